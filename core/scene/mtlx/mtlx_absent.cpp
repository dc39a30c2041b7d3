// Replaces mtlx.cpp in a program without libraries.
#include "core/scene/mtlx/mtlx.h"

namespace burnish {

Status apply_mtlx(Scene&, const std::string& path, const Limits&, const Jobs*)
{
    return Error{ExitCode::bad_input, path, "", "this program was built without pugixml, which reads MaterialX"};
}

} // namespace burnish
