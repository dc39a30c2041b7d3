// The cascades that are part of the program, shading/bake/mipnet/*.mipnet with their bytes as they were when it was built.
#pragma once
#include "core/base/embedded.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish {
extern const EmbeddedFile kMipnetGgx, kMipnetBeckmann, kMipnetAshikhminShirley;
}

namespace burnish::mipnet {

const Weights* shipped_weights(Lobe lobe); // of every lobe, kept for good

} // namespace burnish::mipnet
