#include "shading/bake/mipnet/batch.h"

#include <algorithm>
#include <cmath>

#include "core/math/scalar_math.h"
#include "shading/bake/mipnet/net.h"

namespace burnish::mipnet {
namespace {

struct Direction3 {
    double x, y, z;
};

Direction3 around_z(double z, double turn)
{
    const double r = std::sqrt(std::max(1.0 - z * z, 0.0));
    return {r * det_cos(turn), r * det_sin(turn), z};
}

Direction3 cosine_weighted(Random& random) // except grazing directions
{
    const double z = std::sqrt(random.between(0.01, 1.0));
    return around_z(z, random.between(0.0, 2.0 * kPi));
}

} // namespace

void put_pair(Random& random, float* pair, std::size_t apart, double mirrored_share)
{
    const double kind = random.unit();
    const Direction3 o = cosine_weighted(random);
    Direction3 i = around_z(random.between(0.1, 1.0), random.between(0.0, 2.0 * kPi));
    if (kind >= 1.0 - mirrored_share)
        for (int tries = 0; tries < 8; ++tries) {
            const double u = random.unit(), turn = random.between(0.0, 2.0 * kPi);
            const Direction3 h = around_z(det_pow(u, kind < 1.0 - 0.5 * mirrored_share ? 1.0 / 11.0 : 1.0 / 81.0), turn);
            const double oh = o.x * h.x + o.y * h.y + o.z * h.z;
            const Direction3 mirrored = {2.0 * oh * h.x - o.x, 2.0 * oh * h.y - o.y, 2.0 * oh * h.z - o.z};
            if (mirrored.z < 0.05)
                continue;
            i = mirrored;
            break;
        }
    const double values[] = {i.x, i.y, i.z, o.x, o.y, o.z};
    for (std::size_t k = 0; k < 6; ++k)
        pair[k * apart] = static_cast<float>(values[k]);
}

std::size_t place_in_shard(int x, int y, int tile)
{
    std::size_t at = 0, n = static_cast<std::size_t>(kSlots) * kTileSide * kTileSide;
    for (int level = 0; level < kTrainedLevels; ++level, x >>= 1, y >>= 1) {
        n /= 4;
        at += static_cast<std::size_t>((x & 1) | (y & 1) << 1) * n;
    }
    return at + static_cast<std::size_t>(tile);
}

Batch make_batch(const TrainingSet& set, std::uint64_t seed, int pairs, double mirrored_share)
{
    constexpr std::size_t kTexelsOfShard = static_cast<std::size_t>(kSlots) * kTileSide * kTileSide;
    Random random(seed);
    Batch batch;
    batch.texels.resize(kChannels * kTexelsOfShard);
    batch.tiles.resize(3 * kSlots);
    batch.pairs.resize(static_cast<std::size_t>(pairs) * 6 * kSlots);
    for (int tile = 0; tile < kTiles; ++tile) {
        // Cut a random tile from a random material, and mirror it
        const Material& m = set.materials[static_cast<std::size_t>(random.below(static_cast<int>(set.materials.size())))];
        const int side = m.texels.width, x0 = random.below(side), y0 = random.below(side), symmetry = random.below(8);
        Texels cut = make_texels(kTileSide, kTileSide);
        for (int y = 0; y < kTileSide; ++y)
            for (int x = 0; x < kTileSide; ++x) {
                const std::size_t from =
                    static_cast<std::size_t>((y0 + y) % side) * static_cast<std::size_t>(side) + static_cast<std::size_t>((x0 + x) % side);
                for (std::size_t c = 0; c < kChannels; ++c)
                    cut.channel[c][static_cast<std::size_t>(y * kTileSide + x)] = m.texels.channel[c][from];
            }
        cut = mirrored(cut, symmetry);
        for (int y = 0; y < kTileSide; ++y)
            for (int x = 0; x < kTileSide; ++x)
                for (std::size_t c = 0; c < kChannels; ++c)
                    batch.texels[c * kTexelsOfShard + place_in_shard(x, y, tile)] =
                        cut.channel[c][static_cast<std::size_t>(y * kTileSide + x)];
        // Draw reflectances, intensity and directions
        const double base = m.metal ? random.between(0.4, 1.0) : random.between(0.05, 0.9);
        const std::size_t t = static_cast<std::size_t>(tile);
        batch.tiles[t] = static_cast<float>(m.metal ? base : 0.04);
        batch.tiles[kSlots + t] = static_cast<float>(m.metal ? 0.0 : base);
        batch.tiles[2 * kSlots + t] = static_cast<float>(random.between(1.0, 10.0));
        for (std::size_t p = 0; p < static_cast<std::size_t>(pairs); ++p)
            put_pair(random, batch.pairs.data() + p * 6 * kSlots + t, kSlots, mirrored_share);
    }
    return batch;
}

} // namespace burnish::mipnet
