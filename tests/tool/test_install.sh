#!/usr/bin/env bash
# A ten-line program against the installed tree, through pkg-config and through CMake; then all of it is uninstalled:
# test_install.sh SOURCE BUILD MAP
set -eu
source=$1
build=$2
map=$3
folder=$(mktemp -d)
unset CAMBER_KERNELS LD_PRELOAD # what is installed brings its kernels
manifest=$build/install_manifest.txt
[ ! -f "$manifest" ] || mv "$manifest" "$folder/manifest"
# Whoever has installed from this folder wants to uninstall that.
trap 'rm -f "$manifest"; [ ! -f "$folder/manifest" ] || mv "$folder/manifest" "$manifest"; rm -rf "$folder"' EXIT
cmake --install "$build" --prefix "$folder/usr" >"$folder/log" || { cat "$folder/log"; exit 1; }
cp -a "$folder/usr" "$folder/installed"
for file in LICENSE README.md CHANGELOG.md docs/glossary.md; do
    cmp "$source/$file" "$folder/usr/share/doc/camber/$file"
done
# Man pages: a verb's own has all options that camber.1 has in the verb's section, and a page of the library its headers.
for verb in tiles serve; do
    page=$folder/usr/share/man/man1/camber-$verb.1
    [ "$map" = ON ] && [ -e "$page" ] || continue
    grep -q "^\.B camber $verb\$" "$page" && [ "$(grep -c '^\.BR \\-\\-' "$page")" -gt 5 ]
    diff <(sed -n "/^\.SS $(case $verb in tiles) echo Tiles ;; *) echo Serving ;; esac)\$/,/^\.S[SH]/p" "$source/src/cli/camber.1" | grep '^\.BR \\-') \
        <(sed -n '/^\.SH OPTIONS/,/^\.PP$/p' "$page" | grep '^\.BR \\-')
done
for header in "$source"/src/camber*.h; do
    grep -q "^\.B $(basename "$header")\$" "$folder/usr/share/man/man3/camber.3"
done
# Completion, where the shells look for it.
bash -n "$folder/usr/share/bash-completion/completions/camber"
grep -qx '#compdef camber' "$folder/usr/share/zsh/site-functions/_camber"
grep -q "^complete -c camber -n .__camber_in render. -l output" "$folder/usr/share/fish/vendor_completions.d/camber.fish"

cat >"$folder/core.c" <<'C'
#include <camber_proof.h>
#include <stdio.h>
int main(void) {
    const float points[] = {10, 10, 90, 10, 90, 90};
    const uint32_t offsets[] = {0, 3};
    const camber_stroke stroke = {.width_px = 8};
    camber_context *context;
    camber_polylines *lines;
    camber_mesh_data mesh;
    if (camber_context_create(NULL, &context) != CAMBER_OK ||
        camber_polylines_create(context, &(camber_polylines_desc){points, 3, offsets, 1, NULL, false}, &lines) != CAMBER_OK ||
        camber_mesh_data_tessellate(context, lines, &(camber_tessellation_desc){&stroke, 1, CAMBER_METHOD_STRIP, 0}, &mesh))
        return 1;
    printf("%s: %zu vertices\n", camber_version(), mesh.info.vertex_count);
    return mesh.info.vertex_count == 6 ? 0 : 1;
}
C
cat >"$folder/map.c" <<'C'
#include <camber_map.h>
int main(void) {
    camber_context *context;
    camber_style *style;
    if (camber_context_create(NULL, &context) != CAMBER_OK ||
        camber_style_create_builtin(context, CAMBER_THEME_DARK, &style) != CAMBER_OK)
        return 1;
    camber_style_destroy(style);
    camber_context_destroy(context);
    return 0;
}
C
# Uninstalled is all of it, but nothing of anyone else's. As the target does it: in a folder that is being tested CMake
# is not to run again.
uninstall() { cmake -DMANIFEST="$manifest" -P "$source/src/uninstall.cmake" >"$folder/log" 2>&1; }
ninja -C "$build" -t query uninstall >/dev/null
mkdir -p "$folder/usr/share/camber"
touch "$folder/usr/share/camber/mine.json"
uninstall || { cat "$folder/log"; exit 1; }
left=$(cd "$folder/usr" && find . ! -type d -o -name '*camber*' | sort | xargs)
[ "$left" = "./share/camber ./share/camber/mine.json" ] || { echo "left behind: $left"; exit 1; }
! uninstall || { echo "uninstalled twice"; exit 1; }
export DESTDIR=$folder/stage
cmake --install "$build" --prefix /usr >"$folder/log" || { cat "$folder/log"; exit 1; }
"$DESTDIR/usr/bin/camber" --version
uninstall || { cat "$folder/log"; exit 1; }
left=$(cd "$DESTDIR" && find . ! -type d -o -name '*camber*')
[ -z "$left" ] || { echo "left behind: $left"; exit 1; }
unset DESTDIR
rm -r "${folder:?}/usr"
mv "$folder/installed" "$folder/usr"

