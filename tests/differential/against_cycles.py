#!/usr/bin/env python3
"""Renders the scenes of gltf_scenes/cases.py that Cycles' importer says exactly here and by the Cycles of Blender, and compares the pictures.

  against_cycles.py                every such scene
  against_cycles.py camera node    those whose names hold one of these words
  against_cycles.py --keep FOLDER  scenes and pictures stay there
  against_cycles.py --markdown FILE  writes the table of a document

BPY is a Python that has bpy (`pip install bpy`; bpy 5.0 is for Python 3.11) [the one that runs this]. As a control, 2 % more light has to be found in
each scene that agrees.

Exit status 0 if each scene comes out as known_cycles.py says it does, 7 otherwise.
"""

import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import numpy

import against_gltf
import exr
import judge
import table
from gltf_scenes import cases as gltf
from known_cycles import KNOWN
from programs import ROOT, Gpt

SAMPLES = 1024
CONTROL = 1.02


@dataclass
class Result:
    name: str
    group: str
    verdict: str = ""
    z: float = 0.0
    difference: list = field(default_factory=list)


def pictures_of_cycles(chosen, folder):
    """One process renders all scenes: starting Blender takes longer than a scene."""
    jobs = [{"scene": str(folder / (against_gltf.file_name(case.name) + (".glb" if case.binary else ".gltf"))), "out": str(folder / f"{against_gltf.file_name(case.name)}.npy"), "size": [case.width, case.height], "depth": case.depth} for case in chosen]
    (folder / "jobs.json").write_text(json.dumps(jobs))
    run = subprocess.run([os.environ.get("BPY", sys.executable), str(HERE / "render_by_cycles.py"), str(folder / "jobs.json")], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise SystemExit(f"against_cycles.py: Blender ended with {run.returncode}: {run.stderr[-2000:]} {run.stdout[-500:]}")
    return [numpy.load(job["out"]) if Path(job["out"]).exists() else None for job in jobs]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", help="parts of the names of scenes")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="where scenes and pictures stay")
    parser.add_argument("--markdown", type=Path, metavar="FILE", help="where the table is written")
    parser.add_argument("--gpt", type=Path, default=os.environ.get("GPT", ROOT / "target" / "debug" / "gpt"), help="the program")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="how many run side by side")
    arguments = parser.parse_args()
    all_cases = [case for case in gltf.cases() if case.beside_cycles]
    chosen = [case for case in all_cases if not arguments.words or any(word in case.name for word in arguments.words)]
    level = judge.level_of(len(all_cases))
    with tempfile.TemporaryDirectory() as temporary:
        folder = (arguments.keep or Path(temporary)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        gpt = Gpt(Path(arguments.gpt).resolve())
        scenes = [against_gltf.write(case, folder) for case in chosen]

        def ours(pair):
            case, scene = pair
            out = scene.with_suffix(".exr")
            said = gpt.render(scene, out, SAMPLES, 1, "--max-depth", str(case.depth), "--size", f"{case.width}x{case.height}", "--compression", "none")
            return None if said.error else judge.Picture(exr.read_rgb(out), exr.read_rgb(out, "Variance.") / SAMPLES)

        with concurrent.futures.ThreadPoolExecutor(arguments.processes) as pool:
            mine = list(pool.map(ours, zip(chosen, scenes)))
        theirs = pictures_of_cycles(chosen, folder)
    results = []
    for case, one, other in zip(chosen, mine, theirs):
        result = Result(case.name, case.group)
        results.append(result)
        if one is None or other is None:
            result.verdict = "refused here" if one is None else "refused there"
            continue
        beside = judge.of_replications(other)
        found = judge.judge(one, beside)
        result.z, result.difference = found.largest_z, found.difference
        is_seen = beside.mean.max() == 0 or judge.judge(one.scaled(CONTROL), beside).found(level)
        result.verdict = "differs" if found.found(level) else "agrees" if is_seen else "blind"
    row_of = lambda name: next((row for row in KNOWN if re.search(row[0], name)), None)
    found = []
    for result in results:
        row = row_of(result.name)
        if result.verdict not in (row[1] if row else "agrees", "agrees"):
            found.append(f"{result.verdict.upper()}: {result.name}: z {result.z:.1f}, " + " ".join(f"{100 * part:+.1f} %" for part in result.difference))
    if not arguments.words:
        found += [f"UNUSED ROW of known_cycles.py: {row[0]}" for row in KNOWN if not any(row_of(result.name) is row and result.verdict == row[1] for result in results)]
    if arguments.markdown:
        groups = {}
        for result in results:
            groups.setdefault(result.group, []).append(result)
        lines = ["| beside Cycles | scenes | agree | otherwise |", "| --- | --- | --- | --- |"]
        for group, members in groups.items():
            others = [f"{result.name.split(': ', 1)[1]} {result.verdict}: {(row_of(result.name) or ('', '', '?'))[2]}" for result in members if result.verdict != "agrees"]
            lines.append(f"| {group} | {len(members)} | {sum(result.verdict == 'agrees' for result in members)} | {'; '.join(others)} |")
        table.write(arguments.markdown, "cycles", "\n".join(lines) + "\n")
    print("\n".join(found))
    print(f"{len(results)} scenes, {sum(result.verdict == 'agrees' for result in results)} agree; level {judge.LEVEL} for the whole run; {len(found)} faults")
    return 7 if found else 0


if __name__ == "__main__":
    sys.exit(main())
