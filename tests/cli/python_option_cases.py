"""Keywords of the Python package: the calls that take them, their values, and the program's options beside them."""

import ast
import pathlib
import re

from harness import case, check
from python_cases import FRAME, KEYWORDS, SMALL, environment, hash_of, library, python
from python_more_cases import keywords_of

REFUSED = """
def refused(words, call, error=burnish.Error):
    try: call()
    except error as e: assert words in str(e), (words, str(e))
    else: raise SystemExit(words + ' was taken')
"""

# Options of `burnish render` whose keywords have another name, or are arguments.
RENAMED = {
    "env": "the argument environment", "size": "width and height", "no-background": "background=False", "no-cache": "cache=False",
    "exposure": "the argument of png() and save()", "tonemap": "the argument of png() and save()", "output": "picture.save()",
}
# Options of `burnish render` without a keyword, by reason.
LACKING = {
    "the program prints or writes: a script does so itself": "quiet verbose stats trace count-operations variance frames band-rows",
    "the program draws many pictures: a script loops": "animate steps turntable fps",
    "a script chooses by comparisons": "budget budget-p99 budget-ms plan plan-out verify",
    "parts of the program beyond the library draw it": "show risks",
    "the picture does not change": "tile-size isa",
    "the library draws by the tile renderer and the reference alone": "backend device sampler pipeline validate",
    "maps come with a scene's file": "material normal-map quaternion-map height-map normal-y direction-map rotation-map rotation-encoding strokes "
                                     "roughness-map roughness-encoding",
    "tables and levels from files": "as-table ltc-table mip-net mip-pyramid",
    "tests of the reference, and its files": "reference-strategy checkpoint checkpoint-seconds",
    "several processes share a job": "pieces shard take piece merge work",
    "the library has the default limits": "strict allow-outside-uris",
}


def program_options(bench):
    """Returns the names of the options of `burnish render`. Limits count as none."""
    text = bench.run("render", "--help").expect(0).out
    names = re.findall(r"^  (?:-\w,)?--([a-z][a-z0-9-]*)", text, re.M)
    return {name for name in names if name != "help" and not name.startswith("limit-")}


@case("python.keywords_are_the_program_s_options", budget=10)
def names(bench):
    """Each option of the program is a keyword, has another name, or is lacking for a reason."""
    keywords = set(python(bench, "print(*burnish.options())").stdout.split())
    lacking = {name for names in LACKING.values() for name in names.split()}
    program = program_options(bench)
    same = {name for name in program if name.replace("-", "_") in keywords}
    check(same | set(RENAMED) | lacking == program, f"without a row or a keyword, or unknown: {(same | set(RENAMED) | lacking) ^ program}")
    check(not same & lacking and not same & set(RENAMED), f"a keyword that is said to be lacking: {same & (lacking | set(RENAMED))}")
    own = keywords - {name.replace("-", "_") for name in program}
    check(own == {"width", "height", "background", "layers", "cache"}, f"keywords without an option: {own}")


@case("python.keywords_belong_to_a_call", budget=10)
def owners(bench):
    python(bench, REFUSED + f"""
scene = burnish.load('builtin:plate', {KEYWORDS})
mesh, wrong = (burnish.Mesh([0, 0, 0, 1, 0, 0, 0, 1, 0], **more) for more in ({{}}, dict(width=4)))
for words, call in (('metallic: belongs to Mesh() and set_material()', lambda: scene.render(metallic=1)),
                    ('env_rotation: belongs to load()', lambda: scene.render(env_rotation=90)), ('floor: belongs to load()', lambda: scene.render(floor='stage')),
                    ('width: belongs to render() and reference()', lambda: burnish.load('builtin:plate', width=-5)),
                    ('msaa: belongs to render()', lambda: burnish.load('builtin:plate', msaa=99)), ('msaa: belongs to render()', lambda: scene.reference(msaa=4)),
                    ('technique: belongs to render()', lambda: burnish.load('builtin:plate', technique='none')),
                    ('bounces: belongs to reference()', lambda: scene.render(bounces=None)), ('intensity: belongs to set_light()', lambda: scene.render(intensity=2)),
                    ('width: belongs to', lambda: scene.set_material(0, width=3)), ('width: belongs to', lambda: burnish.meshes(wrong)),
                    ('floor: belongs to load()', lambda: burnish.meshes(mesh, floor='stage')),
                    ('threads: belongs to load() and meshes()', lambda: scene.set_environment(threads=2)), ('widht: is no option', lambda: scene.render(widht=None))):
    refused(words, call)
""")


