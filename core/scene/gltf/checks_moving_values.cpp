// Checks the buffer contents of animations, skins, joints and weights, drawn or not.
#include <cmath>
#include <fmt/format.h>

#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/checks.h"

namespace burnish::gltf {

namespace {

// Checks that times begin at 0 or later and grow.
void check_times(Document& doc, int accessor, const std::string& place)
{
    const AccessorView times = accessor_view(doc, accessor);
    if (times.components() != 1 || times.type() != ComponentType::f32 || times.all_zero())
        return;
    for (std::uint64_t i = 0; i < times.count(); ++i) {
        if (times.number(i, 0) < 0.0f)
            return doc.fault(place, fmt::format("time {} is negative", i));
        if (i > 0 && !(times.number(i, 0) > times.number(i - 1, 0)))
            return doc.fault(place, fmt::format("time {} is not later than the one before", i));
    }
}

// Checks a rotation's keys for unit length. A cubic spline has a tangent before and after each key.
void check_quaternions(Document& doc, int accessor, bool cubic, const std::string& place)
{
    const AccessorView keys = accessor_view(doc, accessor);
    if (keys.components() != 4 || keys.all_zero())
        return;
    const double tolerance = keys.type() == ComponentType::f32 ? kUnitTolerance : component_bytes(keys.type()) == 1 ? 0.02 : 1e-3;
    for (std::uint64_t i = cubic ? 1 : 0; i < keys.count(); i += cubic ? 3 : 1) {
        double sum = 0.0;
        for (int c = 0; c < 4; ++c)
            sum += static_cast<double>(keys.number(i, c)) * static_cast<double>(keys.number(i, c));
        if (!(std::abs(std::sqrt(sum) - 1.0) <= tolerance))
            return doc.fault(place, fmt::format("gives a rotation, element {}, that is no unit quaternion", i));
    }
}

void check_animation_values(Document& doc, const Json& animation, const std::string& place)
{
    const Json &samplers = animation["samplers"], &channels = animation["channels"];
    for (std::size_t i = 0; i < samplers.size(); ++i)
        check_times(doc, get_index(samplers[i], "input"), fmt::format("{}/samplers/{}/input", place, i));
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const std::uint64_t sampler = get_uint(channels[i], "sampler", 0);
        if (sampler < samplers.size() && get_string(channels[i]["target"], "path") == "rotation")
            check_quaternions(doc, get_index(samplers[sampler], "output"),
                              samplers[sampler].value("interpolation", "LINEAR") == "CUBICSPLINE",
                              fmt::format("{}/channels/{}/sampler", place, i));
    }
}

void check_matrices(Document& doc, int accessor, const std::string& place)
{
    const AccessorView matrices = accessor_view(doc, accessor);
    if (matrices.components() != 16 || matrices.all_zero())
        return;
    for (std::uint64_t i = 0; i < matrices.count(); ++i)
        for (int column = 0; column < 4; ++column)
            if (matrices.number(i, 4 * column + 3) != (column == 3 ? 1.0f : 0.0f))
                return doc.fault(place, fmt::format("matrix {} has another last row than 0 0 0 1", i));
}

// Returns the least joint count among the skins of nodes with this mesh; without any skin, no limit.
std::uint64_t joints_of_mesh(const Document& doc, std::size_t mesh)
{
    std::uint64_t least = UINT64_MAX;
    for (std::size_t i = 0; i < table_size(doc.json, "nodes"); ++i) {
        const Json& node = doc.json["nodes"][i];
        if (get_index(node, "mesh") == static_cast<int>(mesh) && node.contains("skin"))
            least = std::min<std::uint64_t>(least, doc.json["skins"][node["skin"].get<std::size_t>()]["joints"].size());
    }
    return least;
}

struct VertexInfluences { // one vertex's influences so far
    double sum = 0.0;
    int used = 0;
    std::set<std::uint32_t> joints;
};

// Returns the fault in four of a vertex's influences, or "".
std::string fault_of(const AccessorView& joints, const AccessorView& weights, std::uint64_t vertex, std::uint64_t joint_count,
                     VertexInfluences& all)
{
    for (int c = 0; c < 4; ++c) {
        const double weight = static_cast<double>(weights.number(vertex, c));
        const std::uint32_t joint = static_cast<std::uint32_t>(joints.number(vertex, c));
        if (weight < 0.0)
            return fmt::format("vertex {} has a negative weight", vertex);
        if (joint >= joint_count)
            return fmt::format("vertex {} names joint {}, and the skin has {}", vertex, joint, joint_count);
        if (weight == 0.0)
            continue;
        if (!all.joints.insert(joint).second)
            return fmt::format("vertex {} names joint {} twice", vertex, joint);
        all.sum += weight;
        ++all.used;
    }
    return "";
}

void check_influences(Document& doc, const Json& primitive, std::uint64_t joint_count, const std::string& place)
{
    std::vector<AccessorView> joints, weights;
    const Json& attributes = primitive["attributes"];
    for (int set = 0; attributes.contains(fmt::format("JOINTS_{}", set)) && attributes.contains(fmt::format("WEIGHTS_{}", set)); ++set) {
        joints.push_back(accessor_view(doc, get_index(attributes, fmt::format("JOINTS_{}", set).c_str())));
        weights.push_back(accessor_view(doc, get_index(attributes, fmt::format("WEIGHTS_{}", set).c_str())));
        for (const AccessorView* view : {&joints.back(), &weights.back()})
            if (view->components() != 4 || view->all_zero() || view->count() != joints[0].count())
                return; // already reported
    }
    for (std::uint64_t v = 0; !joints.empty() && v < joints[0].count(); ++v) {
        VertexInfluences all;
        for (std::size_t set = 0; set < joints.size(); ++set)
            if (const std::string reason = fault_of(joints[set], weights[set], v, joint_count, all); !reason.empty())
                return doc.fault(place, reason);
        constexpr double kRounding = 2e-7; // for each weight, by the specification
        const double tolerance = weights[0].type() == ComponentType::f32 ? kRounding * std::max(1, all.used) : 1e-6;
        if (!(std::abs(all.sum - 1.0) <= tolerance))
            return doc.fault(place, fmt::format("the weights of vertex {} add up to {:g}, not to 1", v, all.sum));
    }
}

void check_numbers(Document& doc, std::size_t index)
{
    const AccessorView view = accessor_view(doc, static_cast<int>(index));
    if (view.type() != ComponentType::f32 || view.all_zero())
        return;
    for (std::uint64_t i = 0; i < view.count(); ++i)
        for (int c = 0; c < view.components(); ++c)
            if (!std::isfinite(view.number(i, c)))
                return doc.fault(fmt::format("/accessors/{}", index), fmt::format("component {} of element {} is NaN or infinite", c, i));
}

} // namespace

