// MaterialX files (.mtlx): surfaces of numbers and pictures, for the materials of a scene.
#pragma once
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

class Jobs;

// Puts the file's materials on the scene's materials with the same names; a file with one material puts it on all. Pictures lie below the
// file's folder, unless Limits::uris_outside; else a picture with the same name in that folder is taken. Inputs that have no counterpart
// give a warning. Errors: mtlx::read_document()'s; damaged or missing pictures; more bytes than textures may have; pictures for a
// scene without texture coordinates; several materials, none of which has the name of one in the scene (ExitCode::usage).
// jobs: threads that decode pictures; null: the calling thread alone. The materials are the same.
Status apply_mtlx(Scene& scene, const std::string& path, const Limits& limits, const Jobs* jobs = nullptr);

} // namespace burnish
