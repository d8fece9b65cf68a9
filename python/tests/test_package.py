"""Tests of the Python package, run by scripts/python against the installed wheel."""

import ast
import base64
import contextlib
import inspect
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import types
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

import gpt_pathtracer as gpt
from gpt_pathtracer import referee
from gpt_pathtracer._display import Bar

ROOT = Path(__file__).resolve().parent.parent.parent
#: The program that the wheel brings.
PROGRAM = Path(sys.executable).parent / ("gpt.exe" if os.name == "nt" else "gpt")

SCENE = """
[film]
size = [24, 16]
[render]
spp = 8
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
vfov = 40
[[material]]
name = "clay"
type = "diffuse"
reflectance = [0.6, 0.3, 0.2]
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "clay"
[[light]]
type = "point"
position = [3, 4, 5]
intensity = [40, 30, 20]
"""


def device():
    return "cpu" if os.environ.get("GPT_TEST_GPU") == "skip" else "auto"


class Rendering(unittest.TestCase):
    def setUp(self):
        self.scene = gpt.Scene.from_toml(SCENE)

    def test_pixels_are_shared_and_cannot_be_written(self):
        picture = self.scene.render(device="cpu")
        pixels = picture.pixels
        self.assertEqual((pixels.shape, pixels.dtype), ((16, 24, 3), np.float32))
        self.assertTrue(pixels[8, 12, 0] > pixels[8, 12, 2] > 0)
        self.assertEqual(pixels[0, 0].tolist(), [0, 0, 0])
        address = pixels.__array_interface__["data"][0]
        self.assertEqual(np.asarray(picture).__array_interface__["data"][0], address)
        self.assertFalse(pixels.flags.owndata or pixels.flags.writeable)
        copy = np.array(picture)
        self.assertNotEqual(copy.__array_interface__["data"][0], address)
        kept = copy.tolist()
        del picture
        other = [self.scene.render(device="cpu", seed=seed) for seed in range(3)]
        self.assertEqual(pixels.tolist(), kept, "the view keeps its memory")
        self.assertNotEqual(other[1].pixels.tolist(), kept)

    def test_stats_say_what_was_done(self):
        stats = self.scene.render(spp=4, size=(10, 6), device="cpu").stats
        self.assertEqual((stats["width"], stats["height"], stats["spp"], stats["samples"]), (10, 6, 4, 240))
        self.assertEqual((stats["device"], stats["stopped_by"]), ("CPU reference", "samples"))
        self.assertGreaterEqual(stats["rays"], 240)
        self.assertEqual((stats["spp_done"], len(stats["mean"]), stats["notice"]), (4, 3, None))

    def test_stats_are_those_of_the_program(self):
        """The same keys, and the same numbers where both render the same."""
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder, "ball.toml")
            scene.write_text(SCENE)
            arguments = ["render", scene, "--device", "cpu", "-q", "-o", Path(folder, "ball.exr"), "--stats", "-"]
            of_program = json.loads(subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True).stdout)
            ours = gpt.Scene.load(scene).render(device="cpu").stats
        self.assertEqual(ours.keys(), of_program.keys())
        for key in ("scene", "scene_hash", "spp", "spp_done", "samples", "rays", "stopped_by", "sampler", "filter", "version"):
            self.assertEqual(ours[key], of_program[key], key)
        np.testing.assert_allclose(ours["mean"], of_program["mean"], rtol=1e-6)

    def test_layers_come_by_their_names(self):
        layers = self.scene.render(device=device(), layers=["normal", "depth", "albedo", "ids"]).layers
        self.assertEqual(sorted(layers), ["Albedo", "MaterialId", "N", "ObjectId", "Z"])
        self.assertEqual((layers["N"].shape, layers["Z"].shape), ((16, 24, 3), (16, 24)))
        self.assertAlmostEqual(float(np.linalg.norm(layers["N"][8, 12])), 1, delta=0.05)
        self.assertAlmostEqual(float(layers["Z"][8, 12]), 3, delta=0.05)
        self.assertEqual(layers["ObjectId"].dtype, np.uint32)
        self.assertEqual((layers["ObjectId"][8, 12], layers["MaterialId"][0, 0]), (1, 0))
        self.assertFalse(layers["N"].flags.owndata or layers["N"].flags.writeable)
        self.assertEqual(self.scene.render(device="cpu").layers, {})

    def test_noise_is_measured(self):
        layers = self.scene.render(spp=16, device="cpu", layers=["variance", "samples", "cryptomatte"]).layers
        self.assertEqual((layers["SampleCount"] == 16).all(), True)
        self.assertEqual(layers["Variance"].shape, (16, 24, 3))
        # At the ball's edge a sample is one thing or the other; beside it nothing is met.
        self.assertGreater(layers["Variance"].max(), 1e-3)
        self.assertEqual(layers["Variance"][0, 0].tolist(), [0, 0, 0])
        self.assertEqual(layers["CryptoObject00"].shape, (16, 24, 4))

    def test_goals(self):
        limited = self.scene.render(spp=10_000_000, time_limit=0.5, device="cpu").stats
        self.assertEqual(limited["stopped_by"], "time_limit")
        reached = self.scene.render(spp=100_000, target_error=0.01, device="cpu").stats
        self.assertEqual(reached["stopped_by"], "target_error")
        known = self.scene.render(spp=100_000, target_interval=0.05, confidence=0.95, layers=["low", "high"], device="cpu")
        self.assertEqual(known.stats["stopped_by"], "target_interval")
        self.assertLessEqual(known.stats["interval"]["widest"], 0.05)
        self.assertTrue((known.layers["Low"] <= known.pixels).all() and (known.pixels <= known.layers["High"]).all())
        self.assertLessEqual(reached["error_bound"], 0.01)

    def test_both_devices_agree(self):
        if device() == "cpu":
            self.skipTest("without a GPU")
        verdict = gpt.verify(self.scene, size=(24, 16), spp=4)
        self.assertTrue(verdict and verdict.agrees, verdict.missed)
        self.assertEqual(verdict.details["paths"], 24 * 16 * 4)

    def test_progress_is_told_and_may_end_it(self):
        told = []
        self.scene.render(spp=200, device="cpu", progress=lambda done, total: told.append((done, total)))
        self.assertEqual(told[-1], (200 * 24 * 16, 200 * 24 * 16))
        self.assertTrue(all(0 <= done <= total for done, total in told), told)
        self.assertEqual(told, sorted(told))

        def enough(done, total):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            self.scene.render(spp=100_000_000, device="cpu", progress=enough)

    def test_other_threads_run_meanwhile(self):
        done = threading.Event()
        render = threading.Thread(target=lambda: (self.scene.render(spp=10_000_000, time_limit=0.5, device="cpu"), done.set()))
        render.start()
        counted = 0
        while not done.is_set():
            counted += 1
            time.sleep(0.001)
        render.join()
        self.assertGreater(counted, 3)

    @unittest.skipIf(os.name == "nt", "signals of Unix")
    def test_ctrl_c_ends_it(self):
        self.interrupt("gpt.Scene.from_toml(sys.stdin.read()).render(spp=1_000_000_000, device='cpu')")

    @unittest.skipIf(os.name == "nt", "signals of Unix")
    def test_ctrl_c_ends_pictures_on_the_way(self):
        self.interrupt("list(gpt.Scene.from_toml(sys.stdin.read()).render_progressively(spp=1_000_000_000, seconds=1e6, device='cpu'))")

    @unittest.skipIf(os.name == "nt" or device() == "cpu", "signals of Unix, and a device to verify")
    def test_ctrl_c_ends_verification(self):
        self.interrupt("gpt.verify(gpt.Scene.from_toml(sys.stdin.read()), size=(400, 400), spp=1_000_000)")

    def interrupt(self, call):
        """Sends Ctrl-C while `call` is at work in a program of its own."""
        code = "import sys, gpt_pathtracer as gpt\nprint('ready', flush=True)\n"
        code += f"try:\n  {call}\nexcept KeyboardInterrupt:\n  print('interrupted', flush=True)\n"
        # Who runs these tests in the background may have told them to ignore Ctrl-C.
        heeds = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)  # noqa: E731
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        child = subprocess.Popen([sys.executable, "-c", code], text=True, preexec_fn=heeds, **pipes)
        child.stdin.write(SCENE)
        child.stdin.close()
        self.assertEqual(child.stdout.readline().strip(), "ready")
        time.sleep(2)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.stdout.readline().strip(), "interrupted")
        self.assertEqual(child.wait(60), 0)
        child.stdout.close()


