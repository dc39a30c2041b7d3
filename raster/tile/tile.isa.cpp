// Draws one tile from triangles to pixels: visibility, shading in dense batches by material, resolve. Compiled once per instruction set.
#include <algorithm>

#include "raster/tile/batch.h"
#include "raster/tile/compose.h"
#include "raster/tile/geometry.h"
#include "raster/tile/record.h"
#include "raster/tile/resolve.h"
#include "raster/tile/shade.h"
#include "raster/tile/share.h"
#include "raster/tile/visible.h"
#include "shading/lights/background.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

namespace {

// Finds the addresses of several batches first, then fetches their texels: see cube_sum.h.
void shade_background_slot(const Tile& t, const view_params& view, std::uint32_t begin, std::uint32_t end)
{
    if (!t.f.background) {
        for (std::uint32_t i = begin; i < end; i += kLanes)
            store_batch(t, load_batch(t, i, end), vec3_all(lit(0.0)));
        return;
    }
    constexpr int kGroup = 8;
    Batch batches[kGroup];
    texel_plan plans[kGroup];
    const cube_desc cube = full_env(t.f);
    for (std::uint32_t i = begin; i < end;) {
        int n = 0;
        for (; n < kGroup && i < end; ++n, i += kLanes) {
            Batch& b = batches[n];
            b = load_batch(t, i, end);
            const real3 ray = background_ray(t.f, view, b.x, b.y);
            plan(plans[n], cube_level_rows(cube, cube_face_uv(ray), 0, lit(1.0)));
        }
        for (int k = 0; k < n; ++k) {
            const real4 v = texel_value(texel_add(texel_zero(), cube.texels, plans[k]));
            store_batch(t, batches[k], radiance_of_texel(t.f, vec3_of(v.x, v.y, v.z)));
        }
    }
}

// Shades a slot without special features. Local copies show the compiler that nobody writes to them, so it hoists everything that depends
// on them alone out of the loop.
template <Technique kTechnique, class Material>
void shade_plain_slot(const Tile& t, const view_params& view, const MaterialRecord& m, const MaterialPlan& found, std::uint32_t begin,
                      std::uint32_t end)
{
    const PlainFrame frame{t.f};
    const Material material{m};
    const view_params eye = view;
    material_inputs at = found.at;
    const lobe_shape shape = found.shape;
    LaneSetup setup = {};
    std::int32_t setup_of = kManyTriangles;
    for (std::uint32_t i = begin; i < end; i += kLanes) {
        const Batch b = load_batch(t, i, end);
        if (b.common == kManyTriangles || b.common != setup_of)
            load_setup(t.s, b.triangle, b.common, setup);
        setup_of = b.common;
        const visible_point p = fragment_of(frame, material, eye, setup, b.x, b.y, b.samples, false, wants_bends(frame, material));
        colour_inputs(material, p, at);
        const shared_sample_record light = shade_fragments<kTechnique>(frame, material, at, shape, p, b.x, b.y);
        if ((technique_tag<kTechnique>::kTraits & kSharesSamples) != 0 && (m.technique_traits & kSharesSamples) != 0)
            store_shared_samples(t, b, light);
        else
            store_batch(t, b, light.rest);
    }
}

template <Technique kTechnique>
void shade_slot(const Tile& t, const view_params& view, const MaterialRecord& m, std::uint32_t begin, std::uint32_t end)
{
    const MaterialPlan plan = plan_material(t.f, m);
    if (plan.untextured && !m.uses_color && m.unlit) { // one colour everywhere
        for (std::uint32_t i = begin; i < end; i += kLanes)
            store_batch(t, load_batch(t, i, end), plan.at.base);
        return;
    }
    // Use plain code if frame and material need nothing more
    constexpr int kTraits = kTechniqueTraits[static_cast<int>(kTechnique)];
    constexpr bool kAlsoRound = (kTraits & kAutomatic) != 0;
    using Material = std::conditional_t<(kTraits & kPhongGrid) != 0, PlainMaterial, UntabledMaterial>;
    constexpr std::uint32_t kWorthACopy = 8 * kLanes; // below this, copies and hoisted values do not pay
    if (plan.untextured && end - begin >= kWorthACopy && PlainFrame::fits(t.f) && Material::fits(m)) {
        if (kAlsoRound && RoundMaterial::fits(m))
            shade_plain_slot<kTechnique, std::conditional_t<kAlsoRound, RoundMaterial, Material>>(t, view, m, plan, begin, end);
        else
            shade_plain_slot<kTechnique, Material>(t, view, m, plan, begin, end);
        return;
    }
    for (std::uint32_t i = begin; i < end; i += kLanes) {
        const Batch b = load_batch(t, i, end);
        const visible_point p = make_fragment(t.f, m, view, t.s, b.triangle, b.common, b.x, b.y, b.samples);
        const shared_sample_record light = shade_planned<kTechnique>(t.f, m, plan, p, b.x, b.y);
        if (m.technique_traits & kSharesSamples)
            store_shared_samples(t, b, light);
        else
            store_batch(t, b, light.rest);
    }
}

// Writes layers for the fragments at each pixel's central sample.
void draw_layers(const Tile& t, const view_params& view, const MaterialRecord& m, std::uint32_t begin, std::uint32_t end)
{
    const integer central = int_lit(1 << t.f.layer_sample);
    for (std::uint32_t i = begin; i < end; i += kLanes) {
        const Batch b = load_batch(t, i, end);
        const integer x = b.x - int_lit(t.x0), y = b.y - int_lit(t.y0);
        const mask in_columns = both(x >= int_lit(t.own_x0), x < int_lit(t.own_x1)),
                   in_rows = both(y >= int_lit(t.own_y0), y < int_lit(t.own_y1));
        const mask seen = both((b.samples & central) != int_lit(0), both(in_columns, in_rows));
        if (none(seen))
            continue;
        const visible_point p = make_fragment(t.f, m, view, t.s, b.triangle, b.common, b.x, b.y, b.samples);
        float words[kLayerWords][kLanes];
        LaneWriter writer{words[0]};
        record_layers(writer, layers_of(t.f, m, fetch_lanes(t.f, m, p), p));
        std::int32_t pixel[kLanes];
        store_int(pixel, b.x + b.y * int_lit(t.f.width));
        for (std::uint32_t bits = to_bits(seen) & ((1u << b.n) - 1); bits; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            float* const to = t.s.output_layers + std::ptrdiff_t{kLayerWords} * pixel[lane];
            for (int k = 0; k < kLayerWords; ++k)
                to[k] = words[k][lane];
        }
    }
}

// Returns true for the techniques that this copy of the kernels draws by.
#ifndef BN_COMPILES_TECHNIQUE
#define BN_COMPILES_TECHNIQUE(id) true
#endif
using ShadeSlot = void (*)(const Tile&, const view_params&, const MaterialRecord&, std::uint32_t, std::uint32_t);
template <Technique kTechnique, bool kCompiled> constexpr ShadeSlot slot_of()
{
    if constexpr (kCompiled)
        return shade_slot<kTechnique>;
    else
        return nullptr;
}
constexpr ShadeSlot kShadeSlots[] = {
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary) slot_of<Technique::id, BN_COMPILES_TECHNIQUE(id)>(),
#include "shading/models.def"
};

