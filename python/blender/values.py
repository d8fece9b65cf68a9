"""What a node's input is: one colour, or a picture. Nodes between pictures and shaders are computed texel by texel."""

import math
import os

import numpy

from . import meshes
from .picture_file import from_srgb, write_exr

LUMINANCE = numpy.array([0.2126729, 0.7151522, 0.0721750], dtype=numpy.float32)
"""Shares of red, green and blue where Blender makes a number of a colour."""

LARGEST = 16_777_216
"""Most texels that are computed."""


class Constant:
    """The same colour everywhere: R, G, B and A."""

    def __init__(self, pixels):
        self.pixels = numpy.asarray(pixels, dtype=numpy.float32)


class Picture:
    """A picture on a surface.

    `image` is the Blender image, None where texels are computed. `affine` leads from the surface's coordinates, which `source` names, to the
    picture's: a matrix of 2 × 3. `channel` is the only one that counts, where there is one.
    """

    def __init__(self, name, source, affine, wrap="repeat", filter="bilinear", image=None, pixels=None, channel=None):
        self.name, self.source, self.affine, self.wrap, self.filter = name, source, affine, wrap, filter
        self.image, self._pixels, self.channel = image, pixels, channel

    @property
    def pixels(self):
        """Linear texels, rows from the top."""
        if self._pixels is None:
            self._pixels = linear_pixels(self.image)
        if self.channel is not None:
            return numpy.repeat(self._pixels[..., "rgba".index(self.channel), None], 4, axis=2)
        return self._pixels

    def with_pixels(self, pixels):
        return Picture(self.name, self.source, self.affine, self.wrap, self.filter, pixels=pixels.astype(numpy.float32))

    def with_channel(self, channel):
        return Picture(self.name, self.source, self.affine, self.wrap, self.filter, self.image, self._pixels, channel)

    def lies_as(self, other):
        return (
            self.source == other.source and numpy.allclose(self.affine, other.affine) and self.wrap == other.wrap
            and self.filter == other.filter and self.pixels.shape == other.pixels.shape
        )


def is_encoded(image):
    """Whether its texels are sRGB's; else they are linear."""
    return not image.is_float and image.colorspace_settings.name == "sRGB"


def linear_pixels(image):
    width, height = image.size
    pixels = numpy.empty(4 * width * height, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, 4)[::-1]
    if is_encoded(image):
        pixels = numpy.concatenate([from_srgb(pixels[..., :3]), pixels[..., 3:]], axis=2)
    return pixels


def mean(value):
    """The colour of a constant, and a picture's mean."""
    return value.pixels if isinstance(value, Constant) else value.pixels.reshape(-1, 4).mean(axis=0)


def is_constant(value, color=None):
    return isinstance(value, Constant) and (color is None or bool(numpy.allclose(value.pixels[:3], color, atol=1e-6)))


def origin(socket):
    """The output that feeds an input, through reroutes and muted nodes; None where nothing does."""
    while socket.is_linked and socket.links:
        link = socket.links[0]
        if link.is_muted:
            return None
        output, node = link.from_socket, link.from_node
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute:
            inner = next((inner for inner in node.internal_links if inner.to_socket == output), None)
            if inner is None:
                return None
            socket = inner.from_socket
        else:
            return output
    return None


def by_identifier(sockets, identifier):
    return next((socket for socket in sockets if socket.identifier == identifier), None)


class Mesh:
    """The mesh for which a material is read: colours of its corners are pictures that no other mesh has."""

    def __init__(self, mesh, found, where):
        self.mesh, self.found, self.where, self.used = mesh, found, where, False


