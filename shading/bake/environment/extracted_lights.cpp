#include "shading/bake/environment/extracted_lights.h"

#include <algorithm>
#include <cmath>

#include "core/math/scalar_math.h"
#include "shading/bake/environment/cube_map.h"
#include "shading/bake/environment/turn.h"

namespace burnish {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kFirstThreshold = 4.0; // times the mean radiance: a light of 4 degrees with 1/200 of all light exceeds it
constexpr double kLargestReach = 5.0 * kDegree, kLargestAxis = 2.5 * kDegree;
constexpr double kLeastCover = 0.3, kMostCover = 2.5; // ellipse area over region: 1 for a disc, less for a glow, more for bridged lamps
// Least ratio to the mean of the surroundings and to the brightest rim pixel, and least share of the sphere's light
constexpr double kLeastContrast = 8.0, kLeastDrop = 4.0, kLeastShare = 0.005;

constexpr std::size_t kMostOfRim = 512; // most pixels that fill a hole; next to a pole the rim has a whole row of pixels

using Pixels = std::vector<std::uint32_t>;

struct Ellipse {            // ellipse of inertia, weighted by luminance
    Direction centre, u, v; // unit; half axes (two deviations, the rim of a uniform disc), as tangents, |u| >= |v|
    double reach;           // radians to the farthest pixel
};

struct Region {
    Pixels pixels;
    double excess; // light above the surroundings: luminance times solid angle
};

double dot(const Direction& a, const Direction& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Direction scaled(const Direction& a, double s)
{
    return {a.x * s, a.y * s, a.z * s};
}

Direction sum(const Direction& a, const Direction& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

Direction unit(const Direction& a)
{
    return scaled(a, 1.0 / std::sqrt(std::max(dot(a, a), 1e-300)));
}

// The picture as pixels on the sphere.
class Picture {
  public:
    explicit Picture(const Equirect& source) : source_(source)
    {
        for (int y = 0; y < source.height; ++y) {
            const double theta = (y + 0.5) * kPi / source.height;
            sin_row_.push_back(det_sin(theta)), cos_row_.push_back(det_cos(theta));
            const double band = det_cos(y * kPi / source.height) - det_cos((y + 1) * kPi / source.height);
            angle_.push_back(band * 2.0 * kPi / source.width);
        }
        for (int x = 0; x < source.width; ++x) {
            const double phi = ((x + 0.5) / source.width - 0.5) * 2.0 * kPi;
            sin_column_.push_back(det_sin(phi)), cos_column_.push_back(det_cos(phi));
        }
    }
    std::size_t width() const { return static_cast<std::size_t>(source_.width); }
    std::size_t height() const { return static_cast<std::size_t>(source_.height); }
    double angle(std::size_t pixel) const { return angle_[pixel / width()]; }
    double step() const { return kPi / source_.height; } // radians between rows
    double luminance(std::size_t pixel) const
    {
        const float* p = source_.rgb.data() + 3 * pixel;
        return kLuminance[0] * static_cast<double>(p[0]) + kLuminance[1] * static_cast<double>(p[1]) +
               kLuminance[2] * static_cast<double>(p[2]);
    }
    Direction direction(std::size_t pixel) const
    {
        const std::size_t x = pixel % width(), y = pixel / width();
        return {sin_row_[y] * cos_column_[x], cos_row_[y], sin_row_[y] * sin_column_[x]};
    }
    // Visits a pixel's eight neighbours. Past a pole lies the row's other side.
    template <class Visit> void neighbours(std::size_t pixel, const Visit& visit) const
    {
        const std::size_t w = width(), x = pixel % w, y = pixel / w;
        for (int dy = -1; dy <= 1; ++dy)
            for (std::size_t dx : {w - 1, std::size_t{0}, std::size_t{1}}) {
                const bool past = (y == 0 && dy < 0) || (y + 1 == height() && dy > 0);
                const std::size_t row = past ? y : y + static_cast<std::size_t>(dy + 1) - 1;
                const std::size_t column = (x + dx + (past ? w / 2 : 0)) % w;
                if (row * w + column != pixel)
                    visit(row * w + column);
            }
    }
    // Visits the pixels with centres within `reach` of a direction.
    template <class Visit> void around(const Direction& centre, double reach, const Visit& visit) const
    {
        const double theta = det_acos(std::clamp(centre.y, -1.0, 1.0));
        const std::size_t first = static_cast<std::size_t>(std::max((theta - reach) / step(), 0.0));
        const std::size_t last = std::min(static_cast<std::size_t>(std::max((theta + reach) / step(), 0.0)), height() - 1);
        const double nearest = det_cos(std::min(reach, kPi));
        for (std::size_t pixel = first * width(); pixel < (last + 1) * width(); ++pixel)
            if (dot(direction(pixel), centre) >= nearest)
                visit(pixel);
    }

  private:
    const Equirect& source_;
    std::vector<double> sin_row_, cos_row_, angle_, sin_column_, cos_column_;
};

// Returns the ellipse of inertia. weight: by pixel in the list, not negative, not all 0. A pixel's own extent counts as a square.
Ellipse ellipse_of(const Picture& picture, const Pixels& pixels, const std::vector<double>& weight)
{
    Ellipse e = {};
    double total = 0.0;
    // Find the centre
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        e.centre = sum(e.centre, scaled(picture.direction(pixels[i]), weight[i]));
        total += weight[i];
    }
    e.centre = unit(e.centre);
    const bool steep = std::fabs(e.centre.y) > 0.7; // then the x axis, else the y axis, is far enough from the centre
    const Direction pole = steep ? Direction{1.0, 0.0, 0.0} : Direction{0.0, 1.0, 0.0};
    const Direction a = unit(sum(pole, scaled(e.centre, -dot(pole, e.centre))));
    const Direction b = {e.centre.y * a.z - e.centre.z * a.y, e.centre.z * a.x - e.centre.x * a.z, e.centre.x * a.y - e.centre.y * a.x};
    double aa = 0.0, bb = 0.0, ab = 0.0, nearest = 1.0;
    // Sum second moments in the tangent plane
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Direction d = picture.direction(pixels[i]);
        const double ahead = dot(d, e.centre), s = dot(d, a) / std::max(ahead, 0.1), t = dot(d, b) / std::max(ahead, 0.1);
        const double w = weight[i] / total, own = picture.angle(pixels[i]) / 12.0;
        aa += w * (s * s + own), bb += w * (t * t + own), ab += w * s * t;
        nearest = std::min(nearest, ahead);
    }
    e.reach = det_acos(std::max(nearest, -1.0));
    // Solve for the half axes
    const double mean = 0.5 * (aa + bb), half = 0.5 * (aa - bb), root = std::sqrt(half * half + ab * ab);
    const double long_axis = 2.0 * std::sqrt(mean + root), short_axis = 2.0 * std::sqrt(std::max(mean - root, 0.0));
    // Take the eigenvector of mean + root from the row that keeps its digits.
    double x = half >= 0.0 ? root + half : ab, y = half >= 0.0 ? ab : root - half;
    const double length = std::sqrt(x * x + y * y);
    x = length > 0.0 ? x / length : 1.0, y = length > 0.0 ? y / length : 0.0;
    e.u = scaled(sum(scaled(a, x), scaled(b, y)), long_axis);
    e.v = scaled(sum(scaled(a, -y), scaled(b, x)), short_axis);
    return e;
}

double length(const Direction& a)
{
    return std::sqrt(dot(a, a));
}

enum : std::uint8_t { kOutside, kInside, kRim };

// Adds two rings of pixels around the region, whose pixels must be marked as inside. Light may have spilled there, and a picture's
// compression may ring there.
void widen(const Picture& picture, Pixels& pixels, std::vector<std::uint8_t>& place)
{
    std::size_t first = 0;
    for (int step = 0; step < 2; ++step) {
        const std::size_t end = pixels.size();
        for (; first < end; ++first)
            picture.neighbours(pixels[first], [&](std::size_t p) {
                if (place[p] == kOutside) {
                    place[p] = kInside;
                    pixels.push_back(static_cast<std::uint32_t>(p));
                }
            });
    }
}

// Finds the regions of extracted lights.
class Finder {
  public:
    explicit Finder(const Picture& picture) : picture_(picture), mark_(picture.width() * picture.height(), 0)
    {
        double total = 0.0;
        for (std::size_t y = 0; y < picture.height(); ++y) {
            double row = 0.0;
            for (std::size_t x = 0; x < picture.width(); ++x)
                row += picture.luminance(y * picture.width() + x);
            total += row * picture.angle(y * picture.width());
        }
        total_ = total;
    }

