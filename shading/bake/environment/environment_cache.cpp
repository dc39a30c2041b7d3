#include "shading/bake/environment/environment_cache.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <limits>

#include "core/base/cache.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "shading/bake/environment/cube_map.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

static_assert(std::endian::native == std::endian::little, "cache files are little-endian");

// The file's header. The specular texels, the irradiance texels and, with extracted lights, the whole environment's texels follow.
struct Header {
    char magic[8];
    std::uint32_t version;
    std::int32_t size, levels, irradiance_size;
    float specular_scale, irradiance_scale, whole_scale, peak_source;
    std::int32_t extracted_light_count;
    ExtractedLight extracted_lights[kMaxExtractedLights];
    std::uint32_t zero;
    double energy_source, energy_cube;
    std::uint64_t content_hash;
    std::uint64_t payload_hash;
    std::uint64_t header_hash; // of all fields above
};
static_assert(sizeof(ExtractedLight) == 56 && sizeof(Header) == 536);
constexpr char kMagic[8] = {'b', 'u', 'r', 'n', 'e', 'n', 'v', '\n'};

constexpr std::uint64_t kMostBytes = 1u << 30; // a cube of 2048 texels has 200 MB

std::uint64_t hash_of(const Header& h)
{
    return hash_bytes(&h, offsetof(Header, header_hash));
}

std::size_t bytes_of(const CubeMap& cube)
{
    return cube.texels.size() * sizeof(std::uint16_t);
}

// Returns true if a cube's texels are valid radiance: finite and not negative.
bool holds_light(const CubeMap& cube)
{
    // Four halves at a time. Above 0x7bff is no finite number; with the sign bit, only -0 is light.
    constexpr std::uint64_t kMagnitude = 0x7fff7fff7fff7fff, kSign = ~kMagnitude, kToSign = 0x0400040004000400;
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i + 4 <= cube.texels.size(); i += 4) {
        std::uint64_t texel;
        std::memcpy(&texel, cube.texels.data() + i, sizeof(texel));
        const std::uint64_t magnitude = texel & kMagnitude; // sums below stay within their 16 bits
        wrong |= (magnitude + kToSign) | (texel & (magnitude + kMagnitude));
    }
    return (wrong & kSign) == 0;
}

// Returns true if all numbers of an extracted light are in range for drawing.
bool is_extracted_light(const ExtractedLight& k)
{
    const auto within = [](const float* v, float least, float most) {
        return std::all_of(v, v + 3, [&](float x) { return x >= least && x <= most; });
    };
    return within(k.direction, -1.01f, 1.01f) && within(k.axis_u, -10.0f, 10.0f) && within(k.axis_v, -10.0f, 10.0f) &&
           within(k.irradiance, 0.0f, std::numeric_limits<float>::max()) && k.angular_radius >= 0.0f && k.angular_radius <= 4.0f &&
           k.share >= 0.0f && k.share <= 1.01f;
}

} // namespace

std::uint64_t environment_hash(const Image& equirect, const EnvironmentOptions& options, int levels)
{
    const struct {
        std::uint32_t version;
        std::int32_t width, height, channels, type, size, levels, samples, extracted_lights;
        float zero[2]; // former place of rotation and exposure; zeros keep older files valid
    } key = {kBakeVersion,      equirect.width, equirect.height, equirect.channels,        static_cast<std::int32_t>(equirect.type),
             options.cube_size, levels,         options.samples, options.extracted_lights, {0.0f, 0.0f}};
    return hash_bytes(equirect.bytes.data(), equirect.bytes.size(), hash_bytes(&key, sizeof(key)));
}

std::string environment_cache_path(const EnvironmentOptions& options, std::uint64_t content_hash)
{
    const std::string folder = options.cache_dir.empty() ? cache_folder() : options.cache_dir;
    return folder.empty() ? "" : fmt::format("{}/environment-{:016x}.bnenv", folder, content_hash);
}

