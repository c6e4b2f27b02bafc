#!/usr/bin/env python3
"""Puts into a wheel the libraries that it needs, with their licences, and names the oldest C library that it runs with.

    bundle_wheel.py WHEEL OUT_FOLDER [PREFIX]      PREFIX: where libraries were installed that are no package of Debian

Each library gets a name of its own, with a hash of its bytes, so that it is never taken for the one of the system or of
another wheel. What the system has to have stays there: the C library, and drivers, which camber loads when they are asked
for. Needs patchelf, and dpkg for names, versions and licences.
"""

import glob
import hashlib
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

# The C library's; GDAL is the system's, in whichever version it is there. Drivers are loaded when they are asked for.
OF_THE_SYSTEM = re.compile(r"(ld-linux-.*|lib(c|m|dl|rt|pthread|gdal))\.so\.\d+$")

EMBEDDED = "libjs-leaflet"  # in the tool: the page of camber serve


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def is_elf(path):
    with open(path, "rb") as file:
        return file.read(4) == b"\x7fELF"


def needed(path):
    return output("patchelf", "--print-needed", path).split()


def locate(path):
    """Name -> file, as the loader finds them for this one."""
    return dict(re.findall(r"^\s*(\S+) => (/\S+)", output("ldd", path), re.M))


def package_of(library, prefix):
    """(name, version, file of the licence) of what a library is part of"""
    if prefix and library.startswith(prefix + "/"):
        for owned in glob.glob(os.path.join(prefix, "share/packages/*")):  # NAME_VERSION: a line a library
            with open(owned, encoding="utf-8") as file:
                if os.path.basename(library).split(".so")[0] in file.read().split():
                    name, version = os.path.basename(owned).split("_")
                    return name, version, os.path.join(prefix, "share/licenses", name)
        sys.exit("bundle: nothing says what %s is part of" % library)
    for path in (library, os.path.realpath(library), "/usr" + library, re.sub("^/usr", "", os.path.realpath(library))):
        found = subprocess.run(["dpkg", "-S", path], capture_output=True, text=True)
        if found.returncode == 0:
            package = found.stdout.split(":")[0]
            version = output("dpkg-query", "-W", "-f", "${Version}", package)
            return package, version, "/usr/share/doc/%s/copyright" % package
    sys.exit("bundle: no package has %s" % library)


def newest_glibc(files):
    """The newest version of the C library whose symbols they want."""
    versions = {(0, 0)}
    for path in files:
        versions |= {tuple(map(int, found)) for found in re.findall(r"\bGLIBC_(\d+)\.(\d+)", output("objdump", "-T", path))}
    return max(versions)


# glibc 2.29 has exp, exp2, log, log2 and pow once more: the new ones set errno otherwise, and return the same numbers.
MATHS = b"GLIBC_2.29"
OLDER_MATHS = {"x86_64": b"GLIBC_2.2.5", "aarch64": b"GLIBC_2.17"}


def hash_version(name):
    """As ELF hashes names of symbols and versions."""
    value = 0
    for byte in name:
        value = (value << 4) + byte
        value = (value ^ (value & 0xF0000000) >> 24) & 0x0FFFFFFF
    return value


def bind_older_maths(path):
    """Changes a library that wants functions of MATHS from libm: it wants the older ones, which any libm has."""
    with open(path, "rb") as file:
        elf = bytearray(file.read())
    first, size, count = struct.unpack_from("<Q10xHH", elf, 0x28)
    sections = [struct.unpack_from("<IIQQQQIIQQ", elf, first + i * size) for i in range(count)]
    for _, kind, _, _, needs, _, link, needed_files, _, _ in sections:
        if kind != 0x6FFFFFFE:  # SHT_GNU_verneed
            continue
        _, _, _, _, texts, text_size, _, _, _, _ = sections[link]

        def text(at):
            return bytes(elf[texts + at:elf.index(0, texts + at)])

        older = OLDER_MATHS[os.uname().machine]
        place = elf.find(b"\0" + older + b"\0", texts, texts + text_size) + 1 - texts
        for _ in range(needed_files):
            _, versions, name, at, following = struct.unpack_from("<HHIII", elf, needs)
            at += needs
            for _ in range(versions):
                _, _, _, version, behind = struct.unpack_from("<IHHII", elf, at)
                if text(name) == b"libm.so.6" and text(version) == MATHS:
                    if place <= 0:
                        sys.exit("bundle: %s has no text %s" % (path, older.decode()))
                    struct.pack_into("<I", elf, at, hash_version(older))
                    struct.pack_into("<I", elf, at + 8, place)
                at += behind
            needs += following
    with open(path, "wb") as file:
        file.write(elf)


