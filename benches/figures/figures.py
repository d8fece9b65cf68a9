#!/usr/bin/env python3
"""The figures of docs/figures.md: which scenes, which ways of rendering them, what is measured. `scripts/figures` builds and runs this."""

import argparse

import integral
import study
from measure import SEEDS, Way, be_quick, error, keep_errors, montage, record, references, samplers, seconds, show, table, write_numbers

BSDF = Way("material sampling alone (`bsdf`)", ["--estimator", "bsdf"])
NEE = Way("light sampling (`nee`)", ["--estimator", "nee"])
MIS = Way("both, power heuristic (`mis`)", ["--estimator", "mis"])
BALANCE = Way("both, balance heuristic", ["--estimator", "mis", "--heuristic", "balance"])


def ways_by_samples(figure, scene, ways, samples, truths, time_spp, time_ways=None):
    """Rows of a table: errors at several numbers of samples, processor seconds, relative error times seconds as a ratio to the last way."""
    errors = {way.name: [error(figure, scene, way, spp, truths) for spp in samples] for way in ways}
    spent = seconds(figure, scene, time_ways or ways, time_spp)
    product = {way.name: errors[way.name][-1][1] * spent[way.name] for way in ways}
    last = product[ways[-1].name]
    for way in ways:
        yield [way.name, *map(show, errors[way.name]), f"{spent[way.name]:.2f}", f"{product[way.name] / last:.2f}"]


def heading(first, samples):
    return [first, *(f"{spp} spp" for spp in samples), "processor seconds", "relative error at equal time"]


def estimators():
    """Naive path tracing, light sampling, both."""
    samples = [4, 16, 64, 256]
    truths = references("box", MIS, 1024)
    rows = ways_by_samples("estimators", "box", [BSDF, NEE, MIS], samples, truths, 96)
    table("estimators", heading("estimator", samples), rows)
    montage("estimators.jpg", 4, [("box", way, spp, "--sampler", "independent") for way in (BSDF, NEE) for spp in samples])


def shadows():
    """Ways of sampling a sphere light, in its shadow."""
    close = {"position = [-0.4, 1.9, 4.2]": "position = [-1.5, 1.6, 0.7]", "look_at  = [0.1, 0.75, 0]": "look_at  = [-0.65, 0, -0.3]"}
    point = {
        'radius   = 0.6\nmaterial = "lamp"': 'radius   = 0.6\nmaterial = "gone"',
        'name = "lamp"\ntype = "emissive"\nradiance = 6': 'name = "gone"\ntype = "pass"\n\n'
        # A sphere of radiance L and radius R sends out πR²L in every direction.
        '[[light]]\ntype = "point"\nposition = [1, 1.8, 0.4]\nintensity = 6.79',
    }
    names = ("area", "visible", "cone")
    samples = [4, 16, 64]
    truths = references("soft-shadow", Way("cone", ["--estimator", "nee"], close), 1024)
    for estimator in ("nee", "mis"):
        ways = [Way(f"`{name}`", ["--estimator", estimator, "--light-sampling", name], close) for name in names]
        rows = ways_by_samples(f"shadows, {estimator}", "soft-shadow", ways, samples, truths, 128)
        table(f"shadows, {estimator}", heading("points on the light", samples), rows)
    flags = ("--sampler", "independent", "--estimator", "nee", "--exposure", "0.5")
    cells = [("soft-shadow", Way("point", [], point), 16, *flags)]
    cells += [("soft-shadow", Way(name, ["--light-sampling", name]), 16, *flags) for name in names]
    montage("shadows.jpg", 4, cells)


def hemispheres():
    """Uniform and cosine-weighted directions."""
    samples = [4, 16, 64]
    truths = references("box", MIS, 1024)
    for estimator in ("bsdf", "nee", "mis"):
        ways = [Way(f"`{name}`", ["--estimator", estimator, "--hemisphere", name]) for name in ("uniform", "cosine")]
        rows = ways_by_samples(f"hemispheres, {estimator}", "box", ways, samples, truths, 96)
        table(f"hemispheres, {estimator}", heading("directions", samples), rows)
    ways = [Way(name, ["--estimator", "bsdf", "--hemisphere", name, "--sampler", "independent"]) for name in ("uniform", "cosine")]
    montage("hemispheres.jpg", 3, [("box", way, spp) for way in ways for spp in (16, 64, 256)])


