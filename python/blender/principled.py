"""The Principled BSDF as gpt's `principled`, which is glTF's."""

import math

import numpy

from . import weights
from .scene_file import grey
from .surfaces import light, mixed, tangent
from .values import Picture, is_constant, mean, origin


def read(surfaces, node):
    """The entry: a blend where metal, glass and the rest have colours of their own."""
    values = surfaces.values
    base = surfaces.color(node, "Base Color")
    metallic = surfaces.number(node, "Metallic")
    transmission = surfaces.number(node, "Transmission Weight")
    common = _common(surfaces, node)
    solid = {**common, "base_color": base, "metallic": metallic}
    solid.update(_subsurface(surfaces, node))
    if is_constant(transmission, [0, 0, 0]) or is_constant(metallic, [1, 1, 1]):
        entry = solid
    else:
        # Cycles tints by the root of the colour where light enters and where it leaves.
        root = values.apply(lambda pixels: numpy.concatenate([numpy.sqrt(numpy.maximum(pixels[..., :3], 0)), pixels[..., 3:]], axis=-1), base)
        body = {**common, "base_color": root, "metallic": 0.0, "transmission": 1.0}
        entry = body
        if not is_constant(transmission, [1, 1, 1]):
            entry = weights.blend(("value", values.luminance(transmission)), body, {**solid, "metallic": 0.0})
        if not is_constant(metallic, [0, 0, 0]):
            entry = weights.blend(("value", values.luminance(metallic)), {**common, "base_color": base, "metallic": 1.0}, entry)
    entry = _with_emission(surfaces, node, entry)
    alpha = surfaces.number(node, "Alpha")
    if not is_constant(alpha, [1, 1, 1]):
        if entry["type"] == "blend" or "emission" in entry:
            return mixed(surfaces, ("value", values.luminance(alpha)), entry, {"type": "pass"})
        entry = {**entry, "opacity": alpha}
    return entry


def _common(surfaces, node):
    """What metal, glass and the rest have in common."""
    ior, specular, tint = _interface(surfaces, node)
    entry = {
        "type": "principled",
        "roughness": surfaces.number(node, "Roughness"),
        "ior": ior,
        "masking": "height_correlated",
        "energy_compensation": node.distribution == "MULTI_GGX",
        **surfaces.normal(node),
    }
    if specular is not None:
        entry["specular"] = specular
    if tint is not None:
        entry["specular_color"] = tint
    _coat(surfaces, node, entry)
    _fibres(surfaces, node, entry)
    _anisotropy(surfaces, node, entry)
    if surfaces.constant(node, "Diffuse Roughness") > 0:
        surfaces.values.report(node, "a rough diffuse base", "Lambert's law")
    thickness = surfaces.constant(node, "Thin Film Thickness")
    if thickness > 0:
        entry["thin_film_thickness"] = thickness
        entry["thin_film_ior"] = min(max(surfaces.constant(node, "Thin Film IOR"), 1.0), 10.0)
    return entry


def _interface(surfaces, node):
    """Index of refraction, `specular` and `specular_color`. Cycles: the level scales the reflectance along the normal, and with it the index."""
    ior = min(max(surfaces.constant(node, "IOR"), 0.1), 10.0)
    level = surfaces.constant(node, "Specular IOR Level")
    tint = surfaces.color(node, "Specular Tint")
    along = ((ior - 1) / (ior + 1)) ** 2 * 2 * level
    specular = None
    if abs(level - 0.5) > 1e-6:
        root = math.sqrt(min(max(along, 0.0), 0.99))
        adjusted = (1 + root) / (1 - root)
        ior = min(adjusted if ior >= 1 else 1 / adjusted, 10.0)
    if along < 1e-6:
        specular = 0.0
    if is_constant(tint, [1, 1, 1]):
        return ior, specular, None
    metal = surfaces.number(node, "Metallic")
    if not is_constant(metal, [0, 0, 0]):
        surfaces.values.report(node, "a specular tint of metal", "white edges (Schlick)")
    return ior, specular, tint


