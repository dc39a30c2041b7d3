// Stop and progress of sessions.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <gtest/gtest.h>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "core/image/io/image_io.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "core/jobs/control.h"
#include "raster/session/session.h"

namespace burnish {
namespace {

OpenOptions open_options(int threads)
{
    OpenOptions open;
    open.threads = threads;
    open.environment.cube_size = 32, open.environment.samples = 64, open.environment.use_cache = false;
    return open;
}

FrameDesc long_frame(const Session& session)
{
    FrameDesc d;
    d.width = 512, d.height = 384;
    d.technique = "mc", d.samples = 1024;
    d.view = session.framed(d.width, d.height);
    return d;
}

std::stop_token requested_stop()
{
    const auto stop = std::make_unique<std::stop_source>(); // g++ 12 warns of a local one
    stop->request_stop();
    return stop->get_token();
}

TEST(control, stops_an_open_before_and_within)
{
    for (const int threads : {1, 2}) {
        {
            const Controlled controlled({requested_stop(), {}});
            const Result<Session> refused = Session::open("builtin:teapot", "builtin:studio", open_options(threads));
            ASSERT_FALSE(refused);
            EXPECT_EQ(refused.error().code, ExitCode::stopped);
        }
        std::stop_source later;
        bool baking = false;
        const Controlled controlled({later.get_token(), [&](const std::string& work, double) {
                                         baking = baking || work.find("baking") != std::string::npos;
                                         if (baking)
                                             later.request_stop();
                                     }});
        OpenOptions slow = open_options(threads);
        slow.environment.cube_size = 256, slow.environment.samples = 4096;
        const Result<Session> stopped = Session::open("builtin:teapot", "builtin:studio", slow);
        ASSERT_FALSE(stopped);
        EXPECT_TRUE(baking);
        EXPECT_EQ(stopped.error().code, ExitCode::stopped);
    }
}

TEST(control, stops_a_frame_and_the_next_one_is_whole)
{
    for (const int threads : {1, 2}) {
        Result<Session> session = Session::open("builtin:teapot", "builtin:studio", open_options(threads));
        ASSERT_TRUE(session);
        FrameDesc quick = long_frame(*session);
        quick.samples = 1;
        const Result<Frame> before = session->render(quick);
        ASSERT_TRUE(before);
        double last = -1.0;
        {
            std::stop_source stop;
            const Controlled controlled({stop.get_token(), [&](const std::string& work, double done) {
                                             EXPECT_EQ(work, "drawing 512x384");
                                             if (done > 0.0)
                                                 last = done, stop.request_stop();
                                         }});
            const Result<Frame> stopped = session->render(long_frame(*session));
            ASSERT_FALSE(stopped);
            EXPECT_EQ(stopped.error().code, ExitCode::stopped);
        }
        EXPECT_GT(last, 0.0);
        EXPECT_LT(last, 1.0);
        const Result<Frame> after = session->render(quick);
        ASSERT_TRUE(after);
        EXPECT_EQ(pixel_hash(after->color), pixel_hash(before->color));
    }
}

TEST(control, hears_of_shares_and_changes_no_bits)
{
    Result<Session> session = Session::open("builtin:teapot", "builtin:studio", open_options(2));
    ASSERT_TRUE(session);
    FrameDesc desc = long_frame(*session);
    desc.samples = 256;
    Result<Frame> alone = session->render(desc);
    ASSERT_TRUE(alone);
    // Make the frame longer than some pauses between two tellings, however fast the machine is
    while (alone->stats.ms < 300.0 && desc.samples < 8192) {
        desc.samples *= 2;
        alone = session->render(desc);
        ASSERT_TRUE(alone);
    }
    std::vector<double> shares;
    std::atomic<int> within = 0;
    const Controlled controlled({{}, [&](const std::string&, double done) {
                                     EXPECT_EQ(++within, 1); // one call at a time
                                     shares.push_back(done);
                                     --within;
                                 }});
    const Result<Frame> told = session->render(desc);
    ASSERT_TRUE(told);
    EXPECT_EQ(pixel_hash(told->color), pixel_hash(alone->color));
    ASSERT_FALSE(shares.empty());
    for (const double share : shares)
        EXPECT_TRUE(share == -1.0 || (share >= 0.0 && share <= 1.0)) << share;
    EXPECT_GT(*std::max_element(shares.begin(), shares.end()), 0.0) << "no share of the tiles is told";
}

TEST(control, makes_errors_of_exceptions)
{
    const Controlled controlled({{}, [](const std::string&, double) { throw std::runtime_error("no more"); }});
    const Result<Session> ended = Session::open("builtin:teapot", "builtin:studio", open_options(2));
    ASSERT_FALSE(ended);
    EXPECT_NE(ended.error().reason.find("no more"), std::string::npos) << ended.error().line();
}

// A function of progress may draw with another session, and comparisons go on.
TEST(control, stops_comparisons_and_leaves_its_own_function_alone)
{
    Result<Session> other = Session::open("builtin:plate", "builtin:studio", open_options(2));
    ASSERT_TRUE(other);
    FrameDesc desc;
    desc.width = 32, desc.height = 24, desc.view = other->framed(32, 24);
    std::stop_source stop;
    int calls = 0;
    Image picture = make_image(40, 30, 3, PixelType::f32);
    const Controlled controlled({stop.get_token(), [&](const std::string&, double) {
                                     stop.request_stop();
                                     EXPECT_TRUE(other->render(desc));
                                     ++calls;
                                 }});
    EXPECT_FALSE(Session::open("builtin:teapot", "builtin:studio", open_options(2)));
    EXPECT_EQ(calls, 1);
    EXPECT_THROW((void)pixel_figures(picture, picture, Jobs(2)), Stopped);
    EXPECT_THROW((void)flip_hdr(picture, picture, {}, Jobs(2)), Stopped);
}

// A stopped reference keeps its passes for a later run.
TEST(control, of_a_reference_leaves_a_checkpoint)
{
    if (!reference_available())
        GTEST_SKIP() << "built without Embree";
    const std::string checkpoint = testing::TempDir() + "stopped.part";
    static_cast<void>(std::remove(checkpoint.c_str()));
    Result<Session> tile = Session::open("builtin:plate", "builtin:studio", open_options(2));
    ASSERT_TRUE(tile);
    SessionOptions options;
    options.backend = Backend::reference;
    options.reference.samples = 1u << 24, options.reference.checkpoint = checkpoint;
    Result<Session> session = Session::make(tile->parts(), options);
    ASSERT_TRUE(session);
    FrameDesc desc;
    desc.width = 64, desc.height = 48, desc.technique = "mc", desc.samples = 1, desc.view = session->framed(64, 48);
    std::stop_source stop;
    {
        const Controlled controlled({stop.get_token(), [&](const std::string&, double done) {
                                         if (done > 0.0)
                                             stop.request_stop();
                                     }});
        const Result<Frame> stopped = session->render(desc);
        ASSERT_FALSE(stopped);
        EXPECT_EQ(stopped.error().code, ExitCode::stopped);
    }
    const Status readable = check_reference_checkpoint(session->parts().input(), desc, options.reference);
    EXPECT_TRUE(readable) << readable.error().line();
    EXPECT_GT(std::filesystem::file_size(checkpoint), 1000u);
    std::filesystem::remove(checkpoint);
}

TEST(control, belongs_to_its_thread)
{
    const Controlled controlled({requested_stop(), {}});
    bool opened = false;
    std::thread other([&] { opened = static_cast<bool>(Session::open("builtin:plate", "builtin:studio", open_options(2))); });
    other.join();
    EXPECT_TRUE(opened);
    EXPECT_THROW(check_stop(), Stopped);
    {
        const Controlled inner(Control{});
        EXPECT_NO_THROW(check_stop());
    }
    EXPECT_THROW(check_stop(), Stopped);
}

// A large picture of noise: its file takes long.
Image noise(int side, PixelType type)
{
    Image image = make_image(side, side, 3, type);
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < image.bytes.size(); ++i)
        state = state * 1664525u + 1013904223u, image.bytes[i] = static_cast<std::byte>((state >> 24) & 0x3f);
    return image;
}

TEST(control, stops_the_writing_of_pictures)
{
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    for (const std::string extension : {"exr", "hdr", "pfm", "png", "jpg", "tif"}) {
        const std::string path = (folder / ("stopped_picture." + extension)).string();
        std::filesystem::remove(path);
        const Image picture = noise(64, stores_floats(path) ? PixelType::f32 : PixelType::u8);
        {
            const Controlled controlled({requested_stop(), {}});
            const Status refused = write_image(path, picture);
            ASSERT_FALSE(refused) << path;
            EXPECT_EQ(refused.error().code, ExitCode::stopped) << path;
            EXPECT_FALSE(std::filesystem::exists(path)) << path;
        }
        EXPECT_TRUE(write_image(path, picture)) << path;
        std::filesystem::remove(path);
    }
    for (const std::string extension : {"exr", "png"}) { // within
        const std::string path = (folder / ("stopped_picture." + extension)).string();
        const Image picture = noise(4096, stores_floats(path) ? PixelType::f32 : PixelType::u8);
        ASSERT_TRUE(write_image(path, noise(16, picture.type))); // loads what the format needs
        std::filesystem::remove(path);
        std::stop_source stop;
        std::thread later([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(60));
            stop.request_stop();
        });
        const Controlled controlled({stop.get_token(), {}});
        const Status refused = write_image(path, picture);
        later.join();
        ASSERT_FALSE(refused) << path;
        EXPECT_EQ(refused.error().code, ExitCode::stopped) << path;
        EXPECT_FALSE(std::filesystem::exists(path)) << path;
    }
}

} // namespace
} // namespace burnish
