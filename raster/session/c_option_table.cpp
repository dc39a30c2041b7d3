// The options of the C interface, one row each.
#include <cmath>

#include "raster/frame/area_light_text.h"
#include "raster/frame/layers.h"
#include "raster/session/c_options.h"
#include "raster/session/c_values.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

constexpr unsigned kLoads = BURNISH_OPEN | BURNISH_OPEN_MESHES, kLights = kLoads | BURNISH_SET_ENVIRONMENT,
                   kDraws = BURNISH_RENDER | BURNISH_REFERENCE;

// A kind of values: the values in words, and their reader.
struct Kind {
    std::string values;
    std::function<Status(CSettings& to, const std::string& text)> set;
};

std::string named(const std::string& type, double least, double most)
{
    const std::string range = range_text(least, most);
    return range.empty() ? type : type + ", " + range;
}

// Each `of` returns the member of CSettings that a row sets.
template <class Of> Kind whole(int least, int most, Of of)
{
    return {most == std::numeric_limits<int>::max() ? fmt::format("int, {} or more", least) : named("int", least, most),
            [=](CSettings& to, const std::string& text) { return put_whole(text, of(to), least, most); }};
}

template <class Of> Kind number(double least, double most, Of of)
{
    return {named("float", least, most), [=](CSettings& to, const std::string& text) { return put_within(text, of(to), least, most); }};
}

template <class Of> Kind vector(const char* type, double least, double most, Of of)
{
    return {named(type, least, most), [=](CSettings& to, const std::string& text) { return put_within(text, of(to), least, most); }};
}

template <class Of> Kind flag(Of of)
{
    return {"bool", [=](CSettings& to, const std::string& text) { return put_flag(text, of(to)); }};
}

// take(settings, index) takes the index of the name.
template <class Take> Kind name(std::vector<std::string> names, Take take)
{
    const std::string values = "one of " + joined(names);
    return {values, [names = std::move(names), take](CSettings& to, const std::string& text) -> Status {
                std::size_t index = 0;
                BN_TRY(put_name(text, names, index));
                take(to, index);
                return {};
            }};
}

// One of some whole numbers.
template <class Of> Kind numeral(const std::vector<int>& numbers, Of of)
{
    std::vector<std::string> names;
    for (const int value : numbers)
        names.push_back(std::to_string(value));
    return name(names, [=](CSettings& to, std::size_t i) { of(to) = numbers[i]; });
}

Kind technique_name()
{
    std::vector<std::string> names = {"auto"};
    for (const TechniqueInfo& technique : techniques())
        if (std::string(technique.name) != "auto")
            names.emplace_back(technique.name);
    return name(names, [names](CSettings& to, std::size_t i) { to.desc.technique = names[i]; });
}

Kind filter_name()
{
    std::vector<std::string> names;
    for (const MipFilterInfo& filter : mip_filters())
        names.emplace_back(filter.name);
    return name(names, [](CSettings& to, std::size_t i) { to.mips.filter = static_cast<MipFilter>(i); });
}

Kind layer_names()
{
    std::vector<std::string> known;
    for (const LayerInfo& layer : layers())
        known.push_back(layer.name);
    return {"names of " + joined(known), [known](CSettings& to, const std::string& text) -> Status {
                if (!to.layers.empty())
                    return wrong_value("layers and aov are one option: give one of them");
                for (std::size_t begin = 0; begin <= text.size();) {
                    const std::size_t end = std::min(text.find(',', begin), text.size());
                    const std::string word = text.substr(begin, end - begin);
                    if (std::find(known.begin(), known.end(), word) == known.end())
                        return wrong_value("'" + word + "' is no layer");
                    if (std::find(to.layers.begin(), to.layers.end(), word) != to.layers.end())
                        return wrong_value("'" + word + "' is given twice");
                    to.layers.push_back(word);
                    begin = end + 1;
                }
                return {};
            }};
}

Kind area_lights()
{
    return {"texts", [](CSettings& to, const std::string& text) -> Status {
                for (std::size_t begin = 0; begin <= text.size();) {
                    const std::size_t end = std::min(text.find(';', begin), text.size());
                    const Result<AreaLight> light = area_light_of(text.substr(begin, end - begin));
                    BN_TRY(light);
                    to.lights.push_back(*light);
                    begin = end + 1;
                }
                return {};
            }};
}

