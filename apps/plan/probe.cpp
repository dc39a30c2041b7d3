#include "apps/plan/probe.h"

#include <algorithm>
#include <cmath>

#include "apps/plan/cost.h"
#include "apps/plan/probe_errors.h"
#include "core/base/clock.h"
#include "core/math/scalar_math.h"
#include "shading/lang/records.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

constexpr double kLeastPixels = 14400;          // in a probe, unless the step would be below
constexpr int kLeastStep = 4, kMostStep = 8;    // frame pixels along a probe pixel's side
constexpr float kProbePpd = 0.5f * kDefaultPpd; // between the frame's filter and one as fine as the probe
constexpr int kRandomSamples = 32;              // of mc, for each of two seeds
constexpr std::uint32_t kSeeds[] = {0x51ed270b, 0x2545f491};
constexpr double kPriorShare = 0.25; // the best prefiltered setting's error over its distance to a single fetch; see the notebook
constexpr double kLeastShare = 0.05; // the same at least
constexpr double kMostShare = 0.8;   // the same at most: where noise is skewed, two noisy pictures deceive
constexpr int kMostExposures = 6;    // for HDR-FLIP, over the frame's range
constexpr int kLightSamples = 16;    // on each area light, for each of two seeds
constexpr double kLightPower = 1.9;  // the square of their noise falls with this power of the samples
constexpr double kHiddenShare = 0.3; // error of a method for area lights whose error is hidden, over the noise of one such picture

bool prefiltered(const MaterialTechnique& m)
{
    return !(find_technique(m.technique)->traits & kSamplesLobe);
}

// Returns the error of mc with a setting's samples, relative to one noisy picture's.
double random_share(const MaterialTechnique& s)
{
    return flip_of(static_cast<double>(kRandomSamples) / static_cast<double>(s.samples));
}

// Returns the best prefiltered setting's mean error on a material. A guess by the distance to a single fetch counts where noise hides it.
double own_error(const Moments& m, double fetch)
{
    return std::clamp(error_without_noise(m, kPriorShare * fetch), kLeastShare * fetch, kMostShare * fetch);
}

FrameDesc probe_desc(const FrameDesc& desc)
{
    FrameDesc d = desc;
    const double pixels = static_cast<double>(desc.width) * desc.height;
    const int step = std::clamp(static_cast<int>(std::sqrt(pixels / kLeastPixels)), kLeastStep, kMostStep);
    d.width = (desc.width + step - 1) / step, d.height = (desc.height + step - 1) / step, d.msaa = 1;
    d.by_material.clear();
    d.stages = d.profile = d.parts = d.layers = d.triangle_ids = false;
    return d;
}

// The setting that all others are held against.
const MaterialTechnique& best_setting(const std::vector<MaterialTechnique>& all)
{
    return *std::find_if(all.rbegin(), all.rend(), prefiltered);
}

// Draws the pictures of a probe, and collects their errors.
class Prober {
  public:
    Prober(Session& session, const FrameDesc& desc, bool by_pixel)
        : session_(session), jobs_(*session.parts().jobs), by_pixel_(by_pixel), count_(session.scene().materials.size()),
          lights_(desc.area_way == kAreaWay_off ? 0 : session.tables().area_lights.size()), small_(probe_desc(desc)), seed_(desc.seed),
          all_(plannable_settings()), best_(best_setting(all_))
    {
        if (lights_ > 0)
            small_.area_way = kAreaWay_ltc; // without noise
    }

    // Draws the best prefiltered setting. Finds the pixels' materials and lobes, and the exposures of HDR-FLIP.
    Status draw_best()
    {
        small_.layers = small_.triangle_ids = true;
        Result<Frame> frame = draw(best_, seed_);
        BN_TRY(frame);
        small_.layers = small_.triangle_ids = false;
        materials_ = materials_of(*frame, session_.tables(), count_);
        lobes_ = lobes_of(*frame, small_);
        first_ = std::move(frame->color);
        const FlipExposures range = find_exposures(first_, flip_, jobs_);
        flip_.start_ev = range.start_ev, flip_.stop_ev = range.stop_ev, flip_.exposures = std::min(range.count, kMostExposures);
        flip_.ppd = kProbePpd;
        return {};
    }