class Values:
    """Reads inputs of nodes. `where` names the material in reports; `mesh` is the mesh that has it, or None."""

    def __init__(self, report, where, mesh=None):
        self._report, self.where, self._mesh = report, where, mesh

    def report(self, node, what, instead):
        self._report.add(f"{self.where}, node {node.label or node.name}", what, instead)

    def color(self, socket):
        output = origin(socket)
        if output is None:
            return Constant(_default(socket))
        value = self._of(output)
        if socket.type == "VALUE" and output.type in ("RGBA", "VECTOR"):
            return self.luminance(value, vector=output.type == "VECTOR")
        return value

    def constant(self, socket, node, name):
        """One number, a picture's mean where there is a picture."""
        value = self.color(socket)
        if not isinstance(value, Constant):
            self.report(node, f"a picture as {name}", f"its mean, {mean(value)[0]:.3g}")
        return float(mean(value)[0])

    def luminance(self, value, vector=False):
        weights = numpy.array([1 / 3] * 3, dtype=numpy.float32) if vector else LUMINANCE
        if isinstance(value, Picture):
            if value.channel is not None:
                return value
            pixels = value.pixels
            if numpy.array_equal(pixels[..., 0], pixels[..., 1]) and numpy.array_equal(pixels[..., 0], pixels[..., 2]):
                return value.with_channel("r")
        return self.apply(lambda pixels: _grey(pixels[..., :3] @ weights, pixels), value)

    def apply(self, function, *values):
        """Computes texel by texel. Pictures that do not lie as the first one does count by their means."""
        pictures = [value for value in values if isinstance(value, Picture)]
        if not pictures:
            return Constant(function(*[value.pixels for value in values]))
        lead = pictures[0]
        inputs = []
        for value in values:
            if isinstance(value, Picture) and not value.lies_as(lead):
                self._report.add(self.where, f"pictures that lie differently, {lead.name} and {value.name}, in one computation",
                                 f"the mean of {value.name}")
                inputs.append(mean(value))
            else:
                inputs.append(value.pixels)
        return lead.with_pixels(numpy.broadcast_to(function(*inputs), lead.pixels.shape))

    def _of(self, output):
        node = output.node
        reader = READERS.get(node.type)
        if reader is None:
            self.report(node, f"the node {node.bl_label}", "the grey 0.5")
            return Constant([0.5, 0.5, 0.5, 1])
        return reader(self, node, output)

    # Coordinates

    def coordinates(self, socket):
        """The source of texture coordinates, and the affine map from them."""
        identity = numpy.array([[1.0, 0, 0], [0, 1, 0]])
        output = origin(socket)
        if output is None:
            return ("uv", ""), identity
        node = output.node
        if node.type == "UVMAP":
            return ("uv", node.uv_map), identity
        if node.type == "TEX_COORD":
            kind = output.identifier
            if kind == "UV":
                return ("uv", ""), identity
            if kind == "Generated":
                return ("generated",), identity
            if kind == "Object" and node.object is None:
                return ("object",), identity
            self.report(node, f"the coordinates {kind}", "the active UV map")
            return ("uv", ""), identity
        if node.type == "ATTRIBUTE" and node.attribute_type == "GEOMETRY":
            return ("uv", node.attribute_name), identity
        if node.type == "MAPPING":
            source, affine = self.coordinates(node.inputs["Vector"])
            return source, _compose(self._mapping(node), affine)
        self.report(node, f"coordinates by the node {node.bl_label}", "the active UV map")
        return ("uv", ""), identity

    def _mapping(self, node):
        location, rotation, scale = (
            [float(x) for x in mean(self.color(node.inputs[name]))[:3]] if name in node.inputs else [0, 0, 0]
            for name in ("Location", "Rotation", "Scale")
        )
        if abs(rotation[0]) > 1e-6 or abs(rotation[1]) > 1e-6:
            self.report(node, "a rotation about x or y", "the rotation about z alone")
        cosine, sine = math.cos(rotation[2]), math.sin(rotation[2])
        turn = numpy.array([[cosine, -sine], [sine, cosine]])
        size = numpy.diag(scale[:2])
        shift = numpy.array(location[:2])
        if node.vector_type == "TEXTURE":
            inverse = numpy.diag([1 / s if s else 0 for s in scale[:2]]) @ turn.T
            return numpy.column_stack([inverse, -inverse @ shift])
        if node.vector_type in ("VECTOR", "NORMAL"):
            shift = numpy.zeros(2)
        return numpy.column_stack([turn @ size, shift])


