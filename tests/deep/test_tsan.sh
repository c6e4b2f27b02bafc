#!/usr/bin/env bash
# Tests of threads, under ThreadSanitizer: test_tsan.sh build SOURCE FOLDER [CMAKE ARGS...], then run SOURCE FOLDER
set -eu
verb=$1 source=$2 folder=$3
shift 3

build() {
    local targets=(camber_tool test_picture_error test_threads)
    mkdir -p "$folder"
    if ! { cmake -S "$source" -B "$folder" -G Ninja -DCAMBER_TESTS=ON -DCAMBER_SANITIZE=THREAD -DCMAKE_BUILD_TYPE=Release "$@" &&
        { ! grep -q '^CAMBER_MAP:.*=ON$' "$folder/CMakeCache.txt" || targets+=(test_readers); } &&
        { ! grep -q '^MICROHTTPD_FOUND:.*=1$' "$folder/CMakeCache.txt" || targets+=(test_draw_queue test_tile_cache); } &&
        { ! grep -q '^camber_cpu_kernels:' <(cmake --build "$folder" --target help) || targets+=(test_cpu); } &&
        cmake --build "$folder" --target "${targets[@]}"; } >"$folder/build.log" 2>&1; then
        tail -n 50 "$folder/build.log"
        exit 1
    fi
}

# gcc 12's falls over a kernel that puts addresses where it wants its shadow; without randomness it does not.
fixed=()
if setarch "$(uname -m)" -R true 2>/dev/null; then fixed=(setarch "$(uname -m)" -R); fi

begin() {
    local said
    said=$("${fixed[@]}" "$folder/src/camber" --version 2>&1) && return
    if [[ $said == *"memory mapping"* || $said == *"memory layout"* ]]; then
        echo "skipped: ThreadSanitizer cannot start under this kernel's random addresses, and setarch -R is not allowed"
        exit 77
    fi
    echo "$said"
    exit 1
}

# Runs the tool, which gets a SIGTERM after so many seconds; a race ends it with 99.
draw() { # seconds, statuses that are right as 0|143, arguments...
    local seconds=$1 right=$2 status=0
    shift 2
    timeout --preserve-status -k 600 "$seconds" "${fixed[@]}" "$folder/src/camber" render "$@" --size 64x64 -o "$work/out.png" -f \
        >"$work/log" 2>&1 || status=$?
    [[ "|$right|" == *"|$status|"* ]] && return
    cat "$work/log"
    echo "camber render $*: status $status"
    exit 1
}

# render opens surface, device and kernels on a thread beside reading, and another thread waits for signals.
run_tool() {
    local city=$source/tests/data/santa_cruz/osm.mbtiles pause
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    echo '{"type":"LineString","coordinates":[[0,0],[1,1],[2,0]]}' >"$work/lines.geojson"
    draw 600 0 "$city" --draw cl
    draw 600 0 "$work/lines.geojson" --draw cl # read by GDAL
    draw 600 '0|69' "$work/lines.geojson" --draw gl # 69: there is no GL
    draw 600 0 - --draw cl <"$city"
    for pause in 0.1 0.2 0.3 0.4; do
        draw "$pause" '0|143' - --draw cl <"$city"
    done
}

run() {
    local test status
    # A child that a test forks leaves without the check at the end, and so a race ends it at once.
    # A run that a signal ends joins no thread.
    export TSAN_OPTIONS=report_thread_leaks=0:exitcode=99:halt_on_error=1:atexit_sleep_ms=0:suppressions=$source/tests/fixtures/tsan.supp:print_suppressions=0
    begin
    for test in test_picture_error test_readers test_threads test_draw_queue test_tile_cache; do
        [ -e "$folder/tests/$test" ] || continue # not in a build without maps, or without a server
        status=0
        "${fixed[@]}" "$folder/tests/$test" || status=$?
        [ "$status" = 0 ] || exit "$status"
    done
    if [ -e "$folder/tests/test_cpu" ]; then # the processor's own device, which the tests above do without
        (unset CAMBER_CPU && "${fixed[@]}" "$folder/tests/test_cpu") || exit $?
        if [ -e "$folder/tests/test_readers" ]; then (unset CAMBER_CPU && run_tool); fi
    fi
    if [ -e "$folder/tests/test_readers" ]; then run_tool; fi
}

"$verb" "$@"
