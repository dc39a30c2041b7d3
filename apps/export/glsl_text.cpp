#include "apps/export/glsl_text.h"

#include <algorithm>
#include <cctype>
#include <fmt/core.h>
#include <fmt/format.h>
#include <map>
#include <set>
#include <sstream>

#include "core/base/check.h"

namespace burnish {
namespace {

bool is_word(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

struct Token {
    std::string text; // a word, or one other character
    bool word = false;
};

// Splits text into tokens. Blanks and comments are tokens too, so all tokens together give the text.
std::vector<Token> tokens_of(const std::string& text)
{
    std::vector<Token> tokens;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at + 1;
        if (is_word(text[at])) {
            const bool word = !std::isdigit(static_cast<unsigned char>(text[at]));
            while (end < text.size() && (is_word(text[end]) || (!word && text[end] == '.')))
                ++end;
            tokens.push_back({text.substr(at, end - at), word});
        } else {
            if (text.compare(at, 2, "//") == 0)
                end = std::min(text.find('\n', at), text.size());
            tokens.push_back({text.substr(at, end - at), false});
        }
        at = end;
    }
    return tokens;
}

bool is_space(const Token& t)
{
    return !t.word && (std::isspace(static_cast<unsigned char>(t.text[0])) || t.text.compare(0, 2, "//") == 0);
}

std::vector<Token> without_spaces(const std::string& text)
{
    std::vector<Token> tokens = tokens_of(text);
    tokens.erase(std::remove_if(tokens.begin(), tokens.end(), is_space), tokens.end());
    return tokens;
}

struct Piece { // a declaration
    std::string comment, text, file;
    std::vector<std::string> defines;
    bool fetches = false; // in the part that users may replace
};

struct FlatText {
    std::vector<Piece> pieces;
    std::map<std::string, std::string> headings; // by file
};

bool ends_with(const std::string& text, const std::string& end)
{
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Returns the names that a declaration adds to the global scope.
std::vector<std::string> defined_by(const std::string& text)
{
    const std::vector<Token> tokens = without_spaces(text);
    std::vector<std::string> names;
    if (tokens[0].text == "struct")
        return {tokens[1].text};
    const auto open = std::find_if(tokens.begin(), tokens.end(), [](const Token& t) { return t.text == "(" || t.text == "="; });
    if (tokens[0].text != "layout" && open != tokens.end() && open->text == "(")
        return {(open - 1)->text};
    int depth = 0;
    const bool block = tokens[0].text == "layout" && text.find('{') != std::string::npos; // its members are in the outermost scope too
    for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
        depth += tokens[i].text == "(" || tokens[i].text == "[" || (tokens[i].text == "{" && !block);
        depth -= tokens[i].text == ")" || tokens[i].text == "]" || (tokens[i].text == "}" && !block);
        const std::string& next = tokens[i + 1].text;
        if (tokens[i].word && depth == 0 && (next == "=" || next == "[" || next == "{" || next == ";" || next == ","))
            names.push_back(tokens[i].text);
    }
    return names;
}

// Reads the preprocessor's output line by line: markers, comments, declarations.
class Reader {
  public:
    FlatText read(const std::string& flat)
    {
        std::istringstream lines(flat);
        for (std::string line; std::getline(lines, line);)
            take(line);
        return std::move(out_);
    }

  private:
    void take(const std::string& line)
    {
        const std::size_t first = line.find_first_not_of(" \t");
        if (line.compare(0, 2, "# ") == 0)
            return enter(line);
        if (!open_.empty())
            return first == std::string::npos || from_list(line, first) ? void() : add(line);
        if (first == std::string::npos)
            return end_comment();
        if (line.compare(first, 2, "//") != 0)
            return add(line.substr(first));
        if (ends_with(line, "[fetches"))
            fetches_ = true;
        else if (ends_with(line, "fetches]"))
            fetches_ = false;
        else if (!ends_with(file_, ".def"))
            comment_ += line + "\n";
    }

    // Returns true for comments of list files (*.def) inside the generated code.
    bool from_list(const std::string& line, std::size_t first) const
    {
        return ends_with(file_, ".def") && line.compare(first, 2, "//") == 0;
    }

    void enter(const std::string& marker)
    {
        const std::size_t begin = marker.find('"'), end = marker.rfind('"');
        end_comment();
        file_ = marker.substr(begin + 1, end - begin - 1);
    }

    // Ends a comment without a declaration. The first such comment of a file is the file's heading.
    void end_comment()
    {
        if (comment_.empty() || !open_.empty())
            return;
        if (file_.find("/lang/") == std::string::npos && !ends_with(file_, ".glsl")) // those describe burnish
            out_.headings.emplace(file_, comment_);
        comment_.clear();
    }

