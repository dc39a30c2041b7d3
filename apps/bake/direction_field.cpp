#include "apps/bake/direction_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace burnish {
namespace {

constexpr int kGutter = 16;      // texels around an island
constexpr double kMostTurns = 8; // texture repeats over one triangle

glm::dvec3 point_of(const float* p)
{
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

class Painter {
  public:
    Painter(const PictureSize& size, const glm::dvec3& direction) : size_(size), direction_(direction)
    {
        const std::size_t texels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
        cosine_.resize(texels), sine_.resize(texels), painted_.resize(texels);
    }

    void triangle(const ShadingVertex* const (&corner)[3])
    {
        double x[3], y[3];
        for (int i = 0; i < 3; ++i)
            x[i] = static_cast<double>(corner[i]->uv0[0]) * size_.width - 0.5,
            y[i] = static_cast<double>(corner[i]->uv0[1]) * size_.height - 0.5;
        const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        const auto [low_x, high_x] = std::minmax({x[0], x[1], x[2]});
        const auto [low_y, high_y] = std::minmax({y[0], y[1], y[2]});
        if (!(std::abs(area) > 1e-12) || !(high_x - low_x < kMostTurns * size_.width) || !(high_y - low_y < kMostTurns * size_.height) ||
            !(std::abs(low_x) < 1e9 && std::abs(low_y) < 1e9))
            return;
        for (auto row = static_cast<std::int64_t>(std::ceil(low_y)); row <= static_cast<std::int64_t>(std::floor(high_y)); ++row)
            for (auto column = static_cast<std::int64_t>(std::ceil(low_x)); column <= static_cast<std::int64_t>(std::floor(high_x));
                 ++column) {
                const double px = static_cast<double>(column), py = static_cast<double>(row);
                const double b = ((px - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (py - y[0])) / area;
                const double c = ((x[1] - x[0]) * (py - y[0]) - (px - x[0]) * (y[1] - y[0])) / area;
                if (b >= 0.0 && c >= 0.0 && b + c <= 1.0)
                    paint(column, row, corner, {1.0 - b - c, b, c});
            }
    }

    // Gives texels beside painted ones the mean of those neighbours.
    void grow()
    {
        const std::vector<std::uint8_t> before = painted_;
        for (int y = 0; y < size_.height; ++y)
            for (int x = 0; x < size_.width; ++x) {
                const std::size_t to = place(x, y);
                double c = 0.0, s = 0.0;
                for (int dy = -1; !before[to] && dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx)
                        if (const std::size_t from = place(x + dx, y + dy); before[from])
                            c += cosine_[from], s += sine_[from];
                const double length = std::sqrt(c * c + s * s);
                if (length > 1e-6)
                    cosine_[to] = c / length, sine_[to] = s / length, painted_[to] = 1;
            }
    }

    // Writes directions at half of the stored double angles.
    void put(float* to) const
    {
        for (std::size_t i = 0; i < painted_.size(); ++i, to += 3) {
            const double c = painted_[i] ? std::sqrt(std::max(0.5 + 0.5 * cosine_[i], 0.0)) : 1.0;
            const double s = painted_[i] ? std::sqrt(std::max(0.5 - 0.5 * cosine_[i], 0.0)) : 0.0;
            to[0] = static_cast<float>(sine_[i] < 0.0 ? -c : c), to[1] = static_cast<float>(s), to[2] = 1.0f;
        }
    }

    std::size_t covered = 0, without = 0, twice = 0;

  private:
    std::size_t place(std::int64_t x, std::int64_t y) const
    {
        const std::int64_t w = size_.width, h = size_.height;
        return static_cast<std::size_t>(((y % h + h) % h) * w + (x % w + w) % w);
    }

    void paint(std::int64_t column, std::int64_t row, const ShadingVertex* const (&corner)[3], const glm::dvec3& weight)
    {
        const std::size_t to = place(column, row);
        if (painted_[to]) {
            ++twice;
            return;
        }
        glm::dvec3 n(0.0), t(0.0);
        for (int i = 0; i < 3; ++i)
            n += point_of(corner[i]->normal) * weight[i], t += point_of(corner[i]->tangent) * weight[i];
        n /= std::sqrt(glm::dot(n, n));
        t -= n * glm::dot(n, t);
        t /= std::sqrt(glm::dot(t, t));
        const glm::dvec3 b = glm::cross(n, t) * static_cast<double>(corner[0]->tangent[3]);
        const double x = glm::dot(t, direction_), y = glm::dot(b, direction_), length2 = x * x + y * y;
        ++covered;
        if (!(length2 > 1e-6)) { // also true for NaN of a degenerate frame
            ++without;
            return;
        }
        cosine_[to] = (x * x - y * y) / length2, sine_[to] = 2.0 * x * y / length2, painted_[to] = 1;
    }

    PictureSize size_;
    glm::dvec3 direction_;
    std::vector<double> cosine_, sine_; // of double angles
    std::vector<std::uint8_t> painted_;
};

} // namespace

DirectionField bake_direction_field(const DrawTables& tables, const glm::vec3& direction, const PictureSize& size)
{
    const glm::dvec3 along(direction);
    Painter painter(size, along / std::sqrt(glm::dot(along, along)));
    for (std::size_t t = 0; t < tables.triangle_count(); ++t) {
        const ShadingVertex* corner[3];
        for (std::size_t i = 0; i < 3; ++i)
            corner[i] = &tables.shading[tables.indices[3 * t + i]];
        painter.triangle(corner);
    }
    DirectionField out = {make_image(size.width, size.height, 3, PixelType::f32), painter.covered, painter.without, painter.twice};
    for (int i = 0; i < kGutter; ++i)
        painter.grow();
    painter.put(out.directions.f32());
    return out;
}

} // namespace burnish
