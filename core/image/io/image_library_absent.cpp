// Replaces image_library.cpp in a program without libraries.
#include "core/image/io/image_library.h"

namespace burnish {

Result<const ImageLibrary*> image_library(const std::string& file)
{
    return Error{ExitCode::unavailable, file, "", "this program was built without OpenImageIO"};
}

} // namespace burnish
