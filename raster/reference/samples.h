// Owen-scrambled Sobol points in lanes. Scrambling and shuffling by hashes follow Burley 2020, "Practical Hash-based Owen Scrambling":
// reverse the digits, hash them with a function in which every bit depends on lower bits only, and reverse them back. Sets with up to five
// dimensions are padded: each set takes its points in a different order.
#pragma once
#include "core/simd/lanes.h"
#include "raster/reference/sobol.h"
#include "shading/kernels/math.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

// Hashes seeds, which are equal in all lanes, as k_hash_u32 does.
BN_INLINE std::uint32_t hash_seed(std::uint32_t a, std::uint32_t b)
{
    std::uint32_t h = a ^ (b * 0x9e3779b9u + 0x7f4a7c15u + (a << 6) + (a >> 2));
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

BN_INLINE integer splat_bits(std::uint32_t bits)
{
    return int_lit(static_cast<std::int32_t>(bits));
}

// A Laine-Karras hash: bit k of the result depends on bits 0 to k of x. Constants: N. Vegdahl 2021, "Building a better LK hash".
BN_INLINE integer scramble_reversed(integer x, std::uint32_t seed)
{
    x = x ^ (x * splat_bits(0x3d20adeau));
    x = x + splat_bits(seed);
    x = x * splat_bits((seed >> 16) | 1u);
    x = x ^ (x * splat_bits(0x05526c56u));
    return x ^ (x * splat_bits(0x53a22864u));
}

// Returns the point that comes index-th in a set; index in [0, 64).
BN_INLINE integer shuffled(integer index, std::uint32_t seed)
{
    return k_reverse_bits(scramble_reversed(k_reverse_bits(index), seed)) & int_lit(kPassSamples - 1);
}

// Returns coordinate `dimension` of point `index`, [0, 1).
BN_INLINE real owen_sobol(const SobolTable& table, integer index, int dimension, std::uint32_t seed)
{
    const integer reversed = gather_int(reinterpret_cast<const std::int32_t*>(table.points[dimension]), index);
    return k_unit_from_bits(k_reverse_bits(scramble_reversed(reversed, hash_seed(seed, static_cast<std::uint32_t>(dimension)))));
}

// Returns the camera positions in lanes first, first + 1...: in the pixel, [0,1)^2. Each half, quarter... of the pixel gets its share of
// the 16.
BN_INLINE real2 camera_position(const SobolTable& table, std::uint32_t pass_seed, integer position)
{
    const std::uint32_t seed = hash_seed(pass_seed, 1);
    return vec2_of(owen_sobol(table, position, 0, seed), owen_sobol(table, position, 1, seed));
}

struct ShadeSample { // random numbers at one path vertex
    real2 light, lobe;
    real choice;
};

// Returns the random numbers of a vertex. shades: at a camera position; vertex: 0 at the camera's hit, 1 after the first bounce...
BN_INLINE ShadeSample shade_sample(const SobolTable& table, std::uint32_t pass_seed, integer position, int shade, int shades, int vertex)
{
    const std::uint32_t seed = hash_seed(pass_seed, static_cast<std::uint32_t>(2 + vertex));
    const integer index = shuffled(position * int_lit(shades) + int_lit(shade), hash_seed(seed, 99));
    ShadeSample s;
    s.light = vec2_of(owen_sobol(table, index, 0, seed), owen_sobol(table, index, 1, seed));
    s.lobe = vec2_of(owen_sobol(table, index, 2, seed), owen_sobol(table, index, 3, seed));
    s.choice = owen_sobol(table, index, 4, seed);
    return s;
}

// Returns the random point on an area light for a vertex, [0,1)^2.
BN_INLINE real2 area_light_point(const SobolTable& table, std::uint32_t pass_seed, integer position, int shade, int shades, int vertex,
                                 int light)
{
    const std::uint32_t of_vertex = hash_seed(pass_seed, 0x6000u + static_cast<std::uint32_t>(vertex));
    const std::uint32_t seed = hash_seed(of_vertex, static_cast<std::uint32_t>(light));
    const integer index = shuffled(position * int_lit(shades) + int_lit(shade), hash_seed(seed, 99));
    return vec2_of(owen_sobol(table, index, 0, seed), owen_sobol(table, index, 1, seed));
}

} // namespace BN_ISA_NS
} // namespace burnish
