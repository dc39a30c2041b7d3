// Monte Carlo integration of pixels, kLanes camera positions at a time. Compiled once per instruction set. Each sample estimates
// environment light twice, with a direction from the environment and one from the lobe, weighted by the power heuristic (Veach 1997,
// section 9.2).
#include "core/simd/ticks.h"
#include "raster/reference/hits.h"
#include "raster/reference/light_sampling.h"
#include "raster/reference/reference_types.h"
#include "raster/reference/samples.h"
#include "raster/reference/surface_bsdf.h"
#include "shading/lights/area_picture.t.h"
#include "shading/lights/area_sample.t.h"
#include "shading/lights/punctual.t.h"
#include "shading/surface/coating_point.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

namespace {

static_assert(kPassPositions % kLanes == 0 && kRays >= kLanes);

// Returns the weight of a direction drawn with density `own`. The other strategy draws it with density `other`.
BN_INLINE real power_weight(real own, real other)
{
    const real ratio = other / max(own, lit(1e-20));
    return lit(1.0) / (lit(1.0) + ratio * ratio);
}

BN_INLINE mask any_light(real3 c)
{
    return max(c.x, max(c.y, c.z)) > lit(0.0);
}

struct EnvironmentEstimate {
    real3 wi;
    real3 value; // BRDF, cosine, radiance and weight, over the density
};

BN_INLINE EnvironmentEstimate by_environment(const ReferenceParams& f, const SurfaceBsdf& r, real2 xi)
{
    const LightSample l = sample_environment(f.sampler, xi);
    const Reflection at = reflect(r, l.wi);
    const real weight = f.strategy == ReferenceStrategy::mis ? power_weight(l.pdf, at.pdf) : lit(1.0);
    const real inv = select(l.pdf > lit(0.0), weight / max(l.pdf, lit(1e-20)), lit(0.0));
    return {l.wi, at.value * environment_radiance(f, l.wi) * inv};
}

// Returns the weight of environment light along a lobe's sample.
BN_INLINE real lobe_weight(const ReferenceParams& f, const SurfaceBsdfSample& s)
{
    if (f.strategy == ReferenceStrategy::brdf)
        return lit(1.0);
    const real weight = f.strategy == ReferenceStrategy::mis ? power_weight(s.pdf, environment_pdf(f.sampler, s.wi)) : lit(0.0);
    return select(s.exact, lit(1.0), weight);
}

// Estimates environment light without occlusion.
BN_INLINE real3 open_light(const ReferenceParams& f, const SurfaceBsdf& r, const ShadeSample& x, const SurfaceBsdfSample& s)
{
    real3 sum = vec3_all(lit(0.0));
    if (f.strategy != ReferenceStrategy::brdf)
        sum = by_environment(f, r, x.light).value;
    const real weight = lobe_weight(f, s);
    return sum + s.weight * environment_radiance(f, s.wi) * weight;
}

// Returns the lanes that see the environment through one interface without occlusion. Path mode has no such lanes: paths continue to the
// place where light leaves.
BN_INLINE mask sees_through(const ReferenceParams& f, const SurfaceBsdf& r, real3 wi)
{
    if (!r.x.transmission.refracts || f.mode == ReferenceMode::path)
        return mask_from_bits(0);
    return both(r.refracts, k_dot3(r.x.geometric_axes.n, wi) < lit(0.0));
}

// Returns a ray that leaves a surface. Its origin is lifted off the surface by the possible rounding error.
BN_INLINE LaneRays leaving_ray(const ReferenceParams& f, const LaneSurface& s, real3 wi)
{
    const real size = max(abs(s.position.x), max(abs(s.position.y), abs(s.position.z)));
    const real lift = size * lit(2e-6) + splat(f.ray_epsilon);
    LaneRays r;
    r.origin = s.position + s.normal * select(k_dot3(s.normal, wi) < lit(0.0), -lift, lift);
    r.direction = wi;
    r.tnear = lit(0.0); // the origin is lifted: any nearer hit counts, such as a wall in a corner
    r.tfar = splat(__builtin_inff());
    return r;
}

struct CoatingUnderLamps { // a coating's point and lobe for punctual lights
    shaded_point point;
    bsdf_lobe lobe;
};

BN_INLINE CoatingUnderLamps coating_under_lamps(const ReferenceParams& f, const SurfaceBsdf& r, int at)
{
    CoatingUnderLamps c;
    if (!has_coating(r, at))
        return c;
    const coating& layer = r.coats[at];
    dfg_value albedo = {lit(1.0), lit(0.0)};
#define BN_COATING(id, bit, strength, lobe)                                                                                                \
    if (at == (bit))                                                                                                                       \
        albedo = id##_albedo(f, layer, coating_n_dot_v(layer, r.x.s.v));
#include "shading/coatings.def"
    make_coating_point(layer, albedo, r.x.geometric_axes, r.x.s.v, r.x.s.occlusion, false, c.point);
    c.lobe = bsdf_lobe_under_lights(kCoatingLobes[at], c.point.lobe, c.point.s, c.point.geometric_axes);
    return c;
}

BN_INLINE real3 coating_lit(const ReferenceParams& f, const coating& c, const CoatingUnderLamps& at, const light_sample& towards, int light)
{
    const punctual_light shone = light_from(f, at.point, at.lobe, vec3_all(lit(0.0)), towards, light);
    return select(k_dot3(c.horizon, shone.l) > lit(0.0), shone.radiance, vec3_all(lit(0.0)));
}

// Sums punctual lights, with occlusion unless the mode is direct.
BN_STAGE real3 punctual_lights(const PixelFrame& p, const LaneSurface& s)
{
    const ReferenceParams& f = p.f;
    const bsdf_lobe lobe = bsdf_lobe_under_lights(f.lobe, s.r.x.lobe, s.r.x.s, s.r.x.geometric_axes);
    rough_interface through;
    if (s.r.x.transmission.refracts)
        through = rough_interface_at(s.r.x);
    CoatingUnderLamps coatings[kCoatings];
    for (int k = 0; k < kCoatings; ++k)
        coatings[k] = coating_under_lamps(f, s.r, k);
    real3 sum = vec3_all(lit(0.0));
    for (int i = 0; i < f.light_count; ++i) {
        const LightRecord& l = f.lights[i];
        const light_sample towards = light_towards(f, s.position, i);
        // Evaluate lobe, interface and coatings
        punctual_light light = light_from(f, s.r.x, lobe, s.r.diffuse, towards, i);
        if (s.r.x.transmission.refracts)
            light.radiance =
                select(s.r.refracts, light_from_interface(f, s.r.x, through, s.r.diffuse, towards, i).radiance, light.radiance);
        mask lit_lanes = both(both(s.reflects, k_dot3(s.r.horizon, light.l) > lit(0.0)), any_light(light.radiance));
        for (int k = 0; k < kCoatings; ++k) {
            if (!has_coating(s.r, k))
                continue;
            light.radiance = select(lit_lanes, light.radiance * (lit(1.0) - s.r.coats[k].share), vec3_all(lit(0.0)));
            light.radiance = light.radiance + coating_lit(f, s.r.coats[k], coatings[k], towards, i);
            lit_lanes = both(s.reflects, any_light(light.radiance));
        }
        // In path mode, light from behind enters through the interface
        if (s.r.x.transmission.refracts && f.mode == ReferenceMode::path) {
            const mask behind = both(both(s.reflects, s.r.refracts), k_dot3(s.r.x.geometric_axes.n, light.l) < lit(0.0));
            const real3 arriving = splat3(l.radiant) * towards.attenuation;
            light.radiance = select(behind, reflect(s.r, light.l).value * arriving, light.radiance);
            lit_lanes = either(both(lit_lanes, not_(behind)), both(behind, any_light(light.radiance)));
        }
        // Trace a shadow ray
        if (f.mode != ReferenceMode::direct && any(lit_lanes)) {
            LaneRays r = leaving_ray(f, s, light.l);
            if (!l.directional)
                r.tfar = k_length3(splat3(l.position) - s.position) * lit(0.99999);
            lit_lanes = both(lit_lanes, not_(find_hits(p, r, lit_lanes, RayKind::occlusion).found));
        }
        sum = sum + select(lit_lanes, light.radiance, vec3_all(lit(0.0)));
    }
    return sum;
}

struct LobeRay { // ray along a lobe's sample, and its hit
    const LaneRays& ray;
    const LaneHits& hits;
};

// Nearer hits than this part of the distance hide a light. The remainder belongs to the object that carries the light.
constexpr double kWayToLight = 0.9999;

// Returns the lanes that see the sampled point on an area light. The ray ends at exactly that point. It starts off the surface, so a
// parallel ray would meet a grazed light elsewhere.
BN_STAGE mask sees_light(const PixelFrame& p, const LaneSurface& s, const area_sample& l, int light, mask wanted)
{
    LaneRays r = leaving_ray(p.f, s, l.wi);
    const real3 way = s.position + l.wi * l.distance - r.origin;
    const real distance = k_length3(way);
    r.direction = way / max(distance, lit(1e-20));
    r.tfar = distance * lit(kWayToLight);
    const mask traced = both(wanted, not_(sees_through(p.f, s.r, l.wi)));
    const LaneHits h = find_hits(p, r, traced, p.f.solid_lights ? RayKind::bounce : RayKind::occlusion);
    return both(wanted, either(not_(h.found), hits_light(p.f, h, light)));
}

// Returns the lanes whose ray hits something before the light in its direction. Both distances count from the ray's origin.
BN_STAGE mask hides_light(const ReferenceParams& f, const LobeRay& b, const area_sample& met, int light)
{
    const area_sample there = area_along(f, light, b.ray.origin, b.ray.direction);
    const real distance = select(there.pdf > lit(0.0), there.distance, met.distance);
    return both(both(b.hits.found, b.hits.t < distance * lit(kWayToLight)), not_(hits_light(f, b.hits, light)));
}

// Sums area lights. Each light is sampled by a point on it, and by the lobe's sample if that meets the light. traced: the lobe sample's
// ray, or null without occlusion.
BN_STAGE real3 area_lights(const PixelFrame& p, const LaneSurface& s, const SurfaceBsdfSample& b, const LobeRay* traced, integer position,
                           int shade, int vertex)
{
    const ReferenceParams& f = p.f;
    const real3 zero = vec3_all(lit(0.0));
    real3 sum = zero;
    for (int i = 0; i < f.area_light_count; ++i) {
        const auto radiance = [&](const area_sample& l) { return area_radiance_at(f, i, s.position + l.wi * l.distance); };
        // Sample a point on the light
        if (f.strategy != ReferenceStrategy::brdf) {
            const area_sample l =
                area_sample_at(f, i, s.position, area_light_point(*f.sobol, p.seed, position, shade, f.shades, vertex, i));
            const Reflection at = reflect(s.r, l.wi);
            const real weight = f.strategy == ReferenceStrategy::mis ? power_weight(l.pdf, at.pdf) : lit(1.0);
            const real3 value = at.value * radiance(l) * (weight / max(l.pdf, lit(1e-20)));
            mask seen = both(both(s.reflects, l.pdf > lit(0.0)), any_light(value));
            if (traced && any(seen))
                seen = sees_light(p, s, l, i, seen);
            sum = sum + select(seen, value, zero);
        }
        // Weigh the lobe's sample
        if (f.strategy == ReferenceStrategy::light && none(b.exact))
            continue;
        const area_sample met = area_along(f, i, s.position, b.wi);
        real weight =
            f.strategy == ReferenceStrategy::mis ? power_weight(b.pdf, met.pdf) : lit(f.strategy == ReferenceStrategy::brdf ? 1.0 : 0.0);
        weight = select(b.exact, lit(1.0), weight);
        mask seen = both(s.reflects, met.pdf > lit(0.0));
        if (traced && any(both(seen, traced->hits.found)))
            seen = both(seen, not_(hides_light(f, *traced, met, i)));
        sum = sum + select(seen, b.weight * radiance(met) * weight, zero);
    }
    return sum;
}

// Lets an interface that disperses refract one channel of light, which each path chooses once. single: lanes whose path has one channel;
// receives those that meet such an interface here. Returns the factor on the path's light.
BN_STAGE real3 refract_one_channel(const PixelFrame& p, SurfaceBsdf& r, integer position, int shade, mask& single)
{
    const integer path = position * int_lit(p.f.shades) + int_lit(shade);
    const real u = k_unit_from_bits(k_hash_u32(k_hash_u32(path) ^ int_lit(static_cast<std::int32_t>(p.seed))));
    const real channel = min(floor(u * lit(3.0)), lit(2.0));
    const mask disperses = both(r.refracts, r.x.transmission.inputs.dispersion > lit(0.0));
    const interface_inputs own = interface_of_channel(r.x.transmission.inputs, channel);
    r.x.transmission.inputs.parts = select_parts(disperses, own.parts, r.x.transmission.inputs.parts);
    const mask first = both(disperses, not_(single));
    const auto part = [&](double at) { return select(first, select(channel == lit(at), lit(3.0), lit(0.0)), lit(1.0)); };
    single = either(single, disperses);
    return vec3_of(part(0.0), part(1.0), part(2.0));
}

// Integrates environment light with occlusion, and with bounces the light from other surfaces.
BN_STAGE real3 traced_light(const PixelFrame& p, const LaneSurface& first, integer position, int shade)
{
    const ReferenceParams& f = p.f;
    const real3 zero = vec3_all(lit(0.0));
    const int bounces = f.mode == ReferenceMode::path ? f.bounces : 0;
    real3 sum = zero, throughput = vec3_all(lit(1.0));
    LaneSurface s = first;
    mask single = mask_from_bits(0);
    for (int depth = 0; any(s.reflects); ++depth) {
        if (s.r.x.transmission.disperses)
            throughput = throughput * refract_one_channel(p, s.r, position, shade, single);
        const ShadeSample x = shade_sample(*f.sobol, p.seed, position, shade, f.shades, depth);
        // Sample the environment
        if (f.strategy != ReferenceStrategy::brdf && !f.lights_only) {
            const EnvironmentEstimate e = by_environment(f, s.r, x.light);
            const real3 value = throughput * e.value;
            const mask wanted = both(s.reflects, any_light(value));
            if (any(wanted)) {
                const mask traced = both(wanted, not_(sees_through(f, s.r, e.wi)));
                const mask blocked = find_hits(p, leaving_ray(f, s, e.wi), traced, RayKind::occlusion).found;
                sum = sum + select(both(wanted, not_(blocked)), value, zero);
            }
        }
        // Sample the lobe, and trace its ray
        const SurfaceBsdfSample b = sample_surface_bsdf(s.r, x.lobe, x.choice);
        const mask wanted = both(s.reflects, any_light(b.weight));
        if (none(wanted) && f.area_light_count == 0)
            break;
        const bool last = depth == bounces;
        const LaneRays r = leaving_ray(f, s, b.wi);
        const mask traced = both(wanted, not_(sees_through(f, s.r, b.wi)));
        const LaneHits h = find_hits(p, r, traced, last && f.area_light_count == 0 ? RayKind::occlusion : RayKind::bounce);
        if (f.area_light_count > 0) { // all lights along the ray, which passes through open ones
            const LobeRay along = {r, h};
            sum = sum + throughput * area_lights(p, s, b, &along, position, shade, depth);
        }
        const real3 carried = throughput * b.weight;
        if (f.lights_only)
            break;
        // Add the environment where the ray is free
        const real3 outside = carried * environment_radiance(f, b.wi) * lobe_weight(f, b);
        sum = sum + select(both(wanted, not_(h.found)), outside, zero);
        if (last || none(h.found))
            break;
        // Continue at the next surface
        find_surface(f, h, r, nullptr, s);
        const real3 decay = s.decay * h.t;
        const real3 left = vec3_of(k_exp2(decay.x), k_exp2(decay.y), k_exp2(decay.z));
        throughput = select(h.found, carried * left, zero);
        real3 at_surface = select(s.emitter, zero, s.emission); // area_lights() has added a solid light
        if (f.light_count > 0 && any(s.reflects))
            at_surface = at_surface + punctual_lights(p, s);
        sum = sum + select(h.found, throughput * at_surface, zero);
    }
    return sum;
}

// Integrates light without occlusion.
BN_STAGE real3 direct_light_of(const PixelFrame& p, const LaneSurface& s, integer position, int shade)
{
    const ReferenceParams& f = p.f;
    const ShadeSample x = shade_sample(*f.sobol, p.seed, position, shade, f.shades, 0);
    const SurfaceBsdfSample b = sample_surface_bsdf(s.r, x.lobe, x.choice);
    const real3 light = f.lights_only ? vec3_all(lit(0.0)) : open_light(f, s.r, x, b) * s.r.x.s.occlusion;
    if (f.area_light_count == 0)
        return light;
    return light + area_lights(p, s, b, nullptr, position, shade, 0);
}

BN_STAGE real3 direct_light(const PixelFrame& p, const LaneSurface& s, integer position, int shade)
{
    if (!s.r.x.transmission.disperses)
        return direct_light_of(p, s, position, shade);
    LaneSurface own = s;
    mask single = mask_from_bits(0);
    const real3 channel = refract_one_channel(p, own.r, position, shade, single);
    return direct_light_of(p, own, position, shade) * channel;
}

// Returns the sum over the shades at a pixel's camera positions `first`, first + 1... in lanes.
BN_STAGE real3 radiance_at_positions(const PixelFrame& p, int x, int y, int first)
{
    const ReferenceParams& f = p.f;
    const integer position = iota() + int_lit(first);
    const real2 in_pixel = camera_position(*f.sobol, p.seed, position);
    const real px = splat(static_cast<float>(x + f.left)) + in_pixel.x, py = splat(static_cast<float>(y + f.top)) + in_pixel.y;
    const LaneRays rays = camera_rays(f, px, py);
    // Derivatives come from the neighbour in the same quad of 2x2 pixels, as in the rasterizer.
    const LaneRays neighbours[2] = {camera_rays(f, px + splat(x & 1 ? -1.0f : 1.0f), py),
                                    camera_rays(f, px, py + splat(y & 1 ? -1.0f : 1.0f))};
    const LaneRays* footprint = f.full_textures ? nullptr : neighbours;
    const mask everything = mask_from_bits((1u << kLanes) - 1u);
    const LaneHits h = find_hits(p, rays, everything, RayKind::camera, footprint);
    LaneSurface s;
    find_surface(f, h, rays, footprint, s);
    // Add emission and background once per camera position
    const real3 zero = vec3_all(lit(0.0));
    real3 once = zero;
    if (any(h.found) && !f.lights_only)
        once = select(h.found, s.emission, zero);
    if (f.background && !all(h.found))
        once = select(h.found, once, environment_radiance(f, rays.direction));
    real3 sum = once * to_real(int_lit(f.shades));
    if (none(s.reflects))
        return sum;
    // Add lights and reflected light
    if (f.light_count > 0)
        sum = sum + punctual_lights(p, s) * to_real(int_lit(f.shades));
    if (f.lights_only && f.area_light_count == 0)
        return sum;
    for (int shade = 0; shade < f.shades; ++shade) {
        const real3 light = f.mode == ReferenceMode::direct ? direct_light(p, s, position, shade) : traced_light(p, s, position, shade);
        sum = sum + select(s.reflects, light, zero);
    }
    return sum;
}

// Returns the state of one pass.
PixelState state_of_pass(const ReferenceParams& f, ReferenceScratch& scratch, int x, int y, std::uint32_t pass)
{
    const std::uint32_t pixel =
        hash_seed(hash_seed(hash_seed(0x62726e73u, static_cast<std::uint32_t>(f.seed)), static_cast<std::uint32_t>(x + f.left)),
                  static_cast<std::uint32_t>(y + f.top));
    float channel[3][kPassPositions];
    for (int first = 0; first < kPassPositions; first += kLanes) {
        const PixelFrame p = {f, scratch, hash_seed(pixel, pass), first};
        const real3 c = radiance_at_positions(p, x, y, first);
        store(channel[0] + first, c.x), store(channel[1] + first, c.y), store(channel[2] + first, c.z);
    }
    PixelState state = {};
    for (int c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (int i = 0; i < kPassPositions; ++i)
            sum += static_cast<double>(channel[c][i]);
        state.mean[c] = sum / (kPassPositions * f.shades);
    }
    return state;
}

void add_passes_to_pixel(const ReferenceParams& f, const PixelBlock& b, ReferenceScratch& scratch, int x, int y, PixelState* const* sums)
{
    const std::ptrdiff_t pixel = static_cast<std::ptrdiff_t>(y) * f.width + x - static_cast<std::ptrdiff_t>(b.first_pixel);
    PixelState own[kMostSums];
    for (int k = 0; k < kMostSums; ++k)
        if (b.done >> k & 1u)
            own[k] = sums[k][pixel];
    for (std::uint32_t pass = b.done; pass < b.done + b.passes; ++pass)
        add_sum(own, pass, 0, state_of_pass(f, scratch, x, y, b.first_pass + pass));
    if (b.totals) {
        b.totals[pixel] = total_of_sums(own, b.done + b.passes);
        return;
    }
    for (int k = 0; k < kMostSums; ++k)
        if ((b.done + b.passes) >> k & 1u)
            sums[k][pixel] = own[k];
}

void add_passes(const ReferenceParams& f, const PixelBlock& b, ReferenceScratch& scratch, PixelState* const* sums)
{
    const std::uint64_t begin = ticks();
    for (int y = b.y0; y < b.y0 + b.height; ++y)
        for (int x = b.x0; x < b.x0 + b.width; ++x)
            add_passes_to_pixel(f, b, scratch, x, y, sums);
    scratch.count.all_ticks += ticks() - begin;
}

void trace_row(const ReferenceParams& f, int y, const SamplePattern& pattern, ReferenceScratch& scratch, std::uint32_t* ids, float* through)
{
    const int count = f.width * pattern.count;
    for (int first = 0; first < count; first += kLanes) {
        float px[kLanes], py[kLanes];
        for (int i = 0; i < kLanes; ++i) {
            const int at = first + i < count ? first + i : first, sample = at % pattern.count;
            px[i] = static_cast<float>(at / pattern.count + f.left) + static_cast<float>(pattern.x[sample]) * (1.0f / kSubpixel);
            py[i] = static_cast<float>(y + f.top) + static_cast<float>(pattern.y[sample]) * (1.0f / kSubpixel);
        }
        const PixelFrame p = {f, scratch, hash_seed(static_cast<std::uint32_t>(f.seed), static_cast<std::uint32_t>(y + f.top)), 0};
        const LaneRays rays = camera_rays(f, load(px), load(py));
        const mask everything = mask_from_bits((1u << kLanes) - 1u);
        real passed;
        const LaneHits h = find_solid_hits(p, rays, everything, passed);
        std::int32_t id[kLanes];
        float share[kLanes];
        store_int(id, select(h.found, h.triangle, int_lit(-1)));
        store(share, passed);
        for (int i = 0; i < kLanes && first + i < count; ++i) {
            ids[first + i] = static_cast<std::uint32_t>(id[i]);
            if (through)
                through[first + i] = share[i];
        }
    }
}

constexpr ReferenceFns kFns = {add_passes, trace_row};

} // namespace

BN_DEFINE_FNS(ReferenceFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
