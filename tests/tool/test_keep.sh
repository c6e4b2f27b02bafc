#!/usr/bin/env bash
# src/gpu/cpu/keep.sh compiles an object again if the text, the words or the compiler are others, and only then:
# test_keep.sh SOURCE. The compiler is a script that counts.
set -eu
keep=$1/src/gpu/cpu/keep.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export CCACHE_DIR=$work/cache
unset CCACHE_READONLY CCACHE_UMASK

# Preprocesses as a compiler does that includes header.h into all; an object has the text and what the compiler was told.
cat >compiler <<'COMPILER'
#!/usr/bin/env bash
while [ $# -gt 0 ]; do
    case $1 in
    --version) echo "version $(cat version)"; exit ;;
    -o) out=$2; shift ;;
    -MF) echo "made: source header.h" >"$2"; shift ;;
    -MT) shift ;;
    -E) preprocesses=1 ;;
    -O*) told+=$1 ;;
    source) ;;
    esac
    shift
done
! grep -q error source || exit 3
cat source header.h >"$out"
[ -n "${preprocesses:-}" ] || { echo "$told $(cat version)" >>"$out"; echo >>compiled; }
COMPILER
chmod +x compiler
echo 1 >version
echo text >source
echo more >header.h

expect() { # COMPILATIONS UNTIL NOW, WHAT, ARGUMENT...
    local count=$1 what=$2
    shift 2
    rm -f object object.d
    sh "$keep" source object "$work/compiler" "$@"
    [ "$(wc -l <compiled)" = "$count" ] || { echo "FAILED: $what: compiled $(wc -l <compiled) times, not $count"; exit 1; }
    [ "$(cat object)" = "$(cat source header.h && echo "$1 $(cat version)")" ] || { echo "FAILED: $what: another object"; exit 1; }
    [ -s object.d ] || { echo "FAILED: $what: ninja is not told of headers"; exit 1; }
}

expect 1 "the first time" -O2 -I/here
expect 1 "the same" -O2 -I/there
expect 2 "other words" -O3 -I/here
echo other >header.h
expect 3 "another header" -O2
echo more >header.h
expect 3 "the header as it was" -O2
echo 2 >version
expect 4 "another compiler" -O2
echo text2 >source
export CCACHE_READONLY=1
expect 5 "a cache that is only read" -O2
expect 6 "nothing was kept" -O2
unset CCACHE_READONLY
export CCACHE_DIR=$work/compiler # no folder
expect 7 "no place for a cache" -O2
export CCACHE_DIR=$work/cache
mkdir bin
ln -s /bin/false bin/find
ln -s /bin/false bin/mv
PATH=$work/bin:$PATH expect 8 "a cache in which another build, or user, is at work" -O2
expect 9 "nothing was moved there" -O2
expect 9 "and then it was" -O2
echo error >source
if sh "$keep" source object "$work/compiler" -O2; then
    echo "FAILED: a text that does not compile"
    exit 1
fi
echo "9 compilations"
