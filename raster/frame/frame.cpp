#include "raster/frame/frame.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <sstream>
#include <string_view>

#include "core/base/check.h"
#include "core/base/hash.h"
#include "core/math/scalar_math.h"
#include "shading/lang/tables.h"

namespace burnish {

namespace {

struct Basis {
    glm::vec3 right, up, forward;
};

// Returns a right-handed basis: right x up = -forward. `forward` need not be unit. A vertical `forward` takes +Z as its up, or -Z if it
// points down.
Basis look_basis(const glm::vec3& forward)
{
    const glm::vec3 f = glm::normalize(forward);
    const glm::vec3 up = std::abs(f.y) > 0.9999f ? glm::vec3(0, 0, f.y > 0 ? 1 : -1) : glm::vec3(0, 1, 0);
    const glm::vec3 r = glm::normalize(glm::cross(f, up));
    return {r, glm::cross(r, f), f};
}

void set_fov(View& view, float tan_half_y, int width, int height)
{
    view.tan_half_y = tan_half_y;
    view.tan_half_x = tan_half_y * static_cast<float>(width) / static_cast<float>(height);
}

// Returns tan(fov / 2) for angles from a few degrees to nearly 180. Uses the half-angle series of sine and cosine: the bits are the same
// on every machine, which the C library's tan does not promise.
float tan_half(float fov_rad)
{
    const double x = static_cast<double>(fov_rad) / 64.0; // after six halvings the angle is below 0.05
    const double x2 = x * x;
    double s = x * (1.0 - x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0)));
    double c = 1.0 - x2 / 2.0 * (1.0 - x2 / 12.0 * (1.0 - x2 / 30.0 * (1.0 - x2 / 56.0)));
    for (int i = 0; i < 5; ++i) {
        const double s2 = 2.0 * s * c;
        c = c * c - s * s;
        s = s2;
    }
    return static_cast<float>(s / c);
}

constexpr float kLeastNear = 1e-30f; // metres: the least that glTF's cameras may have

} // namespace

View make_view(const glm::vec3& eye, const glm::vec3& target, float fov_y_rad, int width, int height)
{
    View view;
    if (target == eye) { // no direction, which check_desc() refuses
        view.eye = eye, view.right = view.up = view.forward = glm::vec3(0.0f);
        return view;
    }
    const Basis b = look_basis(target - eye);
    view.eye = eye;
    view.right = b.right;
    view.up = b.up;
    view.forward = b.forward;
    set_fov(view, tan_half(fov_y_rad), width, height);
    view.znear = std::max(kLeastNear, 1e-3f * glm::length(target - eye));
    return view;
}

Result<View> make_view(const Scene& scene, int camera, int width, int height)
{
    if (camera < 0 || static_cast<std::size_t>(camera) >= scene.cameras.size())
        return Error{ExitCode::usage, "", "/cameras/" + std::to_string(camera),
                     "camera " + std::to_string(camera) + ": the scene has " + std::to_string(scene.cameras.size())};
    const Camera& c = scene.cameras[static_cast<std::size_t>(camera)];
    glm::mat4 world(1.0f);
    for (const Node& node : scene.nodes)
        if (node.camera == camera) {
            world = node.world;
            break;
        }
    View view;
    view.eye = glm::vec3(world[3]);
    view.forward = glm::normalize(-glm::vec3(world[2]));
    view.right = glm::normalize(glm::cross(view.forward, glm::vec3(world[1])));
    view.up = glm::cross(view.right, view.forward);
    view.orthographic = c.orthographic;
    view.znear = std::max(c.znear, kLeastNear);
    if (c.orthographic) {
        view.tan_half_x = c.ymag * static_cast<float>(width) / static_cast<float>(height);
        view.tan_half_y = c.ymag;
        view.znear = c.znear;
        view.zfar = c.zfar;
    } else {
        set_fov(view, tan_half(c.yfov), width, height);
    }
    return view;
}

