// Parts of generated scenes, besides grids (core/scene/grid.h).
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

// Adds a node at `at` with a mesh that `add` makes, in one material.
void add_part(Scene& scene, const Material& material, const glm::vec3& at, void (*add)(Scene&));

// Returns metal with GGX widths roughness^2 (1 +- eta) along and across the tangent.
Material brushed_metal(double roughness, double eta, const glm::vec3& colour);

// Returns a node at `eye`, for a light or a camera, that faces `target` along -Z. The direction must not be +Y.
Node looking(const char* name, const glm::vec3& eye, const glm::vec3& target);

// Returns noise in [0,1) without a visible pattern, equal everywhere.
double noise(int x, int y, std::uint32_t salt);

// Makes an image from texel centres in [0,1], u to the right and v down.
Image map_of(int width, int height, const std::function<glm::dvec3(double u, double v)>& colour);
// Encodes slopes along tangent and bitangent as a normal map colour.
glm::dvec3 normal_colour(const glm::dvec2& slope);

// Evaluates a cubic Bezier curve p[0..3] at t in [0,1], or its derivative. Exact at both ends.
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

// Returns 0 below a, 1 above b, and a smooth transition between; a < b.
inline double smooth_step(double a, double b, double x)
{
    const double t = x <= a ? 0.0 : x >= b ? 1.0 : (x - a) / (b - a);
    return t * t * (3.0 - 2.0 * t);
}

// The scenes and environments, one file for each.
Scene make_teapot();
Scene make_spheres();
Scene make_sphere();
Scene make_plate();
Scene make_lights();
Scene make_glass();
Scene make_bumps();
Scene make_lacquer();
Scene make_cloth();
Scene make_anodised();
Scene make_shaderballs();
Image make_studio(const Jobs* jobs);
Image make_sky(const Jobs* jobs);
Image make_night(const Jobs* jobs);

} // namespace burnish
