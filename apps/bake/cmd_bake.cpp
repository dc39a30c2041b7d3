// `burnish bake`: makes the tables and maps that shading reads.
#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <utility>

#include "apps/bake/direction.h"
#include "apps/bake/direction_field.h"
#include "apps/bake/displaced.h"
#include "apps/bake/environment_textures.h"
#include "apps/bake/lobe.h"
#include "apps/bake/ltc_options.h"
#include "apps/bake/maps.h"
#include "apps/bake/mip.h"
#include "apps/bake/phong_tables.h"
#include "apps/bake/preview.h"
#include "apps/cli/command.h"
#include "apps/cli/open.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"
#include "core/base/file.h"
#include "core/image/io/image_io.h"
#include "core/jobs/activity.h"
#include "core/jobs/cores.h"
#include "raster/frame/frame.h"
#include "shading/bake/environment/environment_cache.h"
#include "shading/bake/tables/phong.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFooter =
    R"~(ltc: a table of linearly transformed cosines and albedos for anisotropic GGX lobes under area lights. Its axes are the eye's two angles,
the greater width and the ratio of the widths. A stopped bake leaves TABLE.part, and the same command continues from it to the same bytes.
direction: a map of the stretched highlight's direction, from a picture's hue or luminance: an angle from 0 to 180 degrees. The picture
shows grooves, and the highlight runs across them, unless --strokes says highlights. See render --direction-map.
quaternion: the shortest rotations to a normal map's normals. See render --quaternion-map.
tpr: a map of the stretched highlight's direction in the tangent plane. Two expressions of u and v give its parts along tangent and
bitangent, or --straighten lays it along one direction in space. With --strokes grooves both give the grooves' direction, and the map still
holds the highlight's. See render --rotation-map.
half-vectors: half vectors that an Ashikhmin-Shirley lobe samples, over both random numbers; an .exr also holds their density.
brdf-lut: directional albedo of that lobe, f0 red + green, over the eye's azimuth and the square root of its cosine. render --as-table reads
both tables; exponents count to five digits.
environment: a baked environment in a folder. render --env FOLDER reads it. --format adds files for engines: prefiltered levels (specular),
box-filtered levels (box), irradiance, the environment with its extracted lights (whole), the DFG table, and the extracted lights as JSON
and GLSL.
mip: mip levels of normals, lobes, base colours, metalness and heights, for a scene's materials or a folder as render --material takes it.
render --mip-pyramid reads them for the same maps. --format exr-mip and png-levels write a folder of glTF textures for other programs:
half floats with mip levels, or one picture a level. The program prints their error against the levels, at texels and between four texels.
lobe: a folder with maps of lobes, fitted to the slopes of heights: roughness.exr (widths), rotation.exr (the stretched highlight's
direction) and normal.exr (tilts). See render --roughness-map, --rotation-map and --normal-map. Masking is the model's own.
The program prints the distance between the slopes and a lobe, and warns where it is large, as in weave.
displaced: a mesh whose triangles follow the heights, as render --height-map shows them by parallax. It has no materials.
Components of quaternion and tpr lie from -1 to 1. In 8 bits, code 128 is 0 and 255 is 1; .exr and .pfm hold the numbers themselves.

Examples:
  burnish bake ltc -o ggx.ltc
  burnish bake ltc -o ggx.ltc --report quality
  burnish bake ltc --table ggx.ltc --report quality
  burnish bake ltc --fit sw --interpolate matrix -o document.ltc
  burnish bake ltc --brdf beckmann -o beckmann.ltc
  burnish bake direction wave.jpg --from hue -o directions.png
  burnish bake quaternion normal.png -o quaternion.png
  burnish bake tpr --expr "cos(pi*v)" "sin(pi*v)" -o turned.exr
  burnish bake tpr --straighten spot.obj --direction 0,1,0 --size 512x512 -o straight.exr --preview seen
  burnish bake half-vectors --nu 70 --nv 400 --size 64x64 -o half_vectors.exr
  burnish bake brdf-lut --nu 70 --nv 400 -o albedo.exr
  burnish bake environment workshop.hdr -o workshop
  burnish bake environment workshop.hdr --format ktx2 -o workshop
  burnish bake mip copper_brushed --mip-filter kappa -o copper.mip --preview levels
  burnish bake mip copper_brushed --mip-filter kappa --format png-levels -o textures
  burnish bake lobe heights.png --height-scale 0.02 -o lobes
  burnish bake displaced wall.obj heights.png --height-scale 0.02 -o wall.glb)~";

