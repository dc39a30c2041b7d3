// The words of a visible point and of its material, in the order of StageRecords (raster/frame/frame.h). put_int and put_real, which take
// one after another, are the includer's.
#ifndef BN_RECORD_GLSL
#define BN_RECORD_GLSL

void put2(real2 v)
{
    put_real(v.x);
    put_real(v.y);
}
void put3(real3 v)
{
    put2(v.xy);
    put_real(v.z);
}

void record_point(visible_point p)
{
    put3(p.normal);
    put3(p.tangent);
    put_real(p.tangent_sign);
    put2(p.color.xy);
    put2(p.color.zw);
    for (int i = 0; i < 2; ++i) {
        put2(p.uv[i]);
        put2(p.uv_dx[i]);
        put2(p.uv_dy[i]);
    }
    put_int(p.front ? 1 : 0);
    put3(p.ray);
    put3(p.position);
}

void record_material(material_inputs at)
{
    put3(at.base);
    put_real(at.alpha);
    put_real(at.metallic);
    put_real(at.roughness);
    put_real(at.occlusion);
    put3(at.normal_map);
    put3(at.emissive);
    put3(at.dielectric_f0);
    put_real(at.dielectric_f90);
    put3(at.tensor2);
    put3(at.tensor4);
}

#endif
