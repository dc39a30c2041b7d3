#include "apps/live/live.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/core.h>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/cli/command_line.h"
#include "apps/cli/report.h"
#include "apps/live/assets.h"
#include "apps/live/page_files.h"
#include "apps/render/stats.h"
#include "apps/report/html.h"
#include "apps/report/json.h"
#include "apps/serve/assets.h"
#include "apps/serve/drawings.h"
#include "core/base/check.h"
#include "core/base/file.h"
#include "core/base/version.h"
#include "core/image/io/image_io.h"
#include "core/image/io/inflate.h"
#include "core/image/io/jpeg_watch.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostRendererBytes = 64 << 20;

std::string packed(const std::uint8_t* bytes, std::size_t size)
{
    const std::vector<std::uint8_t> out = deflated(bytes, size);
    return base64({out.begin(), out.end()});
}

struct PageRenderer {
    std::vector<std::uint8_t> script, module;
};

// Finds the renderer for pages: in the folder, or beside the program as it is installed or built.
Result<PageRenderer> find_renderer(const std::string& folder)
{
    std::error_code ignored;
    const fs::path self = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    std::vector<fs::path> places = {self / "../share/burnish/wasm", self / "../wasm/package", self / "tests/cross/wasm/package"};
    if (!folder.empty())
        places = {folder};
    for (const fs::path& place : places) {
        if (!fs::exists(place / "burnish_core.wasm", ignored))
            continue;
        Result<std::vector<std::uint8_t>> script = read_file((place / "burnish_core.mjs").string(), kMostRendererBytes);
        Result<std::vector<std::uint8_t>> module = read_file((place / "burnish_core.wasm").string(), kMostRendererBytes);
        Result<std::vector<std::uint8_t>> package = read_file((place / "package.json").string(), kMostRendererBytes);
        BN_TRY(script);
        BN_TRY(module);
        BN_TRY(package);
        const auto json = nlohmann::json::parse(package->begin(), package->end(), nullptr, false);
        if (!json.is_object() || json.value("version", "") != version())
            return Error{ExitCode::bad_input, place.string(), "package.json", std::string("is not of version ") + version()};
        return PageRenderer{std::move(*script), std::move(*module)};
    }
    return Error{ExitCode::unavailable, folder, "",
                 "there is no renderer for pages: make it with `cmake --preset wasm && cmake --build --preset wasm`"};
}

// Returns the text of the page's worker.
Result<std::string> worker_text(const PageRenderer& renderer)
{
    std::string text(renderer.script.begin(), renderer.script.end());
    const std::string exported = "export default Module;";
    const std::size_t at = text.rfind(exported);
    if (at == std::string::npos)
        return Error{ExitCode::bad_input, "burnish_core.mjs", "", "exports no Module"};
    text.erase(at, exported.size());
    text.append(kLiveWorker.bytes, kLiveWorker.size);
    if (text.find("</script") != std::string::npos)
        return Error{ExitCode::internal, "burnish_core.mjs", "", "holds the end of a script"};
    return text;
}

// Replaces the only `what` in the text.
void replace(std::string& text, const std::string& what, const std::string& with)
{
    const std::size_t at = text.find(what);
    BN_CHECK(at != std::string::npos && text.find(what, at + 1) == std::string::npos);
    text.replace(at, what.size(), with);
}

// Returns a name for a quoted attribute, byte by byte.
std::string attribute(const std::string& name)
{
    std::string out;
    for (const char c : name)
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
    return out;
}

// Returns the options as a page's state holds them.
Json options_json(const DrawRequest& request)
{
    Json options = Json::object();
    for (const auto& [name, value] : request.options)
        options[name] = name == "--light" && options.contains(name) ? options[name].get<std::string>() + ";" + value : value;
    return options;
}

// Names scenes and environments within the page, and collects their files.
class Names {
  public:
    Names(const LiveWish& wish) : limits_(wish.limits)
    {
        for (const LiveRow& row : wish.rows)
            folders_.emplace(row.request.scene, folders_.size());
        const auto file = [](const std::string& name) { return !name.empty() && name.rfind("builtin:", 0) != 0; };
        const DrawRequest& first = wish.rows.front().request;
        alone_ = folders_.size() == 1 && (file(first.scene) || std::none_of(wish.rows.begin(), wish.rows.end(), [&](const LiveRow& row) {
                                              return file(row.request.environment);
                                          }));
    }

