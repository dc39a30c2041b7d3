#include "core/scene/mtlx/document.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <pugixml.hpp>

#include "core/base/text.h"
#include "core/image/colour.h"
#include "core/image/io/stored_colour.h"

namespace burnish::mtlx {
namespace {

using pugi::xml_node;

constexpr int kMostNodes = 16;     // between a surface and a picture
constexpr int kMostVisits = 20000; // of nodes, in a document
constexpr int kMostInputs = 300;   // of a node
constexpr const char* kSurfaces[] = {"standard_surface", "open_pbr_surface", "gltf_pbr"};
constexpr const char* kPictures[] = {"image", "tiledimage", "gltf_image", "gltf_colorimage"};
constexpr const char* kNormalMaps[] = {"normalmap", "gltf_normalmap"};
constexpr const char* kGeometry[] = {"normal", "tangent"}; // of the mesh

template <std::size_t kCount> bool is_one_of(const char* name, const char* const (&list)[kCount])
{
    return std::any_of(list, list + kCount, [&](const char* each) { return std::strcmp(name, each) == 0; });
}

bool is_named(xml_node node, const char* name)
{
    return std::strcmp(node.name(), name) == 0;
}

// Returns an attribute of the element, or of the nearest element around it that has it.
std::string inherited(xml_node node, const char* attribute)
{
    for (; node; node = node.parent())
        if (const pugi::xml_attribute found = node.attribute(attribute))
            return found.value();
    return "";
}

// Returns all prefixes of file names around an element, the outermost first.
std::string file_prefix(xml_node node)
{
    return node ? file_prefix(node.parent()) + node.attribute("fileprefix").value() : "";
}

class Reader {
  public:
    explicit Reader(const std::string& path) : path_(path) {}

    Result<std::vector<SurfaceMaterial>> read(std::string_view text)
    {
        const pugi::xml_parse_result parsed = xml_.load_buffer(text.data(), text.size());
        if (!parsed)
            return Error{ExitCode::bad_input, path_, fmt::format("byte {}", parsed.offset), parsed.description()};
        root_ = xml_.child("materialx");
        if (!root_)
            return fault("", "has no element materialx");
        const std::string version = root_.attribute("version").value();
        if (version != "1.38" && version != "1.39")
            return fault("", fmt::format("is of version \"{}\"; 1.38 and 1.39 are read", printable(version)));
        std::vector<SurfaceMaterial> all;
        for (const xml_node child : root_.children()) {
            if (is_named(child, "xi:include"))
                return fault(place_of(child), "includes are not read");
            if (!is_named(child, "surfacematerial"))
                continue;
            Result<SurfaceMaterial> material = read_material(child);
            BN_TRY(material);
            all.push_back(std::move(*material));
        }
        if (all.empty())
            return fault("", "has no surfacematerial");
        return all;
    }

  private:
    Error fault(std::string place, std::string reason) const { return {ExitCode::bad_input, path_, std::move(place), std::move(reason)}; }

    static std::string place_of(xml_node node)
    {
        const std::string name = node.attribute("name").value();
        return printable(std::string(node.name()) + (name.empty() ? "" : " " + name));
    }

    static xml_node input_of(xml_node node, const char* name)
    {
        return node.find_child(
            [&](xml_node child) { return is_named(child, "input") && name == std::string(child.attribute("name").value()); });
    }

    // Returns the element of this name in a scope. Names within a scope are unique.
    xml_node named(xml_node scope, const std::string& name)
    {
        std::map<std::string, xml_node>& names = scopes_[scope.internal_object()];
        if (names.empty())
            for (const xml_node child : scope.children())
                names.emplace(child.attribute("name").value(), child);
        const auto found = names.find(name);
        return found == names.end() ? xml_node() : found->second;
    }

    // Returns the node of this name beside the element's node, or in the document.
    xml_node find(xml_node element, const char* name)
    {
        const xml_node beside = named(element.parent().parent(), name);
        return beside ? beside : named(root_, name);
    }

    // Returns true where an input is linked to the mesh's own normal or tangent.
    bool is_geometry(xml_node element)
    {
        xml_node from;
        if (const pugi::xml_attribute name = element.attribute("nodename"))
            from = find(element, name.value());
        return from && is_one_of(from.name(), kGeometry);
    }

