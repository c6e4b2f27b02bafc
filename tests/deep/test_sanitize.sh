#!/usr/bin/env bash
# The tests under AddressSanitizer and UBSan: test_sanitize.sh build SOURCE FOLDER [CMAKE ARGS...], then run FOLDER
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
    # Real cities are for ./dev test --sanitize, and test_kernels is for oclgrind: the other tests call the same.
    unset CAMBER_DATA
    ctest --test-dir "$1" --output-on-failure -j2 -LE "fuzz|deep|cities" -E '^test_kernels$'
    ;;
esac
