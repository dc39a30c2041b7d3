#pragma once
namespace burnish {
const char* version(); // "0.1.0", from the project's CMakeLists.txt
} // namespace burnish
