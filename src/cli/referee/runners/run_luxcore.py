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


def texture(entry):
    name, kind = "scene.textures." + entry["name"], entry.get("type", "image")
    if kind == "image":
        only(entry, "a picture", "file", "color_space", "filter", "wrap", "scale", "offset", "rotation")
        wrap, of_texels = entry.get("wrap", "repeat"), entry.get("filter", "bilinear")
        if wrap == "mirror" or of_texels == "triangle":
            raise Unsupported(f"a picture with {wrap if wrap == 'mirror' else of_texels}")
        file = os.path.join(os.path.dirname(scene_file), entry["file"])
        is_srgb = entry.get("color_space", "srgb" if file.endswith(".png") else "linear") == "srgb"
        lines.extend([f"{name}.type = imagemap", f"{name}.file = {file}", f"{name}.gamma = {2.2 if is_srgb else 1}"])
        lines.extend([f"{name}.wrap = {wrap}", f"{name}.filter = {'nearest' if of_texels == 'nearest' else 'linear'}"])
    elif kind == "checker":
        only(entry, kind, "a", "b", "scale")
        lines.extend([f"{name}.type = checkerboard2d", f"{name}.texture1 = {colour(entry['a'])}", f"{name}.texture2 = {colour(entry['b'])}"])
    else:
        raise Unsupported(f"the texture {kind}")
    (u, v), (x, y) = entry.get("scale", [1, 1]), entry.get("offset", [0, 0])
    # v runs downward there.
    lines.extend([f"{name}.mapping.type = uvmapping2d", f"{name}.mapping.uvscale = {u} {-v}", f"{name}.mapping.uvdelta = {x} {1 - y}"])
    lines.append(f"{name}.mapping.rotation = {entry.get('rotation', 0)}")


def of_texture(value):
    """A constant colour, or the name of a texture."""
    if isinstance(value, dict):
        only(value, "a texture", "texture")
        return value["texture"]
    return colour(value)


def material(entry):
    name, kind = "scene.materials." + entry["name"], entry["type"]
    if kind == "diffuse":
        only(entry, kind, "reflectance", "opacity", "emission")
        lines.extend([f"{name}.type = matte", f"{name}.kd = {of_texture(entry['reflectance'])}"])
        if "opacity" in entry:
            lines.append(f"{name}.transparency = {of_texture(entry['opacity'])}")
        if "emission" in entry:
            lines.append(f"{name}.emission = {of_texture(entry['emission'])}")
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
        lines.extend([*black, f"{name}.emission = {of_texture(entry['radiance'])}"])
    elif kind == "pass":
        only(entry, kind)
        lines.append(f"{name}.type = null")
    elif kind == "blend":
        only(entry, kind, "materials", "weight")
        weight = entry["weight"]
        if weight.get("type") == "constant":
            only(weight, "a weight", "value")
            amount = weight["value"]
        elif weight.get("type") == "texture":
            only(weight, "a weight", "texture")
            amount = weight["texture"]
        else:
            raise Unsupported(f"a blend by {weight.get('type')}")
        first, second = entry["materials"]
        lines.extend([f"{name}.type = mix", f"{name}.material1 = {second}", f"{name}.material2 = {first}"])
        lines.append(f"{name}.amount = {amount}")
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


