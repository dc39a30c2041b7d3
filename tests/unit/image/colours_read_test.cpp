// Colour metadata of files: primaries, factors, luminance and chroma, channel names.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/image/io/image_io.h"
#include "core/image/io/stored_colour.h"
#include "small_files.h"

namespace burnish::colours_read {
namespace {

using test::Bytes;

const Primaries kAcesCg = {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767};
const Primaries kXyz = {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3};

struct Read {
    Image image;
    PictureNotes notes;
};

Read colours(const Bytes& bytes)
{
    Read read;
    Result<Image> image = decode_colours(bytes.data(), bytes.size(), "label", Limits{}, read.notes);
    EXPECT_TRUE(image) << (image ? "" : image.error().line());
    read.image = image ? std::move(*image) : Image{};
    return read;
}

Image stored(const Bytes& bytes)
{
    Result<Image> image = decode_image(bytes.data(), bytes.size(), "label", Limits{});
    EXPECT_TRUE(image) << (image ? "" : image.error().line());
    return image ? std::move(*image) : Image{};
}

Error refusal(const Bytes& bytes)
{
    PictureNotes notes;
    const Result<Image> image = decode_colours(bytes.data(), bytes.size(), "label", Limits{}, notes);
    EXPECT_FALSE(image);
    return image ? Error{ExitCode::ok, "", "", ""} : image.error();
}

std::vector<float> values(const Image& image)
{
    return std::vector<float>(image.f32(), image.f32() + image.bytes.size() / 4);
}

void expect_near(const Image& image, const std::vector<double>& wanted, double within)
{
    const std::vector<float> found = values(image);
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(static_cast<double>(found[i]), wanted[i], within) << "value " << i;
}

test::ExrAttribute chromaticities(const Primaries& p)
{
    std::vector<float> values;
    for (const double v : p)
        values.push_back(static_cast<float>(v));
    return {"chromaticities", "chromaticities", test::floats(values)};
}

// One pixel.
test::ExrPart rgb(float r, float g, float b, const std::vector<test::ExrAttribute>& attributes = {})
{
    return {{{"B", 2, b}, {"G", 2, g}, {"R", 2, r}}, {0, 0, 0, 0}, {0, 0, 0, 0}, "", attributes};
}

// The matrix from ACEScg to linear Rec.709, with Bradford white adaptation, as the Academy's and other tools print it.
TEST(colours, chromaticities_of_acescg_become_rec709)
{
    const test::ExrAttribute said = chromaticities(kAcesCg);
    expect_near(colours(test::make_exr({rgb(1, 0, 0, {said})})).image, {1.70505, -0.13026, -0.02400}, 2e-5);
    expect_near(colours(test::make_exr({rgb(0, 1, 0, {said})})).image, {-0.62179, 1.14080, -0.12897}, 2e-5);
    expect_near(colours(test::make_exr({rgb(0, 0, 1, {said})})).image, {-0.08326, -0.01055, 1.15297}, 2e-5);
    const Read white = colours(test::make_exr({rgb(2, 2, 2, {said})}));
    expect_near(white.image, {2, 2, 2}, 1e-5);
    EXPECT_TRUE(white.notes.converted);
    EXPECT_TRUE(white.notes.warnings.empty());
}

TEST(colours, primaries_on_the_axes_are_xyz)
{
    const test::ExrAttribute said = chromaticities(kXyz);
    expect_near(colours(test::make_exr({rgb(0.5f, 0.5f, 0.5f, {said})})).image, {0.5, 0.5, 0.5}, 1e-6);
    const std::vector<float> one = values(colours(test::make_exr({rgb(0.3f, 0.6f, 0.1f, {said})})).image);
    ASSERT_EQ(one.size(), 3u);
    // Y of both whites is 1. Bradford adaptation changes the luminance of other colours a little.
    EXPECT_NEAR(0.2126 * static_cast<double>(one[0]) + 0.7152 * static_cast<double>(one[1]) + 0.0722 * static_cast<double>(one[2]), 0.6,
                0.02);
}

TEST(colours, rec709_and_silence_keep_every_bit)
{
    const std::vector<float> odd = {0.1f, 1e-30f, 12345.678f};
    const Primaries rounded = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.31271, 0.32902};
    for (const std::vector<test::ExrAttribute>& said :
         {std::vector<test::ExrAttribute>{}, {chromaticities(kRec709Primaries)}, {chromaticities(rounded)}}) {
        const Read read = colours(test::make_exr({rgb(odd[0], odd[1], odd[2], said)}));
        EXPECT_EQ(values(read.image), odd);
        EXPECT_FALSE(read.notes.converted);
    }
    Image image = make_image(5, 3, 3, PixelType::f32);
    for (std::size_t i = 0; i < image.bytes.size() / 4; ++i)
        image.f32()[i] = 0.1f * static_cast<float>(i) - 0.3f;
    const std::string path = test::temporary_folder() + "/own.exr";
    ASSERT_TRUE(write_image(path, image));
    EXPECT_EQ(colours(test::bytes_of(path)).image.bytes, image.bytes);
}

TEST(colours, data_and_grey_and_values_without_end_are_not_converted)
{
    const test::ExrAttribute said = chromaticities(kAcesCg);
    EXPECT_EQ(values(stored(test::make_exr({rgb(0.25f, 0.5f, 1, {said})}))), (std::vector<float>{0.25f, 0.5f, 1}));
    test::ExrPart grey{{{"Y", 2, 0.7f}}, {0, 0, 0, 0}, {0, 0, 0, 0}, "", {said}};
    EXPECT_EQ(values(colours(test::make_exr({grey})).image), (std::vector<float>{0.7f}));
    const float inf = std::numeric_limits<float>::infinity();
    EXPECT_EQ(values(colours(test::make_exr({rgb(inf, 1, 2, {said})})).image), (std::vector<float>{inf, 1, 2}));
}

TEST(colours, what_cannot_be_converted_is_said)
{
    const auto warned = [](const test::ExrAttribute& said, const std::string& needle) {
        const Read read = colours(test::make_exr({rgb(0.25f, 0.5f, 1, {said})}));
        EXPECT_EQ(values(read.image), (std::vector<float>{0.25f, 0.5f, 1}));
        ASSERT_EQ(read.notes.warnings.size(), 1u) << said.name;
        EXPECT_NE(read.notes.warnings[0].find(needle), std::string::npos) << read.notes.warnings[0];
    };
    warned(chromaticities({}), "primaries");
    warned(chromaticities({0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.0}), "primaries");
    warned(chromaticities({0.6, 0.3, 0.6, 0.3, 0.6, 0.3, 0.3127, 0.329}), "primaries");
    warned({"chromaticities", "string", "Rec.709"}, "chromaticities");
    warned({"adoptedNeutral", "v2f", test::floats({0.35f, 0.36f})}, "adoptedNeutral");
    warned({"oiio:ColorSpace", "string", "ACEScg"}, "ACEScg");
    warned({"colorInteropID", "string", "lin_ap1_scene"}, "lin_ap1_scene");
    warned({"envmap", "envmap", "\x07"}, "envmap");
}

TEST(colours, what_changes_nothing_is_not_said)
{
    for (const test::ExrAttribute& said : {test::ExrAttribute{"adoptedNeutral", "v2f", test::floats({0.3127f, 0.329f})},
                                           {"whiteLuminance", "float", test::floats({100.0f})},
                                           {"oiio:ColorSpace", "string", "Linear"},
                                           {"colorInteropID", "string", "lin_rec709_scene"},
                                           {"envmap", "envmap", std::string(1, '\0')}}) {
        const Read read = colours(test::make_exr({rgb(0.25f, 0.5f, 1, {said})}));
        EXPECT_TRUE(read.notes.warnings.empty()) << said.name << ": " << read.notes.warnings[0];
        EXPECT_FALSE(read.notes.cube_faces);
    }
    EXPECT_TRUE(colours(test::make_exr({rgb(1, 1, 1, {{"envmap", "envmap", "\x01"}})})).notes.cube_faces);
}

TEST(colours, luminance_and_chroma_become_rgb)
{
    // Rec.709 red 0.5, green 0.25, blue 1.
    const float y = 0.2126390f * 0.5f + 0.7151687f * 0.25f + 0.0721923f * 1.0f;
    test::ExrPart part{{{"BY", 2, (1.0f - y) / y}, {"RY", 2, (0.5f - y) / y}, {"Y", 2, y}}, {0, 0, 0, 0}, {0, 0, 0, 0}, ""};
    expect_near(colours(test::make_exr({part})).image, {0.5, 0.25, 1.0}, 1e-6);
    expect_near(stored(test::make_exr({part})), {0.5, 0.25, 1.0}, 1e-6);
    part.channels.insert(part.channels.begin(), {"A", 2, 0.75f});
    expect_near(colours(test::make_exr({part})).image, {0.5, 0.25, 1.0, 0.75}, 1e-6);
    // The file's primaries define luminance: here the axes' green alone.
    test::ExrPart xyz{{{"BY", 2, 3.0f}, {"RY", 2, 1.0f}, {"Y", 2, 0.25f}}, {0, 0, 0, 0}, {0, 0, 0, 0}, "", {chromaticities(kXyz)}};
    expect_near(stored(test::make_exr({xyz})), {0.5, 0.25, 1.0}, 1e-6);
}

TEST(colours, half_of_the_chroma_and_subsampled_chroma_are_refused_by_name)
{
    test::ExrPart part{{{"RY", 2, 1}, {"Y", 2, 1}}, {0, 0, 0, 0}, {0, 0, 0, 0}, ""};
    EXPECT_EQ(refusal(test::make_exr({part})).reason, "RY without BY");
    part.channels = {{"BY", 2, 1, 2}, {"RY", 2, 1, 2}, {"Y", 2, 1}};
    EXPECT_NE(refusal(test::make_exr({part})).reason.find("BY is subsampled"), std::string::npos);
}

TEST(colours, channels_of_other_names_are_said)
{
    const auto one = [](const std::vector<test::ExrChannel>& channels) {
        return colours(test::make_exr({test::ExrPart{channels, {0, 0, 0, 0}, {0, 0, 0, 0}, ""}}));
    };
    const Read depth = one({{"Z", 2, 3}});
    EXPECT_EQ(values(depth.image), (std::vector<float>{3}));
    ASSERT_EQ(depth.notes.warnings.size(), 1u);
    EXPECT_EQ(depth.notes.warnings[0], "has no channels R, G, B or Y; taken as grey: Z");
    const Read layer = one({{"N.X", 2, 1}, {"N.Y", 2, 2}, {"N.Z", 2, 3}});
    ASSERT_EQ(layer.notes.warnings.size(), 1u);
    EXPECT_NE(layer.notes.warnings[0].find("red, green and blue: N.X, N.Y, N.Z"), std::string::npos) << layer.notes.warnings[0];
    EXPECT_TRUE(one({{"Y", 2, 1}}).notes.warnings.empty());
    EXPECT_TRUE(one({{"B", 2, 1}, {"G", 2, 1}, {"R", 2, 1}, {"Z", 2, 1}}).notes.warnings.empty());
}

TEST(colours, the_scale_of_pfm_files_multiplies)
{
    const auto pfm = [](const std::string& scale) {
        const std::string text = "Pf\n2 1\n" + scale + "\n" + test::floats({0.5f, 3.0f});
        return Bytes(text.begin(), text.end());
    };
    EXPECT_EQ(values(colours(pfm("-1.0")).image), (std::vector<float>{0.5f, 3.0f}));
    EXPECT_EQ(values(colours(pfm("-2.5")).image), (std::vector<float>{1.25f, 7.5f}));
    for (const char* scale : {"0", "x", "-inf", "nan", "1,5", "0x1p3"})
        EXPECT_NE(refusal(pfm(scale)).reason.find("scale"), std::string::npos) << scale;
}

// Writes an ICC profile with these XYZ of red, green and blue (adapted to D50), and one gamma.
std::string profile_of(const std::vector<double>& xyz, double gamma, const std::string& space = "RGB ")
{
    std::string tags, table;
    const auto big = [](std::string& to, std::uint32_t v) {
        for (int shift = 24; shift >= 0; shift -= 8)
            to += static_cast<char>(v >> shift & 0xFF);
    };
    big(table, 4);
    const std::size_t first = 128 + 4 + 4 * 12;
    const auto add = [&](const std::string& name, const std::string& data) {
        table += name;
        big(table, static_cast<std::uint32_t>(first + tags.size()));
        big(table, static_cast<std::uint32_t>(data.size()));
        tags += data;
    };
    for (std::size_t i = 0; i < 3; ++i) {
        std::string tag = "XYZ " + std::string(4, '\0');
        for (std::size_t c = 0; c < 3; ++c)
            big(tag, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(xyz[3 * i + c] * 65536))));
        add(std::string(1, "rgb"[i]) + "XYZ", tag);
    }
    std::string curve = "curv" + std::string(4, '\0');
    big(curve, 1);
    const auto exponent = static_cast<unsigned>(std::lround(gamma * 256));
    curve += {static_cast<char>(exponent >> 8), static_cast<char>(exponent & 0xFF)};
    add("rTRC", curve);
    std::string header(128, '\0');
    header.replace(16, 4, space), header.replace(36, 4, "acsp");
    return header + table + tags;
}

