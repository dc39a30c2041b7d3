// How busy other programs keep the machine.
#pragma once
#include <optional>
#include <string>
#include <utility>

namespace burnish {

// Ticks that all cores have been busy, and all ticks, of the text of /proc/stat (proc(5)); none where it says nothing of the kind.
std::optional<std::pair<double, double>> ticks_of(const std::string& proc_stat);

// Adds up over the times between begin() and end().
class LoadMeter {
  public:
    void begin();
    void end();
    // Mean share of the cores that other programs took, [0, 1]; none where this machine does not tell, or nothing was measured.
    std::optional<double> others() const;

  private:
    std::optional<std::pair<double, double>> from_;
    double own_from_ms_ = 0.0, busy_s_ = 0.0, all_s_ = 0.0, own_s_ = 0.0;
};

} // namespace burnish
