#include "raster/frame/bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/jobs/jobs.h"
#include "core/math/scalar_math.h"
#include "core/simd/dispatch.h"
#include "raster/rays/ray_tree.h"

namespace burnish {

namespace {

constexpr std::size_t kBodyRays = 512; // at most, through one material's bodies

glm::dvec3 position(const DrawTables& t, std::uint32_t vertex)
{
    return {static_cast<double>(t.px[vertex]), static_cast<double>(t.py[vertex]), static_cast<double>(t.pz[vertex])};
}

glm::dvec3 normal(const DrawTables& t, std::uint32_t vertex)
{
    const float* n = t.shading[vertex].normal;
    return {static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])};
}

using Corner = std::array<std::int64_t, 3>; // a position in steps of a grid

// Returns true if edges have triangles on both sides, but for a few short ones. Corners that lie nearly together are one.
bool is_closed(const DrawTables& t, const Draw& draw)
{
    constexpr double kSteps = 65536.0, kOpen = 0.05; // across the mesh; open length, as a share of the surface's square root
    const glm::dvec3 low(draw.bounds_min), size = glm::dvec3(draw.bounds_max) - low;
    const double step = std::max(size.x, std::max(size.y, size.z)) / kSteps;
    if (!(step > 0.0))
        return false;
    const auto corner_of = [&](std::uint32_t vertex) {
        const glm::dvec3 at = (position(t, vertex) - low) / step + 0.5;
        return Corner{static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y), static_cast<std::int64_t>(at.z)};
    };
    struct Edge {
        Corner low, high;
        bool operator<(const Edge& o) const { return low != o.low ? low < o.low : high < o.high; }
        bool operator==(const Edge& o) const { return low == o.low && high == o.high; }
    };
    std::vector<Edge> edges;
    edges.reserve(3 * std::size_t{draw.triangle_count});
    double area = 0.0;
    for (std::size_t i = draw.first_triangle; i < std::size_t{draw.first_triangle} + draw.triangle_count; ++i) {
        const std::uint32_t* const v = &t.indices[3 * i];
        const Corner c[3] = {corner_of(v[0]), corner_of(v[1]), corner_of(v[2])};
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])
            continue;
        area += 0.5 * glm::length(glm::cross(position(t, v[1]) - position(t, v[0]), position(t, v[2]) - position(t, v[0])));
        for (int k = 0; k < 3; ++k)
            edges.push_back({std::min(c[k], c[(k + 1) % 3]), std::max(c[k], c[(k + 1) % 3])});
    }
    std::sort(edges.begin(), edges.end());
    double open = 0.0;
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end] == edges[i])
            ++end;
        const Edge& e = edges[i];
        if ((end - i) % 2 != 0)
            open += step * glm::length(glm::dvec3(e.high[0] - e.low[0], e.high[1] - e.low[1], e.high[2] - e.low[2]));
        i = end;
    }
    return !edges.empty() && open <= kOpen * std::sqrt(area);
}

struct Probe { // a place on a body's surface
    glm::dvec3 place, inwards;
    double bend; // mean change of the normal per metre, outwards; 1 / radius on a ball
    double area;
};

// Returns the probe at a triangle's middle; area 0: none.
Probe probe_at(const DrawTables& t, std::size_t triangle)
{
    const std::uint32_t* const v = &t.indices[3 * triangle];
    const glm::dvec3 p[3] = {position(t, v[0]), position(t, v[1]), position(t, v[2])};
    const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double twice = glm::length(across);
    Probe probe = {(p[0] + p[1] + p[2]) / 3.0, {}, 0.0, 0.5 * twice};
    if (!(twice > 0.0) || !std::isfinite(twice))
        return {{}, {}, 0.0, 0.0};
    probe.inwards = across / -twice;
    double length2 = 0.0, turn = 0.0;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 edge = p[(k + 1) % 3] - p[k];
        length2 += glm::dot(edge, edge);
        turn += glm::dot(edge, normal(t, v[(k + 1) % 3]) - normal(t, v[k]));
    }
    probe.bend = turn / length2;
    return probe;
}

// Returns the cube root of a node's change of volume: the factor on lengths.
double scale_of(const Scene& scene, const Draw& draw)
{
    if (draw.node < 0 || static_cast<std::size_t>(draw.node) >= scene.nodes.size())
        return 1.0;
    const glm::dmat3 m(scene.nodes[static_cast<std::size_t>(draw.node)].world);
    return det_pow(std::fabs(glm::determinant(m)), 1.0 / 3.0);
}

