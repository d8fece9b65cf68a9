"""Reads a scene file of gpt into plain values that the exporters to other renderers share.

Only what is translated is read; every other key, type or value is refused by name, so that a comparison never compares two different
scenes. What is read keeps gpt's conventions: right-handed, +Y up, linear Rec.709 colours, radiance, max_depth in path edges (1 = emitters
seen directly, 2 = direct lighting).
"""

import tomllib
from dataclasses import dataclass, field
from pathlib import Path

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


@dataclass
class Scene:
    size: tuple
    spp: int
    max_depth: int
    """Path edges; 0: no limit."""
    roulette_depth: int
    """First depth at which Russian roulette may end a path; 0: never."""
    camera: dict
    """position, look_at, up, vfov in degrees."""
    materials: dict = field(default_factory=dict)
    """By name: a dictionary with `type`; colours are lists of three numbers or {"texture": name}."""
    textures: dict = field(default_factory=dict)
    shapes: list = field(default_factory=list)
    """Dictionaries with `type`, `material` (a name), `matrix` (4 × 4, object to world) and the shape's own keys."""
    lights: list = field(default_factory=list)
    media: dict = field(default_factory=dict)
    """By name, `scattering` and `absorption` by channel and unit length, and `g`, the mean cosine."""


def load(path, spp=None, size=None, max_depth=None, exported=True):
    """The scene of a TOML file; `spp`, `size` and `max_depth` override the file's. What `gpt export` writes for those that read it, cut-outs and maps
    that end on the poles, is read only for others."""
    path = Path(path)
    root = Table(tomllib.loads(path.read_text(encoding="utf-8")), path.name)
    film, render = Table(root.take("film", {}), "[film]"), Table(root.take("render", {}), "[render]")
    pixel_filter = Table(film.take("filter", {"type": "box"}), "[film] filter")
    pixel_filter.only("type", ["box"], "box")
    pixel_filter.only("radius", [0.5], 0.5)
    own_size, own_spp, own_depth = film.take("size", [512, 512]), render.take("spp", 256), render.take("max_depth", 16)
    scene = Scene(
        size=tuple(own_size if size is None else size),
        spp=own_spp if spp is None else spp,
        max_depth=own_depth if max_depth is None else max_depth,
        roulette_depth=5 if (depth := render.take("roulette_depth", 5)) == "auto" else depth,
        camera=camera(Table(root.take("camera"), "[camera]")),
    )
    # All estimate the same integral whatever points and strategies they take.
    for key in ("sampler", "estimator", "heuristic", "seed"):
        render.take(key, None)
    for entries in root.take("texture", []):
        table = Table(entries, f"texture {entries.get('name')!r}")
        name = table.take("name")
        scene.textures[name] = texture(table, path.parent)
    for entries in root.take("medium", []):
        if exported:
            raise Refused("media are for renderers that read what `gpt export` writes")
        table = Table(entries, f"medium {entries.get('name')!r}")
        scene.media[table.take("name")] = medium(table)
        table.finish()
    for entries in root.take("material", []):
        table = Table(entries, f"material {entries.get('name')!r}")
        name = table.take("name")
        cut_out = opacity(table, scene) if "opacity" in table.entries and not exported else None
        scene.materials[name] = material(table, scene) | ({"opacity": cut_out} if cut_out else {})
    # Renderers find out by themselves what body the camera is in.
    interiors = [entry.get("interior") for entry in scene.materials.values()]
    around_camera = scene.camera.get("medium")
    if around_camera and not any(interior is scene.media[around_camera] for interior in interiors):
        raise Refused(f"no body of the medium `{around_camera}` is around the camera")
    for number, entries in enumerate(root.take("shape", [])):
        scene.shapes.append(shape(Table(entries, f"shape {number + 1}"), scene, path.parent))
    for number, entries in enumerate(root.take("light", [])):
        scene.lights.append(light(Table(entries, f"light {number + 1}"), path.parent, exported))
    for table in (pixel_filter, film, render, root):
        table.finish()
    return scene


