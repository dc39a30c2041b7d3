#include "raster/reference/accumulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace burnish {

namespace {

std::size_t pixel_count(const Accumulator& a)
{
    return static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
}

} // namespace

Accumulator::Accumulator(int w, int h)
    : width(w), height(h), blocks_x((w + kBlockSide - 1) / kBlockSide), blocks_y((h + kBlockSide - 1) / kBlockSide)
{
    pixels = pixel_count(*this);
    sums.resize(kMostSums);
    passes.resize(static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y));
}

void hold_blocks(Accumulator& a, std::size_t first, std::size_t count)
{
    const auto row = static_cast<std::size_t>(a.blocks_x), width = static_cast<std::size_t>(a.width);
    const std::size_t begin = first / row * kBlockSide, end = ((first + count - 1) / row + 1) * kBlockSide;
    a.first_pixel = begin * width;
    a.pixels = std::min(end, static_cast<std::size_t>(a.height)) * width - a.first_pixel;
}

void reserve_sums(Accumulator& a, std::uint32_t passes)
{
    for (int k = 0; k < kMostSums; ++k)
        if (passes >> k & 1u && a.sums[static_cast<std::size_t>(k)].size() == 0)
            a.sums[static_cast<std::size_t>(k)].resize(a.pixels);
}

void keep_totals(Accumulator& a, std::uint32_t passes)
{
    a.last_passes = passes;
    a.totals.resize(a.pixels);
}

std::uint32_t bits_of_passes(const Accumulator& a)
{
    return std::accumulate(a.passes.begin(), a.passes.end(), 0u, [&](std::uint32_t bits, std::uint32_t passes) {
        return a.last_passes && passes == a.last_passes ? bits : bits | passes;
    });
}

void free_sums(Accumulator& a)
{
    const std::uint32_t used = bits_of_passes(a);
    for (int k = 0; k < kMostSums; ++k)
        if (!(used >> k & 1u))
            a.sums[static_cast<std::size_t>(k)] = {};
}

PixelBlock block_of(const Accumulator& a, std::size_t index, std::uint32_t until)
{
    PixelBlock b = {};
    b.x0 = static_cast<int>(index % static_cast<std::size_t>(a.blocks_x)) * kBlockSide;
    b.y0 = static_cast<int>(index / static_cast<std::size_t>(a.blocks_x)) * kBlockSide;
    b.width = std::min(kBlockSide, a.width - b.x0);
    b.height = std::min(kBlockSide, a.height - b.y0);
    b.first_pixel = a.first_pixel;
    b.first_pass = a.first_pass;
    b.done = a.passes[index];
    b.passes = until > b.done ? until - b.done : 0;
    return b;
}

std::uint32_t least_passes(const Accumulator& a)
{
    return a.passes.empty() ? 0 : *std::min_element(a.passes.begin(), a.passes.end());
}

std::uint32_t least_passes(const Accumulator& a, std::size_t first, std::size_t count)
{
    const auto begin = a.passes.begin() + static_cast<std::ptrdiff_t>(first);
    return count ? *std::min_element(begin, begin + static_cast<std::ptrdiff_t>(count)) : 0;
}

std::uint32_t most_passes(const Accumulator& a)
{
    return a.passes.empty() ? 0 : *std::max_element(a.passes.begin(), a.passes.end());
}

namespace {

std::uint32_t passes_of_pixel(const Accumulator& a, std::size_t pixel)
{
    const std::size_t w = static_cast<std::size_t>(a.width), side = static_cast<std::size_t>(kBlockSide);
    return a.passes[pixel / w / side * static_cast<std::size_t>(a.blocks_x) + pixel % w / side];
}

double variance_of_mean(const PixelState& p, int channel, std::uint32_t passes)
{
    if (passes < 2)
        return std::numeric_limits<double>::infinity();
    return std::max(p.m2[channel], 0.0) / (static_cast<double>(passes) * (static_cast<double>(passes) - 1.0));
}

} // namespace

PixelState state_of_pixel(const Accumulator& a, std::size_t pixel)
{
    const std::uint32_t passes = passes_of_pixel(a, pixel);
    if (a.last_passes && passes == a.last_passes)
        return a.totals[pixel];
    PixelState own[kMostSums];
    for (std::size_t k = 0; k < kMostSums; ++k)
        if (passes >> k & 1u)
            own[k] = a.sums[k][pixel];
    return total_of_sums(own, passes);
}

Image mean_image(const Accumulator& a)
{
    Image image = make_image(a.width, a.height, 3, PixelType::f32);
    for (std::size_t i = 0; i < pixel_count(a); ++i) {
        const PixelState state = state_of_pixel(a, i);
        for (std::size_t c = 0; c < 3; ++c)
            image.f32()[3 * i + c] = static_cast<float>(state.mean[c]);
    }
    return image;
}

Image variance_image(const Accumulator& a)
{
    Image image = make_image(a.width, a.height, 3, PixelType::f32);
    for (std::size_t i = 0; i < pixel_count(a); ++i) {
        const PixelState state = state_of_pixel(a, i);
        for (int c = 0; c < 3; ++c)
            image.f32()[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(variance_of_mean(state, c, passes_of_pixel(a, i)));
    }
    return image;
}

// Uses Cornish and Fisher's expansion in 1 / degrees, accurate to 0.1 % from 6 degrees on, and a table below.
double student_t_975(std::uint32_t degrees)
{
    constexpr double kFew[] = {std::numeric_limits<double>::infinity(), 12.7062, 4.3027, 3.1824, 2.7764, 2.5706};
    if (degrees < 6)
        return kFew[degrees];
    const double z = 1.959963984540054, n = degrees, z2 = z * z;
    const double g1 = z * (z2 + 1.0) / 4.0, g2 = z * (5.0 * z2 * z2 + 16.0 * z2 + 3.0) / 96.0;
    const double g3 = z * (3.0 * z2 * z2 * z2 + 19.0 * z2 * z2 + 17.0 * z2 - 15.0) / 384.0;
    return z + (g1 + (g2 + g3 / n) / n) / n;
}

double mean_relative_error(const Accumulator& a)
{
    double sum = 0.0;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < pixel_count(a); ++i) {
        const PixelState p = state_of_pixel(a, i);
        const double mean = p.mean[0] + p.mean[1] + p.mean[2];
        if (!(mean > 0.0))
            continue;
        const std::uint32_t passes = passes_of_pixel(a, i);
        if (passes < 2)
            return std::numeric_limits<double>::infinity();
        double deviation = 0.0; // deviation of the channels' sum is at most the sum of their deviations
        for (int c = 0; c < 3; ++c)
            deviation += std::sqrt(variance_of_mean(p, c, passes));
        sum += student_t_975(passes - 1) * deviation / mean;
        ++counted;
    }
    return counted ? sum / static_cast<double>(counted) : 0.0;
}

} // namespace burnish
