#include "raster/session/mirror.h"

#include <algorithm>
#include <glm/glm.hpp>

#include "raster/session/check_parts.h"
#include "raster/session/guarded.h"
#include "raster/session/session.h"

namespace burnish {
namespace {

constexpr double kNormalReflectance = 0.04; // of an index of 1.5, by Schlick

// Returns the view mirrored in the plane y = height. Its pictures are turned left to right, since views are right-handed.
View mirrored(View view, float height)
{
    view.eye.y = 2.0f * height - view.eye.y;
    view.forward.y = -view.forward.y, view.up.y = -view.up.y;
    view.right = -glm::vec3(view.right.x, -view.right.y, view.right.z);
    return view;
}

struct FloorMirror {
    const FrameDesc& desc;
    const Draw& floor;
    const Frame& below; // seen from below, turned left to right

    // Returns the reflected light at a pixel's centre. It fades towards the floor's rim, where the backdrop begins.
    glm::dvec3 light_at(std::uint32_t pixel) const
    {
        const View& v = desc.view;
        const auto width = static_cast<std::uint32_t>(desc.width);
        const std::uint32_t x = pixel % width, y = pixel / width;
        const double across = (2.0 * (x + 0.5) / desc.width - 1.0) * static_cast<double>(v.tan_half_x);
        const double up = (1.0 - 2.0 * (y + 0.5) / desc.height) * static_cast<double>(v.tan_half_y);
        const glm::dvec3 aside = glm::dvec3(v.right) * across + glm::dvec3(v.up) * up, forward(v.forward);
        const glm::dvec3 origin = glm::dvec3(v.eye) + (v.orthographic ? aside : glm::dvec3(0.0));
        const glm::dvec3 ray = v.orthographic ? forward : forward + aside;
        const double cosine = std::min(-ray.y / glm::length(ray), 1.0);
        if (!(cosine > 0.0))
            return glm::dvec3(0.0);
        // Find the place on the floor
        const glm::dvec3 low(floor.bounds_min), high(floor.bounds_max);
        const glm::dvec3 place = origin + ray * ((high.y - origin.y) / ray.y), middle = 0.5 * (low + high);
        const double radius = 0.5 * (high.x - low.x), away = glm::length(glm::dvec2(place.x - middle.x, place.z - middle.z)) / radius;
        const double t = std::clamp((away - 0.5) / 0.5, 0.0, 1.0), rim = 1.0 - t * t * (3.0 - 2.0 * t);
        // Reflect by Schlick's approximation
        const double grazing = 1.0 - cosine, squared = grazing * grazing;
        const double fresnel = kNormalReflectance + (1.0 - kNormalReflectance) * (squared * squared * grazing);
        const float* const c = below.color.f32() + std::size_t{3} * (pixel - x + (width - 1 - x));
        return glm::dvec3(glm::vec3(c[0], c[1], c[2])) * (fresnel * rim);
    }
};

Status reflect(const ShadowSettings& shadows, const FrameDesc& desc, Session& session, Frame& lit)
{
    const std::vector<Draw>& draws = session.tables().draws;
    const auto floor = std::find_if(draws.begin(), draws.end(), [](const Draw& draw) { return draw.stage; });
    if (floor == draws.end())
        return {};
    const std::size_t pixels = static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.height);
    const std::size_t samples = pixels * static_cast<std::size_t>(desc.msaa);
    if (lit.triangle_ids.size() != samples || (lit.through.size() != 0 && lit.through.size() != samples))
        return Error{ExitCode::usage, "", "/triangle_ids", "are missing: draw with FrameDesc::triangle_ids"};
    FrameDesc plain = desc;
    plain.layers = plain.parts = plain.triangle_ids = plain.stages = plain.profile = false;
    plain.view = mirrored(desc.view, floor->bounds_max.y);
    const bool shaded = casts_shadows(shadows, plain, session);
    plain.layers = shaded;
    Result<Frame> below = session.render(plain);
    BN_TRY(below);
    if (shaded)
        BN_TRY(add_shadows(shadows, plain, session, *below));
    const FloorMirror mirror{desc, *floor, *below};
    const auto msaa = static_cast<std::size_t>(desc.msaa);
    // Returns the share of a pixel's sample that shows the floor.
    const auto shown = [&](std::size_t sample) {
        const bool on = lit.triangle_ids[sample] - floor->first_triangle < floor->triangle_count;
        return !on ? 0.0 : lit.through.size() == 0 ? 1.0 : static_cast<double>(lit.through[sample]);
    };
    session.parts().jobs->parallel_for(static_cast<std::size_t>(desc.height), [&](std::size_t row, int) {
        for (std::size_t pixel = row * static_cast<std::size_t>(desc.width); pixel < (row + 1) * static_cast<std::size_t>(desc.width);
             ++pixel) {
            double share = 0.0;
            for (std::size_t s = 0; s < msaa; ++s)
                share += shown(pixel * msaa + s);
            if (share == 0.0)
                continue;
            const glm::dvec3 light = mirror.light_at(static_cast<std::uint32_t>(pixel)) * (share / desc.msaa);
            for (int c = 0; c < 3; ++c)
                lit.color.f32()[3 * pixel + static_cast<std::size_t>(c)] += static_cast<float>(light[c]);
        }
    });
    for (PixelPart& part : lit.parts)
        if (const double share = shown(part.pixel * msaa + part.first); share > 0.0) {
            const glm::dvec3 light = mirror.light_at(part.pixel) * share;
            for (int c = 0; c < 3; ++c)
                part.color[static_cast<std::size_t>(c)] += static_cast<float>(light[c]);
        }
    return {};
}

} // namespace

Status add_reflection(const ShadowSettings& shadows, const FrameDesc& desc, Session& session, Frame& lit)
{
    if (!session.parts().scene)
        return moved_away();
    return guarded(session.parts().scene->name, [&]() -> Status {
        BN_TRY(check_shadows(shadows));
        BN_TRY(check_desc(desc));
        if (desc.window.picture_width > 0)
            return Error{ExitCode::usage, "", "", "a floor mirrors whole pictures, not a window of one", "FrameDesc::window"};
        BN_TRY(check_drawn(lit, desc));
        return reflect(shadows, desc, session, lit);
    });
}

} // namespace burnish
