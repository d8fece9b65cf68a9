"""The scenes that are compared: which size, who is left out and why, and what share of the means may differ and why."""

from dataclasses import dataclass, field
from pathlib import Path

import mitsuba as mi
import numpy as np

ROOT = Path(__file__).resolve().parents[2]

TESSELLATED = (2e-3, "its spheres are meshes")
# Made by benches/scenes/make.py; Mitsuba renders what `gpt export` writes of them.
EXPORTED = dict.fromkeys(("cycles", "luxcore"), "its materials and lights are not translated for it")
NO_MEDIA = {"luxcore": "media are not translated for it"}
# Cycles' points are biased at few samples per pixel, in `textured` by 0.8 % at 4 and by 0.03 % at 64.
FEW_SAMPLES = (1e-3, "its points are biased at few samples")


# The means of Mitsuba's ldsampler are off where they were looked at: README.md.
LOW_DISCREPANCY = {"mitsuba-llvm": ("ldsampler",)}


@dataclass
class Scene:
    file: str
    """Relative to the project's root."""
    size: tuple = (256, 256)
    without: dict = field(default_factory=dict)
    """Renderers that do not take part, and why."""
    allowed: dict = field(default_factory=dict)
    """What relative difference of the means is not judged, by renderer, and why."""
    biased: dict = field(default_factory=dict)
    """Settings that do not take part because their means are off, by renderer."""
    kind: str = "small"
    """`small` (at most 100 primitives) or `model`."""

    def __post_init__(self):
        self.allowed = {"cycles": FEW_SAMPLES} | self.allowed

    def prepare(self, folder, say):
        """The scene file to render, or None where its model is absent. An absent environment map is made."""
        path = ROOT / self.file
        if not path.is_file():
            say(f"{path.stem}: left out, {path} is not there; benches/scenes/make.py makes it")
            return None
        text = path.read_text(encoding="utf-8")
        for line in text.splitlines():
            if not line.startswith("file"):
                continue
            found = (path.parent / line.split('"')[1]).resolve()
            if found.is_file():
                continue
            if found.suffix == ".obj":
                say(f"{path.stem}: left out, {found} is not there")
                return None
            made = folder / "environment.exr"
            write_environment(made)
            say(f"{path.stem}: {found} is not there; a generated map of a sun in a sky is taken in its place")
            copy = path.with_name(path.stem + "-generated.toml")
            text = text.replace(line, f'file  = "{made}"')
            # Other paths of the scene are relative to its folder.
            copy = folder / copy.name
            text = text.replace('"../../../shared', f'"{ROOT.parent / "shared"}')
            copy.write_text(text, encoding="utf-8")
            return copy
        return path


def write_environment(path, width=512, height=256):
    """A sky that brightens towards the horizon, with a soft sun."""
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    theta, phi = np.pi * v, 2 * np.pi * u
    direction = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)], axis=-1)
    sun = np.array([0.5, 0.7, 0.51])
    glow = np.exp(80 * (direction @ (sun / np.linalg.norm(sun)) - 1))
    sky = np.where(direction[..., 1:] > 0, 0.3 + 0.3 * (1 - np.abs(direction[..., 1:])) ** 2, 0.15) * np.array([0.8, 0.95, 1.15])
    mi.Bitmap((sky + 30 * glow[..., None] * np.array([1.0, 0.9, 0.7])).astype(np.float32)).write(str(path))


ALL = {
    "cornell": Scene("scenes/cornell.toml", biased=LOW_DISCREPANCY),
    "veach-mis": Scene(
        "scenes/veach-mis.toml", (384, 256), allowed={"cycles": TESSELLATED, "luxcore": TESSELLATED}, biased=LOW_DISCREPANCY
    ),
    "spheres": Scene(
        "scenes/spheres.toml", (320, 180), allowed={"cycles": TESSELLATED, "luxcore": TESSELLATED}, biased=LOW_DISCREPANCY
    ),
    "blend-rough": Scene("benches/scenes/blend-rough.toml", without={"luxcore": "its distribution of facets is Schlick's, not GGX"}),
    "blend-mirror": Scene(
        "benches/scenes/blend-mirror.toml",
        without=dict.fromkeys(("mitsuba-llvm", "mitsuba-scalar"), "its blend is wrong where a part is a mirror"),
    ),
    "glass": Scene("benches/scenes/glass.toml", allowed={"cycles": TESSELLATED, "luxcore": TESSELLATED}, biased=LOW_DISCREPANCY),
    "textured": Scene("benches/scenes/textured.toml"),
    "ogre-area": Scene("benches/scenes/ogre-area.toml", kind="model"),
    "ogre-environment": Scene("benches/scenes/ogre-environment.toml", kind="model"),
    "bunny-area": Scene("benches/scenes/bunny-area.toml", kind="model"),
    "bunny-environment": Scene("benches/scenes/bunny-environment.toml", kind="model"),
    "lamps": Scene("target/scenes/lamps.toml", without=EXPORTED, kind="model"),
    "interior": Scene("target/scenes/interior.toml", (320, 240), without=EXPORTED, kind="model"),
    "ajar": Scene("target/scenes/ajar.toml", (320, 240), without=EXPORTED, kind="model"),
    "sponza-like": Scene("target/scenes/sponza-like.toml", (320, 240), without=EXPORTED, kind="model"),
    "foggy-room": Scene("target/scenes/foggy-room.toml", (320, 240), without=NO_MEDIA, kind="model"),
    "cloud": Scene("target/scenes/cloud.toml", (320, 240), without=EXPORTED, kind="model"),
    "milk": Scene("target/scenes/milk.toml", (320, 240), without=NO_MEDIA, kind="model"),
    "canopy": Scene(
        "target/scenes/canopy.toml", (320, 240), without={"luxcore": "its cut-outs are not translated for it"}, kind="model"
    ),
}
