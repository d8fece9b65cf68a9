#!/usr/bin/env python3
"""Renders scenes of Mitsuba 3 with gpt's importer and with Mitsuba itself, one for each of the newer materials and shapes.

Both programs read the same XML, so importer, model and integrator are held to account at once. Each scene gets the verdict of mitsuba_ogre.py:
Welch's t on seeds, of the whole picture and of tiles of 16 × 16 pixels, with a negative control of one per cent of energy added. Where the
models are known to differ, a difference is expected, and how large it is is told.

Exit status: 0 if every scene came out as expected, 7 otherwise. The default variant needs no LLVM.
"""

import argparse
import json
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

# Name, material, shape, whether agreement is expected.
CASES = [
    ("plastic", bsdf("plastic", RED, True), SPHERE, True),
    ("plastic, nonlinear", bsdf("plastic", RED + '<boolean name="nonlinear" value="true"/>', True), SPHERE, True),
    ("rough plastic", bsdf("roughplastic", RED + number("alpha", 0.2) + word("distribution", "ggx"), True), SPHERE, True),
    (
        "rough plastic, nonlinear, Beckmann",
        bsdf("roughplastic", RED + number("alpha", 0.3) + word("distribution", "beckmann") + '<boolean name="nonlinear" value="true"/>', True),
        SPHERE,
        True,
    ),
    ("Beckmann gold", bsdf("roughconductor", GOLD + number("alpha", 0.3) + word("distribution", "beckmann"), True), SPHERE, True),
    (
        "anisotropic gold",
        bsdf("roughconductor", GOLD + number("alpha_u", 0.1) + number("alpha_v", 0.5) + word("distribution", "ggx"), True),
        SPHERE,
        True,
    ),
    ("thin dielectric", bsdf("thindielectric"), SPHERE, True),
    ("rough dielectric", bsdf("roughdielectric", number("alpha", 0.3) + word("distribution", "ggx")), SPHERE, True),
    ("mask", bsdf("mask", f'<ref name="opacity" id="checks"/><bsdf type="twosided">{DIFFUSE}</bsdf>'), SPHERE, True),
    ("mask of a half", bsdf("mask", f'{number("opacity", 0.5)}<bsdf type="twosided">{PLASTIC}</bsdf>'), SPHERE, True),
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
    (
        "blend by a texture",
        bsdf(
            "blendbsdf",
            f'<ref name="weight" id="checks"/><bsdf type="roughplastic">{RED}{number("alpha", 0.2)}{word("distribution", "ggx")}</bsdf>{DIFFUSE}',
            True,
        ),
        SPHERE,
        True,
    ),
    ("cylinder with a texture", bsdf("diffuse", '<ref name="reflectance" id="checks"/>', True), TUBE, True),
    ("brushed cylinder", bsdf("roughconductor", GOLD + number("alpha_u", 0.1) + number("alpha_v", 0.5) + word("distribution", "ggx"), True), TUBE, True),
    ("cylinder that gives light", bsdf("diffuse", '<rgb name="reflectance" value="0.2"/>', True), LAMP, True),
]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, default=4096, help="samples per pixel in all (default: 4096)")
    parser.add_argument("--seeds", type=int, default=8, help="replications they are split into, at least 2 (default: 8)")
    parser.add_argument("--alpha", type=float, default=0.01, help="level of each of the two verdicts (default: 0.01)")
    parser.add_argument("--variant", default="scalar_rgb", help="Mitsuba's variant (default: scalar_rgb)")
    parser.add_argument("--gpt", type=Path, default=HERE.parents[1] / "target" / "release" / "gpt", help="the program")
    parser.add_argument("--device", default="auto", help="gpt's device (default: auto)")
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


def compare(options, name, text):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        scene = folder / "twin.xml"
        scene.write_text(text, encoding="utf-8")
        exact = imported_exactly(options, scene)
        twin = mi.load_file(str(scene))
        pictures = [ours(options, scene, folder, seed) for seed in range(options.seeds)]
        theirs = [
            np.array(mi.render(twin, spp=options.spp // options.seeds, seed=seed), dtype=np.float64)[..., :3] for seed in range(options.seeds)
        ]
    pictures, theirs = np.stack(pictures), np.stack(theirs)
    judged = agreement.judge(pictures, theirs, options.alpha)
    means = ", ".join(f"{100 * difference:+.3f} %" for difference in judged.difference)
    print(
        f"{name}: {judged.verdict}; {judged.channels} of 3 channels and {judged.tiles} of {agreement.tile_means(theirs)[0].size} tiles × channels rejected; "
        f"means {means}{'' if exact else '; not imported exactly'}",
        flush=True,
    )
    return judged.verdict


def main():
    options = arguments()
    mi.set_variant(options.variant)
    surprises = []
    for name, material, shape, agrees in CASES:
        if options.only and options.only not in name:
            continue
        if compare(options, name, SCENE.format(material=material, shape=shape)) != ("agree" if agrees else "differ"):
            surprises.append(name)
    print(f"not as expected: {', '.join(surprises) or 'none'}")
    return 7 if surprises else 0


if __name__ == "__main__":
    sys.exit(main())
