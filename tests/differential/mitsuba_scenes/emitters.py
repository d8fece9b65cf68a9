"""Cases of lights."""

from . import files, values
from .scene import Case, bsdf, camera, diffuse, element, emitter, flag, lit, look_at, number, path, point, rgb, rotate, scale, scene, shape, string, texture, transform, translate, vector

AIM = transform(look_at("1, 2, 4", "0.3, 0, 0"))


def cases():
    yield from colours()
    yield from places()
    yield from cones()
    yield from projectors()
    yield from maps()
    yield from surfaces()


def colours():
    slots = [
        ("point", "intensity", lambda *within: lit(emitter("point", point("position", 1, 1.5, 3), *within)), True),
        ("constant", "radiance", lambda *within: lit(emitter("constant", *within)), True),
        ("directional", "irradiance", lambda *within: lit(emitter("directional", vector("direction", -0.4, -0.5, -1), *within)), False),
        ("spot", "intensity", lambda *within: lit(emitter("spot", AIM, number("cutoff_angle", 35), *within)), False),
        ("projector", "irradiance", lambda *within: lit(emitter("projector", AIM, number("fov", 50), *within)), False),
        ("area", "radiance", lambda *within: lit(shape("rectangle", transform(rotate(0, 1, 0, 180), translate(-0.6, 0.6, 4)), emitter("area", *within))), True),
    ]
    for name, parameter, rig, whole in slots:
        for form, written in values.of_light(parameter):
            if whole or form in ("rgb of three", "float", "spectrum of one value", "spectrum of pairs", "d65 plugin", "blackbody plugin", "rawconstant of one"):
                yield Case("emitter", name, parameter, form, rig(written), rig(rgb(parameter, 0.7, 0.8, 0.9)))
        yield Case("emitter", name, parameter, "not given", rig(), rig(rgb(parameter, 0.7, 0.8, 0.9)))
        yield Case("emitter", name, "sampling_weight", "3", rig(rgb(parameter, 2), number("sampling_weight", 3)), None)


def places():
    light = rgb("intensity", 20, 18, 15)
    plain = lit(emitter("point", light, point("position", 2, 2, 3)))
    for form, where in [
        ("position", point("position", -1, 1, 2)),
        ("position by a vector", vector("position", -1, 1, 2)),
        ("position in one value", element("point", name="position", value="-1, 1, 2")),
        ("to_world", transform(translate(-1, 1, 2))),
        ("to_world with a scale", transform(translate(-1, 1, 2), scale(1.5))),
    ]:
        yield Case("emitter", "point", "position, to_world", form, lit(emitter("point", light, where)), plain)
    below = lambda *where: scene(path(2), camera("0, -1.5, 6", fov=36), shape("rectangle", transform(scale(3), translate(0, 0, -1.5)), diffuse(0.6, 0.55, 0.5)), emitter("point", light, *where))
    yield Case("emitter", "point", "position, to_world", "not given", below(), below(point("position", 0.3, 0.2, 0)))
    beam = rgb("irradiance", 3, 2.5, 2)
    plain = lit(emitter("directional", beam, vector("direction", 0.5, 0.5, -1)))
    for form, where in [
        ("direction", vector("direction", -0.4, -0.6, -1)),
        ("direction that is long", vector("direction", -4, -6, -10)),
        ("to_world", transform(rotate(1, 0, 0, 160), rotate(0, 1, 0, 20))),
        ("to_world with a scale", transform(scale(3), rotate(1, 0, 0, 160), rotate(0, 1, 0, 20))),
        ("to_world by lookat", transform(look_at("1, 2, 4", "0, 0, 0"))),
        ("to_world that mirrors", transform(look_at("1, 2, 4", "0, 0, 0"), scale(1, -1, 1))),
    ]:
        yield Case("emitter", "directional", "direction, to_world", form, lit(emitter("directional", beam, where)), plain)


def cones():
    spot = lambda *within: lit(emitter("spot", AIM, rgb("intensity", 30, 26, 20), *within))
    plain = spot()
    yield Case("emitter", "spot", "cutoff_angle", "not given", plain, spot(number("cutoff_angle", 30)))
    for cutoff in (8, 15, 30, 60, 85):
        yield Case("emitter", "spot", "cutoff_angle", str(cutoff), spot(number("cutoff_angle", cutoff)), plain)
    for cutoff, beam in ((30, 5), (30, 0), (30, 29), (30, 30)):
        yield Case("emitter", "spot", "beam_width", f"{beam} of {cutoff}", spot(number("cutoff_angle", cutoff), number("beam_width", beam)), spot(number("cutoff_angle", cutoff), number("beam_width", 18)))
    yield Case("emitter", "spot", "beam_width", "40 of 30", spot(number("cutoff_angle", 30), number("beam_width", 40)), None)
    wide = number("cutoff_angle", 35)
    for form, made in [
        ("nearest", values.bitmap("texture", files.COLOURS)),
        ("bilinear", values.bitmap("texture", files.COLOURS, filter_="bilinear")),
        ("raw", values.bitmap("texture", files.COLOURS, raw=True)),
        ("checkerboard", texture("checkerboard", name="texture")),
        ("rgb", rgb("texture", 0.5, 0.3, 0.9)),
        ("to_uv", values.bitmap("texture", files.COLOURS, transform(rotate(0, 0, 1, 30), scale(1.7, 1.2, 1), name="to_uv"))),
    ]:
        yield Case("emitter", "spot", "texture", form, spot(wide, made), spot(wide))
    made = values.bitmap("texture", files.COLOURS)
    for form, steps in turns().items():
        yield Case("emitter", "spot", "to_world", form, lit(emitter("spot", rgb("intensity", 30), wide, made, transform(*steps))), spot(wide))


