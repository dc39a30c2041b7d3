// Reflectance of a thin film over a surface, with interference: the Airy sum of both interfaces by Fresnel's equations, for
// unpolarised light. Colour integrals follow Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence", section 4: Gaussian fits of the observer, one term an order of interference.
#ifndef BN_THIN_FILM_K_H
#define BN_THIN_FILM_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// An order of interference, as the observer's four Gaussians see it: X, Y and Z, and X's second one. Values of one order make the next
// order's.
struct film_order {
    real3 wave, wave_before;    // cosines of this order and the previous one
    real rest, rest_before;     // of X's second Gaussian
    real3 width, width_step;    // Gaussians of this order, and factors to the next one
    real rest_width, rest_step; // of X's second Gaussian
};

// Returns e^-x for x >= 0.
BN_FN real film_decay(real x)
{
    return k_exp2(x * lit(-1.4426950408889634));
}

// Returns order 1. path: optical path difference, nm, at least 0; beyond 12000 nm colours are mixed to white.
BN_FN film_order film_order_of(real path)
{
    real phase = min(path, lit(12000.0)) * lit(6.2831853071795865e-9); // per metre^-1
    film_order r;
    r.wave = vec3_of(k_cos(phase * lit(1.6810e6)), k_cos(phase * lit(1.7953e6)), k_cos(phase * lit(2.2084e6)));
    r.rest = k_cos(phase * lit(2.2399e6));
    r.wave_before = vec3_all(lit(1.0));
    r.rest_before = lit(1.0);
    real square = phase * phase;
    r.width = vec3_of(film_decay(square * lit(4.3278e9)), film_decay(square * lit(9.3046e9)), film_decay(square * lit(6.6121e9)));
    r.rest_width = film_decay(square * lit(4.5282e9));
    r.width_step = r.width * r.width * r.width;
    r.rest_step = r.rest_width * r.rest_width * r.rest_width;
    return r;
}

// Returns the next order: cos((m + 1) x) = 2 cos(x) cos(m x) - cos((m - 1) x), and Gaussians of squares, whose ratios grow by a constant.
BN_FN film_order film_order_next(film_order first, film_order at)
{
    film_order r = at;
    r.wave = first.wave * at.wave * lit(2.0) - at.wave_before;
    r.wave_before = at.wave;
    r.rest = first.rest * at.rest * lit(2.0) - at.rest_before;
    r.rest_before = at.rest;
    r.width = at.width * at.width_step;
    r.width_step = at.width_step * first.width * first.width;
    r.rest_width = at.rest_width * at.rest_step;
    r.rest_step = at.rest_step * first.rest_width * first.rest_width;
    return r;
}

// Returns the order's response. The factors are the Gaussians' integrals times the matrix from XYZ, each row over its sum.
BN_FN real3 film_response(film_order at)
{
    real3 seen = at.wave * at.width;
    real rest = at.rest * at.rest_width;
    real red = seen.x * lit(2.27593101) + seen.y * lit(-1.27552633) + seen.z * lit(-0.41405669) + rest * lit(0.41365200);
    real green = seen.x * lit(-0.86528950) + seen.y * lit(1.97868659) + seen.z * lit(0.04386986) + rest * lit(-0.15726695);
    real blue = seen.x * lit(0.05176555) + seen.y * lit(-0.22425166) + seen.z * lit(1.16307769) + rest * lit(0.00940842);
    return vec3_of(red, green, blue);
}

// One polarisation's share of the Airy sum.
struct film_sum {
    real3 factor; // of the order before
    real3 step;   // to the next order
    real3 value;
};

// Starts the sum. outer, inner: amplitudes that the film's outer and inner interface reflect, [-1,1].
BN_FN film_sum film_sum_of(real outer, real3 inner)
{
    real out2 = outer * outer;
    real passed = lit(1.0) - out2;
    real3 in2 = inner * inner;
    real3 left = max(vec3_all(lit(1.0)) - in2 * out2, vec3_all(lit(1e-6)));
    real3 below = in2 * (passed * passed);
    real3 returned = vec3_of(below.x / left.x, below.y / left.y, below.z / left.z);
    film_sum r;
    r.value = returned + vec3_all(out2);
    r.factor = returned - vec3_all(passed);
    r.step = inner * (-outer);
    return r;
}

// Adds an order. response: its film_response(), twice.
BN_FN film_sum film_sum_add(film_sum sum, real3 response)
{
    film_sum r = sum;
    r.factor = sum.factor * sum.step;
    r.value = sum.value + r.factor * response;
    return r;
}

// Returns the amplitude (first - second) / (first + second) of an interface, 1 where both are 0.
BN_FN real film_amplitude(real first, real second)
{
    real sum = first + second;
    return select(sum > lit(1e-12), (first - second) / max(sum, lit(1e-12)), lit(1.0));
}

// Returns the index of a surface in air from its reflectance at normal incidence.
BN_FN real film_base_index(real f0)
{
    real root = sqrt(min(max(f0, lit(0.0)), lit(0.9998)));
    return (lit(1.0) + root) / (lit(1.0) - root);
}

// Returns the film's reflectance by channel, [0,1]. v_dot_h: cosine to the microfacet, in air, [0,1]. ior: the film's, at least 1.
// thickness: nm, at least 0. f0: reflectance of the surface below in air at normal incidence, [0,1]; a real index stands for it.
BN_FN real3 thin_film_reflectance(real v_dot_h, real ior, real thickness, real3 f0)
{
    real one = lit(1.0);
    // Refract into the film and into the surface below; across: index times cosine
    real c = k_saturate(v_dot_h);
    real s2 = (one - c) * (one + c);
    real index = min(max(ior, one), lit(10.0));
    real across = sqrt(max(index * index - s2, lit(0.0)));
    real3 below = vec3_of(film_base_index(f0.x), film_base_index(f0.y), film_base_index(f0.z));
    real3 below2 = below * below;
    real3 under = vec3_of(sqrt(max(below2.x - s2, lit(0.0))), sqrt(max(below2.y - s2, lit(0.0))), sqrt(max(below2.z - s2, lit(0.0))));
    // Find amplitudes of both interfaces: perpendicular, then parallel
    real3 inner_s = vec3_of(film_amplitude(across, under.x), film_amplitude(across, under.y), film_amplitude(across, under.z));
    real3 dense = below2 * across;
    real3 thin = under * (index * index);
    real3 inner_p = vec3_of(film_amplitude(dense.x, thin.x), film_amplitude(dense.y, thin.y), film_amplitude(dense.z, thin.z));
    film_sum s = film_sum_of(film_amplitude(c, across), inner_s);
    film_sum p = film_sum_of(film_amplitude(index * index * c, across), inner_p);
    // Add four orders of interference
    film_order first = film_order_of(min(max(thickness, lit(0.0)), lit(1e6)) * across * lit(2.0));
    film_order at = first;
    for (int m = 0; m < 4; ++m) {
        real3 response = film_response(at) * lit(2.0);
        s = film_sum_add(s, response);
        p = film_sum_add(p, response);
        at = film_order_next(first, at);
    }
    return clamp((s.value + p.value) * lit(0.5), vec3_all(lit(0.0)), vec3_all(one));
}

BN_KERNELS_END

#endif
