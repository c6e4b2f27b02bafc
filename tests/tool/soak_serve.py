#!/usr/bin/env python3
"""camber serve under load for minutes: tiles and pictures at random places, and URLs that are none, pipelined.

    soak_serve.py TOOL SECONDS ODD_URLS

It ends when both the time is over and so many odd URLs were answered. Each answer must have a status that its URL
allows, the counts of /metrics must be the clients', and the server must end by SIGTERM with status 0: under a sanitizer
that is without a leak. Needs Python's standard library alone. Exit status 1: the first failure, on standard error.
"""

import http.client
import os
import random
import re
import sys
import tempfile
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "fixtures"))

from served import COLUMN, PATIENCE_S, ROW, TOOL, ZOOM, Server, expect, is_sanitized, wait_until, write_map  # noqa: E402

SECONDS, ODD_URLS = float(sys.argv[2]), int(sys.argv[3])
BATCH = 200
PIECES = ["/", "..", "%2e", "%2f", "%ff", "static", "dark", "page", "tiles", ".json", ".png", ".webp", "@2x", "@", ",", "x", "0",
          "1", "13", "-", "9" * 30, "e5", "nan", "inf", "&", ";", "//", "\\", "~", "'", "\"", "health", "events",
          "metrics", "{z}", "<b>", "?", "?a=/0/0/0.png", "%", "%0", "+", "\xe9", "a" * 300]
# Slashes before a path, and what follows a question mark, are no part of a route.
PAGES = re.compile(r"/+(dark/)?(health|tiles\.json)?(\?.*)?|/+(dark/)?(static/.*|[01]/[01]/[01](@\dx)?)\.(png|webp)(\?.*)?")


class Soak:
    def __init__(self, server):
        self.server = server
        self.end = time.monotonic() + SECONDS
        self.lock = threading.Lock()
        self.statuses = {}
        self.odd = 0
        self.wrong = None

    def goes_on(self):
        return self.wrong is None and (time.monotonic() < self.end or self.odd < ODD_URLS)

    def count(self, statuses):
        with self.lock:
            for status in statuses:
                self.statuses[status] = self.statuses.get(status, 0) + 1

    def ask_for_pictures(self, source):
        connection = http.client.HTTPConnection(self.server.host, self.server.port, timeout=PATIENCE_S)
        etag = '"none"'
        while self.goes_on():
            zoom = source.randint(10, 17)
            scale = 2.0 ** (zoom - ZOOM)
            x, y = int((COLUMN + source.uniform(-6, 6)) * scale), int((ROW + source.uniform(-6, 6)) * scale)
            path = f"{source.choice(['', '/dark'])}/{zoom}/{x}/{y}{source.choice(['', '@2x'])}.png"
            if source.random() < 0.02:
                path = f"/static/9,50,{source.uniform(0, 16):.2f}@{source.randint(0, 359)},{source.randint(0, 60)}/300x200.png"
            status, headers, _ = self.server.request(path, connection=connection, If_None_Match=etag)
            etag = headers.get("etag", etag)
            if status not in (200, 304, 503):
                self.wrong = f"{path}: {status}"
            self.count([status])
        connection.close()

    def send_odd(self, source):
        while self.goes_on():
            paths = ["/" + "".join(source.choices(PIECES, k=source.randint(1, 8))) for _ in range(BATCH)]
            request = "".join(f"GET {path} HTTP/1.1\r\nHost: x\r\n\r\n" for path in paths[:-1])
            request += f"GET {paths[-1]} HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"
            back = self.server.send(request.encode("latin-1"))
            statuses = [int(status) for status in re.findall(rb"HTTP/1\.1 (\d\d\d) ", back)]
            if len(statuses) != BATCH:
                self.wrong = f"{len(statuses)} of {BATCH} answers; the last one is to {paths[len(statuses) - 1]!r}"
            for path, status in zip(paths, statuses):
                if not 400 <= status < 500 and not (status in (200, 503) and PAGES.fullmatch(path)):
                    self.wrong = f"{path!r}: {status}"
            self.odd += len(statuses)
            self.count(statuses)

    def run(self):
        threads = [threading.Thread(target=self.ask_for_pictures, args=(random.Random(seed),)) for seed in range(3)]
        threads.append(threading.Thread(target=self.send_odd, args=(random.Random(100),)))
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        expect(self.wrong is None, self.wrong)


def count_requests(server, at_least):
    """All but those that this asks itself. The server counts one after its client has the answer: some may be late."""
    asked = 0

    def count():
        nonlocal asked
        text = server.get("/metrics", port=server.metrics_port)[2].decode()
        found = re.findall(r"^camber_requests_total\{.*\} (\d+)$", text, re.M)
        counted = sum(int(count) for count in found) - asked
        asked += 1
        return (counted,) if counted >= at_least else None

    return wait_until(count, f"the server has counted fewer than {at_least} requests")[0]


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write_map("map.json", count=300)
        server = Server("map.json", "--cache", "4M")
        soak = Soak(server)
        # With the questions whether the server was there, and the request that asked how many they were.
        start, before = time.monotonic(), count_requests(server, server.asked) + 1
        soak.run()
        seconds = time.monotonic() - start
        answers = sum(soak.statuses.values())
        counted = count_requests(server, before + answers) - before
        expect(counted == answers, f"the server has counted {counted} requests, its clients {answers}")
        expect(soak.statuses.get(200, 0) > 100, f"hardly any picture: {soak.statuses}")
        expect(server.get(f"/{ZOOM}/{COLUMN}/{ROW}.png")[0] == 200, "it does not answer any more")
        print(f"{answers} answers in {seconds:.0f} s: {soak.statuses}; {soak.odd} odd URLs; "
              f"{server.resident() >> 20} MB{', sanitized' if is_sanitized() else ''}")
        server.stop()
        os.chdir("/")


main()
