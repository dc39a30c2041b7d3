#include "apps/export/shader_text.h"

#include <fmt/core.h>
#include <set>
#include <utility>

#include "apps/export/shader_tree.h"
#include "core/base/check.h"

namespace burnish {
namespace {

using Expression = ShaderExpression;
using Statement = ShaderStatement;
using Item = ShaderItem;

enum class ShaderLanguage { hlsl, msl, wgsl };

// Words of a language for GLSL's words. An empty word: the same.
struct ShaderWords {
    const char *glsl, *hlsl, *msl, *wgsl;
};
constexpr ShaderWords kWords[] = {
    {"float", "float", "float", "f32"},
    {"int", "int", "int", "i32"},
    {"uint", "uint", "uint", "u32"},
    {"bool", "bool", "bool", "bool"},
    {"vec2", "float2", "float2", "vec2<f32>"},
    {"vec3", "float3", "float3", "vec3<f32>"},
    {"vec4", "float4", "float4", "vec4<f32>"},
    {"roundEven", "round", "rint", "round"},
    {"floatBitsToInt", "asint", "as_type<int>", "bitcast<i32>"},
    {"intBitsToFloat", "asfloat", "as_type<float>", "bitcast<f32>"},
};

// Words that a language keeps for itself and GLSL does not, as far as kernels may use them as names.
using ReservedWords = std::set<std::string, std::less<>>;
const ReservedWords& reserved_words(ShaderLanguage language)
{
    static const ReservedWords kHlsl = {
        "centroid", "class",       "compile", "compute", "export",    "extern", "groupshared",  "half",     "inline",   "interface",
        "line",     "lineadj",     "linear",  "matrix",  "namespace", "pass",   "pixelshader",  "point",    "register", "row_major",
        "sample",   "sampler",     "shared",  "snorm",   "static",    "string", "technique",    "template", "texture",  "this",
        "triangle", "triangleadj", "typedef", "unorm",   "unsigned",  "vector", "vertexshader", "volatile"};
    static const ReservedWords kMsl = {"asm",       "bitand",  "bitor",     "catch",       "compl",   "constexpr", "nullptr", "rint",
                                       "size_t",    "throw",   "try",       "typeid",      "uchar",   "ushort",    "wchar_t", "and",
                                       "auto",      "char",    "class",     "constant",    "default", "delete",    "device",  "enum",
                                       "explicit",  "extern",  "fragment",  "friend",      "goto",    "half",      "inline",  "kernel",
                                       "long",      "mutable", "namespace", "new",         "not",     "operator",  "or",      "private",
                                       "protected", "public",  "register",  "sampler",     "short",   "signed",    "sizeof",  "static",
                                       "template",  "this",    "thread",    "threadgroup", "typedef", "typename",  "union",   "unsigned",
                                       "using",     "vertex",  "virtual",   "volatile",    "xor"};
    static const ReservedWords kWgsl = {
        "abstract",   "active",    "alias",    "as",        "async",    "attribute", "auto",     "become",  "cast",       "catch",
        "class",      "coherent",  "common",   "compile",   "concept",  "crate",     "debugger", "default", "delete",     "demote",
        "diagnostic", "do",        "enable",   "enum",      "explicit", "export",    "extends",  "extern",  "external",   "filter",
        "final",      "finally",   "fn",       "friend",    "from",     "get",       "goto",     "impl",    "implements", "import",
        "inline",     "interface", "layout",   "let",       "loop",     "macro",     "match",    "meta",    "mod",        "module",
        "move",       "mut",       "mutable",  "namespace", "new",      "nil",       "null",     "of",      "operator",   "override",
        "package",    "partial",   "pass",     "patch",     "priv",     "protected", "pub",      "public",  "readonly",   "ref",
        "regardless", "register",  "require",  "requires",  "resource", "restrict",  "self",     "set",     "shared",     "sizeof",
        "smooth",     "snorm",     "static",   "std",       "super",    "target",    "template", "this",    "throw",      "trait",
        "try",        "type",      "typedef",  "union",     "unless",   "unorm",     "unsafe",   "use",     "using",      "var",
        "varying",    "virtual",   "volatile", "where",     "with",     "yield"};
    return language == ShaderLanguage::hlsl ? kHlsl : language == ShaderLanguage::msl ? kMsl : kWgsl;
}

bool is_vector(const std::string& type)
{
    return shader_vector_size(type) > 0;
}

class ShaderPrinter {
  public:
    ShaderPrinter(const ShaderTree& tree, ShaderLanguage language, bool passes_cube)
        : tree_(tree), language_(language), passes_cube_(passes_cube)
    {
        for (const Item& item : tree.items)
            if (item.kind == Item::Kind::prototype)
                engine_.insert(item.text);
        find_fetching();
        for (const Item& item : tree.items) {
            each_expression(item, [&](const Expression& e) {
                if (e.kind == Expression::Kind::call && tree_.structures.count(e.text))
                    made_.insert(e.text);
            });
        }
    }

