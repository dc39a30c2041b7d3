#include "shading/bake/mip/pyramid_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "core/base/bytes.h"
#include "core/base/hash.h"
#include "shading/bake/mip/level_gains.h"
#include "shading/bake/mip/texture.h"

namespace burnish {
namespace {

static_assert(std::endian::native == std::endian::little, "levels are little-endian");
static_assert(sizeof(MipTexel) == 5 * sizeof(float));
constexpr char kMipMagic[8] = {'b', 'n', 'm', 'i', 'p', '0', '1', '\n'};
constexpr std::uint32_t kMipVersion = 3;
constexpr int kMostSide = 1 << 16;

struct MipFileHeader {
    char magic[8];
    std::uint32_t version, count;
};
struct MipMaterialHeader {
    char filter[16];
    float kappa;
    std::uint32_t width, height, levels;
    std::uint64_t source, net;
    std::uint32_t gained, zero;
};
static_assert(sizeof(MipFileHeader) == 16 && sizeof(MipMaterialHeader) == 56);

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

// Empty where all is well.
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
    if (h.width < 1 || h.height < 1 || h.width > kMostSide || h.height > kMostSide || !std::isfinite(h.kappa))
        return fmt::format("holds levels of {}x{} texels", h.width, h.height);
    to.kappa = h.kappa, to.source = h.source, to.net = h.net, to.gained = h.gained;
    to.width = static_cast<int>(h.width), to.height = static_cast<int>(h.height);
    int levels = 0;
    while (levels + 1 < kMaxTextureLevels && (std::max(to.width, to.height) >> (levels + 1)) > 0)
        ++levels;
    if (static_cast<int>(h.levels) != levels)
        return fmt::format("holds {} levels of {}x{} texels, not {}", h.levels, h.width, h.height, levels);
    std::vector<float> gains(h.levels);
    if (!from.read(gains.data(), gains.size()))
        return "is cut off";
    if (h.gained > 6 || !std::all_of(gains.begin(), gains.end(), [&](float g) { return is_gain(g, h.gained != 0); }))
        return "holds no gain of a level";
    for (int l = 1; l <= levels; ++l) {
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

} // namespace

std::vector<std::uint8_t> mip_file_bytes(const std::vector<const MipLevels*>& materials)
{
    std::size_t size = sizeof(MipFileHeader) + sizeof(std::uint64_t);
    for (const MipLevels* m : materials) {
        size += sizeof(MipMaterialHeader);
        for (const MipLevel& level : m->levels)
            size += sizeof level.gain + level.texels.size() * sizeof(MipTexel);
    }
    std::vector<std::uint8_t> bytes;
    bytes.reserve(size); // of large maps it is the largest thing there is
    MipFileHeader head = {};
    std::memcpy(head.magic, kMipMagic, sizeof kMipMagic);
    head.version = kMipVersion, head.count = static_cast<std::uint32_t>(materials.size());
    append_bytes(bytes, &head, sizeof head);
    for (const MipLevels* m : materials) {
        MipMaterialHeader h = {};
        const std::string name = mip_filters()[static_cast<std::size_t>(m->filter)].name;
        std::copy_n(name.begin(), std::min(name.size(), sizeof h.filter), h.filter);
        h.kappa = m->kappa, h.source = m->source, h.net = m->net, h.gained = m->gained;
        h.width = static_cast<std::uint32_t>(m->width), h.height = static_cast<std::uint32_t>(m->height);
        h.levels = static_cast<std::uint32_t>(m->levels.size());
        append_bytes(bytes, &h, sizeof h);
        for (const MipLevel& level : m->levels)
            append_bytes(bytes, &level.gain, sizeof level.gain);
        for (const MipLevel& level : m->levels)
            append_bytes(bytes, level.texels.data(), level.texels.size() * sizeof(MipTexel));
    }
    const std::uint64_t hash = hash_bytes(bytes.data(), bytes.size());
    append_bytes(bytes, &hash, sizeof hash);
    return bytes;
}

Result<std::vector<MipLevels>> parse_mip_file(const std::vector<std::uint8_t>& bytes, const std::string& path)
{
    const auto refused = [&](const std::string& why) { return Error{ExitCode::bad_input, path, "", why}; };
    MipFileHeader head;
    std::uint64_t hash = 0;
    Reader whole(bytes.data(), bytes.size());
    if (bytes.size() < sizeof head + sizeof hash || !whole.read(&head, 1) || std::memcmp(head.magic, kMipMagic, sizeof kMipMagic) != 0)
        return refused("is no file of burnish bake mip");
    if (head.version != kMipVersion)
        return refused(fmt::format("is of version {}, not {}", head.version, kMipVersion));
    std::memcpy(&hash, bytes.data() + bytes.size() - sizeof hash, sizeof hash);
    if (hash != hash_bytes(bytes.data(), bytes.size() - sizeof hash))
        return refused("is damaged: its last 8 bytes are not the hash of what is before them");
    Reader from(bytes.data() + sizeof head, bytes.size() - sizeof head - sizeof hash);
    if (head.count > from.left() / sizeof(MipMaterialHeader))
        return refused("is cut off");
    std::vector<MipLevels> materials(head.count);
    for (MipLevels& m : materials)
        if (const std::string wrong = read_material(from, m); !wrong.empty())
            return refused(wrong);
    if (from.left() > 0)
        return refused(fmt::format("has {} bytes too many", from.left()));
    return materials;
}

} // namespace burnish
