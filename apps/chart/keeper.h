// REPORT_DIR while a chart is made: rows.json with what has been measured, and the pictures.
#pragma once
#include <chrono>
#include <set>
#include <string>

#include "apps/chart/rows.h"
#include "apps/cli/report.h"

namespace burnish {

class Keeper {
  public:
    // Makes the folder where needed and reads the rows of an earlier run; a file that holds something else is told and left behind.
    static Result<Keeper> open(const std::string& folder, Report& report);

    Measured& row(const std::string& key) { return kept_.rows[key]; }
    std::map<std::string, ReferenceNoise>& references() { return kept_.references; }
    std::optional<double>& others() { return kept_.others; }
    Status save();           // now
    Status save_sometimes(); // unless that was a moment ago
    std::string picture(const std::string& name) const { return folder_ + "/pictures/" + name + ".jpg"; }
    std::string file(const std::string& name) const { return folder_ + "/" + name; }
    // Removes charts and pictures of earlier reports that are not among `used` (whole paths), and nothing that has not their names.
    void remove_stale(const std::set<std::string>& used) const;

  private:
    using Clock = std::chrono::steady_clock;

    std::string folder_;
    Kept kept_;
    Clock::time_point saved_ = Clock::now();
};

} // namespace burnish
