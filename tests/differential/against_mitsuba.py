#!/usr/bin/env python3
"""Renders small scenes of Mitsuba's XML here and by Mitsuba 3 itself, and says which of them agree.

  against_mitsuba.py                     every scene
  against_mitsuba.py bitmap cube         those whose names hold one of these words
  against_mitsuba.py --list              names alone
  against_mitsuba.py --keep FOLDER       scenes, pictures and a report stay there; Mitsuba's pictures are taken from there again
  against_mitsuba.py --markdown FILE     writes the table of a document
  against_mitsuba.py --quick             few samples, and no controls: what differs by much

Each scene is held against Mitsuba's picture of it by z-tests (judge.py). Three controls belong to that: 5 % more light has to be found in each
scene that agrees; Mitsuba's own picture has to change with the parameter that the scene is about; and the small changes of mitsuba_scenes/planted.py have to be
found. coverage.py holds the scenes against the words of the importer's source.

Exit status 0 if each scene comes out as known_mitsuba.py says it does and all controls hold, 7 otherwise.
"""

import argparse
import collections
import concurrent.futures
import dataclasses
import hashlib
import json
import multiprocessing
import os
import re
import sys
import tempfile
import traceback
from dataclasses import asdict, dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import numpy

import coverage
import judge
import table
from known_mitsuba import KNOWN, NOT_IN_SCENES
from mitsuba_scenes import bsdfs, documents, emitters, files, media, sensors, shapes, textures
from mitsuba_scenes.planted import PLANTED
from programs import ROOT, Gpt

MODULES = (bsdfs, textures, emitters, shapes, sensors, media, documents)
# Numbers for a scene at first, and where something is in doubt: renders of Mitsuba's, samples of a pixel in each, and ours in all.
STAGES = ((16, 16, 256), (32, 48, 1536))
# Passes of one render have seeds that follow each other, and must not be those of the next render.
SEEDS_APART = 10_000
# Differences that no chance explains are not rendered again.
PLAIN = 100.0
# More light than a test may overlook.
CONTROL = 1.05
# Mitsuba's threads do not survive a fork.
SPAWN = multiprocessing.get_context("spawn")


@dataclass
class Result:
    name: str
    verdict: str = ""
    z: float = 0.0
    difference: list = field(default_factory=list)
    warnings: list = field(default_factory=list)
    error: str = ""
    their_error: str = ""
    file: str = ""


class Mitsuba:
    """Pictures by Mitsuba, kept in a folder by what was asked."""

    def __init__(self, folder):
        import mitsuba

        mitsuba.set_variant("scalar_rgb")
        mitsuba.set_log_level(mitsuba.LogLevel.Error)
        # Two programs share the cores, each with as many processes as there are cores.
        mitsuba.Thread.set_thread_count(1) if hasattr(mitsuba.Thread, "set_thread_count") else None
        self.mitsuba, self.folder = mitsuba, folder
        folder.mkdir(parents=True, exist_ok=True)

    def render(self, scene, text, stage, definitions=()):
        key = hashlib.sha256(f"{self.mitsuba.__version__} {STAGES[stage]} {files.version(scene.parent, text)} {definitions} {text}".encode()).hexdigest()[:24]
        kept = self.folder / f"{key}.npy"
        if kept.exists():
            return judge.of_replications(numpy.load(kept))
        renders, samples, _ = STAGES[stage]
        loaded = self.mitsuba.load_file(str(scene), **dict(definitions))
        pictures = []
        for seed in range(renders):
            picture = numpy.array(self.mitsuba.render(loaded, spp=samples, seed=SEEDS_APART * seed + stage), numpy.float64)
            pictures.append(picture[:, :, :3])
        pictures = numpy.array(pictures)
        unfinished = kept.with_suffix(f".{os.getpid()}.npy")
        numpy.save(unfinished, pictures)
        unfinished.rename(kept)
        return judge.of_replications(pictures)

    def read(self, path, samples):
        picture = numpy.array(self.mitsuba.Bitmap(str(path)), numpy.float64)
        return judge.Picture(picture[:, :, :3], picture[:, :, 3:6] / samples)


_worker = None


def start_worker(folder, program):
    global _worker
    _worker = Mitsuba(folder / "theirs"), Gpt(program), folder


