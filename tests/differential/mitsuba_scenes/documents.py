"""Cases of how a file is written: parameters, includes, references, steps of transforms, and older versions."""

from . import files, values
from .scene import LAMP, Case, bsdf, camera, card, diffuse, element, emitter, light_box, number, path, point, rgb, scale, scene, shape, shown, string, texture, transform, vector


def cases():
    yield from structure()
    yield from steps()
    yield from spellings()
    yield from old()


def structure():
    frame = lambda *parts: scene(path(2), camera("0, 0, 4.4", fov=29), light_box(), LAMP, *parts)
    paint = bsdf("diffuse", rgb("reflectance", 0.2, 0.5, 0.7), id="paint")
    plain = frame(shape("sphere"))
    ref = element("ref", id="paint")
    named = element("ref", name="bsdf", id="paint")
    cases_ = {
        "ref": (paint, shape("sphere", ref)),
        "ref with a name": (paint, shape("sphere", named)),
        "ref above what it names": (shape("sphere", ref), paint),
        "ref within a bsdf": (paint, shape("sphere", bsdf("twosided", ref))),
        "ref to a texture": (texture("bitmap", string("filename", files.COLOURS), id="paint"), shape("sphere", bsdf("diffuse", element("ref", name="reflectance", id="paint")))),
        "ref to a texture below": (shape("sphere", bsdf("diffuse", element("ref", name="reflectance", id="paint"))), texture("bitmap", string("filename", files.COLOURS), id="paint")),
        "alias": (paint, element("alias", id="paint", as_="other"), shape("sphere", element("ref", id="other"))),
        "include": (element("include", filename=files.INCLUDED), shape("sphere", ref)),
        "include below the reference": (shape("sphere", ref), element("include", filename=files.INCLUDED)),
        "path": (element("path", value="sub"), shape("sphere", bsdf("diffuse", values.bitmap("reflectance", "beside.png")))),
        "default": (element("default", name="blue", value="0.7"), shape("sphere", diffuse(0.2, 0.5, "$blue"))),
        "default within a word": (element("default", name="word", value="dif"), shape("sphere", element("bsdf", rgb("reflectance", 0.2, 0.5, 0.7), type="${word}fuse"))),
        "default in braces": (element("default", name="blue", value="0.7"), shape("sphere", diffuse(0.2, 0.5, "${blue}"))),
        "default of a longer name": (element("default", name="a", value="0.1"), element("default", name="ab", value="0.8"), shape("sphere", diffuse(0.2, 0.5, "$ab"))),
        "default given twice": (element("default", name="blue", value="0.7"), element("default", name="blue", value="0.1"), shape("sphere", diffuse(0.2, 0.5, "$blue"))),
        "default that names another": (element("default", name="a", value="0.7"), element("default", name="b", value="$a"), shape("sphere", diffuse(0.2, 0.5, "$b"))),
        "comments": ("<!-- <shape type='cube'/> -->", shape("sphere", "<!-- a -->", diffuse(0.2, 0.5, 0.7))),
        "an emitter that is named": (emitter("point", point("position", 0, 3, 3), rgb("intensity", 9), id="lamp"), shape("sphere", diffuse(0.2, 0.5, 0.7))),
        "a bsdf that nothing uses": (bsdf("conductor", id="unused"), shape("sphere", diffuse(0.2, 0.5, 0.7))),
        "a shape with an id": (shape("sphere", diffuse(0.2, 0.5, 0.7), id="ball"),),
        "a bsdf without a name in a named place": (shape("sphere", bsdf("diffuse", rgb("reflectance", 0.2, 0.5, 0.7), name="anything")),),
    }
    for form, parts in cases_.items():
        yield Case("document", "scene", "structure", form, frame(*parts), plain)
    whole = frame(shape("sphere", diffuse(0.2, 0.5, 0.7)))
    yield Case("document", "scene", "structure", "declaration", '<?xml version="1.0" encoding="utf-8"?>' + whole, plain)
    yield Case("document", "scene", "structure", "doctype", "<!DOCTYPE scene>" + whole, plain)
    yield Case("document", "scene", "structure", "declaration and doctype", '<?xml version="1.0"?>\n<!DOCTYPE scene>\n' + whole, plain)
    yield Case("document", "scene", "structure", "byte order mark", "\ufeff" + whole, plain)
    yield Case("document", "scene", "definitions", "given from outside", frame(element("default", name="blue", value="0.1"), shape("sphere", diffuse(0.2, 0.5, "$blue"))), plain, (("blue", "0.7"),))
    two = scene(path(2), camera("0, 0, 4.4", fov=29), camera("3, 0, 4.4", fov=29), light_box(), LAMP, shape("sphere", diffuse(0.2, 0.5, 0.7)))
    yield Case("document", "scene", "sensors", "two", two, scene(path(2), camera("3, 0, 4.4", fov=29), light_box(), LAMP, shape("sphere", diffuse(0.2, 0.5, 0.7))))


