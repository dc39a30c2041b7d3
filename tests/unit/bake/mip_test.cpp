// Levels of normals and lobes by mip filters.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <set>

#include "core/simd/dispatch.h"
#include "core/simd/half.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/map_levels.h"
#include "shading/bake/mip/mean_fns.h"
#include "shading/bake/mip/net_levels.h"
#include "shading/bake/mip/pyramid_file.h"
#include "shading/bake/mip/texture_rows.h"
#include "shading/bake/mipnet/shipped.h"
#include "shading/lang/records.h"
#include "shading/surface/tensor.k.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

std::vector<MipFilter> lobe_filters()
{
    std::vector<MipFilter> filters;
    for (std::size_t i = 0; i < mip_filters().size(); ++i)
        if (makes_lobes(static_cast<MipFilter>(i)))
            filters.push_back(static_cast<MipFilter>(i));
    return filters;
}

struct Maps {
    Image normal, roughness, direction;
    MipMaps of() const
    {
        MipMaps maps;
        maps.normal = normal.empty() ? nullptr : &normal;
        maps.roughness = roughness.empty() ? nullptr : &roughness;
        maps.direction = direction.empty() ? nullptr : &direction;
        maps.roughness_factor = 0.6f, maps.anisotropy_strength = 0.8f, maps.anisotropy_rotation = 0.0f;
        return maps;
    }
};

using Texel = std::function<std::array<float, 3>(int x, int y)>;
Image floats(int width, int height, const Texel& texel)
{
    Image image = make_image(width, height, 3, PixelType::f32);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::array<float, 3> t = texel(x, y);
            std::copy(t.begin(), t.end(), image.f32() + 3 * (y * width + x));
        }
    return image;
}

std::array<float, 3> code_of(float x, float y)
{
    return {0.5f + 0.5f * x, 0.5f + 0.5f * y, 0.5f + 0.5f * std::sqrt(1.0f - x * x - y * y)};
}

Maps rough_maps(int width, int height, std::uint64_t seed, double lean = 0.6)
{
    Random random(seed);
    Maps m;
    m.normal = floats(width, height, [&](int, int) { return code_of(random.in(-lean, lean), random.in(-lean, lean)); });
    m.roughness = floats(width, height, [&](int, int) { return std::array{0.0f, random.in(0.2, 1.0), 1.0f}; });
    m.direction = floats(width, height, [&](int, int) {
        const double angle = 6.28 * random();
        return std::array{static_cast<float>(0.5 + 0.5 * std::cos(angle)), static_cast<float>(0.5 + 0.5 * std::sin(angle)),
                          random.in(0.1, 1.0)};
    });
    return m;
}

MipLevels levels_of(const Maps& maps, MipFilter filter, float kappa = 1.1f, int threads = 1)
{
    return make_mip_levels(MipSource(maps.of()), filter, kappa, Jobs(threads));
}

MipTexel alone(const MipPoint& p)
{
    const lobe_tensor t = projected_tensor(tensor_of_covariance(p.s));
    return {p.n.x, p.n.y, t.a, t.b, t.c};
}

void expect_near(const MipTexel& a, const MipTexel& b, double off)
{
    EXPECT_NEAR(a.nx, b.nx, off);
    EXPECT_NEAR(a.ny, b.ny, off);
    EXPECT_NEAR(a.a, b.a, off);
    EXPECT_NEAR(a.b, b.b, off);
    EXPECT_NEAR(a.c, b.c, off);
}

