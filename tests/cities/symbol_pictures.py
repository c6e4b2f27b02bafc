"""Another engine's pictures of symbol layers (CAMBER_DATA/symbol-tests), beside camber's.

usage: symbol_pictures.py CAMBER FOLDER OUT [PART-OF-A-NAME]

That engine draws text from signed distances, so edges differ. Two measures do not: which marks (connected dark pixels:
glyphs and icons) there are, and how far each is from that engine's. A mark is found if there is one of camber's whose
middle is within 3 px of it and that is about as large; it agrees if their middles are within half a pixel. A picture
agrees if at least 95 % of the marks of both pictures are found.
"""

import json
import pathlib
import struct
import subprocess
import sys
import zlib

import numpy as np

DARK = 0.5      # of a picture's strongest ink: pixels of marks
MARK_PX = 16    # larger marks are cut
MARGIN_PX = 3   # of the window around a mark that is compared
REACH_PX = 3    # how far a mark may have moved, and still be looked for
LIKE = 0.9      # marks that are at least so like each other are the same


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
    out = bytearray(len(row))
    for i, value in enumerate(row.tolist()):
        left = out[i - channels] if i >= channels else 0
        up = int(above[i])
        if kind == 3:
            guess = (left + up) // 2
        else:
            corner = int(above[i - channels]) if i >= channels else 0
            near = left + up - corner
            guess = min((abs(near - left), 0, left), (abs(near - up), 1, up), (abs(near - corner), 2, corner))[2]
        out[i] = (value + guess) & 255
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


def sum_boxes(values, boxes):
    """Sums in boxes that may reach out of the picture."""
    sums = np.pad(values.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    x0, x1 = (np.clip(boxes[:, i], 0, values.shape[1]) for i in (0, 2))
    y0, y1 = (np.clip(boxes[:, i], 0, values.shape[0]) for i in (1, 3))
    return sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0]


def shifted(ink, x, y):
    """The picture moved to the left and up."""
    height, width = ink.shape[:2]
    padded = np.pad(ink, ((REACH_PX, REACH_PX), (REACH_PX, REACH_PX), (0, 0)))
    return padded[REACH_PX + y : REACH_PX + y + height, REACH_PX + x : REACH_PX + x + width]


def find(marks, ink, other):
    """For each mark how like the other picture is at the best place near it (1: equal), and how far that is, px."""
    windows = marks + np.array([-MARGIN_PX, -MARGIN_PX, MARGIN_PX, MARGIN_PX])
    steps = range(-REACH_PX, REACH_PX + 1)
    own = sum_boxes((ink * ink).sum(axis=2), windows)
    likeness = np.zeros((len(marks), len(steps), len(steps)))
    for j, y in enumerate(steps):
        for i, x in enumerate(steps):
            moved = shifted(other, x, y)
            both = sum_boxes((ink * moved).sum(axis=2), windows)
            theirs = sum_boxes((moved * moved).sum(axis=2), windows)
            likeness[:, j, i] = 2.0 * both / np.maximum(own + theirs, 1e-9)
    best = likeness.reshape(len(marks), -1).argmax(axis=1) if len(marks) else np.zeros(0, int)
    distances = [np.hypot(*(peak(table, *divmod(int(at), len(steps))))) for table, at in zip(likeness, best)]
    return likeness.reshape(len(marks), -1).max(axis=1) if len(marks) else np.zeros(0), np.array(distances)


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


def draw(camber, style_path, folder, out):
    text = style_path.read_text().replace("local://", f"{folder}/")
    style = json.loads(text)
    test = style.get("metadata", {}).get("test", {})
    size = f"{test.get('width', 512)}x{test.get('height', 512)}"
    document, picture = out.with_suffix(".json"), out.with_suffix(".png")
    document.write_text(json.dumps(style))
    command = [camber, "render", "--style", str(document), "--size", size, "--ratio", str(test.get("pixelRatio", 1)),
               "-f", "-q", "--format", "png", "-o", str(picture)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    if done.returncode:
        print(f"{style_path.parent.name}: exit {done.returncode}: {done.stderr.strip()[:200]}")
        return None
    return picture


def compare(wanted, drawn):
    """Likeness and distance of each mark: of that engine's first, then of camber's."""
    ink, background = ink_of(wanted)
    other = ink_of(drawn, background)[0]
    there, back = find(marks_of(ink), ink, other), find(marks_of(other), other, ink)
    return np.concatenate([there[0], back[0]]), np.concatenate([there[1], back[1]])


def main(camber, folder, out, part=""):
    folder, out = pathlib.Path(folder).resolve(), pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    agreeing = count = 0
    near = []
    for style_path in sorted(folder.glob("tests/*/*/style.json")):
        name = f"{style_path.parent.parent.name}/{style_path.parent.name}"
        if part not in name:
            continue
        count += 1
        picture = draw(camber, style_path, folder, out / name.replace("/", "__"))
        if not picture:
            continue
        likeness, distances = compare(read_png(style_path.parent / "expected.png"), read_png(picture))
        found = (likeness >= LIKE) & (distances < REACH_PX)
        share = found.mean() if len(found) else 1.0
        near += list(distances[found])
        agreeing += share >= 0.95
        exact = (distances[found] < 0.5).mean() if found.any() else 1.0
        flag = "" if share >= 0.95 else "  <--"
        print(f"{name}: {len(found)} marks, {share:.0%} found, {exact:.0%} within 0.5 px{flag}", flush=True)
    near = np.array(near)
    print(f"{agreeing} of {count} pictures agree; {(near < 0.5).mean() if len(near) else 0:.1%} of the marks found "
          f"are within half a pixel")


if __name__ == "__main__":
    main(*sys.argv[1:])
