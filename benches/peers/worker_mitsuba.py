"""Mitsuba 3 as a worker (worker.py). Arguments: its variant, then the program gpt, which exports what scene_file.py does not translate."""

import sys
import time

import worker  # first: it takes standard output for itself

import mitsuba as mi
import numpy as np

import scene_file
from exported import Exported

SAMPLERS = ["independent", "stratified", "multijitter", "orthogonal", "ldsampler"]


class Mitsuba:
    def __init__(self, variant, program):
        self.program = program
        mi.set_variant(variant)
        mi.set_log_level(mi.LogLevel.Error)  # samplers warn where they round the number of samples; it is reported instead
        self.name, self.version, self.compiles = f"Mitsuba {variant}", mi.__version__, not variant.startswith("scalar")

    def load(self, path, size):
        import export_mitsuba  # needs the variant to be set

        self.export, self.sensors, self.warm = export_mitsuba, {}, set()
        try:
            self.plan = scene_file.load(path, size=size)
        except scene_file.Refused:
            self.plan = Exported(mi, self.program, path, size)
            self.scene = self.plan.scene()
            return
        self.scene = mi.load_dict(export_mitsuba.export(self.plan))

    def settings(self):
        return SAMPLERS

    def sensor(self, sampler, spp):
        if (sampler, spp) not in self.sensors:
            if isinstance(self.plan, Exported):
                self.sensors[sampler, spp] = self.plan.sensor(sampler, spp)
            else:
                self.plan.spp = spp
                self.sensors[sampler, spp] = mi.load_dict(self.export.sensor(self.plan, sampler))
        return self.sensors[sampler, spp]

    def prepare(self, setting, spp):
        sensor = self.sensor(setting, spp)
        taken = sensor.sampler().sample_count()  # some samplers round
        if self.compiles and (setting, taken) not in self.warm:
            self.warm.add((setting, taken))
            self.picture(sensor, taken, 1 << 16)  # compiles the kernels
        return taken

    def render(self, setting, spp, seed):
        sensor, taken = self.sensor(setting, spp), self.prepare(setting, spp)
        start = time.perf_counter()
        picture = self.picture(sensor, taken, seed)
        return picture, time.perf_counter() - start, taken

    def picture(self, sensor, spp, seed):
        return np.array(mi.render(self.scene, sensor=sensor, spp=spp, seed=seed))


if __name__ == "__main__":
    worker.serve(Mitsuba(*sys.argv[1:]))
