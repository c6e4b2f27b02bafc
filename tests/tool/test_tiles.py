#!/usr/bin/env python3
"""Pyramids of tiles from outside: a tile is a cut of a large picture, and the bytes depend on nothing else.

    test_tiles.py TOOL [NAME...]

TOOL is camber. NAME...: these tests alone. The lines are made up by a seed, around a corner of four metatiles. Needs
Python's standard library alone. Exit status 1: the first failure, on standard error.
"""

import glob
import json
import math
import os
import random
import re
import resource
import signal
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "fixtures"))

from png_rows import decode, difference  # noqa: E402

TOOL = sys.argv[1]
ZOOM, COLUMN, ROW = 13, 4304, 2776  # the corner of four metatiles: columns and rows there are multiples of 8
JOURNAL_HEAD_BYTES = 512  # of a journal that has no unit yet
ENVIRONMENT = {name: text for name, text in os.environ.items()
               if not name.startswith(("SLURM", "OMPI", "PMI", "JOB_COMPLETION", "AWS_BATCH"))}


def run(*arguments, **more):
    more.setdefault("env", ENVIRONMENT)
    return subprocess.run([str(a) for a in (TOOL, *arguments)], capture_output=True, text=True, **more)


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def camber(*arguments, status=0, **more):
    done = run(*arguments, **more)
    expect(done.returncode == status, f"{arguments}: {done.returncode}, not {status}: {done.stdout} {done.stderr}")
    if status:
        errors = [line for line in done.stderr.splitlines() if not line.startswith("camber: warning: ")]
        expect(len(errors) == 1 and errors[0].startswith("camber: "), f"{arguments}: {done.stderr}")
    return done


def tiles(*arguments, status=0, **more):
    return camber("tiles", *arguments, *(["-q"] if status == 0 else []), status=status, **more)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


# ---- Places ----


def place(x, y):
    """Longitude and latitude of a point in tiles of ZOOM."""
    tiles_across = 2 ** ZOOM
    return ((x / tiles_across - 0.5) * 360,
            math.degrees(math.atan(math.sinh((0.5 - y / tiles_across) * 2 * math.pi))))


def write_lines(path, lines):
    """lines: pairs of a class and points in tiles."""
    features = [{"type": "Feature", "properties": {"class": kind},
                 "geometry": {"type": "LineString", "coordinates": [place(x, y) for x, y in points]}}
                for kind, points in lines]
    with open(path, "w") as file:
        json.dump({"type": "FeatureCollection", "features": features}, file)


def make_lines(path, count=60, reach=6.0):
    chance = random.Random(20261123)
    lines = []
    for i in range(count):
        x, y = COLUMN + chance.uniform(-reach, reach), ROW + chance.uniform(-reach, reach)
        angle, points = chance.uniform(0, 7), []
        for _ in range(chance.randrange(2, 40)):
            points.append((x, y))
            angle += chance.gauss(0, 0.5)
            length = chance.expovariate(4)
            x, y = x + length * math.cos(angle), y + length * math.sin(angle)
        lines.append((i % 5, points))
    lines.append((0, [(COLUMN - 5.5, ROW), (COLUMN + 5.5, ROW)]))  # along the border of metatiles
    write_lines(path, lines)


# ---- Pictures ----


def render(source, center, size, zoom, *options):
    """A picture around a place in tiles."""
    longitude, latitude = place(*center)
    camber("render", source, "-o", "large.png", "-f", "-q", "--center", f"{longitude:.15f},{latitude:.15f}",
           "--zoom", zoom, "--size", f"{size}x{size}", *options)
    return decode(read("large.png"))


def archive(path, zoom=None):
    """(zoom, column, row) to bytes of MBTiles; rows from the north."""
    with sqlite3.connect(path) as base:
        rows = base.execute("select zoom_level, tile_column, tile_row, tile_data from tiles").fetchall()
    return {(z, x, 2 ** z - 1 - y): data for z, x, y, data in rows if zoom in (None, z)}


STYLES = {
    "wide": [{"paint": {"line-width": ["match", ["get", "class"], 0, 70, 1, 24, 6], "line-color": "#c04020"}}],
    "offset": [{"paint": {"line-width": 3, "line-offset": 22, "line-color": "#205080"},
                "layout": {"line-join": "round"}},
               {"paint": {"line-width": 2, "line-offset": -31, "line-color": "#208040"}}],
    "blurred": [{"paint": {"line-width": 26, "line-blur": 14, "line-color": "#4020a0", "line-opacity": 0.6}}],
    "dashed": [{"paint": {"line-width": 5, "line-dasharray": [3, 2, 0.5, 2], "line-color": "#101010"},
                "layout": {"line-cap": "round"}}],
    "patterned": [{"paint": {"line-width": 18, "line-pattern": "arrow"}}],
    "labelled": [{"paint": {"line-width": 3, "line-color": "#c0a080"}},
                 {"type": "symbol", "layout": {"symbol-placement": "line", "symbol-spacing": 150, "text-size": 13,
                                               "text-field": ["concat", "Road ", ["to-string", ["get", "class"]]]},
                  "paint": {"text-halo-width": 1.5, "text-halo-color": "#ffffff"}},
                 {"type": "symbol", "layout": {"icon-image": "arrow", "text-size": 15, "text-radial-offset": 0.8,
                                               "text-field": ["concat", "Start of ", ["to-string", ["get", "class"]]],
                                               "text-variable-anchor": ["left", "right", "top", "bottom"]},
                  "paint": {"text-halo-width": 2, "text-halo-color": "#ffe0a0"}}],
    "gap": [{"paint": {"line-width": 4, "line-gap-width": 17, "line-translate": [13, -9], "line-color": "#a06000"}}],
}


def write_style(name, layers, background="#f2efe9"):
    """Writes NAME.json; without a background pictures are transparent."""
    style = {"version": 8, "sources": {"lines": {"type": "vector"}}, "layers": []}
    if background == "arrow":
        style["layers"].append({"id": "background", "type": "background", "paint": {"background-pattern": "arrow"}})
    elif background:
        style["layers"].append({"id": "background", "type": "background",
                                "paint": {"background-color": background}})
    for i, layer in enumerate(layers):
        style["layers"].append({"id": f"layer{i}", "type": "line", "source": "lines", **layer})
    if "pattern" in json.dumps(style) or "icon-image" in json.dumps(style):
        style["sprite"] = "sprite"
        write_sprite()
    with open(f"{name}.json", "w") as file:
        json.dump(style, file)
    return f"{name}.json"


