#include "apps/golden/manifest.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "apps/cli/command_line.h"
#include "apps/cli/report.h"
#include "apps/compare/picture_names.h"
#include "apps/options/options.h"
#include "apps/report/json.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/text.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;
using JsonValue = nlohmann::ordered_json;

constexpr std::uint64_t kMostManifestBytes = 64ull << 20;
constexpr std::size_t kMostName = 150; // bytes
constexpr double kMostSeconds = 86400.0;

// A mistake, thrown within this file alone.
struct Mistake {
    std::string place, reason;
};

const JsonValue* member(const JsonValue& of, const char* name)
{
    const auto at = of.find(name);
    return at == of.end() ? nullptr : &*at;
}

void check_members(const JsonValue& of, const std::string& place, const std::set<std::string>& known)
{
    if (!of.is_object())
        throw Mistake{place, "is no object"};
    for (const auto& [name, value] : of.items())
        if (!known.contains(name))
            throw Mistake{place + "/" + name, "is unknown; known are " + join({known.begin(), known.end()})};
}

std::string text_of(const JsonValue& of, const char* name, const std::string& place, const std::string& fallback)
{
    const JsonValue* value = member(of, name);
    if (value && !value->is_string())
        throw Mistake{place + "/" + name, "is no text"};
    const std::string text = value ? value->get<std::string>() : fallback;
    if (text.find('\0') != std::string::npos)
        throw Mistake{place + "/" + name, "holds a zero byte"};
    return text;
}

std::vector<std::string> words_of(const JsonValue& of, const char* name, const std::string& place)
{
    std::vector<std::string> words;
    const JsonValue* value = member(of, name);
    if (value && !value->is_array())
        throw Mistake{place + "/" + name, "is no list of words"};
    for (std::size_t i = 0; value && i < value->size(); ++i) {
        if (!(*value)[i].is_string() || (*value)[i].get<std::string>().find('\0') != std::string::npos)
            throw Mistake{fmt::format("{}/{}/{}", place, name, i), "is no text"};
        words.push_back((*value)[i].get<std::string>());
    }
    return words;
}

std::optional<double> number_of(const JsonValue& of, const char* name, const std::string& place, double most)
{
    const JsonValue* value = member(of, name);
    if (!value)
        return std::nullopt;
    if (!value->is_number() || !(value->get<double>() >= 0.0 && value->get<double>() <= most))
        throw Mistake{place + "/" + name, fmt::format("is no number from 0 to {:g}", most)};
    return value->get<double>();
}

void read_limits(const JsonValue& of, const std::string& place, GoldenLimits& to)
{
    const JsonValue* hold = member(of, "hold");
    if (!hold)
        return;
    check_members(*hold, place + "/hold", {"flip", "flip_p99", "pattern", "z", "operations"});
    to = {number_of(*hold, "flip", place + "/hold", 1.0), number_of(*hold, "flip_p99", place + "/hold", 1.0),
          number_of(*hold, "pattern", place + "/hold", 100.0), number_of(*hold, "z", place + "/hold", 1.0),
          number_of(*hold, "operations", place + "/hold", 1e18)};
}

void read_environment(const JsonValue& of, const std::string& place, std::map<std::string, std::string>& to)
{
    const JsonValue* variables = member(of, "environment");
    if (!variables)
        return;
    if (!variables->is_object())
        throw Mistake{place + "/environment", "is no object"};
    for (const auto& [name, value] : variables->items()) {
        if (name.empty() || name.find('=') != std::string::npos || name.find('\0') != std::string::npos)
            throw Mistake{place + "/environment/" + name, "is no name of a variable"};
        to[name] = text_of(*variables, name.c_str(), place + "/environment", "");
    }
}

// Members that rows take over unless they have their own.
struct Defaults {
    std::vector<std::string> options;
    std::string goldens = "goldens", format = "png";
    GoldenRow row;
};

