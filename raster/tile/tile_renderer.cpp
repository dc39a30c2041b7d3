#include "raster/tile/tile_renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "core/simd/cpu.h"
#include "raster/frame/grid_samples.h"
#include "raster/frame/upload.h"
#include "raster/tile/bins.h"
#include "raster/tile/cull.h"
#include "raster/tile/profiler.h"
#include "raster/tile/tile_types.h"

namespace burnish {

namespace bn_scalar {
const TileFns& tile_fns();
}
namespace bn_avx2 {
const TileFns& tile_fns();
}
namespace bn_avx512 {
const TileFns& tile_fns();
}

namespace {

const TileFns& fns_of(Isa isa)
{
    return isa == Isa::avx512 ? bn_avx512::tile_fns() : isa == Isa::avx2 ? bn_avx2::tile_fns() : bn_scalar::tile_fns();
}

// Scratch of one worker: everything a tile needs, sized once for the worst case.
struct WorkerScratch {
    Column<float> depth, block_far, red, green, blue;
    Column<std::uint32_t> ids, slot_begin, pass_lanes, entries, drawn_singly;
    Column<std::uint8_t> block_dirty, register_passes;
    Column<TriangleSetup> triangles;
    Column<ClipRecord> clips;
    Column<std::int32_t> fragment_triangle, fragment_pixel, fragment_mask, order, slot_of_material, slot_material;
    FrameStats stats;

    void prepare(int tile_size, int msaa, std::size_t materials)
    {
        const std::size_t pixels = static_cast<std::size_t>(tile_size) * static_cast<std::size_t>(tile_size);
        const std::size_t samples = pixels * static_cast<std::size_t>(msaa), blocks = pixels / kBlockPixels;
        depth.resize(samples), ids.resize(samples), block_far.resize(blocks), block_dirty.resize(blocks);
        pass_lanes.resize(samples), register_passes.resize(pixels);
        for (Column<float>* c : {&red, &green, &blue})
            c->resize(samples);
        for (Column<std::int32_t>* c : {&fragment_triangle, &fragment_pixel, &fragment_mask, &order})
            c->resize(samples);
        slot_begin.resize(materials + 3), slot_material.resize(materials + 2), slot_of_material.resize(materials);
        std::fill(slot_of_material.begin(), slot_of_material.end(), -1);
        stats = {};
    }

    // Grows to the largest tile that this worker has met, and keeps that from frame to frame.
    TileScratch view(Frame& frame, std::size_t triangle_count)
    {
        const std::size_t room = triangle_count + kColumnPad; // whole registers are written
        if (triangles.size() < room)
            triangles.resize(room), entries.resize(room), drawn_singly.resize(room);
        return {depth.data(), ids.data(), block_far.data(), block_dirty.data(), static_cast<std::uint32_t>(triangle_count),
                entries.data(), triangles.data(), clips.data(), drawn_singly.data(), fragment_triangle.data(),
                fragment_pixel.data(), fragment_mask.data(), register_passes.data(), pass_lanes.data(), red.data(), green.data(),
                blue.data(), order.data(), false, kNoMaterial, slot_of_material.data(), slot_material.data(), slot_begin.data(), 0, 0,
                frame.color.f32(), frame.triangle_ids.empty() ? nullptr : frame.triangle_ids.data(),
                frame.stages.depths.empty() ? nullptr : frame.stages.depths.data(),
                frame.stages.pairs.empty() ? nullptr : frame.stages.pairs.data(), nullptr};
    }
};

class TileRenderer final : public Renderer {
  public:
    TileRenderer(const RenderInput& input, Isa isa)
        : input_(input), isa_(isa), fns_(fns_of(isa)), scene_(upload_scene(input.scene, input.tables, input.jobs))
    {
        vertices_.resize(input.tables.px.size());
    }
    Result<Frame> render(const FrameDesc& desc, Frame recycled) override;
    std::string device() const override { return cpu_name() + " (" + isa_name(isa_) + ")"; }

  private:
    FrameParams frame_params(const FrameDesc& desc, const std::vector<MaterialRecord>& materials);
    void prepare_grid(const FrameDesc& desc, FrameParams& f);
    void draw_tiles(const FrameParams& f, Frame& frame, Profiler* profiler);