@case("python.values_are_checked_where_they_are_given", budget=10)
def values(bench):
    """In C too: burnish_options_set checks a value before any call reads it."""
    python(bench, REFUSED + f"""
import ctypes
from burnish import _native
options = ctypes.c_void_p()
_native.call('burnish_options_make', ctypes.byref(options))
def put(name, value): _native.call('burnish_options_set', options, name.encode(), value.encode())
for name, value in (('width', '-5'), ('width', '16385'), ('msaa', '99'), ('technique', 'none'), ('roughness', '1.5'), ('anisotropy', '-2'), ('env_size', '100'),
                    ('env_exposure', '1e9'), ('env_rotation', 'nan'), ('fov', '190'), ('zoom', '0'), ('eye', '1,2'), ('f0', '0,0,2'), ('time', '-1'), ('layers', 'none'),
                    ('aov', 'depth,depth'), ('key_lights', '9'), ('mip_filter', 'none'), ('mip_kappa', '5'), ('floor', 'lake'), ('shadows', 'yes'), ('shadow_samples', '0'), ('axis_k', '0'), ('brdf', 'none'),
                    ('metallic', '2'), ('base_color', '1,1,1'), ('intensity', '-1'), ('samples', '0'), ('camera', '-1'), ('target_error', '0')):
    refused(name + ': ', lambda: put(name, value))
for name, value in (('range', '0'), ('roughness', '1'), ('key_lights', 'off'), ('tilt', '80,-80'), ('camera', 'front')): put(name, value)
# Options of other calls are left out, names of materials are refused
put('metallic', '1')
session = ctypes.c_void_p()
refused('metallic: belongs to materials', lambda: _native.call('burnish_open', b'builtin:plate', None, options, ctypes.byref(session)))
_native.library().burnish_options_free(options)
""")


@case("python.whole_numbers_have_no_fractions", budget=10)
def whole(bench):
    """Each keyword whose values are whole numbers refuses a fraction, and names itself."""
    python(bench, REFUSED + """
import ctypes
from burnish import _native
whole = [name for i, name in enumerate(burnish.options()) if _native.library().burnish_option_values(i).startswith(b'int,')]
assert {'light_samples', 'seed', 'samples', 'width', 'height', 'shadow_samples', 'bounces', 'threads', 'animation', 'env_samples', 'texture_anisotropy'} <= set(whole), whole
options = ctypes.c_void_p()
_native.call('burnish_options_make', ctypes.byref(options))
for name in whole + ['msaa', 'env_size', 'key_lights']:
    for value in ('1.5', '1e0.5', '2.000001'): refused(name + ': ', lambda: _native.call('burnish_options_set', options, name.encode(), value.encode()))
_native.library().burnish_options_free(options)
scene = burnish.load('builtin:plate', env_size=32, env_samples=16)
for name in ('light_samples', 'seed', 'samples', 'width', 'shadow_samples'): refused(name + ': ', lambda: scene.render(**{name: 1.5}))
""")


