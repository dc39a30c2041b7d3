// `burnish bake mip`: levels of a scene's materials, to be kept, for other programs, and to be looked at.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/bake/preview.h"
#include "apps/cli/option.h"
#include "core/base/limits.h"
#include "core/base/result.h"
#include "shading/bake/mip/colour_levels.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish {

enum class MipFormat { pyramid, exr_mip, png_levels };

struct MipArguments {
    MipFilter filter;
    std::optional<double> kappa;
    std::string net; // of filter mipnet; empty: the program's for brdf
    MipFallback fallback{};
    bool gains = false; // of levels' reflectances
    int brdf = 0;       // a lobe; of ltc, too
    MipFormat format = MipFormat::pyramid;
    bool couple_albedo = false; // base colour and metalness weighted by how texels face
    ColourKernel color_kernel = ColourKernel::box;
    MipArguments();
};
std::vector<Option> mip_options(MipArguments& to);
Value lobe_value(int& to); // of --brdf: a lobe's place by its name

struct MipBake { // with what all of `burnish bake` has
    const MipArguments& options;
    std::string material, output, preview;
    Limits limits;
    int threads, verbosity;
    bool quiet;
};
int run_mip(const MipBake& bake); // the exit code

// Of every level from 1 on two pictures: normals as a normal map has them, and lobes in false colour: red and green the widths' roots
// (perceptual roughness, 0 to 1) along tangent and bitangent, blue how the axis lies between them (128: along one).
Preview mip_pictures(const std::string& material, const MipLevels& levels);

// Names of materials as they may stand in files' names, each once: what is no letter or digit is _, only the first hundred letters count,
// and a number follows where two are alike.
std::vector<std::string> plain_names(const std::vector<std::string>& materials);

} // namespace burnish
