// What a workload runs: a scene made ready for one engine, drawn frame by frame.
#pragma once
#include <memory>

#include "bench/frame/workloads.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct SubjectOptions {
    Isa isa = Isa::scalar;
    int threads = 0;                 // of workloads that name none; 0: all cores
    bool coarse_environment = false; // a small one that is baked at once, without the cache
};

class Subject {
  public:
    virtual ~Subject() = default;
    virtual void frame() = 0;                                // draws one
    virtual double units() const = 0;                        // pixels; triangles where the scene is a number of them
    virtual const Column<std::uint32_t>& triangle_ids() = 0; // by pixel, at one sample a pixel; 0xffffffff: none
    virtual std::string pixels() const { return ""; }        // hash of the last frame, where there is a picture
    virtual std::string what() const { return ""; }          // library and version, where it is not burnish
};

// An Error with ExitCode::unavailable where the engine is not in this build.
Result<std::unique_ptr<Subject>> make_subject(const Workload& workload, const SubjectOptions& options);

// The same by rays of Embree; called by make_subject.
Result<std::unique_ptr<Subject>> make_ray_subject(const Workload& workload, const SubjectOptions& options);

} // namespace burnish
