#include "shading/bake/mip/filter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "shading/bake/mip/net_levels.h"
#include "shading/bake/mip/slopes.h"
#include "shading/bake/mip/texture.h"
#include "shading/bake/mipnet/shipped.h"
#include "shading/surface/tensor.k.h"

namespace burnish {

const std::vector<MipFilterInfo>& mip_filters()
{
    static const std::vector<MipFilterInfo> table = {
#define BN_MIP_FILTER(id, at, name, summary) {name, summary},
#include "shading/models.def"
    };
    return table;
}

bool makes_lobes(MipFilter filter)
{
    return filter != kMipFilter_box && filter != kMipFilter_lean;
}

bool takes_kappa(MipFilter filter)
{
    return filter == kMipFilter_kappa || filter == kMipFilter_mipnet;
}

float gain_of_taps(MipFilter filter, float kappa)
{
    if (takes_kappa(filter))
        return std::sqrt(0.5f * kappa);
    if (filter == kMipFilter_ssgt)
        return std::sqrt(0.5f);
    return filter == kMipFilter_leadr ? 1.0f : 0.0f;
}

namespace {

// What is averaged. Of baseline: normal, a, b, c. Of covariance: normal, covariance. Of leadr: mean slope, covariance of slopes. Of ssgt
// and kappa: normal, squared widths in space.
struct State {
    std::array<float, 9> v;
};
struct Shape {
    std::size_t means, count; // of them the first are means that spread; the rest follow
    float spread;             // how much of what means differ by joins the rest, xx yy (zz) xy (xz yz)
};
Shape shape_of(MipFilter filter, float kappa)
{
    if (filter == kMipFilter_leadr)
        return {2, 5, 1.0f};
    if (filter == kMipFilter_ssgt)
        return {3, 9, 1.0f};
    if (filter == kMipFilter_kappa)
        return {3, 9, kappa};
    return {3, 6, 0.0f};
}

real3 unit_or_up(real3 n)
{
    const float length = std::sqrt((n.x * n.x + n.y * n.y) + n.z * n.z);
    return length > 1e-6f ? vec3_of(n.x / length, n.y / length, n.z / length) : vec3_of(0.0f, 0.0f, 1.0f);
}

real3 normal_of_slope(real2 slope)
{
    const float length = std::sqrt(1.0f + (slope.x * slope.x + slope.y * slope.y));
    return vec3_of(slope.x / length, slope.y / length, 1.0f / length);
}

slope_covariance scaled(slope_covariance s, float by)
{
    return {s.xx * by, s.yy * by, s.xy * by};
}

State state_of(MipFilter filter, const MipPoint& p)
{
    if (filter == kMipFilter_baseline) {
        const lobe_tensor t = projected_tensor(tensor_of_covariance(p.s));
        return {{p.n.x, p.n.y, p.n.z, t.a, t.b, t.c}};
    }
    if (filter == kMipFilter_covariance)
        return {{p.n.x, p.n.y, p.n.z, p.s.xx, p.s.yy, p.s.xy}};
    if (filter == kMipFilter_leadr) {
        const float steep = std::sqrt(p.n.x * p.n.x + p.n.y * p.n.y) / (kMostSlope * p.n.z), keep = steep > 1.0f ? 1.0f / steep : 1.0f;
        const real2 slope = vec2_of(keep * p.n.x / p.n.z, keep * p.n.y / p.n.z);
        const slope_covariance s = covariance_from_frame(normal_of_slope(slope), p.s);
        return {{slope.x, slope.y, s.xx, s.yy, s.xy}};
    }
    const space_covariance s = covariance_in_space(p.n, scaled(p.s, 2.0f));
    return {{p.n.x, p.n.y, p.n.z, s.xx, s.yy, s.zz, s.xy, s.xz, s.yz}};
}

MipTexel texel_of(MipFilter filter, const State& s)
{
    const auto& v = s.v;
    real3 n = unit_or_up(vec3_of(v[0], v[1], v[2]));
    lobe_tensor t = {v[3], v[4], v[5]};
    if (filter == kMipFilter_covariance)
        t = tensor_of_covariance({v[3], v[4], v[5]});
    else if (filter == kMipFilter_leadr) {
        n = normal_of_slope(vec2_of(v[0], v[1]));
        t = tensor_of_covariance(covariance_to_frame(n, {v[2], v[3], v[4]}));
    } else if (filter == kMipFilter_kappa) {
        t = tensor_of_covariance(scaled(covariance_seen_from(n, {v[3], v[4], v[5], v[6], v[7], v[8]}), 0.5f));
    } else if (filter == kMipFilter_ssgt) {
        const real3 mean = vec3_of(v[0], v[1], v[2]);
        const space_covariance spread = {v[3], v[4], v[5], v[6], v[7], v[8]};
        n = unit_or_up(sggx_product(mean, spread, n)); // towards its axis: after this the mean slope is of second order
        t = tensor_of_covariance(scaled(sggx_lobe(n, mean, spread).spread, 0.5f));
    }
    t = projected_tensor(t);
    return {n.x, n.y, t.a, t.b, t.c};
}

// Pairs of means whose product a place of the rest is of.
struct Pair {
    std::size_t i, j;
};
constexpr Pair kFlatPairs[] = {{0, 0}, {1, 1}, {0, 1}};
constexpr Pair kSpacePairs[] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

// Means are of unit normals again where a filter goes on from level to level.
void settle(MipFilter filter, State& s)
{
    if (filter != kMipFilter_baseline)
        return;
    const real3 n = unit_or_up(vec3_of(s.v[0], s.v[1], s.v[2]));
    s.v[0] = n.x, s.v[1] = n.y, s.v[2] = n.z;
}

// Of four texels alike, in a square: the sum of both diagonals has the same bits however the square is mirrored or turned.
State merged(const Shape& shape, const State& a, const State& b, const State& c, const State& d)
{
    State r = {};
    for (std::size_t k = 0; k < shape.count; ++k)
        r.v[k] = 0.25f * ((a.v[k] + d.v[k]) + (b.v[k] + c.v[k]));
    if (shape.spread == 0.0f)
        return r;
    const Pair* pairs = shape.means == 3 ? kSpacePairs : kFlatPairs;
    for (std::size_t k = shape.means; k < shape.count; ++k) {
        const auto [i, j] = pairs[k - shape.means];
        const auto product = [&, i = i, j = j](const State& s) { return (s.v[i] - r.v[i]) * (s.v[j] - r.v[j]); };
        r.v[k] += shape.spread * (0.25f * ((product(a) + product(d)) + (product(b) + product(c))));
    }
    return r;
}

struct Share { // of a texel or row of a finer level
    int at;
    double weight;
};
// Texel i of `target` covers these of `source`, exactly.
std::vector<Share> shares_of(int i, int source, int target)
{
    std::vector<Share> shares;
    const std::int64_t s = source, t = target; // units of 1 / target texels of the source
    for (std::int64_t k = i * s / t; k < ((i + 1) * s + t - 1) / t; ++k) {
        const std::int64_t overlap = std::min((k + 1) * t, (i + 1) * s) - std::max(k * t, i * s);
        shares.push_back({static_cast<int>(k), static_cast<double>(overlap) / static_cast<double>(s)});
    }
    return shares;
}

// rows: those of `down`, one after the other, `width` texels each.
State merged_of_many(const Shape& shape, const State* rows, int width, const std::vector<Share>& down, const std::vector<Share>& across)
{
    std::array<double, 9> sum = {};
    const auto each = [&](auto&& use) {
        for (std::size_t y = 0; y < down.size(); ++y)
            for (const Share& x : across)
                use(rows[y * static_cast<std::size_t>(width) + static_cast<std::size_t>(x.at)], down[y].weight * x.weight);
    };
    each([&](const State& s, double weight) {
        for (std::size_t k = 0; k < shape.count; ++k)
            sum[k] += weight * static_cast<double>(s.v[k]);
    });
    const std::array<double, 9> mean = sum;
    if (shape.spread > 0.0f) {
        const Pair* pairs = shape.means == 3 ? kSpacePairs : kFlatPairs;
        each([&](const State& s, double weight) {
            for (std::size_t k = shape.means; k < shape.count; ++k) {
                const auto [i, j] = pairs[k - shape.means];
                sum[k] += static_cast<double>(shape.spread) * weight * (static_cast<double>(s.v[i]) - mean[i]) *
                          (static_cast<double>(s.v[j]) - mean[j]);
            }
        });
    }
    State r = {};
    for (std::size_t k = 0; k < shape.count; ++k)
        r.v[k] = static_cast<float>(sum[k]);
    return r;
}

struct StateLevel {
    int width = 0, height = 0;
    std::vector<State> states;
};

// One level from a finer one, or from the source where `from` is null.
class LevelMaker {
  public:
    LevelMaker(const MipSource& source, const StateLevel* from, MipFilter filter, const Shape& shape)
        : source_(source), from_(from), filter_(filter), shape_(shape), width_(from ? from->width : source.width()),
          height_(from ? from->height : source.height())
    {
    }