def _compose(outer, inner):
    return numpy.column_stack([outer[:, :2] @ inner[:, :2], outer[:, :2] @ inner[:, 2] + outer[:, 2]])


def _default(socket):
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, (int, float)):
        return [value, value, value, 1]
    parts = [float(x) for x in value]
    return parts[:4] if len(parts) >= 4 else [*parts, 1]


def _grey(numbers, like):
    numbers = numpy.asarray(numbers)[..., None]
    return numpy.concatenate([numbers, numbers, numbers, numpy.broadcast_to(like[..., 3:], numbers.shape)], axis=-1)


# Nodes, one function each: (values, node, output) -> Constant or Picture.


def _image(values, node, output):
    image = node.image
    if image is None or not image.has_data and (image.pixels[0:1] is None or not image.size[0]):
        values.report(node, "no picture, or one that cannot be read", "Blender's pink")
        return Constant([1, 0, 1, 1])
    if image.source in ("MOVIE", "SEQUENCE", "TILED"):
        values.report(node, f"a picture of the kind {image.source}", "its first one")
    space = image.colorspace_settings.name
    if space not in ("sRGB", "Non-Color", "Linear Rec.709", "Raw", "Linear", "scene_linear"):
        values.report(node, f"the colour space {space}", "read as linear Rec.709" if image.is_float else "its texels are not converted")
    if node.projection != "FLAT":
        values.report(node, f"the projection {node.projection}", "flat, by the coordinates x and y")
    source, affine = values.coordinates(node.inputs["Vector"])
    wrap = {"REPEAT": "repeat", "EXTEND": "clamp", "MIRROR": "mirror"}.get(node.extension, "clamp")
    filter = "nearest" if node.interpolation == "Closest" else "bilinear"
    if node.interpolation in ("Cubic", "Smart"):
        values.report(node, f"the interpolation {node.interpolation}", "bilinear")
    picture = Picture(image.name, source, affine, wrap, filter, image=image)
    width, height = image.size
    if width * height > LARGEST:
        return picture.with_channel("a") if output.identifier == "Alpha" else picture
    if output.identifier == "Alpha" and image.channels < 4 and node.extension != "CLIP":
        return Constant([1, 1, 1, 1])
    # Cycles: a colour without its alpha is the colour times alpha, and with it what was multiplied is divided again.
    alpha_is_used = any(other.identifier == "Alpha" and other.is_linked for other in node.outputs)
    has_alpha = image.channels == 4 and image.alpha_mode in ("STRAIGHT", "PREMUL") and space != "Non-Color"
    is_multiplied = image.is_float or image.alpha_mode == "PREMUL"
    if output.identifier == "Color" and has_alpha and alpha_is_used == is_multiplied:
        pixels = picture.pixels
        alpha = pixels[..., 3:]
        if alpha.min() < 1:
            factor = 1 / numpy.where(alpha > 0, alpha, 1) if is_multiplied else alpha
            picture = picture.with_pixels(numpy.concatenate([pixels[..., :3] * factor, alpha], axis=2))
    if node.extension == "CLIP":
        pixels = numpy.zeros((height + 2, width + 2, 4), dtype=numpy.float32)
        pixels[1:-1, 1:-1] = picture.pixels
        inside = numpy.array([[width / (width + 2), 0, 1 / (width + 2)], [0, height / (height + 2), 1 / (height + 2)]])
        picture = Picture(image.name, source, _compose(inside, affine), "clamp", filter, pixels=pixels)
    return picture.with_channel("a") if output.identifier == "Alpha" else picture


