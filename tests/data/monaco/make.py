#!/usr/bin/env python3
"""Makes monaco.osm.pbf of the extract that Debian's source package osrm-backend has: make.py EXTRACT.osm.pbf

osmium cuts a box out, writes the box into the file's header, and leaves out what the style city does not look at,
authors and versions too.
"""

import os
import subprocess
import sys
import tempfile

BOX = "7.395,43.716,7.45,43.7555"  # west, south, east, north
KEYS = "highway building natural landuse leisure waterway railway amenity man_made aeroway".split()
HERE = os.path.dirname(os.path.abspath(__file__))


def osmium(*arguments):
    subprocess.run(["osmium", *arguments], check=True)


def main():
    with tempfile.TemporaryDirectory() as folder:
        cut = os.path.join(folder, "cut.osm.pbf")
        osmium("extract", "-b", BOX, "--set-bounds", "-s", "smart", sys.argv[1], "-o", cut)
        osmium("tags-filter", cut, *("nwr/" + key for key in KEYS), "-O", "-o", os.path.join(HERE, "monaco.osm.pbf"),
               "-f", "pbf,add_metadata=none")


if __name__ == "__main__":
    main()
