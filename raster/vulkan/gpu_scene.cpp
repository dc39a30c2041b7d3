#include "raster/vulkan/gpu_scene.h"

#include <algorithm>

#include "core/base/check.h"
#include "raster/vulkan/bands.h"

namespace burnish {

namespace {

static_assert(sizeof(GpuVertex) == kVertexWords * sizeof(std::uint32_t));

template <class T> Buffer filled(Context& context, const std::vector<T>& table, VkBufferUsageFlags more = 0)
{
    const std::size_t bytes = table.size() * sizeof(T);
    require_limit(context, "SessionParts::scene", "maxStorageBufferRange", bytes, context.features().max_buffer);
    return make_filled_buffer(context, table.data(), bytes, more);
}

// Makes a buffer with a device address. texels: halves, or pairs of floats.
template <class T> Buffer texel_page(Context& context, const Column<T>& texels)
{
    return make_filled_buffer(context, texels.data(), texels.size() * sizeof(T), VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
}

} // namespace

int viewport_half(const Features& features)
{
    int half = kGpuViewportHalf;
    while (2 * half > features.max_viewport)
        half /= 2;
    return half;
}

GpuScene::GpuScene(Context& context, const RenderInput& input)
    : input_(input), maker_(input), frame_(context, sizeof(GpuFrame), Buffer::Place::device)
{
    texels_.push_back(texel_page(context, input.environment.specular.texels));
    texels_.push_back(texel_page(context, input.environment.irradiance.texels));
    texels_.emplace_back(context, 0, Buffer::Place::device, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT); // filled later with the box chain
    texels_.push_back(texel_page(context, input.dfg.pairs));
    texels_.push_back(make_filled_buffer(context, lobe_albedo_pairs(), lobe_albedo_bytes(), VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT));
    texels_.emplace_back(context, 0, Buffer::Place::device, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT); // its slices
    if (input.environment.extracted_lights.empty())                                                     // then it equals the specular cube
        texels_.emplace_back(context, 0, Buffer::Place::device, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
    else
        texels_.push_back(texel_page(context, input.environment.whole.texels));
    const std::vector<std::uint16_t>& ltc = maker_.ltc_texels();
    texels_.push_back(
        make_filled_buffer(context, ltc.data(), ltc.size() * sizeof(std::uint16_t), VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT));
    for (const auto& p : maker_.scene().pyramids)
        texels_.push_back(texel_page(context, p->texels));
    for (std::size_t i = 0; i < kBehindTextures; ++i) // filled later
        texels_.emplace_back(context, 0, Buffer::Place::device, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
    upload_pages(context);
    upload_tables(context);
}

void GpuScene::upload_pages(Context& context)
{
    std::vector<std::uint64_t> addresses;
    for (const Buffer& b : texels_)
        addresses.push_back(b.address());
    if (input_.environment.extracted_lights.empty())
        addresses[kGpuWholePage] = addresses[kGpuSpecularPage];
    pages_ = filled(context, addresses);
}

void GpuScene::upload_tables(Context& context)
{
    const DrawTables& t = input_.tables;
    const SceneTables& scene = maker_.scene();
    // Concatenate all floats and all integers into one buffer each
    GpuPlaces& places = record_.places;
    std::vector<float> reals(3 * kGpuMaxGrid);
    const auto append = [](auto& table, const auto* from, std::size_t n) {
        const std::size_t at = table.size();
        table.insert(table.end(), from, from + n);
        return static_cast<int>(at);
    };
    const std::size_t vertices = t.px.size();
    require_limit(context, "SessionParts::scene", "maxDrawIndexedIndexValue", vertices, context.features().max_index);
    places.position_base[0] = append(reals, t.px.data(), vertices);
    places.position_base[1] = append(reals, t.py.data(), vertices);
    places.position_base[2] = append(reals, t.pz.data(), vertices);
    places.shading_base = append(reals, reinterpret_cast<const float*>(t.shading.data()), 16 * vertices);
    std::vector<std::int32_t> ints;
    places.index_base = append(ints, t.indices.data(), t.indices.size());
    places.material_base = append(ints, t.triangle_material.data(), t.triangle_count());
    std::vector<GpuTexture> textures;
    std::vector<TextureParams> params = scene.textures;
    params.push_back(texture_params(maker_.behind().light)), params.push_back(texture_params(maker_.behind().depth));
    for (std::size_t i = 0; i < params.size(); ++i) {
        const TextureParams& p = params[i];
        textures.push_back({kGpuFirstTexturePage + static_cast<int>(i), p.levels, p.wrap_s, p.wrap_t, p.nearest, append(ints, p.offset, 16),
                            append(reals, p.level_width, 16), append(reals, p.level_height, 16)});
    }
    places.vertex_count = static_cast<int>(vertices), places.triangle_count = static_cast<int>(t.triangle_count());
    reals_ = filled(context, reals);
    ints_ = filled(context, ints, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    textures_ = filled(context, textures);
    lights_ = filled(context, scene.lights);
    area_lights_ = filled(context, scene.area_lights);
    materials_ = Buffer(context, scene.materials.size() * sizeof(MaterialRecord), Buffer::Place::device);
}

// Uploads the picture of surfaces behind. Its first picture, and one with another size, brings its levels' places too.
void GpuScene::upload_behind(Context& context)
{
    const BehindPicture& behind = maker_.behind();
    const bool fits = behind.light.width == behind_width_ && behind.light.height == behind_height_;
    const std::size_t first = static_cast<std::size_t>(kGpuFirstTexturePage) + maker_.scene().textures.size();
    const TexturePyramid* const pyramids[kBehindTextures] = {&behind.light, &behind.depth};
    for (std::size_t i = 0; i < kBehindTextures; ++i)
        if (fits)
            fill_buffer(context, texels_[first + i], pyramids[i]->texels.data(), pyramids[i]->texels.size() * sizeof(std::uint16_t));
        else
            texels_[first + i] = texel_page(context, pyramids[i]->texels);
    if (fits)
        return;
    behind_width_ = behind.light.width, behind_height_ = behind.light.height;
    upload_pages(context);
    upload_tables(context);
}

void GpuScene::prepare(Context& context, const FrameDesc& desc, std::uint32_t setup_capacity)
{
    record_.frame = maker_.make(desc);
    if (record_.frame.behind >= 0)
        upload_behind(context);
    record_.places.setup_capacity = static_cast<int>(setup_capacity);
    record_.places.clip_unit = 1.0f / static_cast<float>(kSubpixel * viewport_half(context.features()));
    const auto grown = [&](int page, const auto& texels) {
        Buffer& held = texels_[static_cast<std::size_t>(page)];
        if (held.bytes() >= texels.size() * sizeof texels[0])
            return;
        held = texel_page(context, texels);
        upload_pages(context);
    };
    grown(kGpuBoxPage, maker_.mip_env().texels);
    grown(kGpuLobeSlicePage, maker_.lobe_slices());
    if (const std::vector<GridSample>& grid = maker_.grid(); !grid.empty()) {
        BN_CHECK_OP(grid.size(), <=, static_cast<std::size_t>(kGpuMaxGrid));
        fill_buffer(context, reals_, grid.data(), grid.size() * sizeof(GridSample));
    }
    fill_buffer(context, materials_, maker_.materials().data(), maker_.materials().size() * sizeof(MaterialRecord));
    fill_buffer(context, frame_, &record_, sizeof record_);
}

} // namespace burnish
