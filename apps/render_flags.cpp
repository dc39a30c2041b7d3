// The command line of `burnish render`: names, values and help texts.
#include "apps/command.h"
#include "apps/render_options.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(Pictures: .exr .hdr .pfm hold linear Rec.709 radiance as it was rendered; .png .jpg .tif are exposed, tonemapped
and encoded as sRGB. A file appears under its name only when it is complete. Without -o the frame is rendered and
its figures are printed.

Examples:
  burnish render -o teapot.png
  burnish render lamp.glb --env workshop.hdr --size 1920x1080 --msaa 8 -o lamp.png -o lamp.exr --stats lamp.json
  burnish render lamp.glb --eye 0.2,0.3,1.5 --target 0,0.2,0 --fov 30 -o close.png
  burnish render builtin:spheres --env builtin:sky --env-rotation 90 --exposure -1 -o spheres.png
  burnish render builtin:plate --frames 50 --threads 2 --isa avx2 --stats -
  burnish render --backend vulkan --device lavapipe -o teapot.png
  burnish render --backend reference --samples 4096 --checkpoint teapot.part -o teapot.exr --variance teapot_var.exr)";

void add_inputs(CLI::App& app, RenderArguments& to)
{
    app.add_option("SCENE", to.plain.scene, "A .gltf or .glb file, or builtin:NAME (builtin:teapot)");
    app.add_option("--env", to.plain.env, "Equirectangular picture or builtin:NAME (builtin:studio)")
        ->type_name("FILE")
        ->group("Environment");
    app.add_option("--env-rotation", to.env_rotation, "Turn it about +Y, counter-clockwise from above (0)")
        ->type_name("DEG")
        ->group("Environment");
    app.add_option("--env-exposure", to.env_exposure, "Multiply its radiance by 2^EV (0)")
        ->type_name("EV")
        ->group("Environment");
    app.add_option("--env-size", to.env_size, "Texels along a cube edge, a power of two (512)")
        ->type_name("N")
        ->group("Environment");
    app.add_option("--env-samples", to.env_samples, "Samples a texel of the prefiltered levels (1024)")
        ->type_name("N")
        ->group("Environment");
    app.add_flag("--no-cache", to.no_cache, "Neither read nor write the cache of baked environments")
        ->group("Environment");
}

void add_outputs(CLI::App& app, RenderArguments& to)
{
    app.add_option("-o,--output", to.plain.outputs, "Picture to write; may be given several times")
        ->type_name("FILE")
        ->allow_extra_args(false)
        ->take_all()
        ->group("Output");
    app.add_option("--tonemap", to.tonemap, "none, pbr-neutral or aces, for 8-bit pictures (pbr-neutral)")
        ->type_name("NAME")
        ->group("Output");
    app.add_option("--exposure", to.exposure, "Multiply by 2^EV before tonemapping (0)")
        ->type_name("EV")
        ->group("Output");
    app.add_option("--stats", to.plain.stats_file, "Figures as JSON; - for standard output")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--trace", to.plain.trace_file, "Chrome trace events, for ui.perfetto.dev")
        ->type_name("FILE")
        ->group("Output");
    app.add_flag("-q,--quiet", to.plain.quiet, "Print errors only")->group("Output");
    app.add_flag("-v,--verbose", to.plain.verbosity, "Print more")->group("Output");
}

void add_picture(CLI::App& app, RenderArguments& to)
{
    app.add_option("--size", to.size, "Width and height in pixels (1280x720)")
        ->type_name("WxH")
        ->group("Picture");
    app.add_option("--msaa", to.msaa, "Samples a pixel: 1, 2, 4, 8 or 16 (8)")
        ->type_name("N")
        ->group("Picture");
    app.add_option("--camera", to.plain.camera,
                   "Camera of the scene, by index or name (the first, else framed)")
        ->type_name("N|NAME")
        ->group("Picture");
    app.add_option("--eye", to.eye, "Camera position, world space")->type_name("X,Y,Z")->group("Picture");
    app.add_option("--target", to.target, "What --eye looks at (the centre of the scene)")
        ->type_name("X,Y,Z")
        ->group("Picture");
    app.add_option("--fov", to.fov, "Vertical field of view of --eye (45)")
        ->type_name("DEG")
        ->group("Picture");
    app.add_option("--technique", to.technique, "See burnish list techniques (split_isotropic)")
        ->type_name("NAME")
        ->group("Picture");
    app.add_option("--samples", to.samples, "Samples of the technique, where it takes any; of the reference, a pixel (1024)")
        ->type_name("N")
        ->group("Picture");
    app.add_option("--axis-k", to.axis_k, "Deviations of slope that the major axis covers (1)")
        ->type_name("K")
        ->group("Picture");
    app.add_option("--axis-beta", to.axis_beta, "Overlap of samples on the major axis (2.3)")
        ->type_name("B")
        ->group("Picture");
    app.add_option("--tilt", to.tilt, "Tilt every lobe against its surface, towards the bitangent and away from the tangent (0,0)")
        ->type_name("DEG,DEG")
        ->group("Picture");
    app.add_option("--dfg", to.dfg, "Directional albedo: table (baked, exact) or fit (analytic, coarse) (table)")
        ->type_name("NAME")
        ->group("Picture");
    app.add_flag("--horizon", to.horizon, "Normal maps reflect nothing from below the surface itself")->group("Picture");
    app.add_flag("--energy-compensation", to.energy_compensation, "Return the light that rough lobes lose between microfacets")
        ->group("Picture");
    app.add_option("--seed", to.seed, "Seed of techniques that use random numbers (0)")
        ->type_name("N")
        ->group("Picture");
    app.add_option("--roughness", to.roughness, "Override alpha_lin of every material, 0 to 1")
        ->type_name("R")
        ->group("Picture");
    app.add_option("--anisotropy", to.anisotropy, "Override eta of every material, -1 to 1: alpha_lin^2 (1 +- eta) along and across")
        ->type_name("A")
        ->group("Picture");
    app.add_option("--texture-anisotropy", to.texture_anisotropy,
                   "Texture taps along the major axis at most (16)")
        ->type_name("N")
        ->group("Picture");
    app.add_flag("--no-background", to.no_background, "Black behind the scene instead of the environment")
        ->group("Picture");
}

