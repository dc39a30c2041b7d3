"""Image sequences: render --animate and --turntable, compare --sequence."""

import json
import struct
import zlib

import gltf_files as files
from camera_cases import TINY, area, cube, seen
from compare_cases import bright, pfm
from harness import case, check, scratch

ROW = ("builtin:plate", "--size", "48x32", "--msaa", "1", "--env-size", "16", "--env-samples", "4")


def same(step, figures):
    check(step["pixel_hash"] == figures["pixel_hash"], f"step {step} differs from the picture of its values, {figures['pixel_hash']}")


@case("animation.each_step_is_the_picture_of_its_values", tier="nightly")
def each_step_is_the_picture_of_its_values(bench):
    row = bench.figures(*ROW, "--animate", "roughness=0.2:0.6,eye=0,0,3:0.5,1,3,fov=40:30", "--steps", "3", "-o", "a_%02d.exr")
    steps = row["steps"]
    check([s["step"] for s in steps] == [0, 1, 2], f"{steps}")
    check(len({s["pixel_hash"] for s in steps}) == 3, "nothing changes")
    for step, (roughness, eye, fov) in zip(steps, (("0.2", "0,0,3", "40"), ("0.4", "0.25,0.5,3", "35"), ("0.6", "0.5,1,3", "30"))):
        check((step["roughness"], step["eye"], step["fov"]) == (roughness, eye, fov), f"{step}")
        same(step, bench.figures(*ROW, "--roughness", roughness, "--eye", eye, "--fov", fov, "-o", "single.exr"))
        picture = bench.folder / f"a_{step['step']:02}.exr"
        check(picture.read_bytes() == (bench.folder / "single.exr").read_bytes(), f"{picture.name} is another file than of its picture alone")


@case("animation.environments_and_whole_numbers_change_too", tier="nightly")
def environments_and_whole_numbers_change_too(bench):
    row = bench.figures(*ROW, "--animate", "env-rotation=0:90,samples=4:9", "--steps", "2", "--technique", "major_axis")
    for step, rotation, samples in zip(row["steps"], ("0", "90"), ("4", "9")):
        same(step, bench.figures(*ROW, "--technique", "major_axis", "--env-rotation", rotation, "--samples", samples))


@case("animation.materials_change_too")
def materials_change_too(bench):
    row = bench.figures(*ROW, "--animate", "f0=0.04,0.04,0.04:1,0.5,0", "--steps", "2")
    check(row["steps"][0]["pixel_hash"] != row["steps"][1]["pixel_hash"], "nothing changes")
    for step, f0 in zip(row["steps"], ("0.04,0.04,0.04", "1,0.5,0")):
        same(step, bench.figures(*ROW, "--f0", f0))


