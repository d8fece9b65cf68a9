#!/usr/bin/env python3
"""Time to equal error of gpt, Mitsuba 3, Blender's Cycles and LuxCore, side by side, on scenes that they define alike.

For every scene: each renderer loads it, tries its settings (samplers, ways to choose lights) and keeps the one with the least error ×
time; then all render in turn, seed by seed, at three sample counts that take a quarter, half and the whole of --seconds. From the
pictures follows every renderer's error at its times, from those the times to an equal error (convergence.py). Times are of rendering
alone, without loading, building and compiling, as every renderer reports it.

A ratio is given only where the means agree (agreement.py), with a negative control, which pictures of half the size with more samples are
rendered for; what a renderer models differently is not rendered.

Run with the Python that has Mitsuba. Exit status: 0, or 7 where means differ.
"""

import argparse
import datetime
import json
import math
import os
import sys
import tempfile
import time
from dataclasses import asdict
from pathlib import Path

import mitsuba as mi
import numpy as np

import circumstances
import convergence
import scenes
import table
from agreement import judge
from process import HERE, PeerError, Process

# Enough for Welch's t to find 1 % of energy.
AGREEMENT_SEEDS = 6
# Of each verdict; there are some forty in a run, and hardly one of them should be wrong.
AGREEMENT_LEVEL = 0.001
# What relative difference of means is not judged: rounding.
DEFAULT_ALLOWED = (1e-4, "")
PEERS = ["mitsuba-llvm", "mitsuba-scalar", "cycles", "luxcore"]
# gpt as a user has it without asking for anything, and at the best of its settings. The first that runs is whose pictures others are compared with.
WAYS = {"default": "gpt-default", "best": "gpt"}
# Added to the seed of the default's pictures, so that they share no random numbers with those of the best setting.
OWN_SEEDS = {"gpt-default": 500}


def is_gpt(key):
    return key in WAYS.values()


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", help=f"names out of: {', '.join(scenes.ALL)} (default: all)")
    parser.add_argument("--peers", nargs="+", default=PEERS, choices=PEERS)
    parser.add_argument("--ways", nargs="+", default=list(WAYS), choices=list(WAYS), help="gpt with its defaults, at its best setting, or both (default: both)")
    parser.add_argument("--seconds", type=float, default=1.2, help="of the longest render of each renderer (default: 1.2)")
    parser.add_argument("--choose-seconds", type=float, help="of the renders by which a renderer's setting is chosen (default: a quarter of --seconds)")
    parser.add_argument("--seeds", type=int, default=5, help="replications, at least 3 (default: 5)")
    parser.add_argument("--agreement-spp", type=int, default=48, help="samples per pixel of each of the pictures whose means are compared, four times as many from gpt (default: 48)")
    parser.add_argument("--gpt", type=Path, default=HERE.parents[1] / "target" / "release" / "gpt", help="the program")
    parser.add_argument("--settings", nargs="+", help="the settings of gpt that are tried, by name (default: all)")
    parser.add_argument("--device", default="auto", help="gpt's device (default: auto)")
    parser.add_argument("--cycles-python", default=os.environ.get("GPT_CYCLES_PYTHON", sys.executable), help="the Python that has bpy (default: $GPT_CYCLES_PYTHON, else this one)")
    parser.add_argument("--json", type=Path, default=Path("peers.json"), help="all numbers (default: peers.json)")
    parser.add_argument("--markdown", type=Path, default=Path("peers.md"), help="the tables (default: peers.md)")
    parser.add_argument("--pictures", type=Path, help="folder for a PNG of every scene, renderer beside renderer")
    options = parser.parse_args()
    if options.seeds < 3:
        parser.error("--seeds must be at least 3")
    if options.choose_seconds is not None and not options.choose_seconds > 0:
        parser.error("--choose-seconds must be above 0")
    unknown = [name for name in options.scenes if name not in scenes.ALL]
    if unknown:
        parser.error(f"there is no scene {unknown[0]!r}; choose from {', '.join(scenes.ALL)}")
    return options


