// A conformance folder: scenes, environment, truths, and pages that draw the scenes in engines.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct FolderScene {
    std::string name, about, file; // file: within the folder
    bool environment = true, area_light = false;
};

struct ConformFolder {
    std::string path;
    std::vector<FolderScene> scenes;
    std::string truth_of(const std::string& scene) const { return path + "/truth/" + scene + ".exr"; }
    std::string variance_of(const std::string& scene) const { return path + "/truth/" + scene + ".variance.exr"; }
};

// Reads conform.json. Errors: ExitCode::bad_input, also for a folder of another version.
Result<ConformFolder> read_conform_folder(const std::string& path);

// Writes everything but the truths.
Status write_conform_files(const std::string& path);

} // namespace burnish
