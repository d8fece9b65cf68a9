"""Renders a scene file of the suite by LuxCore: SCENE.toml OUTPUT.exr SPP SEED. Ends with status 64 and a reason where LuxCore cannot be asked."""

import math
import os
import sys
import time
import tomllib

import numpy
import OpenEXR
import pyluxcore

scene_file, output, spp, seed = sys.argv[1:]
given = tomllib.load(open(scene_file, "rb"))
lines = []


class Unsupported(Exception):
    pass


def only(table, what, *known):
    others = set(table) - {"type", "name", *known}
    if others:
        raise Unsupported(f"{what} with {', '.join(sorted(others))}")


def colour(value):
    if isinstance(value, (int, float)):
        value = [value] * 3
    if not isinstance(value, list):
        raise Unsupported("a colour that is no constant")
    return " ".join(map(repr, map(float, value)))


def material(entry):
    name, kind = "scene.materials." + entry["name"], entry["type"]
    if kind == "diffuse":
        only(entry, kind, "reflectance")
        lines.extend([f"{name}.type = matte", f"{name}.kd = {colour(entry['reflectance'])}"])
    elif kind == "mirror":
        only(entry, kind, "reflectance")
        lines.extend([f"{name}.type = mirror", f"{name}.kr = {colour(entry.get('reflectance', 1))}"])
    elif kind == "glass":
        only(entry, kind, "ior")
        ior = f"{name}.interiorior = {entry['ior']}"
        lines.extend([f"{name}.type = glass", f"{name}.kr = 1 1 1", f"{name}.kt = 1 1 1", ior])
    elif kind == "emissive":
        only(entry, kind, "radiance")
        black = [f"{name}.type = matte", f"{name}.kd = 0 0 0"]
        lines.extend([*black, f"{name}.emission = {colour(entry['radiance'])}"])
    elif kind == "pass":
        only(entry, kind)
        lines.append(f"{name}.type = null")
    elif kind == "blend":
        only(entry, kind, "materials", "weight")
        if not isinstance(entry["weight"], (int, float)):
            raise Unsupported("a blend by another weight than a number")
        first, second = entry["materials"]
        lines.extend([f"{name}.type = mix", f"{name}.material1 = {second}", f"{name}.material2 = {first}"])
        lines.append(f"{name}.amount = {entry['weight']}")
    else:
        raise Unsupported(f"the material {kind}")


