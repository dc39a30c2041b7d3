// Opens scenes and environments by the user's names. Errors carry a hint if a similar name exists.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "raster/session/session.h"

namespace burnish {

Result<std::shared_ptr<const SceneData>> open_scene(const std::string& name, const Limits& limits, const MaterialOverrides& overrides,
                                                    const MipSettings& mips, const Moment& moment, const std::vector<AreaLight>& lights,
                                                    const FloorSettings& floor = {}, const Jobs* jobs = nullptr);
Result<std::shared_ptr<const Environment>> open_environment(const std::string& name, const EnvironmentOptions& options,
                                                            const Limits& limits, const Jobs& jobs);

} // namespace burnish
