#include "apps/render_options.h"

#include <algorithm>
#include <cstdlib>
#include <array>
#include <fmt/format.h>

#include "apps/option_reader.h"
#include "apps/parse.h"
#include "apps/reference_options.h"
#include "apps/report.h"
#include "apps/vulkan_options.h"
#include "core/math/scalar_math.h"
#include "core/scene/builtin.h"

namespace burnish {
namespace {

constexpr std::int64_t kMaxThreads = 1024;
constexpr std::int64_t kMaxFrames = 1000000;
constexpr std::int64_t kMaxTechniqueSamples = 65536;
constexpr std::int64_t kMaxBakeSamples = 1 << 20;
constexpr double kMaxExposure = 64.0; // stops either way: 2^64 is far beyond any scene

void read_limits(const RenderArguments& in, OptionReader& reader, Limits& limits)
{
    constexpr std::int64_t kMaxInt = 1 << 30;
    reader.integer("--limit-image-side", in.limit_image_side, 1, kMaxInt, limits.image_side);
    reader.bytes("--limit-texture-bytes", in.limit_texture_bytes, limits.texture_bytes);
    reader.integer("--limit-json-depth", in.limit_json_depth, 1, 10000, limits.json_depth);
    reader.integer("--limit-node-depth", in.limit_node_depth, 1, 10000, limits.node_depth);
    reader.bytes("--limit-file-bytes", in.limit_file_bytes, limits.file_bytes);
    reader.bytes("--limit-accessor-bytes", in.limit_accessor_bytes, limits.accessor_bytes);
    reader.bytes("--limit-data-uri-bytes", in.limit_data_uri_bytes, limits.data_uri_bytes);
    reader.bytes("--limit-draw-bytes", in.limit_draw_bytes, limits.draw_bytes);
}

void read_environment(const RenderArguments& in, OptionReader& reader, EnvironmentOptions& environment)
{
    reader.number("--env-rotation", in.env_rotation, -36000.0, 36000.0, environment.rotation_deg);
    reader.number("--env-exposure", in.env_exposure, -kMaxExposure, kMaxExposure, environment.exposure_ev);
    reader.choice("--env-size", in.env_size, {"16", "32", "64", "128", "256", "512", "1024", "2048"},
                  environment.cube_size);
    reader.integer("--env-samples", in.env_samples, 1, kMaxBakeSamples, environment.samples);
    environment.use_cache = !in.no_cache;
}

void read_camera(const RenderArguments& in, OptionReader& reader, RenderOptions& out)
{
    reader.vec3("--eye", in.eye, out.eye);
    reader.vec3("--target", in.target, out.target);
    reader.number("--fov", in.fov, 0.1, 179.0, out.fov_y_deg);
    if (out.eye && !out.camera.empty())
        reader.refuse(usage_error("--eye", "cannot be combined with --camera"));
    if (!out.eye && (out.target || !in.fov.empty()))
        reader.refuse(usage_error(out.target ? "--target" : "--fov", "needs --eye"));
    if (out.eye && out.target && *out.eye == *out.target)
        reader.refuse(usage_error("--target", "is the same point as --eye"));
}

void read_picture(const RenderArguments& in, OptionReader& reader, RenderOptions& out)
{
    FrameDesc& frame = out.frame;
    if (!in.size.empty()) {
        const Result<PictureSize> size = parse_picture_size("--size", in.size);
        if (!size)
            return reader.refuse(size.error());
        frame.width = size->width;
        frame.height = size->height;
    }
    reader.choice("--msaa", in.msaa, {"1", "2", "4", "8", "16"}, frame.msaa);
    for (const int side : {frame.width, frame.height})
        if (side < 1 || side > kMaxPictureSide)
            return reader.refuse(
                usage_error("--size", fmt::format("each side must be from 1 to {} pixels, got {}x{}",
                                                  kMaxPictureSide, frame.width, frame.height)));
    const std::int64_t samples = std::int64_t{frame.width} * frame.height * frame.msaa;
    if (samples > kMaxPictureSamples)
        reader.refuse(
            usage_error("--size", fmt::format("{}x{} with --msaa {} is {} samples, more than {}", frame.width,
                                              frame.height, frame.msaa, samples, kMaxPictureSamples)));
    reader.choice("--tile-size", in.tile_size, {"32", "64"}, frame.tile_size);
    reader.integer("--texture-anisotropy", in.texture_anisotropy, 1, 16, frame.texture_anisotropy);
    reader.number("--roughness", in.roughness, 0.0, 1.0, frame.roughness);
    reader.number("--anisotropy", in.anisotropy, -1.0, 1.0, frame.anisotropy);
    frame.override_anisotropy = !in.anisotropy.empty();
    frame.background = !in.no_background;
    reader.number("--exposure", in.exposure, -kMaxExposure, kMaxExposure, out.exposure_ev);
    if (!in.tonemap.empty()) {
        const Result<Tonemap> tonemap = parse_tonemap(in.tonemap);
        if (!tonemap)
            return reader.refuse(usage_error(
                "--tonemap", fmt::format("'{}' is not one of none, pbr-neutral, aces", in.tonemap)));
        out.tonemap = *tonemap;
        out.tonemap_name = in.tonemap;
    }
}

void read_technique(const RenderArguments& in, OptionReader& reader, RenderOptions& out)
{
    FrameDesc& frame = out.frame;
    if (!in.technique.empty())
        frame.technique = in.technique;
    const TechniqueInfo* technique = find_technique(frame.technique);
    if (!technique) {
        std::vector<std::string> names;
        for (const TechniqueInfo& known : techniques())
            names.emplace_back(known.name);
        return reader.refuse(
            usage_error("--technique", fmt::format("'{}' is not one of {}", frame.technique, join(names))));
    }
    int samples = technique->default_samples;
    if (out.backend != "reference") // which reads them itself
        reader.integer("--samples", in.samples, 1, kMaxTechniqueSamples, samples);
    if (samples > technique->most_samples)
        return reader.refuse(usage_error("--samples", fmt::format("{} takes 1 to {}, got {}", frame.technique, technique->most_samples, samples)));
    frame.samples = samples_taken(*technique, samples);
    if (frame.samples != samples)
        out.warnings.push_back(
            fmt::format("--samples {}: {} takes {}", samples, frame.technique, frame.samples));
    reader.number("--axis-k", in.axis_k, 0.01, 10.0, frame.major_axis_k);
    reader.number("--axis-beta", in.axis_beta, 0.0, 100.0, frame.major_axis_beta);
    if (!in.tilt.empty()) {
        const std::size_t comma = in.tilt.find(',');
        if (comma == std::string::npos)
            return reader.refuse(usage_error("--tilt", fmt::format("expected two angles such as 20,0, got '{}'", in.tilt)));
        glm::vec2 degrees{0.0f};
        for (int i = 0; i < 2; ++i) {
            const std::string angle = i ? in.tilt.substr(comma + 1) : in.tilt.substr(0, comma);
            if (angle.empty())
                return reader.refuse(usage_error("--tilt", fmt::format("expected two angles such as 20,0, got '{}'", in.tilt)));
            reader.number("--tilt", angle, -80.0, 80.0, degrees[i]);
        }
        frame.tilt_rad = degrees * static_cast<float>(kPi / 180.0);
    }
    if (in.dfg != "table" && in.dfg != "fit")
        reader.refuse(usage_error("--dfg", fmt::format("'{}' is not one of table, fit", in.dfg)));
    frame.dfg_fit = in.dfg == "fit";
    frame.energy_compensation = in.energy_compensation;
    frame.horizon = in.horizon;
    reader.integer("--seed", in.seed, 0, 0x7fffffff, frame.seed);
}

void read_machine(const RenderArguments& in, OptionReader& reader, RenderOptions& out)
{
    const std::vector<std::string> backends = backend_names();
    if (std::find(backends.begin(), backends.end(), out.backend) == backends.end())
        reader.refuse(
            usage_error("--backend", fmt::format("'{}' is not one of {}", out.backend, join(backends))));
    reader.integer("--threads", in.threads, 1, kMaxThreads, out.threads);
    reader.integer("--frames", in.frames, 1, kMaxFrames, out.frames);
    if (const char* forced = std::getenv("BN_FORCE_ISA"); forced && !parse_isa(forced))
        reader.refuse(usage_error("BN_FORCE_ISA", fmt::format("'{}' is not one of scalar, avx2, avx512", forced)));
    out.isa = best_isa();
    if (in.isa.empty())
        return;
    const Result<Isa> isa = parse_isa(in.isa);
    if (!isa)
        return reader.refuse(
            usage_error("--isa", fmt::format("'{}' is not one of scalar, avx2, avx512", in.isa)));
    if (!isa_available(*isa))
        return reader.refuse(
            Error{ExitCode::unavailable, "", "--isa",
                  fmt::format("this machine cannot run {}, at most {}", in.isa, isa_name(best_isa()))});
    out.isa = *isa;
}

// "builtin:NAME" with a name that exists, or anything else (a path).
void check_builtin(OptionReader& reader, const std::string& option, const std::string& spec,
                   const std::vector<BuiltinInfo>& known)
{
    constexpr const char* kPrefix = "builtin:";
    if (spec.rfind(kPrefix, 0) != 0)
        return;
    std::vector<std::string> names;
    for (const BuiltinInfo& info : known)
        names.push_back(kPrefix + std::string(info.name));
    if (std::find(names.begin(), names.end(), spec) == names.end())
        reader.refuse(usage_error(option, fmt::format("'{}' is not one of {}", spec, join(names))));
}

} // namespace

std::vector<std::string> backend_names()
{
    return {"tile", "vulkan", "reference"};
}

Result<RenderOptions> check_render_options(const RenderArguments& arguments)
{
    RenderOptions out = arguments.plain;
    OptionReader reader;
    if (out.scene.empty())
        reader.refuse(usage_error("SCENE", "is empty"));
    if (out.env.empty())
        reader.refuse(usage_error("--env", "is empty"));
    check_builtin(reader, "SCENE", out.scene, builtin_scenes());
    check_builtin(reader, "--env", out.env, builtin_environments());
    read_picture(arguments, reader, out);
    read_technique(arguments, reader, out);
    read_machine(arguments, reader, out);
    read_reference(arguments, reader, out);
    read_vulkan(arguments, reader, out);
    read_camera(arguments, reader, out);
    read_environment(arguments, reader, out.environment);
    read_limits(arguments, reader, out.limits);
    if (!reader.status())
        return reader.status().error();
    out.environment.quiet = out.quiet;
    return out;
}

} // namespace burnish