// Returns log2 of a share of light, (0,1]; a finite number for 0.
float log2_of_share(float share)
{
    return static_cast<float>(det_log(static_cast<double>(std::max(share, 1e-12f))) / det_log(2.0));
}

bool transmits(const Material& m)
{
    return m.transmission > 0.0f && !m.unlit;
}

} // namespace

bool is_closed_body(const DrawTables& tables, std::size_t material)
{
    return std::all_of(tables.draws.begin(), tables.draws.end(),
                       [&](const Draw& d) { return static_cast<std::size_t>(d.material) != material || is_closed(tables, d); });
}

Body measure_body(const Scene& scene, const DrawTables& tables, std::size_t material, const Jobs& jobs)
{
    if (!is_closed_body(tables, material))
        return {};
    // Find its triangles
    std::vector<std::uint32_t> ids;
    double scale = 0.0;
    for (const Draw& draw : tables.draws) {
        if (static_cast<std::size_t>(draw.material) != material)
            continue;
        scale += scale_of(scene, draw) * draw.triangle_count;
        for (std::uint32_t i = 0; i < draw.triangle_count; ++i)
            ids.push_back(draw.first_triangle + i);
    }
    if (ids.empty())
        return {};
    scale /= static_cast<double>(ids.size());
    // Place probes on evenly chosen triangles
    const TraceSpan span("bodies");
    std::vector<Probe> probes;
    const std::size_t count = std::min(ids.size(), kBodyRays);
    for (std::size_t i = 0; i < count; ++i)
        if (const Probe probe = probe_at(tables, ids[i * ids.size() / count]); probe.area > 0.0)
            probes.push_back(probe);
    // Send a ray through the body from each
    const RayTree tree = make_ray_tree(tables, ids, std::vector<std::uint8_t>(tables.triangle_count()), jobs);
    const TraceFns& fns = pick<TraceFns>(best_isa());
    double area = 0.0, extent = 0.0, roundness = 0.0;
    const double declared = static_cast<double>(scene.materials[material].thickness) * scale;
    for (std::size_t first = 0; first < probes.size(); first += kRays) {
        RayPacket k = {};
        for (std::size_t i = 0; i < kRays; ++i) {
            const Probe& p = probes[std::min(first + i, probes.size() - 1)];
            const glm::dvec3 from = p.place + p.inwards * (1e-3 * std::sqrt(p.area));
            k.org_x[i] = static_cast<float>(from.x), k.org_y[i] = static_cast<float>(from.y), k.org_z[i] = static_cast<float>(from.z);
            k.dir_x[i] = static_cast<float>(p.inwards.x), k.dir_y[i] = static_cast<float>(p.inwards.y);
            k.dir_z[i] = static_cast<float>(p.inwards.z);
            k.tfar[i] = std::numeric_limits<float>::infinity(), k.valid[i] = -1;
            k.geometry[i] = kNoHit;
        }
        fns.trace(tree.view(), k, RayKind::bounce);
        for (std::size_t i = 0; i < kRays && first + i < probes.size(); ++i) {
            if (k.geometry[i] == kNoHit)
                continue;
            const Probe& p = probes[first + i];
            const double through = declared > 0.0 ? declared : static_cast<double>(k.tfar[i]);
            area += p.area, extent += p.area * through;
            roundness += p.area * std::clamp(0.5 * through * p.bend, 0.0, 1.0);
        }
    }
    if (!(area > 0.0) || !std::isfinite(extent))
        return {};
    return {false, extent / area, roundness / area};
}

void put_bodies(const Scene& scene, const DrawTables& tables, const Jobs& jobs, std::vector<MaterialRecord>& records,
                std::vector<MaterialRecord>& overridden)
{
    for (std::size_t i = 0; i < records.size(); ++i) {
        const Material& m = scene.materials[i];
        if (!transmits(m))
            continue;
        const Body body = measure_body(scene, tables, i, jobs);
        MaterialRecord& r = records[i];
        r.thin = body.thin;
        r.body_extent = static_cast<float>(body.extent), r.body_roundness = static_cast<float>(body.roundness);
        for (int c = 0; c < 3 && m.attenuation_distance > 0.0f; ++c)
            r.body_decay[c] = std::max(log2_of_share(m.attenuation_color[c]) / m.attenuation_distance, -1e30f);
        if (i >= overridden.size())
            continue;
        MaterialRecord& o = overridden[i];
        o.thin = r.thin, o.body_extent = r.body_extent, o.body_roundness = r.body_roundness;
        std::copy(std::begin(r.body_decay), std::end(r.body_decay), o.body_decay);
    }
}

} // namespace burnish
