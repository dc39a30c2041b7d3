// What reading and writing share about OpenImageIO.
#pragma once
#include <string>

namespace burnish {

// Sets the library's process-wide attributes once.
void configure_openimageio();

// The first line of a library message, without its full stop.
std::string first_line(const std::string& text);

} // namespace burnish
