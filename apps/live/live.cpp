#include "apps/live/live.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <map>
#include <nlohmann/json.hpp>

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

// Replaces the one place where `what` stands.
void replace(std::string& text, const std::string& what, const std::string& with)
{
    const std::size_t at = text.find(what);
    BN_CHECK(at != std::string::npos && text.find(what, at + 1) == std::string::npos);
    text.replace(at, what.size(), with);
}

// Returns the options as a page's state holds them.
Json options_json(const DrawRequest& request)
{
    Json options = Json::object();
    for (const auto& [name, value] : request.options)
        options[name] = options.contains(name) ? options[name].get<std::string>() + ";" + value : value; // several lights
    return options;
}

// Names scenes and environments within the page, and collects their files.
class Names {
  public:
    Names(const LiveWish& wish) : limits_(wish.limits)
    {
        for (const LiveRow& row : wish.rows)
            folders_.emplace(row.request.scene, folders_.size());
    }

    // Returns the names of the request's scene and environment. read: their files.
    Result<std::pair<std::string, std::string>> of(const DrawRequest& request, const std::vector<std::string>& read)
    {
        const auto found = named_.find({request.scene, request.environment});
        if (found != named_.end())
            return found->second;
        Result<PageFiles> files = page_files(request.scene, request.environment, read, limits_);
        BN_TRY(files);
        const bool alone = folders_.size() == 1;
        const std::string folder = alone ? "" : fmt::format("{}/", folders_[request.scene]), root = alone ? "" : "scenes/";
        std::string environment = files->environment;
        for (PageFile& file : files->files) {
            const bool light = file.name == files->environment, decoded = file.name.rfind("decoded/", 0) == 0;
            std::string name = decoded ? file.name : root + folder + file.name;
            for (int number = 1; light && files_.contains(name) && files_[name] != file.bytes; ++number) { // another light of this name
                environment = fmt::format("{}-{}", number, files->environment);
                name = root + folder + environment;
            }
            files_.insert_or_assign(std::move(name), std::move(file.bytes));
        }
        target_ = alone ? files->scene : files_.empty() ? "" : "scenes";
        const auto within = [&](const std::string& name) { return name.empty() || name.rfind("builtin:", 0) == 0 ? name : folder + name; };
        return named_[{request.scene, request.environment}] = {within(files->scene), within(environment)};
    }

    const std::map<std::string, std::vector<std::uint8_t>>& files() const { return files_; }
    const std::string& target() const { return target_; } // what the page's renderer serves

  private:
    using Pair = std::pair<std::string, std::string>; // scene and environment
    const Limits& limits_;
    std::map<std::string, std::size_t> folders_; // by scene
    std::map<Pair, Pair> named_;
    std::map<std::string, std::vector<std::uint8_t>> files_; // by name in the page
    std::string target_;
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
            to.options.emplace_back(option.name, option.takes_value() ? option.value.get() : "");
}

std::optional<DrawRequest> live_request(const OptionTable& given)
{
    DrawRequest request;
    request.width = 1280, request.height = 720; // as `burnish render` has them
    for (const Option& option : given.options()) {
        const std::string value = option.given && option.takes_value() ? option.value.get() : "";
        if (!option.given || is_served(option) || option.group == "Machine")
            continue;
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
    Drawings drawings(wish.limits, wish.threads);
    Names names(wish);
    Json rows = Json::object();
    for (const auto& [key, request] : wish.rows) {
        const Result<std::shared_ptr<const Drawn>> drawn = drawings.draw(request, {});
        BN_TRY(drawn);
        const auto named = names.of(request, (*drawn)->files);
        BN_TRY(named);
        const auto& [scene, environment] = *named;
        rows[key] = {{"scene", scene},
                     {"environment", environment},
                     {"options", options_json(request)},
                     {"width", request.width},
                     {"height", request.height},
                     {"hash", hash_text((*drawn)->rendered.figures.hash)},
                     {"command", command_of(request)}};
        if (!out.picture.empty())
            continue;
        Result<std::string> picture = encode_png(shown_picture(**drawn));
        BN_TRY(picture);
        out.picture = std::move(*picture);
    }
    const Json page = {{"version", version()}, {"target", names.target()}, {"rows", rows}};
    out.html = fmt::format("<script type=\"application/json\" id=\"burnish-page\">{}</script>\n", script_json(page));
    for (const auto& [name, bytes] : names.files())
        out.html += fmt::format("<script type=\"text/plain\" class=\"burnish-file\" data-name=\"{}\">{}</script>\n", escaped(name),
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

Result<std::string> live_page(const LiveWish& wish)
{
    Result<LiveParts> parts = live_parts(wish);
    BN_TRY(parts);
    std::string text(kServePage.bytes, kServePage.size);
    replace(text, "<script>\n'use strict';\n", parts->html + "<script>\n'use strict';\n");
    replace(text, "<img id=\"a\"", fmt::format("<img id=\"a\" src=\"data:image/png;base64,{}\"", base64(parts->picture)));
    return text;
}

} // namespace burnish
