// Thin films: turned titanium under oxide of growing thickness, in the colours that anodising gives. Before it lie two balls of black
// glass under lustre. One film is even; the other one runs down and gathers.
#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"
#include "core/scene/texture.h"

namespace burnish {
namespace {

constexpr double kRod = 0.0175, kRodHeight = 0.13;                                       // radius and height, metres
constexpr double kFilmBall = 0.036;                                                      // radius, metres
constexpr float kOxideIor = 2.4f;                                                        // titanium dioxide
constexpr float kLustreIor = 2.1f;                                                       // metal salts burnt in
constexpr float kOxide[] = {25.0f, 38.0f, 52.0f, 70.0f, 100.0f, 130.0f, 170.0f, 215.0f}; // thickness, nm
constexpr int kRods = 8;

// Highlights run along the rod: turning leaves grooves around it.
Material titanium(float oxide)
{
    Material m = brushed_metal(0.36, 0.7, {0.542f, 0.497f, 0.449f});
    m.name = "titanium under oxide";
    m.iridescence = 1.0f, m.iridescence_ior = kOxideIor, m.iridescence_thickness = oxide;
    return m;
}

Material black_glass(const char* name, float roughness, float thickness)
{
    Material m;
    m.name = name;
    m.base_color = glm::vec4(0.012f, 0.012f, 0.014f, 1.0f);
    m.metallic = 0.0f, m.roughness = roughness;
    m.iridescence = 1.0f, m.iridescence_ior = kLustreIor, m.iridescence_thickness = thickness;
    return m;
}

// An upright rod with a round top. The profile goes up the side in the first half of the rows, then over the top.
void add_rod(Scene& scene)
{
    constexpr int kTurn = 96, kSide = 4, kTop = 12;
    add_grid(scene, kTurn, kSide + kTop, [](int column, int row) {
        const double turn = 2.0 * kPi * (column % kTurn) / kTurn, east = det_sin(turn), south = det_cos(turn);
        const double straight = kRodHeight - kRod;
        const double angle = row <= kSide ? 0.0 : 0.5 * kPi * (row - kSide) / kTop;
        const double up = row <= kSide ? straight * row / kSide : straight + kRod * det_sin(angle);
        const double out = row == kSide + kTop ? 0.0 : det_cos(angle);
        SurfacePoint s;
        s.position = {kRod * out * east, up, kRod * out * south};
        s.normal = {out * east, det_sin(angle), out * south};
        s.tangent = {-det_sin(angle) * east, out, -det_sin(angle) * south};
        s.u = static_cast<double>(column) / kTurn, s.v = 1.0 - up / kRodHeight;
        return s;
    });
}

// A film's thickness in green: thin at the top, with folds that hang down.
glm::dvec3 running_film(double u, double v)
{
    const double folds = det_sin(2.0 * kPi * (3.0 * u + 0.25 * det_sin(2.0 * kPi * (u + v)))) * det_sin(kPi * v);
    return {1.0, 0.15 + 0.6 * v + 0.12 * folds, 0.0};
}

} // namespace

Scene make_anodised()
{
    Scene scene;
    scene.name = "anodised";
    for (int i = 0; i < kRods; ++i) {
        const double place = i - 0.5 * (kRods - 1);
        add_part(scene, titanium(kOxide[i]), {static_cast<float>(0.046 * place), 0.0f, static_cast<float>(-0.02 - 0.0022 * place * place)},
                 add_rod);
    }
    const auto ball = [](Scene& s) { add_sphere(s, 96, 48, kFilmBall); };
    const auto high = static_cast<float>(kFilmBall);
    add_part(scene, black_glass("lustre", 0.15f, 310.0f), {-0.055f, high, 0.07f}, ball);
    Material running = black_glass("running lustre", 0.1f, 700.0f);
    running.iridescence_thickness_least = 80.0f;
    running.iridescence_thickness_tex.texture = add_texture(scene, "thickness", map_of(128, 128, running_film));
    add_part(scene, running, {0.055f, high, 0.07f}, ball);
    Camera camera;
    camera.name = "front", camera.yfov = 0.32f, camera.znear = 0.05f;
    scene.cameras.push_back(camera);
    Node view = looking("front", glm::vec3(0.0f, 0.16f, 0.74f), glm::vec3(0.0f, 0.058f, 0.0f));
    view.camera = 0;
    scene.nodes.push_back(view);
    return scene;
}

} // namespace burnish
