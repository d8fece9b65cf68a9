"""What the exporter writes, by closed forms and by what Cycles computes of the same lamps."""

import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    import bpy
except ImportError:
    raise unittest.SkipTest("the module bpy is not there: `pip install bpy` has it (about 350 MB, for one version of Python)") from None

import tomllib

import compare
import numpy
import scenes
from gpt_blender.picture_file import write_exr
from gpt_blender.report import Report
from gpt_blender.scene import export
from gpt_blender.scene_file import toml
from gpt_blender.shaders import share_kept

HERE = os.path.dirname(os.path.abspath(__file__))
EXPORT = os.path.join(HERE, "..", "export.py")


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="gpt-export-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.path = os.path.join(self.folder, "scene.toml")

    def exported(self, scene):
        self.report, self.flags = export(scene, self.path)
        with open(self.path, "rb") as file:
            return tomllib.load(file)

    def says(self, *words):
        lines = [str(line) for line in self.report.lines]
        self.assertTrue(any(all(word in line for word in words) for line in lines), (words, lines))


class Lamps(Case):
    """The irradiance E under a lamp at height d above the middle of a white floor, whose radiance is E/π."""

    HEIGHT = 2.0

    def irradiance_by_cycles(self):
        scene = bpy.context.scene
        scenes.floor(scenes.simple("White", "BsdfDiffuse", Color=(1, 1, 1)))
        scenes.camera(location=(0, 0, 1), rotation=(0, 0, 0), type="ORTHO", ortho_scale=0.02)
        scene.cycles.max_bounces = 0
        scene.render.resolution_x = scene.render.resolution_y = 8
        return math.pi * compare.by_cycles(scene, self.folder, runs=1, samples=1024)[0].mean()

    def check(self, kind, power, expected, **keys):
        scenes.empty()
        scenes.lamp(kind, power, (0, 0, self.HEIGHT), **keys)
        self.assertAlmostEqual(self.irradiance_by_cycles() / expected, 1, delta=2e-3)
        self.assertGreater(abs(self.irradiance_by_cycles() / (1.01 * expected) - 1), 2e-3)
        return self.exported(bpy.context.scene)

    def test_point(self):
        found = self.check("POINT", 80, 80 / (4 * math.pi * self.HEIGHT**2))
        self.assertAlmostEqual(found["light"][0]["intensity"], 80 / (4 * math.pi), places=5)

    def test_spot(self):
        found = self.check("SPOT", 80, 80 / (4 * math.pi * self.HEIGHT**2), spot_size=math.radians(60), spot_blend=0.5)
        spot = found["light"][0]
        self.assertAlmostEqual(spot["intensity"], 80 / (4 * math.pi), places=5)
        self.assertAlmostEqual(spot["angle"], 30, places=4)
        edge = math.cos(math.radians(30))
        self.assertAlmostEqual(math.cos(math.radians(spot["falloff"])), edge + 0.5 * (1 - edge), places=5)

    def emitted(self, found):
        """Radiance of the lamp's surface."""
        entry = next(entry for entry in found["material"] if "emission" in entry)
        return entry["emission"] * entry["opacity"]

    def test_sphere(self):
        # On the axis of a sphere of radiance L: π L r²/d².
        radiance = 80 / (4 * math.pi**2 * 0.3**2)
        found = self.check("POINT", 80, math.pi * radiance * 0.3**2 / self.HEIGHT**2, shadow_soft_size=0.3, use_soft_falloff=False)
        self.assertAlmostEqual(self.emitted(found) / radiance, 1, places=5)

    def test_disk(self):
        # On the axis of a disk of radiance L: π L r²/(r² + d²).
        radiance = 80 / (math.pi * math.pi * 0.5**2)
        found = self.check("AREA", 80, math.pi * radiance * 0.25 / (0.25 + self.HEIGHT**2), shape="DISK", size=1.0)
        self.assertAlmostEqual(self.emitted(found) / radiance, 1, places=5)

    def test_square_and_scale(self):
        # Below the middle of a rectangle 2a × 2b (Howell's catalogue, B-4, four times).
        a, b, d = 0.5 * 1.2, 0.25 * 0.8, self.HEIGHT
        radiance = 80 / (math.pi * 4 * a * b)
        x, y = a / d, b / d
        factor = 4 / (2 * math.pi) * sum(
            p / math.sqrt(1 + p * p) * math.atan(q / math.sqrt(1 + p * p)) for p, q in ((x, y), (y, x)))
        found = self.check("AREA", 80, math.pi * radiance * factor, shape="RECTANGLE", size=1.0, size_y=0.5, scale=(1.2, 0.8, 1))
        self.assertAlmostEqual(self.emitted(found) / radiance, 1, places=5)

    def test_sun(self):
        found = self.check("SUN", 3, 3.0, angle=0)
        self.assertAlmostEqual(found["light"][0]["irradiance"], 3, places=6)

    def test_sun_with_an_angle(self):
        half = math.radians(10)
        found = self.check("SUN", 3, 3.0, angle=2 * half)
        self.assertAlmostEqual(self.emitted(found) * math.pi * math.sin(half) ** 2, 3, places=4)


