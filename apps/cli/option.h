// Options, each described once: its name, its values, their target and its help. The command line, the help and later uses by name read
// the same rows.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

enum class ValueKind { flag, count, integer, number, bytes, size, vector, name, names, text, file, folder };

// The type and target of an option. The functions in apps/cli/values.h make values.
struct Value {
    ValueKind kind = ValueKind::text;
    double low = 0.0, high = 0.0;   // range for integers and numbers, also inside vectors
    std::vector<std::string> names; // all valid names; for files: builtin:NAME besides paths
    bool repeated = false;          // collects every occurrence; otherwise the last one counts
    // Replaces the current value. `texts` has one entry for each occurrence, at least one; entries of flags are empty.
    std::function<Status(const std::string& option, const std::vector<std::string>& texts)> set;
    std::function<std::string()> get; // the current value in command-line syntax; at first the default
};

struct Option {
    // names: "--size", "-o,--output", or "SCENE" for a positional argument. value_name: "WxH". In `help`, {} stands for the value's
    // names or
    // range. `initial`: text for the default, if `value` cannot tell; "" prints none.
    Option(const std::string& names, const std::string& value_name, const std::string& help, Value value, const char* initial = nullptr);
    Option must_be_given() const;
    Option is_output() const; // the value names a file to write

    std::string name, value_name, help, group; // name: "--output"
    char letter = '\0';                        // 'o'
    Value value;
    std::vector<std::string> texts{}; // as given, one for each occurrence
    std::optional<std::string> initial;
    std::string needed_option, needed_value; // giving this option is an error unless needed_option has needed_value
    bool required = false, given = false, output = false;

    bool positional() const { return name[0] != '-'; }
    bool takes_value() const { return value.kind != ValueKind::flag && value.kind != ValueKind::count; }
    std::string meaning() const;      // help, with the value's names or range
    std::string default_text() const; // "" without a default
    std::string help_text() const;    // meaning(), with the default in brackets
};

// All options of a subcommand, in the help's order.
class OptionTable {
  public:
    void add(const std::string& group, std::vector<Option> options);
    void add_needing(const std::string& needed_option, const std::string& needed_value, std::vector<Option> options);

    // Rows taken from another table, under a heading of this one. `help` and `initial` replace the row's own.
    struct Taken {
        Taken(const char* option_name, const char* other_help = nullptr, const char* other_initial = nullptr)
            : name(option_name), help(other_help), initial(other_initial)
        {
        }
        const char *name, *help, *initial;
    };
    void take(const OptionTable& from, const std::string& group, const std::vector<Taken>& taken);
    void take_all(const OptionTable& from, const std::string& group); // all rows under this heading

    const std::vector<Option>& options() const { return options_; }
    std::vector<Option>& options() { return options_; }
    Option* find(const std::string& name); // "--size" or "size"; null if unknown
    bool given(const std::string& name) const;
    // Reads `text` into the option's target, as the command line does.
    Status set(const std::string& name, const std::string& text) { return set_all(name, {text}); }
    Status set_all(const std::string& name, const std::vector<std::string>& texts); // of an option that was given several times
    Status check_needs() const;                                                     // fails if a given option needs another option's value

  private:
    std::vector<Option> options_;
};

} // namespace burnish
