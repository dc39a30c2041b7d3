#include "shading/bake/mipnet/mip_optimiser_fns.h"

#include "shading/bake/mipnet/tensor.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace mipnet_lanes {
namespace {

namespace net = burnish::mipnet;

constexpr std::size_t kLane = static_cast<std::size_t>(kLanes), kSlotCount = net::kSlots, kPlanes = net::kChannels;
constexpr float kFitRate = 0.08f, kFirstDecay = 0.9f, kSecondDecay = 0.99f;

// Reads the lights for the pairs from `at` on, or for pair `at` in all lanes.
template <class Read> BN_FN light light_at(Read read)
{
    return {vec3_of(read(0), read(1), read(2)),
            vec3_of(read(3), read(4), read(5)),
            vec3_of(read(6), read(7), read(8)),
            read(9),
            read(10),
            read(11),
            read(12)};
}

template <int lobe> void light_rows(const net::PairLights& l)
{
    const std::size_t pairs = static_cast<std::size_t>(l.pairs);
    for (std::size_t p = 0; p < pairs; p += kLane) {
        const auto at = [&](std::size_t k) { return get(l.directions + k * pairs + p); };
        const light made = light_of<lobe>(vec3_of(at(0), at(1), at(2)), vec3_of(at(3), at(4), at(5)), all_lanes(l.f0), all_lanes(l.diffuse),
                                          get(l.intensity + p));
        const real row[net::kLightRows] = {made.i.x, made.i.y, made.i.z, made.o.x,     made.o.y,     made.o.z,      made.h.x,
                                           made.h.y, made.h.z, made.lh,  made.fresnel, made.diffuse, made.intensity};
        for (std::size_t k = 0; k < net::kLightRows; ++k)
            put(l.rows + k * pairs + p, row[k]);
    }
}

// Averages the radiance of a texel's footprint.
template <int lobe> void gather_of(const net::GatherWork& w)
{
    const std::size_t pairs = static_cast<std::size_t>(w.pairs), vectors = pairs / kLane;
    real sum[net::kMostPairs / kLane], line[net::kMostPairs / kLane];
    for (std::size_t v = 0; v < vectors; ++v)
        sum[v] = lit(0.0);
    for (int y = 0; y < w.line_count; ++y) {
        for (std::size_t v = 0; v < vectors; ++v)
            line[v] = lit(0.0);
        for (int x = 0; x < w.column_count; ++x) {
            const std::size_t from = static_cast<std::size_t>(w.lines[y]) * w.width + static_cast<std::size_t>(w.columns[x]);
            const auto channel = [&](std::size_t c) { return all_lanes(w.planes[c][from]); };
            const lobe_place<real> place = lobe_place_of(texel<real>{channel(0), channel(1), channel(2), channel(3), channel(4)});
            const real share = all_lanes(w.across[x]);
            for (std::size_t v = 0; v < vectors; ++v) {
                const light l = light_at([&](std::size_t k) { return get(w.rows + k * pairs + v * kLane); });
                line[v] += radiance<lobe>(place, l) * share;
            }
        }
        const real share = all_lanes(w.down[y]);
        for (std::size_t v = 0; v < vectors; ++v)
            sum[v] += line[v] * share;
    }
    for (std::size_t v = 0; v < vectors; ++v)
        put(w.out + v * kLane, sum[v]);
}

BN_FN light light_of_pair(const net::FitWork& w, int p)
{
    return light_at([&](std::size_t k) { return all_lanes(w.rows[k * static_cast<std::size_t>(w.pairs) + static_cast<std::size_t>(p)]); });
}

// Returns a pair's radiance: the lobe's x plus other lobes' radiance.
template <class V> BN_FN V beside(const net::FitWork& w, const V& x, int p, std::size_t slot)
{
    return w.rest ? x * all_lanes(w.share) + get(w.rest + static_cast<std::size_t>(p) * kSlotCount + slot) : x;
}

// Returns the loss over all pairs, for the texels from `slot` on.
template <int lobe> __attribute__((noinline)) real fit_loss(const net::FitWork& w, std::size_t slot, const texel<real>& t)
{
    const lobe_place<real> place = lobe_place_of(t);
    real sum = lit(0.0);
    for (int p = 0; p < w.pairs; ++p) {
        const real e = tone(beside(w, radiance<lobe>(place, light_of_pair(w, p)), p, slot)).shown -
                       get(w.shown + static_cast<std::size_t>(p) * kSlotCount + slot);
        sum += max(e, -e);
    }
    return sum;
}

BN_FN texel<real> chosen(const mask& first, const texel<real>& a, const texel<real>& b)
{
    return {select(first, a.nx, b.nx), select(first, a.ny, b.ny), select(first, a.a, b.a), select(first, a.b, b.b),
            select(first, a.c, b.c)};
}

// Computes the gradient of the loss over `batch` pairs from `first` on, by nx, ny, a, b, c.
template <int lobe>
__attribute__((noinline)) void fit_slope(const net::FitWork& w, std::size_t slot, int first, const texel<real>& t, real* slope)
{
    const real zero = lit(0.0), one = lit(1.0);
    const texel<dual> x = {{t.nx, one, zero, zero, zero, zero},
                           {t.ny, zero, one, zero, zero, zero},
                           {t.a, zero, zero, one, zero, zero},
                           {t.b, zero, zero, zero, one, zero},
                           {t.c, zero, zero, zero, zero, one}};
    const lobe_place<dual> place = lobe_place_of(x);
    for (std::size_t c = 0; c < kPlanes; ++c)
        slope[c] = zero;
    for (int p = first; p < first + w.batch; ++p) {
        const dual r = beside(w, radiance<lobe>(place, light_of_pair(w, p)), p, slot);
        const tone_pair found = tone(r.v);
        const real e = found.shown - get(w.shown + static_cast<std::size_t>(p) * kSlotCount + slot);
        const real by = select(e > zero, found.slope, select(e < zero, -found.slope, zero));
        slope[0] += by * r.d0, slope[1] += by * r.d1, slope[2] += by * r.d2, slope[3] += by * r.d3, slope[4] += by * r.d4;
    }
}

// Runs Adam (Kingma, Ba 2015) on the normal in units of the lobe's mean width, on log a and log b, and on c / sqrt(a b). The rate falls to
// 0.
template <int lobe> __attribute__((noinline)) texel<real> moved(const net::FitWork& w, std::size_t slot, const texel<real>& from)
{
    texel<real> t = from;
    real first[kPlanes], second[kPlanes];
    for (std::size_t c = 0; c < kPlanes; ++c)
        first[c] = second[c] = lit(0.0);
    float first_left = 1.0f, second_left = 1.0f; // powers of the decays
    for (int step = 0; step < w.steps; ++step) {
        real s[kPlanes];
        fit_slope<lobe>(w, slot, step * w.batch % w.pairs, t, s);
        // Change variables
        const real width = (t.a + t.b) * lit(0.5), mixed = sqrt(t.a * t.b);
        const real by[kPlanes] = {s[0] * width, s[1] * width, s[2] * t.a + s[4] * t.c * lit(0.5), s[3] * t.b + s[4] * t.c * lit(0.5),
                                  s[4] * mixed};
        first_left *= kFirstDecay, second_left *= kSecondDecay;
        const real rate = all_lanes(kFitRate * (1.0f - static_cast<float>(step) / static_cast<float>(w.steps)) / (1.0f - first_left));
        const real unbiased = all_lanes(1.0f / (1.0f - second_left));
        real step_by[kPlanes];
        // Update the moments, and step
        for (std::size_t c = 0; c < kPlanes; ++c) {
            first[c] = first[c] * all_lanes(kFirstDecay) + by[c] * all_lanes(1.0f - kFirstDecay);
            second[c] = second[c] * all_lanes(kSecondDecay) + by[c] * by[c] * all_lanes(1.0f - kSecondDecay);
            step_by[c] = rate * first[c] / (sqrt(second[c] * unbiased) + lit(1e-12));
        }
        const real skew = t.c / mixed - step_by[4];
        t.nx = t.nx - step_by[0] * width, t.ny = t.ny - step_by[1] * width;
        t.a = t.a * exp_of(-step_by[2]), t.b = t.b * exp_of(-step_by[3]);
        t.c = max(min(skew, lit(1.0)), lit(-1.0)) * sqrt(t.a * t.b);
        t = proj(t);
    }
    return t;
}

template <int lobe> void fit_of(const net::FitWork& w)
{
    // Tonemap the target
    for (std::size_t i = 0; i < static_cast<std::size_t>(w.pairs) * kSlotCount; i += kLane)
        put(w.shown + i, tone(get(w.radiance + i)).shown);
    for (std::size_t slot = 0; slot < kSlotCount; slot += kLane) {
        texel<real> best = {};
        // Find the best start
        real least = lit(0.0);
        for (int s = 0; s < w.start_count; ++s) {
            const auto at = [&](std::size_t c) { return get(w.starts + (static_cast<std::size_t>(s) * kPlanes + c) * kSlotCount + slot); };
            const texel<real> t = {at(0), at(1), at(2), at(3), at(4)};
            const real loss = fit_loss<lobe>(w, slot, t);
            const mask better = loss < least;
            best = s == 0 ? t : chosen(better, t, best);
            least = s == 0 ? loss : select(better, loss, least);
        }
        // Optimise from there
        const texel<real> found = moved<lobe>(w, slot, best);
        const real loss = fit_loss<lobe>(w, slot, found);
        const mask better = loss < least * lit(0.99); // a smaller gain is noise
        best = chosen(better, found, best);
        if (w.loss)
            put(w.loss + slot, select(better, loss, least) / all_lanes(static_cast<float>(w.pairs)));
        const real channel[kPlanes] = {best.nx, best.ny, best.a, best.b, best.c};
        for (std::size_t c = 0; c < kPlanes; ++c)
            put(w.out + c * kSlotCount + slot, channel[c]);
    }
}

template <template <int> class Run, class Work> void by_lobe(const Work& work)
{
    switch (work.lobe) {
    case net::Lobe::ggx_aniso:
        return Run<0>::run(work);
    case net::Lobe::beckmann:
        return Run<1>::run(work);
    case net::Lobe::ashikhmin_shirley:
        return Run<2>::run(work);
    }
}

template <int lobe> struct Light {
    static void run(const net::PairLights& work) { light_rows<lobe>(work); }
};
template <int lobe> struct Gather {
    static void run(const net::GatherWork& work) { gather_of<lobe>(work); }
};
template <int lobe> struct Fit {
    static void run(const net::FitWork& work) { fit_of<lobe>(work); }
};

constexpr net::MipOptimiserFns kMipOptimiserFns = {by_lobe<Light, net::PairLights>, by_lobe<Gather, net::GatherWork>,
                                                   by_lobe<Fit, net::FitWork>};

} // namespace
} // namespace mipnet_lanes

BN_DEFINE_FNS(mipnet::MipOptimiserFns, mipnet_lanes::kMipOptimiserFns)

} // namespace BN_ISA_NS
} // namespace burnish
