"""Tests of `gpt render --view` in a real browser, run by scripts/browser."""

import os
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np

from page import NARROW, WIDE, PageTest, decode

SKY = "radiance = [0.25, 0.5, 1]"

SCENE = f"""
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
{SKY}
[[material]]
name = "clay"
type = "diffuse"
reflectance = [0.8, 0.2, 0.05]
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "clay"
"""


class View(PageTest):
    SCENE = SCENE

    def view(self, *arguments, **context):
        """Starts a render and opens its page."""
        self.open("render", "scene.toml", "--device", "cpu", "--view", "-o", "a.exr", "-o", "a.png", *arguments, **context)

    def test_the_page_fits_wide_and_narrow_windows_and_shows_the_picture(self):
        self.view("--aov", "normal")
        for name, size in (("wide", WIDE), ("narrow", NARROW)):
            self.page.set_viewport_size(size)
            self.wait_until_finished()
            self.readout()
            self.keep(name)
            sideways = self.page.evaluate("() => document.documentElement.scrollWidth - window.innerWidth")
            self.assertLessEqual(sideways, 0, f"{name}: it must not scroll sideways")
            for control in ("layer", "exposure", "auto", "curve", "zoom", "png", "exr", "canvas"):
                box = self.page.locator(f"#{control}").bounding_box()
                self.assertTrue(box["x"] >= 0 and box["x"] + box["width"] <= size["width"] and box["width"] > 0, f"{name}: {control} {box}")
                self.assertLessEqual(box["y"] + box["height"], size["height"], f"{name}: {control} {box}")
            picture = self.shown()
            height, width, _ = picture.shape
            middle = picture[height // 2, width // 2]
            # A third of the picture's width to the left: whichever side limits it.
            sky = picture[height // 2, width // 2 - int(min(width, 1.5 * height) / 3)]
            self.assertTrue(middle[0] > middle[2], f"{name}: the clay is reddish, not {middle}")
            self.assertTrue(sky[2] > sky[0] + 20, f"{name}: the sky is bluish, not {sky}")
        self.assertEqual(self.troubles, [])
        origin = self.address.split("/", 3)[2]
        self.assertTrue(all(url.startswith(("blob:", "data:")) or url.split("/", 3)[2] == origin for url in self.requests), self.requests)

    def test_curves_and_exposure_are_those_of_the_preview(self):
        for curve in ("agx", "filmic", "clip"):
            with self.subTest(curve):
                self.view("--tonemap", curve, "--exposure", "-1")
                self.wait_until_finished()
                preview = decode((self.folder / "a.png").read_bytes())
                saved = self.saved_png()
                self.assertEqual(saved.shape, preview.shape)
                self.assertLessEqual(np.abs(saved - preview).max(), 1)
                # The control: another curve, and another exposure, are other pictures.
                self.page.select_option("#curve", "clip" if curve != "clip" else "agx")
                self.assertGreater(np.abs(self.saved_after_drawing() - preview).max(), 8)
                self.page.select_option("#curve", curve)
                self.page.locator("#exposure").fill("1")
                self.assertGreater(np.abs(self.saved_after_drawing() - preview).max(), 8)
                self.assertEqual(self.text("stops"), "1.0 EV")
                self.assertEqual(self.end(), 0)

    def saved_after_drawing(self):
        self.readout()
        return self.saved_png()

    def test_pixels_show_their_radiance_samples_and_error(self):
        self.view()
        self.wait_until_finished()
        self.point_at(2, 3)
        self.assertEqual(self.readout().split(), ["2,", "3", "0.25000", "0.50000", "1.0000", "luminance", "0.4829", "±", "0.0", "16", "samples"])
        self.point_at(48, 32)
        radiance = [float(number) for number in self.readout().split()[2:5]]
        for seen, sky, reflectance in zip(radiance, (0.25, 0.5, 1), (0.8, 0.2, 0.05)):
            self.assertAlmostEqual(seen, sky * reflectance, delta=1e-4, msg="a convex body under an even sky")
        self.page.mouse.move(1, 1)

    def test_zoom_by_keys_buttons_and_wheel(self):
        self.view()
        self.wait_until_finished()
        scale = lambda: self.page.evaluate("() => place.scale")
        whole = scale()
        self.assertEqual(whole, int(whole), "a small picture fits by whole numbers")
        self.page.click("#one")
        self.assertEqual(scale(), 1)
        self.page.click("#in")
        self.assertEqual(scale(), 2)
        self.page.locator("#canvas").focus()
        self.page.keyboard.press("-")
        self.assertEqual(scale(), 1)
        self.page.keyboard.press("0")
        self.assertEqual(scale(), whole)
        # The pixel below the pointer stays there.
        self.point_at(10, 20)
        before = self.readout()
        self.page.mouse.wheel(0, -300)
        self.wait("(whole) => place.scale > 1.5 * whole", whole)
        self.assertEqual(self.readout(), before)
        # Dragging moves the picture: another pixel is below the pointer where it is put down again.
        corner = self.page.evaluate("() => place.x")
        self.page.mouse.down()
        self.page.mouse.move(300, 400, steps=3)
        self.page.mouse.up()
        self.assertNotEqual(self.page.evaluate("() => place.x"), corner)

    def test_layers_and_maps(self):
        self.view("--aov", "normal")
        self.wait_until_finished()
        radiance = self.saved_png()
        self.page.select_option("#layer", "N")
        self.wait("() => wanted.includes('/N/') && !isStale")
        normals = self.saved_png()
        # Towards the camera the normal is +z: half, half, one.
        self.assertLessEqual(np.abs(normals[32, 48] - [127, 127, 255]).max(), 4)
        self.page.select_option("#layer", "samples")
        self.wait("() => wanted.includes('//') && !isStale")
        self.assertTrue((self.saved_after_drawing() == 255).all(), "every pixel has all samples")
        self.page.select_option("#layer", "noise")
        noise = self.saved_after_drawing()
        self.assertFalse((noise == radiance).all())
        self.page.select_option("#layer", "")
        self.wait("() => wanted.includes('//') && !isStale")
        self.assertTrue((self.saved_after_drawing() == radiance).all())

    def test_light_groups_are_weighed_anew_by_sliders(self):
        lamp = '[[light]]\ntype = "point"\nposition = [2, 2, 3]\nintensity = [9, 5, 2]\nlight_group = "key"\n'
        self.scene.write_text(SCENE + lamp)
        self.view("--aov", "groups")
        self.wait_until_finished()
        plain = self.saved_png()
        self.assertTrue(self.page.locator("#groups").is_visible())
        self.assertEqual(self.text("regroup"), "as rendered")
        # By the keyboard, under the name that a screen reader says.
        slider = self.page.get_by_label("strength of the light group key")
        slider.focus()
        for _ in range(20):
            self.page.keyboard.press("ArrowRight")
        self.page.get_by_label("tint of the light group rest").fill("#808040")
        self.wait("() => groups.sum !== null && !isStale")
        self.assertEqual(self.text("regroup"), "gpt regroup --group key=2 --group rest=1,#808040")
        self.assertEqual(slider.get_attribute("aria-valuetext"), "2.00 times as bright")
        self.keep("groups")
        regrouped = self.saved_after_drawing()
        flags = self.text("regroup").split()[2:]
        command = [os.environ["GPT"], "regroup", self.folder / "a.exr", *flags, "-o", self.folder / "b.png"]
        subprocess.run(command, check=True, capture_output=True)
        self.assertLessEqual(np.abs(regrouped - decode((self.folder / "b.png").read_bytes())).max(), 1)
        # The control: the picture as rendered is another, and the button leads back to it.
        self.assertGreater(np.abs(regrouped - plain).max(), 20)
        self.page.click("#plain")
        self.wait("() => groups.sum === null && !isStale")
        self.assertTrue((self.saved_after_drawing() == plain).all())
        self.assertEqual(self.troubles, [])
        self.page.set_viewport_size(NARROW)
        self.readout()
        self.assertLessEqual(self.page.evaluate("() => document.documentElement.scrollWidth - window.innerWidth"), 0)

    def test_a_render_without_groups_has_no_sliders(self):
        self.view()
        self.wait_until_finished()
        self.assertFalse(self.page.locator("#groups").is_visible())

    def test_the_radiance_is_saved_as_openexr(self):
        self.view()
        self.wait_until_finished()
        with self.page.expect_download() as download:
            self.page.click("#exr")
        self.assertEqual(download.value.suggested_filename, "scene-16spp.exr")
        saved = self.folder / "saved.exr"
        download.value.save_as(saved)
        compare = lambda other: subprocess.run([os.environ["GPT"], "compare", saved, other, "--tolerance", "0"], capture_output=True).returncode
        self.assertEqual(compare(self.folder / "a.exr"), 0)
        subprocess.run([os.environ["GPT"], "render", self.scene, "--device", "cpu", "--seed", "7", "--quiet", "-o", self.folder / "other.exr"], check=True)
        self.assertEqual(compare(self.folder / "other.exr"), 7, "the control")

    def test_automatic_exposure(self):
        self.view()
        self.wait_until_finished()
        self.page.locator("#canvas").focus()
        self.page.keyboard.press("a")
        self.readout()
        stops = float(self.page.locator("#exposure").input_value())
        values = self.page.evaluate("() => Array.from(picture.values)")
        luminance = np.array(values).reshape(-1, 5)[:, :3] @ [0.2126, 0.7152, 0.0722]
        self.assertAlmostEqual(stops, np.log2(0.18) - np.log2(luminance).mean(), delta=0.051)
        self.assertEqual(self.page.locator("#auto").get_attribute("aria-pressed"), "true")

    def test_a_changed_scene_is_shown_and_a_mistake_is_told(self):
        self.view("--watch")
        self.wait_until_finished()
        start = time.monotonic()
        self.scene.write_text(SCENE.replace(SKY, "radiance = [1, 0.5, 0.25]"))
        self.wait("() => picture.values[0] > picture.values[2]")
        print(f"from a change to its first picture in the browser: {time.monotonic() - start:.2f} s", flush=True)
        self.wait_until_finished()
        self.assertEqual(self.page.evaluate("() => [...picture.values.slice(0, 3)]"), [1, 0.5, 0.25])
        self.scene.write_text(SCENE.replace("radius", "raduis"))
        self.wait("() => document.getElementById('phase').className === 'failed'")
        self.assertIn("raduis", self.text("message"))
        self.assertTrue(self.page.locator("#message").is_visible())
        self.keep("mistake")
        self.assertEqual(self.page.evaluate("() => picture.values[0]"), 1, "the last picture stays")
        self.scene.write_text(SCENE)
        self.wait("() => picture.values[0] === 0.25")
        self.wait_until_finished()
        self.assertFalse(self.page.locator("#message").is_visible())

    def test_it_converges_and_says_when_the_program_has_ended(self):
        self.view("--spp", "100000000")
        self.wait("() => state && state.samples[0] > 0 && picture.number > 0")
        first = self.page.evaluate("() => picture.number")
        self.wait("(first) => picture.number > first", first)
        self.assertIn("rendering", self.text("phase"))
        self.assertRegex(self.text("facts"), r"96×64 · .* spp.* · relMSE about")
        self.assertEqual(self.end(), 130)
        self.wait("() => document.getElementById('phase').textContent.startsWith('gpt has ended')")
        self.assertTrue(self.page.locator("#exr").is_disabled())


if __name__ == "__main__":
    unittest.main(verbosity=2)
