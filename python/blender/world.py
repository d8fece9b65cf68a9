"""The world: one radiance, a map with its strength and rotation, or a map made by Cycles of what a node tree shows."""

import math

import numpy

from .picture_file import write_exr
from .values import Constant, Picture, Textures, Values, mean, origin

BAKED_SIZE = (2048, 1024)


def export(world, file, report, bake=None):
    """Adds the `environment`. `bake(world, size)` gives a lat-long picture of a world whose nodes cannot be said; None leaves those grey."""
    if world is None:
        return
    where = f"world {world.name}"
    values = Values(report, where)
    if world.node_tree is None or not getattr(world, "use_nodes", True):
        _constant(file, numpy.array(world.color[:]))
        return
    inlined = world.inline_shader_nodes() if hasattr(world, "inline_shader_nodes") else None
    tree = inlined.node_tree if inlined is not None else world.node_tree
    output = next((node for node in tree.nodes if node.type == "OUTPUT_WORLD" and node.is_active_output), None)
    if output is None:
        return
    if origin(output.inputs["Volume"]) is not None:
        report.add(where, "a volume", "left out")
    surface = origin(output.inputs["Surface"])
    if surface is None:
        return
    if surface.node.type in ("BACKGROUND", "EMISSION") and _background(surface.node, values, file, report, where):
        return
    if bake is None:
        report.add(where, "nodes that only Cycles can show", "left out")
        return
    report.add(where, f"the nodes of {surface.node.bl_label}", f"a map of {BAKED_SIZE[0]} × {BAKED_SIZE[1]} made by Cycles")
    path, reference = file.new_file(world.name, ".exr")
    write_exr(path, bake(world, BAKED_SIZE)[..., :3])
    # Blender's map is turned from ours by a quarter.
    file.lights.append({"type": "environment", "file": reference, "rotate": 90.0})


def _constant(file, radiance):
    radiance = numpy.maximum(radiance.astype(float), 0)
    if radiance.max() > 0:
        file.lights.append({"type": "environment", "radiance": [float(channel) for channel in radiance]})


def _background(node, values, file, report, where):
    """True if the background could be said."""
    strength = values.color(node.inputs["Strength"])
    if not isinstance(strength, Constant):
        return False
    factor = max(float(strength.pixels[0]), 0.0)
    output = origin(node.inputs["Color"])
    if output is None:
        _constant(file, numpy.array(node.inputs["Color"].default_value[:3]) * factor)
        return True
    if output.node.type == "TEX_ENVIRONMENT":
        return _map(output.node, factor, values, file, report, where)
    if not _is_known(output):
        return False
    color = values.color(node.inputs["Color"])
    if not isinstance(color, Constant):
        return False
    _constant(file, color.pixels[:3] * factor)
    return True


def _is_known(output):
    """Whether it is made of constants alone."""
    if output.node.type.startswith("TEX_") or output.node.type in ("NEW_GEOMETRY", "LIGHT_PATH", "TEX_COORD", "LAYER_WEIGHT", "FRESNEL"):
        return False
    return all(_is_known(origin(socket)) for socket in output.node.inputs if origin(socket) is not None)


def _map(node, factor, values, file, report, where):
    image = node.image
    if image is None or not image.size[0] or node.projection != "EQUIRECTANGULAR":
        return False
    turned = _rotation(node.inputs["Vector"], values)
    if turned is None:
        return False
    identity = numpy.array([[1.0, 0, 0], [0, 1, 0]])
    picture = Picture(image.name, ("world",), identity, image=image)
    if image.filepath.lower().endswith((".exr", ".hdr")) and image.is_float:
        reference = Textures(file, report).copied(image)
    else:
        path, reference = file.new_file(image.name, ".exr")
        write_exr(path, picture.pixels[..., :3])
    # Blender's map is turned from ours by a quarter; what its directions are turned by turns the map the other way.
    entry = {"type": "environment", "file": reference, "rotate": 90.0 - math.degrees(turned)}
    if factor != 1:
        entry["scale"] = factor
    file.lights.append(entry)
    return True


def _rotation(socket, values):
    """Radians about z by which directions are turned before they are looked up; None where that is not all."""
    output = origin(socket)
    if output is None:
        return 0.0
    node = output.node
    if node.type == "TEX_COORD" and output.identifier == "Generated" or node.type == "NEW_GEOMETRY" and output.identifier in ("Position", "Incoming"):
        return 0.0 if output.identifier != "Incoming" else None
    if node.type != "MAPPING" or node.vector_type not in ("POINT", "TEXTURE", "VECTOR"):
        return None
    inner = _rotation(node.inputs["Vector"], values)
    rotation = mean(values.color(node.inputs["Rotation"]))[:3]
    scale = mean(values.color(node.inputs["Scale"]))[:3]
    location = mean(values.color(node.inputs["Location"]))[:3] if node.vector_type != "VECTOR" else numpy.zeros(3)
    if inner is None or abs(rotation[0]) > 1e-6 or abs(rotation[1]) > 1e-6 or not numpy.allclose(scale, scale[0]) or scale[0] <= 0 or any(abs(location) > 1e-6):
        return None
    return inner + float(-rotation[2] if node.vector_type == "TEXTURE" else rotation[2])
