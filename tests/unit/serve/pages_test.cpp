// Several renderers draw bands of one picture, which are joined to the picture of one renderer.
#include <cstdint>
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/serve/pages.h"

namespace burnish {
namespace {

using Json = nlohmann::ordered_json;

struct Renderer { // a worker of a page
    ServeSetting setting;
    std::unique_ptr<Pages> pages;

    explicit Renderer(const std::string& scene)
    {
        setting.target = scene, setting.threads = 1;
        Result<ServedLists> lists = served_lists(scene);
        pages = std::make_unique<Pages>(setting, std::move(*lists));
    }
};

HttpRequest question(const std::string& path, const Json& body)
{
    HttpRequest request;
    request.method = "POST", request.path = path, request.body = body.dump();
    return request;
}

Json header_of(const HttpResponse& response)
{
    return response.headers.empty() ? Json() : Json::parse(response.headers.front().second);
}

HttpResponse part_of(Renderer& renderer, const Json& picture, double from, double to)
{
    HttpResponse response;
    renderer.pages->draw_part(question("/part", {{"picture", picture}, {"from", from}, {"to", to}}), response);
    return response;
}

HttpResponse joined(Renderer& renderer, const Json& picture, const std::vector<HttpResponse>& parts)
{
    Json bands = Json::array();
    std::vector<std::uint8_t> pixels;
    for (const HttpResponse& part : parts) {
        bands.push_back(header_of(part));
        pixels.insert(pixels.end(), part.body.begin(), part.body.end());
    }
    HttpResponse response;
    renderer.pages->join(question("/join", {{"picture", picture}, {"bands", bands}, {"ms", 12.5}}), pixels, response);
    return response;
}

HttpResponse whole(Renderer& renderer, const Json& picture)
{
    HttpResponse response;
    renderer.pages->answer(question("/draw", picture), response);
    return response;
}

Json picture_of(const std::string& scene, Json options, int width, int height, int reduction = 1)
{
    options["--env-size"] = "16", options["--env-samples"] = "16";
    return {{"scene", scene}, {"options", options}, {"width", width}, {"height", height}, {"reduction", reduction}};
}

TEST(serve, bands_of_several_renderers_are_the_picture_of_one)
{
    struct Case {
        const char* scene;
        Json options;
        std::vector<double> ends;
        int reduction;
    };
    const Case cases[] = {
        {"builtin:teapot", {{"--technique", "bent_normal"}}, {0.0, 0.37, 1.0}, 1},
        {"builtin:spheres", {{"--technique", "lobe_line"}, {"--samples", "8"}}, {0.0, 0.2, 0.21, 0.9, 1.0}, 1}, // shares samples
        {"builtin:lights", {{"--resolve", "display"}}, {0.0, 0.5, 1.0}, 2},
        {"builtin:plate", {{"--no-background", ""}, {"--exposure", "1"}}, {0.0, 0.0, 0.6, 1.0}, 1}};
    for (const Case& c : cases) {
        Renderer first(c.scene), second(c.scene), alone(c.scene);
        const Json picture = picture_of(c.scene, c.options, 75, 61, c.reduction);
        std::vector<HttpResponse> parts;
        for (std::size_t i = 0; i + 1 < c.ends.size(); ++i)
            parts.push_back(part_of(i % 2 ? second : first, picture, c.ends[i], c.ends[i + 1]));
        const HttpResponse together = joined(first, picture, parts), one = whole(alone, picture);
        ASSERT_EQ(one.status, 200) << one.body;
        ASSERT_EQ(together.status, 200) << together.body;
        EXPECT_EQ(together.body, one.body) << c.scene;
        const Json a = header_of(together), b = header_of(one);
        for (const char* name : {"hash", "width", "height", "command", "warnings", "eye", "nan_pixels"})
            EXPECT_EQ(a[name], b[name]) << c.scene << " " << name;
        EXPECT_EQ(a["frame_ms"], 12.5);
        EXPECT_FALSE(a["stages"].empty());
        // The picture is cached: neither asking for it nor comparing draws it again
        EXPECT_EQ(header_of(whole(first, picture))["frame_ms"], 12.5);
        HttpResponse difference;
        first.pages->answer(question("/difference", {{"reference", picture}, {"test", picture}}), difference);
        EXPECT_EQ(header_of(difference)["flip_mean"], 0.0);
    }
}

TEST(serve, a_picture_that_is_drawn_as_a_whole_has_no_bands)
{
    Renderer glass("builtin:glass"), plate("builtin:plate");
    EXPECT_EQ(part_of(glass, picture_of("builtin:glass", {{"--technique", "bent_normal"}}, 40, 40), 0.0, 0.5).status, 409);
    EXPECT_EQ(part_of(plate, picture_of("builtin:plate", {{"--floor", "mirror"}}, 40, 40), 0.0, 0.5).status, 409);
    EXPECT_EQ(part_of(plate, picture_of("builtin:plate", {{"--show", "normal"}}, 40, 40), 0.0, 0.5).status, 409);
    EXPECT_EQ(part_of(plate, picture_of("builtin:plate", {{"--no-such", "1"}}, 40, 40), 0.0, 0.5).status, 400);
}

TEST(serve, bands_that_do_not_fill_the_picture_are_refused)
{
    Renderer one("builtin:plate");
    const Json picture = picture_of("builtin:plate", {{"--technique", "bent_normal"}}, 40, 40);
    const HttpResponse top = part_of(one, picture, 0.0, 0.5), bottom = part_of(one, picture, 0.5, 1.0);
    ASSERT_EQ(top.status, 200) << top.body;
    EXPECT_EQ(joined(one, picture, {top, bottom}).status, 200);
    EXPECT_EQ(joined(one, picture, {top}).status, 400);
    EXPECT_EQ(joined(one, picture, {top, top, bottom}).status, 400);
    const Json wide = picture_of("builtin:plate", {{"--technique", "bent_normal"}}, 48, 40);
    EXPECT_EQ(joined(one, picture, {top, part_of(one, wide, 0.5, 1.0)}).status, 400);
    HttpResponse cut = bottom;
    cut.body.resize(cut.body.size() / 2);
    EXPECT_EQ(joined(one, picture, {top, cut}).status, 400);
}

} // namespace
} // namespace burnish
