#include "core/image/io/icc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

namespace burnish {
namespace {

constexpr std::size_t kHeader = 128;
constexpr std::uint32_t kMostTags = 100;

// XYZ of sRGB's red, green and blue, adapted to D50 by Bradford, as its profiles store them.
constexpr double kSrgb[3][3] = {{0.4361, 0.2225, 0.0139}, {0.3851, 0.7169, 0.0971}, {0.1431, 0.0606, 0.7141}};

struct Profile {
    const std::uint8_t* data;
    std::size_t size;

    std::uint32_t word(std::size_t at) const
    {
        return static_cast<std::uint32_t>(data[at]) << 24 | static_cast<std::uint32_t>(data[at + 1]) << 16 |
               static_cast<std::uint32_t>(data[at + 2]) << 8 | data[at + 3];
    }
    std::string_view name(std::size_t at) const { return {reinterpret_cast<const char*>(data + at), 4}; }

    // Returns the place of a tag with at least `least` bytes.
    std::optional<std::size_t> tag(std::string_view wanted, std::size_t least) const
    {
        for (std::uint32_t i = 0, n = std::min(word(kHeader), kMostTags); i < n; ++i) {
            const std::size_t entry = kHeader + 4 + 12 * std::size_t{i};
            if (entry + 12 > size)
                return std::nullopt;
            const std::size_t at = word(entry + 4), length = word(entry + 8);
            if (name(entry) == wanted)
                return length >= least && at <= size && length <= size - at ? std::optional(at) : std::nullopt;
        }
        return std::nullopt;
    }
    double fixed(std::size_t at) const { return static_cast<double>(static_cast<std::int32_t>(word(at))) / 65536.0; }
};

// Returns the exponent of a tone curve at one half. Nothing for unknown kinds.
std::optional<double> exponent_of(const Profile& p, std::size_t at, std::size_t end)
{
    if (p.name(at) == "curv") {
        const std::size_t count = p.word(at + 8), first = at + 12;
        if (count == 0)
            return 1.0;
        if (count > (end - first) / 2)
            return std::nullopt;
        const auto value = [&](std::size_t i) { return static_cast<double>(p.data[first + 2 * i] << 8 | p.data[first + 2 * i + 1]); };
        if (count == 1)
            return value(0) / 256.0;
        const double half = value(count / 2) / 65535.0, place = static_cast<double>(count / 2) / static_cast<double>(count - 1);
        return half > 0.0 && half < 1.0 ? std::optional(std::log(half) / std::log(place)) : std::nullopt;
    }
    if (p.name(at) == "para" && at + 16 <= end) {
        const int kind = p.data[at + 8] << 8 | p.data[at + 9];
        const double g = p.fixed(at + 12);
        if (kind == 0)
            return g;
        if (kind >= 1 && kind <= 4 && at + 24 <= end) { // (a x + b)^g, straight near black
            const double half = std::pow(std::max(p.fixed(at + 16) * 0.5 + p.fixed(at + 20), 0.0), g);
            return half > 0.0 && half < 1.0 ? std::optional(std::log(half) / std::log(0.5)) : std::nullopt;
        }
    }
    return std::nullopt;
}

} // namespace

std::string profile_warning(const std::uint8_t* data, std::size_t size)
{
    const Profile p{data, size};
    if (size < kHeader + 4 || p.name(36) != "acsp")
        return "its colour profile is damaged; its colours are taken as sRGB";
    const std::string space(p.name(16));
    if (space == "GRAY")
        return "";
    if (space != "RGB ")
        return "its colour profile is of another kind than RGB; its colours are taken as sRGB";
    // Compare primaries
    const char* const kTags[] = {"rXYZ", "gXYZ", "bXYZ"};
    for (int i = 0; i < 3; ++i) {
        const std::optional<std::size_t> at = p.tag(kTags[i], 20);
        if (!at)
            return "its colour profile gives no primaries; its colours are taken as sRGB";
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(p.fixed(*at + 8 + 4 * c) - kSrgb[i][c]) > 0.01)
                return "its colour profile has other primaries than sRGB; its colours are taken as sRGB";
    }
    // Compare the tone curve: sRGB's exponent at one half is 2.22
    const std::optional<std::size_t> curve = p.tag("rTRC", 12);
    const std::optional<double> exponent = curve ? exponent_of(p, *curve, size) : std::nullopt;
    if (!exponent || *exponent < 2.0 || *exponent > 2.45)
        return "its colour profile has another tone curve than sRGB; its colours are taken as sRGB";
    return "";
}

} // namespace burnish
