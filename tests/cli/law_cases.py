"""Laws for every technique: mirrored and scaled scenes give mirrored and scaled images, and theory's decreases hold."""

import array
import csv
import io
import math
import re
import struct

from environment_files import exr, hdr, rgbe
from gltf_files import data_uri, png, text
from harness import case, check, scratch

LIGHT = ("--env", "builtin:studio", "--env-size", "64", "--env-samples", "64", "--floor", "off")
SIDE = ("--size", "64x64", "-q")


def in_two_tiers(claim, law, some):
    """Registers law(bench, techniques) for some techniques in check, and for all nightly."""
    @case(f"laws.{claim}", budget=20)
    def for_some(bench):
        """Draws pictures in pairs, for each of some techniques."""
        law(bench, some)

    case(f"laws.{claim}_by_any_technique", tier="nightly")(lambda bench: law(bench, names_of(bench, "techniques")))


def names_of(bench, what):
    return re.findall(r"^(\w[\w-]*)", bench.run("list", what).expect(0).out, re.M)


def lobes(bench):
    """Returns the models of --brdf that have an albedo."""
    return [line.split()[0] for line in bench.run("list", "models").expect(0).out.splitlines() if "--brdf" in line and "heidrich" not in line]


def words_of(path):
    """Returns the width and the rows of floats, from the bottom, of a .pfm."""
    data = path.read_bytes()
    width, height = map(int, data.split(b"\n")[1].split())
    values = array.array("f", data[-12 * width * height:])
    return width, [values[3 * width * y:3 * width * (y + 1)] for y in range(height)]


def picture(bench, name, *words):
    bench.run("render", *words, *SIDE, "-o", f"{name}.pfm").expect(0)
    return words_of(bench.folder / f"{name}.pfm")


def flip(bench, a, b):
    return float(next(csv.DictReader(io.StringIO(
        bench.run("compare", f"{a}.pfm", f"{b}.pfm", "--metric", "flip-hdr", "-q", "--csv", "-").expect(0).out)))["flip_mean"])


def differing(one, other):
    """Returns the number of words that differ between two images, and their largest relative difference."""
    pairs = [(a, b) for x, y in zip(one, other, strict=True) for a, b in zip(x, y, strict=True) if a != b]
    return len(pairs), max((abs(a - b) / max(abs(a), abs(b)) for a, b in pairs), default=0.0)


# Its squares and products with eta = 1/2 are exact floats: the slope deviations are 3/16 and 1/16.
EXACT = "0.4204482138156891"


def turned_grain(bench, techniques):
    """A grain along +t and -t gives equal words. So does eta along the tangent and -eta with the tangent turned a quarter clockwise,
    unless squared widths are rounded. (Counter-clockwise the lobe's axis points the other way, and samples with it.)"""
    for name, x in (("t", 255), ("minus_t", 0)):  # 128 is 0
        (bench.folder / f"{name}.png").write_bytes(png(4, 4, color=lambda *_, x=x: (x, 128, 255)))
    for name, tangent in (("x", (1.0, 0.0, 0.0)), ("y", (0.0, -1.0, 0.0))):
        corners = [(x, y, 0.0, 0.0, 0.0, 1.0, *tangent, 1.0, x, y) for y in (-1.0, 1.0) for x in (-1.0, 1.0)]
        scratch(bench, f"{name}.gltf", brushed(corners, [0, 1, 3, 0, 3, 2]))
    for name in techniques:
        drawn = lambda label, scene, *words: picture(bench, label, scene, *LIGHT, "--technique", name, *words)[1]
        along, back = (drawn("a", "builtin:plate", "--roughness", "0.4", "--rotation-map", map_, "--rotation-encoding", "vector", "--anisotropy", "0.5")
                       for map_ in ("t.png", "minus_t.png"))
        check(back == along, f"{name}: a grain along -t is drawn otherwise: {differing(along, back)}")
        for roughness, most in ((EXACT, 0.0), ("0.4", 2e-4)):
            seen = ("--eye", "0.4,-1.2,1", "--target", "0,0,0", "--roughness", roughness)
            along, across = drawn("a", "x.gltf", *seen, "--anisotropy", "0.5"), drawn("b", "y.gltf", *seen, "--anisotropy", "-0.5")
            check(len({v for row in along for v in row}) > 3000, "there is nothing to be seen")
            (differ, part), found = differing(along, across), flip(bench, "a", "b")
            print(f"{name}, roughness {roughness}: eta turned, {differ} words by {part:.2g}, FLIP {found:.6f}", flush=True)
            check(found < most or differ == 0, f"{name}: {differ} words, FLIP {found} between eta and -eta with the tangent turned")


