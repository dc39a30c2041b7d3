#include "raster/vulkan/lab/lean_lights.h"

#include <cstring>

#include "shading/bake/ltc/shipped.h"

namespace burnish {

namespace {

constexpr int kTableNodes = 8, kTableAlphas = 11, kTablePlanes = 3; // of the table that lights.glsl reads
constexpr int kPointsOfAreas = 16;
static_assert(kPointsOfAreas == kMostAreaCorners);

glm::vec4 four(const float* v, float w)
{
    return {v[0], v[1], v[2], w};
}

float number(bool flag)
{
    return flag ? 1.0f : 0.0f;
}

void append_lamp(const LightRecord& l, std::vector<glm::vec4>& to)
{
    to.insert(to.end(), {four(l.position, l.inv_range2), four(l.direction, l.spot_scale), four(l.radiant, l.spot_offset),
                         glm::vec4(number(l.directional != 0), 0.0f, 0.0f, 0.0f)});
}

void append_area(const AreaLightRecord& l, std::vector<glm::vec4>& to)
{
    const bool one_sided = l.shape <= kArea_disk && l.two_sided == 0;
    to.insert(to.end(), {glm::vec4(static_cast<float>(l.shape), static_cast<float>(l.corners), l.radius, number(one_sided)),
                         four(l.radiance, 0.0f), four(l.normal, 0.0f)});
    for (int k = 0; k < kPointsOfAreas; ++k)
        to.push_back(k < l.corners ? four(l.points + 3 * k, 0.0f) : glm::vec4(0.0f));
}

} // namespace

const char* lights_that_lean_lacks(const GpuScene& scene)
{
    const FrameRecord& f = scene.record();
    if (f.area_light_count == 0)
        return nullptr;
    if (f.area_way != kAreaWay_ltc)
        return "another FrameDesc::area_way than ltc";
    const LtcTableRecord& t = f.ltc;
    if (t.root_alpha == 0 || t.basis != 1 || t.over_alpha == 0 || t.inverse != 0 || t.alphas != kTableAlphas)
        return "tables of transformed cosines in another form than the built-in one's";
    for (int i = 0; i < f.area_light_count; ++i)
        if (scene.tables().area_lights[static_cast<std::size_t>(i)].picture >= 0)
            return "area lights with pictures";
    return nullptr;
}

std::vector<glm::vec4> lean_lights(const GpuScene& scene)
{
    const FrameRecord& f = scene.record();
    std::vector<glm::vec4> data = {glm::vec4(static_cast<float>(f.light_count), static_cast<float>(f.area_light_count), 0.0f, 0.0f)};
    for (int i = 0; i < f.light_count; ++i)
        append_lamp(scene.tables().lights[static_cast<std::size_t>(i)], data);
    for (int i = 0; i < f.area_light_count; ++i)
        append_area(scene.tables().area_lights[static_cast<std::size_t>(i)], data);
    return data;
}

DeviceImage upload_cosines(Context& context, const RenderInput& input)
{
    const bool own = input.ltc && input.ltc->record.alphas == kTableAlphas; // frames with area lights and another table are refused
    const std::vector<std::uint16_t>& all = own ? input.ltc->texels : ltc::shipped_tables().texels;
    ImageShape shape;
    shape.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    shape.width = kTableNodes, shape.height = kTableAlphas, shape.depth = kTablePlanes * kTableNodes * kTableNodes;
    const auto first = all.begin();
    return upload_halves(context, {first, first + 4 * shape.width * shape.height * shape.depth}, shape);
}

DeviceImage upload_halves(Context& context, const std::vector<std::uint16_t>& halves, ImageShape shape)
{
    shape.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    DeviceImage image(context, shape);
    const Buffer staging(context, halves.size() * sizeof(std::uint16_t), Buffer::Place::host);
    std::memcpy(staging.data(), halves.data(), halves.size() * sizeof(std::uint16_t));
    VkBufferImageCopy copy = {};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {static_cast<std::uint32_t>(shape.width), static_cast<std::uint32_t>(shape.height),
                        static_cast<std::uint32_t>(shape.depth)};
    VkCommandBuffer c = context.begin();
    change_layout(c, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(c, staging.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    change_layout(c, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    context.submit(c);
    return image;
}

} // namespace burnish
