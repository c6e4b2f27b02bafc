"""Another engine's pictures of symbol layers (CAMBER_DATA/symbol-tests), beside camber's.

usage: symbol_pictures.py CAMBER OUT [PART-OF-A-NAME]

That engine draws text from signed distances, so edges differ. Two measures do not: which marks (glyphs, icons, pieces
of larger things) there are, and how far each is from that engine's. A mark is connected pixels with ink. The test lays
the window around it over the other picture, and moves it until both are most alike:

    likeness = 2 sum(a b) / (sum(a^2) + sum(b^2))     a, b: how the pixels' colours differ from the background

A mark is found if the windows are alike nearer than 3 px. A picture agrees if 95 % of the marks of both pictures are
found; of all marks found 95 % must be within half a pixel. The table of exceptions says why other pictures differ, and
how many of their marks are found at least; one that has come to agree must go from there. Pictures that differ stay in
OUT, that engine's beside camber's. Exit status: 0, 1 (a picture differs), 77 (there are no pictures).
"""

import json
import os
import pathlib
import struct
import subprocess
import sys
import zlib

import numpy as np

DARK = 0.5  # of a picture's strongest ink: pixels of marks
MARK_PX = 16  # larger marks are cut
MARGIN_PX = 3  # of the window around a mark
REACH_PX = 3  # how far a mark is looked for
NEARER = 0.002  # likeness that a place loses for each px^2 of its distance
LIKE = 0.85  # the same glyph, blurred, has more; another one has less
AGREES = 0.95  # the share of marks

ORDER = ("labels come in the order of the tile's features there; here in one that is the same in every view, unless "
         "the style asks for the source's")
CUT = "each tile has its own labels there, and lines begin where a tile cuts them; here lines that go on are one"
WAYS = CUT + "; lines that have no text are not joined there, and each way has its own icons"
LARGER = CUT + "; in tiles that are seen larger the first label of a line is as many times farther from its start"
CIRCLES = LARGER + "; circles around texts along lines reach farther here than the boxes do there"
UPRIGHT = ("glyphs that stand upright in lines that go down are 5/24 em higher there; here they are where MapLibre GL JS 6 "
           "has them")

# Pictures that differ: the share of marks that is found at least, and why.
EXCEPTIONS = {
    "symbol-avoid-edges/rotated": (0.7, WAYS + "; icons avoid the edges of tiles there, those of the picture here"),
    "symbol-avoid-edges/true": (0.6, WAYS + "; icons avoid the edges of tiles there, those of the picture here"),
    "symbol-placement/line-overscaled": (0.0, LARGER + "; a line's icons are tried one after the other there"),
    "symbol-placement/point-polygon": (
        0.85, "the point of a polygon that is farthest from its edges is found within 16 px there, within 1 px here"),
    "symbol-spacing/line-far": (0.6, WAYS),
    "text-arabic/multi-paragraph": (
        0.0, "U+001C ends a paragraph, and cuts lines there after they were chosen; here it ends a line, as "
        "newlines do"),
    "text-keep-upright/line-placement-true": (0.35, CUT),
    "text-max-angle/literal": (0.35, CUT),
    "text-pitch-alignment/auto-text-rotation-alignment-map": (0.0, CIRCLES),
    "text-pitch-alignment/map-text-rotation-alignment-viewport": (0.0, LARGER),
    "text-pitch-alignment/viewport-text-rotation-alignment-map": (0.0, CIRCLES),
    "text-rotate/function": (0.45, ORDER),
    "text-visibility/visible": (0.35, ORDER),
    "text-writing-mode/chinese-punctuation": (
        0.3, UPRIGHT + "; the folder has no glyphs of U+FE00 to U+FEFF, the vertical forms that that engine drew"),
    "text-writing-mode/mixed": (0.35, UPRIGHT + "; to the right of the middle and below it " + CUT),
}
# Proofs that a reason holds: with these properties in its style, so many marks of a picture are found.
PROOFS = {
    "text-rotate/function": ({"symbol-z-order": "source"}, 0.85),
    "text-visibility/visible": ({"symbol-z-order": "source"}, 0.75),
}


