from typing import Any, Iterable, Optional, Sequence, Tuple, Union

from . import Context, Text, _Array, _Fonts, _Path

def fonts(folders: Sequence[_Path] = (), *, context: Optional[Context] = None) -> list[dict[str, Any]]: ...

class Shaped:
    glyphs: _Array
    lines: _Array
    box: Tuple[float, float, float, float]
    points: _Array
    offsets: _Array
    def __init__(self, glyphs: _Array, lines: _Array, box: Tuple[float, float, float, float], points: _Array,
                 offsets: _Array) -> None: ...
    @property
    def width(self) -> float: ...
    @property
    def height(self) -> float: ...

def shape(text: str, *, size: float = 16, fonts: Sequence[_Path] = (), context: Optional[Context] = None,
          font: _Fonts = ..., anchor: str = ..., align: str = ..., max_width: float = ..., line_height: float = ...,
          letter_spacing: float = ..., vertical: bool = ..., language: Optional[str] = ...) -> Shaped: ...

def boxes(texts: Union[Text, Iterable[Text]], *, fonts: Sequence[_Path] = (),
          context: Optional[Context] = None) -> _Array: ...
