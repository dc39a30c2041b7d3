// The kernel language in GLSL 4.6 (see lang.h). `precise` on every type forbids fusing and reordering. A stage may define
// BN_LANG_SET (descriptor set, default 0) and BN_LANG_BINDING (first of three bindings, default 0) before the include.
// Unused buffers need not be bound.
#ifndef BN_GLSL_H
#define BN_GLSL_H

#ifndef BN_LANG_SET
#define BN_LANG_SET 0
#endif
#ifndef BN_LANG_BINDING
#define BN_LANG_BINDING 0
#endif

#define BN_FN
#define BN_STAGE
#define BN_IN(T) T
#define BN_INOUT(T) inout T
#define BN_KERNELS_BEGIN
#define BN_KERNELS_END

#define real precise float
#define uniform_real precise float
#define real2 precise vec2
#define real3 precise vec3
#define real4 precise vec4
#define integer precise int
#define mask precise bool
#define any_wide precise double

#define lit(x) (x)
#define int_lit(x) (x)
#define splat(x) (x)
#define vec2_of vec2
#define vec3_of vec3
#define vec4_of vec4
#define vec2_all vec2
#define vec3_all vec3
#define vec4_all vec4

#define to_real(i) float(i)
#define to_wide(x) double(x)
#define wide_like(w, x) double(x)
#define to_int(x) int(x)
#define round_to_int(x) int(roundEven(x))
#define bits_of(x) floatBitsToInt(x)
#define real_from_bits(i) intBitsToFloat(i)
#define shl(i, n) ((i) << (n))
#define shr(i, n) ((i) >> (n))
#define shr_logical(i, n) int(uint(i) >> (n))
#define both(a, b) ((a) && (b))
#define either(a, b) ((a) || (b))
#define not_(a) (!(a))
#define any_lane(m) (m)
#define no_lane(m) (!(m))
#define most_of_lanes(x) (x)

real select(mask m, real a, real b)
{
    return m ? a : b;
}
real2 select(mask m, real2 a, real2 b)
{
    return m ? a : b;
}
real3 select(mask m, real3 a, real3 b)
{
    return m ? a : b;
}
real4 select(mask m, real4 a, real4 b)
{
    return m ? a : b;
}
integer select(mask m, integer a, integer b)
{
    return m ? a : b;
}
mask select(mask m, mask a, mask b)
{
    return m ? a : b;
}

// GLSL leaves NaN and the order of zeros in min and max to the implementation, so these replace them.
real bn_min(real a, real b)
{
    return a < b ? a : b;
}
integer bn_min(integer a, integer b)
{
    return a < b ? a : b;
}
real2 bn_min(real2 a, real2 b)
{
    return vec2(bn_min(a.x, b.x), bn_min(a.y, b.y));
}
real3 bn_min(real3 a, real3 b)
{
    return vec3(bn_min(a.x, b.x), bn_min(a.y, b.y), bn_min(a.z, b.z));
}
real4 bn_min(real4 a, real4 b)
{
    return vec4(bn_min(a.x, b.x), bn_min(a.y, b.y), bn_min(a.z, b.z), bn_min(a.w, b.w));
}
real bn_max(real a, real b)
{
    return a > b ? a : b;
}
integer bn_max(integer a, integer b)
{
    return a > b ? a : b;
}
real2 bn_max(real2 a, real2 b)
{
    return vec2(bn_max(a.x, b.x), bn_max(a.y, b.y));
}
real3 bn_max(real3 a, real3 b)
{
    return vec3(bn_max(a.x, b.x), bn_max(a.y, b.y), bn_max(a.z, b.z));
}
real4 bn_max(real4 a, real4 b)
{
    return vec4(bn_max(a.x, b.x), bn_max(a.y, b.y), bn_max(a.z, b.z), bn_max(a.w, b.w));
}
#define min bn_min
#define max bn_max
real bn_clamp(real x, real lo, real hi)
{
    return min(max(x, lo), hi);
}
integer bn_clamp(integer x, integer lo, integer hi)
{
    return min(max(x, lo), hi);
}
real2 bn_clamp(real2 x, real2 lo, real2 hi)
{
    return min(max(x, lo), hi);
}
real3 bn_clamp(real3 x, real3 lo, real3 hi)
{
    return min(max(x, lo), hi);
}
real4 bn_clamp(real4 x, real4 lo, real4 hi)
{
    return min(max(x, lo), hi);
}
#define clamp bn_clamp