namespace {

// A cache file's bytes, in order. read: returns false if there are too few.
struct CacheBytes {
    std::uint64_t size;
    std::function<bool(void* to, std::size_t bytes)> read;
};

std::size_t cube_bytes(int size, int levels)
{
    std::size_t texels = 0;
    for (int l = 0; l < levels; ++l)
        texels += cube_texels((size >> l) + 2);
    return texels * 4 * sizeof(std::uint16_t);
}

// Returns true if all figures and extracted lights are in range for drawing.
bool holds_figures(const Header& h)
{
    // Largest scale with which every half float up to 65504 gives a finite float.
    constexpr float kMostScale = 0x1p111f;
    for (const double figure : {static_cast<double>(h.specular_scale), static_cast<double>(h.irradiance_scale),
                                static_cast<double>(h.whole_scale), static_cast<double>(h.peak_source), h.energy_source, h.energy_cube})
        if (!std::isfinite(figure) || figure < 0.0)
            return false;
    return std::max({h.specular_scale, h.irradiance_scale, h.whole_scale}) <= kMostScale &&
           std::all_of(h.extracted_lights, h.extracted_lights + h.extracted_light_count, is_extracted_light);
}

// Reads the texels into their cubes.
std::optional<Environment> parse(const CacheBytes& file, std::uint64_t content_hash, int size, int levels)
{
    const std::uint64_t least = sizeof(Header) + cube_bytes(size, levels) + cube_bytes(kIrradianceSize, 1);
    const std::uint64_t most = least + cube_bytes(size, 1);
    Header h;
    if ((file.size != least && file.size != most) || !file.read(&h, sizeof(h)))
        return std::nullopt;
    if (std::memcmp(h.magic, kMagic, sizeof(kMagic)) != 0 || h.version != kBakeVersion || h.size != size || h.levels != levels ||
        h.irradiance_size != kIrradianceSize || h.content_hash != content_hash || h.header_hash != hash_of(h) ||
        h.extracted_light_count < 0 || h.extracted_light_count > kMaxExtractedLights ||
        (h.extracted_light_count > 0) != (file.size == most) || !holds_figures(h))
        return std::nullopt;
    Environment e;
    HashStream hash;
    const auto take = [&](CubeMap& cube, int side, int side_levels, float scale) {
        cube = make_unfilled_cube_map(side, side_levels, scale);
        const bool whole = file.read(cube.texels.data(), bytes_of(cube));
        if (whole)
            hash.add(cube.texels.data(), bytes_of(cube));
        return whole;
    };
    if (!take(e.specular, size, levels, h.specular_scale) || !take(e.irradiance, kIrradianceSize, 1, h.irradiance_scale) ||
        (h.extracted_light_count > 0 && !take(e.whole, size, 1, h.whole_scale)) || hash.value() != h.payload_hash ||
        !holds_light(e.specular) || !holds_light(e.irradiance) || !holds_light(e.whole))
        return std::nullopt;
    e.extracted_lights.assign(h.extracted_lights, h.extracted_lights + h.extracted_light_count);
    e.energy_source = h.energy_source, e.energy_cube = h.energy_cube, e.peak_source = h.peak_source;
    e.content_hash = content_hash;
    e.from_cache = true;
    return e;
}

CacheBytes bytes_in(const std::uint8_t* data, std::size_t bytes)
{
    return {bytes, [data, bytes, at = std::size_t{0}](void* to, std::size_t some) mutable {
                if (some > bytes - at)
                    return false;
                std::memcpy(to, data + at, some);
                at += some;
                return true;
            }};
}

} // namespace

std::optional<Environment> parse_environment_cache(const std::uint8_t* data, std::size_t bytes, std::uint64_t content_hash, int size,
                                                   int levels)
{
    return parse(bytes_in(data, bytes), content_hash, size, levels);
}

