#!/bin/bash -eu
# The fuzz targets as OSS-Fuzz wants them, with its compilers, flags and engine; check.sh runs it without OSS-Fuzz.
#
# All targets are built: none needs an OpenCL device where it fuzzes. What a target is
# linked with is not there where it runs: the libraries lie in $OUT/lib beside it, with libc's own left out, and each
# program finds them by an rpath, which unlike a runpath holds for what the libraries themselves want.

cmake -S "$SRC/camber" -B "$WORK/camber" -G Ninja -DCMAKE_BUILD_TYPE=None -DCAMBER_FUZZ=ON -DCAMBER_CPU=OFF \
    -DCAMBER_FUZZ_ENGINE="$LIB_FUZZING_ENGINE" -DCMAKE_BUILD_RPATH='$ORIGIN/lib' \
    -DCMAKE_EXE_LINKER_FLAGS=-Wl,--disable-new-dtags
cmake --build "$WORK/camber" --target fuzz_targets

mkdir -p "$OUT/lib"
for program in "$WORK"/camber/tests/fuzz/fuzz_*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    name=$(basename "$program")
    target=${name#fuzz_}
    cp "$program" "$OUT/"
    for kept in corpus regressions; do
        folder=$SRC/camber/tests/fuzz/$kept/$target
        [ ! -d "$folder" ] || zip -qj "$OUT/${name}_seed_corpus.zip" "$folder"/*
    done
    [ ! -f "$SRC/camber/tests/fuzz/$target.dict" ] || cp "$SRC/camber/tests/fuzz/$target.dict" "$OUT/$name.dict"
    printf '[libfuzzer]\nmax_len = 4096\n' >"$OUT/$name.options"
    ldd "$program" | awk '$2 == "=>" && $3 ~ /^\// { print $3 }'
done | sort -u | grep -Ev '/lib(c|m|dl|rt|pthread|resolv)\.so' | xargs cp -Lt "$OUT/lib"
