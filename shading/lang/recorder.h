// Output of recorded words.
//   recorder w; put_real(w, x)   stores x as the next word
// In C++, the file that includes assembly defines both; in GLSL a recorder is the index of the next word.
#ifndef BN_RECORDER_H
#define BN_RECORDER_H

#ifdef __cplusplus
#define recorder auto
#else
#include "shading/lang/recorder.glsl"
#endif

#endif
