"""burnish plot: figures of lobes."""

import math
import re
import xml.etree.ElementTree

from harness import case, check
from manual_page_cases import check_options
from progress_cases import check_told


def discs(bench, *words):
    """Returns {family: [(x, y)]} of the dots of `plot axis`."""
    bench.run("plot", "axis", *words, "-o", "a.svg").expect(0)
    text = (bench.folder / "a.svg").read_text()
    xml.etree.ElementTree.fromstring(text)
    found = {}
    for family, circle in re.findall(r'<g class="best (c\d)"[^>]*>\s*<circle ([^>]*)', text):
        found.setdefault(family, []).append(tuple(float(re.search(rf'\b{name}="([-\d.]+)"', circle)[1]) for name in ("cx", "cy")))
    return found


# A panel is 300 px wide and shows slopes to 1.5 times k deviations. The centre of the first panel is at (174, 190).
@case("plot.seen_along_the_normal_everything_is_symmetric")
def symmetric(bench):
    found = discs(bench, "--eye", "0,0", "--samples", "5")
    far = sorted(p for p in found["c4"] if p[0] < 324 and p[1] < 340)
    check([(round(x, 1), round(y, 1)) for x, y in far] == [(74, 190), (274, 190)], f"the farthest points are {far}")
    samples = sorted(x for x, y in found["c2"] if x < 324 and y < 340)
    check(len(samples) == 5 and abs(samples[2] - 174) < 0.1 and abs(samples[0] + samples[4] - 348) < 0.1, f"the samples are at {samples}")
    turned = discs(bench, "--eye", "0,0", "--samples", "5", "--anisotropy", "-0.8")
    check(turned == found, "an ellipse that is turned is drawn along its own axes")


@case("plot.at_grazing_views_the_axis_ends_at_the_horizon")
def clamped(bench):
    found = discs(bench, "--eye", "75,0", "--roughness", "0.7", "--samples", "9")
    far = sorted(x for x, y in found["c4"] if x < 324 and y < 340)
    samples = sorted(x for x, y in found["c2"] if x < 324 and y < 340)
    check(len(far) == 2 and min(samples) > far[0] + 20 and max(samples) < far[1] + 1, f"samples at {samples} between {far}")
    beyond = [x for x, y in found["c4"] if x > 672 and y < 340] # one mirrored point lies below the horizon and is not shown
    check(len(beyond) == 1, f"{beyond}")


# Results of appendices A to D: (eye, roughness, anisotropy, width, radius) for 16 samples.
WIDTHS = (((0.5, 0.3, 0.8), "0.5", "0.8", 0.11974987, 0.07918166), ((0.6, -0.2, 0.1), "0.4", "0.5", 0.04737105, 0.03401382),
          ((0.7, 0.0, 0.4), "0.5", "0.6", 0.14275683, 0.07331634))


@case("plot.the_points_that_are_drawn_are_the_lobe_s_width_apart")
def width(bench):
    for (x, y, z), roughness, anisotropy, wide, radius in WIDTHS:
        eye = f"{math.degrees(math.atan2(math.hypot(x, y), z))},{math.degrees(math.atan2(y, x))}"
        bench.run("plot", "axis", "--eye", eye, "--roughness", roughness, "--anisotropy", anisotropy, "-o", "a.svg").expect(0)
        found = re.search(r"width ([\d.]+), radius ([\d.]+)", (bench.folder / "a.svg").read_text())
        check(abs(float(found[1]) - wide) < 2e-5 and abs(float(found[2]) - radius) < 2e-5, f"{found[0]}, not {wide} and {radius}")


def lobe(bench, *words):
    """Returns a figure's lobe data: the peak and its place, the value in the mirror direction and its place; and the figure."""
    bench.run("plot", "lobe", *words, "-o", "l.svg", "-q").expect(0)
    text = (bench.folder / "l.svg").read_text()
    xml.etree.ElementTree.fromstring(text)
    number = r"([-\d.e+]+)"
    found = re.search(rf"peak {number} at {number},{number}, mirror direction {number} at {number},{number}", text)
    return [float(group) for group in found.groups()] + [text]