def grid(columns, rows, point):
    """Points and triangles of a surface of two parameters from 0 to 1."""
    points = [point(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            triangles += [(a, a + 1, a + columns + 2), (a, a + columns + 2, a + columns + 1)]
    return points, triangles


def shape(scene, number, entry):
    kind, name, normals = entry["type"], f"shape{number}", None
    if kind == "rectangle":
        only(entry, kind, "corner", "edge_u", "edge_v", "material")
        c, u, v = entry["corner"], entry["edge_u"], entry["edge_v"]
        points, triangles = grid(1, 1, lambda s, t: tuple(c[k] + s * u[k] + t * v[k] for k in range(3)))
    elif kind == "sphere":
        only(entry, kind, "center", "radius", "material")

        def normal(s, t):
            around, down = 2 * math.pi * s, math.pi * (1 - t)
            return math.sin(down) * math.sin(around), math.cos(down), math.sin(down) * math.cos(around)

        center, radius = entry["center"], entry["radius"]
        normals, triangles = grid(512, 256, normal)
        points = [tuple(center[k] + radius * n[k] for k in range(3)) for n in normals]
    elif kind == "mesh":
        # No material has a texture here, so texture coordinates say nothing.
        only(entry, kind, "positions", "faces", "normals", "uvs", "material")
        points = [tuple(map(float, point)) for point in entry["positions"]]
        triangles = [tuple(face) for face in entry["faces"]]
        if "normals" in entry:
            normals = [tuple(map(float, normal)) for normal in entry["normals"]]
    else:
        raise Unsupported(f"the shape {kind}")
    scene.DefineMesh(name, points, triangles, normals, None, None, None)
    lines.extend([f"scene.objects.{name}.shape = {name}", f"scene.objects.{name}.material = {entry['material']}"])


def light(number, entry):
    name, kind = f"scene.lights.light{number}", entry["type"]
    if kind == "environment":
        only(entry, kind, "radiance")
        lines.extend([f"{name}.type = constantinfinite", f"{name}.color = {colour(entry['radiance'])}"])
    elif kind == "point":
        only(entry, kind, "position", "intensity")
        lines.extend([f"{name}.type = point", f"{name}.position = {colour(entry['position'])}"])
        # The colour there is that of the flux.
        lines.extend([f"{name}.color = {colour(entry['intensity'])}", f"{name}.gain = {' '.join([repr(4 * math.pi)] * 3)}"])
    elif kind == "directional":
        only(entry, kind, "direction", "irradiance")
        lines.extend([f"{name}.type = sharpdistant", f"{name}.direction = {colour(entry['direction'])}"])
        lines.append(f"{name}.color = {colour(entry['irradiance'])}")
    else:
        raise Unsupported(f"the light {kind}")


def camera(entry, width, height):
    only(entry, "a camera", "position", "look_at", "up", "vfov", "projection", "height")
    name, half = "scene.camera", 0.5 * entry.get("height", 2)
    aspect = width / height
    lines.extend([f"{name}.type = {entry.get('projection', 'perspective')}", f"{name}.autofocus.enable = 0"])
    lines.append(f"{name}.lookat.orig = {colour(entry['position'])}")
    lines.append(f"{name}.lookat.target = {colour(entry['look_at'])}")
    lines.append(f"{name}.up = {colour(entry.get('up', [0, 1, 0]))}")
    # Rows lie one below where they belong there, and the first is black: one more is rendered, and the first cut off.
    below = -half * (1 + 2 / height)
    lines.append(f"{name}.screenwindow = {-half * aspect} {half * aspect} {below} {half}")
    if "vfov" in entry:
        lines.append(f"{name}.fieldofview = {entry['vfov']}")


try:
    pyluxcore.Init()
    scene = pyluxcore.Scene()
    only(given, "a scene", "film", "render", "camera", "material", "shape", "light")
    width, height = given["film"]["size"]
    depth = given["render"].get("max_depth", 16) or 10_000
    camera(given["camera"], width, height)
    for entry in given.get("material", []):
        material(entry)
    for number, entry in enumerate(given.get("shape", [])):
        shape(scene, number, entry)
    for number, entry in enumerate(given.get("light", [])):
        light(number, entry)
except Unsupported as reason:
    print(reason, flush=True)
    os._exit(64)

described = pyluxcore.Properties()
described.SetFromString("\n".join(lines) + "\n")
scene.Parse(described)
settings = pyluxcore.Properties()
settings.SetFromString(f"""
renderengine.type = PATHCPU
renderengine.seed = {seed}
sampler.type = RANDOM
sampler.random.adaptive.strength = 0
path.pathdepth.total = {depth}
path.pathdepth.diffuse = {depth}
path.pathdepth.glossy = {depth}
path.pathdepth.specular = {depth}
film.width = {width}
film.height = {height + 1}
film.filter.type = NONE
film.imagepipelines.0.0.type = NOP
film.outputs.0.type = RGB
film.outputs.0.filename = picture.exr
batch.haltspp = {spp}
""")
session = pyluxcore.RenderSession(pyluxcore.RenderConfig(settings, scene))
session.Start()
while not session.HasDone():
    time.sleep(0.02)
    session.UpdateStats()
session.Stop()
session.UpdateStats()
pixels = numpy.zeros((height + 1, width, 3), dtype=numpy.float32)
session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0)
# Rows come from below.
header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
OpenEXR.File(header, {"RGB": numpy.ascontiguousarray(pixels[height - 1 :: -1])}).write(output)
os._exit(0)
