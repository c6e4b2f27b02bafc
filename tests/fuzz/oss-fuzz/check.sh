#!/usr/bin/env bash
# Whether what OSS-Fuzz is given would build and run there, without its images: check.sh SOURCE [FOLDER]
#
# projects/camber is what google/oss-fuzz has of a project. This stands in for its base-builder: the same variables, in a
# folder of their own, which is kept where it is named: ../run.sh fuzzes what lies there. The sanitizers are those that
# OSS-Fuzz builds with one by one. Exits with 77 where clang or libFuzzer is missing.
set -u
source=$(realpath "$1") folder=${2:-}
project=$source/tests/fuzz/oss-fuzz/projects/camber
failures=0

fail() {
    echo "fails: $*"
    failures=$((failures + 1))
}

# ---- The two files that are read elsewhere ----

check_fields() {
    local field
    for field in homepage main_repo primary_contact language base_os_version fuzzing_engines sanitizers; do
        grep -q "^$field:" "$project/project.yaml" || fail "project.yaml has no $field"
    done
    grep -q "^FROM gcr.io/oss-fuzz-base/base-builder:$(sed -n 's/^base_os_version: *//p' "$project/project.yaml")\$" \
        "$project/Dockerfile" || fail "the Dockerfile begins from another system than project.yaml says"
    grep -l example.org "$project"/* | sed 's/$/: the address of the repository is still to be filled in/'
}

# Each package is one that dev installs, or that this system's lists have.
check_packages() {
    local package known
    known=$(sed -n '/^readonly PACKAGES_/,/)/p' "$source/dev" | tr -s '=()' ' ')
    for package in $(sed -n '/apt-get install/,/[^\\]$/p' "$project/Dockerfile" | tr -d '\\' | tr ' ' '\n' |
        sed -n '/^[a-z0-9][a-z0-9.+-]*$/p' | grep -Ev '^(apt-get|update|install)$'); do
        case " $(echo $known) " in
        *" $package "*) ;;
        *) apt-cache show "$package" >/dev/null 2>&1 || fail "the Dockerfile wants $package, which nobody knows" ;;
        esac
    done
}

# ---- The build, and a second of each target ----

build() {
    local flags="-O1 -fno-omit-frame-pointer -gline-tables-only -fno-sanitize-recover=all"
    flags+=" -fsanitize=address,undefined,float-cast-overflow,fuzzer-no-link"
    rm -rf "$folder/out" "$folder/away" "$folder/seeds"
    mkdir -p "$folder/src" "$folder/out" "$folder/work" "$folder/tests"
    ln -sfn "$source" "$folder/src/camber"
    ln -sfn ../away "$folder/tests/fuzz"
    env SRC="$folder/src" OUT="$folder/out" WORK="$folder/work" CC=clang CXX=clang++ CFLAGS="$flags" CXXFLAGS="$flags" \
        LIB_FUZZING_ENGINE=-fsanitize=fuzzer SANITIZER=address FUZZING_ENGINE=libfuzzer ARCHITECTURE=x86_64 \
        bash -eu "$project/build.sh" >"$folder/build.log" 2>&1
}

# $OUT alone, as where it runs: moved away from where it was built, and with no other way to the libraries.
run_target() { # NAME
    local name=fuzz_$1 seeds=$folder/seeds/$1
    [ -x "$folder/away/$name" ] || { fail "$name is not in \$OUT"; return; }
    [ ! -f "$source/tests/fuzz/$1.dict" ] || [ -f "$folder/away/$name.dict" ] || fail "$name.dict is not in \$OUT"
    mkdir -p "$seeds"
    python3 -m zipfile -e "$folder/away/${name}_seed_corpus.zip" "$seeds" || fail "$name has no seeds"
    (cd "$folder/away" && ldd "./$name") | grep -E 'not found|=> /(usr/)?lib.*/lib(gdal|sqlite3|png16|OpenCL)\.so' &&
        fail "$name takes libraries from this system"
    timeout 600 "$folder/away/$name" "$seeds" -max_total_time=1 -max_len=4096 -rss_limit_mb=2048 \
        -artifact_prefix="$folder/broken-" >"$folder/$1.log" 2>&1 ||
        { fail "$name does not run"; grep -a "does not hold" "$folder/$1.log"; tail -n 5 "$folder/$1.log"; }
}

check_targets() {
    local target
    mv "$folder/out" "$folder/away"
    for target in "$source"/tests/fuzz/fuzz_*.c; do
        grep -q LLVMFuzzerTestOneInput "$target" || continue
        target=$(basename "$target" .c)
        run_target "${target#fuzz_}"
    done
    [ -e "$folder/away/lib" ] || fail "no libraries in \$OUT"
}

check_fields
check_packages
if ! command -v clang++ >/dev/null || ! command -v zip >/dev/null ||
    ! echo 'int LLVMFuzzerTestOneInput(const char *b, unsigned long n) { return b && !n; }' |
    clang -x c -fsanitize=fuzzer,address - -o /dev/null 2>/dev/null; then
    [ $failures = 0 ] || exit 1
    echo "no clang, libFuzzer or zip: skipped"
    exit 77
fi
if [ -z "$folder" ]; then
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
fi
if build; then
    check_targets
else
    fail "build.sh does not build"
    tail -n 40 "$folder/build.log"
fi
echo "$failures failures, $SECONDS s"
[ $failures = 0 ]
