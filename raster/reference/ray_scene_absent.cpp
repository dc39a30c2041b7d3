// Replaces ray_scene.cpp in a build without Embree.
#include "raster/reference/ray_scene.h"

namespace burnish {

bool ray_scene_available()
{
    return false;
}

Result<std::unique_ptr<RayScene>> make_ray_scene(const Scene&, const DrawTables&, const Jobs&)
{
    return Error{ExitCode::unavailable, "", "", "this program was built without Embree 3", "SessionOptions::backend reference"};
}

} // namespace burnish
