// The lean shaders specialised by their constants, as unit/vulkan/prune_test.cpp has it of the product's.
#include <gtest/gtest.h>

#include "raster/vulkan/forward_shaders.h"
#include "raster/vulkan/lab/lean.h"
#include "raster/vulkan/shaders.h"
#include "tests/unit/vulkan/pruned.h"

namespace burnish::test {
namespace {

TEST(lean, is_valid_when_it_is_pruned)
{
    if (!validator_is_there())
        GTEST_SKIP() << "no spirv-val";
    check_pruned("lean", *shader_words("lean", "", lean_shaders()->files), {1, 2, 3, 4, 5});
}

} // namespace
} // namespace burnish::test