def turning():
    """Returns a triangle that turns about y by 90 degrees in two seconds."""
    gltf = files.triangle()
    keys = struct.pack("<2f", 0, 2) + struct.pack("<8f", 0, 0, 0, 1, 0, 0.5**0.5, 0, 0.5**0.5)
    gltf["buffers"].append({"uri": files.data_uri(keys), "byteLength": len(keys)})
    buffer, view, accessor = len(gltf["buffers"]) - 1, len(gltf["bufferViews"]), len(gltf["accessors"])
    gltf["bufferViews"] += [{"buffer": buffer, "byteLength": 8}, {"buffer": buffer, "byteOffset": 8, "byteLength": 32}]
    gltf["accessors"] += [{"bufferView": view, "componentType": 5126, "type": "SCALAR", "count": 2, "min": [0], "max": [2]},
                          {"bufferView": view + 1, "componentType": 5126, "type": "VEC4", "count": 2}]
    gltf["animations"] = [{"samplers": [{"input": accessor, "output": accessor + 1}],
                           "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}]
    return files.text(gltf)


@case("animation.time_goes_through_the_scene_s_own")
def time_goes_through_the_scene_s_own(bench):
    scratch(bench, "turning.gltf", turning())
    seen = ("turning.gltf", "--eye", "0,0,3", "--target", "0,0,0", "--size", "32x32", "--env-size", "16", "--env-samples", "4")
    steps = bench.figures(*seen, "--animate", "time=0:2", "--steps", "3")["steps"]
    check(len({s["pixel_hash"] for s in steps}) == 3, "nothing changes")
    for step, time in zip(steps, ("0", "1", "2")):
        same(step, bench.figures(*seen, "--time", time))
    done = bench.run("render", *seen, "--time", "5", "-o", "a.png").expect(0)
    check("ends at 2 s" in done.err, done.err)
    same(steps[2], bench.figures(*seen, "--time", "5"))
    bench.run("render", *seen, "--time", "1", "--animation", "4", "-o", "b.png").expect(4).expect_one_line("turning.gltf", "--animation")
    bench.run("render", *seen, "--time", "-1", "-o", "b.png").expect(2).expect_one_line("--time")
    bench.run("render", "builtin:plate", *seen[1:], "--time", "1", "-o", "b.png").expect(4).expect_one_line("builtin:plate", "--time")
    check(not (bench.folder / "b.png").exists(), "b.png was written")


@case("animation.a_turntable_goes_once_around_at_one_distance")
def a_turntable_goes_once_around_at_one_distance(bench):
    scratch(bench, "cube.gltf", cube())
    words = [w for w in TINY if w not in ("-o", "a.pfm")]
    bench.run("render", "cube.gltf", *words, "--turntable", "4", "--orbit", "0,0", "-o", "t%d.pfm").expect(0)
    areas = []
    for i, face in enumerate(("front", "right", "back", "left")):
        (bench.folder / f"t{i}.pfm").rename(bench.folder / "a.pfm")
        found = seen_in_file(bench)
        check(set(found) == {face}, f"picture {i} shows {set(found)}, not {face}")
        areas.append(area(found))
    check(min(areas) == max(areas) > 500, f"the cube's sizes are {areas}")


def seen_in_file(bench):
    """Returns camera_cases.seen() for the existing a.pfm."""
    class Still:
        folder = bench.folder

        @staticmethod
        def run(*_):
            return Still

        @staticmethod
        def expect(_):
            return None

    return seen(Still)


def chunks(data):
    at, found = 8, []
    while at < len(data):
        size, = struct.unpack(">I", data[at:at + 4])
        kind, body, sum_, = data[at + 4:at + 8], data[at + 8:at + 8 + size], data[at + 8 + size:at + 12 + size]
        check(struct.unpack(">I", sum_)[0] == zlib.crc32(kind + body), f"the check sum of {kind}")
        found.append((kind, body))
        at += 12 + size
    return found


@case("animation.a_moving_picture_holds_the_pictures_of_its_row")
def a_moving_picture_holds_the_pictures_of_its_row(bench):
    bench.run("render", *ROW, "--animate", "roughness=0.2:0.6", "--steps", "3", "--fps", "12", "--msaa", "4", "--resolve", "display",
              "--exposure", "3", "-o", "a.apng", "-o", "s%d.png").expect(0)
    found = chunks((bench.folder / "a.apng").read_bytes())
    kinds = [kind for kind, _ in found]
    check(kinds[0] == b"IHDR" and kinds[-1] == b"IEND" and kinds.index(b"acTL") < kinds.index(b"IDAT"), f"{kinds}")
    check(dict(found)[b"acTL"] == struct.pack(">II", 3, 0), "not three pictures for ever")
    frames, sequence = [], []
    for kind, body in found:
        if kind in (b"fcTL", b"fdAT"):
            sequence.append(struct.unpack(">I", body[:4])[0])
        if kind == b"fcTL":
            check(struct.unpack(">IIIIHHBB", body[4:]) == (48, 32, 0, 0, 1, 12, 0, 0), f"{body}")
            frames.append(b"")
        elif kind in (b"IDAT", b"fdAT"):
            frames[-1] += body if kind == b"IDAT" else body[4:]
    check(sequence == list(range(len(sequence))), f"{sequence}")
    single = [b"".join(body for kind, body in chunks((bench.folder / f"s{i}.png").read_bytes()) if kind == b"IDAT") for i in range(3)]
    check(frames == single and len(set(frames)) == 3, "other pictures than those of the row")
    check(len(zlib.decompress(frames[0])) == 32 * (1 + 3 * 48), "a picture of another size")


@case("animation.what_cannot_be_a_row_is_refused")
def what_cannot_be_a_row_is_refused(bench):
    animate = ("--animate", "roughness=0:1")
    for words, needles in (
            (("--animate", "rougness=0:1"), ("--animate", "did you mean 'roughness'")),
            (("--animate", "technique=mc:mc"), ("--animate", "technique")),
            (("--animate", "output=1:2"), ("--animate", "output")),
            (("--animate", "roughness=0"), ("--animate", "NAME=FROM:TO")),
            (("--animate", ""), ("--animate",)),
            (("--animate", "roughness=0:2"), ("--roughness", "2")),
            (("--animate", "roughness=0:x"), ("--animate", "x")),
            (("--animate", "roughness=0:nan"), ("--animate", "nan")),
            (("--animate", "eye=0,0,1:1,2"), ("--eye", "1,2")),
            (("--animate", "roughness=0:1,roughness=1:0"), ("--animate", "twice")),
            ((*animate, "--steps", "1"), ("--steps", "1")),
            (("--steps", "5"), ("--steps", "--animate")),
            (("--fps", "5"), ("--fps", "--animate")),
            ((*animate, "--roughness", "0.5"), ("--roughness", "--animate")),
            (("--anisotropy", "0.5", "--animate", "anisotropy=0:1"), ("--anisotropy", "--animate")),
            ((*animate, "--steps", "2", "-o", "one.png"), ("-o", "one.png", "%04d")),
            ((*animate, "--steps", "2", "-o", "a%d_%d.png"), ("-o", "%04d")),
            ((*animate, "--steps", "2", "-o", "no/such/a%d.png"), ("no/such",)),
            ((*animate, "--frames", "3"), ("--frames", "--animate")),
            ((*animate, "--steps", "2", "-o", "a.gif"), ("-o", "a.gif", ".apng")),
            ((*animate, "--steps", "2", "-o", "a.mp4"), ("-o", "a.mp4", ".apng")),
            ((*animate, "--steps", "2", "-o", "a%d.webp"), ("-o", "a%d.webp", ".apng")),
            ((*animate, "--steps", "2", "-o", "a.apng", "-o", "./a.apng"), ("-o", "a.apng", "twice")),
            ((*animate, "--steps", "2", "-o", "no/a.apng"), ("no/a.apng",)),
            ((*animate, "--steps", "2", "-o", "a%d.png", "--fps", "9"), ("--fps", ".apng")),
            (("-o", "a.apng"), ("a.apng",)),
            (("--turntable", "1"), ("--turntable", "1")),
            (("--turntable", "4", "--eye", "0,0,1"), ("--eye", "--turntable")),
            (("--turntable", "4", "--steps", "4"), ("--steps", "--turntable")),
            (("--turntable", "4", *animate), ("--animate", "--turntable"))):
        done = bench.run("render", *ROW, *words)
        check(done.code in (2, 7), f"exit code\n{done.describe()}")
        done.expect_one_line(*needles)
        check(bench.left_behind() == [], f"left {bench.left_behind()}\n{done.describe()}")


@case("animation.a_row_never_writes_over_its_input")
def a_row_never_writes_over_its_input(bench):
    scratch(bench, "in_1.pfm", pfm(8, 4, bright))
    done = bench.run("render", "builtin:plate", "--env", "in_1.pfm", "--size", "16x16", "--env-size", "16", "--animate", "roughness=0:1",
                     "--steps", "3", "-o", "in_%d.pfm").expect(2)
    done.expect_one_line("in_1.pfm")
    check(bench.left_behind() == ["in_1.pfm"], f"left {bench.left_behind()}")


def flickering(bench, words=(), code=0):
    done = bench.run("compare", "--sequence", "r%02d.pfm", "t%02d.pfm", *words, "--json", "-").expect(code)
    return json.loads(done.out)


def rows(bench, test, count=3):
    for i in range(count):
        scratch(bench, f"r{i:02}.pfm", pfm(24, 16, bright))
        scratch(bench, f"t{i:02}.pfm", pfm(24, 16, test(i)))


@case("animation.flicker_is_what_neighbours_differ_by", tier="nightly")
def flicker_is_what_neighbours_differ_by(bench):
    darker = lambda x, y: (0.1 * x, 0.2 * y, 0.7)
    rows(bench, lambda i: darker) # wrong, but constant
    still = flickering(bench)
    check(still["flicker"] == 0.0 and still["flip_mean"] > 0.01, f"{still}")
    rows(bench, lambda i: darker if i == 1 else bright) # right except for one frame
    one = flickering(bench, ("--fail-flicker", "0.001"), code=1)
    check(one["worst_frame"] == 1 and abs(one["flip_mean"] - one["flip_worst"] / 3) < 1e-9, f"{one}")
    check(one["flicker"] > 0.01 and one["reference_change"] == 0.0 and len(one["by_frame"]) == 3, f"{one}")
    for i in range(3): # the reference flickers equally: the test adds no flicker
        (bench.folder / f"r{i:02}.pfm").write_bytes((bench.folder / f"t{i:02}.pfm").read_bytes())
    moving = flickering(bench, ("--fail-flicker", "0"))
    check(moving["flicker"] == 0.0 and moving["reference_change"] > 0.01, f"{moving}")


@case("animation.rows_that_do_not_match_are_refused")
def rows_that_do_not_match_are_refused(bench):
    def refused(code, *needles, words=("r%02d.pfm", "t%02d.pfm")):
        done = bench.run("compare", "--sequence", *words, "--json", "o.json").expect(code)
        done.expect_one_line(*needles)
        if code == 2:
            check("o.json" not in bench.left_behind(), "a file is left")
            return
        found = json.loads((bench.folder / "o.json").read_text())
        check(found["verdict"] == "failed" and all(needle in found["test"] + found["reason"] for needle in needles), f"{found}")
        (bench.folder / "o.json").unlink()

    rows(bench, lambda i: bright)
    refused(2, "REFERENCE", "a.pfm", words=("a.pfm", "t%02d.pfm"))
    refused(4, "q%02d.pfm", words=("q%02d.pfm", "q%02d.pfm"))
    (bench.folder / "t01.pfm").unlink()
    refused(4, "t01.pfm", "missing")
    (bench.folder / "r01.pfm").unlink()
    refused(4, "r01.pfm", "missing") # missing in both: a gap
    rows(bench, lambda i: bright)
    scratch(bench, "t02.pfm", pfm(23, 16, bright))
    refused(3, "t02.pfm", "23x16")
    scratch(bench, "t02.pfm", pfm(24, 16, lambda x, y: (float("nan"), 0, 0)))
    refused(6, "t02.pfm", "NaN")
    done = bench.run("compare", "--fail-flicker", "1", "r00.pfm", "r00.pfm").expect(2)
    done.expect_one_line("--fail-flicker", "--sequence")
