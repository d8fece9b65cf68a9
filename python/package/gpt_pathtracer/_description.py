"""Scenes of Python's own values: dictionaries become the text of a scene file, arrays of numpy become files beside it."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Sequence, Tuple, Union

import numpy as np

from . import _native

#: Columns of a mesh's vertices in a PLY file, by the scene file's keys: how many numbers each has, and their names.
_COLUMNS: Dict[str, Tuple[str, ...]] = {"positions": ("x", "y", "z"), "normals": ("nx", "ny", "nz"), "uvs": ("u", "v")}
#: Keys of a mesh that are written there.
_OF_MESH = (*_COLUMNS, "faces")


@dataclass(frozen=True)
class FileContent:
    """The content of a file, in place of its path in a dictionary that is a scene."""

    #: The ending says what it is.
    name: str
    content: bytes = field(repr=False)


def text_of(description: Mapping[str, Any], folder: Path) -> str:
    """The text of a scene file. Pictures and meshes that are arrays are written into `folder`, which the text names."""
    if not isinstance(description, Mapping):
        raise TypeError(f"a scene is a dictionary, not {type(description).__name__}")
    written = _Files(folder)
    return "".join(f"{_key(key)} = {_value(written.replaced(value, key), key)}\n" for key, value in description.items())


class _Files:
    """Files that arrays are written to, by numbers."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._count = folder, 0

    def _next(self, ending: str) -> Path:
        self._count += 1
        return self._folder / f"array-{self._count}.{ending}"

    def replaced(self, value: Any, place: str) -> Any:
        """The value with names of files in place of arrays that files hold."""
        if isinstance(value, FileContent):
            path = self._next(os.path.splitext(value.name)[1].lstrip(".") or "bin")
            path.write_bytes(value.content)
            return str(path)
        if isinstance(value, Mapping):
            kept = dict(value)
            if isinstance(kept.get("file"), np.ndarray):
                by_type = "srgb" if kept["file"].dtype == np.uint8 else "linear"
                is_linear = kept.get("color_space", by_type) == "linear"
                kept["file"] = self._picture(kept["file"], is_linear, f"{place}.file")
                # The file's numbers are linear, which is what its format says.
                if kept.get("color_space") == "srgb":
                    del kept["color_space"]
            # A file of a mesh has no second texture coordinates: with them the arrays are written as they are.
            if "second_uvs" not in kept and any(isinstance(kept.get(key), np.ndarray) for key in _OF_MESH):
                if "file" in kept:
                    raise _native.SceneError(f"{place}: a mesh has either `file` or arrays")
                if "material" not in kept:
                    raise _native.SceneError(f"{place}: the key `material` is missing")
                found = {key: kept.pop(key) for key in _OF_MESH if key in kept}
                kept["file"] = self._mesh(found, place)
            return {key: self.replaced(inner, f"{place}.{key}") for key, inner in kept.items()}
        if isinstance(value, (list, tuple)):
            return [self.replaced(inner, f"{place}[{index}]") for index, inner in enumerate(value)]
        return value

    def _picture(self, pixels: np.ndarray[Any, Any], is_linear: bool, place: str) -> str:
        """Numbers are linear radiance in a file: bytes are taken for sRGB, unless the texture says that they are linear."""
        if pixels.dtype == np.uint8:
            numbers = pixels.astype(np.float32) / np.float32(255)
            if not is_linear:
                numbers = _decoded(numbers)
        elif pixels.dtype.kind == "f":
            with np.errstate(over="ignore"):
                numbers = pixels.astype(np.float32)
            if not is_linear:
                numbers = _decoded(numbers)
        else:
            raise _native.SceneError(f"{place}: a picture has numbers of type uint8 or floating point, not {pixels.dtype}")
        if numbers.ndim == 2:
            numbers = np.repeat(numbers[..., np.newaxis], 3, axis=2)
        if numbers.ndim != 3 or numbers.shape[2] != 3 or 0 in numbers.shape:
            raise _native.SceneError(f"{place}: a picture has the shape (rows, columns) or (rows, columns, 3), not {pixels.shape}")
        if not np.isfinite(numbers).all():
            raise _native.SceneError(f"{place}: the picture has numbers that are not finite")
        path = self._next("exr")
        rows, columns, _ = numbers.shape
        _native.Picture.from_bytes(columns, rows, np.ascontiguousarray(numbers).tobytes()).save(str(path), [], "", [])
        return str(path)

    def _mesh(self, found: Mapping[str, Any], place: str) -> str:
        if "positions" not in found or "faces" not in found:
            raise _native.SceneError(f"{place}: a mesh of arrays has `positions` and `faces`")
        columns: List[np.ndarray[Any, Any]] = []
        names: List[str] = []
        for key, of_key in _COLUMNS.items():
            if key not in found:
                continue
            numbers = _numbers(found[key], "iuf", f"{place}.{key}")
            if numbers.ndim != 2 or numbers.shape[1] != len(of_key):
                raise _native.SceneError(f"{place}.{key}: expected the shape (vertices, {len(of_key)}), not {numbers.shape}")
            if columns and len(numbers) != len(columns[0]):
                raise _native.SceneError(f"{place}.{key}: {len(numbers)} of them, for {len(columns[0])} positions")
            with np.errstate(over="ignore"):
                numbers = numbers.astype(np.float32)
            if not np.isfinite(numbers).all():
                raise _native.SceneError(f"{place}.{key}: there are numbers that are not finite in single precision")
            columns.append(numbers)
            names.extend(of_key)
        faces = _numbers(found["faces"], "iu", f"{place}.faces")
        count = len(columns[0])
        if faces.ndim != 2 or faces.shape[1] != 3:
            raise _native.SceneError(f"{place}.faces: expected the shape (triangles, 3), not {faces.shape}")
        if faces.size and not (0 <= int(faces.min()) and int(faces.max()) < count):
            raise _native.SceneError(f"{place}.faces: an index lies outside the {count} positions")
        corners = np.empty(len(faces), dtype=[("count", "u1"), ("corners", "<u4", 3)])
        corners["count"], corners["corners"] = 3, faces
        header = "ply\nformat binary_little_endian 1.0\n"
        header += f"element vertex {count}\n" + "".join(f"property float {name}\n" for name in names)
        header += f"element face {len(faces)}\nproperty list uchar uint vertex_indices\nend_header\n"
        path = self._next("ply")
        path.write_bytes(header.encode() + np.hstack(columns).astype("<f4").tobytes() + corners.tobytes())
        return str(path)


