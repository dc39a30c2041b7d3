#include "core/scene/gltf/pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "core/math/scalar_math.h"
#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/graph.h"

namespace burnish::gltf {

namespace {

using Numbers = std::vector<double>;

struct Keys {
    AccessorView times, values;
    std::size_t width = 0; // numbers in a key
    bool step = false, cubic = false;

    double time(std::size_t key) const { return static_cast<double>(times.number(key, 0)); }
    // Returns a key's numbers. `part` applies to cubic splines: 0 the in-tangent, 1 the value, 2 the out-tangent.
    Numbers at(std::size_t key, std::size_t part = 1) const
    {
        const std::size_t components = static_cast<std::size_t>(values.components());
        const std::size_t first = (cubic ? 3 * key + part : key) * width;
        Numbers numbers(width);
        for (std::size_t i = 0; i < width; ++i)
            numbers[i] = static_cast<double>(values.number((first + i) / components, static_cast<int>((first + i) % components)));
        return numbers;
    }
};

// Interpolates along the shorter arc at constant speed. Blends nearly equal quaternions linearly.
Numbers slerp(const Numbers& a, Numbers b, double x)
{
    double dot = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
        dot += a[i] * b[i];
    const double sign = dot < 0.0 ? -1.0 : 1.0, angle = det_acos(std::min(std::fabs(dot), 1.0)), sine = det_sin(angle);
    const double from = sine < 1e-6 ? 1.0 - x : det_sin((1.0 - x) * angle) / sine, to = sine < 1e-6 ? x : det_sin(x * angle) / sine;
    for (std::size_t i = 0; i < 4; ++i)
        b[i] = from * a[i] + sign * to * b[i];
    return b;
}

Numbers value_at(const Keys& keys, double time, bool rotation)
{
    const std::size_t count = static_cast<std::size_t>(keys.times.count());
    std::size_t next = 0;
    while (next < count && keys.time(next) <= time)
        ++next;
    if (next == 0 || next == count || keys.step)
        return keys.at(next == 0 ? 0 : next - 1);
    const double length = keys.time(next) - keys.time(next - 1), x = (time - keys.time(next - 1)) / length;
    Numbers a = keys.at(next - 1), b = keys.at(next);
    if (!keys.cubic && rotation)
        return slerp(a, std::move(b), x);
    if (!keys.cubic) {
        for (std::size_t i = 0; i < a.size(); ++i)
            a[i] += x * (b[i] - a[i]);
        return a;
    }
    const Numbers leaving = keys.at(next - 1, 2), arriving = keys.at(next, 0);
    const double x2 = x * x, x3 = x2 * x;
    for (std::size_t i = 0; i < a.size(); ++i)
        a[i] = (2.0 * x3 - 3.0 * x2 + 1.0) * a[i] + length * (x3 - 2.0 * x2 + x) * leaving[i] + (3.0 * x2 - 2.0 * x3) * b[i] +
               length * (x3 - x2) * arriving[i];
    return a;
}

std::size_t targets_of(const Document& doc, const Json& node)
{
    const int mesh = get_index(node, "mesh");
    if (mesh < 0)
        return 0;
    const Json& primitives = doc.json["meshes"][static_cast<std::size_t>(mesh)]["primitives"];
    return primitives.empty() || !primitives[0].contains("targets") ? 0 : primitives[0]["targets"].size();
}

// Reads an animation sampler. Returns false where its data do not fit the target; check_moving() has reported this.
bool read_keys(Document& doc, const Json& sampler, std::size_t width, Keys& keys)
{
    const std::string kind = sampler.value("interpolation", "LINEAR");
    keys.times = accessor_view(doc, get_index(sampler, "input"));
    keys.values = accessor_view(doc, get_index(sampler, "output"));
    keys.width = width;
    keys.step = kind == "STEP", keys.cubic = kind == "CUBICSPLINE";
    const std::uint64_t numbers = keys.values.count() * static_cast<std::uint64_t>(keys.values.components());
    return width > 0 && keys.times && keys.times.components() == 1 && !keys.times.all_zero() &&
           numbers >= keys.times.count() * width * (keys.cubic ? 3 : 1);
}

void move_node(Document& doc, const Json& channel, const Json& samplers, double time, const std::string& place)
{
    const std::string path = get_string(channel["target"], "path");
    const int index = get_index(channel["target"], "node");
    const std::uint64_t sampler = get_uint(channel, "sampler", 0);
    const bool weights = path == "weights";
    if (index < 0 || sampler >= samplers.size() || !(weights || path == "translation" || path == "rotation" || path == "scale"))
        return;
    Json& node = doc.json["nodes"][static_cast<std::size_t>(index)];
    Keys keys;
    if ((!weights && node.contains("matrix")) || !read_keys(doc, samplers[sampler],
                                                            weights              ? targets_of(doc, node)
                                                            : path == "rotation" ? 4
                                                                                 : 3,
                                                            keys))
        return;
    const Numbers numbers = value_at(keys, time, path == "rotation");
    for (const double number : numbers)
        if (!(std::fabs(number) <= 1e30))
            fail(place, fmt::format("gives a {} that is NaN or infinite", path));
    if (path == "rotation" && !is_rotation(numbers.data()))
        fail(place, "gives a rotation that is not a unit quaternion");
    node[path] = numbers;
}

} // namespace

void set_moment(Document& doc, const Moment& moment)
{
    const std::size_t count = table_size(doc.json, "animations");
    if (!moment.seconds) {
        if (count > 0)
            doc.warn("animations are drawn at Moment::seconds only; the scene is drawn as it rests");
        return;
    }
    if (!(*moment.seconds >= 0.0f))
        fail("/animations", "are drawn from 0 s on (Moment::seconds)");
    if (static_cast<std::size_t>(moment.animation) >= count)
        fail("/animations", fmt::format("has no animation {} (Moment::animation); the file has {}", moment.animation, count));
    const Json animation = doc.json["animations"][static_cast<std::size_t>(moment.animation)];
    const std::string place = fmt::format("/animations/{}", moment.animation);
    double end = 0.0;
    for (const Json& sampler : animation["samplers"]) {
        const AccessorView times = accessor_view(doc, get_index(sampler, "input"));
        for (std::uint64_t i = times.all_zero() ? times.count() : 0; i < times.count(); ++i)
            end = std::max(end, static_cast<double>(times.number(i, 0)));
    }
    const double time = static_cast<double>(*moment.seconds);
    if (time > end)
        doc.warn(fmt::format("animation {} ends at {:g} s; drawn as it is then (Moment::seconds)", moment.animation, end));
    for (std::size_t i = 0; i < animation["channels"].size(); ++i)
        move_node(doc, animation["channels"][i], animation["samplers"], time, fmt::format("{}/channels/{}", place, i));
}

std::vector<glm::mat4> instances_of(Document& doc, const Json& node, const std::string& place)
{
    const Json* extension = get_extension(node, "EXT_mesh_gpu_instancing");
    const Json* attributes = extension && extension->is_object() ? get_member(*extension, "attributes") : nullptr;
    if (!attributes || !attributes->is_object())
        return {};
    const char* const names[] = {"TRANSLATION", "ROTATION", "SCALE"};
    const char* const members[] = {"translation", "rotation", "scale"};
    AccessorView views[3];
    std::uint64_t count = 0;
    // View the attributes, and check their sizes
    for (int i = 0; i < 3; ++i) {
        const std::string here = fmt::format("{}/extensions/EXT_mesh_gpu_instancing/attributes/{}", place, names[i]);
        const auto it = attributes->find(names[i]);
        if (it == attributes->end())
            continue;
        if (!it->is_number_unsigned() || it->get<std::uint64_t>() >= table_size(doc.json, "accessors"))
            fail(here, "is no accessor");
        views[i] = accessor_view(doc, it->get<int>());
        if (views[i].components() != (i == 1 ? 4 : 3))
            fail(here, fmt::format("has {} components, {} are needed", views[i].components(), i == 1 ? 4 : 3));
        if (views[i].all_zero())
            fail(here, "has no buffer view");
        check_finite(doc, it->get<int>(), views[i]);
        if (count != 0 && views[i].count() != count)
            fail(here, fmt::format("has {} elements where another attribute has {}", views[i].count(), count));
        count = views[i].count();
    }
    // Compose each instance's matrix
    std::vector<glm::mat4> matrices;
    doc.charge(count * sizeof(Node), place);
    for (std::uint64_t k = 0; k < count; ++k) {
        Json trs = Json::object();
        for (int i = 0; i < 3; ++i)
            for (int c = 0; views[i] && c < views[i].components(); ++c)
                trs[members[i]].push_back(views[i].number(k, c));
        if (views[1] && !is_rotation(trs["rotation"].get<std::array<double, 4>>().data()))
            fail(fmt::format("{}/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION", place),
                 fmt::format("element {} is not a unit quaternion", k));
        matrices.push_back(trs_matrix(trs, fmt::format("{}/extensions/EXT_mesh_gpu_instancing", place)));
    }
    return matrices;
}

} // namespace burnish::gltf
