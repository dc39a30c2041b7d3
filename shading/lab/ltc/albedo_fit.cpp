#include "shading/lab/ltc/albedo_fit.h"

#include <algorithm>
#include <array>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/interpolant_fit.h"

namespace burnish::ltc {
namespace {

constexpr double kOfNodes = 0.3;      // a node's weight among samples
constexpr int kAlbedoSteps = 40;      // conjugate gradient steps
constexpr double kLeastAlbedo = 1e-3; // least denominator in relative errors

struct AlbedoSample {
    Corners corners;
    double weight;
    Albedo is;
};

// Minimises the sum of weight scale (interpolant - is)^2, starting from `nodes`. equal: for each node, the first node that equals it by
// symmetry. Uses conjugate gradients.
template <class Is, class Scale>
void fit_channel(std::vector<double>& nodes, const std::vector<std::size_t>& equal, const std::vector<AlbedoSample>& samples, const Is& is,
                 const Scale& scale)
{
    const auto between = [](const Corners& corners, const std::vector<double>& of) {
        double sum = 0.0;
        for (const Corner& corner : corners)
            sum += corner.weight * of[corner.node];
        return sum;
    };
    const auto spread = [&](const std::vector<double>& of_sample) { // to the nodes around a sample
        std::vector<double> sums(nodes.size(), 0.0);
        for (std::size_t i = 0; i < samples.size(); ++i)
            for (const Corner& corner : samples[i].corners)
                sums[equal[corner.node]] += corner.weight * of_sample[i];
        for (std::size_t n = 0; n < nodes.size(); ++n)
            sums[n] = sums[equal[n]];
        return sums;
    };
    const auto inner = [&](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0.0;
        for (std::size_t n = 0; n < nodes.size(); ++n)
            sum += equal[n] == n ? a[n] * b[n] : 0.0;
        return sum;
    };
    // Weigh the residuals
    std::vector<double> factor, left;
    for (const AlbedoSample& sample : samples) {
        factor.push_back(sample.weight * scale(sample.is));
        left.push_back(factor.back() * (is(sample.is) - between(sample.corners, nodes)));
    }
    // Take conjugate gradient steps
    std::vector<double> residual = spread(left), direction = residual;
    double rho = inner(residual, residual);
    const double enough = 1e-12 * rho;
    for (int step = 0; step < kAlbedoSteps && rho > enough; ++step) {
        for (std::size_t i = 0; i < samples.size(); ++i)
            left[i] = factor[i] * between(samples[i].corners, direction);
        const std::vector<double> product = spread(left);
        const double along = rho / inner(direction, product);
        for (std::size_t n = 0; n < nodes.size(); ++n)
            nodes[n] += along * direction[n], residual[n] -= along * product[n];
        const double next = inner(residual, residual);
        for (std::size_t n = 0; n < nodes.size(); ++n)
            direction[n] = residual[n] + next / rho * direction[n];
        rho = next;
    }
}

} // namespace

std::vector<Albedo> albedos_of_nodes(const Grid& grid, Model model, const Jobs& jobs)
{
    const Rule rule(22);
    std::vector<Albedo> albedos(grid.nodes());
    jobs.parallel_for(grid.nodes(), [&](std::size_t node, int) {
        const std::array<int, 4> i = grid.indices(node);
        if (i[1] == 0 || (i[0] != 0 && i[3] != grid.size - 1)) // otherwise one lobe serves all azimuths
            albedos[node] = albedo(Lobe(grid.place(node), 1.0, model), rule);
    });
    for (std::size_t node = 0; node < grid.nodes(); ++node) {
        const std::array<int, 4> i = grid.indices(node);
        if (i[0] == 0 || i[3] == grid.size - 1)
            albedos[node] = albedos[grid.node(i[0], 0, i[2], i[3])];
    }
    return albedos;
}

std::vector<Albedo> albedos_between_nodes(const Grid& grid, Model model, std::vector<Albedo> of_nodes, int a_cell, const Jobs& jobs)
{
    const Rule rule(18);
    // Integrate sample lobes in every cell
    std::vector<Place> places;
    std::size_t k = 0;
    for (const std::array<int, 4>& cell : grid.cells())
        for (int s = 0; s < a_cell; ++s)
            places.push_back(grid.between(cell[0], cell[1], cell[2], cell[3], spread_point(k++)));
    std::vector<AlbedoSample> samples(places.size());
    jobs.parallel_for(places.size(), [&](std::size_t i, int) {
        Place& place = places[i];
        place.theta = std::min(place.theta, Grid::kMostTheta);
        place.alpha = std::max(place.alpha, Grid::kLeastAlpha);
        place.lambda = std::max(place.lambda, Grid::kLeastLambda);
        samples[i] = {grid.corners(place), 1.0, albedo(Lobe(place, 1.0, model), rule)};
    });
    // Add the nodes as samples
    std::vector<std::size_t> equal(grid.nodes());
    for (std::size_t node = 0; node < grid.nodes(); ++node) {
        const std::array<int, 4> i = grid.indices(node);
        equal[node] = i[0] == 0 || i[3] == grid.size - 1 ? grid.node(i[0], 0, i[2], i[3]) : node;
        AlbedoSample own = {{}, kOfNodes, of_nodes[node]};
        own.corners[0] = {node, 1.0};
        samples.push_back(own);
    }
    // Fit both channels
    std::vector<double> all, grazing;
    for (const Albedo& a : of_nodes)
        all.push_back(a.all), grazing.push_back(a.grazing);
    const auto relative = [](const Albedo& a) {
        const double s = 1.0 / std::max(a.all, kLeastAlbedo);
        return s * s;
    };
    fit_channel(
        all, equal, samples, [](const Albedo& a) { return a.all; }, relative);
    fit_channel(
        grazing, equal, samples, [](const Albedo& a) { return a.grazing; }, [](const Albedo&) { return 1.0; });
    for (std::size_t node = 0; node < grid.nodes(); ++node)
        of_nodes[node] = {std::max(all[node], 0.0), std::max(grazing[node], 0.0)};
    return of_nodes;
}

} // namespace burnish::ltc
