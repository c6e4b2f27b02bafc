import os
from typing import Any, Iterable, NamedTuple, NoReturn, Optional, Sequence, Tuple, Union

import numpy
import numpy.typing

from . import text as text

_Array = numpy.typing.NDArray[Any]
_Picture = numpy.typing.NDArray[numpy.uint8]
_Path = Union[str, bytes, "os.PathLike[str]"]
# An n x 2 array, a list of such arrays, GeoArrow, geometries of Shapely, a GeoSeries or a GeoDataFrame.
_Lines = Any
_Color = Union[str, Sequence[float]]
_Colors = Union[_Color, Sequence[_Color], _Array]
_Widths = Union[float, Sequence[float], _Array]
_Size = Tuple[int, int]
_Fonts = Union[str, Sequence[str]]

__version__: str

class Error(Exception): ...
class ArgumentError(Error, ValueError): ...
class InputError(Error, ValueError): ...
class NotFoundError(Error, FileNotFoundError): ...
class DeviceError(Error, RuntimeError): ...
class FileError(Error, OSError): ...
class LimitError(Error, OverflowError): ...
class OutOfMemoryError(Error, MemoryError): ...

_Bbox = Tuple[float, float, float, float]

class Context:
    def __init__(self, device: Optional[str] = None, *, draw: str = "auto", memory: int = 0,
                 cache_dir: Optional[_Path] = None, root: Optional[_Path] = None, allow_remote: bool = False,
                 allow_vrt: bool = False) -> None: ...
    @property
    def device(self) -> dict[str, Any]: ...

def devices() -> list[dict[str, Any]]: ...

class Text:
    def __init__(self, x: float, y: float, text: str, *, size: float = 16, color: _Color = "#000",
                 halo: Optional[_Color] = None, halo_width: float = 1.5, angle: float = 0, font: _Fonts = ...,
                 anchor: str = ..., align: str = ..., max_width: float = ..., line_height: float = ...,
                 letter_spacing: float = ..., vertical: bool = ..., language: Optional[str] = ...) -> None: ...
    @classmethod
    def along(cls, points: Any, text: str, *, shift: float = 0, keep_direction: bool = False, max_turn: float = 45,
              size: float = ..., color: _Color = ..., halo: Optional[_Color] = ..., halo_width: float = ...,
              font: _Fonts = ..., anchor: str = ..., align: str = ..., max_width: float = ..., line_height: float = ...,
              letter_spacing: float = ..., language: Optional[str] = ...) -> Text: ...

def draw(points: _Lines, offsets: Optional[Any] = None, *, width: _Widths = 8, color: _Colors = "#336",
         size: _Size = (1024, 1024), rows: Optional[Any] = None, background: Optional[_Color] = None,
         overlap: str = "flatten", opacity: float = 1, pitch: float = 0, keep_open: bool = False,
         premultiplied: bool = False, out: Optional[_Picture] = None, texts: Union[Text, Iterable[Text]] = (),
         fonts: Sequence[_Path] = (), context: Optional[Context] = None, join: str = ..., cap: str = ..., miter_limit: float = ..., offset: float = ..., gap: float = ...,
         blur: float = ..., dash: Optional[Sequence[float]] = ...) -> _Picture: ...

class Mesh(NamedTuple):
    method: str
    strips: bool
    records: _Array
    vertices: _Array
    indices: _Array

def tessellate(points: _Lines, offsets: Optional[Any] = None, *, width: _Widths = 8, rows: Optional[Any] = None,
               method: str = "strip", fan_tolerance: float = 0, keep_open: bool = False,
               context: Optional[Context] = None, join: str = ..., cap: str = ..., miter_limit: float = ...,
               offset: float = ..., gap: float = ..., blur: float = ...,
               dash: Optional[Sequence[float]] = ...) -> Mesh: ...

class Network:
    bounds: Tuple[float, float, float, float]
    def __init__(self, points: _Lines, offsets: Optional[Any] = None, *, rows: Optional[Any] = None,
                 importance: Optional[_Array] = None, keep_open: bool = False, dashed: bool = False,
                 context: Optional[Context] = None, **unknown: NoReturn) -> None: ...
    def draw(self, *, center: Optional[Sequence[float]] = None, scale: Optional[float] = None, bearing: float = 0,
             pitch: float = 0, simplify: float = 0, width: _Widths = 8, color: _Colors = "#336",
             size: _Size = (1024, 1024), background: Optional[_Color] = None, overlap: str = "flatten",
             opacity: float = 1, premultiplied: bool = False, out: Optional[_Picture] = None, join: str = ...,
             cap: str = ..., miter_limit: float = ..., offset: float = ..., gap: float = ..., blur: float = ...,
             dash: Optional[Sequence[float]] = ...) -> _Picture: ...

def encode(picture: _Picture, format: str = "png", *, quality: Optional[int] = None, premultiplied: bool = False, dpi: float = 0,
           context: Optional[Context] = None) -> bytes: ...

