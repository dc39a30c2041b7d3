// The options of `burnish render`: as they are given, then checked and resolved.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "apps/cli/parse.h"
#include "apps/options/show.h"
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/colour.h"
#include "core/scene/material_overrides.h"
#include "core/scene/scene.h"
#include "raster/reference/reference_renderer.h"
#include "raster/tile/tile_renderer.h"
#include "raster/vulkan/vulkan_renderer.h"
#include "shading/bake/environment/environment.h"
#include "shading/bake/mip/settings.h"

namespace burnish {

struct RenderOptions {
    std::string scene = "builtin:teapot";
    Moment moment;
    std::vector<AreaLight> lights;      // besides those of the scene
    std::vector<std::string> as_tables; // of as_mc's lobes, or folders of them; empty: frames make their own
    std::string ltc_table;              // of area lights; empty: the program's own
    MaterialOverrides overrides;        // what all materials take
    MipSettings mips;
    std::vector<std::string> outputs;
    std::vector<std::string> aov;      // layers of .exr outputs
    Shown show = Shown::light;         // in 8-bit outputs
    std::string risks;                 // picture of what the atlas says of the technique; "-": its words only; empty: none
    bool shadow_ratio = false;         // area lights throw shadows, by samples
    int shadow_samples = 64;           // a pixel
    Resolve resolve = Resolve::linear; // of 8-bit outputs
    std::string stats_file;            // empty: none; "-": standard output
    std::string trace_file;            // empty: none

    std::string env = "builtin:studio";
    bool env_given = false; // else the scene's own light is taken where it has one
    EnvironmentOptions environment;

    std::string camera;            // index or name, empty: the scene's first camera, else framed automatically
    std::optional<glm::dvec3> eye; // world space, metres
    std::optional<glm::dvec3> target;
    std::optional<float> fov_y_deg;     // none: the camera's, else 45
    std::optional<glm::vec2> orbit_deg; // azimuth, elevation: the whole scene from there
    float zoom = 1.0f;                  // things are so many times larger

    FrameDesc frame; // its view is filled in once the scene is known
    std::string backend = "tile";
    ReferenceOptions reference; // of --backend reference
    std::string variance_file;  // empty: none
    VulkanOptions vulkan;       // of --backend vulkan
    Isa isa = Isa::scalar;
    int threads = 0; // 0: all cores the process may use
    int frames = 1;
    int turntable = 0; // pictures once around the scene; 0: none
    int fps = 30;      // of moving pictures
    Tonemap tonemap = Tonemap::pbr_neutral;
    float exposure_ev = 0.0f;

    Limits limits;
    std::vector<std::string> warnings; // about options, one line each
    bool quiet = false;
    int verbosity = 0;
};

// Where the command line puts values: most where they stay, some where they wait for what else is given.
struct RenderArguments {
    RenderOptions plain;
    PictureSize size = {1280, 720};
    std::optional<std::int64_t> samples; // none: the technique's or the reference's own number
    std::string animate;                 // as --animate takes it
    int steps = 60;                      // of it
};

// All options of `burnish render`, which other subcommands take theirs from; `to` must outlive the table.
OptionTable render_option_table(RenderArguments& to);

std::string reference_mode_name(const RenderOptions& options); // as --reference-mode takes it

// Everything that can be known to be wrong before a file is opened. `given`: the table that `arguments` were set by; options that it does
// not have were not given.
Result<RenderOptions> check_render_options(const RenderArguments& arguments, const OptionTable& given);

// The parts of it that belong to one backend.
Status check_reference_options(const RenderArguments& arguments, const OptionTable& given, RenderOptions& out);
Status check_vulkan_options(RenderOptions& out);

// Options that change a picture and can be swept or go from one value to another: numbers and, with `names`, names too.
bool changes_pictures(const Option& option, bool names);

// Those for which a scene has to be read again.
bool changes_scene(const Option& option);

// Options that were given and change nothing under the others: one warning each, which names both.
void warn_of_no_effect(const OptionTable& given, RenderOptions& out);

} // namespace burnish
