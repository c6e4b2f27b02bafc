"""A label of each script, drawn by camber and by hb-view, which shapes with HarfBuzz and draws with Cairo.

usage: test_scripts.py CAMBER SHIPPED-FONT OUT

camber draws one sheet. hb-view draws each line of it with the same font, MORE times larger; the average of MORE x MORE
of its pixels is how much of one of camber's is covered. It is laid over camber's so that the middles of their ink meet.
Two measures, in shares of all ink: how much of it is in other pixels, and how much of it is in another place if both
are blurred, which edges do not add to, but a missing mark does. So that these measures are worth something, the text
without one of its characters must not pass. The sheet stays in OUT. Scripts without their fonts are left out, and a
line says so. Exit status: 0, 1 (a script differs), 77 (there is no hb-view).
"""

import json
import math
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cities"))
from symbol_pictures import read_png  # noqa: E402

SIZE_PX = 32  # of the text: not so small that camber widens its strokes
MORE = 8
WIDTH_PX, ROW_PX = 384, 72
BLUR_PX = 5
# Shares of ink, about twice what was measured.
MOST_IN_OTHER_PIXELS, MOST_ELSEWHERE = 0.10, 0.04

SHIPPED = "shipped"
# name, text, the font that draws it. A space has the width of the first font's, so most texts here have none.
SCRIPTS = [
    ("Latin", "Việt Nam Łódź ŷ̌", SHIPPED),
    ("Latin, marks", "e\u0302\u0301 o\u0308\u0323 a\u030a\u0301 n\u0303\u0331", SHIPPED),
    ("Greek", "Αθήνα Πάτρα Ϊ", SHIPPED),
    ("Cyrillic", "Київ Москва й", SHIPPED),
    ("Arabic", "القَاهِرَةُ المكتبة", "Noto Sans Arabic"),
    ("Hebrew", "תֵּל־אָבִיב", "Noto Sans Hebrew"),
    ("Devanagari", "दिल्ली क्षेत्र", "Noto Sans Devanagari"),
    ("Thai", "กรุงเทพฯ น้ำ", "Noto Sans Thai"),
    ("Khmer", "ភ្នំពេញ កម្ពុជា", "Noto Sans Khmer"),
    ("Burmese", "ရန်ကုန်မြို့", "Noto Sans Myanmar"),
    ("Chinese", "北京市朝阳区", "Noto Sans CJK SC"),
    ("Japanese", "東京タワーがある", "Noto Sans CJK JP"),
    ("Korean", "서울특별시 강남구", "Noto Sans CJK KR"),
]
DOWN = ("Japanese, downwards", "東京都「タワー」", "Noto Sans CJK JP")


def find_font(family, shipped):
    """The file of a font and its number there; None: there is none."""
    if family == SHIPPED:
        return shipped, 0
    listed = subprocess.run(["fc-list", f"{family}:style=Regular", "file", "index", "variable"], capture_output=True,
                            text=True, check=True).stdout
    for line in sorted(listed.splitlines()):
        path, _, rest = line.partition(": ")
        if "variable=True" not in rest:
            return path, int(rest.split("index=")[1].split(":")[0])
    return None


def coordinates_of(x, y, height):
    """Where a pixel of the sheet is on the map, whose centre is 0, 0 and whose zoom is 10."""
    world = [0.5 + (x - WIDTH_PX / 2) / (512 * 1024), 0.5 + (y - height / 2) / (512 * 1024)]
    return [world[0] * 360 - 180, math.degrees(math.atan(math.sinh(math.pi * (1 - 2 * world[1]))))]


def draw_sheet(camber, rows, out):
    """The coverage of camber's sheet, and what camber says."""
    height = ROW_PX * len(rows) + SIZE_PX * 12
    layers, sources = [{"id": "paper", "type": "background", "paint": {"background-color": "#ffffff"}}], {}
    for i, (name, text, family) in enumerate([*rows, DOWN]):
        y = ROW_PX * (i + 0.5) if i < len(rows) else height - SIZE_PX * 6
        point = {"type": "Point", "coordinates": coordinates_of(WIDTH_PX / 2, y, height)}
        sources[name] = {"type": "geojson", "data": {"type": "Feature", "properties": {"text": text}, "geometry": point}}
        # The fonts of most scripts are not named: camber must find them.
        named = family + " Regular" if "CJK" in family else "Noto Sans Regular"
        layout = {"text-field": ["get", "text"], "text-font": [named], "text-size": SIZE_PX, "text-max-width": 99,
                  "text-allow-overlap": True}
        if i == len(rows):
            layout |= {"text-writing-mode": ["vertical"]}
        layers.append({"id": name, "type": "symbol", "source": name, "layout": layout})
    style = out / "scripts.json"
    style.write_text(json.dumps({"version": 8, "sources": sources, "layers": layers}))
    command = [camber, "render", "--style", style, "--size", f"{WIDTH_PX}x{height}", "--center", "0,0", "--zoom", "10",
               "-f", "-v", "--format", "png", "-o", out / "scripts.png"]
    said = subprocess.run(command, check=True, timeout=600, capture_output=True, text=True).stderr
    return 1.0 - read_png(out / "scripts.png")[:, :, 0] / 255.0, said


