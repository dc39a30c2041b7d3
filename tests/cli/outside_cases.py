"""Means of the reference and of techniques, against closed forms and sums that share nothing with the renderer (outside_integrals.py)."""

import math

import outside_integrals as light
import outside_scenes as drawing
from gltf_files import png
from harness import case
from outside_integrals import LEVEL, Lobe, add, dot, times, unit
from outside_scenes import COSINES, MC, PATH, POINTS, REFERENCE, SHADOWED, check_near, disk, drawn, material, quad, sphere
from reference_cases import needs_embree

EYE = unit((0.5, 0.2, 0.8))
LOW_EYE = unit((-0.3, 0.8, 0.45))
COPPER = (0.9, 0.6, 0.3)
PAINT = (0.8, 0.5, 0.2)
LAMP = (3.0, 2.0, 1.0)
SPOT = (0.002, 0.002)  # a camera's window that sees one point of a plate, nearly
ORIGIN = (0.0, 0.0, 0.0)


def product(*colours):
    return tuple(math.prod(c) for c in zip(*colours))


# Lamps over a plate at the origin: each lamp as files have it, and the [(direction, solid angle)] that a point sees of it.
QUAD = ((-0.6, -0.4, 1.2), (-0.7, 0.6, 1.3), (0.3, 0.7, 1.3), (0.4, -0.3, 1.2))
SUNK = ((1.0, 0.5, -0.5), (1.0, 1.0, 1.0), (-1.0, 1.0, 1.0), (-1.0, 0.5, -0.5))
DISK = ((0.5, -0.4, 0.9), (0.5, 0.1, 0.9), (1.0, -0.4, 0.9))
ELLIPSE = ((-0.4, 0.3, 0.8), (-0.4, 0.9, 0.8), (-0.1, 0.3, 0.9))
BALL = ((0.3, -0.4, 0.8), 0.35)
LAMPS = {
    "quad": (quad(QUAD, LAMP), lambda p: light.quad_seen(p, QUAD)),
    "disk": (disk(*DISK, LAMP), lambda p: light.disk_seen(p, *DISK)),
    "ellipse": (disk(*ELLIPSE, LAMP), lambda p: light.disk_seen(p, *ELLIPSE)),
    "sphere": (sphere(*BALL, LAMP), lambda p: light.sphere_seen(p, *BALL)),
}


def plate_lit(bench, name, of, lamps, expected, ways, samples=1024, parts=(), bound=0.003):
    scene = drawing.scene([(drawing.plate(), of), *parts], EYE, SPOT, lamps)
    for way in ways:
        found, = drawn(bench, scene, drawing.black, way, "8x8", samples)
        check_near(f"{name} by {' '.join(way)}", found, expected, bound)


@case("outside.flat_lamps_light_plates_by_lambert_s_formula", tier="nightly")
def flat_lamps(bench):
    needs_embree(bench)
    forms = {
        "quad": (quad(QUAD, LAMP), light.lambert(ORIGIN, LEVEL[2], QUAD)),
        "quad through the horizon": (quad(SUNK, LAMP), light.lambert(ORIGIN, LEVEL[2], SUNK)),
        "disk": (LAMPS["disk"][0], light.disk_facing(DISK[0][2], math.hypot(*DISK[0][:2]), 0.5)),
        "ellipse": (LAMPS["ellipse"][0], light.seen_by_diffuse(LEVEL[2], LAMPS["ellipse"][1](ORIGIN))),
    }
    for name, (lamp, form) in forms.items():
        plate_lit(bench, name, material(diffuse=PAINT), [lamp], product(times(LAMP, form), PAINT), (SHADOWED, PATH, POINTS, COSINES))


@case("outside.a_ball_of_light_lights_plates_by_its_form_factor", tier="nightly")
def ball_of_light(bench):
    needs_embree(bench)
    for name, centre, radius in (("overhead", (0.0, 0.0, 1.0), 0.3), ("aside", (0.8, -0.3, 0.5), 0.25), ("near", (-0.3, -0.3, 0.6), 0.5)):
        form = light.ball_above(ORIGIN, LEVEL[2], centre, radius)
        plate_lit(bench, name, material(diffuse=PAINT), [sphere(centre, radius, LAMP)], product(times(LAMP, form), PAINT),
                  (SHADOWED, PATH, POINTS, COSINES))
    centre, radius = (0.9, 0.0, 0.1), 0.4  # half below
    form = light.seen_by_diffuse(LEVEL[2], light.sphere_seen(ORIGIN, centre, radius, 96))
    plate_lit(bench, "through the horizon", material(diffuse=PAINT), [sphere(centre, radius, LAMP)], product(times(LAMP, form), PAINT),
              (SHADOWED, PATH, POINTS))


