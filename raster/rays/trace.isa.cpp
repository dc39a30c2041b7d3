// Rays through a tree, a ray a lane. A ray meets a triangle if it passes the bounds of all nodes above, so its hit depends on no other ray.
#include "core/simd/lanes.h"
#include "raster/rays/trace_fns.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

struct Vec {
    real x, y, z;
};

BN_INLINE Vec minus(const Vec& a, const Vec& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
BN_INLINE Vec plus(const Vec& a, const Vec& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
BN_INLINE Vec cross(const Vec& a, const Vec& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
BN_INLINE real dot(const Vec& a, const Vec& b)
{
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

struct Rays {
    Vec origin, direction, inverse; // inverse: of the direction, finite
    real tnear, tfar, u, v;
    integer id;
};

// Bounds are widened by this part of the distance, since distances to bounds and to triangles round differently.
constexpr double kWiden = 1e-5;
constexpr double kRounding = 2e-6, kMostSlack = 1e-3, kEdgeOn = 1e-7;

BN_INLINE real inverse_of(real d)
{
    const real tiny = lit(1e-30);
    return lit(1.0) / select(abs(d) < tiny, select(d < lit(0.0), -tiny, tiny), d);
}

// Returns the lanes whose rays pass a child's bounds.
BN_INLINE mask passes(const Rays& r, const RayNode& node, int child, real& enters)
{
    real from = r.tnear, to = r.tfar;
    const auto slab = [&](int axis, real origin, real inverse) {
        const real a = (splat(node.low[child][axis]) - origin) * inverse, b = (splat(node.high[child][axis]) - origin) * inverse;
        from = max(min(a, b), from);
        to = min(max(a, b), to);
    };
    slab(0, r.origin.x, r.inverse.x);
    slab(1, r.origin.y, r.inverse.y);
    slab(2, r.origin.z, r.inverse.z);
    enters = from;
    return from - abs(from) * lit(kWiden) <= to + abs(to) * lit(kWiden);
}

BN_INLINE Vec corner_of(const RayTriangle& t, int k)
{
    return {splat(t.corner[k][0]), splat(t.corner[k][1]), splat(t.corner[k][2])};
}

BN_INLINE real greatest(const Vec& v)
{
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

// Tests a triangle by the volumes that the ray spans with its edges. Triangles with a common edge get the same number there, so no ray
// passes between them. Around a corner the numbers' rounding could leave a gap: volumes within the rounding count as 0, up to a small part
// of the triangle. Returns the lanes with a nearer hit, and stores it unless `occlusion`.
BN_INLINE mask meet(Rays& r, const RayTriangle& t, RayKind kind, mask wanted)
{
    // Find the signed volumes of the edges
    const Vec a = minus(corner_of(t, 0), r.origin), b = minus(corner_of(t, 1), r.origin), c = minus(corner_of(t, 2), r.origin);
    const Vec ca = minus(c, a), ab = minus(a, b), bc = minus(b, c);
    const real u = dot(cross(ca, plus(c, a)), r.direction), v = dot(cross(ab, plus(a, b)), r.direction);
    const real w = dot(cross(bc, plus(b, c)), r.direction), sum = (u + v) + w;
    const real least = min(u, min(v, w)), most = max(u, max(v, w)), widest = abs(sum) * lit(kMostSlack);
    if (none(both(wanted, either(least >= -widest, most <= widest))))
        return mask_from_bits(0);
    const real products = greatest(r.direction) * max(greatest(a), max(greatest(b), greatest(c))) * max(greatest(ca), greatest(ab));
    const real slack = min(products * lit(kRounding), widest);
    // A triangle seen from its edge has no certain distance
    mask hit = both(both(wanted, abs(sum) > products * lit(kEdgeOn)), either(least >= -slack, most <= slack));
    if (none(hit))
        return hit;
    // Find the distance
    const Vec normal = cross(ab, ca);
    const real along = dot(normal, r.direction), distance = dot(normal, a) / along;
    hit = both(hit, both(abs(along) > lit(0.0), distance >= r.tnear));
    const integer id = int_lit(static_cast<int>(t.id));
    hit = both(hit, either(distance < r.tfar, both(both(distance <= r.tfar, r.id >= int_lit(0)), id < r.id)));
    // The outside has counter-clockwise corners
    if (kind == RayKind::camera && t.single_sided)
        hit = both(hit, along > lit(0.0));
    if (kind == RayKind::occlusion || none(hit))
        return hit;
    r.tfar = select(hit, distance, r.tfar);
    const real second = clamp(u / sum, lit(0.0), lit(1.0));
    r.u = select(hit, second, r.u), r.v = select(hit, clamp(v / sum, lit(0.0), lit(1.0) - second), r.v);
    r.id = select(hit, id, r.id);
    return hit;
}

struct Entry { // of the stack
    std::uint32_t node;
    mask rays;
};

BN_INLINE void trace_lanes(const RayTreeView& tree, Rays& r, RayKind kind, mask open, mask& found)
{
    Entry stack[kDeepestTree];
    int height = 0;
    stack[height++] = {0, open};
    while (height > 0) {
        const Entry at = stack[--height];
        const mask rays = kind == RayKind::occlusion ? both(at.rays, not_(found)) : at.rays;
        if (none(rays))
            continue;
        // Meet leaves at once, and put off the farther node
        const RayNode& node = tree.nodes[at.node];
        const real d = node.axis == 0 ? r.direction.x : node.axis == 1 ? r.direction.y : r.direction.z;
        const bool backwards = ((to_bits(d < lit(0.0)) >> __builtin_ctz(to_bits(rays))) & 1u) != 0;
        Entry later[2];
        int count = 0;
        for (int k = 0; k < 2; ++k) {
            const int child = backwards ? 1 - k : k;
            real enters;
            const mask through = both(rays, passes(r, node, child, enters));
            if (none(through))
                continue;
            if (node.count[child] == 0) {
                later[count++] = {node.first[child], through};
                continue;
            }
            for (std::uint32_t i = 0; i < node.count[child]; ++i) {
                const mask hit = meet(r, tree.triangles[node.first[child] + i], kind, through);
                found = either(found, hit);
            }
        }
        while (count > 0)
            stack[height++] = later[--count];
        if (kind == RayKind::occlusion && none(both(open, not_(found))))
            return;
    }
}

void trace(const RayTreeView& tree, RayPacket& k, RayKind kind)
{
    for (int first = 0; tree.any && first < kRays; first += kLanes) {
        const mask valid = load_int(k.valid + first) != int_lit(0);
        Rays r;
        r.origin = {load(k.org_x + first), load(k.org_y + first), load(k.org_z + first)};
        r.direction = {load(k.dir_x + first), load(k.dir_y + first), load(k.dir_z + first)};
        // Leave out rays with a NaN or Inf, which would pass all bounds
        const mask sound = both(dot(r.origin, r.origin) <= splat(3e38f), dot(r.direction, r.direction) <= splat(3e38f));
        const mask open = both(valid, sound);
        if (none(open))
            continue;
        r.inverse = {inverse_of(r.direction.x), inverse_of(r.direction.y), inverse_of(r.direction.z)};
        r.tnear = load(k.tnear + first), r.tfar = load(k.tfar + first);
        r.u = load(k.u + first), r.v = load(k.v + first);
        const mask had = load_int(reinterpret_cast<const std::int32_t*>(k.geometry + first)) != int_lit(-1);
        r.id = select(had, load_int(reinterpret_cast<const std::int32_t*>(k.triangle + first)), int_lit(-1));
        mask found = mask_from_bits(0);
        trace_lanes(tree, r, kind, open, found);
        if (kind == RayKind::occlusion) {
            store(k.tfar + first, select(found, splat(-__builtin_inff()), r.tfar));
            continue;
        }
        store(k.tfar + first, r.tfar), store(k.u + first, r.u), store(k.v + first, r.v);
        store_int(reinterpret_cast<std::int32_t*>(k.triangle + first), r.id);
        store_int(reinterpret_cast<std::int32_t*>(k.geometry + first), select(r.id >= int_lit(0), int_lit(0), int_lit(-1)));
    }
}

constexpr TraceFns kFns = {trace};

} // namespace

BN_DEFINE_FNS(TraceFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