def write_sprite():
    size = 12
    rows = b"".join(b"\0" + b"".join(bytes((200, 20 * y, 20 * x, 255 if abs(x - 6) <= y else 0))
                                     for x in range(size)) for y in range(size))

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    with open("sprite.png", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 6, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    with open("sprite.json", "w") as file:
        json.dump({"arrow": {"x": 0, "y": 0, "width": size, "height": size, "pixelRatio": 1}}, file)


# ---- Tests ----


def compare_cuts(name, there, picture, first, across, px, most):
    """Compares the tiles of a square of them with a picture of it. Tiles that are not there show one colour."""
    seen = 0
    for i in range(across):
        for k in range(across):
            cut = [row[4 * px * i:4 * px * (i + 1)] for row in picture[px * k:px * (k + 1)]]
            data = there.get((first[0] + i, first[1] + k))
            if data is None:
                expect(all(row == cut[0][:4] * px for row in cut), f"{name}: tile {i}, {k} is missing")
                continue
            made = decode(data)
            seen += 1
            if made != cut:
                worst = difference(made, cut)
                expect(worst <= most, f"{name}: tile {i}, {k} differs by {worst} levels, and {most} are allowed")
    expect(seen > across * across // 4, f"{name}: {seen} tiles show something")


def test_cuts():
    """To the byte, within a unit and across units."""
    make_lines("lines.geojson")
    for name, layers in STYLES.items():
        style = write_style(name, layers, None if name == "blurred" else "#f2efe9")
        tiles("lines.geojson", "-o", "cuts.mbtiles", "-f", "--style", style, "--min-zoom", ZOOM, "--max-zoom", ZOOM)
        there = {key[1:]: data for key, data in archive("cuts.mbtiles").items()}
        picture = render("lines.geojson", (COLUMN - 4, ROW - 4), 2048, ZOOM - 1, "--style", style)
        compare_cuts(f"{name} in a unit", there, picture, (COLUMN - 8, ROW - 8), 8, 256, 0)
        picture = render("lines.geojson", (COLUMN, ROW), 1536, ZOOM - 1, "--style", style)
        compare_cuts(f"{name} across units", there, picture, (COLUMN - 3, ROW - 3), 6, 256, 0)


def test_paved():
    """A background of images goes on from tile to tile; tiles without lines are left out, or kept."""
    make_lines("lines.geojson")
    style = write_style("paved", STYLES["gap"], "arrow")
    one = ("lines.geojson", "--style", style, "--min-zoom", ZOOM, "--max-zoom", ZOOM)
    tiles(*one, "-o", "paved.mbtiles")
    tiles(*one, "-o", "kept.mbtiles", "--keep-empty")
    some, there = archive("paved.mbtiles"), archive("kept.mbtiles")
    expect(0 < len(some) < len(there) and all(there[key] == data for key, data in some.items()), "other tiles are kept")
    there = {key[1:]: data for key, data in there.items()}
    for column, row, most in ((COLUMN - 4, ROW - 4, 0), (COLUMN, ROW, 1)):  # across units images are sampled elsewhere
        picture = render("lines.geojson", (column, row), 2048, ZOOM - 1, "--style", style)
        compare_cuts(f"paved, {column}", there, picture, (column - 4, row - 4), 8, 256, most)


def test_sizes():
    """Ratios, tiles of 512 px, the dark theme; and WebP without loss shows what the PNG does."""
    make_lines("lines.geojson")
    style = write_style("dashed", STYLES["dashed"])
    tiles("lines.geojson", "-o", "twice.mbtiles", "--style", style, "--ratio", 2, "--min-zoom", ZOOM - 1,
          "--max-zoom", ZOOM - 1)
    there = {key[1:]: data for key, data in archive("twice.mbtiles").items()}
    picture = render("lines.geojson", (COLUMN, ROW), 512, ZOOM - 2, "--style", style, "--ratio", 2)
    compare_cuts("@2x", there, picture, (COLUMN // 2 - 1, ROW // 2 - 1), 2, 512, 0)
    tiles("lines.geojson", "-o", "large.mbtiles", "--style", style, "--tile-size", 512, "--min-zoom", ZOOM - 1,
          "--max-zoom", ZOOM - 1)
    there = {key[1:]: data for key, data in archive("large.mbtiles").items()}
    picture = render("lines.geojson", (COLUMN, ROW), 1024, ZOOM - 1, "--style", style)
    compare_cuts("512", there, picture, (COLUMN // 2 - 1, ROW // 2 - 1), 2, 512, 0)
    tiles("lines.geojson", "-o", "dark.mbtiles", "--theme", "dark", "--min-zoom", ZOOM, "--max-zoom", ZOOM)
    there = {key[1:]: data for key, data in archive("dark.mbtiles").items()}
    picture = render("lines.geojson", (COLUMN, ROW), 1024, ZOOM - 1, "--theme", "dark")
    compare_cuts("dark", there, picture, (COLUMN - 2, ROW - 2), 4, 256, 0)
    done = run("tiles", "lines.geojson", "-o", "lossy.pmtiles", "--format", "webp", "--max-zoom", 10)
    if "no WebP" not in done.stderr:
        expect(done.returncode == 0, done.stderr)
        shown = json.loads(camber("tiles", "show", "lossy.pmtiles", "--json").stdout)
        expect(shown["type"] == "webp" and shown["tiles"] > 0, shown)
    many = ("lines.geojson", "--style", write_style("blurred", STYLES["blurred"]), "--max-zoom", 13)
    tiles(*many, "-o", "few.pmtiles", "--format", "png8")
    tiles(*many, "-o", "all.pmtiles")
    expect(os.path.getsize("few.pmtiles") < os.path.getsize("all.pmtiles"), "png8 is larger than png")
    for name in ("few.pmtiles", "all.pmtiles"):
        camber("tiles", "verify", name)


RANGE = ("--min-zoom", "9", "--max-zoom", "13")


def test_same_bytes():
    """Threads, memory and shards change nothing, in each format."""
    make_lines("lines.geojson")
    common = ("lines.geojson", "--style", write_style("dashed", STYLES["dashed"] + STYLES["labelled"][1:]), *RANGE)
    tiles(*common, "-o", "one.pmtiles")
    whole = read("one.pmtiles")
    camber("tiles", "verify", "one.pmtiles")
    for option, value in (("--threads", 1), ("--threads", 2), ("--threads", 5), ("--memory", "48M"),
                          ("--memory", "1G")):
        tiles(*common, "-o", "other.pmtiles", "-f", "--name", "one", option, value)
        expect(read("other.pmtiles") == whole, f"{option} {value}: other bytes")
    for count in (1, 3, 7):
        parts = []
        for part in range(1, count + 1):
            tiles(*common, "-o", "one.pmtiles", "--shard", f"{part}/{count}")
            parts.append(f"one.{part}-of-{count}.pmtiles")
        random.Random(count).shuffle(parts)
        camber("tiles", "merge", *parts, "-o", "merged.pmtiles", "-f")
        expect(read("merged.pmtiles") == whole, f"{count} shards: other bytes")
    done = tiles(*common, "-o", "one.pmtiles", "--shard", "2/3", "--resume")
    tiles(*common, "-o", "one.mbtiles")
    camber("tiles", "merge", "one.pmtiles", "-o", "same.mbtiles")
    expect(archive("one.mbtiles") == archive("same.mbtiles"), "MBTiles have other tiles than PMTiles")
    tiles(*common, "-o", "one/")
    for (zoom, column, row), data in archive("one.mbtiles").items():
        expect(read(f"one/{zoom}/{column}/{row}.png") == data, "a folder has other tiles than MBTiles")


def test_schedule():
    """Shards that go by a schedule make the same archive, and refuse a schedule that is of something else."""
    make_lines("lines.geojson", 60, reach=60.0)
    style = write_style("dashed", STYLES["dashed"] + STYLES["labelled"][1:])
    common = ["lines.geojson", "--style", style, "--max-zoom", "13"]
    tiles(*common, "-o", "one.pmtiles", "-f")
    whole = read("one.pmtiles")
    tiles(*common, "-o", "one.pmtiles", "--dry-run", "--schedule", "plan", status=0)
    expect(os.path.exists("plan") and os.path.exists("plan.features"), "a dry run wrote no schedule")
    tiles(*common, "-o", "one.pmtiles", "--dry-run", "--schedule", "plan", status=73)
    first = read("plan"), read("plan.features")
    tiles(*common, "-o", "one.pmtiles", "--dry-run", "--schedule", "plan", "-f")
    expect(first == (read("plan"), read("plan.features")), "the same schedule has other bytes")
    for count, features in ((1, True), (5, True), (5, False)):
        if not features:
            os.rename("plan.features", "aside")
        for part in range(1, count + 1):
            tiles(*common, "-o", "one.pmtiles", "--schedule", "plan", "--shard", f"{part}/{count}", "-f")
        parts = [f"one.{part}-of-{count}.pmtiles" for part in range(1, count + 1)]
        camber("tiles", "merge", *parts, "-o", "merged.pmtiles", "-f")
        expect(read("merged.pmtiles") == whole, f"{count} shards by a schedule: other bytes, {features}")
    os.rename("aside", "plan.features")
    # Parts with a schedule and without one are parts of the same run.
    tiles(*common, "-o", "one.pmtiles", "--shard", "3/5", "-f")
    camber("tiles", "merge", *parts, "-o", "merged.pmtiles", "-f")
    expect(read("merged.pmtiles") == whole, "a part without the schedule: other bytes")
    tiles(*common, "-o", "other.pmtiles", "--name", "one", "--schedule", "plan")
    expect(read("other.pmtiles") == whole, "a whole run by a schedule: other bytes")
    by_schedule = ["-o", "refused.pmtiles", "--schedule", "plan", "--shard", "1/2"]
    tiles(*common[:-1], "12", *by_schedule, status=65)
    tiles("lines.geojson", "--max-zoom", "13", *by_schedule, status=65)
    make_lines("lines.geojson", 59, reach=60.0)
    tiles(*common, *by_schedule, status=65)
    make_lines("lines.geojson", 60, reach=60.0)
    features = bytearray(read("plan.features"))
    for at in (0, 9, 70, len(features) // 2, len(features) - 20):
        damaged = bytearray(features)
        damaged[at] ^= 0x55
        write("plan.features", damaged)
        tiles(*common, *by_schedule, status=65)
    write("plan.features", features[:len(features) // 2])
    tiles(*common, *by_schedule, status=65)
    write("plan.features", features)
    schedule = read("plan")
    for bad in (b"", b"{}", b"[1]", schedule[:len(schedule) // 2], schedule.replace(b'"d ', b'"19 ', 1)):
        write("plan", bad)
        tiles(*common, *by_schedule, status=65)
    write("plan", schedule)
    tiles(*common, *by_schedule)
    tiles(*common, "-o", "x.pmtiles", "--schedule", "missing", "--shard", "1/2", status=66)
    tiles(*common, "-o", "x.pmtiles", "--schedule", "plan", "--dry-run", "--shard", "1/2", status=2)
    tiles(*common, "-o", "x.pmtiles", "--schedule", "lines.geojson", "--dry-run", "-f", status=2)


def test_auto():
    """The variables of engines name the part."""
    write_lines("short.geojson", [(0, [(COLUMN + 1, ROW + 1), (COLUMN + 1.5, ROW + 1.2)])])
    common = ("short.geojson", "-o", "auto.pmtiles", "--max-zoom", "6", "--shard", "auto", "-f")
    engines = [({"SLURM_ARRAY_TASK_ID": "5", "SLURM_ARRAY_TASK_MIN": "3", "SLURM_ARRAY_TASK_COUNT": "4",
                 "SLURM_PROCID": "0", "SLURM_NTASKS": "1"}, (), "3-of-4"),
               ({"OMPI_COMM_WORLD_RANK": "1", "OMPI_COMM_WORLD_SIZE": "3", "SLURM_PROCID": "0"}, (), "2-of-3"),
               ({"PMI_RANK": "0", "PMI_SIZE": "2"}, (), "1-of-2"),
               ({"SLURM_PROCID": "1", "SLURM_NTASKS": "2"}, (), "2-of-2"),
               ({"JOB_COMPLETION_INDEX": "2"}, ("--shards", "5"), "3-of-5"),
               ({"AWS_BATCH_JOB_ARRAY_INDEX": "0"}, ("--shards", "2"), "1-of-2")]
    for variables, more, part in engines:
        tiles(*common, *more, env={**ENVIRONMENT, **variables})
        expect(os.path.exists(f"auto.{part}.pmtiles"), f"{variables}: no auto.{part}.pmtiles")
        os.unlink(f"auto.{part}.pmtiles")
    tiles(*common, status=2)
    tiles(*common, status=2, env={**ENVIRONMENT, "JOB_COMPLETION_INDEX": "2"})
    tiles(*common, "--shards", 2, status=2, env={**ENVIRONMENT, "JOB_COMPLETION_INDEX": "2"})
    tiles(*common, status=2, env={**ENVIRONMENT, "PMI_RANK": "x", "PMI_SIZE": "2"})
    # Some of the parts: whether 3 is the third or the fourth nobody can tell.
    array = {"SLURM_ARRAY_TASK_ID": "3", "SLURM_ARRAY_TASK_MIN": "3", "SLURM_ARRAY_TASK_MAX": "7",
             "SLURM_ARRAY_TASK_COUNT": "2", "SLURM_ARRAY_TASK_STEP": "1"}
    for more in (("--shards", 8), ("--shards", 2), ()):
        done = tiles(*common, *more, status=2, env={**ENVIRONMENT, **array})
        expect("--shard K/N" in done.stderr and not glob.glob("auto.*"), f"{more}: {done.stderr}")
    tiles(*common, "--shards", 8, status=2, env={**ENVIRONMENT, **array, "SLURM_ARRAY_TASK_MAX": "4"})
    tiles(*common, "--shards", 8, status=2, env={**ENVIRONMENT, "OMPI_COMM_WORLD_RANK": "1", "OMPI_COMM_WORLD_SIZE": "3"})
    tiles(*common, env={**ENVIRONMENT, **array, "SLURM_ARRAY_TASK_STEP": "4"})
    expect(glob.glob("auto.*") == ["auto.1-of-2.pmtiles"], glob.glob("auto.*"))


def size_of(path):
    try:
        return os.path.getsize(path)
    except FileNotFoundError:
        return 0


def test_killed():
    """kill -9 at random moments after a unit has ended, then --resume: the same bytes as uninterrupted."""
    make_lines("lines.geojson", 120)
    common = ("lines.geojson", "--style", write_style("labelled", STYLES["labelled"]), "--min-zoom", 9, "--max-zoom", 13)
    tiles(*common, "-o", "whole.pmtiles", "--resume")  # from the start, where nothing is there
    whole = read("whole.pmtiles")
    chance, resumed = random.Random(), 0
    seed = chance.randrange(10 ** 9)
    chance.seed(seed)
    left = 20
    while left > 0:
        for _ in range(chance.randrange(1, 4)):
            child = subprocess.Popen([TOOL, "tiles", *map(str, common), "-o", "killed.pmtiles", "-q", "--resume",
                                      "--name", "whole"], env=ENVIRONMENT)
            while child.poll() is None and size_of("killed.pmtiles.camber-units") <= JOURNAL_HEAD_BYTES:
                time.sleep(0.002)
            time.sleep(chance.uniform(0, 0.5) if left % 2 else 0)
            child.kill()
            expect(child.wait() in (0, -signal.SIGKILL), f"seed {seed}: ended with {child.returncode}")
            left -= 1
            if child.returncode == 0:
                break
        done = camber("tiles", *common, "-o", "killed.pmtiles", "--resume", "--name", "whole", "--json")
        told = json.loads(done.stdout)
        resumed += told["resumed_units"]
        expect(read("killed.pmtiles") == whole, f"seed {seed}: resumed, other bytes")
        left_over = [name for name in os.listdir(".") if ".camber-" in name]
        expect(not left_over, f"seed {seed}: files are left beside: {left_over}")
        os.unlink("killed.pmtiles")
    expect(resumed > 0, f"seed {seed}: no unit was ever resumed")
    for ending in ("tiles", "units"):  # as a run leaves them that is killed once its archive has its name
        with open(f"whole.pmtiles.camber-{ending}", "wb") as file:
            file.write(b"left over")
    told = json.loads(camber("tiles", *common, "-o", "whole.pmtiles", "--resume", "--json").stdout)
    expect(not [name for name in os.listdir(".") if ".camber-" in name], "files of a whole archive stay")
    expect(told["done"] and told["units"] == 0, f"a whole archive is drawn again: {told}")


def wait_for_units(child, name, before=0):
    """Until the run's journal, which it has locked, is longer than before."""
    while size_of(name + ".camber-units") <= before:
        expect(child.poll() is None, "it has ended before it wrote a unit")
        time.sleep(0.005)


def test_stopped():
    """A signal ends the run with its status; nothing is half-written, and --resume goes on."""
    make_lines("lines.geojson", 400)
    common = ["tiles", "lines.geojson", "--style", write_style("wide", STYLES["wide"]), "--max-zoom", "17", "-q"]
    for number in (signal.SIGINT, signal.SIGTERM):
        before = size_of("stopped.pmtiles.camber-units")
        child = subprocess.Popen([TOOL, *common, "-o", "stopped.pmtiles", "--resume"], env=ENVIRONMENT,
                                 stderr=subprocess.PIPE, text=True)
        wait_for_units(child, "stopped.pmtiles", before)
        child.send_signal(number)
        told = child.communicate()[1]
        expect(child.returncode == 128 + number, f"signal {number}: {child.returncode}")
        expect(told.count("\n") <= 1, told)
        expect(not os.path.exists("stopped.pmtiles"), "half an archive is there")
    child = subprocess.Popen([TOOL, *common[:-1], "-o", "kept.pmtiles"], env=ENVIRONMENT, stderr=subprocess.PIPE, text=True)
    while not os.path.exists("kept.pmtiles.camber-tiles") or os.path.getsize("kept.pmtiles.camber-tiles") == 0:
        expect(child.poll() is None, "it has ended before a unit")
        time.sleep(0.005)
    child.send_signal(signal.SIGINT)
    told = child.communicate()[1]
    expect("--resume continues with the finished tiles, which are kept in kept.pmtiles.camber-tiles" in told, told)


def test_other_run():
    """What is resumed or renewed must be of the same input, style and options; one writer at a time."""
    make_lines("lines.geojson", 200)
    style = write_style("wide", STYLES["wide"])
    common = ["tiles", "lines.geojson", "-o", "locked.pmtiles", "--style", style, "--max-zoom", "15"]
    child = subprocess.Popen([TOOL, *common, "-q"], env=ENVIRONMENT)
    wait_for_units(child, "locked.pmtiles")
    line = camber(*common, status=74).stderr
    expect("another process" in line, line)
    child.kill()
    child.wait()
    line = camber(*common, "--ratio", "1.5", "--resume", status=65).stderr
    expect("options" in line and "style" not in line, line)
    tiles("lines.geojson", "-o", "there.pmtiles", "--style", style, "--max-zoom", 8)
    with open("list", "w") as file:
        file.write("8/134/86\n")
    line = tiles("lines.geojson", "-o", "there.pmtiles", "--renew", "list", status=65).stderr
    expect("style" in line, line)
    tiles("lines.geojson", "-o", "there.pmtiles", "--style", style, "--max-zoom", 8, status=73)
    tiles("lines.geojson", "-o", "missing.pmtiles", "--style", style, "--renew", "list", status=66)


def test_renew():
    """Just the tiles of a list are drawn anew; where nothing is left, they go."""
    style = write_style("wide", STYLES["wide"])
    before = [(1, [(COLUMN + 1.5, ROW + 1.5), (COLUMN + 3.5, ROW + 1.5)]),
              (1, [(COLUMN - 3.5, ROW - 1.5), (COLUMN - 2.5, ROW - 1.5)])]
    after = [(1, [(COLUMN + 1.5, ROW + 1.2), (COLUMN + 3.5, ROW + 1.9)])]
    write_lines("data.geojson", before)
    options = ("data.geojson", "--style", style, "--name", "map")
    tiles(*options, "-o", "map.mbtiles", *RANGE)
    old = archive("map.mbtiles")
    write_lines("data.geojson", after)
    tiles(*options, "-o", "new.mbtiles", *RANGE)
    new = archive("new.mbtiles")
    listed = [(ZOOM, COLUMN + 2, ROW + 1), (ZOOM, COLUMN - 3, ROW - 2), (ZOOM, COLUMN + 20, ROW)]
    with open("list", "w") as file:
        file.writelines(f"{zoom}/{column}/{row}\n" for zoom, column, row in listed)
    said = camber("tiles", *options, "-o", "map.mbtiles", "--renew", "list").stderr
    expect(re.search(r"^1 tile removed", said, re.M) and "1 tile of the list is outside" in said, said)
    expect(re.search(r"^map.mbtiles: \d+ tiles? drawn, now \d+ tiles, zooms \d+ to \d+, [\d.]+ KB, [\d.]+ s$", said, re.M), said)
    made = archive("map.mbtiles")
    wanted = {**old, **{key: new.get(key) for key in listed}}
    expect(made == {key: data for key, data in wanted.items() if data}, "renewed tiles, and no others, are new")
    expect(old[listed[0]] != made[listed[0]] and listed[1] in old and listed[1] not in made, "the data has changed")
    with open("list", "w") as file:
        file.writelines(f"{zoom}/{column}/{row}\n" for zoom, column, row in {**old, **new})
    for name in ("map.mbtiles", "map.mbtiles"):
        tiles(*options, "-o", name, "--tiles", "list")  # the former name of --renew
        expect(archive(name) == new, "all tiles renewed are not all tiles drawn")
    said = camber("tiles", *options, "-o", "map.mbtiles", "--renew", "list").stderr
    expect("removed" not in said and "left out" not in said, said)
    with open("outside", "w") as file:
        file.write(f"{ZOOM}/{COLUMN + 2}/{ROW + 1}\n{ZOOM}/{COLUMN + 2000}/{ROW}\n2/1/1\n")
    said = camber("tiles", *options, "-o", "map.mbtiles", "--renew", "outside").stderr
    expect("2 tiles of the list are outside" in said and archive("map.mbtiles") == new, said)
    camber("tiles", "verify", "map.mbtiles")
    with open("outside", "w") as file:
        file.write("2/1/1\n")
    said = camber("tiles", *options, "-o", "map.mbtiles", "--renew", "outside").stderr
    expect("1 tile of the list is outside" in said and "nothing to renew" in said, said)
    # Zooms that are named, or a box: they say what the archive is to have.
    with open("outside", "w") as file:
        file.write(f"2/2/1\n{ZOOM}/{COLUMN + 2}/{ROW + 1}\n{ZOOM}/{COLUMN + 2}/{ROW + 1}\n")
    said = camber("tiles", *options, "-o", "map.mbtiles", "--renew", "outside", *RANGE).stderr
    expect("1 tile of the list is outside" in said and archive("map.mbtiles") == new, said)
    tiles(*options, "-o", "wider.mbtiles", *RANGE)
    said = camber("tiles", *options, "-o", "wider.mbtiles", "--renew", "outside", "--min-zoom", 0, "--max-zoom", 20).stderr
    expect("outside" not in said and (2, 2, 1) in archive("wider.mbtiles"), said)
    write_lines("far.geojson", after + [(1, [(COLUMN + 31.5, ROW + 1.5), (COLUMN + 33.5, ROW + 1.5)])])
    with open("outside", "w") as file:
        file.write(f"{ZOOM}/{COLUMN + 32}/{ROW + 1}\n")
    far, box = ("far.geojson", *options[1:]), [*place(COLUMN - 50, ROW + 50), *place(COLUMN + 50, ROW - 50)]
    said = camber("tiles", *far, "-o", "wider.mbtiles", "--renew", "outside").stderr
    expect("nothing to renew" in said and (ZOOM, COLUMN + 32, ROW + 1) not in archive("wider.mbtiles"), said)
    tiles(*far, "-o", "wider.mbtiles", "--renew", "outside", "--bbox", ",".join(map(str, box)))
    expect((ZOOM, COLUMN + 32, ROW + 1) in archive("wider.mbtiles"), "a tile of the box that is named")
    camber("tiles", "verify", "wider.mbtiles")
    # Another input, by mistake: it would empty the archive.
    write_lines("far.geojson", [(1, [(COLUMN + 901.5, ROW + 1.5), (COLUMN + 903.5, ROW + 1.5)])])
    said = tiles("far.geojson", *options[1:], "-o", "map.mbtiles", "--renew", "list", status=65).stderr
    expect("lies outside the archive's bounds" in said and archive("map.mbtiles") == new, said)
    with open("list", "w") as file:
        file.write("13/1/1\n13/1\n")
    line = tiles(*options, "-o", "map.mbtiles", "--renew", "list", status=65).stderr
    expect("line 2" in line, line)


SHARDS = 20  # more than there are units


def test_labels():
    """Shuffled input, shards of one unit or none, and single tiles: the same labels."""
    make_lines("lines.geojson")
    style = write_style("labelled", STYLES["labelled"])
    told = json.loads(camber("tiles", "lines.geojson", "--style", style, *RANGE, "-o", "one.pmtiles", "--json").stdout)
    expect(told["units"] < SHARDS, f"each shard has a unit: {told}")
    whole = read("one.pmtiles")
    with open("lines.geojson") as file:
        features = json.load(file)
    random.Random(5).shuffle(features["features"])
    with open("shuffled.geojson", "w") as file:
        json.dump(features, file)
    tiles("shuffled.geojson", "--style", style, *RANGE, "-o", "shuffled.mbtiles", "--name", "one")
    tiles("lines.geojson", "--style", style, *RANGE, "-o", "one.mbtiles")
    there, shuffled = archive("one.mbtiles"), archive("shuffled.mbtiles")
    expect(there.keys() == shuffled.keys(), "shuffled: other tiles")
    for key, data in there.items():
        if data != shuffled[key]:
            worst = difference(decode(data), decode(shuffled[key]))
            expect(worst <= 1, f"shuffled: {key} differs by {worst}")
    parts = []
    for part in range(1, SHARDS + 1):
        tiles("lines.geojson", "--style", style, *RANGE, "-o", "one.pmtiles", "--shard", f"{part}/{SHARDS}")
        parts.append(f"one.{part}-of-{SHARDS}.pmtiles")
    camber("tiles", "merge", *parts, "-o", "merged.pmtiles", "-f")
    expect(read("merged.pmtiles") == whole, f"{SHARDS} shards: other bytes")
    some = [key for key in there if key[0] == ZOOM]
    for key in some[::max(1, len(some) // 3)]:
        tiles("lines.geojson", "--style", style, "-o", "single.mbtiles", "-f", "--tile", "/".join(map(str, key)))
        expect(archive("single.mbtiles") == {key: there[key]}, f"{key} alone has other bytes")
    tiles("lines.geojson", "--style", style, *RANGE, "-o", "lines.mbtiles", "--no-labels")
    expect(archive("lines.mbtiles").keys() <= there.keys(), "a tile with lines is missing")
    camber("tiles", "verify", "one.pmtiles")


def test_label_sizes():
    """Tiles of 512 px and of twice the density have the same labels at the same places."""
    make_lines("lines.geojson")
    common = ("lines.geojson", "--style", write_style("labelled", STYLES["labelled"]))
    tiles(*common, *RANGE, "-o", "one.mbtiles", "--label-record", "one")
    tiles(*common, *RANGE, "-o", "two.mbtiles", "--ratio", 2, "--label-record", "two")
    expect(len(read("one")) > 2000 and read("one") == read("two"), "@2x has other labels")
    tiles(*common, *RANGE, "-o", "three.mbtiles", "--ratio", 2, "--label-record", "three", "--threads", 5)
    expect(read("two.mbtiles") == read("three.mbtiles") or archive("two.mbtiles") == archive("three.mbtiles"),
           "other threads: other bytes @2x")
    tiles(*common, "--tile-size", 512, "--min-zoom", 8, "--max-zoom", 12, "-o", "large.mbtiles")
    small, large, compared = archive("one.mbtiles"), archive("large.mbtiles"), 0
    expect({(z - 1, x // 2, y // 2) for z, x, y in small} == large.keys(), "other tiles of 512 px")
    for (zoom, column, row), data in large.items():
        rows = decode(data)
        for x, y in ((0, 0), (1, 0), (0, 1), (1, 1)):
            part = small.get((zoom + 1, 2 * column + x, 2 * row + y))
            if part:
                cut = [line[1024 * x:1024 * x + 1024] for line in rows[256 * y:256 * y + 256]]
                worst = difference(decode(part), cut)
                compared += 1
                expect(worst <= 1, f"{zoom}/{column}/{row} of 512 px differs by {worst}")
    expect(compared > 100, f"{compared} tiles compared")


def test_renew_labels():
    """Of new data, only the changed line's tile is listed; tiles whose labels have moved are renewed by the record."""
    style = write_style("labelled", STYLES["labelled"])
    make_lines("data.geojson")
    common = ("data.geojson", "--style", style, "--name", "map")
    tiles(*common, "-o", "map.mbtiles", *RANGE, "--label-record", "labels")
    old = archive("map.mbtiles")
    with open("data.geojson") as file:
        data = json.load(file)
    data["features"].append({"type": "Feature", "properties": {"class": 9}, "geometry": {
        "type": "LineString", "coordinates": [place(COLUMN + 0.02, ROW + 0.5), place(COLUMN + 0.05, ROW + 0.52)]}})
    with open("data.geojson", "w") as file:
        json.dump(data, file)
    tiles(*common, "-o", "new.mbtiles", *RANGE, "--label-record", "wanted")
    new = archive("new.mbtiles")
    listed = [(ZOOM - n, COLUMN >> n, ROW >> n) for n in range(14) if (ZOOM - n, COLUMN >> n, ROW >> n) in new]
    changed = {key for key in old.keys() | new.keys() if old.get(key) != new.get(key)}
    expect(changed - set(listed), "the label touches no other tile")
    with open("list", "w") as file:
        file.writelines(f"{zoom}/{column}/{row}\n" for zoom, column, row in listed)
    with sqlite3.connect("map.mbtiles") as base, sqlite3.connect("left.mbtiles") as copy:
        base.backup(copy)
    said = camber("tiles", *common, "-o", "left.mbtiles", "--renew", "list").stderr
    expect("labels that have moved" in said and archive("left.mbtiles") != new, f"without a record: {said}")
    said = camber("tiles", *common, "-o", "map.mbtiles", "--renew", "list", "--label-record", "labels").stderr
    expect("not listed, but with other labels" in said and archive("map.mbtiles") == new, f"with a record: {said}")
    expect(read("labels") == read("wanted"), "the record is not the new one")
    write("labels", read("labels")[:-3])
    tiles(*common, "-o", "map.mbtiles", "--renew", "list", "--label-record", "labels", status=65)
    os.remove("labels")
    tiles(*common, "-o", "map.mbtiles", "--renew", "list", "--label-record", "labels", status=66)
    expect(not os.path.exists("labels"), "a record of labels that were not compared")
    tiles(*common, "-o", "new.mbtiles", *RANGE, "--label-record", "labels", "--resume")
    expect(read("labels") == read("wanted"), "a complete archive that is resumed has no record")
    tiles(*common, "-o", "x.mbtiles", "--shard", "1/2", "--label-record", "labels", status=2)
    tiles(*common, "-o", "x.mbtiles", "--no-labels", "--label-record", "labels", status=2)


def test_merged_sizes():
    """Tiles of two sizes make no map."""
    make_lines("lines.geojson")
    for name, *options in (("small.pmtiles",), ("large.mbtiles", "--tile-size", "512"), ("fine.pmtiles", "--ratio", "2")):
        tiles("lines.geojson", "-o", name, "--max-zoom", 9, *options)
    for given, said in ((("small.pmtiles", "large.mbtiles"), "512 px, not 256"),
                        (("large.mbtiles", "fine.pmtiles"), "ratio 2, not 1")):
        line = camber("tiles", "merge", *given, "-o", "both.pmtiles", status=65).stderr
        expect(said in line and not os.path.exists("both.pmtiles"), line)
    camber("tiles", "merge", "large.mbtiles", "-o", "both.pmtiles")


def test_area():
    """Boxes, regions, lists, empty tiles, dry runs."""
    make_lines("lines.geojson")
    write_lines("short.geojson", [(1, [(COLUMN + 2.3, ROW + 2.3), (COLUMN + 2.6, ROW + 2.6)])])
    style = write_style("thin", [{"paint": {"line-width": 1, "line-color": "#000"}}])
    one = ("--style", style, "--min-zoom", ZOOM, "--max-zoom", ZOOM)
    tiles("short.geojson", "-o", "short.mbtiles", *one)
    expect(set(archive("short.mbtiles")) == {(ZOOM, COLUMN + 2, ROW + 2)}, "a tile exactly outside is drawn")
    tiles("lines.geojson", "-o", "all.mbtiles", *one)
    whole = archive("all.mbtiles")
    west, north = place(COLUMN - 2, ROW - 2)
    east, south = place(COLUMN + 1, ROW + 1)
    box = f"{west + 1e-6},{south + 1e-6},{east - 1e-6},{north - 1e-6}"
    inside = {(ZOOM, COLUMN + i, ROW + k) for i in range(-2, 1) for k in range(-2, 1)}
    tiles("lines.geojson", "-o", "box.mbtiles", *one, "--bbox", box)
    expect(archive("box.mbtiles") == {k: d for k, d in whole.items() if k in inside}, "--bbox: other tiles")
    tiles("lines.geojson", "-o", "kept.mbtiles", *one, "--bbox", box, "--keep-empty")
    kept = archive("kept.mbtiles")
    expect(set(kept) == inside, "--keep-empty leaves tiles out")
    with open("region.geojson", "w") as file:
        corners = [place(x, y) for x, y in ((COLUMN - 1.5, ROW + 0.2), (COLUMN + 2.5, ROW + 0.5),
                                            (COLUMN - 1.5, ROW + 0.8), (COLUMN - 1.5, ROW + 0.2))]
        json.dump({"type": "Feature", "properties": {},
                   "geometry": {"type": "Polygon", "coordinates": [corners]}}, file)
    tiles("lines.geojson", "-o", "region.mbtiles", *one, "--region", "region.geojson")
    wanted = {(ZOOM, COLUMN + i, ROW) for i in range(-2, 3)}
    expect(archive("region.mbtiles") == {k: d for k, d in whole.items() if k in wanted}, "--region: other tiles")
    some = sorted(whole)[:2]
    tiles("lines.geojson", "-o", "some.mbtiles", "--style", style,
          *(word for z, x, y in some for word in ("--tile", f"{z}/{x}/{y}")))
    expect(archive("some.mbtiles") == {key: whole[key] for key in some}, "--tile: other tiles")
    camber("tiles", "lines.geojson", "-o", "dry.mbtiles", *one, "--dry-run", "--keep-empty", "--bbox", "-20,20,40,70")
    told = json.loads(camber("tiles", "lines.geojson", "-o", "dry.mbtiles", *one, "--dry-run", "--json").stdout)
    size = sum(len(data) for data in whole.values())
    expect(not os.path.exists("dry.mbtiles") and len(whole) <= told["tiles"] < 1.2 * len(whole), told)
    expect(0.8 * size < told["bytes"] < 1.25 * size and told["points"] > 0 and told["units"] > 0, told)
    with open("empty.geojson", "w") as file:
        json.dump({"type": "FeatureCollection", "features": []}, file)
    swapped = camber("tiles", "lines.geojson", "-o", "swapped.pmtiles", *one, "--bbox", "43,7,44,8").stderr
    expect("longitudes come first" in swapped, swapped)
    for box, wide in (("9,50,8,51", True), ("179,50,-179,51", False)):
        said = camber("tiles", "lines.geojson", "-o", "wide.pmtiles", "-f", "--bbox", box, "--max-zoom", 4).stderr
        expect(("359 degrees wide" in said) == wide, said)
    done = run("tiles", "empty.geojson", "-o", "empty.pmtiles", "--max-zoom", "3")
    expect(done.returncode in (0, 65), done.stderr)
    for name in ("short", "all", "box", "kept", "region", "some"):
        camber("tiles", "verify", f"{name}.mbtiles")


def test_dry_run():
    """A town in the country: most of its bytes are in a few metatiles, and a dry run finds those."""
    chance = random.Random(20261129)
    lines = [(0, [(COLUMN - 40 + i, ROW + chance.uniform(-8, 8)) for i in range(80)])]
    for i in range(4000):
        x, y = COLUMN - 20.5 + chance.gauss(0, 0.4), ROW + 5.5 + chance.gauss(0, 0.4)
        lines.append((i % 5, [(x, y), (x + chance.uniform(-0.1, 0.1), y + chance.uniform(-0.1, 0.1))]))
    write_lines("town.geojson", lines)
    for options in (("--max-zoom", ZOOM), ("--max-zoom", ZOOM + 2, "--keep-empty")):
        told = json.loads(camber("tiles", "town.geojson", "-o", "dry.mbtiles", *options, "--dry-run", "--json").stdout)
        made = json.loads(camber("tiles", "town.geojson", "-o", "town.mbtiles", "-f", *options, "--json").stdout)
        expect(0.8 < told["bytes"] / made["bytes"] < 1.25, f"{options}: {told} {made}")
        expect(made["tiles"] <= told["tiles"] < 1.5 * made["tiles"], f"{options}: {told} {made}")
    said = camber("tiles", "town.geojson", "-o", "dry.mbtiles", "--max-zoom", 9, "--dry-run").stderr
    expect(re.search(r"^dry.mbtiles: would have at most \d+ tiles in \d+ metatiles?, [\d,]+ points, about \d+ KB; "
                     r"dry run, [\d.]+ s$", said, re.M), said)


def test_metadata():
    make_lines("lines.geojson")
    tiles("lines.geojson", "-o", "told.pmtiles", "--max-zoom", 9, "--name", "Lines", "--description", "made up",
          "--attribution", "nobody")
    shown = json.loads(camber("tiles", "show", "told.pmtiles", "--json").stdout)
    metadata = shown["metadata"]
    expect((metadata["name"], metadata["description"], metadata["attribution"]) == ("Lines", "made up", "nobody"), shown)
    expect("theme" not in metadata, "a light map has a theme")
    for name, options in (("dark.pmtiles", ("--theme", "dark")), ("own.mbtiles", ("--style", "own.json"))):
        with open("own.json", "w") as file:
            json.dump({"version": 8, "sources": {}, "layers": [
                {"id": "light", "type": "background", "paint": {"background-color": "#fff"}},
                {"id": "dark", "type": "background", "paint": {"background-color": "rgba(10, 20, 30, 0.9)"}},
                {"id": "lines", "type": "line", "paint": {"line-color": "#fff"}}]}, file)
        tiles("lines.geojson", "-o", name, "--max-zoom", 9, *options)
        about = json.loads(camber("tiles", "show", name, "--json").stdout)["metadata"]
        expect(about["theme"] == "dark", f"{name}: {about}")
    longitude, latitude = place(COLUMN, ROW)
    west, south, east, north = shown["bounds"]
    expect(west < longitude < east and south < latitude < north and east - west < 2, shown)
    expect([word.split("=")[0] for word in shown["fingerprint"].split()] ==
           ["input", "style", "options", "area", "version"], shown)


def message(field, content):
    """A field of protobuf: bytes with their length, or a number."""
    def varint(number):
        return bytes([number & 127 | 128]) + varint(number >> 7) if number > 127 else bytes([number])
    if isinstance(content, int):
        return varint(field << 3) + varint(content)
    return varint(field << 3 | 2) + varint(len(content)) + content


def vector_tile(layers):
    """Each layer has one feature, the western half of the tile, or a line through its middle."""
    zigzag = {"area": [9, 0, 0, 26, 4096, 0, 0, 8192, 4095, 0, 15], "line": [9, 0, 4096, 10, 8192, 0]}
    tile = b""
    for name, (what, properties) in layers.items():
        shape = b"".join(message(0, number)[1:] for number in zigzag[what])
        tags = b"".join(bytes([i, i]) for i in range(len(properties)))
        tile += message(3, message(15, 2) + message(1, name.encode()) +
                        message(2, message(2, tags) + message(3, 3 if what == "area" else 2) + message(4, shape)) +
                        b"".join(message(3, key.encode()) for key in properties) +
                        b"".join(message(4, message(7, 1) if value is True else message(1, value.encode()))
                                 for value in properties.values()) + message(5, 4096))
    return tile


def write_vector_tiles(path, layers):
    """The north-western tile of zoom 1; rows count from the south."""
    about = [{"id": name, "fields": {key: "String" for key in properties}} for name, (_, properties) in layers.items()]
    base = sqlite3.connect(path)
    base.execute("CREATE TABLE metadata (name TEXT, value TEXT)")
    base.execute("CREATE TABLE tiles (zoom_level INTEGER, tile_column INTEGER, tile_row INTEGER, tile_data BLOB)")
    base.executemany("INSERT INTO metadata VALUES (?, ?)",
                     [("name", "x"), ("format", "pbf"), ("json", json.dumps({"vector_layers": about}))])
    base.execute("INSERT INTO tiles VALUES (?, ?, ?, ?)", (1, 0, 1, zlib.compress(vector_tile(layers))))
    base.commit()
    base.close()


def test_schemas():
    """show tells the schema by the names of layers; and the style city draws it, or plainly what has none."""
    water, motorway, plain = (0xa6, 0xcf, 0xdd), (0xe5, 0x8c, 0x70), (0x3f, 0x65, 0x95)
    cases = {
        "OpenMapTiles": {"water": ("area", {"class": "lake"}), "transportation": ("line", {"class": "motorway"})},
        "Protomaps 4": {"earth": ("area", {"kind": "earth"}), "water": ("area", {"kind": "lake"}),
                         "roads": ("line", {"kind": "highway", "kind_detail": "motorway", "is_bridge": True})},
        "Protomaps 3": {"earth": ("area", {"pmap:kind": "earth"}), "water": ("area", {"pmap:kind": "lake"}),
                         "roads": ("line", {"pmap:kind": "highway", "pmap:kind_detail": "motorway"})},
        "Shortbread": {"water_polygons": ("area", {"kind": "water"}), "streets": ("line", {"kind": "motorway"})},
        None: {"roads": ("line", {"NAME": "x"})}}
    for schema, layers in cases.items():
        path = f"{schema}.mbtiles"
        write_vector_tiles(path, layers)
        expect(json.loads(camber("tiles", "show", path, "--json").stdout)["schema"] == schema, schema)
        line = re.search(r"^schema +(.*)$", camber("tiles", "show", path).stdout, re.M).group(1)
        expect(line == (schema or "none that the style city knows; its layers are drawn plainly"), line)
        camber("render", path, "-o", "x.png", "-f", "-q", "--center", "-90,66.51326", "--zoom", 16, "--size", "100x100",
               "--width", 8)
        found = {tuple(row[i:i + 3]) for row in decode(read("x.png")) for i in range(0, len(row), 4)}
        expect({water, motorway} <= found if schema else plain in found, f"{schema} has the colours {sorted(found)}")
    make_lines("lines.geojson")
    tiles("lines.geojson", "-o", "x.pmtiles", "--max-zoom", 9)
    expect("schema" not in camber("tiles", "show", "x.pmtiles").stdout, "pictures have a schema")


def test_full():
    """A limit on a file's size stands for a full disk: one line, nothing half-written, and room brings the rest."""
    make_lines("lines.geojson")
    common = ("lines.geojson", "-o", "full.pmtiles", "--max-zoom", "13")
    tiles(*common)
    whole = read("full.pmtiles")
    os.unlink("full.pmtiles")
    for part in (0.0, 0.3, 0.95):
        def confine():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            limit = int(len(whole) * part)
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        camber("tiles", *common, "--resume", status=74, preexec_fn=confine)
        expect(not os.path.exists("full.pmtiles"), "half an archive is there")
    tiles(*common, "--resume")
    expect(read("full.pmtiles") == whole, "other bytes than at once")


def folder_of(path):
    """Names of files to their bytes."""
    names = [os.path.join(folder, name) for folder, _, files in os.walk(path) for name in files]
    return {name: read(name) for name in names}


def test_folders():
    """A folder of tiles is replaced by -f, and one that has anything else is not."""
    make_lines("lines.geojson", 3)
    draw = ("lines.geojson", "--max-zoom", "3")
    tiles(*draw, "-o", "tiles/")
    before = folder_of("tiles")
    tiles(*draw, "-o", "tiles/", "-f")
    expect(folder_of("tiles") == before, "a folder that was replaced has other tiles")
    write("tiles/index.html", b"a page")
    os.mkdir("site")
    write("site/notes.txt", b"notes")
    os.makedirs("years/2024")
    os.symlink("site", "link")
    there = sorted(os.listdir("."))
    for name, told in (("tiles/", "index.html"), ("site/", "notes.txt"), ("years/", "metadata.json"), ("link/", "link"),
                       ("./", "replaced"), ("../", "replaced")):
        for how in ("--force", "--resume"):
            line = camber("tiles", *draw, "-o", name, how, status=74).stderr
            expect(told in line and "--force" not in line, f"{name} {how}: {line}")
    line = camber("tiles", "merge", "tiles/", "-o", "site/", "-f", status=74).stderr
    expect("notes.txt" in line, line)
    expect(folder_of("tiles") == before | {"tiles/index.html": b"a page"}, "a file in the archive is gone")
    expect(folder_of("site") == {"site/notes.txt": b"notes"}, "a file is gone")
    expect(sorted(os.listdir(".")) == there, "something is left or gone")


def test_usage():
    make_lines("lines.geojson", 3)
    good = ["lines.geojson", "-o", "x.pmtiles"]
    bad = [(["lines.geojson"], "-o"), (["-o", "x.pmtiles"], "input"), (["lines.geojson", "-o", "x.png"], "extension"),
           ([*good, "--min-zoom", "5", "--max-zoom", "4"], "--min-zoom"), ([*good, "--max-zoom", "25"], "--max-zoom"),
           ([*good, "--tile-size", "128"], "--tile-size"), ([*good, "--ratio", "9"], "--ratio"),
           ([*good, "--ratio", "0.1"], "--ratio"), ([*good, "--format", "glb", "--keep-empty"], "--keep-empty"),
           ([*good, "--quality", "50"], "--quality"), ([*good, "--tile", "3/8/0"], "--tile"),
           ([*good, "--tile", "3/1"], "--tile"), ([*good, "--tile", "3/1/1", "--max-zoom", "4"], "--tile"),
           ([*good, "--shard", "0/3"], "--shard"), ([*good, "--shard", "4/3"], "--shard"),
           ([*good, "--shard", "a"], "--shard"), ([*good, "--shards", "3"], "--shards"),
           ([*good, "--bbox", "1,2,3"], "--bbox"), ([*good, "--renew", "list", "--resume"], "--renew"),
           ([*good, "--center", "1,1"], "--center"), (["shwo", "x.pmtiles"], "show, verify, merge"),
           (["show", "x.pmtiles", "--max-zoom", "3"], "--max-zoom")]
    for arguments, word in bad:
        line = camber("tiles", *arguments, status=2).stderr
        expect(word in line, f"{arguments}: {line}")
    camber("tiles", "missing.geojson", "-o", "x.pmtiles", status=66)
    camber("tiles", "lines.geojson", "-o", "missing/x.pmtiles", status=73)
    camber("tiles", *good, "--region", "lines.geojson", status=65)
    expect(not [name for name in os.listdir(".") if name.startswith("x.")], "a run that fails leaves something")


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # under nohup or a shell's & it is ignored, and by children
    tests = [test_usage, test_cuts, test_paved, test_sizes, test_same_bytes, test_schedule, test_auto, test_killed,
             test_stopped, test_other_run, test_renew, test_labels, test_label_sizes,
             test_renew_labels, test_merged_sizes, test_area, test_folders, test_dry_run, test_metadata,
             test_schemas, test_full]
    named = [test for test in tests if test.__name__[5:] in sys.argv[2:]]
    for test in named or tests:
        with tempfile.TemporaryDirectory(prefix="camber-tiles-") as folder:
            os.chdir(folder)
            start = time.monotonic()
            test()
            print(f"{test.__name__}: {time.monotonic() - start:.1f} s", flush=True)
            os.chdir("/")


main()
