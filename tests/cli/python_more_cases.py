"""The Python package for editors, notebooks and other libraries: stubs, HTML, DLPack, arrays, and the examples."""

import ast
import json
import pathlib
import re
import shutil
import subprocess
import sys
import zipfile

from harness import Skipped, case, check
from python_cases import FRAME, KEYWORDS, ROOT, environment, library, python, pythons

PACKAGE, EXAMPLES = ROOT / "apps/python/burnish", ROOT / "apps/examples/python"
STUB = PACKAGE / "__init__.pyi"
FUNCTIONS = {"load": (None, "load"), "meshes": (None, "meshes"), "render": ("Scene", "render"), "reference": ("Scene", "reference"), "Mesh": ("Mesh", "__init__"), "set_material": ("Scene", "set_material"), "set_light": ("Scene", "set_light"),
             "set_environment": ("Scene", "set_environment")}


def keywords_of(function):
    """Returns {name: (type, default)} of a function's keywords in the stub, as texts."""
    owner, name = FUNCTIONS[function]
    tree = ast.parse(STUB.read_text())
    body = tree.body if owner is None else next(node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == owner).body
    arguments = next(node for node in body if isinstance(node, ast.FunctionDef) and node.name == name).args
    return {a.arg: (ast.unparse(a.annotation), ast.unparse(d)) for a, d in zip(arguments.kwonlyargs, arguments.kw_defaults)}


