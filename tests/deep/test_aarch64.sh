#!/usr/bin/env bash
# Camber on aarch64, which QEMU emulates: cross-compiled with this Debian's arm64 packages, and beside this build.
#
#   test_aarch64.sh build SOURCE FOLDER [CMAKE ARGS...]   the libraries, the tool and the tests, in FOLDER
#   test_aarch64.sh run SOURCE FOLDER K/N                 every N-th test that draws nothing, or draws by kernels
#   test_aarch64.sh bytes SOURCE FOLDER TOOL              the same pictures, tiles and meshes as TOOL, this build's
#
# The packages lie, extracted and nothing more, in a folder of CAMBER_CHROOTS (/var/cache/camber-chroots), and stay there.
# No foreign architecture is added to this system, and nothing is mounted. Ends with 77 if something is not to be had.
set -eu
kept=${CAMBER_CHROOTS:-/var/cache/camber-chroots}
debian=$(. /etc/os-release && [ "$ID" = debian ] && echo "$VERSION_CODENAME") || debian=
export CAMBER_SYSROOT=$kept/aarch64-$debian
libraries=(libc6-dev libpng-dev libdeflate-dev libwebp-dev libmicrohttpd-dev libmeshoptimizer-dev liblz4-dev libzstd-dev
    liblzma-dev libjansson-dev libgdal-dev libprotobuf-c-dev libsqlite3-dev zlib1g-dev libharfbuzz-dev libfribidi-dev
    libfontconfig-dev libcairo2-dev libcmocka-dev)
# QEMU runs the unit tests, and these, which draw by kernels.
drawn=(test_{golden,golden_map,polygons,dashes,ramps,paints,circles}_cl)
kernels=(test_{cpu,stages,tessellate,arc_length,rasterize_areas})

skip() { echo "skipped: aarch64: $*"; exit 77; }

unit_tests() { (cd "$1/tests/unit" && printf '%s\n' test_*.c | sed 's/\.c$//'); }

get_libraries() {
    local part triplet=usr/lib/aarch64-linux-gnu
    [ ! -e "$CAMBER_SYSROOT" ] || return 0
    mkdir -p "$kept"
    part=$(mktemp -d "$kept/aarch64.XXXXXX")
    if ! mmdebstrap --variant=extract --architectures=arm64 --include="$(IFS=, && echo "${libraries[*]}")" \
        --hook-dir=/usr/share/mmdebstrap/hooks/merged-usr "$debian" "$part" http://deb.debian.org/debian >"$folder/packages.log" 2>&1; then
        rm -rf "$part"
        tail -n 3 "$folder/packages.log"
        skip "Debian's arm64 packages are not to be had"
    fi
    # Links are made for a root folder: libm.so would be that of this system, and the linker would take libm.a in its place.
    find "$part/$triplet" -maxdepth 1 -type l -lname '/*' | while read -r link; do ln -sf "../../..$(readlink "$link")" "$link"; done
    # GDAL's libraries need these, which packages choose when they are configured.
    ln -s blas/libblas.so.3 lapack/liblapack.so.3 "$part/$triplet"
    chmod 755 "$part"
    mv -T "$part" "$CAMBER_SYSROOT" 2>/dev/null || rm -rf "$part" # another run was faster
}

build() {
    local source=$1 tests
    folder=$2
    shift 2
    [ -n "$debian" ] || skip "this is no Debian"
    for program in mmdebstrap qemu-aarch64 aarch64-linux-gnu-gcc clang; do
        command -v "$program" >/dev/null || skip "no $program (Debian: mmdebstrap, qemu-user, gcc-aarch64-linux-gnu, clang)"
    done
    [ -e "$CAMBER_SYSROOT" ] || [ "$(id -u)" = 0 ] || skip "only root fetches packages"
    mkdir -p "$folder"
    get_libraries
    export PKG_CONFIG_SYSROOT_DIR=$CAMBER_SYSROOT
    export PKG_CONFIG_LIBDIR=$CAMBER_SYSROOT/usr/lib/aarch64-linux-gnu/pkgconfig:$CAMBER_SYSROOT/usr/share/pkgconfig
    mapfile -t tests < <(unit_tests "$source")
    tests+=("${kernels[@]}" "${drawn[@]%_cl}")
    if ! { cmake -S "$source" -B "$folder" -G Ninja --toolchain "$source/tests/deep/aarch64.cmake" -DCAMBER_TESTS=ON \
        -DCAMBER_CPU=ON -DCMAKE_BUILD_TYPE=Release "$@" &&
        cmake --build "$folder" --target camber_tool "${tests[@]}"; } >"$folder/build.log" 2>&1; then
        grep -E -A5 '^FAILED|error:' "$folder/build.log" || tail -n 50 "$folder/build.log"
        exit 1
    fi
}

# CMake has QEMU run a test that it built.
run() {
    local source=$1 folder=$2 tests
    [ -x "$folder/src/camber" ] || skip "it was not built"
    mapfile -t tests < <(unit_tests "$source")
    tests+=("${kernels[@]}" "${drawn[@]}")
    CAMBER_CPU='' ctest --test-dir "$folder" --output-on-failure -j4 --no-tests=error -I "${3%/*},,${3#*/}" \
        -R "^($(IFS='|' && echo "${tests[*]}"))\$"
}

bytes() {
    [ -x "$2/src/camber" ] || skip "it was not built"
    python3 "$1/tests/tool/test_processors.py" "$3" aarch64 qemu-aarch64 -L "$CAMBER_SYSROOT" "$2/src/camber"
}

"$@"
