#include "shading/lab/ltc/polygon.h"

#include "core/math/scalar_math.h"

namespace burnish::ltc {

double polygon_part(const Matrix& n, const std::vector<Vec>& corners)
{
    std::vector<Vec> above; // clipped: points on the horizon count as below
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec a = n * corners[i], b = n * corners[(i + 1) % corners.size()];
        if (a.z > 0.0)
            above.push_back(unit(a));
        if ((a.z > 0.0) != (b.z > 0.0)) {
            const double t = a.z / (a.z - b.z);
            above.push_back(unit({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), 0.0}));
        }
    }
    // Sum the edges' form factors
    double sum = 0.0;
    for (std::size_t i = 0; i < above.size() && above.size() > 2; ++i) {
        const Vec &a = above[i], &b = above[(i + 1) % above.size()], c = cross(a, b);
        const double length = std::sqrt(dot(c, c));
        if (length > 0.0)
            sum += c.z * (det_atan2(length, dot(a, b)) / length);
    }
    return std::abs(sum) / (2.0 * kPi);
}

} // namespace burnish::ltc
