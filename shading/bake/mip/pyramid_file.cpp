#include "shading/bake/mip/pyramid_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "core/base/bytes.h"
#include "core/base/hash.h"
#include "shading/bake/mip/grid.h"
#include "shading/bake/mip/level_gains.h"

namespace burnish {
namespace {

static_assert(std::endian::native == std::endian::little, "levels are little-endian");
static_assert(sizeof(MipTexel) == 5 * sizeof(float));
constexpr char kMipMagic[8] = {'b', 'n', 'm', 'i', 'p', '0', '1', '\n'};
constexpr std::uint32_t kMipVersion = 4;
constexpr int kMostSide = 1 << 16;

struct MipFileHeader {
    char magic[8];
    std::uint32_t version, materials, maps, zero;
};
struct MipMaterialHeader {
    char filter[16];
    float kappa;
    std::uint32_t width, height, levels;
    std::uint64_t source, net;
    std::uint32_t gained, zero;
};
struct MipMapHeader {
    MapId id;
    std::uint32_t width, height, channels, levels;
};
static_assert(sizeof(MipFileHeader) == 24 && sizeof(MipMaterialHeader) == 56 && sizeof(MapId) == 24 && sizeof(MipMapHeader) == 40);

class Reader {
  public:
    Reader(const std::uint8_t* at, std::size_t size) : at_(at), left_(size) {}
    template <class T> bool read(T* to, std::size_t count)
    {
        if (count > left_ / sizeof(T))
            return false;
        if (count > 0)
            std::memcpy(to, at_, count * sizeof(T));
        at_ += count * sizeof(T), left_ -= count * sizeof(T);
        return true;
    }
    std::size_t left() const { return left_; }

  private:
    const std::uint8_t* at_;
    std::size_t left_;
};

bool is_lobe(const MipTexel& t)
{
    return t.nx * t.nx + t.ny * t.ny <= 1.0f && t.a >= 0.0f && t.b >= 0.0f && t.a <= 1.0f && t.b <= 1.0f && t.c * t.c <= t.a * t.b;
}

bool is_gain(float gain, bool any)
{
    return any ? gain >= kLeastGain && gain <= kMostGain : gain == 1.0f;
}

// Returns the fault in a header's sides and number of levels. Empty if there is none.
std::string wrong_sides(std::uint32_t width, std::uint32_t height, std::uint32_t levels)
{
    if (width < 1 || height < 1 || width > kMostSide || height > kMostSide)
        return fmt::format("holds levels of {}x{} texels", width, height);
    const int wanted = levels_below(static_cast<int>(width), static_cast<int>(height));
    if (levels != static_cast<std::uint32_t>(wanted))
        return fmt::format("holds {} levels of {}x{} texels, not {}", levels, width, height, wanted);
    return "";
}

// Reads a material. Returns the fault, or an empty string.
std::string read_material(Reader& from, MipLevels& to)
{
    MipMaterialHeader h;
    if (!from.read(&h, 1))
        return "is cut off";
    std::size_t filter = 0;
    while (filter < mip_filters().size() && std::strncmp(h.filter, mip_filters()[filter].name, sizeof h.filter) != 0)
        ++filter;
    to.filter = static_cast<MipFilter>(filter);
    if (filter == mip_filters().size() || !makes_lobes(to.filter))
        return "is of a filter that makes no levels of lobes";
    if (const std::string wrong = wrong_sides(h.width, h.height, h.levels); !wrong.empty())
        return wrong;
    if (const float most = takes_kappa(to.filter) ? static_cast<float>(kMostKappa) : 0.0f; !(h.kappa >= 0.0f && h.kappa <= most))
        return fmt::format("holds a kappa of {}, which must be 0 to {} of this filter", h.kappa, most);
    to.kappa = h.kappa, to.source = h.source, to.net = h.net, to.gained = h.gained;
    to.width = static_cast<int>(h.width), to.height = static_cast<int>(h.height);
    std::vector<float> gains(h.levels);
    if (!from.read(gains.data(), gains.size()))
        return "is cut off";
    if (h.gained > 6 || !std::all_of(gains.begin(), gains.end(), [&](float g) { return is_gain(g, h.gained != 0); }))
        return "holds no gain of a level";
    for (int l = 1; l <= static_cast<int>(h.levels); ++l) {
        MipLevel level = {std::max(1, to.width >> l), std::max(1, to.height >> l), {}, gains[static_cast<std::size_t>(l) - 1]};
        const std::size_t texels = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height);
        if (texels > from.left() / sizeof(MipTexel))
            return "is cut off";
        level.texels.resize(texels);
        from.read(level.texels.data(), texels);
        if (!std::all_of(level.texels.begin(), level.texels.end(), is_lobe))
            return fmt::format("holds no lobe at a texel of level {}", l);
        to.levels.push_back(std::move(level));
    }
    return "";
}

// Reads a map. Returns the fault, or an empty string.
std::string read_map(Reader& from, MapLevels& to)
{
    MipMapHeader h;
    if (!from.read(&h, 1))
        return "is cut off";
    if (h.id.part > MapPart::height || h.id.kernel > ColourKernel::kaiser)
        return "holds a map that is none";
    if (const std::string wrong = wrong_sides(h.width, h.height, h.levels); !wrong.empty())
        return wrong;
    if ((h.channels != 1 && h.channels != 3 && h.channels != 4) || (h.id.part == MapPart::height && h.channels != 1))
        return fmt::format("holds a map of {} channels", h.channels);
    to.id = h.id, to.width = static_cast<int>(h.width), to.height = static_cast<int>(h.height), to.channels = static_cast<int>(h.channels);
    for (std::uint32_t l = 1; l <= h.levels; ++l) {
        const std::size_t count = std::size_t{std::max(1u, h.width >> l)} * std::max(1u, h.height >> l) * h.channels;
        if (count > from.left() / sizeof(std::uint16_t))
            return "is cut off";
        std::vector<std::uint16_t> halves(count);
        from.read(halves.data(), count);
        if (!std::all_of(halves.begin(), halves.end(), [](std::uint16_t half) { return (half & 0x7c00u) != 0x7c00u; }))
            return fmt::format("holds a number that is none in level {} of a map", l);
        to.levels.push_back(std::move(halves));
    }
    return "";
}

// Hash of bytes that arrive in parts, block by block.
class BlockHash {
  public:
    BlockHash() { block_.reserve(kBlock); }
    void add(const void* data, std::size_t size)
    {
        for (const auto* from = static_cast<const std::uint8_t*>(data); size > 0;) {
            const std::size_t taken = std::min(size, kBlock - block_.size());
            append_bytes(block_, from, taken);
            from += taken, size -= taken;
            if (block_.size() == kBlock)
                close();
        }
    }
    std::uint64_t hash()
    {
        if (!block_.empty())
            close();
        return hash_;
    }