def glossy():
    """Glossy reflections and refractions."""
    for scene in ("glossy-reflection", "glossy-refraction"):
        truths = references(scene, MIS, 2048)
        rows = ways_by_samples(scene, scene, [BSDF, NEE, MIS], [16, 64], truths, 128)
        table(scene, heading("estimator", [16, 64]), rows)
    montage("glossy.jpg", 2, [(scene, MIS, 160, "--size", "320x240") for scene in ("glossy-reflection", "glossy-refraction")])


def aliasing():
    """The position inside the pixel."""
    names = ("none", "independent", "stratified", "halton", "quadrant", "sobol")
    ways = [Way(f"`{name}`", ["--pixel-sampler", name]) for name in names]
    truths = references("aliasing", ways[3], 2048, "80x60")
    samples = [16, 64]
    rows = [[way.name, *(show(error("aliasing", "aliasing", way, spp, truths, "80x60")) for spp in samples)] for way in ways]
    table("aliasing", ["position inside the pixel", *(f"{spp} spp" for spp in samples)], rows)
    montage("aliasing.png", 3, [("aliasing", way, 16, "--size", "80x60") for way in ways], enlarge=3)


APERTURE = 'aperture = { shape = "disk", radius = 0.12 }\nfocus_distance = 5'


def lenses():
    """Depth of field, aperture shapes, samplers of the lens."""

    def lens(shape, radius, distance):
        return {APERTURE: f'aperture = {{ shape = "{shape}", radius = {radius} }}\nfocus_distance = {distance}'}

    distances = ((0.03, 3.8), (0.03, 5), (0.03, 6.6), (0.12, 3.8), (0.12, 5), (0.12, 6.6))
    montage("focus.jpg", 3, [("lens", Way("", [], lens("square", *pair)), 128) for pair in distances])
    montage("apertures.jpg", 3, [("lens", Way("", [], lens(shape, 0.12, 3.8)), 256) for shape in ("square", "disk", "polygon")])
    samplers = ("independent", "stratified", "halton", "sobol")
    ways = [Way(f"`{name}`", ["--sampler", name, "--pixel-sampler", "halton"]) for name in samplers]
    truths = references("lens", ways[2], 1024)
    rows = [[way.name, *(show(error("lenses", "lens", way, spp, truths)) for spp in (16, 64))] for way in ways]
    table("lenses", ["sampler, lens included", "16 spp", "64 spp"], rows)


