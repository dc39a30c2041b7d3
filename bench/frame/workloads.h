// The table of workloads and their aims: data only.
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
    const char* group; // workloads of a group run in turn: A B A B
    BenchScene scene;
    std::int64_t size = 0; // size of the scene
    int width = 1920, height = 1080, msaa = 1;
    const char* technique = "bent_normal";
    int samples = 0;  // 0: the technique's default
    float eta = 0.0f; // replaces the material's where nonzero, with roughness
    int threads = 0;  // 0: as --threads says
    Engine engine = Engine::tile;
    int packet = 0;    // rays traced together
    bool slow = false; // skipped by --quick
    float roughness = 0.3f;
    int extracted_lights = 0; // synthetic ones, above the scene
    int quads = 0;            // area lights behind the eye; each lights every pixel
    const char* area_way = "ltc";
    int light_samples = 16; // on each quad, for area_way mc
    int frame_map = kFrameGramSchmidt;
    bool background = true;  // drawn where no surface is
    double along = 0.0;      // in a series of workloads that differ in one number: this number
    bool only_named = false; // runs only where --only names the workload or its group
};

enum class Measure {
    cpu_ms,       // a frame's CPU time
    cpu_ratio,    // CPU time, `workload` / `base`
    cpu_more,     // CPU time, `workload` - `base`, ns for each pixel
    speedup,      // wall time, `base` / `workload`
    times_faster, // CPU time, fastest of `base...` / `workload`
    unit_spread,  // largest / smallest CPU time for a unit, over workloads whose names begin with `workload`
};

struct Aim {
    const char* group;
    const char* what;
    Measure measure;
    const char* workload;
    const char* base; // the other workload, or a prefix of the others' names; empty: none
    double limit;     // upper limit; lower limit for speedup and times_faster
};

const std::vector<Workload>& workloads();
void append_growth(std::vector<Workload>& table); // part of workloads()
const std::vector<Aim>& aims();
inline bool at_least(Measure m)
{
    return m == Measure::speedup || m == Measure::times_faster;
}

} // namespace burnish
