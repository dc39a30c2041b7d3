// Tables of Ashikhmin-Shirley lobes as pictures, in place of those that frames make: `burnish bake half-vectors` and `brdf-lut` write them.
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
    // A table, or a folder's pictures that are one; a second one of a kind takes the first one's place.
    static Result<PhongFiles> read(const std::vector<std::string>& paths, const Limits& limits);
    // The same of a picture that is at hand; errors and warnings call it `name`.
    static Result<PhongFiles> of(const Image& picture, const std::string& name);

    bool has_half_vectors() const { return half_.width > 0; }
    bool has_albedo() const { return albedo_.width > 0; }
    std::vector<std::string> warnings(int samples) const; // what 8 bits and sizes cost; samples: that are taken of half vectors

    // Whether the tables are of a lobe with these exponents, along its wide axis and its narrow one, or of one that lies across. Errors:
    // bad_input.
    Status check(double nu, double nv) const;
    // Those of phong_half_vectors(), of the nearest texels below. Only with half vectors, for a lobe that passes check().
    std::vector<PhongHalfVector> half_vectors(double nu, double nv, int samples) const;
    // As bake_phong_slice() fills them. Only with an albedo table.
    void slice(double nu, double nv, int size, float* pairs) const;

  private:
    // How columns of an albedo table go through the eye's azimuth: AzimuthAxis of phong.h, and evenly from the axis of the larger exponent.
    enum class Columns { root, linear, linear_exchanged };

    Status add(const std::string& path, const Limits& limits);
    Status add(const Image& picture, const std::string& path);
    double half_off_by(double nu, double nv) const; // of the vectors, at most
    double albedo_off_by(double nu, double nv, Columns columns) const;
    Columns nearest_columns(double nu, double nv) const;
    PhongAlbedo albedo(Columns columns, double root_n_dot_v, double root_along) const;

    std::string half_path_, albedo_path_;
    Image half_, albedo_; // f32; x, y, z, density (0: none is held) and s, b, unused
    int half_codes_ = 0;  // of 8 bits: values along the first axis; else 0
    bool albedo_8_ = false;
};

} // namespace burnish
