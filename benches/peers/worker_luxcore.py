"""LuxCore as a worker (worker.py)."""

import time

import numpy as np
import worker  # first: it takes standard output for itself

import pyluxcore

import export_luxcore
import scene_file

# Sampler, and by what a light is chosen; every triangle of a mesh that emits is a light.
SETTINGS = {
    "Sobol, lights by log of power": ("SOBOL", "LOG_POWER"),
    "Sobol, lights by power": ("SOBOL", "POWER"),
    "Sobol, lights uniformly": ("SOBOL", "UNIFORM"),
    "random, lights by log of power": ("RANDOM", "LOG_POWER"),
    "random, lights uniformly": ("RANDOM", "UNIFORM"),
}
POLL_SECONDS = 0.002


class LuxCore:
    def __init__(self):
        pyluxcore.Init()
        pyluxcore.SetLogHandler(lambda text: None)
        self.name, self.version = "LuxCore", pyluxcore.Version()

    def load(self, path, size):
        self.plan = scene_file.load(path, size=size)
        self.scene = export_luxcore.build(self.plan)

    def settings(self):
        return list(SETTINGS)

    def prepare(self, setting, spp):
        return spp  # nothing is compiled

    def render(self, setting, spp, seed):
        config = pyluxcore.RenderConfig(export_luxcore.configuration(self.plan, spp, seed, *SETTINGS[setting]), self.scene)
        session = pyluxcore.RenderSession(config)
        session.Start()
        while not session.HasDone():
            time.sleep(POLL_SECONDS)
            session.UpdateStats()
        statistics = session.GetStats()
        seconds = statistics.Get("stats.renderengine.time").GetFloat()
        taken = statistics.Get("stats.renderengine.pass").GetFloat()
        session.Stop()
        width, height = self.plan.size
        pixels = np.zeros(width * height * 3, dtype=np.float32)
        session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0, True)
        return pixels.reshape(height, width, 3)[::-1], seconds, taken


if __name__ == "__main__":
    worker.serve(LuxCore())
