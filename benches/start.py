#!/usr/bin/env python3
"""How long it takes until a first picture is there: seconds of the clock from the start of the program to the written picture of one sample a pixel.

  benches/start.py [SCENE…] [--rounds 3] [--size 256x256] [--json start.json]

Each round renders every scene with an empty cache of the driver's kernels, then with the cache that this filled. Nothing else may run on the machine.
"""

import argparse
import datetime
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "benches/peers"))

import circumstances  # noqa: E402  a neighbour's module

SCENES = ["cornell", "veach-mis", "workshop", "target/scenes/sponza-like.toml"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--size", default="256x256")
    parser.add_argument("--gpt", type=Path, default=ROOT / "target/release/gpt")
    parser.add_argument("--json", type=Path, default=Path("start.json"))
    return parser.parse_args()


def seconds(options, scene, cache, picture):
    environment = os.environ | {"MESA_SHADER_CACHE_DIR": cache, "XDG_CACHE_HOME": cache}
    command = [options.gpt, "render", scene, "--size", options.size, "--spp", "1", "-o", picture, "--quiet"]
    start = time.perf_counter()
    subprocess.run(command, check=True, env=environment, stderr=subprocess.DEVNULL)
    return round(time.perf_counter() - start, 3)


def main():
    options = arguments()
    found = {scene: {"cold": [], "warm": []} for scene in options.scenes}
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.exr"
        for _ in range(options.rounds):
            for scene, times in found.items():
                with tempfile.TemporaryDirectory() as cache:
                    for kind in ("cold", "warm"):
                        times[kind].append(seconds(options, scene, cache, picture))
                print(scene, times, file=sys.stderr)
    rows = [{"scene": Path(scene).stem, **times} for scene, times in found.items()]
    report = {"date": datetime.date.today().isoformat(), "machine": circumstances.machine(), "device": circumstances.device(options.gpt), "size": options.size, "scenes": rows}
    options.json.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
