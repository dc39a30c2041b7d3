#include "apps/cli/manual.h"

#include <fmt/core.h>

#include "apps/cli/command_line.h"
#include "core/base/version.h"

namespace burnish {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

std::string trimmed_end(const std::string& text)
{
    return text.substr(0, text.find_last_not_of(" \n") + 1);
}

// Escapes text for roff: no escapes, no requests at line starts, and a minus that can be copied.
std::string roff(const std::string& text)
{
    std::string out = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    out = replaced(out, "\n.", "\n\\&.");
    out = replaced(out, "\n'", "\n\\&'");
    return out.empty() || (out[0] != '.' && out[0] != '\'') ? out : "\\&" + out;
}

std::string roff_option(const Option& option)
{
    std::string names = option.letter ? fmt::format("-{}, {}", option.letter, option.name) : option.name;
    if (option.takes_value() && !option.positional())
        names += " " + option.value_name;
    return fmt::format(".TP\n.B {}\n{}\n", roff(names), roff(option.help_text()));
}

bool takes_path(const Option& option)
{
    return option.value.kind == ValueKind::file || option.value.kind == ValueKind::folder;
}

// Returns all names that an option or a positional argument accepts, with blanks between.
std::string words_of(const Option& option)
{
    std::string words;
    for (const std::string& name : option.value.names)
        words += (words.empty() ? "" : " ") + name;
    return words;
}

std::string names_of(const Command& command)
{
    std::string names = "--help --version";
    for (const Option& option : command.options.options())
        if (!option.positional())
            names += " " + option.name;
    return names;
}

std::string subcommands(const std::vector<Command>& commands)
{
    std::string names;
    for (const Command& command : commands)
        names += command.name + " ";
    return names + "help";
}

// Quotes text for a shell, in single quotes.
std::string quoted(const std::string& text)
{
    return fmt::format("'{}'", replaced(text, "'", "'\\''"));
}

// Escapes text between brackets or colons of zsh's _arguments.
std::string zsh_text(const std::string& text)
{
    std::string out;
    for (const char c : text)
        out += c == '[' || c == ']' || c == ':' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return out;
}

std::string zsh_values(const Option& option)
{
    const std::string words = words_of(option);
    const std::string message = zsh_text(option.positional() ? option.name : option.value_name);
    if (words.empty())
        return fmt::format(":{}:{}", message, takes_path(option) ? "_files" : "");
    const std::string list = zsh_text(words);
    return takes_path(option) ? fmt::format(":{}:{{compadd -- {}; _files}}", message, words) : fmt::format(":{}:({})", message, list);
}

std::string zsh_option(const Option& option)
{
    if (option.positional())
        return quoted(fmt::format("{}{}", option.value.repeated ? "*" : "", zsh_values(option)));
    const std::string help = fmt::format("[{}]", zsh_text(option.help_text()));
    const std::string values = option.takes_value() ? zsh_values(option) : "";
    const char* many = option.value.repeated || !option.takes_value() ? "*" : "";
    std::string out = quoted(fmt::format("{}{}{}{}", many, option.name, help, values));
    if (option.letter)
        out += fmt::format(" {}", quoted(fmt::format("{}-{}{}{}", many, option.letter, help, values)));
    return out;
}

// Escapes the text of a Markdown table cell: no cell end, no tag, no line break.
std::string markdown_cell(const std::string& text)
{
    return replaced(replaced(replaced(text, "|", "\\|"), "<", "&lt;"), "\n", " ");
}

std::string markdown_code(const std::string& text)
{
    return text.empty() ? "" : fmt::format("`{}`", replaced(text, "|", "\\|"));
}

struct OptionPicture {
    const char *command, *option, *words, *file;
};
constexpr OptionPicture kOptionPictures[] = {
#define BN_PICTURE(command, option, words, file) {command, option, words, file},
#include "apps/cli/option_pictures.def"
};

// Returns the pictures beside a subcommand's own option, as a cell's further lines.
std::string own_pictures(const std::string& command, const std::string& option)
{
    std::string out;
    for (const OptionPicture& row : kOptionPictures)
        if (command == row.command && option == row.option)
            out += fmt::format("<br>`{}` ![{}](../pictures/{})", row.words, row.words, row.file);
    return out;
}

// Returns the pictures beside an option: its own, else those of an option of render that means the same.
std::string markdown_pictures(const Command& command, const Option& option, const std::vector<Command>& commands)
{
    const std::string own = own_pictures(command.name, option.name);
    if (!own.empty())
        return own;
    for (const Command& render : commands)
        if (render.name == "render")
            for (const Option& same : render.options.options())
                if (same.name == option.name && same.help == option.help && same.value_name == option.value_name)
                    return own_pictures(render.name, option.name);
    return "";
}

std::string markdown_option(const Command& command, const Option& option, const std::vector<Command>& commands)
{
    std::string names = markdown_code(option.name);
    if (option.letter)
        names = fmt::format("`-{}`, {}", option.letter, names);
    const std::string value = option.takes_value() && !option.positional() ? markdown_code(option.value_name) : "";
    const std::string at_first = option.required ? "must be given" : markdown_cell(option.default_text());
    const char* again = option.value.repeated && option.takes_value() ? "; may be given several times" : "";
    const std::string meaning = markdown_cell(option.meaning()) + (option.help.find("several times") == std::string::npos ? again : "") +
                                markdown_pictures(command, option, commands);
    return fmt::format("| {} | {} | {} | {} |\n", names, value, at_first, meaning);
}

// Writes one table under each option heading, in table order.
std::string markdown_options(const Command& command, const std::vector<Command>& commands)
{
    std::string out, heading;
    bool begun = false, places = false;
    for (const Option& option : command.options.options()) {
        if (!begun || option.group != heading || option.positional() != places) {
            places = option.positional(), heading = option.group;
            const std::string title = places ? "Arguments" : heading.empty() ? "Options" : heading;
            out += fmt::format("\n## {}\n\n| {} | value | default | meaning |\n| --- | --- | --- | --- |\n", title,
                               places ? "argument" : "option");
            begun = true;
        }
        out += markdown_option(command, option, commands);
    }
    return out;
}

// Writes the footer's text, and its examples as a code block.
std::string markdown_footer(const std::string& footer)
{
    const std::string mark = "Examples:\n";
    const std::size_t at = footer.find(mark);
    const std::string notes = trimmed_end(footer.substr(0, at));
    const std::string rest = at == std::string::npos ? "" : footer.substr(at + mark.size());
    const std::size_t end = rest.find("\n\n");
    std::string out = notes.empty() ? "" : fmt::format("\n## Notes\n\n{}\n", replaced(notes, "<", "&lt;"));
    if (!rest.empty())
        out += fmt::format("\n## Examples\n{}\n", replaced("\n" + trimmed_end(rest.substr(0, end)), "\n  ", "\n    "));
    if (end != std::string::npos)
        out += fmt::format("\n{}\n", replaced(trimmed_end(rest.substr(end + 2)), "<", "&lt;"));
    return out;
}

} // namespace

