"""Files of `burnish bake mip`: whole pyramids, with base colours, metalness and heights."""

import random
import re
import struct

import gltf_files as files
from compare_cases import png
from detail_cases import bare, bumps, hash_of
from environment_files import small_sky
from harness import case, check
from input_cases import scratch
from mip_cases import SMALL
from parity_cases import check_equal, parity

PARTS = ("base colours", "metalness", "heights")
MASK = 2**64 - 1


def xxh64(data, seed):
    """xxHash64 as specified."""
    p1, p2, p3, p4, p5 = 0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5

    def turned(x, by):
        return (x << by | x >> (64 - by)) & MASK

    def mixed(sum_, lane):
        return turned((sum_ + lane * p2) & MASK, 31) * p1 & MASK

    at = 0
    if len(data) >= 32:
        sums = [(seed + p1 + p2) & MASK, (seed + p2) & MASK, seed, (seed - p1) & MASK]
        while at + 32 <= len(data):
            sums = [mixed(*pair) for pair in zip(sums, struct.unpack_from("<4Q", data, at))]
            at += 32
        found = sum(turned(s, by) for s, by in zip(sums, (1, 7, 12, 18))) & MASK
        for s in sums:
            found = ((found ^ mixed(0, s)) * p1 + p4) & MASK
    else:
        found = (seed + p5) & MASK
    found = (found + len(data)) & MASK
    while at + 8 <= len(data):
        found = (turned(found ^ mixed(0, struct.unpack_from("<Q", data, at)[0]), 27) * p1 + p4) & MASK
        at += 8
    if at + 4 <= len(data):
        found = (turned(found ^ struct.unpack_from("<I", data, at)[0] * p1 & MASK, 23) * p2 + p3) & MASK
        at += 4
    for byte in data[at:]:
        found = turned(found ^ byte * p5 & MASK, 11) * p1 & MASK
    found = (found ^ found >> 33) * p2 & MASK
    found = (found ^ found >> 29) * p3 & MASK
    return found ^ found >> 32


def sealed(body):
    found = 0
    for at in range(0, len(body), 1 << 20):
        found = xxh64(body[at:at + (1 << 20)], found)
    return body + struct.pack("<Q", found)


def maps_of(file):
    """Returns {part: (kernel, hash of normals, where its halves begin, where they end)}, in the layout of pyramid_file.h."""
    version, materials, count, zero = struct.unpack_from("<4I", file, 8)
    check((file[:8], version, zero) == (b"bnmip01\n", 4, 0), f"{file[:24]}")
    at, found = 24, {}

    def texels(width, height, levels):
        return sum(max(1, width >> level) * max(1, height >> level) for level in range(1, levels + 1))

    for _ in range(materials):
        width, height, levels = struct.unpack_from("<3I", file, at + 20)
        at += 56 + 4 * levels + 20 * texels(width, height, levels)
    for _ in range(count):
        part, kernel, _, normals, width, height, channels, levels = struct.unpack_from("<2I2Q4I", file, at)
        end = at + 40 + 2 * channels * texels(width, height, levels)
        found[PARTS[part]] = (kernel, normals, at + 40, end)
        at = end
    check(at + 8 == len(file), f"{at} of {len(file)} bytes")
    return found


def whole(bench, name, **other):
    """Writes a folder with all maps; `other` replaces the given ones."""
    folder = bench.folder / name
    folder.mkdir()

    def put(part, width, height, texel, channels=1):
        (folder / f"x_{part}.png").write_bytes(png(width, height, other.get(part, texel), channels=channels))

    put("normal", 33, 17, bumps, 3)
    put("roughness", 16, 16, lambda x, y: (40 + 12 * x,))
    put("basecolor", 32, 32, lambda x, y: (250, 120, 40) if x % 8 < 4 else (40, 120 + 4 * y, 250), 3)
    put("metallic", 16, 16, lambda x, y: (255 * ((x ^ y) & 1),))
    put("height", 16, 16, lambda x, y: (10 * x + 5 * y,))
    return name


LOOKS = ((), ("--couple", "albedo"), ("--color-kernel", "kaiser"), ("--couple", "albedo", "--color-kernel", "kaiser"))