def processes(options, folder):
    python = [sys.executable]
    commands = {
        **{key: [*python, "worker_gpt.py", options.gpt.resolve(), options.device, way] for way, key in WAYS.items()},
        "mitsuba-llvm": [*python, "worker_mitsuba.py", "llvm_ad_rgb", options.gpt.resolve()],
        "mitsuba-scalar": [*python, "worker_mitsuba.py", "scalar_rgb", options.gpt.resolve()],
        "cycles": [options.cycles_python, "worker_cycles.py"],
        "luxcore": [*python, "worker_luxcore.py"],
    }
    return {key: Process(key, commands[key], folder) for key in [*(key for way, key in WAYS.items() if way in options.ways), *options.peers]}


def say(text):
    print(text, file=sys.stderr, flush=True)


class Contestant:
    """A renderer in one scene, with all that it has rendered."""

    def __init__(self, process, path, size, wanted):
        self.process, self.samples = process, {}
        process.start()
        loading = process.load(path, size)
        known = process.settings()
        unknown = [setting for setting in wanted or [] if setting not in known]
        if unknown:
            raise PeerError(f"there is no setting {unknown[0]!r}; choose from {'; '.join(known)}")
        self.settings = wanted or known
        first, again = (process.render(self.settings[0], 1, seed) for seed in range(2))
        # gpt is started anew for every picture; its first one filled the driver's cache of kernels.
        self.start_up = again["wall"] if is_gpt(process.key) else process.seconds_to_start + loading + first["wall"]
        # Of a render of no samples at all, by those of 1 and 4.
        more = process.render(self.settings[0], 4, 2)
        self.idle_cpu = again["cpu"] - (more["cpu"] - again["cpu"]) / (more["spp"] - again["spp"])

    def power_for(self, setting, seconds):
        """Of the sample count, a power of two, whose render takes about that long with what it learns, at least 2."""
        power = 2
        while True:
            found = self.process.render(setting, 1 << power, 90)
            taken = max(found["seconds"] - found["learning"], 1e-3)
            left = max(seconds - found["learning"], taken)
            if taken > left / 3 or power >= 16:
                return max(2, power + round(math.log2(left / taken)))
            power += max(1, math.floor(math.log2(left / 2 / taken)))

    def choose(self, seconds, choose_seconds, settings, known):
        """Keeps the setting with the least error × time, after two renders of `choose_seconds` with each, and the ladder of sample counts. Learning counts
        with the share that it has in a render of `seconds`. `known` is the reference, or None where there is none yet; with too few samples to meet a
        light at all, a renderer's own pictures scatter too little."""
        costs = {}
        power = self.power_for(settings[0], seconds)
        self.choosing = 1 << max(0, power + round(math.log2(choose_seconds / seconds)))
        if len(settings) > 1:
            tries = {setting: [self.process.render(setting, self.choosing, 91 + seed) for seed in range(2)] for setting in settings}
            pictures = {setting: np.stack([found["picture"] for found in made]).astype(np.float64) for setting, made in tries.items()}
            brightness = None if known else convergence.brightness(list(pictures.values()))
            for setting, made in tries.items():
                errors = known.errors(pictures[setting]) if known else convergence.relative_errors(pictures[setting], brightness)
                seconds_taken = [found["seconds"] - found["learning"] * (1 - self.choosing / (1 << power)) for found in made]
                costs[setting] = float(errors.mean() * np.mean(seconds_taken))
        self.costs = costs
        self.setting = min(costs, key=costs.get) if costs else settings[0]
        if self.setting != settings[0]:
            power = self.power_for(self.setting, seconds)
        # What is compiled for a sample count is compiled now. Some samplers round the count: no step is taken twice.
        self.ladder = sorted({round(self.process.prepare(self.setting, 1 << (power - back))) for back in range(3)})

    def render(self, spp, seed):
        found = self.process.render(self.setting, spp, seed + OWN_SEEDS.get(self.process.key, 0))
        if not np.isfinite(found["picture"]).all():
            raise PeerError(f"{self.process.key} made pixels that are not finite")
        self.samples.setdefault(found["spp"], []).append(found)

    def levels(self, known):
        made = []
        for spp, found in sorted(self.samples.items()):
            pictures = np.stack([each["picture"] for each in found]).astype(np.float64)
            seconds = np.array([each["seconds"] for each in found])
            own = is_gpt(self.process.key)
            made.append(convergence.Level(spp, seconds, convergence.relative_errors(pictures, known.brightness) if own else known.errors(pictures)))
        return made

    def cpu_seconds(self, levels):
        """Processor seconds of every level, without what a render takes before its first sample."""
        return [np.maximum([each["cpu"] - self.idle_cpu for each in self.samples[level.spp]], 1e-3) for level in levels]

    def replications(self):
        """One picture a seed, all its sample counts together."""
        weights = np.array(sorted(self.samples), dtype=float)
        by_seed = zip(*(self.samples[spp] for spp in sorted(self.samples)), strict=False)
        return np.stack([np.average([each["picture"] for each in row], axis=0, weights=weights) for row in by_seed]).astype(np.float64)


