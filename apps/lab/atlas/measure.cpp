#include "apps/lab/atlas/measure.h"

#include <algorithm>
#include <cstring>

#include "core/image/colour.h"
#include "core/image/magma.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "core/image/metrics/pattern.h"
#include "shading/lang/records.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

constexpr double kGone = 0.5;                          // an error is gone if less than this share remains
constexpr int kMoreSamples = 64, kMostSamples = 65536; // for find_kind(): factor and limit for technique and light samples
constexpr int kVerdictSide = 32;                       // pixels of pictures in find_kind(), unless textures matter

// Returns the pixels that show the scene in either picture. Coverage of path-traced pictures is unknown.
std::vector<bool> either_covers(const Picture& reference, const Picture& now)
{
    std::vector<bool> covered = now.covered;
    for (std::size_t i = 0; i < reference.covered.size(); ++i)
        covered[i] = covered[i] || reference.covered[i];
    return covered;
}

// Returns the mean over covered pixels.
double mean_of(const Image& map, const std::vector<bool>& covered)
{
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < covered.size(); ++i)
        if (covered[i])
            sum += static_cast<double>(map.f32()[i]), count += 1.0;
    return count > 0.0 ? sum / count : 0.0;
}

void take_more(FrameDesc& frame)
{
    const TechniqueInfo& technique = *find_technique(frame.technique);
    frame.samples = effective_samples(technique, std::min({frame.samples * kMoreSamples, kMostSamples, technique.most_samples}));
    frame.light_samples = std::min(frame.light_samples * kMoreSamples, static_cast<std::uint32_t>(kMostSamples));
    frame.msaa = kMaxSamples;
}

// Walks the path of one entry.
class Walker {
  public:
    Walker(const AtlasEntry& entry, const AtlasWalk& walk, PictureCache& cache) : entry_(entry), walk_(walk), cache_(cache)
    {
        out_.measured.id = entry.id;
        out_.strip = make_image(walk.side * walk.steps, walk.side * kAtlasRows, 3, PixelType::u8);
    }
    Result<WalkedEntry> walk();

  private:
    Status step(int i);
    Status find_kind();
    // Returns mean HDR-FLIP (LDR-FLIP for displayed pictures) over covered pixels, and its map.
    double difference(const ReferencePicture& exposed_by, const Picture& a, const Picture& b, const std::vector<bool>& covered, Image& map);
    // Returns the error of `now`, by the entry's kind of reference. map: HDR- or LDR-FLIP.
    double error_against(const ReferencePicture& reference, const AtlasEntry& reference_of, const Picture& now, Image& map);
    // more: raises the reference's samples too, if the tile renderer makes it.
    Result<double> error_of(const AtlasSetting& test, const AtlasEntry& reference_of, int step, bool more = false);
    Result<double> error_of(const Picture& now, const AtlasEntry& reference_of, int step, bool more = false);
    void show(AtlasRow row, int column, const Image& shown);
    double place(int i) const { return static_cast<double>(i) / (walk_.steps - 1); }

    const AtlasEntry& entry_;
    const AtlasWalk& walk_;
    PictureCache& cache_;
    WalkedEntry out_;
    std::optional<Picture> before_; // the tested picture
    std::shared_ptr<const ReferencePicture> reference_before_;
};

// Uses the exposures of one reference, so that all figures of a step are comparable.
double Walker::difference(const ReferencePicture& exposed_by, const Picture& a, const Picture& b, const std::vector<bool>& covered,
                          Image& map)
{
    FlipOptions flip;
    flip.isa = cache_.isa();
    if (b.color.type == PixelType::u8) {
        map = flip_ldr(a.color, b.color, flip, cache_.jobs()).error;
    } else {
        const FlipExposures range = find_exposures(exposed_by.picture.color, flip, cache_.jobs());
        flip.start_ev = range.start_ev, flip.stop_ev = range.stop_ev, flip.exposures = range.count;
        map = flip_hdr(a.color, b.color, flip, cache_.jobs()).error;
    }
    return mean_of(map, covered);
}

