#include "tests/unit/golden.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <vector>

#include "core/base/hash.h"
#include "core/image/colour.h"
#include "core/image/io/image_io.h"
#include "core/image/magma.h"
#include "raster/frame/frame.h"

namespace burnish::test {
namespace fs = std::filesystem;
namespace {

// NAME.txt: one line each for the hash, the row checks and the column checks.
struct Checks {
    std::string hash;
    std::vector<std::string> rows, columns;
};

std::vector<std::string> words_of(const std::string& line)
{
    std::istringstream in(line);
    return {std::istream_iterator<std::string>(in), {}};
}

Checks checks_of(const Image& picture)
{
    Checks checks{fmt::format("{:016x}", pixel_hash(picture)), {}, {}};
    const std::size_t w = static_cast<std::size_t>(picture.width), h = static_cast<std::size_t>(picture.height), pixel = 3 * sizeof(float);
    std::vector<std::uint64_t> columns(w, 0);
    for (std::size_t y = 0; y < h; ++y) {
        const std::byte* row = picture.bytes.data() + y * w * pixel;
        checks.rows.push_back(fmt::format("{:08x}", static_cast<std::uint32_t>(hash_bytes(row, w * pixel))));
        for (std::size_t x = 0; x < w; ++x)
            columns[x] = hash_bytes(row + x * pixel, pixel, columns[x]);
    }
    for (std::uint64_t column : columns)
        checks.columns.push_back(fmt::format("{:08x}", static_cast<std::uint32_t>(column)));
    return checks;
}

Checks read_checks(const std::string& path)
{
    std::ifstream file(path);
    std::string hash, rows, columns;
    std::getline(file, hash), std::getline(file, rows), std::getline(file, columns);
    return {hash, words_of(rows), words_of(columns)};
}

std::string text_of(const Checks& checks)
{
    return fmt::format("{}\n{}\n{}\n", checks.hash, fmt::join(checks.rows, " "), fmt::join(checks.columns, " "));
}

// Rounds to 16 bits: sign, exponent and 7 bits of the mantissa, 0.4 % of the value.
float rounded(float value)
{
    return std::bit_cast<float>((std::bit_cast<std::uint32_t>(value) + 0x8000u) & 0xffff0000u);
}

Image rounded(const Image& picture)
{
    Image image = picture;
    std::transform(picture.f32(), picture.f32() + picture.bytes.size() / sizeof(float), image.f32(), [](float v) { return rounded(v); });
    return image;
}

std::string write_picture(const std::string& path, const Image& picture)
{
    fs::create_directories(fs::path(path).parent_path());
    const Status status = write_image(path, picture);
    return status ? "" : status.error().line();
}

// The smallest and largest index where two lists differ.
struct Range {
    std::size_t first = 0, last = 0, count = 0;
};

Range differing(const std::vector<std::string>& a, const std::vector<std::string>& b)
{
    Range range;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] != b[i]) {
            range.first = range.count ? range.first : i;
            range.last = i;
            ++range.count;
        }
    return range;
}

// Differences visible in 16 bits. `map`: relative differences from 1 % or less to 100 % as 0.4 to 1 on a logarithmic scale.
struct Differences {
    int count = 0;
    std::size_t most_at = 0; // the pixel with the largest relative difference
    double most = -1.0;
    Image map;
};

Differences visible_differences(const Image& expected, const Image& actual)
{
    Differences d;
    d.map = make_image(expected.width, expected.height, 1, PixelType::f32);
    const std::size_t pixels = static_cast<std::size_t>(expected.width) * static_cast<std::size_t>(expected.height);
    for (std::size_t i = 0; i < pixels; ++i) {
        double error = 0.0;
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
            const double a = static_cast<double>(expected.f32()[c]), b = static_cast<double>(rounded(actual.f32()[c]));
            const double one = std::abs(a - b) / std::max(std::abs(a), 1e-3);
            error = std::isfinite(one) ? std::max(error, one) : 1.0;
        }
        d.map.f32()[i] = error > 0.0 ? static_cast<float>(std::clamp(1.0 + 0.3 * std::log10(error), 0.4, 1.0)) : 0.0f;
        d.count += error > 0.0;
        if (error > d.most)
            d.most = error, d.most_at = i;
    }
    return d;
}

std::string pixel_text(const Image& picture, std::size_t at)
{
    const std::size_t w = static_cast<std::size_t>(picture.width);
    const float* p = picture.f32() + 3 * at;
    return fmt::format("({}, {}): {} {} {}", at % w, at / w, p[0], p[1], p[2]);
}

