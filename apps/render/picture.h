// Renders one picture: loads the scene and the environment, makes the renderer and draws the frames.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "apps/options/options.h"
#include "apps/render/stats.h"
#include "apps/risks/risks.h"
#include "raster/frame/layers.h"
#include "raster/session/session.h"

namespace burnish {

struct Rendered {
    Image color; // RGBA for pictures without a background
    Image variance;
    std::vector<PixelPart> parts; // if --resolve is not linear
    NamedChannels layered;        // with --aov: `color` and the layers
    Image shown;                  // with --show: the false colours
    std::optional<RiskMap> risks; // with --risks
    FrameProfile profile;         // of the last frame, if asked for
    RenderFigures figures;
};

// Writes the format named by the extension of `path`. jobs: null for the calling thread alone.
Status write_rendered(const std::string& path, const Rendered& rendered, const RenderOptions& options, const Jobs* jobs = nullptr);

// Refuses output paths that collide with each other or with `inputs`, the files read.
Status check_paths(const RenderOptions& options, const std::vector<std::string>& inputs);

// Stores into `lost_checkpoint` the error of a checkpoint that could not be written.
SessionOptions session_options(const RenderOptions& options, std::optional<Error>& lost_checkpoint);

// Name the scene's environment under these options, and open it, baked as far as the renderer needs. The reference needs no mip levels.
std::string light_name(const RenderOptions& options, const SceneData& scene);
Result<std::shared_ptr<const Environment>> open_light(const RenderOptions& options, const SceneData& scene, const Jobs& jobs);

// Reads the files of --ltc-table and --as-table.
Status read_tables(const RenderOptions& options, SessionParts& parts, Report& report);

// Loads the scene, bakes the environment and makes the renderer. Reports one line for each.
Result<Session> prepare(const RenderOptions& options, RenderFigures& figures, std::optional<Error>& lost_checkpoint, Report& report);

// Renders --frames frames of one picture. Fails with ExitCode::differ if the pixels of two frames differ.
Result<Rendered> render_frames(const RenderOptions& options, FrameDesc desc, Session& session, RenderFigures figures);

// Renders the pictures of --animate or --turntable. Returns the exit code.
int run_animation(RenderArguments& arguments, OptionTable& given);

} // namespace burnish
