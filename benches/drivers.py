#!/usr/bin/env python3
"""One program on several releases of a driver: rendering time of each scene, in turn.

  benches/drivers.py NAME=ROOT NAME=ROOT… [--scenes SCENE…] [--rounds 3]
  benches/drivers.py --table RESULT.json                        prints the table of a result that is there already

A ROOT is a folder with a system of its own that has the driver, `/` for this machine's; debootstrap makes one:

  debootstrap --variant=minbase --include=libvulkan1,mesa-vulkan-drivers trixie ROOT http://deb.debian.org/debian

The checkout is bound into each root, read only, for the time of the run, which takes root's rights. All drivers render the same samples with the same
fixed setting, so that nothing is learned and nothing is chosen. Each scene gets so many samples that the first driver takes about `--seconds`; a first
render, which is not counted, leaves the compiled kernels in the driver's cache. Told are the seconds of rendering by the clock and of processor time,
median and range over the rounds, and the ratio to the first driver's in the same round.

Nothing else may run on the machine; scenes of target/scenes are made by benches/scenes/make.py.
"""

import argparse
import contextlib
import datetime
import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FIXED = ["--light-samples", "1", "--guiding", "off"]
SCENES = [
    "cornell", "veach-mis", "cellar", "bazaar",
    *(f"benches/scenes/{name}.toml" for name in ("glass", "textured", "blend-rough", "ogre", "ogre-area", "ogre-environment", "bunny-area", "bunny-environment")),
    *(f"target/scenes/{name}.toml" for name in ("lamps", "interior", "ajar", "sponza-like", "canopy", "foggy-room", "cloud", "milk")),
]
PILOT_SAMPLES = 4


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drivers", nargs="*", metavar="NAME=ROOT", help="drivers by the names of the table, the first one is the measure")
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=1.5)
    parser.add_argument("--size", default="256x192")
    parser.add_argument("--gpt", type=Path, default=ROOT / "target" / "release" / "gpt")
    parser.add_argument("--bind", type=Path, nargs="+", default=[], metavar="FOLDER", help="further folders that scenes take files from")
    parser.add_argument("--json", type=Path, default=Path("drivers.json"))
    parser.add_argument("--table", type=Path, metavar="RESULT", help="prints the table of a result and renders nothing")
    return parser.parse_args()


@contextlib.contextmanager
def bound(root, folders):
    """The folders, read only, and what a driver reads of the kernel, inside of a root; nothing to do for `/`."""
    if root == Path("/"):
        yield
        return
    mounted = []
    try:
        for source in [Path("/proc"), Path("/dev"), *folders]:
            target = root / source.relative_to("/")
            if os.path.ismount(target):
                continue
            target.mkdir(parents=True, exist_ok=True)
            subprocess.run(["mount", "--bind", str(source), str(target)], check=True)
            mounted.append(target)
            if source in folders:
                subprocess.run(["mount", "-o", "remount,ro,bind", str(target)], check=True)
        yield
    finally:
        for target in reversed(mounted):
            subprocess.run(["umount", str(target)], check=False)