    // Draws two independent noisy pictures by mc. Finds its noise and its processor time.
    Status draw_noisy()
    {
        const double begin = process_cpu_ms();
        Noisy noisy;
        BN_TRY(draw_pair({"mc", kRandomSamples}, noisy));
        noisy_ms_ = 0.5 * (process_cpu_ms() - begin);
        finish(noisy);
        moments_ = moments_of(error_of(first_, noisy.one), error_of(first_, noisy.other), noisy.between, materials_);
        noise_ = std::move(noisy);
        return {};
    }

    // Draws the other prefiltered settings. Finds their distances to the best one, and the best one's own error.
    Status draw_prefiltered()
    {
        fetch_.assign(count_, 1.0), fetch_map_.assign(count_, all_.size());
        double fetch_ms = noisy_ms_;
        for (const MaterialTechnique& s : all_) {
            distances_.emplace_back(count_, 0.0);
            maps_.emplace_back();
            if (!prefiltered(s) || (s.technique == best_.technique && s.samples == best_.samples))
                continue;
            const double before = process_cpu_ms();
            const Result<Frame> frame = draw(s, seed_);
            BN_TRY(frame);
            if (s.samples == 1)
                fetch_ms = std::min(fetch_ms, process_cpu_ms() - before);
            maps_.back() = error_of(first_, frame->color);
            distances_.back() = mean_errors(maps_.back(), materials_);
            for (std::size_t m = 0; m < count_ && s.samples == 1; ++m)
                if (distances_.back()[m] < fetch_[m])
                    fetch_[m] = distances_.back()[m], fetch_map_[m] = maps_.size() - 1;
        }
        for (std::size_t m = 0; m < count_; ++m)
            own_.push_back(is_body(m) ? kPriorShare * fetch_[m] : own_error(moments_[m], fetch_[m]));
        double instructions = 0.0;
        for (std::size_t m = 0; m < count_; ++m)
            instructions += materials_.pixels[m] * random_over_fetch(kRandomSamples);
        probe_.ms_per_instruction = std::max(0.0, noisy_ms_ - fetch_ms) / std::max(1.0, instructions);
        return {};
    }

    // Draws area lights by points on them, twice, and by the methods in the list. Finds the methods' errors.
    Status draw_area_lights(const std::vector<AreaLightsSetting>& list)
    {
        if (lights_ == 0)
            return {};
        Noisy noisy;
        small_.area_way = kAreaWay_mc, small_.light_samples = kLightSamples;
        BN_TRY(draw_pair(best_, noisy));
        small_.area_way = kAreaWay_ltc;
        finish(noisy);
        for (const AreaLightsSetting& s : list) {
            ProbedAreaLights& to = probe_.area_lights.emplace_back();
            to.setting = s, to.cost = area_lights_cost(s, lights_);
            if (s.way == kAreaWay_mc) {
                put_noise(noisy, flip_of(det_pow(static_cast<double>(kLightSamples) / s.samples, kLightPower)), to);
                continue;
            }
            if (s.way == kAreaWay_ltc) {
                put_errors(noisy, first_, to);
                continue;
            }
            small_.area_way = s.way;
            const Result<Frame> frame = draw(best_, seed_);
            small_.area_way = kAreaWay_ltc;
            BN_TRY(frame);
            put_errors(noisy, frame->color, to);
        }
        return {};
    }

