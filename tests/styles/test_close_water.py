"""Checks close_water.py: the sea of a box, areas of water that are cut, and ways that lack nodes."""

import pathlib
import subprocess
import sys

# A coast from the south to the north of the box, with land in the west; an island in the sea; a lake, of which one way
# is missing, and another one that is whole.
EXTRACT = """n1 x1 y0.001
n2 x1 y1
n3 x1.2 y1.999
n4 x1.5 y0.5
n5 x1.7 y0.5
n6 x1.6 y0.7
n7 x0.2 y0.2
n8 x0.4 y0.2
n9 x0.3 y0.4
w1 Tnatural=coastline Nn2,n3
w2 Tnatural=coastline Nn1,n2
w3 Tnatural=coastline Nn4,n5,n6,n4
w4 T Nn7,n8
w5 T Nn8,n9,n7
w6 Thighway=primary Nn7,n99,n8
w7 Thighway=primary Nn99,n8
r1 Ttype=multipolygon,natural=water Mw4@outer,w5@outer
r2 Ttype=multipolygon,natural=water Mw4@outer
r3 Ttype=multipolygon,natural=water Mw4@outer,w55@outer
"""

script = pathlib.Path(__file__).with_name("close_water.py")
rows = subprocess.run([sys.executable, script, "0", "0", "2", "2"], input=EXTRACT, capture_output=True, text=True,
                      check=True).stdout.splitlines()
names = [row.split()[0] for row in rows]
assert {"r1", "w6"} <= set(names) and not {"r2", "r3", "w7"} & set(names), names
assert "w6 Thighway=primary Nn7,n8" in rows, rows
places = {row.split()[0]: tuple(float(field[1:]) for field in row.split()[2:]) for row in rows if row.startswith("n1717")}
outer, inner = ([places[node] for node in row.split(" N")[1].split(",")] for row in rows if row.startswith("w1717"))
assert outer == [(1, 0), (1, 0.001), (1, 1), (1.2, 1.999), (1.2, 2), (2, 2), (2, 0), (1, 0)], outer
assert inner == [(1.5, 0.5), (1.7, 0.5), (1.6, 0.7), (1.5, 0.5)], inner
assert rows[-1].split()[2:] == ["Ttype=multipolygon,natural=water,water=river", "Mw17179869191@outer,w17179869194@inner"], rows[-1]
