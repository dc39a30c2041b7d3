#include "raster/vulkan/forward.h"

#include <fmt/format.h>

namespace burnish {

namespace {
constexpr VkFormat kColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkShaderStageFlags kPushStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

std::int32_t used_textures(const GpuMaterial& m)
{
    std::int32_t bits = 0;
    for (int i = 0; i < kGpuTextureSlots; ++i)
        bits |= m.textures[i].texture >= 0 ? 1 << i : 0;
    return bits;
}
} // namespace

void ForwardPass::prepare(const FrameDesc& desc)
{
    const bool box = scene_.box_cube().levels > 0;
    if (sampler_ == VulkanSampler::native && (!native_ || native_->max_anisotropy() != desc.texture_anisotropy || native_->has_box() != box)) {
        native_.reset();
        native_.emplace(context_, pipelines_.native_layout(), input_, scene_, desc.texture_anisotropy);
    }
    if (width_ == desc.width && height_ == desc.height && msaa_ == desc.msaa)
        return;
    if (!(context_.features().target_samples & static_cast<VkSampleCountFlags>(desc.msaa)))
        throw VulkanError{Error{ExitCode::unavailable, "", "--pipeline", fmt::format("forward: {} cannot take {} samples a pixel", context_.info().name, desc.msaa)}};
    width_ = desc.width, height_ = desc.height, msaa_ = desc.msaa;
    ImageShape shape;
    shape.width = width_, shape.height = height_;
    shape.format = kColorFormat, shape.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    resolved_ = DeviceImage(context_, shape);
    shape.samples = static_cast<VkSampleCountFlagBits>(msaa_);
    shape.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    color_ = msaa_ > 1 ? DeviceImage(context_, shape) : DeviceImage();
    shape.format = VK_FORMAT_D32_SFLOAT, shape.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    depth_ = DeviceImage(context_, shape);
    pixels_ = Buffer(context_, static_cast<VkDeviceSize>(width_) * static_cast<VkDeviceSize>(height_) * 4 * sizeof(float), Buffer::Place::host);
}

GraphicsState ForwardPass::state(const char* vertex, const char* fragment, VkCompareOp compare) const
{
    const std::string suffix = sampler_ == VulkanSampler::native ? "_native" : "";
    return {vertex, fragment + suffix, kColorFormat, static_cast<VkSampleCountFlagBits>(msaa_), compare};
}

void ForwardPass::bind_native(VkCommandBuffer c, std::size_t material)
{
    if (!native_)
        return;
    const VkDescriptorSet set = native_->set(material);
    vkCmdBindDescriptorSets(c, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_.layout(), 1, 1, &set, 0, nullptr);
}

void ForwardPass::draw_scene(VkCommandBuffer c, const FrameDesc& desc, const Specialization& technique)
{
    vkCmdBindIndexBuffer(c, scene_.ints().handle(), static_cast<VkDeviceSize>(scene_.record().index_base) * sizeof(std::uint32_t), VK_INDEX_TYPE_UINT32);
    for (const Draw& draw : input_.tables.draws) {
        const auto material = static_cast<std::size_t>(draw.material);
        const GpuMaterial& m = scene_.material_records()[material];
        Specialization constants = technique; // constant_id 0 to 3
        constants.push_back(desc.stages);     // 4: of the compute stage only
        constants.push_back(used_textures(m));
        vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_GRAPHICS,
                          pipelines_.graphics(state("forward_vert", "forward", VK_COMPARE_OP_GREATER), constants));
        bind_native(c, material);
        vkCmdSetCullMode(c, m.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        const PassConstants pass = {0, 0, -1, draw.material};
        vkCmdPushConstants(c, pipelines_.layout(), kPushStages, 0, sizeof pass, &pass);
        vkCmdDrawIndexed(c, 3 * draw.triangle_count, 1, 3 * draw.first_triangle, 0, 0);
    }
}

// Last, where nothing was drawn: at depth 0, the farthest.
void ForwardPass::draw_backdrop(VkCommandBuffer c)
{
    vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_.graphics(state("backdrop_vert", "backdrop", VK_COMPARE_OP_GREATER_OR_EQUAL)));
    if (!input_.scene.materials.empty())
        bind_native(c, 0);
    vkCmdSetCullMode(c, VK_CULL_MODE_NONE);
    vkCmdDraw(c, 3, 1, 0, 0);
}

void ForwardPass::draw(VkCommandBuffer c, const FrameDesc& desc, const Specialization& technique)
{
    const bool resolves = msaa_ > 1;
    change_layout(c, resolved_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    if (resolves)
        change_layout(c, color_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    change_layout(c, depth_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    auto color = vk_struct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    color.imageView = resolves ? color_.view() : resolved_.view(), color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR, color.storeOp = resolves ? VK_ATTACHMENT_STORE_OP_DONT_CARE : VK_ATTACHMENT_STORE_OP_STORE;
    if (resolves) {
        color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
        color.resolveImageView = resolved_.view(), color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    }
    auto depth = vk_struct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    depth.imageView = depth_.view(), depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR, depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE; // cleared to 0: reversed depth
    const VkRect2D area = {{0, 0}, {static_cast<std::uint32_t>(width_), static_cast<std::uint32_t>(height_)}};
    auto rendering = vk_struct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea = area, rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1, rendering.pColorAttachments = &color, rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(c, &rendering);
    pipelines_.bind_set(c, VK_PIPELINE_BIND_POINT_GRAPHICS);
    const VkViewport viewport = {0, 0, static_cast<float>(width_), static_cast<float>(height_), 0.0f, 1.0f};
    vkCmdSetViewport(c, 0, 1, &viewport);
    vkCmdSetScissor(c, 0, 1, &area);
    draw_scene(c, desc, technique);
    draw_backdrop(c);
    vkCmdEndRendering(c);
}

void ForwardPass::read(VkCommandBuffer c)
{
    change_layout(c, resolved_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy copy = {};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {static_cast<std::uint32_t>(width_), static_cast<std::uint32_t>(height_), 1};
    vkCmdCopyImageToBuffer(c, resolved_.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels_.handle(), 1, &copy);
    full_barrier(c);
}

} // namespace burnish
