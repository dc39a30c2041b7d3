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
         "where no environment is given: rotation, intensity and the first level's images, of which all else is made"},
        {"EXT_mesh_gpu_instancing", supported, "translation, rotation, scale"},
        {"EXT_meshopt_compression", supported, "all modes and filters"},
        {"EXT_texture_webp", supported, ""},
        {"KHR_animation_pointer", ignored, "nothing moves"},
        {"KHR_draco_mesh_compression", in_part, "triangle meshes of bitstream 2.2, no metadata"},
        {"KHR_lights_punctual", supported, "directional, point and spot lights; no shadows but in the reference"},
        {"KHR_materials_anisotropy", supported, "strength, rotation, texture"},
        {"KHR_materials_clearcoat", supported, "factors, textures, normal texture"},
        {"KHR_materials_dispersion", ignored, ""},
        {"KHR_materials_emissive_strength", supported, ""},
        {"KHR_materials_ior", supported, ""},
        {"KHR_materials_iridescence", ignored, ""},
        {"KHR_materials_sheen", ignored, ""},
        {"KHR_materials_specular", supported, "factor, colour, textures"},
        {"KHR_materials_transmission", supported, "factor, texture; refracted by mc and the reference, else drawn opaque"},
        {"KHR_materials_unlit", supported, ""},
        {"KHR_materials_variants", ignored, "drawn with the materials of the mesh"},
        {"KHR_materials_volume", ignored, "what lets light through is solid and absorbs nothing"},
        {"KHR_mesh_quantization", supported, ""},
        {"KHR_texture_basisu", ignored, "the texture's plain image is drawn, where it has one"},
        {"KHR_texture_transform", supported, ""},
        {"KHR_xmp_json_ld", ignored, "nothing to see"},
        {"animations", in_part, "one moment, at Moment::seconds; of nodes and morph targets"},
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
