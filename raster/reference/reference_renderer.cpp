#include "raster/reference/reference_renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "core/simd/cpu.h"
#include "raster/frame/upload.h"
#include "raster/reference/accumulator.h"
#include "raster/reference/checkpoint.h"
#include "raster/reference/scene_key.h"

namespace burnish {

namespace bn_scalar {
const ReferenceFns& reference_fns();
}
namespace bn_avx2 {
const ReferenceFns& reference_fns();
}
namespace bn_avx512 {
const ReferenceFns& reference_fns();
}

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

const ReferenceFns& fns_of(Isa isa)
{
    return isa == Isa::avx512 ? bn_avx512::reference_fns() : isa == Isa::avx2 ? bn_avx2::reference_fns() : bn_scalar::reference_fns();
}

const char* isa_text(Isa isa) { return isa == Isa::avx512 ? "avx512" : isa == Isa::avx2 ? "avx2" : "scalar"; }

void trace_packet(const RayScene& scene, RayPacket& rays, RayKind kind) { scene.trace(rays, kind); }

struct BlockRange {
    std::size_t begin, end;
};

class ReferenceRenderer final : public Renderer {
  public:
    ReferenceRenderer(const RenderInput& input, const ReferenceOptions& options, std::unique_ptr<RayScene> rays)
        : input_(input), options_(options), fns_(fns_of(options.isa)), rays_(std::move(rays)),
          scene_(upload_scene(input.scene, input.tables, input.jobs)),
          sampler_(make_environment_sampler(input.environment.specular, input.jobs))
    {
    }
    Result<Frame> render(const FrameDesc& desc, Frame) override;
    std::string device() const override
    {
        return cpu_name() + " (" + isa_text(options_.isa) + ", " + rays_->description() + ")";
    }

  private:
    ReferenceParams params(const FrameDesc& desc, const std::vector<MaterialRecord>& materials);
    Result<Accumulator> integrate(const FrameDesc& desc, const ReferenceParams& f, SamplingStats& stats);
    void advance(const ReferenceParams& f, Accumulator& a, std::uint32_t passes, BlockRange blocks);
    bool stopped() const { return options_.stop && options_.stop->load(std::memory_order_relaxed); }

