// JSON and CSV texts of reports. Members keep the order in which they were put in. Files that make values include <nlohmann/json.hpp>.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace burnish {

using Json = nlohmann::ordered_json; // floats go into it by shortest_decimal(), so that .1f is 0.1

// Writes lines indented by so many spaces a level; -1: all on one line. Bytes of a text that are not UTF-8 are replaced: file names are
// bytes to the operating system. NaN and infinities become null.
std::string json_text(const Json& json, int indent);

// Returns an array of objects as CSV (RFC 4180): a line of names, then a line an object. Inner members are named a.b. Arrays and null are
// left out.
std::string csv_text(const Json& rows);

} // namespace burnish