def read_png(path):
    """Pixels as a float array [height, width, 4], straight alpha."""
    data = path.read_bytes()
    at, chunks, head, opacity = 8, b"", None, np.zeros(0, np.uint8)
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", body)
        elif kind == b"PLTE":
            palette = np.frombuffer(body, np.uint8).reshape(-1, 3)
        elif kind == b"tRNS":
            opacity = np.frombuffer(body, np.uint8)
        elif kind == b"IDAT":
            chunks += body
        at += 12 + size
    width, height, depth, color = head[:4]
    if color not in (2, 3, 6) or head[6] or (depth != 8 and color != 3):
        raise ValueError(f"{path}: PNG of depth {depth}, colour type {color}")
    channels = {2: 3, 3: 1, 6: 4}[color]
    row_bytes = (width * channels * depth + 7) // 8
    raw = np.frombuffer(zlib.decompress(chunks), np.uint8).reshape(height, 1 + row_bytes)
    rows = np.zeros((height, row_bytes), np.uint8)
    for y in range(height):
        rows[y] = unfilter(raw[y, 0], raw[y, 1:], rows[y - 1] if y else np.zeros_like(rows[0]), channels)
    picture = np.full((height, width, 4), 255.0)
    if color == 3:
        bits = np.unpackbits(rows, axis=1)[:, : width * depth].reshape(height, width, depth)
        index = (bits * (1 << np.arange(depth)[::-1])).sum(axis=2)
        picture[:, :, :3] = palette[index]
        picture[:, :, 3] = np.concatenate([opacity, np.full(256 - len(opacity), 255, np.uint8)])[index]
        return picture
    picture[:, :, :channels] = rows.reshape(height, width, channels)
    return picture


def unfilter(kind, row, above, channels):
    if kind == 0:
        return row
    if kind == 2:
        return row + above
    if kind == 1:
        return np.cumsum(row.reshape(-1, channels), axis=0, dtype=np.uint8).reshape(-1)
    out = np.empty_like(row)
    for c in range(channels):
        out[c::channels] = unfilter_channel(kind, row[c::channels], above[c::channels])
    return out


def unfilter_channel(kind, row, above):
    """Averages (3) or Paeth's guesses (4). Nearly all of a picture is paper, where each byte is the one to its left: only
    edges are looked at one by one."""
    corner = np.concatenate([np.zeros(1, np.uint8), above[:-1]])
    edges = np.flatnonzero((row != 0) | (above != corner)).tolist() + [len(row)]
    out, row, above, corner = bytearray(len(row)), row.tolist(), above.tolist(), corner.tolist()
    i = left = edge = 0
    while i < len(row):
        if i < edges[edge] and (kind == 4 or left == above[i]):
            out[i : edges[edge]] = bytes([left]) * (edges[edge] - i)
            i = edges[edge]
            continue
        if kind == 3:
            guess = (left + above[i]) // 2
        else:
            near = left + above[i] - corner[i]
            guess = min((abs(near - left), 0, left), (abs(near - above[i]), 1, above[i]), (abs(near - corner[i]), 2, corner[i]))[2]
        out[i] = left = (row[i] + guess) & 255
        edge += i == edges[edge]
        i += 1
    return np.frombuffer(bytes(out), np.uint8)


def ink_of(picture, background=None):
    """How each pixel differs from the background, which is the most frequent colour: [height, width, 3], -1 to 1."""
    alpha = picture[:, :, 3:] / 255.0
    seen = picture[:, :, :3] * alpha + 255.0 * (1.0 - alpha)
    if background is None:
        colors, counts = np.unique(seen.reshape(-1, 3).round(), axis=0, return_counts=True)
        background = colors[counts.argmax()]
    return (seen - background) / 255.0, background


def marks_of(ink):
    """Boxes (x0, y0, x1, y1) around connected pixels with ink; those of large ones are cut into smaller boxes."""
    dark = np.abs(ink).max(axis=2)
    todo = {(int(y), int(x)) for y, x in zip(*np.nonzero(dark > DARK * max(dark.max(), 0.1)))}
    marks = []
    while todo:
        stack, inside = [todo.pop()], []
        while stack:
            y, x = stack.pop()
            inside.append((x, y))
            for near in [(y + j, x + i) for j in (-1, 0, 1) for i in (-1, 0, 1)]:
                if near in todo:
                    todo.remove(near)
                    stack.append(near)
        marks += cut(np.array(inside))
    return np.array(marks, int).reshape(-1, 4)


