#include "raster/reference/reference_renderer.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "core/base/check.h"
#include "core/jobs/control.h"
#include "core/simd/cpu.h"
#include "raster/frame/frame_record.h"
#include "raster/rays/ray_tree.h"
#include "raster/reference/accumulator.h"
#include "raster/reference/checkpoint.h"
#include "raster/reference/embree_scene.h"
#include "raster/reference/ray_range.h"
#include "raster/reference/scene_key.h"

namespace burnish {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

void trace_packet(const RayScene& scene, RayPacket& rays, RayKind kind)
{
    scene.trace(rays, kind);
}

Links links_of(const ReferenceOptions& options)
{
    return options.own_checkpoint ? Links::refuse : Links::follow;
}

struct BlockRange {
    std::size_t begin, end;
};

FrameDesc with_msaa(FrameDesc desc, int msaa)
{
    desc.msaa = msaa;
    return desc;
}

bool keeps(const ReferenceOptions& options)
{
    return !options.checkpoint.empty() || !options.checkpoint_folder.empty();
}

Status check_options(const ReferenceOptions& o)
{
    if (o.samples < 1 || o.samples > kMaxReferenceSamples)
        return Error{ExitCode::usage, "", "", "samples must lie in 1..2^32"};
    if (o.shades < 1 || o.shades > kPassShades)
        return Error{ExitCode::usage, "", "", "shades must lie in 1..4"};
    if (o.part && o.target_error > 0.0)
        return Error{ExitCode::usage, "", "", "ReferenceOptions::target_error is of whole pictures"};
    if (o.part && keeps(o))
        return Error{ExitCode::usage, "", "", "ReferenceOptions::checkpoint is of whole pictures"};
    const std::uint64_t passes = reference_passes(o.part && o.part->samples ? o.part->samples : o.samples, o.shades);
    if (o.part && o.part->first_pass % std::bit_ceil(passes) != 0)
        return Error{ExitCode::usage, "", "", "ReferencePart::first_pass must be a multiple of the power of two from its passes on"};
    if (o.bounces < 0)
        return Error{ExitCode::usage, "", "", "bounces must not be negative"};
    return {};
}

// Returns an extracted light as a directional one.
LightRecord directional_light(const ExtractedLightRecord& from)
{
    LightRecord light = {};
    light.directional = 1;
    for (int k = 0; k < 3; ++k)
        light.direction[k] = -from.direction[k], light.radiant[k] = from.irradiance[k];
    return light;
}

class ReferenceRenderer final : public Renderer {
  public:
    ReferenceRenderer(const RenderInput& input, const ReferenceOptions& options, std::unique_ptr<RayScene> rays)
        : input_(input), options_(options), fns_(pick<ReferenceFns>(options.isa)), rays_(std::move(rays)), maker_(input),
          sampler_(make_environment_sampler(input.environment.picture(), input.jobs))
    {
    }
    Result<Frame> render(const FrameDesc& desc, Frame) override;
    std::string device() const override { return cpu_name() + " (" + isa_name(options_.isa) + ", " + rays_->description() + ")"; }

  private:
    ReferenceParams params(const FrameDesc& desc);
    void add_extracted_lights(ReferenceParams& f);
    Result<Accumulator> integrate(const FrameDesc& desc, const ReferenceParams& f, SamplingStats& stats);
    Status add_light(const FrameDesc& desc, const ReferenceParams& f, Frame& frame);
    void advance(const ReferenceParams& f, Accumulator& a, std::uint32_t passes, BlockRange blocks);
    std::uint64_t pass_samples() const { return static_cast<std::uint64_t>(kPassPositions * options_.shades); }
    bool stopped() const { return options_.stop && options_.stop->load(std::memory_order_relaxed); }

