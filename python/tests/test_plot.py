"""Plots, densities and maps of tables: what people guess works, or an error says what to give instead."""

import os
import re
import subprocess
import sys
import tempfile
import warnings

import numpy
import pytest

import camber
import png_rows
from camber._lines import from_each, from_geometries, from_linestrings

LINES = [numpy.array([[10.0, 50], [10.2, 50.1]]), numpy.array([[10.0, 50.1], [10.2, 50]]),
         numpy.array([[10.1, 50], [10.1, 50.1], [10.15, 50.05]])]


@pytest.fixture
def frame():
    geopandas = pytest.importorskip("geopandas")
    from shapely.geometry import LineString
    return geopandas.GeoDataFrame({"speed": [10.0, 20, 30], "kind": ["bus", None, "rail"]},
                                  geometry=[LineString(line) for line in LINES], crs="EPSG:4326")


def is_color(pixel, color, off=2):
    return all(abs(int(a) - b) <= off for a, b in zip(pixel, color))


# ---- Geometries ----


def test_geometries_all_at_once_are_those_one_by_one():
    shapely = pytest.importorskip("shapely")
    if not hasattr(shapely, "get_parts"):
        pytest.skip("Shapely 1 has no calls for all geometries at once")
    from shapely import geometry as g
    ring = [(0, 0), (4, 0), (4, 4)]
    some = [g.LineString([(0, 0), (1, 1)]), None, g.MultiLineString([[(0, 0), (1, 2)], [(3, 3), (4, 4), (5, 5)]]),
            g.Polygon(ring, [[(1, 1), (2, 1), (2, 2)]]), g.LineString(), g.Point(1, 2), g.LinearRing(ring), g.Polygon(),
            g.GeometryCollection([g.Point(3, 3), g.GeometryCollection([g.Polygon(ring), g.LineString([(7, 7), (8, 8)])])]),
            g.MultiPolygon([g.Polygon(ring), g.Polygon([(5, 5), (6, 5), (6, 6)])]), g.MultiPoint([(1, 1), (2, 2)]),
            g.LineString([(0, 0, 5), (1, 1, 6)]), g.Point()]
    random = numpy.random.default_rng(1)
    for dots in False, True:
        for _ in range(50):
            chosen = [some[i] for i in random.integers(0, len(some), random.integers(0, 12))]
            ours, theirs = from_geometries(chosen, dots), from_each(chosen, dots)
            assert ours.origin_count == theirs.origin_count
            for a, b in zip((ours.points, ours.offsets, ours.origins), (theirs.points, theirs.offsets, theirs.origins)):
                assert numpy.array_equal(a, b)


class Fresh:
    """Geometries that are made whenever they are asked for, and that nobody else keeps."""

    def __init__(self, pieces):
        self.pieces = pieces

    def __len__(self):
        return len(self.pieces)

    def __iter__(self):
        from shapely import wkb
        return map(wkb.loads, self.pieces)


def test_linestrings_by_functions_of_geos():
    shapely = pytest.importorskip("shapely")
    if hasattr(shapely, "get_parts"):
        pytest.skip("for Shapely 1")
    from shapely.geometry import LineString, MultiLineString, Polygon
    lines = [LineString(line) for line in LINES]
    for geometries in lines, [*lines, lines[0]]:
        ours, theirs = from_linestrings(geometries), from_each(geometries, False)
        assert (ours.points == theirs.points).all() and (ours.offsets == theirs.offsets).all()
        assert (ours.origins == theirs.origins).all() and ours.origin_count == theirs.origin_count
    of_each = from_linestrings([LineString([(0, 0, 1), (1, 2, 1)]), LineString(), LineString([(3, 4), (5, 6)]), LineString()])
    assert of_each.points.tolist() == [[0, 0], [1, 2], [3, 4], [5, 6]] and of_each.offsets.tolist() == [0, 2, 2, 4, 4]
    made_anew = Fresh([line.wkb for line in lines] * 500)
    ours, theirs = from_linestrings(made_anew), from_each(made_anew, False)
    assert (ours.points == theirs.points).all() and (ours.offsets == theirs.offsets).all()
    for other in MultiLineString([LINES[0]]), Polygon([(0, 0), (1, 0), (1, 1)]), None:
        assert from_linestrings([*lines, other]) is None
        assert len(from_geometries([*lines, other])) >= 3


