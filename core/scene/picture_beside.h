// Pictures that a scene's file or a material's file names.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/limits.h"

namespace burnish {

// Returns the path, without links, of the file that a name means: relative to the folder, or the file with the same name in the folder.
// Backslashes count as slashes. Nothing where there is no such file. Files outside of the folder need Limits::uris_outside.
std::optional<std::string> picture_beside(const std::filesystem::path& folder, std::string name, const Limits& limits);

} // namespace burnish
