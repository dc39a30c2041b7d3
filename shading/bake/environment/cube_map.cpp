#include "shading/bake/environment/cube_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "core/simd/half.h"

namespace burnish {
namespace {

// Returns the signed solid angle on a face between its centre and (u, v).
double corner_solid_angle(double u, double v)
{
    return det_atan2(u * v, std::sqrt(u * u + v * v + 1.0));
}

std::vector<double> solid_angles(int size)
{
    const std::size_t n = static_cast<std::size_t>(size);
    std::vector<double> corner((n + 1) * (n + 1)), angle(n * n);
    for (std::size_t y = 0; y <= n; ++y)
        for (std::size_t x = 0; x <= n; ++x)
            corner[y * (n + 1) + x] = corner_solid_angle(2.0 * static_cast<double>(x) / static_cast<double>(n) - 1.0,
                                                         2.0 * static_cast<double>(y) / static_cast<double>(n) - 1.0);
    for (std::size_t y = 0; y < n; ++y)
        for (std::size_t x = 0; x < n; ++x) {
            const double* c = corner.data() + y * (n + 1) + x;
            angle[y * n + x] = (c[0] - c[1]) - (c[n + 1] - c[n + 2]);
        }
    return angle;
}

struct TexelAt {
    int face, x, y;
};

// Returns the neighbouring face's texel that continues `face` past one edge. Either x or y is -1 or size, not both.
TexelAt across_edge(int face, int x, int y, int size)
{
    const double step = 2.0 / size;
    // A quarter texel past the edge is enough to change the face, and moves no texel centre out of its row.
    const auto coordinate = [&](int i) { return i < 0 ? -1.0 - 0.25 * step : i >= size ? 1.0 + 0.25 * step : (i + 0.5) * step - 1.0; };
    const Direction d = cube_direction(face, coordinate(x), coordinate(y));
    const double ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
    TexelAt t;
    double u, v;
    if (ax > ay && ax > az) {
        t.face = d.x > 0.0 ? 0 : 1;
        u = -d.z / d.x, v = -d.y / ax;
    } else if (ay > az) {
        t.face = d.y > 0.0 ? 2 : 3;
        u = d.x / ay, v = d.z / d.y;
    } else {
        t.face = d.z > 0.0 ? 4 : 5;
        u = d.x / d.z, v = -d.y / az;
    }
    t.x = std::clamp(static_cast<int>((u + 1.0) / step), 0, size - 1);
    t.y = std::clamp(static_cast<int>((v + 1.0) / step), 0, size - 1);
    return t;
}

std::uint16_t* texel_at(CubeMap& cube, int level, int face, int x, int y) // x, y: -1 is the border
{
    const std::size_t side = static_cast<std::size_t>(cube.size >> level) + 2;
    const std::size_t at = cube.offset[static_cast<std::size_t>(level)] + static_cast<std::size_t>(face) * side * side +
                           static_cast<std::size_t>(y + 1) * side + static_cast<std::size_t>(x + 1);
    return cube.texels.data() + 4 * at;
}

// Copies all faces' borders from their neighbours. A corner is the mean of its three texels.
void fill_cube_border(CubeMap& cube, int level)
{
    const int n = cube.size >> level;
    const auto copy = [&](int face, int x, int y) {
        const TexelAt from = across_edge(face, x, y, n);
        std::memcpy(texel_at(cube, level, face, x, y), texel_at(cube, level, from.face, from.x, from.y), 8);
    };
    for (int face = 0; face < 6; ++face) {
        for (int i = 0; i < n; ++i) {
            copy(face, i, -1);
            copy(face, i, n);
            copy(face, -1, i);
            copy(face, n, i);
        }
        for (const int y : {-1, n})
            for (const int x : {-1, n}) {
                const int inside_x = std::clamp(x, 0, n - 1), inside_y = std::clamp(y, 0, n - 1);
                const std::uint16_t* a = texel_at(cube, level, face, inside_x, inside_y);
                const std::uint16_t* b = texel_at(cube, level, face, x, inside_y);
                const std::uint16_t* c = texel_at(cube, level, face, inside_x, y);
                std::uint16_t* to = texel_at(cube, level, face, x, y);
                for (int i = 0; i < 4; ++i) {
                    // Sort, so that the three faces at a corner round alike
                    float v[3] = {half_to_float(a[i]), half_to_float(b[i]), half_to_float(c[i])};
                    std::sort(v, v + 3);
                    to[i] = float_to_half((v[0] + v[1] + v[2]) / 3.0f);
                }
            }
    }
}

} // namespace

Direction cube_direction(int face, double u, double v)
{
    switch (face) {
    case 0:
        return {1.0, -v, -u};
    case 1:
        return {-1.0, -v, u};
    case 2:
        return {u, 1.0, v};
    case 3:
        return {u, -1.0, -v};
    case 4:
        return {u, -v, 1.0};
    default:
        return {-u, -v, -1.0};
    }
}

CubeLevel make_cube_level(int size)
{
    CubeLevel level;
    level.size = size;
    level.rgb.resize(cube_texels(size) * 3);
    level.solid_angle = solid_angles(size);
    return level;
}

CubeLevel half_cube_level(const CubeLevel& from, const Jobs& jobs)
{
    BN_CHECK(from.size >= 2 && from.size % 2 == 0);
    const std::size_t n = static_cast<std::size_t>(from.size / 2), wide = 2 * n;
    CubeLevel to;
    to.size = from.size / 2;
    to.rgb.resize(cube_texels(to.size) * 3);
    to.solid_angle.resize(n * n);
    const auto children = [wide](std::size_t x, std::size_t y, std::size_t k) { // index in a face of child k
        return (2 * y + k / 2) * wide + 2 * x + k % 2;
    };
    for (std::size_t y = 0; y < n; ++y)
        for (std::size_t x = 0; x < n; ++x)
            for (std::size_t k = 0; k < 4; ++k)
                to.solid_angle[y * n + x] += from.solid_angle[children(x, y, k)];
    jobs.parallel_for(6 * n, [&](std::size_t row, int) {
        const std::size_t face = row / n, y = row % n;
        for (std::size_t x = 0; x < n; ++x) {
            double sum[3] = {};
            for (std::size_t k = 0; k < 4; ++k) {
                const std::size_t child = children(x, y, k);
                for (std::size_t c = 0; c < 3; ++c)
                    sum[c] += from.solid_angle[child] * static_cast<double>(from.rgb[(face * wide * wide + child) * 3 + c]);
            }
            for (std::size_t c = 0; c < 3; ++c)
                to.rgb[((face * n + y) * n + x) * 3 + c] = static_cast<float>(sum[c] / to.solid_angle[y * n + x]);
        }
    });
    return to;
}

double mean_luminance(const CubeLevel& level)
{
    double sum = 0.0;
    const std::size_t face_texels = level.solid_angle.size();
    for (std::size_t i = 0; i < 6 * face_texels; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            sum += kLuminance[c] * static_cast<double>(level.rgb[i * 3 + c]) * level.solid_angle[i % face_texels];
    return sum / (4.0 * kPi);
}

double mean_luminance(const CubeMap& cube)
{
    const std::vector<double> angles = solid_angles(cube.size);
    double sum = 0.0;
    const std::size_t n = static_cast<std::size_t>(cube.size), side = n + 2;
    for (std::size_t face = 0; face < 6; ++face)
        for (std::size_t y = 0; y < n; ++y) {
            const std::uint16_t* row = cube.texels.data() + 4 * ((face * side + y + 1) * side + 1);
            for (std::size_t x = 0; x < n; ++x)
                for (std::size_t c = 0; c < 3; ++c)
                    sum += kLuminance[c] * static_cast<double>(half_to_float(row[4 * x + c])) * angles[y * n + x];
        }
    return sum * static_cast<double>(cube.scale) / (4.0 * kPi);
}

CubeMap box_filtered_chain(const CubeMap& environment, const Jobs& jobs)
{
    CubeLevel level = make_cube_level(environment.size);
    const std::size_t n = static_cast<std::size_t>(environment.size), side = n + 2;
    for (std::size_t row = 0; row < 6 * n; ++row) {
        const std::size_t face = row / n, y = row % n;
        const std::uint16_t* from = environment.texels.data() + 4 * ((face * side + y + 1) * side + 1);
        for (std::size_t x = 0; x < n; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                level.rgb[(row * n + x) * 3 + c] = half_to_float(from[4 * x + c]) * environment.scale;
    }
    int levels = 1;
    while ((environment.size >> levels) > 0)
        ++levels;
    CubeMap chain = make_cube_map(environment.size, levels, environment.scale);
    store_cube_level(chain, 0, level.rgb.data(), jobs);
    for (int l = 1; l < levels; ++l) {
        level = half_cube_level(level, jobs);
        store_cube_level(chain, l, level.rgb.data(), jobs);
    }
    return chain;
}

CubeMap make_cube_map(int size, int levels, float scale)
{
    CubeMap cube = make_unfilled_cube_map(size, levels, scale);
    std::fill(cube.texels.begin(), cube.texels.end(), std::uint16_t{0});
    return cube;
}

CubeMap make_unfilled_cube_map(int size, int levels, float scale)
{
    BN_CHECK(size > 0 && levels > 0 && (size >> (levels - 1)) > 0);
    CubeMap cube;
    cube.size = size, cube.levels = levels, cube.scale = scale;
    std::size_t texels = 0;
    for (int l = 0; l < levels; ++l) {
        cube.offset.push_back(static_cast<std::uint32_t>(texels));
        texels += cube_texels((size >> l) + 2);
    }
    BN_CHECK_OP(texels, <, std::size_t{1} << 31);
    cube.texels.resize_for_overwrite(texels * 4);
    return cube;
}

void store_cube_level(CubeMap& cube, int level, const float* rgb, const Jobs& jobs)
{
    const int n = cube.size >> level;
    const float inv_scale = 1.0f / cube.scale; // exact: a power of two
    jobs.parallel_for(6 * static_cast<std::size_t>(n), [&](std::size_t row, int) {
        const int face = static_cast<int>(row) / n, y = static_cast<int>(row) % n;
        const float* from = rgb + row * static_cast<std::size_t>(n) * 3;
        std::uint16_t* to = texel_at(cube, level, face, 0, y);
        for (int x = 0; x < n; ++x, from += 3, to += 4) {
            for (int c = 0; c < 3; ++c)
                to[c] = float_to_half(from[c] * inv_scale);
            to[3] = 0x3c00; // 1
        }
    });
    fill_cube_border(cube, level);
}

float cube_scale(double peak)
{
    if (!(peak > 0.0))
        return 1.0f;
    int exponent = 0;
    std::frexp(peak, &exponent); // peak in [2^(exponent-1), 2^exponent)
    return static_cast<float>(std::ldexp(1.0, std::clamp(exponent - 15, -100, 110)));
}

} // namespace burnish