double Walker::error_against(const ReferencePicture& reference, const AtlasEntry& reference_of, const Picture& now, Image& map)
{
    const std::vector<bool> covered = either_covers(reference.picture, now);
    const double flip = difference(reference, reference.picture, now, covered, map);
    if (reference_of.reference != AtlasReference::pattern)
        return flip;
    const auto with_mask = [&](const Image& rgb) { return with_alpha(rgb, [&](std::size_t i) { return covered[i] ? 1.0f : 0.0f; }); };
    return pattern_figures(with_mask(reference.picture.color), nullptr, with_mask(now.color), cache_.jobs(), &reference.variance).rms;
}

void Walker::show(AtlasRow row, int column, const Image& shown)
{
    const std::size_t bytes = static_cast<std::size_t>(shown.width) * 3;
    for (int y = 0; y < shown.height; ++y)
        std::memcpy(out_.strip.bytes.data() +
                        (static_cast<std::size_t>(static_cast<int>(row) * walk_.side + y) * static_cast<std::size_t>(out_.strip.width) +
                         static_cast<std::size_t>(column * walk_.side)) *
                            3,
                    shown.bytes.data() + static_cast<std::size_t>(y) * bytes, bytes);
}

Status Walker::step(int i)
{
    AtlasStep s;
    s.s = place(i);
    // Render the reference
    const Result<AtlasSetting> of_reference = setting_of(entry_, AtlasRole::reference, s.s, walk_.side, walk_.samples);
    BN_TRY(of_reference);
    const Result<std::shared_ptr<const ReferencePicture>> reference = cache_.reference(*of_reference);
    BN_TRY(reference);
    out_.stopped = !*reference;
    if (out_.stopped)
        return {};
    s.noise = entry_.reference == AtlasReference::pattern ? 0.0 : (*reference)->noise; // patterns are measured without noise
    const auto shown = [&](const Picture& p, const RenderOptions& o) {
        return p.color.type == PixelType::u8 ? p.color : tonemap_to_srgb8(p.color, o.tonemap, o.exposure_ev);
    };
    show(AtlasRow::reference, i, shown((*reference)->picture, of_reference->options));
    // Render the tested picture and its cure, and compare both with the reference
    for (const AtlasRole role : {AtlasRole::test, AtlasRole::cure}) {
        if (role == AtlasRole::cure && (!entry_.cure[0] || (walk_.steps - 1 - i) % walk_.cure_every != 0))
            continue;
        const Result<AtlasSetting> setting = setting_of(entry_, role, s.s, walk_.side, 0);
        BN_TRY(setting);
        Result<Frame> frame = cache_.draw(*setting);
        BN_TRY(frame);
        const bool test = role == AtlasRole::test;
        Picture now = picture_of(*setting, std::move(*frame));
        const std::vector<bool> covered = either_covers((*reference)->picture, now);
        Image map, unused;
        const double error = error_against(**reference, entry_, now, map);
        if (test)
            s.error = error;
        else
            s.cure_error = error;
        show(test ? AtlasRow::test : AtlasRow::cure, i, shown(now, setting->options));
        show(test ? AtlasRow::error : AtlasRow::cure_error, i, magma_map(map));
        if (test && before_) // change beyond the reference's own change
            s.change = difference(**reference, *before_, now, covered, unused) -
                       difference(**reference, reference_before_->picture, (*reference)->picture, covered, unused);
        if (test)
            s.values = setting->values, before_ = std::move(now);
    }
    reference_before_ = *reference;
    out_.measured.steps.push_back(std::move(s));
    return {};
}

// Returns the error of a picture on the path against another entry's reference.
Result<double> Walker::error_of(const AtlasSetting& test, const AtlasEntry& reference_of, int step, bool more)
{
    Result<Frame> frame = cache_.draw(test);
    BN_TRY(frame);
    return error_of(picture_of(test, std::move(*frame)), reference_of, step, more);
}

