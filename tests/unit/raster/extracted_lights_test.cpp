// Extracted lights on a surface: the lobe's response to a small disc or ellipse on the sky, against a sum over directional lights inside
// it. Roughness goes from a mirror to a rough surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr double kOneDegree = std::numbers::pi / 180.0;

struct Disc {
    glm::dvec3 centre, u, v; // unit; half axes as tangents, orthogonal to the centre
};

// Returns a disc around the direction in which a level plate mirrors the eye, offset by angles along x and y.
Disc disc_near(const glm::dvec3& mirrored, double off_x, double off_y, double radius, double ratio, double turn)
{
    Disc d;
    d.centre = glm::normalize(mirrored + glm::dvec3(off_x, off_y, 0.0));
    const glm::dvec3 a = glm::normalize(glm::cross(d.centre, glm::dvec3(0.3, 1.0, 0.2))), b = glm::cross(d.centre, a);
    d.u = (a * std::cos(turn) + b * std::sin(turn)) * radius;
    d.v = (b * std::cos(turn) - a * std::sin(turn)) * radius * ratio;
    return d;
}

// A plate under one extracted light, or under the directional lights that sample the extracted light.
class Sun {
  public:
    explicit Sun(float metallic = 1.0f) : extracted_(plate(metallic), 0.0f), points_(plate(metallic), 0.0f) {}

    void place(const Disc& disc, int count)
    {
        const glm::dvec3 irradiance(3.0, 2.0, 1.0);
        ExtractedLight k = {};
        for (int i = 0; i < 3; ++i) {
            k.direction[i] = static_cast<float>(disc.centre[i]), k.irradiance[i] = static_cast<float>(irradiance[i]);
            k.axis_u[i] = static_cast<float>(disc.u[i]), k.axis_v[i] = static_cast<float>(disc.v[i]);
        }
        extracted_.environment.extracted_lights = {k};
        extracted_.environment.whole = extracted_.environment.specular;
        points_.tables.lights.clear();
        for (int i = 0; i < count; ++i) { // spread evenly by the golden angle
            const double r = std::sqrt((i + 0.5) / count), a = i * 2.39996322972865332;
            PunctualLight l;
            l.directional = true;
            l.direction = -glm::vec3(glm::normalize(disc.centre + disc.u * (r * std::cos(a)) + disc.v * (r * std::sin(a))));
            l.radiant = glm::vec3(irradiance / static_cast<double>(count));
            points_.tables.lights.push_back(l);
        }
    }
    struct Seen {
        double extracted, points;
    };
    Seen seen(const FrameDesc& shading, const glm::dvec3& eye) const
    {
        FrameDesc d = shading;
        d.width = d.height = 2, d.msaa = 1, d.background = false;
        d.view = make_view(glm::vec3(eye * 100.0), {0, 0, 0}, 1e-4f, 2, 2);
        const auto red = [&](const Stage& s) { return static_cast<double>(s.render(d, best_isa()).color.f32()[0]); };
        return {red(extracted_), red(points_)};
    }

  private:
    Stage extracted_, points_;
};

struct Worst {
    double of_peak = 0.0, ratio = 0.0; // differences over the largest value; logarithms of ratios
};

// Returns the largest errors over light positions along both axes of the lobe.
Worst worst_of(Sun& sun, const FrameDesc& d, const glm::dvec3& eye, double radius, double ratio, int count)
{
    const glm::dvec3 mirrored(-eye.x, -eye.y, eye.z);
    const double alpha = static_cast<double>(d.roughness * d.roughness);
    double peak = 0.0;
    Worst w;
    std::vector<Sun::Seen> all;
    for (const double along : {0.0, 0.5, 1.5, 4.0})
        for (const glm::dvec2 axis : {glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(0.7, 0.7)}) {
            const double reach = along * (radius + 2.0 * alpha);
            sun.place(disc_near(mirrored, axis.x * reach, axis.y * reach, radius, ratio, 0.4), count);
            all.push_back(sun.seen(d, eye));
            peak = std::max(peak, all.back().points);
        }
    for (const Sun::Seen& s : all) {
        w.of_peak = std::max(w.of_peak, std::abs(s.extracted - s.points) / peak);
        if (s.points > 1e-6 * peak)
            w.ratio = std::max(w.ratio, std::abs(std::log(s.extracted / s.points)));
    }
    return w;
}

glm::dvec3 eye_at(double cosine, double azimuth_rad)
{
    const double sine = std::sqrt(1.0 - cosine * cosine);
    return {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), cosine};
}

