#include "shading/lab/mipnet/training_batch.h"

#include "shading/bake/mipnet/net.h"

namespace burnish::mipnet {

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
