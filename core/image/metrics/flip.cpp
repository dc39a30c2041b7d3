// Drives FLIP over an image: tiles in parallel, each with a ring of rows. Rows in the ring are filtered along x and
// wait for the filters along y. A pixel's error depends only on nearby pixels, so neither tile order nor threads change
// a bit.
#include "core/image/metrics/flip.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/check.h"
#include "core/base/column.h"
#include "core/image/io/linear_rows.h"
#include "core/image/metrics/flip_filters.h"
#include "core/image/metrics/flip_lanes.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

// A ring of 256 columns fits the L2 cache. The tile above also filters the first rows of the ring.
constexpr int kTileWidth = 256, kTileHeight = 128; // pixels, a multiple of every lane count
constexpr double kMostStops = 120.0;               // 2^120 is still a finite float
constexpr int kPad = 16;                           // floats that lanes may touch beyond a row's end

// Returns the tone curve (c0 x^2 + c1 x + c2) / (c3 x^2 + c4 x + c5) of Andersson et al. 2021. ACES is Narkowicz's fit
// without its exposure of 0.6. Reinhard works on the luminance.
FlipTone tone_of(FlipTonemap tonemap)
{
    FlipTone tone;
    tone.curve = tonemap == FlipTonemap::reinhard ? FlipTone::reinhard : FlipTone::rational;
    constexpr float kCurves[3][6] = {{0.36f * 2.51f, 0.6f * 0.03f, 0.0f, 0.36f * 2.43f, 0.6f * 0.59f, 0.14f},
                                     {0.0f, 1.0f, 0.0f, 0.0f, 1.0f, 1.0f},
                                     {0.231683f, 0.013791f, 0.0f, 0.18f, 0.3f, 0.018f}};
    std::copy_n(kCurves[static_cast<int>(tonemap)], 6, tone.c);
    return tone;
}

// Returns the brightness that the curve maps to t: the larger root of (c0 - t c3) x^2 + (c1 - t c4) x + (c2 - t c5) =
// 0.
double inverse_tone(const FlipTone& tone, double t)
{
    const auto coefficient = [&](int i) { return static_cast<double>(tone.c[i]) - t * static_cast<double>(tone.c[i + 3]); };
    const double a = coefficient(0), b = coefficient(1), c = coefficient(2);
    if (a == 0.0)
        return -c / b;
    const double half = -0.5 * b / a, root = std::sqrt(half * half - c / a);
    return half + root; // a > 0 > c in ACES and Hable: the other root is negative
}

double log2_of(double x)
{
    return det_log(x) / 0.69314718055994531;
}

struct Pass {
    const LinearRows& reference;
    const LinearRows& test;
    const FlipKernels& kernels;
    const FlipFns& fns;
    std::vector<FlipTone> tones; // the error is the maximum over these curves
    Image& error;
};

struct Tile {
    int x0, y0, width, height;
};

class TileWorker {
  public:
    void run(const Pass& pass, const Tile& tile)
    {
        radius_ = pass.kernels.radius();
        reserve();
        load(pass, tile);
        for (std::size_t i = 0; i < pass.tones.size(); ++i)
            run_tone(pass, tile, pass.tones[i], i > 0);
    }

  private:
    static constexpr int kStride = kTileWidth;

    void reserve()
    {
        row_stride_ = kTileWidth + 2 * radius_ + kPad;
        slots_ = 2 * radius_ + kFlipRows;
        linear_.resize(static_cast<std::size_t>(kTileHeight + 2 * radius_) * 2 * row_floats());
        pixels_.resize(row_floats());
        ring_.resize(static_cast<std::size_t>(slots_) * 2 * kFlipPlanes * kStride);
        rows_.resize(static_cast<std::size_t>(slots_));
        differing_.resize(static_cast<std::size_t>(kTileHeight + 2 * radius_) + 1);
    }

    std::size_t row_floats() const { return 3 * static_cast<std::size_t>(row_stride_); }

    // Returns row y of image 0 (reference) or 1 (test): planes of linear R, G, B from the left edge of the tile's ring
    // on.
    float* linear(int y, int picture) { return linear_.data() + static_cast<std::size_t>(2 * (y - first_row_) + picture) * row_floats(); }