// A map of one normal and one lobe keeps both at each level, flat or tilted. Filtering does not turn tilted lobes.
TEST(mip, one_value_stays_at_every_level)
{
    for (const auto& [width, height] : {std::pair(64, 32), {257, 129}, {1, 64}, {3, 5}, {1, 1}})
        for (const float tilt : {0.0f, 0.5f, -0.9f}) {
            Maps maps;
            maps.normal = floats(width, height, [&](int, int) { return code_of(tilt, 0.3f * tilt); });
            maps.direction = floats(width, height, [](int, int) { return std::array{0.9f, 0.8f, 0.7f}; });
            const MipSource source(maps.of());
            std::vector<MipPoint> row(static_cast<std::size_t>(width));
            source.row(0, row.data());
            for (const MipFilter filter : lobe_filters()) {
                const MipLevels made = levels_of(maps, filter);
                SCOPED_TRACE(testing::Message()
                             << width << "x" << height << " " << tilt << " " << mip_filters()[static_cast<std::size_t>(filter)].name);
                EXPECT_EQ(static_cast<int>(made.levels.size()), static_cast<int>(std::log2(std::max(width, height))));
                for (const MipLevel& level : made.levels)
                    for (const MipTexel& texel : level.texels)
                        expect_near(texel, alone(row[0]), 5e-6);
            }
        }
}

TEST(mip, levels_of_odd_sides_are_exact_means)
{
    for (const auto& [width, height] : {std::pair(257, 129), {1, 64}, {5, 3}, {64, 48}}) {
        const Maps maps = rough_maps(width, height, 7, 0.3);
        const MipSource source(maps.of());
        const MipLevels made = levels_of(maps, kMipFilter_covariance), spread = levels_of(maps, kMipFilter_leadr);
        // the last level is one texel, the mean of all texels
        double n[3] = {}, s[3] = {}, slope[2] = {}, flat[3] = {};
        std::vector<MipPoint> row(static_cast<std::size_t>(width));
        const double share = 1.0 / (static_cast<double>(width) * height);
        for (int y = 0; y < height; ++y) {
            source.row(y, row.data());
            for (const MipPoint& p : row) {
                const float of[6] = {p.n.x, p.n.y, p.n.z, p.s.xx, p.s.yy, p.s.xy};
                for (int i = 0; i < 3; ++i)
                    n[i] += share * static_cast<double>(of[i]), s[i] += share * static_cast<double>(of[i + 3]);
                const double sx = static_cast<double>(p.n.x) / static_cast<double>(p.n.z);
                const double sy = static_cast<double>(p.n.y) / static_cast<double>(p.n.z);
                const slope_covariance own = covariance_from_frame(p.n, p.s);
                slope[0] += share * sx, slope[1] += share * sy;
                flat[0] += share * (static_cast<double>(own.xx) + sx * sx), flat[1] += share * (static_cast<double>(own.yy) + sy * sy);
                flat[2] += share * (static_cast<double>(own.xy) + sx * sy);
            }
        }
        const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        const MipTexel last = made.levels.back().texels.front();
        const slope_covariance got = covariance_of_tensor({last.a, last.b, last.c});
        EXPECT_NEAR(last.nx, n[0] / length, 2e-6);
        EXPECT_NEAR(last.ny, n[1] / length, 2e-6);
        EXPECT_NEAR(got.xx, s[0], 2e-6);
        EXPECT_NEAR(got.yy, s[1], 2e-6);
        EXPECT_NEAR(got.xy, s[2], 2e-6);
        const MipTexel mean = spread.levels.back().texels.front();
        const double steep = std::sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
        EXPECT_NEAR(mean.nx, slope[0] / steep, 3e-6);
        EXPECT_NEAR(mean.ny, slope[1] / steep, 3e-6);
        const real3 up = vec3_of(mean.nx, mean.ny, std::sqrt(1.0f - mean.nx * mean.nx - mean.ny * mean.ny));
        const slope_covariance all = covariance_from_frame(up, covariance_of_tensor({mean.a, mean.b, mean.c}));
        EXPECT_NEAR(all.xx, flat[0] - slope[0] * slope[0], 5e-6);
        EXPECT_NEAR(all.yy, flat[1] - slope[1] * slope[1], 5e-6);
        EXPECT_NEAR(all.xy, flat[2] - slope[0] * slope[1], 5e-6);
    }
}

