// Linearly transformed cosines (LTC) for an anisotropic GGX lobe seen from one eye, from a baked table (shading/bake/ltc).
// Heitz, Dupuy, Hill, Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines"; the
// four-dimensional table: KT, Heitz, Dupuy, Narayanan 2022, "Bringing Linearly Transformed Cosines to Anisotropic GGX".
//
// Ellipse frame: x and y are the axes of alpha_x and alpha_y, z is the normal. Cosine's space: the lobe is max(z, 0) / pi
// there. The matrix M maps the cosine's space to the ellipse frame. Its inverse N maps lights the other way. The density of
// a direction l is, with u = N l,
//    q(l) = max(u.z, 0) |det N| / (pi |u|^4).
//
// The table holds eyes in one quadrant and alpha_x >= alpha_y. Other eyes are mirrored into the quadrant and their matrices
// back: rows change sign or place, which negates the determinant each time.
#ifndef BN_LTC_TABLE_K_H
#define BN_LTC_TABLE_K_H
#include "shading/kernels/math.k.h"
#include "shading/kernels/texel_rows.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct ltc_table {       // uniform; LtcTableRecord
    texel_buffer texels; // ltc::table_texels()
    int root_alpha;      // 1: nodes are uniform in the square root of alpha, 0: in alpha
    int basis;           // frame of the entries, 0: the ellipse frame, 1: the mirror direction, 2: the natural matrix
    int over_alpha;      // 1: the first two columns are divided by alpha
    int inverse;         // 1: entries are N, in the ellipse frame
    int alphas;          // nodes along alpha, 8 of them up to 1; 8 along the other axes
};

// A place in the table. Widths outside [0.002, 2], ratios outside [0.02, 1] and cosines below 0.02 are clamped to the
// border: floats cannot tell narrower lobes from a mirror. NaN counts as a border, too.
struct ltc_place {
    real3 eye;           // in the table's quadrant: unit, x and y >= 0
    real theta, phi;     // the eye's angles, [0, pi/2] rad
    real alpha, lambda;  // the greater width, along the table's x; the smaller over the greater
    real sign_x, sign_y; // 1 or -1: the eye's signs in the ellipse frame
    mask swapped;        // the greater width is alpha_y
};

struct ltc_lobe {
    real3 m0, m1, m2;  // columns of M; m2 is nearly unit
    real3 n0, n1, n2;  // rows of N
    real det;          // det M; negative where M mirrors
    real all, grazing; // albedo for Fresnel 1, and for (1 - v.h)^5: reflectance f0 all + (f90 - f0) grazing
};

// Finds the eye's place in the table. eye: unit, in the ellipse frame.
BN_FN ltc_place ltc_place_of(real3 eye, real alpha_x, real alpha_y)
{
    ltc_place p;
    real wide_x = min(max(alpha_x, lit(1e-6)), lit(2.0));
    real wide_y = min(max(alpha_y, lit(1e-6)), lit(2.0));
    p.swapped = wide_y > wide_x;
    real wider = max(wide_x, wide_y);
    real ratio = min(wide_x, wide_y) / wider;
    p.alpha = max(wider, lit(0.002));
    p.lambda = max(ratio, lit(0.02));
    p.sign_x = select(eye.x < lit(0.0), lit(-1.0), lit(1.0));
    p.sign_y = select(eye.y < lit(0.0), lit(-1.0), lit(1.0));
    real across_x = min(abs(eye.x), lit(1.0));
    real across_y = min(abs(eye.y), lit(1.0));
    real x = select(p.swapped, across_y, across_x);
    real y = select(p.swapped, across_x, across_y);
    real flat2 = x * x + y * y;
    real flat_length = sqrt(max(flat2, lit(1e-12)));
    mask upright = flat2 < lit(1e-12); // here all azimuths are equal
    real cosine = select(upright, lit(1.0), x / flat_length);
    real sine = select(upright, lit(0.0), y / flat_length);
    // Do not derive the radius from z near 1: its rounding would turn the eye.
    mask above = eye.z > lit(0.02);
    real z = select(above, min(eye.z, lit(1.0)), lit(0.02));
    real radius = select(above, min(flat_length, lit(1.0)), lit(0.99979998));
    p.eye = vec3_of(radius * cosine, radius * sine, z);
    p.theta = k_atan2_above(radius, z);
    p.phi = k_atan2_above(sine, cosine);
    return p;
}