    // Returns the names of the request's scene and environment. read: their files.
    Result<std::pair<std::string, std::string>> of(const DrawRequest& request, const std::vector<std::string>& read)
    {
        const auto found = named_.find({request.scene, request.environment});
        if (found != named_.end())
            return found->second;
        Result<PageFiles> files = page_files(request.scene, request.environment, read, limits_);
        BN_TRY(files);
        const std::string folder = alone_ ? "" : fmt::format("{}/", folders_[request.scene]), root = alone_ ? "" : "scenes/";
        std::string environment = files->environment;
        for (PageFile& file : files->files) {
            const bool light = file.name == files->environment;
            std::string name = root + folder + file.name;
            for (int number = 1; light && files_.contains(name) && files_[name] != file.bytes; ++number) { // another light of this name
                environment = fmt::format("{}-{}", number, files->environment);
                name = root + folder + environment;
            }
            files_.insert_or_assign(std::move(name), std::move(file.bytes));
        }
        target_ = alone_ ? files->scene : files_.empty() ? "" : "scenes";
        const auto within = [&](const std::string& name) { return name.empty() || name.rfind("builtin:", 0) == 0 ? name : folder + name; };
        return named_[{request.scene, request.environment}] = {within(files->scene), within(environment)};
    }

    std::map<std::string, std::vector<std::uint8_t>>& files() { return files_; }
    const std::string& target() const { return target_; } // the scene, or folder of scenes, that the page's renderer serves

  private:
    using Pair = std::pair<std::string, std::string>; // scene and environment
    const Limits& limits_;
    std::map<std::string, std::size_t> folders_; // by scene
    std::map<Pair, Pair> named_;
    std::map<std::string, std::vector<std::uint8_t>> files_; // by name in the page
    std::string target_;
    bool alone_ = false; // one scene: the page serves its file, else a folder of scenes
};

} // namespace

void add_served(const OptionTable& given, DrawRequest& to)
{
    RenderArguments arguments;
    const OptionTable render = render_option_table(arguments);
    const auto served = [&](const std::string& name) { // other tables have other groups
        return std::any_of(render.options().begin(), render.options().end(),
                           [&](const Option& o) { return o.name == name && is_served(o); });
    };
    for (const Option& option : given.options())
        if (option.given && served(option.name))
            for (const std::string& text : option.value.repeated ? option.texts : std::vector{option.texts.back()})
                to.options.emplace_back(option.name, text);
}

std::optional<DrawRequest> live_request(const OptionTable& given)
{
    DrawRequest request;
    request.width = 1280, request.height = 720; // as `burnish render` has them
    for (const Option& option : given.options()) {
        if (!option.given || is_served(option) || option.group == "Machine" || option.name == "--no-cache")
            continue;
        const std::string value = option.texts.back();
        if (option.name == "SCENE")
            request.scene = value;
        else if (option.name == "--env")
            request.environment = value;
        else if (option.name == "--size") {
            const std::size_t cross = value.find('x');
            request.width = std::stoi(value), request.height = std::stoi(value.substr(cross + 1));
        } else if (option.name != "--quiet" && option.name != "--verbose" && option.name != "--output")
            return std::nullopt;
    }
    add_served(given, request);
    return request;
}

Result<std::optional<DrawRequest>> live_request(const std::vector<std::string>& words)
{
    RenderArguments arguments;
    Command render{"render", "", render_option_table(arguments), "", {}};
    BN_TRY(read_command_line(render, words));
    return live_request(render.options);
}

