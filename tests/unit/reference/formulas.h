// Light that surfaces reflect, refract and give back, by published formulas: in double, added up over grids of directions. They share
// nothing with the shading text. Surfaces face +z; directions are unit.
#pragma once
#include <functional>
#include <glm/glm.hpp>

namespace burnish::test {

using Sky = glm::dvec3 (*)(const glm::dvec3&);
// Brightens towards one side and about one broad maximum, elsewhere in each colour.
glm::dvec3 coloured_sky(const glm::dvec3& direction);
glm::dvec3 white_sky(const glm::dvec3& direction);
glm::dvec3 sky_upside_down(const glm::dvec3& direction); // the coloured one, mirrored at z = 0

using Fresnel = std::function<glm::dvec3(double)>; // of the cosine at a facet
Fresnel schlick_of(const glm::dvec3& f0);
Fresnel fresnel_of(double index); // exact; index: of the far side over the near one's
Fresnel no_fresnel();             // everything is reflected

struct Facets { // a distribution of microfacets' normals
    double along = 1.0, across = 1.0;
    glm::dmat3 axes{1.0};   // columns: the grain, across it, the commonest normal
    bool correlated = true; // masking and shadowing, by height
    bool level() const { return axes[2].z == 1.0; }
};

// KHR_materials_anisotropy; rotation: counter-clockwise from the tangent, in degrees.
Facets gltf_facets(double roughness, double strength = 0.0, double rotation = 0.0);
// Walter et al. 2014, eq. 3: towards the bitangent, and away from the tangent, in radians.
Facets tilted_by(Facets f, double x, double y);
double facet_density(const Facets& f, const glm::dvec3& m); // 1/sr, by area of the surface
double area_seen(const Facets& f, const glm::dvec3& u);     // of all facets, as u sees them, by area of the surface
double inverse_g1(const Facets& f, const glm::dvec3& u);    // of Smith's masking
// Calls add(normal, solid angle) for rings x 2 rings normals of the upper half.
void for_each_facet(const Facets& f, int rings, const std::function<void(const glm::dvec3&, double)>& add);

inline constexpr int kFacetRings = 256;
// Radiance towards o.
glm::dvec3 reflected_light(const Facets& f, const glm::dvec3& o, const Fresnel& fresnel, Sky sky = coloured_sky, int rings = kFacetRings);
// Of a rough interface, over the square of the index, which refraction keeps. tint: of what passes.
glm::dvec3 glass_light(const Facets& f, const glm::dvec3& o, double index, const glm::dvec3& tint, Sky sky = coloured_sky);
// Of a white Lambertian surface about axes[2], by light from above z = lowest.
glm::dvec3 diffuse_light(const glm::dmat3& axes = glm::dmat3(1.0), double lowest = 0.0);

} // namespace burnish::test
