#include "shading/bake/bake_fns.h"
#include "shading/kernels/math.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

// Returns unit directions to texel centres of a face.
BN_FN real3 texel_directions(int face, int size, integer ix, integer iy)
{
    const real inv = splat(1.0f / static_cast<float>(size));
    const real u = to_real(ix + ix + int_lit(1)) * inv - lit(1.0), v = to_real(iy + iy + int_lit(1)) * inv - lit(1.0);
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

// Returns directions of texels first... in a square with `side` texels per row. The square's first texel is (x, y).
BN_FN real3 square_directions(int face, int size, int x, int y, int side, int first)
{
    const integer i = iota() + int_lit(first);
    const int shift = __builtin_ctz(static_cast<unsigned>(side));
    return texel_directions(face, size, (i & int_lit(side - 1)) + int_lit(x), shr(i, shift) + int_lit(y));
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

// With V = N = R, n.h = v.h. A direction l then has a weight D(h) n.l that depends on q = |l - n|^2 alone. The half angle's squared cosine
// is 1 - q/4, and the angle's cosine is 1 - q/2. D is divided by its largest value. Karis 2013.
void prefilter(const PrefilterInput& in, int face, int size, int x, int y, float* rgb)
{
    const int side = size < kPrefilterBlock ? size : kPrefilterBlock, count = side * side;
    const float a2 = in.alpha * in.alpha;
    const real slope = splat((1.0f - a2) / (4.0f * a2)), one = lit(1.0), zero = lit(0.0), half = lit(0.5);
    for (int at = 0; at < count; at += kLanes, rgb += 3 * kLanes) {
        const real3 n = square_directions(face, size, x, y, side, at);
        real3 sum = vec3_all(zero);
        real weights = zero;
        for (int i = 0; i < in.count; ++i) {
            const PrefilterTerm& t = in.terms[i];
            const real dx = splat(t.x) - n.x, dy = splat(t.y) - n.y, dz = splat(t.z) - n.z;
            const real q = dx * dx + dy * dy + dz * dz;
            const real d = one + slope * q;
            const real w = max(one - half * q, zero) / (d * d);
            sum = sum + vec3_of(splat(t.r), splat(t.g), splat(t.b)) * w;
            weights = weights + splat(t.angle) * w;
        }
        store_texels(sum / weights, count - at < kLanes ? count - at : kLanes, rgb);
    }
}

void irradiance(const IrradianceInput& source, int face, int size, int first, int count, float* rgb)
{
    for (int at = 0; at < count; at += kLanes, rgb += 3 * kLanes) {
        const real3 normal = square_directions(face, size, 0, 0, size, first + at);
        real3 sum = vec3_all(lit(0.0));
        real weights = lit(0.0);
        for (int row = 0; row < source.count; row += source.row) {
            real3 part = vec3_all(lit(0.0));
            real part_weights = lit(0.0);
            for (int i = row; i < row + source.row; ++i) {
                const real cosine = normal.x * splat(source.x[i]) + normal.y * splat(source.y[i]) + normal.z * splat(source.z[i]);
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

BN_DEFINE_FNS(BakeFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
