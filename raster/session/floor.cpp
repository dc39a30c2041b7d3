#include "raster/session/floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/cache.h"
#include "core/base/hash.h"
#include "core/jobs/activity.h"
#include "core/jobs/control.h"
#include "core/jobs/jobs.h"
#include "core/math/scalar_math.h"
#include "core/scene/draw_tables.h"
#include "core/scene/grid.h"
#include "core/scene/tangents.h"
#include "raster/rays/ray_tree.h"
#include "raster/session/visibility_cache.h"

namespace burnish {
namespace {

// Radii and heights are in scene radii. A scene's radius is half its bounds' diagonal.
constexpr int kSectors = 256;    // around the centre
constexpr int kFloorRings = 144; // of vertices on the floor
constexpr int kCoveRings = 48;   // on the backdrop
constexpr double kFloorRadius = 3.0;
constexpr double kWallRadius = 6.0, kCoveRadius = 2.5, kWallHeight = 6.0, kTop = 9.0;
constexpr int kFloorRays = 256, kVertexRays = 64; // of a vertex
constexpr std::size_t kMostDarkened = 1u << 20;   // vertices in a scene that is darkened
constexpr double kSpread = 0.015;                 // around a vertex, about the distance to the next
constexpr double kLift = 1e-4;                    // from the scene's lowest place up to a ray's origin
constexpr double kBelow = 2e-3;                   // from that place down to the floor, so that the scene's own ground hides the floor

double mix(double a, double b, double t)
{
    return a + (b - a) * t;
}

double smooth(double a, double b, double x)
{
    const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

struct Place { // on the profile that turns around the scene's axis
    double radius, height;
};

// Returns a ring's radius on the floor. Rings are dense near the centre, where shadows are.
double floor_radius(int ring)
{
    const double t = static_cast<double>(ring) / kFloorRings;
    return kFloorRadius * mix(t, t * t, 0.6);
}

// Returns the backdrop's profile, from the floor's rim to the top.
Place backdrop_place(int ring)
{
    const double t = 4.0 * ring / kCoveRings, start = kWallRadius - kCoveRadius;
    const double part = std::min(t, 4.0) - std::floor(std::min(t, 3.999999));
    if (t < 1.0)
        return {mix(kFloorRadius, start, part), 0.0};
    const double angle = 0.5 * kPi * part;
    if (t < 2.0)
        return {start + kCoveRadius * det_sin(angle), kCoveRadius * (1.0 - det_cos(angle))};
    if (t < 3.0)
        return {kWallRadius, mix(kCoveRadius, kWallHeight, part)};
    return {ring == kCoveRings ? 0.0 : kWallRadius * det_cos(angle), mix(kWallHeight, kTop, det_sin(angle))};
}

// Returns the light that falls on a place on the stage: a pool around the scene that fades outwards and upwards.
double pool_of_light(const Place& p)
{
    return mix(0.1, 1.0, 1.0 - smooth(0.6, 6.0, p.radius + p.height));
}

Material floor_material(const char* name)
{
    Material m;
    m.name = name;
    m.base_color = glm::vec4(0.2f, 0.2f, 0.2f, 1.0f);
    m.metallic = 0.0f, m.roughness = 1.0f, m.specular = 0.0f;
    return m;
}

// Returns directions about +Z with equal weights under a cosine (Malley's method over a Hammersley set).
std::vector<glm::dvec3> sky_directions(int count)
{
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < count; ++i) {
        double turned = 0.0, digit = 0.5; // the radical inverse
        for (auto bits = static_cast<unsigned>(i); bits; bits >>= 1, digit *= 0.5)
            turned += (bits & 1u) * digit;
        const double radius2 = (i + 0.5) / count, angle = 2.0 * kPi * turned, radius = std::sqrt(radius2);
        directions.push_back({radius * det_cos(angle), radius * det_sin(angle), std::sqrt(1.0 - radius2)});
    }
    return directions;
}

struct Seer { // a place that looks at the sky
    glm::dvec3 place, normal;
};

// Returns points in the unit disc, one for each ray from a place (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
std::vector<glm::dvec2> disc_points(int count)
{
    std::vector<glm::dvec2> points;
    for (int i = 0; i < count; ++i) {
        const double a = 0.7548776662466927 * i, b = 0.5698402909980532 * i, angle = 2.0 * kPi * (b - std::floor(b));
        points.push_back(glm::dvec2(det_cos(angle), det_sin(angle)) * std::sqrt(a - std::floor(a)));
    }
    return points;
}

// Returns the sky share that each place sees. spread: the radius around a place where its rays begin, metres. With it a thin wall
// that stands on the place hides what it hides beside the place.
std::vector<float> visibility_of(const std::vector<Seer>& seers, int ray_count, double spread, const RayScene& rays, const Jobs& jobs)
{
    const std::vector<glm::dvec3> sky = sky_directions(ray_count);
    const std::vector<glm::dvec2> begins = disc_points(ray_count);
    std::vector<float> seen(seers.size());
    jobs.parallel_for((seers.size() + kRays - 1) / kRays, [&](std::size_t packet, int) {
        RayPacket k = {};
        glm::dvec3 place[kRays], across[kRays], along[kRays], normal[kRays];
        int free[kRays] = {};
        for (std::size_t i = 0; i < kRays; ++i) {
            const Seer& seer = seers[std::min(packet * kRays + i, seers.size() - 1)];
            place[i] = seer.place, normal[i] = seer.normal;
            across[i] = glm::dvec3(any_tangent(glm::vec3(seer.normal)));
            along[i] = glm::cross(normal[i], across[i]);
        }
        for (std::size_t ray = 0; ray < sky.size(); ++ray) {
            const glm::dvec3 d = sky[ray];
            const glm::dvec2 begin = begins[ray] * spread;
            for (std::size_t i = 0; i < kRays; ++i) {
                const glm::dvec3 from = place[i] + across[i] * begin.x + along[i] * begin.y;
                k.org_x[i] = static_cast<float>(from.x), k.org_y[i] = static_cast<float>(from.y), k.org_z[i] = static_cast<float>(from.z);
                const glm::dvec3 to = across[i] * d.x + along[i] * d.y + normal[i] * d.z;
                k.dir_x[i] = static_cast<float>(to.x), k.dir_y[i] = static_cast<float>(to.y), k.dir_z[i] = static_cast<float>(to.z);
                k.tnear[i] = 0.0f, k.tfar[i] = std::numeric_limits<float>::infinity(), k.valid[i] = -1;
            }
            rays.trace(k, RayKind::occlusion);
            for (std::size_t i = 0; i < kRays; ++i)
                free[i] += k.tfar[i] >= 0.0f;
        }
        for (std::size_t i = 0; i < kRays && packet * kRays + i < seers.size(); ++i)
            seen[packet * kRays + i] = static_cast<float>(free[i]) / static_cast<float>(ray_count);
    });
    return seen;
}

// Returns the materials that hide no sky from a floor.
std::vector<bool> clear_materials(const Scene& scene)
{
    std::vector<bool> clear;
    for (const Material& m : scene.materials)
        clear.push_back(m.unlit || m.alpha_mode == AlphaMode::blend || m.transmission > 0.0f);
    return clear;
}

// Finds the sky's visibility; looks in the cache first.
class SkyFinder {
  public:
    SkyFinder(const Scene& scene, const DrawTables& tables, const FloorSettings& settings)
        : scene_(scene), tables_(tables), clear_(clear_materials(scene)), use_cache_(settings.use_cache), jobs_(settings.threads)
    {
    }
    std::vector<float> find(const std::vector<Seer>& seers, int ray_count, double spread)
    {
        const std::uint64_t hash = use_cache_ ? hash_of(seers, ray_count, spread) : 0;
        const std::string path = use_cache_ ? visibility_path(hash) : "";
        if (path.empty())
            return trace(seers, ray_count, spread);
        std::optional<std::vector<float>> cached = read_visibility_cache(path, hash, seers.size());
        if (cached)
            return std::move(*cached);
        std::optional<CacheLock> lock; // until the visibility is cached
        {
            const Activity activity("waiting for another process that finds contact shadows");
            lock.emplace(path, kMostLockSeconds, check_stop);
        }
        if (std::optional<std::vector<float>> made = read_visibility_cache(path, hash, seers.size()))
            return std::move(*made);
        std::vector<float> found = trace(seers, ray_count, spread);
        static_cast<void>(write_visibility_cache(path, hash, found)); // a failure costs the next run its time
        return found;
    }