    std::string text()
    {
        for (std::size_t i = 0; i < tree_.items.size(); ++i)
            print_item(tree_.items[i], static_cast<int>(i));
        return std::move(out_);
    }

  private:
    bool wgsl() const { return language_ == ShaderLanguage::wgsl; }
    bool msl() const { return language_ == ShaderLanguage::msl; }
    bool hlsl() const { return language_ == ShaderLanguage::hlsl; }

    std::string word(const std::string& glsl) const
    {
        for (const ShaderWords& row : kWords)
            if (glsl == row.glsl)
                return hlsl() ? row.hlsl : msl() ? row.msl : row.wgsl;
        return glsl;
    }

    // Returns a name that the language does not keep for itself.
    std::string own(const std::string& name) const { return reserved_words(language_).count(name) ? name + "_" : name; }

    std::string element(const std::string& type) const { return type.back() == ']' ? type.substr(0, type.size() - 2) : type; }

    // Which functions fetch

    template <class Visit> static void each_expression(const Expression& e, const Visit& visit)
    {
        visit(e);
        for (const Expression& part : e.of)
            each_expression(part, visit);
    }

    template <class Visit> static void each_expression(const std::vector<Statement>& list, const Visit& visit)
    {
        for (const Statement& s : list) {
            for (const ShaderVariable& variable : s.variables)
                for (const Expression& e : variable.value)
                    each_expression(e, visit);
            for (const Expression& e : s.expressions)
                each_expression(e, visit);
            each_expression(s.body, visit);
            each_expression(s.otherwise, visit);
        }
    }

    template <class Visit> static void each_expression(const Item& item, const Visit& visit)
    {
        for (const ShaderVariable& variable : item.variables)
            for (const Expression& e : variable.value)
                each_expression(e, visit);
        each_expression(item.body, visit);
    }

    // Functions stand before their callers, so one pass finds all that fetch.
    void find_fetching()
    {
        for (std::size_t i = 0; i < tree_.items.size(); ++i)
            each_expression(tree_.items[i].body, [&](const Expression& e) {
                if (e.kind == Expression::Kind::call && (engine_.count(e.text) || fetching_.count(e.function)))
                    fetching_.insert(static_cast<int>(i));
            });
    }

    // Expressions

    // Returns the function's name: in WGSL with a suffix where the name is overloaded.
    std::string function_name(int index) const
    {
        const Item& item = tree_.items[static_cast<std::size_t>(index)];
        const bool overloaded = wgsl() && tree_.functions.at(item.text).size() > 1;
        return overloaded ? item.text + "_" + (is_vector(item.type) ? item.type : word(item.type)) : item.text;
    }

