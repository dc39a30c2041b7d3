// The pixels that a range on the sub-pixel grid can touch.
#ifndef BN_PIXEL_RANGE_K_H
#define BN_PIXEL_RANGE_K_H

#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct pixel_range { // pixels in the image, inclusive; empty where first > last
    integer first, last;
};

// Returns the pixels, in an image with `size` pixels along an axis, that have a sample in lo...hi. lo, hi: 1/256 pixel from
// the centre pixel; center: 1/256 pixel from the image's first. sample_min, sample_max: range of sample positions in a
// pixel, 1/256 pixel.
BN_FN pixel_range pixels_touched(integer lo, integer hi, int center, int sample_min, int sample_max, int size)
{
    pixel_range r;
    r.first = max(shr(lo + int_lit(center - sample_max + 255), 8), int_lit(0));
    r.last = min(shr(hi + int_lit(center - sample_min), 8), int_lit(size - 1));
    return r;
}

BN_KERNELS_END

#endif
