"""Scenes by gpt beside Cycles, and for each a fault planted in the exporter, which has to be noticed."""

import importlib
import os
import shutil
import tempfile
import unittest
from unittest import mock

try:
    import bpy  # noqa: F401
except ImportError:
    raise unittest.SkipTest("the module bpy is not there: `pip install bpy` has it (about 350 MB, for one version of Python)") from None

import compare
import numpy
import scenes

if shutil.which(compare.gpt()) is None:
    raise unittest.SkipTest("the program gpt is not there: set GPT to its path")


def module(name):
    return importlib.import_module(f"gpt_blender.{name}")


def changed(name, function, change):
    """The exporter with one function's result changed."""
    of = module(name)
    plain = getattr(of, function)

    def faulty(*arguments, **keys):
        return change(plain(*arguments, **keys))

    return mock.patch.object(of, function, faulty)


def camera_key(key, change):
    """The exporter with one key of the camera changed."""
    of = module("camera")
    plain = of.export

    def faulty(scene, made, file, report):
        plain(scene, made, file, report)
        file.camera[key] = change(file.camera[key])

    return mock.patch.object(of, "export", faulty)


def in_viewport():
    """The exporter that takes what the viewport shows: modifiers of another level."""
    return mock.patch.object(
        module("engine"), "with_render_depsgraph", lambda scene, work: work(bpy.context.evaluated_depsgraph_get()))


FAULTS = {
    "sharp_lamps": lambda: changed("lamps", "_power", lambda power: 1.02 * power),
    "soft_lamps": lambda: changed("lamps", "_power", lambda power: 1.02 * power),
    "world_map": lambda: changed("world", "_rotation", lambda angle: angle + 0.05),
    "lenses": lambda: camera_key("shift", lambda shift: [shift[0], 0.9 * shift[1]]),
    "panoramas": lambda: camera_key("azimuth", lambda azimuth: [-azimuth[1], -azimuth[0]]),
    "metals": lambda: changed("principled", "_common", lambda entry: {**entry, "energy_compensation": False}),
    "principled": lambda: changed("principled", "_interface", lambda found: (2.0, *found[1:])),
    "glass": lambda: changed("shaders", "_dielectric", lambda entry: {**entry, "ior": entry["ior"] * 1.1}),
    "trees": lambda: changed("weights", "heuristic", lambda found: {**found, "power": 1.1 * found["power"]} if found and "power" in found else found),
    "textures": lambda: mock.patch.object(module("values").Values, "_mapping", lambda *_: numpy.array([[2.0, 0, 0], [0, 1, 0]])),
    "places": in_viewport,
    "parallel": lambda: camera_key("height", lambda height: 1.02 * height),
    "fisheye": lambda: camera_key("fov", lambda fov: 1.02 * fov),
    "brushed": lambda: changed("meshes", "uv_of", lambda uvs: uvs[:, ::-1]),
    "linked": lambda: changed("links", "_is_lit", lambda _: True),
    "sky": lambda: changed("engine", "bake_world", lambda pixels: pixels[:, ::-1]),
}

BEYOND = {"principled": 0.06}
"""Scenes in which the programs' models differ, with the most by which a tile may: see docs/from-blender.md."""


class BesideCycles(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="gpt-beside-")
        self.addCleanup(shutil.rmtree, self.folder)

    def compare(self, make):
        return compare.beside(make, os.path.join(self.folder, "scene"))[0]

    def agrees(self, name, result):
        if name in BEYOND:
            return 1 - BEYOND[name] < result["low"] and result["high"] < 1 + BEYOND[name] and abs(result["ratio"] - 1) < 0.02
        return result["off"] == 0


def _tests(make):
    name = make.__name__

    def agrees(self):
        result = self.compare(make)
        print(name, result)
        self.assertTrue(self.agrees(name, result), result)

    def is_noticed(self):
        with FAULTS[name]():
            result = self.compare(make)
        print(name, "with a fault", result)
        self.assertFalse(self.agrees(name, result), result)

    return agrees, is_noticed


for _make in (*scenes.SCENES, *scenes.FURTHER):
    _agrees, _is_noticed = _tests(_make)
    setattr(BesideCycles, f"test_{_make.__name__}", _agrees)
    setattr(BesideCycles, f"test_a_fault_in_{_make.__name__}_is_noticed", _is_noticed)


if __name__ == "__main__":
    unittest.main()
