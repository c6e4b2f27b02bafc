#!/usr/bin/env python3
"""Other processors give the same bytes: pictures, tiles and meshes of this one's best level beside those of others.

    test_processors.py TOOL                            each level of kernels that this processor has
    test_processors.py TOOL LEVEL RUNNER... OTHER      of OTHER, a build of camber, which RUNNER emulates a processor for:
                                                       there the best level must be LEVEL

TOOL is camber. Needs Python's standard library alone. Exit status 1: what differs, on standard error; 77: TOOL has no
kernels for this processor.
"""

import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "fixtures"))

from png_rows import decode  # noqa: E402

DATA = os.path.join(HERE, "..", "data")
MONACO = os.path.join(DATA, "monaco", "monaco.osm.pbf")
TOWN = os.path.join(DATA, "santa_cruz", "osm.mbtiles")
STREETS = os.path.join(DATA, "santa_cruz", "tiger.mbtiles")
WORDS = os.path.join(DATA, "styles", "words.json")
IN_KERNELS = ["--draw", "cl", "--device", "camber", "-q"]

# Each file that the tool writes, with its arguments. Kernels draw every pixel; the rest of a run is the host's.
OUTPUTS = [
    ("monaco.png", ["render", MONACO, "--size", "700x500"]),
    ("dark.webp", ["render", MONACO, "--theme", "dark", "--bearing", "33", "--pitch", "55", "--size", "400x400",
                   "--ratio", "2", "--quality", "100"]),
    ("streets.png", ["render", STREETS, "--size", "512x512"]),
    ("town.png8.png", ["render", TOWN, "--format", "png8", "--bearing", "200", "--size", "600x400"]),
    ("words.png", ["render", "--style", WORDS, "--size", "400x400", "--center", "0,0", "--zoom", "12"]),
    ("paints.png", ["render", "--style", "paints.json", "--size", "700x700"]),
    ("pitched.png", ["render", "--style", "paints.json", "--size", "500x500", "--pitch", "60", "--bearing", "-20",
                     "--coverage", "linear"]),
    ("town.pmtiles", ["tiles", TOWN, "--max-zoom", "14", "--format", "png8"]),
    ("streets.glb", ["tessellate", STREETS]),
]


def walk(random_of, steps, step):
    x, y = random_of.uniform(-0.05, 0.05), random_of.uniform(-0.05, 0.05)
    points = [[x, y]]
    for _ in range(steps):
        x, y = x + random_of.gauss(0, step), y + random_of.gauss(0, step)
        points.append([round(x, 7), round(y, 7)])
    return points


