// Options of `burnish chart`: as written on the command line, then checked and resolved.
#pragma once
#include <string>
#include <vector>

#include "apps/chart/plan.h"
#include "apps/options/options.h"

namespace burnish {

struct ChartOptions {
    RenderOptions base; // size of the timed frames, view, machine and limits; its scene and environment are those being measured
    int error_width = 0, error_height = 0; // pixels, of the pictures that are compared with the reference
    std::vector<std::string> scenes = {"builtin:spheres"}, envs = {"builtin:studio"};
    std::vector<std::string> techniques = technique_names();
    Sweeps sweeps;
    std::vector<Cell> cells;                                 // of the sweeps
    std::vector<RenderOptions> cell_options;                 // `base` as each of them changes it
    bool sweeps_environments = false, sweeps_scenes = false; // options that these are made by
    bool display_flip = false;                               // FLIP of pictures as they are shown, in place of HDR-FLIP of linear ones
    int runs = 9;                                            // timed, of every setting
    std::uint64_t reference_samples = 4096;                  // a pixel
    std::string folder;
    bool mip = false;       // mip filters are measured, not frames
    std::string maps;       // a folder of pictured materials for these
    int per_set = 1000;     // materials at most
    bool two_lobes = false; // of crossed grain, by two lobes a texel beside the filters
};

struct ChartArguments {
    ChartArguments() { render.size = {1920, 1080}, render.plain.reference.full_textures = true; }
    RenderArguments render; // options that mean the same as in `burnish render`
    PictureSize error_size; // 0x0: as large as usual
    ChartOptions plain;
};

OptionTable chart_option_table(ChartArguments& to);

// Everything that can be known to be wrong before a file is opened.
Result<ChartOptions> check_chart_options(const ChartArguments& arguments, const OptionTable& given);

} // namespace burnish
