// From rays to surfaces: camera rays, tracing with transparency, and materials at hits, merged over lanes with different materials.
#pragma once
#include "core/simd/lanes.h"
#include "core/simd/ticks.h"
#include "raster/frame/lane_material.h"
#include "raster/reference/reference_types.h"
#include "raster/reference/surface_bsdf.h"
#include "shading/kernels/camera.t.h"
#include "shading/lights/background.t.h"
#include "shading/surface/coverage.t.h"
#include "shading/surface/facets.t.h"
#include "shading/surface/make_shaded_point.t.h"
#include "shading/surface/parallax.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct LaneRays {
    real3 origin, direction; // direction: unit; perspective camera rays have length 1 along the view instead
    real tnear, tfar;
};

struct LaneHits {
    mask found;
    integer triangle; // global id, 0 without a hit
    real u, v, t;     // the second and third vertices' weights; distance in direction lengths
};

struct PixelFrame { // a lane batch's context
    const ReferenceParams& f;
    ReferenceScratch& scratch;
    std::uint32_t seed; // for the pixel and pass
    int first;          // lane 0's camera position
};

// Makes camera rays. (px, py): pixels from the image's top left corner.
BN_INLINE LaneRays camera_rays(const ReferenceParams& f, real px, real py)
{
    const view_params view = view_params_of(f.view);
    LaneRays r;
    r.direction = ray_through(f, view, px, py);
    r.origin = view.eye;
    r.tnear = view.znear;
    r.tfar = splat(__builtin_inff());
    if (f.view.orthographic) {
        const real x = (px - splat(f.half_width)) / splat(f.half_width) / view.inv_tan_x;
        const real y = (splat(f.half_height) - py) / splat(f.half_height) / view.inv_tan_y;
        r.origin = view.eye + view.right * x + view.up * y;
        r.tfar = view.zfar;
    }
    return r;
}

// Traces the lanes in `wanted`, and counts rays and time.
BN_INLINE LaneHits trace_lanes(const PixelFrame& p, const LaneRays& r, mask wanted, RayKind kind)
{
    RayPacket& k = p.scratch.packet;
    store(k.org_x, r.origin.x), store(k.org_y, r.origin.y), store(k.org_z, r.origin.z);
    store(k.dir_x, r.direction.x), store(k.dir_y, r.direction.y), store(k.dir_z, r.direction.z);
    store(k.tnear, r.tnear), store(k.tfar, r.tfar);
    for (int i = 0; i < kRays; ++i)
        k.valid[i] = 0;
    store_int(k.valid, select(wanted, int_lit(-1), int_lit(0)));
    const std::uint64_t begin = ticks();
    p.f.trace(*p.f.rays, k, kind);
    p.scratch.count.ticks += ticks() - begin;
    p.scratch.count.rays += static_cast<std::uint64_t>(__builtin_popcount(to_bits(wanted)));
    LaneHits h;
    h.t = load(k.tfar);
    if (kind == RayKind::occlusion) {
        h.found = both(wanted, h.t < lit(0.0));
        h.triangle = int_lit(0);
        h.u = h.v = lit(0.0);
        return h;
    }
    h.found = both(wanted, load_int(k.geometry) != int_lit(-1));
    h.triangle = select(h.found, load_int(k.triangle), int_lit(0));
    h.u = select(h.found, load(k.u), lit(0.0));
    h.v = select(h.found, load(k.v), lit(0.0));
    return h;
}

struct LaneTriangle {
    integer vertex[3];
    real3 corner[3]; // world space
};

BN_INLINE LaneTriangle load_triangle(const ReferenceParams& f, integer triangle)
{
    LaneTriangle t;
    const integer first = triangle * int_lit(3);
    for (int k = 0; k < 3; ++k) {
        t.vertex[k] = gather_int(reinterpret_cast<const std::int32_t*>(f.indices), first + int_lit(k));
        t.corner[k] = vec3_of(gather(f.px, t.vertex[k]), gather(f.py, t.vertex[k]), gather(f.pz, t.vertex[k]));
    }
    return t;
}

