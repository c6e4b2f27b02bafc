"""Lines from other libraries: GeoArrow through Arrow's C data interface, made by hand here; Shapely and GeoPandas."""

import ctypes
import functools
import struct

import numpy
import pytest

import camber
from camber._lines import as_lines

LINES = [numpy.array([[5.0, 5], [60, 9], [30, 50]]), numpy.array([[8.0, 40], [50, 60]]),
         numpy.array([[50.0, 8], [10, 20], [60, 60]])]
WANTED = {"size": (70, 66), "width": 3}


class Schema(ctypes.Structure):
    pass


class Array(ctypes.Structure):
    pass


Schema._fields_ = [("format", ctypes.c_char_p), ("name", ctypes.c_char_p), ("metadata", ctypes.c_char_p),
                   ("flags", ctypes.c_int64), ("n_children", ctypes.c_int64),
                   ("children", ctypes.POINTER(ctypes.POINTER(Schema))), ("dictionary", ctypes.c_void_p),
                   ("release", ctypes.c_void_p), ("private_data", ctypes.c_void_p)]
Array._fields_ = [("length", ctypes.c_int64), ("null_count", ctypes.c_int64), ("offset", ctypes.c_int64),
                  ("n_buffers", ctypes.c_int64), ("n_children", ctypes.c_int64),
                  ("buffers", ctypes.POINTER(ctypes.c_void_p)), ("children", ctypes.POINTER(ctypes.POINTER(Array))),
                  ("dictionary", ctypes.c_void_p), ("release", ctypes.c_void_p), ("private_data", ctypes.c_void_p)]


class Stream(ctypes.Structure):
    _fields_ = [(name, ctypes.c_void_p) for name in ("get_schema", "get_next", "get_last_error", "release", "private_data")]


RELEASE = ctypes.CFUNCTYPE(None, ctypes.c_void_p)
GET = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
TELL = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p)
new_capsule = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)(
    ("PyCapsule_New", ctypes.pythonapi))
pointer_of = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p)(
    ("PyCapsule_GetPointer", ctypes.pythonapi))
NAMES = {Schema: b"arrow_schema", Array: b"arrow_array", Stream: b"arrow_array_stream"}
given = []  # everything made here, which must live until the last capsule is gone


def address_of(function):
    return ctypes.cast(function, ctypes.c_void_p).value


def destroy(kind, capsule):
    """Releases a struct together with its capsule, unless it has already been released."""
    made = kind.from_address(pointer_of(capsule, NAMES[kind]))
    if made.release:
        RELEASE(made.release)(ctypes.addressof(made))


DESTROYERS = {kind: RELEASE(functools.partial(destroy, kind)) for kind in NAMES}


def capsule_of(made):
    return new_capsule(ctypes.addressof(made), NAMES[type(made)], address_of(DESTROYERS[type(made)]))


class Given:
    """Counts releases, and overwrites the memory at each one, so that a later access is noticed."""

    def __init__(self):
        self.released = []
        given.append(self)

    def releaser(self, kind):
        function = RELEASE(functools.partial(self.release, kind))
        given.append(function)
        return address_of(function)

    def release(self, kind, address):
        self.released.append(kind)
        kind.from_address(address).release = None
        if kind is Array:
            self.spoil()


class Arrow(Given):
    """An array of one level: its buffers, of which the first is the validity bitmap, and its children."""

    def __init__(self, kind, length, buffers, children=(), offset=0, nulls=0):
        super().__init__()
        self.kept = [buffers, children]
        pointers = [None if each is None else each.ctypes.data for each in buffers]
        self.schema = Schema(format=kind.encode(), n_children=len(children))
        self.array = Array(length=length, null_count=nulls, offset=offset, n_buffers=len(buffers),
                           n_children=len(children), buffers=(ctypes.c_void_p * len(buffers))(*pointers))
        if children:
            self.schema.children = (ctypes.POINTER(Schema) * len(children))(*[ctypes.pointer(c.schema) for c in children])
            self.array.children = (ctypes.POINTER(Array) * len(children))(*[ctypes.pointer(c.array) for c in children])
        self.schema.release, self.array.release = self.releaser(Schema), self.releaser(Array)

    def spoil(self):
        for buffer in self.kept[0]:
            if buffer is not None:
                buffer.view("u1").fill(255)
        for child in self.kept[1]:
            child.spoil()

    def __arrow_c_array__(self, requested_schema=None):
        return capsule_of(self.schema), capsule_of(self.array)


