"""The shapes of a scene as triangles in world space, for renderers that have no other primitives."""

from dataclasses import dataclass

import numpy as np

from scene_file import Refused


@dataclass
class Mesh:
    """Triangles, counter-clockwise seen from outside."""

    positions: np.ndarray
    faces: np.ndarray
    normals: np.ndarray | None = None
    """One a vertex, where they are interpolated."""
    coordinates: np.ndarray | None = None
    """Texture coordinates, one pair a vertex; v grows upwards."""


def mesh(shape, columns=128):
    """The triangles of any shape; a sphere is made of `columns` by half as many rows."""
    kind = shape["type"]
    if kind == "rectangle":
        corner, u, v = shape["corner"], shape["edge_u"], shape["edge_v"]
        square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
        made = Mesh(corner + square[:, :1] * u + square[:, 1:] * v, np.array([[0, 1, 2], [0, 2, 3]]), coordinates=square)
    elif kind == "box":
        made = box(shape["min"], shape["max"])
    elif kind == "sphere":
        made = sphere(columns)
        made.positions = shape["center"] + shape["radius"] * made.positions
    elif "file" in shape:
        made = (binary_ply if shape["file"].suffix == ".ply" else wavefront)(shape)
    else:
        made = Mesh(np.array(shape["positions"], dtype=float), np.array(shape["faces"]))
    matrix = shape["matrix"]
    made.positions = made.positions @ matrix[:3, :3].T + matrix[:3, 3]
    if made.normals is not None:
        made.normals = made.normals @ np.linalg.inv(matrix[:3, :3])
        made.normals /= np.linalg.norm(made.normals, axis=1, keepdims=True)
    return made


def spheres_columns(scene, shape):
    """How fine a sphere is made: coarser where it emits, since every triangle is a light of its own then."""
    return 48 if scene.materials[shape["material"]]["type"] == "emissive" else 128


def box(low, high):
    positions = np.array([[(low, high)[x][0], (low, high)[y][1], (low, high)[z][2]] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Mesh(positions, np.array([part for a, b, c, d in quads for part in ((a, b, c), (a, c, d))]))


def sphere(columns):
    """About the origin, with the normals of the sphere and with the surface area of a sphere of radius 1, hence its mean silhouette too."""
    rows = columns // 2
    theta = np.pi * np.arange(1, rows)[:, None] / rows
    phi = 2 * np.pi * np.arange(columns)[None, :] / columns
    ring = np.stack([np.sin(theta) * np.cos(phi), np.broadcast_to(np.cos(theta), (rows - 1, columns)), -np.sin(theta) * np.sin(phi)], axis=-1)
    normals = np.concatenate([[[0, 1, 0]], ring.reshape(-1, 3), [[0, -1, 0]]])
    at = lambda row, column: 1 + (row - 1) * columns + column % columns  # noqa: E731
    faces = []
    for column in range(columns):
        faces.append((0, at(1, column), at(1, column + 1)))
        for row in range(1, rows - 1):
            a, b, c, d = at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)
            faces += [(a, b, c), (a, c, d)]
        faces.append((at(rows - 1, column), len(normals) - 1, at(rows - 1, column + 1)))
    faces = np.array(faces)
    a, b, c = (normals[faces[:, corner]] for corner in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    return Mesh(normals * np.sqrt(4 * np.pi / area), faces, normals)


def wavefront(shape):
    """An OBJ file of triangles with flat facets."""
    positions, faces, has_normals = [], [], False
    with shape["file"].open(encoding="utf-8") as file:
        for line in file:
            key, *values = line.split() or [""]
            if key == "v":
                positions.append([float(value) for value in values[:3]])
            elif key == "f" and len(values) == 3:
                faces.append([int(value.split("/")[0]) - 1 for value in values])
            elif key == "f":
                raise Refused(f"{shape['file'].name}: faces of {len(values)} corners are not translated")
            has_normals |= key == "vn"
    if has_normals if shape["smooth"] is None else shape["smooth"]:
        raise Refused(f"{shape['file'].name}: interpolated normals of a model are not translated")
    return Mesh(np.array(positions), np.array(faces))


def binary_ply(shape):
    """A PLY file as benches/scenes/meshes.py writes it: vertices of x, y, z, u, v, and triangles."""
    text = shape["file"].read_bytes()
    head, data = text.split(b"end_header\n", 1)
    head = head.decode()
    expected = ["ply", "format binary_little_endian 1.0", "property float x", "property float y", "property float z", "property float u", "property float v"]
    if any(line not in head.splitlines() for line in expected) or head.count("property") != 6 or shape["smooth"] is not False:
        raise Refused(f"{shape['file'].name}: only flat meshes of x, y, z, u, v are translated")
    vertices, faces = (int(line.split()[-1]) for line in head.splitlines() if line.startswith("element"))
    points = np.frombuffer(data, "<f4", 5 * vertices).reshape(-1, 5).astype(float)
    corners = np.frombuffer(data, [("count", "u1"), ("corners", "<i4", 3)], faces, 20 * vertices)
    return Mesh(points[:, :3], corners["corners"].astype(int), coordinates=points[:, 3:])
