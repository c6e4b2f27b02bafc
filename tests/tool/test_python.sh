#!/usr/bin/env bash
# The Python module, built by pip without a network and tested by pytest: test_python.sh SOURCE BUILD PYTHON [PYTEST ARGS...]
# A build with sanitizers has their library loaded first.
set -eu
source=$1 build=$2 python=$3
shift 3
skip() { echo "skipped: $*"; exit 77; }
for module in numpy cffi setuptools wheel pip pytest; do
    "$python" -c "import $module" 2>/dev/null || skip "$python has no $module (Debian: python3-$module)"
done
[ -f "$("$python" -c 'import sysconfig; print(sysconfig.get_path("include"))')/Python.h" ] || skip "no Python.h (Debian: python3-dev)"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
preloaded=${LD_PRELOAD:-}
unset LD_PRELOAD
mkdir "$folder/tree"
cp -r "$source"/{pyproject.toml,setup.py,MANIFEST.in,LICENSE,python,docs} "$folder/tree"
cd "$folder/tree"
export CAMBER_BUILD=$build LD_LIBRARY_PATH=$build/src CAMBER_TOOL=$build/src/camber PYTHONDONTWRITEBYTECODE=1
pip() { "$python" -m pip --disable-pip-version-check "$@" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }; }
sanitizer=$(ldd "$build/src/libcamber.so" | awk '/lib[at]san/ { print $3 }')
case $sanitizer in *libasan*) export CFLAGS=-fsanitize=address PYTHONMALLOC=malloc ;; esac # so that it sees Python's blocks
# As a release has it, from a source distribution, which build makes of the tree.
sources=.
if "$python" -c 'import build.__main__' 2>/dev/null; then
    "$python" -m build --sdist --outdir "$folder/dist" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
    sources=$(ls "$folder"/dist/camber-*.tar.gz)
fi
pip install --no-index --no-deps --root-user-action=ignore --target "$folder/site" "$sources"
export PYTHONPATH=$folder/site
if [ -n "$sanitizer" ]; then
    echo "under a sanitizer: the stubs are not compared"
elif "$python" -c 'import mypy' 2>/dev/null; then # the stubs say what the module has
    (cd "$folder" && "$python" -m mypy.stubtest camber --ignore-missing-stub) || exit 1
    (cd "$folder/site" && "$python" -m mypy --cache-dir "${XDG_CACHE_HOME:-$folder}/mypy" -c 'import camber; camber.Map("a", column="b")') |
        grep -q 'Argument "column" to "Map"' || { echo "the stubs take an argument that does not exist"; exit 1; }
else
    echo "no mypy: the stubs are not compared"
fi
# With the library of C++ it finds what others throw: matplotlib of Debian 13, as it is imported.
export LD_PRELOAD=${sanitizer:+$sanitizer libstdc++.so.6 }$preloaded
# Python keeps what it has until it ends; memory that is freed is used again at once, so that its growth can be told.
[ -z "$sanitizer" ] || export CAMBER_CALLS=10000 ASAN_OPTIONS=${ASAN_OPTIONS:-}:detect_leaks=0:quarantine_size_mb=1:thread_local_quarantine_size_kb=16
cd "$source"
"$python" -m pytest -q -p no:cacheprovider -rs "$@"
