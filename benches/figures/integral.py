"""The integral of x³ over [0, 1], which is 1/4, estimated with a uniform density, a similar one and a mismatched one."""

import math
import random

RUNS = 1000
# Name, x of a uniform number, density at x, variance of one sample f/p.
DENSITIES = [
    ("p = 1", lambda u: u, lambda x: 1.0, 1 / 7 - 1 / 16),
    ("p = 2x", math.sqrt, lambda x: 2 * x, 1 / 12 - 1 / 16),
    # ∫x⁶/(3/2 − x) by division: (3/2)⁶ ln 3 less the integrals of the quotient's terms.
    (
        "p = 3/2 − x",
        lambda u: 1.5 - math.sqrt(2.25 - 2 * u),
        lambda x: 1.5 - x,
        1.5**6 * math.log(3) - sum(1.5 ** (5 - power) / (power + 1) for power in range(6)) - 1 / 16,
    ),
]


def rows(counts=(25, 100, 400, 1000)):
    """For each density and number of samples: root mean square deviation, what theory says, and the largest deviation of 1,000 runs."""
    generator = random.Random(43)
    for name, sample, density, variance in DENSITIES:
        for count in counts:
            deviations = []
            for _ in range(RUNS):
                # 1 − u is never 0, where the second density vanishes.
                points = [sample(1 - generator.random()) for _ in range(count)]
                deviations.append(sum(x**3 / density(x) for x in points) / count - 0.25)
            measured = math.sqrt(sum(d * d for d in deviations) / RUNS)
            yield name, count, measured, math.sqrt(variance / count), max(map(abs, deviations))
