"""Blender's shader nodes as materials, one function each: (surfaces, node) -> entry."""

import math

import numpy

from . import principled, weights
from .scene_file import grey
from .surfaces import BLACK, WHITE, Scaled, light, mixed, most, tangent
from .values import Constant, Picture, is_constant, mean


def _diffuse(surfaces, node):
    color, roughness = surfaces.color(node, "Color"), surfaces.number(node, "Roughness")
    entry = {"type": "diffuse", "reflectance": color}
    if not is_constant(roughness, [0, 0, 0]):
        entry = {"type": "oren_nayar", "reflectance": color, "roughness": roughness}
    return {**entry, **surfaces.normal(node)}


def _translucent(surfaces, node):
    return {"type": "diffuse_transmission", "reflectance": BLACK, "transmittance": surfaces.color(node, "Color"), **surfaces.normal(node)}


def _transparent(surfaces, node):
    color = surfaces.color(node, "Color")
    if is_constant(color, [1, 1, 1]):
        return {"type": "pass"}
    black = {"type": "diffuse", "reflectance": BLACK}
    pixels = color.pixels
    if numpy.allclose(pixels[..., 0], pixels[..., 1], atol=1e-4) and numpy.allclose(pixels[..., 0], pixels[..., 2], atol=1e-4):
        return mixed(surfaces, ("value", surfaces.values.luminance(color)), {"type": "pass"}, black)
    surfaces.values.report(node, "a coloured transparency", "a coloured pane that bends nothing: lamps without a surface do not shine through")
    return {"type": "glass", "ior": 1.0, "thin": True, "transmittance": color}


def _widths(surfaces, node, anisotropy_name="Anisotropy"):
    """Keys of the width of microfacets. Cycles: α = roughness²."""
    roughness = surfaces.number(node, "Roughness")
    socket = node.inputs.get(anisotropy_name)
    strength = surfaces.values.constant(socket, node, anisotropy_name) if socket is not None else 0.0
    if abs(strength) < 1e-6:
        if isinstance(roughness, Constant) and float(roughness.pixels[0]) < 1e-3:
            return {"alpha": 0.0}
        return {"roughness": roughness}
    value = float(mean(roughness)[0])
    if not isinstance(roughness, Constant):
        surfaces.values.report(node, "a picture of the roughness of what is anisotropic", f"its mean, {value:.3g}")
    # Cycles: above 0 narrow along the tangent and wide across it, below 0 the other way round.
    strength = min(max(strength, -0.99), 0.99)
    along, across = (value**2 / (1 + strength), value**2 * (1 + strength)) if strength < 0 else (value**2 * (1 - strength), value**2 / (1 - strength))
    along, across = min(along, 1.0), min(across, 1.0)
    tangent(surfaces, node)
    return {"alpha_u": along, "alpha_v": across}


def _glossy(surfaces, node):
    """Microfacets of one colour at all angles: those of a metal that reflects everything, times the colour."""
    color = surfaces.color(node, "Color")
    widths = _widths(surfaces, node)
    entry = {"type": "conductor", "reflectance": 1.0, "specular_reflectance": color, **widths, **surfaces.normal(node)}
    entry["distribution"] = "beckmann" if node.distribution == "BECKMANN" else "ggx"
    if node.distribution == "ASHIKHMIN_SHIRLEY":
        surfaces.values.report(node, "Ashikhmin and Shirley's distribution", "GGX")
    if node.distribution == "MULTI_GGX":
        rough = widths.get("roughness")
        value = float(mean(rough)[0]) if rough is not None else math.sqrt(max(widths.get("alpha_u", 0.0), widths.get("alpha_v", 0.0)))
        kept = share_kept(value)
        brightest = most(color)
        if kept < 0.99:
            darker = f", {100 * (1 - 1 / max(brightest / kept, 1)):.0f} % darker" if brightest > kept else ""
            surfaces.values.report(node, "light that microfacets send to each other (Multiscatter GGX)", f"as much light by single scattering{darker}")
        entry["specular_reflectance"] = surfaces.scaled(color, min(1 / kept, 1 / max(brightest, 1e-6) if brightest <= 1 else 1.0))
    return entry