// Two texels with normals (x, 0) and (-x, 0): the result of each filter, derived by hand.
TEST(mip, filters_widen_lobes_by_what_their_formulas_say)
{
    const float x = 0.4f, z = std::sqrt(1.0f - x * x);
    Maps maps;
    maps.normal = floats(2, 1, [&](int at, int) { return code_of(at == 0 ? x : -x, 0.0f); });
    MipMaps of = maps.of();
    of.roughness_factor = 0.5f, of.anisotropy_strength = 0.0f; // alpha 0.25
    const MipSource source(of);
    const Jobs jobs(1);
    const double a2 = 0.0625, xd = 0.4, z2 = 1.0 - xd * xd, s = xd / static_cast<double>(z);
    const auto widths = [&](MipFilter filter, float kappa) {
        const MipTexel t = make_mip_levels(source, filter, kappa, jobs).levels[0].texels[0];
        EXPECT_NEAR(t.nx, 0.0, 1e-6);
        EXPECT_NEAR(t.c, 0.0, 1e-6);
        return std::pair(static_cast<double>(t.b) * static_cast<double>(t.b), static_cast<double>(t.a) * static_cast<double>(t.a));
    };
    const auto near = [](std::pair<double, double> got, double along, double across) {
        EXPECT_NEAR(got.first, along, 1e-6);
        EXPECT_NEAR(got.second, across, 1e-6);
    };
    near(widths(kMipFilter_baseline, 0.0f), a2, a2);
    near(widths(kMipFilter_covariance, 0.0f), a2, a2);
    near(widths(kMipFilter_kappa, 1.0f), a2 * z2 + xd * xd, a2); // seen at an angle, plus the spread of normals
    near(widths(kMipFilter_kappa, 0.5f), a2 * z2 + 0.5 * xd * xd, a2);
    const double nn = a2 * xd * xd + z2;
    near(widths(kMipFilter_ssgt, 0.0f), (a2 * z2 + xd * xd) / nn, a2 / nn);
    near(widths(kMipFilter_leadr, 0.0f), a2 / (z2 * z2) + 2.0 * s * s, a2 / z2);
    EXPECT_EQ(gain_of_taps(kMipFilter_baseline, 1.0f), 0.0f);
    EXPECT_NEAR(gain_of_taps(kMipFilter_kappa, 2.0f), 1.0f, 1e-6f);
}

