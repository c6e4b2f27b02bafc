#!/usr/bin/env bash
# The examples, built without a warning against the installed tree, and run; and README.md quotes the first one:
# test_examples.sh SOURCE BUILD MAP [OUT]
# The pictures that they draw stay in OUT.
set -eu
source=$1
build=$2
map=$3
folder=$(mktemp -d)
out=${4:-$folder/pictures}
mkdir -p "$out"
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$folder"' EXIT
# Another test installs from the same folder; its list of files is put back.
manifest=$build/install_manifest.txt
[ ! -f "$manifest" ] || cp "$manifest" "$folder/manifest"
cmake --install "$build" --prefix "$folder/usr" >"$folder/log" || { cat "$folder/log"; exit 1; }
rm -f "$manifest"
[ ! -f "$folder/manifest" ] || mv "$folder/manifest" "$manifest"
unset LD_PRELOAD

cmake -S "$source/examples" -B "$folder/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/usr" -DCMAKE_C_FLAGS=-Werror \
    >"$folder/log" 2>&1 && cmake --build "$folder/build" >>"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
for file in "$source"/examples/*.c; do
    most=100
    [ "${file##*/}" != viewer.c ] || most=850 # a whole program
    [ "$(wc -l <"$file")" -le "$most" ] || { echo "$file is too long for an example"; exit 1; }
done

# README.md quotes what stands in the file between its marks.
marked=$(sed -n '/^\/\* README begins \*\/$/,/^\/\* README ends \*\/$/p' "$source/examples/hello.c" | sed '1d;$d')
quoted=$(sed -n '/^<!-- examples\/hello\.c -->$/,/^<!-- end -->$/p' "$source/README.md" | sed '1,2d' | sed '$d' | sed '$d')
if grep -q 'examples/hello\.c' "$source/README.md"; then
    [ -n "$marked" ] && [ "$marked" = "$quoted" ] || {
        diff <(echo "$marked") <(echo "$quoted")
        echo "README.md does not quote examples/hello.c between <!-- examples/hello.c --> and <!-- end -->"
        exit 1
    }
fi

if "$folder/usr/bin/camber" info | grep -q '^device *none'; then
    echo "built, not run: no OpenCL device"
    exit 77
fi
cd "$out"
"$folder/build/hello"
"$folder/build/validate"
[ "$map" != ON ] || "$folder/build/map" "$source/tests/data/santa_cruz/osm.mbtiles"

# A tile from the example's own server.
ask_for_tile() {
    local port=$((20000 + RANDOM % 12000))
    "$folder/build/tiles" "$source/tests/data/santa_cruz/osm.mbtiles" "$port" &
    server=$!
    for _ in $(seq 300); do
        ! (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || break
        sleep 0.1
    done
    exec 3<>"/dev/tcp/127.0.0.1/$port"
    printf 'GET /12/659/1593.png HTTP/1.0\r\n\r\n' >&3
    cat <&3 >tile.http
    exec 3>&-
    kill "$server"
    wait "$server" || true
    server=
    head -n 1 tile.http | grep -q '200 OK' && grep -q IEND tile.http || { echo "the example tiles gives no tile"; exit 1; }
}
[ "$map" != ON ] || ask_for_tile
[ ! -x "$folder/build/viewer" ] || SDL_VIDEODRIVER=dummy "$folder/build/viewer" --draw cl --benchmark --frames 20 \
    "$source/tests/data/santa_cruz/osm.mbtiles"
status=0
[ ! -x "$folder/build/texture" ] || "$folder/build/texture" || status=$?
[ "$status" = 0 ] || [ "$status" = 77 ] || exit "$status"
ls -l
