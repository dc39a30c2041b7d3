#include "shading/bake/mip/filter.h"

#include <algorithm>
#include <array>
#include <atomic>
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

bool takes_net(MipFilter filter)
{
    return filter == kMipFilter_mipnet || filter == kMipFilter_teacher;
}

bool takes_kappa(MipFilter filter)
{
    return filter == kMipFilter_kappa || takes_net(filter);
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

constexpr int kMostBanded = 5;

struct StateLevel {
    int width = 0, height = 0;
    std::vector<State> states;
};

// One level from a finer one, or from the source where `from` is null.
class LevelMaker {
  public:
    LevelMaker(const MipRows& source, const StateLevel* from, MipFilter filter, const Shape& shape)
        : source_(source), from_(from), filter_(filter), shape_(shape), width_(from ? from->width : source.width),
          height_(from ? from->height : source.height)
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

    const MipRows& source_;
    const StateLevel* from_;
    MipFilter filter_;
    Shape shape_;
    int width_, height_;
};

int levels_of(int width, int height) // from 1 on
{
    int levels = 0;
    while (levels + 1 < kMaxTextureLevels && (std::max(width, height) >> (levels + 1)) > 0)
        ++levels;
    return levels;
}

StateLevel level_of(const MipRows& level0, int l)
{
    StateLevel level;
    level.width = std::max(1, level0.width >> l), level.height = std::max(1, level0.height >> l);
    return level;
}

// The finer level that level l is made from, as make_texture_pyramid() has it: the smallest whose texels its footprints are unions of.
int finer_level(const MipRows& level0, int l)
{
    const StateLevel to = level_of(level0, l);
    int from = l - 1;
    for (; from > 0; --from)
        if (const StateLevel of = level_of(level0, from); of.width % to.width == 0 && of.height % to.height == 0)
            break;
    return from;
}

// Levels after `first`, whose states are `banded` (or after level 0), up to `last`; returns the states of the last one.
StateLevel put_levels_from(const MipRows& level0, int first, StateLevel banded, int last, MipFilter filter, const Shape& shape,
                           const Jobs& jobs, std::vector<MipLevel>& made)
{
    std::vector<StateLevel> states(1);
    states[0] = std::move(banded);
    for (int l = first + 1; l <= last; ++l) {
        StateLevel next = level_of(level0, l);
        next.states.resize(static_cast<std::size_t>(next.width) * static_cast<std::size_t>(next.height));
        const int from = finer_level(level0, l);
        MipLevel level = {next.width, next.height, std::vector<MipTexel>(next.states.size())};
        LevelMaker(level0, from > 0 ? &states[static_cast<std::size_t>(from - first)] : nullptr, filter, shape).make(next, level, jobs);
        made.push_back(std::move(level));
        states.push_back(std::move(next));
    }
    return std::move(states.back());
}

// How many levels can be made of bands of rows, whose states nothing else needs: sides are halved without a rest.
int banded_levels(int width, int height)
{
    const MipRows sides = {width, height, {}};
    int levels = 0;
    while (levels < kMostBanded && (width >> levels) % 2 == 0 && (height >> levels) % 2 == 0)
        ++levels;
    const auto stays = [&](int banded) {
        for (int l = banded + 1; l <= levels_of(width, height); ++l)
            if (finer_level(sides, l) < banded)
                return false;
        return true;
    };
    while (levels > 0 && !stays(levels))
        --levels;
    return levels;
}

// Levels 1 to `levels`, and the states of the last one.
StateLevel make_banded_levels(const MipRows& level0, int levels, MipFilter filter, const Shape& shape, const Jobs& jobs,
                              std::vector<MipLevel>& made)
{
    for (int l = 1; l <= levels; ++l) {
        const StateLevel size = level_of(level0, l);
        made.push_back(
            {size.width, size.height, std::vector<MipTexel>(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height))});
    }
    StateLevel last = level_of(level0, levels);
    last.states.resize(made.back().texels.size());
    jobs.parallel_for(static_cast<std::size_t>(level0.height >> levels), [&](std::size_t band, int) {
        const int first = static_cast<int>(band) << levels;
        const MipRows rows = {level0.width, 1 << levels, [&](int y, MipPoint* to) { level0.row(first + y, to); }};
        std::vector<MipLevel> of_band;
        const StateLevel state = put_levels_from(rows, 0, {}, levels, filter, shape, Jobs(1), of_band);
        for (std::size_t l = 0; l < of_band.size(); ++l)
            std::copy(of_band[l].texels.begin(), of_band[l].texels.end(),
                      made[l].texels.begin() + static_cast<std::ptrdiff_t>(band * of_band[l].texels.size()));
        std::copy(state.states.begin(), state.states.end(), last.states.begin() + static_cast<std::ptrdiff_t>(band * state.states.size()));
    });
    return last;
}

} // namespace