    Result<SurfaceMaterial> read_material(xml_node node)
    {
        SurfaceMaterial r;
        r.name = node.attribute("name").value();
        const xml_node shader = input_of(node, "surfaceshader");
        const xml_node surface = named(root_, shader.attribute("nodename").value());
        if (!shader || !surface)
            return fault(place_of(node), "has no surface");
        if (!is_one_of(surface.name(), kSurfaces))
            return fault(place_of(surface), "is not read; standard_surface, open_pbr_surface and gltf_pbr are");
        if (std::distance(surface.children().begin(), surface.children().end()) > kMostInputs)
            return fault(place_of(surface), "has too many inputs");
        r.kind = surface.name();
        for (const xml_node child : surface.children("input")) {
            if (!*child.attribute("name").value())
                return fault(place_of(surface), "has an input without a name");
            if (is_geometry(child))
                continue;
            Result<Input> input = resolved(child, 0);
            if (!input) {
                Error error = input.error();
                error.place = fmt::format("{}: {}{}{}", place_of(surface), printable(child.attribute("name").value()),
                                          error.place.empty() ? "" : ": ", error.place);
                return error;
            }
            input->name = child.attribute("name").value();
            r.inputs.push_back(std::move(*input));
        }
        return r;
    }

    // Returns the value of an input element, or what it is connected to.
    Result<Input> resolved(xml_node element, int depth)
    {
        Result<Input> found = Error{};
        if (const pugi::xml_attribute graph = element.attribute("nodegraph")) {
            const xml_node nodes = named(root_, graph.value());
            const std::string wanted = element.attribute("output").value();
            const xml_node output =
                wanted.empty() ? nodes.child("output") : nodes.find_child_by_attribute("output", "name", wanted.c_str());
            if (!output)
                return fault("", fmt::format("nodegraph {} has no such output", printable(graph.value())));
            found = read_node(named(nodes, output.attribute("nodename").value()), output, depth + 1);
        } else if (const pugi::xml_attribute name = element.attribute("nodename"))
            found = read_node(find(element, name.value()), element, depth + 1);
        else if (element.attribute("interfacename"))
            return fault("", "inputs of node graphs are not read");
        else
            found = constant(element);
        const std::string channels = element.attribute("channels").value();
        if (!found || channels.empty() || channels == "rgb" || channels == "xyz")
            return found;
        if (channels.find_first_not_of(channels[0]) != std::string::npos)
            return fault("", fmt::format("channels \"{}\" are not read", printable(channels)));
        return channel_of(std::move(*found), channels[0]);
    }

    // Returns what a node gives. from: the element that names the node.
    Result<Input> read_node(xml_node node, xml_node from, int depth)
    {
        if (depth > kMostNodes || ++visits_ > kMostVisits)
            return fault("", "comes from too many nodes, or from itself");
        if (!node)
            return fault("", fmt::format("there is no node {}", printable(from.attribute("nodename").value())));
        if (std::distance(node.children().begin(), node.children().end()) > kMostInputs)
            return fault(place_of(node), "has too many inputs");
        const std::string output = from.attribute("output").value();
        Result<Input> r = read_known_node(node, depth);
        if (!r && r.error().place.empty()) {
            Error error = r.error();
            error.place = place_of(node);
            return error;
        }
        const bool has_channels = std::strncmp(node.name(), "separate", 8) == 0 || output == "outa";
        if (r && has_channels && output.size() == 4 && output.starts_with("out"))
            return channel_of(std::move(*r), output[3]);
        return r;
    }

    Result<Input> read_known_node(xml_node node, int depth)
    {
        if (is_one_of(node.name(), kPictures))
            return read_picture(node);
        if (is_one_of(node.name(), kNormalMaps))
            return read_normal_map(node, depth);
        if (is_named(node, "constant"))
            return resolved(input_of(node, "value"), depth);
        if (is_named(node, "multiply"))
            return read_product(node, depth);
        const bool separates = std::strncmp(node.name(), "separate", 8) == 0;
        if (!separates && !is_named(node, "extract") && !is_named(node, "swizzle"))
            return fault("", "such nodes are not read");
        Result<Input> of = resolved(input_of(node, "in"), depth);
        BN_TRY(of);
        if (is_named(node, "extract")) {
            const Result<Input> index = input_of(node, "index") ? resolved(input_of(node, "index"), depth) : Result<Input>(Input());
            BN_TRY(index);
            if (index->picture)
                return fault("", "its index is a picture");
            return channel_of(std::move(*of), "xyzw"[static_cast<int>(std::clamp(index->value.x, 0.0f, 3.0f))]);
        }
        const std::string channels = input_of(node, "channels").attribute("value").value();
        if (is_named(node, "swizzle") && channels.size() != 1)
            return fault("", "gives more than one channel");
        return separates ? of : channel_of(std::move(*of), channels[0]);
    }

    Result<Input> channel_of(Input input, char name) const
    {
        constexpr const char *kColour = "rgba", *kVector = "xyzw";
        const char* found = std::strchr(kColour, name);
        const char* const vector = std::strchr(kVector, name);
        if (!name || (!found && !vector))
            return fault("", "gives no channel");
        const int channel = static_cast<int>(found ? found - kColour : vector - kVector);
        if (input.picture)
            input.picture->channel = channel, input.picture->one_channel = true,
            input.picture->factor = glm::vec4(input.picture->factor[channel]);
        else
            input.value = glm::vec3(channel == 3 ? input.alpha : input.value[channel]);
        return input;
    }

