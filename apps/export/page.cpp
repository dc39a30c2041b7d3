#include "apps/export/page.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/export/assets.h"
#include "apps/export/page_files.h"
#include "apps/render/stats.h"
#include "apps/report/html.h"
#include "apps/report/json.h"
#include "apps/serve/assets.h"
#include "apps/serve/drawings.h"
#include "core/base/check.h"
#include "core/base/file.h"
#include "core/base/version.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostRendererBytes = 64 << 20;

std::string base64(const std::uint8_t* bytes, std::size_t size)
{
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((size + 2) / 3 * 4);
    for (std::size_t i = 0; i < size; i += 3) {
        const unsigned rest = static_cast<unsigned>(std::min<std::size_t>(3, size - i));
        const unsigned group = bytes[i] << 16 | (rest > 1 ? bytes[i + 1] << 8 : 0) | (rest > 2 ? bytes[i + 2] : 0);
        for (unsigned digit = 0; digit < 4; ++digit)
            out += digit <= rest ? kDigits[group >> (18 - 6 * digit) & 63] : '=';
    }
    return out;
}

Result<std::string> packed(const std::vector<std::uint8_t>& bytes)
{
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::vector<std::uint8_t> out(size);
    if (compress2(out.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION) != Z_OK)
        return Error{ExitCode::bad_input, "", "", "no memory to pack a page"};
    return base64(out.data(), size);
}

struct PageRenderer {
    std::vector<std::uint8_t> script, module;
};

// Finds the renderer for pages: in the folder, or beside the program as it is installed or built.
Result<PageRenderer> find_renderer(const std::string& folder)
{
    std::error_code ignored;
    const fs::path self = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    std::vector<fs::path> places = {self / "../share/burnish/wasm", self / "../wasm/apps/wasm", self / "wasm/apps/wasm"};
    if (!folder.empty())
        places = {folder};
    for (const fs::path& place : places) {
        if (!fs::exists(place / "burnish_core.wasm", ignored))
            continue;
        Result<std::vector<std::uint8_t>> script = read_file((place / "burnish_core.mjs").string(), kMostRendererBytes);
        Result<std::vector<std::uint8_t>> module = read_file((place / "burnish_core.wasm").string(), kMostRendererBytes);
        BN_TRY(script);
        BN_TRY(module);
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
        return Error{ExitCode::bad_input, "burnish_core.mjs", "", "exports no Module: it is of another version"};
    text.erase(at, exported.size());
    text.append(kPageWorker.bytes, kPageWorker.size);
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

std::string json_in_page(std::string json)
{
    for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;)
        json.replace(at, 1, "\\u003c");
    return json;
}

// Returns the options as a page's state holds them.
Json options_json(const DrawRequest& request)
{
    Json options = Json::object();
    for (const auto& [name, value] : request.options) {
        std::string text = value;
        if (options.contains(name)) // lights
            text = options[name].get<std::string>() + ";" + text;
        options[name] = text;
    }
    return options;
}

} // namespace

Result<std::string> page_text(const PageWish& wish)
{
    const Result<PageRenderer> renderer = find_renderer(wish.renderer_folder);
    BN_TRY(renderer);
    const Result<std::string> worker = worker_text(*renderer);
    BN_TRY(worker);
    Drawings drawings(wish.limits, wish.threads);
    const Result<std::shared_ptr<const Drawn>> drawn = drawings.draw(wish.request, {});
    BN_TRY(drawn);
    const Result<PageFiles> files = page_files(wish.request.scene, wish.request.environment, (*drawn)->files, wish.limits);
    BN_TRY(files);
    const Result<std::string> picture = encode_png(shown_picture(**drawn));
    BN_TRY(picture);
    const Json request = {{"scene", fs::path(files->scene).filename().string()}, {"environment", files->environment},
                          {"options", options_json(wish.request)}, {"width", wish.request.width},
                          {"height", wish.request.height}, {"reduction", 1}};
    const Json page = {{"version", version()},
                       {"target", files->scene},
                       {"environment", files->environment},
                       {"options", options_json(wish.request)},
                       {"made",
                        {{"request", request},
                         {"hash", hash_text((*drawn)->rendered.figures.hash)},
                         {"command", command_of(wish.request)}}}};
    std::string parts = fmt::format("<script type=\"application/json\" id=\"burnish-page\">{}</script>\n", json_in_page(json_text(page, -1)));
    for (const PageFile& file : files->files) {
        const Result<std::string> bytes = packed(file.bytes);
        BN_TRY(bytes);
        parts += fmt::format("<script type=\"text/plain\" class=\"burnish-file\" data-name=\"{}\">{}</script>\n", escaped(file.name), *bytes);
    }
    const Result<std::string> module = packed(renderer->module);
    BN_TRY(module);
    parts += fmt::format("<script type=\"text/plain\" id=\"burnish-wasm\">{}</script>\n", *module);
    parts += fmt::format("<script type=\"text/plain\" id=\"burnish-worker\">\n{}</script>\n<script>\n", *worker);
    parts.append(kPageLive.bytes, kPageLive.size);
    parts += "</script>\n<script>\n'use strict';\n";
    std::string text(kServePage.bytes, kServePage.size);
    replace(text, "<script>\n'use strict';\n", parts);
    replace(text, "<img id=\"a\"",
            fmt::format("<img id=\"a\" src=\"data:image/png;base64,{}\"",
                        base64(reinterpret_cast<const std::uint8_t*>(picture->data()), picture->size())));
    return text;
}

} // namespace burnish