@case("plot.every_model_has_its_peak_where_it_must", budget=4)
def peaks(bench):
    names = [line.split()[0] for line in bench.run("list", "models").expect(0).out.splitlines() if line.strip()]
    drawn = 0
    for name in names:
        done = bench.run("plot", "lobe", "--brdf", name, "-o", "l.svg")
        if done.code == 2: # a model that is not a surface lobe
            continue
        drawn += 1
        peak, theta, _, mirrored, off, _, _ = lobe(bench, "--brdf", name, "--anisotropy", "0", "--eye", "0,0")
        if name == "heidrich_seidel": # threads are bright all the way around
            check(abs(mirrored - 1) < 1e-4 and peak < 1 + 1e-6, f"{name}: {peak} {mirrored}")
            continue
        if name == "charlie": # fibres stand up: dark from straight above
            check(mirrored < 1e-6 and theta > 45, f"{name}: {mirrored} {theta}")
            continue
        # alpha is 1/4: D / 4, or its replacement, is 4 / pi; for Ashikhmin's Phong (17 / 16) / 2 of that
        value = 17 / (8 * math.pi) if name == "ashikhmin_shirley" else 4 / math.pi
        check(theta < 0.01 and off < 0.01 and abs(peak / value - 1) < 1e-4, f"{name}: {peak} at {theta}, not {value}")
    check(drawn >= 9, f"{drawn} of {names}")


@case("plot.a_tilted_lobe_is_mirrored_about_its_own_normal")
def tilted(bench):
    for tilt, where in (("20,0", (40, 90)), ("0,20", (40, 180)), ("-10,0", (20, -90))):
        _, theta, phi, _, _, _, text = lobe(bench, "--tilt", tilt, "--roughness", "0.15", "--anisotropy", "0.5", "--eye", "0,0")
        check(abs(theta - where[0]) < 0.2 and abs(abs(phi) - abs(where[1])) < 0.2 and phi * where[1] > 0, f"{tilt}: peak at {theta},{phi}")
        check("ellipsoid" in text, "what is tilted is no ellipsoid")
    straight, skewed = (lobe(bench, "--tilt", tilt, "--eye", "30,0")[0] for tilt in ("0,0", "15,10"))
    check(abs(straight - skewed) > 0.01 * straight, "tilt changes nothing")


@case("plot.densities_fill_the_circle_and_end_there")
def densities(bench):
    bench.run("plot", "axis", "--roughness", "0.9", "-o", "a.svg", "-q").expect(0)
    number = r'"([-\d.]+)"'
    cells = [[float(v) for v in c] for c in re.findall(rf'<rect x={number} y={number} width={number} height={number} fill="rgb', (bench.folder / "a.svg").read_text())]
    for middle in (498, 822): # microfacet normals and reflected directions, 150 px around
        rows = {}
        for x, y, width, height in cells:
            if abs(x - middle) < 151 and y < 341:
                rows.setdefault(y, []).append((x, x + width))
        check(len(rows) == 150, f"{len(rows)} rows")
        for y, spans in rows.items():
            half = math.sqrt(max(150**2 - (y + 1 - 190) ** 2, 0))
            least, most = min(a for a, _ in spans) - middle + half, max(b for _, b in spans) - middle - half
            check(abs(least) < 0.2 and abs(most) < 0.2, f"row {y}: off the circle by {least} and {most}")


@case("plot.contours_of_a_round_lobe_are_circles")
def contours(bench):
    text = lobe(bench, "--anisotropy", "0", "--eye", "0,0", "--roughness", "0.6")[-1]
    group = re.search(r'<g class="c1"[^>]*>(.*?)</g>', text, re.S)[1]
    middle = 24 + 300 + 24 + 150, 190 # of the second panel
    far = sorted(math.hypot(float(x) - middle[0], float(y) - middle[1]) for x, y in re.findall(r"([\d.]+)[ ,]([\d.]+)", group))
    rings = [[far[0]]]
    for distance in far[1:]:
        if distance - rings[-1][-1] > 3:
            rings.append([])
        rings[-1].append(distance)
    check(len(rings) == 4 and all(ring[-1] - ring[0] < 1.5 for ring in rings), f"{[(ring[0], ring[-1]) for ring in rings]}")


def sides(bench, *words):
    bench.run("plot", "side", *words, "-o", "s.svg", "-q").expect(0)
    text = (bench.folder / "s.svg").read_text()
    xml.etree.ElementTree.fromstring(text)
    found = re.search(r"bent_normal ([\d.]+) %, major_axis ([\d.]+) %", text)
    return float(found[1]), float(found[2])


