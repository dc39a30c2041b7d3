#include <array>
#include <fmt/format.h>
#include <span>
#include <string_view>

#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/checks.h"

namespace burnish::gltf {

namespace {

// Allowed formats of an attribute (glTF 2.0, 3.7.2.1; KHR_mesh_quantization adds the second list). A format is TYPE,
// component type, and "n" where normalization is required.
struct Semantic {
    std::string_view name; // without its number
    bool numbered;
    std::string_view formats, quantized;
};
constexpr Semantic kSemantics[] = {
    {"POSITION", false, "VEC3:5126", "VEC3:5120 VEC3:5120n VEC3:5121 VEC3:5121n VEC3:5122 VEC3:5122n VEC3:5123 VEC3:5123n"},
    {"NORMAL", false, "VEC3:5126", "VEC3:5120n VEC3:5122n"},
    {"TANGENT", false, "VEC4:5126", "VEC4:5120n VEC4:5122n"},
    {"TEXCOORD", true, "VEC2:5126 VEC2:5121n VEC2:5123n", "VEC2:5120 VEC2:5120n VEC2:5121 VEC2:5122 VEC2:5122n VEC2:5123"},
    {"COLOR", true, "VEC3:5126 VEC3:5121n VEC3:5123n VEC4:5126 VEC4:5121n VEC4:5123n", ""},
    {"JOINTS", true, "VEC4:5121 VEC4:5123", ""},
    {"WEIGHTS", true, "VEC4:5126 VEC4:5121n VEC4:5123n", ""},
};

// Formats in morph targets. Targets hold differences, so tangents have no sign and colours may be negative.
constexpr Semantic kTargetSemantics[] = {
    {"POSITION", false, "VEC3:5126", "VEC3:5120 VEC3:5120n VEC3:5122 VEC3:5122n"},
    {"NORMAL", false, "VEC3:5126", "VEC3:5120n VEC3:5122n"},
    {"TANGENT", false, "VEC3:5126", "VEC3:5120n VEC3:5122n"},
    {"TEXCOORD", true, "VEC2:5126 VEC2:5120n VEC2:5121n VEC2:5122n VEC2:5123n", "VEC2:5120 VEC2:5121 VEC2:5122 VEC2:5123"},
    {"COLOR", true, "VEC3:5126 VEC3:5120n VEC3:5121n VEC3:5122n VEC3:5123n VEC4:5126 VEC4:5120n VEC4:5121n VEC4:5122n VEC4:5123n", ""},
};

std::string format_of(const Json& accessor)
{
    return fmt::format("{}:{}{}", get_string(accessor, "type"), get_index(accessor, "componentType"),
                       accessor.value("normalized", false) ? "n" : "");
}

std::uint64_t component_of(const Json& accessor)
{
    return component_bytes(static_cast<ComponentType>(get_index(accessor, "componentType")));
}

struct Attribute {
    std::string base;
    int number = -1; // the number, if the name has one
};

Attribute split_name(const std::string& name)
{
    const std::size_t bar = name.rfind('_');
    if (bar == std::string::npos || bar + 1 == name.size() || name.find_first_not_of("0123456789", bar + 1) != std::string::npos ||
        name.size() - bar > 6)
        return {name, -1};
    return {name.substr(0, bar), std::stoi(name.substr(bar + 1))};
}

class Rules {
  public:
    explicit Rules(Document& doc)
        : doc_(doc), view_use_(table_size(doc.json, "bufferViews")), vertex_accessor_of_view_(view_use_.size(), -1),
          accessor_use_(table_size(doc.json, "accessors")),
          quantized_(doc.json.contains("extensionsUsed") && is_named(doc.json["extensionsUsed"], "KHR_mesh_quantization"))
    {
    }

