#include "core/scene/builtin/builtin.h"

#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

template <class T> struct Maker {
    BuiltinInfo info;
    T (*make)();
};

constexpr Maker<Scene> kScenes[] = {
    {{"teapot", "the Utah teapot in steel, brushed around its axis"}, make_teapot},
    {{"spheres", "silver spheres over roughness (right) and anisotropy (up)"}, make_spheres},
    {{"sphere", "one of them under a lamp, to look at a single lobe"}, make_sphere},
    {{"plate", "a brass plate whose brushing follows a direction texture"}, make_plate},
    {{"lights", "a dark room: brushed plates and spheres under area lights, for --env builtin:night"}, make_lights},
    {{"glass", "balls and a ring of glass on a turned steel disc, for --technique mc and the reference"}, make_glass},
    {{"bumps", "a hammered sphere, a turned disc, a record and tiles: surfaces whose look is in their maps"}, make_bumps},
    {{"lacquer", "a carbon weave, car paint and brushed steel under clear coats, on satin plastic"}, make_lacquer},
    {{"shaderballs", "twelve balls whose look is in their maps, near, far and grazing: for --mip-filter and --camera"}, make_shaderballs},
};
constexpr Maker<Image> kEnvironments[] = {
    {{"studio", "a dim studio with soft boxes and strips"}, make_studio},
    {{"sky", "a clear sky with a small sun"}, make_sky},
    {{"night", "next to no light, for scenes with lights of their own"}, make_night},
};

template <class T, std::size_t N> std::vector<BuiltinInfo> infos(const Maker<T> (&makers)[N])
{
    std::vector<BuiltinInfo> list;
    for (const Maker<T>& maker : makers)
        list.push_back(maker.info);
    return list;
}

template <class T, std::size_t N> Result<T> make_named(const Maker<T> (&makers)[N], const std::string& name, const char* what)
{
    std::string known;
    for (const Maker<T>& maker : makers) {
        if (name == maker.info.name)
            return maker.make();
        known += (known.empty() ? "" : ", ") + std::string(maker.info.name);
    }
    return Error{ExitCode::bad_input, "builtin:" + name, "", "no built-in " + std::string(what) + " has this name; there are " + known};
}

} // namespace

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

Result<Scene> make_builtin_scene(const std::string& name)
{
    Result<Scene> scene = make_named(kScenes, name, "scene");
    if (scene)
        update_world(*scene);
    return scene;
}

Result<Image> make_builtin_environment(const std::string& name)
{
    return make_named(kEnvironments, name, "environment");
}

} // namespace burnish