    RenderInput input_;
    ReferenceOptions options_;
    const ReferenceFns& fns_;
    std::unique_ptr<RayScene> rays_;
    FrameMaker maker_;
    EnvironmentSampler sampler_;
    std::vector<ReferenceScratch> workers_;
    std::vector<LightRecord> lights_; // with lamps_only
};

// Puts the extracted lights behind the punctual ones.
void ReferenceRenderer::add_extracted_lights(ReferenceParams& f)
{
    lights_.assign(f.lights, f.lights + f.light_count);
    std::transform(f.extracted_lights, f.extracted_lights + f.extracted_light_count, std::back_inserter(lights_), directional_light);
    f.lights = lights_.data(), f.light_count = static_cast<int>(lights_.size());
}

ReferenceParams ReferenceRenderer::params(const FrameDesc& desc)
{
    ReferenceParams f = {};
    FrameDesc own = reference_desc(desc);
    own.glass = 0; // rays find the other interfaces
    static_cast<ShadingFrame&>(f) = maker_.make(own);
    for (const MaterialRecord& m : maker_.materials()) {
        f.any_alpha = f.any_alpha || m.alpha_mode != kAlpha_opaque;
        f.solid_lights = f.solid_lights || m.emitter >= kSolidEmitter;
    }
    f.ray_epsilon = 1e-6f * glm::length(input_.tables.bounds_max - input_.tables.bounds_min);
    f.sampler = sampler_.view;
    f.mode = options_.mode, f.strategy = options_.strategy, f.bounces = options_.bounces;
    f.full_textures = options_.full_textures, f.shades = options_.shades;
    f.lights_only = options_.area_lights_only || options_.lamps_only;
    if (f.lights_only)
        f.background = 0;
    if (options_.area_lights_only)
        f.light_count = 0;
    if (options_.lamps_only)
        f.area_light_count = 0, add_extracted_lights(f);
    f.sobol = &sobol_table();
    f.rays = rays_.get();
    f.trace = trace_packet;
    return f;
}

// Advances blocks to `passes`. Ends early, between blocks, if asked to stop.
void ReferenceRenderer::advance(const ReferenceParams& f, Accumulator& a, std::uint32_t passes, BlockRange blocks)
{
    const bool last = a.last_passes != 0 && passes == a.last_passes;
    if (!last)
        reserve_sums(a, passes);
    PixelState* sums[kMostSums];
    std::transform(a.sums.begin(), a.sums.end(), sums, [](Column<PixelState>& s) { return s.data(); });
    input_.jobs.parallel_for(blocks.end - blocks.begin, [&](std::size_t k, int worker) {
        const std::size_t i = blocks.begin + k;
        PixelBlock block = block_of(a, i, passes);
        block.totals = last ? a.totals.data() : nullptr;
        if (block.passes == 0 || stopped())
            return;
        fns_.add_passes(f, block, workers_[static_cast<std::size_t>(worker)], sums);
        a.passes[i] = block.done + block.passes;
    });
}

constexpr std::uint64_t kRoundSamples = 1u << 22;

// Returns the passes that blocks take at once. Between two error checks: some million samples. They depend on the picture's size alone, so
// a run's end does not depend on its speed. Without such checks a power of two, so few partial sums are kept for the whole picture.
std::uint32_t passes_in_round(const FrameDesc& desc, std::uint64_t pass_samples, bool checks_error)
{
    constexpr std::uint32_t kUncheckedPasses = 32;
    if (!checks_error)
        return kUncheckedPasses;
    const std::uint64_t samples = static_cast<std::uint64_t>(desc.width) * static_cast<std::uint64_t>(desc.height) * pass_samples;
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(1, kRoundSamples / samples));
}

// Returns the blocks between two looks at the clock for the checkpoint: one pass over a large picture may take minutes. Threads wait for
// each other after them, so each thread has several.
std::size_t blocks_in_slice(std::uint32_t passes, int threads)
{
    constexpr std::size_t kFewest = 64, kOfThread = 8;
    return std::max({kFewest, kOfThread * static_cast<std::size_t>(threads),
                     static_cast<std::size_t>(kRoundSamples / (kPassSamples * kBlockSide * kBlockSide * std::max(passes, 1u)))});
}

// Returns the checkpoint's file for a picture with this key.
std::string file_of(const ReferenceOptions& options, std::uint64_t key)
{
    return options.checkpoint_folder.empty() ? options.checkpoint
                                             : fmt::format("{}/reference-{:016x}.part", options.checkpoint_folder, key);
}