// Reads the members that both a row and the defaults may have.
void read_common(const JsonValue& of, const std::string& place, std::string& format, GoldenRow& to)
{
    read_limits(of, place, to.limits);
    read_environment(of, place, to.environment);
    to.seconds = number_of(of, "seconds", place, kMostSeconds).value_or(to.seconds);
    to.mask = text_of(of, "mask", place, to.mask);
    format = text_of(of, "format", place, format);
    static const std::set<std::string> formats = {"png", "exr", "hdr", "pfm", "tif", "jpg"};
    if (!formats.contains(format))
        throw Mistake{place + "/format", "is none of " + join({formats.begin(), formats.end()})};
    if (const std::string keep = text_of(of, "keep", place, to.hash_alone ? "hash" : "picture"); keep == "hash" || keep == "picture")
        to.hash_alone = keep == "hash";
    else
        throw Mistake{place + "/keep", "is neither picture nor hash"};
}

void check_name(const std::string& name, const std::string& place, std::set<std::string>& taken)
{
    if (name.empty() || name.size() > kMostName)
        throw Mistake{place + "/name", fmt::format("has {} bytes; 1 to {} are allowed", name.size(), kMostName)};
    if (printable(name) != name)
        throw Mistake{place + "/name", "holds characters that do not print"};
    if (!taken.insert(name).second)
        throw Mistake{place + "/name", "'" + name + "' is the name of an earlier row"};
}

// Refuses options of a scene that write files besides the picture, or print in place of drawing.
void check_options(const std::vector<std::string>& defaults, const std::vector<std::string>& own, const std::string& place)
{
    RenderArguments arguments;
    const OptionTable table = render_option_table(arguments);
    std::vector<std::string> words = defaults;
    words.insert(words.end(), own.begin(), own.end());
    const std::size_t at = find_output_or_help(table, words);
    if (at < words.size())
        throw Mistake{at < defaults.size() ? fmt::format("/defaults/options/{}", at)
                                           : fmt::format("{}/options/{}", place, at - defaults.size()),
                      "'" + words[at] + "' writes or prints something else than the row's picture"};
}

GoldenRow read_row(const JsonValue& of, const std::string& place, const Defaults& defaults, std::set<std::string>& taken)
{
    check_members(of, place,
                  {"name", "scene", "options", "command", "picture", "golden", "hold", "environment", "seconds", "mask", "format", "keep"});
    GoldenRow row = defaults.row;
    row.name = text_of(of, "name", place, "");
    check_name(row.name, place, taken);
    std::string format = defaults.format;
    read_common(of, place, format, row);
    // Tell the three kinds apart
    const std::string scene = text_of(of, "scene", place, "");
    const std::vector<std::string> options = words_of(of, "options", place);
    row.command = words_of(of, "command", place), row.picture = text_of(of, "picture", place, "");
    if (!scene.empty()) {
        if (!row.command.empty() || !row.picture.empty())
            throw Mistake{place, "has a scene, and a command or a picture too"};
        if (scene[0] == '-')
            throw Mistake{place + "/scene", "begins like an option; a file is named ./" + scene};
        check_options(defaults.options, options, place);
        row.kind = GoldenKind::scene;
        row.command = {"render", scene};
        row.command.insert(row.command.end(), defaults.options.begin(), defaults.options.end());
        row.command.insert(row.command.end(), options.begin(), options.end());
        row.extension = "." + format;
    } else {
        if (!options.empty())
            throw Mistake{place + "/options", "belong to a scene"};
        if (row.picture.empty())
            throw Mistake{place, row.command.empty() ? "needs a scene, a command with its picture, or a picture"
                                                     : "needs the picture that its command writes"};
        if (of.contains("command") && row.command.empty())
            throw Mistake{place + "/command", "has no word"};
        row.kind = row.command.empty() ? GoldenKind::picture : GoldenKind::command;
        row.extension = fs::path(row.picture).extension().string();
    }
    if (row.limits.operations && row.kind != GoldenKind::scene)
        throw Mistake{place + "/hold/operations", "belong to a scene that burnish draws"};
    if (row.hash_alone && !row.limits.exact())
        throw Mistake{place + "/hold", "needs the golden picture, and this row keeps its hash alone"};
    if (row.hash_alone && !row.mask.empty())
        throw Mistake{place + "/mask", "needs the golden picture, and this row keeps its hash alone"};
    const fs::path standard = fs::path(defaults.goldens) / (file_stem(row.name) + (row.hash_alone ? ".hash" : row.extension));
    row.golden = text_of(of, "golden", place, standard.string());
    if (fs::path(row.golden).lexically_normal() == fs::path(row.picture).lexically_normal())
        throw Mistake{place + "/golden", "is the picture itself"};
    return row;
}

