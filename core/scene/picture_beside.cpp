#include "core/scene/picture_beside.h"

#include <algorithm>

namespace burnish {

namespace fs = std::filesystem;

std::optional<std::string> picture_beside(const fs::path& folder, std::string name, const Limits& limits)
{
    std::replace(name.begin(), name.end(), '\\', '/'); // as Windows writes it
    std::error_code failed;
    const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, failed);
    for (const fs::path& path : {fs::path(name), fs::path(name).filename()}) {
        const fs::path whole = path.is_absolute() ? path : folder / path;
        const fs::path file = fs::canonical(whole, failed);
        if (failed || !fs::is_regular_file(file, failed))
            continue;
        if (limits.uris_outside || std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end())
            return file.string();
    }
    return std::nullopt;
}

} // namespace burnish
