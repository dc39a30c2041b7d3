"""burnish.offscreen: pyrender's call names, its conventions for poses and depths, and refusals."""

from harness import case
from python_cases import ROOT, python, pythons

# A square of 2 m, and helpers. turn(AXIS, DEGREES, place) is a pose in rows.
HEAD = """
import math
from burnish import offscreen as pr
SQUARE = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
FACES = [(0, 1, 2), (0, 2, 3)]
W, H = 64, 48
def turn(axis, degrees, place=(0, 0, 0)):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    rows = {'x': [[1, 0, 0], [0, c, -s], [0, s, c]], 'y': [[c, 0, s], [0, 1, 0], [-s, 0, c]], 'z': [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]
    return [row + [p] for row, p in zip(rows, place)] + [[0, 0, 0, 1]]
def square(size=1.0, **material):
    return pr.Mesh([pr.Primitive([(size * x, size * y, z) for x, y, z in SQUARE], indices=FACES, material=pr.MetallicRoughnessMaterial(**material))])
def scene_of(camera, pose, *meshes, **more):
    scene = pr.Scene(**{'ambient_light': (0.5, 0.5, 0.5), **more})
    for mesh, place in meshes: scene.add(mesh, pose=place)
    scene.add(camera, pose=pose)
    return scene
def box(depth):
    seen = [(y, x) for y in range(H) for x in range(W) if depth[y, x] > 0]
    return min(x for y, x in seen), max(x for y, x in seen), min(y for y, x in seen), max(y for y, x in seen)
def rgb(colour, y, x): return tuple(int(colour[y, x, c]) for c in range(3))
def refused(words, call):
    try: call()
    except burnish.Error as error: assert words in str(error) and error.code == 2, (words, str(error))
    else: raise SystemExit(words + ' was taken')
CAMERA = pr.PerspectiveCamera(yfov=2 * math.atan(0.5))    # 24 pixels are half the distance
FRONT = turn('x', 0, (0, 0, 4))
renderer = pr.OffscreenRenderer(W, H)
"""


@case("python.offscreen_depth_is_the_distance_along_the_view", budget=10)
def depth(bench):
    for program in pythons():
        python(bench, HEAD + """
colour, depth = renderer.render(scene_of(CAMERA, FRONT, (square(9), None)))
assert tuple(colour.shape) == (H, W, 3) and tuple(depth.shape) == (H, W) and depth[0, 0] == depth[20, 40] == 4.0      # no longer at the edges
assert memoryview(depth).format == 'f' and memoryview(colour).format == 'B'
_, depth = renderer.render(scene_of(CAMERA, turn('x', 0, (0, 0, 7.25)), (square(), turn('x', 0, (0, 0, 0.5)))))
assert depth[24, 32] == 6.75 and depth[0, 0] == 0
# A plane turned by 40 degrees about y: the ray (x, y, -1) t + (0, 0, 4) meets n = (sin, 0, cos)
_, depth = renderer.render(scene_of(CAMERA, FRONT, (square(2), turn('y', 40))))
s, c, seen = math.sin(math.radians(40)), math.cos(math.radians(40)), 0
for y in range(4, H - 4):
    for x in range(W):
        across = (x + 0.5 - W / 2) / H
        wanted = 4 * c / (c - across * s)
        if abs(across * wanted) < 0.9 * 2 * c and abs((y + 0.5 - H / 2) / H * wanted) < 1.9:
            assert abs(depth[y, x] - wanted) < 5e-5 * wanted, (y, x, depth[y, x], wanted)
            seen += 1
assert seen > 500
_, depth = renderer.render(scene_of(pr.OrthographicCamera(xmag=4 / 3 * 2, ymag=2), FRONT, (square(), None)))
assert depth[24, 32] == 4.0 and box(depth) == (20, 43, 12, 35), (depth[24, 32], box(depth))
assert renderer.render(scene_of(CAMERA, FRONT, (square(), None)), pr.RenderFlags.DEPTH_ONLY)[24, 32] == 4.0
""", program)