    // Puts the settings' errors and costs together.
    Probe take(const std::vector<MaterialTechnique>& settings)
    {
        probe_.width = small_.width, probe_.height = small_.height;
        probe_.materials.resize(count_);
        const TechniqueInfo& automatic = technique_of(FrameDesc{});
        const std::vector<double> default_costs = mean_costs({automatic.name, automatic.default_samples}, lobes_, materials_.of, count_);
        const double lights = lights_ > 0 ? area_lights_cost({FrameDesc().area_way, 1}, lights_) : 0.0;
        for (std::size_t m = 0; m < count_; ++m)
            probe_.materials[m].share = materials_.pixels[m] / static_cast<double>(materials_.of.size()),
            probe_.materials[m].default_cost = default_costs[m] + lights;
        const bool any_prefiltered = std::any_of(settings.begin(), settings.end(), prefiltered);
        for (const MaterialTechnique& s : settings)
            put_setting(s, any_prefiltered);
        if (by_pixel_)
            probe_.pixels.material = materials_.of;
        return std::move(probe_);
    }

  private:
    // Two independent noisy pictures, the errors between them, and one picture's mean error by material.
    struct Noisy {
        Image one, other, between;
        double of_pixel = 0.0; // factor on `between` for one picture's error
        std::vector<double> mean;
    };

    Result<Frame> draw(const MaterialTechnique& by, std::uint32_t seed)
    {
        small_.technique = by.technique, small_.samples = by.samples, small_.seed = seed;
        return session_.render(small_);
    }

    Status draw_pair(const MaterialTechnique& by, Noisy& to)
    {
        Result<Frame> one = draw(by, kSeeds[0]), other = draw(by, kSeeds[1]);
        BN_TRY(one);
        BN_TRY(other);
        to.one = std::move(one->color), to.other = std::move(other->color);
        return {};
    }

    Image error_of(const Image& a, const Image& b) const { return flip_hdr(a, b, flip_, jobs_).error; }

    // Noise has no scale: it is filtered as the frame's is filtered.
    void finish(Noisy& noisy) const
    {
        noisy.between = error_of(noisy.one, noisy.other);
        noisy.mean = mean_errors(noisy.between, materials_);
        noisy.of_pixel = noise_filter(noisy.one, noisy.other, noisy.between, flip_, jobs_) * flip_of(0.5);
        for (double& mean : noisy.mean)
            mean *= noisy.of_pixel;
    }

    void put_noise(const Noisy& noisy, double share, ProbedAreaLights& to) const
    {
        for (const double mean : noisy.mean)
            to.error.push_back(std::min(1.0, mean * share));
        if (by_pixel_)
            for (std::size_t p = 0; p < materials_.of.size(); ++p)
                to.of_pixel.push_back(static_cast<float>(static_cast<double>(noisy.between.f32()[p]) * noisy.of_pixel * share));
    }

    void put_errors(const Noisy& noisy, const Image& picture, ProbedAreaLights& to) const
    {
        const Image of_one = error_of(picture, noisy.one), of_other = error_of(picture, noisy.other);
        const std::vector<Moments> moments = moments_of(of_one, of_other, noisy.between, materials_);
        for (std::size_t m = 0; m < count_; ++m)
            to.error.push_back(std::max(0.0, error_without_noise(moments[m], kHiddenShare * noisy.mean[m])));
        for (std::size_t p = 0; by_pixel_ && p < materials_.of.size(); ++p) {
            if (materials_.of[p] == kUnseen) {
                to.of_pixel.push_back(0.0f);
                continue;
            }
            const auto m = static_cast<std::size_t>(materials_.of[p]);
            const double part = 0.5 * (static_cast<double>(of_one.f32()[p]) + static_cast<double>(of_other.f32()[p]));
            to.of_pixel.push_back(static_cast<float>(to.error[m] * part / std::max(1e-30, moments[m].mean)));
        }
    }

    // Returns true for a material whose prefiltered techniques follow light through a whole body. mc samples one interface, so it tells no
    // errors of those.
    bool is_body(std::size_t m) const
    {
        const Material& of = session_.scene().materials[m];
        return small_.glass != 0 && of.transmission > 0.0f && of.ior > 0.0f && !of.unlit;
    }

