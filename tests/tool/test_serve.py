#!/usr/bin/env python3
"""camber serve from outside, over loopback: routes, caching, hostile clients, signals, load, and the tiles themselves.

    test_serve.py TOOL [NAME...]

TOOL is camber. NAME...: these tests alone. Ports come from the system. The lines are made up by a seed. Needs Python's
standard library alone; strace where it is there. Exit status 1: the first failure, on standard error; 77: the tool has no
server.
"""

import concurrent.futures
import gzip
import http.client
import json
import math
import os
import random
import re
import resource
import select
import shutil
import signal
import socket
import sqlite3
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse
import zlib

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(TESTS, "fixtures"))

from png_rows import decode, difference  # noqa: E402
from served import (COLUMN, PATIENCE_S, ROW, TOOL, ZOOM, Server, expect, run_tests, find_port, is_sanitized, wait_until,  # noqa: E402
                    write_map)

# ---- Routes ----


def test_routes():
    write_map("map.json")
    server = Server("map.json", "--name", "Täst", "--attribution", "(c) Us", "--max-size", "600")
    tile = f"/{ZOOM}/{COLUMN}/{ROW}"
    status, headers, body = server.get("/tiles.json")
    about = json.loads(body)
    expect(status == 200 and headers["content-type"] == "application/json", "tiles.json")
    expect(about["tilejson"] == "3.0.0" and about["name"] == "Täst" and about["attribution"] == "(c) Us", about)
    expect(about["tiles"] == [server.url + "/{z}/{x}/{y}.png"] and about["minzoom"] == 0, about)
    expect(about["camber"] == {"theme": "light", "drawn": True, "ratio_max": 4, "edit": False}, about)
    expect(about["tileSize"] == 256, about)
    west, south, east, north = about["bounds"]
    expect(-180 <= west < about["center"][0] < east <= 180 and south < about["center"][1] < north, about)
    dark = json.loads(server.get("/dark/tiles.json")[2])
    expect(dark["tiles"] == [server.url + "/dark/{z}/{x}/{y}.png"] and dark["camber"]["theme"] == "dark", dark)

    pictures = set()
    for path, start, kind in ((tile + ".png", b"\x89PNG", "image/png"), (tile + "@2x.png", b"\x89PNG", "image/png"),
                              ("/dark" + tile + ".png", b"\x89PNG", "image/png"),
                              (tile + ".webp", b"RIFF", "image/webp"), ("/0/0/0.png", b"\x89PNG", "image/png"),
                              ("/24/8814592/5685248.png", b"\x89PNG", "image/png"),
                              ("/static/9.14,50.1,11/300x200.png", b"\x89PNG", "image/png"),
                              ("/static/9.14,50.1,11@30,60/300x200@2x.webp", b"RIFF", "image/webp")):
        status, headers, body = server.get(path)
        expect(status == 200 and headers["content-type"] == kind and body.startswith(start), f"{path}: {status} {headers}")
        expect(headers["x-content-type-options"] == "nosniff" and headers["access-control-allow-origin"] == "*", headers)
        expect("max-age" in headers["cache-control"] and headers["last-modified"].endswith("GMT"), headers)
        pictures.add(body)
    # The world and the small tile, on which no road is drawn, are the same.
    expect(len(pictures) == 7, "pictures of different paths are the same")
    expect(len(decode(server.get(tile + "@2x.png")[2])) == 512, "a tile @2x is not of 512 px")

    status, headers, body = server.get("/")
    expect(status == 200 and headers["content-type"].startswith("text/html"), headers)
    expect("default-src 'none'" in headers["content-security-policy"], headers)
    expect(server.get("/page/page.css")[1]["content-type"].startswith("text/css"), "page.css")
    expect(server.get("/health")[::2] == (200, b"ok\n"), "health")
    for path in ("/static/0,0,0/601x1.png", "/static/0,0,0/301x1@2x.png", "/static/0,0,0/1x1@5x.webp",
                 "/static/0,0,0/99999999x1.png", "/static/auto/601x1.png", "/static/0,0,1,1/601x1.png"):
        status, headers, body = server.get(path)
        expect(status == 400 and b"at most 600 px (--max-size), and R 4 (--max-ratio)" in body, f"{path}: {status}: {body}")
        expect(server.get(path, port=server.metrics_port)[0] == 404, "pictures at the metrics' address")
    for path in ("/metrics", "/page/none.js", "/events",
                 tile + "@5x.png", tile + ".pbf", "/dark" + tile + ".avif", "/favicon.ico", "/robots.txt"):
        status, headers, body = server.get(path)
        expect(status == 404 and body == b"404 not found\n", f"{path}: {status}")
    for path in (tile + ".jpg", "/dark" + tile + "@2x.jpeg", "/static/0,0,0/9x9.jpg"):
        status, headers, body = server.get(path)
        expect(status == 400 and b"not drawn as JPEG; ask for .png" in body, f"{path}: {status}: {body}")
    metrics = server.get("/metrics", port=server.metrics_port)
    expect(metrics[0] == 200 and b'camber_requests_total{route="tile",status="200"}' in metrics[2], metrics)
    expect(server.get(tile + ".png", port=server.metrics_port)[0] == 404, "tiles at the metrics' address")
    server.stop()

    server = Server("map.json", "--theme", "dark", "--public-url", "https://example.org/map/", "--cors",
                    "https://example.com")
    status, headers, body = server.request("/tiles.json", Host="evil.example")
    expect(json.loads(body)["tiles"] == ["https://example.org/map/{z}/{x}/{y}.png"], body)
    expect(json.loads(body)["camber"]["theme"] == "dark", body)
    expect(headers["access-control-allow-origin"] == "https://example.com", headers)
    expect(server.get("/dark" + tile + ".png")[0] == 404 and server.get("/dark/tiles.json")[0] == 404, "another theme")
    expect(server.get(tile + ".png")[2] in pictures, "the dark theme differs by how it is asked for")
    server.stop()


# ---- Overlays of pictures ----


def overlay(*parameters):
    return "?" + urllib.parse.urlencode(parameters)


def is_color(picture, x, y, wanted, ratio=1):
    """Whether a pixel has this colour, within a level."""
    row = picture[round(y * ratio)]
    return all(abs(a - b) <= 1 for a, b in zip(row[4 * round(x * ratio):][:3], wanted))


def post(server, path, body, **headers):
    made = http.client.HTTPConnection(server.host, server.port, timeout=PATIENCE_S)
    made.request("POST", path, body, headers)
    answer = made.getresponse()
    body = answer.read()
    made.close()
    return answer.status, body


RED, BLUE, GREEN, WHITE = (255, 0, 0), (0, 0, 255), (0, 128, 0), (255, 255, 255)
BOX = "0,40|1,40|1,41|0,41|0,40"


def test_overlays():
    """Paths, markers and texts are where and as the query says, and the same as GeoJSON."""
    write_map("map.json")
    server = Server("map.json")
    view = "/static/0.5,40.5,8/400x400.png"  # a degree is 364 px wide
    plain = decode(server.get(view)[2])

    def ask(*parameters, path=view):
        status, _, body = server.get(path + overlay(*parameters))
        expect(status == 200, f"{parameters}: {status} {body}")
        return decode(body)

    box = ask(("path", BOX), ("fill", "red"), ("stroke", "blue"), ("width", "10"))
    expect(is_color(box, 200, 200, RED) and is_color(box, 18, 200, BLUE) and is_color(box, 382, 200, BLUE), "a filled path")
    expect(box[200][:40] == plain[200][:40] and is_color(box, 24, 200, RED), "its width")
    # The path itself is asked first.
    own = ask(("path", f"fill:green|stroke:none|{BOX}"), ("fill", "red"), ("stroke", "blue"), ("width", "10"))
    expect(is_color(own, 200, 200, GREEN) and is_color(own, 20, 200, GREEN) and own[200][:4 * 17] == plain[200][:4 * 17], "own look")
    expect(ask(("path", "|".join(",".join(reversed(p.split(","))) for p in BOX.split("|"))), ("latlng", "1"), ("fill", "red"),
               ("stroke", "blue"), ("width", "10")) == box, "latlng")
    line = ask(("path", "0.3,40.5|0.7,40.5"), ("stroke", "red"), ("width", "20"), ("border", "blue"), ("borderwidth", "5"))
    expect(is_color(line, 200, 200, RED) and is_color(line, 200, 208, RED) and is_color(line, 200, 213, BLUE), "a border")
    expect(line[217][800:804] == plain[217][800:804] and line[200][4 * 125:4 * 126] == plain[200][4 * 125:4 * 126], "butt")
    for cap in ("round", "square"):
        longer = ask(("path", "0.3,40.5|0.7,40.5"), ("stroke", "red"), ("width", "20"), ("linecap", cap))
        expect(is_color(longer, 122, 200, RED), cap)
    joins = [ask(("path", "0.3,40.4|0.5,40.6|0.7,40.4"), ("width", "20"), ("linejoin", join)) for join in ("miter", "bevel", "round")]
    expect(joins[0] != joins[1] != joins[2] != joins[0], "joins")
    # The example of Google's documents.
    encoded, decoded = "_p~iF~ps|U_ulLnnqC_mqNvxq`@", "-120.2,38.5|-120.95,40.7|-126.453,43.252"
    pictures = [server.get("/static/auto/200x200.png" + overlay(("path", path), ("width", "3")))[2]
                for path in ("enc:" + encoded, decoded, "width:3|enc:" + encoded)]
    expect(pictures[0] == pictures[1] == pictures[2], "an encoded polyline")

    pin = ask(("marker", "0.5,40.5|pin|color:blue"))
    expect(is_color(pin, 200, 192, BLUE) and is_color(pin, 200, 179, WHITE) and pin[203] == plain[203], "a pin stands on its point")
    moved = ask(("marker", "0.5,40.5|pin|scale:2|offset:20,-10|color:blue"))
    expect(is_color(moved, 240, 164, BLUE) and moved[195] == plain[195], "an offset is scaled")
    dot = ask(("marker", "0.5,40.5|dot|color:red"))
    expect(is_color(dot, 200, 200, RED) and is_color(dot, 203, 200, RED) and dot[208] == plain[208], "a dot is centred")
    turned = ask(("marker", "0.5,40.5|pin|color:blue"), path="/static/0.5,40.5,8@90/400x400.png")
    expect(is_color(turned, 200, 192, BLUE) and is_color(turned, 200, 179, WHITE), "a pin stands upright where the map turns")
    words = ask(("text", "0.5,40.5|Wide words|size:40|color:red|halo:none"))
    inked = [y for y in range(400) if words[y] != plain[y]]
    expect(inked and 20 <= max(inked) - min(inked) <= 50 and abs(sum(inked) / len(inked) - 200) < 12, f"a text: {inked}")
    expect(ask(("text", "0.5,40.5|{name} %d|size:40")) != plain and ask(("marker", "0.5,40.5|pin|label:7")) != pin, "texts")
    twice = decode(server.get("/static/0.5,40.5,8/400x400@2x.png" + overlay(("path", BOX), ("fill", "red")))[2])
    expect(len(twice) == 800 and is_color(twice, 200, 200, RED, 2), "@2x")
    expect(ask(("path", BOX), ("unknown", "x"), ("v", "3")) == ask(("path", BOX)), "other parameters are ignored")

    # Fitted: the box takes all but a tenth of a tenth on each side, and none of it without padding.
    for name, parameters, edge in (("auto", (("path", BOX),), 2), ("auto", (("path", BOX), ("padding", "0")), 0)):
        fitted = ask(*parameters, ("fill", "red"), ("stroke", "none"), path=f"/static/{name}/300x600.png")
        inside = [x for x in range(300) if is_color(fitted, x, 300, RED)]
        expect(abs(len(inside) - 300 / (1 + 0.2 * (edge > 0))) <= 2, f"{name} {parameters}: {len(inside)} px")
    bounds = server.get("/static/0,40,1,41/300x600.png" + overlay(("path", BOX), ("padding", "0"), ("fill", "red"), ("stroke", "none")))
    expect(is_color(decode(bounds[2]), 0, 300, RED) and is_color(decode(bounds[2]), 299, 300, RED), "bounds")
    near, far = (server.get("/static/auto/100x100.png" + overlay(("marker", "9.14,50.1"), *more))[2]
                 for more in ((), (("maxzoom", "3"),)))
    expect(near != far, "maxzoom")
    metres = lambda p: f"{p[0] * 111319.49079327358:.9f},{math.asinh(math.tan(math.radians(p[1]))) * 6378137:.9f}"  # noqa: E731
    corners = "|".join(metres([float(n) for n in p.split(",")]) for p in BOX.split("|"))
    raw = f"/static/raw/{metres((0.5, 40.5))},8/400x400.png"
    expect(ask(("path", corners), ("fill", "red"), ("stroke", "blue"), ("width", "10"), path=raw) == box, "metres of Web Mercator")
    far = difference(ask(("marker", metres((0.5, 40.5)) + "|pin|color:blue"), path=raw), pin)
    expect(far < 32, f"a pin at metres, whose curve is simplified a little differently: {far}")
    across = server.get("/static/179,-1,-179,1/300x300.png" + overlay(("path", "179,0|181,0"), ("stroke", "red"), ("width", "9")))
    expect(is_color(decode(across[2]), 150, 150, RED), "bounds across the antimeridian")

    polygon = {"type": "Polygon", "coordinates": [[[float(n) for n in p.split(",")] for p in BOX.split("|")]]}
    look = {"fill": "red", "fill-opacity": 1, "stroke": "blue", "stroke-width": 10}
    point = {"type": "Feature", "properties": {"marker-color": "blue"}, "geometry": {"type": "Point", "coordinates": [0.5, 40.5]}}
    status, body = post(server, view, json.dumps({"type": "Feature", "properties": look, "geometry": polygon}))
    expect(status == 200 and decode(body) == box, f"GeoJSON differs from its path: {status}")
    status, again = post(server, view, json.dumps({"type": "Feature", "properties": look, "geometry": polygon}), **{"If-None-Match": "*"})
    expect(status == 200 and again == body, f"a POST with a condition: {status}")
    status, body = post(server, view, json.dumps({"type": "FeatureCollection", "features": [point]}), Transfer_Encoding="")
    expect(status == 200 and decode(body) == pin, "a point is no marker")
    status, body = post(server, "/static/auto/300x300.png?padding=0&fill=red&stroke=none", json.dumps(polygon))
    expect(status == 200 and is_color(decode(body), 150, 150, RED), "a geometry alone, with the query's look")
    expect(server.get(view)[2] == server.get(view + "?")[2] and decode(server.get(view)[2]) == plain, "it has changed the map")
    expect(post(server, f"/{ZOOM}/{COLUMN}/{ROW}.png", "{}")[0] == 405 and post(server, "/", "{}")[0] == 405, "POST elsewhere")
    server.stop()