class Bundle:
    def __init__(self, root, prefix):
        self.package, self.prefix = os.path.join(root, "camber"), prefix
        self.folder = os.path.join(self.package, "lib")
        self.info = glob.glob(os.path.join(root, "*.dist-info"))[0]
        self.new_names, self.sources, self.packages = {}, {}, {}

    def elf_files(self):
        for top, _, names in os.walk(self.package):
            for path in (os.path.join(top, name) for name in names):
                if is_elf(path):
                    yield path

    def add(self, name, source):
        """Copies a library, and then those that it needs."""
        if name in self.new_names:
            return
        with open(source, "rb") as file:
            digest = hashlib.sha256(file.read()).hexdigest()[:8]
        stem, rest = name.split(".so", 1)
        self.new_names[name], self.sources[name] = "%s-%s.so%s" % (stem, digest, rest), source
        package, version, licence = package_of(source, self.prefix)
        self.packages[package] = version, licence
        copy = os.path.join(self.folder, self.new_names[name])
        shutil.copy(source, copy)
        os.chmod(copy, 0o755)
        subprocess.run(["patchelf", "--set-soname", self.new_names[name], copy], check=True)
        subprocess.run(["patchelf", "--set-rpath", "$ORIGIN", copy], check=True)
        self.add_needed(source)

    def add_needed(self, path):
        found = locate(path)
        for name in needed(path):
            if not OF_THE_SYSTEM.match(name) and not os.path.exists(os.path.join(self.folder, name)):
                if name not in found:
                    sys.exit("bundle: %s needs %s, which is not here" % (path, name))
                self.add(name, found[name])

    def run(self):
        own = list(self.elf_files())
        for path in own:
            self.add_needed(path)
        for path in self.elf_files():
            for name in needed(path):
                if name in self.new_names:
                    subprocess.run(["patchelf", "--replace-needed", name, self.new_names[name], path], check=True)
            bind_older_maths(path)
        self.write_licences()

    def write_licences(self):
        folder = os.path.join(self.info, "licenses")
        os.makedirs(folder, exist_ok=True)
        shutil.copy(os.path.join(os.path.dirname(__file__), "../src/text/fonts/OFL.txt"), folder)  # fonts, in libcamber-map
        lines = ["The libraries in camber/lib besides libcamber's, each with the licence beside this file. They are Debian's, or",
                 "built of Debian's sources, unchanged: https://sources.debian.org/. Those under the LGPL may be replaced by others",
                 "of the same interface.", ""]
        embedded = output("dpkg-query", "-W", "-f", "${Version}", EMBEDDED)
        self.packages[EMBEDDED] = embedded, "/usr/share/doc/%s/copyright" % EMBEDDED
        for package, (version, licence) in sorted(self.packages.items()):
            shutil.copy(licence, os.path.join(folder, package + ".txt"))
            files = sorted(self.new_names[name] for name, source in self.sources.items()
                           if package_of(source, self.prefix)[0] == package)
            lines.append("%s %s: %s" % (package, version, " ".join(files) or "in camber/bin/camber"))
        with open(os.path.join(folder, "LIBRARIES.txt"), "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")


def main():
    wheel, out = sys.argv[1:3]
    prefix = os.path.realpath(sys.argv[3]) if len(sys.argv) > 3 else None
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-m", "wheel", "unpack", "--dest", folder, wheel], check=True)
        root = glob.glob(os.path.join(folder, "*"))[0]
        for tool in ("camber/bin/camber", "*.data/scripts/camber"):  # older versions of wheel forget it
            os.chmod(glob.glob(os.path.join(root, tool))[0], 0o755)
        bundle = Bundle(root, prefix)
        bundle.run()
        tag = "manylinux_%d_%d_%s" % (*newest_glibc(bundle.elf_files()), os.uname().machine)
        about = os.path.join(bundle.info, "WHEEL")
        with open(about, encoding="utf-8") as file:
            text = re.sub(r"^(Tag: \w+-\w+)-\w+$", r"\1-" + tag, file.read(), flags=re.M)
        with open(about, "w", encoding="utf-8") as file:
            file.write(text)
        subprocess.run([sys.executable, "-m", "wheel", "pack", "--dest-dir", out, root], check=True)


if __name__ == "__main__":
    main()
