#!/usr/bin/env python3
"""Whatever osmium writes, the tool draws: small files of each kind, and a city in many packings and orders.

    test_osmium.py TOOL CITY

TOOL is camber, CITY a PBF. The city is held against itself as osmium-tool writes it, and against GDAL; without
osmium-tool the small files are all. Exit status 1: the first failure, on standard error.
"""

import base64
import json
import os
import shutil
import subprocess
import sys
import tempfile

TOOL, CITY = map(os.path.abspath, sys.argv[1:3])

# Made by osmium-tool 1.15 or by hand.
LZ4 = """
AAAADQoJT1NNSGVhZGVyGDIQLDIu8B0iDk9zbVNjaGVtYS1WMC42IgpEZW5zZU5vZGVzggENb3NtaXVtLzEuMTUuMAAAAAsKB09TTURhdGEYdRB4MnHwEQ
oXCgAKAAoHaGlnaHdheQoIY3Jvc3NpbmcSXRJbCgUCAQBQKiMKBQEBADASBQABABIaBwASIgcAMCoFAhUA8CBCD4Cfr9YCwJoMAMCaDMCaDEoRgJmkigHA
mgyAtRigjQaAtRhSCQAAAAIDAAIDAAAAAAsKB09TTURhdGEYPRA3MjnwKAoWCgAKB2hpZ2h3YXkKB3ByaW1hcnkKABIdGhsIARIBARoBAiIKCAEQABgAIA
AoA0IFAgICAgI=
"""
PLACES_ON_WAYS = """
AAAADQoJT1NNSGVhZGVyGEkQPRpFeJxT4vMvzg1OzkjNTdQNM9AzU+JySc0rTvXLT0kt1uL3yU9OLMnMzyv2zwtPrCxuYuTNL87NLM3VN9QzNNUzAABe/B
OeAAAACwoHT1NNRGF0YRhaEFMaVnic4xLnYgBC9ozM9IzyxEoujuSi/OLizLx0IQshMy4mDiYtES4mRkYhJgYGKSBWAmItJiYGJ46GK8evMR2YxePF8eDr
uS7Ghq0SQWxMzAxABAC6qhH6AAAACwoHT1NNRGF0YRhgEFsaXHic4xLjYuBiz8hMzyhPrORiLyjKzE0squRiEHKUsudgFGJklGJkUuLiYBRgkGBQYNBgdm
JlAoEgwYaZS7oYD8ziadgqsaCXDUh68TfMX3+NCSjEAMRABABniBc6
"""
RELATION_FIRST = """
AAAADQoJT1NNSGVhZGVyGDgQLBo0eJxT4vMvzg1OzkjNTdQNM9AzU+JySc0rTvXLT0ktbmLkzS/OzSzN1TfUMzTVMwAAMKgNWAAAAAsKB09TTURhdGEYQB
A0Gjx4nOMS42LgYs/ITM8oT6zkYi8oysxNLKrkYhCSkpLgYBRiZJRiZFLi4mAQYJBgUGDQYHZiYmICAAqMB9MAAAALCgdPU01EYXRhGEAQNBo8eJzjEuRi
4GIpqSxI5WItyi8tSeViEJJXkuVgFGJklGJkUuLiYBBgkGBQYNBgdmJk9mJkCmJkBADSMAZ2AAAACwoHT1NNRGF0YRhCEDwaPnic42LhYuBiEDIRMuJiYm
LSEuFiYmAQAmIpIFYCYi0mJgYnjob5668xHZjF48XRMHNJFyOQFQSUAwC/UAoz
"""
UNKNOWN_BLOB = """
AAAADQoJT1NNSGVhZGVyGEUQOBpBeJzjkuJo2DZru5dAw5EXl70kGlqeXvvCpNDwbdquL0xKfP7FucHJGam5ibphBnpmSlwuqXnFqX75KanFALi8FtsAAA
ALCgdPU01EYXRhGDIQSRoueJzjYuJiEHIWcuTiYIICJ6mGKa/vMC+Ywzh/DiMa6SXZ0LI+fgGYjYYAzaAX4wAAAA0KCUluZGV4RGF0YRgPEBQaC3icq6jA
BABihAlhAAAACwoHT1NNRGF0YRgyECwaLnic4xLhYuBiz8hMzyhPrORiLyjKzE0sqhQSkRLi4BZiZJRiZHLiYIICAM5QBzA=
"""
NO_SIZE = """
AAAADQoJT1NNSGVhZGVyGEMaQXic45LiaNg2a7uXQMORF5e9JBpanl77wqTQ8G3ari9MSnz+xbnByRmpuYm6YQZ6ZkpcLql5xal++SmpxQC4vBbbAAAACw
oHT1NNRGF0YRgwGi54nONi4mIQchZy5OJgggInqYYpr+8wL5jDOH8OIxrpJdnQsj5+AZiNhgDNoBfjAAAACwoHT1NNRGF0YRgwGi54nOMS4WLgYs/ITM8o
T6zkYi8oysxNLKoUEpES4uAWYmSUYmRy4mCCAgDOUAcw
"""
HISTORY = """
AAAADQoJT1NNSGVhZGVyGE8QQxpLeJxT4vMvzg1OzkjNTdQNM9AzU+JySc0rTvXLT0ktVhL1yCwuyS/KTE7M8cxLyy/KTSzJzM9rYuTNL87NLM3VN9QzNN
UzAADrhhYnAAAACwoHT1NNRGF0YRhrEH8aZ3ic4xLnYgBC9ozM9IzyxEoujuSi/OLizLx0oRShJC5WJhDQ0uJiZQQBIVYGEJCCUEoQSouVCUQZQZQ48TfM
X3+N6cAsHgYgBiIvwYaZS7oYgayGrRILetmAZBAnUD0TMwgBAGdXGEsAAAALCgdPU01EYXRhGEIQORo+eJzjEuNi4GLPyEzPKE+s5GIvKMrMTSyq5GIQkp
eS5WAUYmSUYmRS4uFgFGCQYFBg0GA2YHRiZQIBADRhCBo=
"""
MISSING = """
AAAADQoJT1NNSGVhZGVyGDgQLBo0eJxT4vMvzg1OzkjNTdQNM9AzU+JySc0rTvXLT0ktbmLkzS/OzSzN1TfUMzTVMwAAMKgNWAAAAAsKB09TTURhdGEYQx
A8Gj94nONi4WLgYhAyETLiYmJi0hLhYmJkFGJiYJACYiUg1mJiYnDiaJi//hrTgVk8XhwNM5d0MQJZQUA5AL+jCjUAAAALCgdPU01EYXRhGEgQSRpEeJzj
EuNi4GLPyEzPKE+s5GIvKMrMTSyq5GIQ0peS5GAUYmSUYmRS4uJgFGCQYFBg0GB2YmZiYpIS4kAVBIoBAL9jCRMAAAALCgdPU01EYXRhGGEQVhpdeJzj0u
Ni4GIpqSxI5WLPSywpLUrM4eLJLc0pySzIz6lMz8/jYinPz08BKmLNLy1JLRJSUVLiYBRiYmSSYmJmUeLiYBRgkGBQYNBgdWJiY/NiYmEKYmJkBACavRDS
"""


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def render(path, *arguments, status=0, **more):
    command = [TOOL, "render", path, "-o", "out.png", "-f", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, **more)
    expect(status in (None, done.returncode), f"{command}: {done.returncode}, not {status}: {done.stderr}")
    return done