def run(bench, *words, code=0, program=sys.executable, **more):
    done = subprocess.run([program, "-B", *map(str, words)], cwd=bench.folder, env=environment(bench, **more), capture_output=True, text=True, timeout=120)
    check(done.returncode == code, f"{words}\nended with {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done


@case("python.stubs_are_those_of_the_option_tables")
def stubs(bench):
    """apps/python/make_stubs.py rewrites them."""
    made = run(bench, ROOT / "apps/python/make_stubs.py", "-o", "-").stdout
    check(made == STUB.read_text(), "apps/python/burnish/__init__.pyi differs from the text of apps/python/make_stubs.py")
    named = set().union(*(keywords_of(name) for name in FUNCTIONS if name != "Mesh" and not name.startswith("set_"))) | {"samples"}
    listed = python(bench, "print(*burnish.options()); print(*burnish._native.known() - set(burnish.options()))").stdout.splitlines()
    named -= {"environment", "progress"}
    check(named == set(listed[0].split()), f"the stubs and burnish.options() differ by {named ^ set(listed[0].split())}")
    factors = set(keywords_of("Mesh")) | set(keywords_of("set_light"))
    check(set(listed[1].split()) <= factors and set(keywords_of("set_material")) == set(keywords_of("Mesh")), "a factor is missing")
    for name in named:
        check(re.search(rf"^ +{name}: [^=\n]*[^\s,]\.?$", made, re.M), f"{name} has no meaning")
    check("FrameDesc" not in made and "{}" not in made, "a name that users do not know")


@case("python.stubs_have_the_defaults_of_the_library", budget=10)
def defaults(bench):
    """The picture with every default written out is the picture without keywords, and each name of a choice is taken."""
    given = {name: "dict(" + ", ".join(f"{k}={d}" for k, (_, d) in keywords_of(name).items() if k not in ("width", "height", "env_size", "env_samples", "environment", "progress")) + ")" for name in FUNCTIONS if not name.startswith("set_")}
    choices = {k: ast.literal_eval("[" + t[len("Literal[") : -1] + "]") for k, (t, _) in keywords_of("render").items() if t.startswith("Literal[")}
    done = python(bench, f"""
square = dict(positions=[(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], triangles=[(0, 1, 2), (0, 2, 3)], coordinates=[0, 1, 1, 1, 1, 0, 0, 0])
load, scene = (lambda **k: burnish.load('builtin:plate', {KEYWORDS}, **k)), burnish.load('builtin:plate', {KEYWORDS})
print(scene.render({FRAME}).hash, scene.render({FRAME}, **{given['render']}).hash, load(**{given['load']}).render({FRAME}).hash)
print(burnish.meshes(burnish.Mesh(**square), {KEYWORDS}).render({FRAME}).hash, burnish.meshes(burnish.Mesh(**square, **{given['Mesh']}), {KEYWORDS}, **{given['meshes']}).render({FRAME}).hash)
tiny = dict(width=16, height=12)
for name, values in {choices}.items():
    for value in values: scene.render(**tiny, **{{'technique': 'mc', 'samples': 1, name: value}})    # mc takes every model
    try: scene.render(**tiny, **{{name: 'none such'}})
    except burnish.Error as error: assert name in str(error), error
    else: raise SystemExit(name)
for floor in ('shadow', 'stage', 'mirror'): load(floor=floor)
for name in ('auto', *burnish.techniques()): scene.render(**tiny, technique=name)
try: scene.render(widht=None)
except burnish.Error as error: assert 'widht' in str(error)
else: raise SystemExit('widht was taken')
try: print(scene.reference(2, **tiny).hash, scene.reference(2, **tiny, **{given['reference']}).hash)
except burnish.Error as error: assert error.code == 77
""")
    for line in done.stdout.splitlines():
        check(len(set(line.split())) == 1, f"hashes with and without the defaults: {line}")


@case("python.type_checkers_read_the_stubs", tier="nightly")
def types(bench):
    mypy = shutil.which("mypy")
    if not mypy:
        raise Skipped("no mypy")
    good, bad = bench.folder / "good.py", bench.folder / "bad.py"
    good.write_text('import burnish\nscene = burnish.load("x.glb", env_size=64)\npicture = scene.render(technique="mc", layers=["depth"], eye=(1, 2, 3))\n'
                    "print(burnish.compare(picture, picture.pixels).flip_mean + 1.0)\nburnish.meshes(burnish.Mesh([1], metallic=1))\n")
    bad.write_text('import burnish\nscene = burnish.load("x.glb", widht=3)\nscene.render(technique="none")\nscene.render(width="3")\n')
    for file, code in ((good, 0), (bad, 1)):
        done = subprocess.run([mypy, "--strict", "--cache-dir", str(bench.folder / "cache"), str(file)], env={**environment(bench), "MYPYPATH": str(ROOT / "apps/python")},
                              capture_output=True, text=True, timeout=300)
        check(done.returncode == code, done.stdout + done.stderr)
    check(all(f"bad.py:{line}: error" in done.stdout for line in (2, 3, 4)) and "Found 3 errors" in done.stdout, done.stdout)


@case("python.a_wheel_holds_stubs_and_all_modules", budget=10)
def wheel(bench):
    made = run(bench, ROOT / "apps/python/make_wheel.py", "--library", library(bench), "-o", bench.folder / "wheels").stdout.strip()
    with zipfile.ZipFile(made) as files:
        missing = {str(path.relative_to(PACKAGE.parent)) for path in PACKAGE.rglob("*") if path.suffix in (".py", ".pyi", ".typed")} - set(files.namelist())
        check(not missing and {"burnish/py.typed", "burnish/__init__.pyi", "burnish/offscreen/__init__.py"} <= set(files.namelist()), missing)


@case("python.sources_are_those_of_python_3_9", tier="quick")
def old_python(bench):
    """Grammar alone: whether the modules exist in 3.9 is for a reader."""
    for path in (*PACKAGE.rglob("*.py"), *EXAMPLES.glob("*.py"), *PACKAGE.parent.glob("*.py")):
        ast.parse(path.read_text(), str(path), feature_version=(3, 9))
    for path in EXAMPLES.glob("*.py"):
        check(len(path.read_text().splitlines()) < 60, f"{path.name} is too long for an example")


@case("python.notebooks_show_pictures_and_escape_names", budget=10)
def shown(bench):
    bench.folder.joinpath('<i>"&.glb').write_bytes(pathlib.Path(bench.data_file("models/AnisotropyBarnLampSmall.glb")).read_bytes())
    for program in pythons():
        python(bench, f"""
import base64, re
from burnish import _png, _show
scene = burnish.load('<i>"&.glb', environment='builtin:studio', {KEYWORDS})
picture, other = scene.render({FRAME}, technique='bent_normal', layers=['depth', 'normal']), scene.render({FRAME}, roughness=0.9)
html = burnish.compare(picture, other)._repr_html_()
for text in (scene._repr_html_(), picture._repr_html_(), html): assert '<i>' not in text and '&lt;i&gt;&quot;&amp;.glb' in text, text[-200:]
sizes = [_png.decode(base64.b64decode(data))[:2] for data in re.findall('base64,([^"]+)"', html)]
assert sizes == [(96, 64)] * 3 and 'technique bent_normal' in html, sizes
figure = burnish.compare(picture, other).flip_mean
assert all(name in html for name in _show.MEANINGS) and f'{{figure:.6g}}' in html
assert scene._repr_png_() == scene.render(width=240, height=180, msaa=4).png() and picture._repr_png_() == picture.png()
map_of = lambda a, b, w, h: _png.decode(_show.difference_map(a, b, w, h)[0])
assert map_of([1.0] * 6, [1, 1, 1, 1e9, 1e9, 1e9], 2, 1) == (2, 1, bytes(_show.SCALE[0] + _show.SCALE[-1]))
assert map_of([0.5] * 900 * 3, [0.5] * 900 * 3, 900, 1)[:2] == (300, 1)
flat = bytes(range(256)) * 3
assert _png.decode(_png.encode(16, 16, flat)) == (16, 16, flat)
width, height, rgb = _png.decode(picture.png())
raw, _png.numpy = rgb, None
assert _png.decode(picture.png())[2] == raw and len(raw) == 96 * 64 * 3
depth = _png.decode(picture.layer('depth')._repr_png_())[2]
near = min((v, i) for i, v in enumerate(picture.layer('depth').bytes()))[1]
assert depth[3 * near] == 255 and max(v for v in depth) == 255 and len(_png.decode(picture.layer('normal')._repr_png_())[2]) == len(raw)
for y in range(64):
    for x in range(96):
        if picture.layer('depth')[y, x][0] == float('inf'): assert depth[3 * (96 * y + x)] == 0
""", program)


@case("python.dlpack_shares_the_floats", budget=10)
def dlpack(bench):
    for program in pythons():
        python(bench, f"""
import ctypes, gc, weakref
from burnish import _dlpack
picture = burnish.load('builtin:plate', {KEYWORDS}).render({FRAME}, layers=['depth'])
assert picture.pixels.__dlpack_device__() == (1, 0)
get = ctypes.pythonapi.PyCapsule_GetPointer; get.restype, get.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
name = ctypes.pythonapi.PyCapsule_SetName; name.argtypes = [ctypes.py_object, ctypes.c_char_p]
def read(capsule, kind, struct):
    return struct.from_address(get(capsule, kind))
for version, kind, struct in ((None, b'dltensor', _dlpack.Managed), ((0, 8), b'dltensor', _dlpack.Managed), ((1, 1), b'dltensor_versioned', _dlpack.Versioned)):
    capsule = picture.pixels.__dlpack__(max_version=version)
    managed = read(capsule, kind, struct)
    tensor = managed.tensor
    assert (tensor.ndim, tensor.shape[:3], tensor.strides[:3]) == (3, [64, 96, 3], [288, 3, 1]) and (tensor.code, tensor.bits, tensor.lanes) == (2, 32, 1)
    assert tensor.data == picture.pixels.address and tensor.byte_offset == 0
    if version == (1, 1): assert (managed.major, managed.flags) == (1, 1)
    assert len(_dlpack._held) == 1
    del capsule            # nobody reads it
    assert not _dlpack._held
capsule = picture.layer('depth').__dlpack__()
managed = read(capsule, b'dltensor', _dlpack.Managed)
name(capsule, b'used_dltensor')
address, alive = ctypes.addressof(managed), weakref.ref(picture)
del capsule, picture; gc.collect()
assert len(_dlpack._held) == 1 and alive()   # the reader keeps the picture
managed.deleter(address); gc.collect()
assert not _dlpack._held and not alive()
picture = burnish.load('builtin:plate', {KEYWORDS}).render({FRAME})
for wrong in (dict(stream=1), dict(copy=True), dict(dl_device=(2, 0))):
    try: picture.__dlpack__(**wrong)
    except BufferError: pass
    else: raise SystemExit(str(wrong))
try: import numpy
except ImportError: raise SystemExit(0)
shared = numpy.from_dlpack(picture)
assert shared.shape == (64, 96, 3) and shared.__array_interface__['data'][0] == picture.pixels.address and (shared == numpy.asarray(picture)).all()
del picture; gc.collect()
assert shared.sum() > 0 and len(_dlpack._held) == 1
del shared; gc.collect()
assert not _dlpack._held
""", program)


@case("python.meshes_take_arrays_of_any_kind", budget=10)
def arrays(bench):
    for program in pythons():
        python(bench, f"""
import array
square = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
faces = [(0, 1, 2), (0, 2, 3)]
flat, corners = [float(v) for p in square for v in p], [v for f in faces for v in f]
picture = lambda *given, **more: burnish.meshes(burnish.Mesh(*given, **more), {KEYWORDS}).render({FRAME}).hash
wanted = picture(square, faces)
for positions in (flat, array.array('d', flat), array.array('f', flat), memoryview(array.array('f', flat)), (p for p in square), memoryview(array.array('d', 2 * flat))[:12]):
    assert picture(positions, faces) == wanted, positions
for triangles in (corners, array.array('B', corners), array.array('l', corners), array.array('I', corners), memoryview(bytes(corners))):
    assert picture(square, triangles) == wanted, triangles
def refused(error, words, *given, **more):
    try: burnish.Mesh(*given, **more)
    except error as e: assert words in str(e), str(e)
    else: raise SystemExit(words + ' was taken')
refused(TypeError, 'positions/4:', [0, 0, 0, 1, 1j, 0, 1, 0, 0])
refused(TypeError, 'triangles/1:', square, [0, -1, 2])
refused(TypeError, 'triangles/2:', square, [0, 1, 2.5])
refused(TypeError, 'triangles/2:', square, array.array('l', [0, 1, -2]))
refused(TypeError, 'positions', ['0', '0', '0'])
refused(TypeError, 'positions', 'abc')
try: import numpy as np
except ImportError: raise SystemExit(0)
points = np.array(square, 'f8')
wide = np.zeros((4, 6)); wide[:, ::2] = points
for positions in (points, points.astype('f4'), points.astype('f2'), points.astype('>f4'), points.astype('i8'), np.asfortranarray(points), wide[:, ::2], points[::-1][::-1], points.ravel()):
    assert picture(positions, np.array(faces)) == wanted, positions
for kind in ('u1', 'i2', 'u4', 'i8', '>i4'): assert picture(points, np.array(faces, kind)) == wanted
refused(ValueError, 'positions: shape (3, 4)', points.T)
refused(ValueError, 'triangles: shape (3, 2)', points, np.array(faces).T)
refused(TypeError, 'positions/0:', points.astype(complex))
refused(TypeError, 'positions', np.array([['a', 'b', 'c']]))
refused(TypeError, 'triangles/0:', points, np.array(faces, 'f4'))
""", program)


def cells():
    notebook = json.loads((EXAMPLES / "brushed_metal.ipynb").read_text())
    check(all(cell.get("outputs", []) == [] for cell in notebook["cells"]), "the notebook holds outputs: clear them")
    return ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]


