"""Cases of textures."""

from . import files, values
from .scene import Case, LAMP, bsdf, camera, card, diffuse, element, flag, light_box, number, path, rgb, rotate, scale, scene, shape, string, texture, transform, translate


def cases():
    painted = lambda made: card(bsdf("diffuse", made))
    grey = painted(rgb("reflectance", 0.33))
    named = lambda file, *more, **words: values.bitmap("reflectance", file, *more, **words)
    for file in (files.COLOURS, files.COLOURS_16, files.GREYS, files.GREYS_16, files.VEILED, files.JPEG, files.BMP, files.TGA, files.PPM, files.FLOATS, files.HALVES, files.GREY_FLOATS, files.RADIANCE, files.PFM, files.WIDE):
        for raw in (None, True, False) if file in (files.COLOURS, files.FLOATS) else (None, True):
            form = file + {None: "", True: ", raw", False: ", raw false"}[raw]
            yield Case("texture", "bitmap", "filename, raw", form, painted(named(file, raw=raw)), grey)
    plain = painted(named(files.COLOURS))
    yield Case("texture", "bitmap", "filter_type", "not given", painted(texture("bitmap", string("filename", files.COLOURS), name="reflectance")), plain)
    yield Case("texture", "bitmap", "filter_type", "bilinear", painted(named(files.COLOURS, filter_="bilinear")), plain)
    yield Case("texture", "bitmap", "filter_type", "nearest", plain, painted(named(files.COLOURS, filter_="bilinear")))
    spread = transform(scale(2.3, 1.6, 1), translate(-0.4, 0.3, 0), name="to_uv")
    for wrap in ("repeat", "mirror", "clamp"):
        for filter_ in ("nearest", "bilinear"):
            other = painted(named(files.COLOURS, string("wrap_mode", "mirror" if wrap != "mirror" else "clamp"), spread, filter_=filter_))
            yield Case("texture", "bitmap", "wrap_mode", f"{wrap}, {filter_}", painted(named(files.COLOURS, string("wrap_mode", wrap), spread, filter_=filter_)), other)
    yield Case("texture", "bitmap", "wrap_mode", "not given", painted(named(files.COLOURS, spread)), painted(named(files.COLOURS, spread, string("wrap_mode", "clamp"))))
    for value in ("variant", "fp16", "auto"):
        yield Case("texture", "bitmap", "format", value, painted(named(files.COLOURS, string("format", value))), None)
    yield Case("texture", "bitmap", "accel", "false", painted(named(files.COLOURS, flag("accel", False))), None)
    maps = {
        "scale of two": (scale(2),),
        "uneven scale": (scale(3, 0.7, 1),),
        "scale of u and v alone": (element("scale", x=2, y=3),),
        "translation": (translate(0.2, 0.35, 0),),
        "turn by 90 degrees": (rotate(0, 0, 1, 90),),
        "turn by 30 degrees": (rotate(0, 0, 1, 30),),
        "turn about x by 180 degrees": (rotate(1, 0, 0, 180),),
        "mirrored u": (scale(-1, 1, 1),),
        "mirrored v": (scale(1, -1, 1),),
        "scale, then turn": (scale(2, 0.8, 1), rotate(0, 0, 1, 25)),
        "turn, then scale": (rotate(0, 0, 1, 25), scale(2, 0.8, 1)),
        "turn, scale and translation": (rotate(0, 0, 1, 40), scale(1.5), translate(0.1, 0.7, 0)),
        "shear": (element("matrix", value="1 0.5 0 0.1  0 1 0 0  0 0 1 0  0 0 0 1"),),
        "matrix": (element("matrix", value="0.8 -0.6 0 0.3  0.6 0.8 0 0.1  0 0 1 0  0 0 0 1"),),
        "matrix of nine": (element("matrix", value="0.8 -0.6 0  0.6 0.8 0  0 0 1"),),
    }
    for form, steps in maps.items():
        to_uv = transform(*steps, name="to_uv")
        yield Case("texture", "bitmap", "to_uv", form, painted(named(files.COLOURS, to_uv)), plain)
        checks = lambda *more: painted(texture("checkerboard", rgb("color0", 0.7, 0.2, 0.1), rgb("color1", 0.1, 0.3, 0.6), *more, name="reflectance"))
        yield Case("texture", "checkerboard", "to_uv", form, checks(transform(*steps, translate(0.13, 0.07, 0), name="to_uv")), checks())
    yield Case("texture", "checkerboard", "color0, color1", "not given", painted(texture("checkerboard", name="reflectance")), grey)
    yield Case("texture", "checkerboard", "color0, color1", "color0 alone", painted(texture("checkerboard", rgb("color0", 0.8, 0.3, 0.1), name="reflectance")), grey)
    yield Case("texture", "checkerboard", "color0, color1", "color1 alone", painted(texture("checkerboard", rgb("color1", 0.8, 0.3, 0.1), name="reflectance")), grey)
    yield Case("texture", "checkerboard", "color0, color1", "floats", painted(texture("checkerboard", number("color0", 0.8), number("color1", 0.1), name="reflectance")), grey)
    for slot in ("color0", "color1"):
        yield Case("texture", "checkerboard", "color0, color1", f"{slot} a bitmap", painted(texture("checkerboard", values.bitmap(slot, files.COLOURS), name="reflectance")), grey)
    yield Case("texture", "checkerboard", "color0, color1", "color0 a checkerboard", painted(texture("checkerboard", texture("checkerboard", transform(scale(4), name="to_uv"), name="color0"), name="reflectance")), grey)
    yield from attributes()
    yield from corners()


def attributes():
    def painted(made, *more):
        seen = shape("ply", string("filename", files.PLY_ATTRIBUTES), *more, bsdf("diffuse", made))
        return scene(path(2), camera("2.6, 2, 4.2", fov=30), seen, light_box(), LAMP)

    grey = painted(rgb("reflectance", 0.33))
    for name in ("vertex_color", "face_color"):
        yield Case("texture", "mesh_attribute", "name", name, painted(texture("mesh_attribute", string("name", name), name="reflectance")), grey)
        yield Case("texture", "mesh_attribute", "scale", name, painted(texture("mesh_attribute", string("name", name), number("scale", 0.5), name="reflectance")), grey)
    yield Case("texture", "mesh_attribute", "name", "one that is not there", painted(texture("mesh_attribute", string("name", "vertex_nothing"), name="reflectance")), None)


def corners():
    """How textures lie on each shape's own coordinates."""
    for name, more in [("rectangle", ()), ("disk", ()), ("sphere", ()), ("cube", ()), ("cylinder", ()), ("obj", (string("filename", files.OBJ),)), ("ply", (string("filename", files.PLY),)), ("serialized", (string("filename", files.SERIALIZED),))]:
        for angle, axis in ((0, (0, 1, 0)), (120, (0, 1, 0)), (240, (0, 1, 0)), (90, (1, 0, 0)), (-90, (1, 0, 0))):
            surface = bsdf("twosided", bsdf("diffuse", values.bitmap("reflectance", files.COLOURS)))
            seen = lambda of: scene(path(2), camera("1.2, 1.5, 4.5", fov=34), shape(name, *more, transform(rotate(*axis, angle)), of), light_box(), LAMP)
            yield Case("shape", name, "texture coordinates", f"turned by {angle} degrees about {'xyz'[axis.index(1)]}", seen(surface), seen(bsdf("twosided", diffuse(0.33))))
