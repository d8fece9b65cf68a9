#!/usr/bin/env python3
"""Renders small scenes of glTF and holds them against what the specification says they show, pixel by pixel.

  against_gltf.py                  every scene
  against_gltf.py sampler alpha    those whose names hold one of these words
  against_gltf.py --list           names alone
  against_gltf.py --keep FOLDER    scenes and pictures stay there
  against_gltf.py --markdown FILE  writes the table of a document

gltf_scenes/cases.py makes each scene twice: as a file, and as triangles that gltf_scenes/expected.py draws. As a control, 2 % more light has to
be found in each scene that agrees, and a picture that is mirrored; and the small changes of gltf_scenes/planted.py have to be found.

Exit status 0 if each scene comes out as known_gltf.py says it does, 7 otherwise. Needs numpy.
"""

import argparse
import concurrent.futures
import copy
import json
import os
import re
import sys
import tempfile
from dataclasses import asdict, dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import exr
import judge
import table
from gltf_scenes import cases as gltf
from gltf_scenes.planted import PLANTED
from known_gltf import KNOWN
from programs import ROOT, Gpt

# Samples of a pixel and seed: at first, and where something is in doubt.
SAMPLES = ((1024, 1), (8192, 2))
# More light than a test may overlook.
CONTROL = 1.02
# Differences that no chance explains are not rendered again.
PLAIN = 100.0


@dataclass
class Result:
    name: str
    group: str
    planted: str = ""
    verdict: str = ""
    z: float = 0.0
    difference: list = field(default_factory=list)
    warnings: list = field(default_factory=list)
    error: str = ""
    file: str = ""


def file_name(name):
    return "".join(letter if letter.isalnum() or letter in "-." else "_" for letter in name)[:120]


def write(case, folder):
    """The file, and a scene that shows it without the surroundings that files without light get."""
    path = folder / f"{file_name(case.name)}.{'glb' if case.binary else 'gltf'}"
    case.document.write(path, case.binary)
    around = path.with_suffix(".toml")
    variant = f'variant = "{case.variant}"\n' if case.variant else ""
    around.write_text(f'[[import]]\nfile = "{path.name}"\n{variant}\n[[light]]\ntype = "environment"\nradiance = 0\n')
    return around


def try_case(case, folder, gpt, level, planted=""):
    result = Result(case.name, case.group, planted)
    scene = write(case, folder)
    out = folder / f"{scene.stem}.exr"
    result.file = str(scene)
    theirs = judge.Picture(*case.expected())
    for samples, seed in SAMPLES:
        words = ("--max-depth", str(case.depth), "--size", f"{case.width}x{case.height}", "--compression", "none")
        said = gpt.render(scene, out, samples, seed, *words)
        result.warnings, result.error = said.warnings, said.error
        if said.error:
            result.verdict = "refused"
            return result
        ours = judge.Picture(exr.read_rgb(out), exr.read_rgb(out, "Variance.") / samples)
        found = judge.judge(ours, theirs)
        result.z, result.difference = found.largest_z, found.difference
        result.verdict = verdict(found, ours, theirs, level)
        if result.verdict in ("agrees", "differs") and not found.found(judge.SUSPICION) or found.largest_z > PLAIN:
            break
    return result


def planted(cases):
    """Scenes whose files are changed, with what was changed."""
    by_name = {case.name: case for case in cases}
    made = []
    for name, what, change in PLANTED:
        case = copy.deepcopy(by_name[name])
        change(case.document.json)
        case.form += f", off by {what}"
        made.append((case, what))
    return made


def verdict(found, ours, theirs, level):
    if found.found(level):
        return "differs"
    if theirs.mean.max() > 0 and not judge.judge(ours.scaled(CONTROL), theirs).found(level):
        return "blind"
    is_symmetric = not judge.judge(theirs.mirrored(), theirs).found(level)
    if not is_symmetric and not judge.judge(ours.mirrored(), theirs).found(level):
        return "blind"
    return "agrees"


def row_of(name):
    return next((row for row in KNOWN if re.search(row[0], name)), None)


def faults(results, whole):
    found, used = [], set()
    for result in results:
        if result.planted:
            if result.verdict != "differs":
                found.append(f"NOT FOUND: {result.name}: z {result.z:.1f}, {result.verdict} {result.error}")
            continue
        row = row_of(result.name)
        expected = row[1] if row else "agrees"
        if row and result.verdict == expected:
            used.add(row)
        if result.verdict not in (expected, "agrees"):
            difference = " ".join(f"{100 * part:+.1f} %" for part in result.difference)
            found.append(f"{result.verdict.upper()} (expected: {expected}{', and it warns' if result.warnings else ''}): {result.name}: z {result.z:.1f}, {difference} {result.error} [{result.file}]")
    if whole:
        found += [f"UNUSED ROW of known_gltf.py: {row[0]}" for row in KNOWN if row not in used]
    return found


def markdown(results):
    groups = {}
    for result in (result for result in results if not result.planted):
        groups.setdefault(result.group, []).append(result)
    lines = ["| of the specification | scenes | agree | otherwise |", "| --- | --- | --- | --- |"]
    for group, members in groups.items():
        others = [f"{result.name.split(': ', 1)[1]} {result.verdict}: {(row_of(result.name) or ('', '', '?'))[2]}" for result in members if result.verdict != "agrees"]
        lines.append(f"| {group} | {len(members)} | {sum(result.verdict == 'agrees' for result in members)} | {'; '.join(others)} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", help="parts of the names of scenes")
    parser.add_argument("--list", action="store_true", help="names alone")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="where scenes and pictures stay")
    parser.add_argument("--markdown", type=Path, metavar="FILE", help="where the table is written")
    parser.add_argument("--gpt", type=Path, default=os.environ.get("GPT", ROOT / "target" / "debug" / "gpt"), help="the program")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="how many run side by side")
    arguments = parser.parse_args()
    all_cases = list(gltf.cases())
    chosen = [case for case in all_cases if not arguments.words or any(word in case.name for word in arguments.words)]
    if arguments.list:
        print("\n".join(case.name for case in chosen))
        return 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = (arguments.keep or Path(temporary)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        gpt = Gpt(Path(arguments.gpt).resolve())
        level = judge.level_of(len(all_cases))
        with concurrent.futures.ThreadPoolExecutor(arguments.processes) as pool:
            todo = [(case, "") for case in chosen] + [pair for pair in planted(all_cases) if not arguments.words or any(word in pair[0].name for word in arguments.words)]
            results = list(pool.map(lambda pair: try_case(pair[0], folder, gpt, level, pair[1]), todo))
        (folder / "results.json").write_text(json.dumps([asdict(result) for result in results], indent=1))
    if arguments.markdown:
        table.write(arguments.markdown, "gltf", markdown(results))
    found = faults(results, not arguments.words)
    print("\n".join(found))
    scenes, changes = [result for result in results if not result.planted], [result for result in results if result.planted]
    print(f"{len(scenes)} scenes, {sum(result.verdict == 'agrees' for result in scenes)} agree; {sum(result.verdict == 'differs' for result in changes)} of {len(changes)} planted changes found")
    print(f"level {judge.LEVEL} for the whole run; {len(found)} faults")
    return 7 if found else 0


if __name__ == "__main__":
    sys.exit(main())
