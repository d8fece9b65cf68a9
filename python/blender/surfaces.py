"""A surface: an entry of `[[material]]` whose colours and numbers are still `Constant`s and `Picture`s.

The parts of a blend are entries themselves. `materials` writes them, `shaders` and `principled` make them of nodes.
"""

import numpy

from . import weights
from .values import Constant, Picture, origin

BLACK = Constant([0, 0, 0, 1])
WHITE = Constant([1, 1, 1, 1])


class Scaled:
    """A picture times a colour, which the scene file says as the texture's `factor`."""

    def __init__(self, picture, factor):
        self.picture, self.factor = picture, numpy.asarray(factor, dtype=float)


class Surfaces:
    """Reads the nodes of one material."""

    def __init__(self, values, readers):
        self.values, self._readers = values, readers

    def of_material(self, material):
        if material is None or material.node_tree is None:
            # Cycles shows what has no material as a grey diffuse surface.
            return {"type": "diffuse", "reflectance": Constant([0.8, 0.8, 0.8, 1])}
        # Groups, zones and what Blender unfolds before it renders.
        inlined = material.inline_shader_nodes() if hasattr(material, "inline_shader_nodes") else None
        tree = inlined.node_tree if inlined is not None else material.node_tree
        outputs = [node for node in tree.nodes if node.type == "OUTPUT_MATERIAL" and node.target in ("ALL", "CYCLES")]
        output = next((node for node in outputs if node.is_active_output), outputs[0] if outputs else None)
        if output is None:
            return {"type": "diffuse", "reflectance": BLACK}
        if origin(output.inputs["Volume"]) is not None:
            self.values.report(output, "a volume", "left out")
        if origin(output.inputs["Displacement"]) is not None and material.displacement_method != "BUMP":
            self.values.report(output, "displacement", "left out")
        elif origin(output.inputs["Displacement"]) is not None:
            self.values.report(output, "displacement as bumps", "left out; a Bump node comes across")
        return self.of(output.inputs["Surface"])

    def of(self, socket):
        output = origin(socket)
        if output is None:
            # Nothing is linked: no light is reflected.
            return {"type": "diffuse", "reflectance": BLACK}
        reader = self._readers.get(output.node.type)
        if reader is None:
            self.values.report(output.node, f"the shader {output.node.bl_label}", "a diffuse surface of its colour")
            color = output.node.inputs.get("Color")
            return {"type": "diffuse", "reflectance": self.values.color(color) if color else Constant([0.8] * 3 + [1])}
        return reader(self, output.node)

    # Pieces

    def color(self, node, name):
        return self.values.color(node.inputs[name])

    def number(self, node, name):
        """The colour of an input that takes a number: a constant's red channel is the number."""
        return self.values.color(node.inputs[name])

    def constant(self, node, name):
        return self.values.constant(node.inputs[name], node, name)

    def normal(self, node, name="Normal"):
        """Keys of what bends the normal."""
        socket = node.inputs.get(name)
        output = origin(socket) if socket is not None else None
        if output is None:
            return {}
        bend = output.node
        if bend.type == "NORMAL_MAP":
            return self._normal_map(bend)
        if bend.type == "BUMP":
            return self._bump(bend)
        self.values.report(bend, f"a normal by the node {bend.bl_label}", "the surface's own normal")
        return {}

    def _normal_map(self, bend):
        if bend.space != "TANGENT":
            self.values.report(bend, f"a normal map in the space {bend.space}", "left out")
            return {}
        picture = self.values.color(bend.inputs["Color"])
        if not isinstance(picture, Picture):
            return {}
        if bend.uv_map and picture.source == ("uv", ""):
            picture = Picture(picture.name, ("uv", bend.uv_map), picture.affine, picture.wrap, picture.filter, picture.image, picture._pixels)
        strength = self.values.constant(bend.inputs["Strength"], bend, "Strength")
        if picture.image is not None and not picture.image.is_float and picture.image.colorspace_settings.name == "sRGB":
            # What Blender reads: the decoded texels.
            picture = picture.with_pixels(picture.pixels)
        if abs(strength - 1) > 1e-6:
            # Cycles: x and y times the strength, z from 1 to the map's.
            def bent(pixels):
                x, y, z = (2 * pixels[..., k : k + 1] - 1 for k in range(3))
                share = min(max(strength, 0.0), 1.0)
                normal = numpy.concatenate([x * strength, y * strength, 1 + share * (z - 1)], axis=-1)
                normal = normal / numpy.maximum(numpy.linalg.norm(normal, axis=-1, keepdims=True), 1e-6)
                return numpy.concatenate([(normal + 1) / 2, pixels[..., 3:]], axis=-1)

            picture = self.values.apply(bent, picture)
        return {"normal_map": picture, "normal_shadowing": True}

    def _bump(self, bend):
        if origin(bend.inputs["Normal"]) is not None:
            self.values.report(bend, "a bump above another one", "the last one alone")
        height = self.values.color(bend.inputs["Height"])
        if not isinstance(height, Picture):
            return {}
        height = self.values.luminance(height)
        if height.channel is not None or height.image is not None and height.image.colorspace_settings.name == "sRGB":
            height = height.with_channel(None).with_pixels(height.pixels)
        scale = self.values.constant(bend.inputs["Strength"], bend, "Strength") * self.values.constant(bend.inputs["Distance"], bend, "Distance")
        return {"bump_map": height, "bump_scale": -scale if bend.invert else scale, "normal_shadowing": True}

    def scaled(self, color, factor):
        """A colour times a constant colour, at most 1 in each channel."""
        if isinstance(color, Constant):
            return Constant([*(color.pixels[:3] * factor), 1])
        return Scaled(color, numpy.broadcast_to(factor, 3))


