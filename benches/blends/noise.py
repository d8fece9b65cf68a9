#!/usr/bin/env python3
"""Does blending add noise? Mean squared errors of one picture made in five ways.

The teapot (teapot.toml) is Lambert 0.8: directly, as the blend of white and black by 0.8, and as the blend of 0.8 with itself by 0.5,
each blend with `--blend pick` and `--blend mixture`. Every error is taken against two independent references R and S of the direct
material: (mse(X, R) + mse(X, S) − mse(R, S)) / 2 is the error of X alone, whatever noise the references have left.

All ways take the same seeds, that is the same random numbers, and are compared seed by seed; `--own-seeds` gives each way seeds of its
own, so that equal errors are no matter of course. Last it says which of the blends are the direct material's picture bit for bit.

Writes a table of every picture and prints the median over the seeds of the ratio to the direct material's error (with seeds of their own:
to its mean), with the least and the largest. Needs a built program and nothing beyond Python. plot.py draws the figure.
"""

import argparse
import csv
import json
import statistics
import sys
import tempfile
from pathlib import Path

from variants import GPT, HERE, run, write_scenes

METHODS = [
    ("direct", "mixture"),
    ("different colours", "pick"),
    ("different colours", "mixture"),
    ("same colours", "pick"),
    ("same colours", "mixture"),
]
# No seed of a picture, which count from 1.
REFERENCE_SEEDS = (1001, 1002)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, nargs="+", default=[16, 64, 256, 1024], help="samples per pixel (default: 16 64 256 1024)")
    parser.add_argument("--seeds", type=int, default=4, help="pictures of each kind (default: 4)")
    parser.add_argument("--surfaces", nargs="+", choices=["different colours", "same colours"], default=["different colours", "same colours"])
    parser.add_argument("--own-seeds", action="store_true", help="give each way seeds of its own")
    parser.add_argument("--reference-spp", type=int, default=1024, help="samples per pixel of each of the two references (default: 1024)")
    parser.add_argument("--size", default="650x540", help="size of the pictures (default: 650x540)")
    parser.add_argument("--sampler", default="halton", help="sampler of all pictures (default: halton)")
    parser.add_argument("--device", default="auto", help="device (default: auto)")
    parser.add_argument("--output", type=Path, default=HERE / "noise.csv", help="the table to write (default: noise.csv beside this)")
    options = parser.parse_args()
    options.methods = [method for method in METHODS if method[0] in ("direct", *options.surfaces)]
    return options


class Renderer:
    def __init__(self, options, folder):
        self.folder = Path(folder)
        self.scenes = write_scenes(HERE / "teapot.toml", folder, {surface for surface, _ in options.methods})
        self.common = ["--size", options.size, "--sampler", options.sampler, "--device", options.device, "--quiet", "--strict"]
        self.references = [
            self.picture("direct", "mixture", options.reference_spp, seed, f"reference {seed}") for seed in REFERENCE_SEEDS
        ]
        self.between = mse(*self.references)

    def picture(self, surface, blend, spp, seed, name="picture"):
        path = self.folder / f"{name}.exr"
        run(GPT, "render", self.scenes[surface], "--blend", blend, "--spp", spp, "--seed", seed, *self.common, "-o", path)
        return path

    def error(self, surface, blend, spp, seed):
        picture = self.picture(surface, blend, spp, seed)
        return (sum(mse(picture, reference) for reference in self.references) - self.between) / 2


def mse(first, second):
    # 7: the pictures differ, as they should.
    return json.loads(run(GPT, "compare", first, second, "--metric", "mse", "--json", accepted=(0, 7)))["mse"]["all"]


def measure(options):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        renderer = Renderer(options, folder)
        for spp in options.spp:
            for number, (surface, blend) in enumerate(options.methods):
                first = 1 + (100 * number if options.own_seeds else 0)
                for seed in range(first, first + options.seeds):
                    error = renderer.error(surface, blend, spp, seed)
                    rows.append({"surface": surface, "blend": blend, "sampler": options.sampler, "size": options.size, "spp": spp, "seed": seed, "mse": error})
                print(f"{spp} samples per pixel, {surface}, {blend} done", file=sys.stderr)
            compare_to_direct([row for row in rows if row["spp"] == spp], options.own_seeds)
            write(options.output, rows)
        for surface, blend in options.methods[1:]:
            report_identity(renderer, surface, blend, options.spp[0])
    return rows


def compare_to_direct(rows, own_seeds):
    """Gives every row its ratio to the direct material's error with that seed, or to the mean of its errors."""
    direct = {row["seed"]: row["mse"] for row in rows if row["surface"] == "direct"}
    mean = statistics.fmean(direct.values())
    for row in rows:
        row["ratio"] = row["mse"] / (mean if own_seeds else direct[row["seed"]])


def report_identity(renderer, surface, blend, spp):
    direct = renderer.picture("direct", "mixture", spp, 1, "direct")
    equal = mse(direct, renderer.picture(surface, blend, spp, 1)) == 0
    print(f"same seed: {surface}, {blend} is {'the same picture bit for bit' if equal else 'another picture'}")


def write(path, rows):
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        table.writeheader()
        table.writerows({**row, "mse": f"{row['mse']:.5e}", "ratio": f"{row['ratio']:.5f}"} for row in rows)


def summarise(rows):
    print("| surface | blend | spp | MSE (median) | ratio to direct: median (least to largest) |\n| --- | --- | --- | --- | --- |")
    for spp in sorted({row["spp"] for row in rows}):
        for surface, blend in METHODS:
            found = [row for row in rows if (row["surface"], row["blend"], row["spp"]) == (surface, blend, spp)]
            if not found:
                continue
            ratios = [row["ratio"] for row in found]
            error = statistics.median(row["mse"] for row in found)
            print(f"| {surface} | {blend} | {spp} | {error:.3e} | {statistics.median(ratios):.4f} ({min(ratios):.4f} to {max(ratios):.4f}) |")


if __name__ == "__main__":
    summarise(measure(arguments()))