@case("python.offscreen_corners_land_on_their_pixels", budget=10)
def corners(bench):
    python(bench, HEAD + """
assert box(renderer.render(scene_of(CAMERA, FRONT, (square(), None)))[1]) == (20, 43, 12, 35)
assert box(renderer.render(scene_of(CAMERA, turn('x', 0, (1, 0.5, 4)), (square(), None)))[1]) == (8, 31, 18, 41)     # the square goes left and down
assert box(renderer.render(scene_of(CAMERA, FRONT, (square(), turn('x', 0, (1, 0.5, 0)))))[1]) == (32, 55, 6, 29)    # right and up
intrinsics = pr.IntrinsicsCamera(fx=48, fy=48, cx=32, cy=24)
assert box(renderer.render(scene_of(intrinsics, FRONT, (square(), None)))[1]) == (20, 43, 12, 35)
tall = pr.OffscreenRenderer(W, H)
tall.viewport_width = 48
assert tuple(tall.render(scene_of(CAMERA, FRONT, (square(), None)))[1].shape) == (48, 48)
""")


@case("python.offscreen_poses_are_right_handed", budget=10)
def poses(bench):
    python(bench, HEAD + """
def middle(camera_pose, place, mesh_turn=None):
    rows = mesh_turn or turn('x', 0)
    rows = [row[:3] + [p] for row, p in zip(rows, place)] + [[0, 0, 0, 1]]
    _, depth = renderer.render(scene_of(CAMERA, camera_pose, (square(0.2, doubleSided=True), rows)))
    x0, x1, y0, y1 = box(depth)
    return ((x0 + x1 + 1) / 2 - W / 2, H / 2 - (y0 + y1 + 1) / 2)      # right and up of the middle, pixels
def near(got, wanted): assert abs(got[0] - wanted[0]) <= 1 and abs(got[1] - wanted[1]) <= 1, (got, wanted)
near(middle(FRONT, (0.5, 0, 0)), (6, 0))
near(middle(FRONT, (0, 0.5, 0)), (0, 6))
# About y by 90 degrees: the camera looks along -x, and its right is -z
near(middle(turn('y', 90, (4, 0, 0)), (0, 0, -0.5), turn('y', 90)), (6, 0))
# About x by -90 degrees: it looks down, and its up is -z
near(middle(turn('x', -90, (0, 4, 0)), (0, 0, -0.5), turn('x', -90)), (0, 6))
# About z by 90 degrees, a roll: its right is +y, its up is -x
near(middle(turn('z', 90, (0, 0, 4)), (0, 0.5, 0)), (6, 0))
near(middle(turn('z', 90, (0, 0, 4)), (-0.5, 0, 0)), (0, 6))
# A mesh's own turn: +x goes to +y about z
lean = pr.Mesh([pr.Primitive([(x + 2, 0.2 * y, z) for x, y, z in SQUARE], indices=FACES)])
_, depth = renderer.render(scene_of(CAMERA, turn('x', 0, (0, 0, 8)), (lean, turn('z', 90))))
assert box(depth)[2:] == (6, 17), box(depth)
# Poses may change later
scene = scene_of(CAMERA, FRONT, (square(), None))
scene.set_pose(scene.main_camera_node, turn('x', 0, (0, 0, 5)))
assert renderer.render(scene)[1][24, 32] == 5.0
back = turn('y', 180, (0, 0, -4))
assert max(max(row) for row in renderer.render(scene_of(CAMERA, back, (square(), None)))[1].tolist()) == 0         # faces seen from behind
assert renderer.render(scene_of(CAMERA, back, (square(), None)), pr.RenderFlags.SKIP_CULL_FACES)[1][24, 32] == 4.0
""")


