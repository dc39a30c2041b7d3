#include "shading/bake/mip/filter.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/base/check.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mip/level_gains.h"
#include "shading/bake/mip/mean_fns.h"
#include "shading/bake/mip/net_levels.h"
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

std::uint32_t gained_of(mipnet::Lobe lobe, bool metal)
{
    return 1u + 2u * static_cast<std::uint32_t>(lobe) + (metal ? 1u : 0u);
}

bool gained_metal(std::uint32_t gained)
{
    return gained != 0 && (gained - 1u) % 2u == 1u;
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

bool takes_gains(MipFilter filter)
{
    return filter == kMipFilter_ssgt || takes_kappa(filter);
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

struct Shape { // layout of states, see mip::Mean
    mip::Mean mean;
    std::size_t means, count; // a state's first numbers are means that spread; the rest follow
    float spread;             // factor of the means' spread that joins the rest: xx yy (zz) xy (xz yz)
};
Shape shape_of(MipFilter filter, float kappa)
{
    if (filter == kMipFilter_leadr)
        return {mip::Mean::leadr, 2, 5, 1.0f};
    if (filter == kMipFilter_ssgt)
        return {mip::Mean::ssgt, 3, 9, 1.0f};
    if (filter == kMipFilter_kappa)
        return {mip::Mean::kappa, 3, 9, kappa};
    return {filter == kMipFilter_covariance ? mip::Mean::covariance : mip::Mean::baseline, 3, 6, 0.0f};
}

// Planes in a row of states.
struct StateRow {
    const float* first;
    std::size_t stride;
    float at(std::size_t k, int x) const { return first[k * stride + static_cast<std::size_t>(x)]; }
};

// Merges a footprint's texels. rows: one per entry of `down`. to: texel x in a row of states.
void merge_many(const Shape& shape, const std::vector<StateRow>& rows, const std::vector<TexelShare>& down,
                const std::vector<TexelShare>& across, float* to, std::size_t stride)
{
    std::array<double, mip::kMostStates> sum = {};
    const auto each = [&](auto&& use) {
        for (std::size_t y = 0; y < down.size(); ++y)
            for (const TexelShare& x : across)
                use([&](std::size_t k) { return static_cast<double>(rows[y].at(k, x.at)); }, down[y].weight * x.weight);
    };
    // Average all numbers
    each([&](const auto& s, double weight) {
        for (std::size_t k = 0; k < shape.count; ++k)
            sum[k] += weight * s(k);
    });
    const auto mean = sum;
    // Add the spread of the means
    if (shape.spread > 0.0f) {
        const mip::MeanPair* pairs = shape.means == 3 ? mip::kSpacePairs : mip::kFlatPairs;
        each([&](const auto& s, double weight) {
            for (std::size_t k = shape.means; k < shape.count; ++k) {
                const auto [i, j] = pairs[k - shape.means];
                sum[k] += static_cast<double>(shape.spread) * weight * (s(i) - mean[i]) * (s(j) - mean[j]);
            }
        });
    }
    for (std::size_t k = 0; k < shape.count; ++k)
        to[k * stride] = static_cast<float>(sum[k]);
}

struct StateLevel {
    int width = 0, height = 0;
    std::vector<float> states; // by row, then number: planes of mip::row_stride(width)

    std::size_t stride() const { return mip::row_stride(static_cast<std::size_t>(width)); }
    void make_room(const Shape& shape) { states.resize(static_cast<std::size_t>(height) * shape.count * stride()); }
    std::size_t place(const Shape& shape, int y) const { return static_cast<std::size_t>(y) * shape.count * stride(); }
};

// Makes a level from a finer one, or from the source if `from` is null.
class LevelMaker {
  public:
    LevelMaker(const MipRows& source, const StateLevel* from, const Shape& shape)
        : source_(source), from_(from), shape_(shape), width_(from ? from->width : source.width),
          height_(from ? from->height : source.height), stride_(mip::row_stride(static_cast<std::size_t>(width_)))
    {
    }

    void make(StateLevel& to, MipLevel& level, const Jobs& jobs) const
    {
        const auto halves = [](int source, int target) { return source == 2 * target || source == target; };
        const bool square = halves(width_, to.width) && halves(height_, to.height);
        std::vector<std::vector<float>> memory(static_cast<std::size_t>(jobs.threads()));
        jobs.parallel_for(static_cast<std::size_t>(to.height), [&](std::size_t y, int worker) {
            // Find the finer rows under this row, and merge their texels
            const std::vector<TexelShare> down = shares_of(static_cast<int>(y), height_, to.height);
            const std::vector<StateRow> rows = rows_of(down, memory[static_cast<std::size_t>(worker)]);
            const std::size_t width = static_cast<std::size_t>(to.width), stride = to.stride();
            float* const states = to.states.data() + to.place(shape_, static_cast<int>(y));
            if (square)
                fns_.merge({shape_.mean, shape_.spread, width, stride, rows.front().first, rows.back().first, stride_,
                            width_ == 2 * to.width ? 2 : 1, states});
            else
                for (int x = 0; x < to.width; ++x)
                    merge_many(shape_, rows, down, shares_of(x, width_, to.width), states + x, stride);
            fns_.texels({shape_.mean, width, stride, states, &level.texels[y * width].nx});
        });
    }

  private:
    std::vector<StateRow> rows_of(const std::vector<TexelShare>& down, std::vector<float>& memory) const
    {
        std::vector<StateRow> rows;
        const std::size_t points = mip::kPointPlanes * stride_, states = shape_.count * stride_;
        if (!from_ && memory.size() < points + down.size() * states)
            memory.resize(points + down.size() * states);
        for (std::size_t i = 0; i < down.size(); ++i) {
            if (from_) {
                rows.push_back({from_->states.data() + from_->place(shape_, down[i].at), stride_});
                continue;
            }
            float* const to = memory.data() + points + i * states;
            source_.planes(down[i].at, memory.data());
            fns_.states({shape_.mean, static_cast<std::size_t>(width_), stride_, memory.data(), to});
            rows.push_back({to, stride_});
        }
        return rows;
    }

    const MipRows& source_;
    const StateLevel* from_;
    const mip::Fns& fns_ = pick<mip::Fns>();
    Shape shape_;
    int width_, height_;
    std::size_t stride_;
};

StateLevel level_of(const MipRows& level0, int l)
{
    StateLevel level;
    level.width = std::max(1, level0.width >> l), level.height = std::max(1, level0.height >> l);
    return level;
}

MipLevel empty_level(const StateLevel& of)
{
    return {of.width, of.height, std::vector<MipTexel>(static_cast<std::size_t>(of.width) * static_cast<std::size_t>(of.height))};
}

// Makes levels after `first` up to `last`. banded: level `first`'s states, unused for level 0. Returns the last level's states.
StateLevel put_levels_from(const MipRows& level0, int first, StateLevel banded, int last, const Shape& shape, const Jobs& jobs,
                           std::vector<MipLevel>& made)
{
    std::vector<StateLevel> states(1);
    states[0] = std::move(banded);
    for (int l = first + 1; l <= last; ++l) {
        StateLevel next = level_of(level0, l);
        next.make_room(shape);
        const int from = finer_level(level0.width, level0.height, l);
        MipLevel level = empty_level(next);
        LevelMaker(level0, from > 0 ? &states[static_cast<std::size_t>(from - first)] : nullptr, shape).make(next, level, jobs);
        made.push_back(std::move(level));
        states.push_back(std::move(next));
    }
    return std::move(states.back());
}

// Makes levels 1 to `levels` in bands of rows, and returns the last one's states. A band needs little memory.
StateLevel make_banded_levels(const MipRows& level0, int levels, const Shape& shape, const Jobs& jobs, std::vector<MipLevel>& made)
{
    for (int l = 1; l <= levels; ++l)
        made.push_back(empty_level(level_of(level0, l)));
    StateLevel last = level_of(level0, levels);
    last.make_room(shape);
    jobs.parallel_for(static_cast<std::size_t>(level0.height >> levels), [&](std::size_t band, int) {
        const int first = static_cast<int>(band) << levels;
        const MipRows rows = {level0.width, 1 << levels, [&](int y, float* to) { level0.planes(first + y, to); }};
        std::vector<MipLevel> of_band;
        const StateLevel state = put_levels_from(rows, 0, {}, levels, shape, Jobs(1), of_band);
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
    return {source.width(), source.height(), [&source](int y, float* to) { source.planes(y, to); }};
}

MipRows rows_of_texels(const mipnet::Texels& texels)
{
    return {texels.width, texels.height, [&texels](int y, float* to) {
                const std::size_t width = static_cast<std::size_t>(texels.width), first = static_cast<std::size_t>(y) * width;
                const std::size_t stride = mip::row_stride(width);
                std::fill_n(to, mip::kPointPlanes * stride, 0.0f);
                for (std::size_t x = 0; x < width; ++x) {
                    const auto at = [&](std::size_t c) { return texels.channel[c][first + x]; };
                    const float nz = std::sqrt(std::max(1.0f - (at(0) * at(0) + at(1) * at(1)), 0.0f));
                    const slope_covariance s = covariance_of_tensor({at(2), at(3), at(4)});
                    const float point[mip::kPointPlanes] = {at(0), at(1), nz, s.xx, s.yy, s.xy};
                    for (std::size_t k = 0; k < mip::kPointPlanes; ++k)
                        to[k * stride + x] = point[k];
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
        banded = make_banded_levels(level0, first, shape, jobs, made);
    put_levels_from(level0, first, std::move(banded), levels_below(level0.width, level0.height), shape, jobs, made);
    return made;
}

namespace {

// Rows of level 0, hashed on their first read. So maps are decoded only once for levels and hash.
class HashedRows {
  public:
    explicit HashedRows(const MipSource& source) : source_(source), hashes_(static_cast<std::size_t>(source.height())) {}

    MipRows rows()
    {
        return {source_.width(), source_.height(), [this](int y, float* to) {
                    source_.planes(y, to);
                    std::atomic<std::uint64_t>& hash = hashes_[static_cast<std::size_t>(y)];
                    if (hash.load(std::memory_order_relaxed) == 0)
                        hash.store(source_.hash_of_planes(to), std::memory_order_relaxed);
                }};
    }

    std::uint64_t hash()
    {
        std::vector<float> points(mip::kPointPlanes * mip::row_stride(static_cast<std::size_t>(source_.width())));
        std::vector<std::uint64_t> all;
        for (int y = 0; y < source_.height(); ++y) {
            const std::atomic<std::uint64_t>& hash = hashes_[static_cast<std::size_t>(y)];
            if (hash.load(std::memory_order_relaxed) == 0) // no level has read the row
                rows().planes(y, points.data());
            all.push_back(hash.load(std::memory_order_relaxed));
        }
        return source_.hash_of_rows(all);
    }

  private:
    const MipSource& source_;
    std::vector<std::atomic<std::uint64_t>> hashes_;
};

} // namespace

namespace {

// Computes the gains of all levels, and notes their kind.
void put_gains(const MipSource& source, mipnet::Lobe lobe, bool metal, Gains rule, MipLevels& to)
{
    std::vector<LevelSize> sizes = {{to.width, to.height}};
    for (const MipLevel& level : to.levels)
        sizes.push_back({level.width, level.height});
    const auto texels = [&](int level, std::size_t count, const int* x, const int* y, float* planes) {
        if (level == 0) {
            std::vector<float> points(mip::kPointPlanes * count);
            source.points(count, x, y, points.data());
            pick<mip::Fns>().tensors({count, count, points.data(), planes});
            return;
        }
        const MipLevel& of = to.levels[static_cast<std::size_t>(level) - 1];
        for (std::size_t i = 0; i < count; ++i, ++planes) {
            const MipTexel& t =
                of.texels[static_cast<std::size_t>(y[i]) * static_cast<std::size_t>(of.width) + static_cast<std::size_t>(x[i])];
            planes[0] = t.nx, planes[count] = t.ny, planes[2 * count] = t.a, planes[3 * count] = t.b, planes[4 * count] = t.c;
        }
    };
    const std::vector<float> gains = level_gains(sizes, texels, mip_error_surface(lobe, metal), rule);
    for (std::size_t l = 0; l < gains.size(); ++l)
        to.levels[l].gain = gains[l];
    to.gained = gained_of(lobe, metal);
}

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
        put_optimised_levels(level0.rows(), net, help, jobs, made);
    else
        made.levels = make_mean_levels(level0.rows(), filter, made.kappa, jobs);
    made.source = level0.hash();
    if (help.gains != Gains::none && takes_gains(filter))
        put_gains(source, takes_net(filter) ? net.shape.lobe : help.lobe, help.metal, help.gains, made);
    return made;
}

} // namespace burnish