def most(value):
    """The largest channel that a colour has anywhere."""
    if isinstance(value, Scaled):
        return float((value.picture.pixels[..., :3].reshape(-1, 3).max(axis=0) * value.factor).max())
    return float(value.pixels[..., :3].max())


def mixed(surfaces, weight, first, second):
    """A blend; a mix with nothing by a number or a picture is the other one's opacity, through which lamps shine too."""
    for other, through, is_first in ((first, second, True), (second, first, False)):
        fits = through["type"] == "pass" and other["type"] not in ("pass", "blend", "emissive") and "opacity" not in other
        if fits and weight[0] == "value":
            share = weight[1] if is_first else surfaces.values.apply(
                lambda pixels: numpy.concatenate([1 - pixels[..., :3], pixels[..., 3:]], axis=-1), weight[1])
            if isinstance(share, Constant) and "emission" in other:
                continue
            return {**other, "opacity": share}
    return weights.blend(weight, first, second)


def light(surfaces, node, color_name, strength_name):
    color, strength = surfaces.color(node, color_name), surfaces.number(node, strength_name)
    if isinstance(strength, Constant):
        return surfaces.scaled(color, max(float(strength.pixels[0]), 0.0))
    return surfaces.values.apply(
        lambda color, strength: numpy.concatenate([color[..., :3] * strength[..., :1], numpy.ones_like(strength[..., :1])], axis=-1)
        if color.ndim == strength.ndim else color * strength, color, strength,
    )


def tangent(surfaces, node):
    output = origin(node.inputs["Tangent"]) if "Tangent" in node.inputs else None
    if output is None or output.node.type != "TANGENT" or output.node.direction_type != "UV_MAP":
        surfaces.values.report(node, "a tangent that does not follow the texture coordinates", "the direction in which u grows")
    rotation = node.inputs.get("Rotation") or node.inputs.get("Anisotropic Rotation")
    if rotation is not None and abs(surfaces.values.constant(rotation, node, "Rotation")) > 1e-6:
        surfaces.values.report(node, "a rotation of the tangent", "none")
