#!/usr/bin/env bash
# The check of the binary interface tells a field that is new in a struct, and a function that is gone, and lets pass what
# programs do not feel: test_abi.sh SOURCE BUILD
set -eu
source=$1 build=$2
abi=$source/packaging/abi.sh
unset LD_PRELOAD
bash "$abi" soname "$build/src"
command -v abidiff >/dev/null || { echo "skipped: no abidiff (Debian: abigail-tools)"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export CAMBER_ABI=$folder/abi

# make FOLDER FIELDS FUNCTIONS SONAME
make() {
    mkdir -p "$folder/$1"
    printf 'struct camber_desc { int width; %s };\nint camber_draw(const struct camber_desc *desc);\n' "$2" >"$folder/$1/camber.h"
    printf '#include "camber.h"\n%s\n' "$3" >"$folder/$1/camber.c"
    for library in libcamber libcamber-map; do
        cc -g -shared -fPIC -Wl,-soname,"$library.so.$4" -o "$folder/$1/$library.so" "$folder/$1/camber.c"
    done
}
check() { bash "$abi" check "$folder/$1" "$folder/$1" >"$folder/log" 2>&1; }
wants() { # EXIT STATUS, FOLDER, WHAT IS SAID
    local status=0
    check "$2" || status=$?
    [ "$status" = "$1" ] && grep -q "$3" "$folder/log" || { cat "$folder/log"; echo "$2 ends with $status, not $1, or without: $3"; exit 1; }
}
draw='int camber_draw(const struct camber_desc *desc) { return desc->width; }'
make old 'int height;' "$draw int camber_old(void) { return 1; }" 0
wants 0 old 'no release'
cp -r "$folder/old" "$folder/stripped"
strip "$folder"/stripped/*.so
wants 1 stripped 'debug information'
bash "$abi" write "$folder/old" "$folder/old"
wants 0 old 'go on'
make more 'int height;' "$draw int camber_old(void) { return 1; } int camber_new(void) { return 1; }" 0
wants 0 more 'go on'
make field 'int height, depth;' "$draw int camber_old(void) { return 1; }" 0
wants 1 field 'count camber_soversion up'
make gone 'int height;' "$draw" 0
wants 1 gone 'camber_old'
make next 'int height, depth;' "$draw" 1
wants 0 next 'another SONAME'