    // Returns an argument. WGSL may take two comparisons for a list of types.
    std::string argument(const Expression& e)
    {
        const bool compares = e.kind == Expression::Kind::binary && (e.text[0] == '<' || e.text[0] == '>');
        return wgsl() && compares ? "(" + print(e) + ")" : print(e);
    }

    std::string list(const std::vector<Expression>& expressions)
    {
        std::string text;
        for (const Expression& e : expressions)
            text += (text.empty() ? "" : ", ") + argument(e);
        return text;
    }

    std::string made(const Expression& e)
    {
        const bool splat = is_vector(e.text) && e.of.size() == 1 && !is_vector(e.of[0].type);
        if (e.text.back() == ']') {
            const std::string type = word(element(e.text));
            return wgsl() ? fmt::format("array<{}, {}>({})", type, e.of.size(), list(e.of)) : "{" + list(e.of) + "}";
        }
        if (hlsl() && splat)
            return fmt::format("(({})({}))", word(e.text), print(e.of[0]));
        if (hlsl() && tree_.structures.count(e.text))
            return fmt::format("{}_made({})", e.text, list(e.of));
        if (msl() && tree_.structures.count(e.text))
            return fmt::format("{}{{{}}}", e.text, list(e.of));
        return fmt::format("{}({})", word(e.text), list(e.of));
    }

    // Returns the name of an engine's function as a member of burnish_environment.
    static std::string engine_name(const std::string& name) { return name.substr(std::string("burnish_").size()); }

    std::string call(const Expression& e)
    {
        if (engine_.count(e.text))
            return fmt::format("{}({}{})", msl() ? "burnish_env." + engine_name(e.text) : e.text,
                               passes_cube_ ? "burnish_cube, burnish_taps, " : "", list(e.of));
        if (e.function < 0)
            return made(e);
        const Item& function = tree_.items[static_cast<std::size_t>(e.function)];
        std::string arguments = fetching_.count(e.function) ? msl() ? "burnish_env" : passes_cube_ ? "burnish_cube, burnish_taps" : "" : "";
        for (std::size_t i = 0; i < e.of.size(); ++i)
            arguments += (arguments.empty() ? "" : ", ") + (wgsl() && function.variables[i].inout ? reference(e.of[i]) : argument(e.of[i]));
        return fmt::format("{}({})", function_name(e.function), arguments);
    }

    // Returns a pointer to a variable. WGSL takes pointers to whole variables alone, so a member goes through a copy.
    std::string reference(const Expression& e)
    {
        if (e.kind == Expression::Kind::name)
            return pointers_.count(e.text) ? own(e.text) : "&" + own(e.text);
        const std::string copy = fmt::format("burnish_part{}", copies_++), whole = print(e);
        before_.push_back(fmt::format("var {} = {};", copy, whole));
        after_.push_back(fmt::format("{} = {};", whole, copy));
        return "&" + copy;
    }

    // Operators of a kind may stand beside each other without parentheses in every language.
    static int kind_of(const std::string& mark) { return mark == "+" || mark == "-" ? 1 : mark == "*" || mark == "/" ? 2 : 0; }

    std::string operand(const Expression& e, const Expression& outer, bool right)
    {
        const bool loose = e.kind == Expression::Kind::binary || (e.kind == Expression::Kind::choice && !wgsl());
        const int inside = e.kind == Expression::Kind::binary ? kind_of(e.text) : 0, outside = kind_of(outer.text);
        const bool comparison = !inside || !loose ? false : outer.type == "bool" && outer.text != "&&" && outer.text != "||";
        const bool same = outer.text == e.text && (e.text == "&&" || e.text == "||" || e.text == "^");
        const bool compared = e.kind == Expression::Kind::binary && e.type == "bool" && e.text != "&&" && e.text != "||" &&
                              outer.type == "bool" && (outer.text == "&&" || outer.text == "||");
        const bool bare = !loose || comparison || same || compared || (inside && outside && (right ? inside > outside : inside >= outside));
        return bare ? print(e) : "(" + print(e) + ")";
    }

