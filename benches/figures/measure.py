"""Renders scenes, measures their errors and what processors spent on them, joins pictures, and writes tables into a page."""

import csv
import fcntl
import json
import os
import subprocess
import tempfile
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Where `scripts/figures` has built the program and the examples.
BINARIES = Path(os.environ.get("GPT_BINARIES", ROOT / "target" / "release"))
SCENES = ROOT / "scenes" / "figures"
PICTURES = ROOT / "docs" / "figures"
PAGE = ROOT / "docs" / "figures.md"
NUMBERS = Path(__file__).resolve().parent / "numbers.csv"
# Errors are means over pixels: smaller frames measure the same.
ERROR_SIZE = "96x72"
SEEDS = (1, 2, 3, 4)
# Where a figure says nothing else: it makes no difference between numbers of samples.
SAMPLER = "halton"
# No seed of a measured picture.
REFERENCE_SEEDS = (1001, 1002)
# What a quick run renders instead of sizes and numbers of samples: two rows of three squares are a cube map.
QUICK = ["--device", "cpu", "--size", "18x12", "--spp", 1]

scratch = tempfile.TemporaryDirectory(prefix="gpt-figures-")
FOLDER = Path(scratch.name)


@dataclass
class Way:
    """One way of making a picture: flags of `gpt render`, and texts of the scene file to replace."""

    name: str
    flags: list = field(default_factory=list)
    edits: dict = field(default_factory=dict)


def scene_path(scene, edits):
    """The scene as a file; with edits, a copy, which names pictures by their whole paths."""
    path = SCENES / f"{scene}.toml"
    if not path.exists():
        path = ROOT / "scenes" / f"{scene}.toml"
    if not edits:
        return path
    text = path.read_text(encoding="utf-8")
    for old, new in edits.items():
        if text.count(old) != 1:
            raise ValueError(f"{path} holds {old!r} {text.count(old)} times, not once")
        text = text.replace(old, new)
    text = text.replace('"textures/', f'"{ROOT}/scenes/textures/')
    edited = FOLDER / f"{scene}-{abs(hash(text))}.toml"
    edited.write_text(text, encoding="utf-8")
    return edited


def render(scene, way, output, *flags):
    """Renders one picture; returns its statistics and the processor seconds it took, start and compilation included."""
    statistics = FOLDER / "statistics.json"
    sampler = () if "--sampler" in (*way.flags, *flags) else ("--sampler", SAMPLER)
    command = [BINARIES / "gpt", "render", scene_path(scene, way.edits), "--quiet", "--stats", statistics, "-o", output]
    options = [*sampler, *way.flags, *flags]
    command += quickly(options) if quick else options
    before = os.times()
    subprocess.run([str(part) for part in command], check=True)
    after = os.times()
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return json.loads(statistics.read_text(encoding="utf-8")), seconds


def quickly(options):
    """The options, all of which are pairs of a flag and its value, for a few pixels of one sample."""
    pairs = zip(options[::2], options[1::2], strict=True)
    return [*QUICK, *(part for flag, value in pairs if flag not in QUICK for part in (flag, value))]


def distance(picture, reference):
    """Mean square error and relative mean square error between two pictures."""
    done = subprocess.run([BINARIES / "gpt", "compare", picture, reference, "--json"], stdout=subprocess.PIPE, text=True)
    if done.returncode not in (0, 7):
        raise subprocess.CalledProcessError(done.returncode, done.args)
    values = json.loads(done.stdout)
    return values["mse"]["all"], values["relmse"]["all"]


def references(scene, way, spp, size=ERROR_SIZE):
    """Two independent long renders; none where errors are kept."""
    if keeping:
        return []
    paths = []
    for seed in REFERENCE_SEEDS:
        paths.append(FOLDER / f"reference-{scene}-{seed}.exr")
        render(scene, way, paths[-1], "--spp", spp, "--seed", seed, "--size", size)
    return paths


def error(figure, scene, way, spp, truths, size=ERROR_SIZE, seeds=SEEDS):
    """Mean square error and its relative kind, averaged over seeds.

    With two references R and S, (d(X, R) + d(X, S) − d(R, S)) / 2 is the error of X alone, whatever noise the references have left (up to
    the denominators of the relative error).
    """
    if kept := kept_errors(figure, scene, way.name, spp):
        rows = kept
        for seed, row in zip(seeds, rows):
            record(figure, scene, way.name, spp, f"error, seed {seed}", row)
        return [sum(row[kind] for row in rows) / len(rows) for kind in (0, 1)]
    between = distance(*truths)
    rows = []
    for seed in seeds[: 1 if quick else None]:
        picture = FOLDER / "picture.exr"
        render(scene, way, picture, "--spp", spp, "--seed", seed, "--size", size)
        pairs = [distance(picture, truth) for truth in truths]
        rows.append([(pairs[0][kind] + pairs[1][kind] - between[kind]) / 2 for kind in (0, 1)])
        record(figure, scene, way.name, spp, f"error, seed {seed}", rows[-1])
    return [sum(row[kind] for row in rows) / len(rows) for kind in (0, 1)]