// Pointers of C++ are indices here: the first element's index in one of three buffers. All textures together can exceed the
// largest buffer. With BN_TEXEL_PAGES a texel_buffer is a page number, and the first buffer holds the page's address. Such
// a stage requires GL_EXT_buffer_reference_uvec2.
#ifdef BN_TEXEL_PAGES
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer BnTexelPage
{
    uvec2 texels[];
};
layout(std430, set = BN_LANG_SET, binding = BN_LANG_BINDING) readonly buffer BnTexels
{
    uvec2 bn_pages[];
};
#define bn_texel_words(page, at) BnTexelPage(bn_pages[page]).texels[at]
#else
layout(std430, set = BN_LANG_SET, binding = BN_LANG_BINDING) readonly buffer BnTexels
{
    uvec2 bn_texels[];
};
#define bn_texel_words(first, at) bn_texels[(first) + (at)]
#endif
layout(std430, set = BN_LANG_SET, binding = BN_LANG_BINDING + 1) readonly buffer BnReals
{
    float bn_reals[];
};
layout(std430, set = BN_LANG_SET, binding = BN_LANG_BINDING + 2) readonly buffer BnInts
{
    int bn_ints[];
};
#define texel_buffer int
#define pair_table int // stored in the texel buffer, a pair of floats per texel
#define real_table int
#define int_table int

real table_value(real_table table, integer index)
{
    return bn_reals[table + index];
}
integer table_int(int_table table, integer index)
{
    return bn_ints[table + index];
}

real4 pairs_at(pair_table table, integer index)
{
    return vec4(uintBitsToFloat(bn_texel_words(table, index)), uintBitsToFloat(bn_texel_words(table, index + 1)));
}

struct texel_acc {
    real4 left;
    real4 right;
};
#ifndef BN_OWN_TEXELS // a stage may define bn_texel() before
real4 bn_texel(texel_buffer texels, int at)
{
    uvec2 words = bn_texel_words(texels, at);
    return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y));
}
#endif
texel_acc texel_zero()
{
    return texel_acc(vec4(0.0), vec4(0.0));
}
texel_acc texel_add(texel_acc acc, texel_buffer texels, integer row0, integer row1, real w00, real w10, real w01, real w11)
{
    real4 left = acc.left + (w00 * bn_texel(texels, row0) + w01 * bn_texel(texels, row1));
    real4 right = acc.right + (w10 * bn_texel(texels, row0 + 1) + w11 * bn_texel(texels, row1 + 1));
    return texel_acc(left, right);
}
real4 texel_value(texel_acc acc)
{
    return acc.left + acc.right;
}

struct texel_cell {
    integer first;
    int pair[4];
    int row;
    int plane;
    real w00[4];
    real w10[4];
    real w01[4];
    real w11[4];
};
struct texel_planes {
    real4 plane[3];
};
texel_planes texel_cell_value(texel_buffer texels, texel_cell cell)
{
    texel_planes r;
    for (int plane = 0; plane < 3; ++plane) {
        texel_acc acc = texel_zero();
        for (int k = 0; k < 4; ++k) {
            int row0 = cell.first + plane * cell.plane + cell.pair[k];
            acc = texel_add(acc, texels, row0, row0 + cell.row, cell.w00[k], cell.w10[k], cell.w01[k], cell.w11[k]);
        }
        r.plane[plane] = texel_value(acc);
    }
    return r;
}

#endif
