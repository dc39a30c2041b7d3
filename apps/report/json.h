// JSON to be written: values in the order in which they were put in. One source file knows the JSON library.
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/text.h"

namespace burnish {

class Json {
  public:
    struct Member;

    Json() = default; // null
    Json(bool value) : value_(value) {}
    template <std::signed_integral T> Json(T value) : value_(static_cast<std::int64_t>(value)) {}
    template <std::unsigned_integral T> Json(T value) : value_(static_cast<std::uint64_t>(value)) {}
    Json(double value) : value_(value) {} // NaN and infinities become null
    Json(float value) : value_(shortest_decimal(value)) {}
    Json(std::nullptr_t) {}
    Json(const char* text) : value_(std::string(text)) {}
    Json(std::string text) : value_(std::move(text)) {}
    Json(std::initializer_list<Member> members); // an object
    template <class T> Json(const std::vector<T>& values) : Json(array())
    {
        for (const T& value : values)
            push_back(value);
    }
    template <class T> Json(const std::optional<T>& value)
    {
        if (value)
            *this = Json(*value);
    }
    static Json array(std::initializer_list<Json> items = {});
    static Json object();

    Json& operator[](const std::string& key); // of an object, which null becomes; added where it is not there
    void push_back(Json item);                // of an array
    void update(const Json& object);          // with the other's members

    // Lines indented by so many spaces a level; -1: all on one line. What is not UTF-8 in a text is replaced: file names are bytes to the
    // operating system.
    std::string dump(int indent) const;

    // Of an array of objects: a line of names, then one an object, by commas (RFC 4180). Members of objects in them are named a.b; arrays
    // and what is null are left out.
    std::string csv() const;

  private:
    friend struct JsonWriter;
    friend struct CsvWriter;
    struct Items {
        std::vector<std::string> keys; // of an object
        std::vector<Json> values;
        bool array = false;
    };
    std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, Items> value_;
};

struct Json::Member {
    const char* key;
    Json value;
};

} // namespace burnish
