#!/usr/bin/env bash
# The examples, built without a warning against the installed tree, and run: nothing is compiled for them. And README.md
# quotes the first one: test_examples.sh SOURCE BUILD MAP [OUT]
# The pictures that they draw stay in OUT.
set -eu
source=$1
build=$2
map=$3
folder=$(mktemp -d)
out=${4:-$folder/pictures}
mkdir -p "$out"
unset LD_PRELOAD CAMBER_KERNELS POCL_WORK_GROUP_SPECIALIZATION # what is installed brings its kernels
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$folder"' EXIT
# Another test installs from the same folder; its list of files is put back.
manifest=$build/install_manifest.txt
[ ! -f "$manifest" ] || cp "$manifest" "$folder/manifest"
cmake --install "$build" --prefix "$folder/usr" >"$folder/log" || { cat "$folder/log"; exit 1; }
rm -f "$manifest"
[ ! -f "$folder/manifest" ] || mv "$folder/manifest" "$manifest"

cmake -S "$source/examples" -B "$folder/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/usr" -DCMAKE_C_FLAGS=-Werror \
    >"$folder/log" 2>&1 && cmake --build "$folder/build" >>"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
for file in "$source"/examples/*.c; do
    most=100
    case ${file##*/} in
    streets.c) most=140 ;; # lines, text, and where it has room
    viewer.c) most=850 ;;  # a whole program
    esac
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

# A first run finds all kernels installed. In its cache PoCL would have program.bc of each program that it compiles, and
# kernels for work-groups of one size.
mkdir "$folder/cache" "$folder/pocl"
export XDG_CACHE_HOME=$folder/cache POCL_CACHE_DIR=$folder/pocl
expect_none_compiled() { # WHO
    [ -e "$build/src/camber-kernels.stamp" ] || return 0 # this build compiles none ahead
    local compiled
    compiled=$(find "$POCL_CACHE_DIR" -name program.bc -o -name '*.so' ! -path '*/0-0-0/*')
    [ -z "$compiled" ] || { echo "compiled for $1:"; echo "$compiled"; exit 1; }
}
# The same as another user, if root runs this test.
as_nobody() { setpriv --reuid=65534 --clear-groups "$@"; }
run_as_nobody() {
    mkdir "$folder/theirs" && cp "$source/tests/data/santa_cruz/osm.mbtiles" "$folder/theirs"
    chmod 755 "$folder" && chown -R 65534 "$folder/theirs" && cd "$folder/theirs"
    as_nobody test -x "$folder/build/hello" || { echo "skipped: another user, who cannot read $folder"; return 0; }
    local -x XDG_CACHE_HOME=$folder/theirs/cache POCL_CACHE_DIR=$folder/theirs
    as_nobody "$folder/build/hello"
    expect_none_compiled "another user's hello"
    [ "$map" != ON ] || as_nobody "$folder/build/map" osm.mbtiles
    expect_none_compiled "another user's map"
}
[ "$(id -u)" != 0 ] || ! as_nobody true 2>/dev/null || run_as_nobody
cd "$out"
"$folder/build/hello"
expect_none_compiled hello
"$folder/build/validate"
[ "$map" != ON ] || "$folder/build/map" "$source/tests/data/santa_cruz/osm.mbtiles"
[ "$map" != ON ] || [ "$("$folder/build/streets")" = "10 of 10 streets have their names" ]
status=0
[ "$map" != ON ] || "$folder/build/poster" "$source/tests/data/santa_cruz/osm.mbtiles" || status=$?
[ "$map" != ON ] || [ "$status" = 77 ] || [ "$status" = 0 ] && [ "$(head -c 5 poster.pdf)" = %PDF- ] || exit 1
expect_none_compiled "validate, map, poster and streets"

# A tile from the example's own server, at the first port that is free.
ask_for_tile() {
    local port=$((20000 + RANDOM % 12000))
    while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
    "$folder/build/tiles" "$source/tests/data/santa_cruz/osm.mbtiles" "$port" &
    server=$!
    until (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do
        kill -0 $server 2>/dev/null || { echo "the example tiles does not start"; exit 1; }
        sleep 0.1
    done
    # A second one finds the port taken, and says so.
    local status=0 said
    said=$("$folder/build/tiles" "$source/tests/data/santa_cruz/osm.mbtiles" "$port" 2>&1) || status=$?
    [ "$status" = 1 ] && [ "$said" = "tiles: port $port: Address already in use" ] || {
        echo "the example tiles, where its port is taken: status $status, '$said'"
        exit 1
    }
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
expect_none_compiled "tiles, viewer and texture"
ls -l
