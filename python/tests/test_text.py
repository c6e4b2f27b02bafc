"""Texts: fonts, shaping and outlines beside Pillow's, texts in pictures, and arguments that are wrong."""

import math
import os
import re

import numpy
import pytest

import camber
from conftest import TREE

SIZE = {"size": (240, 80), "background": "#fff"}
FONT = os.path.join(TREE, "src/text/fonts/regular.ttf")


def dark(picture):
    """How much of each pixel is covered by black on white."""
    return 1 - picture[..., :3].astype(float).mean(axis=2) / 255


def box_of(picture):
    rows, columns = numpy.nonzero(dark(picture) > 0.02)
    return columns.min(), rows.min(), columns.max() + 1, rows.max() + 1


# ---- Fonts and shaping ----


def test_fonts():
    found = camber.text.fonts()
    shipped = [font for font in found if font["path"] is None]
    assert [font["name"] for font in shipped] == ["Noto Sans", "Noto Sans Bold", "Noto Sans Italic"]
    assert [font["weight"] for font in shipped] == [400, 700, 400] and shipped[2]["italic"]
    assert all(font["name"] for font in found)


def test_fonts_of_a_folder():
    found = camber.text.fonts([os.path.dirname(FONT)])
    assert found[0]["path"].startswith(os.path.dirname(FONT)) and found[0]["name"].startswith("Noto Sans")
    with pytest.raises(FileNotFoundError):
        camber.text.fonts(["/nowhere"])
    with pytest.raises(TypeError):
        camber.text.fonts("/nowhere")


def test_shape():
    shaped = camber.text.shape("Straße", size=20)
    assert len(shaped.glyphs) == 6 and list(shaped.glyphs["character"]) == list(range(6))
    assert shaped.glyphs["glyph"][1] != shaped.glyphs["glyph"][0]
    assert len(shaped.lines) == 1 and shaped.lines["count"][0] == 6
    assert shaped.width == pytest.approx(shaped.glyphs["advance"].sum(), rel=1e-5)
    assert shaped.height == pytest.approx(1.2 * 20, rel=1e-5)
    assert shaped.box[0] == pytest.approx(-shaped.width / 2, abs=1e-4)
    assert shaped.glyphs["x"][0] == pytest.approx(shaped.box[0], abs=1e-4)


def test_shape_beside_pillow():
    font = pytest.importorskip("PIL.ImageFont").truetype(FONT, 1000, layout_engine=0)
    for words in "Straße", "Århus", "Łódź":
        assert camber.text.shape(words, size=1000).width == pytest.approx(font.getlength(words), rel=0.01)


def test_outlines():
    shaped = camber.text.shape("oi", size=100)
    assert len(shaped.offsets) == 5  # the outside and inside of o, the stem and the dot of i
    assert shaped.offsets[0] == 0 and shaped.offsets[-1] == len(shaped.points)
    for first, end in zip(shaped.offsets, shaped.offsets[1:]):
        assert (shaped.points[first] == shaped.points[end - 1]).all()
    x, y = shaped.points.T
    assert shaped.box[0] < x.min() < x.max() < shaped.box[2] and shaped.box[1] < y.min() < y.max() < shaped.box[3]
    picture = camber.draw(shaped.points + 150, shaped.offsets, width=1, color="#000", size=(300, 300))
    assert picture[..., 3].any()


def test_lines_and_clusters():
    shaped = camber.text.shape("e\u0301x\nbc", size=10, align="left", anchor="top-left")
    assert len(shaped.lines) == 2 and list(shaped.lines["count"]) == [2, 2]
    assert list(shaped.glyphs["character"]) == [0, 2, 4, 5]
    assert shaped.glyphs["x"][2] == pytest.approx(0, abs=1e-5)
    broken = camber.text.shape("one two three four", size=10, max_width=50)
    assert len(broken.lines) > 1 and broken.width < 60
    assert camber.text.shape("ab", size=10, letter_spacing=5).width > camber.text.shape("ab", size=10).width + 4


@pytest.mark.parametrize("words", ["", " ", "\ud800", "a\0b", "\u0301" * 50, "\u202e" * 9, "\U0001f600"])
def test_odd_texts(words):
    shaped = camber.text.shape(words)
    assert (shaped.glyphs["character"] < max(len(words), 1)).all()
    assert numpy.isfinite(shaped.points).all()
    camber.draw([], texts=camber.Text(20, 20, words), size=(40, 40))


# ---- Pictures ----


def test_picture_beside_pillow():
    image, drawing, fonts = (pytest.importorskip("PIL." + name) for name in ("Image", "ImageDraw", "ImageFont"))
    font = fonts.truetype(FONT, 40, layout_engine=0)
    other = image.new("RGB", SIZE["size"], "white")
    drawing.Draw(other).text((20, 60), "Straße", "black", font, anchor="ls")
    shaped = camber.text.shape("Straße", size=40, anchor="left")
    text = camber.Text(20, 60 - shaped.glyphs["y"][0], "Straße", size=40, anchor="left")
    ours, theirs = camber.draw([], texts=[text], **SIZE), numpy.asarray(other)
    assert numpy.abs(numpy.subtract(box_of(ours), box_of(theirs))).max() <= 2  # Pillow hints
    assert dark(ours).sum() == pytest.approx(dark(theirs).sum(), rel=0.03)


