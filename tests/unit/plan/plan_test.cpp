#include "apps/plan/plan.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "apps/options/scene_view.h"
#include "apps/plan/cost.h"
#include "core/base/file.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

OpenOptions small_environment(int threads)
{
    OpenOptions open;
    open.threads = threads;
    open.environment.cube_size = 64, open.environment.samples = 64, open.environment.use_cache = false;
    return open;
}

Session& spheres()
{
    static Result<Session> session = Session::open("builtin:spheres", "builtin:studio", small_environment(2));
    return *session;
}

Session& lights()
{
    static Result<Session> session = Session::open("builtin:lights", "builtin:studio", small_environment(2));
    return *session;
}

// Views the scene by its own camera, or whole.
FrameDesc desc_of(const Session& session)
{
    RenderOptions options;
    options.frame.width = 480, options.frame.height = 320, options.frame.msaa = 1;
    const Result<ChosenView> view = choose_view(options, session.scene(), session.tables());
    EXPECT_TRUE(view);
    options.frame.view = view->view;
    return options.frame;
}

Plan plan_of(Session& session, double error)
{
    Result<Plan> plan = make_plan(session, desc_of(session), {error, {}, {}});
    EXPECT_TRUE(plan) << (plan ? "" : plan.error().line());
    return plan ? *plan : Plan{};
}

TEST(plan, a_smaller_budget_costs_more_and_errs_less)
{
    double cost = 0.0, error = 1.0;
    for (const double budget : {0.2, 0.05, 0.03, 0.02}) {
        const Plan plan = plan_of(spheres(), budget);
        EXPECT_LE(plan.error * kPlanSafety, budget);
        EXPECT_GE(plan.cost, cost);
        EXPECT_LE(plan.error, error);
        cost = plan.cost, error = plan.error;
    }
    EXPECT_GT(cost, plan_of(spheres(), 0.2).cost);
}

TEST(plan, is_equal_for_every_number_of_threads_and_instruction_set)
{
    const PlanSubject none;
    const auto plans_of = [&](Session& session) {
        const Result<Plan> tail = make_plan(session, desc_of(session), {{}, 0.3, {}});
        return plan_json(plan_of(session, 0.03), none) + (tail ? plan_json(*tail, none) : tail.error().line());
    };
    const std::string expected = plans_of(spheres());
    for (const Isa isa : program_isas()) {
        if (!isa_available(isa))
            continue;
        SessionOptions options;
        options.isa = isa;
        Result<Session> other = Session::open("builtin:spheres", "builtin:studio", small_environment(isa == best_isa() ? 1 : 3), options);
        ASSERT_TRUE(other);
        EXPECT_EQ(plans_of(*other), expected) << isa_name(isa);
    }
}

TEST(plan, keeps_what_the_user_fixed)
{
    const Result<Plan> plan = make_plan(spheres(), desc_of(spheres()), {0.5, {}, {}}, {.technique = "lobe_line"});
    ASSERT_TRUE(plan);
    for (const PlannedMaterial& m : plan->materials)
        EXPECT_TRUE(m.share == 0.0 || m.chosen.setting.technique == "lobe_line") << m.chosen.setting.technique;
    const Result<Plan> none = make_plan(spheres(), desc_of(spheres()), {0.5, {}, {}}, {.technique = "filtered_is_ggx"});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ExitCode::usage);
}

TEST(plan, budgets_out_of_reach_are_errors)
{
    const Result<Plan> plan = make_plan(spheres(), desc_of(spheres()), {1e-7, {}, {}});
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, ExitCode::usage);
    EXPECT_NE(plan.error().reason.find("no setting reaches"), std::string::npos);
    const Result<Plan> fixed = make_plan(spheres(), desc_of(spheres()), {0.01, {}, {}}, {.technique = "split_isotropic"});
    ASSERT_FALSE(fixed);
    EXPECT_NE(fixed.error().reason.find("no setting reaches"), std::string::npos);
}

