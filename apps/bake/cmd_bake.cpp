// `burnish bake`: tables and maps that shading reads.
#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <iterator>
#include <memory>

#include "apps/bake/direction.h"
#include "apps/bake/displaced.h"
#include "apps/bake/maps.h"
#include "apps/bake/mip.h"
#include "apps/bake/phong_tables.h"
#include "apps/bake/report.h"
#include "apps/bake/resolutions.h"
#include "apps/bake/straighten.h"
#include "apps/cli/command.h"
#include "apps/cli/open.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/values.h"
#include "apps/plot/plot.h"
#include "apps/report/looks.h"
#include "apps/report/png.h"
#include "apps/report/svg.h"
#include "core/base/file.h"
#include "core/image/io/image_io.h"
#include "core/jobs/cores.h"
#include "raster/frame/frame.h"
#include "shading/bake/environment/environment_cache.h"
#include "shading/bake/ltc/bake_ltc.h"
#include "shading/bake/tables/phong.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFooter =
    R"~(ltc: linearly transformed cosines for anisotropic GGX lobes under area lights, and their albedo, by the eye's angles, the greater width
and the ratio of both. What is done so far is kept in TABLE.part: the same command goes on from there, to the same bytes.
direction: a map of the grain's direction from a picture's hues or luminance, which are angles from 0 to 180 degrees; see render
--direction-map.
quaternion: the shortest rotations to a normal map's normals; see render --quaternion-map.
tpr: rotations of the grain in the tangent plane, by two expressions of u and v along tangent and bitangent, or such that the grain of
a mesh lies along one direction; see render --rotation-map.
half-vectors: those that a lobe of Ashikhmin and Shirley samples, over both random numbers, and in .exr their density.
brdf-lut: that lobe's directional albedo, f0 red + green, over the eye's azimuth and the root of its cosine. Both are read back by render
--as-table; exponents count to five digits.
environment: an environment as it is baked before it is drawn; render --env FOLDER reads it.
mip: levels of normals and lobes of a scene's materials, or of a folder of pictures as render --material takes it; render --mip-pyramid
reads them, where the maps are the same. --format exr-mip and png-levels: a folder of glTF textures with all levels, for other programs, half
floats with mip levels or a picture a level; printed is how far what they show lies from their levels, at texels and where four meet.
displaced: a mesh whose heights are triangles, as render --height-map shows them without any; materials are not kept.
The parts of quaternion and tpr lie from -1 to 1: code 128 of 8 bits is 0, 255 is 1; .exr and .pfm hold the numbers themselves.

Examples:
  burnish bake ltc -o ggx.ltc
  burnish bake ltc -o ggx.ltc --report quality
  burnish bake ltc --table ggx.ltc --report quality
  burnish bake ltc --fit sw --interpolate matrix -o document.ltc
  burnish bake ltc --brdf beckmann -o beckmann.ltc
  burnish bake direction wave.jpg --from hue -o directions.png
  burnish bake quaternion normal.png -o quaternion.png
  burnish bake tpr --expr "cos(pi*v)" "sin(pi*v)" -o turned.exr
  burnish bake tpr --straighten spot.obj --direction 0,1,0 --size 512x512 -o straight.exr
  burnish bake half-vectors --nu 70 --nv 400 --size 64x64 -o half_vectors.exr
  burnish bake brdf-lut --nu 70 --nv 400 -o albedo.exr
  burnish bake environment workshop.hdr -o workshop
  burnish bake mip copper_brushed --mip-filter kappa -o copper.mip --preview levels
  burnish bake mip copper_brushed --mip-filter kappa --format png-levels -o textures
  burnish bake displaced wall.obj heights.png --height-scale 0.02 -o wall.glb)~";

