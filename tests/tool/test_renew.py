#!/usr/bin/env python3
"""The job that renews a served archive (examples/serve/camber-renew), as its unit runs it, without systemd: the extract
comes from a server on loopback, camber serve shows the archives, and nginx keeps tiles where it is installed.

    test_renew.py TOOL EXAMPLES [NAME...]

TOOL is camber, EXAMPLES the folder. NAME...: these tests alone. Needs curl and flock; systemd-analyze, nginx and shellcheck
where they are there. Exit status 1: the first failure, on standard error; 77: the tool has no server, or curl is missing.
"""

import atexit
import hashlib
import http.server
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import urllib.request

EXAMPLES = os.path.abspath(sys.argv.pop(2))
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(TESTS, "fixtures"))

from served import (COLUMN, PATIENCE_S, ROW, TOOL, ZOOM, Server, expect, find_port, run_tests, wait_until,  # noqa: E402
                    write_map)

if not shutil.which("curl") or not shutil.which("flock"):
    print("curl or flock is missing")
    sys.exit(77)

TILE = f"/{ZOOM}/{COLUMN}/{ROW}.png"
RENEW = os.path.join(EXAMPLES, "camber-renew")


class Extracts(http.server.BaseHTTPRequestHandler):
    """Serves `content` at /city.json, and its MD5 sum; `fault` says what goes wrong."""
    content, fault, changed_s, sums = b"", None, 0, 0

    def do_GET(self):
        kind = type(self)
        if kind.fault == "status":
            self.send_error(500)
            return
        if self.path.endswith(".md5"):
            body = (hashlib.md5(kind.content).hexdigest() + "  city.json\n").encode()
        elif self.headers.get("If-Modified-Since") == self.date_time_string(kind.changed_s):
            self.send_response(304)
            self.end_headers()
            return
        else:
            body = kind.content[:len(kind.content) // 2] if kind.fault == "other bytes" else kind.content
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Last-Modified", self.date_time_string(kind.changed_s))
        self.end_headers()
        self.wfile.write(body[:len(body) // 2] if kind.fault == "cut off" and not self.path.endswith(".md5") else body)

    def log_message(self, *_):
        pass


def publish(seed, count=80, fault=None):
    """Another extract. seed None: the same as before."""
    if seed is not None:
        write_map("extract.json", seed=seed, count=count)
        with open("extract.json", "rb") as file:
            Extracts.content = file.read()
        Extracts.changed_s += 60
    Extracts.fault = fault


class Job:
    """The job and what it needs: extracts, a folder of archives, and a server once there is one."""

    def __init__(self):
        Extracts.changed_s = int(time.time()) - 100000
        self.source = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Extracts)
        threading.Thread(target=self.source.serve_forever, daemon=True).start()
        os.mkdir("maps")
        os.mkdir("kept")
        self.server = None
        self.environment = {
            **os.environ, "CAMBER": TOOL, "CAMBER_SOURCE": f"http://127.0.0.1:{self.source.server_port}/city.json",
            "CAMBER_ARCHIVE": os.path.abspath("maps/city.pmtiles"), "CAMBER_WAIT": str(PATIENCE_S),
            "CAMBER_TILES": f"--min-zoom {ZOOM - 1} --max-zoom {ZOOM} --tile-size 256", "CAMBER_CACHE": os.path.abspath("kept"),
            "no_proxy": "127.0.0.1"}

    def serve(self, *inputs):
        self.server = Server(*inputs)
        self.environment["CAMBER_URL"] = f"http://127.0.0.1:{self.server.port}"
        self.environment["CAMBER_RELOAD"] = f"kill -HUP {self.server.process.pid}"

    def run(self, *verbs, **environment):
        """Exit status, and what was said, of the unit's commands, up to the first that fails."""
        said = ""
        for verb in verbs or ("draw", "reload"):
            done = subprocess.run([RENEW, verb], env={**self.environment, **environment}, capture_output=True, text=True,
                                  timeout=PATIENCE_S)
            said += done.stdout + done.stderr
            if done.returncode:
                return done.returncode, said
        return 0, said

    def end(self):
        self.server.stop()
        self.source.shutdown()
        self.source.server_close()


def test_files():
    """The unit runs what the tests run; systemd and shellcheck have nothing to say."""
    with open(os.path.join(EXAMPLES, "camber-renew.service"), encoding="utf-8") as file:
        unit = file.read()
    expect(re.findall(r"^Exec\w+=\+?(\S+/camber-renew) (\w+)$", unit, re.M) ==
           [("/usr/share/camber/serve/camber-renew", "draw"), ("/usr/share/camber/serve/camber-renew", "reload")], unit)
    with open(RENEW, encoding="utf-8") as file:
        script = file.read()
    for name in re.findall(r'^Environment="?(CAMBER_\w+)=', unit, re.M):
        expect(f"\n#     {name} " in script, f"{name}: the script does not say what it is")
    if shutil.which("shellcheck"):
        done = subprocess.run(["shellcheck", RENEW], capture_output=True, text=True, check=False)
        expect(done.returncode == 0, done.stdout)
    if not shutil.which("systemd-analyze"):
        print("test_files: no systemd-analyze: units are left out")
        return
    with open("camber-renew.service", "w", encoding="utf-8") as file:
        file.write(unit.replace("/usr/share/camber/serve/camber-renew", RENEW).replace("Documentation=man:camber(1)\n", ""))
    shutil.copy(os.path.join(EXAMPLES, "camber-renew.timer"), ".")
    done = subprocess.run(["systemd-analyze", "verify", "./camber-renew.service", "./camber-renew.timer"], capture_output=True, text=True,
                          timeout=PATIENCE_S)
    said = [line for line in (done.stdout + done.stderr).splitlines() if "camber" in line]
    expect(done.returncode == 0 and not said, f"the units: {done.stdout}{done.stderr}")
    done = subprocess.run(["systemd-analyze", "calendar", re.search(r"OnCalendar=(.*)", open("camber-renew.timer", encoding="utf-8").read()).group(1)],
                          capture_output=True, text=True, timeout=PATIENCE_S)
    expect(done.returncode == 0, done.stderr)


def start_nginx(server):
    """The URL of an nginx that keeps the server's tiles in kept/; None: it is not installed."""
    if not shutil.which("nginx", path=os.environ.get("PATH", "") + ":/usr/sbin"):
        print("test_renewal: no nginx: its cache is left out")
        return None
    port, here = find_port(), os.getcwd()
    os.chmod(".", 0o755)
    os.chmod("kept", 0o777)
    with open("nginx.conf", "w", encoding="utf-8") as file:
        file.write(f"daemon off; pid {here}/pid; error_log stderr;\nevents {{}}\nhttp {{ access_log off;\n"
                   f"proxy_cache_path {here}/kept levels=1:2 keys_zone=camber:1m use_temp_path=off;\n"
                   f"server {{ listen 127.0.0.1:{port}; location / {{ proxy_pass http://127.0.0.1:{server.port}; proxy_cache camber;"
                   f" add_header X-Cache $upstream_cache_status; }} }} }}\n")
    process = subprocess.Popen([shutil.which("nginx", path=os.environ.get("PATH", "") + ":/usr/sbin"), "-p", here, "-c", here + "/nginx.conf"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    atexit.register(process.terminate)
    url = f"http://127.0.0.1:{port}"

    def answers():
        try:
            return get(url + "/health")[1]
        except OSError:
            return None
    wait_until(answers, "nginx does not answer")
    return url


def get(url):
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    with opener.open(url, timeout=PATIENCE_S) as answer:
        return answer.headers.get("X-Cache"), answer.read()


def test_renewal():
    """Week by week: the first archive, another one, nothing new, light and dark."""
    job = Job()
    publish(1)
    status, said = job.run("draw")
    expect(status == 0 and "is new" in said and os.listdir("maps") and not job.server, said)
    job.serve("maps/city.pmtiles")
    expect(job.run("reload")[0] == 0 and job.run("reload")[1] == "camber-renew: nothing to reload\n", "reload alone")
    first = job.server.get(TILE)[2]
    proxy = start_nginx(job.server)
    if proxy:
        get(proxy + TILE)
        expect(get(proxy + TILE) == ("HIT", first), "nginx keeps nothing")
    else:
        with open("kept/tile", "wb") as file:
            file.write(first)

    publish(2)
    before = os.stat("maps/city.pmtiles").st_ino
    status, said = job.run()
    expect(status == 0 and "is served" in said, said)
    second = job.server.get(TILE)[2]
    expect(second != first and os.stat("maps/city.pmtiles").st_ino != before, "the former map is served")
    expect(not any(files for _, _, files in os.walk("kept")), "the proxy's cache is not cleared")
    if proxy:
        expect(get(proxy + TILE) == ("MISS", second), "nginx has the former tile")
    expect(sorted(os.listdir("maps/.renew")) == ["extract", "lock"], os.listdir("maps/.renew"))

    status, said = job.run()
    expect(status == 0 and "has not changed" in said and "nothing to reload" in said, said)

    job.server.stop()
    publish(3)
    dark = {"CAMBER_DARK": os.path.abspath("maps/dark.pmtiles")}
    expect(job.run("draw", **dark)[0] == 0, "light and dark")
    job.serve("maps/city.pmtiles", "dark=maps/dark.pmtiles")
    expect(job.run("reload", **dark)[0] == 0, "light and dark")
    pair = [job.server.get(path + TILE)[2] for path in ("", "/dark")]
    publish(4)
    status, said = job.run("both", **dark)
    now = [job.server.get(path + TILE)[2] for path in ("", "/dark")]
    expect(status == 0 and now[0] != pair[0] and now[1] != pair[1] and now[0] != now[1], said)
    job.end()


def test_failures():
    """Whatever fails, the old map stays, the step is named, and the status is not 0. The next run succeeds."""
    job = Job()
    publish(1)
    expect(job.run("draw")[0] == 0, "the first archive")
    job.serve("maps/city.pmtiles")
    expect(job.run("reload")[0] == 0, "the first archive")
    wait_until(lambda: any("reloaded" in line for line in job.server.errors), "it is not told")
    first, archive = job.server.get(TILE)[2], open("maps/city.pmtiles", "rb").read()
    with open("kept/tile", "wb") as file:
        file.write(first)

    def fails(what, words, **environment):
        status, said = job.run(**environment)
        expect(status not in (0, 1) and words in said and "previous map stays" in said.splitlines()[-1], f"{what}: {status} {said}")
        expect(job.server.get(TILE)[2] == first and os.path.exists("kept/tile"), f"{what}: the map is gone")
        with open("maps/city.pmtiles", "rb") as file:
            expect(file.read() == archive, f"{what}: the archive is another one")
        expect(set(os.listdir("maps/.renew")) <= {"extract", "lock"}, f"{what}: {os.listdir('maps/.renew')}")
        expect(sum("reloaded" in line for line in job.server.errors) == 1, f"{what}: the server was told to read again")

    publish(2, fault="status")
    fails("a server's error", "download of")
    publish(None, fault="cut off")
    fails("a download that ends early", "download of")
    publish(None, fault="other bytes")
    fails("a truncated extract", "MD5 sum differs")
    fails("a truncated extract without a sum", "drawing", CAMBER_MD5="")
    fails("no server", "download of", CAMBER_SOURCE=f"http://127.0.0.1:{find_port()}/city.json", CAMBER_MD5="")
    publish(2, count=1)
    fails("an extract that lacks most", "would shrink")
    publish(3)
    with open("broken", "w", encoding="utf-8") as file:  # a camber whose archives are damaged
        file.write(f'#!/bin/sh\n"{TOOL}" "$@" || exit\n[ "$2" = verify ] || truncate -s -500 "$(find maps/.renew -name city.pmtiles)"\n')
    os.chmod("broken", 0o755)
    fails("a broken archive", "is damaged", CAMBER=os.path.abspath("broken"))
    fails("a wrong option", "drawing", CAMBER_TILES="--none")
    holder = subprocess.Popen(["flock", "maps/.renew/lock", "sleep", "infinity"], start_new_session=True)
    def is_locked():
        return subprocess.run(["flock", "-n", "maps/.renew/lock", "true"], check=False).returncode != 0
    wait_until(is_locked, "no lock")
    fails("two runs at once", "another run")
    os.killpg(holder.pid, signal.SIGTERM)
    holder.wait()
    wait_until(lambda: not is_locked(), "the lock stays")  # which sleep has, too

    # A pair of which only one can be replaced: neither is.
    os.makedirs("maps/dark.pmtiles/in the way")
    fails("a pair", "dark.pmtiles failed", CAMBER_DARK=os.path.abspath("maps/dark.pmtiles"), CAMBER_LEAST="0")
    shutil.rmtree("maps/dark.pmtiles")

    # The server does not take what was verified: the previous archive is put back.
    status, said = job.run(CAMBER_RELOAD="true", CAMBER_WAIT="1")
    expect(status == 65 and "does not take" in said and open("maps/city.pmtiles", "rb").read() == archive, said)
    expect(job.server.get(TILE)[2] == first and os.path.exists("kept/tile"), "the map is gone")
    status, said = job.run(CAMBER_RELOAD="false")
    expect(status == 69 and "false failed" in said and open("maps/city.pmtiles", "rb").read() == archive, said)
    status, said = job.run()
    expect(status == 0 and job.server.get(TILE)[2] != first and not os.path.exists("kept/tile"), said)
    job.end()


def test_killed():
    """A run that is killed as it keeps the extract has drawn it: the next one does not put the former map back for good."""
    job = Job()
    publish(1)
    expect(job.run("draw")[0] == 0, "the first archive")
    job.serve("maps/city.pmtiles")
    expect(job.run("reload")[0] == 0, "the first archive")
    first = job.server.get(TILE)[2]
    os.mkdir("fake")
    with open("fake/mv", "w", encoding="utf-8") as file:
        file.write(f'#!/bin/sh\n{shutil.which("mv")} "$@"\ncase $3 in */extract) kill -9 $PPID ;; esac\n')
    os.chmod("fake/mv", 0o755)
    publish(2)
    status, said = job.run("draw", PATH=os.path.abspath("fake") + ":" + os.environ["PATH"])
    expect(status == -signal.SIGKILL, f"it is not killed: {status} {said}")
    status, said = job.run()
    expect(status == 0 and job.server.get(TILE)[2] != first, f"the former map is served for good: {said}")
    job.end()


def test_full_disk():
    job = Job()
    if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "none", "maps"], capture_output=True,
                                           check=False).returncode != 0:
        print("test_full_disk: no file system of its own: skipped")
        return
    try:
        publish(1, count=20)
        expect(job.run("draw")[0] == 0, "the first archive")
        job.serve("maps/city.pmtiles")
        expect(job.run("reload")[0] == 0, "the first archive")
        first = job.server.get(TILE)[2]
        used = shutil.disk_usage("maps").free
        publish(2)
        for left, words in ((4096, "download"), (12288 + len(Extracts.content), "drawing")):
            with open("maps/filler", "wb") as file:
                file.write(bytes(used - left))
            status, said = job.run()
            expect(status not in (0, 1) and words in said and "previous map stays" in said, f"{left}: {status} {said}")
            expect(job.server.get(TILE)[2] == first and "filler" in os.listdir("maps"), "the map is gone")
            os.remove("maps/filler")
        status, said = job.run()
        expect(status == 0 and job.server.get(TILE)[2] != first, said)
        job.end()
    finally:
        subprocess.run(["umount", "-l", "maps"], check=False)


run_tests(globals())