def share_kept(roughness):
    """The share of diffuse light that white GGX microfacets (α = roughness², Smith's height-correlated masking) reflect at once.

    Integrated over cosines of the view by the visible normals of Heitz (2018), on a fixed grid of numbers.
    """
    alpha = max(float(roughness), 1e-3) ** 2
    count = 32
    grid = (numpy.arange(count) + 0.5) / count
    cosine, first, second = numpy.meshgrid(grid, grid, grid, indexing="ij")
    view = numpy.stack([numpy.sqrt(1 - cosine**2), numpy.zeros_like(cosine), cosine], axis=-1)
    stretched = view * numpy.array([alpha, alpha, 1])
    stretched /= numpy.linalg.norm(stretched, axis=-1, keepdims=True)
    across = numpy.stack([-stretched[..., 1], stretched[..., 0], numpy.zeros_like(cosine)], axis=-1)
    length = numpy.linalg.norm(across, axis=-1, keepdims=True)
    across = numpy.where(length > 1e-9, across / numpy.maximum(length, 1e-9), numpy.array([1.0, 0, 0]))
    beyond = numpy.cross(stretched, across)
    radius, angle = numpy.sqrt(first), 2 * math.pi * second
    x, y = radius * numpy.cos(angle), radius * numpy.sin(angle)
    share = 0.5 * (1 + stretched[..., 2])
    y = (1 - share) * numpy.sqrt(numpy.maximum(0, 1 - x * x)) + share * y
    z = numpy.sqrt(numpy.maximum(0, 1 - x * x - y * y))
    normal = x[..., None] * across + y[..., None] * beyond + z[..., None] * stretched
    normal = normal * numpy.array([alpha, alpha, 1])
    normal /= numpy.linalg.norm(normal, axis=-1, keepdims=True)
    light = 2 * (view * normal).sum(axis=-1, keepdims=True) * normal - view

    def hidden(z):
        z = numpy.maximum(z, 1e-6)
        return 0.5 * (numpy.sqrt(1 + alpha**2 * (1 - z * z) / (z * z)) - 1)

    kept = numpy.where(light[..., 2] > 0, (1 + hidden(cosine)) / (1 + hidden(cosine) + hidden(light[..., 2])), 0)
    return float((kept * cosine).sum() / cosine.sum())


def _glass(surfaces, node):
    color = surfaces.color(node, "Color")
    ior = surfaces.constant(node, "IOR")
    return {**_dielectric(surfaces, node, ior), "reflectance": color, "transmittance": color, **surfaces.normal(node), **_film(surfaces, node)}


def _dielectric(surfaces, node, ior):
    roughness = surfaces.number(node, "Roughness")
    smooth = isinstance(roughness, Constant) and float(roughness.pixels[0]) < 1e-3
    entry = {"type": "glass" if smooth else "rough_glass", "ior": min(max(ior, 0.1), 10.0)}
    if not smooth:
        entry["roughness"] = roughness
        entry["distribution"] = "beckmann" if node.distribution == "BECKMANN" else "ggx"
        if node.distribution == "MULTI_GGX" and float(mean(roughness)[0]) > 0.2:
            surfaces.values.report(node, "light that microfacets send to each other (Multiscatter GGX)", "single scattering, which is darker")
    return entry


def _film(surfaces, node):
    thickness = node.inputs.get("Thin Film Thickness")
    if thickness is None or surfaces.values.constant(thickness, node, "Thin Film Thickness") <= 0:
        return {}
    return {
        "thin_film_thickness": float(mean(surfaces.values.color(thickness))[0]),
        "thin_film_ior": min(max(surfaces.constant(node, "Thin Film IOR"), 1.0), 10.0),
    }


def _refraction(surfaces, node):
    color = surfaces.color(node, "Color")
    ior = surfaces.constant(node, "IOR")
    surfaces.values.report(node, "refraction without reflection", "glass that reflects nothing and loses what glass reflects")
    return {**_dielectric(surfaces, node, ior), "reflectance": BLACK, "transmittance": color, **surfaces.normal(node)}


