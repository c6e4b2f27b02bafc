#!/usr/bin/env python3
"""Sheets of paper: PDF and SVG as other programs read them, and PNG. test_print.py CAMBER MONACO

poppler (pdftocairo, pdftotext, pdffonts, pdfinfo), librsvg (rsvg-convert) and Chromium judge the files; where one of
them is missing, its checks are left out, and a line says so.
"""

import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

CAMBER, MONACO = sys.argv[1:3]
FOLDER = tempfile.mkdtemp()
DPI = 150
VIEW = ["--center", "7.423,43.737", "--zoom", "15", "--paper", "A6", "--dpi", str(DPI)]
MM = 25.4


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def run(*arguments, status=0):
    done = subprocess.run([CAMBER, *arguments], capture_output=True, text=True)
    expect(done.returncode == status, f"{' '.join(arguments)}: {done.returncode}, not {status}: {done.stderr}")
    return done


def render(name, *options):
    path = os.path.join(FOLDER, name)
    run("render", MONACO, "-o", path, "-f", "-q", *options)
    return path


def have(program):
    found = shutil.which(program)
    if not found:
        print(f"left out: no {program} (Debian: {dict.get({'rsvg-convert': 'librsvg2-bin', 'chromium': 'chromium'}, program, 'poppler-utils')})")
    return found


def chunks(path):
    data, at = open(path, "rb").read(), 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        yield kind, data[at + 8:at + 8 + size]
        at += 12 + size


def rows_of(path):
    """RGB rows of a PNG, with whatever filters it has."""
    packed = b""
    for kind, body in chunks(path):
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
    expect(depth == 8 and color in (2, 6), f"{path}: depth {depth}, kind {color}")
    step = {2: 3, 6: 4}[color]
    raw, size, rows, above = zlib.decompress(packed), width * step, [], bytearray(width * step)
    for y in range(height):
        kind, row = raw[y * (size + 1)], bytearray(raw[y * (size + 1) + 1:(y + 1) * (size + 1)])
        for i in range(size if kind else 0):
            a, b, c = row[i - step] if i >= step else 0, above[i], above[i - step] if i >= step else 0
            if kind == 1:
                guess = a
            elif kind == 2:
                guess = b
            elif kind == 3:
                guess = (a + b) // 2
            else:
                p = a + b - c
                guess = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + guess) & 255
        above = row
        rows.append(row if step == 3 else bytearray(v for i, v in enumerate(row) if i % 4 < 3))
    return rows


def difference(one, other):
    """The mean difference of two pictures in levels, and the part of their values that differ by more than 48."""
    a, b = rows_of(one), rows_of(other)
    height, size = min(len(a), len(b)), min(len(a[0]), len(b[0]))
    expect(abs(len(a) - len(b)) <= 1 and abs(len(a[0]) - len(b[0])) <= 3, "the pictures have about one size")
    total = far = 0
    for y in range(height):
        for p, q in zip(a[y][:size], b[y][:size]):
            d = abs(p - q)
            total += d
            far += d > 48
    return total / (height * size), far / (height * size)


# ---- PNG ----

png = render("sheet.png", *VIEW)
heads = dict(chunks(png))
width, height = struct.unpack(">II", heads[b"IHDR"][:8])
expect((width, height) == (round(105 / MM * DPI), round(148 / MM * DPI)), f"A6 has {width} x {height} px")
expect(struct.unpack(">IIB", heads[b"pHYs"]) == (5906, 5906, 1), "a PNG tells its density")
for ratio, per_metre in ("1", 3780), ("2", 7559):
    plain = dict(chunks(render("plain.png", "--size", "64x64", "--ratio", ratio)))
    expect(struct.unpack(">IIB", plain[b"pHYs"]) == (per_metre, per_metre, 1),
           "a PNG without paper has 96 px per inch, times its ratio")
dense = dict(chunks(render("dense.png", "--size", "64x64", "--dpi", "300")))
expect(struct.unpack(">IIB", dense[b"pHYs"]) == (11811, 11811, 1) and struct.unpack(">I", dense[b"IHDR"][:4]) == (64,),
       "--dpi alone is the density of a picture")
