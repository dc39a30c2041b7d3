#include "apps/options/scene_view.h"

#include <charconv>
#include <cmath>
#include <fmt/core.h>
#include <glm/gtc/matrix_transform.hpp>

#include "apps/cli/report.h"

namespace burnish {
namespace {

bool is_placed(const Scene& scene, int camera)
{
    for (const Node& node : scene.nodes)
        if (node.camera == camera)
            return true;
    return false;
}

std::string camera_label(const Scene& scene, int camera)
{
    return fmt::format("{} '{}'", camera, scene.cameras[static_cast<std::size_t>(camera)].name);
}

Result<int> find_camera(const Scene& scene, const std::string& wanted)
{
    const int count = static_cast<int>(scene.cameras.size());
    int found = kNone;
    for (int i = 0; i < count && found == kNone; ++i)
        if (scene.cameras[static_cast<std::size_t>(i)].name == wanted)
            found = i;
    if (found == kNone) {
        int index = 0;
        const char* end = wanted.data() + wanted.size();
        const std::from_chars_result read = std::from_chars(wanted.data(), end, index);
        if (read.ec == std::errc() && read.ptr == end && index >= 0 && index < count)
            found = index;
    }
    if (found == kNone) {
        std::vector<std::string> labels;
        for (int i = 0; i < count; ++i)
            labels.push_back(camera_label(scene, i));
        return usage_error("--camera", count == 0 ? "the scene has no camera" : fmt::format("'{}' is not one of {}", wanted, join(labels)));
    }
    if (!is_placed(scene, found))
        return usage_error("--camera", fmt::format("no node places camera {}", camera_label(scene, found)));
    return found;
}

// Converts to draw space, whose origin is the scene's origin.
glm::vec3 drawn_place(const glm::dvec3& place, const Scene& scene)
{
    return glm::vec3(place - scene.origin);
}

// Applies --fov and --target to a camera of the scene.
Result<View> changed(View view, const RenderOptions& options, const Scene& scene, const std::string& camera)
{
    const int width = picture_width(options.frame), height = picture_height(options.frame);
    if (options.fov_y_deg) {
        if (view.orthographic)
            return usage_error("--fov", camera + " is orthographic: --zoom changes what it shows");
        const glm::vec3 ahead = view.eye + view.forward;
        const float tan_half = make_view(view.eye, ahead, *options.fov_y_deg * kRadiansPerDegree, width, height).tan_half_y;
        view.tan_half_x *= tan_half / view.tan_half_y, view.tan_half_y = tan_half;
    }
    if (options.target) {
        const glm::vec3 target = drawn_place(*options.target, scene);
        if (target == view.eye)
            return usage_error("--target", "is where " + camera + " stands");
        const View turned = make_view(view.eye, target, 1.0f, width, height);
        view.right = turned.right, view.up = turned.up, view.forward = turned.forward;
    }
    return view;
}

int first_placed_camera(const Scene& scene)
{
    for (int camera = 0; camera < static_cast<int>(scene.cameras.size()); ++camera)
        if (is_placed(scene, camera))
            return camera;
    return kNone;
}

Result<ChosenView> wanted_view(const RenderOptions& options, const Scene& scene, const DrawTables& tables)
{
    const int width = picture_width(options.frame), height = picture_height(options.frame);
    const float fov_y_rad = options.fov_y_deg.value_or(kDefaultFovDeg) * kRadiansPerDegree;
    if (options.eye) {
        const glm::vec3 eye = drawn_place(*options.eye, scene);
        const glm::vec3 target = options.target ? drawn_place(*options.target, scene) : (tables.bounds_min + tables.bounds_max) * 0.5f;
        if (target == eye)
            return usage_error("--eye", "is the centre of the scene: give a --target");
        return ChosenView{make_view(eye, target, fov_y_rad, width, height), "from --eye"};
    }
    int camera = options.orbit_deg ? kNone : first_placed_camera(scene);
    if (!options.camera.empty()) {
        const Result<int> found = find_camera(scene, options.camera);
        BN_TRY(found);
        camera = *found;
    }
    if (camera != kNone) {
        const std::string label = "camera " + camera_label(scene, camera);
        const Result<View> own = make_view(scene, camera, width, height);
        BN_TRY(own);
        const Result<View> view = changed(*own, options, scene, label);
        BN_TRY(view);
        return ChosenView{*view, label};
    }
    Framing framing;
    framing.fov_y_rad = fov_y_rad;
    if (options.target)
        framing.target = drawn_place(*options.target, scene);
    const glm::vec2 orbit_deg = options.orbit_deg.value_or(kDefaultOrbitDeg);
    framing.azimuth_rad = orbit_deg.x * kRadiansPerDegree, framing.elevation_rad = orbit_deg.y * kRadiansPerDegree;
    return ChosenView{auto_frame(tables, width, height, framing), options.orbit_deg ? "from --orbit" : "framed automatically", true};
}

} // namespace

Result<ChosenView> choose_view(const RenderOptions& options, const Scene& scene, const DrawTables& tables)
{
    Result<ChosenView> chosen = wanted_view(options, scene, tables);
    BN_TRY(chosen);
    View& view = chosen->view;
    view.tan_half_x /= options.zoom, view.tan_half_y /= options.zoom;
    for (const glm::vec3& v : {view.eye, view.right, view.up, view.forward})
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) // for example a camera node with zero scale
            return options.eye      ? usage_error("--eye", "gives no view: too near or too far from its target")
                   : chosen->framed ? Error{ExitCode::bad_input, options.scene, "/nodes",
                                            "the scene is too large to be framed; give it a camera or --eye"}
                                    : Error{ExitCode::bad_input, options.scene, "/cameras", "the camera's node gives no view"};
    return chosen;
}

