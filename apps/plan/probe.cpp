#include "apps/plan/probe.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "apps/plan/cost.h"
#include "core/base/clock.h"
#include "core/image/metrics/flip.h"
#include "core/math/scalar_math.h"
#include "core/scene/draw_tables.h"
#include "shading/lang/records.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

constexpr double kLeastPixels = 14400;          // in a probe, unless the step would be below
constexpr int kLeastStep = 4, kMostStep = 8;    // frame pixels along a probe pixel's side
constexpr float kProbePpd = 0.5f * kDefaultPpd; // between the frame's filter and one as fine as the probe
constexpr int kRandomSamples = 32;              // of mc, for each of two seeds
constexpr std::uint32_t kSeeds[] = {0x51ed270b, 0x2545f491};
constexpr double kPriorShare = 0.25; // the best prefiltered setting's error over its distance to a single fetch; see the notebook
constexpr double kLeastShare = 0.05; // the same at least
constexpr double kMostShare = 0.8;   // the same at most: where noise is skewed, two noisy pictures deceive
constexpr double kNoiseOff = 0.2;    // the noise's relative deviation, as two noisy pictures tell
// FLIP grows with this power of a distance between colours (Andersson et al. 2020, section 4.1).
constexpr double kFlipExponent = 0.7;
constexpr int kBlock = 8;         // pixels along a block's side; blocks' errors count as independent
constexpr int kMostExposures = 6; // for HDR-FLIP, over the frame's range
constexpr int kUnseen = -1;

// The probe pixels' materials; kUnseen for pixels without a solid surface, or with blended surfaces before it.
struct PixelMaterials {
    std::vector<int> of; // [pixel]
    int width = 0, height = 0;
    std::vector<double> pixels; // of each material
};

PixelMaterials materials_of(const Frame& frame, const DrawTables& tables, std::size_t count)
{
    PixelMaterials m;
    m.pixels.assign(count, 0.0);
    m.width = frame.color.width, m.height = frame.color.height;
    m.of.assign(frame.triangle_ids.size(), kUnseen);
    for (std::size_t p = 0; p < m.of.size(); ++p) {
        const std::uint32_t id = frame.triangle_ids[p];
        if (id != kNoTriangle && (frame.through.empty() || frame.through[p] == 1.0f))
            m.of[p] = static_cast<int>(tables.triangle_material[id]), m.pixels[tables.triangle_material[id]] += 1.0;
    }
    return m;
}

// Squared distance between colours that a FLIP error stands for, and back. Independent errors' squares add.
double squared(double flip)
{
    return det_pow(std::max(0.0, flip), 2.0 / kFlipExponent);
}
double flip_of(double square)
{
    return det_pow(std::max(0.0, square), 0.5 * kFlipExponent);
}

// Returns one noisy picture's squared error to the exact picture, relative to two noisy ones'.
double squared_error_of_one()
{
    return flip_of(0.5) * flip_of(0.5);
}

// Returns the mean error over each material's pixels.
std::vector<double> mean_errors(const Image& error, const PixelMaterials& materials)
{
    std::vector<double> sums(materials.pixels.size(), 0.0);
    for (std::size_t p = 0; p < materials.of.size(); ++p)
        if (materials.of[p] != kUnseen)
            sums[static_cast<std::size_t>(materials.of[p])] += static_cast<double>(error.f32()[p]);
    for (std::size_t m = 0; m < sums.size(); ++m)
        sums[m] /= std::max(1.0, materials.pixels[m]);
    return sums;
}

// Error moments over a material's pixels: for a picture against noisy ones, and for one noisy picture.
struct Moments {
    double mean = 0.0, square = 0.0, noise_square = 0.0; // mean error, squared errors' means
    double deviation = 0.0;                              // standard error of `square` - `noise_square`
};

