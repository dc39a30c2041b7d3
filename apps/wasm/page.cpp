// Answers a page with the renderer inside, as the server answers the page of `burnish serve`.
#include <cstring>
#include <memory>

#include <emscripten/emscripten.h>

#include "apps/serve/pages.h"
#include "core/base/exception.h"

namespace burnish {
namespace {

// Encodes 8-bit colours as a BMP file: no time goes into compression, and browsers show it.
Result<std::string> encode_bmp(const Image& image, const Jobs*)
{
    constexpr std::size_t kHead = 54;
    const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t row = (3 * width + 3) / 4 * 4;
    std::string file(kHead + row * height, '\0');
    const auto word = [&](std::size_t at, std::size_t value, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; ++i)
            file[at + i] = static_cast<char>(value >> (8 * i) & 255);
    };
    file[0] = 'B', file[1] = 'M';
    word(2, file.size(), 4), word(10, kHead, 4), word(14, 40, 4), word(18, width, 4), word(22, height, 4);
    word(26, 1, 2), word(28, 24, 2), word(34, row * height, 4);
    const char* const pixels = reinterpret_cast<const char*>(image.bytes.data());
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const char* const from = pixels + ((height - 1 - y) * width + x) * channels;
            char* const to = &file[kHead + y * row + 3 * x];
            for (std::size_t c = 0; c < 3; ++c) {
                const unsigned value = static_cast<unsigned char>(from[channels < 3 ? 0 : 2 - c]);
                const unsigned alpha = channels == 4 ? static_cast<unsigned char>(from[3]) : 255; // over black, as the page's ground is
                to[c] = static_cast<char>((value * alpha + 127) / 255);
            }
        }
    return file;
}

struct Page {
    ServeSetting setting;
    std::unique_ptr<Pages> pages;
    HttpResponse response;
    std::string info;
};

Page& page()
{
    static Page* const p = new Page;
    return *p;
}

// Answers a question by `work`. Returns the answer's status.
template <class Work> int answered(const char* path, const char* body, const Work& work)
{
    Page& p = page();
    HttpRequest request;
    request.method = body ? "POST" : "GET", request.path = path, request.body = body ? body : "";
    p.response = {};
    p.info.clear();
    if (!p.pages)
        return 404;
    work(*p.pages, request, p.response);
    for (const auto& [name, value] : p.response.headers)
        if (name == kPictureHeader)
            p.info = value;
    return p.response.status;
}

} // namespace
} // namespace burnish

// Serves a file, a folder or builtin:NAME. Returns "", or the error.
extern "C" EMSCRIPTEN_KEEPALIVE const char* burnish_page_open(const char* target)
{
    using namespace burnish;
    Page& p = page();
    p.pages.reset();
    try {
        p.setting.target = target, p.setting.threads = 1;
        p.setting.encode = encode_bmp, p.setting.picture_type = "image/bmp";
        Result<ServedLists> lists = served_lists(p.setting.target);
        if (!lists)
            return (p.info = lists.error().line()).c_str();
        p.pages = std::make_unique<Pages>(p.setting, std::move(*lists));
        return "";
    } catch (...) {
        p.info = error_of_exception(Error{ExitCode::internal, "", "", "a fault of burnish"}).line();
        return p.info.c_str();
    }
}

// Answers a question, or draws a part of a picture at /part, or looks for one at /kept. Returns the answer's status. burnish_page_body,
// _size and _info then hold the answer until the next question.
extern "C" EMSCRIPTEN_KEEPALIVE int burnish_page_ask(const char* path, const char* body)
{
    const bool part = std::strcmp(path, "/part") == 0, kept = std::strcmp(path, "/kept") == 0;
    return burnish::answered(path, body, [&](burnish::Pages& pages, const burnish::HttpRequest& request, burnish::HttpResponse& response) {
        part ? pages.draw_part(request, response) : kept ? pages.kept(request, response) : pages.answer(request, response);
    });
}

// Joins bands that other workers drew (Pages::join). Returns the answer's status.
extern "C" EMSCRIPTEN_KEEPALIVE int burnish_page_join(const char* body, const std::uint8_t* pixels, std::size_t size)
{
    return burnish::answered("/join", body,
                             [&](burnish::Pages& pages, const burnish::HttpRequest& request, burnish::HttpResponse& response) {
                                 pages.join(request, {pixels, size}, response);
                             });
}

extern "C" EMSCRIPTEN_KEEPALIVE const char* burnish_page_body()
{
    return burnish::page().response.body.data();
}

extern "C" EMSCRIPTEN_KEEPALIVE std::size_t burnish_page_size()
{
    return burnish::page().response.body.size();
}

extern "C" EMSCRIPTEN_KEEPALIVE const char* burnish_page_info()
{
    return burnish::page().info.c_str();
}