    RenderInput input_;
    Isa isa_;
    const TileFns& fns_;
    SceneTables scene_;
    CubeMap box_cube_;              // made when a technique first asks for it
    LobeAlbedoTable lobe_albedo_;   // made when a frame first asks for energy compensation
    std::vector<GridSample> grid_;
    Column<SnappedVertex> vertices_;
    Bins bins_;
    std::vector<WorkerScratch> workers_;
};

FrameParams TileRenderer::frame_params(const FrameDesc& desc, const std::vector<MaterialRecord>& materials)
{
    FrameParams f = {};
    f.view = view_params_of(desc.view);
    f.width = desc.width, f.height = desc.height, f.msaa = desc.msaa, f.tile_size = desc.tile_size;
    f.tiles_x = (desc.width + desc.tile_size - 1) / desc.tile_size;
    f.tiles_y = (desc.height + desc.tile_size - 1) / desc.tile_size;
    f.center_x = desc.width / 2 * kSubpixel, f.center_y = desc.height / 2 * kSubpixel;
    f.half_width = 0.5f * static_cast<float>(desc.width), f.half_height = 0.5f * static_cast<float>(desc.height);
    f.pattern = standard_samples(desc.msaa);
    const DrawTables& t = input_.tables;
    f.px = t.px.data(), f.py = t.py.data(), f.pz = t.pz.data();
    f.shading_vertices = reinterpret_cast<const float*>(t.shading.data());
    f.indices = t.indices.data(), f.triangle_material = t.triangle_material.data();
    f.materials = materials.data();
    f.lights = scene_.lights.data(), f.light_count = static_cast<std::int32_t>(scene_.lights.size());
    f.vertices = vertices_.data();
    f.specular_cube = cube_params(input_.environment.specular);
    f.irradiance_cube = cube_params(input_.environment.irradiance);
    f.dfg_texels = input_.dfg.texels.data(), f.dfg_size = input_.dfg.size;
    if (desc.energy_compensation && lobe_albedo_.size == 0)
        lobe_albedo_ = bake_lobe_albedo(kLobeAlbedoSize, input_.jobs);
    f.lobe_albedo_texels = lobe_albedo_.texels.data(), f.lobe_albedo_size = lobe_albedo_.size;
    f.dfg_fit = desc.dfg_fit, f.energy_compensation = desc.energy_compensation, f.horizon = desc.horizon;
    f.background = desc.background, f.samples = desc.samples, f.texture_taps = desc.texture_anisotropy;
    f.technique = static_cast<std::int32_t>(find_technique(desc.technique) - techniques().data());
    f.seed = static_cast<std::int32_t>(desc.seed);
    f.major_axis_k = desc.major_axis_k, f.major_axis_beta = desc.major_axis_beta;
    for (int i = 0; i < 2; ++i) {
        f.tilt_cos[i] = static_cast<float>(det_cos(desc.tilt_rad[i]));
        f.tilt_sin[i] = static_cast<float>(det_sin(desc.tilt_rad[i]));
    }
    f.tilted = desc.tilt_rad != glm::vec2(0.0f);
    f.override_anisotropy = desc.override_anisotropy, f.anisotropy = desc.anisotropy;
    return f;
}

void TileRenderer::prepare_grid(const FrameDesc& desc, FrameParams& f)
{
    if (find_technique(desc.technique)->sampling != Sampling::grid)
        return;
    if (box_cube_.levels == 0)
        box_cube_ = box_filtered_chain(input_.environment.specular, input_.jobs);
    grid_ = grid_samples(desc.samples, desc.technique == "filtered_is_ggx");
    f.box_cube = cube_params(box_cube_);
    f.grid = grid_.data(), f.grid_count = static_cast<std::int32_t>(grid_.size());
}

void TileRenderer::draw_tiles(const FrameParams& f, Frame& frame, Profiler* profiler)
{
    const TraceSpan span("tiles");
    workers_.resize(static_cast<std::size_t>(input_.jobs.threads()));
    const std::size_t tiles = static_cast<std::size_t>(f.tiles_x) * static_cast<std::size_t>(f.tiles_y);
    {
        ProfiledWork work(profiler, 0);
        for (WorkerScratch& w : workers_)
            w.prepare(f.tile_size, f.msaa, scene_.materials.size());
        work.lap(FrameStage::prepare);
    }
    input_.jobs.parallel_for(tiles, [&](std::size_t i, int worker) {
        const TraceSpan tile_span("tile");
        ProfiledWork work(profiler, worker);
        WorkerScratch& w = workers_[static_cast<std::size_t>(worker)];
        TileScratch scratch = w.view(frame, bins_.triangles_in(i));
        scratch.clock = profiler ? profiler->clock(worker) : nullptr;
        bins_.gather_tile(i, w.entries.data(), w.triangles.data(), w.clips);
        scratch.clips = w.clips.data();
        work.lap(FrameStage::gather);
        fns_.render_tile(f, static_cast<int>(i) % f.tiles_x, static_cast<int>(i) / f.tiles_x, scratch);
        w.stats.visible_fragments += scratch.fragment_count - scratch.background_pixels;
        w.stats.background_pixels += scratch.background_pixels;
        if (profiler)
            profiler->end_tile(worker, i);
    });
    for (const WorkerScratch& w : workers_) {
        frame.stats.visible_fragments += w.stats.visible_fragments;
        frame.stats.background_pixels += w.stats.background_pixels;
    }
}

std::size_t tiles_of(const FrameDesc& d)
{
    const auto side = [&](int pixels) { return static_cast<std::size_t>((pixels + d.tile_size - 1) / d.tile_size); };
    return side(d.width) * side(d.height);
}

// Memory for a frame. Every pixel will be written, so what a frame of the same size leaves in it may stay.
Frame frame_for(const FrameDesc& desc, Frame recycled)
{
    Frame frame;
    frame.color = std::move(recycled.color);
    if (frame.color.width != desc.width || frame.color.height != desc.height || frame.color.channels != 3 ||
        frame.color.type != PixelType::f32 || frame.color.empty())
        frame.color = make_image(desc.width, desc.height, 3, PixelType::f32);
    const std::size_t samples =
        static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.height) * static_cast<std::size_t>(desc.msaa);
    if (desc.triangle_ids || desc.stages)
        frame.triangle_ids.resize(samples);
    if (desc.stages)
        frame.stages.depths.resize(samples), frame.stages.pairs.resize(samples * kPairWords);
    return frame;
}

Result<Frame> TileRenderer::render(const FrameDesc& desc, Frame recycled)
{
    if (const Status ok = check_desc(desc); !ok)
        return ok.error();
    const TraceSpan span("frame");
    const auto begin = std::chrono::steady_clock::now();
    std::optional<Profiler> measured;
    if (desc.profile)
        measured.emplace(input_.jobs.threads(), tiles_of(desc), scene_.materials.size(), fns_.lanes);
    Profiler* const profiler = measured ? &*measured : nullptr;
    ProfiledWork before(profiler, 0);
    Frame frame = frame_for(desc, std::move(recycled));
    if (desc.stages)
        frame.stages.vertices.resize(input_.tables.px.size() * kVertexWords);
    const std::vector<MaterialRecord> materials = overridden(scene_.materials, desc);
    FrameParams f = frame_params(desc, materials);
    prepare_grid(desc, f);
    before.lap(FrameStage::prepare);
    const Visible visible = cull(input_.tables, desc.view);
    before.lap(FrameStage::cull);
    before.end();
    transform_draws(f, input_.tables, visible, fns_, input_.jobs, profiler);
    bins_.build(f, input_.tables, visible, fns_, input_.jobs, profiler);
    draw_tiles(f, frame, profiler);
    if (desc.stages)
        fns_.record_vertices(f, static_cast<std::uint32_t>(input_.tables.px.size()), frame.stages.vertices.data());
    if (profiler)
        frame.profile = profiler->sum();
    frame.stats.triangles = input_.tables.triangle_count();
    frame.stats.triangles_drawn = bins_.triangle_count();
    frame.stats.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return frame;
}

} // namespace