// Returns the natural matrix: the first-order turn of the mirror direction by slopes, as columns of M. It is near the fit
// for small widths. At grazing views the second order keeps the first two columns apart.
BN_FN ltc_lobe ltc_natural(ltc_lobe lobe, ltc_place p)
{
    ltc_lobe r = lobe;
    real alpha_y = p.alpha * p.lambda;
    real twice_x = lit(2.0) * p.alpha;
    real twice_y = lit(2.0) * alpha_y;
    real flat2 = p.eye.x * p.eye.x + p.eye.y * p.eye.y;
    mask upright = flat2 < lit(1e-12);
    real scale = lit(1.0) / sqrt(max(flat2, lit(1e-12)));
    real c = select(upright, lit(1.0), p.eye.x * scale);
    real s = select(upright, lit(0.0), p.eye.y * scale);
    real cy = c * alpha_y;
    real sx = s * p.alpha;
    real both_widths = p.alpha * alpha_y;
    real across2 = lit(0.5) * both_widths * both_widths / (cy * cy + sx * sx);
    real mixed = across2 * s * c;
    r.m0 = vec3_of(twice_x * p.eye.z + across2 * s * s, -mixed, twice_x * p.eye.x);
    r.m1 = vec3_of(-mixed, twice_y * p.eye.z + across2 * c * c, twice_y * p.eye.y);
    r.m2 = vec3_of(-p.eye.x, -p.eye.y, p.eye.z);
    return r;
}

struct ltc_cell {  // a cell has 16 nodes
    integer first; // node of least theta, phi, alpha, lambda: ((theta 8 + phi) alphas + alpha) 8 + lambda
    real u_theta, u_phi, u_alpha, u_lambda;
};

BN_FN ltc_cell ltc_cell_of(ltc_table table, ltc_place p)
{
    real alpha = p.alpha;
    if (table.root_alpha != 0) {
        alpha = sqrt(p.alpha);
    }
    real theta_at = p.theta * lit(4.4563384065730693); // 7 / (pi / 2)
    real phi_at = p.phi * lit(4.4563384065730693);
    real alpha_at = alpha * lit(7.0);
    real lambda_at = p.lambda * lit(7.0);
    integer i = min(to_int(theta_at), int_lit(6));
    integer j = min(to_int(phi_at), int_lit(6));
    integer k = min(to_int(alpha_at), int_lit(table.alphas - 2));
    integer l = min(to_int(lambda_at), int_lit(6));
    ltc_cell c;
    c.first = (shl(i, 3) + j) * int_lit(8 * table.alphas) + shl(k, 3) + l;
    c.u_theta = min(theta_at - to_real(i), lit(1.0));
    c.u_phi = min(phi_at - to_real(j), lit(1.0));
    c.u_alpha = min(alpha_at - to_real(k), lit(1.0));
    c.u_lambda = lambda_at - to_real(l);
    return c;
}

// Returns the table's channels in a cell, interpolated, in planes of four.
BN_FN texel_planes ltc_channels(ltc_table table, ltc_cell c)
{
    int azimuth = 8 * table.alphas; // stride between azimuth nodes
    real up = c.u_theta * c.u_phi;
    real weight[4]; // by theta and phi
    weight[2] = c.u_theta - up;
    weight[1] = c.u_phi - up;
    weight[0] = lit(1.0) - c.u_theta - weight[1];
    weight[3] = up;
    texel_cell at;
    at.first = c.first;
    at.row = 8; // stride of alpha nodes; columns are nodes of lambda
    at.plane = 64 * azimuth;
    at.pair[0] = 0;
    at.pair[1] = azimuth;
    at.pair[2] = 8 * azimuth;
    at.pair[3] = 9 * azimuth;
    for (int k = 0; k < 4; ++k) {
        real lower = weight[k] * c.u_alpha;
        real upper = weight[k] - lower;
        at.w10[k] = upper * c.u_lambda;
        at.w11[k] = lower * c.u_lambda;
        at.w00[k] = upper - at.w10[k];
        at.w01[k] = lower - at.w11[k];
    }
    return texel_cell_value(table.texels, at);
}

