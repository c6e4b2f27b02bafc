#!/usr/bin/env python3
"""The areas of `camber tessellate`: shapely unites the polygons of an input, and the triangles have to be that.

usage: test_area_mesh.py CAMBER MONACO FOLDER. Exit status: 77 where shapely or GLU is not here.
"""
import json
import math
import random
import struct
import subprocess
import sys
from pathlib import Path

try:
    from shapely.geometry import LineString, Polygon, box
    from shapely.ops import polygonize, unary_union
except ImportError:
    print("skipped: no shapely (Debian: python3-shapely)")
    sys.exit(77)

CAMBER, MONACO, FOLDER = sys.argv[1], sys.argv[2], Path(sys.argv[3])
SIZE, ZOOM, LONGITUDE, LATITUDE = 512, 12, 8.0, 47.0
failures = 0


def check(good, what, *more):
    global failures
    failures += not good
    print("ok" if good else "FAILED", "-", what, *([] if good else more))


def tessellate(source, name, *options):
    """Runs camber; its JSON. The file is name in FOLDER."""
    done = subprocess.run([CAMBER, "tessellate", str(source), "-o", str(FOLDER / name), "-f", "--json", *options],
                          capture_output=True, text=True, check=False)
    if "need GLU" in done.stderr:
        check(done.returncode == 69, "a lack of GLU is told", done.returncode)
        print("skipped: no GLU (Debian: libglu1-mesa)")
        sys.exit(77)
    check(done.returncode == 0, f"{name} is made", done.stderr)
    return json.loads(done.stdout)


def read_fills(name):
    """The fills of a GLB: (layer, color, height, triangles in px, y down), and its primitives."""
    data = (FOLDER / name).read_bytes()
    length, = struct.unpack_from("<I", data, 12)
    gltf = json.loads(data[20:20 + length])
    binary = data[28 + length:]

    def values(accessor, format_):
        accessor = gltf["accessors"][accessor]
        view = gltf["bufferViews"][accessor["bufferView"]]
        stride = view.get("byteStride", struct.calcsize(format_))
        start = view["byteOffset"] + accessor.get("byteOffset", 0)
        return [struct.unpack_from(format_, binary, start + i * stride) for i in range(accessor["count"])]

    primitives = gltf["meshes"][0]["primitives"]
    areas = [p for p in primitives if "fills" in p.get("extras", {})]
    if not areas:
        return [], primitives
    check(primitives[0] is areas[0] and len(areas) == 1, "areas come first")
    points = values(areas[0]["attributes"]["POSITION"], "<3f")
    indices = [i for i, in values(areas[0]["indices"], "<I")]
    fills, counted = [], 0
    for fill in areas[0]["extras"]["fills"]:
        first, count = fill["indices"]
        check(first == counted and count > 0, "fills follow each other")
        counted += count
        own = [points[i] for i in indices[first:first + count]]
        fills.append((fill["layer"], fill["color"], {z for _, _, z in own},
                      [[(x, -y) for x, y, _ in own[i:i + 3]] for i in range(0, count, 3)]))
    check(counted == len(indices), "each triangle has a fill")
    return fills, primitives


def signed_area(triangle):
    (ax, ay), (bx, by), (cx, cy) = triangle
    return 0.5 * ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))


def unite(triangles):
    """Their union, and the sum of their areas."""
    shapes = [Polygon(t) for t in triangles if signed_area(t) != 0.0]
    return unary_union([s if s.is_valid else s.buffer(0) for s in shapes]), sum(abs(signed_area(t)) for t in triangles)


# ---- Made-up areas ----

def to_degrees(x, y):
    """Px of the picture, y down, as degrees."""
    world = 512 * 2 ** ZOOM
    center = 0.5 - math.log(math.tan(math.pi / 4 + math.radians(LATITUDE) / 2)) / (2 * math.pi)
    u, v = LONGITUDE / 360 + 0.5 + (x - SIZE / 2) / world, center + (y - SIZE / 2) / world
    return [(u - 0.5) * 360, math.degrees(2 * math.atan(math.exp((0.5 - v) * 2 * math.pi)) - math.pi / 2)]


def star(x, y, radius, points):
    far = [radius * (0.4 + 0.6 * random.random()) for _ in range(points)]
    return [(x + r * math.cos(2 * math.pi * i / points), y + r * math.sin(2 * math.pi * i / points))
            for i, r in enumerate(far)]


def feature(kind, *rings):
    closed = [[to_degrees(*p) for p in ring] + [to_degrees(*ring[0])] for ring in rings]
    return {"type": "Feature", "properties": {"kind": kind}, "geometry": {"type": "Polygon", "coordinates": closed}}