    double total() const { return total_; } // luminance times solid angle

    std::vector<Region> find()
    {
        const double threshold = kFirstThreshold * total_ / (4.0 * kPi);
        Pixels bright;
        for (std::size_t p = 0; p < mark_.size(); ++p)
            if (picture_.luminance(p) > threshold)
                bright.push_back(static_cast<std::uint32_t>(p));
        return threshold > 0.0 ? search(bright, threshold) : std::vector<Region>{};
    }

  private:
    // Finds extracted lights among pixels that all exceed the threshold. A region splits if it contains several extracted lights.
    std::vector<Region> search(const Pixels& pixels, double threshold)
    {
        std::vector<Region> found;
        for (const Pixels& part : connected_parts(pixels)) {
            Pixels brighter;
            for (const std::uint32_t p : part)
                if (picture_.luminance(p) > 2.0 * threshold)
                    brighter.push_back(p);
            std::vector<Region> inner = brighter.empty() ? std::vector<Region>{} : search(brighter, 2.0 * threshold);
            Region own = {part, 0.0};
            if (inner.size() < 2 && is_extracted_light(own))
                found.push_back(std::move(own));
            else
                std::move(inner.begin(), inner.end(), std::back_inserter(found));
        }
        return found;
    }

    // Splits pixels into connected parts.
    std::vector<Pixels> connected_parts(const Pixels& pixels)
    {
        for (const std::uint32_t p : pixels)
            mark_[p] = 1;
        std::vector<Pixels> parts;
        for (const std::uint32_t seed : pixels) {
            if (!mark_[seed])
                continue;
            mark_[seed] = 0;
            Pixels part = {seed};
            for (std::size_t i = 0; i < part.size(); ++i)
                picture_.neighbours(part[i], [&](std::size_t p) {
                    if (mark_[p]) {
                        mark_[p] = 0;
                        part.push_back(static_cast<std::uint32_t>(p));
                    }
                });
            std::sort(part.begin(), part.end());
            parts.push_back(std::move(part));
        }
        return parts;
    }

