// Constants of one pass of the rasterizer.
#ifndef BN_PASS_GLSL
#define BN_PASS_GLSL

// Of passes that take one sample of several: where that sample lies, as a shift to the pixel's centre, and its number; -1 where the
// device itself takes all samples.
layout(push_constant) uniform BnPass {
    int shift_x, shift_y; // 1/256 pixel
    int sample_number;
    int material; // of a draw of the forward pipeline
} pass;

#endif
