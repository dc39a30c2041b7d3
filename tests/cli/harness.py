"""Runs the program and checks its messages and files."""

import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
GIB = 1 << 30
CASES = {}  # name -> (function, labels)


class Skipped(Exception):
    """The case cannot run on this machine; the text gives the reason."""


class Failed(Exception):
    pass


def case(name, *labels, tier="check", budget=None):
    """Registers a test area.claim_in_words of a tier: quick, check or nightly. budget: CPU seconds that the test may take, if not the
    tier's (tests/costs.py). The label `input` marks tests for the sanitizer build, `compilers` marks tests that need another build's
    program."""

    def register(function):
        CASES[name] = (function, (tier, *labels, *([f"budget_{budget}"] if budget else [])))
        return function

    return register


def check(condition, text):
    if not condition:
        raise Failed(text)


def data_files(roots, folder, suffixes):
    """Returns {name below the folder: path} of the test data's files with one of the suffixes, sorted by name, each name once."""
    found = {}
    for root in roots:
        for path in (root / folder).rglob("*"):
            if path.suffix in suffixes:
                found.setdefault(str(path.relative_to(root / folder)), path)
    return dict(sorted(found.items()))


def lab_commands():
    """Returns the subcommands that the laboratory's program runs."""
    return set(re.findall(r"^BN_LAB_COMMAND\((\w+)", (ROOT / "apps/cli/commands.def").read_text(), re.M))


def words_of(name):
    """Returns a file's name in the form of test names."""
    return re.sub(r"[^a-z0-9]+", "_", name.lower())


class Completed:
    """A finished run."""

    def __init__(self, command, code, out, err, seconds, peak_bytes):
        self.command, self.code, self.out, self.err = command, code, out, err
        self.seconds, self.peak_bytes = seconds, peak_bytes

    def describe(self):
        return f"{' '.join(map(str, self.command))}\nexit code {self.code}\nstdout: {self.out[-2000:]}\nstderr: {self.err[-4000:]}"

    def expect(self, code):
        check(self.code == code, f"expected exit code {code}\n{self.describe()}")
        return self

    def expect_one_line(self, *needles):
        """Expects exactly one error line on stderr, which contains the needles."""
        lines = self.err.splitlines()
        check(len(lines) == 1 and self.err.endswith("\n"), f"expected one line on stderr\n{self.describe()}")
        check(lines[0].startswith("burnish: "), f"the line does not begin with 'burnish: '\n{self.describe()}")
        for needle in needles:
            check(str(needle) in lines[0], f"the line does not name '{needle}'\n{self.describe()}")
        return self


class Bench:
    """Environment of a case: the program, a new folder, and the test data (tests/data and an optional second folder)."""

    def __init__(self, program, compare_program, data, folder, sanitized):
        self.program, self.compare_program = program, compare_program
        self.data, self.sanitized = data, sanitized
        self.cache = pathlib.Path(folder) / "cache"  # all cases share it, so each environment is baked once

    def open(self, name):
        self.folder = self.cache.parent / name
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)

    def data_file(self, path):
        """Returns the path of a test data file or folder. Files of the optional folder may be missing, so nightly cases alone may ask
        for them."""
        for root in self.data:
            if (root / path).exists():
                return root / path
        raise Skipped(f"no test data at {self.data[-1] / path}")

    def environment(self, extra):
        env = {k: v for k, v in os.environ.items() if not k.startswith("BN_")}
        env["XDG_CACHE_HOME"] = str(self.cache)
        env["ASAN_OPTIONS"] = "allocator_may_return_null=1:hard_rss_limit_mb=4096:intercept_tls_get_addr=0:" + env.get("ASAN_OPTIONS", "")
        env["UBSAN_OPTIONS"] = "print_stacktrace=1"
        if self.sanitized:  # Vulkan drivers leak and are not under test
            env["VK_DRIVER_FILES"] = env["VK_ICD_FILENAMES"] = str(self.cache / "none")
            env["BN_FORCE_ISA"] = "scalar"  # the lanes that sanitizers check
        env["BURNISH_PROGRESS_SECONDS"] = "3600"  # a slow machine would add lines to stderr
        env.update(extra)
        return env

    def run(self, *arguments, program=None, env=None, file_size=None, user=None, processes=None, timeout=120.0):
        """Runs the program in the case's folder. `file_size`: largest file in bytes. `processes`: largest number of the user's
        processes, including threads."""
        command = [program or self.program, *map(str, arguments)]

        def limit():
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            if not self.sanitized:  # shadow memory reserves terabytes of addresses
                resource.setrlimit(resource.RLIMIT_AS, (16 * GIB, 16 * GIB))
            if file_size is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))
            if processes is not None:
                resource.setrlimit(resource.RLIMIT_NPROC, (processes, processes))

        with open(self.folder / ".stdout", "w+b") as out, open(self.folder / ".stderr", "w+b") as err:
            # A limit on file sizes applies to these two files as well, so the program gets pipes then.
            piped = file_size is not None
            begin = time.monotonic()
            child = subprocess.Popen(command, cwd=self.folder, env=self.environment(env or {}), preexec_fn=limit,
                                     stdin=subprocess.DEVNULL, stdout=subprocess.PIPE if piped else out,
                                     stderr=subprocess.PIPE if piped else err, user=user)
            code, usage = self.wait(child, begin, timeout * (6 if self.sanitized else 1))
            seconds = time.monotonic() - begin
            texts = []
            for pipe, file in ((child.stdout, out), (child.stderr, err)):
                file.seek(0)
                texts.append((pipe.read() if piped else file.read()).decode("utf-8", "replace"))
                if piped:
                    pipe.close()
        for name in (".stdout", ".stderr"):
            (self.folder / name).unlink()
        return Completed(command, code, texts[0], texts[1], seconds, usage.ru_maxrss * 1024)

    @staticmethod
    def wait(child, begin, timeout):
        """Waits by wait4, which reports this child's memory."""
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid:
                child.returncode = os.waitstatus_to_exitcode(status)
                return child.returncode, usage
            if time.monotonic() - begin > timeout:
                child.kill()
                os.wait4(child.pid, 0)
                child.returncode = -9
                raise Failed(f"{' '.join(map(str, child.args))} did not end within {timeout:.0f} s")
            time.sleep(0.005)

    def figures(self, *arguments, code=0, **options):
        """Renders, and returns the --stats."""
        done = self.run("render", *arguments, "--stats", "-", **options).expect(code)
        try:
            return json.loads(done.out)
        except ValueError as error:
            raise Failed(f"--stats - is not JSON: {error}\n{done.describe()}") from error

    def left_behind(self):
        return sorted(path.name for path in self.folder.rglob("*"))


# An image small enough for hundreds of runs. The environment is a coarse bake, cached after the first run.
SMALL = ("--size", "160x120", "--msaa", "4", "--env-size", "64", "--env-samples", "32")


def scratch(bench, name, data):
    path = bench.folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path
