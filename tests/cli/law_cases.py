"""Laws that every technique, model and way of lights is held to: no jump along any option, mirrored and scaled scenes give mirrored and scaled
pictures. What breaks a law stands in a table here, with what it was when it was found, and is printed; one that no longer does has to leave it."""

import array
import csv
import io
import math
import re
import struct

from chart_cases import needs_embree
from environment_files import exr
from gltf_files import data_uri, png, text
from harness import case, check, scratch

LIGHT = ("--env", "builtin:studio", "--env-size", "64", "--env-samples", "64")
SIDE = ("--size", "64x64", "-q")
MORE, NOISE = 1.5, 2e-4  # a step may be so many times as large as the reference's, or as the median of its row, and so much more

# Options through their special points, in steps so small that pictures differ by little: what goes, words besides, the steps. What ends at a
# point where lobes change ever faster is judged beside the reference, which does so too; the rest by its own neighbours, for it has no noise.
PATHS = {
    "anisotropy through 0": ("anisotropy=-0.005:0.005", "builtin:sphere --roughness 0.4", 11),
    "anisotropy to 1": ("anisotropy=0.99:1", "builtin:sphere --roughness 0.4", 11),
    "anisotropy through an eighth": ("anisotropy=0.06:0.07", "builtin:sphere --roughness 0.4", 11),
    "roughness to 0": ("roughness=0.01:0", "builtin:sphere --anisotropy 0.6", 11),
    "roughness to 1": ("roughness=0.99:1", "builtin:sphere --anisotropy 0.6", 11),
    "roughness where counts change": ("roughness=0.4:0.42", "builtin:sphere --anisotropy 0.8", 21),
    "tilt through 0": ("tilt=-0.5,0:0.5,0", "builtin:sphere --roughness 0.4 --anisotropy 0.5", 11),
    "environment through a whole turn": ("env-rotation=359.5:360.5", "builtin:sphere --roughness 0.4 --anisotropy 0.5", 11),
    "sun over the horizon": ("env-rotation=170:190", "builtin:plate --env builtin:sky --roughness 0.3 --anisotropy 0.5", 21),
    "eye across a plane of symmetry": ("eye=-0.005,0.25,0.6:0.005,0.25,0.6", "builtin:sphere --target 0,0,0 --roughness 0.4 --anisotropy 0.8", 11),
    "distance": ("zoom=0.995:1.005", "builtin:sphere --roughness 0.4 --anisotropy 0.5", 11),
}
ENDS = {"anisotropy to 1", "roughness to 0", "roughness to 0 by lamps", "axis-beta to 0"}
# Of some techniques alone.
OWN_PATHS = {
    "axis-k": ("axis-k=0.995:1.005", "builtin:sphere --roughness 0.4 --anisotropy 0.8", 11, "major_axis"),
    "axis-beta": ("axis-beta=2.2:2.4", "builtin:sphere --roughness 0.4 --anisotropy 0.8", 11, "major_axis"),
    "axis-beta to 0": ("axis-beta=0.01:0", "builtin:sphere --roughness 0.4 --anisotropy 0.8", 11, "major_axis"),
}
# Of every model that --brdf takes, by mc.
MODEL_PATHS = ("anisotropy through 0", "roughness to 0", "roughness to 1", "tilt through 0")
# Of every way of area lights.
AREA_PATHS = {
    "anisotropy through 0 by lamps": ("anisotropy=-0.005:0.005", "builtin:lights --roughness 0.4", 11),
    "roughness to 0 by lamps": ("roughness=0.01:0", "builtin:lights --anisotropy 0.6", 11),
    "eye around lamps": ("eye=0,1.2,2.4:0.02,1.2,2.4", "builtin:lights --target 0,0.2,0 --roughness 0.4 --anisotropy 0.6", 11),
}
SHORT = (("lobe_line", "anisotropy through 0"), ("bent_normal", "anisotropy through 0"), ("auto", "anisotropy through an eighth"),
         ("major_axis_adaptive", "roughness where counts change"), ("split_isotropic", "environment through a whole turn"),
         ("filtered_is_ggx", "tilt through 0"))

# A breach may be so many times as far, or as little, and what is none so far beyond what is allowed: pictures are the same bits everywhere, the
# reference's noise of 128 samples is another on each machine.
SPREAD = {False: 1.05, True: 1.5}

