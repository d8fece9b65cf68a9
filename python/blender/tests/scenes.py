"""Scenes made by script, each of which shows what one part of the exporter says."""

import math

import bpy
import numpy

SIZE = (96, 72)


def empty():
    """A scene of nothing, set so that Cycles computes what it shows: no clamping, filtering, thresholds or denoising."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = 64
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.sample_clamp_indirect = cycles.sample_clamp_direct = 0
    cycles.light_sampling_threshold = 0
    cycles.blur_glossy = 0
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 12
    cycles.transparent_max_bounces = 64
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    return scene


def camera(location=(0, -7, 2.6), rotation=(1.28, 0, 0), lens=40.0, **keys):
    data = bpy.data.cameras.new("Camera")
    data.lens = lens
    for key, value in keys.items():
        setattr(data, key, value)
    made = bpy.data.objects.new("Camera", data)
    made.location, made.rotation_euler = location, rotation
    bpy.context.collection.objects.link(made)
    bpy.context.scene.camera = made
    return made


def lamp(kind, power, location, rotation=(0, 0, 0), scale=(1, 1, 1), visible=False, **keys):
    data = bpy.data.lights.new(kind.title(), kind)
    data.energy = power
    for key, value in keys.items():
        setattr(data, key, value)
    made = bpy.data.objects.new(kind.title(), data)
    made.location, made.rotation_euler, made.scale = location, rotation, scale
    made.visible_camera = visible
    bpy.context.collection.objects.link(made)
    return made


def grey_world(radiance):
    world = bpy.data.worlds.new("World")
    _with_nodes(world)
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*radiance, 1)
    bpy.context.scene.world = world
    return world


def _with_nodes(owner):
    if owner.node_tree is None or not owner.node_tree.nodes:
        owner.use_nodes = True


class Nodes:
    """A material's nodes in few words."""

    def __init__(self, name):
        self.material = bpy.data.materials.new(name)
        _with_nodes(self.material)
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.output = self.tree.nodes.new("ShaderNodeOutputMaterial")

    def node(self, kind, properties=None, **inputs):
        made = self.tree.nodes.new("ShaderNode" + kind)
        for key, value in (properties or {}).items():
            setattr(made, key, value)
        for key, value in inputs.items():
            name = key.replace("_", " ")
            self.set(made.inputs[int(key[1:]) if key[0] == "i" and key[1:].isdigit() else name], value)
        return made

    def set(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif isinstance(value, bpy.types.Node):
            self.tree.links.new(value.outputs[0], socket)
        elif socket.type == "RGBA" and len(value) == 3:
            socket.default_value = (*value, 1)
        else:
            socket.default_value = value

    def show(self, shader):
        self.set(self.output.inputs["Surface"], shader)
        return self.material


def simple(name, kind, properties=None, **inputs):
    nodes = Nodes(name)
    return nodes.show(nodes.node(kind, properties, **inputs))


def floor(material=None, size=16):
    bpy.ops.mesh.primitive_plane_add(size=size)
    return _finished("Floor", material or simple("Floor", "BsdfDiffuse", Color=(0.5, 0.5, 0.5)))


def ball(name, material, location, radius=0.7):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=location, segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    return _finished(name, material)


def _finished(name, material):
    made = bpy.context.object
    made.name = name
    if material is not None:
        made.data.materials.append(material)
    return made


def image(name, pixels, linear=False, is_float=False):
    """A picture of rows from the bottom, kept in the file as PNG or OpenEXR.

    Cycles interpolates bytes as they are encoded and gpt what they mean, so these scenes have floats.
    """
    height, width = pixels.shape[:2]
    made = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    if linear:
        made.colorspace_settings.name = "Non-Color"
    made.pixels.foreach_set(numpy.ascontiguousarray(pixels, dtype=numpy.float32).ravel())
    made.update()
    made.pack()
    return made


def checks(width, height, first, second, squares=8):
    y, x = numpy.mgrid[0:height, 0:width]
    odd = ((x * squares // width) + (y * squares // height)) % 2
    pixels = numpy.where(odd[..., None] == 1, numpy.array([*first, 1.0]), numpy.array([*second, 1.0]))
    # A ramp tells right from left and up from down.
    pixels[..., 0] *= 0.4 + 0.6 * x / width
    pixels[..., 1] *= 0.4 + 0.6 * y / height
    return pixels


GREY = (0.6, 0.6, 0.6)


def sharp_lamps():
    """A point, a spot with a soft edge and a sun, none with a size."""
    scene = empty()
    floor()
    ball("Ball", simple("White", "BsdfDiffuse", Color=(0.8, 0.7, 0.6)), (0, 0, 0.7))
    lamp("POINT", 200, (-2.2, -1, 2.5), color=(1, 0.8, 0.6))
    lamp("SPOT", 600, (2.5, -1.5, 3.5), (0.5, 0.5, 0), spot_size=math.radians(50), spot_blend=0.6, color=(0.6, 0.8, 1))
    lamp("SUN", 0.6, (0, 0, 5), (0.7, -0.5, 0.3), angle=0, exposure=0.5)
    camera()
    return scene


def soft_lamps():
    """Area lamps of all four shapes, scaled, a point with a radius and a sun with an angle; two are seen."""
    scene = empty()
    floor()
    ball("Ball", simple("White", "BsdfDiffuse", Color=(0.8, 0.7, 0.6)), (0, 0, 0.7))
    lamp("AREA", 60, (-2.5, 0, 2.2), (0.2, -0.7, 0.3), shape="SQUARE", size=0.8)
    lamp("AREA", 60, (2.5, 0.5, 2), (0.1, 0.9, 0), (1.5, 0.7, 1), shape="RECTANGLE", size=0.6, size_y=1.2, color=(1, 0.5, 0.4), visible=True)
    lamp("AREA", 40, (0, -1.5, 3), (0.4, 0, 0), shape="DISK", size=1)
    lamp("AREA", 40, (0, 2.5, 2.2), (-1.0, 0, 0), shape="ELLIPSE", size=1.6, size_y=0.5, color=(0.4, 0.6, 1))
    lamp("POINT", 40, (1.2, -1.4, 0.5), shadow_soft_size=0.2, visible=True, use_soft_falloff=False)
    lamp("SUN", 0.4, (0, 0, 5), (0.5, 0.6, 0), angle=math.radians(12))
    camera()
    return scene


def world_map():
    """A map with a bright window, turned by a Mapping node, seen and mirrored."""
    scene = empty()
    y, x = numpy.mgrid[0:64, 0:128]
    pixels = numpy.ones((64, 128, 4))
    pixels[..., 0], pixels[..., 1], pixels[..., 2] = 0.2 + 0.5 * x / 128, 0.2 + 0.3 * y / 64, 0.5 - 0.3 * x / 128
    pixels[40:52, 20:34, :3] = (14, 11, 7)
    world = grey_world((0, 0, 0))
    tree = world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image("Sky", pixels, is_float=True)
    mapping, coordinates = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Rotation"].default_value = (0, 0, math.radians(70))
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 0.8
    floor(size=5)
    ball("Mirror", simple("Mirror", "BsdfAnisotropic", {"distribution": "GGX"}, Color=(0.9, 0.9, 0.9), Roughness=0.0), (-0.9, 0, 0.8))
    ball("White", simple("White", "BsdfDiffuse", Color=(0.8, 0.8, 0.8)), (0.9, 0, 0.8))
    camera()
    return scene


def lenses():
    """A lens with shift, a wide opening of five blades, turned, and a picture of pixels that are not square."""
    scene = empty()
    grey_world((0.3, 0.35, 0.4))
    nodes = Nodes("Checks")
    picture = nodes.node("TexImage", {"image": image("Checks", checks(64, 64, (0.9, 0.8, 0.7), (0.1, 0.1, 0.2)), is_float=True)})
    floor(nodes.show(nodes.node("BsdfDiffuse", Color=picture)))
    for index in range(4):
        ball(f"Ball {index}", simple(f"Light {index}", "Emission", Color=(1, 0.3 * index, 0.2), Strength=2.0), (index - 1.5, 2.5 * index - 2, 0.4), 0.25)
    made = camera(lens=50, shift_x=0.12, shift_y=-0.08)
    made.data.dof.use_dof = True
    made.data.dof.focus_distance = 6.0
    made.data.dof.aperture_fstop = 0.12
    made.data.dof.aperture_blades = 5
    made.data.dof.aperture_rotation = 0.3
    scene.render.pixel_aspect_x = 1.25
    return scene


def panoramas():
    """A full panorama about checks, a lamp and coloured balls."""
    scene = empty()
    grey_world((0.2, 0.3, 0.5))
    nodes = Nodes("Checks")
    picture = nodes.node("TexImage", {"image": image("Checks", checks(64, 64, (0.9, 0.8, 0.7), (0.1, 0.1, 0.2)), is_float=True)})
    floor(nodes.show(nodes.node("BsdfDiffuse", Color=picture)))
    for index, place in enumerate(((2, 0, 1), (0, 2.5, 1.5), (-2, 0.5, 2), (0.5, -2, 1))):
        ball(f"Ball {index}", simple(f"Light {index}", "Emission", Color=(1, 0.3 * index, 0.2), Strength=1.5), place, 0.4)
    camera(location=(0, 0, 1.2), rotation=(1.4, 0.1, 0.5), type="PANO", panorama_type="EQUIRECTANGULAR",
           longitude_min=-2.0, longitude_max=2.6, latitude_min=-1.0, latitude_max=1.3)
    return scene


def principled():
    """Principled materials: metal, lacquer, coat, matt, cloth of sheen, and light of its own."""
    scene = empty()
    grey_world((0.35, 0.35, 0.35))
    floor(simple("Floor", "BsdfPrincipled", Base_Color=(0.45, 0.42, 0.38), Roughness=0.6))
    rows = (
        ("Gold", dict(Base_Color=(1, 0.77, 0.34), Metallic=1.0, Roughness=0.2)),
        ("Steel", dict(Base_Color=(0.6, 0.6, 0.65), Metallic=1.0, Roughness=0.6)),
        ("Lacquer", dict(Base_Color=(0.75, 0.2, 0.04), Roughness=0.25)),
        ("Coat", dict(Base_Color=(0.05, 0.2, 0.5), Roughness=0.7, Coat_Weight=1.0, Coat_Roughness=0.05)),
        ("Matt", dict(Base_Color=(0.3, 0.6, 0.3), Roughness=1.0, Specular_IOR_Level=0.2)),
        ("Glow", dict(Base_Color=(0.2, 0.2, 0.2), Emission_Color=(0.2, 0.6, 1, 1), Emission_Strength=0.7)),
    )
    for index, (name, inputs) in enumerate(rows):
        ball(name, simple(name, "BsdfPrincipled", **inputs), (1.5 * (index % 3) - 1.5, 1.6 * (index // 3) - 0.8, 0.6), 0.6)
    lamp("AREA", 250, (2, -2, 3.5), (0.5, 0.4, 0), shape="SQUARE", size=1.5)
    camera()
    return scene


def metals():
    """Principled materials without a dielectric above a base that scatters: the two programs have the same model."""
    scene = empty()
    grey_world((0.35, 0.35, 0.35))
    floor(simple("Floor", "BsdfPrincipled", Base_Color=(0.45, 0.42, 0.38), Specular_IOR_Level=0.0))
    rows = (
        ("Gold", dict(Base_Color=(1, 0.77, 0.34), Metallic=1.0, Roughness=0.2)),
        ("Steel", dict(Base_Color=(0.6, 0.6, 0.65), Metallic=1.0, Roughness=0.6)),
        ("Matt", dict(Base_Color=(0.3, 0.6, 0.3), Specular_IOR_Level=0.0)),
        ("Half", dict(Base_Color=(0.7, 0.3, 0.2), Metallic=0.5, Roughness=0.3, Specular_IOR_Level=0.0)),
        ("Glow", dict(Base_Color=(0.2, 0.2, 0.2), Specular_IOR_Level=0.0, Emission_Color=(0.2, 0.6, 1, 1), Emission_Strength=0.7)),
        ("Veil", dict(Base_Color=(0.8, 0.2, 0.6), Specular_IOR_Level=0.0, Alpha=0.4)),
    )
    for index, (name, inputs) in enumerate(rows):
        ball(name, simple(name, "BsdfPrincipled", **inputs), (1.5 * (index % 3) - 1.5, 1.6 * (index // 3) - 0.8, 0.6), 0.6)
    lamp("AREA", 250, (2, -2, 3.5), (0.5, 0.4, 0), shape="SQUARE", size=1.5)
    camera()
    return scene


def glass():
    """Glass, rough glass, a transmitting Principled body, a coloured one, and a thin sheet that lets half through."""
    scene = empty()
    grey_world((0.4, 0.4, 0.4))
    nodes = Nodes("Checks")
    picture = nodes.node("TexImage", {"image": image("Checks", checks(64, 64, (0.9, 0.8, 0.7), (0.1, 0.1, 0.2), 16), is_float=True)})
    floor(nodes.show(nodes.node("BsdfDiffuse", Color=picture)))
    ball("Glass", simple("Glass", "BsdfGlass", {"distribution": "GGX"}, Color=(1, 1, 1), Roughness=0.0, IOR=1.5), (-1.6, 0, 0.7))
    ball("Frosted", simple("Frosted", "BsdfGlass", {"distribution": "GGX"}, Color=(0.9, 1, 0.9), Roughness=0.3, IOR=1.4), (0, 0.4, 0.7))
    ball("Body", simple("Body", "BsdfPrincipled", {"distribution": "GGX"}, Base_Color=(1, 0.6, 0.4), Roughness=0.0, Transmission_Weight=1.0), (1.6, 0, 0.7))
    nodes = Nodes("Veil")
    bpy.ops.mesh.primitive_plane_add(size=1.2, location=(0, -1.6, 0.6), rotation=(math.pi / 2, 0, 0.3))
    _finished("Veil", nodes.show(nodes.node("MixShader", i0=0.5, i1=nodes.node("BsdfTransparent"), i2=nodes.node("BsdfTranslucent", Color=(0.8, 0.3, 0.3)))))
    lamp("AREA", 150, (1, 2, 3), (-0.4, 0.2, 0), shape="SQUARE", size=1)
    camera()
    return scene


def trees():
    """Mix and Add Shader over Layer Weight, Fresnel, Backfacing, Math and a ramp."""
    scene = empty()
    grey_world((0.4, 0.4, 0.4))
    floor()
    red, white = (0.8, 0.15, 0.1), (0.9, 0.9, 0.9)

    def mixed(name, weigh, first, second):
        nodes = Nodes(name)
        return nodes.show(nodes.node("MixShader", i0=weigh(nodes), i1=first(nodes), i2=second(nodes)))

    diffuse = lambda color: lambda nodes: nodes.node("BsdfDiffuse", Color=color)
    glossy = lambda nodes: nodes.node("BsdfAnisotropic", {"distribution": "GGX"}, Color=white, Roughness=0.1)
    glow = lambda nodes: nodes.node("Emission", Color=(0.2, 0.5, 1), Strength=1.0)

    def product(nodes):
        facing = nodes.node("LayerWeight", Blend=0.3).outputs["Facing"]
        return nodes.node("Math", {"operation": "MULTIPLY"}, i0=facing, i1=nodes.node("Fresnel", IOR=2.0))

    def ramp(nodes):
        made = nodes.node("ValToRGB", i0=nodes.node("LayerWeight", Blend=0.5).outputs["Facing"])
        made.color_ramp.elements[0].position, made.color_ramp.elements[1].position = 0.2, 0.7
        return made.outputs["Color"]

    materials = [
        mixed("Varnish", lambda nodes: nodes.node("Fresnel", IOR=1.6), diffuse(red), glossy),
        mixed("Layer", lambda nodes: nodes.node("LayerWeight", Blend=0.4).outputs["Fresnel"], diffuse((0.1, 0.5, 0.2)), glossy),
        mixed("Facing", lambda nodes: nodes.node("LayerWeight", Blend=0.7).outputs["Facing"], diffuse(red), glow),
        mixed("Product", product, diffuse((0.2, 0.2, 0.7)), glow),
        mixed("Ramp", ramp, diffuse((0.7, 0.7, 0.2)), diffuse((0.1, 0.1, 0.1))),
    ]
    nodes = Nodes("Sum")
    total = nodes.node("AddShader", i0=nodes.node("BsdfDiffuse", Color=(0.3, 0.1, 0.1)),
                       i1=nodes.node("BsdfAnisotropic", {"distribution": "GGX"}, Color=(0.4, 0.4, 0.4), Roughness=0.2))
    materials.append(nodes.show(nodes.node("AddShader", i0=total, i1=nodes.node("Emission", Color=(0, 0.2, 0), Strength=1.0))))
    for index, material in enumerate(materials):
        ball(material.name, material, (1.5 * (index % 3) - 1.5, 1.6 * (index // 3) - 0.8, 0.6), 0.6)
    nodes = Nodes("Leaf")
    sides = nodes.node("NewGeometry").outputs["Backfacing"]
    leaf = nodes.node("AddShader", i0=nodes.node("BsdfDiffuse", Color=(0.2, 0.4, 0.1)), i1=nodes.node("BsdfTranslucent", Color=(0.3, 0.5, 0.1)))
    bpy.ops.mesh.primitive_plane_add(size=1, location=(-2.6, -1.5, 0.6), rotation=(1.2, 0.3, 0))
    _finished("Leaf", nodes.show(nodes.node("MixShader", i0=sides, i1=leaf, i2=nodes.node("BsdfDiffuse", Color=(0.6, 0.1, 0.6)))))
    lamp("AREA", 250, (2, -2, 3.5), (0.5, 0.4, 0), shape="SQUARE", size=1.5)
    camera()
    return scene


def textures():
    """Pictures by a Mapping node, all four extensions, nodes between, a normal map, an alpha and colours of corners."""
    scene = empty()
    grey_world((0.4, 0.4, 0.4))
    picture = image("Checks", checks(32, 32, (0.9, 0.8, 0.7), (0.1, 0.1, 0.4), 4), is_float=True)

    def textured(name, extension="REPEAT", scale=(2, 1, 1), rotation=0.4, kind="POINT", change=None):
        nodes = Nodes(name)
        mapping = nodes.node("Mapping", {"vector_type": kind}, Vector=nodes.node("TexCoord").outputs["UV"], Location=(0.2, 0.1, 0),
                             Rotation=(0, 0, rotation), Scale=scale)
        color = nodes.node("TexImage", {"image": picture, "extension": extension}, Vector=mapping).outputs["Color"]
        return nodes.show(nodes.node("BsdfDiffuse", Color=change(nodes, color) if change else color))

    def inverted(nodes, color):
        gamma = nodes.node("Gamma", Color=nodes.node("Invert", Fac=0.7, Color=color), Gamma=1.4)
        return nodes.node("HueSaturation", Hue=0.6, Saturation=0.8, Value=0.9, Color=gamma)

    panels = [textured("Repeat"), textured("Mirror", "MIRROR", (1.5, 1.5, 1), kind="TEXTURE"), textured("Extend", "EXTEND", (1.5, 1.5, 1)),
              textured("Clip", "CLIP", (1.5, 1.5, 1)), textured("Changed", change=inverted)]
    y, x = numpy.mgrid[0:32, 0:32] / 32
    normals = numpy.ones((32, 32, 4))
    normals[..., 0], normals[..., 1] = 0.5 + 0.3 * numpy.sin(4 * math.pi * x), 0.5 + 0.2 * numpy.cos(2 * math.pi * y)
    normals[..., 2] = 0.5 + 0.5 * numpy.sqrt(1 - (2 * normals[..., 0] - 1) ** 2 - (2 * normals[..., 1] - 1) ** 2)
    nodes = Nodes("Bent")
    bend = nodes.node("NormalMap", Strength=0.8, Color=nodes.node("TexImage", {"image": image("Normals", normals, linear=True, is_float=True)}))
    panels.append(nodes.show(nodes.node("BsdfDiffuse", Color=(0.7, 0.7, 0.7), Normal=bend)))
    holes = checks(32, 32, (0.9, 0.5, 0.1), (0.1, 0.5, 0.9), 4)
    holes[..., 3] = numpy.where((x - 0.5) ** 2 + (y - 0.5) ** 2 < 0.12, 0.25, 1.0)
    # Pictures of floats are kept multiplied by their alpha.
    holes[..., :3] *= holes[..., 3:]
    nodes = Nodes("Holes")
    holed = nodes.node("TexImage", {"image": image("Holes", holes, is_float=True)})
    panels.append(nodes.show(nodes.node(
        "MixShader", i0=holed.outputs["Alpha"], i1=nodes.node("BsdfTransparent"), i2=nodes.node("BsdfDiffuse", Color=holed.outputs["Color"]))))
    nodes = Nodes("Painted")
    panels.append(nodes.show(nodes.node("BsdfDiffuse", Color=nodes.node("VertexColor", {"layer_name": "Paint"}))))
    for index, material in enumerate(panels):
        bpy.ops.mesh.primitive_plane_add(size=1.3, location=(1.5 * (index % 4) - 2.25, 0, 1.5 * (index // 4) + 0.8), rotation=(1.3, 0, 0))
        made = _finished(material.name, material)
        if material.name == "Painted":
            paint = made.data.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER")
            paint.data.foreach_set("color", [1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0.8, 0.8, 0.1, 1])
    floor()
    lamp("AREA", 250, (2, -4, 4.5), (0.7, 0.3, 0), shape="SQUARE", size=1)
    camera(location=(0, -8, 1.9), rotation=(1.53, 0, 0))
    return scene


def places():
    """Modifiers, linked duplicates, a mirrored one, a collection's instances, and instances by geometry nodes."""
    scene = empty()
    grey_world((0.4, 0.4, 0.4))
    floor()
    bpy.ops.mesh.primitive_monkey_add(size=1, location=(-1.6, 0, 0.6))
    first = _finished("Suzanne", simple("Red", "BsdfDiffuse", Color=(0.7, 0.2, 0.1)))
    modifier = first.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, 2
    bpy.ops.object.shade_smooth()
    bpy.ops.mesh.primitive_cone_add(radius1=0.4, depth=0.9, location=(0, 0.6, 0.45))
    cone = _finished("Cone", simple("Green", "BsdfDiffuse", Color=(0.2, 0.6, 0.2)))
    for index in range(3):
        twin = bpy.data.objects.new(f"Twin {index}", cone.data)
        twin.location, twin.rotation_euler = (0.6 * index + 0.3, -0.8, 0.45), (0.3 * index, 0, 0)
        twin.scale = (-1 if index == 1 else 1, 1, 0.6 + 0.2 * index)
        bpy.context.collection.objects.link(twin)
    hidden = bpy.data.objects.new("Hidden", cone.data)
    hidden.location, hidden.hide_render = (0, -2, 0.5), True
    bpy.context.collection.objects.link(hidden)
    group = bpy.data.collections.new("Pair")
    for index in range(2):
        bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0.5 * index, 0, 0.2))
        made = _finished(f"Cube {index}", simple(f"Blue {index}", "BsdfDiffuse", Color=(0.1, 0.2 + 0.4 * index, 0.8)))
        bpy.context.collection.objects.unlink(made)
        group.objects.link(made)
    for index in range(3):
        holder = bpy.data.objects.new(f"Holder {index}", None)
        holder.instance_type, holder.instance_collection = "COLLECTION", group
        holder.location, holder.rotation_euler = (1.4, 0.9 * index - 0.3, 0), (0, 0, 0.5 * index)
        bpy.context.collection.objects.link(holder)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=3, size=1.6, location=(-0.6, 2.2, 0.5))
    scattered = _finished("Scattered", None)
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    scatter, thing, paint = (tree.nodes.new(kind) for kind in ("GeometryNodeInstanceOnPoints", "GeometryNodeMeshIcoSphere", "GeometryNodeSetMaterial"))
    thing.inputs["Radius"].default_value = 0.2
    paint.inputs["Material"].default_value = simple("Yellow", "BsdfDiffuse", Color=(0.8, 0.7, 0.1))
    tree.links.new(thing.outputs[0], paint.inputs[0])
    tree.links.new(start.outputs[0], scatter.inputs["Points"])
    tree.links.new(paint.outputs[0], scatter.inputs["Instance"])
    tree.links.new(scatter.outputs[0], end.inputs[0])
    scattered.modifiers.new("Scatter", "NODES").node_group = tree
    lamp("AREA", 250, (2, -2, 3.5), (0.5, 0.4, 0), shape="SQUARE", size=1.5)
    camera()
    return scene


def parallel():
    """An orthographic camera with shift, in an upright picture."""
    scene = places()
    camera(location=(0, -7, 3.4), type="ORTHO", ortho_scale=6, shift_x=0.1, shift_y=0.05)
    scene.render.resolution_x, scene.render.resolution_y = SIZE[1], SIZE[0]
    return scene


def fisheye():
    """An equisolid fisheye that reaches to the corners."""
    scene = panoramas()
    lens = scene.camera.data
    lens.panorama_type, lens.fisheye_lens, lens.fisheye_fov = "FISHEYE_EQUISOLID", 15, 2 * math.pi
    return scene


def brushed():
    """Anisotropic metal, along and across, by Glossy and by Principled."""
    scene = empty()
    grey_world((0.4, 0.4, 0.4))
    floor()
    for index, (kind, strength) in enumerate((("glossy", 0.7), ("glossy", -0.7), ("principled", 0.8))):
        nodes = Nodes(f"Brushed {index}")
        along = nodes.node("Tangent", {"direction_type": "UV_MAP"})
        if kind == "glossy":
            shader = nodes.node("BsdfAnisotropic", {"distribution": "GGX"}, Color=(0.8, 0.8, 0.8), Roughness=0.4, Anisotropy=strength, Tangent=along)
        else:
            shader = nodes.node("BsdfPrincipled", {"distribution": "GGX"}, Base_Color=(0.8, 0.8, 0.8), Metallic=1.0, Roughness=0.4,
                                Anisotropic=strength, Tangent=along)
        ball(f"Ball {index}", nodes.show(shader), (1.4 * index - 1.4, 0, 0.6), 0.6)
    lamp("AREA", 250, (2, -2, 3.5), (0.5, 0.4, 0), shape="SQUARE", size=1.5)
    camera()
    return scene


def sky():
    """A world of nodes that Cycles makes a map of."""
    scene = places()
    tree = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexSky")
    texture.sky_type, texture.sun_direction = "PREETHAM", (0.3, 0.5, 0.6)
    tree.links.new(texture.outputs[0], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 0.1
    return scene


def linked():
    """Lamps that light one ball, all but another one that shares its mesh, and everything."""
    scene = empty()
    floor()
    left = ball("Left", simple("Clay", "BsdfDiffuse", Color=(0.7, 0.5, 0.4)), (-2, 0, 0.7))
    right = left.copy()
    right.name, right.location = "Right", (0, 0, 0.7)
    bpy.context.collection.objects.link(right)
    ball("Mirror", simple("Mirror", "BsdfAnisotropic", {"distribution": "GGX"}, Color=(0.9, 0.9, 0.9), Roughness=0.3), (2, 0, 0.7))
    key = lamp("POINT", 300, (-1, -3, 4), shadow_soft_size=0.3, use_soft_falloff=False)
    wash = lamp("AREA", 150, (2, -2, 4), rotation=(0.5, 0.3, 0), size=1.0)
    lamp("SUN", 0.3, (0, 0, 9), rotation=(0.3, -0.4, 0), angle=0.2)
    for owner, things, state in ((key, [left], "INCLUDE"), (wash, [right], "EXCLUDE")):
        collection = bpy.data.collections.new(f"Receivers of {owner.name}")
        for thing in things:
            collection.objects.link(thing)
            collection.collection_objects[-1].light_linking.link_state = state
        owner.light_linking.receiver_collection = collection
    camera(location=(0, -8, 3), rotation=(1.24, 0, 0), lens=40)
    return scene


FURTHER = (parallel, fisheye, brushed, sky, linked)

SCENES = (sharp_lamps, soft_lamps, world_map, lenses, panoramas, metals, principled, glass, trees, textures, places)