@case("python.offscreen_colours_follow_lights_and_flags", budget=10)
def colours(bench):
    words = set()
    for program in pythons():
        done = python(bench, HEAD + """
import hashlib
from burnish.offscreen import display
grey = square(metallicFactor=0.0, roughnessFactor=1.0, baseColorFactor=(0.5, 0.25, 0.1, 1.0))
scene = scene_of(CAMERA, FRONT, (grey, None), ambient_light=(1.0, 1.0, 1.0))
ambient, _ = renderer.render(scene)
flat, _ = renderer.render(scene, pr.RenderFlags.FLAT)
def lit(light, pose):
    scene = scene_of(CAMERA, FRONT, (grey, None), ambient_light=(0.0, 0.0, 0.0), bg_color=(0.0, 0.0, 0.0))
    scene.add(light, pose=pose)
    return renderer.render(scene)[0]
sun, lamp = lit(pr.DirectionalLight(intensity=math.pi), None), lit(pr.PointLight(intensity=9 * math.pi), turn('x', 0, (0, 0, 3)))
spot = lit(pr.SpotLight(intensity=9 * math.pi, outerConeAngle=0.2), turn('x', 0, (0, 0, 3)))
# Radiance of a white floor is E / pi under a sun, I / (pi r^2) under a lamp, and the sky's own under a sky
for other in (ambient, sun, lamp, spot): assert max(abs(a - b) for a, b in zip(rgb(other, 24, 32), rgb(flat, 24, 32))) <= 8, (rgb(other, 24, 32), rgb(flat, 24, 32))
assert rgb(spot, 24, 32) != (0, 0, 0) == rgb(spot, 13, 21) and rgb(lit(pr.DirectionalLight(intensity=3.0), turn('y', 180)), 24, 32) == (0, 0, 0)
assert rgb(ambient, 0, 0) == (255, 255, 255) and rgb(sun, 0, 0) == (0, 0, 0)
blue, _ = renderer.render(scene_of(CAMERA, FRONT, (grey, None), bg_color=[0, 0, 255]))
assert rgb(blue, 0, 0) == (0, 0, 255)
clear, _ = renderer.render(scene_of(CAMERA, FRONT, (grey, None), bg_color=(1.0, 1.0, 1.0, 0.0)), pr.RenderFlags.RGBA)
assert tuple(clear.shape) == (H, W, 4) and clear[24, 32, 3] == 255 and clear[0, 0, 3] == 0
# Half a pixel of light 1 over white and over black
assert display.over(bytes([188] * 3), [0.5], [1.0, 1.0, 1.0, 1.0]) == (bytes([255] * 3), bytes([255]))
assert display.over(bytes([188] * 3), [0.5], [0.0, 0.0, 0.0, 0.0]) == (bytes([188] * 3), bytes([128]))
seg, depth = renderer.render(scene, pr.RenderFlags.SEG, {scene.mesh_nodes[0]: (10, 20, 30)})
assert rgb(seg, 24, 32) == (10, 20, 30) and rgb(seg, 0, 0) == (0, 0, 0) and depth[24, 32] == 4.0
several = scene_of(CAMERA, FRONT, (square(0.3), turn('x', 0, (-0.9, 0, 0))), (square(), turn('x', 0, (0, 0, 1))), (square(0.3), turn('x', 0, (0.9, 0, 0))))
left, near, right = several.mesh_nodes
near.mesh.is_visible = False
seg, _ = renderer.render(several, pr.RenderFlags.SEG, {left: (1, 0, 0), near: (2, 0, 0), right: (3, 0, 0)})
assert (seg[24, 21, 0], seg[24, 32, 0], seg[24, 42, 0]) == (1, 0, 3)
empty, depth = renderer.render(scene_of(CAMERA, FRONT))
assert rgb(empty, 24, 32) == (255, 255, 255) and depth[24, 32] == 0
sky = pr.Scene(environment='builtin:sky')
sky.add(grey), sky.add(CAMERA, pose=FRONT)
under, _ = pr.OffscreenRenderer(W, H, env_size=32, env_samples=16).render(sky)
assert len({rgb(under, 2, x) for x in range(W)}) > 3, 'no sky behind the square'
class Thing: pass
thing, visual = Thing(), Thing()
thing.vertices, thing.faces, thing.visual, visual.kind = SQUARE, FACES, visual, 'vertex'
visual.vertex_colors = [(255, 0, 0, 255)] * 4
red, depth = renderer.render(scene_of(CAMERA, FRONT, (pr.Mesh.from_trimesh(thing), None)), pr.RenderFlags.FLAT)
assert rgb(red, 24, 32)[0] > 200 and rgb(red, 24, 32)[1] < 40 and depth[24, 32] == 4.0, rgb(red, 24, 32)
# v grows upwards: an eighth of a turn from the first axis, the sun's highlight runs to the upper right
metal = pr.MetallicRoughnessMaterial(roughnessFactor=0.3, anisotropyStrength=0.9, anisotropyRotation=math.pi / 4)
metal = pr.Mesh([pr.Primitive(SQUARE, indices=FACES, texcoord_0=[(0, 0), (1, 0), (1, 1), (0, 1)], material=metal)])
shine = scene_of(CAMERA, FRONT, (metal, None), ambient_light=(0.0, 0.0, 0.0))
shine.add(pr.DirectionalLight(intensity=0.3))
brushed, _ = renderer.render(shine)
assert brushed[14, 41, 0] > 1.5 * brushed[14, 22, 0] and brushed[33, 22, 0] > 1.5 * brushed[33, 41, 0], [brushed[y, x, 0] for y in (14, 33) for x in (22, 41)]
print(hashlib.sha256(b''.join(bytes(memoryview(picture).cast('B')) for picture in (ambient, sun, lamp, spot, blue, clear, seg, under, red, brushed))).hexdigest())
""", program)
        words.add(done.stdout)
    assert len(words) == 1, "with and without numpy the pictures differ"


