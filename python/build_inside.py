"""The C library and the tool inside the package, for a system that has no library of camber's installed.

CMake builds them from the sources of this tree. CMAKE_ARGS in the environment are more options for it.
"""

import os
import shlex
import shutil
import subprocess
import sys

from setuptools.command.build_ext import build_ext

BUILD, PREFIX = "build/python/c", "build/python/inside"  # beside what CMake builds elsewhere
LIBRARIES = os.path.join(PREFIX, "lib")
RUN_PATH = "$ORIGIN/lib"  # of the extension: its package has the same folders as PREFIX


def is_wanted():
    """Whether the C library is built here: CAMBER_BUILD names none, none is installed, and there are its sources."""
    if os.environ.get("CAMBER_BUILD") or not os.path.isfile("CMakeLists.txt"):
        return False
    try:
        return subprocess.run([os.environ.get("PKG_CONFIG", "pkg-config"), "--exists", "camber-map"]).returncode != 0
    except OSError:
        return True


def run(*command):
    print(shlex.join(command), flush=True)
    try:
        subprocess.run(command, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit("camber: the C library does not build: %s; docs/python.md names the packages that it needs" % error)


def build():
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    run("cmake", "-S", ".", "-B", BUILD, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DCAMBER_TESTS=OFF", "-DCAMBER_WARM=OFF",
        "-DCMAKE_INSTALL_LIBDIR=lib", "-DCMAKE_INSTALL_BINDIR=bin", "-DCMAKE_INSTALL_RPATH=$ORIGIN",
        *shlex.split(os.environ.get("CMAKE_ARGS", "")))
    run("cmake", "--build", BUILD, "--parallel", str(os.cpu_count() or 1))
    run("cmake", "--install", BUILD, "--prefix", PREFIX, "--strip")


def copy_into(package):
    """Copies what programs need when they run; a wheel has no links, so each library gets the name that it is loaded by."""
    modules = os.path.join(LIBRARIES, "camber")
    files = [os.path.join("bin", "camber")]
    files += [os.path.join("lib", name) for name in os.listdir(LIBRARIES) if name.split(".so.")[-1].isdigit()]
    files += [os.path.join("lib", "camber", name) for name in os.listdir(modules) if ".so." in name]
    for file in files:
        os.makedirs(os.path.dirname(os.path.join(package, file)), exist_ok=True)
        shutil.copy(os.path.join(PREFIX, file), os.path.join(package, file))


class BuildInside(build_ext):
    def run(self):
        build()
        super().run()
        copy_into(os.path.join(self.build_lib, "camber"))
