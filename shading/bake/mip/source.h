// What a material's maps say of its normals and lobes, texel by texel, on one grid: level 0 of what mip filters make levels of.
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

struct MipMaps {                      // null where there is none; all of one place: the same coordinates see the same point in each
    const Image* normal = nullptr;    // as glTF has it
    const Image* roughness = nullptr; // green
    const Image* direction = nullptr; // KHR_materials_anisotropy
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false;
    float normal_scale = 1.0f; // factors of the material
    float roughness_factor = 1.0f, anisotropy_strength = 0.0f, anisotropy_rotation = 0.0f;
};

Grid grid_of(const MipMaps& maps);

// As wide as the widest map and as high as the highest; smaller ones are interpolated, across the border where they repeat. What is not
// finite is level, and as smooth as the material's factors without a map: NaN does not spread.
class MipSource {
  public:
    explicit MipSource(const MipMaps& maps);
    int width() const { return grid_.width; }
    int height() const { return grid_.height; }
    const MipMaps& maps() const { return maps_; }
    void row(int y, MipPoint* to) const; // width() points
    // The same as kPointPlanes planes, mip::row_stride(width()) apart, 0 where they are longer: x, y, z of normals, xx, yy, xy.
    void planes(int y, float* to) const;
    MipPoint at(int x, int y) const;
    // The same of any points, planes mip::row_stride(count) apart.
    void points(std::size_t count, const int* x, const int* y, float* to) const;
    std::uint64_t hash(const Jobs& jobs) const; // of size and every point
    // The same of the rows' hashes, of a row as planes() writes it.
    std::uint64_t hash_of_rows(const std::vector<std::uint64_t>& rows) const;
    std::uint64_t hash_of_planes(const float* planes) const;

  private:
    // read: (map, its channels from the first on, how many, what stands for what is not finite, stride, to)
    template <class Read> void put(std::size_t count, const Read& read, float* to) const;

    MipMaps maps_;
    Grid grid_;
    Image tensors_[2];
    real2 rotation_;
    slope_covariance only_; // where nothing but factors makes the lobe
};

} // namespace burnish