    // Checks the conditions in extracted_lights.h. Fills the region's excess.
    bool is_extracted_light(Region& region)
    {
        double angle = 0.0, light = 0.0;
        std::vector<double> weight;
        for (const std::uint32_t p : region.pixels) {
            weight.push_back(picture_.angle(p) * picture_.luminance(p));
            angle += picture_.angle(p), light += weight.back();
        }
        if (light < kLeastShare * total_ || angle > kPi * kLargestReach * kLargestReach)
            return false;
        const Ellipse e = ellipse_of(picture_, region.pixels, weight);
        const double u = length(e.u), cover = kPi * u * length(e.v) / angle;
        if (e.reach > kLargestReach || u > kLargestAxis || cover < kLeastCover || cover > kMostCover)
            return false;
        const Surroundings s = around(region, e);
        region.excess = light - s.mean * angle;
        return light > kLeastContrast * s.mean * angle && light > kLeastDrop * s.brightest * angle && region.excess >= kLeastShare * total_;
    }

    struct Surroundings {
        double mean, brightest; // mean luminance out to twice the region's reach; largest luminance on its rim
    };
    // Measures luminance around a region. The pixels next to the region count as part of it.
    Surroundings around(const Region& region, const Ellipse& e)
    {
        Pixels inside = region.pixels;
        for (const std::uint32_t p : inside)
            mark_[p] = kInside;
        widen(picture_, inside, mark_);
        double light = 0.0, angle = 0.0, brightest = 0.0;
        picture_.around(e.centre, 2.0 * e.reach + 4.0 * picture_.step(), [&](std::size_t p) {
            if (mark_[p] == kOutside)
                light += picture_.luminance(p) * picture_.angle(p), angle += picture_.angle(p);
        });
        for (const std::uint32_t i : inside)
            picture_.neighbours(i, [&](std::size_t p) {
                if (mark_[p] == kOutside)
                    brightest = std::max(brightest, picture_.luminance(p));
            });
        for (const std::uint32_t p : inside)
            mark_[p] = kOutside;
        return {angle > 0.0 ? light / angle : 0.0, brightest};
    }

