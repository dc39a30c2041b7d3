"""Bad input: one line that names the file, exit code 4, nothing left behind, quickly and with little memory."""

import os
import struct

import gltf_files as files
from harness import GIB, SMALL, Failed, Skipped, case, check, data_files, scratch, words_of

SECONDS = 10.0  # maximum time of a run on bad input
SCENES = (".gltf", ".glb")
PICTURES = (".exr", ".hdr", ".png", ".jpg")


def refuse(bench, scene, *extra, needles=(), env=None, code=4, **options):
    """Renders, and expects the refusal of `env` where given, else of `scene`."""
    before = set(bench.left_behind())
    what = ("--env", env) if env else ()
    small = ("--size", "64x48", "--msaa", "1") + (() if env else SMALL[4:])
    done = bench.run("render", scene, *what, *small, "-o", "out.png", "-o", "out.exr", *extra, **options)
    done.expect(code).expect_one_line(os.path.basename(str(env or scene)), *needles)
    left = set(bench.left_behind()) - before
    check(not left, f"left behind: {sorted(left)}\n{done.describe()}")
    if not bench.sanitized:
        check(done.seconds < SECONDS, f"took {done.seconds:.1f} s\n{done.describe()}")
        check(done.peak_bytes < GIB, f"took {done.peak_bytes >> 20} MiB\n{done.describe()}")
    return done


def accept(bench, scene, *extra):
    """Loads the file without its fault; otherwise the refusal would prove nothing."""
    return bench.run("render", scene, *SMALL, "-o", "accepted.png", *extra).expect(0)


def add_data_cases(data):
    """Adds one case for each malformed file in the test data."""
    for name, path in data_files(data, "malformed", SCENES + PICTURES).items():

        def run(bench, path=path):
            if path.suffix in SCENES:
                refuse(bench, path)
            else:
                refuse(bench, "builtin:plate", env=path)

        case("malformed.is_refused." + words_of(name), "input")(run)


@case("input.absent_file_is_refused", "input")
def absent_file(bench):
    for name in ("nothing.gltf", "nothing.glb", "no/folder/nothing.glb"):
        refuse(bench, name)
    refuse(bench, "builtin:plate", env="nothing.exr")


@case("input.directory_is_refused", "input")
def directory(bench):
    for name in ("folder.glb", "folder.gltf", "folder.exr", "folder.hdr"):
        (bench.folder / name).mkdir()
    for name in ("folder.glb", "folder.gltf"):
        refuse(bench, name)
    for name in ("folder.exr", "folder.hdr"):
        refuse(bench, "builtin:plate", env=name)


@case("input.empty_file_is_refused", "input")
def empty_file(bench):
    for suffix in SCENES:
        refuse(bench, scratch(bench, "empty" + suffix, b""))
    for suffix in PICTURES:
        refuse(bench, "builtin:plate", env=scratch(bench, "empty" + suffix, b""))


@case("input.noise_is_refused", "input")
def noise(bench):
    """Reads bytes from a fixed generator under every name."""
    state, data = 12345, bytearray()
    for _ in range(4096):
        state = (state * 1103515245 + 12345) & 0x7FFFFFFF
        data.append(state >> 16 & 255)
    for suffix in SCENES:
        refuse(bench, scratch(bench, "noise" + suffix, bytes(data)))
    for suffix in PICTURES:
        refuse(bench, "builtin:plate", env=scratch(bench, "noise" + suffix, bytes(data)))


@case("input.unknown_extension_is_refused", "input")
def unknown_extension(bench):
    refuse(bench, scratch(bench, "scene.obj", b"v 0 0 0\n"))
    refuse(bench, "builtin:plate", env=scratch(bench, "picture.txt", b"no picture\n"))


@case("input.unreadable_file_is_refused", "input")
def unreadable_file(bench):
    path = scratch(bench, "secret.glb", files.glb(files.triangle()))
    path.chmod(0)
    user = None
    if os.geteuid() == 0:
        user = 65534  # root reads everything, so another user must run it
        bench.folder.chmod(0o777)
        try:
            bench.run("--version", user=user).expect(0)
        except (PermissionError, Failed) as error:
            raise Skipped(f"root cannot run the program as another user here: {error}") from error
    refuse(bench, "secret.glb", user=user)


@case("input.nan_in_a_position_is_refused", "input")
def nan_in_a_position(bench):
    accept(bench, scratch(bench, "good.gltf", files.text(files.triangle())))
    for name, value in (("nan", float("nan")), ("inf", float("inf"))):
        bad = files.POSITIONS[:12] + struct.pack("<f", value) + files.POSITIONS[16:]
        refuse(bench, scratch(bench, name + ".gltf", files.text(files.triangle(positions=bad))))


@case("input.index_out_of_range_is_refused", "input")
def index_out_of_range(bench):
    bad = struct.pack("<3H", 0, 1, 3)
    refuse(bench, scratch(bench, "index.gltf", files.text(files.triangle(indices=bad))), needles=("/",))


