#!/usr/bin/env bash
# Fuzzes, each target for some seconds: run.sh FOLDER SECONDS [TARGET...]
#
# An input that takes a minute is a hang: the clock is the wall's, and tests beside it may have the processors.
#
# A run starts from the inputs in tests/fuzz; what it finds on top grows in FOLDER/corpus, and inputs that break
# something land in FOLDER/broken.
set -u
folder=$1 seconds=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS=suppressions=$here/../fixtures/lsan.supp:print_suppressions=0

fuzz() {
    local target=$1 program=$folder/tests/fuzz/fuzz_$1 log=$folder/$1.log options=() kept=() before
    if [ ! -x "$program" ]; then
        echo "$program is not there: skipped"
        return 77
    fi
    mkdir -p "$folder/corpus/$target" "$folder/broken"
    for kept_folder in corpus regressions; do
        [ ! -d "$here/$kept_folder/$target" ] || kept+=("$here/$kept_folder/$target")
    done
    [ ! -f "$here/$target.dict" ] || options+=("-dict=$here/$target.dict")
    before=$(ls "$folder/broken")
    "$program" "$folder/corpus/$target" "${kept[@]}" -max_total_time="$seconds" -timeout=300 -rss_limit_mb=2048 \
        -malloc_limit_mb=512 -max_len=4096 -reload=0 -print_final_stats=1 -artifact_prefix="$folder/broken/$target-" \
        "${options[@]}" >"$log" 2>&1
    local status=$?
    if [ $status -eq 0 ]; then
        echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs," \
            "$(sed -n 's/.*DONE *\(cov: [0-9]*\).*/\1/p' "$log")"
        return 0
    fi
    grep -aE 'does not hold|runtime error|ERROR: |SUMMARY: ' "$log"
    for input in $(comm -13 <(echo "$before") <(ls "$folder/broken")); do
        echo "$target broke; replay with: $program $folder/broken/$input"
    done
    echo "the whole story: $log"
    return 1
}

[ $# -gt 0 ] || set -- $(cd "$folder/tests/fuzz" && find . -maxdepth 1 -type f -name 'fuzz_*' -printf '%f\n' | sed 's/^fuzz_//' | sort)
result=0
for target; do
    fuzz "$target" || result=$?
    [ $result -eq 0 ] || [ $result -eq 77 ] || break
done
exit $result
