#include "raster/reference/ray_range.h"

#include <cmath>
#include <fmt/format.h>

namespace burnish {
namespace {

bool is_near(float coordinate) // false for a NaN
{
    return std::abs(coordinate) <= kFarthestRay;
}

Error too_far(const char* what, float coordinate)
{
    return Error{ExitCode::bad_input, "", "",
                 fmt::format("{} has the coordinate {:g}, and the reference follows rays up to {:g} only: scale the scene down", what,
                             coordinate, kFarthestRay)};
}

} // namespace

Status check_ray_range(const DrawTables& tables)
{
    for (const Column<float>* column : {&tables.px, &tables.py, &tables.pz})
        for (std::size_t i = 0; i < column->size(); ++i)
            if (const float coordinate = column->data()[i]; !is_near(coordinate))
                return too_far("a vertex", coordinate);
    constexpr float kShortest = 5e-7f; // metres across: rays of the reference miss what is smaller
    if (const float side = tables.longest_side(); side > 0.0f && side < kShortest)
        return Error{ExitCode::bad_input, "", "",
                     fmt::format("the scene is {:g} m across, and the reference needs {:g}: scale the scene up", side, kShortest)};
    return {};
}

Status check_ray_range(const View& view)
{
    for (int axis = 0; axis < 3; ++axis)
        if (!is_near(view.eye[axis]))
            return too_far("the camera", view.eye[axis]);
    for (const float half : {view.tan_half_x, view.tan_half_y})
        if (!is_near(half))
            return too_far("the edge of the picture", half);
    return {};
}

} // namespace burnish
