"""Converts lines from arrays, lists of arrays, GeoArrow, Shapely and GeoPandas into points and offsets."""

import ctypes
import datetime
import decimal
import importlib
import json
import os
import struct
import sys

import numpy

from ._core import ArgumentError
from ._library import ffi, lib


class Lines:
    """Points (n x 2), offsets (lines + 1), and the index of each line's origin; None: each line is its own origin.

    origin_count is the number of origins, including those without a line. crs is what GeoArrow says of its CRS, or None.
    """

    def __init__(self, points, offsets, origins=None, origin_count=None, crs=None):
        self.points, self.offsets, self.origins, self.crs = points, offsets, origins, crs
        self._origin_count = origin_count

    def __len__(self):
        return len(self.offsets) - 1

    @property
    def origin_count(self):
        return len(self) if self.origins is None else self._origin_count


def as_points(points, dtype):
    """Returns an array of pairs of this type, C-contiguous and aligned: the caller's own array if it is one already."""
    array = numpy.asarray(points)
    if array.dtype.kind not in "fiu":
        raise TypeError("points have the type %s; give floats or whole numbers" % array.dtype)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 2)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError("points have the shape %s; give n x 2: x and y of each" % (array.shape,))
    with numpy.errstate(over="ignore"):  # infinite values are left out and counted, like NaN
        return numpy.require(array, dtype, "CA")


def as_whole(values, dtype, what):
    """Returns an array of whole numbers that fit the type."""
    array = numpy.asarray(values)
    if array.size == 0:
        array = array.astype(dtype)
    if array.dtype.kind not in "iu":
        raise TypeError("%s have the type %s; give whole numbers" % (what, array.dtype))
    if array.ndim != 1:
        raise ValueError("%s have the shape %s; give one dimension" % (what, array.shape))
    if array.size and (int(array.min()) < 0 or int(array.max()) > numpy.iinfo(dtype).max):
        raise ValueError("%s go from %d to %d; give 0 to %d" % (what, array.min(), array.max(),
                                                                numpy.iinfo(dtype).max))
    return numpy.require(array, dtype, "CA")


def is_pair(value):
    """Whether this is a tuple of points and offsets, as Map.lines() and tracks() return it."""
    return isinstance(value, tuple) and len(value) == 2 and all(isinstance(each, numpy.ndarray) for each in value) and \
        (value[0].ndim, value[1].ndim) == (2, 1) and value[1].dtype.kind in "iu"


def refuse(points):
    """Refuses what is likely given in place of lines: nothing, a file, or a table without a geometry."""
    if points is None or isinstance(points, (str, bytes, os.PathLike)):
        raise TypeError("the lines are %r; give a GeoDataFrame or arrays. camber.Map(file) draws a file, and "
                        "geopandas.read_file(file) reads one" % (points,))
    if isinstance(points, dict) or (columns_of(points) and not hasattr(points, "geometry")
                                    and not hasattr(points, "__arrow_c_stream__")):
        raise TypeError("the table has no geometry; give a GeoDataFrame, or camber.tracks(table, x, y, by)")


def as_lines(points, offsets, dtype, offset_dtype, dots=False):
    """Converts any supported value to Lines of these types. dots: points of Shapely are lines of one point."""
    if offsets is None and is_pair(points):
        points, offsets = points
    refuse(points)
    if isinstance(points, Lines):
        lines = points
    elif offsets is not None:
        lines = Lines(points, offsets)
    elif hasattr(points, "__arrow_c_array__"):
        lines = from_arrow(points)
    elif hasattr(type(points), "geom_type") or hasattr(points, "geometry"):  # of its class: a GeoSeries takes a second
        lines = from_geometries(points, dots)
    elif hasattr(points, "__arrow_c_stream__"):
        lines = from_arrow_stream(points)
    elif isinstance(points, (list, tuple)) or getattr(points, "dtype", None) == object:
        lines = from_list(points, dots)
    else:  # one line
        points = numpy.asarray(points)
        lines = Lines(points, [0, len(points) if points.ndim else 0])
    points, offsets = as_points(lines.points, dtype), as_whole(lines.offsets, offset_dtype, "offsets")
    if not len(offsets):
        raise ValueError("offsets are empty; give one more than there are lines: [0] for none")
    if int(offsets[-1]) != len(points) or offsets[0] != 0 or (len(offsets) > 1 and (offsets[1:] < offsets[:-1]).any()):
        raise ValueError("offsets go from %d to %d, and must ascend from 0 to %d, the number of points"
                         % (offsets[0], offsets[-1], len(points)))
    return Lines(points, offsets, lines.origins, lines._origin_count, lines.crs)