def _checker(values, node, output):
    source, affine = values.coordinates(node.inputs["Vector"])
    scale = values.constant(node.inputs["Scale"], node, "scale")
    if output.identifier == "Fac":
        first, second = numpy.ones(4), numpy.array([0, 0, 0, 1.0])
    else:
        first, second = mean(values.color(node.inputs["Color1"])), mean(values.color(node.inputs["Color2"]))
    # The square at the origin has the second colour; rows from the top.
    pixels = numpy.array([[first, second], [second, first]], dtype=numpy.float32)
    halves = numpy.array([[scale / 2, 0, 0], [0, scale / 2, 0]])
    return Picture("checker", source, _compose(halves, affine), filter="nearest", pixels=pixels)


def _colors_of_corners(values, node, output):
    name = node.layer_name if node.type == "VERTEX_COLOR" else node.attribute_name
    if node.type == "ATTRIBUTE" and node.attribute_type != "GEOMETRY":
        values.report(node, f"an attribute of the kind {node.attribute_type}", "black")
        return Constant([0, 0, 0, 1])
    context = values._mesh
    if context is None:
        values.report(node, "colours of a mesh where there is none", "black")
        return Constant([0, 0, 0, 1])
    context.used = True
    colors = meshes.color_attribute(context.mesh, context.found, name)
    if colors is None:
        values.report(node, f"the attribute {name or '(active)'}, which {context.where} does not have", "black")
        return Constant([0, 0, 0, 1])
    identity = numpy.array([[1.0, 0, 0], [0, 1, 0]])
    picture = Picture(f"{context.where.removeprefix('object ')} {name}", ("blocks",), identity, filter="triangle", pixels=meshes.block_pixels(colors))
    if output.identifier == "Alpha":
        return picture.with_channel("a")
    return values.luminance(picture) if output.identifier == "Fac" else picture


def _math(values, node, output):
    function = MATH.get(node.operation)
    if function is None:
        values.report(node, f"the operation {node.operation}", "its first input")
        return values.color(node.inputs[0])
    inputs = [values.color(socket) for socket in node.inputs[:3]]

    def compute(a, b, c):
        result = function(a[..., 0], b[..., 0], c[..., 0])
        return _grey(numpy.clip(result, 0, 1) if node.use_clamp else result, a)

    return values.apply(compute, *inputs)


MATH = {
    "ADD": lambda a, b, c: a + b,
    "SUBTRACT": lambda a, b, c: a - b,
    "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": lambda a, b, c: numpy.where(b != 0, a / numpy.where(b != 0, b, 1), 0),
    "MULTIPLY_ADD": lambda a, b, c: a * b + c,
    "POWER": lambda a, b, c: numpy.power(numpy.maximum(a, 0), b),
    "SQRT": lambda a, b, c: numpy.sqrt(numpy.maximum(a, 0)),
    "ABSOLUTE": lambda a, b, c: numpy.abs(a),
    "EXPONENT": lambda a, b, c: numpy.exp(a),
    "MINIMUM": lambda a, b, c: numpy.minimum(a, b),
    "MAXIMUM": lambda a, b, c: numpy.maximum(a, b),
    "LESS_THAN": lambda a, b, c: (a < b) * 1.0,
    "GREATER_THAN": lambda a, b, c: (a > b) * 1.0,
    "SIGN": lambda a, b, c: numpy.sign(a),
    "ROUND": lambda a, b, c: numpy.floor(a + 0.5),
    "FLOOR": lambda a, b, c: numpy.floor(a),
    "CEIL": lambda a, b, c: numpy.ceil(a),
    "FRACT": lambda a, b, c: a - numpy.floor(a),
    "SINE": lambda a, b, c: numpy.sin(a),
    "COSINE": lambda a, b, c: numpy.cos(a),
}