    void make(StateLevel& to, MipLevel& level, const Jobs& jobs) const
    {
        const auto halves = [](int source, int target) { return source == 2 * target || source == target; };
        const bool square = halves(width_, to.width) && halves(height_, to.height);
        jobs.parallel_for(static_cast<std::size_t>(to.height), [&](std::size_t y, int) {
            const std::vector<Share> down = shares_of(static_cast<int>(y), height_, to.height);
            const std::vector<State> rows = rows_of(down);
            const std::size_t first = y * static_cast<std::size_t>(to.width);
            for (int x = 0; x < to.width; ++x) {
                State& out = to.states[first + static_cast<std::size_t>(x)];
                out = square ? of_square(rows, x, to.width)
                             : merged_of_many(shape_, rows.data(), width_, down, shares_of(x, width_, to.width));
                settle(filter_, out);
                level.texels[first + static_cast<std::size_t>(x)] = texel_of(filter_, out);
            }
        });
    }

  private:
    std::vector<State> rows_of(const std::vector<Share>& down) const
    {
        const auto width = static_cast<std::size_t>(width_);
        std::vector<State> rows(down.size() * width);
        std::vector<MipPoint> points(from_ ? 0 : width);
        for (std::size_t i = 0; i < down.size(); ++i) {
            State* to = rows.data() + i * width;
            if (from_) {
                std::copy_n(from_->states.data() + static_cast<std::size_t>(down[i].at) * width, width, to);
                continue;
            }
            source_.row(down[i].at, points.data());
            for (std::size_t x = 0; x < width; ++x)
                to[x] = state_of(filter_, points[x]);
        }
        return rows;
    }

