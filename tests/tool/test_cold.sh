#!/bin/bash
# Kernels that a run compiles: with empty caches, with its own, with those that the machine's users share, and thirty runs at
# once. test_cold.sh TOOL CITY
# PoCL's cache tells: a folder with program.bc is a program that was compiled, a .so in it a kernel. In a folder without
# one are the kernels of a binary that was loaded.
set -u
tool=$(realpath "$1")
city=$(realpath "$2")
tmp=$(mktemp -d) || exit 1
trap 'umount "$tmp/mounted" 2>/dev/null; rm -rf "$tmp"' EXIT
chmod 755 "$tmp"
export CAMBER_KERNELS= XDG_CACHE_HOME=$tmp/cache POCL_CACHE_DIR=$tmp/pocl
unset CAMBER_COMPILATIONS LD_PRELOAD POCL_WORK_GROUP_SPECIALIZATION # users do not know of it
failures=0

fail() {
    failures=$((failures + 1))
    echo "FAILED: $*"
}

empty() { # the caches, or others
    rm -rf "$XDG_CACHE_HOME" "$POCL_CACHE_DIR"
    mkdir -p "$XDG_CACHE_HOME" "$POCL_CACHE_DIR"
}

draw() { # OUT: what it says is in OUT.log
    "$tool" render "$city" -vfo "$1" --size 640x480 --draw cl 2>"$1.log" </dev/null
}

built() { # LOG...: how many programs these runs compiled
    cat "$@" | grep -c '^camber: info: kernels of .*: built in'
}

