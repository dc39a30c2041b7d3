// JSON for output: members keep insertion order. Only json.cpp includes the JSON library.
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

    Json& operator[](const std::string& key); // of an object, or null, which becomes one; adds a missing key
    void push_back(Json item);                // to an array
    void update(const Json& object);          // adds or replaces the members of `object`

    // Returns text with `indent` spaces a level; -1: one line. Replaces invalid UTF-8: file names are bytes to the operating system.
    std::string dump(int indent) const;

    // Returns CSV for an array of objects: a header line, then one line an object, with commas (RFC 4180). Nested members are named
    // a.b; arrays and null are left out.
    std::string csv() const;

  private:
    friend struct JsonWriter;
    friend struct CsvWriter;
    struct Items {
        std::vector<std::string> keys; // for objects
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
