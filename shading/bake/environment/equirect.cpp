#include "shading/bake/environment/equirect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <span>

#include "core/image/colour.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

float value_of(const Image& image, std::size_t i)
{
    if (image.type == PixelType::f32)
        return image.f32()[i];
    if (image.type == PixelType::u8)
        return srgb_to_linear(static_cast<float>(reinterpret_cast<const std::uint8_t*>(image.bytes.data())[i]) / 255.0f);
    return srgb_to_linear(static_cast<float>(reinterpret_cast<const std::uint16_t*>(image.bytes.data())[i]) / 65535.0f);
}

// A sample's filter weights along one image axis. The image is constant on its pixels. A sample sees it through a quadratic B-spline. Its
// variance is a one-pixel box's variance (such a box turns constant pixels into linear interpolation) plus the variance for the sample's
// footprint. Neighbouring samples then share every pixel evenly, even where footprints lie askew to the image near its poles.
struct AxisFilter {
    int first = 0;
    std::vector<double> weight; // for pixels from `first` on; sum 1

    // Computes the weights. center: pixels from the image's edge; footprint: pixels.
    void set(double center, double footprint)
    {
        const double f = kSpread * footprint;
        box_ = std::sqrt((1.0 + 3.0 * f * f) / 3.0);
        first = static_cast<int>(std::floor(center - 1.5 * box_));
        const int end = static_cast<int>(std::ceil(center + 1.5 * box_));
        weight.clear();
        double before = 0.0;
        for (int i = first; i < end; ++i) {
            const double after = i + 1 == end ? 1.0 : cumulative((static_cast<double>(i + 1) - center) / box_ + 1.5);
            weight.push_back(after - before);
            before = after;
        }
    }

  private:
    // A value slightly above 1 balances the unevenness along the image's axes (none at 1) and at 45 degrees to them.
    static constexpr double kSpread = 1.08;

    // Integral of the quadratic B-spline on [0,3] up to t.
    static double cumulative(double t)
    {
        if (t <= 0.0)
            return 0.0;
        if (t < 1.0)
            return t * t * t / 6.0;
        if (t < 2.0)
            return (((-2.0 * t + 9.0) * t - 9.0) * t + 3.0) / 6.0;
        return t < 3.0 ? 1.0 - (3.0 - t) * (3.0 - t) * (3.0 - t) / 6.0 : 1.0;
    }
    double box_ = 0.0; // width of each of the three boxes, pixels
};

// Position and extent of a sample: the mean over the footprint of direction d with sides du and dv (any parallelogram on the face). Each
// image axis uses a box with the same variance as the footprint's projection.
struct Footprint {
    const Direction &d, &du, &dv;
    double rho2 = std::max(d.x * d.x + d.z * d.z, 1e-18), rho = std::sqrt(rho2);

    double longitude() const { return 0.5 + det_atan2(d.z, d.x) / (2.0 * kPi); } // in [0,1]
    double colatitude() const { return det_atan2(rho, d.y) / kPi; }
    double wide() const { return std::min(extent(longitude_by(du), longitude_by(dv)) / (2.0 * kPi), 1.0); }
    double high() const { return extent(colatitude_by(du), colatitude_by(dv)) / kPi; }

  private:
    static double extent(double a, double b) { return std::sqrt(a * a + b * b); }
    double longitude_by(const Direction& e) const { return (d.x * e.z - d.z * e.x) / rho2; }
    double colatitude_by(const Direction& e) const
    {
        const double r2 = rho2 + d.y * d.y;
        return (d.y * (d.x * e.x + d.z * e.z) / rho - rho * e.y) / r2;
    }
};

std::array<double, 3> gathered(const Equirect& source, const AxisFilter& across, const AxisFilter& down)
{
    std::array<double, 3> sum{};
    const int start = (across.first % source.width + source.width) % source.width;
    for (std::size_t j = 0; j < down.weight.size(); ++j) {
        const int y = std::clamp(down.first + static_cast<int>(j), 0, source.height - 1);
        const float* row = source.rgb.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(source.width) * 3;
        int x = start;
        std::array<double, 3> line{};
        for (const double weight : across.weight) {
            for (std::size_t c = 0; c < 3; ++c)
                line[c] += weight * static_cast<double>(row[static_cast<std::size_t>(x) * 3 + c]);
            x = x + 1 == source.width ? 0 : x + 1;
        }
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += down.weight[j] * line[c];
    }
    return sum;
}

