// Moving pictures as PNG (APNG, part of the third edition of the PNG specification): what browsers show, and what viewers that know nothing
// of it show the first picture of.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

class MovingPicture {
  public:
    // Each picture is shown for 1 / fps seconds, over and over.
    explicit MovingPicture(int fps) : fps_(fps) {}
    // 8 bits, all of the first one's size and channels. `path` names it in errors, which have ExitCode::output_failed.
    Status add(const std::string& path, const Image& picture);
    std::vector<std::uint8_t> bytes() const; // of the file; at least one picture was added

  private:
    int fps_, width_ = 0, height_ = 0, channels_ = 0;
    std::uint32_t sequence_ = 0;
    std::uint32_t pictures_ = 0;
    std::vector<std::uint8_t> head_, body_; // up to where the pictures' number is told; from there on, but for the last chunk
};

} // namespace burnish
