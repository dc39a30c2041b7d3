// Golden images are complete, and a differing image leaves a visible report.
#include "tests/unit/golden.h"

#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "core/image/io/image_io.h"

namespace burnish::test {
namespace {
namespace fs = std::filesystem;

TEST(golden, every_picture_has_its_checks)
{
    EXPECT_EQ(fault_of_golden(golden_place().kept), "");
}

// A folder that is removed when the test ends.
struct Place : GoldenPlace {
    Place()
    {
        kept = fmt::format("{}golden_{}/kept", testing::TempDir(), ::getpid());
        left = fs::path(kept).parent_path().string() + "/left";
        fs::create_directories(kept);
    }
    ~Place() { fs::remove_all(fs::path(kept).parent_path()); }
};

Image ramp()
{
    Image image = make_image(20, 10, 3, PixelType::f32);
    for (int i = 0; i < 600; ++i)
        image.f32()[i] = static_cast<float>(i) / 600.0f;
    return image;
}

TEST(golden, a_picture_that_differs_is_left_beside_the_golden_one_with_its_place)
{
    Place place;
    place.bless = true;
    EXPECT_TRUE(is_golden("a/ramp", ramp(), "test", place));
    place.bless = false;
    EXPECT_TRUE(is_golden("a/ramp", ramp(), "test", place));
    EXPECT_FALSE(fs::exists(place.left));
    Image other = ramp();
    other.f32()[3 * (4 * 20 + 7)] *= 1.0f + 0x1p-20f;
    const testing::AssertionResult slight = is_golden("a/ramp", other, "slight", place);
    EXPECT_NE(std::string(slight.message()).find("1 columns, x 7 to 7, and 1 rows, y 4 to 4; no value"), std::string::npos)
        << slight.message();
    other.f32()[3 * (6 * 20 + 5) + 1] *= 1.5f;
    const testing::AssertionResult result = is_golden("a/ramp", other, "test", place);
    ASSERT_FALSE(result);
    for (const char* words : {"2 columns, x 5 to 7", "2 rows, y 4 to 6", "1 of 200 pixels", "the most, 0.506 of its value, at (5, 6)"})
        EXPECT_NE(std::string(result.message()).find(words), std::string::npos) << result.message();
    for (const char* name : {"actual.exr", "actual.png", "expected.png", "difference.png"})
        EXPECT_TRUE(read_image(place.left + "/a/ramp.test/" + name, Limits{})) << name;
    const Result<Image> difference = read_image(place.left + "/a/ramp.test/difference.png", Limits{});
    ASSERT_TRUE(difference);
    int shown = 0;
    for (int i = 0; i < 200; ++i)
        shown += static_cast<int>(difference->bytes[static_cast<std::size_t>(3 * i)]) > 20;
    EXPECT_EQ(shown, 4); // where a differing row crosses a differing column
}

TEST(golden, what_was_never_blessed_and_what_two_draw_differently_is_an_error)
{
    Place place;
    EXPECT_FALSE(is_golden("new", ramp(), "test", place));
    place.bless = true;
    EXPECT_TRUE(is_golden("new", ramp(), "one", place));
    Image other = ramp();
    other.f32()[0] = 1.0f;
    EXPECT_FALSE(is_golden("new", other, "two", place));
    place.bless = false;
    EXPECT_TRUE(is_golden("new", ramp(), "one", place));
}

} // namespace
} // namespace burnish::test
