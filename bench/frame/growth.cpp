// Series of workloads that differ in one number, for bench/growth.py.
#include <deque>
#include <fmt/format.h>

#include "bench/frame/workloads.h"

namespace burnish {
namespace {

enum class Grows { scene, samples, picture, threads };

struct GrowthRow {
    const char* group;
    Grows what;
    BenchScene scene;
    std::vector<int> numbers; // for an image its height, 16:9
    const char* technique = "bent_normal";
    float eta = 0.0f;
    int scene_size = 0; // used where the scene does not grow
};

const std::vector<GrowthRow>& rows()
{
    using S = BenchScene;
    static const std::vector<GrowthRow> table = {
        {"growth_triangles", Grows::scene, S::waves, {50000, 100000, 250000, 500000, 1000000, 2000000}},
        {"growth_pixels", Grows::picture, S::sphere, {270, 540, 720, 1080, 1440, 2160}, "bent_normal", 0.5f},
        {"growth_textures", Grows::scene, S::textured, {1, 2, 3, 4, 5}},
        {"growth_lights", Grows::scene, S::lit, {1, 2, 3, 4}},
        {"growth_far_lights", Grows::scene, S::lit, {8, 16, 32, 64, 128, 256}},
        {"growth_materials", Grows::scene, S::materials, {1, 100, 250, 500, 1000}},
        {"growth_layers", Grows::scene, S::layers, {1, 5, 10, 20, 40}},
        {"growth_samples", Grows::samples, S::sphere, {2, 4, 8, 16, 32, 64}, "major_axis_weighted", 0.8f},
        {"growth_mc_samples", Grows::samples, S::sphere, {4, 8, 16, 32, 64}, "mc", 0.8f},
        {"growth_threads", Grows::threads, S::waves, {1, 2, 4, 8}, "bent_normal", 0.0f, 1000000},
    };
    return table;
}

} // namespace

void append_growth(std::vector<Workload>& table)
{
    static std::deque<std::string> names; // storage for workload names
    for (const GrowthRow& row : rows())
        for (const int number : row.numbers) {
            Workload w{"", row.group, row.scene, row.scene_size, 1280, 720, 1, row.technique, 0, row.eta};
            w.along = number, w.only_named = true;
            if (row.what == Grows::scene)
                w.size = number;
            else if (row.what == Grows::samples)
                w.samples = number;
            else if (row.what == Grows::threads)
                w.threads = number;
            else
                w.height = number, w.width = number * 16 / 9, w.along = static_cast<double>(w.width) * w.height;
            w.name = names.emplace_back(fmt::format("{}_{:.0f}", row.group, w.along)).c_str();
            table.push_back(w);
        }
}

} // namespace burnish