def edited(edit):
    gltf = files.triangle()
    edit(gltf)
    return files.text(gltf)


# One edit each of a scene that loads.
EDITS = {
    "node_cycle": lambda g: g["nodes"].append({"children": [0]}) or g["nodes"][0].update(children=[1]),
    "node_own_child": lambda g: g["nodes"][0].update(children=[0]),
    "node_child_out_of_range": lambda g: g["nodes"][0].update(children=[7]),
    "node_two_parents": lambda g: g["nodes"].extend([{"children": [0]}, {"children": [0]}]),
    "scene_node_out_of_range": lambda g: g["scenes"][0].update(nodes=[5]),
    "mesh_out_of_range": lambda g: g["nodes"][0].update(mesh=9),
    "accessor_out_of_range": lambda g: g["meshes"][0]["primitives"][0].update(indices=44),
    "accessor_negative": lambda g: g["meshes"][0]["primitives"][0]["attributes"].update(POSITION=-2),
    "accessor_count_huge": lambda g: g["accessors"][0].update(count=1 << 40),
    "accessor_count_negative": lambda g: g["accessors"][0].update(count=-3),
    "accessor_past_view": lambda g: g["accessors"][0].update(byteOffset=4),
    "accessor_offset_huge": lambda g: g["accessors"][0].update(byteOffset=(1 << 63) - 4),
    "accessor_type_unknown": lambda g: g["accessors"][0].update(type="VEC7"),
    "accessor_component_unknown": lambda g: g["accessors"][0].update(componentType=1234),
    "view_past_buffer": lambda g: g["bufferViews"][0].update(byteLength=4000),
    "view_offset_huge": lambda g: g["bufferViews"][0].update(byteOffset=(1 << 62)),
    "view_buffer_out_of_range": lambda g: g["bufferViews"][0].update(buffer=3),
    "buffer_longer_than_data": lambda g: g["buffers"][0].update(byteLength=5000),
    "buffer_file_absent": lambda g: g["buffers"][0].update(uri="absent.bin"),
    "buffer_over_http": lambda g: g["buffers"][0].update(uri="http://127.0.0.1/scene.bin"),
    "buffer_bad_base64": lambda g: g["buffers"][0].update(uri="data:application/octet-stream;base64,@@@@"),
    "material_out_of_range": lambda g: g["meshes"][0]["primitives"][0].update(material=3),
    "rotation_as_an_array": lambda g: g.update(materials=[{"extensions": {"KHR_materials_anisotropy": {"anisotropyRotation": [0.5]}}}]),
    "asset_version_unknown": lambda g: g["asset"].update(version="9.0"),
    "asset_absent": lambda g: g.pop("asset"),
    "matrix_not_finite": lambda g: g["nodes"][0].update(matrix=[1e39] * 16),
}


def add_edits():
    for name, edit in EDITS.items():

        def run(bench, name=name, edit=edit):
            refuse(bench, scratch(bench, name + ".gltf", edited(edit)))

        case("input.edit_is_refused." + name, "input")(run)


add_edits()


@case("input.required_extension_is_named", "input")
def required_extension(bench):
    gltf = files.triangle()
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = ["EXT_unheard_of", "KHR_also_not"]
    refuse(bench, scratch(bench, "required.gltf", files.text(gltf)), needles=("EXT_unheard_of", "KHR_also_not"))
    del gltf["extensionsRequired"]
    done = accept(bench, scratch(bench, "used.gltf", files.text(gltf)))
    warnings = [line for line in done.err.splitlines() if line.startswith("burnish: warning: ")]
    for name in ("EXT_unheard_of", "KHR_also_not"):
        check(sum(name in line for line in warnings) == 1, f"expected one warning about {name}\n{done.describe()}")


@case("input.truncated_glb_is_refused", "input")
def truncated_glb(bench):
    whole = files.glb(files.triangle())
    accept(bench, scratch(bench, "whole.glb", whole))
    for length in list(range(0, 24, 3)) + list(range(24, len(whole), 97)) + [len(whole) - 1]:
        refuse(bench, scratch(bench, "cut.glb", whole[:length]))


@case("input.truncated_json_is_refused", "input")
def truncated_json(bench):
    whole = files.text(files.triangle())
    for length in range(1, len(whole), 71):
        refuse(bench, scratch(bench, "cut.gltf", whole[:length]))


@case("input.picture_of_60000_by_60000_is_refused", "input")
def huge_picture(bench):
    huge = files.png(60000, 60000, rows=4)
    refuse(bench, "builtin:plate", env=scratch(bench, "huge.png", huge))
    scratch(bench, "texture.png", huge)
    scene = scratch(bench, "scene.gltf", files.text(files.textured("texture.png")))
    refuse(bench, scene)
