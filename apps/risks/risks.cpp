#include "apps/risks/risks.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fmt/core.h>
#include <optional>
#include <string_view>

#include "apps/cli/parse.h"
#include "apps/options/scene_view.h"
#include "apps/risks/path_reader.h"
#include "apps/risks/sky.h"
#include "shading/bake/environment/cube_map.h"
#include "shading/bake/environment/turn.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

enum class Change {
#define BN_RISK_CHANGE(id, what) id,
#include "apps/risks/risks.def"
};

struct Rule {
    const char* entry;
    float (*measure)(const RiskInputs& i);
    Change change;
    const char *readers, *says;
    const char* words;
    bool geometric;
    const char* path;
};

#define BN_RISK_MEASURE(id, value)                                                                                                         \
    float measure_##id(const RiskInputs& i)                                                                                                \
    {                                                                                                                                      \
        return value;                                                                                                                      \
    }
#include "apps/risks/risks.def"

constexpr bool straight = false, geometric = true; // kinds of risks.def
constexpr Rule kRules[] = {
#define BN_RISK(entry, measure, change, readers, says, words, kind, path)                                                                  \
    {#entry, measure_##measure, Change::change, readers, says, words, kind, path},
#include "apps/risks/risks.def"
};

struct Onset {
    const char* entry;
    double s;
};
constexpr Onset kOnsets[] = {
#define BN_ONSET(entry, s) {#entry, s},
#include "apps/risks/onsets.def"
};

static_assert(std::size(kRules) <= 32, "a pixel's rules are the bits of a word");

// An entry's error is a mean over a picture; single pixels fail earlier.
constexpr float kEarly = 0.4f; // fraction of the measure at the onset
constexpr std::size_t kChanges = 0
#define BN_RISK_CHANGE(id, what) +1
#include "apps/risks/risks.def"
    ;
using Changes = std::array<float, kChanges>;
// Least visible differences, by Change, in a pixel's log luminance.
constexpr Changes kSeen = {0.12f, 0.12f, 0.12f, 0.25f, 0.2f, 0.0f};
constexpr float kBlack = 0.1f; // relative to the picture's median luminance: pixels are compared on top of this

constexpr int kLookedAt = 3600, kMostStep = 16; // the small picture's pixels, about; largest step between them
constexpr float kDefaultNdotV = 0.7f;           // for entries whose path does not move the eye
constexpr std::uint8_t kUnmarkedGrey = 48;
struct Active { // a rule that this picture may break
    std::size_t rule;
    float least; // the limit on the rule's measure
    std::string beyond;
};

bool names(const char* beginnings, const std::string& technique)
{
    for (const std::string& word : split(beginnings, ' '))
        if (technique.rfind(word, 0) == 0)
            return true;
    return false;
}

// Returns the place on the rule's path where its failure begins, or none if it begins nowhere.
std::optional<double> onset_of(const Rule& rule)
{
    for (const Onset& onset : kOnsets)
        if (std::string_view(onset.entry) == rule.entry)
            return onset.s;
    return std::nullopt;
}

// Describes a failure's onset for any scene. The eye in the path's own scene and a tilt by two angles become an angle.
std::string onset_words(const PicturePlace& place, const RiskInputs& at)
{
    if (place.options.eye && place.values.starts_with("eye "))
        return fmt::format("seen from lower than {:.0f} degrees above the surface",
                           glm::degrees(std::asin(std::clamp(at.n_dot_v, 0.0f, 1.0f))));
    if (place.values.starts_with("tilt "))
        return fmt::format("a tilt of {:.0f} degrees", glm::degrees(at.tilt));
    return place.values;
}

Result<std::vector<Active>> active_rules(const FrameDesc& desc)
{
    std::vector<Active> out;
    PathReader reader;
    for (std::size_t r = 0; r < std::size(kRules); ++r) {
        const Rule& rule = kRules[r];
        if (!names(rule.readers, technique_of(desc).name))
            continue;
        const std::optional<double> onset = onset_of(rule);
        if (!onset)
            continue;
        const Result<PicturePlace> place = reader.read({rule.entry, split(rule.words, ' '), rule.path, rule.geometric}, *onset);
        BN_TRY(place);
        const RiskInputs at = inputs_of_setting(place->options);
        out.push_back({r, kEarly * rule.measure(at), onset_words(*place, at)});
    }
    return out;
}

float luminance_of(const float* rgb)
{
    return static_cast<float>(kLuminance[0]) * rgb[0] + static_cast<float>(kLuminance[1]) * rgb[1] +
           static_cast<float>(kLuminance[2]) * rgb[2];
}

RiskInputs at_pixel(RiskInputs i, const PixelLayers& at)
{
    const float alpha = at.roughness * at.roughness;
    i.along = alpha * (1.0f + at.anisotropy), i.across = alpha * (1.0f - at.anisotropy);
    return i;
}

bool shaded(const PixelLayers& at)
{
    return at.normal[0] != 0.0f || at.normal[1] != 0.0f || at.normal[2] != 0.0f;
}

// Returns roughness for the lobes that stand for a pixel's lobe: lobes on a line along the grain, one round lobe, one bent lobe.
float narrow_of(const RiskInputs& i)
{
    return std::sqrt(std::max(i.across, 0.3f * i.along));
}
float round_of(const RiskInputs& i)
{
    return std::sqrt(i.alpha());
}
float bent_of(const RiskInputs& i)
{
    return round_of(i) * std::clamp(1.2f - i.eta(), 0.0f, 1.0f);
}

// Examines one picture's pixels.
class Looker {
  public:
    Looker(const Session& session, const FrameDesc& desc, const RiskInputs& inputs, const Frame& frame)
        : sky_(*session.parts().environment), desc_(desc), inputs_(inputs), frame_(frame),
          turn_(sky_from_world(session.parts().environment->rotation_deg))
    {
        turned_ = session.parts().environment->rotation_deg != 0.0f;
        for (const ExtractedLight& light : session.parts().environment->extracted_lights)
            lamps_.push_back({glm::vec3(light.direction[0], light.direction[1], light.direction[2]) * turn_, luminance_of(light.irradiance),
                              0.5f * light.angular_radius});
        black_ = std::max(1e-20f, kBlack * median());
    }
    // Returns the broken rules as bits by index in `active`. `furthest` receives the rule with the largest excess.
    std::uint32_t look(int x, int y, const std::vector<Active>& active, std::uint8_t& furthest) const;

  private:
    struct Lamp {
        glm::vec3 direction; // world space
        float irradiance, radius;
    };
    glm::vec2 extracted_lights(const glm::vec3& n, const glm::vec3& u, const glm::vec3& w, const RiskInputs& i, const glm::vec3& v) const;
    float median() const;
    Changes changes(const PixelLayers& at, const RiskInputs& i, const glm::vec3& v, std::uint32_t asked) const;
    float seen(const glm::vec3& h, const glm::vec3& v, float roughness) const // mirror direction about h, which has any length
    {
        const glm::vec3 d = h * (2.0f * glm::dot(h, v) / glm::dot(h, h)) - v;
        return sky_.luminance(turned_ ? turn_ * d : d, roughness);
    }

    const Sky sky_;
    const FrameDesc& desc_;
    const RiskInputs inputs_;
    const Frame& frame_;
    const glm::mat3 turn_;
    std::vector<Lamp> lamps_;
    bool turned_ = false;
    float black_ = 0.0f;
};

float Looker::median() const
{
    std::vector<float> some;
    const std::size_t pixels = frame_.layers.size(), step = 1 + pixels / 20000;
    for (std::size_t p = 0; p < pixels; p += step)
        if (shaded(frame_.layers[p]))
            some.push_back(luminance_of(frame_.color.f32() + 3 * p));
    if (some.empty())
        return 0.0f;
    const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
    std::nth_element(some.begin(), middle, some.end());
    return *middle;
}

// Returns the luminance in the extracted lights' highlights without masking, for the anisotropic GGX lobe and for the round one.
glm::vec2 Looker::extracted_lights(const glm::vec3& n, const glm::vec3& u, const glm::vec3& w, const RiskInputs& i,
                                   const glm::vec3& v) const
{
    glm::vec2 sum(0.0f);
    const float round = std::max(i.alpha(), 1e-3f), along = std::max(i.along, 1e-3f), across = std::max(i.across, 1e-3f);
    for (const Lamp& lamp : lamps_) {
        const float n_dot_l = glm::dot(n, lamp.direction);
        if (n_dot_l <= 0.0f)
            continue;
        const glm::vec3 h = v + lamp.direction;
        const float hn = glm::dot(h, n), hu = glm::dot(h, u), hw = glm::dot(h, w);
        const auto ggx = [&](float a, float b) { // slope density; the light's size widens the lobe
            const float s = std::max(a, lamp.radius), t = std::max(b, lamp.radius), x = hu / (hn * s), y = hw / (hn * t),
                        k = 1.0f + x * x + y * y;
            return 1.0f / (3.14159265f * s * t * k * k);
        };
        const float other = lamp.irradiance / (4.0f * std::max(i.n_dot_v, 0.05f));
        sum += other * glm::vec2(ggx(along, across), ggx(round, round));
    }
    return sum;
}

// Returns log-luminance differences between the lobe's approximations. Entries not set in `asked` may hold any number.
Changes Looker::changes(const PixelLayers& at, const RiskInputs& i, const glm::vec3& v, std::uint32_t asked) const
{
    const auto wanted = [&](Change change) { return (asked >> static_cast<unsigned>(change) & 1u) != 0; };
    const glm::vec3 n(at.normal[0], at.normal[1], at.normal[2]), u(at.tangent[0], at.tangent[1], at.tangent[2]), w = glm::cross(n, u);
    const float luminance = luminance_of(at.albedo), f0 = 0.04f + (luminance - 0.04f) * at.metalness;
    const float away = 1.0f - i.n_dot_v, away2 = away * away, fresnel = f0 + (1.0f - f0) * away2 * away2 * away;
    const float other = luminance * (1.0f - at.metalness) * sky_.diffuse(turned_ ? turn_ * n : n) + black_;
    // GGX slopes along one axis, density (1 + t^2)^-1.5: five equal parts' medians.
    constexpr float kPlaces[] = {-1.3333f, -0.4364f, 0.0f, 0.4364f, 1.3333f};
    const float narrow = narrow_of(i), round = round_of(i);
    float sum = 0.0f, least = 1e30f, most = 0.0f;
    const auto tap = [&](const glm::vec3& h) {
        const float value = fresnel * seen(h, v, narrow) + other;
        least = std::min(least, value), most = std::max(most, value);
        return value;
    };
    // Gather along the grain, and across if needed
    float middle = 0.0f;
    for (const float t : kPlaces) {
        const float value = tap(n + u * (t * i.along));
        sum += 0.2f * value;
        if (t == 0.0f)
            middle = value;
    }
    if (wanted(Change::around) || wanted(Change::noise))
        for (const float t : {-1.0f, 1.0f})
            tap(n + w * (t * std::max(i.across, 0.01f)));
    // Evaluate the round and the bent approximation
    const float f = fresnel, one = wanted(Change::round) ? f * seen(n, v, round) : 0.0f, stretch = std::min(measure_bend(i), 0.999f);
    const float bent = wanted(Change::bent) ? f * seen(n * (1.0f - stretch) + (v - w * glm::dot(v, w)) * stretch, v, bent_of(i)) : 0.0f;
    const glm::vec2 extracted = f * extracted_lights(n, u, w, i, v); // anisotropic, round
    const auto apart = [](float a, float b) { return std::abs(std::log(a / b)); };
    const float mean = sum + extracted.x, spread = std::log((most + extracted.x) / (least + extracted.x));
    return {apart(mean, one + other + extracted.y), apart(mean, bent + other + extracted.x),
            apart(mean, middle + extracted.x),      spread,
            spread / std::sqrt(i.samples),          1.0f};
}

std::uint32_t Looker::look(int x, int y, const std::vector<Active>& active, std::uint8_t& furthest) const
{
    const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(desc_.width) + static_cast<std::size_t>(x);
    const PixelLayers& at = frame_.layers[pixel];
    const glm::vec3 v = to_eye(desc_.view, desc_.width, desc_.height, x, y);
    RiskInputs i = at_pixel(inputs_, at);
    i.n_dot_v = std::clamp(v.x * at.normal[0] + v.y * at.normal[1] + v.z * at.normal[2], 0.0f, 1.0f);
    // Find the rules beyond their limits
    std::array<float, std::size(kRules)> beyond{};
    std::uint32_t asked = 0;
    for (std::size_t a = 0; a < active.size(); ++a) {
        const Rule& rule = kRules[active[a].rule];
        beyond[a] = rule.measure(i) / active[a].least;
        asked |= beyond[a] > 1.0f ? 1u << static_cast<unsigned>(rule.change) : 0u;
    }
    if (asked == 0)
        return 0;
    // Keep those with a visible change
    const Changes change = changes(at, i, v, asked);
    std::uint32_t bits = 0;
    float far = 0.0f;
    for (std::size_t a = 0; a < active.size(); ++a) {
        const std::size_t kind = static_cast<std::size_t>(kRules[active[a].rule].change);
        if (!(beyond[a] > 1.0f) || change[kind] < kSeen[kind])
            continue;
        bits |= 1u << a;
        if (beyond[a] * change[kind] > far)
            far = beyond[a] * change[kind], furthest = static_cast<std::uint8_t>(2 + active[a].rule);
    }
    return bits;
}

// Returns well separated hues for any rule count.
std::array<std::uint8_t, 3> colour_of(std::size_t rule)
{
    const float hue = std::fmod(0.61803f * static_cast<float>(rule), 1.0f) * 6.0f;
    std::array<std::uint8_t, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c) {
        const float away = std::abs(std::fmod(hue + static_cast<float>(c) * 4.0f, 6.0f) - 3.0f) - 1.0f;
        rgb[c] = static_cast<std::uint8_t>(70.0f + 185.0f * std::clamp(away, 0.0f, 1.0f));
    }
    return rgb;
}

