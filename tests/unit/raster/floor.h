// A floor of one material under constant radiance. Its reflected light is a single number.
#pragma once
#include <cmath>
#include <memory>
#include <utility>

#include "tests/unit/raster/fixture.h"

namespace burnish::test {

// Returns two triangles that face +z, with an untextured material.
inline Scene square(float metallic, float albedo)
{
    Scene scene = scene_of(
        {{glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(1, 1, 0)}, {glm::vec3(-1, -1, 0), glm::vec3(1, 1, 0), glm::vec3(-1, 1, 0)}},
        false);
    scene.materials[0].metallic = metallic;
    scene.materials[0].base_color = glm::vec4(albedo, albedo, albedo, 1.0f);
    return scene;
}

struct Floor {
    explicit Floor(float metallic = 1.0f, float albedo = 1.0f) : Floor(square(metallic, albedo)) {}
    explicit Floor(Scene scene, float radiance = 1.0f) : stage(std::move(scene), radiance) { draw_again(); }

    // Replaces the punctual lights by one of irradiance 1 from a unit direction.
    void put_lamp(const glm::dvec3& from)
    {
        PunctualLight l;
        l.directional = true;
        l.direction = -glm::vec3(from);
        l.radiant = glm::vec3(1.0f);
        stage.tables.lights = {l};
        draw_again();
    }
    // Replaces the extracted lights by a disc of irradiance 1 with this angular radius (radians).
    void put_sun(const glm::dvec3& from, double radius)
    {
        const glm::dvec3 u = glm::normalize(glm::cross(from, glm::dvec3(0.3, 1.0, 0.2))) * radius, v = glm::cross(from, u);
        ExtractedLight k = {};
        for (int i = 0; i < 3; ++i) {
            k.direction[i] = static_cast<float>(from[i]), k.irradiance[i] = 1.0f;
            k.axis_u[i] = static_cast<float>(u[i]), k.axis_v[i] = static_cast<float>(v[i]);
        }
        stage.environment.extracted_lights = {k};
        stage.environment.whole = stage.environment.specular;
        draw_again();
    }

    static glm::dvec3 eye(double cosine, double azimuth_rad)
    {
        const double sine = std::sqrt(1.0 - cosine * cosine);
        return {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), cosine};
    }
    // Returns the mean radiance towards an eye at a cosine against the normal and an azimuth against x, the grain's direction.
    glm::dvec3 colour(const FrameDesc& shading, double cosine, double azimuth_rad) const
    {
        FrameDesc d = shading;
        d.width = d.height = 4, d.msaa = 1;
        d.view = make_view(glm::vec3(eye(cosine, azimuth_rad)) * 20.0f, {0, 0, 0}, 0.001f, d.width, d.height);
        const Frame f = *renderer->render(d);
        glm::dvec3 sum(0.0);
        for (int i = 0; i < d.width * d.height * 3; ++i)
            sum[i % 3] += static_cast<double>(f.color.f32()[i]);
        return sum / static_cast<double>(d.width * d.height);
    }
    double seen(const FrameDesc& shading, double cosine, double azimuth_rad) const
    {
        const glm::dvec3 c = colour(shading, cosine, azimuth_rad);
        return (c.x + c.y + c.z) / 3.0;
    }
    Stage stage;
    std::unique_ptr<Renderer> renderer;

  private:
    void draw_again() { renderer = make_tile_renderer(stage.input(), best_isa()); }
};

} // namespace burnish::test
