#include "shading/bake/mip/mip_error.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/image/metrics/flip.h"
#include "core/math/scalar_math.h"
#include "shading/bake/mip/level_gains.h"
#include "shading/bake/mipnet/net.h"

namespace burnish {
namespace {

using mipnet::Texels;
using Numbers = std::vector<float>;

constexpr int kDifferencePairs = 48, kMipErrorLamps = 3;
constexpr float kMipErrorIntensity = 5.0f;

struct MipErrorLight { // planes of a level
    Numbers to_light, to_eye, intensity;
};

void put_unit(Numbers& planes, std::size_t count, std::size_t at, double x, double y, double z)
{
    const double inverse = 1.0 / std::sqrt(x * x + y * y + z * z);
    planes[at] = static_cast<float>(x * inverse);
    planes[count + at] = static_cast<float>(y * inverse), planes[2 * count + at] = static_cast<float>(z * inverse);
}

// Returns the p-th pair for each tile, as directions per texel.
MipErrorLight mip_error_pair(int p, int width, int height, int tiles)
{
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    MipErrorLight d = {Numbers(3 * count), Numbers(3 * count), Numbers(count, kMipErrorIntensity)};
    const int across = width / tiles, down = height / tiles;
    for (int tile = 0; tile < tiles * tiles; ++tile) {
        mipnet::Random random(1000003u * static_cast<std::uint64_t>(p + tile) + 17u);
        const double zi = random.between(0.1, 1.0), ti = random.between(0.0, 2.0 * kPi), zo = std::sqrt(random.between(0.01, 1.0)),
                     to = random.between(0.0, 2.0 * kPi);
        const double ri = std::sqrt(1.0 - zi * zi), ro = std::sqrt(std::max(1.0 - zo * zo, 0.0));
        const double i[] = {ri * det_cos(ti), ri * det_sin(ti), zi}, o[] = {ro * det_cos(to), ro * det_sin(to), zo};
        for (int y = 0; y < down; ++y)
            for (int x = 0; x < across; ++x) {
                const std::size_t at = static_cast<std::size_t>((tile / tiles * down + y) * width + tile % tiles * across + x);
                put_unit(d.to_light, count, at, i[0], i[1], i[2]), put_unit(d.to_eye, count, at, o[0], o[1], o[2]);
            }
    }
    return d;
}

// Returns a lamp 1.5 from the centre of the plane [-1, 1]^2, and a distant eye near the mirrored direction.
MipErrorLight mip_error_lamp(int which, int side)
{
    constexpr double kLamps[kMipErrorLamps][3] = {{0.0, 0.0, 1.5}, {0.75, 0.0, 1.3}, {0.3, 0.9, 1.16}};
    constexpr double kEyes[kMipErrorLamps][3] = {{0.0, 0.0, 1.0}, {-0.45, 0.1, 0.89}, {-0.3, -0.5, 0.81}};
    const std::size_t row = static_cast<std::size_t>(side), count = row * row;
    MipErrorLight d = {Numbers(3 * count), Numbers(3 * count), Numbers(count)};
    const double *lamp = kLamps[which], *eye = kEyes[which];
    for (std::size_t at = 0; at < count; ++at) {
        const double dx = lamp[0] - ((static_cast<double>(at % row) + 0.5) / side * 2.0 - 1.0);
        const double dy = lamp[1] - ((static_cast<double>(at / row) + 0.5) / side * 2.0 - 1.0), dz = lamp[2];
        put_unit(d.to_light, count, at, dx, dy, dz);
        put_unit(d.to_eye, count, at, eye[0], eye[1], eye[2]);
        d.intensity[at] = static_cast<float>(static_cast<double>(kMipErrorIntensity) / std::sqrt(std::sqrt(dx * dx + dy * dy + dz * dz)));
    }
    return d;
}

std::size_t whole_slots(std::size_t count)
{
    return (count + mipnet::kSlots - 1) / mipnet::kSlots * mipnet::kSlots;
}

Numbers planes_of(const Texels& t)
{
    Numbers planes;
    for (const std::vector<float>& channel : t.channel)
        planes.insert(planes.end(), channel.begin(), channel.end());
    return planes;
}

Numbers radiance_of(const MipErrorSurface& s, const Numbers& planes, const MipErrorLight& d)
{
    const std::size_t count = planes.size() / mipnet::kChannels;
    Numbers out(whole_slots(count), 0.0f);
    pick<mipnet::Fns>().radiance(
        {s.lobe, count, planes.data(), d.to_light.data(), d.to_eye.data(), d.intensity.data(), s.f0, s.diffuse, out.data()});
    return out;
}

Numbers displayed(const Numbers& radiance)
{
    Numbers to(radiance.size());
    pick<mipnet::Fns>().toned(radiance.size(), radiance.data(), to.data());
    return to;
}

Numbers averaged(const Numbers& from, int side) // of a square of side x side
{
    const std::size_t half = static_cast<std::size_t>(side / 2), row = static_cast<std::size_t>(side);
    Numbers to(whole_slots(half * half), 0.0f);
    for (std::size_t y = 0; y < half; ++y)
        for (std::size_t x = 0; x < half; ++x) {
            const std::size_t at = 2 * y * row + 2 * x;
            to[y * half + x] = 0.25f * (from[at] + from[at + 1] + from[at + row] + from[at + row + 1]);
        }
    return to;
}

void add_difference(const Numbers& found, const Numbers& wanted, std::size_t count, int times, MipError& to)
{
    double l1 = 0.0, mse = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double e = static_cast<double>(found[i]) - static_cast<double>(wanted[i]);
        l1 += std::fabs(e), mse += e * e;
    }
    to.l1 += l1 / static_cast<double>(count) / times, to.mse += mse / static_cast<double>(count) / times;
}

double sum_of(const Numbers& radiance, std::size_t count)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i)
        sum += static_cast<double>(radiance[i]);
    return sum;
}