def enter(name, scene, path, options, running):
    """The renderers that take part in the scene, ready to render."""
    ready, chosen, known = {}, None, None
    for key, process in running.items():
        reason = scene.without.get(key)
        if reason:
            say(f"  {key}: left out, {reason}")
            continue
        try:
            contestant = Contestant(process, path, scene.size, options.settings if key == "gpt" else None)
            # The scalar variant is the same renderer with the same points, only slower: it takes what the fast one chose.
            settings = [chosen] if key == "mitsuba-scalar" and chosen else contestant.settings
            settings = [setting for setting in settings if setting not in scene.biased.get(key, ())]
            contestant.choose(options.seconds, options.choose_seconds or options.seconds / 4, settings, known)
        except PeerError as error:
            say(f"  {key}: left out of {name}: {error}")
            continue
        if is_gpt(key) and known is None:
            # Four times the samples of the pictures that are judged by it, and no more than are rendered anyway.
            enough = next((spp for spp in contestant.ladder if spp >= 4 * contestant.choosing), contestant.ladder[-1])
            tries = [process.render(contestant.setting, enough, 95 + seed)["picture"] for seed in range(3)]
            known = convergence.reference(np.stack(tries).astype(np.float64))
        if key == "mitsuba-llvm":
            chosen = contestant.setting
        ready[key] = contestant
        say(f"  {key}: {contestant.setting}, up to {contestant.ladder[-1]} spp, start-up {contestant.start_up:.2f} s")
    return ready


def measure(name, scene, path, options, running):
    """Everything known of the scene afterwards."""
    say(f"{name}")
    ready = enter(name, scene, path, options, running)
    if not any(is_gpt(key) for key in ready):
        raise PeerError(f"gpt did not render {name}")
    for seed in range(options.seeds):
        for step in range(3):
            for key, contestant in list(ready.items()):
                if step >= len(contestant.ladder):
                    continue
                try:
                    contestant.render(contestant.ladder[step], seed)
                except PeerError as error:
                    say(f"  {key}: left out of {name}: {error}")
                    del ready[key]
    return evaluate(scene, ready, agreements(scene, path, options, ready))


