"""The library from C and from Python: the same bits as the program, and errors in place of aborts."""

import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import zipfile

from harness import Skipped, case, check

ROOT = pathlib.Path(__file__).resolve().parents[2]
SMALL = ("--size", "96x64", "--env-size", "32", "--env-samples", "16", "--floor", "off")
KEYWORDS = "env_size=32, env_samples=16"
FRAME = "width=96, height=64"


def library(bench):
    path = pathlib.Path(bench.program).parent / "raster/session/libburnish.so"
    if bench.sanitized or not path.exists():
        raise Skipped(f"no {path}")
    return path


def pythons():
    """This Python, and the system's where that is another: one of them has numpy, or not."""
    return dict.fromkeys(filter(None, (sys.executable, shutil.which("python3", path="/usr/bin:/bin"))))


def environment(bench, **more):
    return bench.environment({"BURNISH_LIBRARY": str(library(bench)), "PYTHONPATH": str(ROOT / "apps/python"), "PYTHONDONTWRITEBYTECODE": "1", **more})


def python(bench, text, program=sys.executable, code=0, env=None):
    done = subprocess.run([program, "-c", "import burnish\n" + text], cwd=bench.folder, env=env or environment(bench), capture_output=True, text=True,
                          timeout=120)
    check(done.returncode == code, f"{text}\nended with {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done


def hash_of(bench, *words):
    done = bench.run("render", *words).expect(0)
    return re.search(r"pixel hash: +([0-9a-f]{16})", done.out + done.err)[1]


@case("python.draws_the_bits_of_the_program", budget=10)
def same_bits(bench):
    pot = hash_of(bench, "builtin:teapot", *SMALL, "--technique", "bent_normal", "--roughness", "0.3")
    ball = hash_of(bench, "builtin:sphere", *SMALL, "--eye", "1,0.5,1", "--target", "0,0,0", "--fov", "30", "--energy-compensation")
    for program in pythons():
        done = python(bench, f"""
print(burnish.load('builtin:teapot', {KEYWORDS}).render({FRAME}, technique='bent_normal', roughness=0.3).hash)
print(burnish.load('builtin:sphere', {KEYWORDS}).render({FRAME}, eye=(1, 0.5, 1), target=[0, 0, 0], fov=30, energy_compensation=True).hash)
""", program)
        check(done.stdout.split() == [pot, ball], f"{program}: {done.stdout} {pot} {ball}")


@case("python.files_are_those_of_the_program", budget=10)
def same_files(bench):
    """8-bit pictures have the program's bytes, each way of a pixel's mean."""
    done = python(bench, f"""
scene = burnish.load('builtin:lights', {KEYWORDS}, floor='off')
for name in ("display", "linear", "weighted"):
    scene.render({FRAME}, msaa=4, resolve=name).save(f"by_python_{{name}}.png")
scene.render({FRAME}, msaa=4).save("by_python.png")
""")
    check(done.returncode == 0, done.stderr)
    files = {name: (bench.folder / f"by_python_{name}.png").read_bytes() for name in ("display", "linear", "weighted")}
    check(len(set(files.values())) == 3, "ways of a pixel's mean look the same")
    check(files["display"] == (bench.folder / "by_python.png").read_bytes(), "the default is not display")
    for name, made in files.items():
        bench.run("render", "builtin:lights", *SMALL, "--msaa", "4", "--resolve", name, "-o", f"{name}.png").expect(0)
        check((bench.folder / f"{name}.png").read_bytes() == made, f"{name}: other bytes than the program's")


@case("python.shadows_and_mirrors_are_the_program_s", budget=20)
def shadows(bench):
    """Draws each picture twice, and shadows cast many rays."""
    words = ("builtin:lights", *SMALL[:-1])
    shaded = hash_of(bench, *words, "off", "--shadows", "ratio", "--shadow-samples", "32")
    mirrored = hash_of(bench, *words, "mirror")
    both = hash_of(bench, *words, "mirror", "--shadows", "on")
    check(len({shaded, mirrored, both, hash_of(bench, *words, "off")}) == 4, "pictures that should differ")
    done = python(bench, f"""
print(burnish.load('builtin:lights', {KEYWORDS}).render({FRAME}, shadows='ratio', shadow_samples=32).hash)
mirror = burnish.load('builtin:lights', {KEYWORDS}, floor='mirror')
print(mirror.render({FRAME}).hash, mirror.render({FRAME}, shadows='on').hash)
try: mirror.reference(16, {FRAME})
except burnish.Error as error: assert 'path' in str(error) or error.code == 77, error
else: raise SystemExit('a reference without the reflection')
""")
    check(done.stdout.split() == [shaded, mirrored, both], f"{done.stdout} {shaded} {mirrored} {both}")


@case("python.pixels_are_buffers", budget=10)
def buffers(bench):
    for program in pythons():
        python(bench, f"""
picture = burnish.load('builtin:teapot', {KEYWORDS}).render({FRAME}, layers=['depth', 'normal'])
flat = picture.pixels.bytes()
assert flat.readonly and len(flat) == 96 * 64 * 3 and flat.format == 'f'
assert tuple(flat[3 * (96 * 30 + 40):][:3]) == picture.pixels[30, 40]
assert len(picture.layer('normal')[30, 40]) == 3 and picture.png()[1:4] == b'PNG'
normal = picture.layer('normal')
del picture                      # the layer and the view keep it
assert len(normal[1, 1]) == 3 and flat[0] >= 0
try: normal[64, 0]
except IndexError: pass
else: raise SystemExit('an index beyond the rows')
try:
    import numpy
except ImportError:
    raise SystemExit(0)
picture = burnish.load('builtin:plate', {KEYWORDS}).render({FRAME})
values = numpy.asarray(picture)
assert values.shape == (64, 96, 3) and values.dtype == numpy.float32 and not values.flags.writeable and not values.flags.owndata
assert burnish.compare(picture, values).flip_mean == 0 and burnish.compare(picture, values[::-1]).flip_mean > 0
assert burnish.compare(picture, values.astype('f8')).differing_fraction == 0
""", program)


@case("python.makes_scenes_of_meshes", budget=10)
def meshes(bench):
    done = python(bench, f"""
square = dict(positions=[(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], triangles=[(0, 1, 2), (0, 2, 3)], coordinates=[0, 1, 1, 1, 1, 0, 0, 0])
metal = burnish.Mesh(**square, metallic=1, roughness=0.4, anisotropy_strength=0.8, base_color=(1, 0.8, 0.5, 1))
lower = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1]
scene = burnish.meshes(metal, burnish.Mesh(**square, transform=lower, emissive=(1, 1, 1)), {KEYWORDS})
print(scene.render({FRAME}).hash, burnish.meshes(metal, {KEYWORDS}).render({FRAME}).hash)
def refused(error, words, **change):
    try: burnish.meshes(burnish.Mesh(**{{**square, **change}}), {KEYWORDS})
    except error as e: assert words in str(e), str(e)
    else: raise SystemExit(f'{{change}} was taken')
refused(burnish.Error, '/meshes/0/triangles/5', triangles=[0, 1, 2, 0, 2, 4])
refused(burnish.Error, 'roughness', roughness=7)
refused(burnish.Error, 'roughnes', roughnes=0.5)
refused(ValueError, 'positions', positions=[1, 2])
refused(TypeError, 'positions', positions=['a', 'b', 'c'])
refused(ValueError, 'coordinates', coordinates=[0, 1])
refused(burnish.Error, '/meshes/0/positions/0', positions=[float('nan')] * 12)
refused(burnish.Error, '/meshes/0/transform/3', transform=[1, 0, 0, float('inf')] + 12 * [0])
""")
    check(len(set(done.stdout.split())) == 2, done.stdout)


@case("python.errors_are_exceptions", budget=10)
def errors(bench):
    python(bench, f"""
scene = burnish.load('builtin:plate', {KEYWORDS})
for code, words, call in ((4, 'absent.glb', lambda: burnish.load('absent.glb')), (2, 'widht', lambda: scene.render(widht=1)),
                          (2, 'technique', lambda: scene.render(technique='none')), (2, 'width', lambda: scene.render(width='wide')),
                          (2, 'width', lambda: scene.render(width=65536)), (2, 'msaa', lambda: scene.render(msaa=-1)),
                          (2, 'eye', lambda: scene.render(eye=(1, 2))), (2, 'layer', lambda: scene.render(layers=['none'])),
                          (2, 'samples', lambda: scene.render(samples=-5)), (2, 'threads', lambda: burnish.load('builtin:plate', threads=-1)),
                          (2, 'exposure', lambda: scene.render({FRAME}).png(130)), (2, 'tonemap', lambda: scene.render({FRAME}).png(tonemap=None)), (2, 'exposure', lambda: scene.render({FRAME}).save('x.png', float('nan'))),
                          (7, 'none/a.png', lambda: scene.render({FRAME}).save('none/a.png')), (4, 'absent.hdr', lambda: burnish.load('builtin:plate', 'absent.hdr'))):
    try: call()
    except burnish.Error as error: assert error.code == code and words in str(error), (error.code, str(error))
    else: raise SystemExit(words + ' was taken')
import copy, pickle
for thing in (scene, scene.render({FRAME})):
    for copied in (copy.copy, copy.deepcopy, pickle.dumps):
        try: copied(thing)
        except TypeError: pass
        else: raise SystemExit('a copy frees twice')
again = pickle.loads(pickle.dumps(burnish.Error(4, 'words')))
assert again.code == 4 and str(again) == 'words'
try: burnish.load('builtin:plate' + chr(0) + 'x')
except ValueError: pass
else: raise SystemExit('a zero byte was taken')
class Short: shape = (64, 96, 3); tolist = lambda self: [0.0] * 9
picture = scene.render({FRAME})
assert burnish.compare(picture.pixels, picture).flip_mean == 0
try: burnish.compare(Short(), picture)
except ValueError: pass
else: raise SystemExit('too few floats were taken')
try: scene.reference(samples=10**9, {FRAME}, progress=lambda work, done: scene.render({FRAME}))
except (RuntimeError, burnish.Error): pass
else: raise SystemExit('a scene drew while it drew')
""")
    env = environment(bench, BURNISH_LIBRARY="absent.so")
    done = python(bench, "burnish.version()", code=1, env=env)
    check("ImportError" in done.stderr and "BURNISH_LIBRARY" in done.stderr, done.stderr)


@case("python.renders_do_not_grow", tier="nightly")
def growth(bench):
    python(bench, f"""
import resource
scene = burnish.load('builtin:plate', {KEYWORDS})
def peak(): return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
for i in range(1000):
    scene.render({FRAME}).png()
    if i == 100: before = peak()
assert peak() - before < 8 * 1024, f'{{peak() - before}} KiB more after 900 pictures'
""")


@case("python.scenes_in_threads_draw_the_same_bits", budget=10)
def threads(bench):
    done = python(bench, f"""
import threading
scene, hashes = burnish.load('builtin:plate', {KEYWORDS}), []
def draw(own):
    for _ in range(5): hashes.append((own or scene).render({FRAME}).hash)
workers = [threading.Thread(target=draw, args=(own,)) for own in (None, None, burnish.load('builtin:plate', {KEYWORDS}))]
[w.start() for w in workers]; [w.join() for w in workers]
print(len(hashes), len(set(hashes)))
""")
    check(done.stdout.split() == ["15", "1"], done.stdout)


@case("python.ctrl_c_stops_a_reference", budget=10)
def stopped(bench):
    text = f"scene = burnish.load('builtin:plate', {KEYWORDS})\nprint('go', flush=True)\nscene.reference(samples=10**9, {FRAME})"
    child = subprocess.Popen([sys.executable, "-c", "import burnish\n" + text], cwd=bench.folder, env=environment(bench), stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True)
    check(child.stdout.readline() == "go\n", "the scene is not there")
    time.sleep(0.5)
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=60)
    check("KeyboardInterrupt" in err or "unavailable" in err or "Embree" in err, err)


