#include "shading/bake/bake_fns.h"
#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/math.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

struct Frame {
    real3 t, b, n; // orthonormal
};

// A frame that turns smoothly with n but for one direction, -y, where few look: Frisvad 2012, about +y.
BN_FN Frame frame_about(real3 n)
{
    const real denominator = max(lit(1.0) + n.y, lit(1e-6));
    const real a = lit(1.0) / denominator, b = -(n.x * n.z) * a;
    Frame f;
    f.n = n;
    f.t = vec3_of(lit(1.0) - n.x * n.x * a, -n.x, b);
    f.b = vec3_of(b, -n.z, lit(1.0) - n.z * n.z * a);
    const mask down = n.y < lit(-0.999999);
    f.t = select(down, vec3_of(lit(1.0), lit(0.0), lit(0.0)), f.t);
    f.b = select(down, vec3_of(lit(0.0), lit(0.0), lit(-1.0)), f.b);
    return f;
}

// Unit directions of the centres of texels first... of a face.
BN_FN real3 texel_directions(int face, int size, int first)
{
    const integer i = iota() + int_lit(first);
    const int shift = __builtin_ctz(static_cast<unsigned>(size));
    const integer ix = i & int_lit(size - 1), iy = shr(i, shift);
    const real inv = splat(1.0f / static_cast<float>(size));
    const real u = to_real(ix + ix + int_lit(1)) * inv - lit(1.0),
               v = to_real(iy + iy + int_lit(1)) * inv - lit(1.0);
    const real one = lit(1.0);
    real3 d;
    switch (face) {
    case 0:
        d = vec3_of(one, -v, -u);
        break;
    case 1:
        d = vec3_of(-one, -v, u);
        break;
    case 2:
        d = vec3_of(u, one, v);
        break;
    case 3:
        d = vec3_of(u, -one, -v);
        break;
    case 4:
        d = vec3_of(u, -v, one);
        break;
    default:
        d = vec3_of(-u, -v, -one);
        break;
    }
    return k_normalize3(d);
}

BN_FN void store_texels(real3 value, int count, float* rgb)
{
    float r[kLanes], g[kLanes], b[kLanes];
    store(r, value.x);
    store(g, value.y);
    store(b, value.z);
    for (int i = 0; i < count; ++i) {
        rgb[3 * i] = r[i];
        rgb[3 * i + 1] = g[i];
        rgb[3 * i + 2] = b[i];
    }
}

void prefilter(const PrefilterInput& in, int face, int size, int first, int count, float* rgb)
{
    const cube_desc cube = {in.texels, in.size, in.levels};
    for (int at = 0; at < count; at += kLanes, rgb += 3 * kLanes) {
        const Frame f = frame_about(texel_directions(face, size, first + at));
        texel_acc acc = texel_zero();
        for (int i = 0; i < in.count; ++i) {
            const real3 d = f.t * splat(in.x[i]) + f.b * splat(in.y[i]) + f.n * splat(in.z[i]);
            const cube_place place = cube_face_uv(d);
            const float fraction = in.fraction[i], coarse = in.weight[i] * fraction;
            acc = cube_level_add(acc, cube, place, in.level[i], splat(in.weight[i] - coarse));
            if (fraction > 0.0f)
                acc = cube_level_add(acc, cube, place, in.level[i] + 1, splat(coarse));
        }
        const real4 sum = texel_value(acc);
        const real scale = splat(in.scale);
        store_texels(vec3_of(sum.x, sum.y, sum.z) * scale, count - at < kLanes ? count - at : kLanes, rgb);
    }
}

void irradiance(const IrradianceInput& source, int face, int size, int first, int count, float* rgb)
{
    for (int at = 0; at < count; at += kLanes, rgb += 3 * kLanes) {
        const real3 normal = texel_directions(face, size, first + at);
        real3 sum = vec3_all(lit(0.0));
        real weights = lit(0.0);
        for (int row = 0; row < source.count; row += source.row) {
            real3 part = vec3_all(lit(0.0));
            real part_weights = lit(0.0);
            for (int i = row; i < row + source.row; ++i) {
                const real cosine = normal.x * splat(source.x[i]) + normal.y * splat(source.y[i]) +
                                    normal.z * splat(source.z[i]);
                const real w = max(cosine, lit(0.0));
                part = part + vec3_of(splat(source.r[i]), splat(source.g[i]), splat(source.b[i])) * w;
                part_weights = part_weights + w;
            }
            sum = sum + part;
            weights = weights + part_weights;
        }
        store_texels(sum * (lit(1.0) / weights), count - at < kLanes ? count - at : kLanes, rgb);
    }
}

constexpr BakeFns kFns = {prefilter, irradiance};

} // namespace

const BakeFns& bake_lanes()
{
    return kFns;
}

} // namespace BN_ISA_NS
} // namespace burnish
