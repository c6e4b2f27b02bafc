#!/usr/bin/env python3
"""What a run opens: test_reach.py TOOL

strace tells every file that the tool opens and every server that it asks for. These are what the command line names, the
parts that formats have, and what libraries and caches are made of; written are OUT and caches. Prints what is beyond and
exits with 1 if anything is; with 77 where there is no strace or it may not look."""
import os
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "fixtures"))
sys.dont_write_bytecode = True
from made_files import shapefile, write  # noqa: E402

TOOL = os.path.realpath(sys.argv[1])
TMP = tempfile.mkdtemp(prefix="camber-reach-")
HOME = os.path.join(TMP, "home")
LINE = '{"type":"LineString","coordinates":[[0,0],[1,1]]}'
# Libraries, drivers and their settings; this process and the machine; what libraries look for in a home and do not find.
SYSTEM = re.compile(r"^(/usr/|/lib|/etc/(ld\.so|OpenCL/|localtime|nsswitch|passwd$|group$|ssl/|gdal|proj|drirc|glvnd|egl|fonts/)|/proc/|/sys/|"
                    r"/dev/(dri|shm|null|urandom|tty|kfd|nvidia)|/run/|/var/cache/fontconfig/|" + re.escape(HOME) + "/)")
OWN = [os.path.dirname(TOOL), *(os.environ[name] for name in ("XDG_CACHE_HOME", "POCL_CACHE_DIR", "CAMBER_KERNELS",
                                                              "MESA_SHADER_CACHE_DIR") if os.environ.get(name))]
# To ask whether a file is there opens nothing.
TRACED = "open,openat,execve,connect,socket,sendto,unlink,unlinkat,rename,renameat,renameat2,link,linkat,symlink,mkdir,mkdirat"
failures, checks = 0, 0
os.mkdir(HOME)
os.environ["HOME"] = HOME
# A leak checker cannot run under strace; the tests of leaks do without it.
os.environ["ASAN_OPTIONS"] = "detect_leaks=0:" + os.environ.get("ASAN_OPTIONS", "")


def style(source, **more):
    layer = '{"id":"a","type":"line","source":"s","paint":{"line-width":5%s}}' % more.get("paint", "")
    return '{"version":8,"center":[0,0],"zoom":0%s,"sources":{"s":{%s}},"layers":[%s]}' % (more.get("root", ""), source, layer)


def logged(name):
    db = sqlite3.connect(name)
    db.execute("CREATE TABLE metadata (name, value)")
    db.execute("CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)")
    db.execute("INSERT INTO tiles VALUES (0, 0, 0, x'%s')" % bytes([26, 9, 10, 5, *b"roads", 120, 2]).hex())
    db.commit()
    db.execute("PRAGMA journal_mode = wal")
    db.close()


def calls(trace):
    """What was called with which path and flags; calls that failed open nothing, but servers are told by asking."""
    begun = {}  # a call that another thread's interrupts is told in two halves
    for line in open(trace, errors="replace"):
        pid, _, told = line.strip().partition(" ")
        told = told.strip()
        if told.endswith("<unfinished ...>"):
            begun[pid] = told[:-len("<unfinished ...>")].rstrip()
            continue
        rest_of = re.match(r"<\.\.\. \w+ resumed>(.*)", told)
        if rest_of:
            told = begun.pop(pid, "") + rest_of.group(1)
        call = re.match(r"(\w+)\((.*)\) += (-?\d+)", told)
        if call:
            yield call.group(1), call.group(2), int(call.group(3))


def beyond(trace, folder, named):
    found = set()
    for name, rest, result in calls(trace):
        if name in ("connect", "socket", "sendto"):
            if re.search(r"AF_INET|sin_port", rest):
                found.add("network: " + rest)
            continue
        path = re.search(r'"([^"]*)"', rest)
        if not path or result < 0:
            continue
        full = os.path.normpath(os.path.join(folder, path.group(1)))
        writes = not name.startswith(("open", "exec")) or re.search(r"O_WRONLY|O_RDWR|O_CREAT", rest)
        if any(full.startswith(own) for own in OWN) or ("kernels-" in full and "/" not in path.group(1)):
            continue
        if writes and not full.startswith("/dev/") and os.path.basename(full) != "out.png" and ".camber-" not in full and \
                not full.startswith(HOME):
            found.add("written: " + full)
        if SYSTEM.match(full) or "O_DIRECTORY" in rest or full in (folder, "/"):
            continue
        if os.path.dirname(full) != folder or (os.path.basename(full) not in named and ".camber-" not in full):
            found.add(full)
    return found


def found_in(make, arguments, named):
    """The status, the words, and what was opened beyond what is named."""
    folder = tempfile.mkdtemp(dir=TMP)
    os.chdir(folder)
    make()
    trace = os.path.join(TMP, "trace")
    done = subprocess.run(["strace", "-f", "-qq", "-o", trace, "-e", "trace=" + TRACED, TOOL, "render", "-q",
                           "-o", "out.png", "--size", "64x64", *arguments], stdin=subprocess.DEVNULL, capture_output=True)
    return done.returncode, done.stderr.decode()[:200].strip(), beyond(trace, folder, {*named, "out.png"})


