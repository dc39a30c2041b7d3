#include "apps/serve/request.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "core/scene/builtin/builtin.h"
#include "raster/frame/upload.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr int kMostSide = 4096, kMostReferenceSamples = 1 << 16;
constexpr const char* kKinds[] = {"flag",   "count", "integer", "number", "bytes", "size",
                                  "vector", "name",  "names",   "text",   "file",  "folder"};

bool ends_in(const fs::path& path, std::initializer_list<const char*> extensions)
{
    const std::string own = extension_of(path.string());
    return std::any_of(extensions.begin(), extensions.end(), [&](const char* e) { return own == e; });
}

// Appends the models and environments below a folder, by name.
void add_files(std::vector<fs::path> found, const fs::path& folder, ServedLists& lists)
{
    std::sort(found.begin(), found.end());
    for (const fs::path& path : found) {
        const ServedFile file{path.lexically_relative(folder).string(), path.string()};
        if (ends_in(path, {"gltf", "glb", "obj"}) && lists.scenes.size() < kMostServed)
            lists.scenes.push_back(file);
        if (ends_in(path, {"hdr", "exr", "pfm"}) && lists.environments.size() < kMostServed)
            lists.environments.push_back(file);
    }
}

// Returns the files that an iterator over a folder finds. An entry that vanishes meanwhile ends the search.
template <class Iterator> std::vector<fs::path> files_of(Iterator at, std::error_code& failed)
{
    std::vector<fs::path> found;
    std::error_code ignored;
    for (; !failed && at != Iterator(); at.increment(failed))
        if (at->is_regular_file(ignored) && ends_in(at->path(), {"gltf", "glb", "obj", "hdr", "exr", "pfm"}))
            found.push_back(at->path());
    return found;
}

// Returns true if brackets nest deeper than `most`. Brackets in texts count too.
bool nests_deeper(const std::string& text, int most)
{
    int depth = 0;
    for (const char c : text) {
        depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
        if (depth > most)
            return true;
    }
    return false;
}

const ServedFile* find_served(const std::vector<ServedFile>& files, const std::string& name)
{
    const auto found = std::find_if(files.begin(), files.end(), [&](const ServedFile& f) { return f.name == name; });
    return found == files.end() ? nullptr : &*found;
}

