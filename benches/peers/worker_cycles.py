"""Blender's Cycles as a worker (worker.py)."""

import re
import tempfile
from pathlib import Path

import worker  # first: it takes standard output for itself

import bpy
import numpy as np

import export_cycles
import scene_file

# The light tree pays where there are many lights; either point set is a scrambled Sobol' sequence.
SETTINGS = {
    "Sobol, light tree": ("TABULATED_SOBOL", True, False),
    "Sobol": ("TABULATED_SOBOL", False, False),
    "blue noise": ("BLUE_NOISE", False, False),
    "Sobol, adaptive": ("TABULATED_SOBOL", False, True),
}
RENDER_TIME = re.compile(rb"(?:(\d+):)?(\d+):(\d+\.\d+)")


class Cycles:
    def __init__(self):
        self.name, self.version, self.folder = "Cycles", bpy.app.version_string, tempfile.TemporaryDirectory()

    def load(self, path, size):
        self.scene = export_cycles.build(scene_file.load(path, size=size, exported=False))
        self.render(next(iter(SETTINGS)), 1, 0)  # builds what persistent data keeps

    def settings(self):
        return list(SETTINGS)

    def prepare(self, setting, spp):
        return spp  # nothing is compiled

    def render(self, setting, spp, seed):
        cycles, file = self.scene.cycles, Path(self.folder.name) / "picture.exr"
        cycles.sampling_pattern, cycles.use_light_tree, cycles.use_adaptive_sampling = SETTINGS[setting]
        cycles.adaptive_threshold = 0.0  # Cycles derives it from the number of samples
        cycles.samples, cycles.seed = spp, seed
        self.scene.render.filepath = str(file)
        bpy.ops.render.render(write_still=True)
        return read(file), render_seconds(file), spp


def render_seconds(file):
    """What Cycles' own statistics say of path tracing alone, to a hundredth of a second."""
    head = file.read_bytes()[:8192]
    found = RENDER_TIME.search(head, head.index(b".render_time"))
    hours, minutes, seconds = found.groups()
    return 3600 * int(hours or 0) + 60 * int(minutes) + float(seconds)


def read(path):
    """Rows from the top, RGB."""
    image = bpy.data.images.load(str(path), check_existing=False)
    width, height = image.size
    pixels = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, -1)[::-1, :, :3]


if __name__ == "__main__":
    worker.serve(Cycles())
