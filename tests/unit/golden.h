// Golden pictures: what a renderer drew when somebody looked at it and agreed. tests/golden/NAME.txt holds the hash of its pixels, which is
// all that a passing test reads, and a check of every row and column; NAME.exr the picture to 16 bits a channel, for people and for
// differences that can be seen. tests/bless rewrites both.
#pragma once
#include <gtest/gtest.h>
#include <string>

#include "core/image/image.h"

namespace burnish::test {

struct GoldenPlace {
    std::string kept;   // the golden pictures
    std::string left;   // where a picture that differs is left, beside the golden one and their difference
    bool bless = false; // pictures become golden instead of being compared
};
GoldenPlace golden_place(); // tests/golden, <build>/golden, the variable BN_BLESS

// Whether `picture` (float RGB, drawn by the renderer or instruction set `by`) is the golden picture `name`, which is a path below the
// folder. If it is not: how many pixels differ, where, by how much, and where the pictures lie that show it.
testing::AssertionResult is_golden(const std::string& name, const Image& picture, const std::string& by,
                                   const GoldenPlace& place = golden_place());

// What is wrong with the files of a folder of golden pictures; empty where nothing is.
std::string fault_of_golden(const std::string& folder);

} // namespace burnish::test
