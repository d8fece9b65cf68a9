#!/usr/bin/env python3
"""Makes the scenes that light sampling and indirect light are judged by, and scenes of media, from parameters; needs Python 3.11 and nothing beyond it.

  benches/scenes/make.py [NAME…] [--out FOLDER]     all, or those named, into FOLDER [target/scenes]

  lamps         a house of 64 rooms with 1,000 emitters of several shapes, sizes and powers; most are hidden from most places
  interior      a furnished room of some 70,000 triangles, textured, lit through a window and by lamps behind shades
  ajar          a room that light reaches through a door ajar alone (after Veach)
  sponza-like   a colonnade of two floors round a court, some 80,000 triangles and 10 textures, under sky, sun and one small lamp
  foggy-room    a room full of fog, with two lamps and a shaft of light
  cloud         a cloud of 128³ voxels under sun and sky
  milk          a glass of milk, and a candle
  prism         a beam of light that a prism spreads into its colours
  canopy        a tree whose 6,000 leaves are cut out of squares by a picture, under a sky with a hazy sun

Scene files, meshes and textures are the same from run to run.
"""

import functools
import math
import pathlib
import random
import sys

import media
from meshes import Mesh, grain, mottled, stripes, write_png, write_sky

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Scene:
    """A scene file in the making, and the files that it names."""

    def __init__(self, folder, name, size, depth, camera, look_at, vfov):
        self.folder, self.name, self.files = folder, name, 0
        self.text = [
            f"[film]\nsize = [{size[0]}, {size[1]}]\n",
            f"[render]\nspp = 64\nmax_depth = {depth}\n",
            f"[camera]\nposition = {list(camera)}\nlook_at = {list(look_at)}\nvfov = {vfov}\n",
        ]

    def add(self, table, **keys):
        lines = [f"[[{table}]]"]
        for key, value in keys.items():
            if isinstance(value, (list, tuple)):
                value = "[" + ", ".join(f"{number:.6g}" for number in value) + "]"
            elif isinstance(value, bool):
                value = str(value).lower()
            elif isinstance(value, str) and not value.startswith("{"):
                value = f'"{value}"'
            lines.append(f"{key} = {value}")
        self.text.append("\n".join(lines) + "\n")

    def around_camera(self, medium):
        self.text[2] += f'medium = "{medium}"\n'

    def diffuse(self, name, colour):
        self.add("material", name=name, type="diffuse", reflectance=colour)

    def textured(self, name, colour, side=256):
        """A diffuse material with a picture of its own."""
        file = f"{self.name}-{name}.png"
        write_png(self.folder / file, side, side, colour)
        self.add("texture", name=name, type="image", file=file)
        self.add("material", name=name, type="diffuse", reflectance=f'{{ texture = "{name}" }}')

    def emissive(self, name, radiance):
        self.add("material", name=name, type="emissive", radiance=radiance)

    def mesh(self, name, mesh, material):
        file = f"{self.name}-{name}.ply"
        mesh.write(self.folder / file)
        self.files += len(mesh.faces)
        self.add("shape", type="mesh", file=file, material=material, smooth=False)

    def sky(self, zenith, horizon, ground, sun=None):
        file = f"{self.name}-sky.hdr"
        write_sky(self.folder / file, zenith, horizon, ground, sun)
        # Rows as Mitsuba has them, so that both see the same sky.
        self.add("light", type="environment", file=file, rows="to_poles")

    def rectangle(self, material, corner, u, v, **keys):
        self.add("shape", type="rectangle", corner=corner, edge_u=u, edge_v=v, material=material, **keys)

    def write(self):
        path = self.folder / f"{self.name}.toml"
        path.write_text("# Made by benches/scenes/make.py.\n\n" + "\n".join(self.text), encoding="utf-8")
        print(f"{path}: {self.files:,} triangles")


