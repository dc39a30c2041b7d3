#include "raster/frame/pixel_parts.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace burnish {

void merge_parts(std::span<const std::span<const PixelPart>> lists, int width, int height, const Jobs& jobs, std::vector<PixelPart>& to)
{
    const auto row_of = [&](const PixelPart& part) { return part.pixel / static_cast<std::uint32_t>(width); };
    // Count each row's parts, and find where a row begins
    const std::size_t rows = static_cast<std::size_t>(height);
    std::vector<std::size_t> begin(rows + 1, 0);
    for (const std::span<const PixelPart> list : lists)
        for (const PixelPart& part : list)
            ++begin[row_of(part) + 1];
    for (std::size_t row = 0; row < rows; ++row)
        begin[row + 1] += begin[row];
    // Move the parts to their rows
    to.resize(begin[rows]);
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (const std::span<const PixelPart> list : lists)
        for (const PixelPart& part : list)
            to[next[row_of(part)]++] = part;
    // Count each row's parts by column. Move them there. Order a pixel's parts by insertion.
    constexpr std::size_t kBand = 16;
    const std::size_t columns = static_cast<std::size_t>(width);
    jobs.parallel_for((rows + kBand - 1) / kBand, [&](std::size_t band, int) {
        std::vector<std::size_t> first(columns + 1), end(columns + 1); // by column, into the row's parts
        std::vector<PixelPart> row_parts;
        for (std::size_t row = band * kBand; row < std::min(rows, (band + 1) * kBand); ++row) {
            PixelPart* const parts = to.data() + begin[row];
            row_parts.assign(parts, to.data() + begin[row + 1]);
            if (row_parts.empty())
                continue;
            const auto column_of = [&](const PixelPart& part) { return part.pixel - row * columns; };
            std::fill(first.begin(), first.end(), std::size_t{0});
            for (const PixelPart& part : row_parts)
                ++first[column_of(part) + 1];
            for (std::size_t x = 0; x < columns; ++x)
                first[x + 1] += first[x];
            end = first;
            for (const PixelPart& part : row_parts) {
                std::size_t place = end[column_of(part)]++;
                for (; place > first[column_of(part)] && part_before(part, parts[place - 1]); --place)
                    parts[place] = parts[place - 1];
                parts[place] = part;
            }
        }
    });
}

} // namespace burnish
