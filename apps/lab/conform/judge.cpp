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
constexpr double kSeen = 0.01;         // mean FLIP from which a mistake shows in a scene
constexpr double kExplains = 0.7;      // of the distance before that a mistake may leave
constexpr double kExplainsWhole = 0.5; // the same for a mistake of whole pictures, which may hide in an engine's noise
constexpr double kLeastGain = 0.012;   // mean FLIP a scene that a mistake must take away
// A picture is right up to this mean FLIP to the reference or to the engine's way, a factor on the engine's noise, within bounds. The noise
// is the median of that FLIP over all scenes.
constexpr double kRightOfNoise = 2.0, kLeastRight = 0.06, kMostRight = 0.12, kLeastNoise = 0.03;
constexpr double kSuspect = 1.4;          // of the noise, from which a scene may hold a mistake
constexpr double kNear = 1.3;             // of the noise, up to which pictures are like those with a mistake
constexpr int kProbes = 4;                // scenes after which a mistake that takes nothing away is given up
constexpr std::size_t kStride = 11;       // between scenes tried one after the other
constexpr double kExplained = 0.25;       // of the wrong distance in a way, which its mistakes may leave before another way is tried
constexpr double kWellExplained = 0.05;   // the same, where another way is far from about as few scenes
constexpr int kAboutAsFew = 2;            // scenes
constexpr double kHopeful = 0.85;         // of the distance before, which it may leave there
constexpr double kAlike = 1.05;           // mistakes that look alike in a scene: the named one counts as the nearest
constexpr double kLeastExposure = 0.12;   // stops
constexpr double kLeastNamed = 1.0 / 3.0; // share of the wrong scenes that mistakes explain, from which they are named

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

// A set of mistakes' effect in a scene: the size of its change, and the distance that it leaves. size 0: no change.
struct Effect {
    double size = 0.0, distance = 0.0; // mean FLIP
};

// A set of mistakes that may explain pictures.
struct Candidate {
    std::vector<int> set;
    double gain = 0.0; // distance that it takes away, a sum of FLIP over scenes
    FoundMistake found;
    std::vector<double> left; // by scene
};

// Returns true where a scene may hold a mistake that is not found yet. left: its distance to the known mistakes.
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

bool changes_whole_pictures(int mutant)
{
    if (mutant == kExposure)
        return true;
    const Mutant& m = mutants()[static_cast<std::size_t>(mutant)];
    return m.picture || m.sky != MutantSky::right || (m.frame && !m.scene);
}

class Judge {
  public:
    Judge(ConformDrawer& drawer, const std::vector<EnginePicture>& pictures, const Jobs& jobs)
        : drawer_(drawer), pictures_(pictures), jobs_(jobs)
    {
    }
    Result<Judgement> run(const ConformFolder& folder, const std::vector<Image>& references);

  private:
    bool usable(std::size_t scene) const { return !pictures_[scene].file.empty() && pictures_[scene].fault.empty(); }
    Result<std::optional<Image>> shown_with(std::size_t scene, const std::vector<int>& mistakes);
    Status find_effects(const std::vector<int>& mistakes, const std::vector<Image>& without, const std::vector<bool>& of,
                        const std::vector<double>& left, bool hopeful, std::vector<Effect>& to);
    Result<std::vector<Effect>> effects_of(const std::vector<int>& mistakes, bool whole, const std::vector<Image>& without,
                                           const std::vector<double>& left, const Judgement& judgement);
    std::vector<std::vector<int>> candidates(const std::vector<int>& known, bool pairs) const;
    Result<Candidate> best_candidate(const std::vector<int>& known, bool pairs, const std::vector<Image>& without,
                                     const std::vector<double>& left, Judgement& to);
    Result<DrawnWay> draw_way(const RightWay& way);
    void judge_by(const std::vector<DrawnWay>& ways, std::size_t at, const std::vector<Image>& references, Judgement& to);
    double exposure_against(const std::vector<Image>& without) const;
    Status find_mistakes(bool pairs, Judgement& to);

    ConformDrawer& drawer_;
    const std::vector<EnginePicture>& pictures_;
    const Jobs& jobs_;
    std::vector<Image> way_shown_;   // by scene
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
    if (drawn && !*drawn && drawn_ones.size() < mistakes.size()) // the exposure changes every scene
        drawn = drawer_.draw(scene, {});
    BN_TRY(drawn);
    if (!*drawn)
        return std::optional<Image>();
    return std::optional<Image>(tonemap_to_srgb8(**drawn, Tonemap::none, stops));
}

