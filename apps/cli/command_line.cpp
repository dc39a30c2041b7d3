#include "apps/cli/command_line.h"

#include <algorithm>
#include <fmt/core.h>

#include "apps/cli/report.h"
#include "apps/cli/suggest.h"

namespace burnish {
namespace {

constexpr std::size_t kColumn = 36; // start column of help texts
constexpr const char* kHelp = "Print this text and exit";

// The texts given for each option, in table order.
struct Given {
    std::vector<std::vector<std::string>> texts;
    Asked asked = Asked::nothing;
    std::string wrong;              // first error in the words; empty: none
    std::size_t output_or_help = 0; // index of the first word that gives an output, or asks; else the number of words
};

// Splits words into options and their texts.
class Reader {
  public:
    Reader(const std::vector<Option>& options, const std::vector<std::string>& words) : options_(options), words_(words)
    {
        given_.texts.resize(options.size());
        given_.output_or_help = words.size();
    }

    Given read()
    {
        bool only_places = false; // after "--"
        while (at_ < words_.size()) {
            word_ = at_;
            const std::string& word = words_[at_++];
            if (only_places || word.size() < 2 || word[0] != '-' || is_number(word))
                place(word);
            else if (word == "--")
                only_places = true;
            else if (word[1] == '-')
                long_option(word);
            else
                letters(word);
        }
        return std::move(given_);
    }

  private:
    // Returns true for "-1" and "-.5": these are values, not option letters.
    static bool is_number(const std::string& word) { return (word[1] >= '0' && word[1] <= '9') || word[1] == '.'; }

    void refuse(const std::string& reason)
    {
        if (given_.wrong.empty())
            given_.wrong = reason;
    }
    void refuse_word(const std::string& word) { refuse("The following argument was not expected: " + word); }

    void refuse_option(const std::string& word, const std::string& name)
    {
        std::vector<std::string> names = {"--help"};
        for (const Option& option : options_)
            if (!option.positional())
                names.push_back(option.name);
        refuse("The following argument was not expected: " + word + did_you_mean(name, names));
    }

    void place(const std::string& word)
    {
        for (std::size_t i = 0; i < options_.size(); ++i)
            if (options_[i].positional() && (options_[i].value.repeated || given_.texts[i].empty()))
                return take(i, word);
        const bool torn =
            last_ < options_.size() && options_[last_].value.kind == ValueKind::vector && word.find_first_of("0123456789") == 0;
        refuse("The following argument was not expected: " + word +
               (torn ? fmt::format("; {} takes {}, with commas and no blanks", options_[last_].name, options_[last_].value_name) : ""));
    }

    void long_option(const std::string& word)
    {
        const std::size_t equals = word.find('=');
        const std::string name = word.substr(0, equals);
        if (name == "--help")
            ask(Asked::help);
        else if (const std::size_t i = index_of(name); i == options_.size())
            name == "--version" ? ask(Asked::version) : refuse_option(word, name);
        else if (!options_[i].takes_value())
            equals == std::string::npos ? given_.texts[i].push_back("") : refuse(name + ": takes no value");
        else if (equals != std::string::npos)
            take(i, word.substr(equals + 1));
        else
            take_next(i);
    }

    // Reads option letters: "-q", "-qv", "-t4", "-qt4", "-t 4".
    void letters(const std::string& word)
    {
        for (std::size_t k = 1; k < word.size(); ++k) {
            std::size_t i = 0;
            while (i < options_.size() && options_[i].letter != word[k])
                ++i;
            if (word[k] == 'h')
                ask(Asked::help);
            else if (i == options_.size())
                return refuse_word(word);
            else if (!options_[i].takes_value())
                given_.texts[i].push_back("");
            else
                return k + 1 < word.size() ? take(i, word.substr(k + 1)) : take_next(i);
        }
    }

    void ask(Asked asked)
    {
        given_.asked = asked;
        given_.output_or_help = std::min(given_.output_or_help, word_);
    }

    void note_output(std::size_t i)
    {
        if (options_[i].output)
            given_.output_or_help = std::min(given_.output_or_help, word_);
    }

    std::size_t index_of(const std::string& name) const
    {
        std::size_t i = 0;
        while (i < options_.size() && options_[i].name != name)
            ++i;
        return i;
    }

