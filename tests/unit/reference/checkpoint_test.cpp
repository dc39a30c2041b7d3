// Renders give equal bits on all instruction sets and thread counts, however often they are interrupted.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "core/scene/builtin/builtin.h"
#include "raster/reference/accumulator.h"
#include "raster/reference/checkpoint.h"
#include "raster/reference/reference_types.h"
#include "raster/reference/scene_key.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

class TempFile {
  public:
    explicit TempFile(const char* name)
        : path_((std::filesystem::temp_directory_path() / ("burnish_" + std::to_string(getpid()) + "_" + name)).string())
    {
    }
    ~TempFile()
    {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

Scene small_scene()
{
    Scene scene = ball_scene(metal(0.5f, 0.0f), false);
    add_scene(scene, plane_scene(lambert(0.6f)), {0.0f, 0.0f, -1.1f}, 2.0f);
    return scene;
}

FrameDesc small_desc()
{
    FrameDesc d = desc_of(37, 21, make_view(glm::vec3(1.0f, 0.8f, 4.0f), glm::vec3(0.0f), 0.7f, 37, 21));
    d.seed = 3;
    return d;
}

ReferenceOptions options_of(ReferenceMode mode, std::uint64_t samples)
{
    ReferenceOptions o;
    o.mode = mode, o.samples = samples, o.bounces = 3;
    return o;
}

Result<Frame> try_render(const Stage& stage, const FrameDesc& d, const ReferenceOptions& o)
{
    const RenderInput input = stage.input();
    Result<std::unique_ptr<Renderer>> renderer = make_reference_renderer(input, o);
    EXPECT_TRUE(renderer);
    return (*renderer)->render(d);
}

TEST(bits, are_the_same_for_any_thread_count_and_instruction_set)
{
    BN_NEEDS_EMBREE();
    const std::vector<Isa> isas = isas_with<ReferenceFns>();
    const auto has = [&](const char* name) {
        return std::any_of(isas.begin(), isas.end(), [&](Isa i) { return std::string(isa_name(i)) == name; });
    };
    ASSERT_TRUE(has("portable16") || has("avx512")) << "16 lanes on every machine";
    for (ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed, ReferenceMode::path}) {
        std::uint64_t color = 0, variance = 0;
        for (int threads : {1, 2, 5}) {
            const Stage stage(small_scene(), 1.0f, threads);
            for (Isa isa : isas) {
                const RenderInput input = stage.input();
                ReferenceOptions o = options_of(mode, 320);
                o.isa = isa;
                const Result<Frame> f = (*make_reference_renderer(input, o))->render(small_desc());
                ASSERT_TRUE(f);
                EXPECT_EQ(f->stats.sampling.samples, 320u);
                color = color ? color : pixel_hash(f->color);
                variance = variance ? variance : pixel_hash(f->variance);
                EXPECT_EQ(pixel_hash(f->color), color)
                    << "mode " << static_cast<int>(mode) << ", " << threads << " threads, " << isa_name(isa);
                EXPECT_EQ(pixel_hash(f->variance), variance);
            }
        }
    }
}

TEST(bits, differ_for_another_seed)
{
    BN_NEEDS_EMBREE();
    const Stage stage(small_scene());
    FrameDesc d = small_desc();
    const std::uint64_t first = pixel_hash(render_reference(stage, d, options_of(ReferenceMode::direct, 64)).color);
    d.seed = 4;
    EXPECT_NE(pixel_hash(render_reference(stage, d, options_of(ReferenceMode::direct, 64)).color), first);
}

TEST(checkpoint, a_picture_gone_on_with_is_the_picture_made_at_once)
{
    BN_NEEDS_EMBREE();
    const Stage stage(small_scene(), 1.0f, 2);
    const Frame at_once = render_reference(stage, small_desc(), options_of(ReferenceMode::shadowed, 640));
    const TempFile file("resumed");
    for (std::uint64_t samples : {64u, 192u, 640u}) {
        ReferenceOptions o = options_of(ReferenceMode::shadowed, samples);
        o.checkpoint = file.path();
        const Frame f = render_reference(stage, small_desc(), o);
        EXPECT_EQ(f.stats.sampling.resumed, samples > 64);
        EXPECT_EQ(f.stats.sampling.samples_before, samples == 64 ? 0u : samples == 192 ? 64u : 192u);
        EXPECT_EQ(pixel_hash(f.color) == pixel_hash(at_once.color), samples == 640);
        if (samples == 640) {
            EXPECT_EQ(pixel_hash(f.variance), pixel_hash(at_once.variance));
        }
    }
}

TEST(checkpoint, a_run_that_is_stopped_again_and_again_loses_nothing)
{
    BN_NEEDS_EMBREE();
    const Stage stage(small_scene(), 1.0f, 2);
    const std::uint64_t samples = 64 * 600;
    const Frame at_once = render_reference(stage, small_desc(), options_of(ReferenceMode::path, samples));
    const TempFile file("stopped");
    int stops = 0;
    for (int run = 0; run < 1000; ++run) {
        std::atomic<bool> stop{false};
        ReferenceOptions o = options_of(ReferenceMode::path, samples);
        o.checkpoint = file.path();
        o.stop = &stop;
        const double share = 0.15 * at_once.stats.ms; // of the whole time: several stops, with progress before each
        std::thread bell([&] {
            std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(share * (1.0 + 0.2 * run)));
            stop = true;
        });
        const Frame f = render_reference(stage, small_desc(), o);
        bell.join();
        if (f.stats.sampling.stopped) {
            ++stops;
            continue;
        }
        EXPECT_EQ(pixel_hash(f.color), pixel_hash(at_once.color));
        EXPECT_EQ(pixel_hash(f.variance), pixel_hash(at_once.variance));
        break;
    }
    std::printf("stopped %d times\n", stops);
    EXPECT_GE(stops, 1);
    EXPECT_LT(stops, 500);
}

