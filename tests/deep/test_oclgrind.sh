#!/usr/bin/env bash
# The kernels in oclgrind, which checks every access for bounds and races and every call of the API: test_oclgrind.sh
# PROGRAM. Not with --uninitialized: 21.10 takes for uninitialised what it computes in integers of odd widths, which its
# clang makes of masks; what it finds then are sums of words that it has seen written.
set -u
command -v oclgrind >/dev/null || { echo "oclgrind is not installed: skipped"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# The kernels that it compiles are of no use to others.
export XDG_CACHE_HOME=$folder CAMBER_KERNELS=
program=$1
# Its clang reads the kernels from memory only where it may write a cache. 21.10 does not know
# llvm.experimental.noalias.scope.decl, which clang leaves where it inlines a function that returns a struct.
check() { # options of kernels, arguments of the program
    oclgrind --data-races --check-api --build-options "$1" --log "$folder/log" "$program" "${@:2}"
    local status=$?
    if [ -s "$folder/log" ]; then
        echo "oclgrind found:"
        head -n 40 "$folder/log"
        exit 1
    fi
    [ $status -eq 0 ] || exit $status
}
check -fno-inline
# 21.10 does not know llvm.abs either, which clang makes of an integer that is optimised.
check '-fno-inline -cl-opt-disable' --one-lane
