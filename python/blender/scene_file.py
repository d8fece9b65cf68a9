"""A scene file: its tables in memory, and their text in TOML."""

import json
import math
import os

import numpy


class SceneFile:
    """Tables of a scene file, as docs/scene-format.md names them, and the folder of what they refer to."""

    def __init__(self, path):
        self.path = os.path.abspath(path)
        stem = os.path.splitext(os.path.basename(self.path))[0]
        self.folder_name = stem + "_files"
        self.folder = os.path.join(os.path.dirname(self.path), self.folder_name)
        self.film, self.render, self.camera = {}, {}, {}
        self.textures, self.materials, self.shapes, self.groups, self.instances, self.lights = [], [], [], [], [], []
        self._taken = set()

    def new_name(self, kind, wanted):
        """A name that no other entry of this kind has."""
        name, number = wanted, 1
        while (kind, name) in self._taken:
            number += 1
            name = f"{wanted} {number}"
        self._taken.add((kind, name))
        return name

    def new_file(self, wanted, ending):
        """The path of a new file in the scene's folder, and how the scene file refers to it."""
        os.makedirs(self.folder, exist_ok=True)
        plain = "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in wanted) or "file"
        name = self.new_name("file", plain.lower()) + ending
        return os.path.join(self.folder, name.replace(" ", "_")), f"{self.folder_name}/{name.replace(' ', '_')}"

    def add_texture(self, entry, wanted):
        for known in self.textures:
            if {key: known[key] for key in known if key != "name"} == entry:
                return known["name"]
        name = self.new_name("texture", wanted)
        self.textures.append({"name": name, **entry})
        return name

    def add_material(self, entry, wanted):
        """Adds a material; those of a blend may be entries themselves, which are added before it."""
        if entry == {"type": "pass"}:
            known = next((known["name"] for known in self.materials if known["type"] == "pass"), None)
            if known is not None:
                return known
            wanted = "nothing"
        entry = dict(entry)
        if entry["type"] == "blend":
            entry["materials"] = [
                part if isinstance(part, str) else self.add_material(part, f"{wanted}.{letter}")
                for part, letter in zip(entry["materials"], "ab")
            ]
        name = self.new_name("material", wanted)
        self.materials.append({"name": name, **entry})
        return name

    def text(self, comments=()):
        lines = [f"# {line}" for comment in comments for line in str(comment).splitlines()]
        lines.append("version = 1")
        for name, table in (("film", self.film), ("render", self.render), ("camera", self.camera)):
            if table:
                lines += ["", f"[{name}]", *_pairs(table)]
        lists = (
            ("texture", self.textures), ("material", self.materials), ("shape", self.shapes),
            ("group", self.groups), ("instance", self.instances), ("light", self.lights),
        )
        for name, entries in lists:
            for entry in entries:
                held = entry.get("shape", [])
                lines += ["", f"[[{name}]]", *_pairs({key: entry[key] for key in entry if key != "shape"})]
                for shape in held:
                    lines += ["", f"[[{name}.shape]]", *_pairs(shape)]
        return "\n".join(lines) + "\n"

    def write(self, comments=()):
        os.makedirs(os.path.dirname(self.path), exist_ok=True)
        with open(self.path, "w", encoding="utf-8") as file:
            file.write(self.text(comments))


def _pairs(table):
    return [f"{key} = {toml(value)}" for key, value in table.items()]


def toml(value):
    """A value as TOML writes it; numbers with seven places, as many as Blender keeps."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, int):
        return str(value)
    if isinstance(value, (float, numpy.floating)):
        number = float(value)
        if not math.isfinite(number):
            raise ValueError(f"{number} cannot stand in a scene file")
        return f"{number:.7g}"
    if isinstance(value, dict):
        return "{ " + ", ".join(_pairs(value)) + " }"
    return "[" + ", ".join(toml(part) for part in value) + "]"


def steps(matrix):
    """A transform in place of steps: a matrix of 4 × 4 as its 16 numbers, row by row."""
    rows = numpy.array(matrix, dtype=float)
    return [{"matrix": [*rows[:3].ravel(), 0, 0, 0, 1]}]


TO_Y_UP = numpy.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=float)
"""Blender's z points up; here y does, which maps of the environment turn about."""


def point(vector):
    """A point or direction of Blender's world in the scene file's."""
    x, y, z = vector
    return [float(x), float(z), -float(y)]


def grey(color):
    """One number where three are equal."""
    color = [float(channel) for channel in color]
    return color[0] if color[0] == color[1] == color[2] else color
