#include "apps/report/json.h"

#include <nlohmann/json.hpp>

#include "core/base/check.h"

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

std::string Json::dump(int indent) const
{
    return std::visit(JsonWriter(), value_).dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

} // namespace burnish
