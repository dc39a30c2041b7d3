#include "raster/tile/tile_renderer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstring>
#include <optional>
#include <span>

#include "core/base/check.h"
#include "core/jobs/control.h"
#include "core/simd/cpu.h"
#include "raster/frame/frame_record.h"
#include "raster/frame/pixel_parts.h"
#include "raster/tile/bins.h"
#include "raster/tile/cull.h"
#include "raster/tile/profiler.h"
#include "raster/tile/tile_split.h"
#include "raster/tile/tile_types.h"
#include "raster/tile/twins.h"

namespace burnish {

namespace {

// Memory of PeelScratch.
struct WorkerPeel {
    Column<float> alpha, depth, red, green, blue, through;
    Column<std::int32_t> id;
    Column<std::uint64_t> pixels;
    Column<bool> done;
    Column<std::uint32_t> triangles, order;
    Column<float> nearest;

    void prepare(std::size_t samples, std::size_t blocks)
    {
        for (Column<float>* c : {&alpha, &depth, &red, &green, &blue, &through})
            c->resize(samples);
        id.resize(samples), pixels.resize(blocks), done.resize(blocks);
    }
    PeelScratch view(TileScratch& layer, float* output_through)
    {
        if (triangles.size() < layer.triangle_count)
            triangles.resize(layer.triangle_count), order.resize(layer.triangle_count), nearest.resize(layer.triangle_count);
        return {.layer = &layer,
                .alpha = alpha.data(),
                .depth = depth.data(),
                .id = id.data(),
                .red = red.data(),
                .green = green.data(),
                .blue = blue.data(),
                .through = through.data(),
                .pixels = pixels.data(),
                .done = done.data(),
                .triangles = triangles.data(),
                .order = order.data(),
                .nearest = nearest.data(),
                .triangle_count = 0,
                .passed = 0,
                .nearest_open = 0.0f,
                .fragment_count = 0,
                .output_through = output_through};
    }
};

// Scratch memory of one worker, sized once for a tile's worst case.
struct WorkerScratch {
    Column<float> depth, block_far, red, green, blue, shared_words, shared_pixels;
    Column<std::uint32_t> ids, slot_begin, pass_lanes, entries, drawn_singly;
    Column<std::uint8_t> block_dirty, register_passes;
    Column<BlockState> block_state;
    Column<BlockPlane> block_plane;
    Column<TriangleSetup> triangles;
    Column<ClipRecord> clips;
    Column<std::int32_t> fragment_triangle, fragment_pixel, fragment_mask, order, slot_of_material, slot_material;
    std::size_t shared_capacity = 0;
    std::vector<PixelPart> parts;

    void prepare(int tile_size, int msaa, std::size_t materials, bool shares)
    {
        const std::size_t pixels = static_cast<std::size_t>(tile_size) * static_cast<std::size_t>(tile_size);
        const std::size_t samples = pixels * static_cast<std::size_t>(msaa), blocks = pixels / kBlockPixels;
        depth.resize(samples), ids.resize(samples), block_far.resize(blocks), block_dirty.resize(blocks);
        block_state.resize(blocks), block_plane.resize(blocks);
        pass_lanes.resize(samples), register_passes.resize(pixels);
        for (Column<float>* c : {&red, &green, &blue})
            c->resize(samples);
        for (Column<std::int32_t>* c : {&fragment_triangle, &fragment_pixel, &fragment_mask, &order})
            c->resize(samples);
        if (shares) {
            shared_capacity = samples + kColumnPad; // whole registers are written
            shared_words.resize(std::size_t{kSharedWords} * shared_capacity);
            shared_pixels.resize(std::size_t{kSharedPlanes} * kSharedPixels);
        }
        slot_begin.resize(materials + 3), slot_material.resize(materials + 2), slot_of_material.resize(materials);
        std::fill(slot_of_material.begin(), slot_of_material.end(), -1);
        parts.clear();
    }

