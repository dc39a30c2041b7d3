#include "apps/report/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/check.h"
#include "core/base/text.h"

namespace burnish {

struct JsonWriter {
    nlohmann::ordered_json operator()(std::monostate) const { return nullptr; }
    nlohmann::ordered_json operator()(const Json::Items& items) const
    {
        nlohmann::ordered_json out = items.array ? nlohmann::ordered_json::array() : nlohmann::ordered_json::object();
        for (std::size_t i = 0; i < items.values.size(); ++i) {
            nlohmann::ordered_json value = std::visit(*this, items.values[i].value_);
            if (items.array)
                out.push_back(std::move(value));
            else
                out[items.keys[i]] = std::move(value);
        }
        return out;
    }
    template <class T> nlohmann::ordered_json operator()(const T& plain) const { return plain; }
};

Json Json::array(std::initializer_list<Json> items)
{
    Json json;
    json.value_ = Items{{}, items, true};
    return json;
}

Json Json::object()
{
    Json json;
    json.value_ = Items{};
    return json;
}

Json::Json(std::initializer_list<Member> members) : value_(Items{})
{
    for (const Member& member : members)
        (*this)[member.key] = member.value;
}

Json& Json::operator[](const std::string& key)
{
    if (std::holds_alternative<std::monostate>(value_))
        value_ = Items{};
    Items& items = std::get<Items>(value_);
    BN_CHECK(!items.array);
    for (std::size_t i = 0; i < items.keys.size(); ++i)
        if (items.keys[i] == key)
            return items.values[i];
    items.keys.push_back(key);
    return items.values.emplace_back();
}

void Json::push_back(Json item)
{
    Items& items = std::get<Items>(value_);
    BN_CHECK(items.array);
    items.values.push_back(std::move(item));
}

void Json::update(const Json& object)
{
    const Items& items = std::get<Items>(object.value_);
    for (std::size_t i = 0; i < items.keys.size(); ++i)
        (*this)[items.keys[i]] = items.values[i];
}

struct CsvWriter {
    std::vector<std::string> names;
    std::vector<std::vector<std::string>> lines; // columns, by name

    static std::string cell(std::string text)
    {
        if (text.find_first_of(",\"\r\n") == std::string::npos)
            return text;
        for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2))
            text.insert(at, 1, '"');
        return '"' + text + '"';
    }

    void put(const std::string& name, const Json& value)
    {
        if (const Json::Items* items = std::get_if<Json::Items>(&value.value_)) {
            for (std::size_t i = 0; i < items->values.size() && !items->array; ++i)
                put(name.empty() ? items->keys[i] : name + "." + items->keys[i], items->values[i]);
            return;
        }
        std::size_t at = 0;
        while (at < names.size() && names[at] != name)
            ++at;
        if (at == names.size())
            names.push_back(name);
        lines.back().resize(std::max(lines.back().size(), at + 1));
        const std::string* text = std::get_if<std::string>(&value.value_);
        const bool nothing = std::holds_alternative<std::monostate>(value.value_);
        const std::string dumped = nothing ? "" : text ? printable(*text) : value.dump(-1);
        lines.back()[at] = cell(dumped == "null" ? "" : dumped); // NaN and infinities
    }
};

std::string Json::csv() const
{
    CsvWriter writer;
    for (const Json& row : std::get<Items>(value_).values) {
        writer.lines.emplace_back();
        writer.put("", row);
    }
    const auto joined = [&](const std::vector<std::string>& cells) {
        std::string line;
        for (std::size_t i = 0; i < writer.names.size(); ++i)
            line += (i ? "," : "") + (i < cells.size() ? cells[i] : "");
        return line + "\n";
    };
    std::string out = joined(writer.names);
    for (const std::vector<std::string>& line : writer.lines)
        out += joined(line);
    return out;
}

std::string Json::dump(int indent) const
{
    // Escapes non-ASCII characters: names come from files, and the text may go to a terminal.
    return std::visit(JsonWriter(), value_).dump(indent, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
}

} // namespace burnish
