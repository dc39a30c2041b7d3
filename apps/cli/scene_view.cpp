#include "apps/cli/scene_view.h"

#include <charconv>
#include <cmath>
#include <fmt/core.h>

#include "apps/cli/report.h"

namespace burnish {
namespace {

constexpr float kRadiansPerDegree = 0.017453292519943295f;

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

} // namespace

namespace {

Result<ChosenView> wanted_view(const RenderOptions& options, const Scene& scene, const DrawTables& tables)
{
    const int width = options.frame.width, height = options.frame.height;
    if (options.eye) {
        const glm::vec3 target = options.target ? *options.target : (tables.bounds_min + tables.bounds_max) * 0.5f;
        if (target == *options.eye)
            return usage_error("--eye", "is the centre of the scene: give a --target");
        return ChosenView{make_view(*options.eye, target, options.fov_y_deg * kRadiansPerDegree, width, height), "from --eye"};
    }
    if (!options.camera.empty()) {
        const Result<int> camera = find_camera(scene, options.camera);
        if (!camera)
            return camera.error();
        return ChosenView{make_view(scene, *camera, width, height), "camera " + camera_label(scene, *camera)};
    }
    for (int camera = 0; camera < static_cast<int>(scene.cameras.size()); ++camera)
        if (is_placed(scene, camera))
            return ChosenView{make_view(scene, camera, width, height), "camera " + camera_label(scene, camera)};
    return ChosenView{auto_frame(tables, width, height), "framed automatically", true};
}

} // namespace

Result<ChosenView> choose_view(const RenderOptions& options, const Scene& scene, const DrawTables& tables)
{
    Result<ChosenView> chosen = wanted_view(options, scene, tables);
    if (!chosen)
        return chosen;
    const View& view = chosen->view;
    for (const glm::vec3& v : {view.eye, view.right, view.up, view.forward})
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) // a camera node scaled to nothing, say
            return options.eye      ? usage_error("--eye", "gives no view: too near or too far from its target")
                   : chosen->framed ? Error{ExitCode::bad_input, options.scene, "/nodes",
                                            "the scene is too large to be framed; give it a camera or --eye"}
                                    : Error{ExitCode::bad_input, options.scene, "/cameras", "the camera's node gives no view"};
    return chosen;
}

std::string describe_matrix(const View& view)
{
    const glm::mat4 m = clip_from_world(view);
    std::string text;
    for (int row = 0; row < 4; ++row)
        text += fmt::format("{}[{:.7g} {:.7g} {:.7g} {:.7g}]", row ? " " : "", m[0][row], m[1][row], m[2][row], m[3][row]);
    return text;
}

} // namespace burnish