programs=core
[ "$map" = ON ] && programs="core map"
libdir=$(dirname "$(find "$folder/usr" -name libcamber.so | head -n 1)")
export PKG_CONFIG_PATH=$libdir/pkgconfig LD_LIBRARY_PATH=$libdir

for program in $programs; do
    package=camber
    [ "$program" = map ] && package=camber-map
    # shellcheck disable=SC2046
    ${CC:-cc} -std=c11 -Wall -Werror $(pkg-config --cflags "$package") "$folder/$program.c" -o "$folder/$program" \
        $(pkg-config --libs "$package")
    "$folder/$program"
done

cat >"$folder/CMakeLists.txt" <<C
cmake_minimum_required(VERSION 3.22)
project(consumer C)
find_package(camber REQUIRED)
add_executable(core_shared core.c)
target_link_libraries(core_shared camber::camber)
add_executable(core_static core.c)
target_link_libraries(core_static camber::camber_static)
if($map)
  find_package(camber-map REQUIRED)
  add_executable(map_shared map.c)
  target_link_libraries(map_shared camber::camber_map)
  add_executable(map_static map.c)
  target_link_libraries(map_static camber::camber_map_static)
endif()
C
cmake -S "$folder" -B "$folder/consumer" -G Ninja -DCMAKE_PREFIX_PATH="$folder/usr" >"$folder/log" 2>&1 &&
    cmake --build "$folder/consumer" >>"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
for program in $programs; do
    "$folder/consumer/${program}_shared"
    "$folder/consumer/${program}_static"
done

