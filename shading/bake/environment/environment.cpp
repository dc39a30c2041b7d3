#include "shading/bake/environment/environment.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "core/base/cache.h"
#include "core/base/hash.h"
#include "core/image/io/image_io.h"
#include "core/jobs/activity.h"
#include "core/jobs/control.h"
#include "core/math/scalar_math.h"
#include "core/scene/builtin/builtin.h"
#include "core/simd/dispatch.h"
#include "shading/bake/environment/cube_map.h"
#include "shading/bake/environment/cube_picture.h"
#include "shading/bake/environment/environment_cache.h"
#include "shading/bake/environment/equirect.h"
#include "shading/bake/environment/extracted_lights.h"
#include "shading/bake/environment/image_light.h"
#include "shading/bake/environment/light_tree.h"
#include "shading/bake/environment/prefilter.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

constexpr int kIrradianceSource = 64; // texels along an edge of the level that irradiance reads
constexpr int kTexelsAJob = 512;
constexpr int kMostBlocksAlong = 8, kSquaresAlong = 4; // blocks along a square that shares a walk at most; squares along a face at least
// A light piece's size over its distance (light_tree.h), times the square root of the number of pieces, roughly. Chosen so that 1024
// pieces suffice under suns and between lamps.
constexpr double kOpening = 6.4, kWidestOpening = 1.0;

// Runs a kernel in pieces over all texels of a cube, face by face.
template <class Kernel> std::vector<float> run_over_cube(int size, const Jobs& jobs, Progress& progress, const Kernel& kernel)
{
    std::vector<float> rgb(cube_texels(size) * 3);
    const int face_texels = size * size, piece = std::min(kTexelsAJob, face_texels), pieces = face_texels / piece;
    jobs.parallel_for(6 * static_cast<std::size_t>(pieces), [&](std::size_t i, int) {
        const int face = static_cast<int>(i) / pieces, first = static_cast<int>(i) % pieces * piece;
        const std::size_t texel = static_cast<std::size_t>(face) * static_cast<std::size_t>(face_texels) + static_cast<std::size_t>(first);
        kernel(face, first, piece, rgb.data() + texel * 3);
        progress.step(static_cast<std::size_t>(piece));
    });
    return rgb;
}

std::vector<CubeLevel> box_chain(CubeLevel level0, const Jobs& jobs)
{
    std::vector<CubeLevel> chain;
    chain.push_back(std::move(level0));
    while (chain.back().size > 1)
        chain.push_back(half_cube_level(chain.back(), jobs));
    return chain;
}

// Prefilters a level, in blocks of texels that share their terms and squares of blocks that share a walk over the light tree.
std::vector<float> prefilter_level(const std::vector<LightLevel>& tree, int size, double alpha, double opening, const Jobs& jobs,
                                   Progress& progress)
{
    std::vector<float> rgb(cube_texels(size) * 3);
    const BakeFns& fns = pick<BakeFns>();
    const int side = std::min(kPrefilterBlock, size), along = std::clamp(size / side / kSquaresAlong, 1, kMostBlocksAlong);
    const int squares = size / side / along;
    std::vector<GatherScratch> scratch(static_cast<std::size_t>(jobs.threads()));
    jobs.parallel_for(6 * static_cast<std::size_t>(squares) * static_cast<std::size_t>(squares), [&](std::size_t i, int worker) {
        const int at = static_cast<int>(i), face = at / (squares * squares), wide = side * along;
        const int left = at % squares * wide, top = at / squares % squares * wide;
        const double step = 2.0 / size;
        const BlockSquare square = {face, along, left * step - 1.0, top * step - 1.0, side * step};
        gather_terms(tree, square, alpha, opening, scratch[static_cast<std::size_t>(worker)],
                     [&](int block_x, int block_y, std::span<const PrefilterTerm> terms) {
                         const int x = left + block_x * side, y = top + block_y * side;
                         float block[kPrefilterBlock * kPrefilterBlock * 3];
                         fns.prefilter({terms.data(), static_cast<int>(terms.size()), static_cast<float>(alpha)}, face, size, x, y, block);
                         for (int row = 0; row < side; ++row) {
                             const std::size_t first = static_cast<std::size_t>(face * size + y + row) * static_cast<std::size_t>(size) +
                                                       static_cast<std::size_t>(x);
                             std::copy_n(block + row * side * 3, side * 3, rgb.data() + first * 3);
                         }
                     });
        progress.step(static_cast<std::size_t>(wide) * static_cast<std::size_t>(wide));
    });
    return rgb;
}