GoldenManifest manifest_of(const JsonValue& json, const std::string& folder)
{
    check_members(json, "", {"$schema", "goldens", "defaults", "rows"});
    Defaults defaults;
    defaults.goldens = text_of(json, "goldens", "", defaults.goldens);
    if (const JsonValue* given = member(json, "defaults")) {
        check_members(*given, "/defaults", {"options", "hold", "environment", "seconds", "mask", "format", "keep"});
        defaults.options = words_of(*given, "options", "/defaults");
        read_common(*given, "/defaults", defaults.format, defaults.row);
    }
    const JsonValue* rows = member(json, "rows");
    if (!rows || !rows->is_array())
        throw Mistake{"/rows", "is no list of rows"};
    if (rows->empty())
        throw Mistake{"/rows", "is empty: it needs a row"};
    GoldenManifest manifest;
    manifest.folder = folder;
    std::set<std::string> taken, goldens, written;
    for (std::size_t i = 0; i < rows->size(); ++i) {
        const std::string place = fmt::format("/rows/{}", i);
        const GoldenRow& row = manifest.rows.emplace_back(read_row((*rows)[i], place, defaults, taken));
        if (!goldens.insert(fs::path(row.golden).lexically_normal().string()).second)
            throw Mistake{place + "/golden", "is an earlier row's golden too"};
        if (row.kind == GoldenKind::command && !written.insert(fs::path(row.picture).lexically_normal().string()).second)
            throw Mistake{place + "/picture", "is written by an earlier row too"};
    }
    return manifest;
}

// Hears a parser's events, and refuses an object with two members of one name.
class DuplicateMembers {
  public:
    void hear(JsonValue::parse_event_t event, const JsonValue& parsed)
    {
        using Event = JsonValue::parse_event_t;
        switch (event) {
        case Event::object_start:
        case Event::array_start:
            next_element();
            levels_.push_back({event == Event::array_start, 0, "", {}});
            break;
        case Event::object_end:
        case Event::array_end:
            levels_.pop_back();
            break;
        case Event::value:
            next_element();
            break;
        case Event::key:
            levels_.back().at = parsed.get<std::string>();
            if (!levels_.back().names.insert(levels_.back().at).second)
                throw Mistake{place(), "is there twice"};
            break;
        }
    }

  private:
    struct Level {
        bool is_array = false;
        std::size_t next = 0; // index of an array's next element
        std::string at;       // name or index of the last member
        std::set<std::string> names;
    };

  public:
    // Returns the JSON path of the last member.
    std::string place() const
    {
        std::string text;
        for (const Level& level : levels_)
            text += "/" + level.at;
        return text;
    }

  private:
    void next_element()
    {
        if (!levels_.empty() && levels_.back().is_array)
            levels_.back().at = std::to_string(levels_.back().next++);
    }

    std::vector<Level> levels_;
};

// Returns the mask for a picture: the file itself, or the file in the folder with the picture's name, else as PNG. Empty: none.
std::string mask_of(const std::string& mask, const fs::path& picture)
{
    std::error_code ignored;
    if (mask.empty() || !fs::is_directory(mask, ignored))
        return mask;
    for (const fs::path& name : {picture, fs::path(picture).replace_extension(".png")})
        if (fs::exists(mask / name, ignored))
            return (mask / name).string();
    return "";
}

// Returns "line 3, column 7" of a byte.
std::string line_and_column(const std::vector<std::uint8_t>& text, std::size_t byte)
{
    std::size_t line = 1, column = 1;
    for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i)
        text[i] == '\n' ? (++line, column = 1) : ++column;
    return fmt::format("line {}, column {}", line, column);
}

} // namespace

