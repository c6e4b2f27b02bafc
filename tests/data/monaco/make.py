#!/usr/bin/env python3
"""Makes monaco.osm.pbf of the extract that Debian's source package osrm-backend has: make.py EXTRACT.osm.pbf

osmium cuts a box out and leaves out what the style city does not look at, authors and versions too. OpenStreetMap has
a coast and no sea: a multipolygon of the coast's ways and one more way, off the shore, makes water of it. The three
points, the way and the relation that this adds have ids far above those of OpenStreetMap.
"""

import os
import subprocess
import sys
import tempfile

BOX = "7.395,43.716,7.45,43.7555"  # west, south, east, north
KEYS = "highway building natural landuse leisure waterway railway amenity man_made aeroway".split()
OFF_SHORE = 7.5, 43.7  # longitude and latitude of the sea's corner
FIRST_ID = 60000000001
HERE = os.path.dirname(os.path.abspath(__file__))


def osmium(*arguments):
    subprocess.run(["osmium", *arguments], check=True)


def fields(line):
    """A line of osmium's OPL: {"w": "24874398", "T": "natural=coastline", "N": "n1,n2,..."}"""
    return {field[0]: field[1:] for field in line.split()}


def join(ways):
    """The coast from end to end: [(id, nodes)] in order, where each way begins with the last node of the one before."""
    following = {nodes[0]: (name, nodes) for name, nodes in ways if nodes[0] != nodes[-1]}
    ends = {nodes[-1] for _, nodes in ways}
    (at,) = [nodes[0] for _, nodes in ways if nodes[0] not in ends]
    coast = []
    while at in following:
        coast.append(following.pop(at))
        at = coast[-1][1][-1]
    assert not following, "the coast is in pieces"
    return coast


def add_sea(lines):
    """The lines with a sea; osmium sorts them."""
    objects = [fields(line) for line in lines]
    nodes = {o["n"]: (float(o["x"]), float(o["y"])) for o in objects if "n" in o and "x" in o}
    ways = [(o["w"], o["N"].replace("n", "").split(",")) for o in objects
            if "w" in o and "natural=coastline" in o.get("T", "")]
    coast, islands = join(ways), [name for name, nodes in ways if nodes[0] == nodes[-1]]
    first, last = coast[0][1][0], coast[-1][1][-1]
    corners = [(OFF_SHORE[0], nodes[last][1]), OFF_SHORE, (nodes[first][0], OFF_SHORE[1])]
    sea = [f"n{FIRST_ID + i} x{x} y{y}" for i, (x, y) in enumerate(corners)]
    sea.append(f"w{FIRST_ID} Nn{last}," + "".join(f"n{FIRST_ID + i}," for i in range(3)) + f"n{first}")
    members = [f"w{name}@outer" for name in [name for name, _ in coast] + [FIRST_ID]]
    members += [f"w{name}@inner" for name in islands]
    sea.append(f"r{FIRST_ID} Ttype=multipolygon,natural=water M" + ",".join(members))
    return lines + sea


def main():
    with tempfile.TemporaryDirectory() as folder:
        cut, kept, opl = (os.path.join(folder, name) for name in ("cut.osm.pbf", "kept.opl", "sea.opl"))
        osmium("extract", "-b", BOX, "-s", "smart", sys.argv[1], "-o", cut)
        osmium("tags-filter", cut, *("nwr/" + key for key in KEYS), "-o", kept, "-f", "opl,add_metadata=none")
        with open(kept, encoding="utf-8") as file:
            lines = add_sea(file.read().splitlines())
        with open(opl, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
        osmium("sort", opl, "-O", "-o", os.path.join(HERE, "monaco.osm.pbf"), "-f", "pbf,add_metadata=none")


if __name__ == "__main__":
    main()
