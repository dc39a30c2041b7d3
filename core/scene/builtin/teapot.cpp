// The Utah teapot after Martin Newell's control points (University of Utah, 1975): 32 bicubic Bezier patches.
// Symmetries reduce 306 points to 41. Body, lid and bottom are profiles rotated about the axis along a quarter curve,
// whose inner points stand at 0.56 of the radius. Handle and spout are mirrored cross-sections. (Newell rounded 0.8 *
// 0.56 to 0.45 in the knob; here it is 0.448.) Two flat pieces close views inside: between lid and rim, and in the
// spout. Newell's space: +z up, the spout towards +x, 3.15 high.
#include <array>
#include <cmath>

#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

constexpr double kMetres = 0.05;       // metres in Newell's unit: the pot is 16 cm high
constexpr double kQuarterInner = 0.56; // Newell's quarter circle: (1, 0), (1, .56), (.56, 1), (0, 1)
constexpr int kQuarterColumns = 32, kProfileRows = 16, kSweepRows = 24, kSectionColumns = 32;

using Profile = glm::dvec2; // radius, height

// Each curve begins at the end of the previous one. The outside is on the right.
constexpr std::array<Profile, 13> kBody = {
    Profile(0.0, 0.0),                                                                        // bottom
    {1.425, 0.0},      {1.5, 0.075},      {1.5, 0.15}, {1.5, 0.225}, {2.0, 0.45}, {2.0, 0.9}, // lower body
    {2.0, 1.35},       {1.75, 1.875},     {1.5, 2.4},                                         // upper body
    {1.4375, 2.53125}, {1.3375, 2.53125}, {1.4, 2.4},                                         // rim, over and in
};
constexpr std::array<Profile, 4> kGap = {Profile(1.4, 2.4), {1.375, 2.4}, {1.325, 2.4}, {1.3, 2.4}};
constexpr std::array<Profile, 7> kLid = {
    Profile(1.3, 2.4), {1.3, 2.55}, {0.4, 2.55}, {0.2, 2.7}, // lid
    {0.0, 2.85},       {0.8, 3.15}, {0.0, 3.15},             // knob
};
// The pot's stand: a low disc with a rounded edge.
constexpr std::array<Profile, 7> kStand = {
    Profile(3.25, -0.3), {3.35, -0.3}, {3.4, -0.25}, {3.4, -0.15}, {3.4, -0.06}, {3.35, -0.01}, {3.25, -0.01},
};
constexpr std::array<Profile, 4> kStandTop = {Profile(3.25, -0.01), {2.2, -0.01}, {1.1, -0.01}, {0.0, -0.01}};

// A cross-section of handle or spout: Bezier points a, a + w y, b + w y, b, and their mirror image.
struct Section {
    double ax, az, bx, bz, half_width;
};
constexpr std::array<Section, 7> kHandle = {
    Section{-1.6, 2.025, -1.5, 2.25, 0.3}, {-2.3, 2.025, -2.5, 2.25, 0.3},    {-2.7, 2.025, -3.0, 2.25, 0.3}, {-2.7, 1.8, -3.0, 1.8, 0.3},
    {-2.7, 1.575, -3.0, 1.35, 0.3},        {-2.5, 1.125, -2.65, 0.9375, 0.3}, {-2.0, 0.9, -1.9, 0.6, 0.3},
};
constexpr std::array<Section, 7> kSpout = {
    Section{1.7, 1.425, 1.7, 0.6, 0.66}, {2.6, 1.425, 3.1, 0.825, 0.66},   {2.3, 2.1, 2.4, 2.025, 0.25}, {2.7, 2.4, 3.3, 2.4, 0.25},
    {2.8, 2.475, 3.525, 2.49375, 0.25},  {2.9, 2.475, 3.45, 2.5125, 0.15}, {2.8, 2.4, 3.2, 2.4, 0.15},
};

// Converts to metres, +Y up.
glm::dvec3 upright(const glm::dvec3& p)
{
    return {p.x, p.z, -p.y};
}

// Curve and parameter of step `i`, with `steps` steps on each curve.
struct Place {
    int curve;
    double t;
};
Place place_on(int i, int steps, int curves)
{
    const int curve = i / steps < curves ? i / steps : curves - 1;
    return {curve, static_cast<double>(i - curve * steps) / static_cast<double>(steps)};
}

struct QuarterTurn {
    glm::dvec2 at, along; // point and derivative of the unit quarter curve, rotated to its quadrant
};
QuarterTurn quarter_turn(int column)
{
    static constexpr glm::dvec2 points[4] = {{1.0, 0.0}, {1.0, kQuarterInner}, {kQuarterInner, 1.0}, {0.0, 1.0}};
    const Place place = place_on(column % (4 * kQuarterColumns), kQuarterColumns, 4);
    QuarterTurn turn{bezier(points, place.t), bezier_derivative(points, place.t)};
    for (int k = 0; k < place.curve; ++k) { // exact, so that the seams close bit by bit
        turn.at = {-turn.at.y, turn.at.x};
        turn.along = {-turn.along.y, turn.along.x};
    }
    return turn;
}

