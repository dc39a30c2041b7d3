// Animated PNG (APNG, part of the PNG specification's third edition). Browsers play the animation; viewers without APNG
// support show the first frame.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

class MovingPicture {
  public:
    // Shows each frame for 1 / fps seconds, and repeats forever.
    explicit MovingPicture(int fps) : fps_(fps) {}
    // Appends an 8-bit frame; all frames have the first one's size and channels. `path` names the file in errors, which
    // have ExitCode::output_failed.
    Status add(const std::string& path, const Image& picture);
    std::vector<std::uint8_t> bytes() const; // returns the whole file; needs at least one frame

  private:
    int fps_, width_ = 0, height_ = 0, channels_ = 0;
    std::uint32_t sequence_ = 0;
    std::uint32_t pictures_ = 0;
    std::vector<std::uint8_t> head_, body_; // the file up to the frame count; the rest without the last chunk
};

} // namespace burnish