    State of_square(const std::vector<State>& rows, int x, int width) const
    {
        const bool wide = width_ == 2 * width;
        const State* top = rows.data() + static_cast<std::size_t>(wide ? 2 * x : x);
        const State* bottom = rows.size() > static_cast<std::size_t>(width_) ? top + width_ : top;
        return merged(shape_, top[0], top[wide], bottom[0], bottom[wide]);
    }

    const MipSource& source_;
    const StateLevel* from_;
    MipFilter filter_;
    Shape shape_;
    int width_, height_;
};

} // namespace

MipLevels make_mip_levels(const MipSource& source, MipFilter filter, float kappa, const Jobs& jobs, const mipnet::Weights* net)
{
    BN_CHECK(makes_lobes(filter));
    MipLevels made;
    made.filter = filter, made.kappa = takes_kappa(filter) ? kappa : 0.0f;
    made.width = source.width(), made.height = source.height();
    made.source = source.hash(jobs);
    if (filter == kMipFilter_mipnet) {
        put_net_levels(source, net ? *net : *mipnet::shipped_weights(mipnet::Lobe::ggx_aniso), jobs, made);
        return made;
    }
    const Shape shape = shape_of(filter, made.kappa);
    const int side = std::max(made.width, made.height);
    std::vector<StateLevel> states(1); // level 0 is the source
    for (int l = 1; l < kMaxTextureLevels && (side >> l) > 0; ++l) {
        StateLevel next;
        next.width = std::max(1, made.width >> l), next.height = std::max(1, made.height >> l);
        next.states.resize(static_cast<std::size_t>(next.width) * static_cast<std::size_t>(next.height));
        // from the smallest earlier level whose texels its footprints are unions of, as make_texture_pyramid() does
        std::size_t from = states.size() - 1;
        while (from > 0 && (states[from].width % next.width != 0 || states[from].height % next.height != 0))
            --from;
        MipLevel level = {next.width, next.height, std::vector<MipTexel>(next.states.size())};
        LevelMaker(source, from > 0 ? &states[from] : nullptr, filter, shape).make(next, level, jobs);
        made.levels.push_back(std::move(level));
        states.push_back(std::move(next));
    }
    return made;
}

} // namespace burnish
