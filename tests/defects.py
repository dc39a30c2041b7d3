#!/usr/bin/env python3
"""Plants one defect after another in the formulas of frames, maps and parallax. Exactly one unit test must fail, the test for this
defect.

Usage: defects.py BUILD [NAME...]        BUILD: a built preset of Ninja; NAME: defects of the table, all of them if none is given

The changed text lies in a separate folder, which comes first on the include path. The test files that read this text are compiled against
it and linked to the unchanged libraries. The checkout and the build stay unchanged.

Exit code: 0 each defect fails its test and no other; 1 not; 77 no build by Ninja here.
"""

import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]

# program: (test folder, its files that read the formulas, other files, suites to run)
PROGRAMS = {
    "unit_techniques": ("tests/unit/techniques", ("frame_test.cpp", "kernels.isa.cpp"), ("tests/unit/lanes/kernels.cpp",), "frame.*"),
    "unit_raster": ("tests/unit/raster", ("bump_test.cpp", "parallax_test.cpp", "fixture.cpp"), (), "bump.*:parallax.*"),
    "unit_scene": ("tests/unit/scene", ("surface_maps_test.cpp",), ("core/scene/surface_maps.cpp",), "surface_maps.*"),
}
SURFACE, MAPS = "shading/surface/surface.k.h", "core/scene/surface_maps.cpp"
TURNED_LAST = """surface_frame bumped = axes;
    bumped.b = k_cross(x.geometric_axes.n, axes.t);
    x.lobe = lobe_in_frame(m, shape, bumped);"""
# name: (file, text, replacement, program, the test that fails)
DEFECTS = {
    "b_flipped": (SURFACE, "vec3_of(a, n.y * part,", "vec3_of(a, -(n.y * part),", "unit_techniques", "frame.of_a_quaternion_turns_about_x_as_y_says"),
    "c_flipped": (SURFACE, "-(n.x * part)", "n.x * part", "unit_techniques", "frame.of_a_quaternion_turns_about_y_against_x"),
    "middle_sign_of_bitangent": (SURFACE, "r.b = vec3_of(bc, a2 - b2 + c2,", "r.b = vec3_of(bc, a2 + b2 + c2,", "unit_techniques",
                                 "frame.of_a_quaternion_has_its_bitangent"),
    "bitangent_as_printed": (SURFACE, "a2 - b2 + c2, -ab)", "a2 - b2 + c2, ab)", "unit_techniques", "frame.of_a_quaternion_has_its_bitangent"),
    "tangent_flipped": (SURFACE, "vec3_of(a2 + b2 - c2, bc, ac)", "vec3_of(a2 + b2 - c2, bc, -ac)", "unit_techniques", "frame.of_a_quaternion_has_its_tangent"),
    "rotation_after_bump": ("shading/surface/make_shaded_point.t.h", "x.lobe = lobe_in_frame(m, shape, axes);", TURNED_LAST, "unit_raster",
                            "bump.turns_what_a_rotation_has_turned"),
    "height_for_depth": ("shading/surface/parallax.t.h", "lit(1.0) - texel_at_level(map, kNormalTex, uv).w", "texel_at_level(map, kNormalTex, uv).w", "unit_raster",
                         "parallax.of_height_one_is_the_surface"),
    "b_flipped_in_maps": (MAPS, "q[1] = y / (2.0 * a)", "q[1] = -y / (2.0 * a)", "unit_scene", "surface_maps.quaternions_are_green_as_y_says"),
    "c_flipped_in_maps": (MAPS, "q[2] = -x / (2.0 * a)", "q[2] = x / (2.0 * a)", "unit_scene", "surface_maps.quaternions_are_blue_against_x"),
    "x_flipped_from_maps": (MAPS, "code16(0.5 - a * c)", "code16(0.5 + a * c)", "unit_scene", "surface_maps.normals_of_quaternions_lean_along_x"),
    "y_flipped_from_maps": (MAPS, "code16(0.5 + a * b)", "code16(0.5 - a * b)", "unit_scene", "surface_maps.normals_of_quaternions_lean_along_y"),
}


