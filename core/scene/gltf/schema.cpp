#include "core/scene/gltf/schema.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <string_view>

#include "core/scene/gltf/extensions.h"
#include "core/scene/gltf/textures.h"

namespace burnish::gltf {

namespace {

constexpr double kAny = 3.4028234663852886e38; // every number must fit a float
constexpr double kWhole = 9007199254740992.0;  // 2^53: integers stay exact in JSON readers

enum class Kind { object, objects, text, boolean, integer, index, indices, number, numbers, word, words, code };

// One rule for all values that a path matches; '*' matches any array element or object member.
struct Rule {
    const char* path;
    Kind kind;
    double low = -kAny, high = kAny; // bounds for integers and numbers
    const char* more = "";           // index: the table; word: the allowed words; code: the allowed integers
    bool required = false;
    std::size_t count = 0; // numbers: array length, 0 any
};

constexpr bool kRequired = true;

const Rule kRules[] = {
    {"scene", Kind::index, 0, 0, "scenes"},
    {"scenes", Kind::objects},
    {"scenes/*/name", Kind::text},
    {"scenes/*/nodes", Kind::indices, 0, 0, "nodes"},
    {"nodes", Kind::objects},
    {"nodes/*/name", Kind::text},
    {"nodes/*/children", Kind::indices, 0, 0, "nodes"},
    {"nodes/*/mesh", Kind::index, 0, 0, "meshes"},
    {"nodes/*/camera", Kind::index, 0, 0, "cameras"},
    {"nodes/*/skin", Kind::index, 0, 0, "skins"},
    {"nodes/*/matrix", Kind::numbers, -kAny, kAny, "", false, 16},
    {"nodes/*/translation", Kind::numbers, -kAny, kAny, "", false, 3},
    {"nodes/*/rotation", Kind::numbers, -kAny, kAny, "", false, 4},
    {"nodes/*/scale", Kind::numbers, -kAny, kAny, "", false, 3},
    {"nodes/*/extensions", Kind::object},
    {"nodes/*/extensions/KHR_lights_punctual", Kind::object},
    {"nodes/*/extensions/KHR_lights_punctual/light", Kind::index, 0, 0, "extensions/KHR_lights_punctual/lights", kRequired},

    {"extensions", Kind::object},
    {"extensions/KHR_materials_variants", Kind::object},
    {"extensions/KHR_materials_variants/variants", Kind::objects, 0, 0, "", kRequired},
    {"extensions/KHR_materials_variants/variants/*/name", Kind::text, 0, 0, "", kRequired},
    {"extensions/KHR_lights_punctual", Kind::object},
    {"extensions/KHR_lights_punctual/lights", Kind::objects},
    {"extensions/KHR_lights_punctual/lights/*/name", Kind::text},
    {"extensions/KHR_lights_punctual/lights/*/type", Kind::word, 0, 0, "directional point spot", kRequired},

    {"scenes/*/extensions", Kind::object},
    {"scenes/*/extensions/EXT_lights_image_based", Kind::object},
    {"scenes/*/extensions/EXT_lights_image_based/light", Kind::index, 0, 0, "extensions/EXT_lights_image_based/lights", kRequired},
    {"extensions/EXT_lights_image_based", Kind::object},
    {"extensions/EXT_lights_image_based/lights", Kind::objects},
    {"extensions/EXT_lights_image_based/lights/*/name", Kind::text},
    {"extensions/EXT_lights_image_based/lights/*/intensity", Kind::number, 0},
    {"extensions/EXT_lights_image_based/lights/*/rotation", Kind::numbers, -kAny, kAny, "", false, 4},
    {"extensions/EXT_lights_image_based/lights/*/irradianceCoefficients/*", Kind::numbers, -kAny, kAny, "", false, 3},
    {"extensions/EXT_lights_image_based/lights/*/specularImageSize", Kind::integer, 1, 1 << 20, "", kRequired},
    {"extensions/EXT_lights_image_based/lights/*/specularImages/*", Kind::indices, 0, 0, "images", false, 6},

    {"cameras", Kind::objects},
    {"cameras/*/name", Kind::text},
    {"cameras/*/type", Kind::word, 0, 0, "perspective orthographic", kRequired},
    {"cameras/*/perspective", Kind::object},
    {"cameras/*/perspective/yfov", Kind::number, 1e-6, 3.1415926, "", kRequired},
    {"cameras/*/perspective/znear", Kind::number, 1e-30, kAny, "", kRequired},
    {"cameras/*/perspective/zfar", Kind::number, 1e-30, kAny},
    {"cameras/*/perspective/aspectRatio", Kind::number, 1e-30, kAny},
    {"cameras/*/orthographic", Kind::object},
    {"cameras/*/orthographic/xmag", Kind::number, -kAny, kAny, "", kRequired},
    {"cameras/*/orthographic/ymag", Kind::number, -kAny, kAny, "", kRequired},
    {"cameras/*/orthographic/znear", Kind::number, 0, kAny, "", kRequired},
    {"cameras/*/orthographic/zfar", Kind::number, 1e-30, kAny, "", kRequired},

    {"buffers", Kind::objects},
    {"buffers/*/byteLength", Kind::integer, 1, kWhole, "", kRequired},
    {"buffers/*/uri", Kind::text},
    {"buffers/*/extensions", Kind::object},
    {"buffers/*/extensions/EXT_meshopt_compression", Kind::object},
    {"buffers/*/extensions/EXT_meshopt_compression/fallback", Kind::boolean},
    {"bufferViews", Kind::objects},
    {"bufferViews/*/buffer", Kind::index, 0, 0, "buffers", kRequired},
    {"bufferViews/*/byteOffset", Kind::integer, 0, kWhole},
    {"bufferViews/*/byteLength", Kind::integer, 1, kWhole, "", kRequired},
    {"bufferViews/*/byteStride", Kind::integer, 4, 252},
    {"bufferViews/*/extensions", Kind::object},
    {"bufferViews/*/extensions/EXT_meshopt_compression", Kind::object},
    {"bufferViews/*/extensions/EXT_meshopt_compression/buffer", Kind::index, 0, 0, "buffers", kRequired},
    {"bufferViews/*/extensions/EXT_meshopt_compression/byteOffset", Kind::integer, 0, kWhole},
    {"bufferViews/*/extensions/EXT_meshopt_compression/byteLength", Kind::integer, 1, kWhole, "", kRequired},
    {"bufferViews/*/extensions/EXT_meshopt_compression/byteStride", Kind::integer, 1, 256, "", kRequired},
    {"bufferViews/*/extensions/EXT_meshopt_compression/count", Kind::integer, 1, kWhole, "", kRequired},
    {"bufferViews/*/extensions/EXT_meshopt_compression/mode", Kind::word, 0, 0, "ATTRIBUTES TRIANGLES INDICES", kRequired},
    {"bufferViews/*/extensions/EXT_meshopt_compression/filter", Kind::word, 0, 0, "NONE OCTAHEDRAL QUATERNION EXPONENTIAL"},
    {"accessors", Kind::objects},
    {"accessors/*/bufferView", Kind::index, 0, 0, "bufferViews"},
    {"accessors/*/byteOffset", Kind::integer, 0, kWhole},
    {"accessors/*/componentType", Kind::code, 0, 0, "5120 5121 5122 5123 5125 5126", kRequired},
    {"accessors/*/normalized", Kind::boolean},
    {"accessors/*/count", Kind::integer, 1, kWhole, "", kRequired},
    {"accessors/*/type", Kind::word, 0, 0, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4", kRequired},
    {"accessors/*/sparse", Kind::object},
    {"accessors/*/sparse/count", Kind::integer, 1, kWhole, "", kRequired},
    {"accessors/*/sparse/indices", Kind::object, 0, 0, "", kRequired},
    {"accessors/*/sparse/indices/bufferView", Kind::index, 0, 0, "bufferViews", kRequired},
    {"accessors/*/sparse/indices/byteOffset", Kind::integer, 0, kWhole},
    {"accessors/*/sparse/indices/componentType", Kind::code, 0, 0, "5121 5123 5125", kRequired},
    {"accessors/*/sparse/values", Kind::object, 0, 0, "", kRequired},
    {"accessors/*/sparse/values/bufferView", Kind::index, 0, 0, "bufferViews", kRequired},
    {"accessors/*/sparse/values/byteOffset", Kind::integer, 0, kWhole},

    {"meshes", Kind::objects},
    {"meshes/*/name", Kind::text},
    {"meshes/*/primitives", Kind::objects, 0, 0, "", kRequired},
    {"meshes/*/primitives/*/attributes", Kind::object, 0, 0, "", kRequired},
    {"meshes/*/primitives/*/attributes/*", Kind::index, 0, 0, "accessors"},
    {"meshes/*/primitives/*/indices", Kind::index, 0, 0, "accessors"},
    {"meshes/*/primitives/*/material", Kind::index, 0, 0, "materials"},
    {"meshes/*/primitives/*/mode", Kind::code, 0, 0, "0 1 2 3 4 5 6"},
    {"meshes/*/primitives/*/targets", Kind::objects},
    {"meshes/*/primitives/*/extensions", Kind::object},
    {"meshes/*/primitives/*/extensions/KHR_materials_variants", Kind::object},
    {"meshes/*/primitives/*/extensions/KHR_materials_variants/mappings", Kind::objects, 0, 0, "", kRequired},
    {"meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/material", Kind::index, 0, 0, "materials", kRequired},
    {"meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/variants", Kind::indices, 0, 0,
     "extensions/KHR_materials_variants/variants", kRequired},
    {"meshes/*/primitives/*/extensions/KHR_draco_mesh_compression", Kind::object},
    {"meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", Kind::index, 0, 0, "bufferViews", kRequired},
    {"meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes", Kind::object, 0, 0, "", kRequired},
    {"meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes/*", Kind::integer, 0, 4294967295.0},

    {"nodes/*/weights", Kind::numbers},
    {"meshes/*/weights", Kind::numbers},
    {"meshes/*/primitives/*/targets/*/*", Kind::index, 0, 0, "accessors"},
    {"accessors/*/name", Kind::text},
    {"accessors/*/min", Kind::numbers, -1e39, 1e39},
    {"accessors/*/max", Kind::numbers, -1e39, 1e39},
    {"buffers/*/name", Kind::text},
    {"bufferViews/*/name", Kind::text},
    {"bufferViews/*/target", Kind::code, 0, 0, "34962 34963"},
    {"samplers/*/name", Kind::text},
    {"skins", Kind::objects},
    {"skins/*/name", Kind::text},
    {"skins/*/joints", Kind::indices, 0, 0, "nodes", kRequired},
    {"skins/*/skeleton", Kind::index, 0, 0, "nodes"},
    {"skins/*/inverseBindMatrices", Kind::index, 0, 0, "accessors"},
    {"animations", Kind::objects},
    {"animations/*/name", Kind::text},
    {"animations/*/samplers", Kind::objects, 0, 0, "", kRequired},
    {"animations/*/samplers/*/input", Kind::index, 0, 0, "accessors", kRequired},
    {"animations/*/samplers/*/output", Kind::index, 0, 0, "accessors", kRequired},
    {"animations/*/samplers/*/interpolation", Kind::text},
    {"animations/*/channels", Kind::objects, 0, 0, "", kRequired},
    {"animations/*/channels/*/sampler", Kind::integer, 0, kWhole, "", kRequired},
    {"animations/*/channels/*/target", Kind::object, 0, 0, "", kRequired},
    {"animations/*/channels/*/target/node", Kind::index, 0, 0, "nodes"},
    {"animations/*/channels/*/target/path", Kind::text, 0, 0, "", kRequired},

    {"images", Kind::objects},
    {"images/*/name", Kind::text},
    {"images/*/uri", Kind::text},
    {"images/*/mimeType", Kind::text},
    {"images/*/bufferView", Kind::index, 0, 0, "bufferViews"},
    {"samplers", Kind::objects},
    {"samplers/*/magFilter", Kind::code, 0, 0, "9728 9729"},
    {"samplers/*/minFilter", Kind::code, 0, 0, "9728 9729 9984 9985 9986 9987"},
    {"samplers/*/wrapS", Kind::code, 0, 0, "33071 33648 10497"},
    {"samplers/*/wrapT", Kind::code, 0, 0, "33071 33648 10497"},
    {"textures", Kind::objects},
    {"textures/*/name", Kind::text},
    {"textures/*/source", Kind::index, 0, 0, "images"},
    {"textures/*/sampler", Kind::index, 0, 0, "samplers"},
    {"textures/*/extensions", Kind::object},
    {"textures/*/extensions/EXT_texture_webp", Kind::object},
    {"textures/*/extensions/EXT_texture_webp/source", Kind::index, 0, 0, "images"},

    {"materials", Kind::objects},
    {"materials/*/name", Kind::text},
};

template <class Field> constexpr Rule factor_rule(const char* path, double least, double most)
{
    constexpr std::size_t kCount = sizeof(Field) / sizeof(float);
    return {path, kCount == 1 ? Kind::number : Kind::numbers, least, most, "", false, kCount == 1 ? 0 : kCount};
}

// Rules for a material or light: the lines of core/scene's .def files.
const Rule kMaterialRules[] = {
#define BN_FACTOR(kind, name, fallback, path, least, most) factor_rule<FieldKinds::kind>(path, least, most),
#define BN_FLAG(kind, name, path) {path, Kind::kind},
#define BN_CHOICE(type, name, words, path) {path, Kind::word, 0, 0, words},
#define BN_TEXTURE(name, path) {path, Kind::object},
#include "core/scene/material.def"
    {"/extras/burnish/rotationTexture/encoding", Kind::word, 0, 0, kRotationEncodings},
    {"/extras/burnish/directionalRoughnessTexture/encoding", Kind::word, 0, 0, kRoughnessEncodings},
};
const Rule kLightRules[] = {
#define BN_LIGHT_FACTOR(kind, name, fallback, path, least, most) factor_rule<FieldKinds::kind>(path, least, most),
#include "core/scene/light.def"
};

const Rule kAreaLightRules[] = {
    // below a node
    {"/extras/burnish/areaLight", Kind::object},
    {"/extras/burnish/areaLight/shape", Kind::word, 0, 0, "quad polygon disk sphere line", kRequired},
    {"/extras/burnish/areaLight/points", Kind::numbers, -kAny, kAny, "", kRequired},
    {"/extras/burnish/areaLight/twoSided", Kind::boolean},
    {"/extras/burnish/areaLight/solid", Kind::boolean},
    {"/extras/burnish/areaLight/texture", Kind::object},
    {"/extras/burnish/areaLight/texture/index", Kind::index, 0, 0, "textures", kRequired},
#define BN_AREA_FACTOR(kind, name, path, least, most) factor_rule<FieldKinds::kind>("/extras/burnish/areaLight" path, least, most),
#include "core/scene/area_light.def"
};

// Rules for every texture reference in a material (textures.h).
const Rule kTextureInfoRules[] = {
    {"", Kind::object},
    {"/index", Kind::index, 0, 0, "textures", kRequired},
    {"/texCoord", Kind::integer, 0, 1000},
    {"/extensions", Kind::object},
    {"/extensions/KHR_texture_transform", Kind::object},
    {"/extensions/KHR_texture_transform/offset", Kind::numbers, -kAny, kAny, "", false, 2},
    {"/extensions/KHR_texture_transform/scale", Kind::numbers, -kAny, kAny, "", false, 2},
    {"/extensions/KHR_texture_transform/rotation", Kind::number},
    {"/extensions/KHR_texture_transform/texCoord", Kind::integer, 0, 1000},
};

class Checker {
  public:
    explicit Checker(Json& root) : root_(root) {}

    void run(const Rule& rule, std::string_view path)
    {
        rule_ = &rule;
        table_ = rule.kind == Kind::index || rule.kind == Kind::indices ? size_of(rule.more) : 0;
        place_.clear();
        visit(root_, path);
    }

  private:
    std::size_t size_of(std::string_view table) const
    {
        const Json::json_pointer pointer(fmt::format("/{}", table));
        return root_.contains(pointer) && root_.at(pointer).is_array() ? root_.at(pointer).size() : 0;
    }

    void visit(Json& node, std::string_view path)
    {
        const std::size_t slash = path.find('/');
        const std::string_view step = path.substr(0, slash);
        const std::string_view rest = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
        const std::size_t mark = place_.size();
        const auto descend = [&](Json& child, std::string_view name) {
            (place_ += '/') += name;
            rest.empty() ? check(child) : visit(child, rest);
            place_.resize(mark);
        };
        if (step == "*" && node.is_array()) {
            for (std::size_t i = 0; i < node.size(); ++i)
                descend(node[i], std::to_string(i));
        } else if (step == "*" && node.is_object()) {
            for (auto it = node.begin(); it != node.end(); ++it)
                descend(it.value(), it.key());
        } else if (node.is_object()) {
            const auto it = node.find(std::string(step));
            if (it != node.end())
                descend(*it, step);
            else if (rule_->required && rest.empty())
                fail(place(), "\"" + std::string(step) + "\" is missing");
        }
    }

    std::string place() const { return place_.empty() ? "/" : printable(place_); }
    [[noreturn]] void wrong(const std::string& want, const Json& value) const
    {
        const std::string shown = value.is_structured() ? value.type_name() : printable(value.dump());
        fail(place(), "must be " + want + ", is " + shown);
    }

    void check_number(Json& value, bool whole)
    {
        const char* kind = whole ? "an integer" : "a number";
        if (!value.is_number())
            wrong(kind, value);
        const double number = value.get<double>();
        if (whole && (std::floor(number) != number || !(std::abs(number) <= kWhole)))
            wrong(kind, value);
        if (!(number >= rule_->low && number <= rule_->high)) {
            if (rule_->high >= kWhole)
                wrong(rule_->low <= -kAny ? "a finite number" : fmt::format("{} of at least {}", kind, rule_->low), value);
            wrong(fmt::format("{} from {} to {}", kind, rule_->low, rule_->high), value);
        }
        if (!whole)
            value = number;
        else if (value.is_number_float())
            value = static_cast<std::int64_t>(number);
    }

    void check_index(Json& value)
    {
        if (!value.is_number())
            wrong("an index", value);
        const double number = value.get<double>();
        if (!(number >= 0 && number < static_cast<double>(table_)) || std::floor(number) != number)
            wrong(fmt::format("an index into the {} entries of /{}", table_, rule_->more), value);
        value = static_cast<std::int64_t>(number);
    }

    template <class F> void check_each(Json& array, const char* want, F&& each)
    {
        if (!array.is_array() || (rule_->count && array.size() != rule_->count))
            wrong(rule_->count ? fmt::format("an array of {} {}", rule_->count, want) : fmt::format("an array of {}", want), array);
        const std::size_t mark = place_.size();
        for (std::size_t i = 0; i < array.size(); ++i) {
            place_ += "/" + std::to_string(i);
            each(array[i]);
            place_.resize(mark);
        }
    }

    void check_object(const Json& value) const
    {
        if (!value.is_object())
            wrong("an object", value);
    }

    void check(Json& value)
    {
        switch (rule_->kind) {
        case Kind::object:
            return check_object(value);
        case Kind::objects:
            return check_each(value, "objects", [this](Json& v) { check_object(v); });
        case Kind::integer:
            return check_number(value, true);
        case Kind::number:
            return check_number(value, false);
        case Kind::numbers:
            return check_each(value, "numbers", [this](Json& v) { check_number(v, false); });
        case Kind::index:
            return check_index(value);
        case Kind::indices:
            return check_each(value, "indices", [this](Json& v) { check_index(v); });
        case Kind::words:
            return check_each(value, "strings", [this](Json& v) { check_text(v); });
        case Kind::text:
            return check_text(value);
        case Kind::boolean:
            if (!value.is_boolean())
                wrong("true or false", value);
            return;
        case Kind::word:
            if (!value.is_string() || !has_word(rule_->more, value.get_ref<const std::string&>()))
                wrong(std::string("one of ") + rule_->more, value);
            return;
        case Kind::code:
            return check_code(value);
        }
    }

    void check_text(const Json& value) const
    {
        if (!value.is_string())
            wrong("a string", value);
    }

    void check_code(Json& value)
    {
        const double number = value.is_number() ? value.get<double>() : -1.0;
        if (!(number >= 0 && number < 1e6) || !has_word(rule_->more, fmt::format("{}", number)))
            wrong(std::string("one of ") + rule_->more, value);
        value = static_cast<std::int64_t>(number);
    }

    Json& root_;
    const Rule* rule_ = nullptr;
    std::size_t table_ = 0;
    std::string place_;
};

// Applies rules to the values below one object. Also checks that the values' enclosing members are objects.
void check_below(Checker& checker, const std::string& where, std::span<const Rule> rules)
{
    for (const Rule& rule : rules) {
        const std::string_view path = rule.path;
        for (std::size_t slash = path.find('/', 1); slash != std::string_view::npos; slash = path.find('/', slash + 1)) {
            const std::string_view holder = path.substr(0, slash);
            const Rule object = {"", Kind::object};
            if (holder != "/extras") // extras may hold anything
                checker.run(object, where + std::string(holder));
        }
        checker.run(rule, where + rule.path);
    }
}

// Checks members of cameras, lights and materials that are only valid together.
void check_pairs(const Json& json)
{
    // Check cameras: their lens, zfar beyond znear, magnifications
    for (std::size_t i = 0; i < table_size(json, "cameras"); ++i) {
        const Json& camera = json["cameras"][i];
        const std::string type = camera["type"], place = fmt::format("/cameras/{}", i);
        if (!camera.contains(type))
            fail(place, "\"" + type + "\" is missing");
        const Json& lens = camera[type];
        if (lens.contains("zfar") && !(lens["zfar"].get<double>() > lens["znear"].get<double>()))
            fail(place + "/" + type + "/zfar", "must be greater than znear");
        for (const char* key : {"xmag", "ymag"})
            if (type == "orthographic" && lens[key].get<double>() == 0.0)
                fail(place + "/orthographic/" + key, "must not be 0");
    }
    // Check the cone angles of spot lights
    const Json* lights = get_extension(json, "KHR_lights_punctual");
    for (std::size_t i = 0; lights && i < table_size(*lights, "lights"); ++i) {
        const Json& light = (*lights)["lights"][i];
        const std::string place = fmt::format("/extensions/KHR_lights_punctual/lights/{}", i);
        if (light["type"] != "spot")
            continue;
        if (!light.contains("spot"))
            fail(place, "\"spot\" is missing");
        const Json& spot = light["spot"];
        if (spot.value("innerConeAngle", 0.0) >= spot.value("outerConeAngle", 0.78539816339744828))
            fail(place + "/spot", "innerConeAngle must be smaller than outerConeAngle");
    }
    // Check that conductors have both eta and k
    const Json::json_pointer conductor("/extras/burnish/conductor");
    for (std::size_t i = 0; i < table_size(json, "materials"); ++i)
        for (const char* key : {"eta", "k"})
            if (const Json& material = json["materials"][i]; material.contains(conductor) && !material[conductor].contains(key))
                fail(fmt::format("/materials/{}{}", i, conductor.to_string()), fmt::format("\"{}\" is missing", key));
    // Check the range of indices of refraction
    for (std::size_t i = 0; i < table_size(json, "materials"); ++i)
        if (const Json* ior = get_extension(json["materials"][i], "KHR_materials_ior")) {
            const double value = ior->value("ior", 1.5);
            if (value != 0.0 && value < 1.0)
                fail(fmt::format("/materials/{}/extensions/KHR_materials_ior/ior", i), "must be 0 or at least 1");
        }
}

} // namespace

void check_version_and_extensions(Document& doc)
{
    static const Rule kFirst[] = {
        {"asset", Kind::object, 0, 0, "", kRequired},
        {"asset/version", Kind::text, 0, 0, "", kRequired},
        {"asset/minVersion", Kind::text},
        {"asset/generator", Kind::text},
        {"asset/copyright", Kind::text},
        {"extensionsUsed", Kind::words},
        {"extensionsRequired", Kind::words},
    };
    // Check types before reading any member
    Checker checker(doc.json);
    for (const Rule& rule : kFirst)
        checker.run(rule, rule.path);
    // Check the version
    const Json& asset = doc.json["asset"];
    const std::string version = asset["version"];
    if (version.substr(0, 2) != "2.")
        fail("/asset/version", "glTF version \"" + printable(version) + "\" is not supported, only 2.x");
    if (asset.contains("minVersion") && asset["minVersion"] != "2.0")
        fail("/asset/minVersion", "glTF version " + printable(asset["minVersion"].dump()) + " is needed, 2.0 is supported");

    // Refuse unsupported required extensions
    std::set<std::string> seen;
    std::string missing;
    for (const Json& name : doc.json.value("extensionsRequired", Json::array()))
        if (!is_read(name) && seen.insert(name).second)
            missing += (missing.empty() ? "" : ", ") + printable(name);
    if (!missing.empty())
        fail("/extensionsRequired", "the file requires extensions that are not supported: " + missing);
    // Warn of unsupported used extensions
    for (const Json& name : doc.json.value("extensionsUsed", Json::array()))
        if (!is_read(name) && doc.limits.strict)
            fail("/extensionsUsed", "extension " + printable(name) + " is not supported (Limits::strict)");
        else if (!is_read(name))
            doc.warn(ignored_warning(printable(name)));
}

void check_schema(Json& json)
{
    Checker checker(json);
    for (const Rule& rule : kRules)
        checker.run(rule, rule.path);
    check_below(checker, "materials/*", kMaterialRules);
    check_below(checker, "extensions/KHR_lights_punctual/lights/*", kLightRules);
    check_below(checker, "nodes/*", kAreaLightRules);
    for (const MaterialTexture& texture : kMaterialTextures)
        for (const Rule& rule : kTextureInfoRules)
            checker.run(rule, std::string("materials/*") + texture.path + rule.path);
    check_pairs(json);
}

} // namespace burnish::gltf
