"""The files that scenes name: pictures, spectra and meshes, made anew for each run."""

import hashlib
import re
import struct
import zlib

import numpy

COLOURS, COLOURS_16, GREYS, GREYS_16, FLOATS = "colours.png", "colours-16.png", "greys.png", "greys-16.png", "floats.exr"
VEILED = "veiled.png"
JPEG, BMP, TGA, RADIANCE, PFM, PPM, HALVES = "colours.jpg", "colours.bmp", "colours.tga", "floats.hdr", "floats.pfm", "colours.ppm", "halves.exr"
GREY_FLOATS, WIDE = "grey-floats.exr", "wide.png"
SKY, SKY_RADIANCE, SKY_PNG = "sky.exr", "sky.hdr", "sky.png"
NORMALS, HEIGHTS, HEIGHTS_FLOAT = "normals.png", "heights.png", "heights.exr"
SPECTRUM = "paint.spd"
OBJ, OBJ_BARE, OBJ_SMOOTH, PLY, PLY_BINARY, PLY_ATTRIBUTES, SERIALIZED = "block.obj", "bare.obj", "smooth.obj", "block.ply", "block-binary.ply", "painted.ply", "block.serialized"
CLOUD, CLOUD_BOXED, TINTS, CLOUD_TINTED = "cloud.vol", "cloud-boxed.vol", "tints.vol", "cloud-tinted.vol"
INCLUDED, INCLUDED_BSDF = "included.xml", "included-bsdf.xml"


def version(folder, text):
    """Of the files that a scene names: kept pictures of other files do not count."""
    named = sorted({name for name in re.findall(r'"([\w.-]+\.\w+)"', text) if (folder / name).is_file()})
    return hashlib.sha256(b"".join((folder / name).read_bytes() for name in named)).hexdigest()


def write(folder, mitsuba):
    """Writes all of them. `mitsuba` is the module, whose bitmaps are written."""
    folder.mkdir(parents=True, exist_ok=True)
    save = lambda name, values, gamma=False: _save(mitsuba, folder / name, values, gamma)
    colours, greys = _colours(), _colours()[:, :, 1:2]
    bytes_ = lambda values: numpy.round(values * 255).astype(numpy.uint8)
    words = lambda values: numpy.round(values * 65535).astype(numpy.uint16)
    for name in (COLOURS, BMP, TGA, PPM):
        save(name, bytes_(colours), True)
    save(JPEG, bytes_(numpy.repeat(numpy.repeat(colours, 16, 0), 16, 1)), True)
    save(GREYS, bytes_(greys), True)
    save(COLOURS_16, words(colours), True)
    save(GREYS_16, words(greys), True)
    save(VEILED, bytes_(numpy.concatenate([colours, _colours()[::-1, ::-1, :1]], axis=2)), True)
    save(WIDE, bytes_(_colours(6, 3)), True)
    for name in (FLOATS, RADIANCE, PFM):
        save(name, colours.astype(numpy.float32))
    save(HALVES, colours.astype(numpy.float16))
    save(GREY_FLOATS, greys.astype(numpy.float32))
    sky = _sky()
    save(SKY, sky)
    save(SKY_RADIANCE, sky)
    save(SKY_PNG, bytes_(numpy.clip(sky / 2, 0, 1)), True)
    x, y = numpy.meshgrid(numpy.linspace(0, 1, 8), numpy.linspace(0, 1, 8))
    bent = numpy.stack([0.5 + 0.2 * numpy.cos(5 * x), 0.5 + 0.25 * numpy.sin(4 * y + x), numpy.full_like(x, 0.9)], axis=2)
    save(NORMALS, bytes_(bent))
    heights = (0.5 + 0.3 * numpy.sin(6 * x) * numpy.cos(4 * y + 1) + 0.1 * x)[:, :, None]
    save(HEIGHTS, bytes_(heights), True)
    save(HEIGHTS_FLOAT, heights.astype(numpy.float32))
    (folder / SPECTRUM).write_text("# wavelength and value\n400 0.1\n470 0.3\n550 0.25\n610 0.8\n720 0.7\n")
    _meshes(folder)
    _volumes(folder)
    (folder / INCLUDED).write_text(
        '<scene version="3.0.0"><bsdf type="diffuse" id="paint"><rgb name="reflectance" value="0.2, 0.5, 0.7"/></bsdf></scene>'
    )
    (folder / "sub").mkdir(exist_ok=True)
    save(f"sub/beside.png", bytes_(colours), True)


