// Progress reports for long work: work beyond the progress interval (BURNISH_PROGRESS_SECONDS, 10) writes a line to
// stderr.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

namespace burnish {

// Possibly long work, for the object's lifetime. After a silent interval, a line names the work and its enclosing
// works: "parity, row 3 of 20, compiling shade: 20 s". On a terminal the line appears after a second and disappears
// with the work. Thread-safe. A thread ends its activities in reverse order.
class Activity {
  public:
    explicit Activity(std::string what);
    // `say` writes its own line instead of the work's name.
    Activity(std::string what, std::function<void()> say);
    ~Activity();
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;

    static void tell(bool on);          // turns lines on or off; off at first, because a library is silent
    static void restart_interval();     // another report has just appeared: restarts the interval
    static std::uint64_t interval_ns(); // between lines where stderr is no terminal
    static std::string innermost();     // the name of the calling thread's last activity, or ""

  private:
    std::uint64_t id_;
};

} // namespace burnish