namespace {

// Places the eye so that each side plane touches the outermost vertex. The direction is fixed. Along x, t is the tangent of the half angle
// and z the distance along the view: x_i - t z_i <= x_e - t z_e and -x_i - t z_i <= -x_e - t z_e for an eye at (x_e, z_e).
View framed_from(const DrawTables& tables, int width, int height, const glm::vec3& from, float fov_y_rad,
                 const std::optional<glm::vec3>& target)
{
    constexpr float kMargin = 1.08f;
    const glm::vec3 center = target ? *target : 0.5f * (tables.bounds_min + tables.bounds_max);
    const float radius = std::max(1e-30f, 0.5f * glm::length(tables.bounds_max - tables.bounds_min));
    View view = make_view(center + from, center, fov_y_rad, width, height);
    const float tx = view.tan_half_x / kMargin, ty = view.tan_half_y / kMargin;
    // Find the outermost vertex for each side plane
    float right = -1e30f, left = -1e30f, top = -1e30f, bottom = -1e30f, nearest = 1e30f;
    const auto touch = [&](const glm::vec3& p) {
        const glm::vec3 d = p - center;
        const float x = glm::dot(d, view.right), y = glm::dot(d, view.up), z = glm::dot(d, view.forward);
        right = std::max(right, x - tx * z), left = std::max(left, -x - tx * z);
        top = std::max(top, y - ty * z), bottom = std::max(bottom, -y - ty * z);
        nearest = std::min(nearest, z);
    };
    bool any = false;
    for (const Draw& draw : tables.draws) {
        if (draw.stage)
            continue;
        any = any || draw.triangle_count > 0;
        for (std::size_t i = std::size_t{3} * draw.first_triangle, end = i + std::size_t{3} * draw.triangle_count; i < end; ++i)
            touch({tables.px[tables.indices[i]], tables.py[tables.indices[i]], tables.pz[tables.indices[i]]});
    }
    if (!any)
        for (int i = 0; i < 8; ++i)
            touch({(i & 1 ? tables.bounds_max : tables.bounds_min).x, (i & 2 ? tables.bounds_max : tables.bounds_min).y,
                   (i & 4 ? tables.bounds_max : tables.bounds_min).z});
    if (target) // equal distances from the target to both sides
        right = left = std::max(right, left), top = bottom = std::max(top, bottom);
    // Step back until every plane fits
    const float back = std::min({-(right + left) / (2 * tx), -(top + bottom) / (2 * ty), nearest - 0.05f * radius});
    view.eye = center + view.right * (0.5f * (right - left)) + view.up * (0.5f * (top - bottom)) + view.forward * back;
    view.znear = std::max(std::max(kLeastNear, 1e-6f * std::min(radius, 1.0f)), 0.5f * (nearest - back));
    return view;
}

} // namespace

View auto_frame(const DrawTables& tables, int width, int height, const Framing& f)
{
    const double a = static_cast<double>(f.azimuth_rad), e = static_cast<double>(f.elevation_rad);
    const glm::vec3 from(glm::dvec3(det_cos(e) * det_sin(a), det_sin(e), det_cos(e) * det_cos(a)));
    return framed_from(tables, width, height, from, f.fov_y_rad, f.target);
}

View auto_frame(const DrawTables& tables, int width, int height)
{
    return framed_from(tables, width, height, glm::normalize(glm::vec3(0.35f, 0.35f, 1.0f)), 0.78539816f, {});
}

glm::mat4 clip_from_world(const View& v)
{
    const float sx = 1.0f / v.tan_half_x, sy = -1.0f / v.tan_half_y;
    glm::mat4 m(0.0f);
    for (int i = 0; i < 3; ++i) {
        m[i][0] = v.right[i] * sx;
        m[i][1] = v.up[i] * sy;
    }
    m[3][0] = -glm::dot(v.right, v.eye) * sx;
    m[3][1] = -glm::dot(v.up, v.eye) * sy;
    if (v.orthographic) {
        const float s = 1.0f / (v.zfar - v.znear);
        for (int i = 0; i < 3; ++i)
            m[i][2] = -v.forward[i] * s;
        m[3][2] = (v.zfar + glm::dot(v.forward, v.eye)) * s;
        m[3][3] = 1.0f;
    } else {
        for (int i = 0; i < 3; ++i)
            m[i][3] = v.forward[i];
        m[3][2] = v.znear;
        m[3][3] = -glm::dot(v.forward, v.eye);
    }
    return m;
}

