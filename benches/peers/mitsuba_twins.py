#!/usr/bin/env python3
"""Renders scenes of Mitsuba 3 with gpt's importer and with Mitsuba itself, one for each of the newer materials and shapes.

Both programs read the same XML, so importer, model and integrator are held to account at once. Each scene gets the verdict of mitsuba_ogre.py:
Welch's t on seeds, of the whole picture and of tiles of 16 × 16 pixels, with a negative control of one per cent of energy added. Where the
models are known to differ, a difference is expected, and how large it is is told.

`--rows` prints rows of a table instead: the largest |z| of a tile, its p-value and what that is rejected below, and the p-value of the whole
picture once 1 % of energy is added to ours.

Exit status: 0 if every scene came out as expected, 7 otherwise. The default variant needs no LLVM.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import mitsuba as mi
import numpy as np

import agreement

HERE = Path(__file__).resolve().parent
agreement.TILE = 16

SCENE = """<scene version="3.0.0">
  <integrator type="path"><integer name="max_depth" value="8"/><integer name="rr_depth" value="100"/></integrator>
  <sensor type="perspective">
    <string name="fov_axis" value="y"/><float name="fov" value="32"/>
    <transform name="to_world"><lookat origin="0,1.6,5" target="0,0.8,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="48"/><rfilter type="box"/></film>
    <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
  </sensor>
  <texture type="checkerboard" id="checks"><rgb name="color0" value="0.9"/><rgb name="color1" value="0.05"/>
    <transform name="to_uv"><scale x="6" y="4"/></transform></texture>
  {material}
  {shape}
  <shape type="rectangle">
    <transform name="to_world"><scale x="8" y="8"/><rotate x="1" angle="-90"/></transform>
    <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.5 0.45 0.4"/></bsdf></bsdf>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><scale x="0.9" y="0.7"/><rotate x="1" angle="70"/><translate x="-2.2" y="3.6" z="1.4"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
    <emitter type="area"><rgb name="radiance" value="9 8 7"/></emitter>
  </shape>
  <emitter type="constant"><rgb name="radiance" value="0.35 0.38 0.42"/></emitter>
