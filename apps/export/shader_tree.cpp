#include "apps/export/shader_tree.h"

#include <cctype>
#include <charconv>
#include <fmt/core.h>

#include "core/base/check.h"

namespace burnish {
namespace {

using Expression = ShaderExpression;
using Statement = ShaderStatement;

struct ShaderToken {
    enum class Kind { word, number, mark, comment, directive, blank, end };
    Kind kind = Kind::end;
    std::string text;
    int line = 0;
};

bool starts_word(char c)
{
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}

[[noreturn]] void not_understood(const std::string& text, const std::string& wanted, int line)
{
    throw CheckFailed(fmt::format("an exported shader's line {}: '{}' in the place of {}", line + 1, text, wanted));
}

// Returns the length of the number at `at`, with its exponent and suffix.
std::size_t number_length(const std::string& text, std::size_t at)
{
    const bool hexadecimal = text.compare(at, 2, "0x") == 0;
    std::size_t end = at;
    while (end < text.size()) {
        const char c = text[end];
        const bool exponent_sign = !hexadecimal && (c == '-' || c == '+') && end > at && (text[end - 1] == 'e' || text[end - 1] == 'E');
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && !exponent_sign)
            break;
        ++end;
    }
    return end - at;
}

std::vector<ShaderToken> shader_tokens(const std::string& text)
{
    static const char* const kMarks[] = {"<<", ">>", "<=", ">=", "==", "!=", "&&", "||", "++", "--", "+=", "-=", "*=", "/="};
    using Kind = ShaderToken::Kind;
    std::vector<ShaderToken> tokens;
    int line = 0, newlines = 0;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        std::size_t length = 1;
        Kind kind = Kind::mark;
        if (c == '\n') {
            ++line, ++at;
            if (++newlines == 2)
                tokens.push_back({Kind::blank, "", -1});
            continue;
        }
        if (std::isspace(static_cast<unsigned char>(c))) {
            ++at;
            continue;
        }
        newlines = 0;
        if (c == '#' || text.compare(at, 2, "//") == 0) {
            length = std::min(text.find('\n', at), text.size()) - at;
            kind = c == '#' ? Kind::directive : Kind::comment;
        } else if (starts_word(c)) {
            while (at + length < text.size() &&
                   (starts_word(text[at + length]) || std::isdigit(static_cast<unsigned char>(text[at + length]))))
                ++length;
            kind = Kind::word;
        } else if (std::isdigit(static_cast<unsigned char>(c))) {
            length = number_length(text, at);
            kind = Kind::number;
        } else {
            for (const char* const mark : kMarks)
                if (text.compare(at, 2, mark) == 0)
                    length = 2;
        }
        tokens.push_back({kind, text.substr(at, length), line});
        at += length;
    }
    tokens.push_back({Kind::end, "", line + 1});
    return tokens;
}

// Returns the binding strength of a binary operator, 0 for other marks: C's order.
int strength_of(const std::string& mark)
{
    static const std::map<std::string, int> kStrengths = {{"||", 1}, {"&&", 2}, {"|", 3}, {"^", 4},  {"&", 5},  {"==", 6},
                                                          {"!=", 6}, {"<", 7},  {">", 7}, {"<=", 7}, {">=", 7}, {"<<", 8},
                                                          {">>", 8}, {"+", 9},  {"-", 9}, {"*", 10}, {"/", 10}, {"%", 10}};
    const auto at = kStrengths.find(mark);
    return at == kStrengths.end() ? 0 : at->second;
}

class ShaderParser {
  public:
    explicit ShaderParser(const std::string& text) : tokens_(shader_tokens(text)) {}

    ShaderTree read()
    {
        while (!at_end())
            read_item();
        return std::move(tree_);
    }

  private:
    using Kind = ShaderToken::Kind;

    const ShaderToken& now() const { return tokens_[at_]; }
    bool at_end() const { return now().kind == Kind::end; }
    bool is(const char* text) const { return now().text == text && now().kind != Kind::comment; }

    const ShaderToken& next()
    {
        const ShaderToken& token = tokens_[at_++];
        while (now().kind == Kind::blank)
            ++at_;
        return token;
    }

