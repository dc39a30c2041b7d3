// Options of the C interface: their checks, the settings that they make, and the view.
#include "raster/session/c_options.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "raster/session/c_values.h"

namespace burnish {
namespace {

// Reads a factor's value within its range.
Status put(const std::string& text, float& to, double least, double most)
{
    return put_within(text, to, least, most);
}
template <int n> Status put(const std::string& text, glm::vec<n, float>& to, double least, double most)
{
    return put_within(text, to, least, most);
}

Status put_factor(Material& to, const std::string& name, const std::string& value)
{
#define BN_FACTOR(kind, factor, fallback, path, least, most)                                                                               \
    if (name == #factor)                                                                                                                   \
        return put(value, to.factor, least, most);
#define BN_FLAG(kind, flag, path)                                                                                                          \
    if (name == #flag)                                                                                                                     \
        return put_flag(value, to.flag);
#include "core/scene/material.def"
    return wrong_value("is no option of materials");
}

Status put_factor(Light& to, const std::string& name, const std::string& value)
{
    if (name == "range" && put(value, to.range, 0.0, 0.0)) // unlimited
        return {};
#define BN_LIGHT_FACTOR(kind, factor, fallback, path, least, most)                                                                         \
    if (name == #factor)                                                                                                                   \
        return put(value, to.factor, least, most);
#include "core/scene/light.def"
    return wrong_value("is no option of lights");
}

template <class Of> Status set_factors(Of& to, const burnish_options* options)
{
    if (options)
        for (const auto& [name, value] : options->values)
            if (const Status set = put_factor(to, name, value); !set)
                return Error{ExitCode::usage, "", name, set.error().reason};
    return {};
}

bool in_list(const std::vector<std::string>& list, const std::string& name)
{
    return std::find(list.begin(), list.end(), name) != list.end();
}

const COption* find_option(const std::string& name)
{
    const auto at = std::find_if(c_options().begin(), c_options().end(), [&](const COption& option) { return option.name == name; });
    return at == c_options().end() ? nullptr : &*at;
}

// Refuses views that are chosen twice.
Status check_view(const CSettings& settings)
{
    const auto refuse = [](const char* name, const char* reason) { return Error{ExitCode::usage, "", name, reason}; };
    if (!settings.camera.empty() && (settings.eye || settings.orbit_deg))
        return refuse(settings.eye ? "eye" : "orbit", "cannot be combined with camera");
    if (settings.eye && settings.orbit_deg)
        return refuse("orbit", "cannot be combined with eye");
    if (settings.eye && settings.target && *settings.eye == *settings.target)
        return refuse("target", "is the same point as eye");
    return {};
}

} // namespace

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
    static const std::pair<const char*, const char*> fields[] = {{"EnvironmentOptions::cube_size", "env_size"},
                                                                 {"EnvironmentOptions::exposure_ev", "env_exposure"},
                                                                 {"EnvironmentOptions::extracted_lights", "key_lights"},
                                                                 {"EnvironmentOptions::rotation_deg", "env_rotation"},
                                                                 {"EnvironmentOptions::samples", "env_samples"},
                                                                 {"MipSettings::filter", "mip_filter"},
                                                                 {"MipSettings::kappa", "mip_kappa"},
                                                                 {"MipSettings::gains", "mip_gain"},
                                                                 {"Moment::animation", "animation"},
                                                                 {"Moment::seconds", "time"},
                                                                 {"Moment::variant", "variant"},
                                                                 {"FloorSettings::kind", "floor"},
                                                                 {"ShadowSettings::of", "shadows"},
                                                                 {"ShadowSettings::samples", "shadow_samples"}};
    std::string out = text;
    for (const auto& [field, option] : fields)
        for (std::size_t at = out.find(field); at != std::string::npos; at = out.find(field, at))
            out.replace(at, std::string_view(field).size(), option);
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

Status check_option(const std::string& name, const std::string& value)
{
    Status checked = wrong_value("is no option");
    if (const COption* option = find_option(name)) {
        CSettings settings;
        checked = option->set(settings, value);
    }
    if (Material material; !checked && in_list(c_material_options(), name))
        checked = put_factor(material, name, value);
    if (Light light; !checked && in_list(c_light_options(), name))
        checked = put_factor(light, name, value);
    return checked;
}

Result<CSettings> settings_of(const burnish_options* options, unsigned call)
{
    CSettings settings;
    settings.desc.samples = automatic_technique().default_samples;
    settings.open.environment.quiet = true;
    if (!options)
        return settings;
    for (const auto& [name, value] : options->values)
        if (!find_option(name))
            return Error{ExitCode::usage, "", name, in_list(c_material_options(), name) ? "belongs to materials" : "belongs to lights"};
    for (const COption& option : c_options()) {
        const auto at = options->values.find(option.name);
        if (at == options->values.end() || !(option.calls & call))
            continue;
        if (const Status set = option.set(settings, at->second); !set)
            return Error{ExitCode::usage, "", option.name, set.error().reason};
    }
    BN_TRY(check_view(settings));
    if (const TechniqueInfo* technique = find_technique(settings.desc.technique); technique)
        settings.desc.samples = settings.samples.value_or(technique->default_samples);
    settings.floor.threads = settings.mips.threads = settings.open.threads;
    settings.floor.use_cache = settings.mips.use_cache = settings.open.environment.use_cache;
    return settings;
}

Status set_material(Material& to, const burnish_options* options)
{
    return set_factors(to, options);
}

Status set_light(Light& to, const burnish_options* options)
{
    return set_factors(to, options);
}

namespace {

bool is_placed(const Scene& scene, int camera)
{
    return std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const Node& node) { return node.camera == camera; });
}

// Returns the index of a camera by name or index. An empty text means the first camera that a node places. Returns kNone where there is
// none.
Result<int> find_camera(const Scene& scene, const std::string& wanted)
{
    const int count = static_cast<int>(scene.cameras.size());
    if (wanted.empty()) {
        for (int camera = 0; camera < count; ++camera)
            if (is_placed(scene, camera))
                return camera;
        return int{kNone};
    }
    int found = kNone;
    for (int i = 0; i < count && found == kNone; ++i)
        if (scene.cameras[static_cast<std::size_t>(i)].name == wanted)
            found = i;
    if (found == kNone && !put_whole(wanted, found, 0, count - 1))
        return Error{ExitCode::usage, "", "camera", fmt::format("'{}' is no camera: the scene has {}", wanted, count)};
    if (!is_placed(scene, found))
        return Error{ExitCode::usage, "", "camera", fmt::format("no node places camera {}", found)};
    return found;
}

// Applies fov and target to a camera of the scene.
Result<View> changed(View view, const CSettings& settings, const glm::vec3& origin)
{
    const int width = settings.desc.width, height = settings.desc.height;
    if (settings.fov_deg) {
        if (view.orthographic)
            return Error{ExitCode::usage, "", "fov", "the camera is orthographic: zoom changes what it shows"};
        const float tan_half = make_view(view.eye, view.eye + view.forward, glm::radians(*settings.fov_deg), width, height).tan_half_y;
        view.tan_half_x *= tan_half / view.tan_half_y, view.tan_half_y = tan_half;
    }
    if (settings.target) {
        const glm::vec3 target = *settings.target - origin;
        if (target == view.eye)
            return Error{ExitCode::usage, "", "target", "is where the camera stands"};
        const View turned = make_view(view.eye, target, 1.0f, width, height);
        view.right = turned.right, view.up = turned.up, view.forward = turned.forward;
    }
    return view;
}

Result<View> wanted_view(const CSettings& settings, const Session& session)
{
    constexpr float kDefaultFov = 45.0f;
    const int width = settings.desc.width, height = settings.desc.height;
    const float fov_rad = glm::radians(settings.fov_deg.value_or(kDefaultFov));
    const glm::vec3 origin(session.scene().origin);
    if (settings.eye) {
        const glm::vec3 middle = 0.5f * (session.tables().bounds_min + session.tables().bounds_max);
        const glm::vec3 target = settings.target ? *settings.target - origin : middle;
        if (*settings.eye - origin == target)
            return Error{ExitCode::usage, "", "eye", "is the centre of the scene: give a target"};
        return make_view(*settings.eye - origin, target, fov_rad, width, height);
    }
    const Result<int> camera = settings.orbit_deg ? Result<int>(int{kNone}) : find_camera(session.scene(), settings.camera);
    BN_TRY(camera);
    if (*camera != kNone) {
        const Result<View> own = make_view(session.scene(), *camera, width, height);
        BN_TRY(own);
        return changed(*own, settings, origin);
    }
    Framing framing;
    framing.fov_y_rad = fov_rad;
    if (settings.target)
        framing.target = *settings.target - origin;
    if (settings.orbit_deg)
        framing.azimuth_rad = glm::radians(settings.orbit_deg->x), framing.elevation_rad = glm::radians(settings.orbit_deg->y);
    return session.framed(width, height, framing);
}

} // namespace

Result<View> view_of(const CSettings& settings, const Session& session)
{
    Result<View> view = wanted_view(settings, session);
    BN_TRY(view);
    view->tan_half_x /= settings.zoom, view->tan_half_y /= settings.zoom;
    const float length = glm::length(view->forward), far = glm::length(view->eye); // of numbers that are too large: 0 or not finite
    if ((settings.eye || settings.target) && !(length > 0.5f && std::isfinite(length) && std::isfinite(far)))
        return Error{ExitCode::usage, "", settings.eye ? "eye" : "target",
                     "gives no view: its numbers are too large, or the camera stands too near to its target"};
    return view;
}

} // namespace burnish
