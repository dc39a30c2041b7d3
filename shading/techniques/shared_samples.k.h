// Interleaved sampling: Keller and Heidrich 2001, "Interleaved Sampling". In each 2x2 quad of pixels, samples lie in four
// different places of their cells. A fragment averages its results with results of fragments with similar lobes in the 3x3
// pixels around it, which gives four times the samples for the same price. Weights at the window's sides are one half, so
// each of the four places counts the same wherever the window lies, and no quad shows. The environment is infinitely far
// away, so only the direction, length and width of lobes tell two fragments apart.
#ifndef BN_SHARED_SAMPLES_K_H
#define BN_SHARED_SAMPLES_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct shared_sample_record { // a fragment's, 16 words
    real3 light;              // mean radiance along its line
    real width;               // the lobe's width across the grain, alpha; below 0: the colour is `rest`, nothing is shared
    real3 mirror, along;      // the lobe's mirror direction, unit, and its line at z = 1 (lobe_line); both world space
    real3 factor, rest;       // colour = light * factor + rest
};

// Returns the place of a pixel's sample in its cell, (0,1). odd_x, odd_y: 0 or 1.
BN_FN real quad_offset(integer odd_x, integer odd_y)
{
    real half_x = to_real(odd_x) * lit(0.5);
    return select(odd_y == int_lit(0), lit(0.125) + half_x, lit(0.875) - half_x);
}

// Returns the weight of a pixel in the window. dx, dy: its distance from the middle, -1 to 1.
BN_FN real window_weight(int dx, int dy)
{
    return lit(dx == 0 ? 1.0 : 0.5) * lit(dy == 0 ? 1.0 : 0.5);
}

// Returns the similarity of two lobes, the weight of b's light for a, [0,1]: 1 for equal lobes. Across the line the weight
// falls to 0 at .7 of the lobe's width and of an eighth of its length at z = 1, added as squares. That eighth is the spacing
// of sixteen samples in its middle. Along the line the weight falls to 0 at .7 of the width and of half the length, over
// which light spreads. So a fragment takes from others what its own samples do not resolve.
BN_FN real record_similarity(shared_sample_record a, shared_sample_record b)
{
    real3 turn = (a.mirror - b.mirror) * lit(0.5); // as slopes: a mirror turns twice as far as its normal
    real3 same = a.along - b.along;
    real3 opposite = a.along + b.along; // the line has no sign
    real bend = min(k_dot3(same, same), k_dot3(opposite, opposite));
    real wider = a.width - b.width;
    real narrow = min(a.width, b.width);
    real narrow2 = max(narrow * narrow, lit(1e-20));
    // Measure the distance along and across a's line
    real long2 = k_dot3(a.along, a.along);
    real along = k_dot3(turn, a.along);
    real along2 = along * along / max(long2, lit(1e-20));
    real across2 = max(k_dot3(turn, turn) - along2, lit(0.0)) + bend + wider * wider;
    real apart = across2 / (narrow2 + long2 * lit(0.015625)) + along2 / (narrow2 + long2 * lit(0.25));
    return max(lit(1.0) - lit(2.0) * apart, lit(0.0));
}

// Makes the record of a colour that shares no samples.
BN_FN shared_sample_record unshared_record(real3 colour)
{
    shared_sample_record r;
    r.light = vec3_all(lit(0.0));
    r.width = lit(-1.0);
    r.mirror = r.light;
    r.along = r.light;
    r.factor = r.light;
    r.rest = colour;
    return r;
}

// A pixel's part that its neighbours see: the place of its first record, and the mean light of all its records that are similar
// to the first. Triangles of one surface thus count as one.
struct shared_pixel {
    shared_sample_record record;
    real cover; // share of the pixel, [0,1]; 0: the pixel shares nothing
};

BN_FN shared_pixel shared_pixel_begin()
{
    shared_pixel r;
    r.record = unshared_record(vec3_all(lit(0.0)));
    r.cover = lit(0.0);
    return r;
}