MipRows rows_of(const MipSource& source)
{
    return {source.width(), source.height(), [&source](int y, MipPoint* to) { source.row(y, to); }};
}

MipRows rows_of_texels(const mipnet::Texels& texels)
{
    return {texels.width, texels.height, [&texels](int y, MipPoint* to) {
                const std::size_t width = static_cast<std::size_t>(texels.width), first = static_cast<std::size_t>(y) * width;
                for (std::size_t x = 0; x < width; ++x) {
                    const auto at = [&](std::size_t c) { return texels.channel[c][first + x]; };
                    const float nz = std::sqrt(std::max(1.0f - (at(0) * at(0) + at(1) * at(1)), 0.0f));
                    to[x] = {vec3_of(at(0), at(1), nz), covariance_of_tensor({at(2), at(3), at(4)})};
                }
            }};
}

std::vector<MipLevel> make_mean_levels(const MipRows& level0, MipFilter filter, float kappa, const Jobs& jobs)
{
    BN_CHECK(makes_lobes(filter) && !takes_net(filter));
    const Shape shape = shape_of(filter, kappa);
    const int first = banded_levels(level0.width, level0.height);
    std::vector<MipLevel> made;
    StateLevel banded;
    if (first > 0)
        banded = make_banded_levels(level0, first, filter, shape, jobs, made);
    put_levels_from(level0, first, std::move(banded), levels_of(level0.width, level0.height), filter, shape, jobs, made);
    return made;
}

namespace {

// Rows of level 0, hashed where they are first read: what levels are made of is not decoded again for its hash.
class HashedRows {
  public:
    explicit HashedRows(const MipSource& source) : source_(source), hashes_(static_cast<std::size_t>(source.height())) {}

    MipRows rows()
    {
        return {source_.width(), source_.height(), [this](int y, MipPoint* to) {
                    source_.row(y, to);
                    std::atomic<std::uint64_t>& hash = hashes_[static_cast<std::size_t>(y)];
                    if (hash.load(std::memory_order_relaxed) == 0)
                        hash.store(MipSource::hash_of_row(to, source_.width()), std::memory_order_relaxed);
                }};
    }

    std::uint64_t hash()
    {
        std::vector<MipPoint> points(static_cast<std::size_t>(source_.width()));
        std::vector<std::uint64_t> all;
        for (int y = 0; y < source_.height(); ++y) {
            const std::atomic<std::uint64_t>& hash = hashes_[static_cast<std::size_t>(y)];
            if (hash.load(std::memory_order_relaxed) == 0) // no level was made of it
                rows().row(y, points.data());
            all.push_back(hash.load(std::memory_order_relaxed));
        }
        return source_.hash_of_rows(all);
    }

  private:
    const MipSource& source_;
    std::vector<std::atomic<std::uint64_t>> hashes_;
};

} // namespace

MipLevels make_mip_levels(const MipSource& source, MipFilter filter, float kappa, const Jobs& jobs, const MipHelp& help)
{
    BN_CHECK(makes_lobes(filter));
    MipLevels made;
    made.filter = filter, made.kappa = takes_kappa(filter) ? kappa : 0.0f;
    made.width = source.width(), made.height = source.height();
    HashedRows level0(source);
    const mipnet::Weights& net = help.net ? *help.net : *mipnet::shipped_weights(mipnet::Lobe::ggx_aniso);
    if (filter == kMipFilter_mipnet)
        put_net_levels(level0.rows(), net, jobs, made);
    else if (filter == kMipFilter_teacher)
        put_taught_levels(level0.rows(), net, help, jobs, made);
    else
        made.levels = make_mean_levels(level0.rows(), filter, made.kappa, jobs);
    made.source = level0.hash();
    return made;
}

} // namespace burnish
