#include "apps/lab/conform/judge.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <numeric>
#include <string_view>
#include <utility>

#include "apps/lab/conform/scenes.h"
#include "core/image/colour.h"
#include "core/image/metrics/flip.h"
#include "core/jobs/activity.h"

namespace burnish {
namespace {

constexpr std::size_t kMostMistakes = 6;
constexpr double kSeen = 0.01;       // mean FLIP from which a mistake shows in a scene
constexpr double kExplains = 0.7;    // of the distance before that a mistake may leave
constexpr double kLeastGain = 0.012; // mean FLIP a scene that a mistake must take away
// A picture is right up to this mean FLIP to the truth or to the engine's way, a factor on the engine's noise, within bounds. The noise is
// the median of that FLIP over all scenes.
constexpr double kRightOfNoise = 2.0, kLeastRight = 0.06, kMostRight = 0.12, kLeastNoise = 0.03;
constexpr double kSuspect = 1.4;        // of the noise, from which a scene may hold a mistake
constexpr double kNear = 1.3;           // of the noise, up to which pictures are like those with a mistake
constexpr int kProbes = 4;              // scenes after which a mistake that takes nothing away is given up
constexpr std::size_t kStride = 11;     // between scenes tried one after the other
constexpr double kExplained = 0.5;      // of what is wrong in a way, which its mistakes may leave before another way is tried
constexpr double kHopeful = 0.85;       // of the distance before, which it may leave there
constexpr double kLeastExposure = 0.12; // stops

double luminance(const std::byte* texel)
{
    const auto value = [&](int c) { return static_cast<double>(srgb_to_linear(static_cast<float>(static_cast<int>(texel[c])) / 255.0f)); };
    return 0.2126 * value(0) + 0.7152 * value(1) + 0.0722 * value(2);
}

// Returns the median ratio of luminances where neither picture is dark or clipped, stops; none where too few pixels are so.
std::optional<double> exposure_between(const Image& of, const Image& to)
{
    std::vector<double> stops;
    for (std::size_t at = 0; at < of.bytes.size(); at += 3) {
        const double a = luminance(&of.bytes[at]), b = luminance(&to.bytes[at]);
        if (a > 0.005 && b > 0.005 && a < 0.9 && b < 0.9)
            stops.push_back(std::log2(a / b));
    }
    if (stops.size() < 1000)
        return std::nullopt;
    const auto middle = stops.begin() + static_cast<std::ptrdiff_t>(stops.size() / 2);
    std::nth_element(stops.begin(), middle, stops.end());
    return *middle;
}

// The distances of one set of mistakes to the pictures, by scene; negative: it changes nothing there.
struct Distances {
    std::vector<double> of;
};

// Returns true where a scene may hold a mistake that is not found yet. left: its distance to what is known.
bool is_suspect(const SceneJudgement& scene, const Judgement& judgement, double left)
{
    return std::min(scene.to_right, left) > std::min(kSuspect * judgement.noise, judgement.right_up_to);
}

// All scenes in a way without mistakes, and the pictures' distances to them.
struct DrawnWay {
    const RightWay* way;
    std::vector<Image> shown;
    std::vector<double> distance;
    int far; // scenes that are not like it
};

class Judge {
  public:
    Judge(ConformDrawer& drawer, const std::vector<EnginePicture>& pictures, const Jobs& jobs)
        : drawer_(drawer), pictures_(pictures), jobs_(jobs)
    {
    }
    Result<Judgement> run(const ConformFolder& folder, const std::vector<Image>& truths);

  private:
    bool usable(std::size_t scene) const { return !pictures_[scene].file.empty() && pictures_[scene].fault.empty(); }
    Result<std::optional<Image>> shown_with(std::size_t scene, const std::vector<int>& mistakes);
    Status find_distances(const std::vector<int>& mistakes, const std::vector<Image>& without, const std::vector<bool>& of,
                          const std::vector<double>& left, Distances& to);
    Result<Distances> distances_of(const std::vector<int>& mistakes, const std::vector<Image>& without, const std::vector<double>& left,
                                   const Judgement& judgement);
    Result<DrawnWay> draw_way(const RightWay& way);
    void judge_by(const std::vector<DrawnWay>& ways, std::size_t at, const std::vector<Image>& truths, Judgement& to);
    double exposure_against(const std::vector<Image>& without) const;
    Status find_mistakes(Judgement& to);