// Adds a surface of revolution about the axis; tangents run around it. `shade` gives the vertex colour at a radius.
template <std::size_t N, class Shade>
void add_turned(Scene& scene, const std::array<Profile, N>& profile, int rows_per_curve, const Shade& shade)
{
    const int curves = static_cast<int>(N - 1) / 3, rows = curves * rows_per_curve, columns = 4 * kQuarterColumns;
    add_grid(scene, columns, rows, [&](int column, int row) {
        const QuarterTurn turn = quarter_turn(column);
        const Place place = place_on(row, rows_per_curve, curves);
        const Profile* p = &profile[static_cast<std::size_t>(3 * place.curve)];
        const Profile at = bezier(p, place.t), along = bezier_derivative(p, place.t);
        // Omit the radius from the derivative around the axis: then the normal exists at the poles, too.
        const glm::dvec3 around(turn.along, 0.0), up(turn.at * along.x, along.y);
        SurfacePoint s;
        s.position = upright(glm::dvec3(turn.at * at.x, at.y)) * kMetres;
        s.normal = upright(glm::cross(around, up));
        s.tangent = upright(around);
        s.u = static_cast<double>(column) / columns;
        s.v = 1.0 - static_cast<double>(row) / rows;
        s.shade = shade(at.x);
        return s;
    });
}

struct SectionPoint {
    glm::dvec3 at, around;
};
// Returns the point of a control section at a column of the loop.
SectionPoint section_point(const Section& s, int column)
{
    const glm::dvec3 points[4] = {{s.ax, 0.0, s.az}, {s.ax, s.half_width, s.az}, {s.bx, s.half_width, s.bz}, {s.bx, 0.0, s.bz}};
    const int half = kSectionColumns / 2, i = column % kSectionColumns;
    const bool mirrored = i > half;
    const double t = static_cast<double>(mirrored ? kSectionColumns - i : i) / half;
    SectionPoint p{bezier(points, t), bezier_derivative(points, t)};
    if (mirrored) {
        p.at.y = -p.at.y;
        p.around = {-p.around.x, p.around.y, -p.around.z};
    }
    return p;
}

// Sweeps along the sections; tangents run around them. `reversed` turns the columns the other way around, so that faces
// point outwards.
void add_swept(Scene& scene, const std::array<Section, 7>& sections, bool reversed)
{
    const int rows = 2 * kSweepRows;
    add_grid(scene, kSectionColumns, rows, [&](int grid_column, int row) {
        const int column = reversed ? kSectionColumns - grid_column : grid_column;
        const Place place = place_on(row, kSweepRows, 2);
        glm::dvec3 at[4], around[4];
        for (int k = 0; k < 4; ++k) {
            const SectionPoint p = section_point(sections[static_cast<std::size_t>(3 * place.curve + k)], column);
            at[k] = p.at;
            around[k] = p.around;
        }
        const glm::dvec3 across = bezier(around, place.t) * (reversed ? -1.0 : 1.0);
        SurfacePoint s;
        s.position = upright(bezier(at, place.t)) * kMetres;
        s.normal = upright(glm::cross(across, bezier_derivative(at, place.t)));
        s.tangent = upright(across);
        s.u = static_cast<double>(grid_column) / kSectionColumns;
        s.v = 1.0 - static_cast<double>(row) / rows;
        return s;
    });
}

// Closes the spout at its last, level section.
void add_spout_end(Scene& scene)
{
    const int half = kSectionColumns / 2, rows = 8;
    add_grid(scene, half, rows, [&](int column, int row) {
        const SectionPoint p = section_point(kSpout.back(), column);
        SurfacePoint s;
        s.u = static_cast<double>(column) / half;
        s.v = 1.0 - static_cast<double>(row) / rows;
        s.position = upright({p.at.x, p.at.y * (1.0 - 2.0 * s.v), p.at.z}) * kMetres;
        s.normal = {0.0, 1.0, 0.0};
        s.tangent = {1.0, 0.0, 0.0};
        return s;
    });
}

void add_materials(Scene& scene)
{
    Material brushed;
    brushed.name = "brushed steel";
    brushed.base_color = glm::vec4(0.84f, 0.82f, 0.79f, 1.0f);
    brushed.metallic = 1.0f;
    brushed.roughness = 0.35f;
    brushed.anisotropy_strength = 0.8f;
    brushed.anisotropy_rotation = static_cast<float>(0.5 * kPi); // grooves run along the tangents, so highlights run across
    scene.materials.push_back(brushed);
    Material matte;
    matte.name = "matte stand";
    matte.base_color = glm::vec4(0.08f, 0.083f, 0.092f, 1.0f);
    matte.metallic = 0.0f;
    matte.roughness = 0.85f;
    matte.specular = 0.3f;
    scene.materials.push_back(matte);
}

} // namespace

Scene make_teapot()
{
    Scene scene;
    scene.name = "teapot";
    add_materials(scene);
    const auto white = [](double) { return 1.0; };
    // Image-based light casts no shadow, so the stand's vertex colours hold a soft shadow around the pot's foot.
    const auto contact = [](double radius) { return 0.05 + 0.95 * smooth_step(0.9, 2.7, radius); };

    const std::uint32_t pot = begin_primitive(scene, 0);
    add_turned(scene, kBody, kProfileRows, white);
    add_turned(scene, kGap, 1, white);
    add_turned(scene, kLid, kProfileRows, white);
    add_swept(scene, kHandle, true);
    add_swept(scene, kSpout, true);
    add_spout_end(scene);
    add_node(scene, "teapot", add_mesh(scene, "teapot", pot), glm::mat4(1.0f));

    const std::uint32_t stand = begin_primitive(scene, 1);
    add_turned(scene, kStand, kProfileRows / 2, contact);
    add_turned(scene, kStandTop, kProfileRows, contact);
    add_node(scene, "stand", add_mesh(scene, "stand", stand), glm::mat4(1.0f));
    return scene;
}

} // namespace burnish