const std::vector<double> kSrgbXyz = {0.4360, 0.2225, 0.0139, 0.3851, 0.7169, 0.0971, 0.1431, 0.0606, 0.7139};
const std::vector<double> kDisplayP3Xyz = {0.5151, 0.2412, -0.0011, 0.2920, 0.6922, 0.0419, 0.1571, 0.0666, 0.7841};

std::vector<std::string> warnings_of_png(const std::vector<test::PngChunk>& extra)
{
    return colours(test::make_png(1, 1, 8, 2, "abc", extra)).notes.warnings;
}

std::string numbers(const std::vector<std::uint32_t>& values)
{
    std::string out;
    for (const std::uint32_t v : values)
        for (int shift = 24; shift >= 0; shift -= 8)
            out += static_cast<char>(v >> shift & 0xFF);
    return out;
}

TEST(colours, of_png_in_other_spaces_are_said)
{
    const auto icc = [](const std::string& profile) { return test::PngChunk{"iCCP", "any" + std::string(2, '\0') + test::store(profile)}; };
    const std::string p3 = profile_of(kDisplayP3Xyz, 2.2);
    const test::PngChunk rec2020{"cHRM", numbers({31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600})};
    for (const auto& [chunks, needle] : {std::pair{std::vector<test::PngChunk>{icc(p3)}, "profile has other primaries"},
                                         {{icc(profile_of(kSrgbXyz, 1.0))}, "profile has another tone curve"},
                                         {{icc("short")}, "profile is damaged"},
                                         {{icc(profile_of(kSrgbXyz, 2.2, "CMYK"))}, "another kind than RGB"},
                                         {{{"iCCP", "any" + std::string(2, '\0') + "no stream"}}, "profile is damaged"},
                                         {{{"gAMA", numbers({100000})}}, "gAMA is 1;"},
                                         {{rec2020}, "cHRM"},
                                         {{{"cICP", "\x09\x10" + std::string(1, '\0') + "\x01"}}, "cICP names primaries 9 and curve 16"}}) {
        const std::vector<std::string> found = warnings_of_png(chunks);
        ASSERT_EQ(found.size(), 1u) << needle;
        EXPECT_NE(found[0].find(needle), std::string::npos) << found[0];
    }
}

