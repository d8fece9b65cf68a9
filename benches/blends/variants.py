"""The surfaces that are compared: a Lambert surface of 0.8, and blends of two diffuse materials."""

import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
GPT = HERE.parents[1] / "target" / "release" / "gpt"

DIRECT = """[[material]]
name = "target"
type = "diffuse"
reflectance = 0.8
"""

BLEND = """[[material]]
name = "first"
type = "diffuse"
reflectance = {first}

[[material]]
name = "second"
type = "diffuse"
reflectance = {second}

[[material]]
name = "target"
type = "blend"
materials = ["first", "second"]
weight = {weight}
"""

MATERIALS = {
    "direct": DIRECT,
    "different colours": BLEND.format(first=1, second=0, weight='{ type = "constant", value = 0.8 }'),
    "same colours": BLEND.format(first=0.8, second=0.8, weight='{ type = "constant", value = 0.5 }'),
    "facing": BLEND.format(first=1, second=0.6, weight='{ type = "facing", power = 1.0 }'),
}


def write_scenes(template, folder, names):
    """Writes the template's scene with each of the surfaces into a folder, and returns their paths."""
    text = template.read_text(encoding="utf-8")
    if text.count(DIRECT) != 1:
        raise ValueError(f"{template} does not hold the target's material as variants.py knows it")
    # Paths in a scene file are relative to it.
    text = text.replace('"../../', f'"{HERE.parents[1].as_posix()}/')
    paths = {}
    for name in names:
        paths[name] = Path(folder) / f"{template.stem} {name}.toml"
        paths[name].write_text(text.replace(DIRECT, MATERIALS[name]), encoding="utf-8")
    return paths


def run(*command, accepted=(0,)):
    """What the command says on its standard output."""
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, text=True)
    if done.returncode not in accepted:
        raise subprocess.CalledProcessError(done.returncode, done.args)
    return done.stdout
