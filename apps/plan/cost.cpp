#include "apps/plan/cost.h"

#include <algorithm>
#include <cmath>

#include "apps/options/scene_view.h"
#include "core/base/check.h"
#include "raster/frame/frame_record.h"
#include "raster/frame/upload.h"
#include "shading/techniques/lobe_line.k.h"

namespace burnish {
namespace {

enum class Count { all, line };
constexpr double kSharing = 198.0; // instructions of `fixed` by which fragments share their samples

// Returns the samples that lobe_line takes where all neighbours are alike: one, and pairs. A round lobe shares none.
double line_samples(const PixelLobes::Lobe& at, int samples)
{
    const lobe_line line = lobe_line_of({at.o[0], at.o[1], at.o[2]}, at.sigma_u, at.sigma_v);
    const float all = static_cast<float>(samples - (samples % 2 == 0 ? 1 : 0));
    const bool shares = at.sigma_u != at.sigma_v;
    const float most = shares ? std::max(lobe_line_limit(line, all), std::min(all, 3.0f)) : all;
    const float per_width = static_cast<float>(shares ? kLineSamplesShared : kLineSamplesAlone);
    const double count = static_cast<double>(lobe_line_count(line, per_width, most));
    return 1.0 + 2.0 * std::ceil(0.5 * (count - 1.0));
}

// Returns the cost of a fragment, whose lobe decides on lobe_line's samples.
double fragment_cost(const PlanCost& cost, int samples, const PixelLobes::Lobe& lobe)
{
    const double n = cost.line ? line_samples(lobe, samples) : static_cast<double>(samples);
    const bool alone = cost.line && lobe.sigma_u == lobe.sigma_v;
    return cost.fixed - (alone ? kSharing : 0.0) + cost.sample * n;
}

} // namespace

const std::vector<PlanCost>& plan_costs()
{
    static const std::vector<PlanCost> table = {
#define BN_PLAN_SETTING(technique, samples, count, fixed, sample) {#technique, samples, Count::count == Count::line, fixed, sample},
#include "apps/plan/costs.def"
    };
    return table;
}

const std::vector<AreaLightsCost>& area_lights_costs()
{
    static const std::vector<AreaLightsCost> table = {
#define BN_PLAN_AREA_LIGHTS(way, samples, fixed, quad, sample) {kAreaWay_##way, samples, fixed, quad, sample},
#include "apps/plan/costs.def"
    };
    return table;
}

double area_lights_cost(const AreaLightsSetting& setting, std::size_t lights)
{
    const std::vector<AreaLightsCost>& all = area_lights_costs();
    const auto found = std::find_if(all.begin(), all.end(), [&](const AreaLightsCost& c) { return c.way == setting.way; });
    const AreaLightsCost& cost = found == all.end() ? all.front() : *found;
    return cost.fixed + (cost.quad + cost.sample * setting.samples) * static_cast<double>(lights);
}

double random_over_fetch(int samples)
{
    const auto find = [](const char* technique) {
        return *std::find_if(plan_costs().begin(), plan_costs().end(), [&](const PlanCost& c) { return c.technique == technique; });
    };
    const PlanCost random = find("mc"), fetch = find("split_isotropic");
    return random.fixed + random.sample * samples - fetch.fixed - fetch.sample;
}

PixelLobes lobes_of(const Frame& frame, const FrameDesc& desc)
{
    PixelLobes lobes;
    lobes.of.resize(frame.layers.size());
    for (std::size_t p = 0; p < lobes.of.size(); ++p) {
        const PixelLayers& at = frame.layers[p];
        const int x = static_cast<int>(p % static_cast<std::size_t>(desc.width)),
                  y = static_cast<int>(p / static_cast<std::size_t>(desc.width));
        const glm::vec3 v = to_eye(desc.view, desc.width, desc.height, x, y), n(at.normal[0], at.normal[1], at.normal[2]),
                        t(at.tangent[0], at.tangent[1], at.tangent[2]);
        const float alpha = at.roughness * at.roughness, root2 = 1.41421356f;
        lobes.of[p] = {{glm::dot(v, t), glm::dot(v, glm::cross(n, t)), glm::dot(v, n)},
                       alpha * (1.0f + at.anisotropy) / root2,
                       alpha * (1.0f - at.anisotropy) / root2};
    }
    return lobes;
}

std::vector<double> mean_costs(const MaterialTechnique& setting, const PixelLobes& lobes, const std::vector<int>& material,
                               std::size_t count)
{
    const auto cost = std::find_if(plan_costs().begin(), plan_costs().end(),
                                   [&](const PlanCost& c) { return c.technique == setting.technique && c.samples == setting.samples; });
    BN_CHECK(cost != plan_costs().end());
    std::vector<double> sums(count, 0.0), pixels(count, 0.0);
    for (std::size_t p = 0; p < material.size(); ++p) {
        if (material[p] < 0)
            continue;
        const std::size_t m = static_cast<std::size_t>(material[p]);
        sums[m] += fragment_cost(*cost, setting.samples, lobes.of[p]), pixels[m] += 1.0;
    }
    for (std::size_t m = 0; m < count; ++m)
        sums[m] /= std::max(1.0, pixels[m]);
    return sums;
}

} // namespace burnish