def seconds(figure, scene, ways, spp, size="240x180", rounds=2):
    """Processor seconds of each way beyond those of one sample: the least of some rounds in which the ways take turns, of either."""
    taken = {way.name: ([], []) for way in ways}
    for _ in range(1 if quick else rounds):
        for way in ways:
            for times, count in zip(taken[way.name], (1, spp)):
                times.append(render(scene, way, FOLDER / "timed.exr", "--spp", count, "--size", size)[1])
    for way in ways:
        for times, count in zip(taken[way.name], (1, spp)):
            record(figure, scene, way.name, count, "processor seconds", times)
    # The system counts hundredths of a second.
    return {name: max(min(long) - min(short), 0.01) for name, (short, long) in taken.items()}


def montage(name, columns, cells, enlarge=1):
    """Renders pictures and joins them: cells are (scene, way, spp, flags)."""
    PICTURES.mkdir(exist_ok=True)
    paths = []
    for number, (scene, way, spp, *flags) in enumerate(cells):
        paths.append(FOLDER / f"cell-{number}.png")
        render(scene, way, paths[-1], "--spp", spp, *flags)
    command = [BINARIES / "examples" / "montage", PICTURES / name, columns, *paths]
    if enlarge > 1:
        command[1:1] = ["--enlarge", enlarge]
    subprocess.run([str(part) for part in command], check=True)


def show(pair):
    """Mean square error and its relative kind, as a table shows them."""
    return ", ".join(f"{value:.2e}".replace("e-0", "e-").replace("e+00", "") for value in pair)


def table(name, heading, rows):
    """Puts a table into the page, between the comments that name it."""
    lines = ["| " + " | ".join(str(cell) for cell in row) + " |" for row in [heading, ["---"] * len(heading), *rows]]
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    with locked():
        text = PAGE.read_text(encoding="utf-8")
        if text.count(begin) != 1 or text.count(end) != 1:
            raise ValueError(f"{PAGE} has no place for the table {name}")
        head, rest = text.split(begin)
        PAGE.write_text(head + begin + "\n" + "\n".join(lines) + "\n\n" + end + rest.split(end)[1], encoding="utf-8")
    print("\n".join([name, *lines, ""]), flush=True)


def samplers():
    """Draws the points of every sampler."""
    subprocess.run([str(BINARIES / "examples" / "sampler_projections"), str(PICTURES.parent / "samplers.png")], check=True)


# Whether this run only shows that everything still runs.
quick = False


def be_quick():
    """From here on pictures have a few pixels, and whatever is written goes into a folder that is removed in the end."""
    global quick, PICTURES, PAGE, NUMBERS
    quick = True
    page, numbers = PAGE, NUMBERS
    PICTURES, PAGE, NUMBERS = FOLDER / "figures", FOLDER / page.name, FOLDER / numbers.name
    PAGE.write_bytes(page.read_bytes())
    NUMBERS.write_bytes(numbers.read_bytes())


# What was measured in this run, and in earlier ones that are to be kept.
recorded = []
keeping = []


def keep_errors():
    """From here on errors are those of numbers.csv; only times are measured again."""
    keeping.extend(read_numbers())


def kept_errors(figure, scene, way, spp):
    """The errors of one table's cell, seed by seed; an exception where errors are to be kept and this one is missing."""
    if not keeping:
        return []
    rows = [row for row in keeping if row[:4] == [figure, scene, way, str(spp)] and row[4].startswith("error")]
    if not rows:
        raise ValueError(f"{NUMBERS} has no errors of {figure}, {scene}, {way}, {spp}")
    return [[float(value) for value in row[5:7]] for row in rows]


def record(figure, scene, way, spp, what, values):
    recorded.append([figure, scene, way, spp, what, *(f"{value:.6g}" for value in values)])


def read_numbers():
    if not NUMBERS.exists():
        return []
    with NUMBERS.open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file))[1:]


def write_numbers():
    """Every measured value; those of figures that were not measured this time stay as they were."""
    measured = {row[0] for row in recorded}
    with locked():
        rows = [row for row in read_numbers() if row[0] not in measured] + recorded
        with NUMBERS.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["figure", "scene", "way", "samples per pixel", "what", "values: mean square error and relative, or one a round"])
            writer.writerows(rows)


@contextmanager
def locked():
    """One run at a time may write; two may measure different figures."""
    with Path(__file__).open(encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield
