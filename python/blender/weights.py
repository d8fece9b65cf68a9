"""Numbers that depend on the view, as the weights of blends that gpt has (docs/blends.md).

A weight is a tuple: ("is", heuristic of a scene file), ("value", constant or picture), ("not", weight), ("both", weight, weight),
("between", weight, low, high): low + (high − low)·weight, or ("ramp", weight, function, steps).
"""

import numpy

from .values import Constant, origin

STEPS = 24
"""Steps by which a curve over a weight is said."""

VIEW_NODES = ("LAYER_WEIGHT", "FRESNEL", "NEW_GEOMETRY", "LIGHT_PATH")


def depends_on_view(socket):
    output = origin(socket)
    return output is not None and (
        output.node.type in VIEW_NODES or any(depends_on_view(inner) for inner in output.node.inputs if inner.type in ("VALUE", "RGBA"))
    )


def read(values, socket):
    """The number at a socket as a weight."""
    if not depends_on_view(socket):
        return ("value", values.luminance(values.color(socket)))
    output = origin(socket)
    node = output.node
    reader = READERS.get(node.type)
    weight = reader(values, node, output) if reader else None
    if weight is None:
        values.report(node, f"{node.bl_label} of what depends on the view", "the weight 0.5")
        return ("value", Constant([0.5, 0.5, 0.5, 1]))
    return weight


def number(value):
    return ("value", Constant([value, value, value, 1]))


def constant_of(weight):
    """The number of a constant weight, or None."""
    return float(weight[1].pixels[0]) if weight[0] == "value" and isinstance(weight[1], Constant) else None


def heuristic(weight):
    """A weight as one heuristic of a scene file, its pictures still pictures; None where it takes several blends."""
    if weight[0] == "is":
        return weight[1]
    if weight[0] == "not":
        inner = heuristic(weight[1])
        return None if inner is None else {"type": "reverse", "of": inner}
    if weight[0] == "value":
        constant = constant_of(weight)
        return {"type": "texture", "texture": weight[1]} if constant is None else {"type": "constant", "value": min(max(constant, 0.0), 1.0)}
    return None


def blend(weight, first, second):
    """first by the weight, second by the rest: nested blends where it takes several."""
    kind = weight[0]
    if kind == "value":
        constant = constant_of(weight)
        if constant is not None and (constant <= 0 or constant >= 1):
            return second if constant <= 0 else first
    if kind == "not":
        return blend(weight[1], second, first)
    if kind == "both":
        return blend(weight[1], blend(weight[2], first, second), second)
    if kind == "between":
        return blend(weight[1], blend(number(weight[3]), first, second), blend(number(weight[2]), first, second))
    if kind == "ramp":
        of = heuristic(weight[1])
        bounds = weight[3]
        middles = [(low + high) / 2 for low, high in zip([0.0, *bounds], [*bounds, 1.0])]
        entry = blend(number(weight[2](middles[0])), first, second)
        for bound, middle in zip(bounds, middles[1:]):
            step = blend(number(weight[2](middle)), first, second)
            entry = {"type": "blend", "materials": [step, entry], "weight": {"type": "threshold", "tau": bound, "of": of}}
        return entry
    return {"type": "blend", "materials": [first, second], "weight": heuristic(weight)}


def _layer_weight(values, node, output):
    share = values.constant(node.inputs["Blend"], node, "Blend")
    _flat(values, node)
    if output.identifier == "Fresnel":
        return ("not", ("is", {"type": "fresnel", "ior": 1 / max(1 - share, 1e-1), "exact": True}))
    # Cycles: 1 − |cos|^p, p = 2·blend below one half, 0.5/(1 − blend) above.
    share = min(max(share, 0.0), 1 - 1e-5)
    return ("not", ("is", {"type": "facing", "power": 2 * share if share < 0.5 else 0.5 / (1 - share)}))


def _fresnel(values, node, output):
    _flat(values, node)
    ior = min(max(values.constant(node.inputs["IOR"], node, "IOR"), 0.1), 10.0)
    return ("not", ("is", {"type": "fresnel", "ior": ior, "exact": True}))


def _flat(values, node):
    if origin(node.inputs["Normal"]) is not None:
        values.report(node, "a bent normal of a weight", "the normal of the materials that it blends")


def _geometry(values, node, output):
    return ("not", ("is", {"type": "front"})) if output.identifier == "Backfacing" else None


