// Guards TIFF (revision 6.0, sections 2 and 8): reads the first directory's sizes before the library allocates memory
// for them.
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/image/io/guard.h"

namespace burnish {
namespace {

constexpr unsigned kWidth = 256, kHeight = 257, kBits = 258, kCompression = 259, kPhotometric = 262, kSamples = 277;
constexpr unsigned kTileWidth = 322, kTileHeight = 323;
constexpr unsigned kPrimaries = 319, kSampleFormat = 339, kProfile = 34675;
constexpr std::uint64_t kNoCompression = 1, kPalette = 3, kLogL = 32844, kLogLuv = 32845, kFloat = 3;

class Directory {
  public:
    Directory(const ImageBytes& file, std::uint64_t at) : file_(file), at_(at), little_(file.data[0] == 'I') {}

    bool complete() const { return at_ >= 8 && at_ + 2 <= file_.size && at_ + 2 + 12 * number(at_, 2) <= file_.size; }

    // Returns an entry's first value. Nothing where the entry has no integer type or lies past the file's end.
    std::optional<std::uint64_t> value(unsigned tag) const
    {
        for (std::uint64_t i = 0, n = number(at_, 2); i < n; ++i) {
            const std::uint64_t entry = at_ + 2 + 12 * i;
            if (number(entry, 2) != tag)
                continue;
            const std::uint64_t type = number(entry + 2, 2), count = number(entry + 4, 4);
            const unsigned bytes = type == 1 ? 1 : type == 3 ? 2 : type == 4 ? 4 : 0;
            if (bytes == 0 || count == 0)
                return std::nullopt;
            const std::uint64_t from = count * bytes <= 4 ? entry + 8 : number(entry + 8, 4);
            return from + bytes <= file_.size ? std::optional(number(from, bytes)) : std::nullopt;
        }
        return std::nullopt;
    }

    // Returns an entry's bytes. Nothing where the entry is absent, is not of type UNDEFINED or BYTE, or lies past the file's end.
    std::vector<std::uint8_t> bytes(unsigned tag) const
    {
        for (std::uint64_t i = 0, n = number(at_, 2); i < n; ++i) {
            const std::uint64_t entry = at_ + 2 + 12 * i, type = number(entry + 2, 2), count = number(entry + 4, 4);
            if (number(entry, 2) != tag || (type != 7 && type != 1) || count <= 4)
                continue;
            const std::uint64_t from = number(entry + 8, 4);
            if (from <= file_.size && count <= file_.size - from)
                return {file_.data + from, file_.data + from + count};
        }
        return {};
    }

    bool has(unsigned tag) const
    {
        for (std::uint64_t i = 0, n = number(at_, 2); i < n; ++i)
            if (number(at_ + 2 + 12 * i, 2) == tag)
                return true;
        return false;
    }

    std::uint64_t number(std::uint64_t at, unsigned bytes) const
    {
        std::uint64_t n = 0;
        for (unsigned i = 0; i < bytes; ++i)
            n = n << 8 | file_.data[at + (little_ ? bytes - 1 - i : i)];
        return n;
    }

  private:
    const ImageBytes& file_;
    std::uint64_t at_;
    bool little_;
};

} // namespace

Result<ImageProbe> probe_tiff(const ImageBytes& file, const Limits& limits)
{
    // Find the first directory
    if (file.size < 8)
        return file.error(fmt::format("byte {}", file.size), "the file ends inside its header");
    const Directory directory(file, Directory(file, 0).number(4, 4));
    if (!directory.complete())
        return file.error("byte 4", "the first directory does not lie in the file");
    // Check the sides and the sample format
    const std::optional<std::uint64_t> width = directory.value(kWidth), height = directory.value(kHeight);
    if (!width || !height)
        return file.error("header", "the width or the height is missing");
    BN_TRY(check_sides(file, static_cast<std::int64_t>(*width), static_cast<std::int64_t>(*height), limits));
    const std::uint64_t bits = directory.value(kBits).value_or(1), samples = directory.value(kSamples).value_or(1);
    if (bits < 1 || bits > 64 || samples < 1 || samples > 1024)
        return file.error("header", fmt::format("{} samples a pixel of {} bits", samples, bits));
    // Check that the file can hold the pixels
    if (directory.value(kCompression).value_or(kNoCompression) == kNoCompression && *width * *height * samples / 8 * bits > file.size)
        return file.error(fmt::format("header: {} x {} pixels", *width, *height),
                          fmt::format("{} bytes cannot hold that many pixels", file.size));
    const std::uint64_t pixel = samples * (bits > 8 ? bits / 8 : 1) * (directory.value(kPhotometric).value_or(0) == kPalette ? 3 : 1);
    BN_TRY(check_proportion(file, *width, *height, pixel));
    // The library decodes a whole tile, however small the image.
    const std::uint64_t tile_width = directory.value(kTileWidth).value_or(0), tile_height = directory.value(kTileHeight).value_or(0);
    const std::uint64_t side = static_cast<std::uint64_t>(limits.image_side);
    if (tile_width > side || tile_height > side)
        return file.error("header: tiles", fmt::format("tiles of {} x {} pixels are too large", tile_width, tile_height));
    BN_TRY(check_proportion(file, tile_width, tile_height, pixel));
    // Refuse or warn of unsupported colour encodings
    const std::uint64_t photometric = directory.value(kPhotometric).value_or(0);
    if (photometric == kLogL || photometric == kLogLuv)
        return file.error("header: photometric interpretation", "CIE LogL and LogLuv pixels are not supported");
    ImageProbe probe{"tiff"};
    if (directory.value(kSampleFormat).value_or(1) == kFloat) {
        if (directory.has(kPrimaries) || directory.has(kProfile))
            probe.colour.warnings.push_back("its primaries or colour profile are not read; its colours are taken as linear Rec.709");
    } else {
        probe.colour.profile = directory.bytes(kProfile);
        if (probe.colour.profile.empty() && directory.has(kProfile))
            probe.colour.warnings.push_back("its colour profile is damaged; its colours are taken as sRGB");
        else if (probe.colour.profile.empty() && directory.has(kPrimaries))
            probe.colour.warnings.push_back("its primaries are not read; its colours are taken as sRGB");
    }
    return probe;
}

} // namespace burnish
