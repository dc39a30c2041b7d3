// Shared parts of the bake tests: test images, random numbers, kernel results.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/image/image.h"
#include "core/simd/half.h"
#include "shading/bake/bake_fns.h"
#include "shading/bake/environment/environment.h"
#include "tests/unit/lanes/kernels.h"

namespace burnish {

// Random numbers in [0,1), equal on every machine (SplitMix64).
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double operator()()
    {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    float in(double lo, double hi) { return static_cast<float>(lo + (hi - lo) * (*this)()); }

  private:
    std::uint64_t state_;
};

using test::float_fns, test::oracle_fns, test::IsaFns, test::TexelView;

inline TexelView view_of(const CubeMap& cube)
{
    return {.texels = cube.texels.data(), .size = cube.size, .levels = cube.levels};
}

// Returns a kernel's results, point after point. Arguments are laid out as in Kernel.
inline std::vector<float> results(const IsaFns& isa, const char* name, const std::vector<float>& in, const TexelView& t = {})
{
    const std::vector<double> out = test::call(isa, name, {in.begin(), in.end()}, t);
    const std::size_t count = static_cast<std::size_t>(test::kernel(isa, name).outputs), n = out.size() / count;
    std::vector<float> points(out.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        points[i % n * count + i / n] = static_cast<float>(out[i]);
    return points;
}

// Returns an equirectangular f32 RGB image from radiance(x, y, z, rgb), a function on unit directions.
inline Image equirect_of(int width, const std::function<void(double, double, double, float*)>& radiance)
{
    Image image = make_image(width, width / 2, 3, PixelType::f32);
    const double pi = 3.14159265358979323846;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < width; ++x) {
            const double phi = ((x + 0.5) / width - 0.5) * 2.0 * pi, theta = (y + 0.5) / image.height * pi;
            const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            radiance(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi), image.f32() + i * 3);
        }
    return image;
}

// Returns a smooth environment with colour everywhere.
inline Image smooth_equirect(int width)
{
    return equirect_of(width, [](double x, double y, double z, float* rgb) {
        rgb[0] = static_cast<float>(1.0 + 0.8 * x + 0.3 * y * z);
        rgb[1] = static_cast<float>(1.0 + 0.7 * y * y - 0.2 * x);
        rgb[2] = static_cast<float>(1.2 + z * (0.5 + 0.4 * x));
    });
}

inline EnvironmentOptions small_bake() // without the cache
{
    EnvironmentOptions o;
    o.cube_size = 32;
    o.samples = 128;
    o.use_cache = false;
    return o;
}

// Returns a stored cube texel times the cube's scale; x, y: -1 is the border.
inline float cube_texel(const CubeMap& cube, int level, int face, int x, int y, int channel)
{
    const std::size_t side = static_cast<std::size_t>(cube.size >> level) + 2;
    const std::size_t at = cube.offset[static_cast<std::size_t>(level)] + static_cast<std::size_t>(face) * side * side +
                           static_cast<std::size_t>(y + 1) * side + static_cast<std::size_t>(x + 1);
    return half_to_float(cube.texels[4 * at + static_cast<std::size_t>(channel)]) * cube.scale;
}

} // namespace burnish