// Transforms a column of the table's matrix to the place's ellipse frame.
BN_FN real3 ltc_shown(ltc_table table, ltc_lobe natural, ltc_place p, real3 column)
{
    real3 r = column;
    if (table.basis == 1) { // the shortest turn from the normal to the mirror direction m2
        real x = natural.m2.x;
        real y = natural.m2.y;
        real s = lit(1.0) / (lit(1.0) + p.eye.z);
        real towards = x * column.x + y * column.y;
        real back = column.z - s * towards;
        r = vec3_of(column.x + x * back, column.y + y * back, p.eye.z * column.z - towards);
    }
    if (table.basis == 2) {
        r = natural.m0 * column.x + natural.m1 * column.y + natural.m2 * column.z;
    }
    return r;
}

// Maps a vector from the table's quadrant to the ellipse frame.
BN_FN real3 ltc_unfolded(ltc_place p, real3 v)
{
    real x = select(p.swapped, v.y, v.x);
    real y = select(p.swapped, v.x, v.y);
    return vec3_of(p.sign_x * x, p.sign_y * y, v.z);
}

// Fills N and the determinant of an M with nonzero determinant.
BN_FN ltc_lobe ltc_inverted(ltc_lobe lobe)
{
    ltc_lobe r = lobe;
    real3 row0 = k_cross(lobe.m1, lobe.m2);
    real3 row1 = k_cross(lobe.m2, lobe.m0);
    real3 row2 = k_cross(lobe.m0, lobe.m1);
    r.det = k_dot3(lobe.m0, row0);
    real scale = lit(1.0) / r.det;
    r.n0 = row0 * scale;
    r.n1 = row1 * scale;
    r.n2 = row2 * scale;
    return r;
}

// Looks up the lobe. eye: unit, in the ellipse frame. The natural matrix replaces a table matrix without positive
// determinant.
BN_FN ltc_lobe ltc_lookup(ltc_table table, real3 eye, real alpha_x, real alpha_y)
{
    // Fetch the table's channels
    ltc_place p = ltc_place_of(eye, alpha_x, alpha_y);
    ltc_cell cell = ltc_cell_of(table, p);
    texel_planes channels = ltc_channels(table, cell);
    real4 a = channels.plane[0];
    real4 b = channels.plane[1];
    real4 c = channels.plane[2];
    ltc_lobe lobe;
    lobe.all = k_saturate(c.y);
    lobe.grazing = k_saturate(c.z);
    lobe.m0 = vec3_all(lit(0.0)); // copied below
    lobe.m1 = lobe.m0;
    lobe.m2 = vec3_of(-p.eye.x, -p.eye.y, p.eye.z);
    lobe.n0 = lobe.m0;
    lobe.n1 = lobe.m0;
    lobe.n2 = lobe.m0;
    lobe.det = lit(0.0);
    ltc_lobe natural = lobe;
    if (table.basis == 2) {
        natural = ltc_natural(lobe, p);
    }
    // Unpack the matrix, and invert it where the table holds N
    real3 m0 = vec3_of(a.x, a.w, b.z);
    real3 m1 = vec3_of(a.y, b.x, b.w);
    real3 m2 = vec3_of(a.z, b.y, c.x);
    if (table.inverse != 0) { // of N its cofactors, transposed
        ltc_lobe n = lobe;
        n.m0 = m0;
        n.m1 = m1;
        n.m2 = m2;
        n = ltc_inverted(n);
        m0 = vec3_of(n.n0.x, n.n1.x, n.n2.x);
        m1 = vec3_of(n.n0.y, n.n1.y, n.n2.y);
        m2 = vec3_of(n.n0.z, n.n1.z, n.n2.z);
    }
    if (table.over_alpha != 0) {
        m0 = m0 * p.alpha;
        m1 = m1 * p.alpha;
    }
    // Transform the columns to the ellipse frame
    lobe.m0 = ltc_shown(table, natural, p, m0);
    lobe.m1 = ltc_shown(table, natural, p, m1);
    lobe.m2 = ltc_shown(table, natural, p, m2);
    // Replace a degenerate matrix by the natural one
    real det = k_dot3(lobe.m0, k_cross(lobe.m1, lobe.m2));
    mask usable = det > lit(1e-9);
    if (any_lane(not_(usable))) {
        natural = ltc_natural(lobe, p);
        lobe.m0 = select(usable, lobe.m0, natural.m0);
        lobe.m1 = select(usable, lobe.m1, natural.m1);
        lobe.m2 = select(usable, lobe.m2, natural.m2);
    }
    // Undo the mirroring
    lobe.m0 = ltc_unfolded(p, lobe.m0);
    lobe.m1 = ltc_unfolded(p, lobe.m1);
    lobe.m2 = ltc_unfolded(p, lobe.m2);
    return ltc_inverted(lobe);
}

