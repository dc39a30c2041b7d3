// Materials made in code, to train nets on and to judge them by: reliefs of a family, each tiling, with widths that may vary and turn.
#pragma once
#include <string>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mipnet/texels.h"

namespace burnish::mipnet {

struct Family {
    const char* name;
    bool held_out; // never trained on
};
const std::vector<Family>& families();
std::string trained_families(); // "hammered, brushed, ..."

struct Material {
    std::string name; // "twill 3"
    Texels texels;
    bool metal = false;
};
Material make_material(const Family& family, std::uint64_t seed, int side); // side: a multiple of 64

// Seeds of the training set begin at 0, those of other sets where none of it can be.
inline constexpr std::uint64_t kValidationSeeds = 1u << 20, kTestSeeds = 1u << 21;

struct TrainingSet {
    std::vector<Material> materials;
    std::uint64_t hash = 0; // of all of it
};
inline constexpr int kTrainedSide = 128; // texels, of materials that shipped nets are trained on
TrainingSet make_training_set(int seeds, int side, const Jobs& jobs);
void add_material(TrainingSet& set, const Material& material);

struct TestMaterial {
    Material material;
    std::string set; // "held-out", "new seeds", "trained"
};
std::vector<TestMaterial> make_test_set(const Jobs& jobs);
// Metals whose grain crosses below a texel, which one lobe cannot show: set "crossed".
std::vector<TestMaterial> make_crossed_set();
std::vector<TestMaterial> make_trained_set(const Jobs& jobs); // two of every trained family that nets are trained on
std::vector<TestMaterial>
make_validation_set(const Jobs& jobs); // what may be looked at while anything is chosen: trained families, other seeds

} // namespace burnish::mipnet
