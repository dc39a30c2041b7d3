#include "apps/report/pictures.h"

#include <algorithm>
#include <vector>

#include "apps/report/html.h"
#include "core/base/file.h"

namespace burnish {
namespace {

constexpr std::uint64_t kMaxPictureBytes = 64ull << 20;

struct Tap {
    int at = 0;
    float weight = 0.0f;
};

// Returns, for each output pixel, the input pixels it covers with their weights, which sum to 1.
std::vector<std::vector<Tap>> taps(int from, int to)
{
    std::vector<std::vector<Tap>> out(static_cast<std::size_t>(to));
    const double step = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
        const double low = i * step, high = (i + 1) * step;
        for (int k = static_cast<int>(low); k < from && k < high; ++k) {
            const double part = std::min<double>(high, k + 1) - std::max<double>(low, k);
            if (part > 0.0)
                out[static_cast<std::size_t>(i)].push_back({k, static_cast<float>(part / step)});
        }
    }
    return out;
}

// Shrinks to a size that is no larger in either direction.
Image shrink_to(const Image& image, int width, int height)
{
    Image out = make_image(width, height, image.channels, PixelType::f32);
    const auto columns = taps(image.width, width), rows = taps(image.height, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const Tap& row : rows[static_cast<std::size_t>(y)])
                for (const Tap& column : columns[static_cast<std::size_t>(x)])
                    for (int c = 0; c < image.channels; ++c)
                        out.f32()[(y * width + x) * image.channels + c] +=
                            row.weight * column.weight * image.f32()[(row.at * image.width + column.at) * image.channels + c];
    return out;
}

} // namespace

Image shrink(const Image& image, int width)
{
    if (image.width <= width)
        return image;
    return shrink_to(image, width, std::max(1, static_cast<int>(static_cast<double>(image.height) * width / image.width + 0.5)));
}

Image shrink_within(const Image& image, int side)
{
    const int longest = std::max(image.width, image.height);
    if (longest <= side)
        return image;
    const auto shorter = [&](int of) { return std::max(1, static_cast<int>(static_cast<double>(of) * side / longest + 0.5)); };
    return shrink_to(image, shorter(image.width), shorter(image.height));
}

int picture_width(std::size_t rows)
{
    return rows <= 100 ? 480 : rows <= 250 ? 320 : rows <= 600 ? 200 : 120;
}

Result<std::string> data_uri(const std::string& jpeg_file)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(jpeg_file, kMaxPictureBytes);
    BN_TRY(bytes);
    return "data:image/jpeg;base64," + base64(std::string(bytes->begin(), bytes->end()));
}

} // namespace burnish
