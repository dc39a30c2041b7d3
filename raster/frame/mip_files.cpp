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
#include "raster/frame/mip_cache.h"
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

Result<std::shared_ptr<const mipnet::Weights>> net_of(const MipSettings& asked, const Limits& limits)
{
    using Net = std::shared_ptr<const mipnet::Weights>;
    const mipnet::Lobe lobe = lobe_of_model(asked.brdf);
    if (asked.net.empty())
        return Net(Net(), mipnet::shipped_weights(lobe)); // which is never freed
    const Result<std::vector<std::uint8_t>> bytes = read_file(asked.net, limits.file_bytes);
    BN_TRY(bytes);
    Result<mipnet::Weights> read = mipnet::parse_weights(bytes->data(), bytes->size(), asked.net);
    BN_TRY(read);
    if (read->shape.lobe != lobe)
        return Error{ExitCode::bad_input, asked.net, "byte 12",
                     std::string("is of lobes of ") + mipnet::lobe_name(read->shape.lobe) + ", and model " + lobe_model(asked.brdf).name +
                         " needs those of " + mipnet::lobe_name(lobe)};
    return std::make_shared<const mipnet::Weights>(std::move(*read));
}

std::string comparison_text(const Scene& scene, const Material& m, const mipnet::Comparison& c)
{
    char text[160];
    std::snprintf(text, sizeof text, "is filtered as by MipSettings::filter %s: the net's L1 is %.2f times baseline's, kappa's %.2f",
                  c.prefers_kappa() ? "kappa" : "baseline", c.net / c.baseline, c.kappa / c.baseline);
    return material_text(scene, m) + " " + text;
}

} // namespace

mipnet::Lobe lobe_of_model(int brdf)
{
    const ModelInfo& model = lobe_model(brdf);
    if (model.lobe_traits & kNormals_ggx)
        return mipnet::Lobe::ggx_aniso;
    return std::string(model.name) == "ashikhmin_shirley" ? mipnet::Lobe::ashikhmin_shirley : mipnet::Lobe::beckmann;
}

Status settle_nets(Scene& scene, SceneMips& mips, const MipSettings& asked, const Limits& limits, const std::vector<bool>* only)
{
    const auto wanted = [&](std::size_t i) { return !only || (*only)[i]; };
    for (std::size_t i = 0; i < mips.materials.size(); ++i)
        if (wanted(i))
            mips.materials[i].lobe = lobe_of_model(asked.brdf);
    const Jobs jobs(asked.threads);
    if (!takes_net(asked.filter)) {
        if (asked.use_cache && !mips.baked)
            cache_mips(scene, mips, jobs);
        return {};
    }
    std::shared_ptr<const mipnet::Weights> held; // by materials that stay as they are
    for (std::size_t i = 0; i < mips.materials.size(); ++i)
        if (!wanted(i) && mips.materials[i].net)
            held = mips.materials[i].net;
    const Result<std::shared_ptr<const mipnet::Weights>> net =
        held ? Result<std::shared_ptr<const mipnet::Weights>>(held) : net_of(asked, limits);
    BN_TRY(net);
    std::vector<std::optional<mipnet::Comparison>> found(scene.materials.size());
    jobs.parallel_for(found.size(), [&](std::size_t i, int) {
        if (!wanted(i))
            return;
        const Material& m = scene.materials[i];
        MaterialMips& of = mips.materials[i];
        of.net = *net;
        const Activity activity("comparing levels of " + levels_name(scene, m, of));
        if (of.filter == kMipFilter_mipnet && asked.fallback == MipFallback::automatic && is_filtered(scene, m, of))
            found[i] = compare_net(mip_source(scene, m), **net, of.kappa, is_metal(scene, m), Jobs(1));
    });
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!found[i] || found[i]->keeps_net())
            continue;
        MaterialMips& of = mips.materials[i];
        of.filter = found[i]->prefers_kappa() ? kMipFilter_kappa : kMipFilter_baseline, of.net = nullptr;
        scene.warnings.push_back(comparison_text(scene, scene.materials[i], *found[i]));
    }
    if (asked.use_cache && !mips.baked)
        cache_mips(scene, mips, jobs);
    return {};
}

