// What of a module is loaded, as a number: its segments' bytes, without the file header. Symbols may be stripped from it, anything else
// changes it. Used by the build, which writes the number down, and by the program, which opens no module that has another.
#pragma once
#include <elf.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "core/base/hash.h"

namespace burnish {

// Nothing where the file is no 64-bit ELF file or ends before its segments do: mapping it would end the process.
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