// Returns the second and third vertices' weights where a ray meets the triangle's plane (Moeller, Trumbore 1997).
BN_INLINE real2 plane_weights(const LaneTriangle& t, const LaneRays& r)
{
    const real3 e1 = t.corner[1] - t.corner[0], e2 = t.corner[2] - t.corner[0], s = r.origin - t.corner[0];
    const real3 q = k_cross(r.direction, e2);
    const real determinant = k_dot3(e1, q);
    const real safe = select(abs(determinant) > lit(1e-30), determinant, lit(1e-30));
    return vec2_of(k_dot3(s, q) / safe, k_dot3(r.direction, k_cross(s, e1)) / safe);
}

// Geometry at hits, from locate_hits(). footprint: camera rays through the horizontal and the vertical neighbour in the same 2x2 quad;
// null: textures at full detail.
struct LaneGeometry {
    visible_point fragment;
    real3 position, normal; // normal: the triangle's, unit, towards the ray's origin
};

BN_INLINE LaneGeometry locate_hits(const ReferenceParams& f, const LaneHits& h, const LaneRays& r, const LaneRays* footprint)
{
    const LaneTriangle t = load_triangle(f, h.triangle);
    const real3 b = vec3_of(lit(1.0) - h.u - h.v, h.u, h.v);
    LaneGeometry g;
    g.position = t.corner[0] * b.x + t.corner[1] * b.y + t.corner[2] * b.z;
    const real3 outside = k_normalize3(k_cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
    visible_point& p = g.fragment;
    p.front = k_dot3(outside, r.direction) < lit(0.0);
    g.normal = select(p.front, outside, -outside);
    vertex_words a;
    blend_records(f.shading_vertices, t.vertex[0], t.vertex[1], t.vertex[2], b.x, b.y, b.z, a.at);
    set_interpolants(a, true, true, p);
    p.ray = r.direction;
    p.position = g.position;
    p.uv0_dx = p.uv0_dy = p.uv1_dx = p.uv1_dy = vec2_all(lit(0.0));
    if (footprint)
        for (int axis = 0; axis < 2; ++axis) {
            const real2 w = plane_weights(t, footprint[axis]);
            real c[4];
            blend_quad(f.shading_vertices + 8, t.vertex[0], t.vertex[1], t.vertex[2], lit(1.0) - w.x - w.y, w.x, w.y, c);
            (axis == 0 ? p.uv0_dx : p.uv0_dy) = vec2_of(c[0], c[1]) - p.uv0;
            (axis == 0 ? p.uv1_dx : p.uv1_dy) = vec2_of(c[2], c[3]) - p.uv1;
        }
    return g;
}

BN_INLINE parallax_plane parallax_plane_at(const ReferenceParams& f, integer triangle)
{
    const LaneTriangle t = load_triangle(f, triangle);
    const auto coordinates = [&](integer vertex) {
        real c[4];
        blend_quad(f.shading_vertices + 8, vertex, vertex, vertex, lit(1.0), lit(0.0), lit(0.0), c);
        return vec4_of(c[0], c[1], c[2], c[3]);
    };
    const real4 first = coordinates(t.vertex[0]);
    return {t.corner[1] - t.corner[0], t.corner[2] - t.corner[0], coordinates(t.vertex[1]) - first, coordinates(t.vertex[2]) - first};
}

// Fetches the material at hits.
BN_INLINE material_inputs fetch_at_hits(const ReferenceParams& f, const MaterialRecord& m, const LaneHits& h, const visible_point& p)
{
    if (!m.parallax)
        return fetch_lanes(f, m, p);
    visible_point seen = p;
    apply_parallax(f, m, parallax_plane_at(f, h.triangle), seen);
    return fetch_lanes(f, m, seen);
}

// Calls body(material, lanes) once for every material in the lanes.
template <class Body> BN_INLINE void for_each_material(const ReferenceParams& f, integer triangle, mask lanes, const Body& body)
{
    std::int32_t material[kLanes];
    store_int(material, gather_int(reinterpret_cast<const std::int32_t*>(f.triangle_material), triangle));
    const integer all_materials = load_int(material);
    for (std::uint32_t rest = to_bits(lanes); rest;) {
        const std::int32_t id = material[__builtin_ctz(rest)];
        const mask mine = both(lanes, all_materials == int_lit(id));
        body(f.materials[id], mine);
        rest &= ~to_bits(mine);
    }
}

// Returns the lanes whose hit lets the ray pass: below the alpha cutoff, or at random if the material blends.
BN_STAGE mask passes_through(const PixelFrame& p, const LaneHits& h, const LaneRays& r, const LaneRays* footprint, int turn)
{
    std::uint32_t through = 0;
    LaneGeometry g;
    bool located = false;
    for_each_material(p.f, h.triangle, h.found, [&](const MaterialRecord& m, mask lanes) {
        if (m.alpha_mode == kAlpha_opaque)
            return;
        if (!located)
            g = locate_hits(p.f, h, r, footprint);
        located = true;
        const real alpha = fetch_at_hits(p.f, m, h, g.fragment).alpha;
        const integer key =
            (iota() + int_lit(p.first)) ^ splat_bits(hash_seed(p.seed, 0x5000u + static_cast<std::uint32_t>(turn))) ^ bits_of(h.t);
        through |= to_bits(both(lanes, not_(alpha_stays(m, alpha, k_unit_from_bits(k_hash_u32(key))))));
    });
    return mask_from_bits(through);
}

// Finds the nearest hits, with transparency by chance.
BN_INLINE LaneHits find_hits(const PixelFrame& p, LaneRays r, mask wanted, RayKind kind, const LaneRays* footprint = nullptr)
{
    if (!p.f.any_alpha)
        return trace_lanes(p, r, wanted, kind);
    constexpr int kMostLayers = 1 << 16;
    const RayKind search = kind == RayKind::occlusion ? RayKind::bounce : kind;
    LaneHits result = trace_lanes(p, r, wanted, search);
    // Move rays on until no lane passes through its hit
    mask open = wanted;
    for (int turn = 0; turn < kMostLayers; ++turn) {
        open = both(open, passes_through(p, result, r, footprint, turn));
        if (none(open))
            break;
        r.tnear = select(open, result.t + abs(result.t) * lit(2e-6) + splat(p.f.ray_epsilon), r.tnear);
        const LaneHits next = trace_lanes(p, r, open, search);
        result.triangle = select(open, next.triangle, result.triangle);
        result.u = select(open, next.u, result.u), result.v = select(open, next.v, result.v);
        result.t = select(open, next.t, result.t);
        result.found = select(open, next.found, result.found);
    }
    return result;
}

// Returns the light share that passes the hits: 0 on solid surfaces, 1 where a mask cuts the surface away.
BN_STAGE real passed_share(const PixelFrame& p, const LaneHits& h, const LaneRays& r)
{
    real passed = lit(0.0);
    const LaneGeometry g = locate_hits(p.f, h, r, nullptr);
    for_each_material(p.f, h.triangle, h.found, [&](const MaterialRecord& m, mask lanes) {
        if (m.alpha_mode == kAlpha_opaque)
            return;
        const real alpha = min(max(fetch_at_hits(p.f, m, h, g.fragment).alpha, lit(0.0)), lit(1.0));
        const real cut = select(alpha_stays(m, alpha, lit(0.0)), lit(0.0), lit(1.0));
        passed = select(lanes, m.alpha_mode == kAlpha_blend ? lit(1.0) - alpha : cut, passed);
    });
    return passed;
}

// Finds the solid surfaces behind camera rays. through: the blended surfaces' transmittance before them, [0,1].
BN_INLINE LaneHits find_solid_hits(const PixelFrame& p, LaneRays r, mask wanted, real& through)
{
    through = lit(1.0);
    for (LaneHits h = trace_lanes(p, r, wanted, RayKind::camera);;) {
        if (!p.f.any_alpha)
            return h;
        const real passed = passed_share(p, h, r);
        const mask open = both(h.found, passed > lit(0.0));
        if (none(open))
            return h;
        through = select(open, through * passed, through);
        r.tnear = select(open, h.t + abs(h.t) * lit(2e-6) + splat(p.f.ray_epsilon), r.tnear);
        const LaneHits next = trace_lanes(p, r, open, RayKind::camera);
        h.triangle = select(open, next.triangle, h.triangle);
        h.u = select(open, next.u, h.u), h.v = select(open, next.v, h.v), h.t = select(open, next.t, h.t);
        h.found = select(open, next.found, h.found);
    }
}

struct LaneSurface { // surface at a hit; without a hit only `reflects` and `emitter` are set, to false
    SurfaceBsdf r;
    real3 emission;         // towards the ray's origin
    real3 position, normal; // normal: the triangle's
    mask reflects;
    mask emitter; // shows an area light; for later hits, a solid one
    real3 decay;  // log2 of the light's share left after a metre along the ray before the hit
};

BN_INLINE fresnel_parts select_parts(mask m, const fresnel_parts& a, const fresnel_parts& b)
{
    fresnel_parts r;
    r.dielectric = select(m, a.dielectric, b.dielectric), r.conductor = select(m, a.conductor, b.conductor);
    r.dielectric_f0 = select(m, a.dielectric_f0, b.dielectric_f0);
    r.dielectric_f90 = select(m, a.dielectric_f90, b.dielectric_f90), r.ior = select(m, a.ior, b.ior);
    r.eta = select(m, a.eta, b.eta), r.k = select(m, a.k, b.k);
    r.rest_f0 = select(m, a.rest_f0, b.rest_f0), r.rest_f90 = select(m, a.rest_f90, b.rest_f90);
    r.film = select(m, a.film, b.film), r.film_thickness = select(m, a.film_thickness, b.film_thickness);
    r.film_ior = select(m, a.film_ior, b.film_ior), r.film_side = select(m, a.film_side, b.film_side);
    r.metal = select(m, a.metal, b.metal), r.metal_f0 = select(m, a.metal_f0, b.metal_f0);
    return r;
}

// Returns a surface's parts for lanes beside others whose parts reflect otherwise.
BN_INLINE fresnel_parts parts_beside(const surface& s)
{
    if (s.exact)
        return s.parts;
    const real none = lit(0.0), one = lit(1.0);
    const real3 black = vec3_all(none), white = vec3_all(one);
    return {none, none, black, none, one, white, black, s.f0, s.f90, none, none, one, one, none, black};
}

// Selects coatings. Lanes on a surface without the coating have share 0.
BN_INLINE void select_coatings(mask m, const SurfaceBsdf& a, const SurfaceBsdf& b, SurfaceBsdf& r)
{
    r.coatings = a.coatings | b.coatings;
    for (int k = 0; k < kCoatings; ++k) {
        if (!has_coating(r, k))
            continue;
        const coating &c = a.coats[k], &d = b.coats[k];
        r.coats[k].axes.n = select(m, c.axes.n, d.axes.n), r.coats[k].axes.t = select(m, c.axes.t, d.axes.t);
        r.coats[k].axes.b = select(m, c.axes.b, d.axes.b), r.coats[k].horizon = select(m, c.horizon, d.horizon);
        r.coats[k].reflectance = select(m, c.reflectance, d.reflectance), r.coats[k].share = select(m, c.share, d.share);
        r.coats[k].roughness = select(m, c.roughness, d.roughness);
        r.choose_coating[k] = select(m, a.choose_coating[k], b.choose_coating[k]);
    }
}

BN_INLINE SurfaceBsdf select_surface_bsdf(mask m, const SurfaceBsdf& a, const SurfaceBsdf& b)
{
    SurfaceBsdf r = a;
    const surface &s = a.x.s, &t = b.x.s;
    r.x.s.n = select(m, s.n, t.n), r.x.s.v = select(m, s.v, t.v), r.x.s.n_dot_v = select(m, s.n_dot_v, t.n_dot_v);
    r.x.s.diffuse = select(m, s.diffuse, t.diffuse);
    r.x.s.f0 = select(m, s.f0, t.f0), r.x.s.f90 = select(m, s.f90, t.f90);
    r.x.s.roughness = select(m, s.roughness, t.roughness), r.x.s.occlusion = select(m, s.occlusion, t.occlusion);
    r.x.s.exact = std::max(s.exact, t.exact);
    if (r.x.s.exact)
        r.x.s.parts = select_parts(m, parts_beside(s), parts_beside(t));
    const aniso_lobe &k = a.x.lobe, &l = b.x.lobe;
    r.x.lobe.u_axis = select(m, k.u_axis, l.u_axis), r.x.lobe.v_axis = select(m, k.v_axis, l.v_axis);
    r.x.lobe.sigma_u = select(m, k.sigma_u, l.sigma_u), r.x.lobe.sigma_v = select(m, k.sigma_v, l.sigma_v);
    const surface_frame &p = a.x.geometric_axes, &q = b.x.geometric_axes;
    r.x.geometric_axes.n = select(m, p.n, q.n), r.x.geometric_axes.t = select(m, p.t, q.t), r.x.geometric_axes.b = select(m, p.b, q.b);
    r.x.energy.gain = select(m, a.x.energy.gain, b.x.energy.gain);
    r.o = select(m, a.o, b.o), r.horizon = select(m, a.horizon, b.horizon);
    r.diffuse = select(m, a.diffuse, b.diffuse);
    if (a.x.transmission.refracts || b.x.transmission.refracts) {
        r.x.transmission.refracts = true;
        r.x.transmission.disperses = a.x.transmission.disperses || b.x.transmission.disperses;
        r.x.transmission.inputs.tint = select(m, a.x.transmission.inputs.tint, b.x.transmission.inputs.tint);
        r.x.transmission.inputs.dispersion = select(m, a.x.transmission.inputs.dispersion, b.x.transmission.inputs.dispersion);
        r.x.transmission.inputs.parts = select_parts(m, a.x.transmission.inputs.parts, b.x.transmission.inputs.parts);
        r.refracts = either(both(m, a.refracts), both(not_(m), b.refracts));
    }
    select_coatings(m, a, b, r);
    r.choose_specular = select(m, a.choose_specular, b.choose_specular);
    r.mirror = select(m, a.mirror, b.mirror);
    return r;
}

// One material's reflection and emission at the hits.
struct MaterialAtHits {
    SurfaceBsdf r;
    real3 emission;
};

// Replaces x by a material facet if the pixel sees all the material's facets. Facets are chosen in proportion to their
// weights, by a hash over the hit's texture coordinates, which differ between rays.
BN_STAGE void choose_facets(const ReferenceParams& f, const MaterialRecord& m, const material_inputs& at, const LaneGeometry& g,
                            shaded_point& x)
{
    const real far = facets_seen(m, at, x);
    integer place = int_lit(0);
    // Draw a random number from the hit's place
    for (const real& c : {g.fragment.uv0.x, g.fragment.uv0.y, g.fragment.uv1.x, g.fragment.uv1.y})
        place = k_hash_u32(place ^ bits_of(c));
    const real u = k_unit_from_bits(place);
    const mask chosen = u < far;
    if (none(chosen))
        return;
    // Choose a facet by weight
    const real of_facets = u / max(far, lit(1e-6));
    facet_words words = facet_words_of(m, 0);
    real below = words.weight;
    for (int k = 1; k < m.facets; ++k) {
        const facet_words next = facet_words_of(m, k);
        const mask beyond = of_facets >= below;
        words.x = select(beyond, next.x, words.x), words.y = select(beyond, next.y, words.y);
        words.spread = select(beyond, next.spread, words.spread);
        below = below + next.weight;
    }
    // Rebuild the surface point for the chosen lanes
    material_inputs facet = facet_inputs(m, at, words);
    const lobe_shape own = lobe_shape_of(f, m, at), wide = facet_shape(facet, words);
    const lobe_shape shape = {select(chosen, wide.sigma_u, own.sigma_u), select(chosen, wide.sigma_v, own.sigma_v),
                              select(chosen, wide.u, own.u), select(chosen, wide.roughness, own.roughness)};
    facet.normal_map = select(chosen, facet.normal_map, at.normal_map);
    facet.kept = select(chosen, facet.kept, at.kept);
    make_shaded_point(f, m, facet, shape, g.fragment, int_lit(0), x);
    keep_light_of_facets(f, m, facet, select(chosen, lit(1.0), lit(0.0)), x);
}

BN_STAGE MaterialAtHits material_at_hits(const ReferenceParams& f, const MaterialRecord& m, const LaneHits& h, const LaneGeometry& g)
{
    const material_inputs at = fetch_at_hits(f, m, h, g.fragment);
    MaterialAtHits r;
    shaded_point x;
    make_shaded_point(f, m, at, lobe_shape_of(f, m, at), g.fragment, int_lit(0), x);
    if (m.facets > 0)
        choose_facets(f, m, at, g, x);
    if (!x.transmission.refracts)
        x.transmission.inputs = interface_inputs(); // lanes with other materials may refract
    real reflected;
    r.r = make_surface_bsdf(f, x, reflected);
    r.emission = own_light(m, at);
    // Put the coatings over it
    const auto cover = [&](int k, const coating& c) {
        add_coating(r.r, k, c, reflected);
        r.emission = r.emission * (lit(1.0) - c.share);
    };
#define BN_COATING(id, bit, strength, lobe)                                                                                                \
    if (has_coating(m, bit))                                                                                                               \
        cover(bit, id##_coating(f, m, at, x.geometric_axes, x.s.v, facing_handedness(g.fragment)));
#include "shading/coatings.def"
    return r;
}

BN_STAGE void find_surface(const ReferenceParams& f, const LaneHits& h, const LaneRays& r, const LaneRays* footprint, LaneSurface& out)
{
    out.reflects = out.emitter = mask_from_bits(0);
    if (none(h.found))
        return;
    const LaneGeometry g = locate_hits(f, h, r, footprint);
    out.position = g.position, out.normal = g.normal, out.decay = vec3_all(lit(0.0));
    bool first = true;
    for_each_material(f, h.triangle, h.found, [&](const MaterialRecord& m, mask lanes) {
        const MaterialAtHits at = material_at_hits(f, m, h, g);
        out.r = first ? at.r : select_surface_bsdf(lanes, at.r, out.r); // lanes without a hit hold harmless values
        out.emission = first ? at.emission : select(lanes, at.emission, out.emission);
        if (m.emitter)
            out.emitter = either(out.emitter, lanes);
        if (m.refracts) // rays that hit it from behind have crossed its body
            out.decay = select(both(lanes, not_(g.fragment.front)), splat3(m.body_decay), out.decay);
        if (!m.unlit)
            out.reflects = either(out.reflects, lanes);
        first = false;
    });
}

// Returns the lanes that hit the surface of solid area light `light`.
BN_STAGE mask hits_light(const ReferenceParams& f, const LaneHits& h, int light)
{
    mask hit = mask_from_bits(0);
    if (f.solid_lights)
        for_each_material(f, h.triangle, h.found, [&](const MaterialRecord& m, mask lanes) {
            if (m.emitter == kSolidEmitter + light)
                hit = either(hit, lanes);
        });
    return hit;
}

} // namespace BN_ISA_NS
} // namespace burnish
