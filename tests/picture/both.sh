#!/usr/bin/env bash
# A test of pictures on the back end cpu and then in OpenCL, which must draw the same bytes: both.sh TEST FOLDER
set -eu
test=$1 name=$(basename "$1") folder=$2
mkdir -p "$folder"
status=0
CAMBER_CPU='' CAMBER_DRAWN=$folder/$name.cpu "$test" || status=$?
[ "$status" != 77 ] || exit 77
[ "$status" = 0 ] || { echo "$name: $status on the back end cpu"; exit 1; }
CAMBER_CPU=none CAMBER_DRAWN=$folder/$name.opencl "$test" || status=$?
[ "$status" != 77 ] || exit 77
[ "$status" = 0 ] || { echo "$name: $status in OpenCL"; exit 1; }
if [ ! -s "$folder/$name.cpu" ]; then
    echo "$name: no picture was drawn"
    exit 1
fi
if ! differing=$(diff "$folder/$name.cpu" "$folder/$name.opencl"); then
    echo "$name: pictures of $(wc -l <"$folder/$name.cpu") differ in OpenCL (their sizes, hashes of their bytes):"
    echo "$differing" | head -n 20
    exit 1
fi
echo "$name: $(wc -l <"$folder/$name.cpu") pictures have the same bytes on both"
