// Geometry and storage of cube maps during a bake. Faces: +x -x +y -y +z -z. On a face u grows with the column and v with the row, both in
// [-1,1]: +x (1,-v,-u), -x (-1,-v,u), +y (u,1,v), -y (u,-1,-v), +z (u,-v,1), -z (-u,-v,-1).
#pragma once
#include <cstddef>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722}; // Rec.709

struct Direction {
    double x, y, z;
};
Direction cube_direction(int face, double u, double v); // not unit

// One level of linear RGB radiance without border. Faces follow each other, row-major.
struct CubeLevel {
    int size = 0;
    std::vector<float> rgb;          // 6 * size^2 * 3
    std::vector<double> solid_angle; // sr, for the texels of one face (equal on all faces), size^2
};
CubeLevel make_cube_level(int size); // black, with solid angles
inline std::size_t cube_texels(int size)
{
    return 6 * static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
}

// Returns the next smaller level: means of 2x2 texels, weighted by solid angle. Every level has the same mean radiance.
CubeLevel half_cube_level(const CubeLevel& from, const Jobs& jobs);

double mean_luminance(const CubeLevel& level); // over the sphere, Rec.709
double mean_luminance(const CubeMap& cube);    // of the stored level 0, times its scale

// Allocates `levels` black levels.
CubeMap make_cube_map(int size, int levels, float scale);
CubeMap make_unfilled_cube_map(int size, int levels, float scale); // whose texels are undefined
// Writes a level's texels, divided by the cube's scale, and the border.
void store_cube_level(CubeMap& cube, int level, const float* rgb, const Jobs& jobs);
// Returns the power of two that scales `peak` into [2^14, 2^15). Most of half's range lies below this, and texel sums stay finite.
float cube_scale(double peak);

} // namespace burnish
