"""Turns a scene file of gpt into a scene of Mitsuba 3.

Only what both renderers define alike is translated; every other key, type or value is refused by name, so that a comparison never
compares two different scenes.

`load(path)` gives the dictionary that mitsuba.load_dict takes; one of Mitsuba's variants must be set before.

Conventions that agree and need no translation: linear Rec.709 colours, radiance, max_depth (path edges: 1 = emitters seen directly,
2 = direct lighting), the box filter of one pixel, one-sided emission to the side the normal points to. What differs is translated
here: Mitsuba's field of view (its axis is named), one-sided reflection (`twosided`), shapes given by matrices.
"""

import tomllib
from pathlib import Path

import mitsuba as mi
import numpy as np


class Refused(ValueError):
    """The scene uses something that is not translated."""


class Table:
    """A TOML table whose keys must all be taken, so that nothing is ignored."""

    def __init__(self, entries, where):
        self.entries, self.where = dict(entries), where

    def take(self, key, *default):
        if key not in self.entries and default:
            return default[0]
        if key not in self.entries:
            raise Refused(f"{self.where}: `{key}` is missing")
        return self.entries.pop(key)

    def only(self, key, allowed, default):
        value = self.take(key, default)
        if value not in allowed:
            raise Refused(f"{self.where}: `{key}` = {value!r} is not translated")
        return value

    def finish(self):
        if self.entries:
            raise Refused(f"{self.where}: `{next(iter(self.entries))}` is not translated")


def load(path, spp=None):
    """The dictionary for mitsuba.load_dict; `spp` overrides the file's."""
    path = Path(path)
    root = Table(tomllib.loads(path.read_text(encoding="utf-8")), path.name)
    film = Table(root.take("film", {}), "[film]")
    render = Table(root.take("render", {}), "[render]")
    scene = {
        "type": "scene",
        "integrator": integrator(render),
        "sensor": sensor(Table(root.take("camera"), "[camera]"), film, render.take("spp", 256) if spp is None else spp),
    }
    render.take("spp", None)
    # Both estimate the same integral whatever points and strategies they take.
    for key in ("sampler", "estimator", "heuristic", "seed"):
        render.take(key, None)
    materials = {}
    for table in root.take("material", []):
        table = Table(table, f"material {table.get('name')!r}")
        name = table.take("name")
        materials[name] = material(table)
    for number, table in enumerate(root.take("shape", [])):
        scene[f"shape_{number}"] = shape(Table(table, f"shape {number + 1}"), materials, path.parent)
    for number, table in enumerate(root.take("light", [])):
        scene[f"light_{number}"] = light(Table(table, f"light {number + 1}"))
    for table in (film, render, root):
        table.finish()
    return scene


def integrator(render):
    depth, roulette = render.take("max_depth", 16), render.take("roulette_depth", 5)
    # Mitsuba: -1 = unlimited; its roulette cannot be switched off, but it can begin beyond the last edge.
    return {"type": "path", "max_depth": depth if depth > 0 else -1, "rr_depth": roulette if roulette > 0 else 1 << 20}


def sensor(camera, film, spp):
    width, height = film.take("size", [512, 512])
    pixel_filter = Table(film.take("filter", {"type": "box"}), "[film] filter")
    pixel_filter.only("type", ["box"], "box")
    pixel_filter.only("radius", [0.5], 0.5)
    pixel_filter.finish()
    result = {
        "type": "perspective",
        "fov_axis": "y",
        "fov": float(camera.take("vfov", 40.0)),
        "to_world": mi.ScalarTransform4f().look_at(
            origin=camera.take("position"), target=camera.take("look_at"), up=camera.take("up", [0, 1, 0])
        ),
        "near_clip": 1e-3,
        "far_clip": 1e6,
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": "independent", "sample_count": spp},
    }
    camera.finish()
    return result


def colour(value):
    if isinstance(value, dict):
        raise Refused("textures are not translated")
    return {"type": "rgb", "value": [float(part) for part in value] if isinstance(value, list) else [float(value)] * 3}


