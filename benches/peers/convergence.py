"""Time to equal error, from replications of pictures at several sample counts.

The error is the relative mean squared error as `gpt compare` defines it: (a − b)² / (c² + 0.01), averaged over pixels and channels. The
reference b is the mean of all that gpt rendered of the scene, and its own noise, which its replications tell, is taken off. For gpt's own
pictures it is their mean instead: of K pictures with different seeds, Σ (x − mean)² / (K − 1) is the variance of one of them without
bias. That gpt's mean is the others' as well is what agreement.py shows.

The brightness c that errors are relative to is of all renderers together, the less noisy ones counting more. Relative to what a renderer
found alone, its own fireflies would hide themselves: where they are, the brightness is theirs.
"""

from dataclasses import dataclass

import numpy as np

RELATIVE_EPSILON = 1e-2
# The variance of a mean falls at least as fast as 1/N; with the best points in smooth scenes a little faster than N to the −1.5. What a fit
# finds beyond that is noise, and would be blown up where it is carried far.
SLOPES = (-1.6, -1.0)
# How often the weights of renderers are found anew.
BRIGHTNESS_ROUNDS = 4


def relative_errors(pictures, brightness):
    """The mean squared error of each of the pictures (first axis) about their own mean, relative to a brightness, without bias on the average."""
    count = len(pictures)
    squares = (pictures - pictures.mean(axis=0)) ** 2 * (count / (count - 1))
    return (squares / (brightness**2 + RELATIVE_EPSILON)).mean(axis=(1, 2, 3))


@dataclass
class Reference:
    """The mean of independent pictures and how uncertain it is."""

    picture: np.ndarray
    brightness: np.ndarray
    """What errors are relative to."""
    noise: float
    """Its own expected relative mean squared error."""

    def errors(self, pictures):
        """The relative mean squared error of each of the pictures (first axis), which took no part in the reference."""
        squares = (pictures - self.picture) ** 2 / (self.brightness**2 + RELATIVE_EPSILON)
        return np.maximum(squares.mean(axis=(1, 2, 3)) - self.noise, 1e-12)


def reference(pictures, brightness=None):
    """Of replications; errors are relative to their own mean where no brightness is given."""
    mean = pictures.mean(axis=0)
    brightness = mean if brightness is None else brightness
    return Reference(mean, brightness, float(relative_errors(pictures, brightness).mean()) / len(pictures))


def brightness(replications):
    """The mean of several renderers' pictures, each counting by how little noise its replications have relative to that mean."""
    means = [pictures.mean(axis=0) for pictures in replications]
    found = np.mean(means, axis=0)
    for _ in range(BRIGHTNESS_ROUNDS):
        found = np.average(means, axis=0, weights=[1 / max(reference(pictures, found).noise, 1e-12) for pictures in replications])
    return found


@dataclass
class Level:
    """One sample count, rendered once a seed."""

    spp: float
    seconds: np.ndarray
    errors: np.ndarray


def slope(levels):
    """Of the logarithm of the error against that of the time."""
    if len(levels) < 2:
        return -1.0
    times = np.log([np.median(level.seconds) for level in levels])
    errors = np.log([level.errors.mean() for level in levels])
    return float(np.clip(np.polyfit(times, errors, 1)[0], *SLOPES))


def middle_error(levels):
    """The geometric mean of the levels' errors."""
    return float(np.exp(np.mean([np.log(level.errors.mean()) for level in levels])))


def time_to(levels, error, seconds=None):
    """Seconds to reach the error, one number a seed: each level carried along the fitted slope, then their geometric mean."""
    own = slope(levels)
    seconds = [level.seconds for level in levels] if seconds is None else seconds
    logs = [np.log(time) + np.log(error / level.errors) / own for time, level in zip(seconds, levels)]
    return np.exp(np.mean(logs, axis=0))


@dataclass
class Ratio:
    """How many times as long the other takes, seed by seed."""

    median: float
    least: float
    largest: float
    error: float
    """The relative mean squared error at which the two are compared: what gpt has in the middle of its sample counts."""

    def __str__(self):
        return f"{self.median:.2f} ({self.least:.2f}–{self.largest:.2f})"


def ratio(ours, theirs):
    error = middle_error(ours)
    values = time_to(theirs, error) / time_to(ours, error)
    return Ratio(float(np.median(values)), float(values.min()), float(values.max()), error)
