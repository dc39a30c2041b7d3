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

} // namespace burnish::mipnet
