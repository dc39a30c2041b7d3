// How much light lobes give back under light from everywhere, as lane code: each lobe in the lanes is met by one light from its own
// half vectors, so that a few thousand of them have a mean that is sure to a few thousandths, however narrow they are. Plain pointers only.
#pragma once
#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish::mipnet {

inline constexpr int kDrawnNumbers = 8;     // eye x, y, z; a point of the plane, see below, x, y; light x, y, z
inline constexpr double kLeastLightZ = 0.1; // lights are anywhere above that: as those that levels are judged under

struct AlbedoWork {
    Lobe lobe;
    std::size_t texels;  // a multiple of kSlots
    float f0, diffuse;   // reflectances
    bool seen_anyhow;    // what turns away from the eye is as at grazing angles; else dark: see radiance() of tensor.h
    const float* planes; // kChannels planes
    // kDrawnNumbers planes: unit directions, and points that lie as GGX's slopes of width 1 do: density 1 / (pi (1 + r^2)^2)
    const float* drawn;
    std::size_t drawn_apart; // from plane to plane
    // Planes. What integrates to the radiance over all lights of radiance 1 in its mean: what is proportional to both reflectances, and
    // what grazing light adds to a lobe whatever f0 is.
    float *scaled, *rest;
};

struct AlbedoFns {
    void (*albedo)(const AlbedoWork& work);
};

} // namespace burnish::mipnet

namespace burnish {
BN_DECLARE_FNS(mipnet::AlbedoFns);
} // namespace burnish
