"""Writes meshes, lights and a camera as one binary glTF 2.0 file, which the library reads as a scene."""

import ctypes
import json
import struct

from .. import _native

ARRAY, ELEMENTS, FLOAT, WHOLE = 34962, 34963, 5126, 5125
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Writer:
    """Collects a file's parts. Equal parts give equal bytes."""

    def __init__(self):
        self.binary = bytearray()
        self.file = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [],
                     "accessors": [], "bufferViews": [], "cameras": [], "images": [], "textures": []}
        self.lights, self.extensions, self.pictures = [], set(), {}

    def accessor(self, values, each, target=ARRAY, bounds=False):
        """Adds a ctypes array of floats or whole numbers. Returns its index."""
        floats = values._type_._type_ == "f"
        entry = {"bufferView": len(self.file["bufferViews"]), "componentType": FLOAT if floats else WHOLE, "count": len(values) // each,
                 "type": KINDS[each]}
        if bounds:
            entry["min"], entry["max"] = ([of(values[i::each]) for i in range(each)] for of in (min, max))
        self.file["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": 4 * len(values), "target": target})
        self.binary += bytes(values)
        self.file["accessors"].append(entry)
        return len(self.file["accessors"]) - 1

    def texture(self, png):
        """Adds a picture, the bytes of a PNG file. Returns the texture's index."""
        if png not in self.pictures:
            self.pictures[png] = len(self.file["textures"])
            self.binary += bytes(-len(self.binary) % 4)
            self.file["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(png)})
            self.binary += png + bytes(-len(png) % 4)
            self.file["images"].append({"bufferView": len(self.file["bufferViews"]) - 1, "mimeType": "image/png"})
            self.file["textures"].append({"source": len(self.file["images"]) - 1})
        return self.pictures[png]

    def material(self, members, extensions):
        """Adds a material. extensions: {name: object}. Returns its index."""
        self.extensions.update(extensions)
        self.file["materials"].append({**members, **({"extensions": extensions} if extensions else {})})
        return len(self.file["materials"]) - 1

    def node(self, matrix, **what):
        """Adds a node at the root. matrix: 16 floats, column by column. what: mesh=, camera= or light= with its object."""
        entry = {"matrix": list(matrix)}
        for kind, thing in what.items():
            if kind == "light":
                self.extensions.add("KHR_lights_punctual")
                entry["extensions"] = {"KHR_lights_punctual": {"light": len(self.lights)}}
                self.lights.append(thing)
            else:
                entry[kind] = len(self.file[{"mesh": "meshes", "camera": "cameras"}[kind]])
                self.file[{"mesh": "meshes", "camera": "cameras"}[kind]].append(thing)
        self.file["scenes"][0]["nodes"].append(len(self.file["nodes"]))
        self.file["nodes"].append(entry)

    def bytes(self):
        """Returns the file."""
        file = {name: part for name, part in self.file.items() if part}
        if self.lights:
            file["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
        if self.extensions:
            file["extensionsUsed"] = sorted(self.extensions)
        binary = bytes(self.binary) + bytes(-len(self.binary) % 4)
        if binary:
            file["buffers"] = [{"byteLength": len(binary)}]
        text = json.dumps(file).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary if binary else b""
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def even_light(radiance):
    """Returns the picture of an environment with one radiance (red, green, blue) everywhere."""
    pixels = (ctypes.c_float * 24)(*radiance * 8)
    return _native.Values(pixels, ctypes.addressof(pixels), (2, 4, 3))
