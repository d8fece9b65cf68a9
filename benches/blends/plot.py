#!/usr/bin/env python3
"""Draws noise.csv, as noise.py writes it, as docs/blends.svg: the mean squared error against the samples per pixel. Needs matplotlib."""

import csv
import statistics
from collections import defaultdict

import matplotlib

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402  the backend comes first

from variants import HERE  # noqa: E402

# Where curves lie on each other, the later is drawn narrower, so that both are seen.
STYLES = {
    ("direct", "mixture"): ("Lambert 0.8 itself", dict(color="#888888", linewidth=7)),
    ("different colours", "mixture"): ("0.8 white + 0.2 black, mixture", dict(color="#1f77b4", linewidth=3.5)),
    ("same colours", "mixture"): ("0.5 + 0.5 of the same, mixture", dict(color="#2ca02c", linewidth=1.5, marker="s")),
    ("same colours", "pick"): ("0.5 + 0.5 of the same, pick", dict(color="#ff7f0e", linestyle="--", marker="x")),
    ("different colours", "pick"): ("0.8 white + 0.2 black, pick", dict(color="#d62728", linewidth=1.5, marker="o")),
}


def main():
    errors = defaultdict(list)
    with (HERE / "noise.csv").open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            errors[row["surface"], row["blend"], int(row["spp"])].append(float(row["mse"]))
    matplotlib.rcParams["svg.hashsalt"] = "blends"  # the same file from the same data
    figure, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    for method, (label, style) in STYLES.items():
        counts = sorted(spp for *found, spp in errors if tuple(found) == method)
        axes.loglog(counts, [statistics.median(errors[*method, spp]) for spp in counts], label=label, **style)
    counts = sorted({spp for *_, spp in errors})
    axes.set_xticks(counts, [str(count) for count in counts])
    axes.minorticks_off()
    axes.set_xlabel("samples per pixel")
    axes.set_ylabel("mean squared error (median of the seeds)")
    axes.legend()
    figure.savefig(HERE.parents[1] / "docs" / "blends.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