    void add(const std::string& line)
    {
        if (open_.empty())
            begun_in_ = file_;
        open_ += line + "\n";
        bool function = false;
        int braces = 0;
        std::string last;
        for (const Token& t : without_spaces(open_)) {
            braces += t.text == "{";
            function = function || (braces == 1 && t.text == "{" && last == ")");
            braces -= t.text == "}";
            last = t.text;
        }
        if (braces != 0 || !(last == ";" || (function && last == "}")))
            return;
        out_.pieces.push_back({comment_, open_, begun_in_, defined_by(open_), fetches_});
        open_.clear(), comment_.clear();
    }

    FlatText out_;
    std::string file_, begun_in_, comment_, open_;
    bool fetches_ = false;
};

// Returns words that may be global names: no members after a dot; in a struct only types, which precede another word.
std::set<std::string> names_in(const std::string& text)
{
    std::set<std::string> names;
    const std::vector<Token> tokens = without_spaces(text);
    const bool structure = tokens[0].text == "struct";
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const bool type = i + 1 < tokens.size() && tokens[i + 1].word;
        if (tokens[i].word && (i == 0 || tokens[i - 1].text != ".") && (!structure || type))
            names.insert(tokens[i].text);
    }
    return names;
}

// Returns the members read from `variable`.
std::set<std::string> members_read(const std::string& text, const std::string& variable)
{
    std::set<std::string> names;
    const std::vector<Token> tokens = without_spaces(text);
    for (std::size_t i = 0; i + 2 < tokens.size(); ++i)
        if (tokens[i].text == variable && tokens[i + 1].text == ".")
            names.insert(tokens[i + 2].text);
    return names;
}

using Kept = std::vector<bool>; // by piece

Kept reached(const std::vector<Piece>& pieces, const std::vector<std::string>& roots)
{
    std::map<std::string, std::vector<std::size_t>> of_name;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        for (const std::string& name : pieces[i].defines)
            of_name[name].push_back(i);
    Kept kept(pieces.size(), false);
    std::vector<std::string> open = roots;
    for (const std::string& root : roots)
        BN_CHECK(of_name.count(root));
    while (!open.empty()) {
        const std::string name = open.back();
        open.pop_back();
        for (const std::size_t i : of_name[name]) {
            if (kept[i])
                continue;
            kept[i] = true;
            for (const std::string& used : names_in(pieces[i].text))
                if (of_name.count(used))
                    open.push_back(used);
        }
    }
    return kept;
}

// Returns the struct with the members in `read`, one a line.
std::string trimmed_struct(const std::string& text, const std::set<std::string>& read, std::set<std::string>& lost)
{
    const std::size_t open = text.find('{'), close = text.rfind('}');
    std::string out = text.substr(0, open + 1) + "\n";
    std::string bare; // without comments, which would outlive the lines they describe
    for (const Token& t : tokens_of(text.substr(open + 1, close - open - 1)))
        bare += t.text.compare(0, 2, "//") == 0 ? "" : t.text;
    std::istringstream members(bare);
    for (std::string member; std::getline(members, member, ';');) {
        const std::vector<Token> tokens = without_spaces(member);
        std::size_t type_end = 0; // `precise vec3` is two words
        while (type_end + 1 < tokens.size() && tokens[type_end + 1].word)
            ++type_end;
        std::string type, names, name;
        for (std::size_t i = 0; i < type_end; ++i)
            type += tokens[i].text + " ";
        std::string wanted;
        for (std::size_t i = type_end; i <= tokens.size() && !tokens.empty(); ++i) {
            if (i < tokens.size() && tokens[i].text != ",") {
                name += tokens[i].text;
                continue;
            }
            const std::string word = name.substr(0, name.find('['));
            if (read.count(word))
                wanted += (wanted.empty() ? "" : ", ") + name;
            else
                lost.insert(word);
            name.clear();
        }
        if (!wanted.empty())
            out += "    " + type + wanted + ";\n";
    }
    return out + "};\n";
}

// Returns the function without statements that fill lost members.
std::string trimmed_maker(const std::string& text, const std::string& variable, const std::set<std::string>& lost)
{
    std::string out, statement;
    const auto is_lost = [&](const std::string& of) {
        const std::vector<Token> t = without_spaces(of);
        return t.size() > 3 && t[0].text == variable && t[1].text == "." && lost.count(t[2].text);
    };
    const std::size_t open = text.find('{'), close = text.rfind('}');
    for (const char c : text.substr(open + 1, close - open - 1)) {
        statement += c;
        if (c != ';')
            continue;
        out += is_lost(statement) ? "" : "\n    " + statement.substr(statement.find_first_not_of(" \t\n"));
        statement.clear();
    }
    return text.substr(0, open + 1) + out + "\n}\n";
}

std::string public_name(const std::string& name)
{
    return "burnish_" + (name.compare(0, 3, "bn_") == 0 ? name.substr(3) : name);
}

// Renames global names. Members of structs keep their names: there only a word before another word is a type.
std::string renamed(const std::string& text, const std::set<std::string>& names)
{
    const std::vector<Token> tokens = tokens_of(text);
    const bool structure = text.compare(0, 6, "struct") == 0;
    std::string out, last;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const Token& t = tokens[i];
        std::size_t next = i + 1;
        while (next < tokens.size() && is_space(tokens[next]))
            ++next;
        const bool member = last == "." || (structure && last != "struct" && !(next < tokens.size() && tokens[next].word));
        out += t.word && !member && names.count(t.text) ? public_name(t.text) : t.text;
        if (!is_space(t))
            last = t.text;
    }
    return out;
}