void add_machine(CLI::App& app, RenderArguments& to)
{
    app.add_option("--backend", to.plain.backend, "Renderer: tile, vulkan (the same on a GPU or its driver's CPU twin), or reference, which integrates by Monte Carlo (tile)")
        ->type_name("NAME")
        ->group("Machine");
    app.add_option("-t,--threads", to.threads, "Worker threads (all cores)")
        ->type_name("N")
        ->group("Machine");
    app.add_option("--isa", to.isa, "scalar, avx2 or avx512 (the best one); never changes the picture")
        ->type_name("NAME")
        ->group("Machine");
    app.add_option("--tile-size", to.tile_size, "32 or 64 pixels (64); never changes the picture")
        ->type_name("N")
        ->group("Machine");
    app.add_option("--frames", to.frames, "Render the frame N times and report the times (1)")
        ->type_name("N")
        ->group("Machine");
}

void add_vulkan(CLI::App& app, RenderArguments& to)
{
    constexpr const char* kGroup = "With --backend vulkan";
    app.add_option("--device", to.device, "lavapipe, swiftshader, gpu, or a part of a device's name (the first GPU, else a CPU device)")
        ->type_name("NAME")
        ->group(kGroup);
    app.add_option("--sampler", to.sampler, "exact (the tile renderer's bits) or native (the device's samplers, with --pipeline forward) (exact)")
        ->type_name("NAME")
        ->group(kGroup);
    app.add_option("--pipeline", to.pipeline, "ids (visibility first, each visible triangle of a pixel shaded once) or forward (classical) (ids)")
        ->type_name("NAME")
        ->group(kGroup);
    app.add_flag("--validate", to.validate, "With the Khronos validation layer; fail where it complains")->group(kGroup);
}

void add_reference(CLI::App& app, RenderArguments& to)
{
    constexpr const char* kGroup = "With --backend reference";
    app.add_option("--reference-mode", to.reference_mode,
                   "direct (nothing in the light's way, as the techniques have it), shadowed, or path (light between surfaces too) (direct)")
        ->type_name("NAME")
        ->group(kGroup);
    app.add_option("--bounces", to.bounces, "From surface to surface at most, in mode path (8)")->type_name("N")->group(kGroup);
    app.add_option("--target-error", to.target_error,
                   "Stop early once the 95 % confidence interval's half width over the mean, averaged over the pixels, is not above E")
        ->type_name("E")
        ->group(kGroup);
    app.add_option("--checkpoint", to.checkpoint, "Go on from this file if it is there; keep it up to date, also when stopped by Ctrl-C")
        ->type_name("FILE")
        ->group(kGroup);
    app.add_option("--variance", to.variance, "Picture of the variance of the mean, by channel")->type_name("FILE")->group(kGroup);
    app.add_option("--reference-strategy", to.reference_strategy, "How directions are chosen: mis, brdf or light, for tests (mis)")
        ->type_name("NAME")
        ->group(kGroup);
}

void add_limits(CLI::App& app, RenderArguments& to)
{
    const auto limit = [&app](const char* name, std::string& text, const char* help, const char* type) {
        app.add_option(name, text, help)->type_name(type)->group("Limits on input");
    };
    limit("--limit-image-side", to.limit_image_side, "Width and height of an input picture (16384)",
          "PIXELS");
    limit("--limit-texture-bytes", to.limit_texture_bytes, "Decoded textures of the scene (4G)", "BYTES");
    limit("--limit-json-depth", to.limit_json_depth, "Nesting of JSON (64)", "N");
    limit("--limit-node-depth", to.limit_node_depth, "Depth of the scene graph (256)", "N");
    limit("--limit-file-bytes", to.limit_file_bytes, "Size of one input file (2G)", "BYTES");
    limit("--limit-accessor-bytes", to.limit_accessor_bytes, "Decoded accessors of the scene (2G)", "BYTES");
    limit("--limit-data-uri-bytes", to.limit_data_uri_bytes, "One data URI (512M)", "BYTES");
    limit("--limit-draw-bytes", to.limit_draw_bytes, "Vertices and triangles with every instance expanded (8G)",
          "BYTES");
    app.add_flag("--allow-outside-uris", to.plain.limits.uris_outside,
                 "Read files outside the scene's folder")
        ->group("Limits on input");
}

} // namespace

void add_render_options(CLI::App& app, RenderArguments& arguments)
{
    // Of an option given twice the last one counts, so that a script can be given exceptions; -o collects.
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    add_inputs(app, arguments);
    add_outputs(app, arguments);
    add_picture(app, arguments);
    add_machine(app, arguments);
    add_vulkan(app, arguments);
    add_reference(app, arguments);
    add_limits(app, arguments);
    refuse_empty_values(app);
    app.footer(kFooter);
}

} // namespace burnish
