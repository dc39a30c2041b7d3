// Procedural materials to train and judge nets: height fields of several families, all tiling, with widths that may vary and turn.
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

// First seeds of other sets. Seeds of the training set start at 0 and cannot reach these.
inline constexpr std::uint64_t kValidationSeeds = 1u << 20, kTestSeeds = 1u << 21;

struct TrainingSet {
    std::vector<Material> materials;
    std::uint64_t hash = 0; // of all materials
};
inline constexpr int kTrainedSide = 128; // texels, for materials that train shipped nets
TrainingSet make_training_set(int seeds, int side, const Jobs& jobs);
void add_material(TrainingSet& set, const Material& material);

struct TestMaterial {
    Material material;
    std::string set; // "held-out", "new seeds", "trained"
};
std::vector<TestMaterial> make_test_set(const Jobs& jobs);
// Returns metals with crossing grain below a texel, which one lobe cannot show: set "crossed".
std::vector<TestMaterial> make_crossed_set();
std::vector<TestMaterial> make_trained_set(const Jobs& jobs);    // two of every family that nets are trained on
std::vector<TestMaterial> make_validation_set(const Jobs& jobs); // for choices during development: trained families, other seeds

} // namespace burnish::mipnet