def steps():
    paint = bsdf("diffuse", values.bitmap("reflectance", files.COLOURS))
    rig = lambda *written: shown(shape("cube", element("transform", *written, name="to_world"), paint))
    plain = rig(scale(0.9))
    cases_ = {
        "translate in one value": (element("translate", value="0.3, 0.2, 0.5"),),
        "translate in x alone": (element("translate", x=0.4),),
        "translate in y and z": (element("translate", y=0.4, z=-0.3),),
        "scale in one number": (element("scale", value=0.6),),
        "scale in three": (element("scale", value="0.5, 0.8, 1.1"),),
        "scale in three apart by blanks": (element("scale", value="0.5 0.8 1.1"),),
        "scale in x alone": (element("scale", x=0.5),),
        "scale in y and z": (element("scale", y=0.5, z=1.2),),
        "rotate in one value": (element("rotate", value="0.6, 0.8, 0", angle=40),),
        "rotate about y alone": (element("rotate", y=1, angle=40),),
        "rotate about an axis that is not of length 1": (element("rotate", x=0.9, y=1.2, angle=40),),
        "rotate by a negative angle": (element("rotate", x=0.6, y=0.8, angle=-65),),
        "rotate by more than a turn": (element("rotate", y=1, angle=500),),
        "lookat": (scale(0.5), element("lookat", origin="0.3,0.2,0.1", target="1,0.5,2", up="0,1,0")),
        "lookat without up": (scale(0.5), element("lookat", origin="0.3,0.2,0.1", target="1,0.5,2")),
        "lookat apart by blanks": (scale(0.5), element("lookat", origin="0.3 0.2 0.1", target="1 0.5 2", up="0 1 0")),
        "matrix of sixteen": (element("matrix", value="0.5 0 0.1 0.3  0 0.7 0 0.1  0.2 0 0.6 0.2  0 0 0 1"),),
        "matrix apart by commas": (element("matrix", value="0.5,0,0.1,0.3,0,0.7,0,0.1,0.2,0,0.6,0.2,0,0,0,1"),),
        "matrix of nine": (element("matrix", value="0.5 0 0.1  0 0.7 0  0.2 0 0.6"),),
        "projective matrix": (element("matrix", value="0.5 0 0.1 0.3  0 0.7 0 0.1  0.2 0 0.6 0.2  0 0 0.1 1"),),
        "matrix with a last number of 2": (element("matrix", value="1 0 0.2 0.3  0 1.4 0 0.1  0.4 0 1.2 0.2  0 0 0 2"),),
        "order": (element("translate", x=0.5), element("rotate", y=1, angle=40), element("scale", value="0.5, 0.8, 1.1")),
    }
    for form, written in cases_.items():
        yield Case("document", "transform", "steps", form, rig(*written), plain)
    yield Case("document", "transform", "steps", "none", rig(element("translate", x=0)), plain)
    ball = lambda *written: shown(shape("sphere", *written, number("radius", 0.5), paint))
    plain = ball()
    for form, written in {
        "point of x, y and z": point("center", 0.3, 0.2, 0.4),
        "point in one value": element("point", name="center", value="0.3, 0.2, 0.4"),
        "point apart by blanks": element("point", name="center", value="0.3 0.2 0.4"),
        "point of x alone": element("point", name="center", x=0.4),
        "point of one number": element("point", name="center", value=0.4),
        "vector": vector("center", 0.3, 0.2, 0.4),
    }.items():
        yield Case("document", "point", "value", form, ball(written), plain)


