// Training: equal bytes for every way to run, and a lower loss.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/file.h"
#include "shading/lab/mipnet/train.h"

namespace burnish::mipnet {
namespace {

TrainOptions small(Layout layout = Layout::cov)
{
    TrainOptions o;
    o.shape = {Lobe::ggx_aniso, layout, {2, 8}, {2, 12}};
    o.steps = 6, o.pairs = 4, o.seeds = 1, o.side = 64;
    return o;
}

std::vector<std::uint8_t> trained(const TrainOptions& o, int threads)
{
    const Result<std::optional<Weights>> w = train(o, Jobs(threads));
    EXPECT_TRUE(w && *w);
    return w && *w ? weights_bytes(**w) : std::vector<std::uint8_t>();
}

TEST(training, gives_the_same_bytes_for_all_threads_and_instruction_sets)
{
    for (const Layout layout : {Layout::cov, Layout::paper}) {
        TrainOptions o = small(layout);
        const std::vector<std::uint8_t> wanted = trained(o, 1);
        for (int threads = 2; threads <= 3; ++threads)
            EXPECT_EQ(trained(o, threads), wanted) << threads;
        for (const Isa isa : program_isas())
            if (isa_available(isa)) {
                o.isa = isa;
                EXPECT_EQ(trained(o, 2), wanted) << isa_name(isa);
            }
    }
}

TEST(training, goes_on_from_a_checkpoint_to_the_same_bytes)
{
    const std::string file = (std::filesystem::temp_directory_path() / "burnish_training_test.part").string();
    std::filesystem::remove(file);
    TrainOptions o = small();
    const std::vector<std::uint8_t> wanted = trained(o, 1);
    std::atomic<bool> stop{false};
    TrainOptions cut = o;
    cut.checkpoint = file, cut.stop = &stop;
    cut.advance = [&stop](int step, double) { stop = step >= 3; };
    const Result<std::optional<Weights>> stopped = train(cut, Jobs(1));
    ASSERT_TRUE(stopped && !*stopped);
    TrainOptions other = o;
    other.checkpoint = file, other.seed = 2;
    EXPECT_FALSE(train(other, Jobs(1)));
    o.checkpoint = file;
    EXPECT_EQ(trained(o, 1), wanted);
    std::vector<std::uint8_t> bytes = *read_file(file, 1u << 30);
    bytes[bytes.size() / 2] ^= 1;
    ASSERT_TRUE(write_file_atomic(file, bytes.data(), bytes.size()));
    EXPECT_FALSE(train(o, Jobs(1)));
    std::filesystem::remove(file);
}

TEST(training, learns_more_than_the_closed_form)
{
    TrainOptions o = small();
    o.steps = 150, o.pairs = 16, o.seeds = 2;
    double first = 0.0, last = 0.0;
    o.advance = [&](int step, double loss) { (step <= 30 ? first : last) += step <= 30 || step > 120 ? loss / 30.0 : 0.0; };
    trained(o, 2);
    EXPECT_LT(last, 0.94 * first) << first << " to " << last;
}

} // namespace
} // namespace burnish::mipnet