def camera(table):
    found = {
        "position": table.take("position"),
        "look_at": table.take("look_at"),
        "up": table.take("up", [0, 1, 0]),
        "vfov": float(table.take("vfov", 40.0)),
    }
    if inside := table.take("medium", None):
        found["medium"] = inside
    table.finish()
    return found


def existing(folder, name, what):
    file = (folder / name).resolve()
    if not file.is_file():
        raise FileNotFoundError(f"the {what} {file} is not there")
    return file


def texture(table, folder):
    kind = table.only("type", ["image", "checker"], None)
    found = {"type": kind}
    if kind == "image":
        found["file"] = existing(folder, table.take("file"), "picture")
        found["color_space"] = table.take("color_space", "srgb")
        found["wrap"] = table.only("wrap", ["repeat", "clamp"], "repeat")
        found["filter"] = table.take("filter", "bilinear")
        table.only("scale", [1, [1, 1]], 1)
    else:
        found |= {key: colour(table.take(key, default), {}) for key, default in (("a", 1.0), ("b", 0.0))}
        scale = table.take("scale", 1.0)
        found["scale"] = [float(part) for part in scale] if isinstance(scale, list) else [float(scale)] * 2
    table.finish()
    return found


def colour(value, textures):
    if isinstance(value, dict):
        if value.get("texture") not in textures:
            raise Refused(f"the texture {value.get('texture')!r} is not there")
        return value
    return [float(part) for part in value] if isinstance(value, list) else [float(value)] * 3


# Presets of gpt: eta and k in RGB, and Mitsuba's name of the metal, whose spectra it makes into RGB by itself.
METALS = {
    "gold": ([0.143119, 0.374957, 1.44248], [3.98316, 2.38572, 1.60322], "Au"),
    "copper": ([0.200438, 0.924033, 1.10221], [3.91295, 2.45285, 2.14219], "Cu"),
    "silver": ([0.155265, 0.116723, 0.138344], [4.82835, 3.12225, 2.14696], "Ag"),
    "aluminium": ([1.65746, 0.880369, 0.521229], [9.22387, 6.26952, 4.837], "Al"),
}


def material(table, scene):
    kind = table.take("type")
    found = {"type": kind}
    interior = table.take("interior", None)
    if interior:
        found["interior"] = scene.media[interior]
    if kind == "pass":
        pass
    elif kind in ("diffuse", "mirror"):
        found["reflectance"] = colour(table.take("reflectance", *([1.0] if kind == "mirror" else [])), scene.textures)
    elif kind in ("glass", "rough_glass"):
        found |= {"ior": float(table.take("ior", 1.5))}
        found |= {key: colour(table.take(key, 1.0), {}) for key in ("reflectance", "transmittance")}
        if kind == "rough_glass":
            table.only("distribution", ["ggx"], "ggx")
            found["alpha"] = width(table)
    elif kind == "conductor":
        found |= conductor(table)
    elif kind == "emissive":
        table.only("two_sided", [False], False)
        found["radiance"] = colour(table.take("radiance"), {})
    elif kind == "blend":
        parts = table.take("materials")
        weight = Table(table.take("weight"), table.where)
        weight.only("type", ["constant"], None)
        found |= {"parts": [scene.materials[name] for name in parts], "weight": float(weight.take("value"))}
        weight.finish()
    else:
        raise Refused(f"{table.where}: type `{kind}` is not translated")
    table.finish()
    return found


def opacity(table, scene):
    """The name of a texture whose red channel cuts holes."""
    entries = Table(table.take("opacity"), table.where)
    entries.only("channel", ["r"], None)
    name = entries.take("texture")
    entries.finish()
    return colour({"texture": name}, scene.textures)["texture"]


def width(table, *default):
    """The width of the GGX distribution."""
    roughness = table.take("roughness", None)
    return float(table.take("alpha", *default) if roughness is None else roughness**2)