def transform(steps):
    """The map of points by steps, the first of which is done first."""
    whole = numpy.eye(4)
    for step in steps:
        one = numpy.eye(4)
        if set(step) == {"scale"}:
            scale = step["scale"]
            one[:3, :3] = numpy.diag(scale if isinstance(scale, list) else [scale] * 3)
        elif set(step) == {"translate"}:
            one[:3, 3] = step["translate"]
        elif set(step) == {"rotate", "degrees"}:
            axis = numpy.array(step["rotate"], dtype=float)
            x, y, z = axis / numpy.linalg.norm(axis)
            cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            angle = math.radians(step["degrees"])
            one[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
        else:
            raise Unsupported("a transform by a matrix")
        whole = one @ whole
    return whole


def shape(scene, number, entry):
    kind, name, normals, uvs = entry["type"], f"shape{number}", None, None
    move = transform(entry.pop("transform", []))
    if kind == "rectangle":
        only(entry, kind, "corner", "edge_u", "edge_v", "material")
        c, u, v = entry["corner"], entry["edge_u"], entry["edge_v"]
        points, triangles = grid(1, 1, lambda s, t: tuple(c[k] + s * u[k] + t * v[k] for k in range(3)))
        uvs = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
    elif kind == "sphere":
        only(entry, kind, "center", "radius", "material")

        def normal(s, t):
            around, down = 2 * math.pi * s, math.pi * (1 - t)
            return math.sin(down) * math.sin(around), math.cos(down), math.sin(down) * math.cos(around)

        center, radius = entry["center"], entry["radius"]
        normals, triangles = grid(512, 256, normal)
        points = [tuple(center[k] + radius * n[k] for k in range(3)) for n in normals]
    elif kind == "disk":
        only(entry, kind, "center", "normal", "radius", "material")
        normal = numpy.array(entry["normal"], dtype=float)
        normal /= numpy.linalg.norm(normal)
        along = numpy.cross(normal, [1, 0, 0] if abs(normal[0]) < 0.5 else [0, 1, 0])
        along /= numpy.linalg.norm(along)
        beside, center, radius = numpy.cross(normal, along), numpy.array(entry["center"]), entry["radius"]
        rim = [2 * math.pi * step / 4096 for step in range(4096)]
        points = [tuple(center), *(tuple(center + radius * (math.cos(a) * along + math.sin(a) * beside)) for a in rim)]
        triangles = [(0, 1 + step, 1 + (step + 1) % len(rim)) for step in range(len(rim))]
    elif kind == "box":
        only(entry, kind, "min", "max", "material")
        ends = [entry["min"], entry["max"]]
        points = [tuple(float(ends[c >> k & 1][k]) for k in range(3)) for c in range(8)]
        sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        triangles = [(a, b, c) for a, b, c, _ in sides] + [(a, c, d) for a, _, c, d in sides]
    elif kind == "mesh":
        only(entry, kind, "positions", "faces", "normals", "uvs", "material")
        points = [tuple(map(float, point)) for point in entry["positions"]]
        triangles = [tuple(face) for face in entry["faces"]]
        if "normals" in entry:
            normals = [tuple(map(float, normal)) for normal in entry["normals"]]
        if "uvs" in entry:
            uvs = [tuple(map(float, uv)) for uv in entry["uvs"]]
    else:
        raise Unsupported(f"the shape {kind}")
    points = [tuple(map(float, (move @ [*point, 1])[:3])) for point in points]
    if numpy.linalg.det(move[:3, :3]) < 0:
        triangles = [(a, c, b) for a, b, c in triangles]
    if normals:
        across = numpy.linalg.inv(move[:3, :3]).T
        normals = [tuple(map(float, turned / numpy.linalg.norm(turned))) for turned in (across @ normal for normal in normals)]
    scene.DefineMesh(name, points, triangles, normals, uvs, None, None)
    lines.extend([f"scene.objects.{name}.shape = {name}", f"scene.objects.{name}.material = {entry['material']}"])


def light(number, entry):
    name, kind = f"scene.lights.light{number}", entry["type"]
    if kind == "environment":
        only(entry, kind, "radiance", "file", "scale", "rotate")
        if "file" in entry:
            file, gain = os.path.join(os.path.dirname(scene_file), entry["file"]), entry.get("scale", 1)
            lines.extend([f"{name}.type = infinite", f"{name}.file = {file}", f"{name}.gamma = 1", f"{name}.gain = {colour(gain)}"])
            # Its pole is z there, and its left is the right.
            upright = [{"scale": [1, -1, 1]}, {"rotate": [0, 0, 1], "degrees": 90}, {"rotate": [1, 0, 0], "degrees": -90}]
            turn = transform([*upright, {"rotate": [0, 1, 0], "degrees": entry.get("rotate", 0)}])
            lines.append(f"{name}.transformation = {' '.join(map(repr, map(float, turn.T.flatten())))}")
        else:
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
    if entry.get("projection", "perspective") not in ("perspective", "orthographic"):
        raise Unsupported(f"a camera that is {entry['projection']}")
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
    only(given, "a scene", "film", "render", "camera", "texture", "material", "shape", "light")
    width, height = given["film"]["size"]
    depth = given["render"].get("max_depth", 16) or 10_000
    if depth == 1:
        raise Unsupported("a depth of one edge: two are the fewest")
    camera(given["camera"], width, height)
    for entry in given.get("texture", []):
        texture(entry)
    # Blends after what they blend.
    waiting, defined = given.get("material", []), set()
    while waiting:
        ready = [entry for entry in waiting if defined.issuperset(entry.get("materials", []))]
        for entry in ready:
            material(entry)
        defined.update(entry["name"] for entry in ready)
        waiting = [entry for entry in waiting if entry["name"] not in defined]
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
