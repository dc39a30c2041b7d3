#include "shading/lab/mip/judge_filters.h"

#include <algorithm>
#include <fmt/format.h>

#include "shading/bake/mip/fallback.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mipnet/classical.h"
#include "shading/bake/mipnet/pyramid.h"

namespace burnish::mipnet {
namespace {

constexpr int kJudgedPairs = 48;

struct Filter {
    std::string name;
    std::vector<Texels> levels;
};

// Returns the pyramid of a filter as in frames and files: level 0, then the filter's levels.
std::vector<Texels> filtered_pyramid(const Texels& level0, MipFilter filter, const Jobs& jobs)
{
    std::vector<Texels> levels = {level0};
    for (const MipLevel& level : make_mean_levels(rows_of_texels(level0), filter, 0.0f, jobs))
        levels.push_back(mip_level_texels(level));
    return levels;
}

std::vector<Filter> filters_of(const Texels& level0, Lobe lobe, bool metal, const std::vector<Weights>& cascades, const Jobs& jobs)
{
    std::vector<Filter> filters = {{"baseline", classical_pyramid(level0, Method::baseline)},
                                   {"kappa .25", classical_pyramid(level0, Method::kappa, 0.25)},
                                   {"kappa .5", classical_pyramid(level0, Method::kappa, 0.5)},
                                   {"kappa 1", classical_pyramid(level0, Method::kappa, 1.0)}};
    if (lobe == Lobe::ggx_aniso)
        filters.push_back({"ssgt", filtered_pyramid(level0, kMipFilter_ssgt, jobs)});
    if (lobe == Lobe::beckmann)
        filters.push_back({"leadr", filtered_pyramid(level0, kMipFilter_leadr, jobs)});
    for (std::size_t k = 0; k < cascades.size(); ++k) {
        const std::string name = cascades.size() == 1 ? "mipnet" : fmt::format("mipnet {}", k + 1);
        filters.push_back({name, net_pyramid(level0, cascades[k], jobs)});
        const std::size_t side = static_cast<std::size_t>(level0.width);
        const Texels sample = sample_of(level0.width, level0.height, [&](int x, int y, float* to) {
            for (std::size_t c = 0; c < kChannels; ++c)
                to[c] = level0.channel[c][static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x)];
        });
        const double kappa = static_cast<double>(kDefaultMipKappa);
        const Comparison on = compare_on(sample, cascades[k], kappa, metal, jobs);
        const Method closed = on.prefers_kappa() ? Method::kappa : Method::baseline;
        filters.push_back({name + " auto", on.keeps_net() ? filters.back().levels : classical_pyramid(level0, closed, kappa)});
    }
    return filters;
}

} // namespace

std::vector<Judged> judge(const std::vector<TestMaterial>& set, Lobe lobe, const std::vector<Weights>& cascades, const Jobs& jobs)
{
    std::vector<Judged> all;
    for (const TestMaterial& m : set) {
        const int side = m.material.texels.width;
        const std::vector<Filter> filters = filters_of(m.material.texels, lobe, m.material.metal, cascades, jobs);
        std::vector<Judged> rows;
        std::vector<std::vector<Texels>> pyramids;
        for (const Filter& f : filters) {
            rows.push_back({m.set, m.material.name, f.name, {}});
            pyramids.push_back(f.levels);
        }
        const MipErrorSurface surface = mip_error_surface(lobe, m.material.metal);
        const auto errors = judged_errors(pyramids[0][0], evaluated_levels(pyramids), surface, jobs, {.times = kJudgedPairs});
        for (std::size_t f = 0; f < rows.size(); ++f)
            std::copy(errors[f].begin(), errors[f].end(), rows[f].level + 1);
        for (Judged& row : rows) {
            int pictures = 0;
            for (int k = 1; k <= kEvaluatedLevels; ++k) {
                row.level[0].l1 += row.level[k].l1 / kEvaluatedLevels, row.level[0].mse += row.level[k].mse / kEvaluatedLevels;
                row.level[0].light += row.level[k].light / kEvaluatedLevels;
                if (side >> k >= kLeastFlipSide)
                    row.level[0].flip += row.level[k].flip, ++pictures;
            }
            row.level[0].flip /= std::max(pictures, 1);
            all.push_back(row);
        }
    }
    return all;
}

std::vector<Summary> summaries(const std::vector<Judged>& rows)
{
    std::vector<Summary> all;
    const Judged* base = nullptr; // of the same material: it comes first
    for (const Judged& row : rows) {
        if (row.filter == "baseline")
            base = &row;
        auto s = std::find_if(all.begin(), all.end(), [&](const Summary& a) { return a.set == row.set && a.filter == row.filter; });
        if (s == all.end()) {
            s = all.emplace(all.end());
            s->set = row.set, s->filter = row.filter;
        }
        const MipError &f = row.level[0], &b = base->level[0];
        ++s->materials;
        s->mean.flip += f.flip, s->mean.l1 += f.l1, s->mean.mse += f.mse, s->first_level_l1 += row.level[1].l1;
        s->wins[0] += f.flip < b.flip, s->wins[1] += f.l1 < b.l1, s->wins[2] += f.mse < b.mse;
        s->worst_l1 = std::max(s->worst_l1, f.l1 / b.l1);
    }
    for (Summary& s : all) {
        const double n = static_cast<double>(s.materials);
        s.mean.flip /= n, s.mean.l1 /= n, s.mean.mse /= n, s.first_level_l1 /= n;
        for (double& w : s.wins)
            w /= n;
    }
    std::stable_sort(all.begin(), all.end(), [](const Summary& a, const Summary& b) { return a.set < b.set; });
    return all;
}

} // namespace burnish::mipnet
