// Recorded words of a band, for comparisons and for pictures with layers: stages [pixel][first sample][kPairWords], then
// layers [pixel][kLayerWords], then pair colours [pixel][first sample][3]. Only the parts that kRecords names exist.
#ifndef BN_RECORDS_GLSL
#define BN_RECORDS_GLSL

#include "shading/lang/interface.glsl"
#include "shading/stages/pass.glsl"

layout(constant_id = 2) const int kRecords = 0; // a sum of kGpuRecord... bits

#ifndef BN_RECORDS_ACCESS
#define BN_RECORDS_ACCESS writeonly
#define BN_RECORDS_WRITTEN
#endif
layout(std430, set = 0, binding = 14) BN_RECORDS_ACCESS buffer BnRecords
{
    int records[];
};

#define BN_TAKE_WORD(at, x) records[at] = floatBitsToInt(x);

bool recorded(int what)
{
    return (kRecords & what) != 0;
}

// Return the index where words begin. pair: index of the pair's first sample among all samples of the band.
int stages_at(int pair)
{
    return pair * kPairWords;
}
int layers_at(int pixel)
{
    int samples = recorded(kGpuRecordStages) ? frame.width * pass.rows * frame.msaa : 0;
    return samples * kPairWords + pixel * kLayerWords;
}
int color_at(int pair)
{
    return layers_at(recorded(kGpuRecordLayers) ? frame.width * pass.rows : 0) + 3 * pair;
}

#ifdef BN_RECORDS_WRITTEN
// Stores a pair's colour.
void record_color(int pair, vec3 color)
{
    for (int c = 0; c < 3; ++c) {
        if (recorded(kGpuRecordStages))
            records[stages_at(pair) + kPairWords - 3 + c] = floatBitsToInt(color[c]);
        if (recorded(kGpuRecordColors))
            records[color_at(pair) + c] = floatBitsToInt(color[c]);
    }
}
#endif

#endif
