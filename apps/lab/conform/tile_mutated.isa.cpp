// The tile renderer's kernels with the mistakes that shading/lab/conform/mutated.h lists.
#include "shading/lab/conform/mutated.h"

#include "shading/lab/conform/gltf_bent_normal.t.h"

#include "raster/tile/tile.isa.cpp"