@case("python.offscreen_refuses_what_burnish_lacks", budget=10)
def refusals(bench):
    python(bench, HEAD + """
mesh = square()
scene = pr.Scene()
scene.add(mesh)
refused('camera', lambda: renderer.render(scene))
node = scene.add(CAMERA)
scene.remove_node(node)
refused('camera', lambda: renderer.render(scene))
refused('node', lambda: scene.remove_node(node))
whole = scene_of(CAMERA, FRONT, (mesh, None))
refused('flags', lambda: renderer.render(whole, 8))
refused('flags', lambda: renderer.render(whole, 512))
refused('zfar', lambda: renderer.render(scene_of(pr.PerspectiveCamera(0.8, zfar=3.0), FRONT, (mesh, None))))
renderer.render(scene_of(pr.PerspectiveCamera(0.8, zfar=5.0, aspectRatio=W / H), FRONT, (mesh, None)))
refused('aspectRatio', lambda: renderer.render(scene_of(pr.PerspectiveCamera(0.8, aspectRatio=1.0), FRONT, (mesh, None))))
refused('xmag', lambda: renderer.render(scene_of(pr.OrthographicCamera(1, 1), FRONT, (mesh, None))))
refused('cx', lambda: renderer.render(scene_of(pr.IntrinsicsCamera(48, 48, 30, 24), FRONT, (mesh, None))))
class Picture:
    shape = (1, 1, 3)
    def __init__(self, values=(1, 2, 3)): self.values = values
    def tolist(self): return [[self.values]]
mirror = turn('x', 0); mirror[0][0] = -1
double = turn('x', 0); double[1][1] = 2
for words, call in (
        ('pose: it mirrors', lambda: pr.Scene().add(CAMERA, pose=mirror)), ('pose: its axes', lambda: pr.Scene().add(CAMERA, pose=double)),
        ('pose: the last row', lambda: pr.Scene().add(mesh, pose=[[1, 0, 0, 0]] * 4)), ('pose: 9 numbers', lambda: pr.Scene().add(mesh, pose=[[1, 0, 0]] * 3)),
        ('pose/3', lambda: pr.Scene().add(mesh, pose=turn('x', 0, (math.nan, 0, 0)))), ('parent_node', lambda: pr.Scene().add(mesh, parent_node=node)),
        ('obj', lambda: pr.Scene().add('mesh')), ('baseColorTexture', lambda: pr.MetallicRoughnessMaterial(baseColorTexture=object())),
        ('wireframe', lambda: pr.MetallicRoughnessMaterial(wireframe=True)), ('roughnessFactor', lambda: pr.MetallicRoughnessMaterial(roughnessFactor=2)),
        ('alphaMode', lambda: pr.MetallicRoughnessMaterial(alphaMode='GLASS')), ('baseColorFactor/1', lambda: pr.MetallicRoughnessMaterial(baseColorFactor=(0.5, 1.5, 0.5))),
        ('yfov', lambda: pr.PerspectiveCamera(yfov=4)), ('mode', lambda: pr.Primitive(SQUARE, mode=1)), ('targets', lambda: pr.Primitive(SQUARE, targets=[1])),
        ('indices/5', lambda: pr.Primitive(SQUARE, indices=[0, 1, 2, 0, 2, 4])), ('normals', lambda: pr.Primitive(SQUARE, normals=[0, 0, 1])),
        ('color_0/1', lambda: pr.Primitive(SQUARE, color_0=[(1.0, 0, 0), (2.0, 0, 0), (0, 0, 1.0), (0, 0, 1.0)])),
        ('intensity', lambda: pr.PointLight(intensity=-1)), ('point_size', lambda: pr.OffscreenRenderer(W, H, point_size=2.0)),
        ('eye', lambda: pr.OffscreenRenderer(W, H, eye=(1, 1, 1))), ('ambient_light', lambda: pr.Scene(environment='builtin:sky', ambient_light=(0.1, 0.1, 0.1))),
        ('seg_node_map', lambda: renderer.render(whole, pr.RenderFlags.SEG, {whole.mesh_nodes[0]: (1, 2, 300)})), ('viewport_width', lambda: pr.OffscreenRenderer(0, H).render(whole)),
        ('skin', lambda: pr.Node(skin=1)), ('matrix: cannot', lambda: pr.Node(matrix=FRONT, scale=2)), ('rotation: a quaternion', lambda: pr.Node(rotation=(0, 0, 0, 0))),
        ('translation: 2 numbers', lambda: pr.Node(translation=(0, 0))), ('pose: its axes', lambda: pr.Node(camera=CAMERA, scale=2)), ('parent_name: 0 nodes', lambda: whole.add(mesh, parent_name='none')),
        ('children', lambda: whole.add_node(whole.nodes[0])), ('source: a Node', lambda: pr.Texture(source=pr.Node())), ('sampler', lambda: pr.Texture(sampler=1)),
        ('normalTexture', lambda: pr.MetallicRoughnessMaterial(normalTexture=object())), ('texcoord_0', lambda: pr.Primitive(SQUARE, material=pr.MetallicRoughnessMaterial(baseColorTexture=Picture()))),
        ('source/2', lambda: pr.Texture(source=Picture((0.5, 0.5, 1.5)))),
        ('techniqe', lambda: pr.OffscreenRenderer(W, H, techniqe='mc').render(whole))):
    refused(words, call)
class Textured: kind, uv, material = 'texture', [(0, 0)] * 4, type('M', (), {'image': object()})()
refused('image', lambda: pr.Mesh.from_trimesh(type('T', (), {'vertices': SQUARE, 'faces': FACES, 'visual': Textured})()))
refused('positions/3', lambda: pr.Primitive([(0, 0, 0), (math.nan, 0, 0), (0, 0, 0)]))
renderer.render(whole)
renderer.delete()
assert not renderer._cached
""")


