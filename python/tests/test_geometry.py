"""Lines of other libraries: GeoArrow by Arrow's C data interface, made here by hand; Shapely and GeoPandas."""

import ctypes

import numpy
import pytest

import camber

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
new_capsule = ctypes.pythonapi.PyCapsule_New
new_capsule.restype, new_capsule.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]


class Arrow:
    """An array of one level: its buffers (the first says what is there) and its children."""

    def __init__(self, kind, length, buffers, children=(), offset=0, nulls=0):
        self.kept = [buffers, children]
        pointers = [None if each is None else each.ctypes.data for each in buffers]
        self.schema = Schema(format=kind.encode(), n_children=len(children))
        self.array = Array(length=length, null_count=nulls, offset=offset, n_buffers=len(buffers),
                           n_children=len(children), buffers=(ctypes.c_void_p * len(buffers))(*pointers))
        if children:
            self.schema.children = (ctypes.POINTER(Schema) * len(children))(*[ctypes.pointer(c.schema) for c in children])
            self.array.children = (ctypes.POINTER(Array) * len(children))(*[ctypes.pointer(c.array) for c in children])

    def __arrow_c_array__(self, requested_schema=None):
        return (new_capsule(ctypes.addressof(self.schema), b"arrow_schema", None),
                new_capsule(ctypes.addressof(self.array), b"arrow_array", None))


def numbers(values):
    return Arrow("g", len(values), [None, values])


def points_of(values, interleaved):
    if interleaved:
        return Arrow("+w:2", len(values), [None], [numbers(numpy.ascontiguousarray(values).ravel())])
    return Arrow("+s", len(values), [None], [numbers(numpy.ascontiguousarray(values[:, i])) for i in (0, 1)])


def linestrings(interleaved=True, kind="+l", **about):
    offsets = numpy.cumsum([0] + [len(line) for line in LINES]).astype("i8" if kind == "+L" else "i4")
    return Arrow(kind, about.pop("length", 3), [about.pop("valid", None), offsets],
                 [points_of(numpy.concatenate(LINES), interleaved)], **about)


@pytest.mark.parametrize("interleaved", [True, False])
@pytest.mark.parametrize("kind", ["+l", "+L"])
def test_linestrings(interleaved, kind):
    wanted = camber.draw(LINES, **WANTED)
    array = linestrings(interleaved, kind)
    assert (camber.draw(array, **WANTED) == wanted).all()
    assert (camber.Network(array).draw(**WANTED) == camber.Network(LINES).draw(**WANTED)).all()


def test_a_part_and_what_is_missing():
    assert (camber.draw(linestrings(offset=1, length=2), **WANTED) == camber.draw(LINES[1:], **WANTED)).all()
    valid = numpy.array([0b101], numpy.uint8)
    assert (camber.draw(linestrings(valid=valid, nulls=1), **WANTED)
            == camber.draw([LINES[0], LINES[2]], **WANTED)).all()
    assert not camber.draw(linestrings(length=0), **WANTED).any()


def test_multilinestrings_have_one_style_each():
    several = Arrow("+l", 2, [None, numpy.array([0, 1, 3], "i4")], [linestrings()])
    style = {**WANTED, "width": [2, 5], "color": ["#f00", "#00f"]}
    wanted = camber.draw(LINES, rows=[0, 1, 1], **style)
    assert (camber.draw(several, **style) == wanted).all()
    valid = numpy.array([0b01], numpy.uint8)
    several = Arrow("+l", 2, [valid, numpy.array([0, 1, 3], "i4")], [linestrings()], nulls=1)
    assert (camber.draw(several, **WANTED) == camber.draw(LINES[:1], **WANTED)).all()


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
    assert (camber.draw(mixed, **style) == camber.draw(LINES, rows=[0, 0, 2], **style)).all()
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
    assert (camber.draw(geopandas.GeoDataFrame({"kind": list("abcd")}, geometry=series), **WANTED) == wanted).all()
