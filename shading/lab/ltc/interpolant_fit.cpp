#include "shading/lab/ltc/interpolant_fit.h"

#include <algorithm>

#include "core/math/scalar_math.h"

namespace burnish::ltc {
namespace {

constexpr double kNodeWeight = 0.3;
constexpr double kLeastSampleAlpha = 0.005; // for columns that shrink with alpha: no interpolation is accurate below
constexpr double kLeastMu = 1e-3, kWorstL1 = 2.0;
constexpr int kSolverSteps = 60;
constexpr std::size_t kChunk = 64; // samples per job

std::size_t packed(std::size_t i, std::size_t j) // index into an upper triangle with nine rows
{
    return i <= j ? 9 * i - i * (i - 1) / 2 + (j - i) : packed(j, i);
}

template <class Body> void in_chunks(const Jobs& jobs, std::size_t count, const Body& body)
{
    jobs.parallel_for((count + kChunk - 1) / kChunk, [&](std::size_t chunk, int) {
        for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i)
            body(i);
    });
}

} // namespace

std::array<double, 4> spread_point(std::size_t k)
{
    constexpr double kRoot = 1.1673039782614187; // root of x^5 = x + 1
    std::array<double, 4> u;
    double power = 1.0;
    for (double& v : u) {
        power /= kRoot;
        const double at = 0.5 + static_cast<double>(k + 1) * power;
        v = at - std::floor(at);
    }
    return u;
}

InterpolantFit::InterpolantFit(const Grid& grid, Model model, int a_cell, const Jobs& jobs)
    : grid_(grid), model_(model), jobs_(&jobs), rule_(14), albedo_rule_(17), variable_(grid.nodes() * 9, -1), touched_(grid.nodes())
{
    // Place samples in all cells and at all nodes
    std::size_t k = 0;
    for (const std::array<int, 4>& cell : grid.cells())
        for (int s = 0; s < a_cell; ++s) {
            Place place = grid.between(cell[0], cell[1], cell[2], cell[3], spread_point(k++));
            place.theta = std::min(place.theta, Grid::kMostTheta);
            place.alpha = std::max(place.alpha, grid.over_alpha ? Grid::kLeastAlpha : kLeastSampleAlpha);
            place.lambda = std::max(place.lambda, Grid::kLeastLambda);
            samples_.push_back({place, 1.0, grid.corners(place)});
        }
    for (std::size_t node = 0; node < grid.nodes(); ++node) {
        Corners corners{};
        corners[0] = {node, 1.0};
        samples_.push_back({grid.place(node), kNodeWeight, corners});
    }
    // Integrate the samples' albedos
    albedo_.resize(samples_.size());
    in_chunks(jobs, samples_.size(), [&](std::size_t i) { albedo_[i] = albedo(Lobe(samples_[i].place, 1.0, model_), albedo_rule_).all; });
    equations_.resize(samples_.size());
    // List the samples around each node
    for (std::size_t i = 0; i < samples_.size(); ++i)
        for (const Corner& corner : samples_[i].corners)
            if (corner.weight > 0.0)
                touched_[corner.node].push_back({i, corner.weight});
    // Number the variables: elements that are neither zero nor equal to an earlier one
    for (std::size_t node = 0; node < grid.nodes(); ++node)
        for (std::size_t e = 0; e < 9; ++e) {
            const auto [first, element] = grid.first_equal(node, e);
            if (grid.zero(node) >> e & 1u || grid.zero(first) >> element & 1u)
                continue;
            const bool own = first == node && element == e;
            variable_[9 * node + e] = own ? static_cast<std::int32_t>(variables_++) : variable_[9 * first + element];
        }
}

