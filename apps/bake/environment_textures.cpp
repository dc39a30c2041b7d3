#include "apps/bake/environment_textures.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/cli/environment_text.h"
#include "apps/report/json.h"
#include "core/base/file.h"
#include "core/image/io/image_io.h"
#include "core/simd/half.h"
#include "shading/bake/environment/albedo_tiles.h"
#include "shading/bake/ltc/shipped.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFaces[] = {"px", "nx", "py", "ny", "pz", "nz"};

// Returns the cube without its borders, and with its scale.
TextureData texture_of(const CubeMap& cube)
{
    TextureData out;
    out.faces = 6;
    for (int l = 0; l < cube.levels; ++l) {
        const std::size_t side = static_cast<std::size_t>(cube.size >> l), row = side + 2;
        TextureLevel level;
        level.width = level.height = static_cast<int>(side);
        level.texels.reserve(6 * 4 * side * side);
        for (std::size_t face = 0; face < 6; ++face)
            for (std::size_t y = 1; y <= side; ++y)
                for (std::size_t x = 1; x <= side; ++x) {
                    const std::uint16_t* const texel =
                        &cube.texels[4 * (cube.offset[static_cast<std::size_t>(l)] + face * row * row + y * row + x)];
                    for (int c = 0; c < 3; ++c)
                        level.texels.push_back(half_to_float(texel[c]) * cube.scale);
                    level.texels.push_back(1.0f);
                }
        out.levels.push_back(std::move(level));
    }
    return out;
}

TextureData texture_of(const DfgTable& dfg)
{
    TextureData out;
    out.channels = 2;
    out.levels.push_back({dfg.size, dfg.size, std::vector<float>(dfg.pairs.begin(), dfg.pairs.end())});
    return out;
}

TextureData texture_of_albedo_tiles()
{
    TextureData out;
    out.channels = 2;
    out.levels.push_back({kAlbedoTilesSide, kAlbedoTilesSide, albedo_tiles()});
    return out;
}

TextureData texture_of_ltc()
{
    TextureData out;
    TextureLevel level = {ltc::kTextureWidth, ltc::kTextureHeight, {}};
    for (const std::uint16_t half : ltc::shipped_texture())
        level.texels.push_back(half_to_float(half));
    out.levels.push_back(std::move(level));
    return out;
}

// Returns a texture's pictures, by name: a cube's faces and levels, or the table with 0 as blue channel.
std::vector<std::pair<std::string, Image>> pictures_of(const std::string& name, const TextureData& texture)
{
    std::vector<std::pair<std::string, Image>> pictures;
    const auto channels = static_cast<std::size_t>(texture.channels);
    for (std::size_t l = 0; l < texture.levels.size(); ++l)
        for (std::size_t face = 0; face < static_cast<std::size_t>(texture.faces); ++face) {
            const TextureLevel& level = texture.levels[l];
            const std::size_t shown = texture.faces == 1 ? std::max<std::size_t>(channels, 3) : 3; // a cube's alpha is 1
            Image image = make_image(level.width, level.height, static_cast<int>(shown), PixelType::f32);
            const std::size_t pixels = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height);
            for (std::size_t i = 0; i < pixels; ++i)
                for (std::size_t c = 0; c < shown; ++c)
                    image.f32()[shown * i + c] = c < channels ? level.texels[(face * pixels + i) * channels + c] : 0.0f;
            pictures.emplace_back(texture.faces == 1 ? name : fmt::format("{}_{:02}_{}", name, l, kFaces[face]), std::move(image));
        }
    return pictures;
}

std::string vector_text(const float (&v)[3])
{
    return fmt::format("vec3({:#.9g}, {:#.9g}, {:#.9g})", v[0], v[1], v[2]);
}

constexpr std::size_t kBlockLights = 8; // in the uniform block, whatever the bake found

// Returns the lights as GLSL constants, and as a uniform block. An array has at least one element.
std::string lights_glsl(const std::vector<ExtractedLight>& lights)
{
    std::string text = "// Extracted lights of an environment: evenly bright ellipses on the sky, strongest first. Linear Rec.709.\n"
                       "struct burnish_key_light {\n"
                       "    vec3 direction;        // to the light, unit\n"
                       "    vec3 irradiance;       // on a surface that faces the light\n"
                       "    vec3 axis_u, axis_v;   // half axes, as tangents\n"
                       "    float angular_radius;  // of a disc with the same area, radians\n"
                       "};\n";
    text += fmt::format("#ifdef BURNISH_KEY_LIGHTS_BLOCK // fill it from key_lights.bin; BURNISH_KEY_LIGHTS_LAYOUT may add a binding\n"
                        "#ifndef BURNISH_KEY_LIGHTS_LAYOUT\n"
                        "#define BURNISH_KEY_LIGHTS_LAYOUT std140\n"
                        "#endif\n"
                        "layout(BURNISH_KEY_LIGHTS_LAYOUT) uniform burnish_key_lights_block {{\n"
                        "    int burnish_key_light_count;\n"
                        "    burnish_key_light burnish_key_lights[{}];\n"
                        "}};\n"
                        "#else\n",
                        kBlockLights);
    text += fmt::format("const int burnish_key_light_count = {};\n", lights.size());
    text +=
        fmt::format("const burnish_key_light burnish_key_lights[{0}] = burnish_key_light[{0}](\n", std::max<std::size_t>(lights.size(), 1));
    for (std::size_t i = 0; i < std::max<std::size_t>(lights.size(), 1); ++i) {
        const ExtractedLight light = i < lights.size() ? lights[i] : ExtractedLight{};
        text +=
            fmt::format("    burnish_key_light({}, {}, {}, {}, {:#.9g}){}\n", vector_text(light.direction), vector_text(light.irradiance),
                        vector_text(light.axis_u), vector_text(light.axis_v), light.angular_radius, i + 1 < lights.size() ? "," : ");");
    }
    return text + "#endif\n";
}

