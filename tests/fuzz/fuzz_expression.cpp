// libFuzzer entry: any text as an expression of u and v.
#include <algorithm>
#include <string>

#include "apps/bake/expression.h"
#include "core/base/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    constexpr std::size_t kMostCharacters = 1000; // longer texts are refused unread
    const std::unique_ptr<Expression> expression = make_expression(std::string(data, data + std::min(size, kMostCharacters)));
    const Result<double> first = expression->at(0.25, 0.75);
    if (!first)
        BN_CHECK(first.error().code == ExitCode::usage && !first.error().reason.empty());
    BN_CHECK(static_cast<bool>(expression->at(0.5, 0.5)) == static_cast<bool>(first));
    return 0;
}