std::string file_stem(const std::string& name)
{
    std::string stem;
    for (const char c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
                           (c == '.' && !stem.empty());
        stem += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    constexpr std::size_t kMostStem = 150, kKept = 120; // bytes; a name of a file has 255 at most
    if (stem.size() > kMostStem)
        stem = fmt::format("{}%~{:016x}", stem.substr(0, kKept), hash_bytes(name.data(), name.size()));
    return stem;
}

std::string manifest_hash(const GoldenManifest& manifest)
{
    Json rows = Json::array();
    for (const GoldenRow& row : manifest.rows) {
        Json limits = Json::array();
        for (const std::optional<double>& limit :
             {row.limits.flip, row.limits.flip_p99, row.limits.pattern, row.limits.z, row.limits.operations})
            limits.push_back(limit ? Json(*limit) : Json());
        rows.push_back({{"name", row.name},
                        {"kind", static_cast<int>(row.kind)},
                        {"command", row.command},
                        {"environment", row.environment},
                        {"picture", row.picture},
                        {"extension", row.extension},
                        {"golden", row.golden},
                        {"mask", row.mask},
                        {"seconds", row.seconds},
                        {"hash_alone", row.hash_alone},
                        {"limits", limits}});
    }
    const std::string text = json_text(rows, -1);
    return fmt::format("{:016x}", hash_bytes(text.data(), text.size()));
}

Result<GoldenManifest> read_manifest(const std::string& path)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMostManifestBytes);
    BN_TRY(bytes);
    JsonValue json;
    DuplicateMembers members;
    try {
        const auto hear = [&members](int, JsonValue::parse_event_t event, const JsonValue& parsed) {
            members.hear(event, parsed);
            return true;
        };
        json = JsonValue::parse(bytes->begin(), bytes->end(), hear);
    } catch (const JsonValue::parse_error& e) {
        return Error{ExitCode::bad_input, path, line_and_column(*bytes, e.byte), "is no JSON here; JSON has no comments"};
    } catch (const JsonValue::out_of_range&) {
        return Error{ExitCode::bad_input, path, members.place(), "holds a number that no double can hold"};
    } catch (const Mistake& mistake) {
        return Error{ExitCode::bad_input, path, mistake.place, mistake.reason};
    }
    try {
        const std::string folder = fs::path(path).parent_path().string();
        return manifest_of(json, folder.empty() ? "." : folder);
    } catch (const Mistake& mistake) {
        return Error{ExitCode::bad_input, path, mistake.place, mistake.reason};
    }
}

Result<GoldenManifest> manifest_of_pairs(const std::string& expected, const std::string& actual, const GoldenLimits& limits,
                                         const std::string& mask)
{
    std::error_code ignored;
    const auto is_pattern = [&](const std::string& path) {
        return path.find('*') != std::string::npos && !fs::is_directory(path, ignored);
    };
    const bool by_pattern = is_pattern(expected) || is_pattern(actual);
    const Result<std::vector<std::string>> names = by_pattern ? covered_parts(expected, actual) : picture_names(expected, actual);
    BN_TRY(names);
    GoldenManifest manifest;
    manifest.folder = ".";
    for (const std::string& name : *names) {
        const auto path_of = [&](const std::string& given) {
            return by_pattern ? with_part(given, name) : (fs::path(given) / name).string();
        };
        GoldenRow row;
        row.picture = path_of(actual), row.golden = path_of(expected), row.limits = limits;
        const fs::path relative = by_pattern ? fs::path(row.golden).filename() : fs::path(name);
        row.name = printable(relative.string()), row.extension = fs::path(row.picture).extension().string();
        row.mask = mask_of(mask, relative);
        if (fs::path(row.golden).lexically_normal() == fs::path(row.picture).lexically_normal() ||
            fs::equivalent(row.golden, row.picture, ignored))
            return Error{ExitCode::usage, "", "PATH", "'" + row.picture + "' is expected and actual"};
        manifest.rows.push_back(std::move(row));
    }
    if (!mask.empty() && std::all_of(manifest.rows.begin(), manifest.rows.end(), [](const GoldenRow& row) { return row.mask.empty(); }))
        return Error{ExitCode::bad_input, mask, "", "holds no mask with the name of an expected picture"};
    return manifest;
}

} // namespace burnish
