#include "apps/parity/stages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/base/check.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

// Maps floats to integers with the same order.
std::int64_t ordered(std::uint32_t bits)
{
    const std::int64_t magnitude = bits & 0x7fffffffu;
    return bits >> 31 ? -magnitude - 1 : magnitude;
}

class StageCounter {
  public:
    StageCounter(const char* name, int width) : width_(width) { stage_.name = name; }
    void add(std::uint32_t a, std::uint32_t b, std::size_t pixel)
    {
        ++stage_.values;
        if (a == b)
            return;
        ++stage_.words_differ;
        const std::uint64_t ulp = ulp_distance(a, b);
        if (ulp <= stage_.max_ulp)
            return;
        stage_.max_ulp = ulp;
        if (width_ > 0)
            stage_.worst_x = static_cast<int>(pixel) % width_, stage_.worst_y = static_cast<int>(pixel) / width_;
    }
    void add(const std::uint32_t* a, const std::uint32_t* b, int words, std::size_t pixel)
    {
        for (int i = 0; i < words; ++i)
            add(a[i], b[i], pixel);
    }
    const ParityStage& stage() const { return stage_; }

  private:
    ParityStage stage_;
    int width_;
};

std::uint32_t mask_at(const Frame& f, std::size_t sample)
{
    return f.stages.pairs[sample * kPairWords];
}

// Returns true if both frames have a pair that starts at this sample, with the same triangle and samples.
bool same_pair(const Frame& a, const Frame& b, std::size_t sample)
{
    return mask_at(a, sample) != 0 && mask_at(a, sample) == mask_at(b, sample) && a.triangle_ids[sample] == b.triangle_ids[sample];
}

// Returns true if both frames have the same pairs in a pixel: the same triangles on the same samples.
bool same_pairs(const Frame& a, const Frame& b, std::size_t pixel, std::size_t msaa)
{
    for (std::size_t s = pixel * msaa; s < (pixel + 1) * msaa; ++s)
        if (a.triangle_ids[s] != b.triangle_ids[s] || mask_at(a, s) != mask_at(b, s))
            return false;
    return true;
}

bool several_triangles(const Frame& f, std::size_t pixel, std::size_t msaa)
{
    const std::uint32_t* ids = f.triangle_ids.data() + pixel * msaa;
    return std::any_of(ids, ids + msaa, [&](std::uint32_t id) { return id != ids[0]; });
}

const std::uint32_t* color_words(const Frame& f, std::size_t pixel)
{
    return reinterpret_cast<const std::uint32_t*>(f.color.f32() + 3 * pixel);
}

const std::uint32_t* layer_words(const Frame& f, std::size_t pixel)
{
    return reinterpret_cast<const std::uint32_t*>(&f.layers[pixel]);
}

void count_pixel_differences(const Frame& tile, const Frame& other, std::size_t msaa, ParityCounts& out)
{
    const std::size_t pixels = tile.triangle_ids.size() / msaa;
    for (std::size_t p = 0; p < pixels; ++p) {
        if (std::memcmp(color_words(tile, p), color_words(other, p), 3 * sizeof(float)) == 0)
            continue;
        ++out.pixels_differ;
        out.edge_pixels_differ += several_triangles(tile, p, msaa);
    }
}

// Returns true if two vectors differ by more than kRounding times the largest component of either.
bool beyond_rounding(const std::uint32_t* a, const std::uint32_t* b, int words)
{
    double largest = 0.0, difference = 0.0;
    for (int i = 0; i < words; ++i) {
        const double x = static_cast<double>(std::bit_cast<float>(a[i])), y = static_cast<double>(std::bit_cast<float>(b[i]));
        if (!std::isfinite(x) || !std::isfinite(y))
            return a[i] != b[i];
        largest = std::max({largest, std::abs(x), std::abs(y)});
        difference = std::max(difference, std::abs(x - y));
    }
    return difference > kRounding * largest;
}

// Vector lengths inside a pair's words (shading/lang/recorded.h).
constexpr int kInterpolantVectors[] = {
#define BN_POINT(type, words, name, asked) words,
#define BN_INTERPOLATED(type, words, name, asked, first) words,
#include "shading/visible_point.def"
};
constexpr int kMaterialVectors[] = {
#define BN_INPUT(type, words, name) words,
#include "shading/material.def"
};

template <std::size_t N> bool any_beyond_rounding(const int (&vectors)[N], const std::uint32_t* a, const std::uint32_t* b)
{
    for (int words : vectors) {
        if (beyond_rounding(a, b, words))
            return true;
        a += words, b += words;
    }
    return false;
}

PixelCause pair_cause(const std::uint32_t* a, const std::uint32_t* b)
{
    if (any_beyond_rounding(kInterpolantVectors, a + 1, b + 1))
        return PixelCause::interpolants;
    if (any_beyond_rounding(kMaterialVectors, a + 1 + kInterpolantWords, b + 1 + kInterpolantWords))
        return PixelCause::material;
    return beyond_rounding(a + kPairWords - 3, b + kPairWords - 3, 3) ? PixelCause::shaded : PixelCause::rounding;
}

} // namespace

std::uint64_t ulp_distance(std::uint32_t a, std::uint32_t b)
{
    const std::int64_t distance = ordered(a) - ordered(b);
    return static_cast<std::uint64_t>(distance < 0 ? -distance : distance);
}

