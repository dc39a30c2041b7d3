// A scene fuzzer: seeded worlds with a known value in every pixel. BN_WORLDS sets the number of worlds of each kind.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/unit/worlds/world.h"

namespace burnish::test {
namespace {

constexpr int kSide = 24;

int worlds(int usual)
{
    const char* wanted = std::getenv("BN_WORLDS");
    return wanted ? std::atoi(wanted) : usual;
}

FrameDesc desc_from(Dice& dice, const glm::vec3& eye, const glm::vec3& target)
{
    constexpr int kSamples[] = {1, 2, 4, 8};
    FrameDesc d;
    d.width = kSide, d.height = kSide + dice.below(9);
    d.msaa = kSamples[dice.below(4)];
    d.tile_size = dice.below(2) ? 32 : 64;
    d.view = make_view(eye, target, dice.between(0.3f, 2.2f), d.width, d.height);
    return d;
}

// Returns the largest difference of a pixel's channel from `wanted`. NaN counts as infinite.
float worst(const Frame& f, const glm::vec3& wanted)
{
    float most = 0.0f;
    for (std::size_t i = 0; i < f.color.bytes.size() / sizeof(float); ++i) {
        const float off = std::abs(f.color.f32()[i] - wanted[static_cast<int>(i % 3)]);
        most = off <= most ? most : std::isfinite(off) ? off : 1e30f;
    }
    return most;
}

void set_alpha(Dice& dice, Material& m)
{
    m.alpha_mode = static_cast<AlphaMode>(dice.below(3));
    m.base_color.a = dice.below(4) == 0 ? 1.0f : dice.unit();
    m.double_sided = dice.below(2) == 0;
}

void add_things(Dice& dice, World& world, int count, const std::function<Material()>& material, float size, float distance)
{
    const int first = static_cast<int>(world.scene.nodes.size());
    for (int i = 0; i < count; ++i) {
        const std::vector<glm::vec3> shape = dice.below(3) == 0   ? box_corners()
                                             : dice.below(2) == 0 ? ball_corners(4 + dice.below(6))
                                                                  : plate_corners(1 + dice.below(5));
        const int parent = i > 0 && dice.below(3) == 0 ? first + dice.below(i) : kNone;
        const float unit = parent == kNone ? 1.0f : size; // a parent scales its children
        world.add(shape, material(), random_placement(dice, size / unit, distance / unit), parent);
    }
}

using Answer = std::function<void(std::uint64_t seed, const Road& road)>;

// Every other world is drawn from memory, the others through a file.
void for_worlds(int count, const Answer& check, Backend backend = Backend::tile)
{
    for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE("world " + std::to_string(i));
        check(static_cast<std::uint64_t>(i), {i % 2 == 1, backend});
    }
}

// Returns the mean of all channels.
double mean(const Frame& f)
{
    const std::size_t count = f.color.bytes.size() / sizeof(float);
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i)
        sum += static_cast<double>(f.color.f32()[i]);
    return sum / static_cast<double>(count);
}

// Under radiance 1 from everywhere a white dielectric reflects 1, for any shape, roughness, grain and alpha.
void white_under_constant_light(std::uint64_t seed, const Road& road)
{
    constexpr const char* kTechniques[] = {"auto", "split_isotropic", "bent_normal", "major_axis", "lobe_line"};
    Dice dice(seed);
    World world;
    const auto white = [&] {
        Material m;
        m.metallic = 0.0f, m.roughness = dice.between(0.1f, 1.0f);
        m.anisotropy_strength = dice.below(2) ? dice.unit() : 0.0f, m.anisotropy_rotation = dice.between(0.0f, 6.28f);
        set_alpha(dice, m);
        return m;
    };
    add_things(dice, world, 1 + dice.below(6), white, 1.0f, 0.7f);
    FrameDesc d = desc_from(dice, dice.direction() * dice.between(0.2f, 4.0f), glm::vec3(0.0f));
    d.technique = kTechniques[dice.below(5)];
    const Result<Frame> f = draw_world(std::move(world), d, 1.0f, road, dice);
    ASSERT_TRUE(f) << f.error().line();
    if (road.backend == Backend::reference) // whose pixels are noisy
        EXPECT_NEAR(mean(*f), 1.0, 0.005);
    else
        EXPECT_LE(worst(*f, glm::vec3(1.0f)), 0.012f) << d.technique << ", " << d.msaa << " samples";
}