struct BakeArguments {
    std::string what = "ltc", picture, heights, output, table, report;
    DirectionFrom from = DirectionFrom::hue;
    double strength = 1.0;
    std::vector<std::string> expressions;
    std::string mesh;
    std::optional<glm::vec3> along;
    PictureSize size = {0, 0};
    AzimuthAxis azimuth = AzimuthAxis::root;
    EnvironmentOptions environment;
    RotationEncoding encoding = RotationEncoding::vector;
    double depth = 0.05;
    int triangles = 1000000;
    MipArguments mip;
    double nu = -1.0, nv = -1.0;
    Limits limits;
    int resolution = 8, steps = 12, samples = 8, threads = 0;
    ltc::Norm norm = ltc::Norm::l1;
    int cosines = 1;
    std::string interpolate = "mirror";
    bool unaligned = false, unsymmetric = false;
    bool half = false, isotropic = false, quiet = false;
    int verbosity = 0;
};

// The size that was asked for, or the usual one of what is made.
PictureSize size_of(const BakeArguments& a, PictureSize usual)
{
    return a.size.width > 0 ? a.size : usual;
}

OptionTable bake_option_table(BakeArguments& to)
{
    OptionTable table, limits;
    limits.add("", limit_options(to.limits));
    table.add(
        "",
        {{"WHAT", "", "{}",
          choice(to.what, {"ltc", "direction", "quaternion", "tpr", "displaced", "half-vectors", "brdf-lut", "environment", "mip"})},
         {"PICTURE", "", "That directions or quaternions are made of; of tpr the second expression, of displaced the mesh, of mip a scene",
          file(to.picture), ""},
         {"HEIGHTS", "", "Of displaced: the height map", file(to.heights), ""}});
    table.add_needing("WHAT", "displaced",
                      {{"--height-scale", "S", "Depth of height 0, in lengths of texture coordinates", number(to.depth, 0.0, 1000.0)},
                       {"--triangles", "N", "At least so many", integer(to.triangles, 1, 1 << 26)}});
    table.add_needing("WHAT", "mip", mip_options(to.mip));
    table.add_needing("WHAT", "direction",
                      {{"--from", "NAME", "{}", choice(to.from, {"hue", "luminance"})},
                       {"--strength", "S", "Of the anisotropy that the map gives, {}", number(to.strength, 0.0, 1.0)}});
    table.add_needing("WHAT", "tpr",
                      {{"--expr", "EXPR", "Of u and v: the grain along the tangent, and given again or as PICTURE, along the bitangent",
                        texts(to.expressions)},
                       {"--straighten", "SCENE", "In place of expressions: a mesh with texture coordinates, whose grain --direction gives",
                        scene(to.mesh)},
                       {"--direction", "X,Y,Z", "Of the grain in space", point(to.along), ""},
                       {"--encoding", "NAME", "{}", choice(to.encoding, {"vector", "double-angle", "direction"})}});
    table.add_needing("WHAT", "ltc",
                      {{"--resolution", "N", "Nodes along each axis, {}", integer(to.resolution, 3, 128), "8, isotropic 64"},
                       {"--isotropic", "", "Round lobes alone: nodes along theta and alpha, as engines have them", flag(to.isotropic)},
                       {"--steps", "N", "Of the fit of all entries at once, {}; 0: each node alone", integer(to.steps, 0, 100)},
                       {"--samples", "N", "Lobes in each cell that this fit looks at, {}", integer(to.samples, 1, 64)},
                       {"--fit", "NAME", "What makes a node's matrix the nearest: {}", choice(to.norm, {"l1", "l3", "sw"})},
                       {"--interpolate", "NAME", "What is held of matrices: {}", choice(to.interpolate, {"mirror", "matrix", "inverse"})},
                       {"--no-align", "", "Leave matrices turned as they are, whatever their neighbours are", flag(to.unaligned)},
                       {"--no-symmetry", "", "Fit every node by itself, whatever symmetry says of it", flag(to.unsymmetric)},
                       {"--lobes", "N", "Of --report: also the nearest sum of two cosines where one is .3 off or more",
                        choice(to.cosines, std::vector<int>{1, 2})},
                       {"--half", "", "Entries as halves, not floats", flag(to.half)},
                       {"--table", "FILE", "Measure this table instead of making one", file(to.table)},
                       {"--report", "FOLDER", "Also measure the table: quality.json; quality, lobes and resolutions as .svg and .png",
                        folder(to.report)}});
    table.add(
        "Maps and tables of texels",
        {{"--size", "WxH", "Texels of tpr, half-vectors and brdf-lut", picture_size(to.size),
          "256x256; of brdf-lut 10x20, which is what pictures are made with"},
         {"--nu", "N", "Of half-vectors and brdf-lut: exponent along the tangent, 1 / alpha^2", number(to.nu, 0.0, kMostPhongExponent), ""},
         {"--nv", "N", "And along the bitangent", number(to.nv, 0.0, kMostPhongExponent), ""},
         {"--azimuth", "NAME", "How columns of brdf-lut go through the eye's azimuth: {}", choice(to.azimuth, {"root", "linear"})},
         {"--brdf", "NAME",
          "Of ltc and mip: whose lobes; ltc fits ggx_aniso, beckmann, ashikhmin_shirley and ward, mip takes their net and measures "
          "with them",
          lobe_value(to.mip.brdf)}});
    table.add_needing("WHAT", "environment",
                      {{"--env-size", "N", "Texels along a cube edge, a power of two",
                        choice(to.environment.cube_size, {16, 32, 64, 128, 256, 512, 1024, 2048})},
                       {"--key-lights", "N", "Small strong lights that leave it: {}", key_lights(to.environment.key_lights)},
                       {"--env-samples", "N", "Samples a texel of the prefiltered levels", integer(to.environment.samples, 1, 1 << 20)}});
    table.add("Output",
              {{"-o,--output", "FILE",
                "The table, or the map: .png or .tif; of quaternion, tpr and half-vectors .exr, too; of displaced .glb", file(to.output)},
               quiet_option(to.quiet),
               verbose_option(to.verbosity),
               threads_option(to.threads)});
    table.take(limits, "Limits on input",
               {{"--limit-image-side", "Width and height of the picture"}, {"--limit-file-bytes", "Size of its file"}});
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

// Whether a table is made as others make theirs: each node by itself.
bool others_path(const BakeArguments& a)
{
    return a.norm != ltc::Norm::l1 || a.interpolate != "mirror" || a.unaligned || a.unsymmetric;
}

// Whose lobes a table is of; none where --brdf names others than can be fitted.
std::optional<ltc::Model> model_of(const BakeArguments& a)
{
    const auto* const found =
        std::find(std::begin(ltc::kModelNames), std::end(ltc::kModelNames), std::string_view(lobe_model(a.mip.brdf).name));
    if (found == std::end(ltc::kModelNames))
        return std::nullopt;
    return static_cast<ltc::Model>(found - std::begin(ltc::kModelNames));
}

Status check_arguments(const BakeArguments& a, const OptionTable& given)
{
    if (!a.picture.empty())
        return usage_error("PICTURE", fmt::format("'{}': a table is made of nothing", a.picture));
    if (a.table.empty() == a.output.empty())
        return usage_error("-o", "is needed, or --table, and not both");
    if (!a.table.empty())
        for (const char* option :
             {"--steps", "--samples", "--half", "--isotropic", "--fit", "--interpolate", "--no-align", "--no-symmetry", "--brdf"})
            if (given.given(option))
                return usage_error(option, "says how a table is made, and --table FILE is made already");
    if (!model_of(a))
        return usage_error(
            "--brdf", fmt::format("'{}': only ggx_aniso, beckmann, ashikhmin_shirley and ward can be fitted", lobe_model(a.mip.brdf).name));
    if (given.given("--lobes") && a.report.empty())
        return usage_error("--lobes", "says what --report FOLDER measures, which is not asked for");
    if (others_path(a) && given.given("--steps") && a.steps > 0)
        return usage_error(
            "--steps", "is of the fit between nodes, which needs --fit l1, --interpolate mirror, and aligned entries with their symmetry");
    if (a.isotropic)
        for (const char* option : {"--steps", "--samples", "--interpolate", "--no-align", "--no-symmetry"})
            if (given.given(option))
                return usage_error(option, "is of tables of all lobes, and this one is of --isotropic");
    if (!a.isotropic && a.table.empty() && a.resolution > 16)
        return usage_error("--resolution", fmt::format("{} is more than 16, which only a table of --isotropic may have", a.resolution));
    if (a.output == "-")
        return usage_error("-o", "the table is no text for standard output");
    if (a.output.empty())
        return {};
    if (Status path = check_text_path("-o", a.output, {}); !path)
        return path;
    return check_text_path("-o", a.output + ".part", {});
}

Status write_report_files(const BakeArguments& a, const Json& figures, const std::vector<std::pair<std::string, Drawing>>& drawings,
                          Report& report)
{
    std::error_code failed;
    fs::create_directories(a.report, failed);
    if (failed)
        return Error{ExitCode::output_failed, a.report, "", failed.message()};
    std::vector<std::pair<std::string, std::string>> files = {{"quality.json", figures.dump(2) + "\n"}};
    for (const auto& [name, drawing] : drawings) {
        Result<std::string> png = png_of(drawing);
        if (!png)
            return png.error();
        files.emplace_back(name + ".svg", svg_of(drawing, chart_style()));
        files.emplace_back(name + ".png", std::move(*png));
    }
    for (const auto& [name, bytes] : files) {
        const std::string path = (fs::path(a.report) / name).string();
        if (Status written = write_file_atomic(path, bytes.data(), bytes.size()); !written)
            return written;
        report.wrote(path);
    }
    return {};
}

// The table that was asked for; nothing where it was stopped.
Result<std::optional<ltc::Table>> table_of(const BakeArguments& a, const OptionTable& given, const Jobs& jobs, Report& report)
{
    if (!a.table.empty()) {
        Result<ltc::Table> read = ltc::read_table(a.table, given.given("--resolution") ? a.resolution : 0);
        if (!read)
            return read.error();
        return std::optional(std::move(*read));
    }
    ltc::BakeOptions options;
    options.grid = a.isotropic ? ltc::round_grid() : ltc::grid_of(a.resolution);
    if (given.given("--resolution"))
        options.grid.size = a.resolution;
    options.steps = a.isotropic || others_path(a) ? 0 : a.steps, options.samples_a_cell = a.samples;
    options.model = *model_of(a), options.norm = a.norm, options.align = !a.unaligned, options.symmetry = !a.unsymmetric;
    if (a.interpolate != "mirror") {
        options.grid.beyond = 0, options.grid.root_alpha = options.grid.over_alpha = false;
        options.grid.basis = ltc::Basis::tangent, options.grid.inverse = a.interpolate == "inverse";
    }
    options.checkpoint = a.output + ".part";
    options.stop = &watch_stop_signals();
    std::optional<Progress> progress;
    progress.emplace("transformed cosines", ltc::bake_units(options), a.quiet);
    options.advance = [&progress](std::size_t units) { progress->step(units); };
    Result<std::optional<ltc::Baked>> baked = ltc::bake_table(options, jobs);
    progress.reset();
    if (!baked)
        return baked.error();
    if (!*baked)
        return std::optional<ltc::Table>();
    report.event("fit", fmt::format("mean L1 {:.4f} of nodes alone; {:.4f} between them, {:.4f} before", (*baked)->node_l1,
                                    (*baked)->fit_l1, (*baked)->fit_l1_before));
    if (Status written = ltc::write_table(a.output, (*baked)->table, a.half); !written)
        return written.error();
    report.wrote(a.output);
    std::error_code ignored;
    fs::remove(options.checkpoint, ignored);
    return std::optional(std::move((*baked)->table));
}

using Warnings = std::vector<std::string>;

// The one of a picture of floats that holds what are none.
Warnings repaired(const Image& picture, const std::string& path)
{
    const std::uint64_t bad = picture.type == PixelType::f32 ? count_not_finite(picture) : 0;
    return bad == 0 ? Warnings() : Warnings{fmt::format("{}: {} pixels are no numbers and are repaired", path, bad)};
}

int write_map(const BakeArguments& arguments, const Image& map, const Warnings& warnings = {})
{
    if (const Status written = write_image(arguments.output, map); !written)
        return fail(written.error());
    Report report(arguments.quiet, arguments.verbosity);
    report.release();
    for (const std::string& warning : warnings)
        report.warning(warning);
    report.wrote(arguments.output);
    return 0;
}

int run_direction(const BakeArguments& arguments)
{
    if (Status checked = check_direction(arguments); !checked)
        return fail(checked.error());
    const Result<Image> picture = read_image(arguments.picture, arguments.limits);
    if (!picture)
        return fail(picture.error());
    return write_map(arguments, direction_map(*picture, arguments.from, arguments.strength), repaired(*picture, arguments.picture));
}

// Of quaternions and rotations, which keep floats where the file does. inputs: that it must not overwrite.
Result<PixelType> map_type(const BakeArguments& a, const std::vector<std::string>& inputs)
{
    if (a.output.empty())
        return usage_error("-o", "is needed");
    const std::string extension = fs::path(a.output).extension().string();
    const bool floats = extension == ".exr" || extension == ".pfm";
    if (!floats && extension != ".png" && extension != ".tif")
        return usage_error("-o", fmt::format("'{}' must end in .png, .tif, .exr or .pfm, which lose nothing", a.output));
    if (const Status path = check_picture_path(a.output, inputs); !path)
        return path.error();
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
    return write_map(a, map.image, warnings);
}

int run_straighten(const BakeArguments& a)
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
    const auto data = open_scene(a.mesh, a.limits, {}, {}, {});
    if (!data)
        return fail(data.error());
    const Straightened made = straighten((*data)->tables, *a.along, size_of(a, {256, 256}));
    if (made.covered == 0)
        return fail({ExitCode::bad_input, a.mesh, "", "has no texture coordinates that cover a texel"});
    Warnings warnings = (*data)->scene.warnings;
    if (made.without > 0 || made.twice > made.covered / 100) // edges are of two triangles
        warnings.push_back(fmt::format("{}: of {} texels {} have the direction along their normal; {} lie in another triangle too", a.mesh,
                                       made.covered, made.without, made.twice));
    return write_map(a, encoded_rotations(made.directions, a.encoding, *type), warnings);
}

