#!/usr/bin/env bash
# A user of the wheel: installs it, uses all of it, and draws pictures that are compared with those of the build folder.
#
#   wheel.sh draw CAMBER TREE FOLDER     pictures by a tool, of the map of Monaco, of tiles and of GeoJSON, with labels
#   wheel.sh gdal                        afterwards, with GDAL in the system, draws what GDAL alone reads
#   wheel.sh use TREE                    installs TREE/dist/camber-*.whl, without a compiler, and uses all of it here
set -eux
action=$1
shift

draw() { # CAMBER TREE FOLDER
    local camber=$1 data=$2/tests/data
    mkdir -p "$3" && cd "$3"
    cat >streets.geojson <<'JSON'
{"type": "FeatureCollection", "features": [
{"type": "Feature", "properties": {"highway": "primary", "name": "Rue de l’Église"}, "geometry":
    {"type": "LineString", "coordinates": [[7.41, 43.73], [7.414, 43.7325], [7.4225, 43.733]]}},
{"type": "Feature", "properties": {"highway": "residential", "name": "Straße Łódź"}, "geometry":
    {"type": "LineString", "coordinates": [[7.412, 43.729], [7.4155, 43.7365]]}},
{"type": "Feature", "properties": {"natural": "water", "name": "Λίμνη"}, "geometry":
    {"type": "Polygon", "coordinates": [[[7.417, 43.7345], [7.4205, 43.7345], [7.4205, 43.737], [7.418, 43.7365], [7.417, 43.7345]]]}},
{"type": "Feature", "properties": {"place": "village", "name": "Озеро"}, "geometry": {"type": "Point", "coordinates": [7.4175, 43.7305]}}]}
JSON
    "$camber" render "$data/monaco/monaco.osm.pbf" --theme light --center 7.4235,43.7365 --zoom 15.1 --size 1000x640 -o monaco.png -f
    "$camber" render streets.geojson --theme dark --size 600x400 -o streets.png -f
    "$camber" render "$data/santa_cruz/osm.mbtiles" --size 600x400 -o tiles.png -f
}

use() { # TREE
    local tree=$1 package status=0
    python3 -m venv --system-site-packages env
    . env/bin/activate
    test -e "$tree"/dist/camber-*-manylinux_2_28_"$(uname -m)".whl # what docs/releasing.md promises
    pip -q install --no-index --disable-pip-version-check "$tree"/dist/camber-*.whl
    package=$(python -c 'import importlib.util, os; print(os.path.dirname(importlib.util.find_spec("camber").origin))')
    # Everything comes from the wheel but the C library.
    find "$package" -name '*.so*' ! -name 'camber-gdal-*' -exec ldd {} + >needed
    ldd "$package/bin/camber" >>needed
    if grep 'not found' needed; then exit 1; fi
    if grep -vE "^$package|^/home|=> $package|=> /lib/.*/lib(c|m|dl|rt|pthread)\.so|ld-linux|linux-vdso|statically linked" needed; then exit 1; fi
    test "$(ls "$package"/../camber-*.dist-info/licenses/*.txt | wc -l)" -gt 20
    test -s "$(echo "$package"/../camber-*.dist-info/licenses/OFL.txt)"
    camber --version
    camber info | tee info
    grep 'kernels compiled ahead' info
    local said=$PWD/said # what is bundled knows what the system configures
    draw camber "$tree" "$PWD/drawn" 2>"$said"
    cat "$said" >&2
    if grep -i fontconfig "$said"; then exit 1; fi
    camber render "$tree/tests/data/monaco/monaco.osm.pbf" --paper A5 -o monaco.pdf
    head -c 4 monaco.pdf | grep PDF
    camber tessellate streets.geojson --style roads -o streets.glb # areas need GLU, which needs GL
    test -s streets.glb
    camber tiles "$tree/tests/data/monaco/monaco.osm.pbf" --max-zoom 9 -o monaco.pmtiles
    camber tiles verify monaco.pmtiles
    # GDAL is not here: what it alone reads is refused, by name, and with what to do.
    echo '<gpx/>' >track.gpx
    camber render track.gpx -o track.png 2>log || status=$?
    test "$status" = 74
    grep 'camber: track.gpx: .*none of libgdal.so.32 to libgdal.so.40 can be loaded; install it' log
    python - "$tree" <<'PYTHON'
import sys, numpy, camber
t = numpy.linspace(0, 1, 200)
river = numpy.c_[40 + 520 * t, 150 + 60 * numpy.sin(6 * t)]
picture = camber.draw([river], width=24, color="#7ac", size=(600, 300), texts=[camber.Text.along(river, "Río", size=18)])
assert picture.shape == (300, 600, 4) and picture[..., 3].any()
assert camber.density([river], size=(64, 64)).counts.sum() > 0
city = camber.render(sys.argv[1] + "/tests/data/monaco/monaco.osm.pbf", center=(7.4235, 43.7365), zoom=15.1, size=(1000, 640))
assert city.shape == (640, 1000, 4) and len(numpy.unique(city.reshape(-1, 4), axis=0)) > 100
open("module.png", "wb").write(camber.encode(city, "png"))
PYTHON
    od -An -c -N4 module.png | grep 'P   N   G'
}

gdal() {
    . env/bin/activate
    cat >track.gpx <<'GPX'
<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg><trkpt lon="7.41" lat="43.73"/>
<trkpt lon="7.42" lat="43.735"/></trkseg></trk></gpx>
GPX
    camber render track.gpx -o track.png
    od -An -c -N4 track.png | grep 'P   N   G'
    camber info | grep 'GDAL  *GDAL 3'
    # GDAL brought the system's configuration of fontconfig.
    test -e /etc/fonts/fonts.conf
    camber render drawn/streets.geojson -o streets.png 2>said
    if grep -i fontconfig said; then exit 1; fi
}

"$action" "$@"
