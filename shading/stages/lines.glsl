// What the visible (pixel, triangle) pairs of a band share, [pixel of the band][first sample]. As raster/tile's, a record is its width, then
// its vectors.
#ifndef BN_LINES_GLSL
#define BN_LINES_GLSL

#include "shading/techniques/shared_line.k.h"

layout(std430, set = 0, binding = 15) buffer BnLines { float lines[]; };

void put_vector(int to, real3 v)
{
    lines[to] = v.x;
    lines[to + 1] = v.y;
    lines[to + 2] = v.z;
}
real3 vector_at(int from) { return vec3(lines[from], lines[from + 1], lines[from + 2]); }

void store_line(int place, line_record r)
{
    int to = place * kGpuLineWords;
    lines[to] = r.width;
    put_vector(to + 1, r.light);
    put_vector(to + 4, r.mirror);
    put_vector(to + 7, r.along);
    put_vector(to + 10, r.factor);
    put_vector(to + 13, r.rest);
}

line_record load_line(int place)
{
    int from = place * kGpuLineWords;
    return line_record(vector_at(from + 1), lines[from], vector_at(from + 4), vector_at(from + 7), vector_at(from + 10),
                       vector_at(from + 13));
}

#endif