TEST(plan, more_time_errs_less)
{
    double error = 1.0;
    for (const double ms : {1e-3, 1e3, 1e6}) {
        const Result<Plan> plan = make_plan(spheres(), desc_of(spheres()), {{}, {}, ms});
        ASSERT_TRUE(plan);
        ASSERT_TRUE(plan->cpu_ms);
        EXPECT_GT(*plan->cpu_ms, 0.0);
        EXPECT_LE(plan->error, error);
        error = plan->error;
    }
    EXPECT_LT(error, 0.02) << "mc with many samples fits into a quarter of an hour";
}

TEST(plan, a_percentile_holds_the_tail_and_a_smaller_one_costs_more)
{
    double cost = 0.0;
    for (const double p99 : {0.6, 0.3, 0.15}) {
        const Result<Plan> plan = make_plan(spheres(), desc_of(spheres()), {{}, p99, {}});
        ASSERT_TRUE(plan) << plan.error().line();
        ASSERT_TRUE(plan->p99);
        EXPECT_LE(*plan->p99 * kTailSafety, p99);
        EXPECT_GT(plan->cost, cost);
        cost = plan->cost;
    }
    const Result<Plan> none = make_plan(spheres(), desc_of(spheres()), {{}, 1e-6, {}});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().field, "--budget-p99");
}

TEST(plan, beside_a_mean_a_percentile_only_adds)
{
    const Plan mean = plan_of(spheres(), 0.05);
    const Result<Plan> loose = make_plan(spheres(), desc_of(spheres()), {0.05, 1.0, {}});
    const Result<Plan> both = make_plan(spheres(), desc_of(spheres()), {0.05, 0.15, {}});
    const Result<Plan> tail = make_plan(spheres(), desc_of(spheres()), {{}, 0.15, {}});
    ASSERT_TRUE(loose && both && tail);
    EXPECT_EQ(loose->cost, mean.cost) << "a percentile that holds anyway changes nothing";
    EXPECT_LE(both->error * kPlanSafety, 0.05);
    EXPECT_LE(*both->p99 * kTailSafety, 0.15);
    EXPECT_GT(both->cost, mean.cost);
    EXPECT_GE(both->cost, tail->cost);
}

TEST(plan, stands_aside_for_small_pictures)
{
    FrameDesc desc = desc_of(spheres());
    desc.width = desc.height = 64;
    const Result<Plan> plan = make_plan(spheres(), desc, {0.03, {}, {}});
    ASSERT_TRUE(plan);
    EXPECT_FALSE(plan->aside.empty());
    EXPECT_TRUE(plan->frame().by_material.empty());
}

// Cosines err under area lights, so a small budget takes points on the lights.
TEST(plan, chooses_the_method_for_area_lights)
{
    EXPECT_FALSE(plan_of(spheres(), 0.2).area_lights);
    double error = 1.0;
    for (const double budget : {0.2, 0.08, 0.03}) {
        const Plan plan = plan_of(lights(), budget);
        ASSERT_TRUE(plan.area_lights);
        EXPECT_LE(plan.error * kPlanSafety, budget);
        EXPECT_LE(plan.area_lights->chosen.error, error);
        error = plan.area_lights->chosen.error;
        FrameDesc desc = desc_of(lights());
        plan.frame().put(desc);
        EXPECT_TRUE(check_desc(desc));
        if (plan.area_lights->better) {
            EXPECT_LT(plan.area_lights->better->error, error);
        }
    }
    EXPECT_EQ(plan_of(lights(), 0.2).area_lights->chosen.setting.samples, 1);
    EXPECT_EQ(plan_of(lights(), 0.03).area_lights->chosen.setting.way, kAreaWay_mc);
    // A given method is kept, and its error counts
    FrameDesc desc = desc_of(lights());
    const Result<Plan> given = make_plan(lights(), desc, {0.2, {}, {}}, {.area_lights = true});
    ASSERT_TRUE(given && given->area_lights);
    EXPECT_EQ(given->area_lights->chosen.setting.way, desc.area_way);
    EXPECT_GT(given->area_lights->chosen.error, 0.01);
    // Lights that give no light have no method
    desc.area_way = kAreaWay_off;
    const Result<Plan> dark = make_plan(lights(), desc, {0.2, {}, {}});
    ASSERT_TRUE(dark);
    EXPECT_FALSE(dark->area_lights);
}

