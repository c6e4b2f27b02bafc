#!/usr/bin/env bash
# Whether programs that were linked with the last release run with a build that is to be the next one.
#
#     abi.sh soname FOLDER           the names that programs keep, which must be those of packaging/debian
#     abi.sh build FOLDER TARGET...  builds libraries with debug information, which is what is looked at, into FOLDER/src
#     abi.sh check FOLDER HEADERS    what programs use of packaging/abi and the libraries of FOLDER have changed or lost
#     abi.sh write FOLDER HEADERS    writes packaging/abi anew, where nothing keeps programs from running that use a release
#
# HEADERS is the folder of the public headers, camber*.h; a type that they do not show is not looked at. libabigail
# compares. A change counts unless the SONAME is another.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
kept=$here/abi

soname() { objdump -p "$1" | awk '$1 == "SONAME" { print $2 }'; }

# The interface alone, and nothing of where and for which processor it was built.
describe() { # library
    abidw --headers-dir "$folder/headers" --drop-private-types --exported-interfaces-only --no-show-locs --no-corpus-path \
        --no-comp-dir-path --no-architecture --no-elf-needed "$1"
}

# A library's interface against what is kept: 1 where programs do not go on.
compare() { # library, its SONAME
    if [ ! -f "$kept/$1.abi.gz" ]; then
        echo "$1: nothing in packaging/abi to compare with: ./dev abi writes it"
        return 1
    fi
    gzip -dc "$kept/$1.abi.gz" >"$folder/old.abi" || return 1
    if ! grep -q "soname='$2'" "$folder/old.abi"; then
        echo "$1: $2 is another SONAME, so anything may differ"
    elif abidiff --no-added-syms "$folder/old.abi" "$folder/$1.abi"; then
        echo "$1: programs that have been linked with it go on"
    else
        echo "$1: what programs use has changed"
        return 1
    fi
}

[ $# -ge 2 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
case $1 in soname | build) ;; *) command -v abidiff >/dev/null || { echo "skipped: no abidiff (Debian: abigail-tools)"; exit 77; } ;; esac
if [ "$1" = build ]; then
    cmake -S "$here/.." -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCAMBER_TESTS=OFF -DCAMBER_WARM=OFF >"$2.log" 2>&1 &&
        ninja -C "$2" "${@:3}" >>"$2.log" 2>&1 || { tail -n 20 "$2.log"; exit 1; }
    exit
fi
status=0
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
[ "$1" = soname ] || { mkdir "$folder/headers" && cp "$3"/camber*.h "$folder/headers"; }
for library in libcamber libcamber-map; do
    name=$(soname "$2/$library.so")
    if [ "$1" = soname ]; then
        package=$library${name##*.so.}
        grep -qx "Package: $package" "$here/debian/control" || { echo "$name: no $package in packaging/debian/control"; status=1; }
        continue
    fi
    describe "$2/$library.so" >"$folder/$library.abi"
    grep -q "<function-decl name='camber_" "$folder/$library.abi" ||
        { echo "$library: no function of camber with its types: build with debug information"; exit 1; }
    compare "$library" "$name" || status=1
done
if [ $status = 1 ] && [ "$1" = check ]; then
    echo "meant so? before the first release ./dev abi writes it down; later camber_soversion is counted up: docs/releasing.md"
elif [ "$1" = write ]; then
    if [ $status = 1 ] && grep -qE '^## [0-9.]+, [0-9]{4}-' "$here/../CHANGELOG.md"; then
        echo "programs use a release: count camber_soversion up, see docs/releasing.md"
        exit 1
    fi
    mkdir -p "$kept"
    for library in libcamber libcamber-map; do gzip -9n <"$folder/$library.abi" >"$kept/$library.abi.gz"; done
    status=0
fi
exit $status
