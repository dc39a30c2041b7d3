#include "core/scene/gltf/extensions.h"

namespace burnish {
namespace {

constexpr const char *kBegin = "extension ", *kEnd = " is not supported and ignored";

} // namespace

const char* support_name(GltfSupport support)
{
    return support == GltfSupport::supported ? "supported" : support == GltfSupport::in_part ? "in part" : "ignored";
}

const std::vector<GltfFeature>& gltf_features()
{
    using enum GltfSupport;
    static const std::vector<GltfFeature> table = {
        {"EXT_lights_image_based", in_part,
         "where no environment is given: rotation, intensity and the first level's images, which make all other levels"},
        {"EXT_mesh_gpu_instancing", supported, "translation, rotation, scale"},
        {"EXT_meshopt_compression", supported, "all modes and filters"},
        {"EXT_texture_webp", supported, ""},
        {"KHR_animation_pointer", ignored, "animated properties stay at rest"},
        {"KHR_draco_mesh_compression", in_part, "triangle meshes in bitstream 2.2, without metadata"},
        {"KHR_lights_punctual", supported, "directional, point and spot lights; shadows in the reference alone"},
        {"KHR_materials_anisotropy", supported, "strength, rotation, texture"},
        {"KHR_materials_clearcoat", supported, "factors, textures, normal texture"},
        {"KHR_materials_diffuse_transmission", ignored, ""},
        {"KHR_materials_dispersion", supported, "light of the environment through glass; lamps by the middle index"},
        {"KHR_materials_emissive_strength", supported, ""},
        {"KHR_materials_ior", supported, ""},
        {"KHR_materials_iridescence", supported, "factors, textures; interference by Fresnel's equations"},
        {"KHR_materials_sheen", supported, "factors, textures"},
        {"KHR_materials_specular", supported, "factor, colour, textures"},
        {"KHR_materials_transmission", supported, "factor, texture"},
        {"KHR_materials_unlit", supported, ""},
        {"KHR_materials_variants", supported, "Moment::variant; by default the meshes' own materials"},
        {"KHR_materials_volume", in_part, "thickness and attenuation of closed meshes; open meshes are thin; no thickness texture"},
        {"KHR_mesh_quantization", supported, ""},
        {"KHR_texture_basisu", ignored, "the texture's fallback image is drawn, if it has one"},
        {"KHR_texture_transform", supported, ""},
        {"KHR_xmp_json_ld", ignored, "metadata without effect on pictures"},
        {"animations", in_part, "nodes and morph targets, at one moment: Moment::seconds"},
        {"morph targets", supported, "positions, normals, tangents"},
        {"points and lines", ignored, "left out"},
        {"skins", supported, ""},
        {"texture coordinates", in_part, "sets 0 and 1"},
    };
    return table;
}

bool is_read(const std::string& extension)
{
    for (const GltfFeature& feature : gltf_features())
        if (extension == feature.name)
            return feature.support != GltfSupport::ignored && extension.find('_') != std::string::npos;
    return false;
}

std::string ignored_warning(const std::string& extension)
{
    return kBegin + extension + kEnd;
}

std::vector<std::string> ignored_extensions(const std::vector<std::string>& warnings)
{
    const std::string begin = kBegin, end = kEnd;
    std::vector<std::string> names;
    for (const std::string& w : warnings)
        if (w.size() > begin.size() + end.size() && w.rfind(begin, 0) == 0 && w.compare(w.size() - end.size(), end.size(), end) == 0)
            names.push_back(w.substr(begin.size(), w.size() - begin.size() - end.size()));
    return names;
}

} // namespace burnish