@case("outside.lamps_on_brushed_metal_follow_the_sum_over_the_lamp", tier="nightly")
def brushed(bench):
    needs_embree(bench)
    for name, (lamp, seen) in LAMPS.items():
        lobe = Lobe(light.turned(LEVEL, 30.0), 0.4, 0.6, COPPER)
        expected = light.seen_by_lobe(lobe, EYE, seen(ORIGIN), LAMP)
        plate_lit(bench, name, material(metal=COPPER, roughness=0.4, strength=0.6, rotation=30.0), [lamp], expected, (REFERENCE, SHADOWED, POINTS))


# ---- balls: means over a picture of 2.2 x 2.2 that is seen along +z --------------------------------------------------------------------------------

WINDOW = 1.1


INSIDE = 0.65  # half a window within the ball's outline


def inside_ball(radiance, side=16):
    """The mean over a window within the outline; radiance(n): of the ball's point n."""
    places = [INSIDE * (2.0 * (k + 0.5) / side - 1.0) for k in range(side)]
    found = [radiance((x, y, math.sqrt(1.0 - x * x - y * y))) for x in places for y in places]
    return tuple(sum(f[c] for f in found) / len(found) for c in range(3))


def over_ball(radiance, rings=14):
    """The mean over the whole window."""
    total, turns = [0.0, 0.0, 0.0], 3 * rings
    for k in range(rings):
        r = math.sqrt((k + 0.5) / rings)
        for j in range(turns):
            a = 2.0 * math.pi * (j + 0.5) / turns
            for c, v in enumerate(radiance((r * math.cos(a), r * math.sin(a), math.sqrt(1.0 - r * r)))):
                total[c] += v
    return times(total, math.pi / (4.0 * WINDOW**2 * rings * turns))


TOWARDS = (0.0, 0.0, 1.0)
BALL_LAMPS = {
    "quad": (((1.5, -0.8, 1.5), (0.2, -0.8, 2.2), (0.2, 0.9, 2.2), (1.5, 0.9, 1.5)), quad, light.quad_seen),
    "disk": (((-1.2, 1.2, 1.2), (-0.9, 1.7, 1.0), (-0.6, 1.0, 1.8)), disk, light.disk_seen),
    "sphere": (((1.6, 2.2, 1.4), 0.7), sphere, light.sphere_seen),
}


@case("outside.lamps_light_balls_as_their_sums_say", tier="nightly")
def balls(bench):
    needs_embree(bench)
    for name, (shape, lamp, seen) in BALL_LAMPS.items():
        for kind in ("diffuse", "metal"):
            def radiance(n):
                of = seen(n, *([shape] if name == "quad" else shape), 14)
                if kind == "diffuse":
                    return product(times(LAMP, light.seen_by_diffuse(n, of)), PAINT)
                return light.seen_by_lobe(Lobe(frame_at(n), 0.55, 0.0, COPPER), TOWARDS, of, LAMP)

            of = material(diffuse=PAINT) if kind == "diffuse" else material(metal=COPPER, roughness=0.55)
            lamps = [lamp(shape, LAMP) if name == "quad" else lamp(*shape, LAMP)]
            scene = drawing.scene([(drawing.ball(), of)], TOWARDS, (WINDOW, WINDOW), lamps)
            expected = over_ball(radiance)
            for way in (REFERENCE, SHADOWED):
                check_near(f"{kind} ball, {name}, {' '.join(way)}", drawn(bench, scene, drawing.black, way, "16x16", 512)[0], expected, 0.005)
            found, = drawn(bench, scene, drawing.black, (*POINTS[:-1], "64"), "96x96", 1)
            check_near(f"{kind} ball, {name}, points", found, expected, 0.006)


def frame_at(n, pole=(0.0, 1.0, 0.0)):
    """Of the mesh: its tangent runs about the pole."""
    t = unit(light.cross(pole, n))
    return t, light.cross(n, t), n


# ---- things in the way, and things out of the way -----------------------------------------------------------------------------------------------

