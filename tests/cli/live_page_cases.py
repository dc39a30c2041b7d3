"""Pages with the renderer inside: contents of files, requests that fail, and pages of charts, goldens and comparisons in Chromium."""

import base64
import json
import shutil
import struct

from browser import Browser
from harness import case, check
from serve_cases import hash_of_command
from wasm_cases import ROOT, masked, package, parts_of, program_hash


def no_renderer(bench, name, script="var Module = 1;\nexport default Module;", version=None):
    """Writes a folder that looks like the package."""
    folder = bench.folder / name
    folder.mkdir(exist_ok=True)
    (folder / "burnish_core.wasm").write_bytes(b"\0asm module")
    (folder / "burnish_core.mjs").write_text(script)
    (folder / "package.json").write_text(json.dumps({"version": version or bench.run("--version").expect(0).out.split()[1]}))


@case("wasm.pages_hold_what_the_program_draws", budget=8)
def pages_hold(bench):
    """Reads the contents of pages, with a renderer that cannot run."""
    no_renderer(bench, "renderer")
    words = ("--roughness", "0.3", "--technique", "auto", "--no-background", "--env", "builtin:sky", "--env-size", "16", "--size", "32x24")
    bench.run("export", "page", "builtin:sphere", *words, "--renderer", "renderer", "-o", "page.html").expect(0)
    page, files = parts_of((bench.folder / "page.html").read_text())
    check(not files and page["target"] == "builtin:sphere" and page["rows"]["page"]["environment"] == "builtin:sky", str(page))
    row = page["rows"]["page"]
    check(row["options"] == {"--roughness": "0.3", "--technique": "auto", "--no-background": "", "--env-size": "16"}, str(row["options"]))
    check(row["hash"] == program_hash(bench, "builtin:sphere", *words) == hash_of_command(bench, row["command"]), str(row))
    # Several lights, and numbers as they are given
    words = ("--light", "sphere:points=0,1,0:radius=0.1:radiance=9,9,9", "--light", "sphere:points=1,1,0:radius=0.1:radiance=9,2,2", "--roughness", "0.123456789",
             "--env-size", "16", "--size", "32x24")
    bench.run("export", "page", "builtin:sphere", *words, "--renderer", "renderer", "-o", "lights.html", "-q").expect(0)
    row = parts_of((bench.folder / "lights.html").read_text())[0]["rows"]["page"]
    check(row["options"]["--light"] == ";".join(words[1:4:2]) and row["hash"] == program_hash(bench, "builtin:sphere", *words), str(row))
    # An environment beside a built-in scene: the page serves a folder
    bench.run("export", "page", "builtin:sphere", "--env", bench.data_file("env/workshop_1k.hdr"), "--env-size", "16", "--size", "16x16", "--renderer", "renderer", "-o",
              "light.html", "-q").expect(0)
    page, files = parts_of((bench.folder / "light.html").read_text())
    check(page["target"] == "scenes" and list(files) == ["scenes/" + page["rows"]["page"]["environment"]], f"{page['target']} {list(files)}")
    # JPEG images within a file
    bench.run("render", "builtin:sphere", "--size", "16x16", "--env-size", "16", "-o", "within.jpg").expect(0)
    (bench.folder / "within.gltf").write_text(masked({"uri": "data:image/jpeg;base64," + base64.b64encode((bench.folder / "within.jpg").read_bytes()).decode()}))
    bench.run("export", "page", "within.gltf", "--env-size", "16", "--size", "16x16", "--renderer", "renderer", "-o", "within.html", "-q").expect(0)
    check(sum(name.startswith("decoded/") for name in parts_of((bench.folder / "within.html").read_text())[1]) == 1, "the image is not decoded")
    # A model with files of odd names and in folders, whose images are JPEG files
    (bench.folder / "scene/textures").mkdir(parents=True)
    model = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0, "nodes": [{"mesh": 0}],
             "buffers": [{"uri": "shape <1>.bin", "byteLength": 60}], "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                           {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
             "images": [{"uri": "textures/colour.jpg"}], "textures": [{"source": 0}],
             "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}]}
    (bench.folder / "scene/shape <1>.bin").write_bytes(struct.pack("<15f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1))
    (bench.folder / "scene/model.gltf").write_text(json.dumps(model))
    bench.run("render", "builtin:sphere", "--size", "16x16", "--env-size", "16", "-o", "scene/textures/colour.jpg").expect(0)
    bench.run("export", "page", "scene/model.gltf", "--env-size", "16", "--size", "16x16", "--renderer", "renderer", "-o", "model.html", "-q").expect(0)
    page, files = parts_of((bench.folder / "model.html").read_text())
    check(page["target"] == "model.gltf", page["target"])
    decoded = [name for name in files if name.startswith("decoded/")]
    check(set(files) == {"shape &lt;1&gt;.bin", "model.gltf", "textures/colour.jpg", *decoded} and len(decoded) == 1, str(list(files)))
    check(files[decoded[0]].startswith(b"\x89PNG"), "no PNG")
    for name in ("model.gltf", "textures/colour.jpg"):
        check(files[name] == (bench.folder / "scene" / name).read_bytes(), name)


@case("wasm.wrong_requests_for_pages_say_one_line", budget=4)
def wrong_pages(bench):
    bench.run("export", "page", "-o", "x.html").expect(2).expect_one_line("SCENE")
    bench.run("export", "page", "builtin:sphere", "-o", "x.html", "--renderer", ".").expect(77).expect_one_line("cmake --preset wasm")
    no_renderer(bench, ".", "nothing")
    bench.run("export", "page", "builtin:sphere", "-o", "x.html", "--renderer", ".").expect(4).expect_one_line("exports no Module")
    no_renderer(bench, ".", version="9.9")
    bench.run("export", "page", "builtin:sphere", "-o", "x.html", "--renderer", ".").expect(4).expect_one_line("version")
    no_renderer(bench, ".")
    bench.run("export", "page", "gone.glb", "-o", "x.html", "--renderer", ".").expect(4).expect_one_line("gone.glb")
    bench.run("export", "page", "builtin:none", "-o", "x.html", "--renderer", ".").expect(2).expect_one_line("none")
    bench.run("export", "glsl", "builtin:sphere", "--technique", "mc", "-o", "x.glsl").expect(2).expect_one_line("SCENE")
    bench.run("export", "glsl", "--technique", "mc", "--roughness", "0.3", "-o", "x.glsl").expect(2).expect_one_line("--roughness", "WHAT page")
    bench.run("export", "glsl", "--technique", "auto", "-o", "x.glsl").expect(2).expect_one_line("--technique", "auto")
    bench.run("export", "glsl", "-o", "x.glsl").expect(2).expect_one_line("--technique")
    # Refuse scenes and sizes that a page cannot hold
    for words, code, needle in ((("builtin:sphere", "--size", "5000x20"), 2, "--size"), (("builtin:sphere", "--size", "1920x1200", "--msaa", "16"), 2, "--size"),
                                (("builtin:sphere", "--env", bench.data_file("flip/ldr_ref.png")), 4, ".hdr"),
                                ((bench.data_file("models/AnisotropyStrengthTest_meshopt.glb"),), 4, "EXT_meshopt_compression"),
                                (("builtin:sphere", "--light", "quad:points=-1,2,-1;1,2,-1;1,2,1;-1,2,1:texture=t.png"), 2, "texture=")):
        bench.run("export", "page", *words, "--env-size", "16", "-o", "x.html", "--renderer", ".").expect(code).expect_one_line(needle)
    # Of a comparison's test
    bench.run("render", "builtin:sphere", "--size", "20x10", "--env-size", "16", "-o", "a.png").expect(0)
    for words, code, needle in (((), 2, "--html"), (("--html", "x.html", "--live", "builtin:sphere 'a"), 2, "quote"), (("--html", "x.html", "--live", "builtin:sphere --no-such"), 2, "--no-such"),
                                (("--html", "x.html", "--live", "builtin:sphere --as-table t.exr"), 2, "reads or writes a file"), (("--html", "x.html", "--live", "gone.glb"), 4, "gone.glb")):
        bench.run("compare", "a.png", "a.png", *(words or ("--live", "builtin:sphere")), "--renderer", ".").expect(code).expect_one_line(needle)
    bench.run("compare", "a.png", "a.png", "--html", "x.html", "--renderer", ".").expect(2).expect_one_line("--renderer", "--live")
    done = bench.run("compare", "a.png", "a.png", "--html", "y.html", "--live", "builtin:sphere --size 32x10 --env-size 16", "--renderer", ".").expect(0)
    check("draws another picture than a.png" in done.err, done.err)
    for words, same in ((("--no-background",), True), ((), True), (("--roughness", "0.9"), False)):
        bench.run("render", "builtin:sphere", "--size", "20x10", "--env-size", "16", *words[:1] * same, "-o", "b.png", "-o", "b.exr").expect(0)
        for name in ("b.png", "b.exr"):
            done = bench.run("compare", name, name, "--html", "y.html", "--live", " ".join(("builtin:sphere --size 20x10 --env-size 16", *words)), "--renderer", ".").expect(0)
            check(("draws another picture than" in done.err) != same, f"{words} {name}: {done.err}")
    # Before the work, not after it
    (bench.folder / "m.json").write_text(json.dumps({"rows": [{"name": "a", "scene": "builtin:sphere"}]}))
    bench.run("golden", "check", "m.json", "--live", "--renderer", "none").expect(77).expect_one_line("cmake --preset wasm")
    bench.run("golden", "merge", "m.json", "--live").expect(2).expect_one_line("--live")
    bench.run(*CHART, "--live", "--renderer", "none", "-o", "r").expect(77).expect_one_line("cmake --preset wasm")
    check(not (bench.folder / "golden-results").exists() and not (bench.folder / "x.html").exists() and not (bench.folder / "x.glsl").exists(), "a failure leaves a file")


CHART = ("chart", "builtin:plate", "--size", "64x36", "--msaa", "4", "--env-size", "64", "--env-samples", "32", "--reference-samples", "16", "--runs", "1",
         "--no-cache", "--techniques", "bent_normal,major_axis", "--sweep", "samples=4", "--sweep", "roughness=0.3", "--orbit", "20,40")


def page_rows(path):
    return parts_of(path.read_text())[0]["rows"]


@case("wasm.charts_draw_their_rows_anew", budget=6)
def live_chart(bench):
    no_renderer(bench, "renderer")
    bench.run(*CHART, "--live", "--renderer", "renderer", "-o", "r").expect(0)
    rows = page_rows(bench.folder / "r/report.html")
    chart = json.loads((bench.folder / "r/report.html").read_text().split('id="data">', 1)[1].split("</script>", 1)[0].replace("\\u003c", "<"))
    check(len(rows) == 2 and set(rows) == set(chart["rows"]), f"{list(rows)} and {list(chart['rows'])}")
    for key, row in rows.items():
        check(row["hash"] == hash_of_command(bench, row["command"]), str(row))
        # The same picture as the chart's own, which is a JPEG file: another technique differs ten times as much
        (bench.folder / "own.jpg").write_bytes(base64.b64decode(chart["rows"][key]["picture"].split(",", 1)[1]))
        bench.run("compare", "own.jpg", "picture.png", "--fail-flip", "0.06", "-q").expect(0)
    swept = [*CHART[:-4], "--sweep", "roughness=0.3", "--sweep", "glass=body,interface"]
    bench.run(*swept, "--live", "--renderer", "renderer", "-o", "swept").expect(0)
    values = sorted(row["options"]["--glass"] for row in page_rows(bench.folder / "swept/report.html").values())
    check(values == ["body", "body", "interface", "interface"], str(values))
    done = bench.run(*CHART, "--normal-map", bench.data_file("flip/ldr_ref.png"), "--live", "--renderer", "renderer", "-o", "mapped").expect(0)
    check("an option reads a file" in done.err and "burnish-wasm" not in (bench.folder / "mapped/report.html").read_text(), done.describe())
    bench.run(*CHART, "-o", "plain").expect(0)
    check("burnish-wasm" not in (bench.folder / "plain/report.html").read_text(), "a renderer that nobody asked for")


@case("wasm.goldens_that_differ_are_drawn_anew", budget=6)
def live_golden(bench):
    no_renderer(bench, "renderer")
    small = ["--size", "32x24", "--env-size", "16", "--env-samples", "16", "--floor", "off"]
    model = bench.data_file("models/AnisotropyStrengthTest.glb")
    (bench.folder / "set").mkdir()
    shutil.copy(model, bench.folder / "set/model.glb")
    (bench.folder / "set/light.hdr").write_bytes(bench.data_file("env/workshop_1k.hdr").read_bytes())
    (bench.folder / "set/night").mkdir()
    bench.run("render", "builtin:plate", "--env", "builtin:night", "--size", "64x32", "--env-size", "16", "--env-samples", "16", "-o", "set/night/light.hdr").expect(0)

    def write(roughness):
        rows = [{"name": "ball <1>", "scene": "builtin:sphere", "options": ["--roughness", roughness]}, {"name": "same", "scene": "builtin:sphere"},
                {"name": "model", "scene": "model.glb", "options": ["--env", "light.hdr", "--exposure", roughness]},
                {"name": "night", "scene": "model.glb", "options": ["--env", "night/light.hdr", "--exposure", roughness]},
                {"name": "threads", "scene": "builtin:plate", "options": ["--roughness", roughness, "--threads", "1", "--no-cache"]},
                {"name": "table", "scene": "builtin:lights", "options": ["--roughness", roughness, "--ltc-table", "table.ltc"]}]
        (bench.folder / "set/m.json").write_text(json.dumps({"defaults": {"options": small}, "rows": rows}))

    shutil.copy(ROOT / "shading/bake/ltc/ggx.ltc", bench.folder / "set/table.ltc")
    write("0.2")
    bench.run("golden", "check", "set/m.json").expect(5)
    bench.run("golden", "bless", "set/m.json").expect(0)
    write("0.4")
    bench.run("golden", "check", "set/m.json", "--live", "--renderer", "renderer").expect(1)
    text = (bench.folder / "golden-results/index.html").read_text()
    page, files = parts_of(text)
    check(set(page["rows"]) == {"ball <1>", "model", "night", "threads"}, str(page["rows"]))
    for row in page["rows"].values():
        check(row["hash"] == hash_of_command(bench, row["command"]), str(row))
    check(sum(name.endswith("/model.glb") for name in files) == 1 and page["target"] == "scenes", str(list(files)))
    check(files["scenes/" + page["rows"]["model"]["scene"]] == model.read_bytes(), str(list(files)))
    for name, path in (("model", "set/light.hdr"), ("night", "set/night/light.hdr")):  # two lights of one name
        check(files["scenes/" + page["rows"][name]["environment"]] == (bench.folder / path).read_bytes(), f"{name}: {list(files)}")


@case("wasm.a_comparison_draws_its_test_anew", "of_wasm", tier="nightly", budget=100)
def compared(bench):
    words = ("builtin:sphere", "--size", "160x90", "--env-size", "32", "--floor", "off")
    for name, technique in (("a", "mc"), ("b", "bent_normal")):
        bench.run("render", *words, "--technique", technique, "-o", f"{name}.exr").expect(0)
    done = bench.run("compare", "a.exr", "b.exr", "--html", "c.html", "--live", " ".join((*words, "--technique bent_normal")), "--renderer", package(bench)).expect(0)
    check("another picture" not in done.err, done.err)
    with Browser(bench.folder) as browser:
        browser.size(1000, 800)
        browser.open(bench.folder / "c.html")
        browser.value("document.querySelector('.burnish-open').click()")
        inside = "document.querySelector('dialog.burnish-live iframe')?.contentDocument"
        browser.until(f"{inside}?.body?.dataset.proof", 120)
        check(browser.value(f"{inside}.body.dataset.proof") == "same", browser.value(f"{inside}.getElementById('proof').textContent"))
        check(not browser.faults, str(browser.faults))
    done = bench.run("compare", "a.exr", "a.exr", "--html", "d.html", "--live", " ".join((*words, "--technique bent_normal")), "--renderer", package(bench)).expect(0)
    check("draws another picture than a.exr" in done.err, done.err)


@case("wasm.rows_of_reports_open_in_the_page", "of_wasm", tier="nightly", budget=150)
def opens(bench):
    bench.run(*CHART, "--live", "--renderer", package(bench), "-o", "r").expect(0)
    rows = page_rows(bench.folder / "r/report.html")
    with Browser(bench.folder) as browser:
        browser.size(1200, 800)
        browser.open(bench.folder / "r/report.html")
        buttons = browser.value("document.querySelectorAll('.burnish-open').length")
        check(buttons == 2, f"{buttons} buttons")
        inside = "document.querySelector('dialog.burnish-live iframe')?.contentDocument"
        hashes = set()
        for number in range(buttons):
            browser.value(f"document.querySelectorAll('.burnish-open')[{number}].click()")
            browser.until(f"{inside}?.body?.dataset.proof", 120)
            check(browser.value(f"{inside}.body.dataset.proof") == "same", browser.value(f"{inside}.getElementById('proof').textContent"))
            hashes.add(browser.value(f"{inside}.getElementById('proof').textContent").split()[-1])
            browser.screenshot(bench.folder / f"open-{number}.png", whole=False)
            browser.value("document.querySelector('dialog.burnish-live button').click()")
            browser.until("!document.querySelector('dialog')")
        check(hashes == {row["hash"] for row in rows.values()}, f"{hashes} and {rows}")
        check(not browser.faults, str(browser.faults))
