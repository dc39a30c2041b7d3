// The colours of a picture as linear Rec.709, whatever it is stored as.
#pragma once
#include <vector>

#include "core/image/image.h"

namespace burnish {

class LinearRows {
  public:
    explicit LinearRows(const Image& image); // must outlive this

    // n pixels of row y from column x on, which may lie outside: the first and the last pixel repeat.
    void read(int y, int x, int n, float* r, float* g, float* b) const;
    // Of all pixels, row by row: 0.2126 R + 0.7152 G + 0.0722 B.
    std::vector<float> luminances() const;

  private:
    template <class T> void read_as(int y, int x, int n, float* r, float* g, float* b) const;

    const Image& image_;
    std::vector<float> decode_; // linear value of each sRGB code; empty for floats
};

} // namespace burnish