    Result<Input> read_product(xml_node node, int depth)
    {
        Result<Input> a = resolved(input_of(node, "in1"), depth), b = resolved(input_of(node, "in2"), depth);
        BN_TRY(a);
        BN_TRY(b);
        if (a->picture && b->picture)
            return fault("", "multiplies two pictures");
        Input& picture = a->picture ? *a : *b;
        const Input& constant = a->picture ? *b : *a;
        const glm::vec3 factor = constant.value;
        const bool even = factor.x == factor.y && factor.y == factor.z;
        if (picture.picture)
            picture.picture->factor *= glm::vec4(factor, even && constant.alpha == 1.0f ? factor.x : constant.alpha);
        else
            picture.value *= factor;
        const glm::vec4 made = picture.picture ? picture.picture->factor : glm::vec4(picture.value, 1.0f);
        for (int c = 0; c < 4; ++c)
            if (!std::isfinite(made[c]))
                return fault("", "makes no finite number");
        return picture;
    }

    Result<Input> read_normal_map(xml_node node, int depth)
    {
        const bool own = is_named(node, "gltf_normalmap");
        Result<Input> r = own ? read_picture(node) : resolved(input_of(node, "in"), depth);
        BN_TRY(r);
        if (!r->picture)
            return fault("", "has no picture");
        for (const char* const name : {"space", "normal", "tangent"})
            if (const xml_node input = input_of(node, name); input && std::string(input.attribute("value").value()) != "tangent")
                return fault("", fmt::format("its {} is not read", name));
        const xml_node scale = input_of(node, own ? "normal_scale" : "scale");
        r->picture->normal_scale = 1.0f;
        if (scale) {
            const Result<Input> value = resolved(scale, depth);
            BN_TRY(value);
            if (value->picture)
                return fault("", "its scale is a picture");
            r->picture->normal_scale = value->value.x;
        }
        return r;
    }

    Result<Input> read_picture(xml_node node)
    {
        const xml_node file = input_of(node, "file");
        Input r;
        r.picture.emplace();
        PictureInput& picture = *r.picture;
        if (const char* const name = file.attribute("value").value(); *name)
            picture.file = file_prefix(file) + name;
        else
            return fault("", "names no file");
        if (const std::string type = node.attribute("type").value(); type.starts_with("color") || is_named(node, "gltf_colorimage")) {
            const std::string space = inherited(file, "colorspace");
            picture.encoded = space == "srgb_texture";
            if (!picture.encoded && !space.empty() && space != "lin_rec709" && space != "none" && space != "raw")
                return fault("", fmt::format("colours of {} are not read", printable(space)));
        }
        for (const bool up : {false, true}) {
            const std::string mode = input_of(node, up ? "vaddressmode" : "uaddressmode").attribute("value").value();
            WrapMode& wrap = up ? picture.wrap_t : picture.wrap_s;
            if (mode == "clamp")
                wrap = WrapMode::clamp;
            else if (mode == "mirror")
                wrap = WrapMode::mirror;
            else if (!mode.empty() && mode != "periodic")
                return fault("", fmt::format("its address mode {} is not read", printable(mode)));
        }
        picture.nearest = std::string(input_of(node, "filtertype").attribute("value").value()) == "closest";
        for (const char* const name : {"texcoord", "rotate", "realworldimagesize", "realworldtilesize", "operationorder"})
            if (const xml_node input = input_of(node, name); input && !is_default(input, name))
                return fault("", fmt::format("its {} is not read", name));
        const bool gltf = std::strncmp(node.name(), "gltf", 4) == 0;
        BN_TRY(gltf ? place_as_gltf(node, picture) : place_as_tiles(node, picture));
        if (gltf)
            BN_TRY(put_factors(node, picture));
        return r;
    }

    // MaterialX 1.38, node tiledimage: coordinates * tiling - offset, v up.
    Status place_as_tiles(xml_node node, PictureInput& picture) const
    {
        glm::vec2 tiling(1.0f), offset(0.0f);
        BN_TRY(put_pair(input_of(node, "uvtiling"), tiling));
        BN_TRY(put_pair(input_of(node, "uvoffset"), offset));
        picture.scale = tiling;
        picture.offset = glm::vec2(-offset.x, 1.0f - tiling.y + offset.y);
        return {};
    }

