"""camber draws lines of maps into arrays with OpenCL kernels. The manual is docs/python.md."""

from ._core import (ArgumentError, Context, DeviceError, Error, FileError, InputError, LimitError, NotFoundError,
                    OutOfMemoryError, devices, lib as _lib, version as _version)
from ._density import Density, density
from ._draw import Mesh, Network, draw, encode, importance, tessellate
from ._map import Map, render, styles, tiles
from ._lines import tracks
from ._plot import Plot, plot
from ._text import Text
from . import text

__version__ = _version()
__all__ = ["ArgumentError", "Context", "Density", "DeviceError", "Error", "FileError", "InputError", "LimitError", "Map", "Mesh",
           "Network", "NotFoundError", "OutOfMemoryError", "Plot", "Text", "density", "devices", "draw", "encode",
           "importance", "plot", "render", "styles", "tessellate", "text", "tiles",
           "tracks"]

if __version__.split(".")[:2] != [str(_lib.CAMBER_VERSION_MAJOR), str(_lib.CAMBER_VERSION_MINOR)]:
    raise ImportError("camber was built for version %d.%d of its library, and finds %s; build it again"
                      % (_lib.CAMBER_VERSION_MAJOR, _lib.CAMBER_VERSION_MINOR, __version__))