    std::string shift_count(const Expression& e) { return e.kind == Expression::Kind::number ? e.text + "u" : "u32(" + print(e) + ")"; }

    std::string print(const Expression& e)
    {
        switch (e.kind) {
        case Expression::Kind::number:
            return e.text + (e.type == "float" && !wgsl() ? "f" : "");
        case Expression::Kind::name:
            return pointers_.count(e.text) ? "(*" + own(e.text) + ")" : own(e.text);
        case Expression::Kind::call:
            return call(e);
        case Expression::Kind::member:
            return inner(e.of[0]) + "." + (is_vector(e.of[0].type) ? e.text : own(e.text));
        case Expression::Kind::index:
            return inner(e.of[0]) + "[" + print(e.of[1]) + "]";
        case Expression::Kind::unary:
            return e.text + (e.of[0].kind == Expression::Kind::unary ? "(" + print(e.of[0]) + ")" : inner(e.of[0]));
        case Expression::Kind::binary:
            if (wgsl() && (e.text == "<<" || e.text == ">>"))
                return fmt::format("{} {} {}", operand(e.of[0], e, false), e.text, shift_count(e.of[1]));
            return fmt::format("{} {} {}", operand(e.of[0], e, false), e.text, operand(e.of[1], e, true));
        case Expression::Kind::choice:
            break;
        }
        if (wgsl())
            return fmt::format("select({}, {}, {})", print(e.of[2]), print(e.of[1]), print(e.of[0]));
        return fmt::format("{} ? {} : {}", inner(e.of[0]), inner(e.of[1]), inner(e.of[2]));
    }

    std::string inner(const Expression& e)
    {
        const bool loose = e.kind == Expression::Kind::binary || (e.kind == Expression::Kind::choice && !wgsl());
        return loose ? "(" + print(e) + ")" : print(e);
    }

    // Statements

    void line(const std::string& text, const std::string& beside = "")
    {
        out_ += std::string(4 * depth_, ' ') + text + (beside.empty() ? "" : " " + beside) + "\n";
    }

    // Writes the line with its copies of members around it.
    void surrounded(const std::string& text, const std::string& beside)
    {
        for (const std::string& copy : std::exchange(before_, {}))
            line(copy);
        line(text, beside);
        for (const std::string& copy : std::exchange(after_, {}))
            line(copy);
    }

    std::string declared(const ShaderVariable& variable, bool precise)
    {
        const std::string name = own(variable.name);
        const std::string type = word(element(variable.type)), size = variable.count ? fmt::format("[{}]", variable.count) : "";
        if (wgsl())
            return fmt::format("{}: {}", name, variable.count ? fmt::format("array<{}, {}>", type, variable.count) : type);
        return fmt::format("{}{} {}{}", precise && hlsl() && (variable.type == "float" || is_vector(variable.type)) ? "precise " : "", type,
                           name, size);
    }

    void print_body(const std::vector<Statement>& body)
    {
        ++depth_;
        for (const Statement& s : body)
            print(s);
        --depth_;
    }

