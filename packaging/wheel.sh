#!/usr/bin/env bash
# Builds the archive of sources, and the wheel from it: wheel.sh TREE OUT_FOLDER LIBRARIES_FOLDER
#
# Runs as root in a fresh Debian 11, whose C library (2.31) is as old as that of any Linux of the last five years;
# tests/recipes/recipes.sh makes one, which ./dev wheel calls. Debian 11 has clang 16, which compiles the kernels. Its
# HarfBuzz, jansson, libdeflate and libmicrohttpd are too old, its Cairo wants X11, and its fontconfig does not know all
# that newer systems configure, nor their caches: these are built here from Debian 12's sources, and kept in
# LIBRARIES_FOLDER for the next time. setuptools, which is Python only, and GDAL's headers are Debian 12's.
set -eux
tree=$1 out=$2
prefix=$3/$(sed -n '/^begin()/,/^cd /p' "$0" | sha256sum | cut -c 1-12) # other recipes, other libraries
gdal="32;33;34;35;36;37;38;39;40" # 3.6, which Debian 12 has, to 3.14
export LD_LIBRARY_PATH=$prefix/lib PKG_CONFIG_PATH=$prefix/lib/pkgconfig

cat >/etc/apt/sources.list <<'LIST'
deb http://deb.debian.org/debian bullseye main
deb http://deb.debian.org/debian-security bullseye-security main
deb http://deb.debian.org/debian bookworm main
deb-src http://deb.debian.org/debian bookworm main
LIST
printf 'Package: *\nPin: release n=bookworm\nPin-Priority: 1\n' >/etc/apt/preferences.d/bookworm
apt-get update -qq -o Acquire::Check-Valid-Until=false
apt-get install -y -qq -o Acquire::Retries=5 --no-install-recommends gcc g++ make libc6-dev dpkg-dev cmake ninja-build \
    pkg-config file patchelf clang-16 python3-dev python3-distutils python3-cffi python3-wheel python3-pip \
    libpng-dev libwebp-dev libmeshoptimizer-dev libisal-dev liblz4-dev libzstd-dev liblzma-dev \
    libprotobuf-c-dev protobuf-c-compiler libsqlite3-dev zlib1g-dev libfribidi-dev libfreetype-dev libexpat1-dev gperf \
    libpixman-1-dev libjs-leaflet
mkdir -p /opt/parts && cd /opt/parts
apt-get download -qq python3-setuptools/bookworm python3-pkg-resources/bookworm libgdal-dev/bookworm
for part in *.deb; do dpkg -x "$part" .; done # of GDAL only the headers
export PYTHONPATH=/opt/parts/usr/lib/python3/dist-packages SETUPTOOLS_USE_DISTUTILS=stdlib # Debian 11 has patched it

