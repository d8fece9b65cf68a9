"""The forms in which a colour, a light or a number can be written."""

from . import files
from .scene import element, number, rgb, spectrum, string, texture


def of_surface(name):
    """(form, element) of a reflectance."""
    return [
        ("rgb of three", rgb(name, 0.7, 0.3, 0.1)),
        ("rgb of three apart by blanks", element("rgb", name=name, value="0.7 0.3 0.1")),
        ("rgb of one", rgb(name, 0.35)),
        ("rgb in hexadecimal", rgb(name, "#c08040")),
        ("float", number(name, 0.35)),
        ("spectrum of one value", element("spectrum", name=name, value=0.35)),
        ("spectrum of pairs", element("spectrum", name=name, value="400:0.1, 500:0.2, 600:0.7, 700:0.8")),
        ("spectrum of pairs in part of the range", element("spectrum", name=name, value="480:0.3 560:0.8 620:0.1")),
        ("spectrum of a file", element("spectrum", name=name, filename=files.SPECTRUM)),
        ("spectrum of three values", element("spectrum", name=name, value="0.7, 0.3, 0.1")),
        ("srgb plugin", spectrum("srgb", rgb("color", 0.7, 0.3, 0.1), name=name)),
        ("rgb plugin", spectrum("rgb", rgb("value", 0.7, 0.3, 0.1), name=name)),
        ("uniform plugin", spectrum("uniform", number("value", 0.35), name=name)),
        ("regular plugin", spectrum("regular", string("values", "0.1, 0.2, 0.7, 0.8"), number("wavelength_min", 400), number("wavelength_max", 700), name=name)),
        ("irregular plugin", spectrum("irregular", string("values", "0.1 0.8 0.2"), string("wavelengths", "420 540 680"), name=name)),
        ("d65 plugin", spectrum("d65", number("scale", 0.4), name=name)),
        ("rawconstant of one", texture("rawconstant", number("value", 0.35), name=name)),
        ("rawconstant of three", texture("rawconstant", element("rgb", name="value", value="0.7 0.3 0.1"), name=name)),
        ("rawconstant of a vector", texture("rawconstant", element("vector", name="value", value="0.7 0.3 0.1"), name=name)),
        ("bitmap", bitmap(name, files.COLOURS)),
        ("bitmap, raw", bitmap(name, files.COLOURS, raw=True)),
        ("grey bitmap", bitmap(name, files.GREYS)),
        ("bitmap in single precision", bitmap(name, files.FLOATS)),
        ("checkerboard", texture("checkerboard", rgb("color0", 0.7, 0.3, 0.1), rgb("color1", 0.1, 0.4, 0.5), name=name)),
    ]


# Values that are tried in slots that go the way of another one.
SHORT = ("rgb of three", "float", "spectrum of pairs", "bitmap", "bitmap, raw")
SHORT_NUMBERS = ("float", "rgb of three", "grey bitmap", "coloured bitmap, raw", "checkerboard")


def of_light(name):
    """(form, element) of a light's colour."""
    return [
        ("rgb of three", rgb(name, 3, 2, 1)),
        ("rgb of one", rgb(name, 2)),
        ("rgb in hexadecimal", rgb(name, "#c08040")),
        ("float", number(name, 2)),
        ("spectrum of one value", element("spectrum", name=name, value=2)),
        ("spectrum of pairs", element("spectrum", name=name, value="400:1, 500:2, 600:7, 700:8")),
        ("spectrum of pairs in part of the range", element("spectrum", name=name, value="480:3 560:8 620:1")),
        ("spectrum of a file", element("spectrum", name=name, filename=files.SPECTRUM)),
        ("srgb plugin", spectrum("srgb", rgb("color", 0.7, 0.3, 0.1), name=name)),
        ("rgb plugin", spectrum("rgb", rgb("value", 0.7, 0.3, 0.1), name=name)),
        ("uniform plugin", spectrum("uniform", number("value", 2), name=name)),
        ("regular plugin", spectrum("regular", string("values", "1, 2, 7, 8"), number("wavelength_min", 400), number("wavelength_max", 700), name=name)),
        ("irregular plugin", spectrum("irregular", string("values", "1 8 2"), string("wavelengths", "420 540 680"), name=name)),
        ("d65 plugin", spectrum("d65", name=name)),
        ("d65 plugin with a scale", spectrum("d65", number("scale", 2.5), name=name)),
        ("d65 plugin with a colour", spectrum("d65", rgb("color", 3, 2, 1), name=name)),
        ("d65 plugin with a colour and a scale", spectrum("d65", rgb("color", 3, 2, 1), number("scale", 0.5), name=name)),
        ("blackbody plugin", spectrum("blackbody", number("temperature", 3000), name=name)),
        ("blackbody plugin of a part", spectrum("blackbody", number("temperature", 6500), number("wavelength_min", 450), number("wavelength_max", 600), name=name)),
        ("rawconstant of one", texture("rawconstant", number("value", 2), name=name)),
        ("rawconstant of three", texture("rawconstant", element("rgb", name="value", value="3 2 1"), name=name)),
    ]


def of_number(name, low=0.15, high=0.6):
    """(form, element) of a number from 0 to 1 that may vary over a surface."""
    middle = round((low + high) / 2, 3)
    return [
        ("float", number(name, low)),
        ("another float", number(name, high)),
        ("spectrum of one value", element("spectrum", name=name, value=high)),
        ("rgb of one", rgb(name, high)),
        ("rgb of three", rgb(name, high, middle, low)),
        ("rgb in hexadecimal", rgb(name, "#808080")),
        ("uniform plugin", spectrum("uniform", number("value", high), name=name)),
        ("rawconstant of one", texture("rawconstant", number("value", high), name=name)),
        ("grey bitmap", bitmap(name, files.GREYS)),
        ("grey bitmap, raw", bitmap(name, files.GREYS, raw=True)),
        ("coloured bitmap", bitmap(name, files.COLOURS)),
        ("coloured bitmap, raw", bitmap(name, files.COLOURS, raw=True)),
        ("bitmap in single precision", bitmap(name, files.FLOATS)),
        ("bitmap of 16 bits", bitmap(name, files.GREYS_16)),
        ("checkerboard", texture("checkerboard", rgb("color0", high), rgb("color1", low), name=name)),
        ("coloured checkerboard", texture("checkerboard", rgb("color0", high, middle, low), rgb("color1", low), name=name)),
    ]


def bitmap(name, file, *more, raw=None, filter_="nearest"):
    words = () if raw is None else (element("boolean", name="raw", value="true" if raw else "false"),)
    return texture("bitmap", string("filename", file), string("filter_type", filter_), *words, *more, name=name)
