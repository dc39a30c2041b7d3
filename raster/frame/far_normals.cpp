#include "raster/frame/far_normals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/simd/half.h"
#include "raster/frame/colours.h"
#include "raster/frame/pyramids.h"
#include "shading/bake/mip/anisotropy.h"
#include "shading/bake/mip/facets.h"
#include "shading/bake/mip/source.h"

namespace burnish {

float mean_roughness(const Scene& scene, const Material& m)
{
    if (!m.metallic_roughness_tex.used())
        return m.roughness;
    const Image* const map = &map_image(scene, m.metallic_roughness_tex);
    constexpr std::size_t kTexels = 1024;
    const std::size_t all = static_cast<std::size_t>(map->width) * static_cast<std::size_t>(map->height), count = std::min(all, kTexels);
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i)
        sum += static_cast<double>(texel_channel(*map, i * all / count, map->channels >= 3 ? 1 : 0));
    return m.roughness * static_cast<float>(sum / static_cast<double>(count));
}

KeptWeights kept_weights_of(const Scene& scene, const Material& m, const MaterialMips& mips)
{
    const bool anisotropic = m.anisotropy_strength != 0.0f || m.anisotropy_tex.used(); // facets are round
    if (!m.normal_tex.used() || m.has_height_map || m.unlit || anisotropic || has_gains(m, mips))
        return {};
    return kept_weights(normals_of(scene, m), kept_shares(mean_roughness(scene, m)));
}

std::vector<KeptWeights> kept_weights_by_material(const Scene& scene, const SceneMips& mips, const Jobs& jobs)
{
    std::vector<KeptWeights> kept(scene.materials.size());
    jobs.parallel_for_whole(kept.size(), [&](std::size_t i, int) { kept[i] = kept_weights_of(scene, scene.materials[i], mips.of(i)); });
    return kept;
}

TexturePyramid kept_pyramid(const Scene& scene, const Material& m, const Texture& sampler, TextureEncoding encoding)
{
    const KeptShares& shares = kept_shares(mean_roughness(scene, m));
    const auto means = mean_levels(normals_of(scene, m), [&](const MipPoint& p) { return shares.at(kKeptKnot, p.n.z); });
    const TexturePyramid own = make_texture_pyramid(map_image(scene, m.normal_tex), sampler, encoding);
    return make_texture_pyramid(own.width, own.height, sampler, encoding, [&](int level, int width, int y, float* rgba) {
        const std::uint16_t* from = texel_row(own, level, y);
        for (int x = 0; x < width; ++x, rgba += 4, from += 4) {
            for (int c = 0; c < 3; ++c)
                rgba[c] = half_to_float(from[c]);
            rgba[3] = 1.0f;
            if (level == 0)
                continue;
            const float nx = m.normal_scale * (2.0f * rgba[0] - 1.0f), ny = m.normal_scale * (2.0f * rgba[1] - 1.0f);
            const float nz = std::max(2.0f * rgba[2] - 1.0f, 0.0f), length = std::sqrt(nx * nx + ny * ny + nz * nz);
            const std::size_t texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            rgba[3] = kept_share(shares, means[static_cast<std::size_t>(level) - 1][texel], length > 1e-6f ? nz / length : 1.0f);
        }
    });
}

namespace {

constexpr float kLeastLoss = 0.01f; // of light: below this loss, one lobe per texel is accurate enough
constexpr double kAlike = 0.05;     // of the squared lobe width: normals that differ by less are one group

void put_facets(const Scene& scene, const Material& m, const MaterialMips& mips, const KeptWeights& kept, MaterialRecord& to)
{
    to.facets = 0, to.facets_from = 1.0f;
    if (!mips.facets || kept.loss < kLeastLoss || m.transmission > 0.0f || m.tilt_tex.used())
        return;
    to.facets_from = kept.loss;
    const float roughness = mean_roughness(scene, m), own2 = roughness * roughness;
    const double alike = std::max(1e-4, kAlike * static_cast<double>(own2 * own2));
    std::copy(std::begin(kept.mean), std::end(kept.mean), to.facets_kept);
    const std::vector<Facet> facets = facets_of(normals_of(scene, m), alike);
    for (int knot = 0; knot < kKeptKnots; ++knot) {
        float of_groups = 0.0f;
        for (const Facet& facet : facets) {
            const float nz = std::sqrt(std::max(1.0f - (facet.x * facet.x + facet.y * facet.y), 0.0f));
            of_groups += facet.weight * kept_shares(std::sqrt(std::sqrt(own2 * own2 + facet.spread))).at(knot, nz);
        }
        to.groups_kept[knot] = of_groups;
        to.facets_kept[knot] /= std::max(of_groups, 0.05f);
    }
    for (const Facet& facet : facets) {
        const float words[] = {facet.x, facet.y, facet.weight, facet.spread};
        std::copy(std::begin(words), std::end(words), to.facet + 4 * to.facets++);
    }
}

} // namespace

void put_far_normals(const Scene& scene, const Material& m, const MaterialMips& mips, const KeptWeights& kept, MaterialRecord& to)
{
    to.keeps = kept.any ? 1 : 0;
    std::copy(std::begin(kept.of), std::end(kept.of), to.kept);
    put_facets(scene, m, mips, kept, to);
}

std::string why_dim(const Scene& scene, const Material& m)
{
    if (!m.normal_tex.used() || m.unlit || !m.has_height_map)
        return "";
    constexpr float kMuch = 0.2f;
    if (kept_weights(normals_of(scene, m), kept_shares(mean_roughness(scene, m))).loss < kMuch)
        return "";
    return "its normal map holds heights, and no share of the light that steep normals keep: from afar it is too bright or too dark";
}

} // namespace burnish
