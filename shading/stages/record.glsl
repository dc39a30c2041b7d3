// The words of a visible point and of its material, in the order of StageRecords (raster/frame/frame.h). put_int and put_real, which take
// one after another, are the includer's.
#ifndef BN_RECORD_GLSL
#define BN_RECORD_GLSL

void put_real2(real2 v)
{
    put_real(v.x);
    put_real(v.y);
}
void put_real3(real3 v)
{
    put_real2(v.xy);
    put_real(v.z);
}

void record_point(visible_point p)
{
    put_real3(p.normal);
    put_real3(p.tangent);
    put_real(p.tangent_sign);
    put_real2(p.color.xy);
    put_real2(p.color.zw);
    for (int i = 0; i < 2; ++i) {
        put_real2(p.uv[i]);
        put_real2(p.uv_dx[i]);
        put_real2(p.uv_dy[i]);
    }
    put_int(p.front ? 1 : 0);
    put_real3(p.ray);
    put_real3(p.position);
}

void record_material(material_inputs at)
{
#define BN_INPUT(type, words, name) put_##type(at.name);
#include "shading/material.def"
}

#endif