Result<Accumulator> ReferenceRenderer::integrate(const FrameDesc& desc, const ReferenceParams& f, SamplingStats& stats)
{
    constexpr std::uint32_t kFewestPasses = 8; // before the error estimate is trusted
    ReferencePart* const part = options_.part.get();
    const std::uint64_t samples = part && part->samples ? part->samples : options_.samples;
    const auto passes = static_cast<std::uint32_t>(reference_passes(samples, options_.shades));
    const std::uint32_t round = passes_in_round(desc, pass_samples(), options_.target_error > 0.0);
    Accumulator a(desc.width, desc.height);
    a.first_pass = part ? part->first_pass : 0;
    if (part && part->count && part->others.empty())
        hold_blocks(a, part->first, part->count);
    const bool resumable = keeps(options_);
    const std::uint64_t key = part && part->key ? part->key : resumable || part ? reference_key(input_, desc, options_) : 0;
    const std::string file = resumable ? file_of(options_, key) : "";
    // Resume from a checkpoint
    if (resumable) {
        const Result<bool> resumed = read_checkpoint(file, key, a, links_of(options_));
        BN_TRY(resumed);
        stats.resumed = *resumed;
    }
    // Take over the parts of others
    for (const std::vector<std::uint8_t>& other : part ? part->others : std::vector<std::vector<std::uint8_t>>())
        BN_TRY(take_blocks(other, key, a));
    free_sums(a);
    if (!resumable && !part && options_.target_error <= 0.0)
        keep_totals(a, passes);
    const BlockRange range =
        part && part->count ? BlockRange{part->first, std::size_t{part->first} + part->count} : BlockRange{0, a.passes.size()};
    BN_CHECK(range.end <= a.passes.size());
    std::uint32_t done = least_passes(a, range.begin, range.end - range.begin);
    stats.samples_before = done * pass_samples();
    const std::size_t in_slice = blocks_in_slice(std::min(round, passes), input_.jobs.threads());
    const std::size_t slices = (range.end - range.begin + in_slice - 1) / in_slice; // of a pass
    Progress progress("passes", passes > done ? (passes - done) * slices : 0, options_.quiet);
    Clock::time_point written = Clock::now();
    // Also write after the last pass, because a finished checkpoint can be extended with more samples. A disk that is full for a while
    // costs an intermediate checkpoint, not the picture.
    const auto write = [&] { return resumable ? write_checkpoint(file, key, a, links_of(options_)) : Status{}; };
    // Test after whole rounds only, so that an earlier stop cannot change the run's end.
    const auto good_enough = [&] {
        return options_.target_error > 0.0 && done >= kFewestPasses && done % round == 0 && most_passes(a) == done &&
               mean_relative_error(a) <= options_.target_error;
    };
    const auto run_round = [&] {
        const std::uint32_t until = std::min(passes, done - done % round + round);
        const TraceSpan round_span("passes");
        for (std::size_t begin = range.begin; begin < range.end && !stopped(); begin += in_slice) {
            advance(f, a, until, {begin, std::min(begin + in_slice, range.end)});
            progress.step(until - done);
            if (resumable && seconds_since(written) > options_.checkpoint_seconds) {
                static_cast<void>(static_cast<bool>(write())); // the last write decides
                written = Clock::now();
            }
        }
        free_sums(a);
        done = least_passes(a, range.begin, range.end - range.begin);
    };
    try {
        while (done < passes && !good_enough() && !stopped())
            run_round();
    } catch (const Stopped&) {
        static_cast<void>(static_cast<bool>(write())); // so that a later run goes on from here
        throw;
    }
    stats.stopped = stopped() && done < passes;
    if (part && part->count && !stats.stopped)
        part->made = blocks_of(a, key, part->first, part->count);
    // Write the last checkpoint
    const Status kept = write();
    if (!kept && (stats.stopped || !options_.lost_checkpoint))
        return kept.error();
    if (!kept)
        options_.lost_checkpoint(kept.error());
    return a;
}