def columns_of(data):
    """Returns the names of a table's columns: pandas', polars' or pyarrow's. Empty: this is no table."""
    names = getattr(data, "column_names", None)  # pyarrow
    names = getattr(data, "columns", ()) if names is None else names
    return [name for name in names if isinstance(name, str)] if not callable(names) else []


def to_array(column):
    if getattr(getattr(column, "dtype", None), "tz", None) is not None:
        return column.to_numpy("datetime64[ns]")  # which would be objects
    return column.to_numpy() if hasattr(column, "to_numpy") else numpy.asarray(column)


def find_missing(values):
    """Returns which elements of an array of objects are missing: None, NaN, NaT or pandas' NA."""
    pandas = sys.modules.get("pandas")
    return pandas.isna(values) if pandas else numpy.array([each is None or each != each for each in values], bool)


def as_values(values):
    """Returns a column as an array: of floats, in which what is missing is NaN, of dates, or of objects, which are
    categories, None if missing."""
    values = numpy.asarray(to_array(values))
    if values.dtype.kind in "fiu":
        return values.astype(numpy.float64, copy=False)
    if values.dtype.kind in "mM":
        return values
    values = values.astype(object)
    missing = find_missing(values)
    kinds = {type(each) for each in values[~missing]}
    if any(issubclass(kind, (list, dict, set, numpy.ndarray)) or hasattr(kind, "geom_type") for kind in kinds):
        raise ArgumentError("the column has values of type %s; give numbers, dates, texts or booleans"
                            % ", ".join(sorted(kind.__name__ for kind in kinds)))
    if kinds and all(issubclass(kind, (int, float, decimal.Decimal, numpy.number)) and kind is not bool for kind in kinds):
        return numpy.where(missing, numpy.nan, values).astype(numpy.float64)
    if kinds == {datetime.date}:
        return numpy.where(missing, None, values).astype("M8[D]")
    return numpy.where(missing, None, values)


def tracks(table, x="x", y="y", by=None):
    """Makes lines from a table of points, in their order: returns points and offsets, in a tuple that draw(), plot() and
    density() take. x, y: the names of columns. by: the column that says which line a point belongs to; None: one line.
    Lines come in the order of their keys, unless the points of each line are together. Points without a key are left
    out."""
    missing = [name for name in (x, y, by) if name is not None and name not in columns_of(table)]
    if missing:
        raise ValueError("there is no column %r; the table has %s" % (missing[0], ", ".join(map(repr, columns_of(table)))))
    values = [as_values(table[name]) for name in (x, y)]
    for name, column in zip((x, y), values):
        if column.dtype.kind != "f" and len(column):
            raise ArgumentError("the column %r has no numbers; give columns of coordinates" % name)
    points = numpy.stack([column.astype(numpy.float64) for column in values], axis=1)
    if by is not None:
        keys = numpy.asarray(to_array(table[by]))
        has_key = ~(find_missing(keys) if keys.dtype == object else keys != keys)
        points, keys = points[has_key], keys[has_key]
    if by is None or not len(points):
        return points, numpy.array([0, len(points)])
    starts = numpy.concatenate([[0], numpy.flatnonzero(keys[1:] != keys[:-1]) + 1])
    if len(numpy.unique(keys[starts])) < len(starts):
        order = numpy.argsort(keys, kind="stable")
        points, keys = points[order], keys[order]
        starts = numpy.concatenate([[0], numpy.flatnonzero(keys[1:] != keys[:-1]) + 1])
    return points, numpy.append(starts, len(points))