def turns():
    aim = look_at("1, 2, 4", "0.3, 0, 0")
    return {
        "lookat": (aim,),
        "lookat of another up": (look_at("1, 2, 4", "0.3, 0, 0", "1, 0.3, 0"),),
        "turned about its axis": (rotate(0, 0, 1, 35), aim),
        "mirrored in x": (scale(-1, 1, 1), aim),
        "mirrored in y": (scale(1, -1, 1), aim),
        "mirrored in the world": (aim, scale(-1, 1, 1)),
        "scaled": (scale(2), aim),
        "scaled in the world": (look_at("0.5, 1, 2", "0.15, 0, 0"), scale(2)),
        "translation and turns": (rotate(0, 1, 0, 170), rotate(1, 0, 0, 15), translate(0.4, 0.6, 4)),
    }


def projectors():
    def projector(*within, to_world=AIM):
        return lit(emitter("projector", to_world, *within))

    made = values.bitmap("irradiance", files.COLOURS)
    fov = number("fov", 45)
    plain = projector(made, fov)
    for angle in (20, 45, 80):
        yield Case("emitter", "projector", "fov", str(angle), projector(made, number("fov", angle)), projector(made, number("fov", 33)))
    yield Case("emitter", "projector", "fov", "not given", projector(made), plain)
    for axis in ("x", "y", "diagonal", "smaller", "larger"):
        wide = values.bitmap("irradiance", files.WIDE)
        yield Case("emitter", "projector", "fov_axis", axis, projector(wide, fov, string("fov_axis", axis)), projector(wide, number("fov", 31), string("fov_axis", axis)))
    yield Case("emitter", "projector", "focal_length", "35mm", projector(made, string("focal_length", "35mm")), plain)
    for factor in (0.5, 3):
        yield Case("emitter", "projector", "scale", str(factor), projector(made, fov, number("scale", factor)), plain)
    for form, written in [
        ("bilinear", values.bitmap("irradiance", files.COLOURS, filter_="bilinear")),
        ("raw", values.bitmap("irradiance", files.COLOURS, raw=True)),
        ("in single precision", values.bitmap("irradiance", files.FLOATS)),
        ("wide", values.bitmap("irradiance", files.WIDE)),
        ("to_uv", values.bitmap("irradiance", files.COLOURS, transform(rotate(0, 0, 1, 30), scale(1.7, 1.2, 1), name="to_uv"))),
        ("checkerboard", texture("checkerboard", name="irradiance")),
    ]:
        yield Case("emitter", "projector", "irradiance", form, projector(written, fov), projector(rgb("irradiance", 0.5), fov))
    for form, steps in turns().items():
        yield Case("emitter", "projector", "to_world", form, projector(made, fov, to_world=transform(*steps)), projector(rgb("irradiance", 0.5), fov))


def maps():
    """Environment maps, seen and as light."""

    def sky(*within):
        ground = shape("rectangle", transform(scale(1.2), rotate(1, 0, 0, -70), translate(0, -0.9, 0)), diffuse(0.6, 0.6, 0.6))
        ball_ = shape("sphere", number("radius", 0.6), bsdf("conductor"))
        return scene(path(3), camera("0.5, 0.6, 4", fov=45), ground, ball_, emitter("envmap", *within))

    plain = sky(string("filename", files.SKY))
    dim = lit(emitter("constant", rgb("radiance", 0.5)))
    for file in (files.SKY, files.SKY_RADIANCE, files.SKY_PNG, files.GREY_FLOATS):
        yield Case("emitter", "envmap", "filename", file, sky(string("filename", file)), sky(string("filename", files.FLOATS)))
    yield Case("emitter", "envmap", "filename", "picture of four rows", sky(string("filename", files.FLOATS)), plain)
    for factor in (0.5, 2):
        yield Case("emitter", "envmap", "scale", str(factor), sky(string("filename", files.SKY), number("scale", factor)), plain)
    yield Case("emitter", "envmap", "mis_compensation", "true", sky(string("filename", files.SKY), flag("mis_compensation", True)), None)
    for form, steps in {
        "about y by 40": (rotate(0, 1, 0, 40),),
        "about y by 180": (rotate(0, 1, 0, 180),),
        "about x by 90": (rotate(1, 0, 0, 90),),
        "about z by 30": (rotate(0, 0, 1, 30),),
        "general": (rotate(1, 0.4, -0.3, 70),),
        "upside down": (rotate(1, 0, 0, 180),),
        "mirrored in x": (scale(-1, 1, 1),),
        "mirrored in y": (scale(1, -1, 1),),
        "mirrored in z and turned": (scale(1, 1, -1), rotate(0, 1, 0, 50)),
        "mirrored in z, turned generally": (scale(1, 1, -1), rotate(1, 0.4, -0.3, 70)),
        "scaled": (scale(2),),
        "translated": (translate(3, 1, 2),),
        "lookat": (look_at("0, 0, 0", "1, 0.3, 0.2"),),
        "z up": (element("matrix", value="1 0 0 0  0 0 -1 0  0 1 0 0  0 0 0 1"),),
    }.items():
        yield Case("emitter", "envmap", "to_world", form, sky(string("filename", files.SKY), transform(*steps)), plain if form not in ("scaled", "translated") else None)
    yield Case("emitter", "constant", "radiance", "alone in the scene", scene(path(3), camera("0, 0, 4"), emitter("constant", rgb("radiance", 0.4, 0.5, 0.6))), dim)
    yield Case("emitter", "envmap", "filename", "alone in the scene", scene(path(3), camera("0, 0, 4", fov=70), emitter("envmap", string("filename", files.SKY))), dim)


