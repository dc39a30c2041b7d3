// The picture that transmissive bodies show: a frame's opaque surfaces without these bodies.
#pragma once
#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"
#include "shading/bake/mip/texture.h"

namespace burnish {

inline constexpr std::size_t kBehindTextures = 2;

struct BehindPicture {
    TexturePyramid light; // RGB: radiance times coverage; A: coverage, [0,1]
    TexturePyramid depth; // R, level 0: 1 / depth along the view direction, 1/m; 0: no surface
};

// Returns the description of the frame whose picture a BehindPicture is.
FrameDesc behind_frame(const FrameDesc& desc);

// Makes the picture. frame: drawn by behind_frame(desc).
BehindPicture make_behind_picture(const Frame& frame, const Jobs& jobs);

} // namespace burnish
