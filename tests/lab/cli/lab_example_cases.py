"""Examples of the laboratory's reference pages run, as the product's examples do (manual_example_cases)."""

import shlex

from harness import Skipped, case
from manual_example_cases import OF_LAB, examples_of, run_examples
from manual_page_cases import ROOT, lab_program, pages

FAST = "albedo_by_a_fit" # an entry of the atlas: two images of the tile renderer a step, no reference
# Options behind the examples that begin so. A pair NAME=VALUE is there beside the example's own NAME, and counts, as the last.
SMALL = {
    "burnish atlas --quick": (FAST,),
    "burnish atlas bent_normal_bends_too_far": ("--quick",),
    "burnish bake ltc": ("--resolution 3", "--steps 0"),
    "burnish bake ltc --table": (),
    "burnish chart --mip": ("--per-set 1", "--brdf ggx_aniso"),
    "burnish conform --write": ("--samples 64",),
    "burnish race": ("--techniques split_isotropic", "--msaa 1", "--size 96x64", "--samples 4", "--runs 1", "--devices lavapipe", "--env-size 64",
                     "--env-samples 32"),
    "burnish train": ("--steps=2",),
    "burnish train mip --evaluate": (),
}
BEFORE = {
    "burnish atlas --quick --bless": ("mkdir -p apps/lab/atlas", f"cp {shlex.quote(str(ROOT / 'apps/lab/atlas/golden_figures.txt'))} apps/lab/atlas"),
    "burnish conform conform": ("burnish conform conform pictures --draw -q",),
}


def add_examples(name, lines):
    @case(f"manual.examples_of_reference_pages_run.{name}", tier="nightly")
    def examples(bench):
        if not lab_program(bench).exists():
            raise Skipped("no burnish-lab beside the program")
        run_examples(bench, name, lines, SMALL, BEFORE, {})


for page in pages.LAB:
    add_examples(page, examples_of(page))
for part, begin in OF_LAB.items():
    add_examples(part, [line for line in examples_of(begin.split()[1]) if line.startswith(begin)])
