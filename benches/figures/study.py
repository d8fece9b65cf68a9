"""Figures of docs/figures.md that need settings which are there to compare strategies: how light and material are combined, samplers of the
literature, Phong's lobe as it was published, densities."""

import random
import subprocess
from collections import Counter
from math import cos, radians, sin

import measure
from measure import BINARIES, FOLDER, Way, error, montage, record, references, render, seconds, show, table

MIS = Way("both at each place (`mis`, the default)", ["--estimator", "mis"])


def choosing():
    """Choosing between light and material, beside doing both."""
    ways = [
        Way("one of both at each place (`choose`)", ["--estimator", "choose"]),
        Way("one of both, balance heuristic", ["--estimator", "choose", "--heuristic", "balance"]),
        MIS,
    ]
    for scene, samples, spp in (("cornell", [16, 64, 256], 96), ("veach-glossy", [16, 64, 256], 128)):
        truths = references(scene, MIS, 2048)
        errors = {way.name: [error(f"choosing, {scene}", scene, way, count, truths) for count in samples] for way in ways}
        spent = seconds(f"choosing, {scene}", scene, ways, spp)
        product = {way.name: errors[way.name][-1][1] * spent[way.name] for way in ways}
        rows = [
            [way.name, *map(show, errors[way.name]), f"{spent[way.name]:.2f}", f"{product[way.name] / product[MIS.name]:.2f}"]
            for way in ways
        ]
        heading = ["estimator", *(f"{count} spp" for count in samples), "processor seconds", "relative error at equal time"]
        table(f"choosing, {scene}", heading, rows)
    shown = [(scene, way) for scene in ("cornell", "veach-glossy") for way in (ways[0], MIS)]
    montage("choosing.jpg", 2, [(*cell, 16, "--sampler", "independent", "--size", "240x180") for cell in shown])


def weighing():
    """Heuristics of multiple importance sampling."""

    def power(beta):
        return Way(f"power, β = {beta}", ["--heuristic-exponent", str(beta)])

    def cutoff(alpha):
        return Way(f"cutoff, α = {alpha}", ["--heuristic", "cutoff", "--heuristic-cutoff", str(alpha)])

    balance = Way("balance", ["--heuristic", "balance"])
    ways = [power(0.5), balance, power(2), power(4), power(16), Way("maximum", ["--heuristic", "maximum"])]
    ways += [cutoff(alpha) for alpha in (0.01, 0.1, 0.5)]
    scenes = (("veach-glossy", "plates"), ("glossy-reflection", "glossy balls"))
    errors = {}
    for scene, _ in scenes:
        truths = references(scene, balance, 2048)
        for way in ways:
            errors[scene, way.name] = [error("weighing", scene, way, count, truths) for count in (16, 64)]
    rows = [[way.name, *(show(pair) for scene, _ in scenes for pair in errors[scene, way.name])] for way in ways]
    table("weighing", ["heuristic", *(f"{name}, {count} spp" for _, name in scenes for count in (16, 64))], rows)


