// Writes the table of lobes' albedo as a C++ source, when the program is built: it takes too long to be made when the program starts.
#include <cstdio>

#include "shading/bake/environment/environment.h"

// FILE
int main(int count, char** arguments)
{
    using namespace burnish;
    std::FILE* file = count == 2 ? std::fopen(arguments[1], "w") : nullptr;
    if (!file)
        return 1;
    const Column<std::uint16_t> texels = bake_lobe_albedo(kLobeAlbedoSize, Jobs());
    std::fprintf(file,
                 "#include \"shading/bake/environment/environment.h\"\n\nnamespace burnish {\n\nnamespace {\n"
                 "// a texel is read with the one behind it\nalignas(64) constexpr std::uint16_t kTexels[%zu] = {\n",
                 texels.size() + 64);
    for (std::size_t i = 0; i < texels.size(); ++i)
        std::fprintf(file, i % 16 == 15 ? "%u,\n" : "%u,", static_cast<unsigned>(texels[i]));
    std::fprintf(file, "};\n} // namespace\n\nconst std::uint16_t* lobe_albedo_texels()\n{\n    return kTexels;\n}\n\nstd::size_t "
                       "lobe_albedo_bytes()\n{\n    return sizeof kTexels;\n}\n\n} // namespace burnish\n");
    return std::fclose(file) == 0 ? 0 : 1;
}