enum class BakeFormat { none, pyramid, exr_mip, png_levels, ktx2, dds, exr }; // the levels of mip, then the textures of environment

struct BakeArguments {
    std::string what = "direction", picture, heights, output, preview;
    DirectionFrom from = DirectionFrom::hue;
    Strokes strokes = Strokes::grooves;
    double strength = 1.0;
    std::vector<std::string> expressions;
    std::string mesh;
    std::optional<glm::vec3> along;
    PictureSize size = {0, 0};
    AzimuthAxis azimuth = AzimuthAxis::root;
    EnvironmentOptions environment;
    BakeFormat format = BakeFormat::none;
    TextureFormat textures = TextureFormat::none;
    TexelType texels = TexelType::half;
    RotationEncoding encoding = RotationEncoding::vector;
    double depth = 0.05;
    int triangles = 1000000;
    MipArguments mip;
    double nu = -1.0, nv = -1.0;
    Limits limits;
    LtcArguments ltc;
    PieceOptions pieces;
    int threads = 0, verbosity = 0;
    bool quiet = false;
};

// Returns the requested size, or the default size for the baked data.
PictureSize size_of(const BakeArguments& a, PictureSize fallback)
{
    return a.size.width > 0 ? a.size : fallback;
}

OptionTable bake_option_table(BakeArguments& to)
{
    OptionTable table, limits;
    limits.add("", limit_options(to.limits));
    table.add("", {Option("WHAT", "", "{}",
                          choice(to.what, {"ltc", "direction", "quaternion", "tpr", "displaced", "lobe", "half-vectors", "brdf-lut",
                                           "environment", "mip"}))
                       .must_be_given(),
                   {"PICTURE", "",
                    "Source picture; for lobe the heights, for displaced the mesh, for mip a scene or a folder of pictures, for tpr the "
                    "second expression",
                    file(to.picture), ""},
                   {"HEIGHTS", "", "Height map for displaced", file(to.heights), ""}});
    table.add_needing("WHAT", "displaced", {{"--triangles", "N", "Least number of triangles", integer(to.triangles, 1, 1 << 26)}});
    table.add("Heights", {{"--height-scale", "S", "Depth of the darkest height for displaced and lobe, in texture lengths",
                           number(to.depth, 0.0, 1000.0)}});
    table.add_needing("WHAT", "mip", mip_options(to.mip));
    table.add_needing("WHAT", "direction",
                      {{"--from", "NAME", "Quantity that gives the direction, as an angle from 0 to 180 degrees: {}",
                        choice(to.from, {"hue", "luminance"})},
                       {"--strength", "S", "Anisotropy strength in the map, {}", number(to.strength, 0.0, 1.0)}});
    table.add("Directions",
              {{"--strokes", "NAME", "Direction that is given to direction and tpr: {}; the stretched highlight runs across grooves",
                choice(to.strokes, {"grooves", "highlights"}), "grooves; tpr highlights"}});
    table.add_needing("WHAT", "tpr",
                      {{"--expr", "EXPR",
                        "Direction of the stretched highlight by u and v: its part along the tangent, then, given again or as PICTURE, "
                        "along the bitangent",
                        texts(to.expressions)},
                       {"--straighten", "SCENE",
                        "Mesh with texture coordinates whose highlights stretch along --direction, in place of --expr", scene(to.mesh)},
                       {"--direction", "X,Y,Z", "Direction of the stretched highlight in space, for --straighten", point(to.along), ""},
                       {"--encoding", "NAME", "Encoding in red and green: {}; see render --rotation-encoding",
                        choice(to.encoding, {"vector", "double-angle", "direction"})}});
    table.add_needing("WHAT", "ltc", ltc_options(to.ltc));
    table.add(
        "Maps and tables of texels",
        {{"--size", "WxH", "Width and height in texels of lobe, tpr, half-vectors and brdf-lut", picture_size(to.size),
          "256x256; brdf-lut 10x20, as the renderer uses; lobe one for 64x64 heights"},
         {"--nu", "N", "Exponent along the tangent for half-vectors and brdf-lut, 1 / alpha^2", number(to.nu, 0.0, kMostPhongExponent), ""},
         {"--nv", "N", "Exponent along the bitangent for half-vectors and brdf-lut, 1 / alpha^2", number(to.nv, 0.0, kMostPhongExponent),
          ""},
         {"--azimuth", "NAME", "Spacing of brdf-lut's columns over the eye's azimuth: {}", choice(to.azimuth, {"root", "linear"})},
         {"--brdf", "NAME",
          "Reflection model for ltc (ggx_aniso, beckmann, ashikhmin_shirley or ward), for lobe (ggx_aniso or beckmann) and for mip, "
          "which takes its net and measures with it",
          lobe_value(to.mip.brdf)}});
    table.add_needing(
        "WHAT", "environment",
        {{"--env-size", "N", "Texels along an edge of the cube map: {}",
          choice(to.environment.cube_size, {16, 32, 64, 128, 256, 512, 1024, 2048})},
         {"--key-lights", "N", "Small strong lights to extract from the environment, at most: {}",
          extracted_lights(to.environment.extracted_lights)},
         {"--env-samples", "N", "Samples a texel of the prefiltered levels", integer(to.environment.samples, 1, kMaxEnvironmentSamples)},
         {"--textures", "NAME", "An older name of --format for textures: {}", choice(to.textures, {"none", "ktx2", "dds", "exr"})},
         {"--texels", "NAME", "Numbers in --format ktx2 and dds: {} (16 or 32 bits)", choice(to.texels, {"half", "float"})}});
    table.add(
        "Output",
        {Option("-o,--output", "FILE",
                "Table or map to write: .png or .tif, for quaternion, tpr and half-vectors also .exr, for displaced .glb", file(to.output))
             .is_output(),
         {"--format", "NAME",
          "Of mip: pyramid (a file for render --mip-pyramid), exr-mip or png-levels (a folder of textures for other programs). Of "
          "environment, also textures for engines: ktx2, dds or exr (cubes with all levels, the DFG table, extracted lights), or none",
          choice(to.format, {"none", "pyramid", "exr-mip", "png-levels", "ktx2", "dds", "exr"}), "mip pyramid, environment none"},
         Option("--preview", "FOLDER", "Folder for .png pictures of the result, to look at", folder(to.preview)).is_output(),
         quiet_option(to.quiet),
         verbose_option(to.verbosity),
         threads_option(to.threads)});
    table.add("Pieces of ltc and mip, for several processes", piece_options(to.pieces));
    table.take(limits, "Limits on input",
               {{"--limit-image-side", "Width and height of the input picture"}, {"--limit-file-bytes", "Size of one input file"}});
    return table;
}