    ConformDrawer& drawer_;
    const std::vector<EnginePicture>& pictures_;
    const Jobs& jobs_;
    std::vector<Image> usual_;       // by scene
    std::vector<std::size_t> order_; // of scenes, with unlike ones after each other
    double exposure_ev_ = 0.0;       // of the mistake kExposure
};

Result<std::optional<Image>> Judge::shown_with(std::size_t scene, const std::vector<int>& mistakes)
{
    std::vector<int> drawn_ones;
    float stops = kConformEv;
    for (const int m : mistakes)
        if (m == kExposure)
            stops += static_cast<float>(exposure_ev_);
        else
            drawn_ones.push_back(m);
    Result<std::optional<Image>> drawn = drawer_.draw(scene, drawn_ones);
    BN_TRY(drawn);
    if (!*drawn)
        return std::optional<Image>();
    return std::optional<Image>(tonemap_to_srgb8(**drawn, Tonemap::none, stops));
}

// Fills the distances of the scenes that `of` asks for. Returns early where the first scenes come no nearer by the mistakes.
Status Judge::find_distances(const std::vector<int>& mistakes, const std::vector<Image>& without, const std::vector<bool>& of,
                             const std::vector<double>& left, Distances& to)
{
    double before = 0.0, after = 0.0;
    int probed = 0;
    for (const std::size_t i : order_) {
        if (!usable(i) || !of[i])
            continue;
        Result<std::optional<Image>> drawn = shown_with(i, mistakes);
        BN_TRY(drawn);
        if (!*drawn || mean_flip(without[i], **drawn, jobs_) < kSeen)
            continue;
        to.of[i] = mean_flip(**drawn, pictures_[i].shown, jobs_);
        before += left[i], after += to.of[i];
        if (++probed == kProbes && after > kHopeful * before)
            return {};
    }
    return {};
}

// Returns the distances of a set of mistakes. Draws scenes that are not suspect only where the mistakes explain others.
Result<Distances> Judge::distances_of(const std::vector<int>& mistakes, const std::vector<Image>& without, const std::vector<double>& left,
                                      const Judgement& judgement)
{
    const std::vector<SceneJudgement>& scenes = judgement.scenes;
    Distances found{std::vector<double>(pictures_.size(), -1.0)};
    std::vector<bool> faulty(pictures_.size());
    for (std::size_t i = 0; i < faulty.size(); ++i)
        faulty[i] = usable(i) && is_suspect(scenes[i], judgement, left[i]);
    BN_TRY(find_distances(mistakes, without, faulty, left, found));
    bool explains = false;
    for (std::size_t i = 0; i < faulty.size(); ++i)
        explains = explains || (found.of[i] >= 0.0 && found.of[i] <= kExplains * left[i]);
    if (explains) {
        faulty.flip();
        BN_TRY(find_distances(mistakes, without, faulty, left, found));
    }
    return found;
}

// Returns the pictures' exposure against those, the median over scenes, stops; 0 where it is small.
double Judge::exposure_against(const std::vector<Image>& without) const
{
    std::vector<double> found;
    for (std::size_t i = 0; i < pictures_.size(); ++i)
        if (usable(i))
            if (const std::optional<double> stops = exposure_between(pictures_[i].shown, without[i]))
                found.push_back(*stops);
    if (found.empty())
        return 0.0;
    std::sort(found.begin(), found.end());
    const double stops = found[found.size() / 2];
    return std::abs(stops) < kLeastExposure ? 0.0 : stops;
}

Status Judge::find_mistakes(Judgement& to)
{
    std::vector<Image> without = usual_;
    std::vector<double> left(pictures_.size());
    for (std::size_t i = 0; i < left.size(); ++i)
        left[i] = to.scenes[i].explained;
    std::vector<int> known;
    while (known.size() < kMostMistakes) {
        // Look for the mistake that takes away most
        int best = -1;
        double best_gain = 0.0;
        FoundMistake found;
        std::vector<double> best_left;
        const bool exposed = std::find(known.begin(), known.end(), kExposure) != known.end();
        if (!exposed)
            exposure_ev_ = exposure_against(without);
        for (int m = kExposure; m < static_cast<int>(mutants().size()); ++m) {
            if (std::find(known.begin(), known.end(), m) != known.end() || (m == kExposure && exposure_ev_ == 0.0))
                continue;
            const Activity activity("drawing mistake " + mistake_words(m, exposure_ev_));
            std::vector<int> mistakes = known;
            mistakes.push_back(m);
            const Result<Distances> distances = distances_of(mistakes, without, left, to);
            BN_TRY(distances);
            double before = 0.0, after = 0.0;
            bool wrong = false, near = false;
            std::vector<std::string> seen_in;
            std::vector<double> rest = left;
            for (std::size_t i = 0; i < left.size(); ++i) {
                if (distances->of[i] < 0.0)
                    continue;
                before += left[i], after += distances->of[i];
                rest[i] = distances->of[i];
                wrong = wrong || (to.scenes[i].outcome == SceneJudgement::Outcome::wrong && left[i] > to.right_up_to);
                near = near || (is_suspect(to.scenes[i], to, left[i]) && distances->of[i] <= kNear * to.noise);
                seen_in.push_back(to.scenes[i].name);
                if (known.empty() && distances->of[i] < to.scenes[i].to_usual &&
                    (to.scenes[i].nearest == kNoMistake || distances->of[i] < to.scenes[i].to_nearest))
                    to.scenes[i].nearest = m, to.scenes[i].to_nearest = distances->of[i];
            }
            const double count = static_cast<double>(seen_in.size());
            if ((wrong || near) && before - after > best_gain && after <= kExplains * before && before - after >= kLeastGain * count)
                best = m, best_gain = before - after, best_left = rest, found = {m, seen_in, before / count, after / count};
        }
        if (best < 0)
            return {};
        // Take it for known, and look at what it leaves
        known.push_back(best);
        if (best == kExposure)
            to.exposure_ev = exposure_ev_;
        to.mistakes.push_back(std::move(found));
        left = best_left;
        for (std::size_t i = 0; i < left.size(); ++i) {
            if (known.size() == 1 && left[i] < to.scenes[i].explained)
                to.scenes[i].nearest = best, to.scenes[i].to_nearest = left[i];
            if (usable(i) && is_suspect(to.scenes[i], to, to.scenes[i].explained) && left[i] <= kExplains * to.scenes[i].explained)
                to.scenes[i].outcome = SceneJudgement::Outcome::wrong;
            to.scenes[i].explained = left[i];
            if (!usable(i))
                continue;
            Result<std::optional<Image>> drawn = shown_with(i, known);
            BN_TRY(drawn);
            if (*drawn)
                without[i] = std::move(**drawn);
        }
    }
    return {};
}

// Draws all scenes in a way without mistakes.
Result<DrawnWay> Judge::draw_way(const RightWay& way)
{
    const Activity activity(std::string("drawing ") + way.words);
    drawer_.set_way(way);
    DrawnWay drawn{&way, std::vector<Image>(pictures_.size()), std::vector<double>(pictures_.size()), 0};
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
        if (!usable(i))
            continue;
        Result<std::optional<Image>> shown = shown_with(i, {});
        BN_TRY(shown);
        drawn.shown[i] = std::move(**shown);
        drawn.distance[i] = mean_flip(drawn.shown[i], pictures_[i].shown, jobs_);
        drawn.far += drawn.distance[i] > kLeastRight;
    }
    return drawn;
}

// Fills a judgement for an engine that draws in that way. Fills usual_.
void Judge::judge_by(const std::vector<DrawnWay>& ways, std::size_t at, const std::vector<Image>& truths, Judgement& to)
{
    const RightWay& way = *ways[at].way;
    drawer_.set_way(way);
    to.way = &way;
    usual_ = ways[at].shown;
    std::vector<double> distances;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
        if (!usable(i))
            continue;
        SceneJudgement& scene = to.scenes[i];
        scene.to_usual = scene.explained = ways[at].distance[i];
        scene.usual = mean_flip(shown_picture(truths[i]), usual_[i], jobs_);
        scene.to_right = std::min(scene.to_truth, scene.to_usual);
        for (const DrawnWay& other : ways) // lost light may be given back or not
            if (other.way->kernels == way.kernels && std::string_view(other.way->technique) == way.technique)
                scene.to_right = std::min(scene.to_right, other.distance[i]);
        distances.push_back(scene.to_right);
    }
    if (distances.empty())
        return;
    std::sort(distances.begin(), distances.end());
    to.noise = std::max(distances[distances.size() / 2], kLeastNoise);
    to.right_up_to = std::clamp(kRightOfNoise * to.noise, kLeastRight, kMostRight);
    for (std::size_t i = 0; i < pictures_.size(); ++i)
        if (usable(i))
            to.scenes[i].outcome =
                to.scenes[i].to_right <= to.right_up_to ? SceneJudgement::Outcome::right : SceneJudgement::Outcome::wrong;
}