def agreements(scene, path, options, ready):
    """The judgement on every peer's means, from pictures of half the size."""
    found, ours = {}, None
    for key, contestant in ready.items():
        if is_gpt(key) and ours is not None:
            continue
        contestant.process.load(path, [side // 2 for side in scene.size])
        spp = options.agreement_spp * (4 if is_gpt(key) else 1)
        pictures = [contestant.process.render(contestant.setting, spp, 1000 + seed)["picture"] for seed in range(AGREEMENT_SEEDS)]
        pictures = np.stack(pictures).astype(np.float64)
        if is_gpt(key):
            ours = pictures
        else:
            found[key] = judge(ours, pictures, AGREEMENT_LEVEL, scene.allowed.get(key, DEFAULT_ALLOWED)[0])
    return found


def evaluate(scene, ready, judgements):
    replications = {key: contestant.replications() for key, contestant in ready.items()}
    ours = [key for key in ready if is_gpt(key)]
    alike = [pictures for key, pictures in replications.items() if is_gpt(key) or judgements[key].verdict != "differ"]
    known = convergence.reference(np.concatenate([replications[key] for key in ours]), convergence.brightness(alike))
    levels = {key: contestant.levels(known) for key, contestant in ready.items()}
    result = {"size": list(scene.size), "left_out": scene.without, "renderers": {}, "pairs": {}}
    for key, contestant in ready.items():
        result["renderers"][key] = {
            "setting": contestant.setting,
            "costs_of_settings": contestant.costs,
            "start_up_seconds": contestant.start_up,
            "slope": convergence.slope(levels[key]),
            "levels": [{"spp": level.spp, "seconds": level.seconds.tolist(), "relmse": level.errors.tolist()} for level in levels[key]],
        }
        if is_gpt(key):
            continue
        offset, reason = scene.allowed.get(key, DEFAULT_ALLOWED)
        judgement = judgements[key]
        result["pairs"][key] = {
            "agreement": asdict(judgement),
            "allowed_difference": offset,
            "allowed_because": reason,
            "ratios": {way: ratios(key, way, ready, levels) for way in ours},
        }
        taken = "; ".join(f"{found['median']:.2f} ({found['least']:.2f}–{found['largest']:.2f}) times the time of {way}" for way, found in result["pairs"][key]["ratios"].items())
        say(f"  {key}: {judgement.verdict} ({judgement.channels} channels, {judgement.tiles} tiles rejected), channels {', '.join(f'{d:+.2%}' for d in judgement.difference)}; takes {taken}")
    result["pictures"] = {key: pictures.mean(axis=0) for key, pictures in replications.items()}
    return result


def ratios(peer, way, ready, levels):
    """The peer's time over gpt's at an equal error: of rendering, of processor time, and with start-up."""
    ratio = convergence.ratio(levels[way], levels[peer])
    cpu = [convergence.time_to(levels[each], ratio.error, ready[each].cpu_seconds(levels[each])) for each in (peer, way)]
    whole = [np.median(convergence.time_to(levels[each], ratio.error)) + ready[each].start_up for each in (peer, way)]
    return asdict(ratio) | {"processor": float(np.median(cpu[0] / cpu[1])), "with_start_up": float(whole[0] / whole[1])}


def main():
    mi.set_variant("scalar_rgb")
    options = arguments()
    start = time.perf_counter()
    report = {"date": datetime.date.today().isoformat(), "machine": circumstances.machine(), "device": circumstances.device(options.gpt, options.device), "seconds": options.seconds, "seeds": options.seeds, "absent": {}, "scenes": {}}
    with tempfile.TemporaryDirectory() as folder:
        running = processes(options, folder)
        for key, process in list(running.items()):
            try:
                process.start()
            except (PeerError, OSError) as error:
                report["absent"][key] = str(error)
                say(f"{key} cannot be started and is left out: {error}")
                del running[key]
        report["versions"] = {key: process.about for key, process in running.items()}
        for name in options.scenes or scenes.ALL:
            scene = scenes.ALL[name]
            path = scene.prepare(Path(folder), say)
            if path is None:
                report["absent"][name] = "its model is not there"
                continue
            result = measure(name, scene, path, options, running)
            pictures = result.pop("pictures")
            if options.pictures:
                table.write_pictures(options.pictures / f"{name}.png", pictures)
            report["scenes"][name] = result
            report["minutes"] = (time.perf_counter() - start) / 60
            options.json.write_text(json.dumps(report, indent=1), encoding="utf-8")
            options.markdown.write_text(table.markdown(report), encoding="utf-8")
        for process in running.values():
            process.stop()
    print(table.markdown(report))
    differ = [f"{name}/{key}" for name, found in report["scenes"].items() for key, pair in found["pairs"].items() if pair["agreement"]["verdict"] == "differ"]
    if differ:
        say(f"means differ: {', '.join(differ)}")
    return 7 if differ else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (PeerError, OSError) as error:
        sys.exit(f"compare.py: {error}")