    bool skip(const char* text)
    {
        if (!is(text))
            return false;
        next();
        return true;
    }

    void expect(const char* text)
    {
        if (!skip(text))
            not_understood(now().text, text, now().line);
    }

    // Takes a comment on the line of the token before.
    std::string beside() { return now().kind == Kind::comment && at_ > 0 && tokens_[at_ - 1].line == now().line ? next().text : ""; }

    std::string type_name()
    {
        skip("precise");
        if (now().kind != Kind::word)
            not_understood(now().text, "a type", now().line);
        return next().text;
    }

    // The outermost scope

    void read_item()
    {
        ShaderItem item;
        if (now().kind == Kind::blank) {
            ++at_;
            return;
        }
        if (now().kind == Kind::comment || now().kind == Kind::directive) {
            const Kind kind = now().kind;
            item.kind = kind == Kind::comment ? ShaderItem::Kind::comment : ShaderItem::Kind::directive;
            for (; now().kind == kind; ++at_)
                item.text += now().text + "\n";
            tree_.items.push_back(item);
            return;
        }
        if (skip("struct"))
            read_structure(item);
        else if (skip("const"))
            read_constants(item);
        else
            read_function(item);
        item.comment = item.comment.empty() ? beside() : item.comment;
        tree_.items.push_back(std::move(item));
    }

    void read_structure(ShaderItem& item)
    {
        item.kind = ShaderItem::Kind::structure, item.text = next().text;
        expect("{");
        item.comment = beside();
        while (!is("}")) {
            if (now().kind == Kind::comment) { // above a member
                next();
                continue;
            }
            const std::string type = type_name();
            do {
                item.members.push_back({variable_of(type), ""});
            } while (skip(","));
            expect(";");
            item.members.back().comment = beside();
        }
        expect("}"), expect(";");
        tree_.structures[item.text] = static_cast<int>(tree_.items.size());
    }

    // Reads a number of elements.
    int size_of_array()
    {
        constexpr int kMostElements = 1 << 18;
        const ShaderToken token = next();
        int size = 0;
        const char* const end = token.text.data() + token.text.size();
        if (const auto read = std::from_chars(token.text.data(), end, size);
            read.ec != std::errc() || read.ptr != end || size < 1 || size > kMostElements)
            not_understood(token.text, "a number of elements", token.line);
        return size;
    }

    // Reads a name with the size of an array, if any.
    ShaderVariable variable_of(const std::string& type)
    {
        ShaderVariable variable;
        variable.type = type, variable.name = next().text;
        if (skip("[")) {
            variable.count = size_of_array();
            variable.type += "[]";
            expect("]");
        }
        return variable;
    }

    void read_constants(ShaderItem& item)
    {
        item.kind = ShaderItem::Kind::constant, item.type = type_name();
        do {
            ShaderVariable constant = variable_of(item.type);
            expect("=");
            constant.value = {expression()};
            types_.back()[constant.name] = constant.type;
            item.variables.push_back(std::move(constant));
        } while (skip(","));
        item.text = item.variables[0].name;
        expect(";");
    }

    void read_function(ShaderItem& item)
    {
        item.type = type_name(), item.text = next().text;
        expect("(");
        types_.emplace_back();
        while (!is(")")) {
            const bool inout = skip("inout");
            const std::string type = type_name();
            ShaderVariable parameter;
            if (is(",") || is(")")) // a parameter without a name
                parameter.type = type, parameter.name = fmt::format("unused{}", item.variables.size());
            else
                parameter = variable_of(type);
            parameter.inout = inout;
            types_.back()[parameter.name] = parameter.type;
            item.variables.push_back(std::move(parameter));
            skip(",");
        }
        expect(")");
        item.kind = is(";") ? ShaderItem::Kind::prototype : ShaderItem::Kind::function;
        int index = static_cast<int>(tree_.items.size());
        tree_.functions[item.text].push_back(index);
        signatures_[index] = {item.type, item.variables};
        if (!skip(";"))
            item.body = block();
        types_.pop_back();
    }

    // Statements