glm::vec3 to_eye(const View& view, int width, int height, int x, int y)
{
    if (view.orthographic)
        return -view.forward;
    const float sx = (static_cast<float>(x) + 0.5f) / static_cast<float>(width) * 2.0f - 1.0f,
                sy = 1.0f - (static_cast<float>(y) + 0.5f) / static_cast<float>(height) * 2.0f;
    return -glm::normalize(view.forward + view.right * (sx * view.tan_half_x) + view.up * (sy * view.tan_half_y));
}

std::string world_place(const glm::vec3& place, const Scene& scene, int digits)
{
    const glm::dvec3 p = glm::dvec3(place) + scene.origin;
    const int all = scene.origin == glm::dvec3(0.0) ? digits : 15;
    return fmt::format("{:.{}g},{:.{}g},{:.{}g}", p.x, all, p.y, all, p.z, all);
}

std::string camera_options(const View& view, const Scene& scene, const DrawTables& tables)
{
    if (view.orthographic)
        return "orthographic, which no options give";
    const glm::vec3 to_center = (tables.bounds_min + tables.bounds_max) * 0.5f - view.eye;
    const glm::vec3 target = view.eye + view.forward * std::max(glm::dot(to_center, view.forward), 10.0f * view.znear);
    const auto text = [&](const glm::vec3& p) { return world_place(p, scene, 7); };
    return fmt::format("--eye {} --target {} --fov {:.7g}", text(view.eye), text(target),
                       2.0f * std::atan(view.tan_half_y) / kRadiansPerDegree);
}

std::string describe_matrix(const View& view, const Scene& scene)
{
    const glm::dmat4 m = glm::translate(glm::dmat4(clip_from_world(view)), -scene.origin);
    std::string text;
    for (int row = 0; row < 4; ++row)
        text += fmt::format("{}[{:.7g} {:.7g} {:.7g} {:.7g}]", row ? " " : "", m[0][row], m[1][row], m[2][row], m[3][row]);
    return text;
}

} // namespace burnish
