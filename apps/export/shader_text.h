// Prints an exported shader in an engine's language.
#pragma once
#include <string>

namespace burnish {

// Returns a text of glsl_of() in another language. Throws CheckFailed for an unknown language.
//   essl  OpenGL ES 3.00, WebGL 2: without `precise`
//   hlsl  shader model 5
//   msl   Metal 2.0; functions that fetch take the engine's environment as their first argument
//   wgsl-of-cube  wgsl whose functions that fetch take a cube and its sampler first, where bindings have no names of their own
//   wgsl  WebGPU; overloaded functions get the type of their result as a suffix; a variable that a function changes is a pointer
std::string shader_text(const std::string& glsl, const std::string& language);

} // namespace burnish
