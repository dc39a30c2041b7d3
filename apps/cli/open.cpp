#include "apps/cli/open.h"

#include <algorithm>

#include "apps/cli/suggest.h"

namespace burnish {

Result<std::shared_ptr<const SceneData>> open_scene(const std::string& name, const Limits& limits, const MaterialOverrides& overrides,
                                                    const MipSettings& mips, const Moment& moment, const std::vector<AreaLight>& lights,
                                                    const FloorSettings& floor, const Jobs* jobs)
{
    Result<std::shared_ptr<const SceneData>> scene = load_scene_data(name, limits, overrides, mips, moment, lights, floor, jobs);
    if (!scene) {
        const std::string& file = scene.error().file;
        const bool of_light = std::any_of(lights.begin(), lights.end(), [&](const AreaLight& l) { return l.texture_file == file; });
        return of_light || overrides.names(file) || mips.names(file) ? scene.error() : with_scene_hint(scene.error(), name);
    }
    return scene;
}

Result<std::shared_ptr<const Environment>> open_environment(const std::string& name, const EnvironmentOptions& options,
                                                            const Limits& limits, const Jobs& jobs)
{
    Result<std::shared_ptr<const Environment>> environment = load_shared_environment(name, options, limits, jobs);
    if (!environment)
        return with_environment_hint(environment.error(), name);
    return environment;
}

} // namespace burnish