def _coat(surfaces, node, entry):
    weight = surfaces.number(node, "Coat Weight")
    if is_constant(weight, [0, 0, 0]):
        return
    ior = surfaces.constant(node, "Coat IOR")
    if abs(ior - 1.5) > 1e-3:
        factor = ((ior - 1) / (ior + 1)) ** 2 / 0.04
        surfaces.values.report(node, f"a coat of the index {ior:g}", f"one of 1.5, by {min(factor, 1):.3g} of its weight")
        weight = surfaces.values.apply(lambda pixels: pixels * [*[min(factor, 1.0)] * 3, 1], weight)
    if not is_constant(surfaces.color(node, "Coat Tint"), [1, 1, 1]):
        surfaces.values.report(node, "a tinted coat", "a clear one")
    if origin(node.inputs["Coat Normal"]) is not None:
        bend = surfaces.normal(node, "Coat Normal")
        if "normal_map" in bend:
            surfaces.values.report(node, "a normal map of the coat", "the surface's own normal")
    entry["clearcoat"] = weight
    entry["clearcoat_roughness"] = surfaces.number(node, "Coat Roughness")


def _fibres(surfaces, node, entry):
    weight = surfaces.number(node, "Sheen Weight")
    if is_constant(weight, [0, 0, 0]):
        return
    surfaces.values.report(node, "sheen by Cycles' model", "sheen by Estevez and Kulla's")
    entry["sheen_color"] = surfaces.values.apply(
        lambda weight, tint: numpy.concatenate([weight[..., :1] * tint[..., :3], numpy.ones_like((weight * tint)[..., :1])], axis=-1),
        weight, surfaces.color(node, "Sheen Tint"),
    )
    entry["sheen_roughness"] = surfaces.number(node, "Sheen Roughness")


def _anisotropy(surfaces, node, entry):
    """Cycles: α/aspect along the tangent and α·aspect across it, aspect = √(1 − 0.9·a); here α + (1 − α)·a² and α."""
    strength = surfaces.constant(node, "Anisotropic")
    if strength < 1e-6:
        return
    roughness = float(mean(surfaces.number(node, "Roughness"))[0])
    aspect = math.sqrt(1 - 0.9 * min(strength, 1.0))
    wide, narrow = min(roughness**2 / aspect, 1.0), roughness**2 * aspect
    if isinstance(entry["roughness"], Picture):
        surfaces.values.report(node, "a picture of the roughness of what is anisotropic", f"its mean, {roughness:.3g}")
    entry["roughness"] = math.sqrt(narrow)
    entry["anisotropy"] = math.sqrt(max(wide - narrow, 0.0) / max(1 - narrow, 1e-6))
    tangent(surfaces, node)


def _subsurface(surfaces, node):
    weight = surfaces.number(node, "Subsurface Weight")
    if is_constant(weight, [0, 0, 0]):
        return {}
    scale = surfaces.constant(node, "Subsurface Scale")
    radius = numpy.maximum(mean(surfaces.color(node, "Subsurface Radius"))[:3] * scale, 1e-5)
    surfaces.values.report(node, "Cycles' scattering below the surface", "gpt's, which is a random walk of the same mean free path")
    anisotropy = surfaces.constant(node, "Subsurface Anisotropy")
    entry = {"subsurface": weight, "subsurface_radius": grey(radius)}
    if anisotropy:
        entry["subsurface_anisotropy"] = min(max(anisotropy, -0.99), 0.99)
    return entry


def _with_emission(surfaces, node, entry):
    strength, color = surfaces.number(node, "Emission Strength"), surfaces.color(node, "Emission Color")
    if is_constant(strength, [0, 0, 0]) or is_constant(color, [0, 0, 0]):
        return entry
    return {**entry, "emission": light(surfaces, node, "Emission Color", "Emission Strength"), "emission_two_sided": True}
