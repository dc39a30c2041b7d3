// An exported shader's tree: declarations, statements and typed expressions, read from the GLSL that glsl_of() returns.
// Covers the GLSL subset that the kernel language uses (shading/lang/lang.h): no matrices, textures or while loops.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace burnish {

struct ShaderExpression {
    enum class Kind { number, name, call, member, index, unary, binary, choice };
    Kind kind = Kind::number;
    std::string text; // the literal, name, function, type, member or operator
    std::string type; // in GLSL's words, such as vec3, or a struct's name; arrays end with []
    std::vector<ShaderExpression> of;
    int function = -1; // call: the called function's index in the tree; -1: built in, or makes a type's value
};

struct ShaderVariable {
    std::string type, name;
    int count = 0; // an array's elements; 0: no array
    bool inout = false;
    std::vector<ShaderExpression> value; // none or one
};

struct ShaderStatement {
    enum class Kind { declare, assign, call, branch, loop, result, block };
    Kind kind = Kind::block;
    std::vector<std::string> comments;         // lines above
    std::string beside;                        // a comment on the same line
    std::vector<ShaderVariable> variables;     // declare; loop: its counter
    std::vector<ShaderExpression> expressions; // assign: target and value; branch, loop: condition; call, result: value, or none
    std::vector<ShaderStatement> body, otherwise;
};

struct ShaderMember {
    ShaderVariable variable;
    std::string comment; // beside
};

struct ShaderItem { // in the outermost scope
    enum class Kind { comment, directive, structure, constant, prototype, function };
    Kind kind = Kind::comment;
    std::string text;    // the comment's or directive's lines; other kinds' name; a function's comments stand above as items
    std::string type;    // a function result's, or a constant's
    std::string comment; // beside
    std::vector<ShaderMember> members;
    std::vector<ShaderVariable> variables; // parameters, or constants with one type
    std::vector<ShaderStatement> body;
};

struct ShaderTree {
    std::vector<ShaderItem> items;
    std::map<std::string, std::vector<int>> functions; // item indices by name: overloads
    std::map<std::string, int> structures;
};

// Returns the tree for a text from glsl_of(). Throws CheckFailed at words outside the subset.
ShaderTree shader_tree_of(const std::string& glsl);

// Returns a built-in vector's component count, 0 for other types.
int shader_vector_size(const std::string& type);

} // namespace burnish