    // any_prefiltered: a body takes no other settings.
    void put_setting(const MaterialTechnique& s, bool any_prefiltered)
    {
        const std::vector<double> costs = mean_costs(s, lobes_, materials_.of, count_);
        const auto at = static_cast<std::size_t>(
            std::find_if(all_.begin(), all_.end(),
                         [&](const MaterialTechnique& a) { return a.technique == s.technique && a.samples == s.samples; }) -
            all_.begin());
        for (std::size_t m = 0; m < count_; ++m)
            if (materials_.pixels[m] > 0.0 && !(any_prefiltered && !prefiltered(s) && is_body(m)))
                probe_.materials[m].settings.push_back(
                    {s, prefiltered(s) ? sum_of_errors(distances_[at][m], own_[m]) : noise_.mean[m] * random_share(s), costs[m]});
        if (!by_pixel_)
            return;
        probe_.pixels.error.emplace_back(materials_.of.size(), 0.0f);
        for (std::size_t p = 0; p < materials_.of.size(); ++p)
            if (materials_.of[p] != kUnseen)
                probe_.pixels.error.back()[p] = static_cast<float>(pixel_error(s, at, p));
    }

    double pixel_error(const MaterialTechnique& s, std::size_t at, std::size_t p) const
    {
        const auto m = static_cast<std::size_t>(materials_.of[p]);
        if (!prefiltered(s))
            return static_cast<double>(noise_.between.f32()[p]) * noise_.of_pixel * random_share(s);
        const double distance = maps_[at].bytes.empty() ? 0.0 : static_cast<double>(maps_[at].f32()[p]);
        const double part =
            fetch_map_[m] < all_.size() ? static_cast<double>(maps_[fetch_map_[m]].f32()[p]) / std::max(1e-30, fetch_[m]) : 1.0;
        return sum_of_errors(distance, own_[m] * part);
    }

    Session& session_;
    const Jobs& jobs_;
    bool by_pixel_;
    std::size_t count_, lights_; // materials; area lights that give light
    FrameDesc small_;
    std::uint32_t seed_;
    const std::vector<MaterialTechnique> all_;
    const MaterialTechnique& best_;
    Image first_; // by the best setting
    PixelMaterials materials_;
    PixelLobes lobes_;
    FlipOptions flip_;
    Noisy noise_; // of mc
    double noisy_ms_ = 0.0;
    std::vector<Moments> moments_;               // of the best setting against mc
    std::vector<std::vector<double>> distances_; // [setting][material] to the best one
    std::vector<Image> maps_;                    // of the distances
    std::vector<double> fetch_;                  // the better single fetch's, by material
    std::vector<std::size_t> fetch_map_;         // its place
    std::vector<double> own_;                    // errors of the best setting
    Probe probe_;
};

} // namespace

std::vector<MaterialTechnique> plannable_settings()
{
    std::vector<MaterialTechnique> list;
    for (const PlanCost& c : plan_costs())
        list.push_back({c.technique, c.samples});
    return list;
}

std::vector<AreaLightsSetting> plannable_area_lights()
{
    std::vector<AreaLightsSetting> list;
    for (const AreaLightsCost& c : area_lights_costs())
        list.push_back({c.way, c.samples});
    return list;
}

Result<Probe> probe_frame(Session& session, const FrameDesc& desc, const std::vector<MaterialTechnique>& settings,
                          const std::vector<AreaLightsSetting>& area_lights, bool by_pixel)
{
    Prober prober(session, desc, by_pixel);
    BN_TRY(prober.draw_best());
    BN_TRY(prober.draw_noisy());
    BN_TRY(prober.draw_prefiltered());
    BN_TRY(prober.draw_area_lights(area_lights));
    return prober.take(settings);
}

} // namespace burnish
