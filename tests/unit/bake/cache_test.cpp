#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <unistd.h>

#include "shading/bake/environment/environment_cache.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

class environment_cache : public testing::Test {
  protected:
    environment_cache() : folder_(fs::path(testing::TempDir()) / ("bake_cache_" + std::to_string(getpid())))
    {
        fs::remove_all(folder_);
        options_ = small_bake();
        options_.use_cache = true;
        options_.cache_dir = (folder_ / "deep" / "er").string();
    }
    ~environment_cache() override { fs::remove_all(folder_); }

    Environment bake()
    {
        Result<Environment> e = bake_environment(image_, "test", options_, Jobs(2));
        EXPECT_TRUE(e);
        return std::move(*e);
    }
    std::vector<fs::path> files() const
    {
        std::vector<fs::path> found;
        if (fs::exists(options_.cache_dir))
            for (const fs::directory_entry& f : fs::directory_iterator(options_.cache_dir))
                if (f.path().filename() != "locks")
                    found.push_back(f.path());
        return found;
    }
    static void expect_same(const Environment& a, const Environment& b)
    {
        for (const auto& [x, y] :
             {std::pair{&a.specular, &b.specular}, std::pair{&a.irradiance, &b.irradiance}, std::pair{&a.whole, &b.whole}}) {
            EXPECT_TRUE(std::equal(x->texels.begin(), x->texels.end(), y->texels.begin(), y->texels.end()));
            EXPECT_EQ(x->offset, y->offset);
            EXPECT_EQ(x->size, y->size);
            EXPECT_EQ(x->levels, y->levels);
            EXPECT_EQ(x->scale, y->scale);
        }
        EXPECT_EQ(a.energy_source, b.energy_source);
        EXPECT_EQ(a.energy_cube, b.energy_cube);
        EXPECT_EQ(a.peak_source, b.peak_source);
        EXPECT_EQ(a.content_hash, b.content_hash);
        ASSERT_EQ(a.extracted_lights.size(), b.extracted_lights.size());
        EXPECT_EQ(std::memcmp(a.extracted_lights.data(), b.extracted_lights.data(), a.extracted_lights.size() * sizeof(ExtractedLight)), 0);
    }

    fs::path folder_;
    EnvironmentOptions options_;
    Image image_ = smooth_equirect(64);
};

