// Number of words that recorded stages hold per visible (pixel, triangle) pair, and that layers hold per pixel. One text
// for C++ and GLSL.
#ifndef BN_RECORDED_H
#define BN_RECORDED_H

#ifdef __cplusplus
namespace burnish {
#endif

const int kInterpolantWords = 0
#define BN_POINT(type, words, name, asked) +words
#define BN_INTERPOLATED(type, words, name, asked, first) +words
#include "shading/visible_point.def"
    ;
const int kMaterialWords = 0
#define BN_INPUT(type, words, name) +words
#include "shading/material.def"
    ;
const int kPairWords = 1 + kInterpolantWords + kMaterialWords + 3; // sample mask, interpolants, material inputs, colour
const int kLayerWords = 0
#define BN_LAYER(type, words, name, channels) +words
#include "shading/layers.def"
    ;

#ifdef __cplusplus
}
#endif

#endif
