// libFuzzer entry: any floats as a texture with a table of Ashikhmin-Shirley lobes: half vectors if the first byte is odd, else albedo. If
// the first byte is 0, the whole albedo table is checked. The next two bytes are the sides.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "core/base/check.h"
#include "shading/bake/tables/phong_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    if (size < 3)
        return 0;
    const int width = data[1] % 16 + 1, height = data[2] % 16 + 1;
    std::vector<float> pixels(static_cast<std::size_t>(3 * width * height), 0.5f);
    std::memcpy(pixels.data(), data + 3, std::min(size - 3, pixels.size() * sizeof(float)));
    if (data[0] & 1) {
        float* last_row = pixels.data() + 3 * static_cast<std::size_t>(width * (height - 1)); // of the file; the image's first row
        last_row[0] = last_row[1] = 0.0f, last_row[2] = 1.0f;
    }
    const std::string head = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
    static const int file = memfd_create("fuzz", MFD_CLOEXEC);
    BN_CHECK(file >= 0 && ftruncate(file, 0) == 0);
    const ssize_t bytes = static_cast<ssize_t>(pixels.size() * sizeof(float)), begin = static_cast<ssize_t>(head.size());
    BN_CHECK(pwrite(file, head.data(), head.size(), 0) == begin &&
             pwrite(file, pixels.data(), static_cast<std::size_t>(bytes), begin) == bytes);
    const Result<PhongFiles> tables = PhongFiles::read({"/proc/self/fd/" + std::to_string(file)}, {});
    if (!tables) {
        BN_CHECK(!tables.error().reason.empty());
        return 0;
    }
    BN_CHECK(tables->has_half_vectors() != tables->has_albedo());
    static_cast<void>(tables->warnings(16));
    if (tables->has_half_vectors()) {
        const Status fits = tables->check(10.0, 90.0);
        BN_CHECK(fits || !fits.error().reason.empty());
        for (const PhongHalfVector& h : tables->half_vectors(10.0, 90.0, 16))
            BN_CHECK(std::isfinite(h.x + h.y + h.z + h.density) && h.density >= 0.0);
        return 0;
    }
    if (data[0] != 0) // the comparison takes long for any image
        return 0;
    std::vector<float> pairs(64 * 64 * 2); // larger than a slice of 8
    tables->slice(10.0, 90.0, 8, pairs.data());
    return 0;
}
