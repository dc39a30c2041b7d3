// Recorders (shading/lang/recorder.h) in GLSL. A stage defines BN_TAKE_WORD(at, x), which stores the float x as word `at`.
#ifndef BN_RECORDER_GLSL
#define BN_RECORDER_GLSL

#include "shading/lang/interface.glsl"

#ifndef BN_TAKE_WORD // nothing reads the words
float taken_words[kPairWords];
#define BN_TAKE_WORD(at, x) taken_words[at] = x;
#endif

#define recorder int

void put_real(inout recorder w, real x)
{
    BN_TAKE_WORD(w, x)
    ++w;
}

#endif