    // Grows to the worker's largest tile so far, and keeps that size between frames.
    TileScratch view(Frame& frame, std::size_t triangle_count)
    {
        const std::size_t room = triangle_count + kColumnPad; // whole registers are written
        if (triangles.size() < room)
            triangles.resize(room), entries.resize(room), drawn_singly.resize(room);
        return {.depth = depth.data(),
                .ids = ids.data(),
                .block_far = block_far.data(),
                .block_dirty = block_dirty.data(),
                .block_state = block_state.data(),
                .block_plane = block_plane.data(),
                .triangle_count = static_cast<std::uint32_t>(triangle_count),
                .entries = entries.data(),
                .triangles = triangles.data(),
                .clips = clips.data(),
                .drawn_singly = drawn_singly.data(),
                .fragment_triangle = fragment_triangle.data(),
                .fragment_pixel = fragment_pixel.data(),
                .fragment_mask = fragment_mask.data(),
                .register_passes = register_passes.data(),
                .pass_lanes = pass_lanes.data(),
                .red = red.data(),
                .green = green.data(),
                .blue = blue.data(),
                .shared_words = shared_words.data(),
                .shared_pixels = shared_pixels.data(),
                .shared_capacity = shared_capacity,
                .order = order.data(),
                .in_list_order = false,
                .only_material = kNoMaterial,
                .slot_of_material = slot_of_material.data(),
                .slot_material = slot_material.data(),
                .slot_begin = slot_begin.data(),
                .fragment_count = 0,
                .background_pixels = 0,
                .own_fragments = 0,
                .own_background = 0,
                .transmits = false,
                .output = frame.color.f32(),
                .output_ids = frame.triangle_ids.empty() ? nullptr : frame.triangle_ids.data(),
                .output_depths = frame.stages.depths.empty() ? nullptr : frame.stages.depths.data(),
                .output_pairs = frame.stages.pairs.empty() ? nullptr : frame.stages.pairs.data(),
                .output_layers = frame.layers.empty() ? nullptr : &frame.layers.data()->depth,
                .clock = nullptr,
                .peel = nullptr};
    }
};

class TileRenderer final : public Renderer {
  public:
    TileRenderer(const RenderInput& input, const TileFns& fns, std::string lanes)
        : input_(input), lanes_(std::move(lanes)), fns_(fns), maker_(input)
    {
        vertices_.resize(input.tables.px.size());
    }
    Result<Frame> render(const FrameDesc& desc, Frame recycled) override;
    std::string device() const override { return cpu_name() + " (" + lanes_ + ")"; }

  private:
    FrameParams frame_params(const FrameDesc& desc);
    void prepare_workers(const FrameParams& f);
    void draw_geometry(const FrameParams& f, const FrameDesc& desc, Profiler* profiler);
    Status draw_bodies(const FrameDesc& desc, Frame& frame, Profiler* profiler);
    enum class Tiles { all, with_bodies };
    void draw_tiles(const FrameParams& f, Tiles which, bool parts_wanted, Frame& frame, Profiler* profiler);
    void draw_tile(const FrameParams& p, const TileRect& rect, const TilePart& part, int worker, Frame& frame, bool parts_wanted,
                   Profiler* profiler);

