#!/usr/bin/env bash
# The binary interface is that of packaging/abi, and the check of it tells what programs feel: a field in a struct, a
# function that is gone. What they do not feel passes: test_abi.sh SOURCE BUILD
set -eu
source=$1 build=$2
unset LD_PRELOAD
bash "$source/packaging/abi.sh" soname "$build/src"
command -v abidiff >/dev/null || { echo "skipped: no abidiff (Debian: abigail-tools)"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

wants() { # EXIT STATUS, WHAT IS SAID, COMMAND...
    local status=0
    "${@:3}" >"$folder/log" 2>&1 || status=$?
    [ "$status" = "$1" ] && grep -q "$2" "$folder/log" || { cat "$folder/log"; echo "$* ends with $status"; exit 1; }
}

# ---- camber itself ----

abi() { bash "$source/packaging/abi.sh" "$@"; }
abi build "$build/abi" camber camber_map
wants 0 'libcamber-map: programs that have been linked with it go on' abi check "$build/abi/src" "$source/src"

# The same tree, but for a field in a struct.
rm -rf "$build/abi-tree"
mkdir "$build/abi-tree"
cp -r "$source"/{CMakeLists.txt,LICENSE,*.md,.ci,bench,docs,examples,kernels,shaders,src,packaging} "$build/abi-tree"
mkdir -p "$build/abi-tree/tests"
cp "$source/tests/lint.cmake" "$build/abi-tree/tests"
sed -i '0,/^typedef struct camber_paint {$/s//&\n    float broken;/' "$build/abi-tree/src/camber.h"
! cmp -s "$source/src/camber.h" "$build/abi-tree/src/camber.h"
bash "$build/abi-tree/packaging/abi.sh" build "$build/abi-broken" camber
cp "$build/abi/src/libcamber-map.so" "$build/abi-broken/src"
wants 1 "'float broken'" abi check "$build/abi-broken/src" "$build/abi-tree/src"

# ---- Small libraries ----

# A tree of their own: what is kept lies there, and whether there has been a release.
mkdir -p "$folder/tree/packaging"
cp "$source/packaging/abi.sh" "$folder/tree/packaging"
printf '## 0.1.0, unreleased\n' >"$folder/tree/CHANGELOG.md"
small() { bash "$folder/tree/packaging/abi.sh" "$1" "$folder/$2" "$folder/$2"; }
# make FOLDER FIELDS FUNCTIONS SONAME [FIELDS THAT THE HEADER DOES NOT SHOW]
make() {
    mkdir -p "$folder/$1"
    printf 'struct camber_thing;\nstruct camber_desc { int width; %s };\nint camber_draw(struct camber_thing *pen, const struct camber_desc *desc);\n' "$2" >"$folder/$1/camber.h"
    printf '#include "camber.h"\nstruct camber_thing { int size; %s };\n%s\n' "${5:-}" "$3" >"$folder/$1/camber.c"
    for library in libcamber libcamber-map; do
        cc -g -shared -fPIC -Wl,-soname,"$library.so.$4" -o "$folder/$1/$library.so" "$folder/$1/camber.c"
    done
}
draw='int camber_draw(struct camber_thing *pen, const struct camber_desc *desc) { return pen->size + desc->width; }'
old='int camber_old(void) { return 1; }'
make old 'int height;' "$draw $old" 0
wants 1 'nothing in packaging/abi' small check old
cp -r "$folder/old" "$folder/stripped"
strip "$folder"/stripped/*.so
wants 1 'debug information' small check stripped
wants 0 '' small write old
wants 0 'go on' small check old
make more 'int height;' "$draw $old int camber_new(void) { return 1; }" 0
wants 0 'go on' small check more
make hidden 'int height;' "$draw $old" 0 'int ink;'
wants 0 'go on' small check hidden
make field 'int height, depth;' "$draw $old" 0
wants 1 'what programs use has changed' small check field
make gone 'int height;' "$draw" 0
wants 1 'camber_old' small check gone
make next 'int height, depth;' "$draw" 1
wants 0 'another SONAME' small check next

# Before a release it is written down as it is; after one only with another SONAME.
wants 0 '' small write field
wants 0 'go on' small check field
printf '## 0.2.0, unreleased\n\n## 0.1.0, 2026-12-01\n' >"$folder/tree/CHANGELOG.md"
wants 1 'count camber_soversion up' small write old
wants 0 'go on' small check field
wants 0 'another SONAME' small write next
wants 0 'go on' small check next

# A file that cannot be read is no other SONAME.
echo broken >"$folder/tree/packaging/abi/libcamber.abi.gz"
wants 1 'not in gzip format' small check next
