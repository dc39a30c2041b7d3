// Reads words of a command line as values.
#include <gtest/gtest.h>

#include "apps/cli/command_line.h"
#include "apps/cli/suggest.h"
#include "apps/cli/values.h"
#include "core/base/text.h"

namespace burnish {
namespace {

struct Sample {
    int number = 3, loud = 0;
    bool plain = false, kept = true;
    std::string name = "one";
    std::vector<std::string> files, places;
    Command command{"sample", "A sample", {}, "Examples:\n  none", [](OptionTable&) { return 0; }};

    Sample()
    {
        command.options.add("", {{"PLACE", "", "Where", burnish::files(places)}});
        command.options.add("Group", {{"-n,--number", "N", "A number, {}", integer(number, 0, 10)},
                                      {"-l,--loud", "", "Louder", count(loud)},
                                      {"-p,--plain", "", "Plainer", flag(plain)},
                                      {"--drop", "", "Do not keep", flag(kept, false)},
                                      {"--name", "NAME", "{}", choice(name, {"one", "two", "three"})},
                                      {"-o,--output", "FILE", "Files", burnish::files(files)}});
    }
    std::string read(const std::vector<std::string>& words)
    {
        const Status status = read_command_line(command, words);
        return status ? "" : status.error().line();
    }
};

TEST(cli_words, of_one_text_are_those_that_a_shell_reads)
{
    using Words = std::vector<std::string>;
    EXPECT_EQ(split_words("  a  b\tc\n"), (Words{"a", "b", "c"}));
    EXPECT_EQ(split_words("'a b' \"c 'd'\" e\\ f"), (Words{"a b", "c 'd'", "e f"}));
    EXPECT_EQ(split_words("--light=\"x y\"z '' 'a\\b'"), (Words{"--light=x yz", "", "a\\b"}));
    EXPECT_EQ(split_words(""), Words());
    EXPECT_EQ(split_words("a 'b"), std::nullopt);
    EXPECT_EQ(split_words("a \"b\\\""), std::nullopt);
}

TEST(cli_words, options_take_values_as_shells_users_write_them)
{
    Sample s;
    EXPECT_EQ(s.read({"-n4", "here", "--name=two", "-lpl", "--drop", "-o", "a", "-ob", "--output=c", "--", "-there", "-1"}), "");
    EXPECT_EQ(s.number, 4);
    EXPECT_EQ(s.name, "two");
    EXPECT_EQ(s.loud, 2);
    EXPECT_TRUE(s.plain);
    EXPECT_FALSE(s.kept);
    EXPECT_EQ(s.files, (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_EQ(s.places, (std::vector<std::string>{"here", "-there", "-1"}));
    EXPECT_TRUE(s.command.options.given("--name"));
    Sample numbers; // and a lone minus: places, not letters
    EXPECT_EQ(numbers.read({"-1", "-.5", "-", "-n", "7"}), "");
    EXPECT_EQ(numbers.places.size(), 3u);
    EXPECT_EQ(numbers.number, 7);
    EXPECT_FALSE(numbers.command.options.given("--name"));
}

TEST(cli_words, of_an_option_given_twice_the_last_one_counts_and_the_first_may_be_wrong)
{
    Sample s;
    EXPECT_EQ(s.read({"--number", "99", "--number", "5"}), "");
    EXPECT_EQ(s.number, 5);
}

TEST(cli_words, what_is_wrong_is_named)
{
    const std::string hint = " (see burnish sample --help)";
    EXPECT_EQ(Sample().read({"--bogus"}), "The following argument was not expected: --bogus" + hint);
    EXPECT_EQ(Sample().read({"-lx"}), "The following argument was not expected: -lx" + hint);
    EXPECT_EQ(Sample().read({"--output"}), "--output: 1 required FILE missing" + hint);
    EXPECT_EQ(Sample().read({"-pn"}), "--number: 1 required N missing" + hint);
    EXPECT_EQ(Sample().read({"--name="}), "--name: the value is empty" + hint);
    EXPECT_EQ(Sample().read({"--plain=no"}), "--plain: takes no value" + hint);
    EXPECT_EQ(Sample().read({"--number", "11"}), "--number: expected a whole number from 0 to 10, got '11'");
    EXPECT_EQ(Sample().read({"--name", "four"}), "--name: 'four' is not one of one, two, three");
    Sample required;
    required.command.options.options()[1].required = true;
    EXPECT_EQ(required.read({"here"}), "--number is required" + hint);
}

TEST(cli_words, help_is_asked_for_anywhere_but_in_a_value)
{
    const Command command = Sample().command;
    EXPECT_EQ(asked_by(command, {"here", "--bogus", "--help"}), Asked::help);
    EXPECT_EQ(asked_by(command, {"-ph"}), Asked::help);
    EXPECT_EQ(asked_by(command, {"-o", "--help"}), Asked::nothing);
    EXPECT_EQ(asked_by(command, {"-oh", "--", "-h"}), Asked::nothing);
}

TEST(cli_words, help_holds_every_option_with_its_values_and_its_default)
{
    Sample s;
    const std::string help = help_of(s.command);
    for (const char* line : {"A sample\nUsage: burnish sample [OPTIONS] [PLACE...]\n", "\nPositionals:\n  PLACE ...",
                             "\nGroup:\n  -n,--number N                     A number, 0 to 10 (3)\n",
                             "  --name NAME                       one, two or three (one)\n", "  -o,--output FILE ...              Files\n",
                             "\nExamples:\n  none\n"})
        EXPECT_NE(help.find(line), std::string::npos) << line << "\nin\n" << help;
}

TEST(cli_words, names_that_were_meant_are_near_and_others_get_no_guess)
{
    const std::vector<std::string> names = {"major_axis", "major_axis_weighted", "mc", "bent_normal"};
    EXPECT_EQ(nearest_name("major-axis", names), "major_axis");
    EXPECT_EQ(nearest_name("bnet_normal", names), "bent_normal"); // swapping two letters counts as one slip
    EXPECT_EQ(nearest_name("weighted", names), "major_axis_weighted");
    EXPECT_EQ(nearest_name("cm", names), "mc");
    for (const char* word : {"", "x", "nothing", "a_word_of_another_language"})
        EXPECT_EQ(nearest_name(word, names), "") << word;
    Sample s;
    EXPECT_NE(s.read({"--nmae", "one"}).find("did you mean '--name'?"), std::string::npos);
    EXPECT_NE(s.read({"--name", "tow"}).find("did you mean 'two'?"), std::string::npos);
}

} // namespace
} // namespace burnish