// Most texels along an edge: bounds time and memory for large sources. Two samples per axis and texel preserve a single bright pixel
// better than one sample; one sample is enough if a sun has many pixels.
constexpr int kLargestSampled = 2048;

// Returns the size at which the cube is sampled: no coarser than the source. The samples are then averaged down without loss of light.
int sampled_size(const Equirect& source, int size)
{
    const double texels = 2.0 / kPi * source.height; // then a texel at a face's centre is as large as a pixel
    int sampled = size;
    while (sampled < texels && sampled < kLargestSampled)
        sampled *= 2;
    return sampled;
}

// Sample positions on a face: `count` along an edge, and the vectors between neighbours.
struct SampledFace {
    int face, count;
    double step = 2.0 / count;
    Direction du = side(step, 0.0), dv = side(0.0, step);

    double at(int i) const { return (i + 0.5) * step - 1.0; }

  private:
    Direction side(double u, double v) const
    {
        const Direction d = cube_direction(face, u, v), origin = cube_direction(face, 0.0, 0.0);
        return {d.x - origin.x, d.y - origin.y, d.z - origin.z};
    }
};

// Groups of faces whose samples lie at equal colatitudes and share the vertical filter.
constexpr int kSides[] = {0, 1, 4, 5}, kTop[] = {2}, kBottom[] = {3};
constexpr std::span<const int> kAlike[] = {kSides, kTop, kBottom};

// Returns the horizontal filters by column of samples. On a side face longitude is constant along a column.
std::vector<AxisFilter> columns_of(const SampledFace& samples, const Equirect& source)
{
    std::vector<AxisFilter> columns(static_cast<std::size_t>(samples.count));
    for (int x = 0; x < samples.count; ++x) {
        const Direction d = cube_direction(samples.face, samples.at(x), 0.0);
        const Footprint p = {d, samples.du, samples.dv};
        columns[static_cast<std::size_t>(x)].set(p.longitude() * source.width, p.wide() * source.width);
    }
    return columns;
}

// Samples the texels for which `wanted` accepts the centre, a direction that is not unit.
template <class Wanted> void sample_texels(CubeLevel& cube, const Equirect& source, const Jobs& jobs, const Wanted& wanted)
{
    const int size = cube.size, n = size < kLargestSampled ? 2 : 1;
    std::vector<AxisFilter> columns[6];
    for (const int face : kSides)
        columns[face] = columns_of({face, n * size}, source);
    jobs.parallel_for(std::size(kAlike) * static_cast<std::size_t>(size), [&](std::size_t row, int) {
        const std::span<const int> faces = kAlike[row / static_cast<std::size_t>(size)];
        const int y = static_cast<int>(row % static_cast<std::size_t>(size));
        const SampledFace samples = {faces[0], n * size};
        AxisFilter across, down;
        // Skip texels that nobody wants
        for (int x = 0; x < size; ++x) {
            bool asked[6] = {}, any = false;
            for (const int face : faces) {
                asked[face] = wanted(cube_direction(face, (2 * x + 1.0) / size - 1.0, (2 * y + 1.0) / size - 1.0));
                any = any || asked[face];
            }
            if (!any)
                continue;
            // Sum filtered samples, weighted by solid angle
            std::array<double, 3> sums[6] = {};
            double weights = 0.0;
            for (int k = 0; k < n * n; ++k) {
                const int column = x * n + k % n;
                const double u = samples.at(column), v = samples.at(y * n + k / n);
                const double r2 = 1.0 + u * u + v * v, weight = 1.0 / (r2 * std::sqrt(r2)); // solid angle
                const Direction d = cube_direction(samples.face, u, v);
                const Footprint p = {d, samples.du, samples.dv};
                down.set(p.colatitude() * source.height, p.high() * source.height);
                if (faces.size() == 1)
                    across.set(p.longitude() * source.width, p.wide() * source.width);
                weights += weight;
                for (const int face : faces) {
                    if (!asked[face])
                        continue;
                    const AxisFilter& side = faces.size() == 1 ? across : columns[face][static_cast<std::size_t>(column)];
                    const std::array<double, 3> value = gathered(source, side, down);
                    for (std::size_t c = 0; c < 3; ++c)
                        sums[face][c] += weight * value[c];
                }
            }
            for (const int face : faces) {
                if (!asked[face])
                    continue;
                const std::size_t texel = (static_cast<std::size_t>(face) * static_cast<std::size_t>(size) + static_cast<std::size_t>(y)) *
                                              static_cast<std::size_t>(size) +
                                          static_cast<std::size_t>(x);
                for (std::size_t c = 0; c < 3; ++c)
                    cube.rgb[texel * 3 + c] = static_cast<float>(sums[face][c] / weights);
            }
        }
    });
}

