// Draws one tile from triangles to pixels: visibility, shading in dense batches by material, resolve. Compiled once per instruction set.
#include "raster/tile/compose.h"
#include "raster/tile/geometry.h"
#include "raster/tile/record.h"
#include "raster/tile/resolve.h"
#include "raster/tile/shade.h"
#include "raster/tile/visible.h"
#include "shading/lights/background.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

namespace {

// kLanes fragments with one material.
struct Batch {
    std::int32_t fragment[kLanes];
    int n;
    bool run;                        // all lanes in use, by consecutive fragments in the list
    std::int32_t common;             // the triangle of all fragments, or kManyTriangles
    integer x, y, samples, triangle; // pixel in the image, covered samples, triangle in the tile's list
};

BN_INLINE Batch load_batch(const Tile& t, std::uint32_t at, std::uint32_t end)
{
    // Find out if the fragments are consecutive
    Batch b;
    b.n = static_cast<int>(end - at < kLanes ? end - at : kLanes);
    const std::int32_t* order = t.s.order + at;
    std::int32_t in_list[kLanes];
    std::int32_t first = static_cast<std::int32_t>(at);
    b.run = b.n == kLanes;
    if (!t.s.in_list_order) {
        first = order[0];
        b.run = b.run && order[kLanes - 1] - first == kLanes - 1; // the order is ascending
    } else if (!b.run) {
        store_int(in_list, iota() + int_lit(first));
        order = in_list;
    }
    // Load or gather the fragments
    integer pixel;
    if (b.run) {
        b.fragment[0] = first;
        pixel = load_int(t.s.fragment_pixel + first);
        b.samples = load_int(t.s.fragment_mask + first);
        b.triangle = load_int(t.s.fragment_triangle + first);
    } else {
        for (int i = 0; i < kLanes; ++i) // spare lanes repeat the first fragment
            b.fragment[i] = order[i < b.n ? i : 0];
        const integer index = load_int(b.fragment);
        pixel = gather_int(t.s.fragment_pixel, index);
        b.samples = gather_int(t.s.fragment_mask, index);
        b.triangle = gather_int(t.s.fragment_triangle, index);
    }
    b.x = (pixel & int_lit(255)) + int_lit(t.x0);
    b.y = shr(pixel, 8) + int_lit(t.y0);
    b.common = t.s.fragment_triangle[first];
    if (!all(b.triangle == int_lit(b.common)))
        b.common = kManyTriangles;
    return b;
}

BN_INLINE void store_batch(const Tile& t, const Batch& b, const real3& color)
{
    if (b.run) {
        const std::int32_t to = b.fragment[0];
        store(t.s.red + to, color.x), store(t.s.green + to, color.y), store(t.s.blue + to, color.z);
        return;
    }
    float r[kLanes], g[kLanes], bl[kLanes];
    store(r, color.x), store(g, color.y), store(bl, color.z);
    for (int i = 0; i < b.n; ++i) {
        const std::int32_t to = b.fragment[i];
        t.s.red[to] = r[i], t.s.green[to] = g[i], t.s.blue[to] = bl[i];
    }
}

BN_INLINE void store_shared_samples(const Tile& t, const Batch& b, const shared_sample_record& r)
{
    const shared_sample_words line = words_of_shared_sample(r);
    integer words[16];
    for (int i = 0; i < 16; ++i)
        words[i] = bits_of(line.at[i]);
    if (b.run) {
        store_records16(t.s.lines + std::ptrdiff_t{16} * b.fragment[0], words);
        return;
    }
    alignas(64) float part[kLanes][16];
    store_records16(part, words);
    for (int i = 0; i < b.n; ++i)
        __builtin_memcpy(t.s.lines + std::ptrdiff_t{16} * b.fragment[i], part[i], sizeof part[i]);
}

BN_INLINE shared_sample_record load_shared_samples(const TileScratch& s, integer fragment)
{
    integer words[16];
    load_records16(s.lines, fragment, words);
    shared_sample_words line;
    for (int i = 0; i < 16; ++i)
        line.at[i] = real_from_bits(words[i]);
    return shared_sample_of_words(line);
}

// Lists the fragments that share samples, by pixel.
void list_sharing(const Tile& t)
{
    TileScratch& s = t.s;
    __builtin_memset(s.sharing_of_pixel, 255, sizeof(std::int32_t) * kMaxTileSize * kMaxTileSize);
    for (std::int32_t i = static_cast<std::int32_t>(s.fragment_count); i-- > 0;) {
        const std::int32_t triangle = s.fragment_triangle[i];
        if (triangle < 0 || !(t.f.materials[s.triangles[triangle].info >> 2].technique_traits & kSharesSamples))
            continue;
        const std::int32_t pixel = s.fragment_pixel[i];
        std::int32_t& first = s.sharing_of_pixel[(pixel & 255) + (pixel >> 8) * kMaxTileSize];
        s.next_sharing[i] = first;
        first = i;
    }
}

// Averages a slot's fragments over neighbours that share samples, and stores their colours.
void share_slot(const Tile& t, std::uint32_t begin, std::uint32_t end)
{
    const TileScratch& s = t.s;
    const real each = splat(1.0f / static_cast<float>(t.f.msaa));
    const integer none_left = int_lit(-1);
    for (std::uint32_t i = begin; i < end; i += kLanes) {
        const Batch b = load_batch(t, i, end);
        const integer fragment = b.run ? iota() + int_lit(b.fragment[0]) : load_int(b.fragment);
        const integer pixel = b.x - int_lit(t.x0) + (b.y - int_lit(t.y0)) * int_lit(kMaxTileSize);
        const shared_sample_record own = load_shared_samples(s, fragment);
        shared_sample_mean mean = shared_sample_mean_begin(own);
        // Visit the other three pixels of the quad
        for (int k = 1; k < 4; ++k) {
            integer at = gather_int(s.sharing_of_pixel, pixel ^ int_lit((k & 1) + (k >> 1) * kMaxTileSize));
            for (mask some = at > none_left; any(some); some = at > none_left) {
                const integer other = select(some, at, fragment);
                const shared_sample_record r = load_shared_samples(s, other);
                const real cover = covered_share(gather_int(s.fragment_mask, other), each);
                mean = shared_sample_mean_add(mean, own, r, cover, some);
                at = select(some, gather_int(s.next_sharing, other), none_left);
            }
        }
        store_batch(t, b, shared_sample_mean_colour(mean, own));
    }
}

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
    const material_inputs at = found.at;
    const lobe_shape shape = found.shape;
    LaneSetup setup = {};
    std::int32_t setup_of = kManyTriangles;
    for (std::uint32_t i = begin; i < end; i += kLanes) {
        const Batch b = load_batch(t, i, end);
        if (b.common == kManyTriangles || b.common != setup_of)
            load_setup(t.s, b.triangle, b.common, setup);
        setup_of = b.common;
        const visible_point p = fragment_of(frame, material, eye, setup, b.x, b.y, b.samples, false);
        const shared_sample_record light = shade_fragments<kTechnique>(frame, material, at, shape, p, b.x, b.y);
        if constexpr ((technique_tag<kTechnique>::kTraits & kSharesSamples) != 0)
            store_shared_samples(t, b, light);
        else
            store_batch(t, b, light.rest);
    }
}

