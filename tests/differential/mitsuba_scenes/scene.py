"""What scenes are made of: elements of Mitsuba's XML, the rigs that show a plugin, and the cases that tell what is shown."""

import math
from dataclasses import dataclass

SIZE = 16


@dataclass
class Case:
    """One scene. `other` is a scene in which the parameter has another value: Mitsuba's two pictures have to differ, so that the case tests
    what it says; a parameter that changes no picture has none. `part` is what is varied, as kind, plugin and parameter; `form` says how. `planted_in` is what Mitsuba
    renders where the scene is a control."""

    kind: str
    plugin: str
    parameter: str
    form: str
    xml: str
    other: str | None
    definitions: tuple = ()
    planted_in: str = ""

    @property
    def part(self):
        return f"{self.kind} {self.plugin}: {self.parameter}"

    @property
    def name(self):
        return f"{self.part}: {self.form}"


def element(tag, *within, **attributes):
    """An element. A trailing underscore keeps attributes apart from Python's words."""
    words = "".join(f' {key.rstrip("_")}="{value}"' for key, value in attributes.items() if value is not None)
    inner = "".join(within)
    return f"<{tag}{words}>{inner}</{tag}>" if inner else f"<{tag}{words}/>"


def plugin(kind, type_, *within, name=None, id=None):
    return element(kind, *within, type=type_, name=name, id=id)


def bsdf(type_, *within, name=None, id=None):
    return plugin("bsdf", type_, *within, name=name, id=id)


def shape(type_, *within, id=None):
    return plugin("shape", type_, *within, id=id)


def emitter(type_, *within, id=None):
    return plugin("emitter", type_, *within, id=id)


def texture(type_, *within, name=None, id=None):
    return plugin("texture", type_, *within, name=name, id=id)


def spectrum(type_, *within, name=None):
    return plugin("spectrum", type_, *within, name=name)


def number(name, value):
    return element("float", name=name, value=value)


def integer(name, value):
    return element("integer", name=name, value=value)


def string(name, value):
    return element("string", name=name, value=value)


def flag(name, value):
    return element("boolean", name=name, value="true" if value else "false")


def rgb(name, *value):
    return element("rgb", name=name, value=", ".join(str(one) for one in value))


def point(name, x, y, z):
    return element("point", name=name, x=x, y=y, z=z)


def vector(name, x, y, z):
    return element("vector", name=name, x=x, y=y, z=z)


def transform(*steps, name="to_world"):
    return element("transform", *steps, name=name)


def translate(x, y, z):
    return element("translate", x=x, y=y, z=z)


def scale(x, y=None, z=None):
    return element("scale", value=x) if y is None else element("scale", x=x, y=y, z=z)


def rotate(x, y, z, angle):
    """About an axis of length 1: Mitsuba 3 makes no rotation of one that is longer."""
    length = math.sqrt(x * x + y * y + z * z)
    return element("rotate", x=x / length, y=y / length, z=z / length, angle=angle)


def look_at(origin, target, up="0, 1, 0"):
    return element("lookat", origin=origin, target=target, up=up)


def matrix(*numbers):
    return element("matrix", value=" ".join(str(one) for one in numbers))


def film(*more, width=SIZE, height=SIZE, filter_=plugin("rfilter", "box"), type_="hdrfilm"):
    return plugin("film", type_, integer("width", width), integer("height", height), *more, filter_)


SAMPLER = plugin("sampler", "independent", integer("sample_count", 16))


def sensor(*more, type_="perspective", film_=None, sampler=SAMPLER):
    return plugin("sensor", type_, *more, film() if film_ is None else film_, sampler)


def camera(origin, target="0, 0, 0", fov=30, up="0, 1, 0", film_=None):
    return sensor(number("fov", fov), transform(look_at(origin, target, up)), film_=film_)


def path(depth):
    return plugin("integrator", "path", integer("max_depth", depth))


def scene(*parts, version="3.0.0"):
    return element("scene", *parts, version=version)


def lamp(radiance, *within):
    """A black surface that gives light."""
    return "".join(within) + bsdf("diffuse", rgb("reflectance", 0)) + emitter("area", rgb("radiance", *radiance))


def light_box(half=8):
    """Six walls of light, each of another colour, which is what an environment is: exact, and without a texture."""
    walls = [
        ((1.2, 0.4, 0.2), rotate(0, 1, 0, -90), translate(half, 0, 0)),
        ((0.2, 0.5, 1.1), rotate(0, 1, 0, 90), translate(-half, 0, 0)),
        ((1.5, 1.4, 1.2), rotate(1, 0, 0, 90), translate(0, half, 0)),
        ((0.15, 0.2, 0.1), rotate(1, 0, 0, -90), translate(0, -half, 0)),
        ((0.6, 0.6, 0.7), rotate(0, 1, 0, 180), translate(0, 0, half)),
        ((0.3, 0.25, 0.5), translate(0, 0, -half)),
    ]
    return "".join(shape("rectangle", transform(scale(half), *steps), lamp(colour)) for colour, *steps in walls)


LAMP = emitter("point", point("position", 1.5, 2.5, 4), rgb("intensity", 14, 12, 10))


def ball(surface, depth=3, *more):
    """A sphere of this BSDF in the box of light, with a point light."""
    return scene(path(depth), camera("0, 0, 4.4", fov=29), shape("sphere", surface), light_box(), LAMP, *more)


def card(surface, depth=2, *more):
    """A square of this BSDF that fills the picture, seen along its normal; a point light and walls of light."""
    seen = shape("rectangle", transform(scale(1.05)), surface)
    return scene(path(depth), camera("0, 0, 5", fov=22.6), seen, light_box(), LAMP, *more)


def tilted(surface, depth=2, *more):
    """A square of this BSDF, seen from the side, where a metal's highlight is broad."""
    seen = shape("rectangle", transform(scale(1.4)), surface)
    return scene(path(depth), camera("1.5, 2, 4", fov=24), seen, light_box(), LAMP, *more)


def shown(thing, depth=2, *more):
    """A shape in the box of light, from above and aside. The wide square behind takes its shadow."""
    back = shape("rectangle", transform(scale(5), translate(0, 0, -2.5)), bsdf("diffuse", rgb("reflectance", 0.4, 0.5, 0.6)))
    return scene(path(depth), camera("2.6, 2, 4.2", fov=36), thing, back, light_box(), LAMP, *more)


def lit(light, *more, depth=2):
    """What a light does to a floor, a wall, and a sphere that shadows them."""
    grey = bsdf("diffuse", rgb("reflectance", 0.6, 0.55, 0.5))
    floor = shape("rectangle", transform(scale(4)), grey)
    ball_ = shape("sphere", point("center", 0.5, 0.3, 0.7), number("radius", 0.5), grey)
    return scene(path(depth), camera("0, -1.5, 6", fov=36), floor, ball_, light, *more)


def diffuse(*colour):
    return bsdf("diffuse", rgb("reflectance", *colour))
