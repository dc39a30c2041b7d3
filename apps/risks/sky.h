// How bright an environment is for lobes of any width, coarsely: what `--risks` asks of it.
#pragma once
#include <glm/glm.hpp>

#include "shading/bake/environment/environment.h"

namespace burnish {

class Sky {
  public:
    // Of the prefiltered levels, key lights left out, from one of at most 128 texels a side on. The environment is read whenever asked: a
    // picture asks for fewer texels than there are.
    explicit Sky(const Environment& environment);
    // Luminance that a round lobe of this alpha_lin about `direction` (any length, not 0; of the environment, unturned) meets: the nearest
    // texel of the nearest level.
    float luminance(const glm::vec3& direction, float alpha_lin) const { return at(direction, level_of(alpha_lin)); }
    float diffuse(const glm::vec3& direction) const { return at(direction, static_cast<int>(last_)); } // of the widest lobe

  private:
    int level_of(float alpha_lin) const { return static_cast<int>(alpha_lin * last_ + 0.5f); }
    float at(const glm::vec3& direction, int level) const;

    const CubeMap& cube_;
    int first_ = 0; // level: finer ones are not told apart
    float last_ = 0.0f;
};

} // namespace burnish
