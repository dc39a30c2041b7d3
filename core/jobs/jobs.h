// Parallel loops. The thread that runs an index never changes the index's result.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace burnish {

// A fixed number of worker threads (0: all cores that the process may use).
class Jobs {
  public:
    explicit Jobs(int threads = 0);
    ~Jobs();
    int threads() const;
    bool by_onetbb() const; // false: the process's own pool, or the caller alone
    // Calls body(index, worker) for index in [0, count). worker in [0, threads()) only selects scratch memory. Throws Stopped where the
    // caller's work is to stop (core/jobs/control.h).
    void parallel_for(std::size_t count, const std::function<void(std::size_t index, int worker)>& body) const;
    // Runs like parallel_for(), without stops and progress, for functions that cannot fail.
    void parallel_for_whole(std::size_t count, const std::function<void(std::size_t index, int worker)>& body) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Chrome trace events (chrome://tracing, ui.perfetto.dev). Off until started; a span then costs one branch.
class Trace {
  public:
    static void start();
    static bool on();
    static std::uint64_t now_ns();
    static void span(const char* name, std::uint64_t begin_ns, std::uint64_t end_ns); // `name` must outlive the trace
    static std::string json();                                                        // all spans so far, at most 1,000,000 events
};

class TraceSpan {
  public:
    explicit TraceSpan(const char* name) : name_(name), begin_(Trace::on() ? Trace::now_ns() : 0) {}
    ~TraceSpan()
    {
        if (begin_)
            Trace::span(name_, begin_, Trace::now_ns());
    }
    TraceSpan(const TraceSpan&) = delete;
    TraceSpan& operator=(const TraceSpan&) = delete;

  private:
    const char* name_;
    std::uint64_t begin_;
};

// A progress bar where stderr is a terminal, else lines at the progress interval; silent if quiet. Steps also go to the control of the
// thread that makes the object (core/jobs/control.h). Thread-safe.
class Progress {
  public:
    Progress(std::string label, std::size_t total, bool quiet);
    ~Progress(); // clears the bar
    void step(std::size_t n = 1);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace burnish