def spellings():
    ball = lambda written: shown(shape("sphere", written, bsdf("diffuse")))
    plain = ball("")
    for form, written in {
        "exponent": element("float", name="radius", value="5e-1"),
        "capital exponent": element("float", name="radius", value="5E-1"),
        "no zero before the point": element("float", name="radius", value=".5"),
        "no digit after the point": element("float", name="radius", value="2."),
        "plus": element("float", name="radius", value="+0.5"),
        "blanks around": element("float", name="radius", value=" 0.5 "),
        "integer": element("integer", name="radius", value="2"),
        "suffix": element("float", name="radius", value="0.5f"),
        "long": element("long", name="radius", value="2"),
    }.items():
        yield Case("document", "float", "value", form, ball(written), plain)
    flip = lambda written: shown(shape("cube", written, bsdf("diffuse")))
    for form, value in {"true": "true", "TRUE": "TRUE", "True": "True", "1": "1", "blanks": " true "}.items():
        yield Case("document", "boolean", "value", form, flip(element("boolean", name="flip_normals", value=value)), flip(""))
    for form, value in {"apart by blanks": "0.2 0.5 0.7", "by commas alone": "0.2,0.5,0.7", "by both": "0.2 , 0.5 , 0.7", "hexadecimal in capitals": "#3380B3", "hexadecimal, short": "#38b", "blanks around": " 0.2, 0.5, 0.7 ", "two": "0.2, 0.5", "four": "0.2, 0.5, 0.7, 1"}.items():
        yield Case("document", "rgb", "value", form, card(bsdf("diffuse", element("rgb", name="reflectance", value=value))), card(bsdf("diffuse")))
    for form, tag, value in (("srgb", "srgb", "0.2, 0.5, 0.7"), ("color", "color", "0.2, 0.5, 0.7")):
        yield Case("document", form, "value", "of three", card(bsdf("diffuse", element(tag, name="reflectance", value=value))), card(bsdf("diffuse")))


