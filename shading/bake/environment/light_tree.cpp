#include "shading/bake/environment/light_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/check.h"
#include "core/simd/dispatch.h"

namespace burnish {
namespace {

Direction normalized(const Direction& d)
{
    const double scale = 1.0 / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    return {d.x * scale, d.y * scale, d.z * scale};
}

Direction centre_of(int face, int size, int x, int y)
{
    const double step = 2.0 / size;
    return normalized(cube_direction(face, (x + 0.5) * step - 1.0, (y + 0.5) * step - 1.0));
}

double brightness(const float* rgb)
{
    return static_cast<double>(rgb[0]) + static_cast<double>(rgb[1]) + static_cast<double>(rgb[2]);
}

// Wide lobes still have weight at the horizon, where n.l has an edge. Pieces are then limited to their size at this distance, for a lobe
// with width 1.
constexpr double kWidest = 0.3;

// Returns the quads along a face's edge. A face with one texel belongs to a quad.
std::size_t quads_along(int size)
{
    return static_cast<std::size_t>(std::max(size / 2, 1));
}

// Returns where texel (x, y) in a level stands among its face's quads.
std::size_t place_in_quads(int size, int x, int y)
{
    const std::size_t quad = static_cast<std::size_t>(y / 2) * quads_along(size) + static_cast<std::size_t>(x / 2);
    return quad * 4 + static_cast<std::size_t>(y % 2 * 2 + x % 2);
}

// Returns the index for a texel's x among a level's places. Its y and z stand 4 and 8 numbers behind.
std::size_t index_of_place(int size, int face, int x, int y)
{
    const std::size_t at = place_in_quads(size, x, y);
    return (static_cast<std::size_t>(face) * quads_along(size) * quads_along(size) + at / 4) * 12 + at % 4;
}

Direction place_of(const LightTree& tree, int level, int face, int x, int y)
{
    const int size = tree.boxes[static_cast<std::size_t>(level)].size;
    if (level == 0)
        return centre_of(face, size, x, y);
    const float* p = tree.places[static_cast<std::size_t>(level)].data() + index_of_place(size, face, x, y);
    return {static_cast<double>(p[0]), static_cast<double>(p[4]), static_cast<double>(p[8])};
}

// Returns the mean direction to a texel's light, from the finer level. Without light, solid angle weighs.
Direction mean_place(const LightTree& tree, int level, int face, int x, int y)
{
    const CubeLevel& fine = tree.boxes[static_cast<std::size_t>(level - 1)];
    Direction lit = {0.0, 0.0, 0.0}, all = {0.0, 0.0, 0.0};
    double light = 0.0;
    for (int k = 0; k < 4; ++k) {
        const int part_x = 2 * x + k % 2, part_y = 2 * y + k / 2;
        const std::size_t at = static_cast<std::size_t>(part_y) * static_cast<std::size_t>(fine.size) + static_cast<std::size_t>(part_x);
        const Direction d = place_of(tree, level - 1, face, part_x, part_y);
        const double angle = fine.solid_angle[at];
        const double w = angle * brightness(fine.rgb.data() + (static_cast<std::size_t>(face) * fine.solid_angle.size() + at) * 3);
        lit = {lit.x + w * d.x, lit.y + w * d.y, lit.z + w * d.z};
        all = {all.x + angle * d.x, all.y + angle * d.y, all.z + angle * d.z};
        light += w;
    }
    return normalized(light > 0.0 ? lit : all);
}

std::vector<float> places_of(const LightTree& tree, int level, const Jobs& jobs)
{
    const int size = tree.boxes[static_cast<std::size_t>(level)].size;
    std::vector<float> places(6 * quads_along(size) * quads_along(size) * 12);
    jobs.parallel_for(6 * static_cast<std::size_t>(size), [&](std::size_t row, int) {
        const int face = static_cast<int>(row) / size, y = static_cast<int>(row) % size;
        for (int x = 0; x < size; ++x) {
            const Direction place = level == 0 ? centre_of(face, size, x, y) : mean_place(tree, level, face, x, y);
            float* to = places.data() + index_of_place(size, face, x, y);
            to[0] = static_cast<float>(place.x), to[4] = static_cast<float>(place.y), to[8] = static_cast<float>(place.z);
        }
    });
    return places;
}

} // namespace

LightTree make_light_tree(const std::vector<CubeLevel>& boxes, const Jobs& jobs, int most_placed)
{
    LightTree tree = {boxes, {}, {}};
    for (int level = 0; level < static_cast<int>(boxes.size()); ++level) {
        const CubeLevel& box = boxes[static_cast<std::size_t>(level)];
        std::vector<double>& angles = tree.angles.emplace_back(quads_along(box.size) * quads_along(box.size) * 4);
        for (int y = 0; y < box.size; ++y)
            for (int x = 0; x < box.size; ++x)
                angles[place_in_quads(box.size, x, y)] = box.solid_angle[static_cast<std::size_t>(y * box.size + x)];
        const bool placed = level > 0 || box.size <= most_placed;
        tree.places.push_back(placed ? places_of(tree, level, jobs) : std::vector<float>());
    }
    return tree;
}

std::vector<LightLevel> LightTree::levels() const
{
    std::vector<LightLevel> found;
    for (std::size_t l = 0; l < angles.size(); ++l)
        found.push_back({boxes[l].size, angles[l].data(), places[l].empty() ? nullptr : places[l].data(), boxes[l].rgb.data()});
    return found;
}

namespace {

// A block's circle; chords stand for angles.
struct Circle {
    Direction centre; // unit
    double radius;
};

double chord(const Direction& a, const Direction& b)
{
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

Circle circle_of(const BlockSquare& square, int x, int y)
{
    const double u0 = square.u0 + x * square.side, v0 = square.v0 + y * square.side, u1 = u0 + square.side, v1 = v0 + square.side;
    Circle circle = {normalized(cube_direction(square.face, 0.5 * (u0 + u1), 0.5 * (v0 + v1))), 0.0};
    for (int k = 0; k < 4; ++k)
        circle.radius =
            std::max(circle.radius, chord(normalized(cube_direction(square.face, k % 2 ? u1 : u0, k / 2 ? v1 : v0)), circle.centre));
    return circle;
}

GatherList list_of(GatherScratch::List& memory)
{
    return {memory.terms.data(), memory.marks.data(), 0, 0, static_cast<int>(memory.terms.size()), static_cast<int>(memory.marks.size())};
}

struct Gathering {
    const BlockSquare& square;
    std::vector<Circle> circles; // by block
    GatherInput input;           // without circle
    GatherScratch& scratch;
    const std::function<void(int, int, std::span<const PrefilterTerm>)>& use;
    const LightTreeFns& fns;

    // Gathers for the blocks [x, x + along) x [y, y + along) from a larger square's list.
    void gather(int x, int y, int along, std::size_t depth, const GatherList& from)
    {
        // Bound the blocks' circles
        const auto at = [&](int i, int j) -> const Circle& { return circles[static_cast<std::size_t>(j * square.along + i)]; };
        Circle all = at(x, y);
        GatherInput in = input;
        in.nearer = in.farther = all.radius;
        if (along > 1) {
            constexpr double kRounding = 1e-9; // far above the distances' rounding
            const double half = 0.5 * along;
            all.centre =
                normalized(cube_direction(square.face, square.u0 + (x + half) * square.side, square.v0 + (y + half) * square.side));
            double reach = 0.0, least = all.radius, most = all.radius;
            for (int j = y; j < y + along; ++j)
                for (int i = x; i < x + along; ++i) {
                    const Circle& c = at(i, j);
                    reach = std::max(reach, chord(c.centre, all.centre));
                    least = std::min(least, c.radius), most = std::max(most, c.radius);
                }
            in.nearer = most + reach + kRounding, in.farther = least - reach - kRounding;
        }
        in.centre[0] = all.centre.x, in.centre[1] = all.centre.y, in.centre[2] = all.centre.z;
        // Gather, with more memory where the terms are too many
        GatherScratch::List& memory = scratch.lists[depth];
        GatherList to = list_of(memory);
        while (!fns.gather(in, from, to)) {
            memory.terms.resize(memory.terms.size() * 2), memory.marks.resize(memory.marks.size() * 2);
            to = list_of(memory);
        }
        if (along == 1) {
            use(x, y, {to.terms, static_cast<std::size_t>(to.term_count)});
            return;
        }
        for (int k = 0; k < 4; ++k)
            gather(x + k % 2 * along / 2, y + k / 2 * along / 2, along / 2, depth + 1, to);
    }
};

} // namespace

void gather_terms(const std::vector<LightLevel>& levels, const BlockSquare& square, double alpha, double opening, GatherScratch& scratch,
                  const std::function<void(int, int, std::span<const PrefilterTerm>)>& use, const LightTreeFns& fns)
{
    BN_CHECK(std::has_single_bit(static_cast<unsigned>(square.along)));
    BN_CHECK_OP(levels.size(), <, std::size_t{kMostLightLevels});
    // A lobe is twice as wide about the mirrored direction as in half vectors
    const double width2 = 4.0 * alpha * alpha, farthest = kWidest / alpha;
    Gathering gathering = {square, {}, {levels.data(), {}, 0.0, 0.0, width2, opening * opening, farthest * farthest}, scratch, use, fns};
    for (int y = 0; y < square.along; ++y)
        for (int x = 0; x < square.along; ++x)
            gathering.circles.push_back(circle_of(square, x, y));
    scratch.lists.resize(std::max(scratch.lists.size(), static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(square.along)))),
                         {std::vector<PrefilterTerm>(2048), std::vector<GatherMark>(1024)});
    GatherMark faces[6];
    for (int face = 0; face < 6; ++face)
        faces[face] = {0, face, static_cast<int>(levels.size()), 0, 0, 0, 4}; // the one part is the face
    gathering.gather(0, 0, square.along, 0, {nullptr, faces, 0, 6, 0, 6});
}

} // namespace burnish
