// What goes on, for people who wait: work that takes longer than the progress interval (BURNISH_PROGRESS_SECONDS, 10) says so on stderr.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

namespace burnish {

// Work that may take long, as long as the object lives. Where nothing was said for an interval, a line names it and what it is a part of:
// "parity, row 3 of 20, compiling shade: 20 s". On a terminal the line is there after a second and goes with the work. Thread-safe; a
// thread ends its activities in the reverse order.
class Activity {
  public:
    explicit Activity(std::string what);
    // `say` says the line of what goes on, in place of its name.
    Activity(std::string what, std::function<void()> say);
    ~Activity();
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;

    static void tell(bool on);          // whether lines appear; at first none do, for a library says nothing
    static void said_already();         // something else said how far the work is
    static std::uint64_t interval_ns(); // between lines where stderr is no terminal

  private:
    std::uint64_t id_;
};

} // namespace burnish
