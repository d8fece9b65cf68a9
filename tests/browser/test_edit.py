"""Tests of `gpt edit` in a real browser, run by scripts/browser."""

import http.client
import json
import os
import subprocess
import time
import tomllib
import unittest
from urllib.parse import urlsplit

import numpy as np

from page import NARROW, WIDE, PageTest

SCENE = """# A ball under an even sky.
[film]
size = [96, 64]
[render]
spp = 16
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
vfov = 40
[[light]]
type = "environment"
radiance = [0.25, 0.5, 1] # bluish
[[texture]]
name = "dots"
type = "checker"
a = 0.1
b = 0.9
scale = [4, 4]

# Earthen.
[[material]]
name = "clay" # of the ball
type = "diffuse"
reflectance = [0.8, 0.20, 0.05] # red

[[material]]
name = "steel"
type = "conductor"
reflectance = 0.6
roughness = 0.3

[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "clay"
"""


class Edit(PageTest):
    SCENE = SCENE

    def edit(self, **context):
        self.open("edit", "scene.toml", "--device", "cpu", **context)
        self.wait("() => document.querySelector('#form .row') !== null")
        self.wait_until_finished()

    def radiance(self):
        """The radiance in the middle of the ball, which is the sky's times its reflectance."""
        return self.page.evaluate("() => [...picture.values.slice(5 * (32 * 96 + 48), 5 * (32 * 96 + 48) + 3)]")

    def wait_for_radiance(self, *expected):
        self.wait(
            "(expected) => { const at = 5 * (32 * 96 + 48); return expected.every((value, c) => Math.abs(picture.values[at + c] - value) < 2e-3); }",
            list(expected),
        )

    def control(self, label):
        return self.page.locator(f'#panel :is(button, input, select)[aria-label="{label}"]')

    def fill(self, label, value):
        """Types into a field as somebody who leaves it then."""
        field = self.control(label)
        field.fill(value)
        field.blur()

    def model(self):
        self.wait("() => !isAsking && queue.length === 0")
        return self.page.evaluate("() => model")

    def materials(self):
        return self.model()["lists"]["material"]

    def saved(self):
        self.page.keyboard.press("Control+s")
        self.wait("() => !isAsking && queue.length === 0 && document.getElementById('say').textContent.includes('saved')")
        return self.scene.read_text()

    def test_the_page_fits_wide_and_narrow_windows(self):
        self.edit()
        for name, size in (("edit-wide", WIDE), ("edit-narrow", NARROW)):
            self.page.set_viewport_size(size)
            self.readout()
            self.keep(name)
            sideways = self.page.evaluate("() => document.documentElement.scrollWidth - window.innerWidth")
            self.assertLessEqual(sideways, 0, f"{name}: it must not scroll sideways")
            canvas, panel = (self.page.locator(one).bounding_box() for one in ("#canvas", "#panel"))
            self.assertGreater(min(canvas["width"], canvas["height"]), 200, f"{name}: {canvas}")
            for element in self.page.locator("#panel button:visible, #panel input:visible, #panel select:visible").all():
                box = element.bounding_box()
                self.assertTrue(box["x"] >= panel["x"] and box["x"] + box["width"] <= panel["x"] + panel["width"] + 0.5, f"{name}: {element} {box}")
            nameless = self.page.evaluate(
                "() => [...document.querySelectorAll('#panel button, #panel input, #panel select')].filter((one) => !one.getAttribute('aria-label') && !one.textContent.trim()).length"
            )
            self.assertEqual(nameless, 0, "everything has a name for those who cannot see it")
        self.assertEqual(self.troubles, [])
        origin = urlsplit(self.address).netloc
        self.assertTrue(all(url.startswith(("blob:", "data:")) or urlsplit(url).netloc == origin for url in self.requests), self.requests)

    def camera(self):
        return self.model()["camera"]

    def drag(self, right, down, **keys):
        """Drags from the middle of the canvas, in shares of its height, step by step."""
        box = self.page.locator("#canvas").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        self.page.mouse.move(x, y)
        self.page.mouse.down(**keys)
        for step in range(1, 11):
            self.page.mouse.move(x + right * box["height"] * step / 10, y + down * box["height"] * step / 10)
        self.page.mouse.up(**keys)

    def test_the_camera_follows_the_mouse_and_is_kept_on_request(self):
        self.edit()
        before = self.saved_png()
        # The control: a drag that does not move the camera moves the picture on the canvas alone.
        self.drag(0.2, 0.1)
        self.assertEqual((self.camera()["is_moved"], self.camera()["look"]["position"]), (False, [0, 0, 4]))
        self.page.click("#look")
        # Half a turn for the height of the canvas: a quarter of it is 45 degrees, to the left as the scene turns to the right.
        self.drag(0.25, 0)
        look = self.camera()["look"]
        self.assertEqual(look["look_at"], [0, 0, 0])
        for found, expected in zip(look["position"], (-4 * 0.5**0.5, 0, 4 * 0.5**0.5)):
            self.assertAlmostEqual(found, expected, delta=0.02)
        # Down: from above, as far as no camera stands on its head.
        self.drag(0, 0.25)
        self.assertGreater(self.camera()["look"]["position"][1], 2.7)
        self.drag(0, 0.9)
        x, y, z = self.camera()["look"]["position"]
        self.assertAlmostEqual((x * x + y * y + z * z) ** 0.5, 4, delta=0.01)
        self.assertTrue(3.5 < y < 4, y)
        self.page.click("#back")
        self.wait("() => !model.camera.is_moved && !isAsking && queue.length === 0")
        # Lines that come and go with a render change the canvas's height, by which a drag counts.
        self.wait_until_finished()
        # Aside: a ball of radius 1 at the distance 4 goes by what is seen there, 2 · 4 · tan 20° high.
        self.page.keyboard.down("Shift")
        self.drag(0.25, 0)
        self.page.keyboard.up("Shift")
        look = self.camera()["look"]
        self.assertAlmostEqual(look["position"][0], -0.25 * 8 * 0.36397, delta=0.02)
        self.assertEqual(look["position"][0], look["look_at"][0])
        self.wait_until_finished()
        columns = np.argwhere(np.abs(self.saved_png() - before).sum(axis=(0, 2)) > 0)
        self.assertGreater(columns.size, 20, "the picture follows")
        self.keep("edit-camera")
        # Nearer by the wheel, and by keys that turn and go aside too.
        self.point_at(48, 32)
        self.page.mouse.wheel(0, -300)
        self.wait("() => Math.abs(model.camera.look.position[2] - 2) < 0.01 && !isAsking")
        self.page.locator("#canvas").focus()
        for key in ("-", "ArrowLeft", "ArrowUp", "Shift+ArrowRight"):
            place = self.camera()["look"]
            self.page.keyboard.press(key)
            self.assertNotEqual(self.camera()["look"], place, key)
        # The file knows nothing of it until it is kept, and saved.
        self.assertFalse(self.model()["unsaved"])
        self.assertEqual(self.scene.read_text(), SCENE)
        look = self.camera()["look"]
        self.page.click("#keep")
        self.wait("() => model.unsaved && !model.camera.is_moved")
        text = self.saved()
        kept = tomllib.loads(text)["camera"]
        self.assertEqual((kept["position"], kept["look_at"], kept["vfov"]), (look["position"], look["look_at"], 40))
        self.assertIn("radiance = [0.25, 0.5, 1] # bluish", text)
        self.assertNotIn("up =", text)
        self.page.keyboard.press("Control+z")
        self.wait("() => model.camera.look.position[2] === 4")
        self.page.keyboard.press("c")
        self.wait("() => document.getElementById('look').getAttribute('aria-pressed') === 'false'")
        self.assertEqual(self.troubles, [])

    def test_a_camera_that_moves_by_itself_stays(self):
        self.scene.write_text(SCENE.replace("vfov = 40\n", "vfov = 40\nkeyframes = [{ frame = 0, position = [0, 0, 4] }, { frame = 8, position = [1, 0, 4] }]\n"))
        self.edit()
        self.assertTrue(self.page.locator("#look").is_disabled())
        self.assertIn("keyframes", self.text("place"))
        self.assertEqual(self.page.evaluate(
            "async () => (await fetch('look', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ revision: 1, look: { position: [1, 1, 1], look_at: [0, 0, 0], up: [0, 1, 0] } }) })).status"
        ), 400)

    def test_a_slider_changes_the_picture_and_is_one_step_to_undo(self):
        self.edit()
        self.control("material steel").click()
        self.control("kind of reflectance").select_option(label="linear RGB")
        self.control("material clay").click()
        self.control("kind of reflectance").select_option(label="grey")
        self.wait("() => at(['material', 0, 'reflectance']) > 0.3")
        slider = self.control("reflectance, slider")
        box = slider.bounding_box()
        middle = box["y"] + box["height"] / 2
        self.page.mouse.move(box["x"] + box["width"] / 2, middle)
        self.page.mouse.down()
        for step in range(1, 9):
            self.page.mouse.move(box["x"] + box["width"] * (0.5 + 0.05 * step), middle)
            self.page.wait_for_timeout(30)
        self.page.mouse.up()
        grey = self.materials()[0]["reflectance"]
        self.assertAlmostEqual(grey, 0.9, delta=0.06)
        self.wait_for_radiance(0.25 * grey, 0.5 * grey, grey)
        before = 0.2126 * 0.8 + 0.7152 * 0.2 + 0.0722 * 0.05
        self.page.keyboard.press("Control+z")
        self.wait_for_radiance(0.25 * before, 0.5 * before, before)
        self.page.keyboard.press("Control+z")
        self.wait_for_radiance(0.2, 0.1, 0.05)
        self.page.keyboard.press("Control+Shift+z")
        self.wait_for_radiance(0.25 * before, 0.5 * before, before)
        self.assertEqual(self.troubles, [])

    def test_colours_are_linear_numbers_and_srgb_swatches(self):
        self.edit()
        swatch = self.control("reflectance, as sRGB")
        coded = lambda value: round(255 * (1.055 * value ** (1 / 2.4) - 0.055))
        self.assertEqual(swatch.input_value(), "#{:02x}{:02x}{:02x}".format(*(coded(value) for value in (0.8, 0.2, 0.05))))
        swatch.fill("#808080")
        half = ((128 / 255 + 0.055) / 1.055) ** 2.4
        self.wait_for_radiance(0.25 * half, 0.5 * half, half)
        self.fill("reflectance green", "0.75")
        self.wait_for_radiance(0.25 * half, 0.375, half)
        # An emission may be brighter than a screen: the swatch has its hue.
        self.page.locator("#form details").first.evaluate("(details) => { details.open = true; }")
        self.control("set emission").click()
        self.fill("emission red", "4")
        self.fill("emission green", "2")
        self.fill("emission blue", "0")
        self.wait("() => picture.values[5 * (32 * 96 + 48)] > 4")
        self.assertEqual(self.control("emission, as sRGB").input_value(), f"#ff{coded(0.5):02x}00")
        self.control("leave out emission").click()
        self.wait_for_radiance(0.25 * half, 0.375, half)

    def test_wrapping_in_a_blend_keeps_the_picture_and_its_weight_changes_it(self):
        self.edit()
        before = self.radiance()
        self.control("wrap in a blend").click()
        self.wait("() => model.lists.material.length === 4")
        self.wait_until_finished()
        np.testing.assert_allclose(self.radiance(), before, rtol=1e-4)
        self.control("node clay 2").click()
        self.fill("reflectance red", "0")
        self.wait_for_radiance(0.1, 0.1, 0.05)
        self.control("node clay").click()
        self.keep("edit-blend")
        self.fill("value", "0")
        self.wait_for_radiance(0, 0.1, 0.05)
        self.control("type of weight").select_option("facing")
        self.wait_for_radiance(0.2, 0.1, 0.05)
        # A heuristic of heuristics takes in the one that was there, and gives it back.
        self.control("type of weight").select_option("reverse")
        self.wait_for_radiance(0, 0.1, 0.05)
        self.assertEqual(self.materials()[2]["weight"]["of"]["type"], "facing")
        self.control("type of weight").select_option("facing")
        self.wait_for_radiance(0.2, 0.1, 0.05)
        self.control("move materials 2 up").click()
        self.wait_for_radiance(0, 0.1, 0.05)
        self.assertEqual(self.materials()[2]["materials"], ["clay 2", "clay 1"])
        self.assertEqual(self.troubles, [])

    def test_every_type_can_be_chosen_for_a_new_entry_and_for_an_old_one(self):
        self.edit()
        types = self.control("type of the new material").locator("option").all_text_contents()
        self.assertGreater(len(types), 10)
        for index, kind in enumerate(types):
            with self.subTest(kind):
                self.control("type of the new material").select_option(kind)
                self.control("name of the new material").fill(f"new {kind}")
                before = self.page.evaluate("() => state.round")
                self.control("add a material").click()
                self.assertEqual(self.materials()[-1]["type"], kind)
                self.assertEqual(len(self.materials()), 3 + index)
                self.assertEqual(self.text("node-title"), f"material new {kind}")
                self.wait("(round) => state.phase === 'failed' || (state.round > round && state.phase === 'finished')", before)
                self.assertEqual(self.text("message"), "", kind)
        for kind in types:
            if kind in ("emissive", "pass", "layered"):
                continue
            with self.subTest(f"to {kind}"):
                self.control("material clay").click()
                self.control("type").select_option(kind)
                self.assertEqual(self.materials()[0]["type"], kind)
                self.assertEqual(self.materials()[0]["name"], "clay")
        self.control("remove clay").click()
        self.wait("() => document.getElementById('message').textContent.includes('clay')")
        self.assertEqual(self.troubles, [])

    def test_textures_choices_and_flags(self):
        self.edit()
        self.control("kind of reflectance").select_option(label="texture")
        self.wait("() => at(['material', 0, 'reflectance']).texture === 'dots'")
        self.assertEqual(self.control("texture").locator("option").all_text_contents(), ["dots"])
        self.wait("() => { const at = 5 * (32 * 96 + 48); return picture.values[at] < 0.24 && picture.values[at] / picture.values[at + 1] < 0.51; }")
        self.page.locator("#form details").last.evaluate("(details) => { details.open = true; }")
        self.control("set two_sided").click()
        self.control("two_sided").click()
        self.wait("() => at(['material', 0, 'two_sided']) === true")
        self.control("material steel").click()
        self.page.locator("#form details").last.evaluate("(details) => { details.open = true; }")
        self.control("set distribution").click()
        self.control("distribution").select_option("beckmann")
        self.assertEqual(self.materials()[1]["distribution"], "beckmann")

    def test_saving_keeps_all_else_and_never_overwrites_by_surprise(self):
        self.edit()
        self.assertTrue(self.page.locator("#undo").is_disabled())
        self.fill("reflectance red", "0.4")
        self.wait_for_radiance(0.1, 0.1, 0.05)
        self.assertIn("not saved", self.text("unsaved"))
        self.assertEqual(self.scene.read_text(), SCENE, "nothing is written unasked")
        expected = SCENE.replace("[0.8, 0.20, 0.05] # red", "[0.4, 0.20, 0.05] # red")
        self.assertEqual(self.saved(), expected)
        self.assertEqual(self.text("unsaved"), "")
        self.assertEqual([path.name for path in self.folder.iterdir()], ["scene.toml"], "nothing else is written")
        self.scene.write_text("# other\n" + expected)
        self.fill("reflectance red", "0.2")
        self.page.click("#save")
        self.wait("() => document.getElementById('say').textContent.includes('another program')")
        self.assertEqual(self.scene.read_text(), "# other\n" + expected)
        self.control("save over what the other program wrote").click()
        self.wait("() => document.getElementById('say').textContent.includes('is saved')")
        self.assertEqual(self.scene.read_text(), expected.replace("[0.4,", "[0.2,"))
        self.assertEqual(self.end(), 0)

    def test_a_mistake_is_told_and_the_last_picture_stays(self):
        self.edit()
        self.fill("reflectance red", "7")
        self.wait("() => document.getElementById('phase').className === 'failed'")
        message = self.text("message")
        self.assertIn("reflectance", message)
        self.assertIn("scene.toml:24", message)
        self.assertTrue(self.page.locator("#mistake #message").is_visible())
        self.keep("edit-mistake")
        self.assertAlmostEqual(self.radiance()[0], 0.2, delta=1e-3, msg="the last picture stays")
        self.page.click("#undo")
        self.wait("() => document.getElementById('phase').textContent === 'finished'")
        self.assertFalse(self.page.locator("#message").is_visible())

    def test_only_the_page_itself_may_change_anything(self):
        self.edit()
        place = urlsplit(self.address)
        good = {"Origin": f"http://{place.netloc}", "Content-Type": "application/json"}
        body = json.dumps({"revision": 1, "changes": [{"do": "set", "at": ["material", 0, "reflectance"], "value": 0.5}]})

        def post(path, headers, body=body):
            connection = http.client.HTTPConnection(place.netloc, timeout=30)
            connection.request("POST", path, body, headers)
            return connection.getresponse().status

        edit = place.path + "edit"
        self.assertEqual(post("/" + "0" * 32 + "/edit", good), 403, "another secret")
        self.assertEqual(post(edit, {**good, "Host": "evil.example"}), 403)
        self.assertEqual(post(edit, {**good, "Origin": "http://evil.example"}), 403)
        self.assertEqual(post(edit, {"Content-Type": "application/json"}), 403, "no origin")
        self.assertEqual(post(edit, {**good, "Content-Type": "text/plain"}), 415)
        self.assertEqual(post(edit, good, " " * (1 << 20) + body), 413)
        self.assertEqual(post(edit, good, "{"), 400)
        self.assertEqual(post(edit, good, body.replace("material", "film")), 400, "only materials and media")
        self.assertEqual(post(place.path + "nothing", good), 404)
        self.assertEqual(self.page.evaluate("() => fetch('document').then((answer) => answer.json())")["revision"], 1)
        self.assertEqual(post(edit, good), 200, "the control")
        self.assertEqual(post(edit, good), 409, "that revision is over")
        self.wait_for_radiance(0.125, 0.25, 0.5)
        self.wait("() => model.revision === 2")
        self.assertEqual(self.scene.read_text(), SCENE)

    def test_other_files_are_refused_with_advice(self):
        for name, advice in (("cornell", "gpt scenes cornell > cornell.toml"), ("a.glb", "gpt import a.glb")):
            run = subprocess.run([os.environ["GPT"], "edit", name], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual(run.returncode, 2)
            self.assertIn(advice, run.stderr)

    def test_a_picture_comes_soon_after_an_edit(self):
        cornell = subprocess.run([os.environ["GPT"], "scenes", "cornell"], capture_output=True, text=True, check=True).stdout
        self.scene.write_text(cornell)
        for device in ("cpu", "gpu"):
            self.open("edit", "scene.toml", "--device", device, "--size", "128x128")
            try:
                self.wait("() => document.querySelector('#form .row') !== null && state && state.samples[0] > 0")
            except Exception:
                if device == "cpu":
                    raise
                print("no graphics device was ready in a minute; its latency is not measured", flush=True)
                return
            times = []
            for value in (0.3, 0.6, 0.4, 0.7, 0.5):
                self.page.wait_for_timeout(400)
                times.append(
                    self.page.evaluate(
                        """async (value) => {
                            const before = { round: state.round, number: picture.number }, start = performance.now();
                            set(["material", 0, "reflectance"], [value, value, value]);
                            while (!(state.round > before.round && picture.number > before.number && wanted.endsWith(`/${state.round}`))) await pause(2);
                            return performance.now() - start;
                        }""",
                        value,
                    )
                )
            print(f"{device}: from an edit of cornell at 128x128 to its first picture in the browser: {', '.join(f'{one:.0f}' for one in times)} ms", flush=True)
            self.end()


if __name__ == "__main__":
    unittest.main(verbosity=2)