// Makes the prefiltered chain. Level 0 is the environment; level l holds GGX with roughness = l / (levels - 1).
CubeMap prefilter_chain(const std::vector<CubeLevel>& boxes, int levels, int samples, float scale, const Jobs& jobs, Progress& progress)
{
    const int size = boxes[0].size;
    CubeMap chain = make_cube_map(size, levels, scale);
    store_cube_level(chain, 0, boxes[0].rgb.data(), jobs);
    if (levels == 1)
        return chain;
    const LightTree tree = make_light_tree(boxes, jobs);
    const std::vector<LightLevel> tree_levels = tree.levels();
    const double opening = std::min(kOpening / std::sqrt(samples), kWidestOpening);
    for (int l = 1; l < levels; ++l) {
        const double roughness = static_cast<double>(l) / (levels - 1);
        const std::vector<float> rgb = prefilter_level(tree_levels, size >> l, roughness * roughness, opening, jobs, progress);
        store_cube_level(chain, l, rgb.data(), jobs);
    }
    return chain;
}

CubeMap irradiance_cube(const CubeLevel& from, const Jobs& jobs, Progress& progress)
{
    const BakeFns& fns = pick<BakeFns>();
    const IrradianceSource source = make_irradiance_source(from);
    const IrradianceInput input = source.input();
    const std::vector<float> rgb = run_over_cube(kIrradianceSize, jobs, progress, [&](int face, int first, int count, float* to) {
        fns.irradiance(input, face, kIrradianceSize, first, count, to);
    });
    const float peak = *std::max_element(rgb.begin(), rgb.end());
    CubeMap cube = make_cube_map(kIrradianceSize, 1, cube_scale(static_cast<double>(peak)));
    store_cube_level(cube, 0, rgb.data(), jobs);
    return cube;
}

std::size_t prefilter_texels(int size, int levels)
{
    std::size_t texels = cube_texels(kIrradianceSize);
    for (int l = 1; l < levels; ++l)
        texels += cube_texels(size >> l);
    return texels;
}

Error bad_option(const char* field, const std::string& reason)
{
    return {ExitCode::usage, "", "", reason, std::string("EnvironmentOptions::") + field};
}