template <Technique kTechnique>
void shade_slot(const Tile& t, const view_params& view, const MaterialRecord& m, std::uint32_t begin, std::uint32_t end)
{
    const MaterialPlan plan = plan_material(t.f, m);
    if (plan.uniform && m.unlit) { // one colour everywhere
        for (std::uint32_t i = begin; i < end; i += kLanes)
            store_batch(t, load_batch(t, i, end), plan.at.base);
        return;
    }
    // Use plain code if frame and material need nothing more
    constexpr int kTraits = kTechniqueTraits[static_cast<int>(kTechnique)];
    constexpr bool kAlsoRound = (kTraits & kAutoRound) != 0;
    using Material = std::conditional_t<(kTraits & kPhongGrid) != 0, PlainMaterial, UntabledMaterial>;
    constexpr std::uint32_t kWorthACopy = 8 * kLanes; // below this, copies and hoisted values do not pay
    if (plan.uniform && end - begin >= kWorthACopy && PlainFrame::fits(t.f) && Material::fits(m)) {
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
        const mask seen = (b.samples & central) != int_lit(0);
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

using ShadeSlot = void (*)(const Tile&, const view_params&, const MaterialRecord&, std::uint32_t, std::uint32_t);
constexpr ShadeSlot kShadeSlots[] = {
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary) shade_slot<Technique::id>,
#include "shading/models.def"
};

// Shades the slots after the background's. Afterwards the colours of all fragments are known.
void shade_slots(const Tile& t, const view_params& view, int slots)
{
    const TileScratch& s = t.s;
    bool shared = false;
    for (int k = 1; k < slots; ++k) {
        const MaterialRecord& m = t.f.materials[s.slot_material[k]];
        kShadeSlots[m.technique](t, view, m, s.slot_begin[k], s.slot_begin[k + 1]);
        shared = shared || (m.technique_traits & kSharesSamples);
        lap(s, FrameStage::shade, s.slot_material[k], s.slot_begin[k + 1] - s.slot_begin[k]);
    }
    if (shared)
        list_sharing(t);
    for (int k = 1; shared && k < slots; ++k)
        if (t.f.materials[s.slot_material[k]].technique_traits & kSharesSamples)
            share_slot(t, s.slot_begin[k], s.slot_begin[k + 1]);
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
    const Tile layer{t.f, *peel.layer, t.index_x, t.index_y, t.x0, t.y0, t.width, t.height};
    begin_layers(t);
    for (int slots = find_layer(t); slots > 1; slots = find_layer(t)) {
        shade_slots(layer, view, slots);
        for (int k = 1; k < slots; ++k) {
            const TileScratch& s = layer.s;
            find_alphas(layer, view, t.f.materials[s.slot_material[k]], s.slot_begin[k], s.slot_begin[k + 1], peel.alpha);
        }
        compose_layer(t.f, t.width, t.height, peel);
        lap(layer.s, FrameStage::resolve);
    }
    resolve_blended(t.f, t.x0, t.y0, t.width, t.height, t.s);
}

void draw_all_layers(const Tile& t, const view_params& view, int slots)
{
    for (int k = 1; k < slots; ++k)
        draw_layers(t, view, t.f.materials[t.s.slot_material[k]], t.s.slot_begin[k], t.s.slot_begin[k + 1]);
}

void render_tile(const FrameParams& f, int tile_x, int tile_y, TileScratch& s)
{
    Tile t{f, s, tile_x, tile_y, tile_x * f.tile_size, tile_y * f.tile_size, 0, 0};
    t.width = f.width - t.x0 < f.tile_size ? f.width - t.x0 : f.tile_size;
    t.height = f.height - t.y0 < f.tile_size ? f.height - t.y0 : f.tile_size;
    const view_params view = view_params_of(f.view);
    if (s.output_layers && f.blends)
        draw_all_layers(t, view, find_visible(t, view, Surfaces::all));
    const int slots = find_visible(t, view, Surfaces::solid);
    shade_background_slot(t, view, s.slot_begin[0], s.slot_begin[1]);
    lap(s, FrameStage::background, -1, s.slot_begin[1] - s.slot_begin[0]);
    shade_slots(t, view, slots);
    if (s.output_layers && !f.blends)
        draw_all_layers(t, view, slots);
    if (s.output_pairs) {
        record_depths(f, t.x0, t.y0, t.width, t.height, s);
        record_fragments(f, view, t.x0, t.y0, s);
    }
    resolve(f, t.x0, t.y0, t.width, t.height, s);
    lap(s, FrameStage::resolve);
    if (s.peel && s.peel->triangle_count > 0)
        draw_blended(t, view);
}

constexpr TileFns kFns = {transform_vertices, bin_triangles, touch_tiles, render_tile, record_vertices, kLanes};

} // namespace

BN_DEFINE_FNS(TileFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
