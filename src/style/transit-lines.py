#!/usr/bin/env python3
"""Makes the lines that the style "transit" draws from OpenStreetMap's route relations. Routes that share a street get
slots next to each other.

    osmium tags-filter city.osm.pbf r/route=subway,tram,light_rail,train,ferry -f osm -o routes.osm
    python3 transit-lines.py routes.osm > transit.geojson

Ways within 25 m of each other, such as the tracks of a line, are joined into one, with the routes of all of them. A
stretch with n routes becomes n features, each with its "slot". Slot 0 is the middle; from left to right, as seen in the
stretch's direction, the routes are ordered by mode, colour and number. Stretches that continue each other have the same
direction. Where a route's slot changes, it moves over within TAPER_M on both sides, in short features with "taper". The
first feature of a stretch has the numbers of all its routes ("refs"). A station is a point: the stops of
one name that are within 300 m, moved to the nearest street of routes. Only Python's standard library is needed."""

import collections
import json
import math
import re
import sys
import xml.etree.ElementTree as xml

SNAP_M = 25.0  # anything closer belongs to the same street
SHORT_M = 250.0  # routes that are together for less only cross
STEP_M = 20.0  # between vertices of a street
SAMPLE_M = 5.0
FINE_M = 0.1
BEND_M = 140.0  # of a branch, in which it bends to join its trunk
BEND_STEPS = 16
TAPER_M = 90.0  # of a stretch, in which a route moves from one slot to another
TAPER_STEPS = 10
STATION_M = 300.0  # stops of one name that are closer belong to the same station
ALONG = math.cos(math.radians(30))  # ways at a larger angle to a street only cross it
GROUPS = {"metro": ["subway", "light_rail", "monorail", "funicular"], "train": ["train"], "tram": ["tram"],
          "ferry": ["ferry"], "bus": ["bus", "trolleybus"]}  # each group has its own slots
GROUP_OF = {mode: group for group, modes in GROUPS.items() for mode in modes}
ORDER = [mode for modes in GROUPS.values() for mode in modes]

Route = collections.namedtuple("Route", "mode colour ref network state")


def tags_of(element):
    return {tag.get("k"): tag.get("v") for tag in element.findall("tag")}


def read(path):
    """Returns the ways, as lists of positions with their tags, the ways of each route, and the stops of each group, as
    positions with their names. Both directions of a line are one route."""
    nodes, names, ways, routes, stops = {}, {}, {}, collections.defaultdict(set), collections.defaultdict(set)
    for element in xml.parse(path).getroot():
        if element.tag == "node" and element.get("lon"):
            nodes[element.get("id")] = (float(element.get("lon")), float(element.get("lat")))
            names[element.get("id")] = tags_of(element).get("name")
        elif element.tag == "way":
            line = [nodes[nd.get("ref")] for nd in element.findall("nd") if nd.get("ref") in nodes]
            if len(line) > 1:
                ways[element.get("id")] = (line, tags_of(element))
        elif element.tag == "relation":
            tags = tags_of(element)
            if tags.get("type") != "route" or tags.get("route") not in GROUP_OF:
                continue
            works = tags.get("state") in ("proposed", "construction")
            route = Route(tags["route"], tags.get("colour", "").lower(), (tags.get("ref") or tags.get("name", "")).strip("<>"),
                          tags.get("network", ""), "construction" if works else "")
            for member in element.findall("member"):
                if member.get("type") == "node" and names.get(member.get("ref")) and not works:
                    stops[GROUP_OF[route.mode]].add((names[member.get("ref")], nodes[member.get("ref")]))
                if member.get("type") == "way" and not re.match("platform|stop", member.get("role", "")):
                    routes[route].add(member.get("ref"))
    return ways, routes, stops


def natural(text):
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in re.findall(r"\d+|\D+", text)]


def order_of(route):
    return (ORDER.index(route.mode), route.colour, natural(route.ref), route.network, route.state)