Result<double> Walker::error_of(const Picture& now, const AtlasEntry& reference_of, int step, bool more)
{
    Result<AtlasSetting> setting = setting_of(reference_of, AtlasRole::reference, place(step), now.color.width, walk_.samples);
    BN_TRY(setting);
    if (more && setting->options.backend != "reference")
        take_more(setting->options.frame);
    const Result<std::shared_ptr<const ReferencePicture>> reference = cache_.reference(*setting);
    BN_TRY(reference);
    out_.stopped = !*reference;
    if (out_.stopped)
        return 0.0;
    Image map;
    return error_against(**reference, reference_of, now, map);
}

Status Walker::find_kind()
{
    MeasuredEntry& m = out_.measured;
    m.kind = "none";
    const auto gone = [](double left, double whole) { return left < kGone * std::max(whole, 1e-9); };
    // Draw the worst step in double precision
    bool precision = false;
    const auto worst =
        std::max_element(m.steps.begin(), m.steps.end(), [](const AtlasStep& a, const AtlasStep& b) { return a.error < b.error; });
    const int at = static_cast<int>(worst - m.steps.begin());
    const Result<AtlasSetting> setting = setting_of(entry_, AtlasRole::test, place(at), walk_.side, 0);
    BN_TRY(setting);
    Result<std::optional<Frame>> in_double = cache_.draw_in_double(*setting);
    BN_TRY(in_double);
    if (*in_double) {
        const Result<double> error = error_of(picture_of(*setting, std::move(**in_double)), entry_, at);
        BN_TRY(error);
        m.in_double = *error, precision = gone(*error, m.worst);
    }
    if (m.onset > 1.0 || out_.stopped)
        return {};
    if (precision) {
        m.kind = "precision";
        return {};
    }
    // Take more samples
    const int side = entry_.reference == AtlasReference::full ? walk_.side : std::min(walk_.side, kVerdictSide);
    const Result<AtlasSetting> few = setting_of(entry_, AtlasRole::test, place(at), side, 0);
    BN_TRY(few);
    const Result<double> few_error = error_of(*few, entry_, at);
    BN_TRY(few_error);
    AtlasSetting more = *few;
    take_more(more.options.frame);
    const Result<double> sampled = error_of(more, entry_, at, true);
    BN_TRY(sampled);
    m.kind = gone(*sampled, *few_error) ? "sampling" : "approximation";
    if (m.kind == "sampling" || entry_.reference != AtlasReference::full)
        return {};
    // Compare with a reference that filters textures alike
    AtlasEntry filtered = entry_;
    filtered.reference = AtlasReference::reference, filtered.reference_words = "";
    const Result<double> alike = error_of(*setting, filtered, at);
    BN_TRY(alike);
    if (gone(*alike, m.worst))
        m.kind = "filtering";
    return {};
}

Result<WalkedEntry> Walker::walk()
{
    for (int i = 0; i < walk_.steps && !out_.stopped; ++i)
        BN_TRY(step(i));
    if (!out_.stopped) {
        summarise(entry_, out_.measured);
        BN_TRY(find_kind());
    }
    return std::move(out_);
}

} // namespace

void summarise(const AtlasEntry& entry, MeasuredEntry& m)
{
    m.onset = 2.0, m.worst = m.flicker = m.cure_worst = m.noise = 0.0;
    for (const AtlasStep& s : m.steps) {
        if (m.onset > 1.0 && s.error > entry.threshold)
            m.onset = s.s;
        m.worst = std::max(m.worst, s.error);
        m.cure_worst = std::max(m.cure_worst, s.cure_error.value_or(0.0));
        m.noise = std::max(m.noise, s.noise);
        m.flicker += s.change / static_cast<double>(std::max<std::size_t>(1, m.steps.size() - 1));
    }
}

Result<WalkedEntry> walk_entry(const AtlasEntry& entry, const AtlasWalk& walk, PictureCache& cache)
{
    return Walker(entry, walk, cache).walk();
}

} // namespace burnish