// A small extracted light equals a directional light, for every technique, tilt and lobe, with and without energy compensation.
TEST(extracted_lights, that_are_small_are_directional_lights)
{
    Sun sun;
    double worst = 0.0;
    for (const TechniqueInfo& t : techniques())
        for (const float eta : {0.0f, 0.8f, -0.6f})
            for (const double tilt : {0.0, 12.0})
                for (const bool compensated : {false, true}) {
                    FrameDesc d;
                    d.technique = t.name, d.samples = std::min(t.default_samples, 16);
                    d.roughness = 0.5f, d.anisotropy = eta, d.override_anisotropy = true, d.energy_compensation = compensated;
                    d.tilt_rad = glm::vec2(static_cast<float>(tilt * kOneDegree), static_cast<float>(-0.5 * tilt * kOneDegree));
                    const Worst w = worst_of(sun, d, eye_at(0.6, 0.7), 2e-4, 1.0, 1);
                    EXPECT_LT(w.ratio, 2e-3) << t.name << ", eta " << eta << ", tilt " << tilt << ", compensated " << compensated;
                    worst = std::max(worst, w.ratio);
                }
    std::printf("largest ratio %.2e\n", worst);
}

// An extracted light matches the sum of its directional lights, for round and long lobes. The bounds widen for narrow lobes.
TEST(extracted_lights, are_the_sum_of_the_light_in_them)
{
    Sun sun;
    for (const double radius_deg : {0.27, 2.0})
        for (const float roughness : {0.1f, 0.2f, 0.4f, 0.7f})
            for (const float eta : {0.0f, 0.5f, 0.9f, -0.8f})
                for (const double cosine : {0.95, 0.5}) {
                    FrameDesc d;
                    d.technique = "bent_normal", d.roughness = roughness, d.anisotropy = eta, d.override_anisotropy = true;
                    const Worst w = worst_of(sun, d, eye_at(cosine, 1.9), radius_deg * kOneDegree, eta == 0.5f ? 0.5 : 1.0, 1500);
                    const bool wide = roughness >= 0.4f, narrow = roughness < 0.2f; // narrow: edges of the light show
                    EXPECT_LT(w.of_peak, wide     ? 0.005
                                         : narrow ? 0.2
                                                  : 0.02)
                        << radius_deg << " degrees, " << roughness << ", eta " << eta << ", cosine " << cosine;
                    if (!narrow) {
                        EXPECT_LT(w.ratio, wide ? 0.07 : 0.3)
                            << radius_deg << " degrees, " << roughness << ", eta " << eta << ", cosine " << cosine;
                    }
                    std::printf("radius %.2f roughness %.1f eta %.1f cosine %.2f: %.4f of the peak, %.3f in ratio\n", radius_deg,
                                static_cast<double>(roughness), static_cast<double>(eta), cosine, w.of_peak, w.ratio);
                }
}

// Where eye and light both graze the surface, half vectors may lie anywhere. Nothing may flare up there.
TEST(extracted_lights, that_graze_the_surface_are_no_brighter_than_the_light_in_them)
{
    Sun sun;
    double most = 0.0;
    for (const float roughness : {0.1f, 0.4f, 0.8f})
        for (const float eta : {0.0f, 0.9f, -0.9f})
            for (const double cosine : {0.3, 0.05, 0.005, 0.0002})
                for (const double elevation : {0.05, 0.5, 1.5, 6.0})
                    for (const double azimuth : {0.0, 70.0, 150.0, 180.0}) {
                        FrameDesc d;
                        d.technique = "bent_normal", d.roughness = roughness, d.anisotropy = eta, d.override_anisotropy = true;
                        const double e = elevation * kOneDegree, a = azimuth * kOneDegree + 0.7;
                        sun.place(
                            disc_near({std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}, 0.0, 0.0, kOneDegree, 1.0, 0.0),
                            400);
                        const Sun::Seen s = sun.seen(d, eye_at(cosine, 0.7));
                        EXPECT_LT(s.extracted, 5.0 * s.points + 0.3) << "roughness " << roughness << ", eta " << eta << ", cosine "
                                                                     << cosine << ", elevation " << elevation << ", azimuth " << azimuth;
                        most = std::max(most, s.extracted / (s.points + 1.0));
                    }
    std::printf("at most %.3f of the light in them\n", most);
}

