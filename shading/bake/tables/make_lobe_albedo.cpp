// Writes the lobe albedo table as a C++ source. The build runs this program, because a bake at program start would take too long.
#include <cstdio>

#include "shading/bake/environment/environment.h"

// Usage: make_lobe_albedo FILE
int main(int count, char** arguments)
{
    using namespace burnish;
    std::FILE* file = count == 2 ? std::fopen(arguments[1], "w") : nullptr;
    if (!file)
        return 1;
    const Column<float> pairs = bake_lobe_albedo(kLobeAlbedoSize, Jobs());
    std::fprintf(file,
                 "#include \"shading/bake/environment/environment.h\"\n\nnamespace burnish {\n\nnamespace {\n"
                 "alignas(64) constexpr float kPairs[%zu] = {\n",
                 pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i)
        std::fprintf(file, i % 8 == 7 ? "%af,\n" : "%af,", static_cast<double>(pairs[i]));
    std::fprintf(file, "};\n} // namespace\n\nconst float* lobe_albedo_pairs()\n{\n    return kPairs;\n}\n\nstd::size_t "
                       "lobe_albedo_bytes()\n{\n    return sizeof kPairs;\n}\n\n} // namespace burnish\n");
    return std::fclose(file) == 0 ? 0 : 1;
}