// Returns how far the pictures are from what explains them, a sum over scenes. Distances that are right do not count.
double unexplained_distance(const Judgement& judgement)
{
    double sum = 0.0;
    for (const SceneJudgement& s : judgement.scenes)
        if (s.outcome == SceneJudgement::Outcome::wrong)
            sum += std::max(s.explained - judgement.right_up_to, 0.0);
    return sum;
}

Result<Judgement> Judge::run(const ConformFolder& folder, const std::vector<Image>& truths)
{
    Judgement none;
    for (std::size_t i = 0; i < folder.scenes.size(); ++i) {
        SceneJudgement scene;
        scene.name = folder.scenes[i].name;
        const EnginePicture& picture = pictures_[i];
        if (usable(i))
            scene.to_truth = scene.to_right = mean_flip(shown_picture(truths[i]), picture.shown, jobs_);
        else {
            scene.outcome = picture.file.empty() ? SceneJudgement::Outcome::missing : SceneJudgement::Outcome::unusable;
            scene.reason = picture.file.empty() ? "there is no picture" : picture.fault;
            scene.not_finite = picture.not_finite;
        }
        none.scenes.push_back(std::move(scene));
    }
    for (std::size_t first = 0; first < kStride; ++first)
        for (std::size_t i = first; i < folder.scenes.size(); i += kStride)
            order_.push_back(i);
    // Draw each right way, and begin with the one that is far from the fewest scenes
    std::vector<DrawnWay> ways;
    for (const RightWay& way : right_ways()) {
        Result<DrawnWay> drawn = draw_way(way);
        BN_TRY(drawn);
        ways.push_back(std::move(*drawn));
    }
    std::vector<std::size_t> order(ways.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ways[a].far < ways[b].far; });
    // Look for mistakes in that way, and in others while most is left unexplained
    std::optional<Judgement> best;
    for (const std::size_t at : order) {
        Judgement judgement = none;
        judge_by(ways, at, truths, judgement);
        const double before = unexplained_distance(judgement);
        BN_TRY(find_mistakes(judgement));
        const double left = unexplained_distance(judgement);
        if (!best || left < unexplained_distance(*best))
            best = std::move(judgement);
        if (left <= kExplained * before)
            break;
    }
    drawer_.set_way(*best->way);
    return std::move(*best);
}

} // namespace