def try_case(case, level, quick):
    """What comes of one scene."""
    mitsuba, gpt, folder = _worker
    result = Result(case.name)
    scene = folder / "scenes" / (file_name(case.name) + ".xml")
    scene.write_text(case.xml)
    result.file = str(scene)
    picture = folder / "ours" / (scene.stem + ".exr")
    definitions = [word for key, value in case.definitions for word in ("-D", f"{key}={value}")]
    theirs, their_text, their_scene = None, case.planted_in or case.xml, scene
    if case.planted_in:
        their_scene = scene.with_name(scene.stem + "-theirs.xml")
        their_scene.write_text(their_text)
    try:
        theirs = mitsuba.render(their_scene, their_text, 0, case.definitions)
    except Exception as error:
        result.their_error = " ".join(str(error).split())[:300]

    def ours(stage):
        samples = STAGES[stage][2]
        said = gpt.render(scene, picture, samples, stage, *definitions)
        result.warnings, result.error = said.warnings, said.error
        return None if said.error else mitsuba.read(picture, samples)

    mine = ours(0)
    if mine is None or theirs is None:
        result.verdict = "refused by both" if mine is None and theirs is None else "refused here" if mine is None else "refused there"
        return result
    found = judge.judge(mine, theirs)
    control = judge.judge(mine.scaled(CONTROL), theirs)
    if not quick and found.largest_z < PLAIN and (found.found(judge.SUSPICION) or not control.found(level)):
        theirs = mitsuba.render(their_scene, their_text, 1, case.definitions)
        mine = ours(1)
        found = judge.judge(mine, theirs)
        control = judge.judge(mine.scaled(CONTROL), theirs)
    result.z, result.difference = found.largest_z, found.difference
    if found.found(level):
        result.verdict = "differs"
    elif not control.found(level):
        result.verdict = "blind"
    else:
        result.verdict = "agrees"
    if not quick and case.other is not None and result.verdict == "agrees":
        other = folder / "scenes" / f"other-{hashlib.sha256(case.other.encode()).hexdigest()[:16]}.xml"
        if not other.exists():
            other.write_text(case.other)
        effect = None
        for stage in (0, 1):
            try:
                effect = judge.judge(mitsuba.render(other, case.other, stage), mitsuba.render(scene, case.xml, stage, case.definitions))
            except Exception as error:
                result.their_error = "of the scene beside it: " + " ".join(str(error).split())[:300]
            if effect is not None and effect.found(level):
                break
        if effect is None or not effect.found(level):
            result.verdict = "tests nothing"
    return result


def guarded(case, level, quick):
    try:
        return try_case(case, level, quick)
    except Exception:
        return Result(case.name, "fault", error=traceback.format_exc()[-500:])


def file_name(name):
    plain = "".join(letter if letter.isalnum() or letter in "-." else "_" for letter in name)
    return plain if len(plain) < 100 else plain[:80] + hashlib.sha256(name.encode()).hexdigest()[:8]


def every_case():
    cases = [case for module in MODULES for case in module.cases()]
    names = [case.name for case in cases]
    assert len(set(names)) == len(names), "two scenes have the same name"
    return cases


