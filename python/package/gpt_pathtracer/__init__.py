"""A headless GPU path tracer that proves its pictures against a CPU reference.

    import gpt_pathtracer as gpt

    picture = gpt.Scene.load("cornell").render(spp=64)
    picture.pixels            # rows x columns x 3, linear radiance, float32
    picture.save("cornell.exr")

The program `gpt` comes with the package.
"""

from __future__ import annotations

import contextlib
import difflib
import inspect
import json
import os
import tempfile
import uuid
from dataclasses import dataclass
from pathlib import Path as _Folder
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _native
from ._description import FileContent, SettingValue, dictionary_of, setting_text, text_of
from ._display import Bar, Canvas
from ._native import DeviceError, Error, SceneError, __version__

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Pixels = NDArray[np.float32]
    Layer = NDArray[Any]
    Path = Union[str, os.PathLike[str]]
    Weight = Union[float, str, Sequence[Union[float, str]]]
    Progress = Union[bool, Callable[[int, int], object], None]

__all__ = [
    "Comparison",
    "DeviceError",
    "Error",
    "FileContent",
    "Measurement",
    "Picture",
    "Scene",
    "SceneError",
    "Setting",
    "Verdict",
    "__version__",
    "builtin_scenes",
    "compare",
    "measure",
    "referee",
    "regroup",
    "settings",
    "verify",
]