std::optional<Environment> read_environment_cache(const std::string& path, std::uint64_t content_hash, int size, int levels)
{
    Result<FileReader> file = FileReader::open(path, kMostBytes, Links::refuse);
    if (!file)
        return std::nullopt;
    const auto read = [&](void* to, std::size_t bytes) { return static_cast<bool>(file->read(to, bytes)); };
    std::optional<Environment> found = parse({file->size(), read}, content_hash, size, levels);
    if (found)
        note_cache_use(path);
    return found;
}

std::vector<std::uint8_t> environment_cache_bytes(const Environment& e)
{
    std::vector<std::uint8_t> file(sizeof(Header) + bytes_of(e.specular) + bytes_of(e.irradiance) + bytes_of(e.whole));
    std::uint8_t* to = file.data() + sizeof(Header);
    for (const CubeMap* cube : {&e.specular, &e.irradiance, &e.whole})
        to = std::copy_n(reinterpret_cast<const std::uint8_t*>(cube->texels.data()), bytes_of(*cube), to);
    Header h = {};
    std::memcpy(h.magic, kMagic, sizeof(kMagic));
    h.version = kBakeVersion;
    h.size = e.specular.size, h.levels = e.specular.levels, h.irradiance_size = e.irradiance.size;
    h.specular_scale = e.specular.scale, h.irradiance_scale = e.irradiance.scale, h.whole_scale = e.whole.scale;
    h.peak_source = e.peak_source;
    h.extracted_light_count = static_cast<std::int32_t>(e.extracted_lights.size());
    std::copy(e.extracted_lights.begin(), e.extracted_lights.end(), h.extracted_lights);
    h.energy_source = e.energy_source, h.energy_cube = e.energy_cube;
    h.content_hash = e.content_hash;
    h.payload_hash = hash_bytes(file.data() + sizeof(Header), file.size() - sizeof(Header));
    h.header_hash = hash_of(h);
    std::memcpy(file.data(), &h, sizeof(h));
    return file;
}

bool is_baked_environment(const std::string& path)
{
    std::error_code ignored;
    return std::filesystem::path(path).extension() == ".bnenv" || std::filesystem::is_directory(path, ignored);
}

Result<Environment> read_baked_environment(const std::string& path)
{
    std::error_code ignored;
    const std::string name =
        std::filesystem::is_directory(path, ignored) ? (std::filesystem::path(path) / kBakedEnvironment).string() : path;
    const Result<std::vector<std::uint8_t>> file = read_file(name, kMostBytes);
    BN_TRY(file);
    const auto refused = [&](const char* why) { return Error{ExitCode::bad_input, name, "", why}; };
    Header h;
    if (file->size() < sizeof(h))
        return refused("is no baked environment");
    std::memcpy(&h, file->data(), sizeof(h));
    if (std::memcmp(h.magic, kMagic, sizeof(kMagic)) != 0)
        return refused("is no baked environment");
    if (h.version != kBakeVersion)
        return refused("was baked by another version of burnish");
    const bool sized = h.size >= 4 && h.size <= 4096 && (h.size & (h.size - 1)) == 0 && h.levels >= 1 && h.levels <= 13 &&
                       h.size >> (h.levels - 1) > 0 && h.header_hash == hash_of(h);
    std::optional<Environment> found;
    if (sized)
        found = parse_environment_cache(file->data(), file->size(), h.content_hash, h.size, h.levels);
    if (!found)
        return refused("is damaged: not all bytes are as they were written");
    return std::move(*found);
}

Status write_environment_cache(const std::string& path, const Environment& e)
{
    const std::vector<std::uint8_t> file = environment_cache_bytes(e);
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code ignored; // the write reports a folder that cannot be made
    std::filesystem::create_directories(folder, ignored);
    const Status written = write_file_atomic(path, file.data(), file.size(), Links::refuse);
    prune_cache(folder.string(), cache_limit(), path);
    return written;
}

} // namespace burnish
