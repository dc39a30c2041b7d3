// Writes PNG: the header by libpng, the pixels by zlib, on several threads.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

class Jobs;

// Encodes 8-bit samples as PNG, marked as sRGB; 1 to 4 channels, alpha as stored. `path` names the file in errors,
// which have ExitCode::output_failed. jobs: null for the calling thread alone; the bytes are the same.
Result<std::vector<std::uint8_t>> png_bytes(const std::string& path, const Image& image, const Jobs* jobs = nullptr);

// Encodes such a file by rows. Each call returns the file's next bytes. The whole file's bytes do not depend on how rows are split.
class PngEncoder {
  public:
    explicit PngEncoder(const std::string& path);
    PngEncoder(PngEncoder&&) noexcept;
    ~PngEncoder();
    Result<std::vector<std::uint8_t>> begin(int width, int height, int channels);
    Result<std::vector<std::uint8_t>> rows(const Image& rows, const Jobs* jobs = nullptr);
    Result<std::vector<std::uint8_t>> end();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace burnish