def join(arrays, origins=None, origin_count=None):
    """Makes Lines from an array of points for each line."""
    offsets = numpy.zeros(len(arrays) + 1, numpy.uint64)
    numpy.cumsum([len(array) for array in arrays], out=offsets[1:])
    points = numpy.concatenate(arrays) if arrays else numpy.empty((0, 2))
    return Lines(points, offsets, origins, origin_count)


def from_list(items, dots=False):
    """Converts a list of arrays of points, or of geometries. A list of pairs of numbers is one line."""
    if len(items) and (hasattr(items[0], "geom_type") or items[0] is None):
        return from_geometries(items, dots)
    if len(items) and all(numpy.ndim(item) == 1 and len(item) == 2 for item in items):
        return Lines(numpy.asarray(items), [0, len(items)])
    return join([as_points(item, numpy.float64) for item in items])


# ---- Shapely and GeoPandas ----

POINT, LINE, RING, POLYGON, LAST_SIMPLE = 0, 1, 2, 3, 3  # Shapely's numbers of types; those above are collections


def parts_of(geometry, dots):
    """Returns the lines of a geometry as arrays of points: the parts of a collection, and the rings of polygons."""
    kind = None if geometry is None else geometry.geom_type
    if kind in ("LineString", "LinearRing") or (kind == "Point" and dots and not geometry.is_empty):
        points = numpy.asarray(geometry.coords, dtype=numpy.float64)
        yield points[:, :2] if len(points) else points.reshape(0, 2)
    elif kind == "Polygon":
        for ring in [geometry.exterior, *geometry.interiors] if not geometry.is_empty else []:
            yield from parts_of(ring, dots)
    elif hasattr(geometry, "geoms"):
        for part in geometry.geoms:
            yield from parts_of(part, dots)


def from_each(geometries, dots):
    """Converts geometries one by one, for Shapely 1."""
    arrays, origins = [], []
    for number, geometry in enumerate(geometries):
        for part in parts_of(geometry, dots):
            arrays.append(part)
            origins.append(number)
    return join(arrays, numpy.asarray(origins, numpy.int64), len(geometries))


def from_linestrings(geometries):
    """Converts linestrings of Shapely 1 by GEOS's functions, which is twenty times as fast. None: there is something else
    among them, or GEOS is older than 3.10."""
    geometries = list(geometries)  # a sequence may make them as they are asked for, and GEOS frees those that nobody has
    if not geometries or {type(each).__name__ for each in geometries} != {"LineString"}:
        return None
    geos = importlib.import_module("shapely.geos")
    names = "GEOSGeomTypeId_r", "GEOSGeom_getCoordSeq_r", "GEOSCoordSeq_getSize_r", "GEOSCoordSeq_copyToBuffer_r"
    try:
        functions = [ctypes.cast(getattr(geos._lgeos, name), ctypes.c_void_p).value for name in names]
        handles = numpy.fromiter((each.__geom__ for each in geometries), numpy.uintp, len(geometries))
    except (AttributeError, TypeError):
        return None
    if not handles.all():
        return None
    calls = ffi.new("camber_python_geos *", [ffi.cast(kind, at) for kind, at in zip(
        (field.type for _, field in ffi.typeof("camber_python_geos").fields), (geos.lgeos.geos_handle, *functions))])
    lines, offsets = ffi.from_buffer("uintptr_t[]", handles), numpy.zeros(len(handles) + 1, numpy.uint64)
    if not lib.camber_python_count(calls, lines, len(handles), ffi.from_buffer("uint64_t[]", offsets)):
        return None
    points = numpy.empty((int(offsets[-1]), 2))
    if not lib.camber_python_copy(calls, lines, len(handles), ffi.from_buffer("uint64_t[]", offsets),
                                  ffi.from_buffer("double[]", points)):
        return None
    return Lines(points, offsets, numpy.arange(len(handles)), len(handles))


