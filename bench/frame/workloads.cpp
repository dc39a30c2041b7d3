#include "bench/frame/workloads.h"

#include <string_view>
#include <tuple>

namespace burnish {
namespace {

std::vector<Workload> all_workloads()
{
    using S = BenchScene;
    constexpr int W = 1920, H = 1080;
    std::vector<Workload> table = {
        {"trivial_1x", "trivial", S::constant, 0, W, H, 1},
        {"trivial_8x", "trivial", S::constant, 0, W, H, 8},
        // Depth alone cannot be drawn. One unlit colour comes nearest, and includes each pixel's visibility, listing
        // and resolve.
        {"triangles_1m_1x", "triangles", S::waves, 1036800, W, H, 1},
        {"triangles_1m_4x", "triangles", S::waves, 1036800, W, H, 4},
        {"teapot_1x", "msaa", S::teapot, 0, W, H, 1},
        {"teapot_8x", "msaa", S::teapot, 0, W, H, 8},
        {"layers_1", "overdraw", S::layers, 1, W, H, 1},
        {"layers_10", "overdraw", S::layers, 10, W, H, 1},
        {"bent_normal_eta05", "samples", S::sphere, 0, W, H, 1, "bent_normal", 0, 0.5f},
        {"bent_normal_eta08", "samples", S::sphere, 0, W, H, 1, "bent_normal", 0, 0.8f},
        {"split_isotropic", "samples", S::sphere, 0, W, H, 1, "split_isotropic"},
        {"major_axis_16_eta05", "samples", S::sphere, 0, W, H, 1, "major_axis", 16, 0.5f},
        {"major_axis_16_eta08", "samples", S::sphere, 0, W, H, 1, "major_axis", 16, 0.8f},
        {"adaptive_eta05", "samples", S::sphere, 0, W, H, 1, "major_axis_adaptive", 16, 0.5f},
        {"adaptive_eta08", "samples", S::sphere, 0, W, H, 1, "major_axis_adaptive", 16, 0.8f},
        {"weighted_16_eta05", "samples", S::sphere, 0, W, H, 1, "major_axis_weighted", 16, 0.5f},
        {"weighted_16_eta08", "samples", S::sphere, 0, W, H, 1, "major_axis_weighted", 16, 0.8f},
        // Exponents 20 and 400.
        {"as_mc_60", "phong", S::sphere, 0, W, H, 1, "as_mc", 60, 0.634f, 0, Engine::tile, 0, false, 0.37f},
        {"as_mc_200", "phong", S::sphere, 0, W, H, 1, "as_mc", 200, 0.634f, 0, Engine::tile, 0, true, 0.37f},
        {"as_mc_60_eighth", "phong", S::eighth, 0, W, H, 1, "as_mc", 60, 0.634f, 0, Engine::tile, 0, false, 0.37f},
        {"detail_plain", "detail", S::textured, 5, W, H, 1},
        {"detail_quaternion", "detail", S::textured, 5, W, H, 1},
        {"detail_parallax", "detail", S::textured, 6, W, H, 1}, // a mean of 16 steps for each fragment
        {"textures_0", "textures", S::textured, 0, W, H, 1},
        {"textures_1", "textures", S::textured, 1, W, H, 1},
        {"textures_5", "textures", S::textured, 5, W, H, 1},
        {"floor_3", "textures", S::floor, 0, W, H, 1},
        {"leaves_50k", "foliage", S::leaves, 50000, W, H, 1},
        {"foliage_50k", "foliage", S::foliage, 50000, W, H, 1},
        {"slivers_10k", "slivers", S::slivers, 10000, W, H, 1},
        {"lights_4", "lights", S::lit, 4, W, H, 1},
        {"lights_50", "lights", S::lit, 50, W, H, 1},
        {"materials_1", "materials", S::materials, 1, W, H, 1},
        {"materials_1000", "materials", S::materials, 1000, W, H, 1},
        {"one_thread_crowd_8x", "crowd", S::crowd, 980000, W, H, 8, "bent_normal", 0, 0.0f, 1},
        {"two_threads_crowd_8x", "crowd", S::crowd, 980000, W, H, 8, "bent_normal", 0, 0.0f, 2},
        {"one_thread_trivial_8x", "threads", S::constant, 0, W, H, 8, "bent_normal", 0, 0.0f, 1},
        {"two_threads_trivial_8x", "threads", S::constant, 0, W, H, 8, "bent_normal", 0, 0.0f, 2},
        {"one_thread_triangles", "threads", S::waves, 1036800, W, H, 1, "bent_normal", 0, 0.0f, 1},
        {"two_threads_triangles", "threads", S::waves, 1036800, W, H, 1, "bent_normal", 0, 0.0f, 2},
        {"one_thread_triangles_4x", "threads", S::waves, 1036800, W, H, 4, "bent_normal", 0, 0.0f, 1},
        {"two_threads_triangles_4x", "threads", S::waves, 1036800, W, H, 4, "bent_normal", 0, 0.0f, 2},
        {"one_thread_teapot_8x", "threads", S::teapot, 0, W, H, 8, "bent_normal", 0, 0.0f, 1},
        {"two_threads_teapot_8x", "threads", S::teapot, 0, W, H, 8, "bent_normal", 0, 0.0f, 2},
        {"one_thread_layers_10", "threads", S::layers, 10, W, H, 1, "bent_normal", 0, 0.0f, 1},
        {"two_threads_layers_10", "threads", S::layers, 10, W, H, 1, "bent_normal", 0, 0.0f, 2},
        {"one_thread_bent_normal", "threads", S::sphere, 0, W, H, 1, "bent_normal", 0, 0.5f, 1},
        {"two_threads_bent_normal", "threads", S::sphere, 0, W, H, 1, "bent_normal", 0, 0.5f, 2},
        {"one_thread_major_axis", "threads", S::sphere, 0, W, H, 1, "major_axis", 16, 0.5f, 1},
        {"two_threads_major_axis", "threads", S::sphere, 0, W, H, 1, "major_axis", 16, 0.5f, 2},
        {"one_thread_adaptive", "threads", S::sphere, 0, W, H, 1, "major_axis_adaptive", 16, 0.8f, 1},
        {"two_threads_adaptive", "threads", S::sphere, 0, W, H, 1, "major_axis_adaptive", 16, 0.8f, 2},
        // The image grows with the triangles, so that each triangle keeps its 2 pixels: the unit is one such triangle.
        {"triangles_1e4", "triangle_count", S::waves, 10000, 192, 104, 1},
        {"triangles_1e5", "triangle_count", S::waves, 100000, 600, 336, 1},
        {"triangles_1e6", "triangle_count", S::waves, 1000000, 1888, 1064, 1},
        {"triangles_1e7", "triangle_count", S::waves, 10000000, 5968, 3352, 1, "bent_normal", 0, 0.0f, 0, Engine::tile, 0, true},
        {"pixels_0m25", "pixel_count", S::sphere, 0, 672, 384, 1, "bent_normal", 0, 0.5f},
        {"pixels_2m", "pixel_count", S::sphere, 0, W, H, 1, "bent_normal", 0, 0.5f},
        {"pixels_8m", "pixel_count", S::sphere, 0, 3840, 2160, 1, "bent_normal", 0, 0.5f},
        {"pixels_33m", "pixel_count", S::sphere, 0, 7680, 4320, 1, "bent_normal", 0, 0.5f, 0, Engine::tile, 0, true},
        {"visibility_tile", "rays", S::waves, 1036800, W, H, 1},
        {"visibility_rays_1", "rays", S::waves, 1036800, W, H, 1, "", 0, 0.0f, 0, Engine::rays, 1},
        {"visibility_rays_8", "rays", S::waves, 1036800, W, H, 1, "", 0, 0.0f, 0, Engine::rays, 8},
        {"visibility_rays_16", "rays", S::waves, 1036800, W, H, 1, "", 0, 0.0f, 0, Engine::rays, 16},
    };
    for (const auto& [name, quads, way] : {std::tuple{"quads_0", 0, "ltc"},
                                           {"quads_1", 1, "ltc"},
                                           {"quads_4", 4, "ltc"},
                                           {"quads_16", 16, "ltc"},
                                           {"quads_64", 64, "ltc"},
                                           {"quads_1_isotropic", 1, "ltc-isotropic"}}) {
        Workload w{name, "area_lights", S::sphere, 0, W, H, 1, "bent_normal", 0, 0.5f};
        w.quads = quads, w.area_way = way;
        table.push_back(w);
    }
    for (Workload& w : table) {
        if (w.scene == S::eighth)
            w.background = false;
        if (w.name == std::string_view("detail_quaternion"))
            w.frame_map = kFrameQuaternion;
    }
    append_growth(table);
    return table;
}

} // namespace

const std::vector<Workload>& workloads()
{
    static const std::vector<Workload> table = all_workloads();
    return table;
}

const std::vector<Aim>& aims()
{
    using M = Measure;
    static const std::vector<Aim> table = {
        {"trivial", "constant colour, 1x", M::cpu_ms, "trivial_1x", "", 4.0},
        {"trivial", "constant colour, 8x", M::cpu_ms, "trivial_8x", "", 8.0},
        // A third of the CPU time of lavapipe (Mesa 22.3) for such a mesh, depth only, in ms.
        {"triangles", "1 M triangles of 2 pixels, one colour, 1x", M::cpu_ms, "triangles_1m_1x", "", 49.0 / 3.0},
        {"triangles", "1 M triangles of 2 pixels, one colour, 4x", M::cpu_ms, "triangles_1m_4x", "", 112.0 / 3.0},
        {"msaa", "teapot, bent_normal, 8x to 1x", M::cpu_ratio, "teapot_8x", "teapot_1x", 1.35},
        {"overdraw", "ten layers back to front, to one", M::cpu_ratio, "layers_10", "layers_1", 1.3},
        {"samples", "major_axis 16 to bent_normal, eta 0.5", M::cpu_ratio, "major_axis_16_eta05", "bent_normal_eta05", 3.0},
        {"samples", "major_axis 16 to bent_normal, eta 0.8", M::cpu_ratio, "major_axis_16_eta08", "bent_normal_eta08", 3.0},
        {"samples", "major_axis_adaptive to bent_normal, eta 0.5", M::cpu_ratio, "adaptive_eta05", "bent_normal_eta05", 1.5},
        {"samples", "major_axis_adaptive to bent_normal, eta 0.8", M::cpu_ratio, "adaptive_eta08", "bent_normal_eta08", 2.0},
        {"samples", "major_axis_weighted 16 to bent_normal, eta 0.5", M::cpu_ratio, "weighted_16_eta05", "bent_normal_eta05", 0.0},
        {"samples", "major_axis_weighted 16 to bent_normal, eta 0.8", M::cpu_ratio, "weighted_16_eta08", "bent_normal_eta08", 0.0},
        // A fifth of the CPU time of lavapipe (Mesa 22.3) for plain kernels of this lobe, in ms.
        {"phong", "as_mc, 60 samples", M::cpu_ms, "as_mc_60", "", 1655.0 / 5.0},
        {"phong", "as_mc, 200 samples", M::cpu_ms, "as_mc_200", "", 5362.0 / 5.0},
        {"phong", "as_mc, 60 samples, an eighth of the picture, to all of it", M::cpu_ratio, "as_mc_60_eighth", "as_mc_60", 1.15 / 8.0},
        {"detail", "quaternion frame, beyond Gram-Schmidt's", M::cpu_more, "detail_quaternion", "detail_plain", 1.0},
        {"detail", "parallax, 16 steps, beyond none", M::cpu_more, "detail_parallax", "detail_plain", 25.0},
        // An eighth of the CPU time of lavapipe (Mesa 22.3) for plain LTC kernels, in ms.
        {"area_lights", "one quad by transformed cosines", M::cpu_ms, "quads_1", "", 173.0 / 8.0},
        {"area_lights", "four quads", M::cpu_ms, "quads_4", "", 287.0 / 8.0},
        {"area_lights", "a quad by the round table, to none", M::cpu_ratio, "quads_1_isotropic", "quads_0", 0.0},
        {"area_lights", "a quad by the whole table, to none", M::cpu_ratio, "quads_1", "quads_0", 0.0},
        {"textures", "one texture, to none", M::cpu_ratio, "textures_1", "textures_0", 0.0},
        {"textures", "five textures, to none", M::cpu_ratio, "textures_5", "textures_0", 0.0},
        {"textures", "grazing floor, three textures", M::cpu_ms, "floor_3", "", 0.0},
        {"foliage", "50,000 leaves cut out by alpha, to opaque ones", M::cpu_ratio, "foliage_50k", "leaves_50k", 2.5},
        {"slivers", "10,000 diagonal slivers", M::cpu_ms, "slivers_10k", "", 0.0},
        {"lights", "50 lights of which 4 reach a point, to 4", M::cpu_ratio, "lights_50", "lights_4", 2.0},
        {"materials", "1000 materials in turn, to one", M::cpu_ratio, "materials_1000", "materials_1", 1.3},
        {"crowd", "threads 1 to 2: 980,000 triangles in four tiles, 8x", M::speedup, "two_threads_crowd_8x", "one_thread_crowd_8x", 1.8},
        {"threads", "threads 1 to 2: constant colour, 8x", M::speedup, "two_threads_trivial_8x", "one_thread_trivial_8x", 1.9},
        {"threads", "threads 1 to 2: 1 M triangles, 1x", M::speedup, "two_threads_triangles", "one_thread_triangles", 1.9},
        {"threads", "threads 1 to 2: 1 M triangles, 4x", M::speedup, "two_threads_triangles_4x", "one_thread_triangles_4x", 1.9},
        {"threads", "threads 1 to 2: teapot, 8x", M::speedup, "two_threads_teapot_8x", "one_thread_teapot_8x", 1.9},
        {"threads", "threads 1 to 2: ten layers", M::speedup, "two_threads_layers_10", "one_thread_layers_10", 1.9},
        {"threads", "threads 1 to 2: bent_normal", M::speedup, "two_threads_bent_normal", "one_thread_bent_normal", 1.9},
        {"threads", "threads 1 to 2: major_axis 16", M::speedup, "two_threads_major_axis", "one_thread_major_axis", 1.9},
        {"threads", "threads 1 to 2: major_axis_adaptive", M::speedup, "two_threads_adaptive", "one_thread_adaptive", 1.9},
        {"triangle_count", "time of a triangle of 2 pixels, most to least", M::unit_spread, "triangles_1e", "", 1.5},
        {"pixel_count", "time of a pixel, most to least", M::unit_spread, "pixels_", "", 1.5},
        {"rays", "visibility of 1 M triangles against rays", M::times_faster, "visibility_tile", "visibility_rays_", 3.0},
    };
    return table;
}

} // namespace burnish
