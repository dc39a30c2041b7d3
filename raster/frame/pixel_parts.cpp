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
    // Order each row
    jobs.parallel_for(rows, [&](std::size_t row, int) {
        const auto at = [&](std::size_t i) { return to.begin() + static_cast<std::ptrdiff_t>(i); };
        std::sort(at(begin[row]), at(begin[row + 1]), part_before);
    });
}

} // namespace burnish
