// Mistakes in kernels, which `burnish conform` draws: one name for each use of BN_MUTANT in the kernel text. Only files that
// include this header before any kernel can make them.
#pragma once
#include <cstdint>

namespace burnish {

#define BN_EACH_KERNEL_MUTANT(X)                                                                                                           \
    X(gltf_bend)          /* no mistake: the bent normal that KHR_materials_anisotropy recommends */                                       \
    X(bend_factor)        /* that bends by 2^(2^x), where x^4 is meant */                                                                  \
    X(bend_across)        /* that bends about the tangent, not the bitangent */                                                            \
    X(no_bend)            /* that does not bend */                                                                                         \
    X(mean_width)         /* nor that: a round lobe of the mean width */                                                                   \
    X(no_specular_image)  /* the environment's specular light is lost */                                                                   \
    X(rotation_clockwise) /* directions turn the other way */                                                                              \
    X(axes_swapped)       /* the lobe's axes change places */                                                                              \
    X(handedness_ignored) /* the tangents' w counts as 1 */                                                                                \
    X(alpha_is_roughness) /* the widths are the roughness, not its square */                                                               \
    X(no_fresnel)         /* reflectance does not rise at grazing angles */                                                                \
    X(no_energy_share)    /* the diffuse part gets the light that the lobe reflects, too */

enum class KernelMutant : int {
#define BN_KERNEL_MUTANT(name) name,
    BN_EACH_KERNEL_MUTANT(BN_KERNEL_MUTANT)
#undef BN_KERNEL_MUTANT
};

// The mistakes in the frames that are drawn now, a bit each.
extern std::uint32_t drawn_mutants;

inline constexpr std::uint32_t mutant_bit(KernelMutant mutant)
{
    return 1u << static_cast<int>(mutant);
}

} // namespace burnish

// Techniques that they draw by; others take long to compile.
#define BN_COMPILES_TECHNIQUE(id) (Technique::id == Technique::bent_normal || Technique::id == Technique::lobe_line)
#define BN_MUTANT(name, right, wrong) ((burnish::drawn_mutants & burnish::mutant_bit(burnish::KernelMutant::name)) != 0 ? (wrong) : (right))
