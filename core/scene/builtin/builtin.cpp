#include "core/scene/builtin/builtin.h"

#include <charconv>
#include <fmt/core.h>
#include <optional>

#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

template <class T, class... Arguments> struct Maker {
    BuiltinInfo info;
    T (*make)(Arguments...);
};
using SceneMaker = Maker<Scene>;
using EnvironmentMaker = Maker<Image, const Jobs*>;

constexpr SceneMaker kScenes[] = {
    {{"teapot", "the Utah teapot in steel, brushed around its axis; highlights run from top to bottom"}, make_teapot},
    {{"spheres", "silver spheres whose highlights run around them: roughness grows to the right, anisotropy upwards"}, make_spheres},
    {{"sphere", "one silver sphere under a lamp, to look at a single lobe; its highlights run around it"}, make_sphere},
    {{"plate", "a smooth brass plate with grooves in circles on a disc, along rays in a sunburst, and crosswise in squares around both; "
               "highlights run across grooves"},
     make_plate},
    {{"lights",
      "a dark room under area lights: plates with level, upright and round highlights, and spheres; for the environment builtin:night",
      false},
     make_lights},
    {{"glass", "balls and a ring of glass on a steel disc with highlights along circles, for technique mc and the reference"}, make_glass},
    {{"bumps",
      "a hammered copper sphere, a steel disc with highlights along circles, a grooved record and tiles; all detail is in their maps"},
     make_bumps},
    {{"lacquer", "balls under clear coats on satin plastic: carbon weave (highlights across its threads), car paint, and steel (highlights "
                 "around it)"},
     make_lacquer},
    {{"cloth", "balls of velvet and felt before a drape of satin, whose highlights run across its threads"}, make_cloth},
    {{"anodised", "turned titanium under oxide of growing thickness, and black glass balls under lustre: colours of thin films"},
     make_anodised},
    {{"shaderballs", "twelve balls with all detail in their maps, and cameras near, far and grazing, for mip filters", false},
     make_shaderballs},
};
constexpr EnvironmentMaker kEnvironments[] = {
    {{"studio", "a dim studio with soft boxes and strips"}, make_studio},
    {{"sky", "a clear sky with a small sun"}, make_sky},
    {{"night", "almost no light, for scenes with their own lights"}, make_night},
};

template <class M, std::size_t N> std::vector<BuiltinInfo> infos(const M (&makers)[N])
{
    std::vector<BuiltinInfo> list;
    for (const M& maker : makers)
        list.push_back(maker.info);
    return list;
}

template <class T, class... Arguments, std::size_t N>
Result<T> make_named(const Maker<T, Arguments...> (&makers)[N], const std::string& name, const char* what, Arguments... arguments)
{
    std::string known;
    for (const Maker<T, Arguments...>& maker : makers) {
        if (name == maker.info.name)
            return maker.make(arguments...);
        known += (known.empty() ? "" : ", ") + std::string(maker.info.name);
    }
    return Error{ExitCode::bad_input, "builtin:" + name, "", "no built-in " + std::string(what) + " has this name; there are " + known};
}

std::vector<ParametricScene>& added_scenes()
{
    static std::vector<ParametricScene> scenes;
    return scenes;
}

// Makes a parametric scene by name; returns nothing where `name` is not one of them.
std::optional<Result<Scene>> make_parametric_scene(const std::string& name)
{
    const std::size_t at = name.find('=');
    for (const ParametricScene& known : parametric_scenes()) {
        if (name.substr(0, at) != known.info.name)
            continue;
        double amount = known.by_default;
        if (at != std::string::npos) {
            const char *from = name.data() + at + 1, *to = name.data() + name.size();
            const std::from_chars_result read = std::from_chars(from, to, amount);
            if (read.ec != std::errc() || read.ptr != to || !(amount >= known.least && amount <= known.most))
                return Error{ExitCode::bad_input, "builtin:" + name, "",
                             fmt::format("what follows = is no number from {:g} to {:g}", known.least, known.most)};
        }
        Scene scene = known.make(amount);
        scene.name = known.info.name;
        return Result<Scene>(std::move(scene));
    }
    return std::nullopt;
}

} // namespace

void add_parametric_scenes(const std::vector<ParametricScene>& scenes)
{
    added_scenes().insert(added_scenes().end(), scenes.begin(), scenes.end());
}

const std::vector<ParametricScene>& parametric_scenes()
{
    return added_scenes();
}

const std::vector<BuiltinInfo>& builtin_scenes()
{
    static const std::vector<BuiltinInfo> list = infos(kScenes);
    return list;
}

const std::vector<BuiltinInfo>& builtin_environments()
{
    static const std::vector<BuiltinInfo> list = infos(kEnvironments);
    return list;
}

bool builtin_is_staged(const std::string& name)
{
    for (const BuiltinInfo& info : builtin_scenes())
        if (name == info.name)
            return info.staged;
    return false;
}

Result<Scene> make_builtin_scene(const std::string& name)
{
    std::optional<Result<Scene>> parametric = make_parametric_scene(name);
    Result<Scene> scene = parametric ? std::move(*parametric) : make_named(kScenes, name, "scene");
    if (scene)
        update_world(*scene);
    return scene;
}

Result<Image> make_builtin_environment(const std::string& name, const Jobs* jobs)
{
    return make_named(kEnvironments, name, "environment", jobs);
}

} // namespace burnish