    const Picture& picture_;
    std::vector<std::uint8_t> mark_; // by pixel; all 0 between calls
    double total_ = 0.0;             // luminance times solid angle
};

// Returns radiance that fills a region: a mean over the pixels around all regions, weighted by the inverse cube of distance.
std::vector<float> surroundings(const Picture& picture, const Equirect& source, const Pixels& pixels, std::vector<std::uint8_t>& place)
{
    // Collect the rim, and clear its marks
    Pixels rim;
    for (const std::uint32_t inside : pixels)
        picture.neighbours(inside, [&](std::size_t p) {
            if (place[p] == kOutside) {
                place[p] = kRim;
                rim.push_back(static_cast<std::uint32_t>(p));
            }
        });
    std::vector<Direction> at;
    for (const std::uint32_t p : rim) {
        place[p] = kOutside;
        at.push_back(picture.direction(p));
    }
    // Average over the rim, or over part of a long one
    const std::size_t step = rim.size() / kMostOfRim + 1;
    std::vector<float> filled;
    for (const std::uint32_t inside : pixels) {
        const Direction d = picture.direction(inside);
        double rgb[3] = {}, weights = 0.0;
        for (std::size_t i = 0; i < rim.size(); i += step) {
            const Direction away = sum(at[i], scaled(d, -1.0));
            const double r2 = dot(away, away), w = picture.angle(rim[i]) / (r2 * std::sqrt(r2));
            for (std::size_t c = 0; c < 3; ++c)
                rgb[c] += w * static_cast<double>(source.rgb[3 * std::size_t{rim[i]} + c]);
            weights += w;
        }
        for (std::size_t c = 0; c < 3; ++c)
            filled.push_back(weights > 0.0 ? static_cast<float>(rgb[c] / weights) : 0.0f);
    }
    return filled;
}

// Returns a region's light above `filled`. total: light of the sphere (luminance). A channel without excess light stays in the picture:
// `filled` gets its old values.
ExtractedLight light_of(const Picture& picture, const Equirect& source, double total, const Pixels& pixels, std::vector<float>& filled)
{
    double rgb[3] = {};
    std::vector<double> excess(pixels.size(), 0.0); // by pixel of the region
    for (std::size_t c = 0; c < 3; ++c) {
        const auto was = [&](std::size_t i) { return source.rgb[3 * std::size_t{pixels[i]} + c]; };
        const auto more = [&](std::size_t i) {
            return (static_cast<double>(was(i)) - static_cast<double>(filled[3 * i + c])) * picture.angle(pixels[i]);
        };
        for (std::size_t i = 0; i < pixels.size(); ++i)
            rgb[c] += more(i);
        if (rgb[c] <= 0.0) {
            rgb[c] = 0.0;
            for (std::size_t i = 0; i < pixels.size(); ++i)
                filled[3 * i + c] = was(i);
        }
        for (std::size_t i = 0; i < pixels.size(); ++i)
            excess[i] += kLuminance[c] * more(i);
    }
    double light = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < excess.size(); ++i) {
        excess[i] = std::max(excess[i], 0.0);
        light += excess[i], squares += excess[i] * excess[i] / picture.angle(pixels[i]);
    }
    // The light takes its shape from the inertia ellipse. Its area equals an even disc's with the light's total and mean radiance, so a
    // faint glow does not inflate it.
    Ellipse e = ellipse_of(picture, pixels, excess);
    const double size = std::sqrt(light * light / squares / (kPi * length(e.u) * length(e.v)));
    e.u = scaled(e.u, size), e.v = scaled(e.v, size);
    ExtractedLight extracted;
    const auto store = [](const Direction& d, float* to) {
        to[0] = static_cast<float>(d.x), to[1] = static_cast<float>(d.y), to[2] = static_cast<float>(d.z);
    };
    store(e.centre, extracted.direction), store(e.u, extracted.axis_u), store(e.v, extracted.axis_v);
    for (std::size_t c = 0; c < 3; ++c)
        extracted.irradiance[c] = static_cast<float>(rgb[c]);
    extracted.angular_radius = static_cast<float>(std::sqrt(length(e.u) * length(e.v)));
    extracted.share = static_cast<float>((kLuminance[0] * rgb[0] + kLuminance[1] * rgb[1] + kLuminance[2] * rgb[2]) / total);
    return extracted;
}

