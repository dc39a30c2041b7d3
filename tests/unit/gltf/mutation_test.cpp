// Random damage: for any bytes the reader returns a valid scene or a clear error.
#include <algorithm>
#include <gtest/gtest.h>

#include "asset.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;

namespace {

class Random { // Numerical Recipes' linear congruential generator, high bits
  public:
    explicit Random(std::uint32_t seed) : state_(seed) {}
    std::uint32_t below(std::uint32_t n)
    {
        state_ = state_ * 1664525u + 1013904223u;
        return static_cast<std::uint32_t>((static_cast<std::uint64_t>(state_) * n) >> 32);
    }

  private:
    std::uint32_t state_;
};

void mutate(ByteVector& bytes, Random& random, std::size_t begin, std::size_t end)
{
    const std::uint32_t changes = 1 + random.below(4);
    for (std::uint32_t i = 0; i < changes; ++i) {
        std::uint8_t& b = bytes[begin + random.below(static_cast<std::uint32_t>(end - begin))];
        if (random.below(2))
            b = static_cast<std::uint8_t>(b ^ (1u << random.below(8)));
        else
            b = static_cast<std::uint8_t>(random.below(256));
    }
}

// Changes digits of the JSON text alone: the text stays well formed and its numbers become wrong.
void mutate_digits(ByteVector& bytes, Random& random, std::size_t begin, std::size_t end)
{
    std::vector<std::size_t> digits;
    for (std::size_t i = begin; i < end; ++i)
        if (bytes[i] >= '0' && bytes[i] <= '9')
            digits.push_back(i);
    const std::uint32_t changes = 1 + random.below(3);
    for (std::uint32_t i = 0; i < changes && !digits.empty(); ++i)
        bytes[digits[random.below(static_cast<std::uint32_t>(digits.size()))]] = static_cast<std::uint8_t>('0' + random.below(10));
}

struct Outcome {
    int loaded = 0, refused = 0;
};

Outcome damage(const ByteVector& good, int rounds, std::uint32_t seed)
{
    Random random(seed);
    Outcome outcome;
    const std::size_t json_end = 20 + (good[12] | static_cast<std::size_t>(good[13]) << 8 | static_cast<std::size_t>(good[14]) << 16);
    for (int i = 0; i < rounds && !testing::Test::HasFailure(); ++i) {
        ByteVector bytes = good;
        switch (random.below(4)) {
        case 0:
            mutate(bytes, random, 0, bytes.size());
            break;
        case 1:
            mutate(bytes, random, 20, json_end);
            break;
        case 2:
            mutate(bytes, random, std::min(json_end, bytes.size() - 1), bytes.size());
            break;
        default:
            mutate_digits(bytes, random, 20, json_end);
            break;
        }
        const Result<Scene> scene = load_gltf_bytes(bytes.data(), bytes.size(), "damaged.glb", {});
        if (scene) {
            expect_sound(*scene);
            ++outcome.loaded;
        } else {
            EXPECT_FALSE(scene.error().reason.empty());
            EXPECT_EQ(scene.error().line().find_first_of("\r\n"), std::string::npos);
            ++outcome.refused;
        }
    }
    return outcome;
}

Asset rich_asset()
{
    Asset asset;
    const int where = asset.view(bytes_of<std::uint16_t>({1, 3})), what = asset.view(floats({1, 0, 0, 1, 1, 0}));
    asset.attribute("POSITION", asset.accessor(floats({0, 0, 0, 9, 9, 9, 0, 1, 0, 9, 9, 9}), kF32, "VEC3", 4,
                                               R"(,"sparse":{"count":2,"indices":{"bufferView":)" + std::to_string(where) +
                                                   R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(what) + "}}"));
    asset.attribute("NORMAL", asset.accessor(bytes_of<std::int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 9, 127, 0, 0, 0, 127, 0}), kI8, "VEC3",
                                             4, R"(,"normalized":true)", R"(,"byteStride":4)"));
    asset.attribute("TEXCOORD_0", asset.accessor(bytes_of<std::uint16_t>({0, 0, 65535, 0, 0, 65535, 65535, 65535}), kU16, "VEC2", 4,
                                                 R"(,"normalized":true)"));
    asset.attribute("COLOR_0", asset.accessor(bytes_of<std::uint8_t>({255, 0, 0, 255, 0, 255, 0, 255, 1, 2, 3, 4, 5, 6, 7, 8}), kU8, "VEC4",
                                              4, R"(,"normalized":true)"));
    const int indices = asset.accessor(bytes_of<std::uint8_t>({0, 1, 2, 3}), kU8, "SCALAR", 4);
    asset.primitive = R"(,"material":0,"mode":5,"indices":)" + std::to_string(indices);
    asset.nodes = R"(,"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1,2],"scale":[1,-1,1]},{"mesh":0,"rotation":[0,0,1,0]},)"
                  R"({"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}}])";
    asset.more = R"(,"materials":[{"pbrMetallicRoughness":{"roughnessFactor":0.5},"extensions":{"KHR_materials_anisotropy":)"
                 R"({"anisotropyStrength":0.5}}}],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],)"
                 R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{"outerConeAngle":0.5}}]}})";
    return asset;
}

} // namespace

TEST(mutation, a_damaged_small_file_gives_a_sound_scene_or_an_error)
{
    const ByteVector good = rich_asset().glb();
    const Result<Scene> scene = load_gltf_bytes(good.data(), good.size(), "good.glb", {});
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    const Outcome outcome = damage(good, 4000, 1);
    EXPECT_GT(outcome.loaded, 400); // light damage: many files pass the JSON parser
    EXPECT_GT(outcome.refused, 400);
}

TEST(mutation, damaged_models_give_a_sound_scene_or_an_error)
{
    const std::pair<const char*, int> models[] = {
        {"models/Lights.glb", 400}, {"models/pmndrs_suzi_draco.glb", 150}, {"models/AnisotropyStrengthTest_meshopt.glb", 30}};
    for (const auto& [name, rounds] : models) {
        SCOPED_TRACE(name);
        const Outcome outcome = damage(read_bytes(data_file(name)), rounds, 7);
        EXPECT_EQ(outcome.loaded + outcome.refused, rounds);
    }
}
