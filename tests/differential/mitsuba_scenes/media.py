"""Cases of media, their phase functions and their boundaries."""

from . import files
from .scene import LAMP, Case, bsdf, camera, diffuse, element, emitter, integer, lamp, light_box, number, plugin, point, rgb, rotate, scale, scene, sensor, shape, spectrum, string, transform, translate

NULL = bsdf("null")
DEPTH = 6


def medium(*within, name="interior", type_="homogeneous", id=None):
    return plugin("medium", type_, *within, name=name, id=id)


def phase(type_, *within):
    return plugin("phase", type_, *within)


def volume(name, type_, *within):
    return plugin("volume", type_, *within, name=name)


def constant(name, *value):
    return volume(name, "constvolume", rgb("value", *value))


def ref(id, name=None):
    return element("ref", id=id, name=name)


def tracer(depth=DEPTH, type_="volpathmis", *more):
    """Without roulette, which takes light away there, unless one is given."""
    roulette = "" if any("rr_depth" in one for one in more) else integer("rr_depth", 1000)
    return plugin("integrator", type_, integer("max_depth", depth), roulette, *more)


def filled(*of_shape, integrator=None, radius=1.2, more=""):
    """A ball that holds a medium, in the box of light, with a point light."""
    ball = shape("sphere", number("radius", radius), *of_shape)
    return scene(integrator or tracer(), camera("0, 0, 4.4", fov=29), more, ball, light_box(), LAMP)


def fog(*of_medium, type_="homogeneous", things="", depth=DEPTH, light=None):
    """A medium around the sensor, with a wall that a lamp shines on: paths that are scattered near a point are rare and bright."""
    wall = shape("rectangle", transform(scale(3), translate(0, 0, -1.5)), bsdf("twosided", diffuse(0.6, 0.5, 0.4)))
    eye = sensor(number("fov", 40), transform(element("lookat", origin="0, 0, 4", target="0, 0, 0", up="0, 1, 0")), medium(*of_medium, name=None, type_=type_, id="fog"))
    panel = shape("rectangle", transform(element("lookat", origin="2.5, 2.2, 2.5", target="0, 0, 0", up="0, 1, 0")), lamp((9, 8, 6)))
    return scene(tracer(depth), eye, wall, things, light or panel)


def cases():
    yield from densities()
    yield from grids()
    yield from phases()
    yield from boundaries()
    yield from integrators()


def densities():
    base = filled(NULL, medium())
    thin = number("sigma_t", 0.8)
    yield Case("medium", "homogeneous", "sigma_t", "not given", base, filled(NULL, medium(thin)))
    for form, written in [
        ("float", number("sigma_t", 0.4)),
        ("float, dense", number("sigma_t", 5)),
        ("rgb of three", rgb("sigma_t", 0.9, 0.5, 0.2)),
        ("spectrum of one value", element("spectrum", name="sigma_t", value="0.4")),
        ("volume of a float", volume("sigma_t", "constvolume", number("value", 2))),
        ("volume of a colour", constant("sigma_t", 3, 1.5, 0.6)),
        ("volume of no value", volume("sigma_t", "constvolume")),
        ("uniform", spectrum("uniform", number("value", 2.0), name="sigma_t")),
        ("0", number("sigma_t", 0)),
    ]:
        other = filled(NULL, medium(thin))
        yield Case("medium", "homogeneous", "sigma_t", form, filled(NULL, medium(written)), other)
    for form, written in [
        ("float", number("albedo", 0.4)),
        ("0", number("albedo", 0)),
        ("1", number("albedo", 1)),
        ("rgb of three", rgb("albedo", 0.9, 0.5, 0.2)),
        ("volume of a colour", constant("albedo", 0.9, 0.5, 0.2)),
    ]:
        yield Case("medium", "homogeneous", "albedo", form, filled(NULL, medium(written)), base)
    for factor in (0.3, 3):
        yield Case("medium", "homogeneous", "scale", str(factor), filled(NULL, medium(number("scale", factor), rgb("sigma_t", 0.9, 0.5, 0.2))), filled(NULL, medium(rgb("sigma_t", 0.9, 0.5, 0.2))))
    yield Case("medium", "homogeneous", "to_world of the shape", "scaled", filled(NULL, transform(scale(0.8)), medium(rgb("sigma_t", 0.9, 0.5, 0.2))), base)
    yield Case("medium", "homogeneous", "has_spectral_extinction", "false", filled(NULL, medium(element("boolean", name="has_spectral_extinction", value="false"))), None)
    yield Case("medium", "homogeneous", "sample_emitters", "false, walls of light", scene(tracer(), camera("0, 0, 4.4", fov=29), shape("sphere", NULL, medium(element("boolean", name="sample_emitters", value="false"))), light_box()), None)