// Computes all samples' equations at these entries, and the cost.
void InterpolantFit::measure(const std::vector<Matrix>& entries)
{
    in_chunks(*jobs_, samples_.size(), [&](std::size_t index) {
        const Sample& sample = samples_[index];
        Equations& out = equations_[index];
        Matrix entry{};
        for (const Corner& corner : sample.corners)
            for (std::size_t e = 0; e < 9; ++e)
                entry[e] += corner.weight * entries[corner.node][e];
        const Matrix m = grid_.shown(entry, sample.place);
        if (!(determinant(m) > 0.0)) {
            out = {{}, {}, kWorstL1};
            return;
        }
        Sums sums = sums_of(LobePoints(Lobe(sample.place, albedo_[index], model_), rule_), m);
        // These are equations in E = -D^-1 N dT D, where D holds the widths.
        const double width[3] = {grid_.width(sample.place), grid_.width(sample.place), 1.0};
        for (std::size_t i = 0, at = 0; i < 9; ++i) {
            const double s = width[i % 3] / width[i / 3];
            sums.gradient[i] *= s;
            for (std::size_t j = i; j < 9; ++j)
                sums.hessian[at++] *= s * (width[j % 3] / width[j / 3]);
        }
        const Matrix n = inverse(entry); // E = -N dM = -(entry)^-1 d(entry)
        out.l1 = sums.l1;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t j = 0; j < 3; ++j) {
                double g = 0.0;
                for (std::size_t i = 0; i < 3; ++i)
                    g -= n[3 * i + k] * sums.gradient[3 * i + j];
                out.gradient[3 * k + j] = sample.weight * g;
            }
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t j2 = 0; j2 < 3; ++j2) {
                double half[3][3]; // rows of E, columns of the entry
                for (std::size_t i = 0; i < 3; ++i)
                    for (std::size_t k2 = 0; k2 < 3; ++k2) {
                        half[i][k2] = 0.0;
                        for (std::size_t i2 = 0; i2 < 3; ++i2)
                            half[i][k2] += sums.hessian[packed(3 * i + j, 3 * i2 + j2)] * n[3 * i2 + k2];
                    }
                for (std::size_t k = 0; k < 3; ++k)
                    for (std::size_t k2 = 0; k2 < 3; ++k2) {
                        double h = 0.0;
                        for (std::size_t i = 0; i < 3; ++i)
                            h += n[3 * i + k] * half[i][k2];
                        out.hessian[9 * (3 * k + j) + 3 * k2 + j2] = sample.weight * h;
                    }
            }
    });
    double sum = 0.0, weight = 0.0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        sum += samples_[i].weight * equations_[i].l1;
        weight += samples_[i].weight;
    }
    cost_ = sum / weight;
}

// Solves the equations by conjugate gradients with a diagonal preconditioner. Sums run over samples and nodes in a fixed order, for any
// number of threads.
std::vector<double> InterpolantFit::solve(double mu) const
{
    const std::size_t nodes = grid_.nodes();
    std::vector<std::array<double, 9>> of_sample(samples_.size()), of_node(nodes);
    const auto to_variables = [&](std::vector<double>& out) {
        std::fill(out.begin(), out.end(), 0.0);
        for (std::size_t node = 0; node < nodes; ++node)
            for (std::size_t e = 0; e < 9; ++e)
                if (variable_[9 * node + e] >= 0)
                    out[static_cast<std::size_t>(variable_[9 * node + e])] += of_node[node][e];
    };
    const auto gather = [&](std::vector<double>& out) { // sums the samples' values at their nodes
        in_chunks(*jobs_, nodes, [&](std::size_t node) {
            of_node[node] = {};
            for (const Corner& c : touched_[node])
                for (std::size_t e = 0; e < 9; ++e)
                    of_node[node][e] += c.weight * of_sample[c.node][e];
        });
        to_variables(out);
    };
    std::vector<double> diagonal(variables_), right(variables_), x(variables_, 0.0), product(variables_), direction(variables_),
        z(variables_);
    in_chunks(*jobs_, nodes, [&](std::size_t node) { // exact for an element with its own variable, else its main part
        of_node[node] = {};
        for (const Corner& c : touched_[node])
            for (std::size_t e = 0; e < 9; ++e)
                of_node[node][e] += c.weight * c.weight * equations_[c.node].hessian[10 * e];
    });
    to_variables(diagonal);
    double greatest = 0.0;
    for (double d : diagonal)
        greatest = std::max(greatest, d);
    for (double& d : diagonal)
        d = std::max(d, 1e-12 * greatest);
    // Set up the right side and the product with the matrix
    for (std::size_t i = 0; i < samples_.size(); ++i)
        of_sample[i] = equations_[i].gradient;
    gather(right);
    const auto times = [&](const std::vector<double>& v, std::vector<double>& out) {
        in_chunks(*jobs_, samples_.size(), [&](std::size_t i) {
            std::array<double, 9> d{};
            for (const Corner& corner : samples_[i].corners)
                for (std::size_t e = 0; e < 9; ++e)
                    if (const std::int32_t var = variable_[9 * corner.node + e]; var >= 0)
                        d[e] += corner.weight * v[static_cast<std::size_t>(var)];
            for (std::size_t r = 0; r < 9; ++r) {
                double sum = 0.0;
                for (std::size_t c = 0; c < 9; ++c)
                    sum += equations_[i].hessian[9 * r + c] * d[c];
                of_sample[i][r] = sum;
            }
        });
        gather(out);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] += mu * diagonal[i] * v[i];
    };
    const auto inner = [](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i)
            sum += a[i] * b[i];
        return sum;
    };
    // Take conjugate gradient steps
    for (std::size_t i = 0; i < variables_; ++i)
        direction[i] = z[i] = right[i] / diagonal[i];
    double rho = inner(right, z);
    const double enough = 1e-8 * rho;
    for (int step = 0; step < kSolverSteps && rho > enough; ++step) {
        times(direction, product);
        const double a = rho / inner(direction, product);
        for (std::size_t i = 0; i < variables_; ++i) {
            x[i] += a * direction[i];
            right[i] -= a * product[i];
            z[i] = right[i] / diagonal[i];
        }
        const double next = inner(right, z);
        for (std::size_t i = 0; i < variables_; ++i)
            direction[i] = z[i] + next / rho * direction[i];
        rho = next;
    }
    return x;
}

