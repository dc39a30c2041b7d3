// Lane code for tone mapping and 8-bit sRGB. The bits do not depend on the lane width.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish::tone {

enum class Curve : std::uint32_t { none, pbr_neutral, aces }; // Tonemap, for code that sees no containers

// Tables for codes of 8-bit sRGB. A float's bits above the last kKeyShift are its key, which gives the first candidate. `least` holds the
// smallest float of each code, and a float above 1 at the end.
inline constexpr int kKeyShift = 16; // 128 keys an octave
struct CodeTable {
    std::int32_t first_key; // of floats below the first boundary
    const std::int32_t* start;
    const float* least;
};

struct PixelWork { // converts pixels to codes
    Curve curve;
    float scale; // of radiance, before tone mapping
    CodeTable table;
    int channels; // 3 or 4; alpha is linear
    std::size_t count;
    const float* from;
    std::uint8_t* to;
};

struct ColourWork { // exposes and tone maps colours in place, in whole slots
    Curve curve;
    float scale;
    bool clips; // to [0,1]
    std::size_t count;
    float *r, *g, *b;
};
inline constexpr std::size_t kSlots = 16; // room behind a plane's last colour

struct Fns {
    void (*pixels)(const PixelWork& work);
    void (*colours)(const ColourWork& work);
};

} // namespace burnish::tone

namespace burnish {
BN_DECLARE_FNS(tone::Fns);
} // namespace burnish
