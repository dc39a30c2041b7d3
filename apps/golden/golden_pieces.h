// Rows of a manifest as pieces, for many processes: a piece is a row's result, with the row's files.
#pragma once
#include <string>
#include <vector>

#include "apps/golden/check.h"
#include "apps/golden/manifest.h"
#include "apps/pieces/pieces.h"

namespace burnish {

// Returns a piece a row. Manifest, setting and jobs must outlive the pieces; setting.results is not used.
// A row's key covers its members and the limits on input. It covers the content of files: golden, mask, a picture that is there, a scene's
// files, files of options, and files that a program's words name. A failed row is a piece too, unless the machine may be the cause. Such
// causes are a full disk, and a program that is missing, is killed from outside or takes too long. Errors: scenes and lights that cannot be
// read.
Result<std::vector<JobPiece>> golden_pieces(const GoldenManifest& manifest, const GoldenSetting& setting, const Jobs& jobs);

// Returns the results of finished pieces, in the manifest's order, and puts their files into a results' folder.
Result<std::vector<GoldenResult>> take_golden_pieces(const GoldenManifest& manifest, const std::vector<std::string>& files,
                                                     const std::vector<JobPiece>& pieces, const std::string& folder);

} // namespace burnish
