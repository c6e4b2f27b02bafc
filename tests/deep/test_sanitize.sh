#!/usr/bin/env bash
# The tests under AddressSanitizer and UBSan:
#   test_sanitize.sh build SOURCE FOLDER [CMAKE ARGS...]
#   test_sanitize.sh run FOLDER K/N          every N-th test, from the K-th on
#   test_sanitize.sh run FOLDER soak_serve   that one, which takes its time however fast it is
#   test_sanitize.sh run FOLDER changed      those that the regular expression CAMBER_SANITIZED matches
set -eu
verb=$1
shift
case $verb in
build)
    source=$1 folder=$2
    shift 2
    mkdir -p "$folder"
    if ! { cmake -S "$source" -B "$folder" -G Ninja -DCAMBER_TESTS=ON -DCAMBER_SANITIZE=ON -DCMAKE_BUILD_TYPE=Release "$@" &&
        cmake --build "$folder"; } >"$folder/build.log" 2>&1; then
        tail -n 50 "$folder/build.log"
        exit 1
    fi
    ;;
run)
    # Real cities are for ./dev test --sanitize. Some tests draw or read for minutes what others do, too, or drive a browser
    # over tiles that others make; and test_faults lets threads fail elsewhere. What runs once more in OpenCL is the driver's, which no sanitizer sees.
    unset CAMBER_DATA
    # Each test says which back end draws.
    unset CAMBER_CPU
    # Shares run side by side, and each writes a log in a folder of its own.
    folder=$1/share-${2%/*}
    mkdir -p "$folder"
    echo 'subdirs("..")' >"$folder/CTestTestfile.cmake"
    usual=(-LE "fuzz|deep|cities" -E '^(test_(faults|pixels|pixels_cl|rasterize.*_opencl|python|read_for|overdraw|self_overlap|archives_outside|tiles_outside|serve_outside|serve_hostile|osmium|web|maps|tileset|fills_outside)|soak_serve)$')
    case $2 in
    changed) chosen=(-R "$CAMBER_SANITIZED" "${usual[@]}") ;;
    */*) chosen=(-I "${2%/*},,${2#*/}" "${usual[@]}") ;;
    *) chosen=(-R "^$2\$" --no-tests=error) ;;
    esac
    ctest --test-dir "$folder" --output-on-failure "${chosen[@]}"
    ;;
esac
