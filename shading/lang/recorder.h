// Where assembly puts recorded words.
//   recorder w; put_real(w, x)   takes x as the next word
// In C++ who includes assembly has them; in GLSL a recorder is the next word's place.
#ifndef BN_RECORDER_H
#define BN_RECORDER_H

#ifdef __cplusplus
#define recorder auto
#else
#include "shading/stages/recorder.glsl"
#endif

#endif