class Cameras(Case):
    def test_lens_shift_and_fit(self):
        scene = scenes.empty()
        scenes.camera(lens=50, shift_x=0.1, shift_y=0.2)
        found = self.exported(scene)["camera"]
        self.assertAlmostEqual(math.tan(math.radians(found["vfov"] / 2)), 36 * 72 / 96 / 100, places=6)
        # Shift counts in the longer side.
        numpy.testing.assert_allclose(found["shift"], [0.1, 0.2 * 96 / 72], rtol=1e-6)

    def test_aperture(self):
        scene = scenes.empty()
        made = scenes.camera(lens=50)
        made.data.dof.use_dof, made.data.dof.focus_distance, made.data.dof.aperture_fstop = True, 4, 2.0
        found = self.exported(scene)["camera"]
        self.assertAlmostEqual(found["aperture"]["radius"], 0.0125, places=7)
        self.assertAlmostEqual(found["focus_distance"], 4, places=6)

    def test_without_a_camera_it_says_so(self):
        with self.assertRaisesRegex(ValueError, "no camera"):
            export(scenes.empty(), self.path)


class Reports(Case):
    def test_what_cannot_be_said_is_listed(self):
        scene = scenes.empty()
        nodes = scenes.Nodes("Noisy")
        shader = nodes.node("BsdfDiffuse", Color=nodes.node("TexNoise").outputs["Color"])
        nodes.set(nodes.output.inputs["Volume"], nodes.node("VolumeScatter"))
        scenes.ball("Ball", nodes.show(shader), (0, 0, 1))
        scenes.lamp("AREA", 10, (0, 0, 3), spread=1.0)
        scenes.camera()
        scene.render.use_motion_blur = True
        scene.cycles.use_denoising = True
        self.exported(scene)
        self.says("material Noisy", "Noise Texture")
        self.says("material Noisy", "volume")
        self.says("lamp Area", "spread")
        self.says("render", "motion blur")
        self.says("render", "denoising")

    def test_nothing_is_listed_where_all_is_said(self):
        scenes.places()
        self.exported(bpy.context.scene)
        self.assertEqual([str(line) for line in self.report.lines], [])

    def test_lines_are_not_repeated(self):
        report = Report()
        report.add("a", "b", "c")
        report.add("a", "b", "c")
        self.assertEqual(str(report), "a: b; c")


