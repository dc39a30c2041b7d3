// Golden images: renderings that somebody looked at and approved. tests/golden/NAME.txt holds the pixels' hash, which suffices for a
// passing test, and a check for every row and column. NAME.exr holds the image at 16 bits a channel, for people and for visible
// differences. tests/bless rewrites both.
#pragma once
#include <gtest/gtest.h>
#include <string>

#include "core/image/image.h"

namespace burnish::test {

struct GoldenPlace {
    std::string kept;   // the golden images
    std::string left;   // folder for a differing image, its golden image and their difference
    bool bless = false; // replaces golden images instead of comparing
};
GoldenPlace golden_place(); // tests/golden, <build>/golden, and the variable BN_BLESS

// Compares `picture` (float RGB, drawn by the renderer or instruction set `by`) with the golden image `name`, a path below the folder. A
// failure tells the number, place and size of differences, and where the images are saved.
testing::AssertionResult is_golden(const std::string& name, const Image& picture, const std::string& by,
                                   const GoldenPlace& place = golden_place());

// Returns the fault in a folder of golden images, or an empty string.
std::string fault_of_golden(const std::string& folder);

} // namespace burnish::test