# (technique, model or way; path): the largest step over what is allowed, as it was found. Where eta changes its sign the lobe's axes swap, and with
# them the pattern of samples: noise, which more samples lessen, and the ends of lines. split_isotropic leaves the usual lobe of lights and the
# albedo of untilted ones in a step of a thousandth. An eta of 1 makes lobes thin faster than the reference's own noise follows.
BREACHES = {
    ("auto", "anisotropy to 1"): 1.50,
    ("split_isotropic", "anisotropy through 0"): 5.07,
    ("split_isotropic", "tilt through 0"): 3.75,
    ("bent_normal", "anisotropy to 1"): 1.37,
    ("bent_normal", "roughness to 0"): 1.36,
    ("major_axis", "anisotropy through 0"): 1.29,
    ("major_axis_adaptive", "anisotropy through 0"): 1.02,
    ("lobe_line", "anisotropy through 0"): 2.46,
    ("lobe_line", "anisotropy to 1"): 1.50,
    ("filtered_is_ggx", "anisotropy through 0"): 13.62,
    ("filtered_is_ggx", "anisotropy to 1"): 1.16,
    ("mc", "anisotropy through 0"): 12.92,
    ("as_mc", "anisotropy through 0"): 12.95,
    ("ggx", "anisotropy through 0"): 289.32,
    ("ggx_aniso", "anisotropy through 0"): 12.92,
    ("ggx_aniso_separable", "anisotropy through 0"): 12.94,
    ("beckmann", "anisotropy through 0"): 13.20,
    ("ashikhmin_shirley", "anisotropy through 0"): 10.99,
    ("ward", "anisotropy through 0"): 10.21,
    ("ward_cheap", "anisotropy through 0"): 10.54,
    ("ellipsoid_correlated", "anisotropy through 0"): 12.92,
}


def in_two_tiers(claim, law, some):
    """law(bench, techniques): of some techniques in the gate, of all in slow."""
    case(f"laws.{claim}", tier="gate")(lambda bench: law(bench, some))
    case(f"laws.{claim}_by_any_technique", tier="slow")(lambda bench: law(bench, names_of(bench, "techniques")))


def names_of(bench, what):
    return re.findall(r"^(\w[\w-]*)", bench.run("list", what).expect(0).out, re.M)


def lobes(bench):
    """Models that --brdf takes and that have an albedo."""
    return [line.split()[0] for line in bench.run("list", "models").expect(0).out.splitlines() if "--brdf" in line and "heidrich" not in line]


def moved(bench, path, words, name):
    """A row of pictures NAME%02d.pfm."""
    along, own, steps = path
    scene, *own = own.split()
    bench.run("render", scene, *LIGHT, *own, *words, *SIDE, "--animate", along, "--steps", str(steps), "-o", f"{name}%02d.pfm").expect(0)
    for left in range(steps, 100): # of a longer row
        (bench.folder / f"{name}{left:02d}.pfm").unlink(missing_ok=True)


