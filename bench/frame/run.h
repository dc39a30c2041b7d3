// Runs of workloads in turn, and what they say about the aims.
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
    std::string only;    // part of a group's or a workload's name; empty: all
    std::string program; // burnish, for the first pixel
    std::string self;    // this program, for memory
};

struct Measured { // one workload; a value a round
    const Workload* workload = nullptr;
    std::vector<double> cpu_ms, wall_ms; // of a frame
    double units = 0.0;
    double load = 0.0; // when it began
    std::string what, pixels;
};

struct Row { // one line of the table
    std::string group, what, unit;
    std::optional<double> aim; // none: for information
    bool at_least = false;
    Spread value;
    std::string note;
    bool met() const { return !aim || (at_least ? value.median >= *aim : value.median <= *aim); }
};

bool chosen(const RunOptions& options, const std::string& group, const std::string& name);

// Every chosen workload of the table, group by group; `say` gets a line before each group.
Result<std::vector<Measured>> run_workloads(const RunOptions& options, void (*say)(const std::string&));

// What the aims of the table make of them; aims whose workloads were not run are left out.
std::vector<Row> rows_of(const std::vector<Measured>& measured);

// Share of the pixels that the tile renderer and rays give the same triangle, of a million triangles; -1 without Embree.
double agreement_with_rays(const RunOptions& options);

// Errors of techniques against the Monte Carlo reference; none without Embree.
Result<std::vector<Row>> accuracy_rows(const RunOptions& options);

// Memory and the time to the first pixel, by processes of their own. An Error where one of them failed.
Result<std::vector<Row>> memory_rows(const RunOptions& options);
Result<std::vector<Row>> first_pixel_rows(const RunOptions& options);

// The child of memory_rows: one frame of `triangles` triangles at 1920x1080; prints bytes before, and at most during, the frame.
int print_memory_of(std::int64_t triangles, const SubjectOptions& options);

} // namespace burnish
