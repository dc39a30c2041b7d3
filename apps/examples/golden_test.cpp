// Holds a picture by its hash. The hash is the same on every machine, so it belongs into the repository.
#include <burnish/burnish.hpp>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>

using namespace burnish;

TEST(Golden, ThePlateIsAsItWas)
{
    const char* golden = std::getenv("PLATE_HASH"); // a constant of your test
    ASSERT_TRUE(golden) << "PLATE_HASH is the hash that `burnish render builtin:plate --floor off --size 64x48` prints";
    Result<Session> session = Session::open("builtin:plate", "");
    ASSERT_TRUE(session) << session.error().line();
    FrameDesc desc;
    desc.width = 64, desc.height = 48;
    desc.samples = automatic_technique().default_samples; // as `burnish render` takes
    desc.view = session->framed(desc.width, desc.height);
    const Result<Frame> frame = session->render(desc);
    ASSERT_TRUE(frame) << frame.error().line();
    char hash[17];
    std::snprintf(hash, sizeof(hash), "%016llx", static_cast<unsigned long long>(pixel_hash(frame->color)));
    EXPECT_STREQ(hash, golden);
}