def phong():
    """Phong's lobe with and without its cosine, its rays below the horizon lost or flipped, and without importance sampling."""
    kept, flipped = ["--phong-cosine", "kept"], ["--phong-horizon", "flipped"]
    dropped = ["--phong-cosine", "dropped"]
    lobes = [
        Way("with its cosine, lost below the horizon (the default)", kept),
        Way("with its cosine, flipped", kept + flipped),
        Way("without its cosine, lost", dropped),
        Way("without its cosine, flipped (the thesis)", dropped + flipped),
    ]
    angles = (0, 45, 75, 85)
    rows = []
    for way in lobes:
        shares = []
        for angle in angles:
            seen = {"[0, 0, 10]": "[0, {:.6f}, {:.6f}]".format(*turned(angle))}
            found, _ = render("phong-plate", Way(way.name, way.flags, seen), FOLDER / "plate.exr", "--spp", 4096)
            shares.append(found["mean"][1])
            record("phong, reflected", "phong-plate", way.name, 4096, f"share of light reflected at {angle}°", shares[-1:])
        truths = references("glossy-reflection", way, 2048)
        pair = error("phong, reflected", "glossy-reflection", way, 64, truths)
        rows.append([way.name, *(f"{share:.3f}" for share in shares), show(pair)])
    table("phong, reflected", ["lobe", *(f"at {angle}°" for angle in angles), "balls, 64 spp"], rows)
    montage("phong.jpg", 4, [("glossy-reflection", way, 256, "--size", "240x180") for way in lobes])

    uniform = ["--phong-sampling", "hemisphere", "--hemisphere", "uniform"]
    ways = [("uniform", uniform), ("by the cosine", ["--phong-sampling", "hemisphere"]), ("by the lobe (the default)", [])]
    truths = references("glossy-reflection", MIS, 2048)
    for estimator in ("bsdf", "mis"):
        by = [Way(f"{name}", ["--estimator", estimator, *flags]) for name, flags in ways]
        figure = f"phong, sampling, {estimator}"
        errors = {way.name: [error(figure, "glossy-reflection", way, count, truths) for count in (16, 64)] for way in by}
        spent = seconds(figure, "glossy-reflection", by, 64)
        product = [errors[way.name][-1][1] * spent[way.name] for way in by]
        rows = [
            [way.name, *map(show, errors[way.name]), f"{spent[way.name]:.2f}", f"{one / product[-1]:.2f}"] for way, one in zip(by, product)
        ]
        table(figure, ["directions", "16 spp", "64 spp", "processor seconds", "relative error at equal time"], rows)
    cells = [("glossy-reflection", Way(name, ["--estimator", "mis", *flags]), 64, "--size", "240x180") for name, flags in ways]
    montage("phong-sampling.jpg", 3, [(*cell, "--sampler", "independent") for cell in cells])


def turned(degrees):
    """A camera's place 10 units from the plate, at this angle from its normal."""
    return 10 * sin(radians(degrees)), 10 * cos(radians(degrees))


def sequences():
    """Samplers of the lecture on the Cornell box: its generator, Halton's and Hammersley's points."""
    names = ("lcg", "independent", "stratified", "hammersley", "halton", "sobol")
    ways = [Way(f"`{name}`", ["--sampler", name]) for name in names]
    truths = references("cornell", ways[-1], 2048)
    samples = (25, 64, 100, 256)
    rows = [[way.name, *(show(error("sequences", "cornell", way, spp, truths)) for spp in samples)] for way in ways]
    table("sequences", ["sampler", *(f"{spp} spp" for spp in samples)], rows)
    montage("sequences.jpg", 3, [("cornell", way, 25, "--size", "256x256") for way in ways])


def basics():
    """Kinds of materials, soft shadows of lights of several sizes, and a pinhole."""
    lamp = 'name = "lamp"\ntype = "emissive"\nradiance = [14, 13, 11]'
    large, small = 'radius   = 0.35\nmaterial = "white"', 'radius   = 0.3\nmaterial = "white"'

    def material(name, kind):
        return f'[[material]]\nname = "{name}"\n{kind}'

    def balls(first, second, *further):
        """The box with its two balls of other materials."""
        both = [material("first", first), material("second", second), *further]
        return Way("balls", [], {
            lamp: "\n\n".join([lamp, *both]),
            large: large.replace("white", "first"),
            small: small.replace("white", "second"),
        })

    exponents = Way("three kinds", [], {
        'name = "sharp"\ntype = "glossy"\nreflectance = 0.8\nexponent = 1000': 'name = "sharp"\ntype = "mirror"\nreflectance = 0.8',
        'name = "dull"\ntype = "glossy"\nreflectance = 0.8\nexponent = 10': 'name = "dull"\ntype = "diffuse"\nreflectance = 0.8',
    })
    glowing = balls('type = "emissive"\nradiance = [0.2, 0.3, 0.5]', 'type = "emissive"\nradiance = [2, 1.2, 0.4]')
    smooth = balls('type = "mirror"', 'type = "glass"\nior = 1.5')
    share = 'type = "blend"\nmaterials = ["{}", "{}"]\nweight = {{ type = "constant", value = {} }}'
    # 60 % diffuse, 20 % mirrored and 20 % transmitted; and half diffuse, half mirrored.
    combined = balls(
        share.format("white", "rest", 0.6),
        share.format("white", "mirror", 0.5),
        material("rest", share.format("mirror", "glass", 0.5)),
        material("mirror", 'type = "mirror"'),
        material("glass", 'type = "glass"\nior = 1.5'),
    )
    cells = [("glossy-reflection", exponents), ("box", glowing), ("box", smooth), ("box", combined)]
    cells = [(*cell, 256, "--size", "240x180") for cell in cells]
    for radius in (0.15, 0.3, 0.6):
        # The power is the same.
        light = {
            'radius   = 0.6\nmaterial = "lamp"': f'radius   = {radius}\nmaterial = "lamp"',
            'name = "lamp"\ntype = "emissive"\nradiance = 6': f'name = "lamp"\ntype = "emissive"\nradiance = {6 * (0.6 / radius) ** 2:g}',
        }
        cells.append(("soft-shadow", Way("sizes", [], light), 64, "--exposure", "0.5"))
    pinhole = {'aperture = { shape = "disk", radius = 0.12 }\nfocus_distance = 5': ""}
    cells.append(("lens", Way("pinhole", [], pinhole), 128))
    montage("basics.jpg", 4, cells)


