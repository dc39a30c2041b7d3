// Answers the questions of `burnish serve`'s page, whichever way they come.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/serve/http.h"
#include "apps/serve/request.h"
#include "core/image/io/image_io.h"

namespace burnish {

inline constexpr const char* kPictureHeader = "X-Burnish"; // JSON about the picture in the body

struct ServeSetting {
    std::string target;        // file, folder or builtin:NAME
    std::string output_folder; // where pages may save pictures; empty: nowhere
    int port = 0;              // 0: any that is free
    bool watch = false;        // draw again where a file changes
    Limits limits;
    std::vector<std::string> limit_words; // options of the limits that were given, for the commands that pages show
    int threads = 0;
    Result<std::string> (*encode)(const Image&, const Jobs*) = encode_png; // of 8-bit pictures for the page
    const char* picture_type = "image/png";
};

// GET /lists, /changes. POST /draw, /difference, /save with JSON. Any thread may ask.
class Pages {
  public:
    Pages(const ServeSetting& setting, ServedLists lists); // keeps a reference to the setting
    ~Pages();
    // Status 400: the body says the error; 404; 409: another picture was asked for meanwhile.
    void answer(const HttpRequest& request, HttpResponse& response);
    // For several renderers that draw one picture. draw_part answers {picture, from, to}, two shares of the height in [0, 1], with a header
    // about the rows and their pixels: floats, then 8 bits. join answers {picture, bands, ms}, headers of bands from top to bottom, as POST
    // /draw does; pixels: the pixels of all bands. Status 409 of draw_part: the picture is drawn as a whole.
    void draw_part(const HttpRequest& request, HttpResponse& response);
    void kept(const HttpRequest& request, HttpResponse& response); // status 200 if POST /draw has the picture at hand, else 404
    void join(const HttpRequest& request, std::span<const std::uint8_t> pixels, HttpResponse& response);
    void stop(); // ends all pictures; later ones stop at once

  private:
    class Answers;
    std::unique_ptr<Answers> answers_;
};

} // namespace burnish