std::string markdown_page(const Command& command, const std::vector<Command>& commands)
{
    std::string out = fmt::format("# burnish {}\n\n{}.\n\n", command.name, markdown_cell(command.summary));
    out += fmt::format("    burnish {} {}\n", command.name, replaced(usage_of(command.options), "[OPTIONS]", "[options]"));
    return out + markdown_options(command, commands) + markdown_footer(command.footer);
}

std::string man_page(const std::vector<Command>& commands)
{
    std::string out = fmt::format(".TH BURNISH 1 \"\" \"burnish {}\" \"User Commands\"\n.ad l\n", version());
    out += ".SH NAME\nburnish \\- renders anisotropic materials on the CPU\n.SH SYNOPSIS\n";
    for (const Command& command : commands)
        out += fmt::format(".B burnish {}\n{}\n.br\n", roff(command.name),
                           roff(replaced(usage_of(command.options), "[OPTIONS]", "[options]")));
    out += ".SH DESCRIPTION\nA tile\\-based, SIMD, multithreaded rasterizer that takes glTF 2.0 scenes and HDR environments and writes "
           "linear EXR and display\\-ready PNG.\n";
    for (const Command& command : commands) {
        out += fmt::format(".SH burnish {}\n{}\n", roff(command.name), roff(command.summary + "."));
        std::string heading;
        for (const Option& option : command.options.options()) {
            if (option.group != heading && !option.group.empty())
                out += fmt::format(".SS {}\n", roff(option.group));
            heading = option.group;
            out += roff_option(option);
        }
        if (!command.footer.empty())
            out += ".PP\n.nf\n" + roff(command.footer) + "\n.fi\n";
    }
    return out;
}

