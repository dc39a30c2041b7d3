// Consecutive words of a visible point and its material, as recorded stages hold them (StageRecords in
// raster/frame/frame.h). All words are reals; booleans are 1 or 0.
#ifndef BN_RECORDED_T_H
#define BN_RECORDED_T_H

#include "shading/kernels/visible_point.k.h"
#include "shading/lang/lang.h"
#include "shading/lang/recorder.h"
#include "shading/surface/material.t.h"

BN_KERNELS_BEGIN

// Put values into words; a mask is 1 or 0.
BN_FN void put_mask(BN_INOUT(recorder) w, mask m)
{
    put_real(w, select(m, lit(1.0), lit(0.0)));
}
BN_FN void put_real2(BN_INOUT(recorder) w, real2 v)
{
    put_real(w, v.x);
    put_real(w, v.y);
}
BN_FN void put_real3(BN_INOUT(recorder) w, real3 v)
{
    put_real(w, v.x);
    put_real(w, v.y);
    put_real(w, v.z);
}
BN_FN void put_real4(BN_INOUT(recorder) w, real4 v)
{
    put_real(w, v.x);
    put_real(w, v.y);
    put_real(w, v.z);
    put_real(w, v.w);
}
// Puts zeros in place of values that nothing reads.
BN_FN void put_zeros(BN_INOUT(recorder) w, int count)
{
    for (int i = 0; i < count; ++i)
        put_real(w, lit(0.0));
}

// Records p. uses_color, textured, lights: requested values (shading/visible_point.def).
BN_FN void record_point(BN_INOUT(recorder) w, BN_IN(visible_point) p, bool uses_color, bool textured, bool lights)
{
#define BN_POINT(type, words, name, asked)                                                                                                 \
    if (asked)                                                                                                                             \
        put_##type(w, p.name);                                                                                                             \
    else                                                                                                                                   \
        put_zeros(w, words);
#define BN_INTERPOLATED(type, words, name, asked, first)                                                                                   \
    if (asked)                                                                                                                             \
        put_##type(w, p.name);                                                                                                             \
    else                                                                                                                                   \
        put_zeros(w, words);
#include "shading/visible_point.def"
}

// Records the inputs of a material.
BN_FN void record_material(BN_INOUT(recorder) w, BN_IN(material_inputs) at)
{
#define BN_INPUT(type, words, name) put_##type(w, at.name);
#include "shading/material.def"
}

BN_KERNELS_END

#endif