def counts(path, *arguments):
    return json.loads(render(path, "--json", *arguments).stdout)


def small(name, text):
    with open(name, "wb") as file:
        file.write(base64.b64decode(text))
    return name


def check_small_files():
    """A road each: of so many points, or refused with the cure."""
    for name, text, points in (("lz4", LZ4, 5), ("places", PLACES_ON_WAYS, 5), ("first", RELATION_FIRST, 2),
                               ("blob", UNKNOWN_BLOB, 8), ("size", NO_SIZE, 8), ("missing", MISSING, 2)):
        path = small(name, text)
        if name == "lz4" and "built without" in render(path, status=None).stderr:
            continue
        read = counts(path)
        expect((read["features"], read["points_in"]) == (1, points), f"{name}: {read}")
        missing = [read[key] for key in ("missing_nodes", "missing_ways", "dropped_relations")]
        expect(missing == ([1, 1, 1] if name == "missing" else [0, 0, 0]), f"{name}: {missing}")
    told = render("missing").stderr
    expect("\nmissing: 1 node of ways, 1 way of multipolygons\n" in told and "1 multipolygon left out" in told, told)
    with open("first", "rb") as file: # as standard input, which is read twice
        expect(", 2 points," in render("-", "-v", stdin=file).stderr, "standard input")
    done = render(small("history", HISTORY), status=65)
    expect(done.stderr.count("\n") == 1 and "osmium time-filter" in done.stderr, done.stderr)


