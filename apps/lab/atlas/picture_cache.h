// Renders the atlas's pictures and caches their shared inputs.
#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "apps/lab/atlas/entries.h"
#include "apps/render/cached_reference.h"
#include "raster/session/session.h"

namespace burnish {

struct Picture {
    Image color;               // linear, or 8-bit as displayed
    std::vector<bool> covered; // pixels that show the scene; empty for path-traced pictures
};
// Makes the picture in the setting's format. Frames of the tile renderer have triangle ids.
Picture picture_of(const AtlasSetting& setting, Frame frame);

struct ReferencePicture {
    Picture picture;
    double noise = 0.0; // estimated mean HDR-FLIP caused by its own noise; 0 for the tile renderer
    Image variance;     // of a path-traced picture's pixel means
};

class PictureCache {
  public:
    struct Machine {
        std::shared_ptr<const Jobs> jobs;
        Isa isa;
        ReferenceCache home;
        const std::atomic<bool>* stop; // ends references early
    };
    PictureCache(Machine machine, Report& report) : machine_(std::move(machine)), report_(report) {}

    // Renders by the tile renderer, with triangle ids, and with parts if pictures are compared as displayed.
    Result<Frame> draw(const AtlasSetting& setting);
    // Renders in double precision: raster/tile/twins.h. Returns none if the program has no such lanes.
    Result<std::optional<Frame>> draw_in_double(const AtlasSetting& setting);
    // Returns the picture to compare with, by the path tracer or the tile renderer. Null if the machine's `stop` ended the path tracer.
    Result<std::shared_ptr<const ReferencePicture>> reference(const AtlasSetting& setting);

    const Jobs& jobs() const { return *machine_.jobs; }
    Isa isa() const { return machine_.isa; }

  private:
    Result<const SessionParts*> parts_of(const AtlasSetting& setting);
    Result<Session*> session_of(const AtlasSetting& setting);
    Result<Session*> reference_session(const AtlasSetting& setting, const ReferenceOptions& options);
    Result<FrameDesc> desc_of(const AtlasSetting& setting);

    Machine machine_;
    Report& report_;
    // Caches by the key of their inputs. A full one is cleared.
    std::map<std::string, std::shared_ptr<const SceneData>> scenes_;
    std::map<std::string, std::shared_ptr<const Environment>> environments_;
    std::map<std::string, SessionParts> parts_;
    std::map<std::string, Session> sessions_, reference_sessions_;
    std::map<std::uint64_t, std::shared_ptr<const ReferencePicture>> reference_pictures_;
};

} // namespace burnish