    RenderInput input_;
    std::string lanes_;
    const TileFns& fns_;
    FrameMaker maker_;
    Frame behind_; // the last frame of surfaces behind, for its memory
    struct TileCounts {
        std::uint32_t fragments = 0, background = 0; // visible ones, and pixels with background
        std::uint8_t bodies = 0;                     // 1: deferred, as it shows a transmissive material
    };
    std::vector<TileCounts> by_tile_;
    Column<SnappedVertex> vertices_;
    Bins bins_;
    std::vector<WorkerScratch> workers_;
    std::vector<WorkerScratch> layers_; // by worker, if a material blends
    std::vector<WorkerPeel> peels_;
};

bool shares_samples(const std::vector<MaterialRecord>& materials)
{
    return std::any_of(materials.begin(), materials.end(),
                       [](const MaterialRecord& m) { return (m.technique_traits & kSharesSamples) != 0; });
}

FrameParams TileRenderer::frame_params(const FrameDesc& desc)
{
    FrameParams f = {};
    static_cast<ShadingFrame&>(f) = maker_.make(desc);
    f.tile_size = desc.tile_size;
    f.tile_rim = shares_samples(maker_.materials()) ? 1 : 0;
    f.tile_step = f.tile_size - (f.tile_rim ? kRimRoom : 0);
    f.tiles_x = (desc.width + f.tile_step - 1) / f.tile_step;
    f.tiles_y = (desc.height + f.tile_step - 1) / f.tile_step;
    f.vertices = vertices_.data();
    f.blends = any_blends(maker_.materials());
    f.defers_bodies = maker_.shows_behind(desc) && f.behind < 0;
    return f;
}

// Collects the parts of a fragment behind blended surfaces: each sample is a part. x, y: pixel in the tile.
void collect_blended_parts(const FrameParams& f, int x, int y, std::uint32_t i, const TileScratch& s, PixelPart part,
                           std::vector<PixelPart>& to)
{
    const int block = y / kBlock * (f.tile_size / kBlock) + x / kBlock, in_block = y % kBlock * kBlock + x % kBlock;
    const std::array<float, 3> behind = part.color;
    const PeelScratch& p = *s.peel;
    for (std::uint32_t rest = static_cast<std::uint32_t>(s.fragment_mask[i]); rest; rest &= rest - 1) {
        const std::uint32_t sample = rest & -rest;
        const int at = (block * f.msaa + std::countr_zero(sample)) * kBlockPixels + in_block;
        const float through = p.through[at];
        const bool open = s.fragment_triangle[i] < 0; // no opaque surface lies behind
        part = pixel_part(part.pixel, sample, open && through == 1.0f,
                          {p.red[at] + behind[0] * through, p.green[at] + behind[1] * through, p.blue[at] + behind[2] * through},
                          open ? 1.0f - through : 1.0f);
        to.push_back(part);
    }
}

bool shows_blended(const FrameParams& f, int x, int y, const TileScratch& s)
{
    if (!s.peel || s.peel->triangle_count == 0)
        return false;
    return s.peel->pixels[y / kBlock * (f.tile_size / kBlock) + x / kBlock] >> (y % kBlock * kBlock + x % kBlock) & 1u;
}

// Collects the fragments that do not fill their pixel, in the tile's own pixels.
void collect_parts(const FrameParams& f, const TileRect& tile, const TileScratch& s, std::vector<PixelPart>& to)
{
    const std::uint32_t whole = (1u << f.msaa) - 1;
    const bool some_blended = f.msaa > 1 && s.peel && s.peel->triangle_count != 0;
    for (std::uint32_t i = 0; i < s.fragment_count; ++i) {
        const std::uint32_t samples = static_cast<std::uint32_t>(s.fragment_mask[i]);
        if (samples == whole && !some_blended)
            continue;
        const int x = s.fragment_pixel[i] & 255, y = s.fragment_pixel[i] >> 8;
        if (!tile.owns(x, y))
            continue;
        const bool blended = shows_blended(f, x, y, s);
        if (samples == whole && !(blended && f.msaa > 1))
            continue;
        const PixelPart part = pixel_part(static_cast<std::uint32_t>((tile.y0 + y) * f.width + tile.x0 + x), samples,
                                          s.fragment_triangle[i] < 0, {s.red[i], s.green[i], s.blue[i]});
        if (blended)
            collect_blended_parts(f, x, y, i, s, part, to);
        else
            to.push_back(part);
    }
}

void TileRenderer::prepare_workers(const FrameParams& f)
{
    const std::vector<MaterialRecord>& materials = maker_.materials();
    const bool shares = shares_samples(materials);
    const std::size_t threads = static_cast<std::size_t>(input_.jobs.threads());
    workers_.resize(threads);
    for (WorkerScratch& w : workers_)
        w.prepare(f.tile_size, f.msaa, materials.size(), shares);
    if (!f.blends)
        return;
    layers_.resize(threads), peels_.resize(threads);
    for (WorkerScratch& w : layers_)
        w.prepare(f.tile_size, f.msaa, materials.size(), shares);
    const std::size_t pixels = static_cast<std::size_t>(f.tile_size) * static_cast<std::size_t>(f.tile_size);
    for (WorkerPeel& p : peels_)
        p.prepare(pixels * static_cast<std::size_t>(f.msaa), pixels / kBlockPixels);
}

// Draws one tile, or a part of a tile, in the frame `p`.
void TileRenderer::draw_tile(const FrameParams& p, const TileRect& rect, const TilePart& part, int worker, Frame& frame, bool parts_wanted,
                             Profiler* profiler)
{
    ProfiledWork work(profiler, worker);
    const std::size_t me = static_cast<std::size_t>(worker);
    WorkerScratch& w = workers_[me];
    // Gather the triangles, and connect the layers' memory
    TileScratch scratch = w.view(frame, bins_.triangles_in(part)), layer = {};
    scratch.clock = profiler ? profiler->clock(worker) : nullptr;
    bins_.gather(part, w.entries.data(), w.triangles.data(), w.clips);
    scratch.clips = w.clips.data();
    PeelScratch peel = {};
    if (p.blends) {
        layer = layers_[me].view(frame, 0);
        layer.triangle_count = scratch.triangle_count, layer.entries = scratch.entries, layer.triangles = scratch.triangles;
        layer.clips = scratch.clips, layer.clock = scratch.clock;
        peel = peels_[me].view(layer, frame.through.empty() ? nullptr : frame.through.data());
        scratch.peel = &peel;
    }
    // Draw, and collect parts and statistics
    work.lap(FrameStage::gather);
    fns_.render_tile(p, rect, scratch);
    if (scratch.transmits && p.defers_bodies) { // parts of a tile may write at once
        std::atomic_ref(by_tile_[part.tile].bodies).store(1, std::memory_order_relaxed);
        return;
    }
    if (parts_wanted)
        collect_parts(p, rect, scratch, w.parts);
    std::atomic_ref(by_tile_[part.tile].fragments) += scratch.own_fragments - scratch.own_background + peel.fragment_count;
    std::atomic_ref(by_tile_[part.tile].background) += scratch.own_background;
    if (profiler)
        profiler->end_tile(worker, part.tile);
}

void TileRenderer::draw_tiles(const FrameParams& f, Tiles which, bool parts_wanted, Frame& frame, Profiler* profiler)
{
    const TraceSpan span("tiles");
    const std::size_t tiles = static_cast<std::size_t>(f.tiles_x) * static_cast<std::size_t>(f.tiles_y);
    {
        ProfiledWork work(profiler, 0);
        prepare_workers(f);
        work.lap(FrameStage::prepare);
    }
    // Choose the tiles
    std::vector<std::uint8_t> wanted(tiles, 1);
    if (which == Tiles::with_bodies)
        std::transform(by_tile_.begin(), by_tile_.end(), wanted.begin(), [](const TileCounts& t) { return t.bodies; });
    by_tile_.assign(tiles, {});
    // Cut the longest tiles into parts
    const TileSplit hot = tile_split(bins_.triangles_by_tile(tiles), input_.jobs.threads());
    const auto whole_from = hot.tiles.begin() + static_cast<std::ptrdiff_t>(hot.cut);
    std::vector<std::uint32_t> cut(hot.tiles.begin(), whole_from), known = hot.tiles;
    std::sort(cut.begin(), cut.end()), std::sort(known.begin(), known.end());
    FrameParams parts = f; // the frame with one tile's parts as its tiles
    parts.tile_step = f.tile_size / TilePart::kSide;
    parts.tile_size = f.tile_rim ? 32 : parts.tile_step; // with room for the rim
    parts.tiles_x = parts.tiles_y = TilePart::kSide;
    bins_.cut(f, parts, cut, fns_, input_.jobs);
    const auto draw = [&](const TilePart& part, int worker) {
        const int left = static_cast<int>(part.tile) % f.tiles_x * f.tile_step, top = static_cast<int>(part.tile) / f.tiles_x * f.tile_step;
        const int right = std::min(left + f.tile_step, f.width), bottom = std::min(top + f.tile_step, f.height);
        if (!wanted[part.tile])
            return;
        const bool whole = part.cut < 0;
        const FrameParams& p = whole ? f : parts;
        const int x = left + part.part % TilePart::kSide * p.tile_step, y = top + part.part / TilePart::kSide * p.tile_step;
        if (x >= right || y >= bottom)
            return; // a part beyond the tile or the image
        const TraceSpan tile_span("tile");
        draw_tile(p, tile_rect(p, x, y, right, bottom), part, worker, frame, parts_wanted, profiler);
    };
    // Draw long tiles first, then parts, each by the next free thread, then all others, a few neighbours at a time.
    std::vector<TilePart> order;
    order.reserve(tiles + cut.size() * TilePart::kSide * TilePart::kSide);
    for (auto tile = whole_from; tile != hot.tiles.end(); ++tile)
        order.push_back({*tile});
    for (std::size_t k = 0; k < cut.size(); ++k)
        for (std::int32_t part = 0; part < TilePart::kSide * TilePart::kSide; ++part)
            order.push_back({cut[k], static_cast<std::int32_t>(k), part});
    const std::size_t alone = order.size();
    for (std::uint32_t i = 0; i < tiles; ++i)
        if (!std::binary_search(known.begin(), known.end(), i))
            order.push_back({i});
    const std::size_t others = order.size() - alone, threads = static_cast<std::size_t>(input_.jobs.threads());
    const std::size_t few = std::clamp<std::size_t>(others / (16 * threads), 1, 16), pieces = alone + (others + few - 1) / few;
    std::atomic<std::size_t> next = 0;
    ControlledWork progress(ControlledWork::Kind::count, "", pieces);
    input_.jobs.parallel_for(threads, [&](std::size_t, int worker) {
        for (std::size_t piece = next++; piece < pieces; piece = next++) {
            check_stop();
            const std::size_t begin = piece < alone ? piece : alone + (piece - alone) * few;
            const std::size_t end = piece < alone ? begin + 1 : std::min(begin + few, order.size());
            for (std::size_t i = begin; i < end; ++i)
                draw(order[i], worker);
            progress.step(1);
        }
    });
    // Merge the workers' results
    std::vector<std::span<const PixelPart>> lists;
    for (const WorkerScratch& w : workers_)
        lists.push_back(w.parts);
    for (const TileCounts& t : by_tile_)
        if (!t.bodies)
            frame.stats.visible_fragments += t.fragments, frame.stats.background_pixels += t.background;
    if (!parts_wanted)
        return;
    const auto tile_of = [&](std::uint32_t pixel) {
        const int x = static_cast<int>(pixel) % f.width / f.tile_step, y = static_cast<int>(pixel) / f.width / f.tile_step;
        return static_cast<std::size_t>(y * f.tiles_x + x);
    };
    const std::vector<PixelPart> before = std::move(frame.parts);
    std::vector<PixelPart> kept;
    std::copy_if(before.begin(), before.end(), std::back_inserter(kept), [&](const PixelPart& p) { return !wanted[tile_of(p.pixel)]; });
    lists.push_back(kept);
    frame.parts.clear();
    merge_parts(lists, f.width, f.height, input_.jobs, frame.parts);
}

// Returns a frame with memory. Every pixel will be written, so a recycled picture with equal size keeps its contents.
Frame frame_for(const FrameDesc& desc, bool blends, Frame recycled)
{
    Frame frame;
    frame.color = std::move(recycled.color);
    const std::size_t bytes = static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.height) * 3 * sizeof(float);
    if (frame.color.width != desc.width || frame.color.height != desc.height || frame.color.channels != 3 ||
        frame.color.type != PixelType::f32 || frame.color.bytes.size() != bytes)
        frame.color = make_image(desc.width, desc.height, 3, PixelType::f32);
    const std::size_t samples =
        static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.height) * static_cast<std::size_t>(desc.msaa);
    if (desc.triangle_ids || desc.stages)
        frame.triangle_ids.resize(samples);
    if (desc.triangle_ids && blends) {
        frame.through.resize(samples);
        std::fill(frame.through.begin(), frame.through.end(), 1.0f);
    }
    if (desc.stages)
        frame.stages.depths.resize(samples), frame.stages.pairs.resize(samples * kPairWords);
    if (desc.layers)
        frame.layers.resize(samples / static_cast<std::size_t>(desc.msaa));
    return frame;
}