    std::vector<Statement> block()
    {
        std::vector<Statement> list;
        expect("{");
        types_.emplace_back();
        std::vector<std::string> comments;
        while (!is("}")) {
            if (now().kind == Kind::comment) {
                comments.push_back(next().text);
                continue;
            }
            if (skip(";"))
                continue;
            Statement statement = read_statement();
            statement.comments.insert(statement.comments.begin(), comments.begin(), comments.end());
            comments.clear();
            if (statement.beside.empty())
                statement.beside = beside();
            list.push_back(std::move(statement));
        }
        types_.pop_back();
        expect("}");
        return list;
    }

    std::vector<Statement> body_of(Statement& owner)
    {
        const std::string said = beside();
        if (!said.empty())
            owner.comments.push_back(said);
        while (now().kind == Kind::comment)
            owner.comments.push_back(next().text);
        if (is("{"))
            return block();
        return {read_statement()};
    }

    Statement read_statement()
    {
        Statement s;
        if (is("{")) {
            s.body = block();
        } else if (skip("if")) {
            s.kind = Statement::Kind::branch;
            expect("("), s.expressions = {expression()}, expect(")");
            s.body = body_of(s);
            if (skip("else"))
                s.otherwise = body_of(s);
        } else if (skip("for")) {
            s.kind = Statement::Kind::loop;
            types_.emplace_back();
            expect("("), s.variables = declared(type_name()), expect(";");
            s.expressions = {expression()};
            expect(";"), expect("++"), expect(s.variables[0].name.c_str()), expect(")");
            s.body = body_of(s);
            types_.pop_back();
        } else if (skip("return")) {
            s.kind = Statement::Kind::result;
            if (!is(";"))
                s.expressions = {expression()};
            expect(";");
        } else if (declares()) {
            s.kind = Statement::Kind::declare;
            s.variables = declared(type_name());
            expect(";");
        } else {
            s.expressions = {expression()};
            s.kind = Statement::Kind::call;
            if (skip("=")) {
                s.kind = Statement::Kind::assign;
                s.expressions.push_back(expression());
            }
            expect(";");
        }
        return s;
    }

    bool declares() const { return is("precise") || (now().kind == Kind::word && tokens_[at_ + 1].kind == Kind::word); }

    std::vector<ShaderVariable> declared(const std::string& type)
    {
        std::vector<ShaderVariable> list;
        do {
            ShaderVariable variable = variable_of(type);
            if (skip("="))
                variable.value = {expression()};
            types_.back()[variable.name] = variable.type;
            list.push_back(std::move(variable));
        } while (skip(","));
        return list;
    }

    // Expressions

    Expression expression()
    {
        Expression condition = binary(1);
        if (!skip("?"))
            return condition;
        Expression e;
        e.kind = Expression::Kind::choice, e.of.push_back(std::move(condition));
        e.of.push_back(expression()), expect(":"), e.of.push_back(expression());
        e.type = e.of[1].type;
        return e;
    }

    Expression binary(int least)
    {
        Expression left = unary();
        while (true) {
            while (now().kind == Kind::comment)
                next();
            const std::string mark = now().kind == Kind::mark ? now().text : "";
            const int strength = strength_of(mark);
            if (strength == 0 || strength < least)
                return left;
            next();
            Expression e;
            e.kind = Expression::Kind::binary, e.text = mark;
            e.of = {std::move(left), binary(strength + 1)};
            e.type = strength <= 2 || strength == 6 || strength == 7 ? "bool"
                     : shader_vector_size(e.of[1].type) > 0          ? e.of[1].type
                                                                     : e.of[0].type;
            left = std::move(e);
        }
    }

    Expression unary()
    {
        for (const char* const mark : {"-", "!", "~"})
            if (skip(mark)) {
                Expression e;
                e.kind = Expression::Kind::unary, e.text = mark, e.of = {unary()};
                e.type = e.of[0].type;
                return e;
            }
        return postfix();
    }