compiled() { # what PoCL compiled: programs and kernels
    local folders kernels=0
    mapfile -t folders < <(find "$POCL_CACHE_DIR" -name program.bc -printf '%h\n')
    [ ${#folders[@]} = 0 ] || kernels=$(find "${folders[@]}" -name '*.so' | wc -l)
    echo "${#folders[@]} programs, $kernels kernels"
}

has_pocl() { "$tool" info --json 2>/dev/null | grep -q '"platform": "Portable Computing Language"'; }
has_pocl || { echo "no PoCL: skipped"; exit 77; }

# ---- One run after the other ----

empty
draw "$tmp/cold.png" || fail "cold: $(cat "$tmp/cold.png.log")"
[ "$(built "$tmp/cold.png.log")" = 3 ] || fail "cold: compiles $(built "$tmp/cold.png.log") programs, not 3"
[ "$(compiled)" = "3 programs, 11 kernels" ] || fail "cold: $(compiled)"
[ -z "$(find "$POCL_CACHE_DIR" -name '*.so' ! -path '*/0-0-0/*')" ] || fail "a kernel is built for one size of work-groups"
draw "$tmp/warm.png" || fail "warm: $(cat "$tmp/warm.png.log")"
[ "$(built "$tmp/warm.png.log")" = 0 ] || fail "warm: compiles $(built "$tmp/warm.png.log") programs"
[ "$(compiled)" = "3 programs, 11 kernels" ] || fail "warm: $(compiled)"
cmp "$tmp/cold.png" "$tmp/warm.png" || fail "warm: another picture"

# ---- Thirty at once ----

empty
for run in $(seq 30); do
    draw "$tmp/$run.png" &
    runs[run]=$!
done
for run in $(seq 30); do
    wait "${runs[run]}" || fail "run $run of thirty: $(cat "$tmp/$run.png.log")"
    cmp -s "$tmp/cold.png" "$tmp/$run.png" || fail "run $run of thirty: another picture"
done
[ "$(built "$tmp"/[0-9]*.png.log)" = 3 ] || fail "thirty at once compile $(built "$tmp"/[0-9]*.png.log) programs, not 3"
[ "$(compiled)" = "3 programs, 11 kernels" ] || fail "thirty at once: $(compiled)"

# ---- Kernels that all users share ----

# A file whose bytes are right is used from there, and one that others could have written is not.
shares() { # WHAT COUNT: a run with empty caches of its own compiles so many programs
    empty
    draw "$tmp/shared.png" || fail "$1: $(cat "$tmp/shared.png.log")"
    [ "$(built "$tmp/shared.png.log")" = "$2" ] || fail "$1: compiles $(built "$tmp/shared.png.log") programs, not $2"
    cmp -s "$tmp/cold.png" "$tmp/shared.png" || fail "$1: another picture"
}
mkdir -m 755 "$tmp/shared"
cp "$XDG_CACHE_HOME"/camber/kernels-*.bin "$tmp/shared/"
chmod 644 "$tmp/shared"/*
export CAMBER_KERNELS=$tmp/shared
shares "shared" 0
[ "$(compiled)" = "0 programs, 0 kernels" ] || fail "shared: $(compiled)"
chmod 664 "$tmp/shared"/*
shares "files that the group may write" 3
chmod 644 "$tmp/shared"/* && chmod 777 "$tmp/shared"
shares "a folder that all may write" 3
chmod 755 "$tmp/shared"
for file in "$tmp/shared"/*; do
    mv "$file" "$tmp/kept.bin" && ln -s "$tmp/kept.bin" "$file"
    break
done
shares "a link in place of a file" 1
mv "$tmp/kept.bin" "$file"
if [ "$(id -u)" = 0 ] && setpriv --reuid=65534 --clear-groups true 2>/dev/null; then
    chown 65534 "$tmp/shared"/*
    shares "files of another user's" 3
    chown 0 "$tmp/shared"/*
    mkdir -m 700 "$tmp/theirs" && chown 65534 "$tmp/theirs"
    if setpriv --reuid=65534 --clear-groups "$tool" --version >"$tmp/version" 2>&1; then
        XDG_CACHE_HOME=$tmp/theirs POCL_CACHE_DIR=$tmp/theirs/pocl setpriv --reuid=65534 --clear-groups \
            "$tool" render - -vo - --size 640x480 --draw cl <"$city" 2>"$tmp/theirs.log" >"$tmp/theirs.png" ||
            fail "root's kernels, another user: $(cat "$tmp/theirs.log")"
        [ "$(built "$tmp/theirs.log")" = 0 ] || fail "root's kernels, another user: compiles $(built "$tmp/theirs.log")"
    else
        echo "skipped: root's kernels, another user: who cannot run $tool"
    fi
fi

# ---- Ahead ----

empty
export CAMBER_KERNELS=$tmp/none/at/all
"$tool" info --warm --json >"$tmp/warm.json" 2>"$tmp/warm.log" || fail "info --warm: $(cat "$tmp/warm.log")"
grep -q "\"folder\": \"$XDG_CACHE_HOME/camber\"" "$tmp/warm.json" || fail "info --warm: not in the user's cache: $(cat "$tmp/warm.json")"
programs=$(sed -n 's/^  "programs": \([0-9]*\),*/\1/p' "$tmp/warm.json")
[ "$(find "$XDG_CACHE_HOME/camber" -name 'kernels-*.bin' | wc -l)" = "$programs" ] || fail "info --warm: not $programs files"
draw "$tmp/ahead.png" || fail "after info --warm: $(cat "$tmp/ahead.png.log")"
[ "$(built "$tmp/ahead.png.log")" = 0 ] || fail "after info --warm: compiles $(built "$tmp/ahead.png.log") programs"

# Kernels that this user has already are made for all, too; under any umask; and where nothing is kept that is no success.
export CAMBER_KERNELS=$tmp/all
(umask 077 && "$tool" info --warm >"$tmp/warm.out" 2>"$tmp/warm.log") || fail "info --warm for all: $(cat "$tmp/warm.log")"
[ "$(find "$CAMBER_KERNELS" -perm 644 -name 'kernels-*.bin' | wc -l)" = "$programs" ] || fail "info --warm for all: not $programs files"
[ "$(stat -c %a "$CAMBER_KERNELS")" = 755 ] || fail "a folder for all of mode $(stat -c %a "$CAMBER_KERNELS")"
status=0
for file in "$CAMBER_KERNELS"/kernels-*.bin; do
    mkdir -p "$tmp/nothing/${file##*/}" # a file cannot take the place of a folder
done
CAMBER_KERNELS=$tmp/nothing "$tool" info --warm >"$tmp/warm.out" 2>"$tmp/warm.log" || status=$?
[ "$status" = 74 ] || fail "info --warm that keeps nothing: status $status: $(cat "$tmp/warm.log")"

# ---- Where PoCL would end the process ----

verbs=("render $city -o $tmp/out/x.png --size 64x64")
"$tool" serve "$city" --listen nowhere 2>/dev/null
[ $? = 69 ] || verbs+=("serve $city --theme light --listen 127.0.0.1:0") # 69: this build has no server
refused() { # WORDS COMMAND...: a line that has the words, status 69, and nothing left; a server says no more before
    local words=$1 status verb
    shift
    mkdir -p "$tmp/out" && chmod 777 "$tmp/out"
    for verb in "${verbs[@]}"; do
        status=0
        # shellcheck disable=SC2086
        timeout 300 "$@" $verb --draw cl >"$tmp/refused.log" 2>&1 </dev/null || status=$?
        [ "$status" = 69 ] && [ "$(wc -l <"$tmp/refused.log")" = 1 ] && grep -q "^camber: .*$words" "$tmp/refused.log" ||
            fail "${verb%% *}, $words: status $status: $(cat "$tmp/refused.log")"
        [ -z "$(ls -A "$tmp/out")" ] || fail "$words: left behind: $(ls -A "$tmp/out")"
    done
}

export CAMBER_KERNELS= POCL_CACHE_DIR=$tmp/mounted
mkdir -p "$tmp/mounted" "$tmp/no-programs"
for options in noexec size=64k; do
    empty
    mount -t tmpfs -o "$options" none "$tmp/mounted" 2>/dev/null || { echo "no file system of its own: left out"; break; }
    [ "$options" = noexec ] || head -c 64k /dev/zero >"$tmp/mounted/x"
    refused "POCL_CACHE_DIR" "$tool"
    umount "$tmp/mounted"
done
POCL_CACHE_DIR=$tmp/pocl empty
case $("$tool" info 2>/dev/null) in
*"driver "[1-4].*) refused "binutils" env POCL_CACHE_DIR="$tmp/pocl" PATH="$tmp/no-programs" "$tool" ;;
esac
serve=${verbs[1]:-}
verbs=("${verbs[0]}")
if [ "$(id -u)" = 0 ] && [ "$(nproc)" -gt 1 ] && setpriv --reuid=61234 --clear-groups "$tool" --version >"$tmp/out.log" 2>&1; then
    refused "ulimit -u" setpriv --reuid=61234 --clear-groups bash -c 'ulimit -u 1; exec "$@"' bash "$tool"
    for most in ${serve:+1 6}; do # no thread of its own, or none of libmicrohttpd's
        # shellcheck disable=SC2086
        timeout 300 setpriv --reuid=61234 --clear-groups bash -c "ulimit -u $most; exec \"\$@\"" bash "$tool" $serve >"$tmp/refused.log" 2>&1
        [ $? = 70 ] && grep -q "^camber: serve: .*ulimit -u" "$tmp/refused.log" || fail "serve, ulimit -u $most: $(cat "$tmp/refused.log")"
    done
fi

echo "$failures failures"
[ "$failures" = 0 ]