def _colours(width=4, height=4):
    """Every texel of another colour, no row or column alike, so that whatever mirrors or turns it shows."""
    random = numpy.random.default_rng(5)
    return 0.08 + 0.8 * random.random((height, width, 3))


def _volumes(folder):
    """Grids without a symmetry, whose borders are not empty."""
    random = numpy.random.default_rng(11)
    density = random.random((3, 4, 5, 1)) ** 2 * 3
    _volume(folder / CLOUD, density)
    _volume(folder / CLOUD_BOXED, density, (-1, -0.8, -0.6, 0.9, 1, 0.8))
    _volume(folder / TINTS, 0.2 + 0.75 * random.random((2, 3, 2, 3)))
    _volume(folder / CLOUD_TINTED, density * numpy.array([1, 0.6, 0.3]))


def _volume(path, values, box=(0, 0, 0, 1, 1, 1)):
    depth, height, width, channels = values.shape
    head = b"VOL\3" + struct.pack("<5i6f", 1, width, height, depth, channels, *box)
    path.write_bytes(head + values.astype("<f4").tobytes())


def _sky():
    """Smooth, and without a symmetry."""
    u, v = numpy.meshgrid((numpy.arange(16) + 0.5) / 16, numpy.linspace(0, 1, 9))
    turn = 2 * numpy.pi * u
    red = 1 + 0.7 * numpy.cos(turn) * numpy.sin(numpy.pi * v)
    green = 1 + 0.7 * numpy.sin(turn) * numpy.sin(numpy.pi * v)
    blue = 1 + 0.8 * numpy.cos(numpy.pi * v)
    return numpy.stack([red, green, blue], axis=2).astype(numpy.float32)


def _save(mitsuba, path, values, gamma):
    bitmap = mitsuba.Bitmap(numpy.ascontiguousarray(values))
    bitmap.set_srgb_gamma(gamma)
    if path.suffix == ".tga":
        _tga(path, values)
    elif path.suffix == ".bmp":
        _bmp(path, values)
    elif path.suffix == ".ppm":
        path.write_bytes(b"P6\n%d %d\n255\n" % values.shape[1::-1] + values.tobytes())
    elif path.suffix == ".jpg":
        bitmap.write(str(path), quality=100)
    else:
        bitmap.write(str(path))


def _tga(path, values):
    """24 bits, the first row at the top."""
    height, width, _ = values.shape
    header = struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, width, height, 24, 0x20)
    # Without these last words Mitsuba does not know it for what it is.
    path.write_bytes(header + values[:, :, ::-1].tobytes() + bytes(8) + b"TRUEVISION-XFILE.\0")


def _bmp(path, values):
    """24 bits, the last row first, rows filled up to four bytes."""
    height, width, _ = values.shape
    filled = -(3 * width) % 4
    rows = b"".join(row.tobytes() + bytes(filled) for row in values[::-1, :, ::-1])
    sizes = struct.pack("<IiiHHIIiiII", 40, width, height, 1, 24, 0, len(rows), 2835, 2835, 0, 0)
    path.write_bytes(b"BM" + struct.pack("<IHHI", 54 + len(rows), 0, 0, 54) + sizes + rows)