@case("python.wrong_arguments_are_named", budget=10)
def named(bench):
    python(bench, REFUSED + f"""
mesh = burnish.Mesh([0, 0, 0, 1, 0, 0, 0, 1, 0])
refused('meshes: at least one is needed', lambda: burnish.meshes({KEYWORDS}))
refused('parts/0: int is no burnish.Mesh', lambda: burnish.meshes(5), TypeError)
refused('parts/1: list is no burnish.Mesh', lambda: burnish.meshes(mesh, [mesh]), TypeError)
plate = burnish.load('builtin:plate', {KEYWORDS})
for call in (plate.render, plate.reference):
    refused('eye: gives no view', lambda: call(eye=(1e30, 0, 0)))
    refused('eye: gives no view', lambda: call(eye=(1, 1, 1), target=(0, -1e30, 0)))
    refused('target: gives no view', lambda: call(target=(1e30, 0, 0)))
assert 'rounded up to steps of 16' in burnish.options()['shadow_samples']
pictures = [burnish.load('builtin:lights', {KEYWORDS}).render({FRAME}, shadows='ratio', shadow_samples=n).hash for n in (16, 17, 32)]
assert pictures[0] != pictures[1] == pictures[2], pictures
""")


@case("python.views_are_those_of_the_program", budget=20)
def views(bench):
    """Draws each view twice: by the program and by the package."""
    lamp = str(bench.data_file("models/Lights.glb"))
    wanted = [hash_of(bench, "builtin:plate", *SMALL, *words) for words in (["--target", "0.1,0,0"], ["--orbit", "0,10", "--target", "0,0.1,0"], ["--zoom", "2"],
                                                                            ["--eye", "1,1,2", "--zoom", "0.5"], ["--fov", "30"])]
    wanted.append(hash_of(bench, lamp, *SMALL, "--fov", "20", "--zoom", "1.5"))
    done = python(bench, REFUSED + f"""
plate = burnish.load('builtin:plate', {KEYWORDS})
for more in (dict(target=(0.1, 0, 0)), dict(orbit=(0, 10), target=(0, 0.1, 0)), dict(zoom=2), dict(eye=(1, 1, 2), zoom=0.5), dict(fov=30)):
    print(plate.render({FRAME}, **more).hash)
print(burnish.load({lamp!r}, {KEYWORDS}).render({FRAME}, fov=20, zoom=1.5).hash)
refused('orbit: cannot be combined with eye', lambda: plate.render(eye=(1, 1, 1), orbit=(0, 1)))
refused('eye: cannot be combined with camera', lambda: plate.render(eye=(1, 1, 1), camera=0))
refused('orbit: cannot be combined with camera', lambda: plate.render(orbit=(0, 1), camera=0))
refused('eye: cannot be combined with camera', lambda: plate.reference(eye=(1, 1, 1), orbit=(1, 1), camera=0))
refused('target: is the same point as eye', lambda: plate.render(eye=(1, 1, 1), target=(1, 1, 1)))
refused('camera: ', lambda: plate.render(camera='none'))
""")
    check(done.stdout.split() == wanted, f"{done.stdout} {wanted}")


@case("python.more_keywords_draw_as_the_program", budget=20)
def more(bench):
    """Draws each picture twice: by the program and by the package."""
    wanted = [hash_of(bench, "builtin:bumps", *SMALL, *words) for words in (["--mip-filter", "kappa", "--mip-kappa", "0.5"], ["--f0", "0.9,0.5,0.1"], ["--key-lights", "off"],
                                                                            ["--couple", "albedo", "--color-kernel", "kaiser"])]
    done = python(bench, REFUSED + f"""
for more in (dict(mip_filter='kappa', mip_kappa=0.5), dict(f0=(0.9, 0.5, 0.1)), dict(key_lights='off'), dict(couple='albedo', color_kernel='kaiser')):
    print(burnish.load('builtin:bumps', {KEYWORDS}, **more).render({FRAME}).hash)
scene = burnish.load('builtin:bumps', {KEYWORDS})
picture = scene.render({FRAME}, aov=['depth', 'normal'])
assert picture.layer('depth').bytes() == scene.render({FRAME}, layers=['depth']).layer('depth').bytes()
refused('one option', lambda: scene.render({FRAME}, aov=['depth'], layers=['normal']))
refused('layers: belongs to render()', lambda: scene.reference(layers=['depth']))
assert len({{picture.png(tonemap=name) for name in ('none', 'pbr-neutral', 'aces')}}) == 3 and picture.png() == picture.png(tonemap='pbr-neutral')
refused('tonemap', lambda: picture.png(tonemap='film'))
picture.save('a.png', 1.0, tonemap='aces')
assert open('a.png', 'rb').read() == picture.png(1.0, 'aces')
refused('brdf', lambda: burnish.load('builtin:bumps', {KEYWORDS}, mip_filter='kappa', mip_gain='on').render({FRAME}, brdf='beckmann'))
""")
    check(done.stdout.split() == wanted, f"{done.stdout} {wanted}")