// Adds the pixel's next record. cover: its share of the pixel; 0 where it shares nothing. Until shared_pixel_end(), `light`
// holds a sum.
BN_FN shared_pixel shared_pixel_add(shared_pixel p, shared_sample_record r, real cover)
{
    mask shares = cover > lit(0.0);
    mask first = both(shares, p.cover <= lit(0.0));
    real alike = select(first, lit(1.0), record_similarity(p.record, r));
    real w = select(shares, alike * cover, lit(0.0));
    shared_pixel sum;
    sum.record = p.record;
    sum.record.width = select(first, r.width, p.record.width);
    sum.record.mirror = select(first, r.mirror, p.record.mirror);
    sum.record.along = select(first, r.along, p.record.along);
    sum.record.light = select(shares, p.record.light + r.light * w, p.record.light);
    sum.cover = p.cover + w;
    return sum;
}

BN_FN shared_pixel shared_pixel_end(shared_pixel p)
{
    p.record.light = p.record.light / max(p.cover, lit(1e-20));
    return p;
}

// Mean over a window, weighted by similarity, by covered shares of pixels, and by places in the window.
struct shared_sample_mean {
    real3 sum;
    real weights;
};

BN_FN shared_sample_mean shared_sample_mean_begin(shared_sample_record own)
{
    shared_sample_mean r;
    r.sum = own.light;
    r.weights = lit(1.0);
    return r;
}

// Adds another pixel. cover: of shared_pixel; weight: the pixel's in the window.
BN_FN shared_sample_mean shared_sample_mean_add(shared_sample_mean mean, shared_sample_record own, shared_sample_record other, real cover,
                                                real weight)
{
    real alike = record_similarity(own, other) * (cover * weight);
    mask shares = cover > lit(0.0);
    real w = select(shares, alike, lit(0.0));
    shared_sample_mean r;
    r.sum = select(shares, mean.sum + other.light * w, mean.sum);
    r.weights = mean.weights + w;
    return r;
}

BN_FN real3 shared_sample_mean_light(shared_sample_mean mean)
{
    return mean.sum / mean.weights;
}

// Returns a fragment's colour. light: mean over its pixel's window; pixel: its pixel's record. A fragment unlike its pixel's
// first keeps its own light.
BN_FN real3 shared_sample_colour(shared_sample_record r, real3 light, shared_sample_record pixel)
{
    real alike = record_similarity(pixel, r);
    real3 blend = r.light + (light - r.light) * alike;
    real3 mean = select(alike >= lit(1.0), light, blend);
    return select(r.width >= lit(0.0), mean * r.factor + r.rest, r.rest);
}

// A record as 16 words.
struct shared_sample_words {
    real at[16];
};

BN_FN shared_sample_words words_of_shared_sample(shared_sample_record r)
{
    shared_sample_words w;
    w.at[0] = r.width;
    w.at[1] = r.light.x;
    w.at[2] = r.light.y;
    w.at[3] = r.light.z;
    w.at[4] = r.mirror.x;
    w.at[5] = r.mirror.y;
    w.at[6] = r.mirror.z;
    w.at[7] = r.along.x;
    w.at[8] = r.along.y;
    w.at[9] = r.along.z;
    w.at[10] = r.factor.x;
    w.at[11] = r.factor.y;
    w.at[12] = r.factor.z;
    w.at[13] = r.rest.x;
    w.at[14] = r.rest.y;
    w.at[15] = r.rest.z;
    return w;
}

BN_FN shared_sample_record shared_sample_of_words(shared_sample_words w)
{
    shared_sample_record r;
    r.width = w.at[0];
    r.light = vec3_of(w.at[1], w.at[2], w.at[3]);
    r.mirror = vec3_of(w.at[4], w.at[5], w.at[6]);
    r.along = vec3_of(w.at[7], w.at[8], w.at[9]);
    r.factor = vec3_of(w.at[10], w.at[11], w.at[12]);
    r.rest = vec3_of(w.at[13], w.at[14], w.at[15]);
    return r;
}

BN_KERNELS_END

#endif
