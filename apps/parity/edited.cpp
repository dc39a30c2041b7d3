#include "apps/parity/edited.h"

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fmt/core.h>

#include "apps/cli/outputs.h"
#include "apps/export/shader_tree.h"
#include "apps/golden/child.h"
#include "core/base/check.h"
#include "core/base/file.h"
#include "raster/vulkan/stage_files.h"
#include "raster/vulkan/vulkan_renderer.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

constexpr std::size_t kMostBytes = 4u << 20;
constexpr int kMostDepth = 8;                                      // of structs in structs
constexpr const char* kPlace = "precise vec3 technique_specular("; // of the stage: the first function behind all techniques

// Fetches of the stage that replace the file's, by name.
constexpr const char* kFetches[] = {"cube_desc",       "cube_sum",       "cube_terms",       "cube_sum_begin", "cube_sum_levels_at",
                                    "cube_sum_add",    "cube_sum_value", "cube_terms_begin", "cube_terms_add", "cube_terms_add_level",
                                    "cube_terms_value"};

bool is_name_part(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

// Returns the text with blanks in place of comments.
std::string without_remarks(const std::string& text)
{
    std::string out = text;
    for (std::size_t at = 0; at + 1 < out.size(); ++at) {
        const bool line = out[at] == '/' && out[at + 1] == '/', block = out[at] == '/' && out[at + 1] == '*';
        if (!line && !block)
            continue;
        const std::size_t found = out.find(line ? "\n" : "*/", at + 2);
        const std::size_t end = found == std::string::npos ? out.size() : found + (line ? 0 : 2);
        for (; at < end; ++at)
            if (out[at] != '\n')
                out[at] = ' ';
        --at;
    }
    return out;
}

// Returns the place behind a word, from `at` on, or npos.
std::size_t behind_word(const std::string& code, const std::string& word, std::size_t at)
{
    for (at = code.find(word, at); at != std::string::npos; at = code.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        if ((at == 0 || !is_name_part(code[at - 1])) && (end == code.size() || !is_name_part(code[end])))
            return end;
    }
    return at;
}

// Returns true if the code defines or declares a function. code: without comments.
bool holds_function(const std::string& code, const std::string& name)
{
    for (std::size_t at = behind_word(code, name, 0); at != std::string::npos; at = behind_word(code, name, at)) {
        const std::size_t next = code.find_first_not_of(" \t\r\n", at);
        if (next != std::string::npos && code[next] == '(')
            return true;
    }
    return false;
}

// Returns the declarations of the code's structs alone, which the tree can read whatever the functions hold.
std::string structs_of(const std::string& code)
{
    std::string structs;
    for (std::size_t at = behind_word(code, "struct", 0); at != std::string::npos; at = behind_word(code, "struct", at)) {
        const std::size_t close = code.find('}', at);
        if (close == std::string::npos)
            break;
        structs += "struct" + code.substr(at, close - at) + "};\n";
    }
    return structs;
}

// Appends statements that fill a struct of the file from the program's.
void add_members(const ShaderTree& tree, const std::string& name, const std::string& to, const std::string& from, std::string& out,
                 int depth = 0)
{
    if (depth > kMostDepth)
        throw CheckFailed(fmt::format("struct {} holds itself, or is too deep", name));
    for (const ShaderMember& member : tree.items[static_cast<std::size_t>(tree.structures.at(name))].members) {
        const ShaderVariable& variable = member.variable;
        const std::string field = "." + variable.name;
        if (name == "burnish_settings" && variable.name == "samples")
            continue; // for point_of() alone: the program's points have theirs
        if (tree.structures.count(variable.type)) {
            add_members(tree, variable.type, to + field, from + field, out, depth + 1);
            continue;
        }
        for (int i = 0; i < std::max(variable.count, 1); ++i) {
            const std::string element = variable.count ? fmt::format("[{}]", i) : "";
            out += fmt::format("    {0}{2}{3} = {1}{2}{3};\n", to, from, field, element);
        }
    }
}

// Returns a function that makes a struct of one side from the other's. from: a parameter's declaration, or none.
std::string maker(const ShaderTree& tree, const std::string& function, const std::string& result, const std::string& members,
                  const std::string& parameter, const std::string& from)
{
    std::string body;
    add_members(tree, members, "r", from, body);
    return fmt::format("{0} {1}({2})\n{{\n    {0} r;\n{3}    return r;\n}}\n", result, function, parameter, body);
}

// Returns the compiler's first message about the technique, by the line of the user's file.
std::string first_message(const std::string& output)
{
    const std::string mark = ": error: ";
    const std::size_t found = output.find(mark);
    if (found == std::string::npos)
        return output.substr(0, output.find('\n'));
    const std::size_t begin = output.rfind('\n', found) == std::string::npos ? 0 : output.rfind('\n', found) + 1;
    const std::string place = output.substr(begin, found - begin),
                      said = output.substr(found + mark.size(), output.find('\n', found) - found - mark.size());
    const std::string own = "technique:";
    return place.compare(0, own.size(), own) == 0 ? fmt::format("line {}: {}", place.substr(own.size()), said)
                                                  : "does not fit the stage: " + said;
}

} // namespace