// Returns "lime #b8ff46": the nearest among twelve names, and the bytes.
std::string words_of_colour(std::size_t rule)
{
    constexpr const char* kNames[] = {"red",  "orange", "yellow", "lime",   "green",   "mint",
                                      "cyan", "azure",  "blue",   "violet", "magenta", "pink"};
    const float hue = std::fmod(0.61803f * static_cast<float>(rule), 1.0f);
    const auto name = static_cast<std::size_t>(hue * static_cast<float>(std::size(kNames)) + 0.5f) % std::size(kNames);
    const std::array<std::uint8_t, 3> rgb = colour_of(rule);
    return fmt::format("{} #{:02x}{:02x}{:02x}", kNames[name], rgb[0], rgb[1], rgb[2]);
}

} // namespace

RiskInputs inputs_of_frame(const FrameDesc& desc, const Environment& environment)
{
    RiskInputs i;
    i.samples = static_cast<float>(std::max(1, desc.samples));
    i.axis_k = desc.major_axis_k, i.axis_beta = desc.major_axis_beta;
    i.tilt = glm::length(desc.tilt_rad);
    i.texel = 1.5708f / static_cast<float>(environment.specular.size);
    i.separable = desc.masking != 0 ? 1.0f : 0.0f, i.fit = desc.dfg_fit != 0 ? 1.0f : 0.0f;
    return i;
}

