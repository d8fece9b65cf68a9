"""A page of gpt in a real browser, as the tests of the pages open it: GPT names the program, CHROMIUM the browser.

Where BROWSER_PICTURES names a folder, screenshots of the page go there.
"""

import io
import os
import re
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright

PATIENCE_S = 60
WIDE, NARROW = {"width": 1280, "height": 800}, {"width": 400, "height": 800}


def decode(png):
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


class PageTest(unittest.TestCase):
    """A test with a browser, and a folder with the scene `SCENE` of its class."""

    @classmethod
    def setUpClass(cls):
        cls.playwright = sync_playwright().start()
        cls.addClassCleanup(cls.playwright.stop)
        # The sandbox of a browser needs rights that containers lack; the page is our own.
        cls.browser = cls.playwright.chromium.launch(executable_path=os.environ["CHROMIUM"], args=["--no-sandbox", "--disable-gpu"])
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.scene = self.folder / "scene.toml"
        self.scene.write_text(self.SCENE)
        self.troubles = []

    def open(self, *arguments, size=WIDE, **context):
        """Starts gpt and opens the page whose address it prints."""
        command = [os.environ["GPT"], *arguments]
        environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.gpt = subprocess.Popen(command, cwd=self.folder, env=environment, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end)
        said = []
        for line in self.gpt.stderr:
            said.append(line)
            if found := re.search(r"http://\S+", line):
                break
        else:
            self.fail(f"no address: {said}")
        self.address = found[0]
        self.requests = []
        opened = self.browser.new_context(viewport=size, accept_downloads=True, **context)
        self.addCleanup(opened.close)
        self.page = opened.new_page()
        self.page.set_default_timeout(1000 * PATIENCE_S)
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("pageerror", lambda error: self.troubles.append(str(error)))
        self.page.on("console", lambda said: self.troubles.append(said.text) if said.type == "error" else None)
        self.page.goto(self.address)

    def end(self):
        if self.gpt.poll() is None:
            self.gpt.send_signal(signal.SIGINT)
        self.gpt.communicate(timeout=PATIENCE_S)
        return self.gpt.returncode

    def wait(self, condition, argument=None):
        self.page.wait_for_function(condition, arg=argument)

    def wait_until_finished(self):
        # The words come before the picture they speak of.
        self.wait("() => document.getElementById('phase').textContent === 'finished' && wanted.startsWith(`${state.picture}/`) && !isStale")

    def text(self, element):
        return self.page.locator(f"#{element}").text_content()

    def shown(self):
        """What the canvas shows, as bytes of sRGB."""
        return decode(self.page.locator("#canvas").screenshot())

    def saved_png(self):
        with self.page.expect_download() as download:
            self.page.click("#png")
        return decode(Path(download.value.path()).read_bytes())

    def keep(self, name):
        if folder := os.environ.get("BROWSER_PICTURES"):
            self.page.screenshot(path=str(Path(folder) / f"{name}.png"))

    def point_at(self, x, y):
        """Moves the pointer to the middle of a pixel of the picture."""
        x, y = self.page.evaluate(
            """([x, y]) => {
                const box = canvas.getBoundingClientRect();
                const onPage = (corner, pixel, factor) => (corner + (pixel + 0.5) * place.scale) * factor;
                return [box.left + onPage(place.x, x, box.width / canvas.width), box.top + onPage(place.y, y, box.height / canvas.height)];
            }""",
            [x, y],
        )
        self.page.mouse.move(x, y)

    def readout(self):
        self.page.evaluate("() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))")
        return self.text("readout")
