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
    eighth,   // what of it lies in the middle of the picture, an eighth of all pixels
    teapot,   // builtin:teapot, framed as `burnish render` does
    textured, // a sheet of brushed metal with `size` textures, of 6: colour, normal, roughness, occlusion, direction, heights without depth
    floor,    // a floor with three textures from below the eye to the horizon
    foliage,  // `size` leaves all over the picture, quads whose texture is cut out by alpha
    leaves,   // the same quads, opaque
    slivers,  // `size` diagonal triangles, a thousand pixels long and up to 3.3 wide at 1920x1080
    lit,      // a sheet of brushed metal under `size` point lights: up to 4 of them without end, of more about 4 reach a point
    crowd,    // `size` triangles within 120 x 120 pixels at 1920x1080
    materials // a sheet of 256 x 144 quads, of `size` materials in turn
};

// size: triangles of `waves`, sheets of `layers` and so on; the others have none. Sheets fill a picture of width x height seen by
// bench_view().
Scene make_bench_scene(BenchScene kind, std::int64_t size, int width, int height);
View bench_view(BenchScene kind, const DrawTables& tables, int width, int height);

} // namespace burnish