    void run()
    {
        check_views();
        for (std::size_t i = 0; i < accessor_use_.size(); ++i)
            check_accessor(i);
        for (std::size_t m = 0; m < table_size(doc_.json, "meshes"); ++m) {
            const Json& primitives = doc_.json["meshes"][m]["primitives"];
            for (std::size_t p = 0; p < primitives.size(); ++p)
                check_primitive(primitives[p], fmt::format("/meshes/{}/primitives/{}", m, p));
        }
        for (std::size_t i = 0; i < table_size(doc_.json, "images"); ++i)
            if (const int view = get_index(doc_.json["images"][i], "bufferView"); view >= 0)
                use_view(view, "an image", fmt::format("/images/{}/bufferView", i));
        use_moving();
    }

  private:
    static constexpr const char* kOtherData = "data of other kinds";

    static bool is_named(const Json& names, const char* name)
    {
        for (const Json& n : names)
            if (n == name)
                return true;
        return false;
    }

    // Records uses by animations and skins: their views hold neither vertices nor indices.
    void use_moving()
    {
        for (std::size_t a = 0; a < table_size(doc_.json, "animations"); ++a) {
            const Json& samplers = doc_.json["animations"][a]["samplers"];
            for (std::size_t i = 0; i < samplers.size(); ++i)
                for (const char* part : {"input", "output"})
                    use_accessor(get_index(samplers[i], part), part[0] == 'i' ? "times of an animation" : "values of an animation",
                                 fmt::format("/animations/{}/samplers/{}/{}", a, i, part), kOtherData);
        }
        for (std::size_t i = 0; i < table_size(doc_.json, "skins"); ++i)
            if (const int matrices = get_index(doc_.json["skins"][i], "inverseBindMatrices"); matrices >= 0)
                use_accessor(matrices, "inverse bind matrices", fmt::format("/skins/{}/inverseBindMatrices", i), kOtherData);
    }

    void check_views()
    {
        for (std::size_t i = 0; i < view_use_.size(); ++i) {
            const Json& view = doc_.json["bufferViews"][i];
            const std::string place = fmt::format("/bufferViews/{}", i);
            if (!view.contains("byteStride"))
                continue;
            const std::uint64_t stride = get_uint(view, "byteStride", 0);
            if (stride % 4 != 0)
                doc_.fault(place + "/byteStride", fmt::format("{} is not a multiple of 4", stride));
            if (stride > get_uint(view, "byteLength", 0))
                doc_.fault(place + "/byteStride", fmt::format("{} is more than the view's byteLength", stride));
            if (get_uint(view, "target", 34962) == 34963)
                doc_.fault(place + "/byteStride", "belongs to vertices only, and the view is for indices");
        }
    }

    void check_accessor(std::size_t i)
    {
        const Json& accessor = doc_.json["accessors"][i];
        const std::string place = fmt::format("/accessors/{}", i);
        const int view = get_index(accessor, "bufferView");
        const std::uint64_t offset = get_uint(accessor, "byteOffset", 0), component = component_of(accessor);
        if (view < 0 && accessor.contains("byteOffset"))
            doc_.fault(place + "/byteOffset", "needs a bufferView");
        if (accessor.value("normalized", false) && component == 4)
            doc_.fault(place + "/normalized", "is for integers of 8 and 16 bits only; without effect on floats");
        if (offset % component != 0)
            doc_.fault(place + "/byteOffset", fmt::format("{} is not a multiple of the component's {} bytes", offset, component));
        else if (view >= 0 &&
                 (offset + get_uint(doc_.json["bufferViews"][static_cast<std::size_t>(view)], "byteOffset", 0)) % component != 0)
            doc_.fault(place, fmt::format("its place in the buffer is not a multiple of the component's {} bytes", component));
        if (get_string(accessor, "type").compare(0, 3, "MAT") == 0 && offset % 4 != 0)
            doc_.fault(place + "/byteOffset", "of matrices must be a multiple of 4");
        const auto shape = element_shape(get_string(accessor, "type"));
        for (const char* key : {"min", "max"})
            if (accessor.contains(key) && accessor[key].size() != static_cast<std::size_t>(shape.rows * shape.columns))
                doc_.fault(place + "/" + key, fmt::format("has {} numbers, not {}", accessor[key].size(), shape.rows * shape.columns));
        if (const auto sparse = accessor.find("sparse"); sparse != accessor.end())
            for (const char* part : {"indices", "values"})
                check_sparse(*sparse, part, part[0] == 'i' ? component_of((*sparse)["indices"]) : component, place);
    }