testing::AssertionResult explain(const std::string& name, const Image& picture, const std::string& by, const GoldenPlace& place)
{
    const std::string kept = place.kept + "/" + name, left = fmt::format("{}/{}.{}", place.left, name, by);
    testing::AssertionResult failure = testing::AssertionFailure() << name << " by " << by << ": ";
    fs::remove_all(left);
    failure << write_picture(left + "/actual.exr", picture)
            << write_picture(left + "/actual.png", tonemap_to_srgb8(picture, Tonemap::none, 0.0f));
    const Result<Image> golden = read_image(kept + ".exr", Limits{});
    if (!golden)
        return failure << "there is no golden picture (" << golden.error().line() << "). Drawn: " << left;
    failure << write_picture(left + "/expected.png", tonemap_to_srgb8(*golden, Tonemap::none, 0.0f));
    const Checks now = checks_of(picture), then = read_checks(kept + ".txt");
    if (now.rows.size() != then.rows.size() || now.columns.size() != then.columns.size())
        return failure << fmt::format("{}x{} pixels, and the golden picture has {}x{}. Pictures: {}", now.columns.size(), now.rows.size(),
                                      then.columns.size(), then.rows.size(), left);
    const Range rows = differing(now.rows, then.rows), columns = differing(now.columns, then.columns);
    Differences d = visible_differences(*golden, picture);
    for (std::size_t y = 0; y < now.rows.size(); ++y)
        for (std::size_t x = 0; x < now.columns.size(); ++x)
            if (now.rows[y] != then.rows[y] && now.columns[x] != then.columns[x]) {
                float& shown = d.map.f32()[y * now.columns.size() + x];
                shown = std::max(shown, 0.25f);
            }
    failure << write_picture(left + "/difference.png", magma_map(d.map));
    failure << fmt::format("bits differ in {} columns, x {} to {}, and {} rows, y {} to {}; ", columns.count, columns.first, columns.last,
                           rows.count, rows.first, rows.last);
    if (d.count == 0)
        failure << "no value by as much as 0.4 %";
    else
        failure << fmt::format("{} of {} pixels by more than rounding to 0.4 %, the most, {:.3g} of its value, at {}, expected {}", d.count,
                               picture.width * picture.height, d.most, pixel_text(picture, d.most_at), pixel_text(*golden, d.most_at));
    return failure << ". actual, expected and difference: " << left << ". If that is right: tests/bless";
}

testing::AssertionResult bless(const std::string& name, const Image& picture, const GoldenPlace& place)
{
    const std::string kept = place.kept + "/" + name, fault = write_picture(kept + ".exr", rounded(picture));
    const Status status = write_file(kept + ".txt", text_of(checks_of(picture)));
    if (!fault.empty() || !status)
        return testing::AssertionFailure() << fault << (status ? "" : status.error().line());
    return testing::AssertionSuccess();
}

} // namespace

GoldenPlace golden_place()
{
    return {BN_SOURCE_DIR "/tests/golden", BN_BINARY_DIR "/golden", std::getenv("BN_BLESS") != nullptr};
}

testing::AssertionResult is_golden(const std::string& name, const Image& picture, const std::string& by, const GoldenPlace& place)
{
    static std::set<std::string> blessed; // by this process: other instruction sets must draw the same
    if (picture.type != PixelType::f32 || picture.channels != 3)
        return testing::AssertionFailure() << name << ": not a picture of three floats a pixel";
    if (read_checks(place.kept + "/" + name + ".txt").hash == fmt::format("{:016x}", pixel_hash(picture)))
        return testing::AssertionSuccess();
    if (place.bless && blessed.insert(place.kept + "/" + name).second)
        return bless(name, picture, place);
    return explain(name, picture, by, place);
}

std::string fault_of_golden(const std::string& folder)
{
    std::set<std::string> pictures, texts;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            (entry.path().extension() == ".exr" ? pictures : texts).insert(fs::path(entry.path()).replace_extension().string());
    if (pictures != texts || pictures.empty())
        return fmt::format("{} pictures and {} texts", pictures.size(), texts.size());
    for (const std::string& name : pictures) {
        const Result<Image> picture = read_image(name + ".exr", Limits{});
        if (!picture)
            return picture.error().line();
        const Checks checks = read_checks(name + ".txt");
        if (checks.rows.size() != static_cast<std::size_t>(picture->height) ||
            checks.columns.size() != static_cast<std::size_t>(picture->width))
            return name + ": picture and checks are of two sizes";
    }
    return "";
}

} // namespace burnish::test
