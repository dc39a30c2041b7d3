// The subject of a workload: a scene prepared for one engine, drawn frame by frame.
#pragma once
#include <memory>

#include "bench/frame/workloads.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct SubjectOptions {
    Isa isa = {};
    int threads = 0;                 // for workloads without a thread count; 0: all cores
    bool coarse_environment = false; // a small environment, baked without the cache
};

class Subject {
  public:
    virtual ~Subject() = default;
    virtual void frame() = 0;                                // draws one frame
    virtual double units() const = 0;                        // pixels; triangles for scenes sized by triangles
    virtual const Column<std::uint32_t>& triangle_ids() = 0; // for each pixel, at one sample a pixel; 0xffffffff: none
    virtual std::string pixels() const { return ""; }        // hash of the last frame, where there is an image
    virtual std::string what() const { return ""; }          // library and version, unless burnish
};

// Makes a subject. Returns an Error with ExitCode::unavailable where the engine is not in this build.
Result<std::unique_ptr<Subject>> make_subject(const Workload& workload, const SubjectOptions& options);

// Makes a subject that traces rays with Embree; make_subject calls this.
Result<std::unique_ptr<Subject>> make_ray_subject(const Workload& workload, const SubjectOptions& options);

} // namespace burnish