# ---- Plots ----


def test_a_line_has_the_color_of_its_value(frame):
    plotted = camber.plot(frame[:1].assign(speed=20.0), column="speed", cmap=["#f00", "#00f"], vmin=20, vmax=30,
                          legend=False, width=9, size=(200, 100))
    assert plotted.picture.shape == (100, 200, 4)
    center = plotted.picture[50, 100]
    assert is_color(center, (255, 0, 0, 255)), center


def test_north_is_up_and_everything_is_in_the_picture(frame):
    plotted = camber.plot(frame.geometry[:1], width=4, size=400)  # from the south-west to the north-east
    dark = plotted.picture[..., 0] < 128
    rows, columns = numpy.nonzero(dark)
    assert max(dark.shape) == 400 and rows.min() < 20 and columns.max() > dark.shape[1] - 20
    assert columns[rows.argmin()] > columns[rows.argmax()]
    west, south, east, north = plotted.bounds
    assert west < 10 * 111319.49 < east and south < north and plotted.crs == frame.crs


def test_any_crs_shows_the_same_shape(frame):
    wanted = camber.plot(frame.to_crs(3857), width=3, size=(300, 300)).picture
    assert (numpy.abs(camber.plot(frame, width=3, size=(300, 300)).picture.astype(int) - wanted) <= 2).all()
    utm = camber.plot(frame, crs="EPSG:25832", width=3, size=(300, 300)).picture
    assert (numpy.abs(camber.plot(frame.to_crs(25832), width=3, size=(300, 300)).picture.astype(int) - utm) <= 2).all()
    with pytest.raises(camber.ArgumentError, match="set_crs"):
        camber.plot(LINES, crs="EPSG:3857")


