"""Cases of shapes, their transforms and instances."""

from . import files, values
from .scene import Case, bsdf, diffuse, element, emitter, flag, integer, look_at, matrix, number, point, rgb, rotate, scale, shape, shown, string, transform, translate

MESHES = {"obj": (string("filename", files.OBJ),), "ply": (string("filename", files.PLY),), "serialized": (string("filename", files.SERIALIZED),)}
SHAPES = {"sphere": (), "rectangle": (), "cube": (), "disk": (), "cylinder": (), **MESHES}
PAINT = bsdf("diffuse", values.bitmap("reflectance", files.COLOURS))
LIGHT = emitter("area", rgb("radiance", 4, 3, 2))
GLASS = bsdf("dielectric", number("int_ior", 1.5))


def transforms():
    """In the order in which they are applied."""
    turn = rotate(0.3, 1, 0.2, 35)
    return {
        "translation": (translate(0.4, -0.3, 0.5),),
        "uniform scale": (scale(0.6),),
        "uneven scale": (scale(1.2, 0.6, 0.8),),
        "turn": (turn,),
        "turn about x": (rotate(1, 0, 0, 50),),
        "scale, then turn": (scale(1.2, 0.6, 0.8), turn),
        "turn, then scale": (turn, scale(1.2, 0.6, 0.8)),
        "mirrored in x": (scale(-1, 1, 1), turn),
        "mirrored in y": (scale(1, -1, 1), turn),
        "mirrored in z": (scale(1, 1, -1), turn),
        "mirrored thrice": (scale(-0.8), turn),
        "mirrored and uneven": (scale(-1.2, 0.6, 0.8), turn),
        "shear": (matrix(1, 0.4, 0, 0.1, 0, 1, 0.2, 0, 0, 0, 0.9, 0.2, 0, 0, 0, 1),),
        "matrix of nine": (matrix(0, -1, 0, 1, 0, 0, 0, 0, 1), turn),
        "lookat": (look_at("0.2, 0.1, 0", "1, 0.7, 1.5"),),
    }


def cases():
    turn = rotate(0.3, 1, 0.2, 35)
    for name, more in SHAPES.items():
        rig = lambda steps, surface=PAINT, depth=2, *others: shown(shape(name, *more, transform(*steps), *others, surface), depth)
        plain = rig((turn,), bsdf("diffuse"))
        for form, steps in transforms().items():
            yield Case("shape", name, "to_world", form, rig(steps), plain)
        for form in ("turn", "mirrored in x", "mirrored thrice"):
            steps = transforms()[form]
            yield Case("shape", name, "to_world, giving light", form, rig(steps, LIGHT), plain)
            yield Case("shape", name, "to_world, of glass", form, rig(steps, GLASS, 8), plain)
            yield Case("shape", name, "to_world, plain", form, rig(steps, diffuse(0.3, 0.5, 0.2)), plain)
        for value in (True, False):
            for form, surface, depth in (("diffuse", PAINT, 2), ("light", LIGHT, 2), ("glass", GLASS, 8), ("plain", diffuse(0.3, 0.5, 0.2), 2)):
                if not value and form != "diffuse":
                    continue
                for turned in ("turn", "mirrored in x") if value else ("turn",):
                    steps = transforms()[turned]
                    other = rig(steps, surface, depth, flag("flip_normals", not value))
                    yield Case("shape", name, "flip_normals", f"{str(value).lower()}, {form}, {turned}", rig(steps, surface, depth, flag("flip_normals", value)), None if form == "glass" and name in ("rectangle", "disk") else other)
        yield Case("shape", name, "flip_normals", "true, uneven scale", rig(transforms()["scale, then turn"], PAINT, 2, flag("flip_normals", True)), rig(transforms()["scale, then turn"]))
        yield Case("shape", name, "silhouette_sampling_weight", "2", rig((turn,), PAINT, 2, number("silhouette_sampling_weight", 2)), None)
    yield from parameters()
    yield from bent()
    yield from meshes()
    yield from instances()


def parameters():
    plain = shown(shape("sphere", PAINT))
    for form, more in {
        "radius": (number("radius", 0.6),),
        "center": (point("center", 0.4, 0.3, 0.2),),
        "center and radius": (point("center", 0.4, 0.3, 0.2), number("radius", 0.6)),
        "center, radius and an uneven scale": (point("center", 0.4, 0.3, 0.2), number("radius", 0.6), transform(scale(1.5, 0.8, 1), rotate(0, 1, 0, 30))),
        "center and a mirror": (point("center", 0.4, 0.3, 0.2), transform(scale(-1, 1, 1))),
        "center, giving light": (point("center", 0.4, 0.3, 0.2), number("radius", 0.5), LIGHT),
    }.items():
        yield Case("shape", "sphere", "center, radius", form, shown(shape("sphere", *more, PAINT)), plain)
    plain = shown(shape("cylinder", PAINT))
    for form, more in {
        "radius": (number("radius", 0.5),),
        "p0 and p1": (point("p0", -0.6, -0.4, 0.1), point("p1", 0.7, 0.8, 0.3)),
        "p0 alone": (point("p0", -0.6, -0.4, 0.1),),
        "p1 alone": (point("p1", 0.7, 0.8, 0.3),),
        "p0, p1, radius and a turn": (point("p0", -0.6, -0.4, 0.1), point("p1", 0.7, 0.8, 0.3), number("radius", 0.5), transform(rotate(0, 1, 0.2, 130))),
        "p0, p1, radius and an uneven scale": (point("p0", -0.6, -0.4, 0.1), point("p1", 0.7, 0.8, 0.3), number("radius", 0.5), transform(scale(1.2, 0.6, 0.8))),
        "p0, p1 and a mirror": (point("p0", -0.6, -0.4, 0.1), point("p1", 0.7, 0.8, 0.3), number("radius", 0.5), transform(scale(-1, 1, 1))),
        "downward": (point("p0", 0, 0, 0.5), point("p1", 0, 0, -0.5)),
    }.items():
        yield Case("shape", "cylinder", "p0, p1, radius", form, shown(shape("cylinder", *more, PAINT)), plain)