def from_all(shapely, geometries, dots):
    """Converts geometries by calls of Shapely 2 that take all of them at once."""
    count, origins = len(geometries), numpy.arange(len(geometries))
    kinds = shapely.get_type_id(geometries)
    while (kinds > LAST_SIMPLE).any():  # collections may be nested
        geometries, index = shapely.get_parts(geometries, return_index=True)
        origins, kinds = origins[index], shapely.get_type_id(geometries)
    if (kinds == POLYGON).any():
        rest = kinds != POLYGON
        rings, index = shapely.get_rings(geometries[~rest], return_index=True)
        order = numpy.argsort(numpy.concatenate([numpy.flatnonzero(rest), numpy.flatnonzero(~rest)[index]]), kind="stable")
        origins = numpy.concatenate([origins[rest], origins[~rest][index]])[order]
        geometries = numpy.concatenate([geometries[rest], rings])[order]
        kinds = shapely.get_type_id(geometries)
    counts = shapely.get_num_coordinates(geometries)
    taken = (kinds == LINE) | (kinds == RING) | ((kinds == POINT) & (counts > 0) & dots)
    if not taken.all():
        geometries, origins, counts = geometries[taken], origins[taken], counts[taken]
    offsets = numpy.concatenate([[0], numpy.cumsum(counts)])
    return Lines(shapely.get_coordinates(geometries), offsets, origins, count)


def from_geometries(geometries, dots=False):
    """Converts one or many geometries of Shapely, a GeoSeries, or the geometries of a GeoDataFrame. dots: points are
    lines of one point."""
    if hasattr(type(geometries), "wkb"):  # a geometry
        geometries = [geometries]
    else:
        geometries = getattr(geometries, "geometry", geometries)
    try:
        shapely = importlib.import_module("shapely")
        if not hasattr(shapely, "get_parts"):
            geometries = numpy.asarray(geometries) if hasattr(geometries, "values") else geometries
            return from_linestrings(geometries) or from_each(geometries, dots)
        array = numpy.empty(len(geometries), object)
        array[:] = geometries
        if not (shapely.is_geometry(array) | shapely.is_missing(array)).all():
            return from_each(geometries, dots)
    except ImportError:
        return from_each(geometries, dots)
    return from_all(shapely, array, dots)


# ---- GeoArrow, through Arrow's C data interface ----

_capsule_pointer = ctypes.pythonapi.PyCapsule_GetPointer
_capsule_pointer.restype = ctypes.c_void_p
_capsule_pointer.argtypes = [ctypes.py_object, ctypes.c_char_p]

WANTED = "give GeoArrow's linestring or multilinestring (GeoPandas: to_arrow(geometry_encoding=\"geoarrow\"))"


def _format(schema):
    return ffi.string(schema.format).decode()


def _is_lines(schema):
    """Whether a column may be lines: a list, or a list of lists, of points."""
    for _ in range(2):
        if _format(schema) not in ("+l", "+L") or schema.n_children != 1:
            return False
        schema = schema.children[0]
        if _format(schema) == "+s" or _format(schema).startswith("+w:"):
            return True
    return False


def _metadata(schema):
    """Returns the metadata of a column: pairs of texts with their lengths before them."""
    found, at = {}, 4
    if schema.metadata == ffi.NULL:
        return found
    number = lambda place: struct.unpack("=i", ffi.buffer(schema.metadata + place, 4))[0]  # noqa: E731
    for _ in range(number(0)):
        pair = []
        for _ in range(2):
            size = number(at)
            pair.append(bytes(ffi.buffer(schema.metadata + at + 4, size)))
            at += 4 + size
        found[pair[0]] = pair[1]
    return found