def _metallic(surfaces, node):
    widths = _widths(surfaces, node)
    multiple = node.distribution == "MULTI_GGX"
    if node.fresnel_type != "PHYSICAL_CONDUCTOR" and "roughness" in widths and node.distribution != "BECKMANN":
        if not is_constant(surfaces.color(node, "Edge Tint"), [1, 1, 1]):
            surfaces.values.report(node, "an edge tint", "white edges (Schlick)")
        return {
            "type": "principled", "base_color": surfaces.color(node, "Base Color"), "metallic": 1.0, **widths, "masking": "height_correlated",
            "energy_compensation": multiple, **surfaces.normal(node), **_film(surfaces, node),
        }
    rough = max(float(mean(widths["roughness"])[0]) ** 2 if "roughness" in widths else 0.0, widths.get("alpha_u", 0.0), widths.get("alpha_v", 0.0))
    if multiple and rough > 0.05:
        surfaces.values.report(node, "light that microfacets send to each other (Multiscatter GGX)", "single scattering, which is darker")
    entry = {"type": "conductor", **widths, "distribution": "beckmann" if node.distribution == "BECKMANN" else "ggx", **surfaces.normal(node)}
    if node.fresnel_type == "PHYSICAL_CONDUCTOR":
        for key, name in (("eta", "IOR"), ("k", "Extinction")):
            value = surfaces.color(node, name)
            if isinstance(value, Picture):
                surfaces.values.report(node, f"a picture as {name}", "its mean")
            entry[key] = Constant(numpy.maximum(mean(value), 1e-3))
    else:
        entry["reflectance"] = surfaces.color(node, "Base Color")
        if not is_constant(surfaces.color(node, "Edge Tint"), [1, 1, 1]):
            surfaces.values.report(node, "an edge tint", "white edges (Schlick)")
    return {**entry, **_film(surfaces, node)}


def _emission(surfaces, node):
    return {"type": "emissive", "radiance": light(surfaces, node, "Color", "Strength"), "two_sided": True}


def _sheen(surfaces, node):
    surfaces.values.report(node, f"sheen by the model {node.distribution}", "sheen by Estevez and Kulla's")
    return {
        "type": "principled", "base_color": BLACK, "metallic": 0.0, "specular": 0.0, "roughness": 1.0,
        "sheen_color": surfaces.color(node, "Color"), "sheen_roughness": surfaces.number(node, "Roughness"), **surfaces.normal(node),
    }


def _subsurface(surfaces, node):
    scale = surfaces.constant(node, "Scale")
    radius = numpy.maximum(mean(surfaces.color(node, "Radius"))[:3] * scale, 1e-5)
    color = surfaces.color(node, "Color")
    surfaces.values.report(node, "Cycles' scattering below the surface", "gpt's, which is a random walk of the same mean free path")
    return {
        "type": "principled", "base_color": color, "metallic": 0.0, "specular": 0.0, "roughness": 1.0,
        "subsurface": 1.0, "subsurface_radius": grey(radius), **surfaces.normal(node),
    }


def _mix_shader(surfaces, node):
    weight = weights.read(surfaces.values, node.inputs[0])
    constant = weights.constant_of(weight)
    if constant is not None and constant <= 0:
        return surfaces.of(node.inputs[1])
    if constant is not None and constant >= 1:
        return surfaces.of(node.inputs[2])
    return mixed(surfaces, weight, surfaces.of(node.inputs[2]), surfaces.of(node.inputs[1]))


def _add_shader(surfaces, node):
    first, second = surfaces.of(node.inputs[0]), surfaces.of(node.inputs[1])
    for light, other in ((first, second), (second, first)):
        if light["type"] == "emissive":
            return _withlight(surfaces, node, other, light["radiance"])
    if {first["type"], second["type"]} == {"diffuse", "diffuse_transmission"}:
        sheet, base = (first, second) if first["type"] == "diffuse_transmission" else (second, first)
        bends = ("normal_map", "bump_map")
        if is_constant(sheet["reflectance"], [0, 0, 0]) and not any(key in part for part in (sheet, base) for key in bends):
            if most(base["reflectance"]) + most(sheet["transmittance"]) > 1 + 1e-6:
                surfaces.values.report(node, "a sum that gives off more light than arrives", "both parts darkened to give off as much")
            return _fitted(base["reflectance"], sheet["transmittance"], surfaces)
    return _sum(surfaces, node, first, second)


