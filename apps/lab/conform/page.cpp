#include "apps/lab/conform/page.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/lab/conform/assets.h"
#include "apps/lab/conform/scenes.h"
#include "apps/report/assets.h"
#include "apps/report/html.h"
#include "apps/report/json.h"
#include "apps/report/junit.h"
#include "core/image/io/image_io.h"
#include "core/image/magma.h"
#include "core/image/metrics/flip.h"

namespace burnish {
namespace {

using Outcome = SceneJudgement::Outcome;

bool is_compared(const SceneJudgement& s)
{
    return s.outcome == Outcome::right || s.outcome == Outcome::wrong;
}

// Returns a sentence on a scene that is not right.
std::string fault_of(const SceneJudgement& s)
{
    if (!is_compared(s))
        return s.reason;
    std::string text = fmt::format("FLIP {:.3f} to the reference, {:.3f} to what is right; that way itself is {:.3f} from the reference",
                                   s.to_reference, s.to_right, s.way_to_reference);
    if (s.nearest != kNoMistake)
        text += fmt::format("; nearest: {} (FLIP {:.3f})", mistake_words(s.nearest, s.nearest_ev), s.to_nearest);
    return text;
}

Result<std::string> figure(const std::string& title, const std::string& caption, const Image& image)
{
    const Result<std::string> png = encode_png(image);
    BN_TRY(png);
    return fmt::format("<figure><img src=\"data:image/png;base64,{}\" width=\"{}\" height=\"{}\" alt=\"{}\" loading=\"lazy\">"
                       "<figcaption><strong>{}</strong> {}</figcaption></figure>\n",
                       base64(*png), image.width, image.height, escaped(title), escaped(title), escaped(caption));
}

// Returns a scene's pictures: the engine's, the reference, the engine's way, the mistakes found or the nearest, the error.
Result<std::string> pictures_of(const SceneJudgement& s, std::size_t scene, const Judgement& judgement, const ConformPictures& pictures,
                                ConformDrawer& drawer, const Jobs& jobs)
{
    const Image reference = shown_picture(pictures.references[scene]);
    std::string out;
    const auto add = [&](const std::string& title, const std::string& caption, const Image& image) -> Status {
        const Result<std::string> html = figure(title, caption, image);
        BN_TRY(html);
        out += *html;
        return {};
    };
    if (is_compared(s))
        BN_TRY(add("Engine", fmt::format("FLIP {:.3f} to the reference", s.to_reference), pictures.engine[scene].shown));
    BN_TRY(add("Reference", "by Monte Carlo", reference));
    if (!is_compared(s))
        return out;
    BN_TRY(
        add("Error", "black 0, light yellow 1", magma_map(flip_ldr(reference, pictures.engine[scene].shown, FlipOptions{}, jobs).error)));
    Result<std::optional<Image>> without = drawer.draw(scene, {});
    BN_TRY(without);
    BN_TRY(add("Without mistakes", fmt::format("FLIP {:.3f} to the reference", s.way_to_reference), shown_picture(**without)));
    std::vector<int> shown;
    std::string words;
    for (const FoundMistake& m : judgement.mistakes)
        if (m.mutant != kExposure && std::find(m.scenes.begin(), m.scenes.end(), s.name) != m.scenes.end()) {
            shown.push_back(m.mutant);
            words += (words.empty() ? "" : "; ") + mistake_words(m.mutant, 0.0);
        }
    if (shown.empty() && s.outcome == Outcome::wrong && s.nearest >= 0)
        shown.push_back(s.nearest), words = mistake_words(s.nearest, 0.0);
    if (shown.empty())
        return out;
    Result<std::optional<Image>> wrong = drawer.draw(scene, shown);
    BN_TRY(wrong);
    if (*wrong)
        BN_TRY(add("With the mistake", words, shown_picture(**wrong)));
    return out;
}

std::string heading(const Judgement& judgement)
{
    if (judgement.all_right())
        return fmt::format("All {} pictures are right", judgement.scenes.size());
    const auto bad = std::count_if(judgement.scenes.begin(), judgement.scenes.end(),
                                   [](const SceneJudgement& s) { return s.outcome != Outcome::right; });
    return fmt::format("{} of {} pictures are not right", bad, judgement.scenes.size());
}

} // namespace

const char* outcome_name(Outcome outcome)
{
    constexpr const char* kNames[] = {"right", "wrong", "unusable", "missing"};
    return kNames[static_cast<int>(outcome)];
}

std::string conform_json(const Judgement& judgement)
{
    Json scenes = Json::array(), mistakes = Json::array();
    for (const SceneJudgement& s : judgement.scenes) {
        Json row = {{"name", s.name}, {"outcome", outcome_name(s.outcome)}};
        if (!is_compared(s))
            row["reason"] = s.reason;
        else
            row.update({{"flip_to_truth", s.to_reference},
                        {"flip_to_right", s.to_right},
                        {"flip_of_usual_way_to_truth", s.way_to_reference},
                        {"flip_to_usual_way", s.to_way},
                        {"flip_with_mistakes", s.explained},
                        {"eight_bits", s.from_eight_bits},
                        {"nearest", s.nearest == kNoMistake ? Json(nullptr) : Json(mistake_name(s.nearest))},
                        {"flip_to_nearest", s.nearest == kNoMistake ? Json(nullptr) : Json(s.to_nearest)}});
        scenes.push_back(std::move(row));
    }
    for (const FoundMistake& m : judgement.mistakes)
        mistakes.push_back({{"name", mistake_name(m.mutant)},
                            {"words", mistake_words(m.mutant, judgement.exposure_ev)},
                            {"scenes", m.scenes},
                            {"flip_without", m.before},
                            {"flip_with", m.after}});
    const Json json = {{"right", judgement.all_right()},
                       {"way", judgement.way->name},
                       {"unexplained", judgement.unexplained()},
                       {"exposure_ev", judgement.exposure_ev},
                       {"noise", judgement.noise},
                       {"right_up_to", judgement.right_up_to},
                       {"mistakes", mistakes},
                       {"scenes", scenes}};
    return json_text(json, 1) + "\n";
}

std::string conform_junit(const Judgement& judgement)
{
    std::vector<JunitCase> cases;
    for (const SceneJudgement& s : judgement.scenes) {
        const auto outcome = s.outcome == Outcome::right   ? JunitCase::Outcome::passed
                             : s.outcome == Outcome::wrong ? JunitCase::Outcome::failure
                                                           : JunitCase::Outcome::error;
        cases.push_back({s.name, outcome, s.outcome == Outcome::right ? "" : fault_of(s)});
    }
    return junit_text("burnish conform", "conform", cases);
}

Result<std::string> conform_page(const Judgement& judgement, const ConformFolder& folder, const ConformPictures& pictures,
                                 ConformDrawer& drawer, const Jobs& jobs)
{
    std::string mistakes, rows, walls;
    for (const FoundMistake& m : judgement.mistakes)
        mistakes += fmt::format(
            "<li><strong>{}</strong>. Seen in {}: mean FLIP {:.3f} to burnish's pictures with the mistake, {:.3f} to those without.</li>\n",
            escaped(mistake_words(m.mutant, judgement.exposure_ev)), escaped(join(m.scenes)), m.after, m.before);
    if (const std::vector<std::string> names = judgement.unexplained(); !names.empty())
        mistakes += fmt::format("<li><strong>None of ours</strong> looks like {}.</li>\n", escaped(join(names)));
    for (std::size_t i = 0; i < judgement.scenes.size(); ++i) {
        const SceneJudgement& s = judgement.scenes[i];
        rows += fmt::format("<tr><td><a href=\"#{0}\">{0}</a></td><td>{1}</td><td><strong "
                            "class=\"{2}\">{2}</strong></td><td>{3}</td><td>{4}</td><td>{5}</td></tr>\n",
                            escaped(s.name), escaped(folder.scenes[i].about), outcome_name(s.outcome),
                            is_compared(s) ? fmt::format("{:.3f}", s.to_reference) : "",
                            is_compared(s) ? fmt::format("{:.3f}", s.to_right) : "",
                            is_compared(s) ? fmt::format("{:.3f}", s.way_to_reference) : "");
        const Result<std::string> shown = pictures_of(s, i, judgement, pictures, drawer, jobs);
        BN_TRY(shown);
        walls += fmt::format(
            "<section id=\"{}\"><h2>{}: <span class=\"{}\">{}</span></h2><p>{}.{}</p>\n<div class=\"pictures\">\n{}</div></section>\n",
            escaped(s.name), escaped(s.name), outcome_name(s.outcome), outcome_name(s.outcome), escaped(folder.scenes[i].about),
            s.outcome == Outcome::right ? "" : " " + escaped(fault_of(s)) + ".", *shown);
    }
    const std::string way =
        judgement.way_is_known() ? fmt::format("The engine draws image light like {}. ", escaped(judgement.way->words)) : std::string();
    const std::string title = heading(judgement);
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n"
        "<link rel=\"icon\" href=\"data:,\">\n<style>{1}{2}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n"
        "<p>An engine's pictures against the reference's. {6}A picture is right where it looks like the reference, or like the engine's "
        "way of drawing image light without a mistake.</p>\n"
        "{3}<table class=\"rows\">\n<tr><th>scene</th><th>about</th><th>picture</th><th>FLIP to the reference</th><th>to what is "
        "right</th><th>what is right, to the reference</th></tr>\n{4}</table>\n{5}"
        "</main>\n</body>\n</html>\n",
        title, kChartPageStyle.bytes, kConformStyle.bytes, mistakes.empty() ? "" : "<h2>Mistakes found</h2>\n<ol>\n" + mistakes + "</ol>\n",
        rows, walls, way);
}