class Chunks(Given):
    """A stream of several arrays, and optionally an error after them."""

    def __init__(self, *arrays, error=None):
        super().__init__()
        self.arrays, self.left, self.error = arrays, list(arrays), ctypes.create_string_buffer(error) if error else None
        functions = GET(self.get_schema), GET(self.get_next), TELL(lambda _: self.error and ctypes.addressof(self.error))
        given.extend(functions)
        self.stream = Stream(*map(address_of, functions), self.releaser(Stream))

    def get_schema(self, _, out):
        ctypes.memmove(out, ctypes.addressof(self.arrays[0].schema), ctypes.sizeof(Schema))
        return 0

    def get_next(self, _, out):
        if self.left:
            ctypes.memmove(out, ctypes.addressof(self.left.pop(0).array), ctypes.sizeof(Array))
        elif self.error:
            return 5
        else:
            Array.from_address(out).release = None
        return 0

    def __arrow_c_stream__(self, requested_schema=None):
        return capsule_of(self.stream)


def numbers(values):
    return Arrow("g", len(values), [None, values])


def points_of(values, interleaved, valid=None):
    about = {"nulls": 0 if valid is None else 1}
    if interleaved:
        return Arrow("+w:2", len(values), [valid], [numbers(numpy.array(values, order="C").ravel())], **about)
    return Arrow("+s", len(values), [valid], [numbers(numpy.array(values[:, i])) for i in (0, 1)], **about)


def linestrings(interleaved=True, kind="+l", **about):
    offsets = numpy.cumsum([0] + [len(line) for line in LINES]).astype("i8" if kind == "+L" else "i4")
    return Arrow(kind, about.pop("length", 3), [about.pop("valid", None), offsets],
                 [points_of(numpy.concatenate(LINES), interleaved)], **about)


@pytest.mark.parametrize("interleaved", [True, False])
@pytest.mark.parametrize("kind", ["+l", "+L"])
def test_linestrings(interleaved, kind):
    wanted = camber.draw(LINES, **WANTED)
    assert (camber.draw(linestrings(interleaved, kind), **WANTED) == wanted).all()
    network = camber.Network(linestrings(interleaved, kind))
    assert (network.draw(**WANTED) == camber.Network(LINES).draw(**WANTED)).all()


def test_what_is_given_is_released_once_after_its_use():
    wanted = camber.draw(LINES, **WANTED)
    array = linestrings()
    assert (camber.draw(array, **WANTED) == wanted).all()
    assert sorted(map(str, array.released)) == sorted(map(str, [Schema, Array]))
    with pytest.raises(ValueError, match="released already"):
        camber.draw(array, **WANTED)
    chunks = Chunks(*(linestrings(offset=i, length=1) for i in range(3)))
    assert (camber.draw(chunks, **WANTED) == wanted).all()
    assert [each.released for each in chunks.arrays] == [[Array, Schema], [Array], [Array]]
    assert chunks.released == [Stream]


def test_streams():
    wanted = camber.draw(LINES, **WANTED)
    assert (camber.draw(Chunks(linestrings()), **WANTED) == wanted).all()
    assert (camber.draw(Chunks(linestrings(length=0), linestrings(length=1), linestrings(offset=1, length=2)), **WANTED)
            == wanted).all()
    no_more = Chunks(linestrings())
    no_more.left = []
    assert not camber.draw(no_more, **WANTED).any()
    style = {**WANTED, "width": [2, 5, 7, 1], "color": ["#f00", "#00f", "#0f0", "#fff"]}
    several = [Arrow("+l", 2, [None, numpy.array(offsets, "i4")], [linestrings()]) for offsets in ([0, 1, 3], [0, 0, 1])]
    assert (camber.draw(Chunks(*several), **style)
            == camber.draw([*LINES, LINES[0]], **{**style, "rows": [0, 1, 1, 3]})).all()
    with pytest.raises(ValueError, match="the disk is gone"):
        camber.draw(Chunks(linestrings(), error=b"the disk is gone"), **WANTED)
    with pytest.raises(TypeError):
        camber.draw(Chunks(numbers(numpy.zeros(3))), **WANTED)


