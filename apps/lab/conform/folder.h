// A conformance folder: scenes, environment, references, and pages that draw the scenes in engines.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

struct FolderScene {
    std::string name, about, file; // file: within the folder
    bool environment = true, area_light = false;
};

// Names of the references' folder: the current name, and the name in older folders, which are still read.
inline constexpr const char* kReferenceFolders[] = {"reference", "truth"};

struct ConformFolder {
    std::string path;
    std::vector<FolderScene> scenes;
    std::string references = kReferenceFolders[0]; // one of kReferenceFolders
    std::string reference_of(const std::string& scene) const { return path + "/" + references + "/" + scene + ".exr"; }
    std::string variance_of(const std::string& scene) const { return path + "/" + references + "/" + scene + ".variance.exr"; }
};

// Returns the folder's parts, whether they are there or not.
ConformFolder conform_folder(const std::string& path);

// Reads conform.json. Errors: ExitCode::bad_input, also for a folder of another version.
Result<ConformFolder> read_conform_folder(const std::string& path);

// Writes scenes, environment and pages. Removes an old conform.json. Errors: ExitCode::usage for a folder of other files.
Status write_conform_files(const std::string& path);

// Writes conform.json, after everything else.
Status write_conform_list(const std::string& path);

} // namespace burnish
