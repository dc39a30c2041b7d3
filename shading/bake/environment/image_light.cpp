#include "shading/bake/environment/image_light.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/image/colour.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr int kFaceSubsamples = 4; // per pixel and axis

float unit_value(const Image& image, std::size_t i)
{
    if (image.type == PixelType::u8)
        return static_cast<float>(reinterpret_cast<const std::uint8_t*>(image.bytes.data())[i]) / 255.0f;
    return static_cast<float>(reinterpret_cast<const std::uint16_t*>(image.bytes.data())[i]) / 65535.0f;
}

// Returns linear RGB of a face's texels, times `intensity`. The alpha channel is a divisor.
std::vector<float> radiance_of(const Image& face, double intensity)
{
    const std::size_t texels = static_cast<std::size_t>(face.width) * static_cast<std::size_t>(face.height);
    const std::size_t channels = static_cast<std::size_t>(face.channels);
    const bool divided = channels == 2 || channels == 4;
    std::vector<float> rgb(texels * 3);
    for (std::size_t i = 0; i < texels; ++i) {
        const double divisor = divided ? static_cast<double>(unit_value(face, i * channels + channels - 1)) : 1.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const float linear = srgb_to_linear(unit_value(face, i * channels + (channels >= 3 ? c : 0)));
            rgb[i * 3 + c] = divisor > 0.0 ? static_cast<float>(static_cast<double>(linear) / divisor * intensity) : 0.0f;
        }
    }
    return rgb;
}

// Returns the texel that a direction, not unit, meets: face * size^2 + row * size + column.
std::size_t texel_at(const glm::dvec3& d, int size)
{
    const glm::dvec3 a = glm::abs(d);
    int face;
    double u, v; // along columns and rows, [-1, 1], seen from inside
    if (a.x >= a.y && a.x >= a.z)
        face = d.x > 0.0 ? 0 : 1, u = (d.x > 0.0 ? d.z : -d.z) / a.x, v = -d.y / a.x;
    else if (a.y >= a.z)
        face = d.y > 0.0 ? 2 : 3, u = -d.x / a.y, v = (d.y > 0.0 ? d.z : -d.z) / a.y;
    else
        face = d.z > 0.0 ? 4 : 5, u = (d.z > 0.0 ? -d.x : d.x) / a.z, v = -d.y / a.z;
    const auto at = [size](double t) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>((t + 1.0) * 0.5 * size), 0, size - 1));
    };
    const std::size_t side = static_cast<std::size_t>(size);
    return (static_cast<std::size_t>(face) * side + at(v)) * side + at(u);
}

} // namespace

Image sky_of(const ImageLight& light, const Jobs& jobs)
{
    std::vector<float> cube;
    for (const Image& face : light.faces) {
        const std::vector<float> rgb = radiance_of(face, light.intensity);
        cube.insert(cube.end(), rgb.begin(), rgb.end());
    }
    const int width = 4 * light.size, height = 2 * light.size;
    const glm::dmat3 cube_from_world = glm::transpose(light.world_from_cube);
    std::vector<glm::dvec2> around(static_cast<std::size_t>(width * kFaceSubsamples)); // cosine and sine of the longitude
    for (std::size_t i = 0; i < around.size(); ++i) {
        const double angle = 2.0 * kPi * ((static_cast<double>(i) + 0.5) / static_cast<double>(around.size()) - 0.5);
        around[i] = {det_cos(angle), det_sin(angle)};
    }
    Image sky = make_image(width, height, 3, PixelType::f32);
    jobs.parallel_for(static_cast<std::size_t>(height), [&](std::size_t y, int) {
        std::vector<glm::dvec3> sums(static_cast<std::size_t>(width), glm::dvec3(0.0));
        for (int k = 0; k < kFaceSubsamples; ++k) {
            const double polar = kPi * (static_cast<double>(y) + (k + 0.5) / kFaceSubsamples) / height;
            const double up = det_cos(polar), out = det_sin(polar);
            for (std::size_t i = 0; i < around.size(); ++i) {
                const glm::dvec3 d = cube_from_world * glm::dvec3(out * around[i].x, up, out * around[i].y);
                const float* texel = cube.data() + texel_at(d, light.size) * 3;
                sums[i / kFaceSubsamples] += glm::dvec3(texel[0], texel[1], texel[2]);
            }
        }
        float* row = sky.f32() + y * static_cast<std::size_t>(width) * 3;
        for (std::size_t x = 0; x < sums.size(); ++x)
            for (int c = 0; c < 3; ++c)
                row[x * 3 + static_cast<std::size_t>(c)] = static_cast<float>(sums[x][c] / (kFaceSubsamples * kFaceSubsamples));
    });
    return sky;
}

} // namespace burnish