// Culls, transforms and bins the frame's triangles.
void TileRenderer::draw_geometry(const FrameParams& f, const FrameDesc& desc, Profiler* profiler)
{
    ProfiledWork work(profiler, 0);
    const Visible visible = cull(input_.tables, maker_.materials(), desc.view);
    work.lap(FrameStage::cull);
    work.end();
    transform_draws(f, input_.tables, visible, fns_, input_.jobs, profiler);
    bins_.build(f, input_.tables, visible, fns_, input_.jobs, profiler);
}

// Draws the frame's opaque surfaces, then again the tiles with transmissive bodies, which show these surfaces.
Status TileRenderer::draw_bodies(const FrameDesc& desc, Frame& frame, Profiler* profiler)
{
    const std::vector<TileCounts> by_tile = by_tile_;
    Result<Frame> behind = render(behind_frame(desc), std::move(behind_));
    BN_TRY(behind);
    behind_ = std::move(*behind);
    maker_.take_behind(behind_);
    by_tile_ = by_tile;
    const FrameParams f = frame_params(desc);
    draw_geometry(f, desc, profiler);
    draw_tiles(f, Tiles::with_bodies, desc.parts, frame, profiler);
    return {};
}

Result<Frame> TileRenderer::render(const FrameDesc& desc, Frame recycled)
{
    BN_TRY(maker_.check(desc));
    const TraceSpan span("frame");
    const auto begin = std::chrono::steady_clock::now();
    std::optional<Profiler> measured;
    if (desc.profile)
        measured.emplace(input_.jobs.threads(), maker_.scene().materials.size(), fns_.lanes);
    Profiler* const profiler = measured ? &*measured : nullptr;
    ProfiledWork before(profiler, 0);
    maker_.leave_behind();
    const FrameParams f = frame_params(desc);
    if (profiler)
        profiler->set_tiles(static_cast<std::size_t>(f.tiles_x) * static_cast<std::size_t>(f.tiles_y));
    Frame frame = frame_for(desc, f.blends, std::move(recycled));
    if (desc.stages)
        frame.stages.vertices.resize(input_.tables.px.size() * kVertexWords);
    before.lap(FrameStage::prepare);
    before.end();
    draw_geometry(f, desc, profiler);
    draw_tiles(f, Tiles::all, desc.parts, frame, profiler);
    frame.stats.triangles_drawn = bins_.triangle_count();
    if (f.defers_bodies && std::any_of(by_tile_.begin(), by_tile_.end(), [](const TileCounts& t) { return t.bodies != 0; }))
        BN_TRY(draw_bodies(desc, frame, profiler));
    if (desc.stages)
        fns_.record_vertices(f, static_cast<std::uint32_t>(input_.tables.px.size()), frame.stages.vertices.data());
    if (profiler)
        frame.profile = profiler->sum();
    frame.stats.triangles = input_.tables.triangle_count();
    frame.stats.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return frame;
}

} // namespace

