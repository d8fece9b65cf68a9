"""Reads the scanlines of an OpenEXR file that is not compressed and whose channels are all of single precision."""

import struct

import numpy


def read(path):
    """Channels by their names."""
    data = path.read_bytes()
    at, attributes = 8, {}
    word = lambda start: data[start : data.index(b"\0", start)]
    while data[at]:
        name = word(at)
        at += len(name) + 1
        kind = word(at)
        at += len(kind) + 1
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name.decode()] = data[at + 4 : at + 4 + size]
        at += 4 + size
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    if attributes["compression"] != b"\0":
        raise ValueError(f"{path} is compressed")
    names, rest = [], attributes["channels"]
    while rest[0]:
        name, rest = rest.split(b"\0", 1)
        if struct.unpack_from("<i", rest)[0] != 2:
            raise ValueError(f"{path}: {name} is not of single precision")
        names.append(name.decode())
        rest = rest[16:]
    starts = struct.unpack_from(f"<{height}Q", data, at + 1)
    pixels = {name: numpy.empty((height, width)) for name in names}
    for start in starts:
        (row, _) = struct.unpack_from("<2i", data, start)
        values = numpy.frombuffer(data, "<f4", len(names) * width, start + 8).reshape(len(names), width)
        for name, line in zip(names, values):
            pixels[name][row - top] = line
    return pixels


def read_rgb(path, layer=""):
    channels = read(path)
    return numpy.stack([channels[f"{layer}{name}"] for name in "RGB"], axis=2)