ROOM = quad(((-1.0, -1.0, 1.6), (-1.0, 1.0, 1.6), (1.0, 1.0, 1.6), (1.0, -1.0, 1.6)), LAMP)
RATIO = (*COSINES, "--shadows", "ratio", "--shadow-samples", "256")


def corners_of(low, high, z):
    """As drawing.rectangle has them, facing down."""
    return [corner[:3] for corner in drawing.rectangle(low, high, z)[0]]


@case("outside.lamps_add_up_wherever_they_stand", tier="nightly")
def sums(bench):
    """A ball of light between the plate and a quad, a quad that faces away between them, and a dim quad under the sky: none blocks."""
    needs_embree(bench)
    lamp, ball, between = corners_of((-1.0, -1.0), (1.0, 1.0), 1.6), ((-0.3, -0.2, 0.7), 0.3), corners_of((-0.4, -0.4), (0.3, 0.5), 1.0)
    above, ball_part = light.lambert(ORIGIN, LEVEL[2], lamp), light.ball_above(ORIGIN, LEVEL[2], *ball)
    away = quad(between[::-1], LAMP)
    of = material(diffuse=PAINT)
    ways = (REFERENCE, SHADOWED, PATH, RATIO)
    plate_lit(bench, "quad and ball", of, [quad(lamp, LAMP), sphere(*ball, LAMP)], product(times(LAMP, above + ball_part), PAINT), ways)
    plate_lit(bench, "quad that faces away", of, [quad(lamp, LAMP), away], product(times(LAMP, above), PAINT), ways)
    dim = quad(between, times(LAMP, 0.01))
    expected = product(add((1.0,) * 3, times(LAMP, 0.01 * light.lambert(ORIGIN, LEVEL[2], between))), PAINT)
    scene = drawing.scene([(drawing.plate(), of)], EYE, SPOT, [dim])
    for way in ways:
        found, = drawn(bench, scene, light.white, way, "8x8", 1024)
        check_near(f"dim quad under a white sky by {' '.join(way)}", found, expected)


@case("outside.light_that_grazes_its_own_lamp_arrives", tier="nightly")
def grazing(bench):
    """The lamp lies nearly in the line of sight from the plate: its light leaves at cosines of .005 to .03."""
    needs_embree(bench)
    for height in (0.01, 0.03):
        lamp = [(x, -height, z) for x, z in ((0.3, 1.0), (-0.3, 1.0), (-0.3, 2.0), (0.3, 2.0))]
        expected = product(times(LAMP, light.lambert(ORIGIN, LEVEL[2], lamp)), PAINT)
        plate_lit(bench, f"lamp {height} below the normal", material(diffuse=PAINT), [quad(lamp, LAMP)], expected, (REFERENCE, SHADOWED, PATH, RATIO))


@case("outside.things_in_the_way_take_their_share_of_light", tier="nightly")
def blocked(bench):
    """A black rectangle half way up covers its projection on the lamp, and its form factor of a white sky."""
    needs_embree(bench)
    low, high, z, top = (-0.2, -0.5), (0.45, 0.1), 0.8, 1.6
    lamp = corners_of((-1.0, -1.0), (1.0, 1.0), top)
    shade = corners_of(*(tuple(c * top / z for c in corner) for corner in (low, high)), top)
    open_part = light.lambert(ORIGIN, LEVEL[2], lamp) - light.lambert(ORIGIN, LEVEL[2], shade)
    wall = (drawing.rectangle(low, high, z), {**material(diffuse=(0.0, 0.0, 0.0)), "doubleSided": True})
    plate_lit(bench, "black wall", material(diffuse=PAINT), [quad(lamp, LAMP)], product(times(LAMP, open_part), PAINT), (SHADOWED, PATH, RATIO), 2048, [wall])
    sky_part = 1.0 - light.lambert(ORIGIN, LEVEL[2], corners_of(low, high, z))
    scene = drawing.scene([(drawing.plate(), material(diffuse=PAINT)), wall], EYE, SPOT)
    for way in (SHADOWED, PATH):
        found, = drawn(bench, scene, light.white, way, "8x8", 1024)
        check_near(f"black wall under a white sky by {' '.join(way)}", found, times(PAINT, sky_part))


# ---- materials under a sky ----------------------------------------------------------------------------------------------------------------------

WAYS = {REFERENCE: 0.003, MC: 0.004}  # and their bounds
BY_IRRADIANCE = {**WAYS, MC: 0.04}  # a picture of irradiance knows the surface's horizon roughly