# The unit cube as a box about the origin.
BOX = transform(translate(-0.5, -0.5, -0.5), scale(2.2, 2, 1.8))


def grid(name, file=files.CLOUD, *more, place=BOX):
    return volume(name, "gridvolume", string("filename", file), place, *more)


def cloud(*of_medium, type_="heterogeneous", depth=DEPTH):
    """A wide box that holds a medium with a grid, in the box of light, with a point light."""
    hull = shape("cube", transform(scale(1.6)), NULL, medium(*of_medium, type_=type_))
    return scene(tracer(depth), camera("2.4, 1.6, 3.8", fov=32), hull, light_box(), LAMP)


def grids():
    plain = cloud(grid("sigma_t"))
    for type_ in ("heterogeneous",):
        yield Case("medium", type_, "sigma_t", "grid", plain, cloud(grid("sigma_t"), number("scale", 1.3)))
        yield Case("medium", type_, "sigma_t", "not given", cloud(), cloud(number("sigma_t", 2)))
        yield Case("medium", type_, "sigma_t", "float", cloud(number("sigma_t", 3)), cloud())
        yield Case("medium", type_, "sigma_t", "volume of a float, placed", cloud(volume("sigma_t", "constvolume", number("value", 2), BOX)), cloud(number("sigma_t", 2)))
        yield Case("medium", type_, "sigma_t", "grid of one colour", cloud(grid("sigma_t", files.CLOUD_TINTED)), plain)
        yield Case("medium", type_, "sigma_t", "grid in colours", cloud(grid("sigma_t", files.TINTS), number("scale", 4)), plain)
        for factor in (0.4, 2.5):
            yield Case("medium", type_, "scale", f"{factor}, of a grid", cloud(grid("sigma_t"), number("scale", factor)), plain)
        yield Case("medium", type_, "scale", "2, of a float", cloud(number("sigma_t", 1.5), number("scale", 2)), cloud(number("sigma_t", 1.5)))
        yield Case("medium", type_, "albedo", "float", cloud(grid("sigma_t"), number("albedo", 0.3)), plain)
        yield Case("medium", type_, "albedo", "rgb of three", cloud(grid("sigma_t"), rgb("albedo", 0.9, 0.6, 0.2)), plain)
        yield Case("medium", type_, "albedo", "grid", cloud(grid("sigma_t"), grid("albedo", files.TINTS)), plain)
        yield Case("medium", type_, "albedo", "grid over a float", cloud(number("sigma_t", 3), grid("albedo", files.TINTS)), cloud(number("sigma_t", 3)))
        small = transform(scale(0.8))
        yield Case("medium", type_, "albedo", "smaller grid", cloud(grid("sigma_t"), grid("albedo", files.TINTS, place=small)), plain)
        yield Case("medium", type_, "phase", "hg", cloud(grid("sigma_t"), phase("hg", number("g", 0.6))), plain)
    yield Case("medium", "homogeneous", "albedo", "grid", cloud(number("sigma_t", 1.2), grid("albedo", files.TINTS), type_="homogeneous"), cloud(number("sigma_t", 1.2), type_="homogeneous"))
    near = string("filter_type", "nearest")
    yield Case("volume", "gridvolume", "filter_type", "nearest", cloud(grid("sigma_t", files.CLOUD, near)), plain)
    yield Case("volume", "gridvolume", "filter_type", "trilinear", cloud(grid("sigma_t", files.CLOUD, string("filter_type", "trilinear"))), cloud(grid("sigma_t", files.CLOUD, near)))
    yield Case("volume", "gridvolume", "filter_type", "nearest, of an albedo", cloud(grid("sigma_t"), grid("albedo", files.TINTS, near)), plain)
    for mode in ("clamp", "mirror", "repeat"):
        yield Case("volume", "gridvolume", "wrap_mode", mode, cloud(grid("sigma_t", files.CLOUD, string("wrap_mode", mode))), None)
    boxed = lambda flag: cloud(volume("sigma_t", "gridvolume", string("filename", files.CLOUD_BOXED), element("boolean", name="use_grid_bbox", value=flag)))
    yield Case("volume", "gridvolume", "use_grid_bbox", "true", boxed("true"), boxed("false"))
    yield Case("volume", "gridvolume", "use_grid_bbox", "false", boxed("false"), boxed("true"))
    placed = volume("sigma_t", "gridvolume", string("filename", files.CLOUD_BOXED), element("boolean", name="use_grid_bbox", value="true"), transform(scale(0.7), translate(0.2, 0, 0.1)))
    yield Case("volume", "gridvolume", "use_grid_bbox", "true, placed", cloud(placed), boxed("true"))
    for word in ("raw", "accel"):
        yield Case("volume", "gridvolume", word, "true", cloud(grid("sigma_t", files.CLOUD, element("boolean", name=word, value="true"))), None)
    yield Case("volume", "gridvolume", "max_value", "above the largest", cloud(grid("sigma_t", files.CLOUD, number("max_value", 5))), None)
    moved = lambda *steps: cloud(grid("sigma_t", place=transform(translate(-0.5, -0.5, -0.5), *steps)))
    yield Case("volume", "gridvolume", "to_world", "scaled unevenly", moved(scale(2.4, 1.2, 1.8)), moved(scale(2)))
    yield Case("volume", "gridvolume", "to_world", "turned by 90", moved(scale(2.4, 1.2, 1.8), rotate(0, 0, 1, 90)), moved(scale(2.4, 1.2, 1.8)))
    yield Case("volume", "gridvolume", "to_world", "mirrored", moved(scale(-2.2, 2, 1.8)), moved(scale(2.2, 2, 1.8)))
    yield Case("volume", "gridvolume", "to_world", "turned by 30", moved(scale(2), rotate(0, 1, 0, 30)), moved(scale(2)))


