#!/usr/bin/env bash
# Lines of public transport from OpenStreetMap's routes: test_transit.sh TOOL SCRIPT. Slots where they share a street.
set -eu
tool=$1
script=$2
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# A degree is 111.3 km here. Routes 1 and 2 share the way 10 for 1.1 km, then 2 turns to the north-east (12) and 1 goes on
# through a tunnel (11); the way 13 is 1's other track, 11 m away. Route 3 crosses both.
cat >routes.osm <<'XML'
<osm version="0.6">
  <node id="1" lon="0" lat="0"><tag k="name" v="West End"/></node><node id="2" lon="0.01" lat="0"/><node id="3" lon="0.02" lat="0"/>
  <node id="4" lon="0.02" lat="0.01"/><node id="5" lon="0.005" lat="-0.01"/><node id="6" lon="0.005" lat="0.01"/>
  <node id="7" lon="0" lat="0.0001"><tag k="name" v="West End"/></node><node id="8" lon="0.02" lat="0.0001"/>
  <way id="10"><nd ref="1"/><nd ref="2"/><tag k="railway" v="subway"/></way>
  <way id="11"><nd ref="2"/><nd ref="3"/><tag k="railway" v="subway"/><tag k="tunnel" v="yes"/></way>
  <way id="12"><nd ref="2"/><nd ref="4"/></way>
  <way id="13"><nd ref="8"/><nd ref="7"/></way>
  <way id="14"><nd ref="5"/><nd ref="6"/></way>
  <relation id="1"><member type="way" ref="10" role=""/><member type="way" ref="11" role=""/>
    <tag k="type" v="route"/><tag k="route" v="subway"/><tag k="ref" v="1"/><tag k="colour" v="#FF0000"/></relation>
  <relation id="2"><member type="way" ref="13" role=""/><member type="node" ref="1" role="stop"/>
    <tag k="type" v="route"/><tag k="route" v="subway"/><tag k="ref" v="1"/><tag k="colour" v="#FF0000"/></relation>
  <relation id="3"><member type="way" ref="10" role=""/><member type="way" ref="12" role=""/><member type="way" ref="99" role=""/>
    <member type="node" ref="7" role="stop"/>
    <tag k="type" v="route"/><tag k="route" v="subway"/><tag k="ref" v="2"/><tag k="colour" v="red"/></relation>
  <relation id="4"><member type="way" ref="14" role=""/>
    <tag k="type" v="route"/><tag k="route" v="subway"/><tag k="ref" v="3"/><tag k="state" v="proposed"/></relation>
  <relation id="5"><member type="way" ref="14" role=""/>
    <tag k="type" v="route"/><tag k="route" v="hiking"/></relation>
</osm>
XML
python3 "$script" routes.osm >transit.geojson
python3 - <<'PY'
import json

features = json.load(open("transit.geojson"))["features"]


def those(ref):
    return [(f["properties"], f["geometry"]["coordinates"]) for f in features
            if f["properties"].get("ref") == ref and "taper" not in f["properties"]]


def tapers(ref, routes):
    """The slots of a route's tapers in stretches of so many routes, from the west."""
    return [slot for _, slot in sorted((f["geometry"]["coordinates"][0][0], f["properties"]["slot"]) for f in features
            if f["properties"].get("ref") == ref and "taper" in f["properties"] and f["properties"]["routes"] == routes)]


def expect(holds, what):
    if not holds:
        raise SystemExit(f"{what}: {json.dumps(features)}")


