// Runs workloads in turn and compares the results with the aims.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/frame/subject.h"
#include "bench/scenes/figures.h"

namespace burnish {

struct RunOptions {
    SubjectOptions subject;
    int rounds = 11;
    bool quick = false;  // fewer rounds, no slow workloads
    std::string only;    // part of a group's or workload's name; empty: all
    std::string program; // path of burnish, for the first pixel
    std::string self;    // path of this program, for memory
};

struct Measured { // results of one workload; one value for each round
    const Workload* workload = nullptr;
    std::vector<double> cpu_ms, wall_ms; // for each frame
    double units = 0.0;
    double load = 0.0; // load average at the start
    std::string what, pixels;
};

struct Row { // one line of the table
    std::string group, what, unit;
    std::optional<double> aim; // empty: for information
    bool at_least = false;
    Spread value;
    std::string note;
    bool met() const { return !aim || (at_least ? value.median >= *aim : value.median <= *aim); }
};

bool chosen(const RunOptions& options, const std::string& group, const std::string& name);

// Runs all chosen workloads, group by group. `say` gets a line before each group.
Result<std::vector<Measured>> run_workloads(const RunOptions& options, void (*say)(const std::string&));

// Returns the aims' rows. Leaves out aims whose workloads did not run.
std::vector<Row> rows_of(const std::vector<Measured>& measured);

// Returns the share of pixels where the tile renderer and rays see the same triangle, among a million triangles; -1
// without Embree.
double agreement_with_rays(const RunOptions& options);

// Returns techniques' errors against the Monte Carlo reference; none without Embree.
Result<std::vector<Row>> accuracy_rows(const RunOptions& options);

// Measures memory and the time to the first pixel in separate processes. Returns an Error where a process fails.
Result<std::vector<Row>> memory_rows(const RunOptions& options);
Result<std::vector<Row>> first_pixel_rows(const RunOptions& options);

// Child process of memory_rows: draws one frame with `triangles` triangles at 1920x1080. Prints bytes before the frame
// and their peak during it.
int print_memory_of(std::int64_t triangles, const SubjectOptions& options);

} // namespace burnish
