#include "apps/bake/maps.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <memory>

#include "apps/bake/expression.h"
#include "apps/cli/report.h"

namespace burnish {
namespace {

constexpr std::size_t kMostCharacters = 1000;

} // namespace

Result<Image> rotations_of(const std::vector<std::string>& expressions, const PictureSize& size)
{
    std::vector<std::unique_ptr<Expression>> parsed;
    for (const std::string& text : expressions) {
        if (text.empty() || text.size() > kMostCharacters)
            return usage_error("--expr", fmt::format("is of {} characters, not of 1 to {}", text.size(), kMostCharacters));
        for (std::size_t i = 0; i < text.size(); ++i) { // muParser treats '=' as an assignment
            const auto is = [&](std::size_t at, const char* one_of) {
                return at < text.size() && std::string(one_of).find(text[at]) != std::string::npos;
            };
            if (text[i] == '=' && !is(i + 1, "=") && !(i > 0 && is(i - 1, "=<>!")))
                return usage_error("--expr", fmt::format("'{}' is no expression of u and v: column {}, '='", text, i + 1));
        }
        parsed.push_back(make_expression(text));
    }
    Image out = make_image(size.width, size.height, 3, PixelType::f32);
    float* to = out.f32();
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x, to += 3) {
            const double u = (x + 0.5) / size.width, v = (y + 0.5) / size.height;
            double d[2];
            for (std::size_t i = 0; i < 2; ++i) {
                const Result<double> value = parsed[i]->at(u, v);
                BN_TRY(value);
                if (!(std::abs(*value) < 1e30))
                    return usage_error("--expr",
                                       fmt::format("'{}' is no finite number at texel {},{} (u {:g}, v {:g})", expressions[i], x, y, u, v));
                d[i] = *value;
            }
            const double length = std::sqrt(d[0] * d[0] + d[1] * d[1]);
            if (!(length > 1e-6))
                return usage_error("--expr", fmt::format("both are 0 at texel {},{} (u {:g}, v {:g}): no direction", x, y, u, v));
            to[0] = static_cast<float>(d[0] / length), to[1] = static_cast<float>(d[1] / length), to[2] = 1.0f;
        }
    return out;
}

Image encoded_rotations(const Image& directions, RotationEncoding encoding, PixelType type)
{
    Image out = make_image(directions.width, directions.height, 3, type);
    const std::size_t texels = static_cast<std::size_t>(directions.width) * static_cast<std::size_t>(directions.height);
    for (std::size_t i = 0; i < texels; ++i) {
        double x = static_cast<double>(directions.f32()[3 * i]), y = static_cast<double>(directions.f32()[3 * i + 1]);
        if (encoding == RotationEncoding::double_angle) {
            const double twice = 2.0 * x * y;
            x = x * x - y * y, y = twice;
        }
        const bool unit = encoding == RotationEncoding::direction;
        const double values[3] = {unit ? 0.5 + 0.5 * x : x, unit ? 0.5 + 0.5 * y : y, 1.0};
        for (std::size_t c = 0; c < 3; ++c) {
            const double v = std::clamp(values[c], -1.0, 1.0);
            const bool zero_to_one = unit || c == 2;
            if (type == PixelType::u8)
                out.bytes[3 * i + c] = static_cast<std::byte>(zero_to_one ? std::lround(255.0 * v) : 128 + std::lround(127.0 * v));
            else if (type == PixelType::u16)
                reinterpret_cast<std::uint16_t*>(out.bytes.data())[3 * i + c] =
                    static_cast<std::uint16_t>(zero_to_one ? std::lround(65535.0 * v) : 32768 + std::lround(32767.0 * v));
            else
                out.f32()[3 * i + c] = static_cast<float>(v);
        }
    }
    return out;
}

} // namespace burnish
