// Shared samples (line_record) of a band's visible (pixel, triangle) pairs, [pixel of the band][first sample].
#ifndef BN_LINES_GLSL
#define BN_LINES_GLSL

#include "shading/techniques/shared_line.k.h"

layout(std430, set = 0, binding = 15) buffer BnLines { float lines[]; };

void store_line(int place, line_record r)
{
    line_words words = words_of_line(r);
    for (int i = 0; i < kGpuLineWords; ++i)
        lines[place * kGpuLineWords + i] = words.at[i];
}

line_record load_line(int place)
{
    line_words words;
    for (int i = 0; i < kGpuLineWords; ++i)
        words.at[i] = lines[place * kGpuLineWords + i];
    return line_of_words(words);
}

#endif
