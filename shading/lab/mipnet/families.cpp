#include "shading/lab/mipnet/families.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/hash.h"
#include "core/math/scalar_math.h"
#include "shading/bake/mipnet/net.h"

namespace burnish::mipnet {
namespace {

// Heights on a torus of side x side texels, in texels.
struct HeightField {
    int side;
    Random& random;
    std::vector<double> height;
    double& at(int x, int y)
    {
        const int mask = side - 1;
        if ((side & mask) == 0)
            return height[static_cast<std::size_t>(y & mask) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x & mask)];
        const int px = (x % side + side) % side, py = (y % side + side) % side;
        return height[static_cast<std::size_t>(py) * static_cast<std::size_t>(side) + static_cast<std::size_t>(px)];
    }
    template <class Height> void each(const Height& h)
    {
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                at(x, y) = h(x, y);
    }
};

double lattice(std::uint64_t salt, int x, int y)
{
    return Random(salt + static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) * 0x9e3779b1u +
                  (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 33))
        .unit();
}

int wrapped(int i, int period)
{
    return (i % period + period) % period;
}

// Returns smooth noise in [0,1] on a lattice with px x py nodes around the torus.
double noise(std::uint64_t salt, double x, double y, int px, int py)
{
    const double fx = std::floor(x), fy = std::floor(y), u = x - fx, v = y - fy;
    const double su = u * u * (3.0 - 2.0 * u), sv = v * v * (3.0 - 2.0 * v);
    const int x0 = wrapped(static_cast<int>(fx), px), y0 = wrapped(static_cast<int>(fy), py), x1 = wrapped(x0 + 1, px),
              y1 = wrapped(y0 + 1, py);
    const double low = lattice(salt, x0, y0) * (1.0 - su) + lattice(salt, x1, y0) * su,
                 high = lattice(salt, x0, y1) * (1.0 - su) + lattice(salt, x1, y1) * su;
    return low * (1.0 - sv) + high * sv;
}

double noise_of_cells(std::uint64_t salt, int side, double x, double y, double cell_x, double cell_y)
{
    const int px = std::max(1, static_cast<int>(side / cell_x + 0.5)), py = std::max(1, static_cast<int>(side / cell_y + 0.5));
    return noise(salt, x * px / side, y * py / side, px, py);
}

// Distances to the nearest and second nearest point, with points scattered one per cell, in cells. which: the nearest one's index.
struct Nearest {
    double first = 9.0, second = 9.0, dx = 0.0, dy = 0.0;
    std::uint64_t which = 0;
};
Nearest nearest_point(std::uint64_t salt, int side, double x, double y, double cell)
{
    const int n = std::max(2, static_cast<int>(side / cell + 0.5));
    const double u = x * n / side, v = y * n / side;
    const int cx = static_cast<int>(std::floor(u)), cy = static_cast<int>(std::floor(v));
    Nearest near;
    for (int j = cy - 1; j <= cy + 1; ++j)
        for (int i = cx - 1; i <= cx + 1; ++i) {
            const int wi = wrapped(i, n), wj = wrapped(j, n);
            const double dx = u - (i + lattice(salt, wi, wj)), dy = v - (j + lattice(salt + 1, wi, wj)), d = std::sqrt(dx * dx + dy * dy);
            if (d < near.first) {
                near.second = near.first, near.first = d, near.dx = dx, near.dy = dy;
                near.which = static_cast<std::uint64_t>(wj) * static_cast<std::uint64_t>(n) + static_cast<std::uint64_t>(wi);
            } else if (d < near.second) {
                near.second = d;
            }
        }
    return near;
}

double wave(double x) // with period 1
{
    return det_sin(2.0 * kPi * (x - std::floor(x)));
}
double triangle(double x) // with period 1, 0 to 1
{
    return std::fabs(2.0 * (x - std::floor(x)) - 1.0);
}
int count_of(Random& random, int side, double least, double most) // number of features around the torus, each least to most texels wide
{
    return std::max(1, static_cast<int>(side / random.between(least, most) + 0.5));
}

