// Fits for one lobe and for a table. The bytes do not depend on threads or interruptions.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>

#include "core/base/file.h"
#include "core/math/scalar_math.h"
#include "shading/lab/ltc/bake_ltc.h"
#include "shading/lab/ltc/interpolant_fit.h"
#include "shading/lab/ltc/quality.h"

namespace burnish::ltc {
namespace {

BakeOptions small()
{
    BakeOptions options;
    options.grid = grid_of(3);
    options.steps = 2, options.samples_a_cell = 2;
    return options;
}

std::vector<std::uint8_t> bytes_of(const BakeOptions& options, int threads)
{
    const Jobs jobs(threads);
    const Result<std::optional<Baked>> baked = bake_table(options, jobs);
    EXPECT_TRUE(baked) << (baked ? "" : baked.error().line());
    return baked && *baked ? table_bytes((*baked)->table) : std::vector<std::uint8_t>();
}

TEST(fit, single_lobes_reach_what_is_known)
{
    // {theta, phi, alpha, lambda} in sevenths, and the L1 error of fits by an independent implementation
    const struct {
        int at[4];
        double l1;
    } known[] = {{{0, 0, 7, 7}, 0.0307}, {{2, 3, 4, 4}, 0.0656}, {{3, 2, 6, 5}, 0.0456},
                 {{5, 3, 4, 2}, 0.3243}, {{6, 5, 3, 1}, 0.5595}, {{6, 4, 7, 2}, 0.2588}};
    const Rule rule(15), white(18);
    for (const auto& k : known) {
        const Place place = {k.at[0] / 14.0 * kPi, k.at[1] / 14.0 * kPi, k.at[2] / 7.0, k.at[3] / 7.0};
        const LobePoints points(normalised_lobe(place, white), rule);
        const NodeFit fit = fit_lobe(points, natural_matrix(place), 0);
        EXPECT_NEAR(fit.l1, k.l1, 0.002) << k.at[0] << k.at[1] << k.at[2] << k.at[3];
        EXPECT_GT(determinant(fit.m), 0.0);
        EXPECT_NEAR(fit.m[2] * fit.m[2] + fit.m[5] * fit.m[5] + fit.m[8] * fit.m[8], 1.0, 1e-12);
    }
}

TEST(fit, the_sliced_distance_leads_near_the_lobe_from_a_plain_start)
{
    const Rule rule(14), white(18);
    const Grid about; // its frame is aligned with the mirror direction
    for (const Place& place : {Place{0.3, 0.4, 0.5, 0.6}, Place{0.8, 1.0, 0.3, 0.4}, Place{1.1, 0.5, 0.6, 0.8}}) {
        const LobePoints points(normalised_lobe(place, white), rule);
        const Matrix plain = about.frame(place) * Matrix{place.alpha, 0.0, 0.0, 0.0, place.alpha * place.lambda, 0.0, 0.0, 0.0, 1.0};
        const NodeFit sliced = fit_sliced(points, plain, 0), best = fit_lobe(points, natural_matrix(place), 0);
        printf("start %.3f, sliced %.3f, best %.3f\n", l1_distance(points, with_unit_axis(plain)), sliced.l1, best.l1);
        EXPECT_LT(sliced.l1, 2.0 * best.l1 + 0.02);
        EXPECT_LT(sliced.l1, 0.6 * l1_distance(points, with_unit_axis(plain)));
        EXPECT_GT(sliced.l1, best.l1 - 1e-3);
        EXPECT_GT(determinant(sliced.m), 0.0);
    }
}

// Returns the mean L1 error in the middle of cells, and the flags that the file stores about its making.
std::pair<double, std::uint32_t> nodes_alone(const std::function<void(BakeOptions&)>& change)
{
    BakeOptions options = small();
    options.grid = grid_of(4), options.steps = 0;
    change(options);
    const Jobs jobs(1);
    const Result<std::optional<Baked>> baked = bake_table(options, jobs);
    EXPECT_TRUE(baked && *baked);
    const std::vector<std::uint8_t> bytes = table_bytes((*baked)->table);
    const Result<Table> read = parse_table(bytes.data(), bytes.size(), "t", 4);
    EXPECT_TRUE(read) << (read ? "" : read.error().line());
    const std::vector<double> l1 = read ? l1_of_cells(*read, jobs) : std::vector<double>{2.0};
    return {spread_of(l1).mean, read ? read->made : 0};
}

TEST(fit, as_others_do_it_is_worse_and_the_file_says_how)
{
    const auto [own, plain] = nodes_alone([](BakeOptions&) {});
    const auto [cubed, l3] = nodes_alone([](BakeOptions& o) { o.norm = Norm::l3; });
    const auto [turned, unaligned] = nodes_alone([](BakeOptions& o) { o.align = false; });
    const auto [apart, unsymmetric] = nodes_alone([](BakeOptions& o) { o.symmetry = false; });
    const auto [inverted, inverse] = nodes_alone(
        [](BakeOptions& o) { o.grid.inverse = true, o.grid.root_alpha = o.grid.over_alpha = false, o.grid.basis = Basis::tangent; });
    printf("own %.4f, l3 %.4f, unaligned %.4f, without symmetry %.4f, inverse %.4f\n", own, cubed, turned, apart, inverted);
    EXPECT_EQ(plain, 0u);
    EXPECT_EQ(l3, 1u << kNormShift);
    EXPECT_EQ(unaligned, kUnaligned);
    EXPECT_EQ(unsymmetric, kUnsymmetric);
    EXPECT_EQ(inverse, 0u); // the grid's default
    EXPECT_GT(cubed, own + 0.01);
    EXPECT_GT(turned, own + 0.03);
    EXPECT_GT(inverted, own + 0.05);
    EXPECT_NEAR(apart, own, 0.02);
}

// Returns the L1 distance between two transformed cosines, by points drawn from both.
double between(const Matrix& a, const Matrix& b)
{
    static const Rule rule(16);
    const Matrix na = inverse(a), nb = inverse(b);
    double sum = 0.0;
    for (const Rule::Point& point : rule.points)
        for (const Matrix& by : {a, b}) {
            const Vec l = unit(by * point.clamped);
            const double p = transformed_cosine(na, l), q = transformed_cosine(nb, l);
            sum += std::abs(p - q) / (p + q) / static_cast<double>(rule.points.size());
        }
    return sum;
}

// Mirrors a table entry as lookups do.
Matrix unfolded(Matrix m, bool swap, double sign_x, double sign_y)
{
    if (swap)
        m = {m[3], m[4], m[5], m[0], m[1], m[2], m[6], m[7], m[8]};
    m = Matrix{sign_x, 0.0, 0.0, 0.0, sign_y, 0.0, 0.0, 0.0, 1.0} * m;
    if (determinant(m) < 0.0)
        m[1] = -m[1], m[4] = -m[4], m[7] = -m[7];
    return m;
}

// Fits lobes that symmetry spares the table: lobes of the other quadrants, lobes wider along y, and both.
TEST(fit, lobes_that_tables_leave_out_are_mirror_images_of_those_that_they_have)
{
    const Rule rule(16), white(18);
    const auto points_of = [&](const Place& p) { return LobePoints(normalised_lobe(p, white), rule); };
    for (const Place& place : {Place{0.5, 1.2, 0.7, 0.2}, Place{0.9, 0.6, 0.4, 0.3}, Place{1.1, 0.3, 0.2, 0.5}}) {
        const Matrix first = fit_lobe(points_of(place), natural_matrix(place), 0).m;
        for (const bool swap : {false, true})
            for (const auto& [sx, sy] : {std::pair{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}}) {
                const double azimuth = swap ? 0.5 * kPi - place.phi : place.phi;
                Place other = place;
                other.phi = std::atan2(sy * std::sin(azimuth), sx * std::cos(azimuth));
                if (swap)
                    other.alpha = place.alpha * place.lambda, other.lambda = 1.0 / place.lambda;
                const LobePoints points = points_of(other);
                const NodeFit own = fit_lobe(points, natural_matrix(other), 0);
                const Matrix folded = unfolded(first, swap, sx, sy);
                EXPECT_LT(between(own.m, folded), 0.04) << swap << sx << sy;
                EXPECT_NEAR(l1_distance(points, folded), own.l1, 2e-3) << swap << sx << sy;
                EXPECT_GT(between(own.m, unfolded(first, swap, -sx, sy)), 0.1) << swap << sx << sy; // the mirror images differ
            }
    }
}

TEST(fit, a_table_without_symmetry_has_it_all_the_same)
{
    BakeOptions options = small();
    options.grid = grid_of(4), options.steps = 0;
    const Jobs jobs(1);
    const Result<std::optional<Baked>> with = bake_table(options, jobs);
    options.symmetry = false;
    const Result<std::optional<Baked>> without = bake_table(options, jobs);
    ASSERT_TRUE(with && *with && without && *without);
    const Grid& grid = options.grid;
    const auto entry = [&](const Baked& baked, std::size_t node) {
        Matrix m;
        for (std::size_t e = 0; e < 9; ++e)
            m[e] = static_cast<double>(baked.table.entries[kChannels * node + e]);
        return grid.shown(m, grid.place(node));
    };
    double mean = 0.0, mirrored = 0.0;
    std::size_t images = 0;
    for (std::size_t node = 0; node < grid.nodes(); ++node) {
        mean += between(entry(**with, node), entry(**without, node)) / static_cast<double>(grid.nodes());
        const std::array<int, 4> i = grid.indices(node);
        if (i[3] != grid.size - 1)
            continue;
        const std::size_t image = grid.node(i[0], grid.size - 1 - i[1], i[2], i[3]); // of one width: seen from beyond the diagonal
        mirrored += between(entry(**without, node), with_axes_exchanged(entry(**without, image)));
        ++images;
    }
    printf("with and without %.4f, mirrored %.4f\n", mean, mirrored / static_cast<double>(images));
    EXPECT_LT(mean, 0.02);
    EXPECT_LT(mirrored / static_cast<double>(images), 0.02);
    EXPECT_GT(mean, 0.0); // else nothing was left out
}

TEST(fit, equations_are_the_derivative)
{
    // Along every element of E the sums' gradient equals that energy's gradient: sum W (p - q)^2 / 2, with the initial weights.
    const Place place = {0.8, 0.5, 0.4, 0.5};
    const Rule rule(15), white(18);
    const LobePoints points(normalised_lobe(place, white), rule);
    const Matrix m = with_unit_axis(natural_matrix(place));
    const Sums sums = sums_of(points, m);
    const auto energy = [&](const Matrix& moved) {
        const Matrix n = inverse(m), n2 = inverse(moved);
        double sum = 0.0;
        const auto add = [&](const Vec& l) {
            const Reflected f = density(points.lobe, l);
            const double q = transformed_cosine(n, l), r = f.reflected - transformed_cosine(n2, l);
            if (!(q > 0.0)) // no step changes its density in the first order
                return;
            sum += 0.5 * r * r / ((f.visible + q) * (std::abs(f.reflected - q) + 0.05 * (f.reflected + q)));
        };
        for (const LobePoints::Point& p : points.points)
            add(p.l);
        for (const Rule::Point& p : rule.points)
            add(unit(m * p.clamped));
        return sum / static_cast<double>(rule.points.size());
    };
    for (std::size_t e = 0; e < 9; ++e) {
        const double h = 1e-5;
        Matrix up = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, down = up;
        up[e] += h, down[e] -= h;
        const double slope = (energy(m * inverse(up)) - energy(m * inverse(down))) / (2.0 * h);
        EXPECT_NEAR(-sums.gradient[e], slope, 2e-3 * std::abs(slope) + 2e-3) << "element " << e;
    }
}

TEST(fit, threads_make_no_difference)
{
    const std::vector<std::uint8_t> one = bytes_of(small(), 1);
    EXPECT_EQ(one, bytes_of(small(), 2));
    EXPECT_EQ(one, bytes_of(small(), 3));
}

TEST(fit, stopped_and_gone_on_with_it_is_the_same)
{
    const std::string path = testing::TempDir() + "ltc_fit_test.part";
    std::filesystem::remove(path);
    const std::vector<std::uint8_t> straight = bytes_of(small(), 1);
    const Jobs jobs(1);
    int stops = 0;
    for (bool done = false; !done;) {
        std::atomic<bool> stop{false}; // set after the first progress: after the nodes, and after each step
        BakeOptions options = small();
        options.checkpoint = path;
        options.stop = &stop;
        options.advance = [&stop](std::size_t units) { stop = units == 1 || units == 64; }; // larger counts report earlier work
        const Result<std::optional<Baked>> baked = bake_table(options, jobs);
        ASSERT_TRUE(baked) << baked.error().line();
        done = baked->has_value();
        if (done) {
            EXPECT_EQ(table_bytes((*baked)->table), straight);
        } else {
            ASSERT_LT(++stops, 10);
        }
    }
    EXPECT_EQ(stops, 3); // after the nodes, and after each of two steps
    // A checkpoint from another table, or a damaged one, is refused.
    BakeOptions other = small();
    other.checkpoint = path, other.steps = 3;
    EXPECT_FALSE(bake_table(other, jobs));
    Result<std::vector<std::uint8_t>> kept = read_file(path, 1u << 30);
    ASSERT_TRUE(kept);
    (*kept)[kept->size() / 2] ^= 1;
    ASSERT_TRUE(write_file_atomic(path, kept->data(), kept->size()));
    other.steps = 2;
    const Result<std::optional<Baked>> damaged = bake_table(other, jobs);
    ASSERT_FALSE(damaged);
    EXPECT_NE(damaged.error().reason.find("damaged"), std::string::npos);
    std::filesystem::remove(path);
}

TEST(fit, a_coarse_table_is_nearer_between_its_nodes_than_its_nodes_alone_make_it)
{
    BakeOptions options;
    options.grid = grid_of(5);
    options.steps = 5, options.samples_a_cell = 4;
    const Jobs jobs;
    const Result<std::optional<Baked>> fitted = bake_table(options, jobs);
    options.steps = 0;
    const Result<std::optional<Baked>> nodes = bake_table(options, jobs);
    ASSERT_TRUE(fitted && nodes && *fitted && *nodes);
    EXPECT_LT((*fitted)->fit_l1, 0.95 * (*fitted)->fit_l1_before);
    const std::vector<Place> places = judged_places(200, 0, 5000);
    const auto mean = [&](const Table& table) {
        std::vector<double> l1;
        for (const Judged& j : judge(table, places, 0, jobs))
            l1.push_back(j.l1);
        return spread_of(l1).mean;
    };
    const double with = mean((*fitted)->table), without = mean((*nodes)->table);
    EXPECT_LT(with, 0.97 * without);
    EXPECT_LT(with, 0.2);
}

} // namespace
} // namespace burnish::ltc
