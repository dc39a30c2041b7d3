#include "shading/bake/environment/cube_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/check.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr int kSubsamples = 4; // per pixel and axis

struct CubePlace {
    int face;
    double column, row; // texels from the face's corner; centres of the outermost texels lie on the cube's edges
};

// Returns the place where a direction, not unit, meets a face (OpenEXR, "Reading and Writing OpenEXR Image Files", environment maps).
// last: size - 1. OpenEXR's latlong picture has +Z at its centre, ours +X. So OpenEXR's axes are x = -z, y = y, z = x in ours.
CubePlace place_on_cube(const glm::dvec3& ours, double last)
{
    const glm::dvec3 d(-ours.z, ours.y, ours.x), a = glm::abs(d);
    const auto up = [last](double t) { return (t + 1.0) * 0.5 * last; };
    const auto down = [last](double t) { return (1.0 - t) * 0.5 * last; };
    if (a.x >= a.y && a.x >= a.z)
        return {d.x > 0.0 ? 0 : 1, d.x > 0.0 ? up(d.z / a.x) : down(d.z / a.x), down(d.y / a.x)};
    if (a.y >= a.z)
        return {d.y > 0.0 ? 2 : 3, up(d.x / a.y), d.y > 0.0 ? down(d.z / a.y) : up(d.z / a.y)};
    return {d.z > 0.0 ? 4 : 5, d.z > 0.0 ? down(d.x / a.z) : up(d.x / a.z), down(d.y / a.z)};
}

// Adds the four texels around a place, weighted bilinearly.
void add_texels(const Image& faces, const CubePlace& at, double* sums)
{
    const int size = faces.width, x0 = std::clamp(static_cast<int>(at.column), 0, size - 1),
              y0 = std::clamp(static_cast<int>(at.row), 0, size - 1);
    const double fx = at.column - x0, fy = at.row - y0;
    for (int corner = 0; corner < 4; ++corner) {
        const int x = std::min(x0 + (corner & 1), size - 1), y = std::min(y0 + (corner >> 1), size - 1);
        const double share = ((corner & 1) ? fx : 1.0 - fx) * ((corner >> 1) ? fy : 1.0 - fy);
        if (share <= 0.0)
            continue; // do not spread a NaN from a texel without weight
        const float* texel =
            faces.f32() + (static_cast<std::size_t>(at.face * size + y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x)) *
                              static_cast<std::size_t>(faces.channels);
        for (int c = 0; c < faces.channels; ++c)
            sums[c] += share * static_cast<double>(texel[c]);
    }
}

} // namespace

std::string cube_picture_fault(const Image& faces, std::uint64_t most_pixels)
{
    if (faces.type != PixelType::f32 || faces.height != 6 * faces.width)
        return fmt::format("says cube, and {} x {} pixels are no six square faces one below the other", faces.width, faces.height);
    const std::uint64_t pixels = 8 * static_cast<std::uint64_t>(faces.width) * static_cast<std::uint64_t>(faces.width);
    if (pixels > most_pixels)
        return fmt::format("an environment of such faces has {} pixels, more than {} (Limits::env_pixels)", pixels, most_pixels);
    return "";
}

Image sky_of_cube_picture(const Image& faces, const Jobs& jobs)
{
    BN_CHECK(faces.type == PixelType::f32 && faces.height == 6 * faces.width && faces.channels <= 4);
    const int width = 4 * faces.width, height = 2 * faces.width;
    std::vector<glm::dvec2> around(static_cast<std::size_t>(width * kSubsamples)); // cosine and sine of the longitude
    for (std::size_t i = 0; i < around.size(); ++i) {
        const double angle = 2.0 * kPi * ((static_cast<double>(i) + 0.5) / static_cast<double>(around.size()) - 0.5);
        around[i] = {det_cos(angle), det_sin(angle)};
    }
    Image sky = make_image(width, height, faces.channels, PixelType::f32);
    const std::size_t channels = static_cast<std::size_t>(faces.channels);
    jobs.parallel_for(static_cast<std::size_t>(height), [&](std::size_t y, int) {
        std::vector<double> sums(static_cast<std::size_t>(width) * channels);
        for (int k = 0; k < kSubsamples; ++k) {
            const double polar = kPi * (static_cast<double>(y) + (k + 0.5) / kSubsamples) / height;
            const double up = det_cos(polar), out = det_sin(polar);
            for (std::size_t i = 0; i < around.size(); ++i)
                add_texels(faces, place_on_cube(glm::dvec3(out * around[i].x, up, out * around[i].y), faces.width - 1.0),
                           sums.data() + i / kSubsamples * channels);
        }
        float* row = sky.f32() + y * static_cast<std::size_t>(width) * channels;
        for (std::size_t i = 0; i < sums.size(); ++i)
            row[i] = static_cast<float>(sums[i] / (kSubsamples * kSubsamples));
    });
    return sky;
}

} // namespace burnish
