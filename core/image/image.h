// Image: pixels in memory, row-major, top row first, channels interleaved.
#pragma once
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace burnish {

// Allocator with 64-byte alignment: memory starts at a cache line.
template <class T> struct LineAllocator {
    using value_type = T;
    static constexpr std::align_val_t kLine{64};

    LineAllocator() = default;
    template <class U> LineAllocator(const LineAllocator<U>&) {}
    T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
    void deallocate(T* at, std::size_t) { ::operator delete(at, kLine); }
    bool operator==(const LineAllocator&) const = default;
};

enum class PixelType : std::uint8_t { u8, u16, f32 };

inline std::size_t pixel_type_bytes(PixelType t)
{
    return t == PixelType::u8 ? 1 : t == PixelType::u16 ? 2 : 4;
}

struct Image {
    int width = 0, height = 0;
    int channels = 0;                                       // 1 gray, 2 gray+alpha, 3 RGB, 4 RGBA; images with named channels may have more
    PixelType type = PixelType::u8;                         // u8 and u16 are normalized; f32 is linear radiance or data
    std::vector<std::byte, LineAllocator<std::byte>> bytes; // width * height * channels * pixel_type_bytes(type)

    bool empty() const { return bytes.empty(); }
    const float* f32() const { return reinterpret_cast<const float*>(bytes.data()); }
    float* f32() { return reinterpret_cast<float*>(bytes.data()); }
};

inline Image make_image(int width, int height, int channels, PixelType type)
{
    Image image{width, height, channels, type, {}};
    image.bytes.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels) *
                       pixel_type_bytes(type));
    return image;
}

} // namespace burnish
