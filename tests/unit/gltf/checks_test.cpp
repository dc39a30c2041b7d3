// Violations of glTF 2.0 are always reported. Each rule has one edit of a valid file, with the reported place and whether the file loads.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "asset.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;
using Json = nlohmann::json;

namespace {

// A 1x1 PNG.
const char* const kPng = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";

// Returns a valid document with one object for each rule. Accessors: 0 POSITION, 1 NORMAL, 2 TANGENT, 3 TEXCOORD_0, 4 JOINTS_0, 5
// WEIGHTS_0, 6 indices, 7 times, 8 translations, 9 inverse bind matrices, 10 sparse. Each uses the buffer view of its number.
Json sound()
{
    Json doc = Json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
        "nodes":[{"mesh":0,"skin":0,"children":[3]},{"camera":0,"rotation":[0,0,0,1]},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},{}],
        "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TANGENT":2,"TEXCOORD_0":3,"JOINTS_0":4,"WEIGHTS_0":5},
            "indices":6,"material":0}]}],
        "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],
        "skins":[{"joints":[3],"inverseBindMatrices":9}],
        "animations":[{"samplers":[{"input":7,"output":8}],"channels":[{"sampler":0,"target":{"node":3,"path":"translation"}}]}],
        "accessors":[],"bufferViews":[]})");
    doc["images"] = {{{"uri", std::string("data:image/png;base64,") + kPng}, {"mimeType", "image/png"}}};
    ByteVector bin;
    const auto add = [&](const ByteVector& data, int component, const char* type, int count, Json more) {
        bin.resize((bin.size() + 3) / 4 * 4);
        doc["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", data.size()}});
        Json accessor = {{"bufferView", doc["bufferViews"].size() - 1}, {"componentType", component}, {"type", type}, {"count", count}};
        accessor.update(more);
        doc["accessors"].push_back(accessor);
        bin.insert(bin.end(), data.begin(), data.end());
    };
    add(floats({0, 0, 0, 1, 0, 0, 0, 1, 0}), kF32, "VEC3", 3, {{"min", {0, 0, 0}}, {"max", {1, 1, 0}}});
    add(floats({0, 0, 1, 0, 0, 1, 0, 0, 1}), kF32, "VEC3", 3, Json::object());
    add(floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}), kF32, "VEC4", 3, Json::object());
    add(floats({0, 0, 1, 0, 0, 1}), kF32, "VEC2", 3, Json::object());
    add(ByteVector(12), kU8, "VEC4", 3, Json::object());
    add(floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), kF32, "VEC4", 3, Json::object());
    add({0, 0, 1, 0, 2, 0}, kU16, "SCALAR", 3, Json::object());
    add(floats({0, 1, 2}), kF32, "SCALAR", 3, {{"min", {0}}, {"max", {2}}});
    add(floats({0, 0, 0, 1, 0, 0, 0, 1, 0}), kF32, "VEC3", 3, Json::object());
    add(floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), kF32, "MAT4", 1, Json::object());
    add({0, 0, 0, 0}, kU16, "SCALAR", 2, Json::object());
    doc["buffers"] = {{{"byteLength", bin.size()}, {"uri", "data:application/octet-stream;base64," + base64(bin)}}};
    return doc;
}

struct Breach {
    const char* name;
    const char* patch; // RFC 6902
    const char* place; // place of the error or the warning
};

