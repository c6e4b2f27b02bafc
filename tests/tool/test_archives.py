#!/usr/bin/env python3
"""Archives of tiles from outside: other readers read every tile, what is wrong is told, what is killed goes on.

    test_archives.py TOOL MAKER [NODE [NAME...]]

TOOL is camber, MAKER the program make_archive, which writes made-up tiles by the writer that drawing uses; beside it
lies read_by_gdal. NODE runs npm's reader of PMTiles, where it is there. NAME...: these tests alone. million is one that runs
only if it is named: an archive of 1,000,000 tiles, of which npm's reader and GDAL read every 331st, or with "every" each,
which takes minutes. Needs Python's standard library alone. Exit status 1: the first failure, on standard error.
"""

import gzip
import json
import os
import random
import resource
import shutil
import signal
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time
import zlib

TOOL, MAKER = sys.argv[1], sys.argv[2]
NODE = sys.argv[3] if len(sys.argv) > 3 and sys.argv[3] else None
FOLDER = os.path.dirname(os.path.abspath(__file__))
STEP_OF_MILLION = 331
UNITS_HALF_WAY = 10  # of thirty


def run(*arguments, **more):
    return subprocess.run([str(a) for a in arguments], capture_output=True, text=True, **more)


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def make(path, count, *options, status=0, **more):
    done = run(MAKER, path, count, *options, **more)
    expect(done.returncode == status, f"make_archive {path} {options}: {done.returncode} {done.stderr}")
    return done.stderr


def tiles(*arguments, status=0, **more):
    done = run(TOOL, "tiles", *arguments, **more)
    expect(done.returncode == status, f"tiles {arguments}: {done.returncode} {done.stdout} {done.stderr}")
    if status not in (0, 1):
        expect(done.stderr.count("\n") == 1, f"tiles {arguments}: one line, not {done.stderr}")
    return done


def read(path):
    with open(path, "rb") as file:
        return file.read()


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def alone(path):
    """Nothing stands beside an archive that is whole."""
    beside = [name for name in os.listdir(os.path.dirname(path) or ".")
              if name.startswith(os.path.basename(path) + ".camber")]
    expect(not beside, f"beside {path}: {beside}")


# ---- Other readers ----


def read_by_npm(path, count, step):
    """{(z, x, y): hash}, or None where the reader is not installed."""
    done = run(NODE, os.path.join(FOLDER, "read_archives.mjs"), count, path, step) if NODE else None
    if not done or done.returncode == 77:
        return None
    expect(done.returncode == 0, f"npm's pmtiles: {done.stderr}")
    rows = (line.split() for line in done.stdout.splitlines())
    return {(int(z), int(x), int(y)): int(value) for z, x, y, value in rows}