  private:
    std::vector<float> trace(const std::vector<Seer>& seers, int ray_count, double spread)
    {
        const TraceSpan span("contact shadows");
        const Activity activity("contact shadows");
        if (!rays_)
            rays_ = make_tree_scene(scene_, tables_, jobs_, best_isa(), clear_);
        return visibility_of(seers, ray_count, spread, *rays_, jobs_);
    }
    // Returns a hash over everything that decides the visibility.
    std::uint64_t hash_of(const std::vector<Seer>& seers, int ray_count, double spread) const
    {
        std::vector<std::uint8_t> hides;
        for (std::size_t i = 0; i < clear_.size(); ++i)
            hides.push_back(!clear_[i] && scene_.materials[i].emitter != kOpenEmitter);
        const double figures[] = {kVersion, static_cast<double>(ray_count), spread};
        std::uint64_t hash = hash_bytes(figures, sizeof figures);
        const auto add = [&hash](const auto& column) { hash = hash_bytes(column.data(), column.size() * sizeof *column.data(), hash); };
        add(seers), add(hides);
        add(tables_.px), add(tables_.py), add(tables_.pz), add(tables_.indices), add(tables_.triangle_material);
        return hash;
    }
    static constexpr double kVersion = 1.0; // raise it when rays or directions change

