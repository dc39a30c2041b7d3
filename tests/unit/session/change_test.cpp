// Changes between frames: the bits of a new session, and nothing changed where a change fails.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "core/base/result.h"
#include "core/image/metrics/metrics.h"
#include "core/scene/builtin/builtin.h"
#include "tests/unit/small_scene.h"

namespace burnish {
namespace {

using test::good_scene;
using test::small_environment;

FrameDesc small_desc()
{
    FrameDesc d;
    d.width = 60, d.height = 40, d.msaa = 2;
    d.view = make_view(glm::vec3(0.5f, 0.6f, 3.5f), glm::vec3(0), 0.9f, d.width, d.height);
    d.technique = "bent_normal";
    return d;
}

Result<Session> open_with(Scene scene, const MipSettings& mips = {}, const SessionOptions& options = {})
{
    Result<std::shared_ptr<const SceneData>> data = make_scene_data("mine", std::move(scene), {}, mips);
    BN_TRY(data);
    return Session::make({*data, small_environment(), std::make_shared<const Jobs>(1), *standard_dfg(Jobs(1))}, options);
}

std::uint64_t drawn_hash(Session& session)
{
    const Result<Frame> frame = session.render(small_desc());
    EXPECT_TRUE(frame) << (frame ? "" : frame.error().line());
    return frame ? pixel_hash(frame->color) : 0;
}

// A scene with normal and anisotropy maps, whose texture levels take long.
Scene mapped_scene()
{
    Scene s = good_scene();
    Image& normals = s.images[0];
    for (std::size_t i = 0; i < normals.bytes.size(); i += 3)
        normals.bytes[i] = std::byte(i % 2 ? 90 : 160), normals.bytes[i + 1] = std::byte(120), normals.bytes[i + 2] = std::byte(250);
    s.materials[0].base_color_tex.texture = kNone;
    s.materials[0].normal_tex.texture = 0;
    s.materials[0].metallic = 1.0f, s.materials[0].roughness = 0.3f;
    s.materials.push_back(s.materials[0]);
    s.materials[1].base_color = {0.9f, 0.3f, 0.1f, 1.0f};
    return s;
}

glm::mat4 turned()
{
    glm::mat4 m(1.0f);
    m[0] = {std::cos(0.4f), 0, -std::sin(0.4f), 0}, m[2] = {std::sin(0.4f), 0, std::cos(0.4f), 0}, m[3] = {0.1f, 0.2f, -0.3f, 1};
    return m;
}

struct Change {
    const char* name;
    void (*to_scene)(Scene& s);
    void (*to_changes)(const Scene& s, SceneChanges& c);
};
const Change kChanges[] = {
    {"node", [](Scene& s) { s.nodes[0].local = turned(); }, [](const Scene&, SceneChanges& c) { c.nodes.emplace_back(0, turned()); }},
    {"material", [](Scene& s) { s.materials[0].roughness = 0.6f, s.materials[0].anisotropy_strength = 0.7f; },
     [](const Scene& s, SceneChanges& c) {
         Material m = s.materials[0];
         m.roughness = 0.6f, m.anisotropy_strength = 0.7f;
         c.materials.emplace_back(0, m);
     }},
    {"primitive", [](Scene& s) { s.primitives[0].material = 1; }, [](const Scene&, SceneChanges& c) { c.primitives.emplace_back(0, 1); }},
    {"light", [](Scene& s) { s.lights[0].intensity = 9.0f; },
     [](const Scene& s, SceneChanges& c) {
         Light l = s.lights[0];
         l.intensity = 9.0f;
         c.lights.emplace_back(0, l);
     }},
};

TEST(change, has_the_bits_of_a_new_session)
{
    for (const MipFilter filter : {kMipFilter_box, kMipFilter_kappa}) {
        MipSettings mips;
        mips.filter = filter;
        Result<Session> changed = open_with(mapped_scene(), mips);
        ASSERT_TRUE(changed) << changed.error().line();
        std::uint64_t before = drawn_hash(*changed);
        Scene all = mapped_scene();
        for (const Change& change : kChanges) { // one after another, in the same session
            SCOPED_TRACE(change.name);
            change.to_scene(all);
            SceneChanges c;
            change.to_changes(changed->scene(), c);
            const Status done = changed->change(std::move(c));
            ASSERT_TRUE(done) << done.error().line();
            Result<Session> fresh = open_with(all, mips);
            ASSERT_TRUE(fresh);
            const std::uint64_t hash = drawn_hash(*changed);
            EXPECT_EQ(hash, drawn_hash(*fresh));
            EXPECT_NE(hash, before);
            before = hash;
        }
    }
}

TEST(change, takes_another_environment)
{
    Result<Session> session = open_with(mapped_scene());
    ASSERT_TRUE(session);
    const std::uint64_t studio = drawn_hash(*session);
    EnvironmentOptions options;
    options.cube_size = 16, options.samples = 4, options.use_cache = false, options.rotation_deg = 70.0f;
    const auto sky = load_shared_environment("builtin:sky", options, {}, Jobs(1));
    ASSERT_TRUE(sky);
    SceneChanges changes;
    changes.environment = *sky;
    ASSERT_TRUE(session->change(changes));
    SessionParts parts = session->parts();
    parts.scene = *make_scene_data("mine", mapped_scene(), {});
    Result<Session> fresh = Session::make(parts);
    ASSERT_TRUE(fresh);
    EXPECT_EQ(drawn_hash(*session), drawn_hash(*fresh));
    changes.environment = small_environment();
    ASSERT_TRUE(session->change(changes));
    EXPECT_EQ(drawn_hash(*session), studio);
}

TEST(change, leaves_sessions_that_share_the_scene_alone)
{
    Result<Session> first = open_with(mapped_scene());
    ASSERT_TRUE(first);
    Result<Session> second = Session::make(first->parts());
    ASSERT_TRUE(second);
    const std::uint64_t before = drawn_hash(*second);
    SceneChanges changes;
    changes.nodes.emplace_back(0, turned());
    ASSERT_TRUE(first->change(changes));
    EXPECT_NE(drawn_hash(*first), before);
    EXPECT_EQ(drawn_hash(*second), before);
    EXPECT_NE(&first->scene(), &second->scene());
}

// Where no one else holds the scene, nothing of it is copied.
TEST(change, keeps_the_scene_in_place)
{
    Result<Session> session = open_with(mapped_scene());
    ASSERT_TRUE(session);
    const Scene* const scene = &session->scene();
    const std::byte* const pixels = scene->images[0].bytes.data();
    SceneChanges changes;
    changes.nodes.emplace_back(0, turned());
    ASSERT_TRUE(session->change(changes));
    EXPECT_EQ(&session->scene(), scene);
    EXPECT_EQ(session->scene().images[0].bytes.data(), pixels);
}

TEST(change, that_fails_changes_nothing)
{
    Result<Session> session = open_with(mapped_scene());
    ASSERT_TRUE(session);
    const std::uint64_t before = drawn_hash(*session);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto refused = [&](const char* place, ExitCode code, SceneChanges changes) {
        changes.nodes.emplace_back(1, turned()); // sound, and undone with the wrong one
        const Status done = session->change(std::move(changes));
        ASSERT_FALSE(done) << place;
        EXPECT_EQ(done.error().place, place) << done.error().line();
        EXPECT_EQ(done.error().code, code) << place;
        EXPECT_EQ(drawn_hash(*session), before) << place;
    };
    const Material steel = session->scene().materials[0];
    Material rough = steel, other_map = steel;
    rough.roughness = 2.0f, other_map.base_color_tex.texture = 0;
    Light dark = session->scene().lights[0];
    dark.intensity = nan;
    glm::mat4 broken = turned();
    broken[3].x = nan;
    SceneChanges c;
    c.nodes = {{0, broken}};
    refused("/nodes/0/local", ExitCode::bad_input, c);
    c.nodes = {{0, turned()}, {0, broken}};
    refused("/nodes/0/local", ExitCode::bad_input, c);
    c.nodes = {{99, turned()}};
    refused("/nodes/99", ExitCode::bad_input, c);
    c.nodes = {{-1, turned()}};
    refused("/nodes/-1", ExitCode::bad_input, c);
    c = {}, c.materials = {{0, rough}};
    refused("/materials/0/roughness", ExitCode::bad_input, c);
    c.materials = {{7, steel}};
    refused("/materials/7", ExitCode::bad_input, c);
    c.materials = {{0, other_map}};
    refused("/materials/0/base_color_tex", ExitCode::usage, c);
    c = {}, c.primitives = {{0, 5}};
    refused("/primitives/0/material", ExitCode::bad_input, c);
    // The area light and the shape that shows it
    const auto shape = static_cast<std::int32_t>(session->scene().materials.size() - 1);
    ASSERT_NE(session->scene().materials.back().emitter, kNoEmitter);
    c = {}, c.nodes = {{3, turned()}};
    refused("/nodes/3", ExitCode::usage, c);
    c.nodes = {{static_cast<std::int32_t>(session->scene().nodes.size() - 1), turned()}};
    refused(("/nodes/" + std::to_string(session->scene().nodes.size() - 1)).c_str(), ExitCode::usage, c);
    c = {}, c.materials = {{shape, session->scene().materials.back()}};
    refused(("/materials/" + std::to_string(shape)).c_str(), ExitCode::usage, c);
    c = {}, c.primitives = {{0, shape}};
    refused("/primitives/0/material", ExitCode::usage, c);
    c = {}, c.lights = {{0, dark}};
    refused("/lights/0/intensity", ExitCode::bad_input, c);
}

TEST(change, of_scenes_on_a_floor_is_refused)
{
    FloorSettings floor;
    floor.kind = FloorKind::shadow;
    const auto data = load_scene_data("builtin:plate", {}, {}, {}, {}, {}, floor);
    ASSERT_TRUE(data);
    Result<Session> session = Session::make({*data, small_environment(), std::make_shared<const Jobs>(1), *standard_dfg(Jobs(1))});
    ASSERT_TRUE(session);
    SceneChanges changes;
    changes.nodes.emplace_back(0, turned());
    const Status done = session->change(changes);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ExitCode::usage);
    EXPECT_NE(done.error().reason.find("floor"), std::string::npos);
    changes = {}, changes.environment = small_environment();
    EXPECT_TRUE(session->change(changes));
}

// Its contact shadows stay on the vertices.
TEST(change, of_light_above_a_floor_has_the_bits_of_a_new_session)
{
    FloorSettings floor;
    floor.kind = FloorKind::shadow;
    const auto open_on_floor = [&](const std::shared_ptr<const Environment>& environment) {
        const auto data = load_scene_data("builtin:shaderballs", {}, {}, {}, {}, {}, floor);
        EXPECT_TRUE(data);
        const Column<float>& seen = (*data)->visibility;
        EXPECT_TRUE(std::any_of(seen.begin(), seen.end(), [](float share) { return share < 1.0f; }));
        return Session::make({*data, environment, std::make_shared<const Jobs>(1), *standard_dfg(Jobs(1))});
    };
    const auto drawn_pot = [](Session& s) {
        FrameDesc d = small_desc();
        d.view = s.framed(d.width, d.height);
        const Result<Frame> frame = s.render(d);
        EXPECT_TRUE(frame);
        return frame ? pixel_hash(frame->color) : 0;
    };
    EnvironmentOptions options;
    options.cube_size = 16, options.samples = 4, options.use_cache = false;
    const auto sky = load_shared_environment("builtin:sky", options, {}, Jobs(1));
    ASSERT_TRUE(sky);
    Result<Session> changed = open_on_floor(small_environment()), fresh = open_on_floor(*sky);
    ASSERT_TRUE(changed && fresh);
    SceneChanges changes;
    changes.environment = *sky;
    ASSERT_TRUE(changed->change(changes));
    EXPECT_EQ(drawn_pot(*changed), drawn_pot(*fresh));
}

TEST(change, reaches_the_reference)
{
    SessionOptions options;
    options.backend = Backend::reference;
    options.reference.samples = 16;
    Result<Session> session = open_with(mapped_scene(), {}, options);
    if (!session && session.error().code == ExitCode::unavailable)
        GTEST_SKIP() << session.error().line();
    ASSERT_TRUE(session) << session.error().line();
    const auto trace = [](Session& s) {
        FrameDesc d = small_desc();
        d.width = 24, d.height = 16, d.technique = "mc", d.samples = 1;
        const Result<Frame> frame = s.render(d);
        EXPECT_TRUE(frame) << (frame ? "" : frame.error().line());
        return frame ? pixel_hash(frame->color) : 0;
    };
    const std::uint64_t before = trace(*session);
    SceneChanges changes;
    changes.nodes.emplace_back(0, turned());
    ASSERT_TRUE(session->change(changes));
    Scene moved = mapped_scene();
    moved.nodes[0].local = turned();
    Result<Session> fresh = open_with(moved, {}, options);
    ASSERT_TRUE(fresh);
    EXPECT_EQ(trace(*session), trace(*fresh));
    EXPECT_NE(trace(*session), before);
}

} // namespace
} // namespace burnish
