// libFuzzer entry: any text as the atlas' golden table, and as a cached entry whose key is the first line.
#include <string>

#include "apps/lab/atlas/judge.h"
#include "apps/lab/atlas/result_cache.h"
#include "core/base/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    const std::string text(data, data + size);
    if (const Result<GoldenTable> table = parse_table(text, "fuzz")) {
        const Result<GoldenTable> again = parse_table(table_text(*table), "fuzz"); // without rows that lack an entry
        BN_CHECK(again);
        const std::string written = table_text(*again);
        const Result<GoldenTable> third = parse_table(written, "fuzz");
        BN_CHECK(third && (table->version != kTableVersion || table_text(*third) == written));
    } else {
        BN_CHECK(!table.error().reason.empty());
    }
    const std::size_t line = text.find('\n');
    if (line == std::string::npos)
        return 0;
    const std::string key = text.substr(0, line);
    if (const std::optional<MeasuredEntry> kept = parse_cached_entry(text.substr(line + 1), key)) {
        const std::optional<MeasuredEntry> again = parse_cached_entry(cached_entry_json(*kept, key), key);
        BN_CHECK(again && again->id == kept->id && again->steps.size() == kept->steps.size());
    }
    return 0;
}