def test_texts_are_over_lines():
    line = [[0, 40], [240, 40]]
    text = camber.Text(120, 40, "text", color="#000", halo="#f00")
    plain, with_text = camber.draw(line, width=30, **SIZE), camber.draw(line, width=30, texts=text, **SIZE)
    left, top, right, bottom = camber.text.boxes([text])[0]
    inside = numpy.zeros(plain.shape[:2], bool)
    inside[math.floor(top) - 2:math.ceil(bottom) + 2, math.floor(left) - 2:math.ceil(right) + 2] = True
    assert (plain[~inside] == with_text[~inside]).all()
    assert (with_text[inside] == (0, 0, 0, 255)).all(axis=1).any()  # inside of letters
    assert (with_text[inside] == (255, 0, 0, 255)).all(axis=1).any()  # the halo


def test_halos_are_below_all_texts():
    one, two = camber.Text(120, 40, "I", size=60), camber.Text(124, 40, "I", size=60, halo="#fff", halo_width=9)
    both = camber.draw([], texts=[one, two], **SIZE)
    assert (dark(both) >= dark(camber.draw([], texts=one, **SIZE)) - 0.01).all()


def test_angle_and_anchor():
    turned = camber.draw([], texts=camber.Text(120, 40, "lllll", angle=90), **SIZE)
    left, top, right, bottom = box_of(turned)
    assert bottom - top > right - left
    for anchor, is_left in ("left", False), ("right", True):
        left, _, right, _ = camber.text.boxes(camber.Text(100, 40, "word", anchor=anchor))[0]
        assert right < 101 if is_left else left > 99


def test_along_a_line():
    line = numpy.array([[20.0, 60], [120, 20], [220, 60]])
    text = camber.Text.along(line, "along", size=14, max_turn=60)
    left, top, right, bottom = camber.text.boxes(text)[0]
    assert 90 < left < right < 150 and 10 < top < bottom < 50
    backwards = camber.draw([], texts=camber.Text.along(line[::-1], "along", size=14, max_turn=60), **SIZE)
    assert (backwards == camber.draw([], texts=text, **SIZE)).all()
    moved = camber.text.boxes(camber.Text.along(line, "along", size=14, shift=40))[0]
    assert moved[0] > left + 20
    refused = [camber.Text.along(line, "along", size=14, max_turn=5), camber.Text.along(line[:1], "along"),
               camber.Text.along(line, "along " * 30), camber.Text.along(line * numpy.nan, "along")]
    assert numpy.isnan(camber.text.boxes(refused)).all()
    assert (camber.draw([], texts=refused, **SIZE) == 255).all()


def test_the_same_bytes():
    texts = [camber.Text(20 + 25 * (i % 8), 10 + 20 * (i // 8), "T%d" % i, size=9 + i % 5) for i in range(32)]
    pictures = [camber.draw([], texts=texts, context=camber.Context(), **SIZE) for _ in range(2)]
    assert (pictures[0] == pictures[1]).all() and dark(pictures[0]).any()
    assert (camber.draw([], texts=iter(texts), **SIZE) == pictures[0]).all()


def test_memory_limit():
    texts = [camber.Text(20 + 25 * (i % 8), 10 + 20 * (i // 8), "text", size=9) for i in range(32)]
    limited = camber.Context("cpu", draw="cl", memory=1 << 20)
    assert (camber.draw([], texts=texts, context=limited, **SIZE) == camber.draw([], texts=texts, **SIZE)).all()


@pytest.mark.parametrize("kind, call", [
    (TypeError, lambda: camber.Text(0, 0, 7)),
    (TypeError, lambda: camber.Text(0, 0, b"bytes")),
    (TypeError, lambda: camber.Text("left", 0, "a")),
    (TypeError, lambda: camber.Text(0, 0, "a", colour="#000")),
    (TypeError, lambda: camber.draw([], texts=["a"])),
    (ValueError, lambda: camber.Text(math.nan, 0, "a")),
    (ValueError, lambda: camber.Text(0, 0, "a", color="rouge")),
    (ValueError, lambda: camber.Text(0, 0, "a", size=0)),
    (ValueError, lambda: camber.Text(0, 0, "a", size=math.nan)),
    (ValueError, lambda: camber.Text(0, 0, "a", size=1e9)),
    (ValueError, lambda: camber.Text(0, 0, "a", halo_width=-1)),
    (ValueError, lambda: camber.Text(0, 0, "a", max_width=-1)),
    (ValueError, lambda: camber.Text(0, 0, "a", letter_spacing=math.inf)),
    (ValueError, lambda: camber.Text(0, 0, "a", anchor="middle")),
    (ValueError, lambda: camber.Text(0, 0, "a", align="justify")),
    (ValueError, lambda: camber.Text(0, 0, "a", font="No\0to")),
    (ValueError, lambda: camber.Text.along([[0, 0], [9, 9]], "a", max_turn=0)),
    (ValueError, lambda: camber.Text.along([1, 2, 3], "a")),
    (ValueError, lambda: camber.draw([], texts=camber.Text(2e9, 0, "a"))),
    (ValueError, lambda: camber.draw([], texts=camber.Text.along([[0, 0], [99, 9]], "a", vertical=True))),
    (OverflowError, lambda: camber.text.shape("a" * (1 << 20) + "a")),
])
def test_wrong_arguments(kind, call):
    with pytest.raises(kind):
        call()


def test_the_manual(tmp_path, monkeypatch):
    """Runs the example of docs/python.md."""
    with open(os.path.join(TREE, "docs/python.md"), encoding="utf-8") as file:
        code = re.search(r"## Text\n.*?```python\n(.*?)```", file.read(), re.S).group(1)
    monkeypatch.chdir(tmp_path)
    exec(code, {})
    assert (tmp_path / "names.png").stat().st_size > 1000
