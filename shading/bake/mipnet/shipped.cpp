#include "shading/bake/mipnet/shipped.h"

#include "core/base/check.h"

namespace burnish::mipnet {

const Weights* shipped_weights(Lobe lobe)
{
    static const Weights ggx = [] {
        const Result<Weights> weights =
            parse_weights(reinterpret_cast<const std::uint8_t*>(kMipnetGgx.bytes), kMipnetGgx.size, "ggx_aniso.mipnet");
        BN_CHECK(weights);
        return *weights;
    }();
    return lobe == Lobe::ggx_aniso ? &ggx : nullptr;
}

} // namespace burnish::mipnet