    void take_next(std::size_t i)
    {
        note_output(i);
        if (at_ < words_.size())
            take(i, words_[at_++]);
        else
            refuse(fmt::format("{}: 1 required {} missing", options_[i].name, options_[i].value_name));
    }

    void take(std::size_t i, const std::string& text)
    {
        if (text.empty())
            refuse(options_[i].name + ": the value is empty");
        if (!options_[i].positional())
            last_ = i;
        note_output(i);
        given_.texts[i].push_back(text);
    }

    const std::vector<Option>& options_;
    const std::vector<std::string>& words_;
    std::size_t at_ = 0, word_ = 0, last_ = static_cast<std::size_t>(-1); // word_: of the option; last_: the option that took a value last
    Given given_;
};

// Formats "  -o,--output FILE ...              Picture to write".
std::string help_line(const std::string& names, const std::string& text)
{
    std::string line = "  " + names;
    if (line.size() + 1 > kColumn)
        line += "\n";
    else
        line.resize(kColumn, ' ');
    return line + (line.back() == '\n' ? std::string(kColumn, ' ') : "") + text + "\n";
}

std::string help_line(const Option& option)
{
    std::string names = option.letter ? fmt::format("-{},{}", option.letter, option.name) : option.name;
    if (option.takes_value() && !option.positional())
        names += " " + option.value_name;
    if (option.value.repeated)
        names += " ...";
    if (option.required)
        names += " REQUIRED";
    return help_line(names, option.help_text());
}

} // namespace

Status read_command_line(Command& command, const std::vector<std::string>& words)
{
    std::vector<Option>& options = command.options.options();
    Given given = Reader(options, words).read();
    for (std::size_t i = 0; i < options.size(); ++i)
        if (options[i].required && given.texts[i].empty() && given.wrong.empty())
            given.wrong = options[i].name + " is required" + (options[i].help == "{}" ? ": " + options[i].meaning() : "");
    if (!given.wrong.empty())
        return usage_error("", fmt::format("{} (see burnish {} --help)", given.wrong, command.name));
    for (std::size_t i = 0; i < options.size(); ++i) {
        options[i].given = !given.texts[i].empty();
        if (!options[i].given)
            continue;
        options[i].texts = given.texts[i];
        BN_TRY(options[i].value.set(options[i].name, given.texts[i]));
    }
    return command.options.check_needs();
}

Asked asked_by(const Command& command, const std::vector<std::string>& words)
{
    return Reader(command.options.options(), words).read().asked;
}

std::size_t find_output_or_help(const OptionTable& table, const std::vector<std::string>& words)
{
    return Reader(table.options(), words).read().output_or_help;
}

std::string usage_of(const OptionTable& table)
{
    std::string usage = "[OPTIONS]";
    for (const Option& option : table.options())
        if (option.positional())
            usage += (option.required ? " " : " [") + option.name + (option.value.repeated ? "..." : "") + (option.required ? "" : "]");
    return usage;
}

std::string help_of(const Command& command)
{
    std::string text = fmt::format("{}\nUsage: burnish {} {}\n", command.summary, command.name, usage_of(command.options));
    std::string places, plain = help_line("-h,--help", kHelp);
    std::vector<std::string> headings;
    for (const Option& option : command.options.options()) {
        if (option.positional())
            places += help_line(option);
        else if (option.group.empty())
            plain += help_line(option);
        else if (std::find(headings.begin(), headings.end(), option.group) == headings.end())
            headings.push_back(option.group);
    }
    if (!places.empty())
        text += "\nPositionals:\n" + places;
    text += "\nOptions:\n" + plain;
    for (const std::string& heading : headings) {
        text += "\n" + heading + ":\n";
        for (const Option& option : command.options.options())
            if (!option.positional() && option.group == heading)
                text += help_line(option);
    }
    return text + "\n" + command.footer + "\n";
}

std::string help_of(const std::vector<Command>& commands, const std::string& footer)
{
    std::string text = "burnish renders anisotropic materials on the CPU.\nUsage: burnish [OPTIONS] SUBCOMMAND\n\nOptions:\n";
    text += help_line("--version", "Display program version information and exit") + help_line("-h,--help", kHelp) + "\nSubcommands:\n";
    for (const Command& command : commands)
        text += help_line(command.name, command.summary);
    return text + "\n" + footer + "\n";
}

} // namespace burnish
