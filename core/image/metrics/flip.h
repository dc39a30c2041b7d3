// FLIP: the visible difference between two images that a viewer flips between on a display, as an error in [0,1] for
// each pixel. LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference
// Evaluator for Alternating Images". HDR-FLIP: Andersson, Nilsson, Shirley, Akenine-Moller 2021, "Visualizing Errors in
// Rendered High Dynamic Range Images". Errors have equal bits for every thread count and instruction set.
#pragma once
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"

namespace burnish {

// Default: a viewer 0.7 m from a monitor 0.7 m and 3840 pixels wide: 3840 pi / 180.
inline constexpr float kDefaultPpd = 67.0206433f; // pixels per degree of the visual field
inline constexpr float kMinPpd = 4.0f, kMaxPpd = 1000.0f;
inline constexpr int kMaxFlipExposures = 64;

enum class FlipTonemap { aces, reinhard, hable };
Result<FlipTonemap> parse_flip_tonemap(const std::string& name);

struct FlipOptions {
    float ppd = kDefaultPpd;
    // HDR only. find_exposures() finds missing values in the reference.
    FlipTonemap tonemap = FlipTonemap::aces;
    std::optional<float> start_ev, stop_ev; // stops
    int exposures = 0;                      // 0: one for each stop, at least 2
    std::optional<Isa> isa;                 // empty: the best one
};

struct FlipExposures {
    float start_ev = 0.0f, stop_ev = 0.0f;
    int count = 1;
};

struct FlipResult {
    Image error; // one float channel
    FlipExposures exposures;
};

// Returns the LDR-FLIP error. Both functions take two images of one size, with any channels and types. Alpha is
// ignored, and gray becomes R = G = B. 8 and 16 bits are sRGB, floats are linear Rec.709. No pixel may be NaN or Inf.
// Throws as the functions of metrics.h do.
FlipResult flip_ldr(const Image& reference, const Image& test, const FlipOptions& options, const Jobs& jobs);
// Returns each pixel's largest LDR-FLIP error over a range of exposures.
FlipResult flip_hdr(const Image& reference, const Image& test, const FlipOptions& options, const Jobs& jobs);

// Returns the exposure range of HDR-FLIP. At its start, the reference's largest luminance reaches 85 % of the tone
// curve; at its end, the median luminance does. Unlike the published program, the median ignores pixels without light
// (luminance 0): otherwise a black background over half the image would make the range infinite. Without any light, or
// where a given start lies above the found end, the range is one point.
FlipExposures find_exposures(const Image& reference, const FlipOptions& options, const Jobs& jobs);

} // namespace burnish
