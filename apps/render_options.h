// The options of `burnish render`: as written on the command line, then checked and resolved.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/colour.h"
#include "raster/reference/reference_renderer.h"
#include "raster/tile/tile_renderer.h"
#include "raster/vulkan/vulkan_renderer.h"
#include "shading/bake/environment.h"

namespace burnish {

struct RenderOptions {
    std::string scene = "builtin:teapot";
    std::vector<std::string> outputs;
    std::string stats_file; // empty: none; "-": standard output
    std::string trace_file; // empty: none

    std::string env = "builtin:studio";
    EnvironmentOptions environment;

    std::string camera;           // index or name, empty: the scene's first camera, else framed automatically
    std::optional<glm::vec3> eye; // world space, metres
    std::optional<glm::vec3> target;
    float fov_y_deg = 45.0f;

    FrameDesc frame; // its view is filled in once the scene is known
    std::string backend = "tile";
    ReferenceOptions reference; // of --backend reference
    std::string reference_mode_name = "direct";
    std::string variance_file;  // empty: none
    VulkanOptions vulkan;       // of --backend vulkan
    Isa isa = Isa::scalar;
    int threads = 0; // 0: all cores the process may use
    int frames = 1;
    Tonemap tonemap = Tonemap::pbr_neutral;
    std::string tonemap_name = "pbr-neutral";
    float exposure_ev = 0.0f;

    Limits limits;
    std::vector<std::string> warnings; // about options, one line each
    bool quiet = false;
    int verbosity = 0;
};

// Option values exactly as they were typed; an empty string means "not given".
struct RenderArguments {
    RenderOptions plain; // options that need no reading beyond CLI11's
    std::string size, msaa, samples, threads, frames, roughness, anisotropy, exposure, eye, target, fov, isa,
        technique;
    std::string tile_size, texture_anisotropy, tonemap, env_rotation, env_exposure, env_size, env_samples;
    std::string limit_image_side, limit_texture_bytes, limit_json_depth, limit_node_depth, limit_file_bytes;
    std::string limit_accessor_bytes, limit_data_uri_bytes, limit_draw_bytes;
    std::string axis_k, axis_beta, tilt, seed, dfg = "table";
    std::string reference_mode, reference_strategy, bounces, target_error, checkpoint, variance;
    std::string device, sampler, pipeline;
    bool no_background = false, no_cache = false, energy_compensation = false, horizon = false, validate = false;
};

void add_render_options(CLI::App& app, RenderArguments& arguments);

// The names that --backend takes.
std::vector<std::string> backend_names();

// Everything that can be known to be wrong before a file is opened.
Result<RenderOptions> check_render_options(const RenderArguments& arguments);

} // namespace burnish
