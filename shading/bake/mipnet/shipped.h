// Built-in cascades: shading/bake/mipnet/*.mipnet, embedded at build time.
#pragma once
#include "core/base/embedded.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish {
extern const EmbeddedFile kMipnetGgx, kMipnetBeckmann, kMipnetAshikhminShirley;
}

namespace burnish::mipnet {

const Weights* shipped_weights(Lobe lobe); // for every lobe; never freed

} // namespace burnish::mipnet
