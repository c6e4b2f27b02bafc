#!/usr/bin/env python3
"""Loads camber serve, and beside it Debian's mod_tile with renderd, by wrk -t2 -c16 over loopback.

    serve_load.py FOLDER TOOL CITY STYLE XML SECONDS START WHAT,...

TOOL is camber; it draws CITY in STYLE, as renderd draws XML. FOLDER takes all files. Tiles are of 256 px at zooms 12 to
16, at random places of the city's box; each is asked for once while a server is new: the first thousand, of which few
are beside each other, and all that there are. START is a larger file whose first
tile is waited for. WHAT is camber, behind (camber behind mod_tile), renderd (the same), memory, start. Prints a line of
JSON, without what needs a program that is not here: apache2 with mod_tile, renderd. Exit status 77: no wrk.
"""

import glob
import http.client
import json
import math
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import time

FOLDER, TOOL, CITY, STYLE, XML = sys.argv[1:6]
SECONDS, START, WANTED = int(sys.argv[6]), sys.argv[7], sys.argv[8].split(",")
HERE = os.path.dirname(os.path.abspath(__file__))
MODULES = "/usr/lib/apache2/modules"
ZOOMS = range(12, 17)
FIRST_TILES = 1000
CACHED_TILES = 500
FEW, MANY = 10**4, 10**6  # requests before memory is looked at
KEPT_TILES, NEW_SHARE = 300, 0.02
STARTS = 5


def find_port():
    with socket.socket() as made:
        made.bind(("127.0.0.1", 0))
        return made.getsockname()[1]


def place(zoom, longitude, latitude):
    north = math.asinh(math.tan(math.radians(latitude)))
    return int((longitude + 180) / 360 * 2**zoom), int((1 - north / math.pi) / 2 * 2**zoom)


def make_paths():
    """Different tiles, in the order in which random places and zooms find them."""
    source, paths = random.Random(1), {}
    port, server = start_camber("--style", STYLE)
    west, south, east, north = json.loads(ask(port, "/tiles.json")[1])["bounds"]
    server.stop()
    for _ in range(200000):
        zoom = source.choice(ZOOMS)
        column, row = place(zoom, source.uniform(west, east), source.uniform(south, north))
        paths[f"/{zoom}/{column}/{row}.png"] = True
    return list(paths)


def write_paths(name, paths, prefix=""):
    path = os.path.join(FOLDER, name)
    with open(path, "w", encoding="ascii") as file:
        file.writelines(prefix + one + "\n" for one in paths)
    return path


def ask(port, path):
    made = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    made.request("GET", path)
    answer = made.getresponse()
    body = answer.read()
    made.close()
    return answer, body


def load(port, paths, seconds, how="again", etag=None, servers=()):
    """What wrk counted, and the processors' time of the servers. how: once, each path and no more, or again and again."""
    used = sum(server.cpu_ms() for server in servers)
    done = subprocess.run(["wrk", "-t2", "-c16", f"-d{seconds}s", "--timeout", "60s", "-s",
                           os.path.join(HERE, "serve_paths.lua"), f"http://127.0.0.1:{port}", "--", paths, how,
                           *([etag] if etag else [])], capture_output=True, text=True, check=True)
    said = json.loads(done.stdout.splitlines()[-1])
    return {"a_second": said["requests"] / said["seconds"], "p50_ms": said["p50_ms"], "p99_ms": said["p99_ms"],
            "requests": said["requests"], "failed": said["failed"],
            "cpu_ms": (sum(server.cpu_ms() for server in servers) - used) / max(said["requests"], 1)}