void check_moving_values(Document& doc)
{
    for (std::size_t i = 0; i < table_size(doc.json, "accessors"); ++i)
        if (doc.json["accessors"][i].contains("bufferView") || doc.json["accessors"][i].contains("sparse"))
            check_numbers(doc, i);
    for (std::size_t i = 0; i < table_size(doc.json, "animations"); ++i)
        check_animation_values(doc, doc.json["animations"][i], fmt::format("/animations/{}", i));
    for (std::size_t i = 0; i < table_size(doc.json, "skins"); ++i)
        if (const Json& skin = doc.json["skins"][i]; skin.contains("inverseBindMatrices"))
            check_matrices(doc, get_index(skin, "inverseBindMatrices"), fmt::format("/skins/{}/inverseBindMatrices", i));
    for (std::size_t m = 0; m < table_size(doc.json, "meshes"); ++m) {
        const Json& primitives = doc.json["meshes"][m]["primitives"];
        const std::uint64_t joints = joints_of_mesh(doc, m);
        for (std::size_t p = 0; p < primitives.size(); ++p)
            if (!get_extension(primitives[p], "KHR_draco_mesh_compression"))
                check_influences(doc, primitives[p], joints, fmt::format("/meshes/{}/primitives/{}/attributes/WEIGHTS_0", m, p));
    }
}

} // namespace burnish::gltf
