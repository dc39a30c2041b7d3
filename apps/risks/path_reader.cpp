#include "apps/risks/path_reader.h"

#include <algorithm>
#include <fmt/core.h>

#include "apps/cli/command_line.h"
#include "apps/options/animate.h"

namespace burnish {
namespace {

Result<std::vector<OptionPath>> paths_of(const PicturePath& of, OptionTable& table) // tries both ends on `table`
{
    if (of.path.empty())
        return std::vector<OptionPath>();
    Result<std::vector<OptionPath>> paths = parse_option_paths("path", of.path, table);
    if (paths)
        for (OptionPath& path : *paths)
            path.geometric = of.geometric;
    return paths;
}

} // namespace

PathReader::PathReader() : command_{"render", "", render_option_table(arguments_), "", {}} {}

Result<PicturePlace> PathReader::read(const PicturePath& of, double s)
{
    const auto wrong = [&](Error error) {
        error.place = error.place.empty() ? of.name : fmt::format("{}: {}", of.name, error.place);
        return error;
    };
    const Result<std::vector<OptionPath>> paths = paths_of(of, command_.options);
    if (!paths)
        return wrong(paths.error());
    PicturePlace out;
    arguments_ = {};
    if (const Status read = read_command_line(command_, of.words); !read)
        return wrong(read.error());
    for (const OptionPath& path : *paths) {
        const std::string value = value_at(path, s);
        out.values += fmt::format("{}{} {}", out.values.empty() ? "" : ", ", path.option.substr(2), value);
        if (std::find(of.fixed.begin(), of.fixed.end(), path.option) != of.fixed.end())
            continue;
        if (const Status set = command_.options.set(path.option, value); !set)
            return wrong(set.error());
    }
    const Result<RenderOptions> options = check_render_options(arguments_, command_.options);
    if (!options)
        return wrong(options.error());
    out.options = *options;
    return out;
}

} // namespace burnish
