// Parses and evaluates expressions given by users.
#pragma once
#include <memory>
#include <string>

#include "core/base/result.h"

namespace burnish {

class Expression { // in u and v; bit-exact on all machines for + - * / sin, cos, sqrt and atan2
  public:
    virtual ~Expression() = default;
    // Fails with ExitCode::usage and the column of the error, the same for every u and v; with ExitCode::unavailable without
    // muParser.
    virtual Result<double> at(double u, double v) = 0;
};

std::unique_ptr<Expression> make_expression(const std::string& text);

} // namespace burnish