def test_a_part_and_what_is_missing():
    assert (camber.draw(linestrings(offset=1, length=2), **WANTED) == camber.draw(LINES[1:], **WANTED)).all()
    valid = numpy.array([0b101], numpy.uint8)
    assert (camber.draw(linestrings(valid=valid, nulls=1), **WANTED)
            == camber.draw([LINES[0], LINES[2]], **WANTED)).all()
    assert not camber.draw(linestrings(length=0), **WANTED).any()


@pytest.mark.parametrize("interleaved", [True, False])
def test_points_that_are_missing_split_a_line(interleaved):
    points, offsets = numpy.concatenate(LINES), numpy.array([0, 8], "i4")
    valid = numpy.array([0b11110111], numpy.uint8)
    split = numpy.where(numpy.arange(8)[:, None] == 3, numpy.nan, points)
    whole = points_of(points, interleaved, valid.copy())
    assert (camber.draw(Arrow("+l", 1, [None, offsets.copy()], [whole]), **WANTED) == camber.draw(split, **WANTED)).all()
    sides = [Arrow("g", 8, [missing, numpy.array(points[:, i])], nulls=int(missing is not None))
             for i, missing in enumerate((None, valid))]  # only y is missing
    assert (camber.draw(Arrow("+l", 1, [None, offsets], [Arrow("+s", 8, [None], sides)]), **WANTED)
            == camber.draw(split, **WANTED)).all()


class Table(Arrow):
    """A table of columns, as pyarrow and polars export it."""

    def __init__(self, columns, length, metadata=None, **about):
        super().__init__("+s", length, [None], list(columns.values()), **about)
        self.columns, self.given = list(columns), dict(columns)
        for name, column in columns.items():
            column.schema.name = name.encode()
        if metadata:
            self.given["way"].schema.metadata = metadata

    def __getitem__(self, name):
        return self.given[name].kept[0][1]

    def __arrow_c_stream__(self, requested_schema=None):
        return Chunks(self).__arrow_c_stream__()

    def __arrow_c_array__(self, requested_schema=None):
        raise AssertionError("tables are read as streams")

    __arrow_c_array__ = property()  # there is none


def metadata_of(**pairs):
    texts = [text for pair in pairs.items() for text in pair]
    packed = b"".join(struct.pack("=i", len(text)) + text.encode() for text in
                      (text.replace("__", ":") for text in texts))
    return struct.pack("=i", len(pairs)) + packed


def test_tables():
    wanted = camber.draw(LINES, **WANTED)

    def table(**about):
        metadata = metadata_of(ARROW__extension__name="geoarrow.linestring",
                               ARROW__extension__metadata='{"crs": "EPSG:25832", "edges": "planar"}')
        return Table({"speed": numbers(numpy.array([1.0, 2, 3])), "way": linestrings(kind="+L")}, 3, metadata, **about)

    assert (camber.draw(table(), **WANTED) == wanted).all()
    part = Table({"way": linestrings()}, 2, offset=1)
    assert (camber.draw(part, **WANTED) == camber.draw(LINES[1:], **WANTED)).all()
    assert as_lines(table(), None, "f8", "i8").crs == "EPSG:25832"
    pytest.importorskip("pyproj")
    plotted = camber.plot(table(), column="speed", size=(70, 66), legend=False)
    assert plotted.crs == "EPSG:25832"
    assert (plotted.picture == camber.plot(LINES, column=[1.0, 2, 3], size=(70, 66), legend=False).picture).all()
    with pytest.raises(TypeError, match="no column of lines.*camber.tracks"):
        camber.draw(Table({"speed": numbers(numpy.array([1.0, 2, 3]))}, 3), **WANTED)