def test_notebooks_show_a_png_and_save_writes_it(frame, tmp_path):
    plotted = camber.plot(frame, column="speed")
    assert plotted._repr_png_() == camber.encode(plotted.picture)
    plotted.save(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == plotted._repr_png_()
    plotted.save(tmp_path / "a.webp")
    assert (tmp_path / "a.webp").read_bytes()[8:12] == b"WEBP"
    with pytest.raises(camber.ArgumentError, match="png or .webp"):
        plotted.save(tmp_path / "a.pdf")
    assert numpy.asarray(plotted) is plotted.picture


def test_the_legend_is_in_the_lower_left_corner(frame):
    for column in "speed", "kind":
        with_legend = camber.plot(frame, column=column, size=(500, 500)).picture
        without = camber.plot(frame, column=column, size=(500, 500), legend=False).picture
        rows, columns = numpy.nonzero((with_legend != without).any(axis=2))
        assert len(rows) > 500 and rows.min() > 350 and columns.max() < 330
    camber.plot(frame, column="speed", size=(30, 20))  # there is little room


def test_values_of_all_kinds(frame):
    pandas = pytest.importorskip("pandas")
    style = {"size": (300, 200), "width": 5, "legend": False}
    wanted = camber.plot(frame, column="speed", **style).picture
    for speed in (frame.speed.astype("Int64"), frame.speed.astype(object), frame.speed.astype("float32")):
        assert (camber.plot(frame.assign(speed=speed), column="speed", **style).picture == wanted).all()
    assert (camber.plot(frame, column=frame.speed, **style).picture == wanted).all()
    assert (camber.plot(frame, column=[10, 20, 30], **style).picture == wanted).all()
    days = pandas.to_datetime(["2026-01-10", "2026-01-20", "2026-01-30"])
    by_day = camber.plot(frame.assign(day=days), column="day", **style).picture
    assert (numpy.abs(by_day.astype(int) - wanted) <= 4).all()  # a shade
    camber.plot(frame.assign(day=days), column="day")
    missing = camber.plot(frame.assign(speed=[10, None, 30]), column="speed", missing="#0f0", **style).picture
    assert (missing == (0, 255, 0, 255)).all(axis=2).any() and not (wanted == (0, 255, 0, 255)).all(axis=2).any()
    kinds = camber.plot(frame, column="kind", cmap={"bus": "red", "rail": "blue"}, missing="#fff", **style).picture
    assert (kinds == (255, 0, 0, 255)).all(axis=2).any() and (kinds == (0, 0, 255, 255)).all(axis=2).any()
    camber.plot(frame.assign(kind=frame.kind.astype("category")), column="kind")
    camber.plot(frame.assign(flag=[True, False, None]), column="flag")


def test_a_bbox_shows_a_part(frame):
    part = camber.plot(frame, bbox=(10.0, 50.0, 10.1, 50.05), width=[3, 3, 3], size=(200, 200))
    assert part.bounds[2] < 10.12 * 111319.49 and (part.picture[..., 0] < 128).any()
    colored = camber.plot(frame, column="speed", bbox=(10.0, 50.0, 10.1, 50.05), size=(200, 200), width=[1, 9, 2])
    assert (colored.picture[..., :3] != 255).any()


def test_points_are_dots():
    geopandas = pytest.importorskip("geopandas")
    dots = geopandas.GeoSeries(geopandas.points_from_xy([10, 11, 12], [50, 51, 50]), crs="EPSG:4326")
    picture = camber.plot(dots, width=10, size=(200, 200)).picture
    assert 3 * 70 < (picture[..., 0] < 128).sum() < 3 * 90


@pytest.mark.parametrize("guess, told", [
    (lambda frame: camber.plot(frame, color="speed"), "give column='speed'"),
    (lambda frame: camber.draw(frame, color="speed"), "camber.plot(data, column='speed')"),
    (lambda frame: camber.draw(frame, column="speed"), "camber.plot(data, column=...)"),
    (lambda frame: camber.draw(frame, linewidth=2), "give width="),
    (lambda frame: camber.draw(frame, colour="red"), "give color="),
    (lambda frame: camber.plot(frame, column="sped"), "is it 'speed'?"),
    (lambda frame: camber.plot(frame, column="geometry"), "LineString; give numbers"),
    (lambda frame: camber.plot(frame.geometry, column="speed"), "no table"),
    (lambda frame: camber.plot(frame, column=[1, 2]), "for each of the 3 lines"),
    (lambda frame: camber.plot(frame, column="speed", color="red"), "give one of them"),
    (lambda frame: camber.plot(frame, column="speed", cmap="viridi"), "is it viridis"),
    (lambda frame: camber.plot(frame, cmap="viridis"), "give column= too"),
    (lambda frame: camber.plot(frame, column="kind", vmin=3), "for numbers"),
    (lambda frame: camber.plot(frame, column="speed", vmin=3, vmax=1), "vmin"),
    (lambda frame: camber.plot(frame, width="speed"), "data['speed']"),
    (lambda frame: camber.plot(frame, color="rouge"), "give a name like"),
    (lambda frame: camber.Map(frame.to_numpy()), "give a file, or a GeoDataFrame"),
    (lambda frame: camber.Map(frame, column="speed"), "camber.plot(data, column=...)"),
    (lambda frame: camber.Map(frame).draw(cmap="hot"), "camber.plot(data, cmap=...)"),
    (lambda frame: camber.Map(frame, label=True), "is it labels=?"),
    (lambda frame: camber.Map(frame, style=7), "the name of a built-in style: city"),
    (lambda frame: camber.Map(frame).draw(bbox=(1, 2, 3)), "west, south, east, north"),
    (lambda frame: camber.Map(frame).draw(center="1,2", zoom=3), "longitude, latitude"),
    (lambda frame: camber.Map(frame.assign(geometry=None)), "none of the data's"),
    (lambda frame: camber.plot(frame, column="speed", vmin="low"), "give numbers"),
    (lambda frame: camber.plot("roads.geojson"), "camber.Map(file) draws a file"),
    (lambda frame: camber.plot(None), "give a GeoDataFrame"),
    (lambda frame: camber.plot({"x": [1]}), "camber.tracks(table, x, y, by)"),
    (lambda frame: camber.density(frame.drop(columns="geometry")), "the table has no geometry"),
    (lambda frame: camber.tracks(frame, "kind", "kind"), "has no numbers"),
    (lambda frame: camber.draw(LINES, color=None), "color is None"),
    (lambda frame: camber.Network(LINES, column="speed"), "camber.plot(data, column=...)"),
    (lambda frame: camber.Network(LINES, width=3), "an argument of draw()"),
    (lambda frame: camber.Network(LINES).draw(simplify=1), "camber.importance"),
    (lambda frame: camber.density(frame).shade(how="eqhist"), "eq_hist"),
    (lambda frame: camber.density(frame, weights="kind"), "give numbers"),
])
def test_guesses(frame, guess, told):
    with pytest.raises((camber.ArgumentError, TypeError), match=re.escape(told)):
        guess(frame)


def test_an_empty_picture_is_told(frame):
    with pytest.warns(UserWarning, match="all lines are in .* px; camber.plot"):
        camber.draw(frame)
    with pytest.warns(UserWarning, match="the picture is empty: the lines are at .* camber.plot"):
        camber.draw(frame.to_crs(3857))
    with pytest.warns(UserWarning, match="the picture is empty: the bbox"):
        camber.plot(frame, bbox=(0, 0, 1, 1))
    with pytest.warns(UserWarning, match="0 rows"):
        camber.plot(frame[:0])
    with pytest.warns(UserWarning, match="the picture is empty: it shows"):
        camber.Network(LINES).draw(center=(0, 0), scale=100)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        camber.plot(frame)
        camber.plot(frame, bbox=(10, 50, 10.1, 50.1))
        camber.draw([[[5, 5], [60, 60]]])
        camber.Network(LINES).draw()


def test_one_color_for_all_rows():
    one = camber.Network(LINES, rows=range(3)).draw(size=(90, 90), width=3, color="red")
    assert (one == camber.Network(LINES).draw(size=(90, 90), width=3, color="#f00")).all() and one.any()
    flat = [line * 100 - (990, 4990) for line in LINES]
    assert (camber.draw(flat, rows=[5, 0, 5], color="navy", width=2, size=(40, 40))
            == camber.draw(flat, color="#000080", width=2, size=(40, 40))).all()


# ---- Importance ----


def test_importance_simplifies():
    line = numpy.array([[0.0, 0], [2, 1], [5, 3], [7, 3], [10, 0]])
    importance = camber.importance(line)
    assert importance.dtype == numpy.float32 and numpy.isinf(importance[[0, -1]]).all() and importance[2] == 3
    style = {"center": (5, 1.5), "scale": 8, "size": (100, 50), "width": 2}
    network = camber.Network(line, importance=importance)
    assert (network.draw(simplify=2 * 8, **style) == camber.Network(line[[0, 2, 4]]).draw(**style)).all()
    assert (network.draw(**style) == camber.Network(line).draw(**style)).all()
    assert len(camber.importance(numpy.zeros((0, 2)))) == 0


# ---- Density ----


def walks(count, seed=3):
    random = numpy.random.default_rng(seed)
    return [numpy.cumsum(random.normal(0, 5, (30, 2)), axis=0) + random.uniform(20, 180, 2) for _ in range(count)]


def test_a_density_is_the_sum_of_single_pictures():
    lines, box = walks(60), (0, 0, 200, 200)
    counts = camber.density(lines, bbox=box, size=(200, 200), width=2).counts
    assert counts.dtype == numpy.float32 and counts.shape == (200, 200)
    single = [camber.density([line], bbox=box, size=(200, 200), width=2).counts for line in lines]
    total = numpy.sum(single, axis=0, dtype=numpy.float64)
    assert total.max() > 4 and (numpy.abs(counts - total) <= 1e-4 * numpy.maximum(total, 1)).all()
    for line, one in list(zip(lines, single))[::10]:
        drawn = camber.draw(line * (1, -1) + (0, 200), width=2, color="#000", size=(200, 200), cap="round")
        assert (numpy.abs(one - drawn[..., 3] / 255) < 0.6 / 255).all()


def test_what_a_density_counts():
    line = numpy.array([[0.0, 5.5], [20, 5.5]])
    style = {"bbox": (0, 0, 20, 11), "size": (20, 11), "width": 1, "cap": "butt"}
    assert camber.density([line] * 1000, **style).counts[5, 10] == pytest.approx(1000, rel=1e-4)
    back_and_forth = numpy.concatenate([line, line[::-1]] * 20)
    assert camber.density([back_and_forth], **style).counts[5, 10] == pytest.approx(1, rel=1e-3)
    weighted = camber.density([line] * 3, weights=[0.25, 2, 300], **style).counts
    assert weighted[5, 10] == pytest.approx(302.25, rel=1e-5)
    above = camber.density([line + (0, 0.25)], **style).counts[:, 10]
    assert above[4:7] == pytest.approx([0.25, 0.75, 0], abs=1e-5)
    with pytest.warns(UserWarning, match="empty"):
        assert not camber.density([], **{**style, "bbox": None}).counts.any()


def test_shades():
    counts = camber.density(walks(200), size=(300, 200), width=2)
    shaded = counts.shade(["#000", "#fff"], background="#f00").picture
    empty = counts.counts == 0
    assert (shaded[empty] == (255, 0, 0, 255)).all()
    grays = numpy.sort(shaded[~empty][:, 0].astype(int))
    quarters = grays[[len(grays) // 4, len(grays) // 2, 3 * len(grays) // 4]]
    assert numpy.abs(quarters - (64, 128, 191)).max() < 12  # each shade has as many pixels
    for how in "log", "linear", "cbrt":
        order = numpy.argsort(counts.counts[~empty])
        shades = counts.shade(["#000", "#fff"], how).picture[~empty][order, 0].astype(int)
        assert (numpy.diff(shades) >= 0).all() and shades[-1] == 255
    assert counts._repr_png_()[:4] == b"\x89PNG"
    flat = camber.density([LINES[0]], size=(50, 50)).shade(span=(0, 5), how="linear")
    assert flat.picture.shape == (50, 50, 4)


# ---- A notebook ----


def test_a_notebook_shows_pictures(tmp_path):
    for module in "nbconvert", "nbformat", "ipykernel", "geopandas":
        pytest.importorskip(module)
    import base64
    import json
    source = ["import geopandas, camber\n", "from shapely.geometry import LineString\n",
              "lines = geopandas.GeoDataFrame({'speed': [1, 2]}, crs=4326, geometry=[LineString([(1, 1), (2, 2)]),\n",
              "                                                                    LineString([(1, 2), (2, 1)])])\n",
              "camber.plot(lines, column='speed', size=(120, 100))"]
    cells = [{"cell_type": "code", "metadata": {}, "execution_count": None, "outputs": [], "source": each}
             for each in (source, ["camber.density(lines, size=(60, 50))"], ["camber.Map(lines)"])]
    notebook = tmp_path / "a.ipynb"
    notebook.write_text(json.dumps({"cells": cells, "metadata": {"kernelspec": {
        "name": "python3", "display_name": "Python", "language": "python"}}, "nbformat": 4, "nbformat_minor": 2}))
    subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output", "b.ipynb", notebook],
                   check=True, cwd=tmp_path, capture_output=True, env={**os.environ, "HOME": str(tmp_path)})
    pictures = [base64.b64decode(output["data"]["image/png"]) for cell in json.loads((tmp_path / "b.ipynb").read_text())["cells"]
                for output in cell["outputs"] if "data" in output]
    sizes = [(int.from_bytes(picture[16:20], "big"), int.from_bytes(picture[20:24], "big")) for picture in pictures]
    assert sizes == [(120, 100), (60, 50), (1024, 1024)]


# ---- Maps ----


def test_a_map_of_a_table(frame, tmp_path):
    frame = frame.assign(highway=["primary", "motorway", "primary"])
    shown = camber.Map(frame, style="roads")
    picture = shown.draw(size=(300, 200))
    assert len({tuple(pixel) for pixel in picture.reshape(-1, 4)}) > 20
    assert shown.bounds == pytest.approx((10, 50, 10.2, 50.1))
    assert (camber.Map(frame.to_crs(25832), style="roads").draw(size=(300, 200)) != picture).mean() < 0.05
    assert shown._repr_png_()[:4] == b"\x89PNG"
    with pytest.raises(camber.ArgumentError, match="set_crs"):
        frame.crs = None
        camber.Map(frame)
    with pytest.warns(UserWarning, match="the picture is empty: .*bbox="):
        shown.draw(center=(0, 0), zoom=12)


def test_a_map_of_a_table_names_no_file(frame, caplog):
    with pytest.raises(camber.ArgumentError, match="^the data: the filter .*layer \"data\": "):
        camber.Map(frame, where="none = 1").draw()
    with pytest.raises(camber.InputError, match="^the data: no layer \"none\"; choose one of: data$"):
        camber.Map(frame, layer="none").draw()
    with caplog.at_level("INFO", "camber"):
        camber.Map(frame.assign(geometry=[None, *frame.geometry[1:]]), style="roads").draw()
    assert "the data: left out" in caplog.text and tempfile.gettempdir() not in caplog.text


def test_a_map_on_paper(city, tmp_path):
    if not camber._lib.camber_page_is_built():
        pytest.skip("this build has no Cairo")
    shown = camber.Map(city)
    shown.save(tmp_path / "a.pdf", paper="A5", title="Santa Cruz", scale_bar=True)
    pdf = (tmp_path / "a.pdf").read_bytes()
    assert pdf[:5] == b"%PDF-" and os.listdir(tmp_path) == ["a.pdf"]
    shown.save(tmp_path / "a.svg", size=(400, 300))
    assert re.search(r'width="300(\.0*)?pt"', (tmp_path / "a.svg").read_text()[:600])
    shown.save(tmp_path / "a.png", paper=(80, 60), dpi=100, margin=0)
    rows = png_rows.decode((tmp_path / "a.png").read_bytes())
    assert (len(rows), len(rows[0]) // 4 if isinstance(rows[0], (bytes, bytearray)) else 315) == (236, 315)
    shown.save(tmp_path / "b.png", size=(90, 60))
    with pytest.raises(camber.ArgumentError, match="saved as .png"):
        shown.save(tmp_path / "a.jpg")
    with pytest.raises(camber.ArgumentError, match="needs a sheet"):
        shown.save(tmp_path / "c.png", title="Santa Cruz")
    with pytest.raises(camber.ArgumentError, match="A0 to A6"):
        shown.save(tmp_path / "c.pdf", paper="A9")
    with pytest.raises(camber.FileError, match="nowhere"):
        shown.save(tmp_path / "nowhere" / "c.pdf")
    with pytest.raises(TypeError, match="there is no argument 'zom'"):
        shown.save(tmp_path / "c.pdf", zom=3)


# ---- Values that are missing, extreme or of unusual types ----


def test_dates_in_columns(frame):
    pandas = pytest.importorskip("pandas")
    days = pandas.Series(pandas.date_range("2026-01-01", periods=3))
    style = {"column": "day", "width": 3, "size": (90, 90), "legend": False}
    wanted = camber.plot(frame.assign(day=days), **style).picture
    for same in days.dt.tz_localize("UTC"), days.dt.date:
        assert (camber.plot(frame.assign(day=same), **style).picture == wanted).all()
    limits = {"vmin": "2026-01-01", "vmax": pandas.Timestamp("2026-01-03")}
    assert (camber.plot(frame.assign(day=days), **limits, **style).picture == wanted).all()
    with pytest.raises(ValueError, match="give a date"):
        camber.plot(frame.assign(day=days), vmin="soon", **style)


@pytest.mark.parametrize("arguments,told", [
    ({"column": [-1.7e308, 0, 1.7e308]}, "too far; give vmin and vmax"), ({"column": "speed", "vmax": numpy.inf}, "too far"),
    ({"bbox": (10.2, 50, 10, 50.1)}, "west at most east"), ({"bbox": 5}, "four numbers"), ({"size": -5}, "1 to 65535"),
    ({"column": "kind", "cmap": []}, "empty list"), ({"bbox": (10, 50, 10.1, 50.1), "texts": [camber.Text(1, 1, "x")]},
                                                     "without a bbox")])
def test_extreme_arguments(frame, arguments, told):
    with pytest.raises(ValueError, match=told):
        camber.plot(frame, **arguments)


def test_extreme_values(frame):
    camber.plot(frame, column=[0, 5e-324, 0])
    with pytest.raises(ValueError, match="too far for its scale"):
        camber.plot(numpy.array([[0, 0], [1e308, -1e308], [-1e308, 3]]))
    twice = frame.copy()
    twice.insert(0, "speed", frame.speed, allow_duplicates=True)
    with pytest.raises(ValueError, match="several columns have the name 'speed'"):
        camber.plot(twice, column="speed")
    with pytest.raises(ValueError, match="there is no column '5'"):
        camber.plot(frame.rename(columns={"speed": 5}), column="5")


def test_categories_of_booleans_have_colors(frame):
    style = {"width": 9, "size": (60, 60), "legend": False}
    wanted = camber.plot(frame, color="red", **style).picture
    assert (camber.plot(frame.assign(flag=True), column="flag", cmap={True: "red"}, **style).picture == wanted).all()


def test_dashes_in_a_bbox(frame):
    box = {"bbox": (10.0, 50.0, 10.2, 50.1), "size": (90, 90)}
    for count in lambda **style: (camber.plot(frame, **style).picture[..., 0] < 128).sum(), \
            lambda **style: camber.density(frame, **style).counts.sum():
        assert 0 < count(dash=[4, 4], **box) < 0.8 * count(**box)


def test_weights_that_are_missing_or_infinite(frame):
    some = camber.density(frame.assign(speed=[1, None, 3]), weights="speed", size=(60, 60)).counts
    assert (some == camber.density(frame.assign(speed=[1, 0, 3]), weights="speed", size=(60, 60)).counts).all()
    for far in numpy.inf, -1e300:
        with pytest.raises(ValueError, match="too far for 32 bits"):
            camber.density(frame.assign(speed=[1, far, 3]), weights="speed")
    with pytest.raises(ValueError, match="shade"):
        camber.density(frame, color="red")
    with pytest.raises(ValueError, match="two numbers"):
        camber.density(frame, size=20).shade(how="log", span=5)


def test_copies_are_copies(frame):
    for made, own in ((camber.plot(frame, size=9), "picture"), (camber.density(frame, size=9), "counts")):
        assert not numpy.shares_memory(made.__array__(copy=True), getattr(made, own))
        assert numpy.shares_memory(made.__array__(), getattr(made, own))
        with pytest.raises(ValueError, match="without a copy"):
            made.__array__(numpy.float64, copy=False)


def test_tracks_of_missing_values():
    pandas = pytest.importorskip("pandas")
    for keys in (pandas.array([1, None, 2, 1], dtype="Int64"), [1, numpy.nan, 2, 1], ["a", None, "b", "a"]):
        table = pandas.DataFrame({"x": pandas.array([1, 2, None, 4], dtype="Float64"), "y": [1.0, 2, 3, 4], "id": keys})
        points, offsets = camber.tracks(table, by="id")
        assert numpy.array_equal(points, [[1, 1], [4, 4], [numpy.nan, 3]], equal_nan=True) and offsets.tolist() == [0, 2, 3]
    assert len(camber.tracks(table[1:2], by="id")[0]) == 0


def test_a_map_gets_values_of_their_types(frame):
    import io
    import json
    import pandas
    from camber._map import write_frame
    written = io.StringIO()
    mixed = frame.assign(n=pandas.array([1, None, 3], dtype="Int64"), flag=[True, False, None], speed=[1.5, numpy.inf, 2],
                         day=pandas.to_datetime(["2026-01-01", None, None]), bits=[numpy.zeros(2)] * 3)
    mixed.insert(0, "kind", "none", allow_duplicates=True)
    write_frame(mixed, written)
    first, second, _ = [each["properties"] for each in json.loads(written.getvalue())["features"]]
    assert first == {"n": 1, "flag": True, "speed": 1.5, "day": "2026-01-01 00:00:00", "bits": "[0. 0.]", "kind": "bus"}
    assert [second[name] for name in ("n", "flag", "speed", "day", "kind")] == [None, False, None, None, None]