def made_up():
    """Polygons of four kinds: houses in rows, woods with glades that overlap, rings that cross themselves, a frame."""
    features, shapes = [], {"house": [], "wood": [], "knot": [], "frame": []}

    def add(kind, outer, *holes):
        features.append(feature(kind, outer, *holes))
        shapes[kind].append(Polygon(outer, holes))

    for row in range(6):
        for i in range(30):
            turn = 0.1 * row
            corners = [(8 * i + a, b) for a, b in [(0, 0), (8, 0), (8, 6), (5, 6), (5, 12), (0, 12)]]
            add("house", [(20 + math.cos(turn) * a - math.sin(turn) * b,
                           30 + 40 * row + math.sin(turn) * a + math.cos(turn) * b) for a, b in corners])
    for _ in range(40):
        x, y = random.uniform(-50, SIZE + 50), random.uniform(-50, SIZE + 50)
        add("wood", star(x, y, 60, 40), [(x + 5 * a, y + 5 * b) for a, b in [(-1, -1), (1, -1), (1, 1), (-1, 1)]])
    for i in range(16): # apart: where two overlap, one may take away what the other fills
        a, b, c = [(60 + 120 * (i % 4) + random.uniform(-18, 18), 60 + 120 * (i // 4) + random.uniform(-18, 18))
                   for _ in range(3)]
        bow = [a, b, c, tuple(p + q - r for p, q, r in zip(a, b, c))]
        features.append(feature("knot", bow))
        shapes["knot"].extend(polygonize(unary_union(LineString([*bow, bow[0]]))))
    add("frame", [(-900, -900), (SIZE + 900, -900), (SIZE + 900, SIZE + 900), (-900, SIZE + 900)],
        [(100, 100), (400, 120), (380, 410), (90, 400)])
    (FOLDER / "areas.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return {kind: unary_union(own) for kind, own in shapes.items()}


def test_made_up():
    random.seed(7)
    expected = made_up()
    layers = [{"id": kind, "type": "fill", "filter": ["==", ["get", "kind"], kind],
               "paint": {"fill-color": color, "fill-opacity": 0.5}}
              for kind, color in [("frame", "#ffffff"), ("wood", "#00ff00"), ("knot", "#0000ff"), ("house", "#ff0000")]]
    (FOLDER / "areas.json").write_text(json.dumps({"version": 8, "sources": {}, "layers": [
        *layers, {"id": "edges", "type": "line", "paint": {"line-width": 1},
                  "filter": ["all", ["==", ["get", "kind"], "house"], ["==", ["geometry-type"], "Polygon"]]}]}))
    view = ["--center", f"{LONGITUDE},{LATITUDE}", "--zoom", str(ZOOM), "--size", f"{SIZE}x{SIZE}", "--simplify-px", "0",
            "--style", str(FOLDER / "areas.json")]
    said = tessellate(FOLDER / "areas.geojson", "areas.glb", *view)
    fills, primitives = read_fills("areas.glb")
    check([f[0] for f in fills] == ["frame", "wood", "knot", "house"], "fills in drawing order", [f[0] for f in fills])
    check([f[2] for f in fills] == [{-4.0}, {-3.0}, {-2.0}, {-1.0}], "layers above each other", [f[2] for f in fills])
    check(fills[1][1] == [0, 1, 0, 0.5], "the colour of a fill", fills[1][1])
    check(len(primitives) == 2 and said["area_triangles"] == sum(len(f[3]) for f in fills), "all are counted", said)
    window = box(-1, -1, SIZE + 1, SIZE + 1)
    for layer, _, _, triangles in fills:
        union, total = unite(triangles)
        wanted = expected[layer].intersection(window)
        slack = wanted.boundary.length / 256 + 1.0
        check(all(signed_area(t) <= 0.01 for t in triangles), f"{layer}: triangles face up")
        check(abs(total - union.area) < 0.05 + 1e-5 * total, f"{layer}: none overlap", total, union.area)
        check(abs(union.area - wanted.area) < slack, f"{layer}: the area of the union", union.area, wanted.area)
        check(union.symmetric_difference(wanted).area < slack, f"{layer}: its shape",
              union.symmetric_difference(wanted).area, slack)
    # Areas alone, and none.
    (FOLDER / "areas.json").write_text(json.dumps({"version": 8, "sources": {}, "layers": layers[:1]}))
    tessellate(FOLDER / "areas.geojson", "alone.glb", *view)
    fills, primitives = read_fills("alone.glb")
    check(len(fills) == len(primitives) == 1, "areas without lines", len(primitives))


# ---- A city ----

def test_city():
    said = tessellate(MONACO, "city.glb")
    fills, _ = read_fills("city.glb")
    check(len({f[0] for f in fills}) >= 4 and said["area_triangles"] > 2000, "a city has areas", said)
    sums = [(total, union.area) for union, total in (unite(f[3]) for f in fills)]
    worst = max(total - area - 1e-4 * total for total, area in sums)
    check(worst < 0.5, "none overlap in a city", worst)
    tessellate(MONACO, "again.glb", "--threads", "1")
    check((FOLDER / "city.glb").read_bytes() == (FOLDER / "again.glb").read_bytes(), "the same bytes by one thread")


FOLDER.mkdir(parents=True, exist_ok=True)
test_made_up()
test_city()
sys.exit(1 if failures else 0)