Kind extracted_light_count()
{
    std::vector<std::string> names = {"auto", "off"};
    for (int n = 0; n <= kMaxExtractedLights; ++n)
        names.push_back(std::to_string(n));
    return name(names, [](CSettings& to, std::size_t i) {
        to.open.environment.extracted_lights = i == 0 ? kMaxExtractedLights : i == 1 ? 0 : static_cast<int>(i) - 2;
    });
}

Kind parameter(const ParameterInfo& p)
{
    const std::vector<std::string> names = choices_of(p);
    const std::string values = !names.empty() ? "one of " + joined(names)
                               : p.flag       ? "bool"
                               : p.angles     ? named("2 floats", p.least, p.most)
                               : p.whole      ? named("int", p.least, p.most)
                                              : named("float", p.least, p.most);
    return {values,
            [option = std::string(p.option)](CSettings& to, const std::string& text) { return set_parameter(to.desc, option, text); }};
}

std::string fallback_of(const ParameterInfo& p)
{
    if (const std::vector<std::string> names = choices_of(p); !names.empty())
        return names[static_cast<std::size_t>(p.fallback)];
    if (p.flag)
        return p.fallback != 0.0 ? "true" : "false";
    return p.angles ? fmt::format("{0:g},{0:g}", p.fallback) : fmt::format("{:g}", p.fallback);
}

// Returns the calls that read a parameter.
unsigned calls_of(const ParameterInfo& p)
{
    return p.readers[0] == '\0' || reads("reference", p) ? kDraws : unsigned{BURNISH_RENDER};
}

struct Row {
    const char *name, *help, *fallback; // fallback: empty where the option is unset
    unsigned calls;
    Kind kind;
};

std::vector<Row> picture_rows()
{
    constexpr int kMost = std::numeric_limits<int>::max();
    return {
        {"width", "Pixels", "1280", kDraws, whole(1, kMaxPictureSide, [](CSettings& to) -> int& { return to.desc.width; })},
        {"height", "Pixels", "720", kDraws, whole(1, kMaxPictureSide, [](CSettings& to) -> int& { return to.desc.height; })},
        {"msaa", "Samples a pixel: 1, 2, 4, 8 or 16", "8", BURNISH_RENDER,
         numeral({1, 2, 4, 8, 16}, [](CSettings& to) -> int& { return to.desc.msaa; })},
        {"technique", "Technique for light from the environment", "auto", BURNISH_RENDER, technique_name()},
        {"samples", "Samples of the technique, or samples a pixel of the reference", "", kDraws,
         whole(1, kMost, [](CSettings& to) -> int& { return to.samples.emplace(); })},
        {"roughness", "Overrides the roughness of every material, 0 to 1", "", kDraws,
         number(0, 1, [](CSettings& to) -> float& { return to.desc.roughness; })},
        {"anisotropy", "Overrides the anisotropy of every material, -1 to 1", "", kDraws,
         number(-1, 1,
                [](CSettings& to) -> float& {
                    to.desc.override_anisotropy = true;
                    return to.desc.anisotropy;
                })},
        {"background", "Draws the environment behind the scene", "true", kDraws,
         flag([](CSettings& to) -> bool& { return to.desc.background; })},
        {"texture_anisotropy", "Texture taps at most, 1 to 16", "16", kDraws,
         whole(1, 16, [](CSettings& to) -> int& { return to.desc.texture_anisotropy; })},
        {"eye", "Camera position X,Y,Z, metres", "", kDraws,
         vector("3 floats", -kAny, kAny, [](CSettings& to) -> glm::vec3& { return to.eye.emplace(); })},
        {"target", "Point that the camera looks at; without eye it turns the scene's camera, or moves the framed view", "", kDraws,
         vector("3 floats", -kAny, kAny, [](CSettings& to) -> glm::vec3& { return to.target.emplace(); })},
        {"orbit", "View of the whole scene from AZIMUTH,ELEVATION degrees", "", kDraws,
         vector("2 floats", -kAny, kAny, [](CSettings& to) -> glm::vec2& { return to.orbit_deg.emplace(); })},
        {"fov", "Vertical field of view in degrees; unset: the camera's, else 45", "", kDraws,
         number(0.1, 179, [](CSettings& to) -> float& { return to.fov_deg.emplace(); })},
        {"zoom", "Magnification: shows the scene so many times as large", "1", kDraws,
         number(0.01, 1000, [](CSettings& to) -> float& { return to.zoom; })},
        {"camera",
         "Camera of the scene, by index or name; unset: the first, else the whole scene is shown",
         "",
         kDraws,
         {"int or name",
          [](CSettings& to, const std::string& text) -> Status {
              int index = 0;
              if (!text.empty() && text[0] == '-' && put_whole(text, index, std::numeric_limits<int>::min(), kMost))
                  return wrong_value("'" + text + "' is no index and no name");
              to.camera = text;
              return {};
          }}},
        {"shadows", "Shadows by rays, which scale the lights: off, ratio (of area lights) or on (of lamps and extracted lights too)", "off",
         BURNISH_RENDER, name({"off", "ratio", "on"}, [](CSettings& to, std::size_t i) { to.shadows.of = static_cast<Shadows>(i); })},
        {"shadow_samples", "Samples a pixel for shadows, rounded up to steps of 16", "16", BURNISH_RENDER,
         whole(1, 1 << 20, [](CSettings& to) -> int& { return to.shadows.samples; })},
        {"layers", "Layers of the picture, with commas between: depth, normal, albedo, ...", "", BURNISH_RENDER, layer_names()},
        {"aov", "Another name of layers", "", BURNISH_RENDER, layer_names()},
        {"resolve",
         "Mean of a pixel's samples in 8-bit pictures: linear (before tonemapping), display (after tonemapping) or weighted (by 1 / (1 + "
         "luminance))",
         "display", BURNISH_RENDER,
         name({"linear", "display", "weighted"}, [](CSettings& to, std::size_t i) { to.resolve = static_cast<Resolve>(i); })},
    };
}

