// Stop and progress of sessions.
#include <atomic>
#include <gtest/gtest.h>
#include <mutex>
#include <stdexcept>
#include <thread>

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

TEST(control, hears_of_shares_that_grow_and_changes_no_bits)
{
    Result<Session> session = Session::open("builtin:teapot", "builtin:studio", open_options(2));
    ASSERT_TRUE(session);
    FrameDesc desc = long_frame(*session);
    desc.samples = 32;
    const Result<Frame> alone = session->render(desc);
    ASSERT_TRUE(alone);
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
}

TEST(control, makes_errors_of_exceptions)
{
    const Controlled controlled({{}, [](const std::string&, double) { throw std::runtime_error("no more"); }});
    const Result<Session> ended = Session::open("builtin:teapot", "builtin:studio", open_options(2));
    ASSERT_FALSE(ended);
    EXPECT_NE(ended.error().reason.find("no more"), std::string::npos) << ended.error().line();
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

} // namespace
} // namespace burnish