in_two_tiers("grains_have_no_sign", turned_grain, ("auto", "major_axis_weighted"))


# HDR-FLIP to the mirror image: rounding; places within a quad's four pixels, which have separate samples; random samples.
MIRRORED = {"auto": 0.005, "lobe_line": 0.005, "mc": 0.003, "as_mc": 0.006}


def mirrored(bench, techniques):
    """Draws a sphere without lights, seen along its environment's symmetry plane, with one sample a pixel: more samples lie in no
    mirrored places. Words are not equal, since triangles' corners come in another order."""
    def value(x, y):
        away = abs(x - 31.5)
        return (0.2 + 0.02 * away, 0.3 + 0.02 * y, 2.0 if 4 < away < 9 and y < 12 else 0.1)

    (bench.folder / "even.exr").write_bytes(exr(64, 32, value))
    scratch(bench, "ball.gltf", ball(1.0))
    for name in techniques:
        width, rows = picture(bench, "a", "ball.gltf", "--env", "even.exr", *LIGHT[2:], "--eye", "3,1,0", "--target", "0,0,0", "--technique", name, "--msaa", "1",
                              *(("--samples", "4096") if name.endswith("mc") else ()))  # random numbers have no mirror image
        back = [array.array("f", (v for x in reversed(range(width)) for v in row[3 * x:3 * x + 3])) for row in rows]
        with open(bench.folder / "b.pfm", "wb") as file:
            file.write(b"PF\n%d %d\n-1.0\n" % (width, len(rows)) + b"".join(row.tobytes() for row in back))
        differ, part = differing(rows, back)
        found = flip(bench, "a", "b")
        print(f"{name}: {differ} words by {part:.2g}, FLIP {found:.6f}", flush=True)
        most = MIRRORED.get(name, 1e-4)
        check(most / 10 < found < most if name in MIRRORED else found < most, f"{name}: FLIP {found} to its own mirror image, not below {most}")


in_two_tiers("mirrors_of_scenes_are_mirrors_of_pictures", mirrored, ("auto", "bent_normal"))


@case("laws.radiance_has_no_scale", tier="nightly")
def radiance(bench):
    """Words are equal after scaling the environment."""
    for name in names_of(bench, "techniques"):
        drawn = lambda ev: picture(bench, "a", "builtin:plate", *LIGHT, "--roughness", "0.4", "--technique", name, "--env-exposure", ev)[1]
        usual = drawn("0")
        for ev in (-20, 20):
            check(all(a * 2.0**ev == b for one, other in zip(usual, drawn(str(ev))) for a, b in zip(one, other)), f"{name}: other words at 2^{ev}")


def brushed(corners, index):
    """Returns a glTF file with one brushed mesh; a corner: position, normal, tangent with sign, texture coordinates."""
    data, index = struct.pack(f"<{12 * len(corners)}f", *(v for c in corners for v in c)), struct.pack(f"<{len(index)}H", *index)
    of = lambda at, kind, **more: {"bufferView": 0, "byteOffset": at, "componentType": 5126, "count": len(corners), "type": kind, **more}
    return text({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2, "TEXCOORD_0": 3}, "indices": 4, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"roughnessFactor": 0.4}, "doubleSided": True,
                       "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.6}}}], "extensionsUsed": ["KHR_materials_anisotropy"],
        "accessors": [of(0, "VEC3", min=[min(c[k] for c in corners) for k in range(3)], max=[max(c[k] for c in corners) for k in range(3)]),
                      of(12, "VEC3"), of(24, "VEC4"), of(40, "VEC2"), {"bufferView": 1, "componentType": 5123, "count": len(index) // 2, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(data), "byteStride": 48, "target": 34962},
                        {"buffer": 1, "byteLength": len(index), "target": 34963}],
        "buffers": [{"byteLength": len(data), "uri": data_uri(data)}, {"byteLength": len(index), "uri": data_uri(index)}]})


