#include "raster/vulkan/vulkan_renderer.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/base/check.h"
#include "core/base/clock.h"
#include "raster/frame/pixel_parts.h"
#include "raster/frame/upload.h"
#include "raster/vulkan/bands.h"
#include "raster/vulkan/context.h"
#include "raster/vulkan/forward.h"
#include "raster/vulkan/frame_numbers.h"
#include "raster/vulkan/gpu_scene.h"
#include "raster/vulkan/pipelines.h"

namespace burnish {

bool vulkan_built()
{
    return true;
}

namespace {

constexpr VkFormat kIdFormat = VK_FORMAT_R32G32_SFLOAT; // lower and upper 16 bits; see visibility.frag
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr std::uint32_t kMinSetups = 1024;

std::int32_t recorded_of(const FrameDesc& desc, bool blends)
{
    return (desc.stages ? kGpuRecordStages : 0) | (desc.layers ? kGpuRecordLayers : 0) | (desc.parts || blends ? kGpuRecordColors : 0);
}

// Returns the words recorded for this number of pixels. recorded: kGpuRecordStages...
std::size_t recorded_words(std::int32_t recorded, int msaa, std::size_t pixels)
{
    const std::size_t samples = pixels * static_cast<std::size_t>(msaa);
    return (recorded & kGpuRecordStages ? samples * kPairWords : 0) + (recorded & kGpuRecordLayers ? pixels * kLayerWords : 0) +
           (recorded & kGpuRecordColors ? 3 * samples : 0);
}

// Images and buffers of one band.
struct Targets {
    int width = 0, rows = 0, msaa = 0; // 0: none
    std::int32_t recorded = 0;         // kGpuRecordStages...
    bool native = false, shares = false;
    int rim() const { return shares ? kBandRim : 0; }
    DeviceImage id, depth;
    Buffer ids, depths, color, records, lines, peel;
};

class Device final : public VulkanDevice {
  public:
    explicit Device(const VulkanOptions& wanted) : options(wanted), context(wanted), pipelines(context, wanted) {}
    const VulkanDeviceInfo& info() const override { return context.info(); }

    VulkanOptions options;
    Context context;
    Pipelines pipelines;
};

class VulkanRenderer final : public Renderer {
  public:
    VulkanRenderer(const RenderInput& input, std::shared_ptr<Device> device)
        : device_(std::move(device)), context_(device_->context), pipelines_(device_->pipelines), scene_(context_, input),
          vertices_(context_, input.tables.px.size() * sizeof(GpuVertex), Buffer::Place::host),
          counts_(context_, input.tables.triangle_count() * sizeof(std::int32_t), Buffer::Place::device),
          draw_(context_, sizeof(GpuDraw), Buffer::Place::host, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT),
          forward_(context_, pipelines_, scene_, input, device_->options)
    {
        make_setups(static_cast<std::uint32_t>(input.tables.triangle_count()) + kMinSetups);
    }
    Result<Frame> render(const FrameDesc& desc, Frame) override;
    std::string device() const override { return context_.info().name + ", " + context_.info().driver; }

  private:
    void make_setups(std::uint32_t capacity);
    void make_targets(const FrameDesc& desc);
    void bind(Binding binding, const Buffer& buffer) { pipelines_.bind_buffer(binding, buffer); }
    std::vector<std::pair<Binding, const Buffer*>> scene_bindings() const;
    void bind_all();
    void dispatch(VkCommandBuffer c, VkPipeline pipeline, std::size_t invocations);
    void geometry(VkCommandBuffer c);
    bool blends() const { return any_blends(scene_.tables().materials); }
    void visibility(VkCommandBuffer c, const GpuPass& pass);
    void all_visibility(VkCommandBuffer c, const Band& band, int surfaces);
    Specialization shade_constants(const FrameDesc& desc) const;
    void shade(VkCommandBuffer c, const FrameDesc& desc, const Band& band);
    void compose(VkCommandBuffer c, const FrameDesc& desc, const Band& band, int phase);
    void submit(VkCommandBuffer c); // measures the time too
    void begin_frame(const FrameDesc& desc);
    void draw_band(const FrameDesc& desc, const Band& band, int surfaces);
    void draw_blended(const FrameDesc& desc, const Band& band, Frame& frame);
    void read_band(const FrameDesc& desc, const Band& band, Frame& frame);
    void read_layers(const FrameDesc& desc, const Band& band, Frame& frame);
    void read_blended(const FrameDesc& desc, const Band& band, Frame& frame);
    std::size_t band_bytes() const { return device_->options.band_bytes ? device_->options.band_bytes : kBandBytes; }
    Frame render_ids(const FrameDesc& desc);
    Frame render_forward(const FrameDesc& desc);

