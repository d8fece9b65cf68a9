"""gpt as a worker (worker.py): every render is a process of its own. Arguments: the program, the device, and `best` for the settings that are
tried, or `default` for the one that a user has without asking.

Runs where Mitsuba is installed, whose reader of EXR files it takes.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import worker  # first: it takes standard output for itself

import mitsuba as mi
import numpy as np

# Of the samplers these two are the best nearly everywhere; the first is the program's own choice. Several light samples pay where direct
# light is most of the noise, adaptive sampling where noise is uneven, a guide where light is hard to find.
SETTINGS = {
    "Sobol": ["--sampler", "sobol"],
    "Halton": ["--sampler", "halton"],
    "Sobol, 2 light samples": ["--sampler", "sobol", "--light-samples", "2"],
    "Sobol, 4 light samples": ["--sampler", "sobol", "--light-samples", "4"],
    "Sobol, 4 light samples at 2 surfaces": ["--sampler", "sobol", "--light-samples", "4", "--light-samples-depth", "2"],
    "Sobol, adaptive": ["--sampler", "sobol", "--adaptive"],
    "Sobol, 2 light samples, adaptive": ["--sampler", "sobol", "--light-samples", "2", "--adaptive"],
    "Sobol, 4 light samples, adaptive": ["--sampler", "sobol", "--light-samples", "4", "--adaptive"],
    "Sobol, 8 light samples at 2 surfaces": ["--sampler", "sobol", "--light-samples", "8", "--light-samples-depth", "2"],
    "Sobol, guided": ["--sampler", "sobol", "--guiding", "on"],
    "Sobol, guided by 65536 paths": ["--sampler", "sobol", "--guiding", "on", "--guiding-paths", "65536"],
    "Sobol, guided by 196608 paths": ["--sampler", "sobol", "--guiding", "on", "--guiding-paths", "196608"],
}


DEFAULT = {"the default": []}

# Enough for adaptive sampling to begin.
WARMING_SAMPLES = 16


class Gpt:
    def __init__(self, program, device, way):
        mi.set_variant("scalar_rgb")
        self.program, self.device = program, device
        self.known = DEFAULT if way == "default" else SETTINGS
        self.name = "gpt"
        self.version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]
        self.folder = tempfile.TemporaryDirectory()

    def load(self, path, size):
        self.warm = set()
        self.command = [self.program, "render", path, "--size", "{}x{}".format(*size), "--device", self.device, "--quiet", "--strict"]

    def settings(self):
        return list(self.known)

    def prepare(self, setting, spp):
        # The driver compiles on first use, and keeps what it compiled. Kernels do not depend on how many samples there are, but what the default
        # learns does, and with that its kernels.
        key = (setting, spp) if setting in DEFAULT else setting
        if key not in self.warm:
            self.warm.add(key)
            self.run(setting, spp if setting in DEFAULT else min(spp, WARMING_SAMPLES), 0)
        return spp

    def run(self, setting, spp, seed):
        """The files of the picture and of its figures."""
        picture, report = (Path(self.folder.name) / name for name in ("picture.exr", "stats.json"))
        options = ["--spp", str(spp), "--seed", str(seed), "-o", str(picture), "--stats", str(report)]
        subprocess.run([*self.command, *self.known[setting], *options], check=True)
        return picture, report

    def render(self, setting, spp, seed):
        self.prepare(setting, spp)
        picture, report = self.run(setting, spp, seed)
        figures = json.loads(report.read_text(encoding="utf-8"))
        # Learning is no start-up: it pays back in the samples that follow.
        self.learning_seconds = figures["seconds"]["learn"]
        seconds = figures["seconds"]["render"] + self.learning_seconds
        # Where adaptive sampling gave pixels different numbers of samples, they stand in a fourth channel.
        return np.array(mi.Bitmap(str(picture)), dtype=np.float32)[..., :3], seconds, spp


if __name__ == "__main__":
    worker.serve(Gpt(*sys.argv[1:]))
