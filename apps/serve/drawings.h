// Draws the pictures that pages ask for. Sessions and pictures of the last requests are cached.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "apps/render/picture.h"
#include "apps/render/rows.h"
#include "apps/serve/request.h"

namespace burnish {

struct Drawn {
    RenderOptions options;
    Rendered rendered;
    std::vector<std::string> warnings;
    View view;
    glm::dvec3 origin{0.0}, centre{0.0}; // of the view's places, and of the scene's box; world space, metres
    float radius = 1.0f;                 // of the scene's box, metres
    std::vector<std::string> files{};    // that the scene and its environment were read from
    std::shared_ptr<const Jobs> jobs{};
};

// Returns the picture as the page shows it: 8 bits, or false colours.
Image shown_picture(const Drawn& drawn);

class Drawings {
  public:
    Drawings(const Limits& limits, int threads) : limits_(limits), threads_(threads) {}

    struct Call {
        bool passing = false;       // left out where a later passing request waits
        std::function<bool()> gone; // true once nobody waits for the picture
    };
    // Draws, or returns a cached picture. Any thread may call it; one tile picture and one reference are drawn at a time. A picture stops
    // where nobody waits, a reference where another request comes, and a passing picture where another passing request comes: an error of
    // ExitCode::differ. Other errors are `burnish render`'s.
    Result<std::shared_ptr<const Drawn>> draw(const DrawRequest& request, const Call& call);

    // Draws the rows between two shares of the picture's height, in [0, 1]. Keeps the session, not the rows. Bands with shared ends make
    // the picture. Cannot be stopped. Errors: draw()'s, and ExitCode::usage at FrameDesc::window for a picture that is drawn as a
    // whole.
    Result<DrawnBand> draw_part(const DrawRequest& request, double from, double to);
    // Joins bands from top to bottom. Keeps the picture as draw() does. ms: time of the picture. Errors: ExitCode::usage for bands that do
    // not fill the picture.
    Result<std::shared_ptr<const Drawn>> join(const DrawRequest& request, std::vector<DrawnBand> bands, double ms);
    bool keeps(const DrawRequest& request); // the picture is at hand

    // Forgets everything if a file that was read has changed since. Returns how often that happened.
    std::uint64_t look_for_changes();
    void stop(); // ends all pictures; later ones stop at once

  private:
    struct Prepared {
        std::string key;
        std::shared_ptr<Session> session;
        RenderFigures figures;
        std::vector<std::string> warnings;
    };
    struct Running {
        std::stop_source stop;
        bool reference, passing;
    };
    using Time = std::filesystem::file_time_type;
    Result<Prepared> prepared(const DrawRequest& request, const RenderOptions& options);
    // A request with its session, ready to draw.
    struct Opened {
        RenderOptions options;
        Prepared made;
        FrameDesc desc;
    };
    Result<Opened> open(const DrawRequest& request);
    std::shared_ptr<const Drawn> drawn_of(Opened opened, Rendered rendered) const;
    void keep(const DrawRequest& request, const std::shared_ptr<const Drawn>& drawn);
    Result<std::shared_ptr<const Drawn>> draw_now(const DrawRequest& request, const std::stop_token& stop);
    void note_file(const std::string& path, Time time);
    void stop_older(bool passing);

    Limits limits_;
    int threads_ = 0;
    std::stop_source end_;
    std::mutex tile_, reference_, cache_;
    std::atomic<std::uint64_t> latest_ = 0; // of passing requests
    // Under cache_:
    std::list<Prepared> sessions_;                                             // the latest first
    std::list<std::pair<DrawRequest, std::shared_ptr<const Drawn>>> pictures_; // the latest first
    std::vector<std::pair<std::string, Time>> files_;                          // that sessions were made from
    std::list<Running*> running_;                                              // waiting, or drawn now
    std::uint64_t changes_ = 0;
    bool ending_ = false;
};

} // namespace burnish
