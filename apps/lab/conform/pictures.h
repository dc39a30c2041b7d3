// Reads an engine's pictures of the scenes in a conformance folder, and the references.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "apps/lab/conform/folder.h"
#include "apps/lab/conform/judge.h"
#include "core/base/limits.h"

namespace burnish {

inline constexpr const char* kPictureExtensions[] = {".exr", ".hdr", ".pfm", ".png"}; // of an engine's pictures

struct ConformPictures {
    std::vector<Image> references;     // f32 RGB, by scene
    std::vector<EnginePicture> engine; // by scene
};

// Looks for NAME.exr, .hdr, .pfm and .png in this order. Errors: errors of references, and a folder without one picture. A picture that
// cannot be read or compared has a fault.
Result<ConformPictures> read_conform_pictures(const ConformFolder& folder, const std::string& pictures, const Limits& limits,
                                              Report& report);

} // namespace burnish