    void check_sparse(const Json& sparse, const char* part, std::uint64_t component, const std::string& place)
    {
        const Json& view = doc_.json["bufferViews"][sparse[part]["bufferView"].get<std::size_t>()];
        const std::string here = fmt::format("{}/sparse/{}", place, part);
        if ((get_uint(sparse[part], "byteOffset", 0) + get_uint(view, "byteOffset", 0)) % component != 0)
            doc_.fault(here + "/byteOffset", fmt::format("is not a multiple of the component's {} bytes", component));
        if (view.contains("target"))
            doc_.fault(here + "/bufferView", "has a target, which sparse data has not");
        if (view.contains("byteStride"))
            doc_.fault(here + "/bufferView", "has a byteStride, which sparse data has not");
        mark_view(get_index(sparse[part], "bufferView"), kOtherData, here + "/bufferView");
    }

    // Records an accessor's use. `view_use`: the use of its buffer view, where different.
    void use_accessor(int accessor, const char* use, const std::string& place, const char* view_use = nullptr)
    {
        std::string& known = accessor_use_[static_cast<std::size_t>(accessor)];
        if (!known.empty() && known != use)
            doc_.fault(place, fmt::format("accessor {} is used for {} and for {}", accessor, known, use));
        known = use;
        if (const int view = get_index(doc_.json["accessors"][static_cast<std::size_t>(accessor)], "bufferView"); view >= 0)
            use_view(view, view_use ? view_use : use, place);
    }

    void mark_view(int view, const char* use, const std::string& place)
    {
        std::string& known = view_use_[static_cast<std::size_t>(view)];
        if (!known.empty() && known != use)
            doc_.fault(place, fmt::format("buffer view {} is used for {} and for {}", view, known, use));
        known = use;
    }

    void use_view(int view, const char* use, const std::string& place)
    {
        const Json& json = doc_.json["bufferViews"][static_cast<std::size_t>(view)];
        mark_view(view, use, place);
        if (const std::uint64_t target = get_uint(json, "target", 0); target != 0) {
            const char* said = target == 34962 ? "vertices" : "indices";
            if (std::string_view(use) != said)
                doc_.fault(fmt::format("/bufferViews/{}/target", view), fmt::format("says {}, and it is used for {}", said, use));
        }
        if (json.contains("byteStride") && std::string_view(use) != "vertices")
            doc_.fault(fmt::format("/bufferViews/{}/byteStride", view), fmt::format("belongs to vertices only, not to {}", use));
    }

    void check_primitive(const Json& primitive, const std::string& place)
    {
        const bool compressed = get_extension(primitive, "KHR_draco_mesh_compression") != nullptr;
        std::map<std::string, std::set<int>> sets;
        for (const auto& [name, index] : primitive["attributes"].items()) {
            check_attribute(kSemantics, name, index.get<int>(), place + "/attributes/" + printable(name), compressed);
            check_count(primitive, index.get<std::size_t>(), place + "/attributes/" + printable(name));
            if (const Attribute a = split_name(name); a.number >= 0)
                sets[a.base].insert(a.number);
        }
        for (const auto& [base, numbers] : sets)
            if (base[0] != '_' && *numbers.rbegin() + 1 != static_cast<int>(numbers.size()))
                doc_.fault(place + "/attributes", printable(base) + " does not count from 0 without gaps");
        if (sets["JOINTS"].size() != sets["WEIGHTS"].size())
            doc_.fault(place + "/attributes", "has not as many JOINTS as WEIGHTS");
        for (std::size_t t = 0; primitive.contains("targets") && t < primitive["targets"].size(); ++t)
            for (const auto& [name, index] : primitive["targets"][t].items())
                check_attribute(kTargetSemantics, name, index.get<int>(), fmt::format("{}/targets/{}/{}", place, t, printable(name)),
                                false);
        if (const int indices = get_index(primitive, "indices"); indices >= 0 && !compressed) {
            use_accessor(indices, "indices", place + "/indices");
            if (doc_.json["accessors"][static_cast<std::size_t>(indices)].value("normalized", false))
                doc_.fault(place + "/indices", "are normalized, which indices are not; used as they are");
        }
    }