std::string quoted(const std::string& word)
{
    const bool plain = !word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:,=+") ==
                                            std::string::npos;
    if (plain)
        return word;
    std::string out = "'";
    for (const char c : word)
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

Result<int> whole_of(const Json& json, const char* name, int fallback, int low, int high)
{
    const auto found = json.find(name);
    if (found == json.end())
        return fallback;
    if (!found->is_number_integer() || found->get<std::int64_t>() < low || found->get<std::int64_t>() > high)
        return usage_error(name, fmt::format("is no whole number from {} to {}", low, high));
    return found->get<int>();
}

std::string text_of(const Json& json, const char* name)
{
    const auto found = json.find(name);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

bool of_references(const std::string& option)
{
    return option == "--reference-mode" || option == "--bounces" || option == "--reference-textures";
}

// Returns the options without those that the request's kind sets or ignores.
std::vector<std::pair<std::string, std::string>> drawn_options(const DrawRequest& request)
{
    std::vector<std::pair<std::string, std::string>> options;
    for (const auto& option : request.options) {
        const bool of_tiles = option.first == "--msaa" || option.first == "--technique" || option.first == "--samples";
        if (request.reference_samples > 0 ? !of_tiles
                                          : !of_references(option.first) && !(request.reduction > 1 && option.first == "--msaa"))
            options.push_back(option);
    }
    if (request.reduction > 1 && request.reference_samples == 0)
        options.emplace_back("--msaa", "1");
    return options;
}

} // namespace

Result<ServedLists> served_lists(const std::string& target)
{
    ServedLists lists;
    std::error_code failed;
    const bool builtin = target.rfind("builtin:", 0) == 0;
    if (fs::is_directory(target, failed)) {
        fs::recursive_directory_iterator at(target, fs::directory_options::skip_permission_denied, failed);
        if (failed)
            return Error{ExitCode::bad_input, target, "", failed.message()};
        add_files(files_of(std::move(at), failed), target, lists);
    } else if (!target.empty() && !builtin) {
        const fs::path path(target);
        if (!fs::is_regular_file(path, failed))
            return Error{ExitCode::bad_input, target, "", "is neither a file nor a folder"};
        if (!ends_in(path, {"gltf", "glb", "obj"}))
            return Error{ExitCode::bad_input, target, "", "is no .gltf, .glb or .obj file"};
        const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
        ServedLists beside;
        add_files(files_of(fs::directory_iterator(folder, failed), failed), folder, beside);
        lists.scenes.push_back({path.filename().string(), target});
        lists.environments = std::move(beside.environments);
    } else if (builtin) { // parametric scenes too
        BN_TRY(make_builtin_scene(target.substr(8)));
        lists.scenes.push_back({target, target});
    }
    for (const BuiltinInfo& scene : builtin_scenes())
        if (const std::string name = std::string("builtin:") + scene.name; name != target)
            lists.scenes.push_back({name, name});
    for (const BuiltinInfo& environment : builtin_environments())
        lists.environments.push_back({std::string("builtin:") + environment.name, std::string("builtin:") + environment.name});
    return lists;
}

Result<Json> request_json(const std::string& text)
{
    constexpr int kMostDepth = 8;
    if (nests_deeper(text, kMostDepth))
        return usage_error("request", "nests too deeply");
    Json json = Json::parse(text, nullptr, false);
    return json.is_discarded() ? Result<Json>(usage_error("request", "is no JSON")) : Result<Json>(std::move(json));
}

// Returns the words of area lights, which ';' separates. Blanks around them and empty ones do not count.
std::vector<std::string> lights_of(const std::string& text)
{
    constexpr const char* kBlanks = " \t\r\n";
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(';', begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        if (const std::size_t first = part.find_first_not_of(kBlanks); first != std::string::npos)
            words.push_back(part.substr(first, part.find_last_not_of(kBlanks) + 1 - first));
        begin = end + 1;
    }
    return words;
}

Result<DrawRequest> draw_request_of(const Json& json, const ServedLists& lists)
{
    if (!json.is_object())
        return usage_error("request", "is no object");
    DrawRequest request;
    const ServedFile* scene = find_served(lists.scenes, text_of(json, "scene"));
    if (!scene)
        return usage_error("scene", "is none of those served");
    request.scene = scene->path;
    if (const std::string name = text_of(json, "environment"); !name.empty()) {
        const ServedFile* environment = find_served(lists.environments, name);
        if (!environment)
            return usage_error("environment", "is none of those served");
        request.environment = environment->path;
    }
    RenderArguments arguments;
    const OptionTable table = render_option_table(arguments);
    if (const auto options = json.find("options"); options != json.end() && options->is_object())
        for (const auto& item : options->items()) {
            const std::string& name = item.key();
            const Json& value = item.value();
            const auto known =
                std::find_if(table.options().begin(), table.options().end(), [&](const Option& o) { return o.name == name; });
            if (known == table.options().end() || !is_served(*known) || !value.is_string())
                return usage_error(name, "cannot be set by a page");
            if (name == "--light" && value.get<std::string>().find("texture=") != std::string::npos)
                return usage_error(name, "texture= names a file, which a page cannot do");
            for (std::string& word : name == "--light" ? lights_of(value.get<std::string>()) : std::vector{value.get<std::string>()})
                request.options.emplace_back(name, std::move(word));
        }
    for (const auto& [name, to, low, high] : {std::tuple{"width", &request.width, 1, kMostSide},
                                              {"height", &request.height, 1, kMostSide},
                                              {"reduction", &request.reduction, 1, 8},
                                              {"reference_samples", &request.reference_samples, 0, kMostReferenceSamples}}) {
        const Result<int> number = whole_of(json, name, *to, low, high);
        BN_TRY(number);
        *to = *number;
    }
    if (request.width < 1 || request.height < 1)
        return usage_error("width", "and height are missing");
    if ((request.reduction & (request.reduction - 1)) != 0)
        return usage_error("reduction", "is none of 1, 2, 4 and 8");
    return request;
}

bool is_served(const Option& option)
{
    const ValueKind kind = option.value.kind;
    const bool plain = kind == ValueKind::flag || kind == ValueKind::integer || kind == ValueKind::number || kind == ValueKind::vector ||
                       kind == ValueKind::name || option.name == "--camera" || option.name == "--light" || option.name == "--variant";
    const bool group = option.group == "Environment" || option.group == "Picture" || option.group == "Materials" ||
                       option.group == "Parameters of techniques";
    const bool output = option.name == "--exposure" || option.name == "--tonemap" || option.name == "--resolve" ||
                        option.name == "--show" || option.name == "--shadows" || option.name == "--shadow-samples" ||
                        of_references(option.name);
    return plain && (group || output) && option.name != "--no-cache";
}

Json served_options(const OptionTable& table)
{
    Json rows = Json::array();
    for (const Option& option : table.options())
        if (is_served(option)) {
            Json row = {{"name", option.name},
                        {"group", option.group},
                        {"help", option.name == "--light"
                                     ? "Area lights, with ; between, such as sphere:points=0,1,0:radius=0.1:radiance=9,9,9"
                                     : option.meaning()},
                        {"kind", kKinds[static_cast<std::size_t>(option.value.kind)]},
                        {"value", option.value_name},
                        {"names", option.value.names},
                        {"initial", option.default_text()}};
            if (option.value.kind == ValueKind::integer || option.value.kind == ValueKind::number)
                row["low"] = option.value.low, row["high"] = option.value.high;
            rows.push_back(std::move(row));
        }
    return rows;
}

Result<RenderOptions> render_options_of(const DrawRequest& request, const Limits& limits, int threads, RenderArguments& arguments)
{
    arguments.plain.limits = limits;
    OptionTable table = render_option_table(arguments);
    const auto set = [&table](const std::string& name, const std::string& text) { return table.set(name, text); };
    BN_TRY(set("SCENE", request.scene));
    if (!request.environment.empty())
        BN_TRY(set("--env", request.environment));
    BN_TRY(set("--size",
               fmt::format("{}x{}", std::max(1, request.width / request.reduction), std::max(1, request.height / request.reduction))));
    std::map<std::string, std::vector<std::string>> given;
    for (const auto& [name, text] : drawn_options(request))
        given[name].push_back(text);
    for (const auto& [name, texts] : given)
        BN_TRY(table.set_all(name, texts));
    if (request.reference_samples > 0) {
        BN_TRY(set("--backend", "reference"));
        BN_TRY(set("--samples", std::to_string(request.reference_samples)));
    }
    if (threads > 0)
        BN_TRY(set("--threads", std::to_string(threads)));
    Result<RenderOptions> options = check_render_options(arguments, table);
    BN_TRY(options);
    options->quiet = true;
    options->mips.frames_override = sets_materials(options->frame);
    return options;
}

std::string command_of(const DrawRequest& request, const std::vector<std::string>& further)
{
    std::string text = "burnish render " + quoted(request.scene);
    if (!request.environment.empty())
        text += " --env " + quoted(request.environment);
    text += fmt::format(" --size {}x{}", std::max(1, request.width / request.reduction), std::max(1, request.height / request.reduction));
    for (const auto& [name, value] : drawn_options(request))
        text += " " + name + (value.empty() ? "" : " " + quoted(value));
    if (request.reference_samples > 0)
        text += fmt::format(" --backend reference --samples {}", request.reference_samples);
    for (const std::string& word : further)
        text += " " + quoted(word);
    return text + " -o picture.png";
}

std::string session_key(const DrawRequest& request, const RenderOptions& options)
{
    RenderArguments arguments;
    const OptionTable table = render_option_table(arguments);
    Json key = {request.scene, request.environment, request.reference_samples > 0, options.mips.frames_override};
    for (const Option& option : table.options()) {
        const bool prepared = changes_scene(option) || option.group == "Environment" || option.name == "--floor" ||
                              option.name == "--light" || option.name == "--brdf" || option.name == "--no-background" ||
                              option.name == "--shadows"; // floors and warnings follow these
        for (const auto& [name, value] : request.options)
            if (name == option.name && prepared)
                key.push_back(name + "=" + value);
    }
    return json_text(key, -1);
}

} // namespace burnish
