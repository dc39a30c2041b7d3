// The techniques for environment light in GLSL: shading/techniques/*.t.h, by their lines in shading/models.def.
#ifndef BN_TECHNIQUES_GLSL
#define BN_TECHNIQUES_GLSL

#define BN_TECHNIQUE_TEXTS
#include "shading/models.def"

layout(constant_id = 0) const int kTechniques = -1; // of the frame's materials, a bit a place in models.def

real3 technique_specular(frame_ref f, int technique, shaded_point x)
{
    int at = 0;
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary) \
    if ((kTechniques >> at & 1) != 0 && technique == at)                                                                                   \
        return id##_specular(f, x);                                                                                                        \
    ++at;
#include "shading/models.def"
    return vec3_all(lit(0.0));
}

// Of a technique that shares samples. offset: quad_offset().
line_record technique_shared(frame_ref f, int technique, shaded_point x, real offset)
{
    int at = -1; // of the technique before
    line_record r;
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary) ++at;
#define BN_SHARING(id) \
    if (technique == at)                                                                                                                   \
        r = id##_shared(f, x, offset);
#include "shading/models.def"
    return r;
}

#endif
