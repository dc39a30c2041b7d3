#include "raster/rays/ray_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace burnish {
namespace {

constexpr int kBins = 16;
constexpr int kHeuristicLevels = 56;          // below, halves by count bound the depth
constexpr std::size_t kLeastTriangles = 4096; // of a subtree that a thread builds alone
constexpr float kWidenBounds = 0x1p-21f;      // of the coordinate
static_assert(kHeuristicLevels + 32 < kDeepestTree, "halves of 2^32 triangles end");
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Box {
    glm::vec3 low{kInfinity}, high{-kInfinity};
    void add(const glm::vec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
    void add(const Box& b) { low = glm::min(low, b.low), high = glm::max(high, b.high); }
    // Returns half the surface, in double, since coordinates may be large.
    double area() const
    {
        const glm::dvec3 d = glm::dvec3(high) - glm::dvec3(low);
        return d.x < 0.0 ? 0.0 : d.x * d.y + d.y * d.z + d.z * d.x;
    }
};

struct Item { // a triangle during the build
    Box box;
    glm::vec3 middle;
    std::uint32_t at; // in the caller's list
};

struct Range {
    std::size_t begin, end;
    std::size_t size() const { return end - begin; }
};

struct Split {
    std::size_t middle;
    int axis;
};

Box box_of(const std::vector<Item>& items, Range range)
{
    Box box;
    for (std::size_t i = range.begin; i < range.end; ++i)
        box.add(items[i].box);
    return box;
}

int longest_axis(const Box& box)
{
    const glm::vec3 d = box.high - box.low;
    return d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
}

// Divides a range in halves by count.
Split halve(std::vector<Item>& items, Range range, int axis)
{
    const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t middle = range.begin + range.size() / 2;
    std::nth_element(at(range.begin), at(middle), at(range.end), [axis](const Item& a, const Item& b) {
        return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis] : a.at < b.at;
    });
    return {middle, axis};
}

// Divides a range where the surface area heuristic is least.
Split divide(std::vector<Item>& items, Range range, int level)
{
    Box middles;
    for (std::size_t i = range.begin; i < range.end; ++i)
        middles.add(items[i].middle);
    const int longest = longest_axis(middles);
    if (level >= kHeuristicLevels || !(middles.high[longest] > middles.low[longest]))
        return halve(items, range, longest);
    // Sort triangles into bins along each axis, and compare the divisions between bins
    double best = std::numeric_limits<double>::infinity();
    int best_axis = longest, best_bin = 0;
    const auto bin_of = [&](const Item& item, int axis) {
        const double low = static_cast<double>(middles.low[axis]), extent = static_cast<double>(middles.high[axis]) - low;
        return std::min(static_cast<int>(kBins * (static_cast<double>(item.middle[axis]) - low) / extent), kBins - 1);
    };
    for (int axis = 0; axis < 3; ++axis) {
        if (!(middles.high[axis] > middles.low[axis]))
            continue;
        std::array<Box, kBins> boxes;
        std::array<std::size_t, kBins> counts{};
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const auto bin = static_cast<std::size_t>(bin_of(items[i], axis));
            boxes[bin].add(items[i].box), ++counts[bin];
        }
        std::array<double, kBins> above{}; // cost of the bins from here on
        Box box;
        std::size_t count = 0;
        for (std::size_t bin = kBins; bin-- > 1;) {
            box.add(boxes[bin]), count += counts[bin];
            above[bin] = box.area() * static_cast<double>(count);
        }
        box = {}, count = 0;
        for (std::size_t bin = 1; bin < kBins; ++bin) {
            box.add(boxes[bin - 1]), count += counts[bin - 1];
            const double cost = box.area() * static_cast<double>(count) + above[bin];
            if (count > 0 && count < range.size() && cost < best)
                best = cost, best_axis = axis, best_bin = static_cast<int>(bin);
        }
    }
    if (!std::isfinite(best))
        return halve(items, range, longest);
    const auto first = items.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto end = items.begin() + static_cast<std::ptrdiff_t>(range.end);
    const auto middle = std::stable_partition(first, end, [&](const Item& item) { return bin_of(item, best_axis) < best_bin; });
    return {static_cast<std::size_t>(middle - items.begin()), best_axis};
}

struct Subtree { // built apart, and put in place of a node
    Range range;
    int level;
    std::vector<RayNode> nodes;
};

class Builder {
  public:
    Builder(std::vector<Item>& items, std::size_t alone) : items_(items), alone_(alone) {}

