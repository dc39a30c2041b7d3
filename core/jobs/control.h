// Stop and progress of long work, for programs that use the library:
//
//   std::stop_source stop;
//   const Controlled controlled({stop.get_token(), [](const std::string& work, double done) { show(work, done); }});
//   Result<Session> session = Session::open("lamp.glb", "workshop.hdr"); // ExitCode::stopped after stop.request_stop()
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "core/base/exception.h"

namespace burnish {

struct Control {
    std::stop_token stop = {};
    // Gets the work's name and the share of its current step that is done, [0,1], or -1 where the share is unknown. Any thread may call it,
    // one at a time, at most about ten times a second. It must not use the session that works. An exception ends the work as an Error.
    // Steps of libraries, such as decoding one picture, tell nothing and stop at their end.
    std::function<void(const std::string& work, double done)> progress = {};
};

struct ControlState;

// Controls the calling thread's work for the object's lifetime. A stop takes effect at the next index of a loop or the next activity.
// Functions that return a Result or a Status then return ExitCode::stopped. An inner object replaces an outer one.
class Controlled {
  public:
    explicit Controlled(Control control);
    ~Controlled();
    Controlled(const Controlled&) = delete;
    Controlled& operator=(const Controlled&) = delete;

  private:
    std::unique_ptr<ControlState> state_;
    ControlState* outer_;
    bool outer_in_loop_;
};

void check_stop();           // throws Stopped if the calling thread's work is to stop
std::stop_token stop_here(); // the calling thread's token, for work in threads of other libraries

// Below: for loops and progress reports.

// Counts of one piece of work, reported to the control of the thread that makes the object. Without a control, it does nothing.
class ControlledWork {
  public:
    // A loop reports only where no other loop or count encloses it.
    enum class Kind { loop, count };
    ControlledWork(Kind kind, std::string name, std::size_t total);
    ~ControlledWork();
    ControlledWork(const ControlledWork&) = delete;
    ControlledWork& operator=(const ControlledWork&) = delete;

    bool on() const { return state_ != nullptr; }
    // Runs one index of a loop on any thread, under the control of the loop's thread.
    void run(const std::function<void(std::size_t, int)>& body, std::size_t index, int worker);
    void step(std::size_t n);

  private:
    ControlState* state_;
    Kind kind_;
    bool reports_ = false;
    std::string name_;
    std::size_t total_;
    std::atomic<std::size_t> done_{0};
};

void report_activity(const std::string& name); // its beginning: the share done is unknown; throws Stopped like check_stop()

} // namespace burnish