float largest_finite(const std::vector<float>& values)
{
    float largest = 0.0f;
    for (const float v : values)
        if (v <= kMostRadiance)
            largest = std::max(largest, v);
    return largest;
}

// Returns a row's weight: the difference of its edges' cosines is proportional to its pixels' solid angle.
double row_weight(int y, int height)
{
    return det_cos(kPi * y / height) - det_cos(kPi * (y + 1) / height);
}

// Sets negative light of one channel to 0 in pixels [x0, x0 + side) x [y0, y0 + side), and darkens the rest by the same amount. Returns
// false, and changes nothing, if the rest has too little light.
bool share_out_negative(Equirect& e, int x0, int y0, int side, std::size_t channel)
{
    const int x1 = static_cast<int>(std::min<std::int64_t>(e.width, std::int64_t{x0} + side)),
              y1 = static_cast<int>(std::min<std::int64_t>(e.height, std::int64_t{y0} + side));
    const auto at = [&](int x, int y) -> float& {
        return e.rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(e.width) + static_cast<std::size_t>(x)) * 3 + channel];
    };
    double positive = 0.0, negative = 0.0;
    for (int y = y0; y < y1; ++y) {
        const double weight = row_weight(y, e.height);
        for (int x = x0; x < x1; ++x)
            (at(x, y) < 0.0f ? negative : positive) += weight * std::fabs(static_cast<double>(at(x, y)));
    }
    if (negative == 0.0)
        return true;
    if (positive < negative)
        return false;
    const float rest = static_cast<float>((positive - negative) / positive);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            at(x, y) = at(x, y) < 0.0f ? 0.0f : at(x, y) * rest;
    return true;
}

// Removes negative values and keeps the sum of light. Lossy compression leaves negative values beside bright values that are too bright.
// Starts with blocks of 8 x 8 pixels, as DWA compression has them. Goes on with larger blocks where these hold too little light.
void keep_sum(Equirect& e)
{
    for (std::size_t channel = 0; channel < 3; ++channel) {
        bool done = false;
        for (int side = 8; !done; side *= 2) {
            done = true;
            for (int y = 0; y < e.height; y += side)
                for (int x = 0; x < e.width; x += side)
                    done = share_out_negative(e, x, y, side, channel) && done;
            if (side >= std::max(e.width, e.height))
                break;
        }
    }
    for (float& v : e.rgb)
        v = std::max(v, 0.0f); // the channel has less than no light altogether
}

} // namespace

Equirect make_equirect(const Image& image)
{
    Equirect e;
    e.width = image.width, e.height = image.height;
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const std::size_t channels = static_cast<std::size_t>(image.channels);
    e.rgb.resize(pixels * 3);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            e.rgb[i * 3 + c] = value_of(image, i * channels + (channels >= 3 ? c : 0));
    const float largest = largest_finite(e.rgb);
    bool negative = false;
    for (float& v : e.rgb) {
        if (!(v >= -largest && v <= largest))
            v = v > 0.0f ? largest : 0.0f;
        negative = negative || v < 0.0f;
    }
    if (negative)
        keep_sum(e);
    return e;
}

std::vector<std::string> equirect_warnings(const Image& image)
{
    if (image.type != PixelType::f32)
        return {"the environment has no high dynamic range; taken as sRGB"};
    const std::size_t channels = static_cast<std::size_t>(image.channels), colours = channels >= 3 ? 3 : 1;
    const std::size_t values = image.bytes.size() / sizeof(float);
    const float* const all = image.f32();
    unsigned unusual = 0; // alpha included: a usual picture needs no second look
    for (std::size_t i = 0; i < values; ++i)
        unusual |= static_cast<unsigned>(!(all[i] >= 0.0f)) | static_cast<unsigned>(all[i] > kMostRadiance);
    if (!unusual)
        return {};
    std::size_t nan = 0, negative = 0, infinite = 0, huge = 0;
    float largest = 0.0f;
    for (std::size_t i = 0; i < values; i += channels)
        for (std::size_t c = 0; c < colours; ++c) {
            const float v = image.f32()[i + c];
            nan += std::isnan(v);
            negative += v < 0.0f;
            infinite += std::isinf(v) && v > 0.0f;
            huge += std::isfinite(v) && v > kMostRadiance;
            largest = v <= kMostRadiance ? std::max(largest, v) : largest;
        }
    std::vector<std::string> warnings;
    if (nan)
        warnings.push_back(fmt::format("{} NaN values of the environment set to 0", nan));
    if (negative)
        warnings.push_back(fmt::format("{} negative values of the environment set to 0, their surroundings darker by as much", negative));
    if (infinite)
        warnings.push_back(fmt::format("{} infinite values of the environment set to its largest finite value, {:g}", infinite, largest));
    if (huge)
        warnings.push_back(
            fmt::format("{} values of the environment above {:g} set to its largest value below that, {:g}", huge, kMostRadiance, largest));
    return warnings;
}

