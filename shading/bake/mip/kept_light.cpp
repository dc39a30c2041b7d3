#include "shading/bake/mip/kept_light.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "core/math/scalar_math.h"
#include "shading/bake/mip/grid.h"
#include "shading/bake/mip/mean_fns.h"
#include "shading/bake/mip/texture.h"
#include "shading/models/ggx.k.h"

namespace burnish {
namespace {

constexpr int kAzimuths = 16, kLights = 32;
constexpr float kLeastLoss = 0.004f; // share of mean light; smaller losses are invisible

// Returns the light of a facet whose normal leans to +x, from above the surface's horizon. As in frames, an eye below the facet's own
// horizon moves to grazing angles.
float facet_light(float alpha, float sine, float cosine, int knot)
{
    const ggx_params lobe = ggx_params_of(alpha);
    const float up = 0.1f + 0.3f * static_cast<float>(knot), out = std::sqrt(std::max(1.0f - up * up, 0.0f));
    float sum = 0.0f;
    for (int a = 0; a < kAzimuths; ++a) {
        const double turn = (a + 0.5) / kAzimuths * kPi;
        const real3 v = vec3_of(out * static_cast<float>(det_cos(turn)), out * static_cast<float>(det_sin(turn)), up);
        const real3 o = k_normalize3(vec3_of(cosine * v.x - sine * v.z, v.y, std::max(sine * v.x + cosine * v.z, 1e-4f)));
        for (int i = 0; i < kLights; ++i) {
            const real2 xi = vec2_of((static_cast<float>(i) + 0.5f) / kLights, k_radical_inverse2(i));
            const bsdf_sample s = ggx_sample(lobe, o, xi);
            if (s.valid && cosine * s.wi.z - sine * s.wi.x > 0.0f)
                sum += s.weight;
        }
    }
    return sum;
}

// Returns sqrt(1 - the tilt's cosine), [0,1].
float tilt_place(float nz)
{
    return std::sqrt(std::clamp(1.0f - nz, 0.0f, 1.0f));
}

} // namespace

KeptShares::KeptShares(float alpha)
{
    for (int knot = 0; knot < kKeptKnots; ++knot) {
        const float upright = facet_light(alpha, 0.0f, 1.0f, knot);
        for (int i = 0; i < kTilts; ++i) {
            const float place = static_cast<float>(i) / (kTilts - 1), cosine = 1.0f - place * place;
            const float sine = std::sqrt(std::max(1.0f - cosine * cosine, 0.0f));
            rows_[knot].push_back(facet_light(alpha, sine, cosine, knot) / upright);
        }
    }
}

float KeptShares::at(int knot, float nz) const
{
    const float place = tilt_place(nz) * (kTilts - 1);
    const int low = std::min(static_cast<int>(place), kTilts - 2);
    const std::vector<float>& row = rows_[knot];
    const float from = row[static_cast<std::size_t>(low)], to = row[static_cast<std::size_t>(low) + 1];
    return from + (to - from) * (place - static_cast<float>(low));
}

const KeptShares& kept_shares(float roughness)
{
    static std::mutex making;
    static std::map<int, std::unique_ptr<const KeptShares>> made;
    const int step = std::max(1, static_cast<int>(std::clamp(roughness, 0.0f, 1.0f) * 32.0f + 0.5f));
    const std::lock_guard lock(making);
    std::unique_ptr<const KeptShares>& shares = made[step];
    if (!shares) {
        const float of_step = static_cast<float>(step) / 32.0f;
        shares = std::make_unique<const KeptShares>(of_step * of_step);
    }
    return *shares;
}

std::vector<float> spread_points(const MipSource& source)
{
    constexpr std::size_t kCorners = 4;
    const int width = source.width(), height = source.height();
    std::vector<int> x(kCorners * kSpreadPoints), y(x.size());
    std::vector<float> weight(x.size());
    const bool nearest = source.maps().nearest;
    const auto inside = [](int i, int size, WrapMode wrap) {
        return wrap == WrapMode::repeat ? (i + size) % size : std::clamp(i, 0, size - 1);
    };
    double u = 0.5, v = 0.5; // the sequence of the plastic number
    // Find the texels around each place
    for (std::size_t i = 0; i < kSpreadPoints; ++i) {
        const double px = u * width - (nearest ? 0.0 : 0.5), py = v * height - (nearest ? 0.0 : 0.5);
        const double left = std::floor(px), top = std::floor(py), fx = nearest ? 0.0 : px - left, fy = nearest ? 0.0 : py - top;
        for (std::size_t c = 0; c < kCorners; ++c) {
            x[kCorners * i + c] = inside(static_cast<int>(left) + static_cast<int>(c % 2), width, source.maps().wrap_s);
            y[kCorners * i + c] = inside(static_cast<int>(top) + static_cast<int>(c / 2), height, source.maps().wrap_t);
            weight[kCorners * i + c] = static_cast<float>((c % 2 ? fx : 1.0 - fx) * (c / 2 ? fy : 1.0 - fy));
        }
        u += 0.7548776662466927, v += 0.5698402909980532;
        u -= std::floor(u), v -= std::floor(v);
    }
    // Read and interpolate their normals
    const std::size_t from_stride = mip::row_stride(x.size()), stride = mip::row_stride(kSpreadPoints);
    std::vector<float> corners(mip::kPointPlanes * from_stride), normals(3 * stride);
    source.points(x.size(), x.data(), y.data(), corners.data());
    for (std::size_t i = 0; i < kSpreadPoints; ++i) {
        float n[3] = {};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < kCorners; ++c)
                n[k] += weight[kCorners * i + c] * corners[k * from_stride + kCorners * i + c];
        const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (std::size_t k = 0; k < 3; ++k)
            normals[k * stride + i] = n[k] / std::max(length, 1e-6f);
    }
    return normals;
}