Status check_direction(const BakeArguments& a)
{
    if (a.picture.empty())
        return usage_error("PICTURE", "is needed: what directions are made of");
    if (a.output.empty())
        return usage_error("-o", "is needed");
    const std::string extension = fs::path(a.output).extension().string();
    if (extension != ".png" && extension != ".tif")
        return usage_error("-o", fmt::format("'{}' must end in .png or .tif, which lose nothing", a.output));
    return check_picture_path(a.output, {a.picture});
}

using Warnings = std::vector<std::string>;

// Warns about non-finite pixels of a float picture.
Warnings repaired(const Image& picture, const std::string& path)
{
    const std::uint64_t bad = picture.type == PixelType::f32 ? count_not_finite(picture) : 0;
    return bad == 0 ? Warnings() : Warnings{fmt::format("{}: {} pixels are no numbers and are repaired", path, bad)};
}

bool has_strokes(const BakeArguments& a)
{
    return a.what == "direction" || a.what == "tpr";
}

// Writes baked data with `write`, and previews from `show` if --preview is given.
template <class Write, class Show>
int write_made(const BakeArguments& a, const std::string& path, const Warnings& warnings, Write write, Show show)
{
    const Preview preview = a.preview.empty() ? Preview() : show();
    if (const Status fits = check_preview(a.preview, preview, {path, a.picture, a.heights, a.mesh}); !fits)
        return fail(fits.error());
    if (const Status written = write(); !written)
        return fail(written.error());
    Report report(a.quiet, a.verbosity);
    report.release();
    for (const std::string& warning : warnings)
        report.warning(warning);
    if (has_strokes(a))
        report.event("strokes", a.strokes == Strokes::grooves ? "taken as grooves: highlights run across them"
                                                              : "taken as highlights: grooves run across them");
    report.wrote(path);
    if (const Status written = write_preview(a.preview, preview, report); !written)
        return fail(written.error());
    return 0;
}