@case("python.notebook_cells_run_in_plain_python", budget=10)
def plain_notebook(bench):
    """Each cell runs, and its last value shows itself."""
    (bench.folder / "cells.json").write_text(json.dumps(cells()))
    python(bench, """
import ast, base64, json, re
from burnish import _png
space, kinds = {}, []
for text in json.load(open('cells.json')):
    tree = ast.parse(text)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, 'cell', 'exec'), space)
    value = eval(compile(ast.Expression(last.value), 'cell', 'eval'), space) if last else None
    if hasattr(value, '_repr_html_'):
        pngs = [base64.b64decode(data) for data in re.findall('base64,([^"]+)"', value._repr_html_())]
    else:
        pngs = [value._repr_png_()] if hasattr(value, '_repr_png_') else []
    kinds.append(len(pngs))
    for png in pngs:
        rgb = _png.decode(png)[2]
        assert len(set(rgb)) > 20, 'an empty picture'
assert kinds == [1, 3, 3, 0, 1, 1, 2], kinds
compare, exact = burnish.compare, space['exact']
assert 2 * compare(exact, space['line']).flip_mean < compare(exact, space['split']).flip_mean
""")


@case("python.notebook_runs_in_jupyter", budget=15)
def jupyter(bench):
    """Starts Jupyter, which takes most of the time."""
    program = shutil.which("jupyter-nbconvert", path="/usr/bin:/bin") or shutil.which("jupyter-nbconvert")
    if not program:
        raise Skipped("no jupyter-nbconvert")
    env = {**environment(bench), "HOME": str(bench.folder), "JUPYTER_ALLOW_INSECURE_WRITES": "1"}
    done = subprocess.run([program, "--to", "notebook", "--execute", "--output", "out.ipynb", "--output-dir", str(bench.folder), str(EXAMPLES / "brushed_metal.ipynb")],
                          env=env, cwd=bench.folder, capture_output=True, text=True, timeout=300)
    if "NoSuchKernel" in done.stderr:
        raise Skipped("no python3 kernel (python3-ipykernel)")
    check(done.returncode == 0, done.stderr[-3000:])
    outputs = [output for cell in json.loads((bench.folder / "out.ipynb").read_text())["cells"] for output in cell.get("outputs", [])]
    shown = [output["data"] for output in outputs if "data" in output]
    check(sum("text/html" in data for data in shown) == 4 and sum("image/png" in data for data in shown) == 3, [sorted(data) for data in shown])