// Inside a closed room of one colour nothing else is visible, whatever stands outside.
void closed_room(std::uint64_t seed, const Road& road)
{
    Dice dice(seed + 1000000);
    World world;
    const glm::vec3 wall(dice.unit(), dice.unit(), dice.unit());
    const float size = std::pow(10.0f, dice.between(-1.0f, 6.0f));
    const bool ball = dice.below(2) == 0;
    const glm::mat4 turned = random_placement(dice, size, 0.0f);
    const std::vector<glm::vec3> shape = ball ? ball_corners(3 + dice.below(8)) : box_corners();
    Material room = unlit(wall);
    room.double_sided = dice.below(2) == 0;
    world.add(turned_inside(shape), room, turned);
    add_things(
        dice, world, dice.below(3),
        [&] {
            Material m = unlit({1, 0, 1});
            set_alpha(dice, m);
            return m;
        },
        size, 8.0f * size);
    const glm::vec3 eye = glm::vec3(turned * glm::vec4(dice.direction() * (ball ? 0.4f : 0.9f), 1.0f));
    FrameDesc d = desc_from(dice, eye, eye + dice.direction());
    d.view.znear = std::min(0.01f, 0.002f * size); // before all walls
    const Result<Frame> f = draw_world(std::move(world), d, 3.0f, road, dice);
    ASSERT_TRUE(f) << f.error().line();
    EXPECT_LE(worst(*f, wall), 1e-6f) << "room of " << size << " m, " << d.msaa << " samples, " << d.width << "x" << d.height;
}

// A plate over the whole view hides everything behind it, in any number of pieces with shared corners.
void plate_before_all(std::uint64_t seed, const Road& road)
{
    Dice dice(seed + 2000000);
    World world;
    const glm::vec3 front(dice.unit(), dice.unit(), dice.unit());
    const glm::mat4 turned = random_placement(dice, 1.0f, 0.0f);
    const glm::vec3 normal = glm::normalize(glm::cross(glm::vec3(turned[0]), glm::vec3(turned[1])));
    const float side = glm::dot(normal, glm::vec3(turned[2])) < 0.0f ? -1.0f : 1.0f;
    Material plate = unlit(front);
    plate.double_sided = true;
    add_things(
        dice, world, 1 + dice.below(4),
        [&] {
            Material m = unlit({1, 0, 1});
            set_alpha(dice, m);
            return m;
        },
        1.0f, 0.0f);
    for (Node& n : world.scene.nodes) // all behind the plate
        if (n.parent == kNone)
            n.local[3] -= glm::vec4(normal * (side * 9.0f), 0.0f);
    glm::mat4 wide = turned;
    wide[0] *= 400.0f, wide[1] *= 400.0f;
    world.add(plate_corners(1 + dice.below(60)), plate, wide);
    FrameDesc d = desc_from(dice, normal * (side * dice.between(0.5f, 2.0f)), dice.direction() * 0.2f);
    d.view = make_view(d.view.eye, d.view.eye - normal * side + dice.direction() * 0.2f, 0.6f, d.width, d.height);
    const Result<Frame> f = draw_world(std::move(world), d, 3.0f, road, dice);
    ASSERT_TRUE(f) << f.error().line();
    EXPECT_LE(worst(*f, front), 1e-6f) << d.msaa << " samples";
}

TEST(worlds, white_things_under_constant_light_are_not_seen)
{
    for_worlds(worlds(40), white_under_constant_light);
}
TEST(worlds, a_closed_room_shows_its_walls_alone)
{
    for_worlds(worlds(150), closed_room);
}
TEST(worlds, a_plate_before_all_hides_all)
{
    for_worlds(worlds(60), plate_before_all);
}

TEST(worlds, have_their_answer_by_the_reference)
{
    if (!reference_available())
        GTEST_SKIP() << "built without Embree";
    for_worlds(worlds(20), white_under_constant_light, Backend::reference);
    for_worlds(worlds(30), closed_room, Backend::reference);
    for_worlds(worlds(20), plate_before_all, Backend::reference);
}

TEST(worlds, many_of_each_kind_have_their_answer)
{
    for_worlds(worlds(20000), white_under_constant_light);
    for_worlds(worlds(40000), closed_room);
    for_worlds(worlds(40000), plate_before_all);
    if (reference_available()) {
        for_worlds(worlds(1000), white_under_constant_light, Backend::reference);
        for_worlds(worlds(1000), closed_room, Backend::reference);
        for_worlds(worlds(1000), plate_before_all, Backend::reference);
    }
}

} // namespace
} // namespace burnish::test