std::string mistake_name(int mutant)
{
    return mutant == kExposure ? "exposure" : mutants()[static_cast<std::size_t>(mutant)].name;
}

std::string mistake_words(int mutant, double exposure_ev)
{
    if (mutant == kExposure)
        return fmt::format("the exposure is off by {:+.2f} stops, a factor of {:.3g}", exposure_ev, std::exp2(exposure_ev));
    return mutants()[static_cast<std::size_t>(mutant)].words;
}

bool Judgement::all_right() const
{
    return std::all_of(scenes.begin(), scenes.end(), [](const SceneJudgement& s) { return s.outcome == SceneJudgement::Outcome::right; });
}

std::vector<std::string> Judgement::unexplained() const
{
    std::vector<std::string> names;
    for (const SceneJudgement& s : scenes)
        if (s.outcome == SceneJudgement::Outcome::wrong && s.explained > right_up_to && s.explained > kExplains * s.to_usual)
            names.push_back(s.name);
    return names;
}

Image shown_picture(const Image& linear)
{
    return tonemap_to_srgb8(linear, Tonemap::none, kConformEv);
}

double mean_flip(const Image& reference, const Image& test, const Jobs& jobs)
{
    const FlipResult flip = flip_ldr(reference, test, FlipOptions{}, jobs);
    double sum = 0.0;
    const std::size_t count = flip.error.bytes.size() / sizeof(float);
    for (std::size_t i = 0; i < count; ++i)
        sum += static_cast<double>(flip.error.f32()[i]);
    return sum / static_cast<double>(count);
}

Result<Judgement> judge_pictures(ConformDrawer& drawer, const ConformFolder& folder, const std::vector<Image>& truths,
                                 const std::vector<EnginePicture>& pictures, const Jobs& jobs)
{
    return Judge(drawer, pictures, jobs).run(folder, truths);
}

} // namespace burnish