// Returns true if a slot's material transmits light.
bool transmits(const Tile& t, int slots)
{
    return std::any_of(t.s.slot_material + 1, t.s.slot_material + slots, [&](std::int32_t m) { return t.f.materials[m].refracts != 0; });
}

// Shades the slots after the background's. Afterwards the colours of all fragments are known.
void shade_slots(const Tile& t, const view_params& view, int slots)
{
    const TileScratch& s = t.s;
    bool shared = false;
    for (int k = 1; k < slots; ++k)
        shared = shared || (t.f.materials[s.slot_material[k]].technique_traits & kSharesSamples);
    if (shared)
        begin_sharing(t.s);
    for (int k = 1; k < slots; ++k) {
        const MaterialRecord& m = t.f.materials[s.slot_material[k]];
        kShadeSlots[m.technique](t, view, m, s.slot_begin[k], s.slot_begin[k + 1]);
        lap(s, FrameStage::shade, s.slot_material[k], s.slot_begin[k + 1] - s.slot_begin[k]);
    }
    if (shared)
        share_fragments(t);
}

// Fetches alpha for a layer's fragments with one material.
void find_alphas(const Tile& t, const view_params& view, const MaterialRecord& m, std::uint32_t begin, std::uint32_t end, float* alpha)
{
    for (std::uint32_t i = begin; i < end; i += kLanes) {
        const Batch b = load_batch(t, i, end);
        float found[kLanes];
        store(found, fetch_lanes(t.f, m, make_fragment(t.f, m, view, t.s, b.triangle, b.common, b.x, b.y, b.samples)).alpha);
        for (int k = 0; k < b.n; ++k)
            alpha[b.run ? b.fragment[0] + k : b.fragment[k]] = found[k];
    }
}

