// Commands of pieces, and scripts for engines.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/pieces/submit.h"
#include "apps/pieces/words.h"

namespace burnish::test {
namespace {

using Words = std::vector<std::string>;

TEST(words, of_pieces_are_left_out)
{
    const Words given = {"chart", "--shard", "1/2",       "a.glb",   "--work=w", "--take", "-q",         "--threads",
                         "4",     "-t2",     "--piece=k", "--merge", "-o",       "r",      "--isa=avx2", "-vv"};
    EXPECT_EQ(without_pieces(given), (Words{"chart", "a.glb", "-q", "--threads", "4", "-t2", "-o", "r", "--isa=avx2", "-vv"}));
    EXPECT_EQ(job_words({"chart", "a.glb", "-q", "--threads", "4", "-o", "r", "--isa=avx2", "-vq", "-t", "3", "-t4", "-qt8", "-vt", "2"}),
              (Words{"chart", "a.glb", "-o", "r"}));
}

TEST(words, survive_a_shell)
{
    EXPECT_EQ(shell_words({"burnish", "a.glb", "--eye", "0,1,2"}), "burnish a.glb --eye 0,1,2");
    EXPECT_EQ(shell_words({"it's", "", "a b", "$x", "\n"}), "'it'\\''s' '' 'a b' '$x' '\n'");
}

TEST(submit, fills_all_places)
{
    for (const std::string& engine : submit_engines()) {
        SubmitOptions options;
        options.engine = engine, options.shards = 4, options.at_once = 2, options.work = "my pieces";
        options.words = {"chart", "it's.glb", "-o", "r"};
        const std::string script = submit_script(options);
        for (const char* place : {"@COMMAND@", "@JOB@", "@WORK@", "@SHARDS@", "@LAST@", "@MOST@", "@SHARES@", "@ARGS@", "@MERGE"})
            EXPECT_EQ(script.find(place), std::string::npos) << engine << script;
        EXPECT_NE(script.find("--merge"), std::string::npos) << engine;
        EXPECT_TRUE(check_submit(options) || engine == "mpi" || engine == "openjd") << engine;
        EXPECT_NE(script.find("my pieces"), std::string::npos) << engine;
    }
}

} // namespace
} // namespace burnish::test
