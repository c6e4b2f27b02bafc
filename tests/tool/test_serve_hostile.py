#!/usr/bin/env python3
"""camber serve against those who mean it ill: clients that drop what they begin or read nothing, few descriptors, inputs
that cannot be read again, archives that lead elsewhere, damaged files of the cache.

    test_serve_hostile.py TOOL [NAME...]

TOOL is camber. NAME...: these tests alone. Needs Python's standard library alone. Exit status 1: the first failure, on
standard error; 77: the tool has no server.
"""

import json
import os
import resource
import signal
import socket
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(TESTS, "fixtures"))

from served import COLUMN, PATIENCE_S, ROW, TOOL, ZOOM, Server, expect, run_tests, is_sanitized, wait_until, write_map  # noqa: E402

TILE = f"/{ZOOM}/{COLUMN}/{ROW}.png"
AT_ONCE_S = 25  # half a minute is what a client has that says nothing


def processor_s(process):
    with open(f"/proc/{process.pid}/stat", encoding="ascii") as file:
        words = file.read().rsplit(")", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def is_idle(process):
    """Whether it leaves a core alone for a second, however busy it was before."""
    worked, start = processor_s(process), time.monotonic()
    time.sleep(1)
    return processor_s(process) - worked < 0.3 * (time.monotonic() - start)


# ---- HTTP ----


def test_arguments():
    """More arguments than a request's memory holds: the request is refused, and nothing of it stays."""
    write_map("map.json")
    server = Server("map.json")

    def ask(count):
        for i in range(count):
            with server.open() as made:
                made.sendall(b"GET /?" + (b"&", b"%41&")[i % 2] * 300 + b" HTTP/1.1\r\n\r\n")
                made.recv(1)  # one after another: many at once take memory, which may stay

    ask(1000)
    wait_until(lambda: server.metric("connections") <= 30, "connections stay")
    expect(server.metric("requests_in_flight") == 1, f"in flight: {server.metric('requests_in_flight')}")  # this one
    before = server.resident()
    ask(6000)
    wait_until(lambda: server.metric("connections") <= 30, "connections stay")
    expect(server.metric("requests_in_flight") == 1, f"in flight: {server.metric('requests_in_flight')}")
    expect(is_sanitized() or server.resident() < before + (2 << 20), f"{server.resident() - before} bytes stay")
    made = server.open()  # half a request is none that the end waits for
    made.sendall(b"GET " + TILE.encode() + b" HTTP/1.1\r\nHost: x\r\n")
    time.sleep(0.2)
    start = time.monotonic()
    server.stop()
    expect(time.monotonic() - start < AT_ONCE_S, f"SIGTERM takes {time.monotonic() - start:.1f} s")
    made.close()


def test_absolute():
    """A request's target may name a server before the path, which proxies do (RFC 9112, 3.2.2)."""
    write_map("map.json")
    server = Server("map.json", "-v")
    wanted = server.get(TILE)[2]
    for start in ("http://127.0.0.1", "http://example.org:80", "HTTPS://[::1]:443"):
        expect(server.get(start + TILE)[::2] == (200, wanted), start)
        expect(server.get(start)[::2] == server.get("/")[::2] and server.get(start + "?a")[0] == 200, start + ": the page")
    for path in ("http://", "http:///" + TILE, "http:/" + TILE, "ftp://x" + TILE, "http://x/nothing", "http://x//" + TILE):
        expect(server.get(path)[0] == 404, path)
    server.stop()
    paths = [json.loads(line)["path"] for line in server.errors if line.startswith("{")] # of several threads, in any order
    expect("http://" in paths, paths)


def test_bounds():
    write_map("map.json")
    server = Server("map.json")
    for latitude in ("85.06", "-85.06", "90", "-90", "85.0512"):
        expect(server.get(f"/static/0,{latitude},2/9x9.png")[0] in (400, 404), latitude)
    for latitude in ("85.051129", "-85.051128", "85"):
        expect(server.get(f"/static/0,{latitude},2/9x9.png")[0] == 200, latitude)
    server.stop()
    subprocess.run([TOOL, "tiles", "map.json", "-o", "a.mbtiles", "-q", "--max-zoom", "3"], check=True, timeout=PATIENCE_S)
    for low, high, center in (("-5", "99", "9.1,55.2,99"), ("77", "99", "9.1,55.2,-3")):
        with sqlite3.connect("a.mbtiles") as made:
            for name, value in (("minzoom", low), ("maxzoom", high), ("center", center)):
                made.execute("UPDATE metadata SET value = ? WHERE name = ?", (value, name))
        made.close()
        server = Server("a.mbtiles")
        about = json.loads(server.get("/tiles.json")[2])
        expect(0 <= about["minzoom"] <= about["maxzoom"] <= 24 and 0 <= about["center"][2] <= 24, about)
        server.stop()


# ---- Descriptors ----


def test_descriptors():
    """Idle connections leave descriptors to the drivers, however few there are."""
    write_map("map.json")
    os.mkdir("tiles")
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    for most, options in ((100, ()), (200, ("--renderd", "socket", "--cache-dir", "tiles"))):
        server = Server("map.json", *options, wrapper=("sh", "-c", f'ulimit -n {most}; exec "$@"', "sh"))
        made = [server.open() for _ in range(400)]
        if options:
            for _ in range(100):
                one = socket.socket(socket.AF_UNIX)
                one.settimeout(0.1)
                made.append(one)
                try:
                    one.connect("socket")
                except OSError:  # the queue of those that it has not accepted is full
                    break
        time.sleep(0.5)
        held = len(os.listdir(f"/proc/{server.process.pid}/fd"))
        expect(held < most - 25, f"{held} of {most} descriptors are used by clients that say nothing")
        start = time.monotonic()
        while not is_idle(server.process):  # while these clients are there
            expect(time.monotonic() - start < AT_ONCE_S, f"with ulimit -n {most} it works for nothing")
        for one in made:
            one.close()
        expect(server.get(f"/{ZOOM}/{COLUMN + 1}/{ROW}@4x.webp")[0] == 200, "it does not answer any more")
        server.stop()
    expect(resource.getrlimit(resource.RLIMIT_NOFILE) == before, "the limit is that of another process")
    done = subprocess.run(["sh", "-c", 'ulimit -n 20; exec "$@"', "sh", TOOL, "serve", "map.json", "--listen", "127.0.0.1:0"],
                          capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    expect(done.returncode == 74 and "ulimit -n" in done.stderr, f"{done.returncode} {done.stderr}")


# ---- mod_tile ----


def renderd_message(zoom, x, y, command=1):
    return struct.pack("=5i41s41s41sx", 3, command, x, y, zoom, b"default", b"image/png", b"")


def connect(path):
    made = socket.socket(socket.AF_UNIX)
    made.settimeout(PATIENCE_S)
    made.connect(path)
    return made


def ask_renderd(made, message):
    made.sendall(message)
    back = b""
    while len(back) < len(message):
        some = made.recv(len(message) - len(back))
        if not some:
            return None
        back += some
    return struct.unpack_from("=5i", back)[1]


def test_renderd_clients():
    """One that reads nothing does not stop the end; those that say nothing make room for one that does."""
    write_map("map.json")
    os.mkdir("tiles")
    server = Server("map.json", "--renderd", "socket", "--cache-dir", "tiles")
    deaf, refused = connect("socket"), renderd_message(21, 0, 0)
    deaf.setblocking(False)
    end = time.monotonic() + 2
    while time.monotonic() < end:
        try:
            deaf.send(refused * 10)
        except BlockingIOError:
            time.sleep(0.01)
    good = connect("socket")
    expect(ask_renderd(good, renderd_message(ZOOM, COLUMN, ROW)) == 3, "another client is not answered")
    silent = [connect("socket") for _ in range(62)]
    time.sleep(1.5)
    expect(ask_renderd(good, refused) == 4, "one that speaks has gone")
    for i in range(3):
        with connect("socket") as late:
            expect(ask_renderd(late, refused) == 4, f"silent clients lock number {i} out")
    expect(ask_renderd(good, refused) == 4, "one that speaks has gone for those that do not")
    start = time.monotonic()
    server.stop()
    expect(time.monotonic() - start < AT_ONCE_S, f"SIGTERM takes {time.monotonic() - start:.1f} s")
    for one in (deaf, good, *silent):
        one.close()


# ---- Reading again ----


def varint(number):
    made = b""
    while number > 127:
        made += bytes([number & 127 | 128])
        number >>= 7
    return made + bytes([number])


def zigzag(number):
    return varint(number << 1 if number >= 0 else -number * 2 - 1)


def field(number, body):
    return varint(number << 3 | 2) + varint(len(body)) + body


def blob(kind, body):
    made = field(1, body)
    head = field(1, kind) + b"\x18" + varint(len(made))
    return struct.pack(">I", len(head)) + head + made


def block(group, *strings):
    return blob(b"OSMData", field(1, b"".join(field(1, text) for text in (b"", *strings))) + field(2, group))


def write_pbf(path, count, groups, *strings):
    """So many nodes in a row, and then groups of ways and relations."""
    with open(path, "wb") as file:
        file.write(blob(b"OSMHeader", field(4, b"OsmSchema-V0.6") + field(4, b"DenseNodes")))
        for first in range(0, count, 8000):
            ids, latitudes = zigzag(first + 1) + zigzag(1) * 7999, zigzag(552000000) + (zigzag(20) + zigzag(-21)) * 3999 + b"\0"
            longitudes = zigzag(91000000 + first) + zigzag(1) * 7999
            file.write(block(field(2, field(1, ids) + field(8, latitudes) + field(9, longitudes))))
        for group in groups:
            file.write(block(group, *strings))


def write_hanging(path):
    """A way of many places, and thousands of relations that name it, take a reader minutes."""
    count = 320000
    groups = [field(3, b"\x08\x01" + field(8, zigzag(1) + zigzag(1) * (count - 1) + zigzag(1 - count)))]
    for first in range(0, 20000, 5000):
        groups.append(b"".join(field(4, b"\x08" + varint(i + 1) + field(2, b"\x01\x03") + field(3, b"\x02\x04") +
                                     field(8, b"\x05") + field(9, zigzag(1)) + field(10, b"\x01"))
                               for i in range(first, first + 5000)))
    write_pbf(path, count, groups, b"type", b"multipolygon", b"natural", b"water", b"outer")


def write_heavy(path, count):
    """Roads of so many points."""
    groups = [field(3, b"\x08" + varint(first + 1) + field(2, b"\x01") + field(3, b"\x02") +
                    field(8, zigzag(first + 1) + zigzag(1) * 7999)) for first in range(0, count, 8000)]
    write_pbf(path, count, groups, b"highway", b"primary")


def read_again(server, wanted, seconds=PATIENCE_S):
    """SIGHUP; returns the lines that it made it say, up to the one that is wanted."""
    before = len(server.errors)
    server.process.send_signal(signal.SIGHUP)
    end = time.monotonic() + seconds
    while not any(wanted in line for line in server.errors[before:]):
        expect(server.process.poll() is None, f"SIGHUP has ended it: {server.process.returncode} {server.errors}")
        expect(time.monotonic() < end, f"SIGHUP has no {wanted}: {server.errors}")
        time.sleep(0.05)
    time.sleep(0.3)
    return [line for line in server.errors[before:] if line.startswith("camber: ") and "warning" not in line]


def test_reload_hangs():
    """An input that would take a reader minutes is refused: what was read before stays."""
    write_map("map.json")
    write_hanging("hang.pbf")
    os.symlink("map.json", "map")
    server = Server("map")
    wanted = server.get(TILE)[2]
    os.unlink("map")
    os.symlink("hang.pbf", "map")
    said = read_again(server, "name their ways")
    expect(len(said) == 1, said)
    expect(server.get(TILE)[::2] == (200, wanted) and server.get("/health")[0] == 200, "what was served is gone")
    os.unlink("map")
    os.symlink("map.json", "map")
    write_map("map.json", seed=2)
    server.process.send_signal(signal.SIGHUP)
    wait_until(lambda: server.get(TILE)[2] != wanted, f"nothing is read any more: {server.errors}")
    os.unlink("map")
    os.symlink("hang.pbf", "map")
    server.process.send_signal(signal.SIGHUP)
    time.sleep(1.5)
    start = time.monotonic()
    server.stop()
    expect(time.monotonic() - start < AT_ONCE_S, f"SIGTERM takes {time.monotonic() - start:.1f} s while it reads")


def test_reload_memory():
    """Two readings that do not fit into --memory together: the second fails alone, again and again."""
    write_map("map.json")
    write_heavy("heavy.pbf", 2400000)
    os.symlink("heavy.pbf", "map")
    server = Server("map", "--memory", "128M")
    wanted = server.get(TILE)[2]
    for _ in range(3):
        said = read_again(server, "--memory")
        expect(len(said) == 1 and "allow" in said[0], said)
        expect(server.get(TILE)[::2] == (200, wanted), "what was served is gone")
    os.unlink("map")
    os.symlink("map.json", "map")
    server.process.send_signal(signal.SIGHUP)
    wait_until(lambda: server.get(TILE)[2] != wanted, f"nothing is read any more: {server.errors}")
    server.stop()


# ---- Archives and folders ----


def test_links():
    """A folder of tiles leads to no other file, neither by a tile nor by what lies above it."""
    write_map("map.json")
    with open("secret", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\nsecret")
    os.mkdir("far")
    os.link("secret", f"far/{ROW}.png")
    subprocess.run([TOOL, "tiles", "map.json", "-o", "a/", "-q", "--min-zoom", str(ZOOM), "--max-zoom", str(ZOOM)], check=True,
                   timeout=PATIENCE_S)
    tile = f"a/{ZOOM}/{COLUMN}/{ROW}.png"
    os.symlink("a", "named")  # whoever names the folder may do so by a link
    server = Server("named/")
    wanted = server.get(TILE)[2]
    expect(wanted.startswith(b"\x89PNG"), "a folder by a link")
    server.stop()
    for path, target in ((tile, os.path.abspath("secret")), (os.path.dirname(tile), os.path.abspath("far")),
                         (f"a/{ZOOM}", os.path.abspath("far"))):
        os.rename(path, "kept")
        os.symlink(target, path)
        server = Server("a/")
        status, _, body = server.get(TILE)
        expect(status in (204, 404, 500) and b"secret" not in body, f"{path}: {status} {body[:20]}")
        server.stop()
        for command in (("tiles", "merge", "a/", "-o", "out.pmtiles"), ("tiles", "verify", "a/")):
            done = subprocess.run([TOOL, *command], capture_output=True, text=True, timeout=PATIENCE_S, check=False)
            expect(done.returncode == (65 if "merge" in command else 1) and "link" in done.stderr and
                   not os.path.exists("out.pmtiles"), f"{command}: {done.returncode} {done.stderr}")
        os.unlink(path)
        os.rename("kept", path)
    os.rename("a/metadata.json", "kept")
    os.symlink(os.path.abspath("kept"), "a/metadata.json")
    done = subprocess.run([TOOL, "tiles", "show", "a/"], capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    expect(done.returncode == 65 and "link" in done.stderr, f"metadata: {done.returncode} {done.stderr}")


def test_tileset_links():
    write_map("map.json")
    done = subprocess.run([TOOL, "tiles", "map.json", "-o", "m/", "-q", "--format", "glb", "--max-zoom", "9"],
                          capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    if "this build writes no mesh tiles" in done.stderr:
        print("test_tileset_links: no meshoptimizer: skipped")
        return
    with open("secret", "wb") as file:
        file.write(b"secret")
    for name in ("tileset.json", "subtrees/0.0.0.subtree"):
        os.rename("m/" + name, "kept")
        os.symlink(os.path.abspath("secret"), "m/" + name)
        server = Server("m/")
        status, _, body = server.get("/" + name)
        expect(status == 404 and b"secret" not in body, f"{name}: {status} {body}")
        server.stop()
        os.unlink("m/" + name)
        os.rename("kept", "m/" + name)


def stored_tiles(folder):
    return sorted(os.path.join(where, name) for where, _, files in os.walk(folder) for name in files)


def test_damaged_cache():
    """A file of --cache-dir that is not what was written is drawn anew."""
    write_map("map.json")
    os.mkdir("tiles")
    paths = [TILE, f"/{ZOOM}/{COLUMN}/{ROW}.webp", f"/{ZOOM}/{COLUMN + 1}/{ROW}.png", f"/{ZOOM}/{COLUMN}/{ROW}@2x.png"]
    server = Server("map.json", "--cache-dir", "tiles")
    first = [server.get(path)[2] for path in paths]
    server.stop()
    files = stored_tiles("tiles")
    expect(len(files) == 4, files)
    with open("secret", "wb") as file:
        file.write(b"secret" * 99)
    with open(files[0], "r+b") as file:
        file.write(b"garbage" * 20)
    with open(files[1], "r+b") as file:
        file.truncate(os.path.getsize(files[1]) - 40)
    with open(files[2], "r+b") as file:
        file.seek(os.path.getsize(files[2]) // 2)
        byte = file.read(1)
        file.seek(-1, os.SEEK_CUR)
        file.write(bytes([byte[0] ^ 1]))
    os.rename(files[3], "kept")
    os.symlink(os.path.abspath("kept"), files[3])
    server = Server("map.json", "--cache-dir", "tiles")
    expect([server.get(path)[2] for path in paths] == first, "what is damaged is served")
    expect(server.metric("cache_folder_hits_total") == 0, "what is damaged counts as a tile")
    server.stop()
    server = Server("map.json", "--cache-dir", "tiles")
    expect([server.get(path)[2] for path in paths] == first, "what was damaged has changed")
    expect(server.metric("cache_folder_hits_total") == 4, f"hits: {server.metric('cache_folder_hits_total')} of 4 that were damaged")
    server.stop()


run_tests(globals())