def phases():
    of = lambda *written: filled(NULL, medium(number("sigma_t", 1.5), *written))
    plain = of()
    yield Case("phase", "isotropic", "(none)", "given", of(phase("isotropic")), of(phase("hg")))
    yield Case("phase", "rayleigh", "(none)", "given", of(phase("rayleigh")), of(phase("hg")))
    yield Case("phase", "hg", "g", "not given", of(phase("hg")), plain)
    for cosine in (0.5, -0.6, 0.95):
        yield Case("phase", "hg", "g", str(cosine), of(phase("hg", number("g", cosine))), plain)
    ahead, back = phase("hg", number("g", 0.7)), phase("hg", number("g", -0.7))
    for share in (0.2, 0.8):
        yield Case("phase", "blendphase", "weight", str(share), of(phase("blendphase", number("weight", share), ahead, back)), of(phase("blendphase", number("weight", 0.5), ahead, back)))
    yield Case("phase", "blendphase", "phase", "a blend within", of(phase("blendphase", number("weight", 0.3), phase("rayleigh"), phase("blendphase", number("weight", 0.4), ahead, back))), plain)
    yield Case("phase", "tabphase", "values", "all the same", of(phase("tabphase", string("values", "1, 1, 1"))), of(ahead))
    yield Case("phase", "tabphase", "values", "ahead", of(phase("tabphase", string("values", "0.1, 0.2, 3"))), plain)


