#include "apps/render/cached_reference.h"

#include <filesystem>
#include <fmt/core.h>
#include <unistd.h>

#include "core/base/cache.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

std::string reference_folder(const ReferenceCache& home)
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

ReferenceOptions cached_reference_options(ReferenceOptions options, const ReferenceCache& home, Report& report)
{
    options.checkpoint_folder = reference_folder(home);
    options.checkpoint_seconds = home.save_every;
    options.own_checkpoint = true;
    options.lost_checkpoint = [&report](const Error& error) { report.warning("the reference is not cached: " + error.line()); };
    return options;
}

Result<Frame> cached_reference(Session& reference, const FrameDesc& desc, const ReferenceOptions& options, Report& report)
{
    const RenderInput input = reference.parts().input();
    const FrameDesc drawn = reference.drawn(desc);
    const std::string file = checkpoint_of(input, drawn, options);
    if (const Status good = check_reference_checkpoint(input, drawn, options); !good) {
        report.warning(fmt::format("{}: {}: it is made anew", file, good.error().reason));
        std::error_code failed;
        fs::remove(file, failed);
        if (failed)
            return Error{ExitCode::output_failed, file, "", failed.message()};
    }
    Result<Frame> frame = reference.render(desc);
    if (frame && !file.empty() && fs::path(file).parent_path() == cache_folder())
        prune_cache(cache_folder(), cache_limit(), file);
    return frame;
}

Result<Frame> cached_reference(const Session& session, const FrameDesc& desc, const ReferenceOptions& options, Isa isa,
                               const ReferenceCache& home, Report& report)
{
    SessionOptions of_reference;
    of_reference.backend = Backend::reference, of_reference.isa = isa;
    of_reference.reference = cached_reference_options(options, home, report);
    Result<Session> reference = Session::make(session.parts(), of_reference);
    return reference ? cached_reference(*reference, desc, of_reference.reference, report) : reference.error();
}

} // namespace burnish
