"""Records means of the scenes in cycles_scenes.py by Cycles. Runs inside Blender 3.4:

    blender --background --factory-startup --python tests/cli/cycles_record.py -- tests/data/cycles_means.json [NAME]..."""

import json
import math
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy  # noqa: E402
from mathutils import Matrix, Vector  # noqa: E402

import cycles_scenes as scenes  # noqa: E402
import environment_files  # noqa: E402
import outside_scenes as drawing  # noqa: E402
from outside_integrals import cross, unit  # noqa: E402

SIDE = 32  # pixels
SAMPLES = 4096
RUNS = 8  # with a seed each: their spread is the standard error


def turned(v):
    """Returns a vector of glTF, whose +Y is up, as Blender has it."""
    return v[0], -v[2], v[1]


def camera(scene):
    x = unit(cross((0.0, 1.0, 0.0), scene["eye"]))
    y = cross(scene["eye"], x)
    data = bpy.data.cameras.new("camera")
    data.type, data.ortho_scale, data.clip_end = "ORTHO", 2.0 * scene["window"], 100.0
    place = bpy.data.objects.new("camera", data)
    columns = [Vector(turned(v)) for v in (x, y, scene["eye"])]
    place.matrix_world = Matrix.Translation(20.0 * columns[2]) @ Matrix(columns).transposed().to_4x4()
    bpy.context.collection.objects.link(place)
    bpy.context.scene.camera = place