def run(cases, folder, program, processes, quick):
    (folder / "results.jsonl").unlink(missing_ok=True)
    for part in ("scenes", "ours", "theirs"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    import mitsuba

    mitsuba.set_variant("scalar_rgb")
    files.write(folder / "scenes", mitsuba)
    level = judge.level_of(len(cases))
    results = {}
    # Not one kind after another, so that half a run shows half of each.
    todo = sorted(cases, key=lambda case: hashlib.sha256(case.name.encode()).digest())
    while todo:
        with concurrent.futures.ProcessPoolExecutor(processes, mp_context=SPAWN, initializer=start_worker, initargs=(folder, program)) as pool:
            futures = {pool.submit(guarded, case, level, quick): case for case in todo}
            broken = False
            for future in concurrent.futures.as_completed(futures):
                case = futures[future]
                try:
                    result = future.result()
                except concurrent.futures.process.BrokenProcessPool:
                    broken = True
                    continue
                results[case.name] = result
                with open(folder / "results.jsonl", "a") as log:
                    log.write(json.dumps(asdict(result)) + "\n")
                if len(results) % 50 == 0:
                    print(f"{len(results)} of {len(cases)}", file=sys.stderr, flush=True)
        todo = [case for case in todo if case.name not in results]
        if broken and todo:
            # A scene that ends Mitsuba's process ends one that tries it alone.
            case = todo[0]
            with concurrent.futures.ProcessPoolExecutor(1, mp_context=SPAWN, initializer=start_worker, initargs=(folder, program)) as alone:
                try:
                    results[case.name] = alone.submit(guarded, case, level, quick).result()
                except concurrent.futures.process.BrokenProcessPool:
                    results[case.name] = Result(case.name, "refused there", their_error="the process ends")
            todo = todo[1:]
    return [results[case.name] for case in cases]


def planted(cases):
    """Scenes in which this program is given something else than Mitsuba."""
    by_name = {case.name: case for case in cases}
    made = []
    for name, old, new in PLANTED:
        case = by_name[name]
        if old not in case.xml:
            raise SystemExit(f"mitsuba_scenes/planted.py: {name} does not hold {old}")
        made.append(dataclasses.replace(case, form=f"{case.form}, with {new[-60:]}", xml=case.xml.replace(old, new), planted_in=case.xml, other=None))
    return made


def row_of(name):
    """The row of known_mitsuba.py that a scene falls under."""
    return next((row for row in KNOWN if re.search(row[0], name)), None)


def faults(cases, results, whole):
    """What did not come out as it should, in words."""
    found, used = [], set()
    for case, result in zip(cases, results):
        if case.planted_in:
            if result.verdict != "differs":
                found.append(f"NOT FOUND: {result.name}: z {result.z:.1f}, {result.verdict} {result.error}")
            continue
        row = row_of(result.name)
        expected = row[1] if row else "agrees"
        if row and result.verdict == expected:
            used.add(row)
        if result.verdict not in (expected, "agrees"):
            difference = " ".join(f"{100 * part:+.1f} %" for part in result.difference)
            warned = ", and it warns" if result.warnings else ""
            found.append(f"{result.verdict.upper()} (expected: {expected}{warned}): {result.name}: z {result.z:.1f}, {difference} {result.error} {result.their_error} [{result.file}]")
    if whole:
        found += [f"UNUSED ROW of known_mitsuba.py: {row[0]}" for row in KNOWN if row not in used]
        scenes = coverage.words_of_scenes(case.xml for case in cases)
        words = coverage.words()
        found += [f"NO SCENE holds `{word}`, a word of {file}" for word, file in words.items() if word.lower() not in scenes and word not in NOT_IN_SCENES]
        found += [f"UNUSED ROW of NOT_IN_SCENES: {word}" for word in NOT_IN_SCENES if word not in words or word.lower() in scenes]
    return found


def markdown(cases, results):
    """A row for each parameter of a plugin."""
    parts = {}
    for case, result in zip(cases, results):
        if not case.planted_in:
            parts.setdefault((case.kind, case.plugin, case.parameter), []).append(result)
    lines = ["| plugin | parameter | scenes | agree | otherwise |", "| --- | --- | --- | --- | --- |"]
    for (kind, plugin, parameter), members in parts.items():
        others = {}
        for result in members:
            if result.verdict != "agrees":
                row = row_of(result.name)
                others.setdefault(f"{result.verdict}: {row[2] if row else '?'}", []).append(result)
        words = "; ".join(f"{len(found)} {what}" for what, found in others.items())
        agree = sum(result.verdict == "agrees" for result in members)
        lines.append(f"| {kind} `{plugin}` | {parameter} | {len(members)} | {agree} | {words} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", help="parts of the names of scenes")
    parser.add_argument("--list", action="store_true", help="names alone")
    parser.add_argument("--quick", action="store_true", help="few samples and no controls")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="where scenes and pictures stay")
    parser.add_argument("--markdown", type=Path, metavar="FILE", help="where the table is written")
    parser.add_argument("--gpt", type=Path, default=os.environ.get("GPT", ROOT / "target" / "debug" / "gpt"), help="the program")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="how many run side by side")
    arguments = parser.parse_args()
    cases = every_case()
    whole = not arguments.words and not arguments.quick
    chosen = [case for case in cases if not arguments.words or any(word in case.name for word in arguments.words)]
    if arguments.list:
        print("\n".join(case.name for case in chosen))
        return 0
    chosen += [] if arguments.quick else [case for case in planted(cases) if whole or any(word in case.name for word in arguments.words)]
    with tempfile.TemporaryDirectory() as temporary:
        folder = (arguments.keep or Path(temporary)).resolve()
        results = run(chosen, folder, Path(arguments.gpt).resolve(), arguments.processes, arguments.quick)
        (folder / "results.json").write_text(json.dumps([asdict(result) for result in results], indent=1))
    if arguments.markdown:
        table.write(arguments.markdown, "mitsuba", markdown(chosen, results))
    found = faults(chosen, results, whole)
    print("\n".join(found))
    verdicts = collections.Counter(result.verdict for case, result in zip(chosen, results) if not case.planted_in)
    print(f"{sum(verdicts.values())} scenes: " + ", ".join(f"{count} {verdict}" for verdict, count in verdicts.most_common()))
    changes = [result for case, result in zip(chosen, results) if case.planted_in]
    print(f"{sum(result.verdict == 'differs' for result in changes)} of {len(changes)} planted changes found")
    print(f"level {judge.LEVEL} for the whole run; {len(found)} faults")
    return 7 if found else 0


if __name__ == "__main__":
    sys.exit(main())