@case("python.area_lights_are_the_program_s", budget=10)
def area_lights(bench):
    lamps = ["sphere:points=0,1,0.5:radius=0.1:radiance=90,90,60", "quad:points=-1,2,0/1,2,0/1,2,1/-1,2,1:radiance=1,2,3:two-sided"]
    wanted = [hash_of(bench, "builtin:plate", *SMALL, "--light", lamps[0]), hash_of(bench, "builtin:plate", *SMALL, "--light", lamps[0], "--light", lamps[1])]
    done = python(bench, REFUSED + f"""
lamps = {lamps!r}
for light in (lamps[0], lamps): print(burnish.load('builtin:plate', {KEYWORDS}, light=light).render({FRAME}).hash)
square = burnish.Mesh([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], [0, 1, 2, 0, 2, 3])
assert burnish.meshes(square, {KEYWORDS}, light=lamps).render({FRAME}).hash != burnish.meshes(square, {KEYWORDS}).render({FRAME}).hash
for light, words in (('cube:points=0,0,0:radiance=1,1,1', 'sphere'), ('sphere:points=0,0,0:radius=1', 'radiance=R,G,B'), (lamps[:1] + [''], 'begins with none'),
                     ('sphere:points=0,nan,0:radius=1:radiance=1,1,1', 'nan')):
    refused('light: ', lambda: burnish.load('builtin:plate', light=light))
    refused(words, lambda: burnish.load('builtin:plate', light=light))
""")
    check(done.stdout.split() == wanted, f"{done.stdout} {wanted}")


@case("python.docstrings_list_the_keywords", budget=10)
def docstrings(bench):
    python(bench, """
from burnish import _native
for function, name in ((burnish.load, 'load()'), (burnish.meshes, 'meshes()'), (burnish.Scene.render, 'render()'), (burnish.Scene.reference, 'reference()'),
                       (burnish.Scene.set_environment, 'set_environment()')):
    lines = function.__doc__.split('Keywords:')[1].strip('\\n').splitlines()
    indent = len(lines[0]) - len(lines[0].lstrip())
    listed = {line.split(':')[0].strip() for line in lines if line.strip() and line[indent] != ' '}    # others go on with a keyword
    wanted = {keyword for keyword, calls in _native.calls().items() if name in calls}
    assert listed == wanted, (name, listed ^ wanted)
text = burnish.Scene.render.__doc__
assert 'width: int, 1 to 16384; default 1280. Pixels.' in text and 'background: bool; default True.' in text and 'technique: one of auto, ' in text
assert 'tilt: 2 floats, -80 to 80; default (0, 0).' in text and 'default 1024' in burnish.Scene.reference.__doc__
""")
    python(bench, "assert 'Draws a Picture' in burnish.Scene.render.__doc__", env=environment(bench, BURNISH_LIBRARY="absent.so"))


@case("python.stubs_and_docstrings_agree", budget=10)
def agree(bench):
    """The stubs have each call's keywords, with the library's defaults."""
    given = {name: {k: ast.literal_eval(d) for k, (_, d) in keywords_of(name).items() if k not in ("environment", "progress")} for name in ("load", "meshes", "render", "reference", "set_environment")}
    python(bench, f"""
from burnish import _native
def value(text): return eval(_native.shown_default(text))
table = {{name: value(_native.library().burnish_option_default(i).decode()) for i, name in enumerate(burnish.options())}}
for call, stub in {given!r}.items():
    wanted = {{name: table[name] for name, calls in _native.calls().items() if call + '()' in calls}}
    if call == 'reference': del wanted['samples']    # an argument
    assert {{k: v or None if v == () else v for k, v in stub.items()}} == wanted, (call, stub, wanted)
""")


