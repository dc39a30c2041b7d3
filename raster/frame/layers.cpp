#include "raster/frame/layers.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <string_view>

#include "core/base/check.h"
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

const LayerInfo& layer_named(const std::string& name)
{
    return *std::find_if(layers().begin(), layers().end(), [&](const LayerInfo& l) { return l.name == name; });
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

void ask_for_layers(const std::vector<std::string>& names, FrameDesc& desc)
{
    for (const std::string& name : names)
        if (layer_named(name).first_word >= 0)
            desc.layers = true;
        else
            desc.triangle_ids = true;
}

NamedChannels with_layers(const Image& color, const Frame& frame, const DrawTables& tables, const std::vector<std::string>& names)
{
    BN_CHECK(color.type == PixelType::f32 && color.channels >= 3);
    NamedChannels out;
    out.names = {"R", "G", "B", "A"};
    out.names.resize(static_cast<std::size_t>(color.channels));
    for (const std::string& name : names)
        out.names.insert(out.names.end(), layer_named(name).channels.begin(), layer_named(name).channels.end());
    out.image = make_image(color.width, color.height, static_cast<int>(out.names.size()), PixelType::f32);
    const std::size_t own = static_cast<std::size_t>(color.channels), channels = out.names.size();
    for (std::size_t p = 0; p * own * sizeof(float) < color.bytes.size(); ++p)
        std::copy_n(color.f32() + p * own, own, out.image.f32() + p * channels);
    std::size_t first = own;
    for (const std::string& name : names) {
        put_layer(layer_named(name), frame, tables, first, out.image);
        first += layer_named(name).channels.size();
    }
    return out;
}

} // namespace burnish