Image tonemapped_square(const Numbers& radiance, int side)
{
    Image image = make_image(side, side, 3, PixelType::f32);
    float* to = image.f32();
    for (std::size_t i = 0; i < static_cast<std::size_t>(side) * static_cast<std::size_t>(side); ++i)
        for (int c = 0; c < 3; ++c)
            *to++ = radiance[i] / (1.0f + radiance[i]);
    return image;
}

double mean_flip(const Image& wanted, const Image& found, const Jobs& jobs)
{
    const Image error = flip_ldr(wanted, found, {}, jobs).error;
    const std::size_t count = static_cast<std::size_t>(error.width) * static_cast<std::size_t>(error.height);
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i)
        sum += static_cast<double>(error.f32()[i]);
    return sum / static_cast<double>(count);
}

} // namespace

MipErrorSurface mip_error_surface(mipnet::Lobe lobe, bool metal)
{
    return metal ? MipErrorSurface{lobe, 0.85f, 0.0f} : MipErrorSurface{lobe, 0.04f, 0.5f};
}

Texels mip_level_texels(const MipLevel& level)
{
    Texels to = mipnet::make_texels(level.width, level.height);
    for (std::size_t i = 0; i < level.texels.size(); ++i) {
        const MipTexel& t = level.texels[i];
        const float of[mipnet::kChannels] = {t.nx, t.ny, t.a, t.b, t.c};
        for (std::size_t c = 0; c < mipnet::kChannels; ++c)
            to.channel[c][i] = of[c];
    }
    return to;
}

MipError mip_difference(const Texels& a, const Texels& b, const MipErrorSurface& surface)
{
    BN_CHECK(a.width == b.width && a.height == b.height);
    const Numbers planes[2] = {planes_of(a), planes_of(b)};
    MipError error;
    for (int p = 0; p < kDifferencePairs; ++p) {
        const MipErrorLight d = mip_error_pair(p, a.width, a.height, 1);
        add_difference(displayed(radiance_of(surface, planes[0], d)), displayed(radiance_of(surface, planes[1], d)), a.count(),
                       kDifferencePairs, error);
    }
    return error;
}

