#include "shading/lab/ltc/bake_ltc.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/math/scalar_math.h"
#include "shading/lab/ltc/albedo_fit.h"
#include "shading/lab/ltc/bake_checkpoint.h"

namespace burnish::ltc {
namespace {

constexpr std::size_t kStepUnits = 64;   // cost of an interpolant step, in chains of nodes
constexpr std::size_t kChainsKept = 64;  // chains between two checkpoints
constexpr std::size_t kProbesANode = 93; // lookups that the guard checks

Status keep(const BakeOptions& options, const BakeProgress& p)
{
    if (options.checkpoint.empty())
        return {};
    const std::vector<std::uint8_t> bytes = bake_checkpoint_bytes(bake_key(options), p);
    return write_file_atomic(options.checkpoint, bytes.data(), bytes.size());
}

Status go_on(const BakeOptions& options, BakeProgress& p)
{
    std::error_code ignored;
    if (options.checkpoint.empty() || !std::filesystem::exists(std::filesystem::symlink_status(options.checkpoint, ignored)))
        return {};
    const Result<std::vector<std::uint8_t>> read = read_file(options.checkpoint, std::uint64_t{1} << 32);
    return read ? parse_bake_checkpoint(*read, options.checkpoint, bake_key(options), static_cast<std::uint64_t>(options.steps), p)
                : read.error();
}

// Returns azimuth, width and ratio of a chain, as indices.
std::array<int, 3> chain_place(const Grid& grid, std::size_t chain)
{
    const std::size_t alphas = static_cast<std::size_t>(grid.sizes()[2]), lambdas = static_cast<std::size_t>(grid.sizes()[3]);
    return {static_cast<int>(chain / (alphas * lambdas)), static_cast<int>(chain / lambdas % alphas), static_cast<int>(chain % lambdas)};
}

// Stores a chain, and its mirror image by symmetry.
void put(const BakeOptions& options, int phi, int alpha, int lambda, const Chain& chain, BakeProgress& p)
{
    const Grid& grid = options.grid;
    const int last = grid.size - 1;
    for (int theta = 0; theta <= last; ++theta) {
        const std::size_t node = grid.node(theta, phi, alpha, lambda), i = static_cast<std::size_t>(theta);
        p.nodes[node] = chain.entries[i], p.l1[node] = chain.l1[i];
        if (lambda == last && !grid.round && options.symmetry) { // see Grid::first_equal
            const std::size_t other = grid.node(theta, last - phi, alpha, lambda);
            p.nodes[other] = with_axes_exchanged(chain.entries[i]), p.l1[other] = chain.l1[i];
        }
    }
}

// Makes entries equal to the last bit where symmetry demands it. They differ by rounding.
void make_equal(const Grid& grid, std::vector<Matrix>& entries)
{
    for (std::size_t node = 0; node < entries.size(); ++node)
        for (std::size_t e = 0; e < 9; ++e) {
            const auto [first, element] = grid.first_equal(node, e);
            entries[node][e] = entries[first][element];
        }
}

Matrix in_own_gauge(const Matrix& m)
{
    // Rotates until the first two columns are orthogonal, the longer one first: tan 2t = 2 a.b / (a.a - b.b).
    const Vec a = {m[0], m[3], m[6]}, b = {m[1], m[4], m[7]};
    const double angle = 0.5 * det_atan2(2.0 * dot(a, b), dot(a, a) - dot(b, b)), c = det_cos(angle), s = det_sin(angle);
    return m * Matrix{c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0};
}

} // namespace

Chain fit_chain(const BakeOptions& options, int phi, int alpha, int lambda)
{
    static const Rule albedo_rule(18);
    const Rule rule(options.rule);
    const Grid& grid = options.grid;
    Chain chain;
    Matrix before{}, plain_before{};
    for (int theta = 0; theta < grid.size; ++theta) {
        const std::size_t node = grid.node(theta, theta == 0 && options.symmetry ? 0 : phi, alpha, lambda);
        const Place place = grid.place(node);
        const Mask zero = options.symmetry ? grid.zero(node) : 0; // a gauge rotation moves other elements
        const LobePoints points(normalised_lobe(place, albedo_rule, options.model), rule);
        Matrix plain = natural_matrix(place);
        if (options.norm != Norm::l1) {
            Grid about; // its frame is the mirror direction's
            plain = about.frame(place) * Matrix{place.alpha, 0.0, 0.0, 0.0, place.alpha * place.lambda, 0.0, 0.0, 0.0, 1.0};
        }
        const auto fit = [&](const Matrix& start) {
            return options.norm == Norm::sliced ? fit_sliced(points, start, zero) : fit_lobe(points, start, zero, options.norm);
        };
        NodeFit best = fit(plain);
        if (theta > 0 && options.norm != Norm::sliced) { // start from the neighbour's fit, turned with the mirror direction
            const Matrix start = plain * inverse(plain_before) * before;
            if (determinant(start) > 0.0)
                if (const NodeFit other = fit(start); other.l1 < best.l1)
                    best = other;
        }
        before = best.m, plain_before = plain;
        // Fix the gauge, and store the entry
        Matrix m = options.align ? in_natural_gauge(best.m, place) : in_own_gauge(best.m);
        for (std::size_t e = 0; e < 9; ++e)
            if (options.align && (zero >> e & 1u))
                m[e] = 0.0;
        chain.entries.push_back(grid.held(m, place));
        chain.l1.push_back(options.norm == Norm::l1 ? best.l1 : l1_distance(points, best.m));
    }
    return chain;
}

std::uint64_t bake_key(const BakeOptions& o)
{
    const Grid& g = o.grid;
    const std::int32_t key[] = {static_cast<std::int32_t>(kTableVersion),
                                g.size,
                                g.beyond,
                                g.round,
                                g.root_alpha,
                                g.over_alpha,
                                g.inverse,
                                static_cast<std::int32_t>(g.basis),
                                o.samples_a_cell,
                                o.steps,
                                static_cast<std::int32_t>(o.norm),
                                static_cast<std::int32_t>(o.model),
                                o.align,
                                o.symmetry,
                                o.rule};
    return hash_bytes(key, sizeof key);
}

std::size_t bake_chains(const BakeOptions& options)
{
    return chains_of(options.grid);
}

std::vector<Chain> fit_chains(const BakeOptions& options, std::size_t first, std::size_t count, const Jobs& jobs)
{
    std::vector<Chain> chains(count);
    jobs.parallel_for(count, [&](std::size_t i, int) {
        const auto [phi, alpha, lambda] = chain_place(options.grid, first + i);
        if (options.grid.round || !options.symmetry || lambda < options.grid.size - 1 || 2 * phi < options.grid.size)
            chains[i] = fit_chain(options, phi, alpha, lambda);
        if (options.advance)
            options.advance(1);
    });
    return chains;
}

std::size_t bake_units(const BakeOptions& options)
{
    return chains_of(options.grid) + static_cast<std::size_t>(options.steps) * kStepUnits;
}

Result<std::optional<Baked>> bake_table(const BakeOptions& options, const Jobs& jobs)
{
    const Grid& grid = options.grid;
    const auto advance = [&](std::size_t units) {
        if (options.advance && units > 0)
            options.advance(units);
    };
    const auto stopped = [&] { return options.stop && options.stop->load(); };
    BakeProgress p(grid);
    BN_TRY(go_on(options, p));
    // Resume, then fit chains of nodes, with checkpoints
    advance(p.chains + p.steps * kStepUnits);
    const std::size_t chains = chains_of(grid);
    while (p.chains < chains) {
        const std::size_t from = p.chains, count = std::min(chains - from, kChainsKept);
        const std::vector<Chain> fitted = options.fitted.empty() ? fit_chains(options, from, count, jobs) : std::vector<Chain>();
        for (std::size_t i = 0; i < count; ++i) {
            const Chain& chain = options.fitted.empty() ? fitted[i] : options.fitted[from + i];
            const auto [phi, alpha, lambda] = chain_place(grid, from + i);
            if (!chain.entries.empty())
                put(options, phi, alpha, lambda, chain, p);
        }
        p.chains = from + count;
        if (!options.fitted.empty()) {
            advance(count);
            continue;
        }
        BN_TRY(keep(options, p));
        if (stopped())
            return std::optional<Baked>();
    }
    if (options.symmetry && options.align)
        make_equal(grid, p.nodes);

    // Fit the interpolant
    Baked baked;
    for (double l1 : p.l1)
        baked.node_l1 += l1 / static_cast<double>(p.l1.size());
    std::vector<Matrix> entries = p.nodes;
    if (options.steps > 0) {
        InterpolantFit fit(grid, options.model, options.samples_a_cell, jobs);
        if (p.state.entries.empty()) {
            p.state = fit.begin(p.nodes);
            p.cost_before = p.state.cost;
        }
        while (p.steps < static_cast<std::uint64_t>(options.steps)) {
            if (stopped())
                return std::optional<Baked>();
            fit.step(p.state);
            ++p.steps;
            BN_TRY(keep(options, p));
            advance(kStepUnits);
        }
        entries = p.state.entries;
        if (stopped())
            return std::optional<Baked>();
        // Repair flat matrices
        baked.probes = kProbesANode * grid.nodes();
        fit.guard(entries, p.nodes, 0.2, baked.probes);
        // At grazing views across thin lobes the node fits are no better. Natural matrices are safe everywhere.
        std::vector<Matrix> natural;
        for (std::size_t node = 0; node < grid.nodes(); ++node)
            natural.push_back(grid.held(natural_matrix(grid.place(node)), grid.place(node)));
        make_equal(grid, natural);
        if (stopped())
            return std::optional<Baked>();
        baked.weak_lookups = fit.guard(entries, natural, 0.005, baked.probes);
        baked.fit_l1_before = p.cost_before, baked.fit_l1 = p.state.cost;
    }
    if (stopped())
        return std::optional<Baked>();
    const std::uint32_t made = static_cast<std::uint32_t>(options.norm) << kNormShift | (options.align ? 0u : kUnaligned) |
                               // Bake albedos
                               (options.symmetry ? 0u : kUnsymmetric) | static_cast<std::uint32_t>(options.model) << kLobeShift;
    std::vector<Albedo> albedos = albedos_of_nodes(grid, options.model, jobs);
    if (options.steps > 0)
        albedos = albedos_between_nodes(grid, options.model, std::move(albedos), options.samples_a_cell, jobs);
    baked.table = make_table(grid, entries, albedos, made);
    return std::optional(std::move(baked));
}

} // namespace burnish::ltc