PAINTS = ("glossy paint", "frosted paint", "foil", "car paint", "wall paint")
PAINTS_FROM_AFAR = "position = [0, 1.5, 7]\nlook_at  = [0, 0.5, 0]\nvfov     = 17"
# What each paint is replaced by: blends of what its layers are made of, weighed by how much the top lets through.
TOP = 'weight = { type = "fresnel", ior = %s, exact = true }'
GLOSS = '[[material]]\nname = "gloss"\ntype = "conductor"\nreflectance = 1\nalpha = %s\n\n'
MIXED = '[[material]]\nname = "mixed"\ntype = "blend"\nmaterials = ["%s", "%s"]\nweight = %s\n\n'
IMITATIONS = {
    "glossy paint": ('type = "layered"\ninterfaces = ["varnish", "red"]', 'type = "blend"\nmaterials = ["red", "gloss"]\n' + TOP % 1.5, GLOSS % 0),
    "frosted paint": (
        'type = "layered"\ninterfaces = ["frost", "red"]\nslabs = [{ thickness = 0.1, medium = "haze" }]',
        'type = "blend"\nmaterials = ["red", "gloss"]\n' + TOP % 1.5,
        GLOSS % 0.35,
    ),
    "foil": (
        'type = "layered"\ninterfaces = ["film", "copper"]',
        'type = "blend"\nmaterials = ["copper", "gloss"]\n' + TOP % 1.45,
        GLOSS % 0.06,
    ),
    "car paint": (
        'type = "layered"\ninterfaces = ["varnish", "flakes"]\nslabs = [{ thickness = 0.25, medium = "blue" }]',
        'type = "blend"\nmaterials = ["mixed", "gloss"]\n' + TOP % 1.5,
        GLOSS % 0
        + '[[material]]\nname = "blue"\ntype = "diffuse"\nreflectance = [0.02, 0.1, 0.35]\n\n'
        + '[[material]]\nname = "blue flakes"\ntype = "conductor"\nreflectance = [0.1, 0.4, 0.85]\nalpha = 0.4\n\n'
        + MIXED % ("blue flakes", "blue", '{ type = "constant", value = 0.7 }'),
    ),
    "wall paint": (
        'type = "layered"\ninterfaces = ["binder", "binder", "plaster"]\n'
        'slabs = [{ thickness = { texture = "worn", factor = 0.4 }, medium = "white" }, { thickness = 0.3, medium = "green" }]',
        'type = "blend"\nmaterials = ["mixed", "gloss"]\n' + TOP % 1.33,
        GLOSS % 0.5
        + '[[material]]\nname = "white"\ntype = "diffuse"\nreflectance = 0.8\n\n'
        + '[[material]]\nname = "green"\ntype = "diffuse"\nreflectance = [0.1, 0.55, 0.15]\n\n'
        + MIXED % ("white", "green", '{ type = "texture", texture = "worn" }'),
    ),
}


def cameras():
    """A hall as nine cameras see it."""
    keys = (
        "vfov = 70",
        'projection = "cylindrical"\nazimuth = [-100, 100]',
        'projection = "equirectangular"\nazimuth = [-135, 135]',
        'projection = "fisheye"\nfov = 180',
        'projection = "fisheye"\nfov = 250\nmapping = "stereographic"\nfit = "diagonal"',
        'projection = "kannala_brandt"\nfocal = [75, 75]\nradial = [-0.02, 0.004, -0.003, 0.0004]',
        'projection = "brown_conrady"\nfocal = [120, 120]\nradial = [-0.3, 0.11, -0.016]',
        'projection = "cube_map"\nlayout = "grid"',
        'projection = "equirectangular"\nstereo = { layout = "top_bottom", eye_distance = 0.3 }',
    )
    montage("cameras.jpg", 3, [("hall", Way(key, [], {"vfov     = 70": key}), 256) for key in keys])


def layers():
    """Paints of real layers, their imitations by blends, and Weidlich and Wilkie's approximation."""
    rows = []
    everything = {}
    for place, paint in enumerate(PAINTS):
        x = 0.95 * (place - 2)
        close = {PAINTS_FROM_AFAR: f"position = [{x}, 0.9, 4]\nlook_at  = [{x}, 0.43, 0]\nvfov     = 14"}
        named = f'[[material]]\nname = "{paint}"\n'
        old, new, more = IMITATIONS[paint]
        blended = {named + old: (more + named).replace('"mixed"', f'"mixed {place}"').replace('"gloss"', f'"gloss {place}"') + new}
        blended = {key: value.replace('["mixed"', f'["mixed {place}"').replace('"gloss"]', f'"gloss {place}"]') for key, value in blended.items()}
        straight = {named + old: f'{named}{old}\nmodel = "weidlich-wilkie"'}
        everything |= blended
        # On the CPU: the errors are those of models, and kernels of layers beside blends take long to compile.
        cpu = ["--device", "cpu"]
        real = Way("layers", cpu, close)
        ways = [real, Way("blend", cpu, close | blended), Way("Weidlich and Wilkie", cpu, close | straight)]
        figure = f"layers, {paint}"
        truths = references("paints", real, 128)
        spent = seconds(figure, "paints", ways, 16, "96x72", rounds=1)
        errors = [error(figure, "paints", way, 128, truths, seeds=SEEDS[:1])[1] for way in ways[1:]]
        noise = [error(figure, "paints", way, 16, truths, seeds=SEEDS[:1])[1] for way in ways[:1]]
        ratio = [spent[way.name] / spent["layers"] for way in ways[1:]]
        rows.append([paint, f"{noise[0]:.2e}", *(f"{wrong:.2e}, {share:.2f}" for wrong, share in zip(errors, ratio))])
    table("layers", ["paint", "noise of layers at 16 spp", "blend: error, seconds", "Weidlich and Wilkie: error, seconds"], rows)
    montage("layers.jpg", 1, [("paints", Way("layers"), 256), ("paints", Way("blends", [], everything), 256)])


