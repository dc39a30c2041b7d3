"""Work longer than the progress interval reports its progress: BURNISH_PROGRESS_SECONDS makes the interval short here."""

import re
import subprocess

from harness import Skipped, case, check

OFTEN = {"BURNISH_PROGRESS_SECONDS": "0.005"}
TINY = ("--size", "24x16", "--env-size", "16", "--env-samples", "16", "--floor", "off")


TOLD = (
    (r"^render, .*levels of material '.*' by kappa: ", "render", "builtin:bumps", "--mip-filter", "kappa", *TINY),
    (r"^bake, mip, ", "bake", "mip", "builtin:bumps", "--mip-filter", "kappa", "-o", "a.mip"),
    (r"^render, environment builtin:sky(, .*)?: |^baking builtin:sky: ", "render", "builtin:plate", "--env", "builtin:sky", "--env-size", "64",
     "--env-samples", "256", "--no-cache", "--size", "24x16", "--floor", "off"),
    (r"^render, drawing 64x48: ", "render", "builtin:plate", "--technique", "mc", "--samples", "2048", *TINY[2:], "--size", "64x48"),
)


def lines_of(done):
    """Returns the progress lines: "bake, mip, levels of ...: 3 s", "chart: 12 %, 4 s left"."""
    return [line for line in done.err.splitlines() if re.search(r": (\d+ s|\d+ %.*)$", line)]


def check_told(bench, rows):
    """Rows of a pattern and words. A progress line of the command fits the pattern, and -q leaves nothing."""
    for said, *words in rows:
        done = bench.run(*words, env=OFTEN).expect(0)
        check(any(re.search(said, line) for line in lines_of(done)), f"{said}\n{done.describe()}")
        check(bench.run(*words, "-q", env=OFTEN).expect(0).err == "", f"{words} says something with -q")


@case("progress.of_everything_that_takes_long_is_told", budget=8)
def everything(bench):
    check_told(bench, TOLD)


@case("progress.of_parity_names_the_row_and_the_stage")
def parity(bench):
    """Compiling takes a minute and more: the run ends once its line has come."""
    words = ("parity", "builtin:plate", "--technique", "split_isotropic", "--msaa", "1", *TINY[:-2], "--device", "lavapipe")
    env = bench.environment({**OFTEN, "MESA_SHADER_CACHE_DISABLE": "true"})
    running = subprocess.Popen([bench.program, *words], cwd=bench.folder, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
    named = re.compile(r"parity, row 1 \(builtin:plate split_isotropic, 1 sample\), drawing 24x16, compiling \w+")
    told = []
    for line in running.stderr:
        told.append(line)
        if named.match(line):
            running.kill()
            break
    code = running.wait(timeout=60)
    running.stderr.close()
    if code == 77:
        raise Skipped("no device")
    check(named.match(told[-1] if told else ""), f"it ended with {code}: {told}")
