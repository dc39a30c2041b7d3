#include "apps/parity/rays.h"

#include <algorithm>
#include <cmath>

#include "raster/frame/exact_projection.h"
#include "raster/frame/frame_record.h"

namespace burnish {
namespace {

constexpr Long kEqualDepth = 1e-4L; // of the depth

struct Place {
    const DrawTables& tables;
    ViewRecord view;
    int width, height;
    Long x, y, edge; // pixels

    ProjectedTriangle triangle(std::uint32_t id) const
    {
        glm::vec3 corners[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = tables.indices[std::size_t{3} * id + k];
            corners[k] = glm::vec3(tables.px[v], tables.py[v], tables.pz[v]);
        }
        return project(view, width, height, corners);
    }
    // Returns true near the edges of a triangle, where rounding may decide.
    bool near_edge(const ProjectedTriangle& t) const { return !t.seen_at_all || std::fabs(t.inside(x, y)) <= edge; }
};

// Returns true where a ray's triangle does not cover the sample by its exact projection. Rays lose digits on triangles a hundred thousand
// times as large as the eye's distance.
bool ray_is_off(const Place& place, std::uint32_t right)
{
    if (right == kNoTriangle)
        return false;
    const ProjectedTriangle t = place.triangle(right);
    return !t.seen_at_all || t.inside(place.x, place.y) <= 0;
}

// Returns true where rounding may choose between two triangles, or between one and none.
bool may_be_either(const Place& place, std::uint32_t one, std::uint32_t other)
{
    Long depth[2] = {};
    int count = 0;
    for (std::uint32_t id : {one, other}) {
        if (id == kNoTriangle)
            continue;
        const ProjectedTriangle t = place.triangle(id);
        if (place.near_edge(t))
            return true;
        if (t.inside(place.x, place.y) > 0)
            depth[count++] = t.z.value(place.x, place.y);
    }
    return count == 2 && std::fabs(depth[0] - depth[1]) <= kEqualDepth * std::max(std::fabs(depth[0]), std::fabs(depth[1]));
}

// Returns true for a triangle that rays see otherwise: they cut holes by the texel, devices by filtered texels; they pass a blended surface
// at random.
bool lets_rays_pass(const RenderInput& input, std::uint32_t id)
{
    return id != kNoTriangle && input.scene.materials[input.tables.triangle_material[id]].alpha_mode != AlphaMode::opaque;
}

} // namespace

Result<Session> ray_session(const SessionParts& parts, Isa isa)
{
    SessionOptions options;
    options.backend = Backend::reference, options.isa = isa;
    options.reference.own_rays = options.reference.ids_only = true;
    return Session::make(parts, options);
}

Result<RayCounts> compare_with_rays(const Frame& device, const FrameDesc& desc, Session& rays, double edge)
{
    RayCounts out;
    const FrameDesc drawn = rays.drawn(desc);
    const Result<Frame> traced = rays.renderer().render(drawn);
    BN_TRY(traced);
    const SamplePattern pattern = standard_samples(desc.msaa);
    const RenderInput input = rays.parts().input();
    const auto msaa = static_cast<std::size_t>(desc.msaa);
    for (std::size_t i = 0; i < device.triangle_ids.size(); ++i) {
        const std::uint32_t found = device.triangle_ids[i], right = traced->triangle_ids[i];
        if (lets_rays_pass(input, found) || lets_rays_pass(input, right))
            continue;
        ++out.samples;
        if (found == right)
            continue;
        ++out.differ;
        const int x = static_cast<int>(i / msaa) % desc.width, y = static_cast<int>(i / msaa) / desc.width;
        const std::size_t s = i % msaa;
        const Place place = {input.tables,
                             view_record(drawn.view),
                             desc.width,
                             desc.height,
                             x + Long(pattern.x[s]) / kSubpixel,
                             y + Long(pattern.y[s]) / kSubpixel,
                             Long(edge)};
        if (ray_is_off(place, right) || may_be_either(place, found, right))
            continue;
        ++out.wrong;
        out.worst_x = x, out.worst_y = y;
    }
    return out;
}

} // namespace burnish