    // Builds the nodes of a range. Ranges of at most `alone` triangles become subtrees without nodes.
    std::uint32_t build(Range range, int level, std::vector<RayNode>& nodes, std::vector<Subtree>* apart)
    {
        const auto at = static_cast<std::uint32_t>(nodes.size());
        nodes.push_back({});
        const Split split = divide(items_, range, level);
        nodes[at].axis = static_cast<std::uint32_t>(split.axis);
        // A lone triangle is both children, since a child has at least one
        const Range parts[2] = {{range.begin, range.size() > 1 ? split.middle : range.end}, {split.middle, range.end}};
        for (int k = 0; k < 2; ++k) {
            Box box = box_of(items_, parts[k]);
            const glm::vec3 more = glm::max(glm::abs(box.low), glm::abs(box.high)) * kWidenBounds;
            for (int axis = 0; axis < 3; ++axis) {
                nodes[at].low[k][axis] = box.low[axis] - more[axis];
                nodes[at].high[k][axis] = box.high[axis] + more[axis];
            }
            if (parts[k].size() <= static_cast<std::size_t>(kLeafTriangles)) {
                nodes[at].first[k] = static_cast<std::uint32_t>(parts[k].begin);
                nodes[at].count[k] = static_cast<std::uint16_t>(parts[k].size());
            } else if (apart && parts[k].size() <= alone_) {
                nodes[at].first[k] = kApart | static_cast<std::uint32_t>(apart->size());
                apart->push_back({parts[k], level + 1, {}});
            } else {
                nodes[at].first[k] = build(parts[k], level + 1, nodes, apart);
            }
        }
        return at;
    }
    static constexpr std::uint32_t kApart = 0x80000000u;

  private:
    std::vector<Item>& items_;
    std::size_t alone_;
};

class TreeScene final : public RayScene {
  public:
    TreeScene(const Scene& scene, const DrawTables& tables, const Jobs& jobs, Isa isa, const std::vector<bool>& left_out)
        : fns_(pick<TraceFns>(isa))
    {
        std::vector<std::uint32_t> surfaces, open_lights;
        std::vector<std::uint8_t> single_sided(tables.triangle_count());
        for (std::uint32_t i = 0; i < tables.triangle_count(); ++i) {
            const std::uint32_t id = tables.triangle_material[i];
            if (id < left_out.size() && left_out[id])
                continue;
            const Material& material = scene.materials[id];
            single_sided[i] = !material.double_sided;
            (material.emitter == kOpenEmitter ? open_lights : surfaces).push_back(i);
        }
        surfaces_ = make_ray_tree(tables, surfaces, single_sided, jobs);
        open_lights_ = make_ray_tree(tables, open_lights, single_sided, jobs);
    }
    void trace(RayPacket& rays, RayKind kind) const override
    {
        for (std::uint32_t& geometry : rays.geometry)
            geometry = kNoHit;
        fns_.trace(surfaces_.view(), rays, kind);
        if (kind == RayKind::camera)
            fns_.trace(open_lights_.view(), rays, kind);
    }
    std::string description() const override { return "own rays"; }

  private:
    const TraceFns& fns_;
    RayTree surfaces_, open_lights_;
};

} // namespace

RayTree make_ray_tree(const DrawTables& tables, const std::vector<std::uint32_t>& ids, const std::vector<std::uint8_t>& single_sided,
                      const Jobs& jobs)
{
    RayTree tree;
    if (ids.empty())
        return tree;
    const auto corner = [&](std::uint32_t id, int k) {
        const std::uint32_t v = tables.indices[std::size_t{3} * id + static_cast<std::size_t>(k)];
        return glm::vec3(tables.px[v], tables.py[v], tables.pz[v]);
    };
    std::vector<Item> items(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            items[i].box.add(corner(ids[i], k));
        items[i].middle = items[i].box.low * 0.5f + items[i].box.high * 0.5f;
        items[i].at = static_cast<std::uint32_t>(i);
    }
    // Build the uppermost nodes, then the subtrees below on all threads
    const std::size_t alone = std::max(kLeastTriangles, items.size() / 64);
    std::vector<RayNode> nodes;
    std::vector<Subtree> apart;
    Builder(items, alone).build({0, items.size()}, 0, nodes, &apart);
    jobs.parallel_for(apart.size(),
                      [&](std::size_t i, int) { Builder(items, alone).build(apart[i].range, apart[i].level, apart[i].nodes, nullptr); });
    // Put the subtrees in place
    const std::size_t uppermost = nodes.size();
    for (const Subtree& s : apart) {
        const auto base = static_cast<std::uint32_t>(nodes.size()), which = static_cast<std::uint32_t>(&s - apart.data());
        for (RayNode node : s.nodes) {
            for (int k = 0; k < 2; ++k)
                node.first[k] += node.count[k] ? 0 : base;
            nodes.push_back(node);
        }
        for (std::size_t n = 0; n < uppermost; ++n)
            for (int k = 0; k < 2; ++k)
                if (nodes[n].count[k] == 0 && nodes[n].first[k] == (Builder::kApart | which))
                    nodes[n].first[k] = base;
    }
    tree.nodes.assign(nodes.data(), nodes.size());
    tree.triangles.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        RayTriangle& t = tree.triangles[i];
        t.id = ids[items[i].at];
        t.single_sided = single_sided[t.id];
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                t.corner[k][axis] = corner(t.id, k)[axis];
    }
    return tree;
}

std::unique_ptr<RayScene> make_tree_scene(const Scene& scene, const DrawTables& tables, const Jobs& jobs, Isa isa,
                                          const std::vector<bool>& left_out)
{
    return std::make_unique<TreeScene>(scene, tables, jobs, isa, left_out);
}

} // namespace burnish
