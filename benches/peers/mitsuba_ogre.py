#!/usr/bin/env python3
"""Renders one scene with gpt and with Mitsuba 3 and says whether the pictures agree, and how fast each was.

Both render the same seeds in turn, so that both meet the machine in the same state. Each seed is a replication: a picture of its own.
The verdict is Welch's t on the replications' means, of the whole picture per channel and of every tile and channel, corrected by Šidák;
the same tests must then fail on gpt's pictures with one per cent of energy added. See README.md for the set-up.

Exit status: 0 agreement, 1 no verdict (the negative control did not fail, or a renderer did), 7 a difference.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mitsuba as mi
import numpy as np

from agreement import print_means, verdict

HERE = Path(__file__).resolve().parent


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", type=Path, default=HERE.parent / "scenes" / "ogre.toml")
    parser.add_argument("--spp", type=int, default=1024, help="samples per pixel in all (default: 1024)")
    parser.add_argument("--seeds", type=int, default=8, help="replications they are split into, at least 2 (default: 8)")
    parser.add_argument("--alpha", type=float, default=0.01, help="level of each of the two verdicts (default: 0.01)")
    parser.add_argument("--variant", default="llvm_ad_rgb", help="Mitsuba's variant (default: llvm_ad_rgb)")
    parser.add_argument("--gpt", type=Path, default=HERE.parents[1] / "target" / "release" / "gpt", help="the program")
    parser.add_argument("--device", default="auto", help="gpt's device (default: auto)")
    parser.add_argument("--mitsuba-only", action="store_true", help="render with Mitsuba alone and print its means")
    parser.add_argument("--keep", type=Path, help="folder for both mean pictures and their difference, as EXR")
    options = parser.parse_args()
    if options.seeds < 2 or options.spp < options.seeds:
        parser.error("--seeds must be at least 2, and --spp at least as many")
    return options


class Mitsuba:
    def __init__(self, options):
        from export_mitsuba import load  # needs the variant to be set

        self.spp = options.spp // options.seeds
        self.scene = mi.load_dict(load(options.scene, spp=self.spp))
        self.render(seed=options.seeds)  # the first render compiles the kernels

    def render(self, seed):
        """The picture and the seconds it took."""
        start = time.perf_counter()
        picture = np.array(mi.render(self.scene, spp=self.spp, seed=seed), dtype=np.float64)
        return picture, time.perf_counter() - start


class Gpt:
    def __init__(self, options, folder):
        self.spp, self.folder, self.device = options.spp // options.seeds, Path(folder), None
        self.command = [str(options.gpt), "render", str(options.scene), "--device", options.device, "--quiet", "--strict"]

    def render(self, seed):
        """The picture and the seconds it took, without loading, building and compiling."""
        picture, report = self.folder / "picture.exr", self.folder / "stats.json"
        run = [*self.command, "--spp", str(self.spp), "--seed", str(seed), "-o", str(picture), "--stats", str(report)]
        subprocess.run(run, check=True)
        figures = json.loads(report.read_text(encoding="utf-8"))
        self.device = figures["device"]
        bitmap = mi.Bitmap(str(picture)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False)
        return np.array(bitmap, dtype=np.float64), figures["seconds"]["render"]


def print_speed(name, pictures, seconds, spp):
    samples = pictures.shape[1] * pictures.shape[2] * spp
    rates = samples / np.array(seconds) / 1e6
    print(f"{name:8} {np.median(rates):.2f} Msample/s (median of {len(rates)}; {rates.min():.2f} to {rates.max():.2f})")


def compare(options):
    mi.set_variant(options.variant)
    mitsuba = Mitsuba(options)
    with tempfile.TemporaryDirectory() as folder:
        gpt = None if options.mitsuba_only else Gpt(options, folder)
        ours, theirs = [], []
        for seed in range(options.seeds):
            if gpt:
                ours.append(gpt.render(seed))
            theirs.append(mitsuba.render(seed))
            print(f"seed {seed + 1} of {options.seeds} done", file=sys.stderr)
    their_pictures, their_seconds = np.stack([p for p, _ in theirs]), [s for _, s in theirs]
    print(f"{options.scene.name}, {mitsuba.spp} samples per pixel × {options.seeds} seeds, Mitsuba {mi.__version__} {options.variant}, {os.cpu_count()} cores")
    print_means("Mitsuba", their_pictures)
    print_speed("Mitsuba", their_pictures, their_seconds, mitsuba.spp)
    if gpt is None:
        return 0
    our_pictures, our_seconds = np.stack([p for p, _ in ours]), [s for _, s in ours]
    if our_pictures.shape != their_pictures.shape:
        sys.exit(f"the pictures differ in size: {our_pictures.shape[1:3]} and {their_pictures.shape[1:3]}")
    print_means("gpt", our_pictures)
    print_speed("gpt", our_pictures, our_seconds, gpt.spp)
    ratios = np.array(their_seconds) / np.array(our_seconds)
    print(f"gpt ({gpt.device}) is {np.median(ratios):.2f} times as fast as Mitsuba (paired: {ratios.min():.2f} to {ratios.max():.2f})")
    if options.keep:
        keep(options.keep, our_pictures.mean(axis=0), their_pictures.mean(axis=0))
    return verdict("Mitsuba", our_pictures, their_pictures, options.alpha)


def keep(folder, ours, theirs):
    folder.mkdir(parents=True, exist_ok=True)
    for name, picture in (("gpt", ours), ("mitsuba", theirs), ("difference", ours - theirs)):
        mi.Bitmap(picture.astype(np.float32)).write(str(folder / f"{name}.exr"))


def main():
    options = arguments()
    try:
        sys.exit(compare(options))
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"mitsuba_ogre.py: {error}")


if __name__ == "__main__":
    main()