template <class Show> int write_map(const BakeArguments& a, const Image& map, const Warnings& warnings, Show show)
{
    return write_made(
        a, a.output, warnings, [&] { return write_image(a.output, map); }, [&] { return show(map); });
}

template <class Show>
int write_bytes(const BakeArguments& a, const std::string& path, const void* bytes, std::size_t count, const Warnings& warnings, Show show)
{
    return write_made(
        a, path, warnings, [&] { return write_file_atomic(path, bytes, count); }, show);
}

int run_direction(const BakeArguments& arguments)
{
    if (Status checked = check_direction(arguments); !checked)
        return fail(checked.error());
    const Result<Image> picture = read_image(arguments.picture, arguments.limits);
    if (!picture)
        return fail(picture.error());
    return write_map(arguments, direction_map(*picture, arguments.from, arguments.strokes, arguments.strength),
                     repaired(*picture, arguments.picture),
                     [](const Image& map) { return preview_of_rotations(map, RotationEncoding::direction); });
}

// Returns the pixel type of quaternion and rotation maps: floats if the file format keeps them. inputs: must not be overwritten.
Result<PixelType> map_type(const BakeArguments& a, const std::vector<std::string>& inputs)
{
    if (a.output.empty())
        return usage_error("-o", "is needed");
    const std::string extension = fs::path(a.output).extension().string();
    const bool floats = extension == ".exr" || extension == ".pfm";
    if (!floats && extension != ".png" && extension != ".tif")
        return usage_error("-o", fmt::format("'{}' must end in .png, .tif, .exr or .pfm, which lose nothing", a.output));
    BN_TRY(check_picture_path(a.output, inputs));
    return floats ? PixelType::f32 : PixelType::u8;
}

int run_quaternion(const BakeArguments& a)
{
    if (a.picture.empty())
        return fail(usage_error("PICTURE", "is needed: the normal map"));
    const Result<PixelType> type = map_type(a, {a.picture});
    if (!type)
        return fail(type.error());
    const Result<Image> normals = read_image(a.picture, a.limits);
    if (!normals)
        return fail(normals.error());
    if (normals->channels < 3)
        return fail({ExitCode::bad_input, a.picture, "", "a normal map has red, green and blue"});
    const SurfaceMap map = quaternions_of_normals(*normals, *type);
    Warnings warnings;
    if (map.repaired)
        warnings.push_back(fmt::format("{}: {} normals have no length and turn nothing", a.picture, map.repaired));
    return write_map(a, map.image, warnings, preview_of_quaternions);
}