namespace {

// Returns an error for a picture that pages do not draw.
Status check_picture(const DrawRequest& request)
{
    constexpr int kMostSide = 4096;
    constexpr std::int64_t kMostSamples = 1 << 25; // of memory with 32 bits
    std::int64_t msaa = 8;
    for (const auto& [name, value] : request.options)
        if (name == "--msaa")
            msaa = std::atoi(value.c_str());
        else if (name == "--light" && value.find("texture=") != std::string::npos)
            return usage_error(name, "texture= names a file, which a page cannot read");
    if (request.width > kMostSide || request.height > kMostSide)
        return usage_error("--size", fmt::format("pages draw at most {} pixels along a side", kMostSide));
    if (msaa * request.width * request.height > kMostSamples)
        return usage_error("--size", fmt::format("pages draw at most {} samples: width x height x --msaa", kMostSamples));
    return {};
}

// Draws a row, and adds it to the page.
Status add_row(const std::string& key, const DrawRequest& request, Drawings& drawings, Names& names, Json& rows, LiveParts& out)
{
    BN_TRY(check_picture(request));
    const Result<std::shared_ptr<const Drawn>> drawn = drawings.draw(request, {});
    BN_TRY(drawn);
    const auto named = names.of(request, (*drawn)->files);
    BN_TRY(named);
    Result<std::string> picture = out.picture.empty() ? encode_png(shown_picture(**drawn)) : Result<std::string>(std::string());
    BN_TRY(picture);
    if (out.picture.empty())
        out.picture = std::move(*picture), out.hash = (*drawn)->rendered.figures.hash;
    for (const std::string& warning : (*drawn)->warnings)
        if (std::find(out.warnings.begin(), out.warnings.end(), warning) == out.warnings.end())
            out.warnings.push_back(warning);
    rows[key] = {{"scene", named->first},         {"environment", named->second}, {"options", options_json(request)},
                 {"width", request.width},        {"height", request.height},     {"hash", hash_text((*drawn)->rendered.figures.hash)},
                 {"command", command_of(request)}};
    return {};
}

} // namespace

Status check_renderer(const std::string& folder)
{
    const Result<PageRenderer> renderer = find_renderer(folder);
    return renderer ? Status() : Status(renderer.error());
}

Result<LiveParts> live_parts(const LiveWish& wish)
{
    const Result<PageRenderer> renderer = find_renderer(wish.renderer_folder);
    BN_TRY(renderer);
    const Result<std::string> worker = worker_text(*renderer);
    BN_TRY(worker);
    LiveParts out;
    if (wish.rows.empty())
        return out;
    const JpegWatch watch;
    Drawings drawings(wish.limits, wish.threads);
    Names names(wish);
    Json rows = Json::object();
    for (const auto& [key, request] : wish.rows)
        if (const Status added = add_row(key, request, drawings, names, rows, out); !added)
            out.left_out.emplace_back(key, added.error());
    if (rows.empty())
        return out;
    for (const auto& [hash, image] : watch.images()) {
        const Result<std::string> png = encode_png(image);
        BN_TRY(png);
        names.files()[fmt::format("decoded/{:016x}.png", hash)] = {png->begin(), png->end()};
    }
    const Json page = {{"version", version()}, {"target", names.target()}, {"rows", rows}};
    out.html = fmt::format("<script type=\"application/json\" id=\"burnish-page\">{}</script>\n", script_json(page));
    for (const auto& [name, bytes] : names.files())
        out.html += fmt::format("<script type=\"text/plain\" class=\"burnish-file\" data-name=\"{}\">{}</script>\n", attribute(name),
                                packed(bytes.data(), bytes.size()));
    out.html += fmt::format("<script type=\"text/plain\" id=\"burnish-wasm\">{}</script>\n",
                            packed(renderer->module.data(), renderer->module.size()));
    out.html += fmt::format("<script type=\"text/plain\" id=\"burnish-studio\">{}</script>\n",
                            packed(reinterpret_cast<const std::uint8_t*>(kServePage.bytes), kServePage.size));
    out.html += fmt::format("<script type=\"text/plain\" id=\"burnish-worker\">\n{}</script>\n<script>\n", *worker);
    out.html.append(kLiveScript.bytes, kLiveScript.size);
    out.html += "</script>\n";
    return out;
}

Result<LiveParts> live_page(const LiveWish& wish)
{
    Result<LiveParts> parts = live_parts(wish);
    BN_TRY(parts);
    if (!parts->left_out.empty())
        return parts->left_out.front().second;
    std::string text(kServePage.bytes, kServePage.size);
    replace(text, "<script>\n'use strict';\n", parts->html + "<script>\n'use strict';\n");
    replace(text, "<img id=\"a\"", fmt::format("<img id=\"a\" src=\"data:image/png;base64,{}\"", base64(parts->picture)));
    parts->html = std::move(text);
    return parts;
}

} // namespace burnish
