// What is measured of an entry, as JSON: kept in DIR, from which a stopped atlas goes on, and in atlas.json.
#pragma once
#include <string>

#include "apps/lab/atlas/judge.h"
#include "apps/report/json.h"

namespace burnish {

struct AtlasResult {
    const AtlasEntry* entry = nullptr;
    MeasuredEntry measured;
    Judged judged;
    std::string strip; // file of the pictures, as the page names it; empty: none
};

// Of everything that decides what an entry measures: the program's own bytes, the entry's line and the walk.
std::string entry_key(const AtlasEntry& entry, const AtlasWalk& walk);

std::string kept_entry_json(const MeasuredEntry& measured, const std::string& key);
// Nothing where the text holds another key, or nothing of the kind.
std::optional<MeasuredEntry> parse_kept_entry(const std::string& text, const std::string& key);

Json atlas_json(const std::vector<AtlasResult>& results, const AtlasWalk& walk);

std::string path_text(const AtlasEntry& entry);    // "anisotropy=0:0.9", and that it goes by factors
std::string truth_text(const AtlasEntry& entry);   // what it is compared with
std::string measure_text(const AtlasEntry& entry); // what the figures are

} // namespace burnish
