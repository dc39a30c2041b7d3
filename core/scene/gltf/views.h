// Bounds-checked views of accessor data: every element of an AccessorView is readable.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace burnish::gltf {

enum class ComponentType : int { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

struct ElementShape {
    int rows = 1, columns = 1; // a vector has one column
};

std::uint64_t component_bytes(ComponentType type);
ElementShape element_shape(const std::string& type); // "VEC3", "MAT4", ...
// Returns a column's size; matrix columns start at multiples of 4 bytes (glTF 2.0, 3.6.2.4).
std::uint64_t column_bytes(ComponentType type, ElementShape shape);
std::uint64_t element_bytes(ComponentType type, ElementShape shape);

class AccessorView {
  public:
    AccessorView() = default;

    // Returns true where `count` elements of `element` bytes, `stride` apart, lie in `length` bytes from `offset`. No
    // input overflows.
    static bool fits(std::uint64_t length, std::uint64_t offset, std::uint64_t stride, std::uint64_t count, std::uint64_t element);
    // Views elements of `shape` in `bytes` from `offset`, `stride` apart (0: packed). Returns nothing where they do not
    // fit.
    static std::optional<AccessorView> make(std::span<const std::uint8_t> bytes, std::uint64_t offset, std::uint64_t stride,
                                            std::uint64_t count, ComponentType type, ElementShape shape, bool normalized);
    // Views `count` zero elements without memory: an accessor without a buffer view.
    static AccessorView zeros(std::uint64_t count, ComponentType type, ElementShape shape, bool normalized);

    std::uint64_t count() const { return count_; }
    ComponentType type() const { return type_; }
    int components() const { return shape_.rows * shape_.columns; }
    explicit operator bool() const { return count_ > 0; }
    bool normalized() const { return normalized_; }
    bool all_zero() const { return stride_ == 0; } // made by zeros(): no memory backs the count

    // Returns component c (column-major) of element i as a float. Maps normalized integers to [0,1] or [-1,1] (glTF
    // 2.0, 3.6.2.2).
    float number(std::uint64_t i, int c) const;
    std::uint32_t integer(std::uint64_t i) const; // for unsigned scalars
    const std::uint8_t* element(std::uint64_t i) const { return first_ + i * stride_; }

  private:
    const std::uint8_t* first_ = nullptr;
    std::uint64_t stride_ = 0, count_ = 0;
    ComponentType type_ = ComponentType::f32;
    ElementShape shape_;
    bool normalized_ = false;
};

} // namespace burnish::gltf