Status check(const Image& image, const std::string& name, const EnvironmentOptions& o)
{
    if (image.width <= 0 || image.height <= 0 || image.channels < 1 || image.channels > 4)
        return Error{ExitCode::bad_input, name, "", "the environment has no pixels"};
    if (image.bytes.size() / pixel_type_bytes(image.type) / static_cast<std::size_t>(image.channels) !=
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        return Error{ExitCode::bad_input, name, "/bytes", "the environment has not as many pixels as its size says"};
    if (o.cube_size < 4 || o.cube_size > 4096 || (o.cube_size & (o.cube_size - 1)) != 0)
        return bad_option("cube_size", "the cube size of the environment must be a power of two from 4 to 4096");
    if (o.levels < 0 || o.levels > 13 || (o.levels > 0 && (o.cube_size >> (o.levels - 1)) == 0))
        return bad_option("levels", "the environment's cube is too small for that many levels");
    if (o.extracted_lights < 0 || o.extracted_lights > kMaxExtractedLights)
        return bad_option("extracted_lights", fmt::format("the environment's extracted lights must be 0 to {}", kMaxExtractedLights));
    if (o.samples < 1 || o.samples > kMaxEnvironmentSamples)
        return bad_option("samples", "the samples of the environment must be 1 to 65536");
    if (!(std::fabs(o.exposure_ev) <= kMaxEnvironmentExposure))
        return bad_option("exposure_ev", fmt::format("the environment's exposure must be within {:g} EV of 0", kMaxEnvironmentExposure));
    if (!(std::fabs(o.rotation_deg) <= 36000.0f))
        return bad_option("rotation_deg", "the environment's rotation must be a finite angle in degrees");
    return {};
}

// Bakes all cubes and extracted lights of an image.
Environment bake(const Image& image, const std::string& name, const EnvironmentOptions& options, int levels, const Jobs& jobs)
{
    const TraceSpan span("bake environment");
    Environment e;
    Equirect source = make_equirect(image);
    e.peak_source = peak_value(source);
    e.energy_source = mean_luminance(source);
    // Sample the picture, and extract extracted lights
    double peak = static_cast<double>(e.peak_source);

    Progress progress("baking " + name, prefilter_texels(options.cube_size, levels), options.quiet || options.picture_only);
    CubeLevel sampled = sample_equirect(source, options.cube_size, jobs);
    std::vector<SkyCap> changed;
    e.extracted_lights = extract_lights(source, options.extracted_lights, changed);
    if (!e.extracted_lights.empty()) {
        e.whole = make_cube_map(options.cube_size, 1, cube_scale(peak));
        store_cube_level(e.whole, 0, averaged_to(sampled, options.cube_size, jobs).rgb.data(), jobs);
        sample_equirect_again(sampled, source, changed, jobs);
        peak = static_cast<double>(peak_value(source));
    }
    // Stop at the picture if nothing else is needed
    if (options.picture_only) {
        if (e.extracted_lights.empty()) {
            e.specular = make_cube_map(options.cube_size, 1, cube_scale(peak));
            store_cube_level(e.specular, 0, averaged_to(sampled, options.cube_size, jobs).rgb.data(), jobs);
        }
        e.energy_cube = mean_luminance(e.picture());
        return e;
    }
    // Gather irradiance, and prefilter
    const std::vector<CubeLevel> boxes = box_chain(averaged_to(sampled, options.cube_size, jobs), jobs);
    sampled = {}; // as large as everything else together
    const auto gathered = std::find_if(boxes.begin(), boxes.end(), [](const CubeLevel& l) { return l.size <= kIrradianceSource; });
    e.irradiance = irradiance_cube(*gathered, jobs, progress);
    e.specular = prefilter_chain(boxes, levels, options.samples, cube_scale(peak), jobs, progress);
    e.energy_cube = mean_luminance(e.picture());
    return e;
}

// Applies rotation and exposure after the bake, so that one bake serves them all.
void turn_and_expose(Environment& e, const EnvironmentOptions& options)
{
    if (options.rotation_deg == 0.0f && options.exposure_ev == 0.0f)
        return;
    e.rotation_deg = options.rotation_deg;
    const double gain = det_exp(static_cast<double>(options.exposure_ev) * det_log(2.0));
    const auto expose = [gain](float& value) { value = static_cast<float>(static_cast<double>(value) * gain); };
    for (float* value : {&e.specular.scale, &e.irradiance.scale, &e.whole.scale, &e.peak_source})
        expose(*value);
    for (ExtractedLight& light : e.extracted_lights)
        for (float& irradiance : light.irradiance)
            expose(irradiance);
    e.energy_source *= gain, e.energy_cube *= gain;
    const float both[] = {options.rotation_deg, options.exposure_ev};
    e.content_hash = hash_bytes(both, sizeof both, e.content_hash);
}

double ms_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

Result<Environment> bake_environment(const Image& equirect, const std::string& name, const EnvironmentOptions& options, const Jobs& jobs)
{
    const auto start = std::chrono::steady_clock::now();
    BN_TRY(check(equirect, name, options));
    int levels = options.levels;
    if (levels == 0)
        while ((options.cube_size >> levels) > 1)
            ++levels;
    const std::uint64_t hash = environment_hash(equirect, options, levels);
    const std::string path = options.use_cache ? environment_cache_path(options, hash) : "";
    std::optional<Environment> cached;
    std::optional<CacheLock> lock; // until the bake is cached
    if (!path.empty())
        cached = read_environment_cache(path, hash, options.cube_size, levels);
    if (!path.empty() && !cached && !options.picture_only) {
        const Activity activity("waiting for another bake of " + name);
        lock.emplace(path, kMostLockSeconds, check_stop);
        cached = read_environment_cache(path, hash, options.cube_size, levels); // another may have ended just now
    }
    if (cached) {
        cached->name = name;
        cached->warnings = equirect_warnings(equirect);
        cached->bake_ms = ms_since(start);
        turn_and_expose(*cached, options);
        return std::move(*cached);
    }
    Environment e = bake(equirect, name, options, levels, jobs);
    e.name = name;
    e.warnings = equirect_warnings(equirect);
    e.content_hash = hash;
    e.bake_ms = ms_since(start);
    if (!path.empty() && !options.picture_only)
        if (const Status written = write_environment_cache(path, e); !written)
            e.warnings.push_back("the baked environment is not cached: " + written.error().line());
    turn_and_expose(e, options);
    return e;
}

namespace {

Result<Environment> load_gltf_light(const std::string& file, const EnvironmentOptions& options, const Limits& limits, const Jobs& jobs)
{
    const Result<ImageLight> light = load_image_light(file, limits);
    BN_TRY(light);
    Result<Environment> baked = bake_environment(sky_of(*light, jobs), file, options, jobs);
    if (baked)
        baked->files = light->files;
    return baked;
}

// Loads an equirectangular picture, or an OpenEXR cube picture.
Result<Environment> load_picture(const std::string& file, const EnvironmentOptions& options, const Limits& limits, const Jobs& jobs)
{
    Limits of_environment = limits; // a bake takes time and memory per pixel
    of_environment.image_pixels = limits.env_pixels;
    PictureNotes notes;
    Result<Image> image = read_colours(file, of_environment, notes);
    BN_TRY(image);
    if (notes.cube_faces) {
        if (const std::string fault = cube_picture_fault(*image, limits.env_pixels); !fault.empty())
            return Error{ExitCode::bad_input, file, "header: envmap", fault};
        image = sky_of_cube_picture(*image, jobs);
    } else if (const std::string shape = equirect_shape_warning(*image); !shape.empty()) {
        notes.warnings.push_back(shape);
    }
    Result<Environment> baked = bake_environment(*image, file, options, jobs);
    if (baked)
        baked->warnings.insert(baked->warnings.begin(), notes.warnings.begin(), notes.warnings.end());
    return baked;
}

} // namespace

Result<Environment> load_environment(const std::string& spec, const EnvironmentOptions& options, const Limits& limits, const Jobs& jobs)
{
    const std::string builtin = "builtin:";
    if (!spec.starts_with(builtin) && is_baked_environment(spec)) {
        const auto start = std::chrono::steady_clock::now();
        Result<Environment> baked = read_baked_environment(spec);
        BN_TRY(baked);
        baked->name = spec, baked->bake_ms = ms_since(start);
        turn_and_expose(*baked, options);
        return baked;
    }
    if (!spec.starts_with(builtin))
        return is_gltf(spec) ? load_gltf_light(spec, options, limits, jobs) : load_picture(spec, options, limits, jobs);
    const Result<Image> image = make_builtin_environment(spec.substr(builtin.size()), &jobs);
    return image ? bake_environment(*image, spec, options, jobs) : Result<Environment>(image.error());
}

} // namespace burnish
