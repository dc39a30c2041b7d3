"""Calls of std::filesystem use error codes, since an ordinary path (a name too long, a link to itself, no rights) is no exception.

Usage: paths.py ROOT. Prints one line a fault; exit code 1 where there is any."""

import pathlib
import re
import sys

FOLDERS = ("core", "shading", "raster", "apps", "bench")
# Functions that throw unless their last argument is an error_code.
FREE = ("absolute|canonical|weakly_canonical|relative|proximate|copy|copy_file|copy_symlink|create_directory|create_directories|create_hard_link|"
        "create_symlink|create_directory_symlink|current_path|exists|equivalent|file_size|hard_link_count|is_block_file|is_character_file|"
        "is_directory|is_empty|is_fifo|is_other|is_regular_file|is_socket|is_symlink|last_write_time|permissions|read_symlink|remove|remove_all|"
        "rename|resize_file|space|status|symlink_status|temp_directory_path")
CALL = re.compile(rf"\b(?:fs|filesystem)::(?P<name>{FREE})(?P<open>\()")
ITERATOR = re.compile(r"\b(?:fs|filesystem)::(?P<name>(?:recursive_)?directory_iterator)(?: (?P<variable>\w+))?(?P<open>\()")
ENTRY = re.compile(r"(?:\.|->)(?:is_directory|is_regular_file|is_symlink|is_other|file_size|last_write_time|symlink_status|hard_link_count|exists|refresh)\(\)")
CODE = re.compile(r"\bstd::error_code\s*&?\s*(\w+(?:\s*,\s*\w+)*)")
STATUS = re.compile(r"\b(?:fs|filesystem)::file_status (\w+)")
OF_STATUS = re.compile(r"exists|is_\w+")


def arguments_from(text, begin):
    """Returns the arguments of a call whose '(' is at `begin`, split at the call's commas."""
    depth, found, last = 0, [], begin + 1
    for at in range(begin, len(text)):
        depth += (text[at] in "([{") - (text[at] in ")]}")
        if (text[at] == "," and depth == 1) or depth == 0:
            found.append(text[last:at].strip())
            last = at + 1
        if depth == 0:
            break
    return found


def without_comments(text):
    return re.sub(r"//[^\n]*|\"(?:\\.|[^\"\\\n])*\"", lambda m: '""' if m[0][0] == '"' else "", text)


def faults_of(text):
    """Yields (line, fault) of one source."""
    text = without_comments(text)
    codes = {name.strip() for names in CODE.findall(text) for name in names.split(",")}
    statuses = set(STATUS.findall(text))
    line = lambda at: text.count("\n", 0, at) + 1
    for call in CALL.finditer(text):
        words = arguments_from(text, call.start("open"))
        asks_status = OF_STATUS.fullmatch(call["name"]) and len(words) == 1 and (words[0] in statuses or re.search(r"status\(", words[0]))
        if words[-1] not in codes and not asks_status:
            yield line(call.start()), f"{call['name']}() throws: give it an error_code"
    for made in ITERATOR.finditer(text):
        words = arguments_from(text, made.start("open"))
        if words != [""] and words[-1] not in codes:
            yield line(made.start()), f"{made['name']} throws: give it an error_code"
        if re.search(r"for \([^;()]*(?<!:):(?!:)\s*(?:std::)?$", text[:made.start()]):
            yield line(made.start()), "a loop over a range steps with ++, which throws: use increment(code)"
        if made["variable"] and re.search(rf"\+\+{made['variable']}\b|\b{made['variable']}\+\+", text):
            yield line(made.start()), "++ throws: use increment(code)"
    for entry in ENTRY.finditer(text):
        yield line(entry.start()), f"{entry[0]} throws: give it an error_code"


def self_test():
    head = "std::error_code failed, ignored; fs::file_status status;\n"
    good = ("fs::exists(path, ignored)", "for (std::filesystem::directory_iterator at(folder, failed), end; at != end; at.increment(failed))", "fs::is_directory(status)", "std::filesystem::exists(std::filesystem::symlink_status(path, ignored))",
            "fs::rename(a(b, c), d, failed);", "for (fs::directory_iterator at(folder, failed), end; at != end; at.increment(failed))",
            "at->is_directory(ignored)", "// fs::exists(path)", "fs::path(path).parent_path()", 'say("fs::exists(path)")')
    bad = ("fs::exists(path)", "fs::rename(a(b, c), d)", "std::filesystem::file_size(path)", "for (const auto& e : fs::directory_iterator(folder, failed))",
           "fs::directory_iterator at(folder)", "entry.is_directory()", "fs::create_directories(folder / name(ignored))", "fs::remove(path)",
           "fs::directory_iterator at(folder, failed); ++at;", "fs::temp_directory_path()")
    return all(not list(faults_of(head + text)) for text in good) and all(list(faults_of(head + text)) for text in bad)


def main():
    root = pathlib.Path(sys.argv[1])
    if not self_test():
        print("paths.py does not tell calls that throw from others")
        return 1
    faults, files = [], 0
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                files += 1
                faults += [f"{path.relative_to(root)}:{at}: {why}" for at, why in faults_of(path.read_text())]
    print(*faults, f"{files} files, {len(faults)} faults", sep="\n")
    return 1 if faults or files < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
