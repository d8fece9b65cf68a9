"""Cases of sensors, films, filters, samplers and integrators."""

from . import files, values
from .scene import LAMP, Case, bsdf, camera, diffuse, emitter, film, flag, integer, light_box, look_at, matrix, number, path, plugin, point, rgb, rotate, scale, scene, sensor, shape, string, transform, translate

PAINT = bsdf("twosided", bsdf("diffuse", values.bitmap("reflectance", files.COLOURS, filter_="bilinear")))
AIM = transform(look_at("1.5, 1.2, 4.5", "0, 0, 0"))
STILL = "".join(
    [
        shape("rectangle", transform(scale(1.6)), PAINT),
        shape("sphere", point("center", 0.5, 0.2, 0.8), number("radius", 0.5), diffuse(0.2, 0.5, 0.3)),
        shape("rectangle", transform(scale(0.4), rotate(0, 1, 0, 20), translate(-0.7, 0.3, 1.4)), bsdf("twosided", diffuse(0.7, 0.4, 0.1))),
    ]
)


def seen(sensor_, depth=2, integrator=None):
    return scene(path(depth) if integrator is None else integrator, sensor_, STILL, light_box(), LAMP)


def cases():
    yield from views()
    yield from lenses()
    yield from placed()
    yield from films()
    yield from filters()
    yield from integrators()
    yield from samplers()


def views():
    fov = lambda *more, film_=None: seen(sensor(AIM, *more, film_=film_))
    plain = fov(number("fov", 40))
    for angle in (15, 40, 95):
        yield Case("sensor", "perspective", "fov", str(angle), fov(number("fov", angle)), fov(number("fov", 55)))
    yield Case("sensor", "perspective", "fov", "not given", fov(), plain)
    for size, word in (((16, 16), "square"), ((24, 12), "wide"), ((12, 20), "tall")):
        for axis in ("x", "y", "diagonal", "smaller", "larger"):
            shot = film(width=size[0], height=size[1])
            yield Case("sensor", "perspective", "fov_axis", f"{axis}, {word}", fov(number("fov", 40), string("fov_axis", axis), film_=shot), fov(number("fov", 52), string("fov_axis", axis), film_=shot))
        yield Case("sensor", "perspective", "fov_axis", f"not given, {word}", fov(number("fov", 40), film_=shot), fov(number("fov", 52), film_=shot))
        for length in ("35mm", "85mm", "50"):
            yield Case("sensor", "perspective", "focal_length", f"{length}, {word}", fov(string("focal_length", length), film_=shot), fov(string("focal_length", "61mm"), film_=shot))
    yield Case("sensor", "perspective", "focal_length", "not given, wide", fov(film_=film(width=24, height=12)), fov(number("fov", 50), film_=film(width=24, height=12)))
    for axis in "xy":
        for amount in (0.2, -0.35):
            parameter = f"principal_point_offset_{axis}"
            yield Case("sensor", "perspective", parameter, str(amount), fov(number("fov", 40), number(parameter, amount)), plain)
    yield Case("sensor", "perspective", "principal_point_offset_x", "both, cropped", fov(number("fov", 40), number("principal_point_offset_x", 0.1), number("principal_point_offset_y", 0.2), film_=cropped()), fov(number("fov", 40), film_=cropped()))
    for parameter, amount in (("near_clip", 3.7), ("near_clip", 0.5), ("far_clip", 4.5), ("far_clip", 50)):
        yield Case("sensor", "perspective", parameter, str(amount), fov(number("fov", 40), number(parameter, amount)), plain if amount in (3.7, 4.5) else None)
    for parameter in ("shutter_open", "shutter_close"):
        yield Case("sensor", "perspective", parameter, "given", fov(number("fov", 40), number(parameter, 0 if parameter == "shutter_open" else 0.5)), None)
    yield Case("sensor", "perspective", "focus_distance", "3", fov(number("fov", 40), number("focus_distance", 3)), None)


def cropped():
    return film(integer("crop_width", 12), integer("crop_height", 8), integer("crop_offset_x", 10), integer("crop_offset_y", 3), width=24, height=20)