@case("plot.a_bent_normal_looks_to_the_wrong_side_and_the_axis_does_not")
def sides_of_techniques(bench):
    for eta, rotation in (("0", "45"), ("0.8", "0"), ("0.8", "90")): # no bending, or along parallels or meridians
        bent, axis = sides(bench, "--roughness", "0.4", "--anisotropy", eta, "--rotation", rotation)
        check(bent < 1 and axis < 1, f"{eta}: {bent} and {axis}")
    bent, axis = sides(bench, "--roughness", "0.4", "--anisotropy", "0.8")
    check(bent > 5 and axis < 0.5 * bent, f"{bent} and {axis}")


@case("plot.files_are_the_same_every_time")
def same(bench):
    for what in ("axis", "lobe"):
        for name in ("a.svg", "b.svg"):
            bench.run("plot", what, "-o", name, "-q").expect(0)
        check((bench.folder / "a.svg").read_bytes() == (bench.folder / "b.svg").read_bytes(), f"{what}: two runs make different files")


def distances(bench, *words):
    """Returns {title: L1} of the panels of `plot ltc`."""
    bench.run("plot", "ltc", *words, "-o", "c.svg", "-q", timeout=600).expect(0)
    return re.findall(r">([^<>]*), L1 ([0-9.]+)(: a lune)?<", (bench.folder / "c.svg").read_text())


def cosines(bench, words, lune):
    found = distances(bench, *words)
    by = {name: float(l1) for name, l1, _ in reversed(found)}
    table, one, two = (by[name] for name in ("the table", "the nearest cosine", "the nearest two"))
    check(two <= one <= table < one + 0.1, f"{table}, {one}, {two}")
    check(bool(found[1][2]) == lune and (two < 0.7 * one or not lune), f"{found}")
    check(by["the same, aligned"] < 0.8 * by["a lobe with itself, turned"] + 0.02, f"{by}")
    fits = [float(l1) for name, l1, _ in found if name == "burnish"]
    ways = {how: float(way) for how, way in re.findall(r">([^<>]*), mean squared way ([0-9.]+)<", (bench.folder / "c.svg").read_text())}
    closed, searched = ways["aligned in closed form"], ways["aligned by searching"]
    check(searched <= closed < 1.2 * searched and closed < ways["turned"], f"{ways}")
    check(len(fits) == 3 and min(fits) >= one, f"fits from three starts: {fits}")
    sliced = [float(l1) for name, l1, _ in found if name == "sliced distance"]
    check(len(sliced) == 3 and max(sliced) < min(sliced) + 0.02, f"the sliced distance ends in several places: {sliced}")


@case("plot.cosines_are_as_near_as_they_can_be", tier="nightly")
def cosines_of_a_lune(bench):
    cosines(bench, ("--roughness", "0.7", "--anisotropy", "0.75", "--eye", "65,40"), True)


@case("plot.cosines_without_a_lune_are_as_near_as_they_can_be", tier="nightly")
def cosines_without_a_lune(bench):
    cosines(bench, ("--roughness", "0.5", "--anisotropy", "0.3", "--eye", "30,10"), False)


@case("plot.wrong_options_say_one_line")
def wrong(bench):
    for words, code, needle in (
            (("axes", "-o", "a.svg"), 2, "axis"), (("axis",), 2, "--output"), (("axis", "-o", "a.png"), 2, ".svg; only ellipsoid is a .html"),
            (("axis", "-o", "no/a.svg"), 7, "no/a.svg"), (("axis", "--eye", "95,0", "-o", "a.svg"), 2, "--eye"),
            (("axis", "--eye", "nan,0", "-o", "a.svg"), 2, "--eye"), (("axis", "--samples", "0", "-o", "a.svg"), 2, "--samples"),
            (("axis", "--roughness", "0", "-o", "a.svg"), 2, "--roughness"), (("axis", "--tilt", "5,0", "-o", "a.svg"), 2, "--tilt"),
            (("side", "--eye", "5,0", "-o", "a.svg"), 2, "--eye"), (("side", "--brdf", "ward", "-o", "a.svg"), 2, "--brdf"),
            (("lobe", "--samples", "4", "-o", "a.svg"), 2, "--samples"), (("lobe", "--brdf", "phong", "-o", "a.svg"), 2, "phong"),
            (("lobe", "--brdf", "ward", "--tilt", "5,0", "-o", "a.svg"), 2, "ward"), (("lobe", "--tilt", "90,0", "-o", "a.svg"), 2, "--tilt")):
        bench.run("plot", *words).expect(code).expect_one_line(needle)
    check(bench.left_behind() == [], f"left {bench.left_behind()}")


