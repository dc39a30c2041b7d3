#include "apps/lab/conform/pictures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <utility>

#include "apps/lab/conform/scenes.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

bool exists(const std::string& path)
{
    std::error_code failed;
    return std::filesystem::exists(path, failed);
}

// Returns the picture without its alpha. Grey becomes three channels.
Image three_channels(const Image& image)
{
    if (image.channels == 3)
        return image;
    Image out = make_image(image.width, image.height, 3, image.type);
    const std::size_t size = pixel_type_bytes(image.type),
                      pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const std::byte* from = &image.bytes[(i * static_cast<std::size_t>(image.channels) + (image.channels < 3 ? 0 : c)) * size];
            std::copy(from, from + size, &out.bytes[(i * 3 + c) * size]);
        }
    return out;
}

EnginePicture read_engine_picture(const std::string& folder, const std::string& name, const Limits& limits)
{
    EnginePicture picture;
    for (const char* extension : kPictureExtensions)
        if (exists(folder + "/" + name + extension)) {
            if (!picture.file.empty())
                picture.fault = fmt::format("is there twice, as {} too: keep one", extension);
            else
                picture.file = folder + "/" + name + extension;
        }
    if (!picture.fault.empty())
        return picture;
    if (picture.file.empty())
        return picture;
    PictureNotes notes;
    Result<Image> image = read_colours(picture.file, limits, notes);
    if (!image) {
        picture.fault = image.error().reason;
        return picture;
    }
    if (image->width != kConformWidth || image->height != kConformHeight) {
        picture.fault = fmt::format("has {}x{} pixels, not {}x{}", image->width, image->height, kConformWidth, kConformHeight);
        return picture;
    }
    if (image->type == PixelType::f32) {
        const Image linear = three_channels(*image);
        const std::size_t count = linear.bytes.size() / sizeof(float);
        const auto bad = std::count_if(linear.f32(), linear.f32() + count, [](float v) { return !std::isfinite(v); });
        if (bad != 0)
            picture.fault = fmt::format("{} values are NaN or infinite", bad), picture.not_finite = true;
        else
            picture.shown = shown_picture(linear);
        return picture;
    }
    picture.from_eight_bits = true;
    picture.shown = three_channels(*image);
    if (image->type == PixelType::u16) {
        Image eight = make_image(image->width, image->height, 3, PixelType::u8);
        const auto* values = reinterpret_cast<const std::uint16_t*>(picture.shown.bytes.data());
        for (std::size_t i = 0; i < eight.bytes.size(); ++i)
            eight.bytes[i] = static_cast<std::byte>((static_cast<int>(values[i]) + 128) / 257);
        picture.shown = std::move(eight);
    }
    return picture;
}

} // namespace

Result<ConformPictures> read_conform_pictures(const ConformFolder& folder, const std::string& pictures, const Limits& limits,
                                              Report& report)
{
    ConformPictures out;
    bool one = false;
    std::size_t eight_bits = 0;
    for (const FolderScene& scene : folder.scenes) {
        Result<Image> reference = read_image(folder.reference_of(scene.name), limits);
        BN_TRY(reference);
        if (reference->width != kConformWidth || reference->height != kConformHeight || reference->type != PixelType::f32 ||
            reference->channels != 3)
            return Error{ExitCode::bad_input, folder.reference_of(scene.name), "",
                         "is no reference of a conformance folder: write the folder anew"};
        const std::size_t values = reference->bytes.size() / sizeof(float);
        if (!std::all_of(reference->f32(), reference->f32() + values, [](float v) { return std::isfinite(v); }))
            return Error{ExitCode::not_finite, folder.reference_of(scene.name), "", "holds NaN or infinities: write the folder anew"};
        out.references.push_back(std::move(*reference));
        out.engine.push_back(read_engine_picture(pictures, scene.name, limits));
        one = one || !out.engine.back().file.empty();
        eight_bits += out.engine.back().from_eight_bits;
    }
    if (!one)
        return Error{ExitCode::bad_input, pictures, "",
                     fmt::format("holds no picture of a scene: {}.exr, .hdr, .pfm or .png and so on",
                                 folder.scenes.empty() ? "" : folder.scenes[0].name)};
    if (folder.references != kReferenceFolders[0])
        report.warning(fmt::format("{0}/{1} has the references, as older folders do; --write makes {0}/{2}", folder.path, folder.references,
                                   kReferenceFolders[0]));
    if (eight_bits != 0)
        report.warning(fmt::format("{} pictures of 8 or 16 bits: taken for sRGB at an exposure of {} stops, without a tone curve",
                                   eight_bits, kConformEv));
    return out;
}

} // namespace burnish
