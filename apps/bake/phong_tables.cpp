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

Image albedo_table(double nu, double nv, const PictureSize& size)
{
    Image image = make_image(size.width, size.height, 3, PixelType::f32);
    float* to = image.f32();
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x, to += 3) {
            const double azimuth = 0.5 * kPi * x / std::max(size.width - 1, 1),
                         root = static_cast<double>(y) / std::max(size.height - 1, 1);
            const double n_dot_v = std::max(root * root, 1e-4), sine = std::sqrt(1.0 - n_dot_v * n_dot_v);
            const PhongAlbedo a = phong_albedo({sine * det_cos(azimuth), sine * det_sin(azimuth), n_dot_v}, nu, nv);
            to[0] = static_cast<float>(a.s), to[1] = static_cast<float>(a.b), to[2] = 0.0f;
        }
    return image;
}

} // namespace burnish
