#include "raster/frame/mip_files.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "core/base/file.h"
#include "raster/frame/pyramids.h"
#include "shading/bake/mip/pyramid_file.h"
#include "shading/bake/mip/source.h"

namespace burnish {

namespace {

std::string hexadecimal(std::uint64_t value)
{
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, value);
    return text;
}

} // namespace

void warn_of_unfiltered(Scene& scene)
{
    for (const Material& m : scene.materials)
        if (const std::string why = why_unfiltered(scene, m); !why.empty())
            scene.warnings.push_back("material '" + m.name + "' is filtered as by --mip-filter box: " + why);
}

Status check_mips(const Scene& scene, const std::string& path)
{
    const Jobs jobs(0);
    bool any = false;
    for (const Material& m : scene.materials) {
        if (!is_filtered(scene, m))
            continue;
        any = true;
        const std::uint64_t hash = mip_source(scene, m).hash(jobs);
        if (std::none_of(scene.mips->begin(), scene.mips->end(), [&](const MipLevels& levels) { return fits(levels, hash, m); }))
            return Error{ExitCode::bad_input, path, "",
                         "holds no levels of material '" + m.name + "' by this filter, whose maps hash to " + hexadecimal(hash)};
    }
    return any ? Status() : Error{ExitCode::bad_input, path, "", "the scene has no maps that its filter makes levels of"};
}

Status read_mips(Scene& scene, Dress& with, const Limits& limits)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(with.mip_pyramid, limits.file_bytes);
    if (!bytes)
        return bytes.error();
    Result<std::vector<MipLevels>> mips = parse_mip_file(*bytes, with.mip_pyramid);
    if (!mips)
        return mips.error();
    if (mips->empty())
        return Error{ExitCode::bad_input, with.mip_pyramid, "", "holds no levels"};
    if (with.mip_filter == MipFilter{})
        with.mip_filter = mips->front().filter, with.mip_kappa = mips->front().kappa;
    scene.mips = std::make_shared<const std::vector<MipLevels>>(std::move(*mips));
    return {};
}

} // namespace burnish
