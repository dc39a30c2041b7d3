// A chart while it is measured: its places, each with a reference and rows.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "apps/chart/chart_checkpoint.h"
#include "apps/chart/cpu_load.h"
#include "apps/chart/options.h"
#include "apps/cli/build.h"
#include "apps/cli/report.h"
#include "apps/cli/stop_signal.h"
#include "apps/options/scene_with_view.h"
#include "apps/pieces/packed.h"
#include "apps/pieces/pieces.h"
#include "apps/render/stats.h"
#include "core/jobs/jobs.h"
#include "raster/session/session.h"

namespace burnish {

class Chart {
  public:
    Chart(const ChartOptions& options, std::shared_ptr<const Jobs> jobs, ChartCheckpoint& checkpoint, Report& report)
        : options_(options), jobs_(jobs), checkpoint_(&checkpoint), report_(report), stop_(watch_stop_signals()),
          settings_(settings_of(options.techniques, options.sweeps.samples))
    {
    }
    Status load_all();
    Status measure(); // returns early, without an error, after a signal
    Result<std::vector<JobPiece>> pieces();
    Status take(const std::vector<std::string>& files, const std::vector<JobPiece>& pieces); // into the checkpoint
    bool stopped() const { return stop_.load(); }
    ChartReport take();

  private:
    struct Place { // rows of one place are compared with each other
        const SceneWithView& scene;
        Session& tile;
        FrameDesc desc; // for the compared pictures, without technique and samples
        std::string env;
        Cell cell;
        bool fixes_area_lights; // the user or a sweep chooses their method
        std::uint64_t key = 0;  // hash of scene, environment, view and overrides
    };
    struct Spot { // a place by numbers
        std::size_t scene, environment, cell;
    };
    std::vector<Spot> spots() const;
    Status at_place(const Spot& spot, const std::function<Status(const Place&)>& use);
    Status measure_place(const Place& place);
    Result<std::vector<Setting>> planned_settings(const Place& place);
    std::string reference_name(const Place& place) const;
    std::string reference_picture(const Place& place) const;
    std::string key_of_piece(const Place& place) const;
    Result<double> seconds_of_piece(const Spot& spot);
    Status write_piece_of(const Spot& spot, const std::string& file, const std::string& key);
    Status take_piece(const Place& place, const Packed& packed, const std::string& file);
    Result<Frame> render_reference(const Place& place, ReferenceNoise& noise);
    Status find_errors(const Place& place, const Frame& reference, ChartRow& row);
    Status time_rows(const Place& place, std::vector<ChartRow>& rows);
    Status write_small(const std::string& file, const Image& linear, bool errors);
    ChartRow new_row(const Place& place, const Setting& setting) const;
    FrameDesc desc_of(const Place& place, const Setting& setting) const;
    FrameDesc timed_desc_of(const Place& place, const Setting& setting) const;

    const ChartOptions& options_;
    std::shared_ptr<const Jobs> jobs_;
    ChartCheckpoint* checkpoint_; // of the chart, or of the piece that is made
    Report& report_;
    const std::atomic<bool>& stop_;
    std::vector<Setting> settings_;
    std::vector<SceneWithView> scenes_;
    std::vector<std::shared_ptr<const Environment>> environments_;
    std::uint64_t program_ = program_hash(); // ignores rows of other builds: their kernels may differ
    int picture_width_ = 0;
    std::optional<Session> tile_; // of the pair of scene and environment that was last needed
    std::pair<std::size_t, std::size_t> pair_ = {};
    std::set<std::string> machines_; // of pieces
    std::unique_ptr<Progress> progress_;
    CpuLoadMeter load_; // while frames are timed
    ChartReport out_;
};

} // namespace burnish
