"""OpenEXR files of 32-bit floats, and how bytes encode colours."""

import struct
import zlib

import numpy


def write_exr(path, pixels):
    """Writes rows from the top, of R, G, B and A, as scanlines compressed by ZIP."""
    pixels = numpy.ascontiguousarray(pixels, dtype="<f4")
    height, width, count = pixels.shape
    names = "RGBA"[:count]
    order = sorted(range(count), key=lambda index: names[index])

    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(names[index].encode() + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for index in order) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2)
    header += attribute("channels", "chlist", channels)
    header += attribute("compression", "compression", b"\3")
    header += attribute("dataWindow", "box2i", window)
    header += attribute("displayWindow", "box2i", window)
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    chunks = []
    for top in range(0, height, 16):
        rows = pixels[top : top + 16]
        raw = rows[:, :, order].transpose(0, 2, 1).tobytes()
        data = numpy.frombuffer(raw, dtype=numpy.uint8)
        data = numpy.concatenate([data[0::2], data[1::2]]).astype(numpy.int16)
        data[1:] = (data[1:] - data[:-1] + 128) & 255
        packed = zlib.compress(data.astype(numpy.uint8).tobytes())
        packed = packed if len(packed) < len(raw) else raw
        chunks.append(struct.pack("<ii", top, len(packed)) + packed)
    place = len(header) + 8 * len(chunks)
    offsets = []
    for chunk in chunks:
        offsets.append(place)
        place += len(chunk)
    with open(path, "wb") as file:
        file.write(header + struct.pack(f"<{len(offsets)}Q", *offsets) + b"".join(chunks))


def from_srgb(encoded):
    """Linear values of what sRGB encodes (IEC 61966-2-1)."""
    encoded = numpy.asarray(encoded, dtype=numpy.float32)
    return numpy.where(encoded <= 0.04045, encoded / 12.92, ((numpy.maximum(encoded, 0) + 0.055) / 1.055) ** 2.4)