namespace {

// Checks that the view is a camera: finite numbers, orthonormal axes, planes in order.
Status check_view(const View& v)
{
    const auto usage = [](const char* field, const char* reason) {
        return Error{ExitCode::usage, "", std::string("/view/") + field, reason};
    };
    constexpr float kFarthest = 1e18f; // whose square is a float
    for (int c = 0; c < 3; ++c)
        if (!(std::fabs(v.eye[c]) <= kFarthest))
            return usage("eye", "the camera's place lies beyond 1e18 m or is not finite");
    constexpr float kOff = 1e-3f; // tolerance, above rounding errors
    for (const auto& [axis, name] : {std::pair(v.right, "right"), std::pair(v.up, "up"), std::pair(v.forward, "forward")})
        if (!(std::fabs(glm::dot(axis, axis) - 1.0f) <= kOff))
            return usage(name, "an axis of the camera has no unit length");
    if (!(std::fabs(glm::dot(v.right, v.up)) <= kOff && std::fabs(glm::dot(v.up, v.forward)) <= kOff &&
          std::fabs(glm::dot(v.forward, v.right)) <= kOff))
        return usage("forward", "the camera's axes are not at right angles");
    for (const auto& [half, name] : {std::pair(v.tan_half_x, "tan_half_x"), std::pair(v.tan_half_y, "tan_half_y")})
        if (!std::isfinite(half) || half == 0.0f || (half < 0.0f && !v.orthographic))
            return usage(name, "the camera's angle must lie between 0 and 180 degrees");
    if (!std::isfinite(v.znear) || (!v.orthographic && !(v.znear > 0.0f)))
        return usage("znear", "the near plane must lie in front of the camera");
    if (v.orthographic && (!std::isfinite(v.zfar) || !(v.zfar > v.znear)))
        return usage("zfar", "the far plane must lie behind the near one");
    return {};
}

// Checks the techniques and samples of single materials.
Status check_by_material(const FrameDesc& d)
{
    for (std::size_t i = 0; i < d.by_material.size(); ++i) {
        const MaterialTechnique& m = d.by_material[i];
        const auto usage = [&](std::string reason) {
            return Error{ExitCode::usage, "", "", std::move(reason), "FrameDesc::by_material/" + std::to_string(i)};
        };
        const TechniqueInfo* technique = find_technique(m.technique);
        if (!technique)
            return usage("unknown technique '" + m.technique + "'");
        if (technique->traits & kReadsBox)
            return usage(m.technique + " draws all materials or none");
        if (m.samples < 1 || m.samples > technique->most_samples)
            return usage("samples of " + m.technique + " must lie in 1.." + std::to_string(technique->most_samples));
        BN_TRY(check_lobe(d, *technique));
    }
    return {};
}

// Checks one direction of a window.
Status check_window_side(int size, int first, int picture, const char* side)
{
    const auto usage = [&](const std::string& reason) { return Error{ExitCode::usage, "", "", reason, "FrameDesc::window"}; };
    if (picture < 1 || picture > kMaxWindowedSide)
        return usage(fmt::format("the picture's {} of {} pixels must lie in 1..{}", side, picture, kMaxWindowedSide));
    if (first < 0 || first % kWindowStep != 0 || std::int64_t{first} + size > picture)
        return usage(fmt::format("{} pixels from {} on must lie in the picture's {} of {}, and begin at a multiple of {}", size, first,
                                 side, picture, kWindowStep));
    const std::int64_t cell = window_cell(first, size);
    if (picture > kMaxPictureSide && (first < cell * kWindowCell - kWindowStep || first + size > (cell + 1) * kWindowCell + kWindowStep))
        return usage(fmt::format("{} pixels from {} on reach into two cells of {} pixels", size, first, kWindowCell));
    return {};
}

Status check_window(const FrameDesc& d)
{
    const PictureWindow& w = d.window;
    if (w.picture_width == 0 && w.picture_height == 0 && w.left == 0 && w.top == 0)
        return {};
    BN_TRY(check_window_side(d.width, w.left, w.picture_width, "width"));
    return check_window_side(d.height, w.top, w.picture_height, "height");
}

} // namespace

int window_cell(int first, int size)
{
    return (first + size / 2) / kWindowCell;
}