Error conform_error(const Judgement& judgement)
{
    const auto count_of = [&](Outcome outcome) {
        return std::count_if(judgement.scenes.begin(), judgement.scenes.end(),
                             [&](const SceneJudgement& s) { return s.outcome == outcome; });
    };
    // NaN and pictures that cannot be read come first
    for (const bool finite : {false, true})
        for (const SceneJudgement& s : judgement.scenes)
            if (s.outcome == Outcome::unusable && s.not_finite != finite)
                return Error{finite ? ExitCode::bad_input : ExitCode::not_finite, s.name, "", s.reason};
    // Then wrong ones and missing ones
    std::string text;
    if (const auto wrong = count_of(Outcome::wrong); wrong != 0) {
        text = fmt::format("{} of {} pictures are wrong: ", wrong, judgement.scenes.size());
        text += judgement.mistakes.empty() ? "no known mistake explains it"
                                           : mistake_words(judgement.mistakes.front().mutant, judgement.exposure_ev);
        if (judgement.mistakes.size() > 1)
            text += fmt::format(" (and {})", counted(judgement.mistakes.size() - 1, "more mistake"));
    }
    std::vector<std::string> missing;
    for (const SceneJudgement& s : judgement.scenes)
        if (s.outcome == Outcome::missing)
            missing.push_back(s.name);
    if (!missing.empty())
        text += fmt::format("{}{} of {} pictures are missing: {}", text.empty() ? "" : "; ", missing.size(), judgement.scenes.size(),
                            join(missing));
    return Error{ExitCode::differ, "", "", text};
}

} // namespace burnish