class Settings(unittest.TestCase):
    def setUp(self):
        self.scene = gpt.Scene.from_toml(SCENE)

    def test_every_setting_has_a_name_and_is_what_the_program_takes(self):
        """Each is set to its default by its name, and the program's flag does what the keyword does."""
        known = gpt.settings()
        self.assertGreater(len(known), 20)
        picture = self.scene.render(spp=2, device="cpu")
        for setting in known:
            keywords = {"spp": 2, setting.name: 2 if setting.name == "spp" else setting.default}
            same = self.scene.render(device="cpu", **keywords)
            self.assertEqual(same.pixels.tobytes(), picture.pixels.tobytes(), setting.name)
            self.assertTrue(setting.help and setting.values, setting)
        other = self.scene.render(spp=2, device="cpu", max_depth=1, sampler="independent", guiding=False)
        self.assertEqual((other.stats["max_depth"], other.stats["sampler"], other.stats["guiding"]), (1, "independent", "off"))
        self.assertNotEqual(other.pixels.tobytes(), picture.pixels.tobytes())
        with tempfile.TemporaryDirectory() as folder:
            path, file = Path(folder, "ball.exr"), Path(folder, "ball.toml")
            file.write_text(SCENE)
            subprocess.run([PROGRAM, "render", file, "--device", "cpu", "-q", "--spp", "2", "--max-depth", "1", "--sampler", "independent", "-o", path], check=True)
            self.assertEqual(gpt.Picture.open(path).pixels.tobytes(), other.pixels.tobytes())

    def test_wrong_ones_are_exceptions(self):
        with self.assertRaisesRegex(TypeError, "max_depht.*did you mean 'max_depth'"):
            self.scene.render(max_depht=3)
        with self.assertRaisesRegex(ValueError, "sampler: expected .*sobol.*not `dice`"):
            self.scene.render(sampler="dice")
        for name, value in (("max_depth", -1), ("spp", -1), ("spp", 2.5), ("seed", -1)):
            with self.assertRaisesRegex(ValueError, f"{name}: expected"):
                self.scene.render(**{name: value})
        with self.assertRaisesRegex(TypeError, "progress"):
            self.scene.render(progress="yes")

    def test_parts_add_up(self):
        first = self.scene.render(spp=4, device="cpu").pixels
        second = self.scene.render(spp=4, device="cpu", first_sample=4).pixels
        np.testing.assert_allclose((first + second) / 2, self.scene.render(spp=8, device="cpu").pixels, rtol=1e-5, atol=1e-6)
        part = self.scene.render(spp=4, device="cpu", crop=(8, 4, 6, 5)).pixels
        np.testing.assert_array_equal(part, first[4:9, 8:14])
        with self.assertRaises(ValueError):
            self.scene.render(crop=(20, 0, 6, 5))

    def test_frames(self):
        moving = SCENE.replace("intensity = [40, 30, 20]", "intensity = [40, 30, 20]\nkeyframes = [{ frame = 0, intensity = [0, 0, 0] }, { frame = 10, intensity = [40, 30, 20] }]")
        scene = gpt.Scene.from_toml(moving)
        light = [float(scene.at_frame(frame).render(device="cpu").pixels.sum()) for frame in (0, 5, 10)]
        self.assertEqual(light[0], 0)
        with self.assertRaisesRegex(gpt.SceneError, "a frame is a finite number"):
            scene.at_frame(float("nan"))
        self.assertAlmostEqual(light[1] / light[2], 0.5, delta=1e-4)

    def test_a_bar(self):
        lines = io.StringIO()
        bar = Bar(lines)
        bar(1, 4)
        bar(4, 4)
        bar.close()
        self.assertIn("\r 25% [#######.......................]", lines.getvalue())
        self.assertTrue(lines.getvalue().endswith("\n"))
        self.assertNotIn("IPython", sys.modules)
        with contextlib.redirect_stderr(io.StringIO()) as said:
            self.scene.render(spp=4, device="cpu", progress=True)
        self.assertIn("100% [##############################]", said.getvalue())


