#include "raster/session/c_options.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include "raster/frame/comma_numbers.h"
#include "raster/frame/layers.h"

namespace burnish {
namespace {

Error wrong(const std::string& reason)
{
    return Error{ExitCode::usage, "", "", reason};
}

// Reads `count` numbers with commas between.
Result<std::vector<float>> numbers_of(const std::string& text, std::size_t count)
{
    const std::optional<std::vector<float>> numbers = comma_numbers(text);
    if (!numbers)
        return wrong("'" + text + "' is no number");
    if (numbers->size() != count)
        return wrong("'" + text + "' has " + std::to_string(numbers->size()) + " numbers, not " + std::to_string(count));
    return *numbers;
}

Status put(const std::string& text, float& to)
{
    const Result<std::vector<float>> numbers = numbers_of(text, 1);
    BN_TRY(numbers);
    to = (*numbers)[0];
    return {};
}

Status put(const std::string& text, int& to)
{
    const auto [next, failed] = std::from_chars(text.data(), text.data() + text.size(), to);
    return failed == std::errc() && next == text.data() + text.size() ? Status() : Status(wrong("'" + text + "' is no whole number"));
}

// Reads a whole number from `least` to `most`.
Status put_within(const std::string& text, int& to, int least, int most)
{
    int value = 0;
    BN_TRY(put(text, value));
    if (value < least || value > most)
        return wrong("'" + text + "' does not lie in " + std::to_string(least) + ".." + std::to_string(most));
    to = value;
    return {};
}

Status put(const std::string& text, bool& to)
{
    if (text != "true" && text != "false" && text != "1" && text != "0")
        return wrong("'" + text + "' is neither true nor false");
    to = text == "true" || text == "1";
    return {};
}

template <int n> Status put_vector(const std::string& text, glm::vec<n, float>& to)
{
    const Result<std::vector<float>> numbers = numbers_of(text, n);
    BN_TRY(numbers);
    for (int i = 0; i < n; ++i)
        to[i] = (*numbers)[static_cast<std::size_t>(i)];
    return {};
}
Status put(const std::string& text, glm::vec2& to)
{
    return put_vector<2>(text, to);
}
Status put(const std::string& text, glm::vec3& to)
{
    return put_vector<3>(text, to);
}
Status put(const std::string& text, glm::vec4& to)
{
    return put_vector<4>(text, to);
}
template <class T> Status put(const std::string& text, std::optional<T>& to)
{
    return put(text, to.emplace());
}

std::vector<std::string> words_of(const std::string& text)
{
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

Status set_floor(CSettings& to, const std::string& text)
{
    const std::pair<const char*, FloorKind> kinds[] = {{"off", FloorKind::off}, {"shadow", FloorKind::shadow}, {"stage", FloorKind::stage}};
    for (const auto& [name, kind] : kinds)
        if (text == name) {
            to.floor.kind = kind;
            return {};
        }
    return wrong("'" + text + "' is none of off, shadow, stage");
}

Status set_mode(CSettings& to, const std::string& text)
{
    const std::pair<const char*, ReferenceMode> modes[] = {
        {"direct", ReferenceMode::direct}, {"shadowed", ReferenceMode::shadowed}, {"path", ReferenceMode::path}};
    for (const auto& [name, mode] : modes)
        if (text == name) {
            to.reference.mode = mode;
            return {};
        }
    return wrong("'" + text + "' is none of direct, shadowed, path");
}

Status set_layers(CSettings& to, const std::string& text)
{
    for (const std::string& word : words_of(text)) {
        if (std::none_of(layers().begin(), layers().end(), [&](const LayerInfo& layer) { return layer.name == word; }))
            return wrong("'" + word + "' is no layer");
        to.layers.push_back(word);
    }
    return {};
}

} // namespace

const std::vector<COption>& c_options()
{
    static const std::vector<COption> table = [] {
        std::vector<COption> list = {
            {"width", "Pixels", [](CSettings& to, const std::string& v) { return put(v, to.desc.width); }},
            {"height", "Pixels", [](CSettings& to, const std::string& v) { return put(v, to.desc.height); }},
            {"msaa", "Samples a pixel: 1, 2, 4, 8 or 16", [](CSettings& to, const std::string& v) { return put(v, to.desc.msaa); }},
            {"technique", "Technique for light from the environment",
             [](CSettings& to, const std::string& v) {
                 to.desc.technique = v;
                 return Status();
             }},
            {"samples", "Samples of the technique, or samples a pixel of the reference",
             [](CSettings& to, const std::string& v) {
                 to.samples_given = true;
                 return put_within(v, to.desc.samples, 1, 0x7fffffff);
             }},
            {"roughness", "Overrides the roughness of every material, 0 to 1",
             [](CSettings& to, const std::string& v) { return put(v, to.desc.roughness); }},
            {"anisotropy", "Overrides the anisotropy of every material, -1 to 1",
             [](CSettings& to, const std::string& v) {
                 to.desc.override_anisotropy = true;
                 return put(v, to.desc.anisotropy);
             }},
            {"background", "Draws the environment behind the scene",
             [](CSettings& to, const std::string& v) { return put(v, to.desc.background); }},
            {"texture_anisotropy", "Texture taps at most, 1 to 16",
             [](CSettings& to, const std::string& v) { return put(v, to.desc.texture_anisotropy); }},
            {"eye", "Camera position X,Y,Z, metres", [](CSettings& to, const std::string& v) { return put(v, to.eye); }},
            {"target", "Point that the camera looks at", [](CSettings& to, const std::string& v) { return put(v, to.target); }},
            {"orbit", "View of the whole scene from AZIMUTH,ELEVATION degrees",
             [](CSettings& to, const std::string& v) { return put(v, to.orbit_deg); }},
            {"fov", "Vertical field of view in degrees", [](CSettings& to, const std::string& v) { return put(v, to.fov_deg); }},
            {"camera", "Camera of the scene, by index",
             [](CSettings& to, const std::string& v) { return put_within(v, to.camera, 0, 0x7fffffff); }},
            {"layers", "Layers of the picture, with commas between: depth, normal, albedo, ...", set_layers},
            {"reference_mode", "Paths of the reference: direct, shadowed or path", set_mode},
            {"bounces", "Bounces of the reference in mode path",
             [](CSettings& to, const std::string& v) { return put_within(v, to.reference.bounces, 0, 1000); }},
            {"threads", "Worker threads; 0: all cores",
             [](CSettings& to, const std::string& v) { return put_within(v, to.open.threads, 0, 1024); }},
            {"floor", "Floor below the scene: off, shadow or stage", set_floor},
            {"env_size", "Texels along an edge of the environment's cube map",
             [](CSettings& to, const std::string& v) { return put_within(v, to.open.environment.cube_size, 16, 2048); }},
            {"env_samples", "Samples a texel of the prefiltered environment",
             [](CSettings& to, const std::string& v) { return put_within(v, to.open.environment.samples, 1, 1 << 20); }},
            {"env_rotation", "Rotation of the environment in degrees",
             [](CSettings& to, const std::string& v) { return put(v, to.open.environment.rotation_deg); }},
            {"env_exposure", "Exposure of the environment in stops",
             [](CSettings& to, const std::string& v) { return put(v, to.open.environment.exposure_ev); }},
            {"cache", "Keeps bakes in the cache",
             [](CSettings& to, const std::string& v) { return put(v, to.open.environment.use_cache); }},
        };
        for (const ParameterInfo& p : parameters()) {
            std::string help = p.summary;
            if (const std::size_t at = help.find("{}"); at != std::string::npos) {
                std::string names;
                for (const std::string& name : choices_of(p))
                    names += (names.empty() ? "" : ", ") + name;
                help.replace(at, 2, names);
            }
            list.push_back({c_name(p.option), help, nullptr});
        }
        for (COption& option : list)
            option.help = c_words(option.help);
        return list;
    }();
    return table;
}

const std::vector<std::string>& c_material_options()
{
    static const std::vector<std::string> names = {
#define BN_FACTOR(kind, name, fallback, path, least, most) #name,
#define BN_FLAG(kind, name, path) #name,
#include "core/scene/material.def"
    };
    return names;
}

const std::vector<std::string>& c_light_options()
{
    static const std::vector<std::string> names = {
#define BN_LIGHT_FACTOR(kind, name, fallback, path, least, most) #name,
#include "core/scene/light.def"
    };
    return names;
}

std::string c_name(const std::string& name)
{
    std::string out = name;
    std::replace(out.begin(), out.end(), '-', '_');
    return out;
}

std::string c_words(const std::string& text)
{
    std::string out = text;
    for (const std::string_view type : {"FrameDesc::", "SessionOptions::", "OpenOptions::", "EnvironmentOptions::"})
        for (std::size_t at = out.find(type); at != std::string::npos; at = out.find(type, at)) {
            out.erase(at, type.size());
            std::size_t end = at;
            while (end < out.size() && (std::isalnum(static_cast<unsigned char>(out[end])) || out[end] == '_'))
                ++end;
            for (const ParameterInfo& p : parameters())
                if (out.compare(at, end - at, p.name) == 0) {
                    out.replace(at, end - at, c_name(p.option));
                    break;
                }
        }
    return out;
}

Result<CSettings> settings_of(const burnish_options* options)
{
    CSettings settings;
    settings.desc.samples = automatic_technique().default_samples;
    settings.open.environment.quiet = true;
    if (!options)
        return settings;
    for (const COption& option : c_options()) {
        const auto at = options->values.find(option.name);
        if (at == options->values.end())
            continue;
        Status set;
        if (option.set)
            set = option.set(settings, at->second);
        else
            for (const ParameterInfo& p : parameters())
                if (c_name(p.option) == option.name)
                    set = set_parameter(settings.desc, p.option, at->second);
        if (!set)
            return Error{ExitCode::usage, "", option.name, set.error().reason};
    }
    if (const TechniqueInfo* technique = find_technique(settings.desc.technique); technique && !settings.samples_given)
        settings.desc.samples = technique->default_samples;
    settings.floor.threads = settings.open.threads, settings.floor.use_cache = settings.open.environment.use_cache;
    return settings;
}

Status set_material(Material& to, const burnish_options* options)
{
    if (!options)
        return {};
    for (const auto& [name, value] : options->values) {
        Status set = wrong("is no option of materials");
#define BN_FACTOR(kind, factor, fallback, path, least, most)                                                                               \
    if (name == #factor)                                                                                                                   \
        set = put(value, to.factor);
#define BN_FLAG(kind, flag, path)                                                                                                          \
    if (name == #flag)                                                                                                                     \
        set = put(value, to.flag);
#include "core/scene/material.def"
        if (!set)
            return Error{ExitCode::usage, "", name, set.error().reason};
    }
    return {};
}

Status set_light(Light& to, const burnish_options* options)
{
    if (!options)
        return {};
    for (const auto& [name, value] : options->values) {
        Status set = wrong("is no option of lights");
#define BN_LIGHT_FACTOR(kind, factor, fallback, path, least, most)                                                                         \
    if (name == #factor)                                                                                                                   \
        set = put(value, to.factor);
#include "core/scene/light.def"
        if (!set)
            return Error{ExitCode::usage, "", name, set.error().reason};
    }
    return {};
}

Result<View> view_of(const CSettings& settings, const Session& session)
{
    constexpr float kUsualFov = 45.0f;
    const int width = settings.desc.width, height = settings.desc.height;
    if (width < 1 || height < 1)
        return Error{ExitCode::usage, "", width < 1 ? "width" : "height", "is below 1"};
    const float fov_rad = glm::radians(settings.fov_deg.value_or(kUsualFov));
    if (!(fov_rad > 0.0f && fov_rad < 3.1f))
        return Error{ExitCode::usage, "", "fov", "is no angle of view"};
    const glm::vec3 origin(session.scene().origin);
    if (settings.eye) {
        const glm::vec3 middle = 0.5f * (session.tables().bounds_min + session.tables().bounds_max);
        const glm::vec3 target = settings.target ? *settings.target - origin : middle;
        if (*settings.eye - origin == target)
            return Error{ExitCode::usage, "", "eye", "is the target"};
        return make_view(*settings.eye - origin, target, fov_rad, width, height);
    }
    int camera = settings.camera;
    if (camera < 0 && !settings.orbit_deg)
        for (const Node& node : session.scene().nodes)
            if (node.camera != kNone && (camera < 0 || node.camera < camera))
                camera = node.camera;
    if (camera >= 0 && !settings.orbit_deg)
        return make_view(session.scene(), camera, width, height);
    Framing framing;
    framing.fov_y_rad = fov_rad;
    if (settings.orbit_deg)
        framing.azimuth_rad = glm::radians(settings.orbit_deg->x), framing.elevation_rad = glm::radians(settings.orbit_deg->y);
    return session.framed(width, height, framing);
}

} // namespace burnish
