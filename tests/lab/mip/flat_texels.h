// Texels of one value, for tests of mip levels.
#pragma once
#include "shading/bake/mipnet/texels.h"

namespace burnish {

// Returns side x side texels with level normals and a round lobe of width alpha.
inline mipnet::Texels flat_texels(int side, float alpha)
{
    mipnet::Texels t = mipnet::make_texels(side, side);
    t.channel[2].assign(t.count(), alpha), t.channel[3].assign(t.count(), alpha);
    return t;
}

} // namespace burnish