class Written(unittest.TestCase):
    """Scenes as text, as dictionaries and as files again."""

    def same(self, scene, again, **keywords):
        ours, theirs = (each.render(spp=2, device="cpu", **keywords).pixels for each in (scene, again))
        self.assertGreater(ours.sum(), 0)
        self.assertEqual(ours.tobytes(), theirs.tobytes())

    def test_text_and_dictionaries_give_the_same_picture(self):
        for scene in (gpt.Scene.from_toml(SCENE), gpt.Scene.load("cornell"), gpt.Scene.load("teapot-plastic")):
            small = {"size": (24, 16)}
            self.same(scene, gpt.Scene.from_dict(scene.to_dict()), **small)
            if scene.name != "teapot-plastic":
                self.same(scene, gpt.Scene.from_toml(scene.to_toml()), **small)
        # The control: what the dictionary says counts.
        changed = gpt.Scene.from_toml(SCENE).to_dict()
        changed["material"][0]["reflectance"] = [0.6, 0.3, 0.25]
        with self.assertRaises(AssertionError):
            self.same(gpt.Scene.from_toml(SCENE), gpt.Scene.from_dict(changed))

    def test_arrays_come_back(self):
        """Files of arrays are gone once they are read: the scene has them in memory."""
        side, random = 40, np.random.default_rng(1)
        grid = np.stack(np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side)), axis=-1).reshape(-1, 2)
        positions = np.column_stack([grid, 0.1 * random.random(side * side)])
        corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1, 1)
        faces = np.concatenate([corner + [0, 1, side], corner + [1, side + 1, side]])
        mesh = {"type": "mesh", "positions": positions, "faces": faces, "uvs": grid, "material": "clay"}
        scene = gpt.Scene.from_dict(
            {
                **gpt.Scene.from_toml(SCENE).to_dict(),
                "texture": [{"name": "paint", "type": "image", "file": random.random((8, 8, 3))}],
                "material": [{"name": "clay", "type": "diffuse", "reflectance": {"texture": "paint"}}],
                "shape": [mesh],
            }
        )
        description = scene.to_dict()
        shape, texture = description["shape"][0], description["texture"][0]
        np.testing.assert_array_equal(shape["positions"], positions.astype(np.float32))
        np.testing.assert_array_equal(shape["faces"], faces)
        self.assertIsInstance(texture["file"], gpt.FileContent)
        self.same(scene, gpt.Scene.from_dict(description))
        with self.assertRaisesRegex(gpt.SceneError, "2 of the scene's meshes, pictures and lists came from no file"):
            scene.to_toml()
        with tempfile.TemporaryDirectory() as folder:
            written = scene.save(Path(folder, "again.toml"))
            self.assertEqual([path.suffix for path in written], [".exr", ".ply", ".toml"])
            again = gpt.Scene.load(written[-1])
            self.same(scene, again)
            # Its files are there now, and named from wherever the text is to lie.
            self.same(scene, gpt.Scene.from_toml(again.to_toml(folder=folder), folder=folder))
            self.assertIn('file = "again.files/', again.to_toml(folder=folder))
            with self.assertRaises(OSError):
                again.save(written[-1])
            with self.assertRaisesRegex(ValueError, "ends in .toml"):
                scene.save(Path(folder, "again.txt"))

    def test_it_is_what_the_program_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            file, by_program = Path(folder, "ball.toml"), Path(folder, "saved.toml")
            file.write_text(SCENE)
            subprocess.run([PROGRAM, "render", file, "--device", "cpu", "-q", "-o", Path(folder, "ball.exr"), "--save-scene", by_program], check=True)
            ours = gpt.Scene.load(file)
            self.assertEqual(ours.to_toml(folder=folder), by_program.read_text())
            ours.save(Path(folder, "ours.toml"))
            self.assertEqual(Path(folder, "ours.toml").read_bytes(), by_program.read_bytes())


class Regrouping(unittest.TestCase):
    TWO = SCENE.replace("intensity = [40, 30, 20]", 'intensity = [40, 30, 20]\nlight_group = "key"') + """
[[light]]
type = "point"
position = [-3, 1, 5]
intensity = 10
light_group = "fill"
[[light]]
type = "directional"
direction = [0, -1, 0]
irradiance = 0.2
"""

    def test_groups_are_weighed(self):
        scene = gpt.Scene.from_toml(self.TWO)
        picture = scene.render(device="cpu", layers=["groups", "depth", "ids", "variance"])
        self.assertEqual(sorted(picture.light_groups), ["fill", "key", "rest"])
        same = gpt.regroup(picture, {})
        np.testing.assert_allclose(same.pixels, picture.pixels, rtol=1e-5, atol=1e-6)
        other = gpt.regroup(picture, {"key": 2, "fill": (0.5, "#ff00ff")})
        expected = 2.0 * picture.layers["key"] + [0.5, 0, 0.5] * picture.layers["fill"] + picture.layers["rest"]
        np.testing.assert_allclose(other.pixels, expected, rtol=1e-5, atol=1e-6)
        self.assertEqual(sorted(other.layers), ["MaterialId", "ObjectId", "Z", "fill", "key", "rest"])
        np.testing.assert_array_equal(other.layers["ObjectId"], picture.layers["ObjectId"])
        self.assertEqual((other.stats["left_out"], other.stats["regrouped"]["key"]), (["variance"], [2, 2, 2]))
        back = gpt.regroup(other, {"key": 0.5, "fill": 0})
        np.testing.assert_allclose(back.pixels, picture.layers["key"] + picture.layers["rest"], rtol=1e-5, atol=1e-6)
        # The control: other weights are another picture.
        self.assertGreater(np.abs(other.pixels - picture.pixels).max(), 0.01)

    def test_it_is_what_the_program_does(self):
        with tempfile.TemporaryDirectory() as folder:
            file, whole, by_program = Path(folder, "two.toml"), Path(folder, "two.exr"), Path(folder, "other.exr")
            file.write_text(self.TWO)
            subprocess.run([PROGRAM, "render", file, "--device", "cpu", "-q", "-o", whole, "--aov", "groups"], check=True)
            subprocess.run([PROGRAM, "regroup", whole, "-g", "key=2,#ffddaa", "-o", by_program], check=True)
            expected = gpt.Picture.open(by_program).pixels
            of_file = gpt.regroup(whole, {"key": (2, "#ffddaa")})
            self.assertEqual(of_file.pixels.tobytes(), expected.tobytes())
            self.assertEqual(of_file.light_groups, ("key", "fill", "rest"))
            in_memory = gpt.regroup(gpt.Scene.load(file).render(device="cpu", layers="groups"), {"key": (2, "#ffddaa")})
            self.assertEqual(in_memory.pixels.tobytes(), expected.tobytes())

    def test_layers_are_saved_as_the_program_saves_them(self):
        names = "normal,depth,alpha,variance,samples,ids,cryptomatte,groups"
        with tempfile.TemporaryDirectory() as folder:
            file, by_program, ours, plain = (Path(folder, name) for name in ("two.toml", "program.exr", "ours.exr", "plain.exr"))
            file.write_text(self.TWO)
            subprocess.run([PROGRAM, "render", file, "--device", "cpu", "-q", "-o", by_program, "--aov", names], check=True)
            scene = gpt.Scene.load(file)
            picture = scene.render(device="cpu", layers=names.split(","))
            picture.save(ours)
            self.assertEqual(ours.read_bytes(), by_program.read_bytes())
            again = gpt.Scene.load(file).render(spp=32, device="cpu", layers=["uv", "direct", "object_position"])
            again.save(ours)
            arguments = [PROGRAM, "render", file, "--spp", "32", "--device", "cpu", "-q", "-o", by_program, "--aov", "uv,direct,object_position"]
            subprocess.run(arguments, check=True)
            self.assertEqual(ours.read_bytes(), by_program.read_bytes())
            # Intervals are in layers and in the header.
            intervals = {"target_interval": 0.3, "confidence": 0.95, "interval_of": "pixels", "interval_by": "seen"}
            scene.render(spp=64, device="cpu", layers=["low", "high", "samples"], **intervals).save(ours)
            options = [argument for name, value in intervals.items() for argument in (f"--{name.replace('_', '-')}", str(value))]
            subprocess.run([PROGRAM, "render", file, "--spp", "64", "--device", "cpu", "-q", "-o", by_program, "--aov", "low,high,samples", *options], check=False)
            self.assertEqual(ours.read_bytes(), by_program.read_bytes())
            self.assertIn(b"gpt:pictureLow", ours.read_bytes())
            # The control: without its layers it is another file.
            scene.render(device="cpu").save(plain)
            self.assertNotEqual(plain.read_bytes(), by_program.read_bytes())
            # A picture that was regrouped keeps its groups in its file.
            gpt.regroup(picture, {"key": 2}).save(ours)
            self.assertEqual(gpt.regroup(ours, {"key": 0.5}).light_groups, picture.light_groups)
            np.testing.assert_allclose(gpt.regroup(ours, {"key": 0.5}).pixels, picture.pixels, rtol=1e-5, atol=1e-6)
            picture.save(Path(folder, "preview.png"))

    def test_wrong_weights_are_exceptions(self):
        picture = gpt.Scene.from_toml(self.TWO).render(device="cpu", spp=1, layers=["groups"])
        for weights, words in (({"kye": 1}, "no light group"), ({"key": -1}, "no factor"), ({"key": "red"}, "no factor"), ({"key": (1, 2)}, "one factor")):
            with self.assertRaisesRegex(ValueError, words):
                gpt.regroup(picture, weights)
        with self.assertRaisesRegex(ValueError, "no light groups"):
            gpt.regroup(gpt.Scene.from_toml(self.TWO).render(device="cpu", spp=1), {"key": 1})
        with self.assertRaises(OSError):
            gpt.regroup("missing.exr", {"key": 1})