    // The nodes of gltf_pbr: KHR_texture_transform about the default pivot.
    Status place_as_gltf(xml_node node, PictureInput& picture) const
    {
        glm::vec2 pivot(0.0f, 1.0f);
        BN_TRY(put_pair(input_of(node, "pivot"), pivot));
        if (pivot != glm::vec2(0.0f, 1.0f))
            return fault("", "its pivot is not read");
        BN_TRY(put_pair(input_of(node, "scale"), picture.scale));
        BN_TRY(put_pair(input_of(node, "offset"), picture.offset));
        return {};
    }

    // Multiplies by the factors of gltf_image and gltf_colorimage.
    Status put_factors(xml_node node, PictureInput& picture)
    {
        for (const char* const name : {"factor", "color", "geomcolor"}) {
            const xml_node input = input_of(node, name);
            if (!input)
                continue;
            const Result<Input> value = resolved(input, kMostNodes - 1);
            BN_TRY(value);
            if (value->picture)
                return fault("", fmt::format("its {} is a picture", name));
            const bool number = std::string(input.attribute("type").value()) == "float";
            picture.factor *= glm::vec4(value->value, number ? value->value.x : value->alpha);
        }
        return {};
    }

    // Returns true where an input has no effect: the first texture coordinates, sizes of 1, no rotation.
    bool is_default(xml_node input, const std::string& name)
    {
        if (name == "texcoord") {
            const xml_node from = find(input, input.attribute("nodename").value());
            return is_named(from, "texcoord") && input_of(from, "index").attribute("value").as_int() == 0;
        }
        const Result<Input> value = constant(input);
        const float neutral = name.starts_with("real") || name.starts_with("op") ? 1.0f : 0.0f;
        return value && value->value.x == neutral && value->value.y == neutral;
    }

    Status put_pair(xml_node input, glm::vec2& to) const
    {
        if (!input)
            return {};
        if (input.attribute("nodename") || input.attribute("nodegraph"))
            return fault("", "its place comes from a node");
        const Result<Input> value = constant(input);
        BN_TRY(value);
        to = glm::vec2(value->value);
        return {};
    }

    // Reads one to four numbers, "true" or "false".
    Result<Input> constant(xml_node element) const
    {
        Input r;
        const std::string text = element.attribute("value").value(), type = element.attribute("type").value();
        if (!element)
            return fault("", "lacks an input");
        if (type == "string" || type == "filename" || type.find("shader") != std::string::npos)
            return r;
        if (text == "true" || text == "false") {
            r.value = glm::vec3(text == "true" ? 1.0f : 0.0f);
            return r;
        }
        int count = 0;
        std::string_view rest = text;
        while (!rest.empty() && count < 4) {
            const std::size_t comma = rest.find(',');
            const std::optional<double> number = number_of(rest.substr(0, comma));
            if (!number || !std::isfinite(static_cast<float>(*number)))
                return fault("", fmt::format("\"{}\" is no number", printable(text)));
            (count < 3 ? r.value[count] : r.alpha) = static_cast<float>(*number);
            ++count;
            rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
        }
        if (count == 0)
            return fault("", "has no value");
        if (count == 1)
            r.value = glm::vec3(r.value.x);
        if (type == "color3" || type == "color4")
            BN_TRY(to_rec709(inherited(element, "colorspace"), r.value));
        return r;
    }

    static std::optional<double> number_of(std::string_view text)
    {
        const std::size_t begin = text.find_first_not_of(" \t\r\n");
        if (begin == std::string_view::npos)
            return std::nullopt;
        text = text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
        double value = 0.0;
        const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
        return failed == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
    }

    Status to_rec709(const std::string& space, glm::vec3& colour) const
    {
        if (space.empty() || space == "lin_rec709" || space == "none" || space == "raw")
            return {};
        if (space == "srgb_texture") {
            for (int i = 0; i < 3; ++i)
                colour[i] = srgb_to_linear(std::clamp(colour[i], 0.0f, 1.0f));
            return {};
        }
        if (space != "acescg" && space != "lin_ap1")
            return fault("", fmt::format("colours of {} are not read", printable(space)));
        constexpr Primaries kAp1 = {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767};
        const std::array<double, 9> m = *matrix_to_rec709(kAp1);
        const glm::dvec3 c = colour;
        for (std::size_t i = 0; i < 3; ++i)
            colour[static_cast<int>(i)] =
                static_cast<float>(std::clamp(m[3 * i] * c.x + m[3 * i + 1] * c.y + m[3 * i + 2] * c.z, 0.0, 3e38));
        return {};
    }

    const std::string& path_;
    pugi::xml_document xml_;
    xml_node root_;
    std::map<const void*, std::map<std::string, xml_node>> scopes_; // names in elements that were asked
    int visits_ = 0;
};

} // namespace

Result<std::vector<SurfaceMaterial>> read_document(std::string_view text, const std::string& path)
{
    return Reader(path).read(text);
}

} // namespace burnish::mtlx
