from typing import Any, Callable, Dict, List, Optional, Tuple, final

__version__: str
__all__ = ["Array", "DeviceError", "Error", "Picture", "Rendered", "Scene", "SceneError", "__version__", "builtin_scenes", "compare", "measure", "settings", "verify"]

class Error(Exception): ...
class SceneError(Error): ...
class DeviceError(Error): ...

@final
class Array:
    @property
    def __array_interface__(self) -> Dict[str, Any]: ...

@final
class Picture:
    @staticmethod
    def open(path: str) -> Picture: ...
    @staticmethod
    def from_bytes(width: int, height: int, bytes: bytes) -> Picture: ...
    @property
    def __array_interface__(self) -> Dict[str, Any]: ...
    @property
    def warnings(self) -> List[str]: ...
    def save(self, path: str) -> None: ...

@final
class Rendered:
    @property
    def picture(self) -> Picture: ...
    @property
    def layers(self) -> Dict[str, Array]: ...
    @property
    def stats(self) -> str: ...

@final
class Scene:
    @staticmethod
    def load(
        path: str,
        strict: bool,
        definitions: List[Tuple[str, str]],
        camera: Optional[str],
        variant: Optional[str],
        assets_root: Optional[str],
        environment: Optional[str],
        projection: Optional[str],
    ) -> Scene: ...
    @staticmethod
    def from_toml(text: str, folder: str) -> Scene: ...
    @property
    def name(self) -> str: ...
    @property
    def size(self) -> Tuple[int, int]: ...
    @property
    def spp(self) -> int: ...
    @property
    def warnings(self) -> List[str]: ...
    def at_frame(self, frame: float) -> Scene: ...
    def render(
        self,
        size: Optional[Tuple[int, int]],
        device: str,
        layers: List[str],
        time_limit: Optional[float],
        target_error: Optional[float],
        adaptive: bool,
        intervals: Tuple[Optional[float], Optional[float], Optional[str], Optional[str]],
        part: Tuple[int, Optional[Tuple[int, int, int, int]]],
        settings: List[Tuple[str, str]],
        progress: Optional[Callable[[int, int], object]],
    ) -> Rendered: ...

def compare(picture: Picture, reference: Picture) -> str: ...
def measure(
    scene: Scene,
    meters: List[str],
    target: float,
    confidence: Optional[float],
    interval_by: Optional[str],
    spp: Optional[int],
    seed: Optional[int],
    device: str,
) -> str: ...
def verify(scene: Scene, size: Optional[Tuple[int, int]], spp: Optional[int], device: str) -> str: ...
def settings() -> List[Tuple[str, str, str, str]]: ...
def builtin_scenes() -> List[str]: ...
