#include "shading/bake/mip/standard_textures.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/simd/half.h"
#include "shading/surface/tensor.k.h"

namespace burnish {
namespace {

struct Place { // T, B of the shortest rotation to n, and the mesh's T, B projected into n's plane
    real3 n, turned_t, turned_b, projected_t, projected_b;
};

real3 cross_of(real3 a, real3 b)
{
    return vec3_of(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
float dot_of(real3 a, real3 b)
{
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
real3 scaled_to_unit(real3 v)
{
    const float length = std::sqrt(dot_of(v, v));
    return length > 1e-6f ? vec3_of(v.x / length, v.y / length, v.z / length) : vec3_of(0.0f, 0.0f, 1.0f);
}

Place place_of(real3 n)
{
    const float part = 1.0f / (1.0f + n.z), skew = -(n.x * n.y * part);
    Place p;
    p.n = n;
    p.turned_t = vec3_of(1.0f - n.x * n.x * part, skew, -n.x), p.turned_b = vec3_of(skew, 1.0f - n.y * n.y * part, -n.y);
    p.projected_t = scaled_to_unit(vec3_of(1.0f - n.x * n.x, -n.x * n.y, -n.x * n.z));
    p.projected_b = cross_of(n, p.projected_t);
    return p;
}

// Converts a direction from one pair of axes in n's plane to another.
real2 reframed(real2 u, real3 from_t, real3 from_b, real3 to_t, real3 to_b)
{
    const real3 w = vec3_of(from_t.x * u.x + from_b.x * u.y, from_t.y * u.x + from_b.y * u.y, from_t.z * u.x + from_b.z * u.y);
    return vec2_of(dot_of(w, to_t), dot_of(w, to_b));
}

real3 upright(float nx, float ny)
{
    return vec3_of(nx, ny, std::sqrt(std::max(1.0f - (nx * nx + ny * ny), 0.0f)));
}

std::vector<MipTexel> texels_of(const MipSource& source, const MipLevels& levels, std::size_t level)
{
    if (level > 0)
        return levels.levels[level - 1].texels;
    std::vector<MipTexel> texels;
    std::vector<MipPoint> row(static_cast<std::size_t>(source.width()));
    for (int y = 0; y < source.height(); ++y) {
        source.row(y, row.data());
        for (const MipPoint& p : row) {
            const lobe_tensor t = projected_tensor(tensor_of_covariance(p.s));
            texels.push_back({p.n.x, p.n.y, t.a, t.b, t.c});
        }
    }
    return texels;
}

void put_texel(mipnet::Texels& to, std::size_t at, real3 n, lobe_tensor t)
{
    const float v[mipnet::kChannels] = {n.x, n.y, t.a, t.b, t.c};
    for (std::size_t c = 0; c < mipnet::kChannels; ++c)
        to.channel[c][at] = v[c];
}

// Calls each(place in the result, texels to average, their number): each texel alone, or all squares of four.
template <class Each> mipnet::Texels sampled(int width, int height, bool between, const Each& each)
{
    const auto less = [between](int side) { return between && side > 1 ? side - 1 : side; };
    mipnet::Texels to = mipnet::make_texels(less(width), less(height));
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) {
            std::size_t at[4], count = 0;
            for (int v = y; v < y + (between ? 2 : 1) && v < height; ++v)
                for (int u = x; u < x + (between ? 2 : 1) && u < width; ++u)
                    at[count++] = static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
            each(to, static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(x), at, count);
        }
    return to;
}

template <class Round> Image rounded_by(const Image& unit, const Round& round)
{
    Image to = unit;
    for (std::size_t i = 0; i < to.bytes.size() / sizeof(float); ++i)
        to.f32()[i] = round(std::clamp(to.f32()[i], 0.0f, 1.0f));
    return to;
}

} // namespace

StandardLevels standard_levels(const MipSource& source, const MipLevels& levels, const std::vector<Image>& metallic, float metalness)
{
    BN_CHECK(metallic.empty() || metallic.size() == levels.levels.size() + 1);
    StandardLevels made;
    for (auto* maps : {&made.normal, &made.roughness, &made.anisotropy})
        maps->resize(levels.levels.size() + 1);
    std::vector<real2> coarse; // directions of the coarser level, times the lobes' anisotropy
    int coarse_width = 0, coarse_height = 0;
    for (std::size_t l = levels.levels.size() + 1; l-- > 0;) {
        const int width = l ? levels.levels[l - 1].width : levels.width, height = l ? levels.levels[l - 1].height : levels.height;
        const std::vector<MipTexel> texels = texels_of(source, levels, l);
        Image normal = make_image(width, height, 3, PixelType::f32), roughness = normal, anisotropy = normal;
        std::vector<real2> directions(texels.size());
        // Split each lobe into widths and axis, and choose the axis' sign
        for (std::size_t i = 0; i < texels.size(); ++i) {
            const MipTexel& t = texels[i];
            const Place p = place_of(upright(t.nx, t.ny));
            const tensor_axes axes = axes_of_tensor({t.a, t.b, t.c});
            const float across = axes.alpha_v, along = std::max(std::min(axes.alpha_u, 1.0f), across);
            const float strength = across < 1.0f ? std::sqrt((along - across) / (1.0f - across)) : 0.0f;
            real2 d = strength > 0.0f ? reframed(axes.u, p.turned_t, p.turned_b, p.projected_t, p.projected_b) : vec2_of(1.0f, 0.0f);
            const std::size_t row = static_cast<std::size_t>(width);
            real2 before = vec2_of(0.0f, 0.0f); // left and above; the coarser level decides if these do not
            if (!coarse.empty()) {
                const std::size_t u = std::min(i % row / 2, static_cast<std::size_t>(coarse_width - 1));
                const std::size_t v = std::min(i / row / 2, static_cast<std::size_t>(coarse_height - 1));
                before = coarse[v * static_cast<std::size_t>(coarse_width) + u] * 0.3f;
            }
            if (i % row > 0)
                before = before + directions[i - 1];
            if (i >= row)
                before = before + directions[i - row];
            if (d.x * before.x + d.y * before.y < 0.0f)
                d = vec2_of(-d.x, -d.y);
            directions[i] = d * strength;
            const float n[3] = {0.5f + 0.5f * t.nx, 0.5f + 0.5f * t.ny, 0.5f + 0.5f * p.n.z};
            const float metal = metallic.empty() ? metalness : metallic[l].f32()[i * static_cast<std::size_t>(metallic[l].channels)];
            const float r[3] = {1.0f, std::sqrt(across), metal}, a[3] = {0.5f + 0.5f * d.x, 0.5f + 0.5f * d.y, strength};
            std::copy_n(n, 3, normal.f32() + 3 * i), std::copy_n(r, 3, roughness.f32() + 3 * i);
            std::copy_n(a, 3, anisotropy.f32() + 3 * i);
        }
        made.normal[l] = std::move(normal), made.roughness[l] = std::move(roughness), made.anisotropy[l] = std::move(anisotropy);
        coarse.swap(directions), coarse_width = width, coarse_height = height;
    }
    return made;
}

mipnet::Texels standard_texels(const StandardLevels& textures, std::size_t level, bool between)
{
    const Image &normal = textures.normal[level], &roughness = textures.roughness[level], &anisotropy = textures.anisotropy[level];
    return sampled(
        normal.width, normal.height, between, [&](mipnet::Texels& to, std::size_t place, const std::size_t* at, std::size_t count) {
            float n[3] = {}, a[3] = {}, r = 0.0f;
            for (std::size_t k = 0; k < count; ++k) {
                const float share = 1.0f / static_cast<float>(count);
                for (std::size_t c = 0; c < 3; ++c)
                    n[c] += share * normal.f32()[3 * at[k] + c], a[c] += share * anisotropy.f32()[3 * at[k] + c];
                r += share * roughness.f32()[3 * at[k] + 1];
            }
            const Place p = place_of(scaled_to_unit(vec3_of(2.0f * n[0] - 1.0f, 2.0f * n[1] - 1.0f, 2.0f * n[2] - 1.0f)));
            const real2 d = vec2_of(2.0f * a[0] - 1.0f, 2.0f * a[1] - 1.0f);
            const float length = std::sqrt(d.x * d.x + d.y * d.y), across = r * r, along = across + (1.0f - across) * a[2] * a[2];
            const real2 unit = length > 1e-6f ? vec2_of(d.x / length, d.y / length) : vec2_of(1.0f, 0.0f);
            const real2 u = reframed(unit, p.projected_t, p.projected_b, p.turned_t, p.turned_b);
            put_texel(to, place, p.n, projected_tensor(tensor_of_axes(along, across, u)));
        });
}

mipnet::Texels filtered_texels(const MipSource& source, const MipLevels& levels, std::size_t level, bool between)
{
    const std::vector<MipTexel> texels = texels_of(source, levels, level);
    const int width = level ? levels.levels[level - 1].width : levels.width,
              height = level ? levels.levels[level - 1].height : levels.height;
    const float gain = gain_of_taps(levels.filter, levels.kappa);
    return sampled(width, height, between, [&](mipnet::Texels& to, std::size_t place, const std::size_t* at, std::size_t count) {
        if (count == 1) {
            const MipTexel& t = texels[at[0]];
            put_texel(to, place, upright(t.nx, t.ny), {t.a, t.b, t.c});
            return;
        }
        real3 sum = vec3_of(0.0f, 0.0f, 0.0f);
        slope_covariance s = {0.0f, 0.0f, 0.0f};
        float x = 0.0f, y = 0.0f;
        const float share = 1.0f / static_cast<float>(count);
        for (std::size_t k = 0; k < count; ++k) {
            const MipTexel& t = texels[at[k]];
            const slope_covariance own = covariance_of_tensor({t.a, t.b, t.c});
            sum = sum + upright(t.nx, t.ny), x += share * t.nx, y += share * t.ny;
            s = {s.xx + share * own.xx, s.yy + share * own.yy, s.xy + share * own.xy};
        }
        for (std::size_t k = 0; k < count; ++k) {
            const float dx = gain * (texels[at[k]].nx - x), dy = gain * (texels[at[k]].ny - y);
            s = {s.xx + share * dx * dx, s.yy + share * dy * dy, s.xy + share * dx * dy};
        }
        put_texel(to, place, scaled_to_unit(sum), projected_tensor(tensor_of_covariance(s)));
    });
}

Image rounded_to_codes(const Image& unit)
{
    return rounded_by(unit, [](float x) { return std::floor(x * 255.0f + 0.5f) / 255.0f; });
}

Image rounded_to_halves(const Image& unit)
{
    return rounded_by(unit, [](float x) { return half_to_float(float_to_half(x)); });
}

} // namespace burnish
