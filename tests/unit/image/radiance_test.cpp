// Radiance files: factors and primaries in the header, both run codings, and hostile files.
#include <gtest/gtest.h>

#include "core/image/io/image_io.h"
#include "small_files.h"

namespace burnish::radiance_files {
namespace {

using test::Bytes;

const std::string kGrey = "\x80\x80\x80\x81"; // 1, 1, 1

Bytes hdr(const std::string& resolution, const std::string& pixels, const std::string& lines = "")
{
    return test::make_hdr(resolution, Bytes(pixels.begin(), pixels.end()), lines);
}

Result<Image> read(const Bytes& bytes, PictureNotes* notes = nullptr)
{
    PictureNotes unread;
    return decode_colours(bytes.data(), bytes.size(), "label", Limits{}, notes ? *notes : unread);
}

std::vector<float> values(const Bytes& bytes, PictureNotes* notes = nullptr)
{
    const Result<Image> image = read(bytes, notes);
    EXPECT_TRUE(image) << (image ? "" : image.error().line());
    return image ? std::vector<float>(image->f32(), image->f32() + image->bytes.size() / 4) : std::vector<float>();
}

Error refusal(const Bytes& bytes)
{
    const Result<Image> image = read(bytes);
    EXPECT_FALSE(image);
    return image ? Error{ExitCode::ok, "", "", ""} : image.error();
}

std::string repeated(const std::string& text, std::size_t times)
{
    std::string out;
    while (times-- > 0)
        out += text;
    return out;
}

TEST(radiance, mantissas_and_exponents_are_values)
{
    EXPECT_EQ(values(hdr("-Y 1 +X 3", std::string("\x80\x40\x20\x81\xFF\x00\x01\x88\xFF\xFF\xFF\x00", 12))),
              (std::vector<float>{1.0f, 0.5f, 0.25f, 255.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f}));
}

TEST(radiance, exposures_and_corrections_are_divided_out)
{
    EXPECT_EQ(values(hdr("-Y 1 +X 1", kGrey, "EXPOSURE=2\nEXPOSURE= 4.0\n")), (std::vector<float>{0.125f, 0.125f, 0.125f}));
    EXPECT_EQ(values(hdr("-Y 1 +X 1", kGrey, "COLORCORR=2 1 0.5\nCOLORCORR= 2 2 1\nEXPOSURE=+0.5\n")),
              (std::vector<float>{0.5f, 1.0f, 4.0f}));
    // lines of an image from which this one was made
    EXPECT_EQ(values(hdr("-Y 1 +X 1", kGrey, "pcomb a.hdr\n\tEXPOSURE=4\nPIXASPECT=0.5\n")), (std::vector<float>{1, 1, 1}));
    // factors apply to data as well
    const Bytes exposed = hdr("-Y 1 +X 1", kGrey, "EXPOSURE=4\n");
    EXPECT_EQ(decode_image(exposed.data(), exposed.size(), "label", Limits{})->f32()[0], 0.25f);
    for (const char* line :
         {"EXPOSURE=0", "EXPOSURE=-1", "EXPOSURE=nan", "EXPOSURE=inf", "EXPOSURE=", "EXPOSURE=1,5", "EXPOSURE=1 2", "EXPOSURE=x"})
        EXPECT_EQ(refusal(hdr("-Y 1 +X 1", kGrey, std::string(line) + "\n")).place, "header: EXPOSURE") << line;
    for (const char* line : {"COLORCORR=1 1", "COLORCORR=1 0 1", "COLORCORR=1 1 1 1"})
        EXPECT_EQ(refusal(hdr("-Y 1 +X 1", kGrey, std::string(line) + "\n")).place, "header: COLORCORR") << line;
    EXPECT_EQ(refusal(hdr("-Y 1 +X 1", kGrey, repeated("EXPOSURE=1e200\n", 3))).place, "header: EXPOSURE");
}

TEST(radiance, primaries_of_the_header_are_converted)
{
    PictureNotes notes;
    const std::vector<float> red = values(
        hdr("-Y 1 +X 1", std::string("\x80\x00\x00\x81", 4), "PRIMARIES= 0.713 0.293 0.165 0.83 0.128 0.044 0.32168 0.33767\n"), &notes);
    ASSERT_EQ(red.size(), 3u);
    const double wanted[] = {1.70505, -0.13026, -0.02400};
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(red[c]), wanted[c], 2e-5);
    EXPECT_TRUE(notes.converted && notes.warnings.empty());
    EXPECT_EQ(values(hdr("-Y 1 +X 1", "\x80\x40\x20\x81", "PRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .329\n")),
              (std::vector<float>{1, 0.5f, 0.25f}));
    PictureNotes bad;
    EXPECT_EQ(values(hdr("-Y 1 +X 1", kGrey, "PRIMARIES=1 2 3\n"), &bad), (std::vector<float>{1, 1, 1}));
    ASSERT_EQ(bad.warnings.size(), 1u);
    EXPECT_NE(bad.warnings[0].find("PRIMARIES"), std::string::npos);
    PictureNotes gamma;
    values(hdr("-Y 1 +X 1", kGrey, "GAMMA=2.2\n"), &gamma);
    EXPECT_EQ(gamma.warnings.size(), 1u);
}

TEST(radiance, other_formats_are_refused_by_name)
{
    EXPECT_NE(refusal(hdr("-Y 1 +X 1", kGrey, "FORMAT=32-bit_rle_xyze\n")).reason.find("XYZE"), std::string::npos);
    EXPECT_EQ(refusal(hdr("-Y 1 +X 1", kGrey, "FORMAT=ascii\n")).place, "header: FORMAT");
    for (const char* resolution : {"-Y 1", "-Y 1 -Y 1", "Y 1 X 1", "-Y -1 +X 1", "-Y 0 +X 1", "-Y 1 +X 1 ", "-Y 99999999999999999999 +X 1"})
        refusal(hdr(resolution, kGrey));
}

// Two colours in runs of 3 and 5 + 2 * 256.
TEST(radiance, runs_of_the_older_coding_are_read)
{
    const std::string red = "\x80\x20\x20\x82", blue = "\x20\x20\x80\x80";
    const std::string runs = red + "\1\1\1\3" + blue + "\1\1\1\5\1\1\1\2" + red;
    const std::string plain = repeated(red, 4) + repeated(blue, 1 + 5 + 2 * 256) + red;
    const std::string resolution = "-Y 2 +X " + std::to_string(plain.size() / 4);
    EXPECT_EQ(values(hdr(resolution, runs + runs)), values(hdr(resolution, plain + plain)));
    // 256 of them as 0 + 256
    EXPECT_EQ(values(hdr("-Y 1 +X 257", blue + std::string("\1\1\1\0\1\1\1\1", 8))), values(hdr("-Y 1 +X 257", repeated(blue, 257))));
}

TEST(radiance, both_codings_may_stand_in_one_file)
{
    const std::string pixel = "\x80\x40\x20\x81";
    const std::string new_line = std::string("\2\2\0\x0A", 4) + "\x8A\x80" + "\x8A\x40" + "\x05\x20\x20\x20\x20\x20\x85\x20" + "\x8A\x81";
    EXPECT_EQ(values(hdr("-Y 2 +X 10", new_line + pixel + "\1\1\1\x09")), values(hdr("-Y 2 +X 10", repeated(pixel, 20))));
}

TEST(radiance, hostile_runs_are_refused_where_they_stand)
{
    const std::string pixel = "\x80\x40\x20\x81";
    const auto damaged = [&](const std::string& resolution, const std::string& pixels, const std::string& needle) {
        const Error error = refusal(hdr(resolution, pixels));
        EXPECT_NE(error.reason.find(needle), std::string::npos) << error.line();
        EXPECT_EQ(error.place.rfind("byte ", 0), 0u) << error.line();
    };
    damaged("-Y 1 +X 9", pixel + "\1\1\1\x09", "a run of 9");                                            // one too many
    damaged("-Y 1 +X 9", "\1\1\1\x09", "a run of 9");                                                    // nothing to repeat
    damaged("-Y 2 +X 9", pixel + "\1\1\1\x08" + "\1\1\1\x09", "a run of 9");                             // the pixel of the scanline above
    damaged("-Y 1 +X 9000", pixel + repeated("\1\1\1\xFF", 2), "a run of 65280");                        // digits of base 256
    damaged("-Y 1 +X 9000", pixel + repeated(std::string("\1\1\1\0", 4), 9) + "\1\1\1\xFF", "a run of"); // beyond any word size
    damaged("-Y 1 +X 9", pixel + repeated(std::string("\1\1\1\0", 4), 9), "cut off");
    damaged("-Y 1 +X 10", std::string("\2\2\0\x0B", 4) + "\x8A\x80", "a scanline of 11");
    damaged("-Y 1 +X 10", std::string("\2\2\0\x0A", 4) + "\x8B\x80", "a run of 11");
    damaged("-Y 1 +X 10", std::string("\2\2\0\x0A\0\x80", 6), "a run of 0");
    damaged("-Y 1 +X 10", std::string("\2\2\0\x0A", 4) + "\x0B\x80", "a run of 11");
    damaged("-Y 1 +X 10", std::string("\2\2\0\x0A", 4) + "\x0A\x80", "cut off");
}

TEST(radiance, a_few_bytes_cannot_ask_for_a_large_picture)
{
    for (const char* resolution : {"-Y 16384 +X 16384", "-Y 16384 +X 100", "-Y 100 +X 10000000"}) {
        const Error error = refusal(hdr(resolution, kGrey + "\1\1\1\xFF\1\1\1\x3F"));
        EXPECT_EQ(error.place.rfind("header", 0), 0u) << error.line();
    }
    EXPECT_NE(refusal(hdr("-Y 16384 +X 1000", std::string("\2\2\3\xE8", 4))).reason.find("cannot hold"), std::string::npos);
}

} // namespace
} // namespace burnish::radiance_files
