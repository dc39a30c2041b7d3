// Benchmark scenes made in code: equal bits on every machine.
#pragma once
#include <cstdint>

#include "core/scene/scene.h"
#include "raster/frame/frame.h"

namespace burnish {

enum class BenchScene {
    constant, // one unlit quad over the whole image: every pixel has one colour
    waves,    // an unlit, slightly wavy sheet over the whole image, with about `size` triangles
    layers,   // `size` sheets of brushed metal, each over the whole image, drawn from back to front
    sphere,   // the inside of a brushed metal sphere around the eye: every pixel covered, every direction reflected
    eighth,   // the sphere's middle only: an eighth of all pixels
    teapot,   // builtin:teapot, framed like `burnish render`
    textured, // a sheet of brushed metal with the first `size` of 6 textures: colour, normal, roughness, occlusion, direction, zero heights
    floor,    // a floor with three textures, from below the eye to the horizon
    foliage,  // `size` leaves all over the image: quads with alpha-tested textures
    leaves,   // the quads of foliage, opaque
    slivers,  // `size` diagonal triangles, a thousand pixels long and up to 3.3 wide at 1920x1080
    lit,      // a sheet of brushed metal under `size` point lights: up to 4 with unlimited range; of more, about 4 reach a point
    crowd,    // `size` triangles within 120 x 120 pixels at 1920x1080
    materials // a sheet of 256 x 144 quads with `size` materials in turn
};

// Makes a scene. size: triangles of `waves`, sheets of `layers` and so on; unused by the others. Sheets fill a width x
// height image seen by bench_view().
Scene make_bench_scene(BenchScene kind, std::int64_t size, int width, int height);
View bench_view(BenchScene kind, const DrawTables& tables, int width, int height);

} // namespace burnish
