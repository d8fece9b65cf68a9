"""The referee: small scenes whose pictures are known, and a judge of any renderer's pictures.

    from gpt_pathtracer import referee

    def mine(test, spp, seed):
        return test.scene().render(spp, seed=seed)      # or any renderer's array

    for outcome in referee.run(mine, "lights"):
        print(outcome)

It is what `gpt referee` does.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, Sequence, Tuple, Union

import numpy as np

from . import Picture, Scene, _native, _picture

if TYPE_CHECKING:
    from typing import Optional

    from . import Path, Pixels

    AnyPicture = Union[Picture, Pixels, Path]
    #: Pictures of one test: by their seeds, each with random numbers of its own; or one after the other, of which nothing is known.
    Given = Union[Mapping[int, AnyPicture], Sequence[AnyPicture]]

__all__ = ["VERSION", "NotSupported", "Outcome", "Test", "Truth", "judge", "run", "tests"]

#: The version of the suite: it grows where a test is added or its truth changes.
VERSION: str = _native.referee_version()


class NotSupported(Exception):
    """A renderer cannot be asked for a test; the message says why. For functions that `run` is given."""


@dataclass(frozen=True)
class Truth:
    """The true picture of a test: rows, columns and channels of linear radiance."""

    mean: Pixels
    #: Standard errors of the means; 0 where a formula tells them.
    standard_error: Pixels


@dataclass(frozen=True)
class Outcome:
    """The verdict on a renderer's pictures of one test. It is true where nothing is wrong."""

    test: str
    #: agrees, differs, failed (its pictures cannot be judged) or not supported.
    verdict: str
    #: The nearest of the mistakes whose picture is the renderer's.
    cause: Optional[str]
    #: All of them.
    looks_like: Tuple[str, ...]
    #: The picture is off by at least this share somewhere.
    off_by_at_least: Optional[float]
    #: The smallest change of the picture's mean that would have been found with a probability of 90 %, as a share; None of a black picture.
    would_find: Optional[float]
    #: The fault in words; empty where there is none.
    sentence: str
    #: With the keys of `gpt referee run --json`.
    details: Dict[str, Any]

    def __bool__(self) -> bool:
        return self.verdict in ("agrees", "not supported")

    def __str__(self) -> str:
        return f"{self.test}: {self.verdict}" + (f": {self.sentence}" if self.sentence else "")


class Test:
    """A scene that asks one thing of a renderer."""

    #: For pytest: no test of its own.
    __test__ = False

    def __init__(self, native: _native.RefereeTest) -> None:
        self._native = native
        #: Family and name, as in `lights/point`.
        self.name: str = native.name
        #: A sentence on what is tested.
        self.about: str = native.about
        #: The clause of a specification, or the law, that decides who is right.
        self.decides: str = native.decides
        #: Mistakes that renderers make here, of which the pictures are known.
        self.mistakes: Tuple[str, ...] = tuple(native.mistakes)
        #: Columns and rows of the picture.
        self.size: Tuple[int, int] = native.size
        #: The truth is a formula; else long renders told it.
        self.is_formula: bool = native.is_formula
        #: The scene file, whose paths are names in `files`.
        self.toml: str = native.text

    @property
    def family(self) -> str:
        """The part of the name before the stroke."""
        return self.name.partition("/")[0]

    @property
    def files(self) -> Dict[str, bytes]:
        """Contents of the files that the scene file names."""
        return dict(self._native.files())

    def scene(self) -> Scene:
        """The scene, read."""
        return Scene(self._native.scene())

    def truth(self) -> Truth:
        """The true picture."""
        mean, error = self._native.truth()
        return Truth(np.asarray(mean), np.asarray(error))

    def judge(self, pictures: Given, *, false_alarms: float = 0.01) -> Outcome:
        """The verdict on pictures of this test alone; `false_alarms` is the probability that right ones are said to differ."""
        return _judged(self, pictures, _known_seeds([pictures]), false_alarms)

    def __repr__(self) -> str:
        return f"<gpt_pathtracer.referee.Test {self.name}>"


def tests(*names: str) -> List[Test]:
    """The tests of these names and families; all where none is named."""
    every = [Test(native) for native in _native.referee_tests()]
    for name in names:
        if not any(name in (test.name, test.family) for test in every):
            raise ValueError(f"there is no test and no family {name!r}")
    return [test for test in every if not names or test.name in names or test.family in names]


def judge(pictures: Mapping[str, Given], *, false_alarms: float = 0.01) -> List[Outcome]:
    """The verdicts on pictures by the names of their tests.

    Pictures of a test are arrays, pictures or files: by seeds, as in `{1: first, 2: second}`, or one after the other. Two tell faults of single pixels
    from noise. `false_alarms`: the probability that a right renderer is said to differ in any of the tests.
    """
    by_name = {test.name: test for test in tests()}
    for name in pictures:
        if name not in by_name:
            raise ValueError(f"there is no test {name!r}")
    level = _native.level_of_each(false_alarms, len(pictures))
    # If seeds count in any test, pictures that are equal have no noise.
    known = _known_seeds(list(pictures.values()))
    return [_judged(by_name[name], given, known, level) for name, given in pictures.items()]


def run(
    render: Callable[[Test, int, int], AnyPicture],
    *names: str,
    spp: int = 256,
    runs: int = 2,
    false_alarms: float = 0.01,
) -> List[Outcome]:
    """Asks a renderer for `runs` pictures of each of these tests and families, of all where none is named, and judges them.

    `render` is given the test, samples per pixel and a seed. Where it raises `NotSupported`, the test is not judged.
    """
    chosen = tests(*names)
    made: Dict[str, Given] = {}
    reasons: Dict[str, str] = {}
    for test in chosen:
        try:
            made[test.name] = [render(test, spp, seed) for seed in range(1, runs + 1)]
        except NotSupported as reason:
            reasons[test.name] = str(reason)
    # Tests that were not answered count too: the rest are judged a little more strictly than they had to be.
    level = _native.level_of_each(false_alarms, len(chosen))
    known = _known_seeds(list(made.values()))

    def outcome(test: Test) -> Outcome:
        if test.name in made:
            return _judged(test, made[test.name], known, level)
        reason = reasons[test.name]
        return Outcome(test.name, "not supported", None, (), None, None, reason, {"name": test.name, "reason": reason})

    return [outcome(test) for test in chosen]


def _known_seeds(given: Sequence[Given]) -> bool:
    """Each picture is known to have random numbers of its own: seeds are said, or two pictures of one test differ."""

    def differ(pictures: Sequence[AnyPicture]) -> bool:
        arrays = [np.asarray(_picture(picture)) for picture in pictures]
        return any(not np.array_equal(array, arrays[0]) for array in arrays)

    return any(True if isinstance(pictures, Mapping) else differ(pictures) for pictures in given)


def _judged(test: Test, given: Given, known_seeds: bool, level: float) -> Outcome:
    pictures = [_picture(picture) for picture in (given.values() if isinstance(given, Mapping) else given)]
    details = json.loads(test._native.judge(pictures, known_seeds, level))
    difference, looks_like = details["difference"], tuple(details["looks_like"])
    parts = [difference["sentence"]] if difference else []
    parts += [f"looks like {cause}" for cause in looks_like[:1]]
    parts += [details["reason"]] if details["reason"] else []
    cause = looks_like[0] if looks_like else None
    return Outcome(
        test.name, details["verdict"], cause, looks_like, details["at_least"], details["finds"], "; ".join(parts), details
    )
