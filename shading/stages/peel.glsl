// Blended layers by sample of a band, [pixel of the band][sample][kGpuPeelWords].
#ifndef BN_PEEL_GLSL
#define BN_PEEL_GLSL

#ifndef BN_PEEL_ACCESS
#define BN_PEEL_ACCESS readonly
#endif
layout(std430, set = 0, binding = 17) BN_PEEL_ACCESS buffer BnPeel { float peel[]; };

const int kPeelSolidDepth = 0, kPeelSolidId = 1, kPeelDepth = 2, kPeelId = 3, kPeelThrough = 4, kPeelOver = 5, kPeelBehind = 8, kPeelShown = 11;

#endif