std::string equirect_shape_warning(const Image& image)
{
    const double shape = static_cast<double>(image.width) / image.height;
    const auto is = [shape](double wanted) { return std::fabs(shape / wanted - 1.0) < 0.01; };
    const std::size_t pixel = pixel_type_bytes(image.type) * static_cast<std::size_t>(image.channels);
    if (is(2.0) || std::equal(image.bytes.begin() + static_cast<std::ptrdiff_t>(pixel), image.bytes.end(), image.bytes.begin()))
        return "";
    struct Layout {
        double shape;
        const char* words;
    };
    constexpr Layout kCubes[] = {{4.0 / 3.0, "a cross of a cube's faces"},  {3.0 / 4.0, "a cross of a cube's faces"},
                                 {6.0, "a row of a cube's faces"},          {1.0 / 6.0, "a column of a cube's faces"},
                                 {3.0 / 2.0, "a cube's faces in two rows"}, {1.0, "one face of a cube, or a ball or an angular map"}};
    std::string looks;
    for (const Layout& layout : kCubes)
        if (is(layout.shape))
            looks = fmt::format("; it looks like {}, which is not read", layout.words);
    return fmt::format("{} x {} pixels are not twice as wide as high: they are stretched over the whole sphere{}", image.width,
                       image.height, looks);
}

double mean_luminance(const Equirect& source)
{
    double sum = 0.0;
    for (int y = 0; y < source.height; ++y) {
        double row = 0.0;
        const float* rgb = source.rgb.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(source.width) * 3;
        for (int x = 0; x < source.width; ++x, rgb += 3)
            row += 0.2126 * static_cast<double>(rgb[0]) + 0.7152 * static_cast<double>(rgb[1]) + 0.0722 * static_cast<double>(rgb[2]);
        sum += row * row_weight(y, source.height);
    }
    return sum / (2.0 * source.width);
}

float peak_value(const Equirect& source)
{
    float peak = 0.0f;
    for (const float v : source.rgb)
        peak = std::max(peak, v);
    return peak;
}

CubeLevel sample_equirect(const Equirect& source, int size, const Jobs& jobs)
{
    CubeLevel cube = make_cube_level(sampled_size(source, size));
    sample_texels(cube, source, jobs, [](const Direction&) { return true; });
    return cube;
}

void sample_equirect_again(CubeLevel& sampled, const Equirect& source, const std::vector<SkyCap>& changed, const Jobs& jobs)
{
    // A sample's filter reaches 1.5 sqrt(1/3 + (1.08 f)^2) pixels plus one along each axis, where f is the footprint. That is at most 1.9
    // pixels and 2.3 texels. Towards a pole rows grow by less than a factor of two within this reach. At the pole the reach doubles from
    // end to end.
    constexpr double kReach = 8.0;
    const double pixel = std::max(kPi / source.height, 2.0 * kPi / source.width), texel = 2.0 / sampled.size;
    std::vector<double> least;
    for (const SkyCap& cap : changed)
        least.push_back(det_cos(std::min(cap.radius + kReach * (pixel + texel), kPi)));
    sample_texels(sampled, source, jobs, [&](const Direction& d) {
        const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        for (std::size_t i = 0; i < changed.size(); ++i) {
            const Direction& c = changed[i].centre;
            if (d.x * c.x + d.y * c.y + d.z * c.z >= least[i] * length)
                return true;
        }
        return false;
    });
}

CubeLevel averaged_to(const CubeLevel& sampled, int size, const Jobs& jobs)
{
    if (sampled.size == size)
        return sampled;
    CubeLevel cube = half_cube_level(sampled, jobs);
    while (cube.size > size)
        cube = half_cube_level(cube, jobs);
    return cube;
}

CubeLevel equirect_to_cube(const Equirect& source, int size, const Jobs& jobs)
{
    return averaged_to(sample_equirect(source, size, jobs), size, jobs);
}

} // namespace burnish
