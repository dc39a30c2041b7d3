// Image files made by hand, so that the reader is tested against the formats' definitions and not against our
// writer.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/image/image.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BN_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define BN_SANITIZED 1
#endif
#endif

namespace burnish::test {

using Bytes = std::vector<std::uint8_t>;

struct PngChunk {
    std::string type;
    std::string data;
};

// A PNG of stored (uncompressed) deflate blocks. `raw` holds the scanlines without filter bytes; `extra`
// chunks (PLTE, tRNS, gAMA, ...) come before the pixels.
Bytes make_png(int width, int height, int depth, int colour_type, const std::string& raw, const std::vector<PngChunk>& extra = {});

struct ExrChannel {
    std::string name; // in alphabetical order, as the format wants them
    int type = 2;     // 0 uint, 1 half, 2 float
    float value = 0;  // plus 1 a pixel to the right, plus 100 a row down (data window coordinates)
    int sampling = 1; // in the header only
};

struct ExrAttribute {
    std::string name, type, value;
};

struct ExrPart {
    std::vector<ExrChannel> channels;
    int data[4] = {0, 0, 0, 0};    // data window x0 y0 x1 y1, inclusive
    int display[4] = {0, 0, 0, 0}; // display window
    std::string type;              // "scanlineimage", "deepscanline"; needed for files of many parts
    std::vector<ExrAttribute> attributes = {};
};

std::string floats(const std::vector<float>& values); // as files store them

// Uncompressed scanlines; several parts make a multi-part file. A deep part gets a header but no pixels.
Bytes make_exr(const std::vector<ExrPart>& parts);

// A Radiance file of RGBE pixels, or runs of them, with this resolution line ("-Y 2 +X 3"); lines: further ones of the header.
Bytes make_hdr(const std::string& resolution, const Bytes& rgbe, const std::string& lines = "");

std::string temporary_folder(); // empty, new for every call, removed when the program ends
Bytes bytes_of(const std::string& path);
void put(const std::string& path, const Bytes& bytes);
std::vector<std::string> names_in(const std::string& folder); // hidden ones too, sorted

} // namespace burnish::test