def write_sprite(name, width, height, rgba):
    """Writes a sprite with one icon, flag.png, of one colour."""
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))  # noqa: E731
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    rows = zlib.compress(b"".join(b"\0" + bytes(rgba) * width for _ in range(height)))
    with open(name + ".png", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", rows) + chunk(b"IEND", b""))
    with open(name + ".json", "w", encoding="utf-8") as file:
        json.dump({"flag.png": {"x": 0, "y": 0, "width": width, "height": height, "pixelRatio": 1}}, file)


def check_large_sprite():
    """One picture with icons of a sprite that decodes to 64 MB is drawn, and of several at once some are told to come again."""
    write_sprite("icons/large", 4096, 4096, (*GREEN, 255))
    server = Server("map.json", "--icons", "icons/large")
    path = "/static/0.5,40.5,8/400x400.png" + overlay(("marker", "0.5,40.5|flag.png|scale:0.1"))
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        found = sorted(pool.map(lambda _: server.get(path)[0], range(8)))
    expect(found[0] == 200 and set(found) <= {200, 503}, f"a large sprite: {found}")
    wait_until(lambda: server.get(path)[0] == 200, "a large sprite afterwards, once the answers before are sent")
    server.stop()


def test_icons():
    """A marker may be an icon of the operator's sprite: it stands on its point, and is scaled."""
    write_map("map.json")
    os.mkdir("icons")
    write_sprite("icons/sprite", 20, 30, (*GREEN, 255))
    view = "/static/0.5,40.5,8/400x400.png"
    server = Server("map.json", "--icons", "icons/sprite")
    plain = decode(server.get(view)[2])
    for options, west, east, top, end in (("", 190, 210, 170, 200), ("|scale:2", 180, 220, 140, 200),
                                          ("|offset:10,-20|scale:2", 200, 240, 100, 160)):
        status, _, body = server.get(view + overlay(("marker", "0.5,40.5|flag.png" + options)))
        picture = decode(body) if status == 200 else sys.exit(f"FAILED: {options}: {body}")
        inside = [(x, y) for y in range(400) for x in range(400) if is_color(picture, x, y, GREEN)]
        found = [least(value[axis] for value in inside) + more for axis in (0, 1) for least, more in ((min, 0), (max, 1))]
        far = max(abs(a - b) for a, b in zip(found, (west, east, top, end)))
        expect(far <= (2 if "scale" in options else 0), f"{options}: {found}")  # scaled, its edges are soft
        expect(picture[:top - 2] == plain[:top - 2] and picture[end + 2:] == plain[end + 2:], f"{options}: the map has changed")
    both = decode(server.get(view + overlay(("marker", "0.5,40.5|flag.png"), ("marker", "0.2,40.5|pin|color:blue|label:A")))[2])
    expect(is_color(both, 200, 185, GREEN) and both != plain, "an icon beside a pin")
    for value, words in (("0.5,40.5|flag", b"nor in the server's sprite"), ("0.5,40.5|../flag.png", b"sprite"),
                         ("0.5,40.5|flag.png|label:A", b"only a pin or a dot"), ("0.5,40.5|" + "x" * 99, b"nor in the server's sprite"),
                         ("0.5,40.5|flag.png|pin", b"its icon comes first"), ("0.5,40.5|flag.png|scale:21", b"0.1 to 20")):
        status, _, body = server.get(view + overlay(("marker", value)))
        expect(status == 400 and words in body, f"{value}: {status} {body}")
    check_large_sprite()
    os.rename("icons/sprite.png", "icons/gone.png")
    expect(server.get(view + overlay(("marker", "0.5,40.5|flag.png")))[0] == 500, "a sprite that is gone is not the client's fault")
    expect(server.get(view + overlay(("marker", "0.5,40.5|pin")))[0] == 200, "and a pin does not need it")
    os.rename("icons/gone.png", "icons/sprite.png")
    server.stop()
    for name, text in (("empty", "[]"), ("odd", '{"flag.png": {"x": -1}}'), ("dense", "{}"), ("dense@2x", "[]")):
        with open(name + ".json", "w", encoding="utf-8") as file:
            file.write(text)
        shutil.copy("icons/sprite.png", name + ".png")
    shutil.copy("icons/sprite.json", "dense.json")
    for name, words in (("none", "No such file"), ("map", "No such file"), ("empty", "lists no icons"), ("odd", "odd.json: /flag.png"),
                        ("dense", "dense@2x.json")):
        done = subprocess.run([TOOL, "serve", "map.json", "--listen", "127.0.0.1:0", "--icons", name], capture_output=True, text=True,
                              check=False)
        expect(done.returncode in (65, 66) and words in done.stderr, f"--icons {name}: {done.returncode} {done.stderr}")


def test_preflight():
    """A page of another origin may post GeoJSON: its browser asks first, with OPTIONS."""
    write_map("map.json")
    server = Server("map.json", "--cors", "https://example.com", "--max-size", "600")
    taken = "GET, HEAD, POST, OPTIONS"
    for path in ("/static/auto/300x200.png", "/dark/static/1,2,3/4x4.webp?path=", "/static/auto/601x1.png"):
        status, headers, body = server.request(path, "OPTIONS", Origin="https://example.com", Access_Control_Request_Method="POST",
                                               Access_Control_Request_Headers="content-type")
        expect(status == 204 and not body and headers["allow"] == headers["access-control-allow-methods"] == taken, f"{path}: {status} {headers}")
        expect(headers["access-control-allow-origin"] == "https://example.com", headers)
        expect(headers["access-control-allow-headers"].lower() == "content-type", headers)
        status, headers, _ = server.request(path, "PUT")
        expect(status == 405 and headers["allow"] == taken, f"{path}: {status} {headers}")
    for path, port in (("/health", None), ("/tiles.json", None), ("/static/auto/300x200.png", server.metrics_port)):
        status, headers, _ = server.request(path, "OPTIONS", port=port)
        expect(status == 405 and headers["allow"] == "GET, HEAD" and "access-control-allow-methods" not in headers, f"{path}: {status}")
    server.stop()


def test_long_name():
    """A name that is cut is not cut within a character, which no JSON could contain."""
    write_map("map.json")
    server = Server("map.json", "--name", "ä" * 200)
    expect(json.loads(server.get("/tiles.json")[2])["name"] == "ä" * 127, "a long name")
    server.stop()


def test_overlay_errors():
    """Answers say what is wrong with a picture, with its number, and do not repeat the request's own text."""
    write_map("map.json")
    server = Server("map.json", "--max-size", "600")
    auto = "/static/auto/300x200.png"
    for name, value, words in (
            ("path", "1,2", "two or more points"), ("path", "", "point 1"), ("path", "a|b", "point 1"), ("path", "1,2|3", "point 2"),
            ("path", "nan,1|2,3", "point 1"), ("path", "1,inf|2,3", "point 1"), ("path", "1e999,1|2,3", "point 1"),
            ("path", "0x1,1|2,3", "point 1"), ("path", "1,91|2,3", "point 1"), ("path", "541,1|2,3", "point 1"),
            ("path", "width:-1|1,2|3,4", "width"), ("path", "width:501|1,2|3,4", "width"), ("path", "stroke:<b>|1,2|3,4", "stroke"),
            ("path", "fill:|1,2|3,4", "fill"), ("path", "color:red|1,2|3,4", "its options"), ("path", "enc:~~~~~~~~~~", "encoded"),
            ("path", "enc:_p~iF", "half a point"), ("path", "enc:\x01", "encoded"), ("path", "1,2|3,4" + "|5,6" * 900, None),
            ("marker", "1", "LON,LAT"), ("marker", "1,2|x.png", "pin and dot"), ("marker", "1,2|pin|scale:0", "scale"),
            ("marker", "1,2|pin|offset:1", "offset"), ("marker", "1,2|pin|dot", "its icon comes first"), ("marker", "1,2|pin|x:1", "options"),
            ("text", "1,2", "no words"), ("text", "1,2|", "no words"), ("text", "1,2|x|size:1e9", "size"), ("text", "1,2|x|y", "NAME:VALUE"),
            ("text", "1,2|x|anchor:up", "anchor"), ("text", "1,2|" + "x" * 501, "500 bytes"), ("linecap", "flat", "linecap"),
            ("linejoin", "x", "linejoin"), ("padding", "-1", "padding"), ("maxzoom", "25", "maxzoom"), ("stroke", "nocolour", "stroke")):
        status, headers, body = server.get(auto + overlay((name, value)))
        expect(status == (400 if words else 200), f"{name}={value[:60]}: {status} {body[:200]}")
        expect(not words or (body.startswith(b"400 ") and words.encode() in body and headers["cache-control"] == "no-store"),
               f"{name}={value[:60]}: {body[:200]}")
        expect(b"<b>" not in body and b"nocolour" not in body, "a request's text is repeated")
    expect(b"nothing to fit" in server.get(auto)[2] and b"path 2: " in server.get(auto + overlay(("path", BOX), ("path", "x")))[2], "what")
    many = overlay(*[("path", "1,2|3,4")] * 101)
    expect(b"at most 100 paths" in server.get(auto + many)[2], "many paths")
    for path, words in (("/static/1,2/3x4.png", "the view"), ("/static/raw/1,2,3000000000,4/3x4.png", "metres"), ("/static/1,2,3@x/3x4.png", "the view"), ("/static/1,2,25/3x4.png", "the view"),
                        ("/static/1,4,3,2/3x4.png", "the bounds"), ("/static/1,2,3,99/3x4.png", "the bounds"),
                        ("/static/1,2,3/0x4.png", "the size"), ("/static/1,2,3/3.png", "the size"), ("/static/1,2,3/3x4.gif", "ends in"),
                        ("/static/1,2,3/3x4", "ends in"), ("/static/", "the view"), ("/static/auto/3x4.pbf", "ends in"),
                        ("/static/auto/601x1.png", "at most 600 px")):
        status, _, body = server.get(path)
        expect(status == 400 and words.encode() in body, f"{path}: {status} {body}")
    deep, large = 100000, 1 << 20
    for body, words in ((b"", b"POST needs"), (b"{", b"not JSON"), (b"[]", b"not an object"), (b'"file:///etc/passwd"', b"not JSON"),
                        (b'"/etc/passwd"', b"not JSON"), (b"[" * deep, b"not JSON"), (b'{"a":' * 2000 + b"1" + b"}" * 2000, b"no geometry"),
                        (b'{"type": "FeatureCollection"}', b"features"), (b'{"type": "Point", "coordinates": [1]}', b"two numbers"),
                        (b'{"type": "Point", "coordinates": [1e400, 1]}', b"not JSON"), (b'{"type": "Point", "coordinates": [1, 99]}', b"not on"),
                        (b'{"type": "LineString", "coordinates": ' + b"[" * 20 + b"1, 2" + b"]" * 20 + b"}", b"coordinates"),
                        (b'{"type": "GeometryCollection", "geometries": [' * 20 + b"]}" * 20, b"nested"), (b"\xff\xfe", b"not JSON"),
                        (b'{"type": "Topology"}', b"no geometry"), (b" " * (large + 1), b"more than"),
                        (b'{"type": "Feature", "properties": {"fill": "nocolour"}, "geometry": null}', b"feature 1: fill"),
                        (b'{"type": "Feature", "properties": {"stroke": {"a": 1}}, "geometry": null}', b"feature 1: stroke")):
        status, answer = post(server, auto, body)
        expect(status == 400 and (words in answer or b"not an object" in answer), f"{body[:60]}: {status} {answer}")
        expect(b"passwd" not in answer and b"nocolour" not in answer, answer)
    # Properties that are not what they should be are not errors, and no file is read for them.
    odd = {"type": "Feature", "properties": {"stroke-width": "x", "fill-opacity": [1], "text": 5, "icon-image": "file:///etc/passwd"},
           "geometry": {"type": "LineString", "coordinates": [[1, 2], [3, 4], [3, 4]]}}
    expect(post(server, auto, json.dumps(odd))[0] == 200, "odd properties")
    for data in (b"GET " + auto.encode() + b"?path=%zz%&&=&%00&marker=%ff HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n",
                 b"GET " + auto.encode() + b"?path=" + b"1,2%7C" * (1 << 18) + b" HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n",
                 b"POST " + auto.encode() + b" HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\nConnection: close\r\n\r\nzz\r\n"):
        expect(status_of(server.send(data, seconds=3)) in (400, 413, 414, 431, None), data[:60])
    source = random.Random(11)
    parts = ["path=", "marker=", "text=", "1,2", "|", "%7C", "enc:", "_p~iF", ":", "width:", "stroke:", "red", "&", "=", "1e308", "-", "nan",
             "%00", "%", "latlng=1&", "%F0%9F%98%80", "auto", "padding=9&", "scale:", "label:", "x" * 90, "#", "+", "\\", "'"]
    for _ in range(400):
        path = auto + "?" + "".join(source.choice(parts) for _ in range(source.randint(1, 14)))
        expect(status_of(server.send(b"GET " + path.encode() + b" HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")) in (200, 400), path)
    # Bodies of strangers have little memory at once.
    begun = [server.open() for _ in range(20)]
    for made in begun:
        made.sendall(b"POST " + auto.encode() + b" HTTP/1.1\r\nHost: x\r\nContent-Length: 100000\r\n\r\n" + b" " * 50000)
    wait_until(lambda: post(server, auto, json.dumps(odd))[0] == 503, "any number of bodies is taken")
    for made in begun:
        made.close()
    wait_until(lambda: post(server, auto, json.dumps(odd))[0] == 200, "bodies of clients that have left are kept")
    wait_until(lambda: server.metric("requests_in_flight") == 1, "requests are lost")
    expect(server.get("/health")[0] == 200, "it does not serve any more")
    server.stop()
    expect(not any("ERROR" in line or "runtime error" in line for line in server.errors), server.errors)
    write_archive("light.pmtiles", "light", 3)
    server = Server("light.pmtiles")
    expect(server.get(auto + overlay(("path", BOX)))[0] == 404 and post(server, auto, "{}")[0] == 404, "pictures of an archive")
    server.stop()


def write_archive(name, theme, seed):
    """A PMTiles of pictures in one theme."""
    write_map("archived.json", seed=seed)
    subprocess.run([TOOL, "tiles", "archived.json", "-o", name, "-f", "-q", "--theme", theme, "--min-zoom", str(ZOOM - 2), "--max-zoom",
                    str(ZOOM), "--tile-size", "256"], check=True, timeout=PATIENCE_S)


def test_maps():
    """Several maps under names, among them light and dark out of two archives; each is read again by itself."""
    write_map("a.json", seed=1)
    write_map("b.json", seed=2)
    write_archive("light.pmtiles", "light", 3)
    write_archive("dark.pmtiles", "dark", 3)
    tile = f"{ZOOM}/{COLUMN}/{ROW}.png"
    alone = {}
    for name in ("a.json", "b.json", "light.pmtiles", "dark.pmtiles"):
        server = Server(name)
        alone[name] = server.get("/" + tile)[2]
        server.stop()
    server = Server("a=a.json", "x-1=light.pmtiles", "x-1/dark=dark.pmtiles", "b=b.json")
    for name, file in (("a", "a.json"), ("b", "b.json"), ("x-1", "light.pmtiles"), ("x-1/dark", "dark.pmtiles")):
        expect(server.get(f"/{name}/{tile}")[2] == alone[file], f"{name} is not as when it is alone")
        about = json.loads(server.get(f"/{name}/tiles.json")[2])
        expect(about["tiles"] == [f"{server.url}/{name}/{{z}}/{{x}}/{{y}}.png"], about)
        theme = "dark" if name == "x-1/dark" else "light"
        expect(about["camber"]["theme"] == theme, about)
        page = server.get(f"/{name}/")
        expect(page[0] == 200 and b'src="page/page.js"' in page[2], page[2])
        expect(server.get(f"/{name}/page/page.js")[0] == 200 and server.get(f"/{name}/health")[0] == 200, name)
        status, headers, _ = server.get(f"/{name}")
        expect(status == 308 and headers["location"] == name.split("/")[-1] + "/", headers)
    expect(server.get(f"/a/dark/{tile}")[0] == 200 and server.get(f"/x-1/dark/dark/{tile}")[0] == 404, "dark")
    status, headers, body = server.get("/")
    listed = re.findall(r'<li><a href="([^"]*)/">', body.decode())
    expect(status == 200 and listed == ["a", "x-1", "b"] and "default-src 'none'" in headers["content-security-policy"], body)
    expect(server.get("/page/page.css")[0] == 200 and server.get("/health")[0] == 200, "the list's own files")
    for path in ("/" + tile, "/tiles.json", "/none/" + tile, "/aa/" + tile, "/a" + tile, "/metrics", "/a/metrics", "//a/" + tile):
        expect(server.get(path)[0] == 404, path)

    # tileserver-gl's paths of a map's tiles and pictures, and requests by map.
    view = "static/0,0,1/90x60@2x.png?path=0,0|10,10"
    for path, alias in (view, view), (tile, tile), (tile, "256/" + tile):
        expect(server.get(f"/styles/b/{alias}")[2] == server.get(f"/b/{path}")[2], alias)
    status, _, body = server.get("/styles/b/static/0,0,1/90x60.jpg")
    expect(status == 400 and b"not drawn as JPEG" in body, body)
    expect(server.get(f"/styles/none/{tile}")[0] == 404 and server.get("/styles/b/health")[0] == 404, "no aliases")
    counted = server.get("/metrics", port=server.metrics_port)[2].decode()
    expect(re.search(r'^camber_requests_total{map="b",route="static",status="200"} 2$', counted, re.M), counted)
    expect('camber_requests_total{map="x-1/dark",route="tile",status="200"}' in counted and
           'camber_map_ready{map="x-1/dark"} 1' in counted and 'camber_requests_total{route="none"' in counted, counted)

    # Two are replaced: one by something else, and one by a broken file, which is named; the other maps stay as they were.
    hits = server.metric("cache_tiles")
    write_map("a.json", seed=9)
    with open("light.pmtiles", "r+b") as file:
        file.truncate(100)
    server.process.send_signal(signal.SIGHUP)
    wait_until(lambda: any("reloaded b=b.json" in line for line in server.errors), lambda: server.errors)
    said = "".join(server.errors)
    expect("reloaded a=a.json" in said and "still serving the previous map of x-1\n" in said and "light.pmtiles" in said, said)
    expect(server.metric("cache_tiles") < hits, "tiles of the former map are kept")
    expect(server.get("/a/" + tile)[2] not in alone.values(), "the former map")
    expect(server.get("/b/" + tile)[2] == alone["b.json"] and server.get("/x-1/" + tile)[2] == alone["light.pmtiles"], "others")
    server.stop()

    # Light and dark of one map without a name. /health waits for both.
    write_archive("light.pmtiles", "light", 3)
    write_map("slow.json", count=20000)
    server = Server("light.pmtiles", "dark=slow.json")
    expect(server.get("/dark/" + tile)[0] == 200, "it is told to be ready before its dark map is read")
    server.stop()
    server = Server("light.pmtiles", "dark=dark.pmtiles")
    expect(server.get("/" + tile)[2] == alone["light.pmtiles"] and server.get("/dark/" + tile)[2] == alone["dark.pmtiles"], "themes")
    themes = [json.loads(server.get(path + "tiles.json")[2])["camber"]["theme"] for path in ("/", "/dark/")]
    expect(themes == ["light", "dark"] and server.get("/dark/")[0] == 200 and server.get("/")[0] == 200, themes)
    server.stop()

    for arguments, words in ((("a=a.json", "b.json"), "no name"), (("dark=a.json",), "no map"), (("a/dark=a.json",), "a=INPUT"),
                             (("page=a.json",), "path of this name"), (("a=",), "no input"), (("a=-",), "standard input"),
                             (("a=a.json", "--renderd", "x", "--cache-dir", "y"), "one map"),
                             (("a=a.json", "--edit", "x"), "one map"), (("a=a.json", "--name", "x"), "own name")):
        done = subprocess.run([TOOL, "serve", *arguments], capture_output=True, text=True, timeout=PATIENCE_S)
        expect(done.returncode == 2 and words in done.stderr, f"{arguments}: {done.returncode} {done.stderr}")
    done = subprocess.run([TOOL, "serve", "a=a.json", "b=none.json", "--listen", "127.0.0.1:0"], capture_output=True, text=True,
                          timeout=PATIENCE_S)
    expect(done.returncode == 66 and "none.json" in done.stderr and "http://" not in done.stderr, done.stderr)


def test_start():
    """Before the input is read there is the page alone; what must be drawn is 503."""
    for count in (20000, 80000, 320000):  # until it takes longer to read than to ask
        write_map("map.json", count=count)
        server = Server("map.json", wait=False)
        before = {path: server.get(path) for path in ("/health", f"/{ZOOM}/{COLUMN}/{ROW}.png", "/tiles.json", "/")}
        was_ready = server.metric("ready")
        if not was_ready:
            break
        server.stop()
    expect(not was_ready, "it is ready before it can be asked")
    expect([before[path][0] for path in before] == [503, 503, 503, 200], f"{[(path, before[path][0]) for path in before]}")
    expect(all(headers.get("retry-after") == "1" for status, headers, _ in before.values() if status == 503), before)
    server.wait()
    expect(server.metric("ready") == 1 and server.get(f"/{ZOOM}/{COLUMN}/{ROW}.png")[0] == 200, "it is not ready")
    server.stop()


def test_log():
    """With -v a line of JSON for each request; what a path has of its own does not break it."""
    write_map("map.json")
    server = Server("map.json", "-v")
    tile = f"/{ZOOM}/{COLUMN}/{ROW}.png"
    body = server.get(tile)[2]
    server.request(tile, "HEAD")
    server.send(b'GET /"\\\x01\xff HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n')
    server.request(tile, "POST")
    server.stop()
    lines = [json.loads(line) for line in server.errors if line.startswith("{")]
    lines = [line for line in lines if line["path"] != "/health"]
    # Answers of different connections may be told in another order.
    told = {(line["method"], line["status"]): line for line in lines}
    expect(len(lines) == 4 and set(told) == {("GET", 200), ("HEAD", 200), ("GET", 404), ("POST", 405)}, lines)
    for method, size in (("GET", len(body)), ("HEAD", 0)):
        line = told[method, 200]
        expect((line["path"], line["route"], line["bytes"]) == (tile, "tile", size), line)
    expect(told["GET", 404]["path"].startswith('/"\\'), lines)
    for line in lines:
        expect(re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z", line["time"]) and line["ms"] >= 0, line)


def test_usage():
    write_map("map.json")
    for arguments, status in (((), 2), (("-",), 2), (("map.json", "--style", "-"), 2), (("none.json",), 66),
                              (("map.json", "--listen", "8080"), 2), (("map.json", "--listen", "a.example:1"), 2),
                              (("map.json", "--listen", "127.0.0.1:65536"), 2), (("map.json", "--max-ratio", "9"), 2),
                              (("map.json", "--listen", "192.0.2.1:0"), 74), (("map.json", "--cors", "x\r\ny"), 2),
                              (("map.json", "--public-url", "ftp://x"), 2),
                              (("map.json", "--cache-dir", "none", "--listen", "127.0.0.1:0"), 74),
                              (("map.json", "--cache-dir", "map.json", "--listen", "127.0.0.1:0"), 74),
                              (("map.json", "--renderd", "x"), 2),
                              (("map.json", "--renderd", "x", "--cache-dir", "none", "--listen", "127.0.0.1:0"), 74),
                              (("map.json", "--edit", "x", "--style", "y"), 2)):
        done = subprocess.run([TOOL, "serve", *arguments], capture_output=True, text=True, timeout=PATIENCE_S)
        expect(done.returncode == status, f"{arguments}: {done.returncode}, not {status}: {done.stderr}")
        last = done.stderr.splitlines()[-1]
        expect(last.startswith("camber: "), done.stderr)
    with open("bad.json", "w", encoding="utf-8") as file:
        file.write('{"type": "FeatureCollection", "features": [')
    done = subprocess.run([TOOL, "serve", "bad.json", "-q", "--listen", "127.0.0.1:0"], capture_output=True, text=True,
                          timeout=PATIENCE_S)
    expect(done.returncode == 65 and done.stderr.count("\n") == 1, f"bad input: {done.returncode} {done.stderr}")
    # Nobody is told the address of a server that ends at once.
    for name, status in (("bad.json", 65), ("none.json", 66)):
        done = subprocess.run([TOOL, "serve", name, "--listen", "127.0.0.1:0"], capture_output=True, text=True, timeout=PATIENCE_S)
        expect(done.returncode == status and "http://" not in done.stderr, f"{name}: {done.returncode} {done.stderr}")
    server = Server("map.json")
    done = subprocess.run([TOOL, "serve", "map.json", "--listen", f"127.0.0.1:{server.port}"], capture_output=True,
                          text=True, timeout=PATIENCE_S)
    expect(done.returncode == 74 and "in use" in done.stderr, f"a port in use: {done.returncode} {done.stderr}")
    server.stop()


def test_public_url():
    """Who listens everywhere is told that tiles.json names an address that is of use here alone."""
    write_map("map.json")
    for options in ((), ("--public-url", "https://tiles.example.org")):
        child = subprocess.Popen([TOOL, "serve", "map.json", "--listen", "0.0.0.0:0", *options], stderr=subprocess.PIPE,
                                 text=True)
        said = ""
        while "ready after" not in said:
            line = child.stderr.readline()
            expect(line, f"it ended: {said}")
            said += line
        child.terminate()
        child.wait()
        expect(("--public-url" in said) != bool(options), said)
        expect(re.search(r"^(http://0\.0\.0\.0:\d+|https://tiles\.example\.org)/$", said, re.M), said)


def test_caching():
    write_map("map.json")
    server = Server("map.json")
    path = f"/{ZOOM}/{COLUMN}/{ROW}.png"
    first = server.get(path)
    tag = first[1]["etag"]
    expect(re.fullmatch(r'"[0-9a-f]{24}"', tag), tag)
    expect(server.get(path) [2] == first[2] and server.metric("cache_hits_total") == 1, "it is not cached")
    for known in (tag, f'"x", {tag}', "W/" + tag, "*"):
        status, headers, body = server.request(path, If_None_Match=known)
        expect(status == 304 and body == b"" and headers["etag"] == tag, f"{known}: {status} {headers}")
        expect("cache-control" in headers and "content-encoding" not in headers, headers)
    for unknown in ('"x"', tag[:-2] + '"', ""):
        expect(server.request(path, If_None_Match=unknown)[0] == 200, unknown)
    expect(server.request(path, If_Modified_Since=first[1]["last-modified"])[0] == 304, "If-Modified-Since")
    expect(server.request(path, If_None_Match='"x"', If_Modified_Since=first[1]["last-modified"])[0] == 200, "both")
    for asked in (path, "/tiles.json", "/", "/health", "/none", "/static/9.14,55.2,11/100x100.png"):
        got, head = server.request(asked), server.request(asked, "HEAD")
        same = all(got[1].get(name) == head[1].get(name) for name in ("content-length", "etag", "content-type"))
        expect(got[0] == head[0] and head[2] == b"" and same, f"HEAD {asked}: {head} {got[1]}")

    plain = server.get("/")
    packed = server.request("/", Accept_Encoding="br, gzip")
    expect("content-encoding" not in plain[1] and packed[1]["content-encoding"] == "gzip", packed[1])
    expect(gzip.decompress(packed[2]) == plain[2] and packed[1]["etag"] != plain[1]["etag"], "gzip")
    expect(plain[1]["vary"] == packed[1]["vary"] == "Accept-Encoding", packed[1])
    expect(server.request("/", Accept_Encoding="gzip", If_None_Match=packed[1]["etag"])[0] == 304, "304 of gzip")
    expect("content-encoding" not in server.request(path, Accept_Encoding="gzip")[1], "a PNG is packed again")
    server.stop()


# ---- Hostile clients ----


def status_of(back):
    found = re.match(rb"HTTP/1\.[01] (\d\d\d) ", back)
    return int(found.group(1)) if found else None


def test_hostile():
    write_map("map.json")
    server = Server("map.json")
    inside = f"/{ZOOM}/{COLUMN}/{ROW}.png".encode()
    paths = [b"/../../etc/passwd", b"/%2e%2e/%2e%2e/etc/passwd", b"/..%2f..%2fetc/passwd", b"/page/../../etc/passwd",
             b"/page/%2e%2e%2f", b"//etc/passwd", inside + b"%00", inside + b"/..", b"/%00", b"/\xff\xfe",
             b"/99999999999999999999/0/0.png", b"/1/4294967296/0.png", b"/1/-1/0.png", b"/0/0/0.png%20", b"/0x0/0/0.png",
             b"/static/1e308,0,0/1x1.png", b"/static/0,0,0/99999x99999.png", b"<script>alert(1)</script>", b"/<b>",
             b"http:///0/0/0.png", b"*", b"0/0/0.png"]
    for path in paths:
        back = server.send(b"GET " + path + b" HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
        expect(400 <= (status_of(back) or 0) < 500, f"{path}: {back[:200]}")
        expect(b"script" not in back and b"passwd" not in back and b"root" not in back, f"{path}: {back[:300]}")
    for request in (b"GET " + inside + b"\0 HTTP/1.1\r\nHost: x\r\n\r\n", b"\0\0\0\0\r\n\r\n", b"GET\r\n\r\n", b"\r\n" * 50,
                    b"GET / HTTP/9.9\r\nHost: x\r\n\r\n", b"GET / HTTP/1.1\r\nContent-Length: -1\r\nHost: x\r\n\r\n",
                    b"GET / HTTP/1.1\r\nHost x\r\n\r\n", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" * 20):
        back = server.send(request, seconds=1)
        expect(status_of(back) is None or 400 <= status_of(back) <= 505 or request.startswith(b"GET / HTTP/9"),
               f"{request[:40]}: {back[:200]}")
    for method in ("POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "BREW"):
        status, headers, _ = server.request(inside.decode(), method)
        expect(status == 405 and headers["allow"] == "GET, HEAD", f"{method}: {status}")

    large = 1 << 20
    back = server.send(b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n" % large + b"x" * large, seconds=3)
    expect(status_of(back) in (405, None), back[:100])
    back = server.send(b"GET /" + b"a" * large + b" HTTP/1.1\r\nHost: x\r\n\r\n", seconds=3)
    expect(status_of(back) in (414, 413, 431, 400, None), back[:100])
    back = server.send(b"GET / HTTP/1.1\r\nHost: x\r\nX: " + b"a" * large + b"\r\n\r\n", seconds=3)
    expect(status_of(back) in (413, 431, 400, None), back[:100])
    back = server.send(b"GET / HTTP/1.1\r\nHost: x\r\n" + b"X: y\r\n" * 200000 + b"\r\n", seconds=3)
    expect(status_of(back) in (413, 431, 400, None), back[:100])

    source, connection = random.Random(7), http.client.HTTPConnection(server.host, server.port, timeout=PATIENCE_S)
    pieces = ["/", "..", "%2e", "%00", "static", "dark", "page", "tiles", ".json", ".png", "@2x", "@", ",", "x", "0", "1",
              "-", "9" * 30, "e5", "nan", "?", "&", ";", "//", "\\", "~", "'", "\"", "health", "events", "{z}"]
    answered = 0
    for _ in range(4000):
        path = "/" + "".join(source.choice(pieces) for _ in range(source.randint(1, 8))).replace("?", "%3f")
        try:
            status = server.request(path, connection=connection)[0]
        except (http.client.HTTPException, ConnectionError, http.client.InvalidURL):
            connection.close()
            continue
        answered += 1
        expect(400 <= status < 500 or path in ("/health", "/tiles.json", "/dark/tiles.json") or status == 200
               and re.fullmatch(r"/+|/(dark/)?(static/.*|[01]/[01]/[01](@2x)?)\.png", path), f"{path}: {status}")
    expect(answered > 3900, f"{answered} answers")
    connection.close()
    expect(server.get(inside.decode())[0] == 200, "it does not answer any more")
    server.stop()


def test_pipelining():
    write_map("map.json")
    server = Server("map.json")
    count = 60
    paths = [f"/{ZOOM}/{COLUMN + i % 8}/{ROW + i // 8}.png" for i in range(count)]
    data = b"".join(f"GET {path} HTTP/1.1\r\nHost: x\r\n\r\n".encode() for path in paths[:-1])
    data += f"GET {paths[-1]} HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n".encode()
    back = server.send(data)
    for path in paths:
        head, _, back = back.partition(b"\r\n\r\n")
        expect(status_of(head) == 200, f"{path}: {head}")
        size = int(re.search(rb"Content-Length: (\d+)", head).group(1))
        expect(back[:size] == server.get(path)[2], f"{path}: another tile came")
        back = back[size:]
    expect(back == b"", "more came than was asked for")
    server.stop()


def has_ended(made):
    """Whether the other side has shut the connection down, whatever it had sent before."""
    poller = select.poll()
    poller.register(made, select.POLLRDHUP)
    return any(event & (select.POLLRDHUP | select.POLLHUP | select.POLLERR) for _, event in poller.poll(0))


def test_slow():
    """A request byte by byte, an answer that is not read, one that begins and says nothing more: all are closed, and one
    that takes its time is not."""
    write_map("map.json")
    server = Server("map.json")
    trickle, silent, reader, patient = server.open(), server.open(), server.open(), server.open()
    silent.sendall(b"GET / HT")
    reader.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
    server.get(f"/{ZOOM}/{COLUMN}/{ROW}@4x.png")
    reader.settimeout(2)
    try:
        while True: # until neither side can write
            reader.sendall(f"GET /{ZOOM}/{COLUMN}/{ROW}@4x.png HTTP/1.1\r\nHost: x\r\n\r\n".encode() * 100)
    except socket.timeout:
        pass
    open_ones = {"trickle": trickle, "silent": silent, "reader": reader}
    trickle.sendall(b"GET / HTTP/1.1\r\nX: ")
    for piece in (b"GET /hea", b"lth HTTP/1.1\r\nHost: x\r\nConne", b"ction: close\r\n\r\n"):
        patient.sendall(piece)
        time.sleep(0.5)
    expect(status_of(patient.recv(1 << 16)) == 200, "one that takes its time is closed")

    def are_closed():
        for name, made in list(open_ones.items()):
            try:
                if name == "trickle":
                    made.sendall(b"a")
                made.settimeout(0.05)
                if name != "reader" and made.recv(1) == b"" or name == "reader" and has_ended(made):
                    del open_ones[name]
            except socket.timeout:
                pass
            except OSError:
                del open_ones[name]
        expect(server.get("/health")[0] == 200, "slow clients stop the others")
        return not open_ones

    wait_until(are_closed, lambda: f"slow clients that are not closed: {list(open_ones)}")
    for made in (trickle, silent, reader, patient):
        made.close()
    server.stop()


def test_idle():
    write_map("map.json")
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    count = min(10000, hard - 300)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, count + 200), hard))
    server = Server("map.json")
    before, made = server.resident(), []
    for _ in range(count):
        made.append(server.open())
    expect(server.get(f"/{ZOOM}/{COLUMN}/{ROW}.png")[0] == 200, "idle connections stop the others")
    wait_until(lambda: server.metric("connections") > 0.8 * count, lambda: f"connections: {server.metric('connections')}")
    expect(server.resident() - before < count * 20000 + (64 << 20), f"{server.resident() - before} bytes more")
    for one in made:
        one.close()
    wait_until(lambda: server.metric("connections") <= 10, "closed connections stay")
    resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    server.stop()


def test_overload():
    write_map("map.json", count=400)
    server = Server("map.json", "--cache", "256K")
    results, lock = {}, threading.Lock()

    def ask(first):
        connections = [http.client.HTTPConnection(server.host, server.port, timeout=PATIENCE_S) for _ in range(60)]
        for i, one in enumerate(connections):
            n = first * 60 + i
            one.request("GET", f"/16/{8 * COLUMN + 2 * (n % 32)}/{8 * ROW + 2 * (n // 32)}@4x.webp")
        for one in connections:
            answer = one.getresponse()
            answer.read()
            with lock:
                results[answer.status] = results.get(answer.status, 0) + 1
                if answer.status == 503:
                    expect(answer.getheader("Retry-After") == "1", "503 without Retry-After")
            one.close()

    threads = [threading.Thread(target=ask, args=(first,)) for first in range(8)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    expect(set(results) == {200, 503}, f"overload: {results}")
    expect(server.metric("queue_refused_total") == results[503], "refused requests are not counted")
    expect(server.get(f"/16/{8 * COLUMN}/{8 * ROW}@4x.webp")[0] == 200, "it does not recover")
    server.stop()


def test_left():
    """Pictures that nobody waits for any more are not drawn."""
    write_map("map.json", count=400)
    server = Server("map.json")
    for i in range(100):
        made = server.open()
        made.sendall(f"GET /static/{i / 10},55,{i / 10}/2048x2048.png HTTP/1.1\r\nHost: x\r\n\r\n".encode())
        made.close()
    expect(server.get(f"/{ZOOM}/{COLUMN}/{ROW}.png")[0] == 200, "those who left stop the others")
    wait_until(lambda: server.metric("queue") == 0, "the queue stays")
    expect(server.metric("queue_dropped_total") > 0, f"dropped: {server.metric('queue_dropped_total')}")
    server.stop()


def test_memory():
    if is_sanitized():
        print("the sanitizer keeps what was freed: test_memory is left out")
        return
    write_map("map.json", count=300)
    server = Server("map.json", "--cache", "1M")
    source, connection = random.Random(3), http.client.HTTPConnection(server.host, server.port, timeout=PATIENCE_S)

    def ask(count):
        for _ in range(count):
            zoom = source.randint(12, 17)
            scale = 2.0 ** (zoom - ZOOM)
            x, y = int((COLUMN + source.uniform(-6, 6)) * scale), int((ROW + source.uniform(-6, 6)) * scale)
            expect(server.request(f"/{zoom}/{x}/{y}.png", connection=connection)[0] == 200, "a tile")

    ask(2500)
    before = server.resident()
    ask(5000)
    expect(server.resident() < 1.05 * before + (8 << 20), f"memory: {before} bytes, then {server.resident()}")
    expect(server.metric("cache_bytes") <= 1 << 20, "the cache has grown")
    connection.close()
    server.stop()


# ---- Signals ----


def test_reload():
    write_map("map.json")
    server = Server("map.json")
    path, stop, results = f"/{ZOOM}/{COLUMN}/{ROW}.png", threading.Event(), []

    def ask(seed):
        source, connection = random.Random(seed), http.client.HTTPConnection(server.host, server.port, timeout=PATIENCE_S)
        while not stop.is_set():
            x, y = COLUMN + source.randint(-3, 3), ROW + source.randint(-3, 3)
            results.append(server.request(f"/{ZOOM}/{x}/{y}.png", connection=connection)[0])
        connection.close()

    threads = [threading.Thread(target=ask, args=(seed,)) for seed in range(4)]
    for one in threads:
        one.start()
    tag = server.get(path)[1]["etag"]
    for seed in (2, 3, 4):
        write_map("new.json", seed=seed)
        os.rename("new.json", "map.json")
        server.process.send_signal(signal.SIGHUP)
        wait_until(lambda: server.get(path)[1]["etag"] != tag, "SIGHUP changes nothing")
        tag = server.get(path)[1]["etag"]
    with open("map.json", "w", encoding="utf-8") as file:
        file.write("{")
    server.process.send_signal(signal.SIGHUP)
    wait_until(lambda: any("still serving the previous map" in line for line in server.errors),
               lambda: f"a broken input is not told: {server.errors}")
    expect(server.get(path)[1]["etag"] == tag, "a broken input changes what is served")
    wait_until(lambda: len(results) > 100, lambda: f"{len(results)} requests in all this time")
    stop.set()
    for one in threads:
        one.join()
    expect(set(results) == {200}, f"requests while it reads again: {set(results)}")
    server.stop()


def serve_busy(count):
    """A server of as many lines that ten clients wait for, and the answers that there are, which ask(i) adds to."""
    write_map("map.json", count=count)
    server, results = Server("map.json"), []

    def ask(i):
        status, _, body = server.get(f"/static/9.{i},55.2,11/2000x2000.png")
        results.append((status, body[-8:]))

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(10)]
    for one in threads:
        one.start()
    wait_until(lambda: server.metric("requests_in_flight") - 1 + len(results) >= 10,  # the question itself is one
               "not all requests arrive")
    return server, threads, results


def test_end():
    """SIGTERM ends what is begun; kill -9 leaves nothing in the way of the next."""
    for count in (400, 1200, 4000):  # until drawing takes longer than asking
        server, threads, results = serve_busy(count)
        is_busy = len(results) < 10
        server.stop()
        for one in threads:
            one.join()
        expect(len(results) == 10 and all(status == 200 and tail == b"IEND\xaeB`\x82" for status, tail in results), results)
        if is_busy:
            break
    expect(is_busy, "nothing is begun any more")

    port = find_port()
    server = Server("map.json", listen=f"127.0.0.1:{port}")
    server.get(f"/{ZOOM}/{COLUMN}/{ROW}.png")
    server.stop(signal.SIGKILL, -signal.SIGKILL)
    server = Server("map.json", listen=f"127.0.0.1:{port}")
    server.stop(signal.SIGINT, 130)


def test_reach():
    """It opens what its command line named, drivers and libraries, and nothing by a request."""
    if not shutil.which("strace"):
        print("no strace: test_reach is left out")
        return
    write_map("map.json")
    with open("secret.txt", "w", encoding="utf-8") as file:
        file.write("secret")
    no_leaks = "ASAN_OPTIONS=detect_leaks=0:" + os.environ.get("ASAN_OPTIONS", "")  # which cannot run under strace
    server = Server("map.json", wrapper=("strace", "-f", "-qq", "-o", "trace", "-E", no_leaks,
                                         "-e", "trace=open,openat,openat2,stat"))
    server.get(f"/{ZOOM}/{COLUMN}/{ROW}.png")
    server.get("/static/9.14,50.1,11/300x200.png")
    size = os.path.getsize("trace")
    for path in ("/secret.txt", "/page/secret.txt", "/../secret.txt", "/%2e%2e/map.json", "/etc/passwd", "/page/map.json",
                 f"/{ZOOM}/{COLUMN + 1}/{ROW}.png", "/dark/0/0/0.png", "/", "/tiles.json", "/static/9,55,9/30x20.webp"):
        server.get(path)
    child = int(subprocess.run(["pgrep", "-P", str(server.process.pid)], capture_output=True, text=True,
                               check=True).stdout.split()[0])
    os.kill(child, signal.SIGTERM)
    expect(server.process.wait(timeout=PATIENCE_S) == 0, "it does not end")
    with open("trace", encoding="utf-8", errors="replace") as file:
        whole = file.read()
        file.seek(size)
        late = file.read()
    opened = set(re.findall(r'open(?:at2?)?\((?:AT_FDCWD, )?"([^"]*)"', late))
    allowed = re.compile(r"/proc/|/sys/|/dev/|/usr/|/lib|/etc/(ld|OpenCL|localtime)|.*/camber|.*pocl")
    expect(not [path for path in opened if not allowed.match(path)], f"opened by requests: {opened}")
    expect("secret" not in whole, "it has looked for what a path named")


# Every file system that may be written to becomes one that may not, but an own one for the compiler of kernels. Its last
# words are the command, as a user without rights.
READ_ONLY = """for place in $(cut -d' ' -f2 /proc/self/mounts | sort -r); do mount -o remount,bind,ro $place; done 2>/dev/null
mount -t tmpfs -o mode=777 none cache && ! touch here 2>/dev/null && XDG_CACHE_HOME=$PWD/cache POCL_CACHE_DIR=$PWD/cache/pocl \
exec setpriv --reuid=65534 --regid=65534 --clear-groups --no-new-privs --bounding-set=-all "$@" """


def test_unprivileged():
    """It serves as a user without rights, and needs no file that it may write but the folder of compiled kernels."""
    write_map("map.json")
    os.mkdir("cache")
    os.chmod(".", 0o755)
    wrapper = ("unshare", "--mount", "sh", "-c", READ_ONLY, "sh")
    if os.geteuid() != 0 or subprocess.run([*wrapper, TOOL, "--version"], capture_output=True, check=False).returncode != 0:
        print("test_unprivileged: no root, no mounts, or the tool lies where others cannot go: skipped")
        return
    server = Server("map.json", wrapper=wrapper)
    with open(f"/proc/{server.process.pid}/status", encoding="ascii") as file:
        about = file.read()
    expect(re.search(r"^Uid:(\t65534){4}$", about, re.M) and re.search("^CapEff:\t0+$", about, re.M), about)
    for path in (f"/{ZOOM}/{COLUMN}/{ROW}.png", f"/{ZOOM}/{COLUMN}/{ROW}@2x.webp", "/static/9.14,50.1,11/300x200.png", "/"):
        expect(server.get(path)[0] == 200, path)
    server.stop()


STYLE = {"version": 8, "sources": {}, "layers": [
    {"id": "back", "type": "background", "paint": {"background-color": "#ffffff"}},
    {"id": "roads", "type": "line", "paint": {"line-color": "#000000", "line-width": 3}}]}


def save_style(color):
    STYLE["layers"][1]["paint"]["line-color"] = color
    with open("style.new", "w", encoding="utf-8") as file:
        json.dump(STYLE, file)
    os.rename("style.new", "style.json")


class Events:
    """What the server tells those who listen, as it comes."""

    def __init__(self, server):
        self.made, self.got = server.open(), b""
        self.made.settimeout(0.1)
        self.made.sendall(b"GET /events HTTP/1.1\r\nHost: x\r\n\r\n")

    def wait(self, wanted):
        """The first event that wanted takes."""
        end = time.monotonic() + PATIENCE_S
        while True:
            for text in re.findall(rb"event: style\ndata: (.*)\n\n", self.got):
                event = json.loads(text)
                if wanted(event):
                    return event
            expect(time.monotonic() < end, f"no such event: {self.got}")
            try:
                self.got += self.made.recv(4096)
            except socket.timeout:
                pass


def test_edit():
    write_map("map.json")
    save_style("#0000ff")
    server = Server("map.json", "--edit", "style.json")
    path, listeners = f"/{ZOOM}/{COLUMN}/{ROW}.png", [Events(server), Events(server)]
    about = json.loads(server.get("/tiles.json")[2])
    expect(about["camber"] == {"theme": None, "drawn": True, "ratio_max": 4, "edit": True}, about)
    first = listeners[0].wait(lambda event: event["error"] is None)["revision"]
    expect(b"text/event-stream" in listeners[0].got, listeners[0].got)
    blue = server.get(path)
    expect(blue[1]["cache-control"] == "no-cache", blue[1])
    save_style("#ff0000")
    for one in listeners:
        one.wait(lambda event: event["revision"] == first + 1 and event["error"] is None)
    red = server.get(path)
    expect(red[2] != blue[2], "the style has not changed")
    with open("style.json", "w", encoding="utf-8") as file:
        file.write('{"version": 8,\n "layers": [\n{"id": 3,,}]}')
    event = listeners[0].wait(lambda event: event["error"])
    expect("style.json" in event["error"] and "line 3" in event["error"], event)
    expect(event["revision"] == first + 1 and server.get(path)[2] == red[2], "a broken style is shown")
    late = Events(server)
    late.wait(lambda event: event["error"] and "line 3" in event["error"])
    os.remove("style.json")
    time.sleep(0.5)  # it may look meanwhile, and finds no style: nothing happens
    save_style("#0000ff")
    late.wait(lambda event: event["revision"] == first + 2 and event["error"] is None)
    expect(server.get(path)[2] == blue[2], "the style is not what it was")
    expect(server.request("/events", "HEAD")[0] == 503, "HEAD of events")
    listeners[0].made.close()
    server.stop()
    server = Server("map.json")
    expect(server.get("/events")[0] == 404, "events without --edit")
    server.stop()


def test_own_sources():
    """A style that names its own sources needs no input; they are read again with it."""
    write_map("map.json")
    tiles = "mbtiles://" + os.path.join(TESTS, "data", "santa_cruz", "osm.mbtiles")
    path = f"/{ZOOM}/{COLUMN}/{ROW}.png"
    for asked, source, layer in (("/14/2639/6375.png", {"type": "vector", "url": tiles}, "roads"),
                                 (path, {"type": "geojson", "data": "map.json", "attribution": "(c) Them"}, "")):
        line = {"id": "lines", "type": "line", "source": "own", "paint": {"line-color": "#ff0000", "line-width": 3}}
        style = {"version": 8, "sources": {"own": source}, "layers": [{**line, "source-layer": layer} if layer else line]}
        with open("style.json", "w", encoding="utf-8") as file:
            json.dump(style, file)
        server = Server("--style", "style.json")
        rows = decode(server.get(asked)[2])
        expect(len({row[i:i + 4] for row in rows for i in range(0, len(row), 4)}) > 9, f"{asked}: nothing is drawn")
        about = json.loads(server.get("/tiles.json")[2])
        expect(about["name"] == "style" and len(about["bounds"]) == 4, about)
        if not layer:
            break
        server.stop()
    expect(about["attribution"] == "(c) Them", about)
    tag = server.get(path)[1]["etag"]
    write_map("map.json", seed=2)
    server.process.send_signal(signal.SIGHUP)
    wait_until(lambda: server.get(path)[1]["etag"] != tag, lambda: f"sources are not read again: {server.errors}")
    server.stop()
    expect(any("reloaded style.json" in line for line in server.errors), server.errors)
    server = Server("--edit", "style.json")
    expect(server.get(path)[0] == 200, "--edit without INPUT")
    server.stop()


def test_drawn():
    """Bounds are of what is drawn, and a map in which nothing is drawn says so."""
    layer = {"id": "roads", "type": "line", "filter": ["has", "highway"]}
    road, other = ({"type": "Feature", "properties": {key: "x"}, "geometry": {"type": "LineString", "coordinates": line}}
                   for key, line in (("highway", [[5, 5], [6, 6]]), ("boundary", [[-60, -60], [60, 60]])))
    for path, content in (("roads.json", {"version": 8, "sources": {}, "layers": [layer]}),
                          ("map.json", {"type": "FeatureCollection", "features": [road, other]}), ("none.json", other)):
        with open(path, "w", encoding="utf-8") as file:
            json.dump(content, file)
    server = Server("map.json", "--style", "roads.json")
    about = json.loads(server.get("/tiles.json")[2])
    expect(all(abs(one - wanted) < 1e-5 for one, wanted in zip(about["bounds"], (5, 5, 6, 6))), about)
    expect(not any("warning" in line for line in server.errors), server.errors)
    os.rename("none.json", "map.json")
    server.process.send_signal(signal.SIGHUP)
    wait_until(lambda: any("warning: nothing is drawn: 1 line of" in line for line in server.errors), lambda: server.errors)
    server.stop()


# ---- Tiles ----


def test_tiles():
    """They are those of camber tiles, in bytes, also of lines that turn back on themselves outside a tile."""
    write_map("map.json", count=200, turn=math.pi)
    done = subprocess.run([TOOL, "tiles", "map.json", "-o", "there/", "--keep-empty", "-q", "--max-zoom", "14", "-f"],
                          capture_output=True, text=True, timeout=PATIENCE_S)
    expect(done.returncode == 0, done.stderr)
    server, compared = Server("map.json"), 0
    for zoom in range(15):
        scale = 2.0 ** (zoom - ZOOM)
        for dx in (-2, 0, 1):
            for dy in (-1, 0, 2):
                x, y = int((COLUMN + dx) * scale), int((ROW + dy) * scale)
                path = f"there/{zoom}/{x}/{y}.png"
                expect(os.path.exists(path), f"{path} is not drawn")
                with open(path, "rb") as file:
                    wanted = file.read()
                got = server.get(f"/{zoom}/{x}/{y}.png")[2]
                compared += 1
                expect(got == wanted, f"{zoom}/{x}/{y}: differs by {difference(decode(got), decode(wanted))}")
    expect(compared == 135, f"{compared} tiles are compared")
    server.stop()


def make_archive(*options):
    """What camber tiles draws of map.json: tiles by zoom, column and row."""
    done = subprocess.run([TOOL, "tiles", "map.json", "-o", "there.mbtiles", "-q", "-f", *options], capture_output=True,
                          text=True, timeout=PATIENCE_S, check=False)
    expect(done.returncode == 0, done.stderr)
    with sqlite3.connect("there.mbtiles") as base:
        rows = base.execute("select zoom_level, tile_column, tile_row, tile_data from tiles").fetchall()
    return {(z, x, 2 ** z - 1 - y): data for z, x, y, data in rows}


def count_off(one, other):
    """How many pixels differ by more than one level."""
    return sum(sum(max(abs(p - q) for p, q in zip(a[i:i + 4], b[i:i + 4])) > 1 for i in range(0, len(a), 4))
               for a, b in zip(one, other) if a != b)


def test_labels():
    """They are where camber tiles draws them, in every order of requests; a picture of a view has those of the view."""
    write_map("map.json", count=600)
    with open("map.json", encoding="utf-8") as file:
        roads = json.load(file)
    for i, road in enumerate(roads["features"]):
        road["properties"]["name"] = f"Road {i % 40}"
    with open("map.json", "w", encoding="utf-8") as file:
        json.dump(roads, file)
    zooms = ("--min-zoom", "12", "--max-zoom", "14")
    wanted, plain = make_archive(*zooms), make_archive(*zooms, "--no-labels")
    labelled = [key for key in wanted if wanted[key] != plain.get(key)]
    expect(len(labelled) > 40, f"{len(labelled)} tiles have labels")
    random.Random(3).shuffle(labelled)
    server = Server("map.json")
    for zoom, x, y in labelled[:50]:
        got = server.get(f"/{zoom}/{x}/{y}.png")[2]
        expect(got == wanted[zoom, x, y], f"{zoom}/{x}/{y} differs")
    dense = make_archive(*zooms, "--ratio", "2")
    for zoom, x, y in labelled[:12]:
        expect(server.get(f"/{zoom}/{x}/{y}@2x.png")[2] == dense[zoom, x, y], f"{zoom}/{x}/{y}@2x differs")
    there = (COLUMN / 2 ** ZOOM * 360 - 180, math.degrees(math.atan(math.sinh(math.pi * (1 - 2 * ROW / 2 ** ZOOM)))))
    # No whole zoom with north up: there render has the labels of tiles, and a server's pictures those of the view.
    for zoom, bearing, pitch in ((13.2, 0, 0), (13.4, 0, 0), (13, 40, 0), (13.5, -30, 50)):
        drawn = []
        for options in ([], ["--no-labels"]):
            done = subprocess.run([TOOL, "render", "map.json", "-o", "view.png", "-q", "-f", "--size", "500x400",
                                   f"--center={there[0]:.9f},{there[1]:.9f}", "--zoom", str(zoom), f"--bearing={bearing}",
                                   "--pitch", str(pitch), *options], capture_output=True, text=True,
                                  timeout=PATIENCE_S, check=False)
            expect(done.returncode == 0, done.stderr)
            with open("view.png", "rb") as file:
                drawn.append(decode(file.read()))
        path = f"/static/{there[0]:.9f},{there[1]:.9f},{zoom}@{bearing},{pitch}/500x400.png"
        got = decode(server.get(path)[2])
        expect(count_off(*drawn) > 100, f"{path}: a view with few labels: {count_off(*drawn)}")
        expect(difference(got, drawn[0]) <= 1, f"{path} differs by {difference(got, drawn[0])}")
    server.stop()


XYZ = """<GDAL_WMS><Service name="TMS"><ServerUrl>%s/${z}/${x}/${y}.png</ServerUrl></Service><DataWindow>
<UpperLeftX>-20037508.342789244</UpperLeftX><UpperLeftY>20037508.342789244</UpperLeftY>
<LowerRightX>20037508.342789244</LowerRightX><LowerRightY>-20037508.342789244</LowerRightY>
<TileLevel>%d</TileLevel><TileCountX>1</TileCountX><TileCountY>1</TileCountY><YOrigin>top</YOrigin></DataWindow>
<Projection>EPSG:3857</Projection><BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY><BandsCount>4</BandsCount>
</GDAL_WMS>"""


def test_gdal():
    """GDAL, and by it QGIS, reads the tiles by an XYZ description."""
    if not shutil.which("gdal_translate"):
        print("test_gdal: no gdal_translate (Debian: gdal-bin): skipped")
        return
    write_map("map.json")
    server = Server("map.json")
    with open("xyz.xml", "w", encoding="utf-8") as file:
        file.write(XYZ % (server.url, ZOOM))
    box = [256 * COLUMN, 256 * ROW, 512, 512]
    done = subprocess.run(["gdal_translate", "-q", "-of", "ENVI", "-co", "INTERLEAVE=BIP", "-srcwin", *map(str, box),
                           "xyz.xml", "read.bin"], capture_output=True, text=True, timeout=PATIENCE_S,
                          env={**os.environ, "no_proxy": "*", "NO_PROXY": "*"})
    if "GDAL_WMS" in done.stderr and done.returncode:
        print(f"test_gdal: GDAL without this driver: skipped: {done.stderr}")
        return
    expect(done.returncode == 0, done.stderr)
    with open("read.bin", "rb") as file:
        read = file.read()
    tiles = [[decode(server.get(f"/{ZOOM}/{COLUMN + x}/{ROW + y}.png")[2]) for x in (0, 1)] for y in (0, 1)]
    rows = [tiles[y // 256][0][y % 256] + tiles[y // 256][1][y % 256] for y in range(512)]
    expect(read == b"".join(bytes(row) for row in rows), "GDAL reads other pixels")
    server.stop()


def test_archives():
    write_map("map.json")
    for name, size in (("a.pmtiles", 256), ("a.mbtiles", 512), ("a/", 256)):
        done = subprocess.run([TOOL, "tiles", "map.json", "-o", name, "-q", "--min-zoom", "8", "--max-zoom", "13", "-f",
                               "--tile-size", str(size), "--name", "Archive", "--attribution", "(c) Them"], capture_output=True, text=True,
                              timeout=PATIENCE_S)
        expect(done.returncode == 0, done.stderr)
    with sqlite3.connect("a.mbtiles") as made:  # then the first tile tells
        made.execute("DELETE FROM metadata WHERE name = 'format'")
    made.close()
    tile, body = f"{ZOOM}/{COLUMN}/{ROW}.png", None
    with open("a/" + tile, "rb") as file:
        body = file.read()
    for name, size in (("a.pmtiles", 256), ("a.mbtiles", 512), ("a/", 256), ("a", 256)):
        server = Server(name)
        about = json.loads(server.get("/tiles.json")[2])
        expect(about["name"] == "Archive" and about["attribution"] == "(c) Them", about)
        expect((about["minzoom"], about["maxzoom"], about["camber"]["theme"]) == (8, 13, None), about)
        expect(about["camber"]["ratio_max"] == 1 and len(about["bounds"]) == 4, about)
        expect(not about["camber"]["drawn"] and about["tileSize"] == size, about)
        status, headers, got = server.get("/" + tile)
        expect(status == 200 and (got == body or size == 512) and headers["content-type"] == "image/png",
               f"{name}: {status}")
        expect(server.request("/" + tile, If_None_Match=headers["etag"])[0] == 304, "304 of an archive")
        for path in (f"/{ZOOM}/0/0.png", "/24/0/0.png"):
            status, headers, nothing = server.get(path)
            expect(status == 204 and nothing == b"" and "content-type" not in headers, f"{name}: {path}: {status}")
        for path in (f"/{ZOOM}/{COLUMN}/{ROW}.webp", f"/{ZOOM}/{COLUMN}/{ROW}@2x.png", "/dark/" + tile,
                     "/static/0,0,0/10x10.png", "/static/0,0,0/9999x10.png"):
            expect(server.get(path)[0] == 404, f"{name}: {path}")
        server.stop()
    subprocess.run([TOOL, "tiles", "map.json", "-o", "dark.mbtiles", "-q", "--max-zoom", "9", "--theme", "dark"],
                   check=True, timeout=PATIENCE_S)
    server = Server("dark.mbtiles")
    about = json.loads(server.get("/tiles.json")[2])
    expect(about["camber"]["theme"] == "dark", f"an archive of a dark map: {about}")
    server.stop()
    server = Server("a.pmtiles")
    write_map("map.json", seed=9)
    subprocess.run([TOOL, "tiles", "map.json", "-o", "a.pmtiles", "-q", "--max-zoom", "13", "-f"], check=True, timeout=PATIENCE_S)
    server.process.send_signal(signal.SIGHUP)
    wait_until(lambda: server.get("/" + tile)[2] != body, "SIGHUP does not open the archive again")
    server.stop()


def test_tileset():
    """A folder of mesh tiles has a tileset, whose files are named by numbers; other archives have none."""
    write_map("map.json")
    for name in ("m/", "m.pmtiles"):
        done = subprocess.run([TOOL, "tiles", "map.json", "-o", name, "-q", "--format", "glb", "--min-zoom", "8", "--max-zoom", "13"],
                              capture_output=True, text=True, timeout=PATIENCE_S, check=False)
        if "this build writes no mesh tiles" in done.stderr:
            print("test_tileset: no meshoptimizer: skipped")
            return
        expect(done.returncode == 0, done.stderr)
    subtrees = sorted(os.listdir("m/subtrees"))
    paths = ["tileset.json", *("subtrees/" + name for name in subtrees)]
    expect(len(subtrees) > 1, subtrees)
    for name in ("m/", "m"):
        server = Server(name)
        for path in paths:
            with open("m/" + path, "rb") as file:
                body = file.read()
            status, headers, got = server.get("/" + path)
            kind = "application/json" if path == "tileset.json" else "application/octet-stream"
            expect(status == 200 and got == body and headers["content-type"] == kind, f"{path}: {status}")
            expect(server.request("/" + path, If_None_Match=headers["etag"])[0] == 304, "304 of a tileset")
        # A viewer writes two slashes where a tileset lies at the root.
        expect(server.get("//" + paths[1])[0] == 200, "two slashes")
        for path in ("/subtrees/0.0.1.subtree", "/subtrees/7.0.0.subtree", "/metadata.json", "/subtrees/metadata.json"):
            expect(server.get(path)[0] == 404, path)
        expect(server.metric('requests_total{route="tileset",status="200"}') == 1, "tilesets are not counted")
        server.stop()
    server = Server("m.pmtiles")
    expect(server.get("/" + paths[0])[0] == server.get("/" + paths[1])[0] == 404, "a tileset of PMTiles")
    server.stop()
    subprocess.run([TOOL, "tiles", "merge", "m.pmtiles", "-o", "again/", "-q"], check=True, timeout=PATIENCE_S)
    for path in paths:
        with open("m/" + path, "rb") as one, open("again/" + path, "rb") as other:
            expect(one.read() == other.read(), f"{path} of a folder that was merged")


def test_cut_archive():
    """An archive that is cut or overwritten while it is served: errors, and no end of the server."""
    write_map("map.json")
    for name, ending in (("a.pmtiles", "pmtiles"), ("a.mbtiles", "mbtiles")):
        subprocess.run([TOOL, "tiles", "map.json", "-o", name, "-q", "--max-zoom", "13", "-f"], check=True, timeout=PATIENCE_S)
        server = Server(name)
        path = f"/{ZOOM}/{COLUMN}/{ROW}.png"
        expect(server.get(path)[0] == 200, f"a tile of {ending}")
        size = os.path.getsize(name)
        with open(name, "r+b") as file:
            file.truncate(size // 2)
        statuses = {server.get(f"/{ZOOM}/{COLUMN + x}/{ROW + y}.png")[0] for x in range(-3, 4) for y in range(-3, 4)}
        expect(statuses <= {200, 204, 500}, f"{name}, cut: {statuses}")
        with open(name, "wb") as file:
            file.write(b"\xff" * size)
        statuses = {server.get(f"/12/{COLUMN // 2 + x}/{ROW // 2 + y}.png")[0] for x in range(-2, 3) for y in range(-2, 3)}
        expect(statuses <= {200, 204, 500}, f"{name}, overwritten: {statuses}")
        expect(server.get("/health")[0] == 200 and server.get("/")[0] == 200, f"{name}: it does not answer any more")
        server.stop()


def test_vector_tiles():
    """An archive of vector tiles is drawn, as any map is."""
    server = Server(os.path.join(TESTS, "data", "santa_cruz", "osm.mbtiles"))
    about = json.loads(server.get("/tiles.json")[2])
    expect(about["camber"]["drawn"] and about["camber"]["theme"] == "light", about)
    status, headers, body = server.get("/14/2639/6375.png")
    expect(status == 200 and headers["content-type"] == "image/png", f"{status}: {headers}")
    rows = decode(body)
    expect(len({row[i:i + 4] for row in rows for i in range(0, len(row), 4)}) > 9, "nothing is drawn")
    server.stop()


# ---- mod_tile ----


RENDER, DIRTY, DONE, NOT_DONE = 1, 2, 3, 4


def metatile_path(folder, zoom, x, y):
    hashes = [(x >> 4 * i & 15) << 4 | (y >> 4 * i & 15) for i in range(5)]
    return os.path.join(folder, "default", str(zoom), *(str(one) for one in reversed(hashes))) + ".meta"


def renderd_message(version, command, zoom, x, y, name=b"default", kind=b"image/png"):
    data = struct.pack("=5i", version, command, x, y, zoom)
    if version > 1:
        data += struct.pack("41s", name)
    return data + {1: b"", 2: b"\xff" * 3, 3: struct.pack("41s41sx", kind, b"")}[version]


def ask_renderd(path, *messages):
    """The commands of the answers, one for each message; None where none comes."""
    with socket.socket(socket.AF_UNIX) as made:
        made.settimeout(PATIENCE_S)
        made.connect(path)
        commands = []
        for message in messages:
            made.sendall(message)
            if struct.unpack_from("=5i", message)[1] == DIRTY:
                made.settimeout(1)
            try:
                back = b""
                while len(back) < len(message):
                    some = made.recv(len(message) - len(back))
                    if not some:
                        return commands + [None]
                    back += some
                expect(back[8:61] == message[8:61], "the answer is of another tile")
                commands.append(struct.unpack_from("=5i", back)[1])
            except socket.timeout:
                commands.append(None)
        return commands


def check_metatile(server, folder, zoom, x, y):
    with open(metatile_path(folder, zoom, x, y), "rb") as file:
        data = file.read()
    magic, count, column, row, level = struct.unpack_from("=4s4i", data)
    expect((magic, count, column, row, level) == (b"META", 64, x, y, zoom), f"{zoom}/{x}/{y}: {data[:20]}")
    end, side = 20 + 8 * 64, min(8, 2 ** zoom)
    for i in range(64):
        offset, size = struct.unpack_from("=2i", data, 20 + 8 * i)
        expect(offset == end, f"tile {i} does not lie behind the one before")
        end += size
        if i // 8 < side and i % 8 < side:
            expect(data[offset:end] == server.get(f"/{zoom}/{x + i // 8}/{y + i % 8}.png")[2], f"tile {i}")
        else:
            expect(size == 0, f"there is no tile {i}")
    expect(end == len(data), "bytes behind the last tile")


def test_renderd():
    write_map("map.json")
    os.mkdir("tiles")
    server = Server("map.json", "--renderd", "socket", "--cache-dir", "tiles")
    for version in (1, 2, 3):
        shutil.rmtree("tiles/default", ignore_errors=True)
        got = ask_renderd("socket", renderd_message(version, RENDER, ZOOM, COLUMN + 1, ROW + 5),
                          renderd_message(version, RENDER, 1, 1, 0))
        expect(got == [DONE, DONE], f"version {version}: {got}")
        expect(server.metric("draw_seconds_count") == 2, "a metatile takes more than one drawing")
        check_metatile(server, "tiles", ZOOM, COLUMN, ROW)
        check_metatile(server, "tiles", 1, 0, 0)
    places = [(ZOOM, COLUMN + 8 * x, ROW + 8 * y) for x in (-1, 0, 1) for y in (-1, 0, 1)] * 2  # each by two clients
    told = [None] * len(places)

    def ask(i):
        told[i] = ask_renderd("socket", renderd_message(3, RENDER, *places[i]))

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(len(places))]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    expect(told == [[DONE]] * len(places), f"at once: {told}")
    for place in places[:9]:
        check_metatile(server, "tiles", *place)
    bad = [renderd_message(3, RENDER, 21, 0, 0), renderd_message(3, RENDER, 3, 8, 0), renderd_message(3, RENDER, 3, -1, 0),
           renderd_message(3, RENDER, -1, 0, 0), renderd_message(3, 0, 3, 0, 0), renderd_message(3, 99, 3, 0, 0),
           renderd_message(3, RENDER, 3, 0, 0, name=b".."), renderd_message(3, RENDER, 3, 0, 0, name=b"a/b"),
           renderd_message(3, RENDER, 3, 0, 0, name=b""), renderd_message(3, RENDER, 3, 0, 0, name=b"a" * 41),
           renderd_message(3, RENDER, 3, 0, 0, kind=b"text/html")]
    got = ask_renderd("socket", *bad)
    expect(got == [NOT_DONE] * len(bad), f"bad requests: {got}")
    expect(ask_renderd("socket", struct.pack("=5i", 4, RENDER, 0, 0, 0)) == [None], "version 4")
    expect(ask_renderd("socket", renderd_message(3, DIRTY, 6, 8, 8)) == [None], "a dirty tile is answered")
    wait_until(lambda: os.path.exists(metatile_path("tiles", 6, 8, 8)), "a dirty tile is not drawn")
    found = [name for folder, _, files in os.walk("tiles") for name in files]
    expect(all(re.fullmatch(r"\d+\.meta", name) for name in found), f"left behind: {found}")
    expect(os.listdir("tiles") == ["default"], f"folders: {os.listdir('tiles')}")
    if shutil.which("render_list"):
        done = subprocess.run(["render_list", "-s", "socket", "-m", "default", "-t", os.path.abspath("tiles"), "-l", "1000", "-z",
                               "12", "-Z", "12", "-x", str(COLUMN // 2 - 8), "-X", str(COLUMN // 2 + 7), "-y", str(ROW // 2 - 8),
                               "-Y", str(ROW // 2 + 7), "-a", "-n", "4", "-f"], capture_output=True, text=True, timeout=PATIENCE_S)
        expect(done.returncode == 0 and "Rendered 4 tiles" in done.stdout + done.stderr, done.stdout + done.stderr)
        check_metatile(server, "tiles", 12, COLUMN // 2 - 8, ROW // 2 - 4 & ~7)
    server.stop()
    expect(not os.path.exists("socket"), "the socket stays")
    server = Server("map.json", "--renderd", "socket", "--cache-dir", "tiles")
    done = subprocess.run([TOOL, "serve", "map.json", "--listen", "127.0.0.1:0", "--renderd", "socket", "--cache-dir",
                           "tiles"], capture_output=True, text=True, timeout=PATIENCE_S)
    expect(done.returncode == 74 and "--renderd socket" in done.stderr, f"a socket in use: {done.stderr}")
    server.stop(signal.SIGKILL, -signal.SIGKILL)
    server = Server("map.json", "--renderd", "socket", "--cache-dir", "tiles")
    expect(ask_renderd("socket", renderd_message(3, RENDER, 9, 0, 0)) == [DONE], "after kill -9")
    server.stop()


def test_unwritten_folder():
    """A metatile that cannot be kept is not done, and once it can be kept it is."""
    write_map("map.json")
    for folder in ("tiles", "own"):  # a socket is made in the second
        os.mkdir(folder)
    wrapper = ()
    if os.geteuid() == 0:  # who writes everywhere; so it is somebody else
        os.chmod(".", 0o755)
        os.chmod("own", 0o777)
        caches = os.path.abspath("own")
        wrapper = ("env", f"XDG_CACHE_HOME={caches}", f"POCL_CACHE_DIR={caches}/pocl", "setpriv", "--reuid=65534",
                   "--regid=65534", "--clear-groups")
        if subprocess.run([*wrapper, TOOL, "--version"], capture_output=True, check=False).returncode != 0:
            print("test_unwritten_folder: the tool lies where others than root cannot go: skipped")
            return
    os.chmod("tiles", 0o555)
    server = Server("map.json", "--renderd", "own/socket", "--cache-dir", "tiles", wrapper=wrapper)
    for mode, told in ((0o555, NOT_DONE), (0o777, DONE)):
        os.chmod("tiles", mode)
        got = ask_renderd("own/socket", renderd_message(3, RENDER, 10, 0, 0))
        expect(got == [told], f"a folder of mode {mode:o}: {got}")
        expect(server.get("/10/0/0.png")[0] == 200, "a tile that is not kept")
    check_metatile(server, "tiles", 10, 0, 0)
    server.stop()


def test_lost_device():
    """A device that fails one picture after the other ends the server, with a status that has it started again."""
    if not os.environ.get("FAULT_CL"):
        print("test_lost_device: no library that fails: skipped")
        return
    write_map("map.json")
    server = Server("map.json", wrapper=("env", f"LD_PRELOAD={os.environ['FAULT_CL']}", "CAMBER_FAULT=lost:lost",
                                         "CAMBER_CPU=none"))
    path = "/%d/%d/%d.png"
    expect(server.get(path % (ZOOM, COLUMN, ROW))[0] == 200, "a tile before it is lost")
    with open("lost", "wb"):
        pass
    statuses = [server.get(path % (ZOOM, COLUMN - 1, ROW))[0] for _ in range(2)]
    expect(statuses == [500, 500] and server.get(path % (ZOOM, COLUMN, ROW))[0] == 200, f"lost: {statuses}")
    os.unlink("lost")
    expect(server.get(path % (ZOOM, COLUMN - 1, ROW))[0] == 200, "a device that was busy is taken for lost")
    with open("lost", "wb"):
        pass
    statuses = [server.get(path % (ZOOM, COLUMN + 1, ROW + i))[0] for i in range(3)]
    expect(statuses == [500] * 3, f"lost: {statuses}")
    server.process.wait(timeout=PATIENCE_S)
    server.reader.join(PATIENCE_S)
    expect(server.process.returncode == 69, f"status {server.process.returncode}: {server.errors}")
    expect("the device is lost" in server.errors[-1], server.errors)


def stored_tiles(folder):
    return sorted(os.path.join(where, name) for where, _, files in os.walk(folder) for name in files)


def test_folder():
    """Tiles outlive the server in --cache-dir, those of another input are not taken for its own, and a folder that
    cannot be written to stops nothing."""
    write_map("map.json")
    os.mkdir("tiles")
    paths = [f"/{ZOOM}/{COLUMN}/{ROW}.png", f"/{ZOOM}/{COLUMN}/{ROW}@2x.png", f"/dark/{ZOOM}/{COLUMN}/{ROW}.png"]
    server = Server("map.json", "--cache-dir", "tiles")
    first = [server.get(path)[2] for path in paths]
    server.stop()
    files = stored_tiles("tiles")
    expect(len(set(first)) == 3 and sorted(first) == sorted(open(file, "rb").read()[:-26] for file in files), files)  # then a tag
    server = Server("map.json", "--cache-dir", "tiles")
    expect([server.get(path)[2] for path in paths] == first and server.metric("draw_seconds_count") == 0, "tiles are drawn again")
    expect(server.metric("cache_folder_hits_total") == 3, "the folder's tiles are not counted")
    write_map("map.json", seed=2)
    server.process.send_signal(signal.SIGHUP)
    wait_until(lambda: server.get(paths[0])[2] != first[0], "another input has the tiles of the one before")
    server.stop()
    expect(len(stored_tiles("tiles")) == 4, stored_tiles("tiles"))
    for file in files: # empty, a folder, a pipe: drawn again
        os.unlink(file)
    open(files[0], "wb").close()
    os.mkdir(files[1])
    os.mkfifo(files[2])
    write_map("map.json")
    server = Server("map.json", "--cache-dir", "tiles")
    expect([server.get(path)[2] for path in paths] == first and server.metric("draw_seconds_count") >= 2, "what is no tile is served")
    server.stop()


def test_full_folder():
    write_map("map.json")
    os.mkdir("tiles")
    if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "none", "tiles"],
                                           capture_output=True, check=False).returncode != 0:
        print("test_full_folder: no file system of its own: skipped")
        return
    try:
        server = Server("map.json", "--cache-dir", "tiles")
        for column in range(COLUMN - 4, COLUMN + 4):
            for row in range(ROW - 4, ROW + 4):
                expect(server.get(f"/{ZOOM}/{column}/{row}.png")[0] == 200, "a full folder stops the server")
        server.stop()
        told = [line for line in server.errors if "No space left" in line]
        expect(told and len(told) <= 4 and "free some space" in told[0], server.errors)
        expect(all(re.fullmatch(r"\d+", os.path.basename(file)) and os.path.getsize(file) > 0
                   for file in stored_tiles("tiles")), "a part of a tile is left")
    finally:
        subprocess.run(["umount", "tiles"], check=False)


run_tests(globals())