def commands_of(build, program):
    text = subprocess.run(["ninja", "-C", build, "-t", "commands", program], capture_output=True, text=True, check=True).stdout
    return text.splitlines()


class Program:
    """A test program: compilation of its files, and linking."""

    def __init__(self, build, name):
        self.build, self.name = build, name
        folder, self.read, self.others, self.suites = PROGRAMS[name]
        self.folder = folder
        lines = commands_of(build, name)
        self.own = [line for line in lines if re.search(rf" -o {re.escape(folder)}/CMakeFiles/\S+\.o -c ", line)]
        self.core = [line for line in lines if " -o core/CMakeFiles/burnish_core.dir/" in line and " -c " in line]
        link = lines[-1].removeprefix(": && ").split(" && ")[0]
        self.link = [word for word in shlex.split(link) if not word.startswith(f"{folder}/CMakeFiles/")]

    def compile(self, source, command, first, to):
        words = shlex.split(command)
        words = words[next(i for i, word in enumerate(words) if word.endswith(("c++", "g++", "clang++"))):]
        kept, skip = [], False
        for word in words:
            if skip or word in ("-MD", "-MT", "-MF", "-o", "-c"):
                skip = not skip and word not in ("-MD",)
                continue
            kept.append(word)
        subprocess.run([kept[0], f"-I{first}", *kept[1:], "-o", to, "-c", source], cwd=self.build, check=True)

    def failing(self, work, first, changed):
        """Returns the names of tests that fail when `first` precedes the checkout on the include path."""
        objects = []
        lanes = [line for line in self.own if ".isa.cpp.o -c " in line]
        plain = next(line for line in self.own if ".isa.cpp.o -c " not in line)
        for file in self.read:
            for k, command in enumerate(lanes if file.endswith(".isa.cpp") else [plain]):
                objects.append(work / f"{file}.{k}.o")
                self.compile(ROOT / self.folder / file, command, first, objects[-1])
        for file in self.others:
            source = first / file if file == changed else ROOT / file
            objects.append(work / f"{pathlib.Path(file).name}.o")
            self.compile(source, self.core[0] if file.startswith("core/") else plain, first, objects[-1])
        at = self.link.index("-o")
        words = self.link[:at] + [str(o) for o in objects] + ["-o", str(work / self.name), "-Wl,--allow-multiple-definition"] + self.link[at + 2:]
        subprocess.run(words, cwd=self.build, check=True)
        ran = subprocess.run([work / self.name, f"--gtest_filter={self.suites}"], capture_output=True, text=True)
        if "[==========]" not in ran.stdout:
            raise RuntimeError(ran.stderr)
        return sorted(set(re.findall(r"^\[  FAILED  \] (\w+\.\w+)", ran.stdout, re.M)))


def main():
    build, wanted = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:] or list(DEFECTS)
    if not (build / "build.ninja").exists() or not shutil.which("ninja"):
        print("no build by Ninja here")
        return 77
    wrong, programs = 0, {}
    for name in wanted:
        file, old, new, program, expected = DEFECTS[name]
        with tempfile.TemporaryDirectory() as made:
            work = pathlib.Path(made)
            first = work / "first"
            shutil.copytree(ROOT / "shading", first / "shading", ignore=shutil.ignore_patterns("bake"))
            (first / file).parent.mkdir(parents=True, exist_ok=True)
            text = (ROOT / file).read_text()
            if text.count(old) != 1:
                raise SystemExit(f"{file} does not hold '{old}' once")
            (first / file).write_text(text.replace(old, new))
            programs.setdefault(program, Program(build, program))
            found = programs[program].failing(work, first, file)
        print(f"{name}: {', '.join(found) or 'nothing'} failed" + ("" if found == [expected] else f"; expected {expected} alone"), flush=True)
        wrong += found != [expected]
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
