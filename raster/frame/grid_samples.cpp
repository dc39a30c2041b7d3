#include "raster/frame/grid_samples.h"

#include <cmath>

#include "core/math/scalar_math.h"
#include "shading/kernels/math_special.k.h"

namespace burnish {

std::vector<GridSample> grid_samples(int samples, bool ggx)
{
    int n = 1;
    while ((n + 1) * (n + 1) <= samples)
        ++n;
    std::vector<GridSample> grid;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = (i + 0.5) / n, v = (j + 0.5) / n;
            double x, y, density;
            if (ggx) { // radius from the distribution of slopes, which is that of D h.z
                const double r2 = n == 1 ? 0.0 : v / (1.0 - v), r = std::sqrt(r2); // one sample lies in the middle
                x = r * det_cos(2.0 * kPi * u), y = r * det_sin(2.0 * kPi * u);
                density = 1.0 / (kPi * (1.0 + r2) * (1.0 + r2));
            } else {
                x = static_cast<double>(k_erfinv(static_cast<float>(2.0 * u - 1.0)));
                y = static_cast<double>(k_erfinv(static_cast<float>(2.0 * v - 1.0)));
                density = det_exp(-x * x - y * y) / kPi;
            }
            grid.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(density)});
        }
    return grid;
}

} // namespace burnish
