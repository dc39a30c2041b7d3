#include "apps/plan/plan.h"

#include <gtest/gtest.h>

#include "apps/plan/cost.h"
#include "core/base/file.h"

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

FrameDesc desc_of(const Session& session)
{
    FrameDesc desc;
    desc.width = 480, desc.height = 320, desc.msaa = 1;
    desc.view = session.framed(desc.width, desc.height);
    return desc;
}

Plan plan_of(Session& session, double error)
{
    Result<Plan> plan = make_plan(session, desc_of(session), {error, {}, {}}, "", 0);
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
        const Result<Plan> tail = make_plan(session, desc_of(session), {{}, 0.3, {}}, "", 0);
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
    const Result<Plan> plan = make_plan(spheres(), desc_of(spheres()), {0.5, {}, {}}, "lobe_line", 0);
    ASSERT_TRUE(plan);
    for (const PlannedMaterial& m : plan->materials)
        EXPECT_TRUE(m.share == 0.0 || m.chosen.setting.technique == "lobe_line") << m.chosen.setting.technique;
    const Result<Plan> none = make_plan(spheres(), desc_of(spheres()), {0.5, {}, {}}, "filtered_is_ggx", 0);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ExitCode::usage);
}

TEST(plan, budgets_out_of_reach_are_errors)
{
    const Result<Plan> plan = make_plan(spheres(), desc_of(spheres()), {1e-7, {}, {}}, "", 0);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, ExitCode::usage);
    EXPECT_NE(plan.error().reason.find("no setting reaches"), std::string::npos);
    const Result<Plan> fixed = make_plan(spheres(), desc_of(spheres()), {0.01, {}, {}}, "split_isotropic", 0);
    ASSERT_FALSE(fixed);
    EXPECT_NE(fixed.error().reason.find("no setting reaches"), std::string::npos);
}

TEST(plan, more_time_errs_less)
{
    double error = 1.0;
    for (const double ms : {1e-3, 1e3, 1e6}) {
        const Result<Plan> plan = make_plan(spheres(), desc_of(spheres()), {{}, {}, ms}, "", 0);
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
        const Result<Plan> plan = make_plan(spheres(), desc_of(spheres()), {{}, p99, {}}, "", 0);
        ASSERT_TRUE(plan) << plan.error().line();
        ASSERT_TRUE(plan->p99);
        EXPECT_LE(*plan->p99 * kTailSafety, p99);
        EXPECT_GT(plan->cost, cost);
        cost = plan->cost;
    }
    const Result<Plan> none = make_plan(spheres(), desc_of(spheres()), {{}, 1e-6, {}}, "", 0);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().field, "--budget-p99");
}

TEST(plan, beside_a_mean_a_percentile_only_adds)
{
    const Plan mean = plan_of(spheres(), 0.05);
    const Result<Plan> loose = make_plan(spheres(), desc_of(spheres()), {0.05, 1.0, {}}, "", 0);
    const Result<Plan> both = make_plan(spheres(), desc_of(spheres()), {0.05, 0.15, {}}, "", 0);
    const Result<Plan> tail = make_plan(spheres(), desc_of(spheres()), {{}, 0.15, {}}, "", 0);
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
    const Result<Plan> plan = make_plan(spheres(), desc, {0.03, {}, {}}, "", 0);
    ASSERT_TRUE(plan);
    EXPECT_FALSE(plan->aside.empty());
    EXPECT_TRUE(plan->settings().empty());
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
    const std::string path_ = testing::TempDir() + "plan_test.json";
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
    ASSERT_EQ(read->size(), plan.settings().size());
    for (std::size_t i = 0; i < read->size(); ++i) {
        EXPECT_EQ((*read)[i].technique, plan.settings()[i].technique);
        EXPECT_EQ((*read)[i].samples, plan.settings()[i].samples);
    }
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
}

} // namespace
} // namespace burnish
