// Options of the C interface: names, values and their meanings, as tables.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/image/colour.h"
#include "raster/session/burnish.h"
#include "raster/session/session.h"
#include "raster/session/shadows.h"

struct burnish_options {
    std::map<std::string, std::string> values; // by name, with '_'
    burnish_progress progress = nullptr;
    void* user = nullptr;         // of progress
    burnish::Image environment{}; // equirectangular, f32; empty: none
};

namespace burnish {

// Settings that options make.
struct CSettings {
    OpenOptions open;
    FloorSettings floor;
    Moment moment;
    MaterialOverrides overrides; // f0 alone
    std::vector<AreaLight> lights;
    MipSettings mips;
    FrameDesc desc;
    ShadowSettings shadows;
    std::optional<int> samples;
    ReferenceOptions reference;
    std::optional<glm::vec3> eye, target;
    std::optional<glm::vec2> orbit_deg;
    std::optional<float> fov_deg;
    float zoom = 1.0f;
    std::string camera; // index or name; empty: the scene's first, if any
    std::vector<std::string> layers;
    Resolve resolve = Resolve::display; // of 8-bit pictures of the frame
};

struct COption {
    std::string name, help;
    std::string values;   // "int, 1 to 16384"
    std::string fallback; // as a value; empty: unset
    unsigned calls;       // bits BURNISH_OPEN, ...
    std::function<Status(CSettings& to, const std::string& value)> set;
};
const std::vector<COption>& c_options();
const std::vector<std::string>& c_material_options();
const std::vector<std::string>& c_light_options();

// Returns the name with '_' in place of '-'.
std::string c_name(const std::string& name);

// Returns a text with the names of options in place of fields: "FrameDesc::brdf" becomes "brdf".
std::string c_words(const std::string& text);

// Returns an error, without a place, unless some call takes an option of this name with this value.
Status check_option(const std::string& name, const std::string& value);

// Returns the settings for a call, one of the bits BURNISH_OPEN, .... Options of other calls are left out. Names of materials and lights
// are refused. Errors: ExitCode::usage with the option's name as place.
Result<CSettings> settings_of(const burnish_options* options, unsigned call);
Status set_material(Material& to, const burnish_options* options);
Status set_light(Light& to, const burnish_options* options);

// Returns the view of the settings, as `burnish render` has it: eye, else a camera, else the whole scene.
Result<View> view_of(const CSettings& settings, const Session& session);

} // namespace burnish