    RenderInput input_;
    ReferenceOptions options_;
    const ReferenceFns& fns_;
    std::unique_ptr<RayScene> rays_;
    SceneTables scene_;
    EnvironmentSampler sampler_;
    LobeAlbedoTable lobe_albedo_; // made when a frame first asks for energy compensation
    std::vector<ReferenceScratch> workers_;
};

ReferenceParams ReferenceRenderer::params(const FrameDesc& desc, const std::vector<MaterialRecord>& materials)
{
    ReferenceParams f = {};
    f.view = view_params_of(desc.view);
    f.width = desc.width, f.height = desc.height;
    f.half_width = 0.5f * static_cast<float>(desc.width), f.half_height = 0.5f * static_cast<float>(desc.height);
    const DrawTables& t = input_.tables;
    f.px = t.px.data(), f.py = t.py.data(), f.pz = t.pz.data();
    f.shading_vertices = reinterpret_cast<const float*>(t.shading.data());
    f.indices = t.indices.data(), f.triangle_material = t.triangle_material.data();
    f.materials = materials.data();
    f.lights = scene_.lights.data(), f.light_count = static_cast<std::int32_t>(scene_.lights.size());
    for (const MaterialRecord& m : materials)
        f.any_alpha = f.any_alpha || m.alpha_mode != 0;
    f.ray_epsilon = 1e-6f * glm::length(t.bounds_max - t.bounds_min);
    f.specular_cube = cube_params(input_.environment.specular);
    f.sampler = sampler_.view;
    f.dfg_texels = input_.dfg.texels.data(), f.dfg_size = input_.dfg.size;
    if (desc.energy_compensation && lobe_albedo_.size == 0)
        lobe_albedo_ = bake_lobe_albedo(kLobeAlbedoSize, input_.jobs);
    f.lobe_albedo_texels = lobe_albedo_.texels.data(), f.lobe_albedo_size = lobe_albedo_.size;
    f.dfg_fit = desc.dfg_fit, f.energy_compensation = desc.energy_compensation, f.horizon = desc.horizon;
    f.background = desc.background;
    f.texture_taps = desc.texture_anisotropy;
    f.override_anisotropy = desc.override_anisotropy, f.anisotropy = desc.anisotropy;
    for (int i = 0; i < 2; ++i) {
        f.tilt_cos[i] = static_cast<float>(det_cos(static_cast<double>(desc.tilt_rad[i])));
        f.tilt_sin[i] = static_cast<float>(det_sin(static_cast<double>(desc.tilt_rad[i])));
    }
    f.tilted = desc.tilt_rad != glm::vec2(0.0f);
    f.mode = options_.mode, f.strategy = options_.strategy, f.bounces = options_.bounces;
    f.seed = desc.seed;
    f.sobol = &sobol_table();
    f.rays = rays_.get();
    f.trace = trace_packet;
    return f;
}

// Blocks up to `passes`; ends early, between blocks, when asked to stop.
void ReferenceRenderer::advance(const ReferenceParams& f, Accumulator& a, std::uint32_t passes, BlockRange blocks)
{
    input_.jobs.parallel_for(blocks.end - blocks.begin, [&](std::size_t k, int worker) {
        const std::size_t i = blocks.begin + k;
        const PixelBlock block = block_of(a, i, passes);
        if (block.passes == 0 || stopped())
            return;
        fns_.add_passes(f, block, workers_[static_cast<std::size_t>(worker)], a.pixels.data());
        a.passes[i] = block.first_pass + block.passes;
    });
}

constexpr std::uint64_t kRoundSamples = 1u << 22;

// Work between two looks at the error: some million samples, by the picture's size alone, so that where a run ends does not depend on
// how fast it is.
std::uint32_t passes_in_round(const FrameDesc& desc)
{
    const std::uint64_t samples = static_cast<std::uint64_t>(desc.width) * static_cast<std::uint64_t>(desc.height) * kPassSamples;
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(1, kRoundSamples / samples));
}

// Work between two looks at the clock, whether the checkpoint is due: one pass of a large picture may take minutes.
constexpr std::size_t kBlocksInSlice = kRoundSamples / (kPassSamples * kBlockSide * kBlockSide);

Result<Accumulator> ReferenceRenderer::integrate(const FrameDesc& desc, const ReferenceParams& f, SamplingStats& stats)
{
    constexpr std::uint32_t kFewestPasses = 8; // before an error is believed
    const auto passes = static_cast<std::uint32_t>((options_.samples + kPassSamples - 1) / kPassSamples);
    const std::uint32_t round = passes_in_round(desc);
    Accumulator a(desc.width, desc.height);
    const std::uint64_t key = options_.checkpoint.empty() ? 0 : reference_key(input_, desc, options_);
    if (!options_.checkpoint.empty()) {
        const Result<bool> resumed = read_checkpoint(options_.checkpoint, key, a);
        if (!resumed)
            return resumed.error();
        stats.resumed = *resumed;
    }
    workers_.assign(static_cast<std::size_t>(input_.jobs.threads()), {});
    std::uint32_t done = least_passes(a);
    stats.samples_before = std::uint64_t{done} * kPassSamples;
    Progress progress("passes", passes > done ? passes - done : 0, options_.quiet);
    Clock::time_point written = Clock::now();
    // Also after the last pass: a finished checkpoint may be gone on with for more samples.
    const auto write = [&] { return options_.checkpoint.empty() ? Status{} : write_checkpoint(options_.checkpoint, key, a); };
    // After whole rounds only: what a stop left in between must not decide where the run ends.
    const auto good_enough = [&] {
        return options_.target_error > 0.0 && done >= kFewestPasses && done % round == 0 && most_passes(a) == done &&
               mean_relative_error(a) <= options_.target_error;
    };
    while (done < passes && !good_enough() && !stopped()) {
        const std::uint32_t before = done, until = std::min(passes, done - done % round + round);
        const TraceSpan round_span("passes");
        for (std::size_t begin = 0; begin < a.passes.size() && !stopped(); begin += kBlocksInSlice) {
            advance(f, a, until, {begin, std::min(begin + kBlocksInSlice, a.passes.size())});
            if (!options_.checkpoint.empty() && seconds_since(written) > options_.checkpoint_seconds) {
                if (Status status = write(); !status)
                    return status.error();
                written = Clock::now();
            }
        }
        done = least_passes(a);
        progress.step(done - before);
    }
    stats.stopped = stopped() && done < passes;
    if (Status status = write(); !status)
        return status.error();
    return a;
}

