#!/usr/bin/env bash
# Configures and builds the fuzz targets: build.sh SOURCE FOLDER [CMAKE ARGS...]
set -eu
source=$1 folder=$2
shift 2
if ! command -v clang >/dev/null; then
    echo "no clang: skipped"
    exit 77
fi
if ! echo 'int LLVMFuzzerTestOneInput(const char *b, unsigned long n) { return b && !n; }' |
    clang -x c -fsanitize=fuzzer,address - -o /dev/null 2>/dev/null; then
    echo "no libFuzzer for clang (Debian: libclang-rt-$(clang -dumpversion | cut -d. -f1)-dev): skipped"
    exit 77
fi
mkdir -p "$folder"
log=$folder/build.log
if ! { cmake -S "$source" -B "$folder" -G Ninja -DCAMBER_FUZZ=ON -DCAMBER_CPU=OFF -DCMAKE_C_COMPILER=clang "$@" &&
    cmake --build "$folder" --target fuzz_targets; } >"$log" 2>&1; then
    tail -n 50 "$log"
    exit 1
fi
