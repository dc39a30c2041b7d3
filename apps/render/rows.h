// Picture rows, drawn through windows. Their pixels have the whole picture's bits.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/options/options.h"
#include "apps/render/stats.h"
#include "core/base/hash.h"
#include "raster/frame/profile.h"
#include "raster/session/session.h"

namespace burnish {

// A band's rows, in each form that some output needs.
struct DrawnBand {
    Image linear;                   // f32, RGB or RGBA
    Image layered;                  // f32, with --aov
    std::vector<std::string> names; // of its channels
    Image shown;                    // u8, for .png
    FrameStats stats;
    std::uint64_t nan_pixels = 0;
    std::array<std::uint64_t, kFrameStages> stage_ns = {}; // if FrameDesc::profile
};

struct Bands {
    const RenderOptions& options;
    FrameDesc desc; // of the first window
    Session& session;
    const RenderFigures& figures;
    bool margin = false; // pixels read their neighbours, so windows reach beyond the band

    int width() const { return picture_width(desc); }
    int height() const { return picture_height(desc); }
    int count() const { return (height() + options.band_rows - 1) / options.band_rows; }
    int rows(int band) const { return std::min(options.band_rows, height() - band * options.band_rows); }
    bool in_cells() const { return std::max(width(), height()) > kMaxPictureSide; }
};

bool writes_png(const RenderOptions& options);

// Returns true if the picture's pixels read their neighbours.
bool has_margin(const RenderOptions& options, const FrameDesc& desc, const Session& session);

// Draws the rows from `top` on; kWindowStep divides `top`. Fails with ExitCode::usage at FrameDesc::window for pictures that are drawn as a
// whole.
Result<DrawnBand> draw_rows(const Bands& bands, int top, int rows);

// Adds up windows' figures.
void add_stats(const FrameStats& from, FrameStats& to);

// A picture's hash, as pixel_hash(), from its bands.
class BandHash {
  public:
    BandHash(int width, int height);
    void add(const Image& band);
    std::uint64_t value() const { return hash_.value(); }

  private:
    HashStream hash_;
};

} // namespace burnish