coarse = dict(chunks(render("coarse.png", "--paper", "A6", "--dpi", str(DPI), "--ratio", "50")))
expect(struct.unpack(">II", coarse[b"IHDR"][:8]) == (width, height), "the sheet's size counts, not the usual one")
wide = dict(chunks(render("wide.png", *VIEW, "--landscape")))
expect(struct.unpack(">II", wide[b"IHDR"][:8]) == (height, width), "--landscape turns the sheet")
long = dict(chunks(render("long.png", "--center", "7.423,43.737", "--zoom", "15", "--paper", "2000x30mm", "--dpi", "600",
                          "--grid")))
expect(struct.unpack(">II", long[b"IHDR"][:8]) == (47244, 709), "a sheet may be wider than an image of Cairo's")
top = rows_of(png)[2]
expect(set(top) == {255}, "the margin is white")

# ---- PDF ----

pdf = render("sheet.pdf", *VIEW, "--title", "Monaco Ville", "--scale-bar", "--north-arrow")
expect(open(pdf, "rb").read() == open(render("again.pdf", *VIEW, "--title", "Monaco Ville", "--scale-bar",
                                             "--north-arrow"), "rb").read(), "a PDF is the same each time")
report = json.loads(run("render", MONACO, "-o", os.path.join(FOLDER, "counted.pdf"), "-f", "--json", *VIEW).stdout)
expect((report["width"], report["height"]) == (width, height), f"--json tells the sheet's size: {report}")
expect(report["labels"] > 3 and report["output_bytes"] > 10000, f"--json counts {report}")
odd = "Of \ufffe"  # a noncharacter, which Cairo does not write
expect("the title is not text" in run("render", MONACO, "-o", os.path.join(FOLDER, "odd.pdf"), *VIEW, "--title", odd,
                                      status=2).stderr, "a title that is no text")
render("credit.pdf", *VIEW, "--attribution", odd)
piped = subprocess.run([CAMBER, "render", MONACO, "-o", "-", "--format", "pdf", "-q", *VIEW], capture_output=True)
expect(piped.returncode == 0 and piped.stdout.startswith(b"%PDF-"), "a PDF on standard output")

if have("pdfinfo"):
    told = subprocess.run(["pdfinfo", pdf], capture_output=True, text=True).stdout
    size = re.search(r"Page size: +([\d.]+) x ([\d.]+) pts", told)
    expect(all(abs(float(size[i + 1]) / 72 * MM - mm) < 0.1 for i, mm in enumerate((105, 148))), f"the page: {told}")
    expect("Monaco Ville" in told, "the document has its title")
if have("pdffonts"):
    fonts = subprocess.run(["pdffonts", pdf], capture_output=True, text=True).stdout.splitlines()[2:]
    expect(fonts and all(re.search(r" yes +(yes|no) +yes ", line) for line in fonts), f"embedded, for search: {fonts}")
if have("pdftotext"):
    text = subprocess.run(["pdftotext", pdf, "-"], capture_output=True, text=True).stdout
    for name in ("Monaco Ville", "Boulevard Albert 1er", "Boulevard Princesse Charlotte", "OpenStreetMap"):
        expect(name in text, f"{name} is found in {text}")
if have("pdftocairo"):
    plain = render("nolabels.pdf", *VIEW, "--no-labels")
    picture = render("nolabels.png", *VIEW, "--no-labels")
    subprocess.run(["pdftocairo", "-png", "-singlefile", "-r", str(DPI), plain, os.path.join(FOLDER, "drawn")],
                   check=True)
    mean, far = difference(picture, os.path.join(FOLDER, "drawn.png"))
    expect(mean < 0.6 and far < 0.002, f"a PDF differs by {mean:.3f} levels, and far in {far:.5f}")

said = run("render", MONACO, "-o", os.path.join(FOLDER, "size.pdf"), *VIEW).stderr
expect("size.pdf: 105 x 148 mm, zoom 15.00 at " in said, said)

# ---- Every label of a PDF is found ----

