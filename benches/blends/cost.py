#!/usr/bin/env python3
"""What does blending cost? Times of one picture with and without it.

The sphere (sphere.toml) is Lambert 0.8: directly, as the blend of white and black by 0.8, and as a blend of two greys by the facing
ratio, the blends with `--blend pick` and `--blend mixture`. The ways take turns, round after round, so that all of them meet the
machine in the same state. Two times are taken: seconds of rendering by the clock, and seconds that processors spent on the whole run,
which other programs on the machine disturb less.

Writes cost.csv (every run) and prints the medians of the ratios to the direct material of the same round, with the least and the
largest. Needs a built program and nothing beyond Python, on a system that counts processor time.
"""

import argparse
import csv
import json
import resource
import statistics
import sys
import tempfile
from pathlib import Path

from variants import GPT, HERE, run, write_scenes

METHODS = [
    ("direct", "mixture"),
    ("different colours", "pick"),
    ("different colours", "mixture"),
    ("facing", "pick"),
    ("facing", "mixture"),
]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, nargs="+", default=[64, 1024], help="samples per pixel (default: 64 1024)")
    parser.add_argument("--rounds", type=int, nargs="+", default=[7, 3], help="rounds at each of them (default: 7 3)")
    parser.add_argument("--size", default="650x540", help="size of the pictures (default: 650x540)")
    parser.add_argument("--device", default="auto", help="device (default: auto)")
    parser.add_argument("--output", type=Path, default=HERE / "cost.csv", help="the table to write (default: cost.csv beside this)")
    options = parser.parse_args()
    if len(options.rounds) != len(options.spp):
        parser.error("--rounds takes as many numbers as --spp")
    return options


def measure(options):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        scenes = write_scenes(HERE / "sphere.toml", folder, {surface for surface, _ in METHODS})
        for spp, rounds in zip(options.spp, options.rounds):
            for number in range(1, rounds + 1):
                direct = None
                for surface, blend in METHODS:
                    times = time_of(scenes[surface], blend, spp, options, Path(folder))
                    direct = direct or times
                    ratios = {f"{name} ratio": times[name] / direct[name] for name in times}
                    rows.append({"surface": surface, "blend": blend, "size": options.size, "spp": spp, "round": number, **times, **ratios})
                print(f"{spp} samples per pixel, round {number} of {rounds} done", file=sys.stderr)
                write(options.output, rows)
    return rows


def time_of(scene, blend, spp, options, folder):
    """Seconds of rendering and of processors."""
    report = folder / "stats.json"
    before = processor_seconds()
    run(
        GPT, "render", scene, "--blend", blend, "--spp", spp, "--size", options.size, "--device", options.device,
        "--quiet", "--strict", "--stats", report, "-o", folder / "picture.exr",
    )  # fmt: skip
    clock = json.loads(report.read_text(encoding="utf-8"))["seconds"]["render"]
    return {"clock": clock, "processors": processor_seconds() - before}


def processor_seconds():
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def write(path, rows):
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        table.writeheader()
        table.writerows({key: f"{value:.4f}" if isinstance(value, float) else value for key, value in row.items()} for row in rows)


def summarise(rows):
    print("| surface | blend | spp | rounds | by the clock | of processors |\n| --- | --- | --- | --- | --- | --- |")
    for spp in sorted({row["spp"] for row in rows}):
        for surface, blend in METHODS[1:]:
            found = [row for row in rows if (row["surface"], row["blend"], row["spp"]) == (surface, blend, spp)]
            columns = [spread([row[f"{name} ratio"] for row in found]) for name in ("clock", "processors")]
            print(f"| {surface} | {blend} | {spp} | {len(found)} | {' | '.join(columns)} |")


def spread(ratios):
    return f"{statistics.median(ratios):.3f} ({min(ratios):.3f} to {max(ratios):.3f})"


if __name__ == "__main__":
    summarise(measure(arguments()))