  private:
    void close() { hash_ = hash_bytes(block_.data(), block_.size(), hash_), block_.clear(); }

    static constexpr std::size_t kBlock = 1u << 20;
    std::vector<std::uint8_t> block_;
    std::uint64_t hash_ = 0;
};

// Calls put(data, size) for all parts of a file, in order.
void put_file(const MipParts& parts, const PutBytes& put)
{
    BlockHash hash;
    bool well = true;
    const auto add = [&](const void* data, std::size_t size) { well = put(data, size), hash.add(data, size); };
    MipFileHeader head = {};
    std::memcpy(head.magic, kMipMagic, sizeof kMipMagic);
    head.version = kMipVersion, head.materials = static_cast<std::uint32_t>(parts.materials.size());
    head.maps = static_cast<std::uint32_t>(parts.map_count);
    add(&head, sizeof head);
    for (const MipLevels* m : parts.materials) {
        MipMaterialHeader h = {};
        const std::string name = mip_filters()[static_cast<std::size_t>(m->filter)].name;
        std::copy_n(name.begin(), std::min(name.size(), sizeof h.filter), h.filter);
        h.kappa = m->kappa, h.source = m->source, h.net = m->net, h.gained = m->gained;
        h.width = static_cast<std::uint32_t>(m->width), h.height = static_cast<std::uint32_t>(m->height);
        h.levels = static_cast<std::uint32_t>(m->levels.size());
        add(&h, sizeof h);
        for (const MipLevel& level : m->levels)
            add(&level.gain, sizeof level.gain);
        for (const MipLevel& level : m->levels)
            add(level.texels.data(), level.texels.size() * sizeof(MipTexel));
    }
    for (std::size_t i = 0; well && i < parts.map_count; ++i) { // maps take long to make
        const MapLevels m = parts.map(i);
        const MipMapHeader h = {m.id, static_cast<std::uint32_t>(m.width), static_cast<std::uint32_t>(m.height),
                                static_cast<std::uint32_t>(m.channels), static_cast<std::uint32_t>(m.levels.size())};
        add(&h, sizeof h);
        for (const std::vector<std::uint16_t>& level : m.levels)
            add(level.data(), level.size() * sizeof level[0]);
    }
    const std::uint64_t all = hash.hash();
    put(&all, sizeof all);
}

} // namespace

std::vector<std::uint8_t> mip_file_bytes(const MipParts& parts)
{
    std::vector<std::uint8_t> bytes;
    put_file(parts, [&](const void* data, std::size_t size) {
        append_bytes(bytes, data, size);
        return true;
    });
    return bytes;
}

Status write_mip_file(const std::string& path, const MipParts& parts, Links links)
{
    return write_file_atomic(
        path, [&](const PutBytes& put) { put_file(parts, put); }, links);
}

Result<MipFile> parse_mip_file(const std::vector<std::uint8_t>& bytes, const std::string& path)
{
    const auto refused = [&](const std::string& why) { return Error{ExitCode::bad_input, path, "", why}; };
    MipFileHeader head;
    std::uint64_t hash = 0;
    Reader whole(bytes.data(), bytes.size());
    if (bytes.size() < sizeof head + sizeof hash || !whole.read(&head, 1) || std::memcmp(head.magic, kMipMagic, sizeof kMipMagic) != 0)
        return refused("is no file of mip levels");
    if (head.version != kMipVersion)
        return refused(fmt::format("is of version {}, not {}", head.version, kMipVersion));
    std::memcpy(&hash, bytes.data() + bytes.size() - sizeof hash, sizeof hash);
    BlockHash found;
    found.add(bytes.data(), bytes.size() - sizeof hash);
    if (hash != found.hash())
        return refused("is damaged: its last 8 bytes are not the hash of what is before them");
    Reader from(bytes.data() + sizeof head, bytes.size() - sizeof head - sizeof hash);
    const std::uint64_t headers =
        std::uint64_t{head.materials} * sizeof(MipMaterialHeader) + std::uint64_t{head.maps} * sizeof(MipMapHeader);
    if (headers > from.left())
        return refused("is cut off");
    MipFile file = {std::vector<MipLevels>(head.materials), std::vector<MapLevels>(head.maps)};
    for (MipLevels& m : file.materials)
        if (const std::string wrong = read_material(from, m); !wrong.empty())
            return refused(wrong);
    for (MapLevels& m : file.maps)
        if (const std::string wrong = read_map(from, m); !wrong.empty())
            return refused(wrong);
    if (from.left() > 0)
        return refused(fmt::format("has {} bytes too many", from.left()));
    return file;
}

} // namespace burnish