ParityCounts compare_stages(const Frame& tile, const Frame& other, int msaa)
{
    BN_CHECK_OP(tile.triangle_ids.size(), ==, other.triangle_ids.size());
    BN_CHECK_OP(tile.stages.pairs.size(), ==, other.stages.pairs.size());
    const std::size_t n = static_cast<std::size_t>(msaa), pixels = tile.triangle_ids.size() / n;
    const int width = tile.color.width;
    StageCounter clip("clip positions", 0), visibility(kVisibilityStage, width), depth("depth", width), interpolants("interpolants", width),
        material("material inputs", width), shaded("shaded colour", width), resolved("resolved colour", width), layers("layers", width);
    const bool have_layers = !tile.layers.empty() && !other.layers.empty();
    // Clip positions
    for (std::size_t i = 0; i < std::min(tile.stages.vertices.size(), other.stages.vertices.size()); ++i)
        clip.add(tile.stages.vertices[i], other.stages.vertices[i], 0);
    ParityCounts out;
    out.samples = tile.triangle_ids.size();
    // Each pixel, stage by stage
    for (std::size_t p = 0; p < pixels; ++p) {
        // Visibility and depth, by sample
        std::uint64_t differ = 0;
        for (std::size_t s = p * n; s < (p + 1) * n; ++s) {
            const bool same = tile.triangle_ids[s] == other.triangle_ids[s];
            visibility.add(same ? 0 : 1, 0, p);
            differ += !same;
            if (same)
                depth.add(tile.stages.depths[s], other.stages.depths[s], p);
        }
        const bool same = same_pairs(tile, other, p, n);
        if (!same && differ == 0) { // another piece of the same triangle
            visibility.add(1, 0, p);
            differ = 1;
        }
        out.visibility_differ += differ;
        // Pairs of one triangle and the same samples
        for (std::size_t s = p * n; s < (p + 1) * n; ++s) {
            if (!same_pair(tile, other, s))
                continue;
            const std::uint32_t *a = tile.stages.pairs.data() + s * kPairWords, *b = other.stages.pairs.data() + s * kPairWords;
            if (tile.triangle_ids[s] != kNoTriangle) {
                interpolants.add(a + 1, b + 1, kInterpolantWords, p);
                material.add(a + 1 + kInterpolantWords, b + 1 + kInterpolantWords, kMaterialWords, p);
            }
            shaded.add(a + kPairWords - 3, b + kPairWords - 3, 3, p);
        }
        // Whole pixels
        if (same)
            resolved.add(color_words(tile, p), color_words(other, p), 3, p);
        if (same && have_layers)
            layers.add(layer_words(tile, p), layer_words(other, p), kLayerWords, p);
    }
    // Collect the stages in order
    for (const StageCounter* c : {&clip, &visibility, &depth, &interpolants, &material, &shaded, &resolved})
        out.stages.push_back(c->stage());
    if (have_layers)
        out.stages.push_back(layers.stage());
    count_pixel_differences(tile, other, n, out);
    return out;
}

ParityStage compare_colours(const char* name, const Image& of_tile, const Image& of_other, const Frame& tile, const Frame& other, int msaa)
{
    const std::size_t n = static_cast<std::size_t>(msaa), pixels = tile.triangle_ids.size() / n;
    StageCounter counter(name, tile.color.width);
    for (std::size_t p = 0; p < pixels; ++p)
        if (same_pairs(tile, other, p, n))
            counter.add(reinterpret_cast<const std::uint32_t*>(of_tile.f32() + 3 * p),
                        reinterpret_cast<const std::uint32_t*>(of_other.f32() + 3 * p), 3, p);
    return counter.stage();
}

std::vector<PixelCause> pixel_causes(const Frame& tile, const Frame& other, int msaa)
{
    const std::size_t n = static_cast<std::size_t>(msaa), pixels = tile.triangle_ids.size() / n;
    std::vector<PixelCause> causes(pixels, PixelCause::none);
    for (std::size_t p = 0; p < pixels; ++p) {
        if (std::memcmp(color_words(tile, p), color_words(other, p), 3 * sizeof(float)) == 0)
            continue;
        if (!same_pairs(tile, other, p, n)) {
            causes[p] = PixelCause::visibility;
            continue;
        }
        PixelCause first = beyond_rounding(color_words(tile, p), color_words(other, p), 3) ? PixelCause::resolved : PixelCause::rounding;
        for (std::size_t s = p * n; s < (p + 1) * n; ++s)
            if (mask_at(tile, s))
                first = std::min(first, pair_cause(tile.stages.pairs.data() + s * kPairWords, other.stages.pairs.data() + s * kPairWords));
        causes[p] = first;
    }
    return causes;
}

std::vector<CauseShare> share_causes(const std::vector<PixelCause>& causes, const Frame& tile, int msaa, const float* flip)
{
    CauseShare sums[kPixelCauses];
    for (std::size_t p = 0; p < causes.size(); ++p) {
        CauseShare& sum = sums[static_cast<int>(causes[p])];
        ++sum.pixels;
        sum.edge_pixels += several_triangles(tile, p, static_cast<std::size_t>(msaa));
        sum.flip += flip ? static_cast<double>(flip[p]) / static_cast<double>(causes.size()) : 0.0;
    }
    std::vector<CauseShare> shares;
    for (int i = 0; i < kPixelCauses; ++i) {
        sums[i].cause = static_cast<PixelCause>(i);
        if (sums[i].pixels)
            shares.push_back(sums[i]);
    }
    return shares;
}

const ParityStage* first_difference(const ParityCounts& counts)
{
    for (const ParityStage& stage : counts.stages)
        if (!stage.equal())
            return &stage;
    return nullptr;
}

} // namespace burnish