KeptWeights kept_weights(const MipSource& source, const KeptShares& shares)
{
    constexpr std::size_t kPoints = kSpreadPoints;
    const std::size_t stride = mip::row_stride(kPoints);
    const std::vector<float> points = spread_points(source);
    double mean[3] = {}, kept[kKeptKnots] = {};
    // Average normals and kept shares
    for (std::size_t i = 0; i < kPoints; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            mean[k] += static_cast<double>(points[k * stride + i]);
        for (int knot = 0; knot < kKeptKnots; ++knot)
            kept[knot] += static_cast<double>(shares.at(knot, points[2 * stride + i])) / kPoints;
    }
    const double length = std::sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
    const float nz = length > 1e-9 ? static_cast<float>(mean[2] / length) : 1.0f;
    KeptWeights weights;
    for (int knot = 0; knot < kKeptKnots; ++knot)
        weights.mean[knot] = static_cast<float>(kept[knot]);
    // Compare with an upright lobe about the mean normal
    const auto loss = [&](int knot) { return 1.0f - static_cast<float>(kept[knot]) / std::max(shares.at(knot, nz), 0.05f); };
    const float held = loss(kKeptKnot);
    weights.any = held > kLeastLoss, weights.loss = std::max(held, 0.0f);
    for (int knot = 0; weights.any && knot < kKeptKnots; ++knot)
        weights.of[knot] = std::clamp(loss(knot) / held, 0.0f, 4.0f);
    return weights;
}

std::vector<std::vector<float>> mean_levels(const MipSource& source, const PointQuantity& of)
{
    Image level0 = make_image(source.width(), source.height(), 1, PixelType::f32);
    std::vector<MipPoint> points(static_cast<std::size_t>(source.width()));
    float* to = level0.f32();
    for (int y = 0; y < source.height(); ++y) {
        source.row(y, points.data());
        for (const MipPoint& p : points)
            *to++ = of(p);
    }
    return mean_levels(level0, Jobs(1));
}

std::vector<std::vector<float>> mean_levels(const Image& level0, const Jobs& jobs)
{
    std::vector<std::vector<float>> levels;
    for (int l = 1; l <= levels_below(level0.width, level0.height); ++l)
        levels.emplace_back(static_cast<std::size_t>(std::max(1, level0.width >> l)) *
                            static_cast<std::size_t>(std::max(1, level0.height >> l)));
    each_box_row(level0, TextureEncoding::linear, jobs, [&](int level, int width, int y, const float* texels) {
        float* row = levels[static_cast<std::size_t>(level) - 1].data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
        for (int x = 0; x < width; ++x)
            row[x] = texels[4 * x];
    });
    return levels;
}

float kept_share(const KeptShares& shares, float mean, float nz)
{
    return std::clamp(mean / std::max(shares.at(kKeptKnot, nz), 0.05f), 0.0f, 1.0f);
}

} // namespace burnish