class Process:
    """A server, until what tells whether it is ready does."""

    def __init__(self, is_ready, *command):
        with open(os.path.join(FOLDER, os.path.basename(command[0]) + ".log"), "wb") as log:
            self.process = subprocess.Popen(command, stdout=log, stderr=log, cwd=FOLDER)
        end = time.monotonic() + 60
        while not is_ready():
            if self.process.poll() is not None or time.monotonic() > end:
                self.process.kill()
                sys.exit(f"{command[0]}: it does not get ready; {log.name} says why")
            time.sleep(0.001)

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(timeout=30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def cpu_ms(self):
        """Of the process and its children, Apache's workers among them."""
        with open(f"/proc/{self.process.pid}/task/{self.process.pid}/children", encoding="ascii") as file:
            processes = [str(self.process.pid), *file.read().split()]
        ticks = 0
        for process in processes:
            with open(f"/proc/{process}/stat", encoding="ascii") as file:
                ticks += sum(map(int, file.read().rsplit(")", 1)[1].split()[11:13]))
        return 1e3 * ticks / os.sysconf("SC_CLK_TCK")

    def resident(self):
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")


def answers(port, path):
    try:
        return ask(port, path)[0].status == 200
    except OSError:
        return False


def start_camber(*options, city=CITY, ready="/health"):
    port = find_port()
    return port, Process(lambda: answers(port, ready), TOOL, "serve", city, "-q", "--listen", f"127.0.0.1:{port}", *options)


def measure_camber(paths):
    port, server = start_camber("--style", STYLE)
    made = {"first": load(port, write_paths("new.txt", paths[:FIRST_TILES]), SECONDS, "once", None, [server])}
    server.stop()
    port, server = start_camber("--style", STYLE)
    made["all"] = load(port, write_paths("new.txt", paths), SECONDS, "once", None, [server])
    some = paths[:CACHED_TILES]
    for path in some:
        ask(port, path)
    made["cached"] = load(port, write_paths("cached.txt", some), SECONDS)
    etag = ask(port, some[0])[0].headers["ETag"]
    made["known"] = load(port, write_paths("known.txt", some[:1] * 2), SECONDS, "again", etag)
    server.stop()
    return made


# ---- mod_tile ----


def start_apache(metatiles):
    port = find_port()
    with open(os.path.join(FOLDER, "apache.conf"), "w", encoding="utf-8") as file:
        modules = "".join(f"LoadModule {name}_module {MODULES}/mod_{name}.so\n" for name in ("mpm_event", "authz_core", "tile"))
        file.write(f"""ServerRoot {FOLDER}
ServerName localhost
PidFile {FOLDER}/apache.pid
ErrorLog {FOLDER}/apache.log
DefaultRuntimeDir {FOLDER}
{modules}Listen 127.0.0.1:{port}
KeepAlive On
MaxKeepAliveRequests 0
<VirtualHost *:{port}>
ModTileTileDir {metatiles}
ModTileRenderdSocketName {FOLDER}/renderd.sock
ModTileRequestTimeout 60
ModTileMissingRequestTimeout 60
ModTileMaxLoadOld 1000
ModTileMaxLoadMissing 1000
AddTileConfig /t/ lines
</VirtualHost>
""")
    return port, Process(lambda: answers(port, "/t/0/0/0.png"), "apache2", "-DFOREGROUND", "-f", FOLDER + "/apache.conf")


def start_renderd(metatiles):
    plugins = glob.glob("/usr/lib/mapnik/*/input") + glob.glob("/usr/lib/*/mapnik/*/input")
    with open(os.path.join(FOLDER, "renderd.conf"), "w", encoding="utf-8") as file:
        file.write(f"""[renderd]
socketname={FOLDER}/renderd.sock
stats_file={FOLDER}/renderd.stats
pid_file={FOLDER}/renderd.pid
num_threads=2
tile_dir={metatiles}
[mapnik]
plugins_dir={plugins[0]}
font_dir=/usr/share/fonts
font_dir_recurse=false
[lines]
URI=/t/
XML={XML}
TYPE=png image/png png32:z=1
MAXZOOM=20
""")
    return Process(lambda: os.path.exists(FOLDER + "/renderd.sock"), "renderd", "-f", "-c", FOLDER + "/renderd.conf")


class ModTile:
    """Apache with mod_tile before renderd or camber; nothing is kept of what was before."""

    def __init__(self, by_camber):
        self.metatiles = os.path.join(FOLDER, "metatiles")
        os.mkdir(self.metatiles)
        if by_camber:
            options = ("--renderd", FOLDER + "/renderd.sock", "--cache-dir", self.metatiles)
            self.behind = start_camber("--style", STYLE, *options)[1]
        else:
            self.behind = start_renderd(self.metatiles)
        self.port, self.apache = start_apache(self.metatiles)

    def processes(self):
        return self.behind, self.apache

    def stop(self):
        self.apache.stop()
        self.behind.stop()
        shutil.rmtree(self.metatiles)
        if os.path.exists(FOLDER + "/renderd.sock"):
            os.unlink(FOLDER + "/renderd.sock")


def measure_mod_tile(paths, by_camber):
    """The same paths, in the same order, by mod_tile."""
    server = ModTile(by_camber)
    made = {"first": load(server.port, write_paths("new.txt", paths[:FIRST_TILES], "/t"), SECONDS, "once", None,
                          server.processes())}
    server.stop()
    server = ModTile(by_camber)
    made["all"] = load(server.port, write_paths("new.txt", paths, "/t"), SECONDS, "once", None, server.processes())
    some = [path for path in paths[:CACHED_TILES] if ask(server.port, "/t" + path)[0].status == 200]
    if not by_camber and some:
        made["cached"] = load(server.port, write_paths("cached.txt", some, "/t"), SECONDS)
    server.stop()
    return made


# ---- Memory, and the start ----


def measure_memory(paths):
    """Resident bytes after few requests and after many. Most are of some tiles; the others, of all, fill the cache soon,
    and from then on each takes the room of another."""
    port, server = start_camber("--style", STYLE, "--cache", "8M")
    source, made, asked = random.Random(2), {}, 0
    file = write_paths("all.txt", [source.choice(paths if source.random() < NEW_SHARE else paths[:KEPT_TILES])
                                   for _ in range(10**5)])
    while asked < MANY:
        if "few_bytes" not in made and asked >= FEW:
            made["few_requests"], made["few_bytes"] = asked, server.resident()
        asked += load(port, file, 1 if asked < FEW else SECONDS)["requests"]
    made["many_requests"], made["many_bytes"] = asked, server.resident()
    server.stop()
    return made


def measure_start():
    """Milliseconds from the start of the process to the first tile, with the file's pages thrown away."""
    times = []
    port, server = start_camber(city=START)
    longitude, latitude, _ = json.loads(ask(port, "/tiles.json")[1])["center"]
    server.stop()
    column, row = place(15, longitude, latitude)
    for _ in range(STARTS):
        descriptor = os.open(START, os.O_RDONLY)
        os.posix_fadvise(descriptor, 0, 0, os.POSIX_FADV_DONTNEED)
        os.close(descriptor)
        begin = time.monotonic()
        _, server = start_camber(city=START, ready=f"/15/{column}/{row}.png")
        times.append(1e3 * (time.monotonic() - begin))
        server.stop()
    return {"median_ms": sorted(times)[STARTS // 2], "most_ms": max(times)}


def main():
    os.environ["PATH"] += ":/usr/sbin"
    if not shutil.which("wrk"):
        sys.exit(77)
    paths = make_paths()
    has_mod_tile = shutil.which("apache2") and os.path.exists(MODULES + "/mod_tile.so")
    ways = {"camber": lambda: measure_camber(paths), "memory": lambda: measure_memory(paths), "start": measure_start}
    if has_mod_tile:
        ways["behind"] = lambda: measure_mod_tile(paths, True)
    if has_mod_tile and shutil.which("renderd") and os.path.exists(XML):
        ways["renderd"] = lambda: measure_mod_tile(paths, False)
    if not os.path.exists(START):
        del ways["start"]
    print(json.dumps({"tiles": len(paths), **{way: ways[way]() for way in WANTED if way in ways}}))


main()