// Mirroring a material, or swapping its axes, mirrors or swaps its levels, bit for bit.
TEST(mip, squares_are_filtered_alike_however_they_lie)
{
    constexpr int kSide = 32;
    const Maps maps = rough_maps(kSide, kSide, 3);
    struct Turn {
        bool flip_x, flip_y, swap;
    };
    const auto place = [](const Turn& t, int side, int x, int y) { // the turned map's texel in the original map
        if (t.swap)
            std::swap(x, y);
        return std::pair(t.flip_x ? side - 1 - x : x, t.flip_y ? side - 1 - y : y);
    };
    for (int turns = 1; turns < 8; ++turns) {
        const Turn t = {(turns & 1) != 0, (turns & 2) != 0, (turns & 4) != 0};
        const auto turned_map = [&](const Image& from, bool is_signed) {
            return floats(kSide, kSide, [&](int x, int y) {
                const auto [u, v] = place(t, kSide, x, y);
                const float* texel = from.f32() + 3 * (v * kSide + u);
                std::array<float, 3> to = {texel[0], texel[1], texel[2]};
                if (is_signed) {
                    if (t.flip_x)
                        to[0] = 1.0f - to[0];
                    if (t.flip_y)
                        to[1] = 1.0f - to[1];
                    if (t.swap)
                        std::swap(to[0], to[1]);
                }
                return to;
            });
        };
        // rounded so that 1 - x is exact
        Maps coarse = maps;
        for (std::size_t i = 0; i < coarse.normal.bytes.size() / 4; ++i) {
            coarse.normal.f32()[i] = std::round(coarse.normal.f32()[i] * 4096.0f) / 4096.0f;
            const float d = 2.0f * coarse.direction.f32()[i] - 1.0f; // products are exact, so rounding does not depend on order
            if (i % 3 != 2)
                coarse.direction.f32()[i] = 0.5f + 0.5f * std::copysign(std::exp2(std::floor(std::log2(std::abs(d) + 0.01f))), d);
        }
        const Maps turned = {turned_map(coarse.normal, true), turned_map(coarse.roughness, false), turned_map(coarse.direction, true)};
        const auto without_factor = [](const Maps& m) {
            MipMaps of = m.of();
            of.anisotropy_strength = 0.8f;
            return of;
        };
        const Jobs jobs(1);
        for (const MipFilter filter : lobe_filters()) {
            if (filter == kMipFilter_teacher) // its pairs of directions do not turn
                continue;
            const MipLevels a = make_mip_levels(MipSource(without_factor(coarse)), filter, 1.1f, jobs);
            const MipLevels b = make_mip_levels(MipSource(without_factor(turned)), filter, 1.1f, jobs);
            double unlike = 0.0; // mean difference
            for (std::size_t l = 0; l < a.levels.size(); ++l)
                for (int y = 0; y < a.levels[l].height; ++y)
                    for (int x = 0; x < a.levels[l].width; ++x) {
                        const auto [u, v] = place(t, a.levels[l].width, x, y);
                        MipTexel want = a.levels[l].texels[static_cast<std::size_t>(v * a.levels[l].width + u)];
                        if (t.flip_x)
                            want.nx = -want.nx, want.c = -want.c;
                        if (t.flip_y)
                            want.ny = -want.ny, want.c = -want.c;
                        if (t.swap)
                            std::swap(want.nx, want.ny), std::swap(want.a, want.b);
                        const MipTexel got = b.levels[l].texels[static_cast<std::size_t>(y * a.levels[l].width + x)];
                        if (filter == kMipFilter_mipnet) { // the net has learnt the symmetry approximately
                            for (const float d : {got.nx - want.nx, got.ny - want.ny, got.a - want.a, got.b - want.b, got.c - want.c})
                                unlike += static_cast<double>(std::abs(d)) / (5.0 * 341.0);
                            continue;
                        }
                        ASSERT_EQ(got, want) << mip_filters()[static_cast<std::size_t>(filter)].name << " turn " << turns << " level "
                                             << l + 1 << " " << x << "," << y;
                    }
            EXPECT_LT(unlike, 0.05) << "turn " << turns;
        }
    }
}

TEST(mip, texels_that_are_not_numbers_are_level_and_do_not_spread)
{
    Maps maps = rough_maps(16, 16, 5);
    Maps repaired = maps; // level normals, roughness from the factor, no direction
    for (int i = 0; i < 2; ++i) {
        const std::array<float, 3> texels[3] = {{0.5f, 0.5f, 1.0f}, {1.0f, 1.0f, 1.0f}, {0.5f, 0.5f, 0.0f}};
        std::copy(texels[0].begin(), texels[0].end(), repaired.normal.f32() + 3 * i);
        std::copy(texels[1].begin(), texels[1].end(), repaired.roughness.f32() + 3 * i);
        std::copy(texels[2].begin(), texels[2].end(), repaired.direction.f32() + 3 * i);
    }
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (Image* image : {&maps.normal, &maps.roughness, &maps.direction}) {
        std::fill_n(image->f32(), 3, nan);
        std::fill_n(image->f32() + 3, 3, inf);
    }
    for (const MipFilter filter : lobe_filters()) {
        const MipLevels made = levels_of(maps, filter), whole = levels_of(repaired, filter);
        EXPECT_EQ(mip_file_bytes({{&made}, 0, {}}), mip_file_bytes({{&whole}, 0, {}}));
    }
    std::vector<MipPoint> row(16);
    MipSource(maps.of()).row(0, row.data());
    EXPECT_EQ(row[0].n.z, 1.0f);
}

