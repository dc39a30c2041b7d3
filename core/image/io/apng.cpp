#include "core/image/io/apng.h"

#include <array>
#include <cstring>

#include "core/base/check.h"
#include "core/image/io/png_write.h"

namespace burnish {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kSignature = 8; // bytes before the first chunk

std::array<std::uint32_t, 256> crc_table()
{
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        table[i] = i;
        for (int bit = 0; bit < 8; ++bit)
            table[i] = table[i] & 1u ? 0xedb88320u ^ table[i] >> 1 : table[i] >> 1;
    }
    return table;
}

std::uint32_t crc(const std::uint8_t* data, std::size_t size)
{
    static const std::array<std::uint32_t, 256> table = crc_table();
    std::uint32_t sum = 0xffffffffu;
    for (std::size_t i = 0; i < size; ++i)
        sum = table[(sum ^ data[i]) & 255u] ^ sum >> 8;
    return ~sum;
}

void put(Bytes& to, std::uint32_t value, int bytes = 4)
{
    for (int i = bytes - 1; i >= 0; --i)
        to.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

std::uint32_t number_at(const Bytes& from, std::size_t at)
{
    return static_cast<std::uint32_t>(from[at]) << 24 | static_cast<std::uint32_t>(from[at + 1]) << 16 |
           static_cast<std::uint32_t>(from[at + 2]) << 8 | from[at + 3];
}

void put_chunk(Bytes& to, const char* kind, const Bytes& data)
{
    put(to, static_cast<std::uint32_t>(data.size()));
    const std::size_t begin = to.size();
    to.insert(to.end(), kind, kind + 4);
    to.insert(to.end(), data.begin(), data.end());
    put(to, crc(to.data() + begin, to.size() - begin));
}

} // namespace

Status MovingPicture::add(const std::string& path, const Image& picture)
{
    BN_CHECK(pictures_ == 0 || (picture.width == width_ && picture.height == height_ && picture.channels == channels_));
    const Result<Bytes> png = png_bytes(path, picture);
    BN_TRY(png);
    width_ = picture.width, height_ = picture.height, channels_ = picture.channels;
    // Write the frame's control chunk
    Bytes control; // fcTL
    put(control, sequence_++), put(control, static_cast<std::uint32_t>(width_)), put(control, static_cast<std::uint32_t>(height_));
    put(control, 0), put(control, 0);
    put(control, 1, 2), put(control, static_cast<std::uint32_t>(fps_), 2);
    put(control, 0, 2); // dispose and blend operations: none
    put_chunk(body_, "fcTL", control);
    // Split the PNG: its head once, and its pixel data for each frame
    if (pictures_ == 0)
        head_.assign(png->begin(), png->begin() + kSignature);
    for (std::size_t at = kSignature; at + 12 <= png->size();) {
        const std::size_t size = number_at(*png, at), end = at + 12 + size;
        const bool pixels = std::memcmp(png->data() + at + 4, "IDAT", 4) == 0, last = std::memcmp(png->data() + at + 4, "IEND", 4) == 0;
        const auto chunk = png->begin() + static_cast<std::ptrdiff_t>(at), after = png->begin() + static_cast<std::ptrdiff_t>(end);
        if (pictures_ == 0 && !last) {
            Bytes& to = pixels ? body_ : head_;
            to.insert(to.end(), chunk, after);
        } else if (pixels) {
            Bytes data;
            put(data, sequence_++);
            data.insert(data.end(), chunk + 8, after - 4);
            put_chunk(body_, "fdAT", data);
        }
        at = end;
    }
    ++pictures_;
    return {};
}

std::vector<std::uint8_t> MovingPicture::bytes() const
{
    BN_CHECK(pictures_ > 0);
    Bytes file = head_, count;
    put(count, pictures_), put(count, 0); // 0 plays: repeat forever
    put_chunk(file, "acTL", count);
    file.insert(file.end(), body_.begin(), body_.end());
    put_chunk(file, "IEND", {});
    return file;
}

} // namespace burnish
