#!/usr/bin/env bash
# The spec makes its RPM packages of what this build installs, each file in one of them, and the formula is Ruby:
# test_spec.sh SOURCE BUILD PYTHON
# What Fedora's macros for CMake and Python do is told here, and nothing is compiled anew.
set -eu
source=$1 build=$2 python=$3
unset LD_PRELOAD DESTDIR
! command -v ruby >/dev/null || ruby -c "$source/packaging/camber.rb"
command -v rpmbuild >/dev/null || { echo "skipped: no rpmbuild (Debian: rpm)"; exit 77; }
"$python" -c 'import setuptools, cffi' || { echo "skipped: $python has no setuptools or cffi (Debian: python3-setuptools, python3-cffi)"; exit 77; }
version=$(sed -n 's/^project(camber VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
folder=$(mktemp -d)
mkdir -p "$folder/SOURCES" "$folder/tree/camber-$version"
cp -r "$source"/{pyproject.toml,setup.py,LICENSE,python,docs} "$folder/tree/camber-$version"
tar -C "$folder/tree" -czf "$folder/SOURCES/camber-$version.tar.gz" "camber-$version"
mkdir -p "$folder/tree/package/dist" # npm's archive of Leaflet, of which the build has its own
echo BSD >"$folder/tree/package/LICENSE"
tar -C "$folder/tree" -czf "$folder/SOURCES/$(sed -n 's|^Source1:.*/||p' "$source/packaging/camber.spec")" package
# Whoever has installed from this folder wants to uninstall that.
manifest=$build/install_manifest.txt
[ ! -f "$manifest" ] || mv "$manifest" "$folder/manifest"
trap 'rm -f "$manifest"; [ ! -f "$folder/manifest" ] || mv "$folder/manifest" "$manifest"; rm -rf "$folder"' EXIT

# make SPEC: its packages, with what CMake and Python install in the places that Debian's rpm names
make() {
    rpmbuild -bb --nodeps --define "_topdir $folder" --define "cmake true" --define "cmake_build true" \
        --define "cmake_install DESTDIR=%{buildroot} cmake --install $build --prefix %{_prefix}" \
        --define "_vpath_builddir $build" --define "_libdir %{_prefix}/lib" --define "_docdir %{_datadir}/doc" \
        --define "python3 $python" --define "debug_package %{nil}" \
        --define "python3_sitearch %{_prefix}/{lib,local/lib}/python3*/*-packages" \
        "$1" >"$folder/log" 2>&1
}
make "$source/packaging/camber.spec" || { tail -n 40 "$folder/log"; exit 1; }
for package in camber camber-libs camber-devel python3-camber; do
    rpm -qpl "$folder"/RPMS/*/"$package-$version-"*.rpm >"$folder/files"
    case $package in
    camber) wanted=/usr/bin/camber ;;
    camber-libs) wanted=/usr/lib/libcamber-map.so.0 ;;
    camber-devel) wanted=/usr/include/camber.h ;;
    *) wanted=/camber/__init__.py ;;
    esac
    grep -q "$wanted\$" "$folder/files" || { cat "$folder/files"; echo "$package has no $wanted"; exit 1; }
done
# A file that no package has, and one that is not there, are told.
sed '/^%{_bindir}\/camber/d' "$source/packaging/camber.spec" >"$folder/less.spec"
! make "$folder/less.spec" && grep -q 'unpackaged' "$folder/log" || { tail -n 20 "$folder/log"; exit 1; }
sed 's/^%{_bindir}\/camber/&\n%{_bindir}\/gone/' "$source/packaging/camber.spec" >"$folder/more.spec"
! make "$folder/more.spec" && grep -q '/gone' "$folder/log" || { tail -n 20 "$folder/log"; exit 1; }
