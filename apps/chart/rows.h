// Chart rows: errors and times for one technique with one setting on one surface. Rows are kept in a file while the chart is made, so an
// interrupted chart can resume.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/chart/plan.h"
#include "raster/frame/frame.h"

namespace burnish {

struct RowErrors { // against the reference; pictures with NaN have nan_pixels alone
    double flip_mean = 0.0, flip_p99 = 0.0, rel_mse = 0.0, max_abs = 0.0;
    std::uint64_t nan_pixels = 0;
    double pattern_rms = 0.0, quad_ratio_x = 0.0, quad_ratio_y = 0.0; // core/image/metrics/pattern.h; NaN: unknown
};

struct Measured { // a row's measurements so far
    bool has_errors = false;
    RowErrors errors;
    std::vector<double> ms, cpu_ms; // one entry a run
};
struct ReferenceNoise {          // the reference's own estimated error
    std::uint64_t samples = 0;   // a pixel
    double relative_error = 0.0; // the 95 % confidence interval's half width over the mean, averaged over pixels that are not black
    double flip = 0.0;           // mean FLIP between the reference and the reference plus as much noise again
};

struct ChartResults {                                 // from earlier runs
    std::map<std::string, Measured> rows;             // by ChartRow::key
    std::map<std::string, ReferenceNoise> references; // by the place's key and requested samples
    std::optional<double> others{};                   // largest ChartMachine::others in the runs behind the times
};

struct ChartRow {
    std::string key; // hash over all inputs to pictures and times, 16 hexadecimal digits
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
    std::optional<double> others{}; // the cores' mean share taken by other programs during timing, [0,1]
};
inline constexpr double kBusy = 0.1; // above this share of others, times are not reliable

struct ChartReference {
    std::string picture; // file
    ReferenceNoise noise;
};

struct ChartReport {
    ChartMachine machine;
    int width = 0, height = 0, msaa = 0, runs = 0; // width, height: the timed frames', pixels
    int error_width = 0, error_height = 0;         // pictures compared with the reference
    std::uint64_t reference_samples = 0;
    std::vector<double> wanted;                       // mean errors that the page names settings for
    bool display_flip = false;                        // errors are LDR-FLIP of pictures as they are shown; else HDR-FLIP
    FrameDesc frame;                                  // all rows share its technique parameters
    std::vector<ChartRow> rows;                       // by scene, environment, cell, technique, samples
    std::map<std::string, ChartReference> references; // by place()
};

std::optional<double> number_in(const std::string& value); // a swept option's value; none for names and vectors
std::string place(const ChartRow& row);                    // scene, environment and cell as one text; one place's rows are compared

double flip_of(const ChartRow& row);
double ms_of(const ChartRow& row); // median; NaN without runs, as the next two
double p95_of(const ChartRow& row);
double cpu_ms_of(const ChartRow& row); // median

// Returns the points on the Pareto front: no other point is as good in both coordinates and better in one. Non-finite points are never on
// it.
std::vector<bool> pareto_front(const std::vector<std::pair<double, double>>& points);
void mark_pareto(std::vector<ChartRow>& rows); // by place, over median time and mean FLIP

// Returns sentences on the fastest row of a place within each error (mean FLIP), largest error first. Empty without times.
std::vector<std::string> wanted_settings(const std::vector<const ChartRow*>& rows, const ReferenceNoise& noise, std::vector<double> errors);
inline constexpr double kWantedErrors[] = {0.03, 0.01, 0.003}; // unless budgets say otherwise

inline constexpr int kChartResultsVersion = 3; // file layout
std::string chart_results_json(const ChartResults& results);
Result<ChartResults> parse_chart_results(const std::string& text, const std::string& file);
std::string report_json(const ChartReport& report);
std::string report_csv(const ChartReport& report); // rows only

} // namespace burnish