void hammered(HeightField& heights)
{
    const double cell = heights.random.between(6.0, 24.0);
    const std::uint64_t salt = heights.random.bits();
    heights.each([&](int x, int y) {
        const double d = nearest_point(salt, heights.side, x, y, cell).first;
        return std::min(d * d, 0.5);
    });
}
void brushed(HeightField& heights)
{
    const double length = heights.random.between(24.0, 64.0), width = heights.random.between(1.0, 4.0);
    const std::uint64_t salt = heights.random.bits();
    heights.each([&](int x, int y) {
        return noise_of_cells(salt, heights.side, x, y, length, width) +
               0.5 * noise_of_cells(salt + 7, heights.side, x, y, 0.5 * length, 2.0 * width);
    });
}
void woven(HeightField& heights)
{
    const int n = 2 * count_of(heights.random, heights.side, 8.0, 32.0);
    heights.each([&](int x, int y) {
        const double u = static_cast<double>(x) * n / heights.side, v = static_cast<double>(y) * n / heights.side;
        const bool over = ((static_cast<int>(u) + static_cast<int>(v)) & 1) != 0;
        const double a = std::fabs(wave(0.5 * u)), b = std::fabs(wave(0.5 * v));
        return over ? a * (0.5 + 0.5 * b) : b * (0.5 + 0.5 * a);
    });
}
void fbm(HeightField& heights)
{
    const double cell = heights.random.between(8.0, 48.0), decay = heights.random.between(0.35, 0.65);
    const std::uint64_t salt = heights.random.bits();
    heights.each([&](int x, int y) {
        double h = 0.0, weight = 1.0, size = cell;
        for (int octave = 0; octave < 5 && size >= 1.5; ++octave, weight *= decay, size *= 0.5)
            h += weight * noise_of_cells(salt + 11u * static_cast<unsigned>(octave), heights.side, x, y, size, size);
        return h;
    });
}
void tiles(HeightField& heights)
{
    const int n = count_of(heights.random, heights.side, 12.0, 40.0);
    const double edge = heights.random.between(0.05, 0.2), lean = heights.random.between(0.0, 0.6);
    const std::uint64_t salt = heights.random.bits();
    heights.each([&](int x, int y) {
        const double u = static_cast<double>(x) * n / heights.side, v = static_cast<double>(y) * n / heights.side;
        const int i = static_cast<int>(u), j = static_cast<int>(v);
        const double fu = u - i, fv = v - j, inside = std::min(std::min(fu, 1.0 - fu), std::min(fv, 1.0 - fv));
        return std::min(inside / edge, 1.0) * 0.3 + lean * ((lattice(salt, i, j) - 0.5) * fu + (lattice(salt + 1, i, j) - 0.5) * fv);
    });
}
void studs(HeightField& heights)
{
    const int n = count_of(heights.random, heights.side, 8.0, 28.0);
    const double radius = heights.random.between(0.25, 0.48);
    heights.each([&](int x, int y) {
        const double u = static_cast<double>(x) * n / heights.side, v = static_cast<double>(y) * n / heights.side;
        const double du = u - std::floor(u) - 0.5, dv = v - std::floor(v) - 0.5, d2 = (du * du + dv * dv) / (radius * radius);
        return std::sqrt(std::max(1.0 - d2, 0.0));
    });
}
void waves(HeightField& heights)
{
    struct Wave {
        int kx, ky;
        double phase, height;
    } all[5];
    for (Wave& w : all) {
        const double angle = heights.random.between(0.0, 2.0 * kPi), n = heights.side / heights.random.between(5.0, 40.0);
        w = {static_cast<int>(std::floor(n * det_cos(angle) + 0.5)), static_cast<int>(std::floor(n * det_sin(angle) + 0.5)),
             heights.random.unit(), 1.0 / n};
    }
    const int count = 1 + heights.random.below(5);
    heights.each([&](int x, int y) {
        double h = 0.0;
        for (int k = 0; k < count; ++k)
            h += all[k].height * wave(static_cast<double>(all[k].kx * x + all[k].ky * y) / heights.side + all[k].phase);
        return h;
    });
}
void leather(HeightField& heights)
{
    const double cell = heights.random.between(5.0, 16.0), crack = heights.random.between(0.15, 0.5);
    const std::uint64_t salt = heights.random.bits();
    heights.each([&](int x, int y) {
        const Nearest near = nearest_point(salt, heights.side, x, y, cell);
        return std::min((near.second - near.first) / crack, 1.0) + 0.3 * noise_of_cells(salt + 5, heights.side, x, y, 4.0, 4.0);
    });
}

