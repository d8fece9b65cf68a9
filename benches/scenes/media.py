"""Scenes of light that is scattered on its way: fog, a cloud, milk and wax, a prism."""

import math
import random
import struct

from meshes import Mesh


def write_volume(path, size, density):
    """A grid of Mitsuba's format; `density` has the row along x of each y and z."""
    x, y, z = size
    head = b"VOL" + struct.pack("<B5i6f", 3, 1, x, y, z, 1, 0, 0, 0, 1, 1, 1)
    with open(path, "wb") as file:
        file.write(head)
        for k in range(z):
            for j in range(y):
                file.write(struct.pack(f"<{x}f", *density(j, k)))


def lumps(seed, size, cells):
    """Smooth noise over a box of `size` voxels, of so many cells along each axis: the row along x of each y and z."""
    generator = random.Random(seed)
    x, y, z = cells
    lattice = [[[generator.random() for _ in range(x + 1)] for _ in range(y + 1)] for _ in range(z + 1)]
    ease = lambda t: t * t * (3 - 2 * t)

    def place(voxel, axis):
        at = (voxel + 0.5) / size[axis] * cells[axis]
        return min(int(at), cells[axis] - 1), ease(at - min(int(at), cells[axis] - 1))

    along = [place(voxel, 0) for voxel in range(size[0])]
    rows = [[[row[i] + (row[i + 1] - row[i]) * share for i, share in along] for row in plane] for plane in lattice]

    def row(voxel_y, voxel_z):
        (j, v), (k, w) = place(voxel_y, 1), place(voxel_z, 2)
        a, b, c, d = (1 - v) * (1 - w), v * (1 - w), (1 - v) * w, v * w
        quad = zip(rows[k][j], rows[k][j + 1], rows[k + 1][j], rows[k + 1][j + 1])
        return [a * p + b * q + c * r + d * s for p, q, r, s in quad]

    return row


def cloud_density(size=128):
    """A cumulus: an ellipsoid with a flat base, whose edge is torn by noise of four sizes."""
    octaves = [(0.5**number, lumps(70 + number, (size,) * 3, (4 * 2**number,) * 3)) for number in range(4)]

    def row(j, k):
        parts = [[amount * value for value in noise(j, k)] for amount, noise in octaves]
        torn = [sum(values) / 1.875 - 0.5 for values in zip(*parts)]
        v, w = (j + 0.5) / size, (k + 0.5) / size
        above = max(0.0, min(1.0, (v - 0.12) * 8)) * max(0.0, min(1.0, (0.97 - v) * 12))
        found = []
        for i, noise in enumerate(torn):
            u = (i + 0.5) / size
            inside = 1 - math.sqrt(((u - 0.5) / 0.42) ** 2 + ((v - 0.3) / 0.5) ** 2 + ((w - 0.5) / 0.42) ** 2)
            edge = min(u, 1 - u, w, 1 - w) * 12
            found.append(max(0.0, min(1.0, (inside + 1.5 * noise) * 5)) * above * max(0.0, min(1.0, edge)))
        return found

    return row


def fog(scene_of, folder):
    scene = scene_of(folder, "foggy-room", (320, 240), 24, (2.6, 1.5, 4.4), (2.2, 1.2, 0.0), 60)
    scene.around_camera("fog")
    scene.add("medium", name="fog", absorption=0.01, scattering=0.15, phase='{ type = "henyey_greenstein", g = 0.5 }')
    scene.add("material", name="edge of the fog", type="pass", interior="fog")
    scene.diffuse("plaster", (0.7, 0.68, 0.64))
    scene.diffuse("boards", (0.4, 0.28, 0.18))
    scene.diffuse("grey", (0.5, 0.5, 0.5))
    scene.emissive("warm", (40, 28, 14))
    scene.emissive("cold", (14, 22, 40))
    a, b, c = 4.4, 2.6, 4.8
    scene.add("shape", type="box", min=(-1, -0.5, -0.5), max=(a + 0.5, b + 0.5, c + 0.5), material="edge of the fog")
    scene.rectangle("boards", (0, 0, c), (a, 0, 0), (0, 0, -c))
    scene.rectangle("plaster", (0, b, 0), (a, 0, 0), (0, 0, c))
    scene.rectangle("plaster", (0, 0, 0), (a, 0, 0), (0, b, 0))
    scene.rectangle("plaster", (a, 0, c), (-a, 0, 0), (0, b, 0))
    scene.rectangle("plaster", (a, 0, 0), (0, 0, c), (0, b, 0))
    # The wall with a window, in which a low sun stands.
    for corner, u, v in (
        ((0, 0, c), (0, 0, -c), (0, 0.9, 0)),
        ((0, 2.1, c), (0, 0, -c), (0, b - 2.1, 0)),
        ((0, 0.9, c), (0, 0, -(c - 2.4)), (0, 1.2, 0)),
        ((0, 0.9, 1.4), (0, 0, -1.4), (0, 1.2, 0)),
    ):
        scene.rectangle("plaster", corner, u, v)
    scene.add("light", type="directional", direction=(1, -0.55, 0.12), irradiance=(9, 8, 6.5))
    scene.add("shape", type="sphere", center=(3.6, 1.1, 0.8), radius=0.1, material="warm")
    scene.add("shape", type="sphere", center=(1.0, 2.2, 0.6), radius=0.08, material="cold")
    scene.add("shape", type="box", min=(3.2, 0, 0.4), max=(4.0, 0.7, 1.2), material="boards")
    scene.add("shape", type="box", min=(1.4, 0, 1.2), max=(2.4, 0.75, 2.0), material="grey")
    scene.add("shape", type="sphere", center=(1.9, 1.05, 1.6), radius=0.3, material="grey")
    scene.write()


