"""Makes an extract of OpenStreetMap one that tilemaker reads: it fails if a way lacks nodes, floods land if an area of
water is cut, and takes the sea from a file of its own.

usage: osmium cat CITY.osm.pbf -f opl | close_water.py WEST SOUTH EAST NORTH > OUT.osm.opl

References to missing nodes are left out, and so are areas of water that are cut. The sea of the box is added as areas
of water: coastlines have it on their right, so an area follows a coastline to its end, and then the box clockwise to
where the next coastline begins."""

import math
import sys

FIRST_NEW = 1 << 34  # above all of OpenStreetMap's numbers, as of 2026
WATER = ("natural=water", "natural=bay", "natural=strait")


class Box:
    def __init__(self, west, south, east, north):
        self.corners = [(west, north), (east, north), (east, south), (west, south)]  # clockwise
        self.west, self.south, self.east, self.north = west, south, east, north

    def touch(self, at):
        """Returns the nearest point of the box's edge, and how far around the box it is, from 0 to 4."""
        x, y = min(max(at[0], self.west), self.east), min(max(at[1], self.south), self.north)
        across, down = (x - self.west) / (self.east - self.west), (self.north - y) / (self.north - self.south)
        return min(((math.dist(at, point), point, turn) for point, turn in (
            ((x, self.north), across), ((self.east, y), 1 + down), ((x, self.south), 3 - across),
            ((self.west, y), 4 - down))))[1:]


def chains(ways):
    """Joins coastlines at their common nodes."""
    ways, joined = {way[0]: way for way in ways}, []
    ends = {way[-1] for way in ways.values()}
    for first in sorted(ways, key=lambda node: (node in ends, node)):  # open ones first
        chain = ways.pop(first, None)
        while chain and chain[-1] in ways:
            chain = chain + ways.pop(chain[-1])[1:]
        joined += [chain] if chain else []
    return joined


def close(open_chains, box):
    """Returns rings of the sea from coastlines that end at the box."""
    begins = sorted((box.touch(chain[0])[1], number) for number, chain in enumerate(open_chains))
    rings, left = [], set(range(len(open_chains)))
    while left:
        number, ring, first = min(left), [], min(left)
        while True:
            left.discard(number)
            chain = open_chains[number]
            ring += [box.touch(chain[0])[0]] + chain + [box.touch(chain[-1])[0]]
            turn = box.touch(chain[-1])[1]
            there, following = min(((at - turn) % 4, other) for at, other in begins)
            ring += [box.corners[corner % 4] for corner in range(1 + math.floor(turn), 1 + math.floor(turn + there))]
            if following == first or following not in left:
                break
            number = following
        rings.append(ring + ring[:1])
    return rings


def is_clockwise(ring):
    return sum((b[0] - a[0]) * (b[1] + a[1]) for a, b in zip(ring, ring[1:])) > 0


def seas(coasts, places, box):
    """Returns rings of the sea and of its islands."""
    lines = [[places[node] for node in chain] for chain in chains(coasts)]
    closed = [line for line in lines if line[0] == line[-1] and len(line) > 3]
    rings = close([line for line in lines if line[0] != line[-1]], box)
    outer = rings + [line for line in closed if is_clockwise(line)]
    inner = [line for line in closed if not is_clockwise(line)]
    if inner and not rings:
        outer.append(box.corners + box.corners[:1])
    return outer, inner


def write(outer, inner):
    new, members, after = FIRST_NEW, [], []
    for role, rings in (("outer", outer), ("inner", inner)):
        for ring in rings:
            refs = []
            for x, y in ring[:-1]:
                new += 1
                print(f"n{new} v1 x{x:.7f} y{y:.7f}")
                refs.append(f"n{new}")
            after.append(f"w{new} v1 N{','.join(refs + refs[:1])}")
            members.append(f"w{new}@{role}")
    print("\n".join(after + [f"r{new} v1 Ttype=multipolygon,natural=water,water=river M{','.join(members)}"]))


def is_whole(members, ways):
    """Whether the ways of an area are all there, and form rings."""
    names = [member.split("@")[0] for member in members if member[0] == "w"]
    odd = set()
    for name in names:
        odd ^= {ways[name][0]} ^ {ways[name][1]} if name in ways else {name}
    return not odd


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    box, places, ways, coasts = Box(*map(float, sys.argv[1:])), {}, {}, []
    for row in sys.stdin:
        fields = {field[0]: field[1:] for field in row.split()[1:]}
        if row[0] == "n":
            places[row.split()[0]] = (float(fields["x"]), float(fields["y"]))
        elif row[0] == "w":
            nodes = [node for node in fields["N"].split(",") if node in places]
            row = " ".join(f"N{','.join(nodes)}" if it[0] == "N" else it for it in row.split()) + "\n"
            if len(nodes) < 2:
                continue
            ways[row.split()[0]] = nodes[0], nodes[-1]
            if "natural=coastline" in fields["T"].split(","):
                coasts.append(nodes)
        elif any(tag in fields["T"].split(",") for tag in WATER) and not is_whole(fields["M"].split(","), ways):
            continue
        sys.stdout.write(row)
    if coasts:
        write(*seas(coasts, places, box))


if __name__ == "__main__":
    main()