    Expression postfix()
    {
        Expression e = primary();
        while (is(".") || is("[")) {
            Expression outer;
            if (skip(".")) {
                outer.kind = Expression::Kind::member, outer.text = next().text;
                outer.type = member_type(e.type, outer.text);
                outer.of = {std::move(e)};
            } else {
                next();
                outer.kind = Expression::Kind::index;
                outer.type = shader_vector_size(e.type) > 0 ? "float" : e.type.substr(0, e.type.size() - 2);
                outer.of = {std::move(e), expression()};
                expect("]");
            }
            e = std::move(outer);
        }
        return e;
    }

    std::string member_type(const std::string& of, const std::string& name) const
    {
        if (shader_vector_size(of) > 0)
            return name.size() == 1 ? "float" : "vec" + std::to_string(name.size());
        const auto structure = tree_.structures.find(of);
        BN_CHECK(structure != tree_.structures.end());
        for (const ShaderMember& member : tree_.items[static_cast<std::size_t>(structure->second)].members)
            if (member.variable.name == name)
                return member.variable.type;
        not_understood(name, "a member", now().line);
    }

    Expression primary()
    {
        if (skip("(")) {
            Expression e = expression();
            expect(")");
            return e;
        }
        Expression e;
        const bool number = now().kind == Kind::number;
        e.text = next().text;
        if (e.text == "true" || e.text == "false") {
            e.type = "bool";
            return e;
        }
        if (number) {
            const bool hexadecimal = e.text.compare(0, 2, "0x") == 0;
            e.type = !hexadecimal && e.text.find_first_of(".eEf") != std::string::npos ? "float" : "int";
            if (e.type == "float" && e.text.back() == 'f')
                e.text.pop_back();
            return e;
        }
        int count = 0;
        if (is("[") && shader_vector_size(e.text) > 0) { // an array's elements
            next(), count = size_of_array(), expect("]");
            e.text += "[]";
        }
        if (!is("(")) {
            e.kind = Expression::Kind::name, e.type = type_of(e.text);
            return e;
        }
        next();
        e.kind = Expression::Kind::call;
        while (!is(")")) {
            e.of.push_back(expression());
            skip(",");
        }
        BN_CHECK(count == 0 || e.of.size() == static_cast<std::size_t>(count));
        expect(")");
        resolve(e);
        return e;
    }

    std::string type_of(const std::string& name) const
    {
        for (auto scope = types_.rbegin(); scope != types_.rend(); ++scope)
            if (const auto at = scope->find(name); at != scope->end())
                return at->second;
        not_understood(name, "a declared name", now().line);
    }

    // Finds the function that a call means, and its type.
    void resolve(Expression& e) const
    {
        static const std::map<std::string, std::string> kBuiltIn = {
            {"intBitsToFloat", "float"}, {"floatBitsToInt", "int"}, {"dot", "float"}};
        if (const auto named = tree_.functions.find(e.text); named != tree_.functions.end()) {
            for (const int index : named->second) {
                const auto& [type, parameters] = signatures_.at(index);
                bool same = parameters.size() == e.of.size();
                for (std::size_t i = 0; same && i < e.of.size(); ++i)
                    same = parameters[i].type == e.of[i].type;
                if (same) {
                    e.function = index, e.type = type;
                    return;
                }
            }
            not_understood(e.text, "a function with these parameters", now().line);
        }
        const auto known = kBuiltIn.find(e.text);
        const bool makes = e.text == "float" || e.text == "int" || e.text == "uint" || e.text == "bool" || e.text.back() == ']' ||
                           shader_vector_size(e.text) > 0 || tree_.structures.count(e.text);
        e.type = known != kBuiltIn.end() ? known->second : makes ? e.text : e.of.at(0).type;
    }

    struct Signature {
        std::string type;
        std::vector<ShaderVariable> parameters;
    };

    std::vector<ShaderToken> tokens_;
    std::size_t at_ = 0;
    ShaderTree tree_;
    std::map<int, Signature> signatures_;                      // by item
    std::vector<std::map<std::string, std::string>> types_{1}; // of names, by scope
};

} // namespace

int shader_vector_size(const std::string& type)
{
    return type.size() == 4 && type.compare(0, 3, "vec") == 0 ? type[3] - '0' : 0;
}

ShaderTree shader_tree_of(const std::string& glsl)
{
    return ShaderParser(glsl).read();
}

} // namespace burnish