    const Scene& scene_;
    const DrawTables& tables_;
    std::vector<bool> clear_;
    bool use_cache_;
    Jobs jobs_;
    std::unique_ptr<RayScene> rays_; // made when a ray is wanted
};

// Returns true if vertex colours may hold the sky's visibility: such colours dim the scene's lamplight too.
bool darkens_vertices(const DrawTables& tables)
{
    const bool lamps = std::any_of(tables.lights.begin(), tables.lights.end(), [](const PunctualLight& l) { return !l.directional; });
    return !lamps && tables.area_lights.empty() && tables.px.size() <= kMostDarkened;
}

// Returns the vertices' visibility on dielectrics without vertex colours, and makes their primitives use colours. lift: from their surfaces
// up to the rays' origins, metres.
Column<float> visibility_of_vertices(Scene& scene, const DrawTables& tables, double lift, SkyFinder& sky)
{
    std::vector<std::uint32_t> vertices, darkened;
    std::vector<Seer> seers;
    for (const Draw& draw : tables.draws) {
        const Material& m = scene.materials[static_cast<std::size_t>(draw.material)];
        const Primitive& primitive = scene.primitives[draw.primitive];
        if (primitive.has_color || m.metallic != 0.0f || m.unlit || m.transmission != 0.0f || m.alpha_mode == AlphaMode::blend ||
            m.emitter != kNoEmitter)
            continue;
        darkened.push_back(draw.primitive);
        for (std::uint32_t v = draw.first_vertex; v < draw.first_vertex + draw.vertex_count; ++v) {
            const ShadingVertex& at = tables.shading[v];
            const glm::dvec3 n(glm::vec3(at.normal[0], at.normal[1], at.normal[2]));
            vertices.push_back(v);
            seers.push_back({glm::dvec3(glm::vec3(tables.px[v], tables.py[v], tables.pz[v])) + n * lift, n});
        }
    }
    for (const std::uint32_t primitive : darkened)
        scene.primitives[primitive].has_color = true;
    Column<float> all;
    if (vertices.empty())
        return all;
    const std::vector<float> seen = sky.find(seers, kVertexRays, 0.0);
    all.resize(tables.px.size());
    std::fill(all.data(), all.data() + all.size(), 1.0f);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        all[vertices[i]] = seen[i];
    return all;
}

// Returns the bounds around all that is no light; around the lights where there is nothing else.
std::pair<glm::dvec3, glm::dvec3> bounds_of_things(const Scene& scene, const DrawTables& tables)
{
    glm::dvec3 low(tables.bounds_min), high(tables.bounds_max);
    bool any = false;
    for (const Draw& draw : tables.draws) {
        if (scene.materials[static_cast<std::size_t>(draw.material)].emitter != kNoEmitter)
            continue;
        low = any ? glm::min(low, glm::dvec3(draw.bounds_min)) : glm::dvec3(draw.bounds_min);
        high = any ? glm::max(high, glm::dvec3(draw.bounds_max)) : glm::dvec3(draw.bounds_max);
        any = true;
    }
    return {low, high};
}

struct Ground { // where the floor lies
    glm::dvec3 centre;
    double radius; // the scene's, metres
};

class FloorBuilder {
  public:
    FloorBuilder(Scene& scene, const Ground& ground) : scene_(scene), ground_(ground)
    {
        for (int sector = 0; sector < kSectors; ++sector) {
            const double angle = 2.0 * kPi * sector / kSectors;
            around_[static_cast<std::size_t>(sector)] = {det_cos(angle), -det_sin(angle)};
        }
    }
    glm::dvec3 position(int sector, const Place& p) const
    {
        const glm::dvec2 a = around_[static_cast<std::size_t>(sector % kSectors)] * (p.radius * ground_.radius);
        return ground_.centre + glm::dvec3(a.x, p.height * ground_.radius, a.y);
    }
    // Adds a surface made from rings. shade(sector, ring): vertex colour. Its normals point up, so it is lit evenly.
    template <class Profile, class Shade>
    void add(const char* name, std::int32_t material, int rings, const Profile& profile, const Shade& shade)
    {
        const std::uint32_t primitive = begin_primitive(scene_, material);
        add_grid(scene_, kSectors, rings, [&](int sector, int row) {
            const int ring = rings - row; // from the rim inwards, so that fronts face the scene
            const Place place = profile(ring);
            SurfacePoint s;
            s.position = position(sector, place);
            s.normal = {0.0, 1.0, 0.0}, s.tangent = {1.0, 0.0, 0.0};
            s.u = static_cast<double>(sector) / kSectors, s.v = static_cast<double>(row) / rings;
            s.shade = shade(sector % kSectors, ring);
            return s;
        });
        glm::mat4 place(1.0f);
        place[3] = glm::vec4(glm::vec3(scene_.origin), 1.0f); // the vertices are already in drawing coordinates
        add_node(scene_, name, add_mesh(scene_, name, primitive), place);
        scene_.nodes.back().stage = true;
    }