std::vector<Matrix> InterpolantFit::moved(const std::vector<Matrix>& entries, const std::vector<double>& by) const
{
    std::vector<Matrix> to = entries;
    for (std::size_t node = 0; node < entries.size(); ++node) {
        for (std::size_t e = 0; e < 9; ++e)
            if (const std::int32_t v = variable_[9 * node + e]; v >= 0)
                to[node][e] += by[static_cast<std::size_t>(v)];
        to[node] = with_unit_axis(to[node]);
    }
    return to;
}

InterpolantFit::State InterpolantFit::begin(std::vector<Matrix> entries)
{
    State state;
    state.entries = std::move(entries);
    measure(state.entries);
    state.cost = cost_;
    return state;
}

bool InterpolantFit::step(State& state)
{
    measure(state.entries);
    const std::vector<Matrix> entries = moved(state.entries, solve(state.mu));
    measure(entries);
    if (!(cost_ < state.cost)) {
        state.mu *= 6.0;
        return false;
    }
    state.entries = entries;
    state.cost = cost_;
    state.mu = std::max(0.5 * state.mu, kLeastMu);
    return true;
}

std::size_t InterpolantFit::guard(std::vector<Matrix>& entries, const std::vector<Matrix>& safe, double part, std::size_t probes) const
{
    constexpr int kRounds = 16;
    constexpr double kBlend = 0.2;
    const std::size_t chunk = 4096, chunks = (probes + chunk - 1) / chunk;
    std::size_t left = 0;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<std::vector<Corner>> found(chunks); // nodes around probes that are too flat, with their relative weights
        jobs_->parallel_for(chunks, [&](std::size_t c, int) {
            for (std::size_t i = c * chunk; i < std::min(probes, (c + 1) * chunk); ++i) {
                const Place place = usable_place(spread_point(i), grid_.most_alpha());
                if (determinant(grid_.lookup(entries, place)) >= part * determinant(grid_.lookup(safe, place)))
                    continue;
                const Corners corners = grid_.corners(place);
                double most = 0.0;
                for (const Corner& corner : corners)
                    most = std::max(most, corner.weight);
                for (const Corner& corner : corners)
                    if (corner.weight > 0.0)
                        found[c].push_back({corner.node, corner.weight / most});
            }
        });
        // Blend these nodes, and their equals, towards the safe entries
        std::vector<double> blend(entries.size(), 0.0);
        left = 0;
        for (std::size_t node = 0; node < entries.size(); ++node)
            if (determinant(entries[node]) < part * determinant(safe[node]))
                found[0].insert(found[0].end(), 16, {node, 1.0});
        for (const std::vector<Corner>& some : found)
            for (const Corner& corner : some) {
                double& by = blend[grid_.first_equal(corner.node, 0).first];
                by = std::max(by, corner.weight);
                ++left;
            }
        left /= 16;
        if (left == 0)
            break;
        for (std::size_t node = 0; node < entries.size(); ++node) {
            const double by = blend[grid_.first_equal(node, 0).first];
            if (!(by > 0.0))
                continue;
            for (std::size_t e = 0; e < 9; ++e)
                entries[node][e] += kBlend * by * by * (safe[node][e] - entries[node][e]);
            entries[node] = with_unit_axis(entries[node]);
        }
    }
    return left;
}

} // namespace burnish::ltc