def boundaries():
    milk = medium(rgb("sigma_t", 0.9, 0.7, 0.5), number("scale", 3), phase("hg", number("g", 0.4)))
    surfaces = {
        "null": NULL,
        "dielectric": bsdf("dielectric", number("int_ior", 1.4)),
        "roughdielectric": bsdf("roughdielectric", number("int_ior", 1.4), number("alpha", 0.3)),
        "thindielectric": bsdf("thindielectric"),
        "diffuse": diffuse(0.6, 0.3, 0.2),
        "none": "",
        "mask of diffuse": bsdf("mask", number("opacity", 0.4), diffuse(0.6, 0.3, 0.2)),
        "twosided diffuse": bsdf("twosided", diffuse(0.6, 0.3, 0.2)),
        "blend of null and diffuse": bsdf("blendbsdf", number("weight", 0.4), NULL, diffuse(0.6, 0.3, 0.2)),
    }
    for form, surface in surfaces.items():
        hidden = form in ("diffuse", "none", "twosided diffuse")
        yield Case("medium", "homogeneous", "interior", form, filled(surface, milk), None if hidden else filled(surface))
    yield Case("medium", "homogeneous", "interior", "cube", scene(tracer(), camera("2, 1.5, 4"), shape("cube", NULL, milk), light_box(), LAMP), scene(tracer(), camera("2, 1.5, 4"), shape("cube", NULL), light_box(), LAMP))
    group = shape("shapegroup", shape("cube", NULL, milk), id="g")
    placed = plugin("shape", "instance", ref("g"), transform(scale(0.8), translate(0.2, 0, 0)))
    of_group = lambda group_: scene(tracer(), camera("2, 1.5, 4"), group_, placed, light_box(), LAMP)
    yield Case("medium", "homogeneous", "interior", "in an instance", of_group(group), of_group(shape("shapegroup", shape("cube", NULL), id="g")))
    named = plugin("medium", "homogeneous", rgb("sigma_t", 0.9, 0.7, 0.5), id="milk")
    yield Case("medium", "homogeneous", "interior", "by ref", filled(NULL, ref("milk", "interior"), more=named), filled(NULL, more=named))
    outside = plugin("medium", "homogeneous", number("sigma_t", 0.3), id="air")
    inner = shape("sphere", number("radius", 0.7), bsdf("dielectric", number("int_ior", 1.3)), milk, ref("air", "exterior"))
    yield Case("medium", "homogeneous", "exterior", "the medium around", filled(NULL, ref("air", "interior"), more=outside + inner), filled(NULL, more=outside + inner))
    hole = shape("sphere", number("radius", 0.8), NULL, ref("air", "exterior"))
    dense = plugin("medium", "homogeneous", number("sigma_t", 2), id="air")
    yield Case("medium", "homogeneous", "exterior", "alone, a hole", filled(NULL, ref("air", "interior"), more=dense + hole), filled(NULL, ref("air", "interior"), more=dense))
    glass = shape("sphere", number("radius", 0.8), bsdf("dielectric", number("int_ior", 1.3)))
    yield Case("medium", "homogeneous", "interior", "of what is around a body of glass", filled(NULL, ref("air", "interior"), more=dense + glass), filled(NULL, ref("air", "interior"), more=dense))
    ahead = phase("hg", number("g", 0.6))
    yield Case("sensor", "perspective", "medium", "fog", fog(number("sigma_t", 0.3), ahead), fog(number("sigma_t", 0.2)))
    bulb = emitter("point", point("position", 2.5, 2.2, 2.5), rgb("intensity", 24, 20, 16))
    yield Case("sensor", "perspective", "medium", "fog, a point light, scattered once", fog(number("sigma_t", 0.3), ahead, depth=2, light=bulb), fog(number("sigma_t", 0.3), depth=2, light=bulb))
    yield Case("sensor", "perspective", "medium", "a cloud", fog(grid("sigma_t", files.CLOUD, place=transform(translate(-0.5, -0.5, -0.5), scale(3))), type_="heterogeneous"), fog(number("sigma_t", 0.2)))
    yield Case("sensor", "perspective", "medium", "coloured fog", fog(rgb("sigma_t", 0.1, 0.3, 0.6), rgb("albedo", 0.9, 0.8, 0.5)), fog(number("sigma_t", 0.3)))
    ball = shape("sphere", point("center", 0.5, 0, 0), number("radius", 0.7), bsdf("dielectric", number("int_ior", 1.3)), milk, ref("fog", "exterior"))
    yield Case("sensor", "perspective", "medium", "fog around a body", fog(number("sigma_t", 0.3), things=ball), fog(number("sigma_t", 0.3)))


def integrators():
    milk = medium(number("sigma_t", 1.5))
    of = lambda type_, *more, depth=DEPTH: filled(NULL, milk, integrator=tracer(depth, type_, *more))
    for type_ in ("volpath", "volpathmis"):
        for depth in (2, 3, -1):
            yield Case("integrator", type_, "max_depth", f"{depth}, in a medium", of(type_, depth=depth), of(type_, depth=5) if depth > 0 else None)
        yield Case("integrator", type_, "rr_depth", "2, in a medium", of(type_, integer("rr_depth", 2), depth=-1), None)
        hidden = element("boolean", name="hide_emitters", value="true")
        yield Case("integrator", type_, "hide_emitters", "true, beside a medium", of(type_, hidden), of(type_))
    yield Case("integrator", "path", "medium", "left out", of("path"), None)
    yield Case("integrator", "prbvolpath", "max_depth", "6", of("prbvolpath"), None)
