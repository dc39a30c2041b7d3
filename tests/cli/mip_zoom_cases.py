"""Mip filters over a zoom out: changes from one image to the next."""

import json
import struct

import gltf_files as files
from detail_cases import bare
from harness import case, check
from input_cases import scratch
from mip_cases import grain
from reference_cases import needs_embree


def wide_floor(repeats):
    """Returns a metal floor of 40 by 40 metres, its texture repeated `repeats` times each way."""
    gltf = bare(pbrMetallicRoughness={"metallicFactor": 1, "roughnessFactor": 0.1, "baseColorFactor": [0.9, 0.8, 0.7, 1]})
    corners = ((-20, 20), (20, 20), (20, -20), (-20, 20), (20, -20), (-20, -20))
    columns = ([c for x, z in corners for c in (x, 0, z)], [0, 1, 0] * len(corners),
               [c * repeats for x, z in corners for c in ((x + 20) / 40, (20 - z) / 40)])
    binary = b"".join(struct.pack(f"<{len(c)}f", *c) for c in columns)
    gltf["buffers"] = [{"uri": files.data_uri(binary), "byteLength": len(binary)}]
    gltf["bufferViews"], gltf["accessors"], begin = [], [], 0
    for column, kind in zip(columns, ("VEC3", "VEC3", "VEC2")):
        gltf["bufferViews"].append({"buffer": 0, "byteOffset": begin, "byteLength": 4 * len(column)})
        gltf["accessors"].append({"bufferView": len(gltf["accessors"]), "componentType": 5126, "count": len(corners), "type": kind})
        begin += 4 * len(column)
    gltf["accessors"][0] |= {"min": [-20, 0, -20], "max": [20, 0, 20]}
    gltf["meshes"] = [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "material": 0}]}]
    return gltf


def flickers(bench, steps, samples):
    """Returns the changes between images of a zoom out over rough grain, relative to the reference's changes. Lobe filters stay within
    one and a half times, lean and box within twice."""
    needs_embree(bench)
    scratch(bench, "floor.gltf", files.text(wide_floor(24)))
    scratch(bench, "fine.png", grain(128, 0.3))
    words = ("floor.gltf", "--normal-map", "fine.png", "--frame-map", "quaternion", "--eye", "0,3,4", "--target", "0,0,0", "--fov", "35", "--size", "48x36",
             "--env-size", "64", "--env-samples", "64", "--no-background", "-q", "--animate", "zoom=4:0.6", "--steps", steps)
    bench.run("render", *words, "--backend", "reference", "--reference-textures", "full", "--samples", 4 * samples, "-o", "reference%d.pfm",
              timeout=1000.0).expect(0)
    changes = {}
    for name in ("box", "lean", "kappa", "leadr", "mipnet"):
        bench.run("render", *words, "--mip-filter", name, "--technique", "mc", "--samples", samples, "--msaa", "8", "-o", name + "%d.pfm",
                  timeout=1000.0).expect(0)
        found = json.loads(bench.run("compare", "--sequence", "reference%d.pfm", name + "%d.pfm", "--json", "-", timeout=1000.0).expect(0).out)
        changes[name] = found["change"] / found["reference_change"]
    print("changes to the reference's:", {name: round(share, 2) for name, share in changes.items()})
    check(max(changes["kappa"], changes["leadr"], changes["mipnet"]) < 1.5 and max(changes["lean"], changes["box"]) < 2, f"{changes}")


@case("mip.a_zoom_out_flickers_as_the_reference_does", tier="nightly")
def zoom_out(bench):
    flickers(bench, 8, 128)


@case("mip.a_zoom_out_of_sixty_steps_flickers_as_the_reference_does", tier="nightly")
def long_zoom_out(bench):
    flickers(bench, 60, 256)
