#include "raster/frame/shadow_ratio.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr int kReach = 2;           // pixels to each side
constexpr double kShadowBlur = 0.8; // pixels, standard deviation
constexpr double kOffPlane = 2.0;   // pixels, standard deviation of a neighbour's distance from the surface's plane
constexpr int kAlikeNormals = 6;    // weight: the cosine between normals to the power of 2^6

struct Guide { // geometry of a pixel
    glm::dvec3 position, normal;
    double pixel = 0.0; // side of the pixel at this depth, metres
    bool seen = false;
};

// x, y: pixel in the picture of `width` x `height` pixels.
Guide guide_of(const PixelLayers& layers, const View& v, int x, int y, int width, int height)
{
    Guide g;
    const double depth = static_cast<double>(layers.depth);
    g.normal = {layers.normal[0], layers.normal[1], layers.normal[2]};
    g.seen = glm::dot(g.normal, g.normal) > 0.0 && std::isfinite(depth);
    if (!g.seen)
        return g;
    const double scale = v.orthographic ? 1.0 : depth;
    const double across = (2.0 * (x + 0.5) / width - 1.0) * static_cast<double>(v.tan_half_x) * scale;
    const double up = (1.0 - 2.0 * (y + 0.5) / height) * static_cast<double>(v.tan_half_y) * scale;
    g.position = glm::dvec3(v.eye) + glm::dvec3(v.forward) * depth + glm::dvec3(v.right) * across + glm::dvec3(v.up) * up;
    g.pixel = 2.0 * static_cast<double>(v.tan_half_y) * scale / height;
    return g;
}

double alike(const Guide& a, const Guide& b)
{
    double cosine = std::max(glm::dot(a.normal, b.normal), 0.0);
    for (int i = 0; i < kAlikeNormals; ++i)
        cosine *= cosine;
    const double off = glm::dot(a.normal, b.position - a.position) / (kOffPlane * a.pixel);
    return cosine * det_exp(-0.5 * std::min(off * off, 1000.0));
}

} // namespace

Image shadow_ratio(const Image& shadowed, const Image& open, const Column<PixelLayers>& layers, const FrameDesc& desc, const Jobs& jobs,
                   bool noisy)
{
    const int reach = noisy ? kReach : 0;
    const int width = desc.width, height = desc.height;
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    BN_CHECK(open.width == width && open.height == height && shadowed.width == width && shadowed.height == height);
    BN_CHECK(layers.size() == pixels);
    // Find the surface behind every pixel
    std::vector<Guide> guides(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        guides[i] =
            guide_of(layers[i], desc.view, desc.window.left + static_cast<int>(i % static_cast<std::size_t>(width)),
                     desc.window.top + static_cast<int>(i / static_cast<std::size_t>(width)), picture_width(desc), picture_height(desc));
    // Tabulate the Gaussian
    double falloff[kReach + 1];
    for (int i = 0; i <= kReach; ++i)
        falloff[i] = det_exp(-0.5 * i * i / (kShadowBlur * kShadowBlur));
    Image ratio = make_image(width, height, 3, PixelType::f32);
    auto* const out = reinterpret_cast<float*>(ratio.bytes.data());
    const float *const some = shadowed.f32(), *const all = open.f32();
    jobs.parallel_for(static_cast<std::size_t>(height), [&](std::size_t row, int) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const auto at = [&](int i, int j) {
                return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
            };
            const Guide& here = guides[at(x, y)];
            // Sum both estimates over neighbours on the same surface
            glm::dvec3 arrives(0.0), without(0.0);
            for (int j = std::max(y - reach, 0); j <= std::min(y + reach, height - 1); ++j)
                for (int i = std::max(x - reach, 0); i <= std::min(x + reach, width - 1); ++i) {
                    const Guide& there = guides[at(i, j)];
                    const bool self = i == x && j == y;
                    if (!self && !(here.seen && there.seen))
                        continue;
                    const double weight = self ? 1.0 : falloff[std::abs(i - x)] * falloff[std::abs(j - y)] * alike(here, there);
                    for (int c = 0; c < 3; ++c) {
                        arrives[c] += weight * static_cast<double>(some[3 * at(i, j) + static_cast<std::size_t>(c)]);
                        without[c] += weight * static_cast<double>(all[3 * at(i, j) + static_cast<std::size_t>(c)]);
                    }
                }
            // Divide the sums
            for (int c = 0; c < 3; ++c)
                out[3 * at(x, y) + static_cast<std::size_t>(c)] =
                    without[c] > 0.0 ? static_cast<float>(std::max(arrives[c], 0.0) / without[c]) : 1.0f;
        }
    });
    return ratio;
}

void darken(Image& picture, const Image& lit, const Image& unlit, const Image& ratio)
{
    float* const to = picture.f32();
    for (std::size_t i = 0; i < lit.bytes.size() / sizeof(float); ++i)
        if (const float r = ratio.f32()[i]; r != 1.0f)
            to[i] = std::max(to[i] - (lit.f32()[i] - unlit.f32()[i]) * (1.0f - r), 0.0f);
}

void darken(std::vector<PixelPart>& parts, const std::vector<PixelPart>& lit, const std::vector<PixelPart>& unlit, const Image& ratio)
{
    BN_CHECK(parts.size() == lit.size() && lit.size() == unlit.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const float* const r = ratio.f32() + std::size_t{3} * parts[i].pixel;
        for (std::size_t c = 0; c < 3; ++c)
            if (r[c] != 1.0f)
                parts[i].color[c] = std::max(parts[i].color[c] - (lit[i].color[c] - unlit[i].color[c]) * (1.0f - r[c]), 0.0f);
    }
}

} // namespace burnish