bool isa_available(Isa isa)
{
    return isa == Isa::scalar || (isa == Isa::avx2 && cpu_has_avx2()) || (isa == Isa::avx512 && cpu_has_avx512());
}

Result<Isa> parse_isa(const std::string& name)
{
    for (Isa isa : {Isa::scalar, Isa::avx2, Isa::avx512})
        if (name == isa_name(isa))
            return isa;
    return Error{ExitCode::usage, "", "", "unknown instruction set '" + name + "'; there are scalar, avx2, avx512"};
}

const char* isa_name(Isa isa) { return isa == Isa::avx512 ? "avx512" : isa == Isa::avx2 ? "avx2" : "scalar"; }

Isa best_isa()
{
    Isa cap = Isa::avx512;
    if (const char* forced = std::getenv("BN_FORCE_ISA"))
        if (const Result<Isa> isa = parse_isa(forced))
            cap = *isa;
    for (Isa isa : {Isa::avx512, Isa::avx2})
        if (isa <= cap && isa_available(isa))
            return isa;
    return Isa::scalar;
}

std::unique_ptr<Renderer> make_tile_renderer(const RenderInput& input, Isa isa)
{
    BN_CHECK(isa_available(isa));
    return std::make_unique<TileRenderer>(input, isa);
}

} // namespace burnish
