// Cloth: a velvet ball, a felt ball, and a drape of satin behind them. Satin's threads hang down, so its highlights run across
// the folds.
#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

constexpr double kClothBall = 0.06;                       // radius, metres
constexpr double kDrapeWidth = 0.52, kDrapeHeight = 0.26; // of the drape, metres
constexpr double kDrapeFold = 0.018;                      // half the depth of its folds, metres

Material fibres(const char* name, const glm::vec3& colour, const glm::vec3& sheen, float sheen_roughness)
{
    Material m;
    m.name = name;
    m.base_color = glm::vec4(colour, 1.0f);
    m.metallic = 0.0f, m.roughness = 0.8f, m.specular = 0.5f;
    m.sheen_color = sheen, m.sheen_roughness = sheen_roughness;
    return m;
}

Material satin()
{
    Material m = fibres("satin", glm::vec3(0.62f, 0.45f, 0.24f), glm::vec3(0.2f, 0.17f, 0.12f), 0.4f);
    m.metallic = 0.6f, m.roughness = 0.42f, m.specular = 1.0f;
    m.anisotropy_strength = 0.7f; // along the tangent, across the threads
    m.double_sided = true;
    return m;
}

// Returns the drape's depth: seven folds that lean and flatten towards the top.
double depth_at(double u, double v)
{
    const double deep = kDrapeFold * (0.45 + 0.55 * (1.0 - v));
    return deep * det_sin(2.0 * kPi * 7.0 * u + 1.1 * det_sin(2.0 * kPi * (u + 0.35 * v))) +
           0.3 * deep * det_sin(2.0 * kPi * 3.0 * u + 2.0);
}

void add_drape(Scene& scene)
{
    constexpr int kColumns = 280, kRows = 48;
    add_grid(scene, kColumns, kRows, [](int column, int row) {
        constexpr double kStep = 1e-4;
        const double u = static_cast<double>(column) / kColumns, v = static_cast<double>(row) / kRows;
        const double along_u = (depth_at(u + kStep, v) - depth_at(u - kStep, v)) / (2.0 * kStep * kDrapeWidth);
        const double along_v = (depth_at(u, v + kStep) - depth_at(u, v - kStep)) / (2.0 * kStep * kDrapeHeight);
        SurfacePoint s;
        s.position = {(u - 0.5) * kDrapeWidth, v * kDrapeHeight, depth_at(u, v)};
        s.normal = glm::normalize(glm::dvec3(-along_u, -along_v, 1.0));
        s.tangent = glm::normalize(glm::dvec3(1.0, 0.0, along_u));
        s.u = u, s.v = 1.0 - v;
        return s;
    });
}

} // namespace

Scene make_cloth()
{
    Scene scene;
    scene.name = "cloth";
    const auto ball = [](Scene& s) { add_sphere(s, 96, 48, kClothBall); };
    const auto high = static_cast<float>(kClothBall);
    add_part(scene, satin(), {0.0f, 0.0f, -0.12f}, add_drape);
    add_part(scene, fibres("velvet", glm::vec3(0.12f, 0.004f, 0.012f), glm::vec3(0.9f, 0.25f, 0.3f), 0.35f), {-0.075f, high, 0.02f}, ball);
    add_part(scene, fibres("felt", glm::vec3(0.03f, 0.12f, 0.09f), glm::vec3(0.25f, 0.4f, 0.35f), 0.8f), {0.075f, high, 0.02f}, ball);
    Camera camera;
    camera.name = "front", camera.yfov = 0.34f, camera.znear = 0.05f;
    scene.cameras.push_back(camera);
    Node view = looking("front", glm::vec3(0.0f, 0.2f, 0.74f), glm::vec3(0.0f, 0.085f, 0.0f));
    view.camera = 0;
    scene.nodes.push_back(view);
    return scene;
}

} // namespace burnish
