// What the generated scenes are made with, besides grids (core/scene/grid.h).
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>

#include "core/scene/builtin/builtin.h"
#include "core/scene/grid.h"
#include "core/scene/scene.h"

namespace burnish {

// About the origin. Tangents point east.
void add_sphere(Scene& scene, int meridians, int parallels, double radius);

// Of GGX widths alpha_lin^2 (1 +- eta) along the tangent and across it.
Material brushed_metal(double alpha_lin, double eta, const glm::vec3& colour);

// What shines along -Z, or looks there, from `eye` at `target`, not along +Y.
Node looking(const char* name, const glm::vec3& eye, const glm::vec3& target);

double noise(int x, int y, std::uint32_t salt); // [0,1): without a pattern, the same everywhere

// Texels by their centre, u to the right and v down, [0,1].
Image map_of(int width, int height, const std::function<glm::dvec3(double u, double v)>& colour);
// As a normal map has the slopes along tangent and bitangent.
glm::dvec3 normal_colour(const glm::dvec2& slope);

// Cubic Bezier curve: p[0..3] at t in [0,1], and its derivative. Exact at both ends.
template <class T> T bezier(const T* p, double t)
{
    const double s = 1.0 - t;
    return p[0] * (s * s * s) + p[1] * (3.0 * s * s * t) + p[2] * (3.0 * s * t * t) + p[3] * (t * t * t);
}
template <class T> T bezier_derivative(const T* p, double t)
{
    const double s = 1.0 - t;
    return (p[1] - p[0]) * (3.0 * s * s) + (p[2] - p[1]) * (6.0 * s * t) + (p[3] - p[2]) * (3.0 * t * t);
}

// 0 below a, 1 above b, smooth between; a < b.
inline double smooth_step(double a, double b, double x)
{
    const double t = x <= a ? 0.0 : x >= b ? 1.0 : (x - a) / (b - a);
    return t * t * (3.0 - 2.0 * t);
}

// The scenes and environments, by file.
Scene make_teapot();
Scene make_spheres();
Scene make_sphere();
Scene make_plate();
Scene make_lights();
Scene make_glass();
Scene make_bumps();
Scene make_lacquer();
Scene make_shaderballs();
struct TrialMaker {
    BuiltinInfo info;
    double usual, least, most; // amounts
    Scene (*make)(double amount);
};
const std::vector<TrialMaker>& trial_makers();
Image make_studio();
Image make_sky();
Image make_night();

} // namespace burnish
