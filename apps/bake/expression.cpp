#include "apps/bake/expression.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <limits>
#include <muParser.h>
#include <optional>

#include "apps/cli/report.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

bool is_angle(double x) // range of det_sin()
{
    return std::fabs(x) < 1e6;
}

class Parsed : public Expression {
  public:
    explicit Parsed(const std::string& text) : text_(text)
    {
        parser_.DefineVar("u", &u_);
        parser_.DefineVar("v", &v_);
        parser_.DefineConst("pi", kPi);
        parser_.DefineFun("sin", [](double x) { return is_angle(x) ? det_sin(x) : kNoValue; });
        parser_.DefineFun("cos", [](double x) { return is_angle(x) ? det_cos(x) : kNoValue; });
        parser_.DefineFun("atan2", [](double y, double x) { return det_atan2(y, x); });
        parser_.SetExpr(text);
    }

    Result<double> at(double u, double v) override
    {
        if (wrong_) // muParser must not evaluate again after an error
            return *wrong_;
        u_ = u, v_ = v;
        try {
            int count = 0;
            const double* values = parser_.Eval(count);
            if (count == 1)
                return values[0];
            return usage_error("--expr", fmt::format("'{}' is {} expressions, not one", text_, count));
        } catch (const mu::Parser::exception_type& wrong) {
            const int column = std::min(wrong.GetPos(), static_cast<int>(text_.size())) + 1;
            const std::string token = wrong.GetToken();
            wrong_ = usage_error("--expr", fmt::format("'{}' is no expression of u and v: column {}{}", text_, std::max(column, 1),
                                                       token.empty() ? "" : fmt::format(", '{}'", token)));
            return *wrong_;
        }
    }

  private:
    std::string text_;
    mu::Parser parser_;
    double u_ = 0.0, v_ = 0.0;
    std::optional<Error> wrong_;
};

} // namespace

std::unique_ptr<Expression> make_expression(const std::string& text)
{
    return std::make_unique<Parsed>(text);
}

} // namespace burnish