def write_extract(name, ends):
    """A grid of 200 short roads that do not meet, and a road from there to a place."""
    with open("grid.osm", "w") as file:
        file.write('<osm version="0.6">')
        places = [(1 + x / 1000, y / 1000) for x in range(21) for y in range(20)] + [ends]
        file.writelines(f'<node id="{i}" lon="{x}" lat="{y}" version="1"/>' for i, (x, y) in enumerate(places, 1))
        for way in (i for i in range(1, 401) if (i - 1) // 20 % 2 == 0):
            file.write(f'<way id="{way}" version="1"><nd ref="{way}"/><nd ref="{way + 20}"/><tag k="highway" v="residential"/></way>')
        file.write(f'<way id="401" version="1"><nd ref="1"/><nd ref="{len(places)}"/><tag k="highway" v="primary"/></way></osm>')
    osmium("cat", "grid.osm", "-o", name)


def check_view_of_extract():
    """What reaches far beyond an extract is cut off, and what is near is not; neither is anything of other files."""
    zooms = {}
    for name, ends in (("within", (1.01, 0.01)), ("near", (1.022, 0.01)), ("far", (1.2, 0.01))):
        write_extract(f"{name}.osm.pbf", ends)
        zooms[name] = counts(f"{name}.osm.pbf")["zoom"]
    expect(zooms["within"] - 0.1 < zooms["far"] < zooms["within"], f"a far road: {zooms}")
    expect(zooms["near"] < zooms["far"], f"a road that is near: {zooms}")
    with open("far.geojson", "w") as file:
        file.write('{"type": "LineString", "coordinates": [[1, 0], [1.2, 0.01]]}')
    both = counts("within.osm.pbf", "far.geojson")["zoom"]
    expect(both < zooms["within"] - 2, f"a far line of another file: {both}, {zooms}")
    osmium("cat", "far.osm.pbf", "-o", "far.osm")
    expect(abs(counts("far.osm")["zoom"] - zooms["far"]) < 0.01, "GDAL's reader")


def osmium(*arguments):
    subprocess.run(["osmium", *arguments, "--overwrite"], check=True, stderr=subprocess.DEVNULL)


def picture(path, *options):
    """The pixels, and what was read."""
    read = counts(path, *options)
    with open("out.png", "rb") as file:
        return file.read(), [read[key] for key in ("features", "polylines", "points_in", "missing_nodes")]


def write_forms():
    """Yields the city as osmium writes it, and the form that it must look like."""
    for packing in "none", "lz4", "zlib":
        osmium("cat", CITY, "-f", f"pbf,pbf_compression={packing}", "-o", f"{packing}.osm.pbf")
        yield f"{packing}.osm.pbf", CITY
    osmium("cat", CITY, "-f", "pbf,pbf_dense_nodes=false", "-o", "single.osm.pbf")
    yield "single.osm.pbf", CITY
    osmium("cat", CITY, "-f", "pbf,add_metadata=false,pbf_dense_nodes=false,pbf_compression=lz4", "-o", "bare.osm.pbf")
    yield "bare.osm.pbf", CITY
    osmium("add-locations-to-ways", CITY, "-o", "places.osm.pbf")
    yield "places.osm.pbf", CITY
    osmium("add-locations-to-ways", "-n", CITY, "-f", "pbf,pbf_compression=none", "-o", "both.osm.pbf")
    yield "both.osm.pbf", CITY
    # Several files have no box, and so no sea.
    for kind in "node", "way", "relation":
        osmium("cat", CITY, "-t", kind, "-o", f"{kind[0]}.osm.pbf")
    for order in "nwr", "wrn", "rwn", "wnr", "rnw", "nrw":
        osmium("cat", *(kind + ".osm.pbf" for kind in order), "-o", order + ".osm.pbf")
        yield order + ".osm.pbf", "nwr.osm.pbf"
    osmium("sort", "rwn.osm.pbf", "-o", "sorted.osm.pbf")
    yield "sorted.osm.pbf", "nwr.osm.pbf"


def check_city():
    pictures = {}
    forms = 0
    for path, like in write_forms():
        if like not in pictures:
            pictures[like] = picture(like)
        expect(picture(path) == pictures[like], f"{path} is not drawn as {like} is")
        forms += 1
    # GDAL reads XML, and makes no sea.
    for ending in "osm", "osm.gz":
        osmium("cat", CITY, "-f", ending, "-o", f"city.{ending}")
        expect(picture(f"city.{ending}", "--style", "roads") == picture(CITY, "--style", "roads"), f"the roads of {ending}")
        forms += 1
    size = os.path.getsize(CITY)
    own, gdals = (counts(path, "--style", "roads") for path in (CITY, f"/vsisubfile/0_{size},{CITY}"))
    for key in "features", "polylines", "points_in":
        expect(own[key] == gdals[key], f"{key}: {own[key]}, GDAL: {gdals[key]}")
    print(f"{forms} forms of the city, and GDAL's")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    check_small_files()
    if shutil.which("osmium"):
        check_city()
        check_view_of_extract()
    else:
        print("no osmium-tool: the small files alone")
    os.chdir("/")
