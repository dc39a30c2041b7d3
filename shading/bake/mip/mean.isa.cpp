#include "shading/bake/mip/mean_fns.h"

#include "shading/surface/tensor.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

namespace work = burnish::mip;
using work::Mean, work::kMostStates, work::kPointPlanes;

constexpr std::size_t kLane = static_cast<std::size_t>(kLanes);

BN_FN real3 unit_or_up(real3 n)
{
    const real length = sqrt((n.x * n.x + n.y * n.y) + n.z * n.z);
    const mask any = length > lit(1e-6);
    const real safe = select(any, length, lit(1.0));
    return vec3_of(select(any, n.x / safe, lit(0.0)), select(any, n.y / safe, lit(0.0)), select(any, n.z / safe, lit(1.0)));
}

BN_FN real3 normal_of_slope(real2 slope)
{
    const real length = sqrt(lit(1.0) + (slope.x * slope.x + slope.y * slope.y));
    return vec3_of(slope.x / length, slope.y / length, lit(1.0) / length);
}

BN_FN slope_covariance scaled(slope_covariance s, real by)
{
    return {s.xx * by, s.yy * by, s.xy * by};
}

// Converts 8-bit codes to planes of numbers.
void codes(const work::CodeWork& w)
{
    const std::size_t channels = static_cast<std::size_t>(w.channels), first = static_cast<std::size_t>(w.first);
    const integer byte = int_lit(255);
    const real most = lit(255.0);
    std::size_t at = 0;
    alignas(64) std::int32_t words[4 * kLanes];
    if (channels == 4)
        for (; at + kLane <= w.count; at += kLane) {
            __builtin_memcpy(words, w.codes + 4 * at, 4 * kLane);
            const integer texel = load_int(words);
            for (int k = 0; k < w.planes; ++k)
                store(w.to + static_cast<std::size_t>(k) * w.stride + at, to_real(shr(texel, 8 * (w.first + k)) & byte) / most);
        }
    if (channels == 3)
        for (; at + 4 * kLane <= w.count; at += 4 * kLane) { // four texels in three words
            __builtin_memcpy(words, w.codes + 3 * at, 12 * kLane);
            integer word[3];
            load_triples_int(words, word);
            for (int k = 0; k < w.planes; ++k) {
                integer texels[4];
                for (int j = 0; j < 4; ++j) {
                    const int place = 3 * j + w.first + k;
                    texels[j] = bits_of(to_real(shr(word[place / 4], 8 * (place % 4)) & byte) / most);
                }
                store_quads(w.to + static_cast<std::size_t>(k) * w.stride + at, texels, kLanes);
            }
        }
    for (; at < w.count; ++at)
        for (std::size_t k = 0; k < static_cast<std::size_t>(w.planes); ++k)
            w.to[k * w.stride + at] = static_cast<float>(w.codes[channels * at + first + k]) / 255.0f;
}

// Interpolates along both rows, then between them. A share of 0 takes the first value, whatever the second is.
void blend(const work::BlendWork& w)
{
    const real of_high = splat(w.of_high), zero = lit(0.0);
    for (std::size_t at = 0; at < w.count; at += kLane) {
        const integer left = load_int(w.left + at), right = load_int(w.right + at);
        const real share = load(w.share + at);
        const mask alone = share == zero;
        const auto along = [&](const float* row) {
            const real first = gather(row, left);
            return select(alone, first, first + share * (gather(row, right) - first));
        };
        real value = along(w.low);
        if (w.of_high != 0.0f)
            value = value + of_high * (along(w.high) - value);
        store(w.to + at, value);
    }
}

// Moves a normal that lies flatter than the disc's edge onto that edge. A normal without length points up.
void normals(const work::NormalWork& w)
{
    const real widest = lit(0.999), scale = splat(w.scale), most = splat(3.40282347e38f), one = lit(1.0), zero = lit(0.0);
    const real level_z = sqrt(one - widest * widest);
    for (std::size_t at = 0; at < w.count; at += kLane) {
        float *const x_at = w.planes + at, *const y_at = x_at + w.stride, *const z_at = y_at + w.stride;
        const real nx = scale * (lit(2.0) * load(x_at) - one), ny = scale * (lit(2.0) * load(y_at) - one);
        const real nz = max(lit(2.0) * load(z_at) - one, zero);
        const real across = sqrt(nx * nx + ny * ny), length = sqrt((nx * nx + ny * ny) + nz * nz);
        const mask any_length = both(length > lit(1e-6), length <= most), wide = across > widest * length;
        const real to_edge = widest / select(wide, across, one), whole = select(any_length, length, one);
        const real x = select(wide, nx * to_edge, nx / whole), y = select(wide, ny * to_edge, ny / whole);
        const real z = select(wide, level_z, nz / whole);
        store(x_at, select(any_length, x, zero)), store(y_at, select(any_length, y, zero)), store(z_at, select(any_length, z, one));
    }
}