std::vector<Row> reference_rows()
{
    return {
        {"reference_mode", "Paths of the reference: direct, shadowed or path", "direct", BURNISH_REFERENCE,
         name({"direct", "shadowed", "path"}, [](CSettings& to, std::size_t i) { to.reference.mode = static_cast<ReferenceMode>(i); })},
        {"bounces", "Bounces of the reference in mode path", "8", BURNISH_REFERENCE,
         whole(0, 1000, [](CSettings& to) -> int& { return to.reference.bounces; })},
        {"reference_textures", "Texture reads of the reference: footprint (filtered over a pixel) or full (at each ray's hit)", "footprint",
         BURNISH_REFERENCE, name({"footprint", "full"}, [](CSettings& to, std::size_t i) { to.reference.full_textures = i == 1; })},
        {"target_error",
         "Relative error at which the reference stops early",
         "",
         BURNISH_REFERENCE,
         {"float, 1e-06 to 1",
          [](CSettings& to, const std::string& text) -> Status {
              float value = 0.0f;
              BN_TRY(put_within(text, value, 1e-6, 1.0));
              to.reference.target_error = static_cast<double>(value);
              return {};
          }}},
    };
}

std::vector<Row> scene_rows()
{
    return {
        {"threads", "Worker threads; 0: all cores", "0", kLoads, whole(0, 1024, [](CSettings& to) -> int& { return to.open.threads; })},
        {"floor", "Floor below the scene: off, shadow, stage or mirror", "off", BURNISH_OPEN,
         name({"off", "shadow", "stage", "mirror"}, [](CSettings& to, std::size_t i) { to.floor.kind = static_cast<FloorKind>(i); })},
        {"light", "Area lights in the words that the program takes, several with ';' between", "", kLoads, area_lights()},
        {"time", "Time in the scene's animation, seconds; unset: the scene at rest", "", BURNISH_OPEN,
         number(0, 1e6, [](CSettings& to) -> float& { return to.moment.seconds.emplace(); })},
        {"animation", "Animation that time refers to, by index", "0", BURNISH_OPEN,
         whole(0, 1000000, [](CSettings& to) -> int& { return to.moment.animation; })},
        {"variant",
         "Variant of the scene's materials, by name; unset: the meshes' own materials",
         "",
         BURNISH_OPEN,
         {"name",
          [](CSettings& to, const std::string& text) -> Status {
              to.moment.variant = text;
              return {};
          }}},
        {"f0", "Reflectance at normal incidence of all materials", "", BURNISH_OPEN,
         vector("3 floats", 0, 1, [](CSettings& to) -> glm::vec3& { return to.overrides.f0.emplace(); })},
        {"mip_filter", "Filter for distant normal and roughness maps", mip_filters()[0].name, BURNISH_OPEN, filter_name()},
        {"mip_kappa", "Share of the normals' covariance that widens lobes, for the kappa filter and taps under mipnet and teacher", "0.7",
         BURNISH_OPEN, number(0, kMostKappa, [](CSettings& to) -> float& { return to.mips.kappa.emplace(); })},
        {"mip_gain", "Scales each level's colours to reflect as much lamp light as the finest level, under ssgt, kappa, mipnet and teacher",
         "off", BURNISH_OPEN, name({"off", "on"}, [](CSettings& to, std::size_t i) { to.mips.gains = i == 1; })},
        {"fallback", "Closed forms where the net of the mipnet filter is worse: auto or off", "auto", BURNISH_OPEN,
         name({"auto", "off"}, [](CSettings& to, std::size_t i) { to.mips.fallback = static_cast<MipFallback>(i); })},
        {"couple", "Weights of base colours and metalness in mip levels: none, or albedo (texels that face light and eye weigh more)",
         "none", BURNISH_OPEN, name({"none", "albedo"}, [](CSettings& to, std::size_t i) { to.mips.couple_albedo = i == 1; })},
        {"color_kernel", "Averaging kernel for base colours and metalness in mip levels", "box", BURNISH_OPEN,
         name({"box", "kaiser"}, [](CSettings& to, std::size_t i) { to.mips.kaiser_colours = i == 1; })},
    };
}

