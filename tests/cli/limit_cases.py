"""Every limit on input refuses larger input, names itself, and can be raised by its option."""

import gltf_files as files
from harness import case, scratch
from input_cases import accept, refuse


@case("limit.image_side_is_kept", "input")
def image_side(bench):
    scratch(bench, "texture.png", files.png(40, 40))
    scene = scratch(bench, "scene.gltf", files.text(files.textured("texture.png")))
    accept(bench, scene)
    refuse(bench, scene, "--limit-image-side", "39")
    accept(bench, scene, "--limit-image-side", "40")


@case("limit.texture_bytes_are_kept", "input")
def texture_bytes(bench):
    scratch(bench, "texture.png", files.png(40, 40))
    scene = scratch(bench, "scene.gltf", files.text(files.textured("texture.png")))
    refuse(bench, scene, "--limit-texture-bytes", "1K")
    accept(bench, scene, "--limit-texture-bytes", "1M")


@case("limit.texture_bytes_hold_for_packed_maps", "input")
def packed_maps(bench):
    """A long and a high picture become one that is both."""
    folder = bench.folder / "set"
    folder.mkdir()
    (folder / "a_metallic.png").write_bytes(files.png(1000, 1))
    (folder / "a_roughness.png").write_bytes(files.png(1, 1000))
    words = ("builtin:plate", "--material", "set")
    bench.run("render", *words, "--size", "16x16", "--limit-texture-bytes", "2M").expect(4).expect_one_line("a_roughness.png", "2097152")
    accept(bench, *words, "--limit-texture-bytes", "4M")


@case("limit.json_depth_is_kept", "input")
def json_depth(bench):
    gltf = files.triangle()
    nested = value = {}
    for _ in range(80):
        value["a"] = value = {}
    gltf["extras"] = nested
    scene = scratch(bench, "deep.gltf", files.text(gltf))
    refuse(bench, scene)
    accept(bench, scene, "--limit-json-depth", "100")


@case("limit.bottomless_json_is_refused", "input")
def json_bottomless(bench):
    """Nesting that would overflow the stack of a recursive parser."""
    refuse(bench, scratch(bench, "bottomless.gltf", "[" * 3000000))
    refuse(bench, scratch(bench, "objects.gltf", '{"a":' * 500000))


@case("limit.node_depth_is_kept", "input")
def node_depth(bench):
    gltf = files.triangle()
    depth = 300
    gltf["nodes"] = [{"children": [i + 1]} for i in range(depth)] + [{"mesh": 0}]
    scene = scratch(bench, "chain.gltf", files.text(gltf))
    refuse(bench, scene)
    accept(bench, scene, "--limit-node-depth", "400")


@case("limit.file_bytes_are_kept", "input")
def file_bytes(bench):
    scene = scratch(bench, "scene.glb", files.glb(files.triangle()))
    refuse(bench, scene, "--limit-file-bytes", "100")
    accept(bench, scene, "--limit-file-bytes", "1M")


@case("limit.accessor_bytes_are_kept", "input")
def accessor_bytes(bench):
    scene = scratch(bench, "scene.glb", files.glb(files.triangle()))
    refuse(bench, scene, "--limit-accessor-bytes", "16")
    accept(bench, scene, "--limit-accessor-bytes", "1M")


@case("limit.data_uri_bytes_are_kept", "input")
def data_uri_bytes(bench):
    scene = scratch(bench, "scene.gltf", files.text(files.triangle()))
    refuse(bench, scene, "--limit-data-uri-bytes", "10")
    accept(bench, scene, "--limit-data-uri-bytes", "1K")


@case("limit.uris_stay_below_the_folder", "input")
def outside_uris(bench):
    scratch(bench, "outside.bin", files.POSITIONS + files.INDICES)
    gltf = files.triangle()
    for number, uri in enumerate(("../outside.bin", "a/../../outside.bin", "..%2Foutside.bin",
                                  str(bench.folder / "outside.bin"))):
        gltf["buffers"][0]["uri"] = uri
        refuse(bench, scratch(bench, f"scene/outside{number}.gltf", files.text(gltf)))
    accept(bench, "scene/outside0.gltf", "--allow-outside-uris")