Result<std::string> stage_with_technique(const std::string& stage, const std::string& text, const std::string& file,
                                         const TechniqueInfo& technique)
{
    const std::size_t place = stage.find(kPlace);
    BN_CHECK(place != std::string::npos);
    const std::string code = without_remarks(text), specular = fmt::format("burnish_{}_specular", technique.name);
    const bool shares = technique.traits & kSharesSamples;
    for (const std::string& function : {specular, shares ? fmt::format("burnish_{}_shared", technique.name) : specular})
        if (!holds_function(code, function))
            return Error{ExitCode::bad_input, file, "",
                         fmt::format("holds no function {}; see burnish export glsl --technique {}", function, technique.name)};
    std::string hooks = "#define BURNISH_OWN_FETCHES\n";
    for (const char* const fetch : kFetches)
        hooks += fmt::format("#define burnish_{0} {0}\n", fetch);
    hooks += "#define burnish_cube_sum_levels cube_levels\n"; // the stage's macro for it is gone
    for (const char* const cube : {"prefiltered_env", "mip_env", "full_env"})
        hooks += fmt::format("#define burnish_{0}(f) {0}(0)\n", cube);
    hooks += "#define burnish_grid_sample(f, i) grid_sample(0, i)\n#define burnish_grid_of_four(f, i, set) grid_of_four(0, i, set)\n"
             "#define burnish_fetched cube_sample\n#define burnish_fetched_level cube_sample_level\n";
    std::string calls;
    try {
        const ShaderTree tree = shader_tree_of(structs_of(code));
        for (const char* const needed :
             {"burnish_settings", "burnish_shaded_point", shares ? "burnish_shared_sample_record" : "burnish_settings"})
            if (!tree.structures.count(needed))
                return Error{ExitCode::bad_input, file, "", fmt::format("declares no struct {}", needed)};
        calls = maker(tree, "burnish_program_settings", "burnish_settings", "burnish_settings", "", "frame") +
                maker(tree, "burnish_program_point", "burnish_shaded_point", "burnish_shaded_point", "shaded_point x", "x") +
                fmt::format("#define {0}_specular(f, x) burnish_{0}_specular(burnish_program_settings(), burnish_program_point(x))\n",
                            technique.name);
        if (shares)
            calls += maker(tree, "burnish_program_record", "shared_sample_record", "burnish_shared_sample_record",
                           "burnish_shared_sample_record x", "x") +
                     fmt::format("#define {0}_shared(f, x, o) burnish_program_record(burnish_{0}_shared(burnish_program_settings(), "
                                 "burnish_program_point(x), o))\n",
                                 technique.name);
    } catch (const CheckFailed& failed) {
        return Error{ExitCode::bad_input, file, "", fmt::format("has a struct that is not understood: {}", failed.what())};
    }
    return stage.substr(0, place) + "\n" + hooks + "#line 1 \"technique\"\n" + text + "\n#line 1 \"stage\"\n" + calls + stage.substr(place);
}

namespace {

// Compiles the stage with the file's technique into folder/shade.spv.
Status compile_technique(const std::string& source, const std::string& file, const std::string& folder)
{
    BN_TRY(write_stages(folder));
    BN_TRY(write_text(folder + "/shade.comp", source));
    ChildRun run;
    run.words = {"glslc", "-w", "--target-env=vulkan1.3", "shade.comp", "-o", "shade.spv"};
    run.folder = folder, run.output = folder + "/glslc.txt";
    if (run_child(run))
        return {};
    const Result<std::vector<std::uint8_t>> said = read_file(run.output, kMostBytes);
    const std::string output = said ? std::string(said->begin(), said->end()) : "";
    if (output.empty())
        return Error{ExitCode::unavailable, "", "", "--glsl needs glslc, of Debian's package glslc, in PATH"};
    return Error{ExitCode::bad_input, file, "", first_message(output)};
}

} // namespace

Result<std::unique_ptr<EditedStage>> EditedStage::make(const std::string& file, const TechniqueInfo& technique)
{
    const Result<std::string> stage_source = shade_stage_source();
    BN_TRY(stage_source);
    const Result<std::vector<std::uint8_t>> bytes = read_file(file, kMostBytes);
    BN_TRY(bytes);
    const Result<std::string> source = stage_with_technique(*stage_source, std::string(bytes->begin(), bytes->end()), file, technique);
    BN_TRY(source);
    std::error_code none;
    std::string pattern = (std::filesystem::temp_directory_path(none) / "burnish-XXXXXX").string();
    if (none || !mkdtemp(pattern.data()))
        return Error{ExitCode::output_failed, pattern, "", "cannot be made"};
    std::unique_ptr<EditedStage> stage(new EditedStage);
    stage->folder_ = pattern;
    BN_TRY(compile_technique(*source, file, pattern));
    return stage;
}

EditedStage::~EditedStage()
{
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

} // namespace burnish
