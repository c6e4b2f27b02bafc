#!/usr/bin/env bash
# Whether programs that were linked with the last release run with a build that is to be the next one.
#
#     abi.sh soname FOLDER           the names that programs keep, which must be those of packaging/debian
#     abi.sh write FOLDER HEADERS    writes down what a release has: packaging/abi/*.abi.xz
#     abi.sh check FOLDER HEADERS    what that has and the build has changed or lost, as libabigail finds it
#
# FOLDER has libcamber.so and libcamber-map.so with debug information; HEADERS is the folder of their headers. A change
# counts unless the SONAME is another. CAMBER_ABI names another folder than packaging/abi.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
kept=${CAMBER_ABI:-$here/abi}

soname() { objdump -p "$1" | awk '$1 == "SONAME" { print $2 }'; }
# The interface alone: no type that the headers do not show, and nothing of where it was built.
describe() { # library, folder of the headers
    abidw --headers-dir "$2" --drop-private-types --no-corpus-path --no-comp-dir-path --no-show-locs "$1"
}

[ $# -ge 2 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
[ "$1" = soname ] || command -v abidiff >/dev/null || { echo "skipped: no abidiff (Debian: abigail-tools)"; exit 77; }
status=0
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$kept"
for library in libcamber libcamber-map; do
    built=$2/$library.so
    name=$(soname "$built")
    case $1 in
    soname)
        package=$library${name##*.so.}
        grep -qx "Package: $package" "$here/debian/control" || { echo "$name: no $package in packaging/debian/control"; status=1; }
        ;;
    write)
        describe "$built" "$3" | xz -9 >"$kept/$library.abi.xz"
        ;;
    check)
        describe "$built" "$3" >"$folder/new.abi"
        functions=$(grep -c "<function-decl name='camber_" "$folder/new.abi" || true)
        if [ "$functions" = 0 ]; then
            echo "$library: no function of camber with its types: build with debug information"
            status=1
            continue
        elif [ ! -f "$kept/$library.abi.xz" ]; then
            echo "$library: no release has been written down yet: $functions functions, compared with nothing"
            continue
        fi
        xz -dc "$kept/$library.abi.xz" >"$folder/old.abi"
        if ! grep -q "soname='$name'" "$folder/old.abi"; then
            echo "$library: $name is another SONAME, so anything may differ"
        elif abidiff --no-added-syms "$folder/old.abi" "$folder/new.abi"; then
            echo "$library: programs that have been linked with it go on"
        else
            echo "$library: what programs use has changed: count camber_soversion up, see docs/releasing.md"
            status=1
        fi
        ;;
    esac
done
rmdir "$kept" 2>/dev/null || true
exit $status