int run_tpr(const BakeArguments& a)
{
    if (!a.mesh.empty() || a.along)
        return run_straighten(a);
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
    return write_map(a, encoded_rotations(*directions, a.encoding, *type));
}

int write_bytes(const BakeArguments& a, const std::string& path, const void* bytes, std::size_t count, const Warnings& warnings)
{
    if (const Status written = write_file_atomic(path, bytes, count); !written)
        return fail(written.error());
    Report report(a.quiet, a.verbosity);
    report.release();
    for (const std::string& warning : warnings)
        report.warning(warning);
    report.wrote(path);
    return 0;
}

int run_environment(const BakeArguments& a)
{
    if (a.picture.empty() || a.output.empty())
        return fail(usage_error(a.picture.empty() ? "PICTURE" : "-o", "is needed: an environment, and the folder that it is baked to"));
    const Jobs jobs(a.threads);
    EnvironmentOptions options = a.environment;
    options.quiet = a.quiet, options.use_cache = false;
    const auto baked = open_environment(a.picture, options, a.limits, jobs);
    if (!baked)
        return fail(baked.error());
    std::error_code failed;
    fs::create_directories(a.output, failed);
    if (failed)
        return fail({ExitCode::output_failed, a.output, "", failed.message()});
    const std::vector<std::uint8_t> bytes = environment_cache_bytes(**baked);
    return write_bytes(a, (fs::path(a.output) / kBakedEnvironment).string(), bytes.data(), bytes.size(), (*baked)->warnings);
}

