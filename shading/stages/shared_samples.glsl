// Shared samples (shared_sample_record) of a band's visible (pixel, triangle) pairs, [pixel of the band][first sample].
#ifndef BN_SHARED_SAMPLES_GLSL
#define BN_SHARED_SAMPLES_GLSL

#include "shading/techniques/shared_samples.k.h"

layout(std430, set = 0, binding = 15) buffer BnLines { float lines[]; };

void store_shared_sample(int place, shared_sample_record r)
{
    shared_sample_words words = words_of_shared_sample(r);
    for (int i = 0; i < kGpuSharedSampleWords; ++i)
        lines[place * kGpuSharedSampleWords + i] = words.at[i];
}

shared_sample_record load_shared_sample(int place)
{
    shared_sample_words words;
    for (int i = 0; i < kGpuSharedSampleWords; ++i)
        words.at[i] = lines[place * kGpuSharedSampleWords + i];
    return shared_sample_of_words(words);
}

#endif
