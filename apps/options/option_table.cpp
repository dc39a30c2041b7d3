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

constexpr std::int64_t kMaxFrames = 1000000, kMaxBounces = 1000, kMaxSteps = 100000, kMaxAnimations = 1000000;
constexpr const char* kReferenceModes[] = {"direct", "shadowed", "path"}; // by ReferenceMode

std::vector<Option> environment_rows(RenderArguments& to)
{
    EnvironmentOptions& e = to.plain.environment;
    return {
        {"--env", "FILE",
         "Equirectangular picture, .gltf or .glb file with image-based light, folder of burnish bake environment, or builtin:NAME",
         environment(to.plain.env), "the scene's image-based light, else builtin:studio"},
        {"--env-rotation", "DEG", "Rotation of the environment about +Y in degrees, counter-clockwise seen from above",
         number(e.rotation_deg, -36000.0, 36000.0)},
        {"--env-exposure", "EV", "Exposure of the environment in stops: multiplies its radiance by 2^EV",
         number(e.exposure_ev, -kMaxEnvironmentExposure, kMaxEnvironmentExposure)},
        {"--env-size", "N", "Texels along an edge of the environment's cube map: {}",
         choice(e.cube_size, {16, 32, 64, 128, 256, 512, 1024, 2048})},
        {"--key-lights", "N", "Small strong lights to extract from the environment and shade one by one, at most: {}",
         extracted_lights(e.extracted_lights)},
        {"--env-samples", "N", "Samples a texel of the prefiltered environment levels", integer(e.samples, 1, kMaxEnvironmentSamples)},
        {"--no-cache", "", "Neither read nor write the cache: baked environments, mipnet and teacher levels, and coupled or kaiser colours",
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
        Option("-o,--output", "FILE", "Picture to write; may be given several times", files(to.plain.outputs)).is_output(),
        {"--tonemap", "NAME", "Tone curve of 8-bit pictures: {}", choice(to.plain.tonemap, {"none", "pbr-neutral", "aces"})},
        {"--resolve", "NAME",
         "Mean of a pixel's samples in 8-bit pictures: linear (before tonemapping), display (after tonemapping) or "
         "weighted (by 1 / (1 + luminance))",
         choice(to.plain.resolve, {"linear", "display", "weighted"})},
        {"--shadows", "NAME",
         "Shadows by rays, which scale the lights: off, ratio (of area lights) or on (of lamps and extracted lights too)",
         choice(to.plain.shadows, {"off", "ratio", "on"})},
        {"--shadow-samples", "N", "Samples a pixel for --shadows, rounded up to steps of 16", integer(to.plain.shadow_samples, 1, 1 << 20)},
        {"--aov", "NAMES", "Layers of .exr outputs, separated by commas: {}", choices(to.plain.aov, layer_names()), ""},
        {"--show", "NAME",
         "Contents of 8-bit outputs: {}. The last three are false colours: texture level, lobe shape in the picture, lobe normal",
         choice(to.plain.show, {"light", "lod", "tensor", "normal"})},
        Option("--risks", "FILE",
               "8-bit picture that marks pixels beyond the technique's limits, as measured by burnish atlas; - prints the words alone",
               file(to.plain.risks))
            .is_output(),
        {"--exposure", "EV", "Exposure of 8-bit pictures in stops: multiplies radiance by 2^EV before tonemapping",
         number(to.plain.exposure_ev, -kMaxExposure, kMaxExposure)},
        {"--count-operations", "",
         "Draws one frame more with lanes that count, and adds its float operations to --stats: equal on every machine",
         flag(to.plain.counts_operations)},
        Option("--stats", "FILE", "JSON file with times, counts, warnings and the pixel hash; - for standard output",
               file(to.plain.stats_file))
            .is_output(),
        Option("--trace", "FILE", "Timeline as Chrome trace events, for ui.perfetto.dev", file(to.plain.trace_file)).is_output(),
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
        {"--eye", "X,Y,Z", "Camera position in world space", place(to.plain.eye)},
        {"--target", "X,Y,Z", "Point that the camera looks at, in world space", place(to.plain.target), "the centre of the scene"},
        {"--orbit", "AZ,EL", "View of the whole scene from AZ degrees to the right of +Z and EL degrees above the horizon",
         direction(to.plain.orbit_deg), "35,28 without a camera"},
        {"--fov", "DEG", "Vertical field of view in degrees, {}", number(to.plain.fov_y_deg, 0.1, 179.0), "the camera's, else 45"},
        {"--zoom", "F", "Magnification: shows the scene F times as large, {}", number(to.plain.zoom, 0.01, 1000.0)},
        {"--technique", "NAME", "Technique for light from the environment; see burnish list techniques",
         choice(f.technique, technique_names())},
        {"--samples", "N", "Samples of the technique, if it takes any, or samples a pixel of the reference",
         integer(to.samples, 1, static_cast<std::int64_t>(kMaxReferenceSamples)), "1024"},
        {"--roughness", "R", "Override the roughness of every material, {}", number(f.roughness, 0.0, 1.0), ""},
        {"--anisotropy", "A",
         "Override the anisotropy eta of every material, {}: GGX widths roughness^2 (1 +- eta) along and across the tangent",
         number(f.anisotropy, -1.0, 1.0), ""},
        {"--time", "S", "Time in the scene's animation, {} seconds", number(to.plain.moment.seconds, 0.0, 1e6), "the scene at rest"},
        {"--animation", "N", "Animation that --time refers to, by index", integer(to.plain.moment.animation, 0, kMaxAnimations)},
        {"--variant", "NAME", "Variant of the scene's materials (KHR_materials_variants), by name", text(to.plain.moment.variant),
         "the meshes' own materials"},
        {"--floor", "NAME",
         "Floor below the scene, with soft contact shadows: off, shadow (fades into the environment), stage (bends up into a backdrop) or "
         "mirror (a stage that reflects the scene)",
         choice(to.plain.floor, {"off", "shadow", "stage", "mirror"}),
         "stage for most built-in scenes (shadow with --diffuse ashikhmin-shirley), else off"},
        {"--light", "SPEC", "Area light, such as sphere:points=0,1,0:radius=0.1:radiance=9,9,9; may be given several times",
         area_lights(to.plain.lights)},
        {"--as-table", "FILE|FOLDER",
         "Tables for as_mc from burnish bake half-vectors and brdf-lut: each file by its own option, or their folder",
         files(to.plain.as_tables)},
        {"--ltc-table", "FILE",
         "Table of linearly transformed cosines for --area-lights, from burnish bake ltc, or an .npy array of 8x8x8x8 matrices",
         file(to.plain.ltc_table), "the program's own"},
        {"--texture-anisotropy", "N", "Texture taps along the footprint's major axis at most, {}", integer(f.texture_anisotropy, 1, 16)},
        {"--no-background", "", "Leave the environment out of the background: black, with alpha as coverage", flag(f.background, false)},
    };
}

std::vector<Option> budget_rows(RenderOptions& to)
{
    return {
        {"--budget", "E", "Largest mean HDR-FLIP of the picture: chooses technique and samples of each material, as cheap as possible; {}",
         number(to.budget, 0.0, 1.0), ""},
        {"--budget-p99", "E",
         "Largest 99th percentile of the pixels' HDR-FLIP, alone or beside --budget: at most one pixel in a hundred errs more; {}",
         number(to.budget_p99, 0.0, 1.0), ""},
        {"--budget-ms", "T",
         "Largest processor time of the frame in milliseconds, on this machine: chooses the least error within it. Budgets of errors go "
         "first",
         number(to.budget_ms, 0.001, 1e9), ""},
        Option("--plan-out", "FILE", "JSON file with the choices of a budget, their predicted errors and costs; - for standard output",
               file(to.plan_out))
            .is_output(),
        {"--plan", "FILE", "Draws with the choices of such a file, which must be for the same scene, view and options", file(to.plan_file)},
        {"--verify", "", "Renders the reference too, and prints the picture's error beside the predicted one", flag(to.verify)},
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
        {"--material", "PATH",
         "MaterialX file (.mtlx), or folder of pictures for all materials, told apart by the ends of their names: x_basecolor.png, ...",
         folder(to.material)},
        {"--normal-map", "FILE", "Normal map of all materials", file(to.normal)},
        {"--quaternion-map", "FILE", "Normal map of all materials as quaternions, from burnish bake quaternion", file(to.quaternion)},
        {"--height-map", "FILE", "Height map of all materials, red: 1 is the surface, 0 is deepest; see --height-scale", file(to.height)},
        {"--normal-y", "NAME", "Direction of green in normal maps: up, as glTF has it, or down, as DirectX has it",
         choice(to.normal_y_down, {"up", "down"})},
        {"--direction-map", "FILE",
         "Anisotropy texture of all materials: direction of the stretched highlight (scratches run across it); see burnish bake direction",
         file(to.direction)},
        {"--rotation-map", "FILE",
         "Direction of the stretched highlight for all materials, or of grooves (--strokes), in --rotation-encoding; see burnish bake tpr",
         file(to.rotation)},
        {"--rotation-encoding", "NAME",
         "Red and green of --rotation-map: vector, double-angle (cosine and sine of twice the angle) or direction (as "
         "KHR_materials_anisotropy)",
         choice(to.rotation_encoding, {"vector", "double-angle", "direction"})},
        {"--strokes", "NAME", "Direction that --rotation-map shows: {}; the stretched highlight runs across grooves",
         choice(to.strokes, {"grooves", "highlights"})},
        {"--roughness-map", "FILE", "Roughness of all materials by direction: along the anisotropy direction, and across it",
         file(to.roughness)},
        {"--roughness-encoding", "NAME",
         "Red and green of --roughness-map: widths (alpha along and across) or anisotropy (roughness and anisotropy)",
         choice(to.roughness_encoding, {"widths", "anisotropy"})},
        {"--mip-filter", "NAME", "Filter for distant normal and roughness maps: {} (see burnish list mip-filters)",
         choice(mips.filter, mip_filter_names())},
        {"--mip-kappa", "K",
         "For the kappa filter, and for taps under mipnet and teacher: share of the normals' covariance that widens lobes, {}",
         number(mips.kappa, 0.0, kMostKappa), fmt::format("{}", kDefaultMipKappa).c_str()},
        {"--mip-net", "FILE", "For the mipnet and teacher filters: weights from burnish train mip", file(mips.net),
         "the program's own for --brdf"},
        {"--fallback", "NAME", "For the mipnet filter: {}; auto takes kappa or baseline for materials where the net is worse",
         choice(mips.fallback, {"auto", "off"})},
        {"--mip-gain", "NAME",
         "For the ssgt, kappa, mipnet and teacher filters: {}; on scales each level's colours to reflect as much lamp light as "
         "the finest level",
         choice(mips.gains, {"off", "on"})},
        {"--couple", "NAME",
         "Weights of base colours and metalness in mip levels: none, or albedo (texels that face light and eye weigh more)",
         choice(mips.couple_albedo, {"none", "albedo"})},
        {"--color-kernel", "NAME", "Averaging kernel for base colours and metalness in mip levels: {}",
         choice(mips.kaiser_colours, {"box", "kaiser"})},
        {"--mip-pyramid", "FILE",
         "Mip levels from burnish bake mip, used as they are; the file sets the filter and the averaging of colours", file(mips.pyramid),
         ""},
        {"--f0", "R,G,B", "Reflectance at normal incidence of all materials, each 0 to 1", colour(to.f0)},
    };
}

std::vector<Option> row_rows(RenderArguments& to)
{
    return {
        {"--animate", "NAME=A:B",
         "Options that move from A to B, separated by commas, such as roughness=0.1:0.6; -o is o_%04d.png or o.apng", text(to.animate)},
        {"--steps", "N", "Number of pictures for --animate", integer(to.steps, 2, kMaxSteps)},
        {"--turntable", "N", "Number of pictures for one turn around the scene, at constant distance",
         integer(to.plain.turntable, 2, kMaxSteps), ""},
        {"--fps", "N", "Pictures a second in an .apng, {}", integer(to.plain.fps, 1, 1000)},
    };
}

std::vector<Option> machine_rows(RenderArguments& to)
{
    return {
        {"--backend", "NAME", "Renderer: tile, vulkan (the same method on a Vulkan device) or reference (Monte Carlo integration)",
         hinted(choice(to.plain.backend, {"tile", "vulkan", "reference"}),
                {{"gpu", "a GPU is --backend vulkan --device gpu"},
                 {"lavapipe", "that is --backend vulkan --device lavapipe"},
                 {"swiftshader", "that is --backend vulkan --device swiftshader"},
                 {"cpu", "tile is the renderer on the CPU"},
                 {"embree", "reference is the one by Embree's rays"}})},
        threads_option(to.plain.threads),
        isa_option(to.plain.isa, "Instruction set: {}; never changes the picture"),
        {"--tile-size", "N", "Edge of a tile in pixels: {}; never changes the picture", choice(to.plain.frame.tile_size, {32, 64})},
        {"--frames", "N", "Render the frame N times and report the times", integer(to.plain.frames, 1, kMaxFrames)},
    };
}

std::vector<Option> vulkan_rows(VulkanOptions& to)
{
    return {
        {"--device", "NAME", "Vulkan device: lavapipe, swiftshader, gpu, or part of a device's name", text(to.device),
         "the first GPU, else a CPU device"},
        {"--sampler", "NAME",
         "Texture sampler: exact (the tile renderer's bits) or native (the device's samplers, with --pipeline forward)",
         choice(to.sampler, {"exact", "native"})},
        {"--pipeline", "NAME", "Pipeline: ids (visibility first, one shading for each visible triangle and pixel) or forward (classical)",
         choice(to.pipeline, {"ids", "forward"})},
        {"--validate", "", "Run the Khronos validation layer, and fail on its complaints", flag(to.validate)},
    };
}

std::vector<Option> reference_rows(RenderArguments& to)
{
    ReferenceOptions& r = to.plain.reference;
    return {
        {"--reference-mode", "NAME", "Paths of light: direct (unshadowed, as in techniques), shadowed, or path (also between surfaces)",
         choice(r.mode, {std::begin(kReferenceModes), std::end(kReferenceModes)})},
        {"--bounces", "N", "Bounces from surface to surface at most, in mode path", integer(r.bounces, 0, kMaxBounces)},
        {"--reference-textures", "NAME",
         "Texture reads: footprint (filtered over a pixel, as in techniques) or full (at each ray's hit, the reference for maps)",
         choice(r.full_textures, {"footprint", "full"})},
        {"--target-error", "E",
         "Stop early at this relative error: half the 95 % confidence interval over the mean, averaged over the pixels",
         number(r.target_error, 1e-6, 1.0), ""},
        Option("--checkpoint", "FILE", "Checkpoint file: continues from it if it exists, and updates it, also when stopped by Ctrl-C",
               file(r.checkpoint))
            .is_output(),
        {"--checkpoint-seconds", "S", "Seconds between updates of the checkpoint", number(r.checkpoint_seconds, 0.0, 86400.0)},
        Option("--variance", "FILE", "Picture of the mean's variance in each channel", file(to.plain.variance_file)).is_output(),
        {"--reference-strategy", "NAME", "Sampling of directions, for tests: {}", choice(r.strategy, {"mis", "brdf", "light"})},
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
    table.add("Budget", budget_rows(to.plain));
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