    void print(const Statement& s)
    {
        for (const std::string& comment : s.comments)
            line(comment);
        switch (s.kind) {
        case Statement::Kind::declare:
            for (const ShaderVariable& variable : s.variables) {
                const std::string value = variable.value.empty() ? "" : " = " + print(variable.value[0]);
                surrounded((wgsl() ? "var " : "") + declared(variable, true) + value + ";", s.beside);
            }
            return;
        case Statement::Kind::assign:
            return surrounded(fmt::format("{} = {};", print(s.expressions[0]), print(s.expressions[1])), s.beside);
        case Statement::Kind::call:
            return surrounded(print(s.expressions[0]) + ";", s.beside);
        case Statement::Kind::result: {
            const std::string value = s.expressions.empty() ? "" : " " + print(s.expressions[0]);
            BN_CHECK(before_.empty()); // a copy would never be written back
            return line("return" + value + ";", s.beside);
        }
        case Statement::Kind::branch:
            line(fmt::format("if ({}) {{", print(s.expressions[0])), s.beside);
            BN_CHECK(before_.empty()); // a copy would stand in the body
            print_body(s.body);
            if (!s.otherwise.empty())
                line("} else {"), print_body(s.otherwise);
            return line("}");
        case Statement::Kind::loop: {
            const ShaderVariable& counter = s.variables[0];
            line(fmt::format("for ({}{} = {}; {}; {}++) {{", wgsl() ? "var " : "", declared(counter, false), print(counter.value[0]),
                             print(s.expressions[0]), own(counter.name)),
                 s.beside);
            BN_CHECK(before_.empty());
            print_body(s.body);
            return line("}");
        }
        case Statement::Kind::block:
            line("{"), print_body(s.body), line("}");
        }
    }

    // Declarations

    void print_item(const Item& item, int index)
    {
        switch (item.kind) {
        case Item::Kind::comment:
            if (!out_.empty())
                out_ += "\n";
            out_ += item.text;
            break;
        case Item::Kind::directive:
            out_ += wgsl() ? "" : "\n" + item.text;
            break;
        case Item::Kind::structure:
            gap(), print_structure(item);
            break;
        case Item::Kind::constant:
            for (const ShaderVariable& constant : item.variables) {
                const char* kind = wgsl() ? "const " : msl() ? "constant " : "static const ";
                line(kind + declared(constant, false) + " = " + print(constant.value[0]) + ";", item.comment);
            }
            break;
        case Item::Kind::prototype:
            if (hlsl())
                line(fmt::format("{} {}({});", word(item.type), item.text, parameters(item, index)));
            else
                line(fmt::format("// {}: in {}", signature(item, index),
                                 msl() ? "struct burnish_environment, which you define above this file" : "your shader"));
            break;
        case Item::Kind::function:
            gap(), print_function(item, index);
        }
    }

    // A comment above a declaration stands beside it, everything else an empty line apart.
    void gap()
    {
        const std::size_t last = out_.size() < 2 ? 0 : out_.rfind('\n', out_.size() - 2) + 1;
        if (out_.compare(last, 2, "//") != 0)
            out_ += "\n";
    }

    void print_structure(const Item& item)
    {
        line("struct " + item.text + " {", item.comment);
        ++depth_;
        for (const ShaderMember& member : item.members)
            line(declared(member.variable, false) + (wgsl() ? "," : ";"), member.comment);
        --depth_;
        line(wgsl() ? "}" : "};");
        if (!hlsl() || !made_.count(item.text))
            return;
        std::string values, fill;
        for (const ShaderMember& member : item.members) {
            values += (values.empty() ? "" : ", ") + declared(member.variable, false);
            fill += fmt::format("    made.{0} = {0};\n", own(member.variable.name));
        }
        out_ += fmt::format("\n{0} {0}_made({1})\n{{\n    {0} made;\n{2}    return made;\n}}\n", item.text, values, fill);
    }

    std::string parameters(const Item& item, int index)
    {
        std::string text = fetching_.count(index) ? msl()          ? "thread const burnish_environment& burnish_env"
                                                    : passes_cube_ ? "burnish_cube: texture_cube<f32>, burnish_taps: sampler"
                                                                   : ""
                                                  : "";
        for (const ShaderVariable& parameter : item.variables) {
            ShaderVariable p = parameter;
            if (wgsl() && assigned_.count(p.name))
                p.name += "_given";
            std::string one = declared(p, false);
            if (p.inout)
                one = wgsl()  ? fmt::format("{}: ptr<function, {}>", own(p.name), word(p.type))
                      : msl() ? fmt::format("thread {}& {}", word(p.type), own(p.name))
                              : "inout " + one;
            text += (text.empty() ? "" : ", ") + one;
        }
        return text;
    }