RiskInputs inputs_of_setting(const RenderOptions& o)
{
    Environment environment;
    environment.specular.size = o.environment.cube_size;
    RiskInputs i = inputs_of_frame(o.frame, environment);
    const float roughness = std::max(o.frame.roughness, 0.0f), eta = std::abs(o.frame.anisotropy);
    i.along = roughness * roughness * (1.0f + eta), i.across = roughness * roughness * (1.0f - eta);
    i.n_dot_v = o.eye ? static_cast<float>(o.eye->z / glm::length(*o.eye)) : kDefaultNdotV; // builtin:plate faces +Z
    return i;
}

Result<RiskMap> mark_risks(Session& session, const FrameDesc& desc)
{
    const auto begin = std::chrono::steady_clock::now();
    const Result<std::vector<Active>> active = active_rules(desc);
    BN_TRY(active);
    // Draw a small picture with layers
    const double pixels = static_cast<double>(desc.width) * desc.height;
    const int step = std::clamp(static_cast<int>(std::sqrt(pixels / kLookedAt) + 0.5), 1, kMostStep);
    FrameDesc probe = desc;
    probe.width = (desc.width + step - 1) / step, probe.height = (desc.height + step - 1) / step, probe.msaa = 1;
    probe.samples = 1, probe.light_samples = 1, probe.background = false;
    probe.triangle_ids = probe.parts = probe.stages = probe.profile = false, probe.layers = true;
    const Result<Frame> frame = session.render(probe);
    BN_TRY(frame);
    const Looker looker(session, probe, inputs_of_frame(desc, *session.parts().environment), *frame);
    // Mark its pixels, in parallel over rows
    RiskMap map;
    map.width = probe.width, map.height = probe.height;
    map.marks.assign(frame->layers.size(), 0);
    struct Counts {
        std::array<std::uint64_t, 32> of{};
        std::uint64_t shaded = 0, any = 0;
    };
    std::vector<Counts> counts(static_cast<std::size_t>(probe.height));
    session.parts().jobs->parallel_for(counts.size(), [&](std::size_t y, int) {
        Counts& c = counts[y];
        for (std::size_t x = 0; x < static_cast<std::size_t>(probe.width); ++x) {
            const std::size_t p = y * static_cast<std::size_t>(probe.width) + x;
            if (!shaded(frame->layers[p]))
                continue;
            map.marks[p] = 1;
            const std::uint32_t bits = looker.look(static_cast<int>(x), static_cast<int>(y), *active, map.marks[p]);
            ++c.shaded, c.any += bits != 0;
            for (std::size_t a = 0; a < active->size(); ++a)
                c.of[a] += bits >> a & 1u;
        }
    });
    // Sum the counts and list the findings
    Counts all;
    for (const Counts& c : counts) {
        all.shaded += c.shaded, all.any += c.any;
        for (std::size_t a = 0; a < all.of.size(); ++a)
            all.of[a] += c.of[a];
    }
    const double shaded = static_cast<double>(std::max<std::uint64_t>(1, all.shaded));
    map.share = static_cast<double>(all.any) / shaded;
    for (std::size_t a = 0; a < active->size(); ++a) {
        const Active& rule = (*active)[a];
        if (all.of[a])
            map.findings.push_back({technique_of(desc).name, kRules[rule.rule].entry, kRules[rule.rule].says, rule.beyond,
                                    words_of_colour(rule.rule), static_cast<double>(all.of[a]) / shaded});
    }
    std::stable_sort(map.findings.begin(), map.findings.end(),
                     [](const RiskFinding& a, const RiskFinding& b) { return a.share > b.share; });
    map.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return map;
}

Image risk_picture(const RiskMap& map, int width, int height)
{
    Image out = make_image(width, height, 3, PixelType::u8);
    std::array<std::array<std::uint8_t, 3>, 2 + std::size(kRules)> colours{};
    colours[1].fill(kUnmarkedGrey);
    for (std::size_t rule = 0; rule < std::size(kRules); ++rule)
        colours[2 + rule] = colour_of(rule);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int from = y * map.height / height * map.width + x * map.width / width;
            const std::array<std::uint8_t, 3>& rgb = colours[map.marks[static_cast<std::size_t>(from)]];
            std::memcpy(out.bytes.data() +
                            3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)),
                        rgb.data(), 3);
        }
    return out;
}

std::string risk_lines(const RiskMap& map)
{
    std::string text;
    for (const RiskFinding& f : map.findings)
        text += fmt::format("{}, {:.1f} % of shaded pixels: {} past its limit, {} ({}; {})\n", f.colour, 100.0 * f.share, f.technique,
                            f.beyond, f.says, f.entry);
    return text + fmt::format("{:.1f} % of shaded pixels are past any of them\n", 100.0 * map.share);
}

} // namespace burnish
