"""Every exit code of core/base/result.h is in the table of apps/manual/ci.md and in the text of --help."""

import pathlib
import re
import sys


def codes_of_enum(text):
    body = re.search(r"enum class ExitCode : int \{(.*?)\};", text, re.S)[1]
    return {int(code): name for name, code in re.findall(r"^\s*(\w+) = (\d+),", body, re.M)}


def faults(result_h, page, program_cpp):
    codes = codes_of_enum(result_h)
    table = re.search(r"^## Exit codes\n(.*?)^## ", page, re.S | re.M)[1]
    in_table = {int(n) for cell in re.findall(r"^\| ([\d, ]+) \|", table, re.M) for n in cell.split(",")}
    spoken = re.search(r"^Exit codes: (.*?)\)\"", program_cpp, re.S | re.M)[1]
    in_help = {int(n) for n in re.findall(r"(?:^|[,\n] ?| or )(\d+) ", " " + spoken)} | {0}
    found = []
    for where, there in (("apps/manual/ci.md", in_table), ("apps/cli/program.cpp", in_help)):
        found += [f"{where}: exit code {code} ({name}) of core/base/result.h is missing" for code, name in codes.items() if code not in there]
        found += [f"{where}: exit code {code} is none of core/base/result.h" for code in sorted(there - set(codes) - {130, 143})]
    return found


def main(root):
    texts = [(root / name).read_text() for name in ("core/base/result.h", "apps/manual/ci.md", "apps/cli/program.cpp")]
    wrong = faults(*texts)
    # the check finds planted faults
    without = [faults(texts[0], re.sub(r"^\| 5 \|.*\n", "", texts[1], flags=re.M), texts[2]),
               faults(texts[0].replace("usage = 2,", "usage = 2,\n    other = 9,"), texts[1], texts[2])]
    if [len(w) for w in without] != [len(wrong) + 1, len(wrong) + 2]:
        wrong.append(f"the check does not see faults: {without}")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
