// Replaces embree_scene.cpp in a build without Embree.
#include "raster/reference/embree_scene.h"

namespace burnish {

bool embree_available()
{
    return false;
}

Result<std::unique_ptr<RayScene>> make_embree_scene(const Scene&, const DrawTables&, const Jobs&)
{
    return Error{ExitCode::unavailable, "", "", "this program was built without Embree 3", "SessionOptions::backend reference"};
}

} // namespace burnish