// Draws a set of mistakes in the scenes that `of` asks for. hopeful: ends where the first scenes come no nearer by the mistakes.
Status Judge::find_effects(const std::vector<int>& mistakes, const std::vector<Image>& without, const std::vector<bool>& of,
                           const std::vector<double>& left, bool hopeful, std::vector<Effect>& to)
{
    double before = 0.0, after = 0.0;
    int probed = 0;
    for (const std::size_t i : order_) {
        if (!usable(i) || !of[i])
            continue;
        Result<std::optional<Image>> drawn = shown_with(i, mistakes);
        BN_TRY(drawn);
        const double size = *drawn ? mean_flip(without[i], **drawn, jobs_) : 0.0;
        if (size < kSeen)
            continue;
        to[i] = {size, mean_flip(**drawn, pictures_[i].shown, jobs_)};
        before += left[i], after += to[i].distance;
        if (++probed == kProbes && hopeful && after > kHopeful * before)
            return {};
    }
    return {};
}

// Returns the effects of a set of mistakes by scene. Draws scenes that are not suspect only where the mistakes explain others.
Result<std::vector<Effect>> Judge::effects_of(const std::vector<int>& mistakes, bool whole, const std::vector<Image>& without,
                                              const std::vector<double>& left, const Judgement& judgement)
{
    std::vector<Effect> found(pictures_.size());
    std::vector<bool> suspect(pictures_.size());
    for (std::size_t i = 0; i < suspect.size(); ++i)
        suspect[i] = usable(i) && (whole || is_suspect(judgement.scenes[i], judgement, left[i]));
    BN_TRY(find_effects(mistakes, without, suspect, left, true, found));
    bool explains = false;
    for (std::size_t i = 0; i < suspect.size(); ++i)
        explains = explains || (found[i].size > 0.0 && found[i].distance <= kExplains * left[i]);
    if (explains) {
        suspect.flip();
        BN_TRY(find_effects(mistakes, without, suspect, left, false, found));
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

// Returns the sets of mistakes that may come next: one each, or two where one of them changes whole pictures.
std::vector<std::vector<int>> Judge::candidates(const std::vector<int>& known, bool pairs) const
{
    std::vector<int> single;
    for (int m = kExposure; m < static_cast<int>(mutants().size()); ++m)
        if (std::find(known.begin(), known.end(), m) == known.end() && (m != kExposure || exposure_ev_ != 0.0))
            single.push_back(m);
    std::vector<std::vector<int>> sets;
    for (const int a : single) {
        if (!pairs)
            sets.push_back({a});
        for (const int b : single)
            if (pairs && changes_whole_pictures(a) && b != a && (!changes_whole_pictures(b) || b > a))
                sets.push_back({a, b});
    }
    return sets;
}

// Returns the candidate that takes away most of the distance left; empty: none explains enough.
Result<Candidate> Judge::best_candidate(const std::vector<int>& known, bool pairs, const std::vector<Image>& without,
                                        const std::vector<double>& left, Judgement& to)
{
    Candidate best;
    for (const std::vector<int>& set : candidates(known, pairs)) {
        const Activity activity("drawing mistake " + mistake_words(set.front(), exposure_ev_));
        std::vector<int> mistakes = known;
        mistakes.insert(mistakes.end(), set.begin(), set.end());
        const bool whole = changes_whole_pictures(set.front());
        const Result<std::vector<Effect>> effects = effects_of(mistakes, whole, without, left, to);
        BN_TRY(effects);
        // Sum the distance that it takes away, weighted by the size of its changes
        Candidate now{set, 0.0, {}, left};
        double before = 0.0, after = 0.0, weight = 0.0;
        bool accepted = whole;
        for (std::size_t i = 0; i < left.size(); ++i) {
            const Effect& e = (*effects)[i];
            if (e.size == 0.0)
                continue;
            SceneJudgement& scene = to.scenes[i];
            before += e.size * left[i], after += e.size * e.distance, weight += e.size;
            now.gain += left[i] - e.distance;
            now.left[i] = e.distance;
            now.found.scenes.push_back(scene.name);
            now.found.before += left[i], now.found.after += e.distance;
            const bool suspect = is_suspect(scene, to, left[i]) && e.distance <= kExplains * left[i];
            accepted = accepted || (suspect && (left[i] > to.right_up_to || e.distance <= kNear * to.noise));
            if (known.empty() && set.size() == 1 && e.distance < std::min(scene.to_way, scene.to_nearest))
                scene.nearest = set.front(), scene.to_nearest = e.distance, scene.nearest_ev = exposure_ev_;
        }
        const double share = whole ? kExplainsWhole : kExplains;
        if (accepted && now.gain > best.gain && after <= share * before && before - after >= kLeastGain * weight)
            best = std::move(now);
    }
    return best;
}

// Finds mistakes one after the other. pairs: begins with two at once where no single one explains enough.
Status Judge::find_mistakes(bool pairs, Judgement& to)
{
    std::vector<Image> without = way_shown_;
    std::vector<double> left(pictures_.size());
    for (std::size_t i = 0; i < left.size(); ++i)
        left[i] = to.scenes[i].explained;
    std::vector<int> known;
    while (known.size() < kMostMistakes) {
        if (std::find(known.begin(), known.end(), kExposure) == known.end())
            exposure_ev_ = exposure_against(without);
        Result<Candidate> best = best_candidate(known, false, without, left, to);
        BN_TRY(best);
        if (best->set.empty() && known.empty() && pairs) {
            best = best_candidate(known, true, without, left, to);
            BN_TRY(best);
        }
        if (best->set.empty())
            return {};
        // Take it for known, and look at the distance that it leaves
        const double count = static_cast<double>(best->found.scenes.size());
        best->found.before /= count, best->found.after /= count;
        for (const int m : best->set) {
            known.push_back(m);
            to.mistakes.push_back(best->found);
            to.mistakes.back().mutant = m;
            if (m == kExposure)
                to.exposure_ev = exposure_ev_;
        }
        for (std::size_t i = 0; i < left.size(); ++i) {
            if (!usable(i))
                continue;
            SceneJudgement& scene = to.scenes[i];
            if (best->left[i] < left[i] && best->left[i] <= kExplains * left[i])
                scene.outcome = SceneJudgement::Outcome::wrong;
            if (best->set.size() == 1 && to.mistakes.size() == 1 && best->left[i] < left[i] && best->left[i] <= kAlike * scene.to_nearest)
                scene.nearest = best->set.front(), scene.to_nearest = best->left[i], scene.nearest_ev = exposure_ev_;
            scene.explained = best->left[i];
            Result<std::optional<Image>> drawn = shown_with(i, known);
            BN_TRY(drawn);
            if (*drawn)
                without[i] = std::move(**drawn);
        }
        left = best->left;
    }
    return {};
}

// Draws all scenes in a way without mistakes.
Result<DrawnWay> Judge::draw_way(const RightWay& way)
{
    const Activity activity(std::string("drawing ") + way.words);
    drawer_.set_way(way);
    DrawnWay drawn{&way, std::vector<Image>(pictures_.size()), std::vector<double>(pictures_.size()), 0};
    std::vector<Image> linear(pictures_.size());
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
        if (!usable(i))
            continue;
        Result<std::optional<Image>> picture = drawer_.draw(i, {});
        BN_TRY(picture);
        linear[i] = std::move(**picture);
        drawn.shown[i] = shown_picture(linear[i]);
        drawn.distance[i] = mean_flip(drawn.shown[i], pictures_[i].shown, jobs_);
    }
    // Count the scenes that are far, at any exposure
    const double stops = exposure_against(drawn.shown);
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
        if (!usable(i))
            continue;
        double least = drawn.distance[i];
        if (stops != 0.0) {
            const Image exposed = tonemap_to_srgb8(linear[i], Tonemap::none, kConformEv + static_cast<float>(stops));
            least = std::min(least, mean_flip(exposed, pictures_[i].shown, jobs_));
        }
        drawn.far += least > kLeastRight;
    }
    return drawn;
}