@case("mip.files_hold_whole_pyramids", "input", tier="nightly")
def files_hold(bench):
    whole(bench, "set")
    seen = ("builtin:sphere", *SMALL, "--material", "set")
    hashes = []
    for i, look in enumerate(LOOKS):
        name = f"{i}.mip"
        bench.run("bake", "mip", "set", *look, "-q", "-o", name).expect(0)
        bench.run("bake", "mip", "set", *look, "--threads", "3", "-q", "-o", "3.threads", env={"BN_FORCE_ISA": "scalar"}).expect(0)
        good = (bench.folder / name).read_bytes()
        check((bench.folder / "3.threads").read_bytes() == good == sealed(good[:-8]), "threads or lanes change the bytes")
        maps = maps_of(good)
        check(set(maps) == set(PARTS), f"{maps}")
        check([maps[part][0] for part in PARTS] == [int("kaiser" in look)] * 2 + [0], f"{look}: {maps}")
        check([maps[part][1] != 0 for part in PARTS] == ["albedo" in look] * 2 + [False], f"{look}: {maps}")
        for more in ((), ("--anisotropy", "0.5")):
            made = hash_of(bench, *seen, "--mip-filter", "kappa", *look, *more)
            check(hash_of(bench, *seen, "--mip-filter", "kappa", *look, *more, "--mip-pyramid", name) == made, f"{look} {more}: other pixels")
            check(hash_of(bench, *seen, *more, "--mip-pyramid", name) == made, f"{look} {more}: a file does not say how colours are averaged")
        hashes.append(hash_of(bench, *seen, "--mip-pyramid", name))
        for part, (*_, begin, end) in maps.items():  # drawing uses the file's contents
            scratch(bench, "spoilt.mip", sealed(good[:begin] + struct.pack("<H", 0x3400) * ((end - begin) // 2) + good[end:-8]))
            check(hash_of(bench, *seen, "--mip-pyramid", "spoilt.mip") != hashes[-1], f"{look}: {part} are not looked at")
    check(len(set(hashes)) == len(LOOKS), f"{hashes}")
    for look, name in ((LOOKS[1], "0.mip"), (LOOKS[0], "1.mip"), (LOOKS[2], "0.mip"), (LOOKS[2], "3.mip")):
        bench.run("render", *seen, "--mip-filter", "kappa", *look, "--mip-pyramid", name, "-o", "x.pfm").expect(4).expect_one_line("base colours")
    done = bench.run("render", *seen, "--couple", "albedo", "--color-kernel", "kaiser", "--mip-pyramid", "0.mip", "-o", "a.pfm").expect(0)
    check(all(f"{option} has no effect with --mip-pyramid" in done.err for option in ("--couple", "--color-kernel")), done.describe())
    # other maps, an older file, and invalid numbers
    for name, part, texel in (("basecolor", "base colours", lambda x, y: (250, 120, 41)), ("metallic", "metalness", lambda x, y: (3,)),
                              ("height", "heights", lambda x, y: (3 * x,)), ("normal", "hash", lambda x, y: bumps(x + 1, y))):
        whole(bench, name, **{name: texel})
        bench.run("render", "builtin:sphere", *SMALL, "--material", name, "--mip-pyramid", "3.mip", "-o", "x.pfm").expect(4).expect_one_line(part)
    good = (bench.folder / "0.mip").read_bytes()
    begin = maps_of(good)["metalness"][2]
    for needle, at, data in (("version 3, not 4", 8, b"\3"), ("number that is none", begin, b"\0\x7c"), ("map that is none", begin - 40, b"\3"),
                             ("channels", begin - 8, b"\2"), ("levels of", begin - 16, b"\0"), ("is cut off", 16, b"\4"), ("bytes too many", 16, b"\2")):
        scratch(bench, "bad.mip", sealed(good[:at] + data + good[at + len(data):-8]))
        bench.run("render", *seen, "--mip-pyramid", "bad.mip", "-o", "x.pfm").expect(4).expect_one_line(needle)
    # files with the hash of these maps, but other sides or channels
    at, material = 24, struct.pack("<3I", 1, 1, 0)
    width, height, levels = struct.unpack_from("<3I", good, at + 20)
    end = at + 56 + 4 * levels + 20 * sum(max(1, width >> k) * max(1, height >> k) for k in range(1, levels + 1))
    scratch(bench, "bad.mip", sealed(good[:at + 20] + material + good[at + 32:at + 56] + good[end:-8]))
    bench.run("render", *seen, "--mip-pyramid", "bad.mip", "-o", "x.pfm").expect(4).expect_one_line("no levels of material")
    maps = maps_of(good)
    for part, (_, _, begin, end) in maps.items():
        small = good[:begin - 16] + struct.pack("<4I", 1, 1, struct.unpack_from("<I", good, begin - 8)[0], 0) + good[end:-8]
        scratch(bench, "bad.mip", sealed(small))
        bench.run("render", *seen, "--mip-pyramid", "bad.mip", "-o", "x.pfm").expect(4).expect_one_line(f"no levels of the {part}")
    check("x.pfm" not in bench.left_behind(), "what failed has left something")


@case("mip.numbers_of_files_lie_in_their_ranges", "input")
def ranges(bench):
    """With a right hash: kappa, gains, lobes and texels outside the range of any bake."""
    whole(bench, "set")
    seen = ("builtin:sphere", *SMALL, "--material", "set")
    for name, filter_ in (("kappa.mip", "kappa"), ("leadr.mip", "leadr")):
        bench.run("bake", "mip", "set", "--mip-filter", filter_, "-q", "-o", name).expect(0)
    good, other = ((bench.folder / name).read_bytes() for name in ("kappa.mip", "leadr.mip"))
    nan, texel = float("nan"), 24 + 56 + 4 * struct.unpack_from("<3I", good, 24 + 20)[2]
    base, metal = (maps_of(good)[part][2] for part in ("base colours", "metalness"))
    floats = lambda *x: struct.pack(f"<{len(x)}f", *x)
    wrong = [("kappa", good, 24 + 16, floats(k)) for k in (-1.0, -1e-30, 4.001, 1e38, float("inf"), nan)]
    wrong += [("kappa", other, 24 + 16, floats(1.0)), ("gain", good, 24 + 56, floats(1.5)), ("gain", good, 24 + 48, b"\7")]
    wrong += [("no lobe", good, texel, floats(*lobe)) for lobe in ((2, 0, .1, .1, 0), (0, 0, -.1, .1, 0), (0, 0, .1, 1e9, 0), (0, 0, .1, .1, .2), (nan, 0, .1, .1, 0))]
    wrong += [("base colours", good, base, struct.pack("<H", half)) for half in (0x3c01, 0xb800, 0x7bff)] + [("metalness", good, metal, b"\1\x3c")]
    for needle, file, at, data in wrong:
        scratch(bench, "bad.mip", sealed(file[:at] + data + file[at + len(data):-8]))
        bench.run("render", *seen, "--mip-pyramid", "bad.mip", "-o", "x.pfm").expect(4).expect_one_line(needle)
    for kappa in (0.0, 4.0):
        scratch(bench, "good.mip", sealed(good[:24 + 16] + floats(kappa) + good[24 + 20:-8]))
        bench.run("render", *seen, "--mip-pyramid", "good.mip", "-o", "x.pfm").expect(0)


@case("mip.files_of_a_full_disk_have_no_name", "input")
def full_disk(bench):
    whole(bench, "set")
    words = ("bake", "mip", "set", "-q", "-o")
    bench.run(*words, "whole.mip").expect(0)
    size = (bench.folder / "whole.mip").stat().st_size
    for most in (0, 100, size // 2, size - 1):
        full = bench.run(*words, "full.mip", file_size=most).expect(7).expect_one_line("full.mip")
        check(not [name for name in bench.left_behind() if "full" in name], full.describe())
        bench.run("bake", "mip", "set", "--mip-kappa", "2", "-q", "-o", "whole.mip", file_size=most).expect(7)
    bench.run(*words, "again.mip", file_size=size).expect(0)
    check((bench.folder / "whole.mip").read_bytes() == (bench.folder / "again.mip").read_bytes(), "what was there is not as it was")


@case("mip.colours_that_take_long_are_kept_by_content")
def kept(bench):
    whole(bench, "set"), whole(bench, "other", basecolor=lambda x, y: (250, 4 * x, 40))
    cache = bench.folder / "cache"
    lit = ("--size", "64x48", "--msaa", "1", "--samples", "4", "--technique", "mc", *small_sky(bench))

    def drawn(folder, *words):
        found = bench.figures("builtin:sphere", *lit, "--material", folder, *words, env={"XDG_CACHE_HOME": str(cache)})
        return found["pixel_hash"], {path: path.read_bytes() for path in (cache / "burnish").glob("levels-*.mip")}

    check(not drawn("set")[1], "plain means are kept")
    for look in LOOKS[1:]:
        plain, before = drawn("set", *look, "--no-cache")
        first, there = drawn("set", *look)
        check(first == plain == drawn("set", *look)[0] and len(there) == len(before) + 2, f"{look}: {sorted(there)}")
        for name in set(there) - set(before):
            part, = maps_of(there[name])
            *_, begin, end = maps_of(there[name])[part]
            name.write_bytes(sealed(there[name][:begin] + struct.pack("<H", 0x3400) * ((end - begin) // 2) + there[name][end:-8]))
            check(drawn("set", *look)[0] != first, f"{look}: {part} of the cache are not looked at")
            name.write_bytes(there[name][:-9])  # damaged files are replaced
            check(drawn("set", *look) == (first, there), f"{look}: a damaged file stays")
    other, more = drawn("other", *look)
    check(other != first and len(more) == len(there) + 1, "another map of base colours")
    name, swapped = sorted(more)[:2]  # a file with other contents under this name
    data = more[name], more[swapped]
    name.write_bytes(data[1]), swapped.write_bytes(data[0])
    for folder, found in (("set", first), ("other", other)):
        check(drawn(folder, *look)[0] == found, "levels of other maps are taken")


@case("mip.bakes_write_over_nothing_that_they_read", "input")
def inputs(bench):
    whole(bench, "set")
    gltf = bare(normalTexture={"index": 0})
    gltf["materials"][0]["name"] = "odd"
    gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "odd_normal_01.png"}]
    scratch(bench, "odd.gltf", files.text(gltf))
    scratch(bench, "odd_normal_01.png", png(16, 16, bumps))
    before = {path: path.read_bytes() for path in bench.folder.rglob("*") if path.is_file()}
    for words in (("odd.gltf", "-o", "a.mip", "--preview", "."), ("odd.gltf", "-o", "odd_normal_01.png"), ("odd.gltf", "-o", "odd.gltf"),
                  ("odd.gltf", "--format", "png-levels", "-o", "."), ("set", "-o", "set/x_normal.png"), ("set", "-o", "set/x_height.png")):
        bench.run("bake", "mip", *words, "-q").expect(2).expect_one_line("odd_normal_01.png" if words[-1] == "." else words[-1])
    check({path: path.read_bytes() for path in bench.folder.rglob("*") if path.is_file()} == before, f"{bench.left_behind()}")
    bench.run("bake", "mip", "odd.gltf", "-q", "-o", "a.mip", "--preview", "seen").expect(0)
    check((bench.folder / "seen/odd_normal_01.png").exists(), "no preview")


@case("mip.maps_of_one_texel_have_no_levels")
def one_texel(bench):
    (bench.folder / "set").mkdir()
    for part, texel, channels in (("normal", (140, 120, 250), 3), ("roughness", (90,), 1), ("basecolor", (200, 100, 50), 3), ("height", (9,), 1)):
        (bench.folder / f"set/x_{part}.png").write_bytes(png(1, 1, lambda x, y: texel, channels=channels))
    for name in ("kappa", "mipnet", "teacher"):
        bench.run("bake", "mip", "set", "--mip-filter", name, "--couple", "albedo", "-q", "-o", "a.mip").expect(0)
        check(all(begin == end for *_, begin, end in maps_of((bench.folder / "a.mip").read_bytes()).values()), "there are levels")
        seen = ("builtin:sphere", *SMALL, "--material", "set")
        check(hash_of(bench, *seen, "--mip-filter", name, "--couple", "albedo") == hash_of(bench, *seen, "--mip-pyramid", "a.mip"), name)


def flipped(bench, name, words, flips, codes):
    """Flips one bit of the file after another. Each gives an image, or one line and a code."""
    chance, good = random.Random(17), (bench.folder / name).read_bytes()
    for _ in range(flips):
        at, bit = chance.randrange(len(good)), chance.randrange(8)
        scratch(bench, "flip" + name, good[:at] + bytes([good[at] ^ 1 << bit]) + good[at + 1:])
        done = bench.run(*words, timeout=60.0)
        check(done.code in codes, f"byte {at}, bit {bit}: {done.describe()}")
        if done.code not in (0, 6):
            done.expect_one_line()


@case("mip.flipped_bits_are_refused_or_read", tier="nightly")
def flips(bench):
    """Flips 200 bits of a pyramid file, 50 of an image in each format. In files without a hash a flip may go unnoticed."""
    bench.run("bake", "mip", "builtin:roofs=1", "-q", "-o", "p.mip").expect(0)
    render = ("render", "builtin:roofs=1", *SMALL, "-q", "-o", "x.pfm")
    flipped(bench, "p.mip", (*render, "--mip-pyramid", "flipp.mip"), 200, (4,))
    for form, name in (("png-levels", "n.png"), ("exr-mip", "n.exr")):
        bench.run("bake", "mip", "builtin:roofs=1", "--format", form, "-q", "-o", form).expect(0)
        source = sorted((bench.folder / form).glob("*_normal*"))[0]
        (bench.folder / name).write_bytes(source.read_bytes())
        flipped(bench, name, ("compare", name, "flip" + name, "--metric", "mse", "-q"), 200, (0, 1, 3, 4, 6))


@case("mip.names_of_files_may_be_any")
def hostile_names(bench):
    """Names of folders and materials, in the formats that name files after them, and in another locale."""
    gltf = bare(normalTexture={"index": 0})
    gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "n.png"}]
    scratch(bench, "n.png", png(16, 16, bumps))
    for i, name in enumerate(("../../up", "a/b", "", ".", "..", "\n\x1b[31m", "-o", "\u00e9\u4e16", "con", "x" * 400, "%s%n", ".hidden")):
        gltf["materials"][0]["name"] = name
        scratch(bench, "odd.gltf", files.text(gltf))
        bench.run("bake", "mip", "odd.gltf", "--format", "png-levels", "-q", "-o", f"made{i}").expect(0)
        made = sorted(path.name for path in (bench.folder / f"made{i}").iterdir())
        check(made and all(re.search(r"_(normal|roughness|color|anisotropy)_\d\d\.png$", n) for n in made), f"{name!r}: {made}")
    check(not list(bench.folder.parent.glob("up*")) and not (bench.folder / "a").exists(), "files outside the folder")
    first = {path.name: path.read_bytes() for path in (bench.folder / "made1").iterdir()}
    gltf["materials"][0]["name"] = "a/b"
    scratch(bench, "odd.gltf", files.text(gltf))
    for name in ("-dash", "sp ace", "new\nline", "\u00e9", "\udcff", "made;ls", "d,e"):
        env = {"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}
        bench.run("bake", "mip", "odd.gltf", "--format", "png-levels", "-q", "-o", f"./{name}", env=env).expect(0)
        check({path.name: path.read_bytes() for path in (bench.folder / name).iterdir()} == first, f"{name!r}: other files")


@case("mip.files_give_the_same_words_on_devices", tier="nightly")
def devices(bench):
    bench.run("bake", "mip", "builtin:shaderballs", "--couple", "albedo", "--color-kernel", "kaiser", "--mip-gain", "on", "-q", "-o", "balls.mip").expect(0)
    check_equal(parity(bench, "builtin:shaderballs", "--size", "48x36", "--msaa", "1", "--technique", "auto", "--mip-pyramid", "balls.mip"))