const Breach kBreaches[] = {
    // asset, extensions
    {"version_pattern", R"([{"op":"replace","path":"/asset/version","value":"2.0.1"}])", "/asset/version"},
    {"version_unknown", R"([{"op":"replace","path":"/asset/version","value":"3.0"}])", "/asset/version"},
    {"generator_is_no_text", R"([{"op":"add","path":"/asset/generator","value":1}])", "/asset/generator"},
    {"required_not_used", R"([{"op":"add","path":"/extensionsRequired","value":["KHR_materials_ior"]}])", "/extensionsRequired/0"},
    {"undeclared", R"([{"op":"add","path":"/materials/0/extensions","value":{"KHR_materials_ior":{"ior":1.4}}}])",
     "/materials/0/extensions/KHR_materials_ior"},
    {"used_twice", R"([{"op":"add","path":"/extensionsUsed","value":["KHR_materials_ior","KHR_materials_ior"]}])", "/extensionsUsed/1"},
    // empty
    {"empty_extensions", R"([{"op":"add","path":"/extensionsUsed","value":[]}])", "/extensionsUsed"},
    {"empty_samplers", R"([{"op":"add","path":"/samplers","value":[]}])", "/samplers"},
    {"empty_children", R"([{"op":"add","path":"/nodes/3/children","value":[]}])", "/nodes/3/children"},
    {"empty_scene", R"([{"op":"replace","path":"/scenes/0/nodes","value":[]}])", "/scenes/0/nodes"},
    {"empty_primitives", R"([{"op":"replace","path":"/meshes/0/primitives","value":[]}])", "/meshes/0/primitives"},
    {"empty_attributes", R"([{"op":"replace","path":"/meshes/0/primitives/0/attributes","value":{}}])",
     "/meshes/0/primitives/0/attributes"},
    {"empty_channels", R"([{"op":"replace","path":"/animations/0/channels","value":[]}])", "/animations/0/channels"},
    {"empty_joints", R"([{"op":"replace","path":"/skins/0/joints","value":[]}])", "/skins/0/joints"},
    {"empty_weights", R"([{"op":"add","path":"/meshes/0/weights","value":[]}])", "/meshes/0/weights"},
    // nodes, scenes, cameras
    {"rotation_not_unit", R"([{"op":"replace","path":"/nodes/1/rotation","value":[0,0,0,2]}])", "/nodes/1/rotation"},
    {"rotation_nothing", R"([{"op":"replace","path":"/nodes/1/rotation","value":[0,0,0,0]}])", "/nodes/1/rotation"},
    {"matrix_and_trs", R"([{"op":"add","path":"/nodes/2/scale","value":[1,1,1]}])", "/nodes/2/matrix"},
    {"matrix_sheared", R"([{"op":"replace","path":"/nodes/2/matrix/4","value":0.5}])", "/nodes/2/matrix"},
    {"no_root", R"([{"op":"add","path":"/scenes/0/nodes/-","value":3}])", "/scenes/0/nodes/3"},
    {"node_twice", R"([{"op":"add","path":"/scenes/0/nodes/-","value":1}])", "/scenes/0/nodes/3"},
    {"child_twice", R"([{"op":"add","path":"/nodes/0/children/-","value":3}])", "/nodes/0/children/1"},
    {"loop", R"([{"op":"add","path":"/nodes/3/children","value":[0]}])", "/nodes/3"},
    {"camera_of_two_types", R"([{"op":"add","path":"/cameras/0/orthographic","value":{"xmag":1,"ymag":1,"znear":0,"zfar":1}}])",
     "/cameras/0"},
    {"camera_without_lens", R"([{"op":"remove","path":"/cameras/0/perspective"}])", "/cameras/0"},
    {"far_before_near", R"([{"op":"add","path":"/cameras/0/perspective/zfar","value":0.1}])", "/cameras/0/perspective/zfar"},
    {"skin_without_joints_data", R"([{"op":"remove","path":"/meshes/0/primitives/0/attributes/JOINTS_0"},
        {"op":"remove","path":"/meshes/0/primitives/0/attributes/WEIGHTS_0"}])",
     "/nodes/0/skin"},
    {"weights_without_targets", R"([{"op":"add","path":"/nodes/0/weights","value":[1]}])", "/nodes/0/weights"},
    // buffers, views
    {"buffer_type", R"([{"op":"add","path":"/buffers/-","value":{"byteLength":3,"uri":"data:image/png;base64,AAAA"}}])", "/buffers/1/uri"},
    {"buffer_too_short", R"([{"op":"add","path":"/buffers/-","value":{"byteLength":9,"uri":"data:application/octet-stream;base64,AAAA"}}])",
     "/buffers/1/byteLength"},
    {"buffer_too_long", R"([{"op":"add","path":"/buffers/-","value":{"byteLength":2,"uri":"data:application/octet-stream;base64,AAAA"}}])",
     "/buffers/1/byteLength"},
    {"buffer_length_nothing", R"([{"op":"replace","path":"/buffers/0/byteLength","value":0}])", "/buffers/0/byteLength"},
    {"view_too_long", R"([{"op":"replace","path":"/bufferViews/0/byteLength","value":100000}])", "/bufferViews/0"},
    {"view_target_unknown", R"([{"op":"add","path":"/bufferViews/0/target","value":1}])", "/bufferViews/0/target"},
    {"view_target_of_vertices", R"([{"op":"add","path":"/bufferViews/0/target","value":34963}])", "/bufferViews/0/target"},
    {"view_target_of_indices", R"([{"op":"add","path":"/bufferViews/6/target","value":34962}])", "/bufferViews/6/target"},
    {"stride_too_small", R"([{"op":"add","path":"/bufferViews/0/byteStride","value":8}])", "/accessors/0"},
    {"stride_odd", R"([{"op":"add","path":"/bufferViews/0/byteStride","value":14}])", "/accessors/0"},
    {"stride_above_length", R"([{"op":"add","path":"/bufferViews/0/byteStride","value":252}])", "/accessors/0"},
    {"stride_of_indices", R"([{"op":"add","path":"/bufferViews/6/byteStride","value":4},{"op":"replace","path":"/bufferViews/6/byteLength",
        "value":12}])",
     "/bufferViews/6/byteStride"},
    {"no_stride_for_two", R"([{"op":"replace","path":"/bufferViews/0/byteLength","value":72},
        {"op":"replace","path":"/accessors/1/bufferView","value":0},{"op":"add","path":"/accessors/1/byteOffset","value":36}])",
     "/bufferViews/0"},
    {"view_of_vertices_and_indices", R"([{"op":"replace","path":"/accessors/6/bufferView","value":3},
        {"op":"replace","path":"/accessors/6/componentType","value":5125},{"op":"replace","path":"/accessors/6/count","value":3}])",
     "/meshes/0/primitives/0/indices"},
    // accessors
    {"offset_without_view", R"([{"op":"add","path":"/accessors/-","value":{"componentType":5126,"type":"VEC3","count":3,"byteOffset":4}}])",
     "/accessors/11/byteOffset"},
    {"offset_unaligned",
     R"([{"op":"replace","path":"/accessors/3/count","value":2},{"op":"add","path":"/accessors/3/byteOffset","value":2}])",
     "/meshes/0/primitives/0/attributes"},
    {"total_offset_unaligned", R"([{"op":"replace","path":"/bufferViews/8/byteOffset","value":1}])", "/accessors/8"},
    {"normalized_float", R"([{"op":"add","path":"/accessors/1/normalized","value":true}])", "/accessors/1/normalized"},
    {"count_nothing", R"([{"op":"replace","path":"/accessors/1/count","value":0}])", "/accessors/1/count"},
    {"count_too_large", R"([{"op":"replace","path":"/accessors/1/count","value":4}])", "/accessors/1"},
    {"type_unknown", R"([{"op":"replace","path":"/accessors/1/type","value":"VEC5"}])", "/accessors/1/type"},
    {"component_unknown", R"([{"op":"replace","path":"/accessors/1/componentType","value":5124}])", "/accessors/1/componentType"},
    {"min_of_wrong_length", R"([{"op":"replace","path":"/accessors/0/min","value":[0,0]}])", "/accessors/0/min"},
    {"min_is_no_array", R"([{"op":"replace","path":"/accessors/0/min","value":0}])", "/accessors/0/min"},
    {"min_too_high", R"([{"op":"replace","path":"/accessors/0/min/0","value":0.5}])", "/accessors/0/min/0"},
    {"min_too_low", R"([{"op":"replace","path":"/accessors/0/min/1","value":-1}])", "/accessors/0/min/1"},
    {"max_too_low", R"([{"op":"replace","path":"/accessors/0/max/0","value":0.5}])", "/accessors/0/max/0"},
    {"max_too_high", R"([{"op":"replace","path":"/accessors/0/max/2","value":7}])", "/accessors/0/max/2"},
    {"sparse_above_count", R"([{"op":"add","path":"/accessors/3/sparse","value":{"count":4,"indices":{"bufferView":10,"componentType":5121},
        "values":{"bufferView":0}}}])",
     "/accessors/3/sparse/count"},
    {"sparse_not_increasing", R"([{"op":"add","path":"/accessors/3/sparse","value":{"count":2,"indices":{"bufferView":10,
        "componentType":5123},"values":{"bufferView":8}}}])",
     "/accessors/3/sparse/indices"},
    {"sparse_with_target", R"([{"op":"add","path":"/bufferViews/10/target","value":34962},{"op":"add","path":"/accessors/3/sparse","value":
        {"count":1,"indices":{"bufferView":10,"componentType":5123},"values":{"bufferView":8}}}])",
     "/accessors/3/sparse/indices/bufferView"},
    {"normal_not_unit", R"([{"op":"replace","path":"/meshes/0/primitives/0/attributes/NORMAL","value":8}])", "/accessors/8"},
    {"tangent_not_unit", R"([{"op":"replace","path":"/accessors/2/bufferView","value":9}])", "/accessors/2"},
    // meshes
    {"no_bounds", R"([{"op":"remove","path":"/accessors/0/min"}])", "/meshes/0/primitives/0/attributes/POSITION"},
    {"unknown_attribute", R"([{"op":"add","path":"/meshes/0/primitives/0/attributes/COLOUR","value":2}])",
     "/meshes/0/primitives/0/attributes/COLOUR"},
    {"attribute_without_number", R"([{"op":"add","path":"/meshes/0/primitives/0/attributes/TEXCOORD","value":3}])",
     "/meshes/0/primitives/0/attributes/TEXCOORD"},
    {"numbers_with_a_gap", R"([{"op":"add","path":"/meshes/0/primitives/0/attributes/TEXCOORD_2","value":3}])",
     "/meshes/0/primitives/0/attributes"},
    {"joints_without_weights", R"([{"op":"remove","path":"/meshes/0/primitives/0/attributes/WEIGHTS_0"}])",
     "/meshes/0/primitives/0/attributes"},
    {"position_of_u32", R"([{"op":"replace","path":"/accessors/0/componentType","value":5125}])",
     "/meshes/0/primitives/0/attributes/POSITION"},
    {"coordinates_of_i16", R"([{"op":"replace","path":"/accessors/3/componentType","value":5122},
        {"op":"add","path":"/accessors/3/normalized","value":true}])",
     "/meshes/0/primitives/0/attributes/TEXCOORD_0"},
    {"counts_differ", R"([{"op":"replace","path":"/accessors/1/count","value":2}])", "/meshes/0/primitives/0/attributes"},
    {"vertices_unaligned", R"([{"op":"replace","path":"/accessors/4/type","value":"VEC3"},
        {"op":"remove","path":"/nodes/0/skin"}])",
     "/meshes/0/primitives/0/attributes/JOINTS_0"},
    {"indices_of_floats", R"([{"op":"replace","path":"/meshes/0/primitives/0/indices","value":7}])", "/meshes/0/primitives/0/indices"},
    {"indices_are_vertices_too", R"([{"op":"replace","path":"/meshes/0/primitives/0/indices","value":4}])",
     "/meshes/0/primitives/0/indices"},
    {"indices_normalized", R"([{"op":"add","path":"/accessors/6/normalized","value":true}])", "/meshes/0/primitives/0/indices"},
    {"no_coordinates", R"([{"op":"remove","path":"/meshes/0/primitives/0/attributes/TEXCOORD_0"}])", "mesh 0"},
    {"targets_without_base", R"([{"op":"add","path":"/meshes/0/primitives/0/targets","value":[{"COLOR_0":1}]}])",
     "/meshes/0/primitives/0/targets/0/COLOR_0"},
    {"target_count", R"([{"op":"add","path":"/meshes/0/primitives/0/targets","value":[{"POSITION":10}]}])",
     "/meshes/0/primitives/0/targets/0/POSITION"},
    {"mesh_weights", R"([{"op":"add","path":"/meshes/0/weights","value":[1]}])", "/meshes/0/weights"},
    // images
    {"image_uri_and_view", R"([{"op":"add","path":"/images/0/bufferView","value":0}])", "/images/0"},
    {"image_of_another_type", R"([{"op":"replace","path":"/images/0/mimeType","value":"image/jpeg"}])", "/images/0/mimeType"},
    {"image_view_without_type", R"([{"op":"replace","path":"/images/0","value":{"bufferView":0}}])", "/images/0"},
    {"uri_with_spaces", R"([{"op":"add","path":"/images/-","value":{"uri":"a b.png"}}])", "/images/1/uri"},
    // skins, animations
    {"too_few_matrices", R"([{"op":"add","path":"/skins/0/joints/-","value":1}])", "/skins/0/inverseBindMatrices"},
    {"matrices_of_vectors", R"([{"op":"replace","path":"/skins/0/inverseBindMatrices","value":8}])", "/skins/0/inverseBindMatrices"},
    {"no_samplers", R"([{"op":"remove","path":"/animations/0/samplers"}])", "/animations/0"},
    {"no_such_sampler", R"([{"op":"replace","path":"/animations/0/channels/0/sampler","value":1}])", "/animations/0/channels/0/sampler"},
    {"times_of_vectors", R"([{"op":"replace","path":"/animations/0/samplers/0/input","value":8}])", "/animations/0/samplers/0/input"},
    {"times_without_bounds", R"([{"op":"remove","path":"/accessors/7/max"}])", "/animations/0/samplers/0/input"},
    {"too_few_values", R"([{"op":"replace","path":"/accessors/8/count","value":2}])", "/animations/0/samplers/0/output"},
    {"values_of_the_wrong_type", R"([{"op":"replace","path":"/animations/0/channels/0/target/path","value":"rotation"}])",
     "/animations/0/channels/0/sampler"},
    {"target_has_a_matrix", R"([{"op":"replace","path":"/animations/0/channels/0/target/node","value":2}])",
     "/animations/0/channels/0/target/path"},
    {"target_without_morphs", R"([{"op":"replace","path":"/animations/0/channels/0/target/path","value":"weights"}])",
     "/animations/0/channels/0/target/path"},
    {"target_twice", R"([{"op":"add","path":"/animations/0/channels/-","value":{"sampler":0,"target":{"node":3,"path":"translation"}}}])",
     "/animations/0/channels/1/target"},
    // places of extensions, and contents of ignored ones
    {"extension_elsewhere", R"([{"op":"add","path":"/extensionsUsed","value":["KHR_materials_ior"]},
        {"op":"add","path":"/nodes/3/extensions","value":{"KHR_materials_ior":{}}}])",
     "/nodes/3/extensions/KHR_materials_ior"},
    {"light_of_a_material", R"([{"op":"add","path":"/extensionsUsed","value":["KHR_lights_punctual"]},
        {"op":"add","path":"/materials/0/extensions","value":{"KHR_lights_punctual":{}}}])",
     "/materials/0/extensions/KHR_lights_punctual"},
    {"ignored_extension_is_no_object", R"([{"op":"add","path":"/extensionsUsed","value":["KHR_materials_diffuse_transmission"]},
        {"op":"add","path":"/materials/0/extensions","value":{"KHR_materials_diffuse_transmission":[]}}])",
     "/materials/0/extensions/KHR_materials_diffuse_transmission"},
    {"extensions_are_no_object", R"([{"op":"add","path":"/scenes/0/extensions","value":[1,2,3]}])", "/scenes/0/extensions"},
    {"extensions_of_an_extension_are_no_object", R"([{"op":"add","path":"/extensionsUsed","value":["KHR_materials_ior"]},
        {"op":"add","path":"/materials/0/extensions","value":{"KHR_materials_ior":{"ior":1.4,"extensions":1}}}])",
     "/materials/0/extensions/KHR_materials_ior/extensions"},
    {"ignored_number_out_of_range", R"([{"op":"add","path":"/extensionsUsed","value":["KHR_materials_diffuse_transmission"]},
        {"op":"add","path":"/materials/0/extensions","value":{"KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":2}}}])",
     "/materials/0/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor"},
    {"ignored_number_is_text", R"([{"op":"add","path":"/extensionsUsed","value":["KHR_materials_diffuse_transmission"]},
        {"op":"add","path":"/materials/0/extensions","value":{"KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":"x"}}}])",
     "/materials/0/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor"},
    {"light_above_one", R"([{"op":"add","path":"/extensionsUsed","value":["KHR_lights_punctual"]},
        {"op":"add","path":"/extensions","value":{"KHR_lights_punctual":{"lights":[{"type":"point","color":[1,2,1]}]}}}])",
     "/extensions/KHR_lights_punctual/lights/0/color/1"},
    // skins and the meshes that they move
    {"matrix_flat", R"([{"op":"replace","path":"/nodes/2/matrix/5","value":0}])", "/nodes/2/matrix"},
    {"skeleton_beside_joints", R"([{"op":"add","path":"/skins/0/skeleton","value":1}])", "/skins/0/skeleton"},
    {"joints_of_two_roots",
     R"([{"op":"replace","path":"/skins/0/joints","value":[3,1]},{"op":"remove","path":"/skins/0/inverseBindMatrices"}])",
     "/skins/0/joints"},
    {"joints_outside_the_scene", R"([{"op":"remove","path":"/nodes/0/children"}])", "/nodes/0/skin"},
    {"joint_too_high", R"([{"op":"replace","path":"/bufferViews/4/byteOffset","value":96}])",
     "/meshes/0/primitives/0/attributes/WEIGHTS_0"},
    {"weights_do_not_add_up", R"([{"op":"replace","path":"/accessors/5/bufferView","value":9},
        {"op":"add","path":"/accessors/5/byteOffset","value":4}])",
     "/meshes/0/primitives/0/attributes/WEIGHTS_0"},
    {"joint_twice", R"([{"op":"replace","path":"/bufferViews/5/byteOffset","value":84}])", "/meshes/0/primitives/0/attributes/WEIGHTS_0"},
    {"bind_matrix_with_another_row", R"([{"op":"replace","path":"/bufferViews/9/byteOffset","value":72}])", "/skins/0/inverseBindMatrices"},
    // morph targets
    {"target_of_another_format", R"([{"op":"add","path":"/meshes/0/primitives/0/targets","value":[{"NORMAL":2}]}])",
     "/meshes/0/primitives/0/targets/0/NORMAL"},
    {"target_without_bounds", R"([{"op":"add","path":"/meshes/0/primitives/0/targets","value":[{"POSITION":1}]}])",
     "/meshes/0/primitives/0/targets/0/POSITION"},
    // views with two uses
    {"view_of_vertices_and_keys", R"([{"op":"replace","path":"/animations/0/samplers/0/output","value":1}])",
     "/animations/0/samplers/0/output"},
    {"view_of_vertices_and_sparse_indices", R"([{"op":"add","path":"/accessors/3/sparse","value":{"count":1,"indices":{"bufferView":1,
        "componentType":5123},"values":{"bufferView":8}}}])",
     "/meshes/0/primitives/0/attributes/NORMAL"},
    {"target_of_keys", R"([{"op":"add","path":"/bufferViews/7/target","value":34962}])", "/bufferViews/7/target"},
    {"stride_of_keys", R"([{"op":"add","path":"/bufferViews/7/byteStride","value":4}])", "/bufferViews/7/byteStride"},
    {"stride_of_matrices", R"([{"op":"add","path":"/bufferViews/9/byteStride","value":64}])", "/bufferViews/9/byteStride"},
    {"joints_of_another_count", R"([{"op":"replace","path":"/accessors/4/count","value":2}])",
     "/meshes/0/primitives/0/attributes/JOINTS_0"},
    // keys
    {"keys_of_integers", R"([{"op":"replace","path":"/accessors/8/componentType","value":5122}])", "/animations/0/channels/0/sampler"},
    {"times_do_not_grow", R"([{"op":"replace","path":"/bufferViews/7/byteOffset","value":0}])", "/animations/0/samplers/0/input"},
    {"times_negative", R"([{"op":"replace","path":"/bufferViews/7","value":{"buffer":1,"byteLength":12}},
        {"op":"add","path":"/buffers/-","value":{"byteLength":12,"uri":"data:application/octet-stream;base64,AACAvwAAgD8AAABA"}}])",
     "/animations/0/samplers/0/input"},
    {"rotation_key_not_unit", R"([{"op":"replace","path":"/animations/0/channels/0/target/path","value":"rotation"},
        {"op":"replace","path":"/bufferViews/8","value":{"buffer":1,"byteLength":48}},
        {"op":"replace","path":"/accessors/8","value":{"bufferView":8,"componentType":5126,"type":"VEC4","count":3}},
        {"op":"add","path":"/buffers/-","value":{"byteLength":48,"uri":"data:application/octet-stream;base64,AAAAQAAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAABAAAAAAAAAAAAAAAAA"}}])",
     "/animations/0/channels/0/sampler"},
    {"not_a_number_in_keys", R"([{"op":"replace","path":"/bufferViews/7","value":{"buffer":1,"byteLength":12}},
        {"op":"add","path":"/buffers/-","value":{"byteLength":12,"uri":"data:application/octet-stream;base64,AAAAAAAAwH8AAABA"}}])",
     "/accessors/7"},
    {"coordinates_behind_a_transform", R"([{"op":"add","path":"/extensionsUsed","value":["KHR_texture_transform"]},
        {"op":"add","path":"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord","value":1},
        {"op":"add","path":"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions","value":{"KHR_texture_transform":{"texCoord":0}}}])",
     "/meshes/0/primitives/0/material"},
    {"image_type_empty", R"([{"op":"replace","path":"/images/0/mimeType","value":""}])", "/images/0/mimeType"},
};