// Fills a judgement for an engine that draws in that way. Fills way_shown_.
void Judge::judge_by(const std::vector<DrawnWay>& ways, std::size_t at, const std::vector<Image>& references, Judgement& to)
{
    const RightWay& way = *ways[at].way;
    drawer_.set_way(way);
    to.way = &way;
    way_shown_ = ways[at].shown;
    std::vector<double> distances;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
        if (!usable(i))
            continue;
        SceneJudgement& scene = to.scenes[i];
        scene.to_way = scene.explained = ways[at].distance[i];
        scene.way_to_reference = mean_flip(shown_picture(references[i]), way_shown_[i], jobs_);
        scene.to_right = std::min(scene.to_reference, scene.to_way);
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

// Returns the distance of the pictures from their explanations, a sum over scenes. Distances that are right do not count. A right picture
// counts where the mistakes would make it wrong.
double unexplained_distance(const Judgement& judgement)
{
    double sum = 0.0;
    for (const SceneJudgement& s : judgement.scenes)
        if (s.outcome == SceneJudgement::Outcome::wrong || (s.outcome == SceneJudgement::Outcome::right && s.explained > s.to_way))
            sum += std::max(s.explained - judgement.right_up_to, 0.0);
    return sum;
}

// Returns true for a scene that the mistakes found bring near to the picture.
bool is_explained(const SceneJudgement& s, const Judgement& judgement)
{
    return s.explained <= judgement.right_up_to || s.explained <= kExplains * s.to_way;
}

// Takes the mistakes back where they explain few of the wrong scenes: a fault that nobody knows looks like one of ours here and there.
void forget_chance(Judgement& judgement)
{
    double wrong = 0.0, explained = 0.0;
    for (const SceneJudgement& s : judgement.scenes)
        if (s.outcome == SceneJudgement::Outcome::wrong)
            wrong += 1.0, explained += is_explained(s, judgement);
    if (explained >= kLeastNamed * wrong)
        return;
    judgement.mistakes.clear(), judgement.exposure_ev = 0.0;
    for (SceneJudgement& s : judgement.scenes)
        s.explained = s.to_way;
}

Result<Judgement> Judge::run(const ConformFolder& folder, const std::vector<Image>& references)
{
    Judgement none;
    for (std::size_t i = 0; i < folder.scenes.size(); ++i) {
        SceneJudgement scene;
        scene.name = folder.scenes[i].name;
        const EnginePicture& picture = pictures_[i];
        scene.from_eight_bits = picture.from_eight_bits;
        if (usable(i))
            scene.to_reference = scene.to_right = mean_flip(shown_picture(references[i]), picture.shown, jobs_);
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
    // Look for mistakes in that way, and in others while too much is left unexplained
    std::optional<Judgement> best;
    const auto look = [&](std::size_t at, bool pairs) -> Result<double> {
        Judgement judgement = none;
        judge_by(ways, at, references, judgement);
        const double before = unexplained_distance(judgement);
        BN_TRY(find_mistakes(pairs, judgement));
        const double left = unexplained_distance(judgement);
        if (!best || left < unexplained_distance(*best))
            best = std::move(judgement);
        return before > 0.0 ? left / before : 0.0;
    };
    const auto about_as_few = [&](std::size_t at) { return ways[at].far <= ways[order.front()].far + kAboutAsFew; };
    double least = 1.0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && least <= (about_as_few(order[i]) ? kWellExplained : kExplained))
            break;
        const Result<double> share = look(order[i], false);
        BN_TRY(share);
        least = std::min(least, *share);
    }
    forget_chance(*best);
    // Look for two at once where no single one explains pictures that are mostly wrong
    const auto wrong = std::count_if(best->scenes.begin(), best->scenes.end(),
                                     [](const SceneJudgement& s) { return s.outcome == SceneJudgement::Outcome::wrong; });
    const bool searches = 2 * wrong > static_cast<std::ptrdiff_t>(best->scenes.size());
    for (std::size_t i = 0; searches && best->mistakes.empty() && i < order.size() && about_as_few(order[i]); ++i)
        BN_TRY(look(order[i], true));
    forget_chance(*best);
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

bool Judgement::way_is_known() const
{
    const auto known = std::count_if(scenes.begin(), scenes.end(), [&](const SceneJudgement& s) {
        return s.outcome == SceneJudgement::Outcome::right || (s.outcome == SceneJudgement::Outcome::wrong && s.explained <= right_up_to);
    });
    return 2 * known > static_cast<std::ptrdiff_t>(scenes.size());
}

bool Judgement::all_right() const
{
    return std::all_of(scenes.begin(), scenes.end(), [](const SceneJudgement& s) { return s.outcome == SceneJudgement::Outcome::right; });
}

std::vector<std::string> Judgement::unexplained() const
{
    std::vector<std::string> names;
    for (const SceneJudgement& s : scenes)
        if (s.outcome == SceneJudgement::Outcome::wrong && !is_explained(s, *this))
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

Result<Judgement> judge_pictures(ConformDrawer& drawer, const ConformFolder& folder, const std::vector<Image>& references,
                                 const std::vector<EnginePicture>& pictures, const Jobs& jobs)
{
    return Judge(drawer, pictures, jobs).run(folder, references);
}

} // namespace burnish
