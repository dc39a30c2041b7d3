#include <webp/decode.h>

#include "core/image/io/common_formats.h"

namespace burnish {

std::optional<Status> read_webp(const ImageBytes& file, const PlacePixels& place)
{
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(file.data, file.size, &features) != VP8_STATUS_OK || features.has_animation)
        return std::nullopt;
    StoredHeader header;
    header.width = header.full_width = features.width, header.height = header.full_height = features.height;
    header.depth = 1, header.channels = features.has_alpha ? 4 : 3, header.type = PixelType::u8;
    header.channel_names = {"R", "G", "B"};
    if (features.has_alpha)
        header.channel_names.emplace_back("A");
    const Result<PixelRequest> wanted = place(header);
    if (!wanted)
        return Status(wanted.error());
    if (wanted->first != 0 || wanted->end != header.channels)
        return std::nullopt;
    const auto decode = features.has_alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
    const std::size_t row_bytes = static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.channels);
    const std::size_t bytes = row_bytes * static_cast<std::size_t>(header.height);
    if (!decode(file.data, file.size, reinterpret_cast<std::uint8_t*>(wanted->to), bytes, static_cast<int>(row_bytes)))
        return std::nullopt;
    return Status();
}

} // namespace burnish
