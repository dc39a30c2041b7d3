// Orders the parts of pixels that show several things.
#pragma once
#include <span>
#include <vector>

#include "core/image/colour.h"
#include "core/jobs/jobs.h"

namespace burnish {

// Returns true where a comes before b: by pixel, then by first sample.
constexpr bool part_before(const PixelPart& a, const PixelPart& b)
{
    return a.pixel != b.pixel ? a.pixel < b.pixel : a.first < b.first;
}

// Fills `to` with the parts of all lists, in order. Lists are in any order; no two parts have one pixel and one first sample. Pixels lie in
// a picture of width x height.
void merge_parts(std::span<const std::span<const PixelPart>> lists, int width, int height, const Jobs& jobs, std::vector<PixelPart>& to);

} // namespace burnish
