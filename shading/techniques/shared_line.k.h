// Samples shared in a 2x2 quad of pixels. Each fragment's samples lie elsewhere in their cells; fragments that see alike lobes average what
// all of them found, four times as many samples for the price of one's: Keller and Heidrich 2001, "Interleaved Sampling". Light
// comes from afar, so all that tells two fragments apart is where their lobes look, how long they are and how wide.
#ifndef BN_SHARED_LINE_K_H
#define BN_SHARED_LINE_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct line_record {     // of a fragment: 16 words
    real3 light;         // mean radiance along its line
    real width;          // of its lobe across the grain, alpha; below 0: the colour is `rest`, nothing is shared
    real3 mirror, along; // where its lobe looks, unit, and its line at z = 1 (lobe_line), both world space
    real3 factor, rest;  // colour = light * factor + rest
};

// Where in its cell a sample of a pixel lies, (0,1). odd_x, odd_y: 0 or 1.
BN_FN real quad_offset(integer odd_x, integer odd_y)
{
    real half_x = to_real(odd_x) * lit(0.5);
    return select(odd_y == int_lit(0), lit(0.125) + half_x, lit(0.875) - half_x);
}

// How much of b's light is a's, [0,1]: all of it where they see the same lobe; nothing from one width across the line on, or from half of
// its length along it, where light is spread that far.
BN_FN real line_likeness(line_record a, line_record b)
{
    real3 turn = (a.mirror - b.mirror) * lit(0.5); // as slopes: a mirror turns twice as far as its normal
    real3 same = a.along - b.along;
    real3 opposite = a.along + b.along; // the other end is as good
    real bend = min(k_dot3(same, same), k_dot3(opposite, opposite));
    real wider = a.width - b.width;
    real narrow = min(a.width, b.width);
    real narrow2 = max(narrow * narrow, lit(1e-20));
    real long2 = k_dot3(a.along, a.along);
    real along = k_dot3(turn, a.along);
    real along2 = along * along / max(long2, lit(1e-20));
    real across2 = max(k_dot3(turn, turn) - along2, lit(0.0)) + bend + wider * wider;
    real apart = across2 / narrow2 + along2 / (narrow2 + long2 * lit(0.25));
    return max(lit(1.0) - apart, lit(0.0));
}

BN_FN real3 line_colour(line_record r, real3 light)
{
    return light * r.factor + r.rest;
}

BN_KERNELS_END

#endif