</scene>
"""

SPHERE = '<shape type="sphere"><point name="center" x="0" y="1" z="0"/><ref id="target"/></shape>'
TUBE = """<shape type="cylinder"><point name="p0" x="-0.9" y="0.6" z="0.3"/><point name="p1" x="0.8" y="1.3" z="-0.2"/>
  <float name="radius" value="0.55"/><ref id="target"/></shape>"""
# A light that both find by sampling its area.
LAMP = """<shape type="cylinder"><point name="p0" x="-0.9" y="0.5" z="0.3"/><point name="p1" x="0.8" y="0.9" z="-0.2"/><float name="radius" value="0.2"/>
  <ref id="target"/><emitter type="area"><rgb name="radiance" value="3 2.5 2"/></emitter></shape>"""


def bsdf(kind, within="", wrapped=False):
    """A BSDF called `target`; one that reflects on its front alone is wrapped, so that both sides do."""
    if wrapped:
        return f'<bsdf type="twosided" id="target"><bsdf type="{kind}">{within}</bsdf></bsdf>'
    return f'<bsdf type="{kind}" id="target">{within}</bsdf>'


def number(name, value):
    return f'<float name="{name}" value="{value}"/>'


def word(name, value):
    return f'<string name="{name}" value="{value}"/>'


RED = '<rgb name="diffuse_reflectance" value="0.6 0.1 0.05"/>'
GOLD = word("material", "Au")
DIFFUSE = '<bsdf type="diffuse"><rgb name="reflectance" value="0.1 0.3 0.6"/></bsdf>'
PLASTIC = f'<bsdf type="plastic">{RED}</bsdf>'

# Mitsuba's base under a rough surface is darker than an integration makes it. The plain mean over 64 evenly spaced cosines, both ends included, of
# the light that is sent back from within gives about its numbers. These are the reflectances with which Mitsuba's base is as bright as integrated:
# by 1.27 % without `nonlinear` (GGX of 0.2), and so that rho / (1 - rho R) is right with it (Beckmann of 0.3).
BRIGHTER_RED = '<rgb name="diffuse_reflectance" value="0.60762 0.10127 0.050635"/>'
BRIGHTER_NONLINEAR_RED = '<rgb name="diffuse_reflectance" value="0.6027 0.100075 0.0500187"/>'


def rough_plastic(color):
    return bsdf("roughplastic", color + number("alpha", 0.2) + word("distribution", "ggx"), True)


def nonlinear_plastic(color):
    return bsdf("roughplastic", color + number("alpha", 0.3) + word("distribution", "beckmann") + '<boolean name="nonlinear" value="true"/>', True)


def blend_by_texture(color):
    plastic = f'<bsdf type="roughplastic">{color}{number("alpha", 0.2)}{word("distribution", "ggx")}</bsdf>'
    return bsdf("blendbsdf", f'<ref name="weight" id="checks"/>{plastic}{DIFFUSE}', True)


MASK = bsdf("mask", f'<ref name="opacity" id="checks"/><bsdf type="twosided">{DIFFUSE}</bsdf>')
PLAIN = bsdf("diffuse", '<rgb name="reflectance" value="0.9"/>', True)
MASK_OF_HALF = bsdf("mask", f'{number("opacity", 0.5)}<bsdf type="twosided">{PLASTIC}</bsdf>')


def edges(most):
    """Before a material: paths of up to so many edges, in place of 8."""
    return f"<!-- edges: {most} -->"


# Sheets across the whole view, close before the camera, that let nine tenths through as holes do and absorb the rest: every path from the camera
# goes through each of them once, and next to none meets one again.
SHEET_COUNT = 6
BEHIND_SHEETS = SPHERE + "".join(
    f"""<shape type="rectangle">
    <transform name="to_world"><scale value="0.1"/>
      <lookat origin="0,{1.6 - 0.8 * along:.6g},{5 - 5 * along:.6g}" target="0,0.8,0" up="0,1,0"/></transform>
    <bsdf type="mask"><float name="opacity" value="0.1"/>
      <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf></bsdf></bsdf>
  </shape>"""
    for along in (0.02 + 0.004 * number for number in range(SHEET_COUNT))
)

# Name, material, shape, whether agreement is expected, and Mitsuba's own material where it has another.
CASES = [
    ("plastic", bsdf("plastic", RED, True), SPHERE, True),
    ("plastic, nonlinear", bsdf("plastic", RED + '<boolean name="nonlinear" value="true"/>', True), SPHERE, True),
    ("rough plastic", rough_plastic(RED), SPHERE, False),
    ("rough plastic, Mitsuba's base as integrated", rough_plastic(RED), SPHERE, True, rough_plastic(BRIGHTER_RED)),
    ("rough plastic, nonlinear, Beckmann", nonlinear_plastic(RED), SPHERE, False),
    ("the same, Mitsuba's base as integrated", nonlinear_plastic(RED), SPHERE, True, nonlinear_plastic(BRIGHTER_NONLINEAR_RED)),
    ("Beckmann gold", bsdf("roughconductor", GOLD + number("alpha", 0.3) + word("distribution", "beckmann"), True), SPHERE, True),
    (
        "anisotropic gold",
        bsdf("roughconductor", GOLD + number("alpha_u", 0.1) + number("alpha_v", 0.5) + word("distribution", "ggx"), True),
        SPHERE,
        True,
    ),
    ("thin dielectric", bsdf("thindielectric"), SPHERE, True),
    ("rough dielectric", bsdf("roughdielectric", number("alpha", 0.3) + word("distribution", "ggx")), SPHERE, True),
    # gpt does not count the way through a hole as an edge of the path, and Mitsuba does. Paths of 64 edges end where next to nothing is left.
    ("mask, 8 edges", MASK, SPHERE, False),
    ("mask, 64 edges", edges(64) + MASK, SPHERE, True),
    ("mask of a half, 8 edges", MASK_OF_HALF, SPHERE, False),
    ("mask of a half, 64 edges", edges(64) + MASK_OF_HALF, SPHERE, True),
    # How many edges Mitsuba needs where gpt has 3: as many more as there are sheets. One fewer is too few, and one more too many.
    (f"behind {SHEET_COUNT} sheets, Mitsuba's {2 + SHEET_COUNT} edges", edges(3) + PLAIN, BEHIND_SHEETS, False, edges(2 + SHEET_COUNT) + PLAIN),
    (f"behind {SHEET_COUNT} sheets, Mitsuba's {3 + SHEET_COUNT} edges", edges(3) + PLAIN, BEHIND_SHEETS, True, edges(3 + SHEET_COUNT) + PLAIN),
    (f"behind {SHEET_COUNT} sheets, Mitsuba's {4 + SHEET_COUNT} edges", edges(3) + PLAIN, BEHIND_SHEETS, False, edges(4 + SHEET_COUNT) + PLAIN),
    (
        "blend of rough metal and diffuse",
        bsdf(
            "blendbsdf",
            f'{number("weight", 0.4)}<bsdf type="roughconductor">{GOLD}{number("alpha", 0.3)}{word("distribution", "ggx")}</bsdf>{DIFFUSE}',
            True,
        ),
        SPHERE,
        True,
    ),
    ("blend by a texture, Mitsuba's base as integrated", blend_by_texture(RED), SPHERE, True, blend_by_texture(BRIGHTER_RED)),
    ("cylinder with a texture", bsdf("diffuse", '<ref name="reflectance" id="checks"/>', True), TUBE, True),
    ("brushed cylinder", bsdf("roughconductor", GOLD + number("alpha_u", 0.1) + number("alpha_v", 0.5) + word("distribution", "ggx"), True), TUBE, True),
    ("cylinder that gives light", bsdf("diffuse", '<rgb name="reflectance" value="0.2"/>', True), LAMP, True),
]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, default=4096, help="samples per pixel in all (default: 4096)")
    parser.add_argument("--seeds", type=int, default=16, help="replications they are split into, at least 2 (default: 16)")
    parser.add_argument("--alpha", type=float, default=0.01, help="level of each of the two verdicts (default: 0.01)")
    parser.add_argument("--variant", default="scalar_rgb", help="Mitsuba's variant (default: scalar_rgb)")
    parser.add_argument("--gpt", type=Path, default=HERE.parents[1] / "target" / "release" / "gpt", help="the program")
    parser.add_argument("--device", default="auto", help="gpt's device (default: auto)")
    parser.add_argument("--first-seed", type=int, default=0, help="the first of the replications' seeds (default: 0)")
    parser.add_argument("--rows", action="store_true", help="rows of a table in Markdown")
    parser.add_argument("--only", help="scenes whose name holds this")
    return parser.parse_args()


def ours(options, scene, folder, seed):
    picture = folder / "picture.exr"
    run = [options.gpt, "render", scene, "--device", options.device, "--quiet", "--spp", str(options.spp // options.seeds)]
    subprocess.run([*map(str, run), "--seed", str(seed), "-o", str(picture)], check=True)
    bitmap = mi.Bitmap(str(picture)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False)
    return np.array(bitmap, dtype=np.float64)


def imported_exactly(options, scene):
    """Nothing of the scene is dropped or approximated."""
    check = subprocess.run([str(options.gpt), "check", str(scene), "--json"], check=True, capture_output=True, text=True)
    report = json.loads(check.stdout)
    return not report.get("dropped") and not report.get("approximated")


def scene_with(material, shape):
    text = SCENE.format(material=material, shape=shape)
    asked = re.search("<!-- edges: ([0-9]+) -->", material)
    return text.replace('name="max_depth" value="8"', f'name="max_depth" value="{asked[1]}"') if asked else text


def compare(options, name, text, twin_text):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        scene = folder / "twin.xml"
        scene.write_text(text, encoding="utf-8")
        exact = imported_exactly(options, scene)
        twin = mi.load_string(twin_text)
        seeds = range(options.first_seed, options.first_seed + options.seeds)
        pictures = [ours(options, scene, folder, seed) for seed in seeds]
        theirs = [
            np.array(mi.render(twin, spp=options.spp // options.seeds, seed=seed), dtype=np.float64)[..., :3] for seed in seeds
        ]
    pictures, theirs = np.stack(pictures), np.stack(theirs)
    judged = agreement.judge(pictures, theirs, options.alpha)
    means = ", ".join(f"{100 * difference:+.3f} %" for difference in judged.difference)
    inexact = "" if exact else "; not imported exactly"
    if options.rows:
        print(
            f"| {name} | {judged.largest_z:.2f} | {judged.least_p:.2g} | {judged.level:.2g} | {means} | {judged.planted_p:.1g} | {judged.verdict}{inexact} |",
            flush=True,
        )
        return judged.verdict
    print(
        f"{name}: {judged.verdict}; {judged.channels} of 3 channels and {judged.tiles} of {agreement.tile_means(theirs)[0].size} tiles × channels rejected; "
        f"means {means}{inexact}",
        flush=True,
    )
    return judged.verdict


def main():
    options = arguments()
    mi.set_variant(options.variant)
    surprises = []
    for name, material, shape, agrees, *theirs in CASES:
        if options.only and options.only not in name:
            continue
        ours, twin = (scene_with(chosen, shape) for chosen in (material, theirs[0] if theirs else material))
        if compare(options, name, ours, twin) != ("agree" if agrees else "differ"):
            surprises.append(name)
    print(f"not as expected: {', '.join(surprises) or 'none'}")
    return 7 if surprises else 0


if __name__ == "__main__":
    sys.exit(main())
