// The options for `burnish render`: as given on the command line, then checked and resolved.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "apps/cli/parse.h"
#include "apps/options/show.h"
#include "apps/pieces/pieces.h"
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/colour.h"
#include "core/scene/material_overrides.h"
#include "core/scene/scene.h"
#include "raster/reference/reference_renderer.h"
#include "raster/session/floor.h"
#include "raster/session/shadows.h"
#include "raster/tile/tile_renderer.h"
#include "raster/vulkan/vulkan_renderer.h"
#include "shading/bake/environment/environment.h"
#include "shading/bake/mip/settings.h"

namespace burnish {

enum class FloorChoice { off, shadow, stage, mirror, automatic }; // automatic: as floor_of() says

struct RenderOptions {
    std::string scene = "builtin:teapot";
    Moment moment;
    std::vector<AreaLight> lights;      // besides the scene's own
    std::vector<std::string> as_tables; // for as_mc's lobes, or folders with tables; empty: frames make their own
    std::string ltc_table;              // for area lights; empty: the program's own
    MaterialOverrides overrides;        // what all materials take
    MipSettings mips;
    FloorChoice floor = FloorChoice::automatic;
    int band_rows = 0;      // a band's rows, where the picture is drawn in bands; 0: it is drawn at once
    bool in_pieces = false; // a signal ends the process between a reference's blocks, as with a checkpoint
    std::vector<std::string> outputs;
    std::vector<std::string> aov;       // .exr outputs' layers
    Shown show = Shown::light;          // 8-bit outputs' false colour
    std::string risks;                  // picture with the atlas's risks for the technique; "-": text only; empty: none
    Shadows shadows = Shadows::off;     // for lights, by ray-traced samples
    int shadow_samples = 16;            // a pixel
    Resolve resolve = Resolve::display; // for 8-bit outputs; linear by default where samples are not kept
    std::string stats_file;             // empty: none; "-": standard output
    bool counts_operations = false;     // in a frame, for stats_file
    std::string trace_file;             // empty: none
    std::optional<double> budget;       // largest mean HDR-FLIP: the plan chooses each material's technique and samples
    std::optional<double> budget_p99;   // largest 99th percentile of its pixels' HDR-FLIP
    std::optional<double> budget_ms;    // the frame's largest processor time, milliseconds
    bool fixes_technique = false;       // given beside a budget
    int fixed_samples = 0;              // given beside a budget; 0: none
    bool fixes_area_lights = false;     // given beside a budget
    std::string plan_file, plan_out;    // plan to draw by, and plan to write; empty: none
    bool verify = false;                // compares the planned picture with the reference
    bool plans() const { return budget || budget_p99 || budget_ms; }
    const char* first_budget() const { return budget ? "--budget" : budget_p99 ? "--budget-p99" : "--budget-ms"; }

    std::string env = "builtin:studio";
    bool env_given = false; // otherwise the scene's own light, if any
    EnvironmentOptions environment;

    std::string camera;            // index or name; empty: the scene's first camera, else automatic framing
    std::optional<glm::dvec3> eye; // world space, metres
    std::optional<glm::dvec3> target;
    std::optional<float> fov_y_deg;     // none: the camera's angle, else 45
    std::optional<glm::vec2> orbit_deg; // azimuth, elevation; frames the whole scene from there
    float zoom = 1.0f;                  // magnification

    FrameDesc frame; // its view is set once the scene is known
    std::string backend = "tile";
    ReferenceOptions reference; // for --backend reference
    std::string variance_file;  // empty: none
    VulkanOptions vulkan;       // for --backend vulkan
    Isa isa = {};
    int threads = 0; // 0: all cores open to the process
    int frames = 1;
    int turntable = 0; // pictures around the scene; 0: no turntable
    int fps = 30;      // for animations
    Tonemap tonemap = Tonemap::pbr_neutral;
    float exposure_ev = 0.0f;

    Limits limits;
    std::vector<std::string> warnings; // about options, one line each
    bool quiet = false;
    int verbosity = 0;
};

inline constexpr int kBandTile = 64; // pixels along .exr tiles' sides, in pictures that no frame holds; their bands have whole tiles

// Returns the floor for `burnish render`. By default built-in scenes stand on the stage if the background is drawn, except scenes with
// their own floor.
FloorSettings floor_of(const RenderOptions& options);

// Returns true if pictures need pixels' samples: 8-bit ones that are not plain means. The reference keeps no samples.
bool needs_parts(const RenderOptions& options);

// Targets for the command line's values. Most values are final here; some wait for other options.
struct RenderArguments {
    RenderOptions plain;
    PictureSize size = {1280, 720};
    std::optional<std::int64_t> samples;   // none: the technique's or the reference's default
    std::string animate;                   // in --animate's syntax
    int steps = 60;                        // for --animate
    std::optional<std::int64_t> band_rows; // none: chosen
    bool may_have_bands = false;           // one picture, which the command can write by rows
    PieceOptions pieces;
};

// Returns all options for `burnish render`. Other subcommands take rows from this table. `to` must outlive the table.
OptionTable render_option_table(RenderArguments& to);

std::string reference_mode_name(const RenderOptions& options); // in --reference-mode's syntax

// Reports every error that can be found before a file is opened. `given` is the table that filled `arguments`; an option absent from the
// table counts as not given.
Result<RenderOptions> check_render_options(const RenderArguments& arguments, const OptionTable& given);

// Returns the error for a picture that cannot be drawn in bands, at the option that asks for bands.
Error no_bands_error(const RenderArguments& arguments, const std::string& reason);

// Checks the options that belong to one backend.
Status check_reference_options(const RenderArguments& arguments, const OptionTable& given, RenderOptions& out);
Status check_vulkan_options(RenderOptions& out);

// Returns true for options that change a picture and can be swept or animated: numbers and, with `names`, names too.
bool changes_pictures(const Option& option, bool names);

// Returns true for options that need the scene to be read again.
bool changes_scene(const Option& option);

// Adds one warning for each given option that has no effect, and names the option that causes this.
void warn_of_no_effect(const OptionTable& given, RenderOptions& out);
void warn_of_baked_environment(const OptionTable& given, RenderOptions& out); // of that kind, for options of the bake

} // namespace burnish
