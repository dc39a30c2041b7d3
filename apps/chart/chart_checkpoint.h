// REPORT_DIR while a chart is made: rows.json with the measurements so far, and the pictures.
#pragma once
#include <chrono>
#include <set>
#include <string>

#include "apps/chart/rows.h"
#include "apps/cli/report.h"

namespace burnish {

class ChartCheckpoint {
  public:
    // Makes the folder if needed and reads the rows of an earlier run. Reports an unreadable rows.json and starts anew.
    static Result<ChartCheckpoint> open(const std::string& folder, Report& report);

    Measured& row(const std::string& key) { return results_.rows[key]; }
    std::map<std::string, ReferenceNoise>& references() { return results_.references; }
    std::optional<double>& others() { return results_.others; }
    Status save();           // at once
    Status save_sometimes(); // if the last save is some time ago
    std::string picture(const std::string& name) const { return folder_ + "/pictures/" + name + ".jpg"; }
    std::string file(const std::string& name) const { return folder_ + "/" + name; }
    // Removes charts and pictures of earlier reports that are not among `used` (full paths). Leaves files with other names alone.
    void remove_stale(const std::set<std::string>& used) const;

  private:
    using Clock = std::chrono::steady_clock;

    std::string folder_;
    ChartResults results_;
    Clock::time_point saved_ = Clock::now();
};

} // namespace burnish