def old():
    """Files that say a version before 2, which Mitsuba 3 brings up to date as it reads them."""
    words = lambda name, *within, type_: element(name, *within, type=type_)
    film_ = words("film", element("integer", name="width", value=16), element("integer", name="height", value=16), element("rfilter", type="box"), type_="hdrfilm")

    def old_scene(*parts, fov=element("float", name="fov", value=29), up="0, 1, 0", version="0.6.0"):
        view = words("sensor", fov, element("transform", element("lookat", origin="0, 0, 4.4", target="0, 0, 0", up=up), name="toWorld"), film_, element("sampler", element("integer", name="sampleCount", value=16), type="independent"), type_="perspective")
        light = words("emitter", element("point", name="position", x=1.5, y=2.5, z=4), element("rgb", name="intensity", value="14, 12, 10"), type_="point")
        sky = words("emitter", element("rgb", name="radiance", value="0.4, 0.5, 0.6"), type_="constant")
        return element("scene", words("integrator", element("integer", name="maxDepth", value=8), type_="path"), view, light, sky, *parts, version=version)

    plain = old_scene(shape("sphere"))
    glass = lambda *within: shape("sphere", words("bsdf", *within, type_="dielectric"))
    for version in ("0.4.0", "0.5.0", "0.6.0"):
        yield Case("old version", "scene", "version", version, old_scene(shape("sphere", diffuse(0.2, 0.5, 0.7)), version=version), plain)
    cases_ = {
        "toWorld": shape("cube", element("transform", element("scale", value=0.5), element("rotate", y=1, angle=30), name="toWorld"), diffuse(0.2, 0.5, 0.7)),
        "intIOR": glass(element("float", name="intIOR", value=1.8)),
        "extIOR": glass(element("float", name="extIOR", value=1.2)),
        "intIOR by name": glass(element("string", name="intIOR", value="diamond")),
        "diffuseReflectance": shape("sphere", words("bsdf", element("rgb", name="diffuseReflectance", value="0.2, 0.5, 0.7"), type_="plastic")),
        "specularReflectance": shape("sphere", words("bsdf", element("rgb", name="specularReflectance", value="0.2, 0.5, 0.7"), type_="conductor")),
        "alphaU and alphaV": shape("sphere", words("bsdf", element("float", name="alphaU", value=0.1), element("float", name="alphaV", value=0.4), type_="roughconductor")),
        "roughconductor": shape("sphere", words("bsdf", element("float", name="alpha", value=0.2), type_="roughconductor")),
        "flipNormals": shape("cube", element("boolean", name="flipNormals", value="true"), transform(scale(0.4)), diffuse(0.2, 0.5, 0.7)),
        "srgb": shape("sphere", bsdf("diffuse", element("srgb", name="reflectance", value="0.2, 0.5, 0.7"))),
        "srgb in hexadecimal": shape("sphere", bsdf("diffuse", element("srgb", name="reflectance", value="#3380b3"))),
        "spectrum of one value": shape("sphere", bsdf("diffuse", element("spectrum", name="reflectance", value=0.3))),
        "spectrum of pairs": shape("sphere", bsdf("diffuse", element("spectrum", name="reflectance", value="400:0.1, 500:0.3, 600:0.8, 700:0.7"))),
        "diffuse without a reflectance": shape("sphere", bsdf("diffuse")),
        "bitmap": shape("sphere", bsdf("diffuse", texture("bitmap", string("filename", files.COLOURS), element("string", name="filterType", value="nearest"), name="reflectance"))),
        "wrapMode": shape("sphere", bsdf("diffuse", texture("bitmap", string("filename", files.COLOURS), element("string", name="wrapMode", value="mirror"), element("float", name="uscale", value=3), name="reflectance"))),
        "uscale and vscale": shape("sphere", bsdf("diffuse", texture("bitmap", string("filename", files.COLOURS), element("string", name="filterType", value="nearest"), element("float", name="uscale", value=2), element("float", name="vscale", value=3), name="reflectance"))),
        "uvscale": shape("sphere", bsdf("diffuse", texture("checkerboard", element("float", name="uvscale", value=3), name="reflectance"))),
        "uoffset and voffset": shape("sphere", bsdf("diffuse", texture("checkerboard", element("float", name="uoffset", value=0.2), element("float", name="voffset", value=0.35), name="reflectance"))),
        "checkerboard": shape("sphere", bsdf("diffuse", texture("checkerboard", element("rgb", name="color0", value="0.8, 0.2, 0.1"), element("rgb", name="color1", value="0.1, 0.2, 0.7"), name="reflectance"))),
        "flipTexCoords": shape("obj", string("filename", files.OBJ), element("boolean", name="flipTexCoords", value="false"), bsdf("diffuse", values.bitmap("reflectance", files.COLOURS))),
        "faceNormals": shape("obj", string("filename", files.OBJ), element("boolean", name="faceNormals", value="true"), diffuse(0.2, 0.5, 0.7)),
        "shapeIndex": shape("serialized", string("filename", files.SERIALIZED), element("integer", name="shapeIndex", value=2), diffuse(0.2, 0.5, 0.7)),
        "cutoffAngle and beamWidth": shape("sphere", diffuse(0.2, 0.5, 0.7)) + words("emitter", element("float", name="cutoffAngle", value=20), element("float", name="beamWidth", value=8), element("rgb", name="intensity", value=30), element("transform", element("lookat", origin="-2, 1, 4", target="0, 0, 0"), name="toWorld"), type_="spot"),
    }
    for form, parts in cases_.items():
        other = old_scene(shape("sphere", diffuse(0.9, 0.1, 0.1))) if form == "diffuse without a reflectance" else plain
        yield Case("old version", "scene", "spelling", form, old_scene(parts), other)
    for axis in ("x", "y", "smaller"):
        yield Case("old version", "sensor", "fovAxis", axis, old_scene(shape("sphere", diffuse(0.2, 0.5, 0.7)), fov=element("float", name="fov", value=33) + element("string", name="fovAxis", value=axis)), old_scene(shape("sphere", diffuse(0.2, 0.5, 0.7))))
    yield Case("old version", "sensor", "focalLength", "35mm", old_scene(shape("sphere", diffuse(0.2, 0.5, 0.7)), fov=element("string", name="focalLength", value="35mm")), old_scene(shape("sphere", diffuse(0.2, 0.5, 0.7))))
    for name, within in {
        "phong": (number("exponent", 20),), "ward": (number("alpha_u", 0.2),), "coating": (diffuse(0.5, 0.3, 0.1),), "difftrans": (), "roughdiffuse": (number("alpha", 0.3),),
        "roughcoating": (diffuse(0.5, 0.3, 0.1),), "mixturebsdf": (string("weights", "0.4, 0.6"), diffuse(0.5, 0.3, 0.1), diffuse(0.1, 0.3, 0.5)), "mirror": (), "lambertian": (),
    }.items():
        yield Case("old version", f"bsdf {name}", "plugin", "as it is", old_scene(shape("sphere", bsdf(name, *within))), plain)
