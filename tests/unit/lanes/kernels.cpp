#include "tests/unit/lanes/kernels.h"

#include <cstring>

#include "core/base/check.h"
#include "core/simd/dispatch.h"

namespace burnish::test {

const IsaFns& oracle_fns()
{
    return burnish::oracle_fns<IsaFns>();
}

const std::vector<IsaFns>& float_fns()
{
    static const std::vector<IsaFns> all = [] {
        std::vector<IsaFns> list;
        for (const Isa isa : isas_with<IsaFns>())
            list.push_back(pick<IsaFns>(isa));
        return list;
    }();
    return all;
}

const std::vector<IsaFns>& all_fns()
{
    static const std::vector<IsaFns> all = [] {
        std::vector<IsaFns> list = float_fns();
        list.push_back(oracle_fns());
        return list;
    }();
    return all;
}

const IsaFns& fast_fns()
{
    return pick<IsaFns>();
}

const Kernel& kernel(const IsaFns& isa, const char* name)
{
    int found = -1;
    for (int i = 0; i < isa.count; ++i)
        if (std::strcmp(isa.kernels[i].name, name) == 0)
            found = i;
    BN_CHECK(found >= 0);
    return isa.kernels[found];
}

std::vector<double> run(const Kernel& kernel, const std::vector<double>& in, const TexelView& t)
{
    const std::size_t inputs = static_cast<std::size_t>(kernel.inputs), n = in.size() / inputs;
    BN_CHECK(n > 0 && n * inputs == in.size());
    std::vector<double> out(n * static_cast<std::size_t>(kernel.outputs));
    kernel.run(t, static_cast<int>(n), in.data(), out.data());
    return out;
}

std::vector<double> call(const IsaFns& isa, const char* name, const std::vector<double>& in, const TexelView& t)
{
    return run(kernel(isa, name), in, t);
}

} // namespace burnish::test