// Writes directions (3 floats a texel). Grooves are turned by a quarter.
int write_rotations(const BakeArguments& a, Image directions, PixelType type, const Warnings& warnings)
{
    const std::size_t texels = static_cast<std::size_t>(directions.width) * static_cast<std::size_t>(directions.height);
    for (std::size_t i = 0; i < texels && a.strokes == Strokes::grooves; ++i) {
        float* const d = directions.f32() + 3 * i;
        d[0] = -std::exchange(d[1], d[0]);
    }
    return write_map(a, encoded_rotations(directions, a.encoding, type), warnings,
                     [&](const Image& map) { return preview_of_rotations(map, a.encoding); });
}

int run_direction_field(const BakeArguments& a)
{
    if (!a.expressions.empty() || !a.picture.empty())
        return fail(usage_error("--expr", "and --straighten both say what is made"));
    if (a.mesh.empty() || !a.along)
        return fail(usage_error(a.along ? "--straighten" : "--direction", "is needed"));
    if (!(glm::dot(*a.along, *a.along) > 1e-12f))
        return fail(usage_error("--direction", "has no length"));
    const Result<PixelType> type = map_type(a, {a.mesh});
    if (!type)
        return fail(type.error());
    const auto data = open_scene(a.mesh, a.limits, {}, {}, {}, {});
    if (!data)
        return fail(data.error());
    const DirectionField made = bake_direction_field((*data)->tables, *a.along, size_of(a, {256, 256}));
    if (made.covered == 0)
        return fail({ExitCode::bad_input, a.mesh, "", "has no texture coordinates that cover a texel"});
    Warnings warnings = (*data)->scene.warnings;
    if (made.without > 0 || made.twice > made.covered / 100) // an edge texel may lie in two triangles
        warnings.push_back(fmt::format("{}: of {} texels {} have the direction along their normal; {} lie in another triangle too", a.mesh,
                                       made.covered, made.without, made.twice));
    return write_rotations(a, made.directions, *type, warnings);
}

int run_tpr(const BakeArguments& a)
{
    if (!a.mesh.empty() || a.along)
        return run_direction_field(a);
    std::vector<std::string> expressions = a.expressions;
    if (!a.picture.empty())
        expressions.push_back(a.picture);
    if (expressions.size() != 2)
        return fail(usage_error("--expr", fmt::format("{} given, not two: along tangent and bitangent", expressions.size())));
    const Result<PixelType> type = map_type(a, {});
    if (!type)
        return fail(type.error());
    const Result<Image> directions = rotations_of(expressions, size_of(a, {256, 256}));
    if (!directions)
        return fail(directions.error());
    return write_rotations(a, *directions, *type, {});
}

int run_environment(const BakeArguments& a)
{
    if (a.picture.empty() || a.output.empty())
        return fail(usage_error(a.picture.empty() ? "PICTURE" : "-o", "is needed: an environment, and the folder that it is baked to"));
    if (const Status path = check_folder_path(a.output); !path)
        return fail(path.error());
    const Jobs jobs(a.threads);
    EnvironmentOptions options = a.environment;
    options.quiet = a.quiet, options.use_cache = false;
    const auto baked = open_environment(a.picture, options, a.limits, jobs);
    if (!baked)
        return fail(baked.error());
    if (const Status made = make_output_folder(a.output); !made)
        return fail(made.error());
    const std::vector<std::uint8_t> bytes = environment_cache_bytes(**baked);
    const int code = write_bytes(a, (fs::path(a.output) / kBakedEnvironment).string(), bytes.data(), bytes.size(), (*baked)->warnings,
                                 [&] { return preview_of_environment(**baked); });
    if (code != 0 || a.textures == TextureFormat::none)
        return code;
    const auto dfg = standard_dfg(jobs);
    if (!dfg)
        return fail(dfg.error());
    const Result<EnvironmentTextures> written = write_environment_textures(a.output, **baked, **dfg, a.textures, a.texels, jobs);
    if (!written)
        return fail(written.error());
    Report report(a.quiet, a.verbosity);
    report.release();
    for (const std::string& warning : written->warnings)
        report.warning(warning);
    for (const std::string& path : written->files)
        report.wrote(path);
    return 0;
}

