"""Builds a scene of gpt in Blender, for Cycles.

Cycles has no sphere primitive: spheres are meshes of 16,128 triangles with the sphere's normals, those that emit of 2,208. (A point light with
a radius is a sphere to light sampling there, but does not hide what is behind it.) Blender's +Z is up; the scene is left as it is, lying
on its side, and so is the camera.
"""

import math
import os

import bpy
import numpy as np
from mathutils import Matrix, Vector

from scene_file import Refused
from triangles import mesh, spheres_columns


def build(scene):
    """The scene that bpy.context has afterwards, with Cycles set up for one device, the CPU."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    target = bpy.context.scene
    known = {name: material(name, entry, scene) for name, entry in scene.materials.items()}
    for number, shape in enumerate(scene.shapes):
        add_mesh(target, f"shape {number}", mesh(shape, spheres_columns(scene, shape)), known[shape["material"]])
    add_lights(target, scene.lights)
    set_camera(target, scene.camera)
    set_cycles(target, scene)
    return target


def new_tree(owner):
    owner.use_nodes = True
    owner.node_tree.nodes.clear()
    return owner.node_tree


def node(tree, kind, inputs=(), **properties):
    made = tree.nodes.new(kind)
    for key, value in properties.items():
        setattr(made, key, value)
    for key, value in dict(inputs).items():
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, made.inputs[key])
        else:
            made.inputs[key].default_value = value
    return made


def material(name, entry, scene):
    made = bpy.data.materials.new(name)
    tree = new_tree(made)
    if "interior" in entry:
        outputs = {"Volume": volume(tree, entry["interior"])}
        if entry["type"] != "pass":
            outputs["Surface"] = surface(tree, entry, scene).outputs[0]
        node(tree, "ShaderNodeOutputMaterial", outputs)
        return made
    shader = emission(tree, entry["radiance"]) if entry["type"] == "emissive" else surface(tree, entry, scene)
    if "opacity" in entry:
        shader = cut_out(tree, shader, colour(tree, {"texture": entry["opacity"]}, scene))
    node(tree, "ShaderNodeOutputMaterial", {"Surface": shader.outputs[0]})
    return made


def volume(tree, medium):
    """Scattering is colour times density there, and absorption (1 - colour) times density."""
    scattering, absorption = medium["scattering"], medium["absorption"]
    most_scattered, most_absorbed = (max(float(part.max()), 1e-12) for part in (scattering, absorption))
    inputs = {"Color": (*(scattering / most_scattered), 1), "Density": most_scattered, "Anisotropy": medium["g"]}
    scatter = node(tree, "ShaderNodeVolumeScatter", inputs)
    absorb = node(tree, "ShaderNodeVolumeAbsorption", {"Color": (*(1 - absorption / most_absorbed), 1), "Density": most_absorbed})
    both = node(tree, "ShaderNodeAddShader")
    tree.links.new(scatter.outputs[0], both.inputs[0])
    tree.links.new(absorb.outputs[0], both.inputs[1])
    return both.outputs[0]


def cut_out(tree, shader, opacity):
    """The mix node's factor is the weight of its second shader."""
    mix = node(tree, "ShaderNodeMixShader", {"Fac": opacity})
    tree.links.new(node(tree, "ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
    tree.links.new(shader.outputs[0], mix.inputs[2])
    return mix


def emission(tree, radiance):
    """Emits to the front only."""
    back = node(tree, "ShaderNodeNewGeometry").outputs["Backfacing"]
    front = node(tree, "ShaderNodeMath", {0: 1.0, 1: back}, operation="SUBTRACT")
    return node(tree, "ShaderNodeEmission", {"Color": (*radiance, 1), "Strength": front.outputs[0]})


def surface(tree, entry, scene):
    kind = entry["type"]
    if kind == "diffuse":
        return node(tree, "ShaderNodeBsdfDiffuse", {"Color": colour(tree, entry["reflectance"], scene), "Roughness": 0.0})
    if kind == "mirror":
        return glossy(tree, entry["reflectance"], 0.0)
    if kind == "glass":
        if entry["reflectance"] != entry["transmittance"]:
            raise Refused("Cycles' glass has one colour for both of its parts")
        optics = {"Color": (*entry["reflectance"], 1), "Roughness": 0.0, "IOR": entry["ior"]}
        return node(tree, "ShaderNodeBsdfGlass", optics, distribution="GGX")
    if kind == "rough_glass":
        optics = {"Color": (*entry["reflectance"], 1), "Roughness": math.sqrt(entry["alpha"]), "IOR": entry["ior"]}
        return node(tree, "ShaderNodeBsdfGlass", optics, distribution="GGX")
    if kind == "conductor" and "eta" in entry:
        optics = {"IOR": entry["eta"], "Extinction": entry["k"], "Roughness": math.sqrt(entry["alpha"]), "Anisotropy": 0.0}
        return node(tree, "ShaderNodeBsdfMetallic", optics, distribution="GGX", fresnel_type="PHYSICAL_CONDUCTOR")
    if kind == "conductor" and entry["reflectance"] == [1.0] * 3:
        return glossy(tree, entry["reflectance"], entry["alpha"])
    if kind == "blend":
        # The mix node's factor is the weight of its second shader.
        mix = node(tree, "ShaderNodeMixShader", {"Fac": 1 - entry["weight"]})
        for slot, part in enumerate(entry["parts"]):
            tree.links.new(surface(tree, part, scene).outputs[0], mix.inputs[1 + slot])
        return mix
    raise Refused(f"`{kind}` is not translated for Cycles")


def glossy(tree, reflectance, alpha):
    """Cycles' GGX is height-correlated; its width is the square of the node's roughness."""
    inputs = {"Color": (*reflectance, 1), "Roughness": math.sqrt(alpha), "Anisotropy": 0.0}
    return node(tree, "ShaderNodeBsdfAnisotropic", inputs, distribution="GGX")


def colour(tree, value, scene):
    if not isinstance(value, dict):
        return (*value, 1)
    texture, uv = scene.textures[value["texture"]], node(tree, "ShaderNodeUVMap").outputs["UV"]
    if texture["type"] == "checker":
        u, v = texture["scale"]
        scaled = node(tree, "ShaderNodeVectorMath", {0: uv, 1: (u, v, 0.0)}, operation="MULTIPLY").outputs[0]
        colours = {"Color1": (*texture["b"], 1), "Color2": (*texture["a"], 1)}  # the square at the origin is of the second
        return node(tree, "ShaderNodeTexChecker", {"Vector": scaled, "Scale": 1.0} | colours).outputs["Color"]
    made = node(
        tree,
        "ShaderNodeTexImage",
        {"Vector": uv},
        interpolation={"bilinear": "Linear", "nearest": "Closest"}[texture["filter"]],
        extension={"repeat": "REPEAT", "clamp": "EXTEND"}[texture["wrap"]],
        image=bpy.data.images.load(str(texture["file"])),
    )
    made.image.colorspace_settings.name = {"srgb": "sRGB", "linear": "Non-Color"}[texture["color_space"]]
    return made.outputs["Color"]


def add_mesh(target, name, triangles, material):
    made = bpy.data.meshes.new(name)
    made.from_pydata(triangles.positions.tolist(), [], triangles.faces.tolist())
    made.materials.append(material)
    if triangles.coordinates is not None:
        corners = triangles.coordinates[triangles.faces.ravel()]
        made.uv_layers.new(name="UVMap").data.foreach_set("uv", corners.ravel())
    if triangles.normals is not None:
        made.shade_smooth()
        made.normals_split_custom_set_from_vertices(triangles.normals.tolist())
    target.collection.objects.link(bpy.data.objects.new(name, made))


def add_lights(target, lights):
    target.world = bpy.data.worlds.new("sky")
    tree, colour = new_tree(target.world), (0, 0, 0, 1)
    strength = 1.0
    for light in lights:
        if light["type"] == "directional":
            sun = bpy.data.lights.new("sun", "SUN")
            peak = max(light["irradiance"])
            sun.color, sun.energy, sun.angle = [part / peak for part in light["irradiance"]], peak, 0.0
            thing = bpy.data.objects.new("sun", sun)
            thing.matrix_world = Vector(light["direction"]).to_track_quat("-Z", "Y").to_matrix().to_4x4()
            target.collection.objects.link(thing)
            continue
        if light["type"] != "environment":
            raise Refused(f"a light of type `{light['type']}` is not translated for Cycles")
        if "radiance" in light:
            colour = (*light["radiance"], 1)
        else:
            colour, strength = environment_map(tree, light), light["scale"]
    background = node(tree, "ShaderNodeBackground", {"Color": colour, "Strength": strength})
    node(tree, "ShaderNodeOutputWorld", {"Surface": background.outputs[0]})


def environment_map(tree, light):
    """Cycles' u is ½ − atan2(y, x)/2π and its pole +z; gpt's is atan2(x, −z)/2π and +y: so (x, y, z) there are (z, x, y) here."""
    parts = node(tree, "ShaderNodeSeparateXYZ", {"Vector": node(tree, "ShaderNodeTexCoord").outputs["Generated"]}).outputs
    turned = node(tree, "ShaderNodeCombineXYZ", {"X": parts["Z"], "Y": parts["X"], "Z": parts["Y"]}).outputs[0]
    image = bpy.data.images.load(str(light["file"]))
    image.colorspace_settings.name = "Linear Rec.709"
    if light["to_poles"]:
        image = with_rows_inside(image)
    return node(tree, "ShaderNodeTexEnvironment", {"Vector": turned}, image=image, interpolation="Linear").outputs["Color"]


def with_rows_inside(image, times=32):
    """A map whose first and last row lie on the poles, as one whose rows end there: each gap between two rows is `times` rows that interpolate."""
    width, height = image.size
    pixels = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    rows = pixels.reshape(height, -1)
    place = (np.arange(times * (height - 1)) + 0.5) / times
    below, share = place.astype(int), (place % 1)[:, None].astype(np.float32)
    finer = (1 - share) * rows[below] + share * rows[below + 1]
    made = bpy.data.images.new("map", width, len(finer), float_buffer=True)
    made.colorspace_settings.name = "Linear Rec.709"
    made.pixels.foreach_set(finer.ravel())
    made.pack()
    return made


def set_camera(target, camera):
    position = Vector(camera["position"])
    back = (position - Vector(camera["look_at"])).normalized()
    right = Vector(camera["up"]).cross(back).normalized()
    made = bpy.data.cameras.new("camera")
    made.sensor_fit, made.sensor_height = "VERTICAL", 24.0
    made.lens = 12.0 / math.tan(math.radians(camera["vfov"]) / 2)
    made.clip_start, made.clip_end = 1e-3, 1e6
    target.camera = bpy.data.objects.new("camera", made)
    target.camera.matrix_world = Matrix.Translation(position) @ Matrix((right, back.cross(right), back)).transposed().to_4x4()
    target.collection.objects.link(target.camera)


def set_cycles(target, scene):
    """The same integral: no clamping, no filtering of gloss, no light threshold, no adaptive sampling, no denoiser."""
    target.render.engine = "CYCLES"
    cycles = target.cycles
    cycles.device = "CPU"
    bounces = scene.max_depth - 2 if scene.max_depth else 1024  # none: light sources seen directly and direct lighting, two edges
    for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
        setattr(cycles, f"{kind}_bounces", bounces)
    # Ways through holes are no edges of a path.
    cycles.transparent_max_bounces = 1024 if any("opacity" in entry or entry["type"] == "pass" for entry in scene.materials.values()) else bounces
    cycles.pixel_filter_type = "BOX"
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_guiding = False
    cycles.caustics_reflective = cycles.caustics_refractive = True
    render = target.render
    render.use_persistent_data = True  # the hierarchy is built once
    render.resolution_x, render.resolution_y, render.resolution_percentage = *scene.size, 100
    render.threads_mode, render.threads = "FIXED", os.cpu_count()
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
