// FLIP: how different two pictures look to someone who flips between them on a display, as one error in [0,1]
// a pixel. LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A
// Difference Evaluator for Alternating Images". HDR-FLIP: Andersson, Nilsson, Shirley, Akenine-Moller 2021,
// "Visualizing Errors in Rendered High Dynamic Range Images". The errors are the same bits for every number
// of threads and every instruction set.
#pragma once
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"

namespace burnish {

// A viewer 0.7 m before a monitor that is 0.7 m and 3840 pixels wide: 3840 pi / 180.
inline constexpr float kDefaultPpd = 67.0206433f; // pixels per degree of the visual field
inline constexpr float kMinPpd = 4.0f, kMaxPpd = 1000.0f;
inline constexpr int kMaxFlipExposures = 64;

enum class FlipTonemap { aces, reinhard, hable };
Result<FlipTonemap> parse_flip_tonemap(const std::string& name);

struct FlipOptions {
    float ppd = kDefaultPpd;
    // HDR only. What is not given is found in the reference (find_exposures).
    FlipTonemap tonemap = FlipTonemap::aces;
    std::optional<float> start_ev, stop_ev; // stops
    int exposures = 0;                      // 0: one a stop, at least 2
    std::optional<Isa> isa;                 // none: the best one
};

struct FlipExposures {
    float start_ev = 0.0f, stop_ev = 0.0f;
    int count = 1;
};

struct FlipResult {
    Image error; // one float channel
    FlipExposures exposures;
};

// Both want two pictures of one size, of any channels and types. Alpha is not looked at, gray is R = G = B;
// 8 and 16 bits are sRGB, floats are linear Rec.709. No pixel may be NaN or Inf.
FlipResult flip_ldr(const Image& reference, const Image& test, const FlipOptions& options, const Jobs& jobs);
// The largest LDR-FLIP error of each pixel over a range of exposures.
FlipResult flip_hdr(const Image& reference, const Image& test, const FlipOptions& options, const Jobs& jobs);

// The range of HDR-FLIP: from the exposure that brings the reference's largest luminance to 85 % of the tone
// curve, to the one that brings the median there. Unlike the published program, the median is that of pixels
// with light (luminance above 0): a black background of more than half the picture would make the range
// infinite. Without any light, or where a given start lies above what is found, the range is one point.
FlipExposures find_exposures(const Image& reference, const FlipOptions& options, const Jobs& jobs);

} // namespace burnish
