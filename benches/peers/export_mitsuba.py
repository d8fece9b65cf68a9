"""Turns a scene file of gpt into a scene of Mitsuba 3.

`load(path)` gives the dictionary that mitsuba.load_dict takes; one of Mitsuba's variants must be set before.

Conventions that agree and need no translation: linear Rec.709 colours, radiance, max_depth (path edges: 1 = emitters seen directly,
2 = direct lighting), the box filter of one pixel, one-sided emission to the side the normal points to, the directions of a lat-long
map. What differs is translated here: Mitsuba's field of view (its axis is named), one-sided reflection (`twosided`), shapes given by
matrices, a blend's weight (of the second part).
"""

import mitsuba as mi
import numpy as np

import scene_file
from scene_file import METALS, Refused  # noqa: F401  METALS is used from here
from triangles import mesh

# Mitsuba's own, whose shadowing is G1·G1, or one with the height-correlated one of this project (correlated_conductor.py).
ROUGH_CONDUCTOR = "roughconductor"


def load(path, spp=None, size=None, max_depth=None, sampler="independent"):
    """The dictionary for mitsuba.load_dict; what is given overrides the file's."""
    return export(scene_file.load(path, spp, size, max_depth), sampler)


def export(scene, sampler="independent"):
    found = {"type": "scene", "integrator": integrator(scene), "sensor": sensor(scene, sampler)}
    for number, shape in enumerate(scene.shapes):
        found[f"shape_{number}"] = export_shape(shape, scene)
    for number, light in enumerate(scene.lights):
        found[f"light_{number}"] = export_light(light)
    return found


def integrator(scene):
    # Mitsuba: -1 = unlimited; its roulette cannot be switched off, but it can begin beyond the last edge.
    return {"type": "path", "max_depth": scene.max_depth or -1, "rr_depth": scene.roulette_depth or 1 << 20}


def sensor(scene, sampler):
    camera, (width, height) = scene.camera, scene.size
    return {
        "type": "perspective",
        "fov_axis": "y",
        "fov": camera["vfov"],
        "to_world": mi.ScalarTransform4f().look_at(origin=camera["position"], target=camera["look_at"], up=camera["up"]),
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
        "sampler": {"type": sampler, "sample_count": scene.spp},
    }


def colour(value, scene=None):
    if isinstance(value, dict):
        return texture(scene.textures[value["texture"]])
    return {"type": "rgb", "value": value}


def texture(texture):
    if texture["type"] == "checker":
        # A period of Mitsuba's holds two squares.
        u, v = texture["scale"]
        scale = mi.ScalarTransform3f().scale([u / 2, v / 2])
        return {"type": "checkerboard", "color0": colour(texture["a"]), "color1": colour(texture["b"]), "to_uv": scale}
    return {
        "type": "bitmap",
        "filename": str(texture["file"]),
        "to_uv": mi.ScalarTransform3f().translate([0, 1]).scale([1, -1]),  # rows count from the top there
        "raw": texture["color_space"] == "linear",
        "wrap_mode": texture["wrap"],
        "filter_type": texture["filter"],
    }


def material(entry, scene):
    """The BSDF of a material, one-sided."""
    kind = entry["type"]
    if kind == "diffuse":
        return {"type": "diffuse", "reflectance": colour(entry["reflectance"], scene)}
    if kind == "mirror":
        return {"type": "conductor", "material": "none", "specular_reflectance": colour(entry["reflectance"], scene)}
    if kind == "emissive":
        return {"type": "diffuse", "reflectance": colour([0.0] * 3)}
    if kind in ("glass", "rough_glass"):
        plugin = {"type": "dielectric"} if kind == "glass" else {"type": "roughdielectric", "distribution": "ggx", "alpha": entry["alpha"]}
        filters = {f"specular_{ours}": colour(entry[key]) for ours, key in (("reflectance", "reflectance"), ("transmittance", "transmittance"))}
        return plugin | {"int_ior": entry["ior"], "ext_ior": 1.0} | filters
    if kind == "conductor":
        return conductor(entry)
    return blend(entry, scene)


