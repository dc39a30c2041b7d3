#include "apps/cli/suggest.h"

#include <algorithm>
#include <cctype>
#include <fmt/core.h>

#include "core/scene/builtin/builtin.h"

namespace burnish {
namespace {

// Counts the letters changed, left out, added or swapped with a neighbour (Damerau 1964, neighbours swapped once).
std::size_t distance(const std::string& a, const std::string& b)
{
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t k = 0; k <= b.size(); ++k) {
            if (i == 0 || k == 0) {
                d[i][k] = i + k;
                continue;
            }
            d[i][k] = std::min({d[i - 1][k] + 1, d[i][k - 1] + 1, d[i - 1][k - 1] + (a[i - 1] != b[k - 1])});
            if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
                d[i][k] = std::min(d[i][k], d[i - 2][k - 2] + 1);
        }
    return d[a.size()][b.size()];
}

bool has_ending(const std::string& name, const std::vector<std::string>& endings)
{
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::any_of(endings.begin(), endings.end(), [&](const std::string& ending) {
        return lower.size() > ending.size() && lower.compare(lower.size() - ending.size(), ending.size(), ending) == 0;
    });
}

bool is_picture(const std::string& name)
{
    return has_ending(name, {".png", ".jpg", ".jpeg", ".exr", ".hdr", ".pfm", ".tif", ".tiff", ".webp"});
}

bool is_scene(const std::string& name)
{
    return has_ending(name, {".gltf", ".glb", ".obj"});
}

bool is_url(const std::string& name)
{
    return name.rfind("http://", 0) == 0 || name.rfind("https://", 0) == 0;
}

std::string builtin_hint(const std::string& name, const std::vector<BuiltinInfo>& infos, const char* what)
{
    std::vector<std::string> names;
    for (const BuiltinInfo& info : infos)
        names.emplace_back(info.name);
    const std::string found = name.find('/') == std::string::npos ? nearest_name(name, names) : "";
    return found.empty() ? "" : fmt::format("the built-in {} is called builtin:{}", what, found);
}

Error with_hint(Error error, const std::string& hint)
{
    if (!hint.empty())
        error.reason += "; " + hint;
    return error;
}

} // namespace

std::string nearest_name(const std::string& word, const std::vector<std::string>& names)
{
    std::string best;
    std::size_t least = 1 + std::min<std::size_t>(3, (word.size() + 1) / 3); // exclusive bound
    constexpr std::size_t kLongest = 64;                                     // longer words are not typing errors
    for (const std::string& name : names) {
        if (word.empty() || word.size() > kLongest)
            break;
        // Counts a part of a name, such as its beginning, as one error.
        const bool part = word.size() >= 3 && name.find(word) != std::string::npos;
        const std::size_t d = name == word ? 0 : part ? 1 : distance(word, name);
        if (d < least)
            least = d, best = name;
    }
    return best;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& names)
{
    const std::string name = nearest_name(word, names);
    return name.empty() ? "" : fmt::format("; did you mean '{}'?", name);
}

bool looks_like_scene(const std::string& word)
{
    return is_scene(word) || word.rfind("builtin:", 0) == 0;
}

std::string builtin_scene_hint(const std::string& word)
{
    return builtin_hint(word, builtin_scenes(), "scene");
}

Error with_scene_hint(Error error, const std::string& scene)
{
    if (is_url(scene))
        return with_hint(std::move(error), "nothing is read over a network: download it first");
    if (is_picture(scene))
        return with_hint(std::move(error),
                         fmt::format("it is named as a picture: to write one, -o {0}; to be lit by one, --env {0}", scene));
    if (has_ending(scene, {".fbx", ".ply", ".stl", ".dae", ".usd", ".usda", ".usdz", ".blend", ".3ds"}))
        return with_hint(std::move(error), "scenes are .gltf, .glb or .obj files: Blender, for instance, exports them");
    return with_hint(std::move(error), builtin_scene_hint(scene));
}

Error with_environment_hint(Error error, const std::string& environment)
{
    if (is_url(environment))
        return with_hint(std::move(error), "nothing is read over a network: download it first");
    if (is_scene(environment))
        return with_hint(std::move(error),
                         fmt::format("it is named as a scene, which is given without --env: burnish render {}", environment));
    return with_hint(std::move(error), builtin_hint(environment, builtin_environments(), "environment"));
}

} // namespace burnish