    float* slot(int y) { return ring_.data() + static_cast<std::size_t>(y % slots_) * 2 * kFlipPlanes * kStride; }

    // Loads the tile once for all exposures, and counts the rows that differ. Renderings of one scene often agree in
    // parts, such as the background, and run_tone() skips those.
    void load(const Pass& pass, const Tile& tile)
    {
        first_row_ = std::max(0, tile.y0 - radius_);
        end_row_ = std::min(pass.error.height, tile.y0 + tile.height + radius_);
        for (int y = first_row_; y < end_row_; ++y)
            for (int picture = 0; picture < 2; ++picture) {
                float* r = linear(y, picture);
                (picture ? pass.test : pass.reference)
                    .read(y, tile.x0 - radius_, tile.width + 2 * radius_, r, r + row_stride_, r + 2 * row_stride_);
            }
        for (int y = first_row_; y < end_row_; ++y) {
            const std::size_t i = static_cast<std::size_t>(y - first_row_);
            differing_[i + 1] = differing_[i] + !equal_rows(linear(y, 0), linear(y, 1), tile.width + 2 * radius_);
        }
    }

    bool equal_rows(const float* a, const float* b, int n) const
    {
        for (int plane = 0; plane < 3; ++plane)
            if (std::memcmp(a + plane * row_stride_, b + plane * row_stride_, static_cast<std::size_t>(n) * sizeof(float)) != 0)
                return false;
        return true;
    }

    // Returns true where rows [begin, end), clipped to the loaded rows, hold any difference.
    bool differ(int begin, int end) const
    {
        const auto before = [&](int y) { return differing_[static_cast<std::size_t>(std::clamp(y, first_row_, end_row_) - first_row_)]; };
        return before(begin) != before(end);
    }

    void run_tone(const Pass& pass, const Tile& tile, const FlipTone& tone, bool keep_larger)
    {
        const int last_row = pass.error.height - 1, tile_end = tile.y0 + tile.height;
        int next = first_row_;
        for (int y = tile.y0; y < tile_end; y += kFlipRows) {
            if (!differ(y - radius_, y + radius_ + kFlipRows))
                continue; // equal pixels have no error, and errors start at 0
            // Filter the rows that this block needs and no earlier block has filtered
            next = std::max(next, y - radius_);
            for (; next < std::min(end_row_, y + radius_ + kFlipRows); ++next)
                for (int picture = 0; picture < 2; ++picture)
                    filter_row(pass, tile, tone, linear(next, picture), slot(next) + picture * kFlipPlanes * kStride);
            // Finish the block from the ring's rows
            for (int k = -radius_; k < radius_ + kFlipRows; ++k)
                rows_[static_cast<std::size_t>(k + radius_)] = slot(std::clamp(y + k, 0, last_row));
            float* to[kFlipRows];
            for (int j = 0; j < kFlipRows; ++j)
                to[j] = pass.error.f32() +
                        static_cast<std::size_t>(std::min(y + j, last_row)) * static_cast<std::size_t>(pass.error.width) +
                        static_cast<std::size_t>(tile.x0);
            pass.fns.finish(pass.kernels.lanes(), rows_.data(), radius_, kStride, tile.width, keep_larger, to, tile_end - y);
        }
    }

    void filter_row(const Pass& pass, const Tile& tile, const FlipTone& tone, const float* from, float* to)
    {
        float* y = pixels_.data();
        pass.fns.prepare(tone, tile.width + 2 * radius_, row_stride_, from, y);
        y += radius_;
        pass.fns.filter(pass.kernels.lanes(), y, y + row_stride_, y + 2 * row_stride_, tile.width, kStride, to);
    }

    int radius_ = 0, row_stride_ = 0, slots_ = 0;
    int first_row_ = 0, end_row_ = 0; // rows of the tile with its ring
    Column<float> linear_, pixels_, ring_;
    std::vector<int> differing_; // for each row of the tile with its ring: number of differing rows before it
    std::vector<const float*> rows_;
};