def conductor(entry):
    if entry.get("reflectance", [1.0] * 3) != [1.0] * 3:
        raise Refused("Mitsuba has no metal of a given reflectance at normal incidence, unless it is 1")
    optics = {"eta": colour(entry["eta"]), "k": colour(entry["k"])} if "eta" in entry else {"material": "none"}
    alpha = entry["alpha"]
    return optics | ({"type": "conductor"} if alpha == 0 else {"type": ROUGH_CONDUCTOR, "distribution": "ggx", "alpha": alpha})


def blend(entry, scene):
    """Mitsuba's weight is that of the second BSDF. It is right for smooth BSDFs only: delta lobes are refused."""
    first, second = (material(part, scene) for part in entry["parts"])
    if any(part["type"] in ("conductor", "dielectric", "roughdielectric") for part in (first, second)):
        raise Refused("Mitsuba's blend is wrong for delta lobes, and one-sided")
    return {"type": "blendbsdf", "weight": 1.0 - entry["weight"], "first": first, "second": second}


def export_shape(shape, scene):
    kind, to_world = shape["type"], shape["matrix"]
    if kind == "mesh" and "file" not in shape:
        return inline_mesh(shape, scene)
    if kind == "mesh":
        with shape["file"].open(encoding="utf-8") as file:
            has_normals = any(line.startswith("vn ") for line in file)
        smooth = has_normals if shape["smooth"] is None else shape["smooth"]
        result = {"type": "obj", "filename": str(shape["file"]), "face_normals": not smooth}
    elif kind == "sphere":
        result = {"type": "sphere", "center": list(shape["center"]), "radius": shape["radius"]}
    elif kind == "rectangle":
        corner, u, v = shape["corner"], shape["edge_u"], shape["edge_v"]
        normal = np.cross(u, v)
        # Mitsuba's rectangle spans [-1, 1]² and faces +z.
        result = {"type": "rectangle"}
        to_world = to_world @ columns(u / 2, v / 2, normal / np.linalg.norm(normal), corner + (u + v) / 2)
    else:
        low, high = shape["min"], shape["max"]
        result = {"type": "cube"}
        to_world = to_world @ columns(*np.diag((high - low) / 2), (low + high) / 2)
    entry = scene.materials[shape["material"]]
    emission = {"emitter": {"type": "area", "radiance": colour(entry["radiance"])}} if entry["type"] == "emissive" else {}
    return result | {"bsdf": surface(entry, scene), "to_world": mi.ScalarTransform4f(to_world)} | emission


def surface(entry, scene):
    """What reflects on the front only in Mitsuba reflects on both sides here; dielectrics have an inside."""
    bsdf = material(entry, scene)
    return bsdf if bsdf["type"] in ("dielectric", "roughdielectric") else {"type": "twosided", "bsdf": bsdf}


def inline_mesh(shape, scene):
    entry = scene.materials[shape["material"]]
    if entry["type"] == "emissive":
        raise Refused("emissive meshes within a scene file are not translated")
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(surface(entry, scene))
    found = mesh(shape)
    made = mi.Mesh("inline", len(found.positions), len(found.faces), props=properties)
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = found.positions.ravel().tolist()
    parameters["faces"] = found.faces.ravel().tolist()
    parameters.update()
    return made


def columns(x, y, z, origin):
    return np.vstack([np.column_stack([x, y, z, origin]), [0, 0, 0, 1]])


def export_light(light):
    if light["type"] == "point":
        return {"type": "point", "position": light["position"], "intensity": colour(light["intensity"])}
    if "file" in light:
        return {"type": "envmap", "bitmap": environment_map(light["file"]), "scale": light["scale"]}
    return {"type": "constant", "radiance": colour(light["radiance"])}


def environment_map(file):
    """Mitsuba's first and last row of texels lie on the poles, gpt's half a texel off them. Twice the rows and one more, those between two of the
    file their mean, interpolate to the same radiance."""
    rows = np.array(mi.Bitmap(str(file)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False))
    finer = np.empty((2 * len(rows) + 1, *rows.shape[1:]), dtype=np.float32)
    finer[1::2] = rows
    finer[2:-1:2] = (rows[1:] + rows[:-1]) / 2
    finer[0], finer[-1] = rows[0], rows[-1]
    return mi.Bitmap(finer)
