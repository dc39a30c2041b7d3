"""MaterialX files (--material FILE.mtlx): the pictures of equal glTF materials; files that cannot be read."""

import gltf_files as files
from fresnel_cases import CLOSE
from harness import case, check
from input_cases import scratch
from gltf_files import base64

PIXELS = dict(color=lambda x, y: (200 - 9 * x, 90 + 5 * y, 250 - 7 * x, 255))


def value(name, number, kind="float"):
    return f'<input name="{name}" type="{kind}" value="{number}"/>'


def link(name, output, kind="float"):
    return f'<input name="{name}" type="{kind}" nodegraph="G" output="{output}"/>'


def document(kind, inputs, graph="", name="M"):
    return (f'<materialx version="1.39" colorspace="lin_rec709">{graph}<{kind} name="S" type="surfaceshader">{inputs}</{kind}>'
            f'<surfacematerial name="{name}" type="material"><input name="surfaceshader" type="surfaceshader" nodename="S"/></surfacematerial></materialx>')


def picture(name, channel=None, space=""):
    """Returns an image node and an output of it, or of one of its channels."""
    node = f'<image name="{name}" type="color3"><input name="file" type="filename" value="{name}.png"{space}/></image>'
    if channel is None:
        return node + f'<output name="{name}" type="color3" nodename="{name}"/>'
    return (node + f'<extract name="{name}_x" type="float"><input name="in" type="color3" nodename="{name}"/>{value("index", channel, "integer")}</extract>'
            f'<output name="{name}" type="float" nodename="{name}_x"/>')


def plate(bench, name, material, used=()):
    """Returns a textured triangle that fills the view. The file wears the material."""
    gltf = files.textured("data:image/png;base64," + base64.b64encode(files.png(16, 16, **PIXELS)).decode())
    gltf["materials"] = [{"doubleSided": True, **material}]
    gltf["extensionsUsed"] = list(used)
    return scratch(bench, name + ".gltf", files.text(gltf))


def write(bench, name, text):
    (bench.folder / name).write_text(text)
    return name


@case("mtlx.surfaces_draw_as_equal_gltf_materials_do")
def equal(bench):
    (bench.folder / "colour.png").write_bytes(files.png(16, 16, **PIXELS))
    bare = plate(bench, "bare", {})
    srgb = ' colorspace="srgb_texture"'
    graph = "<nodegraph name='G'>" + picture("colour", None, srgb) + "</nodegraph>"
    pbr = dict(metallicFactor=0.25, roughnessFactor=0.5)
    for name, text, material, used in (
            ("numbers", document("gltf_pbr", value("base_color", "0.5, 0.25, 0.125", "color3") + value("metallic", 0.25) + value("roughness", 0.5)),
             {"pbrMetallicRoughness": {**pbr, "baseColorFactor": [0.5, 0.25, 0.125, 1]}}, ()),
            ("picture", document("gltf_pbr", link("base_color", "colour", "color3") + value("metallic", 0.25) + value("roughness", 0.5), graph),
             {"pbrMetallicRoughness": {**pbr, "baseColorTexture": {"index": 0}}}, ()),
            ("coat and film", document("gltf_pbr", value("metallic", 0.25) + value("roughness", 0.5) + value("clearcoat", 0.5) + value("clearcoat_roughness", 0.25) +
                                       value("iridescence", 0.75) + value("iridescence_thickness", 350) + value("iridescence_ior", 1.5)),
             {"pbrMetallicRoughness": pbr, "extensions": {
                 "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25},
                 "KHR_materials_iridescence": {"iridescenceFactor": 0.75, "iridescenceIor": 1.5, "iridescenceThicknessMaximum": 350}}},
             ("KHR_materials_clearcoat", "KHR_materials_iridescence")),
            ("stretched", document("gltf_pbr", value("metallic", 0.25) + value("roughness", 0.5) + value("anisotropy_strength", 0.5) + value("anisotropy_rotation", 0.5)),
             {"pbrMetallicRoughness": pbr, "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 0.5}}},
             ("KHR_materials_anisotropy",))):
        for technique in ("auto", "split_isotropic"):
            words = (*CLOSE, "--technique", technique, "--msaa", "4")
            mine = bench.figures(bare, "--material", write(bench, "a.mtlx", text), *words)["pixel_hash"]
            theirs = bench.figures(plate(bench, "own", material, used), *words)["pixel_hash"]
            check(mine == theirs, f"{name}, {technique}: {mine}, not {theirs}")
            check(mine != bench.figures(bare, *words)["pixel_hash"], f"{name}: nothing is tested")


@case("mtlx.files_that_cannot_be_drawn_are_named", "input")
def faults(bench):
    bare = plate(bench, "bare", {})
    words = ("render", bare, *CLOSE, "--material")
    noise = "<nodegraph name='G'><noise3d name='n' type='float'/><output name='n' type='float' nodename='n'/></nodegraph>"
    for text, needle in (("<materialx", "a.mtlx: byte"), (document("gltf_pbr", link("roughness", "n"), noise), "roughness: noise3d n: such nodes are not read"),
                         (document("gltf_pbr", link("roughness", "lost"), "<nodegraph name='G'>" + picture("lost", 1) + "</nodegraph>"), "lost.png is not found"),
                         (document("lambert", ""), "standard_surface, open_pbr_surface and gltf_pbr are")):
        bench.run(*words, write(bench, "a.mtlx", text)).expect(4).expect_one_line(needle)
    bench.run(*words, "missing.mtlx").expect(4).expect_one_line("missing.mtlx")
    ball = scratch(bench, "no_uv.gltf", files.text(files.triangle()))
    (bench.folder / "lost.png").write_bytes(files.png(16, 16, **PIXELS))
    text = document("gltf_pbr", link("roughness", "lost"), "<nodegraph name='G'>" + picture("lost", 1) + "</nodegraph>")
    bench.run("render", ball, *CLOSE, "--material", write(bench, "a.mtlx", text)).expect(4).expect_one_line("texture coordinates")
    said = bench.run(*words, write(bench, "a.mtlx", document("standard_surface", value("subsurface", 0.5)))).expect(0).err
    check('nothing is made of subsurface' in said, said)
    two = document("gltf_pbr", "", name="A").replace("</materialx>", document("gltf_pbr", "", name="B").split("</gltf_pbr>")[1])
    bench.run(*words, write(bench, "a.mtlx", two)).expect(2).expect_one_line("--material: no material of the scene has the name of one of these: A, B")
