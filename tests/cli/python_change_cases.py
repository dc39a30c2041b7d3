"""The Python package: changes between pictures, environments from arrays, progress and stops."""

import signal
import struct
import subprocess
import sys
import time

from harness import case, check
from python_cases import FRAME, KEYWORDS, SMALL, environment, hash_of, python, pythons

SQUARE = """
square = dict(positions=[(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], triangles=[(0, 1, 2), (0, 2, 3)],
              coordinates=[0, 1, 1, 1, 1, 0, 0, 0], metallic=1)
rows = [[0.8, 0, 0.6, 0.1], [0, 1, 0, 0.2], [-0.6, 0, 0.8, -0.3], [0, 0, 0, 1]]
columns = [rows[row][column] for column in range(4) for row in range(4)]
"""


@case("python.changed_scenes_have_the_bits_of_new_ones", budget=10)
def changes(bench):
    python(bench, SQUARE + f"""
view = dict({FRAME}, eye=(1, 1, 4), target=(0, 0, 0))
def fresh(transform=None, **factors):
    return burnish.meshes(burnish.Mesh(**square, transform=transform, **factors), {KEYWORDS}).render(**view).hash
scene = burnish.meshes(burnish.Mesh(**square), {KEYWORDS})
seen = [scene.render(**view).hash]
scene.move(0, rows)
seen.append(scene.render(**view).hash)
assert seen[1] == fresh(rows) == fresh(columns), 'a moved node'
scene.set_material(0, roughness=0.25, anisotropy_strength=0.7)
seen.append(scene.render(**view).hash)
assert seen[2] == fresh(columns, roughness=0.25, anisotropy_strength=0.7), 'a changed material'
scene.set_environment('builtin:sky', {KEYWORDS})
seen.append(scene.render(**view).hash)
assert seen[3] == burnish.meshes(burnish.Mesh(**square, transform=rows, roughness=0.25, anisotropy_strength=0.7), environment='builtin:sky',
                                 {KEYWORDS}).render(**view).hash, 'another environment'
assert len(set(seen)) == 4, seen
def refused(error, words, call):
    try: call()
    except error as e: assert words in str(e), str(e)
    else: raise SystemExit(f'{{words}} was taken')
    assert scene.render(**view).hash == seen[3], 'a change that fails changes nothing'
refused(burnish.Error, 'node', lambda: scene.move(1, rows))
refused(KeyError, 'wheel', lambda: scene.move('wheel', rows))
refused(burnish.Error, '/nodes/0/local', lambda: scene.move(0, [float('nan')] * 16))
refused(ValueError, 'matrix', lambda: scene.move(0, [1, 2, 3]))
refused(ValueError, 'matrix', lambda: scene.move(0, [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]]))
refused(burnish.Error, 'roughness', lambda: scene.set_material(0, roughness=7))
refused(burnish.Error, 'roughnes', lambda: scene.set_material(0, roughnes=0.5))
refused(KeyError, 'steel', lambda: scene.set_material('steel', roughness=0.5))
refused(burnish.Error, 'light', lambda: scene.set_light(0, intensity=2))
refused(burnish.Error, 'absent.hdr', lambda: scene.set_environment('absent.hdr'))
""")


@case("python.lights_and_names_of_files_change", budget=10)
def named(bench):
    python(bench, f"""
scene = burnish.load({str(bench.data_file("models/Lights.glb"))!r}, {KEYWORDS})
first = scene.render({FRAME}).hash
scene.set_light(0, intensity=0)
dark = scene.render({FRAME}).hash
assert dark != first
assert scene.lights and scene.nodes and scene.materials and None not in scene.nodes
named = next(name for name in scene.nodes if name)
scene.move(named, [[1, 0, 0, 0.01], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
floor = burnish.load('builtin:plate', floor='shadow', {KEYWORDS})
try: floor.move(0, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
except burnish.Error as error: assert error.code == 2 and 'floor' in str(error), str(error)
else: raise SystemExit('a scene with a floor moved')
""")


@case("python.environments_are_arrays", budget=10)
def arrays(bench):
    width, height = 64, 32
    rows = [[(0.2 + 0.01 * x, 0.3, 0.02 * y) for x in range(width)] for y in range(height)]
    (bench.folder / "sky.pfm").write_bytes(b"PF\n%d %d\n-1.0\n" % (width, height) +
                                           b"".join(struct.pack("<3f", *p) for row in reversed(rows) for p in row))
    expected = hash_of(bench, "builtin:plate", "--env", "sky.pfm", *SMALL)
    for program in pythons():
        python(bench, f"""
sky = [[(0.2 + 0.01 * x, 0.3, 0.02 * y) for x in range({width})] for y in range({height})]
class Array: # without numpy
    shape = ({height}, {width}, 3)
    def tolist(self): return sky
sources = [Array()]
try:
    import numpy
    sources += [numpy.array(sky), numpy.array(sky, 'f4'), numpy.asfortranarray(sky)]
except ImportError: pass
for source in sources:
    assert burnish.load('builtin:plate', source, {KEYWORDS}).render({FRAME}).hash == '{expected}'
    scene = burnish.load('builtin:plate', 'builtin:sky', {KEYWORDS})
    scene.set_environment(source, {KEYWORDS})
    assert scene.render({FRAME}).hash == '{expected}'
import warnings
sky[3][5] = (float('nan'), 0, 0) # repaired, as environments of files are, and told once
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter('always')
    scene = burnish.load('builtin:plate', Array(), {KEYWORDS})
    assert [w.category for w in told] == [burnish.InputWarning] and 'NaN' in str(told[0].message), told
    scene.set_environment(Array(), {KEYWORDS})
    assert len(told) == 1, told
for wrong in ([[1, 2, 3]], 7, (0.1, 0.2, 0.3)):
    try: burnish.load('builtin:plate', wrong, {KEYWORDS})
    except ValueError: pass
    else: raise SystemExit(f'{{wrong}} was taken')
""", program)


