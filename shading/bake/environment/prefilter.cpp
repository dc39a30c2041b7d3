#include "shading/bake/environment/prefilter.h"

#include <cmath>

namespace burnish {
IrradianceSource make_irradiance_source(const CubeLevel& level)
{
    IrradianceSource s;
    const std::size_t n = static_cast<std::size_t>(level.size);
    s.row = level.size;
    const double step = 2.0 / level.size, node = 0.5 / std::sqrt(3.0); // Gauss-Legendre, two points per axis
    for (int face = 0; face < 6; ++face)
        for (std::size_t i = 0; i < n * n; ++i) {
            Direction sum = {0.0, 0.0, 0.0};
            for (int k = 0; k < 4; ++k) {
                const double u = (static_cast<double>(i % n) + 0.5 + (k % 2 ? node : -node)) * step - 1.0;
                const double v = (static_cast<double>(i / n) + 0.5 + (k / 2 ? node : -node)) * step - 1.0;
                const Direction d = cube_direction(face, u, v);
                const double r2 = 1.0 + u * u + v * v,
                             w = 0.25 * step * step / (r2 * r2); // unit direction times solid angle
                sum = {sum.x + w * d.x, sum.y + w * d.y, sum.z + w * d.z};
            }
            s.x.push_back(static_cast<float>(sum.x));
            s.y.push_back(static_cast<float>(sum.y));
            s.z.push_back(static_cast<float>(sum.z));
            const float* rgb = level.rgb.data() + (static_cast<std::size_t>(face) * n * n + i) * 3;
            s.r.push_back(rgb[0]);
            s.g.push_back(rgb[1]);
            s.b.push_back(rgb[2]);
        }
    return s;
}

IrradianceInput IrradianceSource::input() const
{
    return {x.data(), y.data(), z.data(), r.data(), g.data(), b.data(), static_cast<int>(x.size()), row};
}

} // namespace burnish