def lenses():
    lens = lambda *more, film_=None: seen(sensor(AIM, number("fov", 40), *more, type_="thinlens", film_=film_))
    focus = number("focus_distance", 3.2)
    for radius in (0.1, 0.5):
        yield Case("sensor", "thinlens", "aperture_radius", str(radius), lens(number("aperture_radius", radius), focus), lens(number("aperture_radius", 0.25), focus))
    for distance in (3, 6):
        yield Case("sensor", "thinlens", "focus_distance", str(distance), lens(number("aperture_radius", 0.4), number("focus_distance", distance)), lens(number("aperture_radius", 0.4), number("focus_distance", 4)))
    yield Case("sensor", "thinlens", "focus_distance", "not given", lens(number("aperture_radius", 0.3)), lens(number("aperture_radius", 0.3), focus))
    yield Case("sensor", "thinlens", "aperture_radius", "not given", lens(focus), lens(number("aperture_radius", 0.5), focus))
    yield Case("sensor", "thinlens", "fov", "wide film", lens(number("aperture_radius", 0.2), focus, film_=film(width=24, height=12)), lens(number("aperture_radius", 0.5), focus, film_=film(width=24, height=12)))
    yield Case("sensor", "thinlens", "film", "cropped", lens(number("aperture_radius", 0.2), focus, film_=cropped()), lens(number("aperture_radius", 0.5), focus, film_=cropped()))
    lens = lambda *steps: seen(sensor(number("fov", 40), transform(*steps), number("aperture_radius", 0.3), focus, type_="thinlens"))
    yield Case("sensor", "thinlens", "to_world", "scaled", lens(scale(2), look_at("1.5, 1.2, 4.5", "0, 0, 0")), lens(look_at("1, 1.2, 4.5", "0, 0, 0")))


def placed():
    aim = look_at("1.5, 1.2, 4.5", "0, 0, 0")
    steps_of = {
        "lookat": (aim,),
        "lookat of another up": (look_at("1.5, 1.2, 4.5", "0, 0, 0", "1, 0.2, 0"),),
        "lookat with up not across": (look_at("1.5, 1.2, 4.5", "0, 0, 0", "0.3, 1, 0.9"),),
        "lookat along up": (look_at("0, 4.5, 0.001", "0, 0, 0", "0, 1, 0"),),
        "not given": None,
        "turn and translation": (rotate(0, 1, 0, 190), translate(0.3, 0.2, 5)),
        "turn about its axis": (rotate(0, 0, 1, 25), aim),
        "uniform scale": (scale(3), aim),
        "uneven scale": (scale(1.5, 0.8, 1), aim),
        "scale along its axis": (scale(1, 1, 2), aim),
        "scale of the world": (look_at("3, 2.4, 9", "0, 0, 0"), scale(0.5)),
        "mirrored in x": (scale(-1, 1, 1), aim),
        "mirrored in y": (scale(1, -1, 1), aim),
        "mirrored in the world": (aim, scale(-1, 1, 1)),
        "mirrored thrice": (scale(-1), aim),
        "shear": (matrix(1, 0.3, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1), aim),
        "matrix": (matrix(-1, 0, 0, 0.3, 0, 1, 0, 0.2, 0, 0, -1, 5, 0, 0, 0, 1),),
    }
    for type_, more in (("perspective", (number("fov", 40),)), ("orthographic", ())):
        for form, steps in steps_of.items():
            if steps is not None and type_ == "orthographic":
                steps = (scale(1.6), *steps)
            made = seen(sensor(*more, *(() if steps is None else (transform(*steps),)), type_=type_))
            other = seen(sensor(*more, transform(*(() if type_ == "perspective" else (scale(1.6),)), look_at("1.8, 1.2, 4.5", "0.2, 0, 0")), type_=type_))
            yield Case("sensor", type_, "to_world", form, made, other)
    ortho = lambda *more, film_=None, size=(1.6,): seen(sensor(transform(scale(*size), aim), *more, type_="orthographic", film_=film_))
    plain = ortho()
    for size in ((0.7,), (2, 1, 1), (1, 2, 1)):
        yield Case("sensor", "orthographic", "to_world", f"scale {size}", ortho(size=size), plain)
    for shot, form in ((film(width=24, height=12), "wide film"), (film(width=12, height=20), "tall film"), (cropped(), "cropped film")):
        yield Case("sensor", "orthographic", "film", form, ortho(film_=shot), ortho(film_=shot, size=(1.9,)))
    for parameter, amount in (("near_clip", 3.7), ("far_clip", 4.5)):
        yield Case("sensor", "orthographic", parameter, str(amount), ortho(number(parameter, amount)), plain)


