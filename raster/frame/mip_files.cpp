#include "raster/frame/mip_files.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <optional>

#include "core/base/file.h"
#include "core/jobs/activity.h"
#include "raster/frame/colours.h"
#include "raster/frame/far_normals.h"
#include "raster/frame/frame.h"
#include "raster/frame/kept_mips.h"
#include "raster/frame/pyramids.h"
#include "shading/bake/mip/net_levels.h"
#include "shading/bake/mip/pyramid_file.h"
#include "shading/bake/mip/source.h"
#include "shading/bake/mipnet/shipped.h"
#include "shading/lang/records.h"

namespace burnish {

namespace {

std::string hexadecimal(std::uint64_t value)
{
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, value);
    return text;
}

Result<std::shared_ptr<const mipnet::Weights>> net_of(const Dress& with, const Limits& limits)
{
    using Net = std::shared_ptr<const mipnet::Weights>;
    const mipnet::Lobe lobe = lobe_of_model(with.mip_brdf);
    if (with.mip_net.empty())
        return Net(Net(), mipnet::shipped_weights(lobe)); // a static object, never freed
    const Result<std::vector<std::uint8_t>> bytes = read_file(with.mip_net, limits.file_bytes);
    BN_TRY(bytes);
    Result<mipnet::Weights> read = mipnet::parse_weights(bytes->data(), bytes->size(), with.mip_net);
    BN_TRY(read);
    if (read->shape.lobe != lobe)
        return Error{ExitCode::bad_input, with.mip_net, "byte 12",
                     std::string("is of lobes of ") + mipnet::lobe_name(read->shape.lobe) + ", and model " +
                         lobe_model(with.mip_brdf).name + " needs those of " + mipnet::lobe_name(lobe)};
    return std::make_shared<const mipnet::Weights>(std::move(*read));
}

std::string comparison_text(const Material& m, const mipnet::Comparison& c)
{
    char text[160];
    std::snprintf(text, sizeof text, "is filtered as by --mip-filter %s: the net's L1 is %.2f times baseline's, kappa's %.2f",
                  c.prefers_kappa() ? "kappa" : "baseline", c.net / c.baseline, c.kappa / c.baseline);
    return "material '" + m.name + "' " + text;
}

} // namespace

mipnet::Lobe lobe_of_model(int brdf)
{
    const ModelInfo& model = lobe_model(brdf);
    if (model.lobe_traits & kNormals_ggx)
        return mipnet::Lobe::ggx_aniso;
    return std::string(model.name) == "ashikhmin_shirley" ? mipnet::Lobe::ashikhmin_shirley : mipnet::Lobe::beckmann;
}

Status settle_nets(Scene& scene, const Dress& with, const Limits& limits)
{
    for (Material& m : scene.materials)
        m.mip_lobe = static_cast<std::uint32_t>(lobe_of_model(with.mip_brdf));
    const Jobs jobs(with.threads);
    if (!takes_net(with.mip_filter)) {
        if (with.keep_mips && !scene.mips)
            keep_mips(scene, jobs);
        return {};
    }
    const Result<std::shared_ptr<const mipnet::Weights>> net = net_of(with, limits);
    BN_TRY(net);
    std::vector<std::optional<mipnet::Comparison>> found(scene.materials.size());
    jobs.parallel_for(found.size(), [&](std::size_t i, int) {
        Material& m = scene.materials[i];
        m.mip_net = *net;
        const Activity activity("comparing levels of " + levels_name(m));
        if (m.mip_filter == kMipFilter_mipnet && with.mip_fallback == MipFallback::automatic && is_filtered(scene, m))
            found[i] = compare_net(mip_source(scene, m), **net, m.mip_kappa, is_metal(scene, m), Jobs(1));
    });
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!found[i] || found[i]->keeps_net())
            continue;
        Material& m = scene.materials[i];
        m.mip_filter = found[i]->prefers_kappa() ? kMipFilter_kappa : kMipFilter_baseline, m.mip_net = nullptr;
        scene.warnings.push_back(comparison_text(m, *found[i]));
    }
    if (with.keep_mips && !scene.mips)
        keep_mips(scene, jobs);
    return {};
}

void take_filters_of_mips(Scene& scene)
{
    const Jobs jobs(0);
    for (Material& m : scene.materials) {
        m.mip_coupled = m.mip_kaiser = false;
        for (const UsedMap& map : used_maps(scene, m)) {
            const MapId id = map_id(scene, m, map, jobs);
            for (const MapLevels& levels : scene.mips->maps)
                if (levels.id.part == id.part && levels.id.source == id.source) {
                    m.mip_coupled |= levels.id.normals != 0;
                    m.mip_kaiser |= levels.id.kernel == ColourKernel::kaiser;
                }
        }
        if (!is_filtered(scene, m))
            continue;
        const std::uint64_t hash = mip_source(scene, m).hash(jobs);
        for (const MipLevels& levels : scene.mips->materials)
            if (levels.source == hash) {
                m.mip_filter = levels.filter, m.mip_kappa = levels.kappa, m.mip_gains = levels.gained != 0;
                break;
            }
    }
}

void warn_of_unfiltered(Scene& scene)
{
    for (const Material& m : scene.materials)
        if (const std::string why = why_unfiltered(scene, m); !why.empty())
            scene.warnings.push_back("material '" + m.name + "' is filtered as by --mip-filter box: " + why);
    for (const Material& m : scene.materials)
        if (const std::string why = why_dim(scene, m); !why.empty())
            scene.warnings.push_back("material '" + m.name + "' keeps no light of its normals: " + why);
    for (const Material& m : scene.materials)
        if (const std::string why = why_uncoupled(scene, m); !why.empty())
            scene.warnings.push_back("material '" + m.name + "' " + why);
}

Status check_mips(const Scene& scene, const std::string& path)
{
    const Jobs jobs(0);
    bool any = false;
    for (const Material& m : scene.materials) {
        if (!is_filtered(scene, m))
            continue;
        any = true;
        const MipSource source = mip_source(scene, m);
        const std::uint64_t hash = source.hash(jobs);
        const auto& held = scene.mips->materials;
        if (std::none_of(held.begin(), held.end(), [&](const MipLevels& levels) { return fits(levels, source, hash, scene, m); }))
            return Error{ExitCode::bad_input, path, "",
                         "holds no levels of material '" + m.name + "' by this filter, gain and model, whose maps hash to " +
                             hexadecimal(hash)};
        for (const UsedMap& map : used_maps(scene, m))
            if (const MapId id = map_id(scene, m, map, jobs); !find_map(scene.mips->maps, id, map_image(scene, *map.ref)))
                return Error{ExitCode::bad_input, path, "",
                             std::string("holds no levels of the ") + name_of(map.part) + " of material '" + m.name + "' by color kernel " +
                                 (map.kernel == ColourKernel::kaiser ? "kaiser" : "box") + (map.coupled ? ", coupled" : ", not coupled") +
                                 ", whose map hashes to " + hexadecimal(id.source)};
    }
    return any ? Status() : Error{ExitCode::bad_input, path, "", "the scene has no maps that its filter makes levels of"};
}

Status read_mips(Scene& scene, Dress& with, const Limits& limits)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(with.mip_pyramid, limits.file_bytes);
    BN_TRY(bytes);
    Result<MipFile> mips = parse_mip_file(*bytes, with.mip_pyramid);
    BN_TRY(mips);
    if (mips->materials.empty())
        return Error{ExitCode::bad_input, with.mip_pyramid, "", "holds no levels of normals and lobes"};
    if (with.mip_filter == MipFilter{})
        with.mip_filter = mips->materials.front().filter, with.mip_kappa = mips->materials.front().kappa;
    scene.mips = std::make_shared<const MipFile>(std::move(*mips));
    return {};
}

} // namespace burnish