def _mix(values, node, output):
    if node.type == "MIX":
        kind = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color", "ROTATION": "Rotation"}[node.data_type]
        factor = by_identifier(node.inputs, "Factor_Vector" if kind == "Vector" and node.factor_mode == "NON_UNIFORM" else "Factor_Float")
        a, b = by_identifier(node.inputs, f"A_{kind}"), by_identifier(node.inputs, f"B_{kind}")
        blend = node.blend_type if kind == "Color" else "MIX"
        clamp_factor, clamp_result = node.clamp_factor, node.clamp_result if kind == "Color" else False
    else:
        factor, a, b = node.inputs[0], node.inputs[1], node.inputs[2]
        blend, clamp_factor, clamp_result = node.blend_type, True, node.use_clamp
    function = BLENDS.get(blend)
    if function is None:
        values.report(node, f"the blend type {blend}", "MIX")
        function = BLENDS["MIX"]

    def compute(t, a, b):
        t = t[..., :3]
        t = numpy.clip(t, 0, 1) if clamp_factor else t
        colors = (1 - t) * a[..., :3] + t * function(a[..., :3], b[..., :3])
        colors = numpy.clip(colors, 0, 1) if clamp_result else colors
        shape = numpy.broadcast_shapes(colors.shape[:-1], a.shape[:-1]) + (1,)
        return numpy.concatenate([colors, numpy.broadcast_to(a[..., 3:], shape)], axis=-1)

    return values.apply(compute, values.color(factor), values.color(a), values.color(b))


BLENDS = {
    "MIX": lambda a, b: b,
    "ADD": lambda a, b: a + b,
    "MULTIPLY": lambda a, b: a * b,
    "SUBTRACT": lambda a, b: a - b,
    "SCREEN": lambda a, b: 1 - (1 - a) * (1 - b),
    "DIVIDE": lambda a, b: numpy.where(b != 0, a / numpy.where(b != 0, b, 1), a),
    "DIFFERENCE": lambda a, b: numpy.abs(a - b),
    "DARKEN": lambda a, b: numpy.minimum(a, b),
    "LIGHTEN": lambda a, b: numpy.maximum(a, b),
    "OVERLAY": lambda a, b: numpy.where(a < 0.5, 2 * a * b, 1 - 2 * (1 - a) * (1 - b)),
}


def _of_colors(function):
    """A node that changes R, G and B, and mixes by Fac where it has one."""

    def read(values, node, output):
        source = node.inputs["Color"]
        names = [socket for socket in node.inputs if socket != source]

        def compute(color, *others):
            changed = function(node, color[..., :3], {socket.name: other[..., :1] for socket, other in zip(names, others)})
            return numpy.concatenate([changed, numpy.broadcast_to(color[..., 3:], changed.shape[:-1] + (1,))], axis=-1)

        return values.apply(compute, values.color(source), *[values.color(socket) for socket in names])

    return read


def _faded(color, changed, inputs):
    name = "Factor" if "Factor" in inputs else "Fac"
    return color + inputs[name] * (changed - color) if name in inputs else changed


def _contrast(node, color, inputs):
    a, b = 1 + inputs["Contrast"], inputs["Brightness" if "Brightness" in inputs else "Bright"] - inputs["Contrast"] / 2
    return numpy.maximum(a * color + b, 0)


def _hue_saturation(node, color, inputs):
    high, low = color.max(axis=-1, keepdims=True), color.min(axis=-1, keepdims=True)
    span = high - low
    safe = numpy.where(span > 0, span, 1)
    r, g, b = color[..., :1], color[..., 1:2], color[..., 2:3]
    hue = numpy.where(high == r, (g - b) / safe, numpy.where(high == g, 2 + (b - r) / safe, 4 + (r - g) / safe)) / 6
    hue = numpy.where(span > 0, hue, 0) + inputs["Hue"] + 0.5
    saturation = numpy.clip(numpy.where(high > 0, span / numpy.where(high > 0, high, 1), 0) * inputs["Saturation"], 0, 1)
    value = high * inputs["Value"]
    ramp = numpy.concatenate([hue, hue + 2 / 3, hue + 1 / 3], axis=-1) % 1
    pure = numpy.clip(numpy.abs(ramp * 6 - 3) - 1, 0, 1)
    return _faded(color, numpy.maximum(value * (1 - saturation * (1 - pure)), 0), inputs)


