"""Builds a scene of gpt in LuxCore.

LuxCore has no sphere primitive: spheres are meshes of 16,128 triangles with the sphere's normals, those that emit of 2,208. Its camera
takes the field of view across the longer side unless the screen's window is given. Its microfacet distribution is Schlick's, not GGX:
rough metals and rough glass are refused.
"""

import os

import pyluxcore

from scene_file import Refused
from triangles import mesh, spheres_columns


def build(scene):
    """The scene as pyluxcore has it."""
    width, height = scene.size
    made, properties = pyluxcore.Scene(), {}
    camera, pixel = scene.camera, 2 / height
    properties |= {
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": camera["position"],
        "scene.camera.lookat.target": camera["look_at"],
        "scene.camera.up": camera["up"],
        "scene.camera.fieldofview": camera["vfov"],
        "scene.camera.screenwindow": [-width / height, width / height, -1.0 - pixel, 1.0 - pixel],  # its rasters' rows are off by one
        "scene.camera.autofocus.enable": 0,
        "scene.camera.cliphither": 1e-3,
        "scene.camera.clipyon": 1e6,
    }
    for name, texture in scene.textures.items():
        properties |= prefixed(f"scene.textures.{name}", texture_properties(texture))
    for name, entry in scene.materials.items():
        add_material(properties, name, entry)
    for number, shape in enumerate(scene.shapes):
        add_mesh(made, f"mesh-{number}", mesh(shape, spheres_columns(scene, shape)))
        properties |= {f"scene.objects.o{number}.shape": f"mesh-{number}", f"scene.objects.o{number}.material": shape["material"]}
    for number, light in enumerate(scene.lights):
        properties |= prefixed(f"scene.lights.l{number}", light_properties(light))
    made.Parse(as_properties(properties))
    return made


def as_properties(values):
    properties = pyluxcore.Properties()
    for key, value in values.items():
        properties.Set(pyluxcore.Property(key, value))
    return properties


def prefixed(prefix, values):
    return {f"{prefix}.{key}": value for key, value in values.items()}


def texture_properties(texture):
    if texture["type"] == "checker":
        scale = {"mapping.type": "uvmapping2d", "mapping.uvscale": texture["scale"]}
        return {"type": "checkerboard2d", "texture1": texture["a"], "texture2": texture["b"]} | scale
    return {
        "type": "imagemap",
        "file": str(texture["file"]),
        "gamma": 1.0 if texture["color_space"] == "linear" else 2.2,
        "wrap": texture["wrap"],
        "filter": {"bilinear": "linear", "nearest": "nearest"}[texture["filter"]],
        "mapping.type": "uvmapping2d",
        "mapping.uvscale": [1, -1],
        "mapping.uvdelta": [0, 1],
    }


def colour(value):
    return value["texture"] if isinstance(value, dict) else value


def add_material(properties, name, entry):
    kind = entry["type"]
    if kind == "diffuse":
        found = {"type": "matte", "kd": colour(entry["reflectance"])}
    elif kind == "mirror":
        found = {"type": "mirror", "kr": colour(entry["reflectance"])}
    elif kind == "glass":
        found = {"type": "glass", "kr": entry["reflectance"], "kt": entry["transmittance"], "interiorior": entry["ior"], "exteriorior": 1.0}
    elif kind == "emissive":
        found = {"type": "matte", "kd": [0.0] * 3, "emission": entry["radiance"]}
    elif kind == "blend":
        for slot, part in enumerate(entry["parts"]):
            add_material(properties, f"{name}-{slot}", part)
        # The amount is that of the second material.
        found = {"type": "mix", "material1": f"{name}-0", "material2": f"{name}-1", "amount": 1 - entry["weight"]}
    else:
        raise Refused(f"`{kind}` is not translated for LuxCore")
    properties |= prefixed(f"scene.materials.{name}", found)


def add_mesh(target, name, triangles):
    rows = lambda values: None if values is None else [tuple(float(part) for part in row) for row in values]  # noqa: E731
    faces = [tuple(int(part) for part in face) for face in triangles.faces]
    target.DefineMesh(name, rows(triangles.positions), faces, rows(triangles.normals), rows(triangles.coordinates), None, None)


def light_properties(light):
    if light["type"] != "environment":
        raise Refused(f"a light of type `{light['type']}` is not translated for LuxCore")
    if "radiance" in light:
        return {"type": "constantinfinite", "color": light["radiance"]}
    # LuxCore's u is atan2(y, x)/2π and its pole +z; gpt's is atan2(x, −z)/2π and +y: so (x, y, z) there are (−z, x, y) here.
    turn = [0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1]
    scale = [light["scale"]] * 3
    return {"type": "infinite", "file": str(light["file"]), "gamma": 1.0, "gain": scale, "transformation": turn, "visibilitymapcache.enable": 0}


def configuration(scene, spp, seed, sampler, lights):
    """Path tracing on the CPU: the same integral, without clamping, hybrid tracing, caches, filtering or adaptive sampling."""
    depth = scene.max_depth or 1 << 20
    width, height = scene.size
    values = {
        "renderengine.type": "PATHCPU",
        "renderengine.seed": seed + 1,
        "native.threads.count": os.cpu_count(),
        "sampler.type": sampler,
        "sampler.sobol.adaptive.strength": 0.0,
        "sampler.random.adaptive.strength": 0.0,
        "lightstrategy.type": lights,
        "path.pathdepth.total": depth,
        "path.pathdepth.diffuse": depth,
        "path.pathdepth.glossy": depth,
        "path.pathdepth.specular": depth,
        "path.russianroulette.depth": scene.roulette_depth or depth,
        "path.hybridbackforward.enable": 0,
        "path.clamping.variance.maxvalue": 0.0,
        "path.photongi.indirect.enabled": 0,
        "path.photongi.caustic.enabled": 0,
        "film.width": width,
        "film.height": height,
        "film.filter.type": "NONE",
        "film.imagepipelines.0.0.type": "NOP",
        "film.outputs.0.type": "RGB",
        "film.outputs.0.filename": "unused.exr",
        "batch.haltspp": spp,
        "batch.halttime": 0,
        "batch.haltnoisethreshold": 0.0,
    }
    return as_properties(values)
