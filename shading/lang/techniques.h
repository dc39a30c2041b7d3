// The techniques for environment light (shading/techniques/*.t.h) by their lines in shading/models.def.
//   technique_ref t                 lanes know theirs when they are compiled (technique_tag), GLSL has its place in models.def
//   technique_traits(m, t)          of a material m that is not unlit
//   technique_specular(f, t, x)     what <id>_specular(f, x) returns
//   technique_shared(f, t, x, o)    what <id>_shared(f, x, o) returns, of a technique that shares samples; o: quad_offset()
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

template <class Tag> BN_FN line_record technique_shared(frame_ref f, Tag, const shaded_point& x, real offset)
{
#define BN_SHARING(id)                                                                                                                     \
    if constexpr (Tag::kId == Technique::id)                                                                                               \
        return id##_shared(f, x, offset);
#include "shading/models.def"
    return line_record{};
}

} // namespace BN_ISA_NS
} // namespace burnish
#else
#define technique_ref int
#define technique_traits(m, t) the_material(m).technique_traits

layout(constant_id = 0) const int kTechniques = -1; // of the frame's materials, a bit a place in models.def

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

line_record technique_shared(frame_ref f, technique_ref technique, shaded_point x, real offset)
{
    int at = -1; // of the technique before
    line_record r;
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary) ++at;
#define BN_SHARING(id)                                                                                                                     \
    if ((kTechniques >> at & 1) != 0 && technique == at)                                                                                   \
        r = id##_shared(f, x, offset);
#include "shading/models.def"
    return r;
}
#endif

#endif