  private:
    Scene& scene_;
    Ground ground_;
    std::array<glm::dvec2, kSectors> around_;
};

} // namespace

void darken_vertices(DrawTables& tables, const Column<float>& visibility)
{
    for (std::size_t v = 0; v < std::min(visibility.size(), tables.shading.size()); ++v)
        for (int c = 0; c < 3; ++c)
            tables.shading[v].color[c] *= visibility[v];
}

Result<Column<float>> lay_floor(Scene& scene, const FloorSettings& settings, const Limits& limits, const std::string& file)
{
    Column<float> of_vertices;
    if (settings.kind == FloorKind::off)
        return of_vertices;
    if (settings.kind != FloorKind::shadow && settings.kind != FloorKind::stage && settings.kind != FloorKind::mirror)
        return Error{ExitCode::usage, "", "", fmt::format("{} is no floor", static_cast<int>(settings.kind)), "FloorSettings::kind"};
    BN_TRY(check_draw_size(scene, limits, file));
    const DrawTables tables = make_draw_tables(scene);
    if (tables.draws.empty())
        return of_vertices;
    // Find the ground under the scene
    const auto [low, high] = bounds_of_things(scene, tables);
    const double radius = std::max(0.5 * glm::length(high - low), 1e-6);
    const Ground ground{{0.5 * (low.x + high.x), low.y - kBelow * radius, 0.5 * (low.z + high.z)}, radius};
    FloorBuilder builder(scene, ground);
    // Find the sky's visibility
    constexpr std::size_t kRow = kSectors;
    std::vector<float> seen((kFloorRings + 1) * kRow, 1.0f);
    if (settings.shaded) {
        SkyFinder sky(scene, tables, settings);
        std::vector<Seer> seers(seen.size());
        for (int ring = 0; ring <= kFloorRings; ++ring)
            for (int sector = 0; sector < kSectors; ++sector)
                seers[static_cast<std::size_t>(ring) * kRow + static_cast<std::size_t>(sector)] = {
                    builder.position(ring == 0 ? 0 : sector, {floor_radius(ring), kBelow + kLift}), {0.0, 1.0, 0.0}};
        seen = sky.find(seers, kFloorRays, kSpread * radius);
        if (darkens_vertices(tables))
            of_vertices = visibility_of_vertices(scene, tables, kLift * radius, sky);
    }
    // Add the surfaces
    const bool fades = settings.kind == FloorKind::shadow;
    const auto shade_of = [&](int sector, int ring) {
        const double r = floor_radius(ring);
        const double own = static_cast<double>(seen[static_cast<std::size_t>(ring) * kRow + static_cast<std::size_t>(sector)]);
        return mix(own, 1.0, smooth(0.6 * kFloorRadius, kFloorRadius, r)) * (fades ? 1.0 : pool_of_light({r, 0.0}));
    };
    const auto material = static_cast<std::int32_t>(scene.materials.size());
    scene.materials.push_back(floor_material("floor"));
    if (settings.kind == FloorKind::mirror && !settings.shaded)
        scene.materials.back().specular = 1.0f, scene.materials.back().roughness = 0.0f;
    const std::size_t first = scene.vertices.size();
    builder.add(
        "floor", material, kFloorRings,
        [](int ring) {
            return Place{floor_radius(ring), 0.0};
        },
        shade_of);
    if (fades) {
        scene.materials.back().alpha_mode = AlphaMode::blend;
        for (std::size_t i = first; i < scene.vertices.size(); ++i) {
            const double x = static_cast<double>(scene.vertices.px[i]) - ground.centre.x;
            const double z = static_cast<double>(scene.vertices.pz[i]) - ground.centre.z;
            scene.vertices.ca[i] = static_cast<float>(1.0 - smooth(0.5, 1.0, std::sqrt(x * x + z * z) / (kFloorRadius * radius)));
        }
        return of_vertices;
    }
    scene.materials.push_back(floor_material("backdrop"));
    scene.materials.back().emitter = kOpenEmitter; // light passes through the backdrop
    builder.add("backdrop", material + 1, kCoveRings, backdrop_place, [](int, int ring) { return pool_of_light(backdrop_place(ring)); });
    return of_vertices;
}

} // namespace burnish