@case("python.meshes_without_a_picture_are_errors", budget=10)
def unseen(bench):
    python(bench, REFUSED + f"""
import warnings
square, faces = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], [0, 1, 2, 0, 2, 3]
def of(positions, *more, **factors): return lambda: burnish.meshes(burnish.Mesh(positions, *more, **factors), {KEYWORDS})
refused('/meshes/0/triangles: 4 vertices in order are no multiple of 3', of(square))
refused('/meshes/0/normals/0: the normal (0, 0, 0) has no direction', of(square, faces, [0] * 12))
refused('/meshes/0/positions/0: 1e+30 is too large', of([1e30 if v == -1 else v for v in square], faces))
for flat in ([0.0] * 9, [0, 0, 0, 1, 1, 1, 2, 2, 2], [1e-30 * v for v in square[:9]]): refused('/meshes/0/triangles: have no area', of(flat))
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter('always')
    of(square, faces, metallic=1)()
    of(square, faces, coordinates=[0, 1, 1, 1, 1, 0, 0, 0], metallic=1, anisotropy_strength=0.8)()
    assert not told, told
    of(square, faces, metallic=1, anisotropy_strength=0.8)()
    assert [w.category for w in told] == [burnish.InputWarning] and 'coordinates' in str(told[0].message), told
    plain = of(square, faces, metallic=1)()
    plain.set_material(0, roughness=0.5)
    assert len(told) == 1
    for _ in range(2): plain.set_material(0, anisotropy_strength=0.8)
    assert len(told) == 2 and told[1].filename == '<string>' and '/primitives/0' in str(told[1].message), told
""")


@case("python.primitives_take_another_material", budget=10)
def primitives(bench):
    python(bench, REFUSED + f"""
square = dict(positions=[-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], triangles=[0, 1, 2, 0, 2, 3])
lower = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1]
red, blue = dict(base_color=(1, 0, 0, 1)), dict(base_color=(0, 0, 1, 1))
def scene(first, second): return burnish.meshes(burnish.Mesh(**square, **first), burnish.Mesh(**square, transform=lower, **second), {KEYWORDS})
changed = scene(red, blue)
changed.set_primitive_material(0, 1)
assert changed.render({FRAME}).hash == scene(blue, blue).render({FRAME}).hash != scene(red, blue).render({FRAME}).hash
refused('primitive: 2: the scene has 2', lambda: changed.set_primitive_material(2, 0))
refused('material: -1', lambda: changed.set_primitive_material(0, -1))
refused('steel', lambda: changed.set_primitive_material(0, 'steel'), KeyError)
""")


@case("python.a_library_that_does_not_load_says_why", budget=10)
def loading(bench):
    real = pathlib.Path(library(bench)).read_bytes()
    (bench.folder / "text.so").write_text("no library\n")
    (bench.folder / "other.so").write_bytes(real[:18] + bytes([real[18] ^ 0x40]) + real[19:])
    (bench.folder / "short.so").write_bytes(real[:100])
    for name, words in (("text.so", "cannot be loaded; {}: is no shared library"), ("other.so", "cannot be loaded; {}: is for another machine"),
                        ("short.so", "cannot be loaded; {}"), ("absent.so", "is not found; BURNISH_LIBRARY may name it; {}")):
        path = str(bench.folder / name)
        last = python(bench, "burnish.version()", code=1, env=environment(bench, BURNISH_LIBRARY=path)).stderr.splitlines()[-1]
        check(last.startswith("ImportError: libburnish.so " + words.format(path)) and ("not found" in last) == (name == "absent.so"), last)
