// Four texels and their weights: the loads of one bilinear fetch from a cube or a texture.
#ifndef BN_TEXEL_ROWS_K_H
#define BN_TEXEL_ROWS_K_H
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Left texels of two horizontal pairs, and the weights w<column><row>.
struct texel_rows {
    integer row0, row1;
    real w00, w10, w01, w11;
};

BN_FN texel_acc texel_rows_add(texel_acc acc, texel_buffer texels, texel_rows r)
{
    return texel_add(acc, texels, r.row0, r.row1, r.w00, r.w10, r.w01, r.w11);
}

BN_KERNELS_END
#endif
