"""burnish profile: the figures are consistent, and profiling does not change the image."""

import json
import xml.etree.ElementTree as tree

from harness import SMALL, case, check

STAGES = ["prepare", "cull", "transform", "setup", "bin", "gather", "clear", "coverage", "visibility", "background", "shade", "resolve"]


def profile(bench, *arguments, code=0):
    return json.loads(bench.run("profile", *arguments, "--json", "-").expect(code).out)


@case("profile.figures_add_up")
def figures(bench):
    found = profile(bench, *SMALL, "--technique", "major_axis", "--threads", "1", "--frames", "3")
    check([s["name"] for s in found["stages"]] == STAGES, f"stages: {found['stages']}")
    times = {s["name"]: s["ms"] for s in found["stages"]}
    check(all(ms > 0 for ms in times.values()), f"a stage takes no time: {times}")
    share = sum(s["share"] for s in found["stages"])
    check(0.97 < share < 1.001, f"the shares add up to {share}")
    for s in found["stages"]:
        check(abs(s["share"] - s["ms"] / found["busy_ms"]) < 1e-9, f"share of {s}")
    # On one thread the stages make up the frame; the whole has a separate clock.
    check(abs(found["waiting_ms"]) < 0.15 * found["busy_ms"], f"{found['waiting_ms']} ms of {found['busy_ms']} are in no stage")
    kernels = sum(k["ms"] for k in found["kernels"])
    check(found["kernels"] and abs(kernels - times["shade"]) < 1e-6, f"kernels take {kernels} ms, shade {times['shade']}")
    for k in found["kernels"]:
        check(k["technique"] == "major_axis" and k["material"] and 0 < k["lanes"]["occupancy"] <= 1, f"kernel {k}")
        check(k["lanes"]["used"] <= k["lanes"]["all"], f"kernel {k}")
    check(0 < found["ms_without_profile"] and 0 < found["ms"], "no frame time")


