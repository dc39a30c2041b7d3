// The table of workloads and what is asked of them: data only.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bench/scenes/scenes.h"
#include "shading/lang/records.h"

namespace burnish {

enum class Engine { tile, rays };

struct Workload {
    const char* name;
    const char* group; // workloads of a group are measured in turn: A B A B
    BenchScene scene;
    std::int64_t size = 0; // of the scene
    int width = 1920, height = 1080, msaa = 1;
    const char* technique = "bent_normal";
    int samples = 0;  // 0: the technique's own
    float eta = 0.0f; // overrides the material where it is not 0, with alpha_lin
    int threads = 0;  // 0: as --threads says
    Engine engine = Engine::tile;
    int packet = 0;    // rays traced together
    bool slow = false; // not with --quick
    float alpha_lin = 0.3f;
    int key_lights = 0; // made ones, above the scene
    int quads = 0;      // area lights behind the eye, each lighting every pixel
    const char* area_way = "ltc";
    int frame_map = kFrameGramSchmidt;
    bool background = true;  // drawn where nothing is
    double along = 0.0;      // of a row of workloads that differ in one number: that number
    bool only_named = false; // drawn only where --only names it or its group
};

enum class Measure {
    cpu_ms,       // CPU time of a frame
    cpu_ratio,    // of `workload` to `base`
    cpu_more,     // of `workload` beyond `base`, ns a pixel
    speedup,      // wall time of `base` to that of `workload`
    times_faster, // CPU time of the fastest of `base...` to that of `workload`
    unit_spread,  // largest to smallest CPU time per unit over the workloads that begin with `workload`
};

struct Aim {
    const char* group;
    const char* what;
    Measure measure;
    const char* workload;
    const char* base; // the other one, or the beginning of the others' names; empty: none
    double limit;     // at most; for speedup and times_faster at least
};

const std::vector<Workload>& workloads();
void append_growth(std::vector<Workload>& table); // part of workloads()
const std::vector<Aim>& aims();
inline bool at_least(Measure m)
{
    return m == Measure::speedup || m == Measure::times_faster;
}

} // namespace burnish
