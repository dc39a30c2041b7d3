#include "raster/vulkan/forward.h"

#include <algorithm>
#include <fmt/format.h>

namespace burnish {

namespace {
constexpr VkFormat kColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr std::size_t kTexelBytes = 16;
constexpr std::size_t kSampleWords = 4 * kGpuForwardGroups;

std::int32_t used_textures(const MaterialRecord& m)
{
    std::int32_t bits = 0;
    for (int i = 0; i < kTextureSlots; ++i)
        bits |= m.textures[i].texture >= 0 ? 1 << i : 0;
    return bits;
}
} // namespace

void ForwardPass::prepare(const FrameDesc& desc, std::size_t band_bytes)
{
    const bool box = scene_.mip_env().levels > 0;
    if (sampler_ == VulkanSampler::native && (!native_ || native_->has_box() != box)) {
        native_.reset();
        native_.emplace(context_, pipelines_.native_layout(), input_, scene_);
    }
    if (drawer_)
        drawer_->prepare(desc);
    make_targets(desc, band_bytes);
    if (!desc.stages)
        return;
    pipelines_.bind_image(kIdImageBinding, samples()), pipelines_.bind_image(kDepthImageBinding, targets_.depth);
    pipelines_.bind_buffer(kIdsBinding, targets_.ids), pipelines_.bind_buffer(kDepthsBinding, targets_.depths);
    pipelines_.bind_buffer(kRecordsBinding, targets_.words);
}

void ForwardPass::make_targets(const FrameDesc& desc, std::size_t band_bytes)
{
    require_width(context_, desc.width);
    if (!(context_.features().target_samples & static_cast<VkSampleCountFlags>(desc.msaa)))
        throw VulkanError{Error{ExitCode::unavailable, "", "",
                                fmt::format("forward: {} cannot take {} samples a pixel", context_.info().name, desc.msaa),
                                "VulkanOptions::pipeline"}};
    const std::size_t msaa = static_cast<std::size_t>(desc.msaa);
    const int rows = band_rows(desc.width, desc.height, desc.stages ? msaa * kSampleWords * sizeof(float) : std::max(kTexelBytes, msaa * 4),
                               band_bytes, 0);
    Targets t;
    t.width = desc.width, t.rows = rows, t.msaa = desc.msaa, t.stages = desc.stages;
    if (t.width == targets_.width && t.rows == targets_.rows && t.msaa == targets_.msaa && t.stages == targets_.stages)
        return;
    targets_ = Targets();
    const VkImageUsageFlags sampled = t.stages ? VK_IMAGE_USAGE_SAMPLED_BIT : 0;
    ImageShape shape;
    shape.width = t.width, shape.height = rows;
    shape.format = kColorFormat, shape.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | sampled;
    t.resolved = DeviceImage(context_, shape);
    shape.samples = static_cast<VkSampleCountFlagBits>(t.msaa);
    shape.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | sampled;
    if (t.msaa > 1)
        t.color = DeviceImage(context_, shape);
    shape.format = VK_FORMAT_D32_SFLOAT, shape.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | sampled;
    t.depth = DeviceImage(context_, shape);
    const std::size_t pixels = static_cast<std::size_t>(t.width) * static_cast<std::size_t>(rows);
    t.pixels = Buffer(context_, pixels * kTexelBytes, Buffer::Place::host);
    if (t.stages) {
        t.ids = Buffer(context_, pixels * msaa * sizeof(std::int32_t), Buffer::Place::host);
        t.depths = Buffer(context_, pixels * msaa * sizeof(float), Buffer::Place::host);
        t.words = Buffer(context_, pixels * msaa * kSampleWords * sizeof(float), Buffer::Place::host);
    }
    targets_ = std::move(t); // only a complete set
}

GraphicsState ForwardPass::state(std::string vertex, std::string fragment, VkCompareOp compare) const
{
    const std::string suffix = sampler_ == VulkanSampler::native ? "_native" : "";
    return {std::move(vertex), std::move(fragment) + suffix, kColorFormat, static_cast<VkSampleCountFlagBits>(targets_.msaa), compare};
}

void ForwardPass::bind_native(VkCommandBuffer c, std::size_t material)
{
    if (!native_)
        return;
    const VkDescriptorSet set = native_->set(material);
    vkCmdBindDescriptorSets(c, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_.layout(), 1, 1, &set, 0, nullptr);
}

// Draws the scene. stages: outputs words of the pass's group, with unindexed vertices; otherwise colours.
void ForwardPass::draw_scene(VkCommandBuffer c, const Specialization& technique, const GpuPass& pass, bool stages)
{
    const char* const fragment = stages                             ? "forward_stages"
                                 : centroid_                        ? "forward_centroid"
                                 : context_.features().primitive_id ? "forward_id"
                                                                    : "forward";
    vkCmdBindIndexBuffer(c, scene_.ints().handle(), static_cast<VkDeviceSize>(scene_.places().index_base) * sizeof(std::uint32_t),
                         VK_INDEX_TYPE_UINT32);
    for (const Draw& draw : input_.tables.draws) {
        const auto material = static_cast<std::size_t>(draw.material);
        const MaterialRecord& m = scene_.materials_of_frame()[material];
        Specialization constants = stages ? Specialization(2) : technique; // constant_id 0, 1
        constants.insert(constants.end(), {0, 0});                         // 2, 3: for compute stages only
        constants.push_back(used_textures(m));
        constants.push_back(targets_.msaa);
        if (stages)
            constants.insert(constants.end(), {context_.features().primitive_id, pass.group});
        vkCmdBindPipeline(
            c, VK_PIPELINE_BIND_POINT_GRAPHICS,
            pipelines_.graphics(state(stages ? "forward_stages_vert" : "forward_vert", fragment, VK_COMPARE_OP_GREATER), constants));
        bind_native(c, material);
        vkCmdSetCullMode(c, m.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        GpuPass of_draw = pass;
        of_draw.material = draw.material, of_draw.first_triangle = static_cast<std::int32_t>(draw.first_triangle);
        pipelines_.push(c, of_draw);
        if (stages)
            vkCmdDraw(c, 3 * draw.triangle_count, 1, 3 * draw.first_triangle, 0);
        else
            vkCmdDrawIndexed(c, 3 * draw.triangle_count, 1, 3 * draw.first_triangle, 0, 0);
    }
}

// Draws the background last, where nothing was drawn: at depth 0, the farthest.
void ForwardPass::draw_backdrop(VkCommandBuffer c, const GpuPass& pass)
{
    vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_GRAPHICS,
                      pipelines_.graphics(state("backdrop_vert", "backdrop", VK_COMPARE_OP_GREATER_OR_EQUAL)));
    bind_native(c, 0);
    vkCmdSetCullMode(c, VK_CULL_MODE_NONE);
    pipelines_.push(c, pass);
    vkCmdDraw(c, 3, 1, 0, 0);
}

void ForwardPass::begin(VkCommandBuffer c, const Band& band, bool resolves)
{
    change_layout(c, samples(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    if (resolves)
        change_layout(c, targets_.resolved, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    change_layout(c, targets_.depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    auto color = vk_struct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    color.imageView = samples().view(), color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.storeOp = resolves && !targets_.stages ? VK_ATTACHMENT_STORE_OP_DONT_CARE : VK_ATTACHMENT_STORE_OP_STORE;
    color.clearValue.color = {{-1.0f, -1.0f, 0.0f, 0.0f}}; // no triangle; a picture's backdrop covers it
    if (resolves) {
        color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
        color.resolveImageView = targets_.resolved.view(), color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    }
    auto depth = vk_struct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    depth.imageView = targets_.depth.view(), depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR; // to 0: reversed depth
    depth.storeOp = targets_.stages ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
    const VkRect2D area = {{0, 0}, {static_cast<std::uint32_t>(targets_.width), static_cast<std::uint32_t>(band.rows)}};
    auto rendering = vk_struct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea = area, rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1, rendering.pColorAttachments = &color, rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(c, &rendering);
    pipelines_.bind_set(c, VK_PIPELINE_BIND_POINT_GRAPHICS);
    const VkViewport viewport = {
        0, -static_cast<float>(band.first_row), static_cast<float>(targets_.width), static_cast<float>(scene_.record().height), 0.0f, 1.0f};
    vkCmdSetViewport(c, 0, 1, &viewport);
    vkCmdSetScissor(c, 0, 1, &area);
}

void ForwardPass::draw(VkCommandBuffer c, const Specialization& technique, const Band& band)
{
    const GpuPass pass = {0, 0, -1, 0, 0, band.first_row, band.rows, 0, 0, 0, 0};
    begin(c, band, targets_.msaa > 1);
    if (drawer_)
        drawer_->draw(c, *native_, static_cast<VkSampleCountFlagBits>(targets_.msaa), kColorFormat, band);
    else {
        draw_scene(c, technique, pass, false);
        draw_backdrop(c, pass);
    }
    vkCmdEndRendering(c);
}

void ForwardPass::read(const Band& band, Frame& frame)
{
    VkCommandBuffer c = context_.begin();
    change_layout(c, targets_.resolved, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy copy = {};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {static_cast<std::uint32_t>(targets_.width), static_cast<std::uint32_t>(band.rows), 1};
    vkCmdCopyImageToBuffer(c, targets_.resolved.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, targets_.pixels.handle(), 1, &copy);
    change_layout(c, targets_.resolved, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    full_barrier(c);
    context_.submit(c);
    const std::size_t width = static_cast<std::size_t>(targets_.width), pixels = width * static_cast<std::size_t>(band.rows);
    float* to = frame.color.f32() + 3 * width * static_cast<std::size_t>(band.first_row);
    for (std::size_t p = 0; p < pixels; ++p)
        std::copy_n(targets_.pixels.as<float>() + 4 * p, 3, to + 3 * p);
}

// Copies the sample image and its depths to buffers.
void ForwardPass::gather(VkCommandBuffer c, const char* shader, const Band& band, int group)
{
    const std::string name = std::string(shader) + (targets_.msaa > 1 ? "_ms" : "");
    change_layout(c, samples(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    change_layout(c, targets_.depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_.compute(name));
    pipelines_.bind_set(c, VK_PIPELINE_BIND_POINT_COMPUTE);
    pipelines_.push(c, {0, 0, 0, 0, 0, band.first_row, band.rows, group, 0, 0, 0});
    pipelines_.dispatch(c, static_cast<std::size_t>(targets_.width) * static_cast<std::size_t>(band.rows));
}

void ForwardPass::record(const FrameDesc& desc, const Band& band, Frame& frame)
{
    VkCommandBuffer c = context_.begin();
    gather(c, "gather_words", band, kGpuColorGroup); // of the picture that draw() left
    for (int group = 0; group < kGpuColorGroup; ++group) {
        begin(c, band, false);
        draw_scene(c, {}, {0, 0, -1, 0, 0, band.first_row, band.rows, group, 0, 0, 0}, true);
        vkCmdEndRendering(c);
        gather(c, group == 0 ? "gather" : "gather_words", band, group);
    }
    context_.submit(c);
    fill_frame(desc, band, frame);
}

void ForwardPass::fill_frame(const FrameDesc& desc, const Band& band, Frame& frame) const
{
    const std::size_t width = static_cast<std::size_t>(desc.width), msaa = static_cast<std::size_t>(desc.msaa);
    const std::size_t first = width * static_cast<std::size_t>(band.first_row) * msaa,
                      count = width * static_cast<std::size_t>(band.rows) * msaa;
    const std::int32_t* ids = targets_.ids.as<std::int32_t>();
    std::copy_n(targets_.depths.as<std::uint32_t>(), count, frame.stages.depths.data() + first);
    for (std::size_t s = 0; s < count; ++s) {
        frame.triangle_ids[first + s] = static_cast<std::uint32_t>(ids[s]);
        const std::size_t in_pixel = s % msaa;
        const std::int32_t* const of = ids + (s - in_pixel);
        if (std::find(of, of + in_pixel, ids[s]) != of + in_pixel)
            continue; // not the first sample of its pair
        std::uint32_t mask = 0;
        for (std::size_t k = in_pixel; k < msaa; ++k)
            mask |= static_cast<std::uint32_t>(of[k] == ids[s]) << k;
        std::uint32_t* const to = frame.stages.pairs.data() + (first + s) * kPairWords;
        const std::uint32_t* const words = targets_.words.as<std::uint32_t>() + s * kSampleWords;
        to[0] = mask;
        if (ids[s] != kGpuNoTriangle)
            std::copy_n(words, kInterpolantWords + kMaterialWords, to + 1);
        std::copy_n(words + 4 * (kGpuColorGroup - 1), 3, to + kPairWords - 3);
    }
}

} // namespace burnish
