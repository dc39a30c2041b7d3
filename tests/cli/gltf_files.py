"""glTF and PNG files made here, so that each fault is one edit away from a file that loads."""

import base64
import copy
import json
import struct
import zlib

POSITIONS = struct.pack("<9f", -1, 0, 0, 1, 0, 0, 0, 1, 0)
INDICES = struct.pack("<3H", 0, 1, 2)


def data_uri(data):
    return "data:application/octet-stream;base64," + base64.b64encode(data).decode()


def triangle(positions=POSITIONS, indices=INDICES):
    """Returns a scene with one triangle, as a dictionary."""
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "node"}],
        "meshes": [{"name": "triangle", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "buffers": [{"byteLength": 42, "uri": data_uri(positions + indices)}],
    }


def textured(image_uri):
    """Returns the triangle with a base colour texture."""
    uvs = struct.pack("<6f", 0, 0, 1, 0, 0, 1)
    gltf = triangle()
    gltf["meshes"][0]["primitives"][0]["material"] = 0
    gltf["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2
    gltf["accessors"].append({"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"})
    gltf["bufferViews"].append({"buffer": 1, "byteLength": 24})
    gltf["buffers"].append({"byteLength": 24, "uri": data_uri(uvs)})
    gltf["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    gltf["textures"] = [{"source": 0}]
    gltf["images"] = [{"uri": image_uri}]
    return gltf


def text(gltf):
    return json.dumps(gltf)


def glb(gltf, binary=POSITIONS + INDICES):
    """Returns the binary container, with the first buffer as its chunk."""
    gltf = copy.deepcopy(gltf)
    gltf["buffers"][0] = {"byteLength": len(binary)}
    body = json.dumps(gltf).encode()
    body += b" " * (-len(body) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I4s", len(body), b"JSON") + body + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def png(width, height, rows=None, color=None):
    """Returns an image with one colour or color(x, y), which may have alpha. If `rows` is less than `height`, the header promises more
    than the file holds."""
    if color:
        raw = b"".join(b"\0" + b"".join(bytes(color(x, y)) for x in range(width)) for y in range(height))
    else:
        raw = b"".join(b"\0" + b"\x80\x40\x20" * min(width, 4096) for _ in range(height if rows is None else rows))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    kind = 6 if color and len(color(0, 0)) == 4 else 2
    header = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")