def draw_larger(text, font, direction, out):
    """hb-view's coverage."""
    path, number = font
    command = ["hb-view", f"--font-file={path}", f"--face-index={number}", f"--font-size={SIZE_PX * MORE}",
               "--language=und", "--margin=200", "--foreground=000080", "--output-format=png",
               f"--output-file={out / 'other.png'}", *direction, f"--text={text}"]
    subprocess.run(command, check=True, timeout=600)
    return 1.0 - read_png(out / "other.png")[:, :, 0] / 255.0


def middle_of(ink):
    return [float((ink.sum(axis=1 - axis) * (np.arange(ink.shape[axis]) + 0.5)).sum() / ink.sum()) for axis in (0, 1)]


def lay_over(larger, ink):
    """The larger picture, made as small as ink, with its middle in the same place."""
    canvas = np.zeros((ink.shape[0] * MORE, ink.shape[1] * MORE))
    moves = [round(MORE * to - at) for to, at in zip(middle_of(ink), middle_of(larger))]
    drawn = np.argwhere(larger > 0.0)
    low, high = drawn.min(axis=0), drawn.max(axis=0) + 1
    if any(l + m < 0 or h + m > size for l, h, m, size in zip(low, high, moves, canvas.shape)):
        return None  # it is much larger
    canvas[low[0] + moves[0]:high[0] + moves[0], low[1] + moves[1]:high[1] + moves[1]] = \
        larger[low[0]:high[0], low[1]:high[1]]
    return canvas.reshape(ink.shape[0], MORE, ink.shape[1], MORE).mean(axis=(1, 3))


def blur(picture):
    """The means of squares of pixels."""
    for _ in (0, 1):
        sums = np.pad(picture, ((BLUR_PX, BLUR_PX), (0, 0))).cumsum(axis=0)
        picture = ((sums[BLUR_PX:] - sums[:-BLUR_PX]) / BLUR_PX).T
    return picture


def compare(ink, larger):
    other = lay_over(larger, ink)
    if other is None:
        return math.inf, math.inf
    return np.abs(ink - other).sum() / ink.sum(), np.abs(blur(ink) - blur(other)).sum() / ink.sum()


def check(name, text, ink, font, direction, out):
    """What is wrong with a label."""
    pixels, elsewhere = compare(ink, draw_larger(text, font, direction, out))
    shorter = compare(ink, draw_larger(text[:-1], font, direction, out))[1]
    print(f"{name}: {pixels:.1%} of the ink is in other pixels, {elsewhere:.1%} elsewhere; without its last character "
          f"{shorter:.1%}", flush=True)
    faults = []
    if pixels > MOST_IN_OTHER_PIXELS or elsewhere > MOST_ELSEWHERE:
        faults.append(f"{name}: it differs from hb-view's")
    if shorter < 2 * MOST_ELSEWHERE:
        faults.append(f"{name}: a missing character is not seen")
    return faults


def main(camber, shipped, out):
    out = pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    if not shutil.which("hb-view") or not shutil.which("fc-list"):
        print("there is no hb-view (Debian: libharfbuzz-bin, fontconfig): scripts are not compared with it")
        return 77
    fonts = {family: find_font(family, shipped) for _, _, family in SCRIPTS}
    for name, _, family in SCRIPTS:
        if not fonts[family]:
            print(f"there is no {family} (Debian: fonts-noto-core, fonts-noto-cjk): {name} is not compared")
    rows = [row for row in SCRIPTS if fonts[row[2]]]
    sheet, said = draw_sheet(camber, rows, out)
    faults = []
    for i, (name, text, family) in enumerate(rows):
        faults += check(name, text, sheet[ROW_PX * i : ROW_PX * (i + 1)], fonts[family], [], out)
        path = "the Noto Sans that camber ships" if family == SHIPPED else fonts[family][0]
        if f"text is drawn with {path}" not in said:
            faults.append(f"{name}: camber does not say that it draws with {path}")
    if fonts[DOWN[2]]:
        faults += check(DOWN[0], DOWN[1], sheet[ROW_PX * len(rows) :], fonts[DOWN[2]], ["--direction=ttb"], out)
    print(*faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