def dictionary_of(tables: Any, contents: Mapping[str, bytes]) -> Any:
    """The tables with arrays and contents in place of the names of files that are in memory."""
    if isinstance(tables, dict):
        content = contents.get(tables["file"]) if isinstance(tables.get("file"), str) else None
        # The materials of several-coloured faces are told apart in the file.
        if content is not None and tables["file"].endswith(".ply") and "materials" not in tables:
            return {**{key: value for key, value in tables.items() if key != "file"}, **_arrays_of_mesh(content)}
        return {key: dictionary_of(value, contents) for key, value in tables.items()}
    if isinstance(tables, list):
        return [dictionary_of(value, contents) for value in tables]
    if isinstance(tables, str) and tables in contents:
        return FileContent(tables.rpartition("/")[2], contents[tables])
    return tables


def _arrays_of_mesh(content: bytes) -> Dict[str, np.ndarray[Any, Any]]:
    """The arrays of a PLY file as scene files have them beside them: vertices of floats, then triangles."""
    header, _, rest = content.partition(b"end_header\n")
    lines = [line.split() for line in header.decode("ascii").splitlines()]
    count, faces = (next(int(line[2]) for line in lines if line[:2] == ["element", name]) for name in ("vertex", "face"))
    names = [line[2] for line in lines if line[:2] == ["property", "float"]]
    vertices = np.frombuffer(rest, "<f4", count * len(names)).reshape(count, len(names))
    corners = np.frombuffer(rest, [("count", "u1"), ("corners", "<u4", 3)], faces, vertices.nbytes)["corners"]
    columns = {**_COLUMNS, "second_uvs": ("u1", "v1")}
    arrays = {key: vertices[:, [names.index(name) for name in of_key]] for key, of_key in columns.items() if of_key[0] in names}
    return {**arrays, "faces": corners}


def _decoded(numbers: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Linear light of values in sRGB (IEC 61966-2-1)."""
    positive = np.maximum(numbers, 0)
    return np.where(numbers <= 0.04045, numbers / 12.92, ((positive + 0.055) / 1.055) ** 2.4).astype(np.float32)


def _numbers(value: Any, kinds: str, place: str) -> np.ndarray[Any, Any]:
    """An array of numbers, of one of numpy's kinds."""
    expected = "whole numbers" if kinds == "iu" else "numbers"
    try:
        numbers = np.asarray(value)
    except ValueError as error:
        raise _native.SceneError(f"{place}: expected {expected}, all rows of one length") from error
    if numbers.dtype.kind not in kinds:
        raise _native.SceneError(f"{place}: expected {expected}, not {numbers.dtype}")
    return numbers


def _key(key: object) -> str:
    if not isinstance(key, str):
        raise TypeError(f"keys of a scene are text, not {key!r}")
    return key if key.isascii() and key.replace("_", "a").replace("-", "a").isalnum() else _text(key)


def _text(text: str) -> str:
    """Text in quotes. JSON's escapes are TOML's; the delete character alone is allowed by JSON and not by TOML."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")


def _value(value: Any, place: str) -> str:
    """The value as TOML writes it in one line."""
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return repr(int(value))
    if isinstance(value, float):
        return repr(float(value))
    if isinstance(value, (str, Path)):
        return _text(str(value))
    if isinstance(value, Mapping):
        inner = (f"{_key(key)} = {_value(of_key, f'{place}.{key}')}" for key, of_key in value.items())
        return "{ " + ", ".join(inner) + " }"
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return "[" + ", ".join(_values(value, place)) + "]"
    raise TypeError(f"{place}: a scene holds numbers, text, lists and dictionaries, not {type(value).__name__}")


def _values(values: Sequence[Any], place: str) -> Iterator[str]:
    return (_value(value, f"{place}[{index}]") for index, value in enumerate(values))


SettingValue = Union[bool, int, float, str]


def setting_text(value: SettingValue) -> str:
    """A setting's value as people write it."""
    if isinstance(value, (bool, np.bool_)):
        return "on" if value else "off"
    return str(value.item() if isinstance(value, np.generic) else value)
