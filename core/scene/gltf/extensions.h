// Support for glTF 2.0 features: the output of `burnish list extensions`, and the extensions that a file may require.
#pragma once
#include <string>
#include <vector>

namespace burnish {

enum class GltfSupport { supported, in_part, ignored };
const char* support_name(GltfSupport support); // "supported", "in part", "ignored"

struct GltfFeature {
    const char* name; // an extension, or a part of glTF (with blanks or small letters)
    GltfSupport support;
    const char* what;
};
const std::vector<GltfFeature>& gltf_features(); // extensions by name, then the parts of glTF without full support

bool is_read(const std::string& extension); // true for full or partial support

// Returns the warning for a used but ignored extension. ignored_extensions() returns the names in such warnings.
std::string ignored_warning(const std::string& extension);
std::vector<std::string> ignored_extensions(const std::vector<std::string>& warnings);

} // namespace burnish