// of_a, of_b: the picture's errors against two independent noisy ones; of_noise: errors between these two. Pixel blocks tell the
// deviation.
std::vector<Moments> moments_of(const Image& of_a, const Image& of_b, const Image& of_noise, const PixelMaterials& materials)
{
    // Sums over a block's pixels with one material, and over blocks
    struct Block {
        double mean = 0.0, square = 0.0, noise_square = 0.0, pixels = 0.0;
    };
    struct Blocks {
        double risen2 = 0.0, risen_pixels = 0.0, pixels2 = 0.0; // risen: square - noise_square
    };
    const double of_one = squared_error_of_one();
    std::vector<Moments> out(materials.pixels.size());
    std::vector<Block> block(out.size());
    std::vector<Blocks> blocks(out.size());
    std::vector<std::size_t> touched;
    for (int y0 = 0; y0 < materials.height; y0 += kBlock)
        for (int x0 = 0; x0 < materials.width; x0 += kBlock) {
            for (int y = y0; y < std::min(y0 + kBlock, materials.height); ++y)
                for (int x = x0; x < std::min(x0 + kBlock, materials.width); ++x) {
                    const std::size_t p =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(materials.width) + static_cast<std::size_t>(x);
                    if (materials.of[p] == kUnseen)
                        continue;
                    const std::size_t m = static_cast<std::size_t>(materials.of[p]);
                    const double a = static_cast<double>(of_a.f32()[p]), b = static_cast<double>(of_b.f32()[p]),
                                 noise = static_cast<double>(of_noise.f32()[p]);
                    Block& to = block[m];
                    if (to.pixels == 0.0)
                        touched.push_back(m);
                    to.mean += 0.5 * (a + b), to.square += 0.5 * (a * a + b * b), to.noise_square += of_one * noise * noise;
                    to.pixels += 1.0;
                }
            for (const std::size_t m : touched) {
                const Block s = std::exchange(block[m], Block{});
                const double pixels = materials.pixels[m], risen = s.square - s.noise_square;
                out[m].mean += s.mean / pixels, out[m].square += s.square / pixels, out[m].noise_square += s.noise_square / pixels;
                blocks[m].risen2 += risen * risen, blocks[m].risen_pixels += risen * s.pixels, blocks[m].pixels2 += s.pixels * s.pixels;
            }
            touched.clear();
        }
    for (std::size_t m = 0; m < out.size(); ++m) {
        const double mean = out[m].square - out[m].noise_square;
        const double squares = blocks[m].risen2 - 2.0 * mean * blocks[m].risen_pixels + mean * mean * blocks[m].pixels2;
        out[m].deviation = std::sqrt(std::max(0.0, squares)) / std::max(1.0, materials.pixels[m]);
    }
    return out;
}

bool prefiltered(const MaterialTechnique& m)
{
    return !(find_technique(m.technique)->traits & kSamplesLobe);
}

// Returns the error of mc with a setting's samples, relative to one noisy picture's.
double random_share(const MaterialTechnique& s)
{
    return flip_of(static_cast<double>(kRandomSamples) / static_cast<double>(s.samples));
}

// Returns the best prefiltered setting's mean error on a material. The measured error without its noise counts as far as this error exceeds
// its deviation. A guess by the distance to a single fetch counts for the rest.
double own_error(const Moments& m, double fetch)
{
    const double guess = kPriorShare * fetch, least = kLeastShare * fetch, risen = std::max(0.0, m.square - m.noise_square);
    const double square = squared(std::sqrt(m.square)) - squared(std::sqrt(m.noise_square));
    const double measured = flip_of(square) * m.mean / std::max(1e-30, std::sqrt(m.square));
    const double off = kNoiseOff * m.noise_square, variance = m.deviation * m.deviation + off * off;
    const double weight = risen * risen / std::max(1e-30, risen * risen + variance);
    return std::clamp(guess + weight * (measured - guess), least, kMostShare * fetch);
}

double sum_of(const Image& error)
{
    const std::size_t pixels = error.bytes.size() / sizeof(float);
    return std::accumulate(error.f32(), error.f32() + pixels, 0.0);
}

// Returns two noisy pictures' error as FLIP filters a frame, relative to `error`, as it filters the probe.
double noise_filter(const Image& a, const Image& b, const Image& error, FlipOptions flip, const Jobs& jobs)
{
    flip.ppd = kDefaultPpd;
    return sum_of(flip_hdr(a, b, flip, jobs).error) / std::max(1e-30, sum_of(error));
}

FrameDesc probe_desc(const FrameDesc& desc)
{
    FrameDesc d = desc;
    const double pixels = static_cast<double>(desc.width) * desc.height;
    const int step = std::clamp(static_cast<int>(std::sqrt(pixels / kLeastPixels)), kLeastStep, kMostStep);
    d.width = (desc.width + step - 1) / step, d.height = (desc.height + step - 1) / step, d.msaa = 1;
    d.by_material.clear();
    d.stages = d.profile = d.parts = d.layers = d.triangle_ids = false;
    return d;
}

} // namespace

std::vector<MaterialTechnique> plannable_settings()
{
    std::vector<MaterialTechnique> list;
    for (const PlanCost& c : plan_costs())
        list.push_back({c.technique, c.samples});
    return list;
}

