"""A glTF file in the making, and PNG files, by the standard library and numpy alone."""

import base64
import json
import struct
import zlib

import numpy

BYTE, UBYTE, SHORT, USHORT, UINT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
TYPES = {BYTE: numpy.int8, UBYTE: numpy.uint8, SHORT: numpy.int16, USHORT: numpy.uint16, UINT: numpy.uint32, FLOAT: numpy.float32}
LEAST = {BYTE: 127, UBYTE: 255, SHORT: 32767, USHORT: 65535}
WIDTHS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Document:
    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}
        self.data = bytearray()

    def add(self, kind, thing):
        """Its index in a list of the file."""
        self.json.setdefault(kind, []).append(thing)
        return len(self.json[kind]) - 1

    def use(self, *extensions):
        used = self.json.setdefault("extensionsUsed", [])
        used += [name for name in extensions if name not in used]

    def view(self, content, stride=None):
        self.data += bytes(-len(self.data) % 4)
        made = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)}
        if stride:
            made["byteStride"] = stride
        self.data += content
        return self.add("bufferViews", made)

    def accessor(self, values, component=FLOAT, normalized=False, padding=0, lead=0):
        """Values are numbers as they mean: a normalized accessor's are from 0 or -1 to 1. `padding` bytes follow each element, `lead` bytes come
        before the first one."""
        values = numpy.asarray(values, float)
        values = values.reshape(len(values), -1)
        stored = numpy.round(values * LEAST[component]) if normalized else values
        rows = stored.astype(TYPES[component])
        # Elements begin at multiples of four bytes in buffers of vertices.
        size = rows.dtype.itemsize * rows.shape[1]
        gap = padding + (-(size + padding) % 4 if values.shape[1] > 1 or padding else 0)
        content = bytes(lead) + b"".join(row.tobytes() + bytes(gap) for row in rows)
        made = {"bufferView": self.view(content, size + gap if gap else None), "componentType": component, "count": len(rows), "type": WIDTHS[rows.shape[1]]}
        if lead:
            made["byteOffset"] = lead
        if normalized:
            made["normalized"] = True
        if component == FLOAT and rows.shape[1] == 3:
            made["min"], made["max"] = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
        return self.add("accessors", made)

    def texture(self, content, mime="image/png", sampler=None):
        """A texture of a picture file's bytes."""
        image = self.add("images", {"bufferView": self.view(content), "mimeType": mime})
        made = {"source": image}
        if sampler is not None:
            made["sampler"] = self.add("samplers", sampler)
        return self.add("textures", made)

    def node(self, parent=None, **words):
        """A node of the scene, or of another node."""
        index = self.add("nodes", words)
        if parent is None:
            self.json["scenes"][0]["nodes"].append(index)
        else:
            self.json["nodes"][parent].setdefault("children", []).append(index)
        return index

    def light(self, light, **where):
        self.use("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        return self.node(extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **where)

    def write(self, path, binary=False):
        if self.data:
            self.json["buffers"] = [{"byteLength": len(self.data)}]
        if not binary:
            if self.data:
                self.json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
            path.write_text(json.dumps(self.json))
            return
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.data) + bytes(-len(self.data) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def png(values, bits=8):
    """A PNG file of values from 0 to 1: rows, columns, and 1 to 4 channels."""
    height, width, channels = values.shape
    most = 2**bits - 1
    rows = numpy.round(values * most).astype(">u2" if bits == 16 else ">u1")
    raw = b"".join(b"\0" + row.tobytes() for row in rows)
    kind = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    chunk = lambda name, content: struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
    head = struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")
