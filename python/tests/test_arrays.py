"""Arrays as input and output: pictures equal those of the tool, and invalid arrays raise errors."""

import struct
import subprocess

import numpy
import pytest

import camber
import png_rows

POINTS = numpy.array([[5, 5], [60, 9], [30, 50], [8, 40], [50, 60], [50, 8]], numpy.float32)
OFFSETS = numpy.array([0, 3, 6], numpy.uint32)


def read_png(data):
    rows = png_rows.decode(data)
    return numpy.frombuffer(b"".join(map(bytes, rows)), numpy.uint8).reshape(len(rows), -1, 4)


def test_draws_the_tools_picture(tool, tmp_path):
    lines, out = tmp_path / "lines", tmp_path / "out.png"
    lines.write_bytes(struct.pack("<III", 0x4C594C50, 2, 6) + OFFSETS.tobytes() + POINTS.tobytes())
    subprocess.run([tool, "bench", "--polylines", lines, "--width-px", "7", "--size", "70x66", "--runs", "1", "-o", out],
                   check=True, capture_output=True)
    picture = camber.draw(POINTS, OFFSETS, width=7, color="#000", background="#fff", size=(70, 66), keep_open=True)
    assert picture.shape == (66, 70, 4) and picture.dtype == numpy.uint8
    assert (picture == read_png(out.read_bytes())).all()


def test_renders_the_tools_picture(tool, city, tmp_path):
    out = tmp_path / "out.png"
    subprocess.run([tool, "render", city, "--size", "300x200", "-o", out], check=True, capture_output=True)
    assert (camber.render(city, size=(300, 200)) == read_png(out.read_bytes())).all()


def test_alpha():
    style = {"width": 7, "color": (1, 0, 0, 0.5), "size": (70, 66)}
    straight, premultiplied = camber.draw(POINTS, OFFSETS, **style), camber.draw(POINTS, OFFSETS, premultiplied=True,
                                                                                 **style)
    assert (straight[..., 3] == premultiplied[..., 3]).all() and straight[..., 3].max() == 128
    assert set(numpy.unique(straight[straight[..., 3] > 0][:, 0])) == {255}
    assert (premultiplied[..., 0] == premultiplied[..., 3]).all()
    # The encoder treats straight and premultiplied values alike, and a PNG keeps them.
    assert camber.encode(straight) == camber.encode(premultiplied, premultiplied=True)
    assert (read_png(camber.encode(straight)) == straight).all()


def test_same_lines_in_other_forms():
    wanted = camber.draw(POINTS, OFFSETS, size=(70, 66))
    forms = [(POINTS.astype("f8"), OFFSETS), (POINTS.astype(">f4"), OFFSETS.astype(">i8")), (POINTS.tolist(), [0, 3, 6]),
             (numpy.asfortranarray(POINTS), OFFSETS), (numpy.repeat(POINTS, 2, axis=0)[::2], OFFSETS),
             (POINTS.astype(numpy.int16), OFFSETS.astype(numpy.int8)), ([POINTS[:3], POINTS[3:].tolist()], None),
             (numpy.repeat(POINTS, 2, axis=1)[:, ::2], numpy.repeat(OFFSETS, 3)[::3]), (POINTS[::-1][::-1], OFFSETS)]
    read_only = POINTS.copy()
    read_only.flags.writeable = False
    for points, offsets in forms + [(read_only, OFFSETS)]:
        assert (camber.draw(points, offsets, size=(70, 66)) == wanted).all()
    one = camber.draw(POINTS[:3], size=(70, 66))
    assert (camber.draw(POINTS[:3].tolist(), size=(70, 66)) == one).all()
    assert (camber.draw(POINTS, [0, 3, 3, 6], size=(70, 66)) == wanted).all()


def test_nothing_is_drawn_of_nothing():
    for points, offsets in ([], None), ([], [0]), (numpy.zeros((0, 2)), [0, 0, 0]), ([[]], None), (POINTS[:0], None):
        assert not camber.draw(points, offsets, size=(9, 9)).any()
        assert not camber.Network(points, offsets).draw(size=(9, 9)).any()
        assert len(camber.tessellate(points, offsets).records) == 0
    assert not camber.draw([], [0], width=[], color=[], size=(9, 9)).any()


