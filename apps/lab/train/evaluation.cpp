// Figures of nets that make mipmaps, against closed forms.
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/cli/outputs.h"
#include "apps/cli/words.h"
#include "apps/lab/mip/real_maps.h"
#include "apps/lab/train/arguments.h"
#include "apps/pieces/given.h"
#include "apps/report/json.h"
#include "core/base/clock.h"
#include "shading/lab/mip/judge_filters.h"

namespace burnish {
namespace {

Json figures_json(const MipError& f)
{
    return {{"flip", f.flip}, {"l1", f.l1}, {"mse", f.mse}, {"light", f.light}};
}

std::string summary_lines(const std::vector<mipnet::Summary>& all)
{
    std::string lines = fmt::format("{:10} {:10} {:>4} {:>7} {:>7} {:>7}   {:>6} {:>6} {:>6}   {:>5} {:>6}  {}\n", "set", "filter", "of",
                                    "FLIP", "L1", "MSE", "dFLIP", "dL1", "dMSE", "worst", "LoD1", "wins FLIP/L1/MSE");
    const mipnet::Summary* base = nullptr;
    for (const mipnet::Summary& s : all) {
        if (s.filter == "baseline")
            base = &s;
        const auto change = [](double is, double was) { return 100.0 * (is / was - 1.0); };
        const MipError &m = s.mean, &b = base->mean;
        lines += fmt::format(
            "{:10} {:10} {:4} {:7.1f} {:7.2f} {:7.2f}   {:+5.1f}% {:+5.1f}% {:+5.1f}%   {:5.2f} {:6.2f}  {:.0f}/{:.0f}/{:.0f} %\n", s.set,
            s.filter, s.materials, 1e3 * m.flip, 1e3 * m.l1, 1e3 * m.mse, change(m.flip, b.flip), change(m.l1, b.l1), change(m.mse, b.mse),
            s.worst_l1, 1e3 * s.first_level_l1, 100.0 * s.wins[0], 100.0 * s.wins[1], 100.0 * s.wins[2]);
    }
    return lines;
}

Json rows_json(const std::vector<mipnet::Judged>& rows)
{
    Json json = Json::array();
    for (const mipnet::Judged& row : rows) {
        Json levels = Json::array();
        for (int k = 1; k <= mipnet::kEvaluatedLevels; ++k)
            levels.push_back(figures_json(row.level[k]));
        json.push_back({{"set", row.set},
                        {"material", row.material},
                        {"filter", row.filter},
                        {"mean", figures_json(row.level[0])},
                        {"levels", levels}});
    }
    return json;
}

MipError figures_of(const Json& json)
{
    MipError f;
    f.flip = json.at("flip"), f.l1 = json.at("l1"), f.mse = json.at("mse"), f.light = json.at("light");
    return f;
}

// Reads rows_json(). Throws where something is missing.
std::vector<mipnet::Judged> rows_of(const Json& json)
{
    std::vector<mipnet::Judged> rows;
    for (const Json& from : json) {
        mipnet::Judged row{from.at("set"), from.at("material"), from.at("filter"), {}};
        row.level[0] = figures_of(from.at("mean"));
        for (int k = 1; k <= mipnet::kEvaluatedLevels; ++k)
            row.level[k] = figures_of(from.at("levels").at(static_cast<std::size_t>(k - 1)));
        rows.push_back(row);
    }
    return rows;
}

// A piece holds the figures of one material.
std::vector<JobPiece> judged_pieces(const std::vector<mipnet::TestMaterial>& set, const mipnet::Weights& weights, const std::string& text,
                                    const Jobs& jobs)
{
    const auto rate = std::make_shared<std::optional<double>>(); // seconds a texel, by the first material
    const auto texels_of = [](const mipnet::TestMaterial& m) {
        return static_cast<double>(m.material.texels.width) * static_cast<double>(m.material.texels.height);
    };
    std::vector<JobPiece> pieces;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const auto judged = [&set, &weights, &jobs, i] { return mipnet::judge({set[i]}, weights.shape.lobe, {weights}, jobs); };
        const std::string key = piece_key(fmt::format("train {} {}{}", i, set[i].material.name, text));
        const auto seconds = [judged, rate, texels = texels_of(set[i])]() -> Result<double> {
            if (!*rate) {
                const double begin = wall_ms();
                judged();
                *rate = (wall_ms() - begin) * 1e-3 / texels;
            }
            return **rate * texels;
        };
        const auto make = [judged, key](const std::string& file) -> Status {
            const std::string rows = rows_json(judged()).dump();
            return write_piece(file, key, {rows.begin(), rows.end()});
        };
        pieces.push_back({key, seconds, make});
    }
    return pieces;
}

Result<std::vector<mipnet::Judged>> merged_rows(const std::vector<std::string>& files, const std::vector<JobPiece>& pieces)
{
    std::vector<mipnet::Judged> all;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        try {
            for (mipnet::Judged& row : rows_of(Json::parse(content->begin(), content->end())))
                all.push_back(std::move(row));
        } catch (const nlohmann::json::exception&) {
            return Error{ExitCode::bad_input, files[i], "", "is a damaged piece"};
        }
    }
    return all;
}

} // namespace

int run_evaluation(const TrainArguments& a, const OptionTable& given, Report& report)
{
    const Result<mipnet::Weights> weights = mipnet::read_weights(a.evaluate);
    if (!weights)
        return fail(weights.error());
    const Jobs jobs(a.threads);
    std::vector<mipnet::TestMaterial> set = a.validation ? mipnet::make_validation_set(jobs) : mipnet::make_test_set(jobs);
    if (!a.maps.empty()) {
        Result<std::vector<mipnet::TestMaterial>> real = real_materials(a.maps, a.limits);
        if (!real)
            return fail(real.error());
        set.insert(set.end(), real->begin(), real->end());
    }
    // List or make pieces, take their rows, or judge all materials
    const std::vector<JobPiece> pieces =
        any_pieces(a.pieces) ? judged_pieces(set, *weights, text_of_given(given), jobs) : std::vector<JobPiece>();
    if (any_pieces(a.pieces) && !a.pieces.merge)
        return run_pieces(a.pieces, command_words(), pieces, report);
    std::vector<mipnet::Judged> rows;
    if (a.pieces.merge) {
        const auto files = finished_pieces(a.pieces, command_words(), pieces);
        if (!files)
            return fail(files.error());
        Result<std::vector<mipnet::Judged>> merged = merged_rows(*files, pieces);
        if (!merged)
            return fail(merged.error());
        rows = std::move(*merged);
    } else {
        rows = mipnet::judge(set, weights->shape.lobe, {*weights}, jobs);
    }
    report.promise_stdout({a.json});
    report.release();
    if (!a.json.empty()) {
        const Json json = {{"brdf", mipnet::lobe_name(weights->shape.lobe)}, {"command", weights->command}, {"rows", rows_json(rows)}};
        if (const Status written = write_text(a.json, json_text(json, 1) + "\n"); !written)
            return fail(written.error());
        report.wrote(a.json);
    }
    report.figures(summary_lines(mipnet::summaries(rows)));
    return 0;
}

} // namespace burnish