def ball(scale):
    """Returns a sphere with this radius and with its meridians as grain."""
    corners, faces = [], []
    for j in range(13):
        for i in range(25):
            e, a = math.pi * (j / 12 - 0.5), 2 * math.pi * i / 24
            n = (math.cos(e) * math.cos(a), math.sin(e), math.cos(e) * math.sin(a))
            corners.append((*(scale * c for c in n), *n, -math.sin(a), 0.0, math.cos(a), 1.0, i / 3, j / 3))
    for j in range(12):
        for i in range(24):
            k = 25 * j + i
            faces += [k, k + 25, k + 26, k, k + 26, k + 1] if i < 12 else [k, k + 25, k + 1, k + 1, k + 25, k + 26] # mirrored about z = 0
    return brushed(corners, faces)


def scaled(bench, techniques):
    """Scales by powers of two give equal words; others differ by rounding."""
    for name in techniques:
        def drawn(label, scale, place=(0.5, 1.0, 2.5), *words):
            scratch(bench, "ball.gltf", ball(scale))
            eye = ",".join(repr(scale * c) for c in place)
            return picture(bench, label, "ball.gltf", *LIGHT, "--eye", eye, "--target", "0,0,0", "--technique", name, *words)

        usual = drawn("a", 1.0)
        check(len({v for row in usual[1] for v in row}) > 3000, "there is nothing to be seen")
        for scale in (2.0**-6, 2.0**13):
            check(drawn("b", scale) == usual, f"{name}: other words at {scale}")
        for scale in (1e-4, 1e4):
            drawn("b", scale)
            found = flip(bench, "a", "b")
            check(found < 0.002, f"{name}: FLIP {found} at {scale}")
        # from a distance of a million, where the narrowest view still sees the object well
        for label, scale in (("a", 1.0), ("b", 1e6 / 1500)):
            width, rows = drawn(label, scale, (300.0, 560.0, 1359.0), "--fov", "0.1")
        check(len({v for row in rows for v in row}) > 3000, "there is nothing to be seen from afar")
        found = flip(bench, "a", "b")
        print(f"{name}: FLIP {found:.6f} from a million away")
        check(found < 0.002, f"{name}: FLIP {found} from a million away")


in_two_tiers("scenes_have_no_scale", scaled, ("auto", "mc"))


def white_ball(bench, *words):
    """Returns the mean of an image with white metal under uniform light."""
    (bench.folder / "even.hdr").write_bytes(hdr(16, 8, lambda y: 16 * rgbe((1.0, 1.0, 1.0))))
    scratch(bench, "ball.gltf", ball(1.0))
    values = [v for row in picture(bench, "m", "ball.gltf", "--env", "even.hdr", *LIGHT[2:], "--eye", "0.5,1,2.5", "--target", "0,0,0", *words)[1]
              for v in row if v > 0]
    return sum(values) / len(values)


def monotone(bench, techniques):
    """Theory's decreases hold: a metal's single-scattering reflection as it grows rougher, and its reflection as its reflectance falls."""
    for name in techniques:
        many = ("--samples", "1024") if name.endswith("mc") else ()
        for what, of in (("roughness", (0.1, 0.3, 0.5, 0.7, 0.9, 1.0)), ("f0", ("1,1,1", ".8,.8,.8", ".5,.5,.5", ".2,.2,.2", "0,0,0"))):
            means = [white_ball(bench, "--technique", name, "--anisotropy", "0.5", *many, *(("--roughness", "0.4") if what == "f0" else ()),
                                f"--{what}", str(value)) for value in of]
            print(f"{name} by {what}: {' '.join(f'{m:.4f}' for m in means)}")
            check(all(a > b for a, b in zip(means, means[1:])), f"{name}: {what} does not make it darker: {means}")


in_two_tiers("what_theory_says_falls_does", monotone, ("auto", "bent_normal"))
