#include "apps/parity/race_report.h"

#include <cmath>
#include <fmt/core.h>

#include "apps/report/json.h"

namespace burnish {

bool same_picture(const RaceRow& row)
{
    return row.error.empty() && row.flip_mean <= kMaxRaceFlip;
}

double geomean_ratio(const RaceReport& report)
{
    double sum = 0.0;
    int count = 0;
    for (const RaceRow& row : report.rows)
        if (same_picture(row))
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
            text += fmt::format("{:<20} {:>7} {:>4} {:>9} {:>10} {:>9} {:>9} {:>6} {:>8}\n", "technique", "samples", "msaa", "tile cpu",
                                "device cpu", "tile ms", "device ms", "ratio", "FLIP");
            place = here;
        }
        text += fmt::format("{:<20} {:>7} {:>4} ", row.technique, row.samples, row.msaa);
        text += row.error.empty()
                    ? fmt::format("{:>9.2f} {:>10.2f} {:>9.2f} {:>9.2f} {:>6.2f} {:>8.2g}{}\n", row.tile_cpu_ms, row.device_cpu_ms,
                                  row.tile_ms, row.device_ms, row.ratio(), row.flip_mean, same_picture(row) ? "" : " *")
                    : row.error + "\n";
        another = another || (row.error.empty() && !same_picture(row));
    }
    if (another)
        text += fmt::format("\n* another picture, mean FLIP above {:g}: counts for nothing\n", kMaxRaceFlip);
    if (const double mean = geomean_ratio(report); mean > 0.0)
        text += fmt::format("\nratio of CPU times, device over tile, geometric mean over the same pictures: {:.2f}\n", mean);
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
        r["scene"] = row.scene, r["technique"] = row.technique, r["samples"] = row.samples, r["msaa"] = row.msaa, r["device"] = row.device;
        r["error"] = row.error.empty() ? Json() : Json(row.error);
        if (!row.error.empty()) { // no figures
            json["rows"].push_back(r);
            continue;
        }
        r["tile_ms"] = row.tile_ms, r["device_ms"] = row.device_ms, r["tile_cpu_ms"] = row.tile_cpu_ms,
        r["device_cpu_ms"] = row.device_cpu_ms;
        r["ratio"] = row.ratio(), r["flip_mean"] = row.flip_mean, r["same_picture"] = same_picture(row);
        json["rows"].push_back(r);
    }
    json["geomean_ratio"] = geomean_ratio(report);
    return json;
}

} // namespace

std::string race_json(const RaceReport& report)
{
    return race_document(report).dump(2) + "\n";
}

std::string race_csv(const RaceReport& report)
{
    return race_document(report)["rows"].csv();
}

} // namespace burnish