TEST(plan, every_setting_has_a_technique_that_materials_may_have)
{
    for (const MaterialTechnique& m : plannable_settings()) {
        FrameDesc desc = desc_of(spheres());
        desc.by_material = {m};
        EXPECT_TRUE(check_desc(desc)) << m.technique;
    }
}

class plan_file : public testing::Test {
  protected:
    const std::string path_ = testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() + ".json";
    const PlanSubject subject_ = {"a scene", "a sky", "a view", 480, 320, "0123"};
    void write(const std::string& text) { ASSERT_TRUE(write_file_atomic(path_, text.data(), text.size())); }
    void refused(const PlanSubject& subject, std::size_t materials, const std::string& place)
    {
        const auto read = read_plan(path_, subject, materials);
        ASSERT_FALSE(read) << place;
        EXPECT_EQ(read.error().code, ExitCode::bad_input);
        EXPECT_EQ(read.error().place, place) << read.error().line();
    }
};

TEST_F(plan_file, holds_the_choices)
{
    const Plan plan = plan_of(spheres(), 0.03);
    write(plan_json(plan, subject_));
    const auto read = read_plan(path_, subject_, plan.materials.size());
    ASSERT_TRUE(read) << read.error().line();
    const std::vector<MaterialTechnique> settings = plan.frame().by_material;
    ASSERT_EQ(read->by_material.size(), settings.size());
    for (std::size_t i = 0; i < settings.size(); ++i) {
        EXPECT_EQ(read->by_material[i].technique, settings[i].technique);
        EXPECT_EQ(read->by_material[i].samples, settings[i].samples);
    }
    EXPECT_FALSE(read->area_lights);
}

TEST_F(plan_file, holds_the_method_for_area_lights)
{
    const Plan plan = plan_of(lights(), 0.05);
    ASSERT_TRUE(plan.area_lights);
    write(plan_json(plan, subject_));
    const auto read = read_plan(path_, subject_, plan.materials.size());
    ASSERT_TRUE(read && read->area_lights);
    FrameDesc desc;
    read->put(desc);
    EXPECT_EQ(desc.area_way, plan.area_lights->chosen.setting.way);
    EXPECT_EQ(desc.light_samples, static_cast<std::uint32_t>(plan.area_lights->chosen.setting.samples));
}

TEST_F(plan_file, for_something_else_names_what_differs)
{
    const Plan plan = plan_of(spheres(), 0.03);
    const std::size_t count = plan.materials.size();
    write(plan_json(plan, subject_));
    PlanSubject other = subject_;
    other.scene = "another";
    refused(other, count, "/scene");
    other = subject_, other.environment = "another";
    refused(other, count, "/environment");
    other = subject_, other.view = "another";
    refused(other, count, "/view");
    other = subject_, other.width = 640;
    refused(other, count, "/size");
    other = subject_, other.content = "4567";
    refused(other, count, "/content");
    refused(subject_, count + 1, "/materials");
}

TEST_F(plan_file, that_is_malformed_is_refused_with_its_place)
{
    write("no JSON");
    refused(subject_, 1, "");
    write("[1]");
    refused(subject_, 1, "");
    write(R"({"format": 2})");
    refused(subject_, 1, "/format");
    std::string text = plan_json(Plan{}, subject_);
    const auto with = [&](const std::string& materials) {
        std::string out = text;
        out.replace(out.find("[]"), 2, materials);
        write(out);
    };
    for (const char* row : {"[1]", "[{}]", R"([{"technique": 3, "samples": 1}])", R"([{"technique": "mc", "samples": -1}])",
                            R"([{"technique": "mc", "samples": 1e99}])", R"([{"technique": "mc", "samples": 1.5}])"}) {
        with(row);
        refused(subject_, 1, "/materials/0");
    }
    for (const auto& [area, place] : {std::pair("[]", "/area_lights"),
                                      {R"({"method": "ltc"})", "/area_lights"},
                                      {R"({"method": "ltc", "samples": -1})", "/area_lights"},
                                      {R"({"method": "sunny", "samples": 1})", "/area_lights/method"}}) {
        with(fmt::format(R"([{{"technique": "mc", "samples": 1}}], "area_lights": {})", area));
        refused(subject_, 1, place);
    }
}

} // namespace
} // namespace burnish