NAMES = ["Île Saint-Honorat", "Groß-Gerau", "Αθήνα", "Санкт-Петербург", "Łódź-Żabieniec", "office fluffy"]
PLACES = [(f"{NAMES[i % 6]} {i}", {"type": "Point", "coordinates": [0.02 * (i % 6) + 0.01, 0.006 * (i // 6) + 0.004]})
          for i in range(60)]
PLACES += [(f"Rue de l’Église {i}", {"type": "LineString", "coordinates": [[0.002, 0.07 + 0.008 * i], [
    0.06, 0.074 + 0.01 * i], [0.118, 0.071 + 0.008 * i]]}) for i in range(5)]
CUT = "Point Nemo", {"type": "Point", "coordinates": [0.0005, 0.065]}  # at the edge
LABELS = {"version": 8, "sources": {"names": {"type": "geojson", "data": {"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"name": name}, "geometry": geometry} for name, geometry in [*PLACES, CUT]]}}}, "layers": [
        {"id": "points", "type": "symbol", "source": "names", "filter": ["==", ["geometry-type"], "Point"],
         "layout": {"text-field": ["get", "name"], "text-size": 11, "text-max-width": 30}},
        {"id": "lines", "type": "symbol", "source": "names", "filter": ["==", ["geometry-type"], "LineString"],
         "layout": {"text-field": ["get", "name"], "text-size": 12, "symbol-placement": "line-center",
                    "text-font": ["Noto Sans Italic"]}}]}
if have("pdftotext"):
    with open(os.path.join(FOLDER, "labels.json"), "w", encoding="utf-8") as file:
        json.dump(LABELS, file)
    named = os.path.join(FOLDER, "labels.pdf")
    for path, count in (named, len(PLACES)), (os.path.join(FOLDER, "labels.png"), len(PLACES) + 1):
        told = run("render", "--style", os.path.join(FOLDER, "labels.json"), "-o", path, "--size", "900x900", "--bbox",
                   "0,0,0.12,0.12", "--json")
        expect(json.loads(told.stdout)["labels"] == count, f"labels are placed, and on a page no edge cuts one: {told.stdout}")
    text = subprocess.run(["pdftotext", named, "-"], capture_output=True, text=True).stdout
    for name, _ in PLACES:
        expect(name in " ".join(text.split()), f"{name} is found")
    expect(CUT[0] not in text, "a label that the edge would cut is left out")

# ---- SVG ----

svg = render("sheet.svg", *VIEW)
told = re.search(r'<svg [^>]*?width="([0-9.]+)pt" height="([0-9.]+)pt"', open(svg, encoding="utf-8").read(500))
expect(told and abs(float(told[1]) - 105 / MM * 72) < 0.01 and abs(float(told[2]) - 148 / MM * 72) < 0.01,
       "an SVG has a size, in points")
if have("rsvg-convert"):
    drawn = os.path.join(FOLDER, "svg.png")
    subprocess.run(["rsvg-convert", "-d", str(DPI), "-p", str(DPI), "-o", drawn, svg], check=True)
    mean, far = difference(png, drawn)
    expect(mean < 0.6 and far < 0.002, f"an SVG with labels differs by {mean:.3f} levels, and far in {far:.5f}")
if have("chromium"):
    drawn, sides = os.path.join(FOLDER, "chromium.png"), [f"{round(mm / MM * 96)}" for mm in (105, 148)]
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--hide-scrollbars", f"--user-data-dir={FOLDER}/profile",
                    f"--force-device-scale-factor={DPI / 96}", f"--window-size={','.join(sides)}",
                    "--force-color-profile=srgb", f"--screenshot={drawn}", f"file://{svg}"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    mean, far = difference(png, drawn)
    expect(mean < 0.9 and far < 0.002, f"Chromium's SVG differs by {mean:.3f} levels, and far in {far:.5f}")

# ---- Dashes, gaps, offsets; a blur, which a page cannot say ----

STYLE = {"version": 8, "sources": {"roads": {"type": "geojson", "data": "roads.geojson"}}, "layers": [
    {"id": "paper", "type": "background", "paint": {"background-color": "#fff"}},
    {"id": "wide", "type": "line", "source": "roads", "layout": {"line-join": "round", "line-cap": "round"},
     "paint": {"line-color": "#c00", "line-width": 14, "line-opacity": 0.5}},
    {"id": "gap", "type": "line", "source": "roads", "layout": {"line-join": "round", "line-cap": "round"},
     "paint": {"line-color": "#060", "line-width": 3, "line-gap-width": 20}},
    {"id": "dash", "type": "line", "source": "roads",
     "paint": {"line-color": "#00c", "line-width": 4, "line-dasharray": [3, 2]}},
    {"id": "beside", "type": "line", "source": "roads",
     "paint": {"line-color": "#000", "line-width": 2, "line-offset": 20}}]}
ROADS = {"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": line}} for line in (
        [[0.001, 0.001], [0.004, 0.004], [0.007, 0.001]], [[0.001, 0.004], [0.007, 0.004]],
        [[0.002, 0.006], [0.005, 0.006], [0.005, 0.009], [0.002, 0.009], [0.002, 0.006]], [[-9, 0.003], [9, 0.0031]])]}
with open(os.path.join(FOLDER, "roads.geojson"), "w", encoding="utf-8") as file:
    json.dump(ROADS, file)


def draw_style(style, name):
    path, out = os.path.join(FOLDER, "style.json"), os.path.join(FOLDER, name)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(style, file)
    done = run("render", "--style", path, "-o", out, "-f", "--center", "0.004,0.005", "--zoom", "15", "--size", "300x440", "--dpi", "96")
    return out, done.stderr


if shutil.which("pdftocairo"):
    out, told = draw_style(STYLE, "effects.pdf")
    expect("image" not in told, f"no image is needed: {told}")
    expect(b"/Subtype /Image" not in open(out, "rb").read(), "and there is none")
    subprocess.run(["pdftocairo", "-png", "-singlefile", "-r", "96", out, os.path.join(FOLDER, "effects")], check=True)
    picture = os.path.join(FOLDER, "picture.png")
    run("render", "--style", os.path.join(FOLDER, "style.json"), "-o", picture, "-f", "-q", "--center", "0.004,0.005",
        "--zoom", "15", "--size", "300x440", "--format", "png")
    mean, far = difference(picture, os.path.join(FOLDER, "effects.png"))
    expect(mean < 1.5 and far < 0.01, f"effects differ by {mean:.3f} levels, and far in {far:.5f}")
    STYLE["layers"][1]["paint"]["line-blur"] = 3
    out, told = draw_style(STYLE, "blurred.pdf")
    expect("drawn as an image" in told, f"a blur is told: {told}")
    expect(b"/Subtype /Image" in open(out, "rb").read(), "and it is an image")

# ---- Options ----

for options, said in (
        (["-o", "a.png", "--title", "x"], "--title: needs a sheet"),
        (["-o", "a.pdf", "--paper", "A17"], "--paper A17: not a size of paper"),
        (["-o", "a.pdf", "--paper", "600x900cm"], "not a size of paper"),
        (["-o", "a.pdf", "--paper", "0x9mm"], "not a size of paper"),
        (["-o", "a.pdf", "--paper", "0x600x900mm"], "not a size of paper"),
        (["-o", "a.pdf", "--paper", "10x0x600mm"], "not a size of paper"),
        (["-o", "a.pdf", "--paper", "600x900mm 1"], "not a size of paper"),
        (["-o", "a.png", "--ratio", "50"], "1024x1024 at ratio 50: out of range"),
        (["-o", "a.pdf", "--paper", "A4", "--size", "10x10"], "--paper and --size"),
        (["-o", "a.pdf", "--margin", "110"], "--margin 110: leaves nothing"),
        (["-o", "a.pdf", "--paper", "A0", "--dpi", "4800"], "--dpi 4800"),
        (["-o", "a.pdf", "--quality", "50"], "--quality: applies only to WebP"),
        (["-o", "a.png", "--fit", "cover", "--center", "1,2", "--zoom", "3"], "--fit: --center"),
        (["-o", "a.png", "--format", "pdf"], "its extension means png")):
    done = run("render", MONACO, *options, status=2)
    expect(said in done.stderr and done.stderr.count("\n") == 1, f"{options}: {done.stderr}")
expect("camber bench writes png" in run("bench", MONACO, "-o", "a.pdf", status=2).stderr, "bench draws no pages")
if os.path.exists("/dev/full"):
    full = run("render", MONACO, "-o", "/dev/full", "-f", "--format", "pdf", *VIEW, status=74)
    expect("No space left" in full.stderr, f"a full disk: {full.stderr}")
shutil.rmtree(FOLDER)
print("print: ok")
