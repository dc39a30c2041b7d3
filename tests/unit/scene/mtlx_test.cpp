// MaterialX files: documents, widths of lobes, pictures, faults.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "core/image/io/image_io.h"
#include "core/math/scalar_math.h"
#include "core/scene/builtin/builtin.h"
#include "core/scene/directional_roughness.h"
#include "core/scene/mtlx/document.h"
#include "core/scene/mtlx/mtlx.h"
#include "core/scene/mtlx/surfaces.h"
#include "tests/unit/temp_folder.h"

using namespace burnish;
using namespace burnish::test;

namespace {

// Returns a document with one surface. inputs: elements within it; graph: elements beside it.
std::string document(const std::string& kind, const std::string& inputs, const std::string& graph = "",
                     const std::string& head = "version=\"1.39\"")
{
    return "<?xml version=\"1.0\"?>\n<materialx " + head + ">" + graph + "<" + kind + " name=\"S\" type=\"surfaceshader\">" + inputs +
           "</" + kind +
           "><surfacematerial name=\"M\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"S\"/>"
           "</surfacematerial></materialx>";
}

std::string number(const std::string& name, const std::string& value, const std::string& type = "float")
{
    return "<input name=\"" + name + "\" type=\"" + type + "\" value=\"" + value + "\"/>";
}

std::string linked(const std::string& name, const std::string& output, const std::string& more = "")
{
    return "<input name=\"" + name + "\" type=\"float\" nodegraph=\"G\" output=\"" + output + "\" " + more + "/>";
}

// Returns a node graph with a picture and, behind it, other nodes.
std::string picture_graph(const std::string& nodes, const std::string& picture_inputs = "")
{
    return "<nodegraph name=\"G\"><image name=\"p\" type=\"vector3\"><input name=\"file\" type=\"filename\" value=\"p.png\"/>" +
           picture_inputs + "</image>" + nodes + "</nodegraph>";
}

struct Loaded {
    Scene scene;
    std::string error;
    std::string warnings;
    const Material& material() const { return scene.materials.front(); }
};

Loaded loaded(const std::string& text, const Image& picture = {}, const char* scene = "sphere")
{
    const TempFolder folder;
    folder.write("a.mtlx", text);
    if (!picture.empty()) {
        EXPECT_TRUE(write_image(folder.path("p.png"), picture));
    }
    Loaded r;
    r.scene = *make_builtin_scene(scene);
    r.scene.warnings.clear();
    if (const Status done = apply_mtlx(r.scene, folder.path("a.mtlx"), Limits()); !done)
        r.error = done.error().line();
    for (const std::string& warning : r.scene.warnings)
        r.warnings += warning + "\n";
    return r;
}

Image picture_of(int red, int green, int blue)
{
    Image image = make_image(4, 4, 3, PixelType::u8);
    for (std::size_t i = 0; i < image.bytes.size(); i += 3)
        image.bytes[i] = std::byte(red), image.bytes[i + 1] = std::byte(green), image.bytes[i + 2] = std::byte(blue);
    return image;
}

// Widths that a material's lobe has: KHR_materials_anisotropy.
mtlx::Widths lobe_of(const Material& m)
{
    const double narrow = static_cast<double>(m.roughness) * static_cast<double>(m.roughness);
    const double s = static_cast<double>(m.anisotropy_strength);
    return {narrow + (1.0 - narrow) * s * s, narrow};
}

TEST(mtlx, widths_are_those_of_each_surface)
{
    for (double r : {0.1, 0.3, 0.7, 1.0})
        for (double a : {0.0, 0.2, 0.65, 0.9, 1.0}) {
            const std::string rough = std::to_string(r), stretched = std::to_string(a);
            // OpenPBR 1.1: alpha_t = r^2 sqrt(2 / (1 + (1 - a)^2)), alpha_b = (1 - a) alpha_t
            const Loaded open = loaded(
                document("open_pbr_surface", number("specular_roughness", rough) + number("specular_roughness_anisotropy", stretched)));
            const double along = r * r * std::sqrt(2.0 / (1.0 + (1.0 - a) * (1.0 - a)));
            EXPECT_NEAR(lobe_of(open.material()).along, std::min(along, 1.0), 2e-6) << r << ' ' << a << open.error;
            EXPECT_NEAR(lobe_of(open.material()).across, (1.0 - a) * along, 2e-6) << r << ' ' << a;
            // standard_surface: aspect = sqrt(1 - a), at most .98; r^2 / aspect and r^2 aspect
            const Loaded standard =
                loaded(document("standard_surface", number("specular_roughness", rough) + number("specular_anisotropy", stretched)));
            const double aspect = std::sqrt(1.0 - std::min(a, 0.98));
            EXPECT_NEAR(lobe_of(standard.material()).along, std::min(r * r / aspect, 1.0), 2e-6) << r << ' ' << a;
            EXPECT_NEAR(lobe_of(standard.material()).across, r * r * aspect, 2e-6) << r << ' ' << a;
            const Loaded own = loaded(document("gltf_pbr", number("roughness", rough) + number("anisotropy_strength", stretched)));
            EXPECT_NEAR(own.material().anisotropy_strength, r < 1.0 ? a : 0.0, 1e-5);
            EXPECT_NEAR(own.material().roughness, r, 1e-6);
        }
    const Loaded turned = loaded(document("standard_surface", number("specular_anisotropy", "0.5") + number("specular_rotation", "0.25")));
    EXPECT_NEAR(turned.material().anisotropy_rotation, 0.5 * kPi, 1e-6);
}

TEST(mtlx, every_part_arrives)
{
    const Loaded open = loaded(document(
        "open_pbr_surface",
        number("base_weight", "0.5") + number("base_color", "0.8, 0.4, 0.2", "color3") + number("base_metalness", "0.25") +
            number("specular_weight", "0.75") + number("specular_color", "1, 0.5, 0.25", "color3") + number("specular_ior", "1.7") +
            number("fuzz_weight", "0.5") + number("fuzz_color", "0.2, 0.4, 0.6", "color3") + number("fuzz_roughness", "0.3") +
            number("coat_weight", "0.9") + number("coat_roughness", "0.1") + number("coat_ior", "1.8") + number("thin_film_weight", "0.6") +
            number("thin_film_thickness", "0.45") + number("thin_film_ior", "1.35") + number("emission_luminance", "20") +
            number("emission_color", "1, 0.5, 0", "color3") + number("geometry_opacity", "0.5")));
    ASSERT_EQ(open.error, "");
    const Material& m = open.material();
    EXPECT_EQ(m.base_color, glm::vec4(0.4f, 0.2f, 0.1f, 0.5f));
    EXPECT_EQ(m.metallic, 0.25f);
    EXPECT_EQ(m.specular, 0.75f);
    EXPECT_EQ(m.specular_color, glm::vec3(1.0f, 0.5f, 0.25f));
    EXPECT_EQ(m.ior, 1.7f);
    EXPECT_EQ(m.sheen_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.sheen_roughness, 0.3f);
    EXPECT_EQ(m.clearcoat, 0.9f);
    EXPECT_EQ(m.clearcoat_roughness, 0.1f);
    EXPECT_EQ(m.clearcoat_ior, 1.8f);
    EXPECT_EQ(m.iridescence, 0.6f);
    EXPECT_EQ(m.iridescence_thickness, 450.0f);
    EXPECT_EQ(m.iridescence_ior, 1.35f);
    EXPECT_EQ(m.emissive * m.emissive_strength, glm::vec3(20.0f, 10.0f, 0.0f));
    EXPECT_EQ(m.alpha_mode, AlphaMode::blend);
    EXPECT_NE(open.warnings.find("specular_color of metal"), std::string::npos) << open.warnings;
    // Defaults of each kind
    const Material plain = loaded(document("standard_surface", "")).material();
    EXPECT_EQ(plain.base_color, glm::vec4(0.8f, 0.8f, 0.8f, 1.0f));
    EXPECT_NEAR(plain.roughness, 0.2f, 1e-6f);
    EXPECT_EQ(plain.iridescence, 0.0f);
    EXPECT_NEAR(loaded(document("open_pbr_surface", "")).material().roughness, 0.3f, 1e-6f);
    const Material khronos = loaded(document("gltf_pbr", "")).material();
    EXPECT_EQ(khronos.metallic, 1.0f);
    EXPECT_EQ(khronos.roughness, 1.0f);
    EXPECT_EQ(khronos.alpha_mode, AlphaMode::opaque);
    // Glass is tinted by the colour of its transmission; with a depth, that colour is what is left there
    const Material glass =
        loaded(document("standard_surface", number("transmission", "1") + number("transmission_color", "0.5, 1, 1", "color3"))).material();
    EXPECT_EQ(glass.base_color, glm::vec4(0.5f, 1.0f, 1.0f, 1.0f));
    EXPECT_EQ(glass.transmission, 1.0f);
    const Material deep =
        loaded(document("standard_surface", number("transmission", "1") + number("transmission_color", "0.5, 1, 1", "color3") +
                                                number("transmission_depth", "2")))
            .material();
    EXPECT_EQ(deep.base_color, glm::vec4(1.0f));
    EXPECT_EQ(deep.dispersion, 0.0f);
    const Material prism =
        loaded(document("open_pbr_surface", number("transmission_weight", "1") + number("transmission_dispersion_scale", "0.5") +
                                                number("transmission_dispersion_abbe_number", "40")))
            .material();
    EXPECT_EQ(prism.dispersion, 0.25f);
    EXPECT_EQ(deep.attenuation_distance, 2.0f);
    EXPECT_EQ(deep.attenuation_color, glm::vec3(0.5f, 1.0f, 1.0f));
}

TEST(mtlx, coats_roughen_the_lobe_below_as_openpbr_has_it)
{
    const Loaded coated = loaded(
        document("open_pbr_surface", number("specular_roughness", "0.3") + number("coat_weight", "0.5") + number("coat_roughness", "0.6")));
    const double both = std::pow(2.0 * std::pow(0.6, 4.0) + std::pow(0.3, 4.0), 0.25);
    EXPECT_NEAR(coated.material().roughness, 0.3 + 0.5 * (both - 0.3), 1e-6);
    EXPECT_EQ(coated.material().clearcoat_ior, 1.6f);
    EXPECT_EQ(coated.warnings, "");
}

TEST(mtlx, colours_become_linear)
{
    const Material encoded =
        loaded(document("gltf_pbr", "<input name=\"base_color\" type=\"color3\" value=\"0.5, 0.5, 0.5\" colorspace=\"srgb_texture\"/>"))
            .material();
    EXPECT_NEAR(encoded.base_color.r, 0.21404114f, 1e-6f);
    const Material wide =
        loaded(document("gltf_pbr", number("base_color", "0.5, 0.5, 0.5", "color3"), "", "version=\"1.38\" colorspace=\"acescg\""))
            .material();
    EXPECT_NEAR(wide.base_color.r, 0.5f, 1e-3f);
    const Material red =
        loaded(document("gltf_pbr", number("base_color", "0.3, 0.1, 0.1", "color3"), "", "version=\"1.38\" colorspace=\"acescg\""))
            .material();
    EXPECT_GT(red.base_color.r, 0.4f);
}

TEST(mtlx, pictures_are_read_by_channel)
{
    const std::string nodes = "<output name=\"o\" type=\"vector3\" nodename=\"p\"/>";
    const Loaded packed = loaded(document("gltf_pbr",
                                          linked("metallic", "o", "channels=\"z\"") + linked("roughness", "o", "channels=\"y\"") +
                                              linked("occlusion", "o", "channels=\"x\""),
                                          picture_graph(nodes, number("uvtiling", "2, 3", "vector2"))),
                                 picture_of(10, 128, 255));
    ASSERT_EQ(packed.error, "");
    const Material& m = packed.material();
    EXPECT_TRUE(m.metallic_roughness_tex.used() && m.occlusion_tex.used());
    EXPECT_EQ(m.metallic, 1.0f);
    EXPECT_EQ(m.roughness, 1.0f);
    EXPECT_EQ(m.metallic_roughness_tex.uv_transform[0], glm::vec2(2.0f, 0.0f));
    EXPECT_EQ(m.metallic_roughness_tex.uv_transform[1], glm::vec2(0.0f, 3.0f));
    EXPECT_EQ(m.metallic_roughness_tex.uv_transform[2], glm::vec2(0.0f, -2.0f)); // v = 0 is at the bottom in the file
    const auto image_of = [&](const TextureRef& ref) -> const Image& {
        return packed.scene.images[static_cast<std::size_t>(packed.scene.textures[static_cast<std::size_t>(ref.texture)].image)];
    };
    const Image& packed_image = image_of(m.metallic_roughness_tex);
    ASSERT_EQ(packed_image.type, PixelType::u8);
    EXPECT_EQ(packed_image.bytes[1], std::byte(128));
    EXPECT_EQ(packed_image.bytes[2], std::byte(255));
    EXPECT_EQ(image_of(m.occlusion_tex).bytes[0], std::byte(10));
    // Other ways to say the same
    for (const std::string& node :
         {std::string("<separate3 name=\"s\" type=\"multioutput\"><input name=\"in\" type=\"vector3\" nodename=\"p\"/></separate3>"
                      "<output name=\"o\" type=\"float\" nodename=\"s\" output=\"outy\"/>"),
          std::string("<extract name=\"s\" type=\"float\"><input name=\"in\" type=\"vector3\" nodename=\"p\"/>"
                      "<input name=\"index\" type=\"integer\" value=\"1\"/></extract><output name=\"o\" type=\"float\" nodename=\"s\"/>"),
          std::string(
              "<swizzle name=\"s\" type=\"float\"><input name=\"in\" type=\"vector3\" nodename=\"p\"/>"
              "<input name=\"channels\" type=\"string\" value=\"y\"/></swizzle><output name=\"o\" type=\"float\" nodename=\"s\"/>")}) {
        const Loaded one = loaded(document("gltf_pbr", linked("roughness", "o"), picture_graph(node)), picture_of(10, 128, 255));
        ASSERT_EQ(one.error, "");
        const TextureRef& ref = one.material().metallic_roughness_tex;
        EXPECT_EQ(one.scene.images[static_cast<std::size_t>(one.scene.textures[static_cast<std::size_t>(ref.texture)].image)].bytes[1],
                  std::byte(128));
    }
}

TEST(mtlx, roughness_pictures_of_stretched_lobes_become_two_widths)
{
    const std::string nodes = "<output name=\"o\" type=\"float\" nodename=\"p\"/>";
    Loaded brushed = loaded(document("open_pbr_surface", linked("specular_roughness", "o") + number("specular_roughness_anisotropy", "0.5"),
                                     picture_graph(nodes)),
                            picture_of(128, 0, 0));
    ASSERT_EQ(brushed.error, "");
    EXPECT_TRUE(brushed.material().directional_roughness_tex.used());
    ASSERT_TRUE(lay_directional_roughness(brushed.scene, Limits(), "a"));
    const Material& m = brushed.material();
    const double r = 128.0 / 255.0, along = r * r * std::sqrt(2.0 / 1.25);
    const auto value = [&](const TextureRef& ref, std::size_t at) {
        const Image& image =
            brushed.scene.images[static_cast<std::size_t>(brushed.scene.textures[static_cast<std::size_t>(ref.texture)].image)];
        return image.type == PixelType::f32 ? static_cast<double>(image.f32()[at])
                                            : static_cast<double>(reinterpret_cast<const std::uint16_t*>(image.bytes.data())[at]) / 65535.0;
    };
    const double narrow = std::pow(value(m.metallic_roughness_tex, 1), 2.0), strength = value(m.anisotropy_tex, 2);
    EXPECT_NEAR(narrow, 0.5 * along, 2e-4);
    EXPECT_NEAR(narrow + (1.0 - narrow) * strength * strength, along, 2e-4);
}

TEST(mtlx, normal_maps_and_factors)
{
    const std::string normal = "<normalmap name=\"n\" type=\"vector3\"><input name=\"in\" type=\"vector3\" nodename=\"p\"/>" +
                               number("scale", "0.5") + "</normalmap><output name=\"o\" type=\"vector3\" nodename=\"n\"/>";
    const Loaded bumpy = loaded(document("standard_surface", linked("normal", "o"), picture_graph(normal)), picture_of(128, 128, 255));
    ASSERT_EQ(bumpy.error, "");
    EXPECT_TRUE(bumpy.material().normal_tex.used());
    EXPECT_EQ(bumpy.material().normal_scale, 0.5f);
    const std::string product = "<multiply name=\"m\" type=\"color3\"><input name=\"in1\" type=\"color3\" nodename=\"p\"/>" +
                                number("in2", "0.5, 0.25, 1", "color3") + "</multiply><output name=\"o\" type=\"color3\" nodename=\"m\"/>";
    const Loaded tinted = loaded(document("standard_surface", linked("base_color", "o") + number("base", "0.5"), picture_graph(product)),
                                 picture_of(200, 200, 200));
    ASSERT_EQ(tinted.error, "");
    EXPECT_EQ(tinted.material().base_color, glm::vec4(0.25f, 0.125f, 0.5f, 1.0f));
}

const Image& image_of(const Loaded& d, const TextureRef& ref)
{
    return d.scene.images[static_cast<std::size_t>(d.scene.textures[static_cast<std::size_t>(ref.texture)].image)];
}

// Two materials with one picture of roughness, each times a factor of its own.
TEST(mtlx, materials_share_a_picture_and_not_its_factor)
{
    const auto product = [](const std::string& name, const std::string& factor) {
        return "<multiply name=\"" + name + "\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"p\"/>" +
               number("in2", factor) + "</multiply><output name=\"o" + name + "\" type=\"float\" nodename=\"" + name + "\"/>";
    };
    const std::string material =
        "<surfacematerial name=\"NAME\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"NAME s\"/>"
        "</surfacematerial>";
    std::string text = "<materialx version=\"1.39\">" + picture_graph(product("a", "0.25") + product("b", "0.75"));
    for (const auto& [name, output] : {std::pair("velvet", "oa"), std::pair("felt", "ob")}) {
        std::string one = material;
        for (std::size_t at = one.find("NAME"); at != std::string::npos; at = one.find("NAME"))
            one.replace(at, 4, name);
        text +=
            "<gltf_pbr name=\"" + std::string(name) + " s\" type=\"surfaceshader\">" + linked("roughness", output) + "</gltf_pbr>" + one;
    }
    const Loaded d = loaded(text + "</materialx>", picture_of(255, 255, 255), "cloth");
    ASSERT_EQ(d.error, "");
    for (const Material& m : d.scene.materials)
        if (m.name == "velvet" || m.name == "felt") {
            const Image& map = image_of(d, m.metallic_roughness_tex);
            ASSERT_EQ(map.type, PixelType::u16);
            EXPECT_NEAR(reinterpret_cast<const std::uint16_t*>(map.bytes.data())[1] / 65535.0, m.name == "felt" ? 0.75 : 0.25, 1e-4)
                << m.name;
        }
}

TEST(mtlx, nodes_of_gltf_have_factors_and_places_of_their_own)
{
    const std::string node = "<gltf_colorimage name=\"c\" type=\"multioutput\"><input name=\"file\" type=\"filename\" value=\"p.png\" "
                             "colorspace=\"srgb_texture\"/>" +
                             number("color", "0.5, 0.25, 1, 0.75", "color4") + number("scale", "1.5, 2", "vector2") +
                             number("offset", "0.25, 0.5", "vector2") +
                             "</gltf_colorimage><output name=\"c\" type=\"color3\" nodename=\"c\" output=\"outcolor\"/><output name=\"a\" "
                             "type=\"float\" nodename=\"c\" "
                             "output=\"outa\"/>";
    const std::string inputs = "<input name=\"base_color\" type=\"color3\" nodegraph=\"G\" output=\"c\"/>";
    const Loaded opaque = loaded(document("gltf_pbr", inputs, "<nodegraph name=\"G\">" + node + "</nodegraph>"), picture_of(200, 200, 200));
    ASSERT_EQ(opaque.error, "");
    EXPECT_EQ(opaque.material().base_color, glm::vec4(0.5f, 0.25f, 1.0f, 1.0f));
    const glm::mat3x2 transform = opaque.material().base_color_tex.uv_transform; // KHR_texture_transform
    EXPECT_EQ(transform[0], glm::vec2(1.5f, 0.0f));
    EXPECT_EQ(transform[1], glm::vec2(0.0f, 2.0f));
    EXPECT_EQ(transform[2], glm::vec2(0.25f, 0.5f));
    const Loaded cut = loaded(document("gltf_pbr", inputs + linked("alpha", "a") + number("alpha_mode", "1", "integer"),
                                       "<nodegraph name=\"G\">" + node + "</nodegraph>"),
                              picture_of(200, 200, 200));
    ASSERT_EQ(cut.error, "");
    EXPECT_EQ(cut.material().alpha_mode, AlphaMode::mask);
    EXPECT_EQ(cut.material().base_color.a, 0.75f);
}

TEST(mtlx, colours_of_pictures_are_read_by_their_space)
{
    const auto with = [](const std::string& space) {
        return loaded(
            document("gltf_pbr", linked("base_color", "o"),
                     "<nodegraph name=\"G\"><image name=\"p\" type=\"color3\"><input name=\"file\" type=\"filename\" value=\"p.png\"" +
                         space + "/></image><output name=\"o\" type=\"color3\" nodename=\"p\"/></nodegraph>"),
            picture_of(128, 128, 128));
    };
    const Loaded encoded = with(" colorspace=\"srgb_texture\""), linear = with(" colorspace=\"lin_rec709\"");
    EXPECT_EQ(image_of(encoded, encoded.material().base_color_tex).type, PixelType::u8); // the slot decodes it
    const Image& floats = image_of(linear, linear.material().base_color_tex);
    ASSERT_EQ(floats.type, PixelType::f32);
    EXPECT_NEAR(floats.f32()[0], 128.0f / 255.0f, 1e-6f);
    EXPECT_NE(with(" colorspace=\"acescg\"").error.find("colours of acescg"), std::string::npos);
}

TEST(mtlx, emission_keeps_its_tint_and_sides_stay_those_of_the_scene)
{
    const std::string product = "<multiply name=\"m\" type=\"color3\"><input name=\"in1\" type=\"color3\" nodename=\"p\"/>" +
                                number("in2", "0, 2, 0", "color3") + "</multiply><output name=\"o\" type=\"color3\" nodename=\"m\"/>";
    const Loaded green =
        loaded(document("open_pbr_surface", linked("emission_color", "o") + number("emission_luminance", "3"), picture_graph(product)),
               picture_of(255, 255, 255), "cloth");
    ASSERT_EQ(green.error, "");
    for (const Material& m : green.scene.materials)
        if (m.name == "satin") {
            EXPECT_EQ(m.emissive * m.emissive_strength, glm::vec3(0.0f, 6.0f, 0.0f));
            EXPECT_TRUE(m.double_sided);
        }
    EXPECT_NE(loaded(document("gltf_pbr", number("emissive", "3e38, 1, 1", "color3") + number("emissive_strength", "3e38")))
                  .error.find("too large"),
              std::string::npos);
}

TEST(mtlx, shares_of_pictures_stay_in_their_range)
{
    const auto with = [](const std::string& factor) {
        const std::string product = "<multiply name=\"m\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"p\"/>" +
                                    number("in2", factor) + "</multiply><output name=\"o\" type=\"float\" nodename=\"m\"/>";
        return loaded(document("gltf_pbr", linked("transmission", "o"), picture_graph(product)), picture_of(255, 255, 255));
    };
    const Loaded high = with("3"), low = with("-2");
    EXPECT_EQ(image_of(high, high.material().transmission_tex).f32()[0], 1.0f);
    EXPECT_EQ(image_of(low, low.material().transmission_tex).f32()[0], 0.0f);
}

TEST(mtlx, a_share_and_a_thickness_may_read_one_picture)
{
    const std::string product = "<multiply name=\"m\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"p\"/>" +
                                number("in2", "400") + "</multiply><output name=\"o\" type=\"float\" nodename=\"m\"/>";
    const Loaded d = loaded(document("gltf_pbr", linked("iridescence", "o") + linked("iridescence_thickness", "o"), picture_graph(product)),
                            picture_of(255, 255, 255));
    ASSERT_EQ(d.error, "");
    EXPECT_EQ(image_of(d, d.material().iridescence_tex).f32()[0], 1.0f);
    EXPECT_EQ(image_of(d, d.material().iridescence_thickness_tex).f32()[0], 400.0f);
}

// Each product names one node twice: without a limit, reading would take 2^15 visits an input.
TEST(mtlx, products_of_products_end)
{
    std::string nodes;
    for (int i = 0; i < 15; ++i)
        for (const char* const side : {i ? "in1" : "", i ? "in2" : ""})
            nodes += i == 0
                         ? ""
                         : (side == std::string("in1") ? "<multiply name=\"n" + std::to_string(i) + "\" type=\"float\">" : std::string()) +
                               "<input name=\"" + side + "\" type=\"float\" nodename=\"n" + std::to_string(i - 1) + "\"/>" +
                               (side == std::string("in2") ? "</multiply>" : "");
    nodes += "<constant name=\"n0\" type=\"float\">" + number("value", "1") + "</constant>";
    const Loaded d = loaded(document(
        "gltf_pbr", "<input name=\"roughness\" type=\"float\" nodename=\"n14\"/><input name=\"metallic\" type=\"float\" nodename=\"n14\"/>",
        nodes));
    EXPECT_NE(d.error.find("comes from too many nodes"), std::string::npos) << d.error;
}

TEST(mtlx, names_choose_materials)
{
    const std::string two =
        "<materialx version=\"1.39\"><gltf_pbr name=\"A\" type=\"surfaceshader\">" + number("roughness", "0.25") +
        "</gltf_pbr><gltf_pbr name=\"B\" type=\"surfaceshader\">" + number("roughness", "0.75") +
        "</gltf_pbr><surfacematerial name=\"velvet\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" "
        "nodename=\"A\"/>"
        "</surfacematerial><surfacematerial name=\"NAME\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" "
        "nodename=\"B\"/></surfacematerial></materialx>";
    const auto with = [&](const std::string& name) {
        std::string text = two;
        return text.replace(text.find("NAME"), 4, name);
    };
    const auto roughness = [](const Loaded& d, const std::string& name) {
        for (const Material& m : d.scene.materials)
            if (m.name == name)
                return m.roughness;
        return -1.0f;
    };
    const Loaded both = loaded(with("felt"), {}, "cloth");
    ASSERT_EQ(both.error, "");
    EXPECT_EQ(roughness(both, "velvet"), 0.25f);
    EXPECT_EQ(roughness(both, "felt"), 0.75f);
    EXPECT_EQ(roughness(both, "satin"), 0.42f); // its own
    const Loaded none = loaded(with("b"), {}, "sphere");
    EXPECT_NE(none.error.find("no material of the scene has the name of one of these: velvet, b"), std::string::npos) << none.error;
}

TEST(mtlx, faults_are_named)
{
    struct Fault {
        std::string text, needle;
    };
    const std::string output = "<output name=\"o\" type=\"float\" nodename=\"n\"/>";
    for (const Fault& fault : {
             Fault{"<materialx version=\"1.39\"", "byte"},
             Fault{"<other/>", "has no element materialx"},
             Fault{document("gltf_pbr", "", "", "version=\"1.37\""), "is of version \"1.37\""},
             Fault{"<materialx version=\"1.39\"><xi:include href=\"x\"/></materialx>", "includes are not read"},
             Fault{"<materialx version=\"1.39\"/>", "has no surfacematerial"},
             Fault{document("UsdPreviewSurface", ""), "UsdPreviewSurface S: is not read"},
             Fault{document("gltf_pbr", number("roughness", "rough")), "gltf_pbr S: roughness: \"rough\" is no number"},
             Fault{document("gltf_pbr", number("roughness", "nan")), "is no number"},
             Fault{document("gltf_pbr", number("", "0.5")), "has an input without a name"},
             Fault{document("gltf_pbr", linked("roughness", "o", "channels=\"xy\""),
                            picture_graph("<output name=\"o\" type=\"float\" nodename=\"p\"/>")),
                   "channels \"xy\" are not read"},
             Fault{document("gltf_pbr", linked("base_color", "o", "channels=\"bbb\""),
                            picture_graph("<output name=\"o\" type=\"color3\" nodename=\"p\"/>")),
                   "one channel of a picture is not read as a colour"},
             Fault{document("gltf_pbr", linked("alpha", "o"), picture_graph("<output name=\"o\" type=\"float\" nodename=\"p\"/>")),
                   "only as the alpha of the base colour's picture"},
             Fault{document("gltf_pbr", number("roughness", "1e400")), "is no number"},
             Fault{document("gltf_pbr", linked("roughness", "o"),
                            "<nodegraph name=\"G\"><noise3d name=\"n\" type=\"float\"/>" + output + "</nodegraph>"),
                   "roughness: noise3d n: such nodes are not read"},
             Fault{document("gltf_pbr", linked("roughness", "o")), "nodegraph G has no such output"},
             Fault{document("gltf_pbr", "<input name=\"roughness\" type=\"float\" nodename=\"n\"/>",
                            "<multiply name=\"n\" type=\"float\"><input name=\"in1\" "
                            "type=\"float\" nodename=\"n\"/>" +
                                number("in2", "1") + "</multiply>"),
                   "comes from too many nodes"},
             Fault{document("gltf_pbr", linked("ior", "o"), picture_graph("<output name=\"o\" type=\"float\" nodename=\"p\"/>")),
                   "pictures are not read here"},
             Fault{document("gltf_pbr", linked("normal", "o"), picture_graph("<output name=\"o\" type=\"float\" nodename=\"p\"/>")),
                   "a picture needs a node normalmap here"},
             Fault{document("gltf_pbr", linked("roughness", "o"), picture_graph("<output name=\"o\" type=\"float\" nodename=\"p\"/>")),
                   "p.png is not found"},
             Fault{document("gltf_pbr", number("base_color", "1, 1, 1", "color3"), "", "version=\"1.39\" colorspace=\"lin_p3\""),
                   "colours of lin_p3"},
             Fault{document(
                       "gltf_pbr", linked("roughness", "o"),
                       picture_graph("<output name=\"o\" type=\"float\" nodename=\"p\"/>", number("uaddressmode", "constant", "string"))),
                   "address mode constant"},
         }) {
        const Loaded d = loaded(fault.text);
        EXPECT_NE(d.error.find(fault.needle), std::string::npos) << fault.needle << ": " << d.error;
    }
    EXPECT_NE(loaded(document("standard_surface", number("subsurface", "0.5"))).warnings.find("nothing is made of subsurface"),
              std::string::npos);
}

TEST(mtlx, damaged_documents_end_in_an_error_or_a_material)
{
    const std::string whole =
        document("open_pbr_surface", linked("base_color", "o") + number("specular_roughness", "0.4"),
                 picture_graph("<multiply name=\"m\" type=\"color3\"><input name=\"in1\" type=\"color3\" nodename=\"p\"/>" +
                               number("in2", "0.5, 0.25, 1", "color3") + "</multiply><output name=\"o\" type=\"color3\" nodename=\"m\"/>"));
    ASSERT_TRUE(mtlx::read_document(whole, "a"));
    std::mt19937 random(1);
    int read = 0;
    for (int i = 0; i < 4000; ++i) {
        std::string text = whole;
        for (unsigned k = 0; k <= random() % 4; ++k)
            text[random() % text.size()] = static_cast<char>(random() % 256);
        if (random() % 4 == 0)
            text.resize(random() % text.size());
        read += static_cast<bool>(mtlx::read_document(text, "a"));
    }
    EXPECT_GT(read, 100);
    EXPECT_LT(read, 3900);
}

} // namespace
