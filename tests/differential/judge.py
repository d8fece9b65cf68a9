"""Whether two pictures of one scene show the same radiance: z-tests of tiles, of which a whole run tells the level.

A picture comes with the variance of each pixel's mean, so that nothing has to be supposed about how much a renderer scatters. The tests of a
scene are those of its tiles' means and of the picture's mean, in each channel. Šidák's correction holds over the tests of a scene, and in the
verdict over all scenes of the run."""

import math
from dataclasses import dataclass

import numpy

# Pixels along each side of a tile.
TILE = 4
# The share of the mean that may differ without a test noticing: one program counts in single precision and interpolates tables of Fresnel's
# equations and of spectra.
ROUNDING = 1e-3
# Radiance below which nothing is judged.
DARK = 1e-5
# That a scene which agrees is rendered again with more samples.
SUSPICION = 0.05
# That anything is found in a whole run in which all scenes agree.
LEVEL = 0.001


@dataclass
class Picture:
    """Linear Rec.709 with the variance of each pixel's mean. `correlation`: times how much more a tile's mean varies than independent pixels'
    would, as where a filter spreads a sample over several."""

    mean: numpy.ndarray
    variance: numpy.ndarray
    correlation: float = 1.0

    def scaled(self, factor):
        return Picture(self.mean * factor, self.variance * factor**2, self.correlation)

    def mirrored(self):
        return Picture(self.mean[:, ::-1], self.variance[:, ::-1], self.correlation)


@dataclass
class Judgement:
    largest_z: float
    # The probability of such a z among the tests of this scene that come from one radiance.
    chance: float
    # The channels' means, ours over theirs less 1.
    difference: list

    def found(self, level):
        return self.chance < level


def of_replications(pictures):
    """A picture from several renders that differ in their random numbers alone, stacked on the first axis."""
    count = len(pictures)
    mean, variance = pictures.mean(axis=0), pictures.var(axis=0, ddof=1) / count
    of_tiles = _tiles(pictures.transpose(1, 2, 3, 0)).var(axis=-1, ddof=1) / count
    independent = _tiles(variance) / TILE**2
    whole = independent.sum()
    return Picture(mean, variance, max(1.0, float(of_tiles.sum() / whole)) if whole > 0 else 1.0)


def judge(ours, theirs):
    """The verdict on two pictures, before it is held against a level."""
    finite = numpy.isfinite(ours.mean).all() and numpy.isfinite(theirs.mean).all()
    if not finite or ours.mean.shape != theirs.mean.shape:
        return Judgement(math.inf, 0.0, [math.nan] * 3)
    scores = []
    for means, share in ((_tiles, TILE**2), (_whole, ours.mean.shape[0] * ours.mean.shape[1])):
        a, b = means(ours.mean), means(theirs.mean)
        noise = (means(ours.variance) * ours.correlation + means(theirs.variance) * theirs.correlation) / share
        excess = numpy.maximum(numpy.abs(a - b) - ROUNDING * numpy.maximum(numpy.abs(a), numpy.abs(b)) - DARK, 0.0)
        scores.append((excess / numpy.sqrt(noise + 1e-20)).ravel())
    scores = numpy.concatenate(scores)
    largest = float(scores.max())
    of_one = math.erfc(largest / math.sqrt(2.0))
    chance = -math.expm1(len(scores) * math.log1p(-of_one)) if of_one < 1.0 else 1.0
    a, b = _whole(ours.mean), _whole(theirs.mean)
    difference = [float(x / y - 1.0) if y > 0 else (0.0 if x == y else math.inf) for x, y in zip(a, b)]
    return Judgement(largest, chance, difference)


def level_of(scenes):
    """The level of each scene's verdict, for the whole run to have LEVEL."""
    return -math.expm1(math.log1p(-LEVEL) / max(scenes, 1))


def _tiles(values):
    height, width = values.shape[:2]
    rows, columns = range(0, height, TILE), range(0, width, TILE)
    return numpy.array([[values[y : y + TILE, x : x + TILE].mean(axis=(0, 1)) for x in columns] for y in rows])


def _whole(values):
    return values.mean(axis=(0, 1))