// Draws blended surfaces layer by layer, the nearest first, over the output of resolve().
void draw_blended(const Tile& t, const view_params& view)
{
    PeelScratch& peel = *t.s.peel;
    const Tile layer{t, t.f, *peel.layer};
    begin_layers(t);
    for (int slots = find_layer(t); slots > 1; slots = find_layer(t)) {
        t.s.transmits = t.s.transmits || transmits(layer, slots);
        shade_slots(layer, view, slots);
        for (int k = 1; k < slots; ++k) {
            const TileScratch& s = layer.s;
            find_alphas(layer, view, t.f.materials[s.slot_material[k]], s.slot_begin[k], s.slot_begin[k + 1], peel.alpha);
        }
        compose_layer(t.f, t.width, t.height, peel);
        lap(layer.s, FrameStage::resolve);
    }
    resolve_blended(t.f, t, t.s);
}

void draw_all_layers(const Tile& t, const view_params& view, int slots)
{
    for (int k = 1; k < slots; ++k)
        draw_layers(t, view, t.f.materials[t.s.slot_material[k]], t.s.slot_begin[k], t.s.slot_begin[k + 1]);
}

void render_tile(const FrameParams& f, const TileRect& rect, TileScratch& s)
{
    const Tile t{rect, f, s};
    const view_params view = view_params_of(f.view);
    if (s.output_layers && f.blends)
        draw_all_layers(t, view, find_visible(t, view, Surfaces::all));
    const int slots = find_visible(t, view, Surfaces::solid);
    s.transmits = slots > 1 && transmits(t, slots);
    if (s.transmits && f.defers_bodies)
        return;
    shade_background_slot(t, view, s.slot_begin[0], s.slot_begin[1]);
    lap(s, FrameStage::background, -1, s.slot_begin[1] - s.slot_begin[0]);
    shade_slots(t, view, slots);
    if (s.output_layers && !f.blends)
        draw_all_layers(t, view, slots);
    if (s.output_pairs) {
        record_depths(f, t, s);
        record_fragments(f, view, t, s);
    }
    resolve(f, t, s);
    lap(s, FrameStage::resolve);
    if (s.peel && s.peel->triangle_count > 0)
        draw_blended(t, view);
}

LaneWork work()
{
#ifdef BN_COUNTED
    return {lane_counts.operations, lane_counts.bytes};
#else
    return {0, 0};
#endif
}

constexpr TileFns kFns = {transform_vertices, bin_triangles, touch_tiles, render_tile, record_vertices, work, kLanes};

} // namespace

BN_DEFINE_FNS(TileFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
