"""apps/manual/limits.md: its rows name entries of the atlas, and its pictures show places on their paths."""

import math
import re

from harness import case, check
from manual_page_cases import MANUAL, ROOT, pages

ROW = re.compile(r"^\| [^|]*<br>`(\w+)` \| !\[\]\(pictures/([^)]+)\) \| !\[\]\(pictures/([^)]+)\) \| ([^|]*) \|$", re.M)
OF_PICTURE = ("-o", "--size")  # options that no entry has


def options_of(words):
    """Returns {option: value} of words of `burnish render`. A scene is the option "", and its amount the option amount."""
    found, left = {}, list(words)
    while left:
        word = left.pop(0)
        if word.startswith("builtin:"):
            found[""], _, amount = word.partition("=")
            found.update({"amount": amount} if amount else {})
        else:
            found[word] = left.pop(0) if left and not re.match(r"--|builtin:", left[0]) else ""
    return found


def entries_of(bench):
    """Returns {entry: (options, path, whether its factors are equal)}. A path is {option: (begin, end)}."""
    found = {}
    listed = bench.run("atlas", "--list").expect(0).out
    for entry, words, path in re.findall(r"^  (\w+)\n      .*\n      burnish render (.*?), (\S+=.*)$", listed, re.M):
        ends = re.findall(r"([\w-]+)=([^=:]+):([^=:]+?)(?=,(?:[a-z][\w-]*=| by)|$)", path)
        found[entry] = (options_of(words.split()), {name if name == "amount" else f"--{name}": (a, b) for name, a, b in ends},
                        path.endswith(", by equal factors"))
    check(len(found) > 50 and all(path for _, path, _ in found.values()), f"{len(found)} entries were read")
    return found


def places(begin, end, value, geometric):
    """Returns the place on a path, from 0 to 1, of each number of a value that changes."""
    for a, b, v in zip(*([float(number) for number in text.split(",")] for text in (begin, end, value)), strict=True):
        if a == b:
            check(v == a, f"{v} is not {a}")
        else:
            yield math.log(v / a) / math.log(b / a) if geometric else (v - a) / (b - a)


def faults_of_place(drawn, path, geometric, begin, end):
    """Returns the faults of a picture that shows one place on a path, between two places."""
    if not path.keys() <= drawn.keys():
        return [f"no value of {sorted(path)}"]
    s = [place for name, (a, b) in path.items() for place in places(a, b, drawn[name], geometric)]
    if max(s) - min(s) > 1e-3:
        return [f"places {s} on one path"]
    return [] if begin - 1e-3 < s[0] < end + 1e-3 else [f"place {s[0]:.4f}, not from {begin} to {end}"]


def faults_of_options(drawn, options, path):
    """Returns the faults of a picture that has the entry's options, and no others."""
    fixed = {name: value for name, value in drawn.items() if name not in path and name not in OF_PICTURE}
    expected = {name: value for name, value in options.items() if name not in path}
    return [] if fixed == expected else [f"drawn with {fixed}, the entry has {expected}"]


def faults_of_cure(right, wrong, path, named):
    """Returns the faults of a picture that differs from the wrong one by its place, or by options that the row names."""
    changed = {name for name in right.keys() | wrong.keys() if right.get(name) != wrong.get(name)} - {"-o", *path}
    if not changed and all(right.get(name) == wrong.get(name) for name in path):
        return ["shows the same as the wrong picture"]
    unnamed = sorted(name for name in changed if name not in right or named.get(name) != right[name])
    return [f"the row does not name {name} {right.get(name)}" for name in unnamed]


@case("manual.pictures_of_limits_are_out_of_the_atlas", tier="quick")
def limits(bench):
    """Wrong pictures have the options of their entry, at a place past its golden onset. Right ones have the cure that the row names."""
    text = (MANUAL / "limits.md").read_text()
    drawn = {words[words.index("-o") + 1]: options_of(words[2:]) for words, _ in pages.commands_of(text) if "-o" in words}
    golden = (ROOT / "apps/lab/atlas/golden_figures.txt").read_text().partition("\n## full\n")[2]
    onsets = {entry: float(onset) for entry, onset in re.findall(r"^\| (\w+) \| ([\d.]+) \|", golden, re.M)}
    known, wrong = entries_of(bench), []
    rows = ROW.findall(text)
    check(len(rows) > 25 and len({entry for entry, *_ in rows}) == len(rows), f"{len(rows)} rows")
    pictured = len(re.findall(r"^\| \*\*.*!\[", text, re.M))
    check(pictured == len(rows), f"{pictured} rows have pictures, {len(rows)} name an entry")
    for entry, bad, good, cure in rows:
        if entry not in known:
            wrong.append(f"{entry}: no entry of the atlas")
            continue
        options, path, geometric = known[entry]
        named = options_of(" ".join(re.findall(r"`((?:--|builtin:)[^`]*)`", cure)).split())
        wrong += [f"{entry}: {bad}: {fault}" for fault in faults_of_options(drawn[bad], options, path)]
        wrong += [f"{entry}: {bad}: {fault}" for fault in faults_of_place(drawn[bad], path, geometric, onsets[entry], 1.0)]
        wrong += [f"{entry}: {good}: {fault}" for fault in faults_of_cure(drawn[good], drawn[bad], path, named)]
        if any(drawn[good].get(name) not in (drawn[bad].get(name), named.get(name)) for name in path): # another place
            wrong += [f"{entry}: {good}: {fault}" for fault in faults_of_place(drawn[good], path, geometric, 0.0, onsets[entry])]
    check(not wrong, "\n".join(wrong))
