// Replaces png_write.cpp in a program without libraries.
#include "core/image/io/png_write.h"

namespace burnish {

Result<std::vector<std::uint8_t>> png_bytes(const std::string& path, const Image&)
{
    return Error{ExitCode::unavailable, path, "", "this program was built without libpng"};
}

} // namespace burnish
