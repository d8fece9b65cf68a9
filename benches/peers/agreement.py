"""Whether two renderers' pictures of one scene agree, from replications: pictures with different seeds, stacked on the first axis."""

from dataclasses import dataclass

import numpy as np
from scipy import stats

TILE = 32


def tile_means(pictures):
    """Replications × tiles × channels; tiles at the right and lower edge may be smaller."""
    _, height, width, _ = pictures.shape
    rows, columns = range(0, height, TILE), range(0, width, TILE)
    return np.stack(
        [pictures[:, y : y + TILE, x : x + TILE].mean(axis=(1, 2)) for y in rows for x in columns], axis=1
    )


def p_values(first, second, alpha, offset=1e-4):
    """Welch's t on the replications (first axis): the p-value of each mean, and the level below which Šidák's correction rejects it.

    Differences up to a share `offset` of the mean are rounding and not judged."""
    a, b = first.mean(axis=0), second.mean(axis=0)
    spreads = [pictures.var(axis=0, ddof=1) / len(pictures) for pictures in (first, second)]
    variance = spreads[0] + spreads[1]
    excess = np.maximum(np.abs(a - b) - offset * np.maximum(np.abs(a), np.abs(b)), 0)
    with np.errstate(divide="ignore", invalid="ignore"):  # no scatter at all, as in the sky: judged by the excess alone
        degrees = variance**2 / sum(spread**2 / (len(p) - 1) for spread, p in zip(spreads, (first, second)))
        p = np.where(variance > 0, 2 * stats.t.sf(excess / np.sqrt(variance), degrees), np.where(excess > 0, 0.0, 1.0))
    p = np.where(np.isfinite(excess), p, 0.0)  # what is not a number never passes
    return p, -np.expm1(np.log1p(-alpha) / p.size)


@dataclass
class Judgement:
    verdict: str
    """`agree`, `differ`, or `no verdict` where 1 % of energy added would not have been found either."""
    difference: list
    """Of the channels' means, relative to the second's."""
    channels: int
    """How many are rejected."""
    tiles: int
    """How many tiles × channels are rejected."""
    least_p: float
    """The smallest p-value of all tiles × channels."""
    level: float
    """What it is rejected below."""
    planted_p: float
    """The smallest p-value of the channels' means once the first has 1 % of energy more."""

    @property
    def largest_z(self):
        """How many standard deviations of a normal distribution are as rare as the smallest p-value."""
        return float(stats.norm.isf(0.5 * self.least_p))


def judge(first, second, alpha=0.01, offset=1e-4):
    """Whether the replications of two renderers agree. `offset`: what share of a mean may differ and is not judged."""
    means = [pictures.mean(axis=(1, 2)) for pictures in (first, second)]
    tiles = [tile_means(pictures) for pictures in (first, second)]
    of_means, of_tiles = (p_values(*values, alpha, offset) for values in (means, tiles))
    rejected = [int((p < level).sum()) for p, level in (of_means, of_tiles)]
    control, level = p_values(1.01 * means[0], means[1], alpha, offset)
    found = "differ" if any(rejected) else "agree" if (control < level).any() else "no verdict"
    difference = (means[0].mean(axis=0) / means[1].mean(axis=0) - 1).tolist()
    return Judgement(found, difference, *rejected, float(of_tiles[0].min()), float(of_tiles[1]), float(control.min()))


def disagreements(ours, theirs, alpha):
    """Counts of rejected channels and of rejected tiles × channels, after printing what was found."""
    whole, level = p_values(ours.mean(axis=(1, 2)), theirs.mean(axis=(1, 2)), alpha)
    tiles, tile_level = p_values(tile_means(ours), tile_means(theirs), alpha)
    print(f"  whole picture: p = {', '.join(f'{p:.3g}' for p in whole)}; rejected below {level:.2g}")
    print(f"  {tiles.size} tiles × channels: least p = {tiles.min():.2g}; rejected below {tile_level:.2g}: {(tiles < tile_level).sum()}")
    return (whole < level).sum(), (tiles < tile_level).sum()


def print_means(name, pictures):
    means = pictures.mean(axis=(1, 2))
    values, errors = means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(len(means))
    print(f"{name:8} mean " + "  ".join(f"{value:.6f} ± {error:.6f}" for value, error in zip(values, errors)))


def verdict(peer, ours, theirs, alpha):
    """Prints whether the replications of both agree: 0 if they do, 7 if not, 1 if the test could not have told."""
    print(f"gpt against {peer}:")
    whole, tiles = disagreements(ours, theirs, alpha)
    print(f"negative control, gpt with 1 % of energy added against {peer}:")
    control, _ = disagreements(1.01 * ours, theirs, alpha)
    if control == 0:
        print("NO VERDICT: the test does not find 1 % of energy; render more samples")
        return 1
    print("AGREE: the differences are within the noise of both" if whole == tiles == 0 else "DIFFER")
    return 0 if whole == tiles == 0 else 7
