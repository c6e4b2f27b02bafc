#!/usr/bin/env python3
"""Small files that ask for much: hostile.py TOOL

Each is made here and given to the tool, which refuses it or draws it: with the status and the words that are promised, one
line, within a gigabyte, and with nothing left behind; one that takes minutes of a processor is ended. Prints what failed;
exits with 1 if anything did."""
import gzip
import os
import resource
import shutil
import signal
import sqlite3
import struct
import subprocess
import sys
import tempfile
import threading

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "fixtures"))
sys.dont_write_bytecode = True
from made_files import shapefile, write  # noqa: E402

TOOL = os.path.realpath(sys.argv[1])
SANITIZED = b"__asan_init" in open(TOOL, "rb").read()
CPU_S, WALL_S = 120, 400  # which only a hang takes
MOST_BYTES = 10**9
LINE = '{"type":"LineString","coordinates":[[0,0],[1,1]]}'
failures, checks = [], 0
TMP = tempfile.mkdtemp(prefix="camber-hostile-")
os.chdir(TMP)
os.mkdir("tmp")
os.environ["TMPDIR"] = os.path.join(TMP, "tmp")


# ---- Making files ----

def varint(number):
    out = bytearray()
    while number > 127:
        out.append(number & 127 | 128)
        number >>= 7
    return bytes(out + bytes([number]))


def field(number, payload):
    return varint(number << 3 | 2) + varint(len(payload)) + payload


def tile(commands, features=1):
    """A vector tile whose layer "roads" has so many lines of these commands."""
    line = field(2, varint(3 << 3) + varint(2) + field(4, commands))
    return field(3, field(1, b"roads") + line * features + varint(5 << 3) + varint(4096) + varint(15 << 3) + varint(2))


def move_and_draw(points):
    return varint(9) + varint(0) + varint(0) + varint(points << 3 | 2) + b"\x02\x02" * points


def mbtiles(name, *statements, tiles=()):
    db = sqlite3.connect(name)
    db.execute("CREATE TABLE metadata (name, value)")
    db.execute("CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)")
    db.executemany("INSERT INTO tiles VALUES (?, ?, ?, ?)", tiles)
    for statement in statements:
        db.execute(statement)
    db.commit()
    db.close()


def pmtiles(name, zoom, entries, content):
    directory = varint(len(entries))
    before = 0
    for number, _, _, _ in entries:
        directory += varint(number - before)
        before = number
    for column in (1, 2):
        directory += b"".join(varint(entry[column]) for entry in entries)
    directory += b"".join(varint(entry[3] + 1) for entry in entries)
    metadata = b'{"vector_layers":[{"id":"roads"}]}'
    at = 127
    head = b"PMTiles\x03"
    for size in (len(directory), len(metadata), 0, len(content)):
        head += struct.pack("<QQ", at, size)
        at += size
    head += struct.pack("<QQQ", 1, 1, 1) + bytes([1, 1, 1, 1, zoom, zoom])
    with open(name, "wb") as file:
        file.write(head.ljust(127, b"\0") + directory + metadata + content)


def style(source, **more):
    """A style of one source, in JSON."""
    layer = '{"id":"a","type":"line","source":"s"%s,"paint":{"line-width":5%s}}' % (
        ',"source-layer":"roads"' if '"vector"' in source else "", more.get("paint", ""))
    return '{"version":8,"center":[0,0],"zoom":%d%s,"sources":{"s":{%s}},"layers":[%s]}' % (
        more.get("zoom", 0), more.get("root", ""), source, layer)


COUNT = "WITH RECURSIVE n(i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM n WHERE i < %d) "


# ---- Running ----

def limited(limits):
    def set_limits():
        for kind, amount in limits.items():
            resource.setrlimit(kind, (amount, amount))
    return set_limits