Status check_desc(const FrameDesc& d, const ReferenceOptions& o)
{
    const auto usage = [](std::string reason) { return Error{ExitCode::usage, "", "", std::move(reason)}; };
    if (d.width < 1 || d.height < 1 || d.width > kMaxPictureSide || d.height > kMaxPictureSide)
        return usage("the image's sides must lie in 1..16384 pixels");
    if (d.msaa != 1 && d.msaa != 2 && d.msaa != 4 && d.msaa != 8 && d.msaa != 16)
        return usage("msaa must be 1, 2, 4, 8 or 16");
    if (std::int64_t{d.width} * d.height * d.msaa > kMaxPictureSamples)
        return usage("width x height x msaa must not exceed 2^28 samples");
    if (d.texture_anisotropy < 1 || d.texture_anisotropy > 16)
        return usage("texture anisotropy must lie in 1..16");
    if (!(std::abs(d.tilt_rad.x) < 1.57f && std::abs(d.tilt_rad.y) < 1.57f))
        return usage("a lobe's tilt must stay below a quarter turn");
    if (o.samples < 1 || o.samples > kMaxReferenceSamples)
        return usage("samples must lie in 1..2^32");
    if (o.bounces < 0)
        return usage("bounces must not be negative");
    return {};
}

Result<Frame> ReferenceRenderer::render(const FrameDesc& desc, Frame)
{
    if (const Status ok = check_desc(desc, options_); !ok)
        return ok.error();
    const TraceSpan span("reference");
    const Clock::time_point begin = Clock::now();
    Frame frame;
    const std::vector<MaterialRecord> materials = overridden(scene_.materials, desc);
    const ReferenceParams f = params(desc, materials);
    SamplingStats& s = frame.stats.sampling;
    const Result<Accumulator> a = integrate(desc, f, s);
    if (!a)
        return a.error();
    const double seconds = seconds_since(begin);
    frame.color = mean_image(*a);
    frame.variance = variance_image(*a);
    s.samples = std::uint64_t{least_passes(*a)} * kPassSamples;
    s.relative_error = mean_relative_error(*a);
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
    if (desc.triangle_ids) {
        const std::size_t row = static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.msaa);
        frame.triangle_ids.resize(row * static_cast<std::size_t>(desc.height));
        const SamplePattern pattern = standard_samples(desc.msaa);
        input_.jobs.parallel_for(static_cast<std::size_t>(desc.height), [&](std::size_t y, int worker) {
            fns_.trace_row(f, static_cast<int>(y), pattern, workers_[static_cast<std::size_t>(worker)],
                           frame.triangle_ids.data() + y * row);
        });
    }
    frame.stats.triangles = frame.stats.triangles_drawn = input_.tables.triangle_count();
    frame.stats.ms = seconds_since(begin) * 1e3;
    return frame;
}

} // namespace

bool reference_available() { return ray_scene_available(); }

Status check_reference_checkpoint(const RenderInput& input, const FrameDesc& desc, const ReferenceOptions& options)
{
    if (options.checkpoint.empty())
        return {};
    Accumulator a(desc.width, desc.height);
    const Result<bool> found = read_checkpoint(options.checkpoint, reference_key(input, desc, options), a);
    return found ? Status{} : Status{found.error()};
}

Result<std::unique_ptr<Renderer>> make_reference_renderer(const RenderInput& input, const ReferenceOptions& options)
{
    Result<std::unique_ptr<RayScene>> rays = make_ray_scene(input.scene, input.tables);
    if (!rays)
        return rays.error();
    return std::unique_ptr<Renderer>(std::make_unique<ReferenceRenderer>(input, options, std::move(*rays)));
}

} // namespace burnish