Status check_desc(const FrameDesc& d)
{
    const auto usage = [](const std::string& field, std::string reason) {
        return Error{ExitCode::usage, "", "", std::move(reason), "FrameDesc::" + field};
    };
    const int most_side = kMaxPictureSide + (d.window.picture_width > 0 ? 2 * kWindowStep : 0); // a cell and what lies around it
    for (const auto& [side, name] : {std::pair(d.width, "width"), std::pair(d.height, "height")})
        if (side < 1 || side > most_side)
            return usage(name, fmt::format("{} pixels; the image's sides must lie in 1..{}", side, most_side));
    BN_TRY(check_window(d));
    if (d.msaa != 1 && d.msaa != 2 && d.msaa != 4 && d.msaa != 8 && d.msaa != 16)
        return usage("msaa", "msaa must be 1, 2, 4, 8 or 16");
    if (std::int64_t{d.width} * d.height * d.msaa > kMaxPictureSamples)
        return usage("width", fmt::format("width x height x msaa must not exceed 2^{} samples", kMaxSampleBits));
    if (d.tile_size != 32 && d.tile_size != 64)
        return usage("tile_size", "the tile size must be 32 or 64");
    if (d.texture_anisotropy < 1 || d.texture_anisotropy > 16)
        return usage("texture_anisotropy", "texture anisotropy must lie in 1..16");
    if (!find_technique(d.technique))
        return usage("technique", "unknown technique '" + d.technique + "'");
    if (const int most = find_technique(d.technique)->most_samples; d.samples < 1 || d.samples > most)
        return usage("samples", "samples of " + d.technique + " must lie in 1.." + std::to_string(most));
    for (const ParameterInfo& p : parameters()) { // a float may lie just outside a range of doubles
        const glm::dvec2 value = parameter_of(d, p);
        if (!(std::min(value.x, value.y) >= p.least - 1e-4 && std::max(value.x, value.y) <= p.most + 1e-4))
            return usage(p.name, fmt::format("is out of its range, {:g} to {:g}", p.least, p.most));
    }
    if (!(d.roughness <= 1.0f))
        return usage("roughness", "the roughness must lie in 0..1, or below 0 for that of the materials");
    if (!(std::fabs(d.anisotropy) <= 1.0f))
        return usage("anisotropy", "the anisotropy must lie in -1..1");
    BN_TRY(check_view(d.view));
    BN_TRY(check_by_material(d));
    return check_lobe(d, *find_technique(d.technique));
}

const std::vector<TechniqueInfo>& techniques()
{
    static const std::vector<TechniqueInfo> table = {
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, traits, summary)                                                         \
    {#id, summary, Sampling::sampling, default_samples, most_samples, traits},
#include "shading/models.def"
    };
    return table;
}

namespace {

const TechniqueInfo& technique_with(int trait) // first technique with this trait
{
    return *std::find_if(techniques().begin(), techniques().end(), [=](const TechniqueInfo& t) { return (t.traits & trait) != 0; });
}

} // namespace

const TechniqueInfo& automatic_technique()
{
    static const TechniqueInfo& chosen = technique_with(kAutomatic);
    static const std::string summary = std::string("the best known: ") + chosen.name;
    static const TechniqueInfo info = {"auto", summary.c_str(), chosen.sampling, chosen.default_samples, chosen.most_samples, 0};
    return info;
}

const TechniqueInfo& chosen_technique()
{
    return technique_with(kAutomatic);
}

namespace {

const TechniqueInfo& resolved(const std::string& technique)
{
    return technique == automatic_technique().name ? chosen_technique() : *find_technique(technique);
}

} // namespace

const TechniqueInfo& technique_of(const FrameDesc& desc)
{
    return resolved(desc.technique);
}

const TechniqueInfo& technique_of(const FrameDesc& desc, std::size_t material)
{
    return material < desc.by_material.size() ? resolved(desc.by_material[material].technique) : technique_of(desc);
}

int samples_of(const FrameDesc& desc, std::size_t material)
{
    return material < desc.by_material.size() ? desc.by_material[material].samples : desc.samples;
}

int traits_for(const TechniqueInfo& technique, bool anisotropic)
{
    return (technique.traits & kRoundAlone) && !anisotropic ? technique.traits - kSharesSamples : technique.traits;
}

const TechniqueInfo* find_technique(const std::string& name)
{
    if (name == automatic_technique().name)
        return &automatic_technique();
    for (const TechniqueInfo& technique : techniques())
        if (name == technique.name)
            return &technique;
    return nullptr;
}