def cloud(scene_of, folder):
    scene = scene_of(folder, "cloud", (320, 240), 64, (0, 0.4, 4.2), (0, 0.35, 0), 36)
    write_volume(folder / "cloud.vol", (128,) * 3, cloud_density())
    scene.add(
        "medium",
        name="cloud",
        absorption=0,
        scattering=24,
        phase='{ type = "henyey_greenstein", g = 0.7 }',
        density='{ file = "cloud.vol", bounds = [[-1, -0.6, -1], [1, 1.4, 1]] }',
    )
    scene.add("material", name="edge", type="pass", interior="cloud")
    scene.add("shape", type="box", min=(-1.01, -0.61, -1.01), max=(1.01, 1.41, 1.01), material="edge")
    scene.add("light", type="directional", direction=(-0.8, -1, -0.6), irradiance=(3.2, 3.0, 2.7))
    scene.add("light", type="environment", radiance=(0.25, 0.4, 0.7))
    scene.write()


def milk(scene_of, folder):
    scene = scene_of(folder, "milk", (320, 240), 128, (0.1, 0.62, 1.7), (0.05, 0.22, 0), 30)
    scene.add("medium", name="milk", scattering=(60, 66, 72), absorption=(0.05, 0.15, 0.6), phase='{ type = "henyey_greenstein", g = 0.6 }')
    scene.add("medium", name="wax", mean_free_path=(0.03, 0.02, 0.014), albedo=(0.995, 0.96, 0.85))
    scene.add("material", name="glass", type="glass", ior=1.5)
    scene.add("material", name="milk", type="glass", ior=1.33, interior="milk")
    scene.add("material", name="wax", type="rough_glass", ior=1.4, roughness=0.5, interior="wax")
    scene.diffuse("table", (0.3, 0.2, 0.13))
    scene.diffuse("wall", (0.5, 0.5, 0.52))
    scene.emissive("flame", (40, 22, 7))
    scene.emissive("window", (5, 5.5, 6))
    scene.rectangle("table", (-2, 0, 2), (4, 0, 0), (0, 0, -4))
    scene.rectangle("wall", (-2, 0, -1), (4, 0, 0), (0, 2, 0))
    scene.rectangle("window", (-1.6, 0.2, -0.9), (0, 1.4, 0), (0, 0, 2))
    scene.add("light", type="environment", radiance=(0.3, 0.35, 0.45))
    glass, inside, candle = Mesh(), Mesh(), Mesh()
    tip = 0
    # From the middle of the foot outward, up the wall, and down within.
    glass.lathe((-0.2, 0.001, 0.01), [(tip, 0), (0.1, 0), (0.12, 0.4), (0.112, 0.4), (0.094, 0.02), (tip, 0.02)], 64)
    # The milk reaches a little into the wall.
    inside.lathe((-0.2, 0.001, 0.01), [(tip, 0.016), (0.096, 0.016), (0.108, 0.28), (tip, 0.28)], 64)
    candle.lathe((0.22, 0.001, 0.05), [(tip, 0), (0.09, 0), (0.09, 0.22), (0.07, 0.25), (tip, 0.24)], 64)
    for name, mesh in (("glass", glass), ("milk", inside), ("wax", candle)):
        scene.mesh(name, mesh, name)
    scene.add("shape", type="sphere", center=(0.22, 0.3, 0.05), radius=0.03, material="flame")
    scene.write()


def prism(scene_of, folder):
    scene = scene_of(folder, "prism", (320, 240), 16, (0, 1.6, 2.2), (0.1, 0.1, 0.1), 40)
    scene.add("material", name="prism", type="glass", ior=1.6, abbe_number=20)
    scene.diffuse("paper", (0.8, 0.8, 0.8))
    scene.diffuse("black", (0.02, 0.02, 0.02))
    scene.emissive("slit", (120, 120, 120))
    scene.add("light", type="environment", radiance=(0.02, 0.02, 0.02))
    scene.rectangle("paper", (-2, 0, 2), (4, 0, 0), (0, 0, -4))
    scene.rectangle("slit", (-1.3, 0.02, 0.29), (0, 0.45, 0), (0, 0, 0.08))
    # Two walls that let a narrow beam pass.
    scene.add("shape", type="box", min=(-0.9, 0, -1), max=(-0.86, 0.5, 0.28), material="black")
    scene.add("shape", type="box", min=(-0.9, 0, 0.38), max=(-0.86, 0.5, 1.2), material="black")
    body = Mesh()
    corners = [(0.32 * math.cos(angle), 0.32 * math.sin(angle) + 0.25) for angle in (math.pi / 2, math.pi * 7 / 6, math.pi * 11 / 6)]
    low, high = 0.002, 0.45
    for (x, z), (next_x, next_z) in zip(corners, corners[1:] + corners[:1]):
        body.quad((x, low, z), (next_x - x, 0, next_z - z), (0, high - low, 0))
    first = len(body.vertices)
    body.vertices += [(x, height, z, 0, 0) for height in (low, high) for x, z in corners]
    body.faces += [(first, first + 1, first + 2), (first + 3, first + 5, first + 4)]
    scene.mesh("body", body, "prism")
    scene.write()


ALL = {"foggy-room": fog, "cloud": cloud, "milk": milk, "prism": prism}
