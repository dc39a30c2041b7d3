// Options of `burnish chart`: as given on the command line, then checked and resolved.
#pragma once
#include <string>
#include <vector>

#include "apps/chart/plan.h"
#include "apps/cli/lab.h"
#include "apps/options/options.h"

namespace burnish {

struct ChartOptions {
    RenderOptions base;                    // timed frames' size, view, machine, limits; scene and environment vary
    int error_width = 0, error_height = 0; // pixels, of the pictures compared with the reference
    std::vector<std::string> scenes = {"builtin:spheres"}, envs = {"builtin:studio"};
    std::vector<std::string> techniques = technique_names();
    Sweeps sweeps;
    std::vector<double> budgets;                             // of planned rows; mean HDR-FLIP
    std::vector<Cell> cells;                                 // one a sweep point
    std::vector<RenderOptions> cell_options;                 // `base` with the changes of each cell
    bool sweeps_environments = false, sweeps_scenes = false; // sweeps contain environment or scene options
    bool display_flip = false;                               // LDR-FLIP on tonemapped pictures, not HDR-FLIP on linear ones
    int runs = 9;                                            // timed runs of every setting
    std::uint64_t reference_samples = 4096;                  // a pixel
    std::string folder;
    bool live = false;    // the page draws its rows anew
    std::string renderer; // for the page; empty: beside the program
    bool mip = false;     // measures mip filters, not frames
    std::string maps;     // folder of photographed materials for --mip
    int per_set = 1000;   // materials at most
    PieceOptions pieces;
    bool two_lobes = false; // also measures two lobes a texel, on crossed grain
};

struct ChartArguments {
    ChartArguments()
    {
        render.size = {1920, 1080}, render.plain.reference.full_textures = true;
        render.plain.frame.glass = 0; // as its reference has it
    }
    RenderArguments render; // options shared with `burnish render`
    PictureSize error_size; // 0x0: the default size
    ChartOptions plain;
};

inline LabPart<ChartArguments, OptionTable> chart_mips; // --mip, with the options present on the command line

OptionTable chart_option_table(ChartArguments& to);

// Reports every error that can be found before a file is opened.
Result<ChartOptions> check_chart_options(const ChartArguments& arguments, const OptionTable& given);

} // namespace burnish
