// Comparison by stage: counts, places, and the cause of a pixel's difference.
#include <gtest/gtest.h>

#include <bit>

#include "apps/parity/stages.h"
#include "tests/unit/parity/frames.h"

namespace burnish::test {
namespace {

const ParityStage& stage_of(const ParityCounts& counts, const std::string& name)
{
    for (const ParityStage& stage : counts.stages)
        if (stage.name == name)
            return stage;
    ADD_FAILURE() << "no stage " << name;
    return counts.stages.front();
}

TEST(ulp_distance, counts_floats_between)
{
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    EXPECT_EQ(ulp_distance(bits(1.0f), bits(1.0f)), 0u);
    EXPECT_EQ(ulp_distance(bits(1.0f), std::bit_cast<std::uint32_t>(1.0f) + 3), 3u);
    EXPECT_EQ(ulp_distance(bits(-0.0f), bits(0.0f)), 1u);
    EXPECT_EQ(ulp_distance(bits(-1.0f), bits(1.0f)), ulp_distance(bits(1.0f), bits(-1.0f)));
}

TEST(compare_stages, of_equal_frames_finds_nothing)
{
    const Frame a = two_pixels();
    const ParityCounts counts = compare_stages(a, a, 2);
    EXPECT_EQ(first_difference(counts), nullptr);
    EXPECT_EQ(counts.samples, 4u);
    EXPECT_EQ(stage_of(counts, "depth").values, 4u);
    EXPECT_EQ(stage_of(counts, "interpolants").values, 2u * kInterpolantWords); // the background has none
    EXPECT_EQ(stage_of(counts, "shaded colour").values, 3u * 3u);
    EXPECT_EQ(stage_of(counts, "resolved colour").values, 2u * 3u);
}

TEST(compare_stages, names_the_stage_the_words_and_the_pixel)
{
    const Frame a = two_pixels();
    const struct {
        const char* stage;
        std::size_t word; // in the pair of pixel 1
    } cases[] = {{"interpolants", 1 + 4}, {"material inputs", 1 + kInterpolantWords + 2}, {"shaded colour", kPairWords - 1}};
    for (const auto& c : cases) {
        Frame b = a;
        b.stages.pairs[2 * kPairWords + c.word] += 5;
        const ParityCounts counts = compare_stages(a, b, 2);
        const ParityStage* first = first_difference(counts);
        ASSERT_NE(first, nullptr) << c.stage;
        EXPECT_EQ(first->name, c.stage);
        EXPECT_EQ(first->words_differ, 1u);
        EXPECT_EQ(first->max_ulp, 5u);
        EXPECT_EQ(first->worst_x, 1);
        EXPECT_EQ(first->worst_y, 0);
    }
    Frame deeper = a;
    deeper.stages.depths[3] ^= 1u;
    EXPECT_EQ(first_difference(compare_stages(a, deeper, 2))->name, "depth");
    Frame moved = a;
    moved.stages.vertices[2] ^= 1u;
    EXPECT_EQ(first_difference(compare_stages(a, moved, 2))->name, "clip positions");
}

TEST(compare_colours, counts_words_where_the_pairs_are_equal)
{
    const Frame a = two_pixels();
    Image shadowed = a.color;
    shadowed.f32()[5] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(1.0f) + 7);
    const ParityStage stage = compare_colours("shadowed colour", a.color, shadowed, a, a, 2);
    EXPECT_EQ(stage.name, "shadowed colour");
    EXPECT_EQ(stage.values, 6u);
    EXPECT_EQ(stage.words_differ, 1u);
    EXPECT_EQ(stage.max_ulp, 7u);
    EXPECT_EQ(stage.worst_x, 1);
    Frame other = a;
    other.triangle_ids[2] = 0;
    EXPECT_EQ(compare_colours("", a.color, shadowed, a, other, 2).values, 3u);
}

TEST(compare_stages, leaves_out_samples_that_show_another_triangle_and_no_others)
{
    const Frame a = two_pixels();
    Frame b = a; // pixel 0: sample 0 has another triangle, sample 1 the same background
    b.triangle_ids[0] = 9;
    b.stages.pairs[1] = 77, b.color.f32()[0] = 9.0f;
    b.stages.depths[0] = 1;
    const ParityCounts counts = compare_stages(a, b, 2);
    EXPECT_EQ(counts.visibility_differ, 1u);
    EXPECT_EQ(stage_of(counts, "visibility").words_differ, 1u);
    EXPECT_EQ(stage_of(counts, "depth").values, 3u);
    EXPECT_EQ(stage_of(counts, "depth").words_differ, 0u);
    EXPECT_EQ(stage_of(counts, "interpolants").values, std::uint64_t{kInterpolantWords});
    EXPECT_EQ(stage_of(counts, "shaded colour").values, 2u * 3u); // the background of pixel 0 and pixel 1
    EXPECT_EQ(stage_of(counts, "resolved colour").values, 3u);
    b.stages.pairs[1 * kPairWords + kPairWords - 3] ^= 1u; // the background of pixel 0, visible in both
    EXPECT_EQ(stage_of(compare_stages(a, b, 2), "shaded colour").words_differ, 1u);
}

TEST(pixel_causes, are_the_first_stage_beyond_rounding)
{
    const Frame a = two_pixels();
    const auto cause = [&](std::size_t word, float value) {
        Frame b = a;
        b.color.f32()[3] += 0.5f;
        if (word)
            b.stages.pairs[2 * kPairWords + word] = std::bit_cast<std::uint32_t>(value);
        return pixel_causes(a, b, 2)[1];
    };
    EXPECT_EQ(cause(0, 0.0f), PixelCause::resolved);
    EXPECT_EQ(cause(1, 1.5f), PixelCause::interpolants); // all words are 1
    EXPECT_EQ(cause(1, 1.0001f), PixelCause::resolved);  // a normal's rounding
    EXPECT_EQ(cause(1 + kInterpolantWords, 1.5f), PixelCause::material);
    EXPECT_EQ(cause(kPairWords - 2, 1.5f), PixelCause::shaded);
    Frame b = a;
    b.color.f32()[3] += 1e-5f;
    EXPECT_EQ(pixel_causes(a, b, 2)[1], PixelCause::rounding);
    EXPECT_EQ(pixel_causes(a, b, 2)[0], PixelCause::none);
    b.triangle_ids[2] = b.triangle_ids[3] = 9;
    EXPECT_EQ(pixel_causes(a, b, 2)[1], PixelCause::visibility);
}

TEST(share_causes, add_up_to_the_mean)
{
    const Frame a = two_pixels();
    const float flip[] = {0.5f, 0.25f};
    const std::vector<CauseShare> shares = share_causes({PixelCause::visibility, PixelCause::rounding}, a, 2, flip);
    ASSERT_EQ(shares.size(), 2u);
    EXPECT_EQ(shares[0].cause, PixelCause::visibility);
    EXPECT_EQ(shares[0].edge_pixels, 1u);
    EXPECT_EQ(shares[1].edge_pixels, 0u);
    EXPECT_DOUBLE_EQ(shares[0].flip + shares[1].flip, 0.375);
}

} // namespace
} // namespace burnish::test
