// The one place where a FrameDesc becomes what shading reads of it: the record, its tables, and what is baked when a frame first asks.
#pragma once
#include <map>
#include <tuple>
#include <vector>

#include "raster/frame/frame.h"
#include "raster/frame/upload.h"
#include "shading/bake/environment/cube_map.h"
#include "shading/lang/tables.h"

namespace burnish {

ViewRecord view_record(const View& view);
CubeRecord cube_record(const CubeMap& cube); // without texels: no levels

// Those of shading/models.def, and the lobe that they choose. tilted: see tilts().
void put_parameters(const FrameDesc& desc, bool tilted, FrameRecord& to);

// All of the record but what a frame's technique is the first to ask for: box cube, grid and table of lobes' albedo.
FrameRecord frame_record(const RenderInput& input, const FrameDesc& desc);

class FrameMaker {
  public:
    explicit FrameMaker(const RenderInput& input); // its references must outlive the maker

    // check_frame(), and whether tables from files are of the lobes that would take them.
    Status check(const FrameDesc& desc) const;
    // desc: one that check() lets pass. What the frame points at stays until the next call.
    ShadingFrame make(const FrameDesc& desc);

    const SceneTables& scene() const { return scene_; }
    const std::vector<MaterialRecord>& materials() const { return materials_; } // of the frame made last
    const std::vector<GridSample>& grid() const { return grid_; }
    const CubeMap& box_cube() const { return box_cube_; }
    const std::vector<std::uint16_t>& ltc_texels() const;             // empty where the scene has no area lights
    const Column<float>& lobe_slices() const { return lobe_slices_; } // of all frames so far

  private:
    void bake(const FrameDesc& desc);
    void choose_techniques(const FrameDesc& desc);
    int slice_of(float sigma_u, float sigma_v, bool phong);
    int set_of(float sigma_u, float sigma_v, int samples);
    void slice_albedo(const FrameDesc& desc);

    RenderInput input_;
    SceneTables scene_;
    std::vector<MaterialRecord> materials_;
    CubeMap box_cube_;                                 // made when a technique first asks for it
    using SlicedLobe = std::tuple<float, float, bool>; // deviations of slope; whether it is an Ashikhmin-Shirley lobe
    std::map<SlicedLobe, int> sliced_;                 // the first pair of each in lobe_slices_
    Column<float> lobe_slices_;
    Column<float> screen_x_, screen_y_;
    std::vector<GridSample> grid_;              // and lobes' sets of half vectors
    int grid_count_ = 0;                        // samples of a fragment
    std::vector<std::pair<float, float>> sets_; // deviations of slope of the lobes whose half vectors follow in the grid
};

} // namespace burnish