def _curves(node, color, inputs):
    node.mapping.initialize()
    grid = numpy.linspace(0, 1, 1024)
    curves = node.mapping.curves
    table = [numpy.array([node.mapping.evaluate(curve, x) for x in grid]) for curve in curves]
    combined = numpy.interp(color, grid, table[3])
    changed = numpy.stack([numpy.interp(combined[..., k], grid, table[k]) for k in range(3)], axis=-1)
    return _faded(color, changed, inputs)


def _ramp(values, node, output):
    table = numpy.array([node.color_ramp.evaluate(x)[:] for x in numpy.linspace(0, 1, 4097)], dtype=numpy.float32)
    value = values.apply(
        lambda t: table[numpy.clip(numpy.rint(t[..., 0] * 4096), 0, 4096).astype(int)], values.color(node.inputs[0])
    )
    return _channel_of(values, value, 3) if output.identifier == "Alpha" else value


def _channel_of(values, value, index):
    return values.apply(lambda pixels: _grey(pixels[..., index], pixels), value)


def _separate(values, node, output):
    if getattr(node, "mode", "RGB") != "RGB":
        values.report(node, f"channels of {node.mode}", "those of RGB")
    index = next(k for k, other in enumerate(node.outputs) if other.identifier == output.identifier)
    value = values.color(node.inputs[0])
    if isinstance(value, Picture) and value.channel is None:
        return value.with_channel("rgb"[index])
    return _channel_of(values, value, index)


def _combine(values, node, output):
    if getattr(node, "mode", "RGB") != "RGB":
        values.report(node, f"channels of {node.mode}", "those of RGB")

    def compute(r, g, b):
        channels = numpy.broadcast_arrays(r[..., 0], g[..., 0], b[..., 0])
        return numpy.stack([*channels, numpy.ones_like(channels[0])], axis=-1)

    return values.apply(compute, *[values.color(socket) for socket in node.inputs[:3]])


def _map_range(values, node, output):
    if node.data_type != "FLOAT" or node.interpolation_type != "LINEAR":
        values.report(node, f"{node.data_type} by {node.interpolation_type}", "a linear map of the number")

    def compute(x, low, high, to_low, to_high):
        x, low, high, to_low, to_high = (part[..., 0] for part in (x, low, high, to_low, to_high))
        t = numpy.where(high != low, (x - low) / numpy.where(high != low, high - low, 1), 0)
        t = numpy.clip(t, 0, 1) if node.clamp else t
        return _grey(to_low + t * (to_high - to_low), numpy.ones(t.shape + (4,)))

    return values.apply(compute, *[values.color(socket) for socket in node.inputs[:5]])


def _clamp(values, node, output):
    return values.apply(
        lambda x, low, high: _grey(numpy.clip(x[..., 0], low[..., 0], high[..., 0]), x), *[values.color(socket) for socket in node.inputs[:3]]
    )


def _procedural(values, node, output):
    values.report(node, f"the procedural texture {node.bl_label}", "the grey 0.5; baked to a picture it comes across")
    return Constant([0.5, 0.5, 0.5, 1])


READERS = {
    "RGB": lambda values, node, output: Constant(output.default_value[:]),
    "VALUE": lambda values, node, output: Constant([output.default_value] * 3 + [1]),
    "TEX_IMAGE": _image,
    "TEX_CHECKER": _checker,
    "VERTEX_COLOR": _colors_of_corners,
    "ATTRIBUTE": _colors_of_corners,
    "MATH": _math,
    "MIX": _mix,
    "MIX_RGB": _mix,
    "INVERT": _of_colors(lambda node, color, inputs: _faded(color, 1 - color, inputs)),
    "GAMMA": _of_colors(lambda node, color, inputs: numpy.where(color > 0, numpy.maximum(color, 0) ** inputs["Gamma"], color)),
    "BRIGHTCONTRAST": _of_colors(_contrast),
    "HUE_SAT": _of_colors(_hue_saturation),
    "CURVE_RGB": _of_colors(_curves),
    "VALTORGB": _ramp,
    "SEPARATE_COLOR": _separate,
    "SEPRGB": _separate,
    "COMBINE_COLOR": _combine,
    "COMBRGB": _combine,
    "RGBTOBW": lambda values, node, output: values.luminance(values.color(node.inputs[0])),
    "MAP_RANGE": _map_range,
    "CLAMP": _clamp,
    **{
        kind: _procedural
        for kind in ("TEX_NOISE", "TEX_VORONOI", "TEX_WAVE", "TEX_MAGIC", "TEX_BRICK", "TEX_GRADIENT", "TEX_GABOR", "TEX_WHITE_NOISE")
    },
}