def material(table):
    """A material as its BSDF, and what it emits or None."""
    kind = table.take("type")
    emitter = None
    if kind == "diffuse":
        bsdf = {"type": "diffuse", "reflectance": colour(table.take("reflectance"))}
    elif kind == "mirror":
        bsdf = {"type": "conductor", "material": "none", "specular_reflectance": colour(table.take("reflectance", 1.0))}
    elif kind == "glass":
        bsdf = {
            "type": "dielectric",
            "int_ior": float(table.take("ior", 1.5)),
            "ext_ior": 1.0,
            "specular_reflectance": colour(table.take("reflectance", 1.0)),
            "specular_transmittance": colour(table.take("transmittance", 1.0)),
        }
    elif kind == "emissive":
        table.only("two_sided", [False], False)
        bsdf = {"type": "diffuse", "reflectance": colour(0.0)}
        emitter = {"type": "area", "radiance": colour(table.take("radiance"))}
    else:
        raise Refused(f"{table.where}: type `{kind}` is not translated")
    table.finish()
    return bsdf if kind == "glass" else {"type": "twosided", "bsdf": bsdf}, emitter


def shape(table, materials, folder):
    kind = table.take("type")
    to_world = transform(table.take("transform", []))
    if kind == "mesh":
        file = folder / table.take("file")
        if not file.is_file():
            raise FileNotFoundError(f"the model {file} is not there")
        has_normals = any(line.startswith("vn ") for line in file.open(encoding="utf-8"))
        smooth = table.take("smooth", has_normals)
        result = {"type": "obj", "filename": str(file), "face_normals": not smooth}
    elif kind == "sphere":
        result = {"type": "sphere", "center": table.take("center"), "radius": float(table.take("radius"))}
    elif kind == "rectangle":
        corner, u, v = (np.array(table.take(key), dtype=float) for key in ("corner", "edge_u", "edge_v"))
        normal = np.cross(u, v)
        # Mitsuba's rectangle spans [-1, 1]² and faces +z.
        result = {"type": "rectangle"}
        to_world = to_world @ columns(u / 2, v / 2, normal / np.linalg.norm(normal), corner + (u + v) / 2)
    elif kind == "box":
        low, high = (np.array(table.take(key), dtype=float) for key in ("min", "max"))
        result = {"type": "cube"}
        to_world = to_world @ columns(*np.diag((high - low) / 2), (low + high) / 2)
    else:
        raise Refused(f"{table.where}: type `{kind}` is not translated")
    name = table.take("material")
    if name not in materials:
        raise Refused(f"{table.where}: there is no material `{name}`")
    bsdf, emitter = materials[name]
    table.finish()
    result |= {"bsdf": bsdf, "to_world": mi.ScalarTransform4f(to_world)}
    return result if emitter is None else result | {"emitter": emitter}


def columns(x, y, z, origin):
    return np.vstack([np.column_stack([x, y, z, origin]), [0, 0, 0, 1]])


def transform(steps):
    """The matrix of a list of steps, the first applied first, or of a `matrix`."""
    if isinstance(steps, dict):
        matrix = Table(steps, "transform")
        result = np.array(matrix.take("matrix"), dtype=float).reshape(4, 4)
        matrix.finish()
        return result
    result = np.eye(4)
    for entries in steps:
        step = Table(entries, "transform")
        factors = mi.ScalarTransform4f()
        if "scale" in entries:
            scale = step.take("scale")
            factors = factors.scale(scale if isinstance(scale, list) else [scale] * 3)
        elif "rotate" in entries:
            factors = factors.rotate(step.take("rotate"), step.take("degrees"))
        else:
            factors = factors.translate(step.take("translate"))
        step.finish()
        result = np.array(factors.matrix) @ result
    return result


def light(table):
    kind = table.take("type")
    if kind == "environment":
        result = {"type": "constant", "radiance": colour(table.take("radiance"))}
        table.take("rotate", None)  # a constant looks the same from every side
    elif kind == "point":
        result = {"type": "point", "position": table.take("position"), "intensity": colour(table.take("intensity"))}
    else:
        raise Refused(f"{table.where}: type `{kind}` is not translated")
    table.finish()
    return result
