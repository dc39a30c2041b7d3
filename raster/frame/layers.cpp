#include "raster/frame/layers.h"

#include <algorithm>
#include <fmt/core.h>
#include <limits>
#include <sstream>
#include <string_view>

#include "raster/frame/upload.h"

namespace burnish {
namespace {

constexpr std::string_view kObject = "object-id", kDepth = "depth";

std::vector<std::string> words_of(const char* text)
{
    std::istringstream in(text);
    std::vector<std::string> words;
    for (std::string word; in >> word;)
        words.push_back(word);
    return words;
}

Error wrong(const std::string& reason)
{
    return {ExitCode::usage, "", "layers", reason};
}

Result<std::vector<const LayerInfo*>> layers_named(const std::vector<std::string>& names)
{
    std::vector<const LayerInfo*> found;
    for (const std::string& name : names) {
        const auto at = std::find_if(layers().begin(), layers().end(), [&](const LayerInfo& l) { return l.name == name; });
        if (at == layers().end())
            return wrong("there is no layer '" + name + "'");
        found.push_back(&*at);
    }
    return found;
}

float object_of(const DrawTables& tables, std::uint32_t triangle)
{
    const auto after = std::upper_bound(tables.draws.begin(), tables.draws.end(), triangle,
                                        [](std::uint32_t t, const Draw& d) { return t < d.first_triangle; });
    return static_cast<float>((after - 1)->node + 1);
}

// Writes a layer to channels [first, ...) of the image, for every pixel.
void put_layer(const LayerInfo& layer, const Frame& frame, const DrawTables& tables, std::size_t first, Image& to)
{
    const std::size_t pixels = static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height),
                      channels = static_cast<std::size_t>(to.channels);
    if (layer.first_word >= 0) {
        for (std::size_t p = 0; p < pixels; ++p) {
            const float* const words = reinterpret_cast<const float*>(&frame.layers[p]) + layer.first_word;
            std::copy_n(words, layer.channels.size(), to.f32() + p * channels + first);
            if (layer.name == kDepth && words[0] == 0.0f)
                to.f32()[p * channels + first] = std::numeric_limits<float>::infinity();
        }
        return;
    }
    const std::size_t msaa = frame.triangle_ids.size() / pixels;
    const auto central = static_cast<std::size_t>(central_sample(standard_samples(static_cast<int>(msaa))));
    for (std::size_t p = 0; p < pixels; ++p) {
        const std::uint32_t triangle = frame.triangle_ids[p * msaa + central];
        if (triangle != kNoTriangle)
            to.f32()[p * channels + first] =
                layer.name == kObject ? object_of(tables, triangle) : static_cast<float>(tables.triangle_material[triangle] + 1);
    }
}

} // namespace

const std::vector<LayerInfo>& layers()
{
    static const std::vector<LayerInfo> table = [] {
        std::vector<LayerInfo> made;
        int word = 0;
#define BN_LAYER(type, words, name, channels)                                                                                              \
    made.push_back({#name, words_of(channels), word});                                                                                     \
    word += words;
#include "shading/layers.def"
        made.push_back({std::string(kObject), {"id"}, -1});
        made.push_back({"material-id", {"materialId"}, -1});
        return made;
    }();
    return table;
}

Status ask_for_layers(const std::vector<std::string>& names, FrameDesc& desc)
{
    const Result<std::vector<const LayerInfo*>> found = layers_named(names);
    BN_TRY(found);
    for (const LayerInfo* layer : *found)
        if (layer->first_word >= 0)
            desc.layers = true;
        else
            desc.triangle_ids = true;
    return {};
}

Result<NamedChannels> with_layers(const Image& color, const Frame& frame, const DrawTables& tables, const std::vector<std::string>& names)
{
    const Result<std::vector<const LayerInfo*>> found = layers_named(names);
    BN_TRY(found);
    if (color.type != PixelType::f32 || color.channels < 3 || color.channels > 4)
        return wrong("the picture is not one of 3 or 4 float channels");
    const std::size_t pixels = static_cast<std::size_t>(color.width) * static_cast<std::size_t>(color.height);
    for (const LayerInfo* layer : *found) {
        const bool of_pixels = layer->first_word >= 0;
        const std::size_t there = of_pixels ? frame.layers.size() : frame.triangle_ids.size();
        if (there == 0 || (of_pixels ? there != pixels : there % std::max<std::size_t>(1, pixels) != 0))
            return wrong(fmt::format("the frame has no '{}' for {}x{} pixels: it was drawn without, or is of another size", layer->name,
                                     color.width, color.height));
    }
    NamedChannels out;
    out.names = {"R", "G", "B", "A"};
    out.names.resize(static_cast<std::size_t>(color.channels));
    for (const LayerInfo* layer : *found)
        out.names.insert(out.names.end(), layer->channels.begin(), layer->channels.end());
    out.image = make_image(color.width, color.height, static_cast<int>(out.names.size()), PixelType::f32);
    const std::size_t own = static_cast<std::size_t>(color.channels), channels = out.names.size();
    for (std::size_t p = 0; p * own * sizeof(float) < color.bytes.size(); ++p)
        std::copy_n(color.f32() + p * own, own, out.image.f32() + p * channels);
    std::size_t first = own;
    for (const LayerInfo* layer : *found) {
        put_layer(*layer, frame, tables, first, out.image);
        first += layer->channels.size();
    }
    return out;
}

} // namespace burnish
