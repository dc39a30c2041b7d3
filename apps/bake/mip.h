// `burnish bake mip`: writes the mip levels of a scene's materials, for burnish, for other programs and for inspection.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/bake/preview.h"
#include "apps/cli/option.h"
#include "apps/pieces/pieces.h"
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
    std::string net; // for the filter mipnet; empty: the built-in net for brdf
    MipFallback fallback{};
    bool gains = false; // with the levels' reflectance gains
    int brdf = 0;       // a lobe of shading/models.def, or ltc
    MipFormat format = MipFormat::pyramid;
    bool couple_albedo = false; // weights base colour and metalness by the texels' projected area
    ColourKernel color_kernel = ColourKernel::box;
    MipArguments();
};
std::vector<Option> mip_options(MipArguments& to);
Value lobe_value(int& to); // value of --brdf: a lobe's index, by name

struct MipBake { // with the options common to `burnish bake`
    const MipArguments& options;
    std::string material, output, preview;
    Limits limits;
    int threads, verbosity;
    bool quiet;
    const PieceOptions& pieces;
    const OptionTable& given;
};
int run_mip(const MipBake& bake); // returns the exit code

// Draws two pictures for every level from 1 on. One is the normal map. The other shows lobes: red and green are perceptual roughness
// [0,1] along tangent and bitangent, blue is the correlation of both (128: axis along one of them).
Preview mip_pictures(const std::string& material, const MipLevels& levels);

// Returns material names for use in file names, without duplicates. Replaces all but letters and digits by _, keeps the first hundred
// characters, and appends a number to duplicates.
std::vector<std::string> plain_names(const std::vector<std::string>& materials);

} // namespace burnish
