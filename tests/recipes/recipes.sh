#!/usr/bin/env bash
# The documents' recipes, each as it stands there, in a fresh Debian with the packages that it names and no other.
#
#   recipes.sh RECIPE [SYSTEM...]     in each system, bookworm and trixie unless others are named. RECIPE is
#       build, core, ci, demo    a recipe of the documents
#       newcomer                 the README's first commands, ./dev demo and all of ./dev test, by a user with sudo
#       packages                 the packages that ./dev package makes: installed, the documents' first examples run, all
#                                removed. They are made here for this Debian, which is taken if none is named, and in
#                                a fresh system for another
#       wheel                    Python's wheel, made in Debian 11 into the build folder, as its archive of sources is; in each
#                                system (bullseye, bookworm, trixie and noble) a user without a compiler installs it and
#                                draws with it what the build folder's tool draws, byte for byte
#       devices                  no test: frames of the back end cpu beside the system's PoCL, in the processor's own code and
#                                in AVX2 code (docs/benchmarks.md). Cities need CAMBER_DATA; trixie has PoCL 6
#
# A recipe is the block below a line <!-- recipe: NAME --> of README.md or docs/*.md: shell, or steps of GitHub Actions,
# whose `run` is run and whose `checkout` is a copy of this tree. Needs root, debootstrap and the system's mirror; ends with
# 77 if one is not to be had. CAMBER_CHROOTS (/var/cache/camber-chroots) keeps fresh systems, their packages and what
# PoCL compiles in them for the next time, and libraries for the wheel; objects are ccache's, in the cache of this system.
# All mounts are in a namespace of their own: they go with it, however this ends.
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
kept=${CAMBER_CHROOTS:-/var/cache/camber-chroots}
objects=${CCACHE_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/ccache}

# The archive of a system, where it is not debootstrap's own choice.
mirror_of() { # SYSTEM
    case $1 in
    noble) echo http://archive.ubuntu.com/ubuntu ;;
    *) echo http://deb.debian.org/debian ;;
    esac
}

skip() { echo "skipped: $*"; exit 77; }

# ---- Inside the namespace ----

# A system like the kept one, of which nothing that is written stays: mount_root DEBIAN FOLDER
mount_root() {
    local base=$kept/$1 folder=$2 root=$2/root
    mkdir -p "$root" "$folder/upper" "$folder/work" "$kept/$1.debs"
    mount -t overlay none -o "lowerdir=$base,upperdir=$folder/upper,workdir=$folder/work" "$root" 2>/dev/null ||
        cp -a "$base/." "$root"
    mount -t proc none "$root/proc"
    mount -t sysfs none "$root/sys"
    mount --rbind /dev "$root/dev" # with its terminals
    mount --bind "$kept/$1.debs" "$root/var/cache/apt/archives"
    mkdir -p "$root/kept/objects" "$root/kept/pocl" "$root/kept/wheel" "$kept/$1.pocl" "$kept/wheel" "$objects"
    chmod 777 "$kept/$1.pocl"
    mount --bind "$objects" "$root/kept/objects"
    mount --bind "$kept/$1.pocl" "$root/kept/pocl"
    mount --bind "$kept/wheel" "$root/kept/wheel"
    [ -z "${CAMBER_DATA:-}" ] || { mkdir "$root/kept/data" && mount --bind "$CAMBER_DATA" "$root/kept/data"; }
    cp -L /etc/resolv.conf "$root/etc/resolv.conf"
    cp -L /etc/ssl/certs/ca-certificates.crt "$root/kept/certificates" # npm's registry is trusted as it is here
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fresh" # nothing of it outlives this run
}

# in_root DEBIAN FOLDER SCRIPT
in_root() {
    mount_root "$1" "$2"
    mkdir -p "$2/root/checkout" "$2/root/root/here"
    [ ! -d "$2/../checkout" ] || mount --bind "$2/../checkout" "$2/root/checkout"
    cp "$3" "$2/root/script.sh"
    chroot "$2/root" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
        DEBIAN_FRONTEND=noninteractive CAMBER_URL=/checkout CMAKE_C_COMPILER_LAUNCHER=ccache CCACHE_DIR=/kept/objects \
        CCACHE_UMASK=000 CCACHE_NOHASHDIR=1 CCACHE_BASEDIR=/root/here POCL_CACHE_DIR=/kept/pocl \
        npm_config_cafile=/kept/certificates ${CAMBER_DATA:+CAMBER_DATA=/kept/data} \
        bash -c 'cd /root/here && exec bash -eux /script.sh'
}

