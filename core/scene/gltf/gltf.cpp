#include "core/scene/gltf/gltf.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <string_view>

#include "core/base/exception.h"
#include "core/scene/builtin/builtin.h"
#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/buffers.h"
#include "core/scene/gltf/checks.h"
#include "core/scene/gltf/container.h"
#include "core/scene/gltf/graph.h"
#include "core/scene/gltf/image_light.h"
#include "core/scene/gltf/material.h"
#include "core/scene/gltf/mesh.h"
#include "core/scene/gltf/pose.h"
#include "core/scene/gltf/schema.h"
#include "core/scene/gltf/variants.h"
#include "core/scene/obj/obj.h"

namespace burnish {

namespace {

using gltf::Document;

Document document_of(const std::string& path, const Limits& limits, std::span<const std::uint8_t> bytes)
{
    const std::size_t slash = path.find_last_of('/');
    Document doc;
    doc.file = path;
    doc.limits = limits;
    doc.folder = slash == std::string::npos ? "" : slash == 0 ? "/." : path.substr(0, slash);
    doc.has_folder = true;
    doc.bytes = bytes;
    doc.scene.files.push_back(path);
    return doc;
}

void read_structure(Document& doc)
{
    doc.input_bytes = doc.bytes.size();
    gltf::parse_container(doc);
    gltf::check_version_and_extensions(doc);
    gltf::check_schema(doc.json);
    gltf::check_structure(doc);
    gltf::check_image_lights(doc);
}

void read_document(Document& doc, const Moment& moment)
{
    read_structure(doc);
    gltf::check_accessor_rules(doc);
    gltf::check_moving(doc);
    gltf::load_cameras_and_lights(doc);
    gltf::load_buffers(doc);
    gltf::check_accessors(doc);
    gltf::check_values(doc);
    gltf::check_moving_values(doc);
    gltf::set_moment(doc, moment);
    gltf::choose_variant(doc, moment.variant);
    gltf::load_nodes(doc);
    gltf::load_materials(doc);
    gltf::load_meshes(doc);
}

ImageLight image_light_of(Document& doc)
{
    read_structure(doc);
    gltf::load_buffers(doc);
    return gltf::read_image_light(doc);
}

// Runs a reader and turns its exceptions, and exceptions of libraries, into Errors. No exception passes this function.
template <class F> auto guarded(const std::string& file, F&& read) -> decltype(read())
{
    const auto error = [&](std::string place, std::string reason) {
        return Error{ExitCode::bad_input, file, std::move(place), std::move(reason)};
    };
    try {
        return read();
    } catch (const gltf::Failure& failure) {
        return error(failure.place, failure.reason);
    } catch (...) {
        return error_of_exception(error("", "cannot read the file"));
    }
}

} // namespace

Result<Scene> load_gltf(const std::string& path, const Limits& limits, const Moment& moment, const Jobs* jobs)
{
    return guarded(path, [&]() -> Result<Scene> {
        const std::vector<std::uint8_t> bytes = gltf::read_file_bytes(path, limits.file_bytes, "");
        Document doc = document_of(path, limits, bytes);
        doc.jobs = jobs;
        read_document(doc, moment);
        return std::move(doc.scene);
    });
}

Result<ImageLight> load_image_light(const std::string& path, const Limits& limits)
{
    return guarded(path, [&]() -> Result<ImageLight> {
        const std::vector<std::uint8_t> bytes = gltf::read_file_bytes(path, limits.file_bytes, "");
        Document doc = document_of(path, limits, bytes);
        return image_light_of(doc);
    });
}

Result<ImageLight> load_image_light_bytes(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits)
{
    return guarded(label, [&]() -> Result<ImageLight> {
        Document doc;
        doc.file = label;
        doc.limits = limits;
        doc.bytes = {data, size};
        return image_light_of(doc);
    });
}

bool is_gltf(const std::string& path)
{
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        return false;
    char first[4] = {};
    std::ifstream file(path, std::ios::binary);
    if (!(file >> std::ws)) // white space before JSON
        return false;
    file.read(first, sizeof first);
    return first[0] == '{' || std::string_view(first, sizeof first) == "glTF" || path.ends_with(".gltf") || path.ends_with(".glb");
}

Result<Scene> load_gltf_bytes(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits,
                              const Moment& moment, const Jobs* jobs)
{
    return guarded(label, [&]() -> Result<Scene> {
        Document doc;
        doc.file = label;
        doc.limits = limits;
        doc.bytes = {data, size};
        doc.jobs = jobs;
        read_document(doc, moment);
        return std::move(doc.scene);
    });
}

Result<Scene> load_scene(const std::string& spec, const Limits& limits, const Moment& moment, const Jobs* jobs)
{
    const std::string kBuiltin = "builtin:";
    if (!moment.variant.empty() && (spec.compare(0, kBuiltin.size(), kBuiltin) == 0 || is_obj(spec)))
        return Error{ExitCode::bad_input, spec, "", "has no variants (Moment::variant); glTF files may have some"};
    if (moment.seconds && (spec.compare(0, kBuiltin.size(), kBuiltin) == 0 || is_obj(spec)))
        return Error{ExitCode::bad_input, spec, "", "has no animations (Moment::seconds); glTF files may have some"};
    if (spec.compare(0, kBuiltin.size(), kBuiltin) == 0)
        return make_builtin_scene(spec.substr(kBuiltin.size()));
    if (is_obj(spec))
        return guarded(spec, [&]() -> Result<Scene> { return load_obj(spec, limits, jobs); });
    return load_gltf(spec, limits, moment, jobs); // checks the content, not the name
}

} // namespace burnish
