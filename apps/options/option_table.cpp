// The rows of `burnish render`: names, values and help texts.
#include <fmt/format.h>

#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"
#include "apps/options/options.h"
#include "apps/options/parameters.h"
#include "raster/frame/layers.h"
#include "shading/bake/mip/levels.h"

namespace burnish {
namespace {

constexpr std::int64_t kMaxFrames = 1000000, kMaxBakeSamples = 1 << 20, kMaxBounces = 1000, kMaxSteps = 100000, kMaxAnimations = 1000000;
constexpr const char* kReferenceModes[] = {"direct", "shadowed", "path"}; // by ReferenceMode

std::vector<Option> environment_rows(RenderArguments& to)
{
    EnvironmentOptions& e = to.plain.environment;
    return {
        {"--env", "FILE", "Equirectangular picture, a .gltf or .glb file with a light of images, or builtin:NAME",
         environment(to.plain.env), "the scene's own light of images, else builtin:studio"},
        {"--env-rotation", "DEG", "Turn it about +Y, counter-clockwise from above", number(e.rotation_deg, -36000.0, 36000.0)},
        {"--env-exposure", "EV", "Multiply its radiance by 2^EV", number(e.exposure_ev, -kMaxExposure, kMaxExposure)},
        {"--env-size", "N", "Texels along a cube edge, a power of two", choice(e.cube_size, {16, 32, 64, 128, 256, 512, 1024, 2048})},
        {"--key-lights", "N", "Small strong lights that leave it and meet lobes themselves: {}", extracted_lights(e.extracted_lights)},
        {"--env-samples", "N", "Samples a texel of the prefiltered levels", integer(e.samples, 1, kMaxBakeSamples)},
        {"--no-cache", "", "Neither read nor write the cache: environments, levels of mipnet and teacher and of coupled or kaiser colours",
         flag(e.use_cache, false)},
    };
}

std::vector<std::string> layer_names()
{
    std::vector<std::string> names;
    for (const LayerInfo& layer : layers())
        names.push_back(layer.name);
    return names;
}

std::vector<Option> output_rows(RenderArguments& to)
{
    return {
        {"-o,--output", "FILE", "Picture to write; may be given several times", files(to.plain.outputs)},
        {"--tonemap", "NAME", "{}, for 8-bit pictures", choice(to.plain.tonemap, {"none", "pbr-neutral", "aces"})},
        {"--resolve", "NAME",
         "What pixels of 8-bit pictures are the mean of: samples as they are, tonemapped afterwards, display: each as it is shown, or "
         "weighted: bright ones less, 1 / (1 + luminance)",
         choice(to.plain.resolve, {"linear", "display", "weighted"})},
        {"--shadows", "NAME", "Of area lights: {}, by samples of the reference that multiply what --area-lights finds",
         choice(to.plain.shadow_ratio, {"off", "ratio"})},
        {"--shadow-samples", "N", "Of --shadows, a pixel", integer(to.plain.shadow_samples, 1, 1 << 20)},
        {"--aov", "NAMES", "Layers of .exr outputs, by commas: {}", choices(to.plain.aov, layer_names()), ""},
        {"--show", "NAME",
         "What 8-bit outputs hold: {}; in false colour the level that textures are read at, how lobes lie in the picture, or normals",
         choice(to.plain.show, {"light", "lod", "tensor", "normal"})},
        {"--risks", "FILE", "Where the technique is beyond what burnish atlas found it to hold: 8-bit picture; - for the words only",
         file(to.plain.risks)},
        {"--exposure", "EV", "Multiply by 2^EV before tonemapping", number(to.plain.exposure_ev, -kMaxExposure, kMaxExposure)},
        {"--stats", "FILE", "Figures as JSON; - for standard output", file(to.plain.stats_file)},
        {"--trace", "FILE", "Chrome trace events, for ui.perfetto.dev", file(to.plain.trace_file)},
        quiet_option(to.plain.quiet),
        verbose_option(to.plain.verbosity),
    };
}

std::vector<Option> picture_rows(RenderArguments& to)
{
    FrameDesc& f = to.plain.frame;
    return {
        {"--size", "WxH", "Width and height in pixels", picture_size(to.size)},
        {"--msaa", "N", "Samples a pixel: {}", choice(f.msaa, {1, 2, 4, 8, 16})},
        {"--camera", "N|NAME", "Camera of the scene, by index or name", text(to.plain.camera), "the first, else framed"},
        {"--eye", "X,Y,Z", "Camera position, world space", place(to.plain.eye)},
        {"--target", "X,Y,Z", "What the camera looks at", place(to.plain.target), "the centre of the scene"},
        {"--orbit", "AZ,EL", "Frame the whole scene, seen from AZ degrees to the right of +Z and EL above the horizon",
         direction(to.plain.orbit_deg), "35,28 without a camera"},
        {"--fov", "DEG", "Vertical field of view", number(to.plain.fov_y_deg, 0.1, 179.0), "the camera's, else 45"},
        {"--zoom", "F", "Show things F times as large", number(to.plain.zoom, 0.01, 1000.0)},
        {"--technique", "NAME", "See burnish list techniques", choice(f.technique, technique_names())},
        {"--samples", "N", "Samples of the technique, where it takes any; of the reference, a pixel",
         integer(to.samples, 1, static_cast<std::int64_t>(kMaxReferenceSamples)), "1024"},
        {"--roughness", "R", "Override alpha_lin of every material, {}", number(f.roughness, 0.0, 1.0), ""},
        {"--anisotropy", "A", "Override eta of every material, {}: alpha_lin^2 (1 +- eta) along and across",
         number(f.anisotropy, -1.0, 1.0), ""},
        {"--time", "S", "Seconds into the scene's animation, {}", number(to.plain.moment.seconds, 0.0, 1e6), "as it rests"},
        {"--animation", "N", "Which animation --time is of", integer(to.plain.moment.animation, 0, kMaxAnimations)},
        {"--light", "SPEC", "Area light, such as sphere:points=0,1,0:radius=0.1:radiance=9,9,9; may be given several times",
         area_lights(to.plain.lights)},
        {"--as-table", "FILE|FOLDER",
         "Half vectors or albedo of as_mc: tables of burnish bake half-vectors and brdf-lut, given again or in a folder",
         files(to.plain.as_tables)},
        {"--ltc-table", "FILE", "Transformed cosines of --area-lights: a table of burnish bake ltc", file(to.plain.ltc_table),
         "the program's own"},
        {"--texture-anisotropy", "N", "Texture taps along the major axis at most", integer(f.texture_anisotropy, 1, 16)},
        {"--no-background", "", "Nothing behind the scene instead of the environment: black, alpha is coverage", flag(f.background, false)},
    };
}

std::vector<std::string> mip_filter_names()
{
    std::vector<std::string> names;
    for (const MipFilterInfo& filter : mip_filters())
        names.emplace_back(filter.name);
    return names;
}

std::vector<Option> material_rows(MaterialOverrides& to, MipSettings& mips)
{
    return {
        {"--material", "FOLDER", "Pictures that all materials are made of, by the ends of their names: x_basecolor.png, normal.exr, ...",
         folder(to.material)},
        {"--normal-map", "FILE", "Normal map of all materials", file(to.normal)},
        {"--quaternion-map", "FILE", "The same as quaternions, of burnish bake quaternion", file(to.quaternion)},
        {"--height-map", "FILE", "Heights below the surface, red: 1 is the surface; see --height-scale", file(to.height)},
        {"--normal-y", "NAME", "Green of normal maps: {}, as DirectX has it", choice(to.normal_y_down, {"up", "down"})},
        {"--direction-map", "FILE", "Picture that all materials take as anisotropy texture, of burnish bake direction", file(to.direction)},
        {"--rotation-map", "FILE", "The same in another encoding", file(to.rotation)},
        {"--rotation-encoding", "NAME", "{}: what red and green of rotations are",
         choice(to.rotation_encoding, {"vector", "double-angle", "direction"})},
        {"--roughness-map", "FILE", "Roughness by direction of all materials: along the grain, and across it", file(to.roughness)},
        {"--roughness-encoding", "NAME", "{}: alpha along and across in red and green, or roughness and anisotropy",
         choice(to.roughness_encoding, {"widths", "anisotropy"})},
        {"--mip-filter", "NAME", "What distant maps of normals and roughness become: {} (see burnish list mip-filters)",
         choice(mips.filter, mip_filter_names())},
        {"--mip-kappa", "K",
         "Of --mip-filter kappa, and of taps under mipnet and teacher: how much of the covariance of normals lobes grow by",
         number(mips.kappa, 0.0, kMostKappa), fmt::format("{}", kDefaultMipKappa).c_str()},
        {"--mip-net", "FILE", "Of --mip-filter mipnet and teacher: weights of burnish train mip", file(mips.net),
         "the program's own for --brdf"},
        {"--fallback", "NAME",
         "Of --mip-filter mipnet: {}; auto leaves materials to kappa or baseline where the net is worse than they are",
         choice(mips.fallback, {"auto", "off"})},
        {"--mip-gain", "NAME",
         "Of --mip-filter ssgt, kappa, mipnet and teacher: {}; on: colours times a gain a level, to reflect as much as the finest under "
         "lamps",
         choice(mips.gains, {"off", "on"})},
        {"--couple", "NAME", "{}; albedo: base colours and metalness of levels weigh as their texels face light and eye",
         choice(mips.couple_albedo, {"none", "albedo"})},
        {"--color-kernel", "NAME", "What base colours and metalness of levels are averaged by: {}",
         choice(mips.kaiser_colours, {"box", "kaiser"})},
        {"--mip-pyramid", "FILE",
         "Levels of burnish bake mip, in place of those made here; it says the filter, and how colours are averaged", file(mips.pyramid),
         ""},
        {"--f0", "R,G,B", "Reflectance at normal incidence of all materials, each 0 to 1", colour(to.f0)},
    };
}

std::vector<Option> row_rows(RenderArguments& to)
{
    return {
        {"--animate", "NAME=A:B",
         "Options that go from A to B, several by commas, such as roughness=0.1:0.6; -o holds the step, o_%04d.png, or all of them, o.apng",
         text(to.animate)},
        {"--steps", "N", "Pictures of --animate", integer(to.steps, 2, kMaxSteps)},
        {"--turntable", "N", "Once around the scene in N pictures, at one distance", integer(to.plain.turntable, 2, kMaxSteps), ""},
        {"--fps", "N", "Pictures a second of an .apng, {}", integer(to.plain.fps, 1, 1000)},
    };
}

std::vector<Option> machine_rows(RenderArguments& to)
{
    return {
        {"--backend", "NAME",
         "Renderer: tile, vulkan (the same on a GPU or its driver's CPU twin), or reference, which integrates by Monte Carlo",
         hinted(choice(to.plain.backend, {"tile", "vulkan", "reference"}),
                {{"gpu", "a GPU is --backend vulkan --device gpu"},
                 {"lavapipe", "that is --backend vulkan --device lavapipe"},
                 {"swiftshader", "that is --backend vulkan --device swiftshader"},
                 {"cpu", "tile is the renderer on the CPU"},
                 {"embree", "reference is the one by Embree's rays"}})},
        threads_option(to.plain.threads),
        isa_option(to.plain.isa, "{}; never changes the picture"),
        {"--tile-size", "N", "{} pixels; never changes the picture", choice(to.plain.frame.tile_size, {32, 64})},
        {"--frames", "N", "Render the frame N times and report the times", integer(to.plain.frames, 1, kMaxFrames)},
    };
}

std::vector<Option> vulkan_rows(VulkanOptions& to)
{
    return {
        {"--device", "NAME", "lavapipe, swiftshader, gpu, or a part of a device's name", text(to.device),
         "the first GPU, else a CPU device"},
        {"--sampler", "NAME", "exact (the tile renderer's bits) or native (the device's samplers, with --pipeline forward)",
         choice(to.sampler, {"exact", "native"})},
        {"--pipeline", "NAME",
         "ids (visibility first, each visible triangle of a pixel shaded once), forward (classical) or lean (forward, as an engine would "
         "shade it, with native samplers)",
         choice(to.pipeline, {"ids", "forward", "lean"})},
        {"--validate", "", "With the Khronos validation layer; fail where it complains", flag(to.validate)},
    };
}

std::vector<Option> reference_rows(RenderArguments& to)
{
    ReferenceOptions& r = to.plain.reference;
    return {
        {"--reference-mode", "NAME",
         "direct (nothing in the light's way, as the techniques have it), shadowed, or path (light between surfaces too)",
         choice(r.mode, {std::begin(kReferenceModes), std::end(kReferenceModes)})},
        {"--bounces", "N", "From surface to surface at most, in mode path", integer(r.bounces, 0, kMaxBounces)},
        {"--reference-textures", "NAME",
         "{}: over a pixel, as techniques filter them, or read where each ray meets them, which judges the filter too",
         choice(r.full_textures, {"footprint", "full"})},
        {"--target-error", "E",
         "Stop early once the 95 % confidence interval's half width over the mean, averaged over the pixels, is not above E",
         number(r.target_error, 1e-6, 1.0), ""},
        {"--checkpoint", "FILE", "Go on from this file if it is there; keep it up to date, also when stopped by Ctrl-C",
         file(r.checkpoint)},
        {"--checkpoint-seconds", "S", "Between two writes of it", number(r.checkpoint_seconds, 0.0, 86400.0)},
        {"--variance", "FILE", "Picture of the variance of the mean, by channel", file(to.plain.variance_file)},
        {"--reference-strategy", "NAME", "How directions are chosen: {}, for tests", choice(r.strategy, {"mis", "brdf", "light"})},
    };
}

} // namespace

std::string reference_mode_name(const RenderOptions& options)
{
    return kReferenceModes[static_cast<std::size_t>(options.reference.mode)];
}

OptionTable render_option_table(RenderArguments& to)
{
    OptionTable table;
    table.add("", {{"SCENE", "", "A .gltf, .glb or .obj file, or builtin:NAME", scene(to.plain.scene)}});
    table.add("Environment", environment_rows(to));
    table.add("Output", output_rows(to));
    table.add("Picture", picture_rows(to));
    table.add("Materials", material_rows(to.plain.overrides, to.plain.mips));
    table.add("Parameters of techniques", parameter_options(to.plain.frame));
    table.add("Pictures in a row", row_rows(to));
    table.add("Machine", machine_rows(to));
    table.add_needing("--backend", "vulkan", vulkan_rows(to.plain.vulkan));
    table.add_needing("--backend", "reference", reference_rows(to));
    table.add("Limits on input", limit_options(to.plain.limits));
    return table;
}

} // namespace burnish
