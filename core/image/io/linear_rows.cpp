#include "core/image/io/linear_rows.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <utility>

#include "core/image/colour.h"

namespace burnish {

LinearRows::LinearRows(const Image& image) : image_(image)
{
    if (image.type == PixelType::f32)
        return;
    const std::size_t codes = image.type == PixelType::u8 ? 256 : 65536;
    decode_.resize(codes);
    for (std::size_t code = 0; code < codes; ++code)
        decode_[code] = srgb_to_linear(static_cast<float>(code) / static_cast<float>(codes - 1));
}

template <class T> void LinearRows::read_as(int y, int x, int n, float* r, float* g, float* b) const
{
    const int channels = image_.channels;
    const T* row = reinterpret_cast<const T*>(image_.bytes.data()) +
                   static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(channels);
    const auto value = [&](T code) {
        if constexpr (sizeof(T) == sizeof(float))
            return code;
        else
            return decode_[code];
    };
    const int to_g = channels >= 3 ? 1 : 0, to_b = channels >= 3 ? 2 : 0;
    const int begin = std::clamp(-x, 0, n - 1), end = std::clamp(image_.width - x, begin + 1, n); // inside the image
    const T* from = row + static_cast<std::size_t>(x + begin) * static_cast<std::size_t>(channels);
    for (int i = begin; i < end; ++i, from += channels) {
        r[i] = value(from[0]);
        g[i] = value(from[to_g]);
        b[i] = value(from[to_b]);
    }
    for (float* plane : {r, g, b}) {
        std::fill(plane, plane + begin, plane[begin]);
        std::fill(plane + end, plane + n, plane[end - 1]);
    }
}

void LinearRows::read(int y, int x, int n, float* r, float* g, float* b) const
{
    if (image_.type == PixelType::u8)
        read_as<std::uint8_t>(y, x, n, r, g, b);
    else if (image_.type == PixelType::u16)
        read_as<std::uint16_t>(y, x, n, r, g, b);
    else
        read_as<float>(y, x, n, r, g, b);
}

// Histogram of luminances, used to find the median half a word at a time. Works because positive floats sort like their
// bits.
struct LinearRows::Histogram {
    std::vector<std::uint32_t> pixels = std::vector<std::uint32_t>(1u << 16); // indexed by half word
    std::uint32_t largest = 0;                                                // bits of the largest luminance

    // Returns the half word of pixel `rank` in ascending order. Changes `rank` to the rank within this half word.
    std::uint32_t find(std::uint64_t& rank) const
    {
        std::uint32_t half = 0;
        for (; rank >= pixels[half]; ++half)
            rank -= pixels[half];
        return half;
    }
};

// Counts luminances by their upper half words. With upper_half >= 0, counts by lower half words the luminances with
// this upper half.
LinearRows::Histogram LinearRows::count_lit(const Jobs& jobs, int upper_half) const
{
    std::vector<Histogram> of_worker(static_cast<std::size_t>(jobs.threads()));
    std::vector<std::vector<float>> row_of(of_worker.size());
    const std::size_t width = static_cast<std::size_t>(image_.width);
    // Count each row into its worker's histogram
    jobs.parallel_for(static_cast<std::size_t>(image_.height), [&](std::size_t y, int worker) {
        Histogram& h = of_worker[static_cast<std::size_t>(worker)];
        std::vector<float>& row = row_of[static_cast<std::size_t>(worker)];
        row.resize(3 * width);
        float *r = row.data(), *g = r + width, *b = g + width;
        read(static_cast<int>(y), 0, image_.width, r, g, b);
        for (std::size_t x = 0; x < width; ++x) {
            const float luminance = 0.2126f * r[x] + 0.7152f * g[x] + 0.0722f * b[x];
            if (!(luminance > 0.0f))
                continue;
            const std::uint32_t bits = std::bit_cast<std::uint32_t>(luminance), half = bits >> 16;
            h.largest = std::max(h.largest, bits);
            if (upper_half < 0)
                ++h.pixels[half];
            else if (half == static_cast<std::uint32_t>(upper_half))
                ++h.pixels[bits & 0xffffu];
        }
    });
    // Add up the workers' histograms
    for (std::size_t i = 1; i < of_worker.size(); ++i) {
        std::transform(of_worker[0].pixels.begin(), of_worker[0].pixels.end(), of_worker[i].pixels.begin(), of_worker[0].pixels.begin(),
                       std::plus<>());
        of_worker[0].largest = std::max(of_worker[0].largest, of_worker[i].largest);
    }
    return std::move(of_worker[0]);
}

LitLuminances LinearRows::lit_luminances(const Jobs& jobs) const
{
    const Histogram upper = count_lit(jobs, -1);
    std::uint64_t rank = 0;
    for (const std::uint32_t n : upper.pixels)
        rank += n;
    if (rank == 0)
        return {};
    rank /= 2;
    const std::uint32_t half = upper.find(rank), low = count_lit(jobs, static_cast<int>(half)).find(rank);
    return {std::bit_cast<float>(half << 16 | low), std::bit_cast<float>(upper.largest)};
}

} // namespace burnish
