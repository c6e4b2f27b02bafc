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


def marks_of(picture):
    """Middles and sizes of connected pixels that differ from the background, which is the most frequent colour."""
    alpha = picture[:, :, 3:] / 255.0
    seen = picture[:, :, :3] * alpha + 255.0 * (1.0 - alpha)
    colors, counts = np.unique(seen.reshape(-1, 3).round(), axis=0, return_counts=True)
    ink = np.abs(seen - colors[counts.argmax()]).max(axis=2) / 255.0
    todo = {(int(y), int(x)) for y, x in zip(*np.nonzero(ink > 0.25))}
    marks = []
    while todo:
        stack, inside = [todo.pop()], []
        while stack:
            y, x = stack.pop()
            inside.append((y, x))
            for near in [(y + j, x + i) for j in (-1, 0, 1) for i in (-1, 0, 1)]:
                if near in todo:
                    todo.remove(near)
                    stack.append(near)
        ys, xs = np.array(inside).T
        # The faint rim counts, too: it says where between pixels the edge is.
        y0, y1, x0, x1 = max(ys.min() - 1, 0), ys.max() + 2, max(xs.min() - 1, 0), xs.max() + 2
        part = ink[y0:y1, x0:x1]
        weight = part.sum()
        if weight >= 2.0:
            middle_y = (part.sum(axis=1) * np.arange(y0, y0 + part.shape[0])).sum() / weight
            middle_x = (part.sum(axis=0) * np.arange(x0, x0 + part.shape[1])).sum() / weight
            marks.append((middle_x, middle_y, weight))
    return np.array(marks).reshape(-1, 3)


def find(marks, others):
    """For each mark its distance from the nearest of the others that is about as large; infinity: there is none."""
    distances = []
    for x, y, weight in marks:
        near = np.hypot(others[:, 0] - x, others[:, 1] - y) if len(others) else np.array([])
        fits = (others[:, 2] > 0.4 * weight) & (others[:, 2] < 2.5 * weight) if len(others) else near
        near = near[fits] if len(near) else near
        distances.append(near.min() if len(near) else np.inf)
    return np.array(distances)


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
        wanted, drawn = marks_of(read_png(style_path.parent / "expected.png")), marks_of(read_png(picture))
        there, back = find(wanted, drawn), find(drawn, wanted)
        both = np.concatenate([there, back])
        share = (both < 3.0).mean() if len(both) else 1.0
        near += list(there[there < 3.0])
        agreeing += share >= 0.95
        exact = (there < 0.5).mean() if len(there) else 1.0
        flag = "" if share >= 0.95 else "  <--"
        print(f"{name}: {len(wanted)} marks, {len(drawn)} drawn, {share:.0%} found, {exact:.0%} within 0.5 px{flag}")
    near = np.array(near)
    print(f"{agreeing} of {count} pictures agree; {(near < 0.5).mean() if len(near) else 0:.1%} of the marks found "
          f"are within half a pixel")


if __name__ == "__main__":
    main(*sys.argv[1:])
