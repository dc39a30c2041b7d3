// Extracts one technique as GLSL for other engines from the text of all techniques (techniques.glsl, flattened at build time).
#pragma once
#include <string>
#include <vector>

#include "shading/lang/tables.h"

namespace burnish {

struct TrimmedStruct {                 // a struct reduced to the members in use
    std::string name, variable, maker; // its name inside functions; the function that fills it, without statements for dropped members
};

struct GlslWish {
    std::vector<std::string> roots; // functions to keep, with their callees
    std::vector<GridSample> grid;   // for techniques with a sample grid; may be empty
    bool blocks = false;            // the grid's samples come in blocks with four sets (kPhongGrid)
    int grid_count = 0;             // grid points used by one shading point
    std::vector<TrimmedStruct> trimmed;
};

// Returns the declarations in their old order, with their comments and their files' opening comments. Prefixes every global name with
// burnish_, so that names cannot collide with the engine's. `flat`: output of a C preprocessor, with line markers and comments.
std::string glsl_of(const std::string& flat, const GlslWish& wish);

} // namespace burnish
