#include "apps/bake/phong_tables.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/math/scalar_math.h"
#include "shading/bake/tables/phong.h"

namespace burnish {

Image half_vector_table(double nu, double nv, const PictureSize& size, PixelType type)
{
    const bool floats = type == PixelType::f32;
    Image image = make_image(size.width, size.height, floats ? 4 : 3, type);
    std::size_t at = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const PhongHalfVector h = phong_half_vector(nu, nv, static_cast<double>(x) / size.width, static_cast<double>(y) / size.height);
            for (const double value : {h.x, h.y, h.z})
                if (floats)
                    image.f32()[at++] = static_cast<float>(value);
                else
                    image.bytes[at++] = static_cast<std::byte>(128 + static_cast<int>(std::lround(127.0 * value)));
            if (floats)
                image.f32()[at++] = static_cast<float>(h.density);
        }
    return image;
}

int codes_of(const Image& image)
{
    std::set<std::byte> codes;
    for (std::size_t i = 0; i < image.bytes.size(); i += static_cast<std::size_t>(image.channels))
        codes.insert(image.bytes[i]);
    return static_cast<int>(codes.size());
}

Image albedo_table(double nu, double nv, const PictureSize& size, AzimuthAxis azimuth)
{
    Image image = make_image(size.width, size.height, 3, PixelType::f32);
    float* to = image.f32();
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x, to += 3) {
            const double across = static_cast<double>(x) / std::max(size.width - 1, 1),
                         eye = static_cast<double>(y) / std::max(size.height - 1, 1);
            const double wide = nu <= nv ? across : 1.0 - across; // angle from the wide axis, in units of 90 degrees
            const double root = azimuth == AzimuthAxis::root ? across : std::sqrt(std::max(det_cos(0.5 * kPi * wide), 0.0));
            const PhongAlbedo a = phong_albedo_at(nu, nv, eye, root);
            to[0] = static_cast<float>(a.s), to[1] = static_cast<float>(a.b), to[2] = 0.0f;
        }
    return image;
}

} // namespace burnish
