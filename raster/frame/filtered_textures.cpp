#include "raster/frame/filtered_textures.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/simd/dispatch.h"
#include "core/simd/half.h"
#include "raster/frame/colours.h"
#include "raster/frame/far_normals.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/kept_light.h"
#include "shading/bake/mip/map_levels.h"
#include "shading/bake/mip/mean_fns.h"
#include "shading/bake/mip/texture_rows.h"

namespace burnish {

namespace {

constexpr int kBand = 16; // rows that a thread writes at once

mip::FilteredTexture texture_of(const PyramidKey& key)
{
    const bool rest = key.encoding == TextureEncoding::residual;
    if (key.tensor_power == 2)
        return rest ? mip::kFilteredRest2 : mip::kFilteredMoments2;
    if (key.tensor_power == 4)
        return rest ? mip::kFilteredRest4 : mip::kFilteredMoments4;
    return mip::kFilteredNormals;
}

// A quantity at the texels of level 0, and its means by level from 1 on.
struct Means {
    Image level0;
    std::vector<std::vector<float>> levels;

    explicit Means(const MipSource& source) : level0(make_image(source.width(), source.height(), 1, PixelType::f32)) {}
    float* row(int level, int y)
    {
        const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(std::max(1, level0.width >> level));
        return (level == 0 ? level0.f32() : levels[static_cast<std::size_t>(level) - 1].data()) + at;
    }
};

class RowWriter {
  public:
    RowWriter(const Scene& scene, const SceneMips& all, const KeptWeights& kept, const std::vector<PyramidKey>& keys,
              const MipLevels& levels, const Jobs& jobs)
        : keys_(keys), levels_(levels), jobs_(jobs), material_(scene.materials[static_cast<std::size_t>(keys.front().material)]),
          source_(mip_source(scene, material_))
    {
        const MaterialMips& mips = all.of(static_cast<std::size_t>(keys.front().material));
        const Texture& sampler = scene.textures[static_cast<std::size_t>(keys.front().texture)];
        work_.gained = has_gains(material_, mips), work_.gain = gain_of_taps(mips.filter, mips.kappa);
        // Undo the scale of normals, which shading applies
        work_.unscale = std::abs(material_.normal_scale) > 1e-3f ? 0.5f / material_.normal_scale : 0.0f;
        bool normals = false, widths = false;
        for (const PyramidKey& key : keys) {
            made_.push_back(make_empty_pyramid(source_.width(), source_.height(), sampler));
            normals |= key.tensor_power == 0, widths |= key.tensor_power == 2 && !work_.gained;
        }
        // Prepare the alpha of normals: the light that facets keep, or the map's own, which may hold heights
        if (normals && kept.any)
            shares_ = &kept_shares(mean_roughness(scene, material_)), kept_.emplace(source_);
        else if (normals)
            take_alpha(scene, all, sampler);
        if (widths)
            width2_.emplace(source_);
    }

    std::vector<TexturePyramid> write()
    {
        write_level(0);
        for (std::optional<Means>* means : {&kept_, &width2_})
            if (*means)
                (*means)->levels = mean_levels((*means)->level0, jobs_);
        for (int level = 1; level < made_.front().levels; ++level)
            write_level(level);
        jobs_.parallel_for(made_.size(), [&](std::size_t k, int) { fill_borders(made_[k]); });
        return std::move(made_);
    }

  private:
    // The planes of a row: points, then a mean width and alpha.
    static constexpr std::size_t kWidthPlane = mip::kPointPlanes, kAlphaPlane = kWidthPlane + 1, kPlanes = kAlphaPlane + 1;

    // Takes the alpha of the normal map's own levels, if it covers the grid.
    void take_alpha(const Scene& scene, const SceneMips& all, const Texture& sampler)
    {
        const Image& map = map_image(scene, material_.normal_tex);
        if ((map.channels != 2 && map.channels != 4) || map.width != source_.width() || map.height != source_.height())
            return;
        const MapLevels* heights =
            material_.has_height_map ? given_map(scene, all, material_, {MapPart::height, &material_.normal_tex, ColourKernel::box, false})
                                     : nullptr;
        const TexturePyramid own =
            heights ? pyramid_of_map(map, sampler, *heights) : make_texture_pyramid(map, sampler, TextureEncoding::linear);
        for (int level = 0; level < own.levels; ++level) {
            const int width = std::max(1, map.width >> level), height = std::max(1, map.height >> level);
            std::vector<std::uint16_t>& to = own_alpha_.emplace_back();
            for (int y = 0; y < height; ++y)
                for (const std::uint16_t *at = texel_row(own, level, y), *end = at + 4 * width; at < end; at += 4)
                    to.push_back(at[3]);
        }
    }

