#include "apps/lab/race/race_report.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/report/json.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "shading/lang/tables.h"

namespace burnish {

bool same_picture(const RaceRow& row)
{
    return row.error.empty() && row.flip_mean <= kMaxRaceFlip && row.flip_whole <= kMaxWholeFlip;
}

std::vector<std::uint8_t> silhouettes_of(const Frame& frame, int msaa, const DrawTables& tables)
{
    const auto draw_of = [&](std::uint32_t triangle) -> std::ptrdiff_t {
        if (triangle == kNoTriangle)
            return -1;
        const auto after = std::upper_bound(tables.draws.begin(), tables.draws.end(), triangle,
                                            [](std::uint32_t t, const Draw& draw) { return t < draw.first_triangle; });
        return after - tables.draws.begin();
    };
    const std::size_t samples = static_cast<std::size_t>(msaa);
    std::vector<std::uint8_t> found(frame.triangle_ids.size() / samples);
    for (std::size_t p = 0; p < found.size(); ++p) {
        const std::uint32_t* const ids = frame.triangle_ids.data() + p * samples;
        found[p] = std::any_of(ids + 1, ids + samples, [&](std::uint32_t id) { return id != ids[0] && draw_of(id) != draw_of(ids[0]); });
    }
    return found;
}

void compare_pictures(const Image& reference, const Image& test, const std::vector<std::uint8_t>& silhouettes, const Jobs& jobs,
                      RaceRow& row)
{
    row.flip_mean = row.flip_whole = 1.0;
    if (not_finite_pixels(reference, test) > 0)
        return;
    row.flip_whole = row.flip_mean = summarise_errors(flip_hdr(reference, test, {}, jobs).error).mean;
    const auto count = static_cast<double>(std::count(silhouettes.begin(), silhouettes.end(), std::uint8_t{1}));
    row.silhouettes = silhouettes.empty() ? 0.0 : count / static_cast<double>(silhouettes.size());
    if (count == 0.0 || row.silhouettes == 1.0)
        return;
    Image same = test; // on silhouettes: FLIP's filters then see no difference there
    for (std::size_t p = 0; p < silhouettes.size(); ++p)
        if (silhouettes[p])
            std::copy_n(reference.f32() + 3 * p, 3, same.f32() + 3 * p);
    row.flip_mean = summarise_errors(flip_hdr(reference, same, {}, jobs).error).mean / (1.0 - row.silhouettes);
}

double geomean_ratio(const RaceReport& report, const std::string& shader)
{
    double sum = 0.0;
    int count = 0;
    for (const RaceRow& row : report.rows)
        if (row.shader == shader && same_picture(row))
            sum += std::log(row.ratio()), ++count;
    return count ? std::exp(sum / count) : 0.0;
}

std::string race_table(const RaceReport& report)
{
    std::string text, place;
    bool another = false;
    for (const RaceRow& row : report.rows) {
        if (const std::string here = fmt::format("{} on {}\n", row.scene, row.device); here != place) {
            text += (place.empty() ? "" : "\n") + here;
            text += fmt::format("{:<20} {:>7} {:>4} {:<6} {:>8} {:>10} {:>8} {:>9} {:>5} {:>7} {:>6}\n", "technique", "samples", "msaa",
                                "shader", "tile cpu", "device cpu", "tile ms", "device ms", "ratio", "FLIP", "edges");
            place = here;
        }
        text += fmt::format("{:<20} {:>7} {:>4} {:<6} ", row.technique, row.samples, row.msaa, row.shader);
        text += row.error.empty() ? fmt::format("{:>8.2f} {:>10.2f} {:>8.2f} {:>9.2f} {:>5.2f} {:>7.2g} {:>5.1f}%{}\n", row.tile_cpu_ms,
                                                row.device_cpu_ms, row.tile_ms, row.device_ms, row.ratio(), row.flip_mean,
                                                100.0 * row.silhouettes, same_picture(row) ? "" : " *")
                                  : row.error + "\n";
        another = another || (row.error.empty() && !same_picture(row));
    }
    if (another)
        text += fmt::format("\n* another picture, mean FLIP above {:g}, or {:g} with silhouettes: counts for nothing\n", kMaxRaceFlip,
                            kMaxWholeFlip);
    for (const char* shader : kRaceShaders)
        if (const double mean = geomean_ratio(report, shader); mean > 0.0)
            text +=
                fmt::format("\nCPU time, device with its {} shader over tile, geometric mean of the same pictures: {:.2f}\n", shader, mean);
    for (const std::string& note : report.notes)
        text += note + "\n";
    return text;
}

namespace {

Json race_document(const RaceReport& report)
{
    Json json;
    json["machine"] = {{"processor", report.processor}, {"isa", report.isa}, {"threads", report.threads}, {"version", report.version}};
    json["width"] = report.width, json["height"] = report.height, json["runs"] = report.runs;
    json["notes"] = report.notes;
    json["rows"] = Json::array();
    for (const RaceRow& row : report.rows) {
        Json r;
        r["shader"] = row.shader, r["scene"] = row.scene, r["technique"] = row.technique, r["samples"] = row.samples, r["msaa"] = row.msaa,
        r["device"] = row.device;
        r["error"] = row.error.empty() ? Json() : Json(row.error);
        if (!row.error.empty()) { // no measurements
            json["rows"].push_back(r);
            continue;
        }
        r["tile_ms"] = row.tile_ms, r["device_ms"] = row.device_ms, r["tile_cpu_ms"] = row.tile_cpu_ms,
        r["device_cpu_ms"] = row.device_cpu_ms;
        r["ratio"] = row.ratio(), r["flip_mean"] = row.flip_mean, r["flip_whole"] = row.flip_whole, r["silhouettes"] = row.silhouettes;
        r["same_picture"] = same_picture(row);
        json["rows"].push_back(r);
    }
    for (const char* shader : kRaceShaders)
        json["geomean_ratio"][shader] = geomean_ratio(report, shader);
    return json;
}

} // namespace

std::string race_json(const RaceReport& report)
{
    return json_text(race_document(report), 2) + "\n";
}

std::string race_csv(const RaceReport& report)
{
    return csv_text(race_document(report)["rows"]);
}

} // namespace burnish