// Returns a line for each sample, or for each set of a block: a fetch then reads one vector.
std::string grid_text(const GlslWish& wish)
{
    std::vector<std::string> rows;
    const float* const values = &wish.grid[0].slope_x;
    if (wish.blocks) {
        for (std::size_t block = 0; block < wish.grid.size(); block += kPhongBlock)
            for (std::size_t set = 0; set < 4; ++set) {
                const float* const at = values + 3 * block + set;
                rows.push_back(fmt::format("vec4({:#.9g}, {:#.9g}, {:#.9g}, {:#.9g})", at[0], at[4], at[8], at[12]));
            }
    } else {
        for (const GridSample& g : wish.grid)
            rows.push_back(fmt::format("vec3({:#.9g}, {:#.9g}, {:#.9g})", g.slope_x, g.slope_y, g.density));
    }
    return fmt::format("const {0} kGrid[{1}] = {0}[{1}](\n    {2});\n", wish.blocks ? "vec4" : "vec3", rows.size(),
                       fmt::join(rows, ",\n    "));
}

} // namespace

std::string glsl_of(const std::string& flat, const GlslWish& wish)
{
    FlatText text = Reader().read(flat);
    std::vector<Piece>& pieces = text.pieces;
    // Add the sample grid
    pieces.insert(pieces.begin(), {"", fmt::format("const int kGridCount = {};\n", wish.grid_count), "", {"kGridCount"}, false});
    if (!wish.grid.empty())
        pieces.insert(std::find_if(pieces.begin(), pieces.end(), [](const Piece& p) { return p.fetches; }),
                      {"// Slopes of the samples, and the density of normals there.\n", grid_text(wish), "", {"kGrid"}, true});
    // Trim structs to the members in use
    Kept kept = reached(pieces, wish.roots);
    for (const TrimmedStruct& wanted : wish.trimmed) {
        std::set<std::string> read, lost;
        for (std::size_t i = 0; i < pieces.size(); ++i)
            if (kept[i] && pieces[i].defines[0] != wanted.maker)
                read.merge(members_read(pieces[i].text, wanted.variable));
        for (Piece& piece : pieces)
            if (piece.defines[0] == wanted.name)
                piece.text = trimmed_struct(piece.text, read, lost);
        for (Piece& piece : pieces)
            if (piece.defines[0] == wanted.maker)
                piece.text = trimmed_maker(piece.text, wanted.variable, lost);
    }
    kept = reached(pieces, wish.roots);

    // Write the kept pieces with their comments, renamed
    std::set<std::string> names;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        if (kept[i])
            names.insert(pieces[i].defines.begin(), pieces[i].defines.end());
    std::string out;
    std::set<std::string> headed;
    bool fetches = false;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (!kept[i])
            continue;
        const Piece& piece = pieces[i];
        if (piece.fetches != fetches)
            out += piece.fetches ? "\n#ifndef BURNISH_OWN_FETCHES\n" : "\n#endif // BURNISH_OWN_FETCHES\n";
        fetches = piece.fetches;
        const auto heading = text.headings.find(piece.file);
        if (heading != text.headings.end() && headed.insert(piece.file).second)
            out += "\n" + heading->second;
        out += "\n" + piece.comment + renamed(piece.text, names);
    }
    return out + (fetches ? "\n#endif // BURNISH_OWN_FETCHES\n" : "");
}

} // namespace burnish
