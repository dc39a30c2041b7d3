#include "raster/vulkan/native_images.h"

#include <algorithm>

namespace burnish {

namespace {

constexpr std::size_t kHalfTexelBytes = 8; // RGBA halves

// Appends a level to `to`, without the border of one texel.
void strip_border(const std::uint16_t* from, int width, int height, std::vector<std::uint16_t>& to)
{
    for (int y = 0; y < height; ++y) {
        const std::uint16_t* row = from + 4 * static_cast<std::size_t>((y + 1) * (width + 2) + 1);
        to.insert(to.end(), row, row + 4 * width);
    }
}

} // namespace

NativeImages::NativeImages(Context& context, VkDescriptorSetLayout layout, const RenderInput& input, const GpuScene& scene)
    : NativeImages(context)
{
    has_box_ = scene.mip_env().levels > 0;
    const CubeMap& specular = input.environment.specular;
    for (const CubeMap* cube :
         {&specular, &input.environment.irradiance, has_box_ ? &scene.mip_env() : &specular, &input.environment.picture()})
        cubes_.push_back(upload(cube->texels.data(), cube->offset, cube->size, cube->size, 6));
    for (const auto& p : scene.tables().pyramids)
        textures_.push_back(upload(p->texels.data(), {p->offset, p->offset + p->levels}, p->width, p->height, 1));
    make_sets(layout, scene);
}

NativeImages::~NativeImages()
{
    vkDestroyDescriptorPool(context_.device(), pool_, nullptr);
    for (const auto& [key, sampler] : samplers_)
        vkDestroySampler(context_.device(), sampler, nullptr);
}

// Uploads an image with its levels. offsets: of the bordered levels, in texels; a cube level's faces are consecutive.
DeviceImage NativeImages::upload(const std::uint16_t* texels, const std::vector<std::uint32_t>& offsets, int width, int height, int layers)
{
    std::vector<std::uint16_t> packed;
    std::vector<VkBufferImageCopy> copies;
    for (std::uint32_t l = 0; l < offsets.size(); ++l) {
        const int w = std::max(width >> l, 1), h = std::max(height >> l, 1);
        VkBufferImageCopy copy = {};
        copy.bufferOffset = packed.size() * sizeof(std::uint16_t);
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, l, 0, static_cast<std::uint32_t>(layers)};
        copy.imageExtent = {static_cast<std::uint32_t>(w), static_cast<std::uint32_t>(h), 1};
        copies.push_back(copy);
        const std::size_t face = static_cast<std::size_t>(w + 2) * static_cast<std::size_t>(h + 2);
        for (std::size_t f = 0; f < static_cast<std::size_t>(layers); ++f)
            strip_border(texels + 4 * (offsets[l] + f * face), w, h, packed);
    }
    ImageShape shape;
    shape.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    shape.width = width, shape.height = height, shape.levels = static_cast<int>(offsets.size()), shape.layers = layers;
    shape.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    DeviceImage image(context_, shape);
    const Buffer staging(context_, packed.size() * sizeof(std::uint16_t), Buffer::Place::host);
    std::memcpy(staging.data(), packed.data(), packed.size() * sizeof(std::uint16_t));
    static_assert(kHalfTexelBytes == 4 * sizeof(std::uint16_t));
    VkCommandBuffer c = context_.begin();
    change_layout(c, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(c, staging.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           static_cast<std::uint32_t>(copies.size()), copies.data());
    change_layout(c, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    context_.submit(c);
    return image;
}

VkSampler NativeImages::sampler(int wrap_s, int wrap_t, bool nearest)
{
    const int key = wrap_s | wrap_t << 2 | nearest << 4;
    const auto known = samplers_.find(key);
    if (known != samplers_.end())
        return known->second;
    constexpr VkSamplerAddressMode kWrap[] = {VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                              VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT};
    auto info = vk_struct<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    info.magFilter = info.minFilter = nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    info.mipmapMode = nearest ? VK_SAMPLER_MIPMAP_MODE_NEAREST : VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.maxLod = nearest ? 0.0f : VK_LOD_CLAMP_NONE; // nearest: level 0 only, as the exact sampler
    info.addressModeU = kWrap[wrap_s], info.addressModeV = kWrap[wrap_t], info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    VkSampler made = VK_NULL_HANDLE;
    BN_VK(vkCreateSampler(context_.device(), &info, nullptr, &made));
    return samplers_[key] = made;
}

void NativeImages::make_sets(VkDescriptorSetLayout layout, const GpuScene& scene)
{
    // At least one set: the backdrop has no material.
    const auto count = static_cast<std::uint32_t>(std::max<std::size_t>(scene.materials_of_frame().size(), 1));
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count * (kGpuCubes + kTextureSlots)};
    auto pool = vk_struct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = count, pool.poolSizeCount = 1, pool.pPoolSizes = &size;
    BN_VK(vkCreateDescriptorPool(context_.device(), &pool, nullptr, &pool_));
    const std::vector<VkDescriptorSetLayout> layouts(count, layout);
    sets_.resize(count);
    auto allocate = vk_struct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool_, allocate.descriptorSetCount = count, allocate.pSetLayouts = layouts.data();
    BN_VK(vkAllocateDescriptorSets(context_.device(), &allocate, sets_.data()));
    const auto image_info = [](VkSampler s, const DeviceImage& image) {
        return VkDescriptorImageInfo{s, image.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    };
    // A slot without a texture is never fetched, but must be bound.
    DeviceImage* const some = textures_.empty() ? nullptr : &textures_.front();
    if (!some) {
        const std::vector<std::uint16_t> black(4 * 9);
        textures_.push_back(upload(black.data(), {0}, 1, 1, 1));
    }
    for (std::uint32_t m = 0; m < count; ++m) {
        VkDescriptorImageInfo cubes[kGpuCubes], textures[kTextureSlots];
        for (int i = 0; i < kGpuCubes; ++i)
            cubes[i] = image_info(sampler(1, 1, false), cubes_[static_cast<std::size_t>(i)]);
        for (int i = 0; i < kTextureSlots; ++i) {
            const int id = scene.materials_of_frame().empty() ? -1 : scene.materials_of_frame()[m].textures[i].texture;
            if (id < 0) {
                textures[i] = image_info(sampler(1, 1, false), textures_.front());
                continue;
            }
            const TextureParams& t = scene.tables().textures[static_cast<std::size_t>(id)];
            textures[i] = image_info(sampler(t.wrap_s, t.wrap_t, t.nearest != 0), textures_[static_cast<std::size_t>(id)]);
        }
        VkWriteDescriptorSet writes[2];
        for (std::uint32_t k = 0; k < 2; ++k) {
            writes[k] = vk_struct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
            writes[k].dstSet = sets_[m], writes[k].dstBinding = k;
            writes[k].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
            writes[k].descriptorCount = k == 0 ? kGpuCubes : kTextureSlots;
            writes[k].pImageInfo = k == 0 ? cubes : textures;
        }
        vkUpdateDescriptorSets(context_.device(), 2, writes, 0, nullptr);
    }
}

} // namespace burnish
