// Lane code for the light that lobes reflect under uniform light. Each lobe, one per lane, meets one light drawn from the lobe's half
// vectors. So a few thousand lobes give an accurate mean, for any width. Interfaces use plain pointers.
#pragma once
#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish::mipnet {

inline constexpr int kDrawnNumbers = 8;     // eye x, y, z; a point in the plane, see below, x, y; light x, y, z
inline constexpr double kLeastLightZ = 0.1; // lights are uniform above this, as those that judge levels

struct AlbedoWork {
    Lobe lobe;
    std::size_t texels;  // a multiple of kSlots
    float f0, diffuse;   // reflectances
    bool seen_anyhow;    // texels that turn away from the eye count as at grazing angles; else dark: see radiance() in tensor.h
    const float* planes; // kChannels planes
    // kDrawnNumbers planes: unit directions, and points distributed as GGX slopes of width 1: density 1 / (pi (1 + r^2)^2).
    const float* drawn;
    std::size_t drawn_apart; // distance between planes
    // Output planes. Their means estimate radiance under all lights with radiance 1: the part proportional to both reflectances, and the
    // part that grazing light adds for any f0.
    float *scaled, *rest;
};

struct AlbedoFns {
    void (*albedo)(const AlbedoWork& work);
};

} // namespace burnish::mipnet

namespace burnish {
BN_DECLARE_FNS(mipnet::AlbedoFns);
} // namespace burnish
