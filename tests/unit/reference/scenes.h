// Scenes and environments with known radiance, and a reference renderer for them.
#pragma once
#include <functional>
#include <memory>

#include "raster/reference/reference_renderer.h"
#include "tests/unit/raster/fixture.h"

#define BN_NEEDS_EMBREE()                                                                                                                  \
    if (!reference_available())                                                                                                            \
    GTEST_SKIP() << "built without Embree"

namespace burnish::test {

// Bakes an environment from radiance by direction, through a cube with `size` texels a side.
Environment environment_of(const std::function<glm::vec3(const glm::vec3&)>& radiance, int size, const Jobs& jobs);
Stage under_coloured_sky(const Scene& scene); // coloured_sky() of formulas.h

// A square of 2 m at the origin that faces +z, its tangent along +x.
Scene plane_scene(const Material& material);
// A ball of radius 1 at the origin. Normals point outwards or, for rooms, inwards.
Scene ball_scene(const Material& material, bool inside);
Scene room_scene(const Material& material); // a cube from -1 to 1, seen from inside
// Adds area lights in world space. shown: also as visible surfaces.
Scene lit_by(Scene scene, const std::vector<AreaLight>& lights, bool shown);
TextureRef add_texel(Scene& to, const glm::ivec3& code);                            // a 1x1 texture of 8 bits
TextureRef add_texel(Scene& to, const glm::vec3& values);                           // a 1x1 texture of floats
TextureRef add_texel(Scene& to, const glm::vec4& values);                           // the same with alpha
void add_scene(Scene& to, const Scene& from, const glm::vec3& offset, float scale); // its first mesh and material

Material lambert(float albedo);                                // diffuse only
Material metal(float roughness, float eta);                    // reflectance 1 everywhere; eta by FrameDesc::anisotropy
View view_from(const glm::vec3& direction, float half_extent); // orthographic, of a small square around the origin
Frame render_reference(const Stage& stage, const FrameDesc& desc, const ReferenceOptions& options);
FrameDesc desc_of(int width, int height, const View& view);

struct Estimate {                       // of the mean over an image's pixels and channels
    double mean = 0.0, deviation = 0.0; // deviation: standard error of `mean`
};
Estimate estimate(const Frame& frame);
double mean_of(const Frame& frame);       // over all channels of all pixels
glm::dvec3 colour_of(const Frame& frame); // mean over all pixels

struct ChannelEstimate { // of the means over an image's pixels
    glm::dvec3 mean{0.0}, deviation{0.0};
};
ChannelEstimate estimate_channels(const Frame& frame);

} // namespace burnish::test