def importance(points: _Lines, offsets: Optional[Any] = None, *, context: Optional[Context] = None) -> _Array: ...

def tracks(table: Any, x: str = "x", y: str = "y", by: Optional[str] = None) -> Tuple[_Array, _Array]: ...

class Plot:
    picture: _Picture
    bounds: _Bbox
    crs: Any
    def __init__(self, picture: _Picture, bounds: _Bbox, crs: Any, context: Optional[Context]) -> None: ...
    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> _Array: ...
    def _repr_png_(self) -> bytes: ...
    def save(self, path: _Path) -> None: ...

def plot(data: Any, column: Optional[Any] = None, *, cmap: Optional[Any] = None, vmin: Optional[Any] = None,
         vmax: Optional[Any] = None, color: Optional[_Colors] = None, missing: _Color = "#bbb", width: _Widths = 1,
         size: Union[int, _Size, None] = None, bbox: Optional[Sequence[float]] = None, crs: Optional[Any] = None,
         background: Optional[_Color] = "#fff", legend: bool = True, title: Optional[str] = None,
         context: Optional[Context] = None, **style: Any) -> Plot: ...

class Density:
    counts: numpy.typing.NDArray[numpy.float32]
    bounds: _Bbox
    crs: Any
    def __init__(self, counts: _Array, bounds: _Bbox, crs: Any, context: Optional[Context]) -> None: ...
    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> _Array: ...
    def shade(self, cmap: Any = "inferno", how: str = "eq_hist", *, background: Optional[_Color] = "#000",
              span: Optional[Sequence[float]] = None) -> Plot: ...
    def _repr_png_(self) -> bytes: ...

def density(data: Any, offsets: Optional[Any] = None, *, weights: Optional[Any] = None, width: float = 1,
            size: Union[int, _Size, None] = None, bbox: Optional[Sequence[float]] = None, crs: Optional[Any] = None,
            context: Optional[Context] = None, **style: Any) -> Density: ...

def styles() -> list[str]: ...

class Map:
    def __init__(self, *inputs: Any, style: Union[_Path, dict[str, Any], None] = None, theme: str = "light",
                 layer: Optional[str] = None, where: Optional[str] = None, labels: bool = True,
                 fonts: Union[_Path, Sequence[_Path]] = (), language: Optional[str] = None,
                 context: Optional[Context] = None, **unknown: NoReturn) -> None: ...
    def draw(self, *, center: Optional[Sequence[float]] = None, zoom: Optional[float] = None,
             bbox: Optional[Sequence[float]] = None, bearing: Optional[float] = None, pitch: Optional[float] = None,
             size: _Size = (1024, 1024), ratio: float = 1, simplify: float = 0.1, method: str = "strip",
             premultiplied: bool = False, out: Optional[_Picture] = None, **unknown: NoReturn) -> _Picture: ...
    def _repr_png_(self) -> bytes: ...
    def save(self, path: _Path, *, paper: Union[str, Sequence[float], None] = None, landscape: bool = False,
             margin: Optional[float] = None, dpi: Optional[float] = None, title: Optional[str] = None,
             subtitle: Optional[str] = None, scale_bar: bool = False, north_arrow: bool = False, grid: bool = False,
             fit: Optional[str] = None, size: Optional[_Size] = None, ratio: Optional[float] = None,
             quality: Optional[int] = None, simplify: float = 0.1, **view: Any) -> None: ...
    def lines(self, *, center: Optional[Sequence[float]] = None, zoom: Optional[float] = None,
              bbox: Optional[Sequence[float]] = None, bearing: Optional[float] = None, size: _Size = (1024, 1024),
              ratio: float = 1, simplify: float = 0.1) -> Tuple[_Array, _Array]: ...
    @property
    def attribution(self) -> Optional[str]: ...
    @property
    def bounds(self) -> Optional[Tuple[float, float, float, float]]: ...
    def tiles(self, output: _Path, *, min_zoom: int = 0, max_zoom: int = 14, bbox: Optional[Sequence[float]] = None,
              tile_size: int = 256, ratio: float = 1, format: str = "png", quality: Optional[int] = None,
              simplify: float = 0.1, threads: int = 0, keep_empty: bool = False, force: bool = False,
              resume: bool = False, dry_run: bool = False, name: Optional[str] = None,
              description: Optional[str] = None, attribution: Optional[str] = None) -> dict[str, Any]: ...

def render(*inputs: Any, style: Union[_Path, dict[str, Any], None] = None, theme: str = "light",
           layer: Optional[str] = None, where: Optional[str] = None, labels: bool = True, fonts: Sequence[_Path] = (),
           language: Optional[str] = None, context: Optional[Context] = None, **view: Any) -> _Picture: ...
def tiles(*inputs: Any, output: _Path, style: Union[_Path, dict[str, Any], None] = None, theme: str = "light",
          layer: Optional[str] = None, where: Optional[str] = None, context: Optional[Context] = None,
          **pyramid: Any) -> dict[str, Any]: ...