Image run_pass(const Image& reference, const Image& test, const FlipOptions& options, std::vector<FlipTone> tones, const Jobs& jobs)
{
    BN_CHECK_OP(reference.width, ==, test.width);
    BN_CHECK_OP(reference.height, ==, test.height);
    BN_CHECK(options.ppd >= kMinPpd && options.ppd <= kMaxPpd);
    Image error = make_image(reference.width, reference.height, 1, PixelType::f32);
    const FlipKernels kernels(static_cast<double>(options.ppd));
    const LinearRows reference_rows(reference), test_rows(test);
    const Pass pass{reference_rows, test_rows, kernels, pick<FlipFns>(options.isa.value_or(best_isa())), std::move(tones), error};

    const int columns = (error.width + kTileWidth - 1) / kTileWidth, rows = (error.height + kTileHeight - 1) / kTileHeight;
    std::vector<TileWorker> workers(static_cast<std::size_t>(jobs.threads()));
    jobs.parallel_for(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), [&](std::size_t i, int worker) {
        const int x0 = static_cast<int>(i) % columns * kTileWidth, y0 = static_cast<int>(i) / columns * kTileHeight;
        workers[static_cast<std::size_t>(worker)].run(
            pass, {x0, y0, std::min(kTileWidth, error.width - x0), std::min(kTileHeight, error.height - y0)});
    });
    return error;
}

} // namespace

Result<FlipTonemap> parse_flip_tonemap(const std::string& name)
{
    if (name == "aces")
        return FlipTonemap::aces;
    if (name == "reinhard")
        return FlipTonemap::reinhard;
    if (name == "hable")
        return FlipTonemap::hable;
    return Error{ExitCode::usage, "", "", "unknown tonemapper \"" + name + "\" (aces, reinhard, hable)"};
}

FlipResult flip_ldr(const Image& reference, const Image& test, const FlipOptions& options, const Jobs& jobs)
{
    return {run_pass(reference, test, options, {FlipTone{}}, jobs), {}};
}

FlipResult flip_hdr(const Image& reference, const Image& test, const FlipOptions& options, const Jobs& jobs)
{
    const FlipExposures range = find_exposures(reference, options, jobs);
    std::vector<FlipTone> tones;
    for (int i = 0; i < range.count; ++i) {
        const double step = range.count == 1 ? 0.0 : static_cast<double>(i) / (range.count - 1);
        const double start = static_cast<double>(range.start_ev), stop = static_cast<double>(range.stop_ev);
        FlipTone tone = tone_of(options.tonemap);
        tone.scale = static_cast<float>(det_exp((start + step * (stop - start)) * 0.69314718055994531));
        tones.push_back(tone);
    }
    return {run_pass(reference, test, options, std::move(tones), jobs), range};
}

FlipExposures find_exposures(const Image& reference, const FlipOptions& options, const Jobs& jobs)
{
    FlipExposures range;
    double start = 0.0, stop = 0.0;
    if (!options.start_ev || !options.stop_ev) {
        const LitLuminances lit = LinearRows(reference).lit_luminances(jobs);
        if (lit.largest > 0.0f) {
            const double target = inverse_tone(tone_of(options.tonemap), 0.85);
            start = log2_of(target / static_cast<double>(lit.largest));
            stop = log2_of(target / static_cast<double>(lit.median));
        }
    }
    const auto bounded = [](double ev) { return static_cast<float>(std::clamp(ev, -kMostStops, kMostStops)); };
    range.start_ev = options.start_ev.value_or(bounded(start));
    range.stop_ev = options.stop_ev.value_or(bounded(stop));
    // With one value given, the found value may lie beyond it.
    if (options.start_ev)
        range.stop_ev = std::max(range.start_ev, range.stop_ev);
    range.start_ev = std::min(range.start_ev, range.stop_ev);
    const int stops = static_cast<int>(std::ceil(std::min(range.stop_ev - range.start_ev, static_cast<float>(kMaxFlipExposures))));
    range.count = options.exposures > 0 ? options.exposures : std::clamp(stops, 2, kMaxFlipExposures);
    return range;
}

} // namespace burnish
