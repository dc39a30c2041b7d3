// Bakes the DFG table by quadrature: GGX with height-correlated Smith masking-shadowing, visible normals sampled on a regular grid.
// Visible normals: Heitz 2018, "Sampling the GGX distribution of visible normals"; as a spherical cap: Dupuy, Benyoub 2023. With visible
// normals the integrand is F * G2/G1, smooth and below 1, so a midpoint rule converges fast.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "shading/bake/environment/environment.h"

namespace burnish {
namespace {

struct ScaleBias {
    double scale, bias;
};

// Smith's Lambda for GGX: (sqrt(1 + alpha^2 tan^2) - 1) / 2.
double ggx_lambda(double cosine, double alpha)
{
    const double tan2 = (1.0 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * std::max(tan2, 0.0)) - 1.0);
}

// Integrates one entry. n_dot_v and alpha are above 0. cosines: azimuths on one half circle; the other half mirrors it.
ScaleBias integrate(double n_dot_v, double alpha, const std::vector<double>& cosines)
{
    const std::size_t n = cosines.size();
    const double vx = std::sqrt(std::max(0.0, 1.0 - n_dot_v * n_dot_v)), vz = n_dot_v;
    // Transform the view direction to the space where the ellipsoid of normals is a sphere
    const double length = std::sqrt(alpha * alpha * vx * vx + vz * vz);
    const double wx = alpha * vx / length, wz = vz / length;
    const double lambda_v = ggx_lambda(vz, alpha);
    ScaleBias sum = {0.0, 0.0};
    for (std::size_t j = 0; j < n; ++j) {
        // Grade towards the far end, where a narrow strip holds the widely tilted normals
        const double t = 1.0 - (static_cast<double>(j) + 0.5) / static_cast<double>(n), density = 3.0 * t * t;
        const double z = 1.0 - (1.0 - t * t * t) * (1.0 + wz);
        const double rho = std::sqrt(std::max(0.0, 1.0 - z * z));
        for (std::size_t i = 0; i < n; ++i) {
            const double cx = rho * cosines[i] + wx, cz = z + wz;
            const double cy2 = rho * rho * (1.0 - cosines[i] * cosines[i]);
            const double hx = alpha * cx, hz = std::max(cz, 0.0);
            const double norm = std::sqrt(hx * hx + alpha * alpha * cy2 + hz * hz);
            const double v_dot_h = (vx * hx + vz * hz) / norm;
            const double n_dot_l = 2.0 * v_dot_h * hz / norm - vz;
            if (!(n_dot_l > 0.0))
                continue;
            const double g = (1.0 + lambda_v) / (1.0 + lambda_v + ggx_lambda(n_dot_l, alpha)) * density; // G2 / G1(v)
            const double m = 1.0 - std::min(v_dot_h, 1.0), fresnel = m * m * m * m * m;
            sum.scale += (1.0 - fresnel) * g;
            sum.bias += fresnel * g;
        }
    }
    const double count = static_cast<double>(n) * static_cast<double>(n);
    return {sum.scale / count, sum.bias / count};
}

// Returns plain Schlick Fresnel: a mirror has no shadowing.
ScaleBias mirror(double n_dot_v)
{
    const double m = 1.0 - n_dot_v, fresnel = m * m * m * m * m;
    return {1.0 - fresnel, fresnel};
}

} // namespace

DfgTable bake_dfg(int size, int samples, const Jobs& jobs)
{
    BN_CHECK(size >= 2 && samples >= 1);
    DfgTable table;
    table.size = size;
    const std::size_t n = static_cast<std::size_t>(size);
    table.pairs.resize(2 * n * n);
    std::vector<double> cosines(static_cast<std::size_t>(std::sqrt(static_cast<double>(samples))));
    for (std::size_t i = 0; i < cosines.size(); ++i)
        cosines[i] = det_cos(kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(cosines.size()));
    jobs.parallel_for(n, [&](std::size_t y, int) {
        const double roughness = static_cast<double>(y) / (size - 1);
        for (std::size_t x = 0; x < n; ++x) {
            const double n_dot_v = static_cast<double>(x) / (size - 1);
            // The first row is a mirror, the first column the limit for grazing views.
            const ScaleBias r = y == 0 ? mirror(n_dot_v) : integrate(std::max(n_dot_v, 1e-4), roughness * roughness, cosines);
            float* const pair = table.pairs.data() + 2 * (y * n + x);
            pair[0] = static_cast<float>(r.scale), pair[1] = static_cast<float>(r.bias);
        }
    });
    return table;
}

} // namespace burnish