def run(arguments, limits, stdin):
    process = subprocess.Popen([TOOL, *arguments], stdin=stdin, stdout=subprocess.DEVNULL,
                               stderr=open("../stderr", "wb"), preexec_fn=limited({resource.RLIMIT_CPU: CPU_S, **limits}))
    timer = threading.Timer(WALL_S, process.kill)
    timer.start()
    _, status, used = os.wait4(process.pid, 0)
    timer.cancel()
    process.returncode = code = os.waitstatus_to_exitcode(status)
    with open("../stderr", "rb") as file:
        said = file.read().decode(errors="replace")
    return code, said, used.ru_utime + used.ru_stime, used.ru_maxrss * 1024


def case(name, make, arguments, status, words="", kept=(), limits=None, stdin=subprocess.DEVNULL):
    """make() fills an empty folder; arguments are the tool's, there; kept are files that may be there afterwards."""
    global checks
    checks += 1
    shutil.rmtree("work", ignore_errors=True)
    os.mkdir("work")
    os.chdir("work")
    make()
    names = set(os.listdir("."))
    before = {path: open(path, "rb").read() for path in sorted(os.listdir(".")) if os.path.isfile(path)}
    code, said, seconds, size = run([str(argument) for argument in arguments], limits or {}, stdin)
    wrong = []
    if code not in (status if isinstance(status, tuple) else (status,)):
        wrong.append("status %s, not %s" % (code, status))
    if code and (said.count("\n") != 1 or not said.startswith("camber: ")):
        wrong.append("not one line")
    if "SECRET" in said:
        wrong.append("quotes what it read")
    if words not in said:
        wrong.append("no word of '%s'" % words)
    if size > MOST_BYTES * (2 if SANITIZED else 1):
        wrong.append("%d MB" % (size // 10**6))
    left = set(os.listdir(".")) - names - {"out.png", *kept}
    if left:
        wrong.append("left: %s" % sorted(left))
    for path, content in before.items():
        if not os.path.isfile(path) or open(path, "rb").read() != content:
            wrong.append("changed: " + path)
    if os.listdir("../tmp"):
        wrong.append("left in TMPDIR: %s" % os.listdir("../tmp"))
    os.chdir("..")
    if wrong:
        failures.append(name)
        print("FAILED: %s: %s: %s" % (name, "; ".join(wrong), said.strip()[:300]))
    elif os.environ.get("CAMBER_VERBOSE"):
        print("%-40s %3d %5.2f s %4d MB  %s" % (name, code, seconds, size // 10**6, said.strip()[:150]))


RENDER = ["render", "-q", "-o", "out.png", "--size", "256x256"]


def refused(name, make, words, status=65, file="in", **more):
    case(name, make, [*RENDER, file], status, words, **more)


def styled(name, make, words, status=65, options=(), **more):
    case(name, make, [*RENDER, "--style", "style.json", *options], status, words, **more)


# ---- Databases ----

def views(name, words, *statements, status=65):
    refused(name, lambda: mbtiles("in.mbtiles", *statements), words, status, "in.mbtiles")


def replace(table, sql):
    return ["DROP TABLE " + table, "CREATE VIEW " + table + " AS " + sql]


ROW = "0 AS zoom_level, %s AS tile_column, 0 AS tile_row, x'1a00' AS tile_data"
views("metadata of gigabytes", "recursion", *replace("metadata", COUNT % 200 + "SELECT 'k' || i AS name, "
      "printf('%.*c', 60000000, 'x') AS value FROM n"))
views("a table without an end", "recursion", *replace("tiles", "WITH RECURSIVE n(i) AS (SELECT 0 UNION ALL SELECT i + 1 "
      "FROM n) SELECT " + ROW % "i" + " FROM n WHERE i < 0"))
views("two million tiles of nothing", "recursion", *replace("tiles", COUNT % 2000000 + "SELECT " + ROW % "i" + " FROM n"))
views("texts to sort by", "functions", *replace("tiles", "SELECT " + ROW % "cast(zeroblob(60000000) AS text)" +
      " FROM sqlite_master"))
views("a product of tables", "too many steps", "CREATE TABLE n (i)", "INSERT INTO n " + COUNT % 999 + "SELECT i FROM n",
      *replace("tiles", "SELECT " + ROW % "a.i" + " FROM n a, n b, n c, n d WHERE a.i + b.i + c.i + d.i < 0"))
views("more tiles than a run may read", "more than 262144 tiles", "CREATE TABLE n (i)",
      "INSERT INTO n " + COUNT % 999 + "SELECT i FROM n",
      *replace("tiles", "SELECT 12 AS zoom_level, a.i AS tile_column, b.i AS tile_row, x'1a00' AS tile_data FROM n a, n b"))
views("a pattern that takes for ever", "functions", *replace("tiles", "SELECT " + ROW % "0" +
      " FROM sqlite_master WHERE hex(zeroblob(1000000)) LIKE '%0%0%0%0%0%0%1'"))
views("an honest view", "", "CREATE TABLE map (z, x, y, id)", "CREATE TABLE images (data, id)",
      *replace("tiles", "SELECT z AS zoom_level, x AS tile_column, y AS tile_row, images.data AS tile_data FROM map JOIN "
               "images ON images.id = map.id"), "INSERT INTO map VALUES (0, 0, 0, 'a')",
      "INSERT INTO images VALUES (x'" + tile(move_and_draw(2)).hex() + "', 'a')", status=0)


def logged():
    mbtiles("in.mbtiles", "INSERT INTO tiles VALUES (0, 0, 0, x'%s')" % tile(move_and_draw(2)).hex())
    db = sqlite3.connect("in.mbtiles")
    db.execute("PRAGMA journal_mode = wal")
    db.close()


def interrupted():
    logged()
    db = sqlite3.connect("in.mbtiles")
    db.execute("INSERT INTO metadata VALUES ('a', 'b')")
    db.commit()
    shutil.copy("in.mbtiles-wal", "kept")
    db.close()
    os.rename("kept", "in.mbtiles-wal")


def hot():
    mbtiles("in.mbtiles")
    db = sqlite3.connect("in.mbtiles", isolation_level=None)
    db.execute("PRAGMA cache_size = 1")
    db.execute("BEGIN")
    for i in range(2000):
        db.execute("INSERT INTO metadata VALUES (?, 'x')", (str(i) * 50,))
    shutil.copy("in.mbtiles", "a")
    shutil.copy("in.mbtiles-journal", "b")
    db.execute("ROLLBACK")
    db.close()
    os.rename("a", "in.mbtiles")
    os.rename("b", "in.mbtiles-journal")


refused("a log beside a database", logged, "", 0, "in.mbtiles")
case("the same through GDAL", logged, [*RENDER, "--where", "a = 'b'", "in.mbtiles"], (0, 2, 65))
refused("a log without its writer", interrupted, "was interrupted", 65, "in.mbtiles")
for ending in ("gpkg", "sqlite", "mbtiles"):
    case("a log without its writer, through GDAL, " + ending, lambda: (interrupted(), os.rename("in.mbtiles-wal", "in." + ending +
         "-wal"), os.rename("in.mbtiles", "in." + ending)), [*RENDER, "in." + ending, "--where", "a = 'b'"], 65, "a log file next to it")
case("a virtual table", lambda: mbtiles("in.sqlite", "CREATE VIRTUAL TABLE v USING fts5(a)", "PRAGMA writable_schema = on",
     "UPDATE sqlite_master SET sql = 'CREATE VIRTUAL TABLE v USING VirtualText(''x.csv'')' WHERE name = 'v'"),
     [*RENDER, "in.sqlite"], 65, "virtual tables")
refused("a hot journal", hot, "was interrupted", 65, "in.mbtiles")
styled("a folder for a database", lambda: (os.mkdir("x.mbtiles"), write("style.json", style(
    '"type":"vector","url":"mbtiles://x.mbtiles"'))), "is a folder")

# ---- Tiles ----

dense = gzip.compress(tile(move_and_draw(12 * 10**6)), 9)
many = gzip.compress(tile(move_and_draw(2), 10**6), 9)
places = [(2, x, y, dense) for x in range(4) for y in range(4)]
styled("sixteen tiles of twelve million points", lambda: (
    mbtiles("x.mbtiles", tiles=places),
    write("style.json", style('"type":"vector","url":"mbtiles://x.mbtiles"', zoom=2))), "32 times what the file has",
    options=("--size", "2048x2048"))
refused("a million lines in one tile", lambda: mbtiles("in.mbtiles", tiles=[(0, 0, 0, many)]), "32 times", 65, "in.mbtiles")
for zoom in (9, 10, 12, 20):
    refused("one tile, %d zooms wide" % zoom, lambda: pmtiles(
        "in.pmtiles", zoom, [(0, 2**62, len(tile(b"")), 0)], tile(b"")), "" if zoom == 9 else "more than 262144 tiles",
        (0, 65) if zoom == 9 else 65, "in.pmtiles")
for ending, make in (("mbtiles", lambda: mbtiles("in.mbtiles", tiles=[(0, 0, 0, b"no tile")] * 3)),
                     ("pmtiles", lambda: pmtiles("in.pmtiles", 0, [(0, 1, 7, 0)], b"no tile"))):
    refused("every tile damaged, " + ending, make, "tile", 65, "in." + ending)

# ---- Devices and pipes ----

DATA = '"type":"geojson","data":"%s"'
styled("data of a device", lambda: write("style.json", style(DATA % "/dev/zero")), "a device or a pipe")
styled("data of a pipe", lambda: (os.mkfifo("pipe"), write("style.json", style(DATA % "pipe"))), "a device or a pipe")
styled("tiles of a pipe", lambda: (os.mkfifo("pipe"), write("style.json", style(
    '"type":"vector","tiles":["pipe"]'))), "a device or a pipe")
styled("a TileJSON of a pipe", lambda: (os.mkfifo("pipe"), write("style.json", style(
    '"type":"vector","url":"pipe"'))), "a device or a pipe")
styled("a sprite of a pipe", lambda: (os.mkfifo("s.png"), write("s.json", "{}"), write("style.json", style(
    '"type":"geojson","data":' + LINE, root=',"sprite":"s"', paint=',"line-pattern":"x"'))), "a device or a pipe")
for name in ("/dev/zero", "pipe"):
    refused("INPUT is " + name, lambda: os.mkfifo("pipe"), "a device or a pipe", 65, name)
    case("the style is " + name, lambda: os.mkfifo("pipe"), [*RENDER, "--style", name], 65, "a device or a pipe")

# ---- Files that a style may name ----

subprocess.run([TOOL, "render", "-q", "--style", "-", "-o", "one.png", "--size", "1x1"], check=True,
               input=style('"type":"geojson","data":' + LINE).encode())
STYLE_OUTSIDE = style(DATA % "../secret.geojson")
write("secret.geojson", "SECRET:x:0:0:" + LINE)
styled("a file that is no map", lambda: write("style.json", STYLE_OUTSIDE), "invalid JSON at line 1")
for name, path in (("there", "../secret.geojson"), ("not there", "../none"), ("a link", "link")):
    styled("beyond the root, " + name, lambda: (os.symlink("../secret.geojson", "link"), write(
        "style.json", style(DATA % path))), "a style may name files only there", options=("--root", "."))
styled("a sprite's index that is no map", lambda: (write("s.json", "{SECRET"), shutil.copy("../one.png", "s.png"), write(
    "style.json", style('"type":"geojson","data":' + LINE, root=',"sprite":"s"', paint=',"line-pattern":"x"'))), "line 1, column")
styled("within the root", lambda: (write("a.geojson", LINE), write("style.json", style(DATA % "a.geojson"))), "", 0,
       options=("--root", "."))
styled("tiles within the root that are not there", lambda: write("style.json", style(
    '"type":"vector","tiles":["t/{z}/{x}/{y}.pbf"]')), "", 0, options=("--root", "."))
styled("tiles beyond the root", lambda: write("style.json", style('"type":"vector","tiles":["../{z}/{x}/{y}.pbf"]')),
       "only there", options=("--root", "."))
LABELS = '{"version":8,"zoom":0,"glyphs":"../{fontstack}/{range}.pbf","sources":{"s":{"type":"geojson","data":' + LINE + \
    '}},"layers":[{"id":"a","type":"symbol","source":"s","layout":{"text-field":"x","text-font":["f"]}}]}'
styled("glyphs beyond the root", lambda: write("style.json", LABELS), "only there", options=("--root", "."))

# ---- Files that OUT may be ----

for name, out in (("a source", "a.geojson"), ("a link to a source", "link")):
    case("OUT is " + name, lambda: (write("a.geojson", LINE), os.symlink("a.geojson", "link"), write(
        "style.json", style(DATA % "a.geojson"))), ["render", "-qf", "--style", "style.json", "-o", out, "--format", "png"],
        2, "a.geojson")
case("OUT is the style", lambda: write("style.json", style('"type":"geojson","data":' + LINE)),
     ["render", "-qf", "--style", "style.json", "-o", "style.json", "--format", "png"], 2, "style.json")
case("OUT is the INPUT behind a prefix", lambda: write("in.geojson", LINE),
     ["render", "-qf", "GeoJSON:in.geojson", "-o", "in.geojson", "--format", "png"], 2, "in.geojson")
case("a dump is a source", lambda: (write("a.geojson", LINE), write("style.json", style(DATA % "a.geojson"))),
     ["bench", "-q", "--style", "style.json", "--dump", "a.geojson", "-f"], 2, "a.geojson")
case("OUT is the INPUT", lambda: write("in.geojson", LINE),
     ["render", "-qf", "in.geojson", "-o", "in.geojson", "--format", "png"], 2, "in.geojson")

# ---- Files that lead elsewhere ----

VRT = "<OGRVRTDataSource><OGRVRTLayer name='a'><SrcDataSource>%s</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>"
GRID = ('GEOGCS["x",DATUM["D",SPHEROID["W",6378137,298.25]%s],PRIMEM["Greenwich",0],UNIT["Degree",0.0174532925199433]]'
        % ',EXTENSION["PROJ4_GRIDS","/etc/passwd"]')
for name in ("in.vrt", "in.geojson"):
    refused("a VRT named " + name, lambda: (write(name, VRT % "a.geojson"), write("a.geojson", LINE)), "--allow-vrt", 65, name)
    case("the same, allowed", lambda: (write(name, VRT % "a.geojson"), write("a.geojson", LINE)),
         [*RENDER, name, "--allow-vrt"], 0)
refused("a server", lambda: write("in.xml", "<OGRWFSDataSource><URL>http://127.0.0.1:9/</URL></OGRWFSDataSource>"),
        "--allow-remote", 65, "in.xml")
refused("an address", lambda: None, "--allow-remote", 65, "http://127.0.0.1:9/a.geojson")
refused("a database's address", lambda: None, "--allow-remote", 65, "PG:host=127.0.0.1 port=9")
refused("a grid of a shapefile", lambda: shapefile("in", GRID), "refers to another file", 65, "in.shp")
DOCTYPE = '<?xml version="1.0"?><!DOCTYPE TRANSFER SYSTEM "%s"><TRANSFER xmlns="http://www.interlis.ch/INTERLIS2.3"/>'
for ending in ("xtf", "xml", "gml"):
    refused("a DOCTYPE that is a pipe, " + ending, lambda: (os.mkfifo("pipe"), write("in." + ending, DOCTYPE % os.path.realpath(
        "pipe"))), "", 65, "in." + ending)
refused("a table of tables", lambda: write("in.tab", '!table\n!version 300\nDefinition Table\nopen table "b.tab"\n'),
        "refers to another file", 65, "in.tab")
refused("an ordinary shapefile", lambda: shapefile("in", GRID.replace(',EXTENSION["PROJ4_GRIDS","/etc/passwd"]', "")), "", 0,
        "in.shp")

# ---- Memory ----

# Packed as small as it gets, two megabytes: what a reader may take follows the file's size.
def bomb(head=b"", name="in.geojson.gz"):
    with gzip.open(name, "wb", 9) as file:
        file.write(head)
        for _ in range(2048):
            file.write(b" " * 2**20)


refused("properties that take longer and longer", lambda: write("in.geojson", '{"type":"Feature","geometry":%s,"properties":{%s}}' % (
    LINE, ",".join('"k%d":1' % i for i in range(150000)))), "reading it has taken 8 s", 65, "in.geojson")
refused("two gigabytes of blanks", bomb, "", 65, "in.geojson.gz")
refused("two gigabytes of XML's blanks", lambda: bomb(b"<osm version='0.6'>", "in.osm.gz"), "", 65, "in.osm.gz")
styled("thirty million arrays", lambda: (write("a.geojson", '{"type":"LineString","coordinates":[' + "[]," * 10**7 + "[]]}"),
                                         write("style.json", style(DATA % "a.geojson"))), "memory: ", 70,
       options=("--memory", "128M"))
case("more lines than memory", lambda: write("in.geojson", '{"type":"MultiLineString","coordinates":[' + ",".join(
    "[[%d,1],[2,%d]]" % (i % 90, i % 80) for i in range(10**6)) + "]}"), [*RENDER, "in.geojson", "--memory", "256K"], 70, "memory")
case("too little memory to ask for", lambda: write("in.geojson", LINE), [*RENDER, "in.geojson", "--memory", "64K"], 2, "--memory")
case("little memory", lambda: write("in.geojson", LINE), [*RENDER, "in.geojson", "--memory", "256K"], 0)
if not SANITIZED:  # which wants all of the address space
    for megabytes in (60, 100, 200, 400, 600, 800, 1000, 2000):
        case("an address space of %d MB" % megabytes, lambda: write("in.geojson", LINE), [*RENDER, "in.geojson"], (0, 70),
             "" if megabytes == 2000 else "memory", limits={resource.RLIMIT_AS: megabytes * 10**6})
for files in (5, 8, 12, 18):
    case("%d open files" % files, lambda: write("in.geojson", LINE), [*RENDER, "in.geojson"], 74, "too many open files",
         limits={resource.RLIMIT_NOFILE: files})
case("40 open files", lambda: write("in.geojson", LINE), [*RENDER, "in.geojson"], 0, limits={resource.RLIMIT_NOFILE: 40})

# ---- Lines in one place ----

for name, points in (("twice the same point", "[5,5],[5,5]"), ("a line at the pole", "[0,90],[0,89]")):
    refused(name, lambda: write("in.geojson", LINE.replace("[0,0],[1,1]", points)), "", 0, "in.geojson")

# ---- The files of who attacked, where they are at hand ----

folder = os.path.join(os.environ.get("CAMBER_DATA", ""), "attack")
if os.environ.get("CAMBER_DATA") and os.path.isdir(folder):
    for name in sorted(os.listdir(folder)):
        path = os.path.join(os.path.realpath(folder), name)
        if name.endswith((".mbtiles", ".pmtiles", ".geojson", ".vrt", ".xml")):
            refused(name, lambda: shutil.copy(path, name), "", (0, 65), name)
        elif name.startswith("x_") and name.endswith(".json"):
            case(name, lambda: [shutil.copy(os.path.join(folder, other), other) for other in os.listdir(folder)] and
                 os.mkfifo("v_fifo.geojson"), [*RENDER, "--style", name, "--size", "2048x2048"], 65)
        elif name.endswith(".lines"):
            case(name, lambda: shutil.copy(path, name), ["validate", "-q", "--polylines", name], 0)
else:
    print("skipped: the attacker's own files: CAMBER_DATA names no folder that has them")

os.chdir("/")
shutil.rmtree(TMP)
print("%d checks, %d failed" % (checks, len(failures)))
sys.exit(1 if failures else 0)
