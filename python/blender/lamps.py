"""Lamps: Blender's watts and shapes as radiance, intensity and irradiance.

In Cycles the radiance of a lamp's surface is P/(π A), P being its power and A the area of the surface:

- a point lamp of radius r is a sphere, A = 4π r², so its intensity is P/(4π) W/sr whatever its radius; a spot is that within its cone;
- an area lamp shines from its front;
- a sun's strength is the irradiance E on a surface that faces it: with the angle α its disk has the radiance E/(π sin²(α/2)).

With `normalize` off, the radiance is P/π whatever the size, and a sun's is its strength.
"""

import math

import numpy

from .scene_file import grey, point

SUN_DISTANCE = 3000
"""Distance of a sun's disk in radii of the scene: seen from its ends, the disk is 0.04 degrees apart."""


def has_light(thing):
    """True of a lamp, not of a mesh that glows."""
    return thing.type == "LIGHT"


def export(instance, file, report, scene_sphere, graph, links):
    """Adds a lamp. `scene_sphere` is the middle and the radius of a sphere about all else; `links` says what lamps light."""
    lamp_object = instance.object
    lamp = lamp_object.data
    where = f"lamp {lamp_object.name}"
    power = _power(lamp, where, report, graph)
    if max(power) <= 0:
        return
    matrix = numpy.array(instance.matrix_world)
    axes = matrix[:3, :3]
    lengths = numpy.linalg.norm(axes, axis=0)
    directions = axes / numpy.where(lengths > 0, lengths, 1)
    position = matrix[:3, 3]
    _unsaid(lamp_object, lamp, where, report)
    linked = links.of_lamp(lamp_object, report)
    if linked is None:
        return
    lights, materials = len(file.lights), len(file.materials)
    hidden = not lamp_object.visible_camera
    if lamp.type == "POINT":
        _point(lamp, power, position, hidden, where, file, report)
    elif lamp.type == "SPOT":
        _spot(lamp, power, position, directions, lengths, where, file, report)
    elif lamp.type == "AREA":
        _area(lamp, power, position, directions, lengths, hidden, where, file, report)
    elif lamp.type == "SUN":
        _sun(lamp, power, directions, hidden, where, file, scene_sphere)
    else:
        report.add(where, f"a lamp of the type {lamp.type}", "left out")
    # The last material added is that of the lamp's surface, a blend behind its parts.
    for entry in [*file.lights[lights:], *file.materials[max(materials, len(file.materials) - 1):]]:
        entry.update(linked)


def _power(lamp, where, report, graph):
    """Power in watts of red, green and blue; a sun's irradiance."""
    color = numpy.array(lamp.color[:], dtype=float)
    if getattr(lamp, "use_temperature", False):
        color = color * numpy.array(lamp.temperature_color[:])
    power = color * lamp.energy * 2.0 ** getattr(lamp, "exposure", 0.0)
    if lamp.use_nodes and lamp.node_tree is not None:
        power = power * graph.lamp_factor(lamp, where)
    if min(power) < 0:
        report.add(where, "a negative power", "no light")
        power = numpy.maximum(power, 0)
    return power


def _unsaid(lamp_object, lamp, where, report):
    if lamp.type == "AREA" and lamp.spread < math.pi - 1e-4:
        report.add(where, f"a spread of {math.degrees(lamp.spread):g} degrees", "it shines in all directions of its front, with the same radiance along its axis")
    for name in ("diffuse", "glossy", "transmission", "volume_scatter"):
        if not getattr(lamp_object, f"visible_{name}", True):
            report.add(where, f"invisible to {name} rays", "it is seen by them")
    if not lamp.use_shadow:
        report.add(where, "casts no shadows", "it does")
    if getattr(lamp.cycles, "is_portal", False):
        report.add(where, "a portal", "a lamp")
    linking = getattr(lamp_object, "light_linking", None)
    if linking and linking.blocker_collection:
        report.add(where, "shadow linking", "everything throws shadows of it")


COVER = 1 / 256
"""How much of a lamp's surface there is: in Cycles all light passes a lamp, so it shows what lies behind, besides its own light."""


def _surface(file, where, radiance, hidden):
    """The material of a lamp's surface, which emits from its front."""
    name = where.removeprefix("lamp ")
    entry = {"type": "diffuse", "reflectance": 0, "opacity": COVER, "emission": grey(numpy.asarray(radiance) / COVER)}
    if hidden:
        entry = {"type": "blend", "materials": [{"type": "pass"}, entry], "weight": {"type": "camera"}}
    return file.add_material(entry, f"lamp {name}")


