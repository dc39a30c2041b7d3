// Draws the scenes of a conformance folder: as an engine does that makes no mistake, with mistakes, and by the reference.
#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/lab/conform/folder.h"
#include "apps/lab/conform/mutants.h"
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "raster/session/session.h"

namespace burnish {

// A way to draw image light without a mistake, as engines have it.
struct RightWay {
    const char *name, *words, *technique;
    int samples;
    std::uint32_t kernels; // bits of KernelMutant
    bool compensates = false;
};
const std::vector<RightWay>& right_ways(); // the default one first

class ConformDrawer {
  public:
    void set_way(const RightWay& way) { way_ = &way; } // of draw(); at first the default one

    // Needs burnish-lab's kernels with mistakes. Errors: ExitCode::unavailable without them; bad_input for the folder's files.
    static Result<ConformDrawer> open(const ConformFolder& folder, const Limits& limits, std::shared_ptr<const Jobs> jobs);

    // Draws a scene in the way set, f32 RGB, with these mistakes, by index into mutants(). Empty: no
    // mistake has anything to change in the scene.
    Result<std::optional<Image>> draw(std::size_t scene, std::span<const int> mistakes);

    // Draws a scene without a mistake by any technique of burnish, f32 RGB.
    Result<Image> by_technique(std::size_t scene, const TechniqueInfo& technique);

    struct ReferencePicture {
        Image color, variance;
    };
    // Draws a scene by the reference. samples: per pixel.
    Result<ReferencePicture> reference(std::size_t scene, std::uint64_t samples, const std::atomic<bool>* stop);

  private:
    struct Opened {
        std::shared_ptr<const SceneData> data;
        bool environment;
    };
    FrameDesc desc_of(const Scene& scene) const;
    Result<SessionParts> parts_of(std::size_t scene);
    Result<std::shared_ptr<const Environment>> sky(bool lit, const std::vector<MutantSky>& changes);

    const RightWay* way_ = &right_ways().front();
    Limits limits_;
    std::shared_ptr<const Jobs> jobs_;
    std::shared_ptr<const DfgTable> dfg_;
    Image environment_;
    std::vector<Opened> scenes_;
    std::map<std::vector<MutantSky>, std::shared_ptr<const Environment>> skies_;
    std::shared_ptr<const Environment> black_;
};

} // namespace burnish
