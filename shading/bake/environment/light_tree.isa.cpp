#include <cmath>

#include "core/simd/lanes.h"
#include "shading/bake/bake_fns.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

constexpr double kHorizon = 1.41421356237309505; // a quarter turn's chord
constexpr double kPlaceError = 1e-6;             // above a place's rounding to single precision

// Adds a part to all blocks.
using Way = unsigned char;
constexpr long long take_it = 0, leave_out = 1, open_it = 2, differ = 3;

// A texel's four parts, in loops over four that compilers turn into lanes.
struct Parts {
    double x[4], y[4], z[4]; // unit directions
    double angle[4];         // sr
    Way way[4];
    int next, end; // parts still to visit
};

// A texel, whose parts lie one level below.
struct Texel {
    int level, x, y;
};

// Writes the unit directions to a finest texel's centres.
void centres(int face, int size, int x, int y, Parts& p)
{
    const double step = 2.0 / size;
    const double u[2] = {(2 * x + 0.5) * step - 1.0, (2 * x + 1 + 0.5) * step - 1.0};
    const double v[2] = {(2 * y + 0.5) * step - 1.0, (2 * y + 1 + 0.5) * step - 1.0};
    const double us[4] = {u[0], u[1], u[0], u[1]}, vs[4] = {v[0], v[0], v[1], v[1]};
    for (int k = 0; k < 4; ++k)
        p.x[k] = face == 0 ? 1.0 : face == 1 ? -1.0 : face == 5 ? -us[k] : us[k];
    for (int k = 0; k < 4; ++k)
        p.y[k] = face == 2 ? 1.0 : face == 3 ? -1.0 : -vs[k];
    for (int k = 0; k < 4; ++k)
        p.z[k] = face == 0 ? -us[k] : face == 1 ? us[k] : face == 2 ? vs[k] : face == 3 ? -vs[k] : face == 4 ? 1.0 : -1.0;
    for (int k = 0; k < 4; ++k) {
        const double scale = 1.0 / std::sqrt(p.x[k] * p.x[k] + p.y[k] * p.y[k] + p.z[k] * p.z[k]);
        p.x[k] *= scale, p.y[k] *= scale, p.z[k] *= scale;
    }
}

using Four = double __attribute__((vector_size(32)));
using FourMasks = long long __attribute__((vector_size(32)));

// Vectors are passed by reference: by value they have another ABI where the processor lacks AVX.
void load(const double* from, Four& x)
{
    __builtin_memcpy(&x, from, sizeof x);
}

void take_root(Four& x)
{
    for (int k = 0; k < 4; ++k)
        x[k] = std::sqrt(x[k]);
}

// Writes positive numbers where a part opens. distance: from a block's nearest place.
void find_openness(const GatherInput& in, const Four& distance, const Four& angle, Four& open)
{
    const Four reach = distance * distance + in.width2, most = in.farthest2 + Four{};
    open = angle - in.opening2 * (most < reach ? most : reach);
}

// Finds the ways for parts whose directions are known. margin: the error in the distance to the horizon. Returns false if a leaf lies
// within it.
bool choose(const GatherInput& in, bool leaves, double margin, Parts& p)
{
    Four x, y, z, angle;
    load(p.x, x), load(p.y, y), load(p.z, z), load(p.angle, angle);
    const Four dx = x - in.centre[0], dy = y - in.centre[1], dz = z - in.centre[2], zero = {};
    Four distance = dx * dx + dy * dy + dz * dz;
    take_root(distance);
    Four near = distance - in.nearer, far = distance - in.farther;
    near = near < zero ? zero : near, far = far < zero ? zero : far;
    const FourMasks seen = far < kHorizon - margin, hidden = near >= kHorizon + margin;
    FourMasks way = seen ? FourMasks{} + take_it : hidden ? FourMasks{} + leave_out : FourMasks{} + differ;
    if (leaves) {
        if (margin > 0.0 && (way[0] == differ || way[1] == differ || way[2] == differ || way[3] == differ))
            return false;
    } else {
        Four open_near, open_far;
        find_openness(in, near, angle, open_near), find_openness(in, far, angle, open_far);
        const FourMasks opens = open_far > zero ? FourMasks{} + open_it : FourMasks{} + differ;
        way = open_near > zero ? opens : way;
    }
    for (int k = 0; k < 4; ++k)
        p.way[k] = static_cast<Way>(way[k]);
    return true;
}