TEST(checkpoint, of_something_else_is_refused_and_left_alone)
{
    BN_NEEDS_EMBREE();
    const TempFile file("other");
    Stage stage(small_scene());
    ReferenceOptions o = options_of(ReferenceMode::direct, 64);
    o.checkpoint = file.path();
    render_reference(stage, small_desc(), o);
    const auto bytes = [&] {
        std::ifstream in(file.path(), std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    const std::string before = bytes();
    const auto refused = [&](const Stage& s, const FrameDesc& d, const ReferenceOptions& options, const char* what) {
        const Result<Frame> f = try_render(s, d, options);
        ASSERT_FALSE(f) << what;
        EXPECT_EQ(f.error().code, ExitCode::bad_input) << what;
        EXPECT_EQ(f.error().file, file.path());
        EXPECT_NE(f.error().reason.find("another picture"), std::string::npos) << what;
        EXPECT_EQ(bytes(), before) << what;
    };
    FrameDesc d = small_desc();
    d.seed = 9;
    refused(stage, d, o, "seed");
    d = small_desc();
    d.view.eye.x += 0.01f;
    refused(stage, d, o, "view");
    d = small_desc();
    d.width = 38;
    refused(stage, d, o, "size");
    d = small_desc();
    d.background = false;
    refused(stage, d, o, "background");
    ReferenceOptions other = o;
    other.mode = ReferenceMode::shadowed;
    refused(stage, small_desc(), other, "mode");
    Scene changed = small_scene();
    changed.materials[1].base_color.g += 0.01f;
    refused(Stage(changed), small_desc(), o, "material");
    changed = small_scene();
    changed.vertices.px[10] += 1e-3f;
    refused(Stage(changed), small_desc(), o, "geometry");
    refused(Stage(small_scene(), 1.01f), small_desc(), o, "environment");
    EXPECT_TRUE(try_render(stage, small_desc(), o));
}

TEST(checkpoint, that_is_none_or_damaged_is_refused)
{
    BN_NEEDS_EMBREE();
    const TempFile file("damaged");
    const Stage stage(small_scene());
    ReferenceOptions o = options_of(ReferenceMode::direct, 64);
    o.checkpoint = file.path();
    render_reference(stage, small_desc(), o);
    std::string bytes;
    {
        std::ifstream in(file.path(), std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(in), {});
    }
    const auto refused = [&](std::string content, const char* word) {
        std::ofstream(file.path(), std::ios::binary) << content;
        const Result<Frame> f = try_render(stage, small_desc(), o);
        ASSERT_FALSE(f) << word;
        EXPECT_EQ(f.error().code, ExitCode::bad_input);
        EXPECT_NE(f.error().reason.find(word), std::string::npos) << f.error().line();
    };
    std::string flipped = bytes;
    flipped[bytes.size() / 2] = static_cast<char>(flipped[bytes.size() / 2] ^ 4);
    refused(flipped, "damaged");
    refused(bytes.substr(0, bytes.size() - 5), "damaged");
    std::string older = bytes;
    ASSERT_EQ(older.substr(0, 7), "BNREF02");
    older[6] = '1';
    refused(older, "another version");
    refused("my diary", "not a checkpoint");
    refused(bytes.substr(0, 20), "not a checkpoint");
}

TEST(target_error, ends_early_and_is_met)
{
    BN_NEEDS_EMBREE();
    const Stage stage(small_scene(), 1.0f, 2);
    ReferenceOptions o = options_of(ReferenceMode::shadowed, 1u << 20);
    o.target_error = 0.01;
    const Frame f = render_reference(stage, small_desc(), o);
    EXPECT_LE(f.stats.sampling.relative_error, 0.01);
    EXPECT_LT(f.stats.sampling.samples, 1u << 18);
    EXPECT_GE(f.stats.sampling.samples, 8u * kPassSamples);
    // Checks the confidence interval: a far better estimate lies inside about as often as promised.
    FrameDesc d = small_desc();
    d.seed = 77;
    const Frame reference = render_reference(stage, d, options_of(ReferenceMode::shadowed, 16 * f.stats.sampling.samples));
    std::size_t inside = 0, n = 0;
    for (std::size_t i = 0; i < f.color.bytes.size() / sizeof(float); ++i) {
        const double v = static_cast<double>(f.variance.f32()[i]) + static_cast<double>(reference.variance.f32()[i]);
        if (!(v > 1e-14))
            continue;
        const double difference = static_cast<double>(f.color.f32()[i]) - static_cast<double>(reference.color.f32()[i]);
        ++n;
        inside += difference * difference < 1.96 * 1.96 * v;
    }
    EXPECT_GT(static_cast<double>(inside) / static_cast<double>(n), 0.93);
    EXPECT_LT(static_cast<double>(inside) / static_cast<double>(n), 0.97);
}

// The end of a run must not depend on its interruptions. The run completes an uneven round before it evaluates the error.
TEST(target_error, is_looked_at_after_whole_rounds_only)
{
    BN_NEEDS_EMBREE();
    const Stage stage(small_scene(), 1.0f, 2);
    const FrameDesc d = small_desc();
    const RenderInput input = stage.input();
    const std::uint32_t round_passes = (1u << 22) / (37 * 21 * kPassSamples);
    const std::uint64_t round = round_passes * kPassSamples; // samples a pixel
    const TempFile file("uneven");
    ReferenceOptions o = options_of(ReferenceMode::direct, round);
    o.checkpoint = file.path();
    const std::uint64_t key = reference_key(input, d, o);
    Accumulator one(d.width, d.height), uneven(d.width, d.height);
    render_reference(stage, d, o);
    ASSERT_TRUE(*read_checkpoint(file.path(), key, one));
    o.samples = 2 * round;
    render_reference(stage, d, o);
    ASSERT_TRUE(*read_checkpoint(file.path(), key, uneven)); // a whole second round, except for one block
    uneven.passes[0] = one.passes[0];
    const PixelBlock first = block_of(one, 0, 0);
    reserve_sums(uneven, round_passes);
    for (int y = first.y0; y < first.y0 + first.height; ++y)
        for (int x = first.x0; x < first.x0 + first.width; ++x)
            for (std::size_t k = 0; k < kMostSums; ++k)
                if (round_passes >> k & 1u)
                    uneven.sums[k][static_cast<std::size_t>(y * d.width + x)] = one.sums[k][static_cast<std::size_t>(y * d.width + x)];
    const double before = mean_relative_error(one), between = mean_relative_error(uneven);
    ASSERT_LT(between, before);
    ASSERT_TRUE(write_checkpoint(file.path(), key, uneven));
    o.samples = 8 * round;
    o.target_error = 0.5 * (before + between);
    const Frame resumed = render_reference(stage, d, o);
    o.checkpoint.clear();
    const Frame at_once = render_reference(stage, d, o);
    EXPECT_EQ(at_once.stats.sampling.samples, 2 * round);
    EXPECT_EQ(resumed.stats.sampling.samples, 2 * round);
    EXPECT_EQ(pixel_hash(resumed.color), pixel_hash(at_once.color));
}

// Renders passes of some blocks alone; returns their state.
std::vector<std::uint8_t> part_of(const Stage& stage, std::uint32_t block, std::uint32_t count, std::uint32_t pass, std::uint32_t passes)
{
    ReferenceOptions o = options_of(ReferenceMode::direct, 27 * kPassSamples);
    o.part = std::make_shared<ReferencePart>();
    o.part->first = block, o.part->count = count;
    o.part->first_pass = pass, o.part->samples = passes * kPassSamples;
    const Frame frame = render_reference(stage, small_desc(), o);
    EXPECT_TRUE(frame.color.bytes.empty() && frame.variance.bytes.empty()); // a part takes no time by the whole picture's size
    return o.part->made;
}

TEST(parts, of_blocks_and_of_passes_make_the_bits_of_one_run)
{
    BN_NEEDS_EMBREE();
    const Stage stage(small_scene(), 1.0f, 2);
    ReferenceOptions o = options_of(ReferenceMode::direct, 27 * kPassSamples);
    const Frame at_once = render_reference(stage, small_desc(), o);
    const std::uint32_t blocks = reference_blocks(37, 21);
    o.part = std::make_shared<ReferencePart>();
    o.part->others = {part_of(stage, 7, blocks - 7, 0, 27)};
    for (std::uint32_t block = 0; block < 7; ++block)
        for (std::uint32_t pass = 0; pass < 27; pass += 8)
            o.part->others.push_back(part_of(stage, block, 1, pass, std::min(8u, 27 - pass)));
    const Frame merged = render_reference(stage, small_desc(), o);
    EXPECT_EQ(merged.stats.sampling.rays, 0u) << "parts were not taken over";
    EXPECT_EQ(pixel_hash(merged.color), pixel_hash(at_once.color));
    EXPECT_EQ(pixel_hash(merged.variance), pixel_hash(at_once.variance));
}

TEST(parts, whose_passes_do_not_follow_are_refused)
{
    BN_NEEDS_EMBREE();
    const Stage stage(small_scene());
    const std::vector<std::uint8_t> first = part_of(stage, 3, 2, 0, 8), second = part_of(stage, 3, 2, 8, 3);
    std::vector<std::uint8_t> odd = first; // as if of passes 4 to 11
    constexpr std::size_t kFirstPassAt = 32;
    odd[kFirstPassAt] = 4;
    ReferenceOptions o = options_of(ReferenceMode::direct, 27 * kPassSamples);
    o.part = std::make_shared<ReferencePart>();
    const auto refused = [&](std::vector<std::vector<std::uint8_t>> others, const char* word) {
        o.part->others = std::move(others);
        const Result<Frame> f = try_render(stage, small_desc(), o);
        ASSERT_FALSE(f) << word;
        EXPECT_EQ(f.error().code, ExitCode::bad_input);
        EXPECT_NE(f.error().reason.find(word), std::string::npos) << f.error().line();
    };
    refused({second}, "do not follow");
    refused({first, first}, "do not follow");
    refused({first, second, second}, "do not follow");
    refused({part_of(stage, 3, 2, 0, 4), odd}, "damaged"); // 8 passes behind 4 are no node of the tree
    refused({std::vector<std::uint8_t>(first.begin(), first.end() - 1)}, "damaged");
    o.part->others = {first, second};
    EXPECT_TRUE(try_render(stage, small_desc(), o));
}

TEST(parts, that_no_merge_could_take_are_refused)
{
    BN_NEEDS_EMBREE();
    const Stage stage(small_scene());
    ReferenceOptions o = options_of(ReferenceMode::direct, 64);
    o.part = std::make_shared<ReferencePart>();
    o.part->count = 1, o.part->first_pass = 4, o.part->samples = 5 * kPassSamples; // 5 passes behind 4 are no node of the tree
    Result<Frame> f = try_render(stage, small_desc(), o);
    ASSERT_FALSE(f);
    EXPECT_NE(f.error().reason.find("first_pass"), std::string::npos);
    o.part->first_pass = 8;
    EXPECT_TRUE(try_render(stage, small_desc(), o));
    const TempFile file("part");
    o.checkpoint = file.path(); // would hold later passes as the picture's first
    f = try_render(stage, small_desc(), o);
    ASSERT_FALSE(f);
    EXPECT_NE(f.error().reason.find("checkpoint"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(file.path()));
}

// A pass of a large image takes minutes, so checkpoints are also written within a pass.
TEST(checkpoint, of_a_large_picture_is_written_within_a_pass)
{
    BN_NEEDS_EMBREE();
    const Stage stage(small_scene(), 1.0f, 2);
    const TempFile file("large");
    FrameDesc d = desc_of(640, 512, make_view(glm::vec3(1.0f, 0.8f, 4.0f), glm::vec3(0.0f), 0.7f, 640, 512));
    ReferenceOptions o = options_of(ReferenceMode::direct, kPassSamples);
    std::atomic<bool> stop{false}, done{false};
    o.stop = &stop;
    o.checkpoint = file.path();
    o.checkpoint_seconds = 0.0;
    std::thread watcher([&] {
        while (!done && !std::filesystem::exists(file.path()))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        stop = true;
    });
    const Frame part = render_reference(stage, d, o);
    done = true;
    watcher.join();
    EXPECT_TRUE(part.stats.sampling.stopped) << "nothing was written before the pass was over";
    EXPECT_EQ(part.stats.sampling.samples, 0u);
    o.stop = nullptr;
    const Frame resumed = render_reference(stage, d, o);
    o.checkpoint.clear();
    EXPECT_EQ(pixel_hash(resumed.color), pixel_hash(render_reference(stage, d, o).color));
}

} // namespace
} // namespace burnish::test
