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
    known = materials(root.take("material", []))
    for number, table in enumerate(root.take("shape", [])):
        scene[f"shape_{number}"] = shape(Table(table, f"shape {number + 1}"), known, path.parent)
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


# Presets of gpt: eta and k in RGB, and Mitsuba's name of the metal, whose spectra it makes into RGB by itself.
METALS = {
    "gold": ([0.143119, 0.374957, 1.44248], [3.98316, 2.38572, 1.60322], "Au"),
    "copper": ([0.200438, 0.924033, 1.10221], [3.91295, 2.45285, 2.14219], "Cu"),
    "silver": ([0.155265, 0.116723, 0.138344], [4.82835, 3.12225, 2.14696], "Ag"),
    "aluminium": ([1.65746, 0.880369, 0.521229], [9.22387, 6.26952, 4.837], "Al"),
}


def materials(tables):
    """Every material by its name: its BSDF, and what it emits or None."""
    found = {}
    for entries in tables:
        table = Table(entries, f"material {entries.get('name')!r}")
        name = table.take("name")
        bsdf, emitter = material(table, found)
        # What reflects on the front only in Mitsuba reflects on both sides here; dielectrics have an inside.
        is_closed = bsdf["type"] in ("dielectric", "roughdielectric")
        found[name] = bsdf if is_closed else {"type": "twosided", "bsdf": bsdf}, emitter
        table.finish()
    return found


def material(table, others):
    """The BSDF of a material, one-sided, and what it emits or None; `others` are those that stand before it in the file."""
    kind = table.take("type")
    if kind == "diffuse":
        return {"type": "diffuse", "reflectance": colour(table.take("reflectance"))}, None
    if kind == "mirror":
        return {"type": "conductor", "material": "none", "specular_reflectance": colour(table.take("reflectance", 1.0))}, None
    if kind == "glass":
        return dielectric("dielectric", table), None
    if kind == "rough_glass":
        table.only("distribution", ["ggx"], "ggx")
        return dielectric("roughdielectric", table) | {"distribution": "ggx", "alpha": width(table)}, None
    if kind == "conductor":
        return conductor(table), None
    if kind == "emissive":
        table.only("two_sided", [False], False)
        return {"type": "diffuse", "reflectance": colour(0.0)}, {"type": "area", "radiance": colour(table.take("radiance"))}
    if kind == "blend":
        return blend(table, others), None
    raise Refused(f"{table.where}: type `{kind}` is not translated")


def dielectric(plugin, table):
    return {
        "type": plugin,
        "int_ior": float(table.take("ior", 1.5)),
        "ext_ior": 1.0,
        "specular_reflectance": colour(table.take("reflectance", 1.0)),
        "specular_transmittance": colour(table.take("transmittance", 1.0)),
    }


def width(table, *default):
    """The width of the GGX distribution."""
    roughness = table.take("roughness", None)
    return float(table.take("alpha", *default) if roughness is None else roughness**2)


def conductor(table):
    metal = table.take("preset", None)
    eta, k = METALS[metal][:2] if metal in METALS else (table.take("eta"), table.take("k"))
    alpha = width(table, 0.0)
    return {"eta": colour(eta), "k": colour(k)} | ({"type": "conductor"} if alpha == 0 else {"type": ROUGH_CONDUCTOR, "distribution": "ggx", "alpha": alpha})


# Mitsuba's own, whose shadowing is G1·G1, or one with the height-correlated one of this project (correlated_conductor.py).
ROUGH_CONDUCTOR = "roughconductor"


def blend(table, others):
    """Mitsuba's weight is that of the second BSDF. It is right for smooth BSDFs only: delta lobes are refused."""
    parts = [others[name][0].get("bsdf") for name in table.take("materials")]
    if any(part is None or part["type"] in ("conductor", "dielectric") for part in parts):
        raise Refused(f"{table.where}: Mitsuba's blend is wrong for delta lobes, and one-sided")
    weight = Table(table.take("weight"), table.where)
    weight.only("type", ["constant"], None)
    result = {"type": "blendbsdf", "weight": 1.0 - float(weight.take("value")), "first": parts[0], "second": parts[1]}
    weight.finish()
    return result


def shape(table, known, folder):
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
    if name not in known:
        raise Refused(f"{table.where}: there is no material `{name}`")
    bsdf, emitter = known[name]
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