# Nothing but the public names leaves the libraries.
for library in "$libdir"/libcamber*.so "$libdir"/camber/*.so; do
    [ -e "$library" ] || continue # no module in a build without maps
    if nm -D --defined-only "$library" | awk '{print $3}' | grep -vE '^(camber_|__bss_start|_edata|_end)'; then
        echo "$library exports more than camber_*"
        exit 1
    fi
done
exported=$(nm -D --defined-only "$libdir/libcamber.so" | awk '{print $3}' | grep '^camber_' | sort)
declared=$(grep -ohE '^CAMBER_API [^(]*\(' "$folder"/usr/include/camber.h "$folder"/usr/include/camber_files.h "$folder"/usr/include/camber_network.h "$folder"/usr/include/camber_proof.h | grep -oE 'camber_[a-z_]+\($' | tr -d '(' | sort)
[ "$exported" = "$declared" ] || { diff <(echo "$exported") <(echo "$declared"); echo "exports and the headers differ"; exit 1; }
"$folder/usr/bin/camber" --version
if [ "$map" != ON ]; then
    status=0
    "$folder/usr/bin/camber" render line.geojson -o line.png 2>"$folder/log" || status=$?
    [ "$status" = 2 ] && grep -q 'this build has no map (CAMBER_MAP=OFF)' "$folder/log" && exit 0
    cat "$folder/log"
    echo "render in a build without maps: status $status"
    exit 1
fi
for style in city-light city-dark roads-light roads-dark openmaptiles-light openmaptiles-dark transit-light transit-dark; do
    "$folder/usr/bin/camber" style check "$folder/usr/share/camber/styles/$style.json"
done
for job in slurm.sh batch.sh mpirun.sh job.yaml batch.json; do
    [ -r "$folder/usr/share/camber/cluster/$job" ] || { echo "not installed: cluster/$job"; exit 1; }
done
# If there is a server, all of its files are there.
for file in $([ ! -d "$folder/usr/share/camber/serve" ] || ls "$source/examples/serve"); do
    cmp "$source/examples/serve/$file" "$folder/usr/share/camber/serve/$file"
done
# The recipe of docs/styles.md works as it stands there, for New York.
city=${CAMBER_DATA:-}/data/nyc.osm.pbf
if [ -f "$city" ] && [ -x /usr/bin/tilemaker ] && command -v osmium >/dev/null && command -v python3 >/dev/null; then
    mkdir "$folder/styles"
    ln -s "$city" "$folder/styles/city.osm.pbf"
    sed -n '/^    examples=/,/^$/s/^    //p' "$source/docs/styles.md" >"$folder/styles/recipe"
    (cd "$folder/styles" && PATH=$folder/usr/bin:$PATH bash -eu recipe) >"$folder/log" 2>&1 &&
        [ "$(head -c 4 "$folder/styles/lines.png")" = "$(head -c 4 "$source/tests/data/styles/transit.png")" ] &&
        ! grep -q 'nothing\|no line' "$folder/log" || { cat "$folder/log"; echo "docs/styles.md does not work"; exit 1; }
fi
# GDAL comes with the first file, and what is wrong where it cannot come is one line.
if ldd "$folder/usr/bin/camber" | grep libgdal; then echo "the tool links GDAL from the start"; exit 1; fi
echo '{"type":"LineString","coordinates":[[0,0],[1,1]]}' >"$folder/line.geojson"
mkdir "$folder/pocl"
XDG_CACHE_HOME=$folder/cache POCL_CACHE_DIR=$folder/pocl env -u POCL_WORK_GROUP_SPECIALIZATION \
    "$folder/usr/bin/camber" tessellate -v "$folder/line.geojson" -o "$folder/line.glb" 2>"$folder/log" || { cat "$folder/log"; exit 1; }
if [ -n "$(find "$libdir/camber-kernels" -name '*.bin' 2>/dev/null)" ]; then # not where there is no device
    if grep 'built in' "$folder/log"; then echo "the installed kernels are not used"; exit 1; fi
    grep -q 'kernels of .*: from the cache' "$folder/log" || { cat "$folder/log"; exit 1; }
fi
rm "$libdir"/camber/camber-gdal.so.*
# Without it camber reads GeoJSON itself, to the same mesh. What GDAL alone can do fails, in one line that names the file.
"$folder/usr/bin/camber" tessellate -q "$folder/line.geojson" -o "$folder/none.glb" && cmp "$folder/line.glb" "$folder/none.glb"
echo '<gpx/>' >"$folder/track.gpx"
for file in track.gpx "line.geojson --where a=1"; do
    status=0
    # shellcheck disable=SC2086 # a file and options
    "$folder/usr/bin/camber" tessellate -q "$folder/"$file -o "$folder/refused.glb" 2>"$folder/log" || status=$?
    [ "$status" = 74 ] && [ "$(wc -l <"$folder/log")" = 1 ] && grep -q "${file%% *}: .*GDAL cannot be loaded.*; install it" "$folder/log" ||
        { cat "$folder/log"; echo "without its module: $file: status $status"; exit 1; }
done
