// Normals and lobes of a material's maps, texel by texel, on one grid: level 0 for mip filters.
#pragma once
#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "shading/bake/mip/grid.h"
#include "shading/surface/covariance.k.h"

namespace burnish {

struct MipPoint {
    real3 n;            // unit, z >= 0.0447: tangent space
    slope_covariance s; // of the lobe, in the normal's frame
};

struct MipMaps {                      // null: no such map; all maps have the same layout
    const Image* normal = nullptr;    // as in glTF
    const Image* roughness = nullptr; // green
    const Image* direction = nullptr; // KHR_materials_anisotropy
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false;
    float normal_scale = 1.0f; // factors of the material
    float roughness_factor = 1.0f, anisotropy_strength = 0.0f, anisotropy_rotation = 0.0f;
};

Grid grid_of(const MipMaps& maps);

// Level 0, as wide as the widest map and as high as the highest. Smaller maps are interpolated, across the border if they repeat. A normal
// that is not finite counts as upright, and roughness as 1 times the material's factor, so NaN does not spread.
class MipSource {
  public:
    explicit MipSource(const MipMaps& maps);
    int width() const { return grid_.width; }
    int height() const { return grid_.height; }
    const MipMaps& maps() const { return maps_; }
    void row(int y, MipPoint* to) const; // width() points
    // Writes a row as kPointPlanes planes, mip::row_stride(width()) apart, padded with 0: x, y, z of normals, then xx, yy, xy.
    void planes(int y, float* to) const;
    MipPoint at(int x, int y) const;
    // Writes the points (x[i], y[i]) as such planes, mip::row_stride(count) apart.
    void points(std::size_t count, const int* x, const int* y, float* to) const;
    std::uint64_t hash(const Jobs& jobs) const; // of size and every point
    // Returns this hash from row hashes, which hash_of_planes() makes from the planes that planes() writes.
    std::uint64_t hash_of_rows(const std::vector<std::uint64_t>& rows) const;
    std::uint64_t hash_of_planes(const float* planes) const;

  private:
    // read: (map, first channel, number of channels, substitutes for values that are not finite, stride, to)
    // read_tensors: (stride, to), 6 planes of tensors with powers 2 and 4 from the map of directions
    template <class Read, class ReadTensors>
    void put(std::size_t count, const Read& read, const ReadTensors& read_tensors, float* to) const;
    void put_tensors(int y, std::size_t stride, float* to) const; // of a grid row

    // The columns of a map beside each place of a grid row, in whole slots.
    struct Columns {
        int map_width;
        std::vector<std::int32_t> left, right;
        std::vector<float> share; // the right one's
    };
    void find_columns(const Image* map);
    void put_row(const Image& map, int y, int first, int count, const float* others, std::size_t stride, float* to) const;

    MipMaps maps_;
    Grid grid_;
    std::vector<Columns> columns_; // by width of those maps that have another size than the grid
    real2 rotation_;
    slope_covariance only_; // the lobe if only factors define it
};

} // namespace burnish