// Rows equal single texels, and 8-bit and 16-bit images equal floats of their values.
TEST(mip, maps_of_codes_are_read_as_their_values)
{
    const int width = 33, height = 5;
    for (const int codes : {256, 65536}) {
        Maps floats_of = rough_maps(width, height, 9), of;
        for (const auto& [from, to] :
             {std::pair(&floats_of.normal, &of.normal), {&floats_of.roughness, &of.roughness}, {&floats_of.direction, &of.direction}}) {
            *to = make_image(width, height, 3, codes == 256 ? PixelType::u8 : PixelType::u16);
            for (std::size_t i = 0; i < 3u * width * height; ++i) {
                const int code = static_cast<int>(from->f32()[i] * static_cast<float>(codes - 1) + 0.5f);
                from->f32()[i] = static_cast<float>(code) / static_cast<float>(codes - 1);
                if (codes == 256)
                    to->bytes[i] = static_cast<std::byte>(code);
                else
                    reinterpret_cast<std::uint16_t*>(to->bytes.data())[i] = static_cast<std::uint16_t>(code);
            }
        }
        const MipSource a(of.of()), b(floats_of.of());
        EXPECT_EQ(a.hash(Jobs(1)), b.hash(Jobs(1)));
        std::vector<MipPoint> row(static_cast<std::size_t>(width));
        a.row(3, row.data());
        for (int x = 0; x < width; ++x) {
            const MipPoint one = a.at(x, 3), in_row = row[static_cast<std::size_t>(x)];
            EXPECT_EQ(one.n.x, in_row.n.x);
            EXPECT_EQ(one.s.xy, in_row.s.xy);
        }
        EXPECT_NE(row[0].n.x, row[1].n.x);
    }
}

// A smaller map is interpolated between its texels: across the border if it repeats, not if it is clamped.
TEST(mip, smaller_maps_wrap_as_their_sampler_says)
{
    Maps maps;
    maps.normal = floats(4, 4, [](int, int) { return code_of(0.0f, 0.0f); });
    maps.roughness = floats(2, 1, [](int x, int) { return std::array{0.0f, x == 0 ? 0.25f : 0.75f, 0.0f}; });
    for (const WrapMode wrap : {WrapMode::repeat, WrapMode::clamp}) {
        MipMaps of = maps.of();
        of.roughness_factor = 1.0f, of.anisotropy_strength = 0.0f, of.wrap_s = of.wrap_t = wrap;
        std::vector<MipPoint> row(4);
        MipSource(of).row(0, row.data());
        const double roughness = wrap == WrapMode::repeat ? 0.25 + 0.25 * 0.5 : 0.25; // a quarter of a texel from the border
        EXPECT_NEAR(row[0].s.xx, 0.5 * std::pow(roughness, 4.0), 1e-6);
        EXPECT_NEAR(row[1].s.xx, 0.5 * std::pow(0.25 + 0.25 * 0.5, 4.0), 1e-6);
    }
}

// Rows interpolate a smaller map with the same bits as single points do, however the sampler goes on at the border.
TEST(mip, rows_of_smaller_maps_are_their_points)
{
    Maps maps;
    maps.direction = floats(7, 6, [](int, int) { return std::array{0.9f, 0.8f, 0.7f}; });
    maps.normal = floats(5, 3, [](int x, int y) { return code_of(0.1f * static_cast<float>(x), -0.2f * static_cast<float>(y)); });
    for (const WrapMode wrap : {WrapMode::repeat, WrapMode::clamp})
        for (const bool nearest : {false, true}) {
            MipMaps of = maps.of();
            of.wrap_s = of.wrap_t = wrap, of.nearest = nearest;
            const MipSource source(of);
            std::vector<MipPoint> row(7);
            for (int y = 0; y < 6; ++y) {
                source.row(y, row.data());
                for (int x = 0; x < 7; ++x) {
                    const MipPoint one = source.at(x, y), in_row = row[static_cast<std::size_t>(x)];
                    EXPECT_EQ(one.n.x, in_row.n.x) << x << ", " << y;
                    EXPECT_EQ(one.n.y, in_row.n.y) << x << ", " << y;
                }
            }
        }
}