void scratches(HeightField& heights)
{
    const int count = heights.side * heights.side / (400 + heights.random.below(1200));
    const double main_angle = heights.random.between(0.0, kPi), spread = heights.random.between(0.1, 1.6);
    for (int k = 0; k < count; ++k) {
        const double angle = main_angle + spread * (heights.random.unit() - 0.5), length = heights.random.between(10.0, 80.0),
                     depth = heights.random.between(0.2, 1.0), half = heights.random.between(0.6, 1.6);
        const double c = det_cos(angle), s = det_sin(angle), x0 = heights.random.between(0.0, heights.side),
                     y0 = heights.random.between(0.0, heights.side);
        for (double t = 0.0; t < length; t += 0.5) {
            const int px = static_cast<int>(std::floor(x0 + t * c)), py = static_cast<int>(std::floor(y0 + t * s));
            for (int j = -2; j <= 2; ++j)
                for (int i = -2; i <= 2; ++i) {
                    const double across = std::fabs((px + i - x0) * s - (py + j - y0) * c);
                    double& h = heights.at(px + i, py + j);
                    h = std::min(h, -depth * std::max(1.0 - across / half, 0.0));
                }
        }
    }
}
void knurl(HeightField& heights)
{
    const int n = count_of(heights.random, heights.side, 6.0, 24.0), m = heights.random.below(2) ? n : std::max(1, n / 2);
    const double sharp = heights.random.between(0.5, 1.0);
    heights.each([&](int x, int y) {
        const double u = static_cast<double>(n * x + m * y) / heights.side, v = static_cast<double>(n * x - m * y) / heights.side;
        return std::min(triangle(u), sharp) + std::min(triangle(v), sharp);
    });
}
void facets(HeightField& heights)
{
    const double cell = heights.random.between(6.0, 28.0);
    const std::uint64_t salt = heights.random.bits();
    heights.each([&](int x, int y) {
        const Nearest near = nearest_point(salt, heights.side, x, y, cell);
        const int which = static_cast<int>(near.which);
        return (lattice(salt + 2, which, 0) - 0.5) * near.dx + (lattice(salt + 3, which, 0) - 0.5) * near.dy;
    });
}
void twill(HeightField& heights)
{
    const int n = 4 * count_of(heights.random, heights.side, 16.0, 48.0);
    const double thread = heights.random.between(0.3, 1.0);
    heights.each([&](int x, int y) {
        const double u = static_cast<double>(x) * n / heights.side, v = static_cast<double>(y) * n / heights.side;
        const double step = (u + std::floor(v)) * 0.25, phase = step - std::floor(step);
        return std::fabs(wave(0.5 * phase)) + thread * 0.25 * std::fabs(wave(0.5 * v));
    });
}
void zigzag(HeightField& heights)
{
    const int n = count_of(heights.random, heights.side, 5.0, 20.0), m = count_of(heights.random, heights.side, 16.0, 64.0);
    const double bend = heights.random.between(0.5, 2.0);
    heights.each([&](int x, int y) {
        const double v = static_cast<double>(y) * n / heights.side + bend * triangle(static_cast<double>(x) * m / heights.side);
        return triangle(v);
    });
}