def excess(bench, path, words, ends):
    """The largest step of a row of pictures, over what is allowed: above 1 is a jump. Truths are kept by their words."""
    truth = "s"
    if ends:
        lobe = tuple(words[words.index("--brdf"):][:2]) if "--brdf" in words else ()
        truth = re.sub(r"\W+", "_", " ".join((*path[:2], *lobe)))
        if not (bench.folder / f"{truth}00.pfm").exists():
            moved(bench, path, (*lobe, "--backend", "reference", "--samples", "128"), truth)
    moved(bench, path, words, "s")
    rows = list(csv.DictReader(io.StringIO(bench.run("compare", "--sequence", f"{truth}%02d.pfm", "s%02d.pfm", "-q", "--csv", "-").expect(0).out)))[1:]
    steps, truths = ([float(row[key]) for row in rows] for key in ("change", "reference_change"))
    usual = sorted(steps)[len(steps) // 2]
    return max(step / (MORE * max(usual, truths[i] if ends else 0.0) + NOISE) for i, step in enumerate(steps))


def held(bench, asked):
    """asked: {(name, path's name): (path, words)}."""
    if any(path in ENDS for _, path in asked):
        needs_embree(bench)
    broken = []
    for key, (path, words) in asked.items():
        noisy = key[1] in ENDS
        found, known = excess(bench, path, words, noisy), BREACHES.get(key)
        least, most = (known / SPREAD[noisy], known * SPREAD[noisy]) if known else (0.0, SPREAD[noisy])
        if found > 1.0 or known:
            print(f"{key}: {found:.2f} times what is allowed" + (f", as is known ({least:.2f} to {most:.2f})" if known else ""))
        if not least <= found <= most:
            broken.append(f"{key}: {found:.2f}, not {least:.2f} to {most:.2f}")
    check(not broken, "; ".join(broken))


def by_technique(bench, some=None):
    asked = {}
    for name in names_of(bench, "techniques"):
        for path, what in PATHS.items():
            asked[name, path] = what, ("--technique", name)
        for path, (*what, reader) in OWN_PATHS.items():
            if name.startswith(reader):
                asked[name, path] = tuple(what), ("--technique", name)
    return {key: asked[key] for key in some} if some else asked


@case("laws.no_technique_jumps_in_some_places", tier="gate")
def some_jumps(bench):
    held(bench, by_technique(bench, SHORT))


@case("laws.no_technique_jumps_anywhere", tier="slow")
def technique_jumps(bench):
    held(bench, by_technique(bench))


@case("laws.no_model_jumps_anywhere", tier="slow")
def model_jumps(bench):
    tilts = {"ggx_aniso", "ellipsoid", "ellipsoid_correlated"}
    held(bench, {(name, path): (PATHS[path], ("--technique", "mc", "--brdf", name)) for name in lobes(bench) for path in MODEL_PATHS
                 if name in tilts or not path.startswith("tilt")})


@case("laws.no_way_of_area_lights_jumps_anywhere", tier="slow")
def area_jumps(bench):
    held(bench, {(name, path): (what, ("--area-lights", name)) for name in names_of(bench, "area-lights") if name != "off"
                 for path, what in AREA_PATHS.items()})


def words_of(path):
    """Width, rows of floats from the bottom, of a .pfm."""
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


def turned_grain(bench, techniques):
    """A grain along +t and -t is the same; eta along the tangent is -eta along the bitangent. Where samples are random they lie otherwise."""
    for name, x, y in (("t", 255, 128), ("minus_t", 0, 128), ("b", 128, 255)): # 128 is 0
        (bench.folder / f"{name}.png").write_bytes(png(4, 4, color=lambda *_, x=x, y=y: (x, y, 255)))
    drawn = lambda technique, map_, eta: picture(bench, f"{map_}", "builtin:plate", *LIGHT, "--roughness", "0.4", "--technique", technique,
                                                 "--rotation-map", f"{map_}.png", "--rotation-encoding", "vector", "--anisotropy", eta)
    for name in techniques:
        along = drawn(name, "t", "0.5")
        back = drawn(name, "minus_t", "0.5")
        differ = sum(a != b for one, other in zip(along[1], back[1]) for a, b in zip(one, other))
        found = flip(bench, "t", "minus_t")
        print(f"{name}: -t, {differ} words, FLIP {found:.6f}")
        check(differ == 0, f"{name}: a grain along -t is drawn otherwise: {differ} words, FLIP {found}")
        drawn(name, "b", "-0.5")
        found = flip(bench, "t", "b")
        print(f"{name}: eta turned, FLIP {found:.6f}")
        check(found < 1e-3, f"{name}: FLIP {found} between eta and -eta with the grain turned")


in_two_tiers("grains_have_no_sign", turned_grain, ("auto", "major_axis_weighted"))


def mirrored(bench, techniques):
    """A sphere without lights, seen along the plane that its environment is symmetric about."""
    def value(x, y):
        away = abs(x - 31.5)
        return (0.2 + 0.02 * away, 0.3 + 0.02 * y, 2.0 if 4 < away < 9 and y < 12 else 0.1)

    (bench.folder / "even.exr").write_bytes(exr(64, 32, value))
    scratch(bench, "ball.gltf", ball(1.0))
    for name in techniques:
        width, rows = picture(bench, "a", "ball.gltf", "--env", "even.exr", *LIGHT[2:], "--eye", "3,1,0", "--target", "0,0,0", "--technique", name,
                              *(("--samples", "4096") if name.endswith("mc") else ()))  # random numbers have no mirror image
        back = [array.array("f", (v for x in reversed(range(width)) for v in row[3 * x:3 * x + 3])) for row in rows]
        with open(bench.folder / "b.pfm", "wb") as file:
            file.write(b"PF\n%d %d\n-1.0\n" % (width, len(rows)) + b"".join(row.tobytes() for row in back))
        differ = sum(a != b for one, other in zip(rows, back) for a, b in zip(one, other))
        found = flip(bench, "a", "b")
        print(f"{name}: {differ} words, FLIP {found:.5f}")
        check(found < 0.01, f"{name}: FLIP {found} to its own mirror image")


in_two_tiers("mirrors_of_scenes_are_mirrors_of_pictures", mirrored, ("auto", "bent_normal"))


@case("laws.radiance_has_no_scale", tier="gate")
def radiance(bench):
    """Equal words, scaled by what the environment is."""
    for name in names_of(bench, "techniques"):
        drawn = lambda ev: picture(bench, "a", "builtin:plate", *LIGHT, "--roughness", "0.4", "--technique", name, "--env-exposure", ev)[1]
        usual = drawn("0")
        for ev in (-20, 20):
            check(all(a * 2.0**ev == b for one, other in zip(usual, drawn(str(ev))) for a, b in zip(one, other)), f"{name}: other words at 2^{ev}")


def ball(scale):
    """A sphere with its meridians as grain, of that radius."""
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
    data = struct.pack(f"<{12 * len(corners)}f", *(v for c in corners for v in c))
    index = struct.pack(f"<{len(faces)}H", *faces)
    of = lambda at, kind, **more: {"bufferView": 0, "byteOffset": at, "componentType": 5126, "count": len(corners), "type": kind, **more}
    return text({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2, "TEXCOORD_0": 3}, "indices": 4, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"roughnessFactor": 0.4}, "doubleSided": True,
                       "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.6}}}], "extensionsUsed": ["KHR_materials_anisotropy"],
        "accessors": [of(0, "VEC3", min=[min(c[k] for c in corners) for k in range(3)], max=[max(c[k] for c in corners) for k in range(3)]),
                      of(12, "VEC3"), of(24, "VEC4"), of(40, "VEC2"), {"bufferView": 1, "componentType": 5123, "count": len(faces), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(data), "byteStride": 48, "target": 34962},
                        {"buffer": 1, "byteLength": len(index), "target": 34963}],
        "buffers": [{"byteLength": len(data), "uri": data_uri(data)}, {"byteLength": len(index), "uri": data_uri(index)}]})