std::vector<Row> environment_rows()
{
    constexpr double kMostTurn = 36000.0, kMostStops = kMaxEnvironmentExposure;
    return {
        {"env_size", "Texels along an edge of the environment's cube map", "512", kLights,
         numeral({16, 32, 64, 128, 256, 512, 1024, 2048}, [](CSettings& to) -> int& { return to.open.environment.cube_size; })},
        {"env_samples", "Samples a texel of the prefiltered environment", "1024", kLights,
         whole(1, 1 << 20, [](CSettings& to) -> int& { return to.open.environment.samples; })},
        {"env_rotation", "Rotation of the environment in degrees", "0", kLights,
         number(-kMostTurn, kMostTurn, [](CSettings& to) -> float& { return to.open.environment.rotation_deg; })},
        {"env_exposure", "Exposure of the environment in stops", "0", kLights,
         number(-kMostStops, kMostStops, [](CSettings& to) -> float& { return to.open.environment.exposure_ev; })},
        {"key_lights", "Small strong lights to extract from the environment and shade one by one, at most", "auto", kLights,
         extracted_light_count()},
        {"cache", "Keeps bakes in the cache", "true", kLights, flag([](CSettings& to) -> bool& { return to.open.environment.use_cache; })},
    };
}

} // namespace

const std::vector<COption>& c_options()
{
    static const std::vector<COption> table = [] {
        std::vector<COption> list;
        for (const auto& rows : {picture_rows(), reference_rows(), scene_rows(), environment_rows()})
            for (const Row& row : rows)
                list.push_back({row.name, row.help, row.kind.values, row.fallback, row.calls, row.kind.set});
        for (const ParameterInfo& p : parameters()) {
            std::string help = p.summary;
            if (const std::size_t at = help.find("{}"); at != std::string::npos)
                help.replace(at, 2, joined(choices_of(p)));
            Kind kind = parameter(p);
            list.push_back({c_name(p.option), help, kind.values, fallback_of(p), calls_of(p), std::move(kind.set)});
        }
        for (COption& option : list)
            option.help = c_words(option.help);
        return list;
    }();
    return table;
}

} // namespace burnish
