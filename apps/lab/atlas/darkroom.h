// Draws the pictures of the atlas, and keeps what several of them are drawn of.
#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "apps/chart/reference.h"
#include "apps/risks/entries.h"
#include "raster/session/session.h"

namespace burnish {

struct Picture {
    Image color;               // linear, or as it is displayed: 8 bits
    std::vector<bool> covered; // pixels that show a part of the scene; empty of references
};
// As the setting says; the frame has triangle ids, of tile renderers.
Picture picture_of(const AtlasSetting& setting, Frame frame);

struct Truth {
    Picture picture;
    double noise = 0.0; // mean HDR-FLIP that its own noise makes; 0 of the tile renderer's pictures
};

class Darkroom {
  public:
    struct Machine {
        std::shared_ptr<const Jobs> jobs;
        Isa isa;
        ReferenceHome home;
        const std::atomic<bool>* stop; // of references
    };
    Darkroom(Machine machine, Report& report) : machine_(std::move(machine)), report_(report) {}

    // By the tile renderer, with triangle ids, and parts where pictures are compared as displayed.
    Result<Frame> draw(const AtlasSetting& setting);
    // The same in double: raster/tile/double_renderer.h. Nothing where the program has no such lanes.
    Result<std::optional<Frame>> draw_in_double(const AtlasSetting& setting);
    // Of what the reference makes of it, or the tile renderer. Null where the machine's `stop` came first.
    Result<std::shared_ptr<const Truth>> truth(const AtlasSetting& setting);

    const Jobs& jobs() const { return *machine_.jobs; }
    Isa isa() const { return machine_.isa; }

  private:
    Result<const SessionParts*> parts_of(const AtlasSetting& setting);
    Result<Session*> session_of(const AtlasSetting& setting);
    Result<Session*> reference_of(const AtlasSetting& setting, const ReferenceOptions& options);
    Result<FrameDesc> desc_of(const AtlasSetting& setting);

    Machine machine_;
    Report& report_;
    // By what makes them; the last few.
    std::map<std::string, std::shared_ptr<const SceneData>> scenes_;
    std::map<std::string, std::shared_ptr<const Environment>> environments_;
    std::map<std::string, SessionParts> parts_;
    std::map<std::string, Session> sessions_, references_;
    std::map<std::uint64_t, std::shared_ptr<const Truth>> truths_;
};

} // namespace burnish