class Sequences(unittest.TestCase):
    MOVING = SCENE.replace("intensity = [40, 30, 20]", "intensity = [40, 30, 20]\nkeyframes = [{ frame = 0, position = [3, 4, 5] }, { frame = 10, position = [-3, 4, 5] }]")

    def test_frames_are_those_of_the_program(self):
        scene = gpt.Scene.from_toml(self.MOVING)
        pictures = list(scene.render_frames("1,4-8x2", device="cpu", layers=["depth"]))
        self.assertEqual([picture.stats["frame"] for picture in pictures], [1, 4, 6, 8])
        self.assertEqual(len({picture.pixels.tobytes() for picture in pictures}), 4, "they differ")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "ball.toml")
            file.write_text(self.MOVING)
            subprocess.run([PROGRAM, "render", file, "--device", "cpu", "-q", "--frames", "1,4-8x2", "-o", Path(folder, "f.#.exr")], check=True)
            for frame, picture in zip((1, 4, 6, 8), pictures):
                self.assertEqual(gpt.Picture.open(Path(folder, f"f.{frame}.exr")).pixels.tobytes(), picture.pixels.tobytes(), frame)
        between = next(scene.render_frames([2.5], device="cpu"))
        self.assertEqual(between.pixels.tobytes(), scene.at_frame(2.5).render(device="cpu").pixels.tobytes())
        self.assertEqual(list(scene.render_frames([], device="cpu")), [])

    def test_mistakes_are_exceptions(self):
        scene = gpt.Scene.from_toml(self.MOVING)
        with self.assertRaisesRegex(ValueError, "ends before it begins"):
            scene.render_frames("5-1")
        # All of them are raised by the call, before anything is rendered.
        for name, near in (("max_depht", "max_depth"), ("layer", "layers"), ("devise", "device"), ("progres", "progress"), ("traget_error", "target_error")):
            with self.assertRaisesRegex(TypeError, rf"render_frames\(\) has no keyword '{name}'; did you mean '{near}'\?"):
                scene.render_frames("1", **{name: 1})
        with self.assertRaisesRegex(TypeError, r"render_progressively\(\).*'secnods'; did you mean 'seconds'"):
            scene.render_progressively(secnods=1)
        with self.assertRaisesRegex(TypeError, r"render\(\).*'liev'; did you mean 'live'"):
            scene.render(liev=True)
        with self.assertRaisesRegex(TypeError, r"'flavour'; help\(Scene.render\)"):
            scene.render(flavour="mint")
        with self.assertRaisesRegex(ValueError, "sampler: expected"):
            scene.render_frames("1", sampler="dice")
        with self.assertRaisesRegex(ValueError, "target_error is a number above 0"):
            scene.render_frames("1", spp=64, target_error=-1)
        with self.assertRaisesRegex(TypeError, "progress"):
            scene.render_frames("1", progress="yes")
        with self.assertRaisesRegex(ValueError, "seconds"):
            scene.render_progressively(seconds=-1)
        with self.assertRaisesRegex(ValueError, "no keyframes"):
            gpt.Scene.from_toml(SCENE).render_frames("1", device="cpu")
        with self.assertRaisesRegex(gpt.SceneError, "a frame is a finite number"):
            scene.render_frames([1, float("nan")], device="cpu")

    def test_who_leaves_early_ends_it(self):
        scene = gpt.Scene.from_toml(self.MOVING)
        start = time.monotonic()
        for _ in scene.render_frames(range(1, 1000), device="cpu"):
            break
        for _ in scene.render_progressively(spp=100_000_000, seconds=0, device="cpu"):
            break
        self.assertLess(time.monotonic() - start, 60)

    def test_pictures_get_better(self):
        scene = gpt.Scene.from_toml(SCENE)
        truth = scene.render(spp=4096, device="cpu", seed=7).pixels
        pictures = list(scene.render_progressively(spp=2000, seconds=0, device="cpu", layers=["depth"]))
        counts = [picture.stats["spp_done"] for picture in pictures]
        self.assertGreater(len(pictures), 2)
        self.assertEqual((counts, counts[-1]), (sorted(counts), 2000))
        errors = [gpt.compare(picture, truth).mse for picture in (pictures[0], pictures[-1])]
        self.assertLess(errors[1], 0.5 * errors[0])
        last = scene.render(spp=2000, device="cpu", layers=["depth"])
        self.assertEqual(pictures[-1].pixels.tobytes(), last.pixels.tobytes())
        self.assertEqual(pictures[-1].layers["Z"].tobytes(), last.layers["Z"].tobytes())
        self.assertEqual((pictures[0].layers, pictures[0].stats["stopped_by"], pictures[-1].stats["stopped_by"]), ({}, None, "samples"))
        # The control: a look on the way is not the last picture.
        self.assertNotEqual(pictures[0].pixels.tobytes(), last.pixels.tobytes())

    def test_progress_is_told_and_may_end_it(self):
        told = []
        list(gpt.Scene.from_toml(self.MOVING).render_frames([1, 2], device="cpu", progress=lambda done, total: told.append((done, total))))
        self.assertEqual(told[-1], (8 * 24 * 16, 8 * 24 * 16))

        def enough(done, total):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            list(gpt.Scene.from_toml(SCENE).render_progressively(spp=100_000_000, seconds=1e6, device="cpu", progress=enough))

    def test_a_notebook_shows_a_live_picture(self):
        shown, ids = [], []

        class Handle:
            def update(self, value, raw=False):
                shown.append(value)

        class Shell:
            kernel = object()

        def display(value, raw=False, display_id=False):
            ids.append(display_id)
            return Handle()

        ipython, of_display = types.ModuleType("IPython"), types.ModuleType("IPython.display")
        ipython.get_ipython, of_display.display = Shell, display
        scene = gpt.Scene.from_toml(SCENE)
        with unittest.mock.patch.dict(sys.modules, {"IPython": ipython, "IPython.display": of_display}):
            picture = scene.render(spp=2000, device="cpu", live=True)
        self.assertEqual(ids, [True], "one output, which is written anew")
        self.assertTrue(all(isinstance(value, gpt.Picture) and value._repr_png_()[:4] == b"\x89PNG" for value in shown), shown)
        self.assertIs(shown[-1], picture)
        self.assertEqual(picture.pixels.tobytes(), scene.render(spp=2000, device="cpu").pixels.tobytes())
        # The control: without a notebook there is a bar.
        with contextlib.redirect_stderr(io.StringIO()) as said:
            scene.render(spp=4, device="cpu", live=True)
        self.assertIn("100% [", said.getvalue())
        self.assertEqual(len(ids), 1)