    // Checks the counts of attributes that are not drawn. A wrong count in a drawn attribute is an error elsewhere.
    void check_count(const Json& primitive, std::size_t index, const std::string& place)
    {
        const auto count = [&](std::size_t i) { return get_uint(doc_.json["accessors"][i], "count", 0); };
        const int positions = get_index(primitive["attributes"], "POSITION");
        if (positions >= 0 && count(index) != count(static_cast<std::size_t>(positions)))
            doc_.fault(place, fmt::format("has {} elements, and POSITION {}", count(index), count(static_cast<std::size_t>(positions))));
    }

    void check_attribute(std::span<const Semantic> semantics, const std::string& name, int index, const std::string& place, bool compressed)
    {
        const Json& accessor = doc_.json["accessors"][static_cast<std::size_t>(index)];
        if (!compressed)
            use_accessor(index, "vertices", place);
        if (name.empty() || name[0] != '_') { // applications may choose such names
            const Attribute a = split_name(name);
            const Semantic* known = nullptr;
            for (const Semantic& s : semantics)
                if (s.name == a.base && s.numbered == (a.number >= 0))
                    known = &s;
            if (!known)
                doc_.fault(place, "is no attribute of glTF; left out");
            else if (!has_word(known->formats, format_of(accessor)) && !(quantized_ && has_word(known->quantized, format_of(accessor))))
                doc_.fault(place,
                           fmt::format("accessor {} has the format {}, which this attribute cannot have", index, format_of(accessor)));
        }
        if (name == "POSITION" && !(accessor.contains("min") && accessor.contains("max")))
            doc_.fault(place, fmt::format("accessor {} has no min and max", index));
        check_vertex_layout(accessor, index, place);
    }

    // Checks that vertex data starts at multiples of 4 bytes, and that accessors on one view have a stride.
    void check_vertex_layout(const Json& accessor, int index, const std::string& place)
    {
        const int view = get_index(accessor, "bufferView");
        if (view < 0)
            return;
        const Json& json = doc_.json["bufferViews"][static_cast<std::size_t>(view)];
        const std::uint64_t element =
            element_bytes(static_cast<ComponentType>(get_index(accessor, "componentType")), element_shape(get_string(accessor, "type")));
        const std::uint64_t offset = get_uint(accessor, "byteOffset", 0), start = offset + get_uint(json, "byteOffset", 0);
        if (start % 4 != 0 || (!json.contains("byteStride") && element % 4 != 0))
            doc_.fault(place, fmt::format("accessor {}: vertex data is not aligned to 4 bytes", index));
        int& first = vertex_accessor_of_view_[static_cast<std::size_t>(view)];
        if (first >= 0 && first != index && !json.contains("byteStride"))
            doc_.fault(fmt::format("/bufferViews/{}", view), "has no byteStride, and more than one accessor of vertices uses it");
        first = first < 0 ? index : first;
    }

    Document& doc_;
    std::vector<std::string> view_use_;
    std::vector<int> vertex_accessor_of_view_;
    std::vector<std::string> accessor_use_;
    bool quantized_;
};

} // namespace

void check_accessor_rules(Document& doc)
{
    Rules(doc).run();
}

} // namespace burnish::gltf
