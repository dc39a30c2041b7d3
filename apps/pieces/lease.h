// Leases on pieces in a folder that several machines share. A lease is a file that only one process can make. Its owner rewrites it every
// few seconds. Others take it over once it has not changed for some time by their own clock, so machines' clocks may differ. The lease of a
// process that has ended on the same machine is free at once.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/base/result.h"

namespace burnish {

// Returns a name that no other process has: machine, process, and a random number.
std::string new_process_name();

struct LeaseTimes {
    std::chrono::milliseconds beat{2000};   // between two signs of life
    std::chrono::milliseconds stale{20000}; // without a sign: the owner is dead
};

// Keeps a lease alive until it is destroyed, and then removes the file.
class Lease {
  public:
    Lease(std::string file, std::string owner, LeaseTimes times);
    ~Lease();
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

  private:
    void beat();

    std::string file_, owner_;
    LeaseTimes times_;
    std::mutex mutex_;
    std::condition_variable ended_;
    bool ends_ = false;
    std::thread thread_;
};

// Takes leases in one folder.
class Leases {
  public:
    // owner: this process, unlike any other: new_process_name().
    explicit Leases(std::string owner, LeaseTimes times = {});
    // Returns the lease of `file`, null where another process holds it.
    Result<std::unique_ptr<Lease>> take(const std::string& file);

  private:
    struct Seen {
        std::string content;
        std::chrono::steady_clock::time_point since;
    };
    std::string owner_;
    LeaseTimes times_;
    std::map<std::string, Seen> seen_;
};

} // namespace burnish