    std::shared_ptr<Device> device_;
    Context& context_;
    Pipelines& pipelines_;
    GpuScene scene_;
    Buffer vertices_, counts_, draw_, setups_;
    ForwardPass forward_;
    std::uint32_t setup_capacity_ = 0;
    double device_ms_ = 0.0, device_cpu_ms_ = 0.0;
    Targets targets_;
};

void VulkanRenderer::make_setups(std::uint32_t capacity)
{
    require_limit(context_, "SessionParts::scene", "maxStorageBufferRange", capacity * sizeof(GpuSetup), context_.features().max_buffer);
    setups_ = Buffer(context_, capacity * sizeof(GpuSetup), Buffer::Place::host);
    setup_capacity_ = capacity;
}

void VulkanRenderer::make_targets(const FrameDesc& desc)
{
    require_width(context_, desc.width);
    const std::size_t msaa = static_cast<std::size_t>(desc.msaa);
    const std::vector<MaterialRecord> materials = in_frame(scene_.tables().materials, desc);
    bool shares = false;
    for (std::size_t i = 0; i < materials.size(); ++i)
        shares = shares || (traits_for(technique_of(desc, i), materials[i].anisotropic != 0) & kSharesSamples) != 0;
    const std::int32_t recorded = recorded_of(desc, blends());
    const std::size_t words =
        std::max({std::size_t{3}, msaa * static_cast<std::size_t>(shares ? kGpuSharedSampleWords : 1),
                  msaa * static_cast<std::size_t>(blends() ? kGpuPeelWords : 1), recorded_words(recorded, desc.msaa, 1)}); // per pixel
    const int rows = band_rows(desc.width, desc.height, words * sizeof(float), band_bytes(), shares ? kBandRim : 0);
    require_limit(context_, "FrameDesc::width", "maxStorageBufferRange",
                  words * sizeof(float) * static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(rows),
                  context_.features().max_buffer);
    Targets t;
    t.width = desc.width, t.rows = rows, t.msaa = desc.msaa, t.recorded = recorded, t.shares = shares;
    t.native = desc.msaa == 1 ||
               ((context_.features().target_samples & static_cast<VkSampleCountFlags>(desc.msaa)) && context_.features().standard_samples);
    if (t.width == targets_.width && t.rows == targets_.rows && t.msaa == targets_.msaa && t.recorded == targets_.recorded &&
        t.shares == targets_.shares)
        return;
    targets_ = Targets();
    ImageShape shape;
    shape.width = t.width, shape.height = rows;
    shape.samples = t.native ? static_cast<VkSampleCountFlagBits>(desc.msaa) : VK_SAMPLE_COUNT_1_BIT;
    shape.format = kIdFormat, shape.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    t.id = DeviceImage(context_, shape);
    shape.format = kDepthFormat, shape.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    t.depth = DeviceImage(context_, shape);
    const std::size_t pixels = static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(rows), samples = pixels * msaa;
    t.ids = Buffer(context_, samples * sizeof(std::int32_t), Buffer::Place::host);
    t.depths = Buffer(context_, samples * sizeof(float), Buffer::Place::host);
    t.color = Buffer(context_, 3 * pixels * sizeof(float), Buffer::Place::host);
    t.records = Buffer(context_, recorded_words(recorded, desc.msaa, pixels) * sizeof(std::uint32_t), Buffer::Place::host);
    t.lines = Buffer(context_, shares ? samples * kGpuSharedSampleWords * sizeof(float) : 0, Buffer::Place::device);
    t.peel = Buffer(context_, blends() ? samples * kGpuPeelWords * sizeof(float) : 0, Buffer::Place::host);
    targets_ = std::move(t); // only a complete set
}

std::vector<std::pair<Binding, const Buffer*>> VulkanRenderer::scene_bindings() const
{
    return {{kTexelsBinding, &scene_.pages()},  {kRealsBinding, &scene_.reals()},           {kIntsBinding, &scene_.ints()},
            {kFrameBinding, &scene_.frame()},   {kMaterialsBinding, &scene_.materials()},   {kTexturesBinding, &scene_.textures()},
            {kLightsBinding, &scene_.lights()}, {kAreaLightsBinding, &scene_.area_lights()}};
}

void VulkanRenderer::bind_all()
{
    for (const auto& [binding, buffer] : scene_bindings())
        bind(binding, *buffer);
    bind(kVerticesBinding, vertices_), bind(kSetupsBinding, setups_), bind(kCountsBinding, counts_), bind(kDrawBinding, draw_);
    bind(kIdsBinding, targets_.ids), bind(kDepthsBinding, targets_.depths);
    bind(kColorBinding, targets_.color), bind(kRecordsBinding, targets_.records), bind(kLinesBinding, targets_.lines);
    bind(kPeelBinding, targets_.peel);
    pipelines_.bind_image(kIdImageBinding, targets_.id), pipelines_.bind_image(kDepthImageBinding, targets_.depth);
}

void VulkanRenderer::dispatch(VkCommandBuffer c, VkPipeline pipeline, std::size_t invocations)
{
    vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    pipelines_.dispatch(c, invocations);
}

// Snaps vertices to the sub-pixel grid, and sets up triangles.
void VulkanRenderer::geometry(VkCommandBuffer c)
{
    const std::size_t triangles = static_cast<std::size_t>(scene_.places().triangle_count);
    dispatch(c, pipelines_.compute("transform"), static_cast<std::size_t>(scene_.places().vertex_count));
    const char* const setup = context_.features().float64 ? "setup_exact" : "setup";
    GpuPass pass = {};
    pipelines_.push(c, pass);
    dispatch(c, pipelines_.compute(setup), triangles);
    dispatch(c, pipelines_.compute("scan"), 1);
    pass.group = 1;
    pipelines_.push(c, pass);
    dispatch(c, pipelines_.compute(setup), triangles);
}

// Runs one rasterizer pass, and copies its ids and depths to buffers.
void VulkanRenderer::visibility(VkCommandBuffer c, const GpuPass& pass)
{
    change_layout(c, targets_.id, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    change_layout(c, targets_.depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    auto color = vk_struct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    color.imageView = targets_.id.view(), color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR, color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    color.clearValue.color = {{-1.0f, -1.0f, 0.0f, 0.0f}};
    auto depth = vk_struct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    depth.imageView = targets_.depth.view(), depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR, depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE; // cleared to 0: reversed depth
    const VkRect2D area = {{0, 0}, {static_cast<std::uint32_t>(targets_.width), static_cast<std::uint32_t>(pass.rows)}};
    auto rendering = vk_struct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea = area, rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1, rendering.pColorAttachments = &color, rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(c, &rendering);
    GraphicsState state = {"visibility_vert", context_.features().float64 ? "visibility_exact" : "visibility", kIdFormat,
                           targets_.native ? static_cast<VkSampleCountFlagBits>(targets_.msaa) : VK_SAMPLE_COUNT_1_BIT,
                           VK_COMPARE_OP_GREATER};
    vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_.graphics(state));
    pipelines_.bind_set(c, VK_PIPELINE_BIND_POINT_GRAPHICS);
    const float half = static_cast<float>(viewport_half(context_.features()));
    const int center_x = scene_.record().center_x / kSubpixel, center_y = scene_.record().center_y / kSubpixel - pass.first_row;
    const VkViewport viewport = {static_cast<float>(center_x) - half, static_cast<float>(center_y) - half, 2 * half, 2 * half, 0.0f, 1.0f};
    vkCmdSetViewport(c, 0, 1, &viewport);
    vkCmdSetScissor(c, 0, 1, &area);
    vkCmdSetCullMode(c, VK_CULL_MODE_NONE);
    pipelines_.push(c, pass);
    vkCmdDrawIndirect(c, draw_.handle(), 0, 1, sizeof(GpuDraw));
    vkCmdEndRendering(c);
    change_layout(c, targets_.id, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    change_layout(c, targets_.depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    dispatch(c, pipelines_.compute(targets_.native && targets_.msaa > 1 ? "gather_ms" : "gather"),
             static_cast<std::size_t>(targets_.width) * static_cast<std::size_t>(pass.rows));
}

// Rasterizes all samples, one pass each if the device lacks the sample count. surfaces: kGpuSolid...
void VulkanRenderer::all_visibility(VkCommandBuffer c, const Band& band, int surfaces)
{
    if (targets_.native) {
        visibility(c, {0, 0, targets_.msaa == 1 ? 0 : -1, 0, 0, band.first_row, band.rows, 0, surfaces, 0, 0});
        return;
    }
    const SamplePattern& pattern = scene_.record().pattern;
    for (int s = 0; s < targets_.msaa; ++s)
        visibility(c, {kSubpixel / 2 - pattern.x[s], kSubpixel / 2 - pattern.y[s], s, 0, 0, band.first_row, band.rows, 0, surfaces, 0, 0});
}

bool any_shares_samples(const std::vector<MaterialRecord>& materials)
{
    return std::any_of(materials.begin(), materials.end(),
                       [](const MaterialRecord& m) { return (m.technique_traits & kSharesSamples) != 0; });
}

Specialization VulkanRenderer::shade_constants(const FrameDesc& desc) const
{
    const bool shares = any_shares_samples(scene_.materials_of_frame());
    const Used others = used_by(device_->options.frames, shares);
    Specialization constants = technique_constants(scene_.materials_of_frame(), scene_.record(), others);
    constants.insert(constants.end(), {recorded_of(desc, blends()), shares});
    return constants;
}

void VulkanRenderer::shade(VkCommandBuffer c, const FrameDesc& desc, const Band& band)
{
    const Specialization constants = shade_constants(desc);
    if (desc.stages)
        vkCmdFillBuffer(c, targets_.records.handle(), 0, VK_WHOLE_SIZE, 0);
    full_barrier(c);
    pipelines_.push(c, {0, 0, 0, 0, 0, band.first_row, band.rows, 0, 0, 0, 0});
    const std::size_t pixels = static_cast<std::size_t>(targets_.width) * static_cast<std::size_t>(band.rows);
    dispatch(c, pipelines_.compute("shade", constants), pixels);
    if (constants.back())
        dispatch(c, pipelines_.compute("share", constants), pixels);
}

// Runs a phase of compose.comp.
void VulkanRenderer::compose(VkCommandBuffer c, const FrameDesc& desc, const Band& band, int phase)
{
    Specialization constants = shade_constants(desc);
    constants.insert(constants.end(), {-1, phase});
    pipelines_.push(c, {0, 0, 0, 0, 0, band.first_row, band.rows, 0, 0, band.own_begin, band.own_end});
    dispatch(c, pipelines_.compute("compose", constants), static_cast<std::size_t>(targets_.width) * static_cast<std::size_t>(band.rows));
}

void VulkanRenderer::begin_frame(const FrameDesc& desc)
{
    device_ms_ = device_cpu_ms_ = 0.0;
    scene_.prepare(context_, desc, setup_capacity_);
    pipelines_.know(known_numbers(scene_.record(), scene_.materials_of_frame(), scene_.tables().area_lights, device_->options.frames));
    bind_all();
}

// Draws the solid or all surfaces of a band. The first band also sets up triangles. surfaces: kGpuSolid or kGpuAll.
void VulkanRenderer::draw_band(const FrameDesc& desc, const Band& band, int surfaces)
{
    VkCommandBuffer c = context_.begin();
    pipelines_.bind_set(c, VK_PIPELINE_BIND_POINT_COMPUTE);
    if (band.first_row + band.own_begin == 0)
        geometry(c);
    all_visibility(c, band, surfaces);
    shade(c, desc, band);
    if (blends() && surfaces == kGpuSolid)
        compose(c, desc, band, 0);
    submit(c);
}

// Draws blended surfaces layer by layer, the nearest first, until a layer is empty.
void VulkanRenderer::draw_blended(const FrameDesc& desc, const Band& band, Frame& frame)
{
    GpuDraw& layer = *static_cast<GpuDraw*>(draw_.data());
    for (int pairs = 1; pairs > 0; pairs = layer.peeled) {
        layer.peeled = layer.peeled_own = 0;
        VkCommandBuffer c = context_.begin();
        pipelines_.bind_set(c, VK_PIPELINE_BIND_POINT_COMPUTE);
        all_visibility(c, band, kGpuLayer);
        shade(c, desc, band);
        compose(c, desc, band, 1);
        submit(c);
        frame.stats.visible_fragments += static_cast<std::uint64_t>(layer.peeled_own);
    }
    VkCommandBuffer c = context_.begin();
    pipelines_.bind_set(c, VK_PIPELINE_BIND_POINT_COMPUTE);
    compose(c, desc, band, 2);
    submit(c);
}

void VulkanRenderer::submit(VkCommandBuffer c)
{
    const double wall = wall_ms(), cpu = process_cpu_ms();
    context_.submit(c);
    device_ms_ += wall_ms() - wall, device_cpu_ms_ += process_cpu_ms() - cpu;
}

// Adds the parts of a band's pixels. ids, colors: by sample; the band starts with pixel `before` in the picture. A pair's colour lies at
// its first sample.
void add_parts(int msaa, std::size_t before, std::size_t pixels, const std::int32_t* ids, const float* colors, std::vector<PixelPart>& to)
{
    const std::uint32_t whole = (1u << msaa) - 1;
    for (std::size_t p = 0; p < pixels; ++p, ids += msaa, colors += 3 * msaa)
        for (std::uint32_t rest = whole; rest;) {
            const int begin = std::countr_zero(rest);
            std::uint32_t samples = 0;
            for (int s = begin; s < msaa; ++s)
                samples |= ids[s] == ids[begin] ? 1u << s : 0u;
            rest &= ~samples;
            const float* const c = colors + 3 * begin;
            if (samples != whole)
                to.push_back(pixel_part(static_cast<std::uint32_t>(before + p), samples, ids[begin] == kGpuNoTriangle, {c[0], c[1], c[2]}));
        }
}

// Copies a band's own pixels to the frame.
void VulkanRenderer::read_band(const FrameDesc& desc, const Band& band, Frame& frame)
{
    const std::size_t msaa = static_cast<std::size_t>(desc.msaa);
    const auto [first, skip, pixels, drawn] = own_pixels(desc.width, band);
    std::memcpy(frame.color.f32() + 3 * first, targets_.color.as<float>() + 3 * skip, 3 * pixels * sizeof(float));
    const std::int32_t* ids = targets_.ids.as<std::int32_t>() + skip * msaa;
    for (std::size_t p = 0; p < pixels; ++p) {
        const std::int32_t* of = ids + p * msaa;
        for (std::size_t s = 0; s < msaa; ++s) {
            if (std::find(of, of + s, of[s]) != of + s)
                continue;
            ++(of[s] == kGpuNoTriangle ? frame.stats.background_pixels : frame.stats.visible_fragments);
        }
    }
    if (!frame.triangle_ids.empty()) {
        const GpuSetup* setups = setups_.as<GpuSetup>();
        for (std::size_t i = 0; i < pixels * msaa; ++i)
            frame.triangle_ids[first * msaa + i] =
                ids[i] == kGpuNoTriangle ? kNoTriangle : static_cast<std::uint32_t>(setups[ids[i]].triangle);
    }
    const std::uint32_t* records = targets_.records.as<std::uint32_t>();
    if (desc.stages) {
        std::copy_n(targets_.depths.as<std::uint32_t>() + skip * msaa, pixels * msaa, frame.stages.depths.data() + first * msaa);
        std::copy_n(records + skip * msaa * kPairWords, pixels * msaa * kPairWords, frame.stages.pairs.data() + first * msaa * kPairWords);
        records += drawn * msaa * kPairWords;
    }
    if (desc.layers)
        records += drawn * kLayerWords;
    if (desc.parts)
        add_parts(desc.msaa, first, pixels, ids, reinterpret_cast<const float*>(records) + 3 * skip * msaa, frame.parts);
}

void VulkanRenderer::read_layers(const FrameDesc& desc, const Band& band, Frame& frame)
{
    const OwnPixels own = own_pixels(desc.width, band);
    const std::uint32_t* records = targets_.records.as<std::uint32_t>();
    if (desc.stages)
        records += own.drawn * static_cast<std::size_t>(desc.msaa) * kPairWords;
    std::memcpy(static_cast<void*>(frame.layers.data() + own.first), records + own.skip * kLayerWords, own.pixels * sizeof(PixelLayers));
}

// A sample's words in the peel buffer, named as in shading/stages/peel.glsl.
struct PeeledSample {
    float solid_depth;
    std::int32_t solid_id;
    float depth;
    std::int32_t id;
    float through, over[3], behind[3], shown;
};
static_assert(sizeof(PeeledSample) == kGpuPeelWords * sizeof(float));

// Replaces the data from read_band() in pixels with blended surfaces.
void VulkanRenderer::read_blended(const FrameDesc& desc, const Band& band, Frame& frame)
{
    const std::size_t msaa = static_cast<std::size_t>(desc.msaa);
    const OwnPixels own = own_pixels(desc.width, band);
    const std::size_t first = own.first, pixels = own.pixels;
    const PeeledSample* const samples = targets_.peel.as<PeeledSample>() + own.skip * msaa;
    const auto shown = [&](std::size_t pixel) { return samples[pixel * msaa].shown != 0.0f; };
    std::erase_if(frame.parts, [&](const PixelPart& part) { return part.pixel >= first && shown(part.pixel - first); });
    for (std::size_t p = 0; p < pixels; ++p) {
        if (!shown(p))
            continue;
        std::copy_n(targets_.color.as<float>() + 3 * (own.skip + p), 3, frame.color.f32() + 3 * (first + p));
        for (std::size_t s = 0; s < msaa; ++s) {
            const PeeledSample& at = samples[p * msaa + s];
            if (!frame.through.empty())
                frame.through[(first + p) * msaa + s] = at.through;
            const auto color = [&](int c) { return at.over[c] + at.behind[c] * at.through; };
            const bool open = at.solid_id == kGpuNoTriangle; // no opaque surface lies behind
            if (desc.parts && msaa > 1)
                frame.parts.push_back(pixel_part(static_cast<std::uint32_t>(first + p), 1u << s, open && at.through == 1.0f,
                                                 {color(0), color(1), color(2)}, open ? 1.0f - at.through : 1.0f));
        }
    }
    std::sort(frame.parts.begin(), frame.parts.end(), part_before);
}

// Returns a frame with room for the requested data.
Frame empty_frame(const FrameDesc& desc)
{
    const std::size_t samples =
        static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.height) * static_cast<std::size_t>(desc.msaa);
    Frame frame;
    frame.color = make_image(desc.width, desc.height, 3, PixelType::f32);
    if (desc.triangle_ids || desc.stages)
        frame.triangle_ids.resize(samples);
    if (desc.stages)
        frame.stages.depths.resize(samples), frame.stages.pairs.resize(samples * kPairWords);
    if (desc.layers)
        frame.layers.resize(samples / static_cast<std::size_t>(desc.msaa));
    return frame;
}

Frame VulkanRenderer::render_ids(const FrameDesc& desc)
{
    make_targets(desc);
    Frame frame = empty_frame(desc);
    if (desc.triangle_ids && blends()) {
        frame.through.resize(frame.triangle_ids.size());
        std::fill(frame.through.begin(), frame.through.end(), 1.0f);
    }
    begin_frame(desc);
    for (const Band& band : bands_of(desc.height, targets_.rows, targets_.rim())) {
        draw_band(desc, band, kGpuSolid);
        const auto setups = static_cast<std::uint32_t>(draw_.as<GpuDraw>()->setups);
        if (setups > setup_capacity_) { // in the first band: clipping made more pieces than expected
            make_setups(setups + setups / 4);
            begin_frame(desc);
            draw_band(desc, band, kGpuSolid);
        }
        read_band(desc, band, frame);
        if (desc.layers && !blends())
            read_layers(desc, band, frame);
        if (!blends())
            continue;
        draw_blended(desc, band, frame);
        read_blended(desc, band, frame);
        if (desc.layers) {
            draw_band(desc, band, kGpuAll);
            read_layers(desc, band, frame);
        }
    }
    frame.stats.triangles = static_cast<std::uint64_t>(scene_.places().triangle_count);
    frame.stats.triangles_drawn = static_cast<std::uint64_t>(draw_.as<GpuDraw>()->setups);
    frame.stats.samples_emulated = !targets_.native;
    frame.stats.depth_interpolated = !context_.features().float64;
    if (desc.stages)
        frame.stages.vertices.assign(vertices_.as<std::uint32_t>(), static_cast<std::size_t>(scene_.places().vertex_count) * kVertexWords);
    return frame;
}

Frame VulkanRenderer::render_forward(const FrameDesc& desc)
{
    device_ms_ = device_cpu_ms_ = 0.0;
    scene_.prepare(context_, desc, setup_capacity_);
    pipelines_.know({});
    forward_.prepare(desc, band_bytes());
    for (const auto& [binding, buffer] : scene_bindings())
        bind(binding, *buffer);
    Frame frame = empty_frame(desc);
    const Used others = used_by(device_->options.frames, false);
    const Specialization technique = technique_constants(scene_.materials_of_frame(), scene_.record(), others);
    for (const Band& band : bands_of(desc.height, forward_.rows(), 0)) {
        VkCommandBuffer c = context_.begin();
        forward_.draw(c, technique, band);
        submit(c);
        forward_.read(band, frame);
        if (desc.stages)
            forward_.record(desc, band, frame);
    }
    frame.stats.triangles = frame.stats.triangles_drawn = static_cast<std::uint64_t>(scene_.places().triangle_count);
    frame.stats.depth_interpolated = true;
    return frame;
}

Result<Frame> VulkanRenderer::render(const FrameDesc& desc, Frame)
{
    BN_TRY(scene_.check(desc));
    const bool forward = device_->options.pipeline != VulkanPipeline::ids;
    const bool brought = forward && device_->options.shaders != nullptr;
    if (forward && desc.window.picture_width > 0)
        return Error{ExitCode::usage, "", "", "forward draws whole pictures alone; ids draws windows of them", "VulkanOptions::pipeline"};
    if (brought && (desc.stages || desc.triangle_ids))
        return Error{ExitCode::usage, "", "", "shaders of a caller have neither stages nor triangle ids", "VulkanOptions::shaders"};
    if (forward && (desc.layers || desc.parts))
        return Error{ExitCode::usage, "", "", "only ids has layers and parts of pixels", "VulkanOptions::pipeline"};
    if (forward && !brought && blends())
        return Error{ExitCode::usage, "", "", "forward does not sort blended surfaces, which the scene has; ids does",
                     "VulkanOptions::pipeline"};
    if (forward && desc.triangle_ids && !desc.stages)
        return Error{ExitCode::usage, "", "", "forward has triangle ids only among its stages", "VulkanOptions::pipeline"};
    try {
        const double begin = wall_ms();
        if (!forward && scene_.shows_behind(desc))
            scene_.take_behind(render_ids(behind_frame(desc)));
        Frame frame = forward ? render_forward(desc) : render_ids(desc);
        if (const std::string messages = context_.validation_messages(); !messages.empty())
            return Error{ExitCode::internal, "", "validation layer", messages};
        frame.stats.ms = wall_ms() - begin;
        frame.stats.device_ms = device_ms_, frame.stats.device_cpu_ms = device_cpu_ms_;
        return frame;
    } catch (const VulkanError& failed) {
        return failed.error;
    }
}

} // namespace

Result<std::shared_ptr<VulkanDevice>> open_vulkan_device(const VulkanOptions& options)
{
    try {
        return std::shared_ptr<VulkanDevice>(std::make_shared<Device>(options));
    } catch (const VulkanError& failed) {
        return failed.error;
    }
}

Result<std::unique_ptr<Renderer>> make_vulkan_renderer(const RenderInput& input, const std::shared_ptr<VulkanDevice>& device)
{
    try {
        return std::unique_ptr<Renderer>(std::make_unique<VulkanRenderer>(input, std::static_pointer_cast<Device>(device)));
    } catch (const VulkanError& failed) {
        return failed.error;
    }
}

} // namespace burnish
