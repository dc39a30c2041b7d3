// FLIP's filters for one viewing distance.
#pragma once
#include "core/base/column.h"
#include "core/image/metrics/flip_lanes.h"

namespace burnish {

class FlipKernels {
  public:
    explicit FlipKernels(double ppd);
    FlipKernels(const FlipKernels&) = delete; // `lanes` points into this object
    FlipKernels& operator=(const FlipKernels&) = delete;

    int radius() const { return radius_; } // radius of the widest filter
    const FlipFilters& lanes() const { return lanes_; }

  private:
    void make_spatial(double ppd);
    void make_features(double ppd);

    int radius_ = 0;
    Column<float> y_, cx_, cz_, cz2_, gauss_, edge_, point_;
    FlipFilters lanes_;
};

} // namespace burnish
