#include "apps/cli/option.h"

#include <algorithm>
#include <fmt/core.h>
#include <iterator>

#include "apps/cli/report.h"
#include "core/base/check.h"

namespace burnish {
namespace {

// Formats "32 or 64", "none, pbr-neutral or aces", "0 to 1".
std::string values_text(const Value& value)
{
    if (value.names.empty())
        return fmt::format("{:g} to {:g}", value.low, value.high);
    std::string text;
    for (std::size_t i = 0; i < value.names.size(); ++i)
        text += (i == 0 ? "" : i + 1 == value.names.size() ? " or " : ", ") + value.names[i];
    return text;
}

} // namespace

Option::Option(const std::string& names, const std::string& value_text, const std::string& help_text_, Value what, const char* at_first)
    : name(names), value_name(value_text), help(help_text_), value(std::move(what))
{
    if (at_first)
        initial = at_first;
    if (const std::size_t comma = names.find(','); comma != std::string::npos)
        letter = names[1], name = names.substr(comma + 1);
}

Option Option::must_be_given() const
{
    Option option = *this;
    option.required = true;
    return option;
}

Option Option::is_output() const
{
    Option option = *this;
    option.output = true;
    return option;
}

std::string Option::meaning() const
{
    std::string text = help;
    if (const std::size_t at = text.find("{}"); at != std::string::npos)
        text.replace(at, 2, values_text(value));
    return text;
}

std::string Option::default_text() const
{
    return required ? "" : initial ? *initial : takes_value() ? value.get() : ""; // what must be given has no default
}

std::string Option::help_text() const
{
    const std::string text = meaning(), shown = default_text();
    return shown.empty() ? text : fmt::format("{} ({})", text, shown);
}

void OptionTable::add(const std::string& group, std::vector<Option> options)
{
    for (Option& option : options) {
        option.group = group;
        options_.push_back(std::move(option));
    }
}

void OptionTable::add_needing(const std::string& needed_option, const std::string& needed_value, std::vector<Option> options)
{
    for (Option& option : options)
        option.needed_option = needed_option, option.needed_value = needed_value;
    add(fmt::format("With {} {}", needed_option, needed_value), std::move(options));
}

void OptionTable::take(const OptionTable& from, const std::string& group, const std::vector<Taken>& taken)
{
    for (const Taken& wanted : taken) {
        const Option* found = const_cast<OptionTable&>(from).find(wanted.name);
        BN_CHECK(found);
        Option option = *found;
        option.group = group;
        if (wanted.help)
            option.help = wanted.help;
        if (wanted.initial)
            option.initial = wanted.initial;
        options_.push_back(std::move(option));
    }
}

void OptionTable::take_all(const OptionTable& from, const std::string& group)
{
    const std::size_t before = options_.size();
    std::copy_if(from.options_.begin(), from.options_.end(), std::back_inserter(options_),
                 [&](const Option& o) { return o.group == group; });
    BN_CHECK(options_.size() > before);
}

Option* OptionTable::find(const std::string& name)
{
    for (Option& option : options_)
        if (option.name == name || option.name == "--" + name)
            return &option;
    return nullptr;
}

bool OptionTable::given(const std::string& name) const
{
    for (const Option& option : options_)
        if (option.name == name)
            return option.given;
    return false;
}

Status OptionTable::set_all(const std::string& name, const std::vector<std::string>& texts)
{
    Option* option = find(name);
    if (!option)
        return usage_error(name, "is no option");
    option->given = true, option->texts = texts;
    return option->value.set(option->name, texts);
}

Status OptionTable::check_needs() const
{
    for (const Option& option : options_) {
        if (!option.given || option.needed_option.empty())
            continue;
        for (const Option& needed : options_)
            if (needed.name == option.needed_option && needed.value.get() != option.needed_value)
                return usage_error(option.name, fmt::format("needs {} {}", option.needed_option, option.needed_value));
    }
    return {};
}

} // namespace burnish