@case("python.example_scripts_run", budget=10)
def examples(bench):
    done = run(bench, EXAMPLES / "turntable.py", "builtin:plate", "-o", "turned", "--steps", "3", "--size", "64x48")
    pictures = [(bench.folder / f"turned/{i:03}.png").read_bytes() for i in range(3)]
    moving = (bench.folder / "turned/turntable.png").read_bytes()
    check(len(set(pictures)) == 3 and moving.count(b"fcTL") == 3 and moving.count(b"fdAT") == 2 and b"acTL\0\0\0\3" in moving, done.stdout)
    numbers = [moving[at.end() + 3] for at in re.finditer(b"fcTL|fdAT", moving)]
    check(numbers == list(range(5)), f"numbers of the animation's parts: {numbers}")
    check(bench.run("compare", "turned/000.png", "turned/turntable.png").expect(0).code == 0, "the first picture of the animation")

    done = run(bench, EXAMPLES / "compare_techniques.py", "builtin:plate", "split_isotropic", "lobe_line", "--size", "64x48", "-o", "page.html")
    mean = float(re.search(r"mean FLIP +([\d.]+)", done.stdout)[1])
    check(0 < mean < 1 and (bench.folder / "page.html").read_text().count("<img") == 3, done.stdout)
    run(bench, EXAMPLES / "compare_techniques.py", "builtin:plate", "none", "lobe_line", code=2)

    script = shutil.copy(EXAMPLES / "golden_test.py", bench.folder)
    check("BLESS=1" in run(bench, script, code=1).stderr, "a test without a hash passed")
    run(bench, script, BLESS="1")
    run(bench, script)
    kept = bench.folder / "golden_test.json"
    kept.write_text(re.sub(r'": "(.)', lambda found: f'": "{"1" if found[1] == "0" else "0"}', kept.read_text()))
    (bench.folder / "golden_test.png").unlink()
    check("golden_test.png" in run(bench, script, code=1).stderr and (bench.folder / "golden_test.png").exists(), "a changed picture passed")