# make_base DEBIAN
make_base() {
    rm -rf --one-file-system "${kept:?}/$1.part"
    local mirror components=main script=
    mirror=$(mirror_of "$1")
    if [ "$1" = noble ]; then
        components=main,universe
        [ -e /usr/share/debootstrap/scripts/noble ] || script=/usr/share/debootstrap/scripts/gutsy # older than the system
    fi
    rm -rf --one-file-system "${kept:?}/$1"
    debootstrap --variant=minbase --include=ccache --components="$components" "$1" "$kept/$1.part" "$mirror" $script &&
        mv "$kept/$1.part" "$kept/$1"
}

if [ "${1:-}" = inside ]; then
    shift
    "$@"
    exit
fi
inside() { unshare --mount --pid --fork --kill-child bash "${BASH_SOURCE[0]}" inside "$@"; }

# ---- Outside ----

# The block of README.md or docs/*.md below a recipe's mark.
block() { # NAME
    awk -v mark="<!-- recipe: $1 -->" '
        $0 == mark { found = 1; next }
        found && /^```/ { if (fenced) exit; fenced = 1; next }
        found && fenced { print; next }
        found && /^    / { print substr($0, 5); indented = 1; next }
        found && indented { exit }' "$source/README.md" "$source"/docs/*.md
}

# Steps of GitHub Actions as shell.
steps() {
    awk 'function flush() {
             if (checkout) print "cp -a /checkout/. " (path ? path : ".")
             if (run != "") print run
             checkout = 0; path = run = ""; folded = 0
         }
         /^ *- /                           { flush() }
         /^ *- uses: actions\/checkout/    { checkout = ++checkouts > 1; next } # the first one is of the roads
         /^ *path: / && checkout           { path = $2; next }
         /^ *- run: >$/                    { folded = 1; next }
         /^ *- run: /                      { sub(/^ *- run: /, ""); run = $0; next }
         folded                            { sub(/^ */, ""); run = run (run == "" ? "" : " ") $0 }
         END                               { flush() }'
}

# The function that README.md gives to root without sudo.
without_sudo() { grep -o 'sudo() {[^`]*}' "$source/README.md"; }

# A recipe as a script, with the checks that follow it. The newcomer to Debian 12 has clang and Chromium, the others have
# what ./dev installs.
script_of() { # NAME SYSTEM
    case $1 in
    build)
        block build
        echo 'od -An -c -N4 city.png | grep -q "P   N   G"'
        echo 'sudo cmake --build build --target uninstall && test ! -e /usr/local/bin/camber'
        ;;
    core)
        echo 'sudo apt-get update && sudo apt-get install -y --no-install-recommends git ca-certificates'
        block core
        ;;
    ci)
        cat <<'ROADS'
echo '{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"highway": "primary"}, "geometry":
    {"type": "LineString", "coordinates": [[0, 0], [0.01, 0.004], [0.013, 0.012], [0.02, 0]]}}]}' >roads.geojson
ROADS
        block ci | steps
        echo 'test -s camber.xml && test -s roads.xml'
        ;;
    newcomer)
        echo 'apt-get update -qq && apt-get install -y -qq --no-install-recommends git ca-certificates sudo'
        [ "$2" != bookworm ] || echo 'apt-get install -y -qq --no-install-recommends clang chromium'
        echo 'useradd -m newcomer && echo "newcomer ALL=(ALL) NOPASSWD: ALL" >/etc/sudoers.d/newcomer'
        echo 'git config --system safe.directory "*"' # the clone is of another user's folder
        cat <<'CLONE'
