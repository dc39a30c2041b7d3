// Frames, sessions and effects with one wrong setting. Each gives an Error that names the field; none ends the process or draws.
#include <cmath>
#include <gtest/gtest.h>
#include <initializer_list>
#include <iterator>
#include <limits>

#include "core/image/io/image_io.h"
#include "raster/session/mirror.h"
#include "raster/session/session.h"
#include "tests/unit/small_scene.h"

namespace burnish {
namespace {

using test::good_scene;
using test::small_environment;

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN(), kInfinite = std::numeric_limits<float>::infinity();

SessionParts plain_parts()
{
    static const std::shared_ptr<const SceneData> data = *make_scene_data("good", good_scene(), {});
    return {data, small_environment(), std::make_shared<const Jobs>(1), *standard_dfg(Jobs(1))};
}

FrameDesc plain_desc()
{
    FrameDesc d;
    d.width = 40, d.height = 30, d.msaa = 1;
    d.view = make_view(glm::vec3(0.5f, 0.4f, 3), glm::vec3(0), 0.8f, d.width, d.height);
    return d;
}

struct BadFrame {
    const char* word; // contained in the error
    void (*change)(FrameDesc& d);
};
const BadFrame kFrames[] = {
    {"sides", [](FrameDesc& d) { d.width = d.height = 0; }},
    {"sides", [](FrameDesc& d) { d.width = 65536, d.height = 1; }},
    {"sides", [](FrameDesc& d) { d.height = -30; }},
    {"2^28", [](FrameDesc& d) { d.width = d.height = 16384, d.msaa = 2; }},
    {"msaa", [](FrameDesc& d) { d.msaa = -1; }},
    {"msaa", [](FrameDesc& d) { d.msaa = 3; }},
    {"msaa", [](FrameDesc& d) { d.msaa = 32; }},
    {"tile size", [](FrameDesc& d) { d.tile_size = 0; }},
    {"texture anisotropy", [](FrameDesc& d) { d.texture_anisotropy = 99; }},
    {"technique", [](FrameDesc& d) { d.technique = ""; }},
    {"samples", [](FrameDesc& d) { d.samples = 0; }},
    {"roughness", [](FrameDesc& d) { d.roughness = kNoNumber; }},
    {"roughness", [](FrameDesc& d) { d.roughness = 2.0f; }},
    {"anisotropy", [](FrameDesc& d) { d.override_anisotropy = true, d.anisotropy = kNoNumber; }},
    {"brdf", [](FrameDesc& d) { d.brdf = 99; }},
    {"brdf", [](FrameDesc& d) { d.brdf = -1; }},
    {"FrameDesc::area_way", [](FrameDesc& d) { d.area_way = 99; }},
    {"FrameDesc::glass", [](FrameDesc& d) { d.glass = 2; }},
    {"FrameDesc::light_samples", [](FrameDesc& d) { d.light_samples = 0; }},
    {"FrameDesc::major_axis_k", [](FrameDesc& d) { d.major_axis_k = kNoNumber; }},
    {"tilt", [](FrameDesc& d) { d.tilt_rad.x = kNoNumber; }},
    {"/view/eye", [](FrameDesc& d) { d.view.eye.x = kNoNumber; }},
    {"/view/eye", [](FrameDesc& d) { d.view.eye.z = kInfinite; }},
    {"/view/right", [](FrameDesc& d) { d.view.right = glm::vec3(0.0f); }},
    {"/view/up", [](FrameDesc& d) { d.view.up *= 3.0f; }},
    {"/view/forward", [](FrameDesc& d) { d.view.forward.y = kNoNumber; }},
    {"/view/forward", [](FrameDesc& d) { d.view.up = d.view.forward; }},
    {"/view/tan_half_x", [](FrameDesc& d) { d.view.tan_half_x = 0.0f; }},
    {"/view/tan_half_y", [](FrameDesc& d) { d.view.tan_half_y = kInfinite; }},
    {"/view/znear", [](FrameDesc& d) { d.view.znear = -1.0f; }},
    {"/view/znear", [](FrameDesc& d) { d.view.znear = kNoNumber; }},
    {"/view/zfar", [](FrameDesc& d) { d.view.orthographic = true; }},
    {"/view/eye", [](FrameDesc& d) { d.view = make_view(glm::vec3(kNoNumber), glm::vec3(0), 0.8f, 4, 3); }},
    {"/view/tan_half", [](FrameDesc& d) { d.view = make_view(glm::vec3(1), glm::vec3(0), 0.8f, 0, 0); }},
    {"/view/tan_half", [](FrameDesc& d) { d.view = make_view(glm::vec3(1), glm::vec3(0), 3.15f, 4, 3); }},
    {"/view/tan_half", [](FrameDesc& d) { d.view = make_view(glm::vec3(1), glm::vec3(0), -0.6f, 4, 3); }},
    {"/view/tan_half_y", [](FrameDesc& d) { d.view.tan_half_y = -0.5f; }},
    {"/view/right", [](FrameDesc& d) { d.view = make_view(glm::vec3(1), glm::vec3(1), 0.8f, 4, 3); }},
    {"/view/eye", [](FrameDesc& d) { d.view.eye.y = 1e30f; }},
};

void expect_refused_frames(Session& session)
{
    for (std::size_t i = 0; i < std::size(kFrames); ++i) {
        SCOPED_TRACE(std::string("frame ") + std::to_string(i) + " " + kFrames[i].word);
        FrameDesc desc = plain_desc();
        kFrames[i].change(desc);
        const Result<Frame> frame = session.render(desc);
        ASSERT_FALSE(frame);
        EXPECT_EQ(frame.error().code, ExitCode::usage);
        EXPECT_NE(frame.error().line().find(kFrames[i].word), std::string::npos) << frame.error().line();
        EXPECT_FALSE(frame.error().place.empty() && frame.error().field.empty()) << frame.error().line();
    }
}

TEST(bad_scenes, cameras_that_are_not_there_are_said)
{
    const Scene scene = good_scene();
    for (const int camera : {-1, static_cast<int>(scene.cameras.size()), std::numeric_limits<int>::max()}) {
        const Result<View> view = make_view(scene, camera, 40, 30);
        ASSERT_FALSE(view);
        EXPECT_EQ(view.error().code, ExitCode::usage);
    }
}

TEST(bad_scenes, frames_are_checked)
{
    Result<Session> session = Session::make(plain_parts());
    ASSERT_TRUE(session);
    expect_refused_frames(*session);
    EXPECT_TRUE(session->render(plain_desc())); // the session still works
    Frame odd;
    odd.color = Image{40, 30, 3, PixelType::f32, {}};
    odd.color.bytes.resize(7);
    const Result<Frame> frame = session->render(plain_desc(), std::move(odd));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->color.bytes.size(), 40u * 30u * 3u * sizeof(float));
}

TEST(bad_scenes, sessions_of_nothing_are_refused)
{
    SessionParts parts = plain_parts();
    parts.scene = std::make_shared<const SceneData>();
    EXPECT_EQ(Session::make(parts).error().field, "SessionParts::scene");
    parts.scene.reset();
    EXPECT_EQ(Session::make(parts).error().field, "SessionParts::scene");
    parts = plain_parts(), parts.environment = std::make_shared<const Environment>();
    EXPECT_EQ(Session::make(parts).error().field, "SessionParts::environment");
    SessionOptions options;
    options.backend = static_cast<Backend>(99);
    EXPECT_EQ(Session::make(plain_parts(), options).error().field, "SessionOptions::backend");
    Result<Session> session = Session::make(plain_parts());
    ASSERT_TRUE(session);
    const Session taken = std::move(*session);
    EXPECT_FALSE(casts_shadows({Shadows::on}, plain_desc(), *session));
    for (const Error& error :
         {session->render(plain_desc()).error(), session->render_any(plain_desc()).error(), session->change({}).error()})
        EXPECT_EQ(error.field, "Session") << error.line();
}

// Draws what shadows and mirrors need.
FrameDesc lit_desc()
{
    FrameDesc desc = plain_desc();
    desc.layers = desc.triangle_ids = true;
    return desc;
}

TEST(bad_scenes, frames_for_shadows_and_mirrors_are_checked)
{
    OpenOptions open;
    open.environment.cube_size = 16, open.environment.samples = 16, open.environment.use_cache = false;
    FloorSettings floor;
    floor.kind = FloorKind::mirror;
    SessionParts parts = plain_parts();
    const auto scene = load_scene_data("builtin:lights", {}, {}, {}, {}, {}, floor);
    ASSERT_TRUE(scene);
    parts.scene = *scene;
    Result<Session> session = Session::make(parts);
    ASSERT_TRUE(session);
    const ShadowSettings shadows{Shadows::on};
    FrameDesc desc = lit_desc();
    desc.view = session->framed(desc.width, desc.height);
    Result<Frame> good = session->render(desc);
    ASSERT_TRUE(good);
    const Frame drawn = std::move(*good);
    struct Case {
        const char* place;
        void (*change)(Frame& frame, FrameDesc& desc, ShadowSettings& shadows);
        bool of_shadows, of_mirrors;
    };
    for (const Case& bad : std::initializer_list<Case>{
             {"/color", [](Frame&f, FrameDesc&, ShadowSettings&) { f = Frame(); }, true, true},
             {"/color", [](Frame&, FrameDesc&d, ShadowSettings&) { d.width *= 5; }, true, true},
             {"/color", [](Frame&, FrameDesc&d, ShadowSettings&) { d.height -= 1; }, true, true},
             {"/layers", [](Frame&f, FrameDesc&, ShadowSettings&) { f.layers = {}; }, true, false},
             {"/triangle_ids", [](Frame&f, FrameDesc&, ShadowSettings&) { f.triangle_ids = {}; }, false, true},
             {"/triangle_ids", [](Frame&, FrameDesc&d, ShadowSettings&) { d.msaa *= 2; }, false, true},
             {"/parts",
              [](Frame&f, FrameDesc&, ShadowSettings&) {
                  f.parts.push_back({40 * 30, 0, 1, false, {}, 1.0f});
              },
              true, true},
             {"FrameDesc::msaa", [](Frame&, FrameDesc&d, ShadowSettings&) { d.msaa = 3; }, false, true},
             {"ShadowSettings::samples", [](Frame&, FrameDesc&, ShadowSettings&s) { s.samples = 0; }, true, true},
             {"ShadowSettings::of", [](Frame&, FrameDesc&, ShadowSettings&s) { s.of = static_cast<Shadows>(9); }, true, true}}) {
        Frame frame = drawn;
        FrameDesc changed = desc;
        ShadowSettings settings = shadows;
        bad.change(frame, changed, settings);
        for (const bool mirrors : {false, true}) {
            if (!(mirrors ? bad.of_mirrors : bad.of_shadows))
                continue;
            const Status done =
                mirrors ? add_reflection(settings, changed, *session, frame) : add_shadows(settings, changed, *session, frame);
            ASSERT_FALSE(done) << bad.place << mirrors;
            EXPECT_EQ(done.error().code, ExitCode::usage);
            EXPECT_EQ(done.error().place + done.error().field, bad.place) << done.error().line();
        }
    }
    Frame frame = drawn;
    ASSERT_TRUE(add_shadows(shadows, desc, *session, frame));
    ASSERT_TRUE(add_reflection(shadows, desc, *session, frame));
    EXPECT_NE(pixel_hash(frame.color), pixel_hash(drawn.color));
}

} // namespace
} // namespace burnish
