// The C interface: versions, lists and options.
#include <algorithm>
#include <cstring>

#include "core/base/version.h"
#include "raster/session/c_calls.h"

namespace burnish {
namespace {

std::string& last_error()
{
    thread_local std::string text;
    return text;
}

const char* text_at(const std::vector<std::string>& list, int index)
{
    return index >= 0 && static_cast<std::size_t>(index) < list.size() ? list[static_cast<std::size_t>(index)].c_str() : nullptr;
}

// Returns an option by its index, or null.
const COption* option_at(int index)
{
    return index >= 0 && static_cast<std::size_t>(index) < c_options().size() ? &c_options()[static_cast<std::size_t>(index)] : nullptr;
}

} // namespace

int fails(const Error& error)
{
    last_error() = c_words(error.line());
    return static_cast<int>(error.code);
}

} // namespace burnish

using namespace burnish;

int burnish_api_version(void)
{
    return BURNISH_API_VERSION;
}

const char* burnish_version(void)
{
    return version();
}

const char* burnish_error(void)
{
    return last_error().c_str();
}

const char* burnish_option_name(int index)
{
    const COption* const option = option_at(index);
    return option ? option->name.c_str() : nullptr;
}

const char* burnish_option_help(int index)
{
    const COption* const option = option_at(index);
    return option ? option->help.c_str() : nullptr;
}

const char* burnish_option_values(int index)
{
    const COption* const option = option_at(index);
    return option ? option->values.c_str() : nullptr;
}

const char* burnish_option_default(int index)
{
    const COption* const option = option_at(index);
    return option ? option->fallback.c_str() : nullptr;
}

unsigned burnish_option_calls(int index)
{
    const COption* const option = option_at(index);
    return option ? option->calls : 0;
}

const char* burnish_material_name(int index)
{
    return text_at(c_material_options(), index);
}

const char* burnish_light_name(int index)
{
    return text_at(c_light_options(), index);
}

const char* burnish_technique_name(int index)
{
    return index >= 0 && static_cast<std::size_t>(index) < techniques().size() ? techniques()[static_cast<std::size_t>(index)].name
                                                                               : nullptr;
}

const char* burnish_technique_help(int index)
{
    return index >= 0 && static_cast<std::size_t>(index) < techniques().size() ? techniques()[static_cast<std::size_t>(index)].summary
                                                                               : nullptr;
}

int burnish_options_make(burnish_options** out)
{
    return guarded_call([&]() -> Status {
        if (!out)
            return usage("out", "is NULL");
        *out = new burnish_options;
        return {};
    });
}

int burnish_options_set(burnish_options* options, const char* name, const char* value)
{
    return guarded_call([&]() -> Status {
        if (!options || !name || !value)
            return usage(!options ? "options" : !name ? "name" : "value", "is NULL");
        const std::string known = c_name(name);
        if (const Status checked = check_option(known, value); !checked)
            return usage(name, checked.error().reason);
        options->values[known] = value;
        return {};
    });
}

int burnish_options_progress(burnish_options* options, burnish_progress progress, void* user)
{
    return guarded_call([&]() -> Status {
        if (!options)
            return usage("options", "is NULL");
        options->progress = progress, options->user = user;
        return {};
    });
}

int burnish_options_environment(burnish_options* options, const float* pixels, int width, int height)
{
    return guarded_call([&]() -> Status {
        if (!options)
            return usage("options", "is NULL");
        constexpr int kMostSide = 1 << 16;
        if (pixels && (width < 1 || height < 1 || width > kMostSide || height > kMostSide))
            return usage(width < 1 || width > kMostSide ? "width" : "height", "does not lie in 1..65536");
        Image image;
        if (pixels) {
            image = make_image(width, height, 3, PixelType::f32);
            std::memcpy(image.bytes.data(), pixels, image.bytes.size());
        }
        options->environment = std::move(image);
        return {};
    });
}

void burnish_options_free(burnish_options* options)
{
    delete options;
}
