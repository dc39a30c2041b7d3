#include "shading/bake/environment/light_tree.h"

#include <algorithm>
#include <cmath>

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
// of width 1.
constexpr double kWidest = 0.3;

// A texel in a level of the tree.
struct TreeNode {
    int level, x, y;
};

Direction place_of(const LightTree& tree, int face, const TreeNode& node)
{
    const int size = tree.boxes[static_cast<std::size_t>(node.level)].size;
    if (node.level == 0)
        return centre_of(face, size, node.x, node.y);
    const std::size_t texel = (static_cast<std::size_t>(face) * static_cast<std::size_t>(size) + static_cast<std::size_t>(node.y)) *
                                  static_cast<std::size_t>(size) +
                              static_cast<std::size_t>(node.x);
    const float* p = tree.places[static_cast<std::size_t>(node.level)].data() + 3 * texel;
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

// Returns the places of a level's texels: means over the finer level's places, weighted by light, or by solid angle where there is no
// light.
std::vector<float> places_of(const LightTree& tree, int level, const Jobs& jobs)
{
    const CubeLevel& fine = tree.boxes[static_cast<std::size_t>(level - 1)];
    const int size = fine.size / 2;
    std::vector<float> places(cube_texels(size) * 3);
    jobs.parallel_for(6 * static_cast<std::size_t>(size), [&](std::size_t row, int) {
        const int face = static_cast<int>(row) / size, y = static_cast<int>(row) % size;
        float* to = places.data() + row * static_cast<std::size_t>(size) * 3;
        for (int x = 0; x < size; ++x, to += 3) {
            Direction lit = {0.0, 0.0, 0.0}, all = {0.0, 0.0, 0.0};
            double light = 0.0;
            for (int k = 0; k < 4; ++k) {
                const TreeNode child = {level - 1, 2 * x + k % 2, 2 * y + k / 2};
                const std::size_t at =
                    static_cast<std::size_t>(child.y) * static_cast<std::size_t>(fine.size) + static_cast<std::size_t>(child.x);
                const Direction d = place_of(tree, face, child);
                const double angle = fine.solid_angle[at];
                const double w = angle * brightness(fine.rgb.data() + (static_cast<std::size_t>(face) * fine.solid_angle.size() + at) * 3);
                lit = {lit.x + w * d.x, lit.y + w * d.y, lit.z + w * d.z};
                all = {all.x + angle * d.x, all.y + angle * d.y, all.z + angle * d.z};
                light += w;
            }
            const Direction place = normalized(light > 0.0 ? lit : all);
            to[0] = static_cast<float>(place.x), to[1] = static_cast<float>(place.y), to[2] = static_cast<float>(place.z);
        }
    });
    return places;
}

} // namespace

LightTree make_light_tree(const std::vector<CubeLevel>& boxes, const Jobs& jobs)
{
    LightTree tree = {boxes, {}};
    tree.places.emplace_back();
    for (int level = 1; level < static_cast<int>(boxes.size()); ++level)
        tree.places.push_back(places_of(tree, level, jobs));
    return tree;
}

void gather_terms(const LightTree& tree, const PrefilterBlock& block, double alpha, double opening, std::vector<PrefilterTerm>& terms)
{
    terms.clear();
    // Bound the block by a circle
    const Direction centre = normalized(cube_direction(block.face, 0.5 * (block.u0 + block.u1), 0.5 * (block.v0 + block.v1)));
    double radius = 0.0; // chords stand for angles throughout
    for (int k = 0; k < 4; ++k) {
        const Direction d = normalized(cube_direction(block.face, k % 2 ? block.u1 : block.u0, k / 2 ? block.v1 : block.v0));
        radius = std::max(radius, std::hypot(d.x - centre.x, d.y - centre.y, d.z - centre.z));
    }
    const double width2 = 4.0 * alpha * alpha; // a lobe is twice as wide about the mirrored direction as in half vectors
    const double opening2 = opening * opening, farthest = kWidest / alpha;
    constexpr double kHorizon = 1.41421356237309505; // chord of a quarter turn
    // Walk the tree of each face, depth first
    struct Seen {
        TreeNode node;
        Direction place;
        std::size_t at; // index in its face
        double angle, distance;
        bool opens;
    };
    std::vector<Seen> waiting; // a stack
    for (int face = 0; face < 6; ++face) {
        const auto seen = [&](const TreeNode& node) {
            const CubeLevel& box = tree.boxes[static_cast<std::size_t>(node.level)];
            Seen s;
            s.node = node;
            s.at = static_cast<std::size_t>(node.y) * static_cast<std::size_t>(box.size) + static_cast<std::size_t>(node.x);
            s.angle = box.solid_angle[s.at];
            s.place = place_of(tree, face, node);
            const double dx = s.place.x - centre.x, dy = s.place.y - centre.y, dz = s.place.z - centre.z;
            s.distance = std::max(std::sqrt(dx * dx + dy * dy + dz * dz) - radius, 0.0);
            s.opens = node.level > 0 && s.angle > opening2 * std::min(s.distance * s.distance + width2, farthest * farthest);
            return s;
        };
        const auto take = [&](const Seen& s) {
            if (s.distance >= kHorizon)
                return;
            const CubeLevel& box = tree.boxes[static_cast<std::size_t>(s.node.level)];
            const float* rgb = box.rgb.data() + (static_cast<std::size_t>(face) * box.solid_angle.size() + s.at) * 3;
            const float w = static_cast<float>(s.angle);
            terms.push_back({static_cast<float>(s.place.x), static_cast<float>(s.place.y), static_cast<float>(s.place.z), w, rgb[0] * w,
                             rgb[1] * w, rgb[2] * w});
        };
        waiting.assign(1, seen({static_cast<int>(tree.boxes.size()) - 1, 0, 0}));
        while (!waiting.empty()) {
            const Seen s = waiting.back();
            waiting.pop_back();
            if (!s.opens) {
                take(s);
                continue;
            }
            Seen parts[4]; // computed together, because their square roots are slow
            for (int k = 0; k < 4; ++k)
                parts[k] = seen({s.node.level - 1, 2 * s.node.x + k % 2, 2 * s.node.y + k / 2});
            int first = 0;
            for (; first < 4 && !parts[first].opens; ++first)
                take(parts[first]);
            for (int k = 3; k >= first; --k)
                waiting.push_back(parts[k]);
        }
    }
}

} // namespace burnish