def sky(function, folder):
    path = Path(folder) / "sky.exr"
    path.write_bytes(environment_files.exr(drawing.WIDE, drawing.WIDE // 2, lambda x, y: function(drawing.direction(x, y))))
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    bpy.context.scene.world = world
    picture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(str(path))
    picture.image.colorspace_settings.name = "Linear"
    world.node_tree.links.new(picture.outputs[0], world.node_tree.nodes["Background"].inputs[0])


def texels(codes):
    picture = bpy.data.images.new("texels", len(codes), 1)
    picture.colorspace_settings.name = "Non-Color"
    picture.pixels = [v for code in codes for v in (*(c / 255.0 for c in code), 1.0)]
    picture.pack()
    return picture


def texture(tree, codes):
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, node.interpolation = texels(codes), "Closest"
    return node.outputs["Color"]


def lobe(tree, of):
    node = tree.nodes.new({"diffuse": "ShaderNodeBsdfDiffuse", "metal": "ShaderNodeBsdfAnisotropic", "glass": "ShaderNodeBsdfGlass",
                           "emission": "ShaderNodeEmission"}[of["kind"]])
    node.inputs["Color"].default_value = (*of["colour"], 1.0)
    if of["kind"] in ("metal", "glass"):
        node.distribution = "GGX"
    if of["kind"] == "glass":
        node.inputs["IOR"].default_value, node.inputs["Roughness"].default_value = 1.5, of["roughness"]
    if of["kind"] == "metal":
        # Cycles stretches by 1 + a and shrinks by 1 / (1 + a), where a is negative along the tangent.
        along, across = scenes.alphas(of)
        node.inputs["Roughness"].default_value = (along * across) ** 0.25
        node.inputs["Anisotropy"].default_value = math.sqrt(across / along) - 1.0
        node.inputs["Rotation"].default_value = scenes.turn(of) / (2.0 * math.pi)
        tangent = tree.nodes.new("ShaderNodeTangent")
        tangent.direction_type, tangent.uv_map = "UV_MAP", "uv"
        tree.links.new(tangent.outputs[0], node.inputs["Tangent"])
    if "roughness_codes" in of:
        product = tree.nodes.new("ShaderNodeMath")
        product.operation, product.inputs[1].default_value = "MULTIPLY", of["roughness"]
        tree.links.new(texture(tree, [(c, c, c) for c in of["roughness_codes"]]), product.inputs[0])
        tree.links.new(product.outputs[0], node.inputs["Roughness"])
    if "normal_code" in of:
        bent = tree.nodes.new("ShaderNodeNormalMap")
        bent.uv_map = "uv"
        tree.links.new(texture(tree, [of["normal_code"]]), bent.inputs["Color"])
        tree.links.new(bent.outputs[0], node.inputs["Normal"])
    return node


def mesh(shape, of):
    corners, faces = shape
    data = bpy.data.meshes.new("mesh")
    data.from_pydata([turned(c) for c in corners], [], [faces[k:k + 3] for k in range(0, len(faces), 3)])
    data.use_auto_smooth = True
    data.polygons.foreach_set("use_smooth", [True] * len(data.polygons))
    data.normals_split_custom_set_from_vertices([turned(c[3:6]) for c in corners])
    coordinates = data.uv_layers.new(name="uv")
    for k, loop in enumerate(data.loops):
        c = corners[loop.vertex_index]
        coordinates.data[k].uv = (c[10], 1.0 - c[11])
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    tree.links.new(lobe(tree, of).outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs[0])
    data.materials.append(material)
    bpy.context.collection.objects.link(bpy.data.objects.new("mesh", data))


def lamp(centre, a, b, radiance):
    """A rectangle as Cycles' area light, which stands in nobody's way. Its radiance is energy / (4 area)."""
    strongest, (x, y) = max(radiance), (math.sqrt(sum(v * v for v in e)) for e in (a, b))
    data = bpy.data.lights.new("lamp", "AREA")
    data.shape, data.size, data.size_y = "RECTANGLE", 2.0 * x, 2.0 * y
    data.color, data.energy = [c / strongest for c in radiance], strongest * 4.0 * (4.0 * x * y)
    columns = [Vector(turned(unit(e))) for e in (a, b, tuple(-v for v in cross(a, b)))]
    columns[1] = columns[2].cross(columns[0])  # a lamp shines along -z
    place = bpy.data.objects.new("lamp", data)
    place.matrix_world = Matrix.Translation(Vector(turned(centre))) @ Matrix(columns).transposed().to_4x4()
    bpy.context.collection.objects.link(place)


def settings():
    scene = bpy.context.scene
    scene.render.engine, cycles = "CYCLES", scene.cycles
    cycles.device, cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", SAMPLES, False, False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    for name in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "transparent_max_bounces"):
        setattr(cycles, name, 64)
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    render = scene.render
    render.film_transparent, render.resolution_percentage = True, 100
    render.resolution_x = render.resolution_y = SIDE
    render.image_settings.file_format, render.image_settings.color_depth, render.image_settings.color_mode = "OPEN_EXR", "32", "RGBA"


def mean_of(path):
    picture = bpy.data.images.load(str(path))
    picture.colorspace_settings.name = "Non-Color"
    values = list(picture.pixels)
    bpy.data.images.remove(picture)
    return [sum(values[c::4]) / SIDE**2 for c in range(3)]


def record(scene, folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    settings()
    camera(scene)
    sky(scene["sky"], folder)
    for shape, of in scene["parts"]:
        mesh(shape, of)
    for one in scene.get("lamps", ()):
        lamp(*one)
    means = []
    for seed in range(RUNS):
        bpy.context.scene.cycles.seed = seed
        bpy.context.scene.render.filepath = str(Path(folder) / "picture.exr")
        bpy.ops.render.render(write_still=True)
        means.append(mean_of(bpy.context.scene.render.filepath))
    mean = [sum(m[c] for m in means) / RUNS for c in range(3)]
    error = [math.sqrt(sum((m[c] - mean[c]) ** 2 for m in means) / (RUNS * (RUNS - 1))) for c in range(3)]
    return {"mean": [float("%.6g" % v) for v in mean], "standard_error": [float("%.2g" % v) for v in error]}


def main():
    output, *names = sys.argv[sys.argv.index("--") + 1:]
    path = Path(output)
    kept = json.loads(path.read_text())["scenes"] if path.exists() else {}
    with tempfile.TemporaryDirectory() as folder:
        for name, scene in scenes.SCENES.items():
            if not names or name in names:
                kept[name] = record(scene, folder)
                print("recorded", name, kept[name], flush=True)
    path.write_text(json.dumps({"made_by": f"Cycles of Blender {bpy.app.version_string}", "samples_a_pixel": SAMPLES * RUNS, "side": SIDE,
                                "scenes": {name: kept[name] for name in scenes.SCENES if name in kept}}, indent=1) + "\n")


main()