int run_displaced(const BakeArguments& a)
{
    if (a.picture.empty() || a.heights.empty())
        return fail(usage_error(a.picture.empty() ? "PICTURE" : "HEIGHTS", "is needed: a mesh and its height map"));
    if (fs::path(a.output).extension() != ".glb")
        return fail(usage_error("-o", a.output.empty() ? "is needed" : fmt::format("'{}' must end in .glb", a.output)));
    if (const Status path = check_text_path("-o", a.output, {a.picture, a.heights}); !path)
        return fail(path.error());
    const auto data = open_scene(a.picture, a.limits, {}, {}, {}, {});
    if (!data)
        return fail(data.error());
    const auto& primitives = (*data)->scene.primitives;
    if (std::none_of(primitives.begin(), primitives.end(), [](const Primitive& p) { return p.has_uv0; }))
        return fail({ExitCode::bad_input, a.picture, "", "has no texture coordinates for a height map"});
    const Result<Image> heights = read_image(a.heights, a.limits);
    if (!heights)
        return fail(heights.error());
    Warnings warnings = (*data)->scene.warnings;
    for (const std::string& warning : repaired(*heights, a.heights))
        warnings.push_back(warning);
    const Result<Displaced> made = displaced((*data)->tables, *heights, a.depth, static_cast<std::size_t>(a.triangles), a.picture);
    if (!made)
        return fail(made.error());
    return write_bytes(a, a.output, made->glb.data(), made->glb.size(), warnings, [&] { return preview_of_heights(*heights, a.depth); });
}

int run_phong(const BakeArguments& a, const OptionTable& given)
{
    for (const char* option : {"--nu", "--nv"})
        if (!given.given(option))
            return fail(usage_error(option, "is needed: an exponent of the lobe"));
    if (!a.picture.empty())
        return fail(usage_error("PICTURE", fmt::format("'{}': a table is made of nothing", a.picture)));
    const Result<PixelType> type = map_type(a, {});
    if (!type)
        return fail(type.error());
    const double nu = rounded_exponent(a.nu), nv = rounded_exponent(a.nv);
    if (a.what == "brdf-lut") {
        if (*type != PixelType::f32)
            return fail(usage_error("-o", fmt::format("'{}' must end in .exr or .pfm, which hold floats", a.output)));
        return write_map(a, albedo_table(nu, nv, size_of(a, {kLobeAlbedoSize / 2, kLobeAlbedoSize}), a.azimuth), {}, preview_of_albedo);
    }
    const bool density = fs::path(a.output).extension() == ".exr";
    if (*type == PixelType::f32 && !density)
        return fail(usage_error("-o", fmt::format("'{}' must end in .exr, which holds the density too, or in .png or .tif", a.output)));
    const Image table = half_vector_table(nu, nv, size_of(a, {256, 256}), *type);
    Warnings warnings;
    if (*type == PixelType::u8)
        warnings.push_back(fmt::format("8 bits leave {} values along the tangent, and no densities", codes_of(table)));
    return write_map(a, table, warnings, preview_of_half_vectors);
}

// Gives --format to the part that has such an output.
Status take_format(BakeArguments& a, const OptionTable& given)
{
    if (!given.given("--format"))
        return {};
    const bool levels = a.format >= BakeFormat::pyramid && a.format <= BakeFormat::png_levels;
    if (a.what == "mip" && levels) {
        a.mip.format = static_cast<MipFormat>(static_cast<int>(a.format) - static_cast<int>(BakeFormat::pyramid));
        return {};
    }
    if (a.what != "environment" || levels)
        return usage_error("--format", a.what == "mip"           ? "is pyramid, exr-mip or png-levels for mip"
                                       : a.what == "environment" ? "is none, ktx2, dds or exr for environment"
                                                                 : "is of mip and environment");
    if (given.given("--textures"))
        return usage_error("--textures", "is an older name of --format: one of them");
    a.textures = a.format == BakeFormat::none
                     ? TextureFormat::none
                     : static_cast<TextureFormat>(static_cast<int>(a.format) - static_cast<int>(BakeFormat::ktx2) + 1);
    return {};
}