class Referee(unittest.TestCase):
    def test_tests_are_those_of_the_program(self):
        listed = json.loads(subprocess.run([PROGRAM, "referee", "list", "--json"], capture_output=True, text=True, check=True).stdout)
        ours = [{"name": test.name, "about": test.about, "decides": test.decides, "mistakes": list(test.mistakes)} for test in referee.tests()]
        self.assertEqual(ours, listed)
        self.assertEqual([test.name for test in referee.tests("lights/point", "lights/sphere")], ["lights/point", "lights/sphere"])
        self.assertTrue(all(test.family == "lights" for test in referee.tests("lights")))
        with self.assertRaisesRegex(ValueError, "no test and no family 'lihgts'"):
            referee.tests("lihgts")

    def test_truths_are_arrays(self):
        point, room = referee.tests("lights/point", "transport/room")
        truth = point.truth()
        self.assertEqual((truth.mean.shape, truth.mean.dtype), ((*reversed(point.size), 3), np.float32))
        self.assertEqual((point.is_formula, float(truth.standard_error.max())), (True, 0))
        # The light stands above (0.4, 0.3); the plane's reflectance is 1/2.
        x, y = (np.arange(64) + 0.5) / 32 - 1, 1 - (np.arange(64) + 0.5) / 32
        square = (x[None, :] - 0.4) ** 2 + (y[:, None] - 0.3) ** 2 + 1
        np.testing.assert_allclose(truth.mean[..., 0], 1.5 / np.pi / square**1.5, rtol=1e-3)
        self.assertFalse(room.is_formula)
        self.assertGreater(room.truth().standard_error.max(), 0)

    def test_right_and_wrong_pictures(self):
        (test,) = referee.tests("lights/point")
        right = {seed: test.scene().render(64, seed=seed, device="cpu").pixels for seed in (1, 2)}
        outcome = test.judge(right)
        self.assertTrue(outcome and outcome.verdict == "agrees" and outcome.cause is None, outcome)
        self.assertLess(outcome.would_find, 0.02)
        # The controls: five per cent too much, and mistakes that have names.
        bright = test.judge({seed: pixels * np.float32(1.05) for seed, pixels in right.items()})
        self.assertFalse(bright)
        self.assertEqual((bright.verdict, bright.cause), ("differs", "everything times 1.0500"))
        self.assertTrue(0.04 < bright.off_by_at_least < 0.06 and "off by at least" in bright.sentence, bright)
        self.assertEqual(test.judge([pixels * np.float32(1 / (4 * np.pi)) for pixels in right.values()]).cause, test.mistakes[0])
        self.assertEqual(test.judge([pixels[:, ::-1] for pixels in right.values()]).cause, "a picture whose left is its right")
        failed = test.judge([np.full_like(right[1], np.nan)])
        self.assertEqual((failed.verdict, bool(failed)), ("failed", False))
        self.assertIn("not finite", failed.sentence)
        with self.assertRaises(ValueError):
            test.judge([])
        with self.assertRaises(ValueError):
            test.judge([right[1], right[2][:32]])
        with self.assertRaises(ValueError):
            test.judge(right, false_alarms=1.5)

    def test_renderers_are_asked(self):
        def mine(test, spp, seed):
            if test.name == "lights/sphere":
                raise referee.NotSupported("there are no area lights")
            return test.scene().render(spp, seed=seed, device="cpu")

        outcomes = referee.run(mine, "lights/point", "lights/sphere", "textures/srgb", "transport/room", spp=32)
        self.assertEqual([outcome.verdict for outcome in outcomes], ["agrees", "not supported", "agrees", "agrees"])
        self.assertTrue(all(outcomes))
        self.assertEqual(str(outcomes[1]), "lights/sphere: not supported: there are no area lights")
        dark = referee.run(lambda test, spp, seed: mine(test, spp, seed).pixels * 0.95, "lights/point", spp=32)
        self.assertEqual([outcome.verdict for outcome in dark], ["differs"])

    def test_verdicts_are_those_of_the_program(self):
        (test,) = referee.tests("lights/disk")
        with tempfile.TemporaryDirectory() as folder:
            pictures = {}
            for seed, suffix in ((1, ""), (2, "-2")):
                picture = test.scene().render(16, seed=seed, device="cpu").pixels * np.float32(1.05)
                pictures[seed] = Path(folder, f"lights-disk{suffix}.exr")
                rows, columns, _ = picture.shape
                gpt.Picture(gpt._native.Picture.from_bytes(columns, rows, picture.tobytes()), {}, {}).save(pictures[seed])
            said = subprocess.run([PROGRAM, "referee", "run", "lights/disk", "--pictures", folder, "--json", "-q"], capture_output=True, text=True)
            theirs = json.loads(said.stdout)["tests"][0]
            ours = referee.judge({"lights/disk": pictures})[0].details
        del ours["difference"]["sentence"]
        for key, value in ours.items():
            self.assertEqual(json.dumps(value), json.dumps(theirs[key]), key)


class Measuring(unittest.TestCase):
    METERS = """
[camera]
position = [0, 1, 4]
look_at = [0, 0, 0]
vfov = 40
[[meter]]
name = "below"
type = "irradiance"
position = [0, 0, 0]
normal = [0, 1, 0]
[[meter]]
name = "turned"
type = "irradiance"
position = [0, 0, 0]
normal = [0.866025403784, 0.5, 0]
[[light]]
type = "point"
position = [0, 2, 0]
intensity = [8, 4, 2]
"""

    def test_meters_are_read(self):
        """A lamp of intensity I at the distance 2 gives I/4, and half of that on what is turned by 60 degrees."""
        scene = gpt.Scene.from_toml(self.METERS)
        below, turned = gpt.measure(scene, device="cpu")
        self.assertEqual((below.name, below.photometric_unit), ("below", "lx"))
        # A meter stands a few millionths of the scene's size above its place.
        np.testing.assert_allclose(below.value, [2, 1, 0.5], rtol=1e-4)
        np.testing.assert_allclose(turned.value, [1, 0.5, 0.25], rtol=1e-4)
        self.assertTrue(all(low <= value <= high for low, value, high in zip(below.low, below.value, below.high)))
        self.assertEqual([each.name for each in gpt.measure(scene, "turned", device="cpu")], ["turned"])
        for wrong in ({"meters": ["left"]}, {"interval_by": "luck"}, {"target_interval": -1.0}):
            with self.assertRaises(ValueError, msg=str(wrong)):
                gpt.measure(scene, device="cpu", **wrong)
        with self.assertRaisesRegex(ValueError, "no meter"):
            gpt.measure(gpt.Scene.from_toml(SCENE), device="cpu")


