#include "core/image/flip.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "core/image/image_io.h"

namespace burnish {
namespace {

double mean(const Image& image)
{
    double sum = 0;
    const std::size_t n = image.bytes.size() / 4;
    for (std::size_t i = 0; i < n; ++i)
        sum += static_cast<double>(image.f32()[i]);
    return sum / static_cast<double>(n);
}

TEST(flip, first)
{
    const std::string d = std::string(BN_SHARED_DATA) + "/flip/";
    const Jobs jobs;
    const Image r = *read_image(d + "ldr_ref.png", {}), bl = *read_image(d + "ldr_blur.png", {}), t = *read_image(d + "ldr_tint.png", {});
    const Image hr = *read_image(d + "hdr_ref.exr", {}), hb = *read_image(d + "hdr_blur.exr", {});
    for (float ppd : {67.0f, kDefaultPpd}) {
        FlipOptions o;
        o.ppd = ppd;
        std::printf("%g blur %.7f (0.098760) tint %.7f (0.263008)\n", double(ppd), mean(flip_ldr(r, bl, o, jobs).error), mean(flip_ldr(r, t, o, jobs).error));
        const FlipResult h = flip_hdr(hr, hb, o, jobs);
        std::printf("hdr %.7f (0.125888) %.5f %.5f %d\n", mean(h.error), double(h.exposures.start_ev), double(h.exposures.stop_ev), h.exposures.count);
    }
}

} // namespace
} // namespace burnish