# begin NAME: its source; then `end LIBRARY` says what was installed
begin() { # NAME
    mkdir -p "/opt/source/$1" && cd "/opt/source/$1"
    apt-get source -qq --download-only "$1/bookworm"
    dpkg-source --no-check -x ./*.dsc tree
    cd tree
}
end() { # LIBRARY
    mkdir -p "$prefix/share/licenses" "$prefix/share/packages"
    local name version
    name=$(dpkg-parsechangelog -S Source) version=$(dpkg-parsechangelog -S Version)
    cp debian/copyright "$prefix/share/licenses/$name"
    echo "$1" >"$prefix/share/packages/${name}_$version"
}
set_times() { # of what autotools made: Debian's patches must not make them run
    touch aclocal.m4
    touch configure
    find . -name '*.in' -exec touch {} +
}
has() { compgen -G "$prefix/share/packages/$1_*"; }
if ! has harfbuzz; then
    begin harfbuzz # as one file, which takes a tenth of the time
    mkdir -p "$prefix/lib/pkgconfig" "$prefix/include/harfbuzz"
    cp src/hb*.h "$prefix/include/harfbuzz"
    g++ -O2 -std=c++11 -fPIC -fno-exceptions -fno-rtti -fno-threadsafe-statics -fvisibility-inlines-hidden -DHAVE_PTHREAD=1 -w \
        -shared -Wl,-soname,libharfbuzz.so.0 -nodefaultlibs src/harfbuzz.cc -o "$prefix/lib/libharfbuzz.so.0" -lc -lm -lpthread
    ln -sf libharfbuzz.so.0 "$prefix/lib/libharfbuzz.so"
    printf '%s\n' 'Name: harfbuzz' 'Description: shapes text' "Version: $(dpkg-parsechangelog -S Version | sed 's/[+-].*//')" \
        "Cflags: -I$prefix/include/harfbuzz" "Libs: -L$prefix/lib -lharfbuzz" >"$prefix/lib/pkgconfig/harfbuzz.pc"
    end libharfbuzz
fi
if ! has cairo; then
    begin cairo
    set_times
    ./configure -q --prefix="$prefix" --disable-static --disable-xlib --disable-xcb --disable-gobject --disable-fc \
        --disable-script --disable-interpreter --disable-trace --disable-ps --disable-gtk-doc --enable-pdf --enable-svg --enable-png \
        CFLAGS=-O2
    make -s -C src -j "$(nproc)" install
    end libcairo
fi
if ! has libfontconfig; then
    begin fontconfig # with the folders of Debian's, which are those of most systems
    set_times
    ./configure -q --prefix="$prefix" --sysconfdir=/etc --localstatedir=/var --with-cache-dir=/var/cache/fontconfig \
        --with-templatedir=/usr/share/fontconfig/conf.avail --disable-static --disable-docs --disable-nls CFLAGS=-O2
    make -s -j "$(nproc)" -C fc-case && make -s -C fc-lang && make -s -j "$(nproc)" -C src
    make -s -C src install && make -s -C fontconfig install && make -s install-pkgconfigDATA
    end libfontconfig
fi
if ! has libdeflate; then
    begin libdeflate
    make -s -j "$(nproc)" PREFIX="$prefix" install
    end libdeflate
fi
if ! has jansson; then
    begin jansson
    cmake -S . -B made -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_BUILD_TYPE=Release \
        -DJANSSON_BUILD_SHARED_LIBS=ON -DJANSSON_BUILD_DOCS=OFF -DJANSSON_WITHOUT_TESTS=ON -DJANSSON_EXAMPLES=OFF
    cmake --build made --target install
    end libjansson
fi
if ! has libmicrohttpd; then
    begin libmicrohttpd
    set_times
    ./configure -q --prefix="$prefix" --disable-static --disable-https --disable-doc --disable-examples --disable-curl \
        CFLAGS="-O2 -DNDEBUG"
    make -s -j "$(nproc)" install
    end libmicrohttpd
fi

cd "$tree"
python3 setup.py -q sdist -d "$tree/from" # the wheel is built of the archive, in a folder whose name ccache knows
tar -C from -xf from/camber-*.tar.gz
cd from/camber-*/
CMAKE_ARGS="-DCAMBER_CLANG=/usr/bin/clang-16 -DCAMBER_CPU=ON -DCMAKE_SHARED_LINKER_FLAGS=-Wl,-z,defs '-DCAMBER_GDAL_SONAMES=$gdal'
    -DCAMBER_GDAL_HEADERS=/opt/parts/usr/include/gdal -DCAMBER_LIBDEFLATE=ON -DCAMBER_WEBP=ON -DCAMBER_SERVE=ON
    -DCAMBER_LZ4=ON -DCAMBER_ZSTD=ON -DCAMBER_LZMA=ON -DCAMBER_CAIRO=ON" \
    PYTHONPATH=python:$PYTHONPATH python3 -c 'import backend; backend.build_wheel("..")' # as pip does
mkdir -p "$out"
python3 "$tree/packaging/bundle_wheel.py" ../camber-*.whl "$out" "$prefix"
cp ../camber-*.tar.gz "$out"