class Textures:
    """Writes pictures as textures of a scene file, each file once."""

    def __init__(self, file, report):
        self._file, self._report, self._files = file, report, {}

    def name(self, picture, where):
        entry = {"type": "image", **self._pixels(picture), "wrap": picture.wrap, "filter": picture.filter}
        entry.update(self._place(picture, where))
        return self._file.add_texture(entry, picture.name)

    def _pixels(self, picture):
        if picture._pixels is None or picture.image is not None:
            key = picture.image.name_full
            if key not in self._files:
                self._files[key] = self.copied(picture.image)
            return {"file": self._files[key], "color_space": "srgb" if is_encoded(picture.image) else "linear"}
        key = picture._pixels.tobytes(), picture._pixels.shape
        if key not in self._files:
            path, self._files[key] = self._file.new_file(picture.name, ".exr")
            write_exr(path, picture._pixels)
        return {"file": self._files[key], "color_space": "linear"}

    def copied(self, image):
        """The image's own bytes where there are some and gpt reads them, else its texels."""
        import bpy

        ending = os.path.splitext(image.filepath)[1].lower()
        known = ending in (".png", ".jpg", ".jpeg", ".exr", ".hdr", ".tga", ".bmp", ".tif", ".tiff", ".webp")
        data = None
        if known and image.source == "FILE" and not image.is_dirty:
            if image.packed_file is not None:
                data = bytes(image.packed_file.data)
            else:
                try:
                    with open(bpy.path.abspath(image.filepath, library=image.library), "rb") as file:
                        data = file.read()
                except OSError:
                    data = None
        stem = os.path.splitext(image.name)[0]
        if data is not None:
            path, reference = self._file.new_file(stem, ending)
            with open(path, "wb") as file:
                file.write(data)
            return reference
        path, reference = self._file.new_file(stem, ".exr")
        pixels = linear_pixels(image)
        if is_encoded(image):
            # The texture says that its texels are sRGB's.
            pixels = numpy.concatenate([_to_srgb(pixels[..., :3]), pixels[..., 3:]], axis=2)
        write_exr(path, pixels)
        return reference

    def _place(self, picture, where):
        """Scale, then turn, then offset: what the affine map is made of."""
        matrix, offset = picture.affine[:, :2], picture.affine[:, 2]
        along = float(numpy.hypot(*matrix[:, 0]))
        place = {}
        if along == 0:
            return {"scale": [0.0, 0.0], "offset": [float(x) for x in offset]} if not numpy.allclose(matrix, [[1, 0], [0, 1]]) else place
        cosine, sine = matrix[:, 0] / along
        across = float(-sine * matrix[0, 1] + cosine * matrix[1, 1])
        if abs(cosine * matrix[0, 1] + sine * matrix[1, 1]) > 1e-4 * max(along, abs(across)):
            self._report.add(where, f"a mapping of {picture.name} that shears", "without what shears")
        if abs(along - 1) > 1e-7 or abs(across - 1) > 1e-7:
            place["scale"] = [along, across]
        degrees = math.degrees(math.atan2(sine, cosine))
        if abs(degrees) > 1e-6:
            place["rotation"] = degrees
        if any(abs(offset) > 1e-9):
            place["offset"] = [float(x) for x in offset]
        return place


def _to_srgb(linear):
    return numpy.where(linear <= 0.0031308, linear * 12.92, 1.055 * numpy.maximum(linear, 0) ** (1 / 2.4) - 0.055)