// Looks up a round lobe in a table with 64 uniform nodes in sqrt(1 - cos theta) and 64 in sqrt(alpha). Two planes of RGBA
// halves hold the albedos and five elements of the matrix, in the frame whose x the eye leans to (columns' x x, y y, z x, x
// z; z z). first: the table's first texel.
BN_FN ltc_lobe ltc_round_lookup(texel_buffer texels, int first, real3 eye, real alpha)
{
    real flat2 = eye.x * eye.x + eye.y * eye.y;
    mask upright = flat2 < lit(1e-12);
    real flat_length = sqrt(max(flat2, lit(1e-12)));
    real cosine = select(upright, lit(1.0), eye.x / flat_length);
    real sine = select(upright, lit(0.0), eye.y / flat_length);
    mask above = eye.z > lit(0.02);
    real fall = select(above, min(flat2, lit(1.0)), lit(0.9996)) / (lit(1.0) + select(above, eye.z, lit(0.02)));
    real theta_at = sqrt(fall) * lit(63.0);
    real alpha_at = sqrt(min(max(alpha, lit(0.002)), lit(1.0))) * lit(63.0);
    integer i = min(to_int(theta_at), int_lit(62));
    integer k = min(to_int(alpha_at), int_lit(62));
    real u = min(theta_at - to_real(i), lit(1.0));
    real v = alpha_at - to_real(k);
    texel_rows r;
    r.w11 = u * v;
    r.w01 = u - r.w11;
    r.w10 = v - r.w11;
    r.w00 = lit(1.0) - u - r.w10;
    r.row0 = shl(i, 6) + k + int_lit(first);
    r.row1 = r.row0 + int_lit(64);
    real4 a = texel_value(texel_rows_add(texel_zero(), texels, r));
    r.row0 = r.row0 + int_lit(4096);
    r.row1 = r.row1 + int_lit(4096);
    real4 b = texel_value(texel_rows_add(texel_zero(), texels, r));
    ltc_lobe lobe;
    lobe.m0 = vec3_of(a.x * cosine, a.x * sine, a.z);
    lobe.m1 = vec3_of(-(a.y * sine), a.y * cosine, lit(0.0));
    lobe.m2 = vec3_of(a.w * cosine, a.w * sine, b.x);
    lobe.all = k_saturate(b.y);
    lobe.grazing = k_saturate(b.z);
    return ltc_inverted(lobe);
}

// Returns the plain cosine about the normal: the lobe of a diffuse surface.
BN_FN ltc_lobe ltc_cosine()
{
    ltc_lobe lobe;
    lobe.m0 = vec3_of(lit(1.0), lit(0.0), lit(0.0));
    lobe.m1 = vec3_of(lit(0.0), lit(1.0), lit(0.0));
    lobe.m2 = vec3_of(lit(0.0), lit(0.0), lit(1.0));
    lobe.n0 = lobe.m0;
    lobe.n1 = lobe.m1;
    lobe.n2 = lobe.m2;
    lobe.det = lit(1.0);
    lobe.all = lit(1.0);
    lobe.grazing = lit(0.0);
    return lobe;
}

// Returns N p: transforms from the ellipse frame to the cosine's space.
BN_FN real3 ltc_to_cosine(BN_IN(ltc_lobe) lobe, real3 p)
{
    return vec3_of(k_dot3(lobe.n0, p), k_dot3(lobe.n1, p), k_dot3(lobe.n2, p));
}

// Returns M^T n for a normal n, a cross product of two vectors in the ellipse frame. Divided by det(M), the result is the
// cross product in the cosine's space. It keeps digits that a product of stretched vectors loses.
BN_FN real3 ltc_normal_to_cosine(BN_IN(ltc_lobe) lobe, real3 n)
{
    return vec3_of(k_dot3(lobe.m0, n), k_dot3(lobe.m1, n), k_dot3(lobe.m2, n));
}

// Returns the lobe's density q at l, 1/sr. l: unit, in the ellipse frame.
BN_FN real ltc_density(BN_IN(ltc_lobe) lobe, real3 l)
{
    real3 u = ltc_to_cosine(lobe, l);
    real length2 = max(k_dot3(u, u), lit(1e-12));
    real above = max(u.z, lit(0.0));
    return above * lit(0.31830988618379067) / (abs(lobe.det) * length2 * length2);
}

BN_KERNELS_END
#endif