std::string where(const std::string& line)
{
    return line.substr(0, line.find(": "));
}

} // namespace

TEST(strict, a_sound_file_is_read_with_no_word_but_of_what_does_not_move)
{
    Limits strict;
    strict.strict = true;
    const Result<Scene> scene = load_text(sound().dump(), strict);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->warnings, (std::vector<std::string>{"animations are drawn at Moment::seconds only; the scene is drawn as it rests"}));
    expect_sound(*scene);
}

TEST(breaches, are_named_and_with_strict_refused)
{
    Limits strict;
    strict.strict = true;
    for (const Breach& breach : kBreaches) {
        SCOPED_TRACE(breach.name);
        const std::string text = sound().patch(Json::parse(breach.patch)).dump();
        const Result<Scene> scene = load_text(text);
        bool named = false;
        std::string said = error_of(scene);
        if (scene) {
            for (const std::string& warning : scene->warnings) {
                named = named || where(warning) == breach.place;
                said += warning + "\n";
            }
            expect_sound(*scene);
        } else {
            named = scene.error().place == breach.place;
        }
        EXPECT_TRUE(named) << said;
        EXPECT_FALSE(load_text(text, strict)) << "read with --strict";
    }
}

TEST(breach, of_the_container_are_named)
{
    Limits strict;
    strict.strict = true;
    const std::string marked = "\xef\xbb\xbf" + triangle().gltf();
    const Result<Scene> scene = load_text(marked);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(where(scene->warnings.at(0)), "byte 0");
    EXPECT_EQ(error_of(load_text(marked, strict)).substr(0, 6), "byte 0");

    ByteVector glb = triangle().glb();
    std::uint32_t json_length = 0;
    std::memcpy(&json_length, glb.data() + 12, 4);
    glb.resize(20 + json_length); // remove the BIN chunk
    const std::uint32_t length = static_cast<std::uint32_t>(glb.size());
    std::memcpy(glb.data() + 8, &length, 4);
    EXPECT_FALSE(load_gltf_bytes(glb.data(), glb.size(), "test.glb", {})); // its accessors need the chunk
    EXPECT_EQ(error_of(load_gltf_bytes(glb.data(), glb.size(), "test.glb", strict)).substr(0, 10), "/buffers/0");
}