def films():
    shot = lambda made: seen(sensor(AIM, number("fov", 40), film_=made))
    for width, height in ((16, 16), (24, 12), (9, 17)):
        made = film(width=width, height=height)
        yield Case("film", "hdrfilm", "width, height", f"{width} and {height}", shot(made), seen(sensor(AIM, number("fov", 55), film_=made)))
    for form, more in {
        "left and above": (integer("crop_width", 10), integer("crop_height", 12)),
        "in the middle": (integer("crop_width", 10), integer("crop_height", 12), integer("crop_offset_x", 7), integer("crop_offset_y", 4)),
        "at the far corner": (integer("crop_width", 8), integer("crop_height", 8), integer("crop_offset_x", 16), integer("crop_offset_y", 12)),
    }.items():
        made = film(*more, width=24, height=20)
        yield Case("film", "hdrfilm", "crop", form, shot(made), seen(sensor(AIM, number("fov", 55), film_=made)))
    for parameter, value in (("pixel_format", "rgba"), ("component_format", "float16"), ("file_format", "pfm")):
        yield Case("film", "hdrfilm", parameter, value, shot(film(string(parameter, value))), None)
    for parameter in ("sample_border", "compensate"):
        yield Case("film", "hdrfilm", parameter, "true", shot(film(flag(parameter, True))), None)


def filters():
    """With a lamp that a pixel or two show, so that a filter's width is seen."""
    small = shape("rectangle", transform(scale(0.09), translate(0.3, 0.4, 0.5)), emitter("area", rgb("radiance", 30, 20, 10)))
    shot = lambda filter_: scene(path(1), camera("0, 0, 5", fov=24, film_=film(filter_=filter_)), small, shape("rectangle", transform(scale(0.5), translate(-0.4, -0.3, 0)), emitter("area", rgb("radiance", 1, 2, 3))))
    box = shot(plugin("rfilter", "box"))
    yield Case("rfilter", "none", "none", "not given", shot(""), box)
    yield Case("rfilter", "box", "radius", "not given", box, shot(plugin("rfilter", "gaussian")))
    for name in ("tent", "gaussian", "mitchell", "catmullrom", "lanczos"):
        yield Case("rfilter", name, "plugin", "as it is", shot(plugin("rfilter", name)), box)
    for radius in (0.7, 2):
        yield Case("rfilter", "tent", "radius", str(radius), shot(plugin("rfilter", "tent", number("radius", radius))), shot(plugin("rfilter", "tent")))
    for deviation in (0.3, 1):
        yield Case("rfilter", "gaussian", "stddev", str(deviation), shot(plugin("rfilter", "gaussian", number("stddev", deviation))), shot(plugin("rfilter", "gaussian")))
    yield Case("rfilter", "mitchell", "B, C", "0.2 and 0.5", shot(plugin("rfilter", "mitchell", number("B", 0.2), number("C", 0.5))), box)
    yield Case("rfilter", "lanczos", "lobes", "2", shot(plugin("rfilter", "lanczos", integer("lobes", 2))), box)