// Returns the uniform block's bytes in the layout std140: the count and 12 padding bytes, then 64 bytes a light.
std::vector<std::uint8_t> lights_block(const std::vector<ExtractedLight>& lights)
{
    struct Row { // a vec3 takes 16 bytes, and a float after it the last 4
        float direction[4], irradiance[4], axis_u[4], axis_v[3], angular_radius;
    };
    static_assert(sizeof(Row) == 64);
    const std::size_t count = std::min(lights.size(), kBlockLights);
    std::vector<std::uint8_t> bytes(16 + kBlockLights * sizeof(Row));
    const auto number = static_cast<std::int32_t>(count);
    std::memcpy(bytes.data(), &number, sizeof number);
    for (std::size_t i = 0; i < count; ++i) {
        Row row{};
        std::copy_n(lights[i].direction, 3, row.direction), std::copy_n(lights[i].irradiance, 3, row.irradiance);
        std::copy_n(lights[i].axis_u, 3, row.axis_u), std::copy_n(lights[i].axis_v, 3, row.axis_v);
        row.angular_radius = lights[i].angular_radius;
        std::memcpy(&bytes[16 + i * sizeof(Row)], &row, sizeof row);
    }
    return bytes;
}

class Writer {
  public:
    Writer(std::string folder, TextureFormat format, TexelType type) : folder_(std::move(folder)), format_(format), type_(type) {}

    Status write(const std::string& name, const TextureData& texture)
    {
        if (format_ == TextureFormat::exr) {
            for (const auto& [picture, image] : pictures_of(name, texture))
                BN_TRY(note(picture + ".exr", write_image(path(picture + ".exr"), image)));
            remove_levels(name, texture.levels.size());
            return {};
        }
        if (const std::uint64_t beyond = type_ == TexelType::half ? count_beyond_half(texture) : 0)
            written.warnings.push_back(
                fmt::format("{}: {} values are beyond half floats and become 65504 (--texels float keeps them)", name, beyond));
        const bool ktx2 = format_ == TextureFormat::ktx2;
        const std::vector<std::uint8_t> bytes = ktx2 ? ktx2_bytes(texture, type_) : dds_bytes(texture, type_);
        return write(name + (ktx2 ? ".ktx2" : ".dds"), bytes.data(), bytes.size());
    }
    Status write(const std::string& name, const std::string& text) { return write(name, text.data(), text.size()); }
    Status write(const std::string& name, const std::vector<std::uint8_t>& bytes) { return write(name, bytes.data(), bytes.size()); }

    // Removes an earlier bake's texture.
    void remove(const std::string& name) const
    {
        std::error_code ignored;
        const fs::path folder(folder_);
        for (const char* end : {".ktx2", ".dds"})
            fs::remove(folder / (name + end), ignored);
        remove_levels(name, 0);
    }

    EnvironmentTextures written;

  private:
    // Removes faces of levels that an earlier bake left. first: the lowest of them.
    void remove_levels(const std::string& name, std::size_t first) const
    {
        constexpr std::size_t kMostLevels = 32;
        std::error_code ignored;
        for (std::size_t level = first; level < kMostLevels; ++level)
            for (const char* face : kFaces)
                fs::remove(fs::path(folder_) / fmt::format("{}_{:02}_{}.exr", name, level, face), ignored);
    }
    std::string path(const std::string& name) const { return (fs::path(folder_) / name).string(); }
    Status note(const std::string& name, Status status)
    {
        if (status)
            written.files.push_back(path(name));
        return status;
    }
    Status write(const std::string& name, const void* bytes, std::size_t count)
    {
        return note(name, write_file_atomic(path(name), bytes, count));
    }

    std::string folder_;
    TextureFormat format_;
    TexelType type_;
};

} // namespace

Result<EnvironmentTextures> write_environment_textures(const std::string& folder, const Environment& environment, const DfgTable& dfg,
                                                       TextureFormat format, TexelType type, const Jobs& jobs)
{
    Writer writer(folder, format, type);
    BN_TRY(writer.write("specular", texture_of(environment.specular)));
    BN_TRY(writer.write("box", texture_of(box_filtered_chain(environment.picture(), jobs))));
    BN_TRY(writer.write("irradiance", texture_of(environment.irradiance)));
    if (!environment.extracted_lights.empty())
        BN_TRY(writer.write("whole", texture_of(environment.whole)));
    else
        writer.remove("whole");
    BN_TRY(writer.write("dfg", texture_of(dfg)));
    BN_TRY(writer.write("lobe_albedo", texture_of_albedo_tiles()));
    BN_TRY(writer.write("ltc", texture_of_ltc()));
    const std::vector<ExtractedLight> lights = turned_extracted_lights(environment);
    BN_TRY(writer.write("key_lights.json", json_text(extracted_lights_json(lights), 2) + "\n"));
    BN_TRY(writer.write("key_lights.glsl", lights_glsl(lights)));
    BN_TRY(writer.write("key_lights.bin", lights_block(lights)));
    return std::move(writer.written);
}

} // namespace burnish