def bent():
    """Maps of normals follow a shape's coordinates."""
    normals = values.bitmap("normalmap", files.NORMALS, raw=True, filter_="bilinear")
    heights = values.bitmap(None, files.HEIGHTS, raw=True, filter_="bilinear")
    turn = rotate(0.3, 1, 0.2, 35)
    for name, more in SHAPES.items():
        for form, steps in {"turn": (turn,), "mirrored in x": (scale(-1, 1, 1), turn), "uneven scale": (scale(1.2, 0.6, 0.8), turn)}.items():
            grey = diffuse(0.5, 0.5, 0.5)
            rig = lambda surface: shown(shape(name, *more, transform(*steps), surface))
            yield Case("shape", name, "normal map", form, rig(bsdf("normalmap", normals, grey)), rig(grey))
            yield Case("shape", name, "bump map", form, rig(bsdf("bumpmap", heights, number("scale", 0.4), grey)), rig(grey))
        brushed = lambda u, v: shown(shape(name, *more, transform(turn), bsdf("roughconductor", string("material", "Au"), number("alpha_u", u), number("alpha_v", v))))
        yield Case("shape", name, "directions of roughness", "turn", brushed(0.05, 0.4), brushed(0.4, 0.05))


def meshes():
    turn = transform(rotate(0.3, 1, 0.2, 35))
    for name, (filename,) in MESHES.items():
        rig = lambda *more, surface=PAINT: shown(shape(name, filename, turn, *more, surface))
        metal = bsdf("roughconductor", string("material", "none"), number("alpha", 0.2))
        yield Case("shape", name, "face_normals", "true", rig(flag("face_normals", True), surface=metal), rig(surface=metal))
        yield Case("shape", name, "face_normals", "false", rig(flag("face_normals", False), surface=metal), rig(flag("face_normals", True), surface=metal))
        if name != "serialized":
            for value in (True, False):
                yield Case("shape", name, "flip_tex_coords", str(value).lower(), rig(flag("flip_tex_coords", value)), rig(flag("flip_tex_coords", not value)))
    plain = shown(shape("obj", string("filename", files.OBJ), turn, diffuse(0.5, 0.5, 0.5)))
    for file, form in ((files.OBJ_BARE, "without normals and coordinates"), (files.OBJ_SMOOTH, "without normals")):
        for more in ((), (flag("face_normals", True),)):
            for surface, what in ((diffuse(0.5, 0.5, 0.5), "plain"), (PAINT, "textured")):
                yield Case("shape", "obj", "filename", f"{form}, {what}{', face_normals' if more else ''}", shown(shape("obj", string("filename", file), turn, *more, surface)), plain)
    yield Case("shape", "ply", "filename", "binary", shown(shape("ply", string("filename", files.PLY_BINARY), turn, PAINT)), plain)
    for index in (1, 2):
        yield Case("shape", "serialized", "shape_index", str(index), shown(shape("serialized", string("filename", files.SERIALIZED), integer("shape_index", index), turn, PAINT)), plain)
    yield Case("shape", "serialized", "shape_index", "2, plain", shown(shape("serialized", string("filename", files.SERIALIZED), integer("shape_index", 2), turn, diffuse(0.5, 0.5, 0.5))), plain)


def instances():
    group = shape("shapegroup", shape("obj", string("filename", files.OBJ), transform(scale(0.6)), PAINT), id="group")
    mixed = shape("shapegroup", shape("cube", transform(scale(0.4), translate(0.3, 0, 0)), PAINT), shape("sphere", number("radius", 0.4), point("center", -0.5, 0, 0), diffuse(0.2, 0.6, 0.3)), id="group")
    ref = element("ref", id="group")
    for form, steps in transforms().items():
        for what, held in (("mesh", group), ("cube and sphere", mixed)) if form in ("uneven scale", "turn", "mirrored in x", "shear") else (("mesh", group),):
            made = lambda chosen: shown(held + "".join(shape("instance", ref, transform(*one)) for one in chosen))
            yield Case("shape", "instance", "to_world", f"{what}, {form}", made([steps, (scale(0.5), translate(-1.2, 0.8, 0.5))]), made([(translate(0, 0, 0.8),)]))
    many = [(scale(0.3), rotate(0, 1, 0, 25 * index), translate(-1.2 + 0.3 * index, 0.5 - 0.15 * index, 0.1 * index)) for index in range(9)]
    yield Case("shape", "instance", "number", "nine", shown(group + "".join(shape("instance", ref, transform(*steps)) for steps in many)), shown(group + shape("instance", ref)))
    yield Case("shape", "shapegroup", "shape", "not instanced", shown(group), shown(group + shape("instance", ref)))
    glass = shape("shapegroup", shape("sphere", GLASS), id="group")
    for form in ("uniform scale", "mirrored in x"):
        yield Case("shape", "instance", "to_world, of glass", form, shown(glass + shape("instance", ref, transform(*transforms()[form])), 8), shown(group + shape("instance", ref)))
    yield Case("shape", "merge", "shape", "two meshes", shown(shape("merge", shape("obj", string("filename", files.OBJ), transform(scale(0.6)), PAINT), shape("obj", string("filename", files.OBJ), transform(scale(0.4), translate(1, 0.4, 0.3)), PAINT))), shown(shape("obj", string("filename", files.OBJ), PAINT)))