def _point(lamp, power, position, hidden, where, file, report):
    radius = lamp.shadow_soft_size
    if radius <= 0:
        file.lights.append({"type": "point", "position": point(position), "intensity": grey(power / (4 * math.pi))})
        return
    radiance = power / math.pi / (4 * math.pi * radius * radius if lamp.normalize else 1)
    if getattr(lamp, "use_soft_falloff", False):
        report.add(where, "a soft falloff", "a sphere all the same: only what is nearer than some radii looks different")
    material = _surface(file, where, radiance, hidden)
    file.shapes.append({"type": "sphere", "center": point(position), "radius": radius, "material": material})


def _spot(lamp, power, position, directions, lengths, where, file, report):
    radius = lamp.shadow_soft_size
    intensity = power / (4 * math.pi)
    if radius > 0:
        report.add(where, f"a spot of radius {radius:g}", "as much light from its middle; shadows are sharp")
        if not lamp.normalize:
            intensity = power * radius * radius
    if lamp.use_square:
        report.add(where, "a spot with a square cone", "a round cone")
    if max(lengths[0], lengths[1]) > 1.001 * min(lengths[0], lengths[1]) or abs(lengths[2] / lengths[0] - 1) > 1e-3:
        report.add(where, "a spot scaled unevenly", "a round cone of the angle it has without scale")
    # Cycles: a smoothstep over the cosine, from the cone's edge inward by the share `spot_blend` of 1 − cos.
    half = min(lamp.spot_size / 2, math.pi / 2)
    if lamp.spot_size > math.pi + 1e-4:
        report.add(where, f"a cone of {math.degrees(lamp.spot_size):g} degrees", "one of 180 degrees")
    edge = math.cos(half)
    full = min(edge + (1 - edge) * lamp.spot_blend, 1.0)
    file.lights.append({
        "type": "spot",
        "position": point(position),
        "direction": point(-directions[:, 2]),
        "intensity": grey(intensity),
        "angle": math.degrees(half),
        "falloff": math.degrees(math.acos(full)),
    })


def _area(lamp, power, position, directions, lengths, hidden, where, file, report):
    size_x = lamp.size * lengths[0]
    size_y = (lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size) * lengths[1]
    if min(size_x, size_y) <= 0:
        report.add(where, "an area of 0", "left out")
        return
    round_shape = lamp.shape in ("DISK", "ELLIPSE")
    area = size_x * size_y * (math.pi / 4 if round_shape else 1)
    radiance = power / math.pi / (area if lamp.normalize else 1)
    material = _surface(file, where, radiance, hidden)
    across, up = directions[:, 0] * size_x, directions[:, 1] * size_y
    if not round_shape:
        file.shapes.append({
            "type": "rectangle",
            "corner": point(position - across / 2 - up / 2),
            "edge_u": point(up),
            "edge_v": point(across),
            "material": material,
        })
    elif abs(size_x / size_y - 1) < 1e-6:
        file.shapes.append({
            "type": "disk",
            "center": point(position),
            "normal": point(-directions[:, 2]),
            "radius": float(size_x / 2),
            "material": material,
        })
    else:
        file.shapes.append({"type": "mesh", "material": material, **_ellipse(position, across / 2, up / 2)})


def _ellipse(middle, across, up, corners=128):
    """A fan of triangles that faces up × across, with the area of the ellipse."""
    step = 2 * math.pi / corners
    wider = math.sqrt(step / math.sin(step))
    rim = [middle + wider * (math.sin(step * k) * across + math.cos(step * k) * up) for k in range(corners)]
    return {
        "positions": [point(middle)] + [point(place) for place in rim],
        "faces": [[0, 1 + k, 1 + (k + 1) % corners] for k in range(corners)],
    }


def _sun(lamp, irradiance, directions, hidden, where, file, scene_sphere):
    travels = -directions[:, 2]
    half = lamp.angle / 2
    if half < 1e-5:
        file.lights.append({"type": "directional", "direction": point(travels), "irradiance": grey(irradiance)})
        return
    middle, radius = scene_sphere
    distance = SUN_DISTANCE * max(radius, 1e-3)
    half = min(half, math.radians(89))
    radiance = irradiance / (math.pi * math.sin(half) ** 2 if lamp.normalize else 1)
    file.shapes.append({
        "type": "disk",
        "center": point(middle - travels * distance),
        "normal": point(travels),
        "radius": float(distance * math.tan(half)),
        "material": _surface(file, where, radiance, hidden),
    })