class Driver:
    def __init__(self, word):
        self.name, _, root = word.partition("=")
        if not root or not Path(root).is_dir():
            sys.exit(f"drivers.py: `{word}` is no NAME=ROOT with a folder as ROOT")
        self.root = Path(root).resolve()

    def command(self, options, *words):
        chroot = [] if self.root == Path("/") else ["chroot", str(self.root), "/usr/bin/env", "-C", str(ROOT)]
        return [*chroot, str(options.gpt.resolve()), *words]

    def identity(self, options):
        """What the program says about the device that it would take."""
        listed = subprocess.run(self.command(options, "devices", "--json"), capture_output=True, text=True, cwd=ROOT, check=True)
        chosen = [device for device in json.loads(listed.stdout) if device.get("chosen_by_auto")]
        if not chosen or chosen[0]["kind"] != "software":
            sys.exit(f"drivers.py: {self.name}: no software driver that gpt takes:\n{listed.stdout}")
        return chosen[0]["driver"]

    def render(self, options, scene, samples):
        """Seconds of rendering by the clock, processor seconds of the whole program."""
        inside = self.root / "tmp"
        with tempfile.TemporaryDirectory(dir=inside) as folder:
            seen = "/" / Path(folder).relative_to(self.root)
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            words = ["render", scene, "--size", options.size, "--spp", str(samples), *FIXED, "-q", "-o", f"{seen}/a.exr", "--stats", f"{seen}/a.json"]
            done = subprocess.run(self.command(options, *words), capture_output=True, text=True, cwd=ROOT, check=False)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            if done.returncode != 0:
                sys.exit(f"drivers.py: {self.name}, {scene}: {done.stderr}")
            figures = json.loads((Path(folder) / "a.json").read_text())
        return figures["seconds"]["render"], after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(options, drivers):
    rows = []
    for scene in options.scenes:
        if "/" in scene and not (ROOT / scene).is_file():
            print(f"drivers.py: {scene} is absent (benches/scenes/make.py makes it)", file=sys.stderr)
            continue
        # Compiles.
        for driver in drivers:
            driver.render(options, scene, PILOT_SAMPLES)
        seconds, _ = drivers[0].render(options, scene, PILOT_SAMPLES)
        samples = max(PILOT_SAMPLES, round(PILOT_SAMPLES * options.seconds / seconds))
        for driver in drivers:
            driver.render(options, scene, samples)
        rounds = [[driver.render(options, scene, samples) for driver in drivers] for _ in range(options.rounds)]
        rows.append({"scene": Path(scene).stem, "samples": samples, "rounds": rounds})
        print(row_of_table(rows[-1]), flush=True)
    return rows


def row_of_table(row):
    """Ratios to the first driver: seconds of the clock, then of processor time; medians and ranges over the rounds."""
    cells = []
    for index in range(len(row["rounds"][0])):
        if index == 0:
            wall = [turn[0][0] for turn in row["rounds"]]
            cells.append(f"{statistics.median(wall):.2f} s")
            continue
        for kind in (0, 1):
            ratios = [turn[index][kind] / turn[0][kind] for turn in row["rounds"]]
            cells.append(f"{statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f})")
    return f"| {row['scene']} | {row['samples']} | " + " | ".join(cells) + " |"


def table(result):
    others = [cell for driver in result["drivers"][1:] for cell in (f"{driver['name']}, clock", f"{driver['name']}, processor")]
    heads = ["scene", "spp", result["drivers"][0]["name"], *others]
    print("| " + " | ".join(heads) + " |\n|" + " --- |" * len(heads))
    for row in result["rows"]:
        print(row_of_table(row))
    for index, driver in enumerate(result["drivers"][1:], start=1):
        for kind, word in ((0, "clock"), (1, "processor")):
            ratios = [statistics.median(turn[index][kind] / turn[0][kind] for turn in row["rounds"]) for row in result["rows"]]
            print(f"{driver['name']}: geometric mean of {word} seconds {statistics.geometric_mean(ratios):.3f} of {result['drivers'][0]['name']}")


def main():
    options = arguments()
    if options.table:
        table(json.loads(options.table.read_text()))
        return
    if len(options.drivers) < 2:
        sys.exit("drivers.py: give two drivers or more as NAME=ROOT")
    drivers = [Driver(word) for word in options.drivers]
    with contextlib.ExitStack() as stack:
        for driver in drivers:
            stack.enter_context(bound(driver.root, [ROOT, *(folder.resolve() for folder in options.bind)]))
        facts = [{"name": driver.name, "driver": driver.identity(options)} for driver in drivers]
        version = subprocess.run([options.gpt, "--version"], capture_output=True, text=True, check=True).stdout.strip()
        result = {
            "version": version,
            "date": datetime.date.today().isoformat(),
            "machine": f"{platform.machine()}, {os.cpu_count()} cores",
            "size": options.size,
            "setting": " ".join(FIXED),
            "drivers": facts,
            "rows": measure(options, drivers),
        }
    options.json.write_text(json.dumps(result, indent=1) + "\n")
    table(result)


main()
