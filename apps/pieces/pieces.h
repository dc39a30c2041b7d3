// Long jobs in pieces, for processes that share a folder: on one machine, under a cluster's engine, or in a CI matrix. The key of a piece
// is the hash of all that decides its content, so equal pieces of two jobs are one. A piece appears complete or not at all. A merge puts
// the pieces together to the files that one process writes.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "apps/cli/report.h"

namespace burnish {

struct PieceOptions {
    bool list = false, take = false, merge = false;
    std::string shard, piece;         // a share, or one piece's key
    std::vector<std::string> folders; // of the pieces; several for a merge
};

std::vector<Option> piece_options(PieceOptions& to);
bool any_pieces(const PieceOptions& o);
// Checks the options before any file is opened.
Status check_piece_options(const PieceOptions& o);

struct JobPiece {
    std::string key;                                // 16 hexadecimal digits
    std::function<Result<double>()> seconds;        // estimated time on this machine, s
    std::function<Status(const std::string&)> make; // writes this file, atomically; nothing where a signal stopped the process
};

// Returns the key of a piece from the text of all that decides its content. The program's build joins it.
std::string piece_key(const std::string& text);
// Returns a name beside a piece's that no other process uses, for a file in the making. A merge sweeps the names of dead processes.
std::string own_name_beside(const std::string& file, const std::string& extension);

// Lists pieces, or makes those that the options name. Returns the exit code. words: the command, from its subcommand on.
int run_pieces(const PieceOptions& options, const std::vector<std::string>& words, const std::vector<JobPiece>& pieces, Report& report);

// Returns the pieces' files, in order, and sweeps files that dead processes left. Where some are missing, prints a command for each on
// standard output; the error has ExitCode::golden_missing.
Result<std::vector<std::string>> finished_pieces(const PieceOptions& options, const std::vector<std::string>& words,
                                                 const std::vector<JobPiece>& pieces);

// Writes a piece: `content` behind the version, the key, a hash and a size. read_piece() refuses damage, and pieces of another version by
// name.
Status write_piece(const std::string& file, const std::string& key, const std::vector<std::uint8_t>& content);
Result<std::vector<std::uint8_t>> read_piece(const std::string& file, const std::string& key);

// Returns the command that a folder's pieces belong to, from its subcommand on. Errors: no job, several, or of another build.
Result<std::vector<std::string>> job_of(const std::vector<std::string>& folders);

} // namespace burnish
