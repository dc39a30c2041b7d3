// The scenes that benchmarks draw, made in code: the same bits on every machine.
#pragma once
#include <cstdint>

#include "core/scene/scene.h"
#include "raster/frame/frame.h"

namespace burnish {

enum class BenchScene {
    constant, // one unlit quad over the whole picture: every pixel the same colour
    waves,    // an unlit, slightly wavy sheet over the whole picture, of about `size` triangles
    layers,   // `size` sheets of brushed metal, each over the whole picture, drawn from the farthest to the nearest
    sphere,   // the inside of a sphere of brushed metal around the eye: every pixel covered, every direction reflected
    teapot    // builtin:teapot, framed as `burnish render` does
};

// size: triangles of `waves`, sheets of `layers`; the others have none. Sheets fill a picture of width x height seen by bench_view().
Scene make_bench_scene(BenchScene kind, std::int64_t size, int width, int height);
View bench_view(BenchScene kind, const DrawTables& tables, int width, int height);

} // namespace burnish