@case("python.offscreen_has_pyrender_s_names", budget=10)
def names(bench):
    """Calls that burnish does not serve raise burnish.Error, which names another way."""
    python(bench, HEAD + """
for name in ('Camera', 'PerspectiveCamera', 'OrthographicCamera', 'IntrinsicsCamera', 'Light', 'PointLight', 'DirectionalLight', 'SpotLight', 'Sampler', 'Texture', 'Material',
             'MetallicRoughnessMaterial', 'Primitive', 'Mesh', 'Node', 'Scene', 'Renderer', 'Viewer', 'OffscreenRenderer', 'RenderFlags', 'TextAlign', 'GLTF'):
    assert hasattr(pr, name) and name in pr.__all__, name
grey = square(metallicFactor=0.0)
whole = scene_of(CAMERA, FRONT, (grey, None))
lamp = pr.PointLight(intensity=9 * math.pi)
for words, call in (
        ('Viewer: burnish opens no window: draw pictures with OffscreenRenderer', lambda: pr.Viewer(whole, use_raymond_lighting=True)), ('Renderer', lambda: pr.Renderer(W, H)),
        ('Sampler', lambda: pr.Sampler(wrapS=pr.GLTF.REPEAT)), ('from_points', lambda: pr.Mesh.from_points(SQUARE, colors=SQUARE)), ('mode', lambda: pr.Primitive(SQUARE, mode=pr.GLTF.POINTS)),
        ('Camera', lambda: pr.Camera(0.05, 100.0)), ('Light', lambda: pr.Light()), ('Material', lambda: pr.Material()), ('get_projection_matrix', lambda: CAMERA.get_projection_matrix(W, H)),
        ('shadow_texture', lambda: lamp.shadow_texture), ('shadow_texture', lamp.generate_shadow_texture), ('get_shadow_camera', lambda: lamp.get_shadow_camera(2.0)),
        ('viewport_width: 64.5', lambda: pr.OffscreenRenderer(64.5, 48)), ('viewport_height: 0.5', lambda: pr.OffscreenRenderer(64, 0.5)), ('viewport_height', lambda: setattr(renderer, 'viewport_height', 48.5))):
    refused(words, call)
flags = {name: value for name, value in vars(pr.RenderFlags).items() if name.isupper()}
assert flags['SHADOWS_ALL'] == 224 and sum(value for name, value in flags.items() if name != 'SHADOWS_ALL') == 32767, flags
for name in ('FLIP_WIREFRAME', 'ALL_WIREFRAME', 'SHADOWS_DIRECTIONAL', 'SHADOWS_POINT', 'SHADOWS_SPOT', 'VERTEX_NORMALS', 'FACE_NORMALS', 'DISABLE_ANTI_ALIASING'):
    refused(f'flags: {name}: ', lambda: renderer.render(whole, flags[name]))
refused('shadows="on"', lambda: renderer.render(whole, pr.RenderFlags.SHADOWS_ALL | pr.RenderFlags.RGBA))
for thing in (grey, grey.primitives[0], whole):
    assert list(thing.centroid) == [0, 0, 0] and list(thing.extents) == [2, 2, 0] and abs(thing.scale - math.sqrt(8)) < 1e-9
assert pr.Primitive(SQUARE[:3], mode=pr.GLTF.TRIANGLES).count == 3 and pr.OffscreenRenderer(64.0, 48).viewport_width == 64
assert all(isinstance(thing, kind) for thing, kind in ((CAMERA, pr.Camera), (lamp, pr.Light), (pr.MetallicRoughnessMaterial(), pr.Material)))
class Faces: kind = 'face'
refused('face_colors', lambda: pr.Mesh.from_trimesh(type('T', (), {'vertices': SQUARE, 'faces': FACES, 'visual': Faces})()))
# Shadows by the keyword: a small square keeps the lamp's light off the middle
shaded = scene_of(CAMERA, FRONT, (square(2, metallicFactor=0.0), None), (square(0.2), turn('x', 0, (0.5, 0, 1))), ambient_light=(0.0, 0.0, 0.0))
shaded.add(lamp, pose=turn('x', 0, (1.0, 0, 2)))
assert shaded.point_lights == {lamp} and not shaded.spot_lights and len(shaded.point_light_nodes) == 1 and not shaded.directional_light_nodes
plain, dark = (pr.OffscreenRenderer(W, H, **more).render(shaded)[0] for more in ({}, {'shadows': 'on'}))
assert rgb(dark, 24, 32) == (0, 0, 0) != rgb(plain, 24, 32) and rgb(dark, 24, 50) == rgb(plain, 24, 50), (rgb(dark, 24, 32), rgb(plain, 24, 32))
lamp.intensity = 0
assert rgb(renderer.render(shaded)[0], 24, 50) == (0, 0, 0), 'a lamp that is turned off'
lamp.intensity = -1
refused('intensity', lambda: renderer.render(shaded))
# trimesh's scenes
class Graph:
    nodes_geometry = ['left', 'right']
    def __getitem__(self, name): return turn('x', 0, (-1.5 if name == 'left' else 1.5, 0, 0)), 'tile'
tile = type('T', (), {'vertices': SQUARE, 'faces': FACES})()
pair = pr.Scene.from_trimesh_scene(type('S', (), {'geometry': {'tile': tile}, 'graph': Graph()})(), ambient_light=(0.5, 0.5, 0.5))
pair.add(CAMERA, pose=turn('x', 0, (0, 0, 8)))
depth = renderer.render(pair)[1]
assert box(depth) == (17, 46, 18, 29) and depth[24, 32] == 0, box(depth)
""")