def integrators():
    def inside(made):
        """Walls that see each other, so that depth counts; glass and a lamp as well."""
        walls = shape("cube", transform(scale(2)), flag("flip_normals", True), bsdf("diffuse", rgb("reflectance", 0.7, 0.6, 0.5)))
        lamp = shape("rectangle", transform(scale(0.8), rotate(1, 0, 0, 90), translate(0, 1.8, 0)), emitter("area", rgb("radiance", 5, 4, 3)))
        return scene(made, camera("0, -0.8, 1.9", "0, 0.3, 0", fov=75), walls, lamp, shape("sphere", number("radius", 0.6), bsdf("dielectric")))

    deep = lambda type_, *more: inside(plugin("integrator", type_, *more))
    for depth in (1, 2, 3, 8, -1):
        yield Case("integrator", "path", "max_depth", str(depth), deep("path", integer("max_depth", depth)), deep("path", integer("max_depth", 4)))
    yield Case("integrator", "path", "max_depth", "0", deep("path", integer("max_depth", 0)), deep("path", integer("max_depth", 4)))
    yield Case("integrator", "path", "max_depth", "not given", deep("path"), deep("path", integer("max_depth", 4)))
    for parameter in ("block_size", "samples_per_pass"):
        yield Case("integrator", "path", parameter, "4", deep("path", integer("max_depth", 3), integer(parameter, 4)), None)
    yield Case("integrator", "path", "timeout", "1000", deep("path", integer("max_depth", 3), number("timeout", 1000)), None)
    yield Case("integrator", "path", "rr_depth", "2", deep("path", integer("rr_depth", 2)), None)
    for name, more in (("path", (integer("max_depth", 3),)), ("direct", ()), ("volpath", (integer("max_depth", 3),))):
        for value in (True, False):
            yield Case("integrator", name, "hide_emitters", str(value).lower(), deep(name, *more, flag("hide_emitters", value)), deep(name, *more, flag("hide_emitters", not value)))
        for value in (True, False):
            sky = lambda hides: scene(plugin("integrator", name, *more, flag("hide_emitters", hides)), camera("0, 0, 4.5"), shape("sphere", diffuse(0.5, 0.4, 0.3)), emitter("constant", rgb("radiance", 0.7, 0.8, 0.9)))
            yield Case("integrator", name, "hide_emitters", f"{str(value).lower()}, of surroundings", sky(value), sky(not value))
    yield Case("integrator", "direct", "plugin", "as it is", deep("direct"), deep("path"))
    for parameter in ("emitter_samples", "bsdf_samples", "shading_samples"):
        more = (integer("bsdf_samples", 1),) if parameter == "emitter_samples" else (integer("emitter_samples", 1),) if parameter == "bsdf_samples" else ()
        yield Case("integrator", "direct", parameter, "2", deep("direct", integer(parameter, 2), *more), None)
    yield Case("integrator", "direct", "emitter_samples", "0", deep("direct", integer("emitter_samples", 0), integer("bsdf_samples", 1)), None)
    yield Case("integrator", "direct", "bsdf_samples", "0", deep("direct", integer("emitter_samples", 1), integer("bsdf_samples", 0)), None)
    for name in ("volpath", "volpathmis", "ptracer"):
        yield Case("integrator", name, "max_depth", "3", deep(name, integer("max_depth", 3)), deep("path", integer("max_depth", 2)))
    yield Case("integrator", "depth", "plugin", "as it is", deep("depth"), deep("path"))
    nested = plugin("integrator", "path", integer("max_depth", 3))
    yield Case("integrator", "aov", "integrator", "path within", inside(plugin("integrator", "aov", string("aovs", "d:depth"), nested)), inside(plugin("integrator", "path", integer("max_depth", 2))))
    yield Case("integrator", "moment", "integrator", "path within", inside(plugin("integrator", "moment", nested)), inside(plugin("integrator", "path", integer("max_depth", 2))))
    yield Case("integrator", "none", "none", "not given", inside(""), None)


def samplers():
    for name in ("independent", "stratified", "multijitter", "orthogonal", "ldsampler"):
        yield Case("sampler", name, "plugin", "as it is", seen(sensor(AIM, number("fov", 40), sampler=plugin("sampler", name, integer("sample_count", 16)))), None)
    yield Case("sampler", "independent", "sample_count", "not given", seen(sensor(AIM, number("fov", 40), sampler=plugin("sampler", "independent"))), None)
    yield Case("sampler", "independent", "seed", "7", seen(sensor(AIM, number("fov", 40), sampler=plugin("sampler", "independent", integer("sample_count", 16), integer("seed", 7)))), None)
    yield Case("sampler", "stratified", "jitter", "false", seen(sensor(AIM, number("fov", 40), sampler=plugin("sampler", "stratified", integer("sample_count", 16), flag("jitter", False)))), None)
