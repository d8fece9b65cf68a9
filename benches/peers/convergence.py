"""Time to equal error, from replications of pictures at several sample counts.

The error is the relative mean squared error as `gpt compare` defines it: (a − b)² / (b² + 0.01), averaged over pixels and channels. What b
is does not have to be known without noise: of K pictures with different seeds, Σ (x − mean)² / (K − 1) is the variance of one of them
without bias. So every renderer is its own reference, whose noise is accounted for, and none needs a longer one. Bias would not show:
agreement.py looks for it.
"""

from dataclasses import dataclass

import numpy as np

RELATIVE_EPSILON = 1e-2
# Random points have slope −1 in variance against samples, good ones down to −1.5 and less in smooth scenes; noise in the fit stays within this.
SLOPES = (-2.0, -0.8)


def relative_errors(pictures, reference):
    """The relative mean squared error of each of the pictures (first axis), whose mean over the pictures is unbiased."""
    count = len(pictures)
    squares = (pictures - pictures.mean(axis=0)) ** 2 * (count / (count - 1))
    return (squares / (reference**2 + RELATIVE_EPSILON)).mean(axis=(1, 2, 3))


@dataclass
class Rung:
    """One sample count, rendered once a seed."""

    spp: float
    seconds: np.ndarray
    errors: np.ndarray


def slope(rungs):
    """Of the logarithm of the error against that of the time."""
    if len(rungs) < 2:
        return -1.0
    times = np.log([np.median(rung.seconds) for rung in rungs])
    errors = np.log([rung.errors.mean() for rung in rungs])
    return float(np.clip(np.polyfit(times, errors, 1)[0], *SLOPES))


def middle_error(rungs):
    """The geometric mean of the rungs' errors."""
    return float(np.exp(np.mean([np.log(rung.errors.mean()) for rung in rungs])))


def time_to(rungs, error, seconds=None):
    """Seconds to reach the error, one number a seed: each rung carried along the fitted slope, then their geometric mean."""
    own = slope(rungs)
    seconds = [rung.seconds for rung in rungs] if seconds is None else seconds
    logs = [np.log(time) + np.log(error / rung.errors) / own for time, rung in zip(seconds, rungs)]
    return np.exp(np.mean(logs, axis=0))


@dataclass
class Ratio:
    """How many times as long the other takes, seed by seed."""

    median: float
    least: float
    largest: float
    error: float
    """The relative mean squared error at which the two are compared: between those both were rendered at."""

    def __str__(self):
        return f"{self.median:.2f} ({self.least:.2f}–{self.largest:.2f})"


def ratio(ours, theirs):
    error = float(np.sqrt(middle_error(ours) * middle_error(theirs)))
    values = time_to(theirs, error) / time_to(ours, error)
    return Ratio(float(np.median(values)), float(values.min()), float(values.max()), error)
