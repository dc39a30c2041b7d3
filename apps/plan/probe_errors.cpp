#include "apps/plan/probe_errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/math/scalar_math.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

constexpr double kNoiseOff = 0.2; // the noise's relative deviation, as two noisy pictures tell
// FLIP grows with this power of a distance between colours (Andersson et al. 2020, section 4.1).
constexpr double kFlipExponent = 0.7;
constexpr int kBlock = 8; // pixels along a block's side; blocks' errors count as independent

// Returns one noisy picture's squared error to the exact picture, relative to two noisy ones'.
double squared_error_of_one()
{
    return flip_of(0.5) * flip_of(0.5);
}

double sum_of(const Image& error)
{
    const std::size_t pixels = error.bytes.size() / sizeof(float);
    return std::accumulate(error.f32(), error.f32() + pixels, 0.0);
}

} // namespace

PixelMaterials materials_of(const Frame& frame, const DrawTables& tables, std::size_t count)
{
    PixelMaterials m;
    m.pixels.assign(count, 0.0);
    m.width = frame.color.width, m.height = frame.color.height;
    m.of.assign(frame.triangle_ids.size(), kUnseen);
    for (std::size_t p = 0; p < m.of.size(); ++p) {
        const std::uint32_t id = frame.triangle_ids[p];
        if (id != kNoTriangle && (frame.through.empty() || frame.through[p] == 1.0f))
            m.of[p] = static_cast<int>(tables.triangle_material[id]), m.pixels[tables.triangle_material[id]] += 1.0;
    }
    return m;
}

double squared(double flip)
{
    return det_pow(std::max(0.0, flip), 2.0 / kFlipExponent);
}
double flip_of(double square)
{
    return det_pow(std::max(0.0, square), 0.5 * kFlipExponent);
}

double sum_of_errors(double a, double b)
{
    return flip_of(squared(a) + squared(b));
}

std::vector<double> mean_errors(const Image& error, const PixelMaterials& materials)
{
    std::vector<double> sums(materials.pixels.size(), 0.0);
    for (std::size_t p = 0; p < materials.of.size(); ++p)
        if (materials.of[p] != kUnseen)
            sums[static_cast<std::size_t>(materials.of[p])] += static_cast<double>(error.f32()[p]);
    for (std::size_t m = 0; m < sums.size(); ++m)
        sums[m] /= std::max(1.0, materials.pixels[m]);
    return sums;
}

std::vector<Moments> moments_of(const Image& of_a, const Image& of_b, const Image& of_noise, const PixelMaterials& materials)
{
    // Sums over a block's pixels with one material, and over blocks
    struct Block {
        double mean = 0.0, square = 0.0, noise_square = 0.0, pixels = 0.0;
    };
    struct Blocks {
        double risen2 = 0.0, risen_pixels = 0.0, pixels2 = 0.0; // risen: square - noise_square
    };
    const double of_one = squared_error_of_one();
    std::vector<Moments> out(materials.pixels.size());
    std::vector<Block> block(out.size());
    std::vector<Blocks> blocks(out.size());
    std::vector<std::size_t> touched;
    for (int y0 = 0; y0 < materials.height; y0 += kBlock)
        for (int x0 = 0; x0 < materials.width; x0 += kBlock) {
            for (int y = y0; y < std::min(y0 + kBlock, materials.height); ++y)
                for (int x = x0; x < std::min(x0 + kBlock, materials.width); ++x) {
                    const std::size_t p =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(materials.width) + static_cast<std::size_t>(x);
                    if (materials.of[p] == kUnseen)
                        continue;
                    const std::size_t m = static_cast<std::size_t>(materials.of[p]);
                    const double a = static_cast<double>(of_a.f32()[p]), b = static_cast<double>(of_b.f32()[p]),
                                 noise = static_cast<double>(of_noise.f32()[p]);
                    Block& to = block[m];
                    if (to.pixels == 0.0)
                        touched.push_back(m);
                    to.mean += 0.5 * (a + b), to.square += 0.5 * (a * a + b * b), to.noise_square += of_one * noise * noise;
                    to.pixels += 1.0;
                }
            for (const std::size_t m : touched) {
                const Block s = std::exchange(block[m], Block{});
                const double pixels = materials.pixels[m], risen = s.square - s.noise_square;
                out[m].mean += s.mean / pixels, out[m].square += s.square / pixels, out[m].noise_square += s.noise_square / pixels;
                blocks[m].risen2 += risen * risen, blocks[m].risen_pixels += risen * s.pixels, blocks[m].pixels2 += s.pixels * s.pixels;
            }
            touched.clear();
        }
    for (std::size_t m = 0; m < out.size(); ++m) {
        const double mean = out[m].square - out[m].noise_square;
        const double squares = blocks[m].risen2 - 2.0 * mean * blocks[m].risen_pixels + mean * mean * blocks[m].pixels2;
        out[m].deviation = std::sqrt(std::max(0.0, squares)) / std::max(1.0, materials.pixels[m]);
    }
    return out;
}

double error_without_noise(const Moments& m, double guess)
{
    const double risen = std::max(0.0, m.square - m.noise_square);
    const double square = squared(std::sqrt(m.square)) - squared(std::sqrt(m.noise_square));
    const double measured = flip_of(square) * m.mean / std::max(1e-30, std::sqrt(m.square));
    const double off = kNoiseOff * m.noise_square, variance = m.deviation * m.deviation + off * off;
    const double weight = risen * risen / std::max(1e-30, risen * risen + variance);
    return guess + weight * (measured - guess);
}

double noise_filter(const Image& a, const Image& b, const Image& error, FlipOptions flip, const Jobs& jobs)
{
    flip.ppd = kDefaultPpd;
    return sum_of(flip_hdr(a, b, flip, jobs).error) / std::max(1e-30, sum_of(error));
}

} // namespace burnish