class Streets:
    """A graph of vertices STEP_M apart. Its edges have the routes along them."""

    def __init__(self):
        self.at, self.heading, self.weight, self.cells = [], [], [], collections.defaultdict(list)
        self.edges = {}  # (smaller vertex, larger vertex): [routes, samples in tunnels, samples]

    def near(self, x, y, heading, without):
        best, best_m = None, SNAP_M
        cell_x, cell_y = int(x // SNAP_M), int(y // SNAP_M)
        for i in range(cell_x - 1, cell_x + 2):
            for j in range(cell_y - 1, cell_y + 2):
                for vertex in self.cells[i, j]:
                    far_m = math.dist(self.at[vertex], (x, y))
                    along = heading is None or abs(math.cos(self.heading[vertex] - heading)) > ALONG
                    if far_m < best_m and along and vertex not in without:
                        best, best_m = vertex, far_m
        return best

    def new(self, x, y, heading):
        self.at.append((x, y))
        self.heading.append(heading)
        self.weight.append(1)
        self.cells[int(x // SNAP_M), int(y // SNAP_M)].append(len(self.at) - 1)
        return len(self.at) - 1

    def draw_to(self, vertex, x, y):
        """Moves a vertex to the mean of its positions. It stays in its cell, which is accurate enough."""
        n = self.weight[vertex]
        self.at[vertex] = ((self.at[vertex][0] * n + x) / (n + 1), (self.at[vertex][1] * n + y) / (n + 1))
        self.weight[vertex] = n + 1

    def add(self, line, routes, in_tunnel):
        own, last, last_own = set(), None, None
        samples = list(sampled(line))
        for number, (x, y) in enumerate(samples):
            (ax, ay), (bx, by) = samples[max(number - 3, 0)], samples[min(number + 3, len(samples) - 1)]
            heading = math.atan2(by - ay, bx - ax)
            is_end = number in (0, len(samples) - 1)
            vertex = self.near(x, y, None if is_end else heading, own)
            if vertex is None:
                if last_own is not None and math.dist(self.at[last_own], (x, y)) < (1 if is_end else STEP_M):
                    continue
                vertex = last_own = self.new(x, y, heading)
                own.add(vertex)
            elif vertex != last:
                self.draw_to(vertex, x, y)
            if last is not None and vertex != last:
                edge = self.edges.setdefault((min(last, vertex), max(last, vertex)), [set(), 0, 0])
                edge[0].update(routes)
                edge[1] += in_tunnel
                edge[2] += 1
            last = vertex


def sampled(line):
    yield line[0]
    for a, b in zip(line, line[1:]):
        count = max(1, math.ceil(math.dist(a, b) / SAMPLE_M))
        for i in range(1, count + 1):
            yield (a[0] + (b[0] - a[0]) * i / count, a[1] + (b[1] - a[1]) * i / count)


def trace(pieces):
    """Joins pieces into lists of vertices along which the routes stay the same. A piece has two vertices, its routes,
    and whether it is a tunnel. Pieces that share no route only cross each other."""
    around = collections.defaultdict(list)
    for number, (a, b, _, _) in enumerate(pieces):
        around[a].append(number)
        around[b].append(number)

    def next_of(number, vertex):
        kind = pieces[number][2:]
        others = [n for n in around[vertex] if n != number and pieces[n][2] & kind[0]]
        return others[0] if len(others) == 1 and pieces[others[0]][2:] == kind else None

    def other_end(number, vertex):
        return pieces[number][0] if pieces[number][1] == vertex else pieces[number][1]

    done, lines = set(), []
    for first in range(len(pieces)):
        if first in done:
            continue
        number, vertex = first, pieces[first][0]  # go back to the start of the stretch, or once around a ring
        while (before := next_of(number, vertex)) is not None and before != first:
            number, vertex = before, other_end(before, vertex)
        line, numbers = [vertex], []
        while number is not None and number not in done:
            done.add(number)
            numbers.append(number)
            vertex = other_end(number, vertex)
            line.append(vertex)
            number = next_of(number, vertex)
        lines.append((line, pieces[first][2:], numbers))
    return lines


def stretches(streets):
    pieces = [(a, b, frozenset(it[0]), 2 * it[1] >= it[2]) for (a, b), it in sorted(streets.edges.items())]
    lines = trace(pieces)
    at = collections.defaultdict(list)
    for line, (routes, _), _ in lines:
        at[line[0]].append(routes)
        at[line[-1]].append(routes)
    crossed = {}
    for line, (routes, in_tunnel), numbers in lines:
        if len(numbers) * STEP_M > SHORT_M:
            continue
        through = {it for it in at[line[0]] if it < routes} & {it for it in at[line[-1]] if it < routes}
        if sum(map(len, through)) == len(routes) and frozenset().union(*through) == routes:
            crossed.update({number: through for number in numbers})
    return trace([(a, b, it, in_tunnel) for number, (a, b, routes, in_tunnel) in enumerate(pieces)
                  for it in sorted(crossed.get(number, [routes]), key=sorted)])


def ends_at(lines):
    """Returns the ends at each vertex: numbers of lines, with 0 for the first end and 1 for the last."""
    ends = collections.defaultdict(list)
    for number, (line, *_) in enumerate(lines):
        ends[line[0]].append((number, 0))
        ends[line[-1]].append((number, 1))
    return ends


def heading_of(line, end, streets):
    """Returns the direction in which a line leaves its end."""
    reach = min(3, len(line) - 1)
    a, b = (line[0], line[reach]) if end == 0 else (line[-1], line[-1 - reach])
    (ax, ay), (bx, by) = streets.at[a], streets.at[b]
    return math.atan2(by - ay, bx - ax)


def direct(lines, streets):
    """Gives stretches that share a route and continue each other straight on the same direction."""
    ends = ends_at(lines)

    def heading(number, end):
        return heading_of(lines[number][0], end, streets)

    turned = {}
    for first in sorted(range(len(lines)), key=lambda n: (-len(lines[n][1][0]), -len(lines[n][0]), n)):
        if first in turned:
            continue
        turned[first] = False
        queue = collections.deque([first])
        while queue:
            number = queue.popleft()
            for end in (0, 1):
                for other, other_end in ends[lines[number][0][-end]]:
                    if other in turned or not lines[other][1][0] & lines[number][1][0]:
                        continue
                    turn = math.cos(heading(number, end) - heading(other, other_end))
                    if turn < 0:  # straight on, because both headings point away from the vertex
                        turned[other] = turned[number] if end != other_end else not turned[number]
                        queue.append(other)
    return [(line[::-1] if turned[n] else line, kind) for n, (line, kind, _) in enumerate(lines)]


def untangle(streets):
    """Leaves one way through a triangle that a route goes around on both sides: the edge, or the detour by a corner from
    which the route goes nowhere else, if other routes take the detour."""
    around = collections.defaultdict(set)
    for a, b in streets.edges:
        around[a].add(b)
        around[b].add(a)

    def routes(a, b):
        return streets.edges[min(a, b), max(a, b)][0]

    for a, b in sorted(streets.edges):
        for c in sorted(around[a] & around[b]):
            common = routes(a, b) & routes(b, c) & routes(a, c)
            for route in sorted(common, key=order_of):
                for corner, left, right in ((a, b, c), (b, a, c), (c, a, b)):
                    if {other for other in around[corner] if route in routes(corner, other)} != {left, right}:
                        continue
                    if (routes(corner, left) & routes(corner, right)) - common:
                        routes(left, right).discard(route)
                    else:
                        routes(corner, left).discard(route)
                        routes(corner, right).discard(route)
                    break
    for edge in [edge for edge, its in streets.edges.items() if not its[0]]:
        del streets.edges[edge]


def smooth(streets):
    """Moves each vertex towards the middle of the two neighbours that it is most nearly in line with."""
    around = collections.defaultdict(list)
    for a, b in sorted(streets.edges):
        around[a].append(b)
        around[b].append(a)
    for _ in range(6):
        at = list(streets.at)
        for vertex, others in around.items():
            turns = [(turn_at(at, a, vertex, b), a, b) for i, a in enumerate(others) for b in others[:i]]
            if turns and min(turns)[0] < -0.5:
                _, a, b = min(turns)
                streets.at[vertex] = tuple((at[a][i] + 2 * at[vertex][i] + at[b][i]) / 4 for i in (0, 1))


def turn_at(at, a, b, c):
    """Returns the cosine of the angle at b. -1 is straight on."""
    ux, uy, vx, vy = at[a][0] - at[b][0], at[a][1] - at[b][1], at[c][0] - at[b][0], at[c][1] - at[b][1]
    return (ux * vx + uy * vy) / (math.hypot(ux, uy) * math.hypot(vx, vy) or 1)


def rounded(points):
    """Returns a line that is smoothed, has its corners cut twice, and lacks points within FINE_M of a straight line."""
    for _ in range(6):
        points = points[:1] + [tuple((a[i] + 2 * b[i] + c[i]) / 4 for i in (0, 1))
                               for a, b, c in zip(points, points[1:], points[2:])] + points[-1:]
    for _ in range(2):
        cut = [points[0]]
        for a, b in zip(points, points[1:]):
            cut += [tuple(a[i] + (b[i] - a[i]) * t for i in (0, 1)) for t in (0.25, 0.75)]
        points = cut + [points[-1]]
    return simplified(points)


def simplified(points):
    (ax, ay), (bx, by) = points[0], points[-1]
    length = math.hypot(bx - ax, by - ay)
    far = [abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / length if length else math.hypot(x - ax, y - ay)
           for x, y in points[1:-1]]
    if not far or max(far) < FINE_M:
        return [points[0], points[-1]]
    middle = far.index(max(far)) + 1
    return simplified(points[:middle + 1])[:-1] + simplified(points[middle:])


def bent(points, ways):
    """Returns a line that leaves its ends in the given directions, None for any: a branch joins its trunk gradually."""
    for way in ways:
        far = along(points)
        reach = min(BEND_M, far[-1] / 2)
        if way is not None and reach > STEP_M:
            rest = part(points, far, reach, far[-1])
            (x0, y0), (x1, y1), (x2, y2) = points[0], rest[0], rest[1]
            length = math.dist(rest[0], rest[1]) or 1
            ux, uy, vx, vy = math.cos(way) * reach, math.sin(way) * reach, (x2 - x1) / length * reach, (y2 - y1) / length * reach
            curve = []
            for t in (k / BEND_STEPS for k in range(BEND_STEPS)):
                a, b, c, d = 2 * t**3 - 3 * t**2 + 1, t**3 - 2 * t**2 + t, 3 * t**2 - 2 * t**3, t**3 - t**2
                curve.append((a * x0 + b * ux + c * x1 + d * vx, a * y0 + b * uy + c * y1 + d * vy))
            points = curve + rest
        points = points[::-1]
    return points


def trunks(lines, streets):
    """Returns, for each line, the directions in which its two ends must leave so that they go on straight in the line
    with the most routes there, or None."""
    ends, found = ends_at(lines), []
    for number, (line, (routes, _)) in enumerate(lines):
        ways = []
        for end in (0, 1):
            heading = heading_of(line, end, streets)
            on = [(-len(lines[other][1][0]), math.cos(heading - there), there) for other, other_end in ends[line[-end]]
                  if other != number and routes & lines[other][1][0]
                  for there in [heading_of(lines[other][0], other_end, streets)]]
            most, cosine, there = min(on, default=(0, 0, 0))
            ways.append(there + math.pi if -most > len(routes) and cosine < -0.6 else None)
        found.append(ways)
    return found


def slots_of(routes):
    """Returns the slot of each route of a stretch."""
    return {route: i - (len(routes) - 1) / 2 for i, route in enumerate(sorted(routes, key=order_of))}


def slots_at_ends(lines, streets):
    """Returns, for each line, the slots of its routes at its two ends: halfway to the slot in the line that goes on."""
    ends = ends_at(lines)
    found = []
    for number, (line, (routes, _)) in enumerate(lines):
        slots = slots_of(routes)
        at_ends = []
        for end in (0, 1):
            heading, there = heading_of(line, end, streets), {}
            for route, slot in slots.items():
                on = [(math.cos(heading - heading_of(lines[other][0], other_end, streets)), other, other_end)
                      for other, other_end in ends[line[-end]] if other != number and route in lines[other][1][0]]
                if on and min(on)[0] < -0.5:
                    _, other, other_end = min(on)
                    sign = 1 if other_end != end else -1  # if both begin or both end here, left and right are swapped
                    there[route] = (slot + sign * slots_of(lines[other][1][0])[route]) / 2
            at_ends.append(there)
        found.append(at_ends)
    return found


def along(points):
    """Returns the distance of each point from the first."""
    far = [0.0]
    for a, b in zip(points, points[1:]):
        far.append(far[-1] + math.dist(a, b))
    return far


def part(points, far, start, end):
    """Returns the part of a line between two distances along it."""
    def at(distance):
        i = next((i for i in range(1, len(far) - 1) if far[i] >= distance), len(far) - 1)
        t = (distance - far[i - 1]) / ((far[i] - far[i - 1]) or 1)
        return tuple(points[i - 1][k] + (points[i][k] - points[i - 1][k]) * t for k in (0, 1))
    return [at(start)] + [point for point, it in zip(points, far) if start < it < end] + [at(end)]


def tapered(points, slot, first, last):
    """Yields a line in parts, with the slot of each and whether it is part of a taper. first, last: the slots at the
    ends of the line."""
    far = along(points)
    reach = min(TAPER_M, far[-1] / 2)
    ends = [reach if abs(there - slot) > 0.01 else 0.0 for there in (first, last)]
    for there, begin, step in ((first, 0.0, ends[0] / TAPER_STEPS), (last, far[-1], -ends[1] / TAPER_STEPS)):
        for k in range(TAPER_STEPS if step else 0):
            t = (k + 0.5) / TAPER_STEPS
            edges = sorted((begin + k * step, begin + (k + 1) * step))
            yield part(points, far, *edges), there + (slot - there) * t * t * (3 - 2 * t), True
    if ends[0] + ends[1] < far[-1]:
        yield part(points, far, ends[0], far[-1] - ends[1]) if any(ends) else points, slot, False


def stations(stops, streets):
    """Yields the name and the position of each station, for stops in metres."""
    found = []  # name, positions
    for name, at in sorted(stops):
        near = [its for its_name, its in found if its_name == name and math.dist(its[0], at) < STATION_M]
        if near:
            near[0].append(at)
        else:
            found.append((name, [at]))
    for name, its in found:
        middle = tuple(sum(at[i] for at in its) / len(its) for i in (0, 1))
        nearest = min(streets.at, key=lambda at: math.dist(at, middle), default=middle)
        yield name, nearest if math.dist(nearest, middle) < STATION_M / 2 else middle


def features(ways, routes, stops):
    if not ways:
        return
    latitude = sum(line[0][1] for line, _ in ways.values()) / len(ways)
    east_m, north_m = 111320 * math.cos(math.radians(latitude)), 111320
    for group in GROUPS:
        along = collections.defaultdict(set)
        for route, members in routes.items():
            if GROUP_OF[route.mode] == group:
                for way in members & ways.keys():
                    along[way].add(route)
        streets = Streets()
        for way in sorted(along, key=lambda it: (-len(along[it]), int(it))):
            line, tags = ways[way]
            in_tunnel = tags.get("tunnel", "no") != "no"
            streets.add([(x * east_m, y * north_m) for x, y in line], along[way], in_tunnel)
        untangle(streets)
        smooth(streets)
        lines = direct(stretches(streets), streets)
        for (line, (here, in_tunnel)), (first, last), ways_out in zip(lines, slots_at_ends(lines, streets),
                                                                      trunks(lines, streets)):
            points = bent(rounded([streets.at[vertex] for vertex in line]), ways_out)
            refs = "  ".join(dict.fromkeys(it.ref for it in sorted(here, key=order_of) if it.ref))
            for route, slot in slots_of(here).items():
                for places, its_slot, is_taper in tapered(points, slot, first.get(route, slot), last.get(route, slot)):
                    properties = {key: value for key, value in route._asdict().items() if value}
                    properties.update(slot=round(its_slot, 3), routes=len(here), tunnel=in_tunnel)
                    if is_taper:
                        properties["taper"] = True
                    elif refs:
                        properties["refs"], refs = refs, ""
                    coordinates = [[round(x / east_m, 7), round(y / north_m, 7)] for x, y in places]
                    yield {"type": "Feature", "properties": properties,
                           "geometry": {"type": "LineString", "coordinates": coordinates}}
        here = [(name, (x * east_m, y * north_m)) for name, (x, y) in stops.get(group, ())]
        for name, (x, y) in stations(here, streets):
            yield {"type": "Feature", "properties": {"station": name, "group": group},
                   "geometry": {"type": "Point", "coordinates": [round(x / east_m, 7), round(y / north_m, 7)]}}


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    path = sys.argv[1]
    try:
        ways, routes, stops = read(path)
    except OSError as error:
        sys.exit(f"{path}: cannot be read: {error.strerror}; check the path and its permissions")
    except (xml.ParseError, TypeError, ValueError) as error:
        sys.exit(f"{path}: not OpenStreetMap XML: {error}; make it with osmium tags-filter ... -f osm")
    json.dump({"type": "FeatureCollection", "features": list(features(ways, routes, stops))}, sys.stdout,
              ensure_ascii=False, separators=(",", ":"))


if __name__ == "__main__":
    main()
