#include "apps/render/reference_pieces.h"

#include <algorithm>
#include <bit>
#include <fmt/core.h>
#include <memory>
#include <optional>

#include "core/base/clock.h"
#include "raster/reference/scene_key.h"
#include "raster/reference/sobol.h"

namespace burnish {
namespace {

constexpr std::uint64_t kPieceSamples = 1u << 22, kMostPieces = 4096; // a second or more each
constexpr std::uint64_t kPixelsOfBlock = 64;
constexpr std::uint32_t kProbes = 8; // blocks that are timed for an estimate

std::uint64_t samples_of_pass(const RenderOptions& options)
{
    return static_cast<std::uint64_t>(kPassPositions) * static_cast<std::uint64_t>(options.reference.shades);
}

struct Range {
    std::uint64_t first, count;
};

// Integrates passes of some blocks. Leaves their state in the part.
Result<Frame> render_blocks(const RenderOptions& options, FrameDesc desc, Session& session, Range blocks, Range passes)
{
    ReferencePart& part = *options.reference.part;
    part.first = static_cast<std::uint32_t>(blocks.first), part.count = static_cast<std::uint32_t>(blocks.count);
    part.first_pass = static_cast<std::uint32_t>(passes.first), part.samples = passes.count * samples_of_pass(options);
    desc.triangle_ids = false;
    return session.render(desc);
}

// Returns the time of some passes over some blocks, s.
Result<double> seconds_of_passes(const RenderOptions& options, const FrameDesc& desc, Session& session, std::uint32_t probes,
                                 std::uint64_t passes)
{
    const std::uint32_t blocks = reference_blocks(desc.width, desc.height);
    const double begin = wall_ms();
    for (std::uint32_t i = 0; i < probes; ++i)
        BN_TRY(render_blocks(options, desc, session, {(2 * i + 1) * blocks / (2 * probes), 1}, {0, passes}));
    return (wall_ms() - begin) * 1e-3;
}

// Returns the time of one pass of one pixel by one thread, s. Two lengths of passes, so that a picture's own set-up does not count.
Result<double> seconds_per_pass(const RenderOptions& options, const FrameDesc& desc, Session& session)
{
    constexpr std::uint64_t kShort = 1, kLong = 9;
    const std::uint32_t blocks = reference_blocks(desc.width, desc.height), probes = std::min(kProbes, blocks);
    BN_TRY(seconds_of_passes(options, desc, session, 1, kShort)); // warms up
    const Result<double> few = seconds_of_passes(options, desc, session, probes, kShort);
    BN_TRY(few);
    const Result<double> many = seconds_of_passes(options, desc, session, probes, kLong);
    BN_TRY(many);
    return std::max(*many - *few, 0.0) / (probes * static_cast<double>(kPixelsOfBlock * (kLong - kShort)));
}

} // namespace

std::vector<JobPiece> reference_pieces(const RenderOptions& options, const FrameDesc& desc, Session& session)
{
    const std::uint64_t blocks = reference_blocks(desc.width, desc.height);
    const std::uint64_t passes = reference_passes(options.reference.samples, options.reference.shades),
                        each_pass = samples_of_pass(options);
    const std::uint64_t at_once = std::clamp<std::uint64_t>(
        std::max(kPieceSamples / (kPixelsOfBlock * each_pass * passes), (blocks + kMostPieces - 1) / kMostPieces), 1, blocks);
    // Split the passes, too, where one block is much: into nodes of the tree in which they are summed
    std::uint64_t node = std::bit_ceil(passes);
    if (at_once == 1)
        node = std::min(node, std::bit_floor(kPieceSamples / (kPixelsOfBlock * each_pass)));
    while (blocks * ((passes + node - 1) / node) > kMostPieces && node < passes)
        node *= 2;
    const std::uint64_t picture = reference_key(session.parts().input(), session.drawn(desc), options.reference);
    options.reference.part->key = picture;
    const auto rate = std::make_shared<std::optional<double>>();
    std::vector<JobPiece> pieces;
    const auto add = [&](Range of_blocks, Range of_passes) {
        const std::string key = piece_key(fmt::format("reference {:016x} blocks {} {} passes {} {}", picture, of_blocks.first,
                                                      of_blocks.count, of_passes.first, of_passes.count));
        const auto seconds = [&options, desc, &session, rate, of_blocks, of_passes]() -> Result<double> {
            if (!*rate) {
                const Result<double> measured = seconds_per_pass(options, desc, session);
                BN_TRY(measured);
                *rate = *measured;
            }
            const double threads = std::min<double>(session.parts().jobs->threads(), static_cast<double>(of_blocks.count));
            return **rate * static_cast<double>(of_blocks.count * kPixelsOfBlock * of_passes.count) / threads;
        };
        const auto make = [&options, desc, &session, of_blocks, of_passes, key](const std::string& file) -> Status {
            const Result<Frame> frame = render_blocks(options, desc, session, of_blocks, of_passes);
            BN_TRY(frame);
            return frame->stats.sampling.stopped ? Status() : write_piece(file, key, options.reference.part->made);
        };
        pieces.push_back({key, seconds, make});
    };
    for (std::uint64_t block = 0; block < blocks; block += at_once)
        for (std::uint64_t pass = 0; pass < passes; pass += node)
            add({block, std::min(at_once, blocks - block)}, {pass, std::min(node, passes - pass)});
    return pieces;
}

Status take_reference_pieces(const RenderOptions& options, const std::vector<std::string>& files, const std::vector<JobPiece>& pieces)
{
    ReferencePart& part = *options.reference.part;
    const std::uint64_t key = part.key;
    part = {};
    part.key = key;
    for (std::size_t i = 0; i < files.size(); ++i) {
        Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        part.others.push_back(std::move(*content));
    }
    return {};
}

} // namespace burnish
