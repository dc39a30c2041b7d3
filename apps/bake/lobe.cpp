#include "apps/bake/lobe.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <utility>

#include "apps/bake/lobe_maps.h"
#include "apps/bake/preview.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "core/base/text.h"
#include "core/image/io/image_io.h"
#include "core/math/scalar_math.h"
#include "raster/frame/frame.h"

namespace burnish {

namespace fs = std::filesystem;

// Distance above which the warning says that there is no single lobe.
static constexpr double kNoLobe = 0.35;

int run_lobe(const LobeArguments& a)
{
    if (a.heights.empty() || a.output.empty())
        return fail(usage_error(a.heights.empty() ? "PICTURE" : "-o", "is needed: heights, and the folder for the maps"));
    if (a.brdf != "ggx_aniso" && a.brdf != "beckmann")
        return fail(usage_error("--brdf", fmt::format("{}: lobe fits ggx_aniso or beckmann", a.brdf)));
    if (const Status path = check_folder_path(a.output); !path)
        return fail(path.error());
    const Result<Image> heights = read_image(a.heights, a.limits);
    if (!heights)
        return fail(heights.error());
    constexpr int kHeights = 64;
    const PictureSize size =
        a.size.width > 0 ? a.size : PictureSize{std::max(1, heights->width / kHeights), std::max(1, heights->height / kHeights)};
    const Result<LobeMaps> made = lobe_maps(*heights, a.depth, size.width, size.height,
                                            a.brdf == "beckmann" ? SlopeModel::beckmann : SlopeModel::ggx, Jobs(a.threads));
    if (!made)
        return fail(a.size.width > 0 ? usage_error("--size", made.error().reason)
                                     : Error{ExitCode::bad_input, a.heights, "", made.error().reason});
    const Preview preview = preview_of_heights(*heights, a.depth);
    if (const Status fits = check_preview(a.preview, preview, {a.heights}); !fits)
        return fail(fits.error());
    if (const Status folder = make_output_folder(a.output); !folder)
        return fail(folder.error());
    Report report(a.quiet, a.verbosity);
    report.release();
    if (const std::uint64_t bad = heights->type == PixelType::f32 ? count_not_finite(*heights) : 0)
        report.warning(fmt::format("{}: {} pixels are no numbers and lie at the surface", a.heights, bad));
    for (const auto& [name, map] : {std::pair<const char*, const Image*>{"roughness.exr", &made->roughness},
                                    {"rotation.exr", &made->rotation},
                                    {"normal.exr", &made->normal}}) {
        const std::string path = (fs::path(a.output) / name).string();
        if (const Status written = write_image(path, *map); !written)
            return fail(written.error());
        report.wrote(path);
    }
    const SlopeLobe& middle = made->middle;
    report.event("lobe",
                 fmt::format("{}x{} of {}; the median: widths {:.3g} and {:.3g} at {:.0f} degrees, {:.2f} from its slopes", size.width,
                             size.height, a.brdf, middle.alpha_along, middle.alpha_across, middle.angle * 180.0 / kPi, middle.distance));
    if (made->clamped > 0)
        report.warning(fmt::format("{}: {} with a width above 1, the widest that maps hold", a.heights,
                                   counted(static_cast<std::uint64_t>(made->clamped), "lobe")));
    if (middle.distance > kNoLobe)
        report.warning(fmt::format("{}: no single lobe of {} reflects like these heights", a.heights, a.brdf));
    if (const Status written = write_preview(a.preview, preview, report); !written)
        return fail(written.error());
    return 0;
}

} // namespace burnish
