#include "core/image/io/stored_colour.h"

#include <cmath>

#include "core/base/check.h"

namespace burnish {
namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<double, 9>; // row-major

constexpr Matrix kBradford = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
constexpr double kLeastDeterminant = 1e-6; // of a primaries triangle in xy; Rec.709 has 0.11

Vector multiply(const Matrix& m, const Vector& v)
{
    Vector out{};
    for (std::size_t r = 0; r < 3; ++r)
        out[r] = m[3 * r] * v[0] + m[3 * r + 1] * v[1] + m[3 * r + 2] * v[2];
    return out;
}

Matrix multiply(const Matrix& a, const Matrix& b)
{
    Matrix out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const Vector column = multiply(a, Vector{b[c], b[3 + c], b[6 + c]});
        for (std::size_t r = 0; r < 3; ++r)
            out[3 * r + c] = column[r];
    }
    return out;
}

double determinant(const Matrix& m)
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

// Inverts a matrix with a determinant other than 0.
Matrix inverse(const Matrix& m)
{
    const double d = determinant(m);
    const auto minor = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t e) { return (m[a] * m[b] - m[c] * m[e]) / d; };
    return {minor(4, 8, 5, 7), minor(2, 7, 1, 8), minor(1, 5, 2, 4), minor(5, 6, 3, 8), minor(0, 8, 2, 6),
            minor(2, 3, 0, 5), minor(3, 7, 4, 6), minor(1, 6, 0, 7), minor(0, 4, 1, 3)};
}

Vector white_of(const Primaries& p)
{
    return {p[6] / p[7], 1.0, (1.0 - p[6] - p[7]) / p[7]};
}

// Returns the RGB to XYZ matrix whose white has Y = 1 (SMPTE RP 177). Nothing for collinear primaries or a black white
// point.
std::optional<Matrix> to_xyz(const Primaries& p)
{
    for (const double v : p)
        if (!std::isfinite(v) || std::fabs(v) > 10.0)
            return std::nullopt;
    Matrix columns{};
    for (std::size_t c = 0; c < 3; ++c)
        columns[c] = p[2 * c], columns[3 + c] = p[2 * c + 1], columns[6 + c] = 1.0 - p[2 * c] - p[2 * c + 1];
    if (!(std::fabs(determinant(columns)) > kLeastDeterminant) || !(p[7] > 1e-3))
        return std::nullopt;
    const Vector sums = multiply(inverse(columns), white_of(p));
    for (std::size_t i = 0; i < 9; ++i)
        columns[i] *= sums[i % 3];
    if (!(std::fabs(determinant(columns)) > kLeastDeterminant * kLeastDeterminant))
        return std::nullopt;
    return columns;
}

std::size_t pixels_of(const Image& image)
{
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

} // namespace

std::optional<std::array<double, 9>> matrix_to_rec709(const Primaries& from)
{
    const std::optional<Matrix> stored = to_xyz(from), rec709 = to_xyz(kRec709Primaries);
    if (!stored)
        return std::nullopt;
    const Vector had = multiply(kBradford, white_of(from)), wanted = multiply(kBradford, white_of(kRec709Primaries));
    Matrix adapt{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(had[i] > 1e-6))
            return std::nullopt;
        adapt[4 * i] = wanted[i] / had[i];
    }
    return multiply(inverse(*rec709), multiply(inverse(kBradford), multiply(adapt, multiply(kBradford, *stored))));
}

bool is_rec709(const Primaries& primaries)
{
    constexpr double kRounded = 5e-4;
    for (std::size_t i = 0; i < primaries.size(); ++i)
        if (!(std::fabs(primaries[i] - kRec709Primaries[i]) < kRounded))
            return false;
    return true;
}

std::array<double, 3> luminance_weights(const Primaries& primaries)
{
    const std::optional<Matrix> stored = to_xyz(primaries);
    const Matrix m = stored && (*stored)[4] > 1e-6 ? *stored : *to_xyz(kRec709Primaries);
    return {m[3], m[4], m[5]}; // white has Y = 1
}

void apply_gain(Image& image, const std::array<double, 3>& gain)
{
    if (image.type != PixelType::f32 || gain == std::array<double, 3>{1, 1, 1})
        return;
    const std::size_t channels = static_cast<std::size_t>(image.channels), colours = channels >= 3 ? 3 : 1;
    float* pixel = image.f32();
    for (std::size_t i = 0, n = pixels_of(image); i < n; ++i, pixel += channels)
        for (std::size_t c = 0; c < colours; ++c)
            pixel[c] = static_cast<float>(static_cast<double>(pixel[c]) * gain[c]);
}

void apply_matrix(Image& image, const std::array<double, 9>& to_rec709)
{
    BN_CHECK(image.type == PixelType::f32 && image.channels >= 3);
    float* pixel = image.f32();
    for (std::size_t i = 0, n = pixels_of(image); i < n; ++i, pixel += image.channels) {
        if (!std::isfinite(pixel[0]) || !std::isfinite(pixel[1]) || !std::isfinite(pixel[2]))
            continue;
        const Vector stored = {static_cast<double>(pixel[0]), static_cast<double>(pixel[1]), static_cast<double>(pixel[2])};
        const Vector out = multiply(to_rec709, stored);
        for (std::size_t c = 0; c < 3; ++c)
            pixel[c] = static_cast<float>(out[c]);
    }
}

std::size_t clip_negative_colours(Image& image)
{
    if (image.type != PixelType::f32)
        return 0;
    const int colours = image.channels >= 3 ? 3 : 1;
    std::size_t clipped = 0;
    float* pixel = image.f32();
    for (std::size_t i = 0, n = pixels_of(image); i < n; ++i, pixel += image.channels) {
        bool below = false;
        for (int c = 0; c < colours; ++c)
            if (pixel[c] < 0.0f)
                pixel[c] = 0.0f, below = true;
        clipped += below;
    }
    return clipped;
}

void decode_luminance_chroma(Image& image, const std::array<double, 3>& weights)
{
    BN_CHECK(image.type == PixelType::f32 && image.channels >= 3);
    float* pixel = image.f32();
    for (std::size_t i = 0, n = pixels_of(image); i < n; ++i, pixel += image.channels) {
        const double y = static_cast<double>(pixel[0]);
        const double r = (static_cast<double>(pixel[1]) + 1.0) * y, b = (static_cast<double>(pixel[2]) + 1.0) * y;
        pixel[0] = static_cast<float>(r), pixel[2] = static_cast<float>(b);
        pixel[1] = static_cast<float>((y - weights[0] * r - weights[2] * b) / weights[1]);
    }
}

} // namespace burnish
