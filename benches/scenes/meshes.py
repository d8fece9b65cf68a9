"""Meshes and textures from parameters, and the files that scenes name: binary PLY and PNG. Needs Python and nothing beyond it."""

import math
import random
import struct
import zlib


class Mesh:
    """Vertices with texture coordinates, and triangles that are counter-clockwise seen from the front."""

    def __init__(self):
        self.vertices, self.faces = [], []

    def quad(self, corner, u, v, scale=1.0):
        """A parallelogram with its front where u × v points; texture coordinates are lengths times `scale`."""
        first = len(self.vertices)
        lengths = [scale * math.hypot(*edge) for edge in (u, v)]
        for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
            place = tuple(c + s * a + t * b for c, a, b in zip(corner, u, v))
            self.vertices.append((*place, s * lengths[0], t * lengths[1]))
        self.faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]

    def box(self, low, high, scale=1.0):
        (x, y, z), (a, b, c) = low, [h - l for l, h in zip(low, high)]
        self.quad((x, y, z + c), (a, 0, 0), (0, b, 0), scale)
        self.quad((x + a, y, z), (-a, 0, 0), (0, b, 0), scale)
        self.quad((x, y, z), (0, 0, c), (0, b, 0), scale)
        self.quad((x + a, y, z + c), (0, 0, -c), (0, b, 0), scale)
        self.quad((x, y + b, z + c), (a, 0, 0), (0, 0, -c), scale)
        self.quad((x, y, z), (a, 0, 0), (0, 0, c), scale)

    def grid(self, columns, rows, place, scale=(1.0, 1.0)):
        """A sheet over the unit square, whose points `place` puts into space."""
        first = len(self.vertices)
        for row in range(rows + 1):
            for column in range(columns + 1):
                s, t = column / columns, row / rows
                self.vertices.append((*place(s, t), s * scale[0], t * scale[1]))
        for row in range(rows):
            for column in range(columns):
                a = first + row * (columns + 1) + column
                b = a + columns + 1
                self.faces += [(a, a + 1, b + 1), (a, b + 1, b)]

    def lathe(self, center, profile, segments, scale=(1.0, 1.0)):
        """A profile of (radius, height) from below, turned about the vertical axis."""
        x, y, z = center
        last = len(profile) - 1

        def place(s, t):
            radius, height = profile[round(t * last)]
            angle = -2 * math.pi * s
            return x + radius * math.cos(angle), y + height, z + radius * math.sin(angle)

        self.grid(segments, last, place, scale)

    def cushion(self, center, half, steps=48, power=0.35):
        """A superellipsoid: a box with round edges."""
        bend = lambda x: math.copysign(abs(x) ** power, x)

        def place(s, t):
            # Not quite to the poles, where triangles would have no area.
            angle, height = -2 * math.pi * s, 0.996 * math.pi * (t - 0.5)
            around = bend(math.cos(height))
            unit = (around * bend(math.cos(angle)), bend(math.sin(height)), around * bend(math.sin(angle)))
            return tuple(c + h * u for c, h, u in zip(center, half, unit))

        self.grid(2 * steps, steps, place, (2.0, 1.0))

    def write(self, path):
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(self.vertices)}\n"
        head += "".join(f"property float {name}\n" for name in "xyzuv")
        head += f"element face {len(self.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        with open(path, "wb") as file:
            file.write(head.encode())
            file.write(b"".join(struct.pack("<5f", *vertex) for vertex in self.vertices))
            file.write(b"".join(struct.pack("<B3i", 3, *face) for face in self.faces))


def write_png(path, width, height, colour):
    """`colour` maps (u, v) in the unit square, v from the bottom, to red, green and blue from 0 to 1."""
    rows = []
    for y in range(height):
        row = bytearray([0])
        for x in range(width):
            value = colour((x + 0.5) / width, 1 - (y + 0.5) / height)
            row += bytes(max(0, min(255, round(255 * c))) for c in value)
        rows.append(bytes(row))

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b""))


def write_sky(path, zenith, horizon, ground, sun=None, width=64, height=32):
    """A lat-long map as Radiance's .hdr: from the horizon's colour to the zenith's by the direction's height, another one below. `sun` is the
    (column, row) of a texel and its colour."""

    def texel(colour):
        mantissa, exponent = math.frexp(max(colour))
        return bytes(int(256 * math.ldexp(c, -exponent)) for c in colour) + bytes([exponent + 128])

    rows = []
    for y in range(height):
        up = math.cos(math.pi * (y + 0.5) / height)
        colour = [h + (z - h) * up for z, h in zip(zenith, horizon)] if up > 0 else ground
        texels = [texel(colour)] * width
        if sun and sun[0][1] == y:
            texels[sun[0][0]] = texel(sun[1])
        rows.append(b"".join(texels))
    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + b"".join(rows))


def noise(seed, cells):
    """Smooth noise from −1 to 1 over the unit square, which repeats at its edges."""
    generator = random.Random(seed)
    lattice = [[generator.uniform(-1, 1) for _ in range(cells)] for _ in range(cells)]

    def at(u, v):
        x, y = u * cells, v * cells
        i, j = math.floor(x), math.floor(y)
        s, t = ((f * f * (3 - 2 * f)) for f in (x - i, y - j))
        value = lambda a, b: lattice[b % cells][a % cells]
        low = value(i, j) * (1 - s) + value(i + 1, j) * s
        high = value(i, j + 1) * (1 - s) + value(i + 1, j + 1) * s
        return low * (1 - t) + high * t

    return at


def mottled(base, amount, seed, cells=16, joints=None):
    """A colour that varies, darker along the joints of bricks where (columns, rows) says how many."""
    fine, coarse = noise(seed, cells), noise(seed + 1, 4)

    def colour(u, v):
        factor = 1 + amount * (0.6 * fine(u, v) + 0.4 * coarse(u, v))
        if joints:
            columns, rows = joints
            row = math.floor(v * rows)
            across, along = (v * rows) % 1, (u * columns + 0.5 * (row % 2)) % 1
            if min(across, 1 - across) < 0.04 or min(along, 1 - along) < 0.04 * columns / rows:
                factor *= 0.55
        return tuple(c * factor for c in base)

    return colour


def grain(base, seed):
    """Wood: rings that run along v."""
    wobble, fine = noise(seed, 6), noise(seed + 1, 64)
    return lambda u, v: tuple(
        c * (1 + 0.18 * math.sin(40 * (u + 0.06 * wobble(u, v))) + 0.08 * fine(u, v * 0.1)) for c in base
    )


def stripes(first, second, count, seed):
    weave = noise(seed, 64)
    return lambda u, v: tuple(c * (1 + 0.1 * weave(u, v)) for c in (first if math.floor(u * count) % 2 == 0 else second))
