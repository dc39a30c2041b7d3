// Approximate environment radiance for lobes of any width, for `--risks`.
#pragma once
#include <glm/glm.hpp>

#include "shading/bake/environment/environment.h"

namespace burnish {

class Sky {
  public:
    // Reads the prefiltered levels, without extracted lights, from the first level with at most 128 texels a side. Texels are converted
    // on each lookup: a picture asks for fewer texels than there are.
    explicit Sky(const Environment& environment);
    // Returns the luminance for a round lobe with this roughness about `direction` (any length, not 0; environment space, unrotated):
    // the nearest texel of the nearest level.
    float luminance(const glm::vec3& direction, float roughness) const { return at(direction, level_of(roughness)); }
    float diffuse(const glm::vec3& direction) const { return at(direction, static_cast<int>(last_)); } // for the widest lobe

  private:
    int level_of(float roughness) const { return static_cast<int>(roughness * last_ + 0.5f); }
    float at(const glm::vec3& direction, int level) const;

    const CubeMap& cube_;
    int first_ = 0; // level: finer ones are not used
    float last_ = 0.0f;
};

} // namespace burnish
