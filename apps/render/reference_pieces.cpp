#include "apps/render/reference_pieces.h"

#include <algorithm>
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

// Integrates some blocks, with `samples` a pixel (0: the picture's). Leaves their state in the part.
Result<Frame> render_blocks(const RenderOptions& options, FrameDesc desc, Session& session, std::uint32_t first, std::uint32_t count,
                            std::uint64_t samples)
{
    ReferencePart& part = *options.reference.part;
    part.first = first, part.count = count, part.samples = samples;
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
        BN_TRY(render_blocks(options, desc, session, (2 * i + 1) * blocks / (2 * probes), 1, passes * kPassSamples));
    return (wall_ms() - begin) * 1e-3;
}

// Returns the time of one sample of one pixel on this machine, s. Two lengths of passes, so that a picture's own set-up does not count.
Result<double> seconds_per_sample(const RenderOptions& options, const FrameDesc& desc, Session& session)
{
    constexpr std::uint64_t kShort = 1, kLong = 9;
    const std::uint32_t blocks = reference_blocks(desc.width, desc.height), probes = std::min(kProbes, blocks);
    BN_TRY(seconds_of_passes(options, desc, session, 1, kShort)); // warms up
    const Result<double> few = seconds_of_passes(options, desc, session, probes, kShort);
    BN_TRY(few);
    const Result<double> many = seconds_of_passes(options, desc, session, probes, kLong);
    BN_TRY(many);
    const double at_once = std::min<double>(session.parts().jobs->threads(), blocks);
    return std::max(*many - *few, 0.0) / (probes * at_once * static_cast<double>(kPixelsOfBlock * kPassSamples * (kLong - kShort)));
}

} // namespace

std::vector<JobPiece> reference_pieces(const RenderOptions& options, const FrameDesc& desc, Session& session)
{
    const std::uint32_t blocks = reference_blocks(desc.width, desc.height);
    const std::uint64_t samples = options.reference.samples;
    const auto each = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
        std::max(kPieceSamples / (kPixelsOfBlock * samples), (blocks + kMostPieces - 1) / kMostPieces), 1, blocks));
    const std::uint64_t picture = reference_key(session.parts().input(), session.drawn(desc), options.reference);
    const auto rate = std::make_shared<std::optional<double>>();
    std::vector<JobPiece> pieces;
    for (std::uint32_t first = 0; first < blocks; first += each) {
        const std::uint32_t count = std::min(each, blocks - first);
        const std::string key = piece_key(fmt::format("reference {:016x} {} {} {}", picture, samples, first, count));
        const auto seconds = [&options, desc, &session, rate, count, samples]() -> Result<double> {
            if (!*rate) {
                const Result<double> measured = seconds_per_sample(options, desc, session);
                BN_TRY(measured);
                *rate = *measured;
            }
            return **rate * static_cast<double>(count * kPixelsOfBlock * samples);
        };
        const auto make = [&options, desc, &session, first, count, key](const std::string& file) -> Status {
            const Result<Frame> frame = render_blocks(options, desc, session, first, count, 0);
            BN_TRY(frame);
            return frame->stats.sampling.stopped ? Status() : write_piece(file, key, options.reference.part->made);
        };
        pieces.push_back({key, seconds, make});
    }
    return pieces;
}

Status take_reference_pieces(const RenderOptions& options, const std::vector<std::string>& files, const std::vector<JobPiece>& pieces)
{
    ReferencePart& part = *options.reference.part;
    part = {};
    for (std::size_t i = 0; i < files.size(); ++i) {
        Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        part.others.push_back(std::move(*content));
    }
    return {};
}

} // namespace burnish