@case("python.offscreen_warns_of_the_script_s_scene_alone", budget=10)
def warned(bench):
    """The page's example warns of nothing. A warning about a script's own mesh names the script's line."""
    page = (ROOT / "apps/manual/python.md").read_text().split("## Scripts for pyrender")[1]
    (bench.folder / "page.py").write_text(page.split("```python\n")[1].split("```")[0])
    python(bench, HEAD + """
import warnings
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter('always')
    with open('page.py') as page: exec(page.read(), {})
    assert not told, [str(one.message) for one in told]
    bare = scene_of(CAMERA, FRONT, (square(anisotropyStrength=0.8), None), bg_color=(0.1, 0.2, 0.3))
    renderer.render(bare)
    assert [one.category for one in told] == [burnish.InputWarning] and 'coordinates' in str(told[0].message) and told[0].filename == '<string>', told
    renderer.render(bare)
    assert len(told) == 1
""")


@case("python.offscreen_nodes_move_with_their_parents", budget=10)
def nested(bench):
    for program in pythons():
        python(bench, HEAD + """
s2 = math.sqrt(0.5)
hand = pr.Node(name='hand', mesh=square(0.5), scale=2)
arm = pr.Node(name='arm', translation=(1, 0.5, 0), children=[hand])
scene = pr.Scene(nodes=[arm], ambient_light=(0.5, 0.5, 0.5))
scene.add(CAMERA, pose=FRONT)
assert box(renderer.render(scene)[1]) == (32, 55, 6, 29)
listed = lambda values: [list(map(float, row)) for row in values]
assert listed(scene.bounds) == [[0, -0.5, 0], [2, 1.5, 0]] and abs(scene.scale - math.sqrt(8)) < 1e-9 and list(scene.centroid) == [1, 0.5, 0] and list(scene.extents) == [2, 2, 0]
assert listed(scene.get_pose(hand)) == [[2, 0, 0, 1], [0, 2, 0, 0.5], [0, 0, 2, 0], [0, 0, 0, 1]] and scene.get_pose(arm) is arm.matrix
assert scene.get_nodes(name='hand') == scene.get_nodes(obj=hand.mesh) == scene.get_nodes(node=hand) == {hand} and scene.get_nodes(name='foot') == set()
assert len(scene.nodes) == 3 and scene.mesh_nodes == [hand] and scene.meshes == {hand.mesh}
scene.set_pose(arm, turn('z', 90, (-1, 0, 0)))
assert box(renderer.render(scene)[1]) == (8, 31, 12, 35)
# A camera on an arm: the arm's turn is the camera's
rig = pr.Scene(ambient_light=(0.5, 0.5, 0.5))
rig.add(square(doubleSided=True))
mount = rig.add_node(pr.Node(name='mount', rotation=(0, s2, 0, s2), translation=(0, 0, 0)))     # about y by 90 degrees
eye = rig.add(CAMERA, pose=turn('x', 0, (0, 0, 4)), parent_name='mount')
assert [round(float(row[3]), 6) for row in rig.get_pose(eye)] == [4, 0, 0, 1]
mount.rotation = (0, 1, 0, 0)
assert abs(renderer.render(rig)[1][24, 32] - 4.0) < 1e-5
mount.scale = 2
refused('pose: its axes', lambda: renderer.render(rig))
mount.scale = (1, 1, 1)
rig.remove_node(mount)
assert rig.main_camera_node is None and len(rig.nodes) == 1
mirrored = pr.Node(scale=(1, -1, 1), rotation=(0, 0, 0, 1))
assert [list(row)[:3] for row in mirrored.matrix][:3] == [[1, 0, 0], [0, -1, 0], [0, 0, 1]], mirrored.matrix
mirrored.scale = (1, -1, 1)
assert list(mirrored.scale) == [1, -1, 1] and mirrored.matrix[1][1] == -1, mirrored.matrix
assert [pr.Node(scale=(-1, -1, 1), rotation=(0, 0, 0, 1)).matrix[i][i] for i in range(3)] == [-1, -1, 1]
flat = pr.Node(scale=(1, 1, 0), rotation=(0.5 ** 0.5, 0, 0, 0.5 ** 0.5), translation=(1, 2, 3))
assert abs(flat.matrix[2][1] - 1) < 1e-9 and abs(flat.matrix[1][1]) < 1e-9 and flat.matrix[2][3] == 3, flat.matrix
for quaternion in ((0.5, 0.5, 0.5, 0.5), (0.1, 0.2, -0.3, 0.4), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0.7, -0.1, 0.2, 0.05)):
    node = pr.Node(rotation=quaternion, scale=(2, 3, 0.5), translation=(1, 2, 3))
    length = math.sqrt(sum(value * value for value in quaternion))
    assert abs(abs(sum(a * b for a, b in zip(quaternion, node.rotation))) / length - 1) < 1e-9, node.rotation
    assert all(abs(a - b) < 1e-9 for a, b in zip(node.scale, (2, 3, 0.5))) and node.translation == [1, 2, 3]
""", program)


