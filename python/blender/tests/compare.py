"""The same scene by Cycles and by gpt, compared by tiles, with the noise of both measured.

    python compare.py FOLDER [SCENE]…        (with the package bpy; GPT is the program)

Both render a scene several times with seeds of their own. A tile's mean in each of these pictures is one number; the two sets of numbers are
compared by Welch's t-test. Pictures and tables go to FOLDER.
"""

import math
import os
import subprocess
import sys

import bpy
import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import export as exporter  # noqa: E402

exporter.package()
from gpt_blender.picture_file import write_exr  # noqa: E402
from gpt_blender.scene import export  # noqa: E402

import scenes  # noqa: E402

TILES = (6, 6)
RUNS = 8
SAMPLES = 64
SURE = 7.0
"""Standard errors by which a tile may be off: chance exceeds it in one of 4700 tiles at 7 degrees of freedom, the least that 8 runs of each leave."""


def gpt():
    return os.environ.get("GPT", "gpt")


def read(path):
    """Linear R, G and B of a picture file, rows from the top."""
    image = bpy.data.images.load(path, check_existing=False)
    width, height = image.size
    pixels = numpy.empty(4 * width * height, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[::-1, :, :3].astype(float)


def by_cycles(scene, folder, runs=RUNS, samples=SAMPLES):
    scene.cycles.samples = samples
    pictures = []
    for seed in range(runs):
        scene.cycles.seed = seed
        scene.render.filepath = os.path.join(folder, "cycles.exr")
        bpy.ops.render.render(write_still=True)
        pictures.append(read(scene.render.filepath))
    return numpy.array(pictures)


def by_gpt(path, folder, runs=RUNS, samples=SAMPLES):
    pictures = []
    for seed in range(runs):
        target = os.path.join(folder, "gpt.exr")
        command = [gpt(), "render", path, "--spp", str(samples), "--seed", str(1000 + seed), "-o", target, "--quiet"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)} ended with {done.returncode}:\n{done.stderr}")
        pictures.append(read(target))
    return numpy.array(pictures)


def tiles(pictures):
    """Means of tiles: runs × rows × columns × channels."""
    runs, height, width, _ = pictures.shape
    rows, columns = TILES
    return pictures.reshape(runs, rows, height // rows, columns, width // columns, 3).mean(axis=(2, 4))


def compared(ours, theirs):
    """Ratio of means with its standard error, and of each tile the ratio and by how many standard errors it is off."""
    a, b = tiles(ours), tiles(theirs)
    count = len(a)
    error = numpy.sqrt(a.var(axis=0, ddof=1) / count + b.var(axis=0, ddof=1) / count)
    level = b.mean()
    # What both compute without noise agrees to rounding alone.
    error = numpy.maximum(error, 2e-4 * level)
    off = (a.mean(axis=0) - b.mean(axis=0)) / error
    ratio = a.mean(axis=0).sum(axis=2) / numpy.maximum(b.mean(axis=0).sum(axis=2), 1e-9)
    wholes = ours.mean(axis=(1, 2, 3)), theirs.mean(axis=(1, 2, 3))
    mean = wholes[0].mean() / wholes[1].mean()
    spread = mean * math.hypot(*(whole.std(ddof=1) / whole.mean() / math.sqrt(count) for whole in wholes))
    return {
        "ratio": mean, "error": spread,
        "tiles": off.size, "off": int((abs(off) > SURE).sum()), "furthest": float(abs(off).max()),
        "low": float(ratio.min()), "high": float(ratio.max()), "relative": relative(ours, theirs),
    }


def relative(ours, theirs):
    """Root mean square of the tiles' differences over the picture's mean."""
    a, b = tiles(ours).mean(axis=0), tiles(theirs).mean(axis=0)
    return float(numpy.sqrt(((a - b) ** 2).mean()) / b.mean())


def beside(make, folder, runs=RUNS, samples=SAMPLES):
    """Makes a scene, exports it, renders it by both, and compares: the comparison, both pictures and the report."""
    scene = make()
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, f"{make.__name__}.toml")
    report, _ = export(scene, path)
    theirs, ours = by_cycles(scene, folder, runs, samples), by_gpt(path, folder, runs, samples)
    return compared(ours, theirs), ours.mean(axis=0), theirs.mean(axis=0), report


def main(folder, names):
    for make in scenes.SCENES:
        if names and make.__name__ not in names:
            continue
        result, ours, theirs, report = beside(make, folder)
        write_exr(os.path.join(folder, f"{make.__name__}-beside.exr"), numpy.concatenate([theirs, ours], axis=1))
        print(f"{make.__name__}: ratio {result['ratio']:.4f} ± {result['error']:.4f}, tiles {result['low']:.3f} to {result['high']:.3f}, "
              f"{result['off']} of {result['tiles']} beyond {SURE:g} standard errors (furthest {result['furthest']:.1f}), "
              f"rms {100 * result['relative']:.2f} %", flush=True)
        for line in report.lines:
            print(f"    {line}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
