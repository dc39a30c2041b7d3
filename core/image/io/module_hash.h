// Hash of a module's loaded bytes: its segments without the file header. Stripping symbols keeps the hash; any other
// change alters it. The build records the hash, and the program opens no module with another hash.
#pragma once
#include <elf.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "core/base/hash.h"

namespace burnish {

// Returns nothing for a file that is not 64-bit ELF or ends before its segments: mapping such a file would end the
// process.
inline std::optional<std::uint64_t> module_hash(const std::vector<std::uint8_t>& file)
{
    Elf64_Ehdr header;
    if (file.size() < sizeof(header))
        return std::nullopt;
    std::memcpy(&header, file.data(), sizeof(header));
    const std::uint64_t table = header.e_phoff, entries = header.e_phnum;
    if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_phentsize != sizeof(Elf64_Phdr) || table > file.size() ||
        entries * sizeof(Elf64_Phdr) > file.size() - table)
        return std::nullopt;
    std::uint64_t hash = 0;
    for (std::uint64_t i = 0; i < entries; ++i) {
        Elf64_Phdr segment;
        std::memcpy(&segment, file.data() + table + i * sizeof(segment), sizeof(segment));
        if (segment.p_offset > file.size() || segment.p_filesz > file.size() - segment.p_offset)
            return std::nullopt;
        if (segment.p_type != PT_LOAD)
            continue;
        const std::uint64_t skip = segment.p_offset < sizeof(header) ? sizeof(header) - segment.p_offset : 0;
        if (segment.p_filesz > skip)
            hash = hash_bytes(file.data() + segment.p_offset + skip, segment.p_filesz - skip, hash);
    }
    return hash;
}

} // namespace burnish
