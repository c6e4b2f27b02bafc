#!/bin/bash
# Faults from outside: kernel caches that cannot be used or hold garbage, two processes filling one, runs that are killed
# while they write; threads and first memory that cannot be had. test_faults.sh TOOL [tool_fault.so]
# Prints what failed and exits 1 if anything did. Signals that the tool handles are test_cli.sh's.
set -u
tool=$(realpath "$1")
tool_fault=${2:+$(realpath "$2")}
tmp=$(mktemp -d) || exit 1
trap 'umount "$tmp"/mount.* 2>/dev/null; rm -rf "$tmp"' EXIT
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=0}
# Nobody has compiled for all users here. PoCL's own cache stays where camber's is emptied.
export CAMBER_KERNELS=
export HOME=$tmp/home POCL_CACHE_DIR=$tmp/pocl XDG_CACHE_HOME=$tmp/xdg
# Mesa says so where it cannot keep its shaders beside camber's kernels: it gets another folder.
export MESA_SHADER_CACHE_DIR=$tmp/mesa
mkdir "$HOME" "$POCL_CACHE_DIR" "$tmp/out"
cd "$tmp/out" || exit 1
checks=0
failures=0
begun=$SECONDS

fail() {
    failures=$((failures + 1))
    echo "FAILED: $name: $*"
}

said() { # what has been done, and how long it has taken so far
    echo "$*; $((SECONDS - begun)) s so far"
}

# Lines all over a degree.
awk 'BEGIN {
    printf "{\"type\":\"FeatureCollection\",\"features\":["
    for (i = 0; i < 60; i++) {
        x = 10 + (i * 37 % 60) / 60; y = 50 + (i * 23 % 60) / 60
        printf "%s{\"type\":\"Feature\",\"properties\":{\"class\":%d},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[", i ? "," : "", i % 5
        for (k = 0; k < 12; k++) {
            printf "%s[%.5f,%.5f]", k ? "," : "", x, y
            x += ((i * 31 + k * 17) % 21 - 10) / 100; y += ((i * 13 + k * 29) % 21 - 10) / 100
        }
        printf "]}}"
    }
    print "]}"
}' >"$tmp/lines.geojson"

draw() { # OUT ARGUMENTS...: out, err and status are what came of it
    local out=$1
    shift
    checks=$((checks + 1))
    "$tool" render "$tmp/lines.geojson" -fo "$out" --size 200x200 "$@" >"$tmp/stdout" 2>"$tmp/stderr" </dev/null
    status=$?
}

# The picture is right, whatever the cache is; nothing is said, since a cache that cannot be used is no error.
draws() { # NAME ARGUMENTS...
    name=$1
    shift
    draw a.png -q "$@"
    [ "$status" = 0 ] || fail "exit status $status: $(head -c 300 "$tmp/stderr")"
    [ -s "$tmp/stderr" ] && fail "says: $(head -c 300 "$tmp/stderr")"
    cmp -s a.png "$right" || fail "another picture"
    rm -f a.png
    [ -z "$(ls -A)" ] || fail "left behind: $(ls -A)"
}

kernels_come_from() { # "the cache" or "built"
    checks=$((checks + 1))
    "$tool" tessellate "$tmp/lines.geojson" -o a.glb -v >"$tmp/stdout" 2>"$tmp/stderr" </dev/null ||
        fail "exit status $?: $(head -c 300 "$tmp/stderr")"
    rm -f a.glb
    grep -q "^camber: info: kernels of [a-z]*: \(from \)\?$1 in" "$tmp/stderr" ||
        fail "kernels are not '$1': $(grep kernels "$tmp/stderr")"
}