@case("python.offscreen_pictures_lie_on_meshes", budget=10)
def textured(bench):
    """(0, 0) is the lower left corner; alpha cuts holes into the coverage."""
    for program in pythons():
        python(bench, HEAD + """
class Picture: # an array without numpy
    def __init__(self, rows): self.rows, self.shape = rows, (len(rows), len(rows[0]), len(rows[0][0]))
    def tolist(self): return self.rows
RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)
def of(rows, **more):
    material = pr.MetallicRoughnessMaterial(baseColorTexture=Picture(rows), metallicFactor=0.0, **more)
    return pr.Mesh([pr.Primitive(SQUARE, indices=FACES, texcoord_0=[(0, 0), (1, 0), (1, 1), (0, 1)], material=material)])
picture, _ = renderer.render(scene_of(CAMERA, FRONT, (of([[RED, GREEN], [BLUE, WHITE]]), None)), pr.RenderFlags.FLAT)
def strongest(y, x): return [i for i, value in enumerate(rgb(picture, y, x)) if value > 180]
assert [strongest(y, x) for y in (16, 31) for x in (24, 39)] == [[0], [1], [2], [0, 1, 2]]
assert pr.Texture(source=Picture([[(1.0, 0.0, 0.0)]])).pixels == bytes(RED)
holed = of([[WHITE + (0,)] * 2 + [WHITE + (255,)] * 2], alphaMode='MASK')
clear, _ = renderer.render(scene_of(CAMERA, FRONT, (holed, None), bg_color=(0.0, 0.0, 0.0, 0.0)), pr.RenderFlags.RGBA)
assert clear[24, 25, 3] == 0 and clear[24, 38, 3] == 255, (clear[24, 25, 3], clear[24, 38, 3])
class Textured: kind, uv, material = 'texture', [(0, 0), (1, 0), (1, 1), (0, 1)], type('M', (), {'image': Picture([[RED]])})()
mesh = pr.Mesh.from_trimesh(type('T', (), {'vertices': SQUARE, 'faces': FACES, 'visual': Textured})())
red, _ = renderer.render(scene_of(CAMERA, FRONT, (mesh, None)), pr.RenderFlags.FLAT)
assert rgb(red, 24, 32)[0] > 180 and rgb(red, 24, 32)[1] < 100, rgb(red, 24, 32)
""", program)
