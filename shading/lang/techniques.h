// Dispatch to the techniques for environment light (shading/techniques/*.t.h), generated from shading/models.def.
//   technique_ref t                 technique_tag, a compile-time type, in C++; an index into models.def in GLSL
//   technique_traits(m, t)          traits for a material m that is not unlit
//   technique_specular(f, t, x)     calls <id>_specular(f, x)
//   technique_shared(f, t, x, o)    calls <id>_shared(f, x, o) of a technique that shares samples; o: quad_offset()
#ifndef BN_TECHNIQUES_H
#define BN_TECHNIQUES_H

#define BN_TECHNIQUE_TEXTS
#include "shading/models.def"

#ifdef __cplusplus
#define technique_ref auto

namespace burnish {
inline namespace BN_ISA_NS {

enum class Technique : std::int32_t {
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary) id,
#include "shading/models.def"
};

constexpr int kTechniqueTraits[] = {
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary) traits,
#include "shading/models.def"
};

template <Technique kTechnique> struct technique_tag {
    static constexpr Technique kId = kTechnique;
    static constexpr int kTraits = kTechniqueTraits[static_cast<int>(kTechnique)];
};

template <class Tag> BN_FN constexpr int technique_traits(material_ref, Tag)
{
    return Tag::kTraits;
}

template <class Tag> BN_FN real3 technique_specular(frame_ref f, Tag, const shaded_point& x)
{
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary)                                                         \
    if constexpr (Tag::kId == Technique::id)                                                                                               \
        return id##_specular(f, x);
#include "shading/models.def"
}

template <class Tag> BN_FN shared_sample_record technique_shared(frame_ref f, Tag, const shaded_point& x, real offset)
{
#define BN_SHARING(id)                                                                                                                     \
    if constexpr (Tag::kId == Technique::id)                                                                                               \
        return id##_shared(f, x, offset);
#include "shading/models.def"
    return shared_sample_record{};
}

} // namespace BN_ISA_NS
} // namespace burnish
#else
#define technique_ref int
#define technique_traits(m, t) the_material(m).technique_traits

layout(constant_id = 0) const int kTechniques = -1; // techniques of the frame's materials: one bit per index in models.def

real3 technique_specular(frame_ref f, technique_ref technique, shaded_point x)
{
    int at = 0;
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary)                                                         \
    if ((kTechniques >> at & 1) != 0 && technique == at)                                                                                   \
        return id##_specular(f, x);                                                                                                        \
    ++at;
#include "shading/models.def"
    return vec3_all(lit(0.0));
}

shared_sample_record technique_shared(frame_ref f, technique_ref technique, shaded_point x, real offset)
{
    int at = -1; // index of the technique line before
    shared_sample_record r;
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary) ++at;
#define BN_SHARING(id)                                                                                                                     \
    if ((kTechniques >> at & 1) != 0 && technique == at)                                                                                   \
        r = id##_shared(f, x, offset);
#include "shading/models.def"
    return r;
}
#endif

#endif
