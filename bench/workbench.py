"""Holds code that scripts of measurement share: options, a folder to work in, runs that end the script where they fail."""

import argparse
import pathlib
import resource
import subprocess
import sys
import tempfile


def arguments(doc):
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--work", help="a folder that stays")
    parser.add_argument("--json", help="the figures as a file")
    return parser


def in_folder(options, measure):
    """measure(options, folder)'s exit code: --work, or a folder that goes afterwards."""
    with tempfile.TemporaryDirectory() as scratch:
        work = pathlib.Path(options.work or scratch).resolve()
        work.mkdir(parents=True, exist_ok=True)
        return measure(options, work)


def seconds_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Program:
    def __init__(self, options, work):
        self.path, self.work = str(pathlib.Path(options.program).resolve()), work

    def run(self, *words):
        """Standard output. Exit code 2 of the script where the program fails."""
        done = subprocess.run([self.path, *map(str, words)], cwd=self.work, capture_output=True, text=True)
        if done.returncode != 0:
            print(done.stderr, file=sys.stderr)
            sys.exit(2)
        return done.stdout

    def timed(self, *words):
        """CPU seconds that a run took."""
        begin = seconds_of_children()
        self.run(*words)
        return seconds_of_children() - begin