std::string bash_completion(const std::vector<Command>& commands)
{
    std::string values, plain;
    for (const Command& command : commands) {
        std::string places, words;
        for (const Option& option : command.options.options()) {
            if (option.positional()) {
                words += words_of(option) + " ";
                places = takes_path(option) ? " files=1" : places;
            } else if (option.takes_value()) {
                const std::string pattern = fmt::format("\"{} {}\"", command.name, option.name) +
                                            (option.letter ? fmt::format("|\"{} -{}\"", command.name, option.letter) : "");
                values += fmt::format("    {}) words={}{} ;;\n", pattern, quoted(words_of(option)), takes_path(option) ? " files=1" : "");
            }
        }
        plain += fmt::format("        {}) words={}{} ;;\n", command.name, quoted(words + names_of(command)), places);
    }
    return fmt::format(R"(# Completion of burnish in bash.
# Names such as builtin:teapot are one word.
COMP_WORDBREAKS=${{COMP_WORDBREAKS//:}}
_burnish()
{{
    local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} words= files=
    if [ "$COMP_CWORD" = 1 ]; then
        words={}
    else
        case "${{COMP_WORDS[1]}} $prev" in
{}        *)
            case "${{COMP_WORDS[1]}}" in
{}            help) words={} ;;
            esac ;;
        esac
    fi
    COMPREPLY=($(compgen -W "$words" -- "$cur"))
    if [ -n "$files" ]; then COMPREPLY+=($(compgen -f -- "$cur")); fi
}}
complete -o filenames -F _burnish burnish
)",
                       quoted(subcommands(commands) + " --help --version"), values, plain, quoted(subcommands(commands)));
}

std::string zsh_completion(const std::vector<Command>& commands)
{
    std::string names, cases;
    for (const Command& command : commands) {
        names += fmt::format("    {}\n", quoted(zsh_text(command.name) + ":" + command.summary));
        cases += fmt::format(
            "    {})\n      _arguments '(-h --help)'{{-h,--help}}'[Print the help and exit]' '--version[Print the version and exit]'",
            command.name);
        for (const Option& option : command.options.options())
            cases += " \\\n        " + zsh_option(option);
        cases += " ;;\n";
    }
    return fmt::format(R"(#compdef burnish
# Completion of burnish in zsh.
_burnish() {{
  local curcontext="$curcontext" state line
  local -a commands=(
{}    'help:Print the help of a subcommand'
  )
  _arguments -C '1:subcommand:->command' '*::argument:->arguments'
  case $state in
  command) _describe subcommand commands ;;
  arguments)
    case $words[1] in
{}    help) _describe subcommand commands ;;
    esac ;;
  esac
}}
_burnish "$@"
)",
                       names, cases);
}

std::string fish_completion(const std::vector<Command>& commands)
{
    std::string out = "# Completion of burnish in fish.\ncomplete -c burnish -f\n";
    for (const Command& command : commands) {
        out += fmt::format("complete -c burnish -n __fish_use_subcommand -a {} -d {}\n", command.name, quoted(command.summary));
        const std::string when = fmt::format("complete -c burnish -n '__fish_seen_subcommand_from {}'", command.name);
        for (const Option& option : command.options.options()) {
            const std::string words = words_of(option), files = takes_path(option) ? " -F" : "";
            if (option.positional()) {
                out += when + files + (words.empty() ? "" : " -a " + quoted(words)) + "\n";
                continue;
            }
            out += when + " -l " + option.name.substr(2) + (option.letter ? fmt::format(" -s {}", option.letter) : "");
            if (option.takes_value())
                out += " -r" + files + (words.empty() ? "" : " -a " + quoted(words));
            out += " -d " + quoted(option.help_text()) + "\n";
        }
    }
    return out;
}

} // namespace burnish