@case("python.arrays_may_outlive_the_package", budget=10)
def outlive(bench):
    """The interpreter frees modules at its end, in no promised order."""
    for program in pythons():
        python(bench, f"""
import sys, types
picture = burnish.load('builtin:plate', {KEYWORDS}).render({FRAME})
later = sys.modules['later'] = types.ModuleType('later')
later.capsule, later.picture = picture.__dlpack__(), picture
try:
    import numpy
    class Kept: pass
    Kept.array, Kept.itself = numpy.from_dlpack(picture), Kept
    later.array = numpy.from_dlpack(picture)
except (ImportError, AttributeError):
    pass
""", program)


@case("python.shares_and_offscreen_scenes_do_not_grow", tier="nightly")
def growth(bench):
    """One picture kept in each round would add 28 MiB."""
    for program in pythons():
        python(bench, f"""
import resource
from burnish import offscreen
scene = burnish.load('builtin:plate', {KEYWORDS})
mesh = offscreen.Mesh([offscreen.Primitive([(-1, -1, 0), (1, -1, 0), (0, 1, 0)])])
renderer = offscreen.OffscreenRenderer(96, 64)
def peak(): return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
for i in range(500):
    picture = scene.render({FRAME})
    picture.__dlpack__(), burnish.compare(picture, picture)._repr_html_()
    stage = offscreen.Scene(ambient_light=(0.5, 0.5, 0.5))
    stage.add(mesh), stage.add(offscreen.PerspectiveCamera(0.8), pose=[[1, 0, 0, i / 1000], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1]])
    renderer.render(stage)
    if i == 100: before = peak()
assert peak() - before < 8 * 1024, f'{{peak() - before}} KiB more after 400 rounds'
""", program)
