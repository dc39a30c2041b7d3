// Image files made by hand, which test the reader against the formats' definitions and not against our writer.
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

// Returns a zlib stream of one stored block.
std::string store(const std::string& raw);

struct PngChunk {
    std::string type;
    std::string data;
};

// Returns a PNG of stored (uncompressed) deflate blocks. `raw` holds the scanlines without filter bytes. `extra` chunks (PLTE, tRNS, gAMA,
// ...) come before the pixels.
Bytes make_png(int width, int height, int depth, int colour_type, const std::string& raw, const std::vector<PngChunk>& extra = {});

struct ExrChannel {
    std::string name; // in alphabetical order, as the format requires
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
    std::string type;              // "scanlineimage", "deepscanline"; required in multi-part files
    std::vector<ExrAttribute> attributes = {};
};

std::string floats(const std::vector<float>& values); // in the files' byte order

// Uncompressed scanlines; several parts make a multi-part file. A deep part gets a header but no pixels.
Bytes make_exr(const std::vector<ExrPart>& parts);

// Returns a Radiance file of RGBE pixels, or runs, with this resolution line ("-Y 2 +X 3"). lines: further header lines.
Bytes make_hdr(const std::string& resolution, const Bytes& rgbe, const std::string& lines = "");

std::string temporary_folder(); // empty, new for every call, removed when the program ends
Bytes bytes_of(const std::string& path);
void put(const std::string& path, const Bytes& bytes);
std::vector<std::string> names_in(const std::string& folder); // sorted, including hidden files

} // namespace burnish::test