def _fitted(reflectance, transmittance, surfaces):
    whole = max(most(reflectance) + most(transmittance), 1.0)
    return {
        "type": "diffuse_transmission",
        "reflectance": surfaces.scaled(reflectance, 1 / whole), "transmittance": surfaces.scaled(transmittance, 1 / whole),
    }


def _withlight(surfaces, node, other, radiance):
    if other["type"] == "emissive" or "emission" in other:
        key = "radiance" if other["type"] == "emissive" else "emission"
        sum_of = [part.picture if isinstance(part, Scaled) else part for part in (other[key], radiance)]
        factors = [part.factor if isinstance(part, Scaled) else numpy.ones(3) for part in (other[key], radiance)]
        total = surfaces.values.apply(
            lambda a, b: numpy.concatenate([a[..., :3] * factors[0] + b[..., :3] * factors[1], numpy.ones_like((a * b)[..., :1])], axis=-1), *sum_of)
        return {**other, key: total}
    if other["type"] == "pass":
        share = 1 / 64
        surfaces.values.report(node, "light from what is transparent", f"what lies behind is darker by {100 * share:.1f} %")
        return {"type": "diffuse", "reflectance": BLACK, "opacity": share, "emission": _brighter(surfaces, radiance, 1 / share), "emission_two_sided": True}
    return {**other, "emission": radiance, "emission_two_sided": True}


def _brighter(surfaces, radiance, factor):
    if isinstance(radiance, Scaled):
        return Scaled(radiance.picture, radiance.factor * factor)
    return surfaces.scaled(radiance, factor)


FACTORS = {
    "diffuse": ("reflectance",), "oren_nayar": ("reflectance",), "conductor": ("specular_reflectance",),
    "glass": ("reflectance", "transmittance"), "rough_glass": ("reflectance", "transmittance"),
    "diffuse_transmission": ("reflectance", "transmittance"),
}
"""Colours by which all that a material reflects and lets through is multiplied."""


def _sum(surfaces, node, first, second):
    """A + B = w·(A/w) + (1 − w)·(B/(1 − w)), where what both give off fits into one: their largest channels add up to 1 at most."""
    shares = [_brightness(part) for part in (first, second)]
    if None in shares:
        surfaces.values.report(node, "a sum of shaders of which one cannot be made brighter", "half of each")
        return weights.blend(weights.number(0.5), first, second)
    whole = sum(shares)
    if whole > 1 + 1e-6:
        surfaces.values.report(node, "a sum that gives off more light than arrives", f"{100 / whole:.0f} % of each")
    if whole <= 0:
        return first
    room = max(whole, 1.0)
    share = shares[0] / whole
    if share <= 0 or share >= 1:
        return first if share >= 1 else second
    return weights.blend(
        weights.number(share), _multiplied(surfaces, first, 1 / (room * share)), _multiplied(surfaces, second, 1 / (room * (1 - share))))


def _brightness(entry):
    if entry["type"] not in FACTORS or "opacity" in entry or "emission" in entry:
        return None
    keys = FACTORS[entry["type"]]
    values = [most(entry[key]) if key in entry else 1.0 for key in keys]
    return sum(values) if entry["type"] == "diffuse_transmission" else max(values)


def _multiplied(surfaces, entry, factor):
    changed = dict(entry)
    for key in FACTORS[entry["type"]]:
        changed[key] = _brighter(surfaces, entry.get(key, WHITE), factor)
    return changed


READERS = {
    "BSDF_PRINCIPLED": principled.read,
    "BSDF_DIFFUSE": _diffuse,
    "BSDF_GLOSSY": _glossy,
    "BSDF_ANISOTROPIC": _glossy,
    "BSDF_METALLIC": _metallic,
    "BSDF_GLASS": _glass,
    "BSDF_REFRACTION": _refraction,
    "BSDF_TRANSLUCENT": _translucent,
    "BSDF_TRANSPARENT": _transparent,
    "BSDF_SHEEN": _sheen,
    "SUBSURFACE_SCATTERING": _subsurface,
    "EMISSION": _emission,
    "MIX_SHADER": _mix_shader,
    "ADD_SHADER": _add_shader,
    "HOLDOUT": lambda surfaces, node: (surfaces.values.report(node, "a holdout", "black"), {"type": "diffuse", "reflectance": BLACK})[1],
}
