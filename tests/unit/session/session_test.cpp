// Sessions: equal bits alone, side by side and in threads; errors instead of exceptions.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "core/base/check.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "raster/frame/choices.h"
#include "raster/frame/far_normals.h"
#include "raster/frame/pyramids.h"
#include "raster/session/session.h"
#include "tests/unit/data.h"

namespace burnish {
namespace {

OpenOptions small_open(int threads = 1)
{
    OpenOptions open;
    open.threads = threads;
    open.environment.cube_size = 16;
    open.environment.samples = 16;
    open.environment.use_cache = false;
    return open;
}

FrameDesc small_frame(const Session& session, const std::string& technique)
{
    FrameDesc desc;
    desc.width = 80, desc.height = 48, desc.msaa = 2;
    desc.technique = technique;
    desc.view = session.framed(desc.width, desc.height);
    return desc;
}

std::uint64_t drawn(Session& session, const std::string& technique = "bent_normal")
{
    const Result<Frame> frame = session.render(small_frame(session, technique));
    EXPECT_TRUE(frame) << (frame ? "" : frame.error().line());
    return frame ? pixel_hash(frame->color) : 0;
}

TEST(session, draws_the_same_alone_and_beside_another)
{
    std::uint64_t teapot = 0, spheres = 0;
    {
        Result<Session> alone = Session::open("builtin:teapot", "builtin:studio", small_open());
        ASSERT_TRUE(alone) << alone.error().line();
        teapot = drawn(*alone);
    }
    {
        Result<Session> alone = Session::open("builtin:spheres", "builtin:sky", small_open());
        ASSERT_TRUE(alone) << alone.error().line();
        spheres = drawn(*alone, "major_axis");
    }
    ASSERT_NE(teapot, spheres);
    Result<Session> a = Session::open("builtin:teapot", "builtin:studio", small_open());
    Result<Session> b = Session::open("builtin:spheres", "builtin:sky", small_open(2));
    ASSERT_TRUE(a && b);
    for (int i = 0; i < 2; ++i) { // in turn
        EXPECT_EQ(drawn(*a), teapot);
        EXPECT_EQ(drawn(*b, "major_axis"), spheres);
    }
    std::uint64_t of_a = 0, of_b = 0; // at once
    std::thread other([&] { of_b = drawn(*b, "major_axis"); });
    of_a = drawn(*a);
    other.join();
    EXPECT_EQ(of_a, teapot);
    EXPECT_EQ(of_b, spheres);
}

// Textures for frames that set roughness are left out on request. Other frames keep their bits; a frame that needs them is an error.
TEST(session, prepares_only_what_its_frames_read)
{
    Result<Session> box = Session::open("builtin:bumps", "builtin:studio", small_open());
    ASSERT_TRUE(box);
    const auto session_with = [&](bool frames_override) {
        MipSettings mips;
        mips.filter = kMipFilter_kappa, mips.frames_override = frames_override;
        SessionParts parts = box->parts();
        parts.scene = *load_scene_data("builtin:bumps", {}, {}, mips);
        return Session::make(parts);
    };
    Result<Session> whole = session_with(true), lean = session_with(false);
    ASSERT_TRUE(whole && lean);
    const auto pyramids_of = [](const Session& session) {
        const SceneMips& mips = session.parts().scene->mips;
        return used_pyramids(session.scene(), mips, kept_weights_by_material(session.scene(), mips, Jobs(1))).size();
    };
    EXPECT_LT(pyramids_of(*lean), pyramids_of(*whole));
    EXPECT_EQ(drawn(*lean), drawn(*whole));
    FrameDesc desc = small_frame(*lean, "bent_normal");
    desc.roughness = 0.4f;
    EXPECT_TRUE(whole->render(desc));
    const Result<Frame> refused = lean->render(desc);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().field, "MipSettings::frames_override");
}

TEST(session, shares_its_parts)
{
    Result<Session> first = Session::open("builtin:teapot", "builtin:studio", small_open());
    ASSERT_TRUE(first);
    const std::uint64_t hash = drawn(*first);
    SessionParts parts = first->parts();
    parts.jobs.reset(), parts.dfg.reset();
    Result<Session> filled_up = Session::make(parts);
    ASSERT_TRUE(filled_up);
    EXPECT_EQ(drawn(*filled_up), hash);
    Result<Session> second = Session::make(first->parts());
    ASSERT_TRUE(second);
    EXPECT_EQ(&first->scene(), &second->scene());
    *first = std::move(*Session::make(second->parts())); // parts outlive the session that made them
    EXPECT_EQ(drawn(*first), hash);
    EXPECT_EQ(drawn(*second), hash);
}

TEST(session, without_an_environment_takes_the_scene_s_own_light)
{
    const std::string six = test::data_file("models/ibl_six_colours.glb");
    const Result<Session> own = Session::open(six, "", small_open()), usual = Session::open("builtin:plate", "", small_open());
    const Result<Session> other = Session::open("builtin:plate", six, small_open());
    ASSERT_TRUE(own && usual && other);
    EXPECT_EQ(own->parts().environment->name, six);
    EXPECT_NEAR(own->parts().environment->energy_source, 0.5, 1e-3); // each channel shines on three of six faces
    EXPECT_EQ(usual->parts().environment->name, "builtin:studio");
    EXPECT_EQ(other->parts().environment->content_hash, own->parts().environment->content_hash);
}

TEST(session, says_what_is_wrong)
{
    const Result<Session> no_scene = Session::open("builtin:nothing", "builtin:studio", small_open());
    ASSERT_FALSE(no_scene);
    EXPECT_NE(no_scene.error().line().find("nothing"), std::string::npos);
    const Result<Session> no_light = Session::open("builtin:teapot", "/nonexistent/a.hdr", small_open());
    ASSERT_FALSE(no_light);
    EXPECT_EQ(no_light.error().code, ExitCode::bad_input);
    OpenOptions tight = small_open();
    tight.limits.draw_bytes = 1;
    const Result<Session> too_large = Session::open("builtin:teapot", "builtin:studio", tight);
    ASSERT_FALSE(too_large);
    EXPECT_EQ(too_large.error().code, ExitCode::bad_input);

    Result<Session> session = Session::open("builtin:teapot", "builtin:studio", small_open());
    ASSERT_TRUE(session);
    for (int missing = 0; missing < 2; ++missing) {
        SessionParts parts = session->parts();
        missing == 0 ? parts.scene.reset() : parts.environment.reset();
        const Result<Session> partial = Session::make(parts);
        ASSERT_FALSE(partial);
        EXPECT_EQ(partial.error().code, ExitCode::usage);
    }
    // Instruction sets that the processor or the program lacks
    for (const int isa : {99, -1}) {
        SessionOptions options;
        options.isa = static_cast<Isa>(isa);
        const Result<Session> unknown = Session::make(session->parts(), options);
        ASSERT_FALSE(unknown);
        EXPECT_EQ(unknown.error().code, ExitCode::unavailable);
    }
    for (const Isa isa : program_isas()) {
        SessionOptions options;
        options.isa = isa;
        EXPECT_EQ(static_cast<bool>(Session::make(session->parts(), options)), isa_available(isa)) << isa_name(isa);
    }
    OpenOptions picture = small_open();
    picture.environment.picture_only = true;
    picture.environment.use_cache = false;
    const Result<Session> without_levels = Session::open("builtin:teapot", "builtin:studio", picture);
    ASSERT_FALSE(without_levels);
    EXPECT_EQ(without_levels.error().code, ExitCode::usage);
    FrameDesc wrong = small_frame(*session, "no_such_technique");
    const Result<Frame> frame = session->render(wrong);
    ASSERT_FALSE(frame);
    EXPECT_EQ(frame.error().code, ExitCode::usage);
}

TEST(session, numbers_of_choices_have_the_names_of_options)
{
    const std::vector<std::tuple<std::string, std::string, int>> named = {
        {"brdf", "ggx-aniso", choice::brdf::ggx_aniso},
        {"brdf", "beckmann", choice::brdf::beckmann},
        {"brdf", "ashikhmin-shirley", choice::brdf::ashikhmin_shirley},
        {"area-lights", "off", choice::area_way::off},
        {"area-lights", "ltc", choice::area_way::ltc},
        {"area-lights", "ltc-clipless", choice::area_way::ltc_clipless},
        {"area-lights", "mc", choice::area_way::mc},
        {"area-lights", "ltc-isotropic", choice::area_way::ltc_isotropic},
        {"diffuse", "lambert", choice::diffuse_model::lambert},
        {"diffuse", "ashikhmin-shirley", choice::diffuse_model::ashikhmin_shirley},
        {"masking", "correlated", choice::masking::correlated},
        {"masking", "separable", choice::masking::separable},
        {"dfg", "table", choice::dfg_fit::table},
        {"dfg", "fit", choice::dfg_fit::fit},
        {"fresnel", "schlick", choice::fresnel::schlick},
        {"fresnel", "conductor", choice::fresnel::conductor},
        {"fresnel", "dielectric", choice::fresnel::dielectric},
        {"frame-map", "gram-schmidt", choice::frame_map::gram_schmidt},
        {"frame-map", "quaternion", choice::frame_map::quaternion},
        {"frame-map", "normal-only", choice::frame_map::normal_only},
        {"frame-map", "off", choice::frame_map::off},
        {"pom-metric", "uv", choice::pom_metric::uv},
        {"pom-metric", "surface", choice::pom_metric::surface},
        {"horizon", "off", choice::horizon::off},
        {"horizon", "on", choice::horizon::on},
        {"as-tables", "on", choice::as_tables::on},
        {"as-tables", "off", choice::as_tables::off},
        {"glass", "interface", choice::glass::interface},
        {"glass", "body", choice::glass::body},
    };
    for (const ParameterInfo& p : parameters()) {
        const std::vector<std::string> names = choices_of(p);
        for (std::size_t i = 0; i < names.size(); ++i) {
            const auto at = std::find_if(named.begin(), named.end(),
                                         [&](const auto& n) { return std::get<0>(n) == p.option && std::get<1>(n) == names[i]; });
            if (std::string(p.option) == "brdf" && at == named.end())
                continue; // made from the same lines as the names
            ASSERT_NE(at, named.end()) << p.option << " " << names[i];
            EXPECT_EQ(std::get<2>(*at), static_cast<int>(i)) << p.option << " " << names[i];
            FrameDesc desc;
            ASSERT_TRUE(set_parameter(desc, p.option, names[i]));
            EXPECT_EQ(desc.*p.choice, std::get<2>(*at)) << p.option << " " << names[i];
        }
    }
}

const ParameterInfo& parameter_with(const std::string& option)
{
    return *std::find_if(parameters().begin(), parameters().end(), [&](const ParameterInfo& p) { return p.option == option; });
}

TEST(session, options_of_techniques_go_by_name)
{
    Result<Session> session = Session::open("builtin:plate", "builtin:studio", small_open());
    ASSERT_TRUE(session);
    FrameDesc desc = small_frame(*session, "mc"), named = desc;
    desc.brdf = 1, desc.energy_compensation = true, desc.seed = 7;
    const std::string model = choices_of(parameter_with("brdf"))[1];
    for (const auto& [name, value] : {std::pair<std::string, std::string>{"brdf", model}, {"energy-compensation", "true"}, {"seed", "7"}})
        ASSERT_TRUE(set_parameter(named, name, value)) << name;
    EXPECT_EQ(named.brdf, desc.brdf);
    EXPECT_EQ(named.energy_compensation, desc.energy_compensation);
    EXPECT_EQ(named.seed, desc.seed);
    ASSERT_TRUE(set_parameter(named, "tilt", "10,-5"));
    EXPECT_NEAR(named.tilt_rad.y, -0.0872665f, 1e-6f);
    for (const auto& [name, value] : {std::pair<std::string, std::string>{"brdf", "none"},
                                      {"brdf", "1"},
                                      {"bdrf", model},
                                      {"tilt", "10"},
                                      {"tilt", "10,99"},
                                      {"energy-compensation", "2"},
                                      {"seed", "x"},
                                      {"seed", "-1"},
                                      {"seed", "nan"},
                                      {"seed", "1.5"},
                                      {"light-samples", "1.5"}}) {
        const Status refused = set_parameter(named, name, value);
        ASSERT_FALSE(refused) << name << " " << value;
        const bool known = name != "bdrf";
        EXPECT_EQ(refused.error().place, known ? "" : name);
        EXPECT_EQ(refused.error().field, known ? std::string("FrameDesc::") + parameter_with(name).name : "") << name << " " << value;
        EXPECT_EQ(refused.error().code, ExitCode::usage);
    }
}

TEST(session, parameters_name_their_readers)
{
    std::vector<std::string> names = {"auto", "reference"};
    for (const TechniqueInfo& technique : techniques())
        names.emplace_back(technique.name);
    for (const std::string& name : names) {
        EXPECT_TRUE(reads(name, parameter_with("horizon"))) << name;
        EXPECT_EQ(reads(name, parameter_with("specular-aa")), name != "reference") << name;
        EXPECT_EQ(reads(name, parameter_with("glass")), name != "reference" && !name.starts_with("mc")) << name;
        EXPECT_EQ(reads(name, parameter_with("axis-k")), name.starts_with("major_axis")) << name;
    }
}

TEST(session, a_caller_s_faults_do_not_end_the_host)
{
    FrameDesc desc;
    const FrameDesc before = desc;
    for (const ParameterInfo& p : parameters())
        for (const double value : {p.least - 1.0, p.most + 1.0, std::nan("")})
            EXPECT_FALSE(set_parameter(desc, p, value)) << p.option << " " << value;
    EXPECT_EQ(desc.major_axis_beta, before.major_axis_beta);
    for (const int lobe : {-1, 99}) {
        const auto table = load_ltc_table("no.ltc", lobe);
        ASSERT_FALSE(table);
        EXPECT_EQ(table.error().code, ExitCode::usage);
    }
    const Image a = make_image(8, 8, 3, PixelType::f32), b = make_image(8, 9, 3, PixelType::f32);
    EXPECT_THROW((void)flip_hdr(a, b, FlipOptions(), Jobs(1)), CheckFailed);
    EXPECT_THROW((void)pixel_figures(a, b, Jobs(1)), CheckFailed);
}

TEST(session, takes_the_other_renderers)
{
    Result<Session> tile = Session::open("builtin:spheres", "builtin:studio", small_open());
    ASSERT_TRUE(tile);
    if (reference_available()) {
        SessionOptions options;
        options.backend = Backend::reference;
        options.reference.samples = 64;
        Result<Session> reference = Session::make(tile->parts(), options);
        ASSERT_TRUE(reference) << reference.error().line();
        const Result<Frame> frame = reference->render(small_frame(*reference, "mc"));
        ASSERT_TRUE(frame) << frame.error().line();
        EXPECT_FALSE(frame->variance.empty());
    }
    SessionOptions options;
    options.backend = Backend::vulkan;
    options.vulkan.device = "lavapipe";
    Result<Session> vulkan = Session::make(tile->parts(), options);
    if (!vulkan) {
        EXPECT_EQ(vulkan.error().code, ExitCode::unavailable);
        GTEST_SKIP() << vulkan.error().line();
    }
    EXPECT_EQ(drawn(*vulkan), drawn(*tile));
}

} // namespace
} // namespace burnish