def motion():
    """Motion blur in different directions, and of turns."""
    left, right = "motion    = [{ translate = [0.4, 0, 0] }]", "motion    = [{ translate = [0, 0.4, 0] }]"
    turns = {
        left: "motion    = [{ rotate = [0, 1, 0], degrees = 40 }]",
        right: "motion    = [{ rotate = [0, 0, 1], degrees = 40 }, { translate = [0.2, 0.2, 0] }]",
    }
    ways = [Way("at rest", [], {"shutter  = [0, 1]": "shutter  = [0, 0]"}), Way("straight"), Way("turning", [], turns)]
    montage("motion.jpg", 3, [("motion", way, 160) for way in ways])


def extensions():
    """Textures and meshes."""
    montage("extensions.jpg", 2, [(scene, MIS, 160, "--size", "320x240") for scene in ("textures", "meshes")])


def integrals():
    """A one-dimensional integral with two densities."""
    rows = list(integral.rows())
    for name, count, *values in rows:
        record("integrals", "x³ over [0, 1]", name, count, "deviation: root mean square, predicted, largest of 1,000", values)
    shown = [[name, count, *(f"{value:.5f}" for value in values)] for name, count, *values in rows]
    table("integrals", ["density", "samples", "root mean square deviation", "predicted", "largest of 1,000"], shown)


def importance():
    """Material, light and multiple importance sampling."""
    truths = references("veach-glossy", MIS, 2048)
    ways = [BSDF, NEE, BALANCE, MIS]
    table("importance", heading("estimator", [16, 64]), ways_by_samples("importance", "veach-glossy", ways, [16, 64], truths, 128))
    truths = references("cornell", MIS, 1024)
    rows = ways_by_samples("importance, Cornell box", "cornell", [BSDF, MIS], [64, 256], truths, 96)
    table("importance, Cornell box", heading("estimator", [64, 256]), rows)
    montage("importance.jpg", 3, [("veach-glossy", way, 16, "--sampler", "independent") for way in (BSDF, NEE, MIS)])


def roulette():
    """Russian roulette on the Cornell box."""

    def way(name, first, longest):
        return Way(name, [], {"[render]\nmax_depth = 8\n": f"[render]\nroulette_depth = {first}\nmax_depth = {longest}\n"})

    ways = [
        way("none, 128 edges", 0, 128),
        way("from the first hit, 128 edges", 1, 128),
        way("from edge 2, 128 edges", 2, 128),
        way("from edge 5 (the default), 128 edges", 5, 128),
        way("from edge 5, no limit", 5, 0),
    ]
    truths = references("cornell", ways[-1], 1024)
    errors = [error("roulette", "cornell", one, 64, truths) for one in ways]
    spent = seconds("roulette", "cornell", ways, 48, "256x256")
    least = [spent[one.name] for one in ways]
    rows = [
        [one.name, show(pair), f"{time:.2f}", f"{100 * (time / least[0] - 1):+.0f} %", f"{pair[1] * time / (errors[0][1] * least[0]):.2f}"]
        for one, pair, time in zip(ways, errors, least)
    ]
    table("roulette", ["roulette", "error at 64 spp", "processor seconds", "time against none", "relative error at equal time"], rows)


