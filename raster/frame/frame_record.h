// Turns a FrameDesc into the data that shading reads: the record, its tables, and data baked when a frame first needs it.
#pragma once
#include <map>
#include <tuple>
#include <vector>

#include "raster/frame/behind.h"
#include "raster/frame/frame.h"
#include "raster/frame/upload.h"
#include "shading/bake/environment/cube_map.h"
#include "shading/lang/tables.h"

namespace burnish {

ViewRecord view_record(const View& view);
CubeRecord cube_record(const CubeMap& cube); // a cube without texels has no levels

// Writes the parameters in shading/models.def and the lobe that they choose. tilted: see tilts().
void put_parameters(const FrameDesc& desc, bool tilted, FrameRecord& to);

// Fills a record, except for data baked on a technique's first request: box cube, sample grid, lobe albedo table.
FrameRecord frame_record(const RenderInput& input, const FrameDesc& desc);

class FrameMaker {
  public:
    explicit FrameMaker(const RenderInput& input); // the references must outlive the maker

    // Runs check_frame(), and checks that tables from files fit the frame's lobes.
    Status check(const FrameDesc& desc) const;
    // Makes the frame. check() must have accepted desc. The frame's pointers stay valid until the next call.
    ShadingFrame make(const FrameDesc& desc);

    // Returns true if the frame's bodies show opaque surfaces behind them. Then draw behind_frame(desc) first, and pass it to
    // take_behind().
    bool shows_behind(const FrameDesc& desc) const;
    void take_behind(const Frame& frame);
    void leave_behind() { behind_ = {}; } // frames then show none
    const BehindPicture& behind() const { return behind_; }

    const SceneTables& scene() const { return scene_; }
    const std::vector<MaterialRecord>& materials() const { return materials_; } // of the last frame
    const std::vector<GridSample>& grid() const { return grid_; }
    const CubeMap& mip_env() const { return mip_env_; }
    const std::vector<std::uint16_t>& ltc_texels() const;             // empty if the scene has no area lights
    const Column<float>& lobe_slices() const { return lobe_slices_; } // for all frames so far

  private:
    void bake(const FrameDesc& desc);
    void put_behind(const FrameDesc& desc, ShadingFrame& f);
    void choose_techniques(const FrameDesc& desc);
    int slice_of(float sigma_u, float sigma_v, bool phong);
    int set_of(float sigma_u, float sigma_v, int samples);
    void slice_albedo(const FrameDesc& desc);

    RenderInput input_;
    SceneTables scene_;
    std::vector<MaterialRecord> materials_;
    BehindPicture behind_;
    std::vector<TextureParams> textures_;              // the scene's, then behind_'s
    CubeMap mip_env_;                                  // made when a technique first needs it
    using SlicedLobe = std::tuple<float, float, bool>; // standard deviations of slope; true for an Ashikhmin-Shirley lobe
    std::map<SlicedLobe, int> sliced_;                 // each lobe's first pair in lobe_slices_
    Column<float> lobe_slices_;
    Column<float> screen_x_, screen_y_;
    std::vector<GridSample> grid_;              // followed by the lobes' sets of half vectors
    int grid_count_ = 0;                        // samples per fragment
    std::vector<std::pair<float, float>> sets_; // standard deviations of slope for the lobes whose half vectors follow in grid_
};

} // namespace burnish
