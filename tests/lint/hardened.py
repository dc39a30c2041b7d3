#!/usr/bin/env python3
"""lint.elf: checks in the finished files that the build's hardening is there.

Usage: hardened.py FILE...   programs and shared libraries for 64-bit little-endian machines

Full RELRO (symbols are bound at the start and then read-only), no executable stack, position-independent code, stack protection, checked
functions of the C library, and on x86-64 an endbr64 wherever an indirect call may land.
"""

import re
import struct
import sys

PT_LOAD, PT_DYNAMIC, PT_GNU_STACK, PT_GNU_RELRO = 1, 2, 0x6474E551, 0x6474E552
DT_FLAGS, DT_FLAGS_1, DF_BIND_NOW, DF_1_NOW, DF_1_PIE = 30, 0x6FFFFFFB, 8, 1, 0x08000000
SHT_SYMTAB, SHT_DYNSYM, STT_FUNC, STB_LOCAL = 2, 11, 2, 0
EM_X86_64 = 62
ENDBR64 = b"\xf3\x0f\x1e\xfa"
# Symbols of our code: a dynamic library also exports symbols from other libraries.
OURS = re.compile(r"_ZN[A-Z]*7burnish|^main$|^burnish_")


class Elf:
    def __init__(self, data):
        if data[:6] != b"\x7fELF\x02\x01":
            raise ValueError("not an ELF file of 64 bits, little-endian")
        self.data = data
        self.kind, self.machine = struct.unpack_from("<HH", data, 16)
        program_at, section_at = struct.unpack_from("<QQ", data, 32)
        program_size, programs, section_size, sections = struct.unpack_from("<HHHH", data, 54)
        fields = ("type", "flags", "offset", "address", "physical", "bytes")
        self.segments = [dict(zip(fields, struct.unpack_from("<IIQQQQ", data, program_at + i * program_size))) for i in range(programs)]
        fields = ("name", "type", "flags", "address", "offset", "bytes", "link")
        self.sections = [dict(zip(fields, struct.unpack_from("<IIQQQQI", data, section_at + i * section_size))) for i in range(sections)]

    def of_type(self, kind):
        return [segment for segment in self.segments if segment["type"] == kind]

    def dynamic(self, tag):
        for segment in self.of_type(PT_DYNAMIC):
            for at in range(segment["offset"], segment["offset"] + segment["bytes"], 16):
                found, value = struct.unpack_from("<QQ", self.data, at)
                if found == tag:
                    return value
        return 0

    def symbols(self, kind):
        """(name, binding, type, section, address)"""
        for table in (s for s in self.sections if s["type"] == kind):
            names = self.sections[table["link"]]["offset"]
            for at in range(table["offset"], table["offset"] + table["bytes"], 24):
                name, info, _, section, address, _ = struct.unpack_from("<IBBHQQ", self.data, at)
                end = self.data.index(b"\0", names + name)
                yield self.data[names + name:end].decode(), info >> 4, info & 15, section, address

    def bytes_at(self, address, count):
        for s in self.of_type(PT_LOAD):
            if s["address"] <= address < s["address"] + s["bytes"]:
                at = s["offset"] + address - s["address"]
                return self.data[at:at + count]
        return b""


def faults_of(elf, is_program):
    imported = {name for name, _, _, section, _ in elf.symbols(SHT_DYNSYM) if section == 0}
    faults = []

    def must(holds, fault):
        if not holds:
            faults.append(fault)

    must(elf.of_type(PT_GNU_RELRO), "no RELRO")
    must(elf.dynamic(DT_FLAGS) & DF_BIND_NOW or elf.dynamic(DT_FLAGS_1) & DF_1_NOW, "symbols are bound when they are first called")
    must(elf.of_type(PT_GNU_STACK) and not elf.of_type(PT_GNU_STACK)[0]["flags"] & 1, "the stack is executable")
    must(elf.kind == 3 and (elf.dynamic(DT_FLAGS_1) & DF_1_PIE or not is_program), "lies at a fixed address")
    must("__stack_chk_fail" in imported, "no stack protection")
    must(any(re.fullmatch(r"__\w+_chk", name) for name in imported), "no checked functions of the C library")
    if elf.machine == EM_X86_64:
        entries = {(name, address) for kind in (SHT_SYMTAB, SHT_DYNSYM) for name, binding, type_, section, address in elf.symbols(kind)
                   if type_ == STT_FUNC and binding != STB_LOCAL and section != 0 and OURS.search(name)}
        bare = [name for name, address in entries if elf.bytes_at(address, 4) != ENDBR64]
        must(entries, "no functions of ours")
        must(not bare, f"{len(bare)} of {len(entries)} functions without endbr64, such as {bare[:3]}")
    return faults


def main():
    bad = 0
    for path in sys.argv[1:]:
        with open(path, "rb") as file:
            faults = faults_of(Elf(file.read()), ".so" not in path.rpartition("/")[2])
        print(f"{path}: {'; '.join(faults) or 'hardened'}")
        bad += bool(faults)
    return bad != 0 or len(sys.argv) < 2


if __name__ == "__main__":
    sys.exit(main())