def write_paints():
    """Every paint property of lines that kernels draw, and areas that overlap themselves, over made-up lines."""
    numbers, features = random.Random(44), []
    for i in range(300):
        line = walk(numbers, 12, 0.004)
        features.append({"type": "Feature", "properties": {"kind": i % 6, "size": numbers.uniform(1, 9)},
                         "geometry": {"type": "LineString", "coordinates": line}})
    for i in range(60):
        ring = walk(numbers, 7, 0.006)
        features.append({"type": "Feature", "properties": {"kind": 6 + i % 2},
                         "geometry": {"type": "Polygon", "coordinates": [ring + ring[:1]]}})
    width = ["interpolate", ["exponential", 1.4], ["zoom"], 5, 1, 20, ["*", 7, ["get", "size"]]]
    looks = [{"line-width": width, "line-color": ["interpolate-hcl", ["linear"], ["get", "size"], 1, "red", 9, "blue"]},
             {"line-width": 6, "line-dasharray": [2, 1.3], "line-opacity": 0.6}, {"line-width": 9, "line-blur": 3.5},
             {"line-width": 3, "line-gap-width": 5, "line-offset": 2.7}, {"line-width": 0.35, "line-color": "#123"},
             {"line-width": 7, "line-gradient": ["interpolate", ["linear"], ["line-progress"], 0, "lime", 1, "navy"]}]
    joins = ["round", "miter", "bevel"]
    layers = [{"id": f"area {kind}", "type": "fill", "source": "made", "filter": ["==", ["get", "kind"], kind],
               "paint": {"fill-color": "#9c7", "fill-opacity": 0.5}} for kind in (6, 7)]
    layers += [{"id": f"line {kind}", "type": "line", "source": "made", "filter": ["==", ["get", "kind"], kind],
                "layout": {"line-join": joins[kind % 3], "line-cap": ["butt", "round", "square"][kind // 2]},
                "paint": paint} for kind, paint in enumerate(looks)]
    source = {"type": "geojson", "lineMetrics": True, "data": {"type": "FeatureCollection", "features": features}}
    with open("paints.json", "w", encoding="utf-8") as file:
        json.dump({"version": 8, "sources": {"made": source}, "layers": layers}, file)


def run(command, level=""):
    return subprocess.run(command, capture_output=True, text=True, check=False,
                          env={**os.environ, "CAMBER_CPU": level, "TZ": "UTC"})


def draw(command, level, folder):
    """Writes all outputs to a folder, and gives the bytes of each; of a PNG its pixels, as encoders differ."""
    os.makedirs(folder)
    written = {}
    for name, arguments in OUTPUTS:
        path, draws = os.path.join(folder, name), IN_KERNELS if arguments[0] == "render" else IN_KERNELS[2:]
        result = run([*command, *arguments, *draws, "-o", path], level)
        if result.returncode:
            sys.exit(f"{name} by {' '.join(command)}, {level or 'the best level'}: status {result.returncode}\n"
                     f"{result.stderr}")
        with open(path, "rb") as file:
            written[name] = file.read()
        if name.endswith(".png"):
            written[name] = b"".join(decode(written[name]))
    return written


def level_of(command, level=""):
    """The level whose kernels run; None: there is none."""
    result = run([*command, "info", "--json"], level)
    devices = json.loads(result.stdout)["devices"] if result.returncode == 0 else []
    names = [re.fullmatch(r"camber (\S+)", device["name"]) for device in devices]
    return next((name[1] for name in names if name), None)


def compare(mine, others, who):
    failures = [name for name in mine if mine[name] != others[name]]
    for name in failures:
        a, b = mine[name], others[name]
        count = sum(x != y for x, y in zip(a, b)) + abs(len(a) - len(b))
        print(f"FAILED: {who}: {name}: {count} of {len(a)} bytes differ", file=sys.stderr)
    return not failures


def main():
    tool = os.path.abspath(sys.argv[1])
    if len(sys.argv) > 2 and not shutil.which(sys.argv[3]):
        print(f"skipped: no {sys.argv[3]} (Debian: qemu-user)")
        sys.exit(77)
    best = level_of([tool])
    if not best:
        print("skipped: camber has no kernels for this processor (Debian: clang, and build again)")
        sys.exit(77)
    if len(sys.argv) > 2:
        cases = [([*sys.argv[3:-1], os.path.abspath(sys.argv[-1])], "", sys.argv[2])]
    else:
        cases = [([tool], level, level) for level in ("x86-64-v3", "x86-64-v2")
                 if level != best and level_of([tool], level) == level]
        if not cases:
            print(f"skipped: {best} is the only level of kernels that this processor has")
            sys.exit(77)
    same = True
    with tempfile.TemporaryDirectory(prefix="camber-processors-") as folder:
        os.chdir(folder)
        write_paints()
        mine = draw([tool], "", "mine")
        for number, (command, level, wanted) in enumerate(cases):
            start = time.monotonic()
            if level_of(command, level) != wanted:
                sys.exit(f"{' '.join(command)}: the level is {level_of(command, level)}, not {wanted}")
            same &= compare(mine, draw(command, level, f"other-{number}"), wanted)
            print(f"{len(mine)} outputs: {wanted} beside {best}, {time.monotonic() - start:.1f} s", flush=True)
        os.chdir("/")
    sys.exit(not same)


main()