    std::string signature(const Item& item, int index)
    {
        if (wgsl())
            return fmt::format("fn {}({}){}", item.kind == Item::Kind::prototype ? item.text : function_name(index),
                               parameters(item, index), item.type == "void" ? "" : " -> " + word(item.type));
        const bool precise = hlsl() && (item.type == "float" || is_vector(item.type));
        const std::string name = item.kind == Item::Kind::prototype && msl() ? engine_name(item.text) : item.text;
        return fmt::format("{}{}{} {}({}){}", msl() && item.kind != Item::Kind::prototype ? "inline " : "", precise ? "precise " : "",
                           word(item.type), name, parameters(item, index), msl() && item.kind == Item::Kind::prototype ? " const" : "");
    }

    // Finds parameters that the function assigns, which WGSL forbids.
    void find_assigned(const Item& item)
    {
        assigned_.clear(), pointers_.clear();
        std::set<std::string> targets;
        find_targets(item.body, targets);
        for (const ShaderVariable& parameter : item.variables) {
            if (wgsl() && parameter.inout)
                pointers_.insert(parameter.name);
            else if (targets.count(parameter.name))
                assigned_.insert(parameter.name);
        }
    }

    static std::string root_of(const Expression& e)
    {
        return e.kind == Expression::Kind::name ? e.text : e.of.empty() ? "" : root_of(e.of[0]);
    }

    void find_targets(const std::vector<Statement>& list, std::set<std::string>& targets) const
    {
        for (const Statement& s : list) {
            if (s.kind == Statement::Kind::assign)
                targets.insert(root_of(s.expressions[0]));
            find_targets(s.body, targets), find_targets(s.otherwise, targets);
        }
        each_expression(list, [&](const Expression& e) {
            if (e.kind == Expression::Kind::call && e.function >= 0)
                for (std::size_t i = 0; i < e.of.size(); ++i)
                    if (tree_.items[static_cast<std::size_t>(e.function)].variables[i].inout)
                        targets.insert(root_of(e.of[i]));
        });
    }

    void print_function(const Item& item, int index)
    {
        find_assigned(item);
        copies_ = 0;
        line(signature(item, index));
        line("{");
        if (wgsl())
            for (const std::string& name : assigned_)
                line(fmt::format("    var {} = {}_given;", own(name), name));
        print_body(item.body);
        line("}");
        assigned_.clear(), pointers_.clear();
    }

    const ShaderTree& tree_;
    ShaderLanguage language_;
    std::set<std::string> engine_;              // functions that the engine provides
    bool passes_cube_;                          // functions that fetch take a cube and its sampler first
    std::set<int> fetching_;                    // functions that call the engine's, themselves or by others
    std::set<std::string> made_;                // structs made from their members' values
    std::set<std::string> assigned_, pointers_; // parameters of the function in hand
    std::vector<std::string> before_, after_;   // copies around the statement in hand
    int copies_ = 0;
    std::size_t depth_ = 0;
    std::string out_;
};

// Returns the text without `precise`, which OpenGL ES has from 3.20 on.
std::string essl_text(std::string text)
{
    const std::string word = "precise ";
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at))
        text.erase(at, word.size());
    return text;
}

} // namespace

std::string shader_text(const std::string& glsl, const std::string& language)
{
    if (language == "essl")
        return essl_text(glsl);
    const bool passes_cube = language == "wgsl-of-cube";
    BN_CHECK(language == "hlsl" || language == "msl" || language == "wgsl" || passes_cube);
    const ShaderLanguage kind = language == "hlsl" ? ShaderLanguage::hlsl : language == "msl" ? ShaderLanguage::msl : ShaderLanguage::wgsl;
    const ShaderTree tree = shader_tree_of(glsl);
    return ShaderPrinter(tree, kind, passes_cube).text();
}

} // namespace burnish