def test_tracks():
    points = numpy.concatenate(LINES)
    keys = numpy.repeat([7, 3, 9], [3, 2, 3])
    table = {"x": points[:, 0], "y": points[:, 1], "id": keys}

    class Columns(dict):
        columns = list(table)

    wanted = camber.draw(LINES, **WANTED)
    assert (camber.draw(camber.tracks(Columns(table), by="id"), **WANTED) == wanted).all()
    order = [0, 3, 5, 1, 4, 6, 7, 2]  # the points of the lines alternate
    mixed = Columns({name: column[order] for name, column in table.items()})
    made, offsets = camber.tracks(mixed, "x", "y", "id")
    assert offsets.tolist() == [0, 2, 5, 8] and (made[2:5] == LINES[0]).all() and (made[:2] == LINES[1]).all()
    assert (camber.draw(camber.tracks(Columns(table)), **WANTED) == camber.draw(points, **WANTED)).all()
    with pytest.raises(ValueError, match="no column 'lon'; the table has 'x', 'y', 'id'"):
        camber.tracks(Columns(table), "lon", "lat")


def test_polars_and_pyarrow():
    polars = pytest.importorskip("polars")
    pyarrow = pytest.importorskip("pyarrow")
    wanted = camber.draw(LINES, **WANTED)
    rows = [[{"x": x, "y": y} for x, y in line] for line in LINES]
    for table in polars.DataFrame({"way": rows, "speed": [1.0, 2, 3]}), pyarrow.table({"way": rows, "speed": [1.0, 2, 3]}):
        assert (camber.draw(table, **WANTED) == wanted).all()
        assert (camber.plot(table, column="speed", legend=False).picture
                == camber.plot(LINES, column=[1.0, 2, 3], legend=False).picture).all()


def test_memory_that_is_not_aligned():
    wanted = camber.draw(LINES, **WANTED)

    def moved(values):
        return numpy.frombuffer(bytearray(1) + values.tobytes(), values.dtype, offset=1)

    offsets = numpy.array([0, 3, 5, 8], "i4")
    points = Arrow("+w:2", 8, [None], [numbers(moved(numpy.concatenate(LINES).ravel()))])
    assert (camber.draw(Arrow("+l", 3, [None, moved(offsets)], [points]), **WANTED) == wanted).all()
    for kind, whole in ("f4", "u4"), ("f8", "u8"):
        values, offsets = moved(numpy.concatenate(LINES).astype(kind)).reshape(-1, 2), moved(offsets.astype(whole))
        assert not values.flags.aligned and not offsets.flags.aligned
        lines = as_lines(values, offsets, numpy.dtype(kind), numpy.dtype(whole))
        assert lines.points.flags.aligned and lines.offsets.flags.aligned
        assert (camber.draw(values, offsets, **WANTED) == wanted).all()
        camber.Network(values, offsets, importance=moved(numpy.zeros(8, "f4"))).draw(**WANTED)


def test_multilinestrings_have_one_style_each():
    several = Arrow("+l", 2, [None, numpy.array([0, 1, 3], "i4")], [linestrings()])
    style = {**WANTED, "width": [2, 5], "color": ["#f00", "#00f"]}
    wanted = camber.draw(LINES, rows=[0, 1, 1], **style)
    assert (camber.draw(several, **style) == wanted).all()
    valid = numpy.array([0b01], numpy.uint8)
    several = Arrow("+l", 2, [valid, numpy.array([0, 1, 3], "i4")], [linestrings()], nulls=1)
    assert (camber.draw(several, **WANTED) == camber.draw(LINES[:1], **WANTED)).all()
    valid = numpy.array([0b101], numpy.uint8)
    several = Arrow("+l", 2, [None, numpy.array([0, 1, 3], "i4")], [linestrings(valid=valid, nulls=1)])
    assert (camber.draw(several, **WANTED) == camber.draw(LINES[::2], **WANTED)).all()


