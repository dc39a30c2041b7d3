#include "apps/lab/mip/mip_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/check.h"
#include "core/base/clock.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mipnet/net.h"
#include "shading/bake/mipnet/shipped.h"
#include "shading/lab/mip/two_lobes.h"
#include "shading/surface/tensor.k.h"

namespace burnish {

namespace {

using mipnet::Texels;

struct TexelMaps { // textures of a material, as in a scene file
    Image normal, roughness, direction;
    MipMaps maps() const
    {
        MipMaps m;
        m.normal = &normal, m.roughness = &roughness, m.direction = &direction, m.anisotropy_strength = 1.0f;
        return m;
    }
};

TexelMaps maps_of_texels(const Texels& t)
{
    TexelMaps maps;
    for (Image* image : {&maps.normal, &maps.roughness, &maps.direction})
        *image = make_image(t.width, t.height, 3, PixelType::f32);
    for (std::size_t i = 0; i < t.count(); ++i) {
        const float x = t.channel[0][i], y = t.channel[1][i], z = std::sqrt(std::max(1.0f - (x * x + y * y), 0.0f));
        const tensor_axes axes = axes_of_tensor({t.channel[2][i], t.channel[3][i], t.channel[4][i]});
        const float across = axes.alpha_v, along = std::min(std::max(axes.alpha_u, across), 1.0f);
        const float strength = across < 1.0f ? std::sqrt((along - across) / (1.0f - across)) : 0.0f;
        const float normal[3] = {0.5f + 0.5f * x, 0.5f + 0.5f * y, 0.5f + 0.5f * z}, rough[3] = {1.0f, std::sqrt(across), 1.0f};
        const float direction[3] = {0.5f + 0.5f * axes.u.x, 0.5f + 0.5f * axes.u.y, strength};
        std::copy_n(normal, 3, maps.normal.f32() + 3 * i), std::copy_n(rough, 3, maps.roughness.f32() + 3 * i);
        std::copy_n(direction, 3, maps.direction.f32() + 3 * i);
    }
    return maps;
}

// Quantities that the renderer averages independently: normal, roughness, s^2 d d^T, s^4 d d^T, slopes and products of slopes.
constexpr std::size_t kMeans = 15;
using Means = std::array<float, kMeans>;

Means means_of(const TexelMaps& maps, std::size_t i)
{
    const float* n = maps.normal.f32() + 3 * i;
    const float* d = maps.direction.f32() + 3 * i;
    const float x = 2.0f * d[0] - 1.0f, y = 2.0f * d[1] - 1.0f, s2 = d[2] * d[2];
    const float nx = 2.0f * n[0] - 1.0f, ny = 2.0f * n[1] - 1.0f, nz = std::max(2.0f * n[2] - 1.0f, 1e-3f), sx = nx / nz, sy = ny / nz;
    return {nx,
            ny,
            nz,
            maps.roughness.f32()[3 * i + 1],
            s2 * x * x,
            s2 * y * y,
            s2 * x * y,
            s2 * s2 * x * x,
            s2 * s2 * y * y,
            s2 * s2 * x * y,
            sx,
            sy,
            sx * sx,
            sy * sy,
            sx * sy};
}

std::vector<Texels> map_by_map(const TexelMaps& maps, bool lean)
{
    int side = maps.normal.width;
    std::vector<Means> means(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (std::size_t i = 0; i < means.size(); ++i)
        means[i] = means_of(maps, i);
    std::vector<Texels> levels;
    for (int l = 1; l <= kMipRowLevels; ++l) {
        const std::size_t row = static_cast<std::size_t>(side), half = row / 2;
        side /= 2;
        Texels level = mipnet::make_texels(side, side);
        std::vector<Means> coarse(half * half);
        for (std::size_t y = 0; y < half; ++y)
            for (std::size_t x = 0; x < half; ++x) {
                Means& m = coarse[y * half + x];
                for (std::size_t k = 0; k < kMeans; ++k)
                    for (const std::size_t at :
                         {2 * y * row + 2 * x, 2 * y * row + 2 * x + 1, (2 * y + 1) * row + 2 * x, (2 * y + 1) * row + 2 * x + 1})
                        m[k] += 0.25f * means[at][k];
                const float length = std::sqrt((m[0] * m[0] + m[1] * m[1]) + m[2] * m[2]);
                slope_covariance s =
                    covariance_from_tensors(m[3] * m[3], 1.0f, vec2_of(1.0f, 0.0f), vec3_of(m[4], m[5], m[6]), vec3_of(m[7], m[8], m[9]));
                if (lean)
                    s = sum_of_covariances(s, covariance_of_moments(vec2_of(m[10], m[11]), vec3_of(m[12], m[13], m[14])));
                const lobe_tensor t = projected_tensor(tensor_of_covariance(s));
                const float of[mipnet::kChannels] = {m[0] / length, m[1] / length, t.a, t.b, t.c};
                for (std::size_t c = 0; c < mipnet::kChannels; ++c)
                    level.channel[c][y * half + x] = of[c];
            }
        levels.push_back(std::move(level));
        means.swap(coarse);
    }
    return levels;
}

struct FilteredLevels {
    std::vector<Texels> texels;
    std::vector<float> gains; // empty: no gains
};

FilteredLevels levels_by(MipFilter filter, const TexelMaps& maps, mipnet::Lobe lobe, bool metal, const MipRowOptions& options,
                         const Jobs& jobs)
{
    if (!makes_lobes(filter))
        return {map_by_map(maps, filter == kMipFilter_lean), {}};
    const MipLevels made =
        make_mip_levels(MipSource(maps.maps()), filter, options.kappa, jobs,
                        {mipnet::shipped_weights(lobe), metal, {}, lobe, options.gains ? Gains::as_judged : Gains::none});
    FilteredLevels levels;
    for (std::size_t l = 0; l < kMipRowLevels; ++l)
        levels.texels.push_back(mip_level_texels(made.levels[l])), levels.gains.push_back(made.levels[l].gain);
    return levels;
}

std::string family_of(const mipnet::TestMaterial& m)
{
    const std::size_t space = m.material.name.rfind(' ');
    return m.set == "real" || m.set == "crossed" || space == std::string::npos ? m.material.name : m.material.name.substr(0, space);
}

// Returns the closed share of the L1 gap between baseline and optimised levels. None if the gap is negligible.
std::optional<double> gap_closed(double l1, double baseline, double optimised)
{
    constexpr double kLeastGap = 0.02; // relative to baseline's L1
    return baseline - optimised > kLeastGap * baseline ? std::optional((baseline - l1) / (baseline - optimised)) : std::nullopt;
}

// Ranks materials by baseline's mean L1, within each set and model.
void mark_hardest(std::vector<MipRow>& rows)
{
    std::map<std::pair<std::string, std::string>, std::map<std::string, double>> of;
    for (const MipRow& row : rows)
        if (row.filter == "baseline")
            of[{row.set, row.brdf}][row.material] += row.error.l1;
    for (auto& [place, materials] : of) {
        std::vector<std::pair<double, std::string>> order;
        for (const auto& [name, l1] : materials)
            order.emplace_back(-l1, name);
        std::sort(order.begin(), order.end());
        order.resize((order.size() + 3) / 4);
        for (MipRow& row : rows)
            row.hardest =
                row.hardest || (row.set == place.first && row.brdf == place.second &&
                                std::any_of(order.begin(), order.end(), [&](const auto& hard) { return hard.second == row.material; }));
    }
}

} // namespace

std::vector<MipRow> mip_rows(const std::vector<mipnet::TestMaterial>& set, const std::vector<mipnet::Lobe>& lobes,
                             const MipRowOptions& options, const Jobs& jobs)
{
    std::vector<MipRow> rows;
    for (const mipnet::TestMaterial& m : set) {
        const Texels& level0 = m.material.texels;
        BN_CHECK(level0.width == level0.height && level0.width % (1 << kMipRowLevels) == 0);
        const TexelMaps maps = maps_of_texels(level0);
        for (const mipnet::Lobe lobe : lobes) {
            std::vector<std::vector<Texels>> filters;
            std::vector<std::vector<float>> gains;
            std::vector<double> ms;
            // Filter the material by every filter
            for (std::size_t f = 0; f < mip_filters().size(); ++f) {
                const double begin = wall_ms();
                FilteredLevels levels = levels_by(static_cast<MipFilter>(f), maps, lobe, m.material.metal, options, jobs);
                filters.push_back(std::move(levels.texels)), gains.push_back(std::move(levels.gains));
                ms.push_back(wall_ms() - begin);
            }
            const auto l1 = [](const std::vector<std::vector<MipError>>& of, MipFilter filter, std::size_t l) {
                return of[static_cast<std::size_t>(filter)][l].l1;
            };
            std::vector<std::vector<Texels>> second(filters.size());
            std::vector<std::string> names;
            for (const MipFilterInfo& filter : mip_filters())
                names.emplace_back(filter.name);
            const MipErrorSurface surface = mip_error_surface(lobe, m.material.metal);
            // Crossed grain: search two lobes a texel
            if (m.set == "crossed") {
                const double begin = wall_ms();
                LobePairs pairs = optimised_pairs(level0, filters[static_cast<std::size_t>(kMipFilter_teacher)], surface, jobs);
                filters.push_back(std::move(pairs.first)), second.push_back(std::move(pairs.second));
                ms.push_back(wall_ms() - begin), names.emplace_back("two lobes");
            }
            // Compare all levels with level 0
            const auto errors = judged_errors(level0, filters, surface, jobs, {}, second, gains);
            for (std::size_t f = 0; f < filters.size(); ++f)
                for (std::size_t l = 0; l < kMipRowLevels; ++l)
                    rows.push_back({m.set, family_of(m), m.material.name, mipnet::lobe_name(lobe), names[f], static_cast<int>(l) + 1, false,
                                    errors[f][l], ms[f],
                                    gap_closed(errors[f][l].l1, l1(errors, kMipFilter_baseline, l), l1(errors, kMipFilter_teacher, l))});
        }
    }
    mark_hardest(rows);
    return rows;
}

Json mip_rows_json(const std::vector<MipRow>& rows)
{
    Json all = Json::array();
    for (const MipRow& r : rows) {
        Json row = {{"set", r.set},           {"family", r.family}, {"material", r.material}, {"brdf", r.brdf},
                    {"mip_filter", r.filter}, {"level", r.level},   {"hardest", r.hardest},   {"flip", r.error.flip},
                    {"l1", r.error.l1},       {"mse", r.error.mse}, {"light", r.error.light}, {"ms", r.ms}};
        if (r.error.flip == 0.0) // the level is too small for FLIP
            row["flip"] = nullptr;
        if (r.gap)
            row["gap"] = *r.gap;
        else
            row["gap"] = nullptr;
        all.push_back(std::move(row));
    }
    return all;
}

std::string mip_rows_csv(const std::vector<MipRow>& rows)
{
    std::string text = "set,family,material,brdf,mip_filter,level,hardest,flip,l1,mse,light,ms,gap\n";
    for (const MipRow& r : rows)
        text += fmt::format("{},{},{},{},{},{},{},{},{:.6f},{:.6f},{:.4f},{:.2f},{}\n", r.set, r.family, r.material, r.brdf, r.filter,
                            r.level, r.hardest ? 1 : 0, r.error.flip > 0.0 ? fmt::format("{:.6f}", r.error.flip) : "", r.error.l1,
                            r.error.mse, r.error.light, r.ms, r.gap ? fmt::format("{:.4f}", *r.gap) : "");
    return text;
}

std::string mip_summary(const std::vector<MipRow>& rows)
{
    struct Sum {
        double flip = 0.0, l1 = 0.0, mse = 0.0, light = 0.0, farthest = 0.0;
        int flips = 0, count = 0;
    };
    std::vector<std::pair<std::string, std::string>> order; // group, filter
    std::map<std::pair<std::string, std::string>, Sum> sums;
    const auto add = [&](const std::string& what, const MipRow& r) {
        const std::pair key(what, r.filter);
        if (!sums.count(key))
            order.push_back(key);
        Sum& s = sums[key];
        s.flip += r.error.flip, s.flips += r.error.flip > 0.0, s.l1 += r.error.l1, s.mse += r.error.mse, ++s.count;
        s.light += r.error.light, s.farthest = std::max(s.farthest, std::abs(r.error.light - 1.0));
    };
    for (const int pass : {0, 1, 2})
        for (const MipRow& r : rows) {
            if (pass == 0)
                add(r.brdf + ", " + r.set, r);
            else if (pass == 1 && r.hardest)
                add(r.brdf + ", " + r.set + ", hardest quarter", r);
            else if (pass == 2 && r.set != "real")
                add(r.brdf + ", " + r.set + ", " + r.family, r);
        }
    std::string lines = fmt::format("{:48} {:12} {:>7} {:>7} {:>7} {:>8} {:>6} {:>7} {:>6}\n", "model, set", "filter", "FLIP", "L1", "MSE",
                                    "L1 by", "gap", "light", "worst");
    for (const auto& key : order) {
        const Sum &s = sums[key], &base = sums[{key.first, "baseline"}], &best = sums[{key.first, "teacher"}];
        const std::optional<double> gap = gap_closed(s.l1 / s.count, base.l1 / base.count, best.l1 / best.count);
        lines += fmt::format("{:48} {:12} {:7.1f} {:7.2f} {:7.2f} {:+7.1f}% {:>6} {:+6.1f}% {:5.0f}%\n", key.first, key.second,
                             1e3 * s.flip / std::max(s.flips, 1), 1e3 * s.l1 / s.count, 1e3 * s.mse / s.count,
                             100.0 * (s.l1 / s.count / (base.l1 / base.count) - 1.0), gap ? fmt::format("{:.0f}%", 100.0 * *gap) : "",
                             100.0 * (s.light / s.count - 1.0), 100.0 * s.farthest);
    }
    return lines;
}

} // namespace burnish