int run_bake(const BakeArguments& by_default, const OptionTable& given)
{
    BakeArguments arguments = by_default;
    if (!given.given("--strokes")) // a picture shows grooves
        arguments.strokes = arguments.what == "direction" ? Strokes::grooves : Strokes::highlights;
    else if (!has_strokes(arguments))
        return fail(usage_error("--strokes", "is of direction and tpr"));
    if (arguments.what != "half-vectors" && arguments.what != "brdf-lut")
        for (const char* option : {"--nu", "--nv"})
            if (given.given(option))
                return fail(usage_error(option, "is of half-vectors and brdf-lut"));
    const bool fits_lobes = arguments.what == "lobe";
    if (given.given("--brdf") && arguments.what != "ltc" && arguments.what != "mip" && !fits_lobes)
        return fail(usage_error("--brdf", "is of ltc, lobe and mip"));
    if (given.given("--height-scale") && arguments.what != "displaced" && !fits_lobes)
        return fail(usage_error("--height-scale", "is of displaced and lobe"));
    if (const Status format = take_format(arguments, given); !format)
        return fail(format.error());
    if (given.given("--texels") && arguments.textures != TextureFormat::ktx2 && arguments.textures != TextureFormat::dds)
        return fail(usage_error("--texels", "is of --format ktx2 and dds"));
    if (given.given("--azimuth") && arguments.what != "brdf-lut")
        return fail(usage_error("--azimuth", "is of brdf-lut"));
    if (given.given("--size") && arguments.what != "tpr" && arguments.what != "half-vectors" && arguments.what != "brdf-lut" && !fits_lobes)
        return fail(usage_error("--size", "is of lobe, tpr, half-vectors and brdf-lut"));
    if (const Status pieces = check_piece_options(arguments.pieces); !pieces)
        return fail(pieces.error());
    if (any_pieces(arguments.pieces) && arguments.what != "ltc" && arguments.what != "mip")
        return fail(usage_error("WHAT", arguments.what + " has no pieces; ltc and mip have"));
    const Activity activity(arguments.what);
    if (arguments.what == "half-vectors" || arguments.what == "brdf-lut")
        return run_phong(arguments, given);
    if (arguments.what == "displaced")
        return run_displaced(arguments);
    if (!arguments.heights.empty())
        return fail(usage_error("HEIGHTS", fmt::format("'{}': only displaced takes two files", arguments.heights)));
    if (fits_lobes)
        return run_lobe({arguments.picture, arguments.output, arguments.preview, arguments.size, arguments.depth,
                         given.given("--brdf") ? lobe_model(arguments.mip.brdf).name : "ggx_aniso", arguments.limits, arguments.threads,
                         arguments.verbosity, arguments.quiet});
    if (arguments.what == "environment")
        return run_environment(arguments);
    if (arguments.what == "mip")
        return run_mip({arguments.mip, arguments.picture, arguments.output, arguments.preview, arguments.limits, arguments.threads,
                        arguments.verbosity, arguments.quiet, arguments.pieces, given});
    if (arguments.what == "direction")
        return run_direction(arguments);
    if (arguments.what == "quaternion")
        return run_quaternion(arguments);
    if (arguments.what == "tpr")
        return run_tpr(arguments);
    return bake_ltc({arguments.ltc, arguments.mip.brdf, arguments.picture, arguments.output, arguments.preview, arguments.threads,
                     arguments.verbosity, arguments.quiet, arguments.pieces},
                    given);
}

} // namespace

Command bake_command()
{
    auto arguments = std::make_shared<BakeArguments>();
    return {"bake", "Make tables and maps for shading", bake_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_bake(*arguments, given); }};
}

} // namespace burnish