def _light_path(values, node, output):
    if output.identifier == "Is Camera Ray":
        return ("is", {"type": "camera"})
    values.report(node, f"the output {output.name}", "0")
    return number(0.0)


def _math(values, node, output):
    first, second = read(values, node.inputs[0]), read(values, node.inputs[1])
    a, b = constant_of(first), constant_of(second)
    if node.operation == "MULTIPLY":
        scale, other = (a, second) if a is not None else (b, first)
        return ("both", first, second) if scale is None else ("between", other, 0.0, scale)
    if node.operation == "ADD" and (a is None) != (b is None):
        offset, other = (a, second) if a is not None else (b, first)
        return ("between", other, offset, offset + 1) if offset == 0 else _curve(other, lambda x: x + offset)
    if node.operation == "SUBTRACT" and a is not None:
        return ("not", second) if a == 1 else _curve(second, lambda x: a - x)
    if node.operation == "SUBTRACT" and b is not None:
        return _curve(first, lambda x: x - b)
    if node.operation in ("GREATER_THAN", "LESS_THAN") and (a is None) != (b is None):
        bound, other, above = (b, first, node.operation == "GREATER_THAN") if a is None else (a, second, node.operation == "LESS_THAN")
        inner = heuristic(other)
        if inner is None:
            return None
        threshold = ("is", {"type": "threshold", "tau": bound, "of": inner})
        return threshold if above else ("not", threshold)
    if node.operation == "POWER" and b is not None:
        return _curve(first, lambda x: max(x, 0.0) ** b)
    return None


def _curve(weight, function, bounds=None):
    """A function of a weight in steps, each with its value in the middle."""
    if heuristic(weight) is None:
        return None
    clamped = lambda x: min(max(float(function(x)), 0.0), 1.0)
    return ("ramp", weight, clamped, bounds or [step / STEPS for step in range(1, STEPS)])


def _ramp(values, node, output):
    weight = read(values, node.inputs[0])
    ramp = node.color_ramp
    luminance = lambda x: float(numpy.dot(ramp.evaluate(x)[:3], [0.2126729, 0.7151522, 0.0721750]))
    value = (lambda x: ramp.evaluate(x)[3]) if output.identifier == "Alpha" else luminance
    stops = ramp.elements
    if ramp.interpolation == "CONSTANT":
        return _curve(weight, value, [stop.position for stop in stops if 0 < stop.position < 1])
    if ramp.interpolation == "LINEAR" and len(stops) == 2 and stops[0].position == 0 and stops[1].position == 1:
        return ("between", weight, value(0.0), value(1.0))
    return _curve(weight, value)


def _mix(values, node, output):
    if node.type == "MIX" and node.data_type not in ("FLOAT", "RGBA") or getattr(node, "blend_type", "MIX") != "MIX":
        return None
    kind = {"FLOAT": "Float", "RGBA": "Color"}[node.data_type] if node.type == "MIX" else None
    inputs = {socket.identifier: socket for socket in node.inputs}
    names = ("Factor_Float", f"A_{kind}", f"B_{kind}") if kind else tuple(socket.identifier for socket in node.inputs[:3])
    factor, first, second = (read(values, inputs[name]) for name in names)
    a, b = constant_of(first), constant_of(second)
    return None if a is None or b is None else ("between", factor, min(max(a, 0.0), 1.0), min(max(b, 0.0), 1.0))


def _map_range(values, node, output):
    weight, *limits = (read(values, socket) for socket in node.inputs[:5])
    low, high, to_low, to_high = (constant_of(limit) for limit in limits)
    if None in (low, high, to_low, to_high) or low == high:
        return None
    if (low, high) == (0, 1) and 0 <= min(to_low, to_high) and max(to_low, to_high) <= 1:
        return ("between", weight, to_low, to_high)
    return _curve(weight, lambda x: to_low + min(max((x - low) / (high - low), 0.0), 1.0) * (to_high - to_low))


READERS = {
    "LAYER_WEIGHT": _layer_weight,
    "FRESNEL": _fresnel,
    "NEW_GEOMETRY": _geometry,
    "LIGHT_PATH": _light_path,
    "MATH": _math,
    "MIX": _mix,
    "MIX_RGB": _mix,
    "MAP_RANGE": _map_range,
    "VALTORGB": _ramp,
    "RGBTOBW": lambda values, node, output: read(values, node.inputs[0]),
    "CLAMP": lambda values, node, output: read(values, node.inputs[0]),
    "INVERT": lambda values, node, output: ("not", read(values, node.inputs["Color"])),
}
