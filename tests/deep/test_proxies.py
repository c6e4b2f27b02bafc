#!/usr/bin/env python3
"""The files of examples/serve, run: camber serve behind nginx, behind Caddy and behind Apache's mod_tile, and systemd's
own check of the unit.

    test_proxies.py TOOL EXAMPLES

TOOL is camber, EXAMPLES the folder. Names, ports, paths and certificates are the test's; all else is as the files have
it. Needs nginx, caddy, systemd-analyze, openssl, apache2-bin and libapache2-mod-tile; what is not there is left out, and
told. Exit status 1: the first failure, on standard error; 77: nothing is there.
"""

import atexit
import glob
import json
import os
import re
import shutil
import ssl
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(TESTS, "fixtures"))

from served import COLUMN, PATIENCE_S, ROW, ZOOM, Server, expect, find_port, write_map  # noqa: E402

TOOL, EXAMPLES = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
TILE = f"/{ZOOM}/{COLUMN}/{ROW}.png"
MOST_EXPOSED = 20  # of 100, as systemd-analyze counts


def read_example(name):
    with open(os.path.join(EXAMPLES, name), encoding="utf-8") as file:
        return file.read()


def replace(text, *pairs):
    for old, new in pairs:
        expect(old in text, f"the example has no {old!r}")
        text = text.replace(old, new)
    return text


def get(url, **headers):
    """Status, headers, body of a server whose certificate nobody signed."""
    anyone = ssl._create_unverified_context()
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}), urllib.request.HTTPSHandler(context=anyone))
    try:
        with opener.open(urllib.request.Request(url, headers=headers), timeout=PATIENCE_S) as answer:
            return answer.status, answer.headers, answer.read()
    except urllib.error.HTTPError as error:
        return error.code, error.headers, error.read()


def start(url, *command):
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    atexit.register(process.kill)
    end = time.monotonic() + PATIENCE_S
    while True:
        try:
            if get(url)[0] == 200:
                return process
        except (urllib.error.URLError, ConnectionError):
            pass
        if process.poll() is not None or time.monotonic() > end:
            process.kill()
            sys.exit(f"FAILED: {command[0]} does not answer at {url}: {process.stderr.read()}")
        time.sleep(0.1)


def stop(process):
    """The status says nothing of camber: Apache, as one process, was seen to end with another than 0."""
    process.terminate()
    process.wait(timeout=PATIENCE_S)


def expect_same(server, url):
    direct = server.get(TILE)
    status, headers, body = get(url + TILE)
    expect(status == 200 and body == direct[2] and headers["ETag"] == direct[1]["etag"], f"{url}{TILE}: {status}")
    expect(get(url + TILE, **{"If-None-Match": headers["ETag"]})[0] == 304, "an ETag that is known")
    expect(get(url + "/1/9/9.png")[0] == 404, "a path that is none")
    about = json.loads(get(url + "/tiles.json")[2])
    expect(about["tiles"][0].startswith("https://tiles.example.org/"), about)
    expect(b"<!doctype html>" in get(url + "/")[2].lower(), "the page")


def place_cache(text, here):
    """The text of nginx.conf, and the folder in which its cache is. Root's nginx makes the one that the file names, and
    it goes with the test; who is not root, or has an nginx that uses it, gets another one."""
    folder = re.search(r"proxy_cache_path (\S+)", text).group(1)
    if os.geteuid() == 0 and not os.path.exists(folder):
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        return text, folder
    print(f"{folder}: left out, since it is {'there already' if os.path.exists(folder) else 'for root to make'}")
    os.mkdir("cache")
    os.chmod(".", 0o755)  # root's workers are another user
    os.chmod("cache", 0o777)
    return replace(text, (folder, here + "/cache")), here + "/cache"


def check_nginx(server):
    port = find_port()
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", "key.pem", "-out", "cert.pem",
                    "-days", "2", "-subj", "/CN=tiles.example.org"], check=True, capture_output=True)
    here = os.getcwd()
    text = replace(read_example("nginx.conf"),
                   ("127.0.0.1:8080", f"127.0.0.1:{server.port}"), ("listen 443", f"listen 127.0.0.1:{port}"),
                   ("/etc/letsencrypt/live/tiles.example.org/fullchain.pem", here + "/cert.pem"),
                   ("/etc/letsencrypt/live/tiles.example.org/privkey.pem", here + "/key.pem"))
    text, keeps = place_cache(text, here)
    with open("nginx.conf", "w", encoding="utf-8") as file:
        file.write(f"daemon off; pid {here}/pid; error_log stderr;\nevents {{}}\nhttp {{ access_log off;\n{text}\n}}\n")
    url = f"https://127.0.0.1:{port}"
    process = start(url + "/health", "nginx", "-p", here, "-c", here + "/nginx.conf")
    expect_same(server, url)
    expect(get(url + TILE)[1]["X-Cache"] == "HIT", "a tile is asked for again")
    expect(any(files for _, _, files in os.walk(keeps)), f"{keeps}: keeps no tile")
    stop(process)


def check_caddy(server):
    port = find_port()
    text = replace(read_example("Caddyfile"), ("\ntiles.example.org {", f"\nhttp://127.0.0.1:{port} {{"),
                   ("127.0.0.1:8080", f"127.0.0.1:{server.port}"))
    with open("Caddyfile", "w", encoding="utf-8") as file:
        file.write("{\n\tadmin off\n}\n" + text)
    os.environ["XDG_DATA_HOME"] = os.environ["XDG_CONFIG_HOME"] = os.getcwd()
    url = f"http://127.0.0.1:{port}"
    process = start(url + "/health", "caddy", "run", "--config", "Caddyfile")
    expect_same(server, url)
    expect(get(url + "/", **{"Accept-Encoding": "gzip"})[1]["Content-Encoding"] == "gzip", "the page is not compressed")
    stop(process)


