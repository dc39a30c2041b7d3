// How a picture is rendered: its scene and environment made ready, its frames drawn.
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
    Image color; // RGBA of pictures without a background
    Image variance;
    std::vector<PixelPart> parts; // with another --resolve than linear
    NamedChannels layered;        // with --aov: `color` and its layers
    Image shown;                  // with --show: its false colours
    std::optional<RiskMap> risks; // with --risks
    RenderFigures figures;
};

// By the extension of `path`.
Status write_rendered(const std::string& path, const Rendered& rendered, const RenderOptions& options);

// `inputs`: files that must not be written over.
Status check_paths(const RenderOptions& options, const std::vector<std::string>& inputs);

// `lost_checkpoint`: why the last one could not be written.
SessionOptions session_options(const RenderOptions& options, std::optional<Error>& lost_checkpoint);

// What the options' environment is for a scene, and baked for the options' renderer: the reference does not need the levels.
std::string light_name(const RenderOptions& options, const SceneData& scene);
Result<std::shared_ptr<const Environment>> open_light(const RenderOptions& options, const SceneData& scene, const Jobs& jobs);

// --ltc-table and --as-table.
Status read_tables(const RenderOptions& options, SessionParts& parts, Report& report);

// Loads and bakes, with a line of the report each, and makes the renderer.
Result<Session> prepare(const RenderOptions& options, RenderFigures& figures, std::optional<Error>& lost_checkpoint, Report& report);

// All frames show the same picture: a renderer that does not repeat itself is caught here.
Result<Rendered> render_frames(const RenderOptions& options, FrameDesc desc, Session& session, RenderFigures figures);

// A row of pictures, --animate or --turntable. Returns the exit code.
int run_row(RenderArguments& arguments, OptionTable& given);

} // namespace burnish
