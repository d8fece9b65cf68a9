#!/usr/bin/env python3
"""Renders one sphere in every material that gpt and Mitsuba 3 define alike, and says material by material whether the pictures agree.

Each material gets the verdict of mitsuba_ogre.py: Welch's t on seeds, of the whole picture and of tiles, with a negative control.
`phong`, `glossy`, and weights that depend on the view have no counterpart in Mitsuba 3. Its blend is wrong where a part is a mirror
(README.md), so blends are of smooth materials here.

Mitsuba's rough metal and rough glass take G1·G1 for shadowing and masking, this project the height-correlated term, which loses less
light at grazing angles. So rough metals are compared twice: with Mitsuba's own, where a difference is expected, and with one that
differs from it in that term alone (correlated_conductor.py), where none is.

Exit status: 0 if every material came out as expected, 7 otherwise.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import mitsuba as mi
import numpy as np

HERE = Path(__file__).resolve().parent

SCENE = """[film]
size = [192, 144]

[render]
max_depth = 6

[camera]
position = [0, 1.6, 5]
look_at  = [0, 0.8, 0]
vfov     = 32

[[material]]
name = "ground"
type = "diffuse"
reflectance = [0.5, 0.45, 0.4]

[[material]]
name = "lamp"
type = "emissive"
radiance = [9, 8, 7]

[[material]]
name = "base"
type = "diffuse"
reflectance = [0.1, 0.3, 0.6]

{material}

[[shape]]
type     = "sphere"
center   = [0, 1, 0]
radius   = 1
material = "target"

[[shape]]
type     = "rectangle"
corner   = [-8, 0, 8]
edge_u   = [16, 0, 0]
edge_v   = [0, 0, -16]
material = "ground"

[[shape]]
type     = "rectangle"
corner   = [-3.4, 3.4, 1.6]
edge_u   = [0.7, 1.2, -0.8]
edge_v   = [1.4, 0, 1.2]
material = "lamp"

[[light]]
type     = "environment"
radiance = [0.35, 0.38, 0.42]
"""

TARGET = '[[material]]\nname = "target"\n'
ROUGH_GOLD = '[[material]]\nname = "metal"\ntype = "conductor"\npreset = "gold"\nalpha = 0.4\n\n'
BLEND = TARGET + 'type = "blend"\nmaterials = ["base", "metal"]\nweight = {{ type = "constant", value = {} }}'

# Name, material, which rough metal Mitsuba takes, whether agreement is expected.
OWN, CORRELATED = "roughconductor", "correlatedconductor"
CASES = [
    ("diffuse", TARGET + 'type = "diffuse"\nreflectance = [0.7, 0.4, 0.2]', OWN, True),
    ("mirror", TARGET + 'type = "mirror"\nreflectance = [0.9, 0.8, 0.7]', OWN, True),
    ("glass", TARGET + 'type = "glass"\nior = 1.5', OWN, True),
    *(
        (f"smooth {metal}", TARGET + f'type = "conductor"\npreset = "{metal}"\nalpha = 0', OWN, True)
        for metal in ("gold", "copper", "silver", "aluminium")
    ),
    ("gold, alpha 0.15", TARGET + 'type = "conductor"\npreset = "gold"\nalpha = 0.15', CORRELATED, True),
    ("gold, alpha 0.4", TARGET + 'type = "conductor"\npreset = "gold"\nalpha = 0.4', CORRELATED, True),
    ("copper, alpha 0.8", TARGET + 'type = "conductor"\npreset = "copper"\nalpha = 0.8', CORRELATED, True),
    ("copper, alpha 0.8, shadowing G1·G1", TARGET + 'type = "conductor"\npreset = "copper"\nalpha = 0.8', OWN, False),
    ("rough glass, alpha 0.1", TARGET + 'type = "rough_glass"\nior = 1.5\nalpha = 0.1', OWN, True),
    ("rough glass, alpha 0.5, shadowing G1·G1", TARGET + 'type = "rough_glass"\nior = 1.5\nalpha = 0.5', OWN, False),
    ("blend 0.3 of diffuse and gold", ROUGH_GOLD + BLEND.format(0.3), CORRELATED, True),
    ("blend 0.8 of diffuse and gold", ROUGH_GOLD + BLEND.format(0.8), CORRELATED, True),
]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, default=1024, help="samples per pixel in all (default: 1024)")
    parser.add_argument("--seeds", type=int, default=8, help="replications they are split into, at least 2 (default: 8)")
    parser.add_argument("--alpha", type=float, default=0.01, help="level of each of the two verdicts (default: 0.01)")
    parser.add_argument("--gpt", type=Path, default=HERE.parents[1] / "target" / "release" / "gpt", help="the program")
    parser.add_argument("--device", default="auto", help="gpt's device (default: auto)")
    parser.add_argument("--only", help="materials whose name holds this")
    parser.add_argument("--keep", type=Path, help="folder for the mean pictures and their differences, as EXR")
    return parser.parse_args()


def presets_differ(export_mitsuba):
    """Holds the presets against what Mitsuba makes of the same metals' spectra, and prints the largest deviation."""
    largest = 0.0
    for eta, k, name in export_mitsuba.METALS.values():
        theirs = mi.traverse(mi.load_dict({"type": "conductor", "material": name}))
        for our, key in ((eta, "eta.value"), (k, "k.value")):
            other = np.array(theirs[key]).ravel()
            largest = max(largest, float(np.max(np.abs(np.array(our) / other - 1))))
    print(f"presets of metals against Mitsuba's: largest deviation of eta and k {100 * largest:.2f} %")
    return largest > 0.005


def main():
    options = arguments()
    options.variant, options.mitsuba_only = "llvm_ad_rgb", False
    mi.set_variant(options.variant)
    import correlated_conductor  # noqa: F401  registers a plugin; needs the variant
    import export_mitsuba
    import mitsuba_ogre

    surprises, keep = ["presets"] if presets_differ(export_mitsuba) else [], options.keep
    for name, material, rough_conductor, agrees in CASES:
        if options.only and options.only not in name:
            continue
        print(f"\n== {name}; {'agreement' if agrees else 'a difference'} is expected", flush=True)
        export_mitsuba.ROUGH_CONDUCTOR = rough_conductor
        options.keep = keep / name.replace(" ", "-") if keep else None
        with tempfile.TemporaryDirectory() as folder:
            options.scene = Path(folder) / "sphere.toml"
            options.scene.write_text(SCENE.format(material=material), encoding="utf-8")
            if mitsuba_ogre.compare(options) != (0 if agrees else 7):
                surprises.append(name)
    print(f"\nnot as expected: {', '.join(surprises) or 'none'}")
    return 7 if surprises else 0


if __name__ == "__main__":
    sys.exit(main())