# A clean cache folder has whole files of camber's, no temporary ones.
is_clean() {
    local file
    for file in "$1"/* "$1"/.[!.]*; do
        [ -e "$file" ] || continue
        [[ $(basename "$file") =~ ^((kernels|shaders)-[0-9a-f]{16}\.bin|\.lock)$ ]] || fail "left in the cache: $(basename "$file")"
    done
}

name="first run"
right=$tmp/right.png
draw "$right" -v
if [ "$status" = 69 ]; then
    echo "skipped: $(head -1 "$tmp/stderr")"
    exit 77
fi
if [ "$status" != 0 ]; then
    fail "exit status $status: $(head -c 300 "$tmp/stderr")"
    exit 1
fi
kernels_come_from "the cache"
cache=$XDG_CACHE_HOME/camber
kernels=$(grep -l classify "$cache"/kernels-*) # those of a method; those of networks lie beside them
[ -f "$kernels" ] || fail "the cache has not one file of kernels: $(ls -A "$cache")"
cp "$kernels" "$tmp/whole.bin"
XDG_CACHE_HOME=$tmp/other draw "$tmp/pitched.png" --pitch 30

# ---- Folders that cannot be used ----

touch "$tmp/file"
XDG_CACHE_HOME=$tmp/file draws "a file in place of the folder"
XDG_CACHE_HOME=$tmp/file/below draws "a folder below a file"
XDG_CACHE_HOME=/proc draws "a file system without folders of ours"
XDG_CACHE_HOME=/$(printf 'a%.0s' $(seq 300)) draws "a name that is too long"
XDG_CACHE_HOME=/$(printf 'a/%.0s' $(seq 2000)) draws "a path that is too long"
XDG_CACHE_HOME=some/where draws "a relative path"
[ -n "$(find "$HOME/.cache/camber" -name 'kernels-*.bin')" ] || fail "not in ~/.cache: $(find "$HOME")"
rm -rf "$HOME/.cache"
(unset XDG_CACHE_HOME && draws "unset" && exit "$failures")
failures=$((failures + $?))
[ -n "$(find "$HOME/.cache/camber" -name 'kernels-*.bin')" ] || fail "not in ~/.cache: $(find "$HOME")"
XDG_CACHE_HOME="" HOME="" draws "neither"
XDG_CACHE_HOME="" HOME=here draws "a relative home"
mkdir "$tmp/away" && ln -s "$tmp/nowhere" "$tmp/away/camber"
XDG_CACHE_HOME=$tmp/away draws "a link to nowhere"

# Permissions do not bind root: a mount does, or a user that is not root.
mkdir "$tmp/mount.ro" "$tmp/mount.small" "$tmp/mount.ro/camber"
cp "$kernels" "$tmp/mount.ro/camber/"
if mount --bind "$tmp/mount.ro" "$tmp/mount.ro" 2>/dev/null && mount -o remount,bind,ro "$tmp/mount.ro" 2>/dev/null; then
    export XDG_CACHE_HOME=$tmp/mount.ro
    draws "a read-only folder that has the kernels"
    kernels_come_from "the cache"
    right=$tmp/pitched.png draws "a read-only folder that lacks the kernels" --pitch 30
    umount "$tmp/mount.ro"
elif [ "$(id -u)" != 0 ]; then
    chmod -R a-w "$tmp/mount.ro"
    XDG_CACHE_HOME=$tmp/mount.ro draws "a read-only folder that has the kernels"
    XDG_CACHE_HOME=$tmp/mount.ro right=$tmp/pitched.png draws "a read-only folder that lacks the kernels" --pitch 30
    chmod -R u+w "$tmp/mount.ro"
else
    echo "skipped: a read-only folder: root without the right to mount one"
fi
if mount -t tmpfs -o size=64k none "$tmp/mount.small" 2>/dev/null; then
    export XDG_CACHE_HOME=$tmp/mount.small
    draws "a disk that is too small"
    [ -z "$(find "$tmp/mount.small" -type f ! -name 'shaders-*.bin' ! -name 'kernels-*.bin' ! -name .lock)" ] || fail "left behind: $(find "$tmp/mount.small" -type f)"
    kernels_come_from built
    umount "$tmp/mount.small"
else
    echo "skipped: a full disk: no right to mount a small one"
fi
export XDG_CACHE_HOME=$tmp/xdg
# They must get to the tool: a home of mode 0700 keeps them out.
if [ "$(id -u)" = 0 ] && setpriv --reuid=65534 --clear-groups "$tool" --version >/dev/null 2>&1; then
    name="kernels of another user's"
    mkdir -p "$tmp/theirs/camber" "$tmp/theirs/pocl" "$tmp/theirs/out"
    cp "$kernels" "$tmp/theirs/camber/" && chmod 600 "$tmp/theirs/camber/"*
    chmod 711 "$tmp" && chmod 644 "$tmp/lines.geojson" && chown 65534 "$tmp/theirs/pocl" "$tmp/theirs/out"
    XDG_CACHE_HOME=$tmp/theirs POCL_CACHE_DIR=$tmp/theirs/pocl setpriv --reuid=65534 --clear-groups \
        "$tool" render "$tmp/lines.geojson" -qo "$tmp/theirs/out/a.png" --size 200x200 2>"$tmp/stderr" ||
        fail "exit status $?: $(head -c 300 "$tmp/stderr")"
    cmp -s "$tmp/theirs/out/a.png" "$right" || fail "another picture"
    name="a file that others may not read"
    for ending in geojson osm.pbf osm.gz; do
        cp "$tmp/lines.geojson" "$tmp/theirs/closed.$ending" && chmod 600 "$tmp/theirs/closed.$ending"
        setpriv --reuid=65534 --clear-groups "$tool" render "$tmp/theirs/closed.$ending" -o "$tmp/theirs/out/b.png" 2>"$tmp/stderr" &&
            fail "exit status 0"
        grep -q "closed.$ending: cannot be read: Permission denied; " "$tmp/stderr" || fail "$(head -c 300 "$tmp/stderr")"
    done
else
    echo "skipped: kernels of another user's: not root, no setpriv, or $tool lies where others cannot go"
fi
said "folders"

# ---- Threads that cannot be had ----

# Who watches for signals and who opens the device beside reading are threads; a run does without either. Each call is
# refused in turn, and then all.
refuse() { # FUNCTION:N
    rm -f "$tmp/refused"
    LD_PRELOAD=$tool_fault CAMBER_FAULT=$1 CAMBER_FAULT_TOLD=$tmp/refused draws "$1"
    rm -f a.png
    [ -z "$(ls -A)" ] || fail "left behind: $(ls -A)"
    [ -e "$tmp/refused" ]
}

if [ -n "$tool_fault" ]; then
    for call in create join mutex_init mutex_lock mutex_unlock mutex_destroy; do
        n=1
        while refuse "pthread_$call:$n" && [ $n -lt 100 ]; do
            n=$((n + 1))
        done
        [ $n -gt 1 ] || fail "the tool does not call it"
        refuse "pthread_$call:1+" || fail "nothing was refused"
        refused="${refused:-}, $call $((n - 1))"
    done
    # Without the thread that waits for them, signals end a run as they end any.
    name="a signal without its watch"
    mkfifo "$tmp/wait"
    LD_PRELOAD=$tool_fault CAMBER_FAULT=pthread_create:1+ "$tool" render - -qo a.png <"$tmp/wait" 2>/dev/null &
    exec 3>"$tmp/wait"
    while [ "/proc/$!/exe" -ef "$BASH" ]; do :; done # which would tidy up if the signal reached it
    sleep 0.5
    kill -TERM $!
    wait $!
    status=$?
    [ $status = 143 ] || fail "exit status $status after SIGTERM"
    exec 3>&-
    rm -f "$tmp/wait"
    draws "after the one that a signal ended"
    rm -f a.png
    [ -z "$(ls -A)" ] || fail "left behind: $(ls -A)"
    said "threads${refused:-}"
    for call in calloc:1 calloc:2 calloc:3 strdup:1 malloc:1; do # of the options and of OUT
        name=$call
        LD_PRELOAD=$tool_fault CAMBER_FAULT=$call draw a.png
        [ "$status" = 70 ] && grep -q '^camber: .*memory' "$tmp/stderr" || fail "exit status $status: $(head -c 300 "$tmp/stderr")"
        [ -z "$(ls -A)" ] || fail "left behind: $(ls -A)"
    done
else
    echo "skipped: threads that cannot be had: no library for it"
fi

# ---- Garbage in the folder ----

# Whatever stands in its place is a miss, and a whole file takes that place.
spoilt() { # NAME
    draws "$1"
    [ -f "$kernels" ] && kernels_come_from "the cache"
    is_clean "$cache"
    rm -rf "$kernels"
    cp "$tmp/whole.bin" "$kernels"
}

size=$(stat -c %s "$kernels")
for left in 0 7 8 9 100 $((size / 2)) $((size - 1)); do
    head -c "$left" "$tmp/whole.bin" >"$kernels"
    spoilt "kernels cut off after $left bytes"
done
head -c "$size" /dev/urandom >"$kernels"
spoilt "random bytes"
for at in 3 8 1000 $((size - 1)); do
    byte=$(od -An -tu1 -j"$at" -N1 "$tmp/whole.bin")
    # shellcheck disable=SC2059
    printf "$(printf '\\%03o' $((byte ^ 64)))" | dd of="$kernels" bs=1 seek="$at" conv=notrunc 2>/dev/null
    spoilt "byte $at of the kernels changed"
done
echo more >>"$kernels"
spoilt "more behind the end"
truncate -s 20G "$kernels"
spoilt "a file larger than memory"
rm -f "$kernels" && mkfifo "$kernels"
spoilt "a pipe in place of the kernels"
rm -f "$kernels" && ln -s /dev/zero "$kernels"
spoilt "a link to a device that never ends"
rm -f "$kernels" && mkdir "$kernels"
draws "a folder in place of the kernels"
is_clean "$cache"
rmdir "$kernels"
cp "$tmp/whole.bin" "$kernels"

# Another method's kernels under this one's name are whole, and the wrong ones.
for method in kite fan; do
    "$tool" tessellate "$tmp/lines.geojson" -fqo mesh.glb --method "$method" 2>"$tmp/stderr" ||
        fail "exit status $?: $(head -c 300 "$tmp/stderr")"
done
rm -f mesh.glb
for other in $(grep -l classify "$cache"/kernels-*); do
    [ "$other" = "$kernels" ] && continue
    cp "$other" "$kernels"
    spoilt "another method's kernels"
done
[ "$(grep -l classify "$cache"/kernels-* | wc -l)" = 3 ] || fail "not three methods' kernels in the cache: $(ls "$cache")"
said "garbage"

# ---- Two processes fill the cache at once ----

name="two processes"
mkdir "$tmp/pocl.1" "$tmp/pocl.2"
runs=50
for run in $(seq $runs); do
    rm -rf "$cache" "$tmp"/[12].png
    for process in 1 2; do
        POCL_CACHE_DIR=$tmp/pocl.$process "$tool" render "$tmp/lines.geojson" -qo "$tmp/$process.png" --size 200x200 \
            2>"$tmp/stderr.$process" </dev/null &
        jobs[process]=$!
    done
    for process in 1 2; do
        wait "${jobs[process]}" || fail "run $run: exit status $?: $(head -c 300 "$tmp/stderr.$process")"
        cmp -s "$tmp/$process.png" "$right" || fail "run $run: another picture"
        [ -s "$tmp/stderr.$process" ] && fail "run $run: says $(head -c 300 "$tmp/stderr.$process")"
    done
    is_clean "$cache"
    [ -s "$kernels" ] || fail "run $run: no kernels in the cache"
    checks=$((checks + 2))
    [ $((run % 10)) = 0 ] && kernels_come_from "the cache"
done
said "two processes, $runs runs"

# ---- Killed ----

# Delays over the time of a run, most of them in its second half, where it writes. A run that ends before is one too. The
# machine's pace may change meanwhile: what a run takes is put less after each that ends before, and more after two others.
drawing=("$tool" render "$tmp/lines.geojson" -q --size 1000x1000 --method)
"${drawing[@]}" strip -o "$tmp/new.png" && "${drawing[@]}" strip --theme dark -o "$tmp/old.png"
begin=$(date +%s%N)
"${drawing[@]}" strip -fo a.png
took_ms=$((($(date +%s%N) - begin) / 1000000))
rm -f a.png
name="killed"
runs=48
killed=0
torn=0
left=0
for run in $(seq $runs); do
    expected=absent
    if [ $((run % 2)) = 0 ]; then
        cp "$tmp/old.png" a.png
        expected=old
    fi
    [ $((run % 4)) -lt 2 ] && rm -rf "$cache"
    delay=$((took_ms * (run < runs / 3 ? run * 150 / runs : 50 + (run - runs / 3) * 90 / runs) / 100))
    "${drawing[@]}" strip -fo a.png 2>"$tmp/stderr" &
    sleep "$(printf '%d.%03d' $((delay / 1000)) $((delay % 1000)))"
    kill -KILL $! 2>/dev/null
    wait $! 2>/dev/null
    status=$?
    checks=$((checks + 1))
    found=absent
    [ -e a.png ] && found=torn
    cmp -s a.png "$tmp/new.png" 2>/dev/null && found=new
    cmp -s a.png "$tmp/old.png" 2>/dev/null && found=old
    case $status:$found in
    0:new) took_ms=$((took_ms * 7 / 8)) ;;
    137:"$expected" | 137:new) killed=$((killed + 1)) took_ms=$((took_ms * 17 / 16)) ;;
    *) fail "after $delay ms: exit status $status, and the file is $found" && torn=$((torn + 1)) ;;
    esac
    # Files that are left are hidden and have the process's name, in the cache the kernels' with six letters behind.
    for file in .[!.]*; do
        [ -e "$file" ] || continue
        left=$((left + 1))
        [[ $file =~ ^\.camber-[0-9]+-[0-9]+\.tmp$ ]] || fail "left behind: $file"
    done
    for file in "$cache"/*; do
        [ -e "$file" ] || continue
        [[ $(basename "$file") =~ ^((kernels|shaders)-[0-9a-f]{16}\.bin(\.[A-Za-z0-9]{6})?)$ ]] || fail "left in the cache: $file"
    done
    rm -f a.png
done
[ "$killed" -ge $((runs / 3)) ] || fail "only $killed of $runs runs were killed"
[ "$left" -ge 1 ] || echo "note: no run left a temporary file"
draws "after the killed ones"
kernels_come_from "the cache"
said "killed: $killed of $runs runs, $torn torn files, $left left beside, removed by the next run"

# A run that lives keeps its file: only leftovers go.
name="a run beside"
mkfifo "$tmp/fifo"
"$tool" render - -qo slow.png --size 200x200 <"$tmp/fifo" 2>"$tmp/stderr.slow" &
slow=$!
exec 3>"$tmp/fifo"
until [ -n "$(ls -A)" ]; do
    kill -0 $slow 2>/dev/null || break
    sleep 0.1
done
mine=$(ls -A)
touch .camber-1-0.tmp .camber-1-0.tmpx .camber-x-0.tmp
draw a.png -q
[ "$status" = 0 ] || fail "exit status $status"
[ "$(ls -A)" = "$(printf '%s\n' "$mine" .camber-1-0.tmpx .camber-x-0.tmp a.png | sort)" ] ||
    fail "there are $(ls -A), not the file that is written, what is not camber's, and a.png"
cat "$tmp/lines.geojson" >&3
exec 3>&-
wait $slow || fail "exit status $? of the slow one: $(head -c 300 "$tmp/stderr.slow")"
cmp -s slow.png "$right" || fail "another picture"
rm -f -- slow.png a.png .camber-1-0.tmpx .camber-x-0.tmp
[ -z "$(ls -A)" ] || fail "left behind: $(ls -A)"

echo "$checks runs, $failures failures, $((SECONDS - begun)) s"
[ "$failures" = 0 ]