    void write_level(int level)
    {
        const int width = std::max(1, source_.width() >> level), height = std::max(1, source_.height() >> level);
        const std::size_t stride = mip::row_stride(static_cast<std::size_t>(width));
        jobs_.parallel_for(static_cast<std::size_t>((height + kBand - 1) / kBand), [&](std::size_t band, int) {
            std::vector<float> planes(kPlanes * stride);
            const int first = static_cast<int>(band) * kBand;
            for (int y = first; y < std::min(first + kBand, height); ++y)
                write_row(level, y, static_cast<std::size_t>(width), stride, planes.data());
        });
    }

    void write_row(int level, int y, std::size_t width, std::size_t stride, float* planes)
    {
        mip::MomentWork work = work_;
        work.count = width, work.stride = stride, work.points = planes, work.reflected = 1.0f;
        if (level == 0) {
            source_.planes(y, planes);
        } else {
            const MipLevel& of = levels_.levels[static_cast<std::size_t>(level) - 1];
            fns_.points({width, stride, &of.texels[static_cast<std::size_t>(y) * width].nx, planes});
            if (work.gained)
                work.reflected = of.gain;
        }
        if (width2_)
            work.width2 = put_widths(level, y, width, stride, planes);
        if (kept_ || !own_alpha_.empty())
            work.alpha = put_alpha(level, y, width, stride, planes);
        for (std::size_t k = 0; k < keys_.size(); ++k)
            work.to[texture_of(keys_[k])] = texel_row(made_[k], level, y);
        fns_.moments(work);
    }

    // Keeps the squared widths of level 0. Returns another level's mean squares, or null at level 0.
    const float* put_widths(int level, int y, std::size_t width, std::size_t stride, float* planes)
    {
        float *const plane = planes + kWidthPlane * stride, *const row = width2_->row(level, y);
        if (level == 0) {
            fns_.widths({width, stride, planes, plane});
            std::copy_n(plane, width, row);
            return nullptr;
        }
        std::copy_n(row, width, plane);
        return plane;
    }

    // Returns the alpha of normals. Keeps the light of level 0's facets.
    const float* put_alpha(int level, int y, std::size_t width, std::size_t stride, float* planes)
    {
        float *const alpha = planes + kAlphaPlane * stride, *const nz = planes + 2 * stride;
        if (kept_) {
            float* const row = kept_->row(level, y);
            for (std::size_t x = 0; x < width; ++x) {
                if (level == 0)
                    row[x] = shares_->at(kKeptKnot, nz[x]);
                alpha[x] = level == 0 ? 1.0f : kept_share(*shares_, row[x], nz[x]);
            }
            return alpha;
        }
        const std::uint16_t* const own = own_alpha_[static_cast<std::size_t>(level)].data() + static_cast<std::size_t>(y) * width;
        for (std::size_t x = 0; x < width; ++x)
            alpha[x] = half_to_float(own[x]);
        return alpha;
    }

    const std::vector<PyramidKey>& keys_;
    const MipLevels& levels_;
    const Jobs& jobs_;
    const Material& material_;
    const MipSource source_;
    const mip::TextureFns& fns_ = pick<mip::TextureFns>();
    mip::MomentWork work_{};
    std::vector<TexturePyramid> made_;                  // by key
    std::vector<std::vector<std::uint16_t>> own_alpha_; // of the normal map, by level: halves
    const KeptShares* shares_ = nullptr;
    std::optional<Means> kept_, width2_; // light that facets keep; squared widths of lobes
};

} // namespace

std::vector<TexturePyramid> filtered_textures(const Scene& scene, const SceneMips& mips, const KeptWeights& kept,
                                              const std::vector<PyramidKey>& keys, const MipLevels& levels, const Jobs& jobs)
{
    return RowWriter(scene, mips, kept, keys, levels, jobs).write();
}

} // namespace burnish