def conductor(table):
    """eta and k, or a `reflectance` at normal incidence (with Schlick's approximation), and the width."""
    alpha, metal = width(table, 0.0), table.take("preset", None)
    if "reflectance" in table.entries:
        return {"reflectance": colour(table.take("reflectance"), {}), "alpha": alpha}
    eta, k = METALS[metal][:2] if metal in METALS else (table.take("eta"), table.take("k"))
    return {"eta": colour(eta, {}), "k": colour(k, {}), "alpha": alpha}


def shape(table, scene, folder):
    kind = table.take("type")
    found = {"type": kind, "matrix": transform(table.take("transform", []))}
    if kind == "mesh" and "file" in table.entries:
        found["file"] = existing(folder, table.take("file"), "model")
        found["smooth"] = table.take("smooth", None)
    elif kind == "mesh":
        found |= {key: np.array(table.take(key)) for key in ("positions", "faces")}
    elif kind == "sphere":
        found |= {"center": np.array(table.take("center"), dtype=float), "radius": float(table.take("radius"))}
    elif kind == "rectangle":
        found |= {key: np.array(table.take(key), dtype=float) for key in ("corner", "edge_u", "edge_v")}
    elif kind == "box":
        found |= {key: np.array(table.take(key), dtype=float) for key in ("min", "max")}
    else:
        raise Refused(f"{table.where}: type `{kind}` is not translated")
    found["material"] = table.take("material")
    if found["material"] not in scene.materials:
        raise Refused(f"{table.where}: there is no material `{found['material']}`")
    table.finish()
    return found


def medium(table):
    phase = table.take("phase", {"type": "isotropic"})
    if phase["type"] not in ("isotropic", "henyey_greenstein"):
        raise Refused(f"a phase function of type `{phase['type']}` is not translated")
    if "albedo" in table.entries:
        albedo, mean_free_path = (np.array(colour(table.take(key), {})) for key in ("albedo", "mean_free_path"))
        scattering, absorption = albedo / mean_free_path, (1 - albedo) / mean_free_path
    else:
        scattering, absorption = (np.array(colour(table.take(key, 0.0), {})) for key in ("scattering", "absorption"))
    return {"scattering": scattering, "absorption": absorption, "g": float(phase.get("g", 0.0))}


def light(table, folder, exported):
    kind = table.take("type")
    if kind == "directional":
        found = {"direction": table.take("direction"), "irradiance": colour(table.take("irradiance"), {})}
    elif kind == "point":
        found = {"position": table.take("position"), "intensity": colour(table.take("intensity"), {})}
    elif kind == "environment" and "file" in table.entries:
        found = {"file": existing(folder, table.take("file"), "environment map"), "scale": float(table.take("scale", 1.0))}
        table.only("rotate", [0], 0)
        found["to_poles"] = not exported and table.only("rows", ["inside", "to_poles"], "inside") == "to_poles"
    elif kind == "environment":
        found = {"radiance": colour(table.take("radiance"), {})}
        table.take("rotate", None)  # a constant looks the same from every side
    else:
        raise Refused(f"{table.where}: type `{kind}` is not translated")
    table.finish()
    return {"type": kind} | found


def transform(steps):
    """The matrix of a list of steps, the first applied first, or of a `matrix`."""
    if isinstance(steps, dict):
        matrix = Table(steps, "transform")
        result = np.array(matrix.take("matrix"), dtype=float).reshape(4, 4)
        matrix.finish()
        return result
    result = np.eye(4)
    for entries in steps:
        table, step = Table(entries, "transform"), np.eye(4)
        if "scale" in entries:
            step[:3, :3] *= np.broadcast_to(np.array(table.take("scale"), dtype=float), 3)
        elif "rotate" in entries:
            step[:3, :3] = rotation(table.take("rotate"), table.take("degrees"))
        else:
            step[:3, 3] = table.take("translate")
        table.finish()
        result = step @ result
    return result


def rotation(axis, degrees):
    """Rodrigues' formula."""
    x, y, z = np.array(axis, dtype=float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