def expect_stripes(bench, name, of, codes, expected, hand=1.0, ways=WAYS):
    """A texture's texels lie side by side: expected of each. The eye has no x, so that they are upright."""
    scene = drawing.scene([(drawing.plate(hand=hand), of)], ABOVE, (1.0, 0.25), images=[texels(*codes)])
    for way, bound in ways.items():
        found = drawn(bench, scene, light.two_lobes, way, "16x4", 4096, len(expected))
        for k, (one, right) in enumerate(zip(found, expected)):
            check_near(f"{name}, texel {k}, {' '.join(way)}", one, right, bound)


def texels(*codes):
    return png(len(codes), 1, color=lambda x, _: codes[x])


ABOVE = unit((0.0, 0.5, 0.8))


@case("outside.textures_of_roughness_have_each_texel_s_lobe", tier="nightly")
def roughness_texture(bench):
    needs_embree(bench)
    codes = (70, 110, 170, 240)
    of = material(metal=COPPER, roughness=0.9)
    of["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {"index": 0}
    expected = [Lobe(LEVEL, 0.9 * g / 255.0, 0.0, COPPER).reflected(ABOVE, light.two_lobes) for g in codes]
    expect_stripes(bench, "roughness", of, [(0, g, 255) for g in codes], expected)


@case("outside.textures_of_anisotropy_have_each_texel_s_grain", tier="nightly")
def grain_texture(bench):
    """Red and green are the grain, blue its strength, also of none; the rotation turns it further, and left-handed tangents turn all of it over."""
    needs_embree(bench)
    codes = ((255, 128, 255), (210, 225, 180), (128, 0, 0), (40, 190, 120))
    for hand in (1.0, -1.0):
        of = material(metal=COPPER, roughness=0.45, strength=0.9, rotation=25.0)
        of["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"] = {"index": 0}
        expected = []
        for r, g, b in codes:
            angle = math.degrees(math.atan2(2.0 * g / 255.0 - 1.0, 2.0 * r / 255.0 - 1.0)) + 25.0
            expected.append(Lobe(light.turned(LEVEL, hand * angle), 0.45, 0.9 * b / 255.0, COPPER).reflected(ABOVE, light.two_lobes))
        expect_stripes(bench, f"tangents {hand:+.0f}", of, codes, expected, hand)


BENT = ((190, 150, 230), (100, 60, 240))


def slope_of(code):
    return tuple(2.0 * c / 255.0 - 1.0 for c in code)


@case("outside.normal_maps_turn_lobes_by_their_scale", tier="nightly")
def normal_map(bench):
    """Of metals, of diffuse plates and under a coat, which keeps the surface's own normal. No light comes from below the surface."""
    needs_embree(bench)
    for hand, scale in ((1.0, 1.0), (1.0, 0.5), (-1.0, 0.5)):
        frame = (LEVEL[0], times(LEVEL[1], hand), LEVEL[2])
        bent = [light.under_map(frame, slope_of(code), scale) for code in BENT]
        coat = {"KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.3}}
        share = 0.8 * (0.04 + 0.96 * (1.0 - ABOVE[2]) ** 5)
        lobes = [Lobe(f, 0.45, 0.6, COPPER, above=LEVEL[2]).reflected(ABOVE, light.two_lobes) for f in bent]
        over = Lobe(LEVEL, 0.3).reflected(ABOVE, light.two_lobes)
        diffuse = [product(light.sky_on_diffuse(f[2], LEVEL[2], light.two_lobes), PAINT) for f in bent]
        for name, of, expected in (("metal", material(metal=COPPER, roughness=0.45, strength=0.6), lobes), ("paint", material(diffuse=PAINT), diffuse),
                                   ("coat", material(metal=COPPER, roughness=0.45, strength=0.6, extensions=coat),
                                    [add(times(one, 1.0 - share), times(over, share)) for one in lobes])):
            of["normalTexture"] = {"index": 0, "scale": scale}
            expect_stripes(bench, f"{name}, scale {scale}, tangents {hand:+.0f}", of, BENT, expected, hand, BY_IRRADIANCE if name == "paint" else WAYS)


@case("outside.balls_under_normal_maps_and_textures_follow_their_sums", tier="nightly")
def mapped_balls(bench):
    needs_embree(bench)
    bent = {"normalTexture": {"index": 0, "scale": 0.5}}
    rough = material(metal=COPPER, roughness=0.8)
    rough["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {"index": 0}
    pole = (0.0, 0.0, 1.0)
    for name, of, code, lobe in (
            ("grain about the pole", material(metal=COPPER, roughness=0.45, strength=0.7, rotation=20.0), (255, 255, 255),
             lambda n: Lobe(light.turned(frame_at(n, pole), 20.0), 0.45, 0.7, COPPER)),
            ("normal map", material(metal=COPPER, roughness=0.5, **bent), (170, 150, 235),
             lambda n: Lobe(light.under_map(frame_at(n), slope_of((170, 150, 235)), 0.5), 0.5, 0.0, COPPER, above=n)),
            ("roughness", rough, (0, 160, 255), lambda n: Lobe(frame_at(n), 0.8 * 160 / 255, 0.0, COPPER)),
            ("grain about an axis", material(metal=COPPER, roughness=0.45, strength=0.7, rotation=20.0), (255, 255, 255),
             lambda n: Lobe(light.turned(frame_at(n), 20.0), 0.45, 0.7, COPPER))):
        expected = inside_ball(lambda n: lobe(n).reflected(TOWARDS, light.two_lobes, 16), 12)
        scene = drawing.scene([(drawing.ball(towards_pole=name == "grain about the pole"), of)], TOWARDS, (INSIDE, INSIDE), images=[texels(code)])
        for way, size in ((REFERENCE, "16x16"), (MC, "48x48")):
            found, = drawn(bench, scene, light.two_lobes, way, size, 512)
            check_near(f"{name}, {' '.join(way)}", found, expected, 0.005)


@case("outside.specular_factors_and_index_set_the_reflectance", tier="nightly")
def reflectance(bench):
    """KHR_materials_specular and KHR_materials_ior. The diffuse part has the rest of light from everywhere, by the lobe's largest colour."""
    needs_embree(bench)
    for name, index, factor, colour in (("index 1.8", 1.8, 1.0, (1.0,) * 3), ("index 2.2", 2.2, 1.0, (1.0,) * 3), ("factor", 1.5, 0.4, (1.0,) * 3),
                                        ("colour", 1.8, 0.7, (1.0, 0.5, 0.2))):
        f0 = tuple(factor * min(1.0, c * ((index - 1.0) / (index + 1.0)) ** 2) for c in colour)
        lobe = Lobe(LEVEL, 0.4, 0.0, f0, (factor,) * 3)
        of = {"pbrMetallicRoughness": {"baseColorFactor": [*PAINT, 1], "metallicFactor": 0, "roughnessFactor": 0.4}, "extensions": {
            "KHR_materials_ior": {"ior": index}, "KHR_materials_specular": {"specularFactor": factor, "specularColorFactor": list(colour)}}}
        for eye in (EYE, LOW_EYE):
            back, sky = max(lobe.albedo(eye)), light.sky_on_diffuse(LEVEL[2], LEVEL[2], light.two_lobes)
            expected = add(lobe.reflected(eye, light.two_lobes), times(product(PAINT, sky), 1.0 - back))
            scene = drawing.scene([(drawing.plate(), of)], eye, SPOT)
            for way in WAYS:
                found, = drawn(bench, scene, light.two_lobes, way, "8x8", 4096)
                check_near(f"{name}, {' '.join(way)}", found, expected, 0.004)


@case("outside.emission_is_its_texture_times_factor_and_strength", tier="nightly")
def emission(bench):
    needs_embree(bench)
    codes = ((255, 255, 255), (188, 120, 60))
    linear = [tuple(((c / 255.0 + 0.055) / 1.055) ** 2.4 for c in code) for code in codes]
    of = material(diffuse=(0.0, 0.0, 0.0), emissiveFactor=[0.9, 0.5, 0.1], emissiveTexture={"index": 0},
                  extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 12.5}})
    scene = drawing.scene([(drawing.plate(), of)], ABOVE, (1.0, 0.25), images=[texels(*codes)])
    for way in (*WAYS, SHADOWED, PATH, COSINES):
        found = drawn(bench, scene, drawing.black, way, "16x4", 256, len(codes))
        for k, (one, tint) in enumerate(zip(found, linear)):
            check_near(f"texel {k}, {' '.join(way)}", one, times(product((0.9, 0.5, 0.1), tint), 12.5), 0.001)
