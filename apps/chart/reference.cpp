#include "apps/chart/reference.h"

#include <filesystem>
#include <fmt/core.h>
#include <unistd.h>

#include "apps/render/stats.h"
#include "core/base/cache.h"
#include "raster/reference/scene_key.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

std::string reference_folder(const ReferenceHome& home)
{
    if (const std::string cache = cache_folder(); home.use_cache && !cache.empty()) {
        std::error_code failed;
        fs::create_directories(cache, failed);
        if (!failed && ::access(cache.c_str(), W_OK | X_OK) == 0)
            return cache;
    }
    return home.folder;
}

} // namespace

Result<Frame> kept_reference(const Session& session, const FrameDesc& desc, ReferenceOptions options, Isa isa, const ReferenceHome& home,
                             Report& report)
{
    const RenderInput input = session.parts().input();
    const FrameDesc drawn = session.drawn(desc);
    if (const std::string folder = reference_folder(home); !folder.empty()) {
        options.checkpoint = fmt::format("{}/reference-{}.part", folder, hash_text(reference_key(input, drawn, options)));
        options.checkpoint_seconds = home.save_every;
        options.own_checkpoint = true;
        options.lost_checkpoint = [&report](const Error& error) { report.warning("the reference is not kept: " + error.line()); };
        if (const Status good = check_reference_checkpoint(input, drawn, options); !good) {
            report.warning(fmt::format("{}: {}: it is made anew", options.checkpoint, good.error().reason));
            std::error_code failed;
            fs::remove(options.checkpoint, failed);
            if (failed)
                return Error{ExitCode::output_failed, options.checkpoint, "", failed.message()};
        }
    }
    SessionOptions of_reference;
    of_reference.backend = Backend::reference, of_reference.isa = isa;
    of_reference.reference = options;
    Result<Session> renderer = Session::make(session.parts(), of_reference);
    if (!renderer)
        return renderer.error();
    Result<Frame> frame = renderer->render(desc);
    if (frame && !options.checkpoint.empty() && fs::path(options.checkpoint).parent_path() == cache_folder())
        prune_cache(cache_folder(), cache_limit(), options.checkpoint);
    return frame;
}

} // namespace burnish
