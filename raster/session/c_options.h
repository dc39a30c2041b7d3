// Options of the C interface: names, values and their meanings, as tables.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "raster/session/burnish.h"
#include "raster/session/session.h"

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
    FrameDesc desc;
    bool samples_given = false;
    ReferenceOptions reference;
    std::optional<glm::vec3> eye, target;
    std::optional<glm::vec2> orbit_deg;
    std::optional<float> fov_deg;
    int camera = -1; // index; negative: the scene's first, if any
    std::vector<std::string> layers;
};

struct COption {
    std::string name, help;
    Status (*set)(CSettings& to, const std::string& value); // null: a parameter of techniques
};
const std::vector<COption>& c_options();
const std::vector<std::string>& c_material_options();
const std::vector<std::string>& c_light_options();

// Returns the name with '_' in place of '-'.
std::string c_name(const std::string& name);

// Returns a text with the names of options in place of fields: "FrameDesc::brdf" becomes "brdf".
std::string c_words(const std::string& text);

// Errors: ExitCode::usage with the option's name as place.
Result<CSettings> settings_of(const burnish_options* options);
Status set_material(Material& to, const burnish_options* options);
Status set_light(Light& to, const burnish_options* options);

// Returns the view of the settings: eye, else a camera, else the whole scene.
Result<View> view_of(const CSettings& settings, const Session& session);

} // namespace burnish