def surfaces():
    """Shapes that give light, as seen and as light."""
    turned = transform(rotate(0, 1, 0, 180), translate(-0.6, 0.6, 3.5))
    side = transform(rotate(0, 1, 0, 140), scale(0.8), translate(1.2, 0.8, 2))
    for form, written in [
        ("bitmap", values.bitmap("radiance", files.COLOURS)),
        ("bitmap, raw", values.bitmap("radiance", files.COLOURS, raw=True)),
        ("bitmap, bilinear", values.bitmap("radiance", files.COLOURS, filter_="bilinear")),
        ("bitmap in single precision", values.bitmap("radiance", files.FLOATS)),
        ("grey bitmap", values.bitmap("radiance", files.GREYS)),
        ("checkerboard", texture("checkerboard", rgb("color0", 0.9, 0.5, 0.2), rgb("color1", 0.2, 0.4, 1), name="radiance")),
    ]:
        yield Case("emitter", "area", "radiance", f"{form}, as light", lit(shape("rectangle", turned, emitter("area", written))), lit(shape("rectangle", turned, emitter("area", rgb("radiance", 0.3)))))
        seen = lambda of: scene(path(2), camera("0, 0, 5", fov=26), shape("rectangle", of))
        yield Case("emitter", "area", "radiance", f"{form}, seen", seen(emitter("area", written)), seen(emitter("area", rgb("radiance", 0.3))))
    warm = emitter("area", rgb("radiance", 5, 4, 3))
    for name, surface in {"diffuse": diffuse(0.7, 0.3, 0.1), "plastic": bsdf("plastic"), "roughconductor": bsdf("roughconductor", number("alpha", 0.3)), "dielectric": bsdf("dielectric"), "null": bsdf("null"), "twosided": bsdf("twosided", diffuse(0.7, 0.3, 0.1)), "mask": bsdf("mask", number("opacity", 0.5), diffuse(0.7, 0.3, 0.1)), "no": ""}.items():
        yield Case("emitter", "area", "bsdf of the shape", f"{name}, front", lit(shape("rectangle", turned, surface, warm), depth=3), lit(shape("rectangle", turned, surface), emitter("constant", rgb("radiance", 0.1)), depth=3))
        yield Case("emitter", "area", "bsdf of the shape", f"{name}, seen from its back too", lit(shape("rectangle", side, surface, warm), emitter("constant", rgb("radiance", 0.3)), depth=3), lit(shape("rectangle", side, surface), emitter("constant", rgb("radiance", 0.3)), depth=3))
    for name in ("directionalarea",):
        yield Case("emitter", name, "radiance", "rgb of three", lit(shape("rectangle", turned, emitter(name, rgb("radiance", 5, 4, 3)))), lit(shape("rectangle", turned, warm)))
    for name in ("sunsky",):
        yield Case("emitter", name, "sun_direction", "given", lit(emitter(name, vector("sun_direction", 0.3, 0.6, 0.7), number("sun_scale", 0))), lit(emitter("constant", rgb("radiance", 0.1))))
    two = emitter("point", point("position", 1, 1.5, 3), rgb("intensity", 10, 5, 2)) + emitter("point", point("position", -1, -1, 3), rgb("intensity", 2, 5, 9))
    yield Case("emitter", "several", "number", "two points", lit(two), lit(emitter("point", point("position", 1, 1.5, 3), rgb("intensity", 10, 5, 2))))
    yield Case("emitter", "several", "number", "point, area and constant", lit(two, shape("rectangle", turned, warm), emitter("constant", rgb("radiance", 0.3, 0.2, 0.1))), lit(two))