def dice():
    """The sum of two dice: how probable it is, and how often it was thrown."""
    generator = random.Random(2)
    throws = 100_000
    sums = Counter(generator.randint(1, 6) + generator.randint(1, 6) for _ in range(throws))
    rows, below, thrown = [], 0, 0
    for total in range(2, 13):
        ways = 6 - abs(7 - total)
        below, thrown = below + ways, thrown + sums[total]
        record("dice", "two dice", f"sum of {total}", throws, "share, and share up to it: predicted, thrown", [ways / 36, sums[total] / throws, below / 36, thrown / throws])
        rows.append([total, f"{ways}/36", f"{sums[total] / throws:.4f}", f"{below / 36:.4f}", f"{thrown / throws:.4f}"])
    table("dice", ["sum", "probability", "share of 100,000 throws", "distribution function F", "share of throws up to it"], rows)


# The table of the thesis that each panel belongs to, and its density there.
DENSITIES = {
    "p = 3x²": "figure 3, p = x²",
    "disk, uniform polar coordinates": "figure 4, left",
    "disk": "figure 4, right; tables 4–6, 1/(πR²)",
    "sphere": "figure 5; tables 4–6, 1/(4πr²)",
    "half of a sphere that a point sees": "figure 19",
    "cone to a sphere at 1.5 radii": "figure 21, left; tables 4–6, 1/(2π(1 − cos θmax))",
    "cone to a sphere at 2 radii": "figure 21, middle",
    "cone to a sphere at 5 radii": "figure 21, right",
    "hemisphere, uniform": "figure 24; tables 4–6, 1/(2π)",
    "hemisphere, cosine": "figure 25; tables 4–6, cos θ/π",
    "Phong, n = 1": "figure 28, left; tables 4–6, (n + 1)/(2π) cosⁿθ",
    "Phong, n = 10": "figure 28, middle",
    "Phong, n = 100": "figure 28, right",
    "triangle": "the lecture, 1/A",
}


def densities():
    """Points of every density, and how far a million of them are from it."""
    measure.PICTURES.mkdir(exist_ok=True)
    command = [str(BINARIES / "examples" / "densities"), str(measure.PICTURES / "densities.png")]
    lines = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, encoding="utf-8").stdout.splitlines()
    rows = []
    for line in lines:
        name, coordinate, *values = line.rsplit(",", 4)
        values = [float(value) for value in values]
        record("densities", name, coordinate, 1_000_000, "mean: measured, predicted; largest of 32 bins in standard deviations", values)
        mean, predicted, worst = values
        rows.append([name, DENSITIES[name], coordinate, f"{mean:.5f}", f"{round(predicted, 5) + 0.0:.5f}", f"{worst:.1f}"])
    heading = ["density", "in the works", "coordinate", "mean of a million points", "predicted", "largest of 32 bins, in standard deviations"]
    table("densities", heading, rows)
