// Holds a picture by its hash. The hash is the same on every machine, so it belongs into the repository.
#include <burnish/burnish.hpp>
#include <cstdlib>
#include <gtest/gtest.h>

using namespace burnish;

TEST(Golden, ThePlateIsAsItWas)
{
    const char* golden = std::getenv("PLATE_HASH"); // a constant of your test
    ASSERT_TRUE(golden);
    Result<Session> session = Session::open("builtin:plate", "");
    ASSERT_TRUE(session) << session.error().line();
    FrameDesc desc;
    desc.width = 64, desc.height = 48;
    desc.samples = automatic_technique().default_samples; // as `burnish render` takes
    desc.view = session->framed(desc.width, desc.height);
    const Result<Frame> frame = session->render(desc);
    ASSERT_TRUE(frame) << frame.error().line();
    EXPECT_EQ(pixel_hash(frame->color), std::strtoull(golden, nullptr, 16));
}