@case("profile.fragments_are_shaded_once")
def fragments(bench):
    """Where pixels share samples, tiles overlap, and fragments at their rims are shaded more than once."""
    alone = ("--technique", "bent_normal")
    for options in (("--msaa", "1", *alone), ("--msaa", "8", "builtin:spheres", *alone), ("--tile-size", "32", *alone), ("--technique", "lobe_line")):
        shares = "lobe_line" in options
        options = (*SMALL, *options)
        stats = bench.figures(*options, "--floor", "off")
        for isa, lanes in (("scalar", 1), ("avx2", 8)):
            found = profile(bench, *options, "--frames", "2", "--threads", "2", "--isa", isa)
            check(found["pixel_hash"] == stats["pixel_hash"], f"{options}: the picture changes when it is profiled")
            check(found["fragments"]["visible"] == stats["visible_fragments"], f"{options}: {found['fragments']}")
            shaded, visible = found["fragments"]["shaded"], found["fragments"]["visible"]
            check(shaded == visible or (shares and visible < shaded < 1.3 * visible), f"each visible fragment is shaded once: {found['fragments']}")
            check(sum(k["lanes"]["used"] for k in found["kernels"]) == found["fragments"]["shaded"], f"lanes: {found['kernels']}")
            check(all(k["lanes"]["all"] % lanes == 0 for k in found["kernels"]), f"{isa}: {found['kernels']}")
            check(lanes > 1 or all(k["lanes"]["occupancy"] == 1 for k in found["kernels"]), f"{isa}: {found['kernels']}")
            tiles = found["tiles"]
            side = found["tile_size"] - (9 if shares else 0)  # from one tile to the next
            check(tiles["count"] == -(-160 // side) * -(-120 // side), f"tiles: {tiles}")
            check(tiles["slowest_ms"] >= tiles["mean_ms"] > 0, f"tiles: {tiles}")
            check(abs(tiles["slowest_to_mean"] * tiles["mean_ms"] - tiles["slowest_ms"]) < 1e-9, f"tiles: {tiles}")
            busy = found["threads_busy_ms"]
            check(len(busy) == 2 and abs(sum(busy) - found["busy_ms"]) < 1e-6, f"threads: {busy} of {found['busy_ms']}")


@case("profile.files_show_every_stage")
def files(bench):
    done = bench.run("profile", *SMALL, "--frames", "2", "--threads", "2", "--json", "p.json", "--svg", "p.svg", "--trace", "p.trace", "-o", "p.png")
    done.expect(0)
    check(bench.left_behind() == ["p.json", "p.png", "p.svg", "p.trace"], f"files: {bench.left_behind()}")
    for word in (*STAGES, "write", "all stages", "fragments", "slowest"):
        check(word in done.out, f"the table does not say {word}\n{done.describe()}")
    found = json.loads((bench.folder / "p.json").read_text())
    check(found["write_ms"] > 0, "no time to write")
    spans = [e["name"] for e in json.loads((bench.folder / "p.trace").read_text())["traceEvents"] if e["ph"] == "X"]
    for stage in STAGES:
        check(stage in spans, f"the trace does not show {stage}")
    parts = spans.count("coverage")  # a crowded tile is drawn in 16 parts
    check(parts % 3 == 0 and (parts // 3 - found["tiles"]["count"]) % 15 == 0 and parts >= 3 * found["tiles"]["count"],
          f"a span of coverage for every tile, or part of one, of the three profiled frames: {parts}")
    root = tree.parse(bench.folder / "p.svg").getroot()
    svg = "{http://www.w3.org/2000/svg}"
    titles = [t.text for t in root.iter(svg + "title")]
    check(any(t.startswith("shade ") for t in titles), f"boxes: {titles}")
    boxes = {"frame": 0.0, "stages": 0.0}
    for group in root.iter(svg + "g"):
        width, row = float(group.find(svg + "rect").get("width")), float(group.find(svg + "rect").get("y"))
        if group.get("class") == "frame":
            boxes["frame"], first = width, row
        elif row == first + 34:
            boxes["stages"] += width
    check(boxes["frame"] > 100 and abs(boxes["stages"] / boxes["frame"] - 1) < 0.01, f"widths: {boxes}")


@case("profile.draws_the_picture_that_render_draws")
def same_picture(bench):
    for resolve in ("linear", "display"):
        words = ("builtin:spheres", "--size", "96x64", "--msaa", "4", "--exposure", "3", "--env-size", "64", "--env-samples", "32", "--resolve", resolve)
        bench.run("profile", *words, "--frames", "1", "-o", "p.png").expect(0)
        bench.run("render", *words, "--floor", "off", "-o", f"{resolve}.png").expect(0)
        check((bench.folder / "p.png").read_bytes() == (bench.folder / f"{resolve}.png").read_bytes(), f"--resolve {resolve}: another picture")
    check((bench.folder / "linear.png").read_bytes() != (bench.folder / "display.png").read_bytes(), "both ways are one: nothing is tested")
    words = ("builtin:sphere", "--size", "48x32", "--env-size", "64", "--env-samples", "32", "--no-background")
    bench.run("profile", *words, "--frames", "1", "-o", "p.exr").expect(0)
    bench.run("render", *words, "-o", "r.exr").expect(0)
    check((bench.folder / "p.exr").read_bytes() == (bench.folder / "r.exr").read_bytes(), "--no-background: another picture")


@case("profile.wrong_options_say_one_line_and_exit_2")
def usage(bench):
    bench.run("profile", *SMALL, "--backend", "reference").expect(2).expect_one_line("--backend")
    bench.run("profile", *SMALL, "--stats", "-").expect(2).expect_one_line("--stats")
    for words in (("--aov", "depth", "-o", "a.exr"), ("--risks", "-"), ("--animate", "roughness=0:1"), ("--turntable", "4"), ("--shadows", "ratio"), ("--floor", "stage")):
        bench.run("profile", *SMALL, *words).expect(2).expect_one_line(words[0], "belongs to burnish render")
    bench.run("profile", *SMALL, "--json", "a", "--svg", "a").expect(2).expect_one_line("twice")
    bench.run("profile", *SMALL, "--json", "").expect(2).expect_one_line("--json")
    bench.run("profile", "absent.glb", "--json", "a.json").expect(4).expect_one_line("absent.glb")
    bench.run("profile", *SMALL, "--json", "absent/a.json").expect(7)
    check(bench.left_behind() == [], f"files: {bench.left_behind()}")