std::vector<std::vector<MipError>> mip_errors(const Texels& level0, const std::vector<std::vector<Texels>>& filters,
                                              const MipErrorSurface& surface, const Jobs& jobs, const MipErrorPairs& pairs,
                                              const std::vector<std::vector<Texels>>& second, const std::vector<std::vector<float>>& gains)
{
    const int levels = filters.empty() ? 0 : static_cast<int>(filters[0].size());
    BN_CHECK(level0.width == level0.height && level0.width % (pairs.tiles << levels) == 0 && pairs.lamps <= kMipErrorLamps);
    std::vector<std::vector<MipError>> errors(filters.size(), std::vector<MipError>(static_cast<std::size_t>(levels)));
    const Numbers planes0 = planes_of(level0);
    std::vector<double> light_of_reference(static_cast<std::size_t>(levels), 0.0);
    std::vector<std::vector<Numbers>> planes(filters.size()), others(filters.size());
    for (std::size_t f = 0; f < second.size(); ++f)
        for (const Texels& level : second[f])
            others[f].push_back(planes_of(level));
    for (std::size_t f = 0; f < filters.size(); ++f)
        for (const Texels& level : filters[f])
            planes[f].push_back(planes_of(level));
    // Add pairs and lamps in one order, whatever the number of threads.
    for (int time = 0; time < pairs.times + pairs.lamps; ++time) {
        const bool pair = time < pairs.times;
        const auto light = [&](int side) {
            return pair ? mip_error_pair(pairs.first + time * pairs.tiles * pairs.tiles, side, side, pairs.tiles)
                        : mip_error_lamp(time - pairs.times, side);
        };
        Numbers reference = radiance_of(surface, planes0, light(level0.width));
        // Average the reference to this level, then compare all filters with it
        for (int l = 1; l <= levels; ++l) {
            const int side = level0.width >> l;
            reference = averaged(reference, 2 * side);
            if (!pair && side < kLeastFlipSide)
                break;
            const MipErrorLight d = light(side);
            const Numbers wanted = pair ? displayed(reference) : Numbers();
            const std::size_t texels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
            if (pair)
                light_of_reference[static_cast<std::size_t>(l) - 1] += sum_of(reference, texels);
            jobs.parallel_for(filters.size(), [&](std::size_t f, int) {
                MipError& to = errors[f][static_cast<std::size_t>(l) - 1];
                const bool plain = f >= gains.size() || gains[f].empty();
                const MipErrorSurface lit = plain ? surface : gained(surface, gains[f][static_cast<std::size_t>(l) - 1]);
                Numbers found = radiance_of(lit, planes[f][static_cast<std::size_t>(l) - 1], d);
                if (!others[f].empty()) {
                    const Numbers other = radiance_of(surface, others[f][static_cast<std::size_t>(l) - 1], d);
                    for (std::size_t i = 0; i < found.size(); ++i)
                        found[i] = 0.5f * (found[i] + other[i]);
                }
                if (pair)
                    add_difference(displayed(found), wanted, texels, pairs.times, to), to.light += sum_of(found, texels);
                else
                    to.flip += mean_flip(tonemapped_square(reference, side), tonemapped_square(found, side), Jobs(1)) / pairs.lamps;
            });
        }
    }
    // Divide by the light of the reference
    for (std::vector<MipError>& of : errors)
        for (std::size_t l = 0; l < of.size(); ++l)
            of[l].light = light_of_reference[l] > 0.0 ? of[l].light / light_of_reference[l] : 1.0;
    return errors;
}

std::vector<std::vector<MipError>> judged_errors(const Texels& level0, const std::vector<std::vector<Texels>>& filters,
                                                 const MipErrorSurface& surface, const Jobs& jobs, const MipErrorPairs& pairs,
                                                 const std::vector<std::vector<Texels>>& second,
                                                 const std::vector<std::vector<float>>& gains)
{
    constexpr int kFirstOfLight = 100000, kTimesOfLight = 24;
    std::vector<std::vector<MipError>> errors = mip_errors(level0, filters, surface, jobs, pairs, second, gains);
    const int tiles = filters.empty() ? 1 : level0.width >> filters[0].size();
    const auto light = mip_errors(level0, filters, surface, jobs,
                                  {.first = kFirstOfLight, .times = kTimesOfLight, .tiles = tiles, .lamps = 0}, second, gains);
    for (std::size_t f = 0; f < errors.size(); ++f)
        for (std::size_t l = 0; l < errors[f].size(); ++l)
            errors[f][l].light = light[f][l].light;
    return errors;
}

} // namespace burnish
