#include "shading/bake/mip/light_picture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/scalar_math.h"
#include "core/simd/half.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

// Level 0's weights along an axis, for each texel in a level and its border.
struct AxisBlur {
    std::vector<int> first;                  // first texel of level 0, by texel of the level from the border on
    std::vector<std::vector<double>> weight; // weights from there on; sum to 1
};

AxisBlur axis_blur(int source, int target, bool even)
{
    // Linear interpolation contributes a variance of 1/6 texel^2
    const double spread = static_cast<double>(kLightPictureSpread);
    const double ratio = static_cast<double>(source) / target, sigma = ratio * std::sqrt(spread * spread - 1.0 / 6.0);
    AxisBlur blur;
    for (int i = -1; i <= target; ++i) {
        const double centre = (i + 0.5) * ratio;
        const int from = even ? 0 : std::clamp(static_cast<int>(std::floor(centre - 4.0 * sigma)), 0, source - 1);
        const int to = even ? source - 1 : std::clamp(static_cast<int>(std::floor(centre + 4.0 * sigma)), 0, source - 1);
        std::vector<double> weights;
        double sum = 0.0;
        for (int k = from; k <= to; ++k) {
            const double z = (k + 0.5 - centre) / sigma;
            weights.push_back(even ? 1.0 : det_exp(-0.5 * z * z));
            sum += weights.back();
        }
        for (double& w : weights)
            w /= sum;
        blur.first.push_back(from);
        blur.weight.push_back(std::move(weights));
    }
    return blur;
}

struct Grid3 { // three values per texel
    int width, height;
    std::vector<float> values;
    float* at(int x, int y)
    {
        return values.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    }
};

Grid3 grid3(int width, int height)
{
    return {width, height, std::vector<float>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
}

// Blurs and resamples to a level's size plus its border.
Grid3 blurred(Grid3& from, int width, int height, bool even)
{
    const AxisBlur along = axis_blur(from.width, width, even), down = axis_blur(from.height, height, even);
    Grid3 rows = grid3(width + 2, from.height), out = grid3(width + 2, height + 2);
    for (int y = 0; y < from.height; ++y)
        for (int x = 0; x < rows.width; ++x) {
            const float* texel = from.at(along.first[static_cast<std::size_t>(x)], y);
            glm::dvec3 sum(0.0);
            for (const double w : along.weight[static_cast<std::size_t>(x)])
                for (int c = 0; c < 3; ++c)
                    sum[c] += w * static_cast<double>(*texel++);
            for (int c = 0; c < 3; ++c)
                rows.at(x, y)[c] = static_cast<float>(sum[c]);
        }
    std::vector<double> sums(3 * static_cast<std::size_t>(out.width));
    for (int y = 0; y < out.height; ++y) {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (std::size_t k = 0; k < down.weight[static_cast<std::size_t>(y)].size(); ++k) {
            const double w = down.weight[static_cast<std::size_t>(y)][k];
            const float* texel = rows.at(0, down.first[static_cast<std::size_t>(y)] + static_cast<int>(k));
            for (std::size_t i = 0; i < sums.size(); ++i)
                sums[i] += w * static_cast<double>(texel[i]);
        }
        std::transform(sums.begin(), sums.end(), out.at(0, y), [](double sum) { return static_cast<float>(sum); });
    }
    return out;
}

} // namespace

LightPicture make_light_picture(const Image& image)
{
    Texture sampler;
    sampler.wrap_s = sampler.wrap_t = WrapMode::clamp;
    LightPicture picture;
    TexturePyramid& p = picture.differences = make_texture_pyramid(image, sampler, TextureEncoding::srgb);
    const auto texel = [&](int level, int x, int y) { // -1 is the border
        const auto stride = static_cast<std::size_t>(p.level_width[level]) + 2;
        return p.texels.data() +
               4 * (static_cast<std::size_t>(p.offset[level]) + static_cast<std::size_t>(y + 1) * stride + static_cast<std::size_t>(x + 1));
    };
    // Subtract the mean
    Grid3 whole = grid3(p.width, p.height);
    glm::dvec3 sum(0.0);
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x)
            for (int c = 0; c < 3; ++c)
                sum[c] += static_cast<double>(whole.at(x, y)[c] = half_to_float(texel(0, x, y)[c]));
    picture.mean = glm::vec3(sum / (static_cast<double>(p.width) * p.height));
    for (std::size_t i = 0; i < whole.values.size(); ++i)
        whole.values[i] -= picture.mean[static_cast<int>(i % 3)];
    const auto put = [&](int level, int x, int y, const float* difference) {
        for (int c = 0; c < 3; ++c)
            texel(level, x, y)[c] = float_to_half(difference[c]);
    };
    // Store level 0 and its border
    for (int y = -1; y <= p.height; ++y)
        for (int x = -1; x <= p.width; ++x)
            put(0, x, y, whole.at(std::clamp(x, 0, p.width - 1), std::clamp(y, 0, p.height - 1)));
    // Blur the higher levels
    for (int level = 1; level < p.levels; ++level) {
        const int width = static_cast<int>(p.level_width[level]), height = static_cast<int>(p.level_height[level]);
        Grid3 grid = blurred(whole, width, height, level + 1 == p.levels);
        for (int y = -1; y <= height; ++y)
            for (int x = -1; x <= width; ++x)
                put(level, x, y, grid.at(x + 1, y + 1));
    }
    return picture;
}

} // namespace burnish
