// CPU load by other programs.
#pragma once
#include <optional>
#include <string>
#include <utility>

namespace burnish {

// Returns {busy ticks, all ticks} over all cores, from the text in /proc/stat (proc(5)), or none if the text has another format.
std::optional<std::pair<double, double>> ticks_of(const std::string& proc_stat);

// Sums the load over the times between begin() and end().
class CpuLoadMeter {
  public:
    void begin();
    void end();
    // Returns the mean share of the cores that other programs took, [0,1]. None without /proc/stat, or after too short a time.
    std::optional<double> others() const;

  private:
    std::optional<std::pair<double, double>> from_;
    double own_from_ms_ = 0.0, busy_s_ = 0.0, all_s_ = 0.0, own_s_ = 0.0;
};

} // namespace burnish