class Descriptions(unittest.TestCase):
    """Scenes of dictionaries and arrays."""

    def described(self, **more):
        return {
            "film": {"size": (24, 16)},
            "render": {"spp": np.int64(8)},
            "camera": {"position": np.array([0.0, 0, 4]), "look_at": [0, 0, 0], "vfov": 40},
            "material": [{"name": "clay", "type": "diffuse", "reflectance": [0.6, 0.3, 0.2]}],
            "shape": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "clay"}],
            "light": [{"type": "point", "position": [3, 4, 5], "intensity": [40, 30, 20]}],
            **more,
        }

    def test_a_dictionary_is_a_scene_file(self):
        ours = gpt.Scene.from_dict(self.described()).render(device="cpu").pixels
        self.assertEqual(ours.tobytes(), gpt.Scene.from_toml(SCENE).render(device="cpu").pixels.tobytes())
        darker = self.described(material=[{"name": "clay", "type": "diffuse", "reflectance": [0.3, 0.15, 0.1]}])
        self.assertLess(gpt.Scene.from_dict(darker).render(device="cpu").pixels.sum(), 0.6 * ours.sum())

    def test_arrays_are_meshes(self):
        corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
        written = {"type": "mesh", "positions": corners, "faces": [[0, 1, 2], [0, 2, 3]], "uvs": [[0, 0], [1, 0], [1, 1], [0, 1]], "material": "clay"}
        arrays = {key: np.array(value) if isinstance(value, list) else value for key, value in written.items()}
        pictures = [gpt.Scene.from_dict(self.described(shape=[shape])).render(device="cpu").pixels for shape in (written, arrays)]
        self.assertGreater(pictures[0].sum(), 0)
        self.assertEqual(pictures[0].tobytes(), pictures[1].tobytes())
        turned = {**arrays, "normals": np.tile(np.array([[0.0, 0.6, 0.8]]), (4, 1))}
        self.assertNotEqual(gpt.Scene.from_dict(self.described(shape=[turned])).render(device="cpu").pixels.tobytes(), pictures[0].tobytes())
        for wrong, words in (
            ({"faces": np.array([[0, 1, 4]])}, r"shape\[0\].faces: an index lies outside the 4 positions"),
            ({"faces": np.array([[0.0, 1, 2]])}, r"shape\[0\].faces: expected whole numbers"),
            ({"positions": np.full((4, 3), np.nan)}, r"shape\[0\].positions: .*not finite"),
            ({"uvs": np.zeros((3, 2))}, r"shape\[0\].uvs: 3 of them, for 4 positions"),
            ({"uvs": np.zeros((4, 3))}, r"shape\[0\].uvs: expected the shape"),
            ({"positions": np.full((4, 3), 1e300)}, r"shape\[0\].positions: .*not finite"),
            ({"positions": np.ones((4, 3), bool)}, r"shape\[0\].positions: expected numbers, not bool"),
            ({"positions": np.ones((4, 3), complex)}, r"shape\[0\].positions: expected numbers, not complex"),
            ({"faces": [[0, 1], [0, 1, 2]]}, r"shape\[0\].faces: expected whole numbers"),
            ({"file": "other.obj"}, r"shape\[0\]: a mesh has either `file` or arrays"),
        ):
            with self.assertRaisesRegex(gpt.SceneError, words):
                gpt.Scene.from_dict(self.described(shape=[{**arrays, **wrong}]))
        bare = {key: value for key, value in arrays.items() if key != "material"}
        with self.assertRaisesRegex(gpt.SceneError, "`material` is missing"):
            gpt.Scene.from_dict(self.described(shape=[bare]))
        second = {**arrays, "second_uvs": arrays["uvs"]}
        self.assertEqual(gpt.Scene.from_dict(self.described(shape=[second])).render(device="cpu").pixels.tobytes(), pictures[0].tobytes())

    def test_arrays_are_textures(self):
        def mean(pixels, **more):
            textured = self.described(
                texture=[{"name": "paint", "type": "image", "file": pixels, **more}],
                material=[{"name": "clay", "type": "diffuse", "reflectance": {"texture": "paint"}}],
            )
            return gpt.Scene.from_dict(textured).render(device="cpu").pixels.sum(axis=(0, 1))

        plain = mean(np.full((4, 4, 3), [0.6, 0.3, 0.2]))
        np.testing.assert_allclose(plain, gpt.Scene.from_toml(SCENE).render(device="cpu").pixels.sum(axis=(0, 1)), rtol=1e-5)
        # 188 of 255 in sRGB is 0.503 of the light; linear, it is 0.737.
        grey = mean(np.full((4, 4), 0.5029))
        np.testing.assert_allclose(mean(np.full((4, 4), 188, np.uint8)), grey, rtol=2e-3)
        for encoded in (np.full((4, 4), 188, np.uint8), np.full((4, 4), 188 / 255)):
            np.testing.assert_allclose(mean(encoded, color_space="srgb"), grey, rtol=2e-3)
        np.testing.assert_allclose(mean(np.full((4, 4), 188, np.uint8), color_space="linear") / grey, 0.7373 / 0.5029, rtol=2e-3)
        for wrong in (np.zeros((4, 4, 2)), np.zeros((4, 4), np.int32), np.full((4, 4), np.inf), np.zeros((0, 4))):
            with self.assertRaisesRegex(gpt.SceneError, r"texture\[0\].file"):
                mean(wrong)

    def test_wrong_values_are_exceptions(self):
        with self.assertRaisesRegex(gpt.SceneError, "reflectanse"):
            gpt.Scene.from_dict(self.described(material=[{"name": "clay", "type": "diffuse", "reflectanse": 1}]))
        with self.assertRaisesRegex(TypeError, "camera.vfov"):
            gpt.Scene.from_dict(self.described(camera={"vfov": None}))
        with self.assertRaises(TypeError):
            gpt.Scene.from_dict([1])
        with self.assertRaisesRegex(TypeError, "bytes"):
            gpt.Scene.from_dict(self.described(camera={"vfov": b"40"}))
        strange = {"name": 'a "quoted" \x7f\n name', "type": "diffuse", "reflectance": 0.5}
        self.assertEqual(gpt.Scene.from_dict(self.described(material=[{**strange, "name": "clay"}, strange])).size, (24, 16))


