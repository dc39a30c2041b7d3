// Draws what pages ask for. Sessions and pictures of the last requests are kept.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "apps/render/picture.h"
#include "apps/serve/request.h"

namespace burnish {

struct Drawn {
    RenderOptions options;
    Rendered rendered;
    std::vector<std::string> warnings;
    glm::vec3 centre{0.0f}, to_eye{0, 0, 1}; // world space; to_eye is a unit vector
    float radius = 1.0f;                     // of the scene's box, metres
};

class Drawings {
  public:
    Drawings(const Limits& limits, int threads) : limits_(limits), threads_(threads) {}

    // Draws, or returns a kept picture. Any thread may call it; one tile picture and one reference are drawn at a time. A reference that is
    // being drawn stops where another request comes: an error of ExitCode::differ. Errors are those of `burnish render`.
    Result<std::shared_ptr<const Drawn>> draw(const DrawRequest& request);

    // Forgets everything if a file that was read has changed since. Returns how often that happened.
    std::uint64_t look_for_changes();
    void stop() // ends a reference; later ones stop at once
    {
        ending_ = true;
        stop_reference_ = true;
    }

  private:
    struct Prepared {
        std::string key;
        std::shared_ptr<Session> session;
        RenderFigures figures;
        std::vector<std::string> warnings;
    };
    Result<Prepared> prepared(const DrawRequest& request, const RenderOptions& options);
    Result<std::shared_ptr<const Drawn>> draw_now(const DrawRequest& request);

    Limits limits_;
    int threads_ = 0;
    std::mutex tile_, reference_, kept_;
    std::atomic<bool> stop_reference_ = false, ending_ = false;
    // Under kept_:
    std::list<Prepared> sessions_;                                               // the latest first
    std::list<std::pair<DrawRequest, std::shared_ptr<const Drawn>>> pictures_;   // the latest first
    std::vector<std::pair<std::string, std::filesystem::file_time_type>> files_; // that sessions were made from
    std::uint64_t changes_ = 0;
};

} // namespace burnish
