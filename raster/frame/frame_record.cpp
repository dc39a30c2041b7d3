#include "raster/frame/frame_record.h"

#include <algorithm>
#include <cmath>

#include "core/math/scalar_math.h"
#include "raster/frame/grid_samples.h"
#include "shading/bake/ltc/shipped.h"
#include "shading/bake/tables/phong_files.h"
#include "shading/kernels/camera.t.h"
#include "shading/surface/lobe_shape.t.h"

namespace burnish {

ViewRecord view_record(const View& v)
{
    ViewRecord p = {};
    for (int i = 0; i < 3; ++i)
        p.eye[i] = v.eye[i], p.right[i] = v.right[i], p.up[i] = v.up[i], p.forward[i] = v.forward[i];
    p.inv_tan_x = 1.0f / v.tan_half_x, p.inv_tan_y = 1.0f / v.tan_half_y;
    p.znear = v.znear, p.zfar = v.zfar;
    p.orthographic = v.orthographic;
    p.inv_depth = v.orthographic ? 1.0f / (v.zfar - v.znear) : 0.0f;
    return p;
}

CubeRecord cube_record(const CubeMap& cube)
{
    return {cube.size, cube.levels, cube.scale};
}

ExtractedLightRecord extracted_light_record(const ExtractedLight& light)
{
    ExtractedLightRecord r = {};
    const auto length = [](const float* v) {
        const double x = static_cast<double>(v[0]), y = static_cast<double>(v[1]), z = static_cast<double>(v[2]);
        return std::sqrt(x * x + y * y + z * z);
    };
    const double solid_angle = kPi * length(light.axis_u) * length(light.axis_v);
    for (int i = 0; i < 3; ++i) {
        r.direction[i] = light.direction[i], r.axis_u[i] = light.axis_u[i], r.axis_v[i] = light.axis_v[i];
        r.irradiance[i] = light.irradiance[i];
        r.radiance[i] = static_cast<float>(static_cast<double>(light.irradiance[i]) / solid_angle);
    }
    return r;
}

void put_parameters(const FrameDesc& d, bool tilted, FrameRecord& f)
{
#define BN_PUT_number(id) f.id = d.id;
#define BN_PUT_whole(id) f.id = static_cast<int>(d.id);
#define BN_PUT_flag(id) f.id = d.id;
#define BN_PUT_choice(id) f.id = d.id;
#define BN_PUT_lobe(id) f.id = d.id;
#define BN_PUT_way(id) f.id = d.id;
#define BN_PUT_angles(id) // see in_frame()
#define BN_PARAMETER(id, kind, option, fallback, least, most, unit, summary, readers) BN_PUT_##kind(id)
#include "shading/models.def"
    f.lobe = lobe_of(d, tilted), f.lobe_traits = lobe_traits_of(f.lobe);
}

// Returns true if maps may tilt normals away from the surface normal.
static bool has_mapped_normals(const Scene& scene, const FrameDesc& d)
{
    return d.frame_map != kFrameOff && std::any_of(scene.materials.begin(), scene.materials.end(),
                                                   [](const Material& m) { return m.normal_tex.used() || m.clearcoat_normal_tex.used(); });
}

static const ltc::ShadingTables& ltc_tables(const RenderInput& input)
{
    return input.ltc ? *input.ltc : ltc::shipped_tables();
}

// Snapped positions along one axis, as in FrameRecord.
struct SnappedAxis {
    int center;
    float half, middle;
};
static SnappedAxis snapped_axis(int size, int first, int picture)
{
    SnappedAxis a = {picture / 2, 0.5f * static_cast<float>(picture), 0.0f};
    if (picture > kMaxPictureSide) {
        a.center = window_cell(first, size) * kWindowCell + kWindowCell / 2;
        a.middle = (static_cast<float>(a.center) - a.half) / a.half;
    }
    a.center = (a.center - first) * kSubpixel;
    return a;
}

// Fills all record fields that need no baking.
FrameRecord frame_record(const RenderInput& input, const FrameDesc& d)
{
    FrameRecord f = {};
    // Camera, picture size and sample pattern
    f.view = view_record(d.view);
    f.width = d.width, f.height = d.height, f.msaa = d.msaa;
    f.left = d.window.left, f.top = d.window.top, f.picture_width = picture_width(d);
    const SnappedAxis across = snapped_axis(d.width, f.left, picture_width(d)), down = snapped_axis(d.height, f.top, picture_height(d));
    f.center_x = across.center, f.half_width = across.half, f.middle_x = across.middle;
    f.center_y = down.center, f.half_height = down.half, f.middle_y = down.middle;
    f.pattern = standard_samples(d.msaa);
    // Environment: cubes and extracted lights
    f.specular = cube_record(input.environment.specular), f.irradiance = cube_record(input.environment.irradiance);
    f.whole = cube_record(input.environment.picture());
    f.extracted_light_count = d.lamps ? static_cast<int>(input.environment.extracted_lights.size()) : 0;
    std::transform(input.environment.extracted_lights.begin(), input.environment.extracted_lights.end(), f.extracted_lights,
                   extracted_light_record);
    f.dfg_size = input.dfg.size, f.lobe_albedo_size = kLobeAlbedoSize;
    // Lamps and area lights
    f.light_count = d.lamps ? static_cast<int>(input.tables.lights.size()) : 0;
    if (d.area_way != kAreaWay_off && !input.tables.area_lights.empty()) {
        f.area_light_count = static_cast<int>(input.tables.area_lights.size());
        f.ltc = ltc_tables(input).record;
    }
    // Options of the frame
    f.layer_sample = d.layers ? central_sample(f.pattern) : -1;
    f.positions = f.light_count > 0 || f.area_light_count > 0 || d.layers;
    f.background = d.background;
    f.texture_taps = d.texture_anisotropy;
    put_parameters(d, tilts(input.scene, d), f);
    if (!has_mapped_normals(input.scene, d)) // then nothing reads the horizon
        f.horizon = 0;
    f.override_anisotropy = d.override_anisotropy, f.anisotropy = d.anisotropy;
    return f;
}

FrameMaker::FrameMaker(const RenderInput& input) : input_(input), scene_(upload_scene(input)) {}

const std::vector<std::uint16_t>& FrameMaker::ltc_texels() const
{
    static const std::vector<std::uint16_t> none;
    return input_.tables.area_lights.empty() ? none : ltc_tables(input_).texels;
}

void FrameMaker::bake(const FrameDesc& desc)
{
    grid_.clear(), sets_.clear();
    const TechniqueInfo& technique = *find_technique(desc.technique);
    if ((technique.traits & kReadsBox) && mip_env_.levels == 0)
        mip_env_ = box_filtered_chain(input_.environment.specular, input_.jobs);
    grid_ = grid_samples(desc.samples, technique.sampling, technique.traits);
    grid_count_ = grid_count(grid_, technique.traits);
}

namespace {

// Returns true if the material transmits light. An index of 0 reflects all light.
bool refracts(const MaterialRecord& m, int lobe)
{
    return !m.unlit && m.transmission > 0.0f && m.ior > 0.0f && !(lobe_traits_of(lobe) & kPunctualOnly);
}

} // namespace

void FrameMaker::choose_techniques(const FrameDesc& desc)
{
    const int lobe = lobe_of(desc, tilts(input_.scene, desc));
    for (std::size_t i = 0; i < materials_.size(); ++i) {
        MaterialRecord& m = materials_[i];
        const TechniqueInfo& t = technique_of(desc, i);
        m.technique = static_cast<int>(&t - techniques().data());
        m.samples = samples_of(desc, i);
        m.technique_traits = m.unlit ? 0 : traits_for(t, m.anisotropic != 0);
        m.refracts = refracts(m, lobe);
        m.hidden = desc.opaque_only && (m.refracts || m.alpha_mode == kAlpha_blend || m.emitter == kOpenEmitter);
        const bool round = !m.anisotropic || (t.traits & kTakesRoundLobes);
        m.lights_lobe = round && lobe == lobe_with(kDefaultLobe) ? lobe_with(kRoundLobe) : lobe;
    }
}

namespace {

// Returns anisotropy_blend_of() for the material's factors. A roughness texture makes some places smoother, and so more brushed; a textured
// material counts as smooth. With or without a texture, brushing fades in continuously as its strength grows from 0.
float anisotropy_blend_by_factors(const ShadingFrame& f, const MaterialRecord& material)
{
    constexpr float kSmooth = 0.3f;
    MaterialRecord m = material;
    if (texture_used(m, kMetalRoughTex) && m.roughness_fixed == 0)
        m.roughness = std::min(m.roughness, kSmooth);
    const lobe_shape shape = only_lobe_shape(f, m);
    return anisotropy_blend_of(shape.sigma_u, shape.sigma_v);
}

} // namespace

// Returns the first pair of a lobe's albedo table. Bakes the table on the first request.
int FrameMaker::slice_of(float sigma_u, float sigma_v, bool phong)
{
    const SlicedLobe wanted = {sigma_u, sigma_v, phong};
    if (const auto known = sliced_.find(wanted); known != sliced_.end())
        return known->second;
    const std::size_t size = phong ? kLobeAlbedoSize : kLobeSliceSize, held = lobe_slices_.size();
    const int first = static_cast<int>(held / 2);
    sliced_.emplace(wanted, first);
    lobe_slices_.resize(held + 2 * size * size / 2);
    const double root2 = 1.4142135623730951;
    const double alpha_u = root2 * static_cast<double>(sigma_u), alpha_v = root2 * static_cast<double>(sigma_v);
    float* const pairs = lobe_slices_.data() + held;
    if (!phong)
        bake_lobe_slice(alpha_u, alpha_v, pairs);
    else if (input_.phong && input_.phong->has_albedo())
        input_.phong->slice(phong_exponent(alpha_u), phong_exponent(alpha_v), kLobeAlbedoSize, pairs);
    else
        bake_phong_slice(kLobeAlbedoSize, alpha_u, alpha_v, pairs);
    return first;
}

// Returns the index of the lobe's first half vector in the grid. Adds the lobe's half vectors on the first request. Returns -1 if the grid
// is full.
int FrameMaker::set_of(float sigma_u, float sigma_v, int samples)
{
    const auto known = std::find(sets_.begin(), sets_.end(), std::pair(sigma_u, sigma_v));
    const int all = kPhongBlock * samples, first = all * (1 + static_cast<int>(known - sets_.begin()));
    if (known != sets_.end())
        return first;
    if (first + all > kMostGridSamples)
        return -1;
    const double root2 = 1.4142135623730951, nu = phong_exponent(root2 * static_cast<double>(sigma_u)),
                 nv = phong_exponent(root2 * static_cast<double>(sigma_v));
    sets_.emplace_back(sigma_u, sigma_v);
    const bool from_file = input_.phong && input_.phong->has_half_vectors();
    add_half_vectors(from_file ? input_.phong->half_vectors(nu, nv, samples) : phong_half_vectors(nu, nv, samples), grid_);
    return first;
}

namespace {

// Returns true if the frame's lobes are Ashikhmin-Shirley lobes with energy compensation, for any technique.
bool compensates_phong(const FrameDesc& desc, const Scene& scene)
{
    return desc.energy_compensation && (lobe_traits_of(lobe_of(desc, tilts(scene, desc))) & kPhongLobe);
}

} // namespace

// Bakes albedo tables and half vectors for materials whose lobe has the same widths everywhere.
void FrameMaker::slice_albedo(const FrameDesc& desc)
{
    ShadingFrame f = {};
    f.override_anisotropy = desc.override_anisotropy, f.anisotropy = desc.anisotropy;
    const bool compensated = compensates_phong(desc, input_.scene);
    for (MaterialRecord& m : materials_) {
        m.albedo_slice = m.phong_slice = m.phong_set = -1, m.anisotropy_blend = 1.0f;
        if (m.anisotropic && (m.technique_traits & kSharesSamples) && !(m.technique_traits & kPhongGrid) && m.moments == kNoMoments)
            m.anisotropy_blend = anisotropy_blend_by_factors(f, m);
        if (!one_lobe_shape(m) || desc.specular_aa)
            continue;
        const lobe_shape shape = only_lobe_shape(f, m);
        if (m.anisotropic)
            m.albedo_slice = slice_of(shape.sigma_u, shape.sigma_v, false);
        const bool sampled = (m.technique_traits & kPhongGrid) && desc.as_tables == 0;
        if (sampled || (compensated && !m.unlit))
            m.phong_slice = slice_of(shape.sigma_u, shape.sigma_v, true);
        if ((m.technique_traits & kPhongGrid) && desc.as_tables == 0 && desc.seed == 0)
            m.phong_set = set_of(shape.sigma_u, shape.sigma_v, desc.samples);
    }
}

bool FrameMaker::shows_behind(const FrameDesc& desc) const
{
    if (desc.glass == 0 || desc.opaque_only)
        return false;
    const int lobe = lobe_of(desc, tilts(input_.scene, desc));
    const auto drawn = [&](const auto& test) {
        return std::any_of(input_.tables.draws.begin(), input_.tables.draws.end(), [&](const Draw& d) {
            const std::size_t at = static_cast<std::size_t>(d.material);
            return test(scene_.materials[at], (technique_of(desc, at).traits & kSamplesInterface) != 0);
        });
    };
    return drawn([&](const MaterialRecord& m, bool samples_interface) { return refracts(m, lobe) && !samples_interface; }) &&
           drawn([&](const MaterialRecord& m, bool) {
               return !refracts(m, lobe) && m.alpha_mode != kAlpha_blend && m.emitter != kOpenEmitter;
           });
}

void FrameMaker::take_behind(const Frame& frame)
{
    behind_ = make_behind_picture(frame, input_.jobs);
}

// Lets the frame read the picture of surfaces behind.
void FrameMaker::put_behind(const FrameDesc& desc, ShadingFrame& f)
{
    f.behind = -1;
    if (!shows_behind(desc))
        return;
    f.positions = 1;
    if (behind_.light.levels == 0)
        return;
    textures_ = scene_.textures;
    f.behind = static_cast<int>(textures_.size());
    textures_.push_back(texture_params(behind_.light)), textures_.push_back(texture_params(behind_.depth));
    f.textures = textures_.data();
}

Status FrameMaker::check(const FrameDesc& desc) const
{
    BN_TRY(check_frame(input_.scene, desc));
    if ((picture_width(desc) > desc.width || picture_height(desc) > desc.height) && shows_behind(desc))
        return Error{ExitCode::usage, "", "",
                     "surfaces that let light through show the whole picture behind them, and a window shows a part "
                     "(FrameDesc::glass interface draws them by the environment alone)",
                     "FrameDesc::window"};
    BN_TRY(check_prepared(input_.mips, desc));
    if (!input_.phong)
        return {};
    const bool compensated = compensates_phong(desc, input_.scene);
    ShadingFrame f = {};
    f.override_anisotropy = desc.override_anisotropy, f.anisotropy = desc.anisotropy;
    for (const MaterialRecord& m : in_frame(overrides(input_.scene, input_.mips, desc) ? scene_.overridden : scene_.materials, desc)) {
        const bool sampled = (technique_of(desc).traits & kPhongGrid) && desc.as_tables == 0;
        if ((!sampled && !compensated) || m.unlit || !one_lobe_shape(m) || desc.specular_aa)
            continue;
        const double root2 = 1.4142135623730951;
        const lobe_shape shape = only_lobe_shape(f, m);
        if (shape.sigma_u > 0.0f)
            BN_TRY(input_.phong->check(phong_exponent(root2 * static_cast<double>(shape.sigma_u)),
                                       phong_exponent(root2 * static_cast<double>(shape.sigma_v))));
    }
    return {};
}

ShadingFrame FrameMaker::make(const FrameDesc& desc)
{
    bake(desc);
    materials_ = in_frame(overrides(input_.scene, input_.mips, desc) ? scene_.overridden : scene_.materials, desc);
    choose_techniques(desc);
    slice_albedo(desc);
    ShadingFrame f = {};
    static_cast<FrameRecord&>(f) = frame_record(input_, desc);
    // Project pixel centres to the view plane
    const view_params view = view_params_of(f.view);
    screen_x_.resize(static_cast<std::size_t>(desc.width)), screen_y_.resize(static_cast<std::size_t>(desc.height));
    for (int x = 0; x < desc.width; ++x)
        screen_x_[static_cast<std::size_t>(x)] = screen_x(static_cast<float>(x + f.left) + 0.5f, f.half_width, view.inv_tan_x);
    for (int y = 0; y < desc.height; ++y)
        screen_y_[static_cast<std::size_t>(y)] = screen_y(static_cast<float>(y + f.top) + 0.5f, f.half_height, view.inv_tan_y);
    f.screen_x = screen_x_.data(), f.screen_y = screen_y_.data();
    // Point the frame at the scene's tables
    const DrawTables& t = input_.tables;
    f.px = t.px.data(), f.py = t.py.data(), f.pz = t.pz.data();
    f.shading_vertices = reinterpret_cast<const float*>(t.shading.data());
    f.indices = t.indices.data(), f.triangle_material = t.triangle_material.data();
    f.materials = materials_.data(), f.textures = scene_.textures.data(), f.lights = scene_.lights.data();
    put_behind(desc, f);
    f.light_columns = scene_.light_columns.data(), f.light_stride = scene_.light_stride;
    f.area_lights = scene_.area_lights.data(), f.ltc_texels = ltc_texels().data();
    // Point the frame at the environment and the albedo tables
    f.specular_texels = input_.environment.specular.texels.data(), f.irradiance_texels = input_.environment.irradiance.texels.data();
    f.whole_texels = input_.environment.picture().texels.data();
    f.dfg_pairs = input_.dfg.pairs.data();
    f.lobe_albedo_pairs = lobe_albedo_pairs(), f.lobe_slice_pairs = lobe_slices_.data();
    f.box = cube_record(mip_env_), f.box_texels = mip_env_.texels.data();
    f.grid = grid_.data(), f.grid_count = grid_count_;
    return f;
}

} // namespace burnish
