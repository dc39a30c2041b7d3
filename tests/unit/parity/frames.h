// A small frame with stages.
#pragma once
#include <algorithm>
#include <bit>

#include "raster/frame/frame.h"
#include "shading/lang/tables.h"

namespace burnish::test {

// Returns two pixels of two samples: the first shows triangle 0 and the background, the second shows triangle 1. Every float is 1.
inline Frame two_pixels()
{
    constexpr std::uint32_t kOne = std::bit_cast<std::uint32_t>(1.0f);
    Frame f;
    f.color = make_image(2, 1, 3, PixelType::f32);
    std::fill_n(f.color.f32(), 6, 1.0f);
    f.triangle_ids.resize(4);
    f.triangle_ids[0] = 0, f.triangle_ids[1] = kNoTriangle, f.triangle_ids[2] = f.triangle_ids[3] = 1;
    f.stages.vertices.resize(kVertexWords), f.stages.depths.resize(4), f.stages.pairs.resize(4 * kPairWords);
    std::fill_n(f.stages.vertices.data(), kVertexWords, kOne), std::fill_n(f.stages.depths.data(), 4, kOne);
    const auto pair = [&](std::size_t sample, std::uint32_t mask, bool background) {
        std::uint32_t* const to = f.stages.pairs.data() + sample * kPairWords;
        to[0] = mask;
        std::fill_n(background ? to + kPairWords - 3 : to + 1, background ? 3 : kPairWords - 1, kOne);
    };
    pair(0, 1, false), pair(1, 2, true), pair(2, 3, false);
    return f;
}

} // namespace burnish::test