def fog():
    """Distance sampling and equi-angular sampling in fog, by light samples alone and with the phase function."""
    samples = [16, 64, 256]
    ways = [
        Way(f"`{places}`, {words}", ["--distance-sampling", places, "--estimator", estimator])
        for places in ("distance", "equiangular", "mis")
        for estimator, words in (("nee", "light samples alone"), ("mis", "with the phase function"))
    ]
    truths = references("foggy-lamps", ways[-1], 4096)
    table("fog", heading("places, directions", samples), ways_by_samples("fog", "foggy-lamps", ways, samples, truths, 64))
    montage("fog.jpg", 3, [("foggy-lamps", way, 16, "--sampler", "independent") for way in ways[::2] + ways[1::2]])


def smoke():
    """Light samples and phase functions in smoke that a grid describes."""
    samples = [16, 64]
    truths = references("bonfire", MIS, 2048)
    table("smoke", heading("estimator", samples), ways_by_samples("smoke", "bonfire", [BSDF, NEE, MIS], samples, truths, 16))
    montage("smoke.jpg", 3, [("bonfire", way, 64, "--size", "240x320", "--sampler", "independent") for way in (BSDF, NEE, MIS)])


BLEND = 'weight = { type = "constant", value = 1 }'


def heuristics():
    """Every heuristic of blends on a ball, with two parameters each."""

    def facing(power):
        return f'{{ type = "facing", power = {power} }}'

    weights = [
        *(f'{{ type = "constant", value = {value} }}' for value in (1, 0.5)),
        *map(facing, (0.2, 10)),
        *(f'{{ type = "fresnel", ior = {ior} }}' for ior in (1, 2.5)),
        *(f'{{ type = "threshold", tau = {tau}, of = {facing(5)} }}' for tau in (0.05, 0.2)),
    ]
    cells = [("heuristics", Way(weight, [], {BLEND: f"weight = {weight}"}), 256) for weight in weights]
    # The first parameters above, the second below.
    montage("heuristics.jpg", 4, cells[::2] + cells[1::2])


def mixed_glass():
    """Silver and green rough glass in one surface."""
    montage("silver-and-glass.jpg", 1, [("silver-and-glass", MIS, 1024)])


def aging():
    """Materials that change with time: drying paint, a stone that dries, dust that settles."""
    scenes = ("drying-paint", "drying-stone", "dust")
    montage("aging.jpg", 4, [(scene, MIS, 256, "--frame", frame) for scene in scenes for frame in (0, 16, 32, 48)])


def strata():
    """Strata whose indices a path's surfaces share, beside those of their own and none."""
    samples = [16, 64, 256]
    names = ("independent", "shared_strata", "stratified")
    truths = references("box", MIS, 1024)
    for estimator in ("bsdf", "mis"):
        ways = [Way(f"`{name}`", ["--estimator", estimator, "--sampler", name]) for name in names]
        rows = ways_by_samples(f"strata, {estimator}", "box", ways, samples, truths, 96)
        table(f"strata, {estimator}", heading("sampler", samples), rows)


FIGURES = {
    figure.__name__: figure
    for figure in (
        *(estimators, shadows, hemispheres, glossy, aliasing, lenses, motion, layers, extensions, integrals, importance, roulette, fog, smoke, samplers),
        *(heuristics, mixed_glass, aging, strata, cameras),
        *(study.choosing, study.weighing, study.phong, study.sequences, study.densities, study.basics, study.dice),
    )
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("figures", nargs="*", metavar="FIGURE", help="which to make again (default: all)")
    parser.add_argument("--times", action="store_true", help="keep the errors of benches/figures/numbers.csv and measure times again")
    parser.add_argument("--list", action="store_true", help="name the figures and stop")
    parser.add_argument("--quick", action="store_true", help="make everything of a few pixels, and keep nothing: does it still run?")
    chosen = parser.parse_args()
    unknown = [name for name in chosen.figures if name not in FIGURES]
    if unknown:
        parser.error(f"no such figure: {', '.join(unknown)}; there are {', '.join(FIGURES)}")
    if chosen.list:
        for name, figure in FIGURES.items():
            print(f"{name:12} {figure.__doc__}")
        return
    if chosen.times:
        keep_errors()
    if chosen.quick:
        be_quick()
    for name in chosen.figures or FIGURES:
        FIGURES[name]()
        write_numbers()


if __name__ == "__main__":
    main()