// As direction_tensor() of anisotropy.h, with the same bits.
void directions(const work::DirectionWork& w)
{
    const real most = splat(3.40282347e38f), one = lit(1.0), zero = lit(0.0);
    for (std::size_t at = 0; at < w.count; at += kLane) {
        const auto code = [&](std::size_t k) { return load(w.codes + k * w.stride + at); };
        const real x = lit(2.0) * code(0) - one, y = lit(2.0) * code(1) - one, strength = code(2), length2 = x * x + y * y;
        const mask any = both(both(length2 >= lit(1e-4), length2 <= most), abs(strength) <= most);
        const real whole = select(any, length2, one), s2 = strength * strength;
        const real weights[2] = {s2 / whole, s2 * s2 / whole};
        for (std::size_t k = 0; k < 2; ++k) {
            float* const to = w.tensors + 3 * k * w.stride + at;
            const real parts[3] = {weights[k] * x * x, weights[k] * y * y, weights[k] * x * y};
            for (std::size_t c = 0; c < 3; ++c)
                store(to + c * w.stride, select(both(any, abs(parts[c]) <= most), parts[c], zero));
        }
    }
}

// Writes the lobes' covariances from roughness and anisotropy.
void covariances(const work::CovarianceWork& w)
{
    const real factor = splat(w.factor), strength = splat(w.strength);
    const real2 rotation = vec2_of(splat(w.cosine), splat(w.sine));
    const real3 along = vec3_of(lit(1.0), lit(0.0), lit(0.0));
    for (std::size_t at = 0; at < w.count; at += kLane) {
        const real own = w.roughness ? factor * load(w.roughness + at) : factor;
        const real roughness = min(max(own, lit(0.0)), lit(1.0));
        const auto plane = [&](std::size_t k) { return load(w.tensors + k * w.stride + at); };
        const auto power = [&](std::size_t k) { return w.tensors ? vec3_of(plane(k), plane(k + 1), plane(k + 2)) : along; };
        const slope_covariance s = covariance_from_tensors(roughness * roughness, strength, rotation, power(0), power(3));
        store(w.to + at, s.xx), store(w.to + w.stride + at, s.yy), store(w.to + 2 * w.stride + at, s.xy);
    }
}

constexpr std::size_t states_of(Mean mean)
{
    return mean == Mean::leadr ? 5 : mean == Mean::ssgt || mean == Mean::kappa ? 9 : 6;
}

struct state {
    real v[kMostStates];
};

// Returns the state of a point: numbers whose mean is meaningful.
template <Mean mean> BN_FN state state_of(real3 n, slope_covariance s)
{
    if constexpr (mean == Mean::baseline) {
        const lobe_tensor t = projected_tensor(tensor_of_covariance(s));
        return {{n.x, n.y, n.z, t.a, t.b, t.c}};
    } else if constexpr (mean == Mean::covariance) {
        return {{n.x, n.y, n.z, s.xx, s.yy, s.xy}};
    } else if constexpr (mean == Mean::leadr) {
        const real steep = sqrt(n.x * n.x + n.y * n.y) / (lit(static_cast<double>(work::kMostSlope)) * n.z);
        const real keep = lit(1.0) / max(steep, lit(1.0));
        const real2 slope = vec2_of(keep * n.x / n.z, keep * n.y / n.z);
        const slope_covariance c = covariance_from_frame(normal_of_slope(slope), s);
        return {{slope.x, slope.y, c.xx, c.yy, c.xy}};
    } else {
        const space_covariance c = covariance_in_space(n, scaled(s, lit(2.0)));
        return {{n.x, n.y, n.z, c.xx, c.yy, c.zz, c.xy, c.xz, c.yz}};
    }
}