// Looks at a texel's parts.
void look(const GatherInput& in, int face, const Texel& texel, Parts& p)
{
    const LightLevel& below = in.levels[texel.level - 1];
    const int size = below.size > 1 ? below.size / 2 : 1;
    const std::size_t quad = static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(texel.x);
    const std::size_t quads = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    const double* angle = below.angles + quad * 4;
    for (int k = 0; k < 4; ++k)
        p.angle[k] = angle[k];
    p.next = 0, p.end = below.size > 1 ? 4 : 1;
    const bool leaves = texel.level == 1;
    if (below.places) {
        const float* at = below.places + (static_cast<std::size_t>(face) * quads + quad) * 12;
        for (int k = 0; k < 4; ++k)
            p.x[k] = static_cast<double>(at[k]), p.y[k] = static_cast<double>(at[4 + k]), p.z[k] = static_cast<double>(at[8 + k]);
        if (choose(in, leaves, leaves ? kPlaceError : 0.0, p))
            return;
    }
    // The finest level's places are rounded: near the horizon its distances need the centres themselves
    centres(face, below.size, texel.x, texel.y, p);
    choose(in, leaves, 0.0, p);
}

void take(const GatherInput& in, int face, const Texel& texel, const Parts& p, int k, PrefilterTerm& to)
{
    const LightLevel& below = in.levels[texel.level - 1];
    const std::size_t size = static_cast<std::size_t>(below.size);
    const std::size_t row = static_cast<std::size_t>(face) * size + static_cast<std::size_t>(2 * texel.y + k / 2);
    const float* rgb = below.rgb + (row * size + static_cast<std::size_t>(2 * texel.x + k % 2)) * 3;
    const float w = static_cast<float>(p.angle[k]);
    to = {static_cast<float>(p.x[k]), static_cast<float>(p.y[k]), static_cast<float>(p.z[k]), w, rgb[0] * w, rgb[1] * w, rgb[2] * w};
}

// Adds a mark, or extends the last one by the next part.
void add_mark(const GatherMark& mark, GatherList& to)
{
    if (to.mark_count > 0) {
        GatherMark& last = to.marks[to.mark_count - 1];
        if (last.term == mark.term && last.end == mark.first && last.face == mark.face && last.level == mark.level && last.x == mark.x &&
            last.y == mark.y) {
            last.end = mark.end;
            return;
        }
    }
    to.marks[to.mark_count++] = mark;
}

// Walks a mark's parts, depth first.
bool walk(const GatherInput& in, const GatherMark& mark, GatherList& to)
{
    Parts stack[kMostLightLevels];
    Texel at[kMostLightLevels];
    int depth = 0;
    at[0] = {mark.level, mark.x, mark.y};
    look(in, mark.face, at[0], stack[0]);
    stack[0].next = mark.first, stack[0].end = mark.end < stack[0].end ? mark.end : stack[0].end;
    while (depth >= 0) {
        Parts& p = stack[depth];
        const Texel texel = at[depth];
        if (to.term_count + 4 > to.most_terms || to.mark_count + 4 > to.most_marks)
            return false;
        for (; p.next < p.end && p.way[p.next] != open_it; ++p.next) {
            if (p.way[p.next] == take_it)
                take(in, mark.face, texel, p, p.next, to.terms[to.term_count++]);
            else if (p.way[p.next] == differ)
                add_mark({to.term_count, mark.face, texel.level, texel.x, texel.y, p.next, p.next + 1}, to);
        }
        if (p.next == p.end) {
            --depth;
            continue;
        }
        const int k = p.next++;
        ++depth;
        at[depth] = {texel.level - 1, 2 * texel.x + k % 2, 2 * texel.y + k / 2};
        look(in, mark.face, at[depth], stack[depth]);
    }
    return true;
}

bool gather(const GatherInput& in, const GatherList& from, GatherList& to)
{
    to.term_count = to.mark_count = 0;
    int copied = 0;
    for (int i = 0; i <= from.mark_count; ++i) {
        const int end = i < from.mark_count ? from.marks[i].term : from.term_count;
        if (to.term_count + end - copied > to.most_terms)
            return false;
        for (; copied < end; ++copied)
            to.terms[to.term_count++] = from.terms[copied];
        if (i < from.mark_count && !walk(in, from.marks[i], to))
            return false;
    }
    return true;
}

constexpr LightTreeFns kFns = {gather};

} // namespace

BN_DEFINE_FNS(LightTreeFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