# A block that no turn or mirror maps to itself: its upper end is narrow and leans over.
_CORNERS = [(-1, -0.8, -0.6), (1, -0.8, -0.6), (1, -0.8, 0.6), (-1, -0.8, 0.6), (-0.2, 0.9, -0.5), (0.7, 0.7, -0.4), (0.7, 0.6, 0.3), (-0.1, 0.8, 0.5)]
_QUADS = [(0, 1, 2, 3), (7, 6, 5, 4), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
_UVS = [(0.05, 0.1), (0.9, 0.0), (0.95, 0.85), (0.1, 1.0)]


def _flat():
    """Positions, normals, texture coordinates and faces, four vertices for each side."""
    positions, normals, uvs, faces = [], [], [], []
    for quad in _QUADS:
        first = len(positions)
        corners = numpy.array([_CORNERS[index] for index in quad])
        normal = numpy.cross(corners[2] - corners[0], corners[3] - corners[1])
        normal /= numpy.linalg.norm(normal)
        for corner, uv in zip(corners, _UVS):
            positions.append(corner)
            # Bent a little, so that interpolation shows.
            bent = normal + 0.3 * corner / numpy.linalg.norm(corner)
            normals.append(bent / numpy.linalg.norm(bent))
            uvs.append(uv)
        faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return positions, normals, uvs, faces


def _meshes(folder):
    positions, normals, uvs, faces = _flat()
    lines = [f"v {x} {y} {z}" for x, y, z in positions] + [f"vt {u} {v}" for u, v in uvs] + [f"vn {x} {y} {z}" for x, y, z in normals]
    lines += ["f " + " ".join(f"{index + 1}/{index + 1}/{index + 1}" for index in face) for face in faces]
    (folder / OBJ).write_text("\n".join(lines) + "\n")
    bare = [f"v {x} {y} {z}" for x, y, z in _CORNERS] + ["f " + " ".join(str(index + 1) for index in quad) for quad in _QUADS]
    (folder / OBJ_BARE).write_text("\n".join(bare) + "\n")
    plain = [f"v {x} {y} {z}" for x, y, z in positions] + [f"vt {u} {v}" for u, v in uvs]
    plain += ["f " + " ".join(f"{index + 1}/{index + 1}" for index in face) for face in faces]
    (folder / OBJ_SMOOTH).write_text("\n".join(plain) + "\n")
    names = ["x", "y", "z", "nx", "ny", "nz", "u", "v"]
    rows = [(*position, *normal, *uv) for position, normal, uv in zip(positions, normals, uvs)]
    _ply(folder / PLY, names, rows, faces, False)
    _ply(folder / PLY_BINARY, names, rows, faces, True)
    random = numpy.random.default_rng(7)
    painted = [(*row, *random.random(3), random.random()) for row in rows]
    of_faces = [(*random.random(3), random.random()) for _ in faces]
    _ply(folder / PLY_ATTRIBUTES, names + ["r", "g", "b", "width"], painted, faces, False, ["r", "g", "b", "width"], of_faces)
    (folder / SERIALIZED).write_bytes(_serialized([(positions, normals, uvs, faces), ([(3 * x, y, z) for x, y, z in _CORNERS[:4]], None, None, [(0, 2, 1), (0, 3, 2)]), ([(0.6 * x, 1.2 * y, z) for x, y, z in positions], None, uvs, faces)]))


def _ply(path, names, rows, faces, binary, face_names=(), of_faces=()):
    head = ["ply", f"format {'binary_little_endian' if binary else 'ascii'} 1.0", f"element vertex {len(rows)}"]
    head += [f"property float {name}" for name in names] + [f"element face {len(faces)}", "property list uchar int vertex_indices"]
    head += [f"property float {name}" for name in face_names] + ["end_header"]
    text = "\n".join(head) + "\n"
    of_faces = of_faces or [()] * len(faces)
    if binary:
        body = b"".join(struct.pack(f"<{len(names)}f", *row) for row in rows)
        body += b"".join(struct.pack("<B3i", 3, *face) for face in faces)
        path.write_bytes(text.encode() + body)
    else:
        lines = [" ".join(str(float(value)) for value in row) for row in rows]
        lines += [" ".join(["3", *map(str, face), *map(str, own)]) for face, own in zip(faces, of_faces)]
        path.write_text(text + "\n".join(lines) + "\n")


def _serialized(meshes):
    """Version 4: each mesh compressed by itself, and where they begin at the end."""
    data, starts = b"", []
    for positions, normals, uvs, faces in meshes:
        flags = 0x1000 | (0x0001 if normals else 0) | (0x0002 if uvs else 0)
        body = struct.pack("<I", flags) + b"a mesh\0" + struct.pack("<QQ", len(positions), len(faces))
        for values in (positions, normals, uvs):
            if values:
                body += numpy.array(values, numpy.float32).tobytes()
        body += numpy.array(faces, numpy.uint32).tobytes()
        starts.append(len(data))
        data += struct.pack("<HH", 0x041C, 4) + zlib.compress(body)
    return data + b"".join(struct.pack("<Q", start) for start in starts) + struct.pack("<I", len(starts))