@case("python.work_is_told_and_stops", budget=20)
def told(bench):
    """Bakes and references work on all cores until they stop."""
    python(bench, f"""
calls = []
def hears(work, done):
    assert isinstance(work, str) and (done == -1 or 0 <= done <= 1), (work, done)
    calls.append(work)
scene = burnish.load('builtin:teapot', progress=hears, env_size=256, env_samples=2048, cache=False)
assert any('baking' in work for work in calls), calls
def stops(call):
    try: call(lambda work, done: True)
    except KeyboardInterrupt: pass
    else: raise SystemExit('the work went on')
stops(lambda p: burnish.load('builtin:teapot', progress=p, env_size=256, env_samples=4096, cache=False))
stops(lambda p: scene.set_environment('builtin:sky', progress=p, env_size=256, env_samples=4096, cache=False))
before = scene.render({FRAME}).hash
stops(lambda p: scene.render(progress=p, width=640, height=480, technique='mc', samples=4096))
stops(lambda p: scene.reference(progress=p, samples=10**9, {FRAME}))
assert scene.render({FRAME}).hash == before
def fails(work, done): raise LookupError('mine')
try: scene.render(progress=fails, width=640, height=480, technique='mc', samples=4096)
except LookupError as error: assert str(error) == 'mine'
else: raise SystemExit('an exception is lost')
assert scene.render({FRAME}, progress=hears).hash == before
""")


@case("python.saving_stops_and_leaves_the_old_file", budget=10)
def saved(bench):
    python(bench, f"""
import os
scene = burnish.load('builtin:teapot', {KEYWORDS})
large = scene.render(width=4096, height=4096, msaa=1, technique='split_isotropic')
before = sorted(os.listdir())
told = []
def stops(work, done):
    told.append(work)
    return True
for name in ('new.png', 'old.png'):
    if name.startswith('old'): open(name, 'w').write('old')
    try: large.save(name, progress=stops)
    except KeyboardInterrupt: pass
    else: raise SystemExit(f'{{name}} was written')
assert told == ['writing new.png', 'writing old.png'], told
assert sorted(os.listdir()) == sorted(before + ['old.png']) and open('old.png').read() == 'old', os.listdir()
try: large.png(progress=stops)
except KeyboardInterrupt: pass
else: raise SystemExit('the bytes were made')
def fails(work, done): raise LookupError('mine')
try: large.save('new.png', progress=fails)
except LookupError as error: assert str(error) == 'mine' and not os.path.exists('new.png')
else: raise SystemExit('an exception is lost')
try: large.save('new.png', progress=lambda work, done: large.png())
except RuntimeError as error: assert 'picture' in str(error)
else: raise SystemExit('a picture waits for itself')
small = scene.render({FRAME})
small.save('new.png', 1.0, progress=lambda work, done: False)
assert open('new.png', 'rb').read() == small.png(1.0)
""")


@case("python.ctrl_c_frees_nothing_twice", tier="quick")
def freed_once(bench):
    """Ctrl-C right behind the call that frees options."""
    python(bench, f"""
import gc
from burnish import _native
library, freed = _native.library(), []
real = library.burnish_options_free
def interrupted(handle):
    freed.append(handle.value)
    if freed.count(handle.value) == 1:
        real(handle)
        raise KeyboardInterrupt
library.burnish_options_free = interrupted
try:
    with _native.Options({{}}, 'render()'):
        pass
except KeyboardInterrupt:
    gc.collect()
assert len(freed) == 1, freed
""")


@case("python.ctrl_c_stops_every_call", tier="nightly")
def interrupt(bench):
    """In check, `python.ctrl_c_stops_a_reference` sends the signal, and `python.work_is_told_and_stops` stops calls."""
    floats, picture = "memoryview(bytearray(12 * 8192 * 4096)).cast('f', [4096, 8192, 3])", "scene.render(width=8192, height=4096, msaa=1, technique='split_isotropic')"
    for large, work in (("None", "scene.render(width=1280, height=720, technique='mc', samples=8192)"),
                        ("None", "burnish.load('builtin:spheres', env_size=2048, env_samples=65536, cache=False)"),
                        (floats, "burnish.compare(large, large)"), (picture, "large.save('large.png')"), (picture, "large.png()"),
                        (f"scene.render({FRAME})", "[large.save('small.png') for _ in iter(int, 1)]"), (f"scene.render({FRAME})", "[large.png() for _ in iter(int, 1)]")):
        child = subprocess.Popen([sys.executable, "-c", f"""
import burnish
scene = burnish.load('builtin:teapot', {KEYWORDS})
large = {large}
print('ready', flush=True)
try: {work}
except KeyboardInterrupt: print('stopped', scene.render({FRAME}).hash)
"""], env=environment(bench), cwd=bench.folder, stdout=subprocess.PIPE, text=True)
        child.stdout.readline()
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        out, _ = child.communicate(timeout=60)
        check(child.returncode == 0 and "stopped" in out, f"{work}: {child.returncode} {out}")
    check(not (bench.folder / "large.png").exists(), "a stopped save left a file")
