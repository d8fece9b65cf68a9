#!/usr/bin/env python3
"""How near the default comes to the best fixed setting: error in equal time, on scenes people have.

  benches/defaults.py [SCENE…] [--seconds 1 10] [--seeds 4]     scenes of `SCENES`, or files; all of them by default
  benches/defaults.py --table RESULT.json…                      prints tables of results that are there already

Every setting renders for so many seconds of the clock (`--time-limit`), with what it learns and compiles, in turn, seed by seed. Its error is the
relative mean squared error about the mean of its own pictures, relative to the brightness that all settings found together. The score of a setting
is 1/(error × seconds), and the default's score is told as a share of the best fixed setting's. Where short renders have told which settings come
near, longer ones take the `--keep` best of them beside the default.

A best one out of many with few seeds is partly luck, so the share is a little too low; its range is from the scores of single seeds left out.

Run with a Python that has Mitsuba, which reads EXR files. Nothing else may run on the machine; scenes of target/scenes are made by benches/scenes/make.py.
"""

import argparse
import datetime
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import mitsuba as mi
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "benches" / "peers"))

import circumstances  # noqa: E402  neighbours' modules
import convergence  # noqa: E402

# Fixed settings: nothing is tried and nothing is chosen by the program. The default is tried beside them, with no option at all.
FIXED = ["--light-samples", "1", "--guiding", "off"]
SETTINGS = {
    "default": [],
    "one light sample": FIXED,
    "2 light samples": ["--light-samples", "2", "--guiding", "off"],
    "4 light samples": ["--light-samples", "4", "--guiding", "off"],
    "8 at 2 surfaces": ["--light-samples", "8", "--light-samples-depth", "2", "--guiding", "off"],
    "adaptive": [*FIXED, "--adaptive"],
    "2, adaptive": ["--light-samples", "2", "--guiding", "off", "--adaptive"],
    "lights by power": [*FIXED, "--light-choice", "power"],
    "guided by 16384": ["--light-samples", "1", "--guiding", "on", "--guiding-paths", "16384"],
    "guided": ["--light-samples", "1", "--guiding", "on"],
    "guided, adaptive": ["--light-samples", "1", "--guiding", "on", "--adaptive"],
}
# Built-in scenes by name, others by file; those that are absent are named and left out.
SCENES = [
    "cornell", "veach-mis", "spheres", "cellar", "bazaar", "terrace", "vitrine", "workshop", "gallery", "knot-plastic",
    *(f"benches/scenes/{name}.toml" for name in ("glass", "textured", "blend-rough", "blend-mirror", "ogre-area", "ogre-environment", "bunny-area", "bunny-environment")),
    *(f"target/scenes/{name}.toml" for name in ("lamps", "interior", "ajar", "sponza-like", "canopy", "foggy-room", "cloud", "milk")),
]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", help="built-in names or files")
    parser.add_argument("--seconds", type=float, nargs="+", default=[1.0, 10.0], help="lengths of renders, rising (default: 1 10)")
    parser.add_argument("--seeds", type=int, nargs="+", default=[5, 3], help="replications for each length, the last one for all that follow (default: 5 3)")
    parser.add_argument("--keep", type=int, default=4, help="settings beside the default that longer renders try (default: 4)")
    parser.add_argument("--settings", nargs="+", choices=list(SETTINGS), default=list(SETTINGS), metavar="SETTING", help=f"out of: {'; '.join(SETTINGS)}")
    parser.add_argument("--size", default="256x192")
    parser.add_argument("--gpt", type=Path, default=ROOT / "target" / "release" / "gpt")
    parser.add_argument("--json", type=Path, default=Path("defaults.json"))
    parser.add_argument("--table", type=Path, nargs="+", metavar="RESULT", help="prints tables of results and renders nothing")
    return parser.parse_args()


