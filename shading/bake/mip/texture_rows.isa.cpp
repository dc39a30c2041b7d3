#include "shading/bake/mip/texture_rows.h"

#include "core/simd/half_rows.h"
#include "shading/bake/mip/mean_fns.h"
#include "shading/lang/records.h"
#include "shading/surface/tensor.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

namespace work = burnish::mip;

constexpr std::size_t kLane = static_cast<std::size_t>(kLanes);
constexpr std::size_t kAtOnce = 64; // texels whose numbers become halves together
static_assert(kAtOnce % kLane == 0 && static_cast<std::size_t>(work::kRowSlots) % kLane == 0);

void halve(const work::HalveWork& w)
{
    for (std::size_t i = 0; i < w.count; ++i) {
        const float *const top = w.top + 8 * i, *const bottom = w.bottom + 8 * i;
        double column[8];
        for (std::size_t k = 0; k < 8; ++k)
            column[k] = 0.5 * static_cast<double>(top[k]) + 0.5 * static_cast<double>(bottom[k]);
        for (std::size_t c = 0; c < 4; ++c)
            w.to[4 * i + c] = static_cast<float>(0.5 * column[c] + 0.5 * column[4 + c]);
    }
}

void halves(const work::HalfWork& w)
{
    if (w.rest)
        residuals_to_halves(w.from, w.count, w.to);
    else
        floats_to_halves(w.from, w.count, w.to);
}

void points(const work::PointWork& w)
{
    alignas(64) float texels[work::kLobeChannels][kAtOnce] = {};
    for (std::size_t first = 0; first < w.stride; first += kAtOnce) {
        const std::size_t some = w.count - first < kAtOnce ? w.count - first : kAtOnce;
        const float* from = w.texels + work::kLobeChannels * first;
        for (std::size_t i = 0; i < some; ++i)
            for (auto& channel : texels)
                channel[i] = *from++;
        for (auto& channel : texels)
            for (std::size_t i = some; i < kAtOnce; ++i)
                channel[i] = 0.0f;
        for (std::size_t i = 0; i < kAtOnce && first + i < w.stride; i += kLane) {
            const real x = load(&texels[0][i]), y = load(&texels[1][i]);
            const slope_covariance s = covariance_of_tensor({load(&texels[2][i]), load(&texels[3][i]), load(&texels[4][i])});
            const real z2 = lit(1.0) - (x * x + y * y);
            const real plane[work::kPointPlanes] = {x, y, sqrt(max(z2, lit(0.0))), s.xx, s.yy, s.xy};
            for (std::size_t k = 0; k < work::kPointPlanes; ++k)
                store(w.points + k * w.stride + first + i, plane[k]);
        }
    }
}

BN_FN real mean_width(slope_covariance lobe)
{
    const slope_axes axes = axes_of_covariance(lobe);
    return (axes.sigma_u + axes.sigma_v) * lit(0.70710678);
}

void widths(const work::WidthWork& w)
{
    for (std::size_t at = 0; at < w.count; at += kLane) {
        const auto plane = [&](std::size_t k) { return load(w.points + k * w.stride + at); };
        const real width = mean_width({plane(3), plane(4), plane(5)});
        store(w.to + at, width * width);
    }
}

// Texels of up to kAtOnce places in a row.
struct texel_run {
    alignas(64) float rgba[4 * kAtOnce];
};
BN_FN void put(texel_run& run, std::size_t i, real r, real g, real b, real a)
{
    const integer texels[4] = {bits_of(r), bits_of(g), bits_of(b), bits_of(a)};
    store_quads(run.rgba + 4 * i, texels, kLanes);
}

// Writes a row of each wanted texture. shading/surface/lobe_shape.t.h reads the moments.
void moments(const work::MomentWork& w)
{
    const real gain = splat(w.gain), reflected = splat(w.reflected), unscale = splat(w.unscale), half = lit(0.5), one = lit(1.0);
    const real of_moment = splat(kMomentScale), of_slope = splat(kSlopeScale);
    const bool two = w.to[work::kFilteredMoments2] || w.to[work::kFilteredRest2];
    const bool four = w.to[work::kFilteredMoments4] || w.to[work::kFilteredRest4];
    texel_run normals, second, fourth;
    for (std::size_t first = 0; first < w.count; first += kAtOnce) {
        const std::size_t some = w.count - first < kAtOnce ? w.count - first : kAtOnce;
        for (std::size_t i = 0; i < some; i += kLane) {
            const std::size_t at = first + i;
            const auto plane = [&](std::size_t k) { return load(w.points + k * w.stride + at); };
            const real nx = plane(0), ny = plane(1), nz = plane(2);
            const slope_covariance s = {plane(3), plane(4), plane(5)};
            const real x = gain * nx, y = gain * ny;
            if (w.to[work::kFilteredNormals])
                put(normals, i, half + unscale * nx, half + unscale * ny, half + half * nz, w.alpha ? load(w.alpha + at) : one);
            if (two) {
                real own = one;
                if (!w.gained && w.width2)
                    own = sqrt(sqrt(max(load(w.width2 + at), lit(0.0))));
                else if (!w.gained)
                    own = sqrt(mean_width(s));
                put(second, i, reflected, nz, own, of_moment * (s.xx + x * x));
            }
            if (four)
                put(fourth, i, of_slope * nx, of_slope * ny, of_moment * (s.yy + y * y), of_moment * (s.xy + x * y));
        }
        const auto give = [&](work::FilteredTexture texture, const texel_run& run, bool rest) {
            std::uint16_t* const to = w.to[texture];
            if (!to)
                return;
            if (rest)
                residuals_to_halves(run.rgba, 4 * some, to + 4 * first);
            else
                floats_to_halves(run.rgba, 4 * some, to + 4 * first);
        };
        give(work::kFilteredNormals, normals, false);
        give(work::kFilteredMoments2, second, false), give(work::kFilteredRest2, second, true);
        give(work::kFilteredMoments4, fourth, false), give(work::kFilteredRest4, fourth, true);
    }
}

constexpr work::TextureFns kTextureFns = {halve, halves, points, widths, moments};

} // namespace

BN_DEFINE_FNS(mip::TextureFns, kTextureFns)

} // namespace BN_ISA_NS
} // namespace burnish