def test_points_that_are_no_numbers_split_a_line():
    points = numpy.array([[5, 5], [20, 5], [numpy.nan, 5], [40, 5], [60, 5], [numpy.inf, 0], [1e300, 1e300]])
    picture = camber.draw(points, size=(70, 10), width=2)
    assert picture[5, 10, 3] and picture[5, 50, 3] and not picture[5, 30, 3]
    assert camber.Network(points).bounds == (5, 5, 1e300, 1e300)
    assert not camber.draw(numpy.full((4, 2), numpy.nan), size=(9, 9)).any()


@pytest.mark.parametrize("points, offsets, error", [
    (POINTS.astype(complex), OFFSETS, TypeError),
    (numpy.array([["a", "b"]]), [0, 1], TypeError),
    (numpy.array([[None, 1]], object), [0, 1], TypeError),
    (POINTS > 7, OFFSETS, TypeError),
    (POINTS.ravel(), OFFSETS, ValueError),
    (POINTS.reshape(2, 3, 2), OFFSETS, ValueError),
    (numpy.zeros((6, 3)), OFFSETS, ValueError),
    (POINTS, [0, 3, 7], ValueError),
    (POINTS, [0, 3, 5], ValueError),
    (POINTS, [1, 3, 6], ValueError),
    (POINTS, [0, 5, 3, 6], ValueError),
    (POINTS, [0, -3, 6], ValueError),
    (POINTS, [0, 2**40, 6], ValueError),
    (POINTS, numpy.array([0, 2**63, 6], numpy.uint64), ValueError),
    (POINTS, [0.0, 3.0, 6.0], TypeError),
    (POINTS, [], ValueError),
    (POINTS, [[0, 3, 6]], ValueError),
    (POINTS, "036", TypeError),
    (POINTS, 6, ValueError),
    (7, None, ValueError),
    ("line", None, TypeError),
    (object(), None, TypeError),
])
def test_wrong_lines(points, offsets, error):
    for draw in camber.draw, camber.tessellate, camber.Network:
        with pytest.raises(error):
            draw(points, offsets)


@pytest.mark.parametrize("wrong", [
    {"width": -1}, {"width": float("nan")}, {"width": "8"}, {"width": [1, 2, 3]}, {"width": 1e9}, {"width": [[1, 2]]},
    {"color": "rouge"}, {"color": "#12"}, {"color": "#ggg"}, {"color": (1, 2, 3)}, {"color": 7}, {"color": ["#fff"]},
    {"color": numpy.zeros((2, 5))}, {"color": ["#fff"] * 3}, {"color": []}, {"color": None},
    {"rows": [0]}, {"rows": [-1, 0]}, {"rows": [0.5, 1]}, {"rows": [0, 2**24], "width": [1, 2]},
    {"size": (0, 5)}, {"size": (5,)}, {"size": (5.5, 5)}, {"size": (70000, 5)}, {"size": None},
    {"join": "sharp"}, {"cap": 3}, {"overlap": []}, {"opacity": 0}, {"opacity": float("nan")}, {"miter_limit": -1},
    {"dash": []}, {"dash": [0, 0]}, {"dash": [-1, 2]}, {"dash": [1] * 500}, {"offset": float("inf")}, {"blur": float("nan")},
    {"pitch": 86}, {"out": numpy.zeros((5, 5, 4), numpy.uint8)}, {"out": numpy.zeros((1024, 1024, 4), numpy.int8)},
    {"out": numpy.zeros((1024, 1024, 8), numpy.uint8)[..., ::2]}, {"out": numpy.zeros((1024, 1024, 4), numpy.uint8)[::-1]},
    {"out": numpy.broadcast_to(numpy.uint8(0), (1024, 1024, 4))}, {"out": []},
])
def test_wrong_styles(wrong):
    with pytest.raises((ValueError, TypeError, camber.Error)) as told:
        camber.draw(POINTS, OFFSETS, **wrong)
    assert str(told.value)


def test_an_array_to_draw_into():
    whole = numpy.full((80, 90, 4), 7, numpy.uint8)
    part = whole[3:69, 5:75]
    assert camber.draw(POINTS, OFFSETS, size=(70, 66), out=part) is part
    assert (part == camber.draw(POINTS, OFFSETS, size=(70, 66))).all()
    whole[3:69, 5:75] = 7
    assert (whole == 7).all()
    part.flags.writeable = False
    with pytest.raises(camber.ArgumentError, match="read-only"):
        camber.draw(POINTS, OFFSETS, size=(70, 66), out=part)


