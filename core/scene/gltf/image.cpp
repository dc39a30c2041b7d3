#include "core/scene/gltf/image.h"

#include <cstring>
#include <fmt/format.h>
#include <string_view>

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

// Returns the encoded bytes. `own` holds bytes that lie in no buffer.
Bytes encoded_image(Document& doc, int image, std::vector<std::uint8_t>& own)
{
    const Json& json = doc.json["images"][static_cast<std::size_t>(image)];
    const std::string place = fmt::format("/images/{}", image);
    if (const int view = get_index(json, "bufferView"); view >= 0)
        return view_bytes(doc, view);
    if (!json.contains("uri"))
        fail(place, "has neither a uri nor a bufferView");
    return read_uri(doc, json["uri"].get_ref<const std::string&>(), place + "/uri", own);
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
    Limits limits = doc.limits;
    limits.texture_bytes -= std::min(limits.texture_bytes, doc.texture_bytes);
    PictureNotes notes;
    Result<Image> decoded = decode_image(bytes.data(), bytes.size(), place, limits, &notes);
    if (!decoded && decoded.error().code == ExitCode::stopped)
        throw Stopped();
    if (!decoded)
        fail(place, printable(decoded.error().reason));
    for (const std::string& warning : notes.warnings)
        doc.warn(fmt::format("image {} {}", image, printable(warning)));
    if (decoded->bytes.size() > limits.texture_bytes)
        fail(place, fmt::format("the scene's textures need more than {} bytes (Limits::texture_bytes)", doc.limits.texture_bytes));
    return std::move(*decoded);
}

} // namespace

int scene_image(Document& doc, int image, bool floats)
{
    const auto [it, is_new] = doc.scene_images.try_emplace(image, static_cast<int>(doc.scene.images.size()));
    if (is_new) {
        check_stop();
        std::vector<std::uint8_t> own;
        const Bytes bytes = encoded_image(doc, image, own);
        doc.scene.images.push_back(decode(doc, image, bytes, floats));
        doc.texture_bytes += doc.scene.images.back().bytes.size();
    }
    return it->second;
}

void check_unused_images(Document& doc)
{
    for (int i = 0; i < static_cast<int>(table_size(doc.json, "images")); ++i) {
        if (doc.scene_images.count(i))
            continue;
        std::vector<std::uint8_t> own;
        const Bytes bytes = encoded_image(doc, i, own);
        if (is_texture_container(bytes))
            doc.warn(fmt::format("image {} is a KTX2 or DDS image, which are not supported; nothing uses it", i));
        else
            static_cast<void>(decode(doc, i, bytes, false));
    }
}

} // namespace burnish::gltf
