// Measurements of an entry as JSON: cached in DIR to resume a stopped atlas, and written to atlas.json.
#pragma once
#include <string>

#include "apps/lab/atlas/judge.h"
#include "apps/report/json.h"

namespace burnish {

struct AtlasResult {
    const AtlasEntry* entry = nullptr;
    MeasuredEntry measured;
    Judged judged;
    std::string strip; // file name of the pictures in the page; empty: none
};

// Hashes all inputs of an entry's measurements: the executable's bytes, the entry's line and the walk.
std::string entry_key(const AtlasEntry& entry, const AtlasWalk& walk);

std::string cached_entry_json(const MeasuredEntry& measured, const std::string& key);
// Returns none if the text holds another key or is invalid.
std::optional<MeasuredEntry> parse_cached_entry(const std::string& text, const std::string& key);

Json atlas_json(const std::vector<AtlasResult>& results, const AtlasWalk& walk);

std::string path_text(const AtlasEntry& entry);      // "anisotropy=0:0.9", with a note for geometric paths
std::string reference_text(const AtlasEntry& entry); // describes the reference
std::string measure_text(const AtlasEntry& entry);   // describes the metric

} // namespace burnish
