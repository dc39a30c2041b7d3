// Expressions as users write them.
#pragma once
#include <memory>
#include <string>

#include "core/base/result.h"

namespace burnish {

class Expression { // of u and v; the same bits on every machine where it keeps to + - * / sin, cos, sqrt and atan2
  public:
    virtual ~Expression() = default;
    // Errors: ExitCode::usage with the column of what is wrong, at any place the same; ExitCode::unavailable in a program without them.
    virtual Result<double> at(double u, double v) = 0;
};

std::unique_ptr<Expression> make_expression(const std::string& text);

} // namespace burnish
