// Tables for Ashikhmin-Shirley lobes from pictures, written by `burnish bake half-vectors` and `brdf-lut`. They replace tables that frames
// make.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "shading/bake/tables/phong.h"

namespace burnish {

class PhongFiles {
  public:
    // Reads tables, or all pictures in a folder. A later table replaces an earlier one of its kind.
    static Result<PhongFiles> read(const std::vector<std::string>& paths, const Limits& limits);
    // Takes a picture from memory. `name` appears in errors and warnings.
    static Result<PhongFiles> of(const Image& picture, const std::string& name);

    bool has_half_vectors() const { return half_.width > 0; }
    bool has_albedo() const { return albedo_.width > 0; }
    std::vector<std::string> warnings(int samples) const; // losses through 8 bits and sizes; samples: number taken from half vectors

    // Checks that the tables fit a lobe with these exponents, along its wide and its narrow axis or the other way around. Errors:
    // bad_input.
    Status check(double nu, double nv) const;
    // Returns the vectors of phong_half_vectors() from the nearest texels below. Needs half vectors, and a lobe that passes check().
    std::vector<PhongHalfVector> half_vectors(double nu, double nv, int samples) const;
    // Fills a slice as bake_phong_slice() does. Needs an albedo table.
    void slice(double nu, double nv, int size, float* pairs) const;

  private:
    // Spacing of an albedo table's columns over the eye's azimuth: AzimuthAxis in phong.h, and even from the axis with the larger
    // exponent.
    enum class Columns { root, linear, linear_exchanged };

    Status add(const std::string& path, const Limits& limits);
    Status add(const Image& picture, const std::string& path);
    double half_off_by(double nu, double nv) const; // largest error in the vectors
    double albedo_off_by(double nu, double nv, Columns columns) const;
    Columns nearest_columns(double nu, double nv) const;
    PhongAlbedo albedo(Columns columns, double root_n_dot_v, double root_along) const;

    std::string half_path_, albedo_path_;
    Image half_, albedo_; // f32; x, y, z, density (0: no density) and s, b, unused
    int half_codes_ = 0;  // 8 bits: number of values along the first axis; else 0
    bool albedo_8_ = false;
};

} // namespace burnish
