// Pieces of a reference picture: some blocks of pixels each, in rows; many passes of one block are several pieces.
#pragma once
#include <vector>

#include "apps/options/options.h"
#include "apps/pieces/pieces.h"
#include "raster/session/session.h"

namespace burnish {

// Returns the picture's pieces. options.reference.part is the session's own; session and options must outlive the pieces.
std::vector<JobPiece> reference_pieces(const RenderOptions& options, const FrameDesc& desc, Session& session);

// Reads finished pieces into options.reference.part, which the next render() takes over.
Status take_reference_pieces(const RenderOptions& options, const std::vector<std::string>& files, const std::vector<JobPiece>& pieces);

} // namespace burnish