[ -w /kept/objects ] && sudo -u newcomer test -w /kept/objects || export CCACHE_READONLY=1 CCACHE_TEMPDIR=/tmp
cat >/home/newcomer/as-told <<'TOLD'
git clone -q /checkout camber && cd camber
CLONE
        [ "$2" != bookworm ] || echo 'export CC=clang CXX=clang++'
        block demo
        echo 'git status --porcelain | tee /tmp/left && test ! -s /tmp/left'
        echo TOLD
        echo 'export CCACHE_BASEDIR=/home/newcomer'
        echo 'sudo -u newcomer --preserve-env=CMAKE_C_COMPILER_LAUNCHER,CCACHE_DIR,CCACHE_UMASK,CCACHE_NOHASHDIR,CCACHE_BASEDIR,CCACHE_READONLY,CCACHE_TEMPDIR,POCL_CACHE_DIR,npm_config_cafile bash -c "cd && exec bash -eux as-told"'
        ;;
    demo)
        echo 'cp -a /checkout camber && cd camber'
        block demo | grep -v '^\./dev test'
        echo 'test -s build/monaco_light.png && test -s build/monaco_dark.png'
        echo 'cmake --install build && ldconfig && camber --version'
        ;;
    packages)
        echo 'apt-get install -y --no-install-recommends /checkout/debs/*.deb gcc libc6-dev pkg-config curl'
        echo '! ls /usr/lib/*/lib*OpenCL* /usr/lib/*/camber-kernels/*.bin && test ! -e /root/.cache' # nothing is compiled
        # The system as it is now: each file of camber's packages, and a moment that is later than all other files.
        echo "dpkg -L \$(dpkg-query -W -f '\${Package}\\n' '*camber*') | sort -u >/files && grep -q /camber /files"
        echo 'while read -r file; do [ -d "$file" ] || echo "$file"; done </files >/owned && sleep 1 && touch /moment'
        # The tool, C, Python, the server. What they keep for their user goes with the folder.
        echo 'export XDG_CACHE_HOME=/root/here/cache'
        block build | grep '^camber ' | sed 's|tests/data|/checkout/tests/data|'
        echo 'od -An -c -N4 city.png | grep -q "P   N   G"'
        echo 'gcc /checkout/examples/hello.c -o hello $(pkg-config --cflags --libs camber) -lm && ./hello'
        echo 'gcc /checkout/examples/map.c -o map $(pkg-config --cflags --libs camber-map) -lm && ./map /checkout/tests/data/santa_cruz/osm.mbtiles'
        echo "python3 - <<'PYTHON'"
        block python
        echo 'PYTHON'
        echo 'od -An -c -N4 flights.png | grep -q "P   N   G"'
        echo 'port=$((20000 + RANDOM % 12000))'
        echo 'camber serve /checkout/tests/data/santa_cruz/osm.mbtiles --listen 127.0.0.1:$port & server=$!'
        echo 'curl -fsS --retry 100 --retry-delay 1 --retry-all-errors http://127.0.0.1:$port/health && kill -0 $server'
        echo 'curl -fsS http://127.0.0.1:$port/12/659/1593.png | od -An -c -N4 | grep -q "P   N   G"'
        echo 'kill $server && wait $server'
        echo 'ls /usr/share/man/man1/camber.1.gz /usr/share/man/man1/camber-tiles.1.gz /usr/share/man/man1/camber-serve.1.gz /usr/share/man/man3/camber.3.gz'
        echo 'if [ -d /root/here/cache ]; then find /root/here/cache -type f; fi; rm -rf /root/here/*'
        echo "apt-get purge -y \$(dpkg-query -W -f '\${Package}\\n' '*camber*')"
        # Nothing is left that was camber's, by its package or by its name, and nothing that was written since, wherever it
        # may be; what dpkg, apt and ldconfig keep for themselves is theirs.
        echo 'while read -r file; do [ ! -e "$file" ] || echo "$file"; done </owned >/left'
        echo 'find / -xdev \( -path /checkout -o -path /proc -o -path /sys -o -path /dev -o -path /var/cache/apt \) -prune -o -name "*camber*" -print >>/left'
        echo 'find / -xdev \( -path /checkout -o -path /proc -o -path /sys -o -path /dev -o -path /var/cache -o -path /var/lib/dpkg -o -path /var/lib/apt -o -path /var/log -o -path /etc/ld.so.cache -o -path /left -o -path /moment \) -prune -o -type f -newer /moment -print >>/left'
        echo 'cat /left && test ! -s /left && test -z "$(ls /tmp)"'
        ;;
    wheel)
        echo 'apt-get install -y -qq --no-install-recommends python3-venv python3-numpy python3-cffi'
        echo 'if command -v gcc cc clang c++; then exit 1; fi'
        echo 'useradd -m traveller && cp /checkout/tests/recipes/wheel.sh /home/traveller && chmod -R a+rX /checkout'
        echo 'su - traveller -c "bash wheel.sh use /checkout"'
        if [ "$2" = bookworm ]; then
            echo 'apt-get install -y -qq --no-install-recommends libgdal32 && su - traveller -c "bash wheel.sh gdal"'
        fi
        # The build folder's tool drew the same; without one there is nothing to compare with.
        echo '[ ! -d /checkout/expected ] || for picture in /checkout/expected/*.png; do cmp "$picture" "/home/traveller/drawn/${picture##*/}"; done'
        ;;
    devices)
        echo 'cp -a /checkout camber && cd camber'
        echo 'eval "$(sed "/^case \"\${1:-help}\"/,\$d; /^cd /d" dev)" && install_packages "${PACKAGES_BUILD[@]}" "${PACKAGES_GL[@]}" pocl-opencl-icd ocl-icd-libopencl1 g++'
        echo 'configure build && compile build camber_bench'
        echo 'build/bench/camber_bench --section devices >/checkout/devices'
        echo 'CAMBER_CPU=x86-64-v3 POCL_KERNELLIB_NAME=avx2 build/bench/camber_bench --section devices >>/checkout/devices'
        ;;
    *) echo "no recipe $1" >&2; exit 2 ;;
    esac
}

