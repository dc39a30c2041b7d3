// The rows of a chart: one technique with one setting on one surface, its errors and its times. Kept in a file while the chart is
// made, so that one that was stopped goes on.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/chart/plan.h"
#include "apps/report/json.h"

namespace burnish {

struct RowErrors { // against the reference; of pictures with NaN only the count is a number
    double flip_mean = 0.0, flip_p99 = 0.0, rel_mse = 0.0, max_abs = 0.0;
    std::uint64_t nan_pixels = 0;
};

struct Measured { // of a row, so far
    bool has_errors = false;
    RowErrors errors;
    std::vector<double> ms, cpu_ms; // by run
};
struct ReferenceNoise {          // how far a reference may be from the truth
    std::uint64_t samples = 0;   // a pixel
    double relative_error = 0.0; // half width of the 95 % confidence interval over the mean, averaged over the pixels that are not black
    double flip = 0.0;           // mean FLIP between the reference and itself with as much noise again
};

struct Kept {                                         // of earlier runs
    std::map<std::string, Measured> rows;             // by ChartRow::key
    std::map<std::string, ReferenceNoise> references; // by key of the place and samples asked for
    std::optional<double> others{};                   // the most of ChartMachine::others of the runs that timed them
};

struct ChartRow {
    std::string key; // of everything that decides its pictures and its times, 16 hexadecimal digits
    std::string scene, env;
    Setting setting;
    Cell cell;
    Measured measured;
    bool pareto = false;
    std::string picture, error_map; // files
};

struct ChartMachine {
    std::string version, processor, isa;
    int threads = 0;
    std::optional<double> others{}; // mean share of the machine's cores that other programs took while frames were timed, [0, 1]
};
inline constexpr double kBusy = 0.1; // of them: times are not to be trusted

struct ChartReference {
    std::string picture; // file
    ReferenceNoise noise;
};

struct ChartReport {
    ChartMachine machine;
    int width = 0, height = 0, msaa = 0, runs = 0; // width, height: of the timed frames, pixels
    int error_width = 0, error_height = 0;         // of the pictures compared with the reference
    std::uint64_t reference_samples = 0;
    bool display_flip = false;                        // errors are LDR-FLIP of pictures as they are shown; else HDR-FLIP
    Json parameters = Json::object();                 // of techniques, the same of all rows
    std::vector<ChartRow> rows;                       // by scene, environment, cell, technique, samples
    std::map<std::string, ChartReference> references; // by place()
};

std::optional<double> number_in(const std::string& value); // of a swept option; none where it is a name or a vector
std::string place(const ChartRow& row);                    // scene, environment and cell as one text: rows of one place are compared

double flip_of(const ChartRow& row);
double ms_of(const ChartRow& row);
double p95_of(const ChartRow& row);

// Which of the points are not beaten: no other is at least as good in both and better in one. What is not finite never is.
std::vector<bool> pareto_front(const std::vector<std::pair<double, double>>& points);
void mark_pareto(std::vector<ChartRow>& rows); // by place, over median time and mean FLIP

inline constexpr int kKeptVersion = 2; // of the layout of the text
std::string kept_json(const Kept& kept);
Result<Kept> parse_kept(const std::string& text, const std::string& file);
std::string report_json(const ChartReport& report);
std::string report_csv(const ChartReport& report); // of the rows

} // namespace burnish
