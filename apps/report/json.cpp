#include "apps/report/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/base/text.h"

namespace burnish {
namespace {

struct CsvWriter {
    std::vector<std::string> names;
    std::vector<std::vector<std::string>> lines; // columns, by name

    static std::string cell(std::string text)
    {
        if (text.find_first_of(",\"\r\n") == std::string::npos && text.find("::") == std::string::npos) // GitHub obeys "::"
            return text;
        for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2))
            text.insert(at, 1, '"');
        return '"' + text + '"';
    }

    void put(const std::string& name, const Json& value)
    {
        if (value.is_object())
            for (const auto& [key, member] : value.items())
                put(name.empty() ? key : name + "." + key, member);
        if (value.is_structured())
            return;
        std::size_t at = 0;
        while (at < names.size() && names[at] != name)
            ++at;
        if (at == names.size())
            names.push_back(name);
        lines.back().resize(std::max(lines.back().size(), at + 1));
        const std::string* text = value.get_ptr<const std::string*>();
        const std::string dumped = text ? printable(*text) : json_text(value, -1);
        lines.back()[at] = cell(!text && dumped == "null" ? "" : dumped); // NaN and infinities too
    }
};

} // namespace

std::string csv_text(const Json& rows)
{
    CsvWriter writer;
    for (const Json& row : rows) {
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

std::string json_text(const Json& json, int indent)
{
    // Escaped beyond ASCII: names come from files, and the text may go to a terminal.
    std::string text = json.dump(indent, ' ', true, Json::error_handler_t::replace);
    // GitHub obeys "##[" anywhere in a step's output. Only strings hold a '#'.
    for (std::size_t at = text.find("##["); at != std::string::npos; at = text.find("##[", at))
        text.replace(at + 1, 1, "\\u0023");
    return text;
}

} // namespace burnish
