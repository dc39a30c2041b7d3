// Fits a lobe to the slopes of a height field: microgeometry as a reflection model sees it.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace burnish {

enum class SlopeModel { ggx, beckmann };

struct SlopeLobe {
    glm::dvec2 mean = {0.0, 0.0};                 // slope along tangent and bitangent: the lobe's tilt
    double alpha_along = 0.0, alpha_across = 0.0; // widths, as the model has them; along the wide axis and across it
    double angle = 0.0;                           // of the wide axis, counter-clockwise from the tangent, [0, pi)
    double distance = 0.0; // L1 between the densities of slopes and lobe, [0,2], in kSlopeCells cells, or along the axis if it is all
};
inline constexpr int kSlopeCells = 64; // equally probable under the lobe

// Returns the lobe with the greatest likelihood. Beckmann's slopes are normally distributed, so that mean and covariance give the lobe.
// GGX's slopes have Student's distribution with two degrees of freedom; the lobe follows by reweighting (Lange, Little and Taylor 1989,
// "Robust Statistical Modeling Using the t Distribution"). slopes: of facets with equal shares of the base plane, at least one, finite.
SlopeLobe fit_slope_lobe(const std::vector<glm::dvec2>& slopes, SlopeModel model);

} // namespace burnish