def check_by_gdal(path, count, step):
    """GDAL has no reader of PMTiles before 3.8, and then none of pictures in them: MBTiles."""
    done = run(os.path.join(os.path.dirname(os.path.abspath(MAKER)), "read_by_gdal"), count, path, step)
    if done.returncode == 77:
        print("GDAL here does not read MBTiles: left out")
        return
    expect(done.returncode == 0, f"GDAL: {done.stderr}")
    expect(int(done.stdout) == (count - 1) // step + 1, f"GDAL reads {done.stdout} tiles of {count}")


def read_by_sqlite(path):
    handle = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
    rows = handle.execute("SELECT zoom_level, tile_column, tile_row, tile_data FROM tiles")
    return {(z, x, (1 << z) - 1 - row): zlib.crc32(data) for z, x, row, data in rows}


def read_by_name(path):
    found = {}
    for folder, _, names in os.walk(path):
        for name in names:
            if name.endswith(".png"):
                z, x = os.path.relpath(folder, path).split("/")
                found[int(z), int(x), int(name[:-4])] = zlib.crc32(read(os.path.join(folder, name)))
    return found


def test_readers():
    for count in (1, 1000):
        for ending in (".pmtiles", ".mbtiles", "/"):
            make(f"r{count}{ending}", count)
            tiles("verify", f"r{count}{ending}")
        truth = read_by_sqlite(f"r{count}.mbtiles")
        expect(len(truth) == count, f"{len(truth)} tiles of {count}")
        expect(read_by_name(f"r{count}") == truth, "a folder's tiles differ from those of MBTiles")
        check_by_gdal(f"r{count}.mbtiles", count, 1)
        by_npm = read_by_npm(f"r{count}.pmtiles", count, 1)
        expect(by_npm is None or by_npm == truth, f"npm's pmtiles reads other tiles of {count}")


def test_million():
    make("million.pmtiles", 1000000)
    tiles("verify", "million.pmtiles")
    tiles("merge", "million.pmtiles", "-o", "million.mbtiles")
    tiles("verify", "million.mbtiles")
    truth = read_by_sqlite("million.mbtiles")
    expect(len(truth) == 1000000, f"{len(truth)} tiles of a million")
    step = 1 if "every" in sys.argv[4:] else STEP_OF_MILLION
    by_npm = read_by_npm("million.pmtiles", 1000000, step)
    if by_npm is not None:
        expect(len(by_npm) == (999999 // step) + 1, "npm's pmtiles reads fewer tiles")
        expect(all(truth[place] == value for place, value in by_npm.items()), "npm's pmtiles reads other tiles")
    check_by_gdal("million.mbtiles", 1000000, step)
    tiles("merge", "million.mbtiles", "-o", "again.pmtiles")
    expect(read("again.pmtiles") == read("million.pmtiles"), "PMTiles to MBTiles and back is not the same")
    child = subprocess.Popen([TOOL, "tiles", "merge", "million.pmtiles", "-o", "stopped.mbtiles"])
    while not os.path.exists("stopped.mbtiles.camber-whole"):
        time.sleep(0.01)
    child.send_signal(signal.SIGINT)
    expect(child.wait() == 130, f"a stopped merge ends with {child.returncode}")
    expect(not os.path.exists("stopped.mbtiles"), "a stopped merge left half an archive")
    alone("stopped.mbtiles")
    for name in ("million.pmtiles", "million.mbtiles", "again.pmtiles"):
        os.unlink(name)


# ---- Rules that are broken ----

HEADER = struct.Struct("<7sB8Q3Q6B4iB2i")
FIELDS = ("magic version root root_size metadata metadata_size leaves leaves_size tiles tiles_size addressed entries "
          "contents clustered packed tile_packed type low high west south east north zoom longitude latitude").split()


def varint(value):
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    out.append(value)
    return bytes(out)


def directory(entries):
    """entries: (number, run, size, offset)"""
    out = varint(len(entries))
    before = 0
    for number, *_ in entries:
        out += varint(number - before)
        before = number
    for column in (1, 2):
        for entry in entries:
            out += varint(entry[column])
    for entry in entries:
        out += varint(entry[3] + 1)
    return gzip.compress(out, mtime=0)


def png(value):
    make("one.mbtiles", value + 1, "force")
    handle = sqlite3.connect("one.mbtiles")
    return handle.execute("SELECT tile_data FROM images ORDER BY length(tile_data) DESC, tile_data").fetchone()[0]


def archive(rows, data, leaves=(), metadata=b'{"name":"x"}', **changes):
    """A PMTiles file with these entries over the bytes of data; changes are of the header's fields."""
    root, about = directory(rows), gzip.compress(metadata, mtime=0)
    leaf = b"".join(leaves)
    counted = [entry for entry in rows if entry[1]]
    fields = dict(magic=b"PMTiles", version=3, root=127, root_size=len(root), metadata=127 + len(root),
                  metadata_size=len(about), leaves=127 + len(root) + len(about), leaves_size=len(leaf),
                  tiles=127 + len(root) + len(about) + len(leaf), tiles_size=len(data),
                  addressed=sum(entry[1] for entry in counted), entries=len(counted),
                  contents=len({entry[3] for entry in counted}), clustered=1, packed=2, tile_packed=1, type=2, low=0,
                  high=1, west=-1800000000, south=-850000000, east=1800000000, north=850000000, zoom=0, longitude=0,
                  latitude=0)
    fields.update(changes)
    return HEADER.pack(*(fields[name] for name in FIELDS)) + root + about + leaf + data


def patched(file, at, value):
    """The file with another offset in its header."""
    return file[:at] + struct.pack("<Q", value) + file[at + 8:]


def broken_pmtiles():
    """(what must be said, the file)"""
    tile = png(0)
    n = len(tile)
    good = [(0, 1, n, 0), (1, 4, n, 0)]
    two = tile + tile
    bad = tile[:-20] + b"x" + tile[-19:]
    yield None, archive(good, tile)
    yield None, archive(good, tile, addressed=0, entries=0, contents=0)  # 0: nobody has counted
    yield "section of leaf directories begins at 0", patched(archive(good, tile), 40, 0)
    yield "section of tiles begins at 0", archive(good, tile, tiles=0)
    yield "a directory: its compression", archive(good, tile, root=0)
    yield "its metadata: its compression", patched(archive(good, tile), 24, 0)
    yield "its metadata: it ends past", patched(archive(good, tile), 24, 10 ** 6)
    yield "section of tiles ends past the end of the file", archive(good, tile, tiles_size=10 ** 6)
    yield "and the section of leaf directories overlap", patched(archive(good, tile, leaves_size=10), 40, 130)
    yield "past the first 16384 bytes", archive(good, tile, root=20000).ljust(20000, b"x") + directory(good)
    yield "clustered is 2", archive(good, tile, clustered=2)
    yield "its sections add up", archive(good, tile) + b"x"
    yield "ends past the section of tiles", archive([(0, 1, n, 0), (1, 4, n, 7)], tile)
    yield "is out of order, although", archive([(0, 1, n, n), (1, 4, n, 0)], two)
    yield "occurs twice", archive([(0, 2, n, 0), (1, 4, n, 0)], tile, addressed=6)
    yield "addressed tiles: the header says", archive(good, tile, addressed=6)
    yield "entries: the header says", archive(good, tile, entries=3)
    yield "contents: the header says", archive(good, tile, contents=2)
    yield "lowest zoom is given", archive(good[1:], tile, addressed=4, entries=1)
    yield "highest zoom is given", archive(good, tile, high=2)
    yield "centre's zoom", archive(good, tile, zoom=2)
    yield "centre's zoom", archive(good[1:], tile, addressed=4, entries=1, low=1)
    yield "have no area", archive(good, tile, east=-1800000000)
    yield "have no area", archive(good, tile, north=-850000000)
    yield "centre 20,0 is outside the bounds", archive(good, tile, east=100000000, longitude=200000000)
    yield "extend beyond the world", archive(good, tile, east=1900000000)
    yield "outside the bounds", archive(good, tile, west=10000000, south=10000000, longitude=20000000,
                                        latitude=20000000)
    yield "has no bytes", archive([(0, 1, 0, 0), (1, 4, n, 0)], tile, contents=1)
    yield "belong to no tile", archive(good, two)
    yield "overlap", archive([(0, 1, n, 0), (1, 4, n, n - 1)], two[:-1])
    yield "not a JSON object", archive(good, tile, metadata=b"[]")
    yield "is not a string", archive(good, tile, metadata=b'{"name":3}')
    yield "no vector_layers", archive(good, tile, type=1)
    yield "type 9", archive(good, tile, type=9)
    yield "zooms are out of range", archive(good, tile, low=2)
    yield "a checksum does not match", archive(good, bad)
    yield "is not a PNG", archive(good, b"x" * n)
    yield "is not a WebP", archive(good, tile, type=4)
    yield "not compressed", archive(good, tile, tile_packed=2)
    yield "is cut off", archive(good, tile[:-12] + b"0" * 12)
    yield "not in order", archive([(1, 1, n, 0), (1, 4, n, 0)], tile)
    yield "not a PMTiles archive", b"x" * 300
    leaf = directory([(1, 4, n, 0)])
    pointer = [(0, 1, n, 0), (1, 0, len(leaf), 0)]
    yield None, archive(pointer, tile, [leaf], addressed=5, entries=2, contents=1)
    yield "belong to none", archive(pointer, tile, [leaf, b"rest"], addressed=5, entries=2, contents=1)
    yield "begins after it", archive([(0, 1, n, 0), (2, 0, len(leaf), 0)], tile, [leaf], addressed=5, entries=2,
                                      contents=1)
    yield "outside the section of leaf directories", archive([(0, 1, n, 0), (1, 0, len(leaf), 50)], tile, [leaf])
    yield "ends past the end", archive([(0, 0, 99, 10 ** 6)], tile)
    inner = directory([(1, 0, len(leaf), 0)])
    yield "lead to others", archive([(0, 1, n, 0), (1, 0, len(inner), len(leaf))], tile, [leaf, inner], addressed=5,
                                    entries=2, contents=1)


def check_findings(path, what):
    done = tiles("verify", path, "--json", status=1 if what else 0)
    found = json.loads(done.stdout)
    expect(found["valid"] == (what is None), f"{path}: {found}")
    expect(not what or any(what in one["message"] for one in found["findings"]), f"{what!r} is not told: {found}")
    lines = tiles("verify", path, status=1 if what else 0).stderr
    expect(not what or what in lines, f"{what!r} has no line: {lines}")
    expect(what or f"{path}: no problem found in " in lines, f"{path}: nothing says that it was verified: {lines}")


def test_pmtiles_rules():
    for what, data in broken_pmtiles():
        write("rule.pmtiles", data)
        check_findings("rule.pmtiles", what)
        # Whatever verify finds, show and merge end in order.
        for action in (("show", "rule.pmtiles"), ("merge", "rule.pmtiles", "-f", "-o", "out.mbtiles")):
            status = run(TOOL, "tiles", *action).returncode
            expect(status in (0, 65), f"{what}: {action}: {status}")


def test_mbtiles_rules():
    broken = (
        (None, "SELECT 1"),
        ("no unique index", "DROP INDEX map_index"),
        ("no name", "DELETE FROM metadata WHERE name = 'name'"),
        ("no format", "DELETE FROM metadata WHERE name = 'format'"),
        ("no bounds", "DELETE FROM metadata WHERE name = 'bounds'"),
        ("no minzoom", "DELETE FROM metadata WHERE name = 'minzoom'"),
        ("not four numbers", "UPDATE metadata SET value = '1,2,3' WHERE name = 'bounds'"),
        ("neither pbf", "UPDATE metadata SET value = 'bmp' WHERE name = 'format'"),
        ("twice", "DROP INDEX metadata_index; INSERT INTO metadata VALUES ('name', 'y')"),
        ("no table metadata", "DROP TABLE metadata"),
        ("no such", "DROP VIEW tiles"),
        ("no such column or row", "UPDATE map SET tile_row = 99 WHERE zoom_level = 1 AND tile_row = 1"),
        ("occurs twice", "DROP INDEX map_index; INSERT INTO map SELECT * FROM map WHERE zoom_level = 0"),
        ("highest zoom", "UPDATE metadata SET value = '9' WHERE name = 'maxzoom'"),
        ("belong to no tile", "INSERT INTO images VALUES ('spare', x'00')"),
        ("have no image", "DELETE FROM images WHERE tile_id = '3'"),
        ("ids of images", "DROP INDEX images_index; INSERT INTO images SELECT * FROM images LIMIT 1"),
        ("is not a PNG", "UPDATE images SET tile_data = x'0011' WHERE tile_id = '3'"),
        ("is empty", "UPDATE images SET tile_data = x'' WHERE tile_id = '3'"),
        ("rows count from the north", "UPDATE metadata SET value = '-180,1,180,85' WHERE name = 'bounds';"
         "DELETE FROM map WHERE zoom_level < 4 OR tile_row >= 8; UPDATE metadata SET value = '4' WHERE name = 'minzoom';"
         "UPDATE metadata SET value = '0,40,4' WHERE name = 'center'"),
    )
    for what, sql in broken:
        make("rule.mbtiles", 1 + 4 + 16 + 64 + 256, "force")
        handle = sqlite3.connect("rule.mbtiles")
        handle.executescript(sql)
        handle.close()
        check_findings("rule.mbtiles", what)


def test_folder_rules():
    def change(what, act):
        make("rule/", 300, "force")
        act()
        check_findings("rule/", what)
        shutil.rmtree("rule")

    make("rule/", 300)
    tile = read("rule/1/0/0.png")
    change(None, lambda: None)
    change("does not have the name of a tile", lambda: write("rule/tileset.json", b"{}")) # these are not meshes
    change("does not have the name of a tile", lambda: write("rule/1/0/01.png", tile))
    change("does not have the name of a tile", lambda: os.mkdir("rule/maps"))
    change("no such column or row", lambda: write("rule/1/0/2.png", tile))
    change("does not have the name of a tile of type", lambda: os.rename("rule/1/0/0.png", "rule/1/0/0.webp"))
    change("occurs twice", lambda: write("rule/1/0/0.webp", tile))
    change("no metadata.json", lambda: os.unlink("rule/metadata.json"))
    change("is a PNG that is cut off", lambda: write("rule/1/0/0.png", tile[:-4]))
    change("highest zoom", lambda: shutil.rmtree("rule/4"))


def write_mbtiles(path, metadata, tile_of):
    """An MBTiles of zoom 1 as simple tools write it."""
    if os.path.exists(path):
        os.unlink(path)
    handle = sqlite3.connect(path)
    handle.execute("CREATE TABLE metadata (name TEXT, value TEXT)")
    handle.execute("CREATE TABLE tiles (zoom_level INTEGER, tile_column INTEGER, tile_row INTEGER, tile_data BLOB)")
    handle.execute("CREATE UNIQUE INDEX place ON tiles (zoom_level, tile_column, tile_row)")
    handle.executemany("INSERT INTO metadata VALUES (?, ?)", metadata.items())
    for i in range(4):
        handle.execute("INSERT INTO tiles VALUES (1, ?, ?, ?)", (i % 2, i // 2, tile_of(i)))
    handle.commit()
    handle.close()


def test_compression():
    """Vector tiles of MBTiles that are plain, or have zlib's header, get the compression that the header says."""
    layers = '{"vector_layers": [{"id": "roads", "fields": {}}]}'
    about = {"name": "t", "format": "pbf", "minzoom": "1", "maxzoom": "1", "bounds": "-180,-85,180,85", "center": "0,0,1",
             "json": layers}
    tile = b"\x1a\x0c\x78\x02\x0a\x05roads\x28\x80\x20"
    for name, tile_of in (("plain", lambda i: tile), ("zlib", lambda i: zlib.compress(tile)),
                          ("mixed", lambda i: (tile, zlib.compress(tile), gzip.compress(tile), tile)[i])):
        write_mbtiles("made.mbtiles", about, tile_of)
        for out in ("out.pmtiles", "out.mbtiles"):
            tiles("merge", "made.mbtiles", "-f", "-o", out)
            tiles("verify", out)
        handle = sqlite3.connect("out.mbtiles")
        found = [gzip.decompress(row[0]) for row in handle.execute("SELECT tile_data FROM tiles")]
        handle.close()
        expect(found == [tile] * 4, f"{name}: {found}")


def test_untold_type():
    """Where nobody says the type it is that of the first tile."""
    tile, noise = png(0), b"nothing that is known"
    write_mbtiles("made.mbtiles", {}, lambda i: tile)
    tiles("merge", "made.mbtiles", "-f", "-o", "out.pmtiles")
    expect("type png" in tiles("show", "out.pmtiles").stdout, "PNGs are not found")
    tiles("verify", "out.pmtiles")
    expect("have no format, and its tiles look like png" in tiles("verify", "made.mbtiles", status=1).stderr +
           tiles("verify", "made.mbtiles", status=1).stdout, "verify does not say what is missing")
    write_mbtiles("made.mbtiles", {}, lambda i: noise)
    tiles("merge", "made.mbtiles", "-f", "-o", "out.pmtiles", status=65)


# ---- Merging ----


def check_flips(parts):
    """A bit of a tile that is another: each is still a tile of its type, and no part of the archive any more."""
    kept, source = read(parts[1]), random.Random(5)
    begin, size = struct.unpack_from("<QQ", kept, 56)
    for _ in range(8):
        data, at = bytearray(kept), begin + source.randrange(size)
        data[at] ^= 1 << source.randrange(8)
        write(parts[1], data)
        tiles("verify", parts[1], status=1)
        line = tiles("merge", *parts, "-o", "merged.pmtiles", status=65).stderr
        expect(parts[1] in line and "checksum" in line and not os.path.exists("merged.pmtiles"), line)
    write(parts[1], kept)


def merge_folders():
    """A folder has no directories of its own that grow: fewer tiles, each of which is a file, are of four units still."""
    count = 4000
    for ending in (".pmtiles", "/"):
        make(f"few{ending}", count)
    parts = [f"few.{k}-of-4.pmtiles" for k in range(1, 5)]
    for k, part in enumerate(parts, 1):
        make(part, count, f"shard={k}/4")
    tiles("merge", *parts, "-o", "merged/")
    expect(read_by_name("merged") == read_by_name("few"), "a merged folder is not what a single run writes")
    tiles("merge", "merged/", "-o", "back.pmtiles")
    expect(read("back.pmtiles") == read("few.pmtiles"), "a folder does not come back as PMTiles")
    alone("merged")
    alone("back.pmtiles")


def test_merge():
    count = 20000
    for ending in (".pmtiles", ".mbtiles"):
        make(f"whole{ending}", count)
    parts = []
    for k in range(1, 5):
        parts.append(f"city.{k}-of-4.pmtiles")
        make(parts[-1], count, f"shard={k}/4")
        tiles("verify", parts[-1])
        shown = json.loads(tiles("show", parts[-1], "--json").stdout)
        expect((shown["shard"], shown["shards"]) == (k, 4), f"{parts[-1]}: {shown}")
    check_flips(parts)
    mixed = parts[::-1]
    tiles("merge", *mixed, "-o", "merged.pmtiles")
    expect(read("merged.pmtiles") == read("whole.pmtiles"), "merged parts are not what a single run writes")
    tiles("merge", *parts, "-o", "merged.mbtiles")
    expect(read("merged.mbtiles") == read("whole.mbtiles"), "merged MBTiles are not what a single run writes")
    merge_folders()
    for name in ("merged.pmtiles", "merged.mbtiles"):
        alone(name)

    def refused(said, *given):
        before = read("merged.pmtiles")
        line = tiles("merge", *given, "-f", "-o", "merged.pmtiles", status=65).stderr
        for words in said:
            expect(words in line, f"{words!r} is not in {line!r}")
        expect(read("merged.pmtiles") == before, "what was there has changed")
        alone("merged.pmtiles")

    refused(("parts 2, 3 of 4 are missing",), parts[0], parts[3])
    refused(("part 2 of 4 is given twice", "part 3 of 4 is missing"), parts[0], parts[1], parts[1], parts[3])
    make("other.pmtiles", count, "shard=3/4", "style=other")
    refused(("other.pmtiles differs in its style",), parts[0], parts[1], "other.pmtiles", parts[3])
    make("of5.pmtiles", count, "shard=3/5")
    refused(("of5.pmtiles is a shard of a run with another number of shards",), *parts, "of5.pmtiles")
    refused(("whole.pmtiles is not a shard",), *parts, "whole.pmtiles")
    write("cut.pmtiles", read(parts[2])[:-5000])
    refused(("cut.pmtiles", "cut off"), parts[0], parts[1], "cut.pmtiles", parts[3])

    tile = png(0)
    n = len(tile)
    other = png(40)
    write("a.pmtiles", archive([(0, 1, n, 0)], tile, high=0))
    write("b.pmtiles", archive([(0, 2, n, 0)], tile))
    write("c.pmtiles", archive([(1, 3, len(other), 0)], other, low=1, zoom=1))
    tiles("merge", "a.pmtiles", "b.pmtiles", "-o", "ab.pmtiles")
    expect(json.loads(tiles("show", "ab.pmtiles", "--json").stdout)["tiles"] == 2, "equal tiles are kept once")
    refused(("b.pmtiles", "c.pmtiles", "1/0/0", "different bytes"), "b.pmtiles", "c.pmtiles")
    refused(("type pbf", "b.pmtiles"), "a.pmtiles", "v.pmtiles") if write(
        "v.pmtiles", archive([(5, 1, n, 0)], tile, type=1)) else None
    tiles("merge", "a.pmtiles", "-o", "ab.pmtiles", status=73)
    tiles("merge", "a.pmtiles", "-o", "nowhere/ab.pmtiles", status=73)
    tiles("merge", "missing.pmtiles", "-o", "x.pmtiles", status=66)
    tiles("merge", "a.pmtiles", "-o", "x.zip", status=2)
    tiles("merge", "-o", "x.pmtiles", status=2)
    tiles("show", "a.pmtiles", "b.pmtiles", status=2)
    tiles("look", "a.pmtiles", status=2)


# ---- Runs that end early ----


def test_killed():
    count, pause = 20000, 4000
    seed = int(os.environ.get("CAMBER_SEED", "17"))
    chance = random.Random(seed)
    for ending in (".pmtiles", ".mbtiles"):
        make(f"calm{ending}", count)
        wanted = read(f"calm{ending}")
        name = f"killed{ending}"
        for round_ in range(8 if ending == ".pmtiles" else 2):
            kills = 0
            way = ["forward"] if round_ % 2 else []
            while True:
                child = subprocess.Popen([MAKER, name, str(count), "resume", f"pause={pause}"] + way,
                                         stderr=subprocess.DEVNULL)
                try:
                    child.wait(chance.uniform(0.002, 0.2) if kills < 4 else None)
                    break
                except subprocess.TimeoutExpired:
                    child.send_signal(signal.SIGKILL)
                    child.wait()
                    kills += 1
            expect(child.returncode == 0, f"seed {seed}: a resumed run ends with {child.returncode}")
            expect(read(name) == wanted, f"seed {seed}, round {round_}: resumed after {kills} kills, other bytes")
            alone(name)
            os.unlink(name)


def start_halting(units, name, count, *options):
    """Starts a run and waits until it has halted after so many units of its own. go_on lets it end."""
    child = subprocess.Popen([MAKER, name, str(count), *options, f"halt={units}"], stdin=subprocess.PIPE,
                             stdout=subprocess.PIPE)
    expect(child.stdout.readline() == b"halted\n", f"{name}: a run ended before {units} units")
    return child


def go_on(child):
    child.communicate()
    return child.returncode


def stop_half_way(name, count, *options):
    """Kills a run that has ended units. Returns the size of its journal."""
    child = start_halting(UNITS_HALF_WAY, name, count, *(options or ["resume"]))
    child.send_signal(signal.SIGKILL)
    go_on(child)
    return os.path.getsize(name + ".camber-units")


def test_resume():
    count = 30000
    make("calm.pmtiles", count, "force")
    stop_half_way("part.pmtiles", count)
    line = make("part.pmtiles", count, "resume", "style=other", status=65)
    expect("differs in its style" in line, line)
    # Torn ends, damaged bytes and damaged records: what is whole is kept, and the rest is drawn again.
    for damage in range(6):
        shutil.copy("part.pmtiles.camber-tiles", "t")
        shutil.copy("part.pmtiles.camber-units", "u")
        data, units = bytearray(read("t")), bytearray(read("u"))
        where = len(units if damage % 2 else data) * (damage + 1) // 8
        if damage % 2:
            units[where] ^= 1
        else:
            data[where] ^= 1
        if damage > 3:
            del data[len(data) // 2:], units[len(units) // 2 + 7:]
        write("torn.pmtiles.camber-tiles", data)
        write("torn.pmtiles.camber-units", units)
        make("torn.pmtiles", count, "resume")
        expect(read("torn.pmtiles") == read("calm.pmtiles"), f"resumed of damage {damage}: other bytes")
        alone("torn.pmtiles")
        os.unlink("torn.pmtiles")
    make("part.pmtiles", count, "resume")
    expect(read("part.pmtiles") == read("calm.pmtiles"), "resumed: other bytes")
    before = os.stat("part.pmtiles").st_mtime_ns
    make("part.pmtiles", count, "resume")
    expect(os.stat("part.pmtiles").st_mtime_ns == before, "a whole archive was written again")
    line = make("part.pmtiles", count, "resume", "style=other", status=65)
    expect("differs in its style" in line and "part.pmtiles" in line, line)
    line = make("part.pmtiles", count, status=74)
    expect("exists" in line, line)


def test_second_names():
    """Where tiles come in the archive's order, their file becomes it; a run that is killed then leaves second names."""
    count, journal, own = 30000, "named.pmtiles.camber-units", "named.pmtiles.camber-tiles"
    wanted = read("calm.pmtiles")
    child = start_halting(1, "named.pmtiles", count, "forward")
    number = os.stat(own).st_ino
    go_on(child)
    expect(os.stat("named.pmtiles").st_ino == number, "the tiles were copied")
    expect(read("named.pmtiles") == wanted, "in order: other bytes than out of it")
    # It is whole and has its name: another run must not write into it before its own is.
    os.link("named.pmtiles", own)
    stop_half_way("named.pmtiles", count, "force", "forward")
    expect(read("named.pmtiles") == wanted, "a run wrote into the archive that it was to replace")
    make("named.pmtiles", count, "resume", "force", "forward")
    expect(read("named.pmtiles") == wanted, "replaced: other bytes")
    os.link("named.pmtiles", own)
    make("named.pmtiles", count, "resume")
    expect(read("named.pmtiles") == wanted, "a whole archive with a second name has changed")
    alone("named.pmtiles")
    # It is whole, and has no name yet: a run goes on with it.
    os.unlink("named.pmtiles")
    before = stop_half_way("named.pmtiles", count, "forward")
    os.link(own, "named.pmtiles.camber-whole")
    child = start_halting(1, "named.pmtiles", count, "resume", "forward")
    expect(os.path.getsize(journal) > before, "a run did not go on")
    go_on(child)
    expect(read("named.pmtiles") == wanted, "gone on after the end: other bytes")
    alone("named.pmtiles")
    # The tiles lie in another folder: a second name would be that of the link.
    os.mkdir("scratch")
    os.symlink("scratch/tiles", own)
    make("named.pmtiles", count, "force", "forward")
    expect(not os.path.islink("named.pmtiles") and read("named.pmtiles") == wanted, "an archive is a link")
    alone("named.pmtiles")


def test_locked():
    child = start_halting(1, "held.pmtiles", 30000)
    line = make("held.pmtiles", 10, "resume", status=74)
    expect("another process" in line and line.count("\n") == 1, line)
    write("a1.pmtiles", archive([(0, 1, len(png(0)), 0)], png(0), high=0))
    tiles("merge", "a1.pmtiles", "-o", "held.pmtiles", status=74)
    expect(go_on(child) == 0, "the writer that has the archive ends well")
    tiles("verify", "held.pmtiles")


def test_full():
    """A limit on a file's size stands for a full disk: the same calls fail in the same places."""
    make("full.pmtiles", 20000)
    whole = read("full.pmtiles")
    make("old.pmtiles", 10)
    for ending in (".pmtiles", ".mbtiles", "/"):
        for part in (0.0, 0.1, 0.5, 0.9, 0.99):
            limit = int(len(whole) * part)
            before = read("old.pmtiles")

            def confine():
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

            if ending != "/" or part == 0:
                line = make(f"none{ending}", 20000, status=74, preexec_fn=confine)
                expect(line.count("\n") == 1 and "cannot be written" in line, line)
                expect(not os.path.exists(f"none{ending}"), f"half of none{ending} is there")
            if ending == ".pmtiles":
                make("old.pmtiles", 20000, "force", status=74, preexec_fn=confine)
                expect(read("old.pmtiles") == before, "what was there has changed")
                done = run(TOOL, "tiles", "merge", "full.pmtiles", "-f", "-o", "old.pmtiles", preexec_fn=confine)
                expect(done.returncode == 74 and done.stderr.count("\n") == 1, f"{done.returncode} {done.stderr}")
                expect(read("old.pmtiles") == before, "what was there has changed")
    for name in [name for name in os.listdir(".") if ".camber-" in name]:
        os.unlink(name)


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # under nohup or a shell's & it is ignored, and by children
    with tempfile.TemporaryDirectory(prefix="camber-archives-") as folder:
        os.chdir(folder)
        tests = [test_readers, test_pmtiles_rules, test_mbtiles_rules, test_folder_rules, test_compression, test_untold_type,
                 test_merge, test_killed, test_resume, test_second_names, test_locked, test_full]
        named = [test for test in [*tests, test_million] if test.__name__[5:] in sys.argv[4:]]
        for test in named or tests:
            start = time.monotonic()
            test()
            print(f"{test.__name__}: {time.monotonic() - start:.1f} s", flush=True)


main()