def cut(points):
    """Boxes of at most MARK_PX around points."""
    low, size = points.min(axis=0), np.ptp(points, axis=0) + 1
    parts = -(-size // MARK_PX)
    cell = (points - low) * parts // size
    boxes = []
    for number in np.unique(cell[:, 1] * parts[0] + cell[:, 0]):
        own = points[cell[:, 1] * parts[0] + cell[:, 0] == number]
        if len(own) >= 3:
            boxes.append([*own.min(axis=0), *(own.max(axis=0) + 1)])
    return boxes


def sums_of(values):
    """Sums of all values above and to the left of a corner of pixels."""
    return np.pad(values.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))


def sum_boxes(sums, boxes):
    """Sums in boxes that may reach out of the picture."""
    x0, x1 = (np.clip(boxes[:, i], 0, sums.shape[1] - 1) for i in (0, 2))
    y0, y1 = (np.clip(boxes[:, i], 0, sums.shape[0] - 1) for i in (1, 3))
    return sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0]


def overlay(ink, other, x, y):
    """Sums of the products of ink and the other picture, which is moved to the left by x and up by y."""
    height, width = ink.shape[:2]
    product = np.zeros((height, width))
    own = np.s_[max(-y, 0) : height - max(y, 0), max(-x, 0) : width - max(x, 0)]
    moved = np.s_[max(y, 0) : height - max(-y, 0), max(x, 0) : width - max(-x, 0)]
    product[own] = np.einsum("ijk,ijk->ij", ink[own], other[moved])
    return sums_of(product)


def find(ink, other):
    """For each mark of both pictures how like the other picture is at the best place near it (1: equal), and how far
    that is, px."""
    pictures = ink, other
    windows = [marks_of(picture) + np.array([-1, -1, 1, 1]) * MARGIN_PX for picture in pictures]
    squares = [sums_of(np.square(picture).sum(axis=2)) for picture in pictures]
    steps = range(-REACH_PX, REACH_PX + 1)
    likeness = [np.zeros((len(boxes), len(steps), len(steps))) for boxes in windows]
    for y in steps:
        for x in steps:
            products = overlay(ink, other, x, y)
            for side, (boxes, sign) in enumerate(zip(windows, (1, -1))):
                moved = boxes + sign * np.array([x, y, x, y])
                both = sum_boxes(products, moved if side else boxes)
                squared = sum_boxes(squares[side], boxes) + sum_boxes(squares[1 - side], moved)
                # Along an edge all places are alike: the nearest counts.
                likeness[side][:, sign * y + REACH_PX, sign * x + REACH_PX] = (
                    2.0 * both / np.maximum(squared, 1e-9) - NEARER * (x * x + y * y))
    tables = np.concatenate(likeness)
    best = tables.reshape(len(tables), len(steps) ** 2)
    places = [divmod(int(at), len(steps)) for at in (best.argmax(axis=1) if len(best) else [])]
    distances = [np.hypot(*peak(table, *place)) for table, place in zip(tables, places)]
    return best.max(axis=1) if len(best) else np.zeros(0), np.array(distances)


def peak(table, j, i):
    """Where a parabola through the best place and its neighbours has its top, px from no move. inf: at the edge."""
    last = len(table) - 1
    if not (0 < j < last and 0 < i < last):
        return np.inf, np.inf
    place = []
    for at, (before, top, after) in ((i, table[j, i - 1 : i + 2]), (j, table[j - 1 : j + 2, i])):
        bend = before - 2.0 * top + after
        place.append(at - REACH_PX + (0.5 * (before - after) / bend if bend < -1e-12 else 0.0))
    return tuple(place)


# ---- Pictures ----


def draw(camber, style, folder, out):
    """Draws a style, and returns the picture's path."""
    test = style.get("metadata", {}).get("test", {})
    size = f"{test.get('width', 512)}x{test.get('height', 512)}"
    document, picture = out.with_suffix(".json"), out.with_suffix(".png")
    document.write_text(json.dumps(style).replace("local://", f"{folder}/"))
    command = [camber, "render", "--style", str(document), "--size", size, "--ratio", str(test.get("pixelRatio", 1)),
               "-f", "-q", "--format", "png", "-o", str(picture)]
    subprocess.run(command, check=True, timeout=600)
    return picture


