#include "shading/bake/mipnet/shipped.h"

#include <array>

#include "core/base/check.h"

namespace burnish::mipnet {

const Weights* shipped_weights(Lobe lobe)
{
    static const std::array<Weights, 3> all = [] { // by lobe
        std::array<Weights, 3> weights;
        const EmbeddedFile* const files[] = {&kMipnetGgx, &kMipnetBeckmann, &kMipnetAshikhminShirley};
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const std::string name = lobe_name(static_cast<Lobe>(i));
            Result<Weights> read = parse_weights(reinterpret_cast<const std::uint8_t*>(files[i]->bytes), files[i]->size, name + ".mipnet");
            BN_CHECK(read && read->shape.lobe == static_cast<Lobe>(i));
            weights[i] = std::move(*read);
        }
        return weights;
    }();
    return &all[static_cast<std::size_t>(lobe)];
}

} // namespace burnish::mipnet
