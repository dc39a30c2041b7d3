// Reads the pictures of a comparison and checks that they can be compared.
#include <fmt/core.h>
#include <utility>

#include "apps/cli/report.h"
#include "apps/compare/alpha.h"
#include "apps/compare/displayed.h"
#include "apps/compare/figures.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

// Refuses pictures of different size or format. 8 and 16 bits match: both are display values.
Status check_match(const std::string& name, const Image& image, const std::string& reference_name, const Image& reference)
{
    const bool floats = image.type == PixelType::f32, reference_floats = reference.type == PixelType::f32;
    if (image.width == reference.width && image.height == reference.height && image.channels == reference.channels &&
        floats == reference_floats)
        return {};
    return Error{ExitCode::size_mismatch, name, "", fmt::format("{}; {} has {}", describe(image), reference_name, describe(reference))};
}

Status check_variance(const std::string& name, const Image& variance, const CompareOptions& options, const Image& reference)
{
    if (reference.type != PixelType::f32)
        return usage_error("--variance", fmt::format("{} does not hold floats", options.reference));
    BN_TRY(check_match(name, variance, options.reference, reference));
    if (const std::int64_t bad = not_finite_pixels(variance, variance))
        return Error{ExitCode::not_finite, name, "", fmt::format("{} pixels are NaN or Inf", bad)};
    for (std::size_t i = 0; i < variance.bytes.size() / sizeof(float); ++i)
        if (variance.f32()[i] < 0.0f)
            return Error{ExitCode::bad_input, name, fmt::format("value {}", i), "a variance is negative"};
    return {};
}

} // namespace

Result<Pictures> read_pictures(const CompareOptions& options, const Jobs& jobs)
{
    const std::vector<std::string> names = compare_inputs(options);
    const std::size_t colours = options.second_reference.empty() ? 2 : 3;
    std::vector<Result<Image>> images(names.size(), Result<Image>(Image{}));
    std::vector<PictureNotes> notes(names.size());
    jobs.parallel_for(names.size(), [&](std::size_t i, int) {
        images[i] = i < colours ? read_colours(names[i], options.limits, notes[i]) : read_image(names[i], options.limits, &notes[i]);
    });
    for (const Result<Image>& image : images)
        BN_TRY(image);
    if (images.size() > colours && (notes[0].converted || notes[1].converted))
        return usage_error("--variance", fmt::format("{} has other primaries than Rec.709, and variances cannot be converted",
                                                     names[notes[0].converted ? 0 : 1]));
    Pictures pictures;
    for (std::size_t i = 0; i < names.size(); ++i)
        for (const std::string& warning : notes[i].warnings)
            pictures.warnings.push_back(names[i] + ": " + warning);
    pictures.reference = std::move(*images[0]);
    pictures.test = std::move(*images[1]);
    Result<std::string> note = drop_lone_alpha(pictures.reference, options.reference, pictures.test, options.test);
    BN_TRY(note);
    pictures.note = std::move(*note);
    BN_TRY(check_match(options.test, pictures.test, options.reference, pictures.reference));
    if (colours > 2) {
        Image& second = pictures.second_reference.emplace(std::move(*images[2]));
        if (second.channels > pictures.reference.channels) {
            const Result<std::string> more = drop_lone_alpha(second, options.second_reference, pictures.reference, options.reference);
            BN_TRY(more);
            pictures.note += (pictures.note.empty() || more->empty() ? "" : "; ") + *more;
        }
        BN_TRY(check_match(options.second_reference, second, options.reference, pictures.reference));
    }
    for (std::size_t i = colours; i < images.size(); ++i) {
        if (pictures.reference.channels == 4 && images[i]->channels == 3 && images[i]->type == PixelType::f32)
            *images[i] = with_alpha(*images[i], [](std::size_t) { return 0.0f; }); // coverage has no noise
        BN_TRY(check_variance(names[i], *images[i], options, pictures.reference));
        pictures.variances.push_back(std::move(*images[i]));
    }
    if (options.metrics && options.metrics->flip_hdr && pictures.reference.type != PixelType::f32)
        return usage_error("--metric",
                           fmt::format("flip-hdr needs float pictures, {} has {}", options.reference, describe(pictures.reference)));
    return pictures;
}

std::vector<std::string> compare_inputs(const CompareOptions& options)
{
    std::vector<std::string> inputs = {options.reference, options.test};
    if (!options.second_reference.empty())
        inputs.push_back(options.second_reference);
    inputs.insert(inputs.end(), options.variances.begin(), options.variances.end());
    return inputs;
}

} // namespace burnish