template <Mean mean> struct States {
    static void run(const work::StateWork& w)
    {
        for (std::size_t at = 0; at < w.count; at += kLane) {
            const auto plane = [&](std::size_t k) { return load(w.points + k * w.stride + at); };
            const state s = state_of<mean>(vec3_of(plane(0), plane(1), plane(2)), {plane(3), plane(4), plane(5)});
            for (std::size_t k = 0; k < states_of(mean); ++k)
                store(w.states + k * w.stride + at, s.v[k]);
        }
    }
};

// Merges a square of four texels with equal weights. Sums both diagonals first, so that mirrored and rotated squares give equal bits.
template <Mean mean> BN_FN state merged(const state& a, const state& b, const state& c, const state& d, real spread)
{
    constexpr std::size_t means = mean == Mean::leadr ? 2 : 3;
    state r;
    for (std::size_t k = 0; k < states_of(mean); ++k)
        r.v[k] = lit(0.25) * ((a.v[k] + d.v[k]) + (b.v[k] + c.v[k]));
    if constexpr (mean == Mean::baseline || mean == Mean::covariance)
        return r;
    for (std::size_t k = means; k < states_of(mean); ++k) {
        const work::MeanPair p = mean == Mean::leadr ? work::kFlatPairs[k - means] : work::kSpacePairs[k - means];
        const auto product = [&](const state& s) { return (s.v[p.i] - r.v[p.i]) * (s.v[p.j] - r.v[p.j]); };
        r.v[k] += spread * (lit(0.25) * ((product(a) + product(d)) + (product(b) + product(c))));
    }
    return r;
}

// Merges rows in pairs, or copies a side that is not halved.
template <Mean mean> struct Merge {
    static void run(const work::MergeWork& w)
    {
        constexpr std::size_t kAtOnce = 64;
        alignas(64) float four[4][states_of(mean)][kAtOnce] = {};
        const std::size_t step = static_cast<std::size_t>(w.across);
        for (std::size_t first = 0; first < w.count; first += kAtOnce) {
            const std::size_t some = w.count - first < kAtOnce ? w.count - first : kAtOnce;
            for (std::size_t k = 0; k < states_of(mean); ++k) {
                const float *const top = w.top + k * w.from_stride + step * first, *const bottom =
                                                                                       w.bottom + k * w.from_stride + step * first;
                if (step == 2) {
                    for (std::size_t i = 0; i < some; ++i)
                        four[0][k][i] = top[2 * i], four[1][k][i] = top[2 * i + 1];
                    for (std::size_t i = 0; i < some; ++i)
                        four[2][k][i] = bottom[2 * i], four[3][k][i] = bottom[2 * i + 1];
                } else {
                    for (std::size_t i = 0; i < some; ++i)
                        four[0][k][i] = four[1][k][i] = top[i], four[2][k][i] = four[3][k][i] = bottom[i];
                }
            }
            for (std::size_t i = 0; i < some; i += kLane) {
                const auto at = [&](std::size_t j) {
                    state s;
                    for (std::size_t k = 0; k < states_of(mean); ++k)
                        s.v[k] = load(&four[j][k][i]);
                    return s;
                };
                const state r = merged<mean>(at(0), at(1), at(2), at(3), splat(w.spread));
                for (std::size_t k = 0; k < states_of(mean); ++k)
                    store(w.states + k * w.stride + first + i, r.v[k]);
            }
        }
    }
};

struct lobe_texel {
    real nx, ny;
    lobe_tensor t;
};

// Returns the normal and lobe of a mean state.
template <Mean mean> BN_FN lobe_texel texel_of(const real* v)
{
    real3 n = unit_or_up(vec3_of(v[0], v[1], v[2]));
    lobe_tensor t = {v[3], v[4], v[5]};
    if constexpr (mean == Mean::covariance) {
        t = tensor_of_covariance({v[3], v[4], v[5]});
    } else if constexpr (mean == Mean::leadr) {
        n = normal_of_slope(vec2_of(v[0], v[1]));
        t = tensor_of_covariance(covariance_to_frame(n, {v[2], v[3], v[4]}));
    } else if constexpr (mean == Mean::kappa) {
        t = tensor_of_covariance(scaled(covariance_seen_from(n, {v[3], v[4], v[5], v[6], v[7], v[8]}), lit(0.5)));
    } else if constexpr (mean == Mean::ssgt) {
        const real3 middle = vec3_of(v[0], v[1], v[2]);
        const space_covariance spread = {v[3], v[4], v[5], v[6], v[7], v[8]};
        n = unit_or_up(sggx_product(middle, spread, n)); // step towards its axis; the remaining mean slope is of second order
        t = tensor_of_covariance(scaled(sggx_lobe(n, middle, spread).spread, lit(0.5)));
    }
    return {n.x, n.y, projected_tensor(t)};
}