def write_png(path, colors):
    height, width, _ = colors.shape
    rows = b"".join(b"\0" + row.tobytes() for row in colors.round().astype(np.uint8))
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = (b"IHDR", head), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, data in chunks:
            file.write(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)))


def compare(wanted, drawn):
    """Which marks of both pictures are found, and how far each is from its place."""
    ink, background = ink_of(wanted)
    other = ink_of(drawn, background)[0]
    likeness, distances = find(ink, other)
    return (likeness >= LIKE) & (distances < REACH_PX), distances


def share_of(found):
    return found.mean() if len(found) else 1.0


def change(style, properties):
    """The style with these properties in its symbol layers."""
    layers = [layer | {"layout": layer.get("layout", {}) | properties} if layer["type"] == "symbol" else layer
              for layer in style["layers"]]
    return style | {"layers": layers}


class Suite:
    def __init__(self, camber, folder, out):
        self.camber, self.folder, self.out = camber, folder, out
        self.distances, self.faults, self.agreeing, self.count = [], [], 0, 0

    def check(self, style_path):
        """Draws a style, and compares the pictures."""
        name = f"{style_path.parent.parent.name}/{style_path.parent.name}"
        out = self.out / name.replace("/", "__")
        style = json.loads(style_path.read_text())
        wanted = read_png(style_path.parent / "expected.png")
        drawn = read_png(draw(self.camber, style, self.folder, out))
        found, distances = compare(wanted, drawn)
        share = share_of(found)
        self.count += 1
        self.agreeing += share >= AGREES
        self.distances += list(distances[found])
        print(f"{name}: {share:.0%} of {len(found)} marks are found", flush=True)
        if share < AGREES:
            sides = [ink_of(picture, np.zeros(3))[0] * 255.0 for picture in (wanted, drawn)]
            write_png(out.with_suffix(".beside.png"), np.concatenate(sides, axis=1))
        if name.startswith("text-anchor/"):
            self.check_measure(name, drawn)
        self.judge(name, share)
        if name in PROOFS:
            properties, least = PROOFS[name]
            changed = draw(self.camber, change(style, properties), self.folder, out.with_name(out.name + "__changed"))
            self.expect(share_of(compare(wanted, read_png(changed))[0]) >= least, f"{name}: its reason does not hold")

    def judge(self, name, share):
        if name not in EXCEPTIONS:
            self.expect(share >= AGREES, f"{name}: only {share:.0%} of its marks are found")
            return
        least, reason = EXCEPTIONS[name]
        self.expect(share >= least, f"{name}: only {share:.0%} of its marks are found, not {least:.0%} ({reason})")
        self.expect(share < AGREES, f"{name}: it agrees now, so it must go from the exceptions")

    def check_measure(self, name, drawn):
        """The measure tells a picture from itself, 6 px farther right."""
        found = compare(drawn, np.roll(drawn, 6, axis=1))[0]
        self.expect(found.mean() < 0.5, f"{name}: the measure takes what has moved for the same")

    def expect(self, holds, fault):
        if not holds:
            self.faults.append(fault)


def main(camber, out, part=""):
    folder, out = pathlib.Path(os.environ.get("CAMBER_DATA", "")).resolve() / "symbol-tests", pathlib.Path(out)
    if not os.environ.get("CAMBER_DATA") or not folder.is_dir():
        print("CAMBER_DATA names no folder that has symbol-tests: another engine's symbols are not compared")
        return 77
    out.mkdir(parents=True, exist_ok=True)
    suite = Suite(camber, folder, out)
    for style_path in sorted(folder.glob("tests/*/*/style.json")):
        if part in str(style_path.parent):
            suite.check(style_path)
    near = (np.array(suite.distances) < 0.5).mean() if suite.distances else 1.0
    suite.expect(near >= AGREES, f"only {near:.1%} of the marks are within half a pixel")
    print(f"{suite.agreeing} of {suite.count} pictures agree; {near:.1%} of the marks found are within half a pixel")
    print(*suite.faults, sep="\n")
    return 1 if suite.faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
