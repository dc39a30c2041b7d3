#include "core/scene/gltf/views.h"

#include <cstring>

#include "core/base/check.h"

namespace burnish::gltf {

namespace {

template <class T> T load(const std::uint8_t* p)
{
    T value;
    std::memcpy(&value, p, sizeof(T)); // unaligned: a file may break the alignment rules
    return value;
}

template <class T> float to_number(const std::uint8_t* p, bool normalized, float largest)
{
    const float value = static_cast<float>(load<T>(p));
    if (!normalized)
        return value;
    const float unit = value / largest;
    return unit < -1.0f ? -1.0f : unit; // for -128 / 127
}

alignas(16) const std::uint8_t kZeros[64] = {}; // the size of the largest element, a MAT4 of floats

} // namespace

std::uint64_t component_bytes(ComponentType type)
{
    switch (type) {
    case ComponentType::i8:
    case ComponentType::u8:
        return 1;
    case ComponentType::i16:
    case ComponentType::u16:
        return 2;
    case ComponentType::u32:
    case ComponentType::f32:
        return 4;
    }
    return 4;
}

ElementShape element_shape(const std::string& type)
{
    if (type == "SCALAR")
        return {1, 1};
    const int n = type.back() - '0';
    BN_CHECK(n >= 2 && n <= 4);
    return type.compare(0, 3, "MAT") == 0 ? ElementShape{n, n} : ElementShape{n, 1};
}

std::uint64_t column_bytes(ComponentType type, ElementShape shape)
{
    const std::uint64_t bytes = component_bytes(type) * static_cast<std::uint64_t>(shape.rows);
    return shape.columns > 1 ? (bytes + 3) / 4 * 4 : bytes;
}

std::uint64_t element_bytes(ComponentType type, ElementShape shape)
{
    return column_bytes(type, shape) * static_cast<std::uint64_t>(shape.columns);
}

bool AccessorView::fits(std::uint64_t length, std::uint64_t offset, std::uint64_t stride, std::uint64_t count, std::uint64_t element)
{
    if (count == 0 || stride < element || offset > length || element > length - offset)
        return false;
    return count - 1 <= (length - offset - element) / stride;
}

std::optional<AccessorView> AccessorView::make(std::span<const std::uint8_t> bytes, std::uint64_t offset, std::uint64_t stride,
                                               std::uint64_t count, ComponentType type, ElementShape shape, bool normalized)
{
    const std::uint64_t element = element_bytes(type, shape);
    const std::uint64_t step = stride == 0 ? element : stride;
    if (!fits(bytes.size(), offset, step, count, element))
        return {};
    AccessorView view = zeros(count, type, shape, normalized);
    view.first_ = bytes.data() + offset;
    view.stride_ = step;
    return view;
}

AccessorView AccessorView::zeros(std::uint64_t count, ComponentType type, ElementShape shape, bool normalized)
{
    AccessorView view;
    view.first_ = kZeros;
    view.count_ = count;
    view.type_ = type;
    view.shape_ = shape;
    view.normalized_ = normalized && type != ComponentType::f32;
    return view;
}

float AccessorView::number(std::uint64_t i, int c) const
{
    BN_DCHECK(i < count_ && c < components());
    const std::uint8_t* p = element(i);
    if (shape_.columns > 1)
        p += column_bytes(type_, shape_) * static_cast<std::uint64_t>(c / shape_.rows);
    p += component_bytes(type_) * static_cast<std::uint64_t>(c % shape_.rows);
    switch (type_) {
    case ComponentType::i8:
        return to_number<std::int8_t>(p, normalized_, 127.0f);
    case ComponentType::u8:
        return to_number<std::uint8_t>(p, normalized_, 255.0f);
    case ComponentType::i16:
        return to_number<std::int16_t>(p, normalized_, 32767.0f);
    case ComponentType::u16:
        return to_number<std::uint16_t>(p, normalized_, 65535.0f);
    case ComponentType::u32:
        return to_number<std::uint32_t>(p, normalized_, 4294967296.0f);
    case ComponentType::f32:
        return load<float>(p);
    }
    return 0.0f;
}

std::uint32_t AccessorView::integer(std::uint64_t i) const
{
    BN_DCHECK(i < count_);
    const std::uint8_t* p = element(i);
    return type_ == ComponentType::u8 ? *p : type_ == ComponentType::u16 ? load<std::uint16_t>(p) : load<std::uint32_t>(p);
}

} // namespace burnish::gltf