# Makes the packages of a Debian, and looks at what programs will be linked with; they lie in the checkout then.
build_packages() { # DEBIAN
    local package=${CAMBER_BUILD:-$source/build}/package libraries
    rm -rf "$run/checkout/debs"
    mkdir "$run/checkout/debs"
    [ -z "${CAMBER_DEBS:-}" ] || { cp "$CAMBER_DEBS"/*.deb "$run/checkout/debs"; return; } # made before
    if [ "$1" != "$here" ]; then
        echo 'apt-get update -qq && apt-get install -y -qq --no-install-recommends git ca-certificates build-essential && cp -a /checkout camber && cd camber
              ./dev package && cp build/package/*.deb /checkout/debs' >"$run/make"
        inside in_root "$1" "$run/$1.make" "$run/make" >"$run/log" 2>&1 || { tail -n 40 "$run/log"; return 1; }
        rm -rf --one-file-system "$run/$1.make"
        return
    fi
    command -v dpkg-buildpackage >/dev/null && command -v dh_python3 >/dev/null ||
        skip "the packages: no dpkg-buildpackage or dh_python3 (Debian: dpkg-dev, debhelper, dh-python)"
    (cd "$source" && ./dev package) || return 1
    libraries=$(echo "$package"/camber-*/obj-*/src)
    bash "$source/packaging/abi.sh" soname "$libraries" || return 1
    bash "$source/packaging/abi.sh" check "$libraries" "$source/src" || [ $? = 77 ] || return 1
    cp "$package"/*.deb "$run/checkout/debs"
}

# Makes the wheel and the archive of sources into the build folder and the checkout, and what the wheel must draw.
build_wheel() {
    local made=${CAMBER_BUILD:-$source/build}/wheel tool=${CAMBER_BUILD:-$source/build}/src/camber
    if [ -n "${CAMBER_WHEEL:-}" ]; then # made before
        cp -r "$CAMBER_WHEEL" "$run/checkout/dist"
    else
        echo 'cp -a /checkout tree && bash tree/packaging/wheel.sh "$PWD/tree" /checkout/dist /kept/wheel' >"$run/make"
        inside in_root bullseye "$run/bullseye.make" "$run/make" >"$run/log" 2>&1 || { tail -n 40 "$run/log"; return 1; }
        rm -rf --one-file-system "$run/bullseye.make" "$made"
        cp -r "$run/checkout/dist" "$made"
        ls -l "$made"
    fi
    if [ -x "$tool" ]; then
        bash "$source/tests/recipes/wheel.sh" draw "$tool" "$source" "$run/checkout/expected" >"$run/log" 2>&1 || { tail -n 40 "$run/log"; return 1; }
    else
        echo "no $tool: the wheel's pictures are compared with nothing"
    fi
}

[ "$(id -u)" = 0 ] || skip "the documents' recipes: not root"
command -v debootstrap >/dev/null || skip "the documents' recipes: no debootstrap (Debian: debootstrap)"
command -v git >/dev/null || skip "the documents' recipes: no git"
unshare --mount --pid --fork true 2>/dev/null || skip "the documents' recipes: no right to mount"
mkdir -p "$kept"
run=$(mktemp -d "$kept/run.XXXXXX")
trap 'rm -rf --one-file-system "$run"' EXIT
trap 'exit 130' INT TERM

# A clean clone of this tree as it is now, what is not committed yet included.
mkdir "$run/checkout"
git -c safe.directory='*' -C "$source" ls-files -coz --exclude-standard | (cd "$source" && tar --null -T - --ignore-failed-read -cf -) | tar -xf - -C "$run/checkout"
git -C "$run/checkout" -c init.defaultBranch=main init -q
git -C "$run/checkout" add -A
git -C "$run/checkout" -c user.name=camber -c user.email=camber@example.org commit -qm "as it is now"
chown -R root: "$run/checkout"

recipe=${1:?recipes.sh RECIPE [SYSTEM...]}
shift
if [ "$recipe" = packages ]; then
    here=$(. /etc/os-release && [ "$ID" = debian ] && echo "$VERSION_CODENAME") || here=
    [ $# -gt 0 ] || set -- ${here:+"$here"}
    [ $# -gt 0 ] || skip "the packages: this is no Debian, and none is named"
fi
[ $# -gt 0 ] || [ "$recipe" != wheel ] || set -- bullseye bookworm trixie noble
[ $# -gt 0 ] || set -- bookworm trixie

prepare() { # SYSTEM
    if [ ! -x "$kept/$1/usr/bin/ccache" ]; then
        begun=$SECONDS
        inside make_base "$1" >"$run/log" 2>&1 || { tail -n 3 "$run/log"; skip "the documents' recipes: debootstrap of $1 failed"; }
        echo "$1: a fresh system, $((SECONDS - begun)) s"
    fi
    echo 'apt-get -qq update' >"$run/update"
    [ "$1" = bullseye ] || echo 'apt-get -qq update -o APT::Update::Error-Mode=any' >"$run/update" # which its apt does not know
    inside in_root "$1" "$run/$1.update" "$run/update" >"$run/log" 2>&1 ||
        { tail -n 3 "$run/log"; skip "the documents' recipes: no $(mirror_of "$1")"; }
}

failures=0
if [ "$recipe" = wheel ]; then
    prepare bullseye
    begun=$SECONDS
    build_wheel || { echo "FAILED: the wheel does not build, after $((SECONDS - begun)) s"; exit 1; }
    echo "bullseye: the wheel is made, $((SECONDS - begun)) s"
fi
for system; do
    prepare "$system"
    begun=$SECONDS
    if [ "$recipe" = packages ] && ! build_packages "$system"; then
        echo "FAILED: $system: the packages do not build"
        failures=$((failures + 1))
        continue
    fi
    { [ "$recipe" = newcomer ] || without_sudo && script_of "$recipe" "$system"; } >"$run/$recipe"
    if { [[ $recipe = @(packages|newcomer|wheel|devices) ]] || [ "$(block "$recipe" | wc -l)" != 0 ]; } &&
        inside in_root "$system" "$run/$system.$recipe" "$run/$recipe" >"$run/log" 2>&1; then
        grep -E '^[0-9]+% tests passed|^skipped, and why|^  test_.*: ' "$run/log" || true
        [ "$recipe" != devices ] || cat "$run/checkout/devices"
        echo "$system: $recipe: works, $((SECONDS - begun)) s"
    else
        failures=$((failures + 1))
        awk '/\*\*\*(Failed|Timeout|Exception)/ { found = 1 } /^ *Start +[0-9]+:/ { found = 0 } found' "$run/log" | head -n 400
        tail -n 60 "$run/log"
        echo "FAILED: $system: $recipe, after $((SECONDS - begun)) s"
    fi
    rm -rf --one-file-system "$run/$system.$recipe"
done
[ $failures = 0 ]