// Returns the smallest cap about the mean direction that contains the pixels' centres.
SkyCap cap_of(const Picture& picture, const Pixels& pixels)
{
    Direction middle = {0.0, 0.0, 0.0};
    for (const std::uint32_t p : pixels)
        middle = sum(middle, picture.direction(p));
    middle = unit(middle);
    double nearest = 1.0;
    for (const std::uint32_t p : pixels)
        nearest = std::min(nearest, dot(picture.direction(p), middle));
    return {middle, det_acos(std::max(nearest, -1.0))};
}

} // namespace

std::vector<ExtractedLight> extract_lights(Equirect& source, int most, std::vector<SkyCap>& changed)
{
    changed.clear();
    if (most <= 0)
        return {};
    const Picture picture(source);
    Finder finder(picture);
    // Take the strongest regions
    std::vector<Region> regions = finder.find();
    std::stable_sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) { return a.excess > b.excess; });
    if (regions.size() > static_cast<std::size_t>(most))
        regions.resize(static_cast<std::size_t>(most));
    // Mark all regions, then widen each
    std::vector<std::uint8_t> place(picture.width() * picture.height(), kOutside);
    for (const Region& r : regions)
        for (const std::uint32_t p : r.pixels)
            place[p] = kInside;
    for (Region& r : regions)
        widen(picture, r.pixels, place);
    // Measure the lights before any hole is filled
    std::vector<ExtractedLight> lights;
    std::vector<std::vector<float>> filled; // for all regions
    for (const Region& r : regions) {
        filled.push_back(surroundings(picture, source, r.pixels, place));
        lights.push_back(light_of(picture, source, finder.total(), r.pixels, filled.back()));
        changed.push_back(cap_of(picture, r.pixels));
    }
    // Fill the holes
    for (std::size_t i = 0; i < regions.size(); ++i)
        for (std::size_t k = 0; k < regions[i].pixels.size(); ++k)
            std::copy_n(filled[i].data() + 3 * k, 3, source.rgb.data() + 3 * std::size_t{regions[i].pixels[k]});
    return lights;
}

ExtractedLight turned(const ExtractedLight& light, float rotation_deg)
{
    const glm::dmat3 world_from_sky = glm::transpose(sky_from_world(rotation_deg));
    ExtractedLight r = light;
    for (float* v : {r.direction, r.axis_u, r.axis_v}) {
        const glm::dvec3 at = world_from_sky * glm::dvec3(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
        for (int i = 0; i < 3; ++i)
            v[i] = static_cast<float>(at[i]);
    }
    return r;
}

} // namespace burnish