expect({f["properties"]["mode"] for f in features if "station" not in f["properties"]} == {"subway"}, "modes")
(station, at), = [(f["properties"], f["geometry"]["coordinates"]) for f in features if "station" in f["properties"]]
expect(station == {"station": "West End", "group": "metro"} and abs(at[0]) < 0.0001 and 0 <= at[1] <= 0.0001, "a station")
(shared, along), = [it for it in those("1") if it[0]["routes"] == 2]
(other, beside), = [it for it in those("2") if it[0]["routes"] == 2]
expect(along == beside and (shared["slot"], other["slot"]) == (-0.5, 0.5), "slots of a shared street")
expect(shared["refs"] == "1  2" and "refs" not in other, "numbers of a shared street")
expect(shared["colour"] == "#ff0000" and other["colour"] == "red", "colours")
ends = sorted([along[0][0], along[-1][0]])
expect(abs(ends[0]) < 0.0001 and abs(ends[1] - 0.01 + 90 / 111320) < 0.0003, "where the shared street lies")
expect(all(0 <= y <= 0.0001 for _, y in along), "the middle of two tracks")
(alone, rest), = [it for it in those("1") if it[0]["routes"] == 1]
expect(alone["slot"] == 0 and alone["tunnel"] and not shared["tunnel"], "a route by itself")
expect((rest[0][0] < rest[-1][0]) == (along[0][0] < along[-1][0]), "stretches that go on have one direction")
(branch, turn), = [it for it in those("2") if it[0]["routes"] == 1]
expect(branch["slot"] == 0 and abs(max(turn)[1] - 0.01) < 0.0001, "a branch")
near = min((it["geometry"]["coordinates"] for it in features if it["properties"].get("ref") == "2" and it["properties"]["routes"] == 1),
           key=lambda line: min(abs(x - 0.01) + abs(y) for x, y in line))
near = near if abs(near[0][0] - 0.01) < abs(near[-1][0] - 0.01) else near[::-1]
expect(abs(near[1][1] - near[0][1]) < 0.3 * (near[1][0] - near[0][0]), "a branch leaves its trunk gradually")
slots = tapers("1", 2) + tapers("1", 1)
steps = [abs(b - a) for a, b in zip([-0.5] + slots, slots + [0])]
expect(len(slots) == 20 and slots == sorted(slots) and max(steps) < 0.1, "route 1 moves over in small steps where 2 leaves")
(crossing, across), = those("3")
expect(crossing["slot"] == 0 and crossing["state"] == "construction" and "colour" not in crossing, "what crosses")
expect(abs(abs(across[0][1] - across[-1][1]) - 0.02) < 0.0001, "what crosses is one line")
PY
python3 - "$script" <<'PY'
import runpy
import sys
import types

script = runpy.run_path(sys.argv[1])
n, b = (script["Route"]("subway", "", ref, "", "") for ref in "NB")


def untangled(edges):
    streets = types.SimpleNamespace(edges={edge: [set(routes), 0, 1] for edge, routes in edges.items()})
    script["untangle"](streets)
    return {edge: its[0] for edge, its in streets.edges.items()}


# N goes from 1 to 4, past the triangle 1, 2, 3. It keeps to the edge, or to the detour by 2 if B goes there.
alone = untangled({(0, 1): [n], (1, 2): [n], (2, 3): [n], (1, 3): [n], (3, 4): [n]})
assert alone == {(0, 1): {n}, (1, 3): {n}, (3, 4): {n}}, alone
both = untangled({(0, 1): [n, b], (1, 2): [n, b], (2, 3): [n, b], (1, 3): [n], (3, 4): [n, b]})
assert both == {(0, 1): {n, b}, (1, 2): {n, b}, (2, 3): {n, b}, (3, 4): {n, b}}, both
PY
"$tool" render -q --style transit --center 0.01,0 --zoom 14 --size 256x256 -o lines.png
"$tool" render -q --style transit --theme dark --center 0.01,0 --zoom 14 --size 256x256 -o dark.png
if cmp -s lines.png dark.png; then echo "the themes are the same"; exit 1; fi
if python3 "$script" 2>"$folder/log"; then echo "no file is no error"; exit 1; fi
grep -q 'osmium tags-filter' "$folder/log"
printf 'no XML\211' >text.osm
mkdir folder.osm
for file in none.osm text.osm folder.osm; do
    status=0
    python3 "$script" $file >/dev/null 2>log || status=$?
    if [ "$status" != 1 ] || [ "$(wc -l <log)" != 1 ] || ! grep -q "^$file: .*; " log; then
        echo "$file: exit status $status: $(cat log)"
        exit 1
    fi
done