// A dielectric scatters the light by its cosine.
TEST(extracted_lights, light_what_is_diffuse_by_their_cosine)
{
    Sun sun(0.0f);
    FrameDesc d;
    d.technique = "split_isotropic", d.roughness = 1.0f;
    const glm::dvec3 eye = eye_at(0.9, 0.3);
    double before = 0.0;
    for (const double elevation : {5.0, 20.0, 60.0, 85.0}) {
        const double e = elevation * kOneDegree;
        sun.place(disc_near({std::cos(e), 0.0, std::sin(e)}, 0.0, 0.0, 0.01, 1.0, 0.0), 64);
        const double extracted = sun.seen(d, eye).extracted, lambert = 3.0 * 0.8 * std::sin(e) / std::numbers::pi;
        EXPECT_NEAR(extracted / lambert, 0.97, 0.06) << elevation; // interface transmittance and specular reflection
        EXPECT_GT(extracted, before);
        before = extracted;
    }
    sun.place(disc_near({0.9, 0.0, -0.4}, 0.0, 0.0, 0.01, 1.0, 0.0), 1);
    EXPECT_EQ(sun.seen(d, eye).extracted, 0.0); // below the horizon
}

// A sun of two degrees seen in its mirror direction and at its edge, from a mirror to the roughest lobe. Brightness falls without a jump,
// and the mirror shows the environment.
TEST(extracted_lights, grow_from_a_mirror_s_picture_to_a_wide_gleam_without_a_jump)
{
    const glm::dvec3 eye = eye_at(0.8, 0.3), mirrored(-eye.x, -eye.y, eye.z);
    Image sky = make_image(1024, 512, 3, PixelType::f32);
    for (int y = 0; y < 512; ++y)
        for (int x = 0; x < 1024; ++x) {
            const double theta = (y + 0.5) / 512 * std::numbers::pi, phi = ((x + 0.5) / 1024 - 0.5) * 2.0 * std::numbers::pi;
            const glm::dvec3 w(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            const double angle = std::acos(std::min(glm::dot(w, mirrored), 1.0)) / kOneDegree;
            std::fill_n(sky.f32() + 3 * (y * 1024 + x), 3, 0.2f + 2000.0f * static_cast<float>(std::clamp((2.2 - angle) / 0.4, 0.0, 1.0)));
        }
    Stage stage(plate(1.0f));
    EnvironmentOptions options;
    options.use_cache = false, options.samples = 256, options.cube_size = 256;
    stage.environment = *bake_environment(sky, "sun", options, stage.jobs);
    ASSERT_EQ(stage.environment.extracted_lights.size(), 1u);
    FrameDesc d;
    d.width = d.height = 2, d.msaa = 1, d.background = false, d.override_anisotropy = true, d.samples = 16;
    const auto red = [&](const glm::dvec3& from) {
        d.view = make_view(glm::vec3(from * 100.0), {0, 0, 0}, 1e-4f, 2, 2);
        return static_cast<double>(stage.render(d, best_isa()).color.f32()[0]);
    };
    for (const char* technique : {"split_isotropic", "lobe_line", "mc"})
        for (const float eta : {0.0f, 0.9f})
            for (const double off_deg : {0.0, 1.0, 6.0}) {
                d.technique = technique, d.anisotropy = eta;
                const double a = off_deg * kOneDegree; // off the sun's centre
                const glm::dvec3 from = glm::normalize(eye + glm::dvec3(0.0, std::tan(a), 0.0));
                d.roughness = 0.0f;
                const double mirror = red(from);
                if (off_deg < 2.0) {
                    EXPECT_NEAR(mirror, 2000.0 * 0.8, 0.02 * 2000.0) << technique << " " << off_deg;
                } else {
                    EXPECT_LT(mirror, 0.5) << technique;
                }
                double before = mirror, jump = 0.0;
                for (float r = 0.002f; r < 1.0f; r = r < 0.1f ? r + 0.004f : r * 1.05f) {
                    d.roughness = r;
                    const double now = red(from);
                    if (std::string(technique) != "mc" || off_deg < 2.0) // mc's samples find the sky by chance
                        jump = std::max(jump, std::abs(now - before) / std::max({now, before, 1.0}));
                    before = now;
                }
                EXPECT_LT(jump, 0.25) << technique << ", eta " << eta << ", " << off_deg << " degrees off";
                std::printf("%s eta %.1f %.0f degrees off: mirror %.3f, roughest %.4f, largest step %.3f\n", technique,
                            static_cast<double>(eta), off_deg, mirror, before, jump);
            }
}

} // namespace
} // namespace burnish::test