// The same for maps of directions: of any number of channels, with values that are not finite or too large.
TEST(mip, rows_of_directions_are_their_points)
{
    Maps maps;
    maps.normal = floats(7, 6, [](int, int) { return code_of(0.0f, 0.0f); });
    for (const int channels : {1, 2, 3})
        for (const auto& [width, height] : {std::pair(3, 2), {7, 6}, {7, 3}, {20, 2}})
            for (const WrapMode wrap : {WrapMode::repeat, WrapMode::clamp}) {
                maps.direction = make_image(width, height, channels, PixelType::f32);
                const std::size_t values = maps.direction.bytes.size() / sizeof(float);
                for (std::size_t i = 0; i < values; ++i)
                    maps.direction.f32()[i] = static_cast<float>(i * 7 % 11) / 10.0f;
                maps.direction.f32()[0] = NAN, maps.direction.f32()[values - 1] = 1e10f, maps.direction.f32()[values / 2] = -INFINITY;
                MipMaps of = maps.of();
                of.wrap_s = of.wrap_t = wrap, of.anisotropy_strength = 0.8f;
                const MipSource source(of);
                std::vector<MipPoint> row(static_cast<std::size_t>(source.width()));
                for (int y = 0; y < source.height(); ++y) {
                    source.row(y, row.data());
                    for (int x = 0; x < source.width(); ++x) {
                        const MipPoint one = source.at(x, y), in_row = row[static_cast<std::size_t>(x)];
                        EXPECT_TRUE(std::isfinite(one.s.xx) && std::isfinite(one.s.yy) && std::isfinite(one.s.xy)) << x << ", " << y;
                        EXPECT_EQ(one.s.xx, in_row.s.xx) << x << ", " << y;
                        EXPECT_EQ(one.s.yy, in_row.s.yy) << x << ", " << y;
                        EXPECT_EQ(one.s.xy, in_row.s.xy) << x << ", " << y;
                    }
                }
            }
}

// Where the net is far from the reference, closed forms are kept. A representative sample of the material decides, at any size.
TEST(mip, nets_are_compared_on_texels_of_the_material)
{
    const Jobs jobs(2);
    const mipnet::Weights& net = *mipnet::shipped_weights(mipnet::Lobe::ggx_aniso);
    for (const auto& [width, height] : {std::pair(256, 64), {33, 129}, {8, 1}}) {
        Maps maps = rough_maps(width, height, 13, 0.3);
        maps.roughness = maps.direction = Image();
        const MipSource source(maps.of());
        const mipnet::Comparison usual = compare_net(source, net, 0.7f, true, jobs);
        EXPECT_TRUE(usual.keeps_net()) << usual.net << " " << usual.baseline;
        EXPECT_LT(usual.kappa, usual.baseline);
        EXPECT_EQ(compare_net(source, net, 0.7f, true, Jobs(1)).net, usual.net);
        mipnet::Weights wrong = net; // the last biases of both nets: lobes far too wide
        const mipnet::Plan plan = mipnet::plan_of(net.shape);
        for (const mipnet::Dense* d : {&plan.a, &plan.b})
            for (std::size_t c = 2; c < 4; ++c)
                wrong.numbers[d->bias[d->count - 1] + c] += 8.0f;
        EXPECT_FALSE(compare_net(source, wrong, 0.7f, true, jobs).keeps_net());
    }
    const mipnet::Texels sample = mipnet::sample_of(4096, 64, [](int x, int y, float* texel) {
        const float texels[] = {static_cast<float>(x), static_cast<float>(y), 1.0f, 1.0f, 0.0f};
        std::copy_n(texels, 5, texel);
    });
    std::set<float> columns;
    for (std::size_t y = 0; y < 128; ++y)
        for (std::size_t x = 0; x < 128; ++x) {
            const float u = sample.channel[0][y * 128 + x], v = sample.channel[1][y * 128 + x];
            ASSERT_EQ(static_cast<std::size_t>(u) % 32, x % 32); // tiles are whole footprints up to level 5
            ASSERT_EQ(static_cast<std::size_t>(v) % 32, y % 32);
            ASSERT_EQ(static_cast<std::size_t>(u) / 1024, x / 32);
            ASSERT_EQ(static_cast<std::size_t>(v) / 32, y / 64);
            columns.insert(u);
        }
    EXPECT_GT(columns.size(), 32u * 8u);
}

