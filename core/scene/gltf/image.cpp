#include "core/scene/gltf/image.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <utility>

#include "core/image/io/image_io.h"
#include "core/jobs/control.h"
#include "core/scene/gltf/buffers.h"

namespace burnish::gltf {

namespace {

bool starts_with(Bytes bytes, std::size_t at, std::string_view magic)
{
    return bytes.size() >= at + magic.size() && std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
}

// Returns true for glTF's image formats. The image library reads many more, which the reader does not pass on.
bool is_readable(Bytes bytes)
{
    return starts_with(bytes, 0, "\x89PNG\r\n\x1a\n") || starts_with(bytes, 0, "\xff\xd8\xff") ||
           (starts_with(bytes, 0, "RIFF") && starts_with(bytes, 8, "WEBP"));
}

bool is_exr(Bytes bytes)
{
    return starts_with(bytes, 0, "\x76\x2f\x31\x01");
}

bool is_texture_container(Bytes bytes) // KTX2 or DDS, formats of other extensions
{
    return starts_with(bytes, 0, "\xabKTX 20\xbb") || starts_with(bytes, 0, "DDS ");
}

// Returns the encoded bytes. They live until an image is removed from doc.image_files.
Bytes encoded_image(Document& doc, int image)
{
    const Json& json = doc.json["images"][static_cast<std::size_t>(image)];
    const std::string place = fmt::format("/images/{}", image);
    if (const int view = get_index(json, "bufferView"); view >= 0)
        return view_bytes(doc, view);
    if (!json.contains("uri"))
        fail(place, "has neither a uri nor a bufferView");
    std::vector<std::uint8_t>& own = doc.image_files[image];
    return own.empty() ? read_uri(doc, json["uri"].get_ref<const std::string&>(), place + "/uri", own) : Bytes(own);
}

// Returns an image that decode_images() decoded, or decodes it.
DecodedImage take_decoded(Document& doc, int image, Bytes bytes, const std::string& place)
{
    Limits limits = doc.limits;
    limits.texture_bytes -= std::min(limits.texture_bytes, doc.texture_bytes);
    if (auto decoded = doc.decoded_images.extract(image); decoded && decoded.mapped().image.bytes.size() <= limits.texture_bytes)
        return std::move(decoded.mapped());
    PictureNotes notes;
    Result<Image> decoded = decode_image(bytes.data(), bytes.size(), place, limits, &notes);
    if (!decoded && decoded.error().code == ExitCode::stopped)
        throw Stopped();
    if (!decoded)
        fail(place, printable(decoded.error().reason));
    return {std::move(*decoded), std::move(notes.warnings)};
}

// Decodes an image. `floats` also allows OpenEXR.
Image decode(Document& doc, int image, Bytes bytes, bool floats)
{
    const std::string place = fmt::format("/images/{}", image);
    if (!is_readable(bytes) && !(floats && is_exr(bytes)))
        fail(place, is_texture_container(bytes) ? "KTX2 and DDS images are not supported" : "is no PNG, JPEG or WebP image");
    const std::string type = get_string(doc.json["images"][static_cast<std::size_t>(image)], "mimeType");
    const char* actual = starts_with(bytes, 0, "RIFF")   ? "image/webp"
                         : starts_with(bytes, 0, "\xff") ? "image/jpeg"
                         : is_exr(bytes)                 ? "image/x-exr"
                                                         : "image/png";
    if (doc.json["images"][static_cast<std::size_t>(image)].contains("mimeType") && type != actual)
        doc.fault(place + "/mimeType", "says " + printable(type) + ", and it is " + actual);
    DecodedImage decoded = take_decoded(doc, image, bytes, place);
    for (const std::string& warning : decoded.warnings)
        doc.warn(fmt::format("image {} {}", image, printable(warning)));
    if (decoded.image.bytes.size() > doc.limits.texture_bytes - std::min(doc.limits.texture_bytes, doc.texture_bytes))
        fail(place, fmt::format("the scene's textures need more than {} bytes (Limits::texture_bytes)", doc.limits.texture_bytes));
    return std::move(decoded.image);
}

// Returns the images that textures name, each once.
std::vector<int> images_of_textures(const Document& doc)
{
    std::vector<int> images;
    for (std::size_t i = 0; i < table_size(doc.json, "textures"); ++i) {
        const int image = image_of_texture(doc.json["textures"][i]);
        if (image >= 0 && std::find(images.begin(), images.end(), image) == images.end())
            images.push_back(image);
    }
    return images;
}

} // namespace

int image_of_texture(const Json& texture)
{
    const Json* webp = get_extension(texture, "EXT_texture_webp");
    return get_index(webp && webp->contains("source") ? *webp : texture, "source");
}

void decode_images(Document& doc)
{
    struct Encoded {
        int image;
        Bytes bytes;
    };
    std::vector<Encoded> encoded;
    for (const int image : images_of_textures(doc)) {
        try {
            const Bytes bytes = encoded_image(doc, image);
            if (is_readable(bytes))
                encoded.push_back({image, bytes});
        } catch (const Failure&) { // scene_image() reports it in its turn
        }
    }
    // Start the largest files first
    std::stable_sort(encoded.begin(), encoded.end(), [](const Encoded& a, const Encoded& b) { return a.bytes.size() > b.bytes.size(); });
    std::vector<std::optional<DecodedImage>> decoded(encoded.size());
    std::atomic<std::uint64_t> taken = doc.texture_bytes;
    const HasRoom room = [&](std::uint64_t bytes) { return taken.fetch_add(bytes) + bytes <= doc.limits.texture_bytes; };
    const auto decode_at = [&](std::size_t i, int) {
        const Encoded& from = encoded[i];
        PictureNotes notes;
        Result<Image> image =
            decode_image(from.bytes.data(), from.bytes.size(), fmt::format("/images/{}", from.image), doc.limits, &notes, room);
        if (image)
            decoded[i] = DecodedImage{std::move(*image), std::move(notes.warnings)};
    };
    if (doc.jobs)
        doc.jobs->parallel_for(encoded.size(), decode_at);
    else
        for (std::size_t i = 0; i < encoded.size(); ++i)
            check_stop(), decode_at(i, 0);
    for (std::size_t i = 0; i < encoded.size(); ++i)
        if (decoded[i])
            doc.decoded_images[encoded[i].image] = std::move(*decoded[i]);
}

int scene_image(Document& doc, int image, bool floats)
{
    const auto [it, is_new] = doc.scene_images.try_emplace(image, static_cast<int>(doc.scene.images.size()));
    if (is_new) {
        check_stop();
        const Bytes bytes = encoded_image(doc, image);
        doc.scene.images.push_back(decode(doc, image, bytes, floats));
        doc.image_files.erase(image);
        doc.texture_bytes += doc.scene.images.back().bytes.size();
    }
    return it->second;
}

void check_unused_images(Document& doc)
{
    for (int i = 0; i < static_cast<int>(table_size(doc.json, "images")); ++i) {
        if (doc.scene_images.count(i))
            continue;
        const Bytes bytes = encoded_image(doc, i);
        if (is_texture_container(bytes))
            doc.warn(fmt::format("image {} is a KTX2 or DDS image, which are not supported; nothing uses it", i));
        else
            static_cast<void>(decode(doc, i, bytes, false));
        doc.image_files.erase(i);
    }
}

} // namespace burnish::gltf