struct FamilyRow {
    Family family;
    void (*make)(HeightField&);
};
constexpr FamilyRow kFamilyRows[] = {
    {{"hammered", false}, hammered},  {{"brushed", false}, brushed}, {{"woven", false}, woven},  {{"fbm", false}, fbm},
    {{"tiles", false}, tiles},        {{"studs", false}, studs},     {{"waves", false}, waves},  {{"leather", false}, leather},
    {{"scratches", true}, scratches}, {{"knurl", true}, knurl},      {{"facets", true}, facets}, {{"twill", true}, twill},
    {{"zigzag", true}, zigzag},
};

// Writes normals of heights, scaled to slopes with root mean square `rms`.
void put_normals(HeightField& heights, double rms, Texels& to)
{
    std::vector<double> sx(to.count()), sy(to.count());
    double sum = 0.0;
    for (int y = 0; y < heights.side; ++y)
        for (int x = 0; x < heights.side; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(heights.side) + static_cast<std::size_t>(x);
            sx[i] = 0.5 * (heights.at(x + 1, y) - heights.at(x - 1, y)), sy[i] = 0.5 * (heights.at(x, y + 1) - heights.at(x, y - 1));
            sum += 0.5 * (sx[i] * sx[i] + sy[i] * sy[i]);
        }
    const double scale = rms / std::sqrt(std::max(sum / static_cast<double>(to.count()), 1e-12));
    for (std::size_t i = 0; i < to.count(); ++i) {
        const double x = -scale * sx[i], y = -scale * sy[i], inverse = 1.0 / std::sqrt(1.0 + x * x + y * y);
        to.channel[0][i] = static_cast<float>(x * inverse), to.channel[1][i] = static_cast<float>(y * inverse);
    }
}

// Writes widths: random roughness, variation and grain.
void put_widths(int side, Random& random, Texels& to)
{
    const double roughness = random.between(0.12, 0.75), alpha = roughness * roughness,
                 vary = random.below(2) ? random.between(0.0, 0.6) : 0.0;
    const bool anisotropic = random.unit() < 0.4, turning = random.below(2) == 1;
    const double eta = anisotropic ? random.between(0.3, 0.9) : 0.0, angle = random.between(0.0, kPi), turns = random.between(0.3, 1.5);
    const double cell = random.between(4.0, 32.0);
    const std::uint64_t salt = random.bits();
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
            const double width = alpha * (1.0 + vary * (2.0 * noise_of_cells(salt, side, x, y, cell, cell) - 1.0));
            const double turned =
                turning ? angle + turns * (2.0 * noise_of_cells(salt + 3, side, x, y, 2.0 * cell, 2.0 * cell) - 1.0) : angle;
            const Tensor t = tensor_of(width * (1.0 + eta), width * (1.0 - eta), turned);
            to.channel[2][i] = static_cast<float>(t.a), to.channel[3][i] = static_cast<float>(t.b),
            to.channel[4][i] = static_cast<float>(t.c);
        }
}

struct Wanted {
    const Family* family;
    std::uint64_t seed;
};
std::vector<Wanted> wanted(std::uint64_t first_seed, int held_out, int trained)
{
    std::vector<Wanted> list;
    for (const FamilyRow& row : kFamilyRows)
        for (int k = 0; k < (row.family.held_out ? held_out : trained); ++k)
            list.push_back({&row.family, first_seed + static_cast<std::uint64_t>(k)});
    return list;
}

std::vector<Material> made(const std::vector<Wanted>& list, int side, const Jobs& jobs)
{
    std::vector<Material> materials(list.size());
    jobs.parallel_for(list.size(), [&](std::size_t i, int) { materials[i] = make_material(*list[i].family, list[i].seed, side); });
    return materials;
}

std::vector<TestMaterial> judged(const std::vector<Wanted>& list, const Jobs& jobs)
{
    std::vector<TestMaterial> set;
    std::vector<Material> materials = made(list, 256, jobs);
    for (std::size_t i = 0; i < list.size(); ++i)
        set.push_back({std::move(materials[i]), list[i].family->held_out ? "held-out" : "new seeds"});
    return set;
}

} // namespace

