#!/usr/bin/env python3
"""What people's files met: data without a schema, in any format; what is blank and says why; outlines, overlaps of
translucent areas, wide views, bounds.

    test_field.py TOOL [data]

TOOL is camber. data: the real files of CAMBER_DATA, and nothing else. Without ogr2ogr (Debian: gdal-bin) formats that are no
text are left out. Exit status 1: the first failure, on standard error; 77: CAMBER_DATA is not set.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "fixtures"))
import png_rows

TOOL = os.path.abspath(sys.argv[1])
HANGS_S = 600
# The libraries of some of GDAL's drivers leak.
os.environ["ASAN_OPTIONS"] = ":".join(filter(None, [os.environ.get("ASAN_OPTIONS"), "detect_leaks=0"]))
PAPER = {"light": (246, 242, 234), "dark": (16, 20, 28)}
INK = {"light": (0x3f, 0x65, 0x95), "dark": (0x86, 0xaa, 0xdb)}
# Formats that ogr2ogr writes, by their endings; with what it needs to.
WRITTEN = {
    "ESRI Shapefile": ("shp", []), "MapInfo File": ("tab", []), "CSV": ("csv", ["-lco", "GEOMETRY=AS_WKT"]),
    "GML": ("gml", []), "GPX": ("gpx", ["-dsco", "GPX_USE_EXTENSIONS=YES"]), "LIBKML": ("kmz", []), "KML": ("kml", []),
    "GeoJSON": ("geojson", []), "GeoJSONSeq": ("geojsonl", []), "OGR_GMT": ("gmt", []), "GPKG": ("gpkg", []),
    "SQLite": ("sqlite", []), "DXF": ("dxf", []), "FlatGeobuf": ("fgb", []), "GeoRSS": ("xml", []),
    "JML": ("jml", []), "MapML": ("mapml", []), "DGN": ("dgn", []),
    "PDF": ("pdf", []), "MBTiles": ("mbtiles", []), "PMTiles": ("pmtiles", []), "netCDF": ("nc", []),
    "Selafin": ("slf", []), "VDV": ("x10", []), "Geoconcept": ("gxt", []), "OpenFileGDB": ("gdb", []),
}


def run(*arguments, status=0):
    done = subprocess.run([TOOL, *arguments], capture_output=True, timeout=HANGS_S)
    said = done.stderr.decode(errors="replace")
    if done.returncode != status:
        sys.exit(f"{' '.join(arguments)}: status {done.returncode}, not {status}: {said}")
    return done.stdout, said


def draw(path, *more, size="120x120"):
    run("render", path, "-o", "out.png", "-f", "-q", "--size", size, *more)
    with open("out.png", "rb") as file:
        return png_rows.decode(file.read())


def colors(rows):
    found = {}
    for row in rows:
        for i in range(0, len(row), 4):
            found[tuple(row[i:i + 3])] = found.get(tuple(row[i:i + 3]), 0) + 1
    return found


def contrast(one, other):
    """By WCAG 2."""
    def luminance(color):
        linear = [c / 12.92 if c <= 0.03928 else ((c + 0.055) / 1.055) ** 2.4 for c in (v / 255 for v in color)]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def check(good, what):
    if not good:
        sys.exit(what)


def feature(geometry, coordinates, **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": geometry, "coordinates": coordinates}}


def write(name, *features):
    with open(name, "w") as file:
        json.dump({"type": "FeatureCollection", "features": features}, file)
    return name


LINE = feature("LineString", [[5, 5], [5.1, 5.1]], type=None)
SQUARE = feature("Polygon", [[[5, 5], [5.1, 5], [5.1, 5.1], [5, 5.1], [5, 5]]], owner="x")
POINT = feature("MultiPoint", [[5.05, 5.05], [5.02, 5.05]], name="x")


def check_looks():
    """Readable, and of one width in pixels at any zoom."""
    write("line.geojson", feature("LineString", [[4, 5.0], [6, 5.0]], type="Running", highway=None))
    for theme, paper in PAPER.items():
        widths = set()
        for zoom in (2, 9, 16):
            rows = draw("line.geojson", "--theme", theme, "--center", "5,5", "--zoom", str(zoom), size="60x40")
            column = [tuple(row[4 * 30:4 * 30 + 3]) for row in rows]
            inked = min(column, key=lambda color: contrast(color, paper) * -1)
            check(contrast(inked, paper) >= 3, f"{theme}: the line's contrast at zoom {zoom} is {contrast(inked, paper)}")
            whole = max(abs(a - b) for a, b in zip(INK[theme], paper))
            widths.add(sum(max(abs(a - b) for a, b in zip(color, paper)) for color in column) / whole)
        check(max(abs(width - 1.6) for width in widths) < 0.03, f"{theme}: widths {widths}")
    for name, one in (("square", SQUARE), ("point", POINT)):
        for theme, paper in PAPER.items():
            found = colors(draw(write(f"{name}.geojson", one), "--theme", theme, "--center", "5.05,5.05", "--zoom", "8"))
            best = max(contrast(color, paper) for color in found)
            check(best >= 3 and len(found) > 1, f"{theme}, {name}: the best contrast is {best}")
    # The options' colours, exactly.
    found = colors(draw(write("all.geojson", LINE, SQUARE, POINT), "--color", "#ff0000", "--fill", "rgb(0, 255, 0)",
                        "--width", "8"))
    check(found.get((255, 0, 0), 0) > 120 * 8 and found.get((0, 255, 0), 0) > 120 * 60, f"the options: {found}")
    run("render", "all.geojson", "-o", "out.png", "-f", "--color", "no colour", status=2)
    run("render", "all.geojson", "-o", "out.png", "-f", "--width", "0", status=2)
    run("render", "all.geojson", "-o", "out.png", "-f", "--fill", "red", "--style", "transit", status=2)


def check_each():
    """One feature that a rule takes leaves the others plain."""
    road = feature("LineString", [[5, 5.05], [5.1, 5.05]], highway="primary")
    water = feature("Polygon", [[[5.06, 5.06], [5.1, 5.06], [5.1, 5.1], [5.06, 5.06]]], natural="water")
    alone = colors(draw(write("known.geojson", road, water), "--center", "5.05,5.05", "--zoom", "9"))
    plain = {INK["light"], (0xd8, 0xe0, 0xe9)}
    check(not plain & set(alone), "a road and water are not plain")
    both = colors(draw(write("both.geojson", LINE, SQUARE, road, water), "--center", "5.05,5.05", "--zoom", "9"))
    check(plain <= set(both) and set(alone) & set(both) >= {(0xa6, 0xcf, 0xdd)}, f"all of them: {sorted(both)}")
    # A building that is too small to be drawn at this zoom is a building, and no parcel.
    house = write("house.geojson", feature("Polygon", SQUARE["geometry"]["coordinates"], building="yes"))
    check(len(colors(draw(house, "--center", "5.05,5.05", "--zoom", "9"))) == 1, "a building at zoom 11 is not plain")


def is_drawn(name):
    done = subprocess.run([TOOL, "render", name, "-o", "out.png", "-f", "-q", "--size", "120x120"], capture_output=True, timeout=HANGS_S)
    if done.returncode:
        return False
    with open("out.png", "rb") as file:
        return len(colors(png_rows.decode(file.read()))) > 1


def reads_back(name):
    """Whether the driver that wrote a file finds places in it."""
    back = subprocess.run(["ogr2ogr", "-f", "GeoJSON", "/vsistdout/", name], capture_output=True, timeout=HANGS_S).stdout
    return b'"coordinates": [ ' in back


def check_formats():
    texts = {
        "track.gpx": """<?xml version="1.0"?><gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1"><trk>
            <type>9</type><trkseg><trkpt lat="5" lon="5"/><trkpt lat="5.1" lon="5.1"/></trkseg></trk></gpx>""",
        "waypoints.gpx": """<?xml version="1.0"?><gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1">
            <wpt lat="5" lon="5"/><wpt lat="5.1" lon="5.1"/></gpx>""",
        "path.kml": """<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><LineString><coordinates>
            5,5 5.1,5.1</coordinates></LineString></Placemark></kml>""",
        "wkt.csv": 'id,WKT\n1,"LINESTRING(5 5,5.1 5.1)"\n2,"POLYGON((5 5,5.1 5,5.1 5.1,5 5))"\n',
    }
    for name, text in texts.items():
        with open(name, "w") as file:
            file.write(text)
        check(len(colors(draw(name))) > 1, f"{name} is blank")
    if not shutil.which("ogr2ogr"):
        print("no ogr2ogr (Debian: gdal-bin): formats that are no text are left out")
        return
    known = json.loads(run("info", "--json")[0])["formats"]
    drawn, left_out = [], []
    for format in known:
        ending, options = WRITTEN.get(format) or (None, None)
        if not ending:
            left_out.append(format)
            continue
        for what, one in (("line", LINE), ("area", SQUARE), ("point", feature("Point", [5, 5], name="x"))):
            name = f"{what}.{ending}"
            if os.path.exists(name):
                shutil.rmtree(name) if os.path.isdir(name) else os.remove(name)
            made = subprocess.run(["ogr2ogr", "-f", format, name, write("one.geojson", one), *options],
                                  capture_output=True, timeout=HANGS_S)
            if made.returncode == 0 and is_drawn(name):
                drawn.append(format)
            else:
                check(made.returncode or not reads_back(name), f"{format}, {what}: {name} is refused or blank")
                left_out.append(f"{format} ({what})")
    print(f"drawn: {', '.join(sorted(set(drawn)))}; not written by ogr2ogr: {', '.join(left_out)}")
    check({"GPKG", "FlatGeobuf", "ESRI Shapefile", "GPX", "KML"} <= set(drawn), "formats that everyone has")


def check_told():
    """A picture, tiles or a map in which nothing is drawn say what was read, why it does not show, and the cure."""
    def said(*arguments):
        text = run(*arguments)[1]
        check(text.count("camber: warning: ") == 1, f"{arguments}: {text}")
        return text
    with open("none.json", "w") as file:
        json.dump({"version": 8, "sources": {}, "layers": [
            {"id": "x", "type": "line", "filter": ["==", ["get", "highway"], "x"]},
            {"id": "y", "type": "line", "minzoom": 12, "filter": ["==", ["get", "kind"], "y"]}]}, file)
    line = write("one_line.geojson", feature("LineString", [[5, 5], [5.1, 5.1]], highway="primary"))
    late = write("late.geojson", feature("LineString", [[5, 5], [5.1, 5.1]], kind="y"))
    empty = write("empty.geojson")
    render, size = ("-o", "out.png", "-f", "--size", "64x64"), os.path.getsize("one_line.geojson")
    text = said("render", line, *render, "--style", "none.json")
    check("nothing is drawn: 1 line of" in text and f"{size} bytes" in text and "no layer of the style draws" in text and
          "it reads highway, kind" in text and "--style" in text, text)
    text = said("render", late, *render, "--style", "none.json", "--center", "5,5", "--zoom", "3")
    check("none of it at zoom 3; it draws some from zoom 12 on" in text, text)
    text = said("render", line, *render, "--bbox", "50,50,50.1,50.1")
    check("nothing is in the view" in text and "longitudes come first" in text, text)
    text = said("render", empty, *render)
    check("no feature of" in text and "check that this is the file you mean" in text, text)
    text = said("render", write("point.geojson", feature("Point", [5, 5])), *render, "--style", "roads")
    check("that the style could draw" in text and "another style with --style" in text, text)
    text = said("tiles", line, "-o", "out.pmtiles", "-f", "--style", "none.json", "--max-zoom", "3")
    check("there are no tiles: 1 line of" in text and "no layer of the style draws" in text, text)
    text = said("tiles", late, "-o", "out.pmtiles", "-f", "--style", "none.json", "--max-zoom", "3")
    check("none of it at zooms 0 to 3; it draws some from zoom 12 on" in text, text)
    text = said("tessellate", line, "-o", "out.glb", "-f", "--style", "none.json")
    check("no layer of the style draws" in text, text)


def write_style(name, *layers, **more):
    with open(name, "w") as file:
        json.dump({"version": 8, "sources": {}, "layers": [{"id": str(i), **layer} for i, layer in enumerate(layers)],
                   **more}, file)
    return name


def box(west, south, east, north, **properties):
    return feature("Polygon", [[[west, south], [east, south], [east, north], [west, north], [west, south]]], **properties)


FILL = {"type": "fill", "paint": {"fill-color": "#ccddff"}}
RED = {"type": "line", "paint": {"line-color": "#ff0000", "line-width": 4}}


def check_outlines():
    """INPUT's areas are outlined as those of a style's own source."""
    square = write("square.geojson", box(-30, -20, 30, 20))
    for layers in ((FILL, RED), (RED,)):
        own = write_style("own.json", *({**layer, "source": "s"} for layer in layers),
                          sources={"s": {"type": "geojson", "data": "square.geojson"}})
        run("render", "--style", own, "-o", "own.png", "-f", "-q", "--size", "200x200", "--center", "0,0", "--zoom", "0")
        with open("own.png", "rb") as file:
            wanted = png_rows.decode(file.read())
        given = draw(square, "--style", write_style("style.json", *layers), "--center", "0,0", "--zoom", "0",
                     size="200x200")
        check(given == wanted and any(row[i:i + 3] == b"\xff\0\0" for row in given for i in range(0, len(row), 4)),
              f"outlines of INPUT, {len(layers)} layers")
    lines = write_style("lines.json", {**RED, "filter": ["==", ["geometry-type"], "LineString"]})
    run("render", square, "-o", "out.png", "-f", "--style", lines, status=65)


def check_overlaps():
    """Translucent areas of several colours look the same in whatever order they come."""
    red, more, blue = box(-30, -20, 10, 20, c="red"), box(-10, -5, 30, 35, c="red"), box(0, 0, 50, 50, c="blue")
    style = write_style("half.json", {"type": "fill", "paint": {"fill-color": ["get", "c"], "fill-opacity": 0.5}})
    for kernels in ("cl", "gl"):
        pictures = [draw(write("areas.geojson", *areas), "--style", style, "--draw", kernels, "--center", "0,0", "--zoom", "0")
                    for areas in ((red, blue, more), (red, more, blue), (blue, more, red))]
        check(pictures[0] == pictures[1] == pictures[2], f"{kernels}: the order of areas shows")
        check(len(colors(pictures[0])) < 40, f"{kernels}: overlaps of one colour darken")
    refused = write_style("dark.json", {**FILL, "metadata": {"camber:overlap": "accumulate"}})
    text = run("render", "areas.geojson", "-o", "out.png", "-f", "--style", refused)[1]
    check("/layers/0/metadata/camber:overlap: applies only to line layers" in text, text)


def check_worlds():
    """A view wider than the world repeats it."""
    write("world.geojson", box(-70, 60, -15, 80), box(0, 20, 40, 50), feature("LineString", [[100, 0], [179, 40]]))
    style = write_style("world.json", FILL, RED)
    for kernels in ("cl", "gl"):
        rows = draw("world.geojson", "--style", style, "--draw", kernels, "--center", "143,0", "--zoom", "0", size="1200x512")
        for row in rows:
            pixels = [row[i:i + 4] for i in range(0, len(row), 4)]
            worst = max(max(abs(a - b) for a, b in zip(one, other)) for one, other in zip(pixels, pixels[512:]))
            check(worst <= 1, f"{kernels}: two worlds differ by {worst} levels")
        check(len(colors(rows)) > 2, f"{kernels}: blank")


def check_bounds():
    """Bounds are of what is drawn, and across 180 degrees."""
    style = write_style("roads.json", {**RED, "filter": ["has", "highway"]})
    write("far.geojson", feature("LineString", [[5, 5], [6, 6]], highway="x"), feature("LineString", [[-60, -60], [60, 60]]))
    write("fiji.geojson", feature("LineString", [[177, -17], [179, -18]], highway="x"),
          feature("LineString", [[-179, -17], [-178, -18]], highway="x"))
    for name, wanted, center in (("far", [5, 5, 6, 6], 5.5), ("fiji", [-180, -18, 180, -17], 179.5)):
        run("tiles", f"{name}.geojson", "-o", f"{name}.pmtiles", "-f", "-q", "--style", style, "--max-zoom", "3")
        run("tiles", "verify", f"{name}.pmtiles")
        about = json.loads(run("tiles", "show", f"{name}.pmtiles", "--json")[0])
        near = max(abs(a - b) for a, b in zip([*about["bounds"], about["center"][0]], [*wanted, center]))
        check(near < 1e-5, f"{name}: bounds {about['bounds']}, centre {about['center']}")


def check_data():
    data = os.environ.get("CAMBER_DATA")
    if not data:
        print("CAMBER_DATA is not set: real files are not drawn")
        sys.exit(77)
    folder = os.path.join(data, "data")
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        if name.endswith((".md", ".properties")) or ".wkb" in name: # notes, and points of a test of GEOS
            continue
        check(len(colors(draw(f"/vsigzip/{path}" if name.endswith(".gz") else path, size="400x400"))) > 1,
              f"{name} is blank")
    for name in ("track.gpx", "line-type-null.geojson", "polygon.geojson", "square.geojson", "par.geojson"):
        check(len(colors(draw(os.path.join(data, "field", name)))) > 1, f"{name} is blank")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for check_one in (check_data,) if sys.argv[2:] == ["data"] else (
                check_looks, check_each, check_formats, check_told, check_outlines, check_overlaps, check_worlds, check_bounds):
            check_one()
        os.chdir("/")


main()