def lamps(folder):
    scene = Scene(folder, "lamps", (256, 256), 6, (13.2, 1.7, 15.6), (15.6, 1.0, 12.5), 62)
    scene.diffuse("plaster", (0.72, 0.7, 0.66))
    scene.diffuse("boards", (0.42, 0.3, 0.2))
    scene.diffuse("grey", (0.5, 0.5, 0.5))
    rooms, side, height = 8, 4.0, 2.8
    wide = rooms * side
    scene.rectangle("boards", (0, 0, wide), (wide, 0, 0), (0, 0, -wide))
    scene.rectangle("plaster", (0, height, 0), (wide, 0, 0), (0, 0, wide))

    def wall(start, along, length):
        scene.rectangle("plaster", start, [length * a for a in along], (0, height, 0))

    for line in range(rooms + 1):
        for room in range(rooms):
            for along, start in (((1, 0, 0), (room * side, 0, line * side)), ((0, 0, 1), (line * side, 0, room * side))):
                at = lambda distance, y=0.0: [s + distance * a + (y if axis == 1 else 0) for axis, (s, a) in enumerate(zip(start, along))]
                if line in (0, rooms):
                    wall(at(0), along, side)
                    continue
                # A door of 0.9 × 2.1 at one end of the wall or the other.
                gap = 0.4 if (room + line) % 2 else side - 1.3
                wall(at(0), along, gap)
                wall(at(gap + 0.9), along, side - gap - 0.9)
                scene.rectangle("plaster", at(gap, 2.1), [0.9 * a for a in along], (0, height - 2.1, 0))
    generator = random.Random(5)
    tints = [(1.0, 0.78, 0.5), (1.0, 0.92, 0.8), (0.8, 0.9, 1.0), (1.0, 0.6, 0.35)]
    count = 0
    for room in range(rooms * rooms):
        x, z = (room % rooms) * side, (room // rooms) * side
        # A table with a ball on it.
        tx, tz = x + generator.uniform(1.2, 2.8), z + generator.uniform(1.2, 2.8)
        scene.add("shape", type="box", min=(tx - 0.5, 0.68, tz - 0.35), max=(tx + 0.5, 0.74, tz + 0.35), material="boards")
        scene.add("shape", type="sphere", center=(tx, 0.92, tz), radius=0.18, material="grey")
        for number in range(1000 * (room + 1) // 64 - 1000 * room // 64):
            # No two lie in one plane: where they overlap, one is before the other.
            lift = 1e-4 * number
            size = 0.02 * 8 ** generator.random()
            power = 0.4 * 60 ** generator.random()
            kind = generator.choice(("sphere", "disk", "rectangle", "triangle"))
            area = {"sphere": 4 * math.pi, "disk": math.pi, "rectangle": 4.0, "triangle": 2.0}[kind] * size * size
            name = f"lamp {count}"
            scene.emissive(name, [power / (math.pi * area) * c for c in generator.choice(tints)])
            px, pz = (generator.uniform(0.3, side - 0.3) for _ in range(2))
            if kind == "sphere":
                py = generator.uniform(0.3, height - 0.2)
                scene.add("shape", type="sphere", center=(x + px, py, z + pz), radius=size, material=name)
            elif kind == "disk":
                scene.add("shape", type="disk", center=(x + px, height - 0.01 - lift, z + pz), normal=(0, -1, 0), radius=size, material=name)
            elif kind == "rectangle":
                # On a wall, facing into the room.
                y = generator.uniform(1.2, 2.4)
                if generator.random() < 0.5:
                    scene.rectangle(name, (x + px, y, z + 0.02 + lift), (2 * size, 0, 0), (0, 2 * size, 0))
                else:
                    scene.rectangle(name, (x + side - 0.02 - lift, y, z + pz), (0, 0, 2 * size), (0, 2 * size, 0))
            else:
                points = [[x + px + size * math.cos(a), 1.9 + lift, z + pz + size * math.sin(a)] for a in (0.0, 2.1, 4.2)]
                scene.add("shape", type="mesh", material=name)
                lines = ", ".join("[" + ", ".join(f"{c:.5f}" for c in point) + "]" for point in points)
                scene.text[-1] += f"positions = [{lines}]\nfaces = [[0, 1, 2]]\n"
            count += 1
    scene.write()


def room_walls(scene, low, high, wall, floor, ceiling):
    """A closed room seen from within; the floor's and the walls' fronts face it."""
    (x, y, z), (a, b, c) = low, [h - l for l, h in zip(low, high)]
    for name, material, corner, u, v in (
        ("floor", floor, (x, y, z + c), (a, 0, 0), (0, 0, -c)),
        ("ceiling", ceiling, (x, y + b, z), (a, 0, 0), (0, 0, c)),
        ("back", wall, (x, y, z), (a, 0, 0), (0, b, 0)),
        ("front", wall, (x + a, y, z + c), (-a, 0, 0), (0, b, 0)),
        ("right", wall, (x + a, y, z), (0, 0, c), (0, b, 0)),
    ):
        mesh = Mesh()
        mesh.quad(corner, u, v, 0.5)
        scene.mesh(name, mesh, material)


def interior(folder):
    scene = Scene(folder, "interior", (320, 240), 8, (2.6, 1.5, 2.4), (-0.6, 0.9, -1.2), 58)
    scene.textured("boards", grain((0.5, 0.33, 0.2), 1))
    scene.textured("wallpaper", stripes((0.72, 0.7, 0.62), (0.66, 0.66, 0.6), 12, 3))
    scene.textured("rug", stripes((0.55, 0.16, 0.13), (0.2, 0.18, 0.3), 9, 5))
    scene.textured("linen", mottled((0.62, 0.6, 0.52), 0.15, 7, 64))
    scene.textured("oak", grain((0.4, 0.26, 0.15), 9))
    scene.diffuse("white", (0.8, 0.8, 0.78))
    scene.diffuse("paper", (0.78, 0.7, 0.58))
    scene.add("material", name="brass", type="conductor", preset="gold", roughness=0.45, masking="separable")
    scene.add("material", name="glaze", type="plastic", reflectance=(0.1, 0.28, 0.3))
    scene.add("material", name="gone", type="pass")
    scene.emissive("bulb", (500, 400, 280))
    room_walls(scene, (-3, 0, -2.6), (3, 2.7, 2.8), "wallpaper", "boards", "white")
    left = Mesh()
    # The window's wall, in four pieces about it.
    for corner, v, w in (((-3, 0, 2.8), -5.4, 0.9), ((-3, 2.1, 2.8), -5.4, 0.6), ((-3, 0.9, 2.8), -2.2, 1.2), ((-3, 0.9, -0.9), -1.7, 1.2)):
        left.quad(corner, (0, 0, v), (0, w, 0), 0.5)
    scene.mesh("left", left, "wallpaper")
    frame = Mesh()
    for low, high in (((-3.06, 0.86, -0.95), (-2.94, 0.92, 0.65)), ((-3.06, 2.08, -0.95), (-2.94, 2.14, 0.65)), ((-3.05, 0.9, -0.19), (-2.97, 2.1, -0.11))):
        frame.box(low, high)
    scene.mesh("frame", frame, "white")
    scene.rectangle("gone", (-3, 0.9, -0.9), (0, 0, 1.5), (0, 1.2, 0), portal=True)
    curtains = Mesh()
    for start in (-1.5, 0.55):
        fold = lambda s, t, start=start: (-2.85 + 0.05 * math.sin(50 * s + 2 * t), 0.1 + 2.25 * t, start + 0.65 * s)
        curtains.grid(90, 50, fold)
    scene.mesh("curtains", curtains, "linen")
    rug = Mesh()
    bump = lambda s, t: 0.012 + 0.006 * math.sin(90 * s) * math.sin(70 * t)
    rug.grid(80, 60, lambda s, t: (-1.6 + 2.6 * s, bump(s, t), 0.9 - 2.0 * t))
    scene.mesh("rug", rug, "rug")
    sofa = Mesh()
    for center, half in (
        ((-0.9, 0.28, -1.9), (1.05, 0.2, 0.45)), ((-0.9, 0.7, -2.3), (1.05, 0.42, 0.16)),
        ((-2.0, 0.45, -1.9), (0.16, 0.34, 0.48)), ((0.2, 0.45, -1.9), (0.16, 0.34, 0.48)),
        ((-1.4, 0.75, -2.0), (0.26, 0.22, 0.1)), ((-0.4, 0.75, -2.0), (0.26, 0.22, 0.1)),
    ):
        sofa.cushion(center, half, 32)
    scene.mesh("sofa", sofa, "linen")
    wood = Mesh()
    wood.box((-1.3, 0.38, -0.6), (0.1, 0.43, 0.2))
    for x in (-1.25, -0.0):
        for z in (-0.55, 0.15):
            wood.box((x, 0.0, z - 0.03), (x + 0.05, 0.38, z + 0.03))
    # Shelves on the right wall, and a side table.
    for level in range(6):
        wood.box((2.6, 0.15 + 0.4 * level, -2.3), (2.98, 0.18 + 0.4 * level, -0.3))
    for z in (-2.34, -0.3):
        wood.box((2.6, 0.0, z), (2.98, 2.2, z + 0.04))
    wood.box((0.75, 0.5, -2.3), (1.35, 0.54, -1.7))
    wood.lathe((1.05, 0, -2.0), [(0.2, 0), (0.04, 0.05), (0.04, 0.5)], 24)
    scene.mesh("wood", wood, "oak")
    generator = random.Random(11)
    for kind in range(4):
        books = Mesh()
        for level in range(5):
            z = -2.25
            while z < -0.4:
                thick, tall = generator.uniform(0.02, 0.05), generator.uniform(0.2, 0.34)
                if generator.randrange(4) == kind:
                    books.box((2.68, 0.18 + 0.4 * level, z), (2.68 + generator.uniform(0.16, 0.24), 0.18 + 0.4 * level + tall, z + thick))
                z += thick + 0.003
        scene.diffuse(f"book {kind}", [(0.5, 0.12, 0.1), (0.1, 0.22, 0.35), (0.6, 0.5, 0.3), (0.12, 0.28, 0.14)][kind])
        scene.mesh(f"books-{kind}", books, f"book {kind}")
    vase = Mesh()
    vase.lathe((-0.5, 0.43, -0.2), [(0.06 + 0.05 * math.sin(2.6 * h / 40 + 0.4) ** 3, 0.3 * h / 40) for h in range(41)], 96)
    scene.mesh("vase", vase, "glaze")
    plant = Mesh()
    for leaf in range(160):
        turn, rise, reach = generator.uniform(0, 6.28), generator.uniform(0.3, 1.3), generator.uniform(0.2, 0.5)

        def blade(s, t, turn=turn, rise=rise, reach=reach):
            out, wide = reach * t, (0.003 + 0.06 * math.sin(math.pi * t)) * (s - 0.5)
            return (
                2.4 + out * math.cos(turn) - wide * math.sin(turn),
                0.35 + rise * t * (1.5 - 0.8 * t),
                0.35 + out * math.sin(turn) + wide * math.cos(turn),
            )

        plant.grid(4, 14, blade)
    scene.diffuse("leaf", (0.12, 0.3, 0.08))
    scene.mesh("plant", plant, "leaf")
    pot = Mesh()
    pot.lathe((2.4, 0, 0.35), [(0.14, 0), (0.2, 0.36), (0.17, 0.36), (0.13, 0.04)], 48)
    scene.mesh("pot", pot, "glaze")
    shades, metal = Mesh(), Mesh()
    for x, y, z in ((1.05, 0.54, -2.0), (-2.5, 1.25, 1.9)):
        shades.lathe((x, y, z), [(0.2 - 0.08 * h / 24, 0.22 + 0.26 * h / 24) for h in range(25)], 72)
        metal.lathe((x, y if y < 1 else 0, z), [(0.09, 0), (0.02, 0.02), (0.015, 0.26 + (0 if y < 1 else y))], 32)
        scene.add("shape", type="sphere", center=(x, y + 0.33, z), radius=0.04, material="bulb")
    scene.mesh("shades", shades, "paper")
    scene.mesh("metal", metal, "brass")
    scene.sky((5.5, 8.5, 16), (15, 15.5, 16), (3, 2.7, 2.3))
    scene.write()


def ajar(folder):
    scene = Scene(folder, "ajar", (320, 240), 10, (0.9, 1.5, 3.2), (-0.5, 0.85, -0.8), 50)
    scene.textured("boards", grain((0.5, 0.36, 0.24), 21))
    scene.diffuse("plaster", (0.75, 0.73, 0.7))
    scene.diffuse("door", (0.45, 0.3, 0.2))
    scene.add("material", name="glaze", type="plastic", reflectance=(0.6, 0.15, 0.1))
    scene.add("material", name="steel", type="conductor", preset="aluminium", roughness=0.4, masking="separable")
    scene.add("material", name="glass", type="glass", ior=1.5)
    scene.emissive("lamp", (900, 830, 730))
    # The dark room, whose left wall has the door; and the bright one behind it.
    room_walls(scene, (-2, 0, -2), (2, 2.6, 3.8), "plaster", "boards", "plaster")
    bright = Mesh()
    bright.quad((-6, 0, 2), (4, 0, 0), (0, 0, -4), 0.5)
    bright.quad((-6, 2.6, -2), (4, 0, 0), (0, 0, 4), 0.5)
    bright.quad((-6, 0, -2), (4, 0, 0), (0, 2.6, 0))
    bright.quad((-2, 0, 2), (-4, 0, 0), (0, 2.6, 0))
    bright.quad((-6, 0, 2), (0, 0, -4), (0, 2.6, 0))
    scene.mesh("bright", bright, "plaster")
    wall = Mesh()
    for x in (-2.0, -2.1):
        for corner, v, w in (((x, 0, 3.8), -3.8, 2.6), ((x, 0, -0.95), -1.05, 2.6), ((x, 2.1, 0), -0.95, 0.5)):
            wall.quad(corner, (0, 0, v), (0, w, 0))
    scene.mesh("wall", wall, "plaster")
    turn = math.radians(24)
    scene.add("shape", type="box", min=(-2.07, 0.01, -0.94), max=(-2.03, 2.09, 0.0), material="door")
    scene.text[-1] += f"transform = [{{ translate = [2.05, 0, 0.95] }}, {{ rotate = [0, 1, 0], degrees = {math.degrees(turn):.4f} }}, {{ translate = [-2.05, 0, -0.95] }}]\n"
    scene.rectangle("lamp", (-4.6, 2.55, -0.4), (0.8, 0, 0), (0, 0, 0.8))
    table = Mesh()
    table.box((-0.9, 0.7, -1.2), (0.9, 0.75, -0.2))
    for x in (-0.88, 0.82):
        for z in (-1.17, -0.3):
            table.box((x, 0, z), (x + 0.06, 0.7, z + 0.06))
    scene.mesh("table", table, "boards")
    # A pot, a bowl and a ball on it.
    pot = Mesh()
    pot.lathe((-0.5, 0.75, -0.7), [(0.02 + 0.16 * math.sin(math.pi * (0.12 + 0.8 * h / 48)), 0.3 * h / 48) for h in range(49)], 96)
    scene.mesh("pot", pot, "glaze")
    bowl = Mesh()
    bowl.lathe((0.05, 0.75, -0.6), [(0.05 + 0.14 * math.sin(0.5 * math.pi * h / 24), 0.14 * (h / 24) ** 2) for h in range(25)], 96)
    scene.mesh("bowl", bowl, "steel")
    scene.add("shape", type="sphere", center=(0.52, 0.9, -0.7), radius=0.15, material="glass")
    scene.write()


def sponza_like(folder):
    scene = Scene(folder, "sponza-like", (320, 240), 7, (6.3, 1.7, 0.7), (-3.0, 3.2, -0.5), 66)
    for name, colour in (
        ("flags", mottled((0.5, 0.47, 0.42), 0.2, 31, 32, (4, 4))),
        ("brick", mottled((0.55, 0.38, 0.28), 0.2, 33, 32, (6, 14))),
        ("stone", mottled((0.62, 0.58, 0.5), 0.14, 35, 48)),
        ("base", mottled((0.5, 0.48, 0.45), 0.2, 37, 24)),
        ("plaster", mottled((0.7, 0.66, 0.56), 0.1, 39, 24)),
        ("beams", grain((0.35, 0.22, 0.13), 41)),
        ("tiles", mottled((0.6, 0.3, 0.2), 0.25, 43, 32, (8, 8))),
        ("red", stripes((0.5, 0.08, 0.08), (0.42, 0.06, 0.07), 14, 45)),
        ("green", stripes((0.08, 0.3, 0.16), (0.06, 0.25, 0.14), 14, 47)),
        ("blue", stripes((0.08, 0.14, 0.42), (0.06, 0.12, 0.36), 14, 49)),
    ):
        scene.textured(name, colour)
    scene.emissive("lamp", (300, 210, 120))
    # The court is 14 × 6; galleries of depth 2.6 run round it on two floors.
    a, b, deep, storey = 7.0, 3.0, 2.6, 3.6
    floors, walls, roof = Mesh(), Mesh(), Mesh()
    floors.grid(60, 40, lambda s, t: ((2 * s - 1) * (a + deep), 0.008 * math.sin(40 * s) * math.sin(31 * t), (1 - 2 * t) * (b + deep)), (8, 5))
    gallery = Mesh()
    for level in (1, 2):
        y = level * storey
        for low, high in (
            ((-a - deep, y - 0.2, -b - deep), (a + deep, y, -b)), ((-a - deep, y - 0.2, b), (a + deep, y, b + deep)),
            ((-a - deep, y - 0.2, -b), (-a, y, b)), ((a, y - 0.2, -b), (a + deep, y, b)),
        ):
            gallery.box(low, high, 0.5)
    scene.mesh("galleries", gallery, "plaster")
    tall = 2 * storey + 1.0
    walls.quad((-a - deep, 0, -b - deep), (2 * (a + deep), 0, 0), (0, tall, 0), 0.4)
    walls.quad((a + deep, 0, b + deep), (-2 * (a + deep), 0, 0), (0, tall, 0), 0.4)
    walls.quad((-a - deep, 0, b + deep), (0, 0, -2 * (b + deep)), (0, tall, 0), 0.4)
    walls.quad((a + deep, 0, -b - deep), (0, 0, 2 * (b + deep)), (0, tall, 0), 0.4)
    scene.mesh("floor", floors, "flags")
    scene.mesh("walls", walls, "brick")
    for side in (-1, 1):
        slope = lambda s, t, side=side: ((2 * s - 1) * (a + deep), 2 * storey + 0.1 + 1.0 * t + 0.03 * math.sin(240 * s), side * (b - 0.3 + (deep + 0.3) * t))
        roof.grid(200, 10, slope, (12, 2))
    scene.mesh("roof", roof, "tiles")
    columns, bases, arches, rails = Mesh(), Mesh(), Mesh(), Mesh()
    places = [(-a + 2 * a * i / 7, z) for i in range(8) for z in (-b, b)] + [(x, -b + 2 * b * i / 3) for i in (1, 2) for x in (-a, a)]
    shaft = [(0.2 * (1 - 0.12 * h / 10), 0.3 + 1.9 * h / 10) for h in range(11)]
    capital = [(0.18, 2.2), (0.21, 2.24), (0.19, 2.3), (0.26, 2.4), (0.3, 2.5), (0.3, 2.56)]
    foot = [(0.3, 0), (0.3, 0.1), (0.27, 0.14), (0.28, 0.2), (0.22, 0.26), (0.2, 0.3)]
    for level in range(2):
        y = level * storey
        for x, z in places:
            columns.lathe((x, y, z), shaft + capital, 28, (2, 3))
            bases.lathe((x, y, z), foot, 28, (2, 1))
        # Arches from column to column: a sheet with a half circle cut out of it, and the vault below.
        runs = [((-a + 2 * a * i / 7, z), (-a + 2 * a * (i + 1) / 7, z)) for i in range(7) for z in (-b, b)]
        runs += [((x, -b + 2 * b * i / 3), (x, -b + 2 * b * (i + 1) / 3)) for i in range(3) for x in (-a, a)]
        for (x0, z0), (x1, z1) in runs:
            spring, top = y + 2.56, y + storey - 0.2

            def face(s, t, x0=x0, z0=z0, x1=x1, z1=z1, spring=spring, top=top):
                lower = spring + 0.75 * math.sin(math.pi * s) ** 0.6
                return x0 + (x1 - x0) * s, lower + (top - lower) * t, z0 + (z1 - z0) * s

            arches.grid(28, 3, face, (2, 1))
            across = (0.3 if z0 == z1 else 0, 0.3 if x0 == x1 else 0)

            def soffit(s, t, x0=x0, z0=z0, x1=x1, z1=z1, spring=spring, across=across):
                wide = 2 * t - 1
                return x0 + (x1 - x0) * s + wide * across[1], spring + 0.75 * math.sin(math.pi * s) ** 0.6, z0 + (z1 - z0) * s + wide * across[0]

            arches.grid(28, 2, soffit, (2, 1))
            if level == 1:
                for step in range(1, 8):
                    s = step / 8
                    x, z = x0 + (x1 - x0) * s, z0 + (z1 - z0) * s
                    rails.lathe((x, y, z), [(0.05, 0), (0.03, 0.1), (0.07, 0.3), (0.03, 0.6), (0.05, 0.75)], 14)
                low = (min(x0, x1) - 0.06, y + 0.75, min(z0, z1) - 0.06)
                rails.box(low, (max(x0, x1) + 0.06, y + 0.85, max(z0, z1) + 0.06))
    scene.mesh("columns", columns, "stone")
    scene.mesh("bases", bases, "base")
    scene.mesh("arches", arches, "plaster")
    scene.mesh("rails", rails, "stone")
    beams = Mesh()
    for level in (1, 2):
        for i in range(40):
            x = -a - deep + 2 * (a + deep) * (i + 0.5) / 40
            for z in (-b - deep, b):
                beams.box((x - 0.06, level * storey - 0.36, z), (x + 0.06, level * storey - 0.2, z + deep))
    scene.mesh("beams", beams, "beams")
    for index, colour in enumerate(("red", "green", "blue", "red")):
        cloth, x = Mesh(), -5.0 + 3.0 * index
        hang = lambda s, t, x=x: (x - 0.6 + 1.2 * s, storey + 0.2 + 2.6 * t, b + 0.12 * math.sin(18 * s + 3 * t) * (1 - 0.6 * t))
        cloth.grid(60, 40, hang)
        scene.mesh(f"cloth-{index}", cloth, colour)
    scene.add("shape", type="sphere", center=(-5.0, 2.2, -4.2), radius=0.06, material="lamp")
    scene.sky((0.5, 0.8, 1.7), (1.2, 1.3, 1.5), (0.2, 0.18, 0.15))
    scene.add("light", type="directional", direction=[-0.254, -0.902, -0.3493], irradiance=(14, 12.6, 10.5))
    scene.write()


def canopy(folder):
    scene = Scene(folder, "canopy", (320, 240), 8, (4.6, 1.4, 6.0), (0.0, 2.1, 0.0), 44)
    # A leaf with a notch, and its stalk: whole texels, so that a cut-out is 0 or 1 for everybody.
    inside = lambda u, v: abs(u - 0.5) < 0.42 * math.sin(math.pi * min(1, v * 0.98 + 0.01)) ** 0.8 * (0.7 + 0.3 * math.cos(22 * v)) or abs(u - 0.5) < 0.03
    write_png(folder / "canopy-leaf.png", 64, 64, lambda u, v: (float(inside(u, v)),) * 3)
    scene.add("texture", name="leaf", type="image", file="canopy-leaf.png", color_space="linear", filter="nearest", wrap="clamp")
    scene.textured("lawn", mottled((0.3, 0.42, 0.16), 0.3, 31))
    scene.textured("bark", grain((0.32, 0.24, 0.17), 32))
    for name, colour in (("green", (0.22, 0.45, 0.1)), ("yellow", (0.55, 0.5, 0.12))):
        scene.add("material", name=name, type="diffuse", reflectance=colour, opacity='{ texture = "leaf", channel = "r" }')
    lawn = Mesh()
    lawn.quad((-9, 0, 9), (18, 0, 0), (0, 0, -18), 0.5)
    scene.mesh("lawn", lawn, "lawn")
    bark = Mesh()
    bark.lathe((0, 0, 0), [(0.24 - 0.16 * h / 24 + 0.12 * math.exp(-h / 2), 2.6 * h / 24) for h in range(25)], 48)
    scene.mesh("bark", bark, "bark")
    place = random.Random(33)
    crown = {"green": Mesh(), "yellow": Mesh()}
    for number in range(6000):
        # Denser towards the surface of an egg.
        z, turn, out = place.uniform(-1, 1), place.uniform(0, 2 * math.pi), place.random() ** 0.25
        level = math.sqrt(1 - z * z)
        center = (1.6 * out * level * math.cos(turn), 2.7 + 1.35 * out * z, 1.6 * out * level * math.sin(turn))
        axis = [place.gauss(0, 1) for _ in range(3)]
        length = math.hypot(*axis)
        u = [0.17 * part / length for part in axis]
        other = [place.gauss(0, 1) for _ in range(3)]
        along = sum(a * b for a, b in zip(u, other)) / sum(a * a for a in u)
        v = [b - along * a for a, b in zip(u, other)]
        length = math.hypot(*v)
        v = [0.17 * part / length for part in v]
        corner = [c - 0.5 * (a + b) for c, a, b in zip(center, u, v)]
        # Texture coordinates are lengths times the scale: the square has the picture once.
        crown["yellow" if number % 7 == 0 else "green"].quad(corner, u, v, 1 / 0.17)
    for name, leaves in crown.items():
        scene.mesh(name, leaves, name)
    # The sun is a texel of the sky, six degrees wide: Mitsuba's shadow rays stop at masks, so it finds no light from one direction behind them.
    scene.sky((0.4, 0.65, 1.4), (0.9, 1.0, 1.2), (0.15, 0.16, 0.1), ((25, 7), (900, 820, 700)))
    scene.write()


ALL = {"lamps": lamps, "interior": interior, "ajar": ajar, "sponza-like": sponza_like, "canopy": canopy}
ALL |= {name: functools.partial(make, Scene) for name, make in media.ALL.items()}


def main(arguments):
    folder, names = ROOT / "target" / "scenes", []
    while arguments:
        word = arguments.pop(0)
        if word in ("-h", "--help"):
            print(__doc__.strip())
            return 0
        if word == "--out" and arguments:
            folder = pathlib.Path(arguments.pop(0))
        elif word in ALL:
            names.append(word)
        else:
            sys.exit(f"make.py: there is no scene {word}; there are {', '.join(ALL)}")
    folder.mkdir(parents=True, exist_ok=True)
    for name in names or ALL:
        ALL[name](folder)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