// Integrates light. Fills the frame's picture, its variance and its statistics.
Status ReferenceRenderer::add_light(const FrameDesc& desc, const ReferenceParams& f, Frame& frame)
{
    const Clock::time_point begin = Clock::now();
    SamplingStats& s = frame.stats.sampling;
    const Result<Accumulator> a = integrate(desc, f, s);
    BN_TRY(a);
    const double seconds = seconds_since(begin);
    s.samples = least_passes(*a) * pass_samples();
    if (!options_.part || options_.part->count == 0) {
        frame.color = mean_image(*a);
        frame.variance = variance_image(*a);
        s.relative_error = mean_relative_error(*a);
    }
    RayCount count = {};
    for (const ReferenceScratch& w : workers_) {
        count.rays += w.count.rays;
        count.ticks += w.count.ticks;
        count.all_ticks += w.count.all_ticks;
    }
    s.rays = count.rays;
    s.ray_share = count.all_ticks ? static_cast<double>(count.ticks) / static_cast<double>(count.all_ticks) : 0.0;
    s.million_samples_per_second =
        static_cast<double>(s.samples - std::min(s.samples, s.samples_before)) * desc.width * desc.height / seconds * 1e-6;
    return {};
}

Result<Frame> ReferenceRenderer::render(const FrameDesc& desc, Frame)
{
    for (const Status& ok : {check_frame(input_.scene, with_msaa(reference_desc(desc), desc.msaa)), check_options(options_),
                             check_ray_range(desc.view), check_prepared(input_.mips, desc)})
        BN_TRY(ok);
    const TraceSpan span("reference");
    const Clock::time_point begin = Clock::now();
    Frame frame;
    const ReferenceParams f = params(desc);
    workers_.assign(static_cast<std::size_t>(input_.jobs.threads()), {});
    if (!options_.ids_only)
        BN_TRY(add_light(desc, f, frame));
    // Trace triangle ids at sample positions
    if (desc.triangle_ids) {
        const std::size_t row = static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.msaa);
        frame.triangle_ids.resize(row * static_cast<std::size_t>(desc.height));
        frame.through.resize(f.any_alpha ? frame.triangle_ids.size() : 0);
        const SamplePattern pattern = standard_samples(desc.msaa);
        input_.jobs.parallel_for(static_cast<std::size_t>(desc.height), [&](std::size_t y, int worker) {
            fns_.trace_row(f, static_cast<int>(y), pattern, workers_[static_cast<std::size_t>(worker)], frame.triangle_ids.data() + y * row,
                           f.any_alpha ? frame.through.data() + y * row : nullptr);
        });
    }
    frame.stats.triangles = frame.stats.triangles_drawn = input_.tables.triangle_count();
    frame.stats.ms = seconds_since(begin) * 1e3;
    return frame;
}

} // namespace

std::uint32_t reference_blocks(int width, int height)
{
    return static_cast<std::uint32_t>(((width + kBlockSide - 1) / kBlockSide) * ((height + kBlockSide - 1) / kBlockSide));
}

std::uint64_t reference_passes(std::uint64_t samples, int shades)
{
    const auto each = static_cast<std::uint64_t>(kPassPositions * shades);
    return (samples + each - 1) / each;
}

bool reference_available()
{
    return embree_available();
}

std::string checkpoint_of(const RenderInput& input, const FrameDesc& desc, const ReferenceOptions& options)
{
    return keeps(options) ? file_of(options, options.checkpoint_folder.empty() ? 0 : reference_key(input, desc, options)) : "";
}

Status check_reference_checkpoint(const RenderInput& input, const FrameDesc& desc, const ReferenceOptions& options)
{
    if (!keeps(options))
        return {};
    const std::uint64_t key = reference_key(input, desc, options);
    Accumulator a(desc.width, desc.height);
    const Result<bool> found = read_checkpoint(file_of(options, key), key, a, links_of(options));
    return found ? Status{} : Status{found.error()};
}

Result<std::unique_ptr<Renderer>> make_reference_renderer(const RenderInput& input, const ReferenceOptions& options)
{
    BN_TRY(check_ray_range(input.tables));
    Result<std::unique_ptr<RayScene>> rays = options.own_rays ? make_tree_scene(input.scene, input.tables, input.jobs, options.isa)
                                                              : make_embree_scene(input.scene, input.tables, input.jobs);
    BN_TRY(rays);
    return std::unique_ptr<Renderer>(std::make_unique<ReferenceRenderer>(input, options, std::move(*rays)));
}

} // namespace burnish
