// A technique from a file in place of the program's, for `burnish parity --glsl`.
#pragma once
#include <memory>
#include <string>

#include "core/base/result.h"
#include "raster/frame/frame.h"

namespace burnish {

// Returns the source of the stage that shades, with the file's functions in place of the program's technique. text: GLSL as
// `burnish export glsl` writes, perhaps edited. stage: of shade_stage_source(). Errors: ExitCode::bad_input where the file lacks the
// technique's function or a struct's members.
Result<std::string> stage_with_technique(const std::string& stage, const std::string& text, const std::string& file,
                                         const TechniqueInfo& technique);

// A folder with all stages, and the file's technique in that which shades. Removed with the object.
class EditedStage {
  public:
    // Compiles by glslc, which must be in PATH. Errors: ExitCode::unavailable without Vulkan or glslc, bad_input with the compiler's first
    // message, bad_input or output_failed for files.
    static Result<std::unique_ptr<EditedStage>> make(const std::string& file, const TechniqueInfo& technique);
    ~EditedStage();
    const std::string& folder() const { return folder_; }

  private:
    EditedStage() = default;
    std::string folder_;
};

} // namespace burnish
