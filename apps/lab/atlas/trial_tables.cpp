#include "apps/lab/atlas/trial_tables.h"

#include <map>

#include "apps/bake/phong_tables.h"
#include "shading/lab/ltc/bake_ltc.h"

namespace burnish {
namespace {

constexpr const char* kTrial = "trial:";
constexpr int kRule = 12; // a quarter of the default directions, to save time

Result<ltc::BakeOptions> options_of(const std::string& path)
{
    ltc::BakeOptions options;
    options.steps = 0, options.rule = kRule;
    options.grid.beyond = 0, options.grid.root_alpha = options.grid.over_alpha = false;
    options.grid.basis = ltc::Basis::tangent;
    const std::string name = path.substr(std::string(kTrial).size());
    if (name == "inverse")
        options.grid.inverse = true;
    else if (name == "unaligned" || name == "unsymmetric")
        options.align = false, options.symmetry = name == "unaligned";
    else
        return Error{ExitCode::bad_input, path, "", "no table of this name is tried; there are unaligned, unsymmetric, inverse"};
    return options;
}

} // namespace

bool is_trial_table(const std::string& path)
{
    return path.rfind(kTrial, 0) == 0;
}

Result<std::shared_ptr<const ltc::ShadingTables>> trial_table(const std::string& path, const Jobs& jobs)
{
    static std::map<std::string, std::shared_ptr<const ltc::ShadingTables>> made; // used by the walking thread alone
    if (const auto found = made.find(path); found != made.end())
        return found->second;
    const Result<ltc::BakeOptions> options = options_of(path);
    BN_TRY(options);
    const Result<std::optional<ltc::Baked>> baked = ltc::bake_table(*options, jobs);
    BN_TRY(baked);
    Result<ltc::ShadingTables> tables = ltc::with_table((*baked)->table, path); // without `stop` the bake always completes
    BN_TRY(tables);
    return made[path] = std::make_shared<const ltc::ShadingTables>(std::move(*tables));
}

Result<std::shared_ptr<const PhongFiles>> trial_half_vectors(const std::string& path, double roughness, double eta)
{
    const std::string name = path.substr(std::string(kTrial).size());
    if (name != "floats" && name != "eight-bits")
        return Error{ExitCode::bad_input, path, "", "no table of this name is tried; there are floats, eight-bits"};
    const double alpha = roughness * roughness, nu = phong_exponent(alpha * (1.0 + eta)), nv = phong_exponent(alpha * (1.0 - eta));
    Result<PhongFiles> table =
        PhongFiles::of(half_vector_table(nu, nv, {256, 256}, name == "floats" ? PixelType::f32 : PixelType::u8), path);
    BN_TRY(table);
    return std::make_shared<const PhongFiles>(std::move(*table));
}

} // namespace burnish
