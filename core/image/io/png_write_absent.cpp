// Replaces png_write.cpp in a program without libraries.
#include "core/image/io/png_write.h"

namespace burnish {

Result<std::vector<std::uint8_t>> png_bytes(const std::string& path, const Image&, const Jobs*)
{
    return Error{ExitCode::unavailable, path, "", "this program was built without libpng"};
}

struct PngEncoder::State {
    std::string path;
};
PngEncoder::PngEncoder(const std::string& path) : state_(new State{path}) {}
PngEncoder::PngEncoder(PngEncoder&&) noexcept = default;
PngEncoder::~PngEncoder() = default;
Result<std::vector<std::uint8_t>> PngEncoder::begin(int, int, int)
{
    return png_bytes(state_->path, {});
}
Result<std::vector<std::uint8_t>> PngEncoder::rows(const Image&, const Jobs*)
{
    return png_bytes(state_->path, {});
}
Result<std::vector<std::uint8_t>> PngEncoder::end()
{
    return png_bytes(state_->path, {});
}

} // namespace burnish
