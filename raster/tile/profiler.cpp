#include "raster/tile/profiler.h"

#include <atomic>

namespace burnish {
namespace {

constexpr std::size_t index_of(FrameStage stage)
{
    return static_cast<std::size_t>(stage);
}

void add(LaneUse& to, const LaneUse& more)
{
    to.used += more.used, to.all += more.all;
}

} // namespace

Profiler::Profiler(int threads, std::size_t materials, int lanes)
    : began_(Trace::now_ns()), lanes_(static_cast<std::uint32_t>(lanes)), workers_(static_cast<std::size_t>(threads))
{
    for (Worker& w : workers_) {
        w.TileClock::lap = tile_lap;
        w.materials.resize(materials);
    }
}

void Profiler::set_tiles(std::size_t count)
{
    tile_ns_.assign(count, 0);
}

// Returns the time since the last note. The time appears in traces too.
std::uint64_t Profiler::Worker::note(FrameStage stage)
{
    const std::uint64_t now = Trace::now_ns(), ns = now - last;
    Trace::span(kFrameStageNames[index_of(stage)], last, now);
    stage_ns[index_of(stage)] += ns;
    last = now;
    return ns;
}

void Profiler::begin(int worker)
{
    Worker& w = workers_[static_cast<std::size_t>(worker)];
    w.began = w.last = Trace::now_ns();
}

void Profiler::lap(int worker, FrameStage stage)
{
    workers_[static_cast<std::size_t>(worker)].note(stage);
}

void Profiler::count(int worker, FrameStage stage, std::uint64_t used)
{
    Worker& w = workers_[static_cast<std::size_t>(worker)];
    add(w.stage_lanes[index_of(stage)], {used, (used + lanes_ - 1) / lanes_ * lanes_});
}

void Profiler::tile_lap(TileClock& self, FrameStage stage, std::int32_t material, std::uint32_t used, std::uint32_t all)
{
    Worker& w = static_cast<Worker&>(self);
    const std::uint64_t ns = w.note(stage);
    add(w.stage_lanes[index_of(stage)], {used, all});
    if (material < 0)
        return;
    KernelProfile& kernel = w.materials[static_cast<std::size_t>(material)];
    kernel.ns += ns;
    add(kernel.lanes, {used, all});
}

void Profiler::end(int worker)
{
    Worker& w = workers_[static_cast<std::size_t>(worker)];
    w.busy += Trace::now_ns() - w.began;
}

void Profiler::end_tile(int worker, std::size_t tile)
{
    const Worker& w = workers_[static_cast<std::size_t>(worker)];
    std::atomic_ref(tile_ns_[tile]).fetch_add(w.last - w.began, std::memory_order_relaxed); // threads may share a tile
}

FrameProfile Profiler::sum() const
{
    FrameProfile p;
    p.wall_ns = Trace::now_ns() - began_;
    p.tile_ns = tile_ns_;
    p.materials.resize(workers_[0].materials.size());
    for (const Worker& w : workers_) {
        p.busy_ns.push_back(w.busy);
        for (std::size_t i = 0; i < kFrameStages; ++i) {
            p.stage_ns[i] += w.stage_ns[i];
            add(p.stage_lanes[i], w.stage_lanes[i]);
        }
        for (std::size_t i = 0; i < w.materials.size(); ++i) {
            p.materials[i].ns += w.materials[i].ns;
            add(p.materials[i].lanes, w.materials[i].lanes);
        }
    }
    return p;
}

} // namespace burnish
