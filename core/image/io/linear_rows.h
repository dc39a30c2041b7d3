// Reads an image's colours as linear Rec.709, for every pixel type.
#pragma once
#include <vector>

#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

// Statistics of the luminance 0.2126 R + 0.7152 G + 0.0722 B over pixels where it is above 0. Both are 0 without such
// pixels.
struct LitLuminances {
    float median = 0.0f, largest = 0.0f; // median: element n / 2, counted from 0, in ascending order
};

class LinearRows {
  public:
    explicit LinearRows(const Image& image); // must outlive this object

    // Reads n pixels of row y from column x on. Columns outside repeat the first or last pixel.
    void read(int y, int x, int n, float* r, float* g, float* b) const;
    LitLuminances lit_luminances(const Jobs& jobs) const;

  private:
    struct Histogram;
    Histogram count_lit(const Jobs& jobs, int upper_half) const;
    template <class T> void read_as(int y, int x, int n, float* r, float* g, float* b) const;

    const Image& image_;
    std::vector<float> decode_; // linear value for each sRGB code; empty for floats
};

} // namespace burnish