def _crs_of(schema):
    """Returns what GeoArrow's metadata says of the CRS, or None."""
    try:
        return json.loads(_metadata(schema)[b"ARROW:extension:metadata"]).get("crs")
    except (KeyError, ValueError, AttributeError):
        return None


class _Arrow:
    """The memory of an Arrow array. Its owner, capsules or structs filled by a stream, frees it."""

    def __init__(self, owner):
        self.owner = owner

    def bytes(self, pointer, first, count):
        kept = ffi.gc(ffi.cast("char *", pointer) + first, lambda _, owner=self.owner: None)
        return numpy.frombuffer(ffi.buffer(kept, count), numpy.uint8)

    def buffer(self, array, number, dtype, first, count):
        """Returns elements of a buffer without a copy. They are valid as long as their owner."""
        if count == 0 or array.buffers[number] == ffi.NULL:
            return numpy.zeros(count, dtype)
        size = numpy.dtype(dtype).itemsize
        return self.bytes(array.buffers[number], first * size, count * size).view(dtype)

    def list(self, schema, array, first, count, what):
        """Returns the offsets of a list's elements."""
        kind = {"+l": numpy.int32, "+L": numpy.int64}.get(_format(schema))
        if kind is None or array.n_buffers != 2 or array.n_children != 1:
            raise TypeError("Arrow's format %r is not a list of %s; %s" % (_format(schema), what, WANTED))
        offsets = self.buffer(array, 1, kind, array.offset + first, count + 1)
        if count and (offsets[0] < 0 or (offsets[1:] < offsets[:-1]).any() or offsets[-1] > array.children[0].length):
            raise ValueError("offsets of an Arrow list do not ascend within its %s" % what)
        return offsets

    def points(self, schema, array, first, count):
        """Returns points as pairs: without a copy if x and y are interleaved, otherwise combined. A missing point is
        NaN."""
        kind = _format(schema)
        if kind.startswith("+w:") and kind[3:].isdigit() and _format(schema.children[0]) == "g":
            side = int(kind[3:])
            values = self.numbers(array.children[0], (array.offset + first) * side, count * side)
            values = values.reshape(count, side)[:, :2]
        elif kind == "+s" and array.n_children >= 2 and all(_format(schema.children[i]) == "g" for i in (0, 1)):
            values = numpy.stack([self.numbers(array.children[i], array.offset + first, count) for i in (0, 1)], axis=1)
        else:
            raise TypeError("Arrow's format %r is not a point; %s" % (kind, WANTED))
        is_valid = self.is_valid(array, first, count)
        return values if is_valid is None else numpy.where(is_valid[:, None], values, numpy.nan)

    def numbers(self, array, first, count):
        """Returns elements of an array of numbers. A missing element is NaN."""
        values = self.buffer(array, 1, numpy.float64, array.offset + first, count)
        is_valid = self.is_valid(array, first, count)
        return values if is_valid is None else numpy.where(is_valid, values, numpy.nan)

    def is_valid(self, array, first, count):
        """Returns which elements are valid, or None if all of them are."""
        if array.null_count == 0 or array.n_buffers == 0 or array.buffers[0] == ffi.NULL:
            return None
        first += array.offset
        bits = self.bytes(array.buffers[0], 0, (first + count + 7) // 8)
        return numpy.unpackbits(bits, bitorder="little")[first:first + count].astype(bool)

    def lines(self, schema, array):
        """Converts linestrings and multilinestrings, or the first column of a table that has some."""
        if _format(schema) == "+s":
            for i in range(schema.n_children):
                if _is_lines(schema.children[i]):
                    return self.column(schema.children[i], array.children[i], array.offset, array.length)
            raise TypeError("the table has no column of lines; %s, or camber.tracks(table, x, y, by)" % WANTED)
        return self.column(schema, array, 0, array.length)

    def column(self, schema, array, start, length):
        """Converts entries [start, start + length) of a column of lines."""
        count, origins = length, None
        offsets = self.list(schema, array, start, count, "points")
        is_valid = self.is_valid(array, start, count)
        inner_schema, inner = schema.children[0], array.children[0]
        if _format(inner_schema) in ("+l", "+L"):
            origins = numpy.repeat(numpy.arange(count), numpy.diff(offsets))
            is_valid = True if is_valid is None else numpy.repeat(is_valid, numpy.diff(offsets))
            first, count = int(offsets[0]) if count else 0, len(origins)
            offsets = self.list(inner_schema, inner, first, count, "points")
            is_inner_valid = self.is_valid(inner, first, count)
            is_valid = is_valid & (True if is_inner_valid is None else is_inner_valid)
            inner_schema, inner = inner_schema.children[0], inner.children[0]
        first = int(offsets[0]) if count else 0
        points = self.points(inner_schema, inner, first, int(offsets[-1]) - first if count else 0)
        offsets = offsets[:count + 1] - first if first else offsets[:count + 1]
        if is_valid is not None and not numpy.all(is_valid):  # a missing line has no points
            points = points[numpy.repeat(is_valid, numpy.diff(offsets))]
            offsets = numpy.concatenate([[0], numpy.cumsum(numpy.diff(offsets) * is_valid)])
        return Lines(points, offsets if count else numpy.zeros(1, numpy.int64), origins, length, _crs_of(schema))


def _struct(capsule, kind, name):
    """Returns the struct in a capsule, unless it has already been moved or released."""
    made = ffi.cast("struct %s *" % kind, _capsule_pointer(capsule, name))
    if made.release == ffi.NULL:
        raise ValueError("Arrow's %s has been released already" % kind)
    return made


def from_arrow(value):
    """Converts the lines of an object with __arrow_c_array__."""
    capsules = value.__arrow_c_array__()
    return _Arrow(capsules).lines(_struct(capsules[0], "ArrowSchema", b"arrow_schema"),
                                  _struct(capsules[1], "ArrowArray", b"arrow_array"))


def _new(kind):
    """Makes a struct for a stream to fill. It is released when Python drops it."""
    return ffi.gc(ffi.new("struct %s *" % kind), lambda made: made.release != ffi.NULL and made.release(made))


def from_arrow_stream(value):
    """Converts the lines of an object with __arrow_c_stream__, which yields several arrays, such as pyarrow's chunked
    ones."""
    capsule = value.__arrow_c_stream__()
    stream = _struct(capsule, "ArrowArrayStream", b"arrow_array_stream")

    def check(failed):
        if failed:
            told = stream.get_last_error(stream)
            raise ValueError("Arrow's stream failed: %s" % (ffi.string(told).decode("utf-8", "replace") if told else failed))

    schema, pieces = _new("ArrowSchema"), []
    check(stream.get_schema(stream, schema))
    while True:
        array = _new("ArrowArray")
        check(stream.get_next(stream, array))
        if array.release == ffi.NULL:
            break
        pieces.append(_Arrow((schema, array)).lines(schema, array))
    if len(pieces) == 1:
        return pieces[0]
    lines = join([piece.points for piece in pieces])
    starts = lines.offsets.astype(numpy.int64)
    offsets = numpy.concatenate([[0], *(piece.offsets[1:] + start for piece, start in zip(pieces, starts))])
    firsts = numpy.cumsum([0, *(piece.origin_count for piece in pieces)])
    origins = None
    if pieces and pieces[0].origins is not None:
        origins = numpy.concatenate([piece.origins + first for piece, first in zip(pieces, firsts)])
    return Lines(lines.points, offsets.astype(numpy.int64), origins, int(firsts[-1]), pieces[0].crs if pieces else None)