std::string read_all(const fs::path& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
void write_all(const fs::path& path, const std::string& bytes)
{
    std::ofstream(path, std::ios::binary) << bytes;
}

TEST_F(environment_cache, a_hit_equals_the_bake_bit_for_bit)
{
    const Environment baked = bake();
    EXPECT_FALSE(baked.from_cache);
    ASSERT_EQ(files().size(), 1u);
    const Environment hit = bake();
    EXPECT_TRUE(hit.from_cache);
    EXPECT_EQ(hit.name, "test");
    expect_same(hit, baked);
}

TEST_F(environment_cache, every_option_of_the_bake_and_every_pixel_has_its_own_entry)
{
    bake();
    options_.samples = 64;
    EXPECT_FALSE(bake().from_cache);
    options_.levels = 3;
    EXPECT_FALSE(bake().from_cache);
    options_.cube_size = 16;
    EXPECT_FALSE(bake().from_cache);
    image_.f32()[100] += 0.001f;
    EXPECT_FALSE(bake().from_cache);
    EXPECT_EQ(files().size(), 5u);
    EXPECT_TRUE(bake().from_cache);
}

TEST_F(environment_cache, one_entry_is_drawn_turned_and_exposed_in_any_way)
{
    const Environment plain = bake();
    options_.rotation_deg = 10.0f, options_.exposure_ev = 1.5f;
    const Environment read = bake();
    EXPECT_TRUE(read.from_cache);
    EXPECT_EQ(files().size(), 1u);
    options_.use_cache = false;
    expect_same(bake(), read);
    EXPECT_NEAR(read.specular.scale / plain.specular.scale, 2.8284271f, 1e-6f);
    EXPECT_NEAR(read.irradiance.scale / plain.irradiance.scale, 2.8284271f, 1e-6f);
}

TEST_F(environment_cache, keeps_extracted_lights)
{
    image_ = smooth_equirect(256);
    float* sun = image_.f32() + 3 * (256 * 40 + 80);
    sun[0] = sun[1] = 5000.0f, sun[2] = 4000.0f;
    const Environment baked = bake();
    ASSERT_EQ(baked.extracted_lights.size(), 1u);
    const Environment read = bake();
    EXPECT_TRUE(read.from_cache);
    expect_same(read, baked);
    options_.extracted_lights = 0;
    const Environment off = bake();
    EXPECT_FALSE(off.from_cache);
    EXPECT_TRUE(off.extracted_lights.empty());
    options_.extracted_lights = 8;
    for (const fs::path& file : files()) // cut at the start of the whole environment, or too long by it
        write_all(file, read_all(file).substr(0, read_all(files().at(0)).size() / 2));
    expect_same(bake(), baked);
}

TEST_F(environment_cache, damaged_files_are_baked_anew)
{
    const Environment baked = bake();
    const fs::path file = files().at(0);
    const std::string good = read_all(file);
    std::vector<std::string> damaged = {
        "", "x", good.substr(0, 40), good.substr(0, good.size() - 1), good + "x", std::string(good.size(), '\0')};
    for (const std::size_t at :
         {std::size_t{0}, std::size_t{9}, std::size_t{13}, std::size_t{25}, std::size_t{70}, std::size_t{500}, good.size() - 1}) {
        damaged.push_back(good);
        damaged.back()[at] = static_cast<char>(damaged.back()[at] ^ 0x10);
    }
    for (std::size_t i = 0; i < damaged.size(); ++i) {
        write_all(file, damaged[i]);
        const Environment e = bake();
        EXPECT_FALSE(e.from_cache) << "damage " << i;
        EXPECT_TRUE(e.warnings.empty());
        expect_same(e, baked);
        EXPECT_EQ(read_all(file), good) << "damage " << i;
    }
    EXPECT_TRUE(bake().from_cache);
}

// The hashes are correct, so the ranges alone reject the numbers.
TEST_F(environment_cache, refuses_numbers_out_of_range)
{
    image_ = smooth_equirect(256);
    float* sun = image_.f32() + 3 * (256 * 40 + 80);
    sun[0] = sun[1] = 5000.0f, sun[2] = 4000.0f;
    const Environment good = bake();
    ASSERT_EQ(good.extracted_lights.size(), 1u);
    const auto is_read = [&](const Environment& e) {
        const std::vector<std::uint8_t> bytes = environment_cache_bytes(e);
        return parse_environment_cache(bytes.data(), bytes.size(), e.content_hash, e.specular.size, e.specular.levels).has_value();
    };
    EXPECT_TRUE(is_read(good));
    for (CubeMap Environment::*cube : {&Environment::specular, &Environment::irradiance, &Environment::whole}) {
        for (const int half : {0x7c00, 0x7e00, 0x8001, 0xbc00, 0xfc00}) // infinite, NaN, the least negative, -1, -infinite
            for (std::size_t channel = 0; channel < 4; ++channel) {
                Environment bad = good;
                (bad.*cube).texels[4 + channel] = static_cast<std::uint16_t>(half);
                EXPECT_FALSE(is_read(bad)) << half << ", channel " << channel;
            }
        Environment light = good;
        (light.*cube).texels[5] = 0x8000, (light.*cube).texels[6] = 0x7bff; // -0, and the largest
        EXPECT_TRUE(is_read(light));
        for (const float scale : {-1.0f, 1e35f, std::numeric_limits<float>::quiet_NaN()}) {
            Environment bad = good;
            (bad.*cube).scale = scale;
            EXPECT_FALSE(is_read(bad)) << scale;
        }
    }
    for (float ExtractedLight::*number : {&ExtractedLight::angular_radius, &ExtractedLight::share})
        for (const float value : {-0.1f, 5.0f, std::numeric_limits<float>::quiet_NaN()}) {
            Environment bad = good;
            bad.extracted_lights[0].*number = value;
            EXPECT_FALSE(is_read(bad)) << value;
        }
    for (float(ExtractedLight::*numbers)[3] :
         {&ExtractedLight::direction, &ExtractedLight::axis_u, &ExtractedLight::axis_v, &ExtractedLight::irradiance}) {
        Environment bad = good;
        (bad.extracted_lights[0].*numbers)[1] = numbers == &ExtractedLight::irradiance ? -1.0f : 1e20f;
        EXPECT_FALSE(is_read(bad));
    }
}

// Above the limit the least recently used environment is removed, not the oldest.
TEST_F(environment_cache, has_a_limit)
{
    const int least = options_.samples;
    bake();
    const std::uintmax_t size = fs::file_size(files().at(0));
    setenv("BURNISH_CACHE_BYTES", std::to_string(2 * size).c_str(), 1);
    const auto with_samples = [&](int samples) {
        options_.samples = samples;
        const bool hit = bake().from_cache;
        for (const fs::path& file : files()) // half a minute passes
            fs::last_write_time(file, fs::last_write_time(file) - std::chrono::seconds(30));
        return hit;
    };
    EXPECT_TRUE(with_samples(least));
    EXPECT_FALSE(with_samples(least + 1));
    EXPECT_TRUE(with_samples(least));
    EXPECT_FALSE(with_samples(least + 2)); // the second one is removed
    EXPECT_EQ(files().size(), 2u);
    EXPECT_TRUE(with_samples(least));
    EXPECT_FALSE(with_samples(least + 1));
    unsetenv("BURNISH_CACHE_BYTES");
}

TEST_F(environment_cache, a_folder_that_cannot_be_made_costs_only_a_warning)
{
    fs::create_directories(folder_);
    write_all(folder_ / "deep", "a file where the folder should be");
    const Environment e = bake();
    EXPECT_FALSE(e.from_cache);
    ASSERT_EQ(e.warnings.size(), 1u);
    EXPECT_NE(e.warnings[0].find("not cached"), std::string::npos);
}

TEST_F(environment_cache, is_not_touched_without_use_cache)
{
    options_.use_cache = false;
    bake();
    EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(environment_cache, lives_in_the_xdg_folder_by_default)
{
    const std::string before = std::getenv("XDG_CACHE_HOME") ? std::getenv("XDG_CACHE_HOME") : "";
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    options_.cache_dir.clear();
    bake();
    EXPECT_TRUE(fs::exists(folder_ / "burnish"));
    EXPECT_TRUE(bake().from_cache);
    before.empty() ? unsetenv("XDG_CACHE_HOME") : setenv("XDG_CACHE_HOME", before.c_str(), 1);
}

} // namespace
} // namespace burnish
