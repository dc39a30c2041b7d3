#include "apps/lab/mip/chart.h"

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/lab/mip/mip_rows.h"
#include "apps/lab/mip/real_maps.h"
#include "core/jobs/jobs.h"
#include "shading/bake/mipnet/net.h"

namespace burnish {
namespace {

// Returns the models to measure mip filters under: the requested model, or all three.
Result<std::vector<mipnet::Lobe>> measured_lobes(const RenderArguments& in, const OptionTable& given)
{
    std::vector<mipnet::Lobe> lobes = {mipnet::Lobe::ggx_aniso, mipnet::Lobe::beckmann, mipnet::Lobe::ashikhmin_shirley};
    if (!given.given("--brdf"))
        return lobes;
    const std::string name = lobe_model(in.plain.frame.brdf).name;
    for (const mipnet::Lobe lobe : lobes)
        if (name == mipnet::lobe_name(lobe))
            return std::vector{lobe};
    return usage_error("--brdf", "is ggx_aniso, beckmann or ashikhmin_shirley where --mip measures filters");
}

} // namespace

int run_mip_chart(const ChartArguments& arguments, const OptionTable& given)
{
    const ChartOptions& o = arguments.plain;
    const RenderOptions& base = arguments.render.plain;
    const std::set<std::string> known = {"--mip",      "--maps",   "--per-set", "--two-lobes", "--brdf",   "--mip-kappa",
                                         "--mip-gain", "--output", "--quiet",   "--verbose",   "--threads"};
    for (const Option& option : given.options())
        if (option.given && !known.count(option.name))
            return fail(usage_error(option.name, "is of charts of frames; --mip draws none"));
    const Result<std::vector<mipnet::Lobe>> lobes = measured_lobes(arguments.render, given);
    if (!lobes)
        return fail(lobes.error());
    Report report(base.quiet, base.verbosity);
    if (const Status made = make_output_folder(o.folder); !made)
        return fail(made.error());
    const Jobs jobs(base.threads);
    std::vector<mipnet::TestMaterial> set = o.two_lobes ? mipnet::make_crossed_set() : mipnet::make_test_set(jobs);
    for (mipnet::TestMaterial& m : o.two_lobes ? std::vector<mipnet::TestMaterial>() : mipnet::make_trained_set(jobs))
        set.push_back(std::move(m));
    if (!o.maps.empty()) {
        const Result<std::vector<mipnet::TestMaterial>> real = real_materials(o.maps, base.limits);
        if (!real)
            return fail(real.error());
        set.insert(set.end(), real->begin(), real->end());
    }
    std::map<std::string, int> seen;
    std::erase_if(set, [&](const mipnet::TestMaterial& m) { return ++seen[m.set] > o.per_set; });
    const float kappa = base.mips.kappa.value_or(kDefaultMipKappa);
    const std::vector<MipRow> rows = mip_rows(set, *lobes, {kappa, base.mips.gains}, jobs);
    report.release();
    const std::string summary = mip_summary(rows);
    const std::pair<const char*, std::string> files[] = {
        {"mip.json", json_text(mip_rows_json(rows), 1) + "\n"}, {"mip.csv", mip_rows_csv(rows)}, {"mip.txt", summary}};
    for (const auto& [name, text] : files) {
        const std::string path = o.folder + "/" + name;
        if (const Status written = write_text(path, text); !written)
            return fail(written.error());
        report.wrote(path);
    }
    report.figures(summary);
    return 0;
}

} // namespace burnish
