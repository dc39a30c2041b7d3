// Option texts to values, one after another.
#pragma once
#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/parse.h"
#include "apps/report.h"
#include "core/base/result.h"

namespace burnish {

// Reads options one after another and remembers the first that is wrong; empty texts leave the default alone.
class OptionReader {
  public:
    template <class T>
    void integer(const std::string& option, const std::string& text, std::int64_t low, std::int64_t high,
                 T& into)
    {
        if (!text.empty())
            take(parse_integer(option, text, low, high), into);
    }
    void number(const std::string& option, const std::string& text, double low, double high, float& into)
    {
        if (!text.empty())
            take(parse_number(option, text, low, high), into);
    }
    void bytes(const std::string& option, const std::string& text, std::uint64_t& into)
    {
        if (!text.empty())
            take(parse_bytes(option, text), into);
    }
    void vec3(const std::string& option, const std::string& text, std::optional<glm::vec3>& into)
    {
        if (text.empty())
            return;
        Result<glm::vec3> value = parse_vec3(option, text);
        if (value)
            into = *value;
        else
            refuse(value.error());
    }
    // One of a few numbers.
    void choice(const std::string& option, const std::string& text, const std::vector<std::string>& valid,
                int& into)
    {
        if (text.empty())
            return;
        if (std::find(valid.begin(), valid.end(), text) == valid.end())
            refuse(usage_error(option, fmt::format("'{}' is not one of {}", text, join(valid))));
        else
            integer(option, text, 0, 1 << 30, into);
    }
    void refuse(const Error& error)
    {
        if (status_)
            status_ = error;
    }
    const Status& status() const { return status_; }

  private:
    template <class Value, class T> void take(const Result<Value>& value, T& into)
    {
        if (value)
            into = static_cast<T>(*value);
        else
            refuse(value.error());
    }

    Status status_;
};

} // namespace burnish