class Objects(Case):
    def test_duplicates_share_a_mesh(self):
        scenes.places()
        found = self.exported(bpy.context.scene)
        counts = sorted(len(instance["places"]) for instance in found["instance"])
        # Both cubes three times, the cone four times, and sixteen balls or a ball for each point.
        self.assertEqual(counts[:3], [3, 3, 4])
        with open(self.path, encoding="utf-8") as file:
            self.assertNotIn("Hidden", file.read())

    def test_lamps_light_the_objects_that_they_are_linked_to(self):
        scenes.linked()
        found = self.exported(bpy.context.scene)
        self.assertEqual([str(line) for line in self.report.lines], [])
        # Two balls share a mesh, each with a receiver of its own; all else is `rest`.
        groups = [instance.get("receiver") for instance in found["instance"]]
        self.assertEqual(sorted(groups), ["linked_1", "linked_2"])
        self.assertEqual([shape.get("receiver") for shape in found["shape"] if shape["type"] == "mesh"], [None, None])
        lit = {tuple(material["lights_only"]) for material in found["material"] if "lights_only" in material}
        self.assertEqual(len(lit), 2)
        self.assertTrue(any(len(names) == 1 and names[0] != "rest" for names in lit), lit)
        self.assertTrue(any(len(names) == 2 and "rest" in names for names in lit), lit)
        # The control: without a collection nothing is said.
        for lamp in bpy.context.scene.objects:
            lamp.light_linking.receiver_collection = None
        found = self.exported(bpy.context.scene)
        self.assertFalse(any("lights_only" in material for material in found["material"]))
        self.assertFalse(any("receiver" in entry for entry in found["shape"] + found["instance"]))

    def test_an_object_hidden_from_the_camera_is_passed_by_it_alone(self):
        scene = scenes.empty()
        scenes.floor().visible_camera = False
        scenes.camera()
        found = self.exported(scene)
        self.assertEqual(next(entry for entry in found["material"] if entry["type"] == "blend")["weight"], {"type": "camera"})


class Files(Case):
    def test_numbers_and_texts_in_toml(self):
        for value in (0.1, 1e-30, -3.5e20, True, 'a "b"\n\\ ä', [1, 2.5], {"a": 1}):
            self.assertEqual(tomllib.loads(f"x = {toml(value)}")["x"], value)
        with self.assertRaises(ValueError):
            toml(math.nan)

    def test_exr_is_read_as_it_was_written(self):
        pixels = numpy.random.default_rng(1).normal(size=(37, 21, 4)).astype(numpy.float32)
        path = os.path.join(self.folder, "a.exr")
        write_exr(path, pixels)
        numpy.testing.assert_array_equal(compare.read(path).astype(numpy.float32), pixels[..., :3])

    def test_white_microfacets_keep_what_they_should(self):
        # What gpt reflects of a white world by a sphere of such a metal, over the sphere's disk.
        for roughness, share in ((0.4, 0.9405), (0.7, 0.7075), (1.0, 0.4092)):
            self.assertAlmostEqual(share_kept(roughness), share, delta=2e-3)
        self.assertGreater(abs(share_kept(0.42) - 0.9405), 2e-3)


class Programs(Case):
    def setUp(self):
        super().setUp()
        if shutil.which(compare.gpt()) is None:
            self.skipTest("the program gpt is not there: set GPT to its path")

    def test_the_script_exports_an_opened_file(self):
        scenes.trees()
        blend = os.path.join(self.folder, "trees.blend")
        bpy.ops.wm.save_as_mainfile(filepath=blend)
        done = subprocess.run([sys.executable, EXPORT, blend, self.path], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("is written", done.stdout)
        done = subprocess.run([compare.gpt(), "check", self.path, "--strict"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_script_says_what_it_needs(self):
        done = subprocess.run([sys.executable, EXPORT, "--", "out.png"], capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("OUT.toml", done.stderr)

    def test_the_button_renders_and_shows_the_picture(self):
        import gpt_blender

        scene = scenes.places()
        scene.cycles.samples = 16
        gpt_blender.register()
        self.addCleanup(gpt_blender.unregister)
        os.environ["GPT"] = compare.gpt()
        self.assertEqual(bpy.ops.render.gpt(), {"FINISHED"})
        image = bpy.data.images["gpt"]
        self.assertEqual(tuple(image.size), scenes.SIZE)
        pixels = numpy.array(image.pixels[:]).reshape(72, 96, 4)[::-1, :, :3]
        theirs = compare.by_cycles(scene, self.folder, runs=1, samples=16)[0]
        self.assertAlmostEqual(pixels.mean() / theirs.mean(), 1, delta=0.01)

    def test_the_button_says_where_the_program_is_missing(self):
        import gpt_blender

        scenes.places()
        gpt_blender.register()
        self.addCleanup(gpt_blender.unregister)
        before = os.environ.get("GPT")
        os.environ["GPT"] = "/nowhere/gpt"
        self.addCleanup(lambda: os.environ.__setitem__("GPT", before) if before else os.environ.pop("GPT"))
        with self.assertRaisesRegex(RuntimeError, "not found"):
            bpy.ops.render.gpt()


if __name__ == "__main__":
    unittest.main()