TEST(mip, bytes_do_not_depend_on_threads)
{
    const Maps maps = rough_maps(61, 47, 11);
    for (const MipFilter filter : lobe_filters()) {
        const MipLevels one = levels_of(maps, filter), three = levels_of(maps, filter, 1.1f, 3);
        EXPECT_EQ(mip_file_bytes({{&one}, 0, {}}), mip_file_bytes({{&three}, 0, {}}));
    }
}

TEST(mip, files_give_back_what_was_written_and_refuse_the_rest)
{
    const Maps maps = rough_maps(13, 8, 2);
    const MipLevels a = levels_of(maps, kMipFilter_kappa, 0.7f), b = levels_of(rough_maps(1, 1, 4), kMipFilter_ssgt);
    const MapLevels colours =
        make_map_levels(maps.normal, {}, {MapPart::base_color, ColourKernel::kaiser, 3, 4}, nullptr, Jobs(1)); // any image
    const MapLevels heights = make_map_levels(maps.normal, {}, {MapPart::height, ColourKernel::box, 5, 0}, nullptr, Jobs(1));
    const MipParts parts = {{&a, &b}, 2, [&](std::size_t i) { return i == 0 ? colours : heights; }};
    const std::vector<std::uint8_t> bytes = mip_file_bytes(parts);
    const Result<MipFile> read = parse_mip_file(bytes, "x.mip");
    ASSERT_TRUE(read);
    ASSERT_EQ(read->materials.size(), 2u);
    EXPECT_EQ(read->materials[0].source, a.source);
    EXPECT_EQ(read->materials[0].kappa, 0.7f);
    EXPECT_EQ(read->materials[0].filter, kMipFilter_kappa);
    ASSERT_EQ(read->materials[0].levels.size(), a.levels.size());
    for (std::size_t l = 0; l < a.levels.size(); ++l)
        EXPECT_EQ(read->materials[0].levels[l].texels, a.levels[l].texels);
    EXPECT_TRUE(read->materials[1].levels.empty());
    ASSERT_EQ(read->maps.size(), 2u);
    for (const auto& [was, is] : {std::pair(&colours, &read->maps[0]), {&heights, &read->maps[1]}}) {
        EXPECT_EQ(is->id, was->id);
        EXPECT_EQ(is->channels, was->channels);
        EXPECT_EQ(is->levels, was->levels);
        EXPECT_EQ(is->levels.size(), 3u);
    }
    EXPECT_NE(colours.channels, heights.channels);
    const std::string path = ::testing::TempDir() + "/whole.mip";
    ASSERT_TRUE(write_mip_file(path, parts));
    EXPECT_EQ(*read_file(path, 1u << 20), bytes);
    std::filesystem::remove(path);
    for (std::size_t at = 0; at < bytes.size(); at += 7) {
        std::vector<std::uint8_t> bad = bytes;
        bad[at] ^= 0x10;
        EXPECT_FALSE(parse_mip_file(bad, "x.mip")) << at;
    }
    for (std::size_t size = 0; size < bytes.size(); size += 5)
        EXPECT_FALSE(parse_mip_file(std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)), "x.mip"));
    Maps other = maps;
    other.roughness.f32()[1] += 0.01f;
    EXPECT_NE(MipSource(other.of()).hash(Jobs(1)), a.source);
}