def case(name, make, arguments, named, status=0):
    global failures, checks
    checks += 1
    code, said, found = found_in(make, arguments, named)
    if code != status or found:
        failures += 1
        print("FAILED: %s: status %d: %s\n  %s" % (name, code, said, "\n  ".join(sorted(found))))


GRID = ('GEOGCS["x",DATUM["D",SPHEROID["W",6378137,298.25],EXTENSION["PROJ4_GRIDS","%s"]],PRIMEM["Greenwich",0],'
        'UNIT["Degree",0.0174532925199433]]' % os.path.join(TMP, "secret"))
write(os.path.join(TMP, "secret"), "root:x:0:0:\n")
if not shutil.which("strace") or subprocess.run(["strace", "-o", os.devnull, "true"], capture_output=True).returncode:
    print("skipped: no strace, or it may not look at processes")
    sys.exit(77)
case("GeoJSON", lambda: write("a.geojson", LINE), ["a.geojson"], ["a.geojson"])
case("a coordinate system on the network", lambda: write("a.geojson", '{"type":"FeatureCollection","crs":{"type":"link",'
     '"properties":{"href":"http://127.0.0.1:9/crs","type":"ogcwkt"}},"features":[{"type":"Feature","properties":{},'
     '"geometry":%s}]}' % LINE), ["a.geojson"], ["a.geojson"])
case("a VRT", lambda: (write("a.geojson", "<OGRVRTDataSource><OGRVRTLayer name='b'><SrcDataSource>b.geojson</SrcDataSource>"
     "</OGRVRTLayer></OGRVRTDataSource>"), write("b.geojson", LINE)), ["a.geojson"], ["a.geojson"], 65)
case("a VRT that is allowed", lambda: (write("a.geojson", "<OGRVRTDataSource><OGRVRTLayer name='b'><SrcDataSource>b.geojson"
     "</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>"), write("b.geojson", LINE)), ["a.geojson", "--allow-vrt"],
     ["a.geojson", "b.geojson"])
case("a VRT of the network that is allowed", lambda: write("a.vrt", "<OGRVRTDataSource><OGRVRTLayer name='b'><SrcDataSource>"
     "/vsicurl/http://127.0.0.1:9/b.geojson</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>"), ["a.vrt", "--allow-vrt"],
     ["a.vrt"], 65)
case("a server", lambda: write("a.xml", "<OGRWFSDataSource><URL>http://127.0.0.1:9/</URL></OGRWFSDataSource>"), ["a.xml"],
     ["a.xml"], 65)
case("a shapefile with a grid elsewhere", lambda: shapefile("a", GRID), ["a.shp"], ["a.shp", "a.shx", "a.prj"], 65)
case("a database at rest", lambda: logged("a.mbtiles"), ["a.mbtiles", "--layer", "roads"], ["a.mbtiles"])
case("a style", lambda: (write("a.geojson", LINE), write("s.json", style('"type":"geojson","data":"a.geojson"'))),
     ["--style", "s.json"], ["a.geojson", "s.json"])
case("a style that leads elsewhere", lambda: write("s.json", style('"type":"geojson","data":"../secret"')),
     ["--style", "s.json", "--root", "."], ["s.json"], 65)
case("a sprite elsewhere", lambda: write("s.json", style('"type":"geojson","data":' + LINE, root=',"sprite":"../secret"',
     paint=',"line-pattern":"x"')), ["--style", "s.json", "--root", "."], ["s.json"], 65)
LABELS = ('{"version":8,"glyphs":"g/{fontstack}/{range}.pbf","sources":{"s":{"type":"geojson","data":%s}},"layers":[{"id":"a",'
          '"type":"symbol","source":"s","layout":{"text-field":"x","text-font":["../../glyphs"]}}]}' % LINE)
os.mkdir(os.path.join(TMP, "glyphs"))
write(os.path.join(TMP, "glyphs", "0-255.pbf"), "SECRET")
case("a font whose name leads elsewhere", lambda: (os.mkdir("g"), write("s.json", LABELS)), ["--style", "s.json"], ["s.json"])
case("a style on the network", lambda: write("s.json", style('"type":"geojson","data":"http://127.0.0.1:9/a"')),
     ["--style", "s.json"], ["s.json"], 65)
# The check itself: what is read elsewhere is told.
os.chdir(TMP)
told = found_in(lambda: write("s.json", style('"type":"geojson","data":"../secret"')), ["--style", "s.json"], ["s.json"])[2]
if told != {os.path.join(TMP, "secret")}:
    failures += 1
    print("FAILED: a file elsewhere was read, and told is: %s" % told)
os.chdir("/")
shutil.rmtree(TMP)
print("%d checks, %d failed" % (checks, failures))
sys.exit(1 if failures else 0)