def check_unit():
    with open("camber.service", "w", encoding="utf-8") as file:
        file.write(replace(read_example("camber.service"), ("ExecStart=camber ", f"ExecStart={TOOL} "),
                           ("Documentation=man:camber(1)\n", "")))  # which is looked for on this machine
    done = subprocess.run(["systemd-analyze", "verify", "./camber.service"], capture_output=True, text=True, timeout=PATIENCE_S)
    said = [line for line in (done.stdout + done.stderr).splitlines() if "camber" in line]
    expect(done.returncode == 0 and not said, f"the unit: {done.stderr}")
    done = subprocess.run(["systemd-analyze", "security", "--offline=true", f"--threshold={MOST_EXPOSED}",
                           "./camber.service"], capture_output=True, text=True, timeout=PATIENCE_S)
    found = re.search(r"Overall exposure level.*: ([0-9.]+) ", done.stdout)
    expect(done.returncode == 0 and found, f"the unit: {done.stdout[-400:]}{done.stderr}")
    print(f"the unit: exposed by {found.group(1)} of 10")


MODULES = "/usr/lib/apache2/modules"
METATILE = 8  # tiles a side


def find_metatiles():
    """Path and time of each."""
    return {path: os.stat(path).st_mtime_ns for path in glob.glob("metatiles/default/**/*.meta", recursive=True)}


def write_apache(port):
    here = os.getcwd()
    text = replace(read_example("mod_tile.conf"),
                   ("<VirtualHost *:80>", f"Listen 127.0.0.1:{port}\n<VirtualHost *:{port}>"),
                   ("/var/cache/renderd/tiles", here + "/metatiles"), ("/run/renderd/renderd.sock", here + "/socket"))
    modules = "".join(f"LoadModule {name}_module {MODULES}/mod_{name}.so\n"
                      for name in ("mpm_event", "authz_core", "tile"))
    with open("apache.conf", "w", encoding="utf-8") as file:
        file.write(f"ServerRoot {here}\nServerName tiles.example.org\nPidFile {here}/apache.pid\n"
                   f"ErrorLog {here}/apache.log\nDefaultRuntimeDir {here}\n{modules}{text}\n")


def check_mod_tile(_):
    """A tile by Apache, which asks camber at its socket; then render_list and render_expired, of the same folder."""
    if not os.path.exists(f"{MODULES}/mod_tile.so"):
        print("no mod_tile: left out")
        return
    port = find_port()
    os.mkdir("metatiles")
    server = Server("map.json", "--renderd", "socket", "--cache-dir", "metatiles")
    write_apache(port)
    url = f"http://127.0.0.1:{port}/map"
    process = start(url + "/0/0/0.png", "apache2", "-X", "-f", os.getcwd() + "/apache.conf")
    for path in (TILE, f"/{ZOOM - 1}/{COLUMN // 2}/{ROW // 2}.png", "/2/1/1.png"):
        status, headers, body = get(url + path)
        expect(status == 200 and headers["Content-Type"] == "image/png", f"{path}: {status}")
        expect(body == server.get(path)[2], f"{path}: another tile")
        expect(get(url + path, **{"If-None-Match": headers["ETag"]})[0] == 304, "mod_tile knows its own tile")
    expect(len(find_metatiles()) == 4, f"metatiles: {find_metatiles()}")
    expect(b"Tile submitted for rendering" in get(url + TILE + "/dirty")[2], "a tile is not asked for again")
    # Both wait where the machine's load is larger than they are told.
    options = ["-s", "socket", "-m", "default", "-t", os.path.abspath("metatiles"), "-l", "1000"]
    column, row = COLUMN - COLUMN % METATILE, ROW - ROW % METATILE
    done = subprocess.run(["render_list", *options, "-a", "-z", str(ZOOM), "-Z", str(ZOOM), "-x", str(column), "-X",
                           str(column + METATILE), "-y", str(row), "-Y", str(row + METATILE - 1), "-f"],
                          capture_output=True, text=True, timeout=PATIENCE_S)
    expect(done.returncode == 0 and "Rendered 2 tiles" in done.stdout + done.stderr, done.stdout + done.stderr)
    before = find_metatiles()
    # The tile itself and the one above it, which are there, and no other.
    done = subprocess.run(["render_expired", *options, "-z", str(ZOOM - 1), "-Z", str(ZOOM)],
                          input=f"{ZOOM}/{COLUMN}/{ROW}\n", capture_output=True, text=True, timeout=PATIENCE_S)
    expect(done.returncode == 0, done.stdout + done.stderr)
    after = find_metatiles()
    changed = {path for path in after if after[path] != before.get(path)}
    expect({path.split("/")[2] for path in changed} == {str(ZOOM - 1), str(ZOOM)} and len(changed) == 2,
           f"expired: {changed}: {done.stdout}{done.stderr}")
    status, _, body = get(url + TILE)
    expect(status == 200 and body == server.get(TILE)[2], f"a tile after it has expired: {status}")
    stop(process)
    server.stop()


def main():
    os.environ["PATH"] += ":/usr/sbin"
    checks = [("systemd-analyze", check_unit), ("nginx", check_nginx), ("caddy", check_caddy),
              ("apache2", check_mod_tile)]
    there = [(name, check) for name, check in checks if shutil.which(name)]
    for name in {name for name, _ in checks} - {name for name, _ in there}:
        print(f"no {name}: left out")
    if not there:
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write_map("map.json")
        server = Server("map.json", "--public-url", "https://tiles.example.org")
        for name, check in there:
            check(*([] if check is check_unit else [server]))
            print(f"{name}: as it should")
        server.stop()
        os.chdir("/")


main()