def rotation(x, y, z):
    """Returns Rx Ry Rz of the ellipsoid's angles, by rows."""
    def product(a, b):
        return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]

    (cx, sx), (cy, sy), (cz, sz) = ((math.cos(a), math.sin(a)) for a in (x, y, z))
    return product([[1, 0, 0], [0, cx, -sx], [0, sx, cx]], product([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]], [[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]))


def mean_normal(ax, ay, angles, rows=160):
    """Returns the integral of the distribution times normals, a double-precision sum independent of the program: equation 1."""
    turn = rotation(*angles)
    length = math.sqrt((ax * turn[0][2])**2 + (ay * turn[1][2])**2 + turn[2][2]**2)
    mean = [0.0, 0.0, 0.0]
    for row in range(rows):
        z = (row + 0.5) / rows
        r = math.sqrt(1 - z * z)
        for column in range(2 * rows):
            phi = math.pi * (column + 0.5) / rows
            m = (r * math.cos(phi), r * math.sin(phi), z)
            q = [sum(turn[i][k] * m[k] for k in range(3)) for i in range(3)]
            d = 1 / (math.pi * ax * ay * length * ((q[0] / ax)**2 + (q[1] / ay)**2 + q[2]**2)**2) * math.pi / rows**2
            mean = [a + d * b for a, b in zip(mean, m)]
    return mean


@case("plot.figures_of_the_ellipsoid_are_its_integrals")
def ellipsoid(bench):
    bench.run("plot", "ellipsoid", "-o", "e.html", "-q").expect(0)
    text = (bench.folder / "e.html").read_text()

    def table(name):
        body = re.search(rf'<table id="{name}">(.*?)</table>', text, re.S)[1]
        return [re.findall(r"<td>(.*?)</td>", row) for row in body.split("</tr>")[1:] if "<td>" in row]

    normals = table("normals")
    check(len(normals) == 4, f"{len(normals)} settings")
    for widths, angles, *figures in normals:
        projected, off_n, off_shape, area, clamped, least, wall, walled = map(float, figures)
        (ax, ay), angles = map(float, widths.split(", ")), tuple(map(float, angles.split(", ")))
        mean = mean_normal(ax, ay, angles)
        flat = math.hypot(mean[0], mean[1])
        check(abs(projected - 1) < 1e-4 and abs(mean[2] - 1) < 1e-3, f"projected area {projected}, {mean[2]}")
        check(abs(off_n - math.degrees(math.atan2(flat, mean[2]))) < 0.02, f"mean normal {off_n} degrees off, {mean}")
        check(abs(wall - flat) < 1e-3, f"wall of {wall}, not {flat}")
        check(off_shape < 0.01 and area < 2e-3, f"{figures}")
        tilted = angles[0] or angles[1]
        check((clamped > 1 and least < 0.99) if tilted else (clamped == 0 and abs(least - 1) < 0.1), f"{figures}")
        check(walled > 0.999, f"the wall leaves {walled}")
    for _, _, *figures in table("samplers"):
        for version in range(3):
            kept, by_area, distance = figures[3 * version:3 * version + 3]
            chi2, freedom = map(float, distance.split(" / "))
            check(abs(float(kept) - float(by_area)) < 0.005, f"version {version + 1} keeps {kept}, not {by_area}")
            check(freedom > 20 and abs(chi2 - freedom) < 5 * math.sqrt(2 * freedom), f"version {version + 1}: {distance}")
    energy = [list(map(float, row)) for row in table("energy")]
    check(max(skew for _, skew, _ in energy) <= 1 and max(mapped for _, _, mapped in energy) > 1.2, f"{energy}")
    check(min(mapped for _, _, mapped in energy) == 0, "a normal map that faces away reflects")


@case("plot.a_page_is_a_page")
def page(bench):
    for words, needle in ((("-o", "e.svg"), ".html"), (("-o", "e.html", "--eye", "3,3"), "--eye"), (("-o", "e.html", "--roughness", "0.5"), "--roughness"),
                          (("-o", "e.html", "--tilt", "3,3"), "--tilt")):
        bench.run("plot", "ellipsoid", *words).expect(2).expect_one_line(needle)
    check(bench.left_behind() == [], f"left {bench.left_behind()}")


@case("progress.of_plots_is_told")
def progress(bench):
    check_told(bench, ((r"^plot, drawing side: ", "plot", "side", "-o", "a.svg"),))


@case("manual.reference_names_every_option_of_plots")
def manual(bench):
    check_options(bench, "plot")
