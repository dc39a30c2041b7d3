// What of glTF 2.0 is read, in part or not at all: what `burnish list extensions` prints, and which extensions a file may require.
#pragma once
#include <string>
#include <vector>

namespace burnish {

enum class GltfSupport { supported, in_part, ignored };
const char* support_name(GltfSupport support); // "supported", "in part", "ignored"

struct GltfFeature {
    const char* name; // of an extension, or of a part of glTF itself, which has blanks or small letters
    GltfSupport support;
    const char* what;
};
const std::vector<GltfFeature>& gltf_features(); // extensions by name, then the parts of glTF that are not wholly read

bool is_read(const std::string& extension); // at least in part

// The warning of an extension that a file uses and that is ignored, and the names that such warnings hold.
std::string ignored_warning(const std::string& extension);
std::vector<std::string> ignored_extensions(const std::vector<std::string>& warnings);

} // namespace burnish
