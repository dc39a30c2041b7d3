// The files of a scene and its environment, as a page carries them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"

namespace burnish {

struct PageFile {
    std::string name; // within the page: relative to its root
    std::vector<std::uint8_t> bytes;
};

struct PageFiles {
    std::vector<PageFile> files;
    std::string scene, environment; // names of files, or builtin:NAME; environment "": the scene's own light
};

// Reads the files of a scene and its environment. `read`: their paths. Errors: ExitCode::bad_input, also for a form that pages do not read.
Result<PageFiles> page_files(const std::string& scene, const std::string& environment, const std::vector<std::string>& read,
                             const Limits& limits);

} // namespace burnish
