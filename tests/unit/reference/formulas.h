// Light that surfaces reflect and refract, by published formulas: double-precision sums over grids of directions. The code shares nothing
// with the shading text. Surfaces face +z, and directions are unit vectors.
#pragma once
#include <functional>
#include <glm/glm.hpp>

namespace burnish::test {

using Sky = glm::dvec3 (*)(const glm::dvec3&);
// Brightens towards one side and around one broad maximum, in another place for each colour.
glm::dvec3 coloured_sky(const glm::dvec3& direction);
glm::dvec3 white_sky(const glm::dvec3& direction);
glm::dvec3 sky_upside_down(const glm::dvec3& direction); // the coloured sky, mirrored at z = 0

using Fresnel = std::function<glm::dvec3(double)>; // function of the cosine at a facet
Fresnel schlick_of(const glm::dvec3& f0);
Fresnel fresnel_of(double index); // exact; index: far side over near side
Fresnel no_fresnel();             // everything is reflected

struct Facets { // a distribution of microfacet normals
    double along = 1.0, across = 1.0;
    glm::dmat3 axes{1.0};   // columns: the grain, across it, the most common normal
    bool correlated = true; // height-correlated masking and shadowing
    bool level() const { return axes[2].z == 1.0; }
};

// KHR_materials_anisotropy; rotation: counter-clockwise from the tangent, in degrees.
Facets gltf_facets(double roughness, double strength = 0.0, double rotation = 0.0);
// Tilts the facets as Walter et al. 2014, eq. 3: towards the bitangent, and away from the tangent, in radians.
Facets tilted_by(Facets f, double x, double y);
double facet_density(const Facets& f, const glm::dvec3& m); // 1/sr, per surface area
double area_seen(const Facets& f, const glm::dvec3& u);     // projected area of all facets towards u, per surface area
double inverse_g1(const Facets& f, const glm::dvec3& u);    // for Smith's masking
// Calls add(normal, solid angle) for rings x 2 rings normals of the upper half.
void for_each_facet(const Facets& f, int rings, const std::function<void(const glm::dvec3&, double)>& add);

inline constexpr int kFacetRings = 256;
// Returns the radiance towards o.
glm::dvec3 reflected_light(const Facets& f, const glm::dvec3& o, const Fresnel& fresnel, Sky sky = coloured_sky, int rings = kFacetRings);
// Returns a rough interface's radiance over the squared index, which refraction conserves. tint: colour of the transmitted light.
glm::dvec3 glass_light(const Facets& f, const glm::dvec3& o, double index, const glm::dvec3& tint, Sky sky = coloured_sky);
// Returns the radiance of a white Lambertian surface about axes[2], under light from above z = lowest.
glm::dvec3 diffuse_light(const glm::dmat3& axes = glm::dmat3(1.0), double lowest = 0.0);

} // namespace burnish::test