int run_displaced(const BakeArguments& a)
{
    if (a.picture.empty() || a.heights.empty())
        return fail(usage_error(a.picture.empty() ? "PICTURE" : "HEIGHTS", "is needed: a mesh and its height map"));
    if (fs::path(a.output).extension() != ".glb")
        return fail(usage_error("-o", a.output.empty() ? "is needed" : fmt::format("'{}' must end in .glb", a.output)));
    if (const Status path = check_text_path("-o", a.output, {a.picture, a.heights}); !path)
        return fail(path.error());
    const auto data = open_scene(a.picture, a.limits, {}, {}, {});
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
    return write_bytes(a, a.output, made->glb.data(), made->glb.size(), warnings);
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
        return write_map(a, albedo_table(nu, nv, size_of(a, {kLobeAlbedoSize / 2, kLobeAlbedoSize}), a.azimuth));
    }
    const bool density = fs::path(a.output).extension() == ".exr";
    if (*type == PixelType::f32 && !density)
        return fail(usage_error("-o", fmt::format("'{}' must end in .exr, which holds the density too, or in .png or .tif", a.output)));
    const Image table = half_vector_table(nu, nv, size_of(a, {256, 256}), *type);
    Warnings warnings;
    if (*type == PixelType::u8)
        warnings.push_back(fmt::format("8 bits leave {} values along the tangent, and no densities", codes_of(table)));
    return write_map(a, table, warnings);
}

