#!/bin/sh
# A pyramid by Debian's renderd and render_list: renderd_tiles.sh FOLDER MAP.xml FORMAT <<LINES of ZOOM LEFT RIGHT TOP BOTTOM
# Two threads draw what two threads ask for, into metatiles below FOLDER. The pyramid is drawn once to warm up, and
# again. Prints a line of JSON: the second time's milliseconds from the first zoom to the last, with a renderd that is
# up, and those of its processors' time. Exit status 77: it is not here, or does not start.
set -eu
folder=$1 xml=$2 format=$3
command -v renderd >/dev/null && command -v render_list >/dev/null || exit 77
for plugins in /usr/lib/mapnik/*/input /usr/lib/*/mapnik/*/input; do [ ! -d "$plugins" ] || break; done
cat >"$folder/renderd.conf" <<CONF
[renderd]
socketname=$folder/renderd.sock
stats_file=$folder/renderd.stats
pid_file=$folder/renderd.pid
num_threads=2
tile_dir=$folder/metatiles
[mapnik]
plugins_dir=$plugins
font_dir=/usr/share/fonts
font_dir_recurse=false
[lines]
URI=/lines/
XML=$xml
TYPE=png image/png $format
MAXZOOM=20
CONF
rm -rf "$folder/metatiles"
mkdir "$folder/metatiles"
renderd -f -c "$folder/renderd.conf" >"$folder/renderd.log" 2>&1 &
server=$!
trap 'kill -9 $server; rm -rf "$folder/metatiles"' EXIT
tries=0
until [ -S "$folder/renderd.sock" ]; do
    tries=$((tries + 1))
    [ $tries -lt 100 ] || exit 77
    sleep 0.05
done
ticks() {
    sed 's/.*) //' "/proc/$server/stat" | { read -r _ _ _ _ _ _ _ _ _ _ _ user system _ && echo $((user + system)); }
}
draw() {
    while read -r zoom left right top bottom; do
        render_list -a -f -m lines -s "$folder/renderd.sock" -t "$folder/metatiles" -n 2 -l 99 -z "$zoom" -Z "$zoom" \
            -x "$left" -X "$right" -y "$top" -Y "$bottom" >>"$folder/renderd.log" 2>&1
    done <"$folder/ranges"
}
cat >"$folder/ranges"
draw
used=$(ticks)
begin=$(date +%s%N)
draw
end=$(date +%s%N)
used=$((($(ticks) - used) * 1000 / $(getconf CLK_TCK)))
drawn=$(find "$folder/metatiles" -name '*.meta' | wc -l)
[ "$drawn" -gt 0 ] || exit 1
echo "{\"ms\": $(((end - begin) / 1000000)), \"cpu_ms\": $used, \"metatiles\": $drawn, \"version\": \"$(dpkg-query -W -f '${Version}' renderd 2>/dev/null)\"}"