class Trial:
    """A scene, rendered by settings in turn."""

    def __init__(self, options, scene, folder):
        self.options, self.scene, self.folder = options, scene, folder

    def render(self, setting, seconds, seed):
        """The picture, the seconds it took from start to end, samples per pixel, and what the program decided."""
        picture, figures = self.folder / "picture.exr", self.folder / "figures.json"
        command = [self.options.gpt, "render", self.scene, "--size", self.options.size, "--seed", str(seed), "--quiet", "--spp", "1000000"]
        command += ["--time-limit", str(seconds), "-o", picture, "--stats", figures, *SETTINGS[setting]]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(f"{self.scene}, {setting}: {done.stderr}")
        told = json.loads(figures.read_text(encoding="utf-8"))
        pixels = np.array(mi.Bitmap(str(picture)), dtype=np.float64)[..., :3]
        spent = told["seconds"]
        decisions = [f"{each['about']}: {each['choice']}, {each['because']}" for each in told["decisions"] if each["about"] in ("directions", "light choice", "light samples")]
        self.device = told["device"]
        return pixels, spent["total"] - spent["write"], told["samples"] / pixels[..., 0].size, decisions

    def measure(self, settings, seconds, seeds):
        """Errors, seconds and samples of every setting, one number a seed."""
        pictures = {setting: [] for setting in settings}
        found = {setting: {"seconds": [], "spp": []} for setting in settings}
        for setting in settings:
            # Kernels are compiled and kept by the driver; which ones depends on what is decided, and that on the length.
            self.render(setting, seconds, 1000)
        for seed in range(seeds):
            for setting in settings:
                picture, taken, spp, decisions = self.render(setting, seconds, seed)
                pictures[setting].append(picture)
                found[setting]["seconds"].append(taken)
                found[setting]["spp"].append(spp)
                found[setting]["decisions"] = decisions
        stacks = {setting: np.stack(made) for setting, made in pictures.items()}
        bright = convergence.brightness(list(stacks.values()))
        for setting, made in stacks.items():
            found[setting]["relmse"] = convergence.relative_errors(made, bright).tolist()
        return found


def score(found, without=None):
    """1/(error × seconds), of all seeds or of all but one."""
    kept = [at for at in range(len(found["relmse"])) if at != without]
    return 1 / (np.mean([found["relmse"][at] for at in kept]) * np.mean([found["seconds"][at] for at in kept]))


def share(settings):
    """The default's score over that of the best fixed setting, its name, and the range with each seed left out."""
    fixed = [name for name in settings if name != "default"]
    best = max(fixed, key=lambda name: score(settings[name]))
    seeds = len(settings["default"]["relmse"])
    without = [score(settings["default"], at) / score(settings[best], at) for at in range(seeds)] if seeds > 2 else []
    ratio = score(settings["default"]) / score(settings[best])
    return ratio, best, min([*without, ratio]), max([*without, ratio])


def table(report):
    lines = ["| scene | seconds | default over best (range) | best fixed setting | default: relMSE, samples a pixel | best: relMSE, samples a pixel |", "| --- | --- | --- | --- | --- | --- |"]
    for scene, lengths in report["scenes"].items():
        for seconds, settings in lengths.items():
            ratio, best, least, most = share(settings)
            told = [f"{np.mean(settings[name]['relmse']):.2e}, {np.mean(settings[name]['spp']):.0f}" for name in ("default", best)]
            lines.append(f"| {scene} | {seconds} | {ratio:.2f} ({least:.2f}–{most:.2f}) | {best} | {told[0]} | {told[1]} |")
    return "\n".join(lines)


def main():
    options = arguments()
    if options.table:
        for path in options.table:
            report = json.loads(path.read_text(encoding="utf-8"))
            for name, part in ({"": report} if "scenes" in report else report).items():
                print(f"{name}\n\n{table(part)}\n")
        return
    mi.set_variant("scalar_rgb")
    version = subprocess.run([options.gpt, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]
    report = {"date": datetime.date.today().isoformat(), "version": version, "machine": circumstances.machine()}
    report |= {"size": options.size, "settings": {name: " ".join(SETTINGS[name]) for name in options.settings}, "scenes": {}}
    with tempfile.TemporaryDirectory() as folder:
        for scene in options.scenes or SCENES:
            path = scene
            if scene.endswith(".toml") and not Path(scene).is_file():
                path = ROOT / scene
                if not path.is_file():
                    print(f"{scene}: left out, it is not there", file=sys.stderr)
                    continue
            trial, settings, lengths = Trial(options, path, Path(folder)), list(options.settings), {}
            for at, seconds in enumerate(options.seconds):
                found = trial.measure(settings, seconds, options.seeds[min(at, len(options.seeds) - 1)])
                lengths[f"{seconds:g}"] = found
                ranking = sorted((name for name in settings if name != "default"), key=lambda name: -score(found[name]))
                said = "  ".join(f"{name} {score(found[name]) / score(found['default']):.2f}" for name in ranking)
                print(f"{Path(scene).stem:18s} {seconds:4g} s  default/best {share(found)[0]:.2f}   {said}", file=sys.stderr, flush=True)
                # A guide may pay in longer renders where it does not in short ones.
                settings = ["default", *ranking[: options.keep], *(name for name in ("guided",) if name in settings and name not in ranking[: options.keep])]
            report["device"] = trial.device
            report["scenes"][Path(scene).stem] = lengths
            options.json.write_text(json.dumps(report, indent=1), encoding="utf-8")
    print(table(report))


if __name__ == "__main__":
    main()