std::unique_ptr<Renderer> make_tile_renderer(const RenderInput& input, Isa isa)
{
    return std::make_unique<TileRenderer>(input, pick<TileFns>(isa), isa_name(isa));
}

std::unique_ptr<Renderer> make_double_tile_renderer(const RenderInput& input)
{
    const auto fns = FnsByIsa<TileFns>::oracle;
    return fns ? std::make_unique<TileRenderer>(input, fns(nullptr), "double") : nullptr;
}

std::unique_ptr<Renderer> make_tile_renderer_of(const RenderInput& input, const TileFns& fns, const std::string& lanes)
{
    return std::make_unique<TileRenderer>(input, fns, lanes);
}

bool has_counting_lanes()
{
    const auto fns = FnsByIsa<TileFns>::counted;
    return fns != nullptr;
}

Result<CountedFrame> draw_counted(const RenderInput& input, const FrameDesc& desc)
{
    if (!has_counting_lanes())
        return Error{ExitCode::unavailable, "", "",
                     "this program has no lanes that count operations: build it with -DBN_COUNTING_LANES=ON"};
    const TileFns& fns = FnsByIsa<TileFns>::counted(nullptr);
    const Jobs alone(1); // lanes count by thread
    RenderInput here{input.scene, input.tables, input.environment, input.dfg, alone, input.ltc, input.phong, input.mips, input.pyramids};
    TileRenderer renderer(here, fns, "counted");
    const LaneWork before = fns.work();
    Result<Frame> frame = renderer.render(desc, {});
    BN_TRY(frame);
    const LaneWork after = fns.work();
    return CountedFrame{std::move(*frame), {after.operations - before.operations, after.bytes - before.bytes}};
}

} // namespace burnish
