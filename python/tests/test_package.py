"""Tests of the Python package, run by scripts/python against the installed wheel."""

import ast
import inspect
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
import unittest
from pathlib import Path

import numpy as np

import gpt_pathtracer as gpt

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

    def test_pictures_are_saved_read_and_compared(self):
        picture = gpt.Scene.from_toml(SCENE).render(device="cpu")
        path = self.folder / "ball.exr"
        picture.save(path)
        again = gpt.Picture.open(path)
        self.assertEqual(again.pixels.tolist(), picture.pixels.tolist())
        self.assertEqual((again.warnings, picture.warnings), ([], []))
        wide = self.folder / "wide.hdr"
        wide.write_bytes(b"#?RADIANCE\nEXPOSURE=2\nPIXASPECT=2\n\n-Y 1 +X 1\n" + bytes([128, 64, 32, 129]))
        read = gpt.Picture.open(wide)
        self.assertEqual((read.pixels.tolist(), len(read.warnings)), ([[[0.5, 0.25, 0.125]]], 1))
        self.assertIn("PIXASPECT", read.warnings[0])
        for same in (again, path, picture.pixels, picture.pixels.astype(np.float64)):
            comparison = gpt.compare(same, picture)
            self.assertEqual((comparison.mse, comparison.largest, comparison.psnr), (0, 0, float("inf")))
        brighter = gpt.compare(picture.pixels + 0.5, picture)
        self.assertAlmostEqual(brighter.mse, 0.25, delta=1e-6)
        self.assertAlmostEqual(brighter.largest, 0.5, delta=1e-6)

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