// Rows of textures: the numbers of each texel as floats, rounded to halves, with what halves leave.
TEST(moment_rows, hold_the_numbers_of_each_point_by_every_instruction_set)
{
    constexpr std::size_t kCount = 149, kStride = 160; // no whole registers, and more than are written at once
    std::mt19937 random(7);
    const auto number = [&] { return static_cast<float>(random() % 4096) / 4096.0f; };
    std::vector<MipTexel> texels(kCount);
    for (MipTexel& t : texels)
        t = {0.9f * number() - 0.45f, 0.9f * number() - 0.45f, 0.5f + number(), 0.5f + number(), number() - 0.5f};
    std::vector<float> width2(kStride), alpha(kStride);
    for (std::size_t x = 0; x < kCount; ++x)
        width2[x] = number(), alpha[x] = number();
    for (const Isa isa : isas_with<mip::TextureFns>()) {
        const mip::TextureFns& fns = pick<mip::TextureFns>(isa);
        std::vector<float> points(mip::kPointPlanes * kStride, -1.0f), widths(kStride);
        fns.points({kCount, kStride, &texels[0].nx, points.data()});
        fns.widths({kCount, kStride, points.data(), widths.data()});
        for (const bool of_level0 : {true, false})
            for (const bool gained : {true, false}) {
                std::vector<std::uint16_t> made[mip::kFilteredTextures];
                mip::MomentWork work{kCount, kStride, points.data(), of_level0 ? nullptr : width2.data(), gained,
                                     0.7f,   0.9f,    0.4f,          of_level0 ? nullptr : alpha.data(),  {}};
                for (std::size_t k = 0; k < mip::kFilteredTextures; ++k)
                    made[k].assign(4 * kCount + 1, 77), work.to[k] = made[k].data();
                fns.moments(work);
                for (std::size_t k = 0; k < mip::kFilteredTextures; ++k) { // each alone
                    std::vector<std::uint16_t> alone(4 * kCount + 1, 77);
                    mip::MomentWork one = work;
                    std::fill(std::begin(one.to), std::end(one.to), nullptr);
                    one.to[k] = alone.data();
                    fns.moments(one);
                    EXPECT_EQ(alone, made[k]) << isa_name(isa) << ", texture " << k;
                }
                for (std::size_t x = 0; x < kCount; ++x) {
                    const MipTexel& t = texels[x];
                    const float nz = std::sqrt(1.0f - (t.nx * t.nx + t.ny * t.ny)), gx = 0.7f * t.nx, gy = 0.7f * t.ny;
                    const slope_covariance s = covariance_of_tensor({t.a, t.b, t.c});
                    const slope_axes axes = axes_of_covariance(s);
                    const float width = (axes.sigma_u + axes.sigma_v) * 0.70710678f;
                    EXPECT_EQ(widths[x], width * width);
                    const float own = gained ? 1.0f : std::sqrt(of_level0 ? width : std::sqrt(width2[x]));
                    const float wanted[3][4] = {
                        {0.5f + 0.4f * t.nx, 0.5f + 0.4f * t.ny, 0.5f + 0.5f * nz, of_level0 ? 1.0f : alpha[x]},
                        {0.9f, nz, own, kMomentScale * (s.xx + gx * gx)},
                        {kSlopeScale * t.nx, kSlopeScale * t.ny, kMomentScale * (s.yy + gy * gy), kMomentScale * (s.xy + gx * gy)}};
                    for (std::size_t k = 0; k < 3; ++k)
                        for (std::size_t c = 0; c < 4; ++c) {
                            const std::uint16_t half = float_to_half(wanted[k][c]);
                            EXPECT_EQ(made[k][4 * x + c], half) << isa_name(isa) << ", texture " << k << ", channel " << c;
                            if (k > 0) {
                                EXPECT_EQ(made[k + 2][4 * x + c], float_to_half(wanted[k][c] - half_to_float(half))) << isa_name(isa);
                            }
                        }
                }
                for (const std::vector<std::uint16_t>& row : made)
                    EXPECT_EQ(row.back(), 77) << "the number after the last texel";
            }
    }
}

} // namespace
} // namespace burnish