@case("python.a_wheel_holds_the_package", budget=10)
def wheel(bench):
    made = [subprocess.run([sys.executable, "-B", str(ROOT / "apps/python/make_wheel.py"), "--library", str(library(bench)), "-o", str(bench.folder / name)],
                           check=True, capture_output=True, text=True).stdout.strip() for name in ("a", "b")]
    check(pathlib.Path(made[0]).read_bytes() == pathlib.Path(made[1]).read_bytes(), "two wheels of the same files differ")
    with zipfile.ZipFile(made[0]) as files:
        files.extractall(bench.folder / "site")
    env = environment(bench, PYTHONPATH=str(bench.folder / "site"))
    del env["BURNISH_LIBRARY"]
    done = python(bench, f"print(burnish.__file__, burnish.load('builtin:plate', {KEYWORDS}).render({FRAME}).hash)", env=env)
    check(str(bench.folder) in done.stdout and hash_of(bench, "builtin:plate", *SMALL) in done.stdout, done.stdout)


@case("python.the_c_interface_is_c", budget=10)
def from_c(bench):
    """A C program, compiled as C99 without a warning, draws the program's picture."""
    folder, compiler = library(bench).parent, shutil.which("cc") or shutil.which("gcc")
    if not compiler:
        raise Skipped("no C compiler")
    (bench.folder / "burnish").mkdir()
    shutil.copy(ROOT / "raster/session/burnish.h", bench.folder / "burnish")  # as it is installed
    subprocess.run([compiler, "-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", str(ROOT / "tests/package/plate.c"), "-I", str(bench.folder),
                    "-L", str(folder), "-lburnish", f"-Wl,-rpath,{folder}", "-o", str(bench.folder / "plate")], check=True, timeout=120)
    done = subprocess.run([str(bench.folder / "plate")], cwd=bench.folder, env=bench.environment({}), capture_output=True, text=True, timeout=120)
    check(done.returncode == 0, f"ended with {done.returncode}: {done.stderr}")
    lines = done.stdout.splitlines()
    check(lines[1] == hash_of(bench, "builtin:spheres", *SMALL, "--fov", "40") and lines[0] != lines[1], lines)
    for line, words in zip(lines[2:], ("widht", "/meshes/0/triangles/5", "absent.glb")):
        check(words in line, lines)
    check((bench.folder / "plate.png").exists(), "no picture")
