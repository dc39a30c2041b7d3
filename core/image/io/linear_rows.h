// The colours of a picture as linear Rec.709, whatever it is stored as.
#pragma once
#include <vector>

#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct LitLuminances {                   // 0.2126 R + 0.7152 G + 0.0722 B of the pixels where that is above 0; without any, both are 0
    float median = 0.0f, largest = 0.0f; // median: of n in ascending order, number n / 2 counted from 0
};

class LinearRows {
  public:
    explicit LinearRows(const Image& image); // must outlive this

    // n pixels of row y from column x on, which may lie outside: the first and the last pixel repeat.
    void read(int y, int x, int n, float* r, float* g, float* b) const;
    LitLuminances lit_luminances(const Jobs& jobs) const;

  private:
    struct Histogram;
    Histogram count_lit(const Jobs& jobs, int upper_half) const;
    template <class T> void read_as(int y, int x, int n, float* r, float* g, float* b) const;

    const Image& image_;
    std::vector<float> decode_; // linear value of each sRGB code; empty for floats
};

} // namespace burnish