void take_filters_of_mips(const Scene& scene, SceneMips& mips)
{
    const Jobs jobs(0);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        MaterialMips& of = mips.materials[i];
        of.coupled = of.kaiser = false;
        for (const UsedMap& map : used_maps(scene, m, of)) {
            const MapId id = map_id(scene, m, map, jobs);
            for (const MapLevels& levels : mips.baked->maps)
                if (levels.id.part == id.part && levels.id.source == id.source) {
                    of.coupled |= levels.id.normals != 0;
                    of.kaiser |= levels.id.kernel == ColourKernel::kaiser;
                }
        }
        if (!is_filtered(scene, m, of))
            continue;
        const std::uint64_t hash = source_hash(mip_source(scene, m), of, jobs);
        for (const MipLevels& levels : mips.baked->materials)
            if (levels.source == hash) {
                of.filter = levels.filter, of.kappa = levels.kappa, of.gains = levels.gained != 0;
                break;
            }
    }
}

void warn_of_unfiltered(Scene& scene, const SceneMips& mips)
{
    const auto warn = [&](const Material& m, const std::string& what) { scene.warnings.push_back(material_text(scene, m) + " " + what); };
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (const std::string why = why_unfiltered(scene, scene.materials[i], mips.of(i)); !why.empty())
            warn(scene.materials[i], "is filtered as by MipSettings::filter box: " + why);
    for (const Material& m : scene.materials)
        if (const std::string why = why_dim(scene, m); !why.empty())
            warn(m, "keeps no light of its normals: " + why);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (const std::string why = why_uncoupled(scene, scene.materials[i], mips.of(i)); !why.empty())
            warn(scene.materials[i], why);
}

Status check_mips(const Scene& scene, SceneMips& mips, const std::string& path)
{
    const Jobs jobs(0);
    bool any = false;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        MaterialMips& of = mips.materials[i];
        if (!is_filtered(scene, m, of))
            continue;
        any = true;
        const MipSource source = mip_source(scene, m);
        const std::uint64_t hash = source_hash(source, of, jobs);
        const auto& held = mips.baked->materials;
        if (std::none_of(held.begin(), held.end(), [&](const MipLevels& levels) { return fits(levels, source, hash, scene, m, of); }))
            return Error{ExitCode::bad_input, path, "",
                         "holds no levels of " + material_text(scene, m) + " by this filter, gain and model, whose maps hash to " +
                             hexadecimal(hash)};
        for (const UsedMap& map : used_maps(scene, m, of))
            if (const MapId id = map_id(scene, m, map, jobs); !find_map(mips.baked->maps, id, map_image(scene, *map.ref)))
                return Error{ExitCode::bad_input, path, "",
                             std::string("holds no levels of the ") + name_of(map.part) + " of " + material_text(scene, m) +
                                 " by color kernel " + (map.kernel == ColourKernel::kaiser ? "kaiser" : "box") +
                                 (map.coupled ? ", coupled" : ", not coupled") + ", whose map hashes to " + hexadecimal(id.source)};
    }
    return any ? Status() : Error{ExitCode::bad_input, path, "", "the scene has no maps that its filter makes levels of"};
}

Result<std::shared_ptr<const MipFile>> read_mips(MipSettings& asked, const Limits& limits)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(asked.pyramid, limits.file_bytes);
    BN_TRY(bytes);
    Result<MipFile> mips = parse_mip_file(*bytes, asked.pyramid);
    BN_TRY(mips);
    if (mips->materials.empty())
        return Error{ExitCode::bad_input, asked.pyramid, "", "holds no levels of normals and lobes"};
    const MipFilter held = mips->materials.front().filter;
    if (asked.box_asked && held != kMipFilter_box)
        return Error{ExitCode::bad_input, asked.pyramid, "",
                     std::string("holds levels by ") + mip_filters()[static_cast<std::size_t>(held)].name +
                         ", and MipSettings::filter is box"};
    if (asked.filter == MipFilter{})
        asked.filter = mips->materials.front().filter, asked.kappa = mips->materials.front().kappa;
    return std::make_shared<const MipFile>(std::move(*mips));
}

} // namespace burnish