// Writes a row of states as texels. Mean::baseline makes normals unit again for the next level.
template <Mean mean> struct Texels {
    static void run(const work::TexelWork& w)
    {
        alignas(64) float out[work::kLobeChannels][kLane];
        for (std::size_t at = 0; at < w.count; at += kLane) {
            real v[kMostStates];
            for (std::size_t k = 0; k < kMostStates; ++k)
                v[k] = k < states_of(mean) ? load(w.states + k * w.stride + at) : lit(0.0);
            if constexpr (mean == Mean::baseline) {
                const real3 n = unit_or_up(vec3_of(v[0], v[1], v[2]));
                v[0] = n.x, v[1] = n.y, v[2] = n.z;
                for (std::size_t k = 0; k < 3; ++k)
                    store(w.states + k * w.stride + at, v[k]);
            }
            const lobe_texel t = texel_of<mean>(v);
            store(out[0], t.nx), store(out[1], t.ny), store(out[2], t.t.a), store(out[3], t.t.b), store(out[4], t.t.c);
            const std::size_t some = w.count - at < kLane ? w.count - at : kLane;
            float* to = w.texels + work::kLobeChannels * at;
            for (std::size_t i = 0; i < some; ++i)
                for (std::size_t c = 0; c < work::kLobeChannels; ++c)
                    *to++ = out[c][i];
        }
    }
};

// Calls the instance for the work's mean.
template <template <Mean> class Run, class Work> void by_mean(const Work& w)
{
    switch (w.mean) {
    case Mean::baseline:
        return Run<Mean::baseline>::run(w);
    case Mean::covariance:
        return Run<Mean::covariance>::run(w);
    case Mean::leadr:
        return Run<Mean::leadr>::run(w);
    case Mean::ssgt:
        return Run<Mean::ssgt>::run(w);
    case Mean::kappa:
        return Run<Mean::kappa>::run(w);
    }
}

void tensors(const work::TensorWork& w)
{
    for (std::size_t at = 0; at < w.count; at += kLane) {
        const auto plane = [&](std::size_t k) { return load(w.points + k * w.stride + at); };
        const lobe_tensor t = projected_tensor(tensor_of_covariance({plane(3), plane(4), plane(5)}));
        const real channel[work::kLobeChannels] = {plane(0), plane(1), t.a, t.b, t.c};
        for (std::size_t c = 0; c < work::kLobeChannels; ++c)
            store(w.to + c * w.stride + at, channel[c]);
    }
}

// Hashes a row. Each number takes one round of the 32-bit hash in the family of hash_bytes() (Collet, xxhash_spec.md).
void hash(const work::HashWork& w)
{
    const integer first = int_lit(static_cast<int>(0x9e3779b1u)), second = int_lit(static_cast<int>(0x85ebca77u));
    const integer start = int_lit(static_cast<int>(0x24234428u));
    for (std::size_t slot = 0; slot < work::kRowSlots; slot += kLane) {
        integer mixed[kPointPlanes];
        for (integer& m : mixed)
            m = start;
        for (std::size_t at = slot; at < w.stride; at += work::kRowSlots)
            for (std::size_t k = 0; k < kPointPlanes; ++k) {
                const integer sum = mixed[k] + bits_of(load(w.points + k * w.stride + at)) * second;
                mixed[k] = (shl(sum, 13) | shr_logical(sum, 19)) * first;
            }
        for (std::size_t k = 0; k < kPointPlanes; ++k)
            store_int(w.mixed + k * work::kRowSlots + slot, mixed[k]);
    }
}

constexpr work::Fns kMipFns = {codes,
                               blend,
                               normals,
                               directions,
                               covariances,
                               by_mean<States, work::StateWork>,
                               by_mean<Merge, work::MergeWork>,
                               by_mean<Texels, work::TexelWork>,
                               tensors,
                               hash};

} // namespace

BN_DEFINE_FNS(mip::Fns, kMipFns)

} // namespace BN_ISA_NS
} // namespace burnish