class Shown(unittest.TestCase):
    def setUp(self):
        self.picture = gpt.Scene.from_toml(SCENE).render(device="cpu", layers=["normal", "depth", "ids"])

    def test_notebooks_show_a_png(self):
        shown = self.picture._repr_png_()
        self.assertEqual(shown[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(shown[16:24], (24).to_bytes(4, "big") + (16).to_bytes(4, "big"))

    def test_a_dataset_of_xarray(self):
        try:
            import xarray  # noqa: F401
        except ImportError:
            with self.assertRaisesRegex(ImportError, "pip install xarray"):
                self.picture.to_xarray()
            self.skipTest("xarray is not installed")
        found = self.picture.to_xarray()
        self.assertEqual((found.radiance.dims, found.radiance.shape), (("y", "x", "channel"), (16, 24, 3)))
        self.assertEqual((found.Z.dims, found.N.dims), (("y", "x"), ("y", "x", "axis")))
        self.assertEqual(float(found.radiance.sel(x=12.5, y=8.5, channel="G")), float(self.picture.pixels[8, 12, 1]))
        self.assertEqual(found.attrs["spp"], 8)


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def test_scenes_come_from_files_and_by_name(self):
        path = self.folder / "ball.toml"
        path.write_text(SCENE)
        scene = gpt.Scene.load(path)
        self.assertEqual((scene.name, scene.size, scene.spp, scene.warnings), ("ball", (24, 16), 8, []))
        self.assertIn("cornell", gpt.builtin_scenes())
        self.assertEqual(gpt.Scene.load("cornell").name, "cornell")

    def test_what_imported_files_leave_open(self):
        """A camera and a variant by name, a folder that files have to lie in, another environment."""
        triangle = {"buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + base64.b64encode(np.float32([-1, -1, 0, 1, -1, 0, 0, 1, 0]).tobytes()).decode()}]}
        cameras = [{"name": name, "type": "perspective", "perspective": {"yfov": yfov, "znear": 0.1}} for name, yfov in (("wide", 1.2), ("narrow", 0.6))]
        nodes = [{"mesh": 0}, {"camera": 0, "name": "wide", "translation": [0, 0, 3]}, {"camera": 1, "name": "narrow", "translation": [0, 0, 3]}]
        file = {
            "asset": {"version": "2.0"},
            **triangle,
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "cameras": cameras,
            "nodes": nodes,
            "scenes": [{"nodes": [0, 1, 2]}],
            "scene": 0,
        }
        path = self.folder / "triangle.gltf"
        path.write_text(json.dumps(file))
        seen = {name: gpt.Scene.load(path, camera=name).render(device="cpu", size=(24, 16), spp=16, layers=["alpha"]).layers["A"].mean() for name in ("wide", "narrow")}
        self.assertGreater(seen["narrow"], 1.5 * seen["wide"])
        with self.assertRaisesRegex(gpt.SceneError, "left.*wide|wide.*narrow"):
            gpt.Scene.load(path, camera="left")
        with self.assertRaises(gpt.SceneError):
            gpt.Scene.load(path, variant="red")
        sky = self.folder / "sky.exr"
        gpt.Scene.from_toml(SCENE).render(spp=1, device="cpu").save(sky)
        plain, lit = (gpt.Scene.load(path, camera="wide", environment=map).render(device="cpu", size=(24, 16), spp=4).pixels for map in (None, sky))
        self.assertNotEqual(plain.tobytes(), lit.tobytes())
        inside, outside = self.folder / "inside", self.folder / "outside"
        inside.mkdir(), outside.mkdir()
        shutil.copy(sky, outside / "sky.exr")
        scene = inside / "scene.toml"
        scene.write_text(SCENE + f'[[light]]\ntype = "environment"\nfile = "{(outside / "sky.exr").as_posix()}"\n')
        self.assertEqual(gpt.Scene.load(scene).size, (24, 16))
        with self.assertRaisesRegex(gpt.Error, "sky.exr"):
            gpt.Scene.load(scene, assets_root=inside)

    def test_pictures_are_saved_read_and_compared(self):
        picture = gpt.Scene.from_toml(SCENE).render(device="cpu")
        path = self.folder / "ball.exr"
        picture.save(path)
        again = gpt.Picture.open(path)
        self.assertEqual(again.pixels.tolist(), picture.pixels.tolist())
        self.assertEqual((again.warnings, picture.warnings, again.layers, again.stats), ([], [], {}, {}))
        wide = self.folder / "wide.hdr"
        wide.write_bytes(b"#?RADIANCE\nEXPOSURE=2\nPIXASPECT=2\n\n-Y 1 +X 1\n" + bytes([128, 64, 32, 129]))
        read = gpt.Picture.open(wide)
        self.assertEqual((read.pixels.tolist(), len(read.warnings), read.layers), ([[[0.5, 0.25, 0.125]]], 1, {}))
        self.assertIn("PIXASPECT", read.warnings[0])
        for same in (again, path, picture.pixels, picture.pixels.astype(np.float64)):
            comparison = gpt.compare(same, picture)
            self.assertEqual((comparison.mse, comparison.largest, comparison.psnr), (0, 0, float("inf")))
        brighter = gpt.compare(picture.pixels + 0.5, picture)
        self.assertAlmostEqual(brighter.mse, 0.25, delta=1e-6)
        self.assertAlmostEqual(brighter.largest, 0.5, delta=1e-6)

    def test_layers_are_read(self):
        """Those of a file of the program and of one of our own are those of the render, and they are saved with the picture again."""
        names = "albedo,normal,position,uv,object_position,motion,depth,alpha,variance,samples,low,high,direct,indirect,emission,ids,cryptomatte,groups"
        scene, by_program, ours, again = (self.folder / name for name in ("two.toml", "program.exr", "ours.exr", "again.exr"))
        scene.write_text(Regrouping.TWO)
        picture = gpt.Scene.load(scene).render(spp=32, device="cpu", layers=names.split(","))
        picture.save(ours)
        arguments = [PROGRAM, "render", scene, "--spp", "32", "--device", "cpu", "-q", "--aov", names]
        subprocess.run([*arguments, "-o", by_program], check=True)
        subprocess.run([*arguments, "-o", self.folder / "parts.exr", "--exr", "parts,tiled"], check=True)
        for file in (by_program, ours, self.folder / "parts.exr"):
            read = gpt.Picture.open(file)
            self.assertEqual(read.pixels.tobytes(), picture.pixels.tobytes())
            self.assertEqual(list(read.layers), list(picture.layers))
            for name, layer in picture.layers.items():
                found = read.layers[name]
                self.assertEqual((name, found.dtype, found.shape, found.tobytes()), (name, layer.dtype, layer.shape, layer.tobytes()))
            self.assertEqual(read.light_groups, picture.light_groups)
            self.assertEqual(gpt.regroup(read, {"key": 2}).pixels.tobytes(), gpt.regroup(file, {"key": 2}).pixels.tobytes())
        read.save(again)
        twice = gpt.Picture.open(again)
        self.assertEqual({name: layer.tobytes() for name, layer in twice.layers.items()}, {name: layer.tobytes() for name, layer in picture.layers.items()})
        self.assertEqual(twice.light_groups, picture.light_groups)
        self.assertIn(b"cryptomatte/", again.read_bytes())
        # The controls: layers differ from each other, and a preview has none.
        self.assertNotEqual(picture.layers["Low"].tobytes(), picture.layers["High"].tobytes())
        picture.save(self.folder / "ball.png")
        self.assertEqual(gpt.Picture.open(self.folder / "ball.png").layers, {})

    def test_layers_of_a_part_and_of_adaptive_samples(self):
        scene, file = self.folder / "ball.toml", self.folder / "part.exr"
        scene.write_text(SCENE)
        subprocess.run([PROGRAM, "render", scene, "--device", "cpu", "-q", "--aov", "depth,normal", "--crop", "8,4,6,5", "-o", file], check=True)
        part = gpt.Picture.open(file)
        whole = gpt.Scene.load(scene).render(device="cpu", layers=["depth", "normal"])
        for name in ("Z", "N"):
            np.testing.assert_array_equal(part.layers[name][4:9, 8:14], whole.layers[name][4:9, 8:14])
            self.assertEqual(part.layers[name][0].any(), False, "outside of the part there is nothing")
        self.assertEqual((part.layers["SampleCount"][4, 8], part.layers["SampleCount.Z"].shape), (8, (16, 24)))
        scene = gpt.Scene.from_toml(SCENE.replace("spp = 8", "spp = 64"))
        picture = scene.render(device="cpu", adaptive=True, layers=["samples"])
        picture.save(file)
        counts = gpt.Picture.open(file).layers["SampleCount"]
        self.assertEqual((counts.dtype, counts.tobytes()), (np.uint32, picture.layers["SampleCount"].tobytes()))
        self.assertGreater(counts.max(), counts.min())

    def test_mistakes_are_exceptions(self):
        with self.assertRaisesRegex(gpt.SceneError, "reflectanse"):
            gpt.Scene.from_toml(SCENE.replace("reflectance", "reflectanse"))
        with self.assertRaisesRegex(gpt.SceneError, "missing.toml"):
            gpt.Scene.load(self.folder / "missing.toml")
        scene = gpt.Scene.from_toml(SCENE)
        with self.assertRaisesRegex(gpt.DeviceError, "Abacus"):
            scene.render(device="Abacus")
        for wrong in ({"spp": 0}, {"size": (0, 5)}, {"layers": ["scent"]}, {"time_limit": -1}, {"target_error": 0.0}, {"target_interval": 0.0}, {"confidence": 0.9}, {"target_interval": 0.1, "interval_of": "rows"}, {"device": ""}):
            with self.assertRaises(ValueError, msg=str(wrong)):
                scene.render(**wrong)
        for error in (gpt.SceneError, gpt.DeviceError):
            self.assertTrue(issubclass(error, gpt.Error))
        with self.assertRaises(OSError):
            gpt.Picture.open(self.folder / "missing.exr")
        with self.assertRaises(OSError):
            scene.render(device="cpu", spp=1).save(self.folder / "no" / "folder.exr")
        with self.assertRaises(ValueError):
            gpt.compare(np.zeros((2, 3, 3)), np.zeros((3, 3, 3)))
        with self.assertRaises(ValueError):
            gpt.compare(np.zeros((2, 3)), np.zeros((2, 3)))

    def test_of_pixels_that_are_no_numbers_nothing_is_said(self):
        comparison = gpt.compare(np.full((2, 3, 3), np.nan, np.float32), np.ones((2, 3, 3), np.float32))
        for value in (comparison.mse, comparison.relmse, comparison.mae, comparison.psnr):
            self.assertTrue(np.isnan(value), comparison)
        # The control.
        equal = gpt.compare(np.ones((2, 3, 3), np.float32), np.ones((2, 3, 3), np.float32))
        self.assertEqual((equal.relmse, equal.psnr), (0.0, float("inf")))

    @unittest.skipUnless(hasattr(os, "fork"), "processes are forked on Unix alone")
    def test_a_forked_process_says_that_it_cannot_render(self):
        def forked(before):
            """What a forked process prints; `before` is done before it is forked."""
            text = f"""
import os, sys
import gpt_pathtracer as gpt
SCENE = {SCENE!r}
{before}
child = os.fork()
if child == 0:
    try:
        print(gpt.Scene.from_toml(SCENE).render(device="cpu", spp=1).pixels.shape, flush=True)
    except gpt.Error as error:
        print("refused:", error, flush=True)
    os._exit(0)
os.waitpid(child, 0)
"""
            return subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=60).stdout

        self.assertIn("refused: this process was forked", forked('gpt.Scene.from_toml(SCENE).render(device="cpu", spp=1)'))
        # The control: whoever has not used it yet may.
        self.assertIn("(16, 24, 3)", forked(""))

    def test_the_program_is_there(self):
        said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(said.strip(), f"gpt {gpt.__version__}")

    def test_types_are_stubbed(self):
        """The stub has what the module has: names, members, and parameters in their order."""
        package = Path(gpt.__file__).parent
        self.assertTrue((package / "py.typed").exists())
        self.assertEqual(stubbed((package / "_native.pyi").read_text()), found(gpt._native))
        # The control: another parameter is noticed.
        self.assertNotEqual(stubbed((package / "_native.pyi").read_text().replace("seed:", "key:")), found(gpt._native))


def stubbed(stub):
    """Names in a stub, with their members or parameters."""

    def of(node):
        if isinstance(node, ast.ClassDef):
            return {member.name: of(member) for member in node.body if isinstance(member, ast.FunctionDef)}
        is_property = any(isinstance(mark, ast.Name) and mark.id == "property" for mark in node.decorator_list)
        return "property" if is_property else [argument.arg for argument in node.args.args]

    return {node.name: of(node) for node in ast.parse(stub).body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def found(module):
    """The same of a module."""

    def of(value):
        if isinstance(value, type) and issubclass(value, Exception):
            return {}
        if isinstance(value, type):
            members = {name: member for name, member in vars(value).items() if not name.startswith("__") or name == "__array_interface__"}
            return {name: of(member) for name, member in members.items()}
        if inspect.isdatadescriptor(value):
            return "property"
        return list(inspect.signature(getattr(value, "__func__", value)).parameters)

    return {name: of(value) for name, value in vars(module).items() if not name.startswith("__")}


class Documentation(unittest.TestCase):
    def test_the_examples_run(self):
        """All Python of docs/python.md, in order, as one notebook."""
        text = (ROOT / "docs" / "python.md").read_text()
        cells = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        self.assertGreater(len(cells), 3)
        if device() == "cpu":
            cells = [cell for cell in cells if "gpt.verify" not in cell]
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                names = {}
                for cell in cells:
                    exec(compile(cell, "docs/python.md", "exec"), names)
                self.assertTrue(Path("ball.exr").exists() and Path("ball.png").exists())
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
