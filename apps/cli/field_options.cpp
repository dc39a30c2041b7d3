#include "apps/cli/field_options.h"

#include <algorithm>
#include <cctype>

#include "raster/frame/frame.h"

namespace burnish {
namespace {

bool in_name(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':';
}

} // namespace

const std::vector<std::pair<std::string, std::string>>& field_options()
{
    static const std::vector<std::pair<std::string, std::string>> all = [] {
        std::vector<std::pair<std::string, std::string>> fields = {
            {"EnvironmentOptions::cube_size", "--env-size"},
            {"EnvironmentOptions::exposure_ev", "--env-exposure"},
            {"EnvironmentOptions::extracted_lights", "--key-lights"},
            {"EnvironmentOptions::rotation_deg", "--env-rotation"},
            {"EnvironmentOptions::samples", "--env-samples"},
            {"FloorSettings::kind", "--floor"},
            {"FrameDesc::anisotropy", "--anisotropy"},
            {"FrameDesc::height", "--size"},
            {"FrameDesc::msaa", "--msaa"},
            {"FrameDesc::roughness", "--roughness"},
            {"FrameDesc::samples", "--samples"},
            {"FrameDesc::technique", "--technique"},
            {"FrameDesc::texture_anisotropy", "--texture-anisotropy"},
            {"FrameDesc::tile_size", "--tile-size"},
            {"FrameDesc::width", "--size"},
            {"FrameDesc::window", "--size"},
            {"Limits::accessor_bytes", "--limit-accessor-bytes"},
            {"Limits::area_lights", "--limit-lights"},
            {"Limits::data_uri_bytes", "--limit-data-uri-bytes"},
            {"Limits::draw_bytes", "--limit-draw-bytes"},
            {"Limits::env_pixels", "--limit-env-pixels"},
            {"Limits::file_bytes", "--limit-file-bytes"},
            {"Limits::image_side", "--limit-image-side"},
            {"Limits::input_bytes", "--limit-input-bytes"},
            {"Limits::json_depth", "--limit-json-depth"},
            {"Limits::node_depth", "--limit-node-depth"},
            {"Limits::strict", "--strict"},
            {"Limits::texture_bytes", "--limit-texture-bytes"},
            {"Limits::uris_outside", "--allow-outside-uris"},
            {"MaterialOverrides::material", "--material"},
            {"MaterialOverrides::normal_y_down", "--normal-y"},
            {"MaterialOverrides::rotation", "--rotation-map"},
            {"MaterialOverrides::rotation_encoding", "--rotation-encoding"},
            {"MaterialOverrides::roughness_encoding", "--roughness-encoding"},
            {"MaterialOverrides::strokes", "--strokes"},
            {"MipSettings::brdf", "--brdf"},
            {"MipSettings::filter", "--mip-filter"},
            {"MipSettings::kappa", "--mip-kappa"},
            {"MipSettings::net", "--mip-net"},
            {"Moment::animation", "--animation"},
            {"Moment::seconds", "--time"},
            {"Moment::variant", "--variant"},
            {"OpenOptions::threads", "--threads"},
            {"SessionOptions::backend", "--backend"},
            {"SessionParts::scene", "SCENE"},
            {"ShadowSettings::of", "--shadows"},
            {"ShadowSettings::samples", "--shadow-samples"},
            {"VulkanOptions::device", "--device"},
            {"VulkanOptions::pipeline", "--pipeline"},
            {"VulkanOptions::sampler", "--sampler"},
            {"VulkanOptions::validate", "--validate"},
        };
        for (const ParameterInfo& p : parameters())
            fields.emplace_back(std::string("FrameDesc::") + p.name, std::string("--") + p.option);
        return fields;
    }();
    return all;
}

std::string with_options(std::string_view text)
{
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && in_name(text[end]))
            ++end;
        std::string_view word = text.substr(at, std::max<std::size_t>(end - at, 1)); // "FrameDesc::brdf:" has a colon that is none of it
        while (word.size() > 1 && word.back() == ':')
            word.remove_suffix(1);
        const auto found =
            std::find_if(field_options().begin(), field_options().end(), [&](const auto& field) { return field.first == word; });
        out += found == field_options().end() ? word : std::string_view(found->second);
        at += word.size();
    }
    return out;
}

std::string line_of(const Error& error)
{
    return with_options(error.line());
}

} // namespace burnish
