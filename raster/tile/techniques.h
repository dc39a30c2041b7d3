// The techniques for environment light, in lanes: shading/techniques/*.t.h, by their lines in shading/models.def.
#pragma once
#define BN_TECHNIQUE_TEXTS
#include "shading/models.def"

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

template <Technique kTechnique> BN_INLINE real3 technique_specular(frame_ref f, const shaded_point& x)
{
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary)                                                         \
    if constexpr (kTechnique == Technique::id)                                                                                             \
        return id##_specular(f, x);
#include "shading/models.def"
}

// Of a technique that shares samples. offset: quad_offset().
template <Technique kTechnique> BN_INLINE line_record technique_shared(frame_ref f, const shaded_point& x, real offset)
{
#define BN_SHARING(id)                                                                                                                     \
    if constexpr (kTechnique == Technique::id)                                                                                             \
        return id##_shared(f, x, offset);
#include "shading/models.def"
}

} // namespace BN_ISA_NS
} // namespace burnish