class Picture:
    """Linear Rec. 709 radiance: rendered, or read from a file. numpy takes it for an array."""

    def __init__(self, native: _native.Picture, layers: Mapping[str, Layer], stats: Dict[str, Any]) -> None:
        self._native = native
        self._pixels: Optional[Pixels] = None
        #: Read-only arrays by the layers' names in EXR files: Albedo, N, P, Z, A, Variance, SampleCount, Direct, Indirect, Emission, ObjectId,
        #: MaterialId, CryptoObject00 and so on. Numbers of samples, objects and materials are whole. Of a picture that was read, all layers of the file.
        self.layers = dict(layers)
        #: What the render did, with the names of `gpt render --stats`; empty of a picture that was read.
        self.stats = stats
        #: Names of the light groups that are among the layers.
        self.light_groups: Tuple[str, ...] = ()
        self._channels: List[Tuple[str, str]] = []
        self._layer_list = ""
        self._notes: List[Tuple[str, str]] = []

    @staticmethod
    def _of(made: _native.Rendered) -> Picture:
        picture = Picture(made.picture, {name: np.asarray(layer) for name, layer in made.layers.items()}, json.loads(made.stats))
        picture.light_groups = tuple(made.groups)
        picture._channels, picture._layer_list, picture._notes = made.channels, made.layer_list, made.notes
        return picture

    @staticmethod
    def open(path: Path) -> Picture:
        """Reads an OpenEXR file, in its display window and with all of its layers, or a PNG, JPEG, HDR and others, whose integers are taken for sRGB where
        they say nothing else. Layers are what they were when the picture was saved, and are saved with it again; those of other programs have the names
        before the last point of their channels."""
        return Picture._of(_native.open_with_layers(os.fspath(path)))

    @property
    def warnings(self) -> List[str]:
        """What the file of a picture that was read says of its pixels that is not used, such as their shape."""
        return self._native.warnings

    @property
    def pixels(self) -> Pixels:
        """Rows, columns, and red, green and blue: a read-only view of the picture's own memory. `.copy()` makes one that can be changed."""
        if self._pixels is None:
            self._pixels = np.asarray(self._native)
        return self._pixels

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> Pixels:
        pixels = self.pixels
        if dtype is not None and np.dtype(dtype) != pixels.dtype:
            if copy is False:
                raise ValueError("numbers of another type are a copy")
            return pixels.astype(dtype)
        return pixels.copy() if copy else pixels

    def save(self, path: Path) -> None:
        """Writes the picture: .exr and .hdr hold the radiance, .png and .jpg are previews. An .exr has its layers too, as `gpt render --aov` writes them."""
        is_exr = os.fspath(path).lower().endswith(".exr")
        channels = [(name, numbers.tobytes(), is_whole) for name, numbers, is_whole in self._numbers()] if is_exr else []
        self._native.save(os.fspath(path), channels, self._layer_list, self._notes)

    def _numbers(self) -> Iterator[Tuple[str, Pixels, bool]]:
        """Names of the layers' channels in EXR files, their numbers, and whether these are whole."""
        places: Dict[str, int] = {}
        for channel, layer in self._channels:
            array, place = self.layers[layer], places.get(layer, 0)
            places[layer] = place + 1
            numbers = array if array.ndim == 2 else array[..., place]
            yield channel, np.ascontiguousarray(numbers, dtype=np.float32), array.dtype == np.uint32

    def to_xarray(self) -> Any:
        """The picture and its layers as an `xarray.Dataset`: `radiance` and the layers by their names, along `y` (rows from the top), `x` and, where they
        have several numbers, `channel` (R, G, B), `axis` (X, Y, Z) or channels of their own. Coordinates are the middles of pixels; attributes say what the render did. Needs xarray."""
        try:
            import xarray  # type: ignore[import-not-found,import-untyped,unused-ignore]
        except ImportError as error:
            raise ImportError("to_xarray needs the package xarray: pip install xarray") from error
        rows, columns, _ = self.pixels.shape
        arrays: Dict[str, Any] = {"radiance": (("y", "x", "channel"), self.pixels)}
        for name, layer in self.layers.items():
            colours = "axis" if name in ("N", "P") else "channel"
            several = colours if layer.shape[2:] == (3,) else f"{name}_channel"
            arrays[name] = (("y", "x", several)[: layer.ndim], layer)
        coordinates = {"y": np.arange(rows) + 0.5, "x": np.arange(columns) + 0.5, "channel": ["R", "G", "B"], "axis": ["X", "Y", "Z"]}
        # Attributes are what netCDF can hold.
        told = {key: value for key, value in self.stats.items() if isinstance(value, (str, int, float)) and not isinstance(value, bool)}
        return xarray.Dataset(arrays, coords=coordinates, attrs=told)

    def _repr_png_(self) -> bytes:
        """The preview that notebooks show."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "picture.png")
            self.save(path)
            with open(path, "rb") as file:
                return file.read()

    def __repr__(self) -> str:
        rows, columns, _ = self.pixels.shape
        return f"<gpt_pathtracer.Picture of {columns}x{rows} pixels>"


class Scene:
    """A scene that was read. It does not change."""

    def __init__(self, native: _native.Scene) -> None:
        self._native = native

    @staticmethod
    def load(
        path: Path,
        *,
        strict: bool = False,
        definitions: Optional[Mapping[str, str]] = None,
        camera: Optional[str] = None,
        variant: Optional[str] = None,
        assets_root: Optional[Path] = None,
        environment: Optional[Path] = None,
        projection: Optional[str] = None,
    ) -> Scene:
        """Reads a scene file (.toml), a model (.obj, .ply), a scene of another program (.gltf, .glb, .xml, .pbrt), or a built-in scene by its name.

        `strict` refuses substitutes for missing textures and materials, and imports that are not exact. `definitions` are values of a Mitsuba
        file's parameters. `camera` and `variant` name those of an imported file that has several. Files that the scene names have to lie in
        `assets_root`, where one is given. `environment` is a map that lights the scene in place of what does otherwise.
        `projection` sees the scene so from where its camera stands: perspective, orthographic, equirectangular, cylindrical, fisheye, cube_map,
        stereo, stereo_panorama.
        """
        values = [(key, str(value)) for key, value in (definitions or {}).items()]
        root, surroundings = (None if each is None else os.fspath(each) for each in (assets_root, environment))
        return Scene(_native.Scene.load(os.fspath(path), strict, values, camera, variant, root, surroundings, projection))

    @staticmethod
    def from_dict(description: Mapping[str, Any]) -> Scene:
        """A scene of dictionaries and lists with the keys of a scene file.

        Numbers and lists may be numpy's. A texture's `file` may be an array (rows, columns) or (rows, columns, 3) of linear radiance, or of bytes in
        sRGB; a mesh's `positions`, `faces`, `normals` and `uvs` may be arrays. Other paths are relative to the working directory.
        """
        with tempfile.TemporaryDirectory() as folder:
            return Scene(_native.Scene.from_toml(text_of(description, _Folder(folder)), os.getcwd()))

    def at_frame(self, frame: float) -> Scene:
        """The scene as its keyframes have it at a frame, which may lie between two."""
        return Scene(self._native.at_frame(frame))

    @staticmethod
    def from_toml(text: str, *, folder: Path = "") -> Scene:
        """Reads the text of a scene file. Paths in it are relative to `folder`."""
        return Scene(_native.Scene.from_toml(text, os.fspath(folder)))

    def to_toml(self, *, folder: Path = "") -> str:
        """The text of a scene file that renders the same picture, bit for bit; `from_toml` reads it. Files are named by their paths from `folder`.

        Meshes and pictures that came from no file have no place in a text: `save` writes them beside the file, and `to_dict` holds them.
        """
        text, files = self._native.written(os.path.join(os.fspath(folder), "scene.toml"))
        if files:
            what = f"{len(files)} of the scene's meshes, pictures and lists came from no file and have no place in a text"
            raise SceneError(f"{what}; save(path) writes them beside the scene file, and to_dict() holds them")
        return text

    def to_dict(self) -> Dict[str, Any]:
        """The scene as dictionaries and lists with the keys of a scene file; `from_dict` of it renders the same picture, bit for bit.

        Meshes that came from no file are arrays; other content that did is a `FileContent`. Paths are relative to the working directory.
        """
        stem = f"memory-{uuid.uuid4().hex}"
        text, files = self._native.written(f"{stem}.toml")
        contents = {f"{stem}.files/{os.path.basename(path)}": content for path, content in files}
        description: Dict[str, Any] = dictionary_of(_native.tables(text), contents)
        return description

    def save(self, path: Path) -> List[_Folder]:
        """Writes a scene file (.toml), and meshes and pictures that came from no file into the folder `NAME.files` beside it, as `gpt render --save-scene` does.
        All that was written, the scene file last. Files that the scene was read from are never replaced."""
        if not os.fspath(path).lower().endswith(".toml"):
            raise ValueError(f"{os.fspath(path)}: a scene file's name ends in .toml")
        return [_Folder(written) for written in self._native.save(os.fspath(path))]

    @property
    def name(self) -> str:
        """The file's name without its ending, or the built-in scene's."""
        return self._native.name

    @property
    def size(self) -> Tuple[int, int]:
        """Columns and rows of the picture."""
        return self._native.size

    @property
    def spp(self) -> int:
        """Samples per pixel."""
        return self._native.spp

    @property
    def warnings(self) -> List[str]:
        """What could not be taken as written, in sentences."""
        return self._native.warnings

    def render(
        self,
        spp: Optional[int] = None,
        *,
        size: Optional[Tuple[int, int]] = None,
        seed: Optional[int] = None,
        device: str = "auto",
        layers: Iterable[str] = (),
        time_limit: Optional[float] = None,
        target_error: Optional[float] = None,
        adaptive: bool = False,
        target_interval: Optional[float] = None,
        confidence: Optional[float] = None,
        interval_of: Optional[str] = None,
        interval_by: Optional[str] = None,
        first_sample: int = 0,
        crop: Optional[Tuple[int, int, int, int]] = None,
        progress: Progress = None,
        live: bool = False,
        **settings: SettingValue,
    ) -> Picture:
        """Renders the scene. Other threads of Python run meanwhile, and Ctrl-C ends it.

        `spp`, `size` and `seed` stand for what the scene says. `device`: auto, gpu, cpu, or a part of an adapter's name. `layers`: albedo, normal,
        position, uv, object_position, motion, depth, alpha, variance, samples, low, high, direct, indirect, emission, ids, cryptomatte, groups.
        `time_limit` in seconds. `target_error`: the relative mean squared error to reach, with `spp` as the most it may take. `adaptive`: more samples where the noise is. `target_interval`:
        the share to which the truth is to be known, at this `confidence` (0.99), of the picture's mean, of its tiles or its pixels (`interval_of`);
        upper ends stand on a bound of samples or on what was seen (`interval_by`). `first_sample` and `crop` (first column and row, width and height)
        render a part of the samples or the pixels; the picture then has the region's size. `progress` is called with the samples that are done and
        those that are wanted, of each layer and then of the picture, up to ten times a second and at the end; what it raises ends the render. True
        shows a bar. `live` shows the picture while it is rendered, where a notebook runs, and a bar elsewhere. All other keywords are settings by the names of a scene's `[render]`, such as `max_depth=12, guiding="on"`: `settings()` lists
        them.
        """
        keywords: Dict[str, Any] = {
            **settings,
            "size": size,
            "seed": seed,
            "device": device,
            "layers": layers,
            "time_limit": time_limit,
            "target_error": target_error,
            "adaptive": adaptive,
            "target_interval": target_interval,
            "confidence": confidence,
            "interval_of": interval_of,
            "interval_by": interval_by,
            "first_sample": first_sample,
            "crop": crop,
        }
        task = self._task("render", spp, keywords)
        canvas = Canvas.of_notebook() if live else None
        with _watching(progress or (live and canvas is None)) as watcher:
            if canvas is None:
                return Picture._of(task.render(watcher))
            *_, picture = map(canvas.show, _taken(task.progressively(_LIVE_SECONDS, watcher)))
            return picture

    def render_frames(
        self, frames: Union[str, Iterable[float]], spp: Optional[int] = None, *, progress: Progress = None, **keywords: Any
    ) -> Iterator[Picture]:
        """Pictures of frames of the scene's keyframes, one after the other, as `gpt render --frames` renders them: on a device that stays open, with
        what does not change made ready once.

        `frames`: numbers, or a text as "1-100", "1-100x5" (every fifth) or "1,5,20-30". `stats["frame"]` of a picture is its frame. The next frame is
        rendered while a picture is used; leaving the loop ends that. `progress` tells of each frame anew. Keywords are those of `render`.
        """
        numbers = _native.frame_list(frames) if isinstance(frames, str) else [float(frame) for frame in frames]
        task = self._task("render_frames", spp, keywords)
        task.check_frames(numbers)
        _check_progress(progress)

        def pictures() -> Iterator[Picture]:
            with _watching(progress) as watcher:
                yield from _taken(task.frames(numbers, watcher))

        return pictures()

    def render_progressively(
        self, spp: Optional[int] = None, *, seconds: float = 0.5, progress: Progress = None, **keywords: Any
    ) -> Iterator[Picture]:
        """Pictures of one render that get better, each `seconds` after the one before at least. The last is what `render` gives, bit for bit.

        Those before it have no layers, and a few `stats`, among them `spp_done` of the pixel that has fewest samples; `stopped_by` is None. The render
        goes on while a picture is used; leaving the loop ends it. Keywords are those of `render`.
        """
        task = self._task("render_progressively", spp, keywords)
        task.check_seconds(seconds)
        _check_progress(progress)

        def pictures() -> Iterator[Picture]:
            with _watching(progress) as watcher:
                yield from _taken(task.progressively(seconds, watcher))

        return pictures()

    def _task(self, function: str, spp: Optional[int], keywords: Mapping[str, Any]) -> _native.Task:
        """The render that a function was asked for with these keywords, of which the names are checked."""
        of_renders, own = (list(inspect.signature(asked).parameters) for asked in (Scene._with, getattr(Scene, function)))
        known = {*of_renders, *_setting_names()} - {"self", "spp", "settings"}
        for name in keywords:
            if name not in known:
                near = difflib.get_close_matches(name, {*known, *own} - {"self", "keywords", "settings"}, 1)
                help = f"did you mean {near[0]!r}?" if near else "help(Scene.render) and settings() name what there is"
                raise TypeError(f"{function}() has no keyword {name!r}; {help}")
        return self._with(spp, **keywords)

    def _with(
        self,
        spp: Optional[int],
        *,
        size: Optional[Tuple[int, int]] = None,
        seed: Optional[int] = None,
        device: str = "auto",
        layers: Iterable[str] = (),
        time_limit: Optional[float] = None,
        target_error: Optional[float] = None,
        adaptive: bool = False,
        target_interval: Optional[float] = None,
        confidence: Optional[float] = None,
        interval_of: Optional[str] = None,
        interval_by: Optional[str] = None,
        first_sample: int = 0,
        crop: Optional[Tuple[int, int, int, int]] = None,
        **settings: SettingValue,
    ) -> _native.Task:
        """A render with these keywords and settings, whose values are checked."""
        names = [layers] if isinstance(layers, str) else list(layers)
        intervals = (target_interval, confidence, interval_of, interval_by)
        named: Dict[str, Optional[SettingValue]] = {"spp": spp, "seed": seed, **settings}
        assigned = [(name, setting_text(value)) for name, value in named.items() if value is not None]
        part = (first_sample, crop)
        return self._native.task(size, device, names, time_limit, target_error, adaptive, intervals, part, assigned)

    def __repr__(self) -> str:
        columns, rows = self.size
        return f"<gpt_pathtracer.Scene {self.name}, {columns}x{rows}, {self.spp} spp>"


#: Seconds between two pictures that a notebook shows.
_LIVE_SECONDS = 0.5


def _check_progress(progress: Progress) -> None:
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        raise TypeError("progress: a function of two numbers, or True for a bar")


@contextlib.contextmanager
def _watching(progress: Progress) -> Iterator[Optional[Callable[[int, int], object]]]:
    """The function that is told how far a render is; a bar is closed in the end."""
    _check_progress(progress)
    if progress is not True:
        yield progress or None
        return
    bar = Bar()
    try:
        yield bar
    finally:
        bar.close()


def _taken(pictures: _native.Pictures) -> Iterator[Picture]:
    """Pictures in the making; who leaves early ends the render."""
    try:
        while True:
            taken = pictures.next()
            if taken is None:
                return
            yield Picture._of(taken[0])
    finally:
        pictures.close()


@dataclass(frozen=True)
class Setting:
    """A setting of how light is estimated."""

    name: str
    help: str
    #: Its value where nobody says one, and which it may have, in words.
    default: str
    values: str


def settings() -> List[Setting]:
    """Settings that `Scene.render` takes by name, from the table that scene files and the command line have too."""
    return [Setting(*row) for row in _native.settings()]


def _setting_names() -> List[str]:
    return [name for name, *_ in _native.settings()]


@dataclass(frozen=True)
class Comparison:
    """How far a picture is from its reference, over all channels; `details` has all that `gpt compare --json` says. Pixels that are no finite numbers
    are left out; where none is left, errors are NaN."""

    mse: float
    #: Relative mean squared error: (a - b)^2 / (b^2 + 0.01).
    relmse: float
    mae: float
    #: Peak signal-to-noise ratio in decibels; infinite of equal pictures.
    psnr: float
    #: Largest difference of a value.
    largest: float
    details: Dict[str, Any]


@dataclass(frozen=True)
class Verdict:
    """Whether a device and the CPU reference agree on a scene, path by path."""

    agrees: bool
    #: Which limits were missed, in sentences.
    missed: List[str]
    details: Dict[str, Any]

    def __bool__(self) -> bool:
        return self.agrees


def _picture(of: Any) -> _native.Picture:
    if isinstance(of, Picture):
        return of._native
    if isinstance(of, (str, os.PathLike)):
        return _native.Picture.open(os.fspath(of))
    pixels = np.ascontiguousarray(of, dtype=np.float32)
    if pixels.ndim != 3 or pixels.shape[2] != 3:
        raise ValueError(f"a picture has rows, columns and three channels, not the shape {pixels.shape}")
    return _native.Picture.from_bytes(pixels.shape[1], pixels.shape[0], pixels.tobytes())


def compare(picture: Union[Picture, Pixels, Path], reference: Union[Picture, Pixels, Path]) -> Comparison:
    """Measures how far a picture is from its reference; each is a picture, an array or a file."""
    details = json.loads(_native.compare(_picture(picture), _picture(reference)))
    # JSON has neither of these numbers: no two pixels are compared, or they are all equal.
    no_number, infinite = float("nan"), float("inf")
    mse, relmse, mae = (no_number if details[name]["all"] is None else details[name]["all"] for name in ("mse", "relmse", "mae"))
    psnr = infinite if mse == 0.0 else details["psnr"]["all"]
    return Comparison(mse, relmse, mae, no_number if psnr is None else psnr, details["largest"]["difference"], details)


def regroup(picture: Union[Picture, Path], weights: Mapping[str, Weight]) -> Picture:
    """A finished picture with the light of its groups weighed anew, as `gpt regroup` does: a picture that was rendered with `layers=["groups"]`, or an
    EXR file of `gpt render --aov groups`.

    A weight is a factor (2, 0.5, 0 for none), an sRGB colour ("#ffddaa"), which multiplies by its components in linear light, or both ((2, "#ffddaa")).
    Groups without a weight stay as they are. Layers that say nothing of light stay too; those of the light as it was are left out, and
    `stats["left_out"]` names them.
    """

    def text(weight: Weight) -> str:
        parts = [weight] if isinstance(weight, (str, float, int)) else weight
        return ",".join(part if isinstance(part, str) else repr(float(part)) for part in parts)

    texts = [f"{group}={text(weight)}" for group, weight in weights.items()]
    if not isinstance(picture, Picture):
        return Picture._of(_native.regroup_file(os.fspath(picture), texts))
    rows, columns, _ = picture.pixels.shape
    channels = [(name, numbers.tobytes()) for name, numbers, _ in picture._numbers()]
    return Picture._of(_native.regroup_channels((columns, rows), channels, picture._layer_list, picture._notes, texts))


def verify(
    scene: Union[Scene, Path], *, size: Optional[Tuple[int, int]] = None, spp: Optional[int] = None, device: str = "gpu"
) -> Verdict:
    """Renders the scene on a device and by the CPU reference with the same random numbers, and compares them path by path."""
    loaded = scene if isinstance(scene, Scene) else Scene.load(scene)
    details = json.loads(_native.verify(loaded._native, size, spp, device))
    return Verdict(details["agrees"], details["missed"], details)


@dataclass(frozen=True)
class Measurement:
    """The reading of a meter; `details` has all that `gpt measure --json` says."""

    name: str
    #: Of `value`, `low` and `high`, which are red, green and blue.
    unit: str
    value: Tuple[float, float, float]
    #: Ends of intervals that hold the truth with the confidence that was asked for.
    low: Tuple[float, float, float]
    high: Tuple[float, float, float]
    #: In lux, or in candela per square metre: the reading, and its interval.
    photometric: Tuple[float, float, float]
    photometric_unit: str
    details: Dict[str, Any]


def measure(
    scene: Union[Scene, Path],
    meters: Iterable[str] = (),
    *,
    target_interval: float = 0.01,
    confidence: Optional[float] = None,
    interval_by: Optional[str] = None,
    spp: Optional[int] = None,
    seed: Optional[int] = None,
    device: str = "auto",
) -> List[Measurement]:
    """Reads a scene's meters, or those of these names, until half the width of each interval is at most `target_interval` of its value, by `spp` samples of
    each of a meter's pixels at most (65536)."""
    loaded = scene if isinstance(scene, Scene) else Scene.load(scene)
    names = [meters] if isinstance(meters, str) else list(meters)
    read = json.loads(_native.measure(loaded._native, names, target_interval, confidence, interval_by, spp, seed, device))

    def measurement(details: Dict[str, Any]) -> Measurement:
        red, green, blue = details["channels"]
        value, low, high = ((red[which], green[which], blue[which]) for which in ("value", "low", "high"))
        lit = details["photometric"]
        photometric = (lit["value"], lit["low"], lit["high"])
        return Measurement(details["name"], details["unit"], value, low, high, photometric, details["photometric_unit"], details)

    return [measurement(details) for details in read]


def builtin_scenes() -> List[str]:
    """Names of the scenes that are part of the package."""
    return _native.builtin_scenes()


# The module needs scenes and pictures.
from . import referee  # noqa: E402