int run_bake(const BakeArguments& arguments, const OptionTable& given)
{
    if (arguments.what != "half-vectors" && arguments.what != "brdf-lut")
        for (const char* option : {"--nu", "--nv"})
            if (given.given(option))
                return fail(usage_error(option, "is of half-vectors and brdf-lut"));
    if (given.given("--brdf") && arguments.what != "ltc" && arguments.what != "mip")
        return fail(usage_error("--brdf", "is of ltc and mip"));
    if (given.given("--azimuth") && arguments.what != "brdf-lut")
        return fail(usage_error("--azimuth", "is of brdf-lut"));
    if (given.given("--size") && arguments.what != "tpr" && arguments.what != "half-vectors" && arguments.what != "brdf-lut")
        return fail(usage_error("--size", "is of tpr, half-vectors and brdf-lut"));
    if (arguments.what == "half-vectors" || arguments.what == "brdf-lut")
        return run_phong(arguments, given);
    if (arguments.what == "displaced")
        return run_displaced(arguments);
    if (!arguments.heights.empty())
        return fail(usage_error("HEIGHTS", fmt::format("'{}': only displaced takes two files", arguments.heights)));
    if (arguments.what == "environment")
        return run_environment(arguments);
    if (arguments.what == "mip")
        return run_mip({arguments.mip, arguments.picture, arguments.output, arguments.limits, arguments.threads, arguments.verbosity,
                        arguments.quiet});
    if (arguments.what == "direction")
        return run_direction(arguments);
    if (arguments.what == "quaternion")
        return run_quaternion(arguments);
    if (arguments.what == "tpr")
        return run_tpr(arguments);
    if (Status checked = check_arguments(arguments, given); !checked)
        return fail(checked.error());
    Report report(arguments.quiet, arguments.verbosity);
    const Jobs jobs(arguments.threads);
    const Result<std::optional<ltc::Table>> table = table_of(arguments, given, jobs, report);
    if (!table)
        return fail(table.error());
    report.release();
    if (!*table) {
        report.event("stopped", fmt::format("the same command goes on from {}.part; no table was written", arguments.output));
        return 128 + stop_signal(); // as a shell reports a process that a signal ended
    }
    if (arguments.report.empty())
        return 0;
    const LtcQuality quality = measure_ltc(**table, arguments.cosines, jobs);
    Json figures = ltc_json(quality, **table);
    std::vector<std::pair<std::string, Drawing>> drawings = {{"quality", plot_ltc_quality(quality)}};
    std::string lines = ltc_lines(quality);
    if ((*table)->model() == ltc::Model::ggx && !(*table)->grid.round) { // the document's figures are of its lobes
        drawings.emplace_back("lobes", plot_ltc(LobePlot(), **table));
        const LtcResolutions resolutions = measure_resolutions(**table, jobs);
        figures["resolutions"] = resolution_json(resolutions);
        drawings.emplace_back("resolutions", plot_resolutions(resolutions));
        lines += resolution_lines(resolutions);
    }
    if (Status written = write_report_files(arguments, figures, drawings, report); !written)
        return fail(written.error());
    report.figures(lines);
    return 0;
}

} // namespace

Command bake_command()
{
    auto arguments = std::make_shared<BakeArguments>();
    return {"bake", "Make tables and maps that shading reads", bake_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_bake(*arguments, given); }};
}

} // namespace burnish