def test_arrow_that_is_wrong():
    offsets = numpy.array([0, 99, 5], "i4")
    for array, error in ((numbers(numpy.zeros(3)), TypeError), (points_of(LINES[0], True), TypeError),
                         (Arrow("z", 1, [None, numpy.zeros(2, "i4"), numpy.zeros(4, "u1")]), TypeError),
                         (Arrow("+l", 1, [None, offsets], [points_of(LINES[0], True)]), ValueError),
                         (Arrow("+l", 2, [None, offsets], [points_of(LINES[0], True)]), ValueError),
                         (Arrow("+l", 1, [None, offsets[::-1] - 9], [points_of(LINES[0], True)]), ValueError),
                         (Arrow("+l", 1, [None, numpy.array([0, 3], "i4")], [numbers(numpy.zeros(9))]), TypeError)):
        with pytest.raises(error):
            camber.draw(array, **WANTED)

    class Other:
        def __arrow_c_array__(self):
            return 1, 2
    with pytest.raises((TypeError, ValueError)):
        camber.draw(Other(), **WANTED)


def test_pyarrow():
    pyarrow = pytest.importorskip("pyarrow")
    array = pyarrow.array([line.tolist() for line in LINES],
                          pyarrow.list_(pyarrow.list_(pyarrow.float64(), 2)))
    assert (camber.draw(array, **WANTED) == camber.draw(LINES, **WANTED)).all()


def test_shapely():
    geometry = pytest.importorskip("shapely.geometry")
    lines = [geometry.LineString(line) for line in LINES]
    wanted = camber.draw(LINES, **WANTED)
    assert (camber.draw(lines, **WANTED) == wanted).all()
    assert (camber.draw(geometry.MultiLineString(lines), **WANTED) == wanted).all()
    style = {**WANTED, "width": [2, 5, 9], "color": ["#f00", "#0f0", "#00f"]}
    mixed = [geometry.MultiLineString(lines[:2]), geometry.Point(1, 2), lines[2]]
    wanted = camber.draw(LINES, rows=[0, 0, 2], **style)
    assert (camber.draw(mixed, **style) == wanted).all()
    assert (camber.draw([mixed[0], mixed[2], mixed[1]], rows=[0, 2, 1], **style) == wanted).all()
    network = camber.Network(mixed, rows=range(3))
    assert (network.draw(**style) == camber.Network(LINES, rows=[0, 0, 2]).draw(**style)).all()
    with pytest.raises(ValueError, match="2 rows and 3 lines"):
        camber.Network(mixed, rows=[0, 0])
    square = geometry.box(10, 10, 50, 50).difference(geometry.box(20, 20, 30, 30))
    rings = [numpy.asarray(square.exterior.coords), numpy.asarray(square.interiors[0].coords)]
    assert (camber.draw(square, **WANTED) == camber.draw(rings, **WANTED)).all()
    assert not camber.draw(geometry.LineString(), **WANTED).any()
    high = geometry.LineString([(*point, 7) for point in LINES[0]])
    assert (camber.draw(high, **WANTED) == camber.draw(LINES[:1], **WANTED)).all()


def test_geopandas():
    geopandas = pytest.importorskip("geopandas")
    geometry = pytest.importorskip("shapely.geometry")
    series = geopandas.GeoSeries([*(geometry.LineString(line) for line in LINES), None])
    wanted = camber.draw(LINES, **WANTED)
    assert (camber.draw(series, **WANTED) == wanted).all()
    frame = geopandas.GeoDataFrame({"w": [2, 5, 9, 1]}, geometry=series)  # the last row has a width, but no line
    assert (camber.draw(frame, **WANTED) == wanted).all()
    style = {**WANTED, "width": frame.w}
    assert (camber.draw(frame, **style) == camber.draw(LINES, **{**style, "width": [2, 5, 9]})).all()
    assert camber.Network(frame, rows=range(4)).draw(**style).any()