def scaled(bench, techniques):
    """By powers of two equal words; by others but for rounding."""
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
        # from as far as the narrowest view sees it well, a million away
        for label, scale in (("a", 1.0), ("b", 1e6 / 1500)):
            width, rows = drawn(label, scale, (300.0, 560.0, 1359.0), "--fov", "0.1")
        check(len({v for row in rows for v in row}) > 3000, "there is nothing to be seen from afar")
        found = flip(bench, "a", "b")
        print(f"{name}: FLIP {found:.6f} from a million away")
        check(found < 0.002, f"{name}: FLIP {found} from a million away")


in_two_tiers("scenes_have_no_scale", scaled, ("auto", "mc"))


# Of a lamp's last points each goes under by itself.
SINKING = {("mc", "leaves"): 3.44}


@case("laws.lamps_go_through_the_horizon_without_a_jump", tier="gate")
def sinking_lamps(bench):
    """By every way of area lights, in steps of a two-hundredth of the lamp's height: while it touches the plate's plane, and as the last of it goes under."""
    for way in names_of(bench, "area-lights"):
        if way == "off":
            continue
        for name, first in (("touches", 0.105), ("leaves", -0.095)): # its lower and its upper edge at 0
            for i in range(11):
                picture(bench, f"s{i:02d}", f"builtin:sinking-lamp={first - 0.001 * i:.3f}", "--env", "builtin:night", *LIGHT[2:], "--area-lights", way,
                        "--eye", "0,-0.3,0.4", "--target", "0,0,0", "--fov", "20", *(("--light-samples", "256") if way == "mc" else ()))  # without the lamp itself
            rows = list(csv.DictReader(io.StringIO(bench.run("compare", "--sequence", "s%02d.pfm", "s%02d.pfm", "-q", "--csv", "-").expect(0).out)))[1:]
            steps = [float(row["change"]) for row in rows]
            found = max(steps) / (MORE * sorted(steps)[len(steps) // 2] + NOISE)
            print(f"{way} {name}: steps {min(steps):.5f} to {max(steps):.5f}, {found:.2f} times what is allowed")
            known = SINKING.get((way, name))
            check(found <= 1 if not known else known / SPREAD[False] <= found <= known * SPREAD[False],
                  f"{way}: a step of {max(steps)}, {found:.2f} times what is allowed, where the lamp {name}")


def white_ball(bench, *words):
    """Mean of a picture of white metal under an even light."""
    (bench.folder / "even.exr").write_bytes(exr(16, 8, lambda *_: (1.0, 1.0, 1.0)))
    scratch(bench, "ball.gltf", ball(1.0))
    values = [v for row in picture(bench, "m", "ball.gltf", "--env", "even.exr", *LIGHT[2:], "--eye", "0.5,1,2.5", "--target", "0,0,0", *words)[1]
              for v in row if v > 0]
    return sum(values) / len(values)


def monotone(bench, techniques):
    """What theory says falls, falls: what metal gives back of light that it reflects once, as it grows rougher; and what it gives back as it
    reflects less."""
    for name in techniques:
        many = ("--samples", "1024") if name.endswith("mc") else ()
        for what, of in (("roughness", (0.1, 0.3, 0.5, 0.7, 0.9, 1.0)), ("f0", ("1,1,1", ".8,.8,.8", ".5,.5,.5", ".2,.2,.2", "0,0,0"))):
            means = [white_ball(bench, "--technique", name, "--anisotropy", "0.5", *many, *(("--roughness", "0.4") if what == "f0" else ()),
                                f"--{what}", str(value)) for value in of]
            print(f"{name} by {what}: {' '.join(f'{m:.4f}' for m in means)}")
            check(all(a > b for a, b in zip(means, means[1:])), f"{name}: {what} does not make it darker: {means}")


in_two_tiers("what_theory_says_falls_does", monotone, ("auto", "bent_normal"))