def test_a_style_for_each_line():
    lines = [[[5, 10], [60, 10]], [[5, 30], [60, 30]], [[5, 50], [60, 50]]]
    picture = camber.draw(lines, width=[2, 4, 8], color=["#f00", "#0f0", "#00f"], size=(70, 60))
    assert (picture[10, 30] == (255, 0, 0, 255)).all() and (picture[30, 30] == (0, 255, 0, 255)).all()
    assert [int((picture[y - 9:y + 9, 30, 3] > 0).sum()) for y in (10, 30, 50)] == [2, 4, 8]
    for color in numpy.eye(3), numpy.eye(3, dtype=numpy.float32), numpy.eye(3, 4) + (0, 0, 0, 1), \
            (numpy.eye(3) * 255).astype(numpy.uint8):
        assert (camber.draw(lines, width=[2, 4, 8], color=color, size=(70, 60)) == picture).all()
    assert (camber.draw(lines, width=[8, 4, 2], color=["#00f", "#0f0", "#f00"], rows=[2, 1, 0], size=(70, 60))
            == picture).all()
    dashed = camber.draw(lines, width=2, dash=[4, 4], size=(70, 60))
    assert dashed[10, 7, 3] and not dashed[10, 11, 3] and dashed[10, 15, 3]


def test_meshes():
    strip = camber.tessellate(POINTS, OFFSETS)
    assert strip.strips and len(strip.indices) == 2 * len(strip.records) >= len(strip.vertices)
    kite = camber.tessellate(POINTS, OFFSETS, method="kite")
    assert not kite.strips and len(kite.indices) % 3 == 0 and kite.indices.max() < len(kite.vertices)
    assert {(x, y) for x, y in kite.records[["x", "y"]].tolist()} >= {tuple(point) for point in POINTS.tolist()}
    again = camber.tessellate(POINTS, OFFSETS, method="kite")
    assert (again.records == kite.records).all() and not numpy.shares_memory(again.records, kite.records)
    records = camber.tessellate(POINTS, OFFSETS).records  # the rest of its mesh is freed
    assert records.base is not None and (records == strip.records).all()


def test_networks():
    network = camber.Network(POINTS.astype("f8"), OFFSETS, rows=[1, 0])
    assert network.bounds == (5, 5, 60, 60)
    style = {"width": [3, 6], "color": ["#f00", "#00f"], "size": (70, 66)}
    still = network.draw(center=(35, 33), scale=1, **style)
    fixed = camber.draw(POINTS, OFFSETS, rows=[1, 0], **style)
    assert numpy.abs(still.astype(int) - fixed).max() <= 1
    assert (network.draw(center=(35, 33), scale=1, bearing=360, **style) == still).all()
    assert (network.draw(center=(35, 33), scale=1, pitch=50, **style) != still).any()
    assert not network.draw(center=(9000, 0), scale=1, **style).any()
    assert network.draw(**style).any()
    for wrong in {"scale": 0}, {"scale": float("nan")}, {"pitch": 90}, {"simplify": -1}, {"center": (float("inf"), 0)}, \
            {"dash": [1, 2]}, {"scale": 1e300}:
        with pytest.raises(ValueError):
            network.draw(**{**style, **wrong})
    with pytest.raises(ValueError):
        camber.Network(POINTS, OFFSETS, importance=[1, 2])
    for wrong in {"width": [3, 6]}, {"color": ["#f00", "#00f"]}:  # it is undefined which line gets which value
        with pytest.raises(ValueError, match="made without rows"):
            camber.Network(POINTS, OFFSETS).draw(**wrong)
    few = camber.Network(POINTS, OFFSETS, importance=[0, 0, 0, 0, 0, 0]).draw(width=2, simplify=1, size=(70, 66))
    assert (few != camber.Network(POINTS, OFFSETS).draw(width=2, size=(70, 66))).any()


def test_encodings():
    picture = camber.draw(POINTS, OFFSETS, size=(70, 66))
    assert camber.encode(picture, "webp", quality=100)[:4] == b"RIFF"
    assert camber.encode(picture[::2, ::-1], "png8")[:4] == b"\x89PNG"
    for wrong in picture[:0], picture[..., :3], picture.astype(float), None, picture[0]:
        with pytest.raises(ValueError):
            camber.encode(wrong)
    with pytest.raises(ValueError, match="choose one of: png, png8, webp"):
        camber.encode(picture, "gif")
    with pytest.raises(ValueError):
        camber.encode(picture, "webp", quality=101)