const std::vector<ParameterInfo>& parameters()
{
    static const std::vector<ParameterInfo> table = {
#define BN_MEMBER_number(id) &FrameDesc::id, nullptr, nullptr, nullptr, nullptr
#define BN_MEMBER_whole(id) nullptr, &FrameDesc::id, nullptr, nullptr, nullptr
#define BN_MEMBER_flag(id) nullptr, nullptr, &FrameDesc::id, nullptr, nullptr
#define BN_MEMBER_choice(id) nullptr, nullptr, nullptr, &FrameDesc::id, nullptr
#define BN_MEMBER_lobe(id) nullptr, nullptr, nullptr, &FrameDesc::id, nullptr
#define BN_MEMBER_way(id) nullptr, nullptr, nullptr, &FrameDesc::id, nullptr
#define BN_MEMBER_angles(id) nullptr, nullptr, nullptr, nullptr, &FrameDesc::id##_rad
#define BN_PARAMETER(id, kind, option, fallback, least, most, unit, summary, readers)                                                      \
    {#id, option, fallback, least, most, unit, summary, readers, BN_MEMBER_##kind(id), #kind},
#include "shading/models.def"
    };
    return table;
}

bool reads(const std::string& technique, const ParameterInfo& p)
{
    constexpr std::string_view kAllBut = "all but ";
    std::string names = p.readers;
    const bool all_but = names.starts_with(kAllBut);
    names = names.substr(all_but ? kAllBut.size() : 0) + " ";
    for (std::size_t at = 0, end; (end = names.find(' ', at)) != std::string::npos; at = end + 1)
        if (technique.compare(0, end - at, names, at, end - at) == 0)
            return !all_but;
    return all_but;
}

glm::dvec2 parameter_of(const FrameDesc& desc, const ParameterInfo& p)
{
    if (p.angles)
        return glm::degrees(glm::dvec2(desc.*p.angles));
    if (p.number)
        return glm::dvec2(static_cast<double>(desc.*p.number));
    if (p.whole)
        return glm::dvec2(static_cast<double>(desc.*p.whole));
    return glm::dvec2(p.flag ? desc.*p.flag : desc.*p.choice);
}

std::vector<std::string> choices_of(const ParameterInfo& p)
{
    std::vector<std::string> names;
    if (!p.choice)
        return names;
    if (p.kind == "way") {
        for (const AreaWayInfo& way : area_ways())
            names.emplace_back(way.name);
        return names;
    }
    if (p.kind == "lobe") {
        for (int lobe = 0; lobe < kLobeCount; ++lobe)
            names.emplace_back(lobe_model(lobe).name);
        return names;
    }
    std::istringstream text(p.unit);
    for (std::string name; std::getline(text, name, '|');)
        names.push_back(name);
    return names;
}

Status set_parameter(FrameDesc& desc, const ParameterInfo& p, double value)
{
    const auto wrong = [&](std::string reason) {
        return Error{ExitCode::usage, "", "", std::move(reason), std::string("FrameDesc::") + p.name};
    };
    if (!(value >= p.least && value <= p.most))
        return wrong(fmt::format("{} is out of range, {} to {}", value, p.least, p.most));
    if (!p.number && !p.angles && value != std::floor(value))
        return wrong(fmt::format("{} is no whole number", value));
    if (p.number)
        desc.*p.number = static_cast<float>(value);
    else if (p.flag)
        desc.*p.flag = value != 0.0;
    else if (p.choice)
        desc.*p.choice = static_cast<int>(value);
    else if (p.angles)
        desc.*p.angles = glm::vec2(static_cast<float>(glm::radians(value)));
    else
        desc.*p.whole = static_cast<std::uint32_t>(value);
    return {};
}

int effective_samples(const TechniqueInfo& technique, int samples)
{
    samples = std::min(samples, technique.most_samples);
    if (technique.sampling == Sampling::none)
        return 1;
    if (technique.sampling == Sampling::count)
        return samples;
    int side = 1;
    while ((side + 1) * (side + 1) <= samples)
        ++side;
    return side * side;
}

namespace {

int lobe_named(std::string_view name)
{
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (name == #id)                                                                                                                       \
        return at;
#include "shading/models.def"
    return -1;
}

} // namespace

const std::vector<ModelInfo>& models()
{
    static const std::vector<ModelInfo> table = {
#define BN_MODEL(id, summary, params, laws, settings) {#id, summary, lobe_named(#id), lobe_traits_of(lobe_named(#id))},
#include "shading/models.def"
    };
    return table;
}

const std::vector<AreaWayInfo>& area_ways()
{
    static const std::vector<AreaWayInfo> table = {
#define BN_AREA_LIGHTS(id, at, name, summary) {name, summary},
#include "shading/models.def"
    };
    return table;
}

const ModelInfo& lobe_model(int lobe)
{
    return *std::find_if(models().begin(), models().end(), [=](const ModelInfo& m) { return m.lobe == lobe; });
}

int lobe_of(const FrameDesc& d, bool tilted)
{
    const bool separable = d.masking != 0;
    if (!(lobe_traits_of(d.brdf) & kDefaultLobe) || !(tilted || separable))
        return d.brdf;
    return lobe_with(!separable ? kTiltedLobe : tilted ? kSeparableTiltedLobe : kSeparableLobe);
}

Status check_lobe(const FrameDesc& d, const TechniqueInfo& technique)
{
    const bool tilted = d.tilt_rad != glm::vec2(0.0f);
    const int lobe = lobe_of(d, tilted);
    const std::string name = lobe_model(lobe).name;
    if (tilted && !(lobe_traits_of(lobe) & kLies_surface))
        return Error{ExitCode::usage, "", "",
                     "lobes of " + name + " cannot be tilted; those of " + lobe_model(lobe_with(kTiltedLobe)).name + " can",
                     "FrameDesc::tilt"};
    if (d.masking != 0 && !(lobe_traits_of(d.brdf) & kDefaultLobe))
        return Error{ExitCode::usage, "", "",
                     "lobes of " + name + " have a masking of their own; that of " + lobe_model(lobe_with(kDefaultLobe)).name +
                         " can be chosen",
                     "FrameDesc::masking"};
    if (!(technique.traits & kSamplesLobe) && !(lobe_traits_of(d.brdf) & kDefaultLobe))
        return Error{ExitCode::usage, "", "",
                     std::string(technique.name) + " is made for " + lobe_model(lobe_with(kDefaultLobe)).name +
                         ", not for FrameDesc::brdf " + name + " (FrameDesc::technique mc and SessionOptions::backend reference take it)",
                     "FrameDesc::technique"};
    return {};
}

std::uint64_t pixel_hash(const Image& image)
{
    const std::uint32_t header[3] = {static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height),
                                     static_cast<std::uint32_t>(image.channels)};
    return hash_bytes(image.bytes.data(), image.bytes.size(), hash_bytes(header, sizeof header));
}

Image with_coverage(const Image& color, const Column<std::uint32_t>& triangle_ids, const Column<float>& through)
{
    const std::size_t pixels = static_cast<std::size_t>(color.width) * static_cast<std::size_t>(color.height);
    BN_CHECK(color.type == PixelType::f32 && color.channels == 3 && !triangle_ids.empty() && triangle_ids.size() % pixels == 0);
    const std::size_t msaa = triangle_ids.size() / pixels;
    Image out = make_image(color.width, color.height, 4, PixelType::f32);
    for (std::size_t p = 0; p < pixels; ++p) {
        float covered = 0.0f;
        for (std::size_t i = p * msaa; i < (p + 1) * msaa; ++i)
            covered += triangle_ids.data()[i] != kNoTriangle ? 1.0f : through.empty() ? 0.0f : 1.0f - through.data()[i];
        std::copy_n(color.f32() + 3 * p, 3, out.f32() + 4 * p);
        out.f32()[4 * p + 3] = covered / static_cast<float>(msaa);
    }
    return out;
}

std::uint64_t count_not_finite(const Image& image)
{
    if (image.bytes.empty())
        return 0;
    BN_CHECK(image.type == PixelType::f32);
    const std::size_t channels = static_cast<std::size_t>(image.channels), words = image.bytes.size() / sizeof(float);
    const float* const v = image.f32();
    // Nearly all pictures are finite: find that without branches first
    constexpr float kMost = std::numeric_limits<float>::max();
    unsigned all = 1;
    for (std::size_t i = 0; i < words; ++i)
        all &= static_cast<unsigned>(std::fabs(v[i]) <= kMost); // false for NaN
    if (all)
        return 0;
    std::uint64_t bad = 0;
    for (std::size_t p = 0; p + channels <= words; p += channels)
        bad += std::all_of(v + p, v + p + channels, [](float x) { return std::isfinite(x); }) ? 0 : 1;
    return bad;
}

} // namespace burnish
