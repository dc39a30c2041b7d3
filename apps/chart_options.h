// Options of `burnish chart`: as written on the command line, then checked and resolved.
#pragma once
#include <string>
#include <vector>

#include "apps/chart_plan.h"
#include "apps/render_options.h"

namespace burnish {

struct ChartOptions {
    RenderOptions base; // size of the timed frames, view, machine and limits; its scene and environment are those being measured
    int error_width = 0, error_height = 0; // pixels, of the pictures that are compared with the reference
    std::vector<std::string> scenes, envs;
    std::vector<std::string> techniques;
    Sweeps sweeps;
    int runs = 9;                          // timed, of every setting
    std::uint64_t reference_samples = 4096; // a pixel
    std::string folder;
};

struct ChartArguments {
    RenderArguments render; // options that mean the same as in `burnish render`
    std::vector<std::string> scenes, envs, sweeps;
    std::string techniques = "all", error_size, runs, reference_samples, folder;
};

void add_chart_options(CLI::App& app, ChartArguments& arguments);

// Everything that can be known to be wrong before a file is opened.
Result<ChartOptions> check_chart_options(const ChartArguments& arguments);

} // namespace burnish
