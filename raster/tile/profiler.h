// Times one frame. Each thread notes the ends of its stages; sum() adds the notes.
#pragma once
#include <memory>
#include <vector>

#include "core/jobs/jobs.h"
#include "raster/frame/profile.h"
#include "raster/tile/tile_types.h"

namespace burnish {

class Profiler {
  public:
    Profiler(int threads, std::size_t materials, int lanes);
    void set_tiles(std::size_t count);

    // A thread works between begin() and end(); each lap() ends a stage. count(): a kernel processed `used` items, kLanes at once.
    void begin(int worker);
    void lap(int worker, FrameStage stage);
    void count(int worker, FrameStage stage, std::uint64_t used);
    void end(int worker);
    void end_tile(int worker, std::size_t tile);
    TileClock* clock(int worker) { return &workers_[static_cast<std::size_t>(worker)]; }

    FrameProfile sum() const;

  private:
    struct alignas(64) Worker final : TileClock {
        std::uint64_t began = 0, last = 0, busy = 0;
        std::array<std::uint64_t, kFrameStages> stage_ns = {};
        std::array<LaneUse, kFrameStages> stage_lanes = {};
        std::vector<KernelProfile> materials;
        std::uint64_t note(FrameStage stage);
    };
    static void tile_lap(TileClock& self, FrameStage stage, std::int32_t material, std::uint32_t used, std::uint32_t all);

    std::uint64_t began_;
    std::uint32_t lanes_;
    std::vector<Worker> workers_;
    std::vector<std::uint64_t> tile_ns_;
};

// Notes on one piece of work, if there is a profiler.
class ProfiledWork {
  public:
    ProfiledWork(Profiler* profiler, int worker) : profiler_(profiler), worker_(worker)
    {
        if (profiler_)
            profiler_->begin(worker_);
    }
    ~ProfiledWork() { end(); }
    void end() // earlier than the scope's end
    {
        if (profiler_)
            profiler_->end(worker_);
        profiler_ = nullptr;
    }
    void lap(FrameStage stage)
    {
        if (profiler_)
            profiler_->lap(worker_, stage);
    }
    void count(FrameStage stage, std::uint64_t used)
    {
        if (profiler_)
            profiler_->count(worker_, stage, used);
    }
    ProfiledWork(const ProfiledWork&) = delete;
    ProfiledWork& operator=(const ProfiledWork&) = delete;

  private:
    Profiler* profiler_;
    int worker_;
};

} // namespace burnish
