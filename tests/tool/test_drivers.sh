#!/usr/bin/env bash
# Traces which libraries the tool loads: no driver unless it is asked for, or needed; and reads its messages where none is here.
# test_drivers.sh TOOL INPUT CPU [LIBRARY]: CPU is 1 if the build has kernels for the processor itself; LIBRARY has only
# one function of OpenCL's.
set -u
tool=$1 input=$2 has_cpu=$3 part=${4:-}
unset LD_PRELOAD CAMBER_CPU CAMBER_COMPILATIONS # users do not know of them
command -v strace >/dev/null && strace -o /dev/null true 2>/dev/null ||
    { echo "skipped: no strace, or it may not look at processes"; exit 77; }
export ASAN_OPTIONS=detect_leaks=0:${ASAN_OPTIONS:-} # which cannot run under strace
drivers='lib(OpenCL|EGL[_a-z]*|GL|GLX|GLESv2|OSMesa|LLVM[-0-9]*|pocl)\.so|/OpenCL/vendors|/pocl/'
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
fail() { echo "FAILED: $*"; exit 1; }

# Draws OUT.png; OUT.trace is each file that was opened, or tried.
traced() { # OUT, options
    local out=$1
    shift
    strace -f -qq -e trace=open,openat,execve -o "$out.trace" "$tool" render "$input" -qfo "$out.png" --size 256x256 "$@" 2>"$out.told"
}
loads() { grep -E "$drivers" "$1.trace" | grep -v ENOENT; }
fails() { # what it must say, the command
    local says=$1 status=0
    shift
    "$@" >told 2>&1 || status=$?
    [ $status = 69 ] || fail "$*: status $status: $(cat told)"
    grep -Eq "$says" told || fail "$*: says $(cat told)"
}

# ---- Linked ----

ldd "$tool" >linked || fail "ldd: $(cat linked)"
grep -q 'libcamber' linked || fail "ldd sees no libraries: $(cat linked)"
! grep -E "$drivers" linked || fail "drivers are linked"

# ---- Loaded ----

gpu=
for file in /dev/dri/renderD* /dev/{nvidiactl,nvhost-gpu,dxg,mali0,kgsl-3d0,pvrsrvkm,galcore}; do # as src/gpu/hardware.c has them
    [ ! -r "$file" ] || gpu=$file
done
if [ -n "$gpu" ]; then
    echo "a GPU may be here ($gpu), so drivers are asked: what is loaded without one is not looked at"
elif [ "$has_cpu" = 1 ]; then
    traced own || fail "does not draw: $(cat own.told)"
    grep -q 'libcamber' own.trace || fail "the trace names no files"
    ! loads own || fail "drivers are loaded to draw on the processor"
    for threads in 1 2 64; do
        strace -f -qq -e trace=clone,clone3 -o "$threads.clones" "$tool" render "$input" -qfo "$threads.png" --size 256x256 \
            --threads $threads || fail "does not draw with $threads threads"
        cmp own.png $threads.png || fail "other bytes with $threads threads"
    done
    [ $(($(wc -l <64.clones) - $(wc -l <1.clones))) -ge 63 ] || fail "--threads is not the number of threads"
fi
# The same run with a device of OpenCL's loads it: the trace shows what is looked for.
if CAMBER_CPU=none "$tool" info --json 2>/dev/null | grep -q '"version": "OpenCL'; then
    CAMBER_CPU=none traced opencl || fail "does not draw in OpenCL: $(cat opencl.told)"
    loads opencl | grep -q 'libOpenCL\.so\.1' || fail "OpenCL draws, and is not loaded"
    [ ! -f own.png ] || cmp own.png opencl.png || fail "OpenCL draws other bytes"
    traced asked --device opencl || fail "does not draw on --device opencl: $(cat asked.told)"
    loads asked | grep -q 'libOpenCL\.so\.1' || fail "--device opencl does not load OpenCL"
    cmp asked.png opencl.png || fail "--device opencl draws other bytes"
fi
if "$tool" info --json 2>/dev/null | grep -q '"available": true'; then
    traced gl --draw gl || fail "does not draw in GL: $(cat gl.told)"
    loads gl | grep -Eq 'lib(EGL|OSMesa)\.so' || fail "GL draws, and is not loaded"
fi

# ---- Missing: libraries that are none ----

mkdir none
for library in libOpenCL.so.1 libEGL.so.1 libOSMesa.so.8 libOSMesa.so.6 libOSMesa.so; do
    echo 'no library' >none/$library
done
export LD_LIBRARY_PATH=$folder/none${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
opencl='OpenCL is not installed \(libOpenCL\.so\.1\); install ocl-icd-libopencl1 and a driver .*pocl-opencl-icd'
fails "no device: $opencl" env CAMBER_CPU=none "$tool" render "$input" -fo a.png
CAMBER_CPU=none "$tool" info >told 2>&1 || fail "info without devices: $(cat told)"
grep -Eq "^device +none" told && grep -Eq "^OpenCL +not available: no device: $opencl" told || fail "info without devices says $(cat told)"
if [ "$has_cpu" = 1 ]; then
    "$tool" render "$input" -qfo bare.png --size 256x256 || fail "does not draw without drivers"
    [ ! -f own.png ] || cmp own.png bare.png || fail "other bytes without drivers"
    fails "no device matches 'opencl'; there are: camber .*; $opencl" "$tool" render "$input" -fo a.png --device opencl
    fails 'install libegl1' "$tool" render "$input" -fo a.png --draw gl
    "$tool" info >told 2>&1 || fail "info: $(cat told)"
    grep -Eq "^device +camber " told || fail "info names no device: $(cat told)"
    grep -Eq "^OpenCL +not available: .*$opencl" told || fail "info does not say how to get OpenCL: $(cat told)"
    grep -Eq '^GL +egl: not available: .*install libegl1' told || fail "info does not say how to get GL: $(cat told)"
fi
if [ -n "$part" ]; then
    cp "$part" none/libOpenCL.so.1
    fails 'no device: OpenCL \(libOpenCL\.so\.1\) lacks functions of version 1\.2; install' env CAMBER_CPU=none "$tool" render "$input" -fo a.png
fi
[ ! -e a.png ] || fail "a picture is left"
echo "no drivers are loaded unasked"