TEST(colours, of_png_in_srgb_are_not_said)
{
    const auto icc = [](const std::string& profile) { return test::PngChunk{"iCCP", "any" + std::string(2, '\0') + test::store(profile)}; };
    const test::PngChunk srgb{"sRGB", std::string(1, '\0')}, wide{"cHRM", numbers({31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600})};
    for (const std::vector<test::PngChunk>& chunks : {std::vector<test::PngChunk>{},
                                                      {icc(profile_of(kSrgbXyz, 2.2))},
                                                      {icc(profile_of({0, 0, 0, 0, 0, 0, 0, 0, 0}, 1.0, "GRAY"))},
                                                      {srgb, wide}, // the sRGB chunk counts
                                                      {{"gAMA", numbers({45455})}},
                                                      {{"cHRM", numbers({31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000})}},
                                                      {{"cICP", "\x01\x0D" + std::string(1, '\0') + "\x01"}, icc("short")}}) {
        const std::vector<std::string> found = warnings_of_png(chunks);
        EXPECT_TRUE(found.empty()) << chunks[0].type << ": " << found[0];
    }
}

// Writes with our own writer, then puts a profile behind JPEG's first marker.
TEST(colours, of_jpeg_in_other_spaces_are_said)
{
    Image image = make_image(8, 8, 3, PixelType::u8);
    const std::string path = test::temporary_folder() + "/own.jpg";
    ASSERT_TRUE(write_image(path, image));
    const Bytes plain = test::bytes_of(path);
    EXPECT_TRUE(colours(plain).notes.warnings.empty());
    const std::string profile = profile_of(kDisplayP3Xyz, 2.2), piece = "ICC_PROFILE" + std::string(1, '\0') + "\x01\x01" + profile;
    Bytes wide(plain.begin(), plain.begin() + 2);
    for (const char c : "\xFF\xE2" + numbers({static_cast<std::uint32_t>(piece.size() + 2)}).substr(2) + piece)
        wide.push_back(static_cast<std::uint8_t>(c));
    wide.insert(wide.end(), plain.begin() + 2, plain.end());
    const std::vector<std::string> found = colours(wide).notes.warnings;
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].find("other primaries"), std::string::npos) << found[0];
}

} // namespace
} // namespace burnish::colours_read
