#include "bench/micro/kernels.h"

#include "raster/tile/tile_types.h"
#include "shading/lang/techniques.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

BN_FN real3 load3(const float* const from[3], int i)
{
    return vec3_of(load(from[0] + i), load(from[1] + i), load(from[2] + i));
}

// Computes a surface's specular radiance for brushed metal.
template <Technique kTechnique> void run(const FrameParams& f, const KernelSurfaces& in, float* rgb)
{
    for (int i = 0; i < in.count; i += kLanes, rgb += 3 * kLanes) {
        const surface_frame frame = geometric_frame(load3(in.n, i), load3(in.t, i), lit(1.0));
        const aniso_lobe lobe = {frame.t, frame.b, splat(in.sigma_u), splat(in.sigma_v)};
        const real3 base = vec3_of(lit(0.9), lit(0.85), lit(0.8));
        const surface s = metallic_roughness_surface(frame.n, load3(in.v, i), base, lit(1.0), lobe_roughness(lobe), vec3_all(lit(0.04)),
                                                     lit(1.0), lit(1.0));
        shaded_point x = {};
        x.s = s, x.lobe = lobe, x.geometric_axes = frame;
        x.energy.albedo = s.f0, x.energy.gain = vec3_all(lit(1.0));
        x.pixel_id = iota() + int_lit(i);
        x.samples = in.samples;
        const real3 color = technique_specular(f, technique_tag<kTechnique>{}, x);
        store(rgb, color.x), store(rgb + kLanes, color.y), store(rgb + 2 * kLanes, color.z);
    }
}

constexpr KernelFn kTechniques[] = {
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary) run<Technique::id>,
#include "shading/models.def"
};

KernelWork work()
{
#ifdef BN_COUNTED
    return {lane_counts.operations, lane_counts.bytes};
#else
    return {0, 0};
#endif
}

constexpr KernelFns kFns = {kTechniques, work};

} // namespace

BN_DEFINE_FNS(KernelFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
