// One technique as GLSL for engines: what it needs of all techniques' text (techniques.glsl, flattened when the program is built).
#pragma once
#include <string>
#include <vector>

#include "shading/lang/tables.h"

namespace burnish {

struct TrimmedStruct {                 // a struct that keeps only the members that something reads
    std::string name, variable, maker; // what functions call it; the function that fills it, whose statements for the others go too
};

struct GlslWish {
    std::vector<std::string> roots; // functions that are to be there, with all that they call
    std::string heading;            // a comment
    std::vector<GridSample> grid;   // of techniques that sample by a grid; may be empty
    int grid_count = 0;             // of them, what a point takes
    std::vector<TrimmedStruct> trimmed;
};

// Declarations in their old order, with the comments before them and those that their files begin with. Every name of the outermost scope
// begins with burnish_, so that none is the engine's own. `flat`: what a C preprocessor leaves, with line markers and comments.
std::string glsl_of(const std::string& flat, const GlslWish& wish);

} // namespace burnish
