// Options, each described once: its name, the values that it takes, where they go, and what --help says. The command line, the help and
// whoever sets an option by its name later read the same rows.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

enum class ValueKind { flag, count, integer, number, bytes, size, vector, name, names, text, file, folder };

// What an option takes and where it goes; made by the functions of apps/cli/values.h.
struct Value {
    ValueKind kind = ValueKind::text;
    double low = 0.0, high = 0.0;   // of integers and numbers, also those of vectors
    std::vector<std::string> names; // all that a name may be; of files: builtin:NAME besides paths
    bool repeated = false;          // every time it is given counts; otherwise the last one
    // Replaces what is there; `texts`: one for each time that the option was given, at least one, of flags empty.
    std::function<Status(const std::string& option, const std::vector<std::string>& texts)> set;
    std::function<std::string()> get; // what is there, as one would write it; at first the default
};

struct Option {
    // names: "--size", "-o,--output", or "SCENE", which is told by its place; value_name: "WxH". In `help`, {} stands for the value's names
    // or its range. `initial`: what counts where the option is not given, if the value itself does not tell; "" says nothing.
    Option(const std::string& names, const std::string& value_name, const std::string& help, Value value, const char* initial = nullptr);
    Option must_be_given() const;

    std::string name, value_name, help, group; // name: "--output"
    char letter = '\0';                        // 'o'
    Value value;
    std::optional<std::string> initial;
    std::string needed_option, needed_value; // it is a mistake unless that option has that value
    bool required = false, given = false;

    bool positional() const { return name[0] != '-'; }
    bool takes_value() const { return value.kind != ValueKind::flag && value.kind != ValueKind::count; }
    std::string meaning() const;      // help, with the value's names or its range
    std::string default_text() const; // "" where there is none
    std::string help_text() const;    // the meaning, with the default in brackets
};

// All options of a subcommand, in the order of its help.
class OptionTable {
  public:
    void add(const std::string& group, std::vector<Option> options);
    void add_needing(const std::string& needed_option, const std::string& needed_value, std::vector<Option> options);

    // Some rows of another table under a heading of this one; `help` and `initial` replace theirs.
    struct Taken {
        Taken(const char* option_name, const char* other_help = nullptr, const char* other_initial = nullptr)
            : name(option_name), help(other_help), initial(other_initial)
        {
        }
        const char *name, *help, *initial;
    };
    void take(const OptionTable& from, const std::string& group, const std::vector<Taken>& taken);
    void take_all(const OptionTable& from, const std::string& group); // that are under this heading there

    const std::vector<Option>& options() const { return options_; }
    std::vector<Option>& options() { return options_; }
    Option* find(const std::string& name); // "--size" or "size"; null where there is none
    bool given(const std::string& name) const;
    // As if written on the command line: reads `text` and puts it where it belongs.
    Status set(const std::string& name, const std::string& text);
    Status check_needs() const; // no option was given that makes no sense with another one

  private:
    std::vector<Option> options_;
};

} // namespace burnish
