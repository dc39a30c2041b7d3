// Shares, as users and engines tell them.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "apps/pieces/share.h"

namespace burnish::test {
namespace {

std::map<std::string, std::string> variables;

const char* variable(const char* name)
{
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
}

struct Told {
    const char* text;
    std::map<std::string, std::string> variables;
    std::uint64_t index, count;
};

TEST(share, is_as_the_user_or_the_engine_says)
{
    const Told all[] = {{"1/1", {}, 0, 1},
                        {"3/16", {}, 2, 16},
                        {"auto", {{"SLURM_ARRAY_TASK_ID", "5"}, {"SLURM_ARRAY_TASK_MIN", "0"}, {"SLURM_ARRAY_TASK_MAX", "7"}}, 5, 8},
                        {"auto",
                         {{"SLURM_ARRAY_TASK_ID", "7"},
                          {"SLURM_ARRAY_TASK_MIN", "1"},
                          {"SLURM_ARRAY_TASK_MAX", "9"},
                          {"SLURM_ARRAY_TASK_STEP", "2"},
                          {"SLURM_PROCID", "0"},
                          {"SLURM_NTASKS", "1"}},
                         3,
                         5},
                        {"auto", {{"SLURM_ARRAY_TASK_ID", "0"}, {"SLURM_ARRAY_TASK_COUNT", "4"}}, 0, 4},
                        {"auto", {{"SGE_TASK_ID", "2"}, {"SGE_TASK_FIRST", "1"}, {"SGE_TASK_LAST", "4"}, {"SGE_TASK_STEPSIZE", "1"}}, 1, 4},
                        {"auto", {{"SGE_TASK_ID", "undefined"}, {"PMI_RANK", "1"}, {"PMI_SIZE", "3"}}, 1, 3},
                        {"auto", {{"OMPI_COMM_WORLD_RANK", "0"}, {"OMPI_COMM_WORLD_SIZE", "2"}}, 0, 2},
                        {"auto", {{"SLURM_PROCID", "3"}, {"SLURM_NTASKS", "4"}}, 3, 4},
                        {"auto/6", {{"JOB_COMPLETION_INDEX", "5"}}, 5, 6},
                        {"auto/3", {{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "8"}}, 2, 3}};
    for (const Told& told : all) {
        SCOPED_TRACE(told.text);
        variables = told.variables;
        const Result<Share> share = parse_share(told.text, variable);
        ASSERT_TRUE(share) << share.error().line();
        EXPECT_EQ(share->index, told.index);
        EXPECT_EQ(share->count, told.count);
    }
}

TEST(share, deals_each_piece_once)
{
    for (std::uint64_t piece = 0; piece < 20; ++piece) {
        int holders = 0;
        for (std::uint64_t i = 0; i < 3; ++i)
            holders += Share{i, 3}.holds(piece);
        EXPECT_EQ(holders, 1);
    }
}

struct Wrong {
    const char* text;
    std::map<std::string, std::string> variables;
    const char* needle;
};

TEST(share, names_what_is_wrong)
{
    const Wrong all[] = {
        {"0/4", {}, "1..4"},
        {"5/4", {}, "1..4"},
        {"1/0", {}, "1 or more"},
        {"1/x", {}, "1 or more"},
        {"-1/4", {}, "I/N"},
        {"3", {}, "I/N"},
        {"", {}, "I/N"},
        {"auto", {}, "SLURM_ARRAY_TASK_ID"},
        {"auto",
         {{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_MIN", "1"}, {"SLURM_ARRAY_TASK_MAX", "7"}, {"SLURM_ARRAY_TASK_COUNT", "3"}},
         "--take"},
        {"auto/0", {{"PMI_RANK", "1"}}, "1 or more"},
        {"auto", {{"JOB_COMPLETION_INDEX", "1"}}, "auto/N"},
        {"auto/2", {{"JOB_COMPLETION_INDEX", "2"}}, "2 shares"},
        {"auto", {{"PMI_RANK", "4"}, {"PMI_SIZE", "4"}}, "4 shares"},
        {"auto",
         {{"SLURM_ARRAY_TASK_ID", "2"}, {"SLURM_ARRAY_TASK_MIN", "1"}, {"SLURM_ARRAY_TASK_MAX", "9"}, {"SLURM_ARRAY_TASK_STEP", "2"}},
         "none of its array"}};
    for (const Wrong& wrong : all) {
        SCOPED_TRACE(wrong.text);
        variables = wrong.variables;
        const Result<Share> share = parse_share(wrong.text, variable);
        ASSERT_FALSE(share);
        EXPECT_EQ(share.error().code, ExitCode::usage);
        EXPECT_NE(share.error().line().find(wrong.needle), std::string::npos) << share.error().line();
    }
}

} // namespace
} // namespace burnish::test