Result<Probe> probe_frame(Session& session, const FrameDesc& desc, const std::vector<MaterialTechnique>& settings, bool by_pixel)
{
    const Jobs& jobs = *session.parts().jobs;
    const std::size_t count = session.scene().materials.size();
    FrameDesc small = probe_desc(desc);
    const auto draw = [&](const MaterialTechnique& by, std::uint32_t seed) {
        small.technique = by.technique, small.samples = by.samples, small.seed = seed;
        return session.render(small);
    };
    // Draw the best prefiltered setting, with the pixels' materials and lobes
    small.layers = small.triangle_ids = true;
    const std::vector<MaterialTechnique> all = plannable_settings();
    const MaterialTechnique& best = *std::find_if(all.rbegin(), all.rend(), prefiltered);
    const Result<Frame> first = draw(best, desc.seed);
    BN_TRY(first);
    small.layers = small.triangle_ids = false;
    const PixelMaterials materials = materials_of(*first, session.tables(), count);
    const PixelLobes lobes = lobes_of(*first, small);
    // Draw two independent noisy pictures, and note their processor time
    const double begin = process_cpu_ms();
    const Result<Frame> one = draw({"mc", kRandomSamples}, kSeeds[0]), other = draw({"mc", kRandomSamples}, kSeeds[1]);
    BN_TRY(one);
    BN_TRY(other);
    const double noisy_ms = 0.5 * (process_cpu_ms() - begin);
    FlipOptions flip;
    const FlipExposures range = find_exposures(first->color, flip, jobs);
    flip.start_ev = range.start_ev, flip.stop_ev = range.stop_ev, flip.exposures = std::min(range.count, kMostExposures);
    flip.ppd = kProbePpd;
    const auto error_of = [&](const Image& a, const Image& b) { return flip_hdr(a, b, flip, jobs).error; };
    const Image of_noise = error_of(one->color, other->color);
    const Image of_one = error_of(first->color, one->color), of_other = error_of(first->color, other->color);
    const std::vector<Moments> moments = moments_of(of_one, of_other, of_noise, materials);
    // Noise has no scale: filter it as the frame's is filtered
    const double filtered = noise_filter(one->color, other->color, of_noise, flip, jobs);
    std::vector<double> noise = mean_errors(of_noise, materials);
    for (double& n : noise)
        n *= filtered * flip_of(0.5);
    // Find each setting's distance to the best one
    std::vector<std::vector<double>> distances;
    std::vector<Image> maps;                               // of the distances
    std::vector<double> fetch(count, 1.0);                 // the better single fetch's
    std::vector<std::size_t> fetch_map(count, all.size()); // its index
    double fetch_ms = noisy_ms;
    for (const MaterialTechnique& s : all) {
        distances.emplace_back(count, 0.0);
        maps.emplace_back();
        if (!prefiltered(s) || (s.technique == best.technique && s.samples == best.samples))
            continue;
        const double before = process_cpu_ms();
        const Result<Frame> frame = draw(s, desc.seed);
        BN_TRY(frame);
        if (s.samples == 1)
            fetch_ms = std::min(fetch_ms, process_cpu_ms() - before);
        maps.back() = error_of(first->color, frame->color);
        distances.back() = mean_errors(maps.back(), materials);
        for (std::size_t m = 0; m < count && s.samples == 1; ++m)
            if (distances.back()[m] < fetch[m])
                fetch[m] = distances.back()[m], fetch_map[m] = maps.size() - 1;
    }
    // Find the best setting's own error
    std::vector<double> own(count, 0.0);
    for (std::size_t m = 0; m < count; ++m)
        own[m] = own_error(moments[m], fetch[m]);
    // Put the settings' errors together
    Probe probe;
    probe.width = small.width, probe.height = small.height;
    probe.materials.resize(count);
    double instructions = 0.0;
    for (std::size_t m = 0; m < count; ++m)
        instructions += materials.pixels[m] * random_over_fetch(kRandomSamples);
    probe.ms_per_instruction = std::max(0.0, noisy_ms - fetch_ms) / std::max(1.0, instructions);
    const TechniqueInfo& automatic = technique_of(FrameDesc{});
    const std::vector<double> default_costs = mean_costs({automatic.name, automatic.default_samples}, lobes, materials.of, count);
    for (std::size_t m = 0; m < count; ++m)
        probe.materials[m].share = materials.pixels[m] / static_cast<double>(materials.of.size()),
        probe.materials[m].default_cost = default_costs[m];
    for (const MaterialTechnique& s : settings) {
        const std::vector<double> costs = mean_costs(s, lobes, materials.of, count);
        const std::size_t at = static_cast<std::size_t>(
            std::find_if(all.begin(), all.end(),
                         [&](const MaterialTechnique& a) { return a.technique == s.technique && a.samples == s.samples; }) -
            all.begin());
        for (std::size_t m = 0; m < count; ++m) {
            if (materials.pixels[m] == 0.0)
                continue;
            const double random = noise[m] * random_share(s);
            const double error = prefiltered(s) ? flip_of(squared(distances[at][m]) + squared(own[m])) : random;
            probe.materials[m].settings.push_back({s, error, costs[m]});
        }
        if (!by_pixel)
            continue;
        probe.pixels.error.emplace_back(materials.of.size(), 0.0f);
        for (std::size_t p = 0; p < materials.of.size(); ++p) {
            if (materials.of[p] == kUnseen)
                continue;
            const std::size_t m = static_cast<std::size_t>(materials.of[p]);
            const double distance = maps[at].bytes.empty() ? 0.0 : static_cast<double>(maps[at].f32()[p]);
            const double part =
                fetch_map[m] < all.size() ? static_cast<double>(maps[fetch_map[m]].f32()[p]) / std::max(1e-30, fetch[m]) : 1.0;
            const double random = static_cast<double>(of_noise.f32()[p]) * filtered * flip_of(0.5) * random_share(s);
            probe.pixels.error.back()[p] =
                static_cast<float>(prefiltered(s) ? flip_of(squared(distance) + squared(own[m] * part)) : random);
        }
    }
    if (by_pixel)
        probe.pixels.material = materials.of;
    return probe;
}

} // namespace burnish
