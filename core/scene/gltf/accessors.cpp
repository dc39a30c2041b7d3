#include "core/scene/gltf/accessors.h"

#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "core/scene/gltf/buffers.h"

namespace burnish::gltf {

namespace {

std::string place_of(int accessor)
{
    return fmt::format("/accessors/{}", accessor);
}

const Json& accessor_json(const Document& doc, int accessor)
{
    return doc.json["accessors"][static_cast<std::size_t>(accessor)];
}

const Json& view_json(const Document& doc, int view)
{
    return doc.json["bufferViews"][static_cast<std::size_t>(view)];
}

struct Layout {
    std::uint64_t count;
    ComponentType type;
    ElementShape shape;
    bool normalized;
};

Layout layout_of(const Json& json)
{
    return {get_uint(json, "count", 0), static_cast<ComponentType>(get_index(json, "componentType")),
            element_shape(get_string(json, "type")), json.value("normalized", false)};
}

// Checks the accessor against the lengths that the JSON declares, before decoding anything.
void check_fits(const Document& doc, int buffer_view, std::uint64_t offset, const Layout& layout, bool may_stride, const std::string& place)
{
    const Json& json = view_json(doc, buffer_view);
    const std::uint64_t length = get_uint(json, "byteLength", 0), stride = get_uint(json, "byteStride", 0);
    const std::uint64_t element = element_bytes(layout.type, layout.shape);
    if (stride != 0 && !may_stride)
        fail(place, fmt::format("buffer view {} must not have a byteStride", buffer_view));
    if (stride % 4 != 0 || (stride != 0 && stride < element))
        fail(place, fmt::format("the byteStride {} of buffer view {} does not suit elements of {} bytes", stride, buffer_view, element));
    if (!AccessorView::fits(length, offset, stride ? stride : element, layout.count, element))
        fail(place, fmt::format("{} elements of {} bytes from byte {} reach past the end of buffer view {} with {} bytes", layout.count,
                                element, offset, buffer_view, length));
}

AccessorView view_of(Document& doc, int buffer_view, std::uint64_t offset, const Layout& layout, const std::string& place)
{
    const std::uint64_t stride = get_uint(view_json(doc, buffer_view), "byteStride", 0);
    const auto view =
        AccessorView::make(view_bytes(doc, buffer_view), offset, stride, layout.count, layout.type, layout.shape, layout.normalized);
    if (!view)
        fail(place, fmt::format("reaches past the end of buffer view {}", buffer_view));
    return *view;
}

Layout sparse_index_layout(const Json& sparse)
{
    return {get_uint(sparse, "count", 0), static_cast<ComponentType>(get_index(sparse["indices"], "componentType")), {}, false};
}

void check_accessor(Document& doc, int accessor)
{
    const Json& json = accessor_json(doc, accessor);
    const std::string place = place_of(accessor);
    const Layout layout = layout_of(json);
    if (const int view = get_index(json, "bufferView"); view >= 0)
        check_fits(doc, view, get_uint(json, "byteOffset", 0), layout, true, place);
    const auto sparse = json.find("sparse");
    if (sparse == json.end())
        return;
    const std::uint64_t count = get_uint(*sparse, "count", 0);
    if (count > layout.count)
        fail(place + "/sparse/count", fmt::format("{} is more than the accessor's count {}", count, layout.count));
    for (const char* part : {"indices", "values"}) {
        const Json& json_part = (*sparse)[part];
        Layout part_layout = layout;
        if (std::strcmp(part, "indices") == 0)
            part_layout = sparse_index_layout(*sparse);
        part_layout.count = count;
        check_fits(doc, get_index(json_part, "bufferView"), get_uint(json_part, "byteOffset", 0), part_layout, false,
                   place + "/sparse/" + part);
    }
}

// Packs the base elements, then writes the sparse elements over them.
std::vector<std::uint8_t> make_dense(Document& doc, const Json& json, const AccessorView& base, const Layout& layout,
                                     const std::string& place)
{
    const Json& sparse = json["sparse"];
    const std::uint64_t element = element_bytes(layout.type, layout.shape);
    // Copy the base elements
    if (layout.count > UINT64_MAX / element)
        fail(place, "the accessor's size overflows");
    doc.charge(layout.count * element, place);
    std::vector<std::uint8_t> dense(layout.count * element);
    for (std::uint64_t i = 0; i < layout.count; ++i)
        std::memcpy(dense.data() + i * element, base.element(i), element);
    // View the sparse indices and values
    const Json &indices = sparse["indices"], &values = sparse["values"];
    const int index_view = get_index(indices, "bufferView"), value_view = get_index(values, "bufferView");
    Layout value_layout = layout;
    value_layout.count = get_uint(sparse, "count", 0);
    const AccessorView where =
        view_of(doc, index_view, get_uint(indices, "byteOffset", 0), sparse_index_layout(sparse), place + "/sparse/indices");
    const AccessorView what = view_of(doc, value_view, get_uint(values, "byteOffset", 0), value_layout, place + "/sparse/values");
    // Overwrite the sparse elements
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < where.count(); ++i) {
        const std::uint64_t index = where.integer(i);
        if (index < next || index >= layout.count)
            fail(place + "/sparse/indices",
                 fmt::format("index {} at {} is out of order or not below the count {}", index, i, layout.count));
        next = index + 1;
        std::memcpy(dense.data() + index * element, what.element(i), element);
    }
    return dense;
}

} // namespace

void check_accessors(Document& doc)
{
    for (std::size_t i = 0; i < table_size(doc.json, "accessors"); ++i)
        check_accessor(doc, static_cast<int>(i));
}

AccessorView accessor_view(Document& doc, int accessor)
{
    const Json& json = accessor_json(doc, accessor);
    const std::string place = place_of(accessor);
    const Layout layout = layout_of(json);
    if (const auto dense = doc.dense_accessors.find(accessor); dense != doc.dense_accessors.end())
        return *AccessorView::make(dense->second, 0, 0, layout.count, layout.type, layout.shape, layout.normalized);
    AccessorView view = AccessorView::zeros(layout.count, layout.type, layout.shape, layout.normalized);
    if (const int source = get_index(json, "bufferView"); source >= 0)
        view = view_of(doc, source, get_uint(json, "byteOffset", 0), layout, place);
    if (!json.contains("sparse"))
        return view;
    const std::vector<std::uint8_t>& bytes =
        doc.dense_accessors.emplace(accessor, make_dense(doc, json, view, layout, place)).first->second;
    return *AccessorView::make(bytes, 0, 0, layout.count, layout.type, layout.shape, layout.normalized);
}

void check_finite(const AccessorView& view, const std::string& place)
{
    if (view.type() != ComponentType::f32 || view.all_zero())
        return;
    for (std::uint64_t i = 0; i < view.count(); ++i)
        for (int c = 0; c < view.components(); ++c)
            if (!std::isfinite(view.number(i, c)))
                fail(place, fmt::format("component {} of element {} is NaN or infinite", c, i));
}

void check_finite(Document& doc, int accessor, const AccessorView& view)
{
    if (doc.finite_accessors.insert(accessor).second)
        check_finite(view, place_of(accessor));
}

} // namespace burnish::gltf