const std::vector<Family>& families()
{
    static const std::vector<Family> all = [] {
        std::vector<Family> list;
        for (const FamilyRow& row : kFamilyRows)
            list.push_back(row.family);
        return list;
    }();
    return all;
}

std::string trained_families()
{
    std::string names;
    for (const Family& f : families())
        if (!f.held_out)
            names += (names.empty() ? "" : ", ") + std::string(f.name);
    return names;
}

Material make_material(const Family& family, std::uint64_t seed, int side)
{
    BN_CHECK(side >= 64 && side % 64 == 0);
    const std::string name = family.name;
    Random random(hash_bytes(name.data(), name.size(), seed));
    const auto row =
        std::find_if(std::begin(kFamilyRows), std::end(kFamilyRows), [&](const FamilyRow& r) { return name == r.family.name; });
    BN_CHECK(row != std::end(kFamilyRows));
    Material m = {name + " " + std::to_string(seed), make_texels(side, side), false};
    const double rms = 0.06 * det_pow(0.7 / 0.06, random.unit());
    HeightField heights = {side, random, std::vector<double>(m.texels.count(), 0.0)};
    row->make(heights);
    put_normals(heights, rms, m.texels);
    put_widths(side, random, m.texels);
    m.metal = random.below(2) == 1;
    make_valid(m.texels);
    return m;
}

TrainingSet make_training_set(int seeds, int side, const Jobs& jobs)
{
    TrainingSet set;
    for (const Material& m : made(wanted(0, 0, seeds), side, jobs))
        add_material(set, m);
    return set;
}

void add_material(TrainingSet& set, const Material& m)
{
    for (const std::vector<float>& channel : m.texels.channel)
        set.hash = hash_bytes(channel.data(), channel.size() * sizeof(float), set.hash);
    set.materials.push_back(m);
}

std::vector<TestMaterial> make_test_set(const Jobs& jobs)
{
    return judged(wanted(kTestSeeds, 5, 2), jobs);
}

std::vector<TestMaterial> make_trained_set(const Jobs& jobs)
{
    std::vector<TestMaterial> set;
    for (Material& m : made(wanted(0, 0, 2), kTrainedSide, jobs))
        set.push_back({std::move(m), "trained"});
    return set;
}

std::vector<TestMaterial> make_crossed_set()
{
    constexpr int kSide = 128;
    struct Crossed {
        const char* name;
        double narrow, wide, lean; // widths across and along the grain; largest sine of normals that lean across it
        int cell;                  // texels with one direction, along a side; 1: random per texel
    };
    std::vector<TestMaterial> set;
    for (const Crossed& c : {Crossed{"crossed grain", 0.06, 0.5, 0.0, 1}, Crossed{"crossed weave", 0.06, 0.4, 0.0, 2},
                             Crossed{"crossed scratches", 0.08, 0.08, 0.3, 1}, Crossed{"crossed ridges", 0.12, 0.12, 0.4, 2}}) {
        const std::string name = c.name;
        Random random(hash_bytes(name.data(), name.size(), 1));
        TestMaterial m = {{name, make_texels(kSide, kSide), true}, "crossed"};
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const bool along_y = c.cell == 1 ? random.below(2) == 1 : (x / c.cell + y / c.cell) % 2 == 1;
                const double lean = c.lean * random.between(-1.0, 1.0);
                const Tensor t = tensor_of(c.wide, c.narrow, along_y ? 0.5 * kPi : 0.0);
                const double of[kChannels] = {along_y ? 0.0 : lean, along_y ? lean : 0.0, t.a, t.b, t.c};
                for (std::size_t k = 0; k < kChannels; ++k)
                    m.material.texels.channel[k][static_cast<std::size_t>(y * kSide + x)] = static_cast<float>(of[k]);
            }
        make_valid(m.material.texels);
        set.push_back(std::move(m));
    }
    return set;
}

std::vector<TestMaterial> make_validation_set(const Jobs& jobs)
{
    return judged(wanted(kValidationSeeds, 0, 2), jobs);
}

} // namespace burnish::mipnet
